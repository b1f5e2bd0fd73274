"""The steady wave of one family by py-pde: Newton's method as its solver, and steps in time beside it."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from pde import PDE, MemoryStorage, ScalarField
from pde.solvers import registered_solvers
from pde.solvers.base import ConvergenceError

from fluid import kdv
from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import known_liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.liquid_model import Whirl
from solvers.pypde.grid import circle
from solvers.pypde.models import OneFamily
from solvers.pypde.one_family import KdvBurgersPDE
from solvers.pypde.settle_family import steady_state, steady_wave
from solvers.pypde.steady_newton import SteadyNewtonSolver, drawn
from solvers.pypde.stock import names
from solvers.waves.modes import WaveTerms
from solvers.waves.steady import solve
from solvers.waves.stepper import to_spectrum
from tests.mutants import kills

SPIN, SLIP = 40.0, -9.0
FAMILY = kdv.coefficients(0.15, 0.135, SPIN, -1)
TERMS = WaveTerms(FAMILY, damping=2.0, forcing=float(kdv.forcing(FAMILY, 0.05)), whirl_speed=SLIP)
WHIRL = Whirl(SPIN, SPIN + SLIP, 1e-4, ramp=1.0)


def equation(terms: WaveTerms = TERMS) -> KdvBurgersPDE:
    return KdvBurgersPDE(**vars(terms))


@functools.cache
def newton() -> np.ndarray:
    """Heights at 16 steps from the deflection."""
    wave = steady_wave(TERMS, 16)
    assert wave.converged
    found = wave.profile(2 * wave.modes.size + 2)
    return found[:: found.size // 16] if found.size % 16 == 0 else drawn(wave, circle(16), 0.0)


def test_newton_is_a_registered_solver_and_its_wave_is_steady() -> None:
    """The state turns with the whirl: its rate of change is -s times its slope."""
    assert registered_solvers()["steady_newton"] is SteadyNewtonSolver
    eq, storage = equation(), MemoryStorage()
    final = eq.solve(
        ScalarField(circle(64), 0.0), 0.7, tracker=[storage.tracker([0.2, 0.7])], solver="steady_newton"
    )
    info = eq.diagnostics["solver"]
    assert info["status"] == "finished" and info["residual"] < 1e-11 and info["wave"].converged
    n = np.arange(33)
    for time, data in [(0.7, final.data), *zip(storage.times, storage.data, strict=True)]:
        state = ScalarField(final.grid, data)
        turning = np.fft.irfft(-1j * SLIP * n * to_spectrum(data))
        # delta n^3 over the speed multiplies the residual.
        gap = np.abs(eq.evolution_rate(state, time).data - turning).max()
        assert gap < 1e-8 * np.abs(turning).max()
    assert np.abs(final.data).max() > 1e-5


@kills("solvers.pypde.steady_newton:drawn", "first - wave.speed * time", "first + wave.speed * time")
@kills("solvers.pypde.steady_newton:steady_problem", "terms.damping", "0.0")
@kills("solvers.pypde.one_family:KdvBurgersPDE.seen", "self.terms.whirl_speed * t - first", "-first")
def test_the_wave_is_the_solvers_of_waves() -> None:
    """At any time, on a grid that carries all modes and one that does not; from the deflection too."""
    wave = solve(kdv_problem(), SLIP)
    fine = wave.profile(2048)
    for points in (16, 64, 512):
        grid = circle(points)
        eq = equation()
        for stop in (0.3, 1.1):
            state = eq.solve(ScalarField(grid, 0.0), stop, tracker=None, solver="steady_newton")
            xi = np.mod(grid.axes_coords[0] - SLIP * stop, 2.0 * math.pi)
            exact = np.interp(xi, 2.0 * math.pi * np.arange(2048) / 2048, fine, period=2.0 * math.pi)
            # Straight lines between 2048 points: (2 pi/2048)^2/8 of the curvature.
            assert np.abs(state.data - exact).max() < 1e-4 * np.abs(fine).max()
            if points == 512:
                assert np.abs(eq.seen(state, stop) - wave.profile(512)).max() < 1e-9 * np.abs(fine).max()


def kdv_problem():  # type: ignore[no-untyped-def]
    from solvers.waves.steady import family_problem

    return family_problem(FAMILY, 0.05, decay=2.0)


# What a settled wave has left of its transients is 1e-6; the steps add their own error.
MARCHED = {"runge-kutta": 2e-4, "scipy": 2e-5, "exponential": 1e-5, "adams-bashforth": 1e-3}


@pytest.mark.parametrize(
    "solver", [*list(MARCHED)[:3], pytest.param("adams-bashforth", marks=pytest.mark.slow)]
)
def test_steps_in_time_arrive_at_newtons_wave(solver: str) -> None:
    heights, reason = steady_state(TERMS, WHIRL, 16, solver)
    assert not reason
    assert np.abs(heights - newton()).max() < MARCHED[solver] * np.abs(newton()).max()


@kills("solvers.waves.modes:wave_split", "* grown(t, terms.ramp)", "")
def test_the_forcing_grows_with_the_ramp() -> None:
    """The liquid's rate of change from rest is the forcing's, which begins with the square of the time."""
    terms = WaveTerms(FAMILY, forcing=1e-4, whirl_speed=SLIP, ramp=2.0)
    state = ScalarField(circle(16), 0.0)
    for time, share in ((0.0, 0.0), (1.0, 0.5), (2.0, 1.0), (3.0, 1.0)):
        rate = KdvBurgersPDE(**vars(terms)).evolution_rate(state, time).data
        assert np.abs(rate + share * 1e-4 * np.sin(state.grid.axes_coords[0] - SLIP * time)).max() < 1e-18


def test_a_wave_without_an_answer_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """Newton's solver raises, with the reason in its record; the wave that was last tried is there."""
    terms = WaveTerms(FAMILY, damping=1e-3, forcing=float(kdv.forcing(FAMILY, 40.0)), whirl_speed=SLIP)
    few = functools.partial(solve, points=16, most_points=16)  # too few for its crests
    monkeypatch.setattr("solvers.pypde.steady_newton.solve", few)
    eq = equation(terms)
    with pytest.raises(ConvergenceError):
        eq.solve(ScalarField(circle(16), 0.0), 1.0, tracker=None, solver="steady_newton")
    info = eq.diagnostics["solver"]
    assert info["status"] == "not converged" and info["reason"] == info["wave"].reason
    assert not steady_wave(terms, 16).converged


def test_solvers_that_cannot_are_refused() -> None:
    found = names(equation())
    assert {"exponential", "steady_newton", "runge-kutta", "scipy", "implicit", "crank-nicolson"} <= set(
        found
    )
    assert not {"euler", "explicit", "milstein", "explicit_mpi", "finite_volume"} & set(found)
    with pytest.raises(InputError, match="solver"):
        steady_state(TERMS, WHIRL, 16, "milstein")
    with pytest.raises(InputError, match="pde"):
        SteadyNewtonSolver(PDE({"u": "laplace(u)"}))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="dt"):
        equation().solve(ScalarField(circle(16), 0.0), 1.0, 0.1, tracker=None, solver="steady_newton")


@kills("solvers.pypde.models:OneFamily._terms", "whirl.slip + lag", "whirl.slip")
@kills("solvers.pypde.models:OneFamily._terms", "whirl.spin, whirl.spin - lag", "whirl.spin, whirl.spin")
@kills(
    "solvers.pypde.models:OneFamily._lag",
    "math.copysign(drag, lag) - fed",
    "math.copysign(drag, lag) - 0.5 * fed",
)
@kills("fluid.kdv:diffusion", "front * (1.0 -", "30.0 * front * (1.0 -")
def test_a_driven_layer_lags_as_the_wall_holds_it_against_the_whirl() -> None:
    chamber = Chamber(0.15, 0.05)
    fill = Fill(chamber, known_liquid("water"), (1.0 - 0.9**2) * chamber.capacity)
    # Settled long waves with dispersion on 128 cells: G and lag; the other family is some 0.1 of G.
    for speed, rate, share, force, lag in (
        (30.58, 2.0, 0.05, 0.4851 + 2.5355j, 0.172),
        (30.58, 0.5, 0.05, 1.7558 + 2.8560j, 0.753),
        (31.0, 0.5, 0.02, 3.2072 + 3.5978j, 0.157),
    ):
        friction = Friction("linear", rate)  # type: ignore[arg-type]
        whirl = Whirl(40.0, speed, share * fill.depth, 0.0)
        wave = OneFamily(friction).wave(fill, whirl)
        found = complex(wave.answer.unbalance[0]) / (fill.full_mass * whirl.amplitude)
        assert wave.answer.converged[0]
        assert abs(found - force) < 0.05 * abs(force)
        assert -wave.mean_rotation == pytest.approx(lag, rel=0.07)
        # Torques, by hand: tau R/(rho u A) = k h R/A, u = lag a, of m R^2.
        held = fill.mass * 0.15**2 * rate * (0.1 / 0.095) * 0.9 * -wave.mean_rotation
        fed = fill.full_mass * (whirl.speed * whirl.amplitude) ** 2 * found.imag
        assert held == pytest.approx(fed, rel=1e-6)
    # A whirl ahead of the drum carries the liquid along; without friction nothing would hold a lag.
    ahead = Whirl(40.0, 57.5, 0.02 * fill.depth, 0.0)
    assert OneFamily(Friction("linear", 2.0)).wave(fill, ahead).mean_rotation > 0.0  # type: ignore[arg-type]
    assert math.isnan(OneFamily().wave(fill, ahead).mean_rotation)
