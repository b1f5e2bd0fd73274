"""Outputs of `run` of many scenes at once: planar machines all together, other rotors one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from leblanc.liquid.choose import choose_all, prepare
from leblanc.liquid.models import synchronous_model
from leblanc.scene.scene import JeffcottRotor, Scene
from leblanc.studies.balls.study import run_balls
from leblanc.studies.loads.study import loaded_machine
from leblanc.studies.peaks import responses_between
from leblanc.studies.run.answer import phase
from leblanc.studies.run.study import loads_of, run_scene
from leblanc.studies.sweep.outputs import Answers, kept_of, together, worst_of
from meshes.errors import InputError
from solvers.synchronous.peaks import highest
from solvers.synchronous.response import Response, joined, machine_responses
from solvers.whirl.growth import machines_growth


def answer_scenes(scenes: Sequence[Scene]) -> Answers:
    """Outputs of `run` of several scenes, equal to those of each one alone to rounding."""
    counts = {scene.speeds.count for scene in scenes}
    if len(counts) != 1:
        raise InputError("scenes", sorted(counts), "at least one, all with one number of speeds")
    if not all(scene.chambers for scene in scenes):
        return together([_bare(scene) for scene in scenes])
    if any(scene.balls for scene in scenes):
        return together([_with_balls(scene) for scene in scenes])
    planar = [k for k, scene in enumerate(scenes) if isinstance(scene.rotor, JeffcottRotor)]
    others = [k for k, scene in enumerate(scenes) if not isinstance(scene.rotor, JeffcottRotor)]
    parts = [_planar([scenes[k] for k in planar])] if planar else []
    parts += [_single(scenes[k]) for k in others]
    return together(parts, np.argsort(np.array([*planar, *others], dtype=np.intp)))


def _bare(scene: Scene) -> Answers:
    """Answers of one scene; without chambers none of a liquid."""
    if scene.chambers:
        return answer_scenes([scene])
    found = _single(scene)
    unknown = np.full(found.speed.shape, np.nan)
    none = dict.fromkeys(("liquid_offset", "liquid_angle", "error_estimate"), unknown)
    return replace(found, **none, model=np.full(found.speed.shape, "none"))


def _with_balls(scene: Scene) -> Answers:
    """Answers of one scene with balls as `run` gives them: the state reported at each speed."""
    result = run_balls(scene, families=False)
    known = {name: getattr(result, name, None) for name in kept_of(scene).over_speed}
    nothing, inside = np.full(result.speed.shape, np.nan), np.ones(result.speed.shape, dtype=bool)
    known |= {"in_range": inside} if known["in_range"] is None else {}
    found: dict[str, Any] = {
        name: (nothing if values is None else values)[None] for name, values in known.items()
    }
    found["balanced_from"] = np.array([result.balanced_from])
    for name in ("amplitude", "amplitude_dry"):
        found[f"peak_{name}"] = np.fmax.reduce(found[name], axis=1)
    return Answers(**found, **worst_of(result.loads))


def _planar(scenes: Sequence[Scene]) -> Answers:
    """Answers of planar rotors, over all pairs of a scene and a speed at once."""
    shape = len(scenes), scenes[0].speeds.count
    prepared = [prepare(scene) for scene in scenes]
    machines = [(machine.planar, machine.scene.fills) for machine in prepared]
    gravity = np.array([machine.axial_gravity for machine in prepared])
    choices = choose_all(prepared)
    speed = np.stack([machine.speed for machine in prepared]).ravel()
    owner = np.repeat(np.arange(len(scenes)), shape[1])
    frictions = [machine.waves for machine in prepared]
    growth, whirl_speed = machines_growth(machines, frictions, owner, speed)
    model = np.concatenate([choice.models for choice in choices])
    found: dict[str, Any] = {
        "speed": speed,
        "growth": growth,
        "whirl_speed": whirl_speed,
        "model": model,
        "error_estimate": np.concatenate([choice.error for choice in choices]),
    }
    parts, places = [], []
    for name in np.unique(model).tolist():
        rows = np.flatnonzero(model == name)
        parts.append(machine_responses(machines, owner[rows], speed[rows], gravity, synchronous_model(name)))
        places.append(rows)
    answer = joined(parts).at(np.argsort(np.concatenate(places)))
    found["phase"] = phase(answer.deflection)
    copied = ("amplitude", "amplitude_dry", "liquid_offset", "liquid_angle", "dry_patch", "converged")
    found |= {name: getattr(answer, name) for name in copied}
    # What is not known is not stable.
    found["stable"] = answer.stable & (growth <= 0.0)
    found["in_range"] = answer.in_range & np.stack([choice.in_range for choice in choices]).ravel()
    held = replace(answer, in_range=found["in_range"])
    each = [held.at(np.flatnonzero(owner == k)) for k in range(len(scenes))]
    found = {name: values.reshape(shape) for name, values in found.items()}
    between = responses_between(prepared, each)
    loads = [
        worst_of(loads_of(loaded_machine(one.scene), one.scene, own, refined))
        for one, own, refined in zip(prepared, each, between, strict=True)
    ]
    known = set.intersection(*map(set, loads))
    worst = {name: np.concatenate([one[name] for one in loads]) for name in known}
    return Answers(**found, **_peaks(each, between), **worst)


def _peaks(answers: Sequence[Response], between: Sequence[Response]) -> dict[str, Any]:
    """Largest amplitudes of each scene at its speeds and between them."""
    every = [joined(pair) for pair in zip(answers, between, strict=True)]
    return {
        "peak_amplitude": np.array([each.peak.amplitude for each in every]),
        "peak_amplitude_dry": np.array([highest(each.speed, each.amplitude_dry).amplitude for each in every]),
    }


def _single(scene: Scene) -> Answers:
    """Answers of one scene as `run` gives them."""
    result = run_scene(scene)
    nothing = np.full(result.speed.shape, np.nan)
    found: dict[str, Any] = {name: getattr(result, name) for name in kept_of(scene).over_speed}
    found["peak_amplitude"] = np.array(result.peak["amplitude"])
    found["peak_amplitude_dry"] = np.array(result.peak_dry["amplitude"])
    found = {name: (nothing if value is None else value)[None] for name, value in found.items()}
    return Answers(**found, **worst_of(result.loads))
