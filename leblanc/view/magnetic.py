"""Picture of a rotor in magnetic bearings: the rotor in its gap, the poles of the magnets, the axis' path."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import LENGTH, MM, in_rpm, number, unit_for, with_unit
from leblanc.view.film import FRAMES, Film
from leblanc.view.machine import cylinder
from leblanc.view.parts import Inset, Label, Picture, Piece, bar_length, circle, line
from leblanc.wings.magnetic.answer import NAMES
from leblanc.wings.magnetic.geometry import MagneticView
from meshes.arrays import Array, Complex, Indices

POLE, HALF, DEEP = math.radians(30.0), 0.2, 0.45  # half angle, half length and depth over the rotor's radius
_ARC = 13  # points of a pole along its arc


def magnetic_picture(view: MagneticView, index: int = 0, last: int | None = None) -> Picture:
    """Picture of a rotor in magnetic bearings at an instant, with the path up to the instant `last`."""
    moved = view.path_factor * view.displacement[:, 0::2] + 1j * view.path_factor * view.displacement[:, 1::2]
    ends = 0.5 * view.length * np.array([-1.0, 1.0])
    top, tail = (_placed(view, _axis(view, moved[index], end), end)[0] for end in (ends[1], ends[0]))
    pieces = cylinder("rotor", "drum back", tail, top, view.radius * MM)
    reach = 0.35 * view.length
    line_ends = ends + np.array([-reach, reach])
    axis = np.concatenate([_placed(view, _axis(view, moved[index], end), end) for end in line_ends])
    rest = np.concatenate([_placed(view, 0j, end) for end in line_ends])
    pieces += [
        Piece("axis at rest", rest, line(2), "axis at rest"),
        Piece("axis of the rotor", axis, line(2), "arm"),
    ]
    for k, plane in enumerate(view.planes):
        pieces += _bearing(view, k, plane)
        path = _placed(view, moved[: None if last is None else last + 1, k], plane)
        if len(path) > 1:
            pieces.append(Piece(f"path {k + 1}", path, line(len(path)), "axis of the drum"))
    bar, name = _bar(view)
    outer = view.radius * (1.0 + DEEP) + view.gap_factor * view.gap
    pole = _placed(view, complex(0.0, outer - 0.2 * view.radius), view.planes[1])[0]
    edge = _placed(view, complex(0.0, view.gap_factor * view.gap), view.planes[0])[0]
    here = _placed(view, complex(moved[0, 1]), view.planes[1])[0]
    rim = _placed(view, _axis(view, moved[index], ends[0]) + view.radius, float(ends[0]))[0]
    labels = [
        Label("magnets", _point(pole)),
        Label("gap", _point(edge)),
        Label("path of the axis", _point(here)),
        Label("rotor", _point(rim)),
        name,
    ]
    return Picture(
        (*pieces, bar),
        tuple(labels),
        f"{one_line(view.name)}: {in_rpm(float(view.speed[index]))} ({view.speed[index]:.4g} rad/s)",
        "\n".join(_state(view, index)),
        " ".join(_caption(view)),
        lying=view.lying,
        long=True,
        frame=np.concatenate([piece.points for piece in (*pieces, bar) if not piece.name.startswith("axis")]),
    )


def magnetic_film(view: MagneticView, frames: int = FRAMES) -> Film:
    """The trial in time, or a turn of the orbit, in so many frames."""
    chosen = np.linspace(0, view.time.size - 1, frames).round().astype(int).tolist()
    distance = np.hypot(view.displacement[:, 0::2], view.displacement[:, 1::2]).max(axis=1)
    curve = (f"deflection, up to {with_unit(float(distance.max()), LENGTH)}", distance)

    def picture(k: int) -> Picture:
        shown = magnetic_picture(view, chosen[k], chosen[k] if view.trial else None)
        return replace(shown, inset=Inset(view.time, (curve,), float(view.time[chosen[k]]), "time"))

    return Film(frames, picture)


def _axis(view: MagneticView, moved: Complex, place: float) -> complex:
    """Deflection of the rotor's straight axis at a place, as drawn, m."""
    first, second = view.planes
    return complex(moved[0] + (moved[1] - moved[0]) * (place - first) / (second - first))


def _placed(view: MagneticView, plane: Complex | complex, height: float) -> Array:
    """Points of the picture, mm: x upright where the axis stands, y upright where it lies."""
    across = np.atleast_1d(np.asarray(plane, dtype=complex))
    axial = np.full(across.shape, height)
    order = (axial, across.real, across.imag) if view.lying else (across.real, across.imag, axial)
    return np.stack(order, axis=-1) * MM


def _bearing(view: MagneticView, k: int, plane: float) -> list[Piece]:
    """Four poles, and the circle that the axis may not leave."""
    inner = view.radius + view.gap_factor * view.gap
    ends = plane - HALF * view.radius, plane + HALF * view.radius
    pieces = [
        piece
        for quarter in range(4)
        for piece in _pole(
            view, f"pole {k + 1}", 0.5 * math.pi * quarter, inner, inner + DEEP * view.radius, ends
        )
    ]
    limit = circle(0j, view.gap_factor * view.gap)
    return [*pieces, Piece(f"gap {k + 1}", _placed(view, limit, plane), line(limit.size), "rim")]


def _pole(
    view: MagneticView, name: str, angle: float, inner: float, outer: float, ends: tuple[float, float]
) -> list[Piece]:
    """A pole as a piece of a ring, faces apart so that its edges stay sharp."""
    turn = np.exp(1j * (angle + np.linspace(-POLE, POLE, _ARC)))
    rings = [_placed(view, size * turn, end) for end in ends for size in (inner, outer)]
    low_in, low_out, high_in, high_out = rings
    pairs = [(low_in, high_in), (high_out, low_out), (low_out, low_in), (high_in, high_out)]
    walls = [Piece(name, np.concatenate(pair), _strip(_ARC), "bearing") for pair in pairs]
    face = np.arange(4, dtype=np.int64)[None]
    sides = [
        Piece(name, np.stack([ring[k] for ring in (low_in, low_out, high_out, high_in)]), face, "bearing")
        for k in (0, -1)
    ]
    return [*walls, *sides]


def _strip(count: int) -> Indices:
    """Faces between two lines of so many points."""
    first = np.arange(count - 1)
    return np.stack([first, first + 1, first + 1 + count, first + count], axis=-1).astype(np.int64)


def _bar(view: MagneticView) -> tuple[Piece, Label]:
    """Scale bar of the rotor, below it."""
    length = bar_length(view.radius)
    low = -0.5 * view.length - 0.5 * view.length
    if view.lying:
        outer = view.radius * (1.0 + DEEP) + view.gap_factor * view.gap
        points = np.array([[0.0, 0.0, -1.2 * outer], [length, 0.0, -1.2 * outer]]) * MM
    else:
        points = np.array([[-0.5 * length, 0.0, low], [0.5 * length, 0.0, low]]) * MM
    return Piece("scale bar", points, line(2), "bar"), Label(
        f"{length * MM:g} mm", _point(points.mean(axis=0))
    )


def _point(row: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in row)
    return x, y, z


def _state(view: MagneticView, index: int) -> list[str]:
    """Where the axis is in its bearings."""
    d = view.displacement[index]
    sizes = float(np.hypot(d[0], d[1])), float(np.hypot(d[2], d[3]))
    unit = unit_for(LENGTH, *sizes)
    when = f"t = {view.time[index]:.3g} s, " if view.trial else ""
    where = f"axis {unit.number(sizes[0])} and {unit.text(sizes[1])} off the centre"
    return [f"{when}{NAMES[view.controller]}: {where}", f"gap {with_unit(view.gap, LENGTH)}"]


def _caption(view: MagneticView) -> list[str]:
    """How it is drawn, sentence by sentence."""
    larger = f"{number(view.path_factor)} times larger"
    parts = [f"Gap drawn {number(view.gap_factor)} times wider, deflections {larger}, the rotor to scale."]
    what = "its trial in time" if view.trial else "a turn by the unbalances alone"
    parts.append(f"The line is the path of the axis in each bearing over {what}.")
    if view.path_factor == view.gap_factor:
        parts.append("On the circle the rotor would touch a magnet.")
    else:
        parts.append("Gap and path have different factors: the circle is no measure of this path.")
    drawn = "Poles are sketched." if not view.sketched else "Poles and size of the rotor are sketched."
    parts.append(drawn)
    if view.assumed:
        parts.append("Some values of the scene are assumed.")
    return parts
