"""Swings of balls by gravity across the axis, against the equations of motion in time and a closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

import leblanc as lb
from fluid.friction.laws import Friction
from meshes.arrays import Array, Complex
from solvers.layer.records import Outcome
from solvers.rotor.balls.balancers import BallRace, simulate, with_balls_at
from solvers.rotor.balls.steady import steady_states
from solvers.rotor.balls.swing import ball_swing, gravity_swing, swing_power
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.runup.balls import Balls
from solvers.runup.long_wave import couple
from tests.mutants import kills

ROTOR = Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
PLANES = TwoPlane(
    10.0, 0.5, 0.1,
    (Support(0.3, 2e4, 400.0), Support(-0.3, 2e4, 400.0)),
    (PlaneUnbalance(0.2, 3e-4, 0.4), PlaneUnbalance(-0.2, 2e-4, 2.5)),
)  # fmt: skip
SHARE = 0.02  # of gravity in the centrifugal acceleration; what is left out is of its square
TURNS = 60  # at the end of a motion, over which its parts are taken


def state(system: RotorSystem, races: Sequence[BallRace], speed: float) -> tuple[Array, Complex, float]:
    """Places and coordinates of the state that fades fastest, and its growth."""
    found = steady_states(system, races, [speed])
    k = int(np.nanargmin(np.where(found.kind[0] > 0, found.growth[0], np.inf)))
    assert found.growth[0, k] < 0.0
    return found.places[0, k], found.coordinates[0, k], float(found.growth[0, k])


def case(kind: str) -> tuple[RotorSystem, list[BallRace], float]:
    """A rotor with balls, and a speed at which they rest."""
    if kind == "heavy":
        return ROTOR.system(), [BallRace(0.0, 0.065, (0.2, 0.2), 1.0)], 200.0
    if kind == "unbalanced":  # the balls do not hold the unbalance, and stand where the axis moves outward
        return replace(ROTOR, unbalance=6e-3).system(), [BallRace(0.0, 0.065, (2e-3, 2e-3), 0.06)], 110.0
    if kind == "two_plane":
        return PLANES.system(), [BallRace(z, 0.1, (0.01, 0.01), 0.1) for z in (0.25, -0.2)], 160.0
    tub = lb.example("tub").rotor.machine()
    return tub.system(), [BallRace(tub.drum_position[1], 0.2, (0.8, 0.8), 10.0)], 60.0


def compare_with_motion(kind: str) -> None:
    """A fourth-order integration from the state at rest, until its start has faded."""
    system, races, speed = case(kind)
    places, coordinates, rate = state(system, races, speed)
    gravity = SHARE * races[0].radius * speed**2
    turns = TURNS + math.ceil(9.0 / -rate * speed / (2.0 * math.pi))
    duration = turns * 2.0 * math.pi / speed
    run = simulate(
        system, races, speed, duration, places=places, gravity=gravity, samples=turns * 16 + 1, steps=64
    )
    rows = slice(-TURNS * 16 - 1, -1)
    time = run.time[rows]
    psi = run.ball_angle[rows] - speed * time[:, None]
    seen = 2.0 * np.mean(psi * np.exp(-1j * speed * time)[:, None], axis=0)
    # To second order the balls go a little round; they swing about where they are then. There gravity acts
    # against the second direction, here against the first: a quarter turn.
    swing = gravity_swing(system, races, speed, psi.mean(axis=0), coordinates, gravity)
    scale = np.abs(swing.balls).max()
    np.testing.assert_allclose(1j * seen, swing.balls, rtol=0.0, atol=0.25 * SHARE * scale)
    moved = 2.0 * np.mean(run.coordinates[rows] * np.exp(-2j * speed * time)[:, None], axis=0)
    size = np.abs(swing.coordinates).max()
    np.testing.assert_allclose(np.abs(moved), np.abs(swing.coordinates), rtol=0.0, atol=0.25 * SHARE * size)


@kills("solvers.rotor.balls.swing:gravity_swing", "- 4.0 * speed**2 * np.conj", "+ 4.0 * speed**2 * np.conj")
@kills("solvers.rotor.balls.swing:gravity_swing", "4.0 * speed**2 * whole", "speed**2 * whole")
def test_heavy_balls_swing_with_their_rotor() -> None:
    compare_with_motion("heavy")


@kills("solvers.rotor.balls.swing:gravity_swing", "+ speed**2 * outward", "- speed**2 * outward")
def test_balls_of_a_rotor_out_of_balance_swing() -> None:
    compare_with_motion("unbalanced")


@pytest.mark.parametrize("kind", ["two_plane", "tub"])
def test_balls_of_rotors_that_tilt_swing(kind: str) -> None:
    """Supports that differ bring back a part that is left out, and is small."""
    compare_with_motion(kind)


@kills("solvers.rotor.balls.swing:ball_swing", "np.hypot(rolling, rate / speed)", "rolling")
def test_a_stiff_rotor_leaves_each_ball_alone() -> None:
    """kappa R (psi'' + b/(kappa m) psi') = g sin(Omega t + psi): the closed form, and its phase."""
    stiff = Jeffcott(4.0, 1e12, 1e3, 0.0).system()
    race, speed, place = BallRace(0.0, 0.1, (0.01,), 0.9), 50.0, np.array([0.7])
    swing = gravity_swing(stiff, [race], speed, place, np.zeros(2, dtype=complex), 9.81)
    closed = ball_swing(np.array(speed), np.array(0.1), np.array(90.0), np.array(1.4), 9.81)
    assert abs(swing.balls[0]) == pytest.approx(float(closed), rel=1e-6)
    whole = -1j * 9.81 / 0.1 * np.exp(0.7j) / (-1.4 * speed**2 + 90.0j * speed)
    assert swing.balls[0] == pytest.approx(whole, rel=1e-6)
    # With the spin it is far from the swing of a pendulum: it falls as its square.
    fast = ball_swing(np.array([1e3, 2e3]), np.array(0.1), np.array(0.0), np.array(1.4), 9.81)
    assert fast[0] / fast[1] == pytest.approx(4.0)


@kills("solvers.rotor.balls.swing:swing_power", "0.5 * speed**2", "speed**2")
def test_a_run_up_held_at_a_speed_swings_so() -> None:
    """The steps of run-ups, gravity against the first direction, in phase."""
    race, speed = BallRace(0.0, 0.065, (7.1e-3, 7.1e-3), 0.1), 150.0
    places, coordinates, _ = state(ROTOR.system(), [race], speed)
    swing = gravity_swing(ROTOR.system(), [race], speed, places, coordinates, 9.81)
    balls = Balls((race,), tuple(places), (1.0, 1.0))
    made = couple(ROTOR.system(), (), speed, Friction(), 9.81, 64, False, balls=balls)
    turn, rows, heat = 2.0 * math.pi / speed, [], []
    for k in range(32 * 20 + 1):
        assert made.advance(4.0 + k * turn / 32.0, 0.0, 0.8, 10**7) is Outcome.DONE
        reading = made.read()
        rows.append([reading.time, *(reading.ball_angle - places)])
        heat.append(float(made.sums.friction))
    time, psi = np.array(rows)[:-1, 0], np.array(rows)[:-1, 1:]
    power = (heat[-1] - heat[0]) / (20 * turn)
    assert power == pytest.approx(swing_power([race], speed, swing.balls), rel=0.02)
    # Told in the drum's frame or in the standing one.
    if abs(psi[0, 0]) > 3.0:
        psi = psi - speed * time[:, None]
    seen = 2.0 * np.mean(psi * np.exp(-1j * speed * time)[:, None], axis=0)
    np.testing.assert_allclose(seen, swing.balls, rtol=0.0, atol=0.01 * np.abs(swing.balls).max())


@kills("solvers.rotor.balls.balancers:with_balls_at", "balls[:, 0], axes, axes", "balls[:, 1], axes, axes")
@kills("solvers.rotor.balls.balancers:with_balls_at", "- 1j * axes[:, 1]", "+ 1j * axes[:, 1]")
def test_balls_held_where_they_rest_move_the_rotor_as_they_do() -> None:
    """The rotor of balls and rotor together answers with the coordinates of the state."""
    for system, speed in ((ROTOR.system(), 80.0), (PLANES.system(), 40.0)):
        races = [BallRace(0.1, 0.1, (0.001, 0.001), 0.5)]
        found = steady_states(system, races, [speed])
        moving = np.flatnonzero(found.kind[0] > 1).tolist()
        assert moving
        for k in moving:
            whole = with_balls_at(system, races, found.places[0, k])
            damping = whole.damping + speed * whole.gyroscopic
            held = whole.stiffness + 1j * speed * damping - speed**2 * whole.mass
            moved = np.linalg.solve(held, speed**2 * whole.unbalance)
            np.testing.assert_allclose(moved, found.coordinates[0, k], rtol=1e-6, atol=1e-12)
