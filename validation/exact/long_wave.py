"""Smooth steady long waves without friction, solved for in the frame of their whirl.

Without bore and friction what `LongWave` ends at obeys ordinary equations, solved by Newton's method: the
error of the model alone, without its cells' [theory: model_error, eq. 24-27]. Lengths over R, times in
1/Omega, velocities over s; of the whirl speed only p^2 counts, as for the fully nonlinear wave.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from meshes.arrays import Array

# Newton's method: done at this residual; rounds; shortest step of the way in amplitude.
_DONE, _ROUNDING, _ROUNDS, _SHORTEST = 1e-13, 1e-11, 25, 1.0 / 128.0
# A step into the complex plane along which the derivative of a residual is exact to rounding.
_STEP = 1e-30
# Nodes from the deflection to its opposite: few to begin with, more where a spectrum has not ended.
NODES = (33, 65, 129)
RESOLVED = 1e-7
# Nodes to find where the flow chokes, and the tail of a spectrum that a corner has there.
_CHOKED, _CORNER = 33, 1e-3


@dataclass(frozen=True)
class SteadyLongWave:
    """A long wave of permanent form, even about the deflection."""

    angle: Array  #: from the deflection, 0 to pi, rad, shape (n,)
    area: Array  #: liquid per radian, over R^2, shape (n,)
    whirl: float  #: w_0/R
    tail: float  #: of its spectrum, the last tenth over the largest
    converged: bool  #: it meets its equations

    @property
    def smooth(self) -> bool:
        """It meets its equations, and the nodes are enough for it."""
        return self.converged and self.tail < RESOLVED

    @property
    def force_ratio(self) -> float:
        """Force over that of a full chamber, by the place of the liquid [theory: potential, eq. 14]."""
        weights = _even(self.angle.size).mean
        third = (1.0 - (1.0 - 2.0 * self.area) ** 1.5) / 3.0
        moment = float(weights @ (third * np.cos(self.angle)))
        return 2.0 * (float(weights @ self.area) + moment / self.whirl)


def steady_long_wave(layer: float, detuning: float, whirl: float, dispersion: bool) -> SteadyLongWave:
    """Long wave that a whirl w_0/R holds, from the layer at rest; not converged where the flow chokes before.

    Depth h_0/R, detuning p^2 = (1 - Omega/omega_w)^2.

    >>> wave = steady_long_wave(0.1, (1.0 - 1.0 / 1.3) ** 2, 0.002, dispersion=True)
    >>> f"{wave.force_ratio:.4f}"  # the exact wave has 2.0425
    '2.0425'
    """
    for count in NODES:
        found = _followed(layer, detuning, whirl, dispersion, count)
        if found.smooth or not found.converged:
            break
    return found


def _followed(layer: float, detuning: float, whirl: float, dispersion: bool, count: int) -> SteadyLongWave:
    """The same on a number of nodes."""
    state, reached, step = _rest(layer, detuning, count), 0.0, 0.5
    while reached < 1.0:
        step = min(step, 1.0 - reached)
        problem = _Problem(layer, detuning, (reached + step) * whirl, dispersion, count)
        found = _newton(problem, state)
        if found is not None:
            state, reached, step = found, reached + step, 1.5 * step
        elif step < _SHORTEST:
            break
        else:
            step *= 0.5
    even = _even(count)
    size = np.abs(even.coefficients @ state[:count])
    tail = float(size[-(count // 10) :].max() / size[1:].max())
    return SteadyLongWave(even.angle, state[:count], whirl, tail, reached >= 1.0)


def choking(layer: float, detuning: float, most: float) -> float:
    """Largest w_0/h_0 of a smooth long wave without dispersion, to 10 %; nan above `most`."""
    state, count, whirl, reached = _rest(layer, detuning, _CHOKED), _CHOKED, 1e-6, 0.0
    coefficients = _even(count).coefficients
    while whirl < most:
        found = _newton(_Problem(layer, detuning, whirl * layer, False, count), state)
        if found is None:
            return reached
        size = np.abs(coefficients @ found[:count])
        if size[-(count // 10) :].max() > _CORNER * size[1:].max():
            return reached
        state, reached, whirl = found, whirl, 1.1 * whirl
    return math.nan


def _rest(layer: float, detuning: float, count: int) -> Array:
    """The unknowns of the layer at rest."""
    area = 0.5 * layer * (2.0 - layer)
    state = np.zeros(2 * count)
    state[:count], state[-2], state[-1] = area, area, (1.0 - detuning) * area
    return state


@dataclass(frozen=True)
class _Problem:
    """What a steady long wave obeys; the parameters of `steady_long_wave`, and the number of nodes n.

    Unknown are the area at the nodes, y at those between the ends, the mass flux and Bernoulli's constant.
    """

    layer: float
    detuning: float
    whirl: float
    dispersion: bool
    count: int

    def residual(self, state: Array) -> Array:
        """Residual of the unknowns, real or complex, shape (..., 2 n) [theory: model_error, eq. 24-27]."""
        n, even, square = self.count, _even(self.count), self.detuning
        area, flux, constant = state[..., :n], state[..., -2:-1], state[..., -1:]
        lag = np.zeros_like(area)
        lag[..., 1:-1] = state[..., n : 2 * n - 2]
        radius2 = 1.0 - 2.0 * area
        log = -0.5 * np.log(radius2)
        speed = (area - flux) / log
        head = (1.0 - square) * area - self.whirl * np.sqrt(radius2) * np.cos(even.angle)
        bernoulli = square * (0.5 * speed * speed / radius2 - speed) + head
        found = np.empty_like(state)
        found[..., :n] = bernoulli - constant - lag @ even.integral.T
        circulation = speed @ even.mean
        if self.dispersion:
            steep, slope = speed @ even.slope.T, area @ even.slope.T
            bent = (head @ even.slope.T) @ even.odd_slope.T
            pressure = 0.4 * (lag @ even.odd_slope.T) - (bent + 2.0 * square * steep * steep) / 3.0
            missing = area * lag - (area * log * log * pressure) @ even.slope.T
            found[..., n : 2 * n - 2] = missing[..., 1:-1]
            circulation = circulation - (log * log * slope * steep / area) @ even.mean / 3.0
        else:
            found[..., n : 2 * n - 2] = lag[..., 1:-1]
        found[..., -2] = area @ even.mean - 0.5 * self.layer * (2.0 - self.layer)
        found[..., -1] = circulation
        return found


def _newton(problem: _Problem, state: Array) -> Array | None:
    """The unknowns near a first guess, or None."""
    steps = 1j * _STEP * np.eye(state.size)
    for _ in range(_ROUNDS):
        residual = problem.residual(state)
        error = float(np.abs(residual).max())
        if error < _DONE:
            return state
        if not np.isfinite(error):
            return None
        jacobian = problem.residual(state + steps).imag.T / _STEP
        try:
            state = state - np.linalg.solve(jacobian, residual)
        except np.linalg.LinAlgError:
            return None
        area = state[: problem.count]
        if not (area.min() > 0.0 and area.max() < 0.5):
            return None
    return state if error < _ROUNDING else None


@dataclass(frozen=True)
class _Even:
    """Even nodes from 0 to pi, and functions even or odd about both ends."""

    angle: Array  #: of the nodes, rad, shape (n,)
    mean: Array  #: weights of the mean, shape (n,)
    coefficients: Array  #: cosines of an even function, shape (n, n)
    slope: Array  #: derivative of an even function, of an odd one, shape (n, n)
    odd_slope: Array
    integral: Array  #: of an odd function, with mean 0, shape (n, n)


@cache
def _even(count: int) -> _Even:
    angle, waves = np.linspace(0.0, np.pi, count), np.arange(count)
    cosine, sine = np.cos(np.outer(angle, waves)), np.sin(np.outer(angle, waves))
    mean = np.full(count, 1.0 / (count - 1))
    mean[[0, -1]] *= 0.5
    of_even, of_odd = 2.0 * cosine.T * mean, 2.0 * sine.T * mean
    of_even[[0, -1]] *= 0.5
    of_odd[[0, -1]] = 0.0
    inverse = np.divide(1.0, waves, out=np.zeros(count), where=waves > 0)
    return _Even(
        angle=angle,
        mean=mean,
        coefficients=of_even,
        slope=-(sine * waves) @ of_even,
        odd_slope=(cosine * waves) @ of_odd,
        integral=-(cosine * inverse) @ of_odd,
    )
