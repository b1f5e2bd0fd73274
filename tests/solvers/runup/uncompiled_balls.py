"""Seeded faults of balls in a run-up's steps, and their oracles, as plain Python by `test_uncompiled.py`."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from fluid.friction.laws import Friction
from solvers.layer.records import Outcome, records
from solvers.rotor.balls.balancers import BallRace, simulate
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.runup.balls import Balls, ball_records, balls_energy, balls_inertia, race_planes
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Motor, Ramp
from solvers.runup.runup import RunupNumerics, run_up
from solvers.runup.state import BALL, SUMS
from solvers.runup.steps.balls import tally_ball
from tests.mutants import kills

_ADD = "solvers.runup.steps.balls:add_ball"
ROTOR = Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
PLANES = TwoPlane(
    10.0, 0.5, 0.1,
    (Support(0.3, 2e4, 40.0), Support(-0.3, 2e4, 40.0)),
    (PlaneUnbalance(0.2, 3e-4, 0.4), PlaneUnbalance(-0.2, 2e-4, 2.5)),
).system()  # fmt: skip
RACES = tuple(BallRace(z, 0.1, (0.2, 0.3), 3.0) for z in (0.25, -0.2))
STIFF = Jeffcott(4.0, 1e12, 1e3, 0.0).system()


def held(
    system: RotorSystem,
    balls: Balls,
    spin: float,
    cells: int,
    stop: float,
    gravity: float = 0.0,
    rate: float = 0.0,
) -> Coupled:
    made = couple(system, (), spin, Friction(), gravity, cells, False, balls=balls)
    assert made.advance(stop, rate, 0.8, 10**6) is Outcome.DONE
    return made


@kills(_ADD, "angle + 0.5 * dt * rate, angle", "angle, angle")
@kills(_ADD, "given_x, given_y = -lever", "given_x, given_y = lever")
@kills(_ADD, "lever * rate * (x_end", "-lever * rate * (x_end")
@kills(_ADD, "(y_end + 0.5 * dt", "(y_end + 0.0 * dt")
@kills(_ADD, "(x_end - 0.5 * dt", "(x_end + 0.5 * dt")
@kills(_ADD, "b[1, i] * x - b[0, i] * y", "b[1, i] * x + b[0, i] * y")
@kills(_ADD, "ball.mass * (b[0, i] * b[0, k]", "0.5 * ball.mass * (b[0, i] * b[0, k]")
@kills(_ADD, "(0.5 * ball.drag", "(ball.drag")
@kills(_ADD, "gravity[1] * x - gravity", "gravity[1] * x + gravity")
@kills("solvers.runup.balls:ball_records", "race.rolling * mass", "mass")
@kills("solvers.runup.balls:ball_records", "race.drag * race.radius**2", "race.drag * race.radius")
def test_steps_follow_the_other_code_to_second_order() -> None:
    """Heavy balls off their places at a held spin; half the step leaves a quarter of the error.

    There gravity acts against the second direction, here against the first: all is a quarter turn on.
    """
    turned, spin, stop = (1.0, 2.5, 0.2, 3.0), 60.0, 0.05
    quarter = 0.5 * np.pi
    ahead = np.exp(1j * quarter)
    onward = RotorSystem(
        **(vars(PLANES) | {"unbalance": PLANES.unbalance * ahead})  # the same machine a quarter turn on
    )
    places = [angle + quarter for angle in turned]
    known = simulate(onward, RACES, spin, stop, places=places, gravity=200.0, samples=3, steps=200)
    errors = []
    for cells in (32, 64):
        reading = held(PLANES, Balls(RACES, turned, (1.0,) * 4), spin, cells, stop, gravity=200.0).read()
        errors.append(np.abs(reading.ball_angle + spin * stop + quarter - known.ball_angle[-1]).max())
    assert errors[1] < 1e-2
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)


@kills(_ADD, "+= ball.carried * gained", "-= ball.carried * gained")
@kills(
    "solvers.runup.balls:ball_records",
    "race.carried * mass * race.radius**2",
    "race.carried * mass * race.radius",
)
def test_a_rolling_ball_is_carried_by_a_change_of_the_spin() -> None:
    """Without drag on a stiff rotor: kappa R phi'' = s R Omega'."""
    race = BallRace(0.0, 0.1, (0.01,), 0.0, 1.4, carried=0.44, driven=0.484)
    made = held(STIFF, Balls((race,), (0.0,), (1.0,)), 20.0, 16, 0.5, rate=15.0)
    assert float(made.read().ball_speed[0]) == pytest.approx(20.0 + 0.44 / 1.4 * 7.5, rel=1e-7)


@kills(_ADD, "(ball.radius * rate) ** 2", "ball.radius * rate**2")
@kills(_ADD, "held = press / max(abs(past)", "held = 0.5 * press / max(abs(past)")
@kills(_ADD, "held * (spins[1] - rate)", "held * (spin - 2.0 * rate)")
def test_resistance_brings_a_ball_along() -> None:
    """Slower than the drum, on a stiff rotor: kappa w' = f w^2, 1/w falls evenly with f/kappa."""
    race = BallRace(0.0, 0.1, (0.01,), 0.0, 1.4, resistance=0.05)
    made = held(STIFF, Balls((race,), (0.0,), (0.5,)), 20.0, 512, 0.2)
    # The press is that of a step's beginning: half of 6e-4 s times the rate over the rate, 0.35 1/s.
    assert 1.0 / float(made.read().ball_speed[0]) == pytest.approx(0.1 - 0.05 / 1.4 * 0.2, rel=3e-4)


@kills("solvers.runup.steps.balls:ball_dragged", "- rate - 0.5 * change", "- rate - change")
@kills("solvers.runup.steps.balls:ball_turned", "+ ball.driven * gained", "- ball.driven * gained")
@kills("solvers.runup.steps.balls:ball_turned", "- ball.carried * change", "+ ball.carried * change")
@kills("solvers.runup.steps.balls:tally_ball", "(spin - mean) * ball_dragged", "(spin - rate) * ball_dragged")
@kills(
    "solvers.runup.steps.balls:tally_ball",
    "ball.mass * ball.radius * mean * pull",
    "ball.mass * ball.radius * mean",
)
@kills("solvers.runup.balls:balls_energy", "- balls.carried * spin", "+ balls.carried * spin")
@kills("solvers.runup.balls:balls_energy", "0.5 * balls.driven", "balls.driven")
@kills("solvers.runup.balls:_along", "(-np.sin(roll)", "(np.sin(roll)")
@kills("solvers.runup.balls:balls_energy", "axis + meeting", "axis - meeting")
@pytest.mark.parametrize(
    "drive",
    [Ramp(40.0, 60.0, 100.0, 0.2), Motor(40.0, 0.05, (0.0, 160.0), (8.0, 0.0), 0.2)],
    ids=["ramp", "motor"],
)
def test_the_energy_is_accounted_for_to_second_order(drive: Ramp | Motor) -> None:
    """On a lying drum; rolling balls take part of a change of the spin."""
    race = BallRace(0.0, 0.065, (0.2, 0.3), 5.0, carried=0.43, driven=0.46)
    model = partial(couple, balls=Balls((race,), (0.3, 2.0), (0.6, 1.2)))
    left = []
    for cells in (16, 32):
        numerics = RunupNumerics(cells=cells, samples=3, companion=False)
        run = run_up(ROTOR.system(), [], drive, Friction(), 9.81, numerics, None, model)
        left.append(run.audit.closure)
    assert left[1] < 2e-3
    assert left[0] / left[1] > 3.0


@kills("solvers.runup.steps.balls:tally_ball", "spins, dt), 0.0)", "spins, dt), -1.0)")
def test_a_ball_whose_slip_turns_round_makes_no_cold() -> None:
    """Slip 1, then -0.4: the resistance is that of the end and pushes against the mean; no heat, none lost.

    Where the slip only falls, to 0.4, its heat is the resistance times the mean slip.
    """
    for change, heat in ((1.4, 0.0), (0.6, 0.01 * 2.0 * 0.4 * 0.7)):
        ball, sums = records(BALL)[0], records(SUMS)[0]
        ball.mass, ball.radius = 1.0, 1.0
        tally_ball(ball, 2.0, np.zeros(2), (0.0, 0.0), change, np.ones(2), 0.01, sums)
        assert sums.friction == pytest.approx(heat, abs=1e-15)


@kills("solvers.runup.balls:balls_inertia", "whole - np", "whole + np")
@kills("solvers.runup.balls:balls_inertia", "(moving / balls.inertia)", "(1.0 / balls.inertia)")
@kills("solvers.runup.balls:balls_energy", "0.5 * balls.mass * np.square", "balls.mass * np.square")
def test_a_blow_leaves_the_least_energy() -> None:
    """Of all changes of the balls' rates with a jump of the rotor's: no torque acts on them in a blow.

    What the balls add to the rotor's inertia is twice that least energy.
    """
    balls = Balls(RACES, (1.0, 2.5, 0.2, 3.0), (1.0,) * 4)
    made = couple(PLANES, (), 60.0, Friction(), 0.0, 16, False, balls=balls)
    state, rows, races = made.state, ball_records(balls), race_planes(PLANES, balls)
    roll, spinning = state.roll, np.full(4, 60.0)
    added, answer = balls_inertia(rows, races, roll)
    jump = np.array([0.3, -0.2, 0.5, 0.1])

    def energy(rates: np.ndarray) -> float:
        return balls_energy(rows, races, jump, roll, rates, 0.0)

    least = energy(-answer @ jump)
    assert 2.0 * least == pytest.approx(jump @ added @ jump, rel=1e-12)
    for k in range(4):
        aside = 1e-3 * np.eye(4)[k]
        both = [energy(-answer @ jump + way * aside) for way in (1.0, -1.0)]
        # A parabola about its least value: alike on both sides, and above it.
        assert both[0] == pytest.approx(both[1], rel=1e-9) and both[0] > least
    # At rest against the drum all energy is that of masses on their circles.
    own = 0.5 * sum(1.4 * mass * (0.1 * 60.0) ** 2 for race in RACES for mass in race.masses)
    assert balls_energy(rows, races, np.zeros(4), roll, spinning, 0.0) == pytest.approx(own, rel=1e-12)
