"""Mesh of the liquid at rest in a spinning drum: the section between the walls and the circle r = a."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from meshes.arrays import Array, Indices
from meshes.errors import InputError, require_positive
from meshes.quality import SIDES as SIDES
from meshes.quality import jacobians

# Nodes of the surface lie on the circle to this fraction of its radius.
_ON_CIRCLE = 1e-9


@dataclass(frozen=True, eq=False)
class LiquidSection:
    """Liquid of a section with its free surface and its walls; made by `liquid_section`.

    A thin baffle is a slit: its two sides have nodes of their own, save those at a tip in the liquid.
    """

    points: Array  #: nodes, shape (N, 2), m, from the drum's geometric axis
    #: node numbers, counter-clockwise, shape (M, 3) or (M, 6) for triangles, (M, 4) or (M, 9) for
    #: quadrilaterals: vertices, then the nodes on the sides 0-1, 1-2, ..., then the one in the middle
    cells: Indices
    #: sides on the free surface, shape (S, 2 or 3): start, end, node between, with the liquid on the left, so
    #: that the angle falls from start to end
    surface: Indices
    wall: Indices  #: sides on walls and baffles, shape (W, 2 or 3), with the liquid on the left
    wall_piece: Indices  #: number of the connected piece of wall of each, shape (W,), from 0
    #: whether a piece is the outermost of its body of liquid, shape (pieces,): what is attached to the outer
    #: wall is part of it; the others stand free in the liquid
    fixed_piece: NDArray[np.bool_]
    surface_radius: float  #: a, m

    @property
    def order(self) -> int:
        """1 for straight sides, 2 for quadratic ones."""
        return int(self.surface.shape[1]) - 1


def liquid_section(points: Array, cells: Indices, surface_radius: float) -> LiquidSection:
    """Find free surface and walls among the free sides of a mesh.

    The sides of the free surface have all their nodes on the circle r = a. An `InputError` for cells
    inverted, folded, overlapping or inside the circle, and for a body of liquid without a free surface.
    """
    require_positive("surface_radius", surface_radius)
    nodes, numbers = _checked(points, cells)
    _check_shapes(nodes, numbers)
    free = free_sides(numbers)
    surface, wall = _surface_and_wall(nodes, numbers, free, surface_radius)
    piece = _pieces(wall, len(nodes))
    body = _components(np.repeat(numbers[:, 0], numbers.shape[1]), numbers.ravel(), len(nodes))
    _check_bodies(nodes, body, numbers, surface)
    fixed = _outermost(nodes, body, wall, piece)
    for array in (nodes, numbers, surface, wall, piece, fixed):
        array.setflags(write=False)
    return LiquidSection(nodes, numbers, surface, wall, piece, fixed, float(surface_radius))


def _checked(points: Array, cells: Indices) -> tuple[Array, Indices]:
    """Copies of the arrays, of shapes and numbers that fit."""
    nodes, numbers = np.array(points, dtype=np.float64), np.array(cells)
    if nodes.ndim != 2 or nodes.shape[1] != 2 or not np.all(np.isfinite(nodes)):
        raise InputError("points", nodes.shape, "an array of shape (N, 2), finite")
    if numbers.ndim != 2 or numbers.shape[1] not in SIDES or len(numbers) == 0:
        raise InputError("cells", numbers.shape, "an array of shape (M, 3), (M, 6), (M, 4) or (M, 9)")
    if not np.issubdtype(numbers.dtype, np.integer):
        raise InputError("cells", str(numbers.dtype), "an array of whole numbers")
    if numbers.min() < 0 or numbers.max() >= len(nodes):
        outside = numbers.max() if numbers.min() >= 0 else numbers.min()
        raise InputError("cells", int(outside), f"node numbers from 0 to {len(nodes) - 1}")
    return nodes, numbers.astype(np.int64)


def _check_shapes(points: Array, cells: Indices) -> None:
    corners = points[cells[:, : len(SIDES[cells.shape[1]])]]
    longest = np.max(np.sum((corners - np.roll(corners, 1, axis=1)) ** 2, axis=2), axis=1)
    # A needle thinner than this fraction of its length is lost in the rounding of its coordinates.
    bad = np.flatnonzero(jacobians(points, cells).min(axis=1) <= 1e-12 * longest)
    if len(bad):
        k = int(bad[0])
        x, y = corners[k].mean(axis=0)
        found = f"{len(bad)} of {len(cells)}, the first number {k} near ({x:g}, {y:g}) m"
        raise InputError("cells", found, "counter-clockwise, with an area, and not folded")


def _surface_and_wall(
    nodes: Array, cells: Indices, free: Indices, surface_radius: float
) -> tuple[Indices, Indices]:
    """Part the free sides into those on the circle and the others."""
    radius = np.hypot(*nodes[free].transpose(2, 0, 1))
    on_circle = np.all(np.abs(radius - surface_radius) <= _ON_CIRCLE * surface_radius, axis=1)
    # A wall may touch the circle from outside with all its nodes; there the angle rises along the side.
    start, end = nodes[free[:, 0]], nodes[free[:, 1]]
    on_circle &= start[:, 0] * end[:, 1] < start[:, 1] * end[:, 0]
    if not on_circle.any():
        raise InputError("surface_radius", surface_radius, "the radius of the circle that bounds the mesh")
    corners = cells[:, : len(SIDES[cells.shape[1]])]
    least = float(np.hypot(*nodes[np.unique(corners)].T).min())
    if least < surface_radius * (1.0 - _ON_CIRCLE):
        raise InputError(
            "surface_radius", surface_radius, f"at most the least radius of the mesh ({least:g} m)"
        )
    return free[on_circle], free[~on_circle]


def _check_bodies(points: Array, body: Indices, cells: Indices, surface: Indices) -> None:
    closed = ~np.isin(body[cells[:, 0]], body[surface[:, 0]])
    if closed.any():
        x, y = points[cells[np.argmax(closed), 0]]
        raise InputError(
            "cells", f"a body of liquid near ({x:g}, {y:g}) m", "a mesh whose bodies all have a free surface"
        )


def free_sides(cells: Indices) -> Indices:
    """Sides that one cell alone has, it on their left, shape (S, 2 or 3): start, end, node between."""
    sides = SIDES[cells.shape[1]]
    every = cells[:, sides].reshape(-1, sides.shape[1])
    nodes = int(cells.max()) + 1
    if len(np.unique(every[:, 0] * nodes + every[:, 1])) < len(every):
        raise InputError("cells", "a side with two cells on the same hand", "free of overlaps")
    pair = np.minimum(every[:, 0], every[:, 1]) * nodes + np.maximum(every[:, 0], every[:, 1])
    _, first, number, count = np.unique(pair, return_index=True, return_inverse=True, return_counts=True)
    if sides.shape[1] == 3:
        between = every[:, 2]
        own = len(np.unique(between)) == len(first)
        if (
            not (own and np.array_equal(between[first][number], between))
            or np.isin(between, every[:, :2]).any()
        ):
            raise InputError("cells", "sides that share or lack a node between", "one such node per side")
    alone: Indices = every[np.sort(first[count == 1])]
    return alone


def _pieces(sides: Indices, nodes: int) -> Indices:
    """Number of the connected piece each side belongs to."""
    if len(sides) == 0:
        return np.zeros(0, dtype=np.int64)
    joined = _components(sides[:, 0], sides[:, 1], nodes)[sides[:, 0]]
    return np.unique(joined, return_inverse=True)[1].astype(np.int64)


def _outermost(points: Array, body_of_node: Indices, wall: Indices, piece: Indices) -> NDArray[np.bool_]:
    """Of each body of liquid the piece of wall with the node farthest from the axis."""
    count = int(piece.max(initial=-1)) + 1
    radius, body = np.zeros(count), np.zeros(count, dtype=np.int64)
    np.maximum.at(radius, piece, np.hypot(*points[wall[:, 0]].T))
    body[piece] = body_of_node[wall[:, 0]]
    fixed = np.zeros(count, dtype=bool)
    for label in np.unique(body):
        here = np.flatnonzero(body == label)
        fixed[here[np.argmax(radius[here])]] = True
    return fixed


def _components(first: Indices, other: Indices, nodes: int) -> Indices:
    """Number of the component of each node under pairs that belong together."""
    links = scipy.sparse.coo_array((np.ones(first.size), (first, other)), shape=(nodes, nodes))
    return np.asarray(scipy.sparse.csgraph.connected_components(links, directed=False)[1], dtype=np.int64)
