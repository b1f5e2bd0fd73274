"""The figure of a chart of stability of balls: regions and the curves between them."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import (
    Caption,
    Figure,
    FigureFiles,
    Frame,
    add_rate_axis,
    lay_out,
    number,
    save,
    style,
)
from leblanc.results.base import one_line
from leblanc.results.motion.ball_chart import BallChart
from leblanc.text.races.chart import CURVES, STATES, alt, answer, what
from leblanc.units import RPM, unit_for
from meshes.arrays import Array

Axes = Any  # matplotlib's

FRAME = Frame(left=0.8, top=0.46, between=0.14, below=0.42)
TITLE = "Where the balls are stable"
PANEL = 3.2  # inches
STABLE = {"colors": ["#CFE6F5"], "hatches": ["//"]}
_MISSING = {"facecolor": "0.94", "hatch": "xx", "edgecolor": "0.72", "linewidth": 0.0}
# Red, green and blue of one growing root, two, three, four and more.
_GROWING = ((0.98, 0.89, 0.78), (0.95, 0.70, 0.48), (0.85, 0.47, 0.23), (0.65, 0.29, 0.12))
LOOKS = {
    "hopf": {"color": "#0072B2", "linestyle": "-", "linewidth": 1.6},
    "zero": {"color": "black", "linestyle": (0, (5, 2)), "linewidth": 1.4},
}
OWN = {"color": "black", "linewidth": 1.1, "linestyle": (0, (1, 1.5)), "zorder": 4}


def chart_figure(result: BallChart) -> Figure:
    """Regions over speed and the number that is varied.

    Parameters
    ----------
    result : the chart
    """
    unit = unit_for(result.dimension, *result.value[[0, -1]].tolist())
    with style():
        figure = Figure()
        figure.alt = alt(result)
        axes: Axes = figure.add_axes((0, 0, 1, 1))
        x, y = result.speed * RPM, result.value * unit.count
        axes.set_yscale("log" if result.log else "linear")
        _draw_regions(axes, result, x, y)
        _draw_missing(axes, result, x, y, unit.count)
        known: set[str] = set()
        for edge in result.edges:
            label = "_" if edge.kind in known else CURVES[edge.kind]
            known.add(edge.kind)
            axes.plot(edge.speed * RPM, edge.value * unit.count, label=label, zorder=3, **LOOKS[edge.kind])
        if math.isfinite(result.scene_value) and y[0] <= result.scene_value * unit.count <= y[-1]:
            own = result.scene_value * unit.count
            axes.axhline(own, label=f"scene: {unit.text(result.scene_value)}", **OWN)
        axes.set_xlim(x[0], x[-1])
        axes.set_ylim(y[0], y[-1])
        axes.grid(visible=False)
        axes.xaxis.set_major_formatter(number)
        axes.yaxis.set_major_formatter(number)
        axes.set_xlabel("Speed (rpm)")
        axes.set_ylabel(f"{what(result)} ({unit.name or chr(0x2013)})")
        add_rate_axis(axes)
        lay_out(figure, [[axes]], [PANEL], FRAME, _caption(result), most_lines=6)
    return figure


def write_chart_figure(result: BallChart, directory: Path) -> FigureFiles:
    """Draw the figure and write it as PNG and SVG.

    Parameters
    ----------
    result : the chart
    directory : where the files go; made if it is missing
    """
    return save(chart_figure(result), directory, "map", TITLE)


def _draw_regions(axes: Axes, result: BallChart, x: Array, y: Array) -> None:
    """Unstable ground in a shade for each number of growing roots, stable ground over it.

    The growth passes 0 nearly straight between two values, so that its contour is smoother than the cells.
    """
    growing, growth = _spread(result.growing, result.missing), _spread(result.growth, result.missing)
    count = _spread(growing, growing == 0)
    shades = np.array([(1.0, 1.0, 1.0), *_GROWING])[np.clip(count, 0, len(_GROWING))]
    axes.pcolormesh(x, y, shades, shading="nearest", rasterized=True, zorder=0.5)
    for roots in np.unique(result.growing[result.growing > 0]).tolist():
        shade = _GROWING[min(roots, len(_GROWING)) - 1]
        name = f"unstable: {roots} growing root{'' if roots == 1 else 's'}"
        axes.fill([], [], facecolor=shade, linewidth=0.0, label=name)
    if result.stable.any():
        if (growing > 0).any():
            stable = axes.contourf(x, y, growth, levels=[-np.inf, 0.0], zorder=0.8, **STABLE)
        else:
            stable = axes.contourf(x, y, np.zeros_like(growth), levels=[-1.0, 1.0], zorder=0.8, **STABLE)
        stable.set(edgecolor="#7FB2D5", linewidth=0.0)
        axes.fill(
            [], [], facecolor="#CFE6F5", hatch="///", edgecolor="#7FB2D5", linewidth=0.0, label="stable"
        )


def _draw_missing(axes: Axes, result: BallChart, x: Array, y: Array, count: float) -> None:
    """Ground where there is no such state; where it ends at a value, up to that."""
    if not result.missing.any():
        return
    if result.state == "balanced":
        ends = [float(y[0]), *(bound * count for bound in result.bounds), float(y[-1])]
        there = bool(result.missing[0, 0])
        for low, high in pairwise(ends):
            if there:
                axes.axhspan(low, high, zorder=1.0, **_MISSING)
            there = not there
    else:
        none = np.where(result.missing, 1.0, 0.0)
        area = axes.contourf(x, y, none, levels=[0.5, 1.5], colors=["0.94"], hatches=["xx"], zorder=1.0)
        area.set(edgecolor="0.72", linewidth=0.0)
    axes.fill([], [], label="no such state", **_MISSING)


def _spread(values: np.ndarray, lost: np.ndarray) -> np.ndarray:
    """Values where some are lost: those of the nearest cell that is not."""
    if not lost.any() or lost.all():
        return values
    from scipy.ndimage import distance_transform_edt

    nearest = distance_transform_edt(lost, return_distances=False, return_indices=True)
    return np.asarray(values[tuple(nearest)])


def _caption(result: BallChart) -> Caption:
    assumed = ", ".join(map(one_line, result.assumed)) or "nothing"
    varied = ", ".join(result.paths)
    return Caption(
        f"Stability of {STATES[result.state]} by the roots of small motions, over speed and {varied}. "
        f"{answer(result)}",
        f"Scene: {one_line(result.name)}, {result.axis} axis. Assumed: {assumed}.",
    )
