"""Figures of time-domain states: range over time, limit cycles, the way down, the layers."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import FillBetweenPolyCollection, LineCollection
from matplotlib.figure import Figure

from leblanc.plotting import chambers, curves
from leblanc.studies.run import figure as run_figures
from tests.oracles.records import RPM, held_rig, record_of, response_of, rig


def line(figure: Figure, label: str, axes: int = 0):
    (found,) = [drawn for drawn in figure.axes[axes].lines if drawn.get_label() == label]
    return found


def band(figure: Figure, axes: int = 0) -> np.ndarray:
    (found,) = [part for part in figure.axes[axes].collections if isinstance(part, FillBetweenPolyCollection)]
    return np.concatenate([path.vertices for path in found.get_paths()])


@pytest.mark.parametrize("at", [slice(None), slice(8, 16)])
def test_the_band_reaches_from_the_least_to_the_largest(at: slice) -> None:
    result = held_rig(at=at)
    held = result.held
    assert held is not None
    points = band(run_figures.amplitude_figure(result))
    for k in np.flatnonzero(held.at).tolist():
        here = points[np.isclose(points[:, 0], result.speed[k] / RPM), 1]
        assert here.min() == pytest.approx(held.least[k] * 1e3)
        assert here.max() == pytest.approx(held.largest[k] * 1e3)
    outside = result.speed[~held.at] / RPM
    assert not np.isclose(points[:, :1], outside).any()


def test_between_the_speeds_asked_for_the_band_goes_with_the_mean() -> None:
    """A refined peak is no wider than its neighbours; the band does not cut its line off."""
    result = held_rig()
    between = response_of(np.array([1190.0, 1250.0]) * RPM)
    higher = np.abs(between.deflection) * 2.0
    refined = replace(
        *(between,),
        model=np.full(2, "long_wave"),
        stable=np.zeros(2, dtype=bool),
        over_time=higher,
    )
    drawn = curves.prepare(replace(result, refined=refined))
    k = int(np.searchsorted(drawn.rpm, 1189.0))
    assert drawn.amplitude[k] == pytest.approx(higher[0] * 1e3)
    assert drawn.least[k] == pytest.approx(0.6 * drawn.amplitude[k])
    assert drawn.largest[k] == pytest.approx(1.5 * drawn.amplitude[k])
    assert drawn.cycling[k]


def test_limit_cycles_are_marked_and_their_whirl_drawn() -> None:
    result = held_rig()
    held = result.held
    assert held is not None
    figure = run_figures.amplitude_figure(result)
    assert [axes.get_ylabel() for axes in figure.axes[:2]] == ["Amplitude (mm 0-p)", "Whirl speed (rpm)"]
    marks = line(figure, "limit cycle, mean")
    known = np.isfinite(marks.get_ydata())
    np.testing.assert_allclose(marks.get_xdata()[known], result.speed[held.limit_cycle] / RPM)
    np.testing.assert_allclose(marks.get_ydata()[known], result.amplitude[held.limit_cycle] * 1e3)
    whirl, spin = line(figure, "limit cycle: whirl", 1), line(figure, "spin", 1)
    known = np.isfinite(whirl.get_ydata())
    np.testing.assert_allclose(whirl.get_ydata()[known], held.whirl_speed[held.limit_cycle] / RPM)
    np.testing.assert_array_equal(spin.get_xdata(), spin.get_ydata())
    low, high = figure.axes[1].get_ylim()
    assert low <= 0.0 and high > 2000.0
    above, below = ([text.get_text() for text in axes.get_legend().get_texts()] for axes in figure.axes[:2])
    assert len(above) == 5 and above[0] == "least to largest over time"
    assert below == ["limit cycle: whirl", "spin"]
    assert "with liquid, limit cycle" in figure.caption.shown.partition("Besides: ")[2]
    # A limit cycle is no unstable answer: what is drawn so begins and ends beside the speed that was lost.
    unstable = line(figure, "with liquid, unstable")
    assert np.nanmax(unstable.get_xdata()[~np.isnan(unstable.get_ydata())]) < 400.0


def test_without_limit_cycles_there_is_no_panel_for_them() -> None:
    result = held_rig()
    held = result.held
    assert held is not None
    calm = np.where(held.limit_cycle, "periodic", held.state)
    response = replace(result.response, stable=result.response.converged)
    quiet = replace(result, response=response, held=replace(held, state=calm))
    (axes,) = run_figures.amplitude_figure(quiet).axes
    assert "limit cycle, mean" not in [drawn.get_label() for drawn in axes.lines]


def test_the_way_down_is_a_line_of_its_own() -> None:
    result = held_rig()
    held = result.held
    assert held is not None
    down = line(run_figures.amplitude_figure(result), "while the speed falls")
    known = np.isfinite(down.get_ydata())
    k = int(np.flatnonzero(held.hysteresis)[0])
    # From the neighbour below to the one above, where both ways are the same.
    np.testing.assert_allclose(down.get_xdata()[known], result.speed[k - 1 : k + 2] / RPM)
    expected = [result.amplitude[k - 1], held.amplitude_down[k], result.amplitude[k + 1]]
    np.testing.assert_allclose(down.get_ydata()[known], np.array(expected) * 1e3)


def test_layers_have_their_mean_and_swing() -> None:
    result = held_rig()
    held = result.held
    assert held is not None
    figure = run_figures.liquid_figure(result)
    assert [axes.get_ylabel() for axes in figure.axes[:3]] == [
        "Liquid offset (mm)",
        "Liquid angle (deg)",
        "Layer's centre (mm)",
    ]
    mean = np.abs(held.liquid[:, 0]) * 1e3
    np.testing.assert_allclose(line(figure, "layer of chamber 1", 2).get_ydata(), mean)
    points = band(figure, 2)
    k = int(np.flatnonzero(held.limit_cycle)[0])
    here = points[np.isclose(points[:, 0], result.speed[k] / RPM), 1]
    assert here.max() - mean[k] == pytest.approx(mean[k] - here.min()) == pytest.approx(2.0)


def test_what_is_out_of_range_does_not_set_the_scale_of_the_layers() -> None:
    result = held_rig()
    held = result.held
    assert held is not None
    wild = np.where(result.in_range[:, None], held.ripple, 0.06)
    figure = run_figures.liquid_figure(replace(result, held=replace(held, ripple=wild)))
    assert figure.axes[2].get_ylim() == run_figures.liquid_figure(result).axes[2].get_ylim()


def test_only_the_layers_that_swing_most_are_drawn() -> None:
    result = held_rig()
    held = result.held
    assert held is not None
    swing = held.ripple * np.array([1.0, 6.0, 3.0, 5.0, 2.0, 4.0])
    many = replace(held, ripple=swing, liquid=np.repeat(held.liquid, 6, axis=1))
    figure = run_figures.liquid_figure(replace(result, held=many))
    labels = [drawn.get_label() for drawn in figure.axes[2].lines]
    assert [x for x in labels if x.startswith("layer")] == [f"layer of chamber {k}" for k in (2, 3, 4, 6)]
    assert "(the 4 that swing most)" in str(figure.caption)


def test_alternative_texts_tell_what_is_drawn() -> None:
    result = held_rig()
    alt = run_figures.amplitude_figure(result).alt
    assert "A band from the least to the largest amplitude over time" in alt
    assert "limit cycles: 1145 to 1335 rpm, amplitude up to 0.6426 mm" in alt
    assert "while the speed falls: 1430 rpm" in alt and "not converged in time: 195 rpm" in alt
    assert run_figures.liquid_figure(result).alt.endswith("at most 2 mm.")
    assert "band" not in run_figures.amplitude_figure(rig()).alt


@pytest.mark.parametrize("draw", [run_figures.amplitude_figure, run_figures.liquid_figure])
def test_panels_do_not_overlap(draw) -> None:
    figure = draw(held_rig())
    FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    boxes = sorted((axes.get_tightbbox() for axes in figure.axes), key=lambda box: box.y0)
    assert all(low.y1 <= high.y0 + 1.0 for low, high in pairwise(boxes))


def test_the_drawing_of_the_chamber_says_that_it_has_no_waves() -> None:
    said = "at rest in the mean motion, without its waves"
    assert said in str(chambers.chamber_figure(held_rig()).caption)
    assert said not in str(chambers.chamber_figure(rig()).caption)


def test_figures_without_held_motions_are_as_they_were() -> None:
    """No band, no further panel, no word of it."""
    for draw, panels in ((run_figures.amplitude_figure, 1), (run_figures.liquid_figure, 2)):
        figure = draw(record_of(rig().response))
        assert len(figure.axes) == panels
        assert "Held" not in str(figure.caption) and "held" not in figure.alt


def test_a_speed_alone_is_marked() -> None:
    """Where there is no neighbour to draw a line to: the limit cycle, and the swing of its layer."""
    plain = held_rig(1)
    assert plain.held is not None
    cycle = np.array([True])
    held = replace(plain.held, state=np.array(["limit_cycle"]), whirl_speed=0.8 * plain.speed)
    result = replace(plain, held=held, response=replace(plain.response, stable=~cycle, converged=cycle))
    figure = run_figures.liquid_figure(result)
    for axes in (0, 1):
        drawn = line(figure, "liquid's centre of mass, limit cycle", axes)
        assert drawn.get_marker() == "D" and np.isfinite(drawn.get_ydata()[drawn.get_markevery()]).all()
    mean = line(figure, "layer of chamber 1", 2)
    assert mean.get_marker() == "o" and len(mean.get_markevery()) == 1
    (swing,) = [part for part in figure.axes[2].collections if isinstance(part, LineCollection)]
    (segment,) = swing.get_segments()
    assert segment[1, 1] - mean.get_ydata()[0] == pytest.approx(1e3 * held.ripple[0, 0])
