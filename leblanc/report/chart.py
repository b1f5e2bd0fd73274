"""The report of `map` of a rotor with balls: where they are stable, the figure, curves, limits."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from leblanc.core.blocks import Cell
from leblanc.core.page import About, picture, render
from leblanc.core.units import RPM, number
from leblanc.report.page import notes
from leblanc.report.parts import doubt, table
from leblanc.results.races.chart import BallChart
from leblanc.text.races.chart import HEAD, STATES, answer, curves, facts, limits, what

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles

MODEL = (
    "Small motions of the rotor with all its coordinates and of the balls in their races about the state, in "
    "the frame that turns with the drum: roots at every point of a grid, and the curves on which a root "
    "stands on the imaginary axis, followed by their arc length."
)


def write_chart_report(result: BallChart, about: About, figure: FigureFiles, path: Path) -> None:
    """Write the report."""
    rows = [(limit.label, Cell(limit.where, warning=bool(limit.grade))) for limit in limits(result)]
    checks = table("", ("Limits of the answer", ""), rows)
    low, high = (number(float(result.speed[k]) * RPM) for k in (0, -1))
    parts = {
        "title": "Stability of balls in their races",
        "machine": f"Stability of {STATES[result.state]} from {low} to {high} rpm over {what(result)}.",
        "answer": answer(result),
        "doubt": doubt(checks),
        "facts": table("", (), facts(result)),
        "checks": checks,
        "curves": table("", HEAD, curves(result)),
        "pictures": [picture(figure)],
        "models": [("balls", MODEL)],
        "remarks": notes(result.notes),
    }
    render("chart", about, parts, path, "leblanc.report")
