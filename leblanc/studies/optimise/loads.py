"""Loads of a machine over its volumes, as objectives and constraints: floor, walking, clearances, motor.

They are those of steady turns over a range of speeds, of a run-up in time, or the worse of both.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from leblanc.core.units import LENGTH, over_rpm, with_unit
from leblanc.scene.scene import Scene, Speeds
from leblanc.scene.tasks import LOADS, Optimisation
from leblanc.studies.loads.study import loaded_machine, steady_power
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from leblanc.studies.optimise.constraints import Constraint
from leblanc.studies.optimise.passages import Passages, WorstLoads
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.loads.turn import turn_extremes

_LIMITS = ("floor_force", "walking_margin", "slip_margin", "point_clearance", "motor_torque")
_ON_FEET = ("floor_force", "walking_margin", "slip_margin")
UNITS = {"floor_force": "N", "motor_torque": "N m"}  # of the others 1


def limits_loads(task: Optimisation) -> bool:
    """Whether the task limits a load: each takes a response over speeds, or a run-up."""
    return any(getattr(task, name) is not None for name in _LIMITS)


def loads_in_time(task: Optimisation) -> bool:
    """Whether loads are looked at over the run-up."""
    return task.loads_over != "operating" and (limits_loads(task) or task.objective in LOADS)


class LoadsOver:
    """The worst loads of a machine with any volumes [theory: loads, eq. 9-11].

    Over a range of speeds, the largest amplitudes between them included (None: its run-ups alone), and over
    its run-ups (None: steady turns alone); `least` is the clearance that every point with a gap is to keep,
    m.
    """

    def __init__(
        self,
        machine: FilledMachine,
        speeds: Speeds | None,
        least: float = 0.0,
        runs: Passages | None = None,
    ) -> None:
        self.machine, self.speeds, self.least, self.runs = machine, speeds, least, runs
        self._known: dict[bytes, dict[str, float]] = {}

    def on(self, runs: Passages) -> LoadsOver:
        """The same with other run-ups."""
        return LoadsOver(self.machine, self.speeds, self.least, runs)

    def of(self, name: str, volumes: Array) -> Array:
        """A load with m sets of volumes; infinite for a run-up that did not come to its end, shape (m,).

        Margins as the share of its hold on the floor that the machine uses, clearances as the share of its
        room that a point takes.
        """
        found = []
        for row in np.ascontiguousarray(volumes):
            if row.tobytes() not in self._known:
                self._known[row.tobytes()] = self._one(row)
            found.append(self._known[row.tobytes()][name])
        return np.array(found)

    def _one(self, volumes: Array) -> dict[str, float]:
        """Every load with one set of volumes, the worse of steady turns and run-up."""
        every = list(self._loads(volumes))
        if any(loads is None for loads in every):
            return dict.fromkeys(_LIMITS, math.inf)
        parts = [self._sizes(loads) for loads in every if loads is not None]
        return {name: float(np.max([part[name] for part in parts])) for name in _LIMITS}

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
    """One of the loads of a machine: a `leblanc.studies.optimise.objectives.Vibration`."""

    over: LoadsOver  #: all of its loads
    name: str  #: as for `LoadsOver.of`

    def exact(self, volumes: Array) -> Array:
        """The load with m sets of volumes, m^3, shape (m, c); shape (m,)."""
        return self.over.of(self.name, volumes)

    def on(self, runs: Passages) -> Load:
        """The same with other run-ups; itself where none count."""
        return self if self.over.runs is None else replace(self, over=self.over.on(runs))


class LoadLimit(Constraint):
    """A limit of a load."""

    def __init__(self, load: Load, meaning: str, limit: float, scale: float) -> None:
        super().__init__(load.name, meaning, UNITS.get(load.name, "1"), limit, scale, load.exact)
        self.load = load

    def on(self, runs: Passages) -> LoadLimit:
        """The same with other run-ups."""
        return LoadLimit(self.load.on(runs), self.meaning, self.limit, self.scale)


def loads_of(
    task: Optimisation, machine: FilledMachine, speeds: Speeds, runs: Passages | None, least: float = 0.0
) -> LoadsOver:
    """The loads that a task looks at."""
    return LoadsOver(machine, None if task.loads_over == "runup" else speeds, least, runs)


def load_constraints(
    scene: Scene, task: Optimisation, machine: FilledMachine, speeds: Speeds, runs: Passages | None = None
) -> list[Constraint]:
    """What the task limits of forces, walking, clearances and the motor."""
    require_loads(scene, task)
    over, where = loads_of(task, machine, speeds, runs, task.point_clearance or 0.0), load_place(task)
    found: list[Constraint] = []
    if task.floor_force is not None:
        text, limit = f"largest force under a foot {where}", task.floor_force
        found.append(LoadLimit(Load(over, "floor_force"), text, limit, limit))
    for name, margin, words in (
        ("walking_margin", task.walking_margin, "walking"),
        ("slip_margin", task.slip_margin, "slip"),
    ):
        if margin is not None:
            text = f"share of its hold on the floor that the machine uses {where}, 1 less the {words} margin"
            found.append(LoadLimit(Load(over, name), text, 1.0 - margin, 1.0))
    if task.point_clearance is not None:
        left = with_unit(task.point_clearance, LENGTH)
        text = f"largest share that a point takes {where} of its gap less {left}"
        found.append(LoadLimit(Load(over, "point_clearance"), text, 1.0, 1.0))
    if task.motor_torque is not None:
        text, limit = f"largest torque of the motor {where}", task.motor_torque
        found.append(LoadLimit(Load(over, "motor_torque"), text, limit, limit))
    return found


def load_place(task: Optimisation, speeds: Speeds | None = None) -> str:
    """Where the loads of a task are looked at, in words."""
    steady = "at the operating speeds"
    if speeds is not None:
        steady = over_rpm(speeds.start, speeds.stop)
    in_time = "over the run-up in time"
    return {"operating": steady, "runup": in_time, "both": f"{steady} and {in_time}"}[task.loads_over]


_MEANING = {
    "floor_force": "largest force under a foot",
    "walking_margin": "share of its hold on the floor that the machine uses, 1 less the walking margin,",
    "point_clearance": "largest share that a point takes of its gap",
    "motor_torque": "largest torque of the motor",
}


def load_meaning(task: Optimisation, speeds: Speeds) -> str:
    """What an objective that is a load means, in words."""
    return f"{_MEANING[task.objective]} {load_place(task, speeds)}"


def require_loads(scene: Scene, task: Optimisation) -> None:
    """Refuse what needs a cabinet, points or a run-up that the scene does not have, or goes another way."""
    limits = [name for name in _LIMITS if getattr(task, name) is not None]
    if task.deflection is not None and limits:
        name = f"optimise.{limits[0]}"
        raise InputError(name, getattr(task, limits[0]), "left out where optimise.deflection is given")
    for name in [*limits, *([task.objective] if task.objective in LOADS else [])]:
        asked = name in limits
        field = f"optimise.{name if asked else 'objective'}"
        value, way = (getattr(task, name), "left out") if asked else (name, "another one")
        if name in _ON_FEET and scene.cabinet is None:
            raise InputError(field, value, f"{way}: the scene has no [cabinet]")
        if name == "motor_torque" and loaded_machine(scene) is None:
            text = f"{way}: the scene has no [cabinet], [[points]] or [[rotor.bearings]]"
            raise InputError(field, value, text)
        if name == "point_clearance" and not _has_room(scene, task.point_clearance or 0.0):
            text = "below the gap of every point in [[points]], at least one of which has a gap"
            raise InputError(field, value, text if asked else f"{way}: no point in [[points]] has a gap")
    if loads_in_time(task) and scene.speed_plan is None:
        text = "operating: the scene has no table [runup] or [programme]"
        raise InputError("optimise.loads_over", task.loads_over, text)


def _has_room(scene: Scene, least: float) -> bool:
    """Some points have gaps, all of them larger than a clearance, m."""
    gaps = [point.gap for point in scene.points if point.gap is not None]
    return bool(gaps) and min(gaps) > least
