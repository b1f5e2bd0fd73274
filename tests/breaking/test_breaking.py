"""What is kept of the breaking of the exact wave comes out again, and the page shows it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tests.breaking.__main__ import CREST_DEPTHS, DEPTHS, WHIRLS, ending, highest
from validation.breaking import crests, kept
from validation.breaking.figure import alternative, breaking_figure, crest_figure, crest_words, pair_shown

ROOT = Path(__file__).parents[2]


def test_all_that_is_asked_is_kept() -> None:
    results = kept()
    assert [(row.depth, row.whirl) for row in results.endings] == [(d, w) for d in DEPTHS for w in WHIRLS]
    assert [row.depth for row in results.highest] == list(CREST_DEPTHS)
    for depth in DEPTHS:
        rows = [row for row in results.endings if row.depth == depth]
        # A smaller whirl takes longer, and the crest that breaks is then lower.
        assert [row.periods for row in rows] == sorted(row.periods for row in rows)
        for row in rows:
            assert bool(row.reason) == (row.state == "broken") and row.crest_number < 1.2


@pytest.mark.slow
@pytest.mark.parametrize("depth", [0.5, 0.7])
def test_highest_crests_come_out_again(depth: float) -> None:
    """Seconds at these depths."""
    (row,) = [row for row in kept().highest if row.depth == depth]
    again = highest(depth)
    assert (again.crest, again.last, again.slip) == pytest.approx((row.crest, row.last, row.slip), rel=1e-6)


def test_highest_crests_are_those_of_another_code() -> None:
    others = {0.1: 1.635, 0.3: 1.3935, 0.5: 1.2387}
    for found in kept().highest:
        # Its last digit or two.
        known = others.get(found.depth, found.crest)
        assert found.crest == pytest.approx(known, abs=3e-3 if found.depth == 0.1 else 2e-4)


@pytest.mark.slow
def test_an_ending_comes_out_again() -> None:
    (row,) = [row for row in kept().endings if (row.depth, row.whirl) == (0.7, 0.1)]
    again = ending(0.7, 0.1)
    # Where a crest breaks rounding grows; a step is 0.01 of a period.
    assert again.periods == pytest.approx(row.periods, abs=0.02) and again.state == row.state
    assert again.crest == pytest.approx(row.crest, rel=0.01)


def test_the_crest_that_breaks_does_not_hang_on_its_nodes() -> None:
    """Three numbers of nodes, and another code's values at two moments to their digits."""
    found = {(row.most, row.time): row for row in crests.kept()}
    for time in crests.TIMES[:-1]:
        few, _, many = (found[most, time] for most in crests.MOST)
        # What half a step does to a slope that gains a degree in 0.02 is the rest.
        assert few.crest == pytest.approx(many.crest, rel=2e-3)
        assert few.slope == pytest.approx(many.slope, rel=0.07 if time > 66.0 else 0.005)
        # The crests themselves stand where they stand to a node.
        assert few.place == pytest.approx(many.place, abs=0.01)
    for most in crests.MOST:
        at = found[most, 66.0]
        assert at.crest == pytest.approx(1.507, abs=1.5e-3) and at.slope == pytest.approx(31.7, abs=0.15)
        assert at.crest_number == pytest.approx(0.69, abs=0.01)
        assert 40.5 < found[most, 66.5].slope < 44.5 and 0.765 < found[most, 66.5].crest_number < 0.795
    ends = [row for row in crests.kept() if row.reason]
    assert [row.most for row in ends] == list(crests.MOST)
    # None overhangs; more nodes go further, with more slope.
    assert [row.time for row in ends] == sorted(row.time for row in ends) and ends[-1].time < 67.0
    assert [row.slope for row in ends] == sorted(row.slope for row in ends) and ends[-1].slope < 90.0
    page = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")
    for row in crests.kept():
        assert f"{row.crest:.3f}, {row.slope:.1f} deg, {row.crest_number:.2f}" in page
    assert len(found[crests.MOST[0], 60.0].depth) == crests.angles().size


@pytest.mark.slow
def test_the_crest_that_breaks_comes_out_again() -> None:
    most = crests.MOST[0]
    again = crests.followed(most, breaking=math.inf)
    for row, before in zip(again, (row for row in crests.kept() if row.most == most), strict=True):
        # Where a crest breaks rounding grows.
        assert row.time == pytest.approx(before.time, abs=0.05)
        assert row.crest == pytest.approx(before.crest, rel=2e-3)
        assert row.slope == pytest.approx(before.slope, rel=0.05)
        assert row.crest_number == pytest.approx(before.crest_number, abs=0.02)
    *_, last = crests.followed(most)
    # As it is judged by itself it ends before.
    assert last.state == "broken" and "crest breaks" in last.reason and last.time < again[-1].time - 0.5
    (row,) = [row for row in kept().endings if (row.depth, row.whirl) == (crests.LAYER, crests.SHARE)]
    period = crests.resonant(crests.LAYER, crests.SHARE)[1].period
    assert last.time / period == pytest.approx(row.periods, abs=0.02)


def test_long_waves_go_with_the_exact_one_until_its_end() -> None:
    for row in kept().beside:
        assert len(row.time) == len(row.exact) == len(row.crest)
        # In the first period a small force is a sum over steps.
        assert row.force[0] < (2e-3 if row.dispersion else 0.01)
        assert max(row.force[1:], default=0.0) < (1e-3 if row.dispersion else 0.04)
        gap = np.abs(np.subtract(row.crest, row.exact))
        assert gap[: int(0.8 * gap.size)].max() < (0.005 if row.dispersion else 0.03)


def test_the_figure_and_its_page() -> None:
    figure = breaking_figure()
    assert figure.alt == alternative(kept()) and len(pair_shown(kept())) == 2
    finest = [row for row in crests.kept() if row.most == max(crests.MOST)]
    assert crest_figure().alt == crest_words(finest) and f"{finest[-1].slope:.1f} deg" in crest_words(finest)
    page = (ROOT / "docs" / "accuracy.md").read_text(encoding="utf-8")
    assert "(images/breaking.png)" in page and "(images/breaking_crest.png)" in page
