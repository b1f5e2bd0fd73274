"""All synchronous deflections of a rotor whose liquid follows a non-decreasing law.

At one speed the deflection e solves |a e - Y(e) + i c e| = u, where a, c and u belong to the rotor and Y, the
liquid's pull towards the deflection, never decreases with e [theory: rotor, eq. 6]. So Y on an interval lies
between its values at the ends: an interval in which the left-hand side cannot reach u holds no solution, and
what is left after halving again and again are the solutions, none missed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from solvers.bracket import bracketed_root

Array = NDArray[np.float64]
Index = NDArray[np.intp]
# Pull Y at deflections e, shape (m,), of the speeds given by their index, shape (m,).
Law = Callable[[Array, Index], Array]

# Intervals are halved this often before a single change of sign in one is taken for a single solution ...
_COARSE = 14
# ... and this often where there is none: solutions closer than 2**-_FINE of the search range are one.
_FINE = 26


def find_branches(
    pull: Law, elastic: Array, damping: Array, force: Array, start: Array, stop: Array
) -> tuple[Array, Index, NDArray[np.bool_]]:
    """Every solution e of (a e - Y(e))^2 + (c e)^2 = u^2 with start < e <= stop, at n speeds.

    Parameters
    ----------
    pull : Y, non-decreasing in e
    elastic, damping, force : a, c and u > 0, shape (n,)
    start, stop : search range of each speed, shape (n,)

    Returns
    -------
    solution : shape (k,), in no order
    which : the speed each belongs to, shape (k,)
    converged : for each speed, all its solutions were resolved, shape (n,)
    """
    converged = np.ones(force.shape, dtype=bool)
    which = np.flatnonzero(stop > start)
    a, c = elastic / force, damping / force
    low, high = start[which], stop[which]
    at_low, at_high = pull(low, which) / force[which], pull(high, which) / force[which]
    found: list[Array] = []
    owner: list[Index] = []
    crossed: list[NDArray[np.bool_]] = []

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
        if level >= _COARSE:
            first, last = balance(low, at_low, which), balance(high, at_high, which)
            # A solution at an interval's lower end belongs to the interval below it.
            single = (np.sign(first) * np.sign(last) < 0.0) | (last == 0.0)
            if np.any(single):
                k = which[single]
                root, sure = bracketed_root(partial(balance_at, k), low[single], high[single])
                found.append(root)
                owner.append(k)
                crossed.append(np.ones(k.size, dtype=bool))
                converged[k[~sure]] = False
            elif level == _FINE:
                # Neither excluded nor crossed at the finest width: the curve touches, a double solution.
                found.append(0.5 * (low + high))
                owner.append(which)
                crossed.append(np.zeros(which.size, dtype=bool))
            low, high, at_low, at_high = (x[~single] for x in (low, high, at_low, at_high))
            which = which[~single]
            if which.size == 0:
                break
        middle = 0.5 * (low + high)
        at_middle = pull(middle, which) / force[which]
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
        at_low, at_high = np.concatenate((at_low, at_middle)), np.concatenate((at_middle, at_high))
        which = np.concatenate((which, which))
    if not found:
        return np.zeros(0), np.zeros(0, dtype=np.intp), converged
    solution, k = _distinct(
        np.concatenate(found), np.concatenate(owner), np.concatenate(crossed), stop - start
    )
    return solution, k, converged


def _distinct(solution: Array, which: Index, crossed: NDArray[np.bool_], span: Array) -> tuple[Array, Index]:
    """One solution for each cluster: the ones crossed, or the middle of where the curve touches."""
    order = np.lexsort((solution, which))
    solution, which, crossed = solution[order], which[order], crossed[order]
    apart = (np.diff(which) != 0) | (np.diff(solution) > 4.0 * 2.0**-_FINE * span[which[1:]])
    first = np.flatnonzero(np.concatenate(([True], apart)))
    last = np.concatenate((first[1:], [which.size])) - 1
    cluster = np.cumsum(np.concatenate(([0], apart.astype(int))))
    has_crossing = np.bincount(cluster, weights=crossed) > 0.0
    touching = first[~has_crossing]
    middle = 0.5 * (solution[touching] + solution[last[~has_crossing]])
    return (
        np.concatenate((solution[crossed], middle)),
        np.concatenate((which[crossed], which[touching])),
    )


def _may_hold(
    low: Array, high: Array, at_low: Array, at_high: Array, a: Array, c: Array
) -> NDArray[np.bool_]:
    """Whether the interval can hold a solution: 1 lies between the bounds of the left-hand side."""
    least = np.minimum(a * low, a * high) - at_high
    most = np.maximum(a * low, a * high) - at_low
    nearest = np.where((least <= 0.0) & (most >= 0.0), 0.0, np.minimum(np.abs(least), np.abs(most)))
    farthest = np.maximum(np.abs(least), np.abs(most))
    # Rounding must not exclude a solution at an end.
    slack = 1e-12
    return (np.hypot(nearest, c * low) <= 1.0 + slack) & (np.hypot(farthest, c * high) >= 1.0 - slack)
