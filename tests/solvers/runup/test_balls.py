"""Balls on a rotor that runs up: another code, limits, momentum, energy and the race's own motions."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest

import leblanc as lb
from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import KNOWN_LIQUIDS
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.rotor.balls.balancers import BallRace, simulate
from solvers.rotor.balls.steady import BallKind
from solvers.rotor.balls.swing import holding
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.runup.balls import Balls
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Handover, Motor, Ramp
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from solvers.synchronous.balls import wet_states
from tests.mutants import kills
from tests.oracles.balls import spread_balls

FRICTION = Friction()
ROTOR = Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
RACE = BallRace(0.0, 0.065, (0.02, 0.02), 0.5)
PLANES = TwoPlane(
    10.0, 0.5, 0.1,
    (Support(0.3, 2e4, 40.0), Support(-0.3, 2e4, 40.0)),
    (PlaneUnbalance(0.2, 3e-4, 0.4), PlaneUnbalance(-0.2, 2e-4, 2.5)),
)  # fmt: skip
MANY = 10**7


def machine(
    system: RotorSystem,
    balls: Balls,
    spin: float,
    cells: int,
    gravity: float = 0.0,
    fills: tuple[Fill, ...] = (),
) -> Coupled:
    return couple(system, fills, spin, FRICTION, gravity, cells, False, balls=balls)


def held(made: Coupled, stop: float, rate: float = 0.0) -> Coupled:
    assert made.advance(stop, rate, 0.8, MANY) is Outcome.DONE
    return made


def history(balls: Balls, drive: Ramp | Motor, cells: int = 64, rotor: Jeffcott = ROTOR) -> RunupHistory:
    numerics = RunupNumerics(cells=cells, samples=60, companion=False)
    return run_up(rotor.system(), [], drive, FRICTION, 0.0, numerics, None, partial(couple, balls=balls))


@pytest.mark.parametrize("kind", ["planar", "two_plane", "tub"])
def test_held_speed_is_the_balancers_motion_to_second_order(kind: str) -> None:
    """The fourth-order solver in the standing frame is another code; half the step leaves a quarter."""
    rotor, spin, places = ROTOR, 150.0, (1.0, 2.5)
    races = [RACE]
    if kind == "two_plane":
        rotor, places = PLANES, (1.0, 2.5, 0.2, 3.0)
        races = [BallRace(z, 0.1, (0.01, 0.01), 0.3) for z in (0.25, -0.2)]
    if kind == "tub":
        rotor, spin = lb.example("tub").rotor.machine(), 60.0
        races = [BallRace(rotor.drum_position[1], 0.2, (0.2, 0.2), 3.0)]
    system = rotor.system()
    known = simulate(system, races, spin, 0.3, places=places, samples=11, steps=800)
    errors = []
    for cells in (128, 256):
        balls = Balls(tuple(races), places, (1.0,) * len(places))
        reading = held(machine(system, balls, spin, cells), 0.3).read()
        errors.append(np.abs(reading.ball_angle + spin * 0.3 - known.ball_angle[-1]).max())
        moved = np.abs(reading.coordinates - known.coordinates[-1]).max()
        assert moved < 0.01 * np.abs(known.coordinates).max()
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_gravity_acts_as_on_the_balancers() -> None:
    """There it acts against the second direction, here against the first: a quarter turn."""
    quiet = Jeffcott(4.0, 4.4e4, 84.0, 0.0).system()
    known = simulate(quiet, [RACE], 20.0, 1.0, places=[1.0, 2.5], gravity=9.81, samples=11, steps=2000)
    turned = Balls((RACE,), (1.0 - 0.5 * math.pi, 2.5 - 0.5 * math.pi), (1.0, 1.0))
    made = machine(quiet, turned, 20.0, 1024, gravity=9.81)
    reading = held(made, 1.0).read()
    ends = reading.ball_angle + 20.0 + 0.5 * math.pi
    np.testing.assert_allclose(ends, known.ball_angle[-1], rtol=0.0, atol=2e-4)


def test_momentum_of_a_free_rotor_with_balls() -> None:
    """Without unbalance and supports it stays; each step leaves the square of a change of rate."""
    free = Jeffcott(4.0, 1e-12, 0.0, 0.0).system()
    gaps = []
    for cells in (64, 128):
        made = machine(free, Balls((RACE,), (0.0, 0.7), (1.0, 0.3)), 40.0, cells)

        def momentum(made: Coupled = made) -> complex:
            way, state = made.state.roll, made.state
            own = 1j * RACE.radius * state.roll_rate * np.exp(1j * way) * np.array(RACE.masses)
            return complex(4.04 * complex(*state.rate) + own.sum())

        before = momentum()
        gaps.append(abs(momentum(held(made, 1.0)) - before) / (0.02 * 0.065 * 40.0))
    assert gaps[1] < 1e-3
    assert gaps[0] / gaps[1] > 3.5


@pytest.mark.parametrize(
    "drive", [Ramp(20.0, 150.0, 40.0, 5.0), Motor(20.0, 0.05, (0.0, 160.0), (2.0, 0.0), 3.0)]
)
def test_energy_is_accounted_for_to_second_order(drive: Ramp | Motor) -> None:
    """Rolling balls take part of a change of the spin; the sums beside the steps know it."""
    race = BallRace(0.0, 0.065, (0.02, 0.02), 0.5, carried=0.43, driven=0.46)
    left = [history(spread_balls([race]), drive, cells).audit.closure for cells in (32, 64)]
    assert left[1] < 2e-3
    assert left[0] / left[1] > 3.0


def test_a_great_drag_fixes_the_balls() -> None:
    """They are a mass on the rotor and a part of its unbalance."""
    race = BallRace(0.0, 0.065, (0.01, 0.02), 1e7)
    drive = Ramp(20.0, 150.0, 40.0, 5.0)
    balls = history(Balls((race,), (0.5, 2.0), (1.0, 1.0)), drive, 256)
    turning = 6e-4 + 0.065 * (0.01 * np.exp(0.5j) + 0.02 * np.exp(2.0j))
    fixed = Jeffcott(4.03, 4.4e4, 84.0, abs(turning))
    alone = run_up(
        fixed.system(), [], drive, FRICTION, 0.0, RunupNumerics(cells=256, samples=60, companion=False)
    )
    # The unbalance of the balls is taken over a step as its chord, the rotor's exactly: (2 pi 0.8/256)^2/24.
    np.testing.assert_allclose(balls.amplitude, alone.amplitude, rtol=0.0, atol=1e-3 * alone.amplitude.max())


def test_balls_without_mass_change_nothing() -> None:
    drive = Ramp(20.0, 150.0, 40.0, 5.0)
    light = history(spread_balls([BallRace(0.0, 0.065, (1e-15, 1e-15), 1e-14)]), drive)
    bare = history(Balls(), drive)
    np.testing.assert_allclose(light.amplitude, bare.amplitude, rtol=1e-11, atol=1e-14 * bare.amplitude.max())


def test_a_rolling_ball_is_carried_by_a_change_of_the_spin() -> None:
    """Without drag on a stiff rotor: kappa R phi'' = s R Omega'."""
    stiff = Jeffcott(4.0, 1e12, 1e3, 0.0).system()
    race = BallRace(0.0, 0.1, (0.01,), 0.0, 1.4, carried=0.44, driven=0.484)
    made = held(machine(stiff, spread_balls([race]), 20.0, 64), 2.0, rate=15.0)
    assert float(made.read().ball_speed[0]) == pytest.approx(
        20.0 + 0.44 / 1.4 * 30.0, rel=1e-7
    )  # it gives by 1e-8


def test_a_ball_at_the_bottom_is_a_pendulum() -> None:
    """Its length is kappa R: back at its start after a period, of some 1e-3 rad that no sine cares for."""
    stiff = Jeffcott(4.0, 1e12, 1e3, 0.0).system()
    race = BallRace(0.0, 0.1, (0.01,), 0.0, 1.4)
    period = 2.0 * math.pi * math.sqrt(1.4 * 0.1 / 9.81)
    made = machine(stiff, Balls((race,), (math.pi + 1e-3,), (0.0,)), 20.0, 512, gravity=9.81)
    quarter = held(made, 0.25 * period).state.roll[0] - math.pi
    assert abs(quarter) < 2e-6
    assert held(made, period).state.roll[0] - math.pi == pytest.approx(1e-3, rel=1e-3)


def test_what_resists_to_rolling_holds_a_ball() -> None:
    """It sticks while the deflection along its race stays below f R, here 40 um, and moves above."""
    spin = 60.0
    size = 6e-4 * spin**2 / abs(4.4e4 - 4.0 * spin**2 + 84.0j * spin)
    moved = {}
    for share in (0.5, 2.0):
        f = size / share / 0.065
        race = BallRace(0.0, 0.065, (1e-6,), 0.0, resistance=f)
        made = machine(ROTOR.system(), Balls((race,), (1.5,), (1.0,)), spin, 64)
        held(made, 1.0)  # past the rotor's own start
        before = made.read().ball_angle[0]
        moved[share] = abs(held(made, 6.0).read().ball_angle[0] - before)
    # It creeps by at most 1e-5 of the spin.
    assert moved[0.5] < 1e-5 * spin * 5.0
    assert moved[2.0] > 0.3


@kills("solvers.rotor.balls.swing:holding", "gravity / np", "0.5 * gravity / np")
@kills("solvers.rotor.balls.swing:holding", "race.resistance * race.radius for", "race.resistance for")
def test_gravity_frees_what_resists_to_rolling() -> None:
    """It adds to the pull once a turn: the resistance may be above the pull, and yet the ball moves on.

    Pull 72 um, gravity 56: a resistance of 85 um leaves a hold of 0.40 of the pull, and the ball slips a
    little each turn, 0.01 rad a second; one of 137 um leaves 1.13 of it, and the ball stays.
    """
    spin, gravity = 60.0, 0.2
    size = 6e-4 * spin**2 / abs(4.4e4 - 4.0 * spin**2 + 84.0j * spin)
    along = size * math.sin(1.5 + math.atan2(84.0 * spin, 4.4e4 - 4.0 * spin**2))
    moved = {}
    for f in (1.3e-3, 2.1e-3):
        race = BallRace(0.0, 0.065, (1e-6,), 0.0, resistance=f)
        share = float(holding([race], spin, gravity)[0, 0]) / along
        assert f * 0.065 > 1.1 * along
        made = machine(ROTOR.system(), Balls((race,), (1.5,), (1.0,)), spin, 64, gravity=gravity)
        # The rotor's own start is part of the first second, which a ball on its hold outlasts.
        before = held(made, 1.0).read().ball_angle[0]
        moved[share] = abs(held(made, 6.0).read().ball_angle[0] - before)
    (free, loose), (firm, still) = sorted(moved.items())
    assert 0.35 < free < 0.45 and 1.1 < firm < 1.2
    assert still < 1e-5 * spin * 5.0
    assert loose > 10.0 * still


def test_balls_and_liquid_take_the_unbalance_together() -> None:
    """With balls that hold it all, above the resonance, the layer ends even."""
    fill = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], 3e-5)
    model = partial(couple, balls=spread_balls([BallRace(0.0, 0.065, (7.1e-3,) * 2, 0.1)]))
    drive, numerics = Ramp(30.0, 250.0, 60.0, 9.0), RunupNumerics(cells=32, samples=60, companion=False)
    run = run_up(ROTOR.system(), [fill], drive, Friction("linear", 3.0), 0.0, numerics, None, model)
    assert run.converged
    assert run.audit.closure < 5e-3
    assert run.amplitude[-1] < 1e-2 * run.amplitude.max()
    assert run.mass_error < 1e-12
    assert run.depth_max[-1, 0] - run.depth_min[-1, 0] < 0.02 * fill.depth


def test_liquid_counts_as_its_mass_in_step_in_the_slow_motions_of_balls() -> None:
    """Below the resonance the balanced state grows, swinging with 0.38 rad/s as seen from the rotor.

    Two samples apart foretell the third: w'' = a w' + b w for a pair of roots.
    """
    fill, spin = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], 3e-5), 80.0
    race = BallRace(0.0, 0.065, (7.1e-3,) * 2, 0.1)
    known = wet_states(ROTOR.system(), [fill], [race], [spin]).states
    assert known.kind[0, 0] == BallKind.BALANCED
    places = known.places[0, 0] + np.array([1e-4, -1e-4])
    balls = Balls((race,), tuple(places.tolist()), (1.0, 1.0))
    made = couple(ROTOR.system(), (fill,), spin, Friction("linear", 10.0), 0.0, 64, False, balls=balls)
    seen = []
    for k in range(1, 14):
        x, y = held(made, 0.5 * k).read().coordinates
        seen.append((x + 1j * y) * np.exp(-0.5j * k * spin))
    w = np.array(seen[2:]) / np.abs(seen[4:]).max()
    size = np.abs(w[2:])
    rows = np.column_stack((w[1:-1], w[:-2])) / size[:, None]
    left, right = (np.concatenate((part.real, part.imag)) for part in (rows, w[2:] / size))
    first, second = np.linalg.lstsq(left, right, rcond=None)[0]
    grown = np.roots([1.0, -first, -second]).astype(complex)
    # The layer lags by its waves' damping: some per cent of a share of 7 % of the mass; cells of 1/64 turn.
    assert (np.log(grown[0]) / 0.5).real == pytest.approx(known.growth[0, 0], rel=0.02)


def test_liquid_caught_beside_balls_keeps_the_momentum() -> None:
    """A lying drum: what is caught hands its momentum to rotor and balls; the energy is told."""
    fill = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], 3e-5)
    model = partial(couple, balls=spread_balls([BallRace(0.0, 0.065, (7.1e-3,) * 2, 0.1)]))
    drive, numerics = Ramp(5.0, 120.0, 40.0, 4.0), RunupNumerics(cells=32, samples=60, companion=False)
    run = run_up(ROTOR.system(), [fill], drive, Friction("wall"), 9.81, numerics, None, model)
    assert run.converged
    assert any(each.captured for each in run.transfers)
    assert run.audit.closure < 2e-2


@pytest.mark.parametrize("gravity", [0.0, 9.81])
@pytest.mark.parametrize(
    "drive", [Ramp(20.0, 150.0, 40.0, 3.0), Motor(20.0, 0.05, (0.0, 160.0), (2.0, 0.0), 3.0)]
)
def test_beside_no_liquid_both_models_are_the_same(drive: Ramp | Motor, gravity: float) -> None:
    """Rotor and balls are stepped alike; of a motor one model stops its rounds where the other goes on."""
    race = BallRace(0.0, 0.065, (0.02, 0.02), 0.5, resistance=1e-3, carried=0.43, driven=0.46)
    numerics = RunupNumerics(cells=64, samples=60, companion=False)
    runs = []
    for model in (couple, couple_linear):
        made = partial(model, balls=spread_balls([race]))
        runs.append(run_up(ROTOR.system(), [], drive, FRICTION, gravity, numerics, None, made))
    assert all(each.converged for each in runs)
    for name in ("amplitude", "ball_angle", "ball_speed", "speed"):
        waves, linear = (np.asarray(getattr(each, name)) for each in runs)
        apart = (1e-9 if isinstance(drive, Ramp) else 5e-4) * np.abs(waves).max()
        np.testing.assert_allclose(linear, waves, rtol=0.0, atol=apart, err_msg=name)
    assert runs[1].audit.closure < 1e-3


def beside_layer(scale: float) -> tuple[RunupHistory, RunupHistory]:
    """Balls beside a layer by both models; unbalance and balls grow together, so that they move alike."""
    fill = Fill(Chamber(0.25, 0.04), KNOWN_LIQUIDS["water"], 5e-4)
    rotor = Jeffcott(30.0, 30.0 * 25.0**2, 2.0 * 0.06 * 30.0 * 25.0, scale)
    race = BallRace(0.0, 0.2, (4.0 * scale, 4.0 * scale), 40.0 * scale)
    runs = []
    for model in (couple, couple_linear):
        numerics = RunupNumerics(cells=128, samples=200, companion=False, dispersion=model is couple)
        made, drive = partial(model, balls=spread_balls([race])), Ramp(5.0, 60.0, 10.0, 6.0)
        law = Friction("linear", 3.0)
        runs.append(run_up(rotor.system(), [fill], drive, law, 0.0, numerics, None, made))
    return runs[0], runs[1]


@kills("solvers.runup.linear:couple_linear", "spin * np.array(balls.shares", "0.0 * np.array(balls.shares")
def test_small_waves_beside_balls_are_those_of_the_long_wave_model() -> None:
    """Two models that share the rotor and the balls alone; without balls they are within 0.5 % as well."""
    gaps = []
    for scale in (1e-3, 1e-2):
        waves, linear = beside_layer(scale)
        assert waves.converged and linear.converged
        size = waves.amplitude.max()
        gaps.append(np.abs(linear.amplitude - waves.amplitude).max() / size)
        moved = np.abs(linear.ball_angle - waves.ball_angle).max()
        assert moved < (0.1 if scale == 1e-3 else 1.0)
        assert linear.audit.closure < 5e-3
    assert gaps[0] < 0.01
    # The waves of the linear layer are off by the order of the amplitude.
    assert gaps[1] > 2.0 * gaps[0]


def test_light_balls_leave_a_linear_layer_as_it_is() -> None:
    fill = Fill(Chamber(0.25, 0.04), KNOWN_LIQUIDS["water"], 5e-4)
    rotor, drive = Jeffcott(30.0, 30.0 * 25.0**2, 90.0, 1e-3), Ramp(5.0, 60.0, 10.0, 6.0)
    numerics, law = RunupNumerics(cells=128, samples=200, companion=False), Friction("linear", 3.0)
    runs = [
        run_up(rotor.system(), [fill], drive, law, 0.0, numerics, None, partial(couple_linear, balls=balls))
        for balls in (Balls(), spread_balls([BallRace(0.0, 0.2, (1e-14, 1e-14), 1e-13)]))
    ]
    size = runs[0].amplitude.max()
    np.testing.assert_allclose(runs[1].amplitude, runs[0].amplitude, rtol=0.0, atol=1e-10 * size)


@kills("solvers.runup.linear:LinearCoupled.switch", "-= along @ jump", "-= 0.0 * (along @ jump)")
@kills("solvers.runup.linear:LinearCoupled.switch", "solve(whole + inertia, lost)", "solve(whole, lost)")
def test_a_linear_layer_let_go_beside_balls_keeps_the_momentum() -> None:
    """What is let go hands its momentum to rotor and balls together, without a torque about the races."""
    fill = Fill(Chamber(0.065, 0.02), KNOWN_LIQUIDS["water"], 3e-5)
    balls = spread_balls([BallRace(0.0, 0.065, (0.2, 0.3), 0.1)])
    riding = Handover.RIDING
    made = couple_linear(
        ROTOR.system(), [fill], 30.0, Friction("wall"), 9.81, 64, False, False, riding, balls
    )
    place, masses = np.array([0.4, 2.0]), np.array(balls.races[0].masses)
    made.machine.place[-2:], made.machine.rate[2:4] = place, (0.3, -0.2)
    made.shaft.spin = 5.0

    def momentum() -> tuple[complex, np.ndarray]:
        m = made.machine
        axis, roll = complex(*m.rate[:2]), m.rate[-2:]
        rolling = masses * (axis + 1j * 0.065 * roll * np.exp(1j * place))
        liquid = made._momentum(0) + made.masses[0] * m.rate[:2]
        along = masses * (1.4 * 0.065 * roll + (np.exp(-1j * place) * axis).imag)
        return complex(4.0 * axis + rolling.sum() + complex(*liquid)), along

    before, along = momentum()
    made.switch()
    assert made.transfers
    after, still = momentum()
    assert abs(after - before) < 1e-12 * max(abs(before), 1e-6)
    np.testing.assert_allclose(still, along, rtol=1e-12)


def test_wrong_input() -> None:
    with pytest.raises(InputError, match="places"):
        Balls((RACE,), (1.0,), (1.0,))
    with pytest.raises(InputError, match="carried"):
        BallRace(0.0, 0.1, (1.0,), 0.1, carried=-1.0)
