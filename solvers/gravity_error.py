"""What gravity across a horizontal axis does to the synchronous answer, estimated.

In the drum gravity turns backwards. In linear theory it adds nothing to what stands still there; the waves
that it drives do in second order, by their drag and by the thin places that they make [theory: model_error].
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fills
from solvers.machine_pairs import Pairs

Array = NDArray[np.float64]

# Found from long-wave layers held at a speed: most have less, the median a third of it.
_SIZE = 0.15
_THIN = 1.25


def law_error(fills: Fills, speed: Array, gravity: Array) -> Array:
    """Change of the liquid's unbalance by gravity across the axis, over full mass times deflection.

    0.15 (R/h0)^(5/4) (g/(Omega^2 a))^2 [theory: model_error, eq. 20].

    Parameters
    ----------
    fills : with liquid, shape (n,)
    speed : spin speed Omega, rad/s, shape (n,)
    gravity : across the axis, m/s^2, shape (n,)

    Returns
    -------
    Shape (n,); nan where the liquid does not ride with the drum
    """
    depth, radius = fills.depth, fills.chamber.radius
    surface = np.maximum(radius - depth, fills.chamber.inner_radius)
    full = fills.volume >= fills.chamber.capacity * (1.0 - 1e-9)
    field = np.square(speed) * surface
    held = field > gravity
    weakness = np.divide(gravity, field, out=np.zeros_like(field), where=held)
    change = _SIZE * (radius / depth) ** _THIN * np.square(weakness)
    return np.asarray(np.where(full | (gravity == 0.0), 0.0, np.where(held, change, np.nan)))


def planar_gravity_error(pairs: Pairs, across: Array, most: Array) -> Array:
    """Estimated relative error of amplitude and liquid by gravity across the axis, shape (n,).

    Parameters
    ----------
    pairs : n pairs of a machine and a speed
    across : gravity across their axes, m/s^2, shape (n,)
    most : bound of the deflection, m, shape (n,)

    Returns
    -------
    The larger of the two [theory: model_error, eq. 21], infinite where it has no bound, nan where the liquid
    does not ride with the drum, shape (n,)
    """
    weighted, largest = np.zeros((2, pairs.speed.size))
    for slot in pairs.slots:
        rows = np.flatnonzero((slot.place >= 0) & (across > 0.0))
        here = slot.fills.at(slot.place[rows])
        change = law_error(here, pairs.speed[rows], across[rows])
        weighted[rows] += here.added_mass * change
        largest[rows] = np.maximum(largest[rows], change)
    # One over the stiffness that holds the largest deflection.
    compliance = np.full(most.shape, np.inf)
    force = pairs.unbalance * np.square(pairs.speed)
    np.divide(most, force, out=compliance, where=force > 0.0)
    pull = np.square(pairs.speed) * weighted
    moved = np.zeros(most.shape)
    np.multiply(pull, compliance, out=moved, where=(pull != 0.0) & (force > 0.0))
    return np.asarray(largest + moved)
