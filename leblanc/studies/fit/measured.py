"""Tables of measured values, as loggers and spreadsheets write them, in SI and zero to peak."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import MappingProxyType

import numpy as np

from leblanc.core import units
from leblanc.core.notes import Note
from leblanc.core.units import Dimension
from leblanc.studies.fit.notes import FitCode
from meshes.arrays import Array
from meshes.errors import InputError

FIELD = "measured"
MOST_ROWS = 100_000
OVER = {"speed": units.ANGULAR_SPEED, "time": units.TIME, "added": units.VOLUME}
QUANTITIES = {
    "amplitude": units.LENGTH,
    "peak": units.LENGTH,
    "phase": units.ANGLE,
    "liquid_offset": units.LENGTH,
    "liquid_angle": units.ANGLE,
}
ANGLES = ("phase", "liquid_angle")
SIZES = ("amplitude", "peak", "liquid_offset")  # never below 0
TURNS = {"alpha", "beta", "gamma"}
# Other words for a column; all others need --column.
_WORDS = {
    "displacement": "amplitude",
    "velocity": "amplitude",
    "acceleration": "amplitude",
    "vibration": "amplitude",
    "rotational speed": "speed",
    "spin speed": "speed",
    "rotor speed": "speed",
}
# Largest values that a measurement can have, SI; no machine comes near them.
_LARGEST = {"speed": 1e6, "time": 1e9, "added": 1e6}
_LARGEST_LENGTH, _LARGEST_ANGLE = 1e4, 1e4

_PEAKS = r"(?:zero[\s-]*to[\s-]*)?peak|0\s*-\s*(?:pk|p)|(?:0|zero)\s*to\s*peak|pk"
# How a value was taken from an oscillation: pattern, its factor to zero to peak, what it is called.
_TAKEN = (
    (r"peak[\s-]*to[\s-]*peak|pk[\s-]*(?:to[\s-]*)?pk|p[\s-]*p|double[\s-]*amplitude", 0.5, "peak to peak"),
    (r"rms|r\.m\.s\.|eff|root[\s-]*mean[\s-]*square", math.sqrt(2.0), "root mean square"),
    (_PEAKS, 1.0, "zero to peak"),
)
_EXTRA_ACCELERATIONS = {"g": 9.80665, "g0": 9.80665, "gn": 9.80665, "mg": 9.80665e-3}  # standard gravity
_BRACKETS = re.compile(r"(.*?)\s*(?:\[([^\[\]]*)\]|\(([^()]*)\)|\{([^{}]*)\})\s*")
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+", re.ASCII)
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)


@dataclass(frozen=True)
class Measurement:
    """What was measured on a machine."""

    over: str  #: "speed", "time", or "added" for liquid added to the first chamber
    at: Array  #: rad/s, s or m^3, rising, shape (n,)
    columns: tuple[tuple[str, Array], ...]  #: name and values of each quantity, SI, shape (n,)
    notes: tuple[Note, ...] = ()  #: what was converted


@dataclass(frozen=True)
class _Column:
    """What one column of the table holds."""

    name: str  #: of the quantity
    factor: float  #: SI and zero to peak, of one unit of the file
    order: int  #: time derivatives: 0 displacement, 1 velocity, 2 acceleration
    text: str  #: of the conversion; empty where there was none


def read_measured(
    path: str | PathLike[str],
    coordinates: Sequence[str],
    free: bool = False,
    column: Mapping[str, str] = MappingProxyType({}),
) -> Measurement:
    """Table of measured values: a header of names with units, then numbers; faults name the line.

    Between columns stand commas, semicolons or tabs; decimal commas are read where no comma stands between
    columns. Amplitudes become displacements, zero to peak. With `free` units are any; `column` has headers by
    the quantities that they stand for, what is neither named there nor known is then left out.
    """
    rows, delimiter = _rows(path, _text(path))
    if not rows:
        raise InputError(FIELD, str(path), "a table: a header, then rows of numbers")
    (line, head), body = rows[0], rows[1:]
    if body and len(head) == 2 * len(body[0][1]):  # a comma before the unit where commas are between columns
        head = [", ".join(head[k : k + 2]) for k in range(0, len(head), 2)]
    if body and _is_units(body[0][1]):
        units_row = [*body[0][1], *[""] * len(head)]
        head = [f"{name} [{unit}]" if unit else name for name, unit in zip(head, units_row, strict=False)]
        body = body[1:]
    if len(body) < 2 or len(body) > MOST_ROWS:
        raise InputError(
            FIELD, f"{len(body) + 1} rows", f"a header and from 2 to {MOST_ROWS} rows of numbers"
        )
    place = f"{path}:{line}"
    known = OVER | QUANTITIES | {c: units.ANGLE if c in TURNS else units.LENGTH for c in coordinates}
    taken = _columns(head, known, free, column, place)
    names = [each.name for each in taken.values()]
    over = [name for name in names if name in OVER]
    if len(over) != 1 or len(names) < 2:
        allowed = "speed, time or added, one of them, and what was measured over it"
        raise InputError(place, ", ".join(head), allowed)
    comma = _decimal_comma(path, body, list(taken), delimiter)
    values = np.array([_numbers(row, taken, len(head), comma, f"{path}:{k}") for k, row in body])
    at = values[:, names.index(over[0])]
    _check(values, names, [k for k, _ in body], path)
    columns, notes = {}, []
    for k, each in enumerate(taken.values()):
        if each.name in OVER:
            continue
        if each.order and over[0] != "speed":
            allowed = f"a displacement over {over[0]}: only over speed is the frequency of each row known"
            raise InputError(place, head[list(taken)[k]], allowed)
        columns[each.name] = values[:, k] / at**each.order if each.order else values[:, k]
        if each.text:
            notes.append(Note(FitCode.CONVERTED, {"column": each.name}, each.text))
    order = np.argsort(at, kind="stable")
    return Measurement(
        over[0], at[order], tuple((name, found[order]) for name, found in columns.items()), tuple(notes)
    )


def named_columns(
    given: Mapping[str, str] | Sequence[str] | None, field: str = "column"
) -> Mapping[str, str]:
    """Headers by quantities, from texts such as "amplitude=Schwingweg [um pp]" where they are none yet."""
    texts = given.values() if isinstance(given, Mapping) else given
    listed = texts is None or (isinstance(texts, Iterable) and all(isinstance(text, str) for text in texts))
    if not listed or isinstance(given, str):
        raise InputError(field, repr(given), 'headers by quantity, as {"amplitude": "Schwingweg [um pp]"}')
    if given is None or isinstance(given, Mapping):
        return given or {}
    found: dict[str, str] = {}
    for text in given:
        name, sign, header = (part.strip() for part in text.partition("="))
        if not (name and sign and header) or name in found:
            raise InputError(
                field, text, 'one header for each quantity, as in amplitude="Schwingweg [um pp]"'
            )
        found[name] = header
    return found


def _text(path: str | PathLike[str]) -> str:
    """The text of a file: UTF-8, UTF-16 behind its mark, or what Western loggers write."""
    try:
        raw = Path(path).read_bytes()
        if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
            return raw.decode("utf-16")
        try:
            return raw.decode("utf-8-sig")
        except UnicodeDecodeError:
            return raw.decode("cp1252")
    except (OSError, UnicodeDecodeError) as fault:
        raise InputError(FIELD, str(path), f"a table of text that can be read ({fault})") from fault


def _rows(path: str | PathLike[str], text: str) -> tuple[list[tuple[int, list[str]]], str]:
    """Number of the line and cells of each row, without empty lines and comments; the sign between cells."""
    delimiter, found = "", []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if not delimiter:
            if said := re.fullmatch(r'"?sep=([,;\t])"?\s*', line, re.IGNORECASE):
                delimiter = said[1]
                continue
            bare = re.sub(r'"[^"]*"', "", line)
            delimiter = next((sign for sign in "\t;" if sign in bare), ",")
        try:
            # No cell of a table of numbers holds a line break: a quote ends on its line.
            (cells,) = csv.reader([line], delimiter=delimiter, skipinitialspace=True, strict=True)
        except (csv.Error, ValueError) as fault:
            signs = {",": "commas", ";": "semicolons", "\t": "tabs"}[delimiter]
            allowed = f"a row whose quotes are closed, {signs} between its cells"
            raise InputError(f"{path}:{number}", line[:60], allowed) from fault
        cells = [cell.strip() for cell in cells]
        while cells and not cells[-1]:
            cells.pop()
        if cells:
            found.append((number, cells))
    return found, delimiter


def _is_units(row: Sequence[str]) -> bool:
    """A row of units under the names, as some loggers write it."""
    return not any(_NUMBER.match(cell) or re.match(r"[+-]?\d", cell) for cell in row) and all(
        re.fullmatch(r"[\[(]?[A-Za-z°µμ/^\d\s*.%²³-]{0,20}[\])]?", cell) for cell in row
    )


def _columns(
    head: Sequence[str], known: Mapping[str, Dimension], free: bool, asked: Mapping[str, str], place: str
) -> dict[int, _Column]:
    """What each column of a header holds, by its number; columns that are left out are not there."""
    found: dict[int, _Column] = {}
    for name, header in asked.items():
        header = header.strip().strip('"')
        if name not in known:
            raise InputError("column", name, "one of " + ", ".join(known))
        k, cell = _asked(head, header, place)
        if k in found:
            raise InputError("column", header, "another header for each quantity")
        found[k] = _column(cell, name, known[name], free, place)
    for k, cell in enumerate(head):
        if k in found:
            continue
        names = [word for word in _names(cell) if word in known]
        if names:
            found[k] = _column(cell, names[0], known[names[0]], free, place)
        elif not asked:
            allowed = "one of " + ", ".join(known) + f', as in speed [rpm]; or --column amplitude="{cell}"'
            raise InputError(f"{place}, column {k + 1}", cell, allowed)
    held: dict[str, int] = {}
    for k, each in found.items():
        if each.name in held:
            both = f"{head[held[each.name]]}, {head[k]}"
            allowed = f"one column of {each.name}, or --column to say which is meant"
            raise InputError(place, both, allowed)
        held[each.name] = k
    return dict(sorted(found.items()))


def _squeezed(text: str) -> str:
    return " ".join(text.split()).casefold()


def _asked(head: Sequence[str], header: str, place: str) -> tuple[int, str]:
    """Number and header of a column that was asked for; a unit may stand in either."""
    name, unit = _parts(header)
    for wanted, cells in ((header, head), (name, [_parts(cell)[0] for cell in head])):
        alike = [k for k, cell in enumerate(cells) if _squeezed(cell) == _squeezed(wanted)]
        if len(alike) > 1:
            raise InputError(place, header, f"one column of the file; {len(alike)} are headed so")
        if alike:
            cell = head[alike[0]]
            own = _parts(cell)[1]
            if unit and own and _squeezed(unit) != _squeezed(own):
                raise InputError(place, header, f"in the unit of the file, {cell}")
            return alike[0], header if unit or not own else cell
    raise InputError("column", header, "one of the headers of the file: " + "; ".join(head))


def _parts(cell: str) -> tuple[str, str]:
    """Name and unit of a header: in brackets, after a comma, after "in" or a slash."""
    if match := _BRACKETS.fullmatch(cell):
        return match[1], next(part for part in match.groups()[1:] if part is not None).strip()
    for sign in (r"\s*,\s*", r"\s+in\s+", r"\s+/\s+"):
        parts = re.split(sign, cell, maxsplit=1)
        if len(parts) == 2 and parts[0].strip() and parts[1].strip():
            return parts[0].strip(), parts[1].strip()
    return cell.strip(), ""


def _taken(text: str) -> tuple[str, float, str]:
    """A text without the words for how an oscillation was taken, their factor and name."""
    for pattern, factor, words in _TAKEN:
        bare, count = re.subn(
            rf"(?<![A-Za-z0-9])(?:{pattern})(?![A-Za-z0-9])", " ", text, flags=re.IGNORECASE
        )
        if count:
            return bare.strip(" \t,;-_"), factor, words
    return text.strip(), 1.0, ""


def _names(cell: str) -> Iterator[str]:
    """What the name of a header may mean; "peak" alone is a quantity."""
    name = _parts(cell)[0].strip()
    yield name
    yield name.lower().replace(" ", "_")
    bare = " ".join(_taken(name)[0].lower().split())
    yield bare.replace(" ", "_")
    yield _WORDS.get(bare, bare)


def _column(cell: str, name: str, dimension: Dimension, free: bool, place: str) -> _Column:
    """Factor and conversion of one column."""
    words, unit = _parts(cell)
    unit, factor, taken = _taken(unit)
    if not taken and name != "peak":
        _, factor, taken = _taken(words)
    if name not in SIZES:
        if taken:
            raise InputError(place, cell, f"a plain value of {name}, not {taken}")
        if free and name not in (*OVER, *ANGLES):
            return _Column(name, 1.0, 0, "")
        return _Column(name, _size(unit, dimension, place, cell), 0, "")
    order, size = 0, None
    if name == "amplitude":
        order, size = _motion(unit, words)
    if free and not order:
        return _Column(name, 1.0, 0, "")
    if size is None:
        size = _size(unit, dimension, place, cell)
    text = _conversion(cell, name, order, taken)
    return _Column(name, size * factor, order, text)


def _conversion(cell: str, name: str, order: int, taken: str) -> str:
    """What was made of a column that is no displacement zero to peak; empty of one that is."""
    if not order and taken in ("", "zero to peak"):
        return ""
    kind = ("displacement", "velocity", "acceleration")[order]
    by = ("", ", divided by the speed of its row", ", divided by the square of the speed of its row")[order]
    how = taken or "taken as zero to peak"
    factor = {"peak to peak": ", halved", "root mean square": ", times the root of 2"}.get(taken, "")
    return f'"{cell}" is a {kind}, {how}: converted to {name}, a displacement zero to peak{factor}{by}.'


def _motion(unit: str, words: str) -> tuple[int, float | None]:
    """Time derivatives that a unit has, and its SI value; None where it is that of neither motion."""
    if unit in _EXTRA_ACCELERATIONS and (unit != "mg" or "acc" in words.lower()):
        return 2, _EXTRA_ACCELERATIONS[unit]
    for order, dimension in enumerate((units.LENGTH, units.VELOCITY, units.ACCELERATION)):
        try:
            return order, units.parse(f"1 {unit}" if unit else 1.0, dimension, "unit")
        except InputError:
            continue
    return 0, None


def _size(unit: str, dimension: Dimension, place: str, cell: str) -> float:
    """SI value of a unit; a plain number is SI."""
    try:
        return units.parse(f"1 {unit}" if unit else 1.0, dimension, place)
    except InputError as fault:
        raise InputError(place, cell, fault.allowed) from fault


def _decimal_comma(
    path: str | PathLike[str], body: Sequence[tuple[int, Sequence[str]]], used: Sequence[int], delimiter: str
) -> bool:
    """Whether commas are the decimal signs of a table; refused where both signs are, or thousands may be."""
    comma = point = None
    decimal = delimiter != ","
    for line, row in body:
        for cell in (row[k] for k in used if k < len(row)):
            if "," in cell and cell.rfind(",") > cell.rfind("."):
                comma = comma or (line, cell)
                decimal |= not _THOUSANDS.fullmatch(cell)
            elif "." in cell:
                point = point or (line, cell)
    if comma and point:
        later = max(comma, point)
        raise InputError(f"{path}:{later[0]}", later[1], "a number with the decimal sign of the other rows")
    if comma and not decimal:
        raise InputError(f"{path}:{comma[0]}", comma[1], "a number without a sign between its thousands")
    return comma is not None


def _numbers(
    row: Sequence[str], taken: Mapping[int, _Column], count: int, comma: bool, place: str
) -> list[float]:
    """Values of the columns that are used, SI and zero to peak, but for the division by the speed."""
    if len(row) != count:
        extra = "; decimal commas need semicolons or tabs between the columns" if len(row) > count else ""
        raise InputError(
            place, ", ".join(row)[:60], f"{count} finite numbers, as the header has columns{extra}"
        )
    found = []
    for k, column in taken.items():
        cell = row[k].replace(".", "").replace(",", ".") if comma else row[k].replace(",", "")
        cell = cell.replace("\N{MINUS SIGN}", "-").replace("\N{NO-BREAK SPACE}", "")
        value = float(cell) if _NUMBER.fullmatch(cell) else math.nan
        if not math.isfinite(value * column.factor):
            raise InputError(place, row[k][:60], f"one of {count} finite numbers")
        found.append(value * column.factor)
    return found


def _check(values: Array, names: Sequence[str], lines: Sequence[int], path: str | PathLike[str]) -> None:
    """No value that nothing measured can have."""
    for k, name in enumerate(names):
        column = values[:, k]
        least = 0.0 if name in (*SIZES, *OVER) else -math.inf
        most = _LARGEST.get(name, _LARGEST_ANGLE if name in ANGLES or name in TURNS else _LARGEST_LENGTH)
        low = column <= least if name == "speed" else column < least
        bad = np.flatnonzero(low | (np.abs(column) > most))
        if bad.size:
            value = float(column[bad[0]])
            bound = "above 0" if name == "speed" else "of at least 0"
            allowed = f"{name} {bound}" if low[bad[0]] else f"{name} of at most {most:g} in SI units"
            raise InputError(f"{path}:{lines[bad[0]]}", value, allowed)
