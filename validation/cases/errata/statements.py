"""Statements of the sources that their own equations contradict [theory: errata]."""

from __future__ import annotations

import math

import numpy as np

from fluid.liquid import known_liquid
from solvers.rotor.balls.two_plane_balance import RigidRotor, dynamic_balancing
from solvers.rotor.vector_model import balance_angles
from solvers.synchronous.response import response
from validation.case import Case, Claims
from validation.cases.rotors.rigs import horizontal_rig, horizontal_rotor
from validation.cases.rotors.tub import suspended_tub

CLAIMS = Claims("errata")

_RPM = math.pi / 30.0


def cases() -> list[Case]:
    """Statements on the liquid's angle, on its effect, on a symbol, on forces and on an order of limits."""
    return [_angle_range(), _any_speed(), _parameter(), _forces(), _order_of_limits()]


def _angle_range() -> Case:
    """The angle of the liquid below resonance, for an unbalance that outweighs the liquid."""
    lag, ratio = math.radians(30.0), 2.0
    first, _ = balance_angles(lag, ratio)
    angle = math.degrees(float(first))
    return CLAIMS.case(
        "dr-alpha-range",
        angle,
        90.0 <= angle <= 180.0,
        difference="none" if 90.0 <= angle <= 180.0 else f"{'below 90' if angle < 90.0 else 'above 180'} deg",
    )


def _any_speed() -> Case:
    """What liquid leaves of the unbalance well below the resonance, where it lies along the deflection."""
    rotor, fills = horizontal_rotor(0.1, 1000.0 * _RPM), horizontal_rig()
    answer = response(rotor, fills, np.array([500.0 * _RPM]), gravity=0.0)
    with_liquid, without = (float(np.abs(w[0])) for w in (answer.deflection, answer.deflection_dry))
    lag = -math.degrees(float(np.angle(answer.deflection[0])))
    return CLAIMS.case("dr-any-speed", with_liquid / without, with_liquid < without, lag=lag)


def _parameter() -> Case:
    """The parameter of the paraboloid in words below eq. 16 and in eq. 17."""
    gravity, speed = 9.81, 90.0
    weight = known_liquid("water").density * gravity
    return CLAIMS.case("dr-beta", speed**2 / (2.0 * gravity), printed=weight * speed**2 / (2.0 * gravity))


def _forces() -> Case:
    """Which forces a static unbalance in the middle of the tub exerts."""
    machine = suspended_tub().system()
    names = ("x", "y", "z", "alpha", "beta", "gamma")
    acting = [name for name, part in zip(names, machine.unbalance, strict=True) if abs(part) > 0.0]
    return CLAIMS.case("dg-forces", " and ".join(f"Q_{name}" for name in acting), acting == ["x", "y"])


def _order_of_limits() -> Case:
    """FF20, eq. 37: of a long rotor without coupling the limit of the tilt need not be the highest."""
    rotor = RigidRotor(mass=10.0, inertia=(0.5, 0.5, 0.1), stiffness=(1e4, 1e4), position=(0.05, -0.05))
    _, _, tilting = rotor.support
    return CLAIMS.case(
        "ff-eq-37", dynamic_balancing(rotor, 1.0).above, printed=math.sqrt(tilting / (0.5 - 0.1))
    )
