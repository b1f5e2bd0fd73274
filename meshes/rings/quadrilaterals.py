"""Mapped quadrilaterals of the liquid ring between the free surface and a circular wall, with baffles.

Circles and rays of nodes, equally spaced in the angle and in ln r, where harmonic functions vary evenly.
Towards the edge of a baffle in the liquid distances grow as a power of the cell's number, which keeps the
order of convergence where a flow turns round it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array, Indices
from meshes.baffles import Baffles
from meshes.errors import InputError, require_few_nodes, require_positive
from meshes.liquid_section import SIDES, LiquidSection, liquid_section
from meshes.rings.triangles import open_slits

# Distances from the edge of a baffle grow as this power of the cell's number. The flow there goes as the root
# of the distance, and elements of degree p keep their order with any power above 2 p.
_POWER = {1: 3.0, 2: 5.0}

# Cells on either side of an edge, at least.
_AT_EDGE = 8

# Longest step in the logarithm of the radius: a cell's middle node stays near its middle.
_LONGEST = 0.5


def ring(
    radius: float,
    surface_radius: float,
    around: int = 96,
    across: int = 6,
    *,
    order: int = 2,
    baffles: Baffles | None = None,
    times: int = 1,
    towards_surface: float = 1.0,
    towards_wall: float = 1.0,
) -> LiquidSection:
    """Liquid at rest between the circle r = a and the wall r = R, in quadrilaterals of four or nine nodes.

    `around` and `across` count cells at least, more with baffles, each a slit; `times` multiplies the cells
    between any two marks, for estimates of the error. `towards_surface` and `towards_wall` above 1 let
    distances from there grow as that power; 1: equal steps in ln r.
    """
    _check(radius, surface_radius, around, across, order, times)
    least = around * order**2
    require_few_nodes("around", around, least)
    require_few_nodes("across", across, least * across)
    require_few_nodes("times", times, least * across * times**2)
    for name, value in (("towards_surface", towards_surface), ("towards_wall", towards_wall)):
        if not 1.0 <= value <= 6.0:
            raise InputError(name, value, "1 to 6")
    towards = towards_surface, towards_wall
    radii, angles, span = _layout(radius, surface_radius, around, across, order, baffles, times, towards)
    points, cells = _grid(radii, angles, order)
    if span is not None and baffles is not None:
        sides = _baffle_sides(radii, span, baffles.count, len(angles) - 1, order)
        points, cells = open_slits(points, cells, sides)
    return liquid_section(points, cells, surface_radius)


@dataclass(frozen=True, eq=False)
class RingSector:
    """The liquid between two neighbouring baffles of a ring, the first of them at angle 0."""

    section: LiquidSection  #: of the sector alone; its walls are the ring's and the sides of both baffles
    rays: Indices  #: nodes on the first baffle's ray and those opposite on the second one's, shape (P, 2)
    baffle: NDArray[np.bool_]  #: whether those stand on the baffles, shape (P,)
    free: bool  #: the baffles stand free of the wall
    edges: Array  #: where baffles end in the liquid, shape (E, 2), m


def ring_sector(
    radius: float, surface_radius: float, around: int, across: int, baffles: Baffles
) -> RingSector:
    """One sector of the `ring` with baffles, of the same cells with nine nodes."""
    _check(radius, surface_radius, around, across, 2, 1)
    radii, angles, span = _layout(radius, surface_radius, around, across, 2, baffles, 1, (1.0, 1.0))
    if span is None:
        raise InputError("baffles", baffles.tip_radius, "in the liquid")
    columns = (len(angles) - 1) // baffles.count
    points, cells = _grid(radii, angles[: columns + 1] - baffles.first_angle, 2, turns=False)
    inner, outer = (int(np.argmin(np.abs(radii - r))) for r in span)
    rows = cells.reshape(len(radii) - 1, columns, 9)
    first, wall, last, surface = (
        rows[part][..., side]
        for part, side in zip(
            ((slice(inner, outer), 0), (-1,), (slice(inner, outer), -1), (0,)), SIDES[9], strict=True
        )
    )
    width = 2 * columns + 1
    ray = np.arange(2 * len(radii) - 1) * width
    on = (np.arange(ray.size) >= 2 * inner) & (np.arange(ray.size) <= 2 * outer)
    free = span[1] < radius
    piece = np.repeat([0, 1], [len(wall), 2 * len(first)]) if free else np.zeros(len(wall) + 2 * len(first))
    edges = [r for r in span if surface_radius < r < radius]
    turn = 2.0 * math.pi / baffles.count
    return RingSector(
        section=LiquidSection(
            points=points,
            cells=cells,
            surface=surface,
            wall=np.concatenate([wall, first, last]),
            wall_piece=piece.astype(np.int64),
            fixed_piece=np.array([True, False])[: 1 + free],
            surface_radius=surface_radius,
        ),
        rays=np.stack([ray, ray + width - 1], axis=1),
        baffle=on,
        free=free,
        edges=np.array([(r * math.cos(t), r * math.sin(t)) for r in edges for t in (0.0, turn)]).reshape(
            -1, 2
        ),
    )


def _layout(
    radius: float,
    surface_radius: float,
    around: int,
    across: int,
    order: int,
    baffles: Baffles | None,
    times: int,
    towards: tuple[float, float],
) -> tuple[Array, Array, tuple[float, float] | None]:
    """Radii of the circles of cells, angles of the rays, and the radii between which baffles are wet."""
    span = baffles.wetted_span(radius, surface_radius) if baffles else None
    edges = [edge for edge in span or () if surface_radius < edge < radius]
    power = _POWER[order] if edges else 1.0
    stops = [(surface_radius, towards[0]), *((edge, power) for edge in edges), (radius, towards[1])]
    marks = [(math.log(r / surface_radius), grade) for r, grade in stops]
    log_radii = _circles(marks, across, times, power)
    depth, gap = marks[-1][0], min(np.diff([mark for mark, _ in marks]))
    angles = _rays(baffles if span else None, around, times, power, depth, gap)
    require_few_nodes("around", around, len(log_radii) * len(angles) * order**2)
    radii = surface_radius * np.exp(log_radii)
    radii[0], radii[-1] = surface_radius, radius
    return radii, angles, span


def _baffle_sides(radii: Array, span: tuple[float, float], count: int, around: int, order: int) -> Indices:
    """Ends of the sides of the grid that lie on baffles, shape (K, 2)."""
    inner, outer = (int(np.argmin(np.abs(radii - r))) for r in span)
    ray = order * np.arange(count) * (around // count)
    circle = order * order * around
    start = np.arange(inner, outer)[:, None] * circle + ray
    return np.stack([start, start + circle], axis=-1).reshape(-1, 2)


def _rays(baffles: Baffles | None, around: int, times: int, power: float, depth: float, gap: float) -> Array:
    """Angles of the rays of nodes, the first repeated a turn later.

    Towards edges distances grow as a power over an angle of twice the layer's depth, from a quarter of the
    narrowest gap that an edge leaves; farther off steps are even. Depth and gap are differences of ln r.
    """
    if baffles is None:
        return np.linspace(0.0, 2.0 * math.pi, around * times + 1)
    half, step = math.pi / baffles.count, 2.0 * math.pi / around
    near = min(half, 2.0 * depth)
    graded = max(_AT_EDGE, math.ceil(power * near / step)) if power > 1.0 else 0
    if graded:
        graded = max(graded, math.ceil((4.0 * near / gap) ** (1.0 / power)))
    zone = near * np.power(np.arange(graded * times + 1) / max(1, graded * times), power)
    even = math.ceil((half - zone[-1]) / step * (1.0 - 1e-9)) * times
    even = max(even, times if zone[-1] < half * (1.0 - 1e-9) else 0, 0 if graded else 2 * times)
    out = np.append(zone, zone[-1] + (half - zone[-1]) * np.arange(1, even + 1) / max(1, even))
    out[-1] = half
    between = np.append(out, 2.0 * half - out[-2:0:-1])
    turns = baffles.first_angle + 2.0 * half * np.arange(baffles.count)[:, None] + between
    return np.append(turns.ravel(), baffles.first_angle + 2.0 * math.pi)


def _circles(marks: list[tuple[float, float]], across: int, times: int, power: float) -> Array:
    """Values of ln(r/a) through all marks, each with the power of the growth from it."""
    whole, gap = marks[-1][0] - marks[0][0], min(np.diff([mark for mark, _ in marks]))
    parts = [np.array([marks[0][0]])]
    for (start, rise), (stop, fall) in pairwise(marks):
        length, edged = stop - start, len(marks) > 2
        count = max(math.ceil(across * length / whole * (1.0 - 1e-9)), math.ceil(length / _LONGEST))
        if edged:
            # Half the cells of a part with an edge lie in a small share of it.
            count = max(2 * count, _AT_EDGE // 2, math.ceil((4.0 * length / gap) ** (1.0 / power)))
        count += count % 2 if min(rise, fall) > 1.0 else 0
        parts.append(start + length * _between(count * times, rise, fall)[1:])
        parts[-1][-1] = stop
    return np.concatenate(parts)


def _between(count: int, rise: float, fall: float) -> Array:
    """Positions from 0 to 1 whose distances from either end grow as a power of the number."""
    t = np.arange(count + 1) / count
    if rise > 1.0 and fall > 1.0:
        low, high = np.power(2.0 * np.minimum(t, 0.5), rise), np.power(2.0 * np.minimum(1.0 - t, 0.5), fall)
        return np.asarray(np.where(t <= 0.5, 0.5 * low, 1.0 - 0.5 * high))
    return np.asarray(np.power(t, rise) if fall == 1.0 else 1.0 - np.power(1.0 - t, fall))


def _grid(radii: Array, angles: Array, order: int, turns: bool = True) -> tuple[Array, Indices]:
    """Nodes circle by circle from the surface outwards, and cells; a last angle is the first if it turns."""
    if order == 2:
        middle = np.sqrt(radii[1:] * radii[:-1])
        radii = np.append(np.stack([radii[:-1], middle], axis=1).ravel(), radii[-1])
        between = 0.5 * (angles[1:] + angles[:-1])
        angles = np.append(np.stack([angles[:-1], between], axis=1).ravel(), angles[-1])
    r, angle = np.meshgrid(radii, angles[:-1] if turns else angles, indexing="ij")
    points = np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1).reshape(-1, 2)
    turn, last = r.shape[1], len(angles) - 1
    i, j = np.meshgrid(np.arange(0, len(radii) - 1, order), np.arange(0, last, order), indexing="ij")
    places = [(0, 0), (order, 0), (order, order), (0, order)]
    places += [(1, 0), (2, 1), (1, 2), (0, 1), (1, 1)] if order == 2 else []
    nodes = [((i + out) * turn + (j + on) % turn).ravel() for out, on in places]
    return points, np.stack(nodes, axis=1).astype(np.int64)


def _check(radius: float, surface_radius: float, around: int, across: int, order: int, times: int) -> None:
    require_positive("radius", radius)
    require_positive("surface_radius", surface_radius)
    if surface_radius >= radius * (1.0 - 1e-8):
        raise InputError("surface_radius", surface_radius, f"below radius ({radius:g} m)")
    if order not in (1, 2):
        raise InputError("order", order, "1 (four nodes a cell) or 2 (nine)")
    for name, value, least in (("around", around, 8), ("across", across, 1), ("times", times, 1)):
        if value < least or value != int(value):
            raise InputError(name, value, f"a whole number, {least} or more")
