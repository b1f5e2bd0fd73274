"""What reports are made of: cells, tables, pictures with their captions as text, and what a scene says."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from leblanc.core.notes import one_line
from leblanc.results.machine.loads import MachineLoads
from leblanc.scene.inputs import inputs_of
from leblanc.scene.rows import Value
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import Optimisation
from leblanc.text.machine import load_rows, verdict

if TYPE_CHECKING:
    from leblanc.figures.drawing.page import FigureFiles


LIGHT = 300_000  # bytes up to which a drawing is kept as lines; beyond it the smaller of the two files
TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


@dataclass(frozen=True)
class Cell:
    """One value as printed."""

    text: str  #: the value with its unit
    assumed: bool = False  #: no source gives it
    warning: bool = False  #: a reader must not overlook it
    path: str = ""  #: in the scene; empty for a result


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


def load_part(loads: MachineLoads | None) -> Table | None:
    """What a machine is judged by, as one table; None where the scene asks for nothing."""
    if loads is None:
        return None
    time = ("after (s)",) if loads.in_time else ()
    rows = [
        (
            # A number keeps its unit beside it.
            *(row.label, Cell(row.size.replace(" ", "\N{NO-BREAK SPACE}"), warning=row.failed), row.speed),
            *((row.time,) if time else ()),
            row.remark,
        )
        for row in load_rows(loads)
    ]
    return table(verdict(loads), ("Machine", "worst", "at (rpm)", *time, ""), rows)


_CLAUSES = 2  # of the sentence of doubt
# What weighs most in it first; what none of these begins follows.
_WEIGHTS = (
    "Not converged",
    "Not settled",
    "Stopped before its end",
    "Amplitude infinite",
    "Constraints exceeded",
    "Answer unstable",
    "A small whirl grows when operating",
    "Growth not known",
    "Stability not known",
    "Liquid model out of range",
    "Model out of range",
    "Error above",
    "Limit cycle",
    "Self-excited whirl",
)


def _weight(label: str) -> int:
    """Rank of a check in the sentence of doubt, the lowest first."""
    ranks = (rank for rank, start in enumerate(_WEIGHTS) if label.startswith(start))
    return next(ranks, len(_WEIGHTS))


def doubt(checks: Table, holds: str = "") -> str:
    """What must not be relied on in an answer, in one sentence of two clauses; the rest is in the table.

    `holds` is said of an answer that passes all checks, after that.
    """
    failed = [(label.text, found.text) for label, found in checks.rows if found.warning]
    failed.sort(key=lambda row: _weight(row[0]))  # of one weight in their order
    if failed:
        told = "; ".join(f"{label[:1].lower()}{label[1:]}: {where}" for label, where in failed[:_CLAUSES])
        rest = len(failed) - _CLAUSES
        return f"Doubtful: {told}{f' ({rest} more under the limits)' if rest > 0 else ''}."
    return f"No limit of the models is passed{f'; {holds}' if holds else ''}."


@dataclass(frozen=True)
class Picture:
    """A figure as a page shows it."""

    title: str  #: below it
    caption: str
    alt: str  #: what it shows, for who cannot see it
    address: str  #: that holds the whole picture
    #: width and height of what is shown, the drawn caption cut off; None if not known
    shape: tuple[float, float] | None


def picture(files: FigureFiles, alt: str = "") -> Picture:
    """A figure on disk as a page shows it, with its caption and alternative text (its own if empty)."""
    lightest = min((files.svg, files.png), key=lambda file: file.stat().st_size)
    chosen = files.svg if files.svg.stat().st_size <= LIGHT else lightest
    content = base64.b64encode(chosen.read_bytes()).decode("ascii")
    text = one_line(files.caption.shown.removeprefix(f"{files.title}."))
    address = f"data:{TYPES[chosen.suffix]};base64,{content}"
    return Picture(files.title, text, alt or files.alt or files.title, address, files.drawn)


@dataclass(frozen=True)
class Entry:
    """One or a few values under one label."""

    label: str
    cells: tuple[Cell, ...]


@dataclass(frozen=True)
class Inputs:
    """What a scene says."""

    entries: tuple[Entry, ...]  #: single values
    tables: tuple[Table, ...]  #: of what there may be several of: chambers, supports, springs
    unused: tuple[Entry, ...] = ()  #: single values that the report's numbers do not depend on

    @property
    def cells(self) -> list[Cell]:
        """All values."""
        single = [cell for entry in (*self.entries, *self.unused) for cell in entry.cells]
        return single + [cell for part in self.tables for row in part.rows for cell in row]

    @property
    def assumed(self) -> bool:
        """Some value is marked."""
        return any(cell.assumed for cell in self.cells)


def scene_inputs(scene: Scene, optimise: Optimisation | None = None, unused: tuple[str, ...] = ()) -> Inputs:
    """Everything that a scene says.

    `optimise` stands in place of the scene's; numbers of the report do not depend on the tables `unused`.
    """
    found = inputs_of(scene, optimise)
    entries = [Entry(row.label, tuple(map(_cell, row.values))) for row in found.rows]
    tables = [
        Table("", part.head, tuple(tuple(map(_cell, row)) for row in part.rows)) for part in found.tables
    ]
    aside = [entry for entry in entries if entry.cells[0].path.partition(".")[0] in unused]
    return Inputs(tuple(entry for entry in entries if entry not in aside), tuple(tables), tuple(aside))


def _cell(value: Value) -> Cell:
    return Cell(one_line(value.text), value.assumed, path=value.path)
