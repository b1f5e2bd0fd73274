"""The cabinet on its feet and the named points of a three-dimensional picture."""

from __future__ import annotations

import numpy as np

from leblanc.core.units import MM
from leblanc.plotting.bodies import Spot
from leblanc.view.machine import cylinder, moved
from leblanc.view.parts import Instant, Label, Piece, Stage, line, placed
from meshes.arrays import Array

# Over the drum's radius: height and radius of a foot, radius of a point.
TALL, WIDE, BALL = 0.1, 0.09, 0.035
NAMED = 4  # points whose names are written


def around(stage: Stage, instant: Instant) -> tuple[list[Piece], list[Piece], list[Label]]:
    """Cabinet and points: pieces that turn with the drum, pieces that do not, names of some of these."""
    if stage.parts is None:
        return [], [], []
    size = stage.parts.drum.radius * MM
    turning: list[Piece] = []
    still, labels = _cabinet(stage), []
    for k, spot in enumerate(stage.parts.points):
        shift = moved(stage, instant, spot.axial) * (1.0 if spot.turns else np.exp(1j * instant.turn))
        place = placed(stage, spot.across + np.atleast_1d(shift), spot.axial)
        piece = Piece(f"point {spot.name}", place, np.zeros((0, 2), dtype=np.int64), "point", BALL * size)
        (turning if spot.turns else still).append(piece)
        if not spot.turns and k < NAMED:
            x, y, z = place[0].tolist()
            labels.append(Label(spot.name, (x, y, z)))
    return turning, still, labels


def corners(stage: Stage) -> Array:
    """Feet of the cabinet and as many corners above them, mm, shape (2, f, 3).

    The top is as far above the axis, or above the machine's middle, as the feet are below it.
    """
    assert stage.parts is not None
    feet = stage.parts.feet
    low = np.concatenate([_at(stage, foot) for foot in feet]).reshape(-1, 3)
    high = low.copy()
    high[:, 2] *= -1.0
    return np.stack([low, high])


def _at(stage: Stage, spot: Spot) -> Array:
    return placed(stage, np.array([spot.across]), spot.axial)


def _cabinet(stage: Stage) -> list[Piece]:
    """Feet of the cabinet, and its edges as lines."""
    assert stage.parts is not None
    if not stage.parts.feet:
        return []
    size, (low, high) = stage.parts.drum.radius * MM, corners(stage)
    up = np.array([0.0, 0.0, 1.0 if high[0, 2] >= low[0, 2] else -1.0])
    pieces = [
        part
        for k, foot in enumerate(low)
        for part in cylinder(f"foot {k + 1}", "foot", foot, foot + TALL * size * up, WIDE * size)
    ]
    for name, ring in (("floor", low), ("top", high)):
        closed = np.concatenate([ring, ring[:1]])
        pieces.append(Piece(f"edge of the cabinet, {name}", closed, line(len(closed)), "cabinet"))
    pieces += [
        Piece(f"edge of the cabinet, {k + 1}", np.stack(pair), line(2), "cabinet")
        for k, pair in enumerate(zip(low, high, strict=True))
    ]
    return pieces
