"""The figures of a wave in a layer and over time, and its film."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.page import (
    FILM_DPI,
    RIGHT,
    WIDTH,
    Figure,
    Frame,
    lay_out,
    number,
    require_film,
    style,
    write_film,
)
from leblanc.figures.wave import axes as wave_axes
from leblanc.figures.wave import picture as wave
from leblanc.figures.wave import time as wave_time
from leblanc.results.layer import LayerPeriodsResult, LayerResult, Wave, WaveFrames
from leblanc.units import MM

Axes = Any  # matplotlib's, which no module that only draws imports
DrawTime = Callable[[Axes, Wave, WaveFrames], None]

WAVE_FRAME = Frame(left=0.1, top=0.1, between=0.0, below=0.44)
FILM_FRAME = Frame(left=0.1, top=0.28, between=0.0, below=0.26)
TIME_FRAME = Frame(left=0.72, top=0.12, between=0.12, below=0.4)
WAVE_HEIGHT, PROFILE_LEFT, PROFILE_BELOW, ASIDE = 2.75, 3.55, 0.15, 0.15  # inches
NOTED_LINES = 10  # of a caption with notes
RPM_ROOM = 0.42  # for a second axis on the right, inches


def wave_figure(record: Wave) -> Figure:
    """The layer seen along the axis and its depth around the wall, in the frame of the deflection."""
    deepest = float(np.max(record.depth))
    factor = wave.depth_factor(record, max(deepest, record.mean_depth))
    with style():
        figure = Figure()
        left, right = (figure.add_axes((0, 0, 1, 1), label=name) for name in ("annulus", "profile"))
        wave_axes.draw_annulus(left, record, factor)
        wave_axes.draw_profile(right, record)
        right.yaxis.set_major_formatter(number)
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
                scale.yaxis.set_major_formatter(number)
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
        right.yaxis.set_major_formatter(number)
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


def layer_figure(result: LayerResult) -> Figure:
    """The main figure of a layer's answer."""
    return wave_figure(result.wave())


def periods_figure(result: LayerPeriodsResult) -> Figure:
    """Force on the drum and mean rotation over the whirl periods of a layer that starts from rest."""
    h, model = result.history, result.case.model
    with style():
        figure = Figure()
        rows = [[figure.add_axes((0, 0, 1, 1), label=name)] for name in ("force", "rotation", "depths")]
        force, rotation, depths = (row[0] for row in rows)
        force.plot(h.time, h.force_ratio.real, marker="o", label="force along the deflection")
        force.plot(h.time, h.force_ratio.imag, marker="s", linestyle="--", label="force 90 deg ahead of it")
        force.set_ylabel("Force ratio (-)")
        rotation.plot(h.time, h.mean_rotation, color="0.15", marker="^", label="mean rotation in the drum")
        rotation.set_ylabel("Rotation (rad/s)")
        depths.plot(h.time, h.depth_max * MM, label="crest")
        depths.plot(h.time, h.depth_min * MM, linestyle="--", label="trough")
        depths.set_ylabel("Depth (mm)")
        depths.set_xlabel("Time (s)")
        for axes in (force, rotation):
            axes.tick_params(labelbottom=False)
        text = f"Means over periods of the whirl seen from the drum. Liquid model: {model}."
        lay_out(figure, rows, [1.5, 1.0, 1.2], TIME_FRAME, text, NOTED_LINES)
        figure.alt = "Curves over time of the force on the drum, the liquid's rotation and its depths."
    return figure
