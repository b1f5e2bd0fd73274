"""What a design of balls is judged by: an amplitude or the mass of all balls, and what it must keep to.

[theory: races, eq. 13-15]
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from leblanc.core.notes import Note
from leblanc.core.units import in_rpm, rpm_range
from leblanc.results.base import ConstraintValue
from leblanc.results.notes import ball_design as notes
from leblanc.scene.scene import Runup, Scene, dry_rotor, require_clear, require_whirl
from leblanc.scene.tasks import Optimisation
from leblanc.scene.unbalances import unbalances_of, with_unbalances
from leblanc.studies.balls.states import WorstStates, planes_of, worst_states
from leblanc.studies.drives import drive_of, numerics_of, planned, rotor_in_time
from leblanc.studies.models.choose import across_gravity, axial_gravity
from leblanc.studies.optimise.balls.design import (
    Variable,
    crowding,
    floats,
    total_mass,
    variables_of,
    with_balls,
)
from leblanc.studies.optimise.problem import operating_speeds, working_speed
from leblanc.studies.optimise.robust import DOUBLE, operating_conditions, unbalance_range
from leblanc.studies.runup.study import chosen_run
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.balance_quality import balance_quality
from solvers.runup.long_wave import couple
from solvers.runup.runup import run_up
from solvers.synchronous.response import response

OBJECTIVES = ("working_speed", "peak", "mean", "least_mass", "robust")
# Fields of a task that say nothing of balls.
_OF_LIQUID = ("deflection", "temperature", "dry_patch", "least_film", "whirl_limit", "spill", "loads_over")
_OF_LOADS = ("floor_force", "walking_margin", "slip_margin", "point_clearance", "motor_torque", "volumes")
_MOST_SPEEDS = 17  # of the scene's or a range's, at which a design is judged
_SLACK = 0.01  # default limit of the amplitude over that without balls
_NEUTRAL = 1e-9  # of the speed: growth that is rounding
_FADES = 0.01  # of the speed: a decay that is fast
_EQUAL = 1e-3  # of the amplitude without balls: what differs by less is equal
WHOLE = 10.0  # objective of a design that breaks a constraint, above those of all that keep them


class Verdict(NamedTuple):
    """What a design is worth.

    `score` is to be made least: of the objective and, among equals, of the decay, above `WHOLE` where a
    constraint is broken; `vibration` the amplitude, m, infinite without a stable state; `mass` of all balls;
    `growth` of small motions at the working speed, the largest over the conditions, 1/s; `excess` relative, 0
    or below if no constraint is exceeded.
    """

    score: float
    value: float
    vibration: float
    mass: float
    growth: float
    excess: float
    values: dict[str, float]


class Limit(NamedTuple):
    """A value that must not be above its limit; `scale` is what an excess is measured by."""

    limit: float
    unit: str
    meaning: str
    scale: float

    def at(self, value: float) -> ConstraintValue:
        """The constraint where it has a value."""
        kept = bool(value <= self.limit + 1e-9 * self.scale)
        return ConstraintValue(self.limit, value, kept, self.unit, self.meaning)


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
        sunk = not any(floats(race) for race in scene.balls)
        if not sunk or values["fits"] > 1.0:
            over = 1.0 if not sunk else min(values["fits"] - 1.0, 1e6)
            lost = dict.fromkeys(self.limits, math.inf) | values
            return Verdict(WHOLE + 10.0 + over, math.inf, math.inf, mass, math.inf, over, lost)
        states = [self._states(scene, sizes) for sizes in self.unbalances]
        growth = max(float(np.max(self._at(each, "growth", self.growth_at))) for each in states)
        values["stable"] = growth
        vibration = self._amplitude(scene, states)
        if "vibration" in self.limits:
            over_all = self.task.limit_at == "operating"
            values["vibration"] = self._largest(states, self.clear_at) if over_all else vibration
        if "clearance" in self.limits:
            values["clearance"] = self._largest(states, self.clear_at)
        if "balance_quality" in self.limits:
            values["balance_quality"] = max(self._quality(each) for each in states)
        return self._weighed(vibration, mass, growth, values)

    def _states(self, scene: Scene, sizes: tuple[float, ...]) -> WorstStates:
        rotor = with_unbalances(scene.rotor, sizes)
        return worst_states(scene.altered(rotor=rotor), self.asked)

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
        over = each @ self.weights if self.weights.size else each.max(axis=1)
        return (
            float(np.quantile(over, self.task.quantile, method="higher")) if over.size > 1 else float(over[0])
        )

    def _quality(self, states: WorstStates) -> float:
        """Balance quality of rotor and balls together at the working speed, m/s."""
        row = int(np.searchsorted(states.speed, self.working_speed))
        coordinates = states.coordinates[row][None]
        return float(balance_quality(dry_rotor(self.scene), [self.working_speed], coordinates)[0])

    def _weighed(self, vibration: float, mass: float, growth: float, values: dict[str, float]) -> Verdict:
        """One number of all."""
        excess = [_over(values[name], own) for name, own in self.limits.items()]
        if not self.by_mass and not math.isfinite(vibration):
            excess.append(1.0)
        worst = max(excess, default=-1.0)
        value = mass if self.by_mass else vibration
        if worst > 1e-9:
            return Verdict(WHOLE + min(worst, 9.0), value, vibration, mass, growth, worst, values)
        slow = 1.0 / (1.0 + max(-growth, 0.0) / (_FADES * self.working_speed))
        score = mass / self.mass_scale if self.by_mass else max(vibration / self.bare, _EQUAL) + _EQUAL * slow
        return Verdict(score, value, vibration, mass, growth, worst, values)


def _over(value: float, own: Limit) -> float:
    found = (value - own.limit) / own.scale
    return 1e6 if math.isnan(found) else min(found, 1e6)


def run_up_peak(scene: Scene) -> float:
    """Largest amplitude of a scene's run-up in time, m; infinite where it did not come to its end."""
    plan = planned(scene)
    drive, numerics = drive_of(plan, scene.rotor), numerics_of(plan, check=False)
    history = chosen_run(scene, drive, across_gravity(scene), numerics).history
    return float(history.amplitude.max()) if history.converged else math.inf


def _spread(speeds: Array) -> Array:
    """At most `_MOST_SPEEDS` of some speeds, the ends among them."""
    if speeds.size <= _MOST_SPEEDS:
        return speeds
    return np.asarray(speeds[np.linspace(0, speeds.size - 1, _MOST_SPEEDS).round().astype(int)])


def ball_problem(scene: Scene, task: Optimisation) -> BallProblem:
    """The search that a scene with balls poses."""
    _require(scene, task)
    variables = variables_of(scene, task)
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
        found += () if task.unbalance is not None else (notes.no_range(),)
    # The states of a design are looked for where it works, and over a range only where one is given.
    growth_at = np.array([speed]) if task.operating is None else np.unique([*operating, speed])
    problem = BallProblem(
        scene=scene,
        task=task,
        variables=variables,
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
        problem = replace(problem, notes=(*problem.notes, notes.no_limit(_SLACK * bare)))
    return replace(problem, limits=_limits(problem))


def _require(scene: Scene, task: Optimisation) -> None:
    """What a search for balls does not know."""
    require_whirl(scene)
    if not scene.balls:
        raise InputError("chambers", len(scene.chambers), "with one of kind balls for this")
    if task.objective not in OBJECTIVES:
        raise InputError("--objective", task.objective, "one of " + ", ".join(OBJECTIVES) + " with balls")
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
        return _run_without(scene)
    found = []
    for sizes in problem.unbalances:
        changed = scene.altered(rotor=with_unbalances(scene.rotor, sizes))
        given = dry_rotor(changed), scene.fills, problem.speeds, axial_gravity(scene)
        sizes_at = [response(*given, position=plane).amplitude for plane in planes_of(scene)]
        found.append(np.max(sizes_at, axis=0))
    each = np.array(found)
    over = each @ problem.weights if problem.weights.size else each.max(axis=1)
    return float(np.quantile(over, problem.task.quantile, method="higher"))


def _run_without(scene: Scene) -> float:
    """Largest amplitude of the run-up without balls, with the liquid of the scene, m."""
    plan = planned(scene)
    drive, numerics = drive_of(plan, scene.rotor), numerics_of(plan, check=False)
    given = rotor_in_time(scene), scene.fills, drive, scene.model.friction, across_gravity(scene), numerics
    history = run_up(*given, None, partial(couple, position=scene.balls[0].plane))
    return float(history.amplitude.max()) if history.converged else math.inf


def _limits(problem: BallProblem) -> dict[str, Limit]:
    """What a design must keep to, by name."""
    task, speed, bare = problem.task, problem.working_speed, problem.bare
    found = {"fits": Limit(1.0, "1", "share of the race that its balls take side by side", 1.0)}
    at = f"at {in_rpm(speed)}"
    if problem.growth_at.size > 1:
        at = f"from {rpm_range(float(problem.growth_at[0]), float(problem.growth_at[-1]))}"
    if task.stable:
        margin = task.stability_margin or 0.0
        scale = max(margin, _FADES * speed)
        limit = -margin if margin > 0.0 else _NEUTRAL * speed
        found["stable"] = Limit(limit, "1/s", f"growth of small motions {at}", scale)
    used = rpm_range(float(problem.clear_at[0]), float(problem.clear_at[-1])) if problem.clear_at.size else ""
    if problem.by_mass:
        limit = task.vibration_limit if task.vibration_limit is not None else _SLACK * bare
        where = f"largest amplitude from {used}" if task.limit_at == "operating" else problem.meaning
        found["vibration"] = Limit(limit, "m", where, limit)
    if task.clearance is not None:
        found["clearance"] = Limit(task.clearance, "m", f"largest amplitude from {used}", task.clearance)
    if task.balance_quality is not None:
        text = f"balance quality of rotor and balls {at}"
        found["balance_quality"] = Limit(task.balance_quality, "m/s", text, task.balance_quality)
    return found
