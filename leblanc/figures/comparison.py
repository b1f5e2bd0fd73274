"""The amplitude over speed by several liquid models, and how far they are apart."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.figures.curves import COLUMNS, spans, thin
from leblanc.figures.page import Caption, Figure, Frame, add_rate_axis, lay_out, number, style
from leblanc.figures.page import save as save  # a figure is drawn and written together
from leblanc.figures.response import DRY, OUT_OF_RANGE, SHADE, value_axis
from leblanc.results.base import one_line
from leblanc.results.explanation import Comparison
from leblanc.results.notes import plane_label
from leblanc.text.explanation import comparison_alt
from leblanc.units import MM, RPM
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
AMPLITUDE, DIFFERENCE = 2.6, 1.3  # inches
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


def comparison_figure(found: Comparison) -> Figure:
    """Amplitude of each model over speed; below, where there are several, their differences."""
    order = np.argsort(found.speed, kind="stable")
    names = list(found.results)
    apart = [100.0 * found.difference(name)[order] for name in names]
    drawn = thin(np.column_stack(apart), COLUMNS)
    rpm = found.speed[order][drawn] * RPM
    with style():
        figure = Figure()
        figure.alt = comparison_alt(found)
        labels = ("amplitude", "difference")[: len(names)]
        rows = [figure.add_axes((0, 0, 1, 1), label=label) for label in labels]
        _draw_amplitude(rows[0], found)
        result = next(iter(found.results.values()))
        place = "" if result.motion is None else plane_label(bool(result.chambers))
        rows[0].set_ylabel(f"Amplitude{place} (mm)")
        if len(rows) > 1:
            _draw_difference(rows[1], rpm, names, [line[drawn] for line in apart])
        for axes in rows:
            _background(axes, found)
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.yaxis.set_minor_formatter("")
        for axes in rows[:-1]:
            axes.tick_params(labelbottom=False)
        rows[-1].set_xlabel("Speed (rpm)")
        add_rate_axis(rows[0])
        heights = [AMPLITUDE, DIFFERENCE][: len(rows)]
        lay_out(figure, [[axes] for axes in rows], heights, FRAME, _caption(found))
    return figure


def _drawn(speed: Array, amplitude: Array) -> tuple[Array, Array]:
    """A line in rpm and mm, with as many points as show, by rising speed."""
    order = np.argsort(speed, kind="stable")
    line = np.where(np.isfinite(amplitude), amplitude, np.nan)[order] * MM
    kept = thin(line[:, None], COLUMNS)
    return speed[order][kept] * RPM, line[kept]


def _draw_amplitude(axes: Axes, found: Comparison) -> None:
    """Amplitude by every model that answers, each with its own speeds, and without liquid."""
    marker = "o" if found.speed.size == 1 else None
    curves = {name: result.curve for name, result in found.results.items()}
    lines = [_drawn(curve.speed, curve.amplitude) for curve in curves.values()]
    for name, line, look in zip(curves, lines, LOOKS, strict=False):
        axes.plot(*line, label=name, marker=marker, **look)
    reference = curves[found.reference]
    bare = _drawn(reference.speed, reference.amplitude_dry)
    even = np.linspace(bare[0][0], bare[0][-1], 14)
    marks = np.unique(np.clip(np.searchsorted(bare[0], even), 0, bare[0].size - 1)).tolist()
    looks = {"color": DRY, "linewidth": 0.8, "marker": "o", "markerfacecolor": "white", "markevery": marks}
    axes.plot(*bare, label="without liquid", zorder=1.9, **looks)
    value_axis(axes, 0.0, [*lines, bare])


def _draw_difference(axes: Axes, rpm: Array, names: list[str], lines: list[Array]) -> None:
    marker = "o" if rpm.size == 1 else None
    for name, line, look in zip(names, lines, LOOKS, strict=False):
        axes.plot(rpm, line, label=name, marker=marker, **look)
    largest = max(float(np.nanmax(np.abs(line), initial=0.0)) for line in lines)
    axes.set_ylim(*(np.array([-1.1, 1.1]) * max(largest, LEAST)))
    axes.set_ylabel("Difference (%)")


def _background(axes: Axes, found: Comparison) -> None:
    """Limits of the speed; where no model is in its range."""
    order = np.argsort(found.speed, kind="stable")
    rpm = found.speed[order] * RPM
    margin = 0.0 if rpm[0] < rpm[-1] else max(0.05 * float(rpm[0]), 1.0)
    limits = float(rpm[0]) - margin, float(rpm[-1]) + margin
    axes.set_xlim(*limits)
    outside = ~np.any([result.in_range[order] for result in found.results.values()], axis=0)
    for k, (left, right) in enumerate(spans(rpm, outside, limits)):
        label = "_" if k else f"every {OUT_OF_RANGE}"
        axes.axvspan(left, right, color=SHADE, linewidth=0, zorder=0, label=label)


def _caption(found: Comparison) -> Caption:
    """What is shown, the scene, what did not answer, what is assumed."""
    assumed = ", ".join(map(one_line, found.assumed)) or "nothing"
    below = (
        f" Below, less that of {found.reference}, as a share of its largest amplitude."
        if len(found.results) > 1
        else ""
    )
    silent = [answer.model for answer in found.answers if not answer.answered]
    missing = f" Models that do not answer it: {', '.join(silent)}." if silent else ""
    return Caption(
        f"Amplitude of the deflection by each liquid model.{below}",
        f"Scene: {one_line(found.name)}.{missing} Assumed: {assumed}.",
    )
