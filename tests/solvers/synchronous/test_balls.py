"""States of balls and liquid in one drum."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.liquid import KNOWN_LIQUIDS
from meshes.chamber import Chamber
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.stability import balanced_stability
from solvers.rotor.balls.steady import BallKind
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.balls import wet_states
from solvers.synchronous.response import response
from tests.mutants import kills

ROTOR = Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
SPEED = np.linspace(30.0, 300.0, 10)


@pytest.mark.parametrize("volume", [1e-6, 3e-5])
def test_balls_without_mass_leave_the_response_with_liquid(volume: float) -> None:
    """The response is solved by another code; a wall that runs dry is among the speeds with little liquid."""
    fill = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], volume)
    found = wet_states(ROTOR.system(), [fill], [BallRace(0.0, 0.06, (1e-13,) * 2, 0.1)], SPEED)
    known = response(ROTOR, [fill], SPEED, 0.0)
    assert known.dry_patch.any() == (volume < 1e-5)
    # The liquid's share agrees to 1e-9 of itself.
    np.testing.assert_allclose(np.abs(found.states.coordinates[:, 0, 0]), known.amplitude, rtol=1e-7)
    np.testing.assert_array_equal(found.dry_patch[:, 0], known.dry_patch)
    moved = known.liquid_offset * fill.mass
    np.testing.assert_allclose(np.abs(found.liquid[:, 0, 0]), moved, rtol=1e-7)


@kills("solvers.synchronous.balls:_in_step", "mass, planes", "0.5 * mass, planes")
@kills("solvers.rotor.balls.states:RotorWithBalls.carrying", "mass + added", "mass + 0.9 * added")
def test_small_motions_take_the_liquid_as_a_mass() -> None:
    """About the balanced state liquid that covers its wall counts as a full chamber, 0.26 kg."""
    fill = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], 3e-5)
    race = BallRace(0.0, 0.065, (7.1e-3,) * 2, 0.1)
    density = fill.mass / fill.volume
    heavier = replace(ROTOR, mass=ROTOR.mass + density * np.pi * 0.065**2 * 0.02)
    for speed in (80.0, 250.0):
        found = wet_states(ROTOR.system(), [fill], [race], [speed]).states
        assert found.kind[0, 0] == BallKind.BALANCED
        known = balanced_stability(heavier.system(), [race], speed)
        # Eigenvalues of matrices that differ by rounding.
        assert found.growth[0, 0] == pytest.approx(known.growth, rel=1e-9)


def test_balls_that_balance_leave_the_liquid_even() -> None:
    fill = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], 3e-5)
    found = wet_states(ROTOR.system(), [fill], [BallRace(0.0, 0.065, (7.1e-3,) * 2, 0.1)], [250.0])
    assert found.states.kind[0, 0] == BallKind.BALANCED
    assert found.states.stable[0, 0]
    assert abs(found.liquid[0, 0, 0]) == 0.0
