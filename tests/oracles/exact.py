"""Exact waves: solitary ones, the shock and sawtooth of the Burgers limit, small ones with linear friction.

Those of Burgers for eta_t + lambda0 eta_theta + alpha eta eta_theta = nu_b eta_theta_theta, nu_b above 0.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from fluid.exact import TravellingWave
from fluid.kdv import KdvCoefficients
from fluid.whirl import offset_with_friction
from meshes.arrays import Array, Complex


def burgers_shock(
    c: KdvCoefficients, viscosity: float, drop: float, theta: ArrayLike, time: ArrayLike
) -> Array:
    """Travelling shock between two levels about a mean of zero [theory: steppers, eq. 16].

    Parameters
    ----------
    c : linear speed and steepening
    viscosity : nu_b, rad^2/s
    drop : level behind minus level ahead, as seen along increasing theta, m^2, of the sign of the steepening
    theta : rad, shape (...,), on an unbounded line
    time : s, shape (...,)
    """
    x = np.asarray(theta, dtype=float) - c.linear_speed * np.asarray(time, dtype=float)
    return np.asarray(-0.5 * drop * np.tanh(c.steepening * drop * x / (4.0 * viscosity)))


def burgers_sawtooth(c: KdvCoefficients, viscosity: float, age: ArrayLike, theta: ArrayLike) -> Array:
    """Decaying shock that runs round the drum, of mean zero [theory: steppers, eq. 17].

    Parameters
    ----------
    c : linear speed and steepening
    viscosity : nu_b, rad^2/s
    age : time since the shock was infinitely high, s, shape (...,), above 0
    theta : rad, shape (...,); the shock is at theta = pi + lambda0 times the age
    """
    old = np.asarray(age, dtype=float)
    x = np.asarray(theta, dtype=float) - c.linear_speed * old
    x = x - 2.0 * math.pi * np.round(x / (2.0 * math.pi))
    # Heat from a source in every turn: those within nine standard deviations count.
    turns = 2 + math.ceil(9.0 * math.sqrt(2.0 * viscosity * float(np.max(old))) / (2.0 * math.pi))
    away = x[..., None] - 2.0 * math.pi * np.arange(-turns, turns + 1)
    exponent = -np.square(away) / (4.0 * viscosity * old[..., None])
    weight = np.exp(exponent - np.max(exponent, axis=-1, keepdims=True))
    mean_distance = np.sum(away * weight, axis=-1) / np.sum(weight, axis=-1)
    return np.asarray(mean_distance / (c.steepening * old))


def solitary_wave(c: KdvCoefficients, height: float, mean_zero: bool = False) -> TravellingWave:
    """Solitary wave on the drum; height, m^2, of the sign of alpha delta [theory: steppers, eq. 12].

    A solution up to its tails, 4 H e^{-2 pi kappa} at the far side, unlike the cnoidal wave. With `mean_zero`
    its level is lowered so that it holds no liquid beyond the mean.
    """
    sharpness = math.sqrt(c.steepening * height / (12.0 * c.dispersion))
    level = -height * math.tanh(math.pi * sharpness) / (math.pi * sharpness) if mean_zero else 0.0
    speed = c.linear_speed + c.steepening * (level + height / 3.0)
    return TravellingWave(height, sharpness, speed, level, 1, 0.0)


def force_with_friction(
    layer_tanh: ArrayLike, spin: ArrayLike, whirl_speed: ArrayLike, rate: ArrayLike
) -> Complex:
    """Force of the layer on its drum over m_f omega^2 w, G = 2 T/(1 + T) (1 + d/w) [theory: whirl, eq. 5]."""
    t = np.asarray(layer_tanh)
    filled = 2.0 * t / (1.0 + t)
    return np.asarray(filled * (1.0 + offset_with_friction(t, spin, whirl_speed, rate)))
