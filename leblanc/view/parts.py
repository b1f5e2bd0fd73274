"""Axes, unbalance, spin, gravity and scale bar of a three-dimensional picture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from leblanc.core.units import MM
from leblanc.plotting.bodies import Liquid, MachineParts, Scale
from meshes.arrays import Array, Complex, Indices

ROUND = 181  # points of a circle


@dataclass(frozen=True)
class Piece:
    """One thing in a picture."""

    name: str  #: what it is
    points: Array  #: mm, shape (n, 3)
    #: numbers of points of each face, shape (m, 3) or (m, 4), or along each line, shape (m, 2)
    cells: Indices
    look: str  #: how it is drawn, by a name of `leblanc.view.picture.LOOKS`
    ball: float = 0.0  #: radius of a ball at each point, mm; 0 for none


@dataclass(frozen=True)
class Label:
    """A text at a place, mm."""

    text: str
    place: tuple[float, float, float]


@dataclass(frozen=True)
class Inset:
    """A small curve in the corner of each frame of a film, with a point where the film is."""

    across: Array  #: what it runs over, rising, shape (n,)
    curves: tuple[tuple[str, Array], ...]  #: one over the other, each with its name, shape (n,)
    at: float  #: where the point is
    name: str  #: of what it runs over


@dataclass(frozen=True)
class Picture:
    """What is drawn."""

    pieces: tuple[Piece, ...]  #: in the picture
    labels: tuple[Label, ...]
    title: str  #: above, below that, and at the foot
    state: str
    caption: str
    lying: bool  #: the axis is horizontal
    long: bool  #: it is longer than wide
    frame: Array  #: points that the camera keeps in sight, mm, shape (n, 3)
    #: a standing machine is seen from high above, so that the layer's depth shows all round
    above: bool = False
    inset: Inset | None = None  #: curve of a film

    def piece(self, name: str) -> Piece:
        """The piece of that name."""
        return next(piece for piece in self.pieces if piece.name == name)


@dataclass(frozen=True)
class Stage:
    """What is fixed while a machine is shown at several instants."""

    fills: tuple[Fill, ...]  #: chambers with their liquid; their middles along the axis, m
    places: tuple[float, ...]
    lying: bool  #: the axis is horizontal
    scale: Scale  #: of deflection and depth
    swing: float  #: largest deflection as drawn, m
    zero: str = "unbalance"  #: what the zero mark on the drum is; empty to leave it out
    gravity: bool = True  #: show where it points
    parts: MachineParts | None = None  #: what carries the chambers and holds them; None to show these alone

    @property
    def radius(self) -> float:
        """Radius of the widest chamber, or of the drum, m."""
        bare = 0.1 if self.parts is None else self.parts.drum.radius
        return max((fill.chamber.radius for fill in self.fills), default=bare)

    @property
    def reach(self) -> float:
        """Farthest that drum and housing come from the axis at rest, m."""
        shell = None if self.parts is None else self.parts.housing
        return self.swing + max(self.radius, 0.0 if shell is None else shell.radius)

    @property
    def whole(self) -> tuple[float, float]:
        """Ends of chambers, drum, housing and shaft along the axis, m."""
        low, high = self.ends
        if self.parts is None:
            return low, high
        shells = [self.parts.drum, *self.parts.shaft]
        shells += [] if self.parts.housing is None else [self.parts.housing]
        return min(low, *(shell.low for shell in shells)), max(high, *(shell.high for shell in shells))

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of all chambers along the axis, m."""
        halves = [0.5 * fill.chamber.height for fill in self.fills]
        low = min((p - h for p, h in zip(self.places, halves, strict=True)), default=-0.02)
        return low, max((p + h for p, h in zip(self.places, halves, strict=True)), default=0.02)


@dataclass(frozen=True)
class Instant:
    """A machine at one instant, seen from the drum unless it says otherwise."""

    deflection: tuple[complex, ...]  #: of each chamber, not yet scaled, m
    lean: complex  #: slope of the axis along itself, not yet scaled
    bodies: tuple[Liquid, ...]  #: liquid of each chamber as drawn, None where there is none
    title: str  #: texts
    state: str
    caption: str
    turn: float = 0.0  #: of the drum from where its zero mark lies in a still, rad


def placed(stage: Stage, plane: Array | Complex, height: Array | float, along: float = 0.0) -> Array:
    """Points of the picture, mm, (n, 3), from complex places across the axis and heights along it, m.

    `along` is added to the heights, m.
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
    """Axis at rest, about which the machine turns, and the drum's own, away from it by the deflection."""
    low, high = stage.whole
    ends = np.array([low - BELOW * stage.radius, high + ABOVE * stage.radius])
    middle = stage.places[0] if stage.places else 0.0
    first = instant.deflection[0] if instant.deflection else 0j
    # The drum's axis ends a little earlier, so that the two can be told apart.
    shorter = ends - np.array([0.0, 0.2 * ABOVE * stage.radius])
    moved = stage.scale.deflection * (first + instant.lean * (shorter - middle))
    own = placed(stage, moved, shorter)
    rest = placed(stage, np.zeros(2), ends)
    pieces = [Piece("axis at rest", rest, line(2), "axis at rest")]
    labels = [Label("axis of rotation", _point(rest[1]))]
    if np.any(moved != 0.0):
        pieces.append(Piece("axis of the drum", own, line(2), "axis of the drum"))
    # In all pictures of a film or in none.
    if stage.swing > 0.015 * stage.radius:
        labels.append(Label("axis of the drum", _point(own[1])))
    return pieces, labels


def marks(stage: Stage, instant: Instant) -> tuple[list[Piece], list[Label]]:
    """The heavy spot on the rim, or the zero mark, which turn with the drum."""
    if not stage.zero:
        return [], []
    centre, top, _ = _widest(stage, instant)
    radius = stage.radius
    spot = placed(stage, centre + np.array([radius]), top)
    pieces = [
        Piece("unbalance", spot, NO_CELLS, "unbalance", SPOT * radius * MM),
        Piece("arm", placed(stage, centre + np.array([0.0, radius]), top), line(2), "arm"),
    ]
    return pieces, [Label(stage.zero, _point(spot[0]))]


def signs(stage: Stage, instant: Instant) -> tuple[list[Piece], list[Label]]:
    """Sense of the spin, gravity, scale bar, which stand."""
    _, top, bottom = _widest(stage, instant)
    away = max(AWAY * stage.radius + stage.swing, 1.04 * stage.reach)
    # Between the springs and dampers of a standing machine.
    low, high = (100.0, 150.0) if stage.lying else (157.0, 205.0)
    turn: Complex = np.exp(1j * np.radians(np.linspace(low, high, 31)))
    arc = placed(stage, away * turn, top)
    pieces, labels = [Piece("spin", arc, line(arc.shape[0]), "spin")], [Label("spin", _point(arc[15]))]
    if stage.gravity:
        arrow = _gravity(stage, bottom)
        pieces.append(Piece("gravity", arrow, line(2), "gravity"))
        labels.append(Label("g", _point(arrow[1])))
    bar = scale_bar(stage, min(bottom, stage.parts.drum.low) if stage.parts else bottom)
    pieces.append(bar)
    labels.append(Label(f"{bar_length(stage.radius) * MM:g} mm", _point(bar.points.mean(axis=0))))
    return pieces, labels


def _widest(stage: Stage, instant: Instant) -> tuple[complex, float, float]:
    """Centre, lid and floor of the widest chamber, m."""
    widest = max(range(len(stage.fills)), key=lambda k: stage.fills[k].chamber.radius, default=None)
    if widest is None:
        centre = stage.scale.deflection * instant.deflection[0] if instant.deflection else 0j
        return centre, stage.whole[1], stage.whole[0]
    half = 0.5 * stage.fills[widest].chamber.height
    centre = stage.scale.deflection * instant.deflection[widest]
    return centre, stage.places[widest] + half, stage.places[widest] - half


def turned(stage: Stage, points: Array, turn: float) -> Array:
    """Points, mm, (n, 3), turned by an angle of rad about the axis at rest, with the spin."""
    if turn == 0.0:
        return points
    first = 1 if stage.lying else 0
    across = (points[:, first] + 1j * points[:, first + 1]) * np.exp(1j * turn)
    found = points.copy()
    found[:, first], found[:, first + 1] = across.real, across.imag
    return found


def _gravity(stage: Stage, bottom: float) -> Array:
    """Ends of the arrow of gravity, mm: beside the machine, on the side of the eye where it lies."""
    if not stage.lying:
        start = placed(stage, complex(1.5, -0.3) * np.array([stage.reach]), stage.ends[1])[0]
        return np.stack([start, start - np.array([0.0, 0.0, 0.3 * stage.radius * MM])])
    ends = -1.25 * stage.reach + 1j * stage.radius * np.array([-0.2, -0.5])
    return placed(stage, ends, bottom)


def bar_length(radius: float) -> float:
    """Length of the scale bar of a machine of a radius, m: 1, 2 or 5 of a decade."""
    most = BAR * radius
    decade = 10.0 ** math.floor(math.log10(most))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= most * (1.0 + 1e-9))


def scale_bar(stage: Stage, height: float) -> Piece:
    """Bar of a round length beside the machine, across its axis, at a height along it, m."""
    half = 0.5 * bar_length(stage.radius)
    # Beside what holds a lying machine, in front of a standing one.
    middle = complex(1.5, -1.05) * stage.reach if stage.lying else -1.15j * stage.reach
    ends = middle + np.array([-half, half])
    return Piece("scale bar", placed(stage, ends, stage.ends[1] if stage.lying else height), line(2), "bar")


def _point(row: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in row)
    return x, y, z
