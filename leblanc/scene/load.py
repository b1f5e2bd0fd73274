"""Reads a scene file and names everything that is wrong with it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from leblanc.scene.faults import SceneFault, SceneFaults, field_path, shown
from leblanc.scene.rotors import ALTERNATIVES
from leblanc.scene.rules import Refused, Table
from leblanc.scene.tables import SCENES, TABLES, SceneTable
from meshes.errors import InputError

MAX_BYTES = 10_000_000

_LONGEST_LINE = 60  # characters of a line that are shown
_LINE = re.compile(r"line (\d+)")
# Slips of the pen, each excluding the others, and the remedy.
_SLIPS = (
    (re.compile(r"=\s*[+-]?\d+,\d"), "the decimal sign is a point"),
    (re.compile(r"=\s*[+-]?[\d.]+\s*[A-Za-z%]"), 'a number with a unit stands in quotes, as "10 ml"'),
    (re.compile(r"=\s*(?!true|false|nan|inf)[A-Za-z]"), "a text stands in quotes"),
)

_Tables = Mapping[tuple[str, ...], type[Table]]


def read_toml(path: str | PathLike[str]) -> dict[str, Any]:
    """Content of a TOML file.

    Parameters
    ----------
    path : the file; at most `MAX_BYTES` long

    Returns
    -------
    its tables

    Raises
    ------
    SceneFaults : no such file, not readable, not UTF-8, not TOML
    """

    def fault(allowed: str) -> SceneFaults:
        return SceneFaults([SceneFault(str(path), "", None, allowed)])

    try:
        with Path(path).open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise fault(f"a file that can be read: {error.strerror or error}") from error
    except ValueError as error:  # a null character in the path
        raise fault(f"the path of a file: {error}") from error
    if len(content) > MAX_BYTES:
        raise fault(f"at most {MAX_BYTES // 1_000_000} MB long")
    try:
        text = content.decode("utf-8-sig")
        return tomllib.loads(text)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise fault(f"UTF-8 text: byte {error.start + 1}, at line {line}, is not") from error
    except RecursionError as error:
        raise fault("TOML with less deeply nested lists and tables") from error
    except tomllib.TOMLDecodeError as error:
        raise fault(f"valid TOML: {_toml_fault(text, str(error))}") from error
    except ValueError as error:
        raise fault("valid TOML without numbers of thousands of digits") from error


def _toml_fault(text: str, said: str) -> str:
    """What is no TOML, with the line and what may have been meant."""
    lines = text.splitlines() or [""]
    said = said.replace("at end of document", f"at line {len(lines)}, the end of the file")
    place = _LINE.search(said)
    line = lines[min(int(place[1]), len(lines)) - 1].partition(" #")[0].strip() if place else ""
    hints = (hint for pattern, hint in _SLIPS if pattern.search(line))
    return "; ".join((f"{said}: {line[:_LONGEST_LINE]}" if line else said, *hints))


def read_scene(path: str | PathLike[str]) -> dict[str, Any]:
    """Content of a scene file; the files that it names are looked for beside it.

    Parameters
    ----------
    path : the file

    Raises
    ------
    SceneFaults : as `read_toml`
    """
    table = read_toml(path)
    chambers = table.get("chambers")
    for one in chambers if isinstance(chambers, list) else ():
        if isinstance(one, dict) and isinstance(one.get("section"), str) and one["section"]:
            one["section"] = str(Path(path).parent / one["section"])
    return table


def check_table(table: Mapping[str, Any], file: str) -> SceneTable:
    """Every value of a scene checked and in SI units.

    Parameters
    ----------
    table : content of a scene file
    file : its name, for the messages

    Raises
    ------
    SceneFaults : with all that is wrong
    """
    if "vary" in table and "rotor" not in table:
        text = "a scene; this is a study of many scenes, which `leblanc sweep` answers"
        raise SceneFaults([SceneFault(file, "", None, text)])
    faults: list[SceneFault] = []
    checked = None
    kind = _kind(table)
    try:
        checked = SCENES[kind].model_validate(table)
    except ValidationError as error:
        faults.extend(_broken_rules(error, file, (), TABLES[kind], _is_unknown_kind(table)))
    if not _is_unknown_kind(table):
        faults.extend(_alternatives(table, kind, file))
    faults.extend(_walls(table.get("chambers"), TABLES[kind], file))
    faults.extend(_drive(table.get("runup"), TABLES[kind], file))
    faults.extend(_assumed(table, file))
    if checked is None or faults:
        raise SceneFaults(faults)
    return checked


def _kind(table: Mapping[str, Any]) -> str:
    """Kind of the rotor; the simplest where the table does not say, so that the rest can still be judged."""
    rotor = table.get("rotor")
    kind = rotor.get("kind") if isinstance(rotor, Mapping) else None
    return kind if isinstance(kind, str) and kind in SCENES else "jeffcott"


def _is_unknown_kind(table: Mapping[str, Any]) -> bool:
    """The table names a kind of rotor that there is not: which keys it may have is not known then."""
    rotor = table.get("rotor")
    return isinstance(rotor, Mapping) and "kind" in rotor and rotor["kind"] not in tuple(SCENES)


def _broken_rules(
    error: ValidationError,
    file: str,
    place: tuple[str | int, ...],
    tables: _Tables,
    any_rotor: bool = False,
) -> Iterator[SceneFault]:
    """One fault for each broken rule; `any_rotor` leaves out what keys a rotor must and may not have."""
    for item in error.errors(include_url=False):
        keys = (*place, *item["loc"])
        if any_rotor and keys[:1] == ("rotor",) and item["type"] in ("missing", "extra_forbidden"):
            continue
        cause = item.get("ctx", {}).get("error")
        if isinstance(cause, ValidationError):  # of a table within a value
            yield from _broken_rules(cause, file, keys, tables, any_rotor)
            continue
        value = None if item["type"] == "missing" else shown(item["input"])
        yield SceneFault(file, field_path(keys), value, _allowed(item, keys, cause, tables))


def _allowed(item: ErrorDetails, keys: tuple[str | int, ...], cause: object, tables: _Tables) -> str:
    """What the value must be, in words."""
    if isinstance(cause, InputError | Refused):
        return cause.allowed
    pattern = tuple("*" if isinstance(key, int) else key for key in keys)
    if item["type"] == "missing":
        return f"given: {_rule(pattern, tables)}"
    if item["type"] == "extra_forbidden":
        return "left out or spelled as one of: " + ", ".join(tables[pattern[:-1]].model_fields)
    return _rule(pattern, tables)


def _rule(pattern: tuple[str, ...], tables: _Tables) -> str:
    """The rule of a field in words."""
    for rule in tables[pattern[:-1]].model_fields[pattern[-1]].metadata if pattern[-1] != "*" else ():
        if hasattr(rule, "func"):
            return str(rule.func.allowed)
    return "a table of " + ", ".join(tables[pattern].model_fields)


def _alternatives(table: Mapping[str, Any], kind: str, file: str) -> Iterator[SceneFault]:
    """Pairs of keys of which one must be given, and one only."""
    for place, pair in ALTERNATIVES.get(kind, ()):
        found: Any = table
        for key in place:
            found = found.get(key) if isinstance(found, Mapping) else None
        if not isinstance(found, Mapping):
            continue  # a fault by itself
        text, path = f"exactly one of {pair[0]} and {pair[1]}", ".".join(place)
        if not any(key in found for key in pair):
            yield SceneFault(file, f"{path}.{pair[0]}", None, f"given: {text}")
        elif all(key in found for key in pair):
            yield SceneFault(file, f"{path}.{pair[1]}", shown(found[pair[1]]), f"given alone: {text}")


def _walls(chambers: Any, tables: _Tables, file: str) -> Iterator[SceneFault]:
    """Walls of a chamber: circles with a radius, or a section from a file."""
    for k, one in enumerate(chambers if isinstance(chambers, list) else ()):
        if not isinstance(one, Mapping):
            continue
        if "section" not in one:
            if "radius" not in one:
                text = f"given: {_rule(('chambers', '*', 'radius'), tables)}; or chambers.{k}.section"
                yield SceneFault(file, f"chambers.{k}.radius", None, text)
            continue
        for key in ("radius", "inner_radius", "baffles"):
            if key in one:
                text = f"left out where chambers.{k}.section is given"
                yield SceneFault(file, f"chambers.{k}.{key}", shown(one[key]), text)


def _drive(runup: Any, tables: _Tables, file: str) -> Iterator[SceneFault]:
    """The ramp of a run-up, which a motor takes the place of."""
    if not isinstance(runup, Mapping):
        return
    if "motor" not in runup:
        if "rate" not in runup:
            yield SceneFault(file, "runup.rate", None, f"given: {_rule(('runup', 'rate'), tables)}")
        return
    if "rate" in runup:
        yield SceneFault(file, "runup.rate", shown(runup["rate"]), "left out where runup.motor is given")
    if runup.get("back") is True:
        yield SceneFault(file, "runup.back", "true", "false where runup.motor is given")


def _assumed(table: Mapping[str, Any], file: str) -> Iterator[SceneFault]:
    """Assumed values that the scene does not hold."""
    paths = table.get("assumed")
    for number, path in enumerate(paths if isinstance(paths, list) else ()):
        if isinstance(path, str) and path and not _holds(table, path):
            text = 'the path of a value that stands in this file, such as "rotor.mass" or "chambers.0.height"'
            yield SceneFault(file, f"assumed.{number}", shown(path), text)


def _holds(table: object, path: str) -> bool:
    """Whether there is a value at that path."""
    for key in path.split("."):
        if isinstance(table, Mapping) and key in table:
            table = table[key]
        elif isinstance(table, list) and key.isdecimal() and len(key) < 7 and int(key) < len(table):
            table = table[int(key)]
        else:
            return False
    return True
