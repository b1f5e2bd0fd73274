"""How wide the figures of a report may be for it to stay on one sheet of paper."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from leblanc.report.page import About
from leblanc.report.parts import Picture, Table

# Millimetres on paper, as the style sheet sets them. The heights are what Letter and A4 leave.
HEIGHTS = 257.0, 275.0
TITLE, HEADING, LINE, SMALL, ROW, CAPTION, GAP = 6.4, 6.6, 3.4, 3.15, 3.85, 3.0, 2.0
NARROW, WIDE, STEP = 72.0, 88.0, 0.5  # width of a figure, two in a row
ACROSS, ACROSS_SMALL, ENTRY, REASON = (
    135,
    145,
    45,
    90,
)  # characters in a line: of the page, a column, a reason


def figure_width(what: About, parts: Mapping[str, Any]) -> float:
    """Width of the figures that keeps a report of `run` on one sheet, mm.

    On a sheet of Letter if it can be, else on one of A4; the widest where it takes two.

    Parameters
    ----------
    what : the report is about
    parts : of its page
    """
    text = text_height(what, parts)
    for height in HEIGHTS:
        width = WIDE
        while width >= NARROW:
            if text + results_height(parts, width) <= height:
                return width
            width -= STEP
    return WIDE


def results_height(parts: Mapping[str, Any], width: float) -> float:
    """Height of the tables beside the first figure and of the others two in a row below, mm.

    Parameters
    ----------
    parts : of the page
    width : of a figure, mm
    """
    first, *others = parts["pictures"] or [None]
    characters = 0.7 * (184.0 - 6.0 - width)
    tables = sum(_table_height(parts[name], characters) for name in ("comparisons", "facts", "checks"))
    beside = max(tables, _row_height([first], width) if first else 0.0)
    rows = sum(_row_height(others[k : k + 2], width) for k in range(0, len(others), 2))
    return HEADING + beside + rows


def _row_height(row: list[Picture], width: float) -> float:
    """Figures beside one another with their captions."""
    captions = max(_lines(f"Figure 1. {one.title}. {one.caption}", 0.79 * width) for one in row)
    return max(one.ratio for one in row) * width + CAPTION * captions + GAP


def _table_height(one: Table, characters: float) -> float:
    """A table whose lines hold so many characters."""
    rows = [sum(len(cell.text) + 9 * cell.warning + 2 for cell in row) for row in one.rows]
    return ROW * (sum(max(1, math.ceil(count / characters)) for count in rows) + bool(one.head)) + 1.0


def _lines(text: str, characters: float = ACROSS) -> int:
    return math.ceil(len(text) / characters)


def text_height(what: About, parts: Mapping[str, Any]) -> float:
    """Height of all but the results, mm.

    Parameters
    ----------
    what : the report is about
    parts : of its page
    """
    inputs = what.inputs
    head = TITLE * _lines(what.name, 75) + LINE * _lines(parts["title"] + parts["machine"] + what.source)
    entries = sum(
        _lines(entry.label + ", ".join(f"{cell.text}  " for cell in entry.cells), ENTRY)
        for entry in inputs.entries
    )
    tables = sum(ROW * (len(one.rows) + 1) + 1.0 for one in inputs.tables)
    unused = "; ".join(f"{entry.label} {cell.text}  " for entry in inputs.unused for cell in entry.cells)
    assumed = _lines(", ".join(what.elsewhere) + " " * 50, ACROSS_SMALL) if inputs.assumed else 0
    small = SMALL * (_lines(unused, ACROSS_SMALL) + assumed)
    said = HEADING + LINE * math.ceil(entries / 3) + tables + small
    reasons = ROW + sum(SMALL * _lines(row[-1].text, REASON) + 0.5 for row in parts["why"].rows)
    words = sum(SMALL * _lines(name + text, ACROSS_SMALL) + 0.5 for name, text in parts["models"])
    remarks = sum(SMALL * _lines(text, ACROSS_SMALL - 6) for text in parts["remarks"])
    return head + said + 2.0 * HEADING + reasons + words + remarks + SMALL * 3.0 + GAP
