"""Emulators of a sweep: between the samples they give what the solvers give, to the error they tell."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from leblanc.cli import main
from leblanc.scene.scene import scene_from_table
from leblanc.scene.schema.paths import keys_of, with_values
from leblanc.studies.sweep.batch import answer_scenes
from leblanc.studies.sweep.emulator import emulate_store, emulated_outputs, varied_fields
from leblanc.studies.sweep.plan import Sweep
from leblanc.studies.sweep.store import Store
from leblanc.studies.sweep.study import run_sweep
from meshes.errors import InputError
from tests.oracles.sweeps import STUDY, study_in

SMOOTH = """
scene = "scene.toml"
method = "sobol"
samples = 64
seed = 3

[vary]
"rotor.mass" = { uniform = ["3 kg", "12 kg"] }
"rotor.damping_ratio" = { uniform = [0.05, 0.3] }
"""


def swept(folder: Path, study: str = SMOOTH) -> tuple[Sweep, Store]:
    plan = study_in(folder, study)
    return plan, run_sweep(plan, folder, workers=0)


def test_between_samples(tmp_path: Path) -> None:
    """Fresh scenes: as far off as cross-validation says, in the order of the study's fields."""
    plan, store = swept(tmp_path)
    emulator = emulate_store(store, "last_amplitude")
    assert emulator.fields == varied_fields(store) == ("rotor.mass", "rotor.damping_ratio")
    fresh = emulator.low + np.random.default_rng(1).random((40, 2)) * (emulator.high - emulator.low)
    paths = [keys_of(name) for name in emulator.fields]
    scenes = [
        scene_from_table(with_values(plan.table, zip(paths, row, strict=True))) for row in fresh.tolist()
    ]
    off = emulator.predict(fresh)[0] / answer_scenes(scenes).amplitude[:, -1] - 1.0
    # A fold knows four fifths of the samples; 64 of them scatter.
    assert np.sqrt(np.mean(off**2)) < 2.0 * emulator.error.root_mean_square < 0.1 * emulator.error.spread


def test_samples_that_are_not_done_are_left_out(tmp_path: Path) -> None:
    wide = SMOOTH.replace('"rotor.damping_ratio" = { uniform = [0.05, 0.3] }', "").replace("64", "40")
    wide += '"chambers.0.volume" = { uniform = ["10 ml", "350 ml"] }\n'
    _, store = swept(tmp_path, wide)
    done = int(np.sum(store.read("status") == 1))
    assert 20 <= done < 40
    assert emulate_store(store, "peak_amplitude").error.samples == done


def test_what_cannot_be_emulated_is_said(tmp_path: Path) -> None:
    _, store = swept(tmp_path, STUDY.replace("256", "32"))
    with pytest.raises(InputError, match="no measure for words"):
        emulate_store(store, "last_amplitude")
    with pytest.raises(InputError, match="peak_amplitude"):
        emulate_store(store, "amplitude")
    with pytest.raises(InputError, match="store of a sweep"):
        emulate_store(tmp_path / "nowhere", "last_amplitude")
    assert all("words" in str(one) for one in emulated_outputs(store).values())


@pytest.mark.usefixtures("undrawn")
def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study_in(tmp_path, SMOOTH)
    arguments = ["sweep", str(tmp_path / "study.toml"), "--workers", "0", "--out", str(tmp_path), "--emulate"]
    assert main(arguments) == 0
    assert "emulator of last amplitude: off by" in capsys.readouterr().out
    assert main([*arguments, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["emulators"]
    assert found["last_amplitude"]["error"]["samples"] == 64
    # The rotor without liquid does vary with its mass.
    assert found["peak_amplitude_dry"]["error"]["root_mean_square"] > 0.0
