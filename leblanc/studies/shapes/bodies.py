"""Liquid of chambers that baffles cut into compartments or whose section is no circle, as closed bodies.

Every compartment keeps its volume. Its free surface is z = beta r^2 + C about the axis at rest, with a C of
its own; without gravity along the axis it is the circle at a distance of its own.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from leblanc.plotting.bodies import LiquidBodies
from meshes.bodies.paraboloid import paraboloid_body
from meshes.chamber_section import liquid_of
from meshes.clip import wall_loops
from meshes.rings.sectors import compartment
from meshes.section import Section, section_area

if TYPE_CHECKING:  # scikit-fem is loaded where such a chamber is drawn
    from solvers.statics.free_surface import SurfaceSolution


AROUND = 180  # sides around the farthest wall, at least
_RIGHT_ANGLE = 24  # sides on a quarter of a compartment's wall


def is_cut(fill: Fill) -> bool:
    """The liquid is no single body between circular walls."""
    return fill.chamber.section is not None or fill.compartments > 1


@lru_cache(maxsize=32)
def sections_of(fill: Fill) -> tuple[Section, ...]:
    """Section of each body of liquid, from wall to wall."""
    chamber = fill.chamber
    if chamber.section is not None:
        return (chamber.section.mesh,)
    assert chamber.baffles is not None
    count = fill.compartments
    sides = max(4, math.ceil(4 * _RIGHT_ANGLE / count))
    return tuple(
        compartment(chamber.baffles, k, chamber.radius, chamber.inner_radius, sides) for k in range(count)
    )


def steepness(speed: float, gravity: float) -> float:
    """beta = Omega^2/(2 g), 1/m; infinite without gravity along the axis [theory: statics, eq. 1]."""
    return math.inf if gravity == 0.0 else speed**2 / (2.0 * gravity)


@lru_cache(maxsize=256)
def surfaces(
    fill: Fill, volume: float, deflection: complex, speed: float, gravity: float
) -> tuple[SurfaceSolution, ...]:
    """Free surface of each body of liquid, equal shares of the volume."""
    return _surfaces(fill, volume, deflection, speed, gravity)


def _surfaces(
    fill: Fill, volume: float, deflection: complex, speed: float, gravity: float
) -> tuple[SurfaceSolution, ...]:
    from solvers.statics.free_surface import solve_surface

    meshes, height = sections_of(fill), fill.chamber.height
    axis = (-deflection.real, -deflection.imag)
    beta = steepness(speed, gravity)
    share = volume / len(meshes)
    return tuple(
        solve_surface(mesh, height, beta, min(share, section_area(mesh) * height), axis) for mesh in meshes
    )


def bodies_at_rest(
    fill: Fill, volume: float, deflection: complex, speed: float, gravity: float
) -> LiquidBodies:
    """Liquid that turns with its chamber about the axis at rest [theory: statics, eq. 1]."""
    beta, bodies = steepness(speed, gravity), []
    found = surfaces(fill, volume, deflection, speed, gravity)
    for mesh, surface in zip(sections_of(fill), found, strict=True):
        bodies.append(
            paraboloid_body(
                mesh,
                fill.chamber.height,
                beta,
                0.0 if math.isinf(beta) else surface.surface_constant,
                dry_radius=surface.dry_radius,
                axis=(-deflection.real, -deflection.imag),
                size=2.0 * math.pi * fill.chamber.radius / AROUND,
                layers=1,
                order=1,
            )
        )
    return LiquidBodies(deflection, tuple(bodies))


def wall_is_dry(fill: Fill, volume: float, deflection: complex, speed: float, gravity: float) -> bool:
    """Somewhere a wall that the liquid at rest covers has none over its whole height."""
    found = surfaces(fill, volume, deflection, speed, gravity)
    for wall, surface in zip(_walls(fill), found, strict=True):
        if float(np.abs(wall + deflection).min()) < surface.dry_radius:
            return True
    return False


def meets_inner_wall(
    fill: Fill, volume: float, deflection: complex, speed: float, gravity: float, depth: float, gap: float
) -> bool:
    """Liquid at rest comes within a gap of a core or inner wall, or past edges of closed baffles."""
    wall = _dry_walls(fill, depth)
    if wall.size == 0:
        return False
    found = surfaces(fill, volume, deflection, speed, gravity)
    away = np.abs(wall + deflection).max(axis=1)
    level = np.array([surface.dry_radius for surface in found])
    return bool(np.any(away > level - gap * fill.chamber.radius))


def _dry_walls(fill: Fill, depth: float) -> NDArray[np.complex128]:
    """Points of walls that the layer at rest leaves dry as a whole, for each body, from the centre, m."""
    chamber, count = fill.chamber, fill.compartments
    if chamber.section is not None:
        dry = [z for z in wall_loops(chamber.section.mesh) if np.abs(z).max() < fill.surface_radius]
        return np.concatenate([np.zeros(0, dtype=complex), *dry])[None] if dry else np.zeros((0, 0), complex)
    assert chamber.baffles is not None
    edge = chamber.radius - (chamber.radius - chamber.baffles.tip_radius) * depth
    turn = np.linspace(0.0, 2.0 * math.pi / count, AROUND // count + 2)
    return np.asarray(max(edge, chamber.inner_radius) * np.exp(1j * (chamber.baffles.angles[:, None] + turn)))


@lru_cache(maxsize=32)
def _walls(fill: Fill) -> tuple[NDArray[np.complex128], ...]:
    """Points of the wall that each body covers at rest, from the chamber's centre, m."""
    chamber = fill.chamber
    if chamber.section is not None:
        if not fill.uneven:
            return (np.array([complex(chamber.radius)]),)
        liquid = liquid_of(chamber.section, fill.surface_radius)
        points = liquid.points[np.unique(liquid.wall)]
        return (points[:, 0] + 1j * points[:, 1],)
    assert chamber.baffles is not None
    turn = np.linspace(0.0, 2.0 * math.pi / fill.compartments, 2 * AROUND)
    return tuple(chamber.radius * np.exp(1j * (start + turn)) for start in chamber.baffles.angles)
