"""Waves as a py-pde equation: other statements of the equation, and what py-pde users expect."""

from __future__ import annotations

import copy
import importlib
import math
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest
from pde import PDE, CallbackTracker, CartesianGrid, DataTracker, MemoryStorage, ScalarField, UnitGrid
from pde.solvers import registered_solvers
from pde.solvers.base import ConvergenceError

from fluid.kdv import KdvCoefficients, wave_frequency
from meshes.errors import InputError
from solvers.pypde.grid import circle
from solvers.pypde.one_family import ExponentialSolver, KdvBurgersPDE
from solvers.waves.modes import WaveTerms, wave_split
from solvers.waves.stepper import advance_fixed, squared, to_spectrum
from tests.solvers.waves.test_terms import FAMILIES, PROGRADE, RETROGRADE, field, hump, relative, solved


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


@pytest.fixture
def interpreted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The operators of a text as Python, the same ones: py-pde compiles them for seconds on any backend."""
    # What these modules compile as they are loaded stays compiled for all.
    for name in (
        "backends.numba._boundaries",
        "backends.numba.operators.common",
        "tools.expressions",
        "tools.mpi",
    ):
        importlib.import_module(f"pde.{name}")
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)


# Each with its order in space, None for a spectral one.
STATEMENTS = {
    "coefficients": (rate_here, None),
    "symbol": (rate_of_symbol, None),
    "whitham with the symbol of kdv": (rate_of_whitham, None),
    "py-pde text, numpy": (rate_of_text("numpy"), 2),
    "py-pde text, scipy": (rate_of_text("scipy"), 2),
}


@pytest.mark.usefixtures("interpreted")
@pytest.mark.parametrize("statement", STATEMENTS)
def test_statements_of_one_equation_agree(statement: str) -> None:
    """Each gives the rate -V eta' of the cnoidal wave, to rounding or to its order."""
    rate, order = STATEMENTS[statement]
    for c in FAMILIES:
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


@pytest.mark.usefixtures("interpreted")
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
from solvers.pypde.grid import circle
from solvers.pypde.one_family import KdvBurgersPDE
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
    root = Path(__file__).parents[3]
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
