"""The wave equations against their exact answers, each term by one that fails with it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from pde import PDE, CartesianGrid, ScalarField

from fluid.exact import TravellingWave, cnoidal_wave
from fluid.kdv import KdvCoefficients, coefficients
from fluid.waves import free_wave_frequencies
from solvers.pypde.grid import circle
from solvers.pypde.one_family import KdvBurgersPDE
from solvers.waves.modes import WaveTerms, wave_split
from solvers.waves.stepper import Control, advance_adaptive, advance_fixed, to_spectrum
from tests.mutants import kills
from tests.oracles.exact import burgers_sawtooth, solitary_wave

PROGRADE = coefficients(0.15, 0.135, 40.0, 1)
RETROGRADE = coefficients(0.15, 0.135, 40.0, -1)
FAMILIES = [PROGRADE, RETROGRADE]
# Waves small enough to be linear: no steepening at all.
LINEAR = [replace(c, steepening=0.0) for c in FAMILIES]


def hump(c: KdvCoefficients, sharpness: float = 3.0) -> TravellingWave:
    """A solitary wave that goes round."""
    return cnoidal_wave(c, 12.0 * c.dispersion * sharpness**2 / c.steepening)


def field(grid: CartesianGrid, wave: TravellingWave, t: float = 0.0) -> ScalarField:
    return ScalarField(grid, wave.profile(grid.axes_coords[0], t))


def relative(values: np.ndarray, exact: np.ndarray) -> float:
    return float(np.linalg.norm(values - exact) / np.linalg.norm(exact))


def solved(eq: PDE | KdvBurgersPDE, state: ScalarField, t: Any, **options: Any) -> np.ndarray:
    options = {"solver": "exponential", "tracker": None} | options
    return np.asarray(eq.solve(state, t, **options).data)


def assert_cnoidal(c: KdvCoefficients) -> None:
    """Shape and place of a cnoidal wave after half a second, one and a half (or three quarters of a) turn."""
    grid, wave = circle(64), hump(c, 1.5)
    found = solved(KdvBurgersPDE(c), field(grid, wave), 0.5, dt=5e-3)
    # Fourth order: halving the step takes the error from 4e-7 to 3e-8.
    assert relative(found, field(grid, wave, 0.5).data) < 1e-6


@pytest.mark.parametrize("c", FAMILIES)
def test_cnoidal_wave(c: KdvCoefficients) -> None:
    assert_cnoidal(c)


@pytest.mark.parametrize("c", FAMILIES)
@pytest.mark.parametrize("method", ["etdrk4", "krogstad", "ifrk4"])
def test_solitary_wave_to_the_tolerance(c: KdvCoefficients, method: str) -> None:
    height = 12.0 * c.dispersion * 3.0**2 / c.steepening
    grid, wave = circle(128), solitary_wave(c, height, mean_zero=True)
    eq = KdvBurgersPDE(c)
    for tolerance in (1e-4, 1e-6):
        found = solved(eq, field(grid, wave), 1.0, method=method, tolerance=tolerance)
        # The tails cut off at the far side are 4 e^{-6 pi} = 3e-8 of the height.
        assert relative(found, field(grid, wave, 1.0).data) < tolerance + 3e-7
        assert eq.diagnostics["solver"]["largest_error"] <= tolerance


@kills("solvers.waves.modes:wave_split", "0.5j * terms.c.steepening", "1.0j * terms.c.steepening")
def test_sawtooth() -> None:
    """Viscosity with steepening: a shock that runs round and decays."""
    c = replace(PROGRADE, dispersion=0.0)
    grid, viscosity = circle(256), 0.1
    theta = grid.axes_coords[0]
    start, stop = 0.5, 1.0
    state = ScalarField(grid, burgers_sawtooth(c, viscosity, start, theta))
    found = solved(KdvBurgersPDE(c, viscosity=viscosity), state, (start, stop), dt=2e-3)
    # The initial shock's modes fall as e^{-n/20}: 1.7e-3 at mode 128.
    assert relative(found, burgers_sawtooth(c, viscosity, stop, theta)) < 1e-5


def assert_forced_from_rest(c: KdvCoefficients, detuning: float) -> None:
    """Without steepening the forced wave has one mode, z' = l z + i q e^{-i s t}, eta = Re(z e^{i theta})."""
    grid, q, gamma, nu, stop = circle(16), 3e-4, 0.8, 0.3, 1.7
    s = c.linear_speed + detuning
    eq = KdvBurgersPDE(c, viscosity=nu, damping=gamma, forcing=q, whirl_speed=s)
    lam = -1j * (c.linear_speed - c.dispersion) - gamma - nu
    z = 1j * q * (np.exp(-1j * s * stop) - np.exp(lam * stop)) / (-1j * s - lam)
    exact = np.real(z * np.exp(1j * grid.axes_coords[0]))
    # In the frame of the whirl the forcing stands still: any step is exact; elsewhere the tolerance holds.
    assert relative(solved(eq, ScalarField(grid, 0.0), stop, dt=0.1), exact) < 1e-12
    assert relative(solved(eq, ScalarField(grid, 0.0), stop, tolerance=1e-6, frame=0.0), exact) < 1e-6


@pytest.mark.parametrize("c", LINEAR)
@pytest.mark.parametrize("detuning", [-2.0, 0.0, 5.0])
def test_forced_from_rest(c: KdvCoefficients, detuning: float) -> None:
    assert_forced_from_rest(c, detuning)


@kills("solvers.waves.modes:wave_split", "0.5j * terms.forcing", "-0.5j * terms.forcing")
@kills("solvers.waves.modes:wave_split", "np.exp(1j * first_angle)", "np.exp(-1j * first_angle)")
def test_push_on_a_layer_at_rest() -> None:
    """A layer at rest rises at -q sin(theta - s t): ahead of the deflection it is drained."""
    grid = circle(32)
    theta, t, q, s = grid.axes_coords[0], 0.4, 2e-4, 7.0
    rate = KdvBurgersPDE(PROGRADE, forcing=q, whirl_speed=s).evolution_rate(ScalarField(grid, 0.0), t)
    assert np.allclose(rate.data, -q * np.sin(theta - s * t), rtol=0.0, atol=1e-15 * q * 32)


def assert_linear_waves(c: KdvCoefficients, spin: float) -> None:
    """Every mode of a grid turns at exactly sigma(n)/n."""
    points, stop = 64, 0.37
    grid = circle(points)
    theta, n = grid.axes_coords[0], np.arange(1, points // 2)
    phase = 2.4 * n**2
    sigma = free_wave_frequencies(n, c.layer_log, spin)[0 if c.family == 1 else 1]

    def waves(t: float) -> np.ndarray:
        return np.sum(np.cos(n * (theta[:, None] - sigma / n * t) + phase), axis=1)

    found = solved(KdvBurgersPDE(c, whitham=True), ScalarField(grid, waves(0.0)), stop, dt=stop)
    # Phases are up to sigma t = 60 rad.
    assert relative(found, waves(stop)) < 60.0 * 8.0 * np.finfo(float).eps


@pytest.mark.parametrize("c", LINEAR)
def test_whitham_waves_run_at_their_exact_speed_at_every_mode(c: KdvCoefficients) -> None:
    assert_linear_waves(c, 40.0)


@kills("solvers.waves.modes:wave_split", "- terms.damping,", "+ terms.damping,")
@kills("solvers.waves.modes:wave_split", "- terms.viscosity *", "+ terms.viscosity *")
@kills("solvers.waves.modes:wave_split", "terms.viscosity * np.square(n)", "terms.viscosity * n")
def test_modes_decay() -> None:
    """Mode n falls as e^{-(gamma + nu n^2) t}."""
    c, gamma, nu, stop = LINEAR[0], 0.7, 0.05, 0.9
    points = 32
    grid = circle(points)
    for n in (1, 2, 7):
        start = ScalarField(grid, np.cos(n * grid.axes_coords[0]))
        found = solved(KdvBurgersPDE(c, viscosity=nu, damping=gamma), start, stop, dt=0.3)
        fall = np.abs(np.fft.rfft(found))[n] / (points / 2)
        assert fall == pytest.approx(math.exp(-(gamma + nu * n**2) * stop), rel=1e-12)


def test_a_steady_forced_wave_stays_as_it_is() -> None:
    """Near resonance with friction the wave settles in the frame of the whirl, and its energy balances."""
    c, gamma, nu, q = PROGRADE, 1.0, 0.02, 5e-5
    s = c.linear_speed + 0.5
    grid = circle(64)
    eq = KdvBurgersPDE(c, whitham=True, viscosity=nu, damping=gamma, forcing=q, whirl_speed=s)
    settled = solved(eq, ScalarField(grid, 0.0), 30.0, tolerance=1e-8)
    t = (30.0, 30.0 + 2.0 * math.pi / s)
    # e^{-gamma t} of the transient is left; a period later the field is the same.
    assert relative(solved(eq, ScalarField(grid, settled), t, tolerance=1e-8), settled) < 1e-7
    spectrum = np.fft.rfft(settled)
    n = np.arange(spectrum.size)
    lost = 2.0 * np.sum((gamma + nu * n**2) * np.abs(spectrum) ** 2) / 64**2
    won = -q * np.mean(settled * np.sin(grid.axes_coords[0] - s * 30.0))
    assert won == pytest.approx(lost, rel=1e-6)


def manufactured_gap(c: KdvCoefficients, steps: int) -> float:
    """Error of eta = a cos(theta - 2 t) + b sin(2 theta + 3 t), which all terms and a source in N keep."""
    a, b, q, s, gamma, nu = 2e-4, 1e-4, 3e-4, 1.1 * c.linear_speed, 0.6, 0.2
    points, stop = 24, 0.4
    theta = 2.0 * np.pi * np.arange(points) / points

    def field_at(t: float) -> np.ndarray:
        return a * np.cos(theta - 2.0 * t) + b * np.sin(2.0 * theta + 3.0 * t)

    def source(t: float) -> np.ndarray:
        one, two = theta - 2.0 * t, 2.0 * theta + 3.0 * t
        eta = field_at(t)
        first = -a * np.sin(one) + 2.0 * b * np.cos(two)
        second = -a * np.cos(one) - 4.0 * b * np.sin(two)
        third = a * np.sin(one) - 8.0 * b * np.cos(two)
        in_time = 2.0 * a * np.sin(one) + 3.0 * b * np.cos(two)
        waves = in_time + c.linear_speed * first + c.steepening * eta * first + c.dispersion * third
        return np.asarray(waves - nu * second + gamma * eta + q * np.sin(theta - s * t))

    plain = wave_split(WaveTerms(c, viscosity=nu, damping=gamma, forcing=q, whirl_speed=s), points)
    split = replace(plain, nonlinear=lambda v, t: plain.nonlinear(v, t) + to_spectrum(source(t)))
    done = advance_fixed(split, to_spectrum(field_at(0.0)), (0.0, stop), steps, "krogstad")
    return relative(np.fft.irfft(done.spectrum, points), field_at(stop))


@kills("solvers.waves.modes:wave_split", "terms.viscosity * np.square(n)", "terms.viscosity * n")
@kills("solvers.waves.modes:wave_split", "-0.5j * terms.c.steepening", "-0.4j * terms.c.steepening")
@kills("solvers.waves.modes:wave_split", "0.5j * terms.forcing", "-0.5j * terms.forcing")
def test_manufactured_field() -> None:
    """Steepening, dispersion, diffusion, decay and forcing together, to fourth order of the step."""
    for c in FAMILIES:
        errors = [manufactured_gap(c, steps) for steps in (100, 200)]
        assert errors[1] < 1e-5
        assert math.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.2)


def turned(turns: int, steps: int = 0, tolerance: float = 1e-6) -> tuple[float, float]:
    """Relative drift of the mass and of the energy of a tall wave that runs round undamped."""
    c = RETROGRADE
    wave = cnoidal_wave(c, 0.3 * c.mean_area, mean=0.03 * c.mean_area)
    start = to_spectrum(wave.profile(2.0 * np.pi * np.arange(64) / 64))
    span = (0.0, turns * 2.0 * math.pi / abs(wave.speed))
    split = wave_split(WaveTerms(c), 64)
    if steps:
        done = advance_fixed(split, start, span, steps, "krogstad")
    else:
        done = advance_adaptive(split, start, span, Control(tolerance), "krogstad")
    assert done.status == "finished"
    before, after = (float(v[0].real ** 2 + 2.0 * np.sum(np.abs(v[1:]) ** 2)) for v in (start, done.spectrum))
    return float(abs(done.spectrum[0] / start[0] - 1.0)), abs(after / before - 1.0)


@kills(
    "solvers.waves.modes:wave_split",
    "-0.5j * terms.c.steepening * n",
    "-0.5j * terms.c.steepening * np.maximum(n, 1)",
)
def test_invariants() -> None:
    """Mass to rounding, as its mode has no rate; the drift of energy falls with the step's fifth power."""
    coarse, fine = turned(4, 640), turned(4, 1280)
    for mass, _ in (coarse, fine):
        assert mass < 1e-15
    # What fourth order leaves only shifts the wave.
    assert fine[1] < 1e-5
    assert math.log2(coarse[1] / fine[1]) == pytest.approx(5.0, abs=0.3)


def test_invariants_of_a_wave_that_runs_round() -> None:
    # A hundred turns in 10 000 steps.
    mass, energy = turned(100, tolerance=1e-4)
    assert mass < 1e-15 and energy < 1e-3


@pytest.mark.slow
def test_invariants_at_a_fine_tolerance() -> None:
    mass, energy = turned(100, tolerance=1e-6)
    # A hundredth of the tolerance is a step of 1/sqrt(10), and 300 times less drift.
    assert mass < 1e-15 and energy < 1e-5


@pytest.mark.parametrize("c", FAMILIES)
@pytest.mark.parametrize("whitham", [False, True])
def test_mass_and_momentum(c: KdvCoefficients, whitham: bool) -> None:
    grid, wave = circle(128), hump(c)
    drift = []
    for dt in (2e-3, 1e-3):
        state = field(grid, wave) + 0.1 * wave.height
        found = solved(KdvBurgersPDE(c, whitham=whitham), state, 0.4, dt=dt)
        assert abs(np.mean(found) - np.mean(state.data)) < 1e-14 * abs(wave.height)
        drift.append(abs(np.mean(found**2) / np.mean(state.data**2) - 1.0))
    # Steps of fourth order: at least sixteenfold, less a tenth.
    assert drift[1] < 1e-8 and drift[0] / drift[1] > 14.0


@kills("solvers.waves.modes:wave_split", "-0.5j * terms.c.steepening", "0.5j * terms.c.steepening")
@kills(
    "solvers.waves.modes:wave_split",
    "wave_frequency(n, terms.c, terms.whitham)",
    "(2.0 * n * terms.c.linear_speed - wave_frequency(n, terms.c, terms.whitham))",
)
def test_prograde_cnoidal_wave() -> None:
    assert_cnoidal(PROGRADE)


@kills("solvers.waves.modes:wave_split", "-1j * omega", "1j * omega")
@kills(
    "solvers.waves.modes:wave_split",
    "wave_frequency(n, terms.c, terms.whitham)",
    "wave_frequency(n, terms.c, False)",
)
def test_linear_waves_of_both_families() -> None:
    for c in LINEAR:
        assert_linear_waves(c, 40.0)


@kills("solvers.waves.modes:wave_split", "0.5j * terms.forcing", "1.0j * terms.forcing")
@kills(
    "solvers.waves.modes:wave_split",
    "np.exp(-1j * terms.whirl_speed * t)",
    "np.exp(1j * terms.whirl_speed * t)",
)
def test_forced_from_rest_off_resonance() -> None:
    assert_forced_from_rest(LINEAR[0], 2.0)
