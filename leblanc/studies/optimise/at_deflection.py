"""The least volumes that leave no wall dry over its whole height at a given deflection."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from leblanc.results.base import Note
from leblanc.results.optimum import ConstraintValue, WettingVolumes, given_deflection
from leblanc.scene.scene import Scene
from leblanc.studies.choose import axial_gravity
from leblanc.studies.optimise.answers import with_volumes
from leblanc.studies.optimise.closed_form import optimal_volume_by_search, wetting_volumes
from solvers.statics.hydrostatics import equilibrium


@dataclass(frozen=True)
class WettedWalls:
    """The least volumes that wet the walls at a deflection; one for each chamber.

    Parameters
    ----------
    deflection, speed : given, m and rad/s
    volumes : found by the search, m^3
    closed_form : beside them
    unbalance, mass : of the liquid, kg m and kg
    dry_wall : whether any wall is dry over its whole height
    evaluations : how many volumes the search evaluated
    notes : how near search and closed form are
    """

    deflection: float
    speed: float
    volumes: tuple[float, ...]
    closed_form: tuple[WettingVolumes, ...]
    unbalance: float
    mass: float
    dry_wall: ConstraintValue
    evaluations: int
    notes: tuple[Note, ...]


def wet_walls(scene: Scene, deflection: float, speed: float) -> WettedWalls:
    """For each chamber the least volume that leaves no part of its wall dry over its whole height.

    Parameters
    ----------
    scene : the machine
    deflection : e, m
    speed : rad/s
    """
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
        held = min(volume * (1.0 + 1e-9), fill.chamber.capacity)
        dry = max(dry, float(equilibrium(fill.chamber, held, deflection, speed, gravity).dry_patch))
    meaning = "wall dry somewhere at the deflection given (1) or nowhere (0)"
    return ConstraintValue(0.0, dry, dry == 0.0, "1", meaning)
