"""What is searched of the balls of a scene, what a design is evaluated by, and what it must keep to.

[theory: races, eq. 13-15]
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from leblanc.core.notes import Note
from leblanc.core.units import in_rpm, rpm_range
from leblanc.liquid.choose import across_gravity, axial_gravity
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Runup, Scene, dry_rotor, require_clear, require_whirl
from leblanc.scene.tasks import MAX_BALLS, Optimisation
from leblanc.scene.unbalances import unbalances_of, with_unbalances
from leblanc.studies.balls.states import WorstStates, planes_of, worst_states
from leblanc.studies.drives import drive_of, numerics_of, planned, rotor_in_time
from leblanc.studies.optimise import notes
from leblanc.studies.optimise.balls.answer import DesignRange
from leblanc.studies.optimise.constraints import Limit
from leblanc.studies.optimise.problem import operating_speeds, working_speed
from leblanc.studies.optimise.robust import DOUBLE, operating_conditions, unbalance_range
from leblanc.studies.runup.study import chosen_run
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.rotor.balance_quality import balance_quality
from solvers.runup.long_wave import couple
from solvers.runup.runup import run_up
from solvers.synchronous.response import response

_FEW, _MANY = 2, 8  # balls of a race where the scene gives no ranges
_USUAL = {"mass": (0.25, 4.0), "diameter": (0.5, 2.0), "drag": (0.01, 100.0)}  # times the scene's
_UNITS = {"count": "1", "mass": "kg", "diameter": "m", "drag": "N s/m", "radius": "m"}
_LOGARITHMIC = ("mass", "diameter", "drag")
OBJECTIVES = ("working_speed", "peak", "mean", "least_mass", "robust")
# Fields of a task that say nothing of balls.
_OF_LIQUID = ("deflection", "temperature", "dry_patch", "least_film", "whirl_limit", "spill", "loads_over")
_OF_LOADS = ("floor_force", "walking_margin", "slip_margin", "point_clearance", "motor_torque", "volumes")
_MOST_SPEEDS = 17  # of the scene's or a range's, at which a design is evaluated
_SLACK = 0.01  # default limit of the amplitude over that without balls
_NEUTRAL = 1e-9  # of the speed: growth that is rounding
_FADES = 0.01  # of the speed: a decay that is fast
_EQUAL = 1e-3  # of the amplitude without balls: what differs by less is equal
WHOLE = 10.0  # objective of a design that breaks a constraint, above those of all that keep them


class Variable(NamedTuple):
    """One number of a race that is searched."""

    race: int
    name: str
    low: float
    high: float

    @property
    def logarithmic(self) -> bool:
        """Its logarithm is searched."""
        return self.name in _LOGARITHMIC and self.low > 0.0

    @property
    def bounds(self) -> tuple[float, float]:
        """Of what is searched."""
        return (math.log(self.low), math.log(self.high)) if self.logarithmic else (self.low, self.high)

    def value(self, searched: float) -> float:
        """The number itself, SI."""
        found = math.exp(searched) if self.logarithmic else searched
        return float(min(max(found, self.low), self.high))

    def searched(self, value: float) -> float:
        """What is searched at a value, within the bounds."""
        held = min(max(value, self.low), self.high)
        return math.log(held) if self.logarithmic else held


def size_of(race: BallRace) -> str:
    """The size of a ball that a scene gives: its mass, or the diameter beside a density."""
    return "mass" if race.mass is not None else "diameter"


def variables_of(scene: Scene, task: Optimisation) -> Iterator[Variable]:
    """What is searched of the balls of every race: what the task gives, or around what the scene has."""
    for k, race in enumerate(scene.balls):
        own, ranges = size_of(race), task.balls
        if ranges is None:
            yield Variable(k, "count", min(_FEW, race.count), min(max(_MANY, race.count), MAX_BALLS))
            for name in (own, "drag"):
                value, (low, high) = getattr(race, name), _USUAL[name]
                if value > 0.0:
                    yield Variable(k, name, low * value, high * value)
            continue
        other, keeps = ("diameter", "mass") if own == "mass" else ("mass", "density")
        if getattr(ranges, other) is not None:
            text = f"left out where chambers.{len(scene.liquids) + k}.{keeps} is given; {own} in its place"
            raise InputError(f"optimise.balls.{other}", list(getattr(ranges, other)), text)
        for name in ("count", own, "drag", "radius"):
            if (span := getattr(ranges, name)) is not None:
                yield Variable(k, name, *span)


def named_ranges(scene: Scene, variables: Sequence[Variable]) -> tuple[DesignRange, ...]:
    """The variables as results keep them."""
    first = len(scene.liquids)
    return tuple(
        DesignRange(f"chambers.{first + v.race}.{v.name}", v.low, v.high, _UNITS[v.name]) for v in variables
    )


def start_of(scene: Scene, variables: Sequence[Variable]) -> Array:
    """The scene's own balls as a point of the search, moved into the ranges, shape (v,)."""
    return np.array([v.searched(float(getattr(scene.balls[v.race], v.name))) for v in variables])


def values_of(variables: Sequence[Variable], point: Array) -> Array:
    """The numbers at a point of the search, SI, shape (v,)."""
    pairs = zip(variables, point.tolist(), strict=True)
    return np.array([round(v.value(x)) if v.name == "count" else v.value(x) for v, x in pairs])


def with_balls(scene: Scene, variables: Sequence[Variable], point: Array) -> Scene:
    """The scene with other balls, which are not checked: they may not fit."""
    changes: list[dict[str, float | int]] = [{} for _ in scene.balls]
    for variable, value in zip(variables, values_of(variables, point).tolist(), strict=True):
        changes[variable.race][variable.name] = round(value) if variable.name == "count" else value
    races = [race.altered(**own) for race, own in zip(scene.balls, changes, strict=True)]
    return scene.altered(chambers=(*scene.liquids, *races))


def crowding(race: BallRace) -> float:
    """Share of the way round a race that its balls take side by side; 0 where their diameter is not known."""
    if race.diameter is None:
        return 0.0
    share = race.diameter / (2.0 * race.radius)
    return race.count * math.asin(share) / math.pi if share < 1.0 else math.inf


def total_mass(scene: Scene) -> float:
    """Of all balls, kg."""
    return float(sum(race.count * race.each for race in scene.balls))


def whole_numbers(variables: Sequence[Variable]) -> Flags:
    """Which of the variables are whole numbers, shape (v,)."""
    return np.array([v.name == "count" for v in variables])


class Verdict(NamedTuple):
    """What a design is worth."""

    score: float  #: to be made least; above `WHOLE` where a constraint is broken
    value: float
    vibration: float  #: amplitude, m, infinite without a stable state
    mass: float  #: of all balls, kg
    growth: float  #: of small motions where they must fade, the largest over the conditions, 1/s
    excess: float  #: relative, 0 or below if no constraint is exceeded
    values: dict[str, float]


@dataclass(frozen=True)
class BallProblem:
    """A search for balls."""

    scene: Scene  #: the machine and what its balls are chosen for
    task: Optimisation
    variables: tuple[Variable, ...]  #: what is searched
    meaning: str  #: of the amplitude, in words
    working_speed: float  #: rad/s
    speeds: Array  #: over which the amplitude is taken; empty weights for the largest, rad/s
    weights: Array
    growth_at: Array  #: speeds at which small motions must fade, rad/s
    clear_at: Array  #: speeds at which the clearance holds, rad/s
    unbalances: tuple[tuple[float, ...], ...]  #: conditions: size of each of the rotor's unbalances, kg m
    in_time: bool  #: the amplitude is the largest of the run-up in time
    bare: float  #: the amplitude without balls, m
    limits: dict[str, Limit]  #: by name
    mass_scale: float  #: kg
    notes: tuple[Note, ...] = ()  #: what was assumed

    @property
    def by_mass(self) -> bool:
        """The mass of the balls is to be small; the amplitude is then one of the constraints."""
        return self.task.objective == "least_mass"

    @property
    def asked(self) -> Array:
        """All speeds at which the states of a design are looked for, rad/s."""
        own = np.empty(0) if self.in_time else self.speeds
        return np.unique(np.concatenate((own, self.growth_at, self.clear_at, [self.working_speed])))

    @property
    def costly(self) -> bool:
        """A design takes tenths of a second."""
        return self.in_time or bool(self.scene.fills) or self.asked.size * len(self.unbalances) > 12

    def judged(self, point: Array) -> Verdict:
        """What a design is worth."""
        scene = with_balls(self.scene, self.variables, point)
        mass = total_mass(scene)
        values = {"fits": max(crowding(race) for race in scene.balls)}
        # Balls that are not heavier than the liquid that they displace float.
        sunk = all(race.displaced < race.each for race in scene.balls)
        if not sunk or values["fits"] > 1.0:
            over = 1.0 if not sunk else min(values["fits"] - 1.0, 1e6)
            lost = dict.fromkeys(self.limits, math.inf) | values
            return Verdict(WHOLE + 10.0 + over, math.inf, math.inf, mass, math.inf, over, lost)
        rotors = (with_unbalances(scene.rotor, sizes) for sizes in self.unbalances)
        states = [worst_states(scene.altered(rotor=rotor), self.asked) for rotor in rotors]
        growth = max(float(np.max(self._at(each, "growth", self.growth_at))) for each in states)
        values["stable"] = growth
        vibration = self._amplitude(scene, states)
        if "vibration" in self.limits:
            over_all = self.task.limit_at == "operating"
            values["vibration"] = self._largest(states, self.clear_at) if over_all else vibration
        if "clearance" in self.limits:
            values["clearance"] = self._largest(states, self.clear_at)
        if "balance_quality" in self.limits:
            at = [self.working_speed]
            rows = (each.coordinates[np.searchsorted(each.speed, at)] for each in states)
            quality = [balance_quality(dry_rotor(self.scene), at, row) for row in rows]
            values["balance_quality"] = float(np.max(quality))
        return self._weighed(vibration, mass, growth, values)

    def _at(self, states: WorstStates, name: str, speeds: Array) -> Array:
        return np.asarray(getattr(states, name)[np.searchsorted(states.speed, speeds)])

    def _largest(self, states: list[WorstStates], speeds: Array) -> float:
        """Largest amplitude at some speeds in any condition; infinite where none was found."""
        found = np.array([self._at(each, "amplitude", speeds) for each in states])
        return float(np.where(np.isnan(found), np.inf, found).max())

    def _amplitude(self, scene: Scene, states: list[WorstStates]) -> float:
        """What the objective looks at, m."""
        if self.in_time:
            return run_up_peak(scene)
        each = np.array([self._at(found, "amplitude", self.speeds) for found in states])
        each = np.where(np.isnan(each), np.inf, each)
        if self.task.objective in ("working_speed", "least_mass", "robust"):
            # Where no state is stable nobody knows how large the motion is.
            each = np.where([self._at(found, "stable", self.speeds) for found in states], each, np.inf)
        return self.taken(each)

    def taken(self, each: Array) -> float:
        """Of amplitudes in each condition over the speeds the one that counts."""
        over = each @ self.weights if self.weights.size else each.max(axis=1)
        if over.size == 1:
            return float(over[0])
        return float(np.quantile(over, self.task.quantile, method="higher"))

    def _weighed(self, vibration: float, mass: float, growth: float, values: dict[str, float]) -> Verdict:
        """One number of all."""
        over = [own.excess(values[name]) for name, own in self.limits.items()]
        excess = np.minimum(np.nan_to_num(over, nan=1e6), 1e6).tolist()
        if not self.by_mass and not math.isfinite(vibration):
            excess.append(1.0)
        worst = max(excess, default=-1.0)
        value = mass if self.by_mass else vibration
        if worst > 1e-9:
            return Verdict(WHOLE + min(worst, 9.0), value, vibration, mass, growth, worst, values)
        slow = 1.0 / (1.0 + max(-growth, 0.0) / (_FADES * self.working_speed))
        score = mass / self.mass_scale if self.by_mass else max(vibration / self.bare, _EQUAL) + _EQUAL * slow
        return Verdict(score, value, vibration, mass, growth, worst, values)


def run_up_peak(scene: Scene, balls: bool = True) -> float:
    """Largest amplitude of a scene's run-up in time, m; infinite where it did not come to its end."""
    plan, gravity = planned(scene), across_gravity(scene)
    drive, numerics = drive_of(plan, scene.rotor), numerics_of(plan, check=False)
    if balls:
        history = chosen_run(scene, drive, gravity, numerics).history
    else:  # with the liquid of the scene
        given = rotor_in_time(scene), scene.fills, drive, scene.model.friction, gravity, numerics
        history = run_up(*given, None, partial(couple, position=scene.balls[0].plane))
    return float(history.amplitude.max()) if history.converged else math.inf


def _spread(speeds: Array) -> Array:
    """At most `_MOST_SPEEDS` of some speeds, the ends among them."""
    if speeds.size <= _MOST_SPEEDS:
        return speeds
    return np.asarray(speeds[np.linspace(0, speeds.size - 1, _MOST_SPEEDS).round().astype(int)])


def ball_problem(scene: Scene, task: Optimisation) -> BallProblem:
    """The search that a scene with balls poses."""
    _require(scene, task)
    speed, used = working_speed(scene, task), operating_speeds(scene, task)
    operating = _spread(np.linspace(used.start, used.stop, used.count))
    speeds, weights, meaning, found = _over_speeds(scene, task, speed)
    in_time = task.objective == "peak" and not task.steady and scene.speed_plan is not None
    if in_time:
        meaning = "largest amplitude of the run-up in time"
        if isinstance(scene.speed_plan, Runup):
            meaning += f" from {rpm_range(scene.speed_plan.start, scene.speed_plan.stop)}"
    unbalances: tuple[tuple[float, ...], ...] = (unbalances_of(scene.rotor),)
    if task.objective == "robust":
        around = unbalance_range(unbalances[0], task.unbalance, DOUBLE)
        conditions = operating_conditions(around, None, task.samples, task.seed)
        unbalances = tuple(condition.unbalance for condition in conditions)
        found += () if task.unbalance is not None else (notes.NO_RANGE,)
    # The states of a design are looked for where it works, and over a range only where one is given.
    growth_at = np.array([speed]) if task.operating is None else np.unique([*operating, speed])
    problem = BallProblem(
        scene=scene,
        task=task,
        variables=tuple(variables_of(scene, task)),
        meaning=meaning,
        working_speed=speed,
        speeds=speeds,
        weights=weights,
        growth_at=growth_at,
        clear_at=operating if task.clearance or task.limit_at == "operating" else np.empty(0),
        unbalances=unbalances,
        in_time=in_time,
        bare=0.0,
        limits={},
        mass_scale=max(total_mass(scene), 1e-12),
        notes=found,
    )
    bare = bare_amplitude(problem)
    if not (math.isfinite(bare) and bare > 0.0):
        text = "such that the rotor without balls has a bounded amplitude above 0 there"
        raise InputError("rotor", scene.rotor.kind, text)
    problem = replace(problem, bare=bare)
    if task.objective == "least_mass" and task.vibration_limit is None:
        note = notes.no_limit(_SLACK * bare, "a hundredth of the amplitude without balls")
        problem = replace(problem, notes=(*found, note))
    return replace(problem, limits={own.name: own for own in _limits(problem)})


def _require(scene: Scene, task: Optimisation) -> None:
    """What a search for balls does not know."""
    require_whirl(scene, known=True)
    if not scene.balls:
        raise InputError("chambers", len(scene.chambers), "with one of kind balls for this")
    if task.objective not in OBJECTIVES:
        raise InputError("objective", task.objective, "one of " + ", ".join(OBJECTIVES) + " with balls")
    usual = Optimisation()
    for name in (*_OF_LIQUID, *_OF_LOADS):
        if (given := getattr(task, name)) != getattr(usual, name):
            raise InputError(f"optimise.{name}", given, "left out with balls: the search does not know it")
    require_clear(scene, "balls beside liquid")
    if scene.model.liquid not in ("auto", "statics"):
        raise InputError("model.liquid", scene.model.liquid, "auto or statics beside balls")


def _over_speeds(
    scene: Scene, task: Optimisation, speed: float
) -> tuple[Array, Array, str, tuple[Note, ...]]:
    """Speeds over which the amplitude is taken, their weights, what it is, and what was assumed."""
    if task.objective == "peak":
        words = f"largest steady amplitude from {rpm_range(scene.speeds.start, scene.speeds.stop)}"
        return _spread(scene.speed_array()), np.empty(0), words, ()
    if task.objective == "mean" and task.duty:
        speeds, weights = np.array([(stage.speed, stage.weight) for stage in task.duty]).T
        words = f"mean amplitude over a duty cycle of {len(task.duty)} speeds"
        return speeds, np.asarray(weights / weights.sum()), words, ()
    if task.objective == "mean":
        speeds = _spread(scene.speed_array())
        words = f"mean amplitude from {rpm_range(scene.speeds.start, scene.speeds.stop)}"
        return speeds, np.full(speeds.size, 1.0 / speeds.size), words, ()
    words = f"amplitude at {in_rpm(speed)}"
    if task.objective == "robust":
        worst = "largest" if task.quantile == 1.0 else f"{task.quantile:g} quantile of the"
        words = f"{worst} amplitude at {in_rpm(speed)} over the range of unbalances"
    return np.array([speed]), np.empty(0), words, ()


def bare_amplitude(problem: BallProblem) -> float:
    """The amplitude of the objective without balls, with the liquid of the scene, m."""
    scene = problem.scene
    if problem.in_time:
        return run_up_peak(scene, balls=False)
    found = []
    for sizes in problem.unbalances:
        changed = scene.altered(rotor=with_unbalances(scene.rotor, sizes))
        given = dry_rotor(changed), scene.fills, problem.speeds, axial_gravity(scene)
        sizes_at = [response(*given, position=plane).amplitude for plane in planes_of(scene)]
        found.append(np.max(sizes_at, axis=0))
    return problem.taken(np.array(found))


def _limits(problem: BallProblem) -> Iterator[Limit]:
    """What a design must keep to."""
    task, speed = problem.task, problem.working_speed
    yield Limit("fits", "share of the race that its balls take side by side", "1", 1.0, 1.0)
    at = f"at {in_rpm(speed)}"
    if problem.growth_at.size > 1:
        at = f"from {rpm_range(float(problem.growth_at[0]), float(problem.growth_at[-1]))}"
    if task.stable:
        margin = task.stability_margin or 0.0
        limit = -margin if margin > 0.0 else _NEUTRAL * speed
        yield Limit("stable", f"growth of small motions {at}", "1/s", limit, max(margin, _FADES * speed))
    used = rpm_range(float(problem.clear_at[0]), float(problem.clear_at[-1])) if problem.clear_at.size else ""
    if problem.by_mass:
        limit = task.vibration_limit if task.vibration_limit is not None else _SLACK * problem.bare
        where = f"largest amplitude from {used}" if task.limit_at == "operating" else problem.meaning
        yield Limit("vibration", where, "m", limit, limit)
    if (most := task.clearance) is not None:
        yield Limit("clearance", f"largest amplitude from {used}", "m", most, most)
    if (grade := task.balance_quality) is not None:
        yield Limit("balance_quality", f"balance quality of rotor and balls {at}", "m/s", grade, grade)
