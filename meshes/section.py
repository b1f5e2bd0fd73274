"""Sections of chambers: triangulations of the plane across the axis, with straight or curved edges."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Indices
from meshes.errors import MOST_NODES, InputError, require_few_nodes, require_not_negative, require_positive
from meshes.quality import EDGES, jacobians, triangle_areas

_FULL_DEPTH = math.sqrt(3.0) / 2.0  # a ring of equilateral triangles is that deep, over their width


@dataclass(frozen=True, eq=False)
class Section:
    """Triangulated section of a chamber; the arrays are checked, copied and cannot be written to."""

    points: Array  #: nodes, shape (N, 2), m, from the chamber's geometric axis
    #: node numbers, counter-clockwise: shape (M, 3) for straight edges; (M, 6) for curved ones, the three
    #: vertices, then the nodes on the edges 0-1, 1-2, 2-0
    triangles: Indices

    def __post_init__(self) -> None:
        points = np.array(self.points, dtype=np.float64)
        numbers = np.array(self.triangles)
        _check_arrays(points, numbers)
        triangles = numbers.astype(np.int64)
        _check_shapes(points, triangles)
        _check_edges(triangles)
        points.setflags(write=False)
        triangles.setflags(write=False)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "triangles", triangles)

    @property
    def order(self) -> int:
        """1 for straight edges, 2 for quadratic ones."""
        return 1 if self.triangles.shape[1] == 3 else 2


def section_area(section: Section) -> float:
    """Area of a section, m^2, exact for its straight or quadratic edges."""
    return float(triangle_areas(section.points, section.triangles).sum())


def disc(
    radius: float,
    segments: int = 64,
    *,
    order: int = 1,
    wall_layer: float | None = None,
    growth: float = 1.3,
) -> Section:
    """Disc about the origin, with a node on the x axis; with straight edges an inscribed polygon.

    `wall_layer` is the largest depth of the triangles at the wall, m (None: as deep as wide), `growth` the
    depth of a ring of triangles over that of the ring outside it.
    """
    return annulus(radius, 0.0, segments, order=order, wall_layer=wall_layer, growth=growth)


def annulus(
    radius: float,
    inner_radius: float,
    segments: int = 64,
    *,
    order: int = 1,
    wall_layer: float | None = None,
    growth: float = 1.3,
) -> Section:
    """Annulus about the origin, with a node of the outer wall on the x axis; a disc without an inner radius.

    Edges of both walls are equally long; the rest as in `disc`.
    """
    _check_request(radius, inner_radius, segments, order, wall_layer, growth)
    radii, counts = _rings(radius, inner_radius, segments, wall_layer, growth)
    require_few_nodes("segments", segments, order**2 * float(counts.sum()))
    # Rings of equal count stay aligned, which keeps thin layers free of inverted triangles; where the
    # count changes, every other ring is turned by half a step.
    turns = np.cumsum(np.diff(counts, prepend=counts[0]) != 0) % 2 * 0.5
    first = np.concatenate([[0], np.cumsum(counts)])
    rings = range(len(counts))
    angles = [2.0 * math.pi * (np.arange(counts[j]) + turns[j]) / counts[j] for j in rings]
    points = [radii[j] * np.stack([np.cos(angles[j]), np.sin(angles[j])], axis=1) for j in rings]
    triangles = [
        _stitch(counts[j], turns[j], first[j], counts[j + 1], turns[j + 1], first[j + 1])
        for j in range(len(counts) - 1)
    ]
    if inner_radius == 0.0:
        last = first[-2] + np.arange(counts[-1])
        centre = np.full(counts[-1], first[-1])
        points.append(np.zeros((1, 2)))
        triangles.append(np.stack([last, np.roll(last, -1), centre], axis=1))
    nodes, corners = np.concatenate(points), np.concatenate(triangles)
    if order == 1:
        return Section(nodes, corners)
    # Edges bend with the wall wherever the layers may be thinner than the bulge of a wall edge, and on
    # both walls.
    aligned = int(np.argmin(np.append(counts == segments, False)))
    bent = np.zeros(len(nodes), dtype=np.int64)
    bent[: first[aligned]] = 1
    if inner_radius > 0.0 and aligned < len(counts):
        bent[first[-2] :] = 2
    return _quadratic(nodes, corners, bent)


def _rings(
    radius: float, inner_radius: float, segments: int, wall_layer: float | None, growth: float
) -> tuple[Array, Indices]:
    """Radii of the rings of nodes from the outer wall inwards (without the centre), and their counts."""
    gap = radius - inner_radius
    width = 2.0 * math.pi * radius / segments
    # Across a narrow gap the nodes of both walls stay aligned.
    inner_count = segments if gap < width else max(8, round(segments * inner_radius / radius))
    inner_width = 2.0 * math.pi * inner_radius / inner_count if inner_radius > 0.0 else math.inf
    depths: list[float] = []
    depth, left = min(wall_layer or math.inf, _FULL_DEPTH * width), gap
    while left > 1e-9 * gap:
        # Towards a narrow inner wall the rings get thinner again.
        depths.append(min(depth, _FULL_DEPTH * inner_width + 0.3 * left))
        left -= depths[-1]
        depth *= growth
        if 8 * len(depths) + segments > MOST_NODES:
            raise InputError("segments", segments, "fewer, or growth larger: above a million nodes")
    widths = np.maximum(width, np.array([depths[0], *depths]) / _FULL_DEPTH)
    layers = np.logical_and.accumulate(widths <= width * (1.0 + 1e-9)) & (wall_layer is not None)
    radii = radius - np.cumsum([0.0, *depths]) * (gap / math.fsum(depths))
    counts = np.rint(2.0 * np.pi * radii / widths).astype(np.int64)
    counts = np.where(layers, segments, np.clip(counts, 6, segments))
    counts[0] = segments
    if inner_radius == 0.0:
        return radii[:-1], counts[:-1]
    radii[-1] = inner_radius
    counts[-1] = segments if layers[-1] else inner_count
    return radii, counts


def _stitch(
    outer: int, outer_turn: float, outer_first: int, inner: int, inner_turn: float, inner_first: int
) -> Indices:
    """Triangles between two rings: each edge of one is joined to the nearest node of the other.

    Edges of both are taken in the order of their middles; ties go to the outer ring.
    """
    outer_middles = (np.arange(outer) + 0.5 + outer_turn) / outer
    inner_middles = (np.arange(inner) + 0.5 + inner_turn) / inner
    i, k = np.arange(outer), np.arange(inner)
    inner_apex = np.searchsorted(inner_middles, outer_middles, side="left") % inner
    outer_apex = np.searchsorted(outer_middles, inner_middles, side="right") % outer
    outwards = np.stack([outer_first + i, outer_first + (i + 1) % outer, inner_first + inner_apex], axis=1)
    inwards = np.stack([inner_first + (k + 1) % inner, inner_first + k, outer_first + outer_apex], axis=1)
    return np.concatenate([outwards, inwards])


def _quadratic(points: Array, corners: Indices, bent: Indices) -> Section:
    """Add midside nodes: on the chord, or on the arc between two nodes of the same `bent` group above 0."""
    ends = np.sort(corners[:, EDGES[:, :2]].reshape(-1, 2), axis=1)
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    middles = 0.5 * (a + b)
    curved = (bent[edges[:, 0]] > 0) & (bent[edges[:, 0]] == bent[edges[:, 1]])
    ra, rb = np.hypot(*a[curved].T)[:, None], np.hypot(*b[curved].T)[:, None]
    along = a[curved] / ra + b[curved] / rb
    middles[curved] = 0.5 * (ra + rb) * along / np.hypot(*along.T)[:, None]
    midside = len(points) + number.reshape(-1, 3)
    return Section(np.concatenate([points, middles]), np.concatenate([corners, midside], axis=1))


def _check_request(
    radius: float, inner_radius: float, segments: int, order: int, wall_layer: float | None, growth: float
) -> None:
    require_positive("radius", radius)
    require_not_negative("inner_radius", inner_radius)
    if inner_radius >= radius:
        raise InputError("inner_radius", inner_radius, f"below radius ({radius:g} m)")
    if segments < 8 or segments != int(segments):
        raise InputError("segments", segments, "a whole number, 8 or more")
    if order not in (1, 2):
        raise InputError("order", order, "1 (straight edges) or 2 (quadratic edges)")
    if wall_layer is not None:
        require_positive("wall_layer", wall_layer)
        if wall_layer < 1e-6 * radius:
            raise InputError("wall_layer", wall_layer, f"a millionth of the radius or more ({radius:g} m)")
    if not 1.0 <= growth <= 2.0:
        raise InputError("growth", growth, "1 to 2")


def _check_arrays(points: Array, triangles: ArrayLike) -> None:
    numbers = np.asarray(triangles)
    if points.ndim != 2 or points.shape[1] != 2:
        raise InputError("points", points.shape, "an array of shape (N, 2)")
    if not np.all(np.isfinite(points)):
        raise InputError("points", "a value that is not finite", "finite coordinates in metres")
    if numbers.ndim != 2 or numbers.shape[1] not in (3, 6) or len(numbers) == 0:
        raise InputError("triangles", numbers.shape, "an array of shape (M, 3) or (M, 6), M above 0")
    if not np.issubdtype(numbers.dtype, np.integer):
        raise InputError("triangles", str(numbers.dtype), "an array of whole numbers")
    if numbers.min() < 0 or numbers.max() >= len(points):
        outside = numbers.max() if numbers.min() >= 0 else numbers.min()
        raise InputError("triangles", int(outside), f"node numbers from 0 to {len(points) - 1}")


def _check_shapes(points: Array, triangles: Indices) -> None:
    corners = points[triangles[:, :3]]
    longest = np.max(np.sum((corners - np.roll(corners, 1, axis=1)) ** 2, axis=2), axis=1)
    # A needle thinner than this fraction of its length is lost in the rounding of its coordinates.
    bad = np.flatnonzero(jacobians(points, triangles).min(axis=1) <= 1e-12 * longest)
    if len(bad):
        k = int(bad[0])
        where = corners[k].mean(axis=0)
        raise InputError(
            "triangles",
            f"{len(bad)} of {len(triangles)}, the first number {k} near ({where[0]:g}, {where[1]:g}) m",
            "counter-clockwise, with an area, and not folded by their midside nodes",
        )


def _check_edges(triangles: Indices) -> None:
    directed = triangles[:, EDGES[:, :2]].reshape(-1, 2)
    if len(np.unique(directed, axis=0)) < len(directed):
        raise InputError("triangles", "an edge with two triangles on the same side", "free of overlaps")
    if triangles.shape[1] == 3:
        return
    ends = np.sort(directed, axis=1)
    middles = triangles[:, EDGES[:, 2]].reshape(-1, 1)
    edges = len(np.unique(ends, axis=0))
    pairs = len(np.unique(np.concatenate([ends, middles], axis=1), axis=0))
    if not edges == pairs == len(np.unique(middles)) or np.isin(middles, ends).any():
        raise InputError("triangles", "edges that share or lack midside nodes", "one midside node per edge")
