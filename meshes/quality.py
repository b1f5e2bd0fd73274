"""How good a plane mesh is: angles, aspect ratios, areas, inverted cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Indices

# Edges of a triangle: first vertex, second vertex, midside node of a quadratic triangle.
EDGES = np.array([[0, 1, 3], [1, 2, 4], [2, 0, 5]])

# Sides of a cell by its number of nodes: start, end and, if curved, the node between.
SIDES = {
    3: EDGES[:, :2],
    6: EDGES,
    4: np.array([[0, 1], [1, 2], [2, 3], [3, 0]]),
    9: np.array([[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]]),
}

# Where the Jacobian of a curved triangle is looked at: steps of 1/8 from vertex to vertex.
_LATTICE = np.array([(i, j) for i in range(9) for j in range(9 - i)], dtype=np.float64).T / 8.0

# Nodes of a quadrilateral of 9 on the reference square, in half sides.
_SQUARE = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1], [1, 1]])


@dataclass(frozen=True)
class Quality:
    """What can spoil a computation on a mesh."""

    triangles: int  #: how many cells there are
    #: the angle at a vertex that differs most from that of the regular cell, 60 degrees for triangles and 90
    #: for quadrilaterals, rad; between tangents if curved
    worst_angle: float
    #: largest ratio of longest side to the breadth across it, 1 for regular cells, of the chords
    aspect_ratio: float
    smallest_area: float  #: of single cells, m^2; negative if inverted
    largest_area: float
    total_area: float  #: m^2
    inverted: int  #: cells with a Jacobian that is zero or negative somewhere


def edge_polynomials(nodes: Array) -> tuple[Array, Array, Array]:
    """Sides of cells as curves c0 + c1 t + c2 t^2, 0 <= t <= 1, counter-clockwise, (M, sides, 2) each, m.

    From nodes (M, K, 2), K = 3 or 6 for triangles, 4 or 9 for quadrilaterals; c2 is exactly zero for a
    straight side.
    """
    sides = SIDES[nodes.shape[1]]
    start, end = nodes[:, sides[:, 0]], nodes[:, sides[:, 1]]
    bend = np.zeros_like(start)
    if sides.shape[1] == 3:
        bend = 2.0 * (start + end) - 4.0 * nodes[:, sides[:, 2]]
        size = np.abs(nodes).max(axis=(1, 2), initial=0.0)[:, None, None]
        bend[np.abs(bend) < 1e-14 * size] = 0.0  # rounding of a node on the chord
    return start, end - start - bend, bend


def jacobians(points: Array, cells: Indices) -> Array:
    """Jacobian determinants of the maps from the reference triangle or square, shape (M, K), m^2.

    At points that include the nodes: twice the area of a straight triangle, the area of a parallelogram.
    """
    nodes = points[cells]
    if cells.shape[1] == 3:
        a, b = nodes[:, 1] - nodes[:, 0], nodes[:, 2] - nodes[:, 0]
        return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])[:, None]
    slopes = _triangle_slopes() if cells.shape[1] == 6 else _square_slopes(cells.shape[1])
    (xp, xq), (yp, yq) = np.einsum("mia,ibk->abmk", nodes, slopes)
    return np.asarray(xp * yq - xq * yp)


def _triangle_slopes() -> Array:
    """Slopes of the six shape functions at the lattice, shape (6, 2, K)."""
    p, q = _LATTICE
    return np.array(
        [
            [4.0 * (p + q) - 3.0, 4.0 * (p + q) - 3.0],
            [4.0 * p - 1.0, np.zeros_like(p)],
            [np.zeros_like(q), 4.0 * q - 1.0],
            [4.0 - 8.0 * p - 4.0 * q, -4.0 * p],
            [4.0 * q, 4.0 * p],
            [-4.0 * q, 4.0 - 4.0 * p - 8.0 * q],
        ]
    )


def _square_slopes(count: int) -> Array:
    """Slopes of the shape functions of a quadrilateral at a lattice with its nodes, shape (count, 2, K)."""
    t = np.linspace(0.0, 1.0, 2 if count == 4 else 7)
    if count == 4:
        values, slopes, number = (
            np.stack([1.0 - t, t]),
            np.stack([-1.0 + 0.0 * t, 1.0 + 0.0 * t]),
            _SQUARE // 2,
        )
    else:
        values = np.stack([(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)])
        slopes, number = np.stack([4.0 * t - 3.0, 4.0 - 8.0 * t, 4.0 * t - 1.0]), _SQUARE
    i, j = number[:count].T
    along_p = slopes[i][:, :, None] * values[j][:, None, :]
    along_q = values[i][:, :, None] * slopes[j][:, None, :]
    return np.stack([along_p, along_q], axis=1).reshape(count, 2, -1)


def cell_areas(points: Array, cells: Indices) -> Array:
    """Area of each cell by Green's theorem along its sides, m^2, exact if curved; negative if clockwise."""
    nodes = points[cells]
    # Measured from a corner, so that a small cell far from the origin keeps its digits.
    c0, c1, c2 = edge_polynomials(nodes - nodes[:, :1])

    def cross(a: Array, b: Array) -> Array:
        return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])

    # half of the integral of c x c' over 0 <= t <= 1
    return np.asarray(0.5 * np.sum(cross(c0, c1 + c2) + cross(c1, c2) / 3.0, axis=1))


def triangle_areas(points: Array, triangles: Indices) -> Array:
    """Area of each triangle, m^2, as `cell_areas`."""
    return cell_areas(points, triangles)


def vertex_angles(points: Array, cells: Indices) -> Array:
    """Angles at the vertices of cells, between tangents of curved sides, (M, vertices), rad, from 0 to pi."""
    _, c1, c2 = edge_polynomials(points[cells])
    leaving = c1
    arriving = np.roll(c1 + 2.0 * c2, 1, axis=1)  # tangent of the side that ends where this one starts
    sine = leaving[..., 1] * arriving[..., 0] - leaving[..., 0] * arriving[..., 1]
    cosine = -(leaving[..., 0] * arriving[..., 0] + leaving[..., 1] * arriving[..., 1])
    return np.asarray(np.abs(np.arctan2(sine, cosine)))


def aspect_ratios(points: Array, cells: Indices) -> Array:
    """Longest chord of each cell over its breadth across it, 1 for regular cells, inf without area."""
    corners = 3 if cells.shape[1] in (3, 6) else 4
    nodes = points[cells[:, :corners]]
    longest = np.max(np.sum((np.roll(nodes, -1, axis=1) - nodes) ** 2, axis=2), axis=1)
    flat = np.abs(cell_areas(points, cells[:, :corners]))
    aspect = np.full_like(flat, np.inf)
    # The breadth of a triangle is twice its area over the side, and sqrt(3)/2 of the side if equilateral.
    regular = 0.25 * np.sqrt(3.0) * longest if corners == 3 else longest
    np.divide(regular, flat, out=aspect, where=flat > 1e-300 + 1e-17 * longest)
    return aspect


def assess(points: Array, triangles: Indices) -> Quality:
    """Quality of a plane mesh, valid or not; angles and aspect ratio without area are 0 or infinite."""
    angles = vertex_angles(points, triangles)
    regular = np.pi / 3.0 if angles.shape[1] == 3 else np.pi / 2.0
    areas = cell_areas(points, triangles)
    return Quality(
        triangles=len(triangles),
        worst_angle=float(angles.flat[np.argmax(np.abs(angles - regular))]),
        aspect_ratio=float(aspect_ratios(points, triangles).max()),
        smallest_area=float(areas.min()),
        largest_area=float(areas.max()),
        total_area=float(areas.sum()),
        inverted=int(np.sum(jacobians(points, triangles).min(axis=1) <= 0.0)),
    )
