"""The amplitude over speed by several liquid models, and how far they are apart."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import MM, MM_PEAK, RPM
from leblanc.plotting.curves import COLUMNS, Span, spans, speed_limits, thin, windows
from leblanc.plotting.page import (
    Caption,
    Figure,
    Frame,
    add_rate_axis,
    add_windows,
    lay_out,
    number,
    style,
)
from leblanc.studies.compare.answer import CompareAnswer, comparison_alt
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.figure import DRY, OUT_OF_RANGE, SHADE, SHARE, value_axis, wider_words
from leblanc.studies.run.notes import plane_label
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports
Line = tuple[Array, Array]

FRAME = Frame(left=0.9, top=0.46, between=0.12, below=0.42)
AMPLITUDE, DIFFERENCE = 2.6, 1.3  # inches
_SWING = 1e-3  # of the largest amplitude: a narrower band looks like a line
LEAST = 1e-3  # per cent: a smaller difference looks like none
# Colours after Okabe and Ito, safe for the colour blind; each model has a style of line and a width as well,
# so that equal lines stay visible on top of one another.
LOOKS = (
    {"color": "#0072B2", "linestyle": "-", "linewidth": 3.0},
    {"color": "#E69F00", "linestyle": (0, (4, 1.5)), "linewidth": 2.2},
    {"color": "#009E73", "linestyle": (0, (1, 1.2)), "linewidth": 2.0},
    {"color": "#CC79A7", "linestyle": (0, (6, 1.5, 1, 1.5)), "linewidth": 1.6},
    {"color": "#56B4E9", "linestyle": (0, (2, 2)), "linewidth": 1.3},
    {"color": "black", "linestyle": "-", "linewidth": 0.8},
)


def comparison_figure(found: CompareAnswer) -> Figure:
    """Amplitude of each model over speed; below, where there are several, their differences."""
    with style():
        figure = Figure()
        figure.alt = comparison_alt(found)
        limits = speed_limits(found.speed)
        whole = _panels(figure, found, limits, "")
        add_rate_axis(whole[0])
        for axes in whole[:-1]:
            axes.tick_params(labelbottom=False)
        heights = [AMPLITUDE, DIFFERENCE][: len(whole)]
        curves = [result.curve for result in found.results.values()]
        lines = [_drawn(curve.speed, curve.amplitude) for curve in curves]
        lines.append(_drawn(curves[0].speed, curves[0].amplitude_dry))
        wider = windows(lines, limits)
        if wider:
            parts = [_panels(figure, found, span, f", part {k + 1}") for k, span in enumerate(wider)]
            text = replace(_caption(found), shown=f"{_caption(found).shown} {wider_words()}")
            wide = list(zip(*parts, strict=True))
            for axes in [*whole, *(axes for part in parts for axes in part)]:
                axes.set_ylabel(_two_lines(axes.get_ylabel()))
            add_windows(figure, whole, wide, [SHARE * height for height in heights] * 2, text, FRAME.left)
        else:
            whole[-1].set_xlabel("Speed (rpm)")
            lay_out(figure, [[axes] for axes in whole], heights, FRAME, _caption(found))
    return figure


def _two_lines(label: str) -> str:
    """A label for a panel that is lower than the label is long."""
    return label.replace(" at ", "\nat ") if " at " in label else label.replace(" (", "\n(")


def _panels(figure: Figure, found: CompareAnswer, limits: Span, part: str) -> list[Axes]:
    """Amplitudes and, of several models, differences over a span of speed."""
    names = list(found.results)
    labels = ("amplitude", "difference")[: len(names)]
    panels = [figure.add_axes((0, 0, 1, 1), label=f"{label}{part}") for label in labels]
    _draw_amplitude(panels[0], found, limits)
    result = next(iter(found.results.values()))
    place = "" if result.motion is None else plane_label(bool(result.chambers))
    panels[0].set_ylabel(f"Amplitude{place} ({MM_PEAK})")
    if len(panels) > 1:
        order = np.argsort(found.speed, kind="stable")
        apart = [100.0 * found.difference(name)[order] for name in names]
        drawn = thin(np.column_stack(apart), COLUMNS)
        rpm = found.speed[order][drawn] * RPM
        _draw_difference(panels[1], names, [_inside((rpm, line[drawn]), limits) for line in apart])
    for axes in panels:
        _background(axes, found, limits)
        axes.xaxis.set_major_formatter(number)
        axes.yaxis.set_major_formatter(number)
        axes.yaxis.set_minor_formatter("")
    return panels


def _drawn(speed: Array, amplitude: Array) -> Line:
    """A line in rpm and mm, with as many points as show, by rising speed."""
    order = np.argsort(speed, kind="stable")
    line = np.where(np.isfinite(amplitude), amplitude, np.nan)[order] * MM
    kept = thin(line[:, None], COLUMNS)
    return speed[order][kept] * RPM, line[kept]


def _inside(line: Line, limits: Span) -> Line:
    """The part of a line within a span of speed, and one point beyond either end of it."""
    x, y = line
    first = max(int(np.searchsorted(x, limits[0], side="right")) - 1, 0)
    last = int(np.searchsorted(x, limits[1], side="left")) + 1
    return x[first:last], y[first:last]


def _draw_amplitude(axes: Axes, found: CompareAnswer, limits: Span) -> None:
    """Amplitude by every model that answers, each with its own speeds, and without liquid."""
    marker = "o" if found.speed.size == 1 else None
    curves = {name: result.curve for name, result in found.results.items()}
    lines = [_inside(_drawn(curve.speed, curve.amplitude), limits) for curve in curves.values()]
    for name, line, look in zip(curves, lines, LOOKS, strict=False):
        axes.plot(*line, label=name, marker=marker, **look)
    for (name, result), look in zip(found.results.items(), LOOKS, strict=False):
        _draw_swing(axes, name, result, look["color"])
    reference = curves[found.reference]
    bare = _inside(_drawn(reference.speed, reference.amplitude_dry), limits)
    even = np.linspace(bare[0][0], bare[0][-1], 14)
    marks = np.unique(np.clip(np.searchsorted(bare[0], even), 0, bare[0].size - 1)).tolist()
    looks = {"color": DRY, "linewidth": 0.8, "marker": "o", "markerfacecolor": "white", "markevery": marks}
    axes.plot(*bare, label="without liquid", zorder=1.9, **looks)
    value_axis(axes, 0.0, [*lines, bare])


def _draw_swing(axes: Axes, name: str, result: RunAnswer, color: object) -> None:
    """From the least to the largest distance over time of a motion that was held, where the two differ."""
    if result.held is None:
        return
    order = np.argsort(result.speed, kind="stable")
    least, most = result.amplitude_min[order] * MM, result.amplitude_max[order] * MM
    if not np.any(most - least > _SWING * np.nanmax(most)):
        return
    marker = {"linewidth": 5.0} if result.speed.size == 1 else {"linewidth": 0.0}
    label = f"{name}, least to largest over time"
    axes.fill_between(
        result.speed[order] * RPM, least, most, color=color, alpha=0.25, zorder=1.5, label=label, **marker
    )


def _draw_difference(axes: Axes, names: list[str], lines: list[Line]) -> None:
    marker = "o" if lines[0][0].size == 1 else None
    for name, line, look in zip(names, lines, LOOKS, strict=False):
        axes.plot(*line, label=name, marker=marker, **look)
    largest = max(float(np.nanmax(np.abs(line), initial=0.0)) for _, line in lines)
    axes.set_ylim(*(np.array([-1.1, 1.1]) * max(largest, LEAST)))
    axes.set_ylabel("Difference (%)")


def _background(axes: Axes, found: CompareAnswer, limits: Span) -> None:
    """Limits of the speed; where no model is in its range."""
    order = np.argsort(found.speed, kind="stable")
    rpm = found.speed[order] * RPM
    axes.set_xlim(*limits)
    outside = ~np.any([result.in_range[order] for result in found.results.values()], axis=0)
    for k, (left, right) in enumerate(spans(rpm, outside, speed_limits(found.speed))):
        label = "_" if k else f"every {OUT_OF_RANGE}"
        axes.axvspan(left, right, color=SHADE, linewidth=0, zorder=0, label=label)
    axes.set_xlim(*limits)


def _caption(found: CompareAnswer) -> Caption:
    """What is shown, the scene, what did not answer, what is assumed."""
    assumed = assumed_words(found.assumed)
    below = (
        f" Below, less that of {found.reference}, as a share of its largest amplitude."
        if len(found.results) > 1
        else ""
    )
    silent = [answer.model for answer in found.answers if not answer.answered]
    missing = f" Models that do not answer it: {', '.join(silent)}." if silent else ""
    held = any(result.held is not None for result in found.results.values())
    swing = " Bands: from the least to the largest over time of motions held." if held else ""
    return Caption(
        f"Amplitude of the deflection by each liquid model.{swing}{below}",
        f"Scene: {one_line(found.name)}.{missing} Assumed: {assumed}.",
    )
