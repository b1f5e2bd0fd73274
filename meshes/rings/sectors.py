"""Sections of sectors: the compartments that full radial baffles make of a chamber."""

from __future__ import annotations

import math

import numpy as np

from meshes.arrays import Indices
from meshes.baffles import Baffles
from meshes.errors import InputError, require_few_nodes, require_not_negative, require_positive
from meshes.quality import EDGES
from meshes.section import Section


def compartment(
    baffles: Baffles,
    number: int,
    radius: float,
    inner_radius: float = 0.0,
    segments: int = 32,
) -> Section:
    """Section between a baffle, counted from 0, and the next one, taken as walls from circle to circle.

    A single baffle leaves the whole chamber, slit along it; the baffles' lengths do not matter.
    """
    if not 0 <= number < baffles.count:
        raise InputError("number", number, f"0 to {baffles.count - 1}")
    angle = 2.0 * math.pi / baffles.count
    start = baffles.first_angle + number * angle
    return sector(radius, start, angle, inner_radius, segments)


def sector(
    radius: float,
    start: float,
    angle: float,
    inner_radius: float = 0.0,
    segments: int = 32,
    *,
    order: int = 2,
) -> Section:
    """Part of a disc (inner radius 0) or an annulus from the ray at `start` over `angle` to another, rad.

    `segments` are triangles along the outer wall.
    """
    _check(radius, start, angle, inner_radius, segments, order)
    require_few_nodes("segments", segments, segments * order**2)
    width, gap = radius * angle / segments, radius - inner_radius
    # The triangles of a narrow sector are longer than wide.
    rows = max(1, min(round(gap / width), 4 * segments))
    radii = np.linspace(radius, inner_radius, rows + 1)
    counts = np.maximum(1, np.rint(segments * radii / radius).astype(np.int64))
    # Across a narrow gap the nodes of both walls stay aligned; edges of 60 degrees are the longest.
    counts = np.maximum(counts, math.ceil(angle / (math.pi / 3.0)))
    counts = np.full(rows + 1, segments) if gap < width else counts
    counts[-1] = 0 if inner_radius == 0.0 else counts[-1]
    require_few_nodes("segments", segments, order**2 * float(counts.sum()))
    first = np.concatenate([[0], np.cumsum(counts + 1)])
    turn = np.concatenate([np.linspace(0.0, 1.0, n + 1) for n in counts])
    r, theta = np.repeat(radii, counts + 1), start + angle * turn
    triangles = np.concatenate([_strip(*counts[k : k + 2], *first[k : k + 2]) for k in range(rows)])
    points = np.stack([r * np.cos(theta), r * np.sin(theta)], axis=1)
    if order == 1:
        return Section(points, triangles)
    ends = np.sort(triangles[:, EDGES[:, :2]].reshape(-1, 2), axis=1)
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    tail, head = edges.T
    middle = 0.5 * (r[tail] + r[head]), 0.5 * (theta[tail] + theta[head])
    bent = np.stack([middle[0] * np.cos(middle[1]), middle[0] * np.sin(middle[1])], axis=1)
    # Edges follow the polar coordinates, which keeps thin layers unfolded, except towards the axis.
    near_axis = np.minimum(r[tail], r[head]) < 0.5 * np.maximum(r[tail], r[head])
    middles = np.where(near_axis[:, None], 0.5 * (points[tail] + points[head]), bent)
    midside = len(points) + number.reshape(-1, 3)
    return Section(np.concatenate([points, middles]), np.concatenate([triangles, midside], axis=1))


def _strip(outer: int, inner: int, outer_first: int, inner_first: int) -> Indices:
    """Triangles between two rows of nodes: each edge of one is joined to the nearest node of the other."""
    i, k = np.arange(outer), np.arange(inner)
    outer_middles, inner_middles = (i + 0.5) / outer, (k + 0.5) / max(inner, 1)
    inner_apex = np.searchsorted(inner_middles, outer_middles, side="left")
    outer_apex = np.searchsorted(outer_middles, inner_middles, side="right")
    outwards = np.stack([outer_first + i, outer_first + i + 1, inner_first + inner_apex], axis=1)
    inwards = np.stack([inner_first + k + 1, inner_first + k, outer_first + outer_apex], axis=1)
    return np.concatenate([outwards, inwards]).astype(np.int64)


def _check(radius: float, start: float, angle: float, inner_radius: float, segments: int, order: int) -> None:
    require_positive("radius", radius)
    require_not_negative("inner_radius", inner_radius)
    if inner_radius >= radius:
        raise InputError("inner_radius", inner_radius, f"below radius ({radius:g} m)")
    if not math.isfinite(start):
        raise InputError("start", start, "a finite angle in radians")
    if not 0.0 < angle <= 2.0 * math.pi * (1.0 + 1e-12):
        raise InputError("angle", angle, "above 0, 2 pi at most")
    if segments != int(segments) or segments < max(1, math.ceil(angle / (math.pi / 3.0))):
        raise InputError("segments", segments, "a whole number, 1 or more, each of 60 degrees at most")
    if order not in (1, 2):
        raise InputError("order", order, "1 (straight edges) or 2 (quadratic edges)")
