"""Triangles of the liquid ring between free surface and circular wall, with baffles as cracks or none."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshes.arrays import Array, Indices
from meshes.baffles import Baffles
from meshes.errors import InputError, require_few_nodes, require_positive
from meshes.liquid_section import SIDES, LiquidSection, liquid_section


def open_slits(points: Array, cells: Indices, slits: Indices) -> tuple[Array, Indices]:
    """Part the cells of a mesh along some of its sides, given by end nodes (K, 2); copies come last.

    A node is doubled where the sides cut its cells into groups: along a slit and where it meets the boundary.
    At a tip inside the mesh the node stays one. An `InputError` for a slit that opens nothing.
    """
    if len(slits) == 0:
        return points, cells
    sides = SIDES[cells.shape[1]]
    nodes = cells[:, sides].reshape(-1, sides.shape[1])
    # The places in `cells` at which each side finds its nodes.
    places = (np.arange(len(cells))[:, None, None] * cells.shape[1] + sides).reshape(nodes.shape)
    ends = np.sort(nodes[:, :2], axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    twin = np.all(ends[order[1:]] == ends[order[:-1]], axis=1)
    side, other_side = order[:-1][twin], order[1:][twin]
    key, wanted = _key(ends[side]), np.unique(_key(np.sort(slits, axis=1)))
    cut = np.isin(key, wanted)
    if np.count_nonzero(cut) != len(wanted):
        raise InputError("slits", np.shape(slits), "sides with a cell on either hand")
    kept, kept_other = side[~cut], other_side[~cut]
    # Neighbours run along their common side in opposite directions.
    width = sides.shape[1]
    turned = [1, 0, 2][:width]
    first, second = places[kept].ravel(), places[kept_other][:, turned].ravel()
    links = coo_array((np.ones(first.size), (first, second)), shape=(cells.size, cells.size))
    count, group = connected_components(links, directed=False)
    return _numbered(points, cells, np.asarray(group), int(count), ends[side[cut]])


def _numbered(
    points: Array, cells: Indices, group: Indices, count: int, opened: Indices
) -> tuple[Array, Indices]:
    """Give the first group of places at each node its number, and new numbers to the others."""
    node = np.empty(count, dtype=np.int64)
    node[group] = cells.ravel()
    _, first = np.unique(node, return_index=True)
    extra = np.ones(count, dtype=bool)
    extra[first] = False
    doubled = np.zeros(len(points), dtype=bool)
    doubled[node[extra]] = True
    if not np.all(doubled[opened].any(axis=1)):
        raise InputError("slits", len(opened), "two sides long or more where both ends are in the mesh")
    number = node.copy()
    number[extra] = len(points) + np.arange(np.count_nonzero(extra))
    return np.concatenate([points, points[node[extra]]]), number[group].reshape(cells.shape)


def _key(ends: Indices) -> Indices:
    """One number for each pair of nodes."""
    return np.asarray(ends[:, 0] * np.int64(2**31) + ends[:, 1])


def graded(
    length: float, largest: float, start: float, end: float, growth: float = 1.5, least: int = 1
) -> Array:
    """Positions from 0 to `length` in steps that grow from both ends by a ratio up to `growth`.

    The steps are stretched or shrunk alike, so that a whole number of them, at least `least`, fills the line.
    """
    slope = math.log(growth)
    # A step that starts where steps are `start` long, and grows on its way, ends that much shorter.
    shorter = slope / (growth - 1.0)
    start, end = min(start * shorter, largest), min(end * shorter, largest)
    # The step is start + slope x, then `largest` if there is room, then end + slope (length - x).
    rise, fall = (largest - start) / slope, length - (largest - end) / slope
    if rise > fall:
        rise = fall = 0.5 * (length + (end - start) / slope)
        rise = fall = min(max(rise, 0.0), length)
    rising = math.log1p(slope * rise / start) / slope
    level = (fall - rise) / largest
    falling = math.log1p(slope * (length - fall) / end) / slope
    total = rising + level + falling
    require_few_nodes("growth", growth, total)
    steps = max(least, math.ceil(total * (1.0 - 1e-9)))
    at = total * np.arange(steps + 1) / steps
    x = rise + (at - rising) * largest
    x = np.where(at < rising, start * np.expm1(slope * np.minimum(at, rising)) / slope, x)
    back = np.minimum(total - at, falling)
    x = np.where(total - at < falling, length - end * np.expm1(slope * back) / slope, x)
    x[0], x[-1] = 0.0, length
    return np.asarray(x)


def ring(
    radius: float,
    surface_radius: float,
    segments: int = 96,
    *,
    order: int = 2,
    layers: int = 4,
    baffles: Baffles | None = None,
    wall_depth: float = math.inf,
    surface_depth: float = math.inf,
    tip_size: float | None = None,
    growth: float = 1.5,
) -> LiquidSection:
    """Liquid at rest between the circle r = a and the wall r = R, in triangles along circles and rays.

    A layer may be much thinner than the cells are wide. Counts are least ones, sizes (m) largest ones:
    `wall_depth`, `surface_depth` of the cells there, `tip_size` at the edges of baffles (None: 1/20 of the
    depth), each a slit.
    """
    _check(radius, surface_radius, segments, order, layers, growth)
    for name, value in (("wall_depth", wall_depth), ("surface_depth", surface_depth)):
        if not value > 0.0:
            raise InputError(name, value, "above 0")
    require_few_nodes("segments", segments, segments * order**2)
    require_few_nodes("layers", layers, segments * order**2 * layers)
    span = baffles.wetted_span(radius, surface_radius) if baffles else None
    depth = radius - surface_radius
    tip = depth / 20.0 if tip_size is None else tip_size
    require_positive("tip_size", tip)
    # Between a tip and the wall, or the surface, there is room for two cells.
    inner, outer = span or (surface_radius, radius)
    at_inner, at_outer = (
        min(tip, 0.5 * gap) if gap > 0.0 else math.inf for gap in (inner - surface_radius, radius - outer)
    )
    deepest = min(depth / layers, 2.0 * math.pi * radius / segments)
    radii = _radii(
        radius, surface_radius, span, deepest, (surface_depth, at_inner, at_outer, wall_depth), growth
    )
    angles = _angles(segments, baffles if span else None, min(at_inner, at_outer) / radius, growth)
    require_few_nodes("segments", segments, len(radii) * len(angles) * order**2)
    points, cells = _grid(radii, angles, order)
    if span is not None and baffles is not None:
        points, cells = open_slits(points, cells, _baffle_sides(radii, angles, span, baffles, order))
    return liquid_section(points, cells, surface_radius)


def _radii(
    radius: float,
    surface_radius: float,
    span: tuple[float, float] | None,
    deepest: float,
    sizes: tuple[float, float, float, float],
    growth: float,
) -> Array:
    """Radii of the circles of nodes: the surface, the tips of the baffles and the wall are among them."""
    at_surface, at_inner, at_outer, at_wall = sizes
    inner, outer = span or (surface_radius, radius)
    marks = [(surface_radius, at_surface)]
    marks += [(inner, at_inner)] if inner > surface_radius else []
    marks += [(outer, at_outer)] if outer < radius else []
    marks += [(radius, at_wall)]
    parts = [np.array([surface_radius])]
    for (start, first), (stop, last) in pairwise(marks):
        steps = graded(stop - start, deepest, first, last, growth, least=2)
        parts.append(np.append(start + steps[1:-1], stop))
    return np.concatenate(parts)


def _angles(segments: int, baffles: Baffles | None, tip: float, growth: float) -> Array:
    """Angles of the rays of nodes, the first repeated a turn later; baffles lie on rays."""
    width = 2.0 * math.pi / segments
    if baffles is None:
        return np.linspace(0.0, 2.0 * math.pi, segments + 1)
    between = graded(2.0 * math.pi / baffles.count, width, tip, tip, growth, least=4)
    turns = baffles.angles[:, None] + between[:-1]
    return np.append(turns.ravel(), baffles.first_angle + 2.0 * math.pi)


def _grid(radii: Array, angles: Array, order: int) -> tuple[Array, Indices]:
    """Nodes and triangles of a polar grid; sides run along the curves halfway between its lines."""
    if order == 2:
        radii, angles = _halved(radii), _halved(angles)
    r, angle = np.meshgrid(radii, angles[:-1], indexing="ij")
    points = np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1).reshape(-1, 2)
    return points, polar_triangles(len(radii) - 1, len(angles) - 1, order)


def polar_triangles(outwards: int, around: int, order: int) -> Indices:
    """Triangles, two to each cell, of a grid of nodes that closes around, row by row from the inside.

    Rows (`outwards` is their number less one) are counter-clockwise; order 2 has vertices at every other row
    and node.
    """
    i, j = np.meshgrid(np.arange(0, outwards, order), np.arange(0, around, order), indexing="ij")

    def node(out: int, on: int) -> Indices:
        """Number of the node of each cell so many steps outwards and onwards."""
        return np.asarray((i + out) * around + (j + on) % around, dtype=np.int64).ravel()

    n = order
    first, second = [node(0, 0), node(n, 0), node(n, n)], [node(0, 0), node(n, n), node(0, n)]
    if order == 2:
        first += [node(1, 0), node(2, 1), node(1, 1)]
        second += [node(1, 1), node(1, 2), node(0, 1)]
    return np.stack([np.stack(first, 1), np.stack(second, 1)], 1).reshape(-1, 3 * order)


def _baffle_sides(
    radii: Array, angles: Array, span: tuple[float, float], baffles: Baffles, order: int
) -> Indices:
    """Sides of the grid on the baffles, shape (K, 2)."""
    around = order * (len(angles) - 1)
    first, last = np.searchsorted(radii, span)
    ray = order * np.arange(baffles.count) * ((len(angles) - 1) // baffles.count)
    start = order * np.arange(first, last)[:, None] * around + ray
    return np.stack([start.ravel(), start.ravel() + order * around], axis=1).astype(np.int64)


def _halved(values: Array) -> Array:
    """Values with those halfway between."""
    finer = np.empty(2 * len(values) - 1)
    finer[::2], finer[1::2] = values, 0.5 * (values[1:] + values[:-1])
    return finer


def _check(
    radius: float, surface_radius: float, segments: int, order: int, layers: int, growth: float
) -> None:
    require_positive("radius", radius)
    require_positive("surface_radius", surface_radius)
    if surface_radius >= radius * (1.0 - 1e-8):
        raise InputError("surface_radius", surface_radius, f"below radius ({radius:g} m)")
    if segments < 8 or segments != int(segments):
        raise InputError("segments", segments, "a whole number, 8 or more")
    if order not in (1, 2):
        raise InputError("order", order, "1 (straight sides) or 2 (quadratic sides)")
    if layers < 1 or layers != int(layers):
        raise InputError("layers", layers, "a whole number, 1 or more")
    if not 1.0 < growth <= 3.0:
        raise InputError("growth", growth, "above 1, 3 at most")
