"""The designs of balls that were tried, and what the best of them does over speed."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import MM, MM_PEAK, RPM
from leblanc.figures.drawing.curves import gapped
from leblanc.figures.drawing.page import Caption, Figure, FigureFiles, Frame, lay_out, number, save, style
from leblanc.results.races.design import BallDesignResult
from leblanc.studies.run.figure import DRY, WET
from leblanc.text.races.design import alt, answer
from meshes.arrays import Flags

FRAME = Frame(left=0.72, top=0.14, between=0.14, below=0.42, gaps=(0.14, 0.56))
TITLE = "Designs of balls and the best of them"
BEST, BALANCED = "#009E73", "#E4F1EC"
_LOOKS = (  # colour and mark of a number of balls
    ("#0072B2", "o"),
    ("#CC79A7", "s"),
    ("#E69F00", "^"),
    ("#56B4E9", "D"),
    ("0.45", "v"),
)
_FAR = 1.5  # times the amplitude without balls: designs beyond are left out of the picture
_GRAM = 1e3


def design_figure(result: BallDesignResult) -> Figure:
    """Amplitude and decay over mass of the designs, amplitude over speed of the best."""
    with style():
        figure = Figure()
        figure.alt = alt(result)
        above: Any = figure.add_axes((0, 0, 1, 1), label="designs")
        middle: Any = figure.add_axes((0, 0, 1, 1), label="decay")
        below: Any = figure.add_axes((0, 0, 1, 1), label="speed")
        _draw_designs(above, result)
        _draw_decay(middle, result)
        middle.set_xlim(above.get_xlim())
        above.tick_params(labelbottom=False)
        _draw_speeds(below, result)
        for axes in (above, middle, below):
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
        panels, heights = [[above], [middle], [below]], [1.8, 1.6, 1.9]
        lay_out(figure, panels, heights, FRAME, _caption(result), most_lines=7)
    return figure


def write_design_figure(result: BallDesignResult, directory: Path) -> FigureFiles:
    """Draw the figure and write it as PNG and SVG."""
    return save(design_figure(result), directory, "design", TITLE)


def _draw_designs(axes: Any, result: BallDesignResult) -> None:
    """Designs that keep to all constraints, a mark for each number of balls, and those that do not."""
    tried, top = result.tried, _FAR * result.vibration_without
    within = np.isfinite(tried.vibration) & (tried.vibration <= top)
    kept = within & (tried.excess <= 1e-9)
    look = {"linestyle": "none", "markersize": 2.6}
    broken = within & ~kept
    if broken.any():
        axes.plot(
            tried.mass[broken] * _GRAM,
            tried.vibration[broken] * MM,
            marker="x",
            color="0.7",
            label="breaks a constraint",
            **look,
        )
    for counts, label, (color, mark) in _groups(result, kept):
        axes.plot(
            tried.mass[counts] * _GRAM,
            tried.vibration[counts] * MM,
            marker=mark,
            color=color,
            markerfacecolor="none",
            markeredgewidth=0.7,
            label=label,
            **look,
        )
    axes.axhline(result.vibration_without * MM, color=DRY, linestyle=(0, (1, 1.5)), label="without balls")
    if math.isfinite(result.vibration):
        star = {"marker": "*", "markersize": 12.0, "color": BEST, "markeredgecolor": "black"}
        axes.plot(
            [result.mass * _GRAM],
            [result.vibration * MM],
            linestyle="none",
            label="best",
            zorder=4,
            clip_on=False,
            **star,
        )
    axes.set_ylim(-0.03 * top * MM, top * MM)
    axes.set_ylabel(f"Amplitude ({MM_PEAK})")


def _draw_decay(axes: Any, result: BallDesignResult) -> None:
    """How quickly small motions of the same designs fade: what tells designs apart that balance alike."""
    tried = result.tried
    kept = np.isfinite(tried.vibration) & (tried.vibration <= _FAR * result.vibration_without)
    kept &= (tried.excess <= 1e-9) & np.isfinite(tried.growth)
    for counts, _, (color, mark) in _groups(result, kept):
        look = {"linestyle": "none", "markersize": 2.6, "marker": mark, "color": color}
        look |= {"markerfacecolor": "none", "markeredgewidth": 0.7, "label": "_"}
        axes.plot(tried.mass[counts] * _GRAM, -tried.growth[counts], **look)
    if math.isfinite(result.growth):
        star = {"marker": "*", "markersize": 12.0, "color": BEST, "markeredgecolor": "black", "label": "_"}
        axes.plot([result.mass * _GRAM], [result.stability_margin], linestyle="none", zorder=4, **star)
    axes.set_xlabel("Mass of all balls (g)")
    axes.set_ylabel("Decay (1/s)")


def _groups(result: BallDesignResult, kept: Flags) -> list[tuple[Flags, str, tuple[str, str]]]:
    """Numbers of balls of the designs, the larger ones together where there are many."""
    counts = np.unique(result.tried.count[kept]).tolist()
    found: list[tuple[Flags, str, tuple[str, str]]] = []
    for k, count in enumerate(counts):
        if k == len(_LOOKS) - 1 and len(counts) > len(_LOOKS):
            more = kept & (result.tried.count >= count)
            found.append((more, f"{count} balls and more", _LOOKS[k]))
            break
        own = kept & (result.tried.count == count)
        found.append((own, f"{count} ball{'' if count == 1 else 's'}", _LOOKS[k]))
    return found


def _draw_speeds(axes: Any, result: BallDesignResult) -> None:
    """The best balls over the speeds of the scene, and where they balance."""
    run = result.response
    rpm, stable = run.speed * RPM, np.where(run.stable, run.amplitude, np.nan)
    bare = np.where(np.isfinite(run.amplitude_without), run.amplitude_without, np.nan)
    if math.isfinite(run.balanced_from):
        span = run.balanced_from * RPM, float(rpm[-1])
        axes.axvspan(*span, color=BALANCED, zorder=0, label="balanced state stable")
    axes.plot(rpm, bare * MM, color=DRY, linestyle=(0, (4, 2)), linewidth=1.1, label="without balls")
    breaks = np.zeros(max(rpm.size - 1, 0), dtype=bool)
    breaks[np.flatnonzero(run.state[1:] != run.state[:-1])] = True
    axes.plot(*gapped(rpm, stable * MM, breaks), color=WET, linewidth=1.6, label="best balls, stable state")
    axes.axvline(result.working_speed * RPM, color=BEST, linewidth=0.9, label="working speed")
    top = float(np.nanmax(np.concatenate((bare, stable, [0.0]))))
    axes.set_ylim(-0.02 * top * MM, 1.1 * top * MM or 1.0)
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel(f"Amplitude ({MM_PEAK})")


def _caption(result: BallDesignResult) -> Caption:
    assumed = ", ".join(map(one_line, result.assumed)) or "nothing"
    designs = (
        f"Above, designs that were judged: {result.meaning}, and the decay of small motions; below, the best "
        "over speed."
    )
    return Caption(
        f"{answer(result)} {designs}",
        f"Scene: {one_line(result.name)}. Objective: {result.objective}. Assumed: {assumed}.",
    )
