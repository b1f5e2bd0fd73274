"""KdV-Burgers and Whitham waves of one family, split for exponential steppers."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fluid.kdv import KdvCoefficients, wave_frequency
from meshes.arrays import Complex
from meshes.errors import InputError, require_not_negative
from solvers.waves.stepper import Split, squared


@dataclass(frozen=True)
class WaveTerms:
    """What acts on the waves of one family [theory: kdv, eq. 1].

    Parameters
    ----------
    c : speed, steepening, dispersion
    whitham : exact dispersion [theory: kdv, eq. 10] instead of the third derivative
    viscosity : nu_b, rad^2/s, 0 or above
    damping : gamma, 1/s, 0 or above
    forcing : q, m^2/s, from `fluid.kdv.forcing`
    whirl_speed : s, seen from the drum, rad/s
    """

    c: KdvCoefficients
    whitham: bool = False
    viscosity: float = 0.0
    damping: float = 0.0
    forcing: float = 0.0
    whirl_speed: float = 0.0

    def __post_init__(self) -> None:
        require_not_negative("viscosity", self.viscosity)
        require_not_negative("damping", self.damping)
        for field, value in (("forcing", self.forcing), ("whirl_speed", self.whirl_speed)):
            if not math.isfinite(value):
                raise InputError(field, value, "a finite number")


def wave_split(terms: WaveTerms, points: int, first_angle: float = 0.0) -> Split:
    """Linear symbol, and steepening with forcing as the rest [theory: steppers, eq. 1].

    Followed in the frame of the whirl or, without forcing, of long waves.

    Parameters
    ----------
    terms : the equation
    points : evenly spaced round the drum, 8 or more; an even number with small factors is fastest
    first_angle : theta of the first point, rad

    Returns
    -------
    Split for fields eta in m^2; free of aliases, without the mode of half the points

    Raises
    ------
    InputError : fewer than 8 points
    """
    if points < 8:
        raise InputError("points", points, "8 or more")
    n = np.arange(points // 2 + 1)
    omega = wave_frequency(n, terms.c, terms.whitham)
    symbol = np.asarray(-1j * omega - terms.viscosity * np.square(n) - terms.damping, dtype=complex)
    steepen = -0.5j * terms.c.steepening * n
    # -q sin(theta - s t) = Re(i q e^{i (theta - s t)}), as scaled by the transform.
    push = 0.5j * terms.forcing * points * np.exp(1j * first_angle)

    def nonlinear(spectrum: Complex, t: float) -> Complex:
        rate = steepen * squared(spectrum, points)
        rate[1] += push * np.exp(-1j * terms.whirl_speed * t)
        return np.asarray(rate)

    frame = terms.whirl_speed if terms.forcing else terms.c.linear_speed
    return Split(symbol, nonlinear, frame)
