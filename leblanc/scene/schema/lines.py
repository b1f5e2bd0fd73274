"""Lines of a TOML file at which its keys stand, which `tomllib` does not tell.

A scanner of what TOML looks like, for files that `tomllib` has read without a fault: it checks nothing.
"""

from __future__ import annotations

import json
import re
import tomllib
from bisect import bisect_left
from dataclasses import dataclass, field

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
