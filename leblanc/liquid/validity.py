"""Whether a question and its answer are to be believed.

Values of a scene that are allowed but hardly meant: what each looks like, and the slip that it may be. The
bounds lie well outside what is built, from the spindle of a hard disc to a gas turbine: a doubt is to be
looked at, and nothing is refused. And the numbers a layer's answer rests on, with the range of its model.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from leblanc.core.notes import Note, NoteCode
from leblanc.core.units import (
    DENSITY,
    LENGTH,
    MASS,
    UNBALANCE,
    VISCOSITY,
    in_rpm,
    number,
    rpm_range,
    with_unit,
)
from leblanc.liquid.notes import Number
from leblanc.scene.rotors import JeffcottRotor, Machine, Spring, TubRotor, TwoPlaneRotor
from leblanc.scene.scene import WITHOUT_CHAMBERS, Exciter, MagneticRotor, Scene
from meshes.errors import InputError
from solvers.liquid_model import Range
from solvers.rotor.system import RotorSystem, moving_mass
from solvers.rotor.vibration import axis_is_free, free_motions

SMALLEST, LARGEST = 2e-4, 10.0  # of a wall, m
THINNEST = 1e-6  # of a layer all round its wall, m
LIQUID = 1.0  # mass of the liquid over that of the rotor
OVERDAMPED = 1.0  # damping ratio of a support
ECCENTRICITY = {"tub": 0.25}  # of the largest wall: the centre of mass from the axis; of a drum with laundry
_ECCENTRICITY = 0.1  # of other rotors
FARTHEST = 10.0  # radii of gyration from the centre of mass; the ends of a rod lie at 1.7
LIGHTEST, HEAVIEST = 50.0, 25e3  # density of a liquid, kg/m^3
THICKEST = 0.5  # kinematic viscosity, m^2/s
GRAVITY = 100.0  # m/s^2
NEAR = 4.0  # speeds and critical speeds are within this factor of one another
_TURN = 2.0 * math.pi / 60.0  # rad/s in one rpm

_WAYS = {
    "x": "along x",
    "y": "along y",
    "z": "along z",
    "alpha": "about x",
    "beta": "about y",
    "gamma": "about z",
}


class DoubtCode(NoteCode):
    """What a value of a scene is that is allowed but hardly meant."""

    SIZE = "doubtful_size"
    FILM = "doubtful_film"
    LIQUID = "doubtful_liquid"
    LIQUID_MASS = "doubtful_liquid_mass"
    DAMPING = "doubtful_damping"
    UNBALANCE = "doubtful_unbalance"
    PLACE = "doubtful_place"
    FREE = "free_direction"
    GRAVITY = "doubtful_gravity"
    SPEED = "doubtful_speed"


def doubt(code: DoubtCode, field: str, looks: str, likely: str) -> Note:
    """A value at a path of the scene that is hardly meant, why, and what may have been meant (or empty)."""
    meant = f"; did you mean {likely}?" if likely else ""
    return Note(
        code, {"field": field, "likely": likely}, f"Check {field}: {looks}{meant}{'' if meant else '.'}"
    )


def doubts(scene: Scene, given: Mapping[str, Any] | None = None) -> tuple[Note, ...]:
    """What is hardly meant in a scene, a note for each value, its field in the data of the note."""
    return (
        *_rotor(scene),
        *_chambers(scene),
        *_gravity(scene),
        *(() if given is None else _speeds(scene, given)),
    )


def _rotor(scene: Scene) -> Iterator[Note]:
    rotor = scene.rotor
    if isinstance(rotor, JeffcottRotor):
        ratio = rotor.machine().damping_ratio
        if ratio > OVERDAMPED:
            given = rotor.damping is None
            text = f"the support is overdamped, {number(ratio)} times the critical damping"
            field = f"rotor.damping{'_ratio' if given else ''}"
            yield doubt(DoubtCode.DAMPING, field, text, number(0.01 * ratio) if given else "")
        yield from _eccentricity(scene, "rotor.unbalance", rotor.unbalance, rotor.mass)
    elif isinstance(rotor, TwoPlaneRotor):
        for k, part in enumerate(rotor.unbalances):
            yield from _eccentricity(scene, f"rotor.unbalances.{k}.size", part.size, rotor.mass)
        gyration = math.sqrt(rotor.transverse_inertia / rotor.mass)
        places = [(f"rotor.supports.{k}.position", part.position) for k, part in enumerate(rotor.supports)]
        places += [(f"rotor.unbalances.{k}.position", p.position) for k, p in enumerate(rotor.unbalances)]
        yield from _far(scene, places, gyration)
        yield from _free(scene)
    elif isinstance(rotor, TubRotor):
        yield from _eccentricity(scene, "rotor.unbalance", rotor.unbalance, rotor.drum_mass)
        for k, load in enumerate(rotor.loads):
            yield from _eccentricity(scene, f"rotor.loads.{k}.size", load.size, rotor.drum_mass)
        gyration = math.sqrt(max(rotor.tub_inertia) / rotor.tub_mass)
        places = [
            (f"rotor.{name}.{k}.position", float(np.linalg.norm(part.position)))
            for name, parts in (("springs", rotor.springs), ("dampers", rotor.dampers))
            for k, part in enumerate(parts)
        ]
        if rotor.unbalance_position is not None:
            places.append(("rotor.unbalance_position", rotor.unbalance_position))
        places += [(f"rotor.loads.{k}.position", load.position) for k, load in enumerate(rotor.loads)]
        yield from _far(scene, places, gyration)
        yield from _free(scene)
    elif isinstance(rotor, MagneticRotor):
        yield from _eccentricity(scene, "rotor.eccentricity", rotor.unbalance, rotor.mass)
    elif isinstance(rotor, Exciter):
        yield from _eccentricity(scene, "rotor.unbalance", rotor.unbalance, rotor.platform_mass)


def _eccentricity(scene: Scene, field: str, unbalance: float, mass: float) -> Iterator[Note]:
    """An unbalance puts the centre of mass far from the axis."""
    size = unbalance / mass
    walls = [fill.chamber.radius for fill in scene.fills]
    if isinstance(scene.rotor, Exciter):
        walls = [scene.rotor.balls.track_radius]
    if isinstance(scene.rotor, MagneticRotor):
        walls = [scene.rotor.magnets.gap]
    most = ECCENTRICITY.get(scene.rotor.kind, _ECCENTRICITY) * max(walls, default=1.0)
    if size > most:
        text = f"{with_unit(unbalance, UNBALANCE)} put the centre of mass of {with_unit(mass, MASS)} "
        text += f"{with_unit(size, LENGTH)} off its axis"
        likely = with_unit(1e-3 * unbalance, UNBALANCE) if 1e-3 * size <= most else ""
        yield doubt(DoubtCode.UNBALANCE, field, text, likely)


def _far(scene: Scene, places: list[tuple[str, float]], gyration: float) -> Iterator[Note]:
    """Places far outside the body whose inertia is given."""
    planes = [(f"chambers.{k}.plane", fill.chamber.plane) for k, fill in enumerate(scene.fills)]
    most = FARTHEST * gyration
    for field, place in (*places, *planes):
        if abs(place) > most:
            text = f"{with_unit(abs(place), LENGTH)} from the centre of mass, of a body whose radius of "
            text += f"gyration is {with_unit(gyration, LENGTH)}"
            likely = with_unit(1e-3 * place, LENGTH) if 1e-3 * abs(place) <= most else ""
            yield doubt(DoubtCode.PLACE, field, text, likely)


def _free(scene: Scene) -> Iterator[Note]:
    """Directions in which nothing holds the machine."""
    assert isinstance(scene.rotor, TwoPlaneRotor | TubRotor)
    if ways := _free_ways(scene.rotor.machine().system()):
        field, cure = _cure(scene.rotor, scene.gravity)
        yield doubt(DoubtCode.FREE, field, f"it takes {cure}; nothing holds the machine {ways}", "")


def _free_ways(system: RotorSystem) -> str:
    """Directions in which nothing holds a machine, in words; empty where there is none."""
    free = free_motions(system)
    energy = (np.abs(free) ** 2 * np.diag(system.mass)[:, None]).sum(axis=1)
    if free.shape[1] == 1:
        # A single motion may be several at once, as a swing about the points that a tub hangs from.
        parts = np.flatnonzero(energy >= 0.1 * energy.sum())
        return " together with ".join(_WAYS[system.coordinates[k]] for k in parts.tolist())
    most = np.argsort(energy)[::-1][: free.shape[1]]
    return " and ".join(_WAYS[system.coordinates[k]] for k in sorted(most.tolist()))


# Field that holds a rotor, and what it takes.
_CURES = {
    "tub": ("rotor.springs", "springs with a stiffness along x, y and z, or more of them"),
    "two_plane": ("rotor.supports", "supports in two planes, stiff in both directions"),
}


_HANGER = 0.3  # m, of a spring in the example


def _cure(rotor: TwoPlaneRotor | TubRotor, gravity: float) -> tuple[str, str]:
    """Field that holds a rotor, and what it takes; what a tub that hangs is held by across its springs."""
    field, cure = _CURES[rotor.kind]
    if not isinstance(rotor, TubRotor) or rotor.axis == "vertical" or not rotor.springs:
        return field, cure
    # Of a tub whose drum lies z is upwards.
    hanging = sum(_carries(spring) for spring in rotor.springs)
    if not hanging:
        return field, cure
    force = (rotor.tub_mass + rotor.drum_mass) * gravity / hanging
    hangs = f"{with_unit(_HANGER, LENGTH)} hold with {number(force / _HANGER)} N/m each"
    return (
        field,
        f"{cure} (springs that a tub hangs from hold it across themselves too, with their force "
        f"over their length: {number(force)} N of its weight on {hangs})",
    )


def _carries(spring: Spring) -> bool:
    """Whether a spring of a tub bears weight."""
    if isinstance(spring.stiffness, tuple):
        return spring.stiffness[2] > 0.0
    return spring.direction is not None and spring.direction[2] != 0.0


def moves_freely(scene: Scene) -> bool:
    """Whether nothing holds the axis in some direction."""
    rotor = scene.rotor
    return isinstance(rotor, TwoPlaneRotor | TubRotor) and axis_is_free(rotor.machine().system())


def require_supported(scene: Scene) -> None:
    """Refuse a machine whose axis can move freely: it never comes to a steady motion of some size."""
    if not moves_freely(scene):
        return
    assert isinstance(scene.rotor, TwoPlaneRotor | TubRotor)
    field, cure = _cure(scene.rotor, scene.gravity)
    ways = _free_ways(scene.rotor.machine().system())
    allowed = f"{cure}: nothing holds the machine {ways}, and an axis that moves freely has no amplitude"
    raise InputError(field, f"free {ways}", allowed)


def _chambers(scene: Scene) -> Iterator[Note]:
    for k, (chamber, fill) in enumerate(zip(scene.liquids, scene.fills, strict=True)):
        at = f"chambers.{k}"
        sizes = (("radius", chamber.radius), ("height", chamber.height))
        odd = [note for name, size in sizes if size for note in _size(f"{at}.{name}", name, size)]
        yield from odd
        area = 2.0 * math.pi * fill.chamber.radius * fill.chamber.height
        if not odd and 0.0 < fill.volume < THINNEST * area:
            text = f"all round the wall it is a film of {with_unit(fill.volume / area, LENGTH)}"
            yield doubt(DoubtCode.FILM, f"{at}.volume", text, "")
        liquid = fill.liquid
        if not LIGHTEST <= liquid.density <= HEAVIEST:
            text = f"no liquid has a density of {number(liquid.density)} {DENSITY.unit}"
            likely = f"{number(1e3 * liquid.density)} {DENSITY.unit}" if liquid.density < LIGHTEST else ""
            yield doubt(DoubtCode.LIQUID, f"{at}.liquid.density", text, likely)
        if liquid.viscosity > THICKEST:
            text = f"a kinematic viscosity of {number(liquid.viscosity)} {VISCOSITY.unit} hardly flows"
            likely = f"{number(liquid.viscosity)} mm^2/s"
            yield doubt(DoubtCode.LIQUID, f"{at}.liquid.viscosity", text, likely)
    yield from _mass(scene)


def _size(field: str, name: str, size: float) -> Iterator[Note]:
    if SMALLEST <= size <= LARGEST:
        return
    factor = 1e-3 if size > LARGEST else 1e3
    likely = with_unit(factor * size, LENGTH) if SMALLEST <= factor * size <= LARGEST else ""
    yield doubt(DoubtCode.SIZE, field, f"a {name} of {with_unit(size, LENGTH)} is hardly built", likely)


def _mass(scene: Scene) -> Iterator[Note]:
    rotor, liquid = scene.rotor, sum(fill.mass for fill in scene.fills)
    if isinstance(rotor, WITHOUT_CHAMBERS) or not scene.fills:
        return
    if isinstance(rotor, Machine):
        if type(rotor).machine is Machine.machine:
            return  # it has none
        mass, field = moving_mass(rotor.machine()), "kind"
    else:
        mass, field = (rotor.drum_mass, "drum_mass") if isinstance(rotor, TubRotor) else (rotor.mass, "mass")
    if liquid > LIQUID * mass:
        text = f"the liquid, {with_unit(liquid, MASS)}, is heavier than the rotor, {with_unit(mass, MASS)}"
        yield doubt(DoubtCode.LIQUID_MASS, f"rotor.{field}", text, "")


def _gravity(scene: Scene) -> Iterator[Note]:
    if scene.gravity > GRAVITY:
        likely = f"{number(1e-3 * scene.gravity)} m/s^2" if scene.gravity <= 1e3 * GRAVITY else ""
        yield doubt(DoubtCode.GRAVITY, "gravity", f"{number(scene.gravity)} m/s^2", likely)


def _speeds(scene: Scene, given: Mapping[str, Any]) -> Iterator[Note]:
    """A speed without a unit, in rad/s, that would suit the others if it were in rpm."""
    rotor, speeds = scene.rotor, scene.speeds
    if not isinstance(rotor, JeffcottRotor):
        return
    critical = rotor.machine().natural_frequency
    if _suits(speeds.start, speeds.stop, critical):
        return
    plain = {
        path: isinstance(given.get(path[0], {}).get(path[1]), int | float)
        for path in (("rotor", "critical_speed"), ("speeds", "start"), ("speeds", "stop"))
    }
    where = f"{rpm_range(speeds.start, speeds.stop)} beside a critical speed of {in_rpm(critical)}"
    own, first, last = plain.values()
    if own and not last and _suits(speeds.start, speeds.stop, critical * _TURN):
        likely = in_rpm(critical * _TURN)
        yield doubt(DoubtCode.SPEED, "rotor.critical_speed", where, likely)
    elif last and not own and _suits(speeds.start * (_TURN if first else 1.0), speeds.stop * _TURN, critical):
        yield doubt(DoubtCode.SPEED, "speeds.stop", where, in_rpm(speeds.stop * _TURN))


def _suits(start: float, stop: float, critical: float) -> bool:
    """The range comes near the critical speed."""
    return stop * NEAR >= critical and start <= NEAR * critical


MEANING = {
    "relative_depth": "mean depth over radius",
    "deflection": "whirl amplitude over mean depth",
    "smooth_whirl": "whirl over the largest that a smooth steady wave follows",
    "detuning": "distance from the nearer natural sloshing wave over that between the two",
    "froude": "whirl speed seen from the drum over the nearer natural sloshing wave's",
    "centrifuge": "centrifugal acceleration at the surface over gravity across the axis",
    "reynolds": "spin speed times radius squared over viscosity",
    "wall_layer": "laminar layer at the wall over mean depth",
    "wave_amplitude": "largest change of depth over mean depth",
    "crest": "greatest depth over mean depth",
    "trough": "least depth over mean depth",
    "crest_number": "speed of the liquid at the crest over that of the crest",
    "force_gap": "force by pressure less that by momentum, over the force or the full drum's",
    "grid_gap": "force on these cells less that on half as many, over the force or the full drum's",
    "other_family": "response of the family left out over that of the one taken",
}


def judge(found: Mapping[str, float], ranges: Mapping[str, Range]) -> tuple[Number, ...]:
    """Numbers that a model's answer rests on, against the model's ranges, in the order of `MEANING`."""
    numbers = []
    for name, meaning in MEANING.items():
        if name not in found:
            continue
        value, bounds = found[name], ranges.get(name)
        least, most = bounds or (None, None)
        inside = bounds is None or bounds[0] <= value <= bounds[1]
        numbers.append(Number(name, meaning, value, least, most, inside))
    return tuple(numbers)
