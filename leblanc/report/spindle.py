"""The report of `run` of a spindle unit: natural frequencies, compliances, where the answer holds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from leblanc.core.units import number
from leblanc.report.page import About, write_page
from leblanc.report.parts import Cell, doubt, picture, table
from leblanc.results.spindles.unit import SpindleResult
from leblanc.text.spindles.unit import HEAD, answer, cage_rows, compliance_rows, limits, remarks

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles


def write_spindle_report(
    result: SpindleResult, what: About, figures: Sequence[FigureFiles], path: Path
) -> None:
    """Write the report.

    Parameters
    ----------
    result : the answer
    what : it is about
    figures : of it
    path : the file to write or replace
    """
    checks = table(
        "",
        ("Limits of the answer", ""),
        [(limit.label, Cell(limit.where, warning=limit.failed)) for limit in limits(result)],
    )
    low, high = (number(float(result.frequency[k]) / (2.0 * math.pi)) for k in (0, -1))
    parts = {
        "title": "Dynamic compliance of a spindle unit",
        "machine": f"A spindle unit of {len(result.beams)} beams with {len(result.stations)} stations, "
        f"driven by a unit force from {low} to {high} Hz at {result.frequency.size} frequencies.",
        "answer": answer(result),
        "doubt": doubt(checks),
        "compliances": table(
            "At the ends of the band and at the natural frequencies", HEAD, compliance_rows(result)
        ),
        "cages": table("At the speed at which the spindle turns", (), cage_rows(result)),
        "checks": checks,
        "pictures": [picture(figure) for figure in figures],
        "remarks": remarks(result),
    }
    write_page("spindle", what, parts, path)
