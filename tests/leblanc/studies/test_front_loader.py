"""The front loader in time: what cells change of its peaks, its holds against time-domain states."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import leblanc as lb
from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from leblanc.scene.scene import Scene
from leblanc.studies.runup.notes import RunupCode, numerical_error
from leblanc.studies.runup.study import runup_scene
from leblanc.studies.runup.words import known, peak_known, sentence
from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.pypde.coupled import RotorLayersPDE
from solvers.rotor.jeffcott import Jeffcott
from tests.mutants import kills

BEGIN = ["to 45 rpm in 2 s", "hold 2 s", "to 90 rpm in 4 s", "hold 4 s"]


def machine(*steps: str) -> Scene:
    return lb.example("front_loader").replace({"programme.steps": [*BEGIN, *steps], "model.friction": "wall"})


@cache
def peaks(cells: int) -> Array:
    """Largest amplitude of each step of the way past the capture, m.

    The middle of three runs whose unbalance differs in its tenth digit: by rounding alone the passage after
    the capture differs by up to a tenth.
    """
    way, runs = machine("to 400 rpm at 40 rpm/s", "hold 1 s"), []
    for k in range(3):
        own = way.replace({"rotor.loads.0.size": 0.092 * (1.0 + 1e-10 * k)})
        found = runup_scene(own, cells=cells, check=False)
        assert found.converged
        runs.append([passage.amplitude for passage in found.passages])
    return np.median(runs, axis=0)


@pytest.mark.slow
def test_peaks_hardly_know_the_cells() -> None:
    """128 and 256 cells agree within 1 %, eight cells between two baffles within 3 %."""
    np.testing.assert_allclose(peaks(128), peaks(256), rtol=0.01)
    np.testing.assert_allclose(peaks(64), peaks(256), rtol=0.03)


@pytest.mark.slow
def test_peak_error_covers_more_cells() -> None:
    """What half the cells change of the largest amplitude is more than what four times the cells do.

    Half the cells are four between two baffles, which have no slopes beside them: some 6 %.
    """
    found = runup_scene(machine("to 400 rpm at 40 rpm/s", "hold 1 s"), cells=64)
    error = found.peak_error["cells"]
    assert abs(peaks(64).max() - peaks(256).max()) < error < 0.1 * peaks(64).max()


@pytest.mark.slow
def test_a_hold_is_a_motion_held_in_time() -> None:
    """The tub goes round as in the periodic motion of the same speed once the swings of the run-up have died.

    The slowest modes lose 3 % of critical damping at 0.7 Hz: after 25 s they are down to 4 %.
    """
    still = {f"rotor.loads.{j}.sheds": None for j in range(2)}
    scene = machine("to 400 rpm at 40 rpm/s", "hold 25 s").replace(still)
    found = runup_scene(scene, check=False)
    late = found.time > found.time[-1] - 2.0
    speed = 400.0 * math.pi / 30.0
    speeds = {"speeds.start": 0.999 * speed, "speeds.stop": speed, "speeds.count": 2, "model.held": "always"}
    held = lb.run(scene.replace(speeds))
    assert held.model[-1] == "long_wave" and held.state[-1] == "periodic"
    low, high = float(held.amplitude_min[-1]), float(held.amplitude_max[-1])
    # An ellipse: its mean radius is that of the two halves to the square of what they differ by.
    assert found.amplitude[late].mean() == pytest.approx(0.5 * (low + high), rel=0.01)
    assert found.amplitude[late].max() == pytest.approx(high, rel=0.05)


def test_motions_held_with_many_baffles() -> None:
    """Which layers stand is known before anything is known of the resolution."""
    fill = Fill(Chamber(0.24, 0.06, baffles=Baffles(8, 0.231)), Liquid("brine", 1200.0, 1.6e-6), 1.2e-3)
    rotor = Jeffcott(60.0, 11196.0, 309.0, 0.05)
    assert RotorLayersPDE(rotor.system(), [fill], 40.0, friction=Friction(), gravity=9.81).layers.all()


@kills("leblanc.studies.runup.words:peak_known", "len(named) > 1", "len(named) > 2")
@kills("leblanc.studies.runup.words:peak_known", "percent(size / largest)", "percent(error / largest)")
def test_what_a_reader_is_told() -> None:
    """The headline has the peak's error, its cause where it is large, and for how long the model holds."""
    short = lb.example("runup").replace({"runup.duration": "1 s", "runup.cells": 16})
    found = runup_scene(short, samples=50, check=False)
    found = replace(found, in_range=np.ones(found.time.size, dtype=bool))
    assert peak_known(found) == "" and "for all of the run" in sentence(found)
    largest = float(found.history.largest.max())
    for gaps, told in (
        ((0.01, math.nan, math.nan), "(1 %)"),
        ((0.04, 0.0, 1e-9), "(4 %)"),
        ((0.15, 0.05, 0.0), "(20 %): cells and steps 15 %, pool-annulus transition 5 %"),
        ((0.05, 0.13, 0.02), "(20 %): cells and steps 5 %, pool-annulus transition 13 %, rounding 2 %"),
    ):
        history = replace(found.history, peak_gaps=tuple(gap * largest for gap in gaps))
        one = replace(found, history=history)
        assert peak_known(one).endswith(told) and peak_known(one) in sentence(one)
        assert ("Largest of all known to", peak_known(one)) in known(one)
    half = replace(found, in_range=np.arange(found.time.size) % 2 == 0)
    assert f"for {100.0 * half.in_range.mean():.3g} % of the run" in sentence(half)


def test_a_look_that_is_too_coarse_says_so() -> None:
    """Without the check, with fewer than 64 cells, for liquid that lies at the bottom first."""
    own = lb.example("front_loader").replace({"programme.steps": ["to 20 rpm in 0.05 s"]})
    codes = {note.code for note in runup_scene(own, cells=32, check=False).notes}
    assert RunupCode.TOO_COARSE in codes and RunupCode.ERROR_UNKNOWN not in codes
    for error, cells, code in (
        (math.nan, 63, RunupCode.TOO_COARSE),
        (math.nan, 64, RunupCode.ERROR_UNKNOWN),
        (math.nan, None, RunupCode.ERROR_UNKNOWN),  # upright, or linear layers
        (0.5, 32, RunupCode.ROUGH),
    ):
        note = numerical_error(error, cells)
        assert note is not None and note.code is code
    assert numerical_error(1e-3, 32) is None
