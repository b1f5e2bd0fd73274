"""Dimensionless numbers of a layer: in a drum that spins, and under a whirl of its axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.paraboloid import CYLINDER_STEEPNESS, steepness
from fluid.waves import free_wave_speeds
from meshes.arrays import Array
from meshes.quantity import Q

_ENDS = ("end",)  # of the range of speeds


@dataclass(frozen=True)
class LayerNumbers:
    """What decides how a layer behaves; shapes (...,) of the speed."""

    fill: Annotated[float, Q("1", "fill", "volume over capacity", variable="fill")]
    relative_depth: Annotated[
        float, Q("1", "relative depth", "mean depth over radius, h0/R", variable="relative_depth")
    ]
    curvature: Annotated[float, Q("1", "curvature", "(R/a)^2, kappa", variable="curvature")]
    centrifuge: Annotated[
        Array,
        Q(
            "1",
            "centrifuge",
            "centrifugal acceleration at the free surface over gravity, Omega^2 a/g",
            _ENDS,
            variable="centrifuge",
        ),
    ]
    #: infinite for a cylinder
    steepness: Annotated[
        Array,
        Q(
            "1",
            "steepness",
            "rise of the surface over the radius in chamber heights, beta R^2/h",
            _ENDS,
            variable="steepness",
        ),
    ]
    reynolds: Annotated[Array, Q("1", "reynolds", "Omega R^2/nu", _ENDS, variable="reynolds")]
    skin: Annotated[
        Array,
        Q("1", "skin", "laminar wall layer over the mean depth, sqrt(nu/Omega)/h0", _ENDS, variable="skin"),
    ]


def layer_numbers(fill: Fill, speed: ArrayLike, gravity: float, axial_gravity: float) -> LayerNumbers:
    """Numbers of one chamber's layer; inf where a denominator is 0 [theory: statics, eq. 2]."""
    spin = np.asarray(speed, dtype=float)
    radius, viscosity = fill.chamber.radius, fill.liquid.viscosity
    surface = fill.surface_radius
    steep = steepness(spin, axial_gravity, radius, fill.chamber.height)
    return LayerNumbers(
        fill=fill.volume / fill.chamber.capacity,
        relative_depth=fill.depth / radius,
        curvature=(radius / surface) ** 2 if surface > 0.0 else np.inf,
        centrifuge=np.square(spin) * surface / gravity if gravity > 0.0 else np.full(spin.shape, np.inf),
        steepness=np.where(steep < CYLINDER_STEEPNESS, steep, np.inf),
        reynolds=spin * radius**2 / viscosity if viscosity > 0.0 else np.full(spin.shape, np.inf),
        skin=np.sqrt(viscosity / spin) / fill.depth if fill.depth > 0.0 else np.full(spin.shape, np.inf),
    )


@dataclass(frozen=True)
class WhirlNumbers:
    """What decides which model of the layer holds under a whirl."""

    relative_depth: float  #: mean depth over radius, h0/R
    deflection: float  #: whirl amplitude over mean depth, w0/h0
    detuning: float  #: distance of the whirl from the nearer natural wave over the distance of the two
    froude: float  #: whirl speed seen from the drum over the nearer natural sloshing wave's
    #: centrifugal acceleration at the free surface over gravity across the axis, Omega^2 a/g
    centrifuge: float
    reynolds: float  #: Omega R^2/nu
    #: laminar layer of the oscillation at the wall over the mean depth, sqrt(2 nu/|s|)/h0; for a
    #: synchronous whirl, which moves nothing, 0 or that of gravity, which turns at the spin
    wall_layer: float


def whirl_numbers(
    fill: Fill, spin: float, whirl_speed: float, amplitude: float, gravity: float
) -> WhirlNumbers:
    """Numbers of one layer under one whirl [theory: waves, eq. 7] [theory: long_wave, eq. 10].

    A number whose denominator is 0 is infinite.
    """
    radius, surface, depth = fill.chamber.radius, fill.surface_radius, fill.depth
    viscosity, slip = fill.liquid.viscosity, whirl_speed - spin
    pair = [
        float(speed)
        for speed in free_wave_speeds(1, math.log(radius / surface) if surface else math.inf, spin)
    ]
    nearer = min(pair, key=lambda speed: abs(slip - speed))
    slowest = abs(slip) or (spin if gravity else 0.0)
    skin = math.sqrt(2.0 * viscosity / slowest) / depth if slowest else 0.0
    return WhirlNumbers(
        relative_depth=depth / radius,
        deflection=amplitude / depth,
        detuning=abs(slip - nearer) / abs(pair[0] - pair[1]),
        froude=abs(slip / nearer),
        centrifuge=spin**2 * surface / gravity if gravity else math.inf,
        reynolds=spin * radius**2 / viscosity if viscosity else math.inf,
        wall_layer=skin,
    )
