"""A question of one's own the whole way: call and command, its file, words, JSON and faults."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli.command import command
from leblanc.core.answer import Answer, NotConverged
from leblanc.core.blocks import Block, Headline, Table
from leblanc.core.question import SCENE, Quantity, ask
from leblanc.core.units import LENGTH
from leblanc.scene.examples import example_path
from leblanc.scene.scene import Scene
from meshes.arrays import Array
from meshes.errors import InputError
from meshes.quantity import Q
from tests.mutants import kills

FILES = ("lift.nc",)


@dataclass(frozen=True)
class LiftAnswer(Answer):
    """Work to lift the rotor, at each speed the same."""

    command = "lift"
    data = "lift.nc"

    name: str
    source: str
    assumed: tuple[str, ...]
    digest: str
    speed: Annotated[Array, Q("rad s-1", "spin speed", over=("speed",))]
    work: Annotated[Array, Q("J", "work to lift the rotor", over=("speed",))]
    height: Annotated[float, Q("m", "height")]

    @property
    def faults(self) -> tuple[str, ...]:
        return ("higher than the room",) if self.height > 3.0 else ()

    def blocks(self) -> tuple[Block, ...]:
        return Headline(f"{self.work[0]:g} J", shown="both"), Table([("height", f"{self.height:g} m")])


def lift(
    scene: Annotated[Scene | str, SCENE, "Scene or its file."],
    *,
    height: Annotated[Quantity, LENGTH, "Height."] = 1.0,
) -> LiftAnswer:
    """Work to lift a rotor."""
    return ask(lift, "tests.leblanc.core.test_way:answer_lift", locals())


def answer_lift(scene: Scene, height: float) -> LiftAnswer:
    """What the study answers: m g h."""
    if height < 0.0:
        raise InputError("height", height, "0 m or more")
    speed = scene.speed_array()
    about = (scene.name, scene.source, scene.assumed, scene.digest)
    return LiftAnswer(*about, speed, np.full(speed.shape, scene.rotor.mass * scene.gravity * height), height)


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    """The horizontal rig as a file: 4 kg under 9.81 m/s^2."""
    file = tmp_path / "rig.toml"
    file.write_text(example_path("horizontal_rig").read_text(encoding="utf-8"), encoding="utf-8")
    return file


@kills("leblanc.core.question:read", "parse_option(value, one.read, one.name)", "2.0")
def test_a_call_takes_a_scene_or_its_file_and_quantities_with_units(rig: Path) -> None:
    for scene in (rig, str(rig), lb.load_scene(rig)):
        assert lift(scene, height="50 cm").work[0] == pytest.approx(4.0 * 9.81 * 0.5, rel=1e-12)  # type: ignore[arg-type]
    assert lift(str(rig)).work[0] == pytest.approx(4.0 * 9.81, rel=1e-12)
    with pytest.raises(InputError, match="scene"):
        lift(4.0)  # type: ignore[arg-type]


@kills("leblanc.cli.command:_of_option", "one is None or one.option.argument", "True")
def test_a_command_prints_words_or_json_and_writes_its_file(
    rig: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    typed = command(lift)
    typed(scene=rig, height="2 m", out=tmp_path / "out", json=False)
    words = capsys.readouterr().out
    assert "78.48 J" in words and "2 m" in words and str(tmp_path / "out" / "lift.nc") in words
    assert (tmp_path / "out" / "lift.nc").is_file()
    typed(scene=rig, height="2 m", out=tmp_path / "out", json=True)
    found = json.loads(capsys.readouterr().out)
    assert found["height"] == 2.0 and found["work"][0] == pytest.approx(78.48)
    with pytest.raises(InputError, match="--height"):
        typed(scene=rig, height="-2 m", out=tmp_path / "out", json=True)


@kills("leblanc.cli.command:finish", "if fault is not None", "if False")
def test_a_failed_answer_is_written_and_ends_as_one(
    rig: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        command(lift)(scene=rig, height="4 m", out=tmp_path / "out", json=False)
        raised: tuple[str, ...] = ()
    except NotConverged as error:
        raised = error.failed
    assert raised == (f"{rig}: higher than the room",)
    assert "156.96 J" in capsys.readouterr().out and (tmp_path / "out" / "lift.nc").is_file()
