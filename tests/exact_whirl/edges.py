"""The band of self-excited whirl without losses in closed form, and where its edges go as the whirl grows.

A rotor on round supports holds the circle 1/v^2 = 1 + mu G, v = omega_w/omega_n [theory: potential, eq. 34].
Its edges are where two circles meet; G's second order in the whirl says which way they move.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from solvers.wave_error import force_change, layer_tanh, small_force


def crest_detuning(layer: ArrayLike, crests: int) -> Array:
    """p_n^2 of small natural waves of n crests [theory: potential, eq. 15]."""
    ring = np.power(1.0 - np.asarray(layer, dtype=float), 2 * crests)
    share = (1.0 - ring) / (1.0 + ring)
    return np.asarray(share / (crests + share))


def edge_mass_ratio(layer: ArrayLike, detuning: ArrayLike) -> Array:
    """Mass ratio mu at which an edge of the band whirls with this detuning [theory: potential, eq. 35].

    p^2 of the whirl behind the drum: below p_1^2 for the lower edge, above for the upper one. Negative or
    infinite where there is no edge.
    """
    x, t = np.asarray(detuning, dtype=float), layer_tanh(layer)
    slip = np.sqrt(x)
    # r dG/dr, with r = omega_w/Omega = 1/(1 + |p|).
    square = np.square(1.0 - np.asarray(layer, dtype=float))
    steep = -2.0 * slip * (1.0 + slip) * square * t * (1.0 + t) / np.square(t - (1.0 + t) * x)
    with np.errstate(divide="ignore"):
        return np.asarray(-2.0 / (2.0 * small_force(layer, x) + steep))


def edge_speed(layer: ArrayLike, detuning: ArrayLike, mass_ratio: ArrayLike) -> Array:
    """Omega/omega_n of a circle without losses that whirls behind the drum with detuning p^2."""
    slip = np.sqrt(np.asarray(detuning, dtype=float))
    return np.asarray((1.0 + slip) / np.sqrt(1.0 + np.asarray(mass_ratio) * small_force(layer, detuning)))


def edge_shift(layer: ArrayLike, detuning: ArrayLike, mass_ratio: ArrayLike) -> Array:
    """Change of an edge's Omega/omega_n over (W/h_0)^2 [theory: potential, eq. 36]."""
    depth = np.asarray(layer, dtype=float)
    size = np.square(depth / (1.0 - depth))
    below = 1.0 + np.asarray(mass_ratio) * small_force(layer, detuning)
    found = -0.5 * edge_speed(layer, detuning, mass_ratio) / below
    return np.asarray(found * np.asarray(mass_ratio) * force_change(layer, detuning) * size)


def edge_detunings(layer: float, mass_ratio: float) -> tuple[float, float]:
    """p^2 of the whirl at the lower and at the upper edge of the band."""
    from scipy.optimize import brentq

    first = float(crest_detuning(layer, 1))

    def off(slip: float) -> float:
        # 1/mu is smooth where mu is not.
        return 1.0 / float(edge_mass_ratio(layer, slip * slip)) - 1.0 / mass_ratio

    near, far = math.sqrt(first), 1.0
    while off(far) * off(near * (1.0 + 1e-9)) > 0.0:
        far *= 2.0
    lower = brentq(off, 1e-9, near * (1.0 - 1e-9), xtol=1e-15)
    upper = brentq(off, near * (1.0 + 1e-9), far, xtol=1e-15)
    return lower**2, upper**2


def soft_mass_ratio(layer: ArrayLike) -> Array:
    """Mass ratio up to which the lower edge gives way as the whirl grows [theory: potential, eq. 37].

    There the whirl at the edge is as fast as the free wave of two crests; a heavier liquid's edge whirls
    faster.
    """
    return edge_mass_ratio(layer, crest_detuning(layer, 2))
