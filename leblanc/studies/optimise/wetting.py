"""The volumes that just wet a chamber's wall at a deflection: analytical and by the search."""

from __future__ import annotations

import numpy as np

from fluid.fill import Fill
from leblanc.studies.optimise.answer import WettingVolumes
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.search import Found, Judgement, SearchPlan, search
from solvers.statics.hydrostatics import equilibrium, wall_volumes


def wetting_volumes(chamber: Chamber, deflection: float, speed: float, gravity: float) -> WettingVolumes:
    """The volumes that wet a wall, analytical."""
    touching, *_, full = map(float, wall_volumes(chamber, deflection, speed, gravity))
    held = np.minimum((touching, full), chamber.capacity)
    of_touching, of_most = equilibrium(chamber, held, deflection, speed, gravity).unbalance()[0].tolist()
    share = of_touching / of_most if of_most > 0.0 else 1.0
    return WettingVolumes(deflection, speed, touching, full, share)


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
