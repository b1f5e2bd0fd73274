"""What is to be small, over the volumes [theory: optimum, eq. 2-4].

A vibration at one speed or a mean over several, the largest over many without asking for all of them, that
of a run-up in time; a load of the machine; `robust` has the quantile over operating conditions.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from leblanc.liquid.models import runup_model
from leblanc.scene.scene import Scene, Speeds
from leblanc.studies.loads.study import loaded_machine, loads_over_time, steady_power
from leblanc.studies.optimise.filled import FilledMachine, Once, with_volumes
from meshes.arrays import Array
from solvers.rotor.loads.turn import turn_extremes

LIMITED = ("floor_force", "walking_margin", "slip_margin", "point_clearance", "motor_torque")


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
        """Vibration, m, shape (m,)."""
        count = self.speeds.size
        pairs = self.machine.at(np.repeat(volumes, count, axis=0), np.tile(self.speeds, volumes.shape[0]))
        return np.asarray(pairs.amplitude.reshape(-1, count) @ self.weights)


class PeakOver:
    """Largest amplitude over a range of speeds, found between them as well [theory: optimum, eq. 3]."""

    def __init__(self, machine: FilledMachine, speeds: Speeds) -> None:
        self.machine, self.speeds = machine, speeds

    def exact(self, volumes: Array) -> Array:
        """As of a `Vibration`."""
        return self.machine.peaks(volumes, self.speeds)


@dataclass(frozen=True)
class WorstLoads:
    """The worst loads of a machine over a range of speeds, or over a run-up."""

    floor_force: float  #: largest under a foot, N; nan without a cabinet
    walking: float  #: least margins against walking and slipping; nan without a cabinet
    slip: float
    clearance: Array  #: least of each point, m, nan without a gap, shape (p,)
    motor_torque: float  #: largest of the drive, N m


@dataclass(frozen=True)
class Passage:
    """What a run-up is evaluated by."""

    amplitude: float  #: largest, m; infinite for a run that did not come to its end
    loads: WorstLoads | None  #: None where nobody asks, or the run did not come to its end


class Passages:
    """The run-ups of a scene in time, several at once on threads; no volumes are run twice."""

    def __init__(
        self, scene: Scene, cells: int | None = None, loaded: bool = False, threads: int = 1
    ) -> None:
        from leblanc.liquid.choose import across_gravity
        from leblanc.studies.drives import drive_of, numerics_of, planned
        from leblanc.studies.runup.study import liquid_model

        plan = planned(scene)
        self.scene, self.drive, self.gravity = scene, drive_of(plan, scene.rotor), across_gravity(scene)
        self.numerics = numerics_of(plan, cells, check=False)
        self.model, self.loaded = runup_model(liquid_model(scene)), loaded
        self.of = Once(self._one, threads)

    def _one(self, volumes: Array) -> Passage:
        from leblanc.studies.drives import rotor_in_time
        from solvers.runup.runup import run_up

        filled = with_volumes(self.scene, volumes)
        given = filled.fills, self.drive, self.scene.model.friction, self.gravity, self.numerics, None
        run = run_up(rotor_in_time(self.scene), *given, self.model, follow=self.loaded)
        if not run.converged:
            return Passage(math.inf, None)
        machine = loaded_machine(filled) if self.loaded else None
        found = None if machine is None else loads_over_time(filled, machine, run)
        if found is None:
            return Passage(float(run.largest.max()), None)
        worst = found.worst
        loads = WorstLoads(
            floor_force=float(np.fmax.reduce(worst.floor_force, axis=None)) if found.stands else math.nan,
            walking=float(np.fmin.reduce(worst.walking)),
            slip=float(np.fmin.reduce(worst.slip)),
            clearance=np.asarray(worst.clearance.min(axis=0)),
            motor_torque=float(found.torque.max()),
        )
        return Passage(float(run.largest.max()), loads)


class RunupPeak:
    """Largest amplitude of a run-up in time; infinite for a run that did not come to its end."""

    def __init__(self, scene: Scene, runs: Passages | None = None) -> None:
        self.runs = Passages(scene) if runs is None else runs

    def exact(self, volumes: Array) -> Array:
        """As of a `Vibration`."""
        return np.array([passage.amplitude for passage in self.runs.of(volumes)])


class LoadsOver:
    """The worst loads of a machine with any volumes [theory: loads, eq. 9-11].

    Over a range of speeds, the largest amplitudes between them included (None: its run-ups alone), and over
    its run-ups (None: steady turns alone); `least` is the clearance that every point with a gap keeps, m.
    """

    def __init__(
        self,
        machine: FilledMachine,
        speeds: Speeds | None,
        least: float = 0.0,
        runs: Passages | None = None,
    ) -> None:
        self.machine, self.speeds, self.least, self.runs = machine, speeds, least, runs
        self._each = Once(self._one)

    def of(self, name: str, volumes: Array) -> Array:
        """A load with m sets of volumes; infinite for a run-up that did not come to its end, shape (m,).

        Margins as the share of its hold on the floor that the machine uses, clearances as the share of its
        room that a point takes.
        """
        return np.array([found[name] for found in self._each(volumes)])

    def _one(self, volumes: Array) -> dict[str, float]:
        """Every load with one set of volumes, the worse of steady turns and run-up."""
        every = list(self._loads(volumes))
        if any(loads is None for loads in every):
            return dict.fromkeys(LIMITED, math.inf)
        parts = [self._sizes(loads) for loads in every if loads is not None]
        return {name: float(np.max([part[name] for part in parts])) for name in LIMITED}

    def _loads(self, volumes: Array) -> Iterator[WorstLoads | None]:
        """Of steady turns and of the run-up, where they count; None for a run-up that was not finished."""
        if self.runs is not None:
            (passage,) = self.runs.of(volumes[None])
            yield passage.loads
        if self.speeds is None:
            return
        machine = loaded_machine(with_volumes(self.machine.scene, volumes))
        assert machine is not None
        answer = self.machine.answer_over(volumes, self.speeds)
        worst = turn_extremes(machine, answer.coordinates, answer.speed)
        friction = self.machine.scene.model.friction
        torque = steady_power(machine, friction, answer.coordinates, answer.speed) / answer.speed
        yield WorstLoads(
            floor_force=math.nan if machine.cabinet is None else float(worst.floor_force.max()),
            walking=float(worst.walking.min()),
            slip=float(worst.slip.min()),
            clearance=np.asarray(worst.clearance.min(axis=0)),
            motor_torque=float(np.nan_to_num(torque, nan=math.inf).max()),
        )

    def _sizes(self, loads: WorstLoads) -> dict[str, float]:
        """The loads as `of` gives them."""
        gaps = np.array([np.nan if point.gap is None else point.gap for point in self.machine.scene.points])
        known = np.flatnonzero(~np.isnan(gaps))
        taken = (gaps - loads.clearance)[known] / np.maximum(gaps[known] - self.least, 1e-12)
        return {
            "floor_force": loads.floor_force,
            "walking_margin": 1.0 - loads.walking,
            "slip_margin": 1.0 - loads.slip,
            "point_clearance": float(np.max(taken, initial=0.0)),
            "motor_torque": loads.motor_torque,
        }


@dataclass(frozen=True)
class Load:
    """One of the loads of a machine in place of a vibration."""

    over: LoadsOver  #: all of its loads
    name: str  #: as for `LoadsOver.of`

    def exact(self, volumes: Array) -> Array:
        """As of a `Vibration`."""
        return self.over.of(self.name, volumes)

    def on(self, runs: Passages) -> Load:
        """The same with other run-ups; itself where none count."""
        over = self.over
        return (
            self
            if over.runs is None
            else Load(LoadsOver(over.machine, over.speeds, over.least, runs), self.name)
        )
