"""Free surface of a liquid that rotates as a whole off the chamber's centre, and moments of the lens.

Surface z = beta r^2 + C, r from the rotation axis, z from the chamber floor [theory: statics, eq. 1]. The
lens is what a disc about the rotation axis shares with the chamber; closed forms from the two circular
segments on either side of the common chord [theory: statics, eq. 4-6].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_positive

# Steepness beta R^2/h that stands for "no gravity along the axis": the surface is then a cylinder to far
# below rounding, and every intermediate product still fits a double.
CYLINDER_STEEPNESS = 1e30


def steepness(speed: ArrayLike, gravity: ArrayLike, radius: ArrayLike, height: ArrayLike) -> Array:
    """Rise of the free surface over the chamber's radius, in chamber heights [theory: statics, eq. 2].

    B = beta R^2/h with beta = Omega^2/(2 g), from 0 (flat; also without speed and gravity) to
    `CYLINDER_STEEPNESS`.
    """
    spin, g, wall, h = (np.asarray(x, dtype=float) for x in (speed, gravity, radius, height))
    rise = np.square(spin * wall)
    fall = 2.0 * g * h
    capped = rise >= CYLINDER_STEEPNESS * fall
    ratio = np.divide(rise, fall, out=np.full(capped.shape, CYLINDER_STEEPNESS), where=~capped)
    return np.where(rise == 0.0, 0.0, ratio)


@dataclass(frozen=True)
class Moments:
    """Integrals over a liquid body, divided by the density.

    The origin lies on the rotation axis at the chamber floor; x points along the deflection, z along the
    axis. A body that is symmetric about the plane of the deflection has y = xy = yz = 0.
    """

    volume: Array  #: integral of 1, m^3, shape (...,)
    x: Array  #: first moments, m^4; x is the unbalance of the liquid over its density
    y: Array
    z: Array
    xx: Array  #: second moments, m^5
    yy: Array
    zz: Array
    xy: Array
    xz: Array
    yz: Array

    @property
    def polar_inertia(self) -> Array:
        """Moment of inertia about the rotation axis over the density, m^5."""
        return self.xx + self.yy


@dataclass(frozen=True)
class Lens:
    """Integrals over the lens about the rotation axis, x along the deflection, r the distance to the axis."""

    area: Array  #: A, integral of 1, m^2, shape (...,)
    x: Array  #: S, integral of x, m^3, shape (...,)
    polar: Array  #: J, integral of r^2, m^4, shape (...,)
    x_polar: Array  #: T, integral of x r^2, m^5, shape (...,)


def lens_moments(disc_radius: ArrayLike, radius: float, eccentricity: ArrayLike) -> Lens:
    """Moments A, S, J and T of a disc about the rotation axis cut by the chamber's disc at a distance e.

    Holds whether the circles cross, one lies in the other, or they are apart [theory: statics, eq. 5-6].
    Rounding is a few units in the last place of (r + R + e)^n, n the dimension: slivers have fewer digits.
    """
    require_positive("radius", radius)
    r, e = np.broadcast_arrays(np.asarray(disc_radius, dtype=float), np.asarray(eccentricity, dtype=float))
    if not np.all(r >= 0.0):
        raise InputError("disc_radius", disc_radius, "0 or above")
    if not np.all(np.isfinite(e) & (e >= 0.0)):
        raise InputError("eccentricity", eccentricity, "finite, 0 or above")

    # A disc that holds the chamber, or is out of its reach, has the lens of the disc that just touches it.
    nearest = np.abs(radius - e)
    nested = (e < radius) & (r < nearest)
    crossing = np.clip(r, nearest, radius + e)
    alpha, theta = _half_angles(crossing, radius, e)
    # Said apart, since concentric circles touch at every angle.
    held = r >= radius + e
    alpha, theta = np.where(held, 0.0, alpha), np.where(held, np.pi, theta)
    sin, cos = np.sin(theta), np.cos(theta)

    # Over the chamber's segment, about the chamber's centre: area, first moment across the chord, second
    # moment across the chord, polar moment.
    area = radius**2 * (theta - sin * cos)
    first = (2.0 / 3.0) * (radius * sin) ** 3
    across = radius**4 * (0.25 * (theta - sin * cos) + 0.5 * sin**3 * cos)
    polar = radius**4 * (0.5 * (theta - sin * cos) + sin**3 * cos / 3.0)
    # The same segment's polar moment about the rotation axis.
    segment_polar = e * e * area - 2.0 * e * first + polar

    disc_area, disc_polar = _own_segment(crossing, alpha)
    whole = np.where(nested, r, 0.0)
    return Lens(
        area=np.where(nested, np.pi * whole**2, disc_area + area),
        # The first moments of the two segments across their common chord cancel exactly.
        x=np.where(nested, 0.0, e * area),
        polar=np.where(nested, 0.5 * np.pi * whole**4, disc_polar + segment_polar),
        x_polar=np.where(nested, 0.0, e * (segment_polar + 2.0 * (across - radius * cos * first))),
    )


def _half_angles(r: Array, radius: float, e: Array) -> tuple[Array, Array]:
    """Half the chord's angle from the rotation axis and the chamber's centre, by no difference of squares."""
    total = r + radius + e
    # The clip takes back what rounding puts beyond tangency.
    short_e = np.maximum(np.where(e > radius, r - (e - radius), (r - e) + radius), 0.0)
    short_chamber = np.maximum(np.where(e < radius, r - (radius - e), (r - radius) + e), 0.0)
    short_r = np.maximum((radius + e) - r, 0.0)
    alpha = 2.0 * np.arctan2(np.sqrt(short_e * short_r), np.sqrt(total * short_chamber))
    theta = 2.0 * np.arctan2(np.sqrt(short_e * short_chamber), np.sqrt(total * short_r))
    return alpha, theta


def _own_segment(r: Array, alpha: Array) -> tuple[Array, Array]:
    """Area and polar moment of the disc's segment beyond the chord, about the disc's centre."""
    sin, cos = np.sin(alpha), np.cos(alpha)
    area = alpha - sin * cos
    return r**2 * area, r**4 * (0.5 * area + sin**3 * cos / 3.0)
