"""Exact linear theory of the layer on the wall of a spinning drum: plane, inviscid flow.

Sign convention: the free surface lies at r_s = a + xi(theta); a positive displacement xi is a thinner layer.
Angles and frequencies are seen from the drum, positive with the spin. Ratios are to the whirl radius and
real: the layer moves along the deflection or against it. `curvature` is kappa = (R/a)^2, above 1;
`whirl_ratio` is q, whirl speed over spin speed; D = (1 - kappa) q^2 + 2 kappa (q - 1)^2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError


def free_wave_frequencies(mode: ArrayLike, layer_log: ArrayLike, spin: ArrayLike) -> tuple[Array, Array]:
    """Frequencies of the prograde and retrograde natural waves of n crests, seen from the drum, rad/s.

    sigma = Omega [T +- sqrt(T^2 + n T)], T = tanh(n L) [theory: waves, eq. 7]; L = ln(R/a) is inf for a full
    drum.

    >>> prograde, retrograde = free_wave_frequencies(1, 0.10536, 40.0)
    >>> print(f"{prograde:.2f} {retrograde:.2f}")
    17.82 -9.42
    """
    n, log, omega = (np.asarray(x, dtype=float) for x in (mode, layer_log, spin))
    _require(bool(np.all(n >= 1.0)), "mode", mode, "1 or above")
    _require(bool(np.all(log > 0.0)), "layer_log", layer_log, "above 0")
    t = np.tanh(n * log)
    root = np.sqrt(t * (t + n))
    # t - root without its cancellation in thick layers and high modes.
    return np.asarray(omega * (t + root)), np.asarray(-omega * (n * t) / (t + root))


def free_wave_speeds(mode: ArrayLike, layer_log: ArrayLike, spin: ArrayLike) -> tuple[Array, Array]:
    """Angular speeds at which the crests of both natural waves run around the drum, relative to it, rad/s.

    sigma/n [theory: waves, eq. 7]; in a thin layer the same for every mode.
    """
    prograde, retrograde = free_wave_frequencies(mode, layer_log, spin)
    n = np.asarray(mode, dtype=float)
    return np.asarray(prograde / n), np.asarray(retrograde / n)


# Waves along a sector; twice as many change the slowest by 1e-4 of it.
_ACROSS = 16


def sector_frequencies(sectors: int, layer_log: float) -> Array:
    """Frequencies of the natural waves between radial walls through the surface, over the spin, rising.

    Of one of so many sectors, from the drum, shape (n,) [theory: waves, eq. 16-18]; L = ln(R/a), above 0.

    >>> print(f"{sector_frequencies(4, 0.34657)[0]:.3f}")
    0.950
    """
    _require(sectors >= 1, "sectors", sectors, "1 or above")
    _require(layer_log > 0.0, "layer_log", layer_log, "above 0")
    j = np.arange(1, _ACROSS + 1)
    order = 0.5 * sectors * j
    t = np.tanh(order * layer_log)
    apart = j[:, None] + j[None, :]
    shared = 4.0 / np.pi * j[None, :] / np.where(apart % 2 == 1, (j[None, :] - j[:, None]) * apart, np.inf)
    # w^2 a = -2 i w C T a + m T a as a pencil of first order.
    both = np.zeros((2 * _ACROSS, 2 * _ACROSS), dtype=complex)
    both[:_ACROSS, :_ACROSS] = -2j * shared * t
    both[:_ACROSS, _ACROSS:] = np.diag(order * t)
    both[_ACROSS:, :_ACROSS] = np.eye(_ACROSS)
    frequency = np.linalg.eigvals(both).real
    return np.asarray(np.sort(frequency[frequency > 0.0]))


def force_ratio(curvature: ArrayLike, whirl_ratio: ArrayLike) -> Array:
    """Force of a liquid layer on its whirling drum, over that of a full drum [theory: waves, eq. 5].

    G = 1 - 2 (q - 1)^2/D: 1 for synchronous whirl, infinite at the natural sloshing wave.
    """
    kappa, q = _checked(curvature, whirl_ratio)
    return np.asarray(1.0 - _over_resonance(2.0 * np.square(q - 1.0), kappa, q))


def offset_ratio(curvature: ArrayLike, whirl_ratio: ArrayLike) -> Array:
    """Offset of the liquid's centre of mass over the whirl radius [theory: waves, eq. 6].

    -q^2/D, along the deflection: 1/(kappa - 1) for synchronous whirl, infinite at the natural sloshing wave.
    """
    kappa, q = _checked(curvature, whirl_ratio)
    return np.asarray(-_over_resonance(np.square(q), kappa, q))


def displacement_ratio(curvature: ArrayLike, whirl_ratio: ArrayLike) -> Array:
    """Displacement of the free surface along the deflection, over the whirl radius [theory: waves, eq. 4].

    xi/w0 = (kappa - 1) q^2/D, positive where the layer is thinner on the side of the deflection: -1 for
    synchronous whirl, infinite at the natural sloshing wave.
    """
    kappa, q = _checked(curvature, whirl_ratio)
    return np.asarray(_over_resonance((kappa - 1.0) * np.square(q), kappa, q))


def gravity_offset(curvature: ArrayLike, spin: ArrayLike, gravity: ArrayLike) -> Array:
    """Offset along gravity of the liquid's centre of mass in a horizontal drum, m [theory: waves, eq. 10].

    -g/(2 kappa Omega^2): it lies above the axis. The force on the drum is the liquid's weight.
    """
    kappa, omega = _checked(curvature, spin)
    _require(bool(np.all(omega != 0.0)), "spin", spin, "other than 0")
    return np.asarray(-np.asarray(gravity, dtype=float) / (2.0 * kappa * np.square(omega)))


def gravity_displacement(curvature: ArrayLike, spin: ArrayLike, gravity: ArrayLike) -> Array:
    """Displacement of the free surface at the lowest point of a horizontal drum, m [theory: waves, eq. 9].

    xi = (kappa - 1) g/(2 kappa Omega^2): the layer is thinner at the bottom.
    """
    kappa = np.asarray(curvature, dtype=float)
    return np.asarray(-(kappa - 1.0) * gravity_offset(kappa, spin, gravity))


def wall_swing(curvature: ArrayLike, spin: ArrayLike, gravity: ArrayLike) -> Array:
    """Velocity with which gravity swings the liquid to and fro along the wall once a turn, m/s.

    U = g/(kappa Omega), seen from a horizontal drum [theory: waves, eq. 13].
    """
    kappa, omega = _checked(curvature, spin)
    _require(bool(np.all(omega != 0.0)), "spin", spin, "other than 0")
    return np.asarray(np.asarray(gravity, dtype=float) / (kappa * omega))


def wall_drift(radius: ArrayLike, curvature: ArrayLike, spin: ArrayLike, gravity: ArrayLike) -> Array:
    """Mean speed of the liquid at the edge of the wall's layer that gravity's swing makes, rad/s.

    -(3/4) U^2/(Omega R^2) seen from the drum, whatever the viscosity: a lag [theory: waves, eq. 15].

    >>> print(f"{wall_drift(0.05, 1.0 / 0.7, 40.0, 9.81):.3f}")
    -0.221
    """
    omega = np.asarray(spin, dtype=float)
    swing = wall_swing(curvature, omega, gravity) / np.asarray(radius, dtype=float)
    return np.asarray(-0.75 * np.square(swing) / omega)


def capture_speed(free_surface_radius: ArrayLike, gravity: ArrayLike) -> Array:
    """Centrifuging speed of a horizontal drum, rad/s: above it the liquid is a closed layer, Omega^2 a > g.

    The linear displacement of the surface is then smaller than the mean depth for every fill: that second
    condition of a closed layer never decides [theory: waves, eq. 11-12].

    >>> print(f"{capture_speed(0.135, 9.81):.3f}")
    8.524
    """
    a, g = np.asarray(free_surface_radius, dtype=float), np.asarray(gravity, dtype=float)
    _require(bool(np.all(a > 0.0)), "free_surface_radius", free_surface_radius, "above 0")
    _require(bool(np.all(g >= 0.0)), "gravity", gravity, "0 or above")
    return np.asarray(np.sqrt(g / a))


def _require(holds: bool, field: str, value: object, allowed: str) -> None:
    if not holds:
        raise InputError(field, value, allowed)


def _checked(curvature: ArrayLike, other: ArrayLike) -> tuple[Array, Array]:
    kappa = np.asarray(curvature, dtype=float)
    _require(bool(np.all(kappa > 1.0)), "curvature", curvature, "above 1")
    return kappa, np.asarray(other, dtype=float)


def _over_resonance(numerator: Array, kappa: Array, q: Array) -> Array:
    """Quotient by D = (1 - kappa) q^2 + 2 kappa (q - 1)^2; infinite where D vanishes."""
    d = (1.0 - kappa) * np.square(q) + 2.0 * kappa * np.square(q - 1.0)
    numerator, d = np.broadcast_arrays(numerator, d)
    out = np.full(d.shape, np.inf)
    np.divide(numerator, d, out=out, where=d != 0.0)
    return out
