"""Tables of the answers over one grid each, as CSV files or as sheets of a workbook."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.core.answer import Answer
from leblanc.core.files import writing
from leblanc.core.netcdf import NamedArrays, Variable
from leblanc.scene.scene import Scene
from leblanc.studies.run import run
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.runup import runup
from leblanc.studies.runup.answer import RunupAnswer
from meshes.errors import InputError

Cell = str | float  # whole numbers among the latter
_GRIDS = ("speed", "time")  # what most is over, before any other dimension
# The same once more: all speeds of the curve are among the speeds.
_AGAIN = ("refined_speed", "curve_speed")
_SHEET = 31  # letters of its name
_ROWS = 1_048_576  # of a sheet at most
_PAIR = ("amplitude", "amplitude_dry")


@dataclass(frozen=True)
class Column:
    """One quantity over the grid of its table."""

    name: str
    unit: str  #: as CF writes it; empty for a number or a text
    values: Sequence[Cell]  #: nan where there is none

    @property
    def head(self) -> str:
        """Its name with its unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class Table:
    """Columns over one grid."""

    name: str  #: of its file or sheet
    text: str  #: what it holds
    columns: tuple[Column, ...]

    def column(self, name: str) -> int | None:
        """Place of a column by its name."""
        return next((k for k, each in enumerate(self.columns) if each.name == name), None)


def tables(scene: Scene) -> tuple[Table, ...]:
    """All of what `run` and, with a run-up or programme, `run_up` answer."""
    response = run(scene)
    if isinstance(response, RunAnswer) and response.refined is not None:
        # Once more at the speeds among which the peaks are: every quantity has the one grid.
        response = run(scene, speeds=response.curve.speed.tolist())
    found = list(_of_answer(response, "response", "response"))
    if scene.speed_plan is not None:
        passed = runup(scene)
        found += _of_answer(passed, "runup", "run-up")
    return tuple(found)


def _of_answer(answer: Answer, name: str, what: str) -> Iterator[Table]:
    """Tables of an answer: that over its grid first, then its single values and what else it has."""
    arrays = answer.named_arrays()
    every = {**arrays.coords, **arrays.variables}
    grid = next((dim for dim in _GRIDS if dim in arrays.sizes), "")
    kept: dict[str, list[Column]] = {grid: []} if grid else {}
    for key, one in every.items():
        if one.dims and one.dims[0] in _AGAIN:
            continue  # among the others
        if len(one.dims) in (1, 2):
            over = grid if grid in one.dims else one.dims[0]
            kept.setdefault(over, []).extend(_columns(key, one, over))
    if isinstance(answer, RunupAnswer):
        kept[grid] += _between(answer)
    for over, columns in kept.items():
        # The grid, then what most look for.
        first = sorted(columns, key=lambda column: (column.name != over, column.name not in _PAIR))
        text = f"{what} over {over.replace('_', ' ')}"
        if len(first) > 1:
            yield Table(name if over == grid else f"{name}_{over}", text, tuple(first))
    single = {key: one for key, one in every.items() if not one.dims}
    if single:
        yield _values(f"{name}_values", f"{what}, single values", single)


def _between(answer: RunupAnswer) -> list[Column]:
    """The largest amplitude since the time before: the peak lies between two times of the grid."""
    history, name = answer.history, "largest_amplitude"
    return [
        Column(name, "m", history.largest.tolist()),
        Column(f"{name}_speed", "rad s-1", history.largest_speed.tolist()),
        Column(f"{name}_time", "s", history.largest_time.tolist()),
    ]


def _columns(name: str, one: Variable, over: str) -> Iterator[Column]:
    """A variable as columns, one for each place along its other dimension."""
    unit = one.attrs.get("units", "1")
    unit = "" if unit == "1" else unit
    if len(one.dims) == 1:
        yield Column(name, unit, one.values.tolist())
        return
    other = one.dims[1 - one.dims.index(over)]
    for k, values in enumerate(one.values if one.dims[1] == over else one.values.T):
        yield Column(f"{name} {other.replace('_', ' ')} {k + 1}", unit, values.tolist())


def _values(name: str, text: str, single: dict[str, Variable]) -> Table:
    """Single values, a row each."""
    units = [str(one.attrs.get("units", "1")) for one in single.values()]
    values = [one.values.item() for one in single.values()]
    columns = ("name", list(single)), ("value", values), ("unit", units)
    return Table(name, text, tuple(Column(head, "", column) for head, column in columns))


def sample_tables(arrays: NamedArrays) -> tuple[Table, ...]:
    """Samples of a sweep, a row each, and their curves, a row for each sample and speed."""
    every = {**arrays.coords, **arrays.variables}
    alone = {name: one for name, one in every.items() if one.dims == ("sample",)}
    # What varies first: its names are paths.
    names = sorted(alone, key=lambda name: ("." not in name, list(alone).index(name)))
    count = next(iter(alone.values())).values.shape[0]
    number = Column("sample", "", list(range(count)))
    found = [Table("samples", "samples", (number, *(_column(name, alone[name]) for name in names)))]
    curves = {name: one for name, one in every.items() if one.dims == ("sample", "speed")}
    if curves:
        over = next(iter(curves.values())).values.shape[1]
        rows = Column("sample", "", [k for k in range(count) for _ in range(over)])
        if "speed" in every and every["speed"].dims == ("speed",):
            each = every["speed"]
            repeated = Variable(("sample", "speed"), np.tile(each.values, (count, 1)), each.attrs)
            curves = {"speed": repeated} | curves
        columns = [_column(name, one) for name, one in curves.items()]
        first = sorted(columns, key=lambda column: column.name != "speed")
        found.append(Table("curves", "curves over speed", (rows, *first)))
    return tuple(found)


def _column(name: str, one: Variable) -> Column:
    unit = one.attrs.get("units", "1")
    return Column(name, "" if unit == "1" else unit, one.values.ravel().tolist())


def write_samples(arrays: NamedArrays, folder: Path, to: str, decimal: str) -> None:
    """Tables of a sweep's samples as CSV files or as a workbook.

    Parameters
    ----------
    folder : where they go
    to : csv or xlsx
    decimal : point or comma, of CSV
    """
    if to not in ("csv", "xlsx"):
        raise InputError("to", to, "csv or xlsx")
    if decimal not in ("point", "comma") or (to == "xlsx" and decimal != "point"):
        raise InputError("decimal", decimal, "point, or comma for csv")
    found = sample_tables(arrays)
    if to == "csv":
        write_csv(found, folder, decimal)
        return
    most = max(len(table.columns[0].values) for table in found)
    if most >= _ROWS:
        raise InputError("to", to, f"csv: a sheet has {_ROWS} rows, these tables {most + 1}")
    write_xlsx(found, folder / "sweep.xlsx")


def write_csv(found: Sequence[Table], folder: Path, decimal: str) -> None:
    """A file a table; numbers with all their digits, nothing where there is none."""
    comma = decimal == "comma"
    for table in found:
        with (
            writing(folder / f"{table.name}.csv") as part,
            part.open("w", newline="", encoding="utf-8") as file,
        ):
            lines = csv.writer(file, delimiter=";" if comma else ",", lineterminator="\n")
            lines.writerow([column.head for column in table.columns])
            for row in zip(*(column.values for column in table.columns), strict=True):
                lines.writerow([_text(cell, comma) for cell in row])


def _text(cell: Cell, comma: bool) -> str:
    if isinstance(cell, float):
        number = repr(cell) if math.isfinite(cell) else "" if math.isnan(cell) else f"{cell}"
        return number.replace(".", ",") if comma else number
    return str(cell)


class _Exact(float):
    """A number that a workbook has with all its digits, of which XlsxWriter writes sixteen."""

    def __format__(self, form: str) -> str:
        return repr(float(self))


def write_xlsx(found: Sequence[Table], path: Path) -> None:
    """A workbook with a sheet a table, and a chart of the amplitude with and without liquid."""
    xlsxwriter = extra("xlsxwriter", "xlsx")
    with writing(path) as part, xlsxwriter.Workbook(part) as book:
        bold = book.add_format({"bold": True, "text_wrap": True, "valign": "top"})
        names = {}
        for table in found:
            names[table.name] = table.name[:_SHEET]
            sheet = book.add_worksheet(names[table.name])
            sheet.freeze_panes(1, 1)
            sheet.set_column(0, len(table.columns) - 1, 14)
            for k, column in enumerate(table.columns):
                sheet.write_string(0, k, column.head, bold)
                for row, cell in enumerate(column.values, 1):
                    if isinstance(cell, str):
                        sheet.write_string(row, k, cell)
                    elif isinstance(cell, int):
                        sheet.write_number(row, k, cell)
                    elif math.isfinite(cell):
                        sheet.write_number(row, k, _Exact(cell))
        drawn = next(
            (
                table
                for table in found
                if table.columns[0].name in _GRIDS and table.column(_PAIR[0]) is not None
            ),
            None,
        )
        if drawn is not None:
            _chart(book, drawn, names[drawn.name])


def _chart(book: Any, table: Table, sheet: str) -> None:
    """Amplitude over the grid of a table, on a sheet of its own."""
    chart = book.add_chart({"type": "scatter", "subtype": "straight"})
    rows = len(table.columns[0].values)
    for name, label in zip(_PAIR, ("with liquid", "without liquid"), strict=True):
        place = table.column(name)
        if place is not None:
            axes = {"categories": [sheet, 1, 0, rows, 0], "values": [sheet, 1, place, rows, place]}
            chart.add_series({"name": label, **axes})
    chart.set_x_axis({"name": table.columns[0].head})
    chart.set_y_axis({"name": "amplitude [m]"})
    chart.set_title({"name": "Amplitude of the deflection"})
    book.add_chartsheet("amplitude").set_chart(chart)


def extra(module: str, to: str) -> Any:
    """A module of the extra `export`; an `InputError` names it where it is missing."""
    try:
        return import_module(module)
    except ImportError as missing:
        allowed = f"asked for once the extra is installed: pip install leblanc[export] ({missing})"
        raise InputError("to", to, allowed) from missing
