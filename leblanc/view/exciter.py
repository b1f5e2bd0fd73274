"""Picture of a vibrating table: platform, springs, track with its balls, unbalance of the shaft."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import LENGTH, MM, in_rpm, unit_for
from leblanc.plotting.bodies import TableView
from leblanc.view.machine import cylinder, damper, spring, tube
from leblanc.view.parts import NO_CELLS, Label, Picture, Piece, bar_length, circle, line
from meshes.arrays import Array, Indices

# Lengths over the radius of the track, chosen for the picture: a scene does not give them.
HALF, THICK, BELOW, SPRING, BALL, SPOT = 1.9, 0.18, 1.5, 1.2, 0.22, 0.09


def table_picture(table: TableView) -> Picture:
    """Picture of a table with balls at the moment when balls and unbalance point along the vibration."""
    track, factor = table.track_radius, table.factor
    pieces = _table(track) + _rotor(track, table.balls)
    swing, names = _swing(track, factor * (table.slow + table.fast))
    bar, name = _bar(track)
    caption = [
        f"Vibration drawn {factor:g} times larger; radius of the track to scale.",
        "Platform, springs and size of the balls are not in the scene and only sketched.",
        "Balls and unbalance turn at different speeds; drawn is a moment when they line up.",
    ]
    unit = unit_for(LENGTH, table.slow, table.fast)
    state = [
        f"balls stuck together at {in_rpm(table.stuck_speed)}: platform {unit.text(table.slow)}",
        f"unbalance of the shaft: platform {unit.text(table.fast)}",
    ]
    labels = [
        Label("unbalance", (0.0, 0.0, 0.55 * track * MM)),
        Label(f"{table.balls} {table.kind}s", (0.0, 0.0, track * MM)),
        Label("spring", (0.8 * HALF * track * MM, 0.8 * HALF * track * MM, -2.1 * track * MM)),
        Label("damper", (0.8 * HALF * track * MM, 0.0, -2.3 * track * MM)),
        *names,
        name,
    ]
    frame = np.concatenate([piece.points for piece in (*pieces, *swing, bar)])
    return Picture(
        (*pieces, *swing, bar),
        tuple(labels),
        f"{one_line(table.name)}: shaft at {in_rpm(table.speed)} ({table.speed:.4g} rad/s)",
        "\n".join(state),
        " ".join(caption),
        lying=True,
        long=False,
        frame=frame,
    )


def _box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[Array, Indices]:
    corners = np.array(
        [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    )
    faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners * MM, np.array(faces, dtype=np.int64)


def _table(track: float) -> list[Piece]:
    """Platform under the track, four springs, the floor."""
    half, top = HALF * track, -1.3 * track
    under = top - THICK * track
    points, faces = _box((-half, -half, under), (half, half, top))
    # Faces apart, so that edges stay sharp.
    plate = [Piece("platform", points[face], np.arange(4, dtype=np.int64)[None], "rib") for face in faces]
    floor = under - SPRING * track
    ground = (
        np.array([[-half, -half, floor], [half, -half, floor], [half, half, floor], [-half, half, floor]])
        * MM
    )
    held = []
    for k, (x, y) in enumerate([(-0.8, -0.8), (-0.8, 0.8), (0.8, -0.8), (0.8, 0.8)], start=1):
        ends = np.array([[x * half, y * half, under], [x * half, y * half, floor]]) * MM
        held += spring(f"spring {k}", ends[0], ends[1], 2.0 * track * MM)
    ends = np.array([[0.8 * half, 0.0, under], [0.8 * half, 0.0, floor]]) * MM
    held += damper("damper", ends[0], ends[1], 2.0 * track * MM)
    return [*plate, Piece("ground", ground, np.arange(4, dtype=np.int64)[None], "ground"), *held]


def _rotor(track: float, count: int) -> list[Piece]:
    """Track, balls about its top, unbalance on the shaft, the shaft."""
    pieces = []
    for radius in ((1.0 - BALL) * track, (1.0 + BALL) * track):
        ring = circle(0j, radius)
        for x in (-BALL * track, BALL * track):
            edge = np.stack([np.full(ring.size, x), ring.real, ring.imag], axis=-1) * MM
            pieces.append(Piece("track", *tube(edge, 0.03 * track * MM), "shaft"))
    # Side by side about the direction of the vibration.
    apart = 2.0 * math.asin(min(1.0, BALL))
    angle = 0.5 * math.pi + apart * (np.arange(count) - 0.5 * (count - 1))
    balls = np.stack([np.zeros(count), track * np.cos(angle), track * np.sin(angle)], axis=-1) * MM
    pieces.append(Piece("balls", balls, NO_CELLS, "ball", 0.95 * BALL * track * MM))
    arm = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.55 * track]]) * MM
    pieces.append(Piece("arm", arm, line(2), "arm"))
    pieces.append(Piece("unbalance", arm[1:], NO_CELLS, "unbalance", SPOT * track * MM))
    shaft = np.array([[-0.9 * track, 0.0, 0.0], [0.9 * track, 0.0, 0.0]]) * MM
    return [*pieces, *cylinder("shaft", "shaft", shaft[0], shaft[1], 0.07 * track * MM), *_posts(track)]


def _posts(track: float) -> list[Piece]:
    """What carries the shaft on the platform."""
    pieces = []
    for x in (-0.8, 0.8):
        for y in (-0.5, 0.5):
            ends = np.array([[x, 0.0, 0.0], [x, y, -1.3]]) * track * MM
            pieces += cylinder("post", "lug", ends[0], ends[1], 0.05 * track * MM)
    return pieces


def _swing(track: float, size: float) -> tuple[list[Piece], list[Label]]:
    """Arrow of the vibration, up and down from the middle of the platform's edge."""
    y, middle = 1.15 * HALF * track, -1.3 * track
    x = HALF * track
    ends = [np.array([[x, y, middle], [x, y, middle + sign * size]]) * MM for sign in (1.0, -1.0)]
    name = Label("vibration", (x * MM, y * MM, (middle + size) * MM))
    return [Piece("vibration", end, line(2), "spin") for end in ends], [name]


def _bar(track: float) -> tuple[Piece, Label]:
    """Scale bar beside the platform."""
    length = bar_length(track)
    y, z = -HALF * track, -(1.3 + THICK + SPRING + 0.25) * track
    points = np.array([[HALF * track, y, z], [HALF * track, y + length, z]]) * MM
    name = Label(f"{length * MM:g} mm", (HALF * track * MM, (y + 0.5 * length) * MM, z * MM))
    return Piece("scale bar", points, line(2), "bar"), name
