"""The figures of a study as PNG and SVG: the only door to matplotlib.

Figures are drawn on the object interface: to import pyplot costs more than to draw them all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import findfont, get_font
from matplotlib.ticker import FuncFormatter, MultipleLocator, NullFormatter
from numpy.typing import ArrayLike

from study.figures import chamber, over_speed
from study.figures.curves import Curves, prepare
from study.record import RPM, StudyRecord, models_used, one_line
from study.results import replacing

Draw = Callable[[Axes, Curves, StudyRecord], None]

# Lengths in inches.
WIDTH, RIGHT = 6.3, 0.25
LEGEND_ROW, CAPTION_ROW, MARGIN = 0.145, 0.125, 0.06
CAPTION_SIZE, MOST_LINES = 7.0, 4  # points; lines of the caption
LEGEND_CHARACTERS = 100  # in one row


@dataclass(frozen=True)
class Frame:
    """Room around and between the rows of axes, inches."""

    left: float
    top: float
    between: float
    below: float


SPEED_FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
CHAMBER_FRAME = Frame(left=0.15, top=0.26, between=0.6, below=0.36)
HEADING_ROW = 0.14


@dataclass(frozen=True)
class FigureFiles:
    """One figure on disk.

    Parameters
    ----------
    name : stem of its files
    title : what it shows
    png, svg : its files
    """

    name: str
    title: str
    png: Path
    svg: Path


@contextmanager
def style() -> Iterator[None]:
    """The house style on top of matplotlib's own defaults, whatever the user's settings are."""
    sheet = resources.files("study") / "leblanc.mplstyle"
    with resources.as_file(sheet) as path, matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(matplotlib.rc_params_from_file(path, use_default_template=False))
        yield


def amplitude_figure(record: StudyRecord) -> Figure:
    """Amplitude over speed with and without liquid."""
    return _over_speed(record, [(2.75, over_speed.draw_amplitude)], "Amplitude of the deflection.")


def liquid_figure(record: StudyRecord) -> Figure:
    """Distance and angle of the liquid's centre of mass over speed."""
    panels = [(1.55, over_speed.draw_offset), (1.55, over_speed.draw_angle)]
    text = "Centre of mass of the liquid: distance from the rotation axis, angle from the unbalance."
    return _over_speed(record, panels, text)


def phase_figure(record: StudyRecord) -> Figure:
    """Phase of the deflection over speed with and without liquid."""
    text = "Angle from the unbalance to the deflection; a lag is negative."
    return _over_speed(record, [(2.75, over_speed.draw_phase)], text)


def chamber_figure(record: StudyRecord) -> Figure:
    """Chambers as seen along the axis at the largest deflection and at the working speed."""
    views = chamber.choose_views(record)
    with style():
        figure = Figure()
        cells = [(drawing, index) for index in views.instants for drawing in views.drawings]
        if not cells:
            axes = figure.add_axes((0, 0, 1, 1), frame_on=False, xticks=[], yticks=[])
            axes.text(0.5, 0.5, "no chamber, or no deflection found", ha="center")
            _lay_out(figure, [[axes]], [1.0], CHAMBER_FRAME, _caption(record, "Chamber seen along the axis."))
            return figure
        drawn = []
        for i, (chambers, index) in enumerate(cells):
            axes = figure.add_axes((0, 0, 1, 1), label=str(i))
            chamber.draw_chambers(axes, chambers, complex(record.response.deflection[index]), views)
            if i % len(views.drawings) == 0:
                chamber.write_numbers(axes, record, views, index)
            drawn.append(axes)
        # Up to two drawings of each view stand in one row, more in a row for each view.
        columns = len(drawn) if len(views.drawings) < 3 else len(views.drawings)
        rows = [drawn[i : i + columns] for i in range(0, len(drawn), columns)]
        sides = [min(2.7, (WIDTH - CHAMBER_FRAME.left - RIGHT) / columns)] * len(rows)
        caption = _caption(record, f"Chamber seen along the axis. {chamber.describe_scale(views)}")
        more = HEADING_ROW * chamber.more_heading_rows(record, views)
        frame = replace(CHAMBER_FRAME, top=CHAMBER_FRAME.top + more, between=CHAMBER_FRAME.between + more)
        _lay_out(figure, rows, sides, frame, caption)
    return figure


def write_figures(record: StudyRecord, directory: Path) -> tuple[FigureFiles, ...]:
    """Draw all figures of a study and write each as PNG and SVG.

    One record gives the same files byte for byte, as long as the version of matplotlib stays the same.

    Parameters
    ----------
    record : the study
    directory : where the files go; made if it is missing
    """
    return tuple(
        save(draw(record), directory, name, title)
        for name, title, draw in (
            ("amplitude", "Amplitude over speed", amplitude_figure),
            ("liquid", "Liquid's centre of mass over speed", liquid_figure),
            ("phase", "Phase of the deflection over speed", phase_figure),
            ("chamber", "Chamber seen along the axis", chamber_figure),
        )
    )


def save(figure: Figure, directory: Path, name: str, title: str) -> FigureFiles:
    """Write one figure as PNG and SVG, without the time of writing.

    Parameters
    ----------
    figure : to write
    directory : where its files go; made if it is missing
    name, title : stem of the files, what the figure shows
    """
    files = FigureFiles(name, title, directory / f"{name}.png", directory / f"{name}.svg")
    FigureCanvasAgg(figure)
    with style():
        with replacing(files.png) as path:
            metadata = {"Software": None, "Title": title}
            # The usual level 6 takes a tenth of all drawing for a few per cent of the size.
            figure.savefig(path, format="png", metadata=metadata, pil_kwargs={"compress_level": 3})
        with replacing(files.svg) as path:
            figure.savefig(path, format="svg", metadata={"Date": None, "Creator": "leblanc", "Title": title})
    return files


def _over_speed(record: StudyRecord, panels: Sequence[tuple[float, Draw]], text: str) -> Figure:
    """Panels above one another that share the speed, in rpm below and in rad/s above."""
    curves = prepare(record)
    with style():
        figure = Figure()
        rows = []
        for i, (_, draw) in enumerate(panels):
            axes = figure.add_axes((0, 0, 1, 1), label=str(i))
            draw(axes, curves, record)
            axes.xaxis.set_major_formatter(FuncFormatter(_number))
            if not axes.yaxis.get_label_text().endswith("(deg)"):
                axes.yaxis.set_major_formatter(FuncFormatter(_number))
                axes.yaxis.set_minor_formatter(NullFormatter())
            else:
                axes.yaxis.set_major_locator(MultipleLocator(45.0))
            rows.append([axes])
        for (axes,) in rows[:-1]:
            axes.tick_params(labelbottom=False)
        axes = rows[-1][0]
        axes.set_xlabel("Speed (rpm)")
        above = rows[0][0].secondary_xaxis("top", functions=(_to_rate, _to_rpm))
        above.set_xlabel("Speed (rad/s)")
        above.xaxis.set_major_formatter(FuncFormatter(_number))
        _lay_out(figure, rows, [height for height, _ in panels], SPEED_FRAME, _caption(record, text))
    return figure


def _to_rate(rpm: ArrayLike) -> ArrayLike:
    return np.asarray(rpm) / RPM


def _to_rpm(rate: ArrayLike) -> ArrayLike:
    return np.asarray(rate) * RPM


def _number(value: float, _position: int | None = None) -> str:
    """Tick label without an offset or a common factor elsewhere on the axis."""
    return f"{value:.10g}".replace("-", "\N{MINUS SIGN}")


def _lay_out(
    figure: Figure, rows: list[list[Axes]], heights: list[float], frame: Frame, caption: str
) -> None:
    """Size of the figure, places of its axes, and below them the legend and the caption."""
    entries: dict[str, Any] = {}
    for axes in [axes for row in rows for axes in row]:
        handles, labels = axes.get_legend_handles_labels()
        entries = dict(zip(labels, handles, strict=True)) | entries
    lines = _wrapped(caption, WIDTH - 2.0 * RIGHT)
    text = CAPTION_ROW * len(lines) + 2.0 * MARGIN
    columns = max(1, min(4, LEGEND_CHARACTERS // (max(map(len, entries), default=0) + 8)))
    legend = LEGEND_ROW * -(-len(entries) // columns) + MARGIN
    total = frame.top + sum(heights) + frame.between * (len(rows) - 1) + frame.below + legend + text
    figure.set_size_inches(WIDTH, total)
    above = frame.top
    for row, height in zip(rows, heights, strict=True):
        width = (WIDTH - frame.left - RIGHT) / len(row)
        for i, axes in enumerate(row):
            left, bottom = frame.left + i * width, total - above - height
            axes.set_position((left / WIDTH, bottom / total, width / WIDTH, height / total))
        above += height + frame.between
    place = {"loc": "lower center", "bbox_to_anchor": (0.5, text / total), "borderaxespad": 0.0}
    figure.legend(entries.values(), entries.keys(), ncols=columns, borderpad=0.0, **place)
    for i, line in enumerate(reversed(lines)):
        height = MARGIN + CAPTION_ROW * (i + 0.25)
        figure.text(RIGHT / WIDTH, height / total, line, fontsize=CAPTION_SIZE, color="0.25")


def _caption(record: StudyRecord, text: str) -> str:
    """What the figure shows, the scene, the model and the values it assumes."""
    assumed = ", ".join(map(one_line, record.assumed)) or "nothing"
    model = ", ".join(models_used(record.response))
    return f"{text} Scene: {one_line(record.name)}. Liquid model: {model}. Assumed: {assumed}."


@cache
def _advance(character: str) -> float:
    """Width of a character of the caption, inches; 0 if the font does not have it."""
    font = get_font(findfont("DejaVu Sans"))
    font.set_size(CAPTION_SIZE, 72)
    known = font.get_char_index(ord(character)) > 0
    return float(font.load_char(ord(character)).linearHoriAdvance) / 65536.0 / 72.0 if known else 0.0


def _wrapped(text: str, width: float) -> list[str]:
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
    return (
        lines if len(lines) <= MOST_LINES else [*lines[: MOST_LINES - 1], lines[MOST_LINES - 1][:-3] + "..."]
    )
