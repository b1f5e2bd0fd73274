"""What the sources say of rotors, bearings and pumps, beside what follows from their own equations."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fluid.liquid import known_liquid
from solvers.rotor.balls.stability import balanced_roots
from solvers.rotor.balls.two_plane_balance import RigidRotor, dynamic_balancing, of_two_planes
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import TwoPlane
from solvers.rotor.vector_model import balance_angles
from solvers.rotor.vibration import unbalance_response
from solvers.synchronous.response import response
from validation.case import Case, Claims
from validation.cases.rotors.rigs import horizontal_rig, horizontal_rotor
from validation.cases.rotors.tub import suspended_tub
from validation.cases.two_plane.damping import damped, lasting
from validation.cases.two_plane.machine import BALLS, LONG, RACES

CLAIMS = Claims("errata")

_RPM = math.pi / 30.0


def cases() -> Iterator[Case]:
    """Errata of the stability condition, the resonance peak, the spindle, the pump, the balancers."""
    yield from (_products_of_inertia(), _peak_shift(), *_bearing())
    # Place of X_5 on the spindle's housing: eq. 14 and 16 against eq. 4 and 5.
    (place,) = {row for row, _ in _ROWS["X_5"]}
    for number in (14, 16):
        yield CLAIMS.case("dr-eq-x5", float(place), number=number)
    yield from _drag_number()
    yield _weak_supports()


def statements() -> Iterator[Case]:
    """What the sources say of the liquid, of forces and of limits, and their own equations contradict."""
    # The angle of the liquid below resonance, for an unbalance that outweighs the liquid.
    angle = math.degrees(float(balance_angles(math.radians(30.0), 2.0)[0]))
    within, off = 90.0 <= angle <= 180.0, f"{'below 90' if angle < 90.0 else 'above 180'} deg"
    yield CLAIMS.case("dr-alpha-range", angle, within, difference="none" if within else off)
    # What liquid leaves of the unbalance well below the resonance, where it lies along the deflection.
    rotor, fills = horizontal_rotor(0.1, 1000.0 * _RPM), horizontal_rig()
    answer = response(rotor, fills, np.array([500.0 * _RPM]), gravity=0.0)
    wet, dry = (float(np.abs(w[0])) for w in (answer.deflection, answer.deflection_dry))
    lag = -math.degrees(float(np.angle(answer.deflection[0])))
    yield CLAIMS.case("dr-any-speed", wet / dry, wet < dry, lag=lag)
    # The parameter of the paraboloid in words below eq. 16 and in eq. 17.
    gravity, speed = 9.81, 90.0
    weight = known_liquid("water").density * gravity
    yield CLAIMS.case("dr-beta", speed**2 / (2.0 * gravity), printed=weight * speed**2 / (2.0 * gravity))
    # Which forces a static unbalance in the middle of the tub exerts.
    machine = suspended_tub().system()
    names = ("x", "y", "z", "alpha", "beta", "gamma")
    acting = [name for name, part in zip(names, machine.unbalance, strict=True) if abs(part) > 0.0]
    yield CLAIMS.case("dg-forces", " and ".join(f"Q_{name}" for name in acting), acting == ["x", "y"])
    # FF20, eq. 37: of a long rotor without coupling the limit of the tilt need not be the highest.
    long = RigidRotor(mass=10.0, inertia=(0.5, 0.5, 0.1), stiffness=(1e4, 1e4), position=(0.05, -0.05))
    limit = math.sqrt(long.support[2] / (0.5 - 0.1))
    yield CLAIMS.case("ff-eq-37", dynamic_balancing(long, 1.0).above, printed=limit)


def _products_of_inertia() -> Case:
    """DR18, eq. 13: derivative of W by gamma_2 upright, gamma_3 following from the unit length."""
    import sympy as sp

    first, second, spin = sp.symbols("gamma_1 gamma_2 omega")
    moments = sp.symbols("A B C D E F")
    a, b, c, d, e, f = moments
    third = sp.sqrt(1 - first**2 - second**2)
    inertia = a * first**2 + b * second**2 + c * third**2
    inertia -= 2 * (d * second * third + e * first * third + f * first * second)
    slope = sp.diff(-(spin**2) * inertia / 2, second).subs({first: 0, second: 0})
    computed = sp.simplify(slope / spin**2)
    return CLAIMS.case("dr-eq-13", str(computed), computed == e)


def _peak_shift() -> Case:
    """DR18, below Fig. 20: where the largest deflection under an unbalance lies as damping grows."""
    from scipy.optimize import minimize_scalar

    def peak(ratio: float) -> float:
        rotor = Jeffcott(1.0, 1.0, 2.0 * ratio, 1.0).system()
        found = minimize_scalar(
            lambda speed: -abs(unbalance_response(rotor, [speed])[0, 0]),
            bounds=(0.5, 2.0),
            method="bounded",
            options={"xatol": 1e-10},
        )
        return float(found.x)

    shift = peak(0.2)
    return CLAIMS.case("dr-fig-20", shift, shift <= 1.0, exact=1.0 / math.sqrt(1.0 - 2.0 * 0.2**2))


# The spindle's speeds that bring each frequency of its bearings to 33 Hz, Hz [DR18, chapter 2.2, table 1].
_RESONANCE = 33.0
_CAGE, _OUTER, _INNER = 85.77, 9.55, 5.96


def _bearing() -> list[Case]:
    """Ball pass frequency of the outer ring from those of cage and inner ring in the same table."""
    cage = _RESONANCE / _CAGE
    balls = round(_RESONANCE / _INNER / (1.0 - cage))
    computed = _RESONANCE / (cage * balls)
    share = 1.0 - 2.0 * cage
    rolling = [
        _RESONANCE / (0.5 * across / share * (1.0 - share**2))
        for across in (1.0, math.cos(math.radians(15.0)))
    ]
    return [
        CLAIMS.case("dr-table-bpfo", computed, tolerance=0.5 * 0.01 / _OUTER, share=share, balls=balls),
        CLAIMS.case(
            "dr-table-bsf",
            rolling[1],
            tolerance=0.5 * 0.1 / 16.1,
            note=f"printed is that of a contact angle of 0, {rolling[0]:.2f}; bearings 7004 have one",
        ),
    ]


# Where reactions act on the housing: indices of the compliances that eq. 5 multiplies with X_1 to X_4 in the
# rows of X_5 and X_6, one row each.
_ROWS = {"X_5": ((1, 2), (1, 3), (1, 4), (1, 5)), "X_6": ((6, 2), (6, 3), (6, 4), (6, 5))}


def _drag_number() -> Iterator[Case]:
    """DR18, chapter 2.3, table 1: the drag's similarity number from the table's own values."""
    shape, viscosity, length, radius = 0.91, 0.056, 22e-3, 7.8e-3
    mass, stiffness, inertia = 12.42e-3, 6000.0, 6.9e-7
    plain = shape * viscosity * math.pi * length**3 * math.sqrt(mass / stiffness) / inertia
    # Radius and length over the scale of lengths, which is the length.
    full = plain * (radius / length) ** 2
    for key, place, computed, note in (
        ("table", "table 1", plain, "the table's formula with the table's values"),
        ("eq-41", "table 1 and eq. 41", full, "eq. 41 has r^2 l over the length as well, r = d/2"),
    ):
        yield CLAIMS.case("dr-pump-drag", computed, key=key, place=place, note=note)


def _weak_supports() -> Case:
    """FF20, conclusion 2: from which speed balls balance a long rotor whose supports hardly damp."""
    damping = 0.5
    weak = damped(LONG, damping)
    printed = dynamic_balancing(of_two_planes(weak, BALLS), 1.0).above

    def first(rotor: TwoPlane) -> float:
        """Least speed above which the rotor without unbalance and its balls are stable, rad/s."""
        system = rotor.system()
        speeds = np.linspace(40.0, 150.0, 101)
        return lasting(lambda speed: balanced_roots(system, RACES, speed).real.max() < 0.0, speeds, 30)

    words = {"damping": damping, "printed": float(printed), "usual": first(LONG)}
    return CLAIMS.case("ff-conclusion-2", first(weak), **words)
