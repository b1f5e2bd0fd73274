"""Figures of an optimum: a mark for each point tried, nothing between them, limits and planes by name."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PathCollection
from matplotlib.contour import ContourSet

import leblanc as lb
from leblanc.studies.optimise.answer import OptimumAnswer, ParetoFront
from leblanc.studies.optimise.figure import front_figure, objective_figure
from leblanc.studies.optimise.study import optimise_scene
from tests.oracles.blocks import table


@cache
def two_chambers() -> OptimumAnswer:
    return optimise_scene(lb.example("horizontal_rig"), "working_speed")


def test_each_pair_of_volumes_is_a_mark_of_its_own_colour() -> None:
    """Every sure point is drawn once with its value; no surface is drawn where nothing was asked."""
    result = two_chambers()
    axes = objective_figure(result).axes[0]
    assert not any(isinstance(drawn, ContourSet) for drawn in axes.collections)
    marks = [drawn for drawn in axes.collections if isinstance(drawn, PathCollection)]
    places = np.concatenate([np.asarray(drawn.get_offsets()) for drawn in marks])
    colours = np.concatenate([np.asarray(drawn.get_array()) for drawn in marks])
    tried = result.candidates
    good = np.isfinite(tried.vibration) & tried.exact
    wanted, first = np.unique(tried.volume[good], axis=0, return_index=True)
    order = np.lexsort(places.T[::-1])
    np.testing.assert_allclose(places[order], 1e6 * wanted, rtol=1e-12)
    np.testing.assert_allclose(colours[order], 1e3 * tried.vibration[good][first], rtol=1e-12)


def test_the_limit_that_is_exceeded_is_named() -> None:
    """The name in the legend is that of the constraint which is farthest over its limit at those points."""
    result = two_chambers()
    tried = result.candidates
    assert len(tried.exceeded) == tried.excess.size
    assert all(
        (name != "") == (excess > 0.0) for name, excess in zip(tried.exceeded, tried.excess, strict=True)
    )
    names = {name.replace("_", " ") for name in tried.exceeded if name}
    assert names and names <= {name.replace("_", " ") for name in result.constraints}
    figure = objective_figure(result)
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {f"tried, limit of {name} exceeded" for name in names} <= set(legend)
    assert not any("a constraint" in text for text in legend)


def test_the_front_is_a_staircase_of_its_points() -> None:
    """The line says what can be had with so much liquid at most: it never rises."""
    found = two_chambers()
    assert found.front is not None
    # The last is on the front by its margin alone, with more vibration than another: no line may lead to it.
    front = ParetoFront(
        volume=np.arange(8.0).reshape(4, 2) * 1e-6,
        vibration=np.array([3e-3, 2e-3, 1e-3, 2.5e-3]),
        mass=np.array([0.0, 0.01, 0.02, 1.4]),
        stability_margin=np.array([0.1, 0.2, -0.1, 5.0]),
    )
    axes = front_figure(replace(found, front=front)).axes[0]
    (line,) = (drawn for drawn in axes.lines if str(drawn.get_label()).startswith("least with"))
    assert line.get_drawstyle() == "steps-post"
    np.testing.assert_allclose(line.get_ydata(), [3.0, 2.0, 1.0, 1.0], rtol=1e-12)
    np.testing.assert_allclose(line.get_xdata(), [0.0, 10.0, 20.0, 1400.0], rtol=1e-12)
    marks = np.concatenate([np.asarray(drawn.get_offsets()) for drawn in axes.collections])
    assert sorted(marks[:, 0].tolist()) == pytest.approx([0.0, 10.0, 20.0, 1400.0])


def test_rows_that_read_alike_are_merged() -> None:
    """Points that differ in the seventh digit are one row, and the chosen one is still marked."""
    found = two_chambers()
    same = np.array([1.0, 1.0 + 1e-9, 1.0 + 2e-9, 2.0])
    front = ParetoFront(
        volume=np.stack([same, same], axis=1) * found.volume,
        vibration=1e-3 / same,
        mass=0.01 * same,
        stability_margin=0.5 * same,
    )
    shown = table(replace(found, front=front), "Liquid (")
    rows = shown.rows
    assert len(rows) == 2 == len({row[1:] for row in rows})
    assert rows[0][0].endswith("(chosen)") and not rows[1][0].endswith("(chosen)")
    assert "2 of 2 points" in shown.head[0]


def test_the_plane_of_the_amplitude_is_named() -> None:
    """On the axis in short, in the caption in full; of a rotor in one plane there is none."""
    tilting = lb.example("two_plane_rig").replace({"speeds.count": 9})
    result = replace(two_chambers(), response=lb.run(tilting))
    figure = objective_figure(result)
    FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    assert any(axes.get_ylabel() == "Vibration at chamber 1 (mm 0-p)" for axes in figure.axes)
    caption = str(figure.caption)
    assert "in the plane of chamber 1" in caption
    assert front_figure(result).axes[0].get_ylabel() == "Vibration at chamber 1 (mm 0-p)"
    assert front_figure(two_chambers()).axes[0].get_ylabel() == "Vibration (mm 0-p)"
