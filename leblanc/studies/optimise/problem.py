"""The problem of an optimisation: objective and constraints at sets of volumes [theory: optimum]."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from leblanc.results import optimum
from leblanc.results.base import Note
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds
from leblanc.scene.tasks import OBJECTIVES, Optimisation
from leblanc.studies.optimise.answers import FilledMachine
from leblanc.studies.optimise.constraints import (
    BEYOND,
    Constraint,
    clearance,
    dry_wall,
    limited,
    room_when_warm,
    stability,
)
from leblanc.studies.optimise.objectives import AtSpeed, PeakOver, RunupPeak, Vibration
from leblanc.studies.optimise.robust import Robust, operating_conditions
from leblanc.units import MM, RPM
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.search import Found, Judgement

COARSE_CELLS = 64  # of a run-up while the search goes on
GROWTH_SPEEDS = 65  # at which the growth of small whirls is looked at
_SLACK = 1.01  # default limit of the vibration over the least that is possible
_DOUBLE = (0.5, 2.0)  # default range of unbalances over the scene's


@dataclass
class Evaluator:
    """Evaluates sets of volumes: a vibration, or their mass, and constraints.

    Parameters
    ----------
    vibration : to be small
    density : of each chamber's liquid, kg/m^3, shape (c,)
    constraints : to keep to
    by_mass : the liquid's mass is to be small; the vibration is then one of the constraints
    best : least objective of any allowed volumes so far, above which an estimate will do
    """

    vibration: Vibration
    density: Array
    constraints: tuple[Constraint, ...]
    by_mass: bool = False
    best: float = field(default=math.inf)

    def __call__(self, volumes: Array) -> Judgement:
        """Evaluate m sets of volumes, m^3, shape (m, c).

        Its details are the values of the constraints, the mass, the vibration, and whether that is sure (1)
        or an estimate from below (0).
        """
        found = {constraint.name: constraint.value(volumes) for constraint in self.constraints}
        over = np.full(volumes.shape[0], -1.0)
        for constraint in self.constraints:
            over = np.maximum(over, constraint.excess(found[constraint.name]))
        mass = volumes @ self.density
        if self.by_mass:
            objective, vibration = mass, found["vibration"]
            limit = next(one.limit for one in self.constraints if one.name == "vibration")
            sure = vibration <= BEYOND * limit
        else:
            vibration, sure = self.vibration.least(volumes, self.best)
            objective = vibration
        self.best = min(self.best, float(objective[sure & (over <= 0.0)].min(initial=math.inf)))
        extra = {"mass": mass, "vibration": vibration, "sure": sure.astype(float)}
        return Judgement(objective, over, found | extra)


@dataclass(frozen=True)
class Problem:
    """What an optimisation is after.

    Parameters
    ----------
    evaluate : objective and constraints at sets of volumes
    meaning : what the value is, in words
    working_speed : rad/s
    speeds : that matter most, rad/s
    costly : one answer takes tens of milliseconds and more
    notes : what was assumed
    """

    evaluate: Evaluator
    meaning: str
    working_speed: float
    speeds: tuple[float, ...]
    costly: bool
    notes: tuple[Note, ...] = ()


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


def problem_of(
    scene: Scene, aim: Optimisation, machine: FilledMachine, solve: Callable[[Problem], Found]
) -> Problem:
    """The problem that a scene poses.

    Parameters
    ----------
    scene, aim : the machine and what is asked for
    machine : the same with any volumes
    solve : gives the best volumes for another problem, on the way to this one

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
    evaluate = Evaluator(at_work, density, constraints)
    problem = Problem(evaluate, f"amplitude at {rpm}", speed, (speed,), not planar)
    return _MAKERS[aim.objective](scene, aim, machine, problem, solve)


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


_Make = Callable[[Scene, Optimisation, FilledMachine, Problem, Callable[[Problem], Found]], Problem]


def _working_speed(
    scene: Scene, aim: Optimisation, machine: FilledMachine, problem: Problem, _: object
) -> Problem:
    return problem


def _peak(scene: Scene, aim: Optimisation, machine: FilledMachine, problem: Problem, _: object) -> Problem:
    if scene.runup is not None and not aim.steady:
        few = min(COARSE_CELLS, scene.runup.cells)
        text = "largest amplitude of the run-up in time"
        evaluate = replace(problem.evaluate, vibration=RunupPeak(scene, few))
        fewer = optimum.few_cells(few, scene.runup.cells)
        notes = (fewer,) if few < scene.runup.cells else ()
        return replace(problem, evaluate=evaluate, meaning=text, costly=True, notes=notes)
    speeds = scene.speeds
    text = f"largest steady amplitude from {speeds.start * RPM:.4g} to {speeds.stop * RPM:.4g} rpm"
    evaluate = replace(problem.evaluate, vibration=PeakOver(machine, speeds))
    return replace(problem, evaluate=evaluate, meaning=text, speeds=(speeds.stop, *_resonances(scene)))


def _resonances(scene: Scene) -> tuple[float, ...]:
    """Critical speeds of a planar rotor with all walls wet and without liquid, rad/s."""
    if not isinstance(scene.rotor, JeffcottRotor):
        return ()
    rotor = scene.rotor.machine()
    added = sum(fill.added_mass for fill in scene.fills)
    return math.sqrt(rotor.stiffness / (rotor.mass + added)), math.sqrt(rotor.stiffness / rotor.mass)


def _mean(scene: Scene, aim: Optimisation, machine: FilledMachine, problem: Problem, _: object) -> Problem:
    if aim.duty:
        speeds, weights = np.array([(one.speed, one.weight) for one in aim.duty]).T
        text, notes = f"mean amplitude over a duty cycle of {len(aim.duty)} speeds", problem.notes
    else:
        speeds = scene.speed_array()
        weights = np.ones(speeds.size)
        text = f"mean amplitude over {speeds.size} speeds, all alike"
        notes = (*problem.notes, optimum.no_duty())
    evaluate = replace(problem.evaluate, vibration=AtSpeed(machine, speeds, weights))
    heaviest = speeds[np.argsort(-weights, kind="stable")][:3].tolist()
    return replace(problem, evaluate=evaluate, meaning=text, speeds=tuple(heaviest), notes=notes)


def _least_mass(
    scene: Scene,
    aim: Optimisation,
    machine: FilledMachine,
    problem: Problem,
    solve: Callable[[Problem], Found],
) -> Problem:
    vibration: Vibration = problem.evaluate.vibration
    where = f"at {problem.working_speed * RPM:.4g} rpm"
    if aim.limit_at == "operating":
        vibration, where = PeakOver(machine, operating_speeds(scene, aim)), "at the operating speeds"
    limit, notes = aim.vibration_limit, problem.notes
    if limit is None:
        least = solve(replace(problem, evaluate=replace(problem.evaluate, vibration=vibration))).objective
        limit = _SLACK * least
        notes = (*notes, optimum.no_limit(limit))
    bound = limited("vibration", f"amplitude {where}", vibration, limit)
    evaluate = replace(
        problem.evaluate,
        vibration=vibration,
        constraints=(*problem.evaluate.constraints, bound),
        by_mass=True,
        best=math.inf,
    )
    text = f"liquid's mass for an amplitude of at most {limit * MM:.4g} mm {where}"
    return replace(problem, evaluate=evaluate, meaning=text, notes=notes)


def _robust(scene: Scene, aim: Optimisation, machine: FilledMachine, problem: Problem, _: object) -> Problem:
    if not isinstance(scene.rotor, JeffcottRotor):
        raise InputError("rotor.kind", scene.rotor.kind, "jeffcott for the objective robust")
    notes, unbalance = problem.notes, aim.unbalance
    if unbalance is None and aim.temperature is None:
        low, high = _DOUBLE
        unbalance = low * scene.rotor.unbalance, high * scene.rotor.unbalance
        notes = (*notes, optimum.no_range())
    around = operating_conditions(scene.rotor.unbalance, unbalance, aim.temperature, aim.samples, aim.seed)
    vibration = Robust(scene, problem.working_speed, around, aim.quantile)
    constraints = problem.evaluate.constraints
    if aim.temperature is not None:
        constraints = (*constraints, room_when_warm(vibration))
    kind = "worst" if aim.quantile == 1.0 else f"{aim.quantile:.4g} quantile of the"
    ranges = [name for name, one in (("unbalance", unbalance), ("temperature", aim.temperature)) if one]
    text = (
        f"{kind} amplitude at {problem.working_speed * RPM:.4g} rpm over {len(around)} circumstances of "
        + " and ".join(ranges)
    )
    evaluate = replace(problem.evaluate, vibration=vibration, constraints=constraints)
    return replace(problem, evaluate=evaluate, meaning=text, notes=notes)


_MAKERS: dict[str, _Make] = {
    "working_speed": _working_speed,
    "peak": _peak,
    "mean": _mean,
    "least_mass": _least_mass,
    "robust": _robust,
}
