"""The scenes that come with the package say what their sources say."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from leblanc.scene import scene as scene_module
from leblanc.scene.scene import Scene, load_scene

RPM = math.pi / 30.0
ROOT = Path(scene_module.__file__).parents[1]
EXAMPLES = sorted((ROOT / "examples").glob("*.toml"))


@pytest.mark.parametrize(
    "file", [*EXAMPLES, ROOT / "leblanc" / "scene" / "starter.toml"], ids=lambda file: file.name
)
def test_shipped_scenes_load(file: Path) -> None:
    scene = load_scene(file)
    assert scene.assumed  # none of the sources gives everything
    for filling in scene.chambers:
        # the undisturbed layer at speed leaves the inner wall dry
        surface = filling.chamber.radius**2 - filling.volume / (math.pi * filling.chamber.height)
        assert surface > filling.chamber.inner_radius**2


def test_the_examples_of_each_kind() -> None:
    names = {file.stem for file in EXAMPLES}
    assert names >= {
        "centrifuge",
        "horizontal_rig",
        "vertical_rig",
        "washing_machine",
        "two_plane_rig",
        "tub",
        "vibratory_table",
        "runup",
        "weak_motor",
    }


def added_mass(scene: Scene) -> float:
    """Mass of liquid that would fill each whole cylinder, kg."""
    return sum(
        filling.liquid.density * math.pi * filling.chamber.radius**2 * filling.chamber.height
        for filling in scene.chambers
    )


def test_the_horizontal_rig_resonates_with_liquid_at_the_measured_speed() -> None:
    """[DR18, fig. 24c]: 90 degrees at 1000 rpm."""
    scene = load_scene(ROOT / "examples" / "horizontal_rig.toml")
    wet = math.sqrt(scene.rotor.stiffness / (scene.rotor.mass + added_mass(scene)))
    assert wet == pytest.approx(1000.0 * RPM, rel=1e-3)  # the scene gives the dry speed with four digits
    measured = np.array([600, 900, 1000, 1100, 1200, 1300])
    assert np.all(np.min(np.abs(scene.speed_array()[:, None] / RPM - measured), axis=0) < 5.0)


def test_the_vertical_rig_resonates_within_the_measured_range() -> None:
    """[DR18, section 7.1]: 12 to 16 rad/s."""
    scene = load_scene(ROOT / "examples" / "vertical_rig.toml")
    for mass in (scene.rotor.mass, scene.rotor.mass + added_mass(scene)):
        assert 12.0 < math.sqrt(scene.rotor.stiffness / mass) < 16.0
    assert {8.0, 12.5, 90.0} <= set(scene.speed_array())
    walls = [filling.chamber.inner_radius for filling in scene.chambers[:-1]]
    assert walls == [filling.chamber.radius for filling in scene.chambers[1:]]  # one ring in another


def test_the_washing_machine_follows_from_the_table() -> None:
    """[DG21, table 1]."""
    rotor = load_scene(ROOT / "examples" / "washing_machine.toml").rotor
    spring, damper = math.radians(75.0), math.radians(70.0)
    assert rotor.mass == pytest.approx(48.2 + 12.5)
    assert rotor.stiffness == pytest.approx(2 * 6000.0 * math.sin(spring) ** 2, rel=1e-4)  # five digits
    assert rotor.damping == pytest.approx(2 * 175.0 * math.sin(damper) ** 2, rel=1e-4)
    assert rotor.unbalance == pytest.approx(12.5 * 14.8e-3)
