"""The problem of an optimisation: objective and constraints at sets of volumes [theory: optimum, eq. 5]."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from leblanc.core.notes import Note
from leblanc.core.units import LENGTH, in_rpm, over_rpm, with_unit
from leblanc.results import optimum
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds
from leblanc.scene.tasks import LOADS, OBJECTIVES, Optimisation
from leblanc.scene.unbalances import unbalances_of
from leblanc.studies.optimise.answers import FilledMachine
from leblanc.studies.optimise.balance import QualityAtSpeed
from leblanc.studies.optimise.constraints import (
    Constraint,
    balanced,
    clearance,
    dry_wall,
    growth,
    limited,
    room_when_warm,
    spill,
    stability,
    wetting,
    whirl_friction,
    whirl_size,
)
from leblanc.studies.optimise.loads import (
    UNITS,
    Load,
    LoadLimit,
    limits_loads,
    load_constraints,
    load_meaning,
    loads_in_time,
    loads_of,
)
from leblanc.studies.optimise.objectives import (
    AtSpeed,
    PeakOver,
    RunupPeak,
    Vibration,
)
from leblanc.studies.optimise.passages import Passages
from leblanc.studies.optimise.robust import (
    DOUBLE,
    Robust,
    UnbalanceRange,
    filled_scenes,
    operating_conditions,
    unbalance_range,
)
from leblanc.studies.optimise.walls import most_cells
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.search import Found, Judgement

_COARSE_CELLS = 64  # of a run-up while the search goes on
_GROWTH_SPEEDS = 65  # at which the growth of small whirls is looked at
_SLACK = 1.01  # default limit of the vibration over the least that is possible


@dataclass(frozen=True)
class Evaluator:
    """Evaluates sets of volumes: a vibration, or their mass, and constraints."""

    vibration: Vibration  #: to be small
    density: Array  #: of each chamber's liquid, kg/m^3, shape (c,)
    constraints: tuple[Constraint, ...]  #: to keep to
    by_mass: bool = False  #: the liquid's mass is to be small; the vibration is then one of the constraints
    estimated: bool = False  #: the vibration is an estimate, by an emulator
    sized: Load | None = None  #: load that is to be small in place of the vibration
    #: run-ups in time by which vibration, loads or both are judged; None where none are
    runs: Passages | None = None

    @property
    def unit(self) -> str:
        """Unit of what is made small."""
        if self.by_mass:
            return "kg"
        return "m" if self.sized is None else UNITS.get(self.sized.name, "1")

    def on(self, scene: Scene, runs: Passages) -> Evaluator:
        """The same with other run-ups."""
        in_time = isinstance(self.vibration, RunupPeak)
        return replace(
            self,
            runs=runs,
            vibration=RunupPeak(scene, runs) if in_time else self.vibration,
            constraints=tuple(
                own.on(runs) if isinstance(own, LoadLimit) else own for own in self.constraints
            ),
            sized=None if self.sized is None else self.sized.on(runs),
        )

    def __call__(self, volumes: Array) -> Judgement:
        """Evaluate m sets of volumes, m^3, shape (m, c).

        The details are the values of the constraints, the mass, the vibration, and whether that is sure (1)
        or an estimate (0).
        """
        found = {own.name: own.value(volumes) for own in self.constraints}
        excesses = [own.excess(found[own.name]) for own in self.constraints]
        over = np.max([np.full(volumes.shape[0], -1.0), *excesses], axis=0)
        mass = volumes @ self.density
        vibration = found["vibration"] if self.by_mass else self.vibration.exact(volumes)
        sure = np.full(over.shape, 0.0 if self.estimated else 1.0)
        details = found | {"mass": mass, "vibration": vibration, "sure": sure}
        value = vibration if self.sized is None else self.sized.exact(volumes)
        return Judgement(mass if self.by_mass else value, over, details)


@dataclass(frozen=True)
class Problem:
    """What an optimisation is after."""

    evaluate: Evaluator  #: objective and constraints at sets of volumes
    meaning: str  #: what the value is, in words
    working_speed: float  #: rad/s
    speeds: tuple[float, ...]  #: that matter most, rad/s
    costly: bool  #: one answer takes tens of milliseconds and more
    notes: tuple[Note, ...] = ()  #: what was assumed


def working_speed(scene: Scene, task: Optimisation) -> float:
    """Speed at which the machine works: the one given, or the scene's last, rad/s."""
    return scene.speeds.stop if task.working_speed is None else task.working_speed


def operating_speeds(scene: Scene, task: Optimisation) -> Speeds:
    """Speeds at which the machine is used: the scene's, or evenly over the range given."""
    if task.operating is None:
        return scene.speeds
    start, stop = task.operating
    return Speeds(start=start, stop=stop, count=1 if start == stop else max(2, scene.speeds.count))


def growth_speeds(scene: Scene, task: Optimisation) -> Array:
    """Operating speeds at which small whirls are looked at, rad/s."""
    speeds = operating_speeds(scene, task)
    return np.linspace(speeds.start, speeds.stop, min(speeds.count, _GROWTH_SPEEDS))


def problem_of(
    scene: Scene, task: Optimisation, machine: FilledMachine, solve: Callable[[Problem], Found]
) -> Problem:
    """The problem that a scene poses."""
    if task.objective not in OBJECTIVES:
        raise InputError("--objective", task.objective, "one of " + ", ".join(OBJECTIVES))
    speed = working_speed(scene, task)
    planar = isinstance(scene.rotor, JeffcottRotor)
    density = np.array([fill.liquid.density for fill in scene.fills])
    at_work = AtSpeed(machine, np.array([speed]), np.ones(1))
    runs, few = _run_ups(scene, task)
    constraints = _constraints(scene, task, machine, speed, runs)
    rpm = in_rpm(speed)
    # Whirls of a ring with baffles take a second each.
    plates = any(fill.chamber.baffles is not None for fill in scene.fills)
    slow = plates or task.whirl_limit is not None or limits_loads(task) or runs is not None
    costly = not planar or slow
    evaluate = Evaluator(at_work, density, constraints, runs=runs)
    laminar = (optimum.laminar(),) if whirl_friction(scene) != scene.model.friction else ()
    notes: tuple[Note, ...] = (*laminar, *few)
    problem = Problem(evaluate, f"amplitude at {rpm}", speed, (speed,), costly, notes)
    return _MAKERS[task.objective](scene, task, machine, problem, solve)


def _run_ups(scene: Scene, task: Optimisation) -> tuple[Passages | None, tuple[Note, ...]]:
    """Run-ups in time that the task needs, on a few cells, and a note where the scene has more."""
    plan, loaded = scene.speed_plan, loads_in_time(task)
    if plan is None or not (loaded or (task.objective == "peak" and not task.steady)):
        return None, ()
    few = min(max(_COARSE_CELLS, most_cells(scene)), plan.cells)
    notes = (optimum.few_cells(few, plan.cells),) if few < plan.cells else ()
    return Passages(scene, few, loaded), notes


def _constraints(
    scene: Scene, task: Optimisation, machine: FilledMachine, speed: float, runs: Passages | None
) -> tuple[Constraint, ...]:
    """The constraints of the task."""
    found = [] if task.dry_patch else [dry_wall(machine, speed)]
    if task.stable:
        found.append(_stability(scene, task, speed))
    if task.least_film > 0.0:
        found.append(wetting(scene, task.least_film))
    if not task.spill and any(fill.chamber.inner_radius > 0.0 for fill in scene.fills):
        found.append(spill(machine, speed))
    if task.whirl_limit is not None:
        found.append(whirl_size(scene, growth_speeds(scene, task), task.whirl_limit))
    if task.clearance is not None:
        found.append(clearance(PeakOver(machine, operating_speeds(scene, task)), task.clearance))
    found += load_constraints(scene, task, machine, operating_speeds(scene, task), runs)
    if task.balance_quality is not None:
        found.append(balanced(QualityAtSpeed(machine, speed), task.balance_quality))
    return tuple(found)


def _stability(scene: Scene, task: Optimisation, speed: float) -> Constraint:
    """Where the machine stays; with a margin, if one is given."""
    speeds, where = _whirl_speeds(scene, task, speed)
    return stability(scene, speeds, task.stability_margin or 0.0, where)


def _whirl_speeds(scene: Scene, task: Optimisation, speed: float) -> tuple[Array, str]:
    """Speeds at which small whirls must die out, rad/s, and their name.

    Those of operation where a margin or a range is given, else those at which the machine stays.
    """
    if task.stability_margin is not None or task.operating is not None:
        return growth_speeds(scene, task), "at the operating speeds"
    if task.objective == "mean":
        return np.unique([speed, *_duty(scene, task)[0]]), "at the working speed and those of the duty cycle"
    return np.array([speed]), "at the working speed"


def _duty(scene: Scene, task: Optimisation) -> tuple[Array, Array]:
    """Speeds of the duty cycle, rad/s, and their weights; the scene's, all alike, where none is given."""
    if task.duty:
        speeds, weights = np.array([(stage.speed, stage.weight) for stage in task.duty]).T
        return speeds, weights
    speeds = scene.speed_array()
    return speeds, np.ones(speeds.size)


_Make = Callable[[Scene, Optimisation, FilledMachine, Problem, Callable[[Problem], Found]], Problem]


def _working_speed(
    scene: Scene, task: Optimisation, machine: FilledMachine, problem: Problem, _: object
) -> Problem:
    return problem


def _peak(scene: Scene, task: Optimisation, machine: FilledMachine, problem: Problem, _: object) -> Problem:
    if problem.evaluate.runs is not None and not task.steady:
        evaluate = replace(problem.evaluate, vibration=RunupPeak(scene, problem.evaluate.runs))
        return replace(problem, evaluate=evaluate, meaning="largest amplitude of the run-up in time")
    speeds = scene.speeds
    text = f"largest steady amplitude {over_rpm(machine.first_speed(speeds), speeds.stop)}"
    evaluate = replace(problem.evaluate, vibration=PeakOver(machine, speeds))
    return replace(problem, evaluate=evaluate, meaning=text, speeds=(speeds.stop, *_resonances(scene)))


def _resonances(scene: Scene) -> tuple[float, ...]:
    """Critical speeds of a planar rotor with all walls wet and without liquid, rad/s."""
    if not isinstance(scene.rotor, JeffcottRotor):
        return ()
    rotor = scene.rotor.machine()
    added = sum(fill.added_mass for fill in scene.fills)
    return math.sqrt(rotor.stiffness / (rotor.mass + added)), math.sqrt(rotor.stiffness / rotor.mass)


def _mean(scene: Scene, task: Optimisation, machine: FilledMachine, problem: Problem, _: object) -> Problem:
    speeds, weights = _duty(scene, task)
    text, notes = f"mean amplitude over a duty cycle of {speeds.size} speeds", problem.notes
    if not task.duty:
        text = f"mean amplitude over {speeds.size} speeds, all alike"
        notes = (*problem.notes, optimum.no_duty())
    evaluate = replace(problem.evaluate, vibration=AtSpeed(machine, speeds, weights))
    heaviest = speeds[np.argsort(-weights, kind="stable")][:3].tolist()
    return replace(problem, evaluate=evaluate, meaning=text, speeds=tuple(heaviest), notes=notes)


def _least_mass(
    scene: Scene,
    task: Optimisation,
    machine: FilledMachine,
    problem: Problem,
    solve: Callable[[Problem], Found],
) -> Problem:
    vibration: Vibration = problem.evaluate.vibration
    where = f"at {in_rpm(problem.working_speed)}"
    if task.limit_at == "operating":
        vibration, where = PeakOver(machine, operating_speeds(scene, task)), "at the operating speeds"
    limit, notes = task.vibration_limit, problem.notes
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
    )
    text = f"liquid's mass for an amplitude of at most {with_unit(limit, LENGTH)} {where}"
    return replace(problem, evaluate=evaluate, meaning=text, notes=notes)


def unbalances(scene: Scene, task: Optimisation) -> UnbalanceRange:
    """Over which the objective robust is taken: as given, or half to twice the scene's where nothing is."""
    default = DOUBLE if task.temperature is None else (1.0, 1.0)
    return unbalance_range(unbalances_of(scene.rotor), task.unbalance, default)


def _robust(scene: Scene, task: Optimisation, machine: FilledMachine, problem: Problem, _: object) -> Problem:
    notes, sizes = problem.notes, unbalances(scene, task)
    if task.unbalance is None and task.temperature is None:
        notes = (*notes, optimum.no_range())
    around = operating_conditions(sizes, task.temperature, task.samples, task.seed)
    vibration = Robust(scene, problem.working_speed, around, task.quantile)
    constraints = problem.evaluate.constraints
    if task.temperature is not None:
        constraints = (
            *(_at_any_temperature(constraint, scene, task, vibration) for constraint in constraints),
        )
        constraints = (*constraints, room_when_warm(vibration))
    kind = "worst" if task.quantile == 1.0 else f"{task.quantile:.4g} quantile of the"
    given = ("unbalance", sizes.least != sizes.most), ("temperature", task.temperature is not None)
    ranges = [name for name, varies in given if varies]
    over = f" over {len(around)} conditions of {' and '.join(ranges)}" if ranges else ""
    text = f"{kind} amplitude at {in_rpm(problem.working_speed)}{over}"
    evaluate = replace(problem.evaluate, vibration=vibration, constraints=constraints)
    return replace(problem, evaluate=evaluate, meaning=text, notes=notes)


def _at_any_temperature(
    constraint: Constraint, scene: Scene, task: Optimisation, robust: Robust
) -> Constraint:
    """The constraint on whirls, which the viscosity damps, at every temperature; any other as it is."""
    if constraint.name != "stability":
        return constraint
    speeds, _ = _whirl_speeds(scene, task, robust.around.speed)

    def value(volumes: Array) -> Array:
        rows = filled_scenes(robust.around, volumes)
        return np.asarray(np.max([growth(warm, held, speeds) for warm, held in rows], axis=0))

    text = f"{constraint.meaning}, at any temperature"
    return Constraint(constraint.name, text, constraint.unit, constraint.limit, constraint.scale, value)


def _load(scene: Scene, task: Optimisation, machine: FilledMachine, problem: Problem, _: object) -> Problem:
    speeds = operating_speeds(scene, task)
    over = loads_of(task, machine, speeds, problem.evaluate.runs)
    evaluate = replace(problem.evaluate, sized=Load(over, task.objective))
    near = (speeds.stop, *_resonances(scene))
    return replace(problem, evaluate=evaluate, meaning=load_meaning(task, speeds), speeds=near, costly=True)


_MAKERS: dict[str, _Make] = {
    "working_speed": _working_speed,
    "peak": _peak,
    "mean": _mean,
    "least_mass": _least_mass,
    "robust": _robust,
    **dict.fromkeys(LOADS, _load),
}
