"""Time-domain states: what a result says of them in numbers, notes, words, tables and exit codes."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.studies.held.answer import MOTIONS
from leblanc.studies.run import notes as notes
from leblanc.studies.run import words as words
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.motion import SelfExcited
from leblanc.studies.run.notes import RunCode
from meshes.errors import InputError
from tests.mutants import kills
from tests.oracles.data_files import assert_read_back
from tests.oracles.records import RPM, held_rig, rig

SOME = slice(8, 16)  # 860 to 1525 rpm: the limit cycles and two speeds more


def held_of(result: RunAnswer):
    assert result.held is not None
    return result.held


def at(result: RunAnswer, rpm: float) -> int:
    return int(np.argmin(np.abs(result.speed - rpm * RPM)))


def cut(result: RunAnswer, rpm: float) -> RunAnswer:
    """The speeds up to one, which is then the last."""
    last = np.arange(at(result, rpm) + 1)
    held = held_of(result)
    arrays = {
        name: value[last]
        for name, value in vars(held).items()
        if isinstance(value, np.ndarray) and value.shape[:1] == result.speed.shape
    }
    error = result.error_estimate
    assert error is not None
    response = result.response.at(last)
    return replace(result, response=response, held=replace(held, **arrays), error_estimate=error[last])


def test_json_and_data_file_have_the_same_motions(tmp_path: Path) -> None:
    result = held_rig(at=SOME)
    found = json.loads(json.dumps(result.to_json(), allow_nan=False))
    data = result.to_dataset()
    assert_read_back(result.named_arrays(), tmp_path)
    held = held_of(result)
    assert found["held_at"] == held.at.tolist() == (data["held_at"] == 1).values.tolist()
    assert found["state"].count("limit_cycle") == 3
    for key in (
        "held_error",
        "held_wave_error",
        "held_whirl_speed",
        "energy_error",
        "amplitude_down",
        "amplitude_min",
        "amplitude_max",
    ):
        np.testing.assert_array_equal(np.array(found[key], dtype=float), data[key].values)
        np.testing.assert_array_equal(np.array(found[key], dtype=float), getattr(result, key))
    assert [error is not None for error in found["energy_error"]] == held.at.tolist()
    for key in ("liquid_mean", "liquid_ripple"):
        assert [row != [None] and row != [[None, None]] for row in found[key]] == held.at.tolist()
    assert data["held_solver"].item() == found["held_solver"] == result.held_solver == "coupled"
    assert data["held_reason"].values.tolist() == found["held_reason"] == result.held_reason.tolist()
    meanings = data["state_down"].attrs["flag_meanings"].split()
    assert tuple(meanings) == MOTIONS
    shown = [meanings[int(value) + len(MOTIONS) - 2] for value in data["state_down"].values]
    assert shown == found["state_down"]


def test_a_motion_held_has_shown_its_own_stability() -> None:
    """Where linear theory knows nothing of the whirls the motion itself says what it is."""
    result = replace(held_rig(), whirl=SelfExcited(np.full(21, np.nan), np.full(21, np.nan), (), "none"))
    kinds = dict(zip(result.state.tolist(), result.stability.tolist(), strict=True))
    assert kinds == {"periodic": "stable", "limit_cycle": "unstable", "not_settled": "not_known"}


def test_the_note_tells_how_far_long_waves_are_off_at_the_whirls_of_cycles() -> None:
    result = held_rig(at=SOME)
    held = held_of(result)
    known = notes.held_motions(held, result.speed)[0]
    assert "; long waves are off by up to 0.2 % there." in known.text and known.data["waves_not_known"] == 0
    errors = held.wave_error.copy()
    errors[np.flatnonzero(held.limit_cycle)[:2]] = np.nan
    for some, said in (
        (errors, "not known at 2 of them: no smooth wave"),
        (errors * np.nan, "not known there"),
    ):
        told = notes.held_motions(replace(held, wave_error=some), result.speed)[0]
        assert said in told.text and told.data["waves_not_known"] >= 2
    # Of fully nonlinear waves nothing is said, nor where it was never asked.
    for other in (replace(held, model="potential", wave_error=errors * np.nan),):
        assert "waves are off" not in notes.held_motions(other, result.speed)[0].text


def test_limits_tell_cycles_from_what_is_unstable() -> None:
    rows = {limit.label: limit for limit in words.checks(held_rig())}
    largest = held_of(held_rig()).largest[held_of(held_rig()).limit_cycle].max() * 1e3
    assert rows["Limit cycle"].where == f"1145 to 1335 rpm, amplitude up to {largest:.4g} mm"
    assert (rows["Not converged in time"].where, rows["Up and down differ"].where) == ("195 rpm", "1430 rpm")
    assert not rows["Answer unstable"].grade
    assert not {"Not converged", "Stability not known"} & set(rows)
    # Nothing of all this where no motion was held.
    assert not {"Limit cycle", "Not converged in time", "Up and down differ"} & {
        x.label for x in words.checks(rig())
    }


def test_the_answer_says_that_a_number_is_a_mean() -> None:
    result = cut(held_rig(), 1240.0)
    k, held = at(result, 1240.0), held_of(result)
    mean, least, largest = (x[k] * 1e3 for x in (result.amplitude, held.least, held.largest))
    said = words.answer(result)
    found = re.search(r"is ([\d.]+) \N{PLUS-MINUS SIGN} ([\d.]+) mm on average", said)
    assert found is not None and abs(float(found[1]) - mean) <= 0.05 * float(found[2])
    assert f"mm on average (limit cycle, between {least:.4g} and {largest:.4g} mm)" in said
    # Two per mille are not spoken of, two percent are.
    assert "on average" not in words.answer(held_rig())
    calm = held_of(held_rig())
    stirred = replace(held_rig(), held=replace(calm, largest=1.02 * calm.largest))
    assert words.answer(stirred).count("on average") == 2
    assert words.answer(stirred).count("limit cycle") == 0


def test_an_unsettled_number_is_said_to_be_one() -> None:
    assert "(out of range, not converged in time)" in words.answer(cut(held_rig(), 195.0))


def test_notes_count_what_was_held() -> None:
    held, speed = held_of(held_rig()), held_rig().speed
    motions, restless = notes.held_motions(held, speed)
    assert motions.code is RunCode.HELD and restless.code is RunCode.NOT_SETTLED
    assert dict(motions.data) == {
        "held": 21, "cells": 128, "error": 3e-3, "limit_cycles": 3, "hysteresis": 1,
        "wave_error": 2e-3, "waves_not_known": 0,
    }  # fmt: skip
    assert "Limit cycles at 3, between 1145 and 1335 rpm;" in motions.text
    assert "at 195 rpm: the motion still changes after 1024 turns" in restless.text
    settled = replace(held, state=np.where(held.not_settled, "periodic", held.state))
    assert [note.code for note in notes.held_motions(settled, speed)] == [RunCode.HELD]
    leaky = replace(settled, energy_error=np.where(held.limit_cycle, 4e-3, np.nan))
    assert [note.code for note in notes.held_motions(leaky, speed)] == [RunCode.HELD, RunCode.ENERGY]
    assert "leaves up to 0.4%" in notes.held_motions(leaky, speed)[-1].text


def test_what_has_not_settled_on_the_way_down_is_no_hysteresis() -> None:
    held = held_of(held_rig())
    (k,) = np.flatnonzero(held.hysteresis)
    lost = held.state_down.copy()
    lost[k] = "not_settled"
    result = replace(held_rig(), held=replace(held, state_down=lost))
    assert not held_of(result).hysteresis.any()
    assert {limit.label: limit.where for limit in words.checks(result)}["Up and down differ"] == "none"
    assert len(words.held_motions(result)) == 1


@kills("leblanc.studies.run.notes:plane", 'turns = ", of', 'turns = "" and ", of')
def test_the_plane_says_that_an_amplitude_is_a_mean() -> None:
    """Where motions are integrated in time every turn has a largest radius of its own."""
    for held in (False, True):
        assert ("mean over the turns" in notes.plane(0.1, "unbalance", True, held).text) is held


def test_slow_disturbances_are_spoken_of_where_nothing_was_held() -> None:
    """A motion integrated in time has met every disturbance, slow or not."""
    assert notes.slow_disturbances(held_of(held_rig())) is None
    some = notes.slow_disturbances(held_of(held_rig(at=SOME)))
    assert some is not None and some.text.startswith("Where no motion was integrated in time")
    plain = notes.slow_disturbances()
    assert plain is not None and plain.text.startswith("Branches are evaluated")


def test_report_tells_cycles_by_ranges_of_speed() -> None:
    cycles, apart = words.held_motions(held_rig())
    (row,) = cycles.rows
    result = held_rig()
    of = held_of(result).limit_cycle
    mean, whirl = result.amplitude[of] * 1e3, held_of(result).whirl_speed[of] / RPM
    assert row[0] == "1145 to 1335"
    assert row[1] == f"{mean.min():.4g} to {mean.max():.4g}"
    assert float(row[2]) == pytest.approx(held_of(result).least[of].min() * 1e3, rel=1e-3)
    assert float(row[3]) == pytest.approx(held_of(result).largest[of].max() * 1e3, rel=1e-3)
    assert row[4] == f"{whirl.min():.4g} to {whirl.max():.4g}"
    (row,) = apart.rows
    assert row[0] == "1430" and row[1].startswith("periodic, ") and row[2].startswith("limit cycle, ")
    assert words.held_motions(rig()) == ()


@pytest.mark.usefixtures("undrawn")
def test_exit_code_3_says_what_has_not_settled_and_what_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("leblanc.studies.run.study.run_scene", lambda *_, **__: held_rig())
    scene = Path(__file__).parents[3] / "examples/horizontal_rig.toml"
    assert main(["run", str(scene), "--out", str(tmp_path)]) == 3
    said = " ".join(capsys.readouterr().err.split())
    assert "not converged in time at 1 of 21 speeds" in said
    assert "195 rpm (the motion still changes after 1024 turns)" in said
    assert "held" in said and "no bounded deflection" not in said
    assert (tmp_path / "response.nc").exists() and (tmp_path / "summary.html").exists()


def test_the_answer_does_not_depend_on_the_workers() -> None:
    scene = lb.example("horizontal_rig").replace(
        {
            "model.liquid": "long_wave", "model.cells": 16, "model.friction": {"linear": 20.0},
            "speeds.start": "1600 rpm", "speeds.stop": "1800 rpm", "speeds.count": 2,
        }
    )  # fmt: skip
    alone, two = (lb.run(scene, workers=count).to_json() for count in (1, 2))
    assert alone == two and set(alone["model"]) == {"long_wave"}
    with pytest.raises(InputError, match="workers"):
        lb.run(scene, workers=0)
