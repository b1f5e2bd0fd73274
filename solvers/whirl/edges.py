"""Stability boundaries: edges of the bands of speed in which a rotor with liquid layers whirls by itself."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION
from meshes.arrays import Array, Flags, Index
from solvers.rotor.system import Rotor
from solvers.whirl.growth import Waves, growth_at
from solvers.whirl.looks import looks

Bands = tuple[tuple[float, float], ...]

_WIDTH = 1e-10  # relative, of the bracket an edge is left in
_BESIDE = 1e-8  # relative, of speeds at an edge
_NEAR = 1e-3  # of a bracket: how closely the secant's zero is looked at
_STEPS = 60


def unstable_bands(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    speed: ArrayLike,
    friction: Waves = NO_FRICTION,
    growth: Array | None = None,
) -> tuple[Bands, ...]:
    """Bands (low, high) of speed in which some whirl grows, rad/s, of each row of fills, edges refined.

    At speeds of its own choice between the first and the last given, so that no band is lost and none depends
    on their number [theory: whirl, eq. 32 and 33]. Next to a speed of unknown growth rate a band ends at the
    last known one.
    """
    grid = np.asarray(speed, dtype=float)
    row, points, rate = looks(rotor, rows, float(grid[0]), float(grid[-1]), friction)
    found = _bands(rotor, rows, row, points, rate, friction)
    if growth is None:
        return found
    # Speeds asked for of which the bands say otherwise are looked from as well, and where the growth is not
    # known at one it is not known up to its neighbours.
    own = np.repeat(np.arange(len(rows)), grid.size), np.tile(grid, len(rows)), np.asarray(growth).ravel()
    other = np.concatenate([_contradicts(bands, grid, g) for bands, g in zip(found, growth, strict=True)])
    for k, at_speeds in enumerate(growth):
        for low, high in bands_not_known(grid, at_speeds):
            rate[(row == k) & (points > low) & (points < high)] = np.nan
            other |= (own[0] == k) & (own[1] >= low) & (own[1] <= high)
    if not other.any():
        return found
    row, points, rate = (np.concatenate([x, y[other]]) for x, y in zip((row, points, rate), own, strict=True))
    order = np.lexsort((points, row))
    return _bands(rotor, rows, row[order], points[order], rate[order], friction)


def _contradicts(bands: Bands, speed: Array, growth: Array) -> Flags:
    """Speeds inside bands at which nothing grows or outside at which something does, shape (n,)."""
    inside, edge = np.zeros(speed.shape, dtype=bool), np.zeros(speed.shape, dtype=bool)
    for low, high in bands:
        inside |= (speed >= low) & (speed <= high)
        edge |= np.minimum(np.abs(speed - low), np.abs(speed - high)) <= _BESIDE * speed
    return np.asarray(~edge & ~np.isnan(growth) & (inside != (growth > 0.0)))


def _bands(
    rotor: Rotor, rows: Sequence[Sequence[Fill]], row: Index, points: Array, rate: Array, friction: Waves
) -> tuple[Bands, ...]:
    """Bands between points by rising row and speed at which the growth is known, their edges refined."""
    grows, known_there = rate > 0.0, ~np.isnan(rate)
    # Where growth begins, after a point, and where it ceases, likewise; the ends of the rows count.
    inner = row[1:] == row[:-1]
    begins = grows & ~np.concatenate([[False], inner & grows[:-1]])
    ceases = grows & ~np.concatenate([inner & grows[1:], [False]])
    # Each with its neighbour on the other side of the edge, if there is one whose growth is known.
    here = np.concatenate([np.flatnonzero(begins), np.flatnonzero(ceases)])
    after = np.arange(here.size) >= np.count_nonzero(begins)
    other = np.clip(here + np.where(after, 1, -1), 0, row.size - 1)
    edge = points[here]
    kept = (row[other] == row[here]) & (other != here) & known_there[other]
    low, high = np.minimum(here, other)[kept], np.maximum(here, other)[kept]
    first, last = (np.stack([points[at], rate[at]]) for at in (low, high))
    edge[kept] = _refine(rotor, rows, row[low], first, last, friction)
    bands = zip(row[begins].tolist(), edge[~after].tolist(), edge[after].tolist(), strict=True)
    found: list[list[tuple[float, float]]] = [[] for _ in rows]
    for k, start, stop in bands:
        found[k].append((start, stop))
    return tuple(tuple(own) for own in found)


def bands_not_known(speed: Array, growth: Array) -> Bands:
    """Bands of speed in which the growth rate is nan, up to the nearest speeds at which it is known.

    Or to the ends of the range.
    """
    lost = np.concatenate([[False], np.isnan(growth), [False]])
    first, past = np.flatnonzero(~lost[:-1] & lost[1:]), np.flatnonzero(lost[:-1] & ~lost[1:])
    low, high = speed[np.maximum(first - 1, 0)], speed[np.minimum(past, speed.size - 1)]
    return tuple(zip(low.tolist(), high.tolist(), strict=True))


def _refine(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    row: Index,
    low: Array,
    high: Array,
    friction: Waves,
) -> Array:
    """Speeds at which the whirl begins or ceases to grow, between those of `low` and `high`.

    Three points at a time: in the middle and closely round the secant's zero; in quarters where the whirl is
    neutral on one side, as without damping.
    """
    low, high = low.copy(), high.copy()
    first = low[1] > 0.0
    for _ in range(_STEPS):
        active = np.flatnonzero(high[0] - low[0] > _WIDTH * high[0])
        if active.size == 0:
            break
        (a, at_a), (b, at_b) = low[:, active], high[:, active]
        width, signs = b - a, at_a * at_b < 0.0
        share = np.full(a.shape, 0.5)
        np.divide(at_a, at_a - at_b, out=share, where=signs)
        near = np.where(signs, np.maximum(_NEAR, 0.25 * _WIDTH * b / width), 0.25)
        parts = np.sort(
            np.clip(np.stack([share - near, share + near, np.full(a.shape, 0.5)]), 0.0, 1.0), axis=0
        )
        looks = a + parts * width
        found = growth_at(rotor, rows, np.tile(row[active], 3), looks.ravel(), friction)[0].reshape(3, -1)
        # The ends and the looks in order; the edge is before the first that is unlike the lower end.
        points = np.concatenate([a[None], looks, b[None]])
        rates = np.concatenate([at_a[None], found, at_b[None]])
        beyond = np.argmax((rates > 0.0) != first[active], axis=0)
        at = np.arange(active.size)
        low[:, active] = points[beyond - 1, at], rates[beyond - 1, at]
        high[:, active] = points[beyond, at], rates[beyond, at]
    return np.asarray(0.5 * (low[0] + high[0]))
