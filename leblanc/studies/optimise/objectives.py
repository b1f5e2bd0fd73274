"""What is to be small: vibrations over the volumes [theory: optimum, eq. 2-4].

At one speed or a mean over several, the largest over many without asking for all of them, and the largest of
a run-up in time; `robust` has the quantile over operating conditions.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from leblanc.scene.scene import Scene, Speeds
from leblanc.studies.optimise.answers import FilledMachine
from leblanc.studies.optimise.passages import Passages
from meshes.arrays import Array


class Vibration(Protocol):
    """A vibration that depends on the volumes of m sets, m^3, shape (m, c)."""

    def exact(self, volumes: Array) -> Array:
        """Vibration, m, shape (m,)."""
        ...


class AtSpeed:
    """Amplitude at one speed, or the weighted mean over several [theory: optimum, eq. 2]."""

    def __init__(self, machine: FilledMachine, speeds: Array, weights: Array) -> None:
        self.machine, self.speeds, self.weights = machine, speeds, weights / weights.sum()

    def exact(self, volumes: Array) -> Array:
        """See `Vibration`."""
        count = self.speeds.size
        pairs = self.machine.at(np.repeat(volumes, count, axis=0), np.tile(self.speeds, volumes.shape[0]))
        return np.asarray(pairs.amplitude.reshape(-1, count) @ self.weights)


class RunupPeak:
    """Largest amplitude of a run-up in time."""

    def __init__(self, scene: Scene, runs: Passages | None = None) -> None:
        self.runs = Passages(scene) if runs is None else runs

    def exact(self, volumes: Array) -> Array:
        """See `Vibration`; infinite for a run that did not come to its end."""
        return np.array([passage.amplitude for passage in self.runs.of(volumes)])


class PeakOver:
    """Largest amplitude over a range of speeds, found between them as well [theory: optimum, eq. 3]."""

    def __init__(self, machine: FilledMachine, speeds: Speeds) -> None:
        self.machine, self.speeds = machine, speeds

    def exact(self, volumes: Array) -> Array:
        """See `Vibration`."""
        return self.machine.peaks(volumes, self.speeds)
