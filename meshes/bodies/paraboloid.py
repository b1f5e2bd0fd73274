"""The body of liquid under a paraboloid: a chamber of any section that turns about any axis along it."""

from __future__ import annotations

import math

import numpy as np

from meshes.arrays import Array, Indices
from meshes.bodies.body import Body, columns
from meshes.errors import InputError, require_not_negative, require_positive
from meshes.refine.bisection import edge_numbers
from meshes.refine.circle_cut import Circle, cut_along
from meshes.section import Section

# Longest edge at a waterline, over its radius; waterlines smaller than this part of the section are left out.
_COARSEST, _SMALLEST = 0.25, 1e-3

# Nodes whose squared distance from the axis is that of a waterline to this fraction are on it.
_ON_LINE = 1e-10


def paraboloid_body(
    section: Section,
    height: float,
    beta: float,
    surface_constant: float = 0.0,
    *,
    dry_radius: float = 0.0,
    axis: tuple[float, float] = (0.0, 0.0),
    size: float = math.inf,
    layers: int = 2,
    order: int = 2,
) -> Body:
    """Liquid between floor, lid, walls and the surface z = beta r^2 + C, r from the rotation axis.

    In coordinates of the chamber, from its geometric axis and its floor; the rotation axis crosses the
    section at `axis`, (-e, 0) for a deflection e. Without gravity (beta infinite) the surface meets the floor
    at `dry_radius`. Where waterlines at floor and lid are closer together than the bend of their edges, the
    surface between them stands upright at the radius that keeps the volume; dry spots much smaller than the
    section are left out.
    """
    _check(height, beta, surface_constant, dry_radius, axis, size, layers, order)
    extent = float(np.ptp(section.points, axis=0).max())
    floor, ramp = _squares(height, beta, surface_constant, dry_radius)
    radii = [math.sqrt(level) for level in (floor + ramp, floor) if 0.0 < level < math.inf]
    waterlines = [Circle(*axis, radius) for radius in radii if radius > _SMALLEST * extent]

    def longest(at: Array) -> Array:
        found = np.full(len(at), size)
        if 0.0 >= floor > -math.inf:
            # Over the floor's shallowest place the depth bends within the square root of depth over beta.
            square = np.sum((at - np.array(axis)) ** 2, axis=1) - floor
            found = np.minimum(found, 0.5 * np.sqrt(np.maximum(square, (_SMALLEST * extent) ** 2)))
        for circle in waterlines:
            found = np.minimum(found, _COARSEST * circle.radius + 0.25 * np.abs(circle.beyond(at)))
        return found

    upright: list[Circle] = []

    def followed(points: Array, triangles: Indices) -> list[Circle]:
        upright[:] = _upright_circle(points, triangles, axis, floor, ramp)
        return upright or waterlines

    dry = floor > (_SMALLEST * extent) ** 2
    points, triangles = cut_along(section, longest, followed, outside=dry)
    if not len(triangles):
        raise InputError("surface_constant", surface_constant, "a surface that leaves liquid in the chamber")
    square = np.sum((points - np.array(axis)) ** 2, axis=1)
    if upright:
        floor, ramp = upright[0].radius ** 2, 0.0
    lid_line = np.zeros(len(points), dtype=bool)
    if math.isfinite(ramp):
        lid_line = np.abs(square - (floor + ramp)) <= _ON_LINE * abs(floor + ramp)
    share = _depth_share(square, floor, ramp, surface_constant / height)
    if not share[triangles].any():
        raise InputError("surface_constant", surface_constant, "a surface that leaves liquid in the chamber")
    side = lid_line if upright else np.zeros(len(points), dtype=bool)
    open_top = ~side & ((share < 1.0) | lid_line)
    return columns(points, triangles, height * share, height, open_top, side, layers=layers, order=order)


def _squares(height: float, beta: float, constant: float, dry_radius: float) -> tuple[float, float]:
    """Squared radius of the floor's waterline, below zero if there is none, and the way to the lid's, m^2."""
    if math.isinf(beta):
        return dry_radius**2, 0.0
    return (-constant / beta, height / beta) if beta > 0.0 else (-math.inf, math.inf)


def _depth_share(square: Array, floor: float, ramp: float, flat: float) -> Array:
    """Depth of the liquid over the chamber's height; `flat` if the surface is level."""
    if math.isinf(ramp):
        return np.full(len(square), min(max(flat, 0.0), 1.0))
    if ramp == 0.0:
        return np.ones(len(square))
    share = np.clip((square - floor) / ramp, 0.0, 1.0)
    share[np.abs(square - floor) <= _ON_LINE * abs(floor)] = 0.0
    share[np.abs(square - floor - ramp) <= _ON_LINE * abs(floor + ramp)] = 1.0
    return np.asarray(share)


def _upright_circle(
    points: Array, triangles: Indices, axis: tuple[float, float], floor: float, ramp: float
) -> list[Circle]:
    """Where the surface stands upright on this mesh, if so: halfway up in r^2, which keeps the volume."""
    if not (floor > 0.0 and math.isfinite(ramp)):
        return []
    circle = Circle(*axis, math.sqrt(floor + 0.5 * ramp))
    _, edges = edge_numbers(triangles)
    away = circle.beyond(points[edges[:, :2]])
    crossing = away[:, 0] * away[:, 1] <= 0.0
    chords = points[edges[crossing, 1]] - points[edges[crossing, 0]]
    longest = float(np.sum(chords**2, axis=1).max(initial=0.0))
    thickness = ramp / (math.sqrt(floor + ramp) + math.sqrt(floor))
    return [circle] if thickness <= 0.5 * longest / circle.radius else []


def _check(
    height: float,
    beta: float,
    constant: float,
    dry_radius: float,
    axis: tuple[float, float],
    size: float,
    layers: int,
    order: int,
) -> None:
    require_positive("height", height)
    require_not_negative("dry_radius", dry_radius)
    if not beta >= 0.0:
        raise InputError("beta", beta, "0 or above; infinite without gravity")
    if not (math.isfinite(constant) or math.isinf(beta)):
        raise InputError("surface_constant", constant, "finite; without gravity give dry_radius")
    if len(axis) != 2 or not all(math.isfinite(value) for value in axis):
        raise InputError("axis", axis, "two finite coordinates in metres")
    if not size > 0.0:
        raise InputError("size", size, "above 0")
    if layers < 1 or layers != int(layers):
        raise InputError("layers", layers, "a whole number, 1 or more")
    if order not in (1, 2):
        raise InputError("order", order, "1 (straight edges) or 2 (quadratic edges)")
