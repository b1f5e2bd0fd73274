"""The three-dimensional picture of a machine at one instant: chambers, walls, liquid, marks; stills."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from leblanc.core.notes import one_line
from leblanc.core.units import DEGREE, LENGTH, MINUS, Unit, in_rpm, unit_for
from leblanc.plotting.bodies import DrawnLiquid, LiquidBodies, LiquidShape, MachineMotion, Scale, strips
from leblanc.plotting.chambers import plates
from leblanc.plotting.page import zero_of
from leblanc.studies.run.words import amplitude_place
from leblanc.view.cabinet import around, corners
from leblanc.view.machine import ground_end, machine
from leblanc.view.parts import (
    ABOVE,
    AWAY,
    BELOW,
    ROUND,
    Instant,
    Label,
    Picture,
    Piece,
    Stage,
    axes,
    circle,
    line,
    marks,
    placed,
    signs,
    turned,
)
from meshes.arrays import Array, Complex, Indices
from meshes.bodies.body import WALL_PARTS
from meshes.chamber import Chamber
from meshes.chamber_section import ChamberSection
from meshes.liquid_section import free_sides
from meshes.section import Section

STEPS = 4  # straight pieces of a curved side
_SAME = 1e-9  # of the farthest point: ends nearer to each other are one
_PARTS = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])  # of a curved triangle

SKIN = 0.003  # walls are drawn so much outside the liquid, over the radius, so that the two do not coincide
_ON_PLATE = 1e-6  # of a plate's length, that a face may be off it


@dataclass(frozen=True)
class Outline:
    """Sides of a section, each as straight pieces with k points, from the geometric axis."""

    walls: Complex  #: complex, m, shape (n, k), with the section on the left
    outwards: Complex  #: unit vectors out of the section at these points, complex, shape (n, k)
    plates: Complex  #: both sides of baffles without thickness, each pair once, m, shape (m, k)


def outline(section: Section) -> Outline:
    """Walls of a section about the geometric axis, those without thickness apart."""
    sides = free_sides(section.triangles)
    plane = section.points[:, 0] + 1j * section.points[:, 1]
    curved = sides.shape[1] == 3
    start, end = plane[sides[:, 0]], plane[sides[:, 1]]
    middle = plane[sides[:, 2]] if curved else 0.5 * (start + end)
    t = np.linspace(0.0, 1.0, STEPS + 1 if curved else 2)
    at = np.stack([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)])
    slope = np.stack([4 * t - 3, 4 - 8 * t, 4 * t - 1])
    nodes = np.stack([start, middle, end], axis=1)
    points, along = nodes @ at, nodes @ slope
    out = -1j * along / np.abs(along)
    same = _SAME * float(np.abs(plane).max())
    pair = _pairs(start, end, same)
    double = np.bincount(pair)[pair] == 2  # sides at the place of another one: the two faces of a baffle
    # One direction where two sides meet.
    total = np.zeros(plane.size, dtype=complex)
    for k, column in ((0, 0), (1, -1)):
        np.add.at(total, sides[~double, k], out[~double, column])
    size = np.abs(total)
    mean = np.divide(total, size, out=np.zeros_like(total), where=size > 0.0)
    out[:, 0], out[:, -1] = mean[sides[:, 0]], mean[sides[:, 1]]
    first = double & (np.arange(len(sides)) == _first(start, end, same))
    walls, outwards, plates = (
        np.asarray(values, dtype=complex) for values in (points[~double], out[~double], points[first])
    )
    return Outline(walls, outwards, plates)


def _pairs(start: Complex, end: Complex, same: float) -> NDArray[np.int64]:
    """Number of each side, alike for two between the same ends."""
    grid = np.stack([start.real, start.imag, end.real, end.imag], axis=1)
    cells = np.rint(grid / same).astype(np.int64)
    swap = (cells[:, 0] > cells[:, 2]) | ((cells[:, 0] == cells[:, 2]) & (cells[:, 1] > cells[:, 3]))
    cells[swap] = cells[swap][:, [2, 3, 0, 1]]
    return np.unique(cells, axis=0, return_inverse=True)[1].ravel().astype(np.int64)


def _first(start: Complex, end: Complex, same: float) -> NDArray[np.int64]:
    """The first side of the number that each has."""
    number = _pairs(start, end, same)
    return np.unique(number, return_index=True)[1][number].astype(np.int64)


def plates_of(chamber: Chamber, depth: float) -> Complex:
    """Baffles as lines from the geometric axis, m, shape (m, k).

    `depth`: by which the liquid layer is drawn deeper, m; distances of baffles from the wall grow with it.
    """
    if chamber.section is not None:
        return outline(chamber.section.mesh).plates
    if chamber.baffles is None:
        return np.empty((0, 2), dtype=complex)
    ends = np.array(plates(chamber.baffles, chamber.radius, depth))
    inner = np.maximum(np.abs(ends[:, :1]), chamber.inner_radius) * np.exp(1j * np.angle(ends[:, 1:]))
    return np.concatenate([inner, ends[:, 1:]], axis=1)


def baffles(stage: Stage, lines: Complex, k: int, centre: complex, floor: float, lid: float) -> list[Piece]:
    """Plates over the whole height of chamber k, counted from 0; lines as from `plates_of`.

    `centre` of the chamber as drawn, `floor` and `lid` along the axis, m.
    """
    return [_ruled(stage, f"baffle {k + 1}", "metal", centre + plate[None], floor, lid) for plate in lines]


def section_walls(
    stage: Stage, section: ChamberSection, k: int, centre: complex, floor: float, lid: float, skin: float
) -> list[Piece]:
    """Walls, floor, lid and their rims of chamber k, counted from 0.

    `centre` of the chamber as drawn, `floor` and `lid` along the axis, m; walls are drawn by `skin` outside
    the liquid, m.
    """
    sides = outline(section.mesh)
    walls = centre + sides.walls + skin * sides.outwards
    mesh = section.mesh
    across = centre + mesh.points[:, 0] + 1j * mesh.points[:, 1]
    number = np.arange(walls.size).reshape(walls.shape)
    edges = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=-1).astype(np.int64)
    return [
        _ruled(stage, f"wall {k + 1}", "wall", walls, floor, lid),
        Piece(f"floor {k + 1}", placed(stage, across, floor), straight(mesh.triangles), "floor"),
        Piece(f"lid {k + 1}", placed(stage, across, lid), straight(mesh.triangles), "lid"),
        *(
            Piece(f"rim {k + 1}", placed(stage, walls.ravel(), height), edges, "rim")
            for height in (floor, lid)
        ),
    ]


def straight(triangles: Indices) -> Indices:
    """Triangles with straight sides, four for one with curved sides; shape (m, 3) or (m, 6)."""
    return triangles if triangles.shape[1] == 3 else triangles[:, _PARTS].reshape(-1, 3)


def _ruled(stage: Stage, name: str, look: str, lines: Complex, floor: float, lid: float) -> Piece:
    """Upright faces on lines across the axis, shape (n, k)."""
    low = np.arange(lines.size).reshape(lines.shape)
    start, other = low[:, :-1].ravel(), low[:, 1:].ravel()
    cells: Indices = np.stack([start, other, other + lines.size, start + lines.size], axis=-1).astype(
        np.int64
    )
    plane = lines.ravel()
    points = np.concatenate([placed(stage, plane, floor), placed(stage, plane, lid)])
    return Piece(name, points, cells, look)


def compose(stage: Stage, instant: Instant) -> Picture:
    """Picture of a machine at one instant."""
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
    carried, standing, held = machine(stage, instant)
    with_drum, outside, named = around(stage, instant)
    lines, axis_names = axes(stage, instant)
    spots, names = marks(stage, instant)
    shown, sign_names = signs(stage, instant)
    turning = [*pieces, *carried, *with_drum, *lines, *spots]
    return Picture(
        pieces=(
            *(replace(piece, points=turned(stage, piece.points, instant.turn)) for piece in turning),
            *standing,
            *outside,
            *shown,
        ),
        labels=(
            *(_turned_label(stage, label, instant.turn) for label in (*axis_names, *names)),
            *sign_names,
            *held,
            *named,
        ),
        title=instant.title,
        state=instant.state,
        caption=instant.caption,
        lying=stage.lying,
        long=stage.ends[1] - stage.ends[0] > 2.0 * stage.radius,
        frame=np.concatenate([_frame(stage), *(piece.points for piece in shown)]),
    )


def _turned_label(stage: Stage, label: Label, turn: float) -> Label:
    x, y, z = turned(stage, np.array([label.place]), turn)[0].tolist()
    return Label(label.text, (x, y, z))


def _frame(stage: Stage) -> Array:
    """Points that stay in sight whatever the machine does, mm."""
    low, high = stage.whole
    points = []
    if stage.parts is not None:
        points = [ground_end(stage, strut)[None] for strut in stage.parts.struts]
        if stage.parts.feet:
            points += [*corners(stage)]
    round_it = circle(0j, max(AWAY * stage.radius + stage.swing, 1.04 * stage.reach))
    ends = np.array([low - BELOW * stage.radius, high + ABOVE * stage.radius])
    rings = [placed(stage, round_it, height) for height in stage.ends]
    if stage.parts is not None:
        drum = stage.parts.drum
        edge = circle(0j, drum.radius + stage.swing)
        rings += [placed(stage, edge, height) for height in (drum.low, drum.high)]
    return np.concatenate([*rings, placed(stage, np.zeros(2), ends), *points])


def _between(stage: Stage, name: str, look: str, *edges: tuple[Complex, float]) -> Piece:
    """Ruled surface between two curves, each at its height."""
    (lower, low), (other, high) = edges
    points = np.concatenate([placed(stage, lower, low), placed(stage, other, high)])
    first = np.arange(lower.size - 1)
    cells = np.stack([first, first + 1, first + 1 + lower.size, first + lower.size], axis=-1)
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
    diagonal, other = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    area = np.linalg.norm(np.cross(diagonal, other), axis=1)
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
            Piece(f"liquid {k + 1}", points, wall[bare & (part == kind)], "liquid")
            for kind in range(len(WALL_PARTS))
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
    number = max(int(edge.max(initial=0)) for edge in edges) + 1
    open_, closed = (edge[:, 0] * number + edge[:, 1] for edge in edges)
    return np.asarray(edges[0][np.isin(open_, closed)], dtype=np.int64)


def stage_of(motion: MachineMotion, scale: Scale) -> Stage:
    """What is fixed in pictures of a machine, of a scale common to all."""
    size = np.nan_to_num(np.abs(motion.deflection))
    tilting = motion.response.motion
    return Stage(
        fills=motion.fills,
        places=motion.places,
        lying=motion.response.axis == "horizontal",
        scale=scale,
        swing=scale.deflection * float(size.max(initial=0.0)),
        zero="unbalance" if tilting is None or tilting.zero == "unbalance" else "angle 0",
        parts=motion.parts,
    )


def still(
    motion: MachineMotion,
    index: int,
    liquid: DrawnLiquid,
    stage: Stage | None = None,
    turn: float = 0.0,
    said: str = "",
) -> Picture:
    """Picture of a machine at one of its speeds, the drum turned by `turn`, rad.

    `stage` of several pictures; of this one alone if None. `said`: sentence of a film about it, in place of
    that of a still.
    """
    found = motion.deflection[index]
    deflection = np.where(np.isfinite(found), found, 0.0)
    lean = complex(motion.lean[index])
    instant = Instant(
        deflection=tuple(map(complex, deflection)),
        lean=lean if cmath.isfinite(lean) else 0j,
        bodies=liquid.bodies,
        title=describe_speed(motion.response.name, float(motion.speed[index])),
        state="\n".join(describe_state(motion, index, liquid.dry)),
        caption=" ".join(describe_drawing(motion, index, liquid, said or "Seen from the drum.")),
        turn=turn,
    )
    return compose(stage_of(motion, liquid.scale) if stage is None else stage, instant)


def describe_speed(name: str, speed: float) -> str:
    """Title of a picture at a speed, rad/s."""
    return f"{one_line(name)}: {in_rpm(speed)} ({speed:.4g} rad/s)"


def describe_state(motion: MachineMotion, index: int, dry: Sequence[bool]) -> list[str]:
    """Deflection and liquid of a machine at one of its speeds, a line each.

    `dry`: the wall of each chamber is dry in part there.
    """
    found, answer = motion.deflection[index], motion.response.response
    if not np.isfinite(found).all():
        return ["no bounded deflection found: the axis is drawn at rest"]
    lines, part, unit = [], "deflection", unit_at(motion, index)
    several = len({round(abs(deflection), 12) for deflection in found}) > 1
    if motion.response.motion is not None:
        size = unit.text(float(motion.response.amplitude[index]))
        lines.append(f"amplitude {amplitude_place(motion.response)}: {size}")
        part = "with the spin"
    for k, deflection in enumerate(found):
        if k == 0 or several:
            name = f"chamber {k + 1}: {part}" if several else part
            lines.append(f"{name} {place_in_words(complex(deflection), zero_of(motion.response), unit)}")
    if not motion.fills:
        return [*lines, "no liquid"]
    which = [str(k + 1) for k, here in enumerate(dry) if here]
    wall = "wall wet all round" if not which else "wall dry in part"
    if which and len(motion.fills) > 1:
        wall += f" in chamber{'s' if len(which) > 1 else ''} {', '.join(which)}"
    lines.append(f"{wall}; liquid model {answer.model[index]}")
    if not answer.in_range[index]:
        lines.append("out of the range in which the models hold")
    stability = motion.response.stability[index]
    if stability == "unstable":
        lines.append("not stable: this motion would not last")
    elif stability == "not_known":
        lines.append("stability not known")
    return lines


def unit_at(motion: MachineMotion, index: int) -> Unit:
    """The unit of all amplitudes and deflections that stand beside a picture."""
    found = np.abs(motion.deflection[index]).tolist()
    return unit_for(LENGTH, float(motion.response.amplitude[index]), *found)


def place_in_words(deflection: complex, zero: str, unit: Unit) -> str:
    """Size and angle of a deflection of m, in words; `zero`: what angles count from."""
    if deflection == 0.0:
        return "none"
    angle = f"{math.degrees(cmath.phase(deflection)):.0f}"
    angle = "0" if angle == "-0" else angle.replace("-", MINUS)
    return f"{unit.text(abs(deflection))} at {angle}{DEGREE} from {zero}"


def describe_drawing(motion: MachineMotion, index: int, liquid: DrawnLiquid, seen: str) -> list[str]:
    """How a machine is drawn, sentence by sentence; `seen` says from where."""
    scale = liquid.scale
    parts = [scale.in_words(), seen]
    if motion.fills and scale != Scale():
        parts.append("The liquid is in equilibrium with the deflection as drawn.")
    wrong = [here for there, here in zip(liquid.dry, liquid.drawn_dry, strict=True) if here != there]
    if wrong:
        parts.append(f"A wall is {'dry in part' if wrong[0] else 'wet all round'} in the picture alone.")
    if any(fill.compartments > 1 for fill in motion.fills):
        parts.append("Baffles close the compartments: each keeps its volume.")
    open_ = [fill for fill in motion.fills if fill.chamber.baffles is not None and fill.compartments == 1]
    if scale.depth > 1.0 and open_:
        parts.append("Distances of the baffles from the wall grow with the depth.")
    if names := dict.fromkeys(
        fill.chamber.section.name for fill in motion.fills if fill.chamber.section is not None
    ):
        parts.append(f"Section from {', '.join(names)}.")
    if motion.moved:
        parts.append("Chambers drawn one behind the other; the scene does not say where they are.")
    tilting, answer = motion.response.motion, motion.response.response
    if tilting is not None and abs(tilting.backward[index]) > 0.01 * abs(answer.deflection[index]):
        parts.append(
            "Drawn is the part that turns with the spin; "
            f"{unit_at(motion, index).text(float(abs(tilting.backward[index])))} turn against it."
        )
    if motion.parts.sketched:
        parts.append(motion.parts.sketched)
    if motion.response.assumed:
        parts.append("Some values of the scene are assumed.")
    return parts
