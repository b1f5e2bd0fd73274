"""The measured ball balancer: verdicts, a kept run made again, and which resistance is the nearest."""

from __future__ import annotations

import pytest

from solvers.rotor.two_plane import Support
from tests.mutants import kills
from tests.oracles.cases import come_out_again, kept_group, verdicts
from validation.cases.measured_balls import cases, figure, machine, runs

GROUP = "validation.cases.measured_balls"


def test_cases_of_the_measured_balls() -> None:
    found = kept_group("measured_balls")
    assert verdicts(found, "erratum") == {"stiffness"}
    # Balls that roll freely balance one and two washers better than measured, in an eccentric race as well.
    free = {f"{why}-{washers}" for why in ("rolling", "eccentric-race") for washers in (1, 2)}
    assert verdicts(found, "differs") == free
    assert {f"sticking-{washers}" for washers in range(4)} <= verdicts(found, "agrees")
    come_out_again(cases.cases())


@kills(f"{GROUP}.machine:couples", "-longer *", "longer *")
def test_the_washers_sit_beside_the_race() -> None:
    """In one plane, on its side of the centre of mass; the misalignment without them was not used for it."""
    place, couple = machine.washer_plane()
    assert 0.020 < place < 0.040
    rotor = machine.known()["rotor"]
    tilt = abs(couple) / (rotor["transverse_inertia"] - rotor["polar_inertia"])
    # Printed with two digits.
    assert tilt == pytest.approx(6.1e-5, abs=0.05e-5)


@kills(f"{GROUP}.machine:rotor", "0.5 * abs(couple) / arm, angle)", "abs(couple) / arm, angle)")
def test_the_rotor_has_what_was_measured_of_its_unbalance() -> None:
    """Its force and its couple about the centre of mass, with one to four washers, as the source has them."""
    for washers in range(1, 5):
        moment = machine.rotor(washers).system().unbalance
        # U of x is the force, that of beta the couple: eq. 19 of the theory of the rotor.
        assert abs(moment[0]) == pytest.approx(12.4e-6 * washers, rel=1e-9)
        assert abs(moment[3]) == pytest.approx(abs(machine.couples()[washers - 1]), rel=0.005)
    assert machine.rotor(0).supports[0] == Support(-0.11, (21500.0, 15800.0), (5.375, 3.95))


@kills(f"{GROUP}.cases:eccentric", "+ centre", "- 0.0 * centre")
def test_balls_balance_the_centre_of_an_eccentric_race() -> None:
    """At most its 5 um more than in a centred one, and a good part of them in the worst direction."""
    more = cases.eccentric(1) - cases.unresisted(1)
    assert 1e-6 < more < 5e-6


def test_one_resistance_is_nearer_than_any_other() -> None:
    assert min(runs.RESISTANCES, key=cases.misfit) == runs.BEST
    # Half of the error without, a quarter of that of more.
    assert cases.misfit(runs.BEST) < 0.5 * cases.misfit(0.0)
    assert cases.misfit(runs.BEST) < 0.25 * cases.misfit(max(runs.RESISTANCES))
    low, high = cases.as_good()
    assert low < runs.BEST < high


def test_kept_runs_come_out_again() -> None:
    """Three washers, whose ways all lead to one amplitude: to the digits that are kept but for rounding."""
    places = runs.starts(1)[0]
    for resistance in (0.0, runs.BEST):
        again = 1e6 * runs.level_of(3, resistance, 0.01, places, runs.GRAVITY)
        # The second drag, the first start.
        kept = cases.levels(resistance)[3][4]
        assert again == pytest.approx(kept, rel=0.01)


def test_the_figure_of_the_measured_balls() -> None:
    one, three, levels = figure.curves_figure().axes
    for axes in (one, three):
        marks = [line for line in axes.get_lines() if line.get_label().startswith("measured")]
        assert [line.get_xdata().size for line in marks] == [18] * 3
    across = {line.get_ydata()[0] for line in levels.get_lines() if line.get_linestyle() == "--"}
    assert across == {1e6 * machine.level("up", washers) for washers in machine.WASHERS}
    # The medians over the resistance, at the best one as the table of the page has them.
    drawn = [line for line in levels.get_lines() if len(line.get_xdata()) == len(runs.RESISTANCES)]
    at = runs.RESISTANCES.index(runs.BEST)
    found = sorted({round(float(line.get_ydata()[at]), 1) for line in drawn if line.get_marker() == "o"})
    assert found == [6.8, 10.7, 13.9, 17.0, 18.3]
