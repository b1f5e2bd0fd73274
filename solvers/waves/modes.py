"""KdV-Burgers and Whitham waves of one family: terms for steppers, equations of a steady wave for its modes.

A steady wave has Galerkin modes 1..M and mean 0, as many as 2 M + 2 points carry; the square is taken on more
than 3 M points, so nothing aliases. The exact derivative is there as a matrix, of the first modes or of all,
and as what it does to a change, by FFT. `one_thread` holds the BLAS to one thread (threadpoolctl): more of
them slow matrices of this size down.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy import fft
from threadpoolctl import ThreadpoolController

from fluid.kdv import KdvCoefficients, wave_frequency
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative
from solvers.liquid_model import grown
from solvers.waves.stepper import Split, squared


@dataclass(frozen=True)
class WaveTerms:
    """What acts on the waves of one family [theory: kdv, eq. 1]."""

    c: KdvCoefficients  #: speed, steepening, dispersion
    whitham: bool = False  #: exact dispersion [theory: kdv, eq. 10] instead of the third derivative
    viscosity: float = 0.0  #: nu_b, rad^2/s, 0 or above
    damping: float = 0.0  #: gamma, 1/s, 0 or above
    forcing: float = 0.0  #: q, m^2/s, from `fluid.kdv.forcing`
    whirl_speed: float = 0.0  #: s, seen from the drum, rad/s
    ramp: float = 0.0  #: time over which the forcing grows, s

    def __post_init__(self) -> None:
        require_not_negative("ramp", self.ramp)
        require_not_negative("viscosity", self.viscosity)
        require_not_negative("damping", self.damping)
        for field, value in (("forcing", self.forcing), ("whirl_speed", self.whirl_speed)):
            if not math.isfinite(value):
                raise InputError(field, value, "a finite number")


def wave_split(terms: WaveTerms, points: int, first_angle: float = 0.0) -> Split:
    """Linear symbol, and steepening with forcing as the rest [theory: steppers, eq. 1].

    For fields eta, m^2, on 8 or more points, the first at theta = `first_angle`; free of aliases, without the
    mode of half the points. Followed in the frame of the whirl or, without forcing, of long waves.
    """
    if points < 8:
        raise InputError("points", points, "8 or more")
    n = np.arange(points // 2 + 1)
    omega = wave_frequency(n, terms.c, terms.whitham)
    symbol = np.asarray(-1j * omega - terms.viscosity * np.square(n) - terms.damping, dtype=complex)
    steepen = -0.5j * terms.c.steepening * n
    # -q sin(theta - s t) = Re(i q e^{i (theta - s t)}), as scaled by the transform.
    push = 0.5j * terms.forcing * points * np.exp(1j * first_angle)

    def nonlinear(spectrum: Complex, t: float) -> Complex:
        rate = steepen * squared(spectrum, points)
        rate[1] += push * np.exp(-1j * terms.whirl_speed * t) * grown(t, terms.ramp)
        return np.asarray(rate)

    frame = terms.whirl_speed if terms.forcing else terms.c.linear_speed
    return Split(symbol, nonlinear, frame)


DENSE_MODES = 511
_NO_MEAN = np.zeros(1, dtype=complex)


@dataclass(frozen=True)
class WaveProblem:
    """Steady waves eta(xi), xi = theta - s t, of mean 0 [theory: kdv, eq. 18]."""

    #: omega(n) of natural sloshing waves of vanishing height, rad/s, odd; takes n = 1, 2, ... as an array
    frequency: Callable[[Array], Array]
    steepening: float  #: alpha, rad/(s m^2), not 0
    forcing: float  #: q, m^2/s; 0 for a natural sloshing wave
    decay: float = 0.0  #: gamma, 1/s, 0 or above
    diffusion: float = 0.0  #: nu_b, rad^2/s, 0 or above

    def __post_init__(self) -> None:
        if not math.isfinite(self.steepening) or self.steepening == 0.0:
            raise InputError("steepening", self.steepening, "a finite number other than 0")
        if not math.isfinite(self.forcing):
            raise InputError("forcing", self.forcing, "a finite number")
        require_not_negative("decay", self.decay)
        require_not_negative("diffusion", self.diffusion)

    @functools.cached_property
    def speed_scale(self) -> float:
        """Speed by which the wave's own height or its dispersion shifts it, rad/s."""
        first, second = self.frequency(np.array([1.0, 2.0]))
        scale = max(math.sqrt(abs(self.steepening * self.forcing)), abs(first - 0.5 * second))
        return float(scale) or 1.0


class System:
    """The scaled equations of M modes: v = alpha eta/scale, p = s/scale, real unknowns [Re v, Im v].

    Mode n, divided by i n: (omega_n/n - p) v_n + (v^2)_n/2 - i (nu n + gamma/n) v_n - q/2 [n = 1] = 0
    [theory: kdv, eq. 19].
    """

    def __init__(self, problem: WaveProblem, modes: int) -> None:
        self.problem, self.modes = problem, modes
        self.scale = problem.speed_scale
        n = np.arange(1.0, modes + 1.0)
        damping = (problem.diffusion * n + problem.decay / n) / self.scale
        self.n = n
        self.diagonal = problem.frequency(n) / n / self.scale - 1j * damping
        self.half_forcing = 0.5 * problem.forcing * problem.steepening / self.scale**2
        self.points = int(fft.next_fast_len(3 * modes + 1, real=True))
        weight = 1.0 / (1.0 + np.abs(self.diagonal - self.diagonal[0].real))
        self.weight = np.concatenate((weight, weight))

    def coefficient(self, p: float) -> Complex:
        """Coefficient of each mode in its own equation, shape (M,)."""
        return np.asarray(self.diagonal - p)

    def by_parameter(self, y: Array, p: float) -> Array:
        """Derivative of the equations with respect to p, shape (2 M,)."""
        return -y

    def linear(self, p: float) -> Array:
        """Wave of the linear equation; near resonance no higher than what nonlinearity lets stand."""
        v = np.zeros(self.modes, dtype=complex)
        gap = self.coefficient(p)[0]
        v[0] = self.half_forcing / gap if gap != 0.0 else 1.0
        v[0] /= max(1.0, abs(v[0]))
        return split(v)

    def residual(self, y: Array, p: float) -> Array:
        """Residual of the equations, shape (2 M,)."""
        v = joined(y)
        square = fft.rfft(np.square(values(v, self.points)), norm="forward")
        r = self.coefficient(p) * v + 0.5 * square[1 : self.modes + 1]
        r[0] -= self.half_forcing
        return split(r)

    def error(self, r: Array, y: Array) -> float:
        """Residual of each mode over its coefficient, relative to the wave."""
        return self.size(r) / (length(y) or 1.0)

    def size(self, r: Array) -> float:
        """Residual with each mode over its coefficient."""
        return length(r * self.weight)

    def act(self, heights: Array, p: float, x: Array) -> Array:
        """The derivative at the wave of these heights times a change x, shape (2 M,)."""
        dv = joined(x)
        product = fft.rfft(heights * values(dv, self.points), norm="forward")
        return split(self.coefficient(p) * dv + product[1 : self.modes + 1])

    def jacobian(self, y: Array, p: float, modes: int, border: int = 0) -> Array:
        """Exact derivative by the first modes, shape (2 modes + border, 2 modes + border), border not set."""
        v = joined(y)
        wave = np.zeros(3 * modes, dtype=complex)  # wave numbers -(modes - 1) ... 2 modes
        kept = min(2 * modes, self.modes)
        wave[modes : modes + kept] = v[:kept]
        wave[: modes - 1] = np.conj(v[: modes - 1][::-1])
        (tr, hr), (ti, hi) = _difference_and_sum(wave.real), _difference_and_sum(wave.imag)
        # Rows of the transpose: Toeplitz and Hankel parts are symmetric, but for the sign of the diagonal's.
        m, full = modes, 2 * modes
        matrix = np.empty((full + border, full + border))
        np.add(tr, hr, out=matrix[:m, :m])
        np.subtract(hi, ti, out=matrix[:m, m:full])
        np.add(hi, ti, out=matrix[m:full, :m])
        np.subtract(tr, hr, out=matrix[m:full, m:full])
        d, k = self.coefficient(p)[:m], np.arange(m)
        matrix[k, k] += d.real
        matrix[m + k, m + k] += d.real
        matrix[k, m + k] += d.imag
        matrix[m + k, k] -= d.imag
        return matrix.T


class DampingSystem(System):
    """`System` at a fixed speed: an extra diffusion, in the problem's scale, takes the place of p."""

    def __init__(self, problem: WaveProblem, modes: int, speed: float) -> None:
        super().__init__(problem, modes)
        self.speed = speed
        self._still = self.diagonal - speed / self.scale

    def coefficient(self, p: float) -> Complex:
        """Coefficient of each mode in its own equation, shape (M,)."""
        return np.asarray(self._still - (1j * p) * self.n)

    def by_parameter(self, y: Array, p: float) -> Array:
        """Derivative of the equations with respect to p, shape (2 M,)."""
        m = self.modes
        return np.concatenate((self.n * y[m:], -self.n * y[:m]))


def one_thread() -> AbstractContextManager[object]:
    """Context in which the BLAS runs on one thread."""
    return cast("AbstractContextManager[object]", _controller().limit(limits=1, user_api="blas"))


@functools.cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


def length(x: Array) -> float:
    """Root of the sum of squares."""
    return math.sqrt(float(x @ x))


def split(v: Complex) -> Array:
    """Real unknowns of complex modes."""
    return np.concatenate((v.real, v.imag))


def joined(y: Array) -> Complex:
    """Complex modes of real unknowns."""
    m = y.size // 2
    return np.asarray(y[:m] + 1j * y[m:])


def resized(y: Array, modes: int) -> Array:
    """Unknowns with modes cut off or set to 0."""
    v, old = np.zeros(modes, dtype=complex), joined(y)
    kept = min(modes, old.size)
    v[:kept] = old[:kept]
    return split(v)


def values(v: Complex, points: int) -> Array:
    """Values at equal steps of a real field without mean."""
    return np.asarray(np.fft.irfft(np.concatenate((_NO_MEAN, v)), points, norm="forward"))


def _difference_and_sum(wave: Array) -> tuple[Array, Array]:
    """Entries of wave number n - m and n + m, n and m from 1, as views; `wave` starts at -(M - 1)."""
    wave = np.ascontiguousarray(wave)
    m, item = wave.size // 3, wave.itemsize
    difference: Array = np.ndarray((m, m), float, wave, (m - 1) * item, (item, -item))
    return difference, np.ndarray((m, m), float, wave, (m + 1) * item, (item, item))
