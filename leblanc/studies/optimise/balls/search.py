"""The search for the balls of a scene: differential evolution over whole and real numbers, then closer."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

import numpy as np

from leblanc.results.base import Note
from leblanc.results.notes import ball_design as notes
from leblanc.results.races.design import BallDesignResult, DesignedRace, TriedDesigns
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies.models.validity import doubts
from leblanc.studies.optimise.balls.design import (
    named_ranges,
    size_of,
    start_of,
    total_mass,
    values_of,
    whole_numbers,
    with_balls,
)
from leblanc.studies.optimise.balls.problem import BallProblem, Verdict, ball_problem
from leblanc.studies.races.balls import run_balls
from leblanc.studies.races.states import worst_states
from meshes.arrays import Array
from meshes.errors import InputError

Progress = Callable[[int, float], object]

_MEMBERS, _GENERATIONS = 8, 40  # of the search: members a variable, generations at most
_FEW_MEMBERS, _FEW_GENERATIONS = 5, 10  # where a design takes tenths of a second
_LEAST_MEMBERS = 16
_SETTLED = 1e-7  # spread of a population that has come together
_NEAR = 0.2  # numbers of balls whose best score is within this of the best may be looked at closer
_CLOSER = 2  # of them, and the one with the fewest balls; the best alone where a design takes its time
_STEPS, _FEW_STEPS = 80, 25  # of the search downhill, a variable
_ROUNDS = 12  # of lighter balls and better drag in turn
_HALVINGS = 50
_DRAGS, _TIGHTER = 7, 3  # places over the range of a drag, and how often that is narrowed about the best
_SAME = 1e-7  # relative: masses that are one
_SLOW = 1e-3  # of the working speed: a decay to be told
_EDGE = 1e-3  # of a range: its end


@dataclass
class _Tried:
    """All designs judged, each once, by processes that share them.

    Parameters
    ----------
    problem : the search
    each : calls a function with every one of some points, as `map` does
    progress : told of designs judged, and the share of the search done
    """

    problem: BallProblem
    each: Callable[[Callable[[Array], Verdict], Iterable[Array]], Iterable[Verdict]]
    progress: Progress | None = None
    share: float = 0.0
    known: dict[bytes, Verdict] = field(default_factory=dict)
    points: list[Array] = field(default_factory=list)

    def snapped(self, point: Array) -> Array:
        """The point with whole numbers of balls."""
        whole = whole_numbers(self.problem.variables)
        return np.ascontiguousarray(np.where(whole, np.round(point), point))

    def all(self, points: Iterable[Array]) -> list[Verdict]:
        """Verdicts on designs, in their order."""
        rows = [self.snapped(point) for point in points]
        new = list({row.tobytes(): row for row in rows if row.tobytes() not in self.known}.values())
        for row, verdict in zip(new, self.each(self.problem.judged, new), strict=True):
            self.known[row.tobytes()] = verdict
            self.points.append(row)
        if self.progress is not None and new:
            self.progress(len(self.points), self.share)
        return [self.known[row.tobytes()] for row in rows]

    def one(self, point: Array) -> Verdict:
        """Verdict on one design."""
        return self.all([point])[0]

    def best(self) -> Array:
        """The best design so far; the first of those that are alike."""
        scores = [self.known[row.tobytes()].score for row in self.points]
        return self.points[int(np.argmin(scores))]


def optimise_balls(
    scene: Scene, task: Optimisation, progress: Progress | None = None, workers: int = 1
) -> BallDesignResult:
    """Best balls of a scene's races within ranges [theory: races, eq. 9-11; SP97].

    The same seed gives the same balls with any number of workers.

    Parameters
    ----------
    scene : with races; its liquid stays as it is filled
    task : its objective, constraints and ranges
    progress : called with the number of designs judged and the share of the search done
    workers : processes that judge designs where one takes its time; this one alone if 1

    Raises
    ------
    InputError : no balls, an objective or a limit that says nothing of balls, a range that does not fit
    """
    if workers < 1:
        raise InputError("workers", workers, "1 or more")
    problem = ball_problem(scene, task)
    if not problem.variables:
        raise InputError("optimise.balls", "nothing", "such that some value of the balls may change")
    with _pool(workers if problem.costly else 1) as each:
        tried = _Tried(problem, each, progress)
        start = tried.snapped(start_of(scene, problem.variables))
        interrupted = False
        try:
            tried.one(start)
            _evolve(tried, start)
            best = _closer(tried)
        except KeyboardInterrupt:
            if not tried.points:
                raise
            best, interrupted = tried.best(), True
    return _result(problem, tried, best, interrupted)


@contextmanager
def _pool(workers: int) -> Iterator[Callable[..., Iterable[Verdict]]]:
    """What judges several designs: this process, or some at once."""
    if workers == 1:
        yield map
        return
    from leblanc.processes import processes

    with processes(workers) as pool:
        yield pool.map


def _evolve(tried: _Tried, start: Array) -> None:
    """Differential evolution over all variables, counts as whole numbers."""
    from scipy.optimize import differential_evolution

    problem, variables = tried.problem, tried.problem.variables
    members, generations = (_FEW_MEMBERS, _FEW_GENERATIONS) if problem.costly else (_MEMBERS, _GENERATIONS)
    spans = [variable.bounds for variable in variables]
    moving = [k for k, (low, high) in enumerate(spans) if high > low]
    if not moving:
        return
    members = max(members, math.ceil(_LEAST_MEMBERS / len(moving)))
    done = 0

    def score(columns: Array) -> Array:
        """Of members as columns, as scipy hands them over."""
        nonlocal done
        rows = np.repeat(start[None], columns.shape[1], axis=0)
        rows[:, moving] = columns.T
        found = np.array([verdict.score for verdict in tried.all(rows)])
        done += 1
        tried.share = 0.8 * min(done / (generations + 1), 1.0)
        return found

    differential_evolution(
        score,
        [spans[k] for k in moving],
        integrality=whole_numbers(variables)[moving],
        x0=start[moving],
        rng=np.random.default_rng(problem.task.seed),
        popsize=members,
        maxiter=generations,
        init="sobol",
        tol=_SETTLED,
        atol=_SETTLED**2,
        polish=False,
        updating="deferred",
        vectorized=True,
    )


def _closer(tried: _Tried) -> Array:
    """The best of the search, closer, for the best few numbers of balls; of equals the fewest balls."""
    whole = whole_numbers(tried.problem.variables)
    groups: dict[bytes, tuple[float, Array]] = {}
    for row in tried.points:
        score, key = tried.known[row.tobytes()].score, row[whole].tobytes()
        if key not in groups or score < groups[key][0]:
            groups[key] = score, row
    ranked = sorted(groups.values(), key=lambda found: (found[0], found[1].tolist()))
    least = ranked[0][0]
    near = [row for score, row in ranked if score <= least + _NEAR * abs(least)]
    few = min(range(len(near)), key=lambda k: near[k][whole].sum())
    near = near[:1] if tried.problem.costly else [near[k] for k in sorted({*range(len(near))[:_CLOSER], few})]
    ends = []
    for k, row in enumerate(near):
        tried.share = 0.8 + 0.2 * k / len(near)
        ends.append(_lightest(tried, row) if tried.problem.by_mass else _downhill(tried, row))
    scores = np.array([tried.one(row).score for row in ends])
    alike = np.flatnonzero(scores <= scores.min() * (1.0 + 1e-6))
    return min((ends[k] for k in alike.tolist()), key=lambda row: (row[whole].sum(), tried.one(row).score))


def _downhill(tried: _Tried, start: Array) -> Array:
    """Nelder and Mead's simplex over what is no whole number, within the ranges."""
    from scipy.optimize import minimize

    problem = tried.problem
    spans = np.array([variable.bounds for variable in problem.variables])
    moving = np.flatnonzero(~whole_numbers(problem.variables) & (spans[:, 1] > spans[:, 0]))
    if not moving.size:
        return start
    low, width = spans[moving, 0], spans[moving, 1] - spans[moving, 0]

    def placed(part: Array) -> Array:
        row = start.copy()
        row[moving] = low + width * np.clip(part, 0.0, 1.0)
        return row

    found = minimize(
        lambda part: tried.one(placed(part)).score,
        (start[moving] - low) / width,
        method="Nelder-Mead",
        bounds=[(0.0, 1.0)] * moving.size,
        options={
            "maxfev": (_FEW_STEPS if problem.costly else _STEPS) * moving.size,
            "xatol": 1e-6,
            "fatol": 1e-10,
        },
    )
    ends = [start, tried.snapped(placed(found.x))]
    return ends[int(np.argmin([tried.one(row).score for row in ends]))]


def _lightest(tried: _Tried, start: Array) -> Array:
    """Lighter balls race by race as long as all constraints are kept, and the quickest drag.

    In turn: a better drag leaves room for lighter balls. The mass falls in every round.
    """
    variables = tried.problem.variables
    if tried.one(start).excess > 1e-9:
        return start
    sizes = [k for k, v in enumerate(variables) if v.name in ("mass", "diameter")]
    drags = [k for k, v in enumerate(variables) if v.name == "drag"]
    wide = [k for k, v in enumerate(variables) if v.name == "radius"]
    best = start
    for turn in range(_ROUNDS):
        before = tried.one(best)
        for k in wide:
            best = _widest(tried, best, k)
        for k in sizes:
            best = _smallest(tried, best, k)
        for k in drags:
            best = _quickest(tried, best, k, 0.5**turn)
        after = tried.one(best)
        if before.mass - after.mass <= _SAME * after.mass:
            break
    for k in sizes:
        best = _smallest(tried, best, k)
    return best


def _moved(row: Array, k: int, value: float) -> Array:
    """The point with another value of one variable."""
    changed = row.copy()
    changed[k] = value
    return changed


def _bisected(tried: _Tried, row: Array, k: int, far: float) -> Array:
    """As near to the far end of a variable as the constraints allow."""
    if tried.one(_moved(row, k, far)).excess <= 1e-9:
        return _moved(row, k, far)
    good, bad = float(row[k]), far
    for _ in range(_HALVINGS):
        middle = 0.5 * (good + bad)
        if abs(good - bad) <= 1e-11 * max(abs(good), 1e-3):
            break
        kept = tried.one(_moved(row, k, middle)).excess <= 1e-9
        good, bad = (middle, bad) if kept else (good, middle)
    return _moved(row, k, good)


def _smallest(tried: _Tried, row: Array, k: int) -> Array:
    return _bisected(tried, row, k, tried.problem.variables[k].bounds[0])


def _widest(tried: _Tried, row: Array, k: int) -> Array:
    return _bisected(tried, row, k, tried.problem.variables[k].bounds[1])


def _quickest(tried: _Tried, row: Array, k: int, share: float) -> Array:
    """The drag at which small motions fade quickest; the same where no other keeps the constraints.

    It is looked for over a share of its range about where it is.
    """
    low, high = tried.problem.variables[k].bounds
    centre, half = float(row[k]), share * (high - low)
    for _ in range(_TIGHTER):
        places = np.linspace(max(centre - half, low), min(centre + half, high), _DRAGS)
        rows = [_moved(row, k, centre), *(_moved(row, k, place) for place in places.tolist())]
        found = tried.all(rows)
        worth = [verdict.growth if verdict.excess <= 1e-9 else math.inf for verdict in found]
        centre = float(rows[int(np.argmin(worth))][k])
        half *= 2.0 / (_DRAGS - 1)
    return _moved(row, k, centre)


def _designed(race: BallRace) -> DesignedRace:
    """A race as results keep it."""
    return DesignedRace(
        count=race.count,
        mass=race.each,
        diameter=race.diameter,
        drag=race.drag,
        radius=race.radius,
        plane=race.plane,
        capacity=race.capacity,
        sized_by=size_of(race),
    )


def _result(problem: BallProblem, tried: _Tried, best: Array, interrupted: bool) -> BallDesignResult:
    """The best balls with all that belongs to them."""
    scene, variables = problem.scene, problem.variables
    chosen, verdict = with_balls(scene, variables, best), tried.one(best)
    own = _of_scene(problem)
    verdicts = [tried.known[row.tobytes()] for row in tried.points]
    values = np.array([values_of(variables, row) for row in tried.points])
    designs = [with_balls(scene, variables, row) for row in tried.points]
    return BallDesignResult(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        objective=problem.task.objective,
        meaning=problem.meaning,
        working_speed=problem.working_speed,
        ranges=named_ranges(scene, variables),
        races=tuple(map(_designed, chosen.balls)),
        races_before=tuple(map(_designed, scene.balls)),
        value=verdict.value,
        vibration=verdict.vibration,
        vibration_before=own.vibration,
        vibration_without=problem.bare,
        mass_before=total_mass(scene),
        growth=verdict.growth,
        growth_before=own.growth,
        constraints={name: limit.at(verdict.values[name]) for name, limit in problem.limits.items()},
        unbalances=np.array(problem.unbalances),
        evaluations=len(tried.points),
        tried=TriedDesigns(
            values=values,
            count=np.array([sum(race.count for race in each.balls) for each in designs]),
            mass=np.array([each.mass for each in verdicts]),
            vibration=np.array([each.vibration for each in verdicts]),
            growth=np.array([each.growth for each in verdicts]),
            excess=np.array([each.excess for each in verdicts]),
        ),
        volume=np.array([fill.volume for fill in scene.fills]),
        response=run_balls(chosen),
        interrupted=interrupted,
        notes=(
            *problem.notes,
            *_findings(problem, best, verdict, interrupted, len(tried.points)),
            *doubts(scene),
        ),
    )


def _of_scene(problem: BallProblem) -> Verdict:
    """Verdict on the scene's own balls, whatever the ranges."""
    return replace(problem, variables=()).judged(np.empty(0))


def _findings(
    problem: BallProblem, best: Array, verdict: Verdict, interrupted: bool, count: int
) -> Iterator[Note]:
    """What must be known of the answer."""
    if interrupted:
        yield notes.interrupted(count)
    ends = []
    for variable, place, named in zip(
        problem.variables, best.tolist(), named_ranges(problem.scene, problem.variables), strict=True
    ):
        low, high = variable.bounds
        near = min(place - low, high - place) <= _EDGE * (high - low)
        if high > low and near and variable.name != "count":
            ends.append(named.path)
    if ends:
        yield notes.at_edge(tuple(ends))
    if 0.0 <= -verdict.growth < _SLOW * problem.working_speed:
        yield notes.slow(-verdict.growth)
    if problem.task.objective in ("peak", "mean") and not problem.in_time:
        scene = with_balls(problem.scene, problem.variables, best)
        found = worst_states(scene, problem.speeds)
        if not found.stable.all():
            first, last = found.speed[~found.stable][[0, -1]].tolist()
            yield notes.unstable_speeds(first, last)
