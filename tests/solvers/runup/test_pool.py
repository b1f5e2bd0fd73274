"""Horizontal drums in a run-up: poured about, become rings and fall; all of it is accounted for."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from fluid.pool import centrifuging_speed, pool_of
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.layer.state import turned_ring
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Handover, Motor, Ramp
from solvers.runup.programme import Programme, Stage
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from tests.mutants import kills

G = 9.81
FILL = Fill(Chamber(0.24, 0.06), Liquid("brine", 1200.0, 1.6e-6), 1.2e-3)
BAFFLED = replace(FILL, chamber=Chamber(0.24, 0.06, 0.2, baffles=Baffles(8, 0.231)))
ROUGH = Friction("quadratic", 0.02)
# Supports so stiff that the axis stands, and none: the machine of 20 kg floats.
STIFF = Jeffcott(20.0, 1e12, 0.0, 0.0)
FREE = Jeffcott(20.0, 1e-9, 0.0, 0.0)
SOFT = Jeffcott(60.0, 11196.0, 309.0, 0.05)


def carried(
    fill: Fill = BAFFLED,
    handover: Handover = Handover.CARRIED,
    friction: Friction = ROUGH,
    stop: float = 60.0,
) -> RunupHistory:
    """Up until a ring stands and down again."""
    numerics = RunupNumerics(cells=64, samples=1200, companion=False, handover=handover)
    time = (stop - 4.0) / 8.0
    return run_up(SOFT.system(), [fill], Ramp(4.0, stop, 8.0, time + 1.0, back=True), friction, G, numerics)


@kills("solvers.runup.long_wave:Coupled._wanted", "formed[self.rests]", "False")
@kills("solvers.runup.state:pours", "pool.half_angle < (", "pool.half_angle < 9.0 + (")
def test_what_reaches_above_the_axis_rests_until_it_is_a_ring() -> None:
    """Four fifths of a ring, three of an open chamber: a mass at the bottom, then a layer at once."""
    ring, free = BAFFLED.chamber, replace(FILL.chamber, height=0.02)
    for fill in (
        replace(BAFFLED, volume=0.8 * ring.capacity),
        Fill(free, FILL.liquid, 0.6 * free.capacity),
    ):
        rough = Friction("quadratic", 0.2)
        pool, forms = pool_of(fill), centrifuging_speed(fill, rough, G)
        history = carried(fill, friction=rough, stop=1.3 * forms)
        assert pool is not None and history.converged and not history.audit.faults and history.transfers
        first = history.transfers[0]
        assert first.captured and forms < first.speed < 1.02 * forms
        before = history.time < first.time
        np.testing.assert_allclose(history.offset[before, 0], -pool.arm, rtol=1e-12)
        np.testing.assert_allclose(history.wet_share[before, 0], pool.half_angle / math.pi, rtol=1e-12)
        assert not history.lifted_share[before, 0].any()


def test_becomes_a_ring_and_falls() -> None:
    """Mass, angular momentum and energy are kept; the ring falls far below where it formed."""
    history = carried()
    assert history.converged
    up, down = history.transfers[0], history.transfers[-1]
    assert up.captured and not down.captured
    own = history.speed + history.mean_rotation[:, 0]
    stands = math.sqrt(G / BAFFLED.surface_radius)
    formed = float(history.speed[np.argmax(own > stands)])
    falls = float(history.speed[np.flatnonzero(own > stands)[-1]])
    # The ring runs ahead of the drum on the way down, and behind it on the way up.
    assert falls < 0.9 * stands < 1.2 * stands < formed < up.speed
    for transfer in history.transfers:
        before, after = transfer.angular_momentum
        # A layer's own is that of its profile.
        assert after == pytest.approx(before, rel=1e-9)
    assert history.mass_error < 1e-12
    assert history.audit.closure < 1e-3 and not history.audit.faults
    lies = history.offset[0, 0].real
    pool = pool_of(BAFFLED)
    assert pool is not None and lies == pytest.approx(-pool.arm, rel=2e-2)
    assert history.wet_share[0, 0] == pytest.approx(pool.half_angle / math.pi, abs=1.0 / 64.0)
    assert history.lifted_share[0, 0] == 0.0
    ring = history.captured[:, 0]
    # Until it falls, when a cell may run dry.
    assert history.wet_share[ring, 0].min() >= 1.0 - 1.0 / 64.0 and history.wet_share[ring, 0].mean() > 0.999
    assert abs(float(history.lifted_share[ring, 0].mean()) - 0.5) < 0.02


@kills("solvers.runup.long_wave:couple", "_FIRM if handover is Handover.DRUM", "_FIRM if False")
def test_firmer_grip_is_earlier() -> None:
    """The rule that shows how far the transition is known: with twice the grip the ring forms earlier."""
    first, other = (carried(handover=rule).transfers[0] for rule in (Handover.DRUM, Handover.CARRIED))
    assert first.speed < 0.98 * other.speed


def test_never_without_friction() -> None:
    """A smooth wall without friction carries nothing; the rule `riding` takes liquid along."""
    history = carried(FILL, friction=Friction(), stop=30.0)
    assert not history.captured.any()
    # No torque acts; the axis alone shakes the pool.
    assert history.audit.drive == 0.0 == history.audit.friction and history.lifted_share.max() < 0.01
    assert carried(FILL, Handover.RIDING, Friction(), 30.0).captured.any()


def test_smooth_walls_carry_later_the_more_liquid() -> None:
    """Thin layers become rings at a lower speed, near the quasi-steady balance."""
    found = []
    for volume in (1e-4, 4e-4):
        fill = replace(FILL, volume=volume)
        history = carried(fill, stop=40.0)
        own = history.speed + history.mean_rotation[:, 0]
        formed = float(history.speed[np.argmax(own > math.sqrt(G / fill.surface_radius))])
        # 8 rad/s^2 is a fast ramp for so little friction.
        assert 0.8 < formed / centrifuging_speed(fill, ROUGH, G) < 1.5
        found.append(formed)
    assert found[0] < found[1]


@kills(
    "solvers.runup.long_wave:Coupled._rearrange",
    "lost -= plane.T @ momentum * anew[j]",
    "lost -= 0.0 * anew[j]",
)
@kills("solvers.runup.long_wave:Coupled._join", "-float(self.shaft.angle)", "float(self.shaft.angle)")
@kills("solvers.runup.long_wave:Coupled._part", "+ self.spin * area", "+ 0.0 * area")
def test_momentum_and_shape_stay() -> None:
    """Cell by cell from one model to the other and back: centre of mass, angular momentum, momentum."""
    machine = couple(FREE.system(), [BAFFLED], 40.0, ROUGH, G, 128, False, handover=Handover.CARRIED)
    assert machine.read().captured[0]
    machine.advance(0.21, 0.0, 0.8, 10**6)
    for stays in (False, True):
        moving = machine.measured() if machine.active[0] else machine._swinging()
        momentum = moving[0][3] if machine.active[0] else moving[0][1]
        rate = machine.state.rate.copy()
        before, turning = machine.read(), machine._turning()[0]
        machine._rearrange(np.array([stays]))
        moving = machine.measured() if machine.active[0] else machine._swinging()
        after = moving[0][3] if machine.active[0] else moving[0][1]
        mass = 20.0 + BAFFLED.mass
        np.testing.assert_allclose(mass * machine.state.rate + after, mass * rate + momentum, atol=1e-12)
        # 64 and 128 cells of straight pieces; a layer's flow has a profile.
        np.testing.assert_allclose(after, momentum, rtol=0.05, atol=0.05 * float(np.abs(momentum).max()))
        assert machine._turning()[0] == pytest.approx(turning, rel=1e-12)
        assert machine.read().offset[0] == pytest.approx(before.offset[0], rel=0.03)


@kills(
    "solvers.layer.state:turned_ring",
    "edges - turns, places, row) + turns",
    "edges - turns, places, row) - turns",
)
def test_turned_rings() -> None:
    """The integral stays, and a smooth density is the same density, turned."""
    for count, angle in ((64, 0.3), (128, -700.1), (96, 2e4)):
        place = 2.0 * math.pi * (np.arange(count) + 0.5) / count
        found = turned_ring(np.stack([2.0 + np.cos(place), np.sin(place)]), angle)
        assert found.mean(axis=1) == pytest.approx([2.0, 0.0], abs=1e-12)
        there = 2.0 * math.pi * (np.arange(count) + 0.5) / count - angle
        np.testing.assert_allclose(found[0], 2.0 + np.cos(there), atol=0.06)


def test_motor_feels_the_liquid() -> None:
    """A motor without torque: drum and liquid share their angular momentum, but for gravity's moment."""
    numerics = RunupNumerics(cells=64, samples=800, companion=False, handover=Handover.CARRIED)
    drive = Motor(10.0, 0.5, (0.0, 100.0), (0.0, 0.0), 2.0)
    history = run_up(STIFF.system(), [BAFFLED], drive, ROUGH, G, numerics)
    machine = couple(STIFF.system(), [BAFFLED], 10.0, ROUGH, G, 64, False, handover=Handover.CARRIED)
    assert history.audit.drive == pytest.approx(0.25 * (10.0**2 - history.speed[-1] ** 2), rel=1e-6)
    machine.drive(np.array([[0.0, 100.0], [0.0, 0.0]]), 0.5)
    machine.advance(2.0, 0.0, 0.8, 10**6)
    weight = BAFFLED.mass * G * -history.offset[:, 0].imag
    taken = float(np.sum(0.5 * (weight[1:] + weight[:-1]) * np.diff(history.time)))
    spun = float(machine._turning()[0][0])
    # Trapezium over samples of 2.5 ms; the moment of the weight as the cells have it.
    assert 0.5 * (10.0 - machine.spin) == pytest.approx(spun + taken, rel=1e-2)
    assert machine.spin < 9.5


def test_a_spinning_drum_begins_with_its_ring() -> None:
    """A drum that has always turned fast begins with a ring; slower, the liquid lies."""
    for fill in (FILL, BAFFLED):
        balance = centrifuging_speed(fill, ROUGH, G)
        for model in (couple, couple_linear):
            for speed, ring in ((1.05 * balance, True), (0.95 * balance, False)):
                given = fill if model is couple else FILL
                if model is couple_linear and fill is BAFFLED:
                    continue
                machine = model(SOFT.system(), [given], speed, ROUGH, G, 32, False, handover=Handover.CARRIED)
                assert bool(machine.read().captured[0]) is ring


def test_solid_and_empty_chambers() -> None:
    """What has no free surface does not move."""
    chamber = replace(FILL.chamber)
    fills = [Fill(chamber, FILL.liquid, 0.0), Fill(chamber, FILL.liquid, chamber.capacity)]
    numerics = RunupNumerics(cells=16, samples=50, companion=False, handover=Handover.CARRIED)
    for model in (couple, couple_linear):
        history = run_up(SOFT.system(), fills, Ramp(4.0, 8.0, 4.0, 2.0), ROUGH, G, numerics, model=model)
        assert history.converged and not history.offset.any() and not history.transfers


def test_up_again_before_it_has_fallen() -> None:
    """A ring that is slowed, and speeded up before it falls, is one layer all the time."""
    stages = (Stage(60.0, rate=8.0), Stage(9.0, rate=8.0), Stage(60.0, rate=8.0))
    numerics = RunupNumerics(cells=32, samples=900, companion=False, handover=Handover.CARRIED)
    history = run_up(SOFT.system(), [BAFFLED], Programme(4.0, stages), ROUGH, G, numerics)
    assert history.converged
    own = history.speed + history.mean_rotation[:, 0]
    since = history.time > history.transfers[0].time
    assert own[since].min() > math.sqrt(G / BAFFLED.surface_radius)
    assert abs(history.offset[since, 0]).max() < 0.12


def test_linear_layers_leave_a_pool_where_it_lies() -> None:
    """They are a mass at the bottom until the drum's own field would hold them."""
    machine = couple_linear(SOFT.system(), [FILL], 5.0, ROUGH, G, 32, False)
    pool = pool_of(FILL)
    assert pool is not None and machine.read().offset[0] == pytest.approx(-pool.arm)
    assert not isinstance(machine, Coupled)
