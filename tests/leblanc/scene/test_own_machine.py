"""A package of one's own: its machine is read, refused and answered like ours, its command asked."""

from __future__ import annotations

import json
import shutil
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
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
    assert lb.map_whirl(str(installed)).growth.shape == (101, 201)


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
