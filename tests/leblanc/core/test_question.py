"""Values of questions, however they are said; what answers print of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import known_liquid
from leblanc.core.files import path_of
from leblanc.core.notes import Note, NoteCode
from leblanc.core.quantities import plain
from leblanc.scene.scene import friction_of, liquid_of
from meshes.errors import InputError


@pytest.mark.parametrize(
    ("text", "table", "law"),
    [
        ("stokes", "stokes", Friction(FrictionLaw.STOKES)),
        ("linear:0.5", {"linear": 0.5}, Friction(FrictionLaw.LINEAR, 0.5)),
        ("linear:0.5 1/s", {"linear": "0.5 1/s"}, Friction(FrictionLaw.LINEAR, 0.5)),
        ("quadratic:0.01", {"quadratic": 0.01}, Friction(FrictionLaw.QUADRATIC, 0.01)),
        ("wall:2 um", {"wall": {"roughness": "2 um"}}, Friction(FrictionLaw.WALL, roughness=2e-6)),
    ],
)
def test_one_grammar_of_friction(text: str, table: object, law: Friction) -> None:
    """A text, a table and the law itself are one law in a call, a text and a table in a file."""
    assert friction_of(text, "friction") == friction_of(table, "friction") == friction_of(law, "friction")
    assert friction_of(text, "friction") == law
    scene = lb.example("horizontal_rig")
    assert all(scene.replace({"model.friction": each}).model.friction == law for each in (text, table))


@pytest.mark.parametrize(
    "wrong", [{"linear": -1.0}, {"cubic": 1.0}, {"linear": 1.0, "quadratic": 1.0}, {}, 0.5, "linear", "mud:1"]
)
def test_no_friction_is_a_fault_of_its_keyword(wrong: object) -> None:
    with pytest.raises(InputError) as raised:
        friction_of(wrong, "friction")
    assert raised.value.field == "friction"


def test_a_file_names_a_text_that_is_no_friction() -> None:
    with pytest.raises(lb.SceneError, match="linear:RATE"):
        lb.example("horizontal_rig").replace({"model.friction": "mud:1"})


def test_liquids_and_files() -> None:
    water = known_liquid("water")
    assert liquid_of("water", "liquid") == liquid_of(water, "liquid") == water
    assert path_of("a.msh", "mesh") == Path("a.msh") and path_of(None, "mesh") is None
    for read, name in ((path_of, "mesh"), (liquid_of, "liquid")):
        with pytest.raises(InputError, match=name):
            read(3.0, name)  # type: ignore[operator]


SCENE, MEASURED = lb.example("horizontal_rig"), "docs/examples/measured.csv"
HUGE = 10**400  # beyond all floating-point numbers
WAVE = {"radius": 0.15, "volume": 6.7e-4, "height": 0.05, "speed": 40.0, "whirl_speed": 32.0}


@pytest.mark.parametrize(
    ("ask", "field"),
    [
        (lambda: lb.layer(**WAVE | {"radius": 1e300}, whirl_amplitude=1e-4), "radius"),
        (lambda: lb.layer(**WAVE | {"speed": HUGE}, whirl_amplitude=1e-4), "speed"),
        (lambda: lb.layer(**WAVE, whirl_amplitude=1e-4, tolerance=HUGE), "tolerance"),
        (lambda: lb.layer(**WAVE, whirl_amplitude=1e-4, cells="many"), "cells"),
        (lambda: lb.compare(SCENE, models=3.0), "models"),
        (lambda: lb.compare(SCENE, models=[1]), "models"),
        (lambda: lb.fit(SCENE, MEASURED, unknown=[1]), "unknown.0"),
        (lambda: lb.fit(SCENE, MEASURED, unknown=["rotor.mass"], column=3.0), "column"),
        (lambda: lb.fit(SCENE, MEASURED, unknown=["rotor.mass"], column={"amplitude": 1}), "column"),
        (lambda: lb.fit(SCENE, None, unknown=["rotor.mass"]), "measured"),
        (lambda: lb.map_balls(lb.example("balls"), over=[1]), "over.0"),
        (lambda: lb.load_scene(3.0), "path"),
        (lambda: lb.example([1]), "example"),
        (lambda: lb.validate([1]), "case"),
    ],
)
def test_what_is_no_value_is_refused_by_its_name(ask: Callable[[], object], field: str) -> None:
    with pytest.raises(InputError) as fault:
        ask()
    assert fault.value.field == field and len(str(fault.value)) < 400


class _Code(NoteCode):
    ONE = "one"


def test_a_note_is_its_sentence_in_json() -> None:
    assert plain({"notes": (Note(_Code.ONE, {"a": 1.0}, "a sentence"),)}) == {"notes": ["a sentence"]}


@pytest.mark.parametrize("radius", [True, np.True_, b"65 mm", b"0.065", bytearray(b"0.065")])
def test_a_truth_value_and_bytes_are_no_quantities(radius: Any) -> None:
    with pytest.raises(InputError, match=r"radius = 'b.*': must be a length"):
        lb.layer(
            radius=radius, volume="10 ml", height="50 mm", speed=40.0, whirl_speed=30.0, whirl_amplitude=1e-4
        )
