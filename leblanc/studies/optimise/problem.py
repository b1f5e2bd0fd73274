"""The problem of an optimisation: objective and constraints at sets of volumes [theory: optimum, eq. 5]."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from leblanc.core.notes import Note
from leblanc.core.units import LENGTH, in_rpm, over_rpm, with_unit
from leblanc.scene.scene import JeffcottRotor, Scene, Speeds
from leblanc.scene.tasks import LOADS, OBJECTIVES, Optimisation
from leblanc.scene.unbalances import unbalances_of
from leblanc.studies.optimise import notes as notes_of
from leblanc.studies.optimise.constraints import (
    UNITS,
    Constraint,
    dry_wall,
    growth,
    limits_loads,
    load_constraints,
    load_place,
    loads_in_time,
    loads_of,
    most_cells,
    spill,
    stability,
    wetting,
    whirl_friction,
    whirl_size,
)
from leblanc.studies.optimise.filled import FilledMachine, QualityAtSpeed
from leblanc.studies.optimise.objectives import AtSpeed, Load, Passages, PeakOver, RunupPeak, Vibration
from leblanc.studies.optimise.robust import (
    DOUBLE,
    Robust,
    UnbalanceRange,
    filled_scenes,
    operating_conditions,
    unbalance_range,
)
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.search import Found, Judgement

_COARSE_CELLS = 64  # of a run-up while the search goes on
_GROWTH_SPEEDS = 65  # at which the growth of small whirls is looked at
_SLACK = 1.01  # default limit of the vibration over the least that is possible


@dataclass(frozen=True)
class Problem:
    """What an optimisation is after: a vibration, or a mass, and constraints at sets of volumes."""

    vibration: Vibration  #: to be small
    density: Array  #: of each chamber's liquid, kg/m^3, shape (c,)
    constraints: tuple[Constraint, ...]  #: to keep to
    meaning: str  #: what the value is, in words
    working_speed: float  #: rad/s
    speeds: tuple[float, ...]  #: that matter most, rad/s
    costly: bool  #: one answer takes tens of milliseconds and more
    #: run-ups in time by which vibration, loads or both are evaluated; None where none are
    runs: Passages | None = None
    notes: tuple[Note, ...] = ()  #: what was assumed
    by_mass: bool = False  #: the liquid's mass is to be small; the vibration is then one of the constraints
    estimated: bool = False  #: the vibration is an estimate, by an emulator
    sized: Load | None = None  #: load that is to be small in place of the vibration

    @property
    def unit(self) -> str:
        """Unit of what is made small."""
        if self.by_mass:
            return "kg"
        return "m" if self.sized is None else UNITS.get(self.sized.name, "1")

    def on(self, scene: Scene, runs: Passages) -> Problem:
        """The same with other run-ups."""
        in_time = isinstance(self.vibration, RunupPeak)
        return replace(
            self,
            runs=runs,
            vibration=RunupPeak(scene, runs) if in_time else self.vibration,
            constraints=tuple(own.on(runs) for own in self.constraints),
            sized=None if self.sized is None else self.sized.on(runs),
        )

    def evaluate(self, volumes: Array) -> Judgement:
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
    scene: Scene,
    task: Optimisation,
    machine: FilledMachine,
    solve: Callable[[Problem], Found],
    threads: int = 1,
    pool: ProcessPoolExecutor | None = None,
) -> Problem:
    """The problem that a scene poses; run-ups go on so many threads, whirls through a pool."""
    if task.objective not in _MAKERS:
        raise InputError("objective", task.objective, "one of " + ", ".join(OBJECTIVES))
    speed = working_speed(scene, task)
    notes = [notes_of.LAMINAR] if whirl_friction(scene) != scene.model.friction else []
    runs, plan, loaded = None, scene.speed_plan, loads_in_time(task)
    if plan is not None and (loaded or (task.objective == "peak" and not task.steady)):
        few = min(max(_COARSE_CELLS, most_cells(scene)), plan.cells)
        notes += [notes_of.few_cells(few, plan.cells)] if few < plan.cells else []
        runs = Passages(scene, few, loaded, threads)
    # Whirls of a ring with baffles take a second each.
    plates = any(fill.chamber.baffles is not None for fill in scene.fills)
    slow = plates or task.whirl_limit is not None or limits_loads(task) or runs is not None
    problem = Problem(
        vibration=AtSpeed(machine, np.array([speed]), np.ones(1)),
        density=np.array([fill.liquid.density for fill in scene.fills]),
        constraints=tuple(_constraints(scene, task, machine, speed, runs, pool)),
        meaning=f"amplitude at {in_rpm(speed)}",
        working_speed=speed,
        speeds=(speed,),
        costly=slow or not isinstance(scene.rotor, JeffcottRotor),
        runs=runs,
        notes=tuple(notes),
    )
    return _MAKERS[task.objective](_Scene(scene, task, machine, solve, pool), problem)


def _constraints(
    scene: Scene,
    task: Optimisation,
    machine: FilledMachine,
    speed: float,
    runs: Passages | None,
    pool: ProcessPoolExecutor | None,
) -> Iterator[Constraint]:
    """The constraints of the task."""
    used = operating_speeds(scene, task)
    if not task.dry_patch:
        yield dry_wall(machine, speed)
    if task.stable:
        speeds, where = _whirl_speeds(scene, task, speed)
        yield stability(scene, speeds, task.stability_margin or 0.0, where, pool)
    if task.least_film > 0.0:
        yield wetting(scene, task.least_film)
    if not task.spill and any(fill.chamber.inner_radius > 0.0 for fill in scene.fills):
        yield spill(machine, speed)
    if task.whirl_limit is not None:
        yield whirl_size(scene, growth_speeds(scene, task), task.whirl_limit)
    if (most := task.clearance) is not None:
        text = "largest amplitude at the operating speeds"
        yield Constraint("clearance", text, "m", most, most, PeakOver(machine, used).exact)
    yield from load_constraints(task, machine, used, runs)
    if (grade := task.balance_quality) is not None:  # of ISO 21940-11
        text = "unbalance of rotor and liquid over the rotor's mass, times the working speed"
        quality = QualityAtSpeed(machine, speed)
        yield Constraint("balance_quality", text, "m/s", grade, grade, quality.of)


def _whirl_speeds(scene: Scene, task: Optimisation, speed: float) -> tuple[Array, str]:
    """Speeds at which small whirls must decay, rad/s, and their name.

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


class _Scene(NamedTuple):
    """What poses a problem."""

    scene: Scene
    task: Optimisation
    machine: FilledMachine
    solve: Callable[[Problem], Found]
    pool: ProcessPoolExecutor | None


def _peak(of: _Scene, problem: Problem) -> Problem:
    speeds = of.scene.speeds
    if problem.runs is not None and not of.task.steady:
        text = "largest amplitude of the run-up in time"
        return replace(problem, vibration=RunupPeak(of.scene, problem.runs), meaning=text)
    text = f"largest steady amplitude {over_rpm(of.machine.first_speed(speeds), speeds.stop)}"
    near = (speeds.stop, *_resonances(of.scene))
    return replace(problem, vibration=PeakOver(of.machine, speeds), meaning=text, speeds=near)


def _resonances(scene: Scene) -> tuple[float, ...]:
    """Critical speeds of a planar rotor with all walls wet and without liquid, rad/s."""
    if not isinstance(scene.rotor, JeffcottRotor):
        return ()
    rotor = scene.rotor.machine()
    added = sum(fill.added_mass for fill in scene.fills)
    return math.sqrt(rotor.stiffness / (rotor.mass + added)), math.sqrt(rotor.stiffness / rotor.mass)


def _mean(of: _Scene, problem: Problem) -> Problem:
    speeds, weights = _duty(of.scene, of.task)
    given = bool(of.task.duty)
    over = f"a duty cycle of {speeds.size} speeds" if given else f"{speeds.size} speeds, all alike"
    return replace(
        problem,
        vibration=AtSpeed(of.machine, speeds, weights),
        meaning=f"mean amplitude over {over}",
        speeds=tuple(speeds[np.argsort(-weights, kind="stable")][:3].tolist()),
        notes=problem.notes if given else (*problem.notes, notes_of.NO_DUTY),
    )


def _least_mass(of: _Scene, problem: Problem) -> Problem:
    where, task = f"at {in_rpm(problem.working_speed)}", of.task
    if task.limit_at == "operating":
        where, used = "at the operating speeds", operating_speeds(of.scene, task)
        problem = replace(problem, vibration=PeakOver(of.machine, used))
    limit, notes = task.vibration_limit, problem.notes
    if limit is None:
        limit = _SLACK * of.solve(problem).objective
        notes = (*notes, notes_of.no_limit(limit, "one per cent above the least possible"))
    bound = Constraint("vibration", f"amplitude {where}", "m", limit, limit, problem.vibration.exact)
    return replace(
        problem,
        constraints=(*problem.constraints, bound),
        meaning=f"liquid's mass for an amplitude of at most {with_unit(limit, LENGTH)} {where}",
        by_mass=True,
        notes=notes,
    )


def unbalances(scene: Scene, task: Optimisation) -> UnbalanceRange:
    """Over which the objective robust is taken: as given, or half to twice the scene's where nothing is."""
    default = DOUBLE if task.temperature is None else (1.0, 1.0)
    return unbalance_range(unbalances_of(scene.rotor), task.unbalance, default)


def _robust(of: _Scene, problem: Problem) -> Problem:
    task, sizes = of.task, unbalances(of.scene, of.task)
    around = operating_conditions(sizes, task.temperature, task.samples, task.seed)
    vibration = Robust(of.scene, problem.working_speed, around, task.quantile)
    constraints, notes = problem.constraints, problem.notes
    if task.temperature is not None:
        speeds, _ = _whirl_speeds(of.scene, task, problem.working_speed)

        def grows(volumes: Array) -> Array:
            rows = filled_scenes(vibration.around, volumes)
            return np.asarray(np.max([growth(warm, held, speeds, of.pool) for warm, held in rows], axis=0))

        text = "share of a chamber that its liquid takes when warmest"
        constraints = (
            # The viscosity damps whirls at every temperature.
            *(
                replace(own, meaning=f"{own.meaning}, at any temperature", found=grows)
                if own.name == "stability"
                else own
                for own in constraints
            ),
            Constraint("room_when_warm", text, "1", 1.0, 1.0, vibration.around.fullest),
        )
    kind = "worst" if task.quantile == 1.0 else f"{task.quantile:.4g} quantile of the"
    given = ("unbalance", sizes.least != sizes.most), ("temperature", task.temperature is not None)
    ranges = [name for name, varies in given if varies]
    over = f" over {len(around)} conditions of {' and '.join(ranges)}" if ranges else ""
    if task.unbalance is None and task.temperature is None:
        notes = (*notes, notes_of.NO_RANGE)
    text = f"{kind} amplitude at {in_rpm(problem.working_speed)}{over}"
    return replace(problem, vibration=vibration, constraints=constraints, meaning=text, notes=notes)


_MEANING = {
    "floor_force": "largest force under a foot",
    "walking_margin": "share of its hold on the floor that the machine uses, 1 less the walking margin,",
    "point_clearance": "largest share that a point takes of its gap",
    "motor_torque": "largest torque of the motor",
}


def _load(of: _Scene, problem: Problem) -> Problem:
    speeds = operating_speeds(of.scene, of.task)
    load = Load(loads_of(of.task, of.machine, speeds, problem.runs), of.task.objective)
    text = f"{_MEANING[of.task.objective]} {load_place(of.task, speeds)}"
    near = (speeds.stop, *_resonances(of.scene))
    return replace(problem, sized=load, meaning=text, speeds=near, costly=True)


_MAKERS: dict[str, Callable[[_Scene, Problem], Problem]] = {
    "working_speed": lambda _, problem: problem,
    "peak": _peak,
    "mean": _mean,
    "least_mass": _least_mass,
    "robust": _robust,
    **dict.fromkeys(LOADS, _load),
}
