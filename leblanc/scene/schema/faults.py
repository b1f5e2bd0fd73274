"""What can be wrong with a scene, in words, and what can go wrong in a study."""

from __future__ import annotations

import difflib
import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

_LONGEST = 60  # characters of a value that are shown
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


@dataclass(frozen=True)
class SceneFault:
    """One thing that is wrong with a scene.

    Parameters
    ----------
    file : name of the file
    field : path of the field, as in "chambers.0.volume"; empty if the file as a whole is wrong
    value : the value as it is shown to the user; None if there is none
    allowed : what the value must be, in words that follow "must be"
    """

    file: str
    field: str
    value: str | None
    allowed: str

    def __str__(self) -> str:
        where = escaped(self.file) + (f": {self.field}" if self.field else "")
        given = "" if self.value is None else f" = {self.value}"
        return f"{where}{given}: must be {escaped(self.allowed)}"


class SceneFaults(ValueError):  # noqa: N818 - the faults of one scene, all of them
    """All that is wrong with one scene.

    Parameters
    ----------
    faults : each with its file, field, value and what is allowed; at least one
    """

    def __init__(self, faults: Sequence[SceneFault]) -> None:
        super().__init__("\n".join(map(str, faults)))
        self.faults = tuple(faults)


class NotConverged(RuntimeError):  # noqa: N818 - it names a state, not a mistake
    """A solver did not converge everywhere; what did is kept.

    Parameters
    ----------
    failed : what did not converge, one line each
    """

    def __init__(self, failed: Sequence[str]) -> None:
        super().__init__("\n".join(failed))
        self.failed = tuple(failed)


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


def meant(given: object, words: Iterable[str]) -> str:
    """What a misspelled word may have meant, to follow what is allowed; empty where nothing is near.

    Parameters
    ----------
    given : what was written
    words : what may be written
    """
    if not isinstance(given, str):
        return ""
    found = difflib.get_close_matches(given.lower()[:_LONGEST], list(words), n=1)
    return f"; did you mean {found[0]}?" if found and found[0] != given else ""


def escaped(text: str) -> str:
    """The text with line breaks and other invisible characters written as escapes."""
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode() for letter in text
    )
