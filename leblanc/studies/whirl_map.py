"""Self-excited whirl of a scene over spin speed and liquid volume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill
from fluid.friction import Friction
from fluid.waves import capture_speed
from fluid.whirl import covering_speed, is_full
from leblanc.friction import friction_words
from leblanc.scene.machine import dry_rotor, jeffcott
from leblanc.scene.scene import Rotor, Scene
from leblanc.studies.validity import RANGES
from leblanc.units import ML, RPM
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.whirl.edges import Bands, unstable_bands
from solvers.whirl.growth import growth_map

VOLUMES, SPEEDS = 101, 201
FEWEST, MOST = 2, 4000  # volumes or speeds of a map
_AT_ONCE = 20  # volumes between reports of progress
_THIN = RANGES["linear"]["wall_layer"][1]


@dataclass(frozen=True)
class StabilityRecord:
    """Growth of self-excited whirl; n speeds, v volumes.

    Parameters
    ----------
    name, source, assumed, digest : of the scene
    speed : spin speed Omega, rad/s, shape (n,)
    volume : liquid in all chambers together, m^3, shape (v,)
    growth : of the whirl that grows most, 1/s, 0 if rounding cannot tell, nan if not found, shape (v, n)
    whirl_speed : of that whirl in the standing frame, rad/s, positive with the spin, shape (v, n)
    in_range : the plane layer is a fair picture of the liquid there, shape (v, n)
    edges : for each volume the bands of speed in which a whirl grows, rad/s; an end that is the first or last
        speed is where the range ends
    friction, damping : of the liquid, of the support, in words
    scene_volume, scene_edges : of the scene as it stands, m^3 and as in `edges`
    notes : limits of validity and findings, in words
    """

    name: str
    source: str
    assumed: tuple[str, ...]
    digest: str
    speed: Array
    volume: Array
    growth: Array
    whirl_speed: Array
    in_range: Flags
    edges: tuple[Bands, ...]
    friction: str
    damping: str
    scene_volume: float
    scene_edges: Bands
    notes: tuple[str, ...]


def map_scene(
    scene: Scene,
    volumes: int = VOLUMES,
    speeds: int = SPEEDS,
    max_volume: float | None = None,
    friction: Friction | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> StabilityRecord:
    """Growth rate and whirl speed of self-excited whirl over the scene's speeds and over volume.

    Parameters
    ----------
    scene : the machine; with several chambers their volumes grow by a common factor
    volumes, speeds : how many of each, at least 2
    max_volume : in all chambers together, m^3; as much as fits if None
    friction : in place of the scene's
    progress : called now and then with the number of volumes done and of all

    Raises
    ------
    InputError : a number out of its range, a range of speeds of no width
    """
    _check(scene, volumes, speeds)
    law = scene.model.friction if friction is None else friction
    speed = np.linspace(scene.speeds.start, scene.speeds.stop, speeds)
    system = dry_rotor(scene).system()
    rows = fills_over_volume(scene.chambers, volumes, max_volume)
    parts = []
    for first in range(0, volumes, _AT_ONCE):
        parts.append(growth_map(system, rows[first : first + _AT_ONCE], speed, law))
        if progress is not None:
            progress(min(first + _AT_ONCE, volumes), volumes)
    growth, whirl_speed = (np.concatenate([one[k] for one in parts]) for k in (0, 1))
    edges = unstable_bands(system, rows, speed, law, growth)
    (own,) = unstable_bands(system, [scene.chambers], speed, law)
    held = np.array([_held(scene, fills, speed) for fills in rows])
    pairs = zip(rows, whirl_speed - speed, strict=True)
    thin = np.array([_thin_layers(fills, slip) for fills, slip in pairs]) | (law.law != "stokes")
    return StabilityRecord(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        speed=speed,
        volume=np.array([sum(fill.volume for fill in fills) for fills in rows]),
        growth=growth,
        whirl_speed=whirl_speed,
        in_range=held & thin,
        edges=edges,
        friction=small_whirl_friction(law),
        damping=_damping_words(scene),
        scene_volume=sum(fill.volume for fill in scene.chambers),
        scene_edges=own,
        notes=_notes(scene, law, own, held, thin, bool(np.any(system.damping))),
    )


def _check(scene: Scene, volumes: int, speeds: int) -> None:
    for field, count in (("--volumes", volumes), ("--speeds", speeds)):
        if not FEWEST <= count <= MOST:
            raise InputError(field, count, f"a whole number from {FEWEST} to {MOST}")
    if scene.speeds.stop <= scene.speeds.start:
        raise InputError("speeds.stop", scene.speeds.stop, "above speeds.start for a map")
    if not scene.chambers:
        raise InputError("chambers", "none", "at least one for a map over volume")


def small_whirl_friction(friction: Friction) -> str:
    """Law of friction as a small whirl meets it, in words."""
    if friction.law == "quadratic":
        return "none (the quadratic law does not act on small whirls)"
    return friction_words(friction)


def fills_over_volume(
    fills: tuple[Fill, ...], count: int, max_volume: float | None = None
) -> list[tuple[Fill, ...]]:
    """The chambers with rising volumes, from none to the most; their ratios stay.

    Chambers without any liquid all the same share it by what they hold.

    Parameters
    ----------
    fills : the chambers as the scene fills them
    count : of volumes
    max_volume : in all together, m^3; where the first chamber is full if None

    Raises
    ------
    InputError : a largest volume that is not positive or does not fit
    """
    capacity = np.array([fill.chamber.capacity for fill in fills])
    parts = np.array([fill.volume for fill in fills])
    parts = parts if parts.any() else capacity
    wet = parts > 0.0
    room = float(parts.sum() * np.min(capacity[wet] / parts[wet]))
    most = room if max_volume is None else max_volume
    if not 0.0 < most <= room * (1.0 + 1e-9):
        raise InputError("--max-volume", max_volume, f"above 0 and at most {room:.6g} m^3, what fits")
    share = parts / parts.sum()
    totals = np.linspace(0.0, min(most, room), count)
    return [
        tuple(
            replace(fill, volume=min(float(total * part), fill.chamber.capacity))
            for fill, part in zip(fills, share, strict=True)
        )
        for total in totals
    ]


def _held(scene: Scene, fills: tuple[Fill, ...], speed: Array) -> Flags:
    """Every layer lies all round its wall: centrifugal acceleration outweighs gravity."""
    free = [fill for fill in fills if fill.volume > 0.0 and not is_full(fill)]
    if scene.rotor.axis == "vertical":
        needed = [covering_speed(fill, scene.gravity) for fill in free]
    else:
        needed = [float(capture_speed(fill.surface_radius, scene.gravity)) for fill in free]
    return np.asarray(speed > max(needed, default=0.0))


def _thin_layers(fills: tuple[Fill, ...], slip: Array) -> Flags:
    """The laminar layers on the walls are thin beside the liquid, as their law assumes."""
    thin = np.ones(slip.shape, dtype=bool)
    for fill in fills:
        if fill.volume > 0.0 and not is_full(fill):
            # sqrt(2 nu/|s|) <= share of the depth.
            thin &= 2.0 * fill.liquid.viscosity <= np.abs(slip) * (_THIN * fill.depth) ** 2
    return thin


def _damping_words(scene: Scene) -> str:
    if isinstance(scene.rotor, Rotor):
        return f"damping ratio {jeffcott(scene).damping_ratio:.3g}"
    return "damping as in the scene"


def _notes(
    scene: Scene, law: Friction, own: Bands, held: Flags, thin: Flags, damped: bool
) -> tuple[str, ...]:
    """Limits of validity and findings, in words."""
    notes = [_own_note(scene, own)]
    if law.law == "quadratic":
        notes.append(
            "Quadratic friction damps in proportion to the motion, not at all in the limit of a small one: "
            "the map is that without liquid friction. It bounds the whirl that grows."
        )
    if law.law in ("none", "quadratic") and damped:
        notes.append(
            "Without liquid friction the damping of the support feeds the wave that runs against the spin, "
            "whose energy is negative: a weak growth remains at almost every speed."
        )
    if len(scene.chambers) > 1:
        notes.append("The volumes of the chambers grow by a common factor up to where the first is full.")
    if not held.all():
        why = (
            "gravity across the axis outweighs the centrifugal acceleration at a free surface"
            if scene.rotor.axis == "horizontal"
            else "the paraboloid leaves part of a wall dry or reaches an inner wall"
        )
        notes.append(f"At {100.0 * np.mean(~held):.2g} % of the points {why}: out of range.")
    if not thin.all():
        notes.append(
            f"At {100.0 * np.mean(~thin):.2g} % of the points the laminar layer at the wall is thicker than "
            f"{_THIN:g} of the liquid's depth: out of range."
        )
    return tuple(notes)


def _own_note(scene: Scene, own: Bands) -> str:
    volume = sum(fill.volume for fill in scene.chambers) * ML
    if not own:
        return f"With the scene's {volume:.4g} ml no whirl grows by itself at these speeds."
    words = ", ".join(f"{low * RPM:.5g} to {high * RPM:.5g} rpm" for low, high in own)
    return f"With the scene's {volume:.4g} ml a whirl grows by itself from {words}."
