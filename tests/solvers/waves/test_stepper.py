"""Exponential steppers: the order they declare, exactness where it is due, what they say when they fail."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from fluid.exact import cnoidal_wave
from fluid.kdv import coefficients
from meshes.errors import InputError
from solvers.waves.stepper import (
    METHODS,
    Control,
    Split,
    advance_adaptive,
    advance_fixed,
    find_method,
    phi_functions,
    squared,
    step_weights,
    to_spectrum,
)
from tests.mutants import kills

# u_t + 6 u u_x + u_xxx = 0, written out here, and its periodic solitary wave.
PLAIN = replace(coefficients(0.15, 0.135, 40.0, 1), linear_speed=0.0, steepening=6.0, dispersion=1.0)
WAVE = cnoidal_wave(PLAIN, 2.0 * 1.5**2)
SPEED = WAVE.speed
DEFAULT = "krogstad"


def angles(points: int) -> np.ndarray:
    return 2.0 * np.pi * np.arange(points) / points


def kdv(points: int, frame: float = 0.0) -> Split:
    n = np.arange(points // 2 + 1)
    return Split(1j * n.astype(complex) ** 3, lambda v, t: -3j * n * squared(v, points), frame)


def manufactured(points: int) -> tuple[Split, np.ndarray]:
    """u = cos(x - 2 t) + sin(2 x + t)/2 solves u_t + u u_x + u_xxx/10 = u_xx/20 - u/10 + source."""
    n = np.arange(points // 2 + 1)
    x = angles(points)

    def source(t: float) -> np.ndarray:
        a, b = x - 2.0 * t, 2.0 * x + t
        u, u_t = np.cos(a) + 0.5 * np.sin(b), 2.0 * np.sin(a) + 0.5 * np.cos(b)
        u_x, u_xx, u_xxx = -np.sin(a) + np.cos(b), -np.cos(a) - 2.0 * np.sin(b), np.sin(a) - 4.0 * np.cos(b)
        return u_t + u * u_x + 0.1 * u_xxx - 0.05 * u_xx + 0.1 * u

    symbol = 0.1j * n.astype(complex) ** 3 - 0.05 * n**2 - 0.1
    split = Split(symbol, lambda v, t: -0.5j * n * squared(v, points) + to_spectrum(source(t)), 0.7)
    return split, x


def manufactured_field(x: np.ndarray, t: float) -> np.ndarray:
    return np.cos(x - 2.0 * t) + 0.5 * np.sin(2.0 * x + t)


def relative(values: np.ndarray, exact: np.ndarray) -> float:
    """Root mean square error over the root mean square."""
    return float(np.linalg.norm(values - exact) / np.linalg.norm(exact))


def soliton_error(method: str, steps: int, frame: float = 0.0) -> float:
    """Against the exact wave, which 64 points show to 1e-13."""
    x, stop = angles(64), 0.1
    done = advance_fixed(kdv(64, frame), to_spectrum(WAVE.profile(x)), (0.0, stop), steps, method)
    assert done.status == "finished"
    return relative(np.fft.irfft(done.spectrum), WAVE.profile(x, stop))


def manufactured_error(method: str, steps: int) -> float:
    split, x = manufactured(24)
    done = advance_fixed(split, to_spectrum(manufactured_field(x, 0.3)), (0.3, 1.3), steps, method)
    return relative(np.fft.irfft(done.spectrum), manufactured_field(x, 1.3))


def assert_order(method: str) -> None:
    declared = find_method(method).order
    for error, steps in ((manufactured_error, 40), (soliton_error, 400)):
        measured = math.log2(error(method, steps) / error(method, 2 * steps))
        assert measured == pytest.approx(declared, abs=0.2), (method, error.__name__, measured)


@pytest.mark.parametrize("method", METHODS)
def test_order_is_the_one_declared(method: str) -> None:
    assert_order(method)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("frame", [-3.0, 0.5 * SPEED])
def test_order_is_the_same_in_any_frame(method: str, frame: float) -> None:
    errors = [soliton_error(method, steps, frame=frame) for steps in (400, 800)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize("method", ["etdrk4", "krogstad"])
def test_wave_of_permanent_form_is_kept_to_rounding_in_its_own_frame(method: str) -> None:
    # A cosine in u_t + u_x = 0 with all of it in N, the hardest split: exact in the frame, poor outside.
    n = np.arange(17)
    start = to_spectrum(np.cos(3.0 * angles(32)))
    inside, outside = (
        advance_fixed(
            Split(np.zeros(17, dtype=complex), lambda v, t: -1j * n * v, frame), start, (0.0, 1.0), 4, method
        )
        for frame in (1.0, 0.0)
    )
    exact = np.cos(3.0 * (angles(32) - 1.0))
    assert relative(np.fft.irfft(inside.spectrum), exact) < 1e-14
    assert relative(np.fft.irfft(outside.spectrum), exact) > 1e-4


@pytest.mark.parametrize("method", METHODS)
def test_linear_part_is_exact_for_any_step(method: str) -> None:
    n = np.arange(33)
    symbol = 1j * n.astype(complex) ** 3 - 0.1 * n**2
    start = to_spectrum(WAVE.profile(angles(64)))
    done = advance_fixed(Split(symbol, lambda v, t: 0.0 * v, 5.0), start, (0.0, 2.0), 1, method)
    assert np.allclose(done.spectrum, np.exp(2.0 * symbol) * start, rtol=1e-13, atol=0.0)


@pytest.mark.parametrize("method", METHODS)
def test_without_linear_part_it_is_the_classical_runge_kutta_method(method: str) -> None:
    """y' = -2 t y: one step against the four stages written out."""
    h, y, slope = 0.3, 0.8, lambda t, y: -2.0 * t * y
    k1 = slope(0.1, y)
    k2 = slope(0.1 + h / 2, y + h / 2 * k1)
    k3 = slope(0.1 + h / 2, y + h / 2 * k2)
    k4 = slope(0.1 + h, y + h * k3)
    split = Split(np.zeros(1, dtype=complex), lambda v, t: -2.0 * t * v)
    done = advance_fixed(split, np.array([0.8 + 0j]), (0.1, 0.1 + h), 1, method)
    # Krogstad's third stage mixes the two slopes at the middle, which agree to second order.
    want = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    assert done.spectrum[0] == pytest.approx(want, rel=1e-14)


@kills("solvers.waves.stepper:phi_functions", "(phi_2 - 0.5) / large", "(phi_2 - 1.0) / large")
@kills("solvers.waves.stepper:phi_functions", "math.factorial(j + k)", "math.factorial(j)")
def test_phi_functions() -> None:
    radii = np.array([0.0, 1e-9, 1e-3, 0.3, 0.999, 1.001, 3.0, 40.0, 500.0])
    z = (radii[:, None] * np.exp(1j * np.array([0.5, 0.75, 1.0, 1.3, 1.5]) * np.pi)).ravel()
    with mpmath.workdps(60):

        def phi(k: int, w: complex) -> complex:
            if w == 0.0:
                return 1.0 / math.factorial(k)
            w = mpmath.mpc(w)
            terms = sum(w**j / mpmath.factorial(j) for j in range(k))
            return complex((mpmath.exp(w) - terms) / w**k)

        for k, found in enumerate(phi_functions(z), start=1):
            want = np.array([phi(k, w) for w in z])
            # Outside the unit circle each of three subtractions may double the rounding.
            assert np.max(np.abs(found - want) / np.abs(want)) < 16.0 * np.finfo(float).eps


@pytest.mark.parametrize("method", METHODS)
def test_weights_integrate_a_constant(method: str) -> None:
    """v' = L v + 1 from 0 ends at (e^{L h} - 1)/L, for exponential time differencing at every step."""
    symbol = np.array([-0.2, -1.5 + 2.0j, 0.4j, -30.0])
    steps = 200 if method == "ifrk4" else 1
    done = advance_fixed(
        Split(symbol, lambda v, t: np.ones(4, dtype=complex)), np.zeros(4, complex), (0, 0.7), steps, method
    )
    # The integrating factor does it to fourth order: (30 x 0.7/200)^4/2880.
    assert np.allclose(done.spectrum, np.expm1(0.7 * symbol) / symbol, rtol=1e-6 if steps > 1 else 1e-14)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_adaptive_steps_reach_the_tolerance(method: str, tolerance: float) -> None:
    split, x = manufactured(24)
    start = to_spectrum(manufactured_field(x, 0.0))
    done = advance_adaptive(split, start, (0.0, 2.0), Control(tolerance), method)
    assert done.status == "finished" and done.time == 2.0
    error = relative(np.fft.irfft(done.spectrum), manufactured_field(x, 2.0))
    assert error < tolerance
    assert done.steps > 5 and 0.0 < done.smallest_step < 1.0
    # The error estimate is of third order, so a hundredth of the tolerance takes sqrt(10) times the steps; a
    # ladder of steps with ratio 2^(1/4) and the start leave some play.
    finer = advance_adaptive(split, start, (0.0, 2.0), Control(tolerance / 100), method)
    assert 2.0 < finer.steps / done.steps < 4.5


def test_adaptive_soliton_reaches_the_tolerance() -> None:
    x = angles(64)
    for method in METHODS:
        for tolerance in (1e-5, 1e-7):
            start = to_spectrum(WAVE.profile(x))
            done = advance_adaptive(kdv(64, 0.5 * SPEED), start, (0.0, 0.3), Control(tolerance), method)
            assert done.largest_error <= tolerance
            error = relative(np.fft.irfft(done.spectrum), WAVE.profile(x, 0.3))
            assert error < tolerance, method


@pytest.mark.parametrize("method", METHODS)
def test_mass_is_kept_to_rounding_and_momentum_to_the_order(method: str) -> None:
    points = 64
    start = to_spectrum(WAVE.profile(angles(points)))
    drift = []
    for steps in (150, 300):
        done = advance_fixed(kdv(points), start, (0.0, 0.1), steps, method)
        assert abs(done.spectrum[0] - start[0]) <= 1e-14 * np.max(np.abs(start))
        values = np.fft.irfft(done.spectrum)
        drift.append(abs(np.sum(values**2) / np.sum(np.fft.irfft(start) ** 2) - 1.0))
    assert drift[0] / drift[1] > 2.0 ** (find_method(method).order - 0.2)
    assert drift[1] < 1e-5


def test_stiffness_costs_no_steps() -> None:
    """512 points: steps 7000 times what an explicit method could take."""
    points, stop, steps = 512, 0.5, 400
    explicit = 2.8 / (points / 2) ** 3
    assert stop / steps > 7000.0 * explicit
    x = angles(points)
    done = advance_fixed(kdv(points, 0.9 * SPEED), to_spectrum(WAVE.profile(x)), (0.0, stop), steps, DEFAULT)
    assert relative(np.fft.irfft(done.spectrum), WAVE.profile(x, stop)) < 1e-6


def test_steps_shrink_when_something_happens_and_grow_again() -> None:
    """A push of 1/10 s in the middle of a quiet second."""

    def push(v: np.ndarray, t: float) -> np.ndarray:
        return np.array([0.0, math.exp(-(((t - 0.5) / 0.05) ** 2)), 0.0], dtype=complex)

    split = Split(np.array([0.0, -1.0 + 1.0j, -2.0]), push)
    done = advance_adaptive(split, np.ones(3, complex), (0.0, 1.0), Control(1e-6, first=0.2), DEFAULT)
    assert done.status == "finished" and done.rejected > 0
    assert done.smallest_step < 0.02 and done.next_step > 0.05
    # integral e^{(L)(1 - t)} push dt, by completing the square.
    lam, width = -1.0 + 1.0j, 0.05
    kick = math.sqrt(math.pi) * width * np.exp(0.5 * lam + 0.25 * (lam * width) ** 2)
    assert done.spectrum[1] == pytest.approx(np.exp(lam) + kick, rel=1e-5)


def explosion() -> Split:
    """v' = v^2 in the mean: 1/(1 - t)."""
    return Split(np.zeros(2, dtype=complex), lambda v, t: v * v)


def test_a_singularity_is_reported_not_returned() -> None:
    start = np.array([1.0 + 0j, 0.0])
    done = advance_adaptive(explosion(), start, (0.0, 2.0), Control(1e-6, shortest=1e-6), DEFAULT)
    assert done.status == "step too small"
    assert np.all(np.isfinite(done.spectrum))
    assert done.time == pytest.approx(1.0, abs=1e-3)
    fixed = advance_fixed(explosion(), start, (0.0, 20.0), 200, DEFAULT)
    assert fixed.status == "diverged"
    assert np.all(np.isfinite(fixed.spectrum)) and fixed.time < 3.0
    few = advance_adaptive(explosion(), start, (0.0, 0.9), Control(1e-10, most=20), DEFAULT)
    assert few.status == "too many steps" and few.steps + few.rejected == 20 and few.time < 0.9


@pytest.mark.parametrize("points", [16, 17, 30])
def test_square_has_no_aliases(points: int) -> None:
    rng = np.random.default_rng(3)
    top = (points - 1) // 2
    half = rng.normal(size=top + 1) + 1j * rng.normal(size=top + 1)
    half[0] = half[0].real
    both = np.concatenate((np.conj(half[:0:-1]), half))
    want = np.convolve(both, both)[2 * top : 3 * top + 1] / points
    spectrum = np.zeros(points // 2 + 1, dtype=complex)
    spectrum[: top + 1] = half
    found = squared(spectrum, points)
    assert np.allclose(found[: top + 1], want, rtol=1e-12)
    assert np.all(found[top + 1 :] == 0.0)


def test_rest_stays_at_rest() -> None:
    done = advance_adaptive(kdv(16), np.zeros(9, complex), (0.0, 1.0), Control(), DEFAULT)
    assert done.status == "finished" and np.all(done.spectrum == 0.0)


def test_step_weights_of_a_still_frame_are_those_of_the_method() -> None:
    symbol = np.array([-1.0 + 2.0j, -3.0, 4.0j])
    for method in METHODS.values():
        half, full, *weights, near, far = step_weights(symbol, 0.0, method, 0.2)
        assert np.allclose(half * half, full, rtol=1e-14)
        assert np.allclose(near * near, far, rtol=1e-14)
        for found, want in zip(weights, method.weights(0.2 * symbol), strict=True):
            assert np.allclose(found, 0.2 * want, rtol=1e-14)


def test_bad_input_is_named() -> None:
    start = np.zeros(9, complex)
    with pytest.raises(InputError, match="method"):
        advance_fixed(kdv(16), start, (0.0, 1.0), 1, "euler")
    with pytest.raises(InputError, match="steps"):
        advance_fixed(kdv(16), start, (0.0, 1.0), 0, DEFAULT)
    for span in ((1.0, 1.0), (0.0, math.nan), (2.0, 1.0)):
        with pytest.raises(InputError, match="span"):
            advance_adaptive(kdv(16), start, span, Control(), DEFAULT)
    with pytest.raises(InputError, match="tolerance"):
        Control(0.0)
    with pytest.raises(InputError, match="first"):
        Control(first=-1.0)


@kills("solvers.waves.stepper:_step", "+ _BEND * bend", "+ 0.0 * bend")
def test_a_rest_that_depends_on_time_alone_is_followed() -> None:
    """v' = cos(9 t) from 0: the stages agree at any step, only the bend of N tells."""
    split = Split(np.zeros(1, dtype=complex), lambda v, t: np.array([math.cos(9.0 * t) + 0j]))
    for tolerance in (1e-3, 1e-5, 1e-7):
        done = advance_adaptive(split, np.zeros(1, complex), (0.0, 5.0), Control(tolerance), DEFAULT)
        # The tolerance is over the field as it is in each step, at most 1/9.
        assert abs(done.spectrum[0] - math.sin(45.0) / 9.0) < tolerance / 9.0


@kills(
    "solvers.waves.stepper:_end_weights",
    "phi_1 - 3.0 * phi_2 + 4.0 * phi_3",
    "phi_1 - 3.0 * phi_2 + 2.0 * phi_3",
)
@kills("solvers.waves.stepper:_end_weights", "4.0 * phi_3 - phi_2", "4.0 * phi_3 + phi_2")
@kills("solvers.waves.stepper:_cox_matthews", "0.5 * half * np.expm1(0.5 * z)", "half * np.expm1(0.5 * z)")
@kills("solvers.waves.stepper:_krogstad", "full - 2.0 * full_2, 2.0 * full_2", "full - full_2, full_2")
@kills(
    "solvers.waves.stepper:_integrating_factor",
    "half * half / 6.0, half / 3.0",
    "half * half / 6.0, half / 2.0",
)
@kills("solvers.waves.stepper:step_weights", "symbol + turn", "symbol - turn")
@kills("solvers.waves.stepper:step_weights", "near * b2", "b2")
@kills("solvers.waves.stepper:_step", "w.b2 * (n2 + n3)", "w.b2 * (n2 + n2)")
@kills(
    "solvers.waves.stepper:_step", "w.a41 * n1 + w.a43 * n3, t + h)", "w.a41 * n1 + w.a43 * n3, t + 0.5 * h)"
)
def test_phases() -> None:
    """Weights and stages with a frame, a moving wave and a source: order 4 has nothing left to hide in."""
    for method in METHODS:
        errors = [manufactured_error(method, steps) for steps in (20, 40)]
        assert math.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.2), method
        assert errors[1] < 1e-6, method


@kills("solvers.waves.stepper:squared", "3 * points // 2", "points")
def test_square_of_sixteen_points_has_no_aliases() -> None:
    test_square_has_no_aliases(16)
