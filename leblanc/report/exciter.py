"""The report of `run` for an exciter: where its balls stick, how its platform vibrates."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from leblanc.report.page import About, write_page
from leblanc.report.parts import Cell, Table, picture, table
from leblanc.studies.exciter import ExciterRecord
from leblanc.text.models import BALLS
from leblanc.text.numbers import NOT_FOUND, number, ranges
from leblanc.units import MM, RPM

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles

WORDS = {
    "smallness": "Share of the balls in the moving mass, over their rolling inertia",
    "drag": "Drag of the balls",
    "unbalance": "Unbalance of the shaft, over that of the balls",
    "damping": "Damping ratio of the platform",
}


def _rpm(speed: float, missing: str = NOT_FOUND) -> str:
    return f"{number(speed * RPM)} rpm" if math.isfinite(speed) else missing


def facts(record: ExciterRecord) -> list[tuple[str, str]]:
    """Speeds that decide how the table behaves, and its vibration at the last speed: label and value.

    Parameters
    ----------
    record : the answer
    """
    first, through, last = record.characteristic
    none = "none: one stuck speed at every speed"
    three = f"{_rpm(first)} to {_rpm(last)}" if math.isfinite(first) else none
    at = _rpm(float(record.speed[-1]))
    slow = (
        f"{number(float(record.slow[-1]) * MM)} mm"
        if record.dual_frequency[-1]
        else "none: they do not stick"
    )
    return [
        ("Natural frequency of the platform", _rpm(record.machine.natural_frequency)),
        ("Three stuck speeds, shaft from and to", three),
        ("Slowest stuck speed at the resonance, shaft at", _rpm(through, "none")),
        ("Critical speed, up to which the balls stick", _rpm(record.critical, "none")),
        ("The same by the source's regression", _rpm(record.printed_critical, "outside its ranges")),
        (f"Vibration with the balls at {at}", slow),
        (f"Vibration with the shaft at {at}", f"{number(float(record.fast[-1]) * MM)} mm"),
    ]


def numbers(record: ExciterRecord) -> Table:
    """Dimensionless numbers of the machine."""
    rows = [(text, number(getattr(record.numbers, name))) for name, text in WORDS.items()]
    return table("", ("Dimensionless numbers", ""), rows)


def integrations(record: ExciterRecord) -> Table:
    """Time integrations beside the formulas."""
    rows: list[Sequence[str | Cell]] = []
    for one in record.checks:
        stay = Cell("stay" if one.holds else "leave", warning=not one.converged)
        stuck = number(one.stuck_speed * RPM) if one.holds else ""
        both = [number(x * MM) if one.holds and math.isfinite(x) else "" for x in (one.slow, one.fast)]
        rows.append((number(one.speed * RPM), stay, stuck, *both))
    head = ("Shaft (rpm)", "balls", "at (rpm)", "platform with them (mm)", "with the shaft (mm)")
    return table("Integrated in time", head, rows)


def checks(record: ExciterRecord) -> Table:
    """Where the answer is not what it seems."""
    lost = [one.speed for one in record.checks if not one.converged]
    words = ", ".join(_rpm(speed) for speed in lost) or "none"
    beyond = ~record.dual_frequency
    outside = not math.isfinite(record.printed_critical)
    rows = [
        ("Time integration not finite", Cell(words, warning=bool(lost))),
        ("Balls do not stick", Cell(ranges(record.speed, beyond), warning=bool(np.any(beyond)))),
        ("Regression of the source", Cell("outside its ranges" if outside else "inside", warning=outside)),
    ]
    return table("", ("Limits of the answer", "at"), rows)


def alt(record: ExciterRecord) -> str:
    """What the figure shows."""
    told = dict(facts(record))
    return (
        "Curves of the speeds at which the balls can stick together and of the platform's two vibrations "
        f"over the shaft's speed; critical speed: {told['Critical speed, up to which the balls stick']}."
    )


def write_exciter_report(record: ExciterRecord, what: About, figure: FigureFiles, path: Path) -> None:
    """Write the report.

    Parameters
    ----------
    record : the answer
    what : it is about
    figure : of it
    path : the file to write or replace
    """
    low, high = number(float(record.speed[0]) * RPM), number(float(record.speed[-1]) * RPM)
    start = record.start
    machine = (
        f"A platform with {record.machine.ball_count} balls in the track of its shaft, shaken from {low} to "
        f"{high} rpm in {record.speed.size} speeds."
    )
    began = (
        f"The critical speed depends on the start: here {start.kind}, {number(start.separation)} rad apart."
    )
    parts = {
        "title": "Stuck speeds of the balls and vibration of the platform",
        "machine": machine,
        "facts": table("", (), facts(record)),
        "numbers": numbers(record),
        "integrations": integrations(record),
        "checks": checks(record),
        "pictures": [picture(figure, alt(record))],
        "models": [("balls", " ".join(BALLS))],
        "remarks": [began, "The numbers over speed are printed by the same command with --json."],
    }
    write_page("exciter", what, parts, path)
