"""Pools in a run-up: they lean, slosh, are carried round and become layers; all of it is accounted for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from fluid.pool import Pool, balance_speed, pool_of
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Handover, Motor, Ramp
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from tests.mutants import kills

G = 9.81
FILL = Fill(Chamber(0.24, 0.06), Liquid("brine", 1200.0, 1.6e-6), 1.2e-3)
POOL = pool_of(FILL)
assert isinstance(POOL, Pool)
ROUGH = Friction("quadratic", 0.02)
# Supports so stiff that the axis stands, and none: the machine of 20 kg floats.
STIFF = Jeffcott(20.0, 1e12, 0.0, 0.0)
FREE = Jeffcott(20.0, 1e-9, 0.0, 0.0)
SOFT = Jeffcott(60.0, 11196.0, 309.0, 0.05)
MODELS = (couple, couple_linear)


def lying(machine: object, lean: float, rate: float) -> None:
    """Put the pool of a machine of either kind there."""
    if isinstance(machine, Coupled):
        machine.state.lean[:], machine.state.lean_rate[:] = lean, rate
        machine.lean[:], machine.lean_rate[:] = lean, rate
    else:
        machine.machine.place[2], machine.machine.rate[2] = lean, rate


def carried(
    handover: Handover, cells: int = 32, model: object = couple, friction: Friction = ROUGH
) -> RunupHistory:
    """Up through the speed of balance and down again."""
    numerics = RunupNumerics(cells=cells, samples=1200, companion=False, handover=handover)
    ramp = Ramp(4.0, 24.0, 4.0, 12.0, back=True)
    return run_up(SOFT.system(), [FILL], ramp, friction, G, numerics, model=model)


@kills("solvers.runup.long_wave:Coupled._uniform", "-lag * (1.0 - self.area) * self.area", "-lag * self.area")
def test_carried_and_fallen() -> None:
    """Caught near the speed of balance, let go far below; mass, angular momentum and energy are kept."""
    history = carried(Handover.CARRIED)
    assert history.converged
    up, down = history.transfers[0], history.transfers[-1]
    assert up.captured and not down.captured
    balance = balance_speed(FILL, POOL, ROUGH, G)
    # The pool needs the time of a swing or two to be carried over the top: the ramp goes on meanwhile.
    assert balance < up.speed < balance + 2.0 * 4.0 * 2.0 * math.pi * math.sqrt(POOL.length / G)
    # Down again the ring stays until its own rotation is near that of sqrt(g/a): hysteresis.
    assert down.speed < 0.75 * up.speed
    for transfer in history.transfers:
        before, after = transfer.angular_momentum
        assert after == pytest.approx(before, rel=1e-9)
    # It is spread on its way over the top, and its weight comes down with that.
    assert up.lifted < 0.0 and down.lifted < 0.0
    # On its way over the top the pool has more energy than the layer, the ring more than the pool at rest.
    assert up.lost > 0.0 and down.lost > 0.0
    assert history.mass_error < 1e-12
    # Of second order in the step; what the changes bring in would be seen.
    assert history.audit.closure < 5e-3


@kills("solvers.runup.state:CoupledRotor.caught", "(self.spin > self.balance)", "(self.spin > 0.0)")
def test_taken_along_by_the_drum() -> None:
    """The other hand-over: at the speed of balance, at once; the drum gives the angular momentum."""
    history = carried(Handover.DRUM)
    up = history.transfers[0]
    assert history.converged and up.captured
    assert up.speed == pytest.approx(balance_speed(FILL, POOL, ROUGH, G), rel=0.01)
    spread = 0.5 * FILL.mass * (0.24**2 + FILL.surface_radius**2)
    assert up.angular_momentum[1] == pytest.approx(spread * up.speed, rel=1e-9)
    assert up.angular_momentum[0] < 0.2 * up.angular_momentum[1]
    # The drum pays.
    assert up.lost < 0.0


def test_never_without_friction() -> None:
    """A smooth wall carries nothing; the old rule takes the liquid along all the same."""
    assert not carried(Handover.CARRIED, friction=Friction()).captured.any()
    assert carried(Handover.RIDING, friction=Friction()).captured.any()


def test_linear_layers_fall_and_rise_alike() -> None:
    """The other model's pool moves alike until it is caught; its account closes as well."""
    friction = Friction("linear", 2.0)
    waves, linear = (carried(Handover.CARRIED, model=model, friction=friction) for model in MODELS)
    first, other = waves.transfers[0], linear.transfers[0]
    assert other.speed == pytest.approx(first.speed, rel=0.01)
    before = waves.time < min(first.time, other.time)
    # Two ways of second order through the same swings.
    np.testing.assert_allclose(linear.offset[before], waves.offset[before], atol=0.01 * POOL.arm)
    for transfer in linear.transfers:
        assert transfer.angular_momentum[1] == pytest.approx(transfer.angular_momentum[0], rel=1e-9)
    assert linear.audit.closure < 1e-2


@kills(
    "solvers.runup.long_wave:Coupled._rearrange",
    "lost -= plane.T @ momentum * anew[j]",
    "lost -= 0.0 * anew[j]",
)
@kills("solvers.runup.state:CoupledRotor.caught", "np.cos(self.lean) < 0.0", "np.cos(self.lean) < 9.0")
def test_momentum_stays() -> None:
    """Rotor and liquid keep their momentum when a pool goes round as a layer, and when it falls."""
    for model in MODELS:
        machine = model(FREE.system(), [FILL], 15.0, ROUGH, G, 32, False, handover=Handover.CARRIED)
        assert not machine.read().captured[0]
        # Fast enough, but still below the axis.
        lying(machine, 0.2, 12.0)
        machine.switch()
        assert not machine.read().captured[0]
        lying(machine, 3.0, 12.0)
        pool = FILL.mass * 12.0 * POOL.arm * np.array([math.sin(3.0), -math.cos(3.0)])
        machine.switch()
        assert machine.read().captured[0]
        rate = machine.state.rate if isinstance(machine, Coupled) else machine.machine.rate[:2]
        np.testing.assert_allclose((20.0 + FILL.mass) * rate, pool, rtol=1e-9)
        own = machine.spin + float(machine.read().mean_rotation[0])
        spread = 0.5 * FILL.mass * (0.24**2 + FILL.surface_radius**2)
        # The mean rotation of a layer is that of its flux, a little off that of its angular momentum.
        assert own == pytest.approx(POOL.inertia * 12.0 / spread, rel=0.15)
        before = (20.0 + FILL.mass) * rate
        machine.shaft.spin = 0.5
        if not isinstance(machine, Coupled):
            machine.machine.carried[:] = 3.0
        machine.switch()
        assert not machine.read().captured[0]
        rate = machine.state.rate if isinstance(machine, Coupled) else machine.machine.rate[:2]
        swing = 0.5 + float(machine.read().mean_rotation[0])
        moving = 1j * swing * FILL.mass * complex(machine.read().offset[0])
        assert abs(moving) > 1e-3
        after = (20.0 + FILL.mass) * rate + np.array([moving.real, moving.imag])
        np.testing.assert_allclose(after, before, rtol=1e-9)


def test_motor_feels_the_pool() -> None:
    """A motor without torque: drum and pool share their angular momentum, but for gravity's moment."""
    drive = Motor(10.0, 0.5, (0.0, 100.0), (0.0, 0.0), 2.0)
    for model in MODELS:
        numerics = RunupNumerics(cells=32, samples=400, companion=False, handover=Handover.CARRIED)
        history = run_up(STIFF.system(), [FILL], drive, ROUGH, G, numerics, model=model)
        lean = np.unwrap(np.angle(-history.offset[:, 0]))
        swing = history.speed + history.mean_rotation[:, 0]
        weight = FILL.mass * G * POOL.arm * np.sin(lean)
        taken = np.concatenate(([0.0], np.cumsum(0.5 * (weight[1:] + weight[:-1]) * np.diff(history.time))))
        total = 0.5 * (history.speed - 10.0) + POOL.inertia * swing + taken
        # Trapezium over samples of 5 ms, steps of second order.
        assert np.abs(total).max() < 2e-3 * np.abs(taken).max()
        assert history.speed[-1] < 9.9


def test_resting_layers_stay_layers() -> None:
    """A drum that has always turned faster than the balance begins with its ring; slower, it lies."""
    balance = balance_speed(FILL, POOL, ROUGH, G)
    for model in MODELS:
        for speed, ring in ((1.05 * balance, True), (0.95 * balance, False)):
            for handover in (Handover.CARRIED, Handover.DRUM):
                machine = model(SOFT.system(), [FILL], speed, ROUGH, G, 32, False, handover=handover)
                assert bool(machine.read().captured[0]) is ring


def test_solid_and_empty_chambers() -> None:
    """What has no free surface does not swing."""
    chamber = replace(FILL.chamber)
    fills = [Fill(chamber, FILL.liquid, 0.0), Fill(chamber, FILL.liquid, chamber.capacity)]
    numerics = RunupNumerics(cells=16, samples=50, companion=False, handover=Handover.CARRIED)
    for model in MODELS:
        history = run_up(SOFT.system(), fills, Ramp(4.0, 8.0, 4.0, 2.0), ROUGH, G, numerics, model=model)
        assert history.converged and not history.offset.any() and not history.transfers


@kills(
    "solvers.runup.state:CoupledRotor.fallen_rate", "np.square(own) + given", "np.square(own) + 9.0 * given"
)
def test_no_fall_gives_energy() -> None:
    """A fast layer that gravity throws down keeps what energy it has; a slow one its angular momentum."""
    machine = couple(STIFF.system(), [FILL], 30.0, ROUGH, G, 32, False, handover=Handover.CARRIED)
    spread = 0.5 * FILL.mass * (0.24**2 + FILL.surface_radius**2)
    for own, whole in ((6.0, True), (-6.0, True), (60.0, False)):
        rate = float(machine.fallen_rate(np.array([own]))[0])
        assert (rate == pytest.approx(spread * own / POOL.inertia)) is whole
        energy, now = 0.5 * spread * own**2, 0.5 * POOL.inertia * rate**2 - FILL.mass * G * POOL.arm
        assert now <= energy * (1.0 + 1e-12)
        assert whole or now == pytest.approx(energy)


@pytest.mark.parametrize("friction", [Friction("linear", 20.0), Friction("quadratic", 0.5)])
def test_drag_is_of_second_order(friction: Friction) -> None:
    """A pool dragged from rest beside its own equation: half the step, a quarter of the error."""
    spin, time = 6.0, 0.4
    pace, torque = couple(STIFF.system(), [FILL], spin, friction, G, 32, False).drags[0]

    def rates(_: float, state: np.ndarray) -> list[float]:
        slip = spin - state[1]
        pull = math.copysign(float(np.interp(abs(slip), pace, torque)), slip)
        return [state[1], pull / POOL.inertia - G / POOL.length * math.sin(state[0])]

    exact = solve_ivp(rates, (0.0, time), [0.0, 0.0], rtol=1e-9, atol=1e-11).y[:, -1]
    for model in MODELS:
        errors = []
        # Steps of 19, 9.5 and 4.8 ms; drag takes a slip of 6 rad/s away at about 20 1/s.
        for cells in (44, 88, 176):
            machine = model(
                STIFF.system(), [FILL], spin, friction, G, cells, False, handover=Handover.CARRIED
            )
            machine.advance(time, 0.0, 0.8, 10**6)
            reading = machine.read()
            found = machine.lean[0] if isinstance(machine, Coupled) else machine.machine.place[2]
            errors.append([found - exact[0], reading.mean_rotation[0] + spin - exact[1]])
        size = np.linalg.norm(errors, axis=1)
        # Four, but for the next term of the error, of the order of the step over the time constant.
        np.testing.assert_allclose(size[:-1] / size[1:], 4.0, rtol=0.25)
