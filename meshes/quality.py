"""How good a triangulation is: angles, aspect ratios, areas, inverted triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Edges of a triangle: first vertex, second vertex, midside node of a quadratic triangle.
EDGES = np.array([[0, 1, 3], [1, 2, 4], [2, 0, 5]])

# Where the Jacobian of a curved triangle is looked at: steps of 1/8 from vertex to vertex.
_LATTICE = np.array([(i, j) for i in range(9) for j in range(9 - i)], dtype=np.float64).T / 8.0


@dataclass(frozen=True)
class Quality:
    """What can spoil a computation on a triangulation.

    Parameters
    ----------
    triangles : how many there are
    worst_angle : the angle at a vertex that differs most from 60 degrees, rad; between tangents if curved
    aspect_ratio : largest ratio of longest edge to the altitude on it, 1 for equilateral, of the chords
    smallest_area, largest_area : of single triangles, m^2; negative if inverted
    total_area : m^2
    inverted : triangles with a Jacobian that is zero or negative somewhere
    """

    triangles: int
    worst_angle: float
    aspect_ratio: float
    smallest_area: float
    largest_area: float
    total_area: float
    inverted: int


def edge_polynomials(nodes: Array) -> tuple[Array, Array, Array]:
    """Edges of triangles as quadratic curves c0 + c1 t + c2 t^2, 0 <= t <= 1, counter-clockwise.

    Parameters
    ----------
    nodes : corners, and midside nodes if curved, shape (M, 3 or 6, 2), m

    Returns
    -------
    c0, c1, c2, each of shape (M, 3, 2), m; c2 is exactly zero for a straight edge.
    """
    start, end = nodes[:, EDGES[:, 0]], nodes[:, EDGES[:, 1]]
    bend = np.zeros_like(start)
    if nodes.shape[1] == 6:
        bend = 2.0 * (start + end) - 4.0 * nodes[:, EDGES[:, 2]]
        size = np.abs(nodes).max(axis=(1, 2), initial=0.0)[:, None, None]
        bend[np.abs(bend) < 1e-14 * size] = 0.0  # rounding of a midside node on the chord
    return start, end - start - bend, bend


def jacobians(points: Array, triangles: Indices) -> Array:
    """Jacobian determinants of the maps from the reference triangle, constant if the edges are straight.

    Parameters
    ----------
    points : nodes, shape (N, 2), m
    triangles : node numbers, shape (M, 3), or (M, 6) with curved edges

    Returns
    -------
    Values at points that include the nodes, shape (M, K), m^2: twice the area for straight edges.
    """
    nodes = points[triangles]
    if triangles.shape[1] == 3:
        a, b = nodes[:, 1] - nodes[:, 0], nodes[:, 2] - nodes[:, 0]
        return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])[:, None]
    p, q = _LATTICE
    slopes = np.array(
        [
            [4.0 * (p + q) - 3.0, 4.0 * (p + q) - 3.0],
            [4.0 * p - 1.0, np.zeros_like(p)],
            [np.zeros_like(q), 4.0 * q - 1.0],
            [4.0 - 8.0 * p - 4.0 * q, -4.0 * p],
            [4.0 * q, 4.0 * p],
            [-4.0 * q, 4.0 - 4.0 * p - 8.0 * q],
        ]
    )
    (xp, xq), (yp, yq) = np.einsum("mia,ibk->abmk", nodes, slopes)
    return np.asarray(xp * yq - xq * yp)


def triangle_areas(points: Array, triangles: Indices) -> Array:
    """Area of each triangle by Green's theorem along its edges, exact for curved ones.

    Parameters
    ----------
    points : nodes, shape (N, 2), m
    triangles : node numbers, shape (M, 3), or (M, 6) with curved edges

    Returns
    -------
    Areas, shape (M,), m^2; negative for clockwise triangles.
    """
    nodes = points[triangles]
    # Measured from a corner, so that a small triangle far from the origin keeps its digits.
    c0, c1, c2 = edge_polynomials(nodes - nodes[:, :1])

    def cross(a: Array, b: Array) -> Array:
        return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])

    # half of the integral of c x c' over 0 <= t <= 1
    return np.asarray(0.5 * np.sum(cross(c0, c1 + c2) + cross(c1, c2) / 3.0, axis=1))


def assess(points: Array, triangles: Indices) -> Quality:
    """Quality of a triangulation, valid or not.

    Parameters
    ----------
    points : nodes, shape (N, 2), m
    triangles : node numbers, shape (M, 3), or (M, 6) with curved edges

    Returns
    -------
    The report; angles and aspect ratio of a triangle without area are 0 or infinite.
    """
    nodes = points[triangles]
    _, c1, c2 = edge_polynomials(nodes)
    leaving = c1
    arriving = np.roll(c1 + 2.0 * c2, 1, axis=1)  # tangent of the edge that ends where this one starts
    sine = leaving[..., 1] * arriving[..., 0] - leaving[..., 0] * arriving[..., 1]
    cosine = -(leaving[..., 0] * arriving[..., 0] + leaving[..., 1] * arriving[..., 1])
    angles = np.abs(np.arctan2(sine, cosine))
    chords = np.roll(nodes[:, :3], -1, axis=1) - nodes[:, :3]
    longest = np.max(np.sum(chords**2, axis=2), axis=1)
    flat = np.abs(triangle_areas(points, triangles[:, :3]))
    aspect = np.full_like(flat, np.inf)
    np.divide(0.25 * np.sqrt(3.0) * longest, flat, out=aspect, where=flat > 1e-300 + 1e-17 * longest)
    areas = triangle_areas(points, triangles)
    return Quality(
        triangles=len(triangles),
        worst_angle=float(angles.flat[np.argmax(np.abs(angles - np.pi / 3.0))]),
        aspect_ratio=float(aspect.max()),
        smallest_area=float(areas.min()),
        largest_area=float(areas.max()),
        total_area=float(areas.sum()),
        inverted=int(np.sum(jacobians(points, triangles).min(axis=1) <= 0.0)),
    )
