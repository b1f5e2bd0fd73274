"""Global search of a box for the least of a function smooth in pieces, with kinks, jumps and plateaus.

A grid of levels that crowd towards the lower corner finds the valleys; from the best of them steps of many
lengths along the axes, along exchanges of one coordinate for another and along the ray from the lower corner
go down; at last the point is drawn to the least cost that keeps its value [theory: optimum, eq. 6-8]. The
function is asked about many points at once.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshes.border import InputError
from solvers.fill_judged import Array, Judge, Judgement, Log, SearchPlan, best_of
from solvers.fill_steps import descend, follow


@dataclass(frozen=True)
class Found:
    """The best point of a search and all that were judged; m points of n coordinates.

    Parameters
    ----------
    point : shape (n,)
    objective, excess : its value; 0 or below if the point is allowed
    points : all that were judged, shape (m, n)
    judged : what was said of them
    grid : how many of them, the first, are the grid's
    """

    point: Array
    objective: float
    excess: float
    points: Array
    judged: Judgement
    grid: int

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
) -> Found:
    """Best point of a box; the same answer to the same question.

    Parameters
    ----------
    judge : of the points
    low, high : the box, shape (n,)
    cost : of each coordinate, above 0, shape (n,); decides between points of equal objective
    starts : points where an edge or a kink is expected, shape (k, n); their coordinates become levels
    alike : groups of coordinates that may be exchanged without a change; they are ordered by falling value
    plan : how much is tried

    Returns
    -------
    Found; the one that exceeds its constraints least where none satisfies them

    Raises
    ------
    InputError : a box whose corners are not finite or not in order
    """
    plan = plan or SearchPlan()
    if not (np.all(np.isfinite(low)) and np.all(np.isfinite(high)) and np.all(low <= high)):
        raise InputError("bounds", [low.tolist(), high.tolist()], "finite, low at most high")
    ask = Log(judge)
    expected = np.empty((0, low.size)) if starts is None else np.clip(starts, low, high)
    crossing = expected if plan.crossed or low.size < 3 else expected[:0]
    levels = [_levels(low[i], high[i], crossing[:, i], low.size, plan) for i in range(low.size)]
    points = _grid(levels, expected, alike, plan)
    said = ask(points)
    kept = _valleys(points, said, cost, levels, plan)
    point, gap = descend(ask, points[kept], low, high, cost, levels, plan)
    if low.size > 1:
        point = follow(ask, point, low, high, cost, gap, plan)
    point = _least_cost(ask, point, low, cost, plan)
    for group in alike:
        point[list(group)] = np.sort(point[list(group)])[::-1]
    last = ask(point[None])
    every, judged = ask.all()
    return Found(point, float(last.objective[0]), float(last.excess[0]), every, judged, points.shape[0])


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
    points = np.concatenate((points, expected))
    for group in alike:
        points[:, list(group)] = np.sort(points[:, list(group)], axis=1)[:, ::-1]
    return np.unique(points, axis=0)


def _lines(levels: list[Array], expected: Array) -> Array:
    """Points along each axis through the lower corner, the diagonal and each point expected."""
    low = np.array([one[0] for one in levels])
    share = [np.interp(np.linspace(0.0, 1.0, 24), np.linspace(0.0, 1.0, one.size), one) for one in levels]
    diagonal = np.stack(share, axis=1)
    rows = [diagonal]
    for base in (low, *expected):
        for i, one in enumerate(levels):
            line = np.tile(base, (one.size, 1))
            line[:, i] = one
            rows.append(line)
    return np.concatenate(rows)


def _rank(points: Array, levels: list[Array]) -> Array:
    """Place of points among the levels, so that neighbours are a distance of 1 apart."""
    return np.stack([np.interp(points[:, i], one, np.arange(one.size)) for i, one in enumerate(levels)], 1)


def _valleys(points: Array, said: Judgement, cost: Array, levels: list[Array], plan: SearchPlan) -> list[int]:
    """The best points of the grid that are not neighbours of one another."""
    rank, kept = _rank(points, levels), list[int]()
    left = np.arange(points.shape[0])
    while left.size and len(kept) < plan.valleys:
        part = Judgement(said.objective[left], said.excess[left])
        k = int(left[best_of(part, points[left] @ cost, plan.hair)])
        kept.append(k)
        left = left[np.abs(rank[left] - rank[k]).max(axis=1) > 1.5]
    return kept


def _least_cost(ask: Log, point: Array, low: Array, cost: Array, plan: SearchPlan) -> Array:
    """The point drawn towards the lower corner, axis by axis, as far as its value stays within a hair."""
    start = ask(point[None])
    limit = float(start.objective[0]) + plan.hair * abs(float(start.objective[0]))
    most = max(float(start.excess[0]), 0.0)
    point = point.copy()
    order = np.argsort(-(cost * (point - low)), kind="stable")
    for i in order.tolist():
        if point[i] > low[i]:
            point[i] = _least_on_axis(ask, point, i, low[i], limit, most, plan)
    return point


def _least_on_axis(
    ask: Log, point: Array, axis: int, low: float, limit: float, most: float, plan: SearchPlan
) -> float:
    """Least value of one coordinate at which the point is as good; the edge is closed in by many at once."""
    bad, good, first = low, float(point[axis]), True
    while good - bad > plan.edge * (good - low):
        inner = np.linspace(bad, good, plan.sections + 1)[1:-1]
        if first:  # the edge may lie close to the corner
            near = low + (good - low) * np.geomspace(1e-4, 1.0 / plan.sections, 6)
            inner, first = np.concatenate(([low], near[:-1], inner)), False
        tried = np.tile(point, (inner.size, 1))
        tried[:, axis] = inner
        said = ask(tried)
        holds = (said.objective <= limit) & (np.maximum(said.excess, 0.0) <= most)
        k = int(np.argmax(holds)) if holds.any() else inner.size
        if k == 0 and inner[0] == low:
            return low
        if k < inner.size:
            good = float(inner[k])
        bad = float(inner[k - 1]) if k > 0 else bad
    return good
