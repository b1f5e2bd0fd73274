"""Estimated errors of a steady answer: of the linear law, and by gravity across the axis.

Closed forms [theory: model_error]. The bounds of the rotors' answers are in `enclosure` and `coupled_bounds`,
`estimate` takes whichever the rotor has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fluid.fill import Fills
from meshes.arrays import Array, Flags

# What is left between an exact answer and the same from another order of sums.
ROUNDING = 1e-12
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


@dataclass(frozen=True)
class LinearError:
    """How far the linear law is from the exact one; shape (n,).

    Parameters
    ----------
    amplitude : bound of the amplitude's relative error; infinite where there is none
    liquid : of the error of the liquid's unbalance, and so of its centre of mass
    wet : no wall runs dry over its whole height
    strain : linear deflection over the one at which the law bends, of the chamber that is nearest to it
    """

    amplitude: Array
    liquid: Array
    wet: Flags
    strain: Array

    @property
    def worst(self) -> Array:
        """The larger of the two errors."""
        return np.maximum(self.amplitude, self.liquid)
