"""Dimensionless numbers of a liquid layer in a spinning chamber."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fluid.fill import Fill
from fluid.paraboloid import steepness

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LayerNumbers:
    """What decides how a layer behaves; shapes (...,) of the speed.

    Parameters
    ----------
    fill : volume over capacity
    relative_depth : mean depth over radius, h0/R
    curvature : (R/a)^2, kappa
    centrifuge : centrifugal acceleration at the free surface over gravity, Omega^2 a/g
    steepness : rise of the surface over the chamber's radius in chamber heights, beta R^2/h
    reynolds : Omega R^2/nu
    skin : depth of the laminar wall layer over the mean depth, sqrt(nu/Omega)/h0
    """

    fill: float
    relative_depth: float
    curvature: float
    centrifuge: Array
    steepness: Array
    reynolds: Array
    skin: Array


def layer_numbers(fill: Fill, speed: ArrayLike, gravity: float, axial_gravity: float) -> LayerNumbers:
    """Numbers of one chamber's layer [theory: statics, eq. 2].

    Parameters
    ----------
    fill : chamber and liquid, with some liquid in it
    speed : spin speed Omega, rad/s, shape (...,), > 0
    gravity : g, m/s^2
    axial_gravity : its component along the axis, m/s^2

    Returns
    -------
    LayerNumbers; a number whose denominator is 0 is infinite
    """
    spin = np.asarray(speed, dtype=float)
    radius, viscosity = fill.chamber.radius, fill.liquid.viscosity
    surface = fill.surface_radius
    return LayerNumbers(
        fill=fill.volume / fill.chamber.capacity,
        relative_depth=fill.depth / radius,
        curvature=(radius / surface) ** 2 if surface > 0.0 else np.inf,
        centrifuge=np.square(spin) * surface / gravity if gravity > 0.0 else np.full(spin.shape, np.inf),
        steepness=steepness(spin, axial_gravity, radius, fill.chamber.height),
        reynolds=spin * radius**2 / viscosity if viscosity > 0.0 else np.full(spin.shape, np.inf),
        skin=np.sqrt(viscosity / spin) / fill.depth if fill.depth > 0.0 else np.full(spin.shape, np.inf),
    )
