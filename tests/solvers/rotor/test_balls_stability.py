"""Roots of rotor and balls: against the motion's own derivative, the rotor alone, and motion in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshes.errors import InputError
from solvers.rotor.balls import stability
from solvers.rotor.balls.balancers import BallRace, race_arrays, simulate
from solvers.rotor.balls.motion import rates
from solvers.rotor.balls.stability import (
    STEPS,
    HalfTurn,
    balanced_roots,
    balanced_stability,
    linearised,
    neutral_directions,
    small_motions,
)
from solvers.rotor.balls.states import RotorWithBalls, balanced_places, balancing_shares, quarter_turn
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from tests.mutants import kills
from tests.oracles.balls import light_ball_roots

SUPPORTS = (Support(0.2, 1e4, 40.0), Support(-0.22, 1.1e4, 40.0))
UNBALANCES = (PlaneUnbalance(0.15, 1e-3, 0.0), PlaneUnbalance(-0.1, 8e-4, 2.0))
LONG = TwoPlane(10.0, 0.5, 0.1, SUPPORTS, ())
LOADED = replace(LONG, unbalances=UNBALANCES)
RACES = (BallRace(0.15, 0.08, (0.015, 0.015), 0.3), BallRace(-0.15, 0.08, (0.015, 0.015), 0.3))
THREE = (replace(RACES[0], masses=(0.015,) * 3), replace(RACES[1], masses=(0.015,) * 4))
UNLIKE = replace(LOADED.system(), stiffness=LOADED.system().stiffness * np.diag([1.0, 1.6, 1.6, 1.0]))
_TURNING = "solvers.rotor.balls.stability:_turning_motions"
PLANAR = Jeffcott(10.0, 2e4, 60.0, 1.2e-3).system()


def rest_near(
    machine: RotorWithBalls, speed: float, places: Sequence[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Places next to given ones at which the balls rest, and the rotor's complex amplitudes there."""
    compliance = machine.compliance(np.array([speed]))
    found = machine.nearest(compliance[0], places)
    assert found is not None
    return found, machine.coordinates(compliance, found[None])[0]


def motion_derivative(
    system: RotorSystem, races: tuple[BallRace, ...], speed: float, places: np.ndarray, deflection: np.ndarray
) -> np.ndarray:
    """Of the rates of motion in the turning frame, by complex steps of the equations of motion themselves."""
    axes, balls = race_arrays(system, races)
    n, count = len(system.coordinates), len(balls)
    turn = speed * quarter_turn(system)
    turning = np.stack((system.unbalance.real, system.unbalance.imag))
    base = np.concatenate((deflection, places, np.zeros(n + count)))
    columns = []
    for k in range(base.size):
        moved = base.astype(complex)
        moved[k] += 1e-30j
        p, psi, dp, dpsi = np.split(moved, [n, n + count, 2 * n + count])
        state = np.concatenate((p, dp + turn @ p, psi, dpsi + speed, [0.0, 0.0]))
        out = np.zeros(state.size, dtype=complex)
        matrices = (system.mass.astype(complex), system.damping + speed * system.gyroscopic, system.stiffness)
        rates(0.0, state, *matrices, turning, axes, balls, np.array([speed, 0.0]), out)
        # In the standing frame q'' = p'' + 2 J p' + J J p at time 0.
        ahead = out[n : 2 * n] - 2.0 * turn @ dp - turn @ turn @ p
        columns.append(np.concatenate((dp, dpsi, ahead, out[2 * n + count : -2])).imag / 1e-30)
    return np.array(columns).T


@kills(_TURNING, "damping + 2.0 * speed", "damping + speed")
@kills(_TURNING, "-2.0 * speed * moment", "2.0 * speed * moment")
@kills(_TURNING, "-(speed**2) * moment", "speed**2 * moment")
@kills(_TURNING, "+ speed * damping @ turn", "- speed * damping @ turn")
@kills(_TURNING, "np.diag(speed**2 * moment", "np.diag(-(speed**2) * moment")
@kills(_TURNING, "np.diag(balls[:, 2] *", "np.diag(0.5 * balls[:, 2] *")
@kills("solvers.rotor.balls.states:RotorWithBalls.compliance", "+ 1j * s * damping", "- 1j * s * damping")
@pytest.mark.parametrize(
    ("system", "races"),
    [
        (LOADED.system(), RACES),
        (LOADED.system(), THREE),
        (PLANAR, (RACES[0], replace(THREE[0], position=0.0))),
    ],
    ids=["two balls", "more balls", "planar"],
)
def test_linear_equations_are_the_derivative_of_the_motion(
    system: RotorSystem, races: tuple[BallRace, ...]
) -> None:
    """About a steady state with deflection, found by Newton's method from places that are none."""
    speed, count = 70.0, sum(len(race.masses) for race in races)
    begin = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, count)
    places, coordinates = rest_near(RotorWithBalls(system, races), speed, begin)
    deflection = coordinates.real
    small = linearised(system, races, speed, places, deflection)
    size = small.mass.shape[0]
    found = np.zeros((2 * size, 2 * size))
    found[:size, size:] = np.eye(size)
    found[size:] = -np.linalg.solve(small.mass, np.hstack((small.stiffness, small.damping)))
    expected = motion_derivative(system, races, speed, places, deflection)
    # Matrices solved with both ways: rounding of entries up to 1e5, and Newton's 1e-13 in the places.
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


def test_steady_balls_are_not_pulled_and_the_rotor_stays() -> None:
    system, speed = LOADED.system(), 70.0
    machine = RotorWithBalls(system, RACES)
    places, coordinates = rest_near(machine, speed, [0.3, 0.4, 2.0, 2.1])
    assert np.abs(coordinates).max() > 1e-6
    # Seen from the ball the axis moves outward or inward, not along the race: rounding of Newton's method.
    seen = (machine.axes @ coordinates.real) @ np.array([1.0, 1.0j]) * np.exp(-1j * places)
    assert np.abs(seen.imag).max() < 1e-11 * np.abs(seen).max()
    balanced = balanced_places(system, RACES)
    run = simulate(system, RACES, speed, 0.5, places=balanced, samples=5)
    # From the balanced state, at rest, nothing moves: rounding of the unbalance's force alone.
    assert np.abs(run.coordinates).max() < 1e-12


@kills("solvers.rotor.balls.states:_pulls", "slope - seen.real", "slope + seen.real")
@kills("solvers.rotor.balls.states:_pulls", "turn.conj()[:, :, None] * each", "turn[:, :, None] * each")
@pytest.mark.parametrize("system", [LOADED.system(), UNLIKE], ids=["alike", "unlike"])
def test_slopes_of_the_pulls_are_their_derivatives(system: RotorSystem) -> None:
    machine, places = RotorWithBalls(system, THREE), np.random.default_rng(1).uniform(0.0, 6.0, 7)
    compliance = machine.compliance(np.array([70.0]))
    slope, step = machine.pulls(compliance, places[None])[1][0], 1e-5
    for k in range(7):
        aside = np.zeros(7)
        aside[k] = step
        ahead, behind = (machine.pulls(compliance, (places + way * aside)[None])[0][0] for way in (1, -1))
        # Of order one: a third derivative times the square of the step, and rounding over it.
        assert slope[:, k] == pytest.approx((ahead - behind) / (2.0 * step), abs=1e-9)


def test_races_in_one_plane_share_the_unbalance_by_what_they_hold() -> None:
    """The small race 1e-4 kg m, the large 9e-4: together they hold all but a thousandth."""
    system = Jeffcott(10.0, 2e4, 60.0, 0.999e-3).system()
    small = BallRace(0.0, 0.05, (1e-3, 1e-3), 0.3)
    races = (small, replace(small, radius=0.09, masses=(5e-3, 5e-3)))
    places = balanced_places(system, races)
    # cos of half the gap is the share of what it holds, the same in both.
    assert np.cos(0.5 * (places[1] - places[0])) == pytest.approx(0.999, abs=1e-12)
    assert np.cos(0.5 * (places[3] - places[2])) == pytest.approx(0.999, abs=1e-12)


@kills("solvers.rotor.balls.stability:neutral_directions", "rows[:, mine]", "rows[:, : mine.size]")
def test_balls_in_a_plane_at_rest_move_freely_beside_others_that_hold_a_deflection() -> None:
    """Three balls of nothing to balance in the middle, two off it that leave a couple: the middle stays."""
    supports = (Support(0.2, 1e4, 40.0), Support(-0.2, 1e4, 40.0))
    couple = (PlaneUnbalance(0.15, 8e-4, 0.0), PlaneUnbalance(-0.15, 8e-4, np.pi))
    system = replace(LONG, supports=supports, unbalances=couple).system()
    light = replace(RACES[0], masses=(1e-3,))
    races = (light, replace(light, position=-0.15), replace(RACES[0], position=0.0, masses=(0.01,) * 3))
    machine = RotorWithBalls(system, races)
    even = 2.0 * np.pi * np.arange(3) / 3.0
    places, q = rest_near(machine, 70.0, [0.1, np.pi + 0.1, *even])
    compliance = machine.compliance(np.array([70.0]))
    free = machine.at_rest(compliance, places[None])[0]
    assert free.tolist() == [False, False, True, True, True]
    small = small_motions(machine, 70.0, places, q, free)
    assert small.neutral.shape == (5, 1)
    assert np.abs(small.neutral[:, 0]) == pytest.approx([0.0, 0.0, *[3.0**-0.5] * 3], abs=1e-6)
    # Without the direction the roots are those of the whole matrix but the one at 0.
    whole = small_motions(machine, 70.0, places, q).roots()
    whole = np.delete(whole, np.argmin(np.abs(whole)))
    assert np.sort(whole.real) == pytest.approx(np.sort(small.roots().real), abs=1e-6)


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


def settled_map(machine: RotorWithBalls, places: np.ndarray, q: np.ndarray | None) -> None:
    """The half turn has the real parts of the roots in the turning frame."""
    small = small_motions(machine, 70.0, places, q)
    whole = np.zeros(len(machine.system.coordinates), dtype=complex) if q is None else q
    over = stability._settled_half_turn(machine, 70.0, places, whole, small.neutral)
    assert over.settled
    roots, found = np.sort(small.roots().real), np.sort(over.roots().real)
    # Settled to 1e-6 in half a turn for the leading one; the others are of the same fourth order.
    assert found == pytest.approx(roots, abs=1e-4 * 70.0 / np.pi)
    assert found[-1] == pytest.approx(roots[-1], abs=4e-6 * 70.0 / np.pi)


@kills("solvers.rotor.balls.stability:_standing_rates", "-2.0 * speed * np", "2.0 * speed * np")
@kills("solvers.rotor.balls.stability:_half_turn", "second @ first - first @ second", "first @ second")
@pytest.mark.parametrize(
    "machine",
    [
        RotorWithBalls(LOADED.system(), RACES),
        RotorWithBalls(PLANAR, (replace(RACES[0], position=0.0),)),
        RotorWithBalls(LOADED.system(), THREE),
    ],
    ids=["two planes", "one plane", "more balls"],
)
def test_multipliers_of_alike_supports_are_the_roots(machine: RotorWithBalls) -> None:
    """About the balanced state: real parts of its roots, frequencies up to turns."""
    settled_map(machine, balanced_places(machine.system, machine.races), None)


@kills(
    "solvers.rotor.balls.stability:_standing_rates",
    "= speed**2 * moment[:, 0]",
    "= -(speed**2) * moment[:, 0]",
)
@kills("solvers.rotor.balls.stability:_standing_rates", "1j * speed * times", "-1j * speed * times")
def test_multipliers_are_the_roots_about_a_deflection_as_well() -> None:
    machine = RotorWithBalls(LOADED.system(), RACES)
    settled_map(machine, *rest_near(machine, 70.0, [0.3, 0.4, 2.0, 2.1]))


def test_half_turn_is_of_fourth_order_and_says_where_it_has_not_settled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of an unlike rotor with a deflection; 16 for each halving of the step."""
    machine = RotorWithBalls(UNLIKE, RACES)
    places, q = rest_near(machine, 70.0, [1.9, 1.9, -1.8, -1.8])
    assert np.abs(q).max() > 1e-6
    maps = [small_motions(machine, 70.0, places, q, steps=steps) for steps in (32, 64, 128)]
    assert all(isinstance(each, HalfTurn) for each in maps)
    off = [np.abs(each.map - maps[-1].map).max() for each in maps[:2]]  # type: ignore[union-attr]
    # Against the finest in place of the exact: (1 - 1/256)/(1/16 - 1/256) = 17.
    assert off[0] / off[1] == pytest.approx(17.0, rel=0.1)
    monkeypatch.setattr(stability, "_MOST", STEPS)
    assert not balanced_stability(UNLIKE, RACES, 70.0).settled
    assert not balanced_stability(UNLIKE, RACES, 70.0).stable


@pytest.mark.parametrize(("speed", "grows"), [(40.0, True), (100.0, False)])
def test_unlike_supports_grow_and_die_in_time_as_the_multipliers_say(speed: float, grows: bool) -> None:
    system = replace(PLANAR, stiffness=np.diag([2e4, 3e4]))
    race = (replace(RACES[0], position=0.0),)
    known = balanced_stability(system, race, speed)
    assert (known.growth > 0.0) == grows
    off = 1e-7 if grows else 1e-3
    run = simulate(system, race, speed, 30.0, places=known.places + off * np.array([1.0, 0.3]), samples=6001)
    size = np.hypot(*run.coordinates.T)
    late = (run.time > (15.0 if grows else 4.0)) & (size < 1e-4) & (size > 1e-13)
    rate = np.polyfit(run.time[late], np.log(size[late]), 1)[0]
    # The second exponent is three quarters of the first: after these times a tenth of the slope is its.
    assert rate == pytest.approx(known.growth, rel=0.1)


def test_more_balls_than_the_balance_needs_are_told_and_are_no_growth() -> None:
    """Three and four balls: 7 places less 4 conditions. Along these the rotor stays balanced; none grows."""
    system = LOADED.system()
    found = balanced_stability(system, THREE, 120.0)
    assert found.neutral.shape == (7, 3) and found.stable
    machine = RotorWithBalls(system, THREE)
    moved = machine.moments(found.places + 1e-6 * found.neutral[:, 0])
    left = np.abs(system.unbalance + moved.sum(axis=1)).max()
    # Left in second order alone.
    assert left < 1e-10 * np.abs(moved).sum()
    assert balanced_stability(system, RACES, 120.0).neutral.shape == (4, 0)
    opposite = neutral_directions(RotorWithBalls(LONG.system(), RACES), [0.0, np.pi, 0.3, 0.3 + np.pi])
    assert opposite.shape == (4, 2)
    # The whole matrix has a root at 0 for each of them, and the same others.
    small = linearised(system, THREE, 120.0, found.places)
    size = small.mass.shape[0]
    matrix = np.zeros((2 * size, 2 * size))
    matrix[:size, size:] = np.eye(size)
    matrix[size:] = -np.linalg.solve(small.mass, np.hstack((small.stiffness, small.damping)))
    whole = np.linalg.eigvals(matrix)
    whole = whole[np.argsort(np.abs(whole))]
    assert np.abs(whole[:3]).max() < 1e-6 * 120.0 < 1e-1 * np.abs(whole[3])
    assert np.sort(whole[3:].real) == pytest.approx(np.sort(found.roots.real), abs=1e-6 * 120.0)


@given(
    st.floats(0.0, 0.999),
    st.floats(-3.0, 3.0),
    st.integers(2, 6),
    st.integers(2, 6),
)
def test_balanced_places_balance(share: float, angle: float, first: int, second: int) -> None:
    """Over all shares of what the balls can take, and any number of them."""
    races = (replace(RACES[0], masses=(0.015,) * first), replace(RACES[1], masses=(0.01,) * second))
    most = [sum(race.masses) * race.radius for race in races]
    unbalances = (PlaneUnbalance(0.15, share * most[0], angle), PlaneUnbalance(-0.15, share * most[1], 1.0))
    system = replace(LONG, unbalances=unbalances).system()
    places = balanced_places(system, races)
    left = system.unbalance + RotorWithBalls(system, races).moments(places).sum(axis=1)
    # The gap is found to rounding; the sum of up to six vectors of size one.
    assert np.abs(left).max() < 1e-10 * sum(most)


PLACES = "solvers.rotor.balls.states"


@kills(f"{PLACES}:_polygon", "2.0 * others[0] - together", "0.0 * others[0] - together")
@kills(f"{PLACES}:_polygon", "math.atan2(-height", "math.atan2(height")
@kills(f"{PLACES}:_in_plane", "np.argsort(-np.concatenate(arms)", "np.argsort(np.concatenate(arms)")
@given(st.lists(st.lists(st.floats(1e-3, 0.05), min_size=1, max_size=3), min_size=1, max_size=3), st.data())
def test_any_balls_of_a_plane_close_a_polygon_or_cannot(
    masses: list[list[float]], data: st.DataObject
) -> None:
    """They hold anything from nothing, or what the longest arm has over the others, to all together."""
    arms = np.sort([0.1 * mass for part in masses for mass in part])
    least, most = max(0.0, 2.0 * float(arms[-1]) - float(arms.sum())), float(arms.sum())
    races = [BallRace(0.0, 0.1, tuple(part), 0.3) for part in masses]
    size = least + data.draw(st.floats(0.001, 0.999)) * (most - least)
    system = Jeffcott(10.0, 1e4, 40.0, size).system()
    if arms.size > 1:
        places = balanced_places(system, races)
        left = system.unbalance + RotorWithBalls(system, tuple(races)).moments(places).sum(axis=1)
        # Rounding of up to nine vectors; an arc's gap is found to rounding.
        assert np.abs(left).max() < 1e-12 * most
    for beyond in [most * 1.001, *([least * 0.999] if least > 1e-6 * most else [])]:
        with pytest.raises(InputError):
            balanced_places(Jeffcott(10.0, 1e4, 40.0, beyond).system(), races)


@kills(f"{PLACES}:balancing_shares", "np.sqrt(np.add.reduceat(machine.moment, first))", "np.ones(first.size)")
def test_races_of_one_plane_are_used_to_the_same_extent() -> None:
    """Of 2.4e-3 and 0.8e-3 kg m: shares in that ratio, all balls at the angle with cos = -U/(H + h)."""
    races = (BallRace(0.0, 0.08, (0.015, 0.015), 0.3), BallRace(0.0, 0.04, (0.01, 0.01), 0.3))
    system = Jeffcott(10.0, 1e4, 40.0, 1.2e-3).system()
    shares, left = balancing_shares(RotorWithBalls(system, races))
    assert np.abs(shares) == pytest.approx([0.9e-3, 0.3e-3], rel=1e-12) and left < 1e-12
    assert np.cos(balanced_places(system, races)) == pytest.approx([-1.2 / 3.2] * 4, abs=1e-12)


def test_balls_that_do_not_balance_are_refused() -> None:
    for masses in ((0.015,), (0.015, 0.02)):
        with pytest.raises(InputError):
            balanced_roots(LONG.system(), (replace(RACES[0], masses=masses),), 60.0)
    heavy = replace(LONG, unbalances=(PlaneUnbalance(0.15, 3e-3),))
    with pytest.raises(InputError, match="races"):
        balanced_stability(heavy.system(), RACES, 60.0)
    with pytest.raises(InputError, match="places"):
        balanced_stability(LOADED.system(), RACES, 60.0, [0.0, 1.0, 2.0, 3.0])
    with pytest.raises(InputError, match="places"):
        # One race cannot balance a couple.
        balanced_stability(LOADED.system(), RACES[:1], 60.0)
    with pytest.raises(InputError, match="stiffness"):
        linearised(replace(PLANAR, stiffness=np.diag([1e4, 2e4])), RACES[:1], 60.0, [2.0, 4.0])


def test_light_balls_move_a_whirl_as_the_closed_form_says() -> None:
    """Forward whirls; what the form leaves out is of the square of the balls' share."""
    weak, weaker = (
        replace(LONG, supports=tuple(replace(support, damping=damping) for support in SUPPORTS)).system()
        for damping in (0.5, 0.05)
    )
    off = []
    for share in (1e-2, 1e-3):
        races = tuple(replace(race, masses=(0.015 * share,) * 2, drag=0.3 * share) for race in RACES)
        exact, found = balanced_roots(weaker, races, 70.0), light_ball_roots(weaker, races, 70.0)
        assert found.size == 2
        off.append(max(float(np.abs(exact - (root - 70.0j)).min()) for root in found))
    # The supports decay with 0.005 1/s, whose square over the frequency is 6e-7.
    assert off[1] < 0.05 * off[0] + 1e-6 and off[0] < 1e-4
    heavier = light_ball_roots(weak, RACES, 60.0).real.max()
    assert heavier > 0.0 > light_ball_roots(weak, RACES, 100.0).real.max()
