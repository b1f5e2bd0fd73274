"""How stuck balls lose their motion: small motions of the stuck state, and capture by the unbalance."""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import polynomial

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.exciter.machine import Dimensionless, stuck_speeds


def stuck_roots(machine: Dimensionless, stuck: float, share: float = 1.0) -> Complex:
    """Small motions of balls that stick together, all of them moving alike [theory: exciter, eq. 4].

    Growth rate and frequency of each in the axes that turn with the balls, in units of the natural frequency,
    the largest growth rate first, shape (5,); the shift of their common phase is left out. `share` is k/N of
    the balls that stick together, the others not near this speed.
    """
    _require_share(share)
    q, h = stuck, machine.damping
    stiffness = complex(1.0 - q * q, 2.0 * h * q)
    platform = np.array([stiffness, complex(2.0 * h, 2.0 * q), 1.0])
    steady = share * q * q / stiffness
    # The platform's answer to a change of the balls' speed, times `platform`, and its acceleration.
    answer = np.array([2.0 * q * (share + steady) - 2j * h * steady, -1j * (share + steady)])
    acceleration: Complex = polynomial.polyadd(
        polynomial.polymul([-q * q, 2j * q, 1.0], answer),
        polynomial.polymul(steady * np.array([-2.0 * q, 1j]), platform),
    )
    drag = machine.smallness * machine.drag
    torque = polynomial.polymul(acceleration, platform.conj()).imag
    bell = polynomial.polymul(platform, platform.conj()).real
    whole = polynomial.polyadd(polynomial.polymul([drag, 1.0], bell), 0.5 * machine.smallness * torque)
    roots = np.asarray(polynomial.polyroots(whole), dtype=np.complex128)
    return roots[np.argsort(-roots.real)]


def parting_roots(machine: Dimensionless, stuck: float, share: float = 1.0) -> Complex:
    """Small motions of stuck balls against one another [theory: exciter, eq. 5].

    Shape (2,), the largest growth rate first: it passes zero where the balls turn at the natural frequency,
    for any unbalance to this order.
    """
    _require_share(share)
    half = 0.5 * machine.smallness * machine.drag
    bell = (1.0 - stuck**2) ** 2 + (2.0 * machine.damping * stuck) ** 2
    spring = 0.5 * machine.smallness * share * stuck**4 * (1.0 - stuck**2) / bell
    turn = complex(half * half - spring) ** 0.5
    return np.array([-half + turn, -half - turn])


def capture_unbalance(machine: Dimensionless, speed: float, share: float) -> float:
    """Unbalance up to which balls can turn at the third stuck speed past the shaft [theory: exciter, eq. 7].

    delta; a larger one pulls the balls into step with the shaft. nan where there is no third stuck speed. For
    a weak drag of the race, eps b small beside the frequency at which a captured ball swings; `share` is k/N
    of the balls at that speed.
    """
    _require_share(share)
    third = third_speed(machine, speed, share)
    answer = speed**2 / abs(complex(1.0 - speed**2, 2.0 * machine.damping * speed))
    return math.pi**2 / 8.0 * (1.0 - third / speed) ** 2 / (machine.smallness * answer)


def third_speed(machine: Dimensionless, speed: float, share: float = 1.0) -> float:
    """Largest stuck speed of a share of the balls, beyond resonance [theory: exciter, eq. 1].

    nan where all stuck speeds are below 1.
    """
    _require_share(share)
    fastest = float(np.nanmax(stuck_speeds(speed, machine, math.sqrt(share))))
    return fastest if fastest > 1.0 else math.nan


def resonance_speed(machine: Dimensionless, speed: float, share: float = 1.0) -> float:
    """Smallest stuck speed of a share of the balls [theory: exciter, eq. 1]."""
    _require_share(share)
    return float(stuck_speeds(speed, machine, math.sqrt(share))[0])


def shares(balls: int) -> Array:
    """k/N of k = 1 to N balls, shape (N,)."""
    return np.arange(1, balls + 1) / balls


def _require_share(share: float) -> None:
    if not 0.0 < share <= 1.0:
        raise InputError("share", share, "above 0 and at most 1")
