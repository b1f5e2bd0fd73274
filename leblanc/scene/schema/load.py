"""Reads a scene file or a study file as TOML; the messages of what can be wrong with it."""

from __future__ import annotations

import difflib
import json
import re
import tomllib
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

from leblanc.core.files import native
from meshes.files.foreign import open_regular

_LONGEST = 60  # characters of a value that are shown
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


@dataclass(frozen=True)
class SceneFault:
    """One thing that is wrong with a scene."""

    file: str  #: name of the file
    field: str  #: path of the field, as in "chambers.0.volume"; empty if the file as a whole is wrong
    value: str | None  #: the value as it is shown to the user; None if there is none
    allowed: str  #: what the value must be, in words that follow "must be"
    line: int | None = None  #: of the field in the file, counted from 1; None where it is not known

    def __str__(self) -> str:
        line = "" if self.line is None else f":{self.line}"
        where = escaped(self.file) + line + (f": {self.field}" if self.field else "")
        given = "" if self.value is None else f" = {self.value}"
        return f"{where}{given}: must be {escaped(self.allowed)}"


class SceneError(ValueError):
    """All that is wrong with one scene.

    Parameters
    ----------
    faults : each with its file, field, value and what is allowed; at least one

    Examples
    --------
    >>> import leblanc as lb
    >>> try:
    ...     lb.example("horizontal_rig").replace({"rotor.mas": 1.0})
    ... except lb.SceneError as error:
    ...     print([fault.field for fault in error.faults])
    ['rotor.mas']
    """

    def __init__(self, faults: Sequence[SceneFault]) -> None:
        super().__init__("\n".join(map(str, faults)))
        self.faults = tuple(faults)

    def __reduce__(self) -> tuple[type[SceneError], tuple[tuple[SceneFault, ...]]]:
        """Comes whole out of another process."""
        return type(self), (self.faults,)


def field_path(keys: Sequence[str | int]) -> str:
    """Path of a field from its keys, as in "chambers.0.volume"."""
    return ".".join(
        str(key) if isinstance(key, int) or _BARE_KEY.fullmatch(key) else shown(key) for key in keys
    )


def shown(value: object) -> str:
    """A value of a scene on one short line, much as it stands in the file."""
    if isinstance(value, bool):
        text = "true" if value else "false"
    elif isinstance(value, int) and value.bit_length() > 128:
        text = f"a whole number of {value.bit_length()} bits"  # Python refuses to write very long ones
    elif isinstance(value, str):
        text = json.dumps(value[: _LONGEST + 1], ensure_ascii=False)
    elif isinstance(value, dict):
        text = "{...}" if value else "{}"
    elif isinstance(value, list | tuple):
        text = "[...]" if value else "[]"
    else:
        text = str(value)
    text = escaped(text)
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def meant(given: object, names: Iterable[str]) -> str:
    """What a misspelled word may have meant, to follow what is allowed; empty where no name is near."""
    if not isinstance(given, str):
        return ""
    found = difflib.get_close_matches(given.lower()[:_LONGEST], list(names), n=1)
    return f"; did you mean {found[0]}?" if found and found[0] != given else ""


def escaped(text: str) -> str:
    """The text with line breaks and other invisible characters written as escapes."""
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode() for letter in text
    )


MAX_BYTES = 10_000_000

# The time and memory of a dotted key grow with the square of its parts; a scene needs four.
_DEEPEST = 30
_DEEP = re.compile(
    r"""(?m)(?:^|[\[{,])[ \t]*+(?:(?>[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*+\.[ \t]*+){%d}""" % _DEEPEST  # noqa: UP031
)

_LONGEST_LINE = 60  # characters of a line that are shown
_LINE = re.compile(r"line (\d+)")
# Slips of the pen, each excluding the others, and the remedy.
_SLIPS = (
    (re.compile(r"=\s*[+-]?\d+,\d"), "the decimal sign is a point"),
    (re.compile(r"=\s*[+-]?[\d.]+\s*[A-Za-z%]"), 'a number with a unit stands in quotes, as "10 ml"'),
    (re.compile(r"=\s*(?!true|false|nan|inf)[A-Za-z]"), "a text stands in quotes"),
)


def _fault(path: str | PathLike[str], allowed: str) -> SceneError:
    return SceneError([SceneFault(str(path), "", None, allowed)])


def read_text(path: str | PathLike[str]) -> str:
    """Text of a file of at most `MAX_BYTES`; else a `SceneError`."""
    fault = partial(_fault, path)
    try:
        with open_regular(path) as stream:
            content = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise fault(f"a file that can be read: {error.strerror or error}") from error
    except ValueError as error:  # a null character in the path
        raise fault(f"the path of a file: {error}") from error
    if len(content) > MAX_BYTES:
        raise fault(f"at most {MAX_BYTES // 1_000_000} MB long")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise fault(f"UTF-8 text: byte {error.start + 1}, at line {line}, is not") from error


def toml_of(text: str, path: str | PathLike[str]) -> dict[str, Any]:
    """Tables of a text in TOML, that of a file; else a `SceneError`."""
    fault = partial(_fault, path)
    try:
        deep = _DEEP.search(text)
        found = {} if deep else tomllib.loads(text)
    except RecursionError as error:
        raise fault("TOML with less deeply nested lists and tables") from error
    except tomllib.TOMLDecodeError as error:
        raise fault(f"valid TOML: {_toml_fault(text, str(error))}") from error
    except ValueError as error:
        raise fault("valid TOML without numbers of thousands of digits") from error
    if deep:
        line = text.count("\n", 0, deep.start()) + 1
        raise fault(f"TOML whose keys have at most {_DEEPEST} parts; one at line {line} has more")
    return found


def read_toml(path: str | PathLike[str]) -> dict[str, Any]:
    """Tables of a TOML file; else a `SceneError`."""
    return toml_of(read_text(path), path)


@contextmanager
def with_lines(path: str | PathLike[str]) -> Iterator[None]:
    """Add to faults of a file that are raised inside the lines at which they stand."""
    try:
        yield
    except SceneError as error:
        root = _places(path)
        raise SceneError(
            [
                replace(fault, line=line_of(root, fault.field))
                if fault.file == str(path) and fault.line is None and fault.field
                else fault
                for fault in error.faults
            ]
        ) from error.__cause__


def given_at(path: str | PathLike[str], field: str) -> tuple[bool, Any, int | None]:
    """Whether a file gives a field such as "chambers.0.volume", its value, and its line.

    The line of what it is missing from where it is not given.
    """
    stands = True
    value: Any = read_toml(path)
    for key in field.split("."):
        if isinstance(value, dict) and key in value:
            value = value[key]
        elif isinstance(value, list) and key.isdecimal() and int(key) < len(value):
            value = value[int(key)]
        else:
            value, stands = None, False
            break
    return stands, value, line_of(_places(path), field)


def _places(path: str | PathLike[str]) -> Place:
    """Places of the keys of a file; none where it can no longer be read."""
    try:
        return places(Path(path).read_bytes()[:MAX_BYTES].decode("utf-8-sig"))
    except (OSError, ValueError, AssertionError, IndexError, RecursionError):
        return Place(0)  # it has changed since it was read


def _toml_fault(text: str, said: str) -> str:
    """What is no TOML, with the line and what may have been meant."""
    lines = text.splitlines() or [""]
    said = said.replace("at end of document", f"at line {len(lines)}, the end of the file")
    place = _LINE.search(said)
    line = lines[min(int(place[1]), len(lines)) - 1].partition(" #")[0].strip() if place else ""
    hints = (hint for pattern, hint in _SLIPS if pattern.search(line))
    return "; ".join((f"{said}: {line[:_LONGEST_LINE]}" if line else said, *hints))


def scene_table(text: str, path: str | PathLike[str]) -> dict[str, Any]:
    """Content of a scene file; the files that it names are looked for beside it."""
    table = toml_of(text, path)
    chambers = table.get("chambers")
    for chamber in chambers if isinstance(chambers, list) else ():
        if isinstance(chamber, dict) and isinstance(chamber.get("section"), str) and chamber["section"]:
            chamber["section"] = str(Path(path).parent / native(chamber["section"]))
    return table


_SPACE = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")  # comments too
_BLANK = re.compile(r"[ \t]*")
_KEY = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'|[A-Za-z0-9_-]+')
_DOT = re.compile(r"[ \t]*\.[ \t]*")
# A text of several lines may end with quotes of its own before the three that close it.
_TEXT = re.compile(
    r'"""(?:[^\\]|\\.)*?"""(?:"{0,2})|\'\'\'.*?\'\'\'(?:\'{0,2})|"(?:[^"\\\n]|\\.)*"|\'[^\'\n]*\'', re.DOTALL
)
_OTHER = re.compile(r"[^,\]}#\n]*")  # numbers, dates, truth values
_STEP = re.compile(r'"(?:[^"\\]|\\.)*"|[^.]+')  # of the path of a field


@dataclass
class Place:
    """Where a key stands, and the keys below it."""

    line: int  #: counted from 1; 0 for the file
    #: by key; entries of a list by their numbers as text
    below: dict[str, Place] = field(default_factory=dict)
    entries: bool = False  #: a list of tables, of which the last one is being read

    def at(self, key: str, line: int) -> Place:
        """The place of a key below, made where it is new."""
        return self.below.setdefault(key, Place(line))


def places(text: str) -> Place:
    """Places of all keys of a text that is valid TOML."""
    return _Scanner(text).scan()


def line_of(root: Place, path: str) -> int | None:
    r"""Line of a field such as "chambers.0.volume", or of what is next above it and stands in the file.

    None for the file as a whole.

    >>> line_of(places("name = 'x'\n[[chambers]]\nvolume = 1"), "chambers.0.volume")
    3
    """
    place = root
    for step in _STEP.findall(path):
        key = json.loads(step) if step.startswith('"') else step
        if key not in place.below:
            break
        place = place.below[key]
    return place.line or None


class _Scanner:
    """A walk through a text; `here` is where it has come to."""

    def __init__(self, text: str) -> None:
        self.text, self.here = text, 0
        self.ends = [found.start() for found in re.finditer("\n", text)]
        self.root = Place(0)

    def scan(self) -> Place:
        """Header by header, key by key."""
        table = self.root
        while self._skip(_SPACE) and self.here < len(self.text):
            if self.text[self.here] == "[":
                table = self._header()
            else:
                self._pair(table)
        return self.root

    def _line(self) -> int:
        return bisect_left(self.ends, self.here) + 1

    def _skip(self, pattern: re.Pattern[str]) -> str | bool:
        """Go past what matches; the text of it, True where it is empty."""
        found = pattern.match(self.text, self.here)
        assert found is not None
        self.here = found.end()
        return found[0] or True

    def _header(self) -> Place:
        """[table] or [[table of a list]]."""
        line, brackets = self._line(), 2 if self.text.startswith("[[", self.here) else 1
        self.here += brackets
        *above, last = self._keys()
        self.here = self.text.index("]", self.here) + brackets
        table = self.root
        for key in above:
            table = _newest(table.at(key, line))
        table = table.at(last, line)
        if brackets == 2:
            table.entries = True
            return table.at(str(len(table.below)), line)
        return _newest(table)

    def _keys(self) -> list[str]:
        """Keys with points between them."""
        found = []
        while True:
            self._skip(_BLANK)
            found.append(_plain(str(self._skip(_KEY))))
            point = _DOT.match(self.text, self.here)
            if point is None:
                return found
            self.here = point.end()

    def _pair(self, table: Place) -> None:
        """A key and its value."""
        line = self._line()
        for key in self._keys():
            table = table.at(key, line)
        self.here = self.text.index("=", self.here) + 1
        self._skip(_BLANK)
        self._value(table)

    def _value(self, place: Place) -> None:
        opening = self.text[self.here]
        if opening in "[{":
            self.here += 1
            self._several(place, "]" if opening == "[" else "}")
        else:
            self._skip(_TEXT if opening in "\"'" else _OTHER)

    def _several(self, place: Place, closing: str) -> None:
        """Entries of a list, or pairs of a table, to its end."""
        while self._skip(_SPACE) and self.text[self.here] != closing:
            if closing == "]":
                self._value(place.at(str(len(place.below)), self._line()))
            else:
                self._pair(place)
            self._skip(_SPACE)
            self.here += self.text[self.here] == ","
        self.here += 1


def _newest(place: Place) -> Place:
    """The table that headers below it count from."""
    return place.below[str(len(place.below) - 1)] if place.entries else place


def _plain(key: str) -> str:
    """A key without its quotes."""
    if key[0] == '"':
        return next(iter(tomllib.loads(f"{key} = 0")))
    return key.strip("'") if key[0] == "'" else key
