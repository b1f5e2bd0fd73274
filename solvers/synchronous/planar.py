"""All synchronous deflections of planar machines with liquid, many pairs of a machine and a speed at once.

One unknown, the size e of the deflection [theory: rotor, eq. 2]: |a e - Y(e) + i c e| = u, with Y the
liquid's pull, which never decreases with e [theory: rotor, eq. 6] and is nowhere steeper than a full chamber
makes it. An interval in which bounds by the values of Y at its ends keep the left-hand side from u holds no
solution, one over which that only rises or falls at most one; others are halved, so that none is missed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from meshes.arrays import Array, Complex, Flags, Index
from solvers.roots import bracketed_root
from solvers.synchronous.pairs import LiquidState, Pairs

# Pull Y at deflections e, shape (m,), of the speeds given by their index, shape (m,).
Law = Callable[[Array, Index], Array]

# Intervals are halved this often before a single change of sign in one is taken for a single solution ...
_COARSE = 14
# ... and this often where there is none: solutions closer than 2**-_FINE of the search range are one.
_FINE = 26


def branches_beyond(
    pull: Law,
    elastic: Array,
    damping: Array,
    force: Array,
    steepest: Array,
    limit: Array,
    dead: Array,
    moved: Flags,
) -> tuple[Array, Index, Flags, Flags]:
    """Every solution beyond `limit`, the straight part of the law, as far as damping and stiffness allow.

    As `find_branches`, and whether solutions are bounded or the law is straight everywhere. `dead`: the
    largest pull of the liquid beyond its mass at the chamber's centre; `moved`: there is a force.
    """
    # No solution is farther out than the damper or the spring allows.
    reach = np.minimum(over(force, damping), over(force + dead, np.abs(elastic))) * (1.0 + 1e-9)
    bounded = np.isfinite(reach) | np.isinf(limit)
    stop = np.where(moved & bounded & np.isfinite(limit), np.maximum(reach, limit), limit)
    return *find_branches(pull, elastic, damping, force, steepest, limit, stop), bounded


def over(above: Array, below: Array) -> Array:
    """Quotient, shape (n,), infinite where there is nothing to divide by."""
    return np.asarray(np.divide(above, below, out=np.full(above.shape, np.inf), where=below > 0.0))


def find_branches(
    pull: Law, elastic: Array, damping: Array, force: Array, steepest: Array, start: Array, stop: Array
) -> tuple[Array, Index, Flags]:
    """Every solution e of (a e - Y(e))^2 + (c e)^2 = u^2 with start < e <= stop, at n speeds.

    Y never falls with e and is nowhere steeper than `steepest`. Solutions in no order, the speed each belongs
    to, and for each speed whether all were resolved.
    """
    converged = np.ones(force.shape, dtype=bool)
    which = np.flatnonzero(stop > start)
    a, c, rise = elastic / force, damping / force, steepest / force
    low, high = start[which], stop[which]
    at_low, at_high = pull(low, which) / force[which], pull(high, which) / force[which]
    found: list[Array] = []
    owner: list[Index] = []
    distance: list[Array] = []

    def balance(e: Array, y: Array, k: Index) -> Array:
        return np.asarray(np.hypot(a[k] * e - y, c[k] * e) - 1.0)

    def balance_at(owners: Index, e: Array, j: Index) -> Array:
        k = owners[j]
        return balance(e, pull(e, k) / force[k], k)

    for level in range(_FINE + 1):
        keep = _may_hold(low, high, at_low, at_high, a[which], c[which])
        low, high, at_low, at_high = (x[keep] for x in (low, high, at_low, at_high))
        which = which[keep]
        if which.size == 0:
            break
        one_way = _one_way(low, high, at_low, at_high, a[which], c[which], rise[which])
        first, last = balance(low, at_low, which), balance(high, at_high, which)
        # A solution at an interval's lower end belongs to the interval below it.
        changes = (np.sign(first) * np.sign(last) < 0.0) | (last == 0.0)
        single = changes & (one_way | (level >= _COARSE))
        if np.any(single):
            k = which[single]
            root, sure = bracketed_root(partial(balance_at, k), low[single], high[single])
            found.append(root)
            owner.append(k)
            distance.append(np.full(k.size, -1.0))
            converged[k[~sure]] = False
        left = ~(single | (one_way & ~changes))
        low, high, at_low, at_high = (x[left] for x in (low, high, at_low, at_high))
        which, off = which[left], np.abs(np.stack((first[left], last[left])))
        if level == _FINE:
            # Neither excluded nor crossed at the finest width: the curve touches, a double solution.
            found.append(np.where(off[0] <= off[1], low, high))
            owner.append(which)
            distance.append(off.min(axis=0))
        if which.size == 0:
            break
        middle = 0.5 * (low + high)
        at_middle = pull(middle, which) / force[which]
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
        at_low, at_high = np.concatenate((at_low, at_middle)), np.concatenate((at_middle, at_high))
        which = np.concatenate((which, which))
    if not found:
        return np.zeros(0), np.zeros(0, dtype=np.intp), converged
    span = np.subtract(stop, start, out=np.zeros_like(stop), where=stop > start)
    solution, k = _distinct(np.concatenate(found), np.concatenate(owner), np.concatenate(distance), span)
    return solution, k, converged


def _distinct(solution: Array, which: Index, distance: Array, span: Array) -> tuple[Array, Index]:
    """One solution for each cluster: the ones crossed, of distance -1, or where the curve comes nearest."""
    order = np.lexsort((solution, which))
    solution, which, distance = solution[order], which[order], distance[order]
    apart = (np.diff(which) != 0) | (np.diff(solution) > 4.0 * 2.0**-_FINE * span[which[1:]])
    cluster = np.cumsum(np.concatenate(([0], apart.astype(int))))
    crossed = distance < 0.0
    nearest = np.lexsort((distance, cluster))
    nearest = nearest[np.concatenate(([True], np.diff(cluster) > 0))]
    kept = np.concatenate((np.flatnonzero(crossed), nearest[~crossed[nearest]]))
    return solution[kept], which[kept]


def _one_way(
    low: Array, high: Array, at_low: Array, at_high: Array, a: Array, c: Array, rise: Array
) -> Flags:
    """Whether the left-hand side only rises or only falls: r (a - Y') + c^2 e keeps its sign, r = a e - Y."""
    corners = [
        r * slope
        for r in (np.minimum(a * low, a * high) - at_high, np.maximum(a * low, a * high) - at_low)
        for slope in (a - rise, a)
    ]
    least = np.min(corners, axis=0) + np.square(c) * low
    most = np.max(corners, axis=0) + np.square(c) * high
    return np.asarray((least >= 0.0) | (most <= 0.0))


def _may_hold(low: Array, high: Array, at_low: Array, at_high: Array, a: Array, c: Array) -> Flags:
    """Whether the interval can hold a solution: 1 lies between the bounds of the left-hand side."""
    least = np.minimum(a * low, a * high) - at_high
    most = np.maximum(a * low, a * high) - at_low
    nearest = np.where((least <= 0.0) & (most >= 0.0), 0.0, np.minimum(np.abs(least), np.abs(most)))
    farthest = np.maximum(np.abs(least), np.abs(most))
    # Rounding must not exclude a solution at an end.
    slack = 1e-12
    return (np.hypot(nearest, c * low) <= 1.0 + slack) & (np.hypot(farthest, c * high) >= 1.0 - slack)


def divide(force: Array, stiffness: Complex) -> Complex:
    """force/stiffness, shape (n,); infinite where an undamped rotor runs at its critical speed."""
    out = np.full(force.shape, complex(np.inf, 0.0))
    np.divide(force, stiffness, out=out, where=stiffness != 0.0)
    return np.where(force == 0.0, 0.0, out)


def all_deflections(pairs: Pairs) -> tuple[Array, Index, Flags]:
    """Sizes of all solutions, m, the pair each belongs to, and whether a pair's are all there.

    At least one for each pair; infinite without a bound.
    """
    squared, limit = np.square(pairs.speed), pairs.limit
    force, damping = pairs.unbalance * squared, pairs.damping * pairs.speed
    straight = np.abs(divide(force, pairs.dynamic_stiffness - pairs.added_mass * squared))
    linear = np.flatnonzero((straight <= limit) | (force == 0.0))

    elastic = pairs.stiffness - (pairs.mass + pairs.liquid_mass) * squared
    moved = force > 0.0
    # A little more than the steepest slope of the unbalance holds the rounding.
    steepest = squared * (pairs.steepest * (1.0 + 1e-9) - pairs.liquid_mass)
    bent, which, converged, bounded = branches_beyond(
        pairs.pull,
        *(elastic, damping, np.where(moved, force, 1.0), steepest),
        limit,
        squared * pairs.reach,
        moved,
    )
    size, owner = np.concatenate((straight[linear], bent)), np.concatenate((linear, which))
    lost = np.setdiff1d(np.arange(squared.size), owner)
    if lost.size:
        converged[lost] = False
        size = np.concatenate((size, np.full(lost.size, np.inf)))
        owner = np.concatenate((owner, lost))
    at_rest = pairs.unbalance == 0.0
    return size, owner, (converged & bounded & np.isfinite(straight)) | at_rest


def with_phase(pairs: Pairs, which: Index, deflection: Array, state: LiquidState) -> Complex:
    """Complex deflections: w lags the unbalance by the angle of the wet rotor's dynamic stiffness."""
    pull = np.square(pairs.speed[which]) * state.unbalance
    total = pairs.dynamic_stiffness[which] * deflection - pull
    return np.asarray(deflection * np.exp(-1j * np.angle(total)), dtype=complex)


def is_stable(pairs: Pairs, which: Index, deflection: Array, state: LiquidState) -> Flags:
    """Stability against disturbances that are slow beside the liquid's waves [theory: rotor, eq. 8]."""
    spin, own, damping, stiffness = (
        x[which] for x in (pairs.speed, pairs.mass, pairs.damping, pairs.stiffness)
    )
    secant = np.divide(state.unbalance, deflection, out=state.slope.copy(), where=deflection > 0.0)
    mass = own + secant
    radial = stiffness - np.square(spin) * (own + state.slope)
    tangential = stiffness - np.square(spin) * (own + secant)
    matrix = np.zeros((which.size, 4, 4))
    matrix[:, 0, 2] = matrix[:, 1, 3] = 1.0
    matrix[:, 2, 0], matrix[:, 3, 1] = -radial / mass, -tangential / mass
    matrix[:, 2, 1], matrix[:, 3, 0] = damping * spin / mass, -damping * spin / mass
    matrix[:, 2, 2] = matrix[:, 3, 3] = -damping / mass
    matrix[:, 2, 3], matrix[:, 3, 2] = 2.0 * spin, -2.0 * spin
    roots = np.linalg.eigvals(matrix)
    # Without damping the roots are imaginary to rounding (square root of it where two meet).
    slack = 1e-7 * np.abs(roots).max(axis=1, initial=0.0)
    return np.asarray(roots.real.max(axis=1, initial=-np.inf) <= slack)


def liquid_offset(pairs: Pairs, farthest: Array, deflection: Array, unbalance: Array) -> Array:
    """Distance of the liquid's centre of mass from the rotation axis; without liquid, that of a drop."""
    drop = np.where(deflection > 0.0, deflection + farthest, 0.0)
    return np.divide(unbalance, pairs.liquid_mass, out=drop, where=pairs.liquid_mass > 0.0)
