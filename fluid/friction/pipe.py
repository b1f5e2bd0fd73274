"""Friction of steady flow in pipes and channels, from laminar to turbulent: one law for all Reynolds numbers.

The mean flow of a layer that lags behind its drum is such a flow, in a channel as high as the chamber and as
deep as the layer [theory: friction, eq. 1-5].
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array

# Reynolds numbers by the hydraulic diameter at which the laminar flow ends and the turbulent one begins.
LAMINAR_BELOW, TURBULENT_FROM = 2100.0, 4000.0
# Rougher than its own hydraulic diameter no channel is; the law means nothing there.
_ROUGHEST = 1.0
_SMALLEST = 1e-300
# Points over the logarithm of the lag in the integral of the spin-up.
_POINTS = 2001


class Regime(StrEnum):
    """How a steady flow goes, by its Reynolds number."""

    LAMINAR = "laminar"
    TRANSITION = "transition"
    TURBULENT = "turbulent"


def regime(reynolds: float) -> Regime:
    """Laminar below a Reynolds number of 2100, turbulent from 4000 on, transition between."""
    if reynolds < LAMINAR_BELOW:
        return Regime.LAMINAR
    return Regime.TRANSITION if reynolds < TURBULENT_FROM else Regime.TURBULENT


def friction_factor(reynolds: ArrayLike, roughness: ArrayLike = 0.0) -> Array:
    """Darcy's friction factor by Churchill's formula, f_D = 8 tau/(rho u^2) [theory: friction, eq. 2].

    Roughness over D_h, taken as 1 beyond; an infinite Re is a liquid without viscosity.
    """
    re = np.asarray(reynolds, dtype=float)
    rough = np.minimum(np.asarray(roughness, dtype=float), _ROUGHEST)
    # In logarithms: the powers of 12 and 16 leave the range of numbers.
    with np.errstate(divide="ignore"):
        inner = -2.457 * np.log(np.power(7.0 / re, 0.9) + 0.27 * rough)
        first, second = 16.0 * np.log(np.abs(inner)), 16.0 * (math.log(37530.0) - np.log(re))
        laminar = 12.0 * (math.log(8.0) - np.log(re))
    turbulent = -1.5 * np.logaddexp(first, second)
    return np.asarray(8.0 * np.exp(np.logaddexp(laminar, turbulent) / 12.0))


def hydraulic_diameter(depth: ArrayLike, height: ArrayLike) -> Array:
    """Hydraulic diameter 4 h h_c/(h_c + 2 h), m; the free surface is not wetted [theory: friction, eq. 3]."""
    h = np.asarray(depth, dtype=float)
    return np.asarray(4.0 * h / (1.0 + 2.0 * h / np.asarray(height, dtype=float)))


def drag_speed(velocity: ArrayLike, diameter: ArrayLike, viscosity: ArrayLike, roughness: ArrayLike) -> Array:
    """Shear over density and velocity, f_D |u|/8, m/s; 8 nu/D_h in slow flow [theory: friction, eq. 1]."""
    d, nu = np.asarray(diameter, dtype=float), np.asarray(viscosity, dtype=float)
    u = np.maximum(np.abs(np.asarray(velocity, dtype=float)), _SMALLEST)
    with np.errstate(divide="ignore"):
        # A motion too slow for its Reynolds number to be told from 0 is laminar.
        reynolds = np.maximum(u * d / nu, 1e-250)
    return np.asarray(
        np.where(reynolds < 1.0, 8.0 * nu / d, friction_factor(reynolds, np.asarray(roughness) / d) * u / 8.0)
    )


def steady_lag(
    acceleration: float, radius: float, diameter: float, viscosity: float, roughness: float = 0.0
) -> float:
    """Slip speed at which friction gives the liquid the drum's acceleration, m/s; inf without friction.

    dOmega/dt R = (f_D/2) u^2/D_h [theory: friction, eq. 4].
    """
    wanted = acceleration * radius
    if wanted == 0.0:
        return 0.0

    def slow(log: float) -> bool:
        velocity = math.exp(log)
        drag = float(drag_speed(velocity, diameter, viscosity, roughness))
        return 4.0 * drag * velocity < wanted * diameter

    low, high = math.log(1e-60), math.log(1e60)
    if slow(high):
        return math.inf
    return math.exp(bisected(slow, low, high)) if slow(low) else 0.0


def bisected(below: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition that holds at `low` and not at `high` ceases to hold, to rounding."""
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return middle
        low, high = (middle, high) if below(middle) else (low, middle)


def spin_up_time(
    share: ArrayLike, velocity: float, diameter: float, viscosity: float, roughness: float = 0.0
) -> Array:
    """Time in which a lag falls to a share of itself at constant spin, s [theory: friction, eq. 5].

    The integral of du/dt = -(f_D/2) u |u|/D_h; inf without friction, 0 without a lag.
    """
    wanted = np.asarray(share, dtype=float)
    if velocity == 0.0:
        return np.zeros_like(wanted)
    # Over the logarithm of the lag, in equal steps to the smallest share that is asked for.
    down = np.linspace(0.0, -math.log(float(wanted.min())), _POINTS)
    drag = drag_speed(abs(velocity) * np.exp(-down), diameter, viscosity, roughness)
    with np.errstate(divide="ignore"):
        pace = 0.25 * diameter / drag
    if not np.isfinite(pace).all():
        return np.where(wanted < 1.0, np.inf, 0.0)
    time = np.concatenate([[0.0], np.cumsum(0.5 * (pace[1:] + pace[:-1]) * np.diff(down))])
    return np.asarray(np.interp(-np.log(wanted), down, time))
