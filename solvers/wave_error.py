"""What the height of a wave does to the force of a layer, and how far each model of the layer is off.

Analytical weakly nonlinear theory, to second order in the whirl: by the exact equations, by long waves and
by unidirectional waves. Their differences are the errors of the models; a growth with the height, fitted to
nonlinear waves, does for the higher orders [theory: model_error, eq. 24-36]. `layer` is h_0/R, `detuning`
p^2 = (1 - Omega/omega_w)^2, `whirl` w_0/h_0, shapes (...,); errors are over the larger of |G| and 1, nan
where there is no smooth wave.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from fluid import kdv
from meshes.arrays import Array

# Nonlinearity at the fold of waves that hardly disperse, its growth with the detuning, and how dispersion
# raises it: to 4/27 of a spring with a cubic term. Fitted to folds of fully nonlinear waves.
_FOLD, _FOLD_GROWTH, _DISPERSED, _DISPERSED_POWER = 0.0456, 1.10, 0.584, 0.616
_CUBIC_SPRING = 4.0 / 27.0
# Whirl at which a thin layer chokes over (1 - p/p_1)^2.
_CHOKES = math.pi**2 / 12.0
# What higher orders add: to all in the nonlinearity, to waves that may choke, to Serre's, to one family;
# slack.
_GROWTH, _CHOKED, _SERRE, _FAMILY, _SLACK = 15.0, 8.0, 4.5, 5.0, 1.03
# Of waves through time on so many cells: the share by which tanh(L) is off for them, and what they take away
# of what the height adds; less where waves disperse, whose faces are of third order.
_CELLS, _CELLS_DISPERSED, _AT_CELLS = (1.3e-3, 0.2), (1e-3, 0.11), 128.0
# An estimate above this is none.
_MOST = 100.0
# At a resonance infinite forces are less one another: no number, and so no estimate.
_AT_RESONANCE = np.errstate(invalid="ignore")


def layer_tanh(layer: ArrayLike) -> Array:
    """T = tanh(L) = (R^2 - a^2)/(R^2 + a^2) of a layer."""
    square = np.square(1.0 - np.asarray(layer, dtype=float))
    return np.asarray((1.0 - square) / (1.0 + square))


def detuning_ratio(layer: ArrayLike, detuning: ArrayLike) -> Array:
    """p/p_1 to small natural sloshing waves of one crest [theory: potential, eq. 15]."""
    t = layer_tanh(layer)
    return np.asarray(np.sqrt(np.asarray(detuning, dtype=float) * (1.0 + t) / t))


def small_force(layer: ArrayLike, detuning: ArrayLike, dispersion: ArrayLike | None = None) -> Array:
    """G of a vanishing whirl; `dispersion` for tanh(L), None: the exact one [theory: model_error, eq. 28]."""
    square = np.square(1.0 - np.asarray(layer, dtype=float))
    t = layer_tanh(layer) if dispersion is None else np.asarray(dispersion)
    x = np.asarray(detuning, dtype=float)
    below = t - (1.0 + t) * x
    return np.asarray(1.0 - square + square * _quotient(t, below))


def force_change(layer: ArrayLike, detuning: ArrayLike) -> Array:
    """What the height adds to G, over (w_0/a)^2, by the exact equations [theory: model_error, eq. 29]."""
    t, x = layer_tanh(layer), np.asarray(detuning, dtype=float)
    first, second = (1.0 + t) * x - t, (1.0 + t + t * t) * x - t
    above = x * (8.0 * t**3 - 21.0 * t * t + 14.0 * t - 5.0) - 4.0 * t * (1.0 - t) ** 2
    return np.asarray(_quotient(t * x * (1.0 - t * t) * above, 8.0 * first**4 * second))


def long_wave_change(layer: ArrayLike, detuning: ArrayLike) -> Array:
    """`force_change` by long waves without dispersion [theory: model_error, eq. 30]."""
    surface, x = 1.0 - np.asarray(layer, dtype=float), np.asarray(detuning, dtype=float)
    log = -np.log(surface)
    first = (1.0 + log) * x - log
    above = log * surface**2 * x * (4.0 * log * (x - 1.0) - 5.0 * x)
    return np.asarray(_quotient(above, 8.0 * first**5))


def nonlinearity(layer: ArrayLike, detuning: ArrayLike, whirl: ArrayLike) -> Array:
    """Share by which the height changes the place of the liquid [theory: model_error, eq. 31]."""
    square = np.square(1.0 - np.asarray(layer, dtype=float))
    offset = small_force(layer, detuning) - (1.0 - square)
    return np.asarray(_quotient(_added(layer, detuning, whirl), np.abs(offset)))


def largest_whirl(layer: ArrayLike, detuning: ArrayLike) -> Array:
    """w_0/h_0 beyond which no smooth steady wave follows a whirl that grows [theory: model_error, eq. 32-33].

    Above the resonance, p > p_1, the fold; below the natural waves of two crests the choking of a thin layer,
    which a thick one comes to earlier; between the resonances of one and of two crests inf.
    """
    t, x = np.broadcast_arrays(layer_tanh(layer), np.asarray(detuning, dtype=float))
    first, second = t / (1.0 + t), t / (1.0 + t + t * t)
    ratio = np.sqrt(x / first)
    apart = np.abs(x - first) / (first - second)
    plain = _FOLD * (1.0 + _FOLD_GROWTH * np.abs(ratio - 1.0))
    level = plain + (_CUBIC_SPRING - _FOLD) / (1.0 + _DISPERSED * apart**_DISPERSED_POWER)
    fold = np.sqrt(_quotient(level, nonlinearity(layer, x, 1.0)))
    below = np.where(x < second, _CHOKES * np.square(1.0 - ratio), np.inf)
    return np.asarray(np.where(ratio > 1.0, fold, below))


@_AT_RESONANCE
def linear_error(layer: ArrayLike, detuning: ArrayLike, whirl: ArrayLike) -> Array:
    """Estimated error of the force by linear theory [theory: model_error, eq. 34]."""
    found = _added(layer, detuning, whirl) * _growth(layer, detuning, whirl)
    return _told(found, layer, detuning, whirl)


@_AT_RESONANCE
def long_wave_error(
    layer: ArrayLike, detuning: ArrayLike, whirl: ArrayLike, dispersion: bool, cells: float = math.inf
) -> Array:
    """Estimated error of the force by long waves [theory: model_error, eq. 35].

    `cells` round the wall, of waves through time.
    """
    depth = np.asarray(layer, dtype=float)
    added, growth = _added(layer, detuning, whirl), _growth(layer, detuning, whirl)
    exact, log = small_force(layer, detuning), -np.log1p(-depth)
    if dispersion:
        padded = log * (15.0 + log * log) / (15.0 + 6.0 * log * log)
        found = np.abs(small_force(layer, detuning, padded) - exact) + _SERRE * added * depth**3 * growth
    else:
        size = np.square(np.asarray(whirl) * depth / (1.0 - depth))
        change = (long_wave_change(layer, detuning) - force_change(layer, detuning)) * size
        found = np.abs(small_force(layer, detuning, log) - exact + change) * growth
        found = found + _CHOKED * added * nonlinearity(layer, detuning, whirl)
    slower, lower = _CELLS_DISPERSED if dispersion else _CELLS
    coarse = (slower * _tanh_change(layer, detuning) + lower * added) * (_AT_CELLS / cells) ** 2
    return _told(found + coarse, layer, detuning, whirl)


@_AT_RESONANCE
def family_error(layer: float, speed: float, whirl: float, whitham: bool) -> float:
    """Estimated error of the force by the family whose resonance is nearer [theory: model_error, eq. 36].

    The speed is omega_w/Omega, other than 0; `whitham`: the family has the exact dispersion.
    """
    surface, detuning, slip = 1.0 - layer, (1.0 - 1.0 / speed) ** 2, speed - 1.0
    pair = [kdv.coefficients(1.0, surface, 1.0, sign) for sign in (1, -1)]
    family = min(pair, key=lambda c: abs(slip - c.linear_speed))
    first, second = (float(kdv.wave_frequency(n, family, whitham)) / n - slip for n in (1, 2))
    # Per whirl, so that a small one has its limit.
    wave = float(_quotient(kdv.forcing(family, speed**2), first))
    bent = float(_quotient((family.steepening * wave * whirl * layer) ** 2, 8.0 * first * second))
    liquid = 2.0 * family.mean_area
    force = liquid * (1.0 + surface * wave * (1.0 + bent) / (2.0 * family.mean_area))
    exact = small_force(layer, detuning) + force_change(layer, detuning) * (whirl * layer / surface) ** 2
    found = abs(force - exact) * _growth(layer, detuning, whirl)
    found += _FAMILY * _added(layer, detuning, whirl) * nonlinearity(layer, detuning, whirl)
    return float(_told(found, layer, detuning, whirl))


def _added(layer: ArrayLike, detuning: ArrayLike, whirl: ArrayLike) -> Array:
    """Size of what the height adds to G."""
    depth = np.asarray(layer, dtype=float)
    size = np.square(np.asarray(whirl, dtype=float) * depth / (1.0 - depth))
    return np.asarray(np.abs(force_change(layer, detuning)) * size)


def _tanh_change(layer: ArrayLike, detuning: ArrayLike) -> Array:
    """Size of the change of G_0 with the logarithm of tanh(L)."""
    t, x = layer_tanh(layer), np.asarray(detuning, dtype=float)
    square = np.square(1.0 - np.asarray(layer, dtype=float))
    return np.asarray(_quotient(square * t * x, np.square(t - (1.0 + t) * x)))


def _growth(layer: ArrayLike, detuning: ArrayLike, whirl: ArrayLike) -> Array:
    """What higher orders make of a difference."""
    return np.asarray(_SLACK * (1.0 + _GROWTH * nonlinearity(layer, detuning, whirl)))


def _told(found: ArrayLike, layer: ArrayLike, detuning: ArrayLike, whirl: ArrayLike) -> Array:
    """Errors over the larger of |G| and 1, where there is a wave and no resonance makes them infinite."""
    relative = _quotient(found, np.maximum(1.0, np.abs(small_force(layer, detuning))))
    held = np.asarray(whirl) <= largest_whirl(layer, detuning)
    return np.asarray(np.where(held & (relative < _MOST), relative, np.nan))


def _quotient(above: ArrayLike, below: ArrayLike) -> Array:
    """A quotient, infinite where it meets a resonance."""
    over, under = np.broadcast_arrays(np.asarray(above, dtype=float), np.asarray(below, dtype=float))
    sound = (under != 0.0) & np.isfinite(under)
    return np.asarray(np.divide(over, under, out=np.full(over.shape, np.inf), where=sound))
