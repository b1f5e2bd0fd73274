"""A scene's spin programme: its passages up and down, told in JSON, text, figures and report."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.units import number
from leblanc.scene.examples import example_path
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.studies.drives import rotor_in_time
from leblanc.studies.optimise.objectives import RunupPeak
from leblanc.studies.runup.answer import RunupAnswer, pieces
from leblanc.studies.runup.figure import speed_figure, time_figure
from leblanc.studies.runup.notes import RunupCode
from leblanc.studies.runup.words import passages
from meshes.errors import InputError
from tests.mutants import kills

STEPS = ["to 60 rad/s in 4 s", "hold 1 s", "to 20 rad/s in 3 s", "to 45 rad/s in 3 s", "coast to 8 rad/s"]


def machine(**changes: object) -> Scene:
    """The machine of examples/runup.toml through a programme with two ways up and two down."""
    table = lb.example("runup").table()
    del table["runup"]
    own = {
        "start": "5 rad/s",
        "steps": STEPS,
        "inertia": 0.5,
        "drag_torque": 3.0,
        "cells": 32,
        "samples": 400,
    }
    table |= {"programme": own | changes, "assumed": []}
    return scene_from_table(table)


def test_too_few_cells_for_compartments_are_refused_where_they_stand() -> None:
    """By the programme's name where the scene has them, by the option's where it was typed."""
    closed = {"chambers.0.inner_radius": 0.2, "chambers.0.baffles": {"count": 10, "tip_radius": 0.2}}
    scene = machine().replace(closed)
    with pytest.raises(InputError, match=r"programme\.cells = 32: must be 40 or more, 4 in each compartment"):
        lb.run_up(scene)
    with pytest.raises(InputError, match=r"^cells = 16: must be 40 or more"):
        lb.run_up(scene, cells=16)


@pytest.fixture(scope="module")
def result() -> RunupAnswer:
    return lb.run_up(machine())


@kills("leblanc.studies.runup.answer:RunupAnswer._falls", 'passage.way == "down"', 'passage.way != "up"')
def test_each_passage_has_its_peak(result: RunupAnswer) -> None:
    """Those up and those down, apart; the largest of all is that of every step kept in the run."""
    ways = [passage.way for passage in result.passages]
    assert ways == ["up", "hold", "down", "up", "down"] and result.turns_back
    # Each begins where the one before ends, the first at the beginning.
    for one, other in zip(result.passages, result.passages[1:], strict=False):
        assert one.end == other.begin and one.speed_end == other.speed_begin
    assert result.passages[0].begin == 0.0 and result.passages[-1].end == result.time[-1]
    down = max(passage.amplitude for passage in result.passages if passage.way == "down")
    up = max(passage.amplitude for passage in result.passages if passage.way != "down")
    assert result.peak["amplitude"] == up and result.peak_back["amplitude"] == down
    assert max(up, down) == result.history.largest.max()
    # The resonance at 25 rad/s is passed each time but while the speed is held.
    assert all(20.0 < passage.speed < 35.0 for passage in result.passages if passage.way != "hold")
    np.testing.assert_array_equal(result.falling[1:], np.diff(result.speed) < 0.0)


def test_curves_have_every_sample_once(result: RunupAnswer) -> None:
    time, speed, amplitude = result.whole_curve()
    assert set(result.time) <= set(time) and time.size <= result.time.size + 2 and (np.diff(time) > 0.0).all()
    assert np.nanmax(amplitude) == result.history.largest.max()
    for back in (False, True):
        time, speed, _ = result.curve(back)
        assert np.isnan(time).sum() == 1
        for part in pieces(result.falling == back):
            inner = np.diff(result.speed[part])
            assert (inner <= 0.0).all() if back else (inner >= -1e-9).all()
    assert np.isnan(speed).sum() == 1


def test_without_liquid_at_the_same_times(result: RunupAnswer) -> None:
    """While the speed is given both have it; a coast of another length is given at the times of this one."""
    given = result.time <= result.passages[-1].begin
    np.testing.assert_allclose(result.speed_dry[given], result.speed[given], rtol=1e-9)
    dry = result.history_dry
    assert dry is not None and dry.time[-1] != result.time[-1]
    common, ours, theirs = np.intersect1d(result.time, dry.time, return_indices=True)
    assert common.size > 0.9 * result.time.size
    np.testing.assert_array_equal(result.speed_dry[ours], dry.speed[theirs])
    assert all(np.isfinite(passage.amplitude_dry) for passage in result.passages)


def test_notes(result: RunupAnswer) -> None:
    codes = {note.code for note in result.notes}
    assert not codes & {RunupCode.STANDING, RunupCode.NO_DRAG, RunupCode.COAST_NOT_ENDED}
    short = ["to 40 rad/s in 2 s", "coast to 0"]
    free = lb.run_up(machine(start=0, steps=short, drag_torque=0.0, coast_limit=2.0), check=False)
    codes = {note.code for note in free.notes}
    assert codes >= {RunupCode.STANDING, RunupCode.NO_DRAG, RunupCode.COAST_NOT_ENDED}
    assert free.time[-1] == pytest.approx(4.0, rel=1e-12)


def test_what_is_shown(result: RunupAnswer) -> None:
    told = json.loads(json.dumps(result.to_json()["passages"]))
    assert [part["way"] for part in told] == [part.way for part in result.passages]
    assert told[4]["text"] == STEPS[4].replace("8 rad/s", "76.39 rpm")
    table, passage = passages(result), result.passages[4]
    assert table.rows[4][:2] == ("5", "coast to 76.39 rpm")
    assert table.rows[4][4] == number(passage.speed * 30.0 / np.pi)
    axes = speed_figure(result).axes[0]
    drawn = {line.get_label() for line in axes.get_lines()}
    assert {"run-up", "run-down", "run-down, without liquid"} <= drawn
    texts = {text.get_text() for legend in time_figure(result).legends for text in legend.get_texts()}
    assert "motor off" in texts


def test_films_and_ensembles() -> None:
    """Frames at regular times, to the end of a coast; runs that differ by rounding, sample by sample."""
    scene = machine(steps=STEPS[:2] + STEPS[4:], samples=200)
    found = lb.run_up(scene, check=False, frames=20, ensemble=2)
    frames, spread = found.frames, found.spread
    assert frames is not None and spread is not None
    assert 17 <= frames.time.size <= 20 and set(frames.time) <= set(found.time)
    np.testing.assert_array_equal(frames.speed, found.speed[np.isin(found.time, frames.time)])
    assert np.diff(frames.time).max() < 1.5 * np.diff(frames.time).min()
    # Until the wall runs dry, in the coast, rounding is all; then a drum coasts for other times as well.
    width = (spread.amplitude_max - spread.amplitude_min)[found.time < 10.0]
    assert spread.lost == 0 and width.max() < 1e-9 * found.peak["amplitude"]
    assert spread.largest_spread < 0.01 and np.isfinite(spread.amplitude_max[:-2]).all()


def test_what_explain_says_before() -> None:
    assert "coasting drum feels the torque" in lb.explain(machine()).runup
    driven = machine(steps=STEPS[:3]).replace({"model.tolerance": 0.05})
    assert "linear layers first" in lb.explain(driven).runup


def test_the_objective_takes_the_way_down_too() -> None:
    """Largest over the whole programme, with the cells of the scene."""
    scene = machine()
    found = RunupPeak(scene).exact(np.array([[5e-4]]))
    assert found[0] == lb.run_up(scene, check=False).history.largest.max()


@pytest.mark.usefixtures("undrawn")
def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.toml"
    text = example_path("programme").read_text(encoding="utf-8")
    scene.write_text(text.replace('"to 1000 rpm at', '"to 500 rpm at'), encoding="utf-8")
    assert main(["runup", str(scene), "--no-check", "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr().out
    assert "coast to a stand" in said and "Largest on the way down" in said
    report = (tmp_path / "out" / "runup.html").read_text(encoding="utf-8")
    assert "Steps of the programme" in report and "coast to a stand" in report


def test_a_motor_limits_a_programme() -> None:
    """From the file to the note, the key and the data; the torque told is the motor's, drag included."""
    torques = {"speeds": [0.0, 100.0], "torques": [9.0, 9.0]}
    points = [{"name": "shaft", "position": [0.0, 0.0, 0.0]}]
    steps = ["to 60 rad/s in 1 s", "hold 1 s"]
    scene = machine(motor=torques, steps=steps).replace({"points": points})
    found = lb.run_up(scene, check=False)
    assert found.model == "long_wave"
    (note,) = (note for note in found.notes if note.code is RunupCode.MOTOR_LIMITED)
    assert note.data["step"] == 1 and note.data["reached"] and "follows the motor" in note.text
    limited = np.array(found.to_json()["motor_limited"])
    assert limited.any() and not limited.all()
    np.testing.assert_array_equal(found.to_dataset()["motor_limited"].values, limited)
    assert found.loads is not None
    # Between two samples the motor's own torque is reported to what the sums over steps leave.
    np.testing.assert_allclose(found.loads.torque[limited], 9.0, rtol=0.03)
    assert "Motor's torque" in {label for label, *_ in found.inputs}
    assert found.speed[-1] == pytest.approx(60.0, rel=1e-4)


def test_water_that_leaves_makes_the_drum_lighter() -> None:
    """The same unbalance leaves with mass and without: the drum that loses mass is slowed faster."""
    sheds = {"share": 0.9, "time_constant": "1 s", "above": "20 rad/s"}
    steps = ["to 60 rad/s in 0.5 s", "hold 0.5 s", "coast 0.5 s"]
    table = machine(steps=steps, cells=16, samples=50).table()
    ends = []
    for mass in ({}, {"mass": "0.5 kg"}):
        rotor = table["rotor"] | {"sheds": sheds | mass}
        scene = scene_from_table(table | {"rotor": rotor})
        (shed,) = rotor_in_time(scene).sheds
        if mass:
            assert shed.mass is not None
            np.testing.assert_allclose(shed.mass, 0.5 * np.eye(2))
            unbalance = scene.rotor.unbalance  # type: ignore[union-attr]
            assert shed.inertia == pytest.approx((0.9 * unbalance) ** 2 / 0.5)
        found = lb.run_up(scene, check=False)
        ends.append(found.speed[-1])
    assert ends[1] < ends[0]
