"""Drum, housing, shaft, bearings, springs and dampers of a three-dimensional picture."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from leblanc.core.units import MM
from leblanc.plotting.bodies import MachineParts, Shell, Strut
from leblanc.view.parts import Instant, Label, Piece, Stage, line, placed
from meshes.arrays import Array, Complex, Indices

ROUND, SIDES = 91, 10  # points of a shell's circle, of a tube's
COILS, AROUND = 7, 18  # of a spring, points of each
# Lengths over the drum's radius.
COIL, WIRE, CYLINDER, ROD, GROUND = 0.062, 0.014, 0.05, 0.02, 0.16
BEARING, COLLAR, RIB, RIB_HALF = 0.16, 0.05, 0.13, math.radians(7.0)
OUTSIDE = 1.008
OPENED = math.radians(75.0)  # half the angle in which a housing is cut away before the eye
EYE = {
    True: math.radians(145.0),
    False: math.radians(-70.0),
}  # angle of the eye round a lying, a standing axis
HOLES, HOLE, CORNERS = 0.14, 0.014, 8  # between holes in a drum, their radius, corners of each
RIBS = np.radians([60.0, 180.0, 300.0])


def tube(points: Array, radius: float, sides: int = SIDES) -> tuple[Array, Indices]:
    """A round bar along a line of n points: points (n * sides, 3) and faces (m, 4).

    The radius is in the unit of the points.
    """
    along = np.gradient(points, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    # Any direction that is nowhere along the line, carried on from point to point.
    start = np.eye(3)[int(np.argmin(np.abs(along[0])))]
    across = np.empty_like(points)
    for k, way in enumerate(along):
        start = start - (start @ way) * way
        start = start / np.linalg.norm(start)
        across[k] = start
    other = np.cross(along, across)
    turn = 2.0 * math.pi * np.arange(sides) / sides
    ring = across[:, None] * np.cos(turn)[:, None] + other[:, None] * np.sin(turn)[:, None]
    row, column = np.meshgrid(np.arange(len(points) - 1), np.arange(sides), indexing="ij")
    here, beside = row * sides + column, row * sides + (column + 1) % sides
    faces = np.stack([here, beside, beside + sides, here + sides], axis=-1).reshape(-1, 4)
    return (points[:, None] + radius * ring).reshape(-1, 3), faces.astype(np.int64)


def coil(start: Array, end: Array, radius: float) -> Array:
    """Line of a coil spring between two points, straight at both ends, shape (n, 3)."""
    along = end - start
    size = float(np.linalg.norm(along))
    way = along / size
    side = np.cross(way, np.eye(3)[int(np.argmin(np.abs(way)))])
    side /= np.linalg.norm(side)
    other = np.cross(way, side)
    turn = np.linspace(0.0, 2.0 * math.pi * COILS, COILS * AROUND + 1)
    # The coil grows out of its axis and back into it.
    grown = radius * np.clip(np.minimum(turn, turn[-1] - turn) / math.pi, 0.0, 1.0)
    axial = size * (0.12 + 0.76 * turn / turn[-1])
    middle = (
        start
        + axial[:, None] * way
        + grown[:, None] * (np.cos(turn)[:, None] * side + np.sin(turn)[:, None] * other)
    )
    return np.concatenate([start[None], middle, end[None]])


def cylinder(name: str, look: str, start: Array, end: Array, radius: float) -> list[Piece]:
    """A cylinder with its ends closed, mm."""
    points, faces = tube(np.stack([start, end]), radius, 2 * SIDES)
    count = 2 * SIDES
    caps = []
    for first in (0, count):
        ring = np.concatenate([points[first : first + count], [start if first == 0 else end]])
        edge = np.arange(count)
        cells = np.stack([edge, (edge + 1) % count, np.full(count, count)], axis=-1).astype(np.int64)
        caps.append(Piece(name, ring, cells, look))
    return [Piece(name, points, faces, look), *caps]


def spring(name: str, start: Array, end: Array, size: float) -> list[Piece]:
    """A coil spring in a machine of a size, mm."""
    points, faces = tube(coil(start, end, COIL * size), WIRE * size)
    return [Piece(name, points, faces, "spring")]


def damper(name: str, start: Array, end: Array, size: float) -> list[Piece]:
    """A cylinder at the end and a rod in it from the start, in a machine of a size, mm."""
    inside, mouth = start + 0.6 * (end - start), start + 0.42 * (end - start)
    return [
        *cylinder(name, "rod", start, inside, ROD * size),
        *cylinder(name, "damper", mouth, end, CYLINDER * size),
    ]


def ground(name: str, end: Array, way: Array, size: float) -> list[Piece]:
    """A plate where a spring or damper ends, across it, in a machine of a size, mm.

    `way`: unit vector towards the ground.
    """
    return cylinder(name, "ground", end, end + 0.03 * size * way, 0.5 * GROUND * size)


def machine(stage: Stage, instant: Instant) -> tuple[list[Piece], list[Piece], list[Label]]:
    """Pieces of the machine that turn with the drum, pieces that do not, names of some of these."""
    parts = stage.parts
    if parts is None:
        return [], [], []
    still, labels = _struts(stage, instant, parts)
    if parts.housing is not None:
        still += _housing(stage, instant, parts.housing)
    for k, place in enumerate(parts.bearings):
        half = COLLAR * parts.drum.radius
        still += _solid_ring(stage, instant, f"bearing {k + 1}", place - half, place + half)
    for shaft in parts.shaft:
        ends = [_at(stage, instant, place, 0j, True) for place in (shaft.low, shaft.high)]
        still += cylinder("shaft", "shaft", ends[0], ends[1], shaft.radius * MM)
    return _drum(stage, instant, parts), still, labels


def moved(stage: Stage, instant: Instant, place: Array | float) -> Complex:
    """Deflection of the axis as drawn at a place along it, seen from the drum, m."""
    first = instant.deflection[0] if instant.deflection else 0j
    middle = stage.places[0] if stage.places else 0.0
    return np.asarray(stage.scale.deflection * (first + instant.lean * (np.asarray(place) - middle)))


def _at(stage: Stage, instant: Instant, place: float, across: complex, standing: bool) -> Array:
    """A point that moves with the axis but does not turn, mm; or one seen from the drum."""
    turn = np.exp(1j * instant.turn) if standing else 1.0
    return np.asarray(placed(stage, np.array([across + moved(stage, instant, place) * turn]), place)[0])


def _struts(stage: Stage, instant: Instant, parts: MachineParts) -> tuple[list[Piece], list[Label]]:
    """Springs, dampers and bushes, each with its ground; the first of a kind gets its name."""
    size = parts.drum.radius * MM
    pieces: list[Piece] = []
    labels: dict[str, Label] = {}
    count: dict[str, int] = {}
    for strut in parts.struts:
        count[strut.kind] = number = count.get(strut.kind, 0) + 1
        name = f"{strut.kind} {number}"
        start = _at(stage, instant, strut.axial, strut.across, True)
        if strut.kind == "bush":
            half = 0.5 * strut.length
            ends = [_at(stage, instant, strut.axial + way, strut.across, True) for way in (-half, half)]
            pieces += cylinder(name, "bush", ends[0], ends[1], 0.5 * strut.length * MM)
            continue
        end = ground_end(stage, strut)
        way = end - placed(stage, np.array([strut.across]), strut.axial)[0]
        pieces += (spring if strut.kind == "spring" else damper)(name, start, end, size)
        pieces += ground(f"ground of {name}", end, way / np.linalg.norm(way), size)
        pieces += _lug(stage, instant, parts, strut, name)
        x, y, z = (0.5 * (start + end)).tolist()
        labels.setdefault(strut.kind, Label(strut.kind, (x, y, z)))
    return pieces, list(labels.values())


def ground_end(stage: Stage, strut: Strut) -> Array:
    """Where a spring or damper stands on the ground, mm, shape (3,)."""
    plane = np.array([strut.across + strut.length * strut.aside])
    return np.asarray(placed(stage, plane, strut.axial + strut.length * strut.along)[0])


def _lug(stage: Stage, instant: Instant, parts: MachineParts, strut: Strut, name: str) -> list[Piece]:
    """Piece from the housing's wall to a spring or damper that holds it farther out."""
    shell = parts.housing
    if shell is None or abs(strut.across) <= 1.001 * shell.radius:
        return []
    foot = shell.radius * strut.across / abs(strut.across)
    place = min(max(strut.axial, shell.low), shell.high)
    start = _at(stage, instant, place, foot, True)
    end = _at(stage, instant, strut.axial, strut.across, True)
    return cylinder(f"lug of {name}", "lug", start, end, 0.03 * parts.drum.radius * MM)


def _ring(stage: Stage, instant: Instant, shell: Shell, place: float, turn: Array, standing: bool) -> Array:
    """Points of a shell's circle, mm."""
    shift = moved(stage, instant, place) * (np.exp(1j * instant.turn) if standing else 1.0)
    return placed(stage, shift + shell.radius * np.exp(1j * turn), place)


def _between(name: str, look: str, low: Array, high: Array) -> Piece:
    """Ruled surface between two lines of as many points."""
    first = np.arange(len(low) - 1)
    cells = np.stack([first, first + 1, first + 1 + len(low), first + len(low)], axis=-1)
    return Piece(name, np.concatenate([low, high]), cells.astype(np.int64), look)


def _housing(stage: Stage, instant: Instant, shell: Shell) -> list[Piece]:
    """Wall, back and rims of what does not turn, cut away before the eye."""
    eye = EYE[stage.lying]
    turn = np.linspace(eye + OPENED, eye + 2.0 * math.pi - OPENED, ROUND)
    low, high = (_ring(stage, instant, shell, place, turn, True) for place in (shell.low, shell.high))
    hub = Shell(BEARING * shell.radius, shell.low, shell.low)
    round_hub = _ring(stage, instant, hub, shell.low, turn, True)
    edges = [low, high]
    ends = [np.stack([low[k], high[k]]) for k in (0, -1)]
    return [
        *_straps(stage, instant, shell),
        _between("housing", "housing", low, high),
        _between("back of the housing", "housing", round_hub, low),
        *(Piece("edge of the housing", edge, line(len(edge)), "edge") for edge in (*edges, *ends)),
    ]


def _straps(stage: Stage, instant: Instant, shell: Shell) -> list[Piece]:
    """Rings round the whole housing where springs and dampers hold it."""
    assert stage.parts is not None
    turn, half = np.linspace(0.0, 2.0 * math.pi, 2 * ROUND - 1), 0.025 * shell.radius
    wide = Shell(1.004 * shell.radius, shell.low, shell.high)
    places = dict.fromkeys(
        min(max(strut.axial, shell.low + half), shell.high - half) for strut in stage.parts.struts
    )
    return [
        _between(
            "strap", "lug", *(_ring(stage, instant, wide, place + way, turn, True) for way in (-half, half))
        )
        for place in places
    ]


def _solid_ring(stage: Stage, instant: Instant, name: str, low: float, high: float) -> list[Piece]:
    assert stage.parts is not None
    ends = [_at(stage, instant, place, 0j, True) for place in (low, high)]
    return cylinder(name, "bearing", ends[0], ends[1], BEARING * stage.parts.drum.radius * MM)


def _drum(stage: Stage, instant: Instant, parts: MachineParts) -> list[Piece]:
    """Shell, back and ribs of a hollow drum; the disc of another. They turn."""
    # Outside the walls of the chambers, so that the two do not coincide.
    shell = replace(parts.drum, radius=OUTSIDE * parts.drum.radius)
    turn = np.linspace(0.0, 2.0 * math.pi, 2 * ROUND - 1)
    low, high = (_ring(stage, instant, shell, place, turn, False) for place in (shell.low, shell.high))
    hub = Shell(parts.shaft[0].radius if parts.shaft else 0.0, shell.low, shell.low)
    round_hub = _ring(stage, instant, hub, shell.low, turn, False)
    pieces = [_between("back of the drum", "drum back", round_hub, low)]
    pieces += _spokes(stage, instant, shell)
    if parts.hollow:
        pieces += [
            _between("drum", "drum", low, high),
            *(Piece("edge of the drum", edge, line(len(edge)), "edge") for edge in (low, high)),
            *_ribs(stage, instant, shell),
            _holes(stage, instant, shell),
        ]
    return pieces


def _spokes(stage: Stage, instant: Instant, shell: Shell) -> list[Piece]:
    """Three arms on the back, which show how the drum turns."""
    middle = complex(moved(stage, instant, shell.low))
    pieces = []
    for turn in RIBS.tolist():
        way = np.exp(1j * turn)
        ends = placed(stage, middle + np.array([0.12, 0.97]) * shell.radius * way, shell.low)
        pieces += cylinder("spoke", "rib", ends[0], ends[1], 0.02 * shell.radius * MM)
    return pieces


def _ribs(stage: Stage, instant: Instant, shell: Shell) -> list[Piece]:
    """Three ribs inside a drum, beside its chambers."""
    low, high = _free(stage, shell)
    if high - low < 0.3 * shell.radius:
        return []
    pieces = []
    for turn in RIBS.tolist():
        away = np.array([1.0, 1.0 - RIB, 1.0 - RIB, 1.0])
        corners: Complex = (
            shell.radius * away * np.exp(1j * (turn + RIB_HALF * np.array([-1.0, -0.4, 0.4, 1.0])))
        )
        ends = [
            placed(stage, corners + complex(moved(stage, instant, place)), place) for place in (low, high)
        ]
        # Faces apart, so that edges stay sharp.
        pieces += [_between("rib", "rib", ends[0][k : k + 2], ends[1][k : k + 2]) for k in range(3)]
        pieces += [Piece("rib", end, np.arange(4, dtype=np.int64)[None], "rib") for end in ends]
    return pieces


def _holes(stage: Stage, instant: Instant, shell: Shell) -> Piece:
    """Rows of small holes in the wall of a drum, away from its chambers."""
    low, high = _free(stage, shell)
    rows = max(1, round((high - low) / (HOLES * shell.radius)))
    places = low + (high - low) * (np.arange(rows) + 0.5) / rows
    count = round(2.0 * math.pi / HOLES)
    turn = 2.0 * math.pi * (np.arange(count)[:, None] + 0.5 * (np.arange(rows) % 2)) / count
    corner = 2.0 * math.pi * np.arange(CORNERS) / CORNERS
    at = turn[..., None] + HOLE * np.cos(corner)
    height = places[:, None] + HOLE * shell.radius * np.sin(corner) + 0.0 * at
    plane: Complex = shell.radius * np.exp(1j * at) + moved(stage, instant, height)
    cells = np.arange(plane.size, dtype=np.int64).reshape(-1, CORNERS)
    return Piece("holes", placed(stage, plane.ravel(), height.ravel()), cells, "hole")


def _free(stage: Stage, shell: Shell) -> tuple[float, float]:
    """The longest part of a drum without a chamber."""
    taken = sorted(
        (place - 0.5 * fill.chamber.height, place + 0.5 * fill.chamber.height)
        for fill, place in zip(stage.fills, stage.places, strict=True)
    )
    starts = [shell.low, *(end for _, end in taken)]
    ends = [*(start for start, _ in taken), shell.high]
    return max(zip(starts, ends, strict=True), key=lambda gap: gap[1] - gap[0])
