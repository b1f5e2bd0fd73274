"""Figures and film of a wave: content, units, that nothing overlaps, that bytes repeat."""

from __future__ import annotations

import math
import os
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.transforms import Bbox
from PIL import Image

from leblanc.plotting import page
from leblanc.studies.layer import figure as wave
from leblanc.studies.layer import figure as wave_page
from leblanc.studies.layer.wave import Wave, WaveFrames
from meshes.errors import InputError
from tests.leblanc.figures.test_wave_values import (
    R,
    bore,
    caption,
    eccentric,
    ends,
    labelled,
    marked,
    running,
)


def nothing() -> Wave:
    """A drum without liquid."""
    lost = complex(math.nan, math.nan)
    return replace(eccentric(), mean_depth=0.0, depth=np.zeros(720), force_ratio=0j, offset=lost)


def half_dry() -> Wave:
    theta = eccentric().theta
    return replace(eccentric(), depth=0.03 * np.maximum(np.cos(theta), 0.0), offset=0.06 + 0j)


def deep(count: int) -> Wave:
    """Nearly full: 90 % of the radius at the deepest place."""
    theta = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    layer = 0.45 * R * (1.0 + np.cos(theta))
    return replace(eccentric(), mean_depth=0.3 * R, theta=theta, depth=layer, force_ratio=-3.0 - 0.2j)


def wordy() -> Wave:
    notes = ("the surface reaches the wall in linear theory: the amplitude is too large for it",) * 12
    return replace(bore(-1e4), title="A title " * 8, notes=notes, spin=1.23456e5)


EXTREMES = {
    "circle": eccentric,
    "bore": bore,
    "against the spin": lambda: bore(-30.0),
    "no liquid": nothing,
    "half dry": half_dry,
    "deep, 16 points": lambda: deep(16),
    "deep, 8192 points": lambda: deep(8192),
    "all words": wordy,
    "thin film": lambda: replace(bore(), mean_depth=1e-7, depth=np.full(256, 1e-7)),
    "no force": lambda: replace(bore(), force_ratio=complex(math.nan), offset=complex(math.nan)),
    "annular": lambda: replace(bore(), inner_radius=0.125),
}


def legend(figure) -> list[str]:
    return [text.get_text() for text in figure.legends[0].get_texts()]


def numbers(figure) -> str:
    (text,) = [text.get_text() for text in figure.axes[0].texts if "force" in text.get_text()]
    return text


def test_labels_and_numbers():
    figure = wave.wave_figure(bore())
    left, right = figure.axes
    assert left.get_aspect() == 1.0
    assert right.get_xlabel() == "Angle from the deflection, with the spin (deg)"
    assert right.get_ylabel() == "Depth (mm)"
    assert right.get_xlim() == (-180.0, 180.0)
    low, high = right.get_ylim()
    assert low == 0.0 and 23.0 < high < 30.0
    assert numbers(figure) == (
        "force coefficient 0.49 + 3.12i (3.158 at 81\N{DEGREE SIGN})\n"
        "centre of mass 22.36 mm at \N{MINUS SIGN}27\N{DEGREE SIGN}"
    )
    np.testing.assert_allclose(labelled(right, "mean depth").get_ydata(), 15.0, rtol=1e-12)
    every = {
        *("depth of the layer", "mean depth", "liquid", "deflection", "force on the drum"),
        *("geometric axis", "liquid's centre of mass"),
    }
    text = caption(figure)
    assert len(legend(figure)) == 5 and set(legend(figure)) < every
    besides = text.partition("Besides: ")[2].partition(". ")[0]
    assert all(name in besides for name in every - set(legend(figure)))
    factor = wave.depth_factor(bore(), float(bore().depth.max()))
    assert f"Depth of the layer drawn \N{MULTIPLICATION SIGN} {factor:g}, walls to scale" in text
    assert "Layer of water. Liquid model: long_wave. Wall 150 mm, " in text
    assert "Notes: mean rotation not converged in time." in text


def test_drawn_liquid_is_the_record_times_the_factor():
    """The wall is a circle to scale; the drawn depth is the record's times the printed factor."""
    record = bore()
    left = wave.wave_figure(record).axes[0]
    factor = wave.depth_factor(record, float(record.depth.max()))
    assert factor == 2.0
    points = left.patches[0].get_xy()[:-1]
    radius = np.hypot(*points.T)
    half = len(points) // 2
    np.testing.assert_allclose(radius[:half], 150.0, rtol=1e-12)
    np.testing.assert_allclose(150.0 - radius[half:].min(), factor * record.depth.max() * 1e3, rtol=1e-12)
    x, y = left.lines[0].get_data()
    np.testing.assert_allclose(np.hypot(x, y), 150.0, rtol=1e-12)


def test_a_layer_that_is_drawn_to_scale_says_so():
    assert "Walls and depth of the layer to scale" in caption(wave.wave_figure(deep(64)))


@pytest.mark.parametrize("force", [complex(math.nan), complex(math.inf, 0.0), complex(0.0, math.nan)])
def test_no_arrow_where_no_force_was_found(force: complex):
    figure = wave.wave_figure(replace(bore(), force_ratio=force, offset=complex(math.nan)))
    assert "force not converged" in numbers(figure)
    assert not {"force on the drum", "liquid's centre of mass"} & set(legend(figure))


def test_dry_patch_is_marked_in_both_drawings():
    figure = wave.wave_figure(half_dry())
    left, right = (labelled(axes, "dry patch on the wall") for axes in figure.axes)
    angle, bar = (np.asarray(values) for values in right.get_data())
    # Half a turn is dry, opposite to the deflection.
    assert np.abs(angle[~np.isnan(bar)]).min() == pytest.approx(90.0, abs=0.6)
    x, y = (np.asarray(values) for values in left.get_data())
    place = np.degrees(np.angle(x + 1j * y))[~np.isnan(x)]
    assert np.abs(place).min() == pytest.approx(90.0, abs=0.6)
    assert np.hypot(x, y)[~np.isnan(x)].min() > 150.0
    assert right.get_linestyle() == left.get_linestyle() == "--"
    # The deep layer merely touches the wall.
    for record in (bore(), deep(16)):
        assert "dry patch on the wall" not in legend(wave.wave_figure(record))


def test_nothing_is_drawn_of_no_liquid():
    figure = wave.wave_figure(nothing())
    assert not figure.axes[0].patches
    assert "dry patch on the wall" in legend(figure)
    assert numbers(figure) == "force coefficient 0\ncentre of mass not found"


def assert_apart(figure) -> None:
    """Every text lies on the figure; axes with their labels, legend and caption do not overlap."""
    FigureCanvasAgg(figure)
    figure.draw_without_rendering()
    drawn, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
    assert drawn.x0 >= 0.0 and drawn.y0 >= 0.0 and drawn.x1 <= width and drawn.y1 <= height, drawn
    blocks = [axes.get_tightbbox() for axes in figure.axes]
    blocks += [figure.legends[0].get_window_extent()] if legend(figure) else []
    blocks += [text.get_window_extent() for text in figure.texts]
    for one, other in combinations(blocks, 2):
        common = Bbox.intersection(one, other)
        # Lines of the caption may touch by the height of their descenders.
        assert common is None or min(common.width, common.height) < 3.0, (one, other)


@pytest.mark.parametrize("name", EXTREMES)
def test_texts_stay_on_the_page_and_apart(name: str):
    record = EXTREMES[name]()
    history = running(record, count=5)
    assert_apart(wave.wave_figure(record))
    figure, show = wave_page._film(record, history)
    show(3)
    assert_apart(figure)


def test_film_has_its_frames(tmp_path: Path):
    record, seen = bore(), []
    history = running(record, count=6)
    path = tmp_path / "new" / "wave.gif"
    assert wave.animate(record, history, path, lambda *done: seen.append(done)) == 6
    assert seen == [(i, 6) for i in range(1, 7)]
    with Image.open(path) as film:
        assert film.n_frames == 6
        assert film.info["duration"] == 50 and film.info["loop"] == 0
        assert film.size[0] == 630 and film.size[1] % 2 == 0
    # A hundred such frames make less than 5 MB.
    assert path.stat().st_size < 6 * 50_000
    assert [file.name for file in path.parent.iterdir()] == ["wave.gif"]


@pytest.mark.parametrize("kind", [".gif", ".html"])
def test_same_history_same_film_whatever_the_user_sets(kind: str, tmp_path: Path):
    history = running(bore(), count=3)
    first, again = (tmp_path / name for name in (f"a{kind}", f"b{kind}"))
    wave.animate(bore(), history, first)
    with matplotlib.rc_context({"lines.linewidth": 9.0, "font.size": 30.0, "savefig.dpi": 20}):
        wave.animate(bore(), history, again)
    assert first.read_bytes() == again.read_bytes()


def test_a_page_plays_without_a_network(tmp_path: Path):
    wave.animate(bore(), running(bore(), count=3), tmp_path / "wave.html")
    page = (tmp_path / "wave.html").read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>") and page.count("data:image/png;base64") == 3
    assert "//" not in page.replace("base64,", "").split("<script")[0] and "font-awesome" not in page
    assert 'class="fa' not in page and "\N{BLACK RIGHT-POINTING TRIANGLE}" in page


def test_same_record_same_figure(tmp_path: Path):
    one, other = (
        page.save(wave.wave_figure(bore()), tmp_path / name, "wave", "W", png=True) for name in "ab"
    )
    assert one.png is not None and other.png is not None
    assert one.png.read_bytes() == other.png.read_bytes()
    assert one.svg.read_bytes() == other.svg.read_bytes()


def test_film_of_one_time(tmp_path: Path):
    history = running(half_dry(), count=1)
    assert wave.animate(half_dry(), history, tmp_path / "one.GIF") == 1


def test_arrow_grows_with_the_deflection():
    history = running(bore(), count=3)
    history = replace(history, deflection=history.deflection * np.array([0.0, 0.5, 1.0]))
    figure, show = wave_page._film(bore(), history)
    lengths = []
    for index in range(3):
        show(index)
        lengths.append(abs(ends(marked(figure.axes[0], "deflection"))))
    assert math.isnan(lengths[0])
    assert lengths[1] == pytest.approx(0.5 * lengths[2])
    assert figure.axes[0].get_title() == "t = 0.50 s"


def test_caption_of_a_film_tells_time():
    """50 frames of 1/20 s show 49 steps of half a second in all."""
    figure, _ = wave_page._film(bore(), running(bore()))
    assert "Seen from the drum. " in caption(figure)
    assert f"One second of the film is {0.5 / 49 * 20:.3g} s." in caption(figure)
    end, _ = wave_page._film(bore(), running(bore(), count=4000, duration=40.0))
    assert "(the last 9.34 s of 40 s)" in caption(end)
    assert "too far apart" not in caption(end)
    coarse, _ = wave_page._film(bore(), running(bore(), count=20, duration=40.0))
    assert "The frames are too far apart to follow the deflection." in caption(coarse)


def test_mp4_needs_an_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match="no ffmpeg was found"):
        wave.animate(bore(), running(bore(), count=2), tmp_path / "new" / "wave.mp4")
    with pytest.raises(InputError, match=r"\.gif, \.html or \.mp4"):
        wave.animate(bore(), running(bore(), count=2), tmp_path / "new" / "wave.avi")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.name != "posix", reason="the player is a shell script")
def test_mp4_gets_every_frame(tmp_path: Path):
    """A player that keeps what it is fed in place of ffmpeg: frames of an even size, four bytes a pixel."""
    player = tmp_path / "player"
    player.write_text('#!/bin/sh\nfor last; do :; done\ncat > "$last"\n')
    player.chmod(0o755)
    path = tmp_path / "wave.mp4"
    figure, _ = wave_page._film(bore(), running(bore(), count=3))
    width, height = (round(side * 100.0) for side in figure.get_size_inches())
    with matplotlib.rc_context({"animation.ffmpeg_path": str(player)}):
        assert wave.animate(bore(), running(bore(), count=3), path) == 3
    assert width % 2 == height % 2 == 0
    assert path.stat().st_size == 3 * 4 * width * height


@pytest.mark.parametrize(
    ("field", "values"),
    [
        ("radius", {"radius": 0.0}),
        ("inner_radius", {"inner_radius": -0.1}),
        ("mean_depth", {"mean_depth": 0.2}),
        ("mean_depth", {"inner_radius": 0.14}),
        ("whirl_amplitude", {"whirl_amplitude": math.nan}),
        ("spin", {"spin": -40.0}),
        ("whirl_speed", {"whirl_speed": math.inf}),
        ("theta", {"theta": np.zeros(2)}),
        ("theta", {"theta": np.full(720, math.nan)}),
        ("depth", {"depth": np.zeros(3)}),
        ("depth", {"depth": np.full(720, math.nan)}),
        ("depth", {"depth": np.full(720, -0.001)}),
        ("depth", {"depth": np.full(720, 0.16)}),
    ],
)
def test_bad_record_is_refused(field: str, values: dict[str, object]):
    with pytest.raises(InputError) as caught:
        replace(eccentric(), **values)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("field", "values"),
    [
        ("time", {"time": np.array([])}),
        ("time", {"time": np.array([0.0, 1.0, 1.0])}),
        ("time", {"time": np.array([0.0, 1.0, math.nan])}),
        ("theta", {"theta": np.zeros((2, 3))}),
        ("depth", {"depth": np.zeros((3, 4))}),
        ("depth", {"depth": np.full((3, 360), -1.0)}),
        ("deflection", {"deflection": np.zeros(2, dtype=complex)}),
        ("deflection", {"deflection": np.full(3, complex(math.nan))}),
    ],
)
def test_bad_history_is_refused(field: str, values: dict[str, object]):
    history: WaveFrames = running(bore(), count=3)
    with pytest.raises(InputError) as caught:
        replace(history, **values)
    assert caught.value.field == field


def test_history_deeper_than_the_drum_is_refused():
    history = replace(running(bore(), count=3), depth=np.full((3, 360), 0.2))
    with pytest.raises(InputError, match="depth"):
        wave.animate(bore(), history, Path("never.gif"))
