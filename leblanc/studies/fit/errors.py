"""Errors of fitted values: from the curvature, or from the profile where the curvature misleads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from leblanc.studies.fit.noise import Judged
from leblanc.studies.fit.problem import LIMIT, Problem, Residual
from leblanc.studies.fit.search import descend
from meshes.arrays import Array, Flags

_NULL = 1e-7  # of the strongest direction: a weaker one changes nothing
_LINEAR = 0.9, 1.1  # of the expected rise: between them the curvature holds
_FIRST = 0.1  # step of a profile where the curvature knows none
_CLOSE = 0.02  # of the rise that a profile is followed to
_BETTER = 0.1  # sum of squares, in noise, by which another place is better
_MOST = 40  # places of one side of a profile
_JOINT = 1.0  # standard error along a direction, of the logarithms, from which on the data do not tell it


@dataclass(frozen=True)
class Curvature:
    """What the derivatives at the best values say."""

    covariance: Array  #: of the logarithms or steps, shape (p, p)
    std: Array  #: nan where nothing tells it, shape (p,)
    correlation: Array  #: shape (p, p)
    flat: tuple[Array, ...]  #: directions that the data do not tell, shape (p,) each
    #: factor of each error because the kind of noise is not known, shape (p,); none where it is
    unsure: Array | None = None


def curvature(jacobian: Array) -> Curvature:
    """Errors of least squares whose residuals have a standard deviation of one [theory: fit, eq. 3]."""
    unknowns = jacobian.shape[1]
    _, size, turn = np.linalg.svd(jacobian, full_matrices=False)
    told = size > max(_NULL * float(size.max()), 1e-300)
    inverse = np.where(told, 1.0 / np.where(told, size, 1.0), 0.0)
    covariance = (turn.T * np.square(inverse)) @ turn
    lost = np.abs(turn[~told]).max(axis=0, initial=0.0) > 1e-3
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    outer = np.outer(deviation, deviation)
    correlation = np.divide(covariance, outer, out=np.eye(unknowns), where=outer > 0.0)
    flat = tuple(turn[k] for k in range(unknowns) if not told[k] or inverse[k] > _JOINT)
    return Curvature(covariance, np.where(lost, np.nan, deviation), correlation, flat)


def averaged(bent: Curvature, best: Judged, bent_other: Curvature, other: Judged) -> Curvature:
    """The curvature with the mean square of errors by two kinds of noise [theory: fit, eq. 12]."""
    share = 1.0 / (1.0 + np.exp(0.5 * min(other.unlikely - best.unlikely, 100.0)))
    apart = np.square(bent_other.std) + np.square(other.x - best.x)
    mean = (1.0 - share) * np.square(bent.std) + share * apart
    known = np.isfinite(mean) & (bent.std > 0.0)
    factor = np.sqrt(np.divide(mean, np.square(bent.std), out=np.ones(mean.size), where=known))
    factor = np.where(np.abs(other.x - best.x) < 1.0, np.maximum(factor, 1.0), 1.0)
    return replace(bent, std=bent.std * factor, unsure=factor)


@dataclass(frozen=True)
class Side:
    """One side of the profile of an unknown."""

    end: float  #: logarithm or step where the rise is that of the interval
    open: bool  #: nothing rises as far as there are answers and the search looks
    edge: bool  #: it ends where the scene has no answer any more


@dataclass(frozen=True)
class Profiles:
    """Intervals of the unknowns by their profiles."""

    sides: tuple[tuple[Side, Side] | None, ...]  #: None where the curvature holds
    better: Array | None  #: values with less left, if a profile came to some


def profiles(
    problem: Problem, x: Array, sigma: Sequence[Array], bent: Curvature, quantile: float, fixed: Flags
) -> Profiles:
    """Both ends of each unknown where the others do their best [theory: fit, eq. 10].

    nan for unknowns that are `fixed` at their bound; `quantile` in standard errors.
    """
    residual = problem.weighted(sigma)
    least = float(np.sum(np.square(residual(x))))
    found: list[tuple[Side, Side] | None] = []
    factor = np.ones(x.size) if bent.unsure is None else bent.unsure
    bent = replace(bent, std=bent.std / factor)
    for k in range(x.size):
        reach = quantile * float(factor[k])
        if fixed[k]:
            found.append(None)
            continue
        std = float(bent.std[k])
        if np.isfinite(std) and _holds(problem, residual, x, bent, k, reach, least):
            found.append(None)
            continue
        sides = []
        for way in (-1.0, 1.0):
            side = _side(problem, residual, x, bent, k, way, reach, least)
            if isinstance(side, np.ndarray):
                return Profiles((), side)
            sides.append(side)
        found.append((sides[0], sides[1]))
    return Profiles(tuple(found), None)


def _along(bent: Curvature, k: int) -> Array:
    """How the other unknowns follow one of them, shape (p,)."""
    own = float(bent.covariance[k, k])
    way = bent.covariance[:, k] / own if own > 0.0 else np.zeros(bent.std.size)
    way = np.where(np.isfinite(bent.std), way, 0.0)
    way[k] = 1.0
    return np.asarray(way)


def _holds(
    problem: Problem, residual: Residual, x: Array, bent: Curvature, k: int, quantile: float, least: float
) -> bool:
    """The sum rises at both ends as the curvature says."""
    for way in (-1.0, 1.0):
        moved = x + way * quantile * float(bent.std[k]) * _along(bent, k)
        if np.abs(moved).max() >= LIMIT or problem.answer(moved) is None:
            return False
        rise = float(np.sum(np.square(residual(moved)))) - least
        if not _LINEAR[0] * quantile <= np.sqrt(max(rise, 0.0)) <= _LINEAR[1] * quantile:
            return False
    return True


def _side(
    problem: Problem,
    residual: Residual,
    x: Array,
    bent: Curvature,
    k: int,
    way: float,
    quantile: float,
    least: float,
) -> Side | Array:
    """Where the profile has risen on one side; values with less left where it comes to some."""
    along = _along(bent, k)
    std = float(bent.std[k])
    step = min(quantile * std, 1.0) if np.isfinite(std) and std > 0.0 else _FIRST
    room = LIMIT - way * float(x[k])
    inside, inner_rise, others = 0.0, 0.0, x
    outside, outer_rise = np.inf, np.inf
    # The rise at the values themselves is 0; a step is tried until one is beyond the interval's.
    for _ in range(_MOST):
        step = min(step, room)
        start = others + way * (step - inside) * along
        start[k] = x[k] + way * step
        moved, rise = _best_others(problem, residual, np.clip(start, -LIMIT, LIMIT), k)
        gain = rise - least
        if gain < -_BETTER:
            return moved
        high = np.sqrt(max(gain, 0.0))
        answered = problem.answer(moved) is not None
        if answered and high <= quantile:
            inside, inner_rise, others = step, high, moved
            if step >= room:
                return Side(float(x[k]) + way * room, True, False)
        else:
            outside, outer_rise = step, high if answered else np.inf
        if abs(high - quantile) <= _CLOSE * quantile and answered:
            return Side(float(x[k]) + way * step, False, False)
        if not np.isfinite(outside):
            share = quantile / high if high > 0.0 else 4.0
            step *= min(max(1.1 * share, 1.3), 4.0)
            continue
        if outside - inside <= 1e-3 * max(outside, 1e-6):
            break
        share = (quantile - inner_rise) / (outer_rise - inner_rise) if np.isfinite(outer_rise) else 0.5
        step = inside + min(max(share, 0.1), 0.9) * (outside - inside)
    edge = not np.isfinite(outer_rise)
    return Side(float(x[k]) + way * inside, edge, edge)


def _best_others(problem: Problem, residual: Residual, x: Array, k: int) -> tuple[Array, float]:
    """Best values of all unknowns but one, and the sum of squares there."""
    free = np.arange(x.size) != k
    if not free.any() or problem.answer(x) is None:
        return x, float(np.sum(np.square(residual(x))))
    found = descend(problem, residual, x, 1e-5, 12, free)
    return found.x, found.cost
