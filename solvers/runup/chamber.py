"""A chamber's liquid in the coupled machine: its layer's properties, its capture, its place before that."""

from __future__ import annotations

import math

from fluid.fill import Fill
from fluid.friction import Friction, FrictionLaw
from fluid.waves import free_wave_frequencies


def layer_properties(fill: Fill, friction: Friction, dispersion: bool) -> tuple[float, ...]:
    """Row of `Machine.layers`."""
    chamber = fill.chamber
    log = math.log(chamber.radius / fill.surface_radius) if fill.surface_radius > 0.0 else math.inf
    # Of unit spin: the coefficient goes with the root of it.
    slip = abs(float(free_wave_frequencies(1, log, 1.0)[1])) if 0.0 < log < math.inf else 0.0
    law, coefficient = friction.at(fill.liquid.viscosity, slip, chamber.radius)
    lid = 2.0 * chamber.radius / chamber.height if friction.law is FrictionLaw.STOKES and slip > 0.0 else 0.0
    weight = fill.liquid.density * chamber.height
    spread = log**2 if dispersion and log < math.inf else 0.0
    return chamber.radius, weight, fill.mass, float(law), coefficient, lid, spread


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
