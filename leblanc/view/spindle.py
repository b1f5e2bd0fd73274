"""Picture of a spindle unit in a natural motion: beams of sections, bearings, clamps, masses, stations."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import MM, number
from leblanc.view.film import ROUND, Film
from leblanc.view.machine import cylinder, ground, spring
from leblanc.view.parts import NO_CELLS, Label, Picture, Piece, bar_length, line
from leblanc.wings.spindle.geometry import DrawnBeam, DrawnJoint, SpindleView
from meshes.arrays import Array, Indices

SIDES = 48  # round a section
OPEN = math.radians(65.0)  # half the angle in which a hollow beam is cut away before the eye
EYE = math.radians(200.0)  # where that is, from the first direction across the axis to the second
STEP = 24  # pieces along a section
GAP = 0.5  # between beams side by side, over the radius of the wider one
# Radius of a marked station and half the length of a bearing, over the widest radius.
SPOT, COLLAR = 0.09, 0.07


def spindle_picture(view: SpindleView, phase: float = 0.0) -> Picture:
    """Picture of a spindle unit at a phase of its natural motion, rad, 0 at the largest deflection."""
    size, swing = max(beam.radius for beam in view.beams), view.factor * math.cos(phase)
    below = _offsets(view)
    pieces: list[Piece] = []
    for k, beam in enumerate(view.beams):
        pieces += _beam(beam, swing, below[k])
    for count, joint in enumerate(view.joints, start=1):
        pieces += _joint(view, joint, count, swing, below, size)
    pieces += _masses(view, swing, below)
    spots, labels = _stations(view, swing, below, size)
    low = min(section.start for beam in view.beams for section in beam.sections)
    high = max(section.end for beam in view.beams for section in beam.sections)
    rest = np.array([[low - 0.5 * size, 0.0, 0.0], [high + 0.5 * size, 0.0, 0.0]]) * MM
    pieces += [*spots, Piece("axis at rest", rest, line(2), "axis at rest")]
    bar, name = _bar(view, below, low, size)
    for beam, offset in zip(view.beams, below, strict=True):
        place = 0.5 * (beam.sections[0].start + beam.sections[-1].end)
        x, y, z = _centre(beam, place, swing, offset).tolist()
        labels.append(Label(beam.name.replace("_", " "), (x, y, z + beam.sections[-1].diameter * 0.5 * MM)))
    hertz = view.frequency / (2.0 * math.pi)
    caption = [
        f"Natural motion {view.number} of {view.count} in the band, without damping; how large it is drawn "
        "says nothing.",
        "Lengths, diameters and bores to scale; hollow beams are cut open in front.",
        "Masses are drawn as discs of steel with their mass and inertia.",
    ]
    if any(beam.level for beam in view.beams):
        caption.append("A beam with no room for another in its bore is drawn beside it, below.")
    if view.assumed:
        caption.append("Some values of the scene are assumed.")
    return Picture(
        (*pieces, bar),
        (*labels, name),
        f"{one_line(view.name)}: natural motion at {number(hertz)} Hz",
        f"{number(view.frequency)} rad/s; moves most: {_most(view)}",
        " ".join(caption),
        lying=True,
        long=True,
        frame=np.concatenate([piece.points for piece in (*_extremes(view, below), bar)]),
    )


def spindle_film(view: SpindleView, frames: int = ROUND) -> Film:
    """A period of a natural motion in so many frames."""
    return Film(frames, lambda k: spindle_picture(view, 2.0 * math.pi * k / frames))


def _offsets(view: SpindleView) -> list[float]:
    """How far below the axis each beam lies, m: beams of one level at one height."""
    found = {0: 0.0}
    widest = {
        level: max(beam.radius for beam in view.beams if beam.level == level)
        for level in {beam.level for beam in view.beams}
    }
    for level in sorted(widest)[1:]:
        room = widest[level - 1] + widest[level]
        found[level] = (
            found[level - 1] - room - GAP * max(widest[level - 1], widest[level]) - 2.0 * view.factor
        )
    return [found[beam.level] for beam in view.beams]


def _centre(beam: DrawnBeam, place: float, swing: float, offset: float) -> Array:
    """Point of a beam's axis, mm; the motion is upward."""
    moved = float(np.interp(place, beam.place, beam.deflection))
    return np.array([place, 0.0, offset + swing * moved]) * MM


def _beam(beam: DrawnBeam, swing: float, offset: float) -> list[Piece]:
    """Sections of a beam along its bent axis, hollow ones open in front."""
    hollow = any(section.bore > 0.0 for section in beam.sections)
    pieces = []
    for section in beam.sections:
        place = np.linspace(section.start, section.end, STEP + 1)
        height = offset + swing * np.interp(place, beam.place, beam.deflection)
        points, faces = revolved(place, height, 0.5 * section.diameter, 0.5 * section.bore, hollow)
        look = "rib" if hollow else "shaft"
        pieces += [Piece(f"beam {beam.name}", points * MM, face, look) for face in faces]
    return pieces


def revolved(
    place: Array, height: Array, radius: float, bore: float, opened: bool = False
) -> tuple[Array, list[Indices]]:
    """A round section along a bent axis, m: points (2 n a, 3), faces of outer wall, bore and each end.

    Normals of the faces point outwards where they are closed; a bore of 0 is none; `opened`: cut away before
    the eye.
    """
    turn = (
        np.linspace(EYE + OPEN, EYE + 2.0 * math.pi - OPEN, SIDES + 1)
        if opened
        else (np.linspace(0.0, 2.0 * math.pi, SIDES + 1))
    )
    rings = [
        np.stack(
            [
                np.broadcast_to(place[:, None], (place.size, turn.size)),
                np.broadcast_to(size * np.cos(turn), (place.size, turn.size)),
                height[:, None] + size * np.sin(turn),
            ],
            axis=-1,
        )
        for size in (radius, bore)
    ]
    points = np.concatenate([ring.reshape(-1, 3) for ring in rings])
    index = np.arange(2 * place.size * turn.size).reshape(2, place.size, turn.size)
    outer, inner = index
    ends = [
        _ruled(inner[0], outer[0]),
        _ruled(outer[-1], inner[-1]),
    ]
    walls = [_strip(outer)] + ([_strip(inner[:, ::-1])] if bore > 0.0 else [])
    cuts = [_ruled(outer[:, 0], inner[:, 0]), _ruled(inner[:, -1], outer[:, -1])] if opened else []
    return points, [*walls, *ends, *cuts]


def _strip(index: Indices) -> Indices:
    """Faces between rows and columns of numbered points."""
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    return np.stack([a, b, c, d], axis=-1).reshape(-1, 4)


def _ruled(first: Indices, second: Indices) -> Indices:
    """Faces between two rows of points."""
    return _strip(np.stack([first, second]))


def _joint(
    view: SpindleView, joint: DrawnJoint, count: int, swing: float, below: list[float], size: float
) -> list[Piece]:
    """A bearing between beams inside one another, a collar where they meet, a spring between those beside."""
    name, first = f"joint {count}", view.beams[joint.first]
    start = _centre(first, joint.place, swing, below[joint.first])
    if joint.second is None:
        foot = np.array([joint.place, 0.0, below[joint.first] - first.radius - 1.6 * size]) * MM
        top = start - np.array([0.0, 0.0, _half(first, joint.place) * MM])
        way = np.array([0.0, 0.0, -1.0])
        return [*spring(name, top, foot, size * MM), *ground(f"ground of {name}", foot, way, 2.0 * size * MM)]
    second = view.beams[joint.second]
    end = _centre(second, joint.place, swing, below[joint.second])
    if first.level != second.level:
        upper, lower = (first, second) if start[2] > end[2] else (second, first)
        top, foot = (start, end) if start[2] > end[2] else (end, start)
        top = top - np.array([0.0, 0.0, _half(upper, joint.place) * MM])
        foot = foot + np.array([0.0, 0.0, _half(lower, joint.place) * MM])
        return spring(name, top, foot, size * MM)
    halves = sorted((_half(first, joint.place), _half(second, joint.place)))
    inner = second if _half(second, joint.place) == halves[0] else first
    outer = first if inner is second else second
    bore = min(
        (
            0.5 * section.bore
            for section in outer.sections
            if section.start - 1e-9 <= joint.place <= section.end + 1e-9 and section.bore > 0.0
        ),
        default=0.0,
    )
    half = COLLAR * size
    place = joint.place + np.array([-half, half])
    if bore > halves[0]:
        level = 0.5 * (start[2] + end[2]) / MM
        points, faces = revolved(place, np.full(2, level), bore, halves[0], opened=True)
        return [Piece(name, points * MM, face, "bearing") for face in faces]
    points, faces = revolved(place, np.full(2, start[2] / MM), 1.04 * halves[1], 0.0)
    return [Piece(name, points * MM, face, "bearing") for face in faces]


def _half(beam: DrawnBeam, place: float) -> float:
    """Radius of a beam at a place, the larger one where two sections meet, m."""
    return 0.5 * max(
        section.diameter for section in beam.sections if section.start - 1e-9 <= place <= section.end + 1e-9
    )


def _masses(view: SpindleView, swing: float, below: list[float]) -> list[Piece]:
    """Discs on the beams."""
    pieces = []
    for count, mass in enumerate(view.masses, start=1):
        beam = view.beams[mass.beam]
        ends = [
            _centre(beam, mass.place + way * mass.thickness, swing, below[mass.beam]) for way in (-0.5, 0.5)
        ]
        pieces += cylinder(f"mass {count}", "lug", ends[0], ends[1], mass.radius * MM)
    return pieces


def _stations(
    view: SpindleView, swing: float, below: list[float], size: float
) -> tuple[list[Piece], list[Label]]:
    """Where the force acts, where is measured, where the vibration is wanted."""
    pieces, labels = [], []
    for station in view.stations:
        beam = view.beams[station.beam]
        spot = _centre(beam, station.place, swing, below[station.beam])
        spot = spot + np.array([0.0, 0.0, (_half(beam, station.place) + SPOT * size) * MM])
        pieces.append(Piece(station.name, spot[None], NO_CELLS, "point", SPOT * size * MM))
        x, y, z = spot.tolist()
        labels.append(Label(station.name, (x, y, z)))
    return pieces, labels


def _extremes(view: SpindleView, below: list[float]) -> list[Piece]:
    """All beams at both ends of the motion, and the ground: what the camera keeps in sight."""
    found = [
        piece
        for way in (1.0, -1.0)
        for beam, offset in zip(view.beams, below, strict=True)
        for piece in _beam(beam, way * view.factor, offset)
    ]
    size = max(beam.radius for beam in view.beams)
    found += [piece for way in (1.0, -1.0) for piece in _masses(view, way * view.factor, below)]
    for joint in view.joints:
        if joint.second is None:
            found += _joint(view, joint, 0, 0.0, below, size)
    return found


def _bar(view: SpindleView, below: list[float], low: float, size: float) -> tuple[Piece, Label]:
    """Scale bar below the machine."""
    length = bar_length(2.0 * size)
    z = (
        min(offset - beam.radius for beam, offset in zip(view.beams, below, strict=True))
        - view.factor
        - 0.4 * size
    )
    points = np.array([[low, 0.0, z], [low + length, 0.0, z]]) * MM
    x, y, height = points.mean(axis=0).tolist()
    return Piece("scale bar", points, line(2), "bar"), Label(f"{length * MM:g} mm", (x, y, height))


def _most(view: SpindleView) -> str:
    """The beam that moves most."""
    sizes = [float(np.abs(beam.deflection).max()) for beam in view.beams]
    return view.beams[int(np.argmax(sizes))].name.replace("_", " ")
