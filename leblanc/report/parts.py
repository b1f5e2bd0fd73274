"""What reports are made of: cells, tables, pictures with their captions as text."""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from leblanc.results.provenance import one_line

if TYPE_CHECKING:
    from leblanc.figures.page import FigureFiles

LIGHT = 300_000  # bytes up to which a drawing is kept as lines; beyond it the smaller of the two files
TYPES = {".svg": "image/svg+xml", ".png": "image/png"}
SCENE = " Scene: "  # from here on a caption repeats what the page says


@dataclass(frozen=True)
class Cell:
    """One value as printed.

    Parameters
    ----------
    text : the value with its unit
    assumed : no source gives it
    warning : a reader must not overlook it
    path : in the scene; empty for a result
    """

    text: str
    assumed: bool = False
    warning: bool = False
    path: str = ""


@dataclass(frozen=True)
class Table:
    """A table; the first cell of each row is its heading.

    Parameters
    ----------
    title : above it, may be empty
    head : headings of the columns; none for a list of labels and values
    rows : of cells, as many as there are columns
    words : cells are sentences, not numbers
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    words: bool = False


def table(
    title: str, head: Sequence[str], rows: Sequence[Sequence[str | Cell]], words: bool = False
) -> Table:
    """Table of texts and cells.

    Parameters
    ----------
    title, head, rows, words : as for `Table`; a text becomes a cell
    """
    cells = tuple(tuple(one if isinstance(one, Cell) else Cell(one) for one in row) for row in rows)
    return Table(title, tuple(head), cells, words)


@dataclass(frozen=True)
class Picture:
    """A figure as a page shows it.

    Parameters
    ----------
    title, caption : below it
    alt : what it shows, for who cannot see it
    address : that holds the whole picture
    shape : width and height of what is shown, the lines of the caption cut off; None if not known
    """

    title: str
    caption: str
    alt: str
    address: str
    shape: tuple[float, float] | None

    @property
    def ratio(self) -> float:
        """Height over width."""
        return 0.66 if self.shape is None else self.shape[1] / self.shape[0]


def picture(files: FigureFiles, alt: str, without: Sequence[str] = ()) -> Picture:
    """A figure with the caption that is drawn in it as text.

    Parameters
    ----------
    files : of the figure
    alt : what it shows and the numbers a reader would take from it
    without : sentences of the caption that the page has elsewhere
    """
    drawing = files.svg.read_text(encoding="utf-8")
    lines, shape = _caption(drawing)
    text = " ".join(lines).partition(SCENE)[0]
    for sentence in without:
        text = text.replace(one_line(sentence), "")
    text = one_line(text.removeprefix(f"{files.title}."))
    chosen = min((files.svg, files.png), key=lambda file: file.stat().st_size)
    chosen = files.svg if files.svg.stat().st_size <= LIGHT else chosen
    content = base64.b64encode(chosen.read_bytes()).decode("ascii")
    return Picture(files.title, text, alt, f"data:{TYPES[chosen.suffix]};base64,{content}", shape)


def _caption(drawing: str) -> tuple[list[str], tuple[float, float] | None]:
    """Lines of the caption of a drawing, and the size of what stands above them, points.

    The lines of a caption stand at the left margin in a size and a grey of their own; each letter is a path,
    with the text beside it as a comment.
    """
    from leblanc.figures.page import CAPTION_ROW, CAPTION_SIZE, RIGHT

    size = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', drawing)
    if size is None:
        return [], None
    wide, high = map(float, size.groups())
    scale = re.escape(f"scale({CAPTION_SIZE / 100.0:g} -{CAPTION_SIZE / 100.0:g})")
    line = (
        r'<g id="text_\d+">\s*<!-- (.*?) -->\s*<g style="fill: #404040" '
        rf'transform="translate\({72.0 * RIGHT:g} ([\d.]+)\) {scale}">'
    )
    found = sorted((float(below), html.unescape(text)) for text, below in re.findall(line, drawing))
    if found:
        # The base of the first line stands a quarter of a row above the row's end.
        high = found[0][0] - 0.75 * 72.0 * CAPTION_ROW
    return [text for _, text in found], (round(wide, 2), round(high, 2))
