"""A chamber's liquid in the coupled machine: its layer's properties, its capture, its place before that."""

from __future__ import annotations

import math
from typing import NamedTuple

from fluid.fill import Fill
from fluid.friction import Friction, FrictionLaw
from fluid.waves import free_wave_frequencies

# A layer is let go at this share of the spin speed that captures it, lest it be caught and let go in turns.
RELEASE = 0.98


def mean_area(fill: Fill) -> float:
    """Liquid area per radian over R^2."""
    return fill.volume / (2.0 * math.pi * fill.chamber.height * fill.chamber.radius**2)


class LayerProperties(NamedTuple):
    """What the steps know of a layer, in the order of the record LAYER of `solvers.runup.state`.

    Parameters
    ----------
    radius : of the wall R, m
    weight : rho h_c, kg/m^2
    mass : kg
    law, coefficient : of the friction: number of the law; k, 1/s, Stokes' over the root of the spin, or c_f
    lid : 2 R/h_c under Stokes' friction, otherwise 0
    spread : square of L for the dispersive term, 0 without it
    """

    radius: float
    weight: float
    mass: float
    law: int
    coefficient: float
    lid: float
    spread: float


def layer_properties(fill: Fill, friction: Friction, dispersion: bool) -> LayerProperties:
    """What the steps know of a chamber's layer.

    Parameters
    ----------
    fill : chamber and liquid
    friction : on the walls; the laminar law takes the frequency of the slower free wave
    dispersion : add the finite depth's dispersion
    """
    chamber = fill.chamber
    log = math.log(chamber.radius / fill.surface_radius) if fill.surface_radius > 0.0 else math.inf
    # Of unit spin: the coefficient goes with the root of it.
    slip = abs(float(free_wave_frequencies(1, log, 1.0)[1])) if 0.0 < log < math.inf else 0.0
    law, coefficient = friction.at(fill.liquid.viscosity, slip, chamber.radius)
    lid = 2.0 * chamber.radius / chamber.height if friction.law is FrictionLaw.STOKES and slip > 0.0 else 0.0
    weight = fill.liquid.density * chamber.height
    spread = log**2 if dispersion and log < math.inf else 0.0
    return LayerProperties(chamber.radius, weight, fill.mass, law, coefficient, lid, spread)


def layer_capture(fill: Fill, gravity: float) -> float:
    """Speed above which the liquid is a layer, rad/s; infinite for liquid without a free surface, or none."""
    if not 0.0 < fill.volume < fill.chamber.capacity * (1.0 - 1e-9) or fill.surface_radius <= 0.0:
        return math.inf
    return math.sqrt(gravity / fill.surface_radius)


def pool_offset(fill: Fill) -> float:
    """Centre of mass of liquid that lies at the bottom of a chamber, along the first direction, m.

    A segment of the circle; an inner wall is left out.
    """
    from scipy.optimize import brentq

    if fill.volume == 0.0 or fill.volume >= fill.chamber.capacity * (1.0 - 1e-9):
        return 0.0
    radius = fill.chamber.radius
    share = fill.volume / (fill.chamber.height * radius**2)
    half = brentq(lambda a: a - math.sin(a) * math.cos(a) - share, 0.0, math.pi)
    return -radius * 2.0 * math.sin(half) ** 3 / (3.0 * share)
