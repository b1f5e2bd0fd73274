"""Waves at the ends of every range: an answer that solves the equations, or a plain no with its cause."""

from __future__ import annotations

import numpy as np
import pytest

from fluid import kdv
from fluid.friction.laws import STOKES, damping_rate, stokes_coefficient
from solvers.waves.modes import System, split
from solvers.waves.newton import SteadyWave
from solvers.waves.steady import family_problem, solve

RADIUS, HEIGHT = 0.15, 0.05


def answer(
    family: int,
    depth: float = 0.1,
    spin: float = 40.0,
    viscosity: float = 1e-6,
    amplitude: float = 0.01,
    speed: float = 1.0,
    whitham: bool = False,
    points: int = 128,
    diffusion: float = 0.0,
) -> tuple[SteadyWave, kdv.KdvCoefficients]:
    """Depth over R, amplitude over the depth, whirl speed over that of the free waves; laminar friction."""
    c = kdv.coefficients(RADIUS, RADIUS * (1.0 - depth), spin, family)
    s = speed * c.linear_speed
    shear = float(stokes_coefficient(viscosity, s)) / RADIUS
    rate = damping_rate(STOKES, shear, 2.0 * RADIUS / HEIGHT, depth, c.mean_area / RADIUS**2, 0.0)
    acceleration = (spin + s) ** 2 * amplitude * depth * RADIUS
    problem = family_problem(c, acceleration, whitham, float(kdv.decay(c, rate)), diffusion)
    return solve(problem, s, points=points), c


def check(wave: SteadyWave, c: kdv.KdvCoefficients) -> None:
    """Finite, without mean; solved on twice its points if it says so, else with a cause."""
    eta = wave.profile(2 * wave.modes.size + 2)
    assert np.all(np.isfinite(eta)) and np.isfinite(complex(kdv.offset(c, eta)))
    assert abs(np.mean(eta)) <= 1e-14 * c.mean_area * max(1.0, np.max(np.abs(eta)) / c.mean_area)
    assert wave.converged == (wave.reason == "")
    if wave.converged:
        finer = System(wave.problem, 2 * wave.modes.size)
        scale = wave.problem.steepening / finer.scale
        y = split(np.pad(wave.modes, (0, wave.modes.size)) * scale)
        assert finer.error(finer.residual(y, wave.speed / finer.scale), y) < 1e-9
    else:
        assert "the wave breaks" in wave.reason or "a bore with waves of" in wave.reason
        assert "more diffusion" in wave.reason or "GMRES" in wave.reason


CASES: dict[str, dict[str, float]] = {
    "a depth of 1e-4 R": {"depth": 1e-4},
    "a depth of 1e-3 R": {"depth": 1e-3},
    "a depth of 0.01 R": {"depth": 1e-2},
    "a depth of 0.5 R": {"depth": 0.5},
    "a depth of 0.9 R": {"depth": 0.9},
    "0.1 rad/s": {"spin": 0.1},
    "1e5 rad/s": {"spin": 1e5},
    "no friction": {"viscosity": 0.0},
    "0.1 m2/s": {"viscosity": 0.1},
    "no whirl": {"amplitude": 0.0},
    "a whirl of 1e-6 depths": {"amplitude": 1e-6},
    "a whirl of one depth": {"amplitude": 1.0},
    "synchronous": {"speed": 0.0},
    "below resonance": {"speed": 0.9},
    "above resonance": {"speed": 1.1},
    "far above resonance": {"speed": 2.0},
    "16 points": {"points": 16},
    "8192 points": {"points": 8192},
    "exact dispersion": {"whitham": True, "amplitude": 1e-3},
}


@pytest.mark.parametrize("family", [1, -1], ids=["prograde", "retrograde"])
@pytest.mark.parametrize("case", CASES)
def test_extremes_have_an_answer(case: str, family: int) -> None:
    wave, c = answer(family, **CASES[case])  # type: ignore[arg-type]
    check(wave, c)
    assert wave.converged, wave.reason
    assert (wave.rms == 0.0) == (case == "no whirl")


def crest_over_the_highest(wave: SteadyWave) -> float:
    """Largest alpha eta over s less the speed of the shortest waves; a smooth wave stays below 1."""
    far = 1e6
    highest = wave.speed - float(wave.problem.frequency(np.array([far]))[0]) / far
    return float(np.max(wave.problem.steepening * wave.profile(16384) / highest))


@pytest.mark.parametrize(
    "family", [pytest.param(1, id="prograde", marks=pytest.mark.slow), pytest.param(-1, id="retrograde")]
)
def test_a_wave_that_breaks_says_so(family: int) -> None:
    """With exact dispersion the steepening of a high wave has no match: its crest comes to stand still."""
    low, c = answer(family, whitham=True, amplitude=1e-3)
    assert low.converged and crest_over_the_highest(low) < 0.5
    tall = 0.1 if family == 1 else 1.0
    high, c = answer(family, whitham=True, amplitude=tall)
    check(high, c)
    assert not high.converged and "the wave breaks" in high.reason
    # A diffusion carries it over the highest wave, to a front.
    rounded, c = answer(family, whitham=True, amplitude=tall, diffusion=0.2)
    assert rounded.converged and crest_over_the_highest(rounded) > 1.0


def test_a_thin_layer_without_friction_has_more_waves_than_are_solved() -> None:
    wave, c = answer(1, depth=0.01, viscosity=0.0, amplitude=0.1)
    check(wave, c)
    assert not wave.converged and "a bore with waves of up to" in wave.reason


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_anywhere_in_the_box(seed: int) -> None:
    """Through both resonances, all ranges at once."""
    draw = np.random.default_rng(seed)
    for _ in range(60):
        wave, c = answer(
            int(draw.choice([1, -1])),
            depth=float(draw.choice([1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.2, 0.3, 0.5, 0.9])),
            spin=float(draw.choice([0.1, 1.0, 40.0, 1e3, 1e5])),
            viscosity=float(draw.choice([0.0, 1e-6, 1e-4, 1e-2, 1e-1])),
            amplitude=float(draw.choice([0.0, 1e-6, 1e-4, 1e-3, 1e-2, 0.05, 0.1, 1.0, 10.0])),
            speed=float(draw.choice([0.1, 0.5, 0.8, 0.9, 0.98, 1.0, 1.02, 1.1, 1.2, 1.5, 3.0])),
            whitham=bool(draw.integers(2)),
            points=int(draw.choice([16, 64, 128, 1024, 8192])),
        )
        check(wave, c)
