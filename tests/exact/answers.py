"""What each model of a layer answers to a whirl, beside the exact wave."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fluid import waves
from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.liquid_model import Whirl
from solvers.pypde.models import OneFamily
from tests.exact.branch import Held
from validation.exact import MODELS, Cases, detuning, whirl_speeds
from validation.exact.long_wave import steady_long_wave

# A liquid without friction in a drum of unit radius and height.
_IDEAL = Liquid("ideal", 1000.0, 0.0)


def layer_fill(layer: float) -> Fill:
    """Layer of depth h_0/R in a drum of unit radius."""
    chamber = Chamber(radius=1.0, height=1.0)
    return Fill(chamber, _IDEAL, volume=chamber.capacity * layer * (2.0 - layer))


def model_answers(layer: float, ratio: float, whirl: float) -> dict[str, float]:
    """G by each model at h_0/R, p/p_1 and w_0/h_0; nan where it has no smooth steady wave."""
    behind, ahead = whirl_speeds(layer, ratio)
    found = {"linear": float(waves.force_ratio(1.0 / (1.0 - layer) ** 2, behind))}
    for name, dispersion in (("long_wave", False), ("dispersion", True)):
        wave = steady_long_wave(layer, detuning(layer, ratio), whirl * layer, dispersion)
        found[name] = wave.force_ratio if wave.smooth else math.nan
    for name, dispersion in (("kdv", False), ("whitham", True)):
        found[name] = family_answer(layer, behind, whirl, dispersion)
        found[f"{name}_twin"] = family_answer(layer, ahead, whirl, dispersion)
    return found


def family_answer(layer: float, speed: float, whirl: float, dispersion: bool) -> float:
    """G by one family of waves at h_0/R, whirl speed over the spin, w_0/h_0; dispersion: the exact one."""
    fill, asked = layer_fill(layer), Whirl(1.0, speed, whirl * layer)
    answer = OneFamily(dispersion=dispersion).wave(fill, asked).answer
    if not answer.converged[0]:
        return math.nan
    return float(answer.unbalance[0].real) / (fill.full_mass * asked.amplitude)


def beside(points: Sequence[tuple[float, float, float]], held: Sequence[Held | None]) -> Cases:
    """All models beside exact waves at points (h_0/R, p/p_1, w_0/h_0); where `held` is None none is asked."""
    none = Held(*[math.nan] * 5)
    answers = [
        dict.fromkeys(MODELS, math.nan) if wave is None else model_answers(*point)
        for point, wave in zip(points, held, strict=True)
    ]
    found = [wave or none for wave in held]
    layer, ratio, whirl = np.array(points).T
    return Cases(
        layer=layer,
        ratio=ratio,
        whirl=whirl,
        exact=np.array([wave.force_ratio for wave in found]),
        crest=np.array([wave.crest for wave in found]),
        trough=np.array([wave.trough for wave in found]),
        ripple=np.array([wave.ripple for wave in found]),
        models={name: np.array([answer[name] for answer in answers]) for name in MODELS},
    )
