"""Parts of a three-dimensional picture, before anything is rendered.

Pieces are measured in millimetres. A standing machine has its axis along z; a lying one has it along x, with
z up. The picture turns with the drum: the unbalance points along x, or across the axis of a lying machine
along y. Angles run with the spin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from study.record import MM, Array
from study.view_bodies import LiquidBodies
from study.view_scale import Scale
from study.view_surfaces import LiquidShape

Indices = NDArray[np.int64]
Complex = NDArray[np.complex128]

ROUND = 181  # points of a circle


@dataclass(frozen=True)
class Piece:
    """One thing in a picture.

    Parameters
    ----------
    name : what it is
    points : mm, shape (n, 3)
    cells : numbers of points of each face, shape (m, 3) or (m, 4), or along each line, shape (m, 2)
    look : how it is drawn, by a name of `study.view_picture.LOOKS`
    ball : radius of a ball at each point, mm; 0 for none
    """

    name: str
    points: Array
    cells: Indices
    look: str
    ball: float = 0.0


@dataclass(frozen=True)
class Label:
    """Words at a place, mm."""

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
    """

    pieces: tuple[Piece, ...]
    labels: tuple[Label, ...]
    title: str
    state: str
    caption: str
    lying: bool
    long: bool
    frame: Array

    def piece(self, name: str) -> Piece:
        """The piece of that name."""
        return next(one for one in self.pieces if one.name == name)


@dataclass(frozen=True)
class Stage:
    """What stands still while a machine is shown at several instants.

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
    title, state, caption : words
    down : direction of gravity across the axis seen from the drum, rad; None to leave it as it is at angle 0
    """

    deflection: tuple[complex, ...]
    lean: complex
    bodies: tuple[LiquidShape | LiquidBodies | None, ...]
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
