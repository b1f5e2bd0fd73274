"""The vector model against the solved rotor [DR18, eq. 24-26]."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any

import numpy as np

from fluid.printed import liquid_angle_as_printed
from meshes.errors import InputError
from solvers.rotor.vector_model import balance_residual, deflection_lag, unbalance_left
from solvers.statics.hydrostatics import equilibrium
from solvers.synchronous.response import response
from validation.case import Case, Claims
from validation.cases.rotors.rigs import horizontal_rig, horizontal_rotor

CLAIMS = Claims("vector_model")

_RPM = 2.0 * math.pi / 60.0


def cases() -> list[Case]:
    """Equation 24 at every speed of the solved response, equation 25 as published, equation 26."""
    rotor, fills = horizontal_rotor(0.1, 1000.0 * _RPM), horizontal_rig()
    speed = np.linspace(100.0, 2000.0, 201) * _RPM
    answer = response(rotor, fills, speed, gravity=0.0)
    size = np.abs(answer.deflection)
    liquid = sum(
        fill.liquid.density * equilibrium(fill.chamber, fill.volume, size, speed, 0.0).unbalance()[0]
        for fill in fills
    )
    ratio = rotor.unbalance / np.asarray(liquid)
    # The rotor's unbalance seen from the liquid, which lies along the deflection.
    angle = -answer.liquid_angle
    lag = np.asarray(deflection_lag(speed, rotor.mass, rotor.damping, rotor.stiffness))
    residual = np.abs(np.asarray(balance_residual(angle, lag, ratio))) / np.maximum(1.0, ratio)
    left = np.asarray(unbalance_left(angle, ratio))
    total = np.abs(rotor.unbalance + liquid * np.exp(1j * answer.liquid_angle)) / rotor.unbalance
    # Angle of eq. 25 as published at 900 rpm, where the solved response has another.
    k = int(np.argmin(np.abs(speed - 900.0 * _RPM)))
    computed, printed = math.degrees(angle[k]), None
    with suppress(InputError):
        printed = math.degrees(liquid_angle_as_printed(float(lag[k]), float(ratio[k])))
    same = printed is not None and abs(printed - computed) <= 1e-6
    words: dict[str, Any] = {"rpm": speed[k] / _RPM, "k": ratio[k], "printed": printed}
    words["difference"] = "no real angle" if printed is None else f"{printed - computed:+.1f} deg"
    return [
        CLAIMS.case("eq-24", float(residual.max()), residual.max() < 1e-10),
        CLAIMS.case("eq-26", float(np.max(np.abs(left - total))), np.max(np.abs(left - total)) < 1e-10),
        CLAIMS.case("eq-25", computed, same, **words),
    ]
