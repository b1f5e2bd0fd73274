"""Notes: what a reader of an answer must know, as a sentence and as numbers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType


class NoteCode(StrEnum):
    """What a note says; each answer has an enumeration of its own."""


@dataclass(frozen=True)
class Note:
    """One thing that a reader of an answer must know.

    A program uses `code` and `data`, a reader reads `text`. A sentence is written in one place: the
    function that makes the note.
    """

    code: NoteCode  #: kind of the sentence
    data: Mapping[str, object] = field(hash=False)  #: the numbers of the sentence, SI
    text: str  #: the sentence

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", MappingProxyType(dict(self.data)))

    def __str__(self) -> str:
        return self.text

    def __reduce__(self) -> tuple[object, ...]:
        return Note, (self.code, dict(self.data), self.text)


def texts(notes: Iterable[Note]) -> tuple[str, ...]:
    """Sentences of notes, in their order."""
    return tuple(note.text for note in notes)


EXACT = 1e-9  # a relative error that is nothing but rounding
WHOLE = 0.995  # a relative error that is said to be the whole or more


def percent(value: float) -> str:
    """A share in per cent, two digits; a text where it is the whole or nothing."""
    if value >= WHOLE:
        return "about 100 % or more"
    return "rounding" if value < EXACT else f"{100.0 * value:.2g} %"


def one_line(text: str) -> str:
    """Text without line breaks and control characters, which files and figures cannot carry."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def assumed_words(paths: Iterable[str]) -> str:
    """How many values of a machine no source gives, for a caption; a report lists them."""
    count = len(tuple(paths))
    return f"{count} of its values" if count else "nothing"
