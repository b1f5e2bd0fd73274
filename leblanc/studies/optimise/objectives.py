"""What is to be small: vibrations over the volumes [theory: optimum, eq. 2-4].

At one speed or a mean over several, the largest over many without asking for all of them, and the largest of
a run-up in time; `robust` has the quantile over operating conditions.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from leblanc.scene.scene import Scene, Speeds
from leblanc.studies.models.liquid import runup_model
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from meshes.arrays import Array


class Vibration(Protocol):
    """A vibration that depends on the volumes of m sets, m^3, shape (m, c)."""

    def exact(self, volumes: Array) -> Array:
        """Vibration, m, shape (m,)."""
        ...


class AtSpeed:
    """Amplitude at one speed, or the weighted mean over several [theory: optimum, eq. 2].

    Parameters
    ----------
    machine : with any volumes
    speeds, weights : rad/s and their shares, shape (k,)
    """

    def __init__(self, machine: FilledMachine, speeds: Array, weights: Array) -> None:
        self.machine, self.speeds, self.weights = machine, speeds, weights / weights.sum()

    def exact(self, volumes: Array) -> Array:
        """See `Vibration`."""
        count = self.speeds.size
        pairs = self.machine.at(np.repeat(volumes, count, axis=0), np.tile(self.speeds, volumes.shape[0]))
        return np.asarray(pairs.amplitude.reshape(-1, count) @ self.weights)


class RunupPeak:
    """Largest amplitude of a run-up in time.

    Parameters
    ----------
    scene : with a table `runup`
    cells : round each wall; the scene's if None
    """

    def __init__(self, scene: Scene, cells: int | None = None) -> None:
        from leblanc.studies.runup import across_gravity, drive_of, liquid_model, numerics_of, planned

        plan = planned(scene)
        self.scene, self.drive, self.gravity = scene, drive_of(plan, scene.rotor), across_gravity(scene)
        self.numerics = numerics_of(plan, cells, check=False)
        self.model = runup_model(liquid_model(scene))
        self._known: dict[bytes, float] = {}

    def exact(self, volumes: Array) -> Array:
        """See `Vibration`; infinite for a run that did not come to its end."""
        return np.array([self._one(np.ascontiguousarray(row)) for row in volumes])

    def _one(self, volumes: Array) -> float:
        from leblanc.studies.drives import rotor_in_time
        from solvers.runup.runup import run_up

        key = volumes.tobytes()
        if key not in self._known:
            friction, fills = self.scene.model.friction, with_volumes(self.scene, volumes).fills
            system = rotor_in_time(self.scene)
            numerics, drive = self.numerics, self.drive
            run = run_up(system, fills, drive, friction, self.gravity, numerics, None, self.model)
            self._known[key] = float(run.largest.max()) if run.converged else math.inf
        return self._known[key]


class PeakOver:
    """Largest amplitude over a range of speeds, found between them as well [theory: optimum, eq. 3].

    Parameters
    ----------
    machine : with any volumes
    speeds : the range
    """

    def __init__(self, machine: FilledMachine, speeds: Speeds) -> None:
        self.machine, self.speeds = machine, speeds

    def exact(self, volumes: Array) -> Array:
        """See `Vibration`."""
        return self.machine.peaks(volumes, self.speeds)
