"""Figures of a study: what they show, in which units, that nothing overlaps, that bytes repeat."""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import ConnectionPatch
from matplotlib.transforms import Bbox

from leblanc.liquid.filled import FilledChamber
from leblanc.plotting import chambers as chamber
from leblanc.plotting import curves
from leblanc.plotting.page import FigureFiles, number, save
from leblanc.studies.run import figure as run_figures
from tests.oracles.records import EXTREMES, RPM, dry_deflection, folded, record_of, response_of, rig

DRAW = (
    run_figures.amplitude_figure,
    run_figures.liquid_figure,
    run_figures.phase_figure,
    chamber.chamber_figure,
)


def line(figure: Figure, label: str, axes: int = 0):
    (found,) = [drawn for drawn in figure.axes[axes].lines if drawn.get_label() == label]
    return found


def legend(figure: Figure) -> list[str]:
    every = [*figure.legends, *(axes.get_legend() for axes in figure.axes if axes.get_legend() is not None)]
    return [text.get_text() for one in every for text in one.get_texts()]


def test_amplitude_in_mm_over_rpm():
    record = rig()
    figure = run_figures.amplitude_figure(record)
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("Speed (rpm)", "Amplitude (mm 0-p)")
    assert axes.child_axes[0].get_xlabel() == "Speed (rad/s)"
    np.testing.assert_allclose(axes.get_xlim(), (100.0, 2000.0), rtol=1e-12)
    wet, dry = line(figure, "with liquid"), line(figure, "without liquid")
    np.testing.assert_allclose(wet.get_ydata(), np.abs(record.response.deflection) * 1e3, rtol=1e-12)
    np.testing.assert_allclose(dry.get_ydata(), np.abs(record.response.deflection_dry) * 1e3, rtol=1e-12)
    low, high = axes.get_ylim()
    assert low == 0.0
    assert np.max(dry.get_ydata()) < high < 1.2 * np.max(dry.get_ydata())
    assert legend(figure) == [
        "with liquid",
        "without liquid",
        "critical speed 968.4 rpm, without liquid 1000 rpm",
        "annular layer from 350 rpm",
        "model out of range",
    ]


def test_lines_differ_without_colour():
    figure = run_figures.amplitude_figure(folded())
    styles = [
        (drawn.get_linestyle(), drawn.get_linewidth(), drawn.get_marker(), drawn._unscaled_dash_pattern)
        for drawn in figure.axes[0].lines
        if not drawn.get_label().startswith("_")
    ]
    assert len(styles) == 8
    assert len(set(map(str, styles))) == len(styles)


def test_fold_shows_all_branches_and_the_jump():
    record = folded()
    figure = run_figures.amplitude_figure(record)
    amplitudes = np.abs(record.response.branch_deflection) * 1e3
    stable, unstable = line(figure, "other branches, stable"), line(figure, "other branches, unstable")
    middle = amplitudes[~np.isnan(amplitudes[:, 2]), 1]
    assert set(middle) <= set(unstable.get_ydata())
    assert set(amplitudes[~np.isnan(amplitudes[:, 2]), 2]) <= set(stable.get_ydata())
    # Along the stable lines no step is as large as the distance between branches.
    steps = np.abs(np.diff(stable.get_ydata()))
    assert np.nanmax(steps) < 0.3
    jump = line(figure, "jump between branches").get_ydata()
    reported = np.abs(record.response.deflection) * 1e3
    assert jump[0] - jump[1] == np.max(np.abs(np.diff(reported)))
    assert np.nanmax(np.abs(np.diff(line(figure, "with liquid").get_ydata()))) < jump[0] - jump[1]


def test_unstable_answer_is_dashed():
    record = folded()
    r = record.response
    stable = r.speed < 900.0 * RPM
    figure = run_figures.amplitude_figure(replace(record, response=replace(r, stable=stable)))
    solid, dashed = line(figure, "with liquid"), line(figure, "with liquid, unstable")
    assert np.nanmax(solid.get_xdata()[~np.isnan(solid.get_ydata())]) < 900.0
    assert np.nanmin(dashed.get_xdata()[~np.isnan(dashed.get_ydata())]) > 890.0
    assert dashed._unscaled_dash_pattern[1] is not None


def test_liquid_offset_in_mm_and_angle_from_0_to_minus_180():
    record = rig()
    figure = run_figures.liquid_figure(record)
    top, bottom = figure.axes
    assert (top.get_ylabel(), bottom.get_ylabel()) == ("Liquid offset (mm)", "Liquid angle (deg)")
    offset, angle = (line(figure, "liquid's centre of mass", i).get_ydata() for i in (0, 1))
    np.testing.assert_allclose(offset, record.response.liquid_offset * 1e3, rtol=1e-12)
    np.testing.assert_allclose(angle, np.degrees(record.response.liquid_angle), rtol=1e-12)
    assert bottom.get_ylim() == (-190.0, 10.0)
    assert angle.max() <= 0.0
    assert angle.min() >= -180.0


def test_undamped_phase_falls_by_half_a_turn():
    """Its angle is 180 degrees above resonance and has to be drawn as a lag."""
    speed = np.linspace(100.0, 2000.0, 200) * RPM
    w = dry_deflection(speed, 4.0, 0.0)
    record = record_of(replace(response_of(speed), deflection=w, branch_deflection=w[:, None]))
    drawn = line(run_figures.phase_figure(record), "with liquid").get_ydata()
    assert set(drawn) == {0.0, -180.0}


def test_dry_patch_is_marked_where_it_is():
    record = folded()
    figure = run_figures.phase_figure(record)
    x = line(figure, "dry patch on the wall").get_xdata()
    dry = record.response.speed[record.response.dry_patch] / RPM
    step = np.diff(record.response.speed)[0] / RPM
    np.testing.assert_allclose(x[:2], (dry[0] - step / 2, dry[-1] + step / 2), rtol=1e-12)
    assert "dry patch on the wall" not in legend(run_figures.phase_figure(rig()))


def test_peak_that_flattens_the_rest_gets_a_logarithmic_axis():
    speed = np.linspace(10.0, 2000.0, 400) * RPM
    sharp = replace(response_of(speed), deflection_dry=dry_deflection(speed, 4.0, 1e-3))
    figure = run_figures.amplitude_figure(record_of(sharp))
    assert figure.axes[0].get_yscale() == "log"
    low, high = figure.axes[0].get_ylim()
    assert low < np.median(np.abs(sharp.deflection)) * 1e3 < np.max(np.abs(sharp.deflection_dry)) * 1e3 < high
    assert run_figures.amplitude_figure(rig()).axes[0].get_yscale() == "linear"


@pytest.mark.parametrize("damping", [0.002, 0.05])
def test_refined_points_do_not_change_the_scale(damping: float):
    """The same curve with a thousand more points about its peak has the same kind of axis."""
    even = np.linspace(10.0, 2000.0, 400) * RPM
    peak = 1000.0 * (1.0 + 5.0 * damping * np.linspace(-1.0, 1.0, 1001)) * RPM
    scales = []
    for speed in (even, np.union1d(even, peak)):
        own = dry_deflection(speed, 4.0, 2.0 * damping * 4.0 * 1000.0 * RPM)
        sharp = replace(response_of(speed), deflection_dry=own, deflection=own)
        scales.append(run_figures.amplitude_figure(record_of(sharp)).axes[0].get_yscale())
    assert scales[0] == scales[1] == ("log" if damping < 0.01 else "linear")


def test_narrow_resonance_is_drawn_wider_below():
    """Both panels show the same lines; frame and links mark on the upper one what the lower one shows."""
    record = narrow()
    own = record.response.deflection
    figure = run_figures.amplitude_figure(record)
    whole, wide = figure.axes
    low, high = wide.get_xlim()
    band = 2.0 * 0.01 * 1000.0  # half-power bandwidth of a light damping
    assert low < 1000.0 - band < 1000.0 + band < high
    assert high - low < 0.1 * (whole.get_xlim()[1] - whole.get_xlim()[0])
    top = np.max(np.abs(own)) * 1e3
    for axes in (whole, wide):
        assert axes.get_ylim()[0] <= 0.0 and axes.get_ylim()[1] > top
        (drawn,) = (line for line in axes.lines if line.get_label() == "with liquid")
        assert np.nanmax(drawn.get_ydata()) == pytest.approx(top, rel=1e-12)
    assert (whole.get_xlabel(), wide.get_xlabel()) == ("", "Speed (rpm)")
    links = [artist for artist in figure.artists if isinstance(artist, ConnectionPatch)]
    assert [link.xy1[0] for link in links] == [low, high]
    caption = figure.caption.shown
    assert figure.alt.endswith(f"Drawn once more below, wider: {low:.0f} to {high:.0f} rpm.")
    assert "resonances under 2.5 % of the axis" in caption
    assert len(run_figures.amplitude_figure(rig()).axes) == 1
    # The liquid's two panels have two below them; only the lowest of each pair has numbers under it.
    several = run_figures.liquid_figure(record).axes
    assert len(several) == 4
    assert several[2].get_xlim() == several[3].get_xlim() == (low, high)
    assert several[2].get_ylabel() == several[0].get_ylabel() != several[3].get_ylabel()


def test_caption_says_scene_model_and_assumed_values():
    record = rig()
    for draw in DRAW:
        caption = str(draw(record).caption)
        assert "Scene: Horizontal rig." in caption
        assert "Liquid model: statics." in caption
        assert caption.endswith("Assumed: 3 of its values.")


def test_chamber_at_the_peak_and_at_the_working_speed():
    record = rig()
    figure = chamber.chamber_figure(record)
    r = record.response
    highest = int(np.argmax(np.abs(r.deflection)))
    headings = [axes.texts[-2].get_text() for axes in figure.axes]
    assert headings == [f"Largest deflection, {r.speed[highest] / RPM:.4g} rpm", "Working speed, 2000 rpm"]
    factor = chamber.choose_views(record).scales[0].deflection
    said = f"Deflection drawn \N{MULTIPLICATION SIGN}\N{NO-BREAK SPACE}{factor:g},"
    assert said in figure.caption.shown
    for axes, index in zip(figure.axes, (highest, -1), strict=True):
        marks = {drawn.get_label(): drawn for drawn in axes.lines}
        centre = complex(*(marks["geometric centre"].get_data()[i][0] for i in (0, 1)))
        assert centre == pytest.approx(r.deflection[index] * factor * 1e3)
        assert [float(value[0]) for value in marks["rotation axis"].get_data()] == [0.0, 0.0]
        spot = complex(*(marks["unbalance"].get_data()[i][0] for i in (0, 1)))
        # Outside the wall, where it covers no liquid.
        assert spot - centre == pytest.approx(65.0 * chamber.OUTSIDE)
        assert axes.get_aspect() == 1.0


def test_spin_is_drawn_the_way_angles_grow():
    axes = chamber.chamber_figure(rig()).axes[0]
    (arrow,) = [text for text in axes.texts if getattr(text, "arrow_patch", None) is not None]
    (x0, y0), (x1, y1) = arrow.xyann, arrow.xy
    assert x0 * y1 - x1 * y0 > 0.0


def test_nested_chambers_share_a_drawing():
    nested = tuple(
        FilledChamber(R, R_i, 0.04, 1e-4, "water", R - 0.005)
        for R, R_i in ((0.1, 0.0), (0.2, 0.155), (0.15, 0.105))
    )
    views = chamber.choose_views(replace(rig(), chambers=nested))
    assert [[c.radius for c in drawing] for drawing in views.drawings] == [[0.2, 0.15, 0.1]]
    apart = tuple(replace(c, inner_radius=0.0) for c in nested)
    assert len(chamber.choose_views(replace(rig(), chambers=apart)).drawings) == 3
    assert len(chamber.choose_views(replace(rig(), chambers=nested[:1] * 4)).drawings) == 1


def parts(axes) -> list[Bbox]:
    """Axes with their labels; of a drawing without axes, itself and the texts around it."""
    if axes.axison:
        return [axes.get_tightbbox()]
    texts = [text for text in (axes.title, *axes.texts) if text.get_text() not in ("", "spin")]
    return [axes.get_window_extent(), *(text.get_window_extent() for text in texts)]


def narrow():
    """A rotor with little damping over a wide range of speeds."""
    speed = np.linspace(10.0, 4000.0, 4000) * RPM
    own = dry_deflection(speed, 4.0, 2.0 * 0.01 * 4.0 * 1000.0 * RPM)
    return record_of(replace(response_of(speed), deflection_dry=own, deflection=own))


@pytest.mark.parametrize("name", ["narrow", *EXTREMES])
def test_texts_stay_on_the_page_and_apart(name: str):
    """Every text lies on the figure; axes with their labels, legend and caption do not overlap."""
    record = narrow() if name == "narrow" else EXTREMES[name]()
    for draw in DRAW:
        figure = draw(record)
        FigureCanvasAgg(figure)
        figure.draw_without_rendering()
        # All that is drawn, tick labels included, inches.
        drawn, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
        assert drawn.x0 >= 0.0, draw.__name__
        assert drawn.y0 >= 0.0, draw.__name__
        assert drawn.x1 <= width, draw.__name__
        assert drawn.y1 <= height, draw.__name__
        blocks = [block for axes in figure.axes for block in parts(axes)]
        blocks += [one.get_window_extent() for one in figure.legends if one.get_texts()]
        blocks += [text.get_window_extent() for text in figure.texts]
        for one, other in combinations(blocks, 2):
            common = Bbox.intersection(one, other)
            # Lines of the caption may touch by the height of their descenders.
            assert common is None or min(common.width, common.height) < 3.0, (draw.__name__, one, other)


def test_very_many_speeds_keep_their_peak():
    record = rig(200_000)
    r = record.response
    w = r.deflection.copy()
    w[123_457] *= 100.0
    record = replace(record, response=replace(r, deflection=w, dry_patch=np.arange(w.size) % 2 == 0))
    figure = run_figures.amplitude_figure(record)
    drawn = line(figure, "with liquid").get_ydata()
    assert drawn.size < 50_000
    assert np.max(drawn) == abs(w[123_457]) * 1e3
    assert len(curves.prepare(record).dry_patch) == 1


def test_same_record_same_bytes_whatever_the_user_sets(tmp_path: Path):
    figures = {
        "amplitude": run_figures.amplitude_figure,
        "liquid": run_figures.liquid_figure,
        "phase": run_figures.phase_figure,
        "chamber": chamber.chamber_figure,
    }

    def drawn(folder: Path) -> list[FigureFiles]:
        return [save(draw(folded()), folder, name, name, png=True) for name, draw in figures.items()]

    first = drawn(tmp_path / "a")
    with matplotlib.rc_context({"lines.linewidth": 9.0, "font.size": 30.0, "svg.hashsalt": "other"}):
        second = drawn(tmp_path / "b")
    assert [files.name for files in first] == [*figures]
    for one, other in zip(first, second, strict=True):
        for a, b in ((one.png, other.png), (one.svg, other.svg)):
            assert hashlib.sha256(a.read_bytes()).digest() == hashlib.sha256(b.read_bytes()).digest(), a.name
        assert one.png.read_bytes().startswith(b"\x89PNG")
        assert "<dc:date>" not in one.svg.read_text(encoding="utf-8")
    assert sorted(path.suffix for path in (tmp_path / "a").iterdir()) == [".png"] * 4 + [".svg"] * 4


def test_right_angle_between_unbalance_and_deflection_at_resonance():
    """At the critical speed the deflection lags by 90 degrees, so the centre lies straight below."""
    record = rig(1, 1000.0, 1000.0)
    r = record.response
    w = dry_deflection(r.speed, 4.0)
    axes = chamber.chamber_figure(record_of(replace(r, deflection=w))).axes[0]
    (centre,) = [drawn for drawn in axes.lines if drawn.get_label() == "geometric centre"]
    x, y = (float(values[0]) for values in centre.get_data())
    assert y < 0.0
    # The constants of the rig give 1000 rpm to five digits.
    assert math.isclose(x, 0.0, abs_tol=1e-3 * abs(y))


def test_a_tick_of_zero_has_no_sign() -> None:
    assert [number(value) for value in (-0.0, 0.0, -2.5)] == ["0", "0", "\N{MINUS SIGN}2.5"]


def test_a_legend_has_five_entries_and_the_caption_the_rest():
    """In one panel the first five; panels with entries of their own have legends of their own."""
    from leblanc.plotting import page

    def drawn(rows: int, names: list[list[str]]) -> page.Figure:
        figure = page.Figure()
        axes = [[figure.add_axes((0, 0, 1, 1), label=str(k))] for k in range(rows)]
        for (one,), labels in zip(axes, names, strict=True):
            one.axvspan(0.0, 0.1, color="0.9", label=f"range {labels[0]}")
            for k, label in enumerate(labels):
                one.plot([0.0, 1.0], [k, k], color="#D55E00", linestyle="--", label=label)
        frame = page.Frame(left=0.7, top=0.4, between=0.1, below=0.4)
        page.lay_out(figure, axes, [1.0] * rows, frame, "What is shown.")
        return figure

    one = drawn(1, [list("abcdef")])
    assert legend(one) == list("abcde")
    assert one.caption.shown == "What is shown. Besides: red, dashed, f; shaded, range a."
    two = drawn(2, [list("abc"), list("cdef")])
    assert not two.legends and two.axes[0].get_legend() is not None and two.caption.shown == "What is shown."
    own = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in two.axes]
    assert own == [["a", "b", "c", "range a"], ["d", "e", "f", "range c"]]
    again = drawn(2, [list("abcdef"), list("abcdef")])
    assert legend(again) == list("abcde") and all(axes.get_legend() is None for axes in again.axes)
