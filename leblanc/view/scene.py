"""The three-dimensional picture of a machine at one instant: chambers, liquid, marks."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from leblanc.results.drawn.shapes import LiquidBodies, LiquidShape, strips
from leblanc.view.parts import (
    ABOVE,
    AWAY,
    BELOW,
    ROUND,
    Instant,
    Picture,
    Piece,
    Stage,
    axes,
    circle,
    line,
    marks,
    placed,
)
from leblanc.view.walls import baffles, plates_of, section_walls, straight
from meshes.arrays import Array, Complex, Indices
from meshes.bodies.body import WALL_PARTS
from meshes.chamber import Chamber

SKIN = 0.003  # walls are drawn so much outside the liquid, over the radius, so that the two do not coincide
_ON_PLATE = 1e-6  # of a plate's length, that a face may be off it


def compose(stage: Stage, instant: Instant) -> Picture:
    """Picture of a machine at one instant.

    Parameters
    ----------
    stage, instant : what stands still and what does not
    """
    factor = stage.scale.deflection
    pieces: list[Piece] = []
    for k, (fill, place) in enumerate(zip(stage.fills, stage.places, strict=True)):
        centre = factor * instant.deflection[k]
        pieces += _walls(stage, fill.chamber, k, centre, place - 0.5 * fill.chamber.height)
        body = instant.bodies[k]
        floor = place - 0.5 * fill.chamber.height
        if isinstance(body, LiquidBodies):
            pieces += _bodies(stage, body, plates_of(fill.chamber, stage.scale.depth), k, floor)
        elif body is not None:
            pieces += _liquid(stage, body, k, floor)
    lines, labels = axes(stage, instant)
    signs, names = marks(stage, instant)
    low, high = stage.ends
    round_it = circle(0j, AWAY * stage.radius + stage.swing)
    ends = np.array([low - BELOW * stage.radius, high + ABOVE * stage.radius])
    rings = [placed(stage, round_it, height) for height in (low, high)]
    return Picture(
        pieces=(*pieces, *lines, *signs, *instant.more),
        labels=(*labels, *names),
        title=instant.title,
        state=instant.state,
        caption=instant.caption,
        lying=stage.lying,
        long=high - low > 2.0 * stage.radius,
        frame=np.concatenate([*rings, placed(stage, np.zeros(2), ends)]),
    )


def _between(stage: Stage, name: str, look: str, *edges: tuple[Complex, float]) -> Piece:
    """Ruled surface between two curves, each at its height."""
    (one, low), (other, high) = edges
    points = np.concatenate([placed(stage, one, low), placed(stage, other, high)])
    first = np.arange(one.size - 1)
    cells = np.stack([first, first + 1, first + 1 + one.size, first + one.size], axis=-1)
    return Piece(name, points, cells.astype(np.int64), look)


def _walls(stage: Stage, chamber: Chamber, k: int, centre: complex, floor: float) -> list[Piece]:
    """Outer and inner wall, floor, and the rims of floor and lid."""
    lid, skin = floor + chamber.height, SKIN * chamber.radius
    plates = plates_of(chamber, stage.scale.depth)
    if chamber.section is not None:
        floor, lid = floor - skin, lid + skin
        pieces = section_walls(stage, chamber.section, k, centre, floor, lid, skin)
        return [*pieces, *baffles(stage, plates, k, centre, floor, lid)]
    outer = circle(centre, chamber.radius + skin)
    inner = circle(centre, max(chamber.inner_radius - skin, 0.0))
    floor, lid = floor - skin, lid + skin
    pieces = [
        _between(stage, f"wall {k + 1}", "wall", (outer, floor), (outer, lid)),
        _between(stage, f"floor {k + 1}", "floor", (inner, floor), (outer, floor)),
        _between(stage, f"lid {k + 1}", "lid", (inner, lid), (outer, lid)),
    ]
    rings = [outer]
    if chamber.inner_radius > 0.0:
        pieces.append(_between(stage, f"inner wall {k + 1}", "wall", (inner, floor), (inner, lid)))
        rings.append(inner)
    pieces += [
        Piece(f"rim {k + 1}", placed(stage, ring, height), line(ROUND), "rim")
        for ring in rings
        for height in (floor, lid)
    ]
    return [*pieces, *baffles(stage, plates, k, centre, floor, lid)]


def _liquid(stage: Stage, body: LiquidShape, k: int, floor: float) -> list[Piece]:
    """Free surface, the rest of the body's boundary, and the line where the surface ends."""
    points = body.surface
    rows, columns = points.shape[:2]
    plane, height = points[..., 0] + 1j * points[..., 1], points[..., 2]
    surface = _solid(
        f"surface {k + 1}",
        placed(stage, plane.ravel(), height.ravel(), floor),
        strips(rows, columns),
        "surface",
    )
    hull = body.outline()
    across, above = hull[..., 0] + 1j * hull[..., 1], hull[..., 2]
    rows, columns = above.shape
    points = placed(stage, across.ravel(), above.ravel(), floor)
    # Inner wall, lid, outer wall, floor: apart, so that each is shaded as one smooth face.
    firsts = (0, columns - 4, columns - 3, columns - 2)
    rest = [_solid(f"liquid {k + 1}", points, strips(rows, columns, c, c + 1), "liquid") for c in firsts]
    return [surface, *rest, *_waterlines(stage, body, k, floor)]


def _solid(name: str, points: Array, cells: Indices, look: str) -> Piece:
    """A piece without the faces that have no area, as where the wall is dry."""
    corners = points[cells]
    one, other = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    area = np.linalg.norm(np.cross(one, other), axis=1)
    kept = area > 1e-12 * max(float(area.max(initial=0.0)), 1e-300)
    return Piece(name, points, cells[kept], look)


def _waterlines(stage: Stage, body: LiquidShape, k: int, floor: float) -> list[Piece]:
    """Ends of the free surface, without those of dry half-planes."""
    both = body.wet & np.roll(body.wet, -1)
    pieces = []
    for end in (0, -1):
        plane = body.centre + body.radius[:, end] * np.exp(1j * body.angle)
        points = placed(stage, plane, body.height[:, end], floor)
        first = np.flatnonzero(both)
        cells = np.stack([first, (first + 1) % body.angle.size], axis=-1).astype(np.int64)
        pieces.append(Piece(f"waterline {k + 1}", points, cells, "waterline"))
    return pieces


def _bodies(stage: Stage, liquid: LiquidBodies, plates: Complex, k: int, floor: float) -> list[Piece]:
    """Free surfaces, the other faces of some bodies, and the lines where the surfaces end."""
    pieces = []
    for body in liquid.bodies:
        across = liquid.centre + body.points[:, 0] + 1j * body.points[:, 1]
        points = placed(stage, across, body.points[:, 2], floor)
        surface, wall = straight(body.surface), straight(body.wall)
        part = np.repeat(body.wall_part, len(wall) // max(len(body.wall), 1))
        pieces.append(Piece(f"surface {k + 1}", points, surface, "surface"))
        bare = ~_on_plates(body.points[wall].mean(axis=1), plates)
        pieces += [
            Piece(f"liquid {k + 1}", points, wall[bare & (part == one)], "liquid")
            for one in range(len(WALL_PARTS))
        ]
        pieces.append(Piece(f"waterline {k + 1}", points, _shore(surface, wall), "waterline"))
    return pieces


def _on_plates(points: Array, plates: Complex) -> NDArray[np.bool_]:
    """Which points lie on baffles, whose own faces show there."""
    across = points[:, 0] + 1j * points[:, 1]
    found = np.zeros(across.size, dtype=bool)
    for line_ in plates:
        for start, end in pairwise(line_):
            share = (across - start) / (end - start)
            found |= (np.abs(share.imag) < _ON_PLATE) & (share.real >= 0.0) & (share.real <= 1.0)
    return found


def _shore(surface: Indices, wall: Indices) -> Indices:
    """Edges that faces of the free surface share with faces on walls."""
    edges = [np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1) for faces in (surface, wall)]
    number = max(int(one.max(initial=0)) for one in edges) + 1
    open_, closed = (one[:, 0] * number + one[:, 1] for one in edges)
    return np.asarray(edges[0][np.isin(open_, closed)], dtype=np.int64)
