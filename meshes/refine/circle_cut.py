"""Triangulations made to follow a circle: nodes near it are moved onto it, crossed triangles are split."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array, Indices
from meshes.quality import jacobians
from meshes.refine.bisection import TURNED, bisect, edge_numbers, quadratic_triangles, refine
from meshes.section import Section

# A vertex moves onto the circle from within this fraction of its shortest edge.
_REACH = 0.3

# Walls that turn by less than this at a vertex, rad, are smooth: the vertex may slide along them.
_SMOOTH = 0.02

# Vertices nearer than this fraction of the radius are on the circle.
_ON_CIRCLE = 1e-12

# Rounds of halving where cells come out folded, and how fast edges may grow from there.
_ROUNDS, _SLOPE = 12, 0.25


@dataclass(frozen=True)
class Circle:
    """A circle: its centre, m, and its radius, m."""

    x: float
    y: float
    radius: float

    def beyond(self, points: Array) -> Array:
        """Distance of points from the circle, m, positive outside, shape (N,)."""
        return np.asarray(np.hypot(points[..., 0] - self.x, points[..., 1] - self.y) - self.radius)

    def project(self, points: Array) -> Array:
        """Nearest points of the circle."""
        centre = np.array([self.x, self.y])
        away = points - centre
        return np.asarray(centre + self.radius * away / np.hypot(away[..., 0], away[..., 1])[..., None])


def follow_circle(
    points: Array, triangles: Indices, circle: Circle, locked: NDArray[np.bool_] | None = None
) -> tuple[Array, Indices, NDArray[np.bool_]]:
    """Make the edges of a triangulation follow a circle; which triangles lie outside it, shape (M,).

    The triangles near the circle must be small against its radius. Edges on it become quadratic arcs; walls
    keep their shape, but for smooth ones, where a vertex may slide along. `locked` vertices do not move.
    """
    fixed = np.zeros(len(points), dtype=bool) if locked is None else locked.copy()
    points, triangles = _split_double_crossings(points, triangles, circle)
    fixed = np.append(fixed, np.zeros(len(points) - len(fixed), dtype=bool))
    points, on_circle = _snap(points, triangles, circle, fixed)
    sign = np.sign(circle.beyond(points))
    sign[on_circle] = 0.0
    points, triangles, outside = _split(points, triangles, circle, sign)
    return _bend_onto(points, triangles, outside, circle), triangles, outside


def _curve(points: Array, edges: Indices, t: Array) -> Array:
    """Points of edges at 0 <= t <= 1 from their first node."""
    start, end, middle = points[edges].transpose(1, 0, 2)
    t = t[:, None]
    at = (1.0 - t) * (1.0 - 2.0 * t) * start + t * (2.0 * t - 1.0) * end + 4.0 * t * (1.0 - t) * middle
    return np.asarray(at)


def _split_double_crossings(points: Array, triangles: Indices, circle: Circle) -> tuple[Array, Indices]:
    """Halve edges that dip into the circle, or out of it, between two ends on the same side."""
    for _ in range(8):
        _, edges = edge_numbers(triangles)
        ends = circle.beyond(points[edges[:, :2]])
        length = np.hypot(*(points[edges[:, 1]] - points[edges[:, 0]]).T)
        inner = np.stack(
            [circle.beyond(_curve(points, edges, np.full(len(edges), k / 8))) for k in range(1, 8)]
        )
        # Ends that will be moved onto the circle are left alone.
        clear = np.abs(ends).min(axis=1) > _REACH * length
        same = np.sign(ends[:, 0]) == np.sign(ends[:, 1])
        double = clear & same & np.any(np.sign(inner) != np.sign(ends[:, 0]), axis=0)
        if not double.any():
            break
        points, triangles = bisect(points, triangles, double)
    return points, triangles


def _crossing(points: Array, edges: Indices, circle: Circle) -> Array:
    """Where edges whose ends lie on different sides cross the circle, t in (0, 1)."""
    low, high = np.zeros(len(edges)), np.ones(len(edges))
    side = np.sign(circle.beyond(points[edges[:, 0]]))
    for _ in range(54):  # one bit of t at a time
        middle = 0.5 * (low + high)
        before = np.sign(circle.beyond(_curve(points, edges, middle))) == side
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.asarray(0.5 * (low + high))


def _snap(
    points: Array, triangles: Indices, circle: Circle, locked: NDArray[np.bool_]
) -> tuple[Array, NDArray[np.bool_]]:
    """Move the vertices near the circle onto it, unless this spoils a triangle."""
    number, edges = edge_numbers(triangles)
    free = np.bincount(number.ravel(), minlength=len(edges)) == 1
    away = circle.beyond(points)
    length = np.hypot(*(points[edges[:, 1]] - points[edges[:, 0]]).T)
    shortest = np.full(len(points), np.inf)
    for end in (0, 1):
        np.minimum.at(shortest, edges[:, end], length)
    vertex = np.isfinite(shortest)
    on_wall = np.zeros(len(points), dtype=bool)
    on_wall[edges[free, :2]] = True
    exact = vertex & (np.abs(away) <= _ON_CIRCLE * circle.radius)
    shortest[~vertex] = 0.0
    moved = vertex & ~on_wall & ~locked & ~exact & (np.abs(away) < _REACH * shortest)
    target = points.copy()
    target[moved] = circle.project(points[moved])
    slid, at = _slides(points, edges[free], circle, locked | exact)
    target[slid] = at
    moved[slid] = True
    before = jacobians(points, triangles).min(axis=1)
    while True:
        placed = _placed(points, edges, free, np.where(moved[:, None], target, points), moved, circle)
        spoilt = jacobians(placed, triangles).min(axis=1) < 0.2 * before
        spoilt &= moved[triangles[:, :3]].any(axis=1)
        if not spoilt.any():
            return placed, moved | exact
        moved[triangles[spoilt, :3]] = False


def _slides(
    points: Array, walls: Indices, circle: Circle, locked: NDArray[np.bool_]
) -> tuple[Indices, Array]:
    """Wall vertices that may slide along their wall to a crossing nearby, and where to."""
    side = np.sign(circle.beyond(points[walls[:, :2]]))
    crossed = np.flatnonzero(side[:, 0] * side[:, 1] < 0.0)
    t = _crossing(points, walls[crossed], circle)
    near = np.minimum(t, 1.0 - t) < _REACH
    crossed, t = crossed[near], t[near]
    vertex = walls[crossed, np.where(t < 0.5, 0, 1)]
    at = circle.project(_curve(points, walls[crossed], t))
    degree = np.bincount(walls[:, :2].ravel(), minlength=len(points))
    once = np.bincount(vertex, minlength=len(points)) == 1
    smooth = once & (degree == 2) & ~locked & (_turning(points, walls) < _SMOOTH)
    return vertex[smooth[vertex]], at[smooth[vertex]]


def _turning(points: Array, walls: Indices) -> Array:
    """Angle by which the wall turns at each vertex with two wall edges, rad; pi at others."""
    tangents = np.zeros((len(points), 2))
    for first, other in ((0, 1), (1, 0)):
        start, end, middle = points[walls[:, first]], points[walls[:, other]], points[walls[:, 2]]
        leaving = 4.0 * middle - 3.0 * start - end
        np.add.at(tangents, walls[:, first], leaving / np.hypot(*leaving.T)[:, None])
    # Opposite unit vectors add to nothing if the wall is straight: the sum is 2 sin(turn / 2) long.
    half = 0.5 * np.hypot(*tangents.T)
    return np.where(half > 0.0, 2.0 * np.arcsin(np.minimum(half, 1.0)), 0.0)


def _placed(
    points: Array,
    edges: Indices,
    free: NDArray[np.bool_],
    target: Array,
    moved: NDArray[np.bool_],
    circle: Circle,
) -> Array:
    """Nodes with the vertices at their targets and the nodes between taken along."""
    placed = target.copy()
    shift = target - points
    middle = edges[:, 2]
    placed[middle] = points[middle] + 0.5 * (shift[edges[:, 0]] + shift[edges[:, 1]])
    # On a wall the node between stays on the wall as it was, halfway along what is left of the edge.
    wall = edges[free & moved[edges[:, :2]].any(axis=1)]
    chord = points[wall[:, 1]] - points[wall[:, 0]]
    along = [np.sum(shift[wall[:, k]] * chord, axis=1) / np.sum(chord**2, axis=1) for k in (0, 1)]
    start, end = along[0], 1.0 + along[1]
    for k, inside in ((0, along[0] > 0.0), (1, along[1] < 0.0)):
        cut = np.flatnonzero(inside & moved[wall[:, k]])
        side = np.sign(circle.beyond(points[wall[cut, :2]]))
        cut = cut[side[:, 0] * side[:, 1] < 0.0]
        (start, end)[k][cut] = _crossing(points, wall[cut], circle)
    placed[wall[:, 2]] = _curve(points, wall, 0.5 * (start + end))
    return placed


def _split(
    points: Array, triangles: Indices, circle: Circle, sign: Array
) -> tuple[Array, Indices, NDArray[np.bool_]]:
    """Split the triangles with vertices on both sides; all triangles, and which lie outside."""
    number, edges = edge_numbers(triangles)
    crossed = sign[edges[:, 0]] * sign[edges[:, 1]] < 0.0
    t = _crossing(points, edges[crossed], circle)
    cuts = np.full((len(edges), 3), -1, dtype=np.int64)
    count = int(crossed.sum())
    # On a crossed edge: the node on the circle, then those between it and the two ends.
    cuts[crossed] = len(points) + np.arange(3 * count).reshape(-1, 3)
    curves = edges[crossed]
    at = [_curve(points, curves, t), _curve(points, curves, 0.5 * t), _curve(points, curves, 0.5 * (1.0 + t))]
    at[0] = circle.project(at[0])
    points = np.concatenate([points, np.stack(at, axis=1).reshape(-1, 2)])
    signs = sign[triangles[:, :3]]
    both = signs.min(axis=1) * signs.max(axis=1) < 0.0
    lone = both & np.all(signs != 0.0, axis=1)
    whole = ~both
    # A triangle with all vertices on the circle lies within it, as do its chords.
    outside = signs[whole].max(axis=1) > 0.0
    points, corner, corner_out = _cut_corners(points, triangles[lone], number[lone], cuts, signs[lone])
    points, third, third_out = _cut_through(
        points, triangles[both & ~lone], number[both & ~lone], cuts, signs[both & ~lone]
    )
    pieces = np.concatenate([triangles[whole], corner, third])
    return points, pieces, np.concatenate([outside, corner_out, third_out])


def _part(cuts: Indices, edge: Indices, end: Indices, other: Indices) -> Indices:
    """Node between the cut of an edge and one of its ends."""
    return np.asarray(np.where(end < other, cuts[edge, 1], cuts[edge, 2]), dtype=np.int64)


def _cut_corners(
    points: Array, triangles: Indices, number: Indices, cuts: Indices, signs: Array
) -> tuple[Array, Indices, NDArray[np.bool_]]:
    """Cut the vertex that lies alone on its side off: a triangle there, two in what is left."""
    apex = np.argmax(signs * np.sign(signs.sum(axis=1))[:, None] < 0.0, axis=1)
    a, b, c, _, bc, _ = np.take_along_axis(triangles, TURNED[apex], axis=1).T
    ab, _, ca = np.take_along_axis(number, TURNED[apex, :3], axis=1).T
    p, q = cuts[ab, 0], cuts[ca, 0]
    n = len(a)
    arc, diagonal = len(points) + np.arange(2 * n).reshape(2, n)
    # The shorter diagonal of the quadrilateral p, b, c, q.
    from_p = np.hypot(*(points[p] - points[c]).T) <= np.hypot(*(points[q] - points[b]).T)
    near, other = np.where(from_p, p, b), np.where(from_p, c, q)
    points = np.concatenate([points, 0.5 * (points[p] + points[q]), 0.5 * (points[near] + points[other])])
    pa, pb, qc, qa = (
        _part(cuts, ab, a, b),
        _part(cuts, ab, b, a),
        _part(cuts, ca, c, a),
        _part(cuts, ca, a, c),
    )
    tip = np.stack([a, p, q, pa, arc, qa], axis=1)
    first = np.where(from_p, [p, b, c, pb, bc, diagonal], [p, b, q, pb, diagonal, arc]).T
    second = np.where(from_p, [p, c, q, diagonal, qc, arc], [b, c, q, bc, qc, diagonal]).T
    tip_out = signs[np.arange(n), apex] > 0.0
    return points, np.concatenate([tip, first, second]), np.concatenate([tip_out, ~tip_out, ~tip_out])


def _cut_through(
    points: Array, triangles: Indices, number: Indices, cuts: Indices, signs: Array
) -> tuple[Array, Indices, NDArray[np.bool_]]:
    """Cut from a vertex on the circle to the opposite edge."""
    apex = np.argmax(signs == 0.0, axis=1)
    a, b, c, ab, _, ca = np.take_along_axis(triangles, TURNED[apex], axis=1).T
    _, bc, _ = np.take_along_axis(number, TURNED[apex, :3], axis=1).T
    p, n = cuts[bc, 0], len(a)
    arc = len(points) + np.arange(n)
    points = np.concatenate([points, 0.5 * (points[a] + points[p])])
    first = np.stack([a, b, p, ab, _part(cuts, bc, b, c), arc], axis=1)
    second = np.stack([a, p, c, arc, _part(cuts, bc, c, b), ca], axis=1)
    b_out = signs[np.arange(n), (apex + 1) % 3] > 0.0
    return points, np.concatenate([first, second]), np.concatenate([b_out, ~b_out])


def _bend_onto(points: Array, triangles: Indices, outside: NDArray[np.bool_], circle: Circle) -> Array:
    """Put the nodes between on the circle where the triangles on either hand lie on different sides."""
    number, edges = edge_numbers(triangles)
    found = np.zeros((2, len(edges)), dtype=bool)
    for side in (0, 1):
        found[side, number[outside == bool(side)].ravel()] = True
    middle = edges[found.all(axis=0), 2]
    bent = points.copy()
    bent[middle] = circle.project(0.5 * (points[edges[:, 0]] + points[edges[:, 1]]))[found.all(axis=0)]
    return bent


def cut_along(
    section: Section,
    size: Callable[[Array], Array],
    circles: Callable[[Array, Indices], Sequence[Circle]],
    *,
    outside: bool,
) -> tuple[Array, Indices]:
    """Quadratic triangulation of a section with edges along circles, which the refined mesh decides.

    `size` as in `refine`. With `outside` what lies inside the last circle is dropped, so that there may be no
    triangle; points may be unused, cells still folded if a wall touches a circle.
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
            fixed = np.zeros(len(points), dtype=bool)
            for other in followed:
                fixed |= np.abs(other.beyond(points)) <= 1e-11 * other.radius
            points, triangles, beyond = follow_circle(points, triangles, circle, fixed)
        kept = triangles[beyond] if outside else triangles
        folded = kept[jacobians(points, kept).min(axis=1) <= 0.0]
        if not len(folded):
            break
        # Where a wall meets a circle at a small angle, its arcs must be short not to reach the wall.
        corners = points[folded[:, :3]]
        edges = np.sqrt(np.max(np.sum((np.roll(corners, 1, axis=1) - corners) ** 2, axis=2), axis=1))
        spots = np.concatenate([spots, np.column_stack([corners.mean(axis=1), 0.4 * edges])])
    return points, kept
