"""What holding a motion is foretold to take, beside what it took."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.held.cost import hold_seconds, settling_turns
from solvers.held.integrate import hold, start
from solvers.held.state import HeldKind, HeldMachine, HoldNumerics
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills

WATER = Liquid("water", 1000.0, 1e-6)
RIG = Jeffcott(4.0, 4.0 * 110.0**2, 2.0 * 0.1 * 4.0 * 110.0, 6e-4)
SMALL = Fill(Chamber(0.065, 0.02), WATER, 1e-5)


@pytest.mark.parametrize(
    ("spin", "gravity", "friction", "kind"),
    [(60.0, 9.81, 3.0, HeldKind.PERIODIC), (27.0, 9.81, 3.0, HeldKind.LIMIT_CYCLE),
     (130.0, 0.0, 0.5, HeldKind.LIMIT_CYCLE)],
)  # fmt: skip
def test_turns_and_steps_are_those_of_held_motions(
    spin: float, gravity: float, friction: float, kind: HeldKind
) -> None:
    """Dying, thrown about, growing by itself: turns to a factor of two, steps in a turn to a tenth."""
    law, speeds, numerics = Friction("linear", friction), np.array([spin]), HoldNumerics(cells=64)
    growth = asynchronous_growth(RIG, [SMALL], speeds, law)[0]
    machine = HeldMachine(RIG.system(), (SMALL,), law, gravity)
    motion = response(RIG, [SMALL], speeds, 0.0).coordinates[0]
    begin = start(machine, spin, numerics, motion, 0.1 if growth[0] > 0.0 else 0.0)
    found = hold(machine, begin, numerics, float(growth[0]))
    assert found.kind is kind
    strength = gravity / (speeds**2 * SMALL.surface_radius)
    foretold = settling_turns(speeds, growth, strength, numerics)[0, 0]
    assert 0.5 < foretold / found.turns < 2.0
    assert numerics.cells / numerics.courant == pytest.approx(found.steps / found.turns, rel=0.1)


@kills("solvers.held.cost:hold_seconds", "np.square(cells)", "cells")
@kills("solvers.held.cost:hold_seconds", "_CELL * len(surfaces)", "_CELL")
@kills("solvers.held.cost:hold_seconds", "across / (np.square(spin)", "across / (spin")
def test_how_the_time_grows() -> None:
    """Four times with twice the cells, twice with two layers, not at all with an empty chamber."""
    speeds, growth = np.array([50.0, 200.0]), np.array([-1.0, -1.0])
    many = HoldNumerics(cells=4096)
    whole = hold_seconds([SMALL], speeds, growth, numerics=many)
    double = hold_seconds([SMALL], speeds, growth, numerics=HoldNumerics(cells=8192))
    # A turn costs 0.4 ms however few its cells, which is far below 1 % of those that 4096 cost.
    np.testing.assert_allclose(double, 4.0 * whole, rtol=0.01)
    np.testing.assert_allclose(
        hold_seconds([SMALL, SMALL], speeds, growth, numerics=many), 2.0 * whole, rtol=0.01
    )
    empty = Fill(Chamber(0.03, 0.02), WATER, 0.0)
    np.testing.assert_array_equal(hold_seconds([SMALL, empty], speeds, growth, numerics=many), whole)
    lying = hold_seconds([SMALL], speeds, growth, 9.81, many)
    # Gravity counts with the fourth power of its share: 6 % of the centrifugal acceleration at 50 rad/s.
    assert lying[0] > whole[0] and lying[1] == pytest.approx(whole[1], rel=1e-6)


@kills("solvers.held.cost:hold_seconds", "numerics, _FOUND", "numerics")
def test_newton_takes_fewer_turns_than_a_march() -> None:
    """Of a motion that decays: 36 turns, and 48 with half the cells, a quarter of the cost each."""
    speeds, growth, numerics = np.array([200.0]), np.array([-1.0]), HoldNumerics(cells=4096)
    dies = hold_seconds([SMALL], speeds, growth, numerics=numerics)
    grows = hold_seconds([SMALL], speeds, np.array([16.0]), numerics=numerics)
    assert dies / grows == pytest.approx((36.0 + 48.0 / 4.0) / ((4.5 + 2.0 / 4.0) * 32.0), rel=0.01)


@kills("solvers.held.cost:settling_turns", "(growth < 0.0)", "(growth > 0.0)")
@kills("solvers.held.cost:settling_turns", "* 2.0 * math.pi / spin", "* 2.0 * math.pi * spin")
@kills("solvers.held.cost:settling_turns", "(strength < _THROWN)", "(strength > _THROWN)")
@kills(
    "solvers.held.cost:settling_turns", "np.isnan(growth), math.inf, growth", "np.isnan(growth), 0.0, growth"
)
def test_what_is_not_known_counts_as_a_whirl() -> None:
    """Without a growth rate, or none at all, windows decide; never more turns than are allowed."""
    speeds, none, numerics = np.full(3, 100.0), np.zeros(3), HoldNumerics()
    unknown, still, slow = settling_turns(speeds, np.array([math.nan, 0.0, 1e-9]), none, numerics)[0]
    assert unknown == 4.5 * 32.0 and still == slow == numerics.turns
    few = HoldNumerics(turns=16)
    assert (settling_turns(speeds, np.array([-1.0, 1.0, 0.0]), none, few) == 16.0).all()
    # One that grows by half in 80 turns is watched over windows of 80; one that dies, over none.
    change = 0.5 / 80.0 * 100.0 / (2.0 * math.pi)
    thrown = np.array([0.0, 0.0, 0.2])
    grows, dies, falls = settling_turns(speeds, change * np.array([1.0, -1.0, -1.0]), thrown, numerics)[0]
    assert grows == pytest.approx(4.5 * 80.0) == falls and dies == 60.0
