"""Unidirectional long waves in the layer: coefficients of the KdV-Burgers and Whitham equations.

    eta_t + lambda0 eta_theta + alpha eta eta_theta + delta eta_theta_theta_theta
        = nu_b eta_theta_theta - gamma eta - q sin(theta - s t)          [theory: kdv, eq. 1]

eta = A - A0 is the liquid area per radian above its mean, m^2 (positive: a thicker layer). theta and the
whirl speed s are seen from the drum, positive with the spin; the deflection lies at theta = s t. These signs
live here alone: a natural sloshing wave is eta ~ exp(i n theta - i omega t).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fluid.friction.laws import Friction, FrictionLaw
from fluid.waves import free_wave_frequencies
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_positive

FRONT = 0.2  # no law sets it: width of a front over the layer's depth, of the highest bore


def refuse_quadratic(friction: Friction, field: str) -> None:
    """InputError for friction that has no rate, by which these waves are damped; `field` it was given in."""
    if friction.law is FrictionLaw.QUADRATIC:
        raise InputError(field, "quadratic", "none, linear, stokes or wall for unidirectional waves")


@dataclass(frozen=True)
class KdvCoefficients:
    """Unidirectional waves on a layer at one spin speed."""

    family: int  #: +1 prograde, -1 retrograde
    linear_speed: float  #: lambda0, angular speed of long waves of vanishing height, rad/s
    steepening: float  #: alpha, how much faster a thicker layer carries them, rad/(s m^2)
    dispersion: float  #: delta, by how much a wave with n crests lags, times n^2, rad/s
    coupling: float  #: q over the acceleration of the axis, m
    radius: float  #: wall and mean free surface, m
    surface_radius: float
    spin: float  #: Omega, rad/s

    @property
    def layer_log(self) -> float:
        """Depth of the layer in conformal measure, L = ln(R/a)."""
        return math.log(self.radius / self.surface_radius)

    @property
    def mean_area(self) -> float:
        """Liquid area per radian of the layer at rest, A0 = (R^2 - a^2)/2, m^2."""
        return 0.5 * (self.radius - self.surface_radius) * (self.radius + self.surface_radius)

    @property
    def other_speed(self) -> float:
        """Speed of long waves of the family that is left out, rad/s."""
        return 2.0 * self.spin * self.layer_log - self.linear_speed


def coefficients(radius: float, surface_radius: float, spin: float, family: int) -> KdvCoefficients:
    """Coefficients of a family of waves, +1 prograde, -1 retrograde [theory: kdv, eq. 5, 8, 9, 11].

    From the annular long-wave equations and the exact dispersion.
    """
    require_positive("radius", radius)
    require_positive("surface_radius", surface_radius)
    require_positive("spin", spin)
    if surface_radius >= radius:
        raise InputError("surface_radius", surface_radius, f"below radius ({radius:g} m)")
    if family not in (1, -1):
        raise InputError("family", family, "+1 (prograde) or -1 (retrograde)")
    log = math.log(radius / surface_radius)
    root = math.sqrt(log * (log + 1.0))
    swing = (2.0 * log + 1.0) / (2.0 * root)
    # 1 - swing and L - root without their cancellation in thick layers; swing^2 - 1 = 1/(2 root)^2.
    share = 1.0 + swing if family == 1 else -1.0 / (4.0 * root**2 * (1.0 + swing))
    speed = log + root if family == 1 else -log / (log + root)
    return KdvCoefficients(
        family=family,
        linear_speed=spin * speed,
        steepening=3.0 * spin / surface_radius**2 * share,
        dispersion=spin * log**3 / 3.0 * share,
        coupling=family * log * surface_radius / (2.0 * spin * root),
        radius=radius,
        surface_radius=surface_radius,
        spin=spin,
    )


def forcing(c: KdvCoefficients, acceleration: ArrayLike) -> Array:
    """Strength q with which the whirling axis forces the waves of the family, m^2/s [theory: kdv, eq. 11].

    q = +-L a F/(2 S), F = omega_w^2 w0 the axis' acceleration; positive for the prograde family.
    """
    return np.asarray(c.coupling * np.asarray(acceleration, dtype=float))


def decay(c: KdvCoefficients, friction_rate: ArrayLike) -> Array:
    """Decay rate of the family under a friction -k u per mass, k |lambda0|/(2 S) [theory: kdv, eq. 12]."""
    k = np.asarray(friction_rate, dtype=float)
    if not bool(np.all(np.isfinite(k) & (k >= 0.0))):
        raise InputError("friction_rate", friction_rate, "a finite number, 0 or above")
    return np.asarray(k * abs(c.linear_speed) / abs(c.linear_speed - c.other_speed))


def diffusion(c: KdvCoefficients, forcing: ArrayLike, front: float = FRONT) -> Array:
    """Diffusion nu_b that makes a front so wide beside the layer's depth, rad^2/s [theory: kdv, eq. 39].

    nu_b = front h0/R sqrt(|alpha q|), of a bore at resonance, whose front is the highest.
    """
    strength = np.sqrt(np.abs(c.steepening * np.asarray(forcing, dtype=float)))
    return np.asarray(front * (1.0 - c.surface_radius / c.radius) * strength)


def wave_frequency(mode: ArrayLike, c: KdvCoefficients, whitham: bool) -> Array:
    """Frequency omega(n) of a natural wave eta ~ exp(i n theta - i omega t) of vanishing height, odd in n.

    KdV: n lambda0 - delta n^3 [theory: kdv, eq. 10]; Whitham: the exact sigma(n) [theory: waves, eq. 7].
    """
    n = np.asarray(mode, dtype=float)
    if not whitham:
        return np.asarray(n * (c.linear_speed - c.dispersion * np.square(n)))
    crests = np.where(n == 0.0, 1.0, np.abs(n))
    prograde, retrograde = free_wave_frequencies(crests, c.layer_log, c.spin)
    return np.asarray(np.sign(n) * (prograde if c.family == 1 else retrograde))


def offset(c: KdvCoefficients, profile: ArrayLike) -> Complex:
    """Offset of the liquid's centre of mass from the drum's axis for a wave, m [theory: kdv, eq. 15].

    a/(2 pi A0) times the integral of eta e^{i xi}, eta at equal steps of xi = theta - s t, shape (...,
    points); the imaginary part lies 90 deg ahead of the deflection. What it leaves out is smaller than the
    terms kept by eta/a^2, while eta itself is known to a part eta/A0.
    """
    eta = np.asarray(profile, dtype=float)
    angle = 2.0 * np.pi * np.arange(eta.shape[-1]) / eta.shape[-1]
    first = np.mean(eta * np.exp(1j * angle), axis=-1)
    return np.asarray(c.surface_radius / c.mean_area * first)


def force_ratio(c: KdvCoefficients, liquid_offset: ArrayLike, whirl_amplitude: ArrayLike) -> Complex:
    """Force of a steady wave on the drum, over that of a full drum m_f omega_w^2 w0.

    G = (1 - 1/kappa)(1 + d/w0): the liquid's momentum [theory: kdv, eq. 16], exact for the offset given.
    """
    w = np.asarray(whirl_amplitude, dtype=float)
    if not bool(np.all(np.isfinite(w) & (w > 0.0))):
        raise InputError("whirl_amplitude", whirl_amplitude, "a finite number above 0")
    liquid_share = 2.0 * c.mean_area / c.radius**2
    return np.asarray(liquid_share * (1.0 + np.asarray(liquid_offset, dtype=complex) / w))


@dataclass(frozen=True)
class Validity:
    """What decides whether weakly nonlinear unidirectional waves suffice; shapes (...,)."""

    amplitude: Array  #: largest |eta|/A0; the coefficients are right to that order
    #: smallest depth of the layer, as area over A0; 0 or below is a dry patch that the model ignores
    thinnest: Array
    detuning: Array  #: |s - lambda0| over the distance of the two families
    #: linear response of the other family over that of this one, |s - lambda0|/|s - lambda_other|
    neglected: Array


def validity(c: KdvCoefficients, profile: ArrayLike, whirl_speed: ArrayLike) -> Validity:
    """Size of what the one-family wave leaves out [theory: kdv, eq. 17]."""
    eta, s = np.asarray(profile, dtype=float), np.asarray(whirl_speed, dtype=float)
    gap = np.abs(s - c.linear_speed)
    other = np.abs(s - c.other_speed)
    return Validity(
        amplitude=np.max(np.abs(eta), axis=-1) / c.mean_area,
        thinnest=1.0 + np.min(eta, axis=-1) / c.mean_area,
        detuning=np.asarray(gap / abs(c.linear_speed - c.other_speed)),
        neglected=np.divide(gap, other, out=np.full(s.shape, np.inf), where=other != 0.0),
    )
