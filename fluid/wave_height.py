"""What the height of a wave does to the force of the layer, and how far each model of the layer is off.

Weakly nonlinear theory in closed form: the force on a whirling drum to second order in the whirl, by the
exact equations, by long waves and by one family [theory: wave_errors]. All is a function of
T = tanh(L) = (R^2 - a^2)/(R^2 + a^2), of p^2 = (1 - Omega/omega_w)^2 and of w_0/a; R = 1.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array

# Share of nonlinearity at the fold: where waves do not disperse and where they do; how one becomes the other.
FOLD_PLAIN, FOLD_DISPERSED = 0.052, 4.0 / 27.0


def resonance(tanh: ArrayLike) -> Array:
    """p_1^2 = T/(1 + T) of small free waves of one crest [theory: potential, eq. 15].

    Parameters
    ----------
    tanh : T, shape (...,)
    """
    t = np.asarray(tanh, dtype=float)
    return np.asarray(t / (1.0 + t))


def force(tanh: ArrayLike, detuning: ArrayLike) -> Array:
    """G of a whirl of vanishing size, T (1 - 2 p^2)/(T - (1 + T) p^2) [theory: wave_errors, eq. 7].

    Parameters
    ----------
    tanh, detuning : T and p^2, shape (...,)
    """
    t, x = np.asarray(tanh, dtype=float), np.asarray(detuning, dtype=float)
    return np.asarray(t * (1.0 - 2.0 * x) / (t - (1.0 + t) * x))


def force_change(tanh: ArrayLike, detuning: ArrayLike) -> Array:
    """What the height of the wave adds to G, over (w_0/a)^2, by the exact equations [theory: wave_errors, eq. 8].

    Parameters
    ----------
    tanh, detuning : T and p^2, shape (...,)
    """
    t, x = np.asarray(tanh, dtype=float), np.asarray(detuning, dtype=float)
    first, second = (1.0 + t) * x - t, (1.0 + t + t * t) * x - t
    above = x * (8.0 * t**3 - 21.0 * t * t + 14.0 * t - 5.0) - 4.0 * t * (1.0 - t) ** 2
    return np.asarray(t * x * (1.0 - t * t) * above / (8.0 * first**4 * second))


def layer_tanh(layer: ArrayLike) -> Array:
    """T = tanh(L) of a layer.

    Parameters
    ----------
    layer : h_0/R, shape (...,)
    """
    square = np.square(1.0 - np.asarray(layer, dtype=float))
    return np.asarray((1.0 - square) / (1.0 + square))
