"""The figure of a chart of stability of balls: regions and the curves between them."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import RPM
from leblanc.plotting.page import (
    Caption,
    Figure,
    Frame,
    add_rate_axis,
    lay_out,
    number,
    style,
)
from leblanc.scene.schema.paths import path_words
from leblanc.studies.map.balls.answer import CURVES, STATES, BallChart, sentence
from meshes.arrays import Array, Flags, Indices

Axes = Any  # matplotlib's

FRAME = Frame(left=0.8, top=0.46, between=0.14, below=0.42)
PANEL = 3.2  # inches
STABLE = {"facecolor": "#CFE6F5", "hatch": "//", "edgecolor": "#7FB2D5", "linewidth": 0.0}
MISSING = {"facecolor": "0.94", "hatch": "xx", "edgecolor": "0.72", "linewidth": 0.0}
# Of one growing root, two, three, four and more.
_GROWING = ("#FBE3C8", "#F3B27A", "#D9793B", "#A64B1F")
LOOKS = {
    "hopf": {"color": "#0072B2", "linestyle": "-", "linewidth": 1.6},
    "zero": {"color": "black", "linestyle": (0, (5, 2)), "linewidth": 1.4},
}
BOUND = {"color": "0.35", "linestyle": "-.", "linewidth": 1.2}
_FINE, _MOST_PARTS = 900, 15  # cells of the image of the regions, and of one step of the grid
OWN = {"color": "black", "linewidth": 1.1, "linestyle": (0, (1, 1.5)), "zorder": 4}


def chart_figure(result: BallChart) -> Figure:
    """Regions over speed and the number that is varied."""
    unit = result.shown_unit
    with style():
        figure = Figure()
        figure.alt = (
            f"Chart of stability over speed and {result.varied}: regions that are stable, unstable by the "
            "number of growing roots, or without such a state, and the curves between them. "
            f"{sentence(result)}"
        )
        axes: Axes = figure.add_axes((0, 0, 1, 1))
        axes.set_yscale("log" if result.log else "linear")
        _draw_regions(axes, result, unit.count)
        known: set[str] = set()
        for edge in result.edges:
            label = "_" if edge.kind in known else CURVES[edge.kind]
            known.add(edge.kind)
            axes.plot(edge.speed * RPM, edge.value * unit.count, label=label, zorder=3, **LOOKS[edge.kind])
        for bound in result.bounds:
            axes.axhline(bound * unit.count, label="the state begins or ends", zorder=3, **BOUND)
        if math.isfinite(result.scene_value) and result.value[0] <= result.scene_value <= result.value[-1]:
            own = result.scene_value * unit.count
            axes.axhline(own, label=f"scene: {unit.text(result.scene_value)}", **OWN)
        axes.set_xlim(result.speed[0] * RPM, result.speed[-1] * RPM)
        axes.set_ylim(result.value[0] * unit.count, result.value[-1] * unit.count)
        axes.grid(visible=False)
        axes.xaxis.set_major_formatter(number)
        axes.yaxis.set_major_formatter(number)
        axes.set_xlabel("Speed (rpm)")
        axes.set_ylabel(f"{path_words(*result.paths)} ({unit.name or chr(0x2013)})")
        add_rate_axis(axes)
        lay_out(figure, [[axes]], [PANEL], FRAME, _caption(result))
    return figure


def _draw_regions(axes: Axes, result: BallChart, count: float) -> None:
    """Stable ground, unstable ground by the number of growing roots, ground without the state."""
    speed, value, growing = regions(result)
    x, y = speed * RPM, value * count
    seen = np.unique(growing).tolist()
    for roots in seen:
        look = _look(roots)
        own = np.where(growing == roots, 1.0, 0.0)
        hatch = [look.get("hatch")]
        area = axes.contourf(
            x, y, own, levels=[0.5, 1.5], colors=[look["facecolor"]], hatches=hatch, zorder=0.5
        )
        area.set(edgecolor=look.get("edgecolor", "none"), linewidth=0.0)
        axes.fill([], [], label=_label(roots), **look)


def _look(roots: int) -> dict[str, Any]:
    if roots <= 0:
        return STABLE if roots == 0 else MISSING
    return {"facecolor": _GROWING[min(roots, len(_GROWING)) - 1], "linewidth": 0.0}


def _label(roots: int) -> str:
    if roots <= 0:
        return "stable" if roots == 0 else "no such state"
    return f"unstable: {roots} growing root{'' if roots == 1 else 's'}"


def regions(result: BallChart) -> tuple[Array, Array, Indices]:
    """Speed, rad/s, value, SI, and number of growing roots, shape (q, p), between the points.

    Each place has the number of the nearest point of the grid that no curve parts from it; -1 for no such
    state.
    """
    from scipy.ndimage import distance_transform_edt, label

    rows, columns = result.growing.shape
    parts = max(1, min(_FINE // max(rows, columns), _MOST_PARTS))
    shape = (rows - 1) * parts + 1, (columns - 1) * parts + 1
    wall = np.zeros(shape, dtype=bool)
    for line in _lines(result):
        wall |= _drawn(line * parts, shape)
    number, areas = label(~wall)
    known = np.full(shape, -2, dtype=np.int64)
    known[::parts, ::parts] = result.growing
    known[wall] = -2
    found = np.full(shape, -2, dtype=np.int64)
    for area in range(1, areas + 1):
        inside = number == area
        points = inside & (known != -2)
        if points.any():
            nearest = distance_transform_edt(~points, return_distances=False, return_indices=True)
            found[inside] = known[tuple(nearest)][inside]
    nearest = distance_transform_edt(found == -2, return_distances=False, return_indices=True)
    speed = np.linspace(result.speed[0], result.speed[-1], shape[1])
    low, high = float(result.value[0]), float(result.value[-1])
    value = np.geomspace(low, high, shape[0]) if result.log else np.linspace(low, high, shape[0])
    return speed, value, found[tuple(nearest)]


def _lines(result: BallChart) -> list[Array]:
    """Curves, and values at which the state begins or ends, in steps of the grid (value, speed), (k, 2)."""
    rows, columns = result.growing.shape

    def steps(value: Array) -> Array:
        low, high = result.value[[0, -1]]
        if result.log:
            value, low, high = np.log(np.maximum(value, 1e-300)), np.log(low), np.log(high)
        return np.asarray((value - low) / (high - low) * (rows - 1))

    first, last = result.speed[[0, -1]]
    lines = [
        np.stack([steps(edge.value), (edge.speed - first) / (last - first) * (columns - 1)], axis=1)
        for edge in result.edges
    ]
    bounds = steps(np.array(result.bounds))
    return [*lines, *(np.array([[bound, 0.0], [bound, columns - 1.0]]) for bound in bounds)]


def _drawn(line: Array, shape: tuple[int, int]) -> Flags:
    """Cells of an image through which a line passes, without a gap."""
    pieces = [
        begin + np.linspace(0.0, 1.0, 2 + int(2.0 * np.abs(end - begin).max()))[:, None] * (end - begin)
        for begin, end in pairwise(line)
    ]
    at = np.rint(np.concatenate(pieces)).astype(np.int64)
    at = at[((at >= 0) & (at < shape)).all(axis=1)]
    found = np.zeros(shape, dtype=bool)
    found[at[:, 0], at[:, 1]] = True
    return found


def _caption(result: BallChart) -> Caption:
    assumed = assumed_words(result.assumed)
    varied = ", ".join(result.paths)
    return Caption(
        f"Stability of {STATES[result.state]} by the roots of small motions, over speed and {varied}. "
        f"{sentence(result)}",
        f"Scene: {one_line(result.name)}, {result.axis} axis. Assumed: {assumed}.",
    )
