"""What a scene is in numbers, and which liquid model answers it."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.numbers import LayerNumbers, layer_numbers
from leblanc.results.record import ModeRecord
from leblanc.scene.machine import dry_rotor
from leblanc.scene.rotors import Exciter as ExciterOfScene
from leblanc.scene.rows import baffle_words
from leblanc.scene.scene import Scene
from leblanc.studies.choose import axial_gravity, choose
from leblanc.studies.exciter import printed_critical
from leblanc.studies.run import main_critical_speeds, rest_modes
from leblanc.text.models import ModelSpan, model_spans
from meshes.errors import InputError
from solvers.rotor.exciter.stuck import characteristic_speeds
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vibration import critical_speeds, modes, orbit, unbalance_response
from solvers.statics.hydrostatics import optimal_volume
from solvers.synchronous.critical import critical_speed, wet_critical_speeds
from solvers.synchronous.models import model_named


def explain_exciter(scene: Scene) -> dict[str, Any]:
    """Numbers that decide how an exciter behaves, without any integration in time [YF17, eq. 2-7 and 13].

    Parameters
    ----------
    scene : with a rotor of kind "exciter"

    Returns
    -------
    Name, natural frequency and characteristic shaft speeds, rad/s, dimensionless numbers, and the source's
    critical speed, rad/s, by its regression; None where there is none

    Raises
    ------
    InputError : its rotor is of another kind
    """
    if not isinstance(scene.rotor, ExciterOfScene):
        raise InputError("rotor.kind", scene.rotor.kind, "exciter for this")
    machine = scene.rotor.machine()
    numbers, unit = machine.dimensionless(), machine.natural_frequency
    known = characteristic_speeds(numbers)
    return {
        "name": scene.name,
        "natural_frequency": unit,
        "speed_ratio": [scene.speeds.start / unit, scene.speeds.stop / unit],
        "dimensionless": asdict(numbers),
        "characteristic_speeds": {
            "second_pair": _number(known.second_pair * unit),
            "through_resonance": _number(known.through_resonance * unit),
            "merger": _number(known.merger * unit),
        },
        "critical_speed_printed": _number(printed_critical(numbers) * unit),
    }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


@dataclass(frozen=True)
class LayerExplanation:
    """One chamber in numbers, at the first and the last speed where they change.

    Parameters
    ----------
    numbers : dimensionless numbers, shape (2,) where they depend on speed
    depth : mean depth of the layer at fast spin, m
    added_mass_ratio : mass of a full chamber over the rotor's, m_f/M
    liquid_mass_ratio : mass of the liquid over the rotor's
    optimal_volume : that just covers the wall at the dry rotor's deflection at the last speed, m^3; nan where
        baffles cut the liquid or the section is no circle
    walls : baffles, or the file of the section, in words; empty for a plain ring
    """

    numbers: LayerNumbers
    depth: float
    added_mass_ratio: float
    liquid_mass_ratio: float
    optimal_volume: float
    walls: str = ""


@dataclass(frozen=True)
class Explanation:
    """A scene in numbers.

    Parameters
    ----------
    name : of the scene
    critical_speed_dry, critical_speed_wet : without liquid, and with it at small deflections, rad/s; of
        several the one at which the unbalance moves the axis most
    damping_ratio : of the support; of several modes the one next to the dry critical speed, at that speed
    speed_ratio : first and last speed over the dry critical speed
    captured_from : speed above which the liquid rides with the drum, rad/s; None if at every speed
    layers : one for each chamber; None for an empty one
    models : which model answers at each speed, how well, and why
    tolerance : relative error that the scene allows
    modes : of the dry rotor at rest; none for a planar rotor, whose only one is the critical speed
    runup : which liquid model the run-up will take, in words; empty without one
    """

    name: str
    critical_speed_dry: float
    critical_speed_wet: float
    damping_ratio: float
    speed_ratio: tuple[float, float]
    captured_from: float | None
    layers: tuple[LayerExplanation | None, ...]
    models: tuple[ModelSpan, ...]
    tolerance: float
    modes: tuple[ModeRecord, ...] = ()
    runup: str = ""


def explain_scene(scene: Scene) -> Explanation:
    """Dimensionless numbers of a scene and the model that each speed takes.

    Raises
    ------
    InputError : the scene asks for a liquid model that does not answer the response to an unbalance
    """
    gravity, choice = axial_gravity(scene), choose(scene)
    ends = np.array([scene.speeds.start, scene.speeds.stop])
    bare = _bare(scene, gravity, choice.model)
    layers: list[LayerExplanation | None] = []
    for fill, dry in zip(scene.fills, bare.deflection, strict=True):
        if fill.volume == 0.0:
            layers.append(None)
            continue
        layers.append(
            LayerExplanation(
                numbers=layer_numbers(fill, ends, scene.gravity, gravity),
                depth=fill.depth,
                added_mass_ratio=fill.added_mass / bare.mass,
                liquid_mass_ratio=fill.mass / bare.mass,
                optimal_volume=_covering(fill, dry, ends[1], gravity),
                walls=_walls(fill),
            )
        )
    return Explanation(
        name=scene.name,
        critical_speed_dry=bare.critical_speed,
        critical_speed_wet=bare.critical_speed_wet,
        damping_ratio=bare.damping_ratio,
        speed_ratio=(ends[0] / bare.critical_speed, ends[1] / bare.critical_speed),
        captured_from=choice.captured_from,
        layers=tuple(layers),
        models=model_spans(choice, scene.speed_array()),
        tolerance=choice.tolerance,
        modes=bare.modes,
        runup=_runup(scene),
    )


def _covering(fill: Fill, deflection: float, speed: float, gravity: float) -> float:
    """Volume that just covers the wall of a clear circular chamber, m^3."""
    if fill.compartments > 1 or fill.chamber.section is not None:
        return math.nan
    return float(optimal_volume(fill.chamber, deflection, speed, gravity))


def _walls(fill: Fill) -> str:
    """What is there besides a plain ring."""
    if fill.chamber.section is not None:
        return f"section of {fill.chamber.section.name}"
    if fill.chamber.baffles is None:
        return ""
    effect = "they cut the liquid into compartments"
    if fill.compartments < 2:
        effect = "at rest in the drum the liquid lies as without them"
    return f"baffles: {baffle_words(fill.chamber.baffles)}; {effect}"


def _runup(scene: Scene) -> str:
    if scene.runup is None:
        return ""
    from leblanc.studies.runup import runup_outlook

    return runup_outlook(scene)


@dataclass(frozen=True)
class _Bare:
    """The rotor without liquid in numbers; its deflection at each chamber is that of the last speed."""

    mass: float
    critical_speed: float
    critical_speed_wet: float
    damping_ratio: float
    deflection: tuple[float, ...]
    modes: tuple[ModeRecord, ...] = ()


def _bare(scene: Scene, gravity: float, model: str) -> _Bare:
    rotor, last = dry_rotor(scene), np.array([scene.speeds.stop])
    system, fills = rotor.system(), scene.fills
    answer = unbalance_response(system, last)
    moved = [float(np.abs(orbit(system, answer, fill.chamber.plane).forward[0])) for fill in fills]
    deflection = tuple(one if np.isfinite(one) else 0.0 for one in moved)
    if isinstance(rotor, Jeffcott):
        wet = critical_speed(rotor, fills, gravity, model_named(model))
        return _Bare(rotor.mass, rotor.natural_frequency, wet, rotor.damping_ratio, deflection)
    liquid = wet_critical_speeds(system, fills, gravity, model_named(model))[0]
    speeds = critical_speeds(system)[0], liquid
    position = fills[0].chamber.plane if fills else 0.0
    dry, wet = main_critical_speeds(system, fills, position, *speeds)
    turning = modes(system, dry if np.isfinite(dry) else 0.0)
    nearest = int(np.argmin(np.abs(turning.frequency[0] - dry))) if np.isfinite(dry) else 0
    ratio = float(turning.damping_ratio[0, nearest])
    return _Bare(rotor.mass, dry, wet, ratio, deflection, rest_modes(system))
