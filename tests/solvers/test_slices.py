"""Compiled loops come back to Python often, end, and give the same digits whatever the slice."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers import slices
from solvers.layer.records import Outcome
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import settle, simulate
from solvers.rotor.balls import balancers
from solvers.rotor.exciter.machine import Dimensionless
from solvers.rotor.exciter.motion import integrate
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Motor, Ramp
from solvers.runup.runup import RunupNumerics, run_up
from tests.oracles.bare_layer import BareLayer

WATER = Liquid("water", 1000.0, 1e-6)
STOKES = Friction(FrictionLaw.STOKES)
ROTOR = Jeffcott(5.0, 5.0 * 30.0**2, 30.0, 5e-4)


def fill() -> Fill:
    return Fill(Chamber(radius=0.1, height=0.05), WATER, volume=1e-4)


def layer() -> np.ndarray:
    """Ten whirl periods of a layer in friction and gravity."""
    whirl = Whirl(spin=40.0, speed=31.0, amplitude=2e-3, ramp=0.3, gravity=9.81)
    found = simulate(fill(), whirl, 10.0 * whirl.period, STOKES, Numerics(cells=48))
    assert found.converged
    return np.concatenate([found.force_ratio, found.depth])


def runup(model, drive) -> np.ndarray:  # type: ignore[no-untyped-def]
    """A run through the resonance."""
    numerics = RunupNumerics(cells=24, samples=12, companion=False)
    found = run_up(ROTOR.system(), [fill()], drive, STOKES, 0.0, numerics, model=model)
    assert found.converged
    return np.concatenate([found.deflection.ravel(), found.offset.ravel(), found.speed])


RAMP = Ramp(start=15.0, stop=45.0, rate=60.0, duration=0.6)
MOTOR = Motor(start=15.0, inertia=0.05, speeds=(0.0, 60.0), torques=(5.0, 0.0), duration=0.6)


def balls() -> np.ndarray:
    found = balancers.simulate(
        *(ROTOR.system(), [balancers.BallRace(0.0, 0.1, (0.05, 0.05), 0.1)], 60.0, 1.0), samples=5
    )
    return np.concatenate([found.coordinates.ravel(), found.ball_angle.ravel()])


def exciter() -> np.ndarray:
    found = integrate(Dimensionless(0.02, 0.4, 0.25, 0.03), 4.0, duration=50.0)
    return np.concatenate([found.ball_speed.ravel(), found.spread])


LOOPS = {
    "layer": layer,
    "long waves on a ramp": lambda: runup(couple, RAMP),
    "long waves and a motor": lambda: runup(couple, MOTOR),
    "linear layers on a ramp": lambda: runup(couple_linear, RAMP),
    "linear layers and a motor": lambda: runup(couple_linear, MOTOR),
    "balls": balls,
    "exciter": exciter,
}


@pytest.mark.parametrize("name", LOOPS)
def test_no_digit_depends_on_the_slice(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = LOOPS[name]()
    for length in (1, 1000):  # a step at a time, and some
        monkeypatch.setattr(slices, "SLICE", length)
        assert np.array_equal(LOOPS[name](), whole), length


@pytest.mark.parametrize("name", LOOPS)
def test_an_interrupt_comes_through_between_slices(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each loop asks for a second slice, in which Python would hear a Ctrl-C."""
    whole, asked = slices.slices, []

    def heard(*given: int):  # type: ignore[no-untyped-def]
        for k, part in enumerate(whole(*given)):
            asked.append(k)
            if k > 0:
                raise KeyboardInterrupt
            yield part

    monkeypatch.setattr(slices, "SLICE", 1)
    for module in (
        "layer.step",
        "runup.long_wave",
        "runup.linear",
        "rotor.balls.steps",
        "rotor.exciter.steps",
    ):
        monkeypatch.setattr(f"solvers.{module}.slices", heard)
    with suppress(KeyboardInterrupt, AssertionError):  # a run-up keeps what it has reached and says so
        LOOPS[name]()
    assert max(asked) == 1


def test_slices_make_up_the_steps() -> None:
    for steps, size in ((0, 5), (1, 1), (10**6, 3), (10**4, 10**6), (7, 10**9)):
        parts = list(slices.slices(steps, size))
        assert sum(parts) == steps and all(part > 0 for part in parts)
        assert all(part * size <= max(slices.SLICE, size) for part in parts)


def test_a_film_that_runs_away_ends_the_run() -> None:
    """A film that turns a million times as fast as the drum is no answer, whatever made it so."""
    layer = BareLayer(fill(), Whirl(spin=40.0, speed=31.0, amplitude=2e-3), STOKES, Numerics(cells=48))
    layer.momentum[5] = 1e6 * layer.area[5]
    layer.advance(most=5)
    assert layer.outcome is Outcome.RAN_AWAY


def test_films_of_a_strong_whirl_do_not_run_away() -> None:
    """A whirl nearly as strong as the spin leaves the wall dry; films on its steep bed once gained speed."""
    whirl = Whirl(spin=1.0, speed=10.594, amplitude=0.0087)
    found = settle(Fill(Chamber(1.0, 2.986), WATER, 0.24302), whirl, STOKES, Numerics(cells=32))
    assert not found.converged and Outcome.RAN_AWAY.message not in found.reason


def test_steps_run_out() -> None:
    """Where films are slow enough to go on for ever the budget ends the run, and the reason names it."""
    layer = BareLayer(fill(), Whirl(spin=40.0, speed=31.0, amplitude=2e-3), STOKES, Numerics(cells=48))
    layer.advance(most=5)
    assert layer.outcome is Outcome.RAN_OUT and layer.steps == 5
    for model in (couple, couple_linear):
        machine = model(ROTOR.system(), [fill()], 20.0, STOKES, 0.0, 24, False)
        assert machine.advance(1.0, 0.0, 0.8, 5) is Outcome.RAN_OUT
        assert 0.0 < machine.time < 1.0


def test_a_run_up_has_a_budget(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run whose steps run out says so and keeps what it has reached."""
    monkeypatch.setattr("solvers.runup.runup.step_budget", lambda *_: 3)
    numerics = RunupNumerics(cells=24, samples=12, companion=False)
    found = run_up(ROTOR.system(), [fill()], RAMP, STOKES, 0.0, numerics)
    assert found.outcome is Outcome.RAN_OUT and not found.converged
    assert Outcome.RAN_OUT.message in found.reason
