"""The volumes that just wet a chamber's wall: in closed form, by the search, and at a given deflection."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from leblanc.core.notes import Note
from leblanc.results.base import ConstraintValue
from leblanc.results.optimum import WettingVolumes, given_deflection
from leblanc.scene.scene import Scene
from leblanc.studies.models.choose import axial_gravity
from leblanc.studies.optimise.answers import with_volumes
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.search import Found, Judgement, SearchPlan, search
from solvers.statics.hydrostatics import equilibrium, optimal_volume


def wetting_volumes(chamber: Chamber, deflection: float, speed: float, gravity: float) -> WettingVolumes:
    """The volumes that wet a wall, in closed form."""
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


def optimal_volume_by_search(
    fill: Fill, deflection: float, speed: float, gravity: float, plan: SearchPlan | None = None
) -> Found:
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
    return search(judge, low, high, np.array([fill.liquid.density]), plan=plan or SearchPlan(edge=1e-11))


@dataclass(frozen=True)
class WettedWalls:
    """The least volumes that wet the walls at a deflection; one for each chamber."""

    deflection: float  #: given, m and rad/s
    speed: float
    volumes: tuple[float, ...]  #: found by the search, m^3
    closed_form: tuple[WettingVolumes, ...]  #: beside them
    unbalance: float  #: of the liquid, kg m and kg
    mass: float
    dry_wall: ConstraintValue  #: whether any wall is dry over its whole height
    evaluations: int  #: how many volumes the search evaluated
    notes: tuple[Note, ...]  #: how near search and closed form are


def wet_walls(scene: Scene, deflection: float, speed: float) -> WettedWalls:
    """For each chamber the least volume that leaves no part of its wall dry over its whole height."""
    gravity = axial_gravity(scene)
    found = [optimal_volume_by_search(fill, deflection, speed, gravity) for fill in scene.fills]
    volumes = tuple(float(best.point[0]) for best in found)
    forms = tuple(wetting_volumes(fill.chamber, deflection, speed, gravity) for fill in scene.fills)
    gap = max(
        abs(volume / form.optimal_volume - 1.0) if form.optimal_volume > 0.0 else abs(volume)
        for volume, form in zip(volumes, forms, strict=True)
    )
    filled = with_volumes(scene, np.array(volumes)).fills
    return WettedWalls(
        deflection=deflection,
        speed=speed,
        volumes=volumes,
        closed_form=forms,
        unbalance=sum(_unbalance(fill, deflection, speed, gravity) for fill in filled),
        mass=sum(fill.mass for fill in filled),
        dry_wall=_dry_wall(scene, volumes, deflection, speed),
        evaluations=sum(best.points.shape[0] for best in found),
        notes=(given_deflection(deflection, speed, gap),),
    )


def _unbalance(fill: Fill, deflection: float, speed: float, gravity: float) -> float:
    """First moment of a chamber's liquid about the rotation axis, kg m."""
    state = equilibrium(fill.chamber, fill.volume, deflection, speed, gravity)
    return fill.liquid.density * float(state.unbalance()[0])


def _dry_wall(scene: Scene, volumes: tuple[float, ...], deflection: float, speed: float) -> ConstraintValue:
    """Whether any wall is dry over its whole height."""
    gravity = axial_gravity(scene)
    dry = 0.0
    for fill, volume in zip(scene.fills, volumes, strict=True):
        # A little above the volume that just wets it.
        filled = min(volume * (1.0 + 1e-9), fill.chamber.capacity)
        dry = max(dry, float(equilibrium(fill.chamber, filled, deflection, speed, gravity).dry_patch))
    meaning = "wall dry somewhere at the deflection given (1) or nowhere (0)"
    return ConstraintValue(0.0, dry, dry == 0.0, "1", meaning)
