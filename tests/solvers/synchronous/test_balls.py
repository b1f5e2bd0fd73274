"""States of balls and liquid in one drum."""

from __future__ import annotations

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.liquid import KNOWN_LIQUIDS
from meshes.chamber import Chamber
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.steady import BallKind
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.balls import wet_states
from solvers.synchronous.response import response

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


def test_balls_that_balance_leave_the_liquid_even() -> None:
    fill = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], 3e-5)
    found = wet_states(ROTOR.system(), [fill], [BallRace(0.0, 0.065, (7.1e-3,) * 2, 0.1)], [250.0])
    assert found.states.kind[0, 0] == BallKind.BALANCED
    assert found.states.stable[0, 0]
    assert abs(found.liquid[0, 0, 0]) == 0.0
