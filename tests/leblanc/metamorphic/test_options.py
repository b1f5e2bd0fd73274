"""Commands that take all they need as options: other units and similar problems are answered alike."""

from __future__ import annotations

from typing import Any

import pytest

from tests.oracles.alike import assert_alike
from tests.oracles.commands import by_options
from tests.oracles.machines import in_other_units, scaled

ROUNDING = 1e-12
# The liquid is water: its viscosity holds the square of the length to the time, its density the mass.
SCALES = (0.5, 0.125, 0.25)

_LAYER = {
    "radius": 0.15, "volume": 6.7e-4, "height": 0.05, "speed": 40.0, "whirl-speed": 32.0,
    "whirl-amplitude": 1.5e-4, "profile": True,
}  # fmt: skip
ASKED: dict[str, tuple[str, dict[str, Any]]] = {
    "statics": ("layer", _LAYER | {"model": "statics", "whirl-speed": 40.0}),
    "linear": ("layer", _LAYER | {"model": "linear"}),
    "long_wave": ("layer", _LAYER | {"model": "long_wave", "cells": 24, "friction": "stokes"}),
    "kdv": ("layer", _LAYER | {"model": "kdv", "friction": "stokes"}),
    "fem": ("layer", _LAYER | {"model": "fem", "cells": 24}),
    "from rest": ("layer", _LAYER | {
        "model": "long_wave", "cells": 24, "friction": "stokes", "duration": 1.0, "ramp": 0.5,
    }),
    "modes": ("modes", {
        "radius": 0.15, "volume": 6.7e-4, "height": 0.05, "speed": 40.0, "segments": 24, "layers": 2,
        "count": 4,
    }),
    "volume": ("volume", {
        "radius": 0.15, "height": 0.05, "speed": 40.0, "eccentricity": 0.003, "volume": 2e-4, "gravity": 9.81,
    }),
}  # fmt: skip


@pytest.mark.parametrize("name", ASKED)
def test_units(name: str) -> None:
    command, options = ASKED[name]
    answer = by_options(command, options)
    assert_alike(by_options(command, in_other_units(options)), answer, ROUNDING)


@pytest.mark.parametrize("name", ASKED)
def test_similar_problems(name: str) -> None:
    command, options = ASKED[name]
    answer = by_options(command, options)
    assert_alike(by_options(command, scaled(options, SCALES)), answer, ROUNDING, SCALES)
