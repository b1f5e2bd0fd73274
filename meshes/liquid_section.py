"""Mesh of the liquid at rest in a spinning drum: the section between the walls and the circle r = a."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshes.border import InputError, require_positive

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Sides of a cell by its number of nodes: start, end and, if curved, the node between.
SIDES = {
    3: np.array([[0, 1], [1, 2], [2, 0]]),
    6: np.array([[0, 1, 3], [1, 2, 4], [2, 0, 5]]),
    4: np.array([[0, 1], [1, 2], [2, 3], [3, 0]]),
    9: np.array([[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]]),
}

# Nodes of the surface lie on the circle to this fraction of its radius.
_ON_CIRCLE = 1e-9


@dataclass(frozen=True, eq=False)
class LiquidSection:
    """Liquid of a section with its free surface and its walls; made by `liquid_section`.

    A thin baffle is a slit: its two sides have nodes of their own, save those at a tip in the liquid.

    Parameters
    ----------
    points : nodes, shape (N, 2), m, from the drum's geometric axis
    cells : node numbers, counter-clockwise, shape (M, 3) or (M, 6) for triangles, (M, 4) or (M, 9) for
        quadrilaterals: vertices, then the nodes on the sides 0-1, 1-2, ..., then the one in the middle
    surface : sides on the free surface, shape (S, 2 or 3): start, end, node between, with the liquid on the
        left, so that the angle falls from start to end
    wall : sides on walls and baffles, shape (W, 2 or 3), with the liquid on the left
    wall_piece : number of the connected piece of wall of each, shape (W,), from 0
    fixed_piece : whether a piece is the outermost of its body of liquid, shape (pieces,): what is attached to
        the outer wall is part of it; the others stand free in the liquid
    surface_radius : a, m
    """

    points: Array
    cells: Indices
    surface: Indices
    wall: Indices
    wall_piece: Indices
    fixed_piece: NDArray[np.bool_]
    surface_radius: float

    @property
    def order(self) -> int:
        """1 for straight sides, 2 for quadratic ones."""
        return int(self.surface.shape[1]) - 1


def liquid_section(points: Array, cells: Indices, surface_radius: float) -> LiquidSection:
    """Find free surface and walls among the free sides of a mesh.

    Parameters
    ----------
    points, cells, surface_radius : as for `LiquidSection`; the sides of the free surface have all their nodes
        on the circle r = a

    Returns
    -------
    The mesh with its sides; the arrays are copied and cannot be written to.

    Raises
    ------
    InputError : a shape or a number that does not fit, no side on the circle, more than two cells on a side
    """
    require_positive("surface_radius", surface_radius)
    nodes, numbers = np.array(points, dtype=np.float64), np.array(cells, dtype=np.int64)
    if nodes.ndim != 2 or nodes.shape[1] != 2 or not np.all(np.isfinite(nodes)):
        raise InputError("points", nodes.shape, "an array of shape (N, 2), finite")
    if numbers.ndim != 2 or numbers.shape[1] not in SIDES or len(numbers) == 0:
        raise InputError("cells", numbers.shape, "an array of shape (M, 3), (M, 6), (M, 4) or (M, 9)")
    if numbers.min() < 0 or numbers.max() >= len(nodes):
        raise InputError("cells", int(numbers.max()), f"node numbers from 0 to {len(nodes) - 1}")
    free = _free_sides(numbers)
    away = np.abs(np.hypot(*nodes[free].transpose(2, 0, 1)) - surface_radius)
    on_circle = np.all(away <= _ON_CIRCLE * surface_radius, axis=1)
    # A wall may touch the circle from outside with all its nodes; there the angle rises along the side.
    start, end = nodes[free[:, 0]], nodes[free[:, 1]]
    on_circle &= start[:, 0] * end[:, 1] < start[:, 1] * end[:, 0]
    if not on_circle.any():
        raise InputError("surface_radius", surface_radius, "the radius of the circle that bounds the mesh")
    surface, wall = free[on_circle], free[~on_circle]
    piece = _pieces(wall, len(nodes))
    fixed = _outermost(nodes, numbers, wall, piece)
    for array in (nodes, numbers, surface, wall, piece, fixed):
        array.setflags(write=False)
    return LiquidSection(nodes, numbers, surface, wall, piece, fixed, float(surface_radius))


def _free_sides(cells: Indices) -> Indices:
    """Sides that one cell alone has, with that cell on the left."""
    sides = SIDES[cells.shape[1]]
    every = cells[:, sides].reshape(-1, sides.shape[1])
    ends = np.sort(every[:, :2], axis=1)
    _, first, count = np.unique(ends, axis=0, return_index=True, return_counts=True)
    if count.max() > 2:
        raise InputError("cells", "a side with more than two cells", "at most two cells on a side")
    alone: Indices = every[np.sort(first[count == 1])]
    return alone


def _pieces(sides: Indices, nodes: int) -> Indices:
    """Number of the connected piece each side belongs to."""
    if len(sides) == 0:
        return np.zeros(0, dtype=np.int64)
    joined = _components(sides[:, 0], sides[:, 1], nodes)[sides[:, 0]]
    return np.unique(joined, return_inverse=True)[1].astype(np.int64)


def _outermost(points: Array, cells: Indices, wall: Indices, piece: Indices) -> NDArray[np.bool_]:
    """Of each body of liquid the piece of wall with the node farthest from the axis."""
    count = int(piece.max(initial=-1)) + 1
    body_of_node = _components(np.repeat(cells[:, 0], cells.shape[1]), cells.ravel(), len(points))
    radius, body = np.zeros(count), np.zeros(count, dtype=np.int64)
    np.maximum.at(radius, piece, np.hypot(*points[wall[:, 0]].T))
    body[piece] = body_of_node[wall[:, 0]]
    fixed = np.zeros(count, dtype=bool)
    for one in np.unique(body):
        here = np.flatnonzero(body == one)
        fixed[here[np.argmax(radius[here])]] = True
    return fixed


def _components(one: Indices, other: Indices, nodes: int) -> Indices:
    """Number of the component of each node under pairs that belong together."""
    links = coo_array((np.ones(one.size), (one, other)), shape=(nodes, nodes))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)
