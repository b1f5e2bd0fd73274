"""Outlines of chambers with baffles or a section of their own, as seen along the axis.

Rays run from the geometric centre, about which walls and baffles lie; the surface of each body of liquid is a
circle about the rotation axis.
"""

from __future__ import annotations

import math

import numpy as np

from leblanc.results.chamber import FilledChamber
from meshes.arrays import Array, Complex
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection
from meshes.liquid_section import free_sides

RAYS = 721
BISECTIONS = 60  # from the radius down to rounding


def is_uneven(chamber: FilledChamber) -> bool:
    """Baffles or a section of its own."""
    return chamber.baffles is not None or chamber.section is not None


def wall_line(section: ChamberSection) -> list[Array]:
    """Walls of a section as closed or open lines of points, m.

    Parameters
    ----------
    section : of the chamber
    """
    sides = free_sides(section.mesh.triangles)
    ordered = sides[:, [0, 2, 1]] if sides.shape[1] == 3 else sides
    return [section.mesh.points[one] for one in ordered]


def bodies(chamber: FilledChamber, centre: complex, depth: float) -> list[Array]:
    """Outline of each body of liquid, m, as closed lines of points, shape (k, 2).

    Parameters
    ----------
    chamber : its walls are drawn to scale
    centre : geometric centre as drawn, from the rotation axis, m
    depth : of the undisturbed layer as drawn, m
    """
    found = []
    for angle in _sectors(chamber):
        wall = _wall(chamber, angle)
        rest = np.minimum(chamber.radius - depth, wall)
        wanted = np.trapezoid(wall**2 - rest**2, angle)
        low, high = 0.0, float(wall.max()) + abs(centre)
        for _ in range(BISECTIONS):
            level = 0.5 * (low + high)
            inner = np.clip(_surface(level, centre, angle), chamber.inner_radius, wall)
            enough = np.trapezoid(wall**2 - inner**2, angle) > wanted
            low, high = (level, high) if enough else (low, level)
        around = np.concatenate([wall * np.exp(1j * angle), (inner * np.exp(1j * angle))[::-1]]) + centre
        found.append(np.stack([around.real, around.imag], axis=1))
    return found


def plates(baffles: Baffles, radius: float, depth_factor: float) -> list[tuple[complex, complex]]:
    """Ends of each baffle from the geometric centre, m; distances from the wall grow as the layer does.

    Parameters
    ----------
    baffles : of the chamber
    radius : of its wall, m
    depth_factor : by which layers are drawn deeper
    """
    inner = max(radius - (radius - baffles.tip_radius) * depth_factor, 0.0)
    outer = max(radius - baffles.wall_gap * depth_factor, inner)
    return [(inner * complex(turn), outer * complex(turn)) for turn in np.exp(1j * baffles.angles)]


def _sectors(chamber: FilledChamber) -> list[Array]:
    """Angles of each body of liquid that cannot mix with the others."""
    baffles = chamber.baffles
    whole = np.linspace(-math.pi, math.pi, RAYS)
    if baffles is None:
        return [whole]
    span = baffles.wetted_span(chamber.radius, chamber.mean_surface_radius)
    if span != (chamber.mean_surface_radius, chamber.radius):
        return [whole]
    width = 2.0 * math.pi / baffles.count
    return [start + np.linspace(0.0, width, RAYS) for start in baffles.angles]


def _wall(chamber: FilledChamber, angle: Array) -> Array:
    """Distance of the outermost wall in each direction, m."""
    if chamber.section is None:
        return np.full(angle.shape, chamber.radius)
    lines = np.stack(wall_line(chamber.section))
    nodes = lines[..., 0] + 1j * lines[..., 1]
    return _outermost(nodes[:, :-1].ravel(), nodes[:, 1:].ravel(), angle)


def _outermost(start: Complex, stop: Complex, angle: Array) -> Array:
    """Distance along each ray of the outermost of many straight sides, given by their ends x + i y, m."""
    turn = np.exp(-1j * angle)[:, None]
    one, other = start * turn, stop * turn
    meets = (one.imag * other.imag <= 0.0) & (one.imag != other.imag)
    share = np.divide(one.imag, one.imag - other.imag, where=meets, out=np.zeros(meets.shape))
    away = np.where(meets, one.real + share * (other.real - one.real), 0.0)
    return np.asarray(away.max(axis=1))


def _surface(level: float, centre: complex, angle: Array) -> Array:
    """Distance from the geometric centre to a circle about the rotation axis; 0 where a ray misses it, m."""
    toward = -centre * np.exp(-1j * angle)
    square = level**2 - toward.imag**2
    return np.asarray(np.maximum(toward.real + np.sqrt(np.maximum(square, 0.0)), 0.0))
