"""The report of `run`: the answer, where it holds, figures, models and why."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from leblanc.report.page import About, models, notes, why, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.results.notes.run import OF_MODELS
from leblanc.results.response import RunResult
from leblanc.text.numbers import ranges
from leblanc.text.run import answer, comparisons, facts, limits, machine, remarks

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles

SHOWN = 4  # figures, of which the phase stands in its own file only; with more, all


def checks(result: RunResult) -> Table:
    """Where the answer is not what it seems, as a table."""
    rows = [(limit.label, Cell(limit.where, warning=limit.failed)) for limit in limits(result)]
    return table("", ("Limits of the answer", "at"), rows)


def write_run_report(result: RunResult, what: About, figures: Sequence[FigureFiles], path: Path) -> None:
    """Write the report: one page for a simple machine.

    Parameters
    ----------
    result : the response
    what : it is about
    figures : in the order of the page
    path : the file to write or replace
    """
    shown = [one for one in figures if len(figures) > SHOWN or one.name != "phase"]
    elsewhere = OF_MODELS if result.models else ()
    parts = {
        "title": "Response to the unbalance over speed",
        "machine": machine(result),
        "answer": answer(result),
        "comparisons": table(
            "",
            ("", "with liquid", "without", "ratio"),
            [(one.label, one.wet, one.dry, one.ratio) for one in comparisons(result)],
        ),
        "facts": table("", (), facts(result)),
        "checks": checks(result),
        "pictures": [picture(one) for one in shown],
        "why": why(result.models) if result.models else _used(result),
        "models": models(result.models_used),
        "remarks": [*notes(result.notes, elsewhere), *remarks(result)],
    }
    write_page("run", what, parts, path)


def _used(result: RunResult) -> Table:
    """The models and their speeds, where no reasons are known."""
    rows = [(name, ranges(result.speed, result.model == name)) for name in result.models_used]
    return table("", ("Model", "Speeds"), rows, True)
