"""Self-excited whirl of a scene over spin speed and liquid volume, or another number of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.waves import capture_speed
from fluid.whirl import covering_speed, is_full
from leblanc.core.notes import Note, NoteCode
from leblanc.core.progress import update
from leblanc.core.units import VOLUME, rpm_bands, with_unit
from leblanc.liquid.choose import Prepared, prepare
from leblanc.liquid.models import asked_with
from leblanc.liquid.notes import slowed_by
from leblanc.liquid.validity import doubts
from leblanc.scene.scene import Scene, require_no_balls, require_whirl
from leblanc.studies.cycles.answer import Cycles
from leblanc.studies.cycles.study import cycles_by, scene_cycles
from leblanc.studies.map.answer import WhirlMap
from leblanc.studies.map.axes import few_points, speeds_of
from leblanc.studies.map.varied import Axis, Varied, axis_of, varied_of
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.checked_model import CheckedModel
from solvers.liquid_model import THIN_LAYERS
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor
from solvers.rotor.vibration import critical_speeds
from solvers.synchronous.response import main_critical_speeds
from solvers.whirl.edges import Bands, bands_not_known, unstable_bands
from solvers.whirl.growth import Waves, growth_map

MOST = 4000  # volumes, values or speeds of a map
VALUES, VOLUMES = 31, 101  # unless others are asked for
_AT_ONCE = 20  # volumes between reports of progress
_THIN = THIN_LAYERS[1]


class MapCode(NoteCode):
    """What the notes of a map say."""

    OWN_VOLUME = "own_volume"
    QUADRATIC = "quadratic"
    WITHOUT_FRICTION = "without_friction"
    COMMON_FACTOR = "common_factor"
    NOT_HELD = "not_held"
    THICK_WALL_LAYER = "thick_wall_layer"
    NOT_KNOWN = "not_known"


def answer(scene: Scene, model: object, speeds: int | Sequence[float], **given: Any) -> WhirlMap:
    """The map of a scene, its liquid as a model of one's own has it where one is given."""
    # Before, as no scene that is read anew may name a model that only this question knows.
    scene, speed = speeds_of(scene, speeds, MOST)
    with asked_with(scene, model) as own:
        return map_scene(own, speed, **given)


def map_scene(
    scene: Scene,
    speed: Array,
    volumes: int | Sequence[float],
    max_volume: float | None = None,
    friction: Friction | None = None,
    cycles: bool = False,
    over: str | Sequence[str] = (),
    start: str | float | None = None,
    stop: str | float | None = None,
    values: int | Sequence[str | float] = VALUES,
    log: bool | None = None,
) -> WhirlMap:
    """Growth rate and whirl speed of self-excited whirl over speeds, rad/s, and over volume.

    With several chambers their volumes grow by a common factor; up to what fits where no largest volume is
    given. `over`: paths of another number in place of the volume, with its values. `cycles`: find how large
    the whirls of the scene as it stands grow.
    """
    require_whirl(scene)
    require_no_balls(scene, "a map over liquid; `lb.map_balls` charts balls")
    if not scene.fills:
        raise InputError("chambers", "none", "at least one for a map over volume")
    machine = prepare(scene, free=True)
    law = machine.waves
    if isinstance(law, CheckedModel) and (friction is not None or cycles):
        field, given = ("friction", friction) if friction is not None else ("cycles", cycles)
        raise InputError(field, given, "left out with a liquid model of one's own")
    law = law if friction is None else friction
    rows, axis, varied = _rows(machine, volumes, max_volume, friction, (over, start, stop, values, log))
    growth, whirl_speed, edges = _grown(rows, speed)
    (own,) = unstable_bands(machine.rotor, [scene.fills], speed, law)
    here = growth_map(machine.rotor, [scene.fills], speed, law)[0][0]
    carried = np.array([_held(row.scene, row.fills, speed) for row in rows])
    large, said = scene_cycles(machine, law) if cycles and isinstance(law, Friction) else (None, ())
    pairs = zip(rows, whirl_speed - speed, strict=True)
    thin = np.array([_thin_layers(row.fills, row.law, slip) for row, slip in pairs])
    rotor = machine.rotor
    return WhirlMap(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        speed=speed,
        volume=np.array([sum(fill.volume for fill in row.fills) for row in rows]),
        growth=growth,
        whirl_speed=whirl_speed,
        in_range=carried & thin,
        edges=edges,
        friction=replace(machine, waves=law).drag,
        damping=_damping(rotor, rows[-1].rotor),
        scene_volume=sum(fill.volume for fill in scene.fills),
        scene_edges=own,
        notes=(
            _own_volume(scene, own, speed, here),
            *_notes(machine, law, (carried, thin, growth), axis is None),
            *said,
            *doubts(scene),
        ),
        edges_not_known=tuple(bands_not_known(speed, found) for found in growth),
        capacity=sum(fill.chamber.capacity for fill in rows[-1].fills if fill.volume > 0.0)
        if axis is None
        else math.nan,
        critical_speed_dry=_critical_speed(machine) if _alike(machine, rows) else math.nan,
        large=None if large is None else Cycles(large.branches, cycles_by(machine)),
        depth=max((fill.depth for fill in scene.fills), default=0.0),
        paths=() if varied is None else varied.paths,
        value=None if axis is None else axis.value,
        scene_value=math.nan if varied is None else varied.own,
        dimension=None if varied is None else varied.rule.dimension,
        log=axis is not None and axis.log,
    )


@dataclass(frozen=True)
class _Row:
    """A machine of the second axis."""

    scene: Scene
    rotor: Rotor
    fills: tuple[Fill, ...]
    law: Waves


def _rows(
    machine: Prepared,
    volumes: int | Sequence[float],
    max_volume: float | None,
    friction: Friction | None,
    asked: tuple[Any, ...],
) -> tuple[list[_Row], Axis | None, Varied | None]:
    """The machines of the second axis; the axis and what varies along it where that is not the volume."""
    scene, (over, *given) = machine.scene, asked
    law = machine.waves if friction is None else friction
    if not over:
        for field, value, usual in zip(("start", "stop", "values", "log"), given, _NOT_ASKED, strict=True):
            if value != usual:
                raise InputError(field, value, "left out without `over`, the path of a number")
        few_points("volumes", volumes, MOST)
        rows = fills_over_volume(scene.fills, volumes, max_volume)
        return [_Row(scene, machine.rotor, fills, law) for fills in rows], None, None
    for field, value, usual in (("volumes", volumes, VOLUMES), ("max_volume", max_volume, None)):
        if value != usual:
            raise InputError(field, value, "left out where `over` names what varies")
    varied = varied_of(scene, over)
    start, stop, values, log = given
    axis = axis_of(varied, values, start, stop, log, MOST)
    found = []
    for value in axis.value.tolist():
        other = prepare(varied.at(scene, value), free=True)
        found.append(
            _Row(other.scene, other.rotor, other.scene.fills, other.waves if friction is None else friction)
        )
    return found, axis, varied


_NOT_ASKED = (None, None, VALUES, None)


def _grown(rows: Sequence[_Row], speed: Array) -> tuple[Array, Array, tuple[Bands, ...]]:
    """Growth and whirl speed, shape (v, n), and bands of each row; of one rotor and law many at once."""
    edges: list[Bands] = []
    parts, done, first = [], 0, rows[0]
    # In the plane all are solved together; a rotor that tilts takes them one by one, each for a while.
    alike = isinstance(first.rotor, Jeffcott) and all(
        row.rotor is first.rotor and row.law is first.law for row in rows
    )
    together = _AT_ONCE if alike else 1
    while done < len(rows):
        some = rows[done : done + together]
        parts.append(growth_map(some[0].rotor, [row.fills for row in some], speed, some[0].law))
        if not alike:
            edges += unstable_bands(some[0].rotor, [some[0].fills], speed, some[0].law, parts[-1][0])
        done += len(some)
        what = "volumes" if done < len(rows) else "edges of the bands"
        update(done, len(rows), f"{what}{slowed_by(first.fills)}")
    growth, whirl_speed = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    if alike:
        edges += unstable_bands(first.rotor, [row.fills for row in rows], speed, first.law, growth)
    return growth, whirl_speed, tuple(edges)


def _damping(rotor: Rotor, last: Rotor) -> str:
    """Damping of the support in words, of the scene and of the last row."""
    if not isinstance(rotor, Jeffcott):
        return "damping as in the scene"
    if isinstance(last, Jeffcott) and last.damping_ratio != rotor.damping_ratio:
        return "damping as it varies"
    return f"damping ratio {rotor.damping_ratio:.3g}"


def _alike(machine: Prepared, rows: Sequence[_Row]) -> bool:
    """Whether the rows have one critical speed without liquid."""
    own, last = machine.rotor.system(), rows[-1].rotor.system()
    return np.array_equal(own.mass, last.mass) and np.array_equal(own.stiffness, last.stiffness)


def _critical_speed(machine: Prepared) -> float:
    """Critical speed without liquid, as of `run`, rad/s; nan where there is none."""
    if isinstance(machine.rotor, Jeffcott):
        return machine.rotor.natural_frequency
    system, dry = machine.system, critical_speeds(machine.system)
    none = np.zeros(0), np.zeros((0, len(system.coordinates)), dtype=complex)
    return main_critical_speeds(system, machine.scene.fills, dry, none)[0]


def fills_over_volume(
    fills: tuple[Fill, ...], volumes: int | Sequence[float], max_volume: float | None = None
) -> list[tuple[Fill, ...]]:
    """The chambers with rising volumes, so many from none to the most or those given; their ratios stay.

    Chambers without any liquid all the same share it by what they hold.
    """
    capacity = np.array([fill.chamber.capacity for fill in fills])
    parts = np.array([fill.volume for fill in fills])
    parts = parts if parts.any() else capacity
    wet = parts > 0.0
    room = float(parts.sum() * np.min(capacity[wet] / parts[wet]))
    most = room if max_volume is None else max_volume
    if not 0.0 < most <= room * (1.0 + 1e-9):
        raise InputError("max_volume", max_volume, f"above 0 and at most {room:.6g} m^3, what fits")
    share = parts / parts.sum()
    if isinstance(volumes, int):
        totals = np.linspace(0.0, min(most, room), volumes)
    else:
        totals = np.array(volumes)
        for k, given in enumerate(volumes):
            if not 0.0 <= given <= room * (1.0 + 1e-9):
                raise InputError(f"volumes.{k}", given, f"0 or above and at most {room:.6g} m^3, what fits")
        if max_volume is not None:
            raise InputError("max_volume", max_volume, "left out where each of the volumes is given")
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


def _thin_layers(fills: tuple[Fill, ...], law: Waves, slip: Array) -> Flags:
    """The laminar layers on the walls are thin beside the liquid, as their law assumes."""
    if not isinstance(law, Friction) or not law.law.laminar:
        return np.ones(slip.shape, dtype=bool)
    thin = np.ones(slip.shape, dtype=bool)
    for fill in fills:
        if fill.volume > 0.0 and not is_full(fill):
            # sqrt(2 nu/|s|) <= share of the depth.
            thin &= 2.0 * fill.liquid.viscosity <= np.abs(slip) * (_THIN * fill.depth) ** 2
    return thin


def _own_volume(scene: Scene, bands: Bands, speed: Array, growth: Array) -> Note:
    """Where whirl grows with the scene's own volume, and where that is not known; growth of shape (n,)."""
    volume, lost = sum(fill.volume for fill in scene.liquids), bands_not_known(speed, growth)
    text = f"no whirl is self-excited at {'the other' if lost else 'these'} speeds."
    if bands:
        text = f"whirl is self-excited from {rpm_bands(bands)}."
    if np.isnan(growth).all():
        text = "it is not known at any of these speeds whether whirl is self-excited."
    elif lost:
        text += f" Not known within {rpm_bands(lost)}: do not take it for stable."
    data = {"volume": volume, "bands": tuple(bands), "not_known": lost}
    return Note(MapCode.OWN_VOLUME, data, f"With the scene's {with_unit(volume, VOLUME)} {text}")


def _notes(
    machine: Prepared, law: Waves, points: tuple[Flags, Flags, Array], volumes: bool
) -> tuple[Note, ...]:
    """Limits of validity and findings."""
    scene, found, (carried, thin, growth) = machine.scene, [], points

    def note(code: MapCode, text: str, **data: object) -> None:
        found.append(Note(code, data, text))

    if lost := int(np.count_nonzero(np.isnan(growth))):
        where = f"At {lost} of {thin.size} points the growth is not known"
        note(
            MapCode.NOT_KNOWN,
            f"{where}: crosses; do not take them for stable.",
            lost=lost,
            points=thin.size,
        )
    friction = law.law if isinstance(law, Friction) else ""
    if friction == "quadratic":
        note(
            MapCode.QUADRATIC,
            "Quadratic friction vanishes for small motions: the map is that without it. It bounds what "
            "grows.",
        )
    if friction in ("none", "quadratic") and np.any(machine.system.damping):
        note(
            MapCode.WITHOUT_FRICTION,
            "Without liquid friction the support's damping feeds the wave against the spin, whose energy is "
            "negative: a weak growth remains at almost every speed.",
        )
    if volumes and len(scene.fills) > 1:
        note(
            MapCode.COMMON_FACTOR,
            "The volumes of the chambers grow by a common factor until the first is full.",
        )
    if not carried.all():
        share, why = float(np.mean(~carried)), "gravity across the axis outweighs the spin"
        if scene.rotor.axis == "vertical":
            why = "a paraboloid leaves part of a wall dry or reaches an inner wall"
        note(MapCode.NOT_HELD, f"At {100.0 * share:.2g} % of the points {why}: out of range.", share=share)
    if not thin.all():
        share = float(np.mean(~thin))
        layer = f"the laminar layer at the wall is thicker than {_THIN:g} of the liquid's depth"
        note(
            MapCode.THICK_WALL_LAYER,
            f"At {100.0 * share:.2g} % of the points {layer}: out of range.",
            share=share,
            limit=_THIN,
        )
    return tuple(found)
