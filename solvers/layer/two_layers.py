"""Two shallow layers of a horizontal drum as they begin: what the steps know of a chamber, liquid at rest.

Lengths over R, times in seconds [theory: pool, eq. 8-17].
"""

from __future__ import annotations

import math

import numpy as np

from fluid import pool as closures
from fluid.fill import Fill
from fluid.friction.laws import Friction, stokes_coefficient
from meshes.arrays import Array
from solvers.layer.records import Record, floats, records

# The surface comes no nearer to the axis where there is no inner wall, but for that of liquid at rest.
_NEAREST, _LEAST = 0.2, 0.03
# Rows of scratch of the steps.
ROWS = 22
# Of a chamber: wall radius R, m; rho h_c R^4 in kg m^2 and rho h_c R^3; mass; area of the full gap, square of
# the waves' speed in it, 1/s^2, radius of its inner wall; law and coefficient of the friction (k, 1/s, or
# c_f), sqrt(nu/2)/R of Stokes', last velocity of the law of the wall's table; 2 R/h_c; number of baffles over
# 2 pi, distances of their edges from the wall, loss coefficient given or -1, whether they let nothing pass,
# and by what the grip on the pool is stronger than expected.
STREAM = floats(
    *("radius", "inertia", "weight", "mass", "full", "slot", "rim"),
    *("law", "coefficient", "stokes", "top", "lid"),
    *("baffles", "tip", "gap", "loss", "shut", "grip"),
)
# What a step adds up: impulse of the torque on the liquid over rho h_c R^4, heat at walls and at baffles.
TAKEN = floats("torque", "heat", "baffles")
# Sums over the cells: first moment; its rate by the flow; inertia of the flow; energy of motion and of what
# full gaps hold; angular momentum; moment of inertia [theory: coupling, eq. 2-4].
FLOWS = floats("moment_x", "moment_y", "flow_x", "flow_y", "xx", "xy", "yy", "energy", "spinning", "inertia")


def stream_of(fill: Fill, friction: Friction, gravity: float, top: float = 0.0, grip: float = 1.0) -> Record:
    """Record STREAM of a chamber; `top` of the law of the wall's table, over R."""
    chamber, plates = fill.chamber, fill.chamber.baffles
    radius, weight = chamber.radius, fill.liquid.density * chamber.height
    pool = closures.pool_of(fill)
    lies = _NEAREST if pool is None else math.cos(pool.half_angle)
    rim = max(chamber.inner_radius / radius, min(_NEAREST, max(lies, _LEAST)))
    found = records(STREAM)[0]
    found.radius, found.weight, found.inertia = radius, weight * radius**3, weight * radius**4
    found.mass, found.rim, found.full = fill.mass, rim, 0.5 * (1.0 - rim) * (1.0 + rim)
    found.slot = closures.SLOT**2 * gravity / radius
    found.law, found.coefficient = friction.law.number, friction.coefficient
    found.stokes, found.top = float(stokes_coefficient(fill.liquid.viscosity, 1.0)) / radius, top
    found.lid, found.loss, found.grip = 2.0 * radius / chamber.height, -1.0, grip
    if plates is not None:
        found.baffles = plates.count / (2.0 * np.pi)
        found.tip, found.gap = 1.0 - plates.tip_radius / radius, plates.wall_gap / radius
        found.loss = -1.0 if plates.loss is None or fill.depth == 0.0 else plates.loss
        found.shut = float(plates.tip_radius <= chamber.inner_radius)
    return found


def resting(mean: float, pull: Array, full: float, slot: float, rim: float) -> Array:
    """Areas over R^2 of liquid at rest under a radial pull G, (n,) [theory: pool, eq. 11]."""
    largest = float(pull.max())

    def at(level: float) -> Array:
        found = np.zeros_like(pull)
        for i in np.flatnonzero(pull > 0.0).tolist():
            found[i] = closures.area_at(level, float(pull[i]), rim, full, slot)
        return found

    low, high = -largest * (1.0 + slot / max(largest, 1e-300)), largest
    for _ in range(200):
        middle = 0.5 * (low + high)
        if not low < middle < high:
            break
        low, high = (middle, high) if at(middle).mean() > mean else (low, middle)
    return at(low)
