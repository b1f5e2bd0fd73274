"""Axes, unbalance, spin, gravity and scale bar of a three-dimensional picture."""

from __future__ import annotations

import math

import numpy as np

from study.record import MM, Array
from study.view_parts import Complex, Indices, Instant, Label, Piece, Stage, line, placed

# Lengths over the widest radius: the axes beyond the chambers, marks outside the wall, the longest scale bar,
# the unbalance, room between a mark and its name.
ABOVE, BELOW, AWAY, BAR, SPOT, NAME = 0.45, 0.3, 1.18, 0.8, 0.035, 0.07
NO_CELLS: Indices = np.zeros((0, 2), dtype=np.int64)


def axes(stage: Stage, instant: Instant) -> tuple[list[Piece], list[Label]]:
    """Axis at rest, about which the machine turns, and the drum's own axis, which the deflection has moved.

    Parameters
    ----------
    stage, instant : what stands still and what does not
    """
    low, high = stage.ends
    ends = np.array([low - BELOW * stage.radius, high + ABOVE * stage.radius])
    middle = stage.places[0] if stage.places else 0.0
    first = instant.deflection[0] if instant.deflection else 0j
    # The drum's axis ends a little earlier, so that the names of the two stay apart.
    shorter = ends - np.array([0.0, 0.2 * ABOVE * stage.radius])
    moved = stage.scale.deflection * (first + instant.lean * (shorter - middle))
    own = placed(stage, moved, shorter)
    rest = placed(stage, np.zeros(2), ends)
    pieces = [Piece("axis at rest", rest, line(2), "axis at rest")]
    if np.any(moved != 0.0):
        pieces.append(Piece("axis of the drum", own, line(2), "axis of the drum"))
    beyond = NAME * stage.radius * np.array([-1.0, 1.0])
    names = placed(stage, np.array([moved[0], 0.0]), ends + beyond)
    labels = [Label("axis of rotation", _point(names[1]))]
    if np.abs(moved).max() > 0.015 * stage.radius:
        labels.append(Label("axis of the drum", _point(names[0])))
    return pieces, labels


def marks(stage: Stage, instant: Instant) -> tuple[list[Piece], list[Label]]:
    """Unbalance, sense of the spin, gravity, scale bar.

    Parameters
    ----------
    stage, instant : what stands still and what does not
    """
    low, high = stage.ends
    widest = max(range(len(stage.fills)), key=lambda k: stage.fills[k].chamber.radius, default=None)
    centre, top, bottom = 0j, high, low
    if widest is not None:
        centre = stage.scale.deflection * instant.deflection[widest]
        half = 0.5 * stage.fills[widest].chamber.height
        top, bottom = stage.places[widest] + half, stage.places[widest] - half
    radius = stage.radius
    pieces, labels = _unbalance(stage, centre, top) if stage.zero else ([], [])
    turn: Complex = np.exp(1j * np.radians(np.linspace(100.0, 150.0, 31)))
    arc = placed(stage, centre + 1.08 * radius * turn, top)
    pieces.append(Piece("spin", arc, line(arc.shape[0]), "spin"))
    outside = placed(stage, centre + 1.2 * radius * turn[15:16], top)
    labels.append(Label("spin", _point(outside[0])))
    if stage.gravity:
        arrow = _gravity(stage, instant, bottom)
        pieces.append(Piece("gravity", arrow, line(2), "gravity"))
        labels.append(Label("g", _point(arrow[1] + NAME * radius * MM * _direction(arrow))))
    bar = scale_bar(stage, bottom)
    pieces.append(bar)
    beyond = bar.points[1] + 2.2 * NAME * radius * MM * _direction(bar.points)
    labels.append(Label(f"{bar_length(stage.radius) * MM:g} mm", _point(beyond)))
    return pieces, labels


def _unbalance(stage: Stage, centre: complex, top: float) -> tuple[list[Piece], list[Label]]:
    """The heavy spot on the rim, or the zero mark, with its name."""
    radius = stage.radius
    spot = placed(stage, centre + np.array([radius]), top)
    pieces = [
        Piece("unbalance", spot, NO_CELLS, "unbalance", SPOT * radius * MM),
        Piece("arm", placed(stage, centre + np.array([0.0, radius]), top), line(2), "arm"),
    ]
    # Above the unbalance of a standing machine, beside that of a lying one.
    out, up = (1.0 + 3.0 * NAME, 0.0) if stage.lying else (1.0, 1.5 * NAME)
    name = placed(stage, centre + np.array([out * radius]), top, up * radius)
    return pieces, [Label(stage.zero, _point(name[0]))]


def _direction(points: Array) -> Array:
    """Unit vector from the first to the last of some points."""
    along = points[-1] - points[0]
    return np.asarray(along / np.linalg.norm(along))


def _gravity(stage: Stage, instant: Instant, bottom: float) -> Array:
    """Ends of the arrow of gravity, mm."""
    reach = stage.radius + stage.swing
    if not stage.lying:
        start = placed(stage, np.array([complex(-1.0, -0.6) * reach]), stage.ends[1])[0]
        return np.stack([start, start - np.array([0.0, 0.0, 0.3 * stage.radius * MM])])
    down = -0.5 * math.pi if instant.down is None else instant.down
    ends = np.array([1.03 * reach, 1.03 * reach + 0.2 * stage.radius])
    return placed(stage, np.exp(1j * down) * ends, bottom)


def bar_length(radius: float) -> float:
    """Length of the scale bar, m: 1, 2 or 5 of a decade.

    Parameters
    ----------
    radius : of the machine, m
    """
    most = BAR * radius
    decade = 10.0 ** math.floor(math.log10(most))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= most * (1.0 + 1e-9))


def scale_bar(stage: Stage, height: float) -> Piece:
    """Bar of a round length beside the machine, across its axis.

    Parameters
    ----------
    stage : what stands still
    height : where it lies along the axis, m
    """
    half, away = 0.5 * bar_length(stage.radius), AWAY * stage.radius + stage.swing
    # Beside the arrow of gravity of a lying machine.
    shift = 0.75 * stage.radius if stage.lying else 0.0
    ends = np.array([shift - half, shift + half]) - 1j * away
    return Piece("scale bar", placed(stage, ends, stage.ends[1] if stage.lying else height), line(2), "bar")


def _point(row: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in row)
    return x, y, z
