"""Self-excited whirl on top of the response to the unbalance: its size at each speed, what is said of it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

from leblanc.liquid.choose import prepare
from leblanc.scene.scene import Scene, load_scene
from leblanc.studies.cycles.study import CycleCode
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.figure import amplitude_figure
from leblanc.studies.run.notes import RunCode
from leblanc.studies.run.study import run_scene
from validation.whirl_in_time import large_whirl_in_time

ROOT = Path(__file__).parents[3]
# Speed in rad/s and amplitude over the depth of rotor and layer marched in time, 128 cells: those of
# tests/solvers/cycles; the natural frequency is 100 rad/s.
MARCHED = ((120.0, 0.4147), (130.0, 0.5664), (140.0, 0.6784), (155.0, 0.8126))


@cache
def machine() -> Scene:
    """The rotor of the page on whirl with a little unbalance, at eight speeds in and about its band."""
    scene = load_scene(ROOT / "docs/examples/self_excited.toml")
    return scene.replace(
        {"rotor.unbalance": 0.00125, "speeds.start": 105.0, "speeds.stop": 155.0, "speeds.count": 11}
    )


@cache
def answer() -> RunAnswer:
    return run_scene(machine(), cycles=True)


def test_the_largest_whirl_at_each_speed() -> None:
    found = answer()
    depth = machine().fills[0].depth
    for speed, amplitude in MARCHED:
        k = int(np.argmin(np.abs(found.speed - speed)))
        # 0.5 % of cells (64 against 128) and settling, and 0.1 % of straight lines between whirls.
        assert found.self_excited_amplitude[k] / depth == pytest.approx(amplitude, rel=0.01)
        assert found.cycles and found.self_excited_whirl_speed[k] == pytest.approx(95.0, rel=0.02)
    assert found.self_excited_amplitude[0] == 0.0 and np.isnan(found.self_excited_whirl_speed[0])
    # The band ends at 148.66 rad/s: beyond it a kick starts the whirl, which is reported.
    assert found.whirl is not None and found.whirl.large is not None
    assert found.whirl.large.kicked[-2:].all() and not found.whirl.large.kicked[found.growth > 0.0].any()
    (said,) = (note for note in found.notes if note.code == RunCode.LARGE_WHIRL)
    assert said.data["kicked"] == [(150.0, 155.0)] and "a kick starts it" in said.text


def test_a_little_unbalance_makes_it_beat() -> None:
    # The same machine with its unbalance in time: the mean is the whirl, and the range twice the response.
    found, scene = answer(), machine()
    k = int(np.argmin(np.abs(found.speed - 130.0)))
    large, small = found.self_excited_amplitude[k], found.amplitude[k]
    assert 0.02 < small / large < 0.2
    rotor = prepare(scene).rotor
    in_time = large_whirl_in_time(rotor, scene.fills, 130.0, scene.model.friction, 0.7 * large)
    assert in_time.amplitude == pytest.approx(large, rel=0.02)
    # The response on top of a whirl is not that to the even layer.
    assert in_time.spread * in_time.amplitude == pytest.approx(2.0 * small, rel=0.15)


def test_only_if_asked() -> None:
    scene = machine().replace({"speeds.count": 3})
    found = run_scene(scene)
    assert found.whirl is not None and found.whirl.large is None
    assert "cycles" not in found.to_json() and "self_excited_amplitude" not in found.named_arrays().variables
    assert not [note for note in found.notes if note.code == RunCode.LARGE_WHIRL]


def test_why_there_is_none() -> None:
    scene = machine().replace({"speeds.count": 3, "model.friction": "none"})
    found = run_scene(scene, cycles=True)
    (said,) = (note for note in found.notes if note.code == CycleCode.NO_CYCLES)
    assert "without friction" in said.text
    # Small whirls grow everywhere, for damping of the supports alone feeds the wave: not known, not 0.
    assert found.to_json()["self_excited_amplitude"] == [None, None, None]
    assert found.cycles == []


def test_a_single_speed() -> None:
    scene = machine().replace({"speeds.start": 130.0, "speeds.stop": 130.0, "speeds.count": 1})
    found = run_scene(scene, cycles=True)
    k = int(np.argmin(np.abs(answer().speed - 130.0)))
    assert found.self_excited_amplitude[0] == pytest.approx(answer().self_excited_amplitude[k], rel=2e-3)


def test_the_figure_shows_what_the_amplitude_beats_between() -> None:
    figure = amplitude_figure(answer())
    axes = figure.axes[0]
    (band,) = (c for c in axes.collections if c.get_label() == "beating with self-excited whirl")
    k = int(np.argmin(np.abs(answer().speed - 130.0)))
    large, small = answer().self_excited_amplitude[k], answer().amplitude[k]
    points = band.get_paths()[0].vertices
    here = points[np.abs(points[:, 0] - 130.0 * 30.0 / np.pi) < 1e-6, 1]
    assert here.min() == pytest.approx(1e3 * (large - small)) and here.max() == pytest.approx(
        1e3 * (large + small)
    )
    assert axes.get_ylim()[1] >= points[:, 1].max()
    assert "beating with self-excited whirl" in figure.alt


def test_one_speed_is_a_band_of_its_own() -> None:
    """A run at a single speed within the band says that a whirl grows there."""
    scene = load_scene(ROOT / "docs/examples/self_excited.toml")
    speed = scene.speed_array()
    middle = float(0.5 * (answer().whirl_bands[0][0] + answer().whirl_bands[0][1]))
    assert speed[0] < middle < speed[-1]
    at = {"speeds.start": middle, "speeds.stop": middle, "speeds.count": 1}
    found = run_scene(scene.replace(at))
    assert [tuple(band) for band in found.whirl_bands] == [(middle, middle)]
    assert not any("No whirl grows" in note.text for note in found.notes)
