"""Races with balls among the chambers of a scene."""

from __future__ import annotations

import math
from typing import Any

import pytest

import leblanc as lb
from leblanc.scene.chambers import Chamber
from leblanc.scene.inputs import inputs_of
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError

RACE: dict[str, Any] = {"kind": "balls", "radius": "100 mm", "count": 2, "mass": "20 g", "drag": 0.5}


def scene_with(*races: dict[str, Any], **more: Any) -> Scene:
    table = lb.example("runup").table() | more
    return scene_from_table(table | {"chambers": [*table["chambers"], *races]})


def test_liquid_and_balls_stand_in_one_list() -> None:
    scene = scene_with(RACE)
    assert [type(part) for part in scene.chambers] == [Chamber, BallRace]
    assert len(scene.fills) == 1
    assert scene.balls[0].capacity == pytest.approx(2 * 0.02 * 0.1)
    assert scene.replace({"chambers.1.mass": "30 g"}).balls[0].each == 0.03
    assert scene_from_table(scene.table()) == scene
    assert "kind" not in scene.table()["chambers"][0]
    assert scene.without_balls().digest == lb.example("runup").digest
    heavier = scene.replace({"chambers.1.mass": "30 g"})
    assert len({scene.digest, heavier.digest, scene.without_balls().digest}) == 3


def test_a_solid_ball_by_its_density() -> None:
    """2/5 m r^2 about its own centre; in liquid as a sphere that takes half of what it displaces along."""
    size, density = 0.012, 7850.0
    volume = math.pi / 6.0 * size**3
    plain = {**RACE, "diameter": size, "density": density}
    del plain["mass"]
    race = BallRace(**plain).race()
    mass, wide = density * volume, 1.0 + 0.006 / 0.1
    assert race.masses == pytest.approx((mass, mass))
    assert (race.rolling, race.carried, race.driven) == pytest.approx((1.4, 0.4 * wide, 0.4 * wide**2))
    slides = BallRace(**plain, motion="sliding").race()
    assert (slides.rolling, slides.carried, slides.driven) == (1.0, 0.0, 0.0)
    covered = BallRace(**plain, liquid={"density": 1000.0, "viscosity": 1e-6}).race()
    gone = 1000.0 * volume
    assert covered.masses[0] == pytest.approx(mass - gone)
    assert covered.rolling * covered.masses[0] == pytest.approx(1.4 * mass + 0.5 * gone)
    assert covered.carried * covered.masses[0] == pytest.approx(0.4 * wide * mass + 1.5 * gone)


@pytest.mark.parametrize(
    ("changes", "field", "said"),
    [
        ({"kind": "ball"}, "chambers.1.kind", "one of: liquid, balls"),
        ({"kind": 3}, "chambers.1.kind", "one of: liquid, balls"),
        ({"count": 0}, "chambers.1.count", "whole number from 1 to 64"),
        ({"density": 7850}, "chambers.1.density", "exactly one of mass and density"),
        ({"liquid": "water"}, "chambers.1.diameter", "given with liquid"),
        ({"diameter": "90 mm", "count": 10}, "chambers.1.diameter", "fit in the race"),
        ({"diameter": "40 mm", "liquid": "water"}, "chambers.1.mass", "or the balls float"),
        ({"start": "bottom"}, "chambers.1.start", "spread where the axis stands"),
        ({"start": "bottom", "start_angle": 1.0}, "chambers.1.start_angle", "at the bottom"),
        ({"volume": 1e-3}, "chambers.1.volume", "left out or spelled"),
    ],
)
def test_what_a_race_refuses(changes: dict[str, Any], field: str, said: str) -> None:
    with pytest.raises(SceneError) as caught:
        scene_with(RACE | changes)
    assert any(fault.field == field and said in str(fault) for fault in caught.value.faults)


def test_races_stand_behind_the_liquid() -> None:
    table = lb.example("runup").table()
    with pytest.raises(SceneError, match="behind the chambers with liquid"):
        scene_from_table(table | {"chambers": [RACE, *table["chambers"]]})


def test_every_key_of_a_race_stands_in_the_inputs() -> None:
    scene = scene_with({**RACE, "diameter": "12 mm"})
    shown = {
        path
        for table in inputs_of(scene).tables
        for line in table.rows
        for value in line
        for path in value.paths
    }
    assert {f"chambers.1.{key}" for key in BallRace.model_fields if key not in ("kind", "density")} <= shown
