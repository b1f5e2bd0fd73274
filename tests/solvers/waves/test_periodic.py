"""Steady waves against exact solutions, another solver and the balance of power."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_bvp
from scipy.optimize import root
from scipy.special import ellipe, ellipj, ellipk
from threadpoolctl import ThreadpoolController, threadpool_info

from fluid.kdv import KdvCoefficients, coefficients, wave_frequency
from meshes.errors import InputError
from solvers.waves.modes import System, WaveProblem, joined, one_thread, split
from solvers.waves.newton import SteadyWave
from solvers.waves.steady import _starts, family_problem, growth, solve
from tests.mutants import kills

PROGRADE = coefficients(0.15, 0.135, 40.0, 1)
RETROGRADE = coefficients(0.15, 0.135, 40.0, -1)
FAMILIES = (PROGRADE, RETROGRADE)


def cnoidal(c: KdvCoefficients, m: float, points: int) -> tuple[float, np.ndarray]:
    """Speed and heights of the cnoidal wave of parameter m with mean 0 and one crest, at xi = 0."""
    K, E = ellipk(m), ellipe(m)
    height = 12.0 * m * c.dispersion / c.steepening * (K / math.pi) ** 2
    mean = (E - (1.0 - m) * K) / (m * K)
    cn = ellipj(K / math.pi * 2.0 * math.pi * np.arange(points) / points, m)[1]
    s = c.linear_speed - c.steepening * height * mean + 4.0 * c.dispersion * (K / math.pi) ** 2 * (2 * m - 1)
    return float(s), height * (cn**2 - mean)


def free_problem(c: KdvCoefficients) -> WaveProblem:
    return WaveProblem(lambda n: wave_frequency(n, c, whitham=False), c.steepening, 0.0)


@kills(
    "solvers.waves.modes:System.residual",
    "self.coefficient(p) * v + 0.5 * square",
    "self.coefficient(p) * v + square",
)
@kills(
    "solvers.waves.modes:System.coefficient", "np.asarray(self.diagonal - p)", "np.asarray(self.diagonal + p)"
)
def test_cnoidal_waves_are_steady() -> None:
    """The unforced, undamped equation keeps them."""
    for c in FAMILIES:
        for m in (0.3, 0.9, 0.999):
            s, eta = cnoidal(c, m, 256)
            system = System(free_problem(c), 85)
            y = split(np.fft.rfft(eta, norm="forward")[1:86] * (c.steepening / system.scale))
            # Rounding of the elliptic functions, 1e-15, times speeds of 20 over the dispersion's 0.1.
            assert system.error(system.residual(y, s / system.scale), y) < 1e-12


@kills("solvers.waves.modes:System.__init__", "/ self.scale - 1j * damping", "/ self.scale + 1j * damping")
@kills(
    "solvers.waves.modes:System.__init__",
    "0.5 * problem.forcing * problem.steepening / self.scale**2",
    "problem.forcing * problem.steepening / self.scale**2",
)
def test_linear_limit() -> None:
    """A small forcing gets the closed form, in the phase that damping gives."""
    for c in FAMILIES:
        for whitham in (False, True):
            problem = family_problem(c, 1e-8, whitham, decay=0.3, diffusion=0.2)
            for s in (c.linear_speed, c.linear_speed - 1.0, 0.0, 2.0 * c.linear_speed):
                wave = solve(problem, s)
                omega = float(wave_frequency(1, c, whitham))
                exact = 0.5 * problem.forcing / (omega - s - 0.5j)
                assert wave.converged
                # The wave's own height shifts its speed by (alpha eta)^2, 1e-14 of the damping's square.
                assert wave.modes[0] == pytest.approx(exact, rel=1e-9)
                assert abs(wave.modes[1]) < 1e-5 * abs(exact)


def manufactured(modes: int, ratio: float = 0.6) -> tuple[float, np.ndarray]:
    """Largest error of a wave with eta_n = h ratio^n, which a dispersion made for it keeps; and the modes.

    (eta^2)_n = h^2 ratio^n (n - 1 + 2 ratio^2/(1 - ratio^2)) by the geometric series.
    """
    c, height, s, q = PROGRADE, 2e-6, 17.5, 3e-7

    def frequency(n: np.ndarray) -> np.ndarray:
        own = -0.5 * c.steepening * height * (n - 1.0 + 2.0 * ratio**2 / (1.0 - ratio**2))
        return n * (s + own + np.where(n == 1.0, 0.5 * q / (height * ratio), 0.0))

    exact = height * ratio ** np.arange(1.0, modes + 1.0)
    wave = solve(
        WaveProblem(frequency, c.steepening, q), s, guess=1.001 * exact, points=2 * modes + 2, most_points=0
    )
    assert wave.residual < 1e-11
    return float(np.max(np.abs(wave.modes - exact)) / height), wave.modes


def test_manufactured_wave() -> None:
    """Newton finds it."""
    # Newton stops at a residual of 1e-11, which the equations' condition, 240, can multiply.
    assert manufactured(64)[0] < 2e-9


@kills(
    "solvers.waves.modes:System.__init__",
    "problem.diffusion * n + problem.decay / n",
    "problem.diffusion * n**2 + problem.decay / n",
)
@kills(
    "solvers.waves.modes:System.__init__",
    "problem.diffusion * n + problem.decay / n",
    "problem.diffusion * n + problem.decay * n",
)
def test_power_balances() -> None:
    """What the whirl feeds is what diffusion and decay take; in physical space."""
    for c in FAMILIES:
        problem = family_problem(c, 0.3, decay=0.2, diffusion=0.05)
        for s in c.linear_speed * np.array([0.95, 1.0, 1.05]):
            wave = solve(problem, float(s))
            assert wave.converged
            points = 1024
            xi = 2.0 * np.pi * np.arange(points) / points
            eta = wave.profile(points)
            slope = np.fft.irfft(1j * np.arange(points // 2 + 1) * np.fft.rfft(eta), points)
            fed = -problem.forcing * np.mean(eta * np.sin(xi))
            lost = problem.diffusion * np.mean(slope**2) + problem.decay * np.mean(eta**2)
            # The residual, 1e-11 in each mode over its coefficient, of which the largest are a hundred.
            assert fed == pytest.approx(lost, rel=1e-8)
            assert abs(np.mean(eta)) < 1e-15


@kills("solvers.waves.modes:System.residual", "r[0] -= self.half_forcing", "r[0] += self.half_forcing")
def test_another_method_finds_the_same_wave() -> None:
    """The damped, forced, tall wave of the differential equation, by scipy's collocation."""
    c, s = PROGRADE, 17.95
    problem = family_problem(c, 0.002, decay=0.02, diffusion=0.01)
    wave = solve(problem, s)
    assert wave.converged
    unit = wave.rms
    assert np.max(np.abs(wave.modes[1:])) > 0.05 * unit

    def slopes(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        eta, first, second = y * unit
        third = -(
            (c.linear_speed - s + problem.steepening * eta) * first
            - problem.diffusion * second + problem.decay * eta + problem.forcing * np.sin(x)
        ) / c.dispersion  # fmt: skip
        return np.array([first, second, third]) / unit

    x = np.linspace(0.0, 2.0 * np.pi, 129)
    eta = np.append(wave.profile(128), wave.profile(128)[0])
    first = np.gradient(eta, x)
    guess = 1.02 * np.array([eta, first, np.gradient(first, x)]) / unit
    other = solve_bvp(slopes, lambda a, b: a - b, x, guess, tol=1e-8, max_nodes=20000)
    assert other.status == 0
    # The collocation's tolerance.
    assert np.max(np.abs(other.sol(x)[0] - eta / unit)) < 1e-7


def bore(c: KdvCoefficients, diffusion: float) -> SteadyWave:
    """Resonant wave without dispersion."""
    problem = family_problem(c, 0.7, diffusion=diffusion)
    still = replace(problem, frequency=lambda n: n * c.linear_speed)
    wave = solve(still, c.linear_speed)
    assert wave.converged
    return wave


def test_bore() -> None:
    """Outside the front 2 sqrt(q/alpha) cos(xi/2), the mean of both sides at the speed of the front."""
    for c in FAMILIES:
        error = []
        for diffusion in (0.1, 0.05):
            wave = bore(c, diffusion)
            height = 2.0 * math.sqrt(wave.problem.forcing / wave.problem.steepening)
            eta = wave.profile(4096)
            xi = 2.0 * np.pi * np.arange(4096) / 4096
            # Thick behind the front as it runs: at xi < 0 if it runs with the spin.
            outside = -c.family * height * np.cos(0.5 * xi)
            away = (xi > 1.0) & (xi < 2.0 * np.pi - 1.0)
            error.append(float(np.max(np.abs(eta - outside)[away])) / height)
            # Odd about the front, which lies at xi = 0: the mean of both sides is (s - lambda0)/alpha = 0.
            assert np.max(np.abs(eta[1:] + eta[:0:-1])) < 1e-9 * height
        # The outer wave errs by the first order of the diffusion.
        assert error[1] < 0.03
        assert error[0] / error[1] == pytest.approx(2.0, abs=0.2)


def outer_bore(detuning: float, xi: np.ndarray) -> np.ndarray:
    """alpha eta over sqrt(alpha q) without dispersion and damping, (s - lambda0)/sqrt(alpha q) given."""
    front = -2.0 * math.asin(0.25 * math.pi * detuning)
    return detuning - 2.0 * np.cos(0.5 * (np.mod(xi - front, 2.0 * np.pi) + front))


def test_bore_follows_the_whirl() -> None:
    """Beside its resonance: the front moves aside, the wave elsewhere is the one without dispersion."""
    xi = 2.0 * np.pi * np.arange(4096) / 4096
    for c in FAMILIES:
        for detuning in (-0.8, 0.5):
            error = []
            for diffusion in (0.08, 0.04):
                problem = family_problem(c, 0.7)
                scale = math.sqrt(problem.steepening * problem.forcing)
                problem = replace(
                    problem, frequency=lambda n, c=c: n * c.linear_speed, diffusion=diffusion * scale
                )
                wave = solve(problem, c.linear_speed + detuning * scale)
                assert wave.converged
                outer = outer_bore(detuning, xi)
                gap = np.abs(problem.steepening * wave.profile(4096) / scale - outer)
                away = np.abs(np.angle(np.exp(1j * (xi + 2.0 * math.asin(0.25 * math.pi * detuning))))) > 1.0
                error.append(float(np.max(gap[away])))
            # Of first order in the diffusion, as at the resonance itself.
            assert error[1] < 0.06
            assert error[0] / error[1] == pytest.approx(2.0, abs=0.3)


@kills("solvers.waves.steady:_starts", "front, n = -2.0 * math.asin", "front, n = 2.0 * math.asin")
@kills(
    "solvers.waves.steady:_starts", "(turn / (n - 0.5) + np.conj(turn)", "(turn / (n - 0.5) - np.conj(turn)"
)
def test_search_begins_at_the_bore() -> None:
    """Fourier coefficients of that wave, rounded off, where steepening rules; by the trapezium rule."""
    problem = family_problem(PROGRADE, 0.7, decay=0.05)
    system = System(problem, 63)
    strength = math.sqrt(problem.steepening * problem.forcing) / system.scale
    xi = 2.0 * np.pi * (np.arange(2**16) + 0.5) / 2**16
    for detuning in (-0.7, 0.0, 0.4):
        p = float(system.diagonal[0].real) + detuning * strength
        start = joined(_starts(system, p)[0])[:6]
        n = np.arange(1, 7)
        wave = np.mean(outer_bore(detuning, xi) * np.exp(-1j * np.outer(n, xi)), axis=1)
        # The jump costs the rule 1e-5 at its 65536 points.
        assert start == pytest.approx(strength * wave * np.exp(-((n / 8.0) ** 2)), abs=3e-5)
        assert abs(np.mean(outer_bore(detuning, xi))) < 3e-5


def test_no_forcing_no_wave() -> None:
    """At rest in the drum, whatever the speed, and stable if it is damped."""
    for decay in (0.0, 0.3):
        wave = solve(family_problem(PROGRADE, 0.0, decay=decay), PROGRADE.linear_speed, points=32)
        assert wave.converged and wave.reason == "" and wave.residual == 0.0
        assert np.all(wave.profile(64) == 0.0) and wave.rms == 0.0
        assert growth(wave) == pytest.approx(-decay, abs=1e-12)


def two_families(c: KdvCoefficients, acceleration: float, s: float, guess: np.ndarray) -> np.ndarray:
    """Steady smooth wave of both long-wave equations, without friction; without mean height and flow.

    In the whirl's frame -s A + R u L and -s u + (Bernoulli's function)/R are constant: algebra at each angle.
    """
    radius, spin, size = c.radius, c.spin, guess.size
    xi = 2.0 * np.pi * np.arange(size) / size

    def left(x: np.ndarray) -> np.ndarray:
        area, u = c.mean_area * (1.0 + x[:size]), radius * spin * x[size : 2 * size]
        r_s = np.sqrt(radius**2 - 2.0 * area)
        log = np.log(radius / r_s)
        head = 0.5 * (u * radius / r_s) ** 2 + spin**2 * area + 2.0 * spin * radius * log * u
        volume = (radius * u * log - s * area) / (c.mean_area * spin) - x[-2]
        momentum = ((head - r_s * acceleration * np.cos(xi)) / radius - s * u) / (radius * spin**2) - x[-1]
        return np.concatenate((volume, momentum, [np.mean(area) / c.mean_area - 1.0, np.mean(u)]))

    flow = c.linear_speed / (radius * c.layer_log) * guess / (radius * spin)
    start = np.concatenate((guess / c.mean_area, flow, [-s / spin, 0.5 * c.mean_area / radius**2]))
    found = root(left, start, tol=1e-13)
    assert np.max(np.abs(found.fun)) < 1e-12
    return np.asarray(found.x[:size] * c.mean_area)


@kills("fluid.kdv:coefficients", "3.0 * spin / surface_radius**2", "2.0 * spin / surface_radius**2")
def test_one_family_against_both() -> None:
    """Against both families: at the same shape, half the height makes half the relative error."""
    for family in (1, -1):
        c, error = coefficients(0.15, 0.135, 40.0, family), []
        for acceleration in (5e-3, 1.25e-3):
            problem = family_problem(c, acceleration)
            still = replace(problem, frequency=lambda n, c=c: n * c.linear_speed)
            s = c.linear_speed + c.family * 2.5 * math.sqrt(c.steepening * problem.forcing)
            wave = solve(still, s)
            assert wave.converged
            # Steepened: without the nonlinear term mode 2 would be missing.
            assert abs(wave.modes[1]) > 0.03 * abs(wave.modes[0])
            eta = wave.profile(256)[::8]
            full = two_families(c, acceleration, s, eta)
            error.append(float(np.max(np.abs(eta - full)) / np.max(np.abs(full))))
        # Heights of 0.1 to 0.4 % of the layer; the detuning goes with them.
        assert error[0] < 0.02
        assert error[0] / error[1] == pytest.approx(2.0, abs=0.03)


@kills(
    "solvers.waves.newton:SteadyWave.rms",
    "float(np.sqrt(2.0) * np.linalg.norm(self.modes))",
    "float(np.linalg.norm(self.modes))",
)
def test_rms_is_that_of_the_profile() -> None:
    """Parseval."""
    wave = solve(family_problem(PROGRADE, 0.3, decay=0.2, diffusion=0.05), 17.5)
    assert wave.rms == pytest.approx(float(np.sqrt(np.mean(wave.profile(1024) ** 2))), rel=1e-12)


def test_manufactured_wave_is_found_with_spectral_accuracy() -> None:
    counts = np.array([8, 12, 16, 24, 32])
    errors = np.array([manufactured(int(m))[0] for m in counts])
    # What is cut off falls as ratio^(2 M) in the lowest modes and ratio^M in the last ones.
    slope = np.polyfit(counts, np.log(errors), 1)[0]
    assert slope < 0.9 * math.log(0.6)


def test_blas_runs_on_one_thread() -> None:
    with ThreadpoolController().limit(limits=2, user_api="blas"), one_thread():
        found = [pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"]
    assert found
    assert set(found) == {1}


@given(
    family=st.sampled_from(FAMILIES),
    acceleration=st.floats(1e-4, 1.0),
    detuning=st.floats(-3.0, 3.0),
    damping=st.floats(0.05, 1.0),
    whitham=st.booleans(),
)
@settings(max_examples=25)
def test_converged_answers_solve_the_equation(
    family: KdvCoefficients, acceleration: float, detuning: float, damping: float, whitham: bool
) -> None:
    problem = family_problem(family, acceleration, whitham, decay=damping, diffusion=0.2 * damping)
    wave = solve(problem, family.linear_speed + detuning)
    assert wave.converged == (not wave.reason)
    if not wave.converged:
        # Newton's method may lose its way; what it then returns is no answer and must not look like one.
        assert wave.residual > 1e-11 or wave.tail > 1e-10
        return
    # The same wave on twice the points: what the tail left out.
    finer = System(problem, 2 * wave.modes.size)
    y = split(np.pad(wave.modes, (0, wave.modes.size)) * (problem.steepening / finer.scale))
    assert finer.error(finer.residual(y, wave.speed / finer.scale), y) < 1e-9
    assert np.array_equal(joined(split(wave.modes)), wave.modes)


def test_what_does_not_converge_says_so() -> None:
    problem = WaveProblem(lambda n: n * PROGRADE.linear_speed, PROGRADE.steepening, 1e-4, diffusion=1e-3)
    wave = solve(problem, PROGRADE.linear_speed, most_points=512)
    assert not wave.converged
    assert "not resolved" in wave.reason or "residual" in wave.reason


def test_bad_input_is_named() -> None:
    problem = family_problem(PROGRADE, 0.1, decay=0.1)
    for field, call in (
        ("speed", lambda: solve(problem, math.inf)),
        ("points", lambda: solve(problem, 1.0, points=6)),
        ("points", lambda: solve(problem, 1.0).profile(64)),
        ("forcing", lambda: solve(free_problem(PROGRADE), 17.8, guess=np.ones(4))),
        ("forcing", lambda: replace(problem, forcing=math.nan)),
        ("steepening", lambda: replace(problem, steepening=0.0)),
        ("decay", lambda: replace(problem, decay=-1.0)),
        ("diffusion", lambda: replace(problem, diffusion=math.inf)),
    ):
        with pytest.raises(InputError) as caught:
            call()
        assert caught.value.field == field
