"""Curves of solutions of m equations in m + 1 unknowns, followed by their arc length through every turn.

Made for few unknowns: the derivative is taken by central differences. Waves and limit cycles, which have
hundreds, have solvers of their own, whose equations know their derivatives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_positive

_ROUNDS = 12
_DIFFERENCE = 1e-6  # of the unit of an unknown
_SHORTEST = 1.0 / 4096.0  # of the first step
_STRAIGHT = 0.9  # least cosine between the directions of two points
_BESIDE = 0.5  # of a step: a point further from the guess than that is on another curve
_EASY = 4  # rounds up to which the next step may be longer


class End(Enum):
    """Why a curve ends."""

    LEFT = "it leaves the box"
    CLOSED = "it closes"
    LOST = "no further point is found"
    NOWHERE = "what it is a curve of ends"
    LONG = "the most points are reached"


@dataclass(frozen=True)
class Curve:
    """Points of a curve, one after the other."""

    points: Array  #: shape (k, m + 1)
    end: End  #: why there are no more


Equations = Callable[[Array], Array]  # of the unknowns, on a curve (m + 1,), what is left, shape (m,)


def follow(
    equations: Equations,
    start: ArrayLike,
    unit: ArrayLike,
    low: ArrayLike,
    high: ArrayLike,
    *,
    step: float = 0.02,
    way: int = 1,
    tolerance: float = 1e-10,
    most: int = 2000,
    renew: Callable[[Array], object] = lambda _: None,
) -> Curve:
    """Follow a curve from a point on it by pseudo-arclength, through its turns.

    `unit` is the size of each unknown, in which `step`, the first and longest one, and `tolerance`, the
    change at which a point counts as found, are measured; the box from `low` to `high` bounds the curve;
    `way` is the direction in which the first unknown that changes grows or falls; `renew` is called with each
    new point, for equations that move their own frame along. Equations are nan where there are none. Where no
    point is found near the start the curve is that alone, with `End.LOST` or `End.NOWHERE`.
    """
    require_positive("step", step)
    size, begin = np.asarray(unit, dtype=float), np.asarray(start, dtype=float)
    corners = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    if not np.all(np.isfinite(size) & (size > 0.0)) or way not in (1, -1):
        raise InputError("unit, way", (size.tolist(), way), "positive sizes, and 1 or -1")
    slope = slopes(equations, begin, size)
    if not np.isfinite(slope).all():
        return Curve(begin[None], End.NOWHERE)
    tangent = way * _tangent(slope)
    found = _corrected(equations, begin, tangent, size, tolerance)
    if isinstance(found, End):
        return Curve(begin[None], found)
    points, length, travelled = [found[0]], step, 0.0
    renew(points[0])
    tangent = first = _onward(found[2], tangent)
    while len(points) < most:
        guess = points[-1] + length * size * tangent
        answer = _corrected(equations, guess, tangent, size, tolerance, _BESIDE * length)
        if isinstance(answer, End) or (ahead := _onward(answer[2], tangent)) @ tangent < _STRAIGHT:
            length *= 0.5
            if length < _SHORTEST * step:
                return Curve(np.array(points), answer if isinstance(answer, End) else End.LOST)
            continue
        point = answer[0]
        points.append(point)
        travelled += length
        if np.any((point < corners[0]) | (point > corners[1])):
            return Curve(np.array(points), End.LEFT)
        home = np.abs((point - points[0]) / size).max()
        if travelled > 3.0 * step and home < length and ahead @ first > 0.0:
            return Curve(np.array(points), End.CLOSED)
        tangent = ahead
        renew(point)
        if answer[1] <= _EASY:
            length = min(1.5 * length, step)
    return Curve(np.array(points), End.LONG)


def slopes(equations: Equations, point: Array, size: float | Array = 1.0) -> Array:
    """Central differences by n unknowns in their units, shape (m, n)."""
    moved = np.diag(np.full(point.size, _DIFFERENCE) * size)
    columns = [(equations(point + row) - equations(point - row)) / (2.0 * _DIFFERENCE) for row in moved]
    return np.array(columns).T


def _tangent(slope: Array) -> Array:
    """Unit vector that changes nothing; its first entry of weight above 0."""
    tangent = np.linalg.svd(slope)[2][-1]
    heavy = np.flatnonzero(np.abs(tangent) > 1e-6)[0]
    return np.asarray(tangent * np.sign(tangent[heavy]))


def _onward(slope: Array, tangent: Array) -> Array:
    """Direction of the curve at a point with these derivatives, on the side of the last one."""
    ahead = np.linalg.svd(slope)[2][-1]
    return np.asarray(ahead if ahead @ tangent >= 0.0 else -ahead)


def _corrected(
    equations: Equations,
    guess: Array,
    tangent: Array,
    size: Array,
    tolerance: float,
    reach: float = np.inf,
) -> tuple[Array, int, Array] | End:
    """Point of the curve on the plane across the tangent, rounds, derivatives there; why where none is found.

    Within `reach` of the guess, in the units: beyond there it is a point of another curve.
    """
    point = guess.copy()
    for count in range(1, _ROUNDS + 1):
        left = equations(point)
        if not np.isfinite(left).all():
            return End.NOWHERE
        slope = slopes(equations, point, size)
        matrix = np.vstack((slope, tangent))
        away = np.append(left, tangent @ ((point - guess) / size))
        if not np.isfinite(matrix).all():
            return End.NOWHERE
        change = np.linalg.lstsq(matrix, -away, rcond=None)[0]
        point = point + size * change
        if np.abs(change).max() <= tolerance:
            # Taken within the tolerance of the point.
            return (point, count, slope) if np.linalg.norm((point - guess) / size) <= reach else End.LOST
    return End.LOST
