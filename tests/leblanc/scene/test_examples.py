"""The scenes that come with the package say what their sources say."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from leblanc.cli import main
from leblanc.scene import scene as scene_module
from leblanc.scene.examples import example, example_names, example_path, example_title
from leblanc.scene.scene import Scene, jeffcott, load_scene
from leblanc.scene.schema.load import read_toml
from leblanc.studies.sweep.plan import load_sweep
from meshes.errors import InputError

RPM = math.pi / 30.0
ROOT = Path(scene_module.__file__).parents[2]
SCENES = [name for name in example_names() if not name.startswith("studies/")]
EXAMPLES = [example_path(name) for name in SCENES]


@pytest.mark.parametrize(
    "file", [*EXAMPLES, ROOT / "leblanc" / "scene" / "starter.toml"], ids=lambda file: file.name
)
def test_shipped_scenes_load(file: Path) -> None:
    scene = load_scene(file)
    assert scene.assumed  # none of the sources gives everything
    for filling in scene.fills:
        # the undisturbed layer at speed leaves the inner wall dry
        surface = filling.chamber.radius**2 - filling.volume / (math.pi * filling.chamber.height)
        assert surface > filling.chamber.inner_radius**2


def test_the_examples_of_each_kind() -> None:
    names = {file.stem for file in EXAMPLES}
    assert names >= {
        "blood_pump",
        "centrifuge",
        "horizontal_rig",
        "vertical_rig",
        "washing_machine",
        "two_plane_rig",
        "tub",
        "vibratory_table",
        "runup",
        "weak_motor",
        "spindle",
        "balls",
        "balls_and_liquid",
        "long_rotor",
    }


def added_mass(scene: Scene) -> float:
    """Mass of liquid that would fill each whole cylinder, kg."""
    return sum(
        filling.liquid.density * math.pi * filling.chamber.radius**2 * filling.chamber.height
        for filling in scene.fills
    )


def test_the_horizontal_rig_resonates_with_liquid_at_the_measured_speed() -> None:
    """[DR18, fig. 24c]: 90 degrees at 1000 rpm."""
    scene = load_scene(ROOT / "examples" / "horizontal_rig.toml")
    rotor = jeffcott(scene)
    wet = math.sqrt(rotor.stiffness / (rotor.mass + added_mass(scene)))
    assert wet == pytest.approx(1000.0 * RPM, rel=1e-3)  # the scene gives the dry speed with four digits
    measured = np.array([600, 900, 1000, 1100, 1200, 1300])
    assert np.all(np.min(np.abs(scene.speed_array()[:, None] / RPM - measured), axis=0) < 5.0)


def test_the_vertical_rig_resonates_within_the_measured_range() -> None:
    """[DR18, section 7.1]: 12 to 16 rad/s."""
    scene = load_scene(ROOT / "examples" / "vertical_rig.toml")
    rotor = jeffcott(scene)
    for mass in (rotor.mass, rotor.mass + added_mass(scene)):
        assert 12.0 < math.sqrt(rotor.stiffness / mass) < 16.0
    assert {8.0, 12.5, 90.0} <= set(scene.speed_array())
    walls = [filling.chamber.inner_radius for filling in scene.fills[:-1]]
    assert walls == [filling.chamber.radius for filling in scene.fills[1:]]  # one ring in another


def test_the_washing_machine_follows_from_the_table() -> None:
    """[DG21, table 1]."""
    rotor = jeffcott(load_scene(ROOT / "examples" / "washing_machine.toml"))
    spring, damper = math.radians(75.0), math.radians(70.0)
    assert rotor.mass == pytest.approx(48.2 + 12.5)
    assert rotor.stiffness == pytest.approx(2 * 6000.0 * math.sin(spring) ** 2, rel=1e-4)  # five digits
    assert rotor.damping == pytest.approx(2 * 175.0 * math.sin(damper) ** 2, rel=1e-4)
    assert rotor.unbalance == pytest.approx(12.5 * 14.8e-3)


def test_examples_by_name() -> None:
    assert {"studies/fill_grid", "runup", "tub"} <= set(example_names())
    assert all(example_path(name).is_file() and example_title(name) for name in example_names())
    for name in SCENES:
        assert example(name).digest == load_scene(example_path(name)).digest
    with pytest.raises(InputError, match=r"did you mean tub\?"):
        example_path("tubb")


@pytest.mark.parametrize("name", example_names())
def test_new_writes_an_example(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "--example", name]) == 0
    written = tmp_path / f"{Path(name).name}.toml"
    said = capsys.readouterr().err
    if name in SCENES:
        assert written.read_bytes() == example_path(name).read_bytes()
        assert f"leblanc run {written.name}" in said
        return
    # A study looks for its scene beside it, and says how to get it there.
    scene = read_toml(written)["scene"]
    assert f"leblanc new --example {Path(scene).stem}; leblanc sweep {written.name}" in said
    assert main(["new", "--example", Path(scene).stem]) == 0
    assert load_sweep(written).digest == load_sweep(example_path(name)).digest


def test_new_lists_the_examples(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["new", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines if line[0] != " "] == list(example_names())
    assert main(["new", "--example", "tbu"]) == 2
    assert "must be one of: balls" in capsys.readouterr().err


def test_the_wheel_carries_the_examples() -> None:
    """They stand beside the packages and are installed inside one."""
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["build"]
    assert wheel["targets"]["wheel"]["force-include"]["examples"] == "leblanc/examples"
    assert example_path("tub").parent in (ROOT / "examples", ROOT / "leblanc" / "examples")
