"""Stability of a spinning top's upright rotation with a partly filled chamber on its axis.

The body turns about a fixed point on its vertical axis; heights are measured upward from that point. A tilt
leaves the energy stationary; the rotation is stable where its second variation is positive.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.chamber import Chamber
from meshes.errors import InputError, require_positive

# The integrand is a polynomial of third degree in r^2, for which two Gauss points are exact; it is positive,
# so that nothing cancels.
_NODES = 0.5 + np.array([-1.0, 1.0]) / np.sqrt(12.0)
# Moments of the liquid are polynomials of at most third degree in r^2 on each piece: two points do as well.
_TWO = np.array([-1.0, 1.0]) / np.sqrt(3.0)


class FrozenLiquid(NamedTuple):
    """Moments of a liquid that turns with its chamber as one body; shapes (...,)."""

    polar: Array  #: about the axis, kg m^2
    transverse: Array  #: about a line across the axis through the fixed point, kg m^2
    static: Array  #: first moment of the heights above the fixed point, kg m


def frozen_liquid(
    chamber: Chamber,
    floor: float,
    surface_constant: ArrayLike,
    speed: ArrayLike,
    gravity: float,
    density: float,
) -> FrozenLiquid:
    """Moments of the liquid below its paraboloid, as if it were frozen [theory: statics, eq. 20].

    Its share in C_0, A_0 and M x_c3 of the whole; arguments as of `free_surface_term`.
    """
    constant, beta = _surface(floor, surface_constant, speed, gravity, density)
    inner, outer = _waterlines(chamber, constant, beta)
    # In s = r^2 the liquid is cut where its surface leaves the floor and where it meets the lid.
    low = np.full(constant.shape, chamber.inner_radius**2)
    marks = [low, inner, outer, np.full(constant.shape, chamber.radius**2)]
    polar, transverse, static = np.zeros((3, *constant.shape))
    for start, stop in itertools.pairwise(marks):
        half = 0.5 * (stop - start)[..., None]
        s = start[..., None] + half * (1.0 + _TWO)
        top = np.clip(constant[..., None] + beta[..., None] * s, 0.0, chamber.height)
        high = floor + top
        ring = np.pi * density * half
        cubed = (high**3 - floor**3) / 3.0
        polar = polar + np.sum(ring * s * top, axis=-1)
        transverse = transverse + np.sum(ring * (0.5 * s * top + cubed), axis=-1)
        static = static + np.sum(ring * 0.5 * top * (high + floor), axis=-1)
    return FrozenLiquid(polar, transverse, static)


def free_surface_term(
    chamber: Chamber,
    floor: float,
    surface_constant: ArrayLike,
    speed: ArrayLike,
    gravity: float,
    density: float,
) -> Array:
    """What the freedom of the surface takes from the stability of the upright rotation, a, N m.

    a = rho g int int (1 + Omega^2 z/g)^2 r^3 cos(phi)^2 dr dphi over the plan of the free surface, z its
    height above the fixed point
    [DR18, eq. 22, whose integral over the angle lacks cos(phi)^2; theory: statics, eq. 19]; 0 without one.
    `floor` counts from the fixed point, C from the floor.
    """
    constant, beta = _surface(floor, surface_constant, speed, gravity, density)
    inner, outer = _waterlines(chamber, constant, beta)
    width = (outer - inner)[..., None]
    s = inner[..., None] + width * _NODES
    height = floor + constant[..., None] + beta[..., None] * s
    stiffening = 1.0 + 2.0 * beta[..., None] * height
    # int r^3 dr = int s/2 ds with s = r^2; the angle contributes pi; each Gauss point weighs 1/2.
    integral = np.sum(np.square(stiffening) * s * width, axis=-1) / 4.0
    return np.asarray(density * gravity * np.pi * integral)


def cylinder_terms(
    chamber: Chamber, floor: float, volume: ArrayLike, speed: ArrayLike, density: float
) -> tuple[FrozenLiquid, Array]:
    """Frozen moments and surface term without gravity [theory: statics, eq. 20 and below eq. 21].

    The surface is a cylinder; a = rho pi Omega^2 a_s^2 int z^2 dz over the height, the limit of (19).
    """
    require_positive("density", density)
    amount, omega = np.broadcast_arrays(np.asarray(volume, dtype=float), np.asarray(speed, dtype=float))
    for field, value in (("floor", floor), ("speed", omega)):
        if not np.all(np.isfinite(value)):
            raise InputError(field, value, "finite")
    if not np.all((amount >= 0.0) & (amount <= chamber.capacity)):
        raise InputError("volume", volume, f"from 0 to the capacity, {chamber.capacity:g} m^3")
    low, high = chamber.inner_radius**2, chamber.radius**2
    ring = amount / (np.pi * chamber.height)  # R^2 - a_s^2
    # A full chamber has no free surface, an empty one no liquid to move.
    free = (amount > 0.0) & (amount < chamber.capacity)
    inner = np.maximum(high - ring, low)
    squared = np.pi * density * ((floor + chamber.height) ** 3 - floor**3) / 3.0  # rho pi int z^2 dz
    polar = 0.5 * density * amount * (high + inner)
    static = density * amount * (floor + 0.5 * chamber.height)
    taken = np.where(free, squared * np.square(omega) * inner, 0.0)
    return FrozenLiquid(polar, 0.5 * polar + squared * ring, static), taken


def _surface(
    floor: float, surface_constant: ArrayLike, speed: ArrayLike, gravity: float, density: float
) -> tuple[Array, Array]:
    """C and beta of the surface z = beta r^2 + C, checked, of one shape."""
    require_positive("gravity", gravity)
    require_positive("density", density)
    constant, omega = np.broadcast_arrays(
        np.asarray(surface_constant, dtype=float), np.asarray(speed, dtype=float)
    )
    for field, value in (("floor", floor), ("surface_constant", constant), ("speed", omega)):
        if not np.all(np.isfinite(value)):
            raise InputError(field, value, "finite")
    return constant, np.asarray(np.square(omega) / (2.0 * gravity))


def _waterlines(chamber: Chamber, constant: Array, beta: Array) -> tuple[Array, Array]:
    """Squared radii between which the surface lies inside the chamber; equal where it does nowhere."""
    low, high = chamber.inner_radius**2, chamber.radius**2
    found = []
    for level in (0.0, chamber.height):
        rise = level - constant
        # Where even the rim stays below the level, the surface never reaches it.
        reached = rise < beta * high
        squared = np.where(reached, 0.0, high)
        np.divide(rise, beta, out=squared, where=reached & (rise > 0.0))
        found.append(np.clip(squared, low, high))
    return found[0], found[1]
