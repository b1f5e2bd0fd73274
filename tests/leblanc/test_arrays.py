"""Speeds and axes of charts as arrays, studies as tables: the answers are those of the other ways."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb

RIG = lb.example("horizontal_rig")
EVEN = lb.map_whirl(RIG, volumes=4, speeds=6)


def test_a_map_of_arrays_is_that_of_its_points() -> None:
    volumes = [f"{1e6 * volume!r} ml" for volume in EVEN.volume[1:].tolist()]
    found = lb.map_whirl(RIG, volumes=volumes, speeds=EVEN.speed)
    np.testing.assert_allclose(found.volume, EVEN.volume[1:], rtol=1e-14)
    np.testing.assert_array_equal(found.speed, EVEN.speed)
    # Of volumes that differ by the rounding of a unit.
    np.testing.assert_allclose(found.growth, EVEN.growth[1:], rtol=1e-9, atol=1e-9)


def test_points_need_not_be_even() -> None:
    found = lb.map_whirl(RIG, volumes=EVEN.volume[[0, 3]], speeds=EVEN.speed[[0, 3, 5]])
    np.testing.assert_allclose(found.growth, EVEN.growth[np.ix_([0, 3], [0, 3, 5])], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found.edges[1], EVEN.edges[3], rtol=1e-9)


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"volumes": [1e-6]}, "volumes"),
        ({"volumes": [2e-6, 1e-6]}, "volumes.1"),
        ({"volumes": [1e-6, "2 mm"]}, "volumes.1"),
        ({"volumes": [-1e-6, 1e-6]}, "volumes.0"),
        ({"volumes": [1e-6, 1.0]}, "volumes.1"),
        ({"volumes": [1e-6, np.nan]}, "volumes.1"),
        ({"volumes": [[1e-6, 2e-6]]}, "volumes.0"),
        ({"volumes": 60.0}, "volumes"),
        ({"volumes": True}, "volumes"),
        ({"volumes": [1e-6, 2e-6], "max_volume": "5 ml"}, "max_volume"),
        ({"speeds": [10.0, 10.0]}, "speeds.1"),
        ({"speeds": np.array(10.0)}, "speeds"),
    ],
)
def test_points_of_a_map_are_checked(given: dict[str, object], field: str) -> None:
    with pytest.raises(lb.InputError) as refused:
        lb.map_whirl(RIG, **{"volumes": 3, "speeds": 3, **given})  # type: ignore[arg-type]
    assert refused.value.field == field


def test_a_speed_of_a_map_is_one_of_the_scene() -> None:
    with pytest.raises(lb.SceneError, match=r"speeds\.values\.0 = -1\.0"):
        lb.map_whirl(RIG, volumes=3, speeds=[-1.0, 10.0])


def test_a_chart_of_arrays_is_that_of_its_points() -> None:
    balls = lb.example("balls")
    even = lb.map_balls(balls, "rotor.unbalance", values=4, speeds=5)
    found = lb.map_balls(balls, "rotor.unbalance", values=even.value[1:], speeds=even.speed[[0, 2, 4]])
    np.testing.assert_array_equal(found.value, even.value[1:])
    np.testing.assert_array_equal(found.growing, even.growing[1:, [0, 2, 4]])
    with pytest.raises(lb.InputError, match="stop = '1 g mm': must be left out"):
        lb.map_balls(balls, "rotor.unbalance", values=[1e-6, 2e-6], stop="1 g mm")
    with pytest.raises(lb.InputError, match=r"values\.1 = -1"):
        lb.map_balls(balls, "rotor.unbalance", values=[1e-6, -1.0])


def test_speeds_of_a_run() -> None:
    speeds = np.array([95.0, 110.0, 140.0])
    found = lb.run(RIG, speeds=speeds)
    np.testing.assert_array_equal(found.speed, speeds)
    assert found == lb.run(RIG.replace({"speeds": speeds.tolist()}))
    with pytest.raises(lb.SceneError, match=r"speeds\.values\.1"):
        lb.run(RIG, speeds=[20.0, 10.0])
    with pytest.raises(lb.InputError, match=r"speeds = 20\.0: must be a list"):
        lb.run(RIG, speeds=20.0)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ["scene", "table", "file"])
def test_a_study_is_a_table_as_well(kind: str, tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(RIG.replace({"speeds.count": 3}).to_toml(), encoding="utf-8")
    study = 'scene = "rig.toml"\nmethod = "grid"\n[vary]\n"rotor.mass" = { linspace = [3.0, 4.0, 2] }\n'
    (tmp_path / "study.toml").write_text(study, encoding="utf-8")
    base = {
        "scene": lb.load_scene(tmp_path / "rig.toml"),
        "table": tomllib.loads((tmp_path / "rig.toml").read_text(encoding="utf-8")),
        "file": str(tmp_path / "rig.toml"),
    }[kind]
    expected = lb.sweep(tmp_path / "study.toml", tmp_path / "a", workers=0)
    vary = {"rotor.mass": {"linspace": [3.0, 4.0, 2]}}
    table = {"scene": base, "method": "grid", "vary": vary}
    found = lb.sweep(table, tmp_path / "b", workers=0)
    assert found.outputs.keys() == expected.outputs.keys()
    np.testing.assert_array_equal(found.to_dataset()["amplitude"], expected.to_dataset()["amplitude"])
    with pytest.raises(lb.SceneError, match=r'study: vary\."rotor\.mass"\.linspace'):
        lb.sweep(table | {"vary": {"rotor.mass": {"linspace": [-1.0, 4.0, 2]}}}, tmp_path / "c", workers=0)
    with pytest.raises(lb.SceneError, match="scene: rotor: must be given"):
        lb.sweep(table | {"scene": {"name": "x"}}, tmp_path / "d", workers=0)
