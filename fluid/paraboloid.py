"""The free surface of a liquid that rotates as a whole about an axis off the chamber's centre.

Surface z = beta r^2 + C, r from the rotation axis, z from the chamber floor [theory: statics, eq. 1].
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array

# Steepness beta R^2/h that stands for "no gravity along the axis": the surface is then a cylinder to far
# below rounding, and every intermediate product still fits a double.
CYLINDER_STEEPNESS = 1e30


def steepness(speed: ArrayLike, gravity: ArrayLike, radius: ArrayLike, height: ArrayLike) -> Array:
    """Rise of the free surface over the chamber's radius, in chamber heights.

    B = beta R^2/h with beta = Omega^2/(2 g) [theory: statics, eq. 2]; capped where the surface is a cylinder.

    Parameters
    ----------
    speed : spin speed Omega, rad/s
    gravity : gravity along the axis g, m/s^2; 0 for a horizontal axis
    radius, height : of the chamber, m

    Returns
    -------
    B, from 0 (flat) to `CYLINDER_STEEPNESS`; 0 where both speed and gravity are 0
    """
    spin, g, wall, h = np.broadcast_arrays(
        *(np.asarray(x, dtype=float) for x in (speed, gravity, radius, height))
    )
    rise = np.square(spin * wall)
    fall = 2.0 * g * h
    capped = rise >= CYLINDER_STEEPNESS * fall
    ratio = np.divide(rise, fall, out=np.full(rise.shape, CYLINDER_STEEPNESS), where=~capped)
    return np.where(rise == 0.0, 0.0, ratio)


def clear_surface_constant(
    volume: ArrayLike, speed: ArrayLike, gravity: float, radius: float, height: float
) -> Array:
    """Surface constant while the surface cuts floor and lid and is clear of the side wall [DR18, eq. 17].

    C = h/2 - beta (R^2 - V/(pi h)), exact there [theory: statics, eq. 3].

    Parameters
    ----------
    volume : V, m^3, shape (...,)
    speed : spin speed Omega, rad/s, shape (...,)
    gravity : g, m/s^2, above 0
    radius, height : of the chamber, m

    Returns
    -------
    C, m, shape (...,)
    """
    beta = np.square(np.asarray(speed, dtype=float)) / (2.0 * gravity)
    filled = np.asarray(volume, dtype=float) / (np.pi * height)
    return np.asarray(0.5 * height - beta * (radius**2 - filled))
