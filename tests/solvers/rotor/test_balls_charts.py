"""Charts of ball balancers: what stands on the curves, and on both sides of them."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from leblanc.scene.scene import Scene, dry_rotor
from meshes.errors import InputError
from solvers.continuation import End, follow
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.balls.charts import (
    NONE,
    Crossing,
    Machine,
    State,
    _on_axis,
    existence_bounds,
    follow_edge,
    stability_chart,
    stable_bands,
)
from solvers.rotor.balls.stability import HalfTurn, balanced_stability, small_motions
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.balls.steps import advance
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from tests.mutants import kills
from tests.oracles.random_balls import machine_with_balls
from validation.cases.two_plane.charts import reference

RACE = BallRace(0.0, 0.08, (0.015, 0.015), 0.3)


def family(speed: float, power: float) -> Machine:
    """A planar rotor over speed and the logarithm of its damping."""
    return Machine(Jeffcott(10.0, 2e4, 10.0**power, 1.2e-3).system(), (RACE,), speed)


@kills("solvers.rotor.balls.stability:Linearised.lasting", "1j * frequency", "2j * frequency")
def test_a_root_stands_on_the_axis_along_each_curve_and_growth_changes_sign_across_the_outermost() -> None:
    chart = stability_chart(family, np.linspace(30.0, 90.0, 9), np.linspace(-0.5, 2.0, 6))
    assert chart.growing.max() > 0 and chart.growing.min() == 0 and chart.edges
    for edge in chart.edges:
        assert edge.kind is Crossing.HOPF and set(edge.ends) <= {End.LEFT, End.CLOSED}
        for k in range(0, edge.first.size, 7):
            machine = family(float(edge.first[k]), float(edge.second[k]))
            roots = balanced_stability(machine.system, machine.races, machine.speed).roots
            near = roots[np.argmin(np.abs(roots - 1j * edge.frequency[k]))]
            # Newton's last change is 1e-10 of the chart's width; roots move with the speed.
            assert abs(near - 1j * edge.frequency[k]) < 1e-6 * machine.speed
    edge = max(chart.edges, key=lambda curve: float(curve.first.max()))
    for k in range(1, edge.first.size - 1, 9):
        speed, power = float(edge.first[k]), float(edge.second[k])
        sides = []
        for share in (0.995, 1.005):
            machine = family(share * speed, power)
            sides.append(balanced_stability(machine.system, machine.races, machine.speed).growth)
        assert sides[0] > 0.0 > sides[1], (speed, power)


def test_states_that_are_not_there_are_marked_and_other_states_are_charted() -> None:
    def loaded(speed: float, unbalance: float) -> Machine:
        return Machine(Jeffcott(10.0, 2e4, 60.0, unbalance).system(), (RACE,), speed)

    speeds = np.array([30.0, 70.0])
    # Two balls take 2.4e-3 kg m.
    chart = stability_chart(loaded, speeds, [1e-3, 3e-3])
    assert chart.growing[:, 1].tolist() == [NONE, NONE] and np.isnan(chart.growth[:, 1]).all()
    # Balls together opposite the unbalance: stable above the critical speed once they do not suffice.
    together = stability_chart(loaded, speeds, [1e-3, 3e-3], State([np.pi, np.pi]))
    assert together.growing[1].tolist() == [1, 0]


def test_bad_grids_are_refused() -> None:
    for first, second in (([1.0], [1.0, 2.0]), ([1.0, 2.0], [2.0, 1.0])):
        with pytest.raises(InputError):
            stability_chart(family, first, second)


BALANCED_BY = 1.2e-3 / (2.0 * 0.08)  # kg: two balls of this mass hold all of 1.2e-3 kg m, and no more


def of_mass(speed: float, mass: float) -> Machine:
    race = BallRace(0.0, 0.08, (mass, mass), 0.3)
    return Machine(Jeffcott(10.0, 2e4, 60.0, 1.2e-3).system(), (race,), speed)


def of_mass_on_unlike(speed: float, mass: float) -> Machine:
    machine = of_mass(speed, mass)
    return replace(machine, system=replace(machine.system, stiffness=np.diag([2e4, 1.2e4])))


def of_unbalance(speed: float, unbalance: float) -> Machine:
    return Machine(Jeffcott(10.0, 2e4, 60.0, unbalance).system(), (RACE,), speed)


@pytest.mark.parametrize(
    ("make", "values", "count", "exact"),
    [
        (of_mass, (0.004, 0.0137), 4, BALANCED_BY),
        (of_unbalance, (1e-3, 4e-3), 4, 2.0 * 0.015 * 0.08),
        (of_mass_on_unlike, (0.004, 0.0137), 2, BALANCED_BY),
    ],
    ids=["ball mass", "unbalance", "unlike supports"],
)
def test_the_balanced_state_branches_off_where_balls_just_suffice(
    make: type[Machine], values: tuple[float, float], count: int, exact: float
) -> None:
    """Both balls on the light side: a root is 0 at every speed where N m R is the unbalance."""
    grid = np.linspace(55.0, 90.0, count), np.linspace(*values, count)
    chart = stability_chart(make, *grid, State([np.pi, np.pi]))
    assert set(chart.growing.ravel().tolist()) == {0, 1}
    assert len(chart.edges) == 1
    edge = chart.edges[0]
    assert edge.kind is Crossing.ZERO and edge.ends == (End.LEFT, End.LEFT)
    assert edge.first.min() <= 55.0 and edge.first.max() >= 90.0
    # Newton's last change is 1e-10 of the chart's width.
    assert edge.second == pytest.approx(exact, rel=1e-9)
    assert edge.first.size > 40 and not edge.frequency.any()


def heavy(speed: float, unbalance: float) -> Machine:
    """One ball that holds more than the unbalance, up to 1.6e-3 kg m."""
    return Machine(
        Jeffcott(10.0, 2e4, 200.0, unbalance).system(), (BallRace(0.0, 0.08, (0.02,), 0.3),), speed
    )


@kills("solvers.rotor.balls.charts:_held", "rotor.coordinates(compliance, places[None])[0]", "np.zeros(2)")
def test_states_of_a_heavy_ball_meet_in_the_fold_of_their_quadratic() -> None:
    """|D a - m R| = U: two deflections a that meet where U = m R |Im D|/|D|, and none below."""
    chart = stability_chart(heavy, np.linspace(20.0, 44.0, 3), np.linspace(2e-4, 1.5e-3, 3), State([-0.8]))
    assert NONE in chart.growing and 0 in chart.growing
    assert len(chart.edges) == 1
    edge = chart.edges[0]
    assert edge.kind is Crossing.ZERO and edge.ends == (End.LEFT, End.LEFT)
    stiffness = 2e4 - 10.02 * edge.first**2 + 200j * edge.first
    exact = 0.02 * 0.08 * np.abs(stiffness.imag) / np.abs(stiffness)
    assert edge.second == pytest.approx(exact, rel=1e-9)


SUPPORTS = (Support(0.2, 1e4, 40.0), Support(-0.22, 1.1e4, 40.0))
LONG = TwoPlane(10.0, 0.5, 0.1, SUPPORTS, ())
TWO_RACES = tuple(replace(RACE, position=place) for place in (0.15, -0.15))


def of_share(speed: float, share: float) -> Machine:
    """A long rotor with two unbalances, each times a share."""
    unbalances = PlaneUnbalance(0.15, share * 1e-3, 0.0), PlaneUnbalance(-0.1, share * 8e-4, 2.0)
    return Machine(replace(LONG, unbalances=unbalances).system(), TWO_RACES, speed)


def test_a_fold_of_two_planes_is_the_turn_of_its_states() -> None:
    """The state with the balls of each race together, followed down in speed, turns near 62.3 rad/s."""
    machine = RotorWithBalls(of_share(100.0, 1.0).system, TWO_RACES)

    def left(point: np.ndarray) -> np.ndarray:
        return machine.pulls(machine.compliance(point[:1]), point[None, 1:])[0][0]

    begin = machine.nearest(machine.compliance(np.array([100.0]))[0], [2.8, 2.8, -1.1, -1.1])
    assert begin is not None
    unit = [30.0, 1.0, 1.0, 1.0, 1.0]
    low, high = np.array([50.0, *[-9.0] * 4]), np.array([120.0, *[9.0] * 4])
    states = follow(left, [100.0, *begin], unit, low, high, way=-1)
    turn = int(np.argmin(states.points[:, 0]))
    assert 2 < turn < len(states.points) - 3 and states.end is End.LEFT
    # The vertex of a parabola through the points about the turn, by the place of the first ball.
    near = states.points[turn - 2 : turn + 3]
    shape = np.polyfit(near[:, 1] - near[2, 1], near[:, 0], 4)
    at = min(np.roots(np.polyder(shape)), key=abs).real
    vertex = float(np.polyval(shape, at))
    # A real root passes 0 there: opposite signs on the two sides.
    signs = []
    for k in (turn - 4, turn + 4):
        speed, places = float(states.points[k, 0]), states.points[k, 1:]
        q = machine.coordinates(machine.compliance(np.array([speed])), places[None])[0]
        roots = small_motions(machine, speed, places, q).roots()
        real = roots[np.abs(roots.imag) < 1e-9].real
        signs.append(np.sign(real[np.argmin(np.abs(real))]))
    assert signs[0] == -signs[1]
    # The curve crosses a corner of the chart.
    chart = stability_chart(of_share, [62.0, 82.0], [0.96, 1.3], State(states.points[turn - 2, 1:]))
    edge = next(edge for edge in chart.edges if edge.kind is Crossing.ZERO)
    order = np.argsort(edge.second)
    found = np.interp(1.0, edge.second[order], edge.first[order])
    # Lines between points a fiftieth of the chart apart: the square of that, of 20 rad/s.
    assert found == pytest.approx(vertex, abs=5e-3)


@kills("solvers.rotor.balls.stability:HalfTurn.lasting", "1j * np.pi * frequency", "2j * np.pi * frequency")
def test_nearly_equal_supports_have_the_curve_of_equal_ones() -> None:
    """On the curve of unlike supports a root of the equal ones is off the axis by as much as they differ."""

    def unlike(off: float, speed: float, power: float) -> Machine:
        machine = family(speed, power)
        stiffness = machine.system.stiffness @ np.diag([1.0, 1.0 + off])
        return replace(machine, system=replace(machine.system, stiffness=stiffness))

    away = []
    for off in (1e-3, 1e-4):
        chart = stability_chart(lambda *at, off=off: unlike(off, *at), [50.0, 65.0], [0.8, 2.0])  # type: ignore[misc]
        assert chart.edges
        sizes = []
        for edge in chart.edges:
            for k in range(0, edge.first.size, 5):
                machine = family(float(edge.first[k]), float(edge.second[k]))
                roots = balanced_stability(machine.system, machine.races, machine.speed).roots
                sizes.append(np.abs(roots - 1j * edge.frequency[k]).min() / machine.speed)
        away.append(max(sizes))
    assert away[0] < 2e-3 and away[1] < 2e-4


@pytest.mark.slow
def test_on_both_sides_of_an_edge_of_unlike_supports_motions_grow_and_die_in_time() -> None:
    """The reference machine with supports of 5 and 45 in one direction, near 4.59."""

    def unlike(speed: float, damping: float) -> Machine:
        return Machine(*reference(damping=damping, alike=False), speed)

    chart = stability_chart(unlike, [4.5, 4.7], [0.0195, 0.0205])
    assert len(chart.edges) == 1
    edge = chart.edges[0]
    assert edge.kind is Crossing.HOPF
    k = int(np.argmin(np.abs(edge.second - 0.02)))
    rates = []
    for share in (0.98, 1.02):
        machine = unlike(share * float(edge.first[k]), float(edge.second[k]))
        known = balanced_stability(machine.system, machine.races, machine.speed)
        rates.append(rate_in_time(machine, known.places))
        # A disturbance of 1e-8 moves by its square besides; steps of 1/128 of a turn, of fourth order.
        assert rates[-1] == pytest.approx(known.growth, rel=1e-4)
    assert rates[0] > 1e-3 and rates[1] < -1e-3


def rate_in_time(machine: Machine, places: np.ndarray, halves: int = 60) -> float:
    """Growth of the motion that grows most over some half turns, by the full equations of motion."""
    system, speed = machine.system, machine.speed
    small = small_motions(RotorWithBalls(system, machine.races), speed, places)
    assert isinstance(small, HalfTurn)
    factors, right = np.linalg.eig(small.map)
    mine, n, count = int(np.argmax(np.abs(factors))), len(system.coordinates), places.size
    begin = 1e-8 * np.real(right[:, mine]) / np.abs(right[:n, mine]).max()
    q, psi, rate, slip = np.split(begin, [n, n + count, 2 * n + count])
    state = np.concatenate((q, rate, places + psi, speed + slip, [0.0, 0.0]))
    record = np.zeros((halves + 1, state.size))
    turning = np.stack((system.unbalance.real, system.unbalance.imag))
    matrices = system.mass, system.damping + speed * system.gyroscopic, system.stiffness, turning
    axes = race_arrays(system, machine.races)
    advance(state, (*matrices, *axes), np.array([speed, 0.0]), np.pi / speed / 64, 64, record)
    passed = np.arange(halves + 1)[:, None]
    q, rate, phi, spin = np.split(record[:, :-2], [n, 2 * n, 2 * n + count], axis=1)
    reverse = (-1.0) ** passed
    moved = np.hstack((reverse * q, phi - places - np.pi * passed, reverse * rate, spin - speed))
    # Rows of the inverse see their own motion alone.
    size = np.abs(moved @ np.linalg.inv(right)[mine])
    return float(np.log(size[-1] / size[0]) / (halves * np.pi / speed))


def test_a_curve_ends_where_the_balanced_state_does() -> None:
    """Two balls take 2.4e-3 kg m: beyond there is no state whose roots could be followed."""
    chart = stability_chart(of_unbalance, [40.0, 60.0], [1e-3, 2e-3])
    edge = chart.edges[0]
    root = 1j * edge.frequency[0]
    start = [edge.first[0], edge.second[0]]
    longer = follow_edge(of_unbalance, start, root, [30.0, 1e-3], [90.0, 3e-3])
    assert longer is not None and End.NOWHERE in longer.ends
    # A shortest step is 1/256 of 0.02 of the width of 2e-3.
    assert longer.second.max() == pytest.approx(2.4e-3, abs=1e-6) and longer.second.max() <= 2.4e-3


def test_bands_of_one_value_end_where_the_growth_is_nothing() -> None:
    growth, bands = stable_bands(family, np.linspace(30.0, 90.0, 9), 1.0)
    assert growth.shape == (9,) and len(bands) == 1 and bands[0][1] == 90.0
    machine = family(bands[0][0], 1.0)
    found = balanced_stability(machine.system, machine.races, machine.speed).growth
    assert abs(found) < 1e-9 * machine.speed
    assert stable_bands(family, [30.0, 40.0], 1.0)[1] == []


ON_AXIS = "solvers.rotor.balls.charts:_on_axis"


@kills(ON_AXIS, "-whole @ parts[2]", "whole @ parts[2]")
@kills(ON_AXIS, "2.0 * far * parts[2]", "far * parts[2]")
@kills(ON_AXIS, "terms = [(matrix, unit), (unit, matrix)]", "terms = [(matrix, unit), (matrix, unit)]")
def test_roots_on_the_axis_are_found_however_narrow_the_band() -> None:
    """A pair w^2 - (t - 0.3)^2 +- 2 i grows over a width of 2 w alone; a third root is t + 0.5."""
    for width in (1e-2, 1e-4, 1e-6):
        middle, rise, bend = (np.zeros((3, 3)) for _ in range(3))
        middle[:2, :2] = [[width**2 - 0.09, 2.0], [-2.0, width**2 - 0.09]]
        rise[:2, :2], bend[:2, :2] = 0.6 * np.eye(2), -np.eye(2)
        middle[2, 2], rise[2, 2] = 0.5, 1.0
        turn = np.random.default_rng(1).uniform(-1.0, 1.0, (3, 3)) + 2.0 * np.eye(3)
        alike = (turn @ part @ np.linalg.inv(turn) for part in (middle, rise, bend))
        found = _on_axis(*alike)
        for exact in (-0.5, 0.3 - width, 0.3 + width):
            # Of two roots this near to one another rounding leaves its square root.
            assert np.abs(found - exact).min() < 1e-12 / width + 1e-12


def _turned(machine: Machine, speed: float, _: float) -> Machine:
    return replace(machine, speed=speed)


BALANCES = (3, 21)  # machines at random whose balls balance them, one in a band of 1.6 rad/s as well


@kills("solvers.rotor.balls.charts:_looks", "np.unique(found)", "np.unique([first, last])")
@pytest.mark.parametrize("seeds", [BALANCES, pytest.param(tuple(range(200)), marks=pytest.mark.slow)])
def test_bands_are_the_same_from_any_number_of_speeds(seeds: tuple[int, ...]) -> None:
    """From two speeds, and as growth at speeds between says."""
    count = 0
    for seed in seeds:
        scene = Scene(**machine_with_balls(seed))
        system, races = dry_rotor(scene).system(), tuple(race.race() for race in scene.balls)
        if RotorWithBalls(system, races).balanced() is None:
            continue
        turning = partial(_turned, Machine(system, races, 1.0))
        ends = [scene.speeds.start, scene.speeds.stop]
        few = stable_bands(turning, ends, 0.0)[1]
        asked = np.linspace(*ends, 41)
        growth, many = stable_bands(turning, asked, 0.0)
        assert few == many
        inside = np.zeros(asked.shape, dtype=bool)
        for low, high in few:
            inside |= (asked >= low) & (asked <= high)
        clear = np.abs(growth) > 1e-9 * asked
        assert (inside == (growth <= 0.0))[clear].all(), seed
        count += bool(few)
    assert count >= len(seeds) // 10


def test_a_start_where_the_state_is_not_there_gives_no_curve() -> None:
    def ends(speed: float, unbalance: float) -> Machine:
        return Machine(Jeffcott(10.0, 2e4, 60.0, unbalance).system(), (RACE,), speed)

    assert existence_bounds(ends, 50.0, [1e-3, 2e-3, 3e-3]) == pytest.approx([2.4e-3], rel=1e-9)
    corner = [30.0, 1e-3], [90.0, 3e-3]
    assert follow_edge(ends, [60.0, 2.9e-3], 10j, *corner) is None
