"""Free surface of one chamber, its optimal volume, and the same by finite elements."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from fluid.fill import Fill
from fluid.printed import optimal_volume_as_printed, optimal_volume_disc_corrected
from leblanc.studies.volume.answer import Coverage, Surface, VolumeAnswer, WallVolumes
from meshes.arrays import Array
from meshes.chamber import Chamber
from meshes.errors import InputError, require_not_negative
from solvers.statics.hydrostatics import equilibrium, wall_volumes

# The volume counts as the optimal one when it is that to the digits that people pass on.
_SAME = 1e-8


def answer_volume(
    radius: float,
    height: float,
    eccentricity: float,
    speed: float,
    volume: float | None = None,
    gravity: float = 9.81,
    inner_radius: float = 0.0,
) -> VolumeAnswer:
    """Optimal volume, exact, by finite elements, and as published [theory: statics, eq. 8]."""
    from solvers.statics.free_surface import optimal_volume_fem

    chamber = Chamber(radius, height, inner_radius)
    for name, value in {"eccentricity": eccentricity, "speed": speed, "gravity": gravity}.items():
        require_not_negative(name, value)
    met = wall_volumes(chamber, eccentricity, speed, gravity)
    exact, lid, full = float(met.wetting), float(np.fmin(met.lid, met.inner)), float(met.full)
    elements = optimal_volume_fem(
        chamber.radius,
        chamber.height,
        eccentricity,
        _beta(speed, gravity),
        inner_radius=chamber.inner_radius,
    )
    return VolumeAnswer(
        chamber=chamber,
        eccentricity=eccentricity,
        speed=speed,
        gravity=gravity,
        optimal_volume=exact,
        optimal_volume_fem=elements,
        fem_error=abs(elements - exact) / exact if exact > 0.0 else abs(elements),
        printed_eq18=_or_none(lambda: optimal_volume_as_printed(chamber, eccentricity, speed, gravity)),
        corrected_eq18=_or_none(lambda: optimal_volume_disc_corrected(chamber, eccentricity, speed, gravity)),
        lid_volume=None if math.isnan(lid) else lid,
        full_volume=full,
        volume=volume,
        surface=None if volume is None else _surface(chamber, volume, eccentricity, speed, gravity, exact),
    )


def volumes_over_speed(
    fills: tuple[Fill, ...], speed: Array, deflection: Array, gravity: float
) -> WallVolumes:
    """The three volumes of each chamber at its deflection at each speed, shape (c, s).

    nan where the deflection is not known or has no bound, and where baffles cut the liquid or a section is no
    circle.
    """
    found = np.full((3, len(fills), speed.size), np.nan)
    for k, fill in enumerate(fills):
        known = np.isfinite(deflection[k])
        if known.any() and fill.compartments <= 1 and fill.chamber.section is None:
            met = wall_volumes(fill.chamber, deflection[k, known], speed[known], gravity)
            found[:, k, known] = met.wetting, np.fmin(met.lid, met.inner), met.full
    return WallVolumes(*found)


def _surface(
    chamber: Chamber, volume: float, eccentricity: float, speed: float, gravity: float, best: float
) -> Surface:
    """Surface constant and unbalance of a given volume, exact and by finite elements."""
    from meshes.section import section_area
    from solvers.statics.free_surface import default_disc, solve_surface

    state = equilibrium(chamber, volume, eccentricity, speed, gravity)
    layer = volume / (2.0 * math.pi * chamber.radius * chamber.height)
    section = default_disc(chamber.radius, layer, inner_radius=chamber.inner_radius)
    # The mesh holds a little less than the chamber: a brimful chamber fills all of it.
    filled = min(volume, section_area(section) * chamber.height)
    elements = solve_surface(
        section, chamber.height, _beta(speed, gravity), filled, axis=(-eccentricity, 0.0)
    )
    constant = float(state.surface_constant)
    return Surface(
        surface_constant=constant if math.isfinite(constant) else None,
        unbalance_volume=float(state.unbalance()[0]),
        unbalance_volume_fem=float(np.asarray(elements.moments.x)),
        case=_case(volume, best),
        converged=bool(state.converged) and elements.converged,
    )


def _case(volume: float, best: float) -> Coverage:
    """The volume against the optimal one."""
    if abs(volume - best) <= _SAME * best:
        return Coverage.AS_MUCH
    return Coverage.MORE if volume > best else Coverage.LESS


def _beta(speed: float, gravity: float) -> float:
    """Omega^2/(2 g), 1/m; infinite without gravity."""
    if speed == 0.0:
        return 0.0
    return speed**2 / (2.0 * gravity) if gravity > 0.0 else math.inf


def _or_none(formula: Callable[[], float]) -> float | None:
    """Value of a printed formula; None where it has none."""
    try:
        return formula()
    except InputError:
        return None
