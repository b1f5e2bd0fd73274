"""Exact waves held on the road of long ones: circles, gravity, another number of nodes, waves that break."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fluid.friction.laws import Friction
from fluid.whirl import body_force_rate, layer_rate, plane_layer
from meshes.errors import InputError
from solvers.held.convergence import Watch
from solvers.held.exact import begin, exact_machine, march, riding
from solvers.held.integrate import hold, hold_with_error, start
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics
from solvers.layer.records import Outcome
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills
from tests.solvers.held.test_integrate import RIG, SMALL

FRICTION, NODES = Friction("linear", 6.0), HoldNumerics(cells=32)


def held(spin: float, exact: bool, gravity: float = 0.0, numerics: HoldNumerics = NODES) -> HeldState:
    """The rig from its synchronous motion."""
    machine = HeldMachine(RIG.system(), (SMALL,), FRICTION, gravity, "potential" if exact else "long_wave")
    steady = response(RIG, [SMALL], [spin], 0.0).coordinates[0]
    growth = float(asynchronous_growth(RIG, [SMALL], np.array([spin]), FRICTION)[0][0])
    return hold(machine, start(machine, spin, numerics, steady), numerics, growth)


@pytest.mark.slow
def test_upright_it_is_the_circle() -> None:
    """Begun off it: what it settles to is the closed form, to the tolerance of settling."""
    wanted = abs(response(RIG, [SMALL], [150.0], 0.0).deflection[0])
    machine = HeldMachine(RIG.system(), (SMALL,), FRICTION, 0.0, liquid="potential")
    steady = response(RIG, [SMALL], [150.0], 0.0).coordinates[0]
    growth = float(asynchronous_growth(RIG, [SMALL], np.array([150.0]), FRICTION)[0][0])
    found = hold(machine, start(machine, 150.0, NODES, 0.99 * steady), NODES, growth)
    assert found.kind is HeldKind.STEADY
    assert found.amplitude == pytest.approx(wanted, rel=4e-4)
    assert found.mass_error < 1e-9
    assert abs(found.mean_rotation[0]) < 1e-3 * 150.0


@kills("solvers.held.exact:_wave", "tanh * gravity", "-tanh * gravity")
@kills("solvers.held.exact:_moment", "spin * over", "over")
def test_gravity_across_begins_as_it_stays() -> None:
    """The small wave of gravity is at rest in space: after a turn the layer is where it began.

    Of second order in the wave's height over the depth, 3 % here.
    """
    heavy = replace(RIG, mass=4e4, stiffness=4e8, unbalance=0.0)
    machine = HeldMachine(heavy.system(), (SMALL,), FRICTION, 9.81, liquid="potential")
    none = np.zeros(2, dtype=complex)
    moment = begin(machine, 150.0, 32, none, 0.0)
    watch = Watch(machine, moment, replace(NODES, turns=16), 0.0)
    watch.count = 15
    after, outcome = march(machine, moment, replace(NODES, turns=16), watch)
    assert outcome is Outcome.DONE
    swing = np.ptp(moment.wave[0, :32])
    assert np.abs(after.wave[0, :32] - moment.wave[0, :32]).max() < 0.1 * swing
    area = moment.area[0] / SMALL.chamber.radius**2
    # No circulation: the velocity along the wall has the mean 0 round it.
    velocity = moment.momentum[0] / SMALL.chamber.radius**4 / area + 150.0 * area
    assert abs(velocity.mean()) < 1e-9 * 150.0


@pytest.mark.slow
def test_gravity_across_and_unbalance_beside_long_waves() -> None:
    """A layer of 0.04 R: long waves are off by the square of that and by their cells."""
    long = held(150.0, False, 9.81, HoldNumerics(cells=128))
    exact = held(150.0, True, 9.81)
    assert exact.kind is HeldKind.PERIODIC
    assert exact.amplitude == pytest.approx(long.amplitude, rel=2e-3)
    assert exact.liquid[0] == pytest.approx(long.liquid[0], rel=2e-2)
    assert exact.ripple[0] == pytest.approx(long.ripple[0], rel=2e-2)
    # Where it lies with gravity half of it is carried round: g/(2 Omega^2).
    assert exact.ripple[0] == pytest.approx(9.81 / 2.0 / 150.0**2, rel=0.1)


def test_another_number_of_nodes() -> None:
    """What a layer holds and how it moves stays; another spin is the same motion in its own time."""
    machine = HeldMachine(RIG.system(), (SMALL,), FRICTION, 9.81, liquid="potential")
    steady = response(RIG, [SMALL], [150.0], 0.0).coordinates[0]
    moment = start(machine, 150.0, HoldNumerics(cells=64), steady)
    from solvers.held.exact import again

    fewer = again(machine, moment, 32)
    assert fewer.wave.shape == (1, 64)
    assert fewer.area.mean() == pytest.approx(moment.area.mean(), rel=1e-12)
    np.testing.assert_allclose(fewer.wave[0, :32], moment.wave[0, :64:2], atol=1e-10)
    faster = moment.at(300.0)
    np.testing.assert_array_equal(faster.wave, moment.wave)
    np.testing.assert_allclose(faster.momentum, 2.0 * moment.momentum)


def test_a_wave_that_breaks_is_not_settled(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hit by three depths times the spin; no more than 64 nodes here."""
    monkeypatch.setattr("solvers.held.exact.MOST", 64)
    machine = HeldMachine(RIG.system(), (SMALL,), FRICTION, 0.0, liquid="potential")
    moment = begin(machine, 150.0, 32, np.zeros(2, dtype=complex), 3.0)
    found = hold(machine, moment, NODES)
    assert found.kind is HeldKind.NOT_SETTLED
    assert any(word in found.reason for word in ("a wave broke", "wants more than", "dry"))


def test_what_does_not_ride_is_a_mass() -> None:
    machine = HeldMachine(RIG.system(), (SMALL,), FRICTION, 9.81, liquid="potential")
    assert riding(machine, 150.0).tolist() == [True]
    assert riding(machine, 5.0).tolist() == [False]
    slow = exact_machine(machine, 5.0, riding(machine, 5.0), 32)
    assert slow.layers == ()
    assert slow.system.mass[0, 0] == pytest.approx(RIG.mass + SMALL.mass)


@kills("fluid.whirl:body_force_rate", "slower_slip(layer.layer_tanh) * spin", "spin")
def test_the_force_damps_as_the_walls_do() -> None:
    layer = plane_layer(SMALL, Friction("stokes"))
    assert layer is not None
    tanh = layer.layer_tanh
    slip = 150.0 * (math.sqrt(tanh * (1.0 + tanh)) - tanh)
    wanted = float(layer_rate(layer, 150.0, -slip).real)
    assert body_force_rate(SMALL, Friction("stokes"), 150.0) == pytest.approx(wanted, rel=1e-12)
    linear = plane_layer(SMALL, Friction("linear", 3.0))
    assert linear is not None
    assert body_force_rate(SMALL, Friction("linear", 3.0), 150.0) == linear.rate
    assert body_force_rate(SMALL, Friction("none"), 150.0) == 0.0


def test_bad_numerics() -> None:
    machine = HeldMachine(RIG.system(), (SMALL,), liquid="potential")
    moment = start(machine, 150.0, NODES)
    for numerics, field in ((replace(NODES, solver="scipy"), "solver"), (replace(NODES, cells=33), "cells")):
        with pytest.raises(InputError, match=field):
            hold_with_error(machine, moment, numerics)
