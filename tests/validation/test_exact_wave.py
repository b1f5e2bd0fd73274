"""The exact wave beside two other codes, number by number, as `leblanc validate exact_wave` prints it."""

from __future__ import annotations

import json
from collections import Counter
from itertools import islice

import pytest

from solvers.potential.steady import on_nodes
from solvers.potential.strip import nodes
from tests.oracles.cases import come_out_again, kept_group, verdicts
from validation.breaking import kept
from validation.cases.liquid.exact_wave import (
    NEAR,
    _circles,
    _forced,
    _free,
    climbed,
    free_figure,
    last_crests,
    last_place,
    sharp_figure,
)
from validation.study import data


def test_every_number_agrees_to_its_digits() -> None:
    """But for two greatest speeds, of which the other code saw too few waves: here they are greater."""
    found, table = kept_group("exact_wave"), data("exact_wave.json")
    assert verdicts(found, "erratum") == {"greatest-0.3", "greatest-0.5"}
    assert len(verdicts(found, "agrees")) == len(found) - 2
    come_out_again([*_circles(), *islice(_forced(table), 6), *islice(_free(table), 3)])


def test_no_number_is_left_out() -> None:
    """Every entry of the tables has its case, and what is compared is what is printed there."""
    table, found = data("exact_wave.json"), kept_group("exact_wave")
    kinds = Counter(name.split("-")[0] for name in found)
    columns = {"forced": 3, "linear": 1, "near_resonance": 1, "greatest": 1, "limiting": 1}
    wanted = {key.split("_")[0]: count * len(table[key]) for key, count in columns.items()}
    wanted["models"] = sum(len(row.keys() & {"force", "long_wave", "dispersion"}) for row in table["models"])
    wanted["free"] = sum(map(len, table["free"].values()))
    wanted["fold"] = sum(map(len, table["folds"].values()))
    wanted["ends"] = 4 * len(table["ends"]["whirls"])
    assert {key: kinds[key] for key in wanted} == wanted
    printed = {case["printed"] for case in found.values()}
    assert {float(row["force"]) for row in table["forced"]} <= printed
    assert {float(speed) for column in table["free"].values() for speed in column.values()} <= printed


def test_figures_of_the_notebook() -> None:
    """Waves climb as far as they are asked, and what a reader is told of them is theirs."""
    assert {depth: crest for depth, crest in last_crests().items() if depth > 0.25} == {
        row.depth: NEAR * row.crest for row in kept().highest if row.depth in (0.3, 0.5)
    }
    climb = climbed(0.5, 1.2)
    assert climb[-1].crest == pytest.approx(1.2, rel=1e-9) and climb[-1].single
    # The faster the higher, as far as that.
    speeds = [wave.slip_speeds()[0] for wave in climb]
    assert speeds == sorted(speeds)
    assert f"{speeds[-1] / (1.0 + 2.0 * speeds[-1]):.4f} at 1.200" in free_figure({0.5: climb}).alt
    figure = sharp_figure(climb[-1], climb[2])
    assert f"{climb[-1].tail:.1e} with crowded nodes" in figure.alt
    even = on_nodes(climb[-1], nodes(climb[-1].surface.size - 1, 1, 1.0))
    assert climb[-1].at.cluster < 1.0 and even.tail > climb[-1].tail


def test_a_digit_that_is_wrong_is_seen() -> None:
    """Twelve digits are held to twelve: a unit of the eleventh is more than is allowed."""
    checked = [case for name, case in kept_group("exact_wave").items() if name.startswith("free-0.1-1.2")]
    assert checked and all(abs(case["computed"] - case["printed"]) < 1e-11 for case in checked)
    assert last_place("-0.248774599939") == 1e-12
    json.dumps([case.to_json() for case in _circles()], allow_nan=False)
