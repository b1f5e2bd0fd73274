"""Forces on the floor, walking and clearances of a machine over its volumes, as objective and constraints."""

from __future__ import annotations

import math

import numpy as np

from leblanc.scene.scene import Scene, Speeds
from leblanc.scene.tasks import Optimisation
from leblanc.studies.machine import loaded_machine
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from leblanc.studies.optimise.constraints import Constraint
from leblanc.units import LENGTH, with_unit
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.loads.turn import turn_extremes

_FORCE, _USED, _REACH = range(3)
_LIMITS = ("floor_force", "walking_margin", "point_clearance")


def limits_loads(task: Optimisation) -> bool:
    """Whether the task limits a force, the walking margin or clearances: each takes a response over speeds.

    Parameters
    ----------
    task : what the liquid is chosen for
    """
    return any(getattr(task, name) is not None for name in _LIMITS)


class LoadsOver:
    """The worst loads of a machine with any volumes over a range of speeds [theory: loads, eq. 9-11].

    Parameters
    ----------
    machine : with any volumes
    speeds : the range; the largest amplitudes between them are looked at as well
    least : clearance that every point with a gap is to keep, m
    """

    def __init__(self, machine: FilledMachine, speeds: Speeds, least: float = 0.0) -> None:
        self.machine, self.speeds, self.least = machine, speeds, least
        self._known: dict[bytes, tuple[float, float, float]] = {}

    def exact(self, volumes: Array) -> Array:
        """Largest force under a foot, N, shape (m,): a `leblanc.studies.optimise.objectives.Vibration`."""
        return self._all(volumes)[:, _FORCE]

    def used(self, volumes: Array) -> Array:
        """Share of its hold on the floor that the machine uses: 1 less the margin against walking, (m,)."""
        return self._all(volumes)[:, _USED]

    def reach(self, volumes: Array) -> Array:
        """Largest share that a point takes of the room up to its least clearance, shape (m,)."""
        return self._all(volumes)[:, _REACH]

    def _all(self, volumes: Array) -> Array:
        for row in np.ascontiguousarray(volumes):
            if row.tobytes() not in self._known:
                self._known[row.tobytes()] = self._one(row)
        keys = [row.tobytes() for row in np.ascontiguousarray(volumes)]
        return np.array([self._known[key] for key in keys]).reshape(-1, 3)

    def _one(self, volumes: Array) -> tuple[float, float, float]:
        """Force, use and reach with one set of volumes."""
        filled = with_volumes(self.machine.scene, volumes)
        machine = loaded_machine(filled)
        assert machine is not None
        answer = self.machine.answer_over(volumes, self.speeds)
        worst = turn_extremes(machine, answer.coordinates, answer.speed)
        room = np.array([np.nan if point.gap is None else point.gap for point in machine.points])
        share = [0.0]
        for k in np.flatnonzero(~np.isnan(room)).tolist():
            left = max(float(room[k]) - self.least, 1e-12)
            share.append(float((room[k] - worst.clearance[:, k]).max()) / left)
        if machine.cabinet is None:
            return math.nan, math.nan, max(share)
        return float(worst.floor_force.max()), 1.0 - float(worst.walking.min()), max(share)


def load_constraints(
    scene: Scene, task: Optimisation, machine: FilledMachine, speeds: Speeds
) -> list[Constraint]:
    """What the task limits of forces, walking and clearances.

    Parameters
    ----------
    scene, task : the machine and what its liquid is chosen for
    machine : the same with any volumes
    speeds : at which it is used

    Raises
    ------
    InputError : a limit of what the scene does not have
    """
    require_loads(scene, task)
    over, where = LoadsOver(machine, speeds, task.point_clearance or 0.0), "at the operating speeds"
    found = []
    if task.floor_force is not None:
        text, limit = f"largest force under a foot {where}", task.floor_force
        found.append(Constraint("floor_force", text, "N", limit, limit, over.exact))
    if task.walking_margin is not None:
        text = f"share of its hold on the floor that the machine uses {where}, 1 less the walking margin"
        found.append(Constraint("walking_margin", text, "1", 1.0 - task.walking_margin, 1.0, over.used))
    if task.point_clearance is not None:
        left = with_unit(task.point_clearance, LENGTH)
        text = f"largest share that a point takes {where} of its gap less {left}"
        found.append(Constraint("point_clearance", text, "1", 1.0, 1.0, over.reach))
    return found


def require_loads(scene: Scene, task: Optimisation) -> None:
    """Refuse what needs a cabinet or points that the scene does not have, or goes another way.

    Parameters
    ----------
    scene, task : the machine and what its liquid is chosen for

    Raises
    ------
    InputError : such a limit or objective
    """
    limits = [name for name in _LIMITS if getattr(task, name) is not None]
    if task.deflection is not None and limits:
        name = f"optimise.{limits[0]}"
        raise InputError(name, getattr(task, limits[0]), "left out where optimise.deflection is given")
    if task.objective == "floor_force" and scene.cabinet is None:
        raise InputError("optimise.objective", task.objective, "another one: the scene has no [cabinet]")
    for name in limits:
        if name != "point_clearance" and scene.cabinet is None:
            raise InputError(f"optimise.{name}", getattr(task, name), "left out: the scene has no [cabinet]")
    if task.point_clearance is not None:
        gaps = [point.gap for point in scene.points if point.gap is not None]
        if not gaps or min(gaps) <= task.point_clearance:
            text = "below the gap of every point in [[points]], at least one of which has a gap"
            raise InputError("optimise.point_clearance", task.point_clearance, text)
