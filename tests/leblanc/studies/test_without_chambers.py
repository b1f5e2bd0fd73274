"""A machine without chambers: every command that needs no liquid answers, the others refuse in one line."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.disk import write
from leblanc.core.page import About
from leblanc.scene.inputs import about
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.studies.run.answer import OF_LIQUID
from leblanc.studies.run.study import run_scene
from leblanc.studies.runup.answer import OF_LIQUID as OF_LIQUID_IN_TIME
from leblanc.studies.runup.study import runup_scene
from leblanc.studies.sweep.batch import answer_scenes
from tests.oracles.pages import write_page_of

ROUNDING = 1e-12
JEFFCOTT = """
name = "Rotor alone"
[rotor]
kind = "jeffcott"
mass = "30 kg"
stiffness = "15 N/mm"
damping = "60 N*s/m"
unbalance = "2 kg*mm"
axis = "horizontal"
[speeds]
start = "8 rad/s"
stop = "90 rad/s"
count = 12
[runup]
start = "15 rad/s"
stop = "30 rad/s"
rate = "30 rad/s^2"
duration = "1 s"
cells = 16
"""
UNREAD = {"liquid": "potential", "friction": {"quadratic": 0.01}, "held": "always", "cells": 127}


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    (tmp_path / "rotor.toml").write_text(JEFFCOTT)
    return lb.load_scene(tmp_path / "rotor.toml")


def with_table(scene: Scene, **tables: Any) -> Scene:
    return scene_from_table(scene.table() | tables)


def test_closed_form_of_a_planar_rotor(scene: Scene) -> None:
    """w = m e W^2/(k - M W^2 + i c W), by hand."""
    found, spin = lb.run(scene), np.linspace(8.0, 90.0, 12)
    exact = 2e-3 * spin**2 / (15e3 - 30.0 * spin**2 + 60j * spin)
    np.testing.assert_allclose(found.deflection, exact, rtol=ROUNDING)
    np.testing.assert_allclose(found.amplitude, found.amplitude_dry, rtol=ROUNDING)
    # Free whirl of the rotor alone dies with half its damping over its mass.
    np.testing.assert_allclose(found.growth, -1.0, rtol=1e-9)
    assert found.stable.all()


@pytest.mark.parametrize("name", ["horizontal_rig", "vertical_rig", "two_plane_rig", "tub", "top_loader"])
def test_it_is_the_same_machine_with_a_chamber_without_its_liquid(name: str) -> None:
    full = lb.example(name)
    table = full.table() | {"speeds": full.speeds.table() | {"count": 7}}
    table.pop("assumed", None)
    # Amplitudes are those at the first chamber: here at the origin, as without one.
    table["chambers"] = [{**full.chambers[0].table(), "volume": 0.0, "plane": 0.0}]
    wet = run_scene(scene_from_table(table))
    alone = run_scene(scene_from_table({key: value for key, value in table.items() if key != "chambers"}))
    np.testing.assert_allclose(alone.amplitude, wet.amplitude_dry, rtol=1e-9)
    np.testing.assert_allclose(alone.deflection_dry, wet.deflection_dry, rtol=1e-9)
    assert alone.critical_speed_dry == pytest.approx(wet.critical_speed_dry, rel=1e-9)
    assert alone.to_json()["critical_speed_wet"] is None


def test_the_table_of_the_liquid_model_is_not_read(scene: Scene) -> None:
    other = with_table(scene, model=UNREAD)
    assert other.digest == scene.digest
    assert lb.run(other).to_json() == lb.run(scene).to_json()
    assert lb.explain(other).to_json() == lb.explain(scene).to_json()
    np.testing.assert_array_equal(lb.run_up(other).amplitude, lb.run_up(scene).amplitude)
    # It is kept: a chamber that is added is answered by it.
    assert other.replace({"speeds.count": 3}).model.liquid == "potential"


def test_keys_of_the_liquid_are_empty_lists(scene: Scene) -> None:
    answer, told = lb.run(scene).to_json(), lb.explain(scene).to_json()
    for name in ("liquid_offset", "liquid_angle", "dry_patch", "model"):
        assert answer[name] == []
    assert len(answer["speed"]) == len(answer["stable"]) == len(answer["in_range"]) == 12
    assert not any(told[name] for name in ("layers", "models", "estimates"))
    found = runup_scene(scene).to_json()
    assert all(found[name] == [] for name in OF_LIQUID_IN_TIME)
    assert found["model"] is None and len(found["amplitude"]) == len(found["time"])
    names = set(lb.run(scene).to_dataset()) | set(lb.run_up(scene).to_dataset())
    assert not names & {*OF_LIQUID, *OF_LIQUID_IN_TIME}
    assert {"amplitude", "amplitude_dry", "peak_amplitude"} <= names


def test_a_run_up_is_that_of_the_same_machine_without_its_liquid() -> None:
    """Steps of both are those of one rotor; the one beside a layer goes by the layer's steps."""
    full = lb.example("runup")
    table = full.table() | {
        "runup": {"start": 15.0, "stop": 45.0, "rate": 30.0, "duration": 1.2, "cells": 16}
    }
    table.pop("assumed", None)
    wet = runup_scene(scene_from_table(table), check=False)
    alone = runup_scene(scene_from_table({k: v for k, v in table.items() if k != "chambers"}), check=False)
    most = float(np.nanmax(wet.amplitude_dry))
    np.testing.assert_allclose(alone.amplitude, wet.amplitude_dry, atol=2e-3 * most)
    assert abs(alone.energy.closure) < 1e-9


def test_pages_and_texts_speak_of_one_machine(scene: Scene, tmp_path: Path) -> None:
    def page(write: Any, result: Any, what: About) -> str:
        write(result, what, (), tmp_path / "page.html")
        text = (tmp_path / "page.html").read_text(encoding="utf-8")
        return text[: text.index("<footer")]

    answer, ramp = run_scene(scene), runup_scene(scene, check=False)
    text = page(write_page_of, answer, about(scene, "leblanc run", unused=("model",)))
    write(ramp, tmp_path, scene)
    text += (tmp_path / "runup.html").read_text(encoding="utf-8").partition("<footer")[0]
    for word in ("with liquid", "Wall dry", "Liquid model", "vector model"):
        assert word not in text
    figure = answer.plot()
    labels = {line.get_label() for axes in figure.axes for line in axes.lines}
    assert "without liquid" in labels and not any("with liquid" in label for label in labels)


def test_many_scenes_at_once(scene: Scene) -> None:
    """A sweep answers them together, as each one alone."""
    scenes = [scene.replace({"rotor.mass": mass}) for mass in (20.0, 30.0)]
    together = answer_scenes(scenes)
    for k, each in enumerate(scenes):
        np.testing.assert_allclose(together.amplitude[k], lb.run(each).amplitude, rtol=ROUNDING)


@pytest.mark.parametrize(
    "command",
    [["optimise"], ["map"], ["trade", "--quick"], ["compare", "--models", "statics,linear"]],
    ids=lambda command: command[0],
)
def test_what_needs_a_liquid_refuses_in_one_line(
    command: list[str], scene: Scene, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name, *rest = command
    assert main([name, str(tmp_path / "rotor.toml"), "--out", str(tmp_path), *rest]) == 2
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1 and 'chambers = "none": must be at least one' in told[0]


@pytest.mark.usefixtures("undrawn")
def test_commands(scene: Scene, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(tmp_path / "rotor.toml")
    assert main(["run", path, "--out", str(tmp_path), "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["amplitude"]) == 12
    for name in ("run", "runup"):
        assert main([name, path, "--out", str(tmp_path)]) == 0
        assert "with liquid" not in (told := capsys.readouterr().out) and "iquid model" not in told
    assert main(["explain", path]) == 0
    assert "liquid model" not in capsys.readouterr().out
    assert not (tmp_path / "liquid.svg").exists() and (tmp_path / "amplitude.svg").exists()
