"""What a scene is in numbers, and which liquid model answers it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fluid.numbers import LayerNumbers, layer_numbers
from solvers.hydrostatics import optimal_volume
from solvers.response import critical_speed
from study.fidelity import axial_gravity, choose
from study.run import jeffcott
from study.scene import Scene


@dataclass(frozen=True)
class LayerExplanation:
    """One chamber in numbers, at the first and the last speed where they change.

    Parameters
    ----------
    numbers : dimensionless numbers, shape (2,) where they depend on speed
    depth : mean depth of the layer at fast spin, m
    added_mass_ratio : mass of a full chamber over the rotor's, m_f/M
    liquid_mass_ratio : mass of the liquid over the rotor's
    optimal_volume : that just covers the wall at the dry rotor's deflection at the last speed, m^3
    """

    numbers: LayerNumbers
    depth: float
    added_mass_ratio: float
    liquid_mass_ratio: float
    optimal_volume: float


@dataclass(frozen=True)
class ModelSpan:
    """A range of speeds that one model answers.

    Parameters
    ----------
    first, last : rad/s
    model : its name
    in_range : it holds there
    reason : why it is taken, in words
    """

    first: float
    last: float
    model: str
    in_range: bool
    reason: str


@dataclass(frozen=True)
class Explanation:
    """A scene in numbers.

    Parameters
    ----------
    name : of the scene
    critical_speed_dry, critical_speed_wet : without liquid, and with it at small deflections, rad/s
    damping_ratio : of the support
    speed_ratio : first and last speed over the dry critical speed
    captured_from : speed above which the liquid rides with the drum, rad/s; None if at every speed
    layers : one for each chamber; None for an empty one
    models : which model answers at each speed, and why
    """

    name: str
    critical_speed_dry: float
    critical_speed_wet: float
    damping_ratio: float
    speed_ratio: tuple[float, float]
    captured_from: float | None
    layers: tuple[LayerExplanation | None, ...]
    models: tuple[ModelSpan, ...]


def explain_scene(scene: Scene) -> Explanation:
    """Dimensionless numbers of a scene and the model that each speed takes.

    Raises
    ------
    InputError : the scene asks for a liquid model that does not answer the response to an unbalance
    """
    rotor, gravity, choice = jeffcott(scene), axial_gravity(scene), choose(scene)
    ends = np.array([scene.speeds.start, scene.speeds.stop])
    stiffness = complex(rotor.dynamic_stiffness(ends)[1])
    force = rotor.unbalance * ends[1] ** 2
    dry = abs(force / stiffness) if stiffness else 0.0
    layers: list[LayerExplanation | None] = []
    for fill in scene.chambers:
        if fill.volume == 0.0:
            layers.append(None)
            continue
        layers.append(
            LayerExplanation(
                numbers=layer_numbers(fill, ends, scene.gravity, gravity),
                depth=fill.depth,
                added_mass_ratio=fill.full_mass / rotor.mass,
                liquid_mass_ratio=fill.mass / rotor.mass,
                optimal_volume=float(optimal_volume(fill.chamber, dry, ends[1], gravity)),
            )
        )
    frequency = rotor.natural_frequency
    return Explanation(
        name=scene.name,
        critical_speed_dry=frequency,
        critical_speed_wet=critical_speed(rotor, scene.chambers, gravity, choice.model),
        damping_ratio=rotor.damping_ratio,
        speed_ratio=(ends[0] / frequency, ends[1] / frequency),
        captured_from=choice.captured_from,
        layers=tuple(layers),
        models=_spans(scene, choice.in_range, choice.model, choice.reason),
    )


def _spans(scene: Scene, in_range: np.ndarray, model: str, reason: str) -> tuple[ModelSpan, ...]:
    """Consecutive speeds with the same answer."""
    speed = scene.speed_array()
    edges = np.flatnonzero(np.diff(in_range.astype(int))) + 1
    spans = []
    for part in np.split(np.arange(speed.size), edges):
        holds = bool(in_range[part[0]])
        why = reason if holds else f"{reason}; but gravity across the axis is stronger than the spin here"
        spans.append(ModelSpan(float(speed[part[0]]), float(speed[part[-1]]), model, holds, why))
    return tuple(spans)
