"""The suspended tub of DG21 and the bearing of DR18: what is stated, and what follows from it."""

from __future__ import annotations

import math

import numpy as np

from solvers.rotor.system import cage_speed
from solvers.rotor.vibration import modes, orbit, unbalance_response
from validation.cases.case import Case, compare
from validation.cases.suspended_tub import (
    DRUM_MASS,
    ECCENTRICITY,
    FARTHEST,
    SPRING_ANGLE,
    TUB_MASS,
    amplitude,
    direction,
    suspended_tub,
)

_RPM = math.pi / 30.0
_ASSUMED = "inertias and places of springs and dampers are assumed"
_PLACES = np.linspace(0.0, FARTHEST, 7)
_SPEEDS = np.linspace(30.0, 400.0, 1481) * _RPM

# A ball bearing 203, the size that DR18 names: circle of the balls' centres and balls, mm.
_CIRCLE, _BALL = 28.5, 6.75


def cases() -> list[Case]:
    """Every case of the tub and of the bearing's cage."""
    return [
        _supercritical(),
        _measured(),
        _frequencies(),
        *_with_distance(),
        *_springs(),
        _rigidity_centre(),
        _cage(),
    ]


def _supercritical() -> Case:
    """Far above resonance the centre of mass of everything stands still."""
    machine = suspended_tub()
    system = machine.system()
    found = orbit(system, unbalance_response(system, [1e4]), 0.0)
    return compare(
        "tub/supercritical",
        "DG21, table 1",
        "amplitude far above resonance, m, y_D = 0",
        DRUM_MASS * ECCENTRICITY / (TUB_MASS + DRUM_MASS),
        float(found.amplitude[0]),
        tolerance=1e-3,
        note="printed is m_2 e/(m_1 + m_2) of the table; 3.7 mm for 1800 g mm of section 4 is an erratum",
    )


def _measured() -> Case:
    """The one amplitude that was measured, with an unbalance that cannot be the one that is stated."""
    size = 1e3 * amplitude(suspended_tub(), _SPEEDS, "z")
    share = 1800e-6 / (DRUM_MASS * ECCENTRICITY)
    return Case(
        name="tub/measured-amplitude",
        source="DG21, section 4",
        quantity="vertical amplitude with an unbalance of 1800 g mm, mm, y_D = 0; no speed is given",
        printed="4 measured, 3.7 computed by the authors",
        computed=f"{share * size[-1]:.2g} at {_SPEEDS[-1] / _RPM:.0f} rpm, {share * size.max():.2g} at most",
        difference=f"with the table's m_2 e it is {size[-1]:.3g} and {size.max():.3g}",
        verdict="differs",
        note="the amplitude fits the table's unbalance, a hundred times the stated one; " + _ASSUMED,
    )


def _frequencies() -> Case:
    found = modes(suspended_tub().system())
    listed = ", ".join(
        f"{one / (2.0 * math.pi):.2f} ({ratio:.2f})"
        for one, ratio in zip(found.frequency[0], found.damping_ratio[0], strict=True)
    )
    return Case(
        name="tub/natural-frequencies",
        source="DG21, section 4",
        quantity="natural frequencies at rest, Hz, with damping ratios",
        printed="computed within 10 % of measured ones, none is listed",
        computed=listed,
        difference="nothing to compare with",
        verdict="trend",
        note=_ASSUMED,
    )


def _with_distance() -> list[Case]:
    """Largest angular and longitudinal motion over the whole range of speeds, as the laundry moves off."""
    found = []
    for name, coordinate, unit, words in (
        ("angular-motion", "alpha", "mrad", "turn about x"),
        ("longitudinal-motion", "y", "mm", "motion along the axis"),
    ):
        size = [1e3 * float(amplitude(suspended_tub(y), _SPEEDS, coordinate).max()) for y in _PLACES]
        rises = bool(np.all(np.diff(size) > 0.0))
        found.append(
            Case(
                name=f"tub/{name}",
                source="DG21, section 5 and Fig. 5",
                quantity=f"largest {words}, {unit}, for y_D = 0 to 90 mm in steps of 15 mm",
                printed="grows with y_D",
                computed=", ".join(f"{one:.3g}" for one in size),
                difference="the same" if rises else "does not grow throughout",
                verdict="trend" if rises else "differs",
                note=_ASSUMED + "; angles beyond 100 mrad are more than linear theory can say",
            )
        )
    return found


def _springs() -> list[Case]:
    """The relations below Fig. 7 for the stiffness of a spring out of the plane across the axis."""
    turn = math.radians(30.0)
    flat, up, out = math.cos(SPRING_ANGLE), math.sin(SPRING_ANGLE), math.cos(turn)
    printed = (flat * out) ** 2 + (flat * math.sin(turn)) ** 2 + (up * out) ** 2
    way = direction(SPRING_ANGLE, turn, 1.0)
    return [
        compare(
            "tub/dg-spring-direction",
            "DG21, below Fig. 7",
            "(C_x^2 + C_y^2 + C_z^2)/C^2 at 75 deg, turned by 30 deg",
            printed,
            sum(one**2 for one in way),
            tolerance=1e-9,
            otherwise="erratum",
            note="C_y = C sin(phi) fits C_x and C_z; printed is C cos(chi) sin(phi)",
        ),
        compare(
            "tub/dg-spring-projection",
            "DG21, below Fig. 7; DR18, eq. 5",
            "stiffness of one spring at 75 deg across, over C",
            flat,
            flat**2,
            tolerance=1e-9,
            otherwise="erratum",
            note="a stiffness is projected twice, displacement and force: c d d^T",
        ),
    ]


def _rigidity_centre() -> Case:
    """Largest turn about x with the laundry in the middle, as the springs move along the axis."""
    shifts = np.array([0.0, 0.01, 0.02, 0.03])
    size = [1e3 * float(amplitude(suspended_tub(shift=one), _SPEEDS, "alpha").max()) for one in shifts]
    rises = bool(np.all(np.diff(size) > 0.0))
    return Case(
        name="tub/rigidity-centre",
        source="DG21, section 5; DR18, section 2",
        quantity="largest turn about x, mrad, for l_c = 0, 10, 20, 30 mm and y_D = 0",
        printed="least where the rigidity centre is at the centre of gravity",
        computed=", ".join(f"{one:.3g}" for one in size),
        difference="the same" if rises else "it is not least there",
        verdict="trend" if rises else "differs",
        note=_ASSUMED + "; the source does not say along which axis l_c lies: here along the spin axis",
    )


def _cage() -> Case:
    return compare(
        "tub/dr-eq-10",
        "DR18, eq. 10",
        "speed of the cage over that of the shaft, ball bearing 203, contact angle 0",
        0.5,
        float(cage_speed(1.0, _CIRCLE, _BALL, 0.0)),
        tolerance=0.01,
        otherwise="erratum",
        note="eq. 9 for beta = 0; eq. 10 forgets the balls: a cage without slip seems to lag by 24 %",
    )
