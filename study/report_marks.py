"""Values of a scene as reports list them, those marked that no source gives."""

from __future__ import annotations

from dataclasses import dataclass

from study.record import MM, RPM, one_line
from study.report_parts import Cell
from study.words import number

Row = tuple[Cell, ...]


@dataclass(frozen=True)
class Entry:
    """One or a few values under one label."""

    label: str
    cells: Row


class Marker:
    """Makes cells and marks those whose value no source gives.

    Parameters
    ----------
    assumed : paths in the scene, of values or of whole tables
    """

    def __init__(self, assumed: tuple[str, ...]) -> None:
        self.assumed = assumed

    def cell(self, text: str, path: str, *derived_from: str) -> Cell:
        """A value at a path; one that is derived is as doubtful as what it comes from."""
        paths = path, *derived_from
        marked = any(
            own == one or own.startswith(f"{one}.") or one.startswith(f"{own}.")
            for own in paths
            for one in self.assumed
        )
        return Cell(one_line(text), marked, path=path)

    def entry(self, label: str, text: str, path: str, *derived_from: str) -> Entry:
        """The only value under a label."""
        return Entry(label, (self.cell(text, path, *derived_from),))


def rpm(speed: float) -> str:
    """A speed in both units."""
    return f"{number(speed * RPM)} rpm ({number(speed)} rad/s)"


def mm(length: float) -> str:
    """A length."""
    return f"{number(length * MM)} mm"


def unbalance(size: float) -> str:
    """Mass times its distance from the axis."""
    return f"{number(size * 1e6)} g mm"
