"""Every liquid model on two example scenes: its error against its time, kept for the front page of the docs.

`python -m tests.models` measures again; `kept` reads what it left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from validation.study import stored

KEPT = Path(__file__).parent / "results.json"


@dataclass(frozen=True)
class ModelRow:
    """One model on one scene."""

    model: str  #: its name in a scene
    cells: int | None  #: round each wall, of waves held in time; None elsewhere
    #: largest relative distance from the best answer over the speeds, of the amplitude and the offset of the
    #: liquid's centre of mass the larger; nan of the best answer itself
    error: float
    estimate: float  #: largest error that the model tells of itself; nan where it has none
    time: float  #: processor time of the whole answer over the number of speeds, s
    lost: int  #: speeds at which it has no answer
    in_range: float  #: part of the speeds

    @property
    def name(self) -> str:
        """Model and resolution."""
        return self.model if self.cells is None else f"{self.model}, {self.cells} cells"


@dataclass(frozen=True)
class ModelTable:
    """All models on one scene."""

    scene: str  #: stem of the example
    about: str  #: the speeds and what the best answer is, in words
    speeds: int  #: how many
    best_error: float  #: own error of the best answer
    rows: tuple[ModelRow, ...]  #: the models


kept, keep = stored(KEPT, tuple[ModelTable, ...])


def error_words(row: ModelRow, best: float) -> str:
    """Error as a table shows it; below the own error of the best answer nothing can be told."""
    if math.isnan(row.error):
        return "best"
    size = "rounding" if row.error < 1e-9 else f"{100.0 * row.error:.2g} %"
    if 1e-9 <= row.error < best:
        size = f"below {100.0 * best:.2g} %"
    return f"{size}; no answer at {row.lost} of the speeds" if row.lost else size


def time_words(seconds: float) -> str:
    """Time of one speed as a table shows it."""
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.2g} s"


def words() -> list[tuple[str, ...]]:
    """Rows of the table on the page: model, then error and time for each scene."""
    tables = kept()
    names = list(dict.fromkeys(row.name for table in tables for row in table.rows))
    found = []
    for name in names:
        cells = [name]
        for table in tables:
            row = next((row for row in table.rows if row.name == name), None)
            told = ("", "") if row is None else (error_words(row, table.best_error), time_words(row.time))
            cells += told
        found.append(tuple(cells))
    return found
