"""Self-excited whirl of a scene over spin speed and liquid volume."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.waves import capture_speed
from fluid.whirl import covering_speed, is_full
from leblanc.core.notes import Note
from leblanc.results.motion.cycles import DEEP, FAST_LAG, LargeWhirl
from leblanc.results.notes import whirl_map as notes
from leblanc.results.whirl_map import WhirlMap
from leblanc.scene.scene import Scene, require_no_balls, require_whirl
from leblanc.studies.models.choose import Prepared, prepare
from leblanc.studies.models.validity import doubts
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.checked_model import CheckedModel
from solvers.liquid_model import THIN_LAYERS
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vibration import critical_speeds
from solvers.synchronous.response import main_critical_speeds
from solvers.whirl.edges import Bands, bands_not_known, unstable_bands
from solvers.whirl.growth import Waves, growth_map

if TYPE_CHECKING:
    from solvers.cycles.cycles import HeldWhirl, LimitCycles


VOLUMES, SPEEDS = 101, 201
FEWEST, MOST = 2, 4000  # volumes or speeds of a map
_AT_ONCE = 20  # volumes between reports of progress
_THIN = THIN_LAYERS[1]
_WAY = 1e-3  # relative width of the range of a single speed


def map_scene(
    scene: Scene,
    volumes: int = VOLUMES,
    speeds: int = SPEEDS,
    max_volume: float | None = None,
    friction: Friction | None = None,
    progress: Callable[[int, int], None] | None = None,
    cycles: bool = False,
    found: Callable[[int, float], None] | None = None,
) -> WhirlMap:
    """Growth rate and whirl speed of self-excited whirl over the scene's speeds and over volume.

    With several chambers their volumes grow by a common factor; up to what fits where no largest volume is
    given. `cycles`: find how large the whirls of the scene as it stands grow.
    """
    _check(scene, volumes, speeds)
    machine = prepare(scene, free=True)
    law = machine.waves
    if isinstance(law, CheckedModel) and (friction is not None or cycles):
        field, given = ("friction", friction) if friction is not None else ("cycles", cycles)
        raise InputError(field, given, "left out with a liquid model of one's own")
    law = law if friction is None else friction
    drag = replace(machine, waves=law).drag
    rotor, speed = machine.rotor, np.linspace(scene.speeds.start, scene.speeds.stop, speeds)
    rows = fills_over_volume(scene.fills, volumes, max_volume)
    parts = []
    # In the plane all are solved together; a rotor that tilts takes them one by one, each for a while.
    together = _AT_ONCE if isinstance(rotor, Jeffcott) else 1
    for first in range(0, volumes, together):
        parts.append(growth_map(rotor, rows[first : first + together], speed, law))
        if progress is not None:
            progress(min(first + together, volumes), volumes)
    growth, whirl_speed = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    edges = unstable_bands(rotor, rows, speed, law, growth)
    (own,) = unstable_bands(rotor, [scene.fills], speed, law)
    carried = np.array([_held(scene, fills, speed) for fills in rows])
    large = _limit_cycles(machine, law, found) if cycles and isinstance(law, Friction) else None
    pairs = zip(rows, whirl_speed - speed, strict=True)
    thin = np.ones(growth.shape, dtype=bool)
    if isinstance(law, Friction) and law.law.laminar:
        thin = np.array([_thin_layers(fills, slip) for fills, slip in pairs])
    return WhirlMap(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        speed=speed,
        volume=np.array([sum(fill.volume for fill in fills) for fills in rows]),
        growth=growth,
        whirl_speed=whirl_speed,
        in_range=carried & thin,
        edges=edges,
        friction=drag,
        damping=_damping(machine),
        scene_volume=sum(fill.volume for fill in scene.fills),
        scene_edges=own,
        notes=(
            *_notes(machine, law, own, carried, thin, int(np.count_nonzero(np.isnan(growth)))),
            *(() if large is None else _cycle_notes(machine, large)),
            *doubts(scene),
        ),
        edges_not_known=tuple(bands_not_known(speed, found) for found in growth),
        capacity=sum(fill.chamber.capacity for fill in rows[-1] if fill.volume > 0.0),
        critical_speed_dry=_critical_speed(machine),
        branches=None if large is None else large.branches,
        depth=max((fill.depth for fill in scene.fills), default=0.0),
    )


def _limit_cycles(
    machine: Prepared, friction: Friction, progress: Callable[[int, float], None] | None
) -> LimitCycles:
    """Limit cycles of the scene as it stands, over its speeds."""
    from solvers.cycles.cycles import limit_cycles

    speeds = machine.scene.speeds
    # A single speed still needs a way to it.
    range_ = speeds.start, max(speeds.stop, speeds.start * (1.0 + _WAY))
    return limit_cycles(machine.rotor, machine.scene.fills, range_, friction, progress=progress)


def large_whirl(machine: Prepared, growth: Array) -> tuple[LargeWhirl, tuple[Note, ...]]:
    """How large the self-excited whirl becomes at each speed of a machine, and what is to be said of it."""
    found = _limit_cycles(machine, machine.scene.model.friction, None)
    largest = [_largest_stable(found, speed) for speed in machine.speed.tolist()]
    size = np.array([0.0 if whirl is None else whirl.amplitude for whirl in largest])
    turning = np.array([np.nan if whirl is None else whirl.whirl_speed for whirl in largest])
    lost = (size == 0.0) & ~(growth <= 0.0)
    large = LargeWhirl(
        branches=found.branches,
        amplitude=np.where(lost, np.nan, size),
        whirl_speed=turning,
        kicked=(size > 0.0) & (growth <= 0.0),
        reason=found.reason,
    )
    return large, tuple(_cycle_notes(machine, found))


def _largest_stable(found: LimitCycles, speed: float) -> HeldWhirl | None:
    whirls = [whirl for branch in found.branches for whirl in branch.at(speed) if whirl.stable]
    return max(whirls, key=lambda whirl: whirl.amplitude, default=None)


def _cycle_notes(machine: Prepared, found: LimitCycles) -> list[Note]:
    """What the limit cycles leave out, and why there are none."""
    if not found.branches:
        return [notes.no_cycles(found.reason)]
    said = [notes.cycles_missing(found.reason)] if found.reason else []
    if machine.scene.rotor.axis == "horizontal" and machine.scene.gravity > 0.0:
        said.append(notes.no_circle())
    lagging = max(float(np.nanmax(branch.lag / branch.speed[:, None])) for branch in found.branches)
    if lagging > FAST_LAG:
        said.append(notes.lagging(lagging, FAST_LAG))
    largest = max(float(np.abs(branch.deflection).max()) for branch in found.branches)
    depth = max(fill.depth for fill in machine.scene.fills)
    if largest > DEEP * depth:
        said.append(notes.deep_whirl(largest / depth))
    return said


def _critical_speed(machine: Prepared) -> float:
    """Critical speed without liquid, as `run` tells it, rad/s; nan where there is none."""
    if isinstance(machine.rotor, Jeffcott):
        return machine.rotor.natural_frequency
    system, dry = machine.system, critical_speeds(machine.system)
    none = np.zeros(0), np.zeros((0, len(system.coordinates)), dtype=complex)
    return main_critical_speeds(system, machine.scene.fills, dry, none)[0]


def _check(scene: Scene, volumes: int, speeds: int) -> None:
    for field, count in (("--volumes", volumes), ("--speeds", speeds)):
        if not FEWEST <= count <= MOST:
            raise InputError(field, count, f"a whole number from {FEWEST} to {MOST}")
    if scene.speeds.stop <= scene.speeds.start:
        raise InputError("speeds.stop", scene.speeds.stop, "above speeds.start for a map")
    require_whirl(scene)
    require_no_balls(scene, "a map over liquid; `lb.map_balls` charts balls")
    if not scene.fills:
        raise InputError("chambers", "none", "at least one for a map over volume")


def fills_over_volume(
    fills: tuple[Fill, ...], count: int, max_volume: float | None = None
) -> list[tuple[Fill, ...]]:
    """The chambers with rising volumes, from none to the most; their ratios stay.

    Chambers without any liquid all the same share it by what they hold.
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


def _damping(machine: Prepared) -> str:
    """Damping of the support, in words."""
    if isinstance(machine.rotor, Jeffcott):
        return f"damping ratio {machine.rotor.damping_ratio:.3g}"
    return "damping as in the scene"


def _notes(
    machine: Prepared, law: Waves, own: Bands, carried: Flags, thin: Flags, lost: int
) -> tuple[Note, ...]:
    """Limits of validity and findings."""
    scene = machine.scene
    found = [notes.own_volume(sum(fill.volume for fill in scene.liquids), own)]
    if lost:
        found.append(notes.growth_not_known(lost, thin.size))
    friction = law.law if isinstance(law, Friction) else ""
    if friction == "quadratic":
        found.append(notes.quadratic())
    if friction in ("none", "quadratic") and np.any(machine.system.damping):
        found.append(notes.without_friction())
    if len(scene.fills) > 1:
        found.append(notes.common_factor())
    if not carried.all():
        found.append(notes.not_held(float(np.mean(~carried)), scene.rotor.axis == "horizontal"))
    if not thin.all():
        found.append(notes.thick_wall_layer(float(np.mean(~thin)), _THIN))
    return tuple(found)
