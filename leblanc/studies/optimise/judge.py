"""The goal of an optimisation: the judge of volumes and what to tell of it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from leblanc.scene.optimise import OBJECTIVES, Optimisation
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds
from leblanc.studies.optimise.answers import FilledMachine
from leblanc.studies.optimise.conditions import Robust, circumstances
from leblanc.studies.optimise.constraints import (
    Constraint,
    FillJudge,
    clearance,
    dry_wall,
    limited,
    room_when_warm,
    stability,
)
from leblanc.studies.optimise.objectives import AtSpeed, PeakOver, RunupPeak, Vibration
from leblanc.units import MM, RPM
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.search import Found

COARSE_CELLS = 64  # of a run-up while the search goes on
GROWTH_SPEEDS = 65  # at which the growth of small whirls is looked at
_SLACK = 1.01  # default limit of the vibration over the least that is possible
_DOUBLE = (0.5, 2.0)  # default range of unbalances over the scene's


@dataclass(frozen=True)
class Goal:
    """What an optimisation is after.

    Parameters
    ----------
    judge : of volumes
    meaning : what the value is, in words
    working_speed : rad/s
    speeds : that matter most, rad/s
    costly : one answer takes tens of milliseconds and more
    notes : what was assumed, in words
    """

    judge: FillJudge
    meaning: str
    working_speed: float
    speeds: tuple[float, ...]
    costly: bool
    notes: tuple[str, ...] = ()


def operating_speeds(scene: Scene, aim: Optimisation) -> Speeds:
    """Speeds at which the machine is used: the scene's, or evenly over the range given."""
    if aim.operating is None:
        return scene.speeds
    start, stop = aim.operating
    return Speeds(start=start, stop=stop, count=1 if start == stop else max(2, scene.speeds.count))


def growth_speeds(scene: Scene, aim: Optimisation) -> Array:
    """Operating speeds at which small whirls are looked at, rad/s."""
    speeds = operating_speeds(scene, aim)
    return np.linspace(speeds.start, speeds.stop, min(speeds.count, GROWTH_SPEEDS))


def goal_of(scene: Scene, aim: Optimisation, machine: FilledMachine, solve: Callable[[Goal], Found]) -> Goal:
    """Goal of a scene.

    Parameters
    ----------
    scene, aim : the machine and what is asked for
    machine : the same with any volumes
    solve : gives the best volumes for another goal, on the way to this one

    Raises
    ------
    InputError : no such objective, or one that lacks something
    """
    if aim.objective not in OBJECTIVES:
        raise InputError("--objective", aim.objective, "one of " + ", ".join(OBJECTIVES))
    speed = scene.speeds.stop if aim.working_speed is None else aim.working_speed
    planar = isinstance(scene.rotor, JeffcottRotor)
    density = np.array([fill.liquid.density for fill in scene.fills])
    at_work = AtSpeed(machine, np.array([speed]), np.ones(1))
    constraints = _constraints(scene, aim, machine, speed)
    rpm = f"{speed * RPM:.4g} rpm"
    goal = Goal(FillJudge(at_work, density, constraints), f"amplitude at {rpm}", speed, (speed,), not planar)
    return _MAKERS[aim.objective](scene, aim, machine, goal, solve)


def _constraints(
    scene: Scene, aim: Optimisation, machine: FilledMachine, speed: float
) -> tuple[Constraint, ...]:
    """What was asked to be kept to."""
    found = [] if aim.dry_patch else [dry_wall(machine, speed)]
    if aim.stability_margin is not None:
        found.append(stability(scene, growth_speeds(scene, aim), aim.stability_margin))
    if aim.clearance is not None:
        found.append(clearance(PeakOver(machine, operating_speeds(scene, aim)), aim.clearance))
    return tuple(found)


_Make = Callable[[Scene, Optimisation, FilledMachine, Goal, Callable[[Goal], Found]], Goal]


def _working_speed(scene: Scene, aim: Optimisation, machine: FilledMachine, goal: Goal, _: object) -> Goal:
    return goal


def _peak(scene: Scene, aim: Optimisation, machine: FilledMachine, goal: Goal, _: object) -> Goal:
    if scene.runup is not None and not aim.steady:
        few = min(COARSE_CELLS, scene.runup.cells)
        text = "largest amplitude of the run-up in time"
        note = (
            f"The search ran the machine up with {few} cells round each wall; the best volumes were run "
            f"again with the scene's {scene.runup.cells}."
        )
        judge = replace(goal.judge, vibration=RunupPeak(scene, few))
        notes = (note,) if few < scene.runup.cells else ()
        return replace(goal, judge=judge, meaning=text, costly=True, notes=notes)
    speeds = scene.speeds
    text = f"largest steady amplitude from {speeds.start * RPM:.4g} to {speeds.stop * RPM:.4g} rpm"
    judge = replace(goal.judge, vibration=PeakOver(machine, speeds))
    return replace(goal, judge=judge, meaning=text, speeds=(speeds.stop, *_resonances(scene)))


def _resonances(scene: Scene) -> tuple[float, ...]:
    """Critical speeds of a planar rotor with all walls wet and without liquid, rad/s."""
    if not isinstance(scene.rotor, JeffcottRotor):
        return ()
    rotor = scene.rotor.machine()
    added = sum(fill.added_mass for fill in scene.fills)
    return math.sqrt(rotor.stiffness / (rotor.mass + added)), math.sqrt(rotor.stiffness / rotor.mass)


def _mean(scene: Scene, aim: Optimisation, machine: FilledMachine, goal: Goal, _: object) -> Goal:
    if aim.duty:
        speeds, weights = np.array([(one.speed, one.weight) for one in aim.duty]).T
        text, notes = f"mean amplitude over a duty cycle of {len(aim.duty)} speeds", goal.notes
    else:
        speeds = scene.speed_array()
        weights = np.ones(speeds.size)
        text = f"mean amplitude over {speeds.size} speeds, all alike"
        notes = (*goal.notes, "No duty cycle is given: the mean is over the scene's speeds, all alike.")
    judge = replace(goal.judge, vibration=AtSpeed(machine, speeds, weights))
    heaviest = speeds[np.argsort(-weights, kind="stable")][:3].tolist()
    return replace(goal, judge=judge, meaning=text, speeds=tuple(heaviest), notes=notes)


def _least_mass(
    scene: Scene, aim: Optimisation, machine: FilledMachine, goal: Goal, solve: Callable[[Goal], Found]
) -> Goal:
    vibration: Vibration = goal.judge.vibration
    where = f"at {goal.working_speed * RPM:.4g} rpm"
    if aim.limit_at == "operating":
        vibration, where = PeakOver(machine, operating_speeds(scene, aim)), "at the operating speeds"
    limit, notes = aim.vibration_limit, goal.notes
    if limit is None:
        least = solve(replace(goal, judge=replace(goal.judge, vibration=vibration))).objective
        limit = _SLACK * least
        share = f"{limit * MM:.4g} mm, one per cent above the least possible"
        notes = (*notes, f"No vibration limit is given: taken is {share}.")
    bound = limited("vibration", f"amplitude {where}", vibration, limit)
    judge = replace(
        goal.judge,
        vibration=vibration,
        constraints=(*goal.judge.constraints, bound),
        by_mass=True,
        best=math.inf,
    )
    text = f"liquid's mass for an amplitude of at most {limit * MM:.4g} mm {where}"
    return replace(goal, judge=judge, meaning=text, notes=notes)


def _robust(scene: Scene, aim: Optimisation, machine: FilledMachine, goal: Goal, _: object) -> Goal:
    if not isinstance(scene.rotor, JeffcottRotor):
        raise InputError("rotor.kind", scene.rotor.kind, "jeffcott for the objective robust")
    notes, unbalance = goal.notes, aim.unbalance
    if unbalance is None and aim.temperature is None:
        low, high = _DOUBLE
        unbalance = low * scene.rotor.unbalance, high * scene.rotor.unbalance
        notes = (*notes, "No range is given: taken are unbalances from half to twice the scene's.")
    around = circumstances(scene.rotor.unbalance, unbalance, aim.temperature, aim.samples, aim.seed)
    vibration = Robust(scene, goal.working_speed, around, aim.quantile)
    constraints = goal.judge.constraints
    if aim.temperature is not None:
        constraints = (*constraints, room_when_warm(vibration))
    kind = "worst" if aim.quantile == 1.0 else f"{aim.quantile:.4g} quantile of the"
    ranges = [name for name, one in (("unbalance", unbalance), ("temperature", aim.temperature)) if one]
    text = (
        f"{kind} amplitude at {goal.working_speed * RPM:.4g} rpm over {len(around)} circumstances of "
        + " and ".join(ranges)
    )
    judge = replace(goal.judge, vibration=vibration, constraints=constraints)
    return replace(goal, judge=judge, meaning=text, notes=notes)


_MAKERS: dict[str, _Make] = {
    "working_speed": _working_speed,
    "peak": _peak,
    "mean": _mean,
    "least_mass": _least_mass,
    "robust": _robust,
}
