"""Steady waves of long-wave models with more and more of the depth, in Fourier space.

Lengths over R, times in 1/omega_w, velocities over the slip s of the whirl. In its frame a model is
Bernoulli's function of its kinetic energy [theory: long_wave, eq. 25]; the wave is even about the deflection,
and Newton's method with derivatives by complex steps finds it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Any

import numpy as np

from fluid.long_wave import PADE, layer_log
from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive

_ROUNDS, _DONE, _SOUND = 25, 1e-14, 1e-9
_TINY = 1e-30
# The first step of the amplitude on the way from the layer at rest, and the shortest one.
_FIRST, _SHORTEST = 0.2, 0.01
# The surface comes no nearer to the axis, A being at most 1/2.
_FULL = 0.499
# Real or, where derivatives are taken, complex.
Values = Any


class Model(StrEnum):
    """What is kept of the depth.

    HYDROSTATIC: nothing; DISPERSION: `dispersion` as the finite volumes have it [theory: long_wave, eq. 14];
    SERRE: Serre's equations in the strip, the kinetic energy to its first correction; SECOND: to its second
    correction [theory: long_wave, eq. 22].
    """

    HYDROSTATIC = "hydrostatic"
    DISPERSION = "dispersion"
    SERRE = "serre"
    SECOND = "second"


@dataclass(frozen=True)
class HalfRing:
    """Nodes from the deflection to the point opposite; derivatives of even and of odd functions."""

    cosine: Array  #: of the nodes' angles, shape (m + 1,)
    of_even: Array  #: d/dtheta from values at the nodes, shape (m + 1, m + 1)
    of_odd: Array
    mean: Array  #: weights, shape (m + 1,)
    cosines: Array  #: coefficients of an even function, shape (m + 1, m + 1)
    sines: Array  #: those of an odd function, of no meaning in their first and last row


@dataclass(frozen=True)
class Wave:
    """A steady wave of a model."""

    area: Array  #: A at the nodes, shape (m + 1,)
    flux: float  #: what the mass flux through the whirl's frame has beside A, over s
    whirl: float  #: w_0

    @property
    def velocity(self) -> Array:
        """Velocity U at the nodes, over s [theory: long_wave, eq. 25]."""
        return np.asarray((self.area + self.flux) / layer_log(self.area))

    @property
    def force_ratio(self) -> float:
        """G, the force on the drum over that of a full chamber, by the momentum of the liquid."""
        ring = half_ring(self.area.size - 1)
        third = (1.0 - (1.0 - 2.0 * self.area) ** 1.5) / 3.0
        volume = 2.0 * float(ring.mean @ self.area)
        return volume + 2.0 * float(ring.mean @ (third * ring.cosine)) / self.whirl

    def coefficients(self) -> tuple[Array, Array]:
        """Coefficients of A and U in cosines of k theta, k = 0 ... m, each shape (m + 1,)."""
        ring = half_ring(self.area.size - 1)
        return np.asarray(ring.cosines @ self.area), np.asarray(ring.cosines @ self.velocity)


@lru_cache(maxsize=4)
def half_ring(count: int) -> HalfRing:
    """Steps between the nodes of a half ring, 8 at least."""
    if count < 8:
        raise InputError("count", count, "at least 8")
    k = np.arange(count + 1)
    angle = math.pi * k / count
    cosine, sine = np.cos(np.outer(angle, k)), np.sin(np.outer(angle, k))
    ends = np.ones(count + 1)
    ends[[0, -1]] = 0.5
    cosines = 2.0 / count * ends[:, None] * cosine.T * ends
    sines = 2.0 / count * sine.T
    return HalfRing(np.cos(angle), (-sine * k) @ cosines, (cosine * k) @ sines, ends / count, cosines, sines)


def steady(model: Model, layer: float, detuning: float, whirl: float, count: int = 64) -> Wave | None:
    """Wave that a whirl w_0/R holds, followed from the layer at rest; None where the way has no smooth one.

    Depth h_0/R, detuning p^2 = (1 - Omega/omega_w)^2, `count` steps of the half ring.

    >>> wave = steady(Model.SECOND, 0.1, (1.0 - 1.0 / 0.85) ** 2, 0.01, 32)
    >>> f"{wave.force_ratio:.6f}"  # exact: 1.409750
    '1.409750'
    """
    if not 0.0 < layer < 1.0:
        raise InputError("layer", layer, "between 0 and 1")
    require_not_negative("detuning", detuning)
    require_positive("whirl", whirl)
    model, rest = Model(model), 0.5 * layer * (2.0 - layer)
    size = 2 * count + 2 if model is Model.SECOND else count + 3
    state = np.zeros(size)
    state[: count + 1], state[count + 1] = rest, -rest
    state[count + 2 if model is not Model.SECOND else -1] = 0.0
    reached, step = 0.0, _FIRST
    while reached < 1.0:
        step = min(step, 1.0 - reached)
        found = _newton(model, layer, detuning, (reached + step) * whirl, state, count)
        if found is not None:
            state, reached, step = found, reached + step, 1.5 * step
        elif step < _SHORTEST:
            return None
        else:
            step *= 0.5
    return Wave(state[: count + 1], float(state[count + 1]), whirl)


def _newton(
    model: Model, layer: float, detuning: float, whirl: float, state: Array, count: int
) -> Array | None:
    """The state that solves the equations, or None."""
    turned = 1j * _TINY * np.eye(state.size)
    error = math.inf
    for _ in range(_ROUNDS):
        residual = residuals(model, layer, detuning, whirl, state, count)
        before, error = error, float(np.abs(residual).max())
        if error < _DONE or (error < _SOUND and error > 0.5 * before):
            break
        slopes = residuals(model, layer, detuning, whirl, state + turned, count).imag.T / _TINY
        try:
            state = state - np.linalg.solve(slopes, residual)
        except np.linalg.LinAlgError:
            return None
        area = state[: count + 1]
        if not np.isfinite(state).all() or area.min() <= 0.0 or area.max() > _FULL:
            return None
    return state if error < _SOUND else None


def residuals(model: Model, layer: float, detuning: float, whirl: float, state: Values, count: int) -> Values:
    """Equations of a steady wave, of one state or of several at once, real or complex.

    The state holds A at the nodes, what the mass flux has beside it, Bernoulli's constant and, of the model
    SECOND, w at the nodes between the ends: shape (..., m + 3) or (..., 2 m + 2).
    """
    ring = half_ring(count)
    area, flux, constant = state[..., : count + 1], state[..., [count + 1]], state[..., [count + 2]]
    inverse, log = 1.0 / (1.0 - 2.0 * area), layer_log(area)
    velocity = (area + flux) / log
    pull = whirl * np.sqrt(1.0 - 2.0 * area) * ring.cosine
    bend = velocity @ ring.of_even.T
    extra = state[..., :0]
    if model is Model.DISPERSION:
        balance = _present(ring, detuning, area, log, velocity, pull)
        # Odd functions have two numbers less: the constant is of no use, and the shortest wave is left out.
        balance[..., 0], balance[..., -1] = constant[..., 0], (area @ ring.cosines.T)[..., -1]
        rest = velocity - log * (log @ ring.of_even.T) * bend / 3.0
    else:
        rest, gained = velocity, 0.5 * velocity * velocity
        if model is Model.SERRE:
            rest = velocity - (log**3 * bend) @ ring.of_odd.T / (3.0 * log)
            gained = velocity * rest - gained - 0.5 * log**2 * bend**2
        elif model is Model.SECOND:
            ends = np.zeros_like(extra, shape=(*state.shape[:-1], 1))
            share = np.concatenate((ends, state[..., count + 3 :], ends), axis=-1)
            curved = share @ ring.of_odd.T
            rest = velocity - (log**3 * share) @ ring.of_odd.T / (3.0 * log)
            gained = velocity * rest - gained - log**2 * share * (bend - 0.5 * share)
            gained = gained + log**4 * curved**2 / 18.0
            extra = (log**3 * (share - bend) - (log**5 * curved) @ ring.of_even.T / 15.0)[..., 1:-1]
        balance = detuning * (gained * inverse - rest - area) + area - pull - constant
    turned = (rest @ ring.mean)[..., None]
    volume = (area @ ring.mean)[..., None] - 0.5 * layer * (2.0 - layer)
    return np.concatenate((balance, turned, volume, extra), axis=-1)


def _present(
    ring: HalfRing, detuning: float, area: Values, log: Values, velocity: Values, pull: Values
) -> Values:
    """Balance of the present dispersion, in coefficients of sines [theory: long_wave, eq. 13]."""
    constant, curved, less = PADE
    static = (1.0 - detuning) * area - pull
    whole = static + detuning * (0.5 * velocity * velocity / (1.0 - 2.0 * area) - velocity)
    missing, head = whole @ ring.of_even.T, static @ ring.of_even.T
    # Per s: what a slip of s does to the square of a velocity over s is in the detuning.
    stretch = head @ ring.of_odd.T + 2.0 * detuning * (velocity @ ring.of_even.T) ** 2
    push = area * log**2 * (curved * (missing @ ring.of_odd.T) - less * stretch) / constant
    return (area * missing - push @ ring.of_even.T) @ ring.sines.T
