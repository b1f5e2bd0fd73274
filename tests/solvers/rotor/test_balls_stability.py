"""Roots of rotor and balls about the balanced state, against the rotor alone and against motion in time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from meshes.errors import InputError
from solvers.rotor.balls.balancers import BallRace, simulate
from solvers.rotor.balls.stability import balanced_roots
from solvers.rotor.two_plane import Support, TwoPlane
from tests.mutants import kills

SUPPORTS = (Support(0.2, 1e4, 40.0), Support(-0.22, 1.1e4, 40.0))
LONG = TwoPlane(10.0, 0.5, 0.1, SUPPORTS, ())
RACES = (BallRace(0.15, 0.08, (0.015, 0.015), 0.3), BallRace(-0.15, 0.08, (0.015, 0.015), 0.3))


def test_light_balls_leave_the_rotor_alone() -> None:
    """Its own whirls, less the spin as seen from the rotor; the balls' slip decays at drag over mass."""
    speed, system = 120.0, LONG.system()
    light = tuple(replace(race, masses=(1.5e-8,) * 2, drag=3e-7) for race in RACES)
    found = balanced_roots(system, light, speed)
    n = len(system.coordinates)
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.eye(n)
    forces = np.hstack((system.stiffness, system.damping + speed * system.gyroscopic))
    matrix[n:] = -np.linalg.solve(system.mass, forces)
    own = np.linalg.eigvals(matrix)
    # A circle with the spin, e^{i w t} (1, -i), turns at w - spin in the rotor, its mirror image at w + spin:
    # each pair of roots gives one of each, by the sense of its whirl.
    moved = np.concatenate([own - 1j * speed, own + 1j * speed])
    decay = -light[0].drag / (light[0].rolling * light[0].masses[0])
    for root in found:
        expected = np.append(moved, [decay, 0.0])
        # Balls of 1e-8 of the rotor change a root by the root of that at most.
        assert np.abs(expected - root).min() < 1e-3 * speed
    assert np.count_nonzero(np.abs(found - decay) < 1e-3 * speed) == 4


@kills("solvers.rotor.balls.stability:balanced_roots", "jacobian -= speed", "jacobian += speed")
@pytest.mark.parametrize(
    ("damping", "speed", "off", "first", "last"),
    [(0.5, 60.0, 1e-6, 8.0, 20.0), (40.0, 120.0, 1e-4, 3.0, 7.0)],
)
def test_motion_in_time_grows_and_decays_as_the_roots_say(
    damping: float, speed: float, off: float, first: float, last: float
) -> None:
    weak = replace(LONG, supports=tuple(replace(support, damping=damping) for support in SUPPORTS))
    root = balanced_roots(weak.system(), RACES, speed)[0]
    assert (root.real > 0.0) == (damping == 0.5)
    # Balls so little off their places that they stay in the linear part, and above rounding.
    places = [off, np.pi, 0.0, np.pi + 0.2 * off]
    run = simulate(weak.system(), RACES, speed, last, places=places, samples=2001)
    size = np.hypot(*run.coordinates[:, :2].T)
    late = run.time > first
    rate = np.polyfit(run.time[late], np.log(size[late]), 1)[0]
    # Of a beat of the slowest two motions, some ten per cent are left in the slope.
    assert rate == pytest.approx(root.real, rel=0.1)


def test_balls_that_do_not_balance_are_refused() -> None:
    for masses in ((0.015,), (0.015, 0.02)):
        with pytest.raises(InputError):
            balanced_roots(LONG.system(), (replace(RACES[0], masses=masses),), 60.0)
