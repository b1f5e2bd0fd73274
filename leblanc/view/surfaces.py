"""The liquid in a chamber as a closed body with its free surface.

Everything is measured in the plane across the axis by complex numbers, and along the axis from the chamber's
floor. The body is cut by half-planes through a line parallel to the axis, each of which meets the free
surface in one curve; the bodies between neighbouring half-planes are flat-sided.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from leblanc.figures.section import chord
from meshes.arrays import Array, Indices
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.statics.hydrostatics import Equilibrium, equilibrium

RAYS = 240  # half-planes around a turn, besides those where a waterline meets a wall
STEPS = 25  # points from one end of the free surface to the other
DRY = 1e-6  # a film thinner than this over the radius is drawn as a dry wall
_FLATTEST = 1e-12  # steepness that stands for a flat surface


@dataclass(frozen=True)
class LiquidShape:
    """Liquid in n half-planes with k points of the free surface each.

    In a half-plane the liquid lies between the chamber's floor, its outer wall and the free surface, which
    runs from the floor or the inner wall outwards to the outer wall or the lid.

    Parameters
    ----------
    centre : of the half-planes, m from the axis at rest
    angle : of each, rising over less than a turn, rad, shape (n,)
    inner, outer : distances of the walls from the centre, m, shape (n,); an inner wall of no size is 0
    radius, height : of the free surface, distance from the centre and above the floor, m, shape (n, k)
    """

    centre: complex
    angle: Array
    inner: Array
    outer: Array
    radius: Array
    height: Array

    @property
    def surface(self) -> Array:
        """Points of the free surface, m, shape (n, k, 3)."""
        plane = self.centre + self.radius * np.exp(1j * self.angle)[:, None]
        return np.stack([plane.real, plane.imag, self.height], axis=-1)

    @property
    def wet(self) -> NDArray[np.bool_]:
        """Half-planes with liquid at the outer wall, shape (n,)."""
        last = self.radius[:, -1] < self.outer * (1.0 - 1e-9)
        return np.asarray(last | (self.height[:, -1] > 0.0))

    def outline(self) -> Array:
        """Closed outlines of the liquid in the half-planes, m, shape (n, k + 4, 3).

        Floor at the surface's inner end, the surface, its outer end carried to the wall, floor at the wall.
        """
        first, last = self.radius[:, :1], self.outer[:, None]
        flat = np.zeros_like(first)
        radius = np.concatenate([first, self.radius, last, last, first], axis=1)
        height = np.concatenate([flat, self.height, self.height[:, -1:], flat, flat], axis=1)
        plane = self.centre + radius * np.exp(1j * self.angle)[:, None]
        return np.stack([plane.real, plane.imag, height], axis=-1)

    def volume(self) -> float:
        """Volume between the flat sides, m^3."""
        points = self.outline() - np.array([self.centre.real, self.centre.imag, 0.0])
        return _volume(points.reshape(-1, 3), strips(*points.shape[:2]))


def strips(rows: int, columns: int, first: int = 0, last: int | None = None) -> Indices:
    """Quadrilaterals between neighbouring rows of points, the last row next to the first.

    Parameters
    ----------
    rows, columns : of the points, numbered row by row
    first, last : the columns that are joined, all of them if not given

    Returns
    -------
    Numbers of points, shape (m, 4), counter-clockwise seen from outside where rows follow one another
    counter-clockwise and columns go outwards over the top
    """
    end = columns - 1 if last is None else last
    row, column = np.meshgrid(np.arange(rows), np.arange(first, end), indexing="ij")
    here, there = row * columns + column, (row + 1) % rows * columns + column
    return np.stack([here, here + 1, there + 1, there], axis=-1).reshape(-1, 4).astype(np.int64)


def _volume(points: Array, quads: Indices) -> float:
    """Volume inside a closed surface: the sum of the tetrahedra from the origin to its triangles."""
    corners = points[quads]
    total = 0.0
    for second, third in ((1, 2), (2, 3)):
        a, b, c = corners[:, 0], corners[:, second], corners[:, third]
        total += float(np.sum(a * np.cross(b, c))) / 6.0
    return total


def body_at_rest(
    chamber: Chamber, volume: float, deflection: complex, speed: float, gravity: float
) -> LiquidShape:
    """Liquid that turns with a chamber as a whole about the axis at rest [theory: statics, eq. 1].

    Parameters
    ----------
    chamber : where the liquid is
    volume : of the liquid, m^3
    deflection : of the chamber's centre from the axis at rest; that axis lies inside the inner wall, or
        inside the chamber if there is none, m
    speed : spin speed, rad/s
    gravity : along the axis, m/s^2

    Raises
    ------
    InputError : the axis at rest lies where the half-planes would cut a wall twice
    """
    size = abs(deflection)
    inside = chamber.inner_radius or chamber.radius
    if not size < inside:
        raise InputError("deflection", size, f"below {inside:g} m, so that the axis at rest lies inside")
    found = equilibrium(chamber, volume, size, speed, gravity)
    floor, lid = (_waterline(found, level) for level in (0.0, 1.0))
    angle = _angles(chamber, deflection, floor, lid)
    outer = chord(chamber.radius, deflection, angle)
    inner = np.zeros_like(outer)
    if chamber.inner_radius > 0.0:
        inner = chord(chamber.inner_radius, deflection, angle)
    first, last = np.clip(floor, inner, outer), np.clip(lid, inner, outer)
    low = np.where((floor > inner), 0.0, _height(found, inner))
    high = np.where(lid < outer, chamber.height, _height(found, outer))
    # Equal steps of the radius; heights follow its square, as on a paraboloid.
    step = np.linspace(0.0, 1.0, STEPS)
    radius = first[:, None] + (last - first)[:, None] * step
    total = np.maximum(last + first, np.finfo(float).tiny)
    share = step * (radius + first[:, None]) / total[:, None]
    height = low[:, None] + (np.maximum(high, low) - low)[:, None] * share
    return LiquidShape(0j, angle, inner, outer, radius, height)


def _waterline(found: Equilibrium, level: float) -> float:
    """Distance from the axis at rest at which the surface has a height, over the chamber's; 0 if nowhere."""
    chamber = found.chamber
    assert isinstance(chamber, Chamber)
    steep = max(float(found.steepness), _FLATTEST)
    farthest = 1.0 + float(found.eccentricity) / chamber.radius
    squared = farthest**2 - (float(found.wetted_height) - level) / steep
    return chamber.radius * math.sqrt(max(squared, 0.0))


def _height(found: Equilibrium, distance: Array) -> Array:
    """Height of the surface at a distance from the axis at rest, cut by floor and lid, m."""
    chamber = found.chamber
    assert isinstance(chamber, Chamber)
    reach = 1.0 + float(found.eccentricity) / chamber.radius
    fall = (reach - distance / chamber.radius) * (reach + distance / chamber.radius)
    share = float(found.wetted_height) - float(found.steepness) * fall
    return np.asarray(chamber.height * np.clip(share, 0.0, 1.0))


def _angles(chamber: Chamber, deflection: complex, *waterlines: float) -> Array:
    """Angles of the half-planes: evenly around, and where a waterline meets a wall."""
    angles = [np.linspace(-math.pi, math.pi, RAYS, endpoint=False)]
    size, towards = abs(deflection), math.atan2(deflection.imag, deflection.real)
    for wall in (chamber.radius, chamber.inner_radius):
        for line in waterlines:
            if min(size, line, wall) > 0.0 and abs(wall - size) < line < wall + size:
                apart = math.acos(np.clip((line**2 + size**2 - wall**2) / (2.0 * line * size), -1.0, 1.0))
                both = np.array([towards + apart, towards - apart])
                angles.append(np.remainder(both + math.pi, 2.0 * math.pi) - math.pi)
    found: Array = np.unique(np.concatenate(angles))
    return found


def body_of_layer(chamber: Chamber, deflection: complex, angle: Array, depth: Array) -> LiquidShape:
    """Liquid of a layer as deep at the lid as at the floor.

    Parameters
    ----------
    chamber : where the liquid is
    deflection : of the chamber's centre from the axis at rest, m
    angle : around the chamber's centre, in any order, rad, shape (n,)
    depth : of the layer there, m, shape (n,)
    """
    turned = np.remainder(angle + math.pi, 2.0 * math.pi) - math.pi
    order = np.argsort(turned)
    free = np.clip(chamber.radius - depth[order], chamber.inner_radius, chamber.radius)
    outer = np.full(free.shape, chamber.radius)
    inner = np.full(free.shape, chamber.inner_radius)
    return _upright(deflection, turned[order], inner, outer, free, chamber.height)


def _upright(
    centre: complex, angle: Array, inner: Array, outer: Array, free: Array, height: float
) -> LiquidShape:
    """Liquid whose surface stands upright from floor to lid; where it meets the wall there is none."""
    dry = free >= outer * (1.0 - DRY)
    rows = np.where(dry[:, None], 0.0, np.array([[0.0, height]]))
    return LiquidShape(centre, angle, inner, outer, np.repeat(free[:, None], 2, axis=1), rows)


def body_of_pool(chamber: Chamber, volume: float, deflection: complex, down: float) -> LiquidShape:
    """Liquid that lies at the bottom of a chamber whose axis is horizontal; an inner wall is left out.

    Parameters
    ----------
    chamber, deflection : as in `body_of_layer`
    volume : of the liquid, m^3
    down : direction of gravity, rad
    """
    level = chamber.radius * math.cos(_half_angle(volume / (chamber.height * chamber.radius**2)))
    # The rays start in the air, half way between its top and the level.
    start = 0.5 * (level - chamber.radius)
    angle = np.linspace(-math.pi, math.pi, 3 * RAYS, endpoint=False)
    centre = complex(-start * math.cos(down), -start * math.sin(down))
    outer = chord(chamber.radius, centre, angle)
    along = np.cos(angle - down)
    free = np.divide(level - start, along, out=np.full(angle.shape, math.inf), where=along > 0.0)
    free = np.minimum(free, outer)
    return _upright(deflection - centre, angle, np.zeros_like(outer), outer, free, chamber.height)


def _half_angle(share: float) -> float:
    """Half the angle of a circular segment of area R^2 (a - sin a cos a), given over R^2, rad."""
    low, high = 0.0, math.pi
    for _ in range(60):
        half = 0.5 * (low + high)
        low, high = (low, half) if half - math.sin(half) * math.cos(half) > share else (half, high)
    return 0.5 * (low + high)
