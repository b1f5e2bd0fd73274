"""The volumes that just wet a chamber's wall at a deflection: analytical and by the search."""

from __future__ import annotations

import math

import numpy as np

from fluid.fill import Fill
from leblanc.studies.optimise.answer import WettingVolumes
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.search import Found, Judgement, SearchPlan, search
from solvers.statics.hydrostatics import equilibrium, optimal_volume


def wetting_volumes(chamber: Chamber, deflection: float, speed: float, gravity: float) -> WettingVolumes:
    """The volumes that wet a wall, analytical."""
    touching = float(optimal_volume(chamber, deflection, speed, gravity))
    full = full_volume(chamber, deflection, speed, gravity)
    filled = min(touching, chamber.capacity)
    most = chamber.capacity if math.isinf(full) else full
    of_touching, of_most = (
        float(equilibrium(chamber, volume, deflection, speed, gravity).unbalance()[0])
        for volume in (filled, most)
    )
    share = of_touching / of_most if of_most > 0.0 else 1.0
    return WettingVolumes(deflection, speed, touching, full, share)


def full_volume(chamber: Chamber, deflection: float, speed: float, gravity: float) -> float:
    """Least volume that wets the whole wall up to the lid [theory: optimum, eq. 1].

    m^3; infinite where the surface would cut the floor's edge or an inner wall, or leave the chamber.
    """
    near = chamber.radius - deflection
    # The surface falls by the chamber's height over h/beta in the square of its radius.
    fall = 2.0 * gravity * chamber.height / speed**2
    if near <= 0.0 or near**2 < fall:
        return math.inf
    if chamber.inner_radius > 0.0 and math.sqrt(near**2 - fall) < chamber.inner_radius + deflection:
        return math.inf
    ring = deflection * (chamber.radius + near)
    return math.pi * chamber.height * (ring + 0.5 * fall)


def optimal_volume_by_search(fill: Fill, deflection: float, speed: float, gravity: float) -> Found:
    """The least volume that leaves no part of the wall dry over its whole height, found by the search.

    The one that comes nearest where none will do.
    """
    chamber = fill.chamber

    def judge(volumes: Array) -> Judgement:
        amount = volumes[:, 0]
        state = equilibrium(chamber, amount, deflection, speed, gravity)
        # Height of the surface at the near wall, over a measure of the heights at both, whatever the speed.
        fallen = 2.0 * state.wetted_height - state.nearest_depth
        over = np.divide(-state.nearest_depth, fallen, out=np.ones_like(fallen), where=fallen > 0.0)
        return Judgement(amount.copy(), over)

    low, high = np.zeros(1), np.array([chamber.capacity])
    return search(judge, low, high, np.array([fill.liquid.density]), plan=SearchPlan(edge=1e-11))
