"""Speeds at which the balls of a dual-frequency exciter can stick, and the shaft speeds where they change."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.roots import bracketed_root
from solvers.rotor.exciter.machine import Dimensionless


@dataclass(frozen=True)
class CharacteristicSpeeds:
    """Shaft speeds over the natural frequency where the stuck speeds change [theory: balls, eq. 12-14].

    Parameters
    ----------
    second_pair : n1, from where there are three stuck speeds; nan if there is one at every speed
    through_resonance : n2, where the slowest stuck speed is the natural frequency
    merger : n3, up to where there are three stuck speeds; nan as n1
    """

    second_pair: float
    through_resonance: float
    merger: float


def lag_number(machine: Dimensionless, together: float = 1.0) -> float:
    """chi = A^2 h/b [theory: balls, eq. 9].

    Parameters
    ----------
    machine : its numbers, with some drag
    together : A, length of the mean of the balls' unit vectors, 0 to 1

    Raises
    ------
    InputError : no drag, A outside 0 to 1
    """
    if machine.drag <= 0.0:
        raise InputError("drag", machine.drag, "above 0")
    if not 0.0 <= together <= 1.0:
        raise InputError("together", together, "0 to 1")
    return together**2 * machine.damping / machine.drag


def shaft_speed(stuck: ArrayLike, machine: Dimensionless, together: float = 1.0) -> Array:
    """Shaft speed that keeps balls at a given speed, without iteration [theory: balls, eq. 10].

    Parameters
    ----------
    stuck : Q, shape (...,)
    machine, together : see `lag_number`

    Returns
    -------
    n, shape (...,)
    """
    q = np.asarray(stuck, dtype=float)
    chi, h = lag_number(machine, together), machine.damping
    return np.asarray(q + chi * q**5 / (np.square(1.0 - q**2) + np.square(2.0 * h * q)))


def stuck_speeds(speed: ArrayLike, machine: Dimensionless, together: float = 1.0) -> Array:
    """All speeds at which the balls can stick, roots of the quintic [theory: balls, eq. 11] [YF17, eq. 9].

    Parameters
    ----------
    speed : n of the shaft over the natural frequency, shape (...,), above 0
    machine, together : see `lag_number`; some platform damping

    Returns
    -------
    Q by size, shape (..., 3); nan in the last two where only one is real

    Raises
    ------
    InputError : a speed that is not positive and finite, a machine without drag or damping
    """
    n = np.asarray(speed, dtype=float)
    if not np.all(np.isfinite(n) & (n > 0.0)):
        raise InputError("speed", n.tolist(), "finite numbers above 0")
    if machine.damping <= 0.0:
        raise InputError("damping", machine.damping, "above 0")
    ends = _turning_points(machine, together)
    shafts = n.reshape(-1)
    # The slowest lies below the peak of n(Q), the fastest beyond its trough, one between them; none is faster
    # than the shaft.
    columns = []
    for low, high in pairwise((0.0, *ends, np.inf)):
        bottom, top = np.full(shafts.shape, low), np.minimum(high, shafts)
        root, there = bracketed_root(
            lambda q, which: shaft_speed(q, machine, together) - shafts[which], np.minimum(bottom, top), top
        )
        columns.append(np.where(there & (bottom < top), root, np.nan))
    columns += [np.full(shafts.shape, np.nan)] * (3 - len(columns))
    return np.sort(np.stack(columns, axis=-1), axis=-1).reshape((*n.shape, 3))


def characteristic_speeds(machine: Dimensionless, together: float = 1.0) -> CharacteristicSpeeds:
    """Shaft speeds where the number of stuck speeds changes, to rounding [theory: balls, eq. 12-14].

    Parameters
    ----------
    machine, together : see `lag_number`; some platform damping
    """
    if machine.damping <= 0.0:
        raise InputError("damping", machine.damping, "above 0")
    ends = _turning_points(machine, together)
    through = float(shaft_speed(1.0, machine, together))
    if not ends:
        return CharacteristicSpeeds(math.nan, through, math.nan)
    peak, trough = (float(shaft_speed(q, machine, together)) for q in ends)
    return CharacteristicSpeeds(trough, through, peak)


def _turning_points(machine: Dimensionless, together: float) -> tuple[float, ...]:
    """Q at the peak and at the trough of n(Q), refined; none where n rises all the way."""
    chi, h = lag_number(machine, together), machine.damping
    bell = np.array([1.0, 0.0, 4.0 * h * h - 2.0, 0.0, 1.0])
    # dn/dQ D^2 = D^2 + chi Q^4 (5 D - Q D')
    factor = polynomial.polysub(5.0 * bell, np.concatenate(([0.0], polynomial.polyder(bell))))
    slope = polynomial.polyadd(polynomial.polymul(bell, bell), chi * np.concatenate((np.zeros(4), factor)))
    roots = polynomial.polyroots(slope)
    real = np.sort(roots.real[(np.abs(roots.imag) <= 1e-7 * np.abs(roots)) & (roots.real > 0.0)])
    if real.size < 2:
        return ()
    steeper = polynomial.polyder(slope)
    for _ in range(3):
        real = real - polynomial.polyval(real, slope) / polynomial.polyval(real, steeper)
    return float(real[0]), float(real[-1])
