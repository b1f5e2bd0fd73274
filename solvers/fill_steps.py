"""Steps downhill of a search for the best fill: along axes, exchanges and rays [theory: optimum, eq. 7-8]."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from solvers.fill_judged import Array, Judgement, Log, SearchPlan, best_of

# Lengths of the steps tried at once: of one coordinate, of two, of exchanges, along a ray.
_ONE, _TWO, _EXCHANGE = (1.0, 0.45, 0.2, 0.06, 0.015), (1.0, 0.3, 0.06), (1.0, 0.25)
_RAY = (-1.0, -0.3, -0.08, 0.0, 0.08, 0.3, 1.0)
_RAY_ROUNDS = 2
# Of the distance of levels: steps of one coordinate, and of more, that have looked closely.
_FINE = (4e-2, 0.3)
_EQUAL = 1e-12  # relative; on the way down only rounding makes values equal
# Lengths at which steps end, over the distance of the levels around the point, for one coordinate and more.
_SHORTEST = (1e-5, 1e-2)


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


def descend(
    ask: Log,
    points: Array,
    low: Array,
    high: Array,
    cost: Array,
    levels: list[Array],
    plan: SearchPlan,
) -> tuple[Array, Array]:
    """Steps of many lengths from several points at once; the best point, and the levels' gaps around it."""
    gaps = np.array([[_gap(one, x) for one, x in zip(levels, row, strict=True)] for row in points])
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
        for k, (tried, length, one) in enumerate(zip(rows, lengths, answer, strict=True)):
            best = best_of(one, tried @ cost, _EQUAL)
            points[k] = tried[best]
            gains[k], moved[k] = _gain(said, one, k, best), best > 0
            said.objective[k], said.excess[k] = one.objective[best], one.excess[best]
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


def follow(
    ask: Log, point: Array, low: Array, high: Array, cost: Array, gap: Array, plan: SearchPlan
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
        tried, one = _along_rays(ask, tried, low, high, cost, float(np.clip(reach, 1e-6, 0.5)))
        best = best_of(one, tried @ cost, _EQUAL)
        better = _gain(Judgement(np.array([value]), np.array([over])), one, 0, best)
        length = np.abs(signed)[(best - 1) // swaps.shape[0]] if best > 0 else 0.0
        factor *= float(np.clip(2.0 * length, 0.3, 2.0))
        small = better <= plan.settled
        point, value, over = tried[best], float(one.objective[best]), float(one.excess[best])
        if small and factor < 0.03:
            break
    return point


def _along_rays(
    ask: Log, points: Array, low: Array, high: Array, cost: Array, reach: float
) -> tuple[Array, Judgement]:
    """The best point near each of several on its ray from the lower corner, and what was said of it."""
    away = points - low
    farthest = np.where(away > 0.0, (high - low) / np.where(away > 0.0, away, 1.0), np.inf).min(axis=1)
    farthest = np.where(np.isfinite(farthest), farthest, 1.0)
    at = np.clip(1.0 + reach * np.array(_RAY), 0.0, farthest[:, None])
    best_at, best = np.ones(points.shape[0]), Judgement(*np.full((2, points.shape[0]), np.inf))
    for k in range(_RAY_ROUNDS + 1):
        rows = [np.clip(low + t[:, None] * one, low, high) for t, one in zip(at, away, strict=True)]
        if k > 0:
            rows = [
                np.concatenate((low + t * one[None], row))
                for t, one, row in zip(best_at, away, rows, strict=True)
            ]
            answers = _ask_apart(ask, rows, best)
            at = np.concatenate((best_at[:, None], at), axis=1)
        else:
            whole = ask(np.concatenate(rows))
            parts = np.split(np.arange(whole.objective.size), points.shape[0])
            answers = [Judgement(whole.objective[p], whole.excess[p]) for p in parts]
        chosen = [best_of(one, row @ cost, _EQUAL) for one, row in zip(answers, rows, strict=True)]
        best = Judgement(
            np.array([one.objective[c] for one, c in zip(answers, chosen, strict=True)]),
            np.array([one.excess[c] for one, c in zip(answers, chosen, strict=True)]),
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


def _ask_apart(ask: Log, rows: list[Array], said: Judgement) -> list[Judgement]:
    """Judgements of several sets of points, asked for at once; the first of each set is known already."""
    fresh = ask(np.concatenate([one[1:] for one in rows]))
    found, begin = [], 0
    for k, one in enumerate(rows):
        part = slice(begin, begin + one.shape[0] - 1)
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
