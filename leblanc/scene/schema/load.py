"""Reads a scene file or a study file as TOML."""

from __future__ import annotations

import re
import tomllib
from os import PathLike
from pathlib import Path
from typing import Any

from leblanc.scene.schema.faults import SceneFault, SceneFaults

MAX_BYTES = 10_000_000

_LONGEST_LINE = 60  # characters of a line that are shown
_LINE = re.compile(r"line (\d+)")
# Slips of the pen, each excluding the others, and the remedy.
_SLIPS = (
    (re.compile(r"=\s*[+-]?\d+,\d"), "the decimal sign is a point"),
    (re.compile(r"=\s*[+-]?[\d.]+\s*[A-Za-z%]"), 'a number with a unit stands in quotes, as "10 ml"'),
    (re.compile(r"=\s*(?!true|false|nan|inf)[A-Za-z]"), "a text stands in quotes"),
)


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
