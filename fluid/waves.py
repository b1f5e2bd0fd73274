"""Exact linear theory of the layer on the wall of a spinning drum: plane, inviscid flow.

Sign convention: the free surface lies at r_s = a + xi(theta); a positive displacement xi is a thinner layer.
Angles and frequencies are seen from the drum, positive with the spin. Ratios are to the whirl's amplitude and
real: the layer moves along the deflection or against it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError


def free_wave_frequencies(mode: ArrayLike, layer_log: ArrayLike, spin: ArrayLike) -> tuple[Array, Array]:
    """Frequencies of the layer's free waves, seen from the drum.

    sigma = Omega [T +- sqrt(T^2 + n T)], T = tanh(n L) [theory: waves, eq. 7].

    Parameters
    ----------
    mode : number n of crests around the drum, shape (...,), at least 1
    layer_log : L = ln(wall radius / mean free-surface radius), shape (...,), above 0; inf for a full drum
    spin : spin speed Omega, rad/s, shape (...,)

    Returns
    -------
    sigma of the prograde wave (0 or above) and of the retrograde wave (0 or below), rad/s, shape (...,)

    Raises
    ------
    InputError : a mode below 1, a layer_log that is not positive

    Examples
    --------
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
    """Angular speeds at which the crests of the layer's free waves run around the drum.

    sigma/n [theory: waves, eq. 7]; in a thin layer the same for every mode.

    Parameters
    ----------
    mode, layer_log, spin : as in `free_wave_frequencies`

    Returns
    -------
    Prograde (0 or above) and retrograde (0 or below) speed relative to the drum, rad/s, shape (...,)

    Raises
    ------
    InputError : a mode below 1, a layer_log that is not positive
    """
    prograde, retrograde = free_wave_frequencies(mode, layer_log, spin)
    n = np.asarray(mode, dtype=float)
    return np.asarray(prograde / n), np.asarray(retrograde / n)


def force_ratio(curvature: ArrayLike, whirl_ratio: ArrayLike) -> Array:
    """Force of a liquid layer on its whirling drum, over that of a full drum.

    G = 1 - 2 (q - 1)^2/D, D = (1 - kappa) q^2 + 2 kappa (q - 1)^2 [theory: waves, eq. 5].

    Parameters
    ----------
    curvature : (wall radius / mean free-surface radius)^2, kappa, shape (...,), above 1
    whirl_ratio : q = whirl speed / spin speed, shape (...,)

    Returns
    -------
    G, shape (...,); 1 for synchronous whirl, infinite at the free wave

    Raises
    ------
    InputError : a curvature of 1 or less

    Examples
    --------
    >>> float(force_ratio(1.2, 1.0))
    1.0
    """
    kappa, q = _checked(curvature, whirl_ratio)
    return np.asarray(1.0 - _over_resonance(2.0 * np.square(q - 1.0), kappa, q))


def offset_ratio(curvature: ArrayLike, whirl_ratio: ArrayLike) -> Array:
    """Offset of the liquid's centre of mass from the drum's geometric axis, over the whirl's amplitude.

    -q^2/D, along the deflection [theory: waves, eq. 6].

    Parameters
    ----------
    curvature, whirl_ratio : as in `force_ratio`

    Returns
    -------
    Offset/w0, shape (...,); 1/(kappa - 1) for synchronous whirl, infinite at the free wave

    Raises
    ------
    InputError : a curvature of 1 or less
    """
    kappa, q = _checked(curvature, whirl_ratio)
    return np.asarray(-_over_resonance(np.square(q), kappa, q))


def displacement_ratio(curvature: ArrayLike, whirl_ratio: ArrayLike) -> Array:
    """Displacement of the free surface along the deflection, over the whirl's amplitude.

    xi/w0 = (kappa - 1) q^2/D; positive where the layer is thinner on the side of the deflection
    [theory: waves, eq. 4].

    Parameters
    ----------
    curvature, whirl_ratio : as in `force_ratio`

    Returns
    -------
    xi/w0, shape (...,); -1 for synchronous whirl, infinite at the free wave

    Raises
    ------
    InputError : a curvature of 1 or less
    """
    kappa, q = _checked(curvature, whirl_ratio)
    return np.asarray(_over_resonance((kappa - 1.0) * np.square(q), kappa, q))


def gravity_offset(curvature: ArrayLike, spin: ArrayLike, gravity: ArrayLike) -> Array:
    """Offset of the liquid's centre of mass in a drum that spins about a horizontal axis.

    -g/(2 kappa Omega^2) along gravity, so the liquid's centre of mass lies above the axis
    [theory: waves, eq. 10]. The force on the drum is the liquid's weight.

    Parameters
    ----------
    curvature : kappa, shape (...,), above 1
    spin : spin speed Omega, rad/s, shape (...,), not 0
    gravity : acceleration across the axis g, m/s^2, shape (...,)

    Returns
    -------
    Offset from the geometric axis, m, positive along gravity, shape (...,)

    Raises
    ------
    InputError : a curvature of 1 or less, a spin speed of 0
    """
    kappa, omega = _checked(curvature, spin)
    _require(bool(np.all(omega != 0.0)), "spin", spin, "other than 0")
    return np.asarray(-np.asarray(gravity, dtype=float) / (2.0 * kappa * np.square(omega)))


def gravity_displacement(curvature: ArrayLike, spin: ArrayLike, gravity: ArrayLike) -> Array:
    """Displacement of the free surface in a drum that spins about a horizontal axis.

    (kappa - 1) g/(2 kappa Omega^2) along gravity: the layer is thinner at the bottom [theory: waves, eq. 9].

    Parameters
    ----------
    curvature, spin, gravity : as in `gravity_offset`

    Returns
    -------
    xi at the lowest point, m, positive where the layer is thinner, shape (...,)

    Raises
    ------
    InputError : a curvature of 1 or less, a spin speed of 0
    """
    kappa = np.asarray(curvature, dtype=float)
    return np.asarray(-(kappa - 1.0) * gravity_offset(kappa, spin, gravity))


def capture_speed(free_surface_radius: ArrayLike, gravity: ArrayLike) -> Array:
    """Spin speed above which a horizontal drum carries the liquid round as a closed layer.

    Centrifugal acceleration at the mean free surface above gravity, Omega^2 a > g. The linear displacement of
    the surface is then smaller than the mean depth for every fill, so that this second condition of a closed
    layer never decides [theory: waves, eq. 11-12].

    Parameters
    ----------
    free_surface_radius : mean radius a of the free surface, m, shape (...,), above 0
    gravity : acceleration across the axis g, m/s^2, shape (...,), 0 or above

    Returns
    -------
    Omega, rad/s, shape (...,)

    Raises
    ------
    InputError : a free-surface radius that is not positive, a negative gravity

    Examples
    --------
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
