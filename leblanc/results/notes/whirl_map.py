"""Notes of the map of self-excited whirl and of its cycles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.units import (
    VOLUME,
    rpm_bands,
    with_unit,
)

if TYPE_CHECKING:
    from solvers.whirl.edges import Bands


class MapCode(NoteCode):
    """What the notes of a map say."""

    OWN_VOLUME = "own_volume"
    QUADRATIC = "quadratic"
    WITHOUT_FRICTION = "without_friction"
    COMMON_FACTOR = "common_factor"
    NOT_HELD = "not_held"
    THICK_WALL_LAYER = "thick_wall_layer"
    NOT_KNOWN = "not_known"
    NO_CYCLES = "no_cycles"
    CYCLES_MISSING = "cycles_missing"
    NO_CIRCLE = "no_circle"
    LAGGING = "lagging"
    DEEP_WHIRL = "deep_whirl"


def no_cycles(reason: str) -> Note:
    """Why no limit cycle is told."""
    return Note(MapCode.NO_CYCLES, {"reason": reason}, f"No limit cycles: {reason}.")


def cycles_missing(reason: str) -> Note:
    """Which limit cycles may be missing among those told."""
    return Note(MapCode.CYCLES_MISSING, {"reason": reason}, f"Limit cycles may be missing: {reason}.")


def no_circle() -> Note:
    """Gravity across the axis is left out of limit cycles."""
    text = (
        "Limit cycles are those without gravity across the axis, with which a whirl is no circle: ask for a "
        "held state of `run` where the spin hardly outweighs it."
    )
    return Note(MapCode.NO_CIRCLE, {}, text)


def lagging(largest: float, limit: float) -> Note:
    """Limit cycles whose liquid lags more than the layer's flow describes."""
    text = (
        f"Limit cycles in which the liquid lags by more than {percent(limit)} of the spin (up to "
        f"{percent(largest)}) are the model's own: its flow has no vorticity."
    )
    return Note(MapCode.LAGGING, {"largest": largest, "limit": limit}, text)


def deep_whirl(largest: float) -> Note:
    """Limit cycles about as large as the layer is deep."""
    text = f"The largest limit cycle is {largest:.2g} times the depth of the layer: walls fall nearly dry."
    return Note(MapCode.DEEP_WHIRL, {"largest": largest}, text)


def growth_not_known(lost: int, points: int) -> Note:
    """Points at which the modes were not found."""
    text = f"At {lost} of {points} points the growth is not known: crosses; do not take them for stable."
    return Note(MapCode.NOT_KNOWN, {"lost": lost, "points": points}, text)


def own_volume(volume: float, bands: Bands) -> Note:
    """Where a whirl grows with the volume of the scene, m^3."""
    with_it = f"With the scene's {with_unit(volume, VOLUME)}"
    text = f"{with_it} no whirl grows by itself at these speeds."
    if bands:
        listed = rpm_bands(bands)
        text = f"{with_it} a whirl grows by itself from {listed}."
    return Note(MapCode.OWN_VOLUME, {"volume": volume, "bands": tuple(bands)}, text)


def quadratic() -> Note:
    """Quadratic friction does nothing to a small whirl."""
    text = "Quadratic friction vanishes for small motions: the map is that without it. It bounds what grows."
    return Note(MapCode.QUADRATIC, {}, text)


def without_friction() -> Note:
    """The damping of the support alone makes a wave grow."""
    text = (
        "Without liquid friction the support's damping feeds the wave against the spin, whose energy is "
        "negative: a weak growth remains at almost every speed."
    )
    return Note(MapCode.WITHOUT_FRICTION, {}, text)


def common_factor() -> Note:
    """How the volumes of several chambers grow."""
    text = "The volumes of the chambers grow by a common factor until the first is full."
    return Note(MapCode.COMMON_FACTOR, {}, text)


def not_held(share: float, horizontal: bool) -> Note:
    """Points at which the liquid does not lie all round its wall."""
    why = "a paraboloid leaves part of a wall dry or reaches an inner wall"
    if horizontal:
        why = "gravity across the axis outweighs the spin"
    text = f"At {100.0 * share:.2g} % of the points {why}: out of range."
    return Note(MapCode.NOT_HELD, {"share": share}, text)


def thick_wall_layer(share: float, limit: float) -> Note:
    """Points at which the laminar layer is thicker than its law allows."""
    text = (
        f"At {100.0 * share:.2g} % of the points the laminar layer at the wall is thicker than {limit:g} of "
        "the liquid's depth: out of range."
    )
    return Note(MapCode.THICK_WALL_LAYER, {"share": share, "limit": limit}, text)
