"""Notes: what a result says besides its numbers, as a code, the numbers of the sentence, and the sentence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType


class NoteCode(StrEnum):
    """What a note says; each result has an enumeration of its own."""


@dataclass(frozen=True)
class Note:
    """One thing that a reader of a result must know.

    A program asks for `code` and `data`, a reader reads `text`. A sentence is written in one place: the
    function that makes the note.

    Parameters
    ----------
    code : what is said
    data : the numbers of the sentence, SI
    text : the sentence
    """

    code: NoteCode
    data: Mapping[str, object] = field(hash=False)
    text: str

    def __post_init__(self) -> None:
        object.__setattr__(self, "data", MappingProxyType(dict(self.data)))

    def __str__(self) -> str:
        return self.text

    def __reduce__(self) -> tuple[object, ...]:
        return Note, (self.code, dict(self.data), self.text)


def texts(notes: Iterable[Note]) -> tuple[str, ...]:
    """The sentences of notes, in their order."""
    return tuple(note.text for note in notes)


EXACT = 1e-9  # a relative error that is nothing but rounding


def percent(value: float) -> str:
    """A share in per cent, two digits; in words where it is the whole or nothing."""
    if value >= 0.995:
        return "about 100 % or more"
    return "rounding" if value < EXACT else f"{100.0 * value:.2g} %"
