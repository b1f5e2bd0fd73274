"""Every triangle of a mesh of liquid into four like it, so that errors of two meshes tell of a third."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshes.bisection import edge_numbers
from meshes.border import InputError
from meshes.liquid_section import LiquidSection, free_sides, liquid_section

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

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
    """The same liquid with all sides half as long; walls keep their shape, the surface its circle.

    Parameters
    ----------
    liquid : with quadratic triangles

    Returns
    -------
    Four triangles for each.

    Raises
    ------
    InputError : other cells
    """
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
    """The same triangles with straight sides.

    Parameters
    ----------
    liquid : with triangles
    """
    used, corners = np.unique(liquid.cells[:, :3], return_inverse=True)
    return liquid_section(liquid.points[used], corners.reshape(-1, 3), liquid.surface_radius)


def _quartered(points: Array, cells: Indices) -> tuple[Array, Indices]:
    """Points, with new ones at the end, and the four parts of each triangle."""
    number, edges = edge_numbers(cells)
    low, high, middle = points[edges].transpose(1, 0, 2)
    quarter = 0.375 * low + 0.75 * middle - 0.125 * high
    three = 0.375 * high + 0.75 * middle - 0.125 * low
    inside = np.einsum("ji,mix->mjx", _INNER, points[cells])
    first = len(points)
    forward = cells[:, :3] < np.roll(cells[:, :3], -1, axis=1)
    near = first + 2 * number + ~forward  # the start of each edge
    far = first + 2 * number + forward
    p, q, r, pq, qr, rp = cells.T
    one, two, three_ = (first + 2 * len(edges) + np.arange(3 * len(cells)).reshape(-1, 3)).T
    parts = [
        [p, pq, rp, near[:, 0], three_, far[:, 2]],
        [pq, q, qr, far[:, 0], near[:, 1], one],
        [rp, qr, r, two, far[:, 1], near[:, 2]],
        [pq, qr, rp, one, two, three_],
    ]
    made = np.stack([quarter, three], axis=1).reshape(-1, 2)
    return (
        np.concatenate([points, made, inside.reshape(-1, 2)]),
        np.concatenate([np.stack(part, axis=1) for part in parts]).astype(np.int64),
    )
