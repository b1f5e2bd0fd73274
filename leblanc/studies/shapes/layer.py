"""The liquid in a chamber as a closed body with its free surface.

Everything is measured in the plane across the axis by complex numbers, and along the axis from the chamber's
floor. The body is cut by half-planes through a line parallel to the axis, each of which meets the free
surface in one curve; the bodies between neighbouring half-planes are flat-sided.
"""

from __future__ import annotations

import math

import numpy as np

from leblanc.plotting.bodies import LiquidBodies, LiquidShape, chord, half_angle, pool
from meshes.arrays import Array
from meshes.bodies.paraboloid import paraboloid_body
from meshes.chamber import Chamber
from meshes.errors import InputError
from meshes.section import annulus
from solvers.statics.hydrostatics import Equilibrium, equilibrium

RAYS = 240  # half-planes around a turn, besides those where a waterline meets a wall
STEPS = 25  # points from one end of the free surface to the other
DRY = 1e-6  # a film thinner than this over the radius is drawn as a dry wall
LEVEL = 1e3  # of the radius: a circle as large as this stands for the level surface of a pool
AROUND = 240  # sides of a ring in which a pool surrounds the inner wall
_FLATTEST = 1e-12  # steepness that stands for a flat surface


def body_at_rest(
    chamber: Chamber, volume: float, deflection: complex, speed: float, gravity: float
) -> LiquidShape:
    """Liquid that turns with a chamber as a whole about the axis at rest [theory: statics, eq. 1].

    The axis at rest lies inside the inner wall, or inside the chamber if there is none.
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
    """Liquid of a layer as deep at the lid as at the floor."""
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


def body_of_pool(
    chamber: Chamber, volume: float, deflection: complex, down: float
) -> LiquidShape | LiquidBodies:
    """Liquid that lies at the bottom of a chamber whose axis is horizontal."""
    level = chamber.radius * math.cos(half_angle(volume / (chamber.height * chamber.radius**2)))
    if 0.0 < chamber.inner_radius > level:
        return _pool_round_wall(chamber, volume, deflection, down)
    # The rays start in the air, half way between its top and the level.
    start = 0.5 * (level - chamber.radius)
    angle = np.linspace(-math.pi, math.pi, 3 * RAYS, endpoint=False)
    centre = complex(-start * math.cos(down), -start * math.sin(down))
    outer = chord(chamber.radius, centre, angle)
    along = np.cos(angle - down)
    free = np.divide(level - start, along, out=np.full(angle.shape, math.inf), where=along > 0.0)
    free = np.minimum(free, outer)
    return _upright(deflection - centre, angle, np.zeros_like(outer), outer, free, chamber.height)


def _pool_round_wall(chamber: Chamber, volume: float, deflection: complex, down: float) -> LiquidBodies:
    """A pool that reaches the inner wall: outside a circle so large that it is level."""
    _, level = pool(chamber.radius, chamber.inner_radius, volume / chamber.height, down)
    reach = LEVEL * chamber.radius
    body = paraboloid_body(
        annulus(chamber.radius, chamber.inner_radius, AROUND, order=2),
        chamber.height,
        math.inf,
        dry_radius=reach + level,
        axis=(-reach * math.cos(down), -reach * math.sin(down)),
        size=2.0 * math.pi * chamber.radius / AROUND,
        layers=1,
        order=1,
    )
    return LiquidBodies(deflection, (body,))
