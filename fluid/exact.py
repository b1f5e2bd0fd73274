"""Exact waves of the Korteweg-de Vries equation on the drum: solitary and cnoidal waves.

All for eta_t + lambda0 eta_theta + alpha eta eta_theta + delta eta_theta_theta_theta = 0
[theory: kdv, eq. 1]; humps where alpha and delta have one sign, as in both families of waves in the layer,
else troughs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.kdv import KdvCoefficients
from meshes.arrays import Array
from meshes.errors import InputError

# Up to this K the complement 1 - m is a number.
_LARGEST_K = 340.0
# Below this 1 - m a cnoidal wave is summed from sech^2 humps, above it taken from scipy's elliptic functions.
_NARROW = 1e-3


@dataclass(frozen=True)
class TravellingWave:
    """A wave of permanent form on the drum."""

    #: H, crest minus trough (level at infinity, for a solitary wave), m^2; negative for a trough
    height: float
    sharpness: float  #: kappa of sech(kappa x) or cn(kappa x), 1/rad
    speed: float  #: V seen from the drum, rad/s
    level: float  #: eta at the foot of the humps, m^2
    crests: int  #: how many there are round the drum
    complement: float  #: 1 - m of the elliptic functions; 0 for a solitary wave

    def profile(self, theta: ArrayLike, time: ArrayLike = 0.0) -> Array:
        """Field eta (m^2) at angles (rad) and times; a crest (or trough) passes theta = 0 at time 0.

        [theory: steppers, eq. 12-13]; narrow crests as a sum over neighbours [theory: steppers, eq. 15]. A
        solitary wave is cut half way round the drum from its crest.
        """
        from scipy.special import ellipj, ellipkm1

        x = np.asarray(theta, dtype=float) - self.speed * np.asarray(time, dtype=float)
        span = 2.0 * math.pi / self.crests
        x = x - span * np.round(x / span)
        m1 = self.complement
        if m1 == 0.0:
            return np.asarray(self.level + self.height * _sech_squared(self.sharpness * x))
        if m1 > _NARROW:
            return np.asarray(self.level + self.height * np.square(ellipj(self.sharpness * x, 1.0 - m1)[1]))
        k, other = float(ellipkm1(m1)), float(ellipkm1(1.0 - m1))
        scale = math.pi / (2.0 * other)
        humps = sum(_sech_squared(scale * self.sharpness * (x + i * span)) for i in range(-3, 4))
        flat = (1.0 - m1) * _mean_square_cn(m1, 1.0 - m1) - scale / k
        return np.asarray(self.level + self.height * (scale**2 * humps + flat) / (1.0 - m1))


def cnoidal_wave(c: KdvCoefficients, height: float, crests: int = 1, mean: float = 0.0) -> TravellingWave:
    """Periodic wave of a height from trough to crest, m^2, on the drum [theory: steppers, eq. 13-14].

    The height has the sign of alpha delta; an `InputError` where the crests would be shocks.
    """
    from scipy.optimize import brentq
    from scipy.special import ellipkm1

    if crests < 1:
        raise InputError("crests", crests, "1 or more")
    target = _sharpness_squared(c, height) * (math.pi / crests) ** 2
    if target > _LARGEST_K**2:
        raise InputError("height", height, f"at most {height * _LARGEST_K**2 / target:g} m^2 in magnitude")

    def excess(y: float) -> float:
        return math.log(_logistic(y) * float(ellipkm1(_logistic(-y))) ** 2 / target)

    # m K^2 lies between m (pi/2)^2 and (K (m = 1/2) + |y|)^2.
    y = brentq(excess, min(0.0, math.log(target)) - 3.0, 2.0 * math.sqrt(target) + 3.0, xtol=1e-14)
    m, m1 = _logistic(y), _logistic(-y)
    sharpness = crests * float(ellipkm1(m1)) / math.pi
    level = mean - height * _mean_square_cn(m1, m)
    speed = c.linear_speed + c.steepening * level + 4.0 * c.dispersion * sharpness**2 * (m - m1)
    return TravellingWave(height, sharpness, speed, level, crests, m1)


def _sharpness_squared(c: KdvCoefficients, height: float) -> float:
    """kappa^2 of crests of height H, alpha H/(12 delta)."""
    if not (math.isfinite(height) and c.steepening * height * c.dispersion > 0.0):
        raise InputError("height", height, "a finite number of the sign of steepening times dispersion")
    return c.steepening * height / (12.0 * c.dispersion)


def _logistic(y: float) -> float:
    """1/(1 + e^{-y}), to rounding on both sides."""
    return 1.0 / (1.0 + math.exp(-y)) if y > 0.0 else math.exp(y) / (1.0 + math.exp(y))


def _sech_squared(x: Array) -> Array:
    decayed = np.exp(-2.0 * np.abs(x))
    return np.asarray(4.0 * decayed / np.square(1.0 + decayed))


def _mean_square_cn(m1: float, m: float) -> float:
    """Mean of cn^2 over a period, (E/K - m1)/m, by the arithmetic-geometric mean, where nothing cancels."""
    a, b, weight, mean = 1.0, math.sqrt(m1), 1.0, 0.5
    half_gap = m / (2.0 * (1.0 + b))
    while half_gap > 1e-17 * a:
        a, b = 0.5 * (a + b), math.sqrt(a * b)
        mean -= weight * half_gap**2 / m
        half_gap, weight = half_gap**2 / (2.0 * (a + b)), 2.0 * weight
    return mean
