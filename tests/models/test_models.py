"""The table of all models on the front page: what is kept, what models answer, and what the page shows."""

from __future__ import annotations

import importlib.util
import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import leblanc as lb
from leblanc.scene.examples import example
from leblanc.scene.scene import LIQUID_MODELS
from tests import models
from tests.models import ModelRow, error_words, kept, time_words, words
from tests.models.__main__ import SCENES, row_of
from tests.models.figure import alternative, models_figure

ROOT = Path(__file__).parents[2]


def table(scene: str) -> models.ModelTable:
    (found,) = [one for one in kept() if one.scene == scene]
    return found


def test_every_model_has_its_row() -> None:
    for found in kept():
        assert {row.model for row in found.rows} == set(LIQUID_MODELS) - {"auto", "potential"}
        # Just one of them is the best answer, from which errors are taken.
        assert sum(math.isnan(row.error) for row in found.rows) == 1
        assert found.best_error < 0.01 and all(row.time > 0.0 for row in found.rows)


@pytest.mark.parametrize("model", ["linear", "kdv", "statics"])
def test_what_is_kept_is_what_the_models_answer(model: str) -> None:
    """Upright, where the exact equilibrium is the best answer; times are of another day."""
    scene = example("runup").replace(SCENES["runup"][0])
    exact, answer = (lb.compare(scene, [name]).answers[0] for name in ("statics", model))
    found = row_of(model, None, answer, exact.result if model != "statics" else answer.result)
    (before,) = [row for row in table("runup").rows if row.model == model]
    told = replace(found, time=before.time)
    for key, value in vars(before).items():
        expected = pytest.approx(value, rel=1e-6, nan_ok=True) if isinstance(value, float) else value
        assert getattr(told, key) == expected, key


def test_words_say_what_is_kept() -> None:
    rows = {row[0]: row[1:] for row in words()}
    for k, found in enumerate(kept()):
        for row in found.rows:
            assert rows[row.name][2 * k] == error_words(row, found.best_error)
            assert rows[row.name][2 * k + 1] == time_words(row.time)
    row = ModelRow("kdv", None, 0.1234, 0.2, 0.0105, 2, 0.0)
    assert error_words(row, 1e-3) == "12 %; no answer at 2 of the speeds"
    assert error_words(replace(row, lost=0, error=1e-4), 1e-3) == "below 0.1 %"
    assert error_words(replace(row, lost=0, error=1e-12), 0.0) == "rounding"
    assert (error_words(replace(row, error=math.nan), 0.0), time_words(0.0105)) == ("best", "10.5 ms")


def test_the_front_page_shows_the_table_and_the_figure() -> None:
    page = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    assert "```{models-table}" in page and "(images/models.png)" in page


def test_the_table_of_the_page_is_the_one_that_is_kept() -> None:
    """Cell by cell, as Sphinx gets it: with the extra `docs` alone."""
    pytest.importorskip("sphinx")
    sys.path.insert(0, str(ROOT / "docs" / "_ext"))
    try:
        spec: Any = importlib.util.spec_from_file_location("pages", ROOT / "docs" / "_ext" / "pages.py")
        pages = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(pages)
    finally:
        sys.path.pop(0)
    (drawn,) = pages.ModelsTable.run(None)
    shown = [entry.astext() for entry in drawn.findall(pages.nodes.entry)]
    assert shown[5:] == [cell for row in words() for cell in row]


def test_the_figure_tells_its_numbers() -> None:
    figure = models_figure()
    assert figure.alt == alternative(kept()) and "kdv on runup 45 %" in figure.alt
    names = {text.get_text() for text in figure.axes[0].texts}
    assert {"kdv", "fem", "linear"} <= names
