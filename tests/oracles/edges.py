"""Edges of bands of whirl without any damping, from the zeros of a polynomial: an oracle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from fluid.whirl import Layer, offset_with_friction
from meshes.arrays import Array


def neutral_stiffness(whirl_ratio: ArrayLike, mass: float, liquid: ArrayLike, layer_tanh: ArrayLike) -> Array:
    """Support stiffness over Omega^2 for which an undamped rotor whirls neutrally at a given whirl ratio, kg.

    Y(r) = r^2 [M + sum m_l (1 + d/w)], the layers without friction [theory: whirl, eq. 16].

    Parameters
    ----------
    whirl_ratio : r = omega/Omega, shape (...,), not at a free wave
    mass : M, kg, with all liquid that has no free surface
    liquid, layer_tanh : masses m_l, kg, and T of the layers, shape (n,)
    """
    r = np.asarray(whirl_ratio, dtype=float)
    total = np.full(r.shape, mass)
    for own, t in zip(np.atleast_1d(liquid), np.atleast_1d(layer_tanh), strict=True):
        total = total + own * (1.0 + offset_with_friction(t, 1.0, r, 0.0).real)
    return np.asarray(np.square(r) * total)


def undamped_edges(mass: float, stiffness: float, layers: Sequence[Layer]) -> Array:
    """Speeds at which an undamped rotor with frictionless layers gains or loses a pair of neutral whirls.

    The stiffness that a neutral whirl of ratio r needs is Omega^2 Y(r); where Y has an extremum two whirls
    merge, so that the edges follow from the zeros of a polynomial [theory: whirl, eq. 17].

    Parameters
    ----------
    mass : M with all liquid that has no free surface, kg
    stiffness : K, N/m
    layers : at least one, all different

    Returns
    -------
    Omega, rad/s, rising
    """
    free = [layer for layer in layers if layer.mass > 0.0]
    # In u = r - 1, in which the waves of a thin layer stand apart.
    ratio = Polynomial([1.0, 1.0])
    waves = [Polynomial([-layer.layer_tanh, -2.0 * layer.layer_tanh, 1.0]) for layer in free]
    bottom = _product(waves)
    top = (mass + sum(layer.mass for layer in free)) * bottom
    for k, layer in enumerate(free):
        share = 0.5 * (1.0 - layer.layer_tanh) * layer.mass
        top = top - share * ratio**2 * _product(waves[:k] + waves[k + 1 :])
    # Y = r^2 top/bottom; the zero of Y' at r = 0 belongs to an infinite speed.
    extrema = (2.0 * top + ratio * top.deriv()) * bottom - ratio * top * bottom.deriv()
    roots = extrema.roots()
    real = roots.real[np.abs(roots.imag) <= 1e-9 * np.abs(roots)] + 1.0
    masses, tanh = (np.array([getattr(layer, name) for layer in free]) for name in ("mass", "layer_tanh"))
    needed = neutral_stiffness(real, mass, masses, tanh)
    return np.sort(np.sqrt(stiffness / needed[needed > 0.0]))


def _product(factors: Sequence[Polynomial]) -> Polynomial:
    total = Polynomial([1.0])
    for factor in factors:
        total = total * factor
    return total
