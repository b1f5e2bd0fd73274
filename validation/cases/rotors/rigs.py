"""Two rigs against what was measured on them [DR18, Fig. 24 and section 7.1].

On the horizontal rig the angle of the liquid from the unbalance is compared. Its damping is not given: it is
fitted, in three ways of growing freedom, and every point's residual is shown. The six angles are multiples of
30 deg, so half of that is what they were read to. On the vertical rig it is asked whether the liquid
compensates below, at and above resonance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from fluid.fill import Fill
from fluid.liquid import known_liquid
from fluid.waves import gravity_displacement
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.vector_model import deflection_lag
from solvers.synchronous.response import critical_speed, response
from validation.case import Case, Claims, Effect
from validation.study import data

HORIZONTAL, VERTICAL = Claims("horizontal_rig"), Claims("vertical_rig")


def horizontal_rig() -> tuple[Fill, ...]:
    """The two chambers of DR18, section 7.2; their height of 20 mm is assumed."""
    water = known_liquid("water")
    return tuple(Fill(Chamber(radius, 0.02), water, 10e-6) for radius in (0.065, 0.05))


def horizontal_rotor(damping_ratio: float, wet_critical_speed: float) -> Jeffcott:
    """Rotor of DR18, section 7.2, of known critical speed with liquid; 4 kg and 60 mm are assumed.

    The damping ratio counts the liquid's added mass.
    """
    mass, unbalance = 4.0, 10e-3 * 60e-3
    total = mass + sum(fill.full_mass for fill in horizontal_rig())
    stiffness = total * wet_critical_speed**2
    return Jeffcott(mass, stiffness, 2.0 * damping_ratio * total * wet_critical_speed, unbalance)


def vertical_rig() -> tuple[Fill, ...]:
    """The three chambers of DR18, section 7.1; their height of 40 mm and the aperture are assumed."""
    water = known_liquid("water")
    walls = ((0.2, 0.15, 0.45e-3), (0.15, 0.1, 0.30e-3), (0.1, 0.05, 0.25e-3))
    return tuple(Fill(Chamber(outer, 0.04, inner), water, volume) for outer, inner, volume in walls)


def vertical_rotor() -> Jeffcott:
    """Rotor of DR18, section 7.1, on its suspension of 2 to 2.5 Hz.

    Assumed are 30 kg, 200 mm for the place of the 30 g, and the damping ratio.
    """
    mass, frequency = 30.0, 2.0 * math.pi * 2.25
    return Jeffcott(mass, mass * frequency**2, 2.0 * 0.01 * mass * frequency, unbalance=30e-3 * 0.2)


_RPM = 2.0 * math.pi / 60.0
_READING = 15.0  # deg
_RESONANCE = 1000.0 * _RPM


def horizontal_cases() -> list[Case]:
    """The fits, the six points of the best founded one, and what gravity adds."""
    measured = data("dr18_fig24.json")
    speed = np.array(measured["speed_rpm"]) * _RPM
    angle = np.array(measured["angle_deg"], dtype=float)
    # Lag of the deflection behind the total unbalance of a rotor of unit mass.
    lag = _fit(
        lambda x: np.degrees(deflection_lag(speed, 1.0, 2.0 * x[0] * _RESONANCE, _RESONANCE**2)), angle, [0.1]
    )
    rotor = _fit(lambda x: _liquid_angle(speed, x[0], _RESONANCE), angle, [0.1])
    free = _fit(lambda x: _liquid_angle(speed, x[0], x[1] * _RESONANCE), angle, [0.1, 1.0])
    found = [
        _summary("lag-alone", "tan(delta) alone, resonance held at 1000 rpm", angle, *lag),
        _summary("rotor-and-liquid", "rotor with liquid, resonance held at 1000 rpm", angle, *rotor),
        _summary("resonance-free", f"the same, resonance free: {1000 * free[0][1]:.0f} rpm", angle, *free),
    ]
    for at, given, off in zip(measured["speed_rpm"], angle, rotor[1], strict=True):
        told = {"at": at, "printed": float(given), "difference": f"{-off:+.1f} deg"}
        found.append(HORIZONTAL.case("rpm", float(given + off), abs(off) <= _READING, **told))
    # Gravity moves the surface, but backwards in the drum: nothing of it is synchronous.
    shifts = []
    for fill in horizontal_rig():
        kappa = (fill.chamber.radius / fill.surface_radius) ** 2
        shifts.append(np.asarray(gravity_displacement(kappa, speed, 9.81)) / fill.depth)
    largest, slowest = float(np.max(np.abs(shifts))), speed[0] / _RPM
    return [*found, HORIZONTAL.case("gravity", largest=largest, slowest=slowest)]


def _fit(model: Callable[[Array], Array], angle: Array, start: list[float]) -> tuple[Array, Array]:
    """Parameters of least squares and the residuals computed - measured, deg."""
    from scipy.optimize import least_squares

    found = least_squares(lambda x: model(x) - angle, start, x_scale=0.1, diff_step=1e-4)
    return np.asarray(found.x), np.asarray(found.fun)


def _liquid_angle(speed: Array, damping_ratio: float, resonance: float) -> Array:
    """Angle of the liquid behind the unbalance by the solved response, deg."""
    rotor = horizontal_rotor(damping_ratio, resonance)
    answer = response(rotor, horizontal_rig(), speed, gravity=0.0)
    return np.asarray(-np.degrees(answer.liquid_angle))


def _summary(name: str, what: str, angle: Array, parameters: Array, residual: Array) -> Case:
    spread = float(np.sqrt(np.mean(residual**2)))
    listed = ", ".join(f"{error:+.1f}" for error in residual)
    turned = angle + residual
    effect = Effect(
        "turn of the liquid through resonance, deg", float(np.ptp(angle)), float(turned[-1] - turned[0])
    )
    return HORIZONTAL.case(
        "summary",
        float(parameters[0]),
        bool(np.all(np.diff(turned) > 0.0)),
        name=name,
        what=what,
        listed=listed,
        spread=spread,
        effect=effect,
    )


def vertical_cases() -> Iterator[Case]:
    """Angle and gain at the three speeds of the photographs."""
    speed = np.array(data("dr18_vertical_rig.json")["speed_rad_s"])
    answer = response(vertical_rotor(), vertical_rig(), speed)
    wet = critical_speed(vertical_rotor(), vertical_rig())
    gain = np.abs(answer.deflection) / np.abs(answer.deflection_dry)
    for k, spin in enumerate(speed):
        lag = -math.degrees(answer.liquid_angle[k])
        told = f"{lag:.0f} deg behind the unbalance, amplitude times {gain[k]:.2f}"
        yield VERTICAL.case("rad-s", told, lag > 90.0 and gain[k] < 1.0, spin=spin, wet=wet)
