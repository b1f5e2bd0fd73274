"""Families of balls' states: ranks by hand, members on a grid, the way of creeping balls, runs in time."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eig, null_space

from meshes.arrays import Array
from solvers.rotor.balls.balancers import BallRace, simulate
from solvers.rotor.balls.families import Member, Polygons, _Budget, _each, _extremes, _Reduced, growth_ranges
from solvers.rotor.balls.stability import Linearised, family_dimension, small_motions
from solvers.rotor.balls.states import RotorWithBalls, balanced_places
from solvers.rotor.balls.steady import BallKind, starts_of, steady_states
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from tests.mutants import kills

ROTOR = Jeffcott(4.0, 4.4e4, 84.0, 6e-4)
SPIN = 250.0
LONG = TwoPlane(
    10.0, 0.5, 0.1,
    (Support(0.3, 2e4, 40.0), Support(-0.3, 2e4, 40.0)),
    (PlaneUnbalance(0.2, 3e-4, 0.4), PlaneUnbalance(-0.2, 2e-4, 2.5)),
)  # fmt: skip


def race(count: int, position: float = 0.0) -> BallRace:
    return BallRace(position, 0.065, (7e-3,) * count, 0.1)


STABILITY = "solvers.rotor.balls.stability"


@kills(
    f"{STABILITY}:family_dimension",
    "neutral_directions(machine, places, still)",
    "neutral_directions(machine, places)",
)
@kills(f"{STABILITY}:neutral_directions", "[sizes > _RANK * sizes.max()]", "[sizes > 0.5 * sizes.max()]")
def test_a_dimension_is_the_number_of_balls_over_the_rank_of_what_they_hold() -> None:
    """A plane at rest binds the sum of its balls, two numbers, unless they stand in one line, then one."""
    some = np.array([0.3, 1.1, 2.9, 4.0, 5.5, 0.9, 2.0, 3.1])
    one_plane, apart = (race(3), race(5)), (race(3, 0.25), race(5, -0.25))
    first, every = np.arange(8) < 3, np.full(8, True)
    for races, still, size in (
        (one_plane, every, 3 + 5 - 2),
        (apart, every, 3 + 5 - 4),
        (apart, first, 3 - 2),
        (apart, ~first, 5 - 2),
        (apart, ~every, 0),
    ):
        assert family_dimension(RotorWithBalls(LONG.system(), races), some, still) == size
    opposite = np.array([0.4, 0.4 + math.pi])
    assert family_dimension(RotorWithBalls(ROTOR.system(), (race(2),)), opposite, np.full(2, True)) == 1
    assert family_dimension(RotorWithBalls(ROTOR.system(), (race(2),)), [0.4, 1.4], np.full(2, True)) == 0


def roots_of_all(found: Linearised) -> Array:
    """Roots of M s^2 + C s + K by a generalised problem in which nothing is left out."""
    size = len(found.mass)
    zero, unit = np.zeros((size, size)), np.eye(size)
    left = np.block([[zero, unit], [-found.stiffness, -found.damping]])
    right = np.block([[unit, zero], [zero, found.mass]])
    return np.asarray(eig(left, right, right=False))


@kills(f"{STABILITY}:Linearised.matrix", "-= self.moved", "+= self.moved")
@kills(
    f"{STABILITY}:Linearised.matrix", "-= self.moved @ self.neutral.T", "-= 0.0 * self.moved @ self.neutral.T"
)
@kills(f"{STABILITY}:_turning_motions", "turn @ deflection / size", "deflection / size")
@kills(f"{STABILITY}:turns_freely", "and not still.all()", "and False")
def test_a_balanced_rotor_with_gathered_balls_may_turn() -> None:
    """A rotor without unbalance, all balls on one side: one root is 0, the others stay as they are."""
    # Supports that damp would take power from balls that nothing but themselves holds back.
    system = Jeffcott(4.0, 4.4e4, 0.0, 0.0).system()
    machine = RotorWithBalls(system, (race(3),))
    start = np.full(3, 0.7)
    moved = machine.coordinates(machine.compliance(np.array([60.0])), start[None])[0]
    still = np.full(3, False)
    assert family_dimension(machine, start, still) == 1
    motions = small_motions(machine, 60.0, start, moved, still)
    assert isinstance(motions, Linearised)
    every = roots_of_all(motions)
    zero = np.argmin(np.abs(every))
    # A double root, of balls that part two ways, is found to the root of rounding of the largest, 110 1/s.
    assert abs(every[zero]) < 1e-5
    left, own = np.delete(every, zero), motions.roots()
    assert own.size == left.size
    assert max(np.abs(left - root).min() for root in own) < 1e-4
    assert max(np.abs(own - root).min() for root in left) < 1e-4


def three_balls(first: float) -> Array | None:
    """Places of three balls that balance `ROTOR`, one of them given: a triangle closed by hand."""
    held = 7e-3 * 0.065
    left = -6e-4 / held - np.exp(1j * first)
    if abs(left) > 2.0:
        return None
    away = math.acos(abs(left) / 2.0)
    return float(np.angle(left)) + np.array([first - float(np.angle(left)), away, -away])


@pytest.mark.parametrize("spin", [130.0, 250.0])
@kills(
    "solvers.rotor.balls.families:_extremes", "goes = better > best + least", "goes = better < best + least"
)
@kills(
    "solvers.rotor.balls.families:_Reduced.growth",
    "-2.0 * speed * np.swapaxes(pulled, 2, 3)",
    "2.0 * speed * np.swapaxes(pulled, 2, 3)",
)
@kills(
    "solvers.rotor.balls.families:_Reduced.growth",
    "2.0 * speed * pushed @ self.turn",
    "-2.0 * speed * pushed @ self.turn",
)
@kills("solvers.rotor.balls.families:_as_two", "first + root + 1j * mixed", "first - root + 1j * mixed")
@kills("solvers.rotor.balls.families:Polygons.held", "np.sin(angles) @ second.T", "np.cos(angles) @ second.T")
def test_the_range_is_that_of_all_members_on_a_grid(spin: float) -> None:
    """Three balls in one plane, one more than needed: the members are a curve, gone along by hand."""
    found = steady_states(ROTOR.system(), [race(3)], [spin])
    assert found.kind[0, 0] == BallKind.BALANCED and found.dimension[0, 0] == 1
    machine, still = RotorWithBalls(ROTOR.system(), (race(3),)), np.full(3, True)
    every = []
    for first in np.linspace(0.0, 2.0 * math.pi, 181):
        places = three_balls(float(first))
        if places is not None:
            every.append(float(small_motions(machine, spin, places, np.zeros(2), still).roots()[0].real))
    (range_,) = growth_ranges([Member(machine, spin, found.places[0, 0], found.coordinates[0, 0], still)])
    assert max(every) - min(every) > 0.1
    # The grid misses an end by h^2/8 of the curvature at most: 1.5e-4 of the span of a few waves.
    slack = 1e-3 * (max(every) - min(every))
    assert range_[0] == pytest.approx(min(every), abs=slack) and range_[0] <= min(every) + 1e-6
    assert range_[1] == pytest.approx(max(every), abs=slack) and range_[1] >= max(every) - 1e-6
    assert range_[0] - 1e-9 <= found.growth[0, 0] <= range_[1] + 1e-9


@kills("solvers.rotor.balls.families:_Reduced.growth", "-(speed**2) * pushed", "speed**2 * pushed")
@kills("solvers.rotor.balls.families:_Reduced.growth", "speed[..., 0] ** 2 * stands", "0.0 * stands")
def test_alike_balls_act_as_two() -> None:
    """Growth with pairs in place of the balls is that of the motions of all, also beside gathered ones."""
    races = (race(4, 0.2), race(3, -0.25))
    machine = RotorWithBalls(LONG.system(), races)
    still = np.arange(7) < 4
    draws = np.random.default_rng(1).uniform(0.0, 2.0 * math.pi, (1, 6, 4))
    own = np.array([0.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5])
    # Any motion that leaves the plane of the first race at rest.
    moved = 1e-4 * (1.0 + 0.3j) * null_space(machine.axes[0]) @ np.array([1.0, 0.4])
    member = Member(machine, 180.0, own, moved, still)
    np.testing.assert_allclose(_Reduced([member]).growth(draws), _each(member)(draws), rtol=0.0, atol=1e-7)


def test_the_search_one_by_one_ends_where_that_at_once_does() -> None:
    """The same budget, so the same members: what supports that differ have to take."""
    machine, still = RotorWithBalls(ROTOR.system(), (race(4),)), np.full(4, True)
    own = Member(machine, SPIN, balanced_places(ROTOR.system(), [race(4)]), np.zeros(2, dtype=complex), still)
    budget = _Budget(4, 4, 1)
    quick = _extremes([own], _Reduced([own]).growth, budget)
    np.testing.assert_allclose(_extremes([own], _each(own), budget), quick, rtol=0.0, atol=1e-7)


def crept(spin: float, count: int, start: Array) -> Array:
    """Where balls end whose places follow their pull, by another solver and the answer of one mass."""
    held = 7e-3 * 0.065
    stiffness = (4.4e4 + 84.0j * spin) / spin**2 - (4.0 + count * 7e-3)

    def pull(_: float, places: Array) -> Array:
        turn = np.exp(1j * places)
        return np.asarray(np.imag((6e-4 + held * turn.sum()) / stiffness * turn.conj()) * 1e4)

    # Slowest rates are some hundredth of the first pull, which is of order 1 here.
    return np.asarray(solve_ivp(pull, (0.0, 3e3), start, method="LSODA", rtol=1e-9, atol=1e-10).y[:, -1])


@kills("solvers.rotor.balls.steady:_to_members", "first = [left[0]", "first = [left[-1]")
@kills("solvers.rotor.balls.states:RotorWithBalls.creep", "(h * second)[kept]", "(h * first)[kept]")
def test_the_reported_member_is_where_creeping_balls_come_to() -> None:
    for count in (3, 5):
        found = steady_states(ROTOR.system(), [race(count)], [SPIN])
        assert found.dimension[0, 0] == count - 2
        ends = crept(SPIN, count, starts_of([count])[0])
        off = np.abs(np.exp(1j * ends) - np.exp(1j * found.places[0, 0]))
        # 1e-5 rad a step, whose errors in the few dozen steps hardly add up.
        assert off.max() < 2e-4


@kills("solvers.rotor.balls.families:Polygons.onto", "found += step", "found -= step")
def test_a_run_from_any_member_stays_there() -> None:
    """Members next to drawn places, in two planes at once: no deflection in time but rounding."""
    races = [race(3, 0.25), race(4, -0.25)]
    own = balanced_places(LONG.system(), races)
    polygons = Polygons(RotorWithBalls(LONG.system(), tuple(races)), np.full(7, True))
    draws = np.random.default_rng(0).uniform(0.0, 2.0 * math.pi, (8, 7))
    members, known = polygons.onto(draws, polygons.held(own))
    assert known.any()
    member = members[np.flatnonzero(known)[0]]
    assert np.abs(np.exp(1j * member) - np.exp(1j * own)).max() > 0.1
    run = simulate(LONG.system(), races, SPIN, 0.2, places=member, samples=5)
    bare = 5e-4 / 10.0
    assert np.abs(run.deflection(LONG.system(), 0.25)).max() < 1e-6 * bare
    turned = np.exp(1j * (run.ball_angle[-1] - SPIN * run.time[-1]))
    np.testing.assert_allclose(turned, np.exp(1j * member), rtol=0.0, atol=1e-6)
