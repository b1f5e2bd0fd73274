"""The liquid at rest in any section: what lies outside the circle of the free surface."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq
from scipy.spatial import cKDTree

from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from meshes.liquid_section import LiquidSection, liquid_section
from meshes.refine.bisection import edge_numbers, quadratic_triangles
from meshes.refine.circle_cut import Circle, cut_along
from meshes.refine.waterline import beyond, distance_range, monotone_arcs
from meshes.section import Section, section_area

# Longest edge at the circle, over its radius.
_COARSEST = 0.25


def area_outside(section: Section, radius: float, axis: tuple[float, float] = (0.0, 0.0)) -> float:
    """Area of the part of a section outside a circle.

    Parameters
    ----------
    section : the section
    radius : of the circle, m
    axis : its centre, m

    Returns
    -------
    The area, m^2, exact on the mesh to about 1e-9.

    Raises
    ------
    InputError : a radius that is negative or not finite
    """
    if not (math.isfinite(radius) and radius >= 0.0):
        raise InputError("radius", radius, "a finite number, 0 or above")
    arcs = monotone_arcs(section, axis)
    least, largest = distance_range(arcs, len(section.triangles))
    square = radius * radius
    if square <= least.min():
        return section_area(section)
    # Whole triangles are added as they are; only those that the circle crosses are integrated.
    crossed = (least < square) & (square < largest)
    whole = Section(section.points, section.triangles[least >= square]) if np.any(least >= square) else None
    total = section_area(whole) if whole else 0.0
    if crossed.any():
        cut = arcs.take(crossed[arcs.triangle])
        of = cut.triangle
        total += float(beyond(cut, least[of], largest[of], square, square * (1.0 + 1e-12))[2].sum())
    return total


def surface_radius_of(section: Section, liquid_area: float) -> float:
    """Radius of the free surface that leaves a given area of liquid, its volume over the chamber's height.

    Parameters
    ----------
    section : the section of the chamber; its geometric axis is the origin
    liquid_area : m^2

    Returns
    -------
    a, m: `area_outside` of it is the area to the accuracy of that function.

    Raises
    ------
    InputError : an area that is not positive, or as large as the section leaves no surface
    """
    require_positive("liquid_area", liquid_area)
    whole = section_area(section)
    if liquid_area >= whole:
        raise InputError("liquid_area", liquid_area, f"below the area of the section ({whole:.9g} m^2)")
    farthest = math.sqrt(
        float(distance_range(monotone_arcs(section, (0.0, 0.0)), len(section.triangles))[1].max())
    )

    def excess(depth: float) -> float:
        return area_outside(section, farthest - depth) - liquid_area

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
    """Liquid of a section outside the circle r = a, with walls of any shape.

    The section is refined by bisection where asked for, and near the circle at least to a quarter of its
    radius. Nodes near the circle are moved onto it, crossed triangles are split, and the sides on it become
    quadratic arcs. Walls keep their shape.

    Parameters
    ----------
    section : the section of the chamber; its geometric axis is the origin
    surface_radius : radius a of the free surface, m
    order : 1 for straight sides, 2 for quadratic ones; that of the section if not given
    surface_size, wall_size : longest sides at the circle and at walls, m
    growth : size of a cell over that of its neighbour nearer to where it is small, above 1, 3 at most

    Returns
    -------
    The mesh.

    Raises
    ------
    InputError : a value out of its range, no liquid outside the circle, a circle that does not cross or lie
        in the section, a wall that hardly touches it, above a million nodes
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
