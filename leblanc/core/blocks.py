"""What an answer shows, in the order of reading; renderers make text or HTML of it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Words:
    """A paragraph."""

    text: str


@dataclass(frozen=True)
class Table:
    """Rows of texts."""

    rows: tuple[tuple[str, ...], ...]
    head: tuple[str, ...] = ()  #: of the columns; none for labels and values
    right: bool = False  #: all columns but the first are aligned to the right
    title: str = ""


@dataclass(frozen=True)
class Picture:
    """A figure that is drawn when it is shown."""

    name: str  #: of its file
    draw: str  #: as "module:function" of the answer


Block = Words | Table | Picture
