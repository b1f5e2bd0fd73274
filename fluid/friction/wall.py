"""The law of the wall for a layer: the mean flow's friction as in a channel, and that of the waves upon it.

Two parts [theory: friction, eq. 6]. The mean part takes each cell's velocity and knows laminar and turbulent
flow; compiled code reads it from a table. The part of the waves is Stokes' and exerts no torque on the layer.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.friction.laws import (
    QUADRATIC,
    WALL,
    Friction,
    FrictionLaw,
    damping_rate,
    layer_thickness,
    plate_factor,
    stokes_coefficient,
)
from fluid.friction.pipe import drag_speed, hydraulic_diameter
from meshes.arrays import Array

# The table's last Reynolds number; beyond it the friction factor is that one's.
_TOP_REYNOLDS = 1e7
# Straight lines between so many equal steps of the velocity's fourth root: off by 1e-4 at most.
_STEPS = 8192
# A table for laws that have none.
NO_TABLE = np.zeros((0, 2))


class WallDrag(NamedTuple):
    """What a time step knows of the law of the wall; rates in the unit of the frequency given."""

    coefficient: float  #: of the waves' part on the wall, sqrt(nu |s|/2)/R, 1/s
    plates: float  #: 2 R/h_c times the drag of floor and lid over that of the wall
    lid: float  #: 2 R/h_c
    thin: float  #: thickness of the oscillating layer over R
    top: float  #: last velocity of the table over R, 1/s
    #: f_D u/8 over that velocity, and (1 - p)/2 or 0, p the power of u in it, at equal steps of the fourth
    #: root of u/top, shape (m, 2)
    table: Array


def wall_drag(
    friction: Friction,
    viscosity: float,
    depth: float,
    radius: float,
    height: float,
    frequency: float,
    spin: float,
) -> WallDrag:
    """The law of the wall for a layer of mean depth h and waves of frequency s seen from the drum, rad/s."""
    diameter = float(hydraulic_diameter(depth, height))
    top, table = drag_table(diameter, viscosity, friction.roughness)
    lid = 2.0 * radius / height
    thin = math.inf
    if frequency != 0.0:
        thin = float(layer_thickness(viscosity, frequency)) / radius
    return WallDrag(
        coefficient=float(stokes_coefficient(viscosity, frequency)) / radius,
        plates=lid * plate_factor(frequency, spin),
        lid=lid,
        # Without waves there is nothing to fade.
        thin=thin if math.isfinite(thin) else 0.0,
        top=top / radius,
        table=table,
    )


def drag_table(diameter: float, viscosity: float, roughness: float) -> tuple[float, Array]:
    """Last velocity of a `WallDrag`'s table, m/s, and the table, shape (m, 2)."""
    # Without viscosity the friction factor does not depend on the velocity: any one will do.
    top = _TOP_REYNOLDS * viscosity / diameter if viscosity > 0.0 else 1.0
    root = np.linspace(0.0, 1.0, _STEPS + 1)
    drag = drag_speed(top * root**4, diameter, viscosity, roughness) / top
    above = np.maximum(drag, 1e-300)
    power = np.ones_like(root)
    power[1:] = np.gradient(np.log(above), root)[1:] * root[1:] / 4.0
    return top, np.stack([drag, 0.5 * np.clip(1.0 - power, 0.0, 1.0)], axis=1)


def mean_rates(drag: WallDrag, depth: ArrayLike, area: ArrayLike, velocity: ArrayLike) -> Array:
    """Rate at which the mean part takes the velocity, (f_D |u|/8)(1/h + 2/h_c) [theory: friction, eq. 7].

    Depth and area over R and R^2, velocity over R, shape (n,).
    """
    slip = np.abs(velocity) / (1.0 - np.asarray(area)) / drag.top
    root = np.minimum(slip, 1.0) ** 0.25
    nodes = np.linspace(0.0, 1.0, len(drag.table))
    found = np.interp(root, nodes, drag.table[:, 0]) * np.maximum(slip, 1.0) * drag.top
    return np.asarray(found * (1.0 / np.asarray(depth) + drag.lid))


def wave_rates(drag: WallDrag, depth: ArrayLike, area: ArrayLike) -> Array:
    """Rate at which the part of the waves takes what they have beside the mean [theory: friction, eq. 8]."""
    h = np.asarray(depth)
    faded = h / (h + drag.thin)
    return np.asarray(drag.coefficient * (1.0 + drag.plates * h) / np.asarray(area) * faded)


def wall_shear(drag: WallDrag, depth: Array, area: Array, velocity: Array) -> Array:
    """Torque of the wall on a radian of the layer over rho, both parts [theory: friction, eq. 6]."""
    held, waves = mean_rates(drag, depth, area, velocity), wave_rates(drag, depth, area)
    weight = waves * area
    mean = float(weight @ velocity) / max(float(weight.sum()), 1e-300)
    return np.asarray(area * (held * velocity + waves * (velocity - mean)))


def lag_drag(fill: Fill, friction: Friction, lag: float, spin: float, slip: float) -> float:
    """Torque of the wall on liquid that lags as a solid, over m R^2 of it, 1/s^2; speeds in rad/s.

    The mean part alone: that of the waves has no torque. `slip` of the waves, without sign.
    """
    radius, depth = fill.chamber.radius, fill.depth / fill.chamber.radius
    law, coefficient = friction.at(fill.liquid.viscosity, slip, radius)
    area = depth * (1.0 - 0.5 * depth)
    if law == WALL:
        # It takes the lag as that of a solid layer.
        diameter = hydraulic_diameter(fill.depth, fill.chamber.height)
        given = lag * radius, diameter, fill.liquid.viscosity, friction.roughness
        return 4.0 * float(drag_speed(*given)) / float(diameter) * lag * (1.0 - area)
    velocity = lag * (1.0 - depth)  # over R, at the surface: the profile R/r of the long waves
    lid = 2.0 * radius / fill.chamber.height if friction.law is FrictionLaw.STOKES else 0.0
    rate = float(damping_rate(law, coefficient, lid, depth, area, velocity if law == QUADRATIC else 0.0))
    return rate * velocity
