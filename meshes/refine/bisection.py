"""Refinement of quadratic triangulations by bisection: conforming, the shape of the section stays exact."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array, Indices
from meshes.errors import MOST_NODES, InputError
from meshes.liquid_section import LiquidSection, free_sides, liquid_section
from meshes.quality import EDGES, cell_areas
from meshes.section import Section

# Turns a triangle so that its edge 0, 1 or 2 comes first.
TURNED = np.array([[0, 1, 2, 3, 4, 5], [1, 2, 0, 4, 5, 3], [2, 0, 1, 5, 3, 4]])


def quadratic_triangles(section: Section) -> tuple[Array, Indices]:
    """Points and six-node triangles of a section; straight edges get nodes at their middles."""
    if section.order == 2:
        return np.array(section.points), np.array(section.triangles)
    number, edges = edge_numbers(section.triangles)
    middles = section.points[edges[:, :2]].mean(axis=1)
    midside = len(section.points) + number
    return np.concatenate([section.points, middles]), np.concatenate([section.triangles, midside], axis=1)


def edge_numbers(triangles: Indices) -> tuple[Indices, Indices]:
    """Numbers of the edges 0-1, 1-2, 2-0 of each triangle, (M, 3), and nodes of each edge, (E, 2 or 3).

    Ends, the lower number first, then the node between.
    """
    width = 2 if triangles.shape[1] == 3 else 3
    every = triangles[:, EDGES[:, :width]].reshape(-1, width)
    low, high = np.minimum(every[:, 0], every[:, 1]), np.maximum(every[:, 0], every[:, 1])
    _, first, number = np.unique(low * (int(high.max()) + 1) + high, return_index=True, return_inverse=True)
    edges = np.stack([low, high, every[:, -1]][:width], axis=1)[first]
    return number.reshape(-1, 3), edges


def refine(points: Array, triangles: Indices, size: Callable[[Array], Array]) -> tuple[Array, Indices]:
    """Bisect triangles until no edge is longer than the given size at its middle.

    Triangles of six nodes; `size` of points (K, 2) gives the longest edge there, m. New points at the end.
    """
    while True:
        _, edges = edge_numbers(triangles)
        wanted = cell_areas(points, triangles[:, :3]) / size(points[triangles[:, :3]].mean(axis=1)) ** 2
        if max(float(wanted.sum()), len(points)) > MOST_NODES:
            raise InputError("size", float(wanted.sum()), "coarser: above a million nodes")
        length = np.hypot(*(points[edges[:, 1]] - points[edges[:, 0]]).T)
        # Chords of curved edges shrink by a little less than half.
        long = length > size(points[edges[:, 2]]) * (1.0 + 1e-9)
        if not long.any():
            return points, triangles
        points, triangles = bisect(points, triangles, long)


def bisect(points: Array, triangles: Indices, marked: NDArray[np.bool_]) -> tuple[Array, Indices]:
    """Halve the marked edges, in the order of `edge_numbers`, and the longest edges of the triangles touched.

    The halves are halved once more if another edge of theirs is: no angle becomes less than half of the
    smallest.
    """
    number, edges = edge_numbers(triangles)
    length = np.sum((points[edges[:, 1]] - points[edges[:, 0]]) ** 2, axis=1)
    rank = np.empty(len(edges), dtype=np.int64)
    rank[np.argsort(length, kind="stable")] = np.arange(len(edges))
    longest = np.argmax(rank[number], axis=1)
    base = number[np.arange(len(number)), longest]
    marked = marked.copy()
    while True:
        more = marked[number].any(axis=1) & ~marked[base]
        if not more.any():
            break
        marked[base[more]] = True
    if len(points) + 4 * int(marked.sum()) > MOST_NODES:
        raise InputError("size", len(points) + 4 * int(marked.sum()), "coarser: above a million nodes")
    triangles = np.take_along_axis(triangles, TURNED[longest], axis=1)
    number = np.take_along_axis(number, TURNED[longest, :3], axis=1)
    # New nodes at a quarter and at three quarters of each marked edge, from its lower end.
    made = _at_quarters(points, edges[marked])
    quarters = np.full((len(edges), 2), -1, dtype=np.int64)
    quarters[marked] = len(points) + np.arange(len(made)).reshape(-1, 2)
    points = np.concatenate([points, made])
    # First across the longest edge; then each half across the old edge that it kept.
    for _ in range(2):
        points, triangles, number = _halve(points, triangles, number, marked, quarters)
    return points, triangles


def _at_quarters(points: Array, edges: Indices) -> Array:
    """Points at a quarter and at three quarters of each quadratic edge, in turn, shape (2 E, 2)."""
    low, high, middle = points[edges].transpose(1, 0, 2)
    quarter = 0.375 * low + 0.75 * middle - 0.125 * high
    three = 0.375 * high + 0.75 * middle - 0.125 * low
    return np.stack([quarter, three], axis=1).reshape(-1, 2)


def _halve(
    points: Array, triangles: Indices, number: Indices, marked: NDArray[np.bool_], quarters: Indices
) -> tuple[Array, Indices, Indices]:
    """Halve the triangles whose first edge is marked; each half starts with the old edge that it kept."""
    split = marked[number[:, 0]] & (number[:, 0] >= 0)
    a, b, c, ab, bc, ca = triangles[split].T
    first, onward, back = number[split].T
    inner = len(points) + np.arange(len(a))
    # The quadratic map at the barycentric coordinates 1/4, 1/4, 1/2.
    middle = 0.25 * points[ab] + 0.5 * (points[bc] + points[ca]) - 0.125 * (points[a] + points[b])
    low_first = a < b
    near_a = np.where(low_first, quarters[first, 0], quarters[first, 1])
    near_b = np.where(low_first, quarters[first, 1], quarters[first, 0])
    halves = [np.stack([c, a, ab, ca, near_a, inner], 1), np.stack([b, c, ab, bc, inner, near_b], 1)]
    # New edges are not to be halved: they carry the number -1.
    none = np.full(len(a), -1)
    numbers = [np.stack([back, none, none], 1), np.stack([onward, none, none], 1)]
    return (
        np.concatenate([points, middle]),
        np.concatenate([triangles[~split], *halves]),
        np.concatenate([number[~split], *numbers]),
    )


# Parabolas through three points of an arc as long as a quarter of the radius leave it by less, of the radius.
_ON_CIRCLE = 1e-5

# The quadratic map at the middles between the nodes 3-4, 4-5 and 5-3 of a triangle.
_INNER = np.array(
    [
        [-0.125, 0.0, -0.125, 0.5, 0.5, 0.25],
        [-0.125, -0.125, 0.0, 0.25, 0.5, 0.5],
        [0.0, -0.125, -0.125, 0.5, 0.25, 0.5],
    ]
)


def halved(liquid: LiquidSection) -> LiquidSection:
    """The same liquid with its quadratic triangles quartered; walls and surface keep their shape."""
    if liquid.cells.shape[1] != 6:
        raise InputError("liquid", liquid.cells.shape, "a mesh of quadratic triangles")
    points, cells = _quartered(liquid.points, liquid.cells)
    # New nodes on the parabolas through three points of the circle are put onto it.
    a, away = liquid.surface_radius, np.hypot(*points.T)
    free = free_sides(cells)
    on_circle = np.unique(free[np.all(np.abs(away[free] - a) <= _ON_CIRCLE * a, axis=1)])
    points[on_circle] *= (a / away[on_circle])[:, None]
    return liquid_section(points, cells, a)


def straightened(liquid: LiquidSection) -> LiquidSection:
    """The same triangles with straight sides."""
    used, corners = np.unique(liquid.cells[:, :3], return_inverse=True)
    return liquid_section(liquid.points[used], corners.reshape(-1, 3), liquid.surface_radius)


def _quartered(points: Array, cells: Indices) -> tuple[Array, Indices]:
    """Points, with new ones at the end, and the four parts of each triangle."""
    number, edges = edge_numbers(cells)
    inside = np.einsum("ji,mix->mjx", _INNER, points[cells])
    first = len(points)
    forward = cells[:, :3] < np.roll(cells[:, :3], -1, axis=1)
    near = first + 2 * number + ~forward  # the start of each edge
    far = first + 2 * number + forward
    p, q, r, pq, qr, rp = cells.T
    across_q, across_r, across_p = (first + 2 * len(edges) + np.arange(3 * len(cells)).reshape(-1, 3)).T
    parts = [
        [p, pq, rp, near[:, 0], across_p, far[:, 2]],
        [pq, q, qr, far[:, 0], near[:, 1], across_q],
        [rp, qr, r, across_r, far[:, 1], near[:, 2]],
        [pq, qr, rp, across_q, across_r, across_p],
    ]
    return (
        np.concatenate([points, _at_quarters(points, edges), inside.reshape(-1, 2)]),
        np.concatenate([np.stack(part, axis=1) for part in parts]).astype(np.int64),
    )
