"""Curves of steady waves: folds, every answer, and which of them are stable."""

import math

import numpy as np
import pytest

from fluid.kdv import coefficients
from meshes.errors import InputError
from solvers.waves.modes import System, WaveProblem, split
from solvers.waves.newton import SteadyWave, newton
from solvers.waves.steady import (
    Branch,
    Response,
    _segment,
    family_problem,
    follow,
    growth,
    growth_rates,
    respond,
    solve,
)
from tests.mutants import kills
from tests.solvers.waves.test_periodic import FAMILIES, PROGRADE, RETROGRADE, cnoidal, free_problem

# A curve that folds twice: one resonance, its answers one, three, one.
GENTLE = family_problem(PROGRADE, 1e-3, decay=0.02)
GENTLE_SPEEDS = np.linspace(17.6, 18.2, 61)


def gentle() -> Response:
    return respond(GENTLE, GENTLE_SPEEDS, stability=True)


@kills("solvers.waves.steady:growth_rates", "np.argsort(-values.real)", "np.argsort(values.real)")
def test_curve_folds() -> None:
    """Three answers next to resonance, on the side of faster waves; the middle one is unstable."""
    answer = gentle()
    assert answer.complete, answer.reason
    counts = np.array([len(waves) for waves in answer.waves])
    assert set(counts) == {1, 3}
    (threefold,) = np.where(counts == 3)
    assert np.all(np.diff(threefold) == 1)
    # omega(1) = lambda0 - delta = 17.82; waves of some height are faster.
    assert GENTLE_SPEEDS[threefold[0]] > PROGRADE.linear_speed - PROGRADE.dispersion
    for k, rates in enumerate(answer.growth):
        if counts[k] == 3:
            assert rates[0] < 0.0 < rates[1]
            assert rates[2] < 0.0
        else:
            assert rates[0] < 0.0
    assert len(answer.branches[0].folds) == 2


def test_stability_changes_at_the_fold() -> None:
    """A real rate passes 0 there: small on both sides, and of opposite sign."""
    branch = follow(GENTLE, 17.6, 18.2, longest=0.02)
    assert branch.complete
    for fold in branch.folds:
        before, after = growth(branch.waves[fold - 2]), growth(branch.waves[fold + 2])
        assert before * after < 0.0
        # Decay rates far from the folds are 0.02 1/s.
        assert max(abs(before), abs(after)) < 0.012


def test_segments_follow_the_curve() -> None:
    """Between two points the cubic lies on the curve to third order of the step and better."""
    branch = follow(GENTLE, 17.6, 18.2, longest=0.1)
    scale = GENTLE.speed_scale
    for k in range(5, len(branch.waves) - 2, 8):
        modes = branch.waves[k].modes.size
        middle = 0.5 ** np.arange(4) @ _segment(branch, k)
        system = System(GENTLE, modes)
        wave = newton(system, middle[:-1], middle[-1])
        assert wave.converged
        ends = [split(w.modes * (GENTLE.steepening / scale)) for w in branch.waves[k : k + 2]]
        on_curve = split(wave.modes * (GENTLE.steepening / scale))
        chord = np.linalg.norm(ends[1] - ends[0])
        # A chord's middle is off by an eighth of its square over the radius of curvature; the cubic far less.
        assert np.linalg.norm(middle[:-1] - on_curve) < 0.01 * chord


@kills(
    "solvers.waves.steady:family_problem",
    "c.steepening, float(forcing(c, acceleration)), decay, diffusion",
    "c.steepening, float(forcing(c, acceleration)), diffusion, decay",
)
@kills(
    "solvers.waves.steady:growth_rates",
    "np.vstack((n * jacobian[m:], -n * jacobian[:m]))",
    "np.vstack((-n * jacobian[m:], n * jacobian[:m]))",
)
@kills(
    "solvers.waves.steady:growth_rates",
    "np.vstack((n * jacobian[m:], -n * jacobian[:m]))",
    "np.vstack((jacobian[m:], -jacobian[:m]))",
)
def test_linear_spectrum() -> None:
    """Disturbances of a vanishing wave are free waves, seen from the whirl, that decay."""
    problem = family_problem(RETROGRADE, 1e-9, whitham=True, decay=0.2, diffusion=0.03)
    s = -9.0
    found = growth_rates(solve(problem, s))
    n = np.arange(1.0, 43.0)
    exact = -1j * (problem.frequency(n) - s * n) - 0.2 - 0.03 * n**2
    # The real operator has each wave and its conjugate; the wave itself disturbs by alpha eta = 1e-8.
    for value in exact:
        assert np.min(np.abs(found - value)) < 1e-6
        assert np.min(np.abs(found - np.conj(value))) < 1e-6
    assert growth(solve(problem, s)) == pytest.approx(-0.23, abs=1e-6)


def test_growth_is_seen_in_time() -> None:
    """The unstable wave, disturbed, departs at its growth rate: two Runge-Kutta runs of its modes."""
    answer = respond(GENTLE, np.array([17.6, 17.93, 18.2]), stability=True)
    wave, rate = answer.waves[1][1], answer.growth[1][1]
    assert rate > 0.005
    problem, m = wave.problem, 12
    n = np.arange(1.0, m + 1.0)
    drift = -1j * (problem.frequency(n) - wave.speed * n) - problem.decay

    def slope(v: np.ndarray) -> np.ndarray:
        eta = np.fft.irfft(np.concatenate(([0.0], v, np.zeros(20 - m))), 38, norm="forward")
        square = np.fft.rfft(eta**2, norm="forward")[1 : m + 1]
        forced = np.where(n == 1.0, 0.5j * problem.forcing, 0.0)
        return drift * v - 0.5j * n * problem.steepening * square + forced

    def advance(v: np.ndarray, dt: float, steps: int) -> np.ndarray:
        for _ in range(steps):
            # Classical Runge-Kutta; the fastest wave turns by delta m^3 dt = 2.2, below its limit of 2.8.
            k1 = slope(v)
            k2 = slope(v + 0.5 * dt * k1)
            k3 = slope(v + 0.5 * dt * k2)
            v = v + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + slope(v + dt * k3))
        return v

    rest = solve(problem, wave.speed, guess=wave.modes[:m], points=2 * m + 2, most_points=0).modes
    # Cutting the wave off at m modes changes it by less than its rate is tested to.
    assert np.max(np.abs(rest - wave.modes[:m])) < 1e-5 * wave.rms
    # Two times far enough apart, late enough for the growing disturbance to stand alone.
    one = advance(rest * (1.0 + 1e-5), 0.03, 5000)
    two = advance(one, 0.03, 1000)
    grown = np.linalg.norm(two - rest) / np.linalg.norm(one - rest)
    # What still decays at 0.05 1/s beside it is e^-10; the disturbance stays linear below 1e-3.
    assert math.log(grown) / 30.0 == pytest.approx(rate, rel=0.02)


@pytest.mark.parametrize("c", FAMILIES, ids=("prograde", "retrograde"))
def test_free_waves_are_neutral(c) -> None:  # type: ignore[no-untyped-def]
    s, eta = cnoidal(c, 0.9, 256)
    system = System(free_problem(c), 60)
    y = split(np.fft.rfft(eta, norm="forward")[1:61] * (c.steepening / system.scale))
    rates = growth_rates(newton(system, y, s / system.scale))
    assert rates.size == 119
    # Cnoidal waves of KdV are stable and nothing decays; rounding of entries delta 60^3.
    assert np.max(np.abs(rates.real)) < 1e-9 * abs(c.dispersion) * 60**3


@pytest.mark.parametrize("acceleration", [pytest.param(0.02, marks=pytest.mark.slow), 0.1])
def test_both_directions_and_step_lengths_see_the_same_curve(acceleration: float) -> None:
    problem = family_problem(RETROGRADE, acceleration, decay=0.07, diffusion=0.01)
    ways = [
        follow(problem, -7.0, -12.0),
        follow(problem, -7.0, -12.0, longest=0.1),
        follow(problem, -12.0, -7.0),
    ]
    assert all(branch.complete for branch in ways)
    assert all(wave.converged for branch in ways for wave in branch.waves)
    assert len({len(branch.folds) for branch in ways}) == 1
    peaks = [_peak(branch) for branch in ways]
    # The largest point of a curve sampled at steps of 0.5 or less misses the peak by their square.
    assert np.ptp(peaks) < 0.02 * peaks[0]


def _peak(branch: Branch) -> float:
    return float(np.max([wave.rms for wave in branch.waves]))


def test_respond_returns_answers_that_solve_alone() -> None:
    answer = gentle()
    for found in answer.waves[::7]:
        for wave in found:
            again = solve(GENTLE, wave.speed, guess=wave.modes)
            assert again.converged
            assert again.modes[:40] == pytest.approx(wave.modes[:40], rel=1e-8, abs=1e-9 * wave.rms)
    assert answer.growth
    assert answer.waves[0][0].speed == GENTLE_SPEEDS[0]
    assert not respond(GENTLE, GENTLE_SPEEDS[:3]).growth


def test_one_answer_is_among_those_of_the_curve() -> None:
    """Where Newton's method does not arrive by itself, at a resonance with many folds."""
    c = PROGRADE
    problem = family_problem(c, 1.0, decay=0.125, diffusion=0.025)
    system, p = System(problem, 63), c.linear_speed / problem.speed_scale
    assert not newton(system, system.linear(p), p).converged
    alone = solve(problem, c.linear_speed)
    assert alone.converged
    curve = respond(problem, c.linear_speed + np.array([-6.0, 0.0, 6.0]))
    assert curve.complete, curve.reason
    assert len(curve.waves[1]) > 1
    gaps = [
        np.linalg.norm(alone.modes[:100] - wave.modes[:100]) / np.linalg.norm(wave.modes)
        for wave in curve.waves[1]
    ]
    # Both stop at residuals of 1e-11.
    assert min(gaps) < 1e-8


def test_curve_ends_where_it_is_asked_to() -> None:
    c = PROGRADE
    branch = follow(family_problem(c, 0.3, decay=0.2, diffusion=0.05), c.linear_speed - 6.0, c.linear_speed)
    assert branch.complete, branch.reason
    assert branch.waves[-1].speed == pytest.approx(c.linear_speed, rel=1e-14)
    assert branch.waves[-1].converged


def test_whitham_and_kdv_agree_for_long_waves() -> None:
    thin = coefficients(0.15, 0.1485, 40.0, 1)
    speed = thin.linear_speed - 0.05
    waves = [solve(family_problem(thin, 1e-4, w, decay=0.05), speed) for w in (False, True)]
    assert all(wave.converged for wave in waves)
    # Both leave out the wave's short part beyond n L = 0.1, where they part by (n L)^2.
    assert waves[0].modes[:3] == pytest.approx(waves[1].modes[:3], rel=1e-2)


def test_incomplete_curves_say_why() -> None:
    short = follow(GENTLE, 17.6, 18.2, most_steps=5)
    assert not short.complete
    assert "5 steps" in short.reason
    thin = WaveProblem(lambda n: n * PROGRADE.linear_speed, PROGRADE.steepening, 1e-4, diffusion=1e-3)
    lost = respond(thin, np.linspace(15.0, 21.0, 5))
    assert not lost.complete
    assert "not resolved" in lost.reason


def test_bad_input_is_named() -> None:
    alone: SteadyWave = solve(GENTLE, 17.0)
    lost = WaveProblem(GENTLE.frequency, GENTLE.steepening, 1.0)
    for field, call in (
        ("stop", lambda: follow(GENTLE, 17.0, 17.0)),
        ("stop", lambda: follow(GENTLE, 17.0, math.nan)),
        ("forcing", lambda: follow(free_problem(PROGRADE), 17.0, 18.0)),
        ("speeds", lambda: respond(GENTLE, [18.0, 17.0])),
        ("margin", lambda: respond(GENTLE, [17.0, 18.0], margin=-1.0)),
        ("wave", lambda: growth(solve(lost, PROGRADE.linear_speed, most_points=0))),
    ):
        with pytest.raises(InputError) as caught:
            call()
        assert caught.value.field == field
    assert alone.converged
