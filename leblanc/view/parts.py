"""Axes, unbalance, spin, gravity and scale bar of a three-dimensional picture."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from fluid.fill import Fill
from leblanc.results.drawn import Liquid, Scale
from leblanc.units import MM
from meshes.arrays import Array, Complex, Indices

ROUND = 181  # points of a circle


@dataclass(frozen=True)
class Piece:
    """One thing in a picture.

    Parameters
    ----------
    name : what it is
    points : mm, shape (n, 3)
    cells : numbers of points of each face, shape (m, 3) or (m, 4), or along each line, shape (m, 2)
    look : how it is drawn, by a name of `leblanc.view.picture.LOOKS`
    ball : radius of a ball at each point, mm; 0 for none
    """

    name: str
    points: Array
    cells: Indices
    look: str
    ball: float = 0.0


@dataclass(frozen=True)
class Label:
    """A text at a place, mm."""

    text: str
    place: tuple[float, float, float]


@dataclass(frozen=True)
class Picture:
    """What is drawn.

    Parameters
    ----------
    pieces, labels : in the picture
    title, state, caption : above, below that, and at the foot
    lying : the axis is horizontal
    long : it is longer than wide
    frame : points that the camera keeps in sight, mm, shape (n, 3)
    above : a standing machine is seen from high above, so that the layer's depth shows all round
    """

    pieces: tuple[Piece, ...]
    labels: tuple[Label, ...]
    title: str
    state: str
    caption: str
    lying: bool
    long: bool
    frame: Array
    above: bool = False

    def piece(self, name: str) -> Piece:
        """The piece of that name."""
        return next(piece for piece in self.pieces if piece.name == name)


@dataclass(frozen=True)
class Stage:
    """What is fixed while a machine is shown at several instants.

    Parameters
    ----------
    fills, places : chambers with their liquid; their middles along the axis, m
    lying : the axis is horizontal
    scale : of deflection and depth
    swing : largest deflection as drawn, m
    zero : what the zero mark on the drum is; empty to leave it out
    gravity : show where it points
    """

    fills: tuple[Fill, ...]
    places: tuple[float, ...]
    lying: bool
    scale: Scale
    swing: float
    zero: str = "unbalance"
    gravity: bool = True

    @property
    def radius(self) -> float:
        """Of the widest chamber, m."""
        return max((fill.chamber.radius for fill in self.fills), default=0.1)

    @property
    def ends(self) -> tuple[float, float]:
        """Of all chambers along the axis, m."""
        halves = [0.5 * fill.chamber.height for fill in self.fills]
        low = min((p - h for p, h in zip(self.places, halves, strict=True)), default=-0.02)
        return low, max((p + h for p, h in zip(self.places, halves, strict=True)), default=0.02)


@dataclass(frozen=True)
class Instant:
    """A machine at one instant, in the drum frame.

    Parameters
    ----------
    deflection : of each chamber, not yet scaled, m
    lean : slope of the axis along itself, not yet scaled
    bodies : liquid of each chamber as drawn, None where there is none
    title, state, caption : texts
    down : direction of gravity across the axis seen from the drum, rad; None to leave it as it is at angle 0
    """

    deflection: tuple[complex, ...]
    lean: complex
    bodies: tuple[Liquid, ...]
    title: str
    state: str
    caption: str
    down: float | None = None
    more: tuple[Piece, ...] = field(default=())


def placed(stage: Stage, plane: Array | Complex, height: Array | float, along: float = 0.0) -> Array:
    """Points of the picture from complex places across the axis and heights along it.

    Parameters
    ----------
    stage : whether the machine lies
    plane : complex, m, shape (n,)
    height : along the axis, m
    along : added to it, m

    Returns
    -------
    mm, shape (n, 3)
    """
    across = np.atleast_1d(np.asarray(plane, dtype=complex))
    axial = np.broadcast_to(np.asarray(height, dtype=float) + along, across.shape)
    order = (axial, across.real, across.imag) if stage.lying else (across.real, across.imag, axial)
    return np.stack(order, axis=-1) * MM


def circle(centre: complex, radius: float) -> Complex:
    """Points of a closed circle, complex, shape (181,)."""
    turn = np.linspace(0.0, 2.0 * math.pi, ROUND)
    return np.asarray(centre + radius * np.exp(1j * turn))


def line(count: int) -> Indices:
    """Cells of a line through so many points in their order."""
    return np.stack([np.arange(count - 1), np.arange(1, count)], axis=-1).astype(np.int64)


# Lengths over the widest radius: the axes beyond the chambers, marks outside the wall, the longest scale bar,
# the unbalance, room between a mark and its name.
ABOVE, BELOW, AWAY, BAR, SPOT, NAME = 0.45, 0.3, 1.18, 0.8, 0.035, 0.07
NO_CELLS: Indices = np.zeros((0, 2), dtype=np.int64)


def axes(stage: Stage, instant: Instant) -> tuple[list[Piece], list[Label]]:
    """Axis at rest, about which the machine turns, and the drum's own axis, which the deflection has moved.

    Parameters
    ----------
    stage, instant : what is fixed and what moves
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
    stage, instant : what is fixed and what moves
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
    stage : what is fixed
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
