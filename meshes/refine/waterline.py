"""Waterlines in a mesh: integrals over triangles that they cross, and the liquid that lies outside of them.

Over a triangle that a waterline crosses, the depth of the liquid has a kink, and a quadrature rule made for
smooth functions loses its order. Such a triangle is integrated along rays from the axis instead. For any
function q and any part of the plane with boundary r(theta), taken around it,

    integral of q over the part = oint dtheta int_{r_0}^{r(theta)} q rho drho,

if q vanishes inside r_0, or if the axis is outside the part. Along an edge the kinks are single points.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from meshes.arrays import Array, Indices
from meshes.errors import InputError, require_positive
from meshes.liquid_section import LiquidSection, liquid_section
from meshes.quality import edge_polynomials, triangle_areas
from meshes.refine.bisection import edge_numbers, quadratic_triangles
from meshes.refine.circle_cut import Circle, cut_along
from meshes.section import Section, section_area

# Points along an edge and along a ray. Rays meet polynomials of degree 7 at most, which 4 points integrate
# exactly; along an edge the integrand has its nearest pole at the axis, see `beyond`.
_EDGE = np.polynomial.legendre.leggauss(8)
_RAY = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, eq=False)
class Arcs:
    """Pieces of the triangles' edges along which the distance from the axis grows from end to end."""

    triangle: Indices  #: number of the triangle that each arc bounds, shape (A,)
    #: coefficients of x(t) = c0 + c1 t + c2 t^2 from the axis, shape (3, 2, A), m; t grows counter-clockwise
    #: around the triangle
    curve: Array
    near: Array  #: t at the two ends, shape (A,)
    far: Array
    near_square: Array  #: squared distance of the ends from the axis, shape (A,), m^2
    far_square: Array

    def take(self, which: NDArray[np.bool_] | Indices) -> Arcs:
        """Some of the arcs."""
        return Arcs(
            self.triangle[which],
            self.curve[:, :, which],
            self.near[which],
            self.far[which],
            self.near_square[which],
            self.far_square[which],
        )


def monotone_arcs(section: Section, axis: tuple[float, float]) -> Arcs:
    """Cut triangles' edges where their distance from the axis is least or largest: 12 arcs to one at most."""
    coefficients = edge_polynomials(section.points[section.triangles] - np.array(axis))
    curve = np.array([c.reshape(-1, 2).T for c in coefficients])
    triangle = np.repeat(np.arange(len(section.triangles)), 3)
    stops = np.zeros((5, curve.shape[2]))
    stops[-1] = 1.0
    c0, c1, c2 = curve
    bent = np.any(c2 != 0.0, axis=0)
    foot = -np.sum(c0 * c1, axis=0) / np.sum(c1 * c1, axis=0)
    stops[1:4] = np.clip(foot, 0.0, 1.0)
    stops[1:4, bent] = _extremes(curve[:, :, bent])
    start, end = stops[:-1].ravel(), stops[1:].ravel()
    arcs, triangle = np.tile(curve, 4), np.tile(triangle, 4)
    keep = np.flatnonzero(end > start)
    start, end, arcs = start[keep], end[keep], arcs[:, :, keep]
    first, last = _square(arcs, start), _square(arcs, end)
    outwards = last >= first
    return Arcs(
        triangle[keep],
        arcs,
        np.where(outwards, start, end),
        np.where(outwards, end, start),
        np.minimum(first, last),
        np.maximum(first, last),
    )


def distance_range(arcs: Arcs, triangles: int) -> tuple[Array, Array]:
    """Least and largest squared distance from the axis over each triangle.

    Shape (M,), m^2; the least is zero in the triangle that holds the axis.
    """
    least, largest = np.full(triangles, np.inf), np.zeros(triangles)
    np.minimum.at(least, arcs.triangle, arcs.near_square)
    np.maximum.at(largest, arcs.triangle, arcs.far_square)
    xa, ya = _position(arcs.curve, np.minimum(arcs.near, arcs.far))
    xb, yb = _position(arcs.curve, np.maximum(arcs.near, arcs.far))
    turn = np.bincount(arcs.triangle, np.arctan2(xa * yb - ya * xb, xa * xb + ya * yb), triangles)
    least[np.abs(turn) > np.pi] = 0.0  # 2 pi around the axis, 0 elsewhere
    return least, largest


def beyond(arcs: Arcs, least: Array, largest: Array, floor: float, lid: float) -> tuple[Array, Array, Array]:
    """Quadrature rule for the parts of triangles outside the floor's waterline: x, y from the axis, weights.

    `floor` and `lid` are squared radii of the waterlines, m^2, the first below zero if the liquid covers the
    axis; weights (m^2) have either sign. Exact to rounding for what is polynomial up to the lid's waterline
    and another polynomial beyond, to about 1e-8 of itself next to the axis, where edges are cut where the
    distance doubles.
    """
    pole = floor if floor > 0.0 else lid
    distant = least > 0.25 * largest
    close = np.max(largest, where=~distant, initial=0.0)
    doublings = [pole * 4.0**j for j in range(1, 13) if pole * 4.0**j < close]
    marks = [_crossing(arcs, level) for level in sorted([floor, lid, *doublings])] + [arcs.far]
    starts, stops = np.array(marks[:-1]), np.array(marks[1:])
    _, which = pieces = np.nonzero(starts != stops)
    start, stop = starts[pieces][:, None], stops[pieces][:, None]
    half = 0.5 * (stop - start)
    curve = arcs.curve[:, :, which, None]
    t = start + half * (1.0 + _EDGE[0])
    x, y = _position(curve, t)
    dx, dy = curve[1] + 2.0 * t * curve[2]
    turn = np.abs(half) * _EDGE[1] * (x * dy - y * dx)
    square = np.maximum(x * x + y * y, 1e-300)
    # The rays start at the floor's waterline, or at the near side of a triangle all outside of it.
    origin = np.maximum(floor, np.where(distant, least, 0.0))[which, None]
    inner = np.sqrt(np.minimum(origin, square) / square)
    kink = np.maximum(inner, np.sqrt(np.minimum(lid, square) / square))
    rules = [_along_rays(x, y, turn, inner, kink), _along_rays(x, y, turn, kink, np.ones_like(kink))]
    px, py, weight = np.concatenate(rules, axis=1)
    return px, py, weight


def _along_rays(x: Array, y: Array, turn: Array, start: Array, stop: Array) -> Array:
    """Points and weights on the rays to (x, y), between two fractions of their length."""
    used = stop > start
    x, y, turn, start, half = x[used], y[used], turn[used], start[used], 0.5 * (stop - start)[used]
    fraction = start[:, None] + half[:, None] * (1.0 + _RAY[0])
    weight = (turn * half)[:, None] * _RAY[1] * fraction
    return np.stack([(fraction * x[:, None]).ravel(), (fraction * y[:, None]).ravel(), weight.ravel()])


def _position(curve: Array, t: Array) -> tuple[Array, Array]:
    """Point of each curve at its t."""
    x, y = curve[0] + t * (curve[1] + t * curve[2])
    return x, y


def _square(curve: Array, t: Array) -> Array:
    """Squared distance from the axis at t."""
    x, y = _position(curve, t)
    return np.asarray(x * x + y * y)


def _crossing(arcs: Arcs, level: float) -> Array:
    """Where each arc crosses the circle of squared radius `level`, else its end on that side, shape (A,)."""
    t = np.where(level >= arcs.far_square, arcs.far, arcs.near)
    crossed = np.flatnonzero((arcs.near_square < level) & (level < arcs.far_square))
    curve = arcs.curve[:, :, crossed]
    low, high = arcs.near[crossed], arcs.far[crossed]
    at = 0.5 * (low + high)
    for _ in range(54):  # by Newton's method, or one bit of t at a time where that leaves the bracket
        x, y = _position(curve, at)
        dx, dy = curve[1] + 2.0 * at * curve[2]
        excess, slope = x * x + y * y - level, 2.0 * (x * dx + y * dy)
        inside = excess < 0.0
        low, high = np.where(inside, at, low), np.where(inside, high, at)
        newton = at - np.divide(excess, slope, out=np.full_like(at, math.inf), where=slope != 0.0)
        fits = (newton >= np.minimum(low, high)) & (newton <= np.maximum(low, high))
        before, at = at, np.where(fits, newton, 0.5 * (low + high))
        # The error of a step of Newton's is of the order of its square.
        if np.all(np.where(fits, np.abs(at - before) < 1e-9, np.abs(high - low) < 1e-15)):
            break
    t[crossed] = at
    return t


def _extremes(curve: Array) -> Array:
    """Stationary points of the distance along quadratic curves, in order, shape (3, A).

    The slope of half the squared distance is a cubic, monotone between its own stationary points; where it
    has no zero, some point of that interval is returned.
    """
    c0, c1, c2 = curve
    d3, d2 = 2.0 * np.sum(c2 * c2, axis=0), 3.0 * np.sum(c1 * c2, axis=0)
    d1, d0 = np.sum(c1 * c1 + 2.0 * c0 * c2, axis=0), np.sum(c0 * c1, axis=0)
    root = np.sqrt(np.maximum(d2 * d2 - 3.0 * d3 * d1, 0.0))
    turns = np.clip([(-d2 - root) / (3.0 * d3), (-d2 + root) / (3.0 * d3)], 0.0, 1.0)
    low = np.concatenate([np.zeros((1, len(d0))), turns])
    high = np.concatenate([turns, np.ones((1, len(d0)))])

    def slope(t: Array) -> Array:
        return np.asarray(d0 + t * (d1 + t * (d2 + t * d3)))

    rising = slope(high) > slope(low)
    for _ in range(54):
        middle = 0.5 * (low + high)
        before = (slope(middle) < 0.0) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.asarray(0.5 * (low + high))


# Longest edge at the circle, over its radius.
_COARSEST = 0.25


def area_outside(section: Section, radius: float, axis: tuple[float, float] = (0.0, 0.0)) -> float:
    """Area of the part of a section outside a circle, m^2, exact on the mesh to about 1e-9."""
    if not (math.isfinite(radius) and radius >= 0.0):
        raise InputError("radius", radius, "a finite number, 0 or above")
    return _Split.of(section, axis).outside(radius)


@dataclass(frozen=True)
class _Split:
    """A section as circles about one axis cut it."""

    areas: Array  #: of its triangles, m^2, shape (M,)
    arcs: Arcs
    least: Array  #: and largest: squared distance of each triangle from the axis, shape (M,)
    largest: Array

    @classmethod
    def of(cls, section: Section, axis: tuple[float, float]) -> _Split:
        """Of a section about an axis."""
        arcs = monotone_arcs(section, axis)
        areas = triangle_areas(section.points, section.triangles)
        return cls(areas, arcs, *distance_range(arcs, len(section.triangles)))

    def outside(self, radius: float) -> float:
        """Area beyond the circle, m^2: whole triangles as they are, those that it crosses integrated."""
        square = radius * radius
        crossed = (self.least < square) & (square < self.largest)
        total = float(self.areas[self.least >= square].sum())
        if crossed.any():
            cut = self.arcs.take(crossed[self.arcs.triangle])
            far = self.least[cut.triangle], self.largest[cut.triangle]
            total += float(beyond(cut, *far, square, square * (1.0 + 1e-12))[2].sum())
        return total


def surface_radius_of(section: Section, liquid_area: float) -> float:
    """Radius of the free surface that leaves an area of liquid, volume over height, m; as `area_outside`."""
    require_positive("liquid_area", liquid_area)
    whole = section_area(section)
    if liquid_area >= whole:
        raise InputError("liquid_area", liquid_area, f"below the area of the section ({whole:.9g} m^2)")
    split = _Split.of(section, (0.0, 0.0))
    farthest = math.sqrt(float(split.largest.max()))

    def excess(depth: float) -> float:
        return split.outside(farthest - depth) - liquid_area

    # By the depth, so that a thin layer keeps its digits.
    depth = brentq(excess, 0.0, farthest, xtol=1e-15 * farthest, rtol=1e-14)
    return float(farthest - depth)


def liquid_outside(
    section: Section,
    surface_radius: float,
    *,
    order: int | None = None,
    surface_size: float = math.inf,
    wall_size: float = math.inf,
    growth: float = 1.5,
) -> LiquidSection:
    """Liquid of a section outside the circle r = a, with walls of any shape, which keep it.

    The section is bisected where sizes (m) are given, and near the circle at least to a quarter of its
    radius. Nodes near the circle are moved onto it, crossed triangles split; sides on it become quadratic
    arcs. An `InputError` where the circle does not cross or lie in the section, or a wall hardly touches it.
    """
    require_positive("surface_radius", surface_radius)
    for name, value in (("surface_size", surface_size), ("wall_size", wall_size)):
        if not value > 0.0:
            raise InputError(name, value, "above 0")
    if not 1.0 < growth <= 3.0:
        raise InputError("growth", growth, "above 1, 3 at most")
    if order not in (None, 1, 2):
        raise InputError("order", order, "1 (straight sides) or 2 (quadratic sides)")
    circle = Circle(0.0, 0.0, surface_radius)
    at_circle = min(surface_size, _COARSEST * surface_radius)
    size = _sizes(section, circle, at_circle, wall_size, 0.5 * (growth - 1.0))
    points, triangles = cut_along(section, size, lambda *_: [circle], outside=True)
    if not len(triangles):
        raise InputError("surface_radius", surface_radius, "a radius that leaves liquid in the section")
    used, inverse = np.unique(triangles[:, : 3 * (order or section.order)], return_inverse=True)
    return liquid_section(points[used], inverse.reshape(len(triangles), -1), surface_radius)


def _sizes(
    section: Section, circle: Circle, at_circle: float, at_wall: float, slope: float
) -> Callable[[Array], Array]:
    """Longest edges, growing from the circle and from the walls."""
    points, triangles = quadratic_triangles(section)
    number, edges = edge_numbers(triangles)
    wall = edges[np.bincount(number.ravel(), minlength=len(edges)) == 1]
    near = cKDTree(points[np.unique(wall)]) if math.isfinite(at_wall) else None

    def size(at: Array) -> Array:
        longest = at_circle + slope * np.abs(circle.beyond(at))
        if near is not None:
            longest = np.minimum(longest, at_wall + slope * near.query(at)[0])
        return np.asarray(longest)

    return size
