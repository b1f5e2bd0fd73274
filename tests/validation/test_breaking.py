"""What is kept of the breaking of the exact wave comes out again, and the page shows it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from validation.breaking import kept
from validation.breaking.__main__ import CREST_DEPTHS, DEPTHS, WHIRLS, ending, highest
from validation.breaking.figure import alternative, breaking_figure, shown

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
    assert figure.alt == alternative(kept()) and len(shown(kept())) == 2
    page = (ROOT / "docs" / "breaking.md").read_text(encoding="utf-8")
    assert "(images/breaking.png)" in page
