"""Steady states of balls against closed forms, the bare rotor, the balanced state's roots and time runs."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import leblanc as lb
from meshes.errors import InputError
from solvers.rotor.balls import steady
from solvers.rotor.balls.balancers import BallRace, simulate
from solvers.rotor.balls.stability import balanced_stability, small_motions
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.balls.steady import BallKind, attracting, steady_states
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import unbalance_response
from tests.mutants import kills

ROTOR = Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
RACE = BallRace(0.0, 0.065, (7.1e-3, 7.1e-3), 0.1)


def kinds(states: steady.BallStates, k: int = 0) -> list[BallKind]:
    return [BallKind(kind) for kind in states.kind[k] if kind]


@settings(max_examples=40, deadline=None)
@given(
    share=st.floats(0.05, 0.95),
    ratio=st.floats(1.5, 6.0),
    damping=st.floats(0.02, 0.3),
    mass=st.floats(1e-3, 0.02),
)
def test_two_balls_balance_above_the_resonance(
    share: float, ratio: float, damping: float, mass: float
) -> None:
    """cos(phi) = -U/(2 m R), and nothing is left but rounding."""
    moment = mass * 0.065
    rotor = Jeffcott(4.0, 4.4e4, 2.0 * damping * math.sqrt(4.4e4 * 4.0), 2.0 * share * moment)
    found = steady_states(
        rotor.system(), [BallRace(0.0, 0.065, (mass, mass), 0.1)], [ratio * rotor.natural_frequency]
    )
    assert kinds(found)[0] is BallKind.BALANCED
    angles = np.sort(np.abs(found.places[0, 0]))
    np.testing.assert_allclose(np.cos(angles), -share, rtol=0.0, atol=1e-9)
    bare = np.abs(unbalance_response(rotor.system(), [ratio * rotor.natural_frequency])).max()
    assert np.abs(found.coordinates[0, 0]).max() <= 1e-9 * bare


@settings(max_examples=40, deadline=None)
@given(ratio=st.floats(0.2, 0.7), damping=st.floats(0.02, 0.2), count=st.integers(1, 5))
def test_balls_gather_below_the_resonance(ratio: float, damping: float, count: int) -> None:
    """All along the deflection a: |D a - N m R| = U, a quadratic; D is the stiffness over Omega^2."""
    rotor = Jeffcott(4.0, 4.4e4, 2.0 * damping * math.sqrt(4.4e4 * 4.0), 6e-4)
    race, spin = BallRace(0.0, 0.065, (2e-3,) * count, 0.5), ratio * rotor.natural_frequency
    found = steady_states(rotor.system(), [race], [spin])
    stable = [k for k in range(found.kind.shape[1]) if found.stable[0, k]]
    assert [BallKind(found.kind[0, k]) for k in stable] == [BallKind.TOGETHER]
    d = (rotor.stiffness - (4.0 + count * 2e-3) * spin**2 + 1j * rotor.damping * spin) / spin**2
    held = count * 2e-3 * 0.065
    roots = np.roots([abs(d) ** 2, -2.0 * held * d.real, held**2 - 6e-4**2])
    wanted = float(roots[(np.abs(roots.imag) < 1e-12) & (roots.real > 0.0)].real.max())
    # Newton's last step leaves the pull at 1e-11 of itself, so the place at about its root of rounding.
    assert abs(found.coordinates[0, stable[0], 0]) == pytest.approx(wanted, rel=1e-8)


def test_balls_that_cannot_hold_the_unbalance_end_opposite_to_it() -> None:
    """Far above the resonance they leave U - N m R."""
    heavy = Jeffcott(4.0, 4.4e4, 84.0, 2e-3)
    found, spin = steady_states(heavy.system(), [RACE], [400.0]), 400.0
    stable = np.flatnonzero(found.stable[0])
    assert [BallKind(found.kind[0, k]) for k in stable] == [BallKind.TOGETHER]
    left = 2e-3 - 2.0 * 7.1e-3 * 0.065
    d = (heavy.stiffness - (4.0 + 2 * 7.1e-3) * spin**2 + 1j * heavy.damping * spin) / spin**2
    # The small damping turns them by little: to its square.
    assert abs(d) * abs(found.coordinates[0, stable[0], 0]) == pytest.approx(left, rel=1e-3)
    assert BallKind.BALANCED not in kinds(found)


def test_balls_without_mass_leave_the_bare_rotor() -> None:
    speed = np.linspace(20.0, 300.0, 15)
    found = steady_states(ROTOR.system(), [BallRace(0.0, 0.065, (1e-14,) * 3, 0.1)], speed)
    bare = unbalance_response(ROTOR.system(), speed)
    np.testing.assert_allclose(np.abs(found.coordinates[:, 0]), np.abs(bare), rtol=1e-10)


@pytest.mark.parametrize("spin", [60.0, 200.0])
def test_a_run_in_time_ends_in_the_stable_state(spin: float) -> None:
    """The solver of motions in time is another code; all motions fade with more than 0.2 1/s."""
    found = steady_states(ROTOR.system(), [RACE], [spin])
    (k,) = np.flatnonzero(found.stable[0]).tolist()
    run = simulate(ROTOR.system(), [RACE], spin, 60.0, places=[1.0, 2.5], samples=100)
    size = np.abs(run.deflection(ROTOR.system(), 0.0)[-1])
    assert size == pytest.approx(abs(found.coordinates[0, k, 0]), rel=1e-4, abs=1e-9)
    ends = np.angle(np.exp(1j * (run.ball_angle[-1] - spin * run.time[-1])))
    np.testing.assert_allclose(np.sort(ends), np.sort(found.places[0, k]), rtol=0.0, atol=2e-3)


def test_a_run_on_unlike_supports_ends_in_the_state_that_follows_the_forward_motion() -> None:
    """30 % stiffer in one direction, balls together: places, and the fading of the balls' motion apart."""
    system, spin = replace(ROTOR.system(), stiffness=np.diag([4.4e4, 1.3 * 4.4e4])), 85.0
    found = steady_states(system, [RACE], [spin])
    (k,) = np.flatnonzero(found.stable[0]).tolist()
    places = found.places[0, k]
    machine = RotorWithBalls(system, (RACE,))
    roots = small_motions(machine, spin, places, found.coordinates[0, k]).roots()
    halves = 216
    duration = halves * math.pi / spin
    start = places + np.array([1e-2, -1e-2])
    run = simulate(system, [RACE], spin, duration, places=start, samples=halves + 1, steps=96)
    seen = run.ball_angle - spin * run.time[:, None]
    # The balls' own ripple, left out of the state, is of their mass over the rotor's: 3.6e-3, and of the
    # backward part of the motion.
    np.testing.assert_allclose(seen[-1], places, rtol=0.0, atol=1e-3)
    apart = np.abs(seen[:, 0] - seen[:, 1])
    peaks = np.flatnonzero((apart[1:-1] > apart[:-2]) & (apart[1:-1] >= apart[2:])) + 1
    peaks = peaks[(run.time[peaks] > 0.2) & (apart[peaks] > 1e-9)]
    rate = np.polyfit(run.time[peaks], np.log(apart[peaks]), 1)[0]
    swing = roots[np.argmin(np.abs(np.abs(roots.imag) - 3.37))]
    assert rate == pytest.approx(swing.real, rel=2e-2)


def test_small_motions_grow_in_time_as_the_root_says() -> None:
    """About the balanced state below the resonance, where a pair of roots s +- i w grows.

    The other motions fade with 10 1/s. Half a period pi/w later the motion is the same, e^(s pi/w) larger.
    """
    spin = 80.0
    found = steady_states(ROTOR.system(), [RACE], [spin])
    assert kinds(found)[0] is BallKind.BALANCED
    rate, places = float(found.growth[0, 0]), found.places[0, 0]
    roots = balanced_stability(ROTOR.system(), [RACE], spin, places).roots
    assert rate == pytest.approx(roots.real.max())
    half = math.pi / abs(roots[np.argmax(roots.real)].imag)
    run = simulate(
        ROTOR.system(), [RACE], spin, 2.0 + half, places=places + np.array([1e-8, -1e-8]), samples=401
    )
    size = np.abs(run.deflection(ROTOR.system(), 0.0))
    first = float(np.interp(2.0, run.time, size))
    # The motion ends at 2e-4 rad, whose square the roots leave out; lines between the samples.
    assert math.log(size[-1] / first) / half == pytest.approx(rate, rel=2e-3)


def test_two_races_balance_two_planes() -> None:
    rotor = TwoPlane(
        10.0, 0.5, 0.1,
        (Support(0.3, 2e4, 40.0), Support(-0.3, 2e4, 40.0)),
        (PlaneUnbalance(0.2, 3e-4, 0.4), PlaneUnbalance(-0.2, 2e-4, 2.5)),
    )  # fmt: skip
    races = [BallRace(z, 0.1, (3e-3, 3e-3), 0.3) for z in (0.25, -0.25)]
    found = steady_states(rotor.system(), races, [250.0])
    assert kinds(found)[0] is BallKind.BALANCED
    assert found.stable[0, 0]
    assert not found.coordinates[0, 0].any()
    # One race alone holds the sum of the unbalances but not their moment.
    alone = steady_states(rotor.system(), races[:1], [250.0])
    assert BallKind.BALANCED not in kinds(alone)


def test_a_race_in_the_plane_of_the_laundry_balances_a_tub() -> None:
    """Six coordinates and supports that differ."""
    rotor = lb.example("tub").rotor
    plane = rotor.drum_position[1] if rotor.unbalance_position is None else rotor.unbalance_position
    mass = 0.4 * rotor.unbalance / 0.2
    found = steady_states(rotor.machine().system(), [BallRace(plane, 0.2, (mass,) * 4, 4.0)], [8.0, 100.0])
    assert [kinds(found, k)[0] for k in (0, 1)] == [BallKind.BALANCED] * 2
    assert not found.coordinates[:, 0].any()
    assert found.stable[1, 0]


def test_wrong_input() -> None:
    with pytest.raises(InputError, match="races"):
        steady_states(ROTOR.system(), [], [100.0])
    with pytest.raises(InputError, match="speed"):
        steady_states(ROTOR.system(), [RACE], [-1.0])
    with pytest.raises(InputError, match="resistance"):
        simulate(ROTOR.system(), [BallRace(0.0, 0.1, (1e-3,), 0.1, resistance=0.01)], 50.0, 0.1)


KEPT = "solvers.rotor.balls.steady:attracting"


@kills(KEPT, "np.where(stay, draw_all, draws)", "stay | draws")
@kills(KEPT, "np.where(stay, draw_all, draws)", "draws")
@kills(KEPT, "stay &= np.isin", "stay |= np.isin")
def test_places_that_creeping_balls_would_leave_are_not_kept() -> None:
    """Two balls that hold H = 8e-4 kg m on a rotor of U = 6e-4, far above its critical speed.

    On the light side both together are drawn there, by U/(U + H) of the pull, and from one another, by
    (H - U)/(U + H). Nothing draws them to the heavy side, everything to where they balance.
    """
    machine = RotorWithBalls(
        Jeffcott(4.0, 4.4e4, 1.0, 6e-4).system(), (BallRace(0.0, 0.1, (4e-3,) * 2, 0.1),)
    )
    light, heavy, apart = (np.pi, np.pi), (0.0, 0.0), np.pi + np.array([1.0, -1.0]) * np.arccos(0.75)
    exact = [
        machine.nearest(machine.compliance(np.array([400.0]))[0], np.array(p)) for p in (light, heavy, apart)
    ]
    places = np.array([place for place in exact if place is not None])
    assert places.shape == (3, 2)
    many = np.repeat(machine.compliance(np.array([400.0])), 3, axis=0)
    # As from the starts 0, which is irregular, and 1 and 2, which begin together.
    told = [attracting(machine, many, np.array([places[k]] * 3), 3).tolist() for k in range(3)]
    assert told == [[False, True, True], [False, False, False], [True, True, True]]


def crept(machine: RotorWithBalls, compliance: np.ndarray, start: np.ndarray, hold: float) -> np.ndarray:
    """The same way by a solver of differential equations, each ball at the speed of its pull beyond."""
    from scipy.integrate import solve_ivp

    def rate(_: float, places: np.ndarray) -> np.ndarray:
        turning = machine.forward(machine.coordinates(compliance, places[None]))[0]
        pull = np.imag(turning * np.exp(-1j * places))
        return np.asarray(np.sign(pull) * np.maximum(np.abs(pull) - hold, 0.0) / hold)

    return np.asarray(solve_ivp(rate, (0.0, 200.0), start, rtol=1e-8, atol=1e-10).y[:, -1])


STICK = "solvers.rotor.balls.states:RotorWithBalls.stick"


@kills(STICK, "np.abs(pull) - held", "np.abs(pull) - 0.5 * held")
@kills(STICK, "np.sign(pull) *", "-np.sign(pull) *")
@kills(STICK, "(beyond != 0.0).astype(float)", "np.ones(beyond.shape)")
def test_balls_that_stick_stop_where_a_solver_has_them() -> None:
    """A start within the band stays, others come to its edge, below and above the resonance.

    Steps of a quarter of the pull's own time: an eighth of the hold, where the pull of the resonance is a
    hundred times as large. Where a way forks its steps may take the other one, here at two of the starts.
    """
    machine = RotorWithBalls(ROTOR.system(), (RACE,))
    hold = 5e-5
    for speed in (60.0, 200.0):
        compliance = machine.compliance(np.array([speed]))
        starts = np.random.default_rng(3).uniform(0.0, 2.0 * math.pi, (12, 2))
        each = np.repeat(compliance, 12, axis=0)
        places, stopped = machine.stick(each, starts, np.full((12, 2), hold))
        assert stopped.all()
        own = np.imag(machine.forward(machine.coordinates(each, places)) * np.exp(-1j * places))
        assert np.abs(own).max() <= hold * (1.0 + 1e-4)
        begun = np.imag(machine.forward(machine.coordinates(each, starts)) * np.exp(-1j * starts))
        still = np.abs(begun).max(axis=1) <= hold
        np.testing.assert_array_equal(places[still], starts[still])
        expected = np.array([crept(machine, compliance, start, hold) for start in starts])
        sizes = [np.abs(machine.forward(machine.coordinates(each, at))[:, 0]) for at in (places, expected)]
        away = np.abs(sizes[0] - sizes[1])
        assert np.sum(away > 0.125 * hold) <= 2 and np.median(away) < 0.01 * hold


def test_balls_that_do_not_resist_stop_where_they_balance() -> None:
    machine = RotorWithBalls(ROTOR.system(), (RACE,))
    starts = np.random.default_rng(3).uniform(0.0, 2.0 * math.pi, (12, 2))
    each = np.repeat(machine.compliance(np.array([200.0])), 12, axis=0)
    places, stopped = machine.stick(each, starts, np.zeros((12, 2)))
    assert stopped.all()
    np.testing.assert_allclose(np.cos(places), -6e-4 / (2.0 * 7.1e-3 * 0.065), rtol=0.0, atol=1e-4)
