"""A machine and its liquid as pictures draw them: bodies in space, small lengths enlarged."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from leblanc.liquid.filled import FilledChamber
from meshes.arrays import Array, Complex, Indices
from meshes.bodies.body import Body, body_integrals
from meshes.clip import Remainder, outside_circle, radius_for
from meshes.liquid_section import LiquidSection

if TYPE_CHECKING:
    from leblanc.studies.balls.answer import BallsAnswer
    from leblanc.studies.run.answer import RunAnswer
    from leblanc.studies.runup.answer import RunupAnswer, RunupFrames

LARGEST_FACTOR = 1e6  # of a depth as drawn
FILLED = 0.55  # deepest place as drawn over the room between the walls
SWING = 0.3  # largest deflection as drawn, over the smallest wall radius
USUAL = 0.9  # of the frames of a film, whose depths its drawing is scaled to
ROOM = 0.97  # deepest place of all frames, likewise
FAR = 1e4  # of the radius: a circle as large as this stands for the level surface of a pool


@dataclass(frozen=True)
class Scale:
    """Factors that a picture applies; walls are to scale."""

    deflection: float = 1.0  #: of the axis
    depth: float = 1.0  #: of the mean layer; 1 draws as much liquid as there is
    #: factor of the deflection that the user gave, if walls leave no room for it; None otherwise
    asked: float | None = None

    def in_words(self) -> str:
        """What is larger than it is, for the caption."""
        if self.asked is None:
            return self._drawn()
        return (
            f"{self._drawn()} Drawn {self.asked:g} times larger it would carry the liquid to an inner wall."
        )

    def _drawn(self) -> str:
        if self.deflection == self.depth == 1.0:
            return "Everything to scale."
        size = f"{self.deflection:g} times"
        if self.depth == 1.0:
            larger = f"{size} larger" if self.deflection > 1.0 else f"at {self.deflection:g} of its size"
            return f"Deflection drawn {larger}, walls and volume of liquid to scale."
        if self.depth == self.deflection:
            return f"Deflection and depth of the liquid layer drawn {size} larger, walls to scale."
        return (
            f"Deflection drawn {size} larger, the liquid layer {self.depth:g} times as deep as it is; "
            "walls to scale."
        )


def rounded_down(factor: float) -> float:
    """The factor with two digits, for printing."""
    step = 10.0 ** (math.floor(math.log10(factor)) - 1)
    # A factor that is a round number already must not lose a digit to rounding.
    return math.floor(factor / step * (1.0 + 1e-9)) * step


def chord(radius: float, centre: complex, angle: Array) -> Array:
    """Distance from the origin, inside a circle, to that circle in a direction, rad, m, shape (...,)."""
    away = centre * np.exp(-1j * angle)
    distance: Array = away.real + np.sqrt(radius**2 - away.imag**2)
    return distance


def half_angle(share: float) -> float:
    """Half the angle a, 0 to pi, of a circular segment, from its area over R^2, a - sin a cos a."""
    low, high = 0.0, math.pi
    for _ in range(60):
        half = 0.5 * (low + high)
        low, high = (low, half) if half - math.sin(half) * math.cos(half) > share else (half, high)
    return 0.5 * (low + high)


def pool(radius: float, inner_radius: float, area: float, down: float) -> tuple[Remainder, float]:
    """Liquid at the bottom of a ring whose axis lies, and how far below the centre its surface is, m.

    `area` is in m^2, `down` the direction of gravity, rad.
    """
    # The same on both sides of the direction of gravity.
    turn = np.exp(1j * (down + np.linspace(0.0, 2.0 * math.pi, 721)[:-1]))
    loops = [radius * turn] + ([inner_radius * turn.conj()] if inner_radius > 0.0 else [])
    away = FAR * radius * complex(math.cos(down), math.sin(down))
    moved = tuple(np.asarray(loop + away, dtype=complex) for loop in loops)
    distance = radius_for(moved, area)
    found = outside_circle(moved, distance)
    back = Remainder(tuple(loop - away for loop in found.loops), tuple(arc - away for arc in found.arcs))
    return back, distance - FAR * radius


def film_factor(chambers: Sequence[FilledChamber], depth: Array, deflection: Complex) -> float:
    """One factor for deflections and depths, so that a surface round the axis at rest stays so as drawn.

    Depths of frames, levels and chambers, m, shape (f, l, c), nan where there is no liquid; deflections, m,
    shape (f, l).
    """
    fits = [LARGEST_FACTOR]
    for j, chamber in enumerate(chambers):
        deepest = float(np.quantile(np.nan_to_num(depth[:, j]).max(axis=1), USUAL))
        if deepest > 0.0:
            fits.append(FILLED * (chamber.radius - chamber.inner_radius) / deepest)
        highest = float(np.nan_to_num(depth[:, j]).max(initial=0.0))
        if highest > 0.0:
            fits.append(ROOM * (chamber.radius - chamber.inner_radius) / highest)
        largest = float(np.abs(deflection[:, j]).max())
        if largest > 0.0:
            fits.append(SWING * chamber.radius / largest)
    return rounded_down(max(1.0, min(fits)))


@dataclass(frozen=True)
class LiquidShape:
    """Liquid in n half-planes with k points of the free surface each.

    In a half-plane the liquid lies between the chamber's floor, its outer wall and the free surface, which
    runs from the floor or the inner wall outwards to the outer wall or the lid.
    """

    centre: complex  #: of the half-planes, m from the axis at rest
    angle: Array  #: of each, rising over less than a turn, rad, shape (n,)
    inner: Array  #: distances of the walls from the centre, m, shape (n,); an inner wall of no size is 0
    outer: Array
    radius: Array  #: of the free surface, distance from the centre and above the floor, m, shape (n, k)
    height: Array

    @property
    def surface(self) -> Array:
        """Points of the free surface, m, shape (n, k, 3)."""
        plane = self.centre + self.radius * np.exp(1j * self.angle)[:, None]
        return np.stack([plane.real, plane.imag, self.height], axis=-1)

    @property
    def wet(self) -> NDArray[np.bool_]:
        """Half-planes with liquid at the outer wall, shape (n,)."""
        last = self.radius[:, -1] < self.outer * (1.0 - 1e-9)
        return np.asarray(last | (self.height[:, -1] > 0.0))

    def outline(self) -> Array:
        """Closed outlines of the liquid in the half-planes, m, shape (n, k + 4, 3).

        Floor at the surface's inner end, the surface, its outer end carried to the wall, floor at the wall.
        """
        first, last = self.radius[:, :1], self.outer[:, None]
        flat = np.zeros_like(first)
        radius = np.concatenate([first, self.radius, last, last, first], axis=1)
        height = np.concatenate([flat, self.height, self.height[:, -1:], flat, flat], axis=1)
        plane = self.centre + radius * np.exp(1j * self.angle)[:, None]
        return np.stack([plane.real, plane.imag, height], axis=-1)

    def volume(self) -> float:
        """Volume between the flat sides, m^3."""
        points = self.outline() - np.array([self.centre.real, self.centre.imag, 0.0])
        return _volume(points.reshape(-1, 3), strips(*points.shape[:2]))


def strips(rows: int, columns: int, first: int = 0, last: int | None = None) -> Indices:
    """Quadrilaterals between neighbouring rows of points, the last row next to the first; shape (m, 4).

    Counter-clockwise seen from outside where rows follow one another counter-clockwise and columns go
    outwards over the top.
    """
    end = columns - 1 if last is None else last
    row, column = np.meshgrid(np.arange(rows), np.arange(first, end), indexing="ij")
    here, there = row * columns + column, (row + 1) % rows * columns + column
    return np.stack([here, here + 1, there + 1, there], axis=-1).reshape(-1, 4).astype(np.int64)


def _volume(points: Array, quads: Indices) -> float:
    """Volume inside a closed surface: the sum of the tetrahedra from the origin to its triangles."""
    corners = points[quads]
    total = 0.0
    for second, third in ((1, 2), (2, 3)):
        a, b, c = corners[:, 0], corners[:, second], corners[:, third]
        total += float(np.sum(a * np.cross(b, c))) / 6.0
    return total


@dataclass(frozen=True)
class LiquidBodies:
    """Bodies of liquid that cannot mix, in one chamber."""

    centre: complex  #: of the chamber, m from the axis at rest
    bodies: tuple[Body, ...]  #: in coordinates of the chamber

    def volume(self) -> float:
        """Of all of them, m^3."""
        return sum(body_integrals(body).volume for body in self.bodies)


Liquid = LiquidShape | LiquidBodies | None  # of one chamber; None where there is none


@dataclass(frozen=True)
class Strut:
    """A spring or damper between the machine and the ground, both places along and across the axis.

    Across the axis, complex: gravity points along -i where the axis lies.
    """

    kind: str  #: "spring", "damper", or "bush" where one acts in all directions
    axial: float  #: where it holds the machine, m
    across: complex
    along: float  #: unit vector from there to the ground, its parts along and across the axis
    aside: complex
    length: float  #: as drawn, m


@dataclass(frozen=True)
class Shell:
    """A drum, tub or ring round the axis."""

    radius: float  #: m
    low: float  #: its ends along the axis, m
    high: float


@dataclass(frozen=True)
class Spot:
    """A place that a scene names: a foot of its cabinet, or a point."""

    name: str  #: of a point; empty for a foot
    axial: float  #: m, as of `Strut`
    across: complex
    turns: bool = False  #: it goes round with the drum


@dataclass(frozen=True)
class MachineParts:
    """What carries the chambers and what holds the machine, as drawn."""

    drum: Shell  #: carries the chambers and turns with them
    hollow: bool  #: a drum with room inside; else a disc with its chambers
    housing: Shell | None  #: round the drum, does not turn; None where there is none
    shaft: tuple[Shell, ...]  #: its pieces along the axis, m
    bearings: tuple[float, ...]  #: places along the axis, m
    struts: tuple[Strut, ...]  #: springs and dampers
    sketched: str  #: what the scene does not say of them, a sentence for the caption; empty if it says all
    feet: tuple[Spot, ...] = ()  #: of its cabinet, in their order round it
    points: tuple[Spot, ...] = ()  #: that the scene names


@dataclass(frozen=True)
class MachineMotion:
    """A machine at some speeds; s speeds, c chambers. Angles count from the unbalance, in the drum frame."""

    response: RunAnswer  #: what `run` says of them
    fills: tuple[Fill, ...]  #: the chambers with their liquid
    places: tuple[float, ...]  #: middle of each chamber along the axis as it is drawn, m
    moved: bool  #: some of them are drawn apart although the scene gives them one plane
    gravity: float  #: along the axis, m/s^2
    #: of the axis at each chamber, m, nan where none was found, shape (s, c); shape (s, 1) without chambers
    deflection: Complex
    lean: Complex  #: slope of the axis along itself, rad, shape (s,)
    parts: MachineParts  #: drum, housing, springs and dampers

    @property
    def speed(self) -> Array:
        """Spin speeds, rad/s, shape (s,)."""
        return self.response.response.speed

    @property
    def length(self) -> float:
        """From the first to the last chamber's middle, m."""
        return float(np.ptp(self.places)) if self.places else 0.0


@dataclass(frozen=True)
class DrawnLiquid:
    """Liquid of c chambers at one speed, in equilibrium with the deflection as it is drawn."""

    scale: Scale  #: of deflection and depth
    bodies: tuple[Liquid, ...]  #: the liquid, one for each chamber
    volume: tuple[float, ...]  #: as drawn, m^3, one for each chamber
    dry: tuple[bool, ...]  #: the wall of each chamber is dry in part, in truth and as drawn
    drawn_dry: tuple[bool, ...]


@dataclass(frozen=True)
class MachineView:
    """A machine at one speed and its liquid as drawn."""

    motion: MachineMotion  #: the machine; its last speed is drawn
    liquid: DrawnLiquid  #: as drawn there

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a machine, SI."""
        answer = self.motion.response.response
        return {
            "speed": float(answer.speed[-1]),
            "deflection": self.motion.deflection[-1],
            "dry_patch": bool(answer.dry_patch[-1]),
            "model": str(answer.model[-1]),
            "deflection_factor": self.liquid.scale.deflection,
            "depth_factor": self.liquid.scale.depth,
            "volume": [fill.volume for fill in self.motion.fills],
            "volume_drawn": list(self.liquid.volume),
        }


@dataclass(frozen=True)
class DrawnRace:
    """A race as it is drawn: a ring as wide as its balls."""

    ring: int  #: its number among the chambers drawn
    radius: float  #: of the circle of the balls' centres, m
    ball: float  #: radius of a ball, m
    assumed: bool  #: the scene does not say how large the balls are
    #: numbers of its balls among those of all races, the first and the one behind the last
    balls: tuple[int, int]


@dataclass(frozen=True)
class RunupView:
    """A run-up frame by frame with its layers as they are drawn; f frames."""

    result: RunupAnswer  #: the run-up
    frames: RunupFrames  #: times, deflections and layers
    fills: tuple[Fill, ...]  #: chambers with their liquid; their middles along the axis, m
    places: tuple[float, ...]
    scale: Scale  #: common to all frames
    bodies: tuple[tuple[Liquid, ...], ...]  #: liquid of each chamber in each frame
    turn: Array  #: of the drum in each frame as drawn, rad, shape (f,)
    slower: float  #: how many times slower than in truth it turns
    parts: MachineParts  #: drum, housing, springs and dampers
    races: tuple[DrawnRace, ...] = ()  #: with balls, whose rings stand behind the chambers with liquid
    #: angle of each ball in the drum in each frame, rad, shape (f, N)
    balls: Array = field(default_factory=lambda: np.zeros((0, 0)))


@dataclass(frozen=True)
class ModeView:
    """One oscillation of the liquid in a spinning chamber, m(t) = Re(mode e^{-i sigma t})."""

    picture: ClassVar = "leblanc.view.film:mode_picture"
    film: ClassVar = "leblanc.view.film:mode_film"

    name: str  #: of the scene
    lying: bool  #: the axis is horizontal
    gravity: float  #: across the axis, left out of the mode, m/s^2
    number: int  #: from 1, by rising size of the frequency
    frequency: float  #: sigma seen from the drum, with the spin positive, rad/s
    crests: int  #: around the drum
    angle: Array  #: of the rays, rising, rad, shape (n,); two at a baffle
    displacement: Complex  #: of the surface along the radius, its largest size 1, shape (n,)
    lift: float  #: largest displacement as drawn, m; the true one is any small number
    depth_factor: float  #: of the layer's depth as drawn
    fill: Fill  #: the chamber with its liquid
    speed: float  #: of the spin, rad/s
    converged: bool  #: of the solver
    section: LiquidSection | None = None  #: the liquid at rest between walls of its own shape, and
    section_displacement: Complex | None = None  #: of each of its nodes; None between circular walls

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --mode --json` prints, SI."""
        return {"speed": self.speed, "frequency": self.frequency, "crests": self.crests}

    @property
    def drawn_depth(self) -> float:
        """Of the layer at rest as drawn, the least in a section of its own, m."""
        return self.depth_factor * self.fill.depth


@dataclass(frozen=True)
class TableView:
    """A vibrating table with balls at the moment when balls and unbalance both point along the vibration."""

    name: str  #: of the scene
    speed: float  #: of the shaft, rad/s
    stuck_speed: float  #: of the balls that stick together, rad/s
    slow: float  #: vibration of the platform by the balls and by the unbalance, m
    fast: float
    track_radius: float  #: of the balls' track, m
    balls: int  #: how many, and "ball" or "roller"
    kind: str
    factor: float  #: of the vibration as drawn

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a table, SI."""
        return {
            "speed": self.speed,
            "stuck_speed": self.stuck_speed,
            "slow": self.slow,
            "fast": self.fast,
            "deflection_factor": self.factor,
        }


@dataclass(frozen=True)
class BallView:
    """A machine with balls at some speeds; s speeds, c chambers, N balls. All in the drum frame."""

    result: BallsAnswer  #: what `run` says of them
    fills: tuple[Fill, ...]  #: chambers with liquid, then a ring without any for each race; their middles, m
    places: tuple[float, ...]
    moved: bool  #: some are drawn apart although the scene gives them one plane
    races: tuple[DrawnRace, ...]  #: with their balls
    deflection: Complex  #: of the axis at each of them, m, 0 where no state was found, shape (s, c)
    lean: Complex  #: slope of the axis along itself, rad, shape (s,)
    angle: Array  #: of each ball as drawn, rad, shape (s, N)
    apart: tuple[bool, ...]  #: balls that would cover one another are drawn side by side, shape (s,)
    scale: Scale  #: of the deflection and the depth of liquid
    bodies: tuple[tuple[Liquid, ...], ...]  #: liquid of each chamber at each speed
    parts: MachineParts  #: drum, housing, springs and dampers

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a machine with balls, SI; angles as `run` has them."""
        return {
            "speed": float(self.result.speed[-1]),
            "deflection": self.deflection[-1],
            "state": str(self.result.state[-1]),
            "ball_angle": self.result.ball_angle[-1],
            "stable": bool(self.result.stable[-1]),
            "deflection_factor": self.scale.deflection,
            "depth_factor": self.scale.depth,
        }
