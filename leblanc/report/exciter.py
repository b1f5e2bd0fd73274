"""The report of `run` for an exciter: where its balls stick, how its platform vibrates."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.report.page import About, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.results.exciter import ExciterResult
from leblanc.text.exciter import NUMBERS, answer, facts
from leblanc.text.models import BALLS
from leblanc.text.numbers import number, ranges
from leblanc.units import MM, RPM

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles


def numbers(result: ExciterResult) -> Table:
    """Dimensionless numbers of the machine."""
    rows = [(text, number(getattr(result.numbers, name))) for name, text in NUMBERS.items()]
    return table("", ("Dimensionless numbers", ""), rows)


def integrations(result: ExciterResult) -> Table:
    """Time integrations beside the formulas."""
    rows: list[Sequence[str | Cell]] = []
    for one in result.checks:
        stay = Cell("stay" if one.holds else "leave", warning=not one.converged)
        stuck = number(one.stuck_speed * RPM) if one.holds else ""
        both = [number(x * MM) if one.holds and math.isfinite(x) else "" for x in (one.slow, one.fast)]
        rows.append((number(one.speed * RPM), stay, stuck, *both))
    head = ("Shaft (rpm)", "balls", "at (rpm)", "platform with them (mm)", "with the shaft (mm)")
    return table("Integrated in time", head, rows)


def checks(result: ExciterResult) -> Table:
    """Where the answer is not what it seems."""
    lost = [one.speed for one in result.checks if not one.converged]
    words = ", ".join(f"{number(speed * RPM)} rpm" for speed in lost) or "none"
    beyond = ~result.dual_frequency
    outside = not math.isfinite(result.printed_critical)
    rows = [
        ("Time integration not finite", Cell(words, warning=bool(lost))),
        ("Balls do not stick", Cell(ranges(result.speed, beyond), warning=bool(np.any(beyond)))),
        ("Regression of the source", Cell("outside its ranges" if outside else "inside", warning=outside)),
    ]
    return table("", ("Limits of the answer", "at"), rows)


def write_exciter_report(result: ExciterResult, what: About, figure: FigureFiles, path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    result : the answer
    what : it is about
    figure : of it
    path : the file to write or replace
    """
    low, high = number(float(result.speed[0]) * RPM), number(float(result.speed[-1]) * RPM)
    start = result.start
    machine = (
        f"A platform with {result.machine.ball_count} balls in the track of its shaft, shaken from {low} to "
        f"{high} rpm in {result.speed.size} speeds."
    )
    began = (
        f"The critical speed depends on the start: here {start.kind}, {number(start.separation)} rad apart."
    )
    parts = {
        "title": "Stuck speeds of the balls and vibration of the platform",
        "machine": machine,
        "answer": answer(result),
        "facts": table("", (), facts(result)),
        "numbers": numbers(result),
        "integrations": integrations(result),
        "checks": checks(result),
        "pictures": [picture(figure)],
        "models": [("balls", " ".join(BALLS))],
        "remarks": [began, "The numbers over speed are printed by the same command with --json."],
    }
    write_page("exciter", what, parts, path)
