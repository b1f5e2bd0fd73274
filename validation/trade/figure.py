"""Accuracy against cost: error over time of every model and resolution, and the front of the best."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from leblanc.core.notes import one_line
from leblanc.plotting.page import style
from validation.page import Figure, page, power

if TYPE_CHECKING:
    from validation.trade.evaluate import Comparison, Row
    from validation.trade.trade import TradeRecord

PICTURED = ("runup", "horizontal_rig")  # scenes whose kept comparison is drawn
Axes = Any  # matplotlib's, which no module that only draws imports

LABEL = 7.5  # points, of a label's letters
_REACH = 18.0  # points, farthest that a label is put from its marker
_FLOOR = 1e-13  # of the errors drawn, where the best answer is exact
FRONT, BELOW = "0.55", "0.92"
TITLES = {
    "response": "Synchronous response",
    "runup": "Run-up",
    "long waves": "One layer, long waves from rest, by each solver of py-pde",
    "one family": "One layer, one steady family, by each solver of py-pde",
}
# Of each kind: colour, marker, line.
LOOKS: dict[str, tuple[str, str, str]] = {
    "auto": ("black", "o", "none"),
    "linear": ("#E69F00", "v", "none"),
    "statics": ("#009E73", "s", "none"),
    "formulas": ("#E69F00", "v", "none"),
    "integration": ("#0072B2", "^", "-"),
    "long_wave": ("#0072B2", "^", "-"),
    "long_wave, dispersion": ("#56B4E9", "P", "--"),
    "long_wave, held": ("#882255", "h", "-."),
    "fem, order 1": ("#D55E00", "D", "-"),
    "fem, order 2": ("#CC79A7", "X", "--"),
    "long_wave, finite_volume": ("#0072B2", "^", "-"),
    "kdv, steady_newton": ("#0072B2", "^", "-"),
    "kdv, exponential": ("#56B4E9", "P", "--"),
}
# Of py-pde's own solvers, by their names.
SOLVERS: dict[str, tuple[str, str, str]] = {
    "runge-kutta": ("#D55E00", "D", "-"),
    "scipy": ("#009E73", "s", "-"),
    "adams-bashforth": ("#CC79A7", "X", "--"),
    "crank-nicolson": ("#E69F00", "v", "--"),
    "implicit": ("0.35", "o", ":"),
    "euler": ("0.6", "P", ":"),
}


@dataclass(frozen=True)
class _Box:
    """A rectangle on the page, points."""

    left: float
    bottom: float
    right: float
    top: float

    def overlap(self, other: _Box) -> float:
        """Area that both cover."""
        across = min(self.right, other.right) - max(self.left, other.left)
        along = min(self.top, other.top) - max(self.bottom, other.bottom)
        return max(across, 0.0) * max(along, 0.0)


def trade_figure(record: TradeRecord) -> Figure:
    """Error over CPU time, one panel for each question."""
    heights, room = [2.75] * len(record.comparisons), {"top": 0.25, "between": 0.62}
    with style():
        with page(heights, _caption(record), (), **room) as (figure, rows):
            for [axes], comparison in zip(rows, record.comparisons, strict=True):
                _draw(axes, comparison, record.tolerance)
                axes.set_title(TITLES[comparison.question], loc="left")
                axes.set_ylabel("Relative error (\N{EN DASH})")
            axes.set_xlabel("CPU time (s)")
        for [axes], comparison in zip(rows, record.comparisons, strict=True):
            _label(figure, axes, comparison)
    return figure


def _known(comparison: Comparison) -> list[Row]:
    return [row for row in comparison.rows if math.isfinite(row.error)]


def _floor(comparison: Comparison) -> float:
    """Level at which errors are drawn that the best answer's own hides."""
    return max(comparison.reference_error if math.isfinite(comparison.reference_error) else 0.0, _FLOOR)


def _height(row: Row, comparison: Comparison) -> float:
    return max(row.error, _floor(comparison))


def _kind(row: Row) -> str:
    return f"{row.model}, {row.variant}" if row.variant else row.model


def _look(kind: str) -> tuple[str, str, str]:
    """Colour, marker and line of a kind."""
    return LOOKS.get(kind) or SOLVERS.get(kind.rpartition(", ")[2], ("0.2", "*", ":"))


def _draw(axes: Axes, comparison: Comparison, tolerance: float) -> None:
    """Ladders, front, marks and the region below the best answer's own error."""
    rows, floor = _known(comparison), _floor(comparison)
    axes.set(xscale="log", yscale="log")
    for kind in dict.fromkeys(_kind(row) for row in rows):
        _ladder(axes, kind, [row for row in rows if _kind(row) == kind], comparison)
    front = sorted((row for row in rows if row.on_front), key=lambda row: row.time)
    if front:
        # Rows within each other's spread of time are on the front side by side: the line takes the lower.
        x = [row.time for row in front]
        y = np.minimum.accumulate([_height(row, comparison) for row in front])
        axes.plot(
            *([*x, 20.0 * max(row.time for row in rows)], [*y, y[-1]]),
            drawstyle="steps-post", color=FRONT, linewidth=3.5, alpha=0.5, zorder=1, label="front",
        )  # fmt: skip
    times, heights = [row.time for row in rows], [_height(row, comparison) for row in rows]
    axes.set_xlim(0.4 * min(times), 4.0 * max(row.time * (1.0 + row.spread) for row in rows))
    low, high = 0.08 * min(*heights, tolerance), 8.0 * max(*heights, tolerance)
    axes.set_ylim(low, high)
    axes.axhspan(low, floor, color=BELOW, zorder=0, label="below the best answer's own error")
    axes.axhline(tolerance, color="0.3", linewidth=0.9, linestyle=":", zorder=1, label="tolerance")
    marks = {"linestyle": "none", "markerfacecolor": "none", "markeredgecolor": "black", "zorder": 4}
    named = ((comparison.default, "o", 11.0, "default"), (comparison.recommended, "D", 13.0, "recommended"))
    for row, shape, size, word in named:
        if row is not None and math.isfinite(row.error):
            axes.plot(row.time, _height(row, comparison), shape, markersize=size, **marks)
            axes.plot([], [], shape, markersize=6.0, label=word, **marks)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(power)
        axis.set_minor_formatter(lambda _value, _at: "")


def _ladder(axes: Axes, kind: str, rows: Sequence[Row], comparison: Comparison) -> None:
    """Points of one kind, hollow where the model is out of its own range, with their spread in time."""
    rows = sorted(rows, key=lambda row: row.resolution or 0)
    colour, marker, line = _look(kind)
    x, y = np.array([row.time for row in rows]), np.array([_height(row, comparison) for row in rows])
    name = kind.replace("_", " ").replace("fem", "finite elements")
    axes.plot(x, y, linestyle=line, color=colour, linewidth=0.9, zorder=2)
    axes.plot([], [], marker, linestyle=line, color=colour, linewidth=0.9, label=name)
    for row, at, height in zip(rows, x, y, strict=True):
        face = colour if row.in_range else "white"
        axes.plot(at, height, marker, color=colour, markerfacecolor=face, markersize=5, zorder=3)
        axes.plot([at, at * (1.0 + row.spread)], [height] * 2, color=colour, linewidth=0.8, zorder=2)
    if not all(row.in_range for row in rows):
        hollow = {"linestyle": "none", "color": "0.3", "markerfacecolor": "white"}
        axes.plot([], [], "o", label="hollow: out of its range", **hollow)


def _label(figure: Figure, axes: Axes, comparison: Comparison) -> None:
    """Resolutions beside the points, where they cover least."""
    inch = figure.dpi / 72.0
    rows = _known(comparison)
    points = [axes.transData.transform((row.time, _height(row, comparison))) / inch for row in rows]
    wide = [8.0 if row.recommended else 6.5 if row.default else 3.5 for row in rows]
    taken = [_Box(x - r, y - r, x + r, y + r) for (x, y), r in zip(points, wide, strict=True)]
    for row, (x, y) in zip(rows, points, strict=True):
        if row.resolution is None:
            continue
        text = str(row.resolution)
        width, tall = 0.62 * LABEL * len(text), LABEL
        best = min(
            _places(x, y, width, tall), key=lambda box: sum(map(box.overlap, taken)) + 0.05 * _away(box, x, y)
        )
        taken.append(_Box(best.left - 1.5, best.bottom, best.right + 1.5, best.top))
        axes.annotate(
            text, (row.time, _height(row, comparison)), xytext=(best.left - x, best.bottom - y + 1.0),
            textcoords="offset points", fontsize=LABEL, color=_look(_kind(row))[0], zorder=5,
        )  # fmt: skip


def _places(x: float, y: float, width: float, tall: float) -> list[_Box]:
    """Where a label may stand round a point, from near to far."""
    found = []
    for reach in np.arange(5.0, _REACH, 2.0):
        for turn in np.arange(0.0, 2.0 * math.pi, math.pi / 8.0):
            middle = x + (reach + 0.5 * width) * math.cos(turn), y + (reach + 0.5 * tall) * math.sin(turn)
            left, bottom = middle[0] - 0.5 * width, middle[1] - 0.5 * tall
            found.append(_Box(left, bottom, left + width, bottom + tall))
    return found


def _away(box: _Box, x: float, y: float) -> float:
    """Distance of a label's middle from its point."""
    return math.hypot(0.5 * (box.left + box.right) - x, 0.5 * (box.bottom + box.top) - y)


def _caption(record: TradeRecord) -> str:
    """What is shown, the scene, what the errors are of, the best answers."""
    assumed = ", ".join(map(one_line, record.assumed)) or "nothing"
    text = " ".join(
        f"{comparison.about[0].upper()}{comparison.about[1:]}; best answer: {comparison.reference}."
        for comparison in record.comparisons
    )
    return (
        "Error and least CPU time of every model, bars: spread of the times; numbers: cells or edges round a "
        f"wall, or steps in a turn. Scene: {one_line(record.name)}. {text} Assumed: {assumed}."
    )


if __name__ == "__main__":
    from functools import partial

    from validation.study import launch, shown
    from validation.trade.recompute import record

    launch(shown(**{f"trade_{name}": partial(trade_figure, record(name)) for name in PICTURED}))
