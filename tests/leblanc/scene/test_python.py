"""Scenes made and changed in Python: the same checks as for a file, and the same scenes."""

from __future__ import annotations

import pickle
import tomllib
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fluid.liquid import KNOWN_LIQUIDS, Liquid
from leblanc.scene.chambers import Chamber
from leblanc.scene.examples import example, example_names
from leblanc.scene.rotors import JeffcottRotor, Spring
from leblanc.scene.scene import Scene, Speeds, scene_from_table
from leblanc.scene.schema.load import SceneError
from tests.leblanc.scene.test_rotors import EXCITER, HEAD, MAGNETIC, MOTOR, TUB, TWO_PLANE
from tests.leblanc.scene.test_scene import TEXT, read

SCENES = [name for name in example_names() if not name.startswith("studies/")]


def fields(caught: pytest.ExceptionInfo[SceneError]) -> list[str]:
    return [fault.field for fault in caught.value.faults]


def test_a_scene_of_parts_is_that_of_the_file() -> None:
    file = tomllib.loads(TEXT)
    parts = Scene(
        name="Rig",
        source="a paper",
        assumed=["rotor.mass", "chambers.0.height"],
        gravity="9.8 m/s^2",
        rotor=JeffcottRotor(
            mass="4 kg",
            critical_speed="1000 rpm",
            damping_ratio=0.1,
            unbalance="0.6 kg*mm",
            axis="horizontal",
        ),
        chambers=[
            Chamber(
                radius="65 mm",
                inner_radius="10 mm",
                height="20 mm",
                volume="10 ml",
                liquid="water",
                plane=-0.005,
            ),
            {"radius": 0.05, "height": 0.02, "volume": 0, "liquid": {"density": 998, "viscosity": 1e-6}},
        ],
        speeds=Speeds(start="100 rpm", stop="2000 rpm", count=191),
        model=file["model"],
        runup=file["runup"],
    )
    assert parts == read()
    assert parts.digest == read().digest


def test_parts_are_refused_in_the_same_words() -> None:
    with pytest.raises(SceneError, match=r"^Chamber: radius = \"-1 m\": must be a length") as caught:
        Chamber(radius="-1 m", height=0.1, liquid="water", volum=3)
    assert fields(caught) == ["radius", "volume", "volum"]
    with pytest.raises(SceneError) as caught:
        Scene(name="x", rotor={"kind": "jeffcott"}, speeds={"start": 2, "stop": 1, "count": 0})
    assert fields(caught) == [
        "rotor.mass",
        "rotor.critical_speed",
        "rotor.damping_ratio",
        "rotor.unbalance",
        "rotor.axis",
        "speeds.stop",
        "speeds.count",
    ]
    with pytest.raises(SceneError, match=r"stiffness = 1.0: must be a list of three"):
        Spring(position=(0.0, 0.0, 0.0), stiffness=1.0)


def test_what_is_assumed_stands_in_the_parts() -> None:
    good: dict[str, Any] = {
        "name": "x",
        "rotor": JeffcottRotor(mass=4, stiffness=4e4, damping=80, unbalance=0, axis="vertical"),
        "chambers": (Chamber(radius=0.1, height=0.02, volume=0, liquid=Liquid("tea", 990.0, 1e-6)),),
        "speeds": Speeds(start=1, stop=2, count=2),
    }
    assert Scene(**good, assumed=("rotor.stiffness", "chambers.0")).fills[0].liquid.name == "tea"
    with pytest.raises(SceneError) as caught:
        Scene(**good, assumed=["rotor.critical_speed", "chambers.0.plane"])
    assert fields(caught) == ["assumed.0", "assumed.1"]


# -- other values --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENES)
def test_nothing_replaced_is_the_same_scene(name: str) -> None:
    scene = example(name)
    again = scene.replace({})
    assert again == scene and again.digest == scene.digest
    assert scene_from_table(scene.table()) == scene
    sent = pickle.loads(pickle.dumps(scene))  # to another process
    assert sent == scene and sent.digest == scene.digest


@pytest.mark.parametrize("text", [TWO_PLANE, TUB, EXCITER, MAGNETIC, TUB + MOTOR])
def test_every_kind_gives_its_table(text: str) -> None:
    scene = scene_from_table(tomllib.loads(HEAD + text))
    assert scene.replace({"name": "x"}).digest == scene.digest


@settings(max_examples=50)
@given(
    st.floats(1e-3, 1e3),
    st.floats(0.0, 2e-4),
    st.sampled_from(sorted(KNOWN_LIQUIDS)),
    st.sampled_from(["none", "stokes", {"linear": 3.0}, {"quadratic": 0.1}]),
)
def test_a_replaced_value_is_that_of_a_file(mass: float, volume: float, liquid: str, friction: Any) -> None:
    """Replaced, or written into the file: the same scene."""
    scene = read().replace(
        {
            "rotor.mass": mass,
            "chambers.0.volume": f"{volume * 1e6!r} ml",
            "chambers.1.liquid": liquid,
            "model.friction": friction,
        }
    )
    file = tomllib.loads(TEXT)
    file["rotor"]["mass"] = mass
    file["chambers"][0]["volume"] = f"{volume * 1e6!r} ml"
    file["chambers"][1]["liquid"] = liquid
    file["model"]["friction"] = friction
    assert scene == scene_from_table(file)
    assert read().digest == read().replace({}).digest  # and the first one stays what it is


def test_values_within_tables_and_lists() -> None:
    scene = read().replace({"chambers.1.liquid.density": "900 kg/m^3", "runup.cells": 32, "gravity": 1.6})
    assert (scene.fills[1].liquid.density, scene.gravity) == (900.0, 1.6)
    assert scene.runup is not None and scene.runup.cells == 32
    tub = example("tub").replace({"rotor.springs.0.position.1": "12 mm"})
    assert tub.rotor.kind == "tub" and tub.rotor.springs[0].position[1] == 0.012
    assert example("tub").replace({"chambers": []}).fills == ()


def test_one_speed_moves_as_a_whole() -> None:
    alone = read().replace({"speeds.stop": "100 rpm", "speeds.count": 1})
    assert alone.replace({"speeds.start": 50.0}).speeds == Speeds(start=50.0, stop=50.0, count=1)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"chambers.0.volum": 1}, [("chambers.0.volum", "did you mean volume?")]),
        ({"rotr.mass": 1}, [("rotr.mass", "did you mean rotor?")]),
        ({"chambers.2.volume": 1}, [("chambers.2.volume", "the scene has no chambers.2")]),
        ({"optimise.seed": 1}, [("optimise.seed", "the scene has no optimise")]),
        ({"rotor.stiffness": 1}, [("rotor.stiffness", "the scene gives rotor.critical_speed in its place")]),
        ({"rotor.kind": "tub"}, [("rotor.tub_mass", "must be given")]),
        (
            {"rotor.mass": "-1 kg", "chambers.0.volume": "80 l"},
            [("rotor.mass", "a mass"), ("chambers.0.volume", "at most what the chamber holds")],
        ),
        ({"x": 1, "rotor.y": 2}, [("x", "the scene has"), ("rotor.y", "rotor has")]),
    ],
)
def test_faulty_values_are_named(changes: dict[str, Any], said: list[tuple[str, str]]) -> None:
    with pytest.raises(SceneError) as caught:
        read().replace(changes)
    for field, words in said:
        assert any(fault.field == field and words in str(fault) for fault in caught.value.faults), field


# -- what was worked out from old values does not outlive them -----------------------------------------------


def test_an_altered_part_forgets_what_it_worked_out() -> None:
    scene = read()
    first, machine = scene.fills[0], scene.rotor.machine()
    assert scene.fills[0] is first and scene.rotor.machine() is machine  # and keeps it otherwise
    other = scene.altered(
        chambers=(scene.chambers[0].altered(height=0.04),), rotor=scene.rotor.altered(unbalance=1.0)
    )
    assert other.fills[0].chamber.height == 0.04 and len(other.fills) == 1
    assert isinstance(other.rotor, JeffcottRotor) and other.rotor.machine().unbalance == 1.0
    more = scene.chambers[0].holding(2e-5)
    assert (more.volume, more.fill().volume, scene.fills[0].volume) == (2e-5, 2e-5, 1e-5)
    assert more.altered(volume=3e-5).fill().volume == 3e-5


# -- near misses ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("right", "wrong", "meant"),
    [
        ("critical_speed =", "critical_sped =", "critical_speed"),
        ("[speeds]", "[speed]", "speeds"),
        ('liquid = "water"', 'liquid = "watr"', "water"),
        ('"long_wave"', '"long wave"', "long_wave"),
        ('"long_wave"', '"LONG_WAVE"', "long_wave"),
        ('"jeffcott"', '"jeffcot"', "jeffcott"),
        ('"horizontal"', '"horizontl"', "horizontal"),
        ('{ linear = "0.5 1/s" }', '"stoke"', "stokes"),
        ("{ linear =", "{ liner =", "linear"),
        ("density = 998", "densty = 998", "density"),
    ],
)
def test_a_near_miss_is_named(right: str, wrong: str, meant: str) -> None:
    assert TEXT.count(right) == 1
    with pytest.raises(SceneError, match=rf"; did you mean {meant}\?"):
        read(TEXT.replace(right, wrong))


def test_what_is_near_to_nothing_is_not_guessed() -> None:
    with pytest.raises(SceneError) as caught:
        read(TEXT.replace('liquid = "water"', 'liquid = "beer"'))
    assert "did you mean" not in str(caught.value)
