"""The numbers a layer's answer rests on, and whether they are inside its model's range."""

from __future__ import annotations

from leblanc.results.layer import Number
from solvers.liquid_model import LiquidWave

MEANING = {
    "relative_depth": "mean depth over radius",
    "deflection": "whirl amplitude over mean depth",
    "detuning": "distance from the nearer free wave over that between the two",
    "froude": "whirl speed seen from the drum over the nearer free wave's",
    "centrifuge": "centrifugal acceleration at the surface over gravity across the axis",
    "reynolds": "spin speed times radius squared over viscosity",
    "wall_layer": "laminar layer at the wall over mean depth",
    "wave_amplitude": "largest change of depth over mean depth",
    "force_gap": "force by pressure less that by momentum, over the force or the full drum's",
    "other_family": "response of the family left out over that of the one taken",
}


def judge(wave: LiquidWave) -> tuple[Number, ...]:
    """Numbers that a model's answer rests on, against the model's ranges, in the order of `MEANING`."""
    numbers = []
    for name, meaning in MEANING.items():
        if name not in wave.numbers:
            continue
        value, bounds = wave.numbers[name], wave.ranges.get(name)
        least, most = bounds or (None, None)
        inside = bounds is None or bounds[0] <= value <= bounds[1]
        numbers.append(Number(name, meaning, value, least, most, inside))
    return tuple(numbers)
