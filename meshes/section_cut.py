"""Sections cut along circles: refined, made to follow them, and refined again where cells come out folded."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from meshes.bisection import quadratic_triangles, refine
from meshes.circle_cut import Circle, follow_circle
from meshes.quality import jacobians
from meshes.section import Section

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Rounds of halving where cells come out folded, and how fast edges may grow from there.
_ROUNDS, _SLOPE = 12, 0.25


def cut_along(
    section: Section,
    size: Callable[[Array], Array],
    circles: Callable[[Array, Indices], Sequence[Circle]],
    *,
    outside: bool,
) -> tuple[Array, Indices]:
    """Quadratic triangulation of a section with edges along circles.

    Parameters
    ----------
    section : the section
    size : longest edge at some points, shape (K, 2) -> (K,), m
    circles : the circles, given the refined points and triangles
    outside : whether to drop what lies inside the last circle

    Returns
    -------
    Points, some of them unused, shape (N, 2), m, and triangles, shape (M, 6); M may be 0. Cells may still be
    folded if a wall touches a circle.
    """
    start = quadratic_triangles(section)
    spots = np.empty((0, 3))

    def longest(at: Array) -> Array:
        found = size(at)
        for x, y, limit in spots:
            found = np.minimum(found, limit + _SLOPE * np.hypot(at[:, 0] - x, at[:, 1] - y))
        return found

    for _ in range(_ROUNDS):
        points, triangles = refine(*start, longest)
        beyond = np.ones(len(triangles), dtype=bool)
        followed = circles(points, triangles)
        for circle in followed:
            held = np.zeros(len(points), dtype=bool)
            for other in followed:
                held |= np.abs(other.beyond(points)) <= 1e-11 * other.radius
            points, triangles, beyond = follow_circle(points, triangles, circle, held)
        kept = triangles[beyond] if outside else triangles
        folded = kept[jacobians(points, kept).min(axis=1) <= 0.0]
        if not len(folded):
            break
        # Where a wall meets a circle at a small angle, its arcs must be short not to reach the wall.
        corners = points[folded[:, :3]]
        edges = np.sqrt(np.max(np.sum((np.roll(corners, 1, axis=1) - corners) ** 2, axis=2), axis=1))
        spots = np.concatenate([spots, np.column_stack([corners.mean(axis=1), 0.4 * edges])])
    return points, kept
