"""The page that figures stand on: style, places of axes, legend and caption, files."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib
import matplotlib.figure
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.font_manager import findfont, get_font
from matplotlib.patches import ConnectionPatch, PathPatch, Polygon
from matplotlib.path import Path as Lines
from matplotlib.ticker import MaxNLocator
from matplotlib.ticker import MultipleLocator as MultipleLocator  # handed on: this is the only door
from numpy.typing import ArrayLike

from leblanc.core.files import path_of, require_writable, writing
from leblanc.core.notes import one_line
from leblanc.core.units import LENGTH, MASS, RPM, VOLUME, unit_for, units_of
from leblanc.studies.run.answer import RunAnswer
from meshes.arrays import Complex
from meshes.errors import InputError

# Lengths in inches.
WIDTH, RIGHT = 6.3, 0.25
LEGEND_ROW, CAPTION_ROW, MARGIN = 0.145, 0.125, 0.06
CAPTION_SIZE, MOST_LINES = 7.0, 4  # points; lines of the caption
LEGEND_CHARACTERS = 100  # in one row
FILM_DPI = 100
LIGHT = 300_000  # bytes of lines that a browser shows at once


@dataclass(frozen=True)
class Frame:
    """Room around and between the rows of axes, inches; `gaps` in place of `between` where they differ."""

    left: float
    top: float
    between: float
    below: float
    gaps: tuple[float, ...] = ()


@dataclass(frozen=True)
class Caption:
    """Text below a figure."""

    shown: str  #: what the figure shows
    origin: str = ""  #: scene, model and assumed values behind it, which a report says elsewhere

    def __str__(self) -> str:
        return f"{self.shown} {self.origin}".strip()


class Figure(matplotlib.figure.Figure):
    """Figure of matplotlib with its caption, alternative text and `drawn`, inches above the caption."""

    caption: Caption = Caption("")
    alt: str = ""
    drawn: tuple[float, float] | None = None

    def add_axes(self, *args: Any, **kwargs: Any) -> Any:
        """See matplotlib; somebody else's axes where a figure is drawn on them."""
        given = _GIVEN.get()
        return super().add_axes(*args, **kwargs) if given is None else given


_GIVEN: ContextVar[Axes | None] = ContextVar("given", default=None)  # axes that a figure is drawn on


def drawn_on(draw: Callable[[Any], Figure], answer: Any, axes: Any) -> Any:
    """The figure of somebody else's axes, on which the one axes of a figure is drawn."""
    if not isinstance(axes, matplotlib.axes.Axes):
        raise InputError("ax", type(axes).__name__, "axes of matplotlib")
    count = len(draw(answer).axes)
    if count != 1:
        raise InputError("ax", "axes", f"left out: this figure has {count} axes, not one")
    token = _GIVEN.set(axes)
    try:
        draw(answer)
    finally:
        _GIVEN.reset(token)
    return axes.figure


@dataclass(frozen=True)
class FigureFiles:
    """One figure on disk."""

    name: str  #: stem of its files
    title: str  #: what it shows
    svg: Path  #: its file
    png: Path | None = None  #: the same in pixels, where it was asked for or the lines are heavy
    caption: Caption = field(default=Caption(""))  #: as of `Figure`
    alt: str = ""
    drawn: tuple[float, float] | None = None

    @property
    def shown(self) -> Path:
        """The file that a report shows: lines, unless they are heavy and pixels are lighter."""
        if self.png is None or self.svg.stat().st_size <= LIGHT:
            return self.svg
        return min((self.svg, self.png), key=lambda file: file.stat().st_size)


@contextmanager
def style() -> Iterator[None]:
    """The house style on top of matplotlib's own defaults, whatever the user's settings are."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_sheet())
        yield


@cache
def _sheet() -> matplotlib.RcParams:
    """The house style, read once."""
    with resources.as_file(resources.files("leblanc.plotting") / "leblanc.mplstyle") as path:
        return matplotlib.rc_params_from_file(path, use_default_template=False)


def save(figure: Figure, directory: Path, name: str, title: str, png: bool = False) -> FigureFiles:
    """Write one figure as SVG, without the time of writing; as PNG where asked for or where that is heavy."""
    svg = directory / f"{name}.svg"
    with style(), writing(svg) as path:
        figure.savefig(path, format="svg", metadata={"Date": None, "Creator": "leblanc", "Title": title})
    pixels = save_png(figure, directory, name, title) if png or svg.stat().st_size > LIGHT else None
    return FigureFiles(name, title, svg, pixels, figure.caption, figure.alt, figure.drawn)


def save_png(figure: Figure, directory: Path, name: str, title: str) -> Path:
    """Write one figure as PNG alone; parameters as for `save`."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    with style(), writing(directory / f"{name}.png") as path:
        metadata = {"Software": None, "Title": title}
        # The usual level 6 takes a tenth of all drawing for a few per cent of the size.
        figure.savefig(path, format="png", metadata=metadata, pil_kwargs={"compress_level": 3})
    return directory / f"{name}.png"


def number(value: float, _position: float | None = None) -> str:
    """Tick label without an offset or a common factor elsewhere on the axis."""
    return f"{value + 0.0:.10g}".replace("-", "\N{MINUS SIGN}")


_PLOTTED = {"mm": LENGTH, "ml": VOLUME, "g": MASS}  # units in which figures draw, as they end a label
_UNIT = re.compile(r"\((mm|ml|g)( 0-p)?\)$")


def readable(axis: Any) -> None:
    """Show an axis in the unit that a person would write for its limits: 5 um, not 0.005 mm."""
    found = _UNIT.search(axis.get_label_text())
    if found is None or axis.get_scale() != "linear":
        return
    dimension = _PLOTTED[found[1]]
    drawn = next(unit for unit in units_of(dimension) if unit.name == found[1])
    chosen = unit_for(dimension, *(float(limit) / drawn.count for limit in axis.get_view_interval()))
    if chosen != drawn:
        factor = chosen.count / drawn.count
        axis.set_label_text(f"{axis.get_label_text()[: found.start()]}({chosen.name}{found[2] or ''})")
        axis.set_major_formatter(lambda value, _position=None: number(value * factor))


def fill(axes: Axes, x: ArrayLike, y: ArrayLike, **look: Any) -> None:
    """Fill a polygon on axes whose limits are set.

    `axes.fill` looks for the extremes of each edge as of a curve, which takes longer than to draw it.
    """
    axes.add_artist(Polygon(np.column_stack([x, y]), **look))


def fill_loops(axes: Axes, loops: Sequence[Complex], **look: Any) -> None:
    """Fill what lies inside closed outlines, with holes in it, on axes whose limits are set."""
    corners, codes = [], []
    for loop in loops:
        closed = np.append(loop, loop[0])
        corners.append(np.column_stack([closed.real, closed.imag]))
        codes.append([Lines.MOVETO, *[Lines.LINETO] * (loop.size - 1), Lines.CLOSEPOLY])
    if corners:
        path = Lines(np.concatenate(corners), np.concatenate(codes))
        axes.add_artist(PathPatch(path, edgecolor="none", **look))


def part_of(colours: str, first: float, last: float) -> ListedColormap:
    """Part of a range of colours, from 0 to 1, without its ends."""
    return ListedColormap(matplotlib.colormaps[colours](np.linspace(first, last, 256)))


def add_rate_axis(axes: Axes, label: str = "Speed (rad/s)") -> None:
    """An axis in rad/s above one in rpm."""
    above = axes.secondary_xaxis("top", functions=(_to_rate, _to_rpm))
    above.set_xlabel(label)
    above.xaxis.set_major_formatter(number)


def _to_rate(rpm: ArrayLike) -> ArrayLike:
    return np.asarray(rpm) / RPM


def _to_rpm(rate: ArrayLike) -> ArrayLike:
    return np.asarray(rate) * RPM


def lay_out(
    figure: Figure,
    rows: list[list[Axes]],
    heights: list[float],
    frame: Frame,
    caption: Caption | str,
    most_lines: int = MOST_LINES,
) -> None:
    """Size of the figure, places of its axes, and below them the legend and the caption.

    Rows stand below one another, heights in inches; of the caption `most_lines` are drawn.
    """
    if (given := _GIVEN.get()) is not None:
        readable(given.xaxis)
        readable(given.yaxis)
        if given.get_legend_handles_labels()[1]:
            given.legend()
        return
    figure.caption = Caption(caption) if isinstance(caption, str) else caption
    entries: dict[str, Any] = {}
    for axes in [axes for row in rows for axes in row]:
        readable(axes.xaxis)
        readable(axes.yaxis)
        handles, labels = axes.get_legend_handles_labels()
        entries = dict(zip(labels, handles, strict=True)) | entries
    lines = _wrapped(str(caption), WIDTH - 2.0 * RIGHT, most_lines)
    text = CAPTION_ROW * len(lines) + 2.0 * MARGIN
    columns = max(1, min(4, LEGEND_CHARACTERS // (max(map(len, entries), default=0) + 8)))
    legend = LEGEND_ROW * -(-len(entries) // columns) + MARGIN
    gaps = frame.gaps or (frame.between,) * (len(rows) - 1)
    total = frame.top + sum(heights) + sum(gaps) + frame.below + legend + text
    figure.set_size_inches(WIDTH, total)
    figure.drawn = WIDTH, total - MARGIN - CAPTION_ROW * len(lines)
    above = frame.top
    for row, height, gap in zip(rows, heights, (*gaps, 0.0), strict=True):
        width = (WIDTH - frame.left - RIGHT) / len(row)
        for i, axes in enumerate(row):
            left, bottom = frame.left + i * width, total - above - height
            axes.set_position((left / WIDTH, bottom / total, width / WIDTH, height / total))
        above += height + gap
    place = {"loc": "lower center", "bbox_to_anchor": (0.5, text / total), "borderaxespad": 0.0}
    figure.legend(entries.values(), entries.keys(), ncols=columns, borderpad=0.0, **place)
    for i, line in enumerate(reversed(lines)):
        height = MARGIN + CAPTION_ROW * (i + 0.25)
        figure.text(RIGHT / WIDTH, height / total, line, fontsize=CAPTION_SIZE, color="0.25")


def add_windows(
    figure: Figure,
    whole: Sequence[Axes],
    wide: Sequence[Sequence[Axes]],
    heights: Sequence[float],
    caption: Caption,
    left: float = 0.72,
) -> None:
    """Lay out panels over all speeds and, below, those that show parts of them, linked by lines.

    `wide` holds for each panel those over the same parts, beside one another; heights, inches, are of the
    rows over all speeds, then of the others.
    """
    parts, count = len(wide[0]), len(whole)
    for row in wide:
        for axes in row:
            axes.xaxis.set_major_locator(MaxNLocator(nbins=8 // parts + 1, steps=[1, 2, 2.5, 5, 10]))
            axes.tick_params(labelbottom=row is wide[-1])
            axes.set_xlabel("Speed (rpm)" if row is wide[-1] else "")
            for side in axes.spines.values():
                side.set(color=_LINKED, linewidth=1.0)
        for axes in row[1:]:
            axes.set_ylabel("")
    gaps = (*[0.12] * (count - 1), 0.5, *[0.12] * (count - 1))
    rows = [[axes] for axes in whole] + [list(row) for row in wide]
    frame = Frame(left=left, top=0.46, between=0.12, below=0.42, gaps=gaps)
    lay_out(figure, rows, list(heights), frame, caption, MOST_LINES + 1)
    for row in wide:
        for axes in row[1:]:
            box = axes.get_position()
            axes.set_position((box.x0 + _APART / WIDTH, box.y0, box.width - _APART / WIDTH, box.height))
    for axes in wide[0]:
        _link(figure, whole, axes)
    for label in whole[-1].get_xticklabels():  # the lines between the panels pass behind them
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.8})


def _link(figure: Figure, whole: Sequence[Axes], part: Axes) -> None:
    """Frame on the panels over all speeds what a part shows, and lead two lines from there to it."""
    low, high = part.get_xlim()
    for axes in whole:
        axes.axvspan(low, high, facecolor="none", edgecolor=_LINKED, linewidth=1.0, zorder=1.2)
    below = whole[-1].get_xaxis_transform()
    for x, corner in ((low, 0.0), (high, 1.0)):
        link = ConnectionPatch((x, 0.0), (corner, 1.0), below, part.transAxes, color=_LINKED)
        link.set(linewidth=0.7, zorder=0.5)
        figure.add_artist(link)


_APART = 0.45  # inches between parts beside one another
_LINKED = "0.45"  # frames of the panels that are linked, and the lines between them


@cache
def _advance(character: str) -> float:
    """Width of a character of the caption, inches; 0 if the font does not have it."""
    font = get_font(findfont("DejaVu Sans"))
    font.set_size(CAPTION_SIZE, 72)
    known = font.get_char_index(ord(character)) > 0
    return float(font.load_char(ord(character)).linearHoriAdvance) / 65536.0 / 72.0 if known else 0.0


def _wrapped(text: str, width: float, most: int) -> list[str]:
    """Lines that fit the figure; characters that the font lacks become boxes, what is too long is cut."""
    text = "".join(c if _advance(c) > 0.0 else "\N{WHITE SQUARE}" for c in text)
    lines, used = [""], 0.0
    for word in text.split(" "):
        length = sum(map(_advance, word))
        if used > 0.0 and used + length > width:
            lines.append("")
            used = 0.0
        for character in word + " ":
            if used + _advance(character) > width and character != " ":
                lines.append("")
                used = 0.0
            lines[-1] += character
            used += _advance(character)
    lines = [line.rstrip() for line in lines]
    return lines if len(lines) <= most else [*lines[: most - 1], lines[most - 1][:-3] + "..."]


def require_film(path: Path) -> str:
    """Ending of a film's path, .gif or .mp4; InputError for another or an .mp4 without an ffmpeg."""
    kind = path.suffix.lower()
    if kind not in (".gif", ".mp4"):
        raise InputError("--animate", str(path), "a file that ends in .gif or .mp4")
    if kind == ".mp4" and shutil.which(_player()) is None:
        raise InputError("--animate", str(path), "a .gif, since no ffmpeg was found to write an .mp4")
    return kind


def film_path(given: str | os.PathLike[str] | None, name: str) -> Path | None:
    """Where a film goes, tried before the work; None without one."""
    path = path_of(given, name)
    if path is not None:
        require_film(path)
        require_writable(path)
    return path


def write_film(
    make: Callable[[], tuple[Figure, Callable[[int], None]]],
    frames: Sequence[int],
    rate: int,
    path: Path,
    drawn: Callable[[int, int], None] | None = None,
) -> int:
    """Write a film, whole or not at all, to a .gif or (with an ffmpeg) an .mp4; its number of frames.

    `make` gives the figure and what sets it to a frame; `rate` is in frames per second; `drawn` is called
    after each with the number drawn and of all.
    """
    from matplotlib.animation import FFMpegWriter, PillowWriter

    kind = require_film(path)
    player = _player()
    with style(), writing(path) as part, TemporaryDirectory() as folder:
        matplotlib.rcParams["animation.ffmpeg_path"] = player
        writer = (PillowWriter if kind == ".gif" else FFMpegWriter)(fps=rate)
        figure, show = make()
        # The writers tell the format by the ending.
        whole = Path(folder) / f"film{kind}"
        with writer.saving(figure, str(whole), FILM_DPI):
            for count, frame in enumerate(frames, start=1):
                show(frame)
                writer.grab_frame()
                if drawn is not None:
                    drawn(count, len(frames))
        shutil.copyfile(whole, part)
    return len(frames)


def _player() -> str:
    """The ffmpeg of the user's settings, not that of a file in the current folder: it may be a stranger's."""
    own = matplotlib.matplotlib_fname() != "matplotlibrc"
    return str(matplotlib.rcParams["animation.ffmpeg_path"]) if own else "ffmpeg"


def caption(result: RunAnswer, text: str) -> Caption:
    """What the figure shows, the scene, the model and the values it assumes."""
    assumed = ", ".join(map(one_line, result.assumed)) or "nothing"
    model = ", ".join(result.models_used)
    return Caption(text, f"Scene: {one_line(result.name)}. Liquid model: {model}. Assumed: {assumed}.")


def zero_of(result: RunAnswer) -> str:
    """What angles count from."""
    motion = result.motion
    return "the unbalance" if motion is None or motion.zero == "unbalance" else motion.zero
