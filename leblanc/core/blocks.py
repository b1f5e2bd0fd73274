"""What an answer shows, in the order of reading; renderers make text or HTML of it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Literal

Shown = Literal["both", "page", "text"]  # on a report's page, on a terminal, or on both


class Grade(IntEnum):
    """How much a check of the answer matters; a warning touches the headline."""

    NOTHING = 0
    NOTE = 1
    CAUTION = 2
    WARNING = 3


@dataclass(frozen=True)
class Cell:
    """One value in words."""

    text: str  #: with its unit
    assumed: bool = False  #: no source gives it
    warning: bool = False  #: a reader must not overlook it
    path: str = ""  #: in the scene; empty for a result


@dataclass(frozen=True)
class Headline:
    """The answer in one sentence, what it is about, how far it is off."""

    text: str
    about: str = ""  #: the machine and its speeds
    error: str = ""  #: the one error of the answer, with its parts
    shown: Shown = "page"


@dataclass(frozen=True)
class Words:
    """A paragraph; as code what can be pasted."""

    text: str
    name: str = ""  #: that begins it
    code: bool = False
    small: bool = False
    shown: Shown = "both"


@dataclass(frozen=True)
class Table:
    """Rows of texts; without a head they are labels and values."""

    rows: Sequence[Sequence[str | Cell]]
    head: Sequence[str] = ()
    right: bool = False  #: on a terminal all columns but the first are aligned to the right
    title: str = ""
    indent: int = 0  #: on a terminal; 2 below a title
    sentences: bool = False  #: cells are sentences, not numbers
    shown: Shown = "both"


@dataclass(frozen=True)
class Check:
    """One check of the answer: what is checked, which speeds fail it."""

    label: str
    where: str
    grade: Grade = Grade.NOTHING


def check(label: str, where: str, failed: object) -> Check:
    """A check that is a warning where it fails."""
    return Check(label, where, Grade.WARNING if failed else Grade.NOTHING)


@dataclass(frozen=True)
class Checks:
    """Where the answer is not what it seems."""

    rows: Sequence[Check]
    title: str = "Limits of the answer"
    head: str = "at"  #: of the second column
    shown: Shown = "both"


@dataclass(frozen=True)
class Picture:
    """A figure, drawn where it is shown."""

    name: str  #: of its files
    title: str
    draw: str  #: "module:function" of the answer
    alone: bool = False  #: a file only, on no page
    shown: Shown = "page"


@dataclass(frozen=True)
class Notes:
    """Notes to a result, a sentence each."""

    texts: Sequence[str]
    title: str = "Notes"
    shown: Shown = "both"


@dataclass(frozen=True)
class Columns:
    """Blocks side by side where there is room."""

    left: Sequence[Block]
    right: Sequence[Block]
    wide: bool = False  #: the left one has pictures
    shown: Shown = "both"


@dataclass(frozen=True)
class Section:
    """Blocks below a heading; what stands before the first section belongs to the results."""

    title: str
    blocks: Sequence[Block]
    width: str = ""  #: of its pictures, as in "120mm"; empty: that of the page
    screen: bool = False  #: left out where the page is printed on paper
    shown: Shown = "both"


Block = Headline | Words | Table | Checks | Picture | Notes | Columns | Section


def flat(blocks: Iterable[Block], on: Shown) -> Iterator[Block]:
    """Blocks that are shown on a page or on a terminal, those of sections and columns in their order."""
    for block in blocks:
        if block.shown not in ("both", on):
            continue
        if isinstance(block, Section):
            yield from flat(block.blocks, on)
        elif isinstance(block, Columns):
            yield from flat((*block.left, *block.right), on)
        else:
            yield block
