"""The page that figures stand on: style, places of axes, legend and caption, files."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import resources
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import matplotlib
import matplotlib.figure
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import Collection
from matplotlib.colors import ListedColormap, to_hex, to_rgba
from matplotlib.container import Container
from matplotlib.lines import Line2D
from matplotlib.patches import ConnectionPatch, PathPatch, Polygon
from matplotlib.path import Path as Lines
from matplotlib.ticker import MaxNLocator
from matplotlib.ticker import MultipleLocator as MultipleLocator  # handed on: this is the only door
from numpy.typing import ArrayLike

from leblanc.core.files import path_of, require_writable, writing
from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import LENGTH, MASS, RPM, VOLUME, unit_for, units_of
from leblanc.studies.run.answer import RunAnswer
from meshes.arrays import Complex
from meshes.errors import InputError

# Lengths in inches.
WIDTH, RIGHT = 6.3, 0.25
LEGEND_ROW, MARGIN = 0.145, 0.06
MOST_ENTRIES = 5  # of a legend; its caption says the rest
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
    """What a page says below a figure, and a file in its description."""

    shown: str  #: what the figure shows
    origin: str = ""  #: scene, model and assumed values behind it, which a report says elsewhere

    def __str__(self) -> str:
        return f"{self.shown} {self.origin}".strip()


class Figure(matplotlib.figure.Figure):
    """Figure of matplotlib with its caption and alternative text."""

    caption: Caption = Caption("")
    alt: str = ""

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
        metadata = {"Date": None, "Creator": "leblanc", "Title": title, "Description": _described(figure)}
        figure.savefig(path, format="svg", metadata=metadata)
    pixels = save_png(figure, directory, name, title) if png or svg.stat().st_size > LIGHT else None
    return FigureFiles(name, title, svg, pixels, figure.caption, figure.alt)


def save_png(figure: Figure, directory: Path, name: str, title: str) -> Path:
    """Write one figure as PNG alone; parameters as for `save`."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(figure)
    with style(), writing(directory / f"{name}.png") as path:
        metadata = {"Software": None, "Title": title, "Description": _described(figure)}
        # The usual level 6 takes a tenth of all drawing for a few per cent of the size.
        figure.savefig(path, format="png", metadata=metadata, pil_kwargs={"compress_level": 3})
    return directory / f"{name}.png"


def _described(figure: Figure) -> str:
    """The caption as one line of plain text."""
    return one_line(str(figure.caption))


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
) -> None:
    """Size of the figure, places of its axes, and below them the legend; the caption is text of the page.

    Rows stand below one another, heights in inches.
    """
    if (given := _GIVEN.get()) is not None:
        readable(given.xaxis)
        readable(given.yaxis)
        if given.get_legend_handles_labels()[1]:
            given.legend()
        return
    entries: dict[str, Any] = {}
    for axes in [axes for row in rows for axes in row]:
        readable(axes.xaxis)
        readable(axes.yaxis)
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    # Curves and points before what marks ranges.
    order = sorted(entries, key=lambda label: _marks_range(entries[label]))
    listed, rest = order[:MOST_ENTRIES], order[MOST_ENTRIES:]
    if rest and len(rows) > 1 and (panels := _by_panel(rows, order)):
        listed, rest = [], _own_legends(panels)
    text = Caption(caption) if isinstance(caption, str) else caption
    besides = "; ".join(f"{look(entries[label])}, {label}" for label in rest)
    figure.caption = replace(text, shown=f"{text.shown} Besides: {besides}.") if rest else text
    columns = max(1, min(4, LEGEND_CHARACTERS // (max(map(len, listed), default=0) + 8)))
    legend = LEGEND_ROW * -(-len(listed) // columns) + MARGIN
    gaps = frame.gaps or (frame.between,) * (len(rows) - 1)
    total = frame.top + sum(heights) + sum(gaps) + frame.below + legend + MARGIN
    figure.set_size_inches(WIDTH, total)
    above = frame.top
    for row, height, gap in zip(rows, heights, (*gaps, 0.0), strict=True):
        width = (WIDTH - frame.left - RIGHT) / len(row)
        for i, axes in enumerate(row):
            left, bottom = frame.left + i * width, total - above - height
            axes.set_position((left / WIDTH, bottom / total, width / WIDTH, height / total))
        above += height + gap
    place = {"loc": "lower center", "bbox_to_anchor": (0.5, MARGIN / total), "borderaxespad": 0.0}
    if listed:
        figure.legend([entries[label] for label in listed], listed, ncols=columns, borderpad=0.0, **place)


def _by_panel(rows: list[list[Axes]], order: list[str]) -> list[tuple[Axes, dict[str, Any]]]:
    """Entries that each panel has before the others; nothing where a single one has them all."""
    found: list[tuple[Axes, dict[str, Any]]] = []
    for axes in [axes for row in rows for axes in row]:
        handles, labels = axes.get_legend_handles_labels()
        mine = dict(zip(labels, handles, strict=True))
        known = {label for _, others in found for label in others}
        own = {label: mine[label] for label in order if label in mine and label not in known}
        found += [(axes, own)] if own else []
    return found if len(found) > 1 else []


def _own_legends(panels: list[tuple[Axes, dict[str, Any]]]) -> list[str]:
    """A legend in each panel of five entries at most; those that have no room."""
    look = {"fontsize": 6.5, "framealpha": 0.85, "borderpad": 0.3, "handlelength": 1.8, "loc": "best"}
    for axes, own in panels:
        few = list(own)[:MOST_ENTRIES]
        axes.legend([own[label] for label in few], few, ncols=1 if len(few) < 3 else 2, **look)
    return [label for _, own in panels for label in list(own)[MOST_ENTRIES:]]


_COLOURS = {
    "#0072b2": "blue", "#d55e00": "red", "#009e73": "green", "#e69f00": "orange", "#56b4e9": "light blue",
    "#cc79a7": "pink", "#aa3377": "purple", "#000000": "black", "#f0e442": "yellow",
}  # fmt: skip
_BAR = 4.0  # points, from which on a line is a bar


def _marks_range(handle: Any) -> bool:
    """A patch or a bar, neither a curve nor points nor a band between curves."""
    if not isinstance(handle, Line2D):
        return not isinstance(handle, Container | Collection)
    return bool(handle.get_linewidth() >= _BAR)


def look(handle: Any) -> str:
    """How an entry of a legend looks, in words: "red, dash-dotted"."""
    if not isinstance(handle, Line2D):
        return "shaded"
    red, green, blue, _ = to_rgba(handle.get_color())
    grey = max(red, green, blue) - min(red, green, blue) < 0.05
    colour = _COLOURS.get(to_hex(handle.get_color()), "grey" if grey else "coloured")
    dashes = handle._unscaled_dash_pattern[1]  # type: ignore[attr-defined] # nothing public has it
    marker = handle.get_marker() not in (None, "None", "", " ")
    if handle.get_linewidth() >= _BAR:
        return f"{colour} bar"
    if handle.get_linestyle() == "None":
        return f"{colour} marks"
    kind = "line with marks" if marker else "line"
    if dashes is not None:
        kind = "dotted" if max(dashes) < 2.0 else "dashed" if len(dashes) < 3 else "dash-dotted"
    return f"{colour}, {kind}"


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
    lay_out(figure, rows, list(heights), frame, caption)
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


def require_film(path: Path) -> str:
    """Ending of a film's path, .gif, .html or .mp4; InputError for another or an .mp4 without an ffmpeg."""
    kind = path.suffix.lower()
    if kind not in (".gif", ".html", ".mp4"):
        raise InputError("--animate", str(path), "a file that ends in .gif, .html or .mp4")
    if kind == ".mp4" and shutil.which(_player()) is None:
        allowed = "a .gif or a page that plays, .html, since no ffmpeg was found to write an .mp4"
        raise InputError("--animate", str(path), allowed)
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
    """Write a film, whole or not at all, to a .gif, a page or (with an ffmpeg) an .mp4; its number of frames.

    `make` gives the figure and what sets it to a frame; `rate` is in frames per second; `drawn` is called
    after each with the number drawn and of all.
    """
    from matplotlib.animation import FFMpegWriter, HTMLWriter, PillowWriter

    kind = require_film(path)
    player = _player()
    with style(), writing(path) as part, TemporaryDirectory() as folder:
        matplotlib.rcParams["animation.ffmpeg_path"] = player
        writer: Any
        if kind == ".html":
            writer = HTMLWriter(fps=rate, embed_frames=True, embed_limit=_PAGE)
        else:
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
        if kind == ".html":
            whole.write_text(_playing(whole.read_text(encoding="utf-8")), encoding="utf-8")
        shutil.copyfile(whole, part)
    return len(frames)


_PAGE = 200.0  # MB of a page of frames at most
# Signs of the buttons of a page that plays, in place of a font from the network.
_BUTTONS = {
    "fa-minus": "\N{MINUS SIGN}",
    "fa-fast-backward": "|\N{LEFTWARDS ARROW}",
    "fa-step-backward": "\N{LEFTWARDS ARROW}",
    "fa-play fa-flip-horizontal": "\N{BLACK LEFT-POINTING TRIANGLE}",
    "fa-pause": "||",
    "fa-play": "\N{BLACK RIGHT-POINTING TRIANGLE}",
    "fa-step-forward": "\N{RIGHTWARDS ARROW}",
    "fa-fast-forward": "\N{RIGHTWARDS ARROW}|",
    "fa-plus": "+",
}


def _playing(page: str) -> str:
    """matplotlib's page of frames as a document that needs no network and is the same each time."""
    page = re.sub(r"<link[^>]*font-awesome[^>]*>", "", page)
    if found := re.search(r"anim([0-9a-f]{32})", page):
        page = page.replace(found[1], "film")
    for name, sign in _BUTTONS.items():
        page = page.replace(f'<i class="fa {name}"></i>', sign)
    head = '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Film</title></head><body>'
    return f"{head}{page}</body></html>\n"


def _player() -> str:
    """The ffmpeg of the user's settings, not that of a file in the current folder: it may be a stranger's."""
    own = matplotlib.matplotlib_fname() != "matplotlibrc"
    return str(matplotlib.rcParams["animation.ffmpeg_path"]) if own else "ffmpeg"


def caption(result: RunAnswer, text: str) -> Caption:
    """What the figure shows, the scene, the model and the values it assumes."""
    model, assumed = ", ".join(result.models_used), assumed_words(result.assumed)
    return Caption(text, f"Scene: {one_line(result.name)}. Liquid model: {model}. Assumed: {assumed}.")


def zero_of(result: RunAnswer) -> str:
    """What angles count from."""
    motion = result.motion
    return "the unbalance" if motion is None or motion.zero == "unbalance" else motion.zero
