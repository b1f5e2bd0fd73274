"""Statements of the sources that their own equations contradict [theory: errata]."""

from __future__ import annotations

import math

import numpy as np

from fluid.liquid import known_liquid
from solvers.rotor.balls.two_plane_balance import RigidRotor, dynamic_balancing
from solvers.rotor.vector_model import balance_angles
from solvers.synchronous.response import response
from validation.case import Case, compare
from validation.cases.rotors.rigs import horizontal_rig, horizontal_rotor
from validation.cases.rotors.tub import suspended_tub

_RPM = math.pi / 30.0


def cases() -> list[Case]:
    """Statements on the liquid's angle, on its effect, on a symbol, on forces and on an order of limits."""
    return [_angle_range(), _any_speed(), _parameter(), _forces(), _order_of_limits()]


def _angle_range() -> Case:
    """The angle of the liquid below resonance, for an unbalance that outweighs the liquid."""
    lag, ratio = math.radians(30.0), 2.0
    first, _ = balance_angles(lag, ratio)
    angle = math.degrees(float(first))
    return Case(
        "errata/dr-alpha-range",
        "DR18, below eq. 25; DG21, below eq. 4",
        "alpha_0, deg (delta = 30 deg, k = 2)",
        "from 90 to 180 for every delta from 0 to 90 deg",
        angle,
        "none" if 90.0 <= angle <= 180.0 else f"{'below 90' if angle < 90.0 else 'above 180'} deg",
        "agrees" if 90.0 <= angle <= 180.0 else "erratum",
        "for k >= 1 the one equilibrium is delta + arcsin(sin(delta)/k); the range is that of the second "
        "root, of which the misprinted arccosine is the angle",
    )


def _any_speed() -> Case:
    """What liquid leaves of the unbalance well below the resonance, where it lies along the deflection."""
    rotor, fills = horizontal_rotor(0.1, 1000.0 * _RPM), horizontal_rig()
    answer = response(rotor, fills, np.array([500.0 * _RPM]), gravity=0.0)
    with_liquid, without = (float(np.abs(w[0])) for w in (answer.deflection, answer.deflection_dry))
    lag = -math.degrees(float(np.angle(answer.deflection[0])))
    return Case(
        "errata/dr-any-speed",
        "DR18, below eq. 20 and end of section 5",
        "deflection with liquid over that without at half the critical speed, horizontal rig",
        "below 1: balancing at any speed",
        with_liquid / without,
        "the same" if with_liquid < without else "the opposite",
        "agrees" if with_liquid < without else "erratum",
        "the surface is a circle about the rotation axis: the liquid lies along the deflection, which lags "
        f"the unbalance by {lag:.0f} deg here; section 6 says so",
    )


def _parameter() -> Case:
    """The parameter of the paraboloid in words below eq. 16 and in eq. 17."""
    gravity, speed = 9.81, 90.0
    weight = known_liquid("water").density * gravity
    return compare(
        "errata/dr-beta",
        "DR18, below eq. 16",
        "beta of water at 90 rad/s, 1/m",
        weight * speed**2 / (2.0 * gravity),
        speed**2 / (2.0 * gravity),
        tolerance=1e-3,
        otherwise="erratum",
        note="1/beta = 2 g/(gamma omega^2) is printed, gamma the weight of a volume; eq. 17, 18 and 20 take "
        "it without gamma, and only so are they lengths and volumes",
    )


def _forces() -> Case:
    """Which forces a static unbalance in the middle of the tub exerts."""
    machine = suspended_tub().system()
    names = ("x", "y", "z", "alpha", "beta", "gamma")
    acting = [name for name, part in zip(names, machine.unbalance, strict=True) if abs(part) > 0.0]
    return Case(
        "errata/dg-forces",
        "DG21, section 5, before Fig. 4",
        "forces that a static unbalance exerts on a tub whose centre lies on the axis",
        "Q_x and Q_y, Q_y being 0 in the same sentence",
        " and ".join(f"Q_{name}" for name in acting),
        "none" if acting == ["x", "y"] else "another force",
        "agrees" if acting == ["x", "y"] else "erratum",
        "the drum spins about y",
    )


def _order_of_limits() -> Case:
    """FF20, eq. 37: of a long rotor without coupling the limit of the tilt need not be the highest."""
    rotor = RigidRotor(mass=10.0, inertia=(0.5, 0.5, 0.1), stiffness=(1e4, 1e4), position=(0.05, -0.05))
    _, _, tilting = rotor.support
    return compare(
        "errata/ff-eq-37",
        "FF20, eq. 37",
        "speed above which a long rotor in two supports 100 mm apart is balanced, rad/s",
        math.sqrt(tilting / (0.5 - 0.1)),
        dynamic_balancing(rotor, 1.0).above,
        tolerance=1e-9,
        otherwise="erratum",
        note="the shift's limit sqrt(k11/M) is higher here: the largest of eq. 34 counts",
    )
