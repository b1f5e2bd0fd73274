"""What studies and notebooks show: tables and figures."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from html import escape
from typing import Any, get_args

from leblanc.plotting.page import WIDTH, Frame, lay_out, style
from leblanc.plotting.page import Figure as Figure
from leblanc.plotting.page import number as number
from validation.case import Case, Value, Verdict

_DPI, _WIDE = 160, 110  # dots of a file and of the screen to an inch
_PLAIN = 10.0  # relative differences below are told in per cent, larger ones as factors
_PLURAL = {"agrees": "agree", "erratum": "errata", "trend": "trends", "differs": "differ"}

_LEFT = 'style="text-align: left; vertical-align: top"'
_SENTENCE = 40  # characters of a cell that is read, not compared with those above and below
# On a telephone a row of words becomes a card with the names of the columns; numbers scroll in their box.
_CARDS = """<style>@media screen and (max-width: 40em) {
.cards thead { display: none }
.cards, .cards tbody, .cards tr, .cards td { display: block; width: auto }
.cards tr { padding: 0.5em 0; border-bottom: 1px solid #8888 }
.cards td { padding: 0.1em 0.3em; border: 0; white-space: normal }
.cards td + td::before { content: attr(data-name) ": "; font-weight: bold }
}</style>"""
_RAISED = str.maketrans("-0123456789", "\N{SUPERSCRIPT MINUS}⁰¹²³⁴⁵⁶⁷⁸⁹")
_BREAK = re.compile(r"(?<=[/_])(?=\w)")  # where a path or a name may go on in the next line


@dataclass(frozen=True)
class Table:
    """Rows of texts and numbers; Markdown as text, HTML in Jupyter and on a page of Sphinx."""

    header: tuple[str, ...]  #: one word for each column
    rows: tuple[tuple[str, ...], ...]  #: as many cells each
    foot: str = ""  #: a line below, or empty

    def __repr__(self) -> str:
        rows = [self.header, ("---",) * len(self.header), *self.rows]
        lines = [f"| {' | '.join(row)} |" for row in rows]
        return "\n".join([*lines, "", self.foot] if self.foot else lines)

    def _repr_html_(self) -> str:
        """For Jupyter and Sphinx; line breaks in a cell are kept."""
        first, *others = (escape(cell) for cell in self.header)
        # The first column says what a row is about, mostly in the most words.
        head = f'<th {_LEFT[:-1]}; width: 42%">{first}</th>'
        head += "".join(f"<th {_LEFT}>{cell}</th>" for cell in others)
        names = [f'data-name="{escape(name)}"' for name in self.header]
        rows = [
            "".join(f"<td {name} {_LEFT}>{_lines(cell)}</td>" for name, cell in zip(names, row, strict=True))
            for row in self.rows
        ]
        body = "".join(f'<tr style="break-inside: avoid">{row}</tr>' for row in rows)
        foot = f"<p>{escape(self.foot)}</p>" if self.foot else ""
        wordy = any(len(cell) > _SENTENCE for row in self.rows for cell in row)
        kind = f'{_CARDS}<table class="cards"' if wordy else "<table"
        inside = f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody>"
        table = f'{kind} style="table-layout: auto">{inside}</table>'
        return f'<div style="overflow-x: auto">{table}</div>{foot}'


@dataclass(frozen=True)
class Picture:
    """A figure as PNG."""

    png: bytes  #: the file's content
    width: int  #: on the screen, pixels
    alt: str  #: what it shows, for who cannot see it

    def __repr__(self) -> str:
        return "figure"

    def _repr_png_(self) -> tuple[bytes, dict[str, int | str]]:
        """For Jupyter."""
        return self.png, {"width": self.width, "alt": self.alt}


def case_table(cases: Sequence[Case]) -> Table:
    """Cases as reference, computed, difference and verdict, with what a reader must know to judge them.

    The reference is printed in the source unless the row says where it comes from.
    """
    rows = []
    for case in cases:
        what = f"{case.quantity}\n[{case.source}; case {case.name.partition('/')[2]}]"
        what += "" if case.origin.kind == "printed" else f"\nReference: {case.origin}"
        what += f"\n{case.note}" if case.note else ""
        if (effect := case.effect) is not None:
            what += f"\n{effect.quantity}: {effect.measured:.3g}, computed {effect.computed:.3g}"
        shown = (_shown(case.printed), _shown(case.computed), _difference(case.difference))
        rows.append((what, *shown, case.verdict))
    found = verdicts(cases)
    counts = (
        f"{len(names)} {_PLURAL[verdict] if len(names) > 1 else verdict}" for verdict, names in found.items()
    )
    header = ("What is compared", "Reference", "Computed", "Difference", "Verdict")
    return Table(header, tuple(rows), f"Of {len(cases)}: " + ", ".join(counts) + ".")


def verdicts(cases: Sequence[Case]) -> dict[str, set[str]]:
    """Names of the cases, without their group, by verdict; verdicts that none has are left out."""
    found = {
        verdict: {case.name.partition("/")[2] for case in cases if case.verdict == verdict}
        for verdict in get_args(Verdict)
    }
    return {verdict: names for verdict, names in found.items() if names}


def picture(figure: Figure) -> Picture:
    """Figure of the page's size."""
    width = round(WIDTH * _WIDE)
    content = io.BytesIO()
    with style():
        figure.savefig(content, format="png", dpi=_DPI, metadata={"Software": None})
    return Picture(content.getvalue(), width, figure.alt or str(figure.caption))


@contextmanager
def page(
    heights: Sequence[float],
    text: str,
    columns: Sequence[int] = (),
    *,
    left: float = 0.72,
    top: float = 0.15,
    between: float = 0.12,
    below: float = 0.42,
    apart: float = 0.0,
) -> Iterator[tuple[Figure, list[list[Any]]]]:
    """Figure in the house style and its rows of axes; laid out above its caption when the body ends.

    Heights of the rows and the room round them in inches; columns: axes of each row, one if there is no
    number; apart: inches between two beside one another.
    """
    with style():
        figure, counts = Figure(), columns or (1,) * len(heights)
        rows: list[list[Any]] = [
            [figure.add_axes((0, 0, 1, 1), label=f"{k} {i}") for i in range(count)]
            for k, count in enumerate(counts)
        ]
        yield figure, rows
        for axis in (axis for row in rows for axes in row for axis in (axes.xaxis, axes.yaxis)):
            if type(axis.get_major_formatter()).__name__ == "ScalarFormatter":
                axis.set_major_formatter(number)
        lay_out(figure, rows, list(heights), Frame(left, top, between, below), text)
        for row in rows:
            for k, axes in enumerate(row if apart else ()):
                box, room = axes.get_position(), apart / len(row) / WIDTH
                axes.set_position((box.x0 + k * room, box.y0, box.width - room, box.height))


def logarithmic(*axes: Any, x: Sequence[float] = (), y: Sequence[float] = ()) -> None:
    """Set an axis with ticks to a logarithmic scale, with these ticks alone, in plain numbers."""
    for each in axes:
        for ticks, name in ((x, "x"), (y, "y")):
            if ticks:
                each.set(**{f"{name}scale": "log", f"{name}ticks": ticks})
                getattr(each, f"{name}axis").set_major_formatter(number)
                getattr(each, f"{name}axis").set_minor_formatter("")


def power(value: float, _at: float | None = None) -> str:
    """A power of ten in plain letters, for the ticks of an axis."""
    return "10" + str(round(math.log10(value))).translate(_RAISED)


def _lines(text: str) -> str:
    """A cell's text in HTML, their line breaks kept, with places where long names may break."""
    return _BREAK.sub("<wbr>", escape(text)).replace("\n", "<br>")


def _shown(value: Value) -> str:
    if value is None:
        return "none"
    return value if isinstance(value, str) else f"{value:.6g}"


def _difference(value: Value) -> str:
    """Relative differences in per cent, large ones as a factor."""
    if not isinstance(value, float):
        return _shown(value)
    if value == 0.0:
        return "0"
    if abs(value) < _PLAIN:
        return f"{100.0 * value:+.3g} %"
    return f"printed is {value + 1.0:,.0f} times the computed"
