"""Whether the liquid compensates on the vertical rig, below, at and above resonance [DR18, section 7.1]."""

from __future__ import annotations

import math

import numpy as np

from solvers.synchronous.response import critical_speed, response
from validation.cases.case import Case
from validation.cases.scenes import data, vertical_rig, vertical_rotor


def cases() -> list[Case]:
    """Angle and gain at the three speeds of the photographs."""
    measured = data("dr18_vertical_rig.json")
    speed = np.array(measured["speed_rad_s"])
    answer = response(vertical_rotor(), vertical_rig(), speed)
    wet = critical_speed(vertical_rotor(), vertical_rig())
    gain = np.abs(answer.deflection) / np.abs(answer.deflection_dry)
    found = []
    for k, one in enumerate(speed):
        lag = -math.degrees(answer.liquid_angle[k])
        helps = lag > 90.0 and gain[k] < 1.0
        found.append(
            Case(
                name=f"vertical_rig/{one:g}-rad-s",
                source="DR18, section 7.1",
                quantity=f"liquid opposite the unbalance at {one:g} rad/s",
                printed="it compensates",
                computed=f"{lag:.0f} deg behind the unbalance, amplitude times {gain[k]:.2f}",
                difference="the same" if helps else "the liquid adds to the vibration here",
                verdict="trend" if helps else "differs",
                note=f"mass, heights, damping and radius of the 30 g are assumed; critical speed with liquid "
                f"{wet:.1f} rad/s; equilibrium compensates above it only",
            )
        )
    return found
