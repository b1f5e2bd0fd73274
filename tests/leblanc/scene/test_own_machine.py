"""A package of one's own: its machine is read, refused and answered like ours, its command asked."""

from __future__ import annotations

import json
import re
import shutil
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from inspect import cleandoc, signature
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc import registry
from leblanc.cli import main
from leblanc.scene.scene import scene_from_table
from tests.mutants import kills

EXAMPLE = Path(__file__).resolve().parents[3] / "docs" / "examples" / "own_package"


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The package of the page, installed into a folder of its own."""
    site = tmp_path / "site"
    shutil.copytree(EXAMPLE / "slender", site / "slender")
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    about = site / f"slender-{project['version']}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: slender\nVersion: {project['version']}\n", encoding="utf-8"
    )
    groups = [
        "\n".join([f"[{group}]", *(f"{name} = {at}" for name, at in found.items())])
        for group, found in project["entry-points"].items()
    ]
    (about / "entry_points.txt").write_text("\n".join(groups) + "\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(site))
    yield EXAMPLE / "machine.toml"
    for name in [name for name in sys.modules if name.partition(".")[0] == "slender"]:
        del sys.modules[name]


def alike(**rotor: Any) -> dict[str, Any]:
    """The horizontal rig, with its rotor as the machine of the package."""
    table = lb.example("horizontal_rig").table()
    own = lb.example("horizontal_rig").rotor.machine()
    values = {"mass": own.mass, "sideways": own.stiffness, "upwards": own.stiffness, "damping": own.damping}
    table["rotor"] = {"kind": "uneven", "unbalance": own.unbalance, "axis": "horizontal"} | values | rotor
    table["speeds"]["count"] = 21
    table.pop("assumed", None)
    return table


def test_with_like_supports_it_is_the_planar_rotor(installed: Path) -> None:
    # The one goes by harmonic balance on two coordinates, the other by its closed planar form.
    own, ours = lb.run(alike()), lb.run(lb.example("horizontal_rig").replace({"speeds.count": 21}))
    for name in ("amplitude", "amplitude_dry", "liquid_offset"):
        assert getattr(own, name) == pytest.approx(getattr(ours, name), rel=1e-6), name
    assert own.peak["speed"] == pytest.approx(ours.peak["speed"], rel=1e-4)
    assert (own.stable == ours.stable).all()


def test_a_stiffer_direction_has_a_higher_critical_speed(installed: Path) -> None:
    # Without liquid and with a hundredth of the damping, sqrt(K/M) of each direction: at these two speeds the
    # curve peaks, and between them it falls.
    scene = lb.load_scene(installed).replace({"rotor.damping": 0.84, "chambers.0.volume": 0.0})
    sideways, upwards = (float(np.sqrt(stiffness / 4.0)) for stiffness in (44e3, 70e3))
    between = 0.5 * (sideways + upwards)
    values = (sideways, 1.02 * sideways, between, 0.98 * upwards, upwards)
    dry = lb.run(scene.replace({"speeds": {"values": values}})).amplitude_dry
    assert dry[0] > 5.0 * dry[1] > 5.0 * dry[2] and dry[4] > 5.0 * dry[3] > 5.0 * dry[2]
    found = lb.explain(str(installed))
    # Of two resonances of one damping the upper one is larger: Omega^2 U/(C Omega).
    assert found.critical_speed_dry == pytest.approx(upwards, rel=1e-3)
    ring = lb.load_scene(installed).fills[0]
    assert found.layers[0].liquid_mass_ratio == pytest.approx(ring.mass / 4.0, rel=1e-12)
    assert lb.map_whirl(str(installed), volumes=3, speeds=11).growth.shape == (3, 11)


@kills("leblanc.scene.schema.part:placed", '(*place, *line.get("loc", ()))', 'line.get("loc", ())')
def test_what_is_wrong_with_it_is_named_as_of_any_other(installed: Path) -> None:
    for wrong, said in (
        ({"mass": "-1 kg"}, 'rotor.mass = "-1 kg": must be a mass'),
        ({"mas": 1.0}, "rotor.mas = 1.0: must be left out or spelled as one of: kind, axis, mass, sideways"),
        ({"kind": "unevn"}, "did you mean uneven?"),
    ):
        with pytest.raises(lb.SceneError) as refused:
            scene_from_table(alike(**wrong))
        assert said in str(refused.value)
    scene = scene_from_table(alike())
    assert scene.replace({"rotor.mass": "5 kg"}).digest != scene.digest
    assert scene_from_table(tomllib.loads(scene.to_toml())) == scene
    for refused_by in (lb.optimise, lambda s: lb.run(s | {"rotor": s["rotor"] | {"kind": "exciter"}})):
        with pytest.raises((lb.InputError, lb.SceneError)):
            refused_by(alike())


def test_without_the_package_its_machine_is_unknown() -> None:
    with pytest.raises(lb.SceneError, match=r"rotor\.kind"):
        scene_from_table(alike())


def test_its_command_is_one_of_ours(
    installed: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["gforce", str(installed), "--out", str(tmp_path / "out")]) == 0
    top = 0.065 * (2000.0 * np.pi / 30.0) ** 2 / 9.81
    assert f"Up to {top:.3g} g at the wall." in capsys.readouterr().out
    assert main(["gforce", str(installed), "--out", str(tmp_path / "out"), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert np.shape(printed["acceleration"]) == (1, 91)
    assert main(["gforce", str(installed), "--depth", "70 mm", "--out", str(tmp_path / "out")]) == 2
    assert "--depth" in capsys.readouterr().err


BROKEN = """
import numpy as np
from dataclasses import replace
from importlib import import_module
from inspect import cleandoc, signature
from typing import ClassVar, Literal
from slender.machine import Uneven

def raises(machine): return 1 / 0
def nothing(machine): return None
def other(name, value): return lambda machine: replace(machine, **{name: value})
def made(kind, change):
    def machine(self): return change(Uneven.machine(self))
    return type(kind, (Uneven,), {
        "__module__": __name__, "__annotations__": {"kind": Literal[kind]}, "kind": kind, "machine": machine,
    })

one = np.eye(2)
raising, none = made("raising", raises), made("none", nothing)
twisted = made("twisted", other("stiffness", 44e3 * (1.0 + 0.2j) * one))
lossy = made("lossy", other("damping", 1j * one))
heavy = made("heavy", other("mass", one + 0j))
unknown = made("unknown", other("stiffness", np.nan * one))
large = made("large", other("stiffness", np.eye(3)))
bare = made("bare", other("stiffness", 44e3))
listed = made("listed", other("stiffness", [[44e3, 0.0], [0.0, 44e3]]))
number = 3
unlike = Uneven

class Astray(Uneven):
    kind: Literal["astray"] = "astray"
    ANSWERS: ClassVar = {"run": "slender.nowhere:answer"}

class Counted(Uneven):
    kind: Literal["counted"] = "counted"
    ANSWERS: ClassVar = {"run": "builtins:id"}
"""
FAULTS = {
    "raising": "machine() of slender.broken:raising fails: ZeroDivisionError: division by zero",
    "none": "machine() of slender.broken:none fails: AttributeError: 'NoneType'",
    "twisted": "stiffness = 'complex128 of shape (2, 2)': must be an array of finite real numbers",
    "lossy": "damping = 'complex128 of shape (2, 2)': must be an array of finite real numbers",
    "heavy": "mass = 'complex128 of shape (2, 2)': must be an array of finite real numbers",
    "unknown": "stiffness = nan: must be an array of finite real numbers, shape (2, 2)",
    "large": "stiffness = 'float64 of shape (3, 3)'",
    "bare": "stiffness = 'float'",
    "listed": "stiffness = 'list'",
    "number": 'slender.broken:number is no subclass of Machine with kind = "number"',
    "unlike": 'slender.broken:unlike is no subclass of Machine with kind = "unlike"',
    "gone": "loading slender.nowhere:it fails: ModuleNotFoundError",
    "astray": "the answer to run, 'slender.nowhere:answer', fails: ModuleNotFoundError",
    "counted": "the answer to run, 'builtins:id', fails: TypeError: it is int",
}


@pytest.fixture
def broken(installed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Another package, of machines with a fault each, two of them with names that are taken."""
    (tmp_path / "site" / "slender" / "broken.py").write_text(BROKEN, encoding="utf-8")
    kinds = {kind: f"slender.broken:{kind}" for kind in FAULTS} | {
        "gone": "slender.nowhere:it",
        "astray": "slender.broken:Astray",
        "counted": "slender.broken:Counted",
        "jeffcott": "slender.broken:number",
        "uneven": "slender.broken:number",
    }
    about = tmp_path / "later" / "thick-1.0.dist-info"
    about.mkdir(parents=True)
    monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path / "later")])
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: thick\nVersion: 1.0\n", encoding="utf-8")
    lines = ["[leblanc.machines]", *(f"{kind} = {at}" for kind, at in kinds.items())]
    (about / "entry_points.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return installed


@kills("leblanc.registry:sound", "(Exception, SystemExit)", "SystemExit")
def test_a_fault_of_a_machine_is_one_sentence(broken: Path) -> None:
    for kind, said in FAULTS.items():
        with pytest.raises((lb.InputError, lb.SceneError)) as refused:
            lb.run(alike(kind=kind))
        assert f"{kind}" in str(refused.value) and said in str(refused.value), refused.value
        assert "rotor.kind = " in str(refused.value) and "\n" not in str(refused.value)


def test_a_package_that_does_not_load_is_no_choice(broken: Path) -> None:
    with pytest.raises(
        lb.SceneError, match=r"one of: jeffcott.*, uneven.*; did you mean jeffcott\?"
    ) as refused:
        scene_from_table(alike(kind="jefcott"))
    assert "gone" not in str(refused.value) and "number" not in str(refused.value)


def test_a_name_that_is_taken_is_told_once(broken: Path, capsys: pytest.CaptureFixture[str]) -> None:
    registry._SAID.clear()
    for _ in range(2):
        assert scene_from_table(alike()).rotor.kind == "uneven"
    assert sorted(capsys.readouterr().err.splitlines()) == [
        "leblanc: slender.broken:number is not used: leblanc.machines has jeffcott of leblanc itself",
        "leblanc: slender.broken:number is not used: leblanc.machines has uneven of slender.machine:Uneven",
    ]


@kills(
    "solvers.rotor.system:RotorSystem.__post_init__", '("fiu", "real numbers")', '("fiuc", "real numbers")'
)
def test_equations_of_motion_have_real_matrices() -> None:
    whole = lb.example("two_plane_rig").rotor.machine().system()
    for name in ("mass", "damping", "gyroscopic", "stiffness", "centre", "lean"):
        value = getattr(whole, name)
        assert replace(whole, **{name: value}).coordinates == whole.coordinates
        said = ""
        try:
            replace(whole, **{name: value * (1.0 + 0.2j)})
        except lb.InputError as error:
            said = str(error)
        assert said.startswith(f"{name} = 'complex128 of shape"), name
        assert "finite real numbers" in said


def test_what_takes_no_such_machine_says_so(
    installed: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for scene in (lb.load_scene(installed), lb.example("spindle")):
        with pytest.raises(lb.InputError, match="this command takes no machine of this one"):
            lb.optimise(scene, "peak")
    assert main(["view", str(installed), "--out", str(tmp_path / "out")]) == 2
    assert "this command takes no machine of this one" in capsys.readouterr().err


@kills("leblanc.scene.scene:require_whirl", "*WITHOUT_CHAMBERS, ", "*WITHOUT_CHAMBERS[1:], ")
@kills("leblanc.studies.layer.study:_of_machine", "require_whirl(scene)", "pass")
@kills("leblanc.studies.sweep.plan:_require_answered", "require_whirl(scene)", "pass")
@pytest.mark.parametrize("name", ["vibratory_table", "spindle", "blood_pump"])
def test_a_machine_that_does_not_whirl_is_refused_alike(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With the line of its kind in its own file, by every command that is not for it."""
    file, study, data = (tmp_path / each for each in ("it.toml", "study.toml", "data.csv"))
    file.write_text(lb.example(name).to_toml(), encoding="utf-8")
    study.write_text(
        'scene = "it.toml"\nmethod = "grid"\n[vary]\n"speeds.stop" = { choice = ["10 Hz", "20 Hz"] }\n',
        encoding="utf-8",
    )
    data.write_text("speed,amplitude\nrpm,mm\n100,1\n200,1\n300,2\n", encoding="utf-8")
    others = (["compare", "it", "--models", "linear"], ["fit", "it", str(data), "--unknown", "rotor.mass"])
    for command in (*([each, "it"] for each in ("map", "runup", "layer", "optimise")), *others, ["sweep"]):
        files = [str(file) if part == "it" else part for part in command]
        assert main([*files, *([str(study)] if command == ["sweep"] else [])]) == 2
        said = capsys.readouterr().err
        assert re.match(re.escape(str(file)) + r":\d+: rotor.kind = ", said), command
        assert "must be of another kind: this command takes no machine of this one" in said, command


def test_a_misspelt_liquid_is_told_with_all_that_are_installed(installed: Path, tmp_path: Path) -> None:
    about = next((tmp_path / "site").glob("*.dist-info")) / "entry_points.txt"
    about.write_text(
        about.read_text(encoding="utf-8") + "[leblanc.liquids]\ncentring = slender.it:It\n", encoding="utf-8"
    )
    with pytest.raises(lb.SceneError, match=r"fem, centring; did you mean centring\?"):
        lb.load_scene(installed).replace({"model.liquid": "centrng"})


def test_its_command_fails_in_one_sentence(
    installed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    dry = Path("dry.toml")
    table = {key: value for key, value in lb.load_scene(installed).table().items() if key != "chambers"}
    dry.write_text(scene_from_table(table).to_toml(), encoding="utf-8")
    assert main(["gforce", str(dry), "--out", "out"]) == 2
    assert "chambers" in capsys.readouterr().err
    gforce = import_module("slender.gforce")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gforce.GforceAnswer, "blocks", lambda self: 1 / 0)
        assert main(["gforce", str(installed), "--out", "out"]) == 2
    *_, said = capsys.readouterr().err.splitlines()
    assert said.startswith("leblanc: command = 'gforce': must be of a package that works; its answer fails: ")
    assert "ZeroDivisionError: division by zero (test_own_machine.py, line " in said
    assert main(["gforce", "none.toml"]) == 2 and main(["gforce", "--nothing"]) == 2
    assert "a package that works" not in capsys.readouterr().err


def test_its_command_has_help_and_outputs(installed: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gforce = import_module("slender.gforce").gforce
    assert "depth : distance from the wall, inwards" in gforce.__doc__
    assert "Annotated" not in str(signature(gforce))
    assert main(["outputs", "gforce"]) == 0
    assert "acceleration at the wall" in capsys.readouterr().out
    assert repr(lb.outputs("gforce")) == "<OutputsAnswer: 3 quantities of gforce>"
    with pytest.raises(lb.InputError, match=r"one of: .*run.*, gforce"):
        lb.outputs("gforse")


def test_help_of_a_call_says_its_parameters() -> None:
    for call in (lb.run, lb.run_up, lb.map_whirl):
        assert "Parameters\n----------\nscene : " in cleandoc(call.__doc__ or "")
        assert "Annotated" not in str(signature(call))
    assert "[default: 1]" in (lb.run.__doc__ or "")
