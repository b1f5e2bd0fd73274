"""A scene becomes a file again; speeds one by one; what a scene is said to be."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.scene.examples import example_names
from leblanc.scene.scene import scene_from_table
from meshes.errors import InputError

SCENES = [name for name in example_names() if not name.startswith("studies/")]


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_written_is_the_scene(name: str, tmp_path: Path) -> None:
    scene = lb.example(name)
    (tmp_path / "again.toml").write_text(scene.to_toml(), encoding="utf-8")
    again = lb.load_scene(tmp_path / "again.toml")
    assert again == scene
    assert again.digest == scene.digest
    assert again.to_toml() == scene.to_toml()


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_is_said_in_a_line(name: str) -> None:
    scene = lb.example(name)
    said = repr(scene)
    assert "\n" not in said
    assert len(said) < 160
    assert scene.name in said
    assert scene.rotor.kind in said


VALUES = [50.0, 80.0, 200.0]


@pytest.mark.parametrize("given", [VALUES, np.array(VALUES), {"values": VALUES}, ["50 rad/s", 80.0, 200]])
def test_speeds_one_by_one(given: Any) -> None:
    rig = lb.example("horizontal_rig")
    own = rig.replace({"speeds": given})
    assert own.speed_array().tolist() == VALUES
    assert (own.speeds.start, own.speeds.stop, own.speeds.count) == (50.0, 200.0, 3)
    assert own.digest != rig.digest
    assert scene_from_table(tomllib.loads(own.to_toml())) == own
    answer = lb.run(own)
    assert answer.speed.tolist() == VALUES
    alone = [lb.run(rig.replace({"speeds": [speed]})).amplitude[0] for speed in VALUES]
    assert np.allclose(answer.amplitude, alone, rtol=1e-12)


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ([80.0, 50.0], "speeds.values.1"),
        ([80.0, 80.0], "speeds.values.1"),
        ([80.0, "slow"], "speeds.values.1"),
        ([], "speeds"),
        ({"values": VALUES, "start": 60.0, "stop": 200.0, "count": 3}, "speeds.values"),
        ({"values": "fast"}, "speeds.values"),
    ],
)
def test_speeds_that_are_none(given: Any, field: str) -> None:
    with pytest.raises(lb.SceneError) as refused:
        lb.example("horizontal_rig").replace({"speeds": given})
    assert field in [fault.field for fault in refused.value.faults], refused.value


def test_a_scene_is_a_file_a_table_or_a_scene(tmp_path: Path) -> None:
    rig = lb.example("horizontal_rig").replace({"speeds": VALUES})
    (tmp_path / "rig.toml").write_text(rig.to_toml(), encoding="utf-8")
    given = (
        rig,
        rig.table(),
        tomllib.loads(rig.to_toml()),
        tmp_path / "rig.toml",
        str(tmp_path / "rig.toml"),
    )
    first, *others = (lb.run(scene).amplitude for scene in given)  # type: ignore[arg-type]
    for other in others:
        assert np.array_equal(first, other)
    with pytest.raises(InputError, match="a Scene, its table, or the path of its file"):
        lb.run(7)  # type: ignore[arg-type]
    with pytest.raises(lb.SceneError, match="rotor"):
        lb.run({"name": "nothing"})
