"""The body of liquid under a wave that is the same at every height of a circular chamber."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Indices
from meshes.bodies.body import Body, columns
from meshes.errors import InputError, require_few_nodes, require_positive
from meshes.rings.triangles import polar_triangles

# Most that a quadratic edge leaves its chord by, over the smaller thickness at its ends.
_BEND = 0.25

# Layers thinner than this fraction of the wall's radius are dry.
_DRY = 1e-9


def wave_body(
    radius: float,
    height: float,
    surface_radius: ArrayLike,
    angles: ArrayLike | None = None,
    *,
    across: int = 3,
    layers: int = 2,
    order: int = 2,
) -> Body:
    """Liquid between the wall r = R and the free surface r = r_s(theta), from floor to lid.

    r_s, R where the wall is dry, at 8 or more rising angles within one turn (None: even from 0); an even
    number for quadratic edges, every other sample between the ends of an edge.
    """
    inner = np.array(surface_radius, dtype=np.float64)
    count = inner.size
    theta = (
        2.0 * np.pi * np.arange(count) / max(count, 1)
        if angles is None
        else np.array(angles, dtype=np.float64)
    )
    _check(radius, height, inner, theta, across, layers, order)
    require_few_nodes("across", across, 2.0 * count * (2.0 * across + 1.0))
    thickness = np.where(inner > radius * (1.0 - _DRY), 0.0, radius - inner)
    if not thickness.any():
        raise InputError("surface_radius", radius, "below radius somewhere: there is no liquid")
    if order == 2:
        thickness[1::2] = _between(thickness[::2], thickness[1::2])
    else:
        theta, thickness = _doubled(theta, thickness)
    share = np.linspace(0.0, 1.0, 2 * across + 1)[:, None]
    r = radius - (1.0 - share) * thickness
    points = np.stack([r * np.cos(theta), r * np.sin(theta)], axis=-1).reshape(-1, 2)
    around = len(theta)
    row, column = np.divmod(np.arange(len(points)), around)
    cells = _merged(row, column, thickness)[polar_triangles(2 * across, around, 2)]
    corners = np.sort(cells[:, :3], axis=1)
    cells = cells[np.all(corners[:, 1:] != corners[:, :-1], axis=1)]
    shore = row == 0
    none = np.zeros(len(points), dtype=bool)
    depth = np.full(len(points), height)
    return columns(points, cells, depth, height, none, shore, layers=layers, order=order)


def _merged(row: Indices, column: Indices, thickness: Array) -> Indices:
    """Number of each node of the grid: where the wall is dry, all nodes of a ray are one.

    The cell beside it is a triangle: its diagonal has become a side and takes that side's middle.
    """
    dry = thickness == 0.0
    before, after = np.roll(dry, 1)[column], np.roll(dry, -1)[column]
    middle = (row % 2 == 1) & (column % 2 == 1)
    row = np.where(middle & after, row - 1, np.where(middle & before, row + 1, row))
    return np.where(dry[column], column, row * len(thickness) + column)


def _between(ends: Array, samples: Array) -> Array:
    """Thickness between the ends of quadratic edges: the samples, but for what would fold the cells there."""
    after = np.roll(ends, -1)
    middle = 0.5 * (ends + after)
    shore = (ends == 0.0) | (after == 0.0)
    bend = _BEND * np.minimum(ends, after)
    return np.where(shore, middle, np.clip(samples, middle - bend, middle + bend))


def _doubled(theta: Array, thickness: Array) -> tuple[Array, Array]:
    """Samples with the middles between them, the last and the first among them."""
    after = np.append(theta[1:], theta[0] + 2.0 * math.pi)
    angles = np.stack([theta, 0.5 * (theta + after)], axis=1).ravel()
    return angles, np.stack([thickness, 0.5 * (thickness + np.roll(thickness, -1))], axis=1).ravel()


def _check(
    radius: float, height: float, inner: Array, theta: Array, across: int, layers: int, order: int
) -> None:
    require_positive("radius", radius)
    require_positive("height", height)
    if inner.ndim != 1 or len(inner) < 8:
        raise InputError("surface_radius", inner.shape, "an array of shape (n,), n 8 or more")
    if not (np.all(np.isfinite(inner)) and inner.min() > 0.0 and inner.max() <= radius * (1.0 + 1e-12)):
        raise InputError("surface_radius", float(inner.min()), f"above 0, radius ({radius:g} m) at most")
    turn = np.diff(theta, append=theta[:1] + 2.0 * math.pi)
    if theta.shape != inner.shape or not (
        np.all(np.isfinite(theta)) and np.all(turn > 0.0) and turn.max() < 1.0
    ):
        raise InputError("angles", theta.shape, "rising within one turn, one for each sample")
    for name, value in (("across", across), ("layers", layers)):
        if value < 1 or value != int(value):
            raise InputError(name, value, "a whole number, 1 or more")
    if order not in (1, 2):
        raise InputError("order", order, "1 (straight edges) or 2 (quadratic edges)")
    if order == 2 and len(inner) % 2:
        raise InputError("surface_radius", len(inner), "an even number of samples for quadratic edges")
