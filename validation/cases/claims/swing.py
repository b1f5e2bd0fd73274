"""What unbalance swings the vertical rig by 35 mm [DR18, section 7.1].

The unbalance was raised in steps of 5 g until the rig swung by 35 mm or its motor hung at the resonance; one
step less, 30 g, was kept. Mass, damping and the load's place are not given, so they are assumed in ranges.
"""

from __future__ import annotations

import math

from scipy.optimize import minimize_scalar

from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vibration import unbalance_response
from validation.case import Case, Claims
from validation.cases.rotors.rigs import vertical_rotor

CLAIMS = Claims("claims")

LOAD, SWING, POWER = 35e-3, 35e-3, 180.0  # kg, m, W: as printed
PLACE = 0.2  # m from the axis, assumed: the inside of the drum
# Assumed ranges: kg that move, m of the load's place, damping ratio of soft steel brackets.
MASSES, PLACES, DAMPING_RATIOS = (10.0, 60.0), (0.15, 0.2), (0.003, 0.02)


def peak(rotor: Jeffcott) -> float:
    """Largest deflection at any constant speed, m."""
    unit, system = rotor.natural_frequency, rotor.system()
    found = minimize_scalar(
        lambda speed: -abs(unbalance_response(system, [speed])[0, 0]),
        bounds=(0.9 * unit, 1.2 * unit),
        method="bounded",
        options={"xatol": 1e-9 * unit},
    )
    return float(-found.fun)


def rig(mass: float, place: float, damping_ratio: float, load: float = LOAD) -> Jeffcott:
    """Rig of moving mass, kg, with a load, kg, at `place` from the axis, m; its suspension at 2.25 Hz."""
    unit = vertical_rotor().natural_frequency
    return Jeffcott(mass, mass * unit**2, 2.0 * damping_ratio * mass * unit, load * place)


def damping_that_swings(mass: float) -> float:
    """Damping ratio with which the load swings the rig by 35 mm.

    U/(2 M zeta sqrt(1 - zeta^2)) is the largest deflection [theory: rotor, eq. 34].
    """
    double = LOAD * PLACE / (mass * SWING)  # 2 zeta sqrt(1 - zeta^2) = sin(2 asin(zeta))
    return math.sin(0.5 * math.asin(double))


def cases() -> list[Case]:
    """The swing with the example's values, over the assumed ranges, and what it asks of the motor."""
    usual = vertical_rotor()
    least = peak(rig(MASSES[1], PLACES[0], DAMPING_RATIOS[1]))
    most = peak(rig(MASSES[0], PLACES[1], DAMPING_RATIOS[0]))
    ratio, speed = damping_that_swings(usual.mass), usual.natural_frequency
    light = rig(usual.mass, PLACE, ratio)
    power = light.damping * speed**2 * SWING**2
    return [
        CLAIMS.case("35-g", peak(rig(usual.mass, PLACE, usual.damping_ratio)), ratio=ratio),
        CLAIMS.case(
            "35-g-range",
            f"{least * 1e3:.1f} to {most * 1e3:.0f} mm",
            least <= SWING <= most,
            product=ratio * usual.mass,
            left=peak(rig(usual.mass, PLACE, ratio, 30e-3)) * 1e3,
        ),
        CLAIMS.case(
            "35-g-motor", agrees=power < POWER, power=power, difference=f"{power / POWER:.2g} of the motor's"
        ),
    ]
