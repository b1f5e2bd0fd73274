"""Solitary and cnoidal waves, shocks: they solve their equation, and their relations hold."""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import chebyshev

from fluid.exact import cnoidal_wave
from fluid.kdv import KdvCoefficients, coefficients
from meshes.errors import InputError
from tests.mutants import kills
from tests.oracles.exact import burgers_sawtooth, burgers_shock, solitary_wave

PROGRADE = coefficients(0.15, 0.135, 40.0, 1)
RETROGRADE = coefficients(0.15, 0.135, 40.0, -1)
# A wave over level ground in the textbook's units, and its mirror images.
PLAIN = replace(PROGRADE, linear_speed=0.7, steepening=6.0, dispersion=1.0)
SIGNS = [replace(PLAIN, steepening=6.0 * a, dispersion=1.0 * d) for a in (1, -1) for d in (1, -1)]
FAMILIES = [PROGRADE, RETROGRADE, *SIGNS]


def height_for(c: KdvCoefficients, sharpness: float) -> float:
    """Height of the solitary wave as sharp as that."""
    return 12.0 * c.dispersion * sharpness**2 / c.steepening


def angles(points: int) -> np.ndarray:
    return 2.0 * np.pi * np.arange(points) / points


def derivative(values: np.ndarray, order: int) -> np.ndarray:
    n = np.arange(values.size // 2 + 1)
    return np.fft.irfft((1j * n) ** order * np.fft.rfft(values), n=values.size)


def assert_travels(c: KdvCoefficients, sharpness: float, crests: int, mean: float) -> None:
    """(lambda0 - V) eta' + alpha eta eta' + delta eta''' = 0, with the derivatives of a Fourier series."""
    wave = cnoidal_wave(c, height_for(c, sharpness), crests, mean * height_for(c, sharpness))
    points = (
        384  # modes of the sharpest wave here, 8, have fallen to e^{-pi 192/16} = 4e-17 at half the points
    )
    eta = wave.profile(angles(points))
    third = c.dispersion * derivative(eta, 3)
    steep = c.steepening * eta * derivative(eta, 1)
    residual = (c.linear_speed - wave.speed) * derivative(eta, 1) + steep + third
    # The third derivative multiplies the rounding of eta by up to (points / 2)^3.
    rounding = 8.0 * np.finfo(float).eps * (points / 2) ** 3 * np.max(np.abs(c.dispersion * eta))
    speeding = 1e-10 * np.max(np.abs(third))
    assert np.max(np.abs(residual)) < rounding + speeding


@pytest.mark.parametrize("c", FAMILIES)
@pytest.mark.parametrize(
    ("sharpness", "crests"), [(0.2, 1), (1.0, 1), (1.7, 2), (2.2, 1), (6.0, 1), (5.0, 2)]
)
def test_cnoidal_wave_solves_the_equation(c: KdvCoefficients, sharpness: float, crests: int) -> None:
    assert_travels(c, sharpness, crests, 0.0)


@settings(max_examples=25)
@given(
    alpha=st.floats(0.1, 100.0),
    delta=st.floats(1e-3, 10.0),
    speed=st.floats(-20.0, 20.0),
    sharpness=st.floats(0.05, 8.0),
    crests=st.integers(1, 3),
    mean=st.floats(-1.0, 1.0),
)
def test_any_cnoidal_wave_solves_the_equation(
    alpha: float, delta: float, speed: float, sharpness: float, crests: int, mean: float
) -> None:
    c = replace(PLAIN, linear_speed=speed, steepening=alpha, dispersion=delta)
    assert_travels(c, sharpness, crests, mean)


@pytest.mark.parametrize("c", FAMILIES)
@pytest.mark.parametrize("crests", [1, 3])
@pytest.mark.parametrize("sharpness", [1e-3, 0.5, 2.0, 4.0, 9.0])
def test_height_and_mean_are_those_asked_for(c: KdvCoefficients, crests: int, sharpness: float) -> None:
    height = height_for(c, sharpness)
    wave = cnoidal_wave(c, height, crests, mean=0.3 * height)
    eta = wave.profile(
        angles(240 * crests)
    )  # an even number of points in each crest: crest and trough are hit
    # A sum over 240 points integrates a wave with sharpness 9 to e^{-pi^2 240/(2 pi 9)}, 1e-18.
    assert np.mean(eta) == pytest.approx(0.3 * height, abs=1e-13 * abs(height))
    assert eta[0] - eta[120] == pytest.approx(height, rel=1e-12)


def test_cnoidal_wave_matches_mpmath() -> None:
    """Profile and speed against elliptic functions in 40 digits, also where 1 - m is below rounding."""
    with mpmath.workdps(40):
        for sharpness, crests in ((0.1, 1), (1.0, 1), (2.3, 1), (2.5, 1), (7.0, 1), (9.0, 2)):
            target = mpmath.mpf(sharpness) ** 2 * (mpmath.pi / crests) ** 2
            # m K(m)^2 = target, solved for y = log(m/(1 - m)).
            logistic = lambda y: 1 / (1 + mpmath.exp(-y))  # noqa: E731
            y = mpmath.findroot(
                lambda y: mpmath.log(logistic(y) * mpmath.ellipk(logistic(y)) ** 2 / target),  # noqa: B023
                (-6.0, 2.0 * float(mpmath.sqrt(target)) - 2.0),
                solver="anderson",
            )
            m = logistic(y)
            k = mpmath.ellipk(m)
            kappa = crests * k / mpmath.pi
            level = -(mpmath.ellipe(m) / k - (1 - m)) / m
            height = height_for(PLAIN, sharpness)
            wave = cnoidal_wave(PLAIN, height, crests)
            x = np.linspace(-np.pi / crests, np.pi / crests, 9)
            want = [level + mpmath.ellipfun("cn", kappa * mpmath.mpf(float(v)), m=m) ** 2 for v in x]
            assert np.allclose(wave.profile(x) / height, np.array(want, dtype=float), rtol=0.0, atol=2e-14)
            speed = (
                PLAIN.linear_speed
                + PLAIN.steepening * height * level
                + 4 * PLAIN.dispersion * kappa**2 * (2 * m - 1)
            )
            assert wave.speed == pytest.approx(float(speed), rel=1e-13)


@pytest.mark.parametrize("c", FAMILIES)
def test_low_cnoidal_wave_is_a_linear_wave(c: KdvCoefficients) -> None:
    sharpness, crests = 1e-4, 3
    height = height_for(c, sharpness)
    wave = cnoidal_wave(c, height, crests)
    theta = angles(48)
    # The next harmonic and the shift of the speed are of the order m = (2 sharpness/crests)^2 = 4e-9.
    assert np.allclose(
        wave.profile(theta), 0.5 * height * np.cos(crests * theta), atol=1e-8 * abs(height), rtol=0
    )
    assert wave.speed == pytest.approx(c.linear_speed - c.dispersion * crests**2, rel=1e-7)


@pytest.mark.parametrize("c", FAMILIES)
def test_high_cnoidal_wave_is_a_solitary_wave(c: KdvCoefficients) -> None:
    height = height_for(c, 12.0)
    wave, single = cnoidal_wave(c, height), solitary_wave(c, height, mean_zero=True)
    theta = angles(200)
    assert np.allclose(wave.profile(theta), single.profile(theta), atol=1e-13 * abs(height), rtol=0.0)
    assert wave.speed == pytest.approx(single.speed, rel=1e-13)
    assert wave.sharpness == pytest.approx(single.sharpness, rel=1e-13)


def test_solitary_wave() -> None:
    """Amplitude, width and speed: u = 2 k^2 sech^2 k(x - 4 k^2 t) solves u_t + 6 u u_x + u_xxx = 0."""
    k = 1.3
    wave = solitary_wave(PLAIN, 2.0 * k**2)
    assert wave.sharpness == pytest.approx(k, rel=1e-14)
    assert wave.speed - PLAIN.linear_speed == pytest.approx(4.0 * k**2, rel=1e-14)
    x = 0.37
    assert float(wave.profile(x + 0.2 * wave.speed, 0.2)) == pytest.approx(2 * k**2 / math.cosh(k * x) ** 2)
    lowered = solitary_wave(PLAIN, 2.0 * k**2, mean_zero=True)
    points = 4096
    theta = angles(points) - math.pi
    # The midpoint rule on a profile with a kink of slope 2 H k e^{-2 pi k} at the cut.
    assert np.mean(lowered.profile(theta)) == pytest.approx(0.0, abs=1e-6)
    # A level carries the wave along.
    assert lowered.speed - wave.speed == pytest.approx(6.0 * lowered.level, rel=1e-12)


def test_taller_prograde_humps_run_faster_and_retrograde_ones_too() -> None:
    for c in (PROGRADE, RETROGRADE):
        low, high = (solitary_wave(c, height_for(c, s)) for s in (2.0, 3.0))
        assert high.height > low.height > 0.0
        assert high.speed / c.linear_speed > low.speed / c.linear_speed > 1.0


@pytest.mark.parametrize("sharpness", [60.0, 100.0])
def test_needles_stay_finite(sharpness: float) -> None:
    wave = cnoidal_wave(PLAIN, height_for(PLAIN, sharpness))
    assert np.all(np.isfinite(wave.profile(angles(64))))
    assert np.all(np.isfinite(solitary_wave(PLAIN, wave.height).profile(angles(64))))


def on_chebyshev(function, low: float, high: float, degree: int = 60):  # type: ignore[no-untyped-def]
    """A function on an interval as a Chebyshev series."""
    return chebyshev.Chebyshev.interpolate(function, degree, domain=[low, high])


def assert_shock(c: KdvCoefficients) -> None:
    drop, viscosity = math.copysign(1.4, c.steepening), 1.0
    t, theta = 0.45, np.linspace(-0.6, 1.2, 21)
    in_space = on_chebyshev(lambda x: burgers_shock(c, viscosity, drop, x, t), -0.7, 1.3)
    slope, bend = in_space.deriv(1)(theta), in_space.deriv(2)(theta)
    rate = [
        on_chebyshev(lambda s: burgers_shock(c, viscosity, drop, x, s), 0.0, 1.0).deriv(1)(t)  # noqa: B023
        for x in theta
    ]
    eta = burgers_shock(c, viscosity, drop, theta, t)
    residual = rate + c.linear_speed * slope + c.steepening * eta * slope - viscosity * bend
    # The second derivative of a series of degree 60 loses 60^4/3 of its rounding.
    assert np.max(np.abs(residual)) < 60.0**4 / 3.0 * 4e-16
    behind, ahead = burgers_shock(c, viscosity, drop, np.array([-40.0, 40.0]), 0.0)
    assert behind - ahead == pytest.approx(drop)


@pytest.mark.parametrize("c", SIGNS)
def test_shock_solves_burgers_equation(c: KdvCoefficients) -> None:
    assert_shock(c)


def assert_sawtooth(c: KdvCoefficients, viscosity: float, age: float) -> None:
    points = 1536  # the thinnest shock here has modes that fall as e^{-n/20}
    theta = angles(points)
    eta = burgers_sawtooth(c, viscosity, age, theta)
    ages = (0.9 * age, 1.1 * age)
    rate = [
        on_chebyshev(lambda s: burgers_sawtooth(c, viscosity, s, x), *ages).deriv(1)(age)  # noqa: B023
        for x in theta[::48]
    ]
    slope, bend = derivative(eta, 1), derivative(eta, 2)
    rest = c.linear_speed * slope + c.steepening * eta * slope - viscosity * bend
    assert np.max(np.abs(np.array(rate) + rest[::48])) < 1e-8 * np.max(np.abs(rest))
    assert abs(np.mean(eta)) < 1e-14 * np.max(np.abs(eta))


@pytest.mark.parametrize("c", SIGNS)
@pytest.mark.parametrize(("viscosity", "age"), [(0.1, 0.5), (0.5, 1.0), (1.0, 3.0)])
def test_sawtooth_solves_burgers_equation(c: KdvCoefficients, viscosity: float, age: float) -> None:
    assert_sawtooth(c, viscosity, age)


def test_thin_sawtooth_has_the_shock_in_it() -> None:
    viscosity, age = 0.01, 0.5
    drop = 2.0 * np.pi / (PLAIN.steepening * age)
    x = np.linspace(-0.02, 0.02, 9)
    saw = burgers_sawtooth(PLAIN, viscosity, age, np.pi + PLAIN.linear_speed * age + x)
    ramp = x / (PLAIN.steepening * age)
    assert np.allclose(saw - ramp, burgers_shock(PLAIN, viscosity, drop, x, 0.0), rtol=0.0, atol=1e-12)


def test_bad_input_is_named() -> None:
    with pytest.raises(InputError, match="height"):
        cnoidal_wave(PLAIN, -1.0)
    with pytest.raises(InputError, match="height"):
        cnoidal_wave(PLAIN, math.nan)
    with pytest.raises(InputError, match="at most"):
        cnoidal_wave(PLAIN, height_for(PLAIN, 200.0))
    with pytest.raises(InputError, match="crests"):
        cnoidal_wave(PLAIN, 1.0, 0)


@kills("fluid.exact:_sharpness_squared", "height / (12.0 * c.dispersion)", "height / (6.0 * c.dispersion)")
@kills("fluid.exact:cnoidal_wave", "sharpness**2 * (m - m1)", "sharpness**2 * (m1 - m)")
@kills("fluid.exact:cnoidal_wave", "level + 4.0 * c.disp", "level + 2.0 * c.disp")
@kills("fluid.exact:_mean_square_cn", "mean -= weight", "mean += weight")
@kills("fluid.exact:TravellingWave.profile", "- scale / k", "+ scale / k")
def test_cnoidal_waves_of_three_shapes() -> None:
    for sharpness, crests in ((1.0, 1), (2.2, 2), (6.0, 1)):
        assert_travels(PROGRADE, sharpness, crests, 0.2)
