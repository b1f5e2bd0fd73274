"""Waves as a py-pde equation: exact answers, other statements of the equation, what py-pde users expect."""

from __future__ import annotations

import copy
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pde import PDE, CallbackTracker, CartesianGrid, DataTracker, MemoryStorage, ScalarField, UnitGrid
from pde.solvers import registered_solvers
from pde.solvers.base import ConvergenceError

from fluid.exact import TravellingWave, burgers_sawtooth, cnoidal_wave, solitary_wave
from fluid.kdv import KdvCoefficients, coefficients, wave_frequency
from fluid.waves import free_wave_frequencies
from meshes.border import InputError
from solvers.stepper import advance_fixed, squared, to_spectrum
from solvers.wave_pde import ExponentialSolver, KdvBurgersPDE, circle
from solvers.wave_terms import WaveTerms, wave_split

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


def assert_sawtooth() -> None:
    """Viscosity with steepening: a shock that runs round and decays."""
    c = replace(PROGRADE, dispersion=0.0)
    grid, viscosity = circle(256), 0.1
    theta = grid.axes_coords[0]
    start, stop = 0.5, 1.0
    state = ScalarField(grid, burgers_sawtooth(c, viscosity, start, theta))
    found = solved(KdvBurgersPDE(c, viscosity=viscosity), state, (start, stop), dt=2e-3)
    # The initial shock's modes fall as e^{-n/20}: 1.7e-3 at mode 128.
    assert relative(found, burgers_sawtooth(c, viscosity, stop, theta)) < 1e-5


def test_sawtooth() -> None:
    assert_sawtooth()


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


def assert_push() -> None:
    """A layer at rest rises at -q sin(theta - s t): ahead of the deflection it is drained."""
    grid = circle(32)
    theta, t, q, s = grid.axes_coords[0], 0.4, 2e-4, 7.0
    rate = KdvBurgersPDE(PROGRADE, forcing=q, whirl_speed=s).evolution_rate(ScalarField(grid, 0.0), t)
    assert np.allclose(rate.data, -q * np.sin(theta - s * t), rtol=0.0, atol=1e-15 * q * 32)


def test_push_on_a_layer_at_rest() -> None:
    assert_push()


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


def assert_decay() -> None:
    """Mode n falls as e^{-(gamma + nu n^2) t}."""
    c, gamma, nu, stop = LINEAR[0], 0.7, 0.05, 0.9
    points = 32
    grid = circle(points)
    for n in (1, 2, 7):
        start = ScalarField(grid, np.cos(n * grid.axes_coords[0]))
        found = solved(KdvBurgersPDE(c, viscosity=nu, damping=gamma), start, stop, dt=0.3)
        fall = np.abs(np.fft.rfft(found))[n] / (points / 2)
        assert fall == pytest.approx(math.exp(-(gamma + nu * n**2) * stop), rel=1e-12)


def test_modes_decay() -> None:
    assert_decay()


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


def rate_here(c: KdvCoefficients, state: ScalarField) -> np.ndarray:
    return np.asarray(KdvBurgersPDE(c).evolution_rate(state).data)


def rate_of_symbol(c: KdvCoefficients, state: ScalarField) -> np.ndarray:
    """The equation as its symbol and its square, by hand."""
    points = state.data.size
    n = np.arange(points // 2 + 1)
    v = to_spectrum(state.data)
    linear = (-1j * c.linear_speed * n - c.dispersion * (1j * n) ** 3) * v
    return np.fft.irfft(linear - 0.5j * c.steepening * n * squared(v, points))


def rate_of_whitham(c: KdvCoefficients, state: ScalarField) -> np.ndarray:
    """The Whitham equation, its frequencies exchanged for KdV's."""
    n = np.arange(state.data.size // 2 + 1)
    shift = 1j * (wave_frequency(n, c, True) - wave_frequency(n, c, False))
    rate = KdvBurgersPDE(c, whitham=True).evolution_rate(state).data
    return np.asarray(rate + np.fft.irfft(shift * to_spectrum(state.data)))


def text(c: KdvCoefficients) -> PDE:
    """The equation as py-pde reads it; finite differences of second order."""
    consts = {"c": c.linear_speed, "a": c.steepening, "d": c.dispersion}
    return PDE({"u": "-c * d_dx(u) - a * u * d_dx(u) - d * d_dx(laplace(u))"}, consts=consts)


def rate_of_text(backend: str):  # type: ignore[no-untyped-def]
    def rate(c: KdvCoefficients, state: ScalarField) -> np.ndarray:
        return np.asarray(text(c).make_pde_rhs(state, backend=backend)(state.data.copy(), 0.0))

    return rate


# Each with its order in space, None for a spectral one, and the families it is tried on: py-pde compiles a
# text for seconds, whatever the backend.
STATEMENTS = {
    "coefficients": (rate_here, None, FAMILIES),
    "symbol": (rate_of_symbol, None, FAMILIES),
    "whitham with the symbol of kdv": (rate_of_whitham, None, FAMILIES),
    "py-pde text, numpy": (rate_of_text("numpy"), 2, [RETROGRADE]),
    "py-pde text, scipy": (rate_of_text("scipy"), 2, [PROGRADE]),
}


@pytest.mark.parametrize("statement", STATEMENTS)
def test_statements_of_one_equation_agree(statement: str) -> None:
    """Each gives the rate -V eta' of the cnoidal wave, to rounding or to its order."""
    rate, order, families = STATEMENTS[statement]
    for c in families:
        wave, errors = hump(c, 1.5), []
        for points in (96, 192) if order is None else (192, 384):
            grid = circle(points)
            state = field(grid, wave)
            n = np.arange(points // 2 + 1)
            exact = np.fft.irfft(-1j * wave.speed * n * to_spectrum(state.data))
            errors.append(relative(rate(c, state), exact))
        if order is None:
            # delta n^3 over lambda0 multiplies rounding, by up to 2e3.
            assert max(errors) < 2e3 * 4.0 * np.finfo(float).eps
        else:
            assert errors[1] < 2e-3
            assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)


def test_text_of_py_pde_arrives_where_ours_does() -> None:
    """Finite differences in space: the two approach each other with the square of the spacing."""
    wave, stop, gaps = hump(PROGRADE, 1.5), 0.02, []
    for points in (32, 64):
        grid = circle(points)
        state = field(grid, wave)
        ours = solved(KdvBurgersPDE(PROGRADE), state, stop)
        # Stable up to 2.8/(lambda0/dx + 2.6 delta/dx^3), 9e-3 s.
        theirs = solved(text(PROGRADE), state, stop, solver="runge-kutta", backend="scipy", dt=1e-3)
        gaps.append(relative(theirs, ours))
    assert gaps[1] < 0.02
    assert math.log2(gaps[0] / gaps[1]) == pytest.approx(2.0, abs=0.3)


STOCK = {
    # First order leaves about (V n)^2 dt t/2, modes n up to 4; the others far less.
    "euler": ({"dt": 2e-5}, 2e-3),
    "adams-bashforth": ({"dt": 1e-4}, 1e-4),
    "runge-kutta": ({"dt": 1e-3}, 1e-6),
    "crank-nicolson": ({"dt": 1e-4, "maxiter": 1000, "maxerror": 1e-12}, 1e-4),
    "implicit": ({"dt": 2e-5, "maxiter": 1000, "maxerror": 1e-12}, 2e-3),
    "scipy": ({"method": "DOP853", "rtol": 1e-10, "atol": 1e-14}, 1e-8),
}


@pytest.mark.parametrize("solver", STOCK)
def test_stock_solvers_of_py_pde_work_and_agree(solver: str) -> None:
    options, allowed = STOCK[solver]
    state = field(circle(32), hump(PROGRADE, 1.0))
    eq = KdvBurgersPDE(PROGRADE, viscosity=0.01, damping=0.1, forcing=1e-4, whirl_speed=18.0)
    ours = solved(eq, state, 0.02, tolerance=1e-10)
    assert relative(solved(eq, state, 0.02, solver=solver, **options), ours) < allowed


def test_solver_is_registered_by_name_and_class() -> None:
    assert registered_solvers()["exponential"] is ExponentialSolver
    state = field(circle(32), hump(PROGRADE, 1.0))
    eq = KdvBurgersPDE(PROGRADE)
    by_name, by_class = (solved(eq, state, 0.05, solver=s) for s in ("exponential", ExponentialSolver))
    assert np.array_equal(by_name, by_class)
    assert eq.diagnostics["solver"]["status"] == "finished"
    assert eq.diagnostics["solver"]["steps"] > 0 and eq.diagnostics["solver"]["smallest_step"] > 0.0


@pytest.mark.parametrize("options", [{}, {"dt": 3e-3}, {"dt": 0.5}])
def test_trackers_and_storage_see_the_wave_at_their_times(options: dict[str, float]) -> None:
    grid, wave = circle(64), hump(PROGRADE, 1.5)
    storage, heights, seen = MemoryStorage(), DataTracker(lambda s: {"crest": s.data.max()}, 0.05), []
    trackers = [
        storage.tracker(0.07),
        heights,
        CallbackTracker(lambda s, t: seen.append((t, s.data.copy())), interrupts=[0.011, 0.2, 0.203]),
    ]
    eq = KdvBurgersPDE(PROGRADE)
    eq.solve(field(grid, wave), 0.35, solver="exponential", tolerance=1e-7, tracker=trackers, **options)
    coarse = options.get("dt", 0.0) > 0.1
    # py-pde fires a tracker up to half of a given step early; the steps that land on times are its own.
    if not coarse:
        assert np.allclose(storage.times, np.arange(6) * 0.07, rtol=0.0, atol=1e-12)
        assert np.allclose([t for t, _ in seen], [0.011, 0.2, 0.203], rtol=0.0, atol=1e-12)
        assert np.allclose(heights.times, np.arange(8) * 0.05, rtol=0.0, atol=1e-12)
    for t, data in [*zip(storage.times, storage.data, strict=True), *seen]:
        assert relative(data, field(grid, wave, t).data) < (1e-5 if not coarse else 0.2)


def test_a_run_can_be_taken_up_again() -> None:
    grid, wave = circle(64), hump(RETROGRADE, 1.5)
    eq = KdvBurgersPDE(RETROGRADE, forcing=1e-4, whirl_speed=-9.0, damping=0.5)
    whole = solved(eq, field(grid, wave), (0.2, 0.6), tolerance=1e-9)
    half = eq.solve(field(grid, wave), (0.2, 0.37), solver="exponential", tolerance=1e-9, tracker=None)
    assert relative(solved(eq, half, (0.37, 0.6), tolerance=1e-9), whole) < 1e-8


def test_the_equation_can_be_copied() -> None:
    state = field(circle(32), hump(PROGRADE, 1.0))
    eq = KdvBurgersPDE(PROGRADE, whitham=True, viscosity=0.1)
    again = copy.deepcopy(eq)
    assert np.array_equal(again.evolution_rate(state).data, eq.evolution_rate(state).data)
    final, info = eq.solve(state, 0.01, solver="exponential", tracker=None, ret_info=True)
    assert info["solver"]["class"] == "ExponentialSolver" and final.grid == state.grid


def test_steps_do_not_follow_the_grid() -> None:
    """512 points, 4000 times the explicit step, in as many steps as 64 points take."""
    wave, counts = hump(PROGRADE, 1.5), []
    for points in (64, 512):
        grid = circle(points)
        eq = KdvBurgersPDE(PROGRADE)
        found = solved(eq, field(grid, wave), 0.5, tolerance=1e-5)
        assert relative(found, field(grid, wave, 0.5).data) < 1e-5
        counts.append(eq.diagnostics["solver"]["steps"])
    assert abs(counts[1] - counts[0]) <= 0.1 * counts[0]
    assert eq.diagnostics["solver"]["smallest_step"] > 200.0 * 2.8 / (PROGRADE.dispersion * 256.0**3)


def test_nothing_is_compiled() -> None:
    script = """
import sys
from fluid.exact import cnoidal_wave
from fluid.kdv import coefficients
from solvers.wave_pde import KdvBurgersPDE, circle
from pde import MemoryStorage, ScalarField
c = coefficients(0.15, 0.135, 40.0, 1)
grid = circle(32)
state = ScalarField(grid, cnoidal_wave(c, 1e-5).profile(grid.axes_coords[0]))
eq = KdvBurgersPDE(c, viscosity=0.1)
for options in ({"solver": "exponential"}, {"solver": "exponential", "backend": "numpy", "dt": 1e-3},
                {"solver": "runge-kutta", "dt": 1e-4}, {"solver": "scipy"}):
    eq.solve(state, 0.002, tracker=MemoryStorage().tracker(0.001), **options)
assert not {"numba", "llvmlite", "jax", "torch"} & set(sys.modules), "compiled"
"""
    root = Path(__file__).parents[2]
    subprocess.run([sys.executable, "-c", script], cwd=root, check=True)


def test_solving_without_py_pde() -> None:
    """The split alone is enough for the steppers, on points that start anywhere."""
    wave, first = hump(PROGRADE, 1.5), 0.3
    theta = first + 2.0 * np.pi * np.arange(64) / 64
    terms = WaveTerms(PROGRADE, forcing=1e-5, whirl_speed=17.0)
    done = advance_fixed(
        wave_split(terms, 64, first), to_spectrum(wave.profile(theta)), (0.0, 0.1), 100, "krogstad"
    )
    grid = circle(64)
    ours = solved(KdvBurgersPDE(PROGRADE, forcing=1e-5, whirl_speed=17.0), field(grid, wave), 0.1, dt=1e-3)
    n = np.arange(33)
    shifted = np.fft.irfft(np.fft.rfft(ours) * np.exp(1j * n * (first - grid.axes_coords[0][0])))
    assert relative(np.fft.irfft(done.spectrum), shifted) < 1e-9


def test_failure_is_an_exception_with_the_time() -> None:
    state = field(circle(128), hump(PROGRADE, 6.0))
    eq = KdvBurgersPDE(PROGRADE)
    with pytest.raises(ConvergenceError, match="diverged at t ="):
        solved(eq, state, 1.0, dt=0.05)
    assert eq.diagnostics["solver"]["status"] == "diverged"


def test_bad_input_is_named() -> None:
    eq, state = KdvBurgersPDE(PROGRADE), ScalarField(circle(16), 0.0)
    for options, named in (
        ({"method": "rk4"}, "method"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"dt": -1.0}, "dt"),
    ):
        with pytest.raises(InputError, match=named):
            solved(eq, state, 1.0, **options)
    for grid in (UnitGrid([16], periodic=True), CartesianGrid([[0, 2 * math.pi]], 16), UnitGrid([4, 4])):
        with pytest.raises(InputError, match="grid"):
            eq.evolution_rate(ScalarField(grid, 0.0))
    with pytest.raises(InputError, match="pde"):
        solved(PDE({"u": "laplace(u)"}), state, 1.0)
    with pytest.raises(InputError, match="points"):
        circle(4)
    with pytest.raises(InputError, match="points"):
        wave_split(WaveTerms(PROGRADE), 7)
    for bad in ({"viscosity": -1.0}, {"damping": math.nan}, {"forcing": math.inf}, {"whirl_speed": math.nan}):
        with pytest.raises(InputError, match=next(iter(bad))):
            KdvBurgersPDE(PROGRADE, **bad)
