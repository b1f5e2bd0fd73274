"""Every solution of the balance of planar machines with liquid, many pairs of a machine and a speed at once.

A planar rotor and its chambers move in one circle, so that the balance has one unknown, the size of the
deflection [theory: rotor, eq. 2].
"""

from __future__ import annotations

import numpy as np

from meshes.arrays import Array, Complex, Flags, Index
from solvers.synchronous.branches import branches_beyond
from solvers.synchronous.pairs import LiquidState, Pairs


def divide(force: Array, stiffness: Complex) -> Complex:
    """force/stiffness, shape (n,); infinite where an undamped rotor runs at its critical speed."""
    out = np.full(force.shape, complex(np.inf, 0.0))
    np.divide(force, stiffness, out=out, where=stiffness != 0.0)
    return np.where(force == 0.0, 0.0, out)


def all_deflections(pairs: Pairs) -> tuple[Array, Index, Flags]:
    """Sizes of all solutions.

    Parameters
    ----------
    pairs : n of them, at speeds above 0

    Returns
    -------
    size : m, infinite where it has no bound, at least one for each pair, shape (k,)
    which : the pair each belongs to, shape (k,)
    converged : a pair's are all there, shape (n,)
    """
    squared, limit = np.square(pairs.speed), pairs.limit
    force, damping = pairs.unbalance * squared, pairs.damping * pairs.speed
    straight = np.abs(divide(force, pairs.dynamic_stiffness - pairs.added_mass * squared))
    linear = np.flatnonzero((straight <= limit) | (force == 0.0))

    elastic = pairs.stiffness - (pairs.mass + pairs.liquid_mass) * squared
    moved = force > 0.0
    # The slope of the unbalance never exceeds a full chamber's mass; a little more holds the rounding.
    steepest = squared * (pairs.added_mass * (1.0 + 1e-9) - pairs.liquid_mass)
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
    """Complex deflections: w lags the unbalance by the angle of the wet rotor's dynamic stiffness.

    Parameters
    ----------
    pairs, which : the pair of each solution, shape (k,)
    deflection : its size, m, shape (k,)
    state : of the liquid there, shape (k,)
    """
    pull = np.square(pairs.speed[which]) * state.unbalance
    total = pairs.dynamic_stiffness[which] * deflection - pull
    return np.asarray(deflection * np.exp(-1j * np.angle(total)), dtype=complex)


def is_stable(pairs: Pairs, which: Index, deflection: Array, state: LiquidState) -> Flags:
    """Stability against disturbances that are slow beside the liquid's waves [theory: rotor, eq. 8].

    Parameters
    ----------
    pairs, which, deflection, state : as in `with_phase`
    """
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
    """Distance of the liquid's centre of mass from the rotation axis; without liquid, that of a drop.

    Parameters
    ----------
    pairs : n of them
    farthest : largest radius of the machine's chambers, m, shape (n,)
    deflection : size, m, shape (n,)
    unbalance : of the liquid, kg m, shape (n,)
    """
    drop = np.where(deflection > 0.0, deflection + farthest, 0.0)
    return np.divide(unbalance, pairs.liquid_mass, out=drop, where=pairs.liquid_mass > 0.0)
