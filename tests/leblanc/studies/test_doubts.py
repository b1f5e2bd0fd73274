"""What is hardly meant in a scene is doubted with its likely slip; what is built is not."""

from __future__ import annotations

import json
import math
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.liquid.validity import doubts
from leblanc.scene.examples import example_names, example_path
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.studies.explain.answer import machine_rows
from meshes.errors import InputError

SCENES = [name for name in example_names() if "rotor" in tomllib.loads(example_path(name).read_text())]


def machine(**changes: Any) -> dict[str, Any]:
    """A planar rotor by its table; changes by their paths with "__" between the keys."""
    table: dict[str, Any] = {
        "name": "Rig",
        "rotor": {
            "kind": "jeffcott",
            "mass": "4 kg",
            "critical_speed": "1000 rpm",
            "damping_ratio": 0.1,
            "unbalance": "0.6 kg*mm",
            "axis": "vertical",
        },
        "chambers": [{"radius": "65 mm", "height": "20 mm", "volume": "10 ml", "liquid": "water"}],
        "speeds": {"start": "100 rpm", "stop": "2000 rpm", "count": 5},
    }
    for path, value in changes.items():
        node: Any = table
        *above, last = path.split("__")
        for key in above:
            node = node[int(key)] if key.isdecimal() else node[key]
        node[last] = value
    return table


def found(table: dict[str, Any]) -> dict[str, str]:
    return {
        str(note.data["field"]): str(note.data["likely"]) for note in doubts(scene_from_table(table), table)
    }


@pytest.mark.parametrize("name", SCENES)
def test_the_examples_are_plausible(name: str) -> None:
    path = example_path(name)
    assert doubts(lb.load_scene(path), tomllib.loads(path.read_text(encoding="utf-8"))) == ()


@pytest.mark.parametrize(
    "table",
    [
        machine(),
        # the spindle of a hard disc: well below its critical speeds, a ring of a few hundred microlitres
        machine(
            rotor__mass="80 g", rotor__critical_speed="40000 rpm", rotor__unbalance="0.5 g*mm",
            chambers__0__radius="9 mm", chambers__0__height="1 mm", chambers__0__volume="0.02 ml",
            speeds__start="5400 rpm", speeds__stop="15000 rpm", rotor__damping_ratio=0.02,
        ),
        # a gas turbine
        machine(
            rotor__mass="60 t", rotor__critical_speed="1200 rpm", rotor__unbalance="3 kg*m",
            chambers__0__radius="1.2 m", chambers__0__height="0.3 m", chambers__0__volume="90 l",
            speeds__stop="3600 rpm",
        ),
        # a separator far above its critical speed
        machine(
            rotor__mass="300 kg", rotor__critical_speed="500 rpm", rotor__unbalance="0.1 kg*m",
            chambers__0__radius="0.4 m", chambers__0__volume="1 l", speeds__stop="8000 rpm",
        ),
        # all in SI without units
        machine(
            rotor__mass=4, rotor__critical_speed=104.7, rotor__unbalance=6e-4, speeds__start=10,
            speeds__stop=210, chambers__0__radius=0.065, chambers__0__height=0.02, chambers__0__volume=1e-5,
        ),
        # all in SI without units, far below the critical speed
        machine(rotor__critical_speed=5000, speeds__start=10, speeds__stop=210),
        # mercury and a thick oil
        machine(chambers__0__liquid={"density": 13546, "viscosity": "60000 mm^2/s"}),
    ],
)  # fmt: skip
def test_what_is_built_is_not_doubted(table: dict[str, Any]) -> None:
    assert found(table) == {}


@pytest.mark.parametrize(
    ("changes", "field", "likely"),
    [
        ({"chambers__0__radius": "250 m"}, "chambers.0.radius", "250 mm"),
        ({"chambers__0__height": 20}, "chambers.0.height", "20 mm"),
        ({"chambers__0__height": "0.02 mm", "chambers__0__volume": "0.1 ml"}, "chambers.0.height", "20 mm"),
        ({"rotor__damping_ratio": 6}, "rotor.damping_ratio", "0.06"),
        ({"rotor__unbalance": 0.6}, "rotor.unbalance", "600 g mm"),
        ({"rotor__unbalance": "20 kg*m"}, "rotor.unbalance", "20 kg mm"),
        ({"chambers__0__volume": "5 mm^3"}, "chambers.0.volume", ""),
        ({"chambers__0__liquid": {"density": 0.998, "viscosity": 1e-6}},
            "chambers.0.liquid.density", "998 kg/m^3"),
        ({"chambers__0__liquid": {"density": 998, "viscosity": 1.0}},
            "chambers.0.liquid.viscosity", "1 mm^2/s"),
        ({"rotor__mass": "9 g", "rotor__unbalance": "1 g*mm"}, "rotor.mass", ""),
        ({"gravity": 9810}, "gravity", "9.81 m/s^2"),
        ({"rotor__critical_speed": 1000}, "rotor.critical_speed", "1000 rpm"),
        ({"speeds__stop": 2000, "speeds__start": 900}, "speeds.stop", "2000 rpm"),
    ],
)  # fmt: skip
def test_a_slip_is_doubted_with_what_was_likely_meant(
    changes: dict[str, Any], field: str, likely: str
) -> None:
    assert found(machine(**changes)) == {field: likely}


def test_speeds_in_si_are_doubted_beside_others_in_rpm_alone() -> None:
    """The same numbers with their units spelled out are what the user says."""
    far = machine(rotor__critical_speed="5000 rad/s")
    assert found(far) == {}


def tub(springs: list[dict[str, Any]]) -> Scene:
    table = lb.example("tub").table()
    table.pop("assumed")
    table["rotor"]["springs"] = springs
    return scene_from_table(table)


def test_directions_in_which_nothing_holds_a_tub() -> None:
    """Upright springs in one plane leave what they do not resist; springs all round leave nothing."""
    upright = [{"position": [x, 0, 0.2], "stiffness": [0, 0, 5000]} for x in (0.2, -0.2)]
    (note,) = doubts(tub(upright))
    assert note.data["field"] == "rotor.springs"
    # x and y shift and turns about x and z; the two springs resist z and, 0.4 m apart, a turn about y.
    assert note.text.endswith("nothing holds the machine along x and along y and about x and about z.")
    whole = [{"position": [x, y, 0.2], "stiffness": [5e3] * 3} for x in (0.2, -0.2) for y in (0.1, -0.1)]
    assert doubts(tub(whole)) == ()


def test_a_machine_that_moves_freely_has_no_headline() -> None:
    """Two upright springs hold no steady motion of some size: refused with the free motions and the cure.

    `explain` answers without critical speeds; springs all round have them.
    """
    upright = tub([{"position": [x, 0, 0.2], "stiffness": [0, 0, 5000]} for x in (0.2, -0.2)])
    few = upright.replace({"speeds.count": 5})
    for ask in (lb.run, lb.run_up, lb.optimise):
        with pytest.raises(InputError, match="stiffness along x, y and z") as refused:
            ask(few)
        assert refused.value.field == "rotor.springs"
        assert "along x and along y and about x and about z" in str(refused.value)
    told = lb.explain(few)
    assert math.isnan(told.critical_speed_dry) and math.isnan(told.critical_speed_wet)
    rows = dict(machine_rows(told))
    assert rows["free to move"].startswith("4 motions") and "critical speed" in rows
    rest = [{"position": [x, y, 0.2], "stiffness": [5e3] * 3} for x in (0.2, -0.2) for y in (0.1, -0.1)]
    held = tub(rest).replace({"speeds.count": 5})
    assert "free to move" not in dict(machine_rows(lb.explain(held)))


def test_a_rotor_in_one_support_may_tilt_freely() -> None:
    scene = lb.example("two_plane_rig")
    table = scene.table()
    table.pop("assumed", None)
    table["rotor"]["supports"] = [{"position": 0.0, "stiffness": 1e6, "damping": 10.0}]
    (note,) = doubts(scene_from_table(table))
    assert note.data["field"] == "rotor.supports" and "about" in note.text


def test_an_unbalance_far_from_the_rotor() -> None:
    (note,) = doubts(lb.example("two_plane_rig").replace({"rotor.unbalances.0.position": "5 m"}))
    assert note.data["field"] == "rotor.unbalances.0.position" and note.data["likely"] == "5 mm"


def test_a_machine_that_moves_freely_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The refusal says what a warning of the file would say."""
    text = example_path("tub").read_text(encoding="utf-8")
    text = re.sub(r"(?s)^assumed = \[.*?^\]\n", "", text, flags=re.MULTILINE)
    begin, end = text.index("[[rotor.springs]]"), text.index("[[rotor.dampers]]")
    spring = "[[rotor.springs]]\nposition = [{}, 0, 0.2]\nstiffness = [0, 0, 5000]\n"
    path = tmp_path / "scene.toml"
    path.write_text(text[:begin] + spring.format(0.2) + spring.format(-0.2) + text[end:], encoding="utf-8")
    assert main(["run", str(path), "--out", str(tmp_path)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.count("nothing holds the machine along x and along y and about x and about z") == 1


@pytest.mark.usefixtures("undrawn")
def test_a_doubt_is_a_line_on_stderr_and_a_note_of_the_result(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = example_path("horizontal_rig").read_text(encoding="utf-8")
    right, wrong = 'radius = "65 mm"', 'radius = "65 m"'
    assert right in text
    path = tmp_path / "scene.toml"
    few = re.sub(r"(?m)^count = \d+", "count = 5", text)
    path.write_text(few.replace(right, wrong, 1), encoding="utf-8")
    assert main(["run", str(path), "--out", str(tmp_path), "--json"]) == 0
    printed = capsys.readouterr()
    line = next(k for k, content in enumerate(path.read_text().splitlines(), 1) if wrong in content)
    said = "Check chambers.0.radius: a radius of 65 m is hardly built; did you mean 65 mm?"
    assert f"{path}:{line}: warning: {said}" in printed.err.splitlines()
    assert said in json.loads(printed.out)["notes"]
