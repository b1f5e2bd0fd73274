"""The special case: one deflection given, the least liquid that covers the walls [theory: optimum, eq. 1]."""

from __future__ import annotations

import numpy as np

from fluid.fill import Fill
from solvers.fill_judged import Judgement
from solvers.hydrostatics import equilibrium
from study.constraints import Verdict
from study.covering import Covering, covering, covering_by_search
from study.fidelity import axial_gravity
from study.record import MM, RPM
from study.scene import Scene


def cover_walls(
    scene: Scene, deflection: float, speed: float
) -> tuple[list[float], tuple[Covering, ...], int, tuple[str, ...]]:
    """For each chamber the least volume that leaves no part of its wall dry over its whole height.

    Parameters
    ----------
    scene : the machine
    deflection : e, m
    speed : rad/s

    Returns
    -------
    volumes found by the search, m^3, the closed forms, how many were judged, and what to say of them
    """
    gravity = axial_gravity(scene)
    found = [covering_by_search(fill, deflection, speed, gravity) for fill in scene.chambers]
    volumes, count = [float(one.point[0]) for one in found], sum(one.points.shape[0] for one in found)
    forms = tuple(covering(fill.chamber, deflection, speed, gravity) for fill in scene.chambers)
    gap = max(
        abs(volume / form.optimal_volume - 1.0) if form.optimal_volume > 0.0 else abs(volume)
        for volume, form in zip(volumes, forms, strict=True)
    )
    note = (
        f"The deflection is given, {deflection * MM:.4g} mm at {speed * RPM:.4g} rpm: the volumes are the "
        "least that leave no part of a wall dry over its whole height; search and closed form differ by "
        f"{gap:.1e}."
    )
    return volumes, forms, count, (note,)


def liquid_unbalance(fill: Fill, deflection: float, speed: float, gravity: float) -> float:
    """First moment of a chamber's liquid about the rotation axis, kg m."""
    state = equilibrium(fill.chamber, fill.volume, deflection, speed, gravity)
    return fill.liquid.density * float(state.unbalance()[0])


def dry_verdict(scene: Scene, volumes: list[float], deflection: float, speed: float) -> Verdict:
    """Whether any wall is dry over its whole height."""
    gravity = axial_gravity(scene)
    dry = 0.0
    for fill, volume in zip(scene.chambers, volumes, strict=True):
        # A hair above the volume that just covers it.
        held = min(volume * (1.0 + 1e-9), fill.chamber.capacity)
        dry = max(dry, float(equilibrium(fill.chamber, held, deflection, speed, gravity).dry_patch))
    return Verdict(0.0, dry, dry == 0.0, "1", "wall dry somewhere at the deflection given (1) or nowhere (0)")


def one_point(volumes: list[float], value: float, mass: float) -> Judgement:
    """Judgement of the answer alone."""
    one = np.ones(1)
    return Judgement(value * one, -one, {"vibration": value * one, "mass": mass * one, "sure": one.copy()})
