"""The numbers a layer's answer rests on, and whether they are inside its model's range."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict

from fluid.fill import Fill
from fluid.numbers import whirl_numbers
from leblanc.results.layer import Number
from solvers.layer.state import Whirl

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

Range = tuple[float, float]

_CAPTURED: Range = (1.0, math.inf)
# The flow between the wall layers is free of vorticity only while they are thin.
_THIN_LAYERS: Range = (0.0, 0.2)
_LONG: Range = (0.0, 0.3)

RANGES: Mapping[str, Mapping[str, Range]] = {
    # The liquid is at rest: any depth, any amplitude, dry walls.
    "statics": {},
    # Next to a synchronous whirl the linear surface is the exact one while it is wet.
    "linear": {"wave_amplitude": (0.0, 0.3), "centrifuge": _CAPTURED, "wall_layer": _THIN_LAYERS},
    "long_wave": {
        "relative_depth": _LONG,
        "centrifuge": _CAPTURED,
        "wall_layer": _THIN_LAYERS,
        "force_gap": (0.0, 0.1),
    },
    "kdv": {
        "relative_depth": _LONG,
        "wave_amplitude": (0.0, 0.3),
        "other_family": (0.0, 0.2),
        "wall_layer": _THIN_LAYERS,
    },
}


def judge(
    model: str,
    fill: Fill,
    whirl: Whirl,
    found: Mapping[str, float],
    ranges: Mapping[str, Range] | None = None,
) -> tuple[Number, ...]:
    """Numbers of a whirl and of what the model found, against the model's range.

    Parameters
    ----------
    model : name in `RANGES`
    fill, whirl : what was asked
    found : further numbers, by names in `MEANING`
    ranges : in place of `RANGES` for some of them

    Returns
    -------
    One Number each, in the order of `MEANING`
    """
    given = whirl_numbers(fill, whirl.spin, whirl.speed, whirl.amplitude, whirl.gravity)
    values = asdict(given) | dict(found)
    limits = dict(RANGES[model]) | dict(ranges or {})
    numbers = []
    for name, meaning in MEANING.items():
        if name not in values:
            continue
        value, bounds = values[name], limits.get(name)
        least, most = bounds or (None, None)
        inside = bounds is None or bounds[0] <= value <= bounds[1]
        numbers.append(Number(name, meaning, value, least, most, inside))
    return tuple(numbers)
