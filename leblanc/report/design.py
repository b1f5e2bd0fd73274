"""The report of `optimise` where balls are chosen: the best of them, what they keep to, what was tried."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from leblanc.core.blocks import Cell
from leblanc.core.notes import texts
from leblanc.core.page import About, picture, render
from leblanc.report.parts import Table, doubt, table
from leblanc.results.races.design import BallDesignResult
from leblanc.text.races.design import RACE_HEAD, answer, constraint_rows, facts, limits, paste, race_rows

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles

_MODEL = (
    "Balls that roll or slide in races on a rotor with all its coordinates: states in which they rest in the "
    "drum, and the roots of small motions about each. The state taken is the worst of the stable ones."
)
_SEARCH = (
    "Designs are searched by differential evolution over whole numbers of balls and real sizes, then closer."
)


def races(result: BallDesignResult) -> Table:
    """The races with the best balls, and with those of the scene."""
    rows = [(f"{number} best", *rest) for number, *rest in race_rows(result)]
    rows += [(f"{number} scene", *rest) for number, *rest in race_rows(result, before=True)]
    return table("", RACE_HEAD, rows)


def constraints(result: BallDesignResult) -> Table:
    """What the balls must keep to."""
    rows = [
        (what, value, limit, Cell(verdict.lower(), warning=verdict != "kept"))
        for what, value, limit, verdict in constraint_rows(result)
    ]
    return table("", ("Constraint", "value", "at most", "verdict"), rows)


def write_design_report(result: BallDesignResult, what: About, figure: FigureFiles, path: Path) -> None:
    """Write the report."""
    rows = [(one.label, Cell(one.where, warning=bool(one.grade))) for one in limits(result)]
    checks = table("", ("Limits of the answer", "at"), rows)
    parts = {
        "title": "Best balls",
        "machine": f"Objective {result.objective}: the {result.meaning}.",
        "answer": answer(result),
        "doubt": doubt(checks),
        "races": races(result),
        "facts": table("", (), facts(result)),
        "constraints": constraints(result),
        "checks": checks,
        "paste": paste(result),
        "pictures": [picture(figure)],
        "models": [("balls", _MODEL)],
        "reason": _SEARCH,
        "remarks": list(texts(result.notes)),
    }
    render("design", what, parts, path, "leblanc.report")
