"""Notes of the map of self-excited whirl, one function a sentence."""

from __future__ import annotations

from typing import TYPE_CHECKING

from leblanc.results.note import Note, NoteCode
from leblanc.units import ML, RPM

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


def own_volume(volume: float, bands: Bands) -> Note:
    """Where a whirl grows with the volume of the scene.

    Parameters
    ----------
    volume : of liquid in all chambers, m^3
    bands : of speed, rad/s
    """
    with_it = f"With the scene's {volume * ML:.4g} ml"
    text = f"{with_it} no whirl grows by itself at these speeds."
    if bands:
        listed = ", ".join(f"{low * RPM:.5g} to {high * RPM:.5g} rpm" for low, high in bands)
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
    """Points at which the liquid does not lie all round its wall.

    Parameters
    ----------
    share : of the points
    horizontal : the axis lies
    """
    why = "a paraboloid leaves part of a wall dry or reaches an inner wall"
    if horizontal:
        why = "gravity across the axis outweighs the spin"
    text = f"At {100.0 * share:.2g} % of the points {why}: out of range."
    return Note(MapCode.NOT_HELD, {"share": share}, text)


def thick_wall_layer(share: float, limit: float) -> Note:
    """Points at which the laminar layer is thicker than its law allows.

    Parameters
    ----------
    share : of the points
    limit : thickness over the liquid's depth
    """
    text = (
        f"At {100.0 * share:.2g} % of the points the laminar layer at the wall is thicker than {limit:g} of "
        "the liquid's depth: out of range."
    )
    return Note(MapCode.THICK_WALL_LAYER, {"share": share, "limit": limit}, text)
