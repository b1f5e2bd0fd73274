"""What reports are made of: tables of cells, a sentence of doubt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from leblanc.core.blocks import Cell, Check, Grade
from leblanc.core.page import doubt as sentence


@dataclass(frozen=True)
class Table:
    """A table; the first cell of each row is its heading."""

    title: str  #: above it, may be empty
    head: tuple[str, ...]  #: headings of the columns; none for a list of labels and values
    rows: tuple[tuple[Cell, ...], ...]  #: of cells, as many as there are columns
    sentences: bool = False  #: cells are sentences, not numbers


def table(
    title: str, head: Sequence[str], rows: Sequence[Sequence[str | Cell]], sentences: bool = False
) -> Table:
    """Table of texts and cells."""
    cells = tuple(tuple(cell if isinstance(cell, Cell) else Cell(cell) for cell in row) for row in rows)
    return Table(title, tuple(head), cells, sentences)


def doubt(checks: Table, holds: str = "") -> str:
    """What must not be relied on in an answer, in one sentence of two clauses; the rest is in the table.

    `holds` is said of an answer that passes all checks, after that.
    """
    rows = [
        Check(label.text, found.text, Grade.WARNING if found.warning else Grade.NOTHING)
        for label, found in checks.rows
    ]
    said = sentence(rows)
    return said if not holds or any(row.grade for row in rows) else f"{said[:-1]}; {holds}."
