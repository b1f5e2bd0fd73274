"""A section between straight sides without the disc of a circle: its area, its outline, the circle's arcs.

Everything is measured in the plane by complex numbers x + i y. Sides have the section on their left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.liquid_section import free_sides
from meshes.section import Section

PIECES = 4  # of a curved side
ARC = math.radians(0.5)  # between points of an arc
_TINY = 1e-9  # rad: two crossings nearer to each other are the two faces of a wall without thickness
_HALVINGS = 60  # down to rounding


@dataclass(frozen=True)
class Remainder:
    """What is left of a section."""

    #: closed outlines with it on their left, complex, m, shape (k,) each, the first point not repeated
    loops: tuple[Complex, ...]
    arcs: tuple[Complex, ...]  #: the parts of the circle among them, shape (k,) each

    @property
    def area(self) -> float:
        """Area inside the loops, m^2."""
        return 0.5 * sum(float(np.sum((loop.conj() * np.roll(loop, -1)).imag)) for loop in self.loops)


def wall_loops(section: Section) -> tuple[Complex, ...]:
    """Walls of a section as closed lines with it on their left, m; quadratic sides are cut into pieces."""
    sides = free_sides(section.triangles)
    plane = section.points[:, 0] + 1j * section.points[:, 1]
    after: dict[int, list[int]] = {}
    for k, start in enumerate(sides[:, 0].tolist()):
        after.setdefault(start, []).append(k)
    share = np.arange(PIECES) / PIECES
    loops = []
    while after:
        first = node = next(iter(after))
        points = []
        while True:
            waiting = after[node]
            side = sides[waiting.pop()]
            if not waiting:
                del after[node]
            points.append(_side(plane[side], share))
            node = int(side[1])
            if node == first:
                break
        loops.append(np.concatenate(points))
    return tuple(loops)


def _side(nodes: Complex, share: Array) -> Complex:
    """Points of a side from its start on, without its end."""
    if nodes.size == 2:
        return nodes[:1]
    start, end, middle = nodes
    at = (1.0 - share) * (1.0 - 2.0 * share) * start + share * (2.0 * share - 1.0) * end
    return np.asarray(at + 4.0 * share * (1.0 - share) * middle)


def area_within(loops: tuple[Complex, ...], radius: ArrayLike) -> Array:
    """Area of a section inside circles about the origin, m^2, from its `wall_loops`.

    Exact for straight sides: each one's share is a triangle inside the circle and a sector outside.
    """
    start = np.concatenate(loops)
    end = np.concatenate([np.roll(loop, -1) for loop in loops])
    reach = np.asarray(radius, dtype=float)[..., None]
    enters, leaves = _roots(start, end, reach)
    inner, outer = start + enters * (end - start), start + leaves * (end - start)
    triangle = (inner.conj() * outer).imag
    sector = np.angle(start.conj() * inner) + np.angle(outer.conj() * end)
    return np.asarray(0.5 * np.sum(np.where(enters < leaves, triangle, 0.0) + reach**2 * sector, axis=-1))


def _roots(start: Complex, end: Complex, radius: float | Array) -> tuple[Array, Array]:
    """Between which shares of its length each side is inside the circle; both alike where it never is."""
    along = end - start
    square = np.abs(along) ** 2
    safe = np.where(square > 0.0, square, 1.0)
    foot = -(start.conj() * along).real / safe
    reach = radius**2 - (start.conj() * along).imag ** 2 / safe
    half = np.sqrt(np.maximum(reach, 0.0) / safe)
    low, high = np.clip(foot - half, 0.0, 1.0), np.clip(foot + half, 0.0, 1.0)
    return low, np.where((reach > 0.0) & (square > 0.0), high, low)


def radius_for(loops: tuple[Complex, ...], area: float) -> float:
    """Radius of the circle about the origin that leaves some area of a section outside of it, m.

    0 where nothing is left, the whole section for a circle that does not reach it.
    """
    whole = Remainder(loops, ()).area
    low, high = 0.0, float(max(np.abs(loop).max() for loop in loops))
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        enough = whole - area_within(loops, middle) > area
        low, high = (middle, high) if enough else (low, middle)
    return 0.5 * (low + high)


def outside_circle(loops: tuple[Complex, ...], radius: float) -> Remainder:
    """What of a section lies outside the circle about the origin."""
    kept: list[Complex] = []
    parts: list[Complex] = []
    for loop in loops:
        whole, cut = _outer_parts(loop, radius)
        kept += whole
        parts += cut
    if not parts:
        if radius == 0.0 or not _holds(loops, radius):
            return Remainder(tuple(kept), ())
        circle = radius * np.exp(-1j * np.linspace(0.0, 2.0 * math.pi, math.ceil(2.0 * math.pi / ARC) + 1))
        return Remainder((*kept, circle[:-1]), (circle,))
    joined, arcs = _joined(parts, radius, loops)
    return Remainder((*kept, *joined), arcs)


def _outer_parts(loop: Complex, radius: float) -> tuple[list[Complex], list[Complex]]:
    """A loop that stays outside the circle, or its pieces, each from out of the disc back into it."""
    end = np.roll(loop, -1)
    enters, leaves = _roots(loop, end, radius)
    inside = enters < leaves
    if not inside.any():
        return [loop], []
    lines: list[list[complex]] = []
    open_: list[complex] = []
    first = int(np.flatnonzero(inside)[0])
    for k in np.roll(np.arange(loop.size), -first).tolist():
        start, stop, low, high = complex(loop[k]), complex(end[k]), float(enters[k]), float(leaves[k])
        if not inside[k]:
            open_.append(stop)
            continue
        if low > 0.0:
            open_.append(start + low * (stop - start))
        if open_:
            lines.append(open_)
        open_ = [start + high * (stop - start), stop] if high < 1.0 else []
    # What is open now ends where the first line begins, if that one starts outside.
    if open_ and lines and enters[first] > 0.0:
        lines[0] = [*open_, *lines[0]]
    elif open_:
        lines.append(open_)
    parts = [np.array(line, dtype=complex) for line in lines if len(line) > 1]
    # A corner that only just reaches out of the disc bounds nothing; its arc looks like the whole circle.
    return [], [part for part in parts if np.abs(part - part[0]).max() > _TINY * radius]


def _holds(loops: tuple[Complex, ...], point: complex) -> bool:
    """A point lies in the section."""
    turn = sum(float(np.sum(np.angle((np.roll(loop, -1) - point) / (loop - point)))) for loop in loops)
    return turn > math.pi


def _joined(
    parts: list[Complex], radius: float, walls: tuple[Complex, ...]
) -> tuple[tuple[Complex, ...], tuple[Complex, ...]]:
    """Pieces of walls joined to loops by arcs along the circle, against the clock inside out."""
    starts, ends = (np.array([np.angle(part[k]) for part in parts]) for k in (0, -1))
    free = set(range(len(parts)))
    loops, arcs = [], []
    while free:
        first = k = min(free)
        line: list[Complex] = []
        while k in free:
            free.discard(k)
            line.append(parts[k])
            after = _next(ends[k], starts, free | {first})
            span = float(np.mod(ends[k] - starts[after], 2.0 * math.pi))
            span = 2.0 * math.pi if span < _TINY else span
            if not _holds(walls, radius * np.exp(1j * (ends[k] - 0.5 * span))):
                break  # the disc touches the walls from without: this piece closes by itself
            turn = ends[k] - np.linspace(0.0, span, max(2, math.ceil(span / ARC) + 1))
            arcs.append(radius * np.exp(1j * turn))
            line.append(arcs[-1][1:-1])
            k = after
        loops.append(np.concatenate(line))
    return tuple(loops), tuple(arcs)


def _next(end: float, starts: Array, free: set[int]) -> int:
    """The piece that starts next along the circle, clockwise from where another one ended."""
    which = np.array(sorted(free))
    away = np.mod(end - starts[which], 2.0 * math.pi)
    away = np.where(away < _TINY, 2.0 * math.pi, away)
    return int(which[int(away.argmin())])
