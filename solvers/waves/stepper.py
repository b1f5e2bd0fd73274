"""Exponential steppers for v_t = L v + N(v, t) on a circle: a stiff linear part costs no steps.

The field is real and periodic over 2 pi. Everything works on the coefficients of its real Fourier transform,
where L is one number for each mode; its exponential carries the linear part, the rest enters through weights
that are functions of L times the step (Runge-Kutta). A stepper sees that symbol and a function N and knows no
equation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, NamedTuple

import numpy as np

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_positive

# Terms of the Taylor series of the phi functions for |z| < 1: the first one left out is below 1/19!.
_TERMS = 19


@dataclass(frozen=True)
class Method:
    """A method of four stages."""

    order: int  #: of the error over a fixed time in the length of the step
    #: takes z = L times the step, shape (modes,); returns a21, a31, a32, a41, a43, b1, b2, b4
    weights: Callable[[Complex], tuple[Complex, ...]]
    #: whether N is followed along each mode's own motion, e^{-L t} N, instead of in a frame
    lawson: bool = False


class Weights(NamedTuple):
    """What a step of one length multiplies with, each of shape (modes,).

    `half` and `full` carry the field over half and the whole step; a and b weigh N and contain the step;
    `near` and `far` bring N from the middle and from the start to where N at the end compares with it.
    """

    half: Complex
    full: Complex
    a21: Complex
    a31: Complex
    a32: Complex
    a41: Complex
    a43: Complex
    b1: Complex
    b2: Complex
    b4: Complex
    near: Complex
    far: Complex


def phi_functions(z: Complex) -> tuple[Complex, Complex, Complex]:
    """phi_1, phi_2, phi_3 to rounding for every argument; 1, 1/2, 1/6 at 0 [theory: steppers, eq. 2]."""
    z = np.asarray(z, dtype=complex)
    near = np.abs(z) < 1.0
    # The quotients cancel near 0; there the Taylor series takes over.
    small, large = np.where(near, z, 0.0), np.where(near, 1.0, z)
    phi_1 = np.expm1(large) / large
    phi_2 = (phi_1 - 1.0) / large
    phi_3 = (phi_2 - 0.5) / large
    series = [np.zeros_like(small) for _ in range(3)]
    for j in reversed(range(_TERMS)):
        series = [s * small + 1.0 / math.factorial(j + k) for k, s in enumerate(series, start=1)]
    return (
        np.where(near, series[0], phi_1),
        np.where(near, series[1], phi_2),
        np.where(near, series[2], phi_3),
    )


def _end_weights(z: Complex) -> tuple[Complex, ...]:
    """Weights of N in the result, exact for N quadratic in time [theory: steppers, eq. 4]."""
    phi_1, phi_2, phi_3 = phi_functions(z)
    return phi_1 - 3.0 * phi_2 + 4.0 * phi_3, 2.0 * phi_2 - 4.0 * phi_3, 4.0 * phi_3 - phi_2


def _cox_matthews(z: Complex) -> tuple[Complex, ...]:
    """Stages of ETDRK4 [theory: steppers, eq. 5]."""
    half, none = phi_functions(0.5 * z)[0], np.zeros_like(z)
    return 0.5 * half, none, 0.5 * half, 0.5 * half * np.expm1(0.5 * z), half, *_end_weights(z)


def _krogstad(z: Complex) -> tuple[Complex, ...]:
    """Stages of Krogstad's ETDRK4-B [theory: steppers, eq. 6]."""
    (half, half_2, _), (full, full_2, _) = phi_functions(0.5 * z), phi_functions(z)
    return 0.5 * half, 0.5 * half - half_2, half_2, full - 2.0 * full_2, 2.0 * full_2, *_end_weights(z)


def _integrating_factor(z: Complex) -> tuple[Complex, ...]:
    """Classical Runge-Kutta for e^{-L t} v [theory: steppers, eq. 7]."""
    half: Complex = np.asarray(np.exp(0.5 * z), dtype=complex)
    unit = np.ones_like(z)
    return 0.5 * half, 0.0 * unit, 0.5 * unit, 0.0 * unit, half, half * half / 6.0, half / 3.0, unit / 6.0


METHODS = {
    "etdrk4": Method(4, _cox_matthews),
    "krogstad": Method(4, _krogstad),
    "ifrk4": Method(4, _integrating_factor, lawson=True),
}


def find_method(name: str) -> Method:
    """Method "etdrk4" (Cox and Matthews), "krogstad" (ETDRK4-B) or "ifrk4" (integrating factor)."""
    if name not in METHODS:
        raise InputError("method", name, "one of " + ", ".join(METHODS))
    return METHODS[name]


def step_weights(symbol: Complex, frame: float, method: Method, step: float) -> Weights:
    """Weights of a step, N followed in a frame that turns with the crests [theory: steppers, eq. 9]."""
    half, full = np.exp(0.5 * step * symbol), np.exp(step * symbol)
    if method.lawson:
        return Weights._make((half, full, *(step * w for w in method.weights(step * symbol)), half, full))
    turn = 1j * frame * np.arange(symbol.size, dtype=complex)
    a21, a31, a32, a41, a43, b1, b2, b4 = (step * w for w in method.weights(step * (symbol + turn)))
    near = np.exp(-0.5 * step * turn)
    far = near * near
    return Weights(
        half, full, near * a21, near * a31, a32, far * a41, near * a43, far * b1, near * b2, b4, near, far
    )


Status = Literal["finished", "step too small", "too many steps", "diverged"]

# Greatest mean departure of a cubic from its parabola, 1/32 of its third divided difference, over b4 = 1/6.
_BEND = 6.0 / 32.0
# The error of a step goes with this power of its length.
_POWER = 4
# Step lengths are powers of this, so that weights are used again.
_RUNG = math.pow(2.0, 0.25)
_SAFETY, _SHRINK, _GROW = 0.8, 0.2, 5.0


@dataclass(frozen=True, eq=False)
class Split:
    """An equation split into a linear part, which is solved exactly, and the rest."""

    symbol: Complex  #: L of each mode 0 ... points // 2, 1/s, shape (points // 2 + 1,)
    #: N, takes the field's spectrum and the time in s, returns the spectrum of N, both of that shape
    nonlinear: Callable[[Complex, float], Complex]
    #: angular speed of the frame in which N is followed, rad/s; any value is right, one in which the field
    #: changes slowly allows longer steps
    frame: float = 0.0


class _Past(NamedTuple):
    """N at the start of the step before, brought to its end, and the length of that step."""

    rest: Complex
    step: float


@dataclass(frozen=True)
class Control:
    """How an adaptive run chooses its steps."""

    tolerance: float = 1e-6  #: error of one step over the field, both root mean squares, above 0
    first: float | None = None  #: length of the first step, s, as a former run left it; None: found from N
    shortest: float = 1e-12  #: steps below this fraction of the time span end the run
    most: int = 1_000_000  #: steps, accepted or not, after which the run ends

    def __post_init__(self) -> None:
        require_positive("tolerance", self.tolerance)
        if self.first is not None:
            require_positive("first", self.first)


@dataclass(frozen=True, eq=False)
class Advance:
    """Where a run ended and what it took."""

    spectrum: Complex  #: of the field at `time`, shape (modes,); the last good one
    time: float  #: s
    #: "finished", or why it stopped before; "diverged" if the error of a step reached the field itself
    status: Status
    steps: int  #: steps taken, and tried in vain
    rejected: int
    smallest_step: float  #: shortest step taken, s; infinite if none was
    next_step: float  #: step length the control would try next, s
    largest_error: float  #: of a step taken, estimated, over the field, both root mean squares


def to_spectrum(values: Array) -> Complex:
    """Fourier coefficients of a real field on evenly spaced points.

    Scaled as numpy.fft.rfft; without the mode of half the points, whose derivative they cannot show.
    """
    spectrum = np.fft.rfft(values)
    if values.size % 2 == 0:
        spectrum[-1] = 0.0
    return np.asarray(spectrum)


def squared(spectrum: Complex, points: int) -> Complex:
    """Spectrum of the square of a real field, free of aliases [theory: steppers, eq. 8]."""
    fine = 3 * points // 2
    square = np.fft.rfft(np.square(np.fft.irfft(spectrum, n=fine)))[: spectrum.size] * (fine / points)
    if points % 2 == 0:
        square[-1] = 0.0
    return np.asarray(square)


def _step(
    split: Split, w: Weights, v: Complex, n1: Complex, t: float, h: float, past: _Past | None
) -> tuple[Complex, Complex, float]:
    """Field and N at the end of a step, and its error over the field [theory: steppers, eq. 3, 10]."""
    middle, carried = w.half * v, w.full * v
    n2 = split.nonlinear(middle + w.a21 * n1, t + 0.5 * h)
    n3 = split.nonlinear(middle + w.a31 * n1 + w.a32 * n2, t + 0.5 * h)
    n4 = split.nonlinear(carried + w.a41 * n1 + w.a43 * n3, t + h)
    end = carried + w.b1 * n1 + w.b2 * (n2 + n3) + w.b4 * n4
    n5 = split.nonlinear(end, t + h)
    # The stages in the middle err by opposite amounts.
    whole, middle = w.far * n1, 0.5 * w.near * (n2 + n3)
    bend = 2.0 * whole - 4.0 * middle + 2.0 * n5
    if past is not None:
        r = past.step / h
        before = w.far * past.rest / (r * (r + 0.5) * (r + 1.0))
        bend = 2.0 / r * whole - 4.0 / (r + 0.5) * middle + 2.0 / (r + 1.0) * n5 - before
    return end, n5, _relative(w.b4 * (n5 - n4 + _BEND * bend), v, end)


def advance_fixed(
    split: Split, spectrum: Complex, span: tuple[float, float], steps: int, method: str
) -> Advance:
    """Advance a field by equal steps."""
    start, stop = _checked_span(span)
    if steps < 1:
        raise InputError("steps", steps, "1 or more")
    h = (stop - start) / steps
    weights = step_weights(split.symbol, split.frame, find_method(method), h)
    v, t, largest = spectrum, start, 0.0
    past = _nothing_past(spectrum)
    with np.errstate(over="ignore", invalid="ignore"):
        n = split.nonlinear(v, t)
        for i in range(steps):
            end, n_end, error = _step(split, weights, v, n, t, h, past)
            if error > 1.0:
                return Advance(v, t, "diverged", i, 1, h if i else math.inf, h, largest)
            past = _Past(weights.far * n, h)
            v, n, t, largest = end, n_end, start + (i + 1) * h, max(largest, error)
    return Advance(v, stop, "finished", steps, 0, h, h, largest)


def advance_adaptive(
    split: Split, spectrum: Complex, span: tuple[float, float], control: Control, method: str
) -> Advance:
    """Advance a field by steps as long as the tolerance allows; the last one ends at the end of the span.

    The better of the two embedded results is kept; a proportional-integral control sets the next step
    [theory: steppers, eq. 10-11].
    """
    start, stop = _checked_span(span)
    scheme = find_method(method)
    weights = lru_cache(maxsize=32)(lambda h: step_weights(split.symbol, split.frame, scheme, h))
    # A step that a former run found good needs no guard; else the first is held back by what bends N.
    past = _nothing_past(spectrum) if control.first else None
    v, t, steps, rejected, smallest, before, largest = spectrum, start, 0, 0, math.inf, 1.0, 0.0
    shortest = max(control.shortest * (stop - start), 4.0 * math.ulp(max(abs(start), abs(stop))))
    with np.errstate(over="ignore", invalid="ignore"):
        n = split.nonlinear(v, t)
        # A hundredth of the time in which N alone would renew the field, at most a tenth of the span.
        size, rate = _norm(v), _norm(n)
        moving = size > 0.0 and rate > 0.0
        guess = min(0.1 * (stop - start), 0.01 * size / rate) if moving else 1e-3 * (stop - start)
        trial = control.first or guess
        while t < stop:
            if steps + rejected >= control.most:
                return Advance(v, t, "too many steps", steps, rejected, smallest, trial, largest)
            rung = math.exp(math.log(_RUNG) * math.floor(math.log(trial, _RUNG) + 1e-9))
            left = stop - t
            # No sliver is left for the last step.
            h = left if rung >= left else min(rung, 0.5 * left)
            w = weights(h)
            end, n_end, error = _step(split, w, v, n, t, h, past)
            error /= control.tolerance
            if error > 1.0:
                rejected += 1
                trial = h * max(_SHRINK, _SAFETY * error ** (-1.0 / _POWER))
                if trial < shortest:
                    return Advance(v, t, "step too small", steps, rejected, smallest, trial, largest)
                continue
            past = _Past(w.far * n, h)
            v, n, t = end, n_end, stop if h >= left else t + h
            steps, smallest = steps + 1, min(smallest, h)
            growth = _growth(error, before)
            # A step cut short to land may not hold the next one back.
            trial = max(trial, h * growth) if h < rung else min(trial * growth, h * _GROW)
            before, largest = max(error, 1e-4), max(largest, error * control.tolerance)
    return Advance(v, t, "finished", steps, rejected, smallest, trial, largest)


def _growth(error: float, before: float) -> float:
    """Factor on the step after an accepted one [theory: steppers, eq. 11]."""
    wanted = _SAFETY * math.pow(max(error, 1e-8), -0.7 / _POWER) * math.pow(before, 0.4 / _POWER)
    return min(_GROW, max(_SHRINK, wanted))


def _nothing_past(spectrum: Complex) -> _Past:
    """A past so far away that it says nothing."""
    return _Past(np.zeros_like(spectrum), math.inf)


def _relative(difference: Complex, v: Complex, end: Complex) -> float:
    """Root mean square of an error over that of the field; infinite where either is not finite."""
    error, size = _norm(difference), max(_norm(v), _norm(end))
    if not (math.isfinite(error) and math.isfinite(size)):
        return math.inf
    return error / size if size > 0.0 else 0.0


def _norm(spectrum: Complex) -> float:
    """Root of the sum of squares over all modes, each but the mean standing for its conjugate too."""
    power = np.square(spectrum.real) + np.square(spectrum.imag)
    return math.sqrt(2.0 * float(power.sum()) - float(power[0]))


def _checked_span(span: tuple[float, float]) -> tuple[float, float]:
    start, stop = span
    if not (math.isfinite(start) and math.isfinite(stop) and stop > start):
        raise InputError("span", span, "two finite times, the second later")
    return start, stop
