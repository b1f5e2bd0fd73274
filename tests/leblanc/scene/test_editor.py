"""The JSON schema of a machine file: it takes what the models take, and refuses what they refuse."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from leblanc.cli import main
from leblanc.scene.examples import example_names, example_path
from leblanc.scene.scene import Scene
from leblanc.scene.schema.editor import machine_schema
from leblanc.scene.schema.paths import path_words

SCENES = [name for name in example_names() if not name.startswith("studies/")]


def table(name: str) -> dict[str, Any]:
    return tomllib.loads(example_path(name).read_text(encoding="utf-8"))


def faults(content: dict[str, Any]) -> list[str]:
    return [fault.message for fault in Draft202012Validator(machine_schema(Scene)).iter_errors(content)]


def test_it_is_a_schema() -> None:
    Draft202012Validator.check_schema(machine_schema(Scene))


@pytest.mark.parametrize("name", SCENES)
def test_the_examples_keep_to_it(name: str) -> None:
    assert not faults(table(name))


@pytest.mark.parametrize(
    ("place", "key", "value"),
    [
        ("rotor", "mas", "4 kg"),
        ("rotor", "axis", "upright"),
        ("rotor", "mass", True),
        ("speeds", "count", 1.5),
        ("runup", "back", "yes"),
        ("chambers", "volume", ["1 l"]),
    ],
)
def test_what_the_models_refuse_it_refuses(place: str, key: str, value: object) -> None:
    content = table("runup")
    inside = content[place][0] if place == "chambers" else content[place]
    inside[key] = value
    assert faults(content)


def test_each_key_has_its_sentence() -> None:
    said = machine_schema(Scene)
    mass = said["$defs"]["JeffcottRotor"]["properties"]["mass"]
    assert mass["type"] == ["number", "string"] and 'such as "4 kg"' in mass["description"]
    for name, part in {"": said, **said["$defs"]}.items():
        for key, entry in part.get("properties", {}).items():
            assert entry.get("description") or "$ref" in entry, f"{name}.{key}"


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert main(["schema", "--out", str(tmp_path / "machine.json")]) == 0
    assert (
        json.loads((tmp_path / "machine.json").read_text(encoding="utf-8"))
        == printed
        == machine_schema(Scene)
    )
    assert "#:schema" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("paths", "words"),
    [
        (("rotor.damping_ratio",), "damping ratio"),
        (("chambers.0.drag",), "race damping"),
        (("chambers.1.drag",), "race damping of chamber 2"),
        (("rotor.supports.0.damping",), "damping of support 1"),
        (("rotor.supports.0.damping", "rotor.supports.1.damping"), "damping of support 1 and 1 more"),
        (("rotor.mass",), "mass"),
    ],
)
def test_paths_are_words_on_axes(paths: tuple[str, ...], words: str) -> None:
    assert path_words(*paths) == words
