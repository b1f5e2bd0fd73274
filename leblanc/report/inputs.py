"""What a scene says, laid out for the pages of reports."""

from __future__ import annotations

from dataclasses import dataclass

from leblanc.report.parts import Cell, Table
from leblanc.results.base import one_line
from leblanc.scene.inputs import inputs_of
from leblanc.scene.optimise import Optimisation
from leblanc.scene.rows import Value
from leblanc.scene.scene import Scene


@dataclass(frozen=True)
class Entry:
    """One or a few values under one label."""

    label: str
    cells: tuple[Cell, ...]


@dataclass(frozen=True)
class Inputs:
    """What a scene says.

    Parameters
    ----------
    entries : single values
    tables : of what there may be several of: chambers, supports, springs
    unused : single values that the report's numbers do not depend on
    """

    entries: tuple[Entry, ...]
    tables: tuple[Table, ...]
    unused: tuple[Entry, ...] = ()

    @property
    def cells(self) -> list[Cell]:
        """All values."""
        single = [cell for entry in (*self.entries, *self.unused) for cell in entry.cells]
        return single + [cell for one in self.tables for row in one.rows for cell in row]

    @property
    def assumed(self) -> bool:
        """Some value is marked."""
        return any(cell.assumed for cell in self.cells)


def scene_inputs(scene: Scene, optimise: Optimisation | None = None, unused: tuple[str, ...] = ()) -> Inputs:
    """Everything that a scene says.

    Parameters
    ----------
    scene : the scene
    optimise : what the liquid is chosen for, in place of the scene's
    unused : tables of the scene that the report's numbers do not depend on
    """
    found = inputs_of(scene, optimise)
    entries = [Entry(row.label, tuple(map(_cell, row.values))) for row in found.rows]
    tables = [Table("", one.head, tuple(tuple(map(_cell, row)) for row in one.rows)) for one in found.tables]
    aside = [one for one in entries if one.cells[0].path.partition(".")[0] in unused]
    return Inputs(tuple(one for one in entries if one not in aside), tuple(tables), tuple(aside))


def _cell(value: Value) -> Cell:
    return Cell(one_line(value.text), value.assumed, path=value.path)
