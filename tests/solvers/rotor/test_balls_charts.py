"""Charts of ball balancers: what stands on the curves, and on both sides of them."""

from __future__ import annotations

import numpy as np
import pytest

from meshes.errors import InputError
from solvers.continuation import End
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.charts import (
    NONE,
    Crossing,
    Machine,
    State,
    existence_bounds,
    follow_edge,
    stability_chart,
    stable_bands,
)
from solvers.rotor.balls.stability import balanced_stability
from solvers.rotor.jeffcott import Jeffcott

RACE = BallRace(0.0, 0.08, (0.015, 0.015), 0.3)


def family(speed: float, power: float) -> Machine:
    """A planar rotor over speed and the logarithm of its damping."""
    return Machine(Jeffcott(10.0, 2e4, 10.0**power, 1.2e-3).system(), (RACE,), speed)


def test_a_root_stands_on_the_axis_along_each_curve() -> None:
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


def test_growth_changes_sign_across_the_outermost_curve() -> None:
    chart = stability_chart(family, np.linspace(30.0, 90.0, 9), np.linspace(-0.5, 2.0, 6))
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


def test_bands_of_one_value_end_where_the_growth_is_nothing() -> None:
    growth, bands = stable_bands(family, np.linspace(30.0, 90.0, 9), 1.0)
    assert growth.shape == (9,) and len(bands) == 1 and bands[0][1] == 90.0
    machine = family(bands[0][0], 1.0)
    found = balanced_stability(machine.system, machine.races, machine.speed).growth
    assert abs(found) < 1e-9 * machine.speed
    assert stable_bands(family, [30.0, 40.0], 1.0)[1] == []


def test_a_start_where_the_state_is_not_there_gives_no_curve() -> None:
    def ends(speed: float, unbalance: float) -> Machine:
        return Machine(Jeffcott(10.0, 2e4, 60.0, unbalance).system(), (RACE,), speed)

    assert existence_bounds(ends, 50.0, [1e-3, 2e-3, 3e-3]) == pytest.approx([2.4e-3], rel=1e-9)
    corner = [30.0, 1e-3], [90.0, 3e-3]
    assert follow_edge(ends, [60.0, 2.9e-3], 10j, *corner) is None
