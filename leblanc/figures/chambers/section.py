"""The chamber as seen along the axis: outlines of wall and liquid, and how much they are exaggerated.

The frame turns with the drum: the rotation axis is the origin, the unbalance points along x. At synchronous
whirl the free surface is a circle about the rotation axis while the wall is a circle about the geometric
centre, which the deflection has moved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from leblanc.results.chamber import FilledChamber
from leblanc.results.drawn.scale import chord, rounded_down
from meshes.arrays import Array

RAYS = 361  # one degree apart, closed
BISECTIONS = 60  # from the radius down to rounding


@dataclass(frozen=True)
class Exaggeration:
    """Factors that the drawing applies.

    Parameters
    ----------
    deflection, depth : of the geometric centre and of the mean layer
    """

    deflection: float
    depth: float


def liquid_outline(chamber: FilledChamber, centre: complex, depth: float) -> tuple[Array, Array, Array]:
    """Liquid between the wall and the circle about the rotation axis that leaves the right area of it.

    Parameters
    ----------
    chamber : its walls are drawn to scale
    centre : geometric centre as drawn, so near that the rotation axis lies inside the inner wall, m
    depth : mean depth of the layer as drawn, m

    Returns
    -------
    Angles of rays about the rotation axis, rad; inner and outer end of the liquid on each, m; shape (361,).
    """
    angle = np.linspace(-math.pi, math.pi, RAYS)
    outer = chord(chamber.radius, centre, angle)
    floor = np.zeros_like(outer)
    if chamber.inner_radius > 0.0:
        floor = chord(chamber.inner_radius, centre, angle)
    wanted = math.pi * depth * (2.0 * chamber.radius - depth)
    low, high = 0.0, float(outer.max())
    for _ in range(BISECTIONS):
        surface = 0.5 * (low + high)
        inner = np.clip(surface, floor, outer)
        # The rays are equally spaced over a turn, where the mean is exact for smooth outlines.
        area = math.pi * float(np.mean((outer**2 - inner**2)[1:]))
        low, high = (surface, high) if area > wanted else (low, surface)
    return angle, np.clip(0.5 * (low + high), floor, outer), outer


def exaggeration(chambers: tuple[FilledChamber, ...], deflections: tuple[float, ...]) -> Exaggeration:
    """Factors that make deflection and layer visible and keep wet walls wet and dry patches dry.

    Parameters
    ----------
    chambers : those that are drawn
    deflections : amplitudes that are drawn, m, 0 or above
    """
    layers = [(c.least_depth, c) for c in chambers]
    layers = [(depth, c) for depth, c in layers if depth > 0.0]
    depth_factor = 1.0
    if layers:
        fits = min(0.5 * (c.radius - c.inner_radius) / depth for depth, c in layers)
        shows = max(0.15 * c.radius / depth for depth, c in layers)
        depth_factor = rounded_down(max(1.0, min(fits, shows)))
    sizes = [w for w in deflections if w > 0.0]
    if not sizes:
        return Exaggeration(1.0, depth_factor)
    inner = [0.9 * c.inner_radius for c in chambers if c.inner_radius > 0.0]
    widest = min([0.35 * c.radius for c in chambers] + inner) / max(sizes)
    wet = [0.9 * depth_factor * depth / w for depth, _ in layers for w in sizes if w < depth]
    factor = rounded_down(min([widest, *wet]))
    dry = [factor * w / depth for depth, _ in layers for w in sizes if w >= depth]
    # Equal factors keep what is dry dry; with unequal ones a thick layer would cover it.
    return Exaggeration(factor, factor if dry and min(dry) < depth_factor else depth_factor)


def side_by_side(chambers: tuple[FilledChamber, ...]) -> list[tuple[FilledChamber, ...]]:
    """Chambers sorted into drawings: those that lie inside one another share one, equal ones are drawn once.

    Parameters
    ----------
    chambers : of the rotor, in any order
    """
    drawings: list[list[FilledChamber]] = []
    for chamber in sorted(dict.fromkeys(chambers), key=lambda c: -c.radius):
        for drawing in drawings:
            if chamber.radius <= drawing[-1].inner_radius and chamber.plane == drawing[-1].plane:
                drawing.append(chamber)
                break
        else:
            drawings.append([chamber])
    return [tuple(drawing) for drawing in drawings]
