"""Seeded faults of pools in the steps, and their oracles, run as plain Python by `test_uncompiled.py`."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from fluid.pool import Pool, balance_speed, pool_of, wall_torque
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Handover
from tests.mutants import kills

G = 9.81
ROUGH = Friction("quadratic", 0.02)
FILL = Fill(Chamber(0.24, 0.06), Liquid("brine", 1200.0, 1.6e-6), 1.2e-3)
POOL = pool_of(FILL)
assert isinstance(POOL, Pool)
# Supports so stiff that the axis stands, and none: the machine of 20 kg floats.
STIFF = Jeffcott(20.0, 1e12, 0.0, 0.0)
FREE = Jeffcott(20.0, 1e-9, 0.0, 0.0)
MODELS = (couple, couple_linear)


def lying(machine: Any, lean: float, rate: float) -> None:
    """Put the pool of a machine of either kind there."""
    if isinstance(machine, Coupled):
        machine.state.lean[:], machine.state.lean_rate[:] = lean, rate
        machine.lean[:], machine.lean_rate[:] = lean, rate
    else:
        machine.machine.place[2], machine.machine.rate[2] = lean, rate


def seen(machine: Any) -> float:
    """Angle of the pool."""
    return float(machine.lean[0] if isinstance(machine, Coupled) else machine.machine.place[2])


@kills("solvers.runup.kernel:_move_pools", "x * np.sin(turned) - y", "x * np.sin(turned) + y")
@kills("solvers.runup.kernel:_move_pools", "np.cos(turned)) / pool.length", "np.cos(turned)) / pool.arm")
@kills("solvers.runup.linear_kernel:_swing", "m.left[row, i] = along", "m.left[row, i] = 0.0")
@kills(
    "solvers.runup.linear_kernel:_swing", "m.left[row, row] = pool.inertia +", "m.left[row, row] = moving +"
)
def test_sloshing() -> None:
    """Small swings: g/l with the axis held; where the machine floats sideways, its mass shares the motion."""
    for model in MODELS:
        for rotor, share in ((STIFF, 0.0), (FREE, FILL.mass / (20.0 + FILL.mass) * POOL.arm / POOL.length)):
            machine = model(rotor.system(), [FILL], 2.0, Friction(), G, 256, False, handover=Handover.CARRIED)
            lying(machine, 0.01, 0.0)
            frequency = math.sqrt(G / POOL.length / (1.0 - share))
            quarter = 0.5 * math.pi / frequency
            for k in range(1, 5):
                machine.advance(k * quarter, 0.0, 0.8, 10**6)
                # Steps of 0.01 s: an error of (omega dt)^2/24 of the time, amplitudes of 0.01^2/16.
                assert seen(machine) == pytest.approx(0.01 * math.cos(0.5 * math.pi * k), abs=6e-5)


@kills("solvers.runup.kernel:dragged", "2.0 * inertia * (both - mean)", "0.0 * (both - mean)")
@kills("solvers.runup.linear_kernel:_hold", "impulse / (dt * mean)", "0.0 / (dt * mean)")
def test_lean() -> None:
    """At constant speed the pool comes to rest where the walls' drag and gravity balance."""
    friction = Friction("linear", 5.0)
    speed = 0.5 * balance_speed(FILL, POOL, friction, G)
    lean = math.asin(float(wall_torque(FILL, POOL, friction, speed)) / (FILL.mass * G * POOL.arm))
    assert lean == pytest.approx(math.asin(0.5))
    for model in MODELS:
        machine = model(STIFF.system(), [FILL], speed, friction, G, 32, False, handover=Handover.CARRIED)
        machine.advance(10.0, 0.0, 0.8, 10**6)
        # The linear law takes the swing away at 5 (r^2)/(l_c l) times a half: nothing is left of it.
        assert seen(machine) == pytest.approx(lean, rel=1e-6)
        assert machine.read().mean_rotation[0] == pytest.approx(-speed, rel=1e-6)
        offset = -POOL.arm * complex(math.cos(lean), math.sin(lean))
        assert machine.read().offset[0] == pytest.approx(offset, rel=1e-6)


@kills(
    "solvers.runup.kernel:_tally",
    "sums.friction += past * room.drag[j]",
    "sums.friction -= past * room.drag[j]",
)
@kills("solvers.runup.kernel:_tally", "sums.drive += spin * room.drag", "sums.drive += past * room.drag")
@kills("solvers.runup.linear_kernel:_tally", "dt * (spin - swing) * torque", "dt * spin * torque")
@kills("solvers.runup.linear_kernel:_tally", "dt * moving * swing * (x - y)", "0.0 * (x - y)")
def test_energy() -> None:
    """What the drum gives a swinging pool is heat, motion of pool and axis, and height."""
    for model in MODELS:
        rotor = Jeffcott(20.0, 2000.0, 0.0, 0.0)
        friction, kept = Friction("linear", 3.0), Handover.CARRIED
        machine: Any = model(rotor.system(), [FILL], 6.0, friction, G, 64, False, handover=kept)
        lying(machine, 0.5, 1.0)
        begin = machine.energy()
        machine.advance(1.5, 0.0, 0.8, 10**6)
        sums = machine.sums
        gained, spent = sums.drive + sums.gravity, sums.friction
        # Of second order in steps of 0.013 s, beside swings of 6 rad/s: (omega dt)^2/12.
        assert machine.energy() - begin == pytest.approx(gained - spent, abs=2e-3 * abs(sums.drive))


@kills("solvers.runup.kernel:dragged", "(2.0 * mean - slip) * slip <= 0.0", "False")
def test_drag_stops_no_more_than_the_slip() -> None:
    """However stiff: the slip is gone, not turned round; its energy is heat, and the account closes."""
    stiff = Fill(replace(FILL.chamber, baffles=Baffles(12, 0.2395)), FILL.liquid, 1e-4)
    for model in MODELS:
        machine: Any = model(STIFF.system(), [stiff], 2.0, ROUGH, 1.5, 200, False, handover=Handover.CARRIED)
        machine.machine.drags[:, 1] *= 1e6
        begin, slips = machine.energy(), []
        for k in range(1, 30):
            machine.advance(0.1 * k, 0.0, 0.8, 10**6)
            slips.append(-float(machine.read().mean_rotation[0]))
        sums = machine.sums
        # Without that rule the slip of 2 rad/s swings to and fro; gravity asks for one of 3e-3.
        assert max(map(abs, slips)) < 1e-2
        # The energy of the slip is heat; what gravity lets slip adds 2 %.
        inertia = pool_of(stiff).inertia
        assert sums.friction == pytest.approx(0.5 * inertia * 2.0**2, rel=3e-2)
        left = sums.drive + sums.gravity - sums.friction - (machine.energy() - begin)
        # Of second order in steps of 13 ms on a path of 2 rad/s, beside lifts of three times that energy.
        assert abs(left) < 1e-3 * sums.friction
