"""Exact waves that lag behind the whirl that holds them, and the circles of a rotor with losses.

Friction is a body force -k u on the liquid. As the steady waves without it, but neither even nor in phase:
the surface at even u all round, by Newton's method [theory: potential, eq. 38].
Lengths over R.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from meshes.arrays import Array
from solvers.wave_error import layer_tanh

# Newton's method: done at this residual, or where rounding stops it; rounds.
_DONE, _ROUNDING, _ROUNDS = 1e-14, 1e-11, 15
# Steps of the unknowns for the derivatives: of a wave, and of the circle's two.
_STEP, _MOVED = 1e-7, 1e-7
# Nodes round the drum, odd so that no wave has a cosine alone; and the tail that is too long for them.
NODES, ROUGH = 65, 1e-5
# Of a circle: settled at this change of the speeds; a determinant too small to tell where to go.
_SETTLED, _FLAT = 1e-10, 1e-12
# Omega/omega_n between which an onset is looked for, and steps.
_SLOWEST, _FASTEST, _APART = 0.2, 4.0, 0.002


@dataclass(frozen=True)
class LaggingWave:
    """A wave that stands in the frame of its whirl."""

    surface: Array  #: y = ln(R/r) at even u, shape (m,)
    potential: Array  #: phi over s there, shape (m,)
    whirl: float  #: w_0/R, along the angle 0
    force_ratio: complex  #: G, complex
    tail: float  #: of the spectrum, the last tenth over the largest
    converged: bool  #: it meets its equations


def lagging_wave(
    layer: float, slip: float, whirl: float, friction: float, near: Array | None = None
) -> LaggingWave:
    """Wave of a whirl w_0/R in liquid with friction k/omega_w, from a surface, (m,), or from rest.

    Slip p = 1 - Omega/omega_w.

    >>> found = lagging_wave(0.1, 1.0 - 1.0 / 1.3, 0.002, 0.0)
    >>> f"{found.force_ratio.real:.9f}"
    '2.042546357'
    """
    surface = np.full(NODES, -math.log1p(-layer)) if near is None else near
    m = surface.size
    state = np.append(surface, 0.5 * slip * slip - 0.5)
    steps, error = _STEP * np.eye(m + 1), math.inf
    for _ in range(_ROUNDS):
        residual = _residual(state, layer, slip, whirl, friction)
        before, error = error, float(np.abs(residual).max())
        if not np.isfinite(error) or error < _DONE or (error < _ROUNDING and error > 0.5 * before):
            break
        jacobian = (_residual(state + steps, layer, slip, whirl, friction) - residual).T / _STEP
        state = state - np.linalg.solve(jacobian, residual)
        if not 0.0 < state[:m].min() <= state[:m].max() < 15.0:
            error = math.inf
            break
    size = np.arange(m // 2 + 1) * np.abs(np.fft.rfft(state[:m]))
    tail = float(size[-(m // 20) :].max() / size.max()) if size.max() > 0.0 else 0.0
    force, potential = _force_ratio(state[:m], layer, whirl), _potential(state[:m])
    return LaggingWave(state[:m], potential, whirl, force, tail, error < _ROUNDING and tail < ROUGH)


@cache
def _waves(m: int) -> tuple[Array, Array]:
    """Wave numbers with their signs, and u."""
    return np.asarray(np.fft.fftfreq(m, 1.0 / m), dtype=float), 2.0 * math.pi * np.arange(m) / m


def _strip(values: Array, depth: Array) -> tuple[Array, Array]:
    """[k coth(kK) g_k] and [-i coth(kK) g_k] of functions, shape (..., m); depths have the shape (..., 1)."""
    k, _ = _waves(values.shape[-1])
    inner = np.where(k == 0.0, 1.0, k) * depth
    over = np.where(k == 0.0, 0.0, 1.0 / np.tanh(inner))
    spectrum = np.fft.fft(values)
    return np.fft.ifft(k * over * spectrum).real, np.fft.ifft(-1j * over * spectrum).real


def _slope(values: Array) -> Array:
    k, _ = _waves(values.shape[-1])
    return np.asarray(np.fft.ifft(1j * k * np.fft.fft(values)).real)


def _residual(state: Array, layer: float, slip: float, whirl: float, friction: float) -> Array:
    """What Bernoulli and the volume miss, shape (..., m + 1)."""
    y, constant = state[..., :-1], state[..., -1:]
    depth = y.mean(axis=-1, keepdims=True)
    square, radius = np.exp(-2.0 * y), np.exp(-y)
    flux, shift = _strip(y, depth)
    opened, angle = 1.0 + flux, _waves(y.shape[-1])[1] + shift
    steep, (carried, lag) = _slope(y), _strip(square, depth)
    speed = 0.5 * carried + square * opened
    kinetic = speed * speed / (2.0 * square * (opened * opened + steep * steep))
    # phi over s along the surface.
    potential = -0.5 * lag
    found = np.empty_like(state)
    found[..., :-1] = slip * slip * kinetic - 0.5 * square - whirl * radius * np.cos(angle) - constant
    found[..., :-1] += friction * slip * potential
    found[..., -1] = ((1.0 - square) * opened).mean(axis=-1) - layer * (2.0 - layer)
    return found


def _potential(y: Array) -> Array:
    """phi over s along the surface [theory: potential, eq. 5]."""
    return -0.5 * _strip(np.exp(-2.0 * y), y.mean(keepdims=True))[1]


def _force_ratio(y: Array, layer: float, whirl: float) -> complex:
    """By the place of the liquid's centre of mass [theory: potential, eq. 14]."""
    flux, shift = _strip(y, y.mean(keepdims=True))
    angle = _waves(y.size)[1] + shift
    third = (1.0 - np.exp(-3.0 * y)) / 3.0
    moment = 2.0 * complex(np.mean(np.exp(1j * angle) * third * (1.0 + flux)))
    return layer * (2.0 - layer) + moment / whirl


@dataclass(frozen=True)
class Circle:
    """A circle of a rotor on round supports with the wave it holds."""

    whirl: float  #: W/h_0
    speed: float  #: Omega/omega_n
    whirl_speed: float  #: omega_w/omega_n
    crest: float  #: depth there over h_0


def small_whirl(
    layer: float, mass_ratio: float, damping: float, friction: float, speed: float
) -> tuple[float, float]:
    """Growth rate and speed over omega_n of the small whirl that grows most [theory: whirl, eq. 8].

    Of h_0/R, mu, zeta, k/omega_n and Omega/omega_n.
    """
    tanh = float(layer_tanh(layer))
    poly = np.polynomial.polynomial
    slip = np.array([-speed, 1.0])
    wave = poly.polymul(slip, slip - np.array([2.0 * tanh * speed + 1j * friction, 0.0]))
    wave = poly.polyadd(wave, [-tanh * speed**2])
    liquid = poly.polyadd(wave, [0.0, 0.0, -0.5 * (1.0 - tanh)])
    rotor = poly.polymul([1.0, 2j * damping, -1.0], wave)
    heavy = poly.polymul([0.0, 0.0, mass_ratio * 2.0 * tanh / (1.0 + tanh)], liquid)
    roots = poly.polyroots(poly.polysub(rotor, heavy))
    most = roots[np.argmin(roots.imag)]
    return -float(most.imag), float(most.real)


def onset(layer: float, mass_ratio: float, damping: float, friction: float) -> tuple[float, float] | None:
    """Omega/omega_n and omega_w/omega_n at which a whirl grows on the way up; None up to `_FASTEST`."""
    from scipy.optimize import brentq

    def growth(speed: float) -> float:
        return small_whirl(layer, mass_ratio, damping, friction, speed)[0]

    below = _SLOWEST
    for speed in np.arange(_SLOWEST, _FASTEST, _APART).tolist():
        if growth(speed) > 0.0:
            if speed == _SLOWEST:
                return None
            found = float(brentq(growth, below, speed, xtol=1e-13))
            return found, small_whirl(layer, mass_ratio, damping, friction, found)[1]
        below = speed
    return None


def circles(
    layer: float,
    mass_ratio: float,
    damping: float,
    friction: float,
    whirls: Sequence[float],
    nodes: int = NODES,
) -> list[Circle]:
    """Circles of rising whirls W/h_0 from the lower onset, each from the one before, until none is found.

    An odd number of nodes round the drum.
    """
    begin = onset(layer, mass_ratio, damping, friction)
    if begin is None:
        return []
    machine = _Machine(layer, mass_ratio, damping, friction)
    point, found = np.array(begin), [Circle(0.0, *begin, 1.0)]
    surface = np.full(nodes, -math.log1p(-layer))
    for whirl in whirls:
        reached = machine.circle(point, whirl, surface)
        if reached is None:
            break
        point, surface = reached
        crest = float(-np.expm1(-surface.max())) / layer
        found.append(Circle(whirl, float(point[0]), float(point[1]), crest))
    return found


@dataclass(frozen=True)
class _Machine:
    """The parameters of `circles`."""

    layer: float
    mass_ratio: float
    damping: float
    friction: float

    def circle(self, begin: Array, whirl: float, near: Array) -> tuple[Array, Array] | None:
        """Both speeds and the surface of the circle of a whirl, by Newton's method."""
        point, surface = begin, near
        for _ in range(_ROUNDS):
            offs = [self.missing(moved, whirl, surface) for moved in (point, *(point + _MOVED * np.eye(2)))]
            known = [off for off in offs if off is not None]
            if len(known) < 3:
                return None
            (off, surface), (first, _), (second, _) = known
            slopes = np.array([first - off, second - off]) / _MOVED
            jacobian = np.array([slopes.real, slopes.imag])
            if abs(np.linalg.det(jacobian)) < _FLAT:
                return None
            change = np.linalg.solve(jacobian, [-off.real, -off.imag])
            point = point + change
            if np.abs(change).max() < _SETTLED:
                return point, surface
        return None

    def missing(self, point: Array, whirl: float, near: Array) -> tuple[complex, Array] | None:
        """What a circle misses of the rotor's equation, and the surface of its wave."""
        speed, turning = point.tolist()
        if not turning > 0.0:
            return None
        slip, friction = 1.0 - speed / turning, self.friction / turning
        wave = lagging_wave(self.layer, slip, whirl * self.layer, friction, near)
        if not wave.converged:
            return None
        held = self.mass_ratio * turning**2 * wave.force_ratio
        return 1.0 - turning**2 + 2j * self.damping * turning - held, wave.surface
