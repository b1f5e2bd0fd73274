"""Search for the best point of a box whose constraints and plateaus a judge knows [theory: optimum, eq. 6-8].

A grid, then steps downhill from its best valleys, along axes, exchanges and rays, then along the floor of a
bent valley or an edge of what is allowed, and at last the least cost among equals, by the same steps.
"""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array
from meshes.errors import InputError

# Lengths of the steps tried at once: of one coordinate, of two, of exchanges, along a ray.
_ONE, _TWO, _EXCHANGE = (1.0, 0.45, 0.2, 0.06, 0.015), (1.0, 0.3, 0.06), (1.0, 0.25)
_RAY = (-1.0, -0.3, -0.08, 0.0, 0.08, 0.3, 1.0)
_RAY_ROUNDS = 2
# Of the distance of levels: steps of one coordinate, and of more, that have looked closely.
_FINE = (4e-2, 0.3)
_EQUAL = 1e-12  # relative; on the way down only rounding makes values equal
_ROUNDS = 3  # of the search for the least cost, if it finds a better objective by the way
_NOTHING = 1e-300
# Shares of a search that are done after its stages, as they come on average.
_GRID, _DOWN, _ALONG, _POLISH = 0.15, 0.35, 0.5, 0.6
_BASES, _POLISHED = 2, 1e-4  # sets of directions tried at once; shortest step over the gap of the levels
# Lengths at which steps end, over the distance of the levels around the point, for one coordinate and more.
_SHORTEST = (1e-5, 1e-2)


@dataclass(frozen=True)
class Judgement:
    """What a judge says of m points."""

    objective: Array  #: to be least; infinite where there is no value, shape (m,)
    excess: Array  #: of the constraint that is exceeded most, relative; 0 or below where all hold, shape (m,)
    details: dict[str, Array] = field(default_factory=dict)  #: further values by name, shape (m,) each


def joined(parts: Sequence[Judgement]) -> Judgement:
    """Judgements of several sets of points as one, one set after the other; at least one."""
    return Judgement(
        np.concatenate([said.objective for said in parts]),
        np.concatenate([said.excess for said in parts]),
        {name: np.concatenate([said.details[name] for said in parts]) for name in parts[0].details},
    )


Judge = Callable[[Array], Judgement]  # takes points, shape (m, n)


class Enough(Exception):  # noqa: N818  # no error
    """Ends a search with what it has; raised by a judge that was asked for more than it may answer.

    `said`: of the first of the points that it was asked for, None where it answered for none of them.
    """

    def __init__(self, why: str, said: Judgement | None = None) -> None:
        super().__init__(why)
        self.said = said


class Budget:
    """What a search may spend: evaluations, and seconds from now; None where it may take any number."""

    def __init__(self, evaluations: int | None = None, seconds: float | None = None) -> None:
        self.left = math.inf if evaluations is None else evaluations
        self.until = math.inf if seconds is None else time.monotonic() + seconds
        self.begun = False
        self.words = "" if evaluations is None else f"{evaluations} evaluations"  # which of both ended it
        self._seconds = "" if seconds is None else f"{seconds:g} s"

    def take(self, count: int) -> int:
        """How many of some evaluations may be made; `Enough` where none may.

        The first are made whatever the time: without any there is no answer.
        """
        if self.begun:
            self.look()
        if self.left <= 0:
            raise Enough(self.words)
        self.begun, count = True, int(min(count, self.left))
        self.left -= count
        return count

    def look(self) -> None:
        """`Enough` where the time is over."""
        if time.monotonic() > self.until:
            self.words = self._seconds
            raise Enough(self.words)


@dataclass(frozen=True)
class SearchPlan:
    """How much a search tries."""

    #: of each coordinate in the grid, by the number of coordinates; beyond the last, lines instead
    levels: tuple[int, ...] = (24, 11, 5)
    #: expected coordinates become levels even of three and more; else those points join the grid
    crossed: bool = True
    finest: float = 1e-4  #: lowest level above the lower corner, over the box's width
    valleys: int = 3  #: of the grid from which steps go down
    sweeps: int = 16  #: of steps, at most
    settled: float = 2e-5  #: relative gain of a round below which a valley counts as followed to its end
    margin: float = 1e-6  #: values that differ by less, relative, count as equal in the end
    #: distance at which the edge of a plateau or of what is allowed counts as found, over its place
    edge: float = 1e-6
    sections: int = 32  #: into which such an edge is closed in at once
    polish: int = 20  #: sweeps in changing directions, at most
    #: binary digits to which points between the corners are rounded, so that neighbours that no answer tells
    #: apart are judged once; 0: they are not
    digits: int = 0
    at_once: int = 0  #: points that a judge is asked for at once, at most; 0: any number


def best_of(judged: Judgement, cost: Array, margin: float = 1e-6, tie: float | None = None) -> int:
    """Index of the best of the points judged [theory: optimum, eq. 6].

    Those that exceed their constraints least, of these the least objective, of those within a margin of it
    the least cost, and of those the one that is farthest from exceeding anything. `tie` is the margin of cost
    and of the room to the limits; None: that of the objective.
    """
    over = np.maximum(judged.excess, 0.0)
    left = np.flatnonzero(over <= over.min() * (1.0 + margin))
    tie = margin if tie is None else tie
    for values, within in ((judged.objective, margin), (cost, tie), (judged.excess, tie)):
        here = values[left]
        least = here.min()
        near = here <= least + within * abs(least) if np.isfinite(least) else here == least
        left = left[near]
    return int(left[0])


@dataclass(frozen=True)
class Found:
    """The best point of a search and all that were judged; m points of n coordinates."""

    point: Array  #: shape (n,)
    objective: float  #: its value; 0 or below if the point is allowed
    excess: float
    points: Array  #: all that were judged, shape (m, n)
    judged: Judgement  #: what was said of them
    interrupted: bool = False  #: by a signal: the best of what was judged until then
    stopped: str = ""  #: why the judge answered no more, which ended the search likewise

    @property
    def feasible(self) -> bool:
        """The point exceeds no constraint."""
        return self.excess <= 0.0


def search(
    judge: Judge,
    low: Array,
    high: Array,
    cost: Array,
    starts: Array | None = None,
    alike: Sequence[Sequence[int]] = (),
    plan: SearchPlan | None = None,
    stage: Callable[[float], None] | None = None,
) -> Found:
    """Best point of a box, the same for the same question; least excess where none is allowed.

    `cost` decides between points of equal objective; `starts` are points where an edge or a kink is expected,
    whose coordinates become levels; coordinates of a group in `alike` may be exchanged without a change and
    are ordered by falling value. No point that was judged beats the answer in the order of `best_of`. A
    Ctrl-C and `Enough` end the search with what it has.
    """
    plan = plan or SearchPlan()
    if not (np.all(np.isfinite(low)) and np.all(np.isfinite(high)) and np.all(low <= high)):
        raise InputError("bounds", [low.tolist(), high.tolist()], "finite, low at most high")
    ask, interrupted, stopped = _Log(judge, low, high, plan), False, ""
    try:
        _searched(ask, low, high, cost, starts, alike, plan, stage or (lambda _: None))
        k = _answer(ask, cost, alike, plan)
    except (KeyboardInterrupt, Enough) as why:
        if not ask.kept:
            raise
        points, said = ask.all()
        k = best_of(said, points @ cost, plan.margin, _EQUAL)
        interrupted, stopped = isinstance(why, KeyboardInterrupt), str(why)
    every, judged = ask.all()
    value, over = float(judged.objective[k]), float(judged.excess[k])
    return Found(every[k], value, over, every, judged, interrupted, stopped)


def _searched(
    ask: _Log,
    low: Array,
    high: Array,
    cost: Array,
    starts: Array | None,
    alike: Sequence[Sequence[int]],
    plan: SearchPlan,
    stage: Callable[[float], None],
) -> None:
    """Ask for all points that it takes to find the best."""
    expected = np.empty((0, low.size)) if starts is None else np.clip(starts, low, high)
    crossing = expected if plan.crossed or low.size < 3 else expected[:0]
    levels = [_levels(low[i], high[i], crossing[:, i], low.size, plan) for i in range(low.size)]
    points = _grid(levels, expected, alike, plan)
    said = ask(points)
    kept = _valleys(points, said, cost, levels, plan)
    stage(_GRID)
    point, gap = _descend(ask, points[kept], low, high, cost, levels, plan)
    stage(_DOWN)
    if low.size > 1:
        point = _follow(ask, point, low, high, cost, gap, plan)
        stage(_ALONG)
        _polished(ask, point, low, high, cost, gap, plan)
    stage(_POLISH)
    _least_cost(ask, low, high, cost, levels, plan)


class _Log:
    """Asks the judge and keeps what it said."""

    def __init__(self, judge: Judge, low: Array, high: Array, plan: SearchPlan) -> None:
        self.judge, self.low, self.high, self.plan = judge, low, high, plan
        self.kept: list[tuple[Array, Judgement]] = []
        self._place: dict[bytes, int] = {}  # of points in the order in which they are kept

    def __call__(self, points: Array) -> Judgement:
        """Judgement of points, shape (m, n); what is not a number counts as infinite."""
        if not self.plan.digits:
            return self._asked(points)
        rows = np.ascontiguousarray(self._rounded(points))
        keys = [row.tobytes() for row in rows]
        fresh = {key: k for k, key in reversed(list(enumerate(keys))) if key not in self._place}
        new = sorted(fresh.values())
        if new:
            self._asked(rows[new])
        at = np.array([self._place[key] for key in keys])
        _, every = self.all()
        details = {name: value[at] for name, value in every.details.items()}
        return Judgement(every.objective[at], every.excess[at], details)

    def _asked(self, points: Array) -> Judgement:
        """What the judge says of points, of which it hears a few at once."""
        few, parts = self.plan.at_once or max(points.shape[0], 1), []
        for first in range(0, max(points.shape[0], 1), few):
            rows = points[first : first + few]
            try:
                parts.append(self._keep(rows, self.judge(rows)))
            except Enough as end:
                if end.said is not None:
                    self._keep(rows[: end.said.objective.size], end.said)
                raise
        return joined(parts)

    def _keep(self, rows: Array, said: Judgement) -> Judgement:
        """A judgement with numbers only, which is remembered."""
        objective = np.where(np.isnan(said.objective), np.inf, said.objective)
        said = Judgement(objective, np.where(np.isnan(said.excess), np.inf, said.excess), said.details)
        self._place |= {row.tobytes(): len(self._place) + k for k, row in enumerate(rows)}
        # Whoever asks may change them afterwards.
        self.kept.append((rows.copy(), Judgement(objective.copy(), said.excess.copy(), said.details)))
        return said

    def _rounded(self, points: Array) -> Array:
        """Points with so many binary digits as the plan has; corners of the box stay where they are."""
        part, power = np.frexp(points)
        size = 2.0**self.plan.digits
        near = np.clip(np.ldexp(np.round(part * size) / size, power), self.low, self.high)
        return np.asarray(np.where((points == self.low) | (points == self.high), points, near))

    def all(self) -> tuple[Array, Judgement]:
        """Every point and what was said of it."""
        return np.concatenate([points for points, _ in self.kept]), joined([said for _, said in self.kept])


def _directions(point: Array, low: Array, cost: Array, gap: Array) -> Array:
    """Steps from a point: along the axes, exchanges at equal cost, along the ray from the lower corner."""
    n = point.size
    axes = [np.where(np.arange(n) == i, gap, 0.0) for i in range(n)]
    away = point - low
    held = (away > 0.0) & (gap > 0.0)
    ray = [away * np.min(gap[held] / away[held])] if n > 1 and np.any(held) else []
    return np.array([*axes, *_exchanges(cost, gap), *ray])


def _exchanges(cost: Array, gap: Array) -> list[Array]:
    """Steps that take from one coordinate what they give to another, at equal cost."""
    steps = []
    for i, j in itertools.combinations(range(cost.size), 2):
        moved = min(cost[i] * gap[i], cost[j] * gap[j])
        step = np.zeros(cost.size)
        step[i], step[j] = moved / cost[i], -moved / cost[j]
        steps.append(step)
    return steps


def _descend(
    ask: Judge,
    points: Array,
    low: Array,
    high: Array,
    cost: Array,
    levels: list[Array],
    plan: SearchPlan,
) -> tuple[Array, Array]:
    """Steps of many lengths from several points at once; the best point, and the levels' gaps around it."""
    gaps = np.array([[_gap(level, x) for level, x in zip(levels, row, strict=True)] for row in points])
    factor, said = np.ones(points.shape[0]), ask(points)
    shortest = _SHORTEST[min(low.size, 2) - 1]
    ladder = np.array(_ONE if low.size == 1 else _TWO)
    signed = np.concatenate((ladder, -ladder))
    for sweep in range(plan.sweeps):
        rows, lengths, gains, looked = [], [], np.zeros(points.shape[0]), factor.copy()
        moved = np.zeros(points.shape[0], dtype=bool)
        for row, gap, scale in zip(points, gaps, factor, strict=True):
            steps = _directions(row, low, cost, scale * gap)
            tried = row + (signed[:, None, None] * steps).reshape(-1, row.size)
            rows.append(np.concatenate((row[None], np.clip(tried, low, high))))
            lengths.append(np.concatenate(([0.0], np.repeat(np.abs(signed), steps.shape[0]))))
        answer = _ask_apart(ask, rows, said)
        for k, (tried, length, heard) in enumerate(zip(rows, lengths, answer, strict=True)):
            best = best_of(heard, tried @ cost, _EQUAL)
            points[k] = tried[best]
            gains[k], moved[k] = _gain(said, heard, k, best), best > 0
            said.objective[k], said.excess[k] = heard.objective[best], heard.excess[best]
            # The next ladder reaches twice as far as the step that was best, and starts below the least.
            factor[k] *= np.clip(2.0 * length[best], 2.0 * ladder[-1], 2.0)
        keep = _still_in_the_race(points, said, cost, sweep)
        # A plateau is left to the end, which walks to its edge at once.
        keep &= (factor > shortest) & ~(
            (gains <= plan.settled) & (moved | (looked < _FINE[min(low.size, 2) - 1]))
        )
        if not keep.any():
            break
        keep[best_of(said, points @ cost, _EQUAL)] = True
        points, gaps, factor = points[keep], gaps[keep], factor[keep]
        said = Judgement(said.objective[keep], said.excess[keep])
    winner = best_of(said, points @ cost, _EQUAL)
    return points[winner].copy(), gaps[winner]


def _follow(
    ask: Judge, point: Array, low: Array, high: Array, cost: Array, gap: Array, plan: SearchPlan
) -> Array:
    """Along the floor of a bent valley or along an edge of what is allowed [theory: optimum, eq. 8].

    The shares are exchanged, and each trial goes down along its own ray from the lower corner, so that a
    valley or an edge that crosses the rays is met in each of them.
    """
    said, factor = ask(point[None]), 1.0
    value, over = float(said.objective[0]), float(said.excess[0])
    for _ in range(plan.sweeps):
        swaps = np.array(_exchanges(cost, factor * np.maximum(gap, 1e-3 * (high - low))))
        signed = np.array([sign * length for length in _EXCHANGE for sign in (1.0, -1.0)])
        tried = np.clip(point + (signed[:, None, None] * swaps).reshape(-1, point.size), low, high)
        tried = np.concatenate((point[None], tried))
        # As far along the rays as the exchanges reach, with some room.
        reach = 3.0 * np.max(np.abs(swaps) @ cost) / max(2.0 * float(cost @ (point - low)), 1e-300)
        tried, heard = _along_rays(ask, tried, low, high, cost, float(np.clip(reach, 1e-6, 0.5)))
        best = best_of(heard, tried @ cost, _EQUAL)
        better = _gain(Judgement(np.array([value]), np.array([over])), heard, 0, best)
        length = np.abs(signed)[(best - 1) // swaps.shape[0]] if best > 0 else 0.0
        factor *= float(np.clip(2.0 * length, 0.3, 2.0))
        small = better <= plan.settled
        point, value, over = tried[best], float(heard.objective[best]), float(heard.excess[best])
        if small and factor < 0.03:
            break
    return point


def _polished(
    ask: Judge, point: Array, low: Array, high: Array, cost: Array, gap: Array, plan: SearchPlan
) -> Array:
    """Steps in directions that change from sweep to sweep [theory: optimum].

    Where a curved edge of what is allowed crosses a valley, no step of a fixed set need go down along it.
    """
    chance, said, factor = np.random.default_rng(0), ask(point[None]), 0.3
    reach = np.maximum(gap, 1e-3 * (high - low))
    for _ in range(plan.polish):
        # As far in every direction at equal cost as the least of the gaps.
        size = np.min((cost * reach)[reach > 0.0], initial=np.inf) * factor / cost
        bases = [np.linalg.qr(chance.normal(size=(point.size, point.size)))[0] for _ in range(_BASES)]
        steps = np.concatenate([sign * basis for basis in bases for sign in (1.0, -1.0)])
        steps = np.concatenate((steps, 0.2 * steps)) * np.where(reach > 0.0, size, 0.0)
        tried = np.clip(point + steps, low, high)
        (heard,) = _ask_apart(ask, [np.concatenate((point[None], tried))], said)
        best = best_of(heard, np.concatenate((point[None], tried)) @ cost, _EQUAL)
        if best > 0:
            point = tried[best - 1]
            said = Judgement(heard.objective[best : best + 1], heard.excess[best : best + 1])
        factor *= 2.0 if best > 0 else 0.4
        if factor < _POLISHED:
            break
    return point


def _along_rays(
    ask: Judge, points: Array, low: Array, high: Array, cost: Array, reach: float
) -> tuple[Array, Judgement]:
    """The best point near each of several on its ray from the lower corner, and what was said of it."""
    away = points - low
    farthest = np.where(away > 0.0, (high - low) / np.where(away > 0.0, away, 1.0), np.inf).min(axis=1)
    farthest = np.where(np.isfinite(farthest), farthest, 1.0)
    at = np.clip(1.0 + reach * np.array(_RAY), 0.0, farthest[:, None])
    best_at, best = np.ones(points.shape[0]), Judgement(*np.full((2, points.shape[0]), np.inf))
    for k in range(_RAY_ROUNDS + 1):
        rows = [np.clip(low + t[:, None] * ray, low, high) for t, ray in zip(at, away, strict=True)]
        if k > 0:
            rows = [
                np.concatenate((low + t * ray[None], row))
                for t, ray, row in zip(best_at, away, rows, strict=True)
            ]
            answers = _ask_apart(ask, rows, best)
            at = np.concatenate((best_at[:, None], at), axis=1)
        else:
            whole = ask(np.concatenate(rows))
            parts = np.split(np.arange(whole.objective.size), points.shape[0])
            answers = [Judgement(whole.objective[p], whole.excess[p]) for p in parts]
        chosen = [best_of(heard, row @ cost, _EQUAL) for heard, row in zip(answers, rows, strict=True)]
        best = Judgement(
            np.array([heard.objective[c] for heard, c in zip(answers, chosen, strict=True)]),
            np.array([heard.excess[c] for heard, c in zip(answers, chosen, strict=True)]),
        )
        best_at = at[np.arange(at.shape[0]), chosen]
        before = np.max(np.where(at < best_at[:, None], at, 0.0), axis=1)
        behind = np.min(np.where(at > best_at[:, None], at, farthest[:, None]), axis=1)
        thirds = np.array([1.0, 2.0]) / 3.0
        at = np.concatenate(
            (
                before[:, None] + (best_at - before)[:, None] * thirds,
                best_at[:, None] + (behind - best_at)[:, None] * thirds,
            ),
            axis=1,
        )
    return np.clip(low + best_at[:, None] * away, low, high), best


def _gain(before: Judgement, now: Judgement, k: int, best: int) -> float:
    """Relative gain of the objective; infinite where constraints are exceeded by less than before."""
    if max(now.excess[best], 0.0) < max(before.excess[k], 0.0) or not np.isfinite(before.objective[k]):
        return math.inf
    gain, size = before.objective[k] - now.objective[best], abs(now.objective[best])
    return float(gain / size) if size > 0.0 else float(gain > 0.0)


def _gap(levels: Array, value: float) -> float:
    """Distance between the levels around a value."""
    if levels.size == 1:
        return 0.0
    k = int(np.clip(np.searchsorted(levels, value), 1, levels.size - 1))
    return float(levels[min(k + 1, levels.size - 1)] - levels[max(k - 1, 0)]) / 2.0


def _ask_apart(ask: Judge, rows: list[Array], said: Judgement) -> list[Judgement]:
    """Judgements of several sets of points, asked for at once; the first of each set is known already."""
    fresh = ask(np.concatenate([tried[1:] for tried in rows]))
    found, begin = [], 0
    for k, tried in enumerate(rows):
        part = slice(begin, begin + tried.shape[0] - 1)
        begin = part.stop
        found.append(
            Judgement(
                np.concatenate((said.objective[k : k + 1], fresh.objective[part])),
                np.concatenate((said.excess[k : k + 1], fresh.excess[part])),
            )
        )
    return found


def _still_in_the_race(points: Array, said: Judgement, cost: Array, sweep: int) -> NDArray[np.bool_]:
    """Which points steps go on from: after two sweeps those only that are not far behind the best."""
    best = best_of(said, points @ cost, _EQUAL)
    if sweep < 1:
        return np.ones(said.objective.shape, dtype=bool)
    over = np.maximum(said.excess, 0.0)
    near = over <= max(1.1 * over[best], 1e-3)
    limit = abs(said.objective[best])
    return np.asarray(near & (said.objective <= said.objective[best] + 0.03 * limit))


def _levels(low: float, high: float, expected: Array, count: int, plan: SearchPlan) -> Array:
    """Values of one coordinate in the grid: both ends, crowding towards the lower one, and those expected."""
    if high == low:
        return np.array([low])
    number = plan.levels[min(count, len(plan.levels)) - 1]
    share = np.geomspace(plan.finest, 1.0, max(number - 1, 2))
    if count == 1:
        # Room for even steps as well: a valley far from the corner may be narrow beside its place.
        share = np.concatenate((share, np.linspace(0.0, 1.0, number // 2)[1:-1]))
    values = np.concatenate(([low, high], low + (high - low) * share, expected))
    return np.unique(np.clip(values, low, high))


def _grid(levels: list[Array], expected: Array, alike: Sequence[Sequence[int]], plan: SearchPlan) -> Array:
    """Points of the grid, those expected among them, without what an exchange makes equal."""
    if len(levels) <= len(plan.levels):
        points = np.array(list(itertools.product(*levels)))
    else:
        points = _lines(levels, expected)
    return np.unique(_ordered(np.concatenate((points, expected)), alike), axis=0)


def _ordered(points: Array, alike: Sequence[Sequence[int]]) -> Array:
    """Points whose exchangeable coordinates fall, shape (m, n)."""
    points = points.copy()
    for group in alike:
        points[:, list(group)] = np.sort(points[:, list(group)], axis=1)[:, ::-1]
    return points


def _lines(levels: list[Array], expected: Array) -> Array:
    """Points along each axis through the lower corner, the diagonal and each point expected."""
    low = np.array([level[0] for level in levels])
    share = [
        np.interp(np.linspace(0.0, 1.0, 24), np.linspace(0.0, 1.0, level.size), level) for level in levels
    ]
    diagonal = np.stack(share, axis=1)
    rows = [diagonal]
    for base in (low, *expected):
        for i, level in enumerate(levels):
            line = np.tile(base, (level.size, 1))
            line[:, i] = level
            rows.append(line)
    return np.concatenate(rows)


def _rank(points: Array, levels: list[Array]) -> Array:
    """Place of points among the levels, so that neighbours are a distance of 1 apart."""
    return np.stack(
        [np.interp(points[:, i], level, np.arange(level.size)) for i, level in enumerate(levels)], 1
    )


def _valleys(points: Array, said: Judgement, cost: Array, levels: list[Array], plan: SearchPlan) -> list[int]:
    """The best points of the grid that are not neighbours of one another."""
    rank, kept = _rank(points, levels), list[int]()
    left = np.arange(points.shape[0])
    while left.size and len(kept) < plan.valleys:
        part = Judgement(said.objective[left], said.excess[left])
        k = int(left[best_of(part, points[left] @ cost, plan.margin)])
        kept.append(k)
        left = left[np.abs(rank[left] - rank[k]).max(axis=1) > 1.5]
    return kept


def _equals(said: Judgement, margin: float) -> tuple[float, float]:
    """Objective up to which points count as equal to the best, and excess up to which they are allowed."""
    over = np.maximum(said.excess, 0.0)
    most = float(over.min())
    least = float(said.objective[over <= most * (1.0 + margin)].min())
    return least + margin * abs(least), most * (1.0 + margin)


def _least_cost(
    ask: _Log,
    low: Array,
    high: Array,
    cost: Array,
    levels: list[Array],
    plan: SearchPlan,
) -> None:
    """Search for the least cost among points that count as equal to the best one, all of which are kept.

    A problem of its own: the cost is to be least, the best objective is a limit. Its search starts at the
    cheapest of the points that are known to be as good, which may be far from the best one.
    """
    for _ in range(_ROUNDS):
        points, said = ask.all()
        limit, most = _equals(said, plan.margin)
        if not math.isfinite(limit):
            return

        def cheap(tried: Array, limit: float = limit, most: float = most) -> Judgement:
            heard = ask(tried)
            beyond = (heard.objective - limit) / max(abs(limit), _NOTHING)
            return Judgement(tried @ cost, np.maximum(heard.excess - most, beyond))

        good = (np.maximum(said.excess, 0.0) <= most) & (said.objective <= limit)
        equal = points[good]
        kept = _valleys(equal, Judgement(equal @ cost, np.full(equal.shape[0], -1.0)), cost, levels, plan)
        best = equal[kept[0]]
        is_cost = bool(np.all(np.abs(said.objective - points @ cost) <= _EQUAL * np.abs(said.objective)))
        if low.size > 1 and not is_cost:
            best, gap = _descend(cheap, equal[kept].copy(), low, high, cost, levels, plan)
            best = _follow(cheap, best, low, high, cost, gap, plan)
            best = _polished(cheap, best, low, high, cost, gap, plan)
        _to_edges(cheap, best, low, cost, plan)
        points, said = ask.all()
        if _equals(said, plan.margin) == (limit, most):
            return


def _answer(ask: _Log, cost: Array, alike: Sequence[Sequence[int]], plan: SearchPlan) -> int:
    """Index of the best of all points judged."""
    points, said = ask.all()
    k = best_of(said, points @ cost, plan.margin, _EQUAL)
    in_order = _ordered(points[k][None], alike)
    if np.array_equal(in_order[0], points[k]):
        return k
    same, (limit, most) = ask(in_order), _equals(said, plan.margin)
    # An exchange changes the last digit of a sum, which may be one too many at an edge.
    as_good = same.objective[0] <= limit and max(same.excess[0], 0.0) <= most
    return points.shape[0] if as_good else k


def _to_edges(ask: Judge, point: Array, low: Array, cost: Array, plan: SearchPlan) -> None:
    """The point drawn towards the lower corner, axis by axis, as far as it is allowed."""
    point = point.copy()
    order = np.argsort(-(cost * (point - low)), kind="stable")
    for i in order.tolist():
        if point[i] > low[i]:
            point[i] = _least_on_axis(ask, point, i, low[i], plan)


def _least_on_axis(ask: Judge, point: Array, axis: int, low: float, plan: SearchPlan) -> float:
    """Least value of one coordinate at which the point is allowed; the edge is closed in by many at once."""
    bad, good, first = low, float(point[axis]), True
    while good - bad > plan.edge * (good - low):
        inner = np.linspace(bad, good, plan.sections + 1)[1:-1]
        if first:  # the edge may lie close to the corner
            near = low + (good - low) * np.geomspace(1e-4, 1.0 / plan.sections, 6)
            inner, first = np.concatenate(([low], near[:-1], inner)), False
        tried = np.tile(point, (inner.size, 1))
        tried[:, axis] = inner
        holds = ask(tried).excess <= 0.0
        k = int(np.argmax(holds)) if holds.any() else inner.size
        if k == 0 and inner[0] == low:
            return low
        if k < inner.size:
            good = float(inner[k])
        bad = float(inner[k - 1]) if k > 0 else bad
    return good


def evolve(
    score: Callable[[Array], Array],
    bounds: Sequence[tuple[float, float]],
    start: Array,
    seed: int,
    members: int,
    generations: int,
    settled: float,
    whole: NDArray[np.bool_] | None = None,
) -> Array:
    """The end of differential evolution [SP97], shape (v,); `start` is one of the first population.

    `score`, to be least, of m members, shape (m, v); `members` a variable, `generations` at most; `settled`
    the spread of a population that has come together; `whole` says which variables are whole numbers.
    """
    from scipy.optimize import differential_evolution

    found = differential_evolution(
        lambda columns: score(columns.T),
        bounds,
        integrality=whole,
        x0=start,
        rng=np.random.default_rng(seed),
        popsize=members,
        maxiter=generations,
        init="sobol",
        tol=settled,
        atol=settled**2,
        polish=False,
        updating="deferred",
        vectorized=True,
    )
    return np.asarray(found.x)
