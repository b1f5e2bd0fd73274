"""Annular long-wave equations of a liquid layer on the wall of a spinning drum, in the drum frame.

Lengths in units of the wall radius R. State: A = (1 - r^2)/2, liquid area per radian, and u, velocity along
the wall relative to the drum. The functions take arrays or scalars, and the finite-volume solver compiles
them as they stand [theory: long_wave].
"""

from __future__ import annotations

from typing import Any

import numpy as np

Real = Any  # an array or, compiled, a number


def free_surface_radius(area: Real) -> Real:
    """r_s = sqrt(1 - 2 A)."""
    return np.sqrt(np.maximum(1.0 - 2.0 * area, 0.0))


def layer_log(area: Real) -> Real:
    """L = ln(1/r_s), the layer's depth in conformal measure."""
    return -0.5 * np.log1p(-2.0 * area)


def static_head(area: Real, surface: Real, spin: float, pull: Real) -> Real:
    """Bernoulli's function at rest, Omega^2 A - r_s f_r, one constant [theory: long_wave, eq. 5]."""
    return spin * spin * area - surface * pull


def surface_at_head(head: Real, spin: float, pull: Real) -> Real:
    """Free-surface radius for a static head, at most the wall's [theory: long_wave, eq. 6]."""
    square = spin * spin
    root = np.sqrt(np.maximum(pull * pull + square * (square - 2.0 * head), 0.0))
    return np.minimum(np.maximum((root - pull) / square, 0.0), 1.0)


def mass_flux(velocity: Real, log: Real) -> Real:
    """u L [theory: long_wave, eq. 1]."""
    return velocity * log


def momentum_flux(velocity: Real, log: Real, area: Real, inverse: Real) -> Real:
    """Flux of relative angular momentum by the flow, u^2 (L + A/r^2)/2, given 1/r^2 [theory: long_wave]."""
    return 0.5 * velocity * velocity * (log + area * inverse)


def pressure_force(area: Real, surface: Real, spin: float, pull: Real) -> Real:
    """Flux of angular momentum by pressure [theory: long_wave, eq. 4].

    Omega^2 A^2/2 + f_r ((1 - r^3)/3 - r A).
    """
    arm = (1.0 - surface) * (1.0 + surface + surface * surface) / 3.0 - surface * area
    return 0.5 * spin * spin * area * area + pull * arm


def wave_celerity(turning: Real, log: Real, spin: float) -> tuple[Real, Real]:
    """Mean and half difference of the two characteristic speeds, of u/r^2 [theory: long_wave, eq. 3].

    lambda = u/r^2 + Omega L +- sqrt(Omega^2 L^2 + L W^2), W = Omega + u/r^2.
    """
    carried = spin * log
    whole = spin + turning
    return turning + carried, np.sqrt(carried * carried + log * whole * whole)


# Last share of the gap over which its waves grow as fast as those of a full one.
CLOSING = 0.02


def slot_stiffness(area: Real, full: float, slot: float) -> Real:
    """Rise of the head with the area for the speed of waves, in a gap that fills [theory: long_wave, eq. 18].

    It sets in by degrees: speeds that jumped would let the fluxes jump with the rotor's acceleration.
    """
    begun = (area / full - 1.0) / CLOSING + 1.0
    return slot * np.minimum(np.maximum(begun, 0.0), 1.0)


def wall_pressure(velocity: Real, log: Real, area: Real, surface: Real, spin: float, pull: Real) -> Real:
    """Pressure on the wall over the density [theory: long_wave, eq. 7]."""
    lift = 1.0 / (surface * surface) - 1.0
    return (
        spin * spin * area
        + 2.0 * spin * log * velocity
        + 0.5 * velocity * velocity * lift
        + pull * (1.0 - surface)
    )


def bernoulli(velocity: Real, log: Real, area: Real, surface: Real, spin: float, pull: Real) -> Real:
    """Bernoulli's function at the free surface [theory: long_wave, eq. 2]."""
    turning = velocity / surface
    return 0.5 * turning * turning + spin * spin * area + 2.0 * spin * log * velocity - surface * pull


# tanh(x)/x is (15 + x^2)/(15 + 6 x^2) to 3e-4 up to x = 1 and 4 % at x = 3 [theory: long_wave, eq. 12].
PADE = (15.0, 6.0, 5.0)
