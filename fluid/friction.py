"""Wall friction laws of a thin layer: rate at which the liquid's motion relative to the drum dies out.

Lengths in units of the wall radius. The wall shear is tau/rho = k h u [theory: long_wave, eq. 9].
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array

NONE, LINEAR, STOKES, QUADRATIC = 0, 1, 2, 3
# The laws by the names that users give them.
LAWS = {"none": NONE, "linear": LINEAR, "stokes": STOKES, "quadratic": QUADRATIC}


def damping_rate(law: int, coefficient: float, lid: float, depth: Any, area: Any, velocity: Any) -> Any:
    """Rate of decay of u, tau R/(rho u A) in the units of the coefficient [theory: long_wave, eq. 9].

    Serves arrays and, compiled, scalars.

    Parameters
    ----------
    law : NONE, LINEAR, STOKES or QUADRATIC
    coefficient : k for LINEAR, 1/s; sqrt(nu |s|/2)/R for STOKES, 1/s; c_f for QUADRATIC
    lid : 2 R/h_c, floor and lid for STOKES; 0 without them
    depth : h/R
    area : A/R^2 > 0
    velocity : u, in units that make c_f |u| a rate
    """
    if law == 1:
        return coefficient * depth / area
    if law == 2:
        return coefficient * (1.0 + lid * depth) / area
    if law == 3:
        return coefficient * np.abs(velocity) / area
    return 0.0 * area


def stokes_coefficient(viscosity: ArrayLike, frequency: ArrayLike) -> Array:
    """Shear over velocity of an oscillating laminar layer, sqrt(nu |s|/2), m/s [theory: long_wave, eq. 10].

    Parameters
    ----------
    viscosity : nu, m^2/s, shape (...,)
    frequency : whirl frequency s seen from the drum, rad/s, shape (...,)
    """
    squared = 0.5 * np.asarray(viscosity, dtype=float) * np.abs(np.asarray(frequency, dtype=float))
    return np.asarray(np.sqrt(squared))
