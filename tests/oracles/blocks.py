"""What an answer shows: a table by its head, its checks that fail, its text on a terminal; or no pictures."""

from __future__ import annotations

import io
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from leblanc.core import disk
from leblanc.core.answer import Answer
from leblanc.core.blocks import Cell, Checks, Picture, Table, flat
from leblanc.core.terminal import show
from leblanc.plotting.page import Figure


def table(answer: Answer, *head: str) -> Table:
    """The one table whose head begins so."""
    tables = [block for block in flat(answer.blocks(), "page") if isinstance(block, Table)]
    (found,) = (one for one in tables if all(map(str.startswith, one.head[: len(head)], head)) and one.head)
    return found


def labels(answer: Answer) -> dict[str, str]:
    """Texts by label, of all tables without a head."""
    tables = (block for block in flat(answer.blocks(), "page") if isinstance(block, Table) and not block.head)
    return {cell_text(row[0]): cell_text(row[1]) for one in tables for row in one.rows}


def failed(answer: Answer) -> dict[str, str]:
    """Where each check fails, by its label."""
    checks = (block for block in flat(answer.blocks(), "page") if isinstance(block, Checks))
    return {one.label: one.where for block in checks for one in block.rows if one.grade}


def cell_text(cell: str | Cell) -> str:
    """Of a cell."""
    return cell if isinstance(cell, str) else cell.text


def on_terminal(answer: Answer) -> str:
    """All that is printed."""
    printed = io.StringIO()
    with redirect_stdout(printed):
        show(answer.blocks())
    return printed.getvalue()


def nothing(_: Answer) -> Figure:
    """A picture of nothing, which takes no time."""
    figure = Figure(figsize=(1.0, 1.0))
    figure.alt = "A picture of nothing."
    return figure


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands write pictures of nothing, where what they say and which files they write is asked."""
    draw = disk.drawing

    def drawing(answer: Answer, picture: Picture, folder: Path, png: bool = False) -> Any:
        return draw(answer, replace(picture, draw=f"{__name__}:{nothing.__name__}"), folder, png)

    monkeypatch.setattr(disk, "drawing", drawing)
