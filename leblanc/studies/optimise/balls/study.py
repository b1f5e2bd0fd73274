"""The search for the balls of a scene: differential evolution over whole and real numbers, then closer."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import nullcontext
from dataclasses import dataclass, field, replace

import numpy as np

from leblanc.core.interrupts import stopping
from leblanc.core.notes import Note
from leblanc.core.progress import update
from leblanc.liquid.validity import doubts
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies.balls.states import worst_states
from leblanc.studies.balls.study import run_balls
from leblanc.studies.optimise import notes
from leblanc.studies.optimise.answer import about
from leblanc.studies.optimise.balls.answer import BallDesignAnswer, DesignedRace, TriedDesigns
from leblanc.studies.optimise.balls.problem import (
    WHOLE,
    BallProblem,
    Verdict,
    ball_problem,
    named_ranges,
    size_of,
    start_of,
    total_mass,
    values_of,
    whole_numbers,
    with_balls,
)
from leblanc.studies.processes import processes
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.search import Budget, Enough, evolve

_MEMBERS, _GENERATIONS = 8, 40  # of the search: members a variable, generations at most
_FEW_MEMBERS, _FEW_GENERATIONS = 5, 10  # where a design takes tenths of a second
_LEAST_MEMBERS = 16
_SETTLED = 1e-7  # spread of a population that has come together
_CLOSER = 2  # numbers of balls looked at closer; the best alone for a mass, or where a design takes time
_RESERVE = 1.01  # so much heavier are the fewest balls at first
_ALIKE = 1e-3  # relative: scores that are one, of which the fewest balls are taken
_STEPS, _FEW_STEPS = 80, 25  # of the search downhill, a variable
_KEPT = 1e-9  # excess over a constraint that is rounding
_ROUNDS = 6  # of lighter balls, race by race
_SAME = 1e-7  # relative: masses that are one
_FOUND = 1e-7  # of a size or its logarithm: how near the least is looked for
_DRAGS, _BESIDE = 9, 0.4  # places over the range of a drag; how far beside the last one it is looked for
_DRAG_FOUND = 1e-6  # of its logarithm: how near the best is looked for
_MOST = 1e9  # 1/s: growth where there is no state
_SLOW = 1e-3  # of the working speed: a decay to be told
_EDGE = 1e-3  # of a range: its end


@dataclass
class _Tried:
    """All designs evaluated, each once, by processes that share them."""

    problem: BallProblem  #: the search
    #: calls a function with every one of some points, as `map` does
    each: Callable[[Callable[[Array], Verdict], Iterable[Array]], Iterable[Verdict]]
    budget: Budget  #: of evaluations and time
    share: float = 0.0  #: of the search done
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
        allowed = self.budget.take(len(new)) if new else 0
        some = new[:allowed]
        for row, verdict in zip(some, self.each(self.problem.judged, some), strict=True):
            self.known[row.tobytes()] = verdict
            self.points.append(row)
        if new:
            update(self.share, 1.0, f"{len(self.points)} designs evaluated")
        if allowed < len(new):
            raise Enough(self.budget.words)
        return [self.known[row.tobytes()] for row in rows]

    def one(self, point: Array) -> Verdict:
        """Verdict on one design."""
        return self.all([point])[0]

    def best(self) -> Array:
        """The best design so far; the first of those that are alike."""
        scores = [self.known[row.tobytes()].score for row in self.points]
        return self.points[int(np.argmin(scores))]


def optimise_balls(
    scene: Scene, task: Optimisation, workers: int = 1, budget: Budget | None = None
) -> BallDesignAnswer:
    """Best balls of a scene's races within ranges [theory: races, eq. 13-15] [SP97].

    The same seed gives the same balls with any number of workers; the best so far where the search is
    interrupted or has spent its budget.
    """
    if workers < 1:
        raise InputError("workers", workers, "1 or more")
    problem = ball_problem(scene, task)
    if not problem.variables:
        raise InputError("optimise.balls", "nothing", "such that some value of the balls may change")
    shared = processes(workers) if problem.costly and workers > 1 else nullcontext()
    with shared as pool:
        tried = _Tried(problem, map if pool is None else pool.map, budget or Budget())
        start = tried.snapped(start_of(scene, problem.variables))
        interrupted, stopped = False, ""
        try:
            with stopping():
                tried.one(start)
                _evolve(tried, start)
                best = _closer(tried)
        except (KeyboardInterrupt, Enough) as why:
            if not tried.points:
                raise
            best, interrupted, stopped = tried.best(), isinstance(why, KeyboardInterrupt), str(why)
    return _result(problem, tried, best, interrupted, stopped)


def _evolve(tried: _Tried, start: Array) -> None:
    """Differential evolution over all variables, counts as whole numbers."""
    problem, variables = tried.problem, tried.problem.variables
    members, generations = (_FEW_MEMBERS, _FEW_GENERATIONS) if problem.costly else (_MEMBERS, _GENERATIONS)
    spans = [variable.bounds for variable in variables]
    moving = [k for k, (low, high) in enumerate(spans) if high > low]
    if not moving:
        return
    members = max(members, math.ceil(_LEAST_MEMBERS / len(moving)))
    done = 0

    def score(members: Array) -> Array:
        nonlocal done
        rows = np.repeat(start[None], members.shape[0], axis=0)
        rows[:, moving] = members
        found = np.array([verdict.score for verdict in tried.all(rows)])
        done += 1
        tried.share = 0.8 * min(done / (generations + 1), 1.0)
        return found

    spans, whole = [spans[k] for k in moving], whole_numbers(variables)[moving]
    evolve(score, spans, start[moving], problem.task.seed, members, generations, _SETTLED, whole)


def _closer(tried: _Tried) -> Array:
    """The best of the search, closer, for the best few numbers of balls; of equals the fewest balls."""
    whole = whole_numbers(tried.problem.variables)
    groups: dict[bytes, tuple[float, Array]] = {}
    for row in tried.points:
        score, key = tried.known[row.tobytes()].score, row[whole].tobytes()
        if key not in groups or score < groups[key][0]:
            groups[key] = score, row
    ranked = sorted(groups.values(), key=lambda found: (found[0], found[1].tolist()))
    near = [row for _, row in ranked[: 1 if tried.problem.costly or tried.problem.by_mass else _CLOSER]]
    ends = []
    for k, row in enumerate(near):
        tried.share = 0.8 + 0.15 * k / len(near)
        ends.append(_ended(tried, row))
    best = ends[int(np.argmin([tried.one(row).score for row in ends]))]
    return best if tried.problem.costly else _fewest(tried, best)


def _ended(tried: _Tried, row: Array) -> Array:
    """The end of the way from a design with as many balls."""
    return (_lightest if tried.problem.by_mass else _downhill)(tried, row)


def _fewest(tried: _Tried, best: Array) -> Array:
    """The fewest balls that do as well: of the same mass and the same drag together, then closer.

    Light balls of a race that stand together act as one of their mass and drag.
    """
    counts = [k for k, v in enumerate(tried.problem.variables) if v.name == "count"]
    score = tried.one(best).score
    if not counts or score >= WHOLE:
        return best
    for number in range(2, int(best[counts].max())):
        row = _regrouped(tried.problem, best, number)
        if np.array_equal(row, best):
            continue
        end = _ended(tried, row)
        if tried.one(end).score <= score * (1.0 + _ALIKE):
            return end
    return best


def _regrouped(problem: BallProblem, point: Array, number: int) -> Array:
    """The point with at most so many balls in each race, of the same mass and drag together."""
    changed = point.copy()
    for k, own in enumerate(problem.variables):
        if own.name != "count":
            continue
        count = max(min(point[k], float(number)), own.low)
        more = _RESERVE * point[k] / count
        powers = {"mass": 1.0, "diameter": 1.0 / 3.0, "drag": 1.0}
        changed[k] = count
        for j, other in enumerate(problem.variables):
            if other.race == own.race and other.name in powers:
                value = other.value(float(point[j])) * more ** powers[other.name]
                changed[j] = other.searched(value)
    return changed


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
    """Lighter balls race by race as long as all constraints are kept, each race with its quickest drag.

    The mass falls in every round; one round is enough for a single race.
    """
    variables = tried.problem.variables
    best = start
    if tried.one(start).excess > _KEPT:
        for k, variable in enumerate(variables):
            best = _quickest(tried, best, k) if variable.name == "drag" else best
        if tried.one(best).excess > _KEPT:
            return start
    drags = {variable.race: k for k, variable in enumerate(variables) if variable.name == "drag"}
    for _ in range(_ROUNDS):
        before = tried.one(best).mass
        for k, variable in enumerate(variables):
            if variable.name == "radius":
                wide = _moved(best, k, variable.bounds[1])
                best = wide if tried.one(wide).excess <= _KEPT else best
        for k, variable in enumerate(variables):
            if variable.name in ("mass", "diameter"):
                best = _smallest(tried, best, k, drags.get(variable.race))
        if before - tried.one(best).mass <= _SAME * before:
            break
    return best


def _moved(row: Array, k: int, value: float) -> Array:
    """The point with another value of one variable."""
    changed = row.copy()
    changed[k] = value
    return changed


def _smallest(tried: _Tried, row: Array, k: int, drag: int | None) -> Array:
    """The least size of the balls of a race with which some drag keeps the constraints, by halving."""

    def kept(size: float, near: Array) -> Array | None:
        moved = _moved(near, k, size)
        if tried.one(moved).excess > _KEPT and drag is not None:
            moved = _quickest(tried, moved, drag, _BESIDE)
        return moved if tried.one(moved).excess <= _KEPT else None

    best = row if drag is None else _quickest(tried, row, drag)
    best = best if tried.one(best).excess <= _KEPT else row
    bad = tried.problem.variables[k].bounds[0]
    end = kept(bad, best)
    if end is not None:
        return end
    while best[k] - bad > _FOUND:
        middle = 0.5 * (float(best[k]) + bad)
        lighter = kept(middle, best)
        if lighter is None:
            bad = middle
        else:
            best = lighter
    return best


def _quickest(tried: _Tried, row: Array, k: int, beside: float | None = None) -> Array:
    """The drag at which small motions decay fastest, whatever else it does."""
    from scipy.optimize import minimize_scalar

    low, high = tried.problem.variables[k].bounds
    begin = float(row[k])

    def growth(place: float) -> float:
        return min(tried.one(_moved(row, k, place)).growth, _MOST)

    if beside is None:
        places = np.linspace(low, high, _DRAGS)
        begin, beside = min([begin, *places.tolist()], key=growth), float(places[1] - places[0])
    near = max(begin - beside, low), min(begin + beside, high)
    if near[1] <= near[0]:
        return row
    found = minimize_scalar(growth, bounds=near, method="bounded", options={"xatol": _DRAG_FOUND})
    return _moved(row, k, min([begin, float(found.x)], key=growth))


def _designed(race: BallRace) -> DesignedRace:
    """A race as answers keep it."""
    names = "count", "diameter", "drag", "radius", "plane", "capacity"
    return DesignedRace(
        mass=race.each, sized_by=size_of(race), **{name: getattr(race, name) for name in names}
    )


def _result(
    problem: BallProblem, tried: _Tried, best: Array, interrupted: bool, stopped: str
) -> BallDesignAnswer:
    """The best balls with all that belongs to them."""
    scene, variables = problem.scene, problem.variables
    chosen, verdict = with_balls(scene, variables, best), tried.one(best)
    # The scene's own balls, whatever the ranges.
    own = replace(problem, variables=()).judged(np.empty(0))
    verdicts = [tried.known[row.tobytes()] for row in tried.points]
    values = np.array([values_of(variables, row) for row in tried.points])
    designs = [with_balls(scene, variables, row) for row in tried.points]
    return BallDesignAnswer(
        **about(scene, problem.task),
        unused=("runup",) if problem.task.objective != "peak" else (),
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
        constraints={name: limit.at(verdict.values[name], 1e-9) for name, limit in problem.limits.items()},
        unbalances=np.array(problem.unbalances),
        evaluations=len(tried.points),
        tried=TriedDesigns(
            values=values,
            count=np.array([sum(race.count for race in each.balls) for each in designs]),
            **{
                name: np.array([getattr(each, name) for each in verdicts])
                for name in ("mass", "vibration", "growth", "excess")
            },
        ),
        volume=np.array([fill.volume for fill in scene.fills]),
        response=run_balls(chosen),
        interrupted=interrupted,
        stopped=stopped,
        notes=(
            *problem.notes,
            *(
                [notes.interrupted(len(tried.points), "designs", limit=stopped)]
                if interrupted or stopped
                else []
            ),
            *_findings(problem, best, verdict),
            *doubts(scene),
        ),
    )


def _findings(problem: BallProblem, best: Array, verdict: Verdict) -> Iterator[Note]:
    """What must be known of the answer."""
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
