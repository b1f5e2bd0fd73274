"""Free surface of one chamber, its optimal volume, and the same by finite elements."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fluid.printed import optimal_volume_as_printed, optimal_volume_disc_corrected
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.statics.hydrostatics import equilibrium, optimal_volume

# The volume counts as the optimal one when it is that to the digits that people pass on.
_SAME = 1e-8


@dataclass(frozen=True)
class VolumeAnswer:
    """Optimal volume of a chamber at a deflection and a speed.

    Parameters
    ----------
    optimal_volume : exact, m^3
    optimal_volume_fem : by finite elements, m^3
    fem_error : of the latter, relative
    printed_eq18 : as the source prints it, m^3; None where the formula has no value
    corrected_eq18 : with its moment corrected, m^3; None where the formula has no value
    """

    optimal_volume: float
    optimal_volume_fem: float
    fem_error: float
    printed_eq18: float | None
    corrected_eq18: float | None


@dataclass(frozen=True)
class SurfaceAnswer:
    """Free surface that holds a given volume.

    Parameters
    ----------
    surface_constant : C of z = beta r^2 + C, m; None without gravity along the axis
    unbalance_volume : first moment of the liquid about the rotation axis over its density, m^4
    unbalance_volume_fem : the same by finite elements, m^4
    case : 1 more liquid than the optimal volume, 2 as much, 3 less [DR18, section 5]
    converged : both surfaces hold the volume asked for
    """

    surface_constant: float | None
    unbalance_volume: float
    unbalance_volume_fem: float
    case: Literal[1, 2, 3]
    converged: bool


def answer_volume(chamber: Chamber, eccentricity: float, speed: float, gravity: float) -> VolumeAnswer:
    """Optimal volume, exact, by finite elements, and as printed [theory: statics, eq. 8].

    Parameters
    ----------
    chamber : the chamber
    eccentricity : deflection e, m
    speed : spin speed Omega, rad/s
    gravity : along the axis, m/s^2

    Raises
    ------
    InputError : a value out of its range
    """
    from solvers.statics.free_surface import optimal_volume_fem

    exact = float(optimal_volume(chamber, eccentricity, speed, gravity))
    elements = optimal_volume_fem(
        chamber.radius,
        chamber.height,
        eccentricity,
        _beta(speed, gravity),
        inner_radius=chamber.inner_radius,
    )
    return VolumeAnswer(
        optimal_volume=exact,
        optimal_volume_fem=elements,
        fem_error=abs(elements - exact) / exact if exact > 0.0 else abs(elements),
        printed_eq18=_or_none(lambda: optimal_volume_as_printed(chamber, eccentricity, speed, gravity)),
        corrected_eq18=_or_none(lambda: optimal_volume_disc_corrected(chamber, eccentricity, speed, gravity)),
    )


def answer_surface(
    chamber: Chamber, volume: float, eccentricity: float, speed: float, gravity: float
) -> SurfaceAnswer:
    """Surface constant and unbalance of a given volume, exact and by finite elements.

    Parameters
    ----------
    chamber : the chamber
    volume : of the liquid, m^3
    eccentricity, speed, gravity : see `answer_volume`

    Raises
    ------
    InputError : a value out of its range, more liquid than the chamber holds
    """
    from meshes.section import section_area
    from solvers.statics.free_surface import default_disc, solve_surface

    state = equilibrium(chamber, volume, eccentricity, speed, gravity)
    layer = volume / (2.0 * math.pi * chamber.radius * chamber.height)
    section = default_disc(chamber.radius, layer, inner_radius=chamber.inner_radius)
    # The mesh holds a little less than the chamber: a brimful chamber fills all of it.
    held = min(volume, section_area(section) * chamber.height)
    elements = solve_surface(section, chamber.height, _beta(speed, gravity), held, axis=(-eccentricity, 0.0))
    constant = float(state.surface_constant)
    best = float(optimal_volume(chamber, eccentricity, speed, gravity))
    return SurfaceAnswer(
        surface_constant=constant if math.isfinite(constant) else None,
        unbalance_volume=float(state.unbalance()[0]),
        unbalance_volume_fem=float(np.asarray(elements.moments.x)),
        case=2 if abs(volume - best) <= _SAME * best else 1 if volume > best else 3,
        converged=bool(state.converged) and elements.converged,
    )


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
