"""The equations of the modes, their derivative, its factors, and Newton's steps."""

import math

import numpy as np
import pytest

from solvers.waves.modes import DENSE_MODES, DampingSystem, System, WaveProblem, joined, split
from solvers.waves.newton import ALONE, _step, factorise, newton, scaled_unknowns
from solvers.waves.steady import family_problem, solve
from tests.mutants import kills
from tests.solvers.waves.test_periodic import PROGRADE, RETROGRADE, free_problem

DAMPED = family_problem(PROGRADE, 0.3, whitham=True, decay=0.2, diffusion=0.05)


def systems(modes: int) -> tuple[System, System]:
    """The equations along the speed and along an extra diffusion."""
    return System(DAMPED, modes), DampingSystem(DAMPED, modes, 17.6)


@kills(
    "solvers.waves.modes:System.jacobian",
    "np.subtract(hi, ti, out=matrix[:m, m:full])",
    "np.add(hi, ti, out=matrix[:m, m:full])",
)
@kills("solvers.waves.modes:System.jacobian", "matrix[k, m + k] += d.imag", "matrix[k, m + k] -= d.imag")
@kills("solvers.waves.modes:System.by_parameter", "return -y", "return y")
@kills(
    "solvers.waves.modes:DampingSystem.by_parameter",
    "(self.n * y[m:], -self.n * y[:m])",
    "(-self.n * y[m:], self.n * y[:m])",
)
@kills("solvers.waves.modes:System.act", "heights * values(dv, self", "0.5 * heights * values(dv, self")
@kills("solvers.waves.modes:_difference_and_sum", "(m + 1) * item, (item, item)", "m * item, (item, item)")
def test_derivative() -> None:
    """Against central differences of the residual; the low block is a part of it."""
    rng = np.random.default_rng(1)
    for system in systems(12):
        y, p, step = rng.normal(size=24), 0.3, 1e-6
        moved = [
            (system.residual(y + e, p) - system.residual(y - e, p)) / (2.0 * step) for e in step * np.eye(24)
        ]
        exact = system.jacobian(y, p, 12)
        # The residual is quadratic: only rounding, 1e-15 times coefficients of 100 over the step.
        assert np.max(np.abs(exact - np.array(moved).T)) < 1e-7
        by_p = (system.residual(y, p + step) - system.residual(y, p - step)) / (2.0 * step)
        assert np.max(np.abs(system.by_parameter(y, p) - by_p)) < 1e-7
        low = np.r_[0:5, 12:17]
        assert np.array_equal(system.jacobian(y, p, 5), exact[np.ix_(low, low)])
        heights, x = (
            np.fft.irfft(np.append(0.0, joined(y)), system.points, norm="forward"),
            rng.normal(size=24),
        )
        assert system.act(heights, p, x) == pytest.approx(exact @ x, rel=1e-12, abs=1e-11)


@kills("solvers.waves.modes:System.__init__", "next_fast_len(3 * modes + 1", "next_fast_len(2 * modes + 1")
def test_products_do_not_alias() -> None:
    """The square of two modes has no part in the others: cos(m xi)^2 = (1 + cos(2 m xi))/2."""
    system = System(free_problem(PROGRADE), 20)
    for m in range(11, 21):
        v = np.zeros(20, dtype=complex)
        v[m - 1] = 1.0
        left = joined(system.residual(split(v), 0.0)) - system.diagonal * v
        # 2 m is above the modes kept, so that nothing is left; rounding of a diagonal of 300.
        assert np.max(np.abs(left)) < 1e-12


@kills(
    "solvers.waves.modes:DampingSystem.coefficient",
    "self._still - (1j * p) * self.n",
    "self._still - (1j * p) / self.n",
)
def test_extra_diffusion() -> None:
    """Both systems state one equation: x more in one is x more in the problem of the other."""
    rng = np.random.default_rng(3)
    extra, speed, y = 0.7, 17.6, rng.normal(size=20)
    along = DampingSystem(DAMPED, 10, speed)
    more = WaveProblem(
        DAMPED.frequency, DAMPED.steepening, DAMPED.forcing, 0.2, 0.05 + extra * DAMPED.speed_scale
    )
    fixed = System(more, 10)
    assert fixed.scale == along.scale
    assert along.residual(y, extra) == pytest.approx(
        fixed.residual(y, speed / fixed.scale), rel=1e-12, abs=1e-12
    )


def steep_wave(modes: int) -> tuple[System, np.ndarray, float]:
    """A system with a rough wave in it, of which few modes are coupled."""
    problem = family_problem(PROGRADE, 0.3, decay=0.2, diffusion=0.05)
    rng = np.random.default_rng(2)
    system = System(problem, modes)
    n = np.arange(1, modes + 1)
    y = split(np.exp(-0.2 * n) * (rng.normal(size=n.size) + 1j * rng.normal(size=n.size)))
    return system, y, float(problem.frequency(np.array([1.0]))[0] / system.scale + 0.3)


@kills(
    "solvers.waves.newton:factorise",
    "2.0 * plane[:low], 2.0 * plane[m : m + low]",
    "plane[:low], plane[m : m + low]",
)
@kills(
    "solvers.waves.newton:Factors.solve",
    "r[low:m] + 1j * r[m + low : size]",
    "r[low:m] - 1j * r[m + low : size]",
)
def test_factors_invert_the_derivative() -> None:
    """Exactly with all modes in the block, else nearly: what is left shrinks by ALONE and more."""
    rng = np.random.default_rng(4)
    system, y, p = steep_wave(63)
    m = system.modes
    plane = rng.normal(size=2 * m + 1)
    full = np.zeros((2 * m + 1, 2 * m + 1))
    full[:-1, :-1] = system.jacobian(y, p, m)
    full[:-1, -1] = system.by_parameter(y, p)
    full[-1] = np.append(2.0 * plane[:-1], plane[-1])
    x = rng.normal(size=2 * m + 1)
    whole = factorise(system, y, p, plane, math.inf)
    part = factorise(system, y, p, plane)
    assert whole.low == m and 8 <= part.low < 0.8 * m
    turned = full @ x
    # Rounding times the condition, up to 1e4.
    assert whole.solve(turned[:-1], turned[-1]) == pytest.approx(x, rel=1e-9, abs=1e-9)
    found = np.zeros(x.size)
    for _ in range(12):
        left = turned - full @ found
        found = found + part.solve(left[:-1], left[-1])
    # A gain of ALONE in each of twelve steps, and of a half at the least.
    assert np.linalg.norm(found - x) < 2.0**-12 * np.linalg.norm(x)
    bare = factorise(system, y, p, alone=math.inf)
    assert bare.solve(full[:-1, :-1] @ x[:-1]) == pytest.approx(x[:-1], rel=1e-9, abs=1e-9)


@kills("solvers.waves.newton:Factors.solve", "off -= 2.0 * float(", "off -= float(")
def test_nothing_is_left_out_at_rest() -> None:
    """Without a wave no modes are coupled but by the plane: any block gives the exact inverse."""
    rng = np.random.default_rng(5)
    system = steep_wave(63)[0]
    m, p = system.modes, 0.3
    plane, x = rng.normal(size=(2, 2 * m + 1))
    factors = factorise(system, np.zeros(2 * m), p, plane)
    assert factors.low == 8
    d = system.coefficient(p)
    right = split(d * joined(x[:-1]))
    found = factors.solve(right, 2.0 * float(plane[:-1] @ x[:-1]) + plane[-1] * x[-1])
    assert found == pytest.approx(x, rel=1e-11, abs=1e-11)


@kills("solvers.waves.newton:factorise", "alone * height", "height")
def test_coupled_modes_are_in_the_block() -> None:
    """Outside of it every coefficient is ALONE times the wave's height or more."""
    system, y, p = steep_wave(63)
    factors = factorise(system, y, p)
    height = np.max(np.abs(np.fft.irfft(np.append(0.0, joined(y)), 512, norm="forward")))
    # The height is taken on 192 points.
    assert np.min(np.abs(factors.high)) > 0.98 * ALONE * height
    assert abs(system.coefficient(p)[factors.low - 1]) < 1.02 * ALONE * height


def test_krylov_step_is_newtons() -> None:
    # A wave so high that it couples more modes than a block may have.
    system, y, p = steep_wave(DENSE_MODES + 40)
    y = 3e4 * y
    r = system.residual(y, p)
    factors = factorise(system, y, p)
    assert not factors.enough and factors.low == DENSE_MODES
    exact = np.linalg.solve(system.jacobian(y, p, system.modes), -r)
    # GMRES stops at 1e-4 of the preconditioned residual.
    assert np.linalg.norm(_step(system, factors, y, p, r) - exact) < 1e-2 * np.linalg.norm(exact)


def test_old_factors_lead_to_the_same_wave() -> None:
    problem = family_problem(RETROGRADE, 0.1, decay=0.2, diffusion=0.05)
    system = System(problem, 63)
    near, here = (solve(problem, s) for s in (-9.5, -9.4))
    old = factorise(system, scaled_unknowns(near), near.speed / system.scale)
    wave = newton(system, scaled_unknowns(near), here.speed / system.scale, factors=old)
    assert wave.converged
    assert wave.modes == pytest.approx(here.modes, rel=1e-8, abs=1e-10 * here.rms)


def test_singular_equations_raise() -> None:
    # At rest on the resonance of an undamped mode its coefficient is 0.
    problem = WaveProblem(lambda n: n, 1.0, 1e-3)
    system = System(problem, 15)
    with pytest.raises(np.linalg.LinAlgError):
        factorise(system, np.zeros(30), 1.0 / system.scale)
    wave = newton(system, np.zeros(30), 1.0 / system.scale)
    assert not wave.converged and "singular" in wave.reason
