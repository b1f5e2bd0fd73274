"""The same machine in other words: three values of a ramp, plates by their height, a tub that hangs."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest

from leblanc.liquid.validity import require_supported
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from meshes.errors import InputError
from tests.mutants import kills

RAMP = {"start": 5.0, "stop": 100.0, "rate": 8.0, "ramp_time": 11.875}


def runup(**given: Any) -> Scene:
    table = example("runup").table()
    rest = {key: value for key, value in table["runup"].items() if key not in (*RAMP, "duration")}
    return scene_from_table(table | {"runup": rest | given, "assumed": []})


@kills("leblanc.scene.tasks:_ramp", "stop - rate * time", "rate * time")
@kills("leblanc.scene.tasks:_ramp", "start + rate * time", "rate * time")
@kills("leblanc.scene.tasks:_ramp", "(stop - start) / time", "stop / time")
def test_three_values_of_a_ramp_say_the_fourth() -> None:
    known = runup(**{key: RAMP[key] for key in ("start", "stop", "rate")}, duration=14.0)
    for names in combinations(RAMP, 3):
        scene = runup(**{key: RAMP[key] for key in names}, duration=14.0)
        plan = scene.runup
        assert plan is not None and (plan.start, plan.stop, plan.rate) == (5.0, 100.0, 8.0)
        assert scene.digest == known.digest
        assert set(scene.table()["runup"]) & set(RAMP) == set(names)  # a file says what was given
        again = scene_from_table(scene.table())
        assert again == scene and again.digest == scene.digest


@kills("leblanc.scene.tasks:Runup.implied", "(self.stop - self.start) / self.rate", "self.stop / self.rate")
def test_without_a_duration_nothing_is_held() -> None:
    for names in combinations(RAMP, 3):
        plan = runup(**{key: RAMP[key] for key in names}).runup
        assert plan is not None and plan.duration == pytest.approx(11.875, rel=1e-15)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"start": 5.0, "stop": 100.0}, r"runup\.rate: must be given: .*three of start, stop, rate"),
        ({"stop": 100.0, "duration": 3.0}, r"runup\.start: .*duration is that of ramp and hold"),
        (RAMP, r"runup\.ramp_time = 11\.875: must be left out"),
        ({"stop": 100.0, "rate": 80.0, "ramp_time": 3.0}, r"runup\.ramp_time = 3\.0: must be such that"),
        ({"start": 100.0, "stop": 5.0, "ramp_time": 3.0}, r"runup\.stop = 5\.0: must be above"),
        ({"start": 5.0, "stop": 1e5, "ramp_time": 1e-9}, r"runup\.ramp_time = 1e-09: .*the rate is"),
        ({"start": 5.0, "stop": 9.0, "ramp_time": "3 m"}, r"runup\.ramp_time = \"3 m\": must be a time"),
        ({"start": 5.0, "stop": 9.0, "motor": {"inertia": 1.0, "speeds": [0.0, 9.0], "torques": [1.0, 1.0]}},
         r"runup\.duration: must be given: a time"),
        ({"start": 5.0, "stop": 9.0, "duration": 3.0, "ramp_time": 2.0,
          "motor": {"inertia": 1.0, "speeds": [0.0, 9.0], "torques": [1.0, 1.0]}},
         r"runup\.ramp_time = 2\.0: must be left out where runup\.motor"),
    ],
)  # fmt: skip
def test_other_ramps_are_refused(given: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said) as caught:
        runup(**given)
    assert len(caught.value.faults) == 1


def plates(**given: Any) -> Scene:
    table = example("front_loader").table()
    return scene_from_table(table).replace({"chambers.0.baffles": {"count": 4} | given})


@kills("leblanc.scene.chambers:Baffles.tip", "radius - self.wall_gap - self.height", "radius - self.height")
def test_plates_by_their_height() -> None:
    radius = plates(tip_radius=0.2).liquids[0].radius
    assert radius is not None
    by_tip, by_height = (
        plates(tip_radius=radius - 0.015, wall_gap=0.003),
        plates(height=0.012, wall_gap=0.003),
    )
    first, second = (scene.fills[0].chamber.baffles for scene in (by_tip, by_height))
    assert first is not None and second is not None
    assert second.tip_radius == pytest.approx(first.tip_radius, rel=1e-15)
    assert by_height.liquids[0].baffles is not None
    assert by_height.liquids[0].baffles.tip_radius == second.tip_radius
    assert by_height.table()["chambers"][0]["baffles"] == {"count": 4, "height": 0.012, "wall_gap": 0.003}
    assert plates(height=radius).fills[0].chamber.baffles.tip_radius == 0.0  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"tip_radius": 0.2, "height": 0.01}, r"height = 0\.01: must be left out where tip_radius is given"),
        ({"height": 0.0}, r"a height above 0"),
        ({"height": 3.0}, r"a height up to radius - wall_gap"),
    ],
)
def test_other_plates_are_refused(given: dict[str, Any], said: str) -> None:
    with pytest.raises(SceneError, match=said):
        plates(**given)


@kills("leblanc.liquid.validity:_cure", "/ hanging", "* hanging")
@kills("leblanc.liquid.validity:_carries", "spring.stiffness[2] > 0.0", "True")
def test_a_tub_that_hangs_is_told_what_holds_it() -> None:
    """Its weight on two springs of 300 mm, whatever others hold it sideways."""
    table = example("front_loader").table()
    table["rotor"]["springs"] = [
        {"position": [x, 0.0, 0.22], "direction": [0.0, 0.0, 1.0], "stiffness": 8e3} for x in (0.2, -0.2)
    ]
    sideways = {"position": [0.2, 0.0, 0.0], "stiffness": [500.0, 0.0, 0.0]}
    table["rotor"]["springs"].append(sideways)
    table["assumed"] = []
    scene = scene_from_table(table)
    force = (scene.rotor.tub_mass + scene.rotor.drum_mass) * 9.81 / 2.0  # type: ignore[union-attr]
    with pytest.raises(
        InputError, match=rf"{force:.4g} N of its weight on 300 mm hold with {force / 0.3:.4g} N/m"
    ):
        require_supported(scene)
