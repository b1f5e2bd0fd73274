"""Formulas as the sources print them, each next to its corrected form, for chambers without an inner wall.

Of the functions named `..._as_printed` only the dry radius is right; they serve the comparison in the
validation report [theory: errata]. The sources' constant C* has the opposite sign of the package's: z = beta
r^2 - C*.
"""

from __future__ import annotations

import math

from fluid.paraboloid import lens_moments
from meshes.chamber import Chamber
from meshes.errors import InputError, require_not_negative, require_positive


def dry_radius_as_printed(chamber: Chamber, eccentricity: float) -> float:
    """Radius R - e of the floor's waterline that touches the near wall, right as published [DR18, eq. 19]."""
    _require_plain(chamber)
    _require_axis_inside(chamber, eccentricity)
    return chamber.radius - eccentricity


def optimal_volume_as_printed(chamber: Chamber, eccentricity: float, speed: float, gravity: float) -> float:
    """Optimal volume as published, m^3: far too large [DR18, eq. 18].

    The polar moment of the air's section at the lid is about a point of its rim, not the rotation axis.
    """
    return _disc_volume(chamber, eccentricity, speed, gravity, corrected=False)


def optimal_volume_disc_corrected(
    chamber: Chamber, eccentricity: float, speed: float, gravity: float
) -> float:
    """Optimal volume with the polar moment about the rotation axis [DR18, eq. 18; theory: errata, eq. 1].

    Still an approximation: the air's section at the lid is a lens, taken as a disc of its extent along e.
    """
    return _disc_volume(chamber, eccentricity, speed, gravity, corrected=True)


def dry_volume_as_printed(
    chamber: Chamber, surface_constant: float, eccentricity: float, speed: float, gravity: float
) -> float:
    """Volume of liquid whose surface leaves a part of the wall dry, as published [DR18, eq. 20].

    A square root is missing, a tangent stands for an arctangent, the sector's angle is halved and taken on
    the wet side.
    """
    beta, chord, cosine = _floor_crossing(chamber, surface_constant, eccentricity, speed, gravity)
    R, h, e, c = chamber.radius, chamber.height, eccentricity, surface_constant
    across = c - beta * (R**2 + e**2)
    if across == 0.0:
        raise InputError("surface_constant", c, "other than beta (R^2 + e^2): no printed tangent there")
    sector = 0.5 * R**2 * h * math.acos(cosine)
    kite = h * chord / (4.0 * e * beta**2)
    disc = h * (h + 2.0 * c) / (2.0 * beta) * (math.pi - math.tan(chord / (2.0 * e * beta * across)))
    return math.pi * R**2 * h - (sector - kite + disc)


def dry_volume_frozen_angle(
    chamber: Chamber, surface_constant: float, eccentricity: float, speed: float, gravity: float
) -> float:
    """Volume of liquid that leaves a part of the wall dry, by the repaired formula [DR18, eq. 20].

    The air's section at each height is a lens; its angles are those at the floor [theory: errata, eq. 2].
    """
    beta, chord, cosine = _floor_crossing(chamber, surface_constant, eccentricity, speed, gravity)
    R, h, e, c = chamber.radius, chamber.height, eccentricity, surface_constant
    root = math.sqrt(chord)
    sector = R**2 * h * math.acos(-cosine)
    kite = h * root / (2.0 * beta)
    disc = h * (h + 2.0 * c) / (2.0 * beta) * math.atan2(root, c + beta * (e**2 - R**2))
    return math.pi * R**2 * h - (sector - kite + disc)


def liquid_volume_by_lens(
    chamber: Chamber, surface_constant: float, eccentricity: float, speed: float, gravity: float
) -> float:
    """Volume of liquid under the paraboloid, exact and analytical [theory: statics, eq. 7].

    Chamber minus air: digits are lost as beta R^2/h grows and as the fill shrinks.
    """
    beta = _steepness(chamber, speed, gravity)
    require_not_negative("eccentricity", eccentricity)
    lid, floor = chamber.height + surface_constant, surface_constant
    air = 0.0
    for level, sign in ((lid, 1.0), (floor, -1.0)):
        if level > 0.0:
            lens = lens_moments(math.sqrt(level / beta), chamber.radius, eccentricity)
            air += sign * (level * float(lens.area) - beta * float(lens.polar))
    return chamber.capacity - air


def optimal_volume_by_lens(chamber: Chamber, eccentricity: float, speed: float, gravity: float) -> float:
    """Volume whose surface just touches the near wall at the floor, exact [theory: statics, eq. 8]."""
    beta = _steepness(chamber, speed, gravity)
    dry = dry_radius_as_printed(chamber, eccentricity)
    return liquid_volume_by_lens(chamber, beta * dry**2, eccentricity, speed, gravity)


def liquid_angle_as_printed(lag: float, ratio: float) -> float:
    """Angle from the liquid to the rotor's unbalance as published, rad [DR18, eq. 25; DG21, eq. 4].

    Of delta and k, the rotor's unbalance over the liquid's; right for k = 1 only: the cosine has lost a
    factor 1/k, the right form is in `solvers.rotor.vector_model`.
    """
    require_positive("ratio", ratio)
    if not math.isfinite(lag):
        raise InputError("lag", lag, "a finite number")
    square = math.sin(lag) ** 2
    radicand = (square - 1.0) * (square - ratio**2)
    if radicand < 0.0:
        raise InputError("ratio", ratio, f"|sin(lag)| ({abs(math.sin(lag)):g}) or above")
    cosine = square + math.sqrt(radicand)
    # At k = 1 the cosine is 1 but for rounding.
    if cosine > 1.0 + 1e-15:
        raise InputError("ratio", ratio, "1 or below: the printed arccosine has no real value beyond")
    return math.pi - math.acos(min(cosine, 1.0))


def _disc_volume(
    chamber: Chamber, eccentricity: float, speed: float, gravity: float, *, corrected: bool
) -> float:
    """DR18, eq. 18, with the polar moment of the disc at the lid about its rim or about the rotation axis."""
    beta = _steepness(chamber, speed, gravity)
    near = dry_radius_as_printed(chamber, eccentricity)
    R, h = chamber.radius, chamber.height
    far = math.sqrt(h / beta + near**2)
    s = far + near
    polar = s**4 / 32.0 + s**2 * (far - near) ** 2 / 16.0 if corrected else 3.0 / 32.0 * s**4
    air = (h + beta * near**2) / 4.0 * s**2 - beta * polar - 0.5 * beta * near**4
    return math.pi * (R**2 * h - air)


def _floor_crossing(
    chamber: Chamber, surface_constant: float, eccentricity: float, speed: float, gravity: float
) -> tuple[float, float, float]:
    """Beta, the radicand of eq. 20, the cosine of the crossing's angle seen from the chamber's centre."""
    beta = _steepness(chamber, speed, gravity)
    _require_axis_inside(chamber, eccentricity)
    require_positive("eccentricity", eccentricity)
    R, e, c = chamber.radius, eccentricity, surface_constant
    low, high = beta * (R - e) ** 2, beta * (R + e) ** 2
    if not low <= c <= high:
        allowed = f"{low:g} to {high:g} m, where the waterline on the floor crosses the side wall"
        raise InputError("surface_constant", c, allowed)
    radicand = (c - low) * (high - c)
    cosine = (c - beta * (R**2 + e**2)) / (2.0 * e * R * beta)
    return beta, radicand, max(-1.0, min(1.0, cosine))


def _steepness(chamber: Chamber, speed: float, gravity: float) -> float:
    """Beta = Omega^2/(2 g), where it is a positive finite number."""
    _require_plain(chamber)
    require_positive("speed", speed)
    require_positive("gravity", gravity)
    beta = 0.5 * speed * (speed / gravity)
    if not (math.isfinite(beta) and beta > 0.0):
        raise InputError("speed", speed, "one for which Omega^2/(2 g) is a positive finite number")
    return beta


def _require_plain(chamber: Chamber) -> None:
    if chamber.inner_radius > 0.0:
        raise InputError("inner_radius", chamber.inner_radius, "0: the printed formulas know no inner wall")


def _require_axis_inside(chamber: Chamber, eccentricity: float) -> None:
    require_not_negative("eccentricity", eccentricity)
    if eccentricity >= chamber.radius:
        raise InputError("eccentricity", eccentricity, f"below radius ({chamber.radius:g} m)")
