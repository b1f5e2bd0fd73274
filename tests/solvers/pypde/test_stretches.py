"""Layers driven by py-pde over whirl periods: its own solvers beside ours, trackers, interrupts, progress."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers import slices
from solvers.layer.state import Numerics
from solvers.liquid_history import LayerHistory
from solvers.liquid_model import Whirl
from solvers.pypde.grid import circle
from solvers.pypde.long_wave import AnnularLongWavePDE
from solvers.pypde.settle import film, settle, simulate
from solvers.pypde.stock import names
from solvers.pypde.stretches import Stretches, StretchMeans, settling
from tests.mutants import kills

SPIN, R, H = 40.0, 0.15, 0.05
FILL = Fill(Chamber(R, H), Liquid("water", 1000.0, 1e-6), math.pi * (R**2 - 0.135**2) * H)
WHIRL = Whirl(SPIN, 31.0, 2e-4, ramp=0.4)
FRICTION = Friction("linear", 3.0)


def driven(solver: str, cells: int = 16, gravity: float = 0.0, count: float = 2.0) -> LayerHistory:
    """Whirl periods from rest."""
    whirl = Whirl(SPIN, 31.0, 2e-4, ramp=0.4, gravity=gravity)
    return simulate(FILL, whirl, count * whirl.period, FRICTION, Numerics(cells), solver)


periods = functools.cache(driven)


def gap(found: LayerHistory, exact: LayerHistory) -> float:
    """Largest difference of what is told of the periods, over its size."""
    pairs = [
        (getattr(found, name), getattr(exact, name))
        for name in ("force_ratio", "pressure_ratio", "offset", "depth_max", "depth_min")
    ]
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


# Shares of what is told that the steps leave: (sigma dt)^p at `steps` of the equation, sigma = 10 rad/s, and
# what the trapezium over 64 samples of a period leaves.
APART = {
    "runge-kutta": 3e-4,
    "adams-bashforth": 1e-3,
    "crank-nicolson": 4e-3,
    "implicit": 6e-2,
    "euler": 2e-2,
}


@pytest.mark.parametrize("solver", APART)
def test_py_pdes_own_solvers_agree_with_scipys(solver: str) -> None:
    found = periods(solver)
    assert found.converged and found.time.size == 2
    assert gap(found, periods("scipy")) < APART[solver]


@kills("solvers.pypde.terms:loads_at", "found[0].push_x, found[0].push_y = push.real, push.imag", "pass")
@kills("solvers.pypde.terms:loads_at", "* turn)", "/ turn)")
@kills("solvers.pypde.stretches:StretchMeans._taken", "0.5 * (t", "0.4 * (t")
def test_finite_volumes_approach_them_with_their_order() -> None:
    """Their steps go with the cells': twice as many leave a quarter of what Heun's method leaves.

    From 64 cells on the rectangles rule that the kernel adds the loads up by, half of it.
    """
    gaps = [gap(driven("finite_volume", n, count=3.0), driven("runge-kutta", n, count=3.0)) for n in (16, 32)]
    assert gaps[1] < 0.02 and 1.5 < math.log2(gaps[0] / gaps[1]) < 2.5, gaps


def test_gravity_across_the_axis_is_seen_by_both() -> None:
    gaps = [gap(periods("finite_volume", n, 3.0), periods("runge-kutta", n, 3.0)) for n in (16, 32)]
    # Loads that turn with the drum are added up in rectangles: half of that is of first order.
    assert gaps[1] < 0.03 and gaps[1] < 0.5 * gaps[0], gaps
    assert gap(periods("finite_volume", 32, 3.0), periods("finite_volume", 32)) > 0.05


def test_settled_answers_agree() -> None:
    """Settled to 1e-4; the rest is the steps' share, which goes with the square of the cells'."""
    answers = [settle(FILL, WHIRL, FRICTION, Numerics(16), s) for s in ("finite_volume", "runge-kutta")]
    assert all(found.converged for found in answers)
    assert abs(answers[0].force_ratio[-1] - answers[1].force_ratio[-1]) < 0.02 * abs(
        answers[1].force_ratio[-1]
    )


def test_solvers_that_cannot_are_refused() -> None:
    found = names(AnnularLongWavePDE(FILL, WHIRL))
    assert {"finite_volume", "runge-kutta", "scipy", "euler", "explicit", "implicit"} <= set(found)
    assert not {"milstein", "explicit_mpi", "exponential", "steady_newton"} & set(found)
    for call in (simulate, settle):
        options = (1.0,) if call is simulate else ()
        for name in ("explicit_mpi", "no such"):
            with pytest.raises(InputError, match="one of adams-bashforth"):
                call(FILL, WHIRL, *options, FRICTION, Numerics(16), name)  # type: ignore[operator]
    with pytest.raises(InputError, match="solver"):
        film(FILL, WHIRL, 4, 1.0, FRICTION, Numerics(16), "milstein")


def test_no_digit_depends_on_who_looks_on() -> None:
    """Progress is told at stops that are there anyway, rising to the end."""
    for solver in ("finite_volume", "runge-kutta"):
        told: list[float] = []
        seen = simulate(FILL, WHIRL, 2.0 * WHIRL.period, FRICTION, Numerics(16), solver, told.append)
        alone = periods(solver)
        for name in ("force_ratio", "offset", "depth", "mean_rotation"):
            assert np.array_equal(getattr(seen, name), getattr(alone, name))
        assert told == sorted(told) and told[0] == 0.0 and told[-1] == pytest.approx(1.0, abs=1e-12)
        shown: list[float] = []
        pictures = film(FILL, WHIRL, 6, 1.0, FRICTION, Numerics(16), solver, shown.append)
        assert np.array_equal(pictures.depth, film(FILL, WHIRL, 6, 1.0, FRICTION, Numerics(16), solver).depth)
        assert shown == pytest.approx([k / 6.0 for k in range(6)], abs=1e-12)


def test_pictures_are_at_equal_times_and_agree() -> None:
    ours, theirs = (
        film(FILL, WHIRL, 8, 2.0, FRICTION, Numerics(32), s) for s in ("finite_volume", "runge-kutta")
    )
    for shots in (ours, theirs):
        np.testing.assert_allclose(shots.time, 0.25 * WHIRL.period * np.arange(8), rtol=0.0, atol=1e-12)
        assert shots.depth.shape == (8, 32) and shots.deflection[0] == 0.0
    wave = np.abs(theirs.depth - FILL.depth).max()
    assert np.abs(ours.depth - theirs.depth).max() < 0.03 * wave
    assert np.abs(ours.depth[0] - FILL.depth).max() < 1e-14
    single = film(FILL, WHIRL, 1, 1.0, FRICTION, Numerics(16))
    assert single.depth.shape == (1, 16) and single.time.tolist() == [0.0]


def test_a_ctrl_c_ends_a_run_of_py_pdes(monkeypatch: pytest.MonkeyPatch) -> None:
    """py-pde's controller keeps an interrupt to itself and returns; ours lets it through."""
    eq = AnnularLongWavePDE(FILL, WHIRL, friction=FRICTION)
    state = eq.start(circle(16))

    def broken_off(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("solvers.layer.step.slices", broken_off)
    with pytest.raises(KeyboardInterrupt):
        eq.solve(state, 1.0, tracker=None)
    monkeypatch.setattr(AnnularLongWavePDE, "evolution_rate", broken_off)
    with pytest.raises(KeyboardInterrupt):
        simulate(FILL, WHIRL, 1.0, FRICTION, Numerics(16), "runge-kutta")
    assert slices.SLICE > 0


def test_a_run_that_is_lost_keeps_its_periods() -> None:
    """The layer is told as it stood at the end of the last whole period, where it was."""
    whirl = Whirl(SPIN, 30.0, 7e-3, ramp=0.5)
    fill = Fill(Chamber(R, 0.01), FILL.liquid, 0.99 * math.pi * R**2 * 0.01)
    for solver in ("finite_volume", "runge-kutta"):
        found = simulate(fill, whirl, 2.0, numerics=Numerics(32), solver=solver)
        assert not found.converged and "axis" in found.reason
        assert found.time.size < 3 and np.isfinite(found.depth).all() and found.mass_error < 1e-12


@kills("solvers.pypde.stretches:settling", "len(periods) % 3 == 0", "len(periods) % 2 == 0")
def test_stretches_grow_until_time_is_up() -> None:
    whirl = Whirl(SPIN, 31.0, 1e-4, ramp=3.1 * Whirl(SPIN, 31.0, 1e-4).period)
    plan = settling(whirl, synchronous=False)
    first = round(100.0 / (whirl.period * SPIN))
    assert plan.periods[:7] == [first] * 3 + [2 * first] * 3 + [4 * first]
    assert plan.start == pytest.approx(4.0 * whirl.period)
    assert sum(plan.periods[:-1]) < 400 <= sum(plan.periods) or plan.ends[-2] * SPIN < 20_000.0
    assert max(settling(Whirl(SPIN, 80.0, 1e-4, ramp=1.0), False).periods) <= 64
    few = Stretches((2, 1), 0.5, 0.1)
    np.testing.assert_allclose(few.ends, [0.5, 0.7, 0.8])
    np.testing.assert_allclose(few.stops(2), [0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8])


def test_means_end_a_run_when_they_stay_the_same() -> None:
    """A layer that nothing drives has the same means in each stretch: the run ends after two."""
    eq = AnnularLongWavePDE(FILL, Whirl(SPIN, SPIN, 0.0))
    means = StretchMeans(eq, Stretches((1,) * 50, 0.0, 0.1), settled=1e-4)
    eq.solve(eq.start(circle(16)), 5.0, tracker=[means])
    assert means.steady and len(means.rows) == 2
    assert eq.diagnostics["controller"]["stop_reason"] == "the means no longer change"
