"""Edges of the bands of speed in which a rotor with liquid layers whirls by itself."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill
from fluid.friction import NO_FRICTION, Friction
from fluid.whirl import Layer, neutral_stiffness
from meshes.arrays import Array, Index
from solvers.rotor.system import RotorSystem
from solvers.whirl.growth import growth_at, planar, planar_layers

Bands = tuple[tuple[float, float], ...]

_WIDTH = 1e-10  # relative, of the bracket an edge is left in
_NEAR = 1e-3  # of a bracket: how closely the secant's zero is looked at
_STEPS = 60
_MOST_SEEDED = 8  # layers; polynomials of more are too steep to have their zeros found


def unstable_bands(
    system: RotorSystem,
    rows: Sequence[Sequence[Fill]],
    speed: ArrayLike,
    friction: Friction = NO_FRICTION,
    growth: Array | None = None,
) -> tuple[Bands, ...]:
    """Bands of speed in which some whirl grows, their edges refined.

    Looked at are the speeds given and, so that no narrow band is lost between them, the edges and the middle
    of each band of the same rotor without any damping, if it is a Jeffcott rotor.

    Parameters
    ----------
    system, rows, friction : as for `solvers.whirl.growth.growth_map`
    speed : rising, rad/s, shape (n,)
    growth : at these speeds if it is known, shape (rows, n)

    Returns
    -------
    For each row its bands (low, high), rad/s; an end that is the first or last speed is where the range ends
    """
    grid = np.asarray(speed, dtype=float)
    row, points = np.repeat(np.arange(len(rows)), grid.size), np.tile(grid, len(rows))
    known = growth_at(system, rows, row, points, friction)[0] if growth is None else growth.ravel()
    seeds = [_seeds(system, fills, float(grid[0]), float(grid[-1])) for fills in rows]
    more = np.repeat(np.arange(len(rows)), [one.size for one in seeds])
    between = np.concatenate([*seeds, np.empty(0)])
    added = growth_at(system, rows, more, between, friction)[0]
    row, points = np.concatenate([row, more]), np.concatenate([points, between])
    rate = np.concatenate([known, added])
    grows = rate > 0.0
    order = np.lexsort((points, row))
    row, points, rate, grows = row[order], points[order], rate[order], grows[order]
    change = np.flatnonzero((row[1:] == row[:-1]) & (grows[1:] != grows[:-1]))
    low, high = (np.stack([points[change + i], rate[change + i]]) for i in (0, 1))
    edge = _refine(system, rows, row[change], low, high, friction)
    return tuple(_bands(k, row, points, grows, row[change], edge) for k in range(len(rows)))


def _bands(k: int, row: Index, points: Array, grows: NDArray[np.bool_], owner: Index, edge: Array) -> Bands:
    """Edges of one row in pairs, with the ends of the range where it is unstable there."""
    own = np.flatnonzero(row == k)
    ends = edge[owner == k].tolist()
    if own.size and grows[own[0]]:
        ends = [float(points[own[0]]), *ends]
    if own.size and grows[own[-1]]:
        ends = [*ends, float(points[own[-1]])]
    return tuple(zip(ends[::2], ends[1::2], strict=True))


def _refine(
    system: RotorSystem,
    rows: Sequence[Sequence[Fill]],
    row: Index,
    low: Array,
    high: Array,
    friction: Friction,
) -> Array:
    """Speeds at which the whirl begins or ceases to grow, between those of `low` and `high`.

    Three looks at a time: in the middle and closely round the secant's zero; in quarters where the whirl is
    neutral on one side, as without any damping.

    Parameters
    ----------
    low, high : speed and growth on either side, shape (2, n)
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
        found = growth_at(system, rows, np.tile(row[active], 3), looks.ravel(), friction)[0].reshape(3, -1)
        # The ends and the looks in order; the edge is before the first that is unlike the lower end.
        points = np.concatenate([a[None], looks, b[None]])
        rates = np.concatenate([at_a[None], found, at_b[None]])
        beyond = np.argmax((rates > 0.0) != first[active], axis=0)
        at = np.arange(active.size)
        low[:, active] = points[beyond - 1, at], rates[beyond - 1, at]
        high[:, active] = points[beyond, at], rates[beyond, at]
    return np.asarray(0.5 * (low[0] + high[0]))


def _seeds(system: RotorSystem, fills: Sequence[Fill], first: float, last: float) -> Array:
    """Edges without damping and the middles between neighbours, inside the range."""
    rotor = planar(system)
    if rotor is None:
        return np.empty(0)
    mass, layers = planar_layers(rotor.mass, fills, NO_FRICTION)
    if not 0 < len(layers) <= _MOST_SEEDED:
        return np.empty(0)
    edges = undamped_edges(mass, rotor.stiffness, layers)
    speeds = np.concatenate([edges, 0.5 * (edges[1:] + edges[:-1])])
    return np.unique(speeds[(speeds > first) & (speeds < last)])


def undamped_edges(mass: float, stiffness: float, layers: Sequence[Layer]) -> Array:
    """Speeds at which an undamped rotor with frictionless layers gains or loses a pair of neutral whirls.

    The stiffness that a neutral whirl of ratio r needs is Omega^2 Y(r); where Y has an extremum two whirls
    merge, so that the edges follow from the zeros of a polynomial [theory: whirl, eq. 17].

    Parameters
    ----------
    mass : M with all liquid that has no free surface, kg
    stiffness : K, N/m
    layers : at least one, all different

    Returns
    -------
    Omega, rad/s, rising
    """
    free = [one for one in layers if one.mass > 0.0]
    # In u = r - 1, in which the waves of a thin layer stand apart.
    ratio = Polynomial([1.0, 1.0])
    waves = [Polynomial([-one.layer_tanh, -2.0 * one.layer_tanh, 1.0]) for one in free]
    bottom = _product(waves)
    top = (mass + sum(one.mass for one in free)) * bottom
    for k, one in enumerate(free):
        share = 0.5 * (1.0 - one.layer_tanh) * one.mass
        top = top - share * ratio**2 * _product(waves[:k] + waves[k + 1 :])
    # Y = r^2 top/bottom; the zero of Y' at r = 0 belongs to an infinite speed.
    extrema = (2.0 * top + ratio * top.deriv()) * bottom - ratio * top * bottom.deriv()
    roots = extrema.roots()
    real = roots.real[np.abs(roots.imag) <= 1e-9 * np.abs(roots)] + 1.0
    masses, tanh = (np.array([getattr(one, name) for one in free]) for name in ("mass", "layer_tanh"))
    needed = neutral_stiffness(real, mass, masses, tanh)
    return np.sort(np.sqrt(stiffness / needed[needed > 0.0]))


def _product(factors: Sequence[Polynomial]) -> Polynomial:
    total = Polynomial([1.0])
    for one in factors:
        total = total * one
    return total
