"""The figures of a study and of a wave, as PNG and SVG, and the film of a wave.

Figures are drawn on the object interface: to import pyplot costs more than to draw them all. This package is
the only door to matplotlib.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MultipleLocator, NullFormatter
from numpy.typing import ArrayLike

from leblanc.figures import campbell, chamber, over_speed, wave, wave_axes, wave_time
from leblanc.figures.caption import caption, zero_of
from leblanc.figures.curves import Curves, prepare
from leblanc.figures.page import (
    FILM_DPI,
    MOST_LINES,
    RIGHT,
    WIDTH,
    Frame,
    lay_out,
    number,
    require_film,
    write_film,
)
from leblanc.figures.page import FigureFiles as FigureFiles  # what a caller of this package needs
from leblanc.figures.page import save as save
from leblanc.figures.page import style as style
from leblanc.results.layer import Wave, WaveFrames
from leblanc.results.record import StudyRecord
from leblanc.units import MM, RPM

Draw = Callable[[Axes, Curves, StudyRecord], None]
DrawTime = Callable[[Axes, Wave, WaveFrames], None]

SPEED_FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
CHAMBER_FRAME = Frame(left=0.15, top=0.26, between=0.6, below=0.36)
WAVE_FRAME = Frame(left=0.1, top=0.1, between=0.0, below=0.44)
FILM_FRAME = Frame(left=0.1, top=0.28, between=0.0, below=0.26)
TIME_FRAME = Frame(left=0.72, top=0.12, between=0.12, below=0.4)
HEADING_ROW = 0.14
WAVE_HEIGHT, PROFILE_LEFT, PROFILE_BELOW, ASIDE = 2.75, 3.55, 0.15, 0.15  # inches
NOTED_LINES = 10  # of a caption with notes
RPM_ROOM = 0.42  # for a second axis on the right, inches


def amplitude_figure(record: StudyRecord) -> Figure:
    """Amplitude over speed with and without liquid."""
    text = "Amplitude of the deflection."
    if record.motion is not None:
        text = f"Largest radius of the axis' orbit at {number(record.motion.position * MM)} mm."
    return _over_speed(record, [(2.75, over_speed.draw_amplitude)], text)


def liquid_figure(record: StudyRecord) -> Figure:
    """Distance and angle of the liquid's centre of mass over speed."""
    panels = [(1.55, over_speed.draw_offset), (1.55, over_speed.draw_angle)]
    text = f"Centre of mass of the liquid: distance from the rotation axis, angle from {zero_of(record)}."
    return _over_speed(record, panels, text)


def phase_figure(record: StudyRecord) -> Figure:
    """Phase of the deflection over speed with and without liquid."""
    text = f"Angle from {zero_of(record)} to the deflection; a lag is negative."
    return _over_speed(record, [(2.75, over_speed.draw_phase)], text)


def chamber_figure(record: StudyRecord) -> Figure:
    """Chambers as seen along the axis at the largest deflection and at the working speed."""
    views = chamber.choose_views(record)
    zero = "unbalance" if record.motion is None else record.motion.zero
    with style():
        figure = Figure()
        cells = [(drawing, index) for index in views.instants for drawing in views.drawings]
        if not cells:
            axes = figure.add_axes((0, 0, 1, 1), frame_on=False, xticks=[], yticks=[])
            axes.text(0.5, 0.5, "no chamber, or no deflection found", ha="center")
            lay_out(figure, [[axes]], [1.0], CHAMBER_FRAME, caption(record, "Chamber seen along the axis."))
            return figure
        drawn = []
        for i, (chambers, index) in enumerate(cells):
            axes = figure.add_axes((0, 0, 1, 1), label=str(i))
            at = chamber.moved(record, chambers, index)
            chamber.draw_chambers(axes, chambers, at, views, zero)
            if i % len(views.drawings) == 0:
                chamber.write_numbers(axes, record, views, index)
            drawn.append(axes)
        # Up to two drawings of each view stand in one row, more in a row for each view.
        columns = len(drawn) if len(views.drawings) < 3 else len(views.drawings)
        rows = [drawn[i : i + columns] for i in range(0, len(drawn), columns)]
        sides = [min(2.7, (WIDTH - CHAMBER_FRAME.left - RIGHT) / columns)] * len(rows)
        part = "" if record.motion is None else " Drawn is the part of the motion that turns with the spin."
        words = caption(record, f"Chamber seen along the axis. {chamber.describe_scale(views)}{part}")
        more = HEADING_ROW * chamber.more_heading_rows(record, views)
        frame = replace(CHAMBER_FRAME, top=CHAMBER_FRAME.top + more, between=CHAMBER_FRAME.between + more)
        lay_out(figure, rows, sides, frame, words, MOST_LINES if record.motion is None else NOTED_LINES)
    return figure


def campbell_figure(record: StudyRecord) -> Figure:
    """Natural frequencies of the dry rotor over its speed."""
    with style():
        figure = Figure()
        axes = figure.add_axes((0, 0, 1, 1))
        campbell.draw_campbell(axes, record)
        for scale in (axes.xaxis, axes.yaxis):
            scale.set_major_formatter(FuncFormatter(number))
        above = axes.secondary_xaxis("top", functions=(_to_rate, _to_rpm))
        above.set_xlabel("Speed (rad/s)")
        text = "Damped natural frequencies without liquid, by the sense in which the axis goes round."
        lay_out(figure, [[axes]], [2.75], SPEED_FRAME, caption(record, text))
    return figure


def wave_figure(record: Wave) -> Figure:
    """The layer seen along the axis and its depth around the wall, in the frame of the deflection."""
    deepest = float(np.max(record.depth))
    factor = wave.depth_factor(record, max(deepest, record.mean_depth))
    with style():
        figure = Figure()
        left, right = (figure.add_axes((0, 0, 1, 1), label=name) for name in ("annulus", "profile"))
        wave_axes.draw_annulus(left, record, factor)
        wave_axes.draw_profile(right, record)
        right.yaxis.set_major_formatter(FuncFormatter(number))
        text = (
            f"{wave_axes.describe_depths(factor)}; arrows show directions, the place of the centre of mass "
            "is not exaggerated. Force ratio: force over that of a full drum; angles from the deflection, "
            "positive with the spin. "
            f"{wave_axes.describe_case(record)}{wave_axes.describe_notes(record)}"
        )
        _beside(figure, left, right, WAVE_FRAME, text)
    return figure


def history_figure(record: Wave, history: WaveFrames) -> Figure:
    """Force, mean rotation and depths over time; the first two only if the history has periods."""
    record.require_room(history)
    panels: list[tuple[float, DrawTime]] = [(1.2, wave_time.draw_depths)]
    text = "Largest and smallest depth around the wall."
    if history.period_time is not None:
        panels = [(1.5, wave_time.draw_force), (1.0, wave_time.draw_rotation), *panels]
        text = (
            "Force on the drum over that of a full drum and the liquid's mean rotation in the drum, each the "
            f"mean over a period of the whirl seen from the drum. {text}"
        )
    with style():
        figure = Figure()
        rows = [[figure.add_axes((0, 0, 1, 1), label=str(i))] for i in range(len(panels))]
        first, last = float(history.time[0]), float(history.time[-1])
        margin = 0.02 * (last - first) if last > first else 0.5
        for (axes,), (_, draw) in zip(rows, panels, strict=True):
            draw(axes, record, history)
            axes.set_xlim(first - margin, last + margin)
            for scale in (axes, *axes.child_axes):
                scale.yaxis.set_major_formatter(FuncFormatter(number))
            axes.tick_params(labelbottom=axes is rows[-1][0])
        rows[-1][0].set_xlabel("Time (s)")
        words = f"{text} {wave_axes.describe_case(record)}{wave_axes.describe_notes(record)}"
        lay_out(figure, rows, [height for height, _ in panels], TIME_FRAME, words, NOTED_LINES)
        for (axes,) in rows:
            box = axes.get_position()
            axes.set_position((box.x0, box.y0, box.width - RPM_ROOM / WIDTH, box.height))
    return figure


def animate(
    record: Wave, history: WaveFrames, path: Path, drawn: Callable[[int, int], None] | None = None
) -> int:
    """Write the film of a wave, in the frame of the drum.

    One history gives the same GIF byte for byte, as long as the versions of matplotlib and Pillow stay the
    same.

    Parameters
    ----------
    record, history : what to show; of a long history its end, as much of it as 120 frames can follow
    path : a .gif, or an .mp4 if there is an ffmpeg
    drawn : called after each frame with the number of frames drawn and of all

    Returns
    -------
    Number of frames.

    Raises
    ------
    InputError : another kind of file, an .mp4 without an ffmpeg, a layer deeper than the wall's radius
    """
    require_film(path)
    record.require_room(history)
    frames = wave.frames(record, history).tolist()
    return write_film(lambda: _film(record, history), frames, wave.FRAME_RATE, path, drawn)


def _film(record: Wave, history: WaveFrames) -> tuple[Figure, Callable[[int], None]]:
    """Figure of a film and what sets it to the time of an index."""
    with style():
        figure = Figure()
        left, right = (figure.add_axes((0, 0, 1, 1), label=name) for name in ("annulus", "profile"))
        show = wave_time.film(left, right, record, history)
        right.yaxis.set_major_formatter(FuncFormatter(number))
        text = f"{wave_time.describe_film(record, history)} {wave_axes.describe_case(record)}"
        _beside(figure, left, right, FILM_FRAME, text)
        # Video codecs halve both sides of a picture for its colours.
        figure.set_size_inches(WIDTH, 2.0 * math.ceil(0.5 * FILM_DPI * figure.get_figheight()) / FILM_DPI)
    return figure, show


def _beside(figure: Figure, left: Axes, right: Axes, frame: Frame, caption: str) -> None:
    """A drawing and a plot side by side, the plot with room for its labels."""
    lay_out(figure, [[left, right]], [WAVE_HEIGHT], frame, caption, NOTED_LINES)
    total, box = figure.get_figheight(), right.get_position()
    x, y = PROFILE_LEFT / WIDTH, box.y0 + PROFILE_BELOW / total
    right.set_position((x, y, 1.0 - RIGHT / WIDTH - x, box.y1 - y))
    place = left.get_position()
    left.set_position((place.x0 - ASIDE / WIDTH, place.y0, place.width, place.height))


def write_figures(record: StudyRecord, directory: Path) -> tuple[FigureFiles, ...]:
    """Draw all figures of a study and write each as PNG and SVG.

    One record gives the same files byte for byte, as long as the version of matplotlib stays the same.

    Parameters
    ----------
    record : the study
    directory : where the files go; made if it is missing
    """
    figures = [
        ("amplitude", "Amplitude over speed", amplitude_figure),
        ("liquid", "Liquid's centre of mass over speed", liquid_figure),
        ("phase", "Phase of the deflection over speed", phase_figure),
        ("chamber", "Chamber seen along the axis", chamber_figure),
    ]
    if record.motion is not None:
        figures.append(("campbell", "Natural frequencies over speed", campbell_figure))
    return tuple(save(draw(record), directory, name, title) for name, title, draw in figures)


def _over_speed(record: StudyRecord, panels: Sequence[tuple[float, Draw]], text: str) -> Figure:
    """Panels above one another that share the speed, in rpm below and in rad/s above."""
    curves = prepare(record)
    with style():
        figure = Figure()
        rows = []
        for i, (_, draw) in enumerate(panels):
            axes = figure.add_axes((0, 0, 1, 1), label=str(i))
            draw(axes, curves, record)
            axes.xaxis.set_major_formatter(FuncFormatter(number))
            if not axes.yaxis.get_label_text().endswith("(deg)"):
                axes.yaxis.set_major_formatter(FuncFormatter(number))
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
        above.xaxis.set_major_formatter(FuncFormatter(number))
        lay_out(figure, rows, [height for height, _ in panels], SPEED_FRAME, caption(record, text))
    return figure


def _to_rate(rpm: ArrayLike) -> ArrayLike:
    return np.asarray(rpm) / RPM


def _to_rpm(rate: ArrayLike) -> ArrayLike:
    return np.asarray(rate) * RPM
