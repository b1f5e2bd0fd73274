"""`leblanc run`: the JSON that scripts rely on, the files, the exit codes."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.scene import load_scene, scene_from_table
from leblanc.studies.run.study import run_scene
from meshes.errors import InputError
from tests.leblanc.studies.test_explain import table
from tests.mutants import kills

KEYS = {
    "speed", "amplitude", "amplitude_dry", "phase", "liquid_offset", "liquid_angle", "dry_patch",
    "stable", "model",
}  # fmt: skip
EXAMPLES = ["horizontal_rig", "centrifuge"]
MORE = [pytest.param(name, marks=pytest.mark.slow) for name in ("vertical_rig", "washing_machine")]


@pytest.mark.parametrize("name", [*EXAMPLES, *MORE])
def test_examples(name: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["run", f"examples/{name}.toml", "--json", "--out", str(tmp_path)]) == 0
    out, _ = capsys.readouterr()
    answer = json.loads(out)
    assert answer.keys() >= KEYS
    speeds = len(answer["speed"])
    assert all(len(answer[key]) == speeds for key in KEYS)
    assert all(one > 0.0 for one in answer["amplitude"])
    # The branch reported is stable against slow disturbances; what is not stable whirls by itself, between
    # edges that were found in another way than the growth at each speed.
    bands, pairs = (
        answer["whirl_bands"],
        zip(answer["speed"], answer["growth"], answer["stable"], strict=True),
    )
    for speed, growth, stable in pairs:
        inside = any(low < speed < high for low, high in bands)
        at_edge = any(abs(speed / edge - 1.0) < 1e-7 for band in bands for edge in band)
        assert stable == (growth <= 0.0) and (stable != inside or at_edge)
    assert 0 < sum(answer["stable"]) < speeds
    # External damping only: the deflection lags the unbalance by no more than half a turn.
    assert all(-math.pi <= one <= 0.0 or one == math.pi for one in answer["phase"])
    with xr.open_dataset(tmp_path / "response.nc") as data:
        assert data.sizes["speed"] == speeds
        assert data["speed"].attrs["units"] == "rad s-1"
    for figure in ("amplitude", "liquid", "phase", "chamber"):
        assert (tmp_path / f"{figure}.svg").stat().st_size > 10_000
    summary = (tmp_path / "summary.html").read_text(encoding="utf-8")
    assert load_scene(f"examples/{name}.toml").name in summary
    assert not [p for p in tmp_path.iterdir() if ".part" in p.name]


def test_same_scene_same_answer() -> None:
    scene = load_scene("examples/horizontal_rig.toml")
    a, b = run_scene(scene).response, run_scene(scene).response
    np.testing.assert_array_equal(a.deflection, b.deflection)


def test_notes_say_what_the_model_leaves_out() -> None:
    notes = " ".join(map(str, run_scene(scene_from_table(table())).notes))
    assert "gravity" in notes and "elf-excited whirl" in notes
    upright = " ".join(map(str, run_scene(scene_from_table(table(axis="vertical"))).notes))
    assert "gravity across" not in upright


def test_undamped_resonance_is_exit_code_3(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(
        'name = "undamped"\n[rotor]\nkind = "jeffcott"\nmass = 4.0\nstiffness = 40000.0\ndamping = 0.0\n'
        'unbalance = 6e-4\naxis = "vertical"\n[[chambers]]\nradius = 0.065\nheight = 0.02\nvolume = 0.0\n'
        'liquid = "water"\n[speeds]\nstart = 99.0\nstop = 101.0\ncount = 3\n'
    )
    assert main(["run", str(scene), "--json", "--out", str(tmp_path / "out")]) == 3
    out, err = capsys.readouterr()
    answer = json.loads(out)
    assert answer["amplitude"][1] is None and answer["amplitude"][0] > 0.0
    assert "100 rad/s" in err and "Traceback" not in err
    assert (tmp_path / "out" / "response.nc").exists()


def test_unwritable_output(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    assert main(["run", "examples/centrifuge.toml", "--out", str(blocked / "deeper")]) == 2
    out, err = capsys.readouterr()
    assert out == "" and str(blocked) in err and "Traceback" not in err


@pytest.mark.parametrize("model", ["kdv", "statics"])
def test_a_model_that_does_not_answer_writes_nothing(
    model: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    text = Path("examples/centrifuge.toml").read_text(encoding="utf-8").replace('"auto"', f'"{model}"')
    scene = tmp_path / "scene.toml"
    # Baffles that cut the liquid into compartments.
    scene.write_text(text.replace("[[chambers]]", "[[chambers]]\nbaffles = { count = 4 }"), encoding="utf-8")
    assert main(["run", str(scene), "--out", str(tmp_path / "out")]) == 2
    assert "model.liquid" in capsys.readouterr().err
    assert not list((tmp_path / "out").glob("*"))


def test_a_solver_for_motions_that_nobody_holds() -> None:
    """A solver is named for time-domain states: where the scene forbids them it would go unheard."""
    with pytest.raises(InputError, match=r"solver.*scipy.*\[model\] held"):
        lb.run(lb.example("runup"), solver="scipy")
    asked = lb.example("runup").replace({"model.liquid": "long_wave", "speeds.count": 2})
    with pytest.raises(InputError, match=r"solver.*nosuch.*runge-kutta"):
        lb.run(asked, solver="nosuch")


@kills("leblanc.studies.held.held:hold_answer", " + _left_out(machine, began.answer.at(rows))", "")
def test_held_waves_know_that_they_leave_out_gravity_along_the_axis() -> None:
    """Where the wall begins to run dry, the depth along the axis counts for more than the cells do."""
    scene = lb.example("runup").replace(
        {"speeds.start": "186 rpm", "speeds.stop": "187 rpm", "speeds.count": 2, "model.cells": 32}
    )
    exact = lb.run(scene.replace({"model.liquid": "statics"}))
    found = lb.run(scene.replace({"model.liquid": "long_wave"}))
    assert found.error_estimate is not None
    change = np.abs(found.amplitude / exact.amplitude - 1.0)
    assert (change < found.error_estimate).all()
    assert (found.error_estimate > found.held_error + 0.01).all()


def test_pixels_where_asked_for(tmp_path: Path) -> None:
    """Figures are lines; `--png` and `write(png=True)` bring the same in pixels."""
    lines, typed, written = (tmp_path / name for name in ("lines", "typed", "written"))
    scene = "examples/centrifuge.toml"
    assert main(["run", scene, "--out", str(lines)]) == 0
    assert main(["run", scene, "--png", "--out", str(typed)]) == 0
    written.mkdir()
    lb.run(scene).write(written, png=True)
    drawn = {path.stem for path in lines.glob("*.svg")}
    assert len(drawn) > 3 and not list(lines.glob("*.png"))
    for folder in (typed, written):
        assert {path.stem for path in folder.glob("*.png")} == drawn
        assert all((folder / f"{name}.png").read_bytes().startswith(b"\x89PNG") for name in drawn)
