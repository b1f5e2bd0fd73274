"""The kept errors of all models over their times, drawn.

`python -m tests.models.figure --out docs/images`; `python -m tests.models` measures them anew.
"""

from __future__ import annotations

import math
from typing import Any

from tests.models import ModelRow, ModelTable, kept
from validation.page import Figure, number, page
from validation.study import launch, shown

_LOOKS = {
    "runup": {"color": "#0072B2", "marker": "o", "markerfacecolor": "#0072B2"},
    "horizontal_rig": {"color": "#D55E00", "marker": "s", "markerfacecolor": "white"},
}
_PLACE = {"runup": (0, 6, "center"), "horizontal_rig": (0, -12, "center")}  # of a name by its point, points
_NEAR = 2.0, 1.2  # times a time, an error: points nearer in both share a name


def models_figure() -> Figure:
    """Error of each liquid model over its time, on each scene."""
    tables = kept()
    text = (
        "Error of the amplitude or of the liquid's centre of mass over seven speeds, the larger. The "
        "best answer has none: upright the exact equilibrium, lying waves held in time on 128 cells."
    )
    with page([2.6], text) as (figure, [[axes]]):
        axes.set_xscale("log")
        axes.set_yscale("log")
        for table in tables:
            _draw(axes, table)
        rows = [row for table in tables for row in table.rows if not math.isnan(row.error)]
        axes.set_xlim(400.0 * min(row.time for row in rows), 4e3 * max(row.time for row in rows))
        axes.set_ylim(30.0 * min(row.error for row in rows), 300.0)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(number)
        axes.set_xlabel("Processor time of a speed (ms)")
        axes.set_ylabel("Largest error (%)")
        figure.alt = alternative(tables)
    return figure


def _draw(axes: Any, table: ModelTable) -> None:
    """The models of one scene; waves held in time are joined, as they differ by their cells alone."""
    look = _LOOKS[table.scene]
    rows = [row for row in table.rows if not math.isnan(row.error)]
    steady, waves = ([row for row in rows if (row.cells is None) == still] for still in (True, False))
    axes.plot(*_points(rows), linestyle="none", label=table.scene, **look)
    axes.plot(*_points(waves), color=look["color"], linewidth=0.8)
    groups: list[list[ModelRow]] = []
    for row in steady:
        near = [group for group in groups if _close(group[0], row)]
        if near:
            near[0].append(row)
        else:
            groups.append([row])
    by_time = [sorted(group, key=lambda row: row.time) for group in groups]
    named = [(", ".join(row.name for row in group), group[0]) for group in by_time]
    first, *_, last = waves
    named.append((f"{first.model}, {first.cells} to {last.cells} cells", waves[len(waves) // 2]))
    away, above, side = _PLACE[table.scene]
    for name, row in named:
        axes.annotate(
            name, (1e3 * row.time, 1e2 * row.error), (away, above), textcoords="offset points",
            ha=side, fontsize=7, color=look["color"],
        )  # fmt: skip


def _points(rows: list[ModelRow]) -> tuple[list[float], list[float]]:
    """Times, ms, and errors, per cent."""
    return [1e3 * row.time for row in rows], [1e2 * row.error for row in rows]


def _close(first: ModelRow, second: ModelRow) -> bool:
    """Points so near to each other that their names would overlap."""
    ratios = (first.time / second.time, first.error / second.error)
    return all(1.0 / near < ratio < near for near, ratio in zip(_NEAR, ratios, strict=True))


def alternative(tables: tuple[ModelTable, ...]) -> str:
    """Numbers that a reader would take from the figure."""
    parts = [
        f"{row.name} on {table.scene} {100.0 * row.error:.2g} % in {1e3 * row.time:.2g} ms"
        for table in tables
        for row in table.rows
        if not math.isnan(row.error)
    ]
    return f"Points of error over time on logarithmic axes: {'; '.join(parts)}."


if __name__ == "__main__":
    launch(shown(models=models_figure))
