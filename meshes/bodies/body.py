"""Bodies of liquid in three dimensions: tetrahedra that stand in columns on a plane triangulation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array, Indices
from meshes.errors import require_few_nodes

# Most that the depth halfway along an edge may differ from the mean of its ends, over that mean.
_BEND = 0.45

# Parts of the walls of a chamber, by number.
WALL_PARTS = ("floor", "lid", "side")

# Edges of a tetrahedron, in the order of their middle nodes; its faces, seen from outside, with theirs.
_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
_FACES = np.array([[0, 2, 1, 6, 5, 4], [0, 1, 3, 4, 8, 7], [1, 2, 3, 5, 9, 8], [0, 3, 2, 7, 9, 6]])

# A prism whose columns come in the order of their numbers falls into three tetrahedra: column and level of
# their vertices. Prisms side by side agree on the diagonal of the face between them.
_PRISM = (
    ((0, 0), (1, 0), (2, 0), (2, 1)),
    ((0, 0), (1, 0), (2, 1), (1, 1)),
    ((0, 0), (0, 1), (1, 1), (2, 1)),
)

# Points and weights on the unit square that integrate polynomials up to degree 6 over a triangle.
_LEGENDRE = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, eq=False)
class Body:
    """A body of liquid with its free surface and the walls that it wets."""

    points: Array  #: nodes, shape (N, 3), m: from the chamber's geometric axis, height above its floor
    #: tetrahedra, shape (M, 4), or (M, 10) with the nodes between 0-1, 1-2, 2-0, 0-3, 1-3, 2-3
    cells: Indices
    surface: Indices  #: triangles on the free surface, seen from outside the liquid, shape (S, 3) or (S, 6)
    wall: Indices  #: triangles on the walls, seen from outside the liquid, shape (W, 3) or (W, 6)
    wall_part: Indices  #: number of the part of the walls in `WALL_PARTS`, shape (W,)

    @property
    def order(self) -> int:
        """1 for straight edges, 2 for quadratic ones."""
        return 1 if self.cells.shape[1] == 4 else 2


@dataclass(frozen=True)
class BodyIntegrals:
    """Volume, m^3, and first moments of a body from the geometric axis and the floor, m^4."""

    volume: float
    x: float
    y: float
    z: float


def columns(
    points: Array,
    triangles: Indices,
    depth: Array,
    height: float,
    open_top: NDArray[np.bool_],
    open_side: NDArray[np.bool_],
    *,
    layers: int,
    order: int,
) -> Body:
    """Liquid that stands on the floor above a plane triangulation of six-node triangles, counter-clockwise.

    `depth` is that of the liquid at each node, m; columns of depth 0 are single points, and where it reaches
    the height the liquid wets the lid. Columns in `open_top` (the lid's waterline among them) end in the free
    surface, those in `open_side` stand in it.
    """
    require_few_nodes("layers", layers, len(points) * (2.0 * layers + 1.0))
    depth = depth.copy()
    ends, middle = triangles[:, [[0, 1], [1, 2], [2, 0]]], triangles[:, 3:]
    # An edge without depth at both ends has none between; where a mesh is too coarse for the bend of the
    # surface, straightening it keeps the cells from folding.
    mean = depth[ends].mean(axis=2)
    depth[middle] = np.clip(depth[middle], (1.0 - _BEND) * mean, (1.0 + _BEND) * mean)
    levels = 2 * layers + 1
    level, empty = np.arange(levels), depth == 0.0
    number = np.arange(len(points))[:, None] * levels + np.where(empty[:, None], 0, level)
    cells = _tetrahedra(triangles, number, empty, layers)
    top = level == levels - 1
    airy = open_side[:, None] | empty[:, None] | (top & open_top[:, None])
    nodes = np.concatenate(
        [np.repeat(points, levels, axis=0), (depth[:, None] * level / (levels - 1)).reshape(-1, 1)], axis=1
    )
    return _body(nodes, cells[:, : 4 if order == 1 else 10], airy.ravel(), height)


def _tetrahedra(triangles: Indices, number: Indices, empty: NDArray[np.bool_], layers: int) -> Indices:
    """Ten-node tetrahedra in the columns of some triangles, without those that have no volume."""
    rank = np.argsort(triangles[:, :3], axis=1)
    column = np.take_along_axis(triangles[:, :3], rank, axis=1)
    # Middle node of the edge between two of the three sorted columns.
    opposite = np.array([1, 2, 0])  # the edge across from a vertex, by its place among the middle nodes
    third = 3 - (rank[:, :, None] + rank[:, None, :])
    between = np.take_along_axis(triangles[:, 3:], opposite[third.clip(0, 2)].reshape(-1, 9), axis=1)
    between = between.reshape(-1, 3, 3)
    parity = np.sign((rank[:, 1] - rank[:, 0]) * (rank[:, 2] - rank[:, 1]) * (rank[:, 2] - rank[:, 0]))
    found = []
    for layer in range(layers):
        for prism in _PRISM:
            where = [(c, 2 * (layer + up)) for c, up in prism]
            nodes = [number[column[:, c], level] for c, level in where]
            for first, other in _EDGES:
                (c, low), (d, high) = where[first], where[other]
                # The level of a column without depth is that of the other end.
                start = np.where(empty[column[:, c]], high, low)
                end = np.where(empty[column[:, d]], start, high)
                middle = column[:, c] if c == d else between[:, c, d]
                nodes.append(number[middle, (start + end) // 2])
            found.append(_upright(np.stack(nodes, axis=1), parity))
    cells = np.concatenate(found)
    corners = np.sort(cells[:, :4], axis=1)
    return np.asarray(cells[np.all(corners[:, 1:] != corners[:, :-1], axis=1)], dtype=np.int64)


def _upright(cells: Indices, parity: Indices) -> Indices:
    """Exchange two vertices where sorting the columns took an odd number of exchanges."""
    turned = cells[:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]]
    return np.where((parity > 0)[:, None], cells, turned)


def _body(points: Array, cells: Indices, airy: NDArray[np.bool_], height: float) -> Body:
    """Part the faces that one cell alone has into free surface and walls; drop nodes that no cell uses."""
    faces = cells[:, _FACES[:, : 3 if cells.shape[1] == 4 else 6]].reshape(
        -1, 3 if cells.shape[1] == 4 else 6
    )
    corners = np.sort(faces[:, :3], axis=1)
    order = np.lexsort(corners.T)
    same = np.all(corners[order[1:]] == corners[order[:-1]], axis=1)
    alone = np.ones(len(faces), dtype=bool)
    alone[order[1:][same]] = alone[order[:-1][same]] = False
    outer = faces[alone]
    z = points[outer[:, :3], 2]
    part = np.where(np.all(z == 0.0, axis=1), 0, np.where(np.all(z >= height, axis=1), 1, 2))
    open_ = airy[outer[:, :3]].all(axis=1)
    used, inverse = np.unique(cells, return_inverse=True)
    new = np.full(len(points), -1, dtype=np.int64)
    new[used] = np.arange(len(used))
    arrays = (points[used], inverse.reshape(cells.shape), new[outer[open_]], new[outer[~open_]], part[~open_])
    for array in arrays:
        array.setflags(write=False)
    return Body(*arrays)


def body_jacobians(points: Array, cells: Indices) -> Array:
    """Jacobian determinants of tetrahedra at their nodes, six times the volume for straight edges, m^3."""
    nodes = points[cells]
    if cells.shape[1] == 4:
        return np.asarray(np.linalg.det(nodes[:, 1:] - nodes[:, :1]))[:, None]
    corners = np.eye(4)
    at = np.concatenate([corners, [0.5 * (corners[a] + corners[b]) for a, b in _EDGES]])
    found = []
    for share in at:
        # Slopes of the shape functions with the four barycentric coordinates, then of these with three.
        slopes = np.zeros((10, 4))
        slopes[:4] = np.diag(4.0 * share - 1.0)
        for k, (a, b) in enumerate(_EDGES, start=4):
            slopes[k, a], slopes[k, b] = 4.0 * share[b], 4.0 * share[a]
        along = slopes[:, 1:] - slopes[:, :1]
        found.append(np.linalg.det(np.einsum("mia,ib->mba", nodes, along)))
    return np.stack(found, axis=1)


def body_integrals(body: Body) -> BodyIntegrals:
    """Volume and first moments of a body by Gauss's theorem over its faces, exact for quadratic ones."""
    faces = np.concatenate([body.surface, body.wall])
    nodes = body.points[faces]
    middle = nodes.mean(axis=(0, 1))  # near the body, so that little cancels
    nodes = nodes - middle
    s, weight = 0.5 * (1.0 + _LEGENDRE[0]), 0.5 * _LEGENDRE[1]
    # The unit square folded onto the triangle.
    p, q = s[:, None] * np.ones(4), (1.0 - s)[:, None] * s
    weights = (weight[:, None] * weight * (1.0 - s)[:, None]).ravel()
    shape, slope_p, slope_q = _shapes(p.ravel(), q.ravel(), faces.shape[1])
    x = np.einsum("fia,ik->kfa", nodes, shape)
    normal = np.cross(np.einsum("fia,ik->kfa", nodes, slope_p), np.einsum("fia,ik->kfa", nodes, slope_q))
    flux = normal * weights[:, None, None]
    volume = float(np.sum(x * flux)) / 3.0
    first = 0.5 * np.sum(x * x * flux, axis=(0, 1)) + volume * middle
    return BodyIntegrals(volume, *(float(value) for value in first))


def _shapes(p: Array, q: Array, count: int) -> tuple[Array, Array, Array]:
    """Shape functions of a triangle of 3 or 6 nodes and their slopes, each of shape (count, K)."""
    r, ones, none = 1.0 - p - q, np.ones_like(p), np.zeros_like(p)
    if count == 3:
        return np.stack([r, p, q]), np.stack([-ones, ones, none]), np.stack([-ones, none, ones])
    shape = np.stack([r * (2 * r - 1), p * (2 * p - 1), q * (2 * q - 1), 4 * r * p, 4 * p * q, 4 * q * r])
    slope_p = np.stack([1 - 4 * r, 4 * p - 1, none, 4 * (r - p), 4 * q, -4 * q])
    slope_q = np.stack([1 - 4 * r, none, 4 * q - 1, -4 * p, 4 * p, 4 * (r - q)])
    return shape, slope_p, slope_q
