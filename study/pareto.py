"""What must be given up for what: vibration, mass of liquid, stability margin [theory: optimum, eq. 10]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Front:
    """Points of which none is better than another in everything; m points of c chambers.

    Parameters
    ----------
    volume : m^3, shape (m, c)
    vibration : m, shape (m,)
    mass : of the liquid, kg, shape (m,)
    margin : decay of the small whirl that dies out slowest at the operating speeds, 1/s; below 0 it grows;
        shape (m,)
    """

    volume: Array
    vibration: Array
    mass: Array
    margin: Array


def not_dominated(values: Array) -> Flags:
    """Points that no other beats: none is as good in every value and better in one.

    Parameters
    ----------
    values : to be small, shape (m, k)

    Returns
    -------
    shape (m,); of points that are equal in everything the first alone
    """
    kept: Flags = np.asarray(np.isfinite(values).all(axis=1))
    order = np.lexsort(values.T[::-1])
    # In this order no point is beaten by a later one.
    for place, k in enumerate(order.tolist()):
        if kept[k]:
            later = order[place + 1 :]
            kept[later] &= ~np.all(values[later] >= values[k], axis=1)
    return kept


def front_of(volume: Array, vibration: Array, mass: Array, margin: Array) -> Front:
    """The points that are not dominated, by rising mass.

    Parameters
    ----------
    volume, vibration, mass, margin : as in `Front`
    """
    kept = np.flatnonzero(not_dominated(np.stack((vibration, mass, -margin), axis=1)))
    kept = kept[np.lexsort((vibration[kept], mass[kept]))]
    return Front(volume[kept], vibration[kept], mass[kept], margin[kept])
