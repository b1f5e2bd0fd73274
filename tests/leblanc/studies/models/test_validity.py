"""Every model tells the numbers it rests on, and says so in the result where they are out of its range."""

from __future__ import annotations

import json
import math

import pytest

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from fluid.liquid import known_liquid
from leblanc.cli import main
from leblanc.results.layer import LayerResult
from leblanc.studies.layer import answer_layer
from leblanc.studies.models.liquid import wave_model
from leblanc.studies.models.validity import MEANING
from meshes.chamber import Chamber
from solvers.synchronous.models import LINEAR

R, H, SPIN = 0.15, 0.01, 40.0
SHARED = {"relative_depth", "deflection", "detuning", "froude", "centrifuge", "reynolds", "wall_layer"}


def layer(relative_depth: float, liquid: str = "water") -> Fill:
    surface = R * (1.0 - relative_depth)
    return Fill(Chamber(R, H), known_liquid(liquid), math.pi * (R**2 - surface**2) * H)


def outside(answer: LayerResult) -> set[str]:
    return {number.name for number in answer.validity if not number.in_range}


@pytest.mark.parametrize("model", ["statics", "linear", "long_wave", "kdv"])
def test_numbers_are_told_and_inside(model: str) -> None:
    whirl = SPIN if model == "statics" else 30.0
    friction = Friction("linear", 1.0) if model in ("long_wave", "kdv") else NO_FRICTION
    answer = answer_layer(layer(0.1), SPIN, whirl, 5e-5, wave_model(model, friction))
    assert {number.name for number in answer.validity} >= SHARED | {"wave_amplitude"}
    assert answer.in_range and not outside(answer) and not answer.notes
    assert all(number.meaning == MEANING[number.name] for number in answer.validity)


@pytest.mark.parametrize(
    ("model", "depth", "whirl", "amplitude", "out"),
    [
        ("linear", 0.1, 30.6, 1e-3, "wave_amplitude"),
        ("linear", 0.002, 30.0, 1e-6, "wall_layer"),
        ("kdv", 0.4, 28.0, 1e-5, "relative_depth"),
        ("kdv", 0.1, 20.0, 1e-5, "other_family"),
        ("long_wave", 0.5, 30.0, 1e-5, "relative_depth"),
    ],
)
def test_outside_is_said(model: str, depth: float, whirl: float, amplitude: float, out: str) -> None:
    friction = Friction("linear", 1.0) if model != "linear" else NO_FRICTION
    answer = answer_layer(layer(depth), SPIN, whirl, amplitude, wave_model(model, friction))
    assert out in outside(answer) and not answer.in_range
    assert any(MEANING[out] in note.text for note in answer.notes)


def test_gravity_that_lets_the_layer_fall_is_out_of_range() -> None:
    answer = answer_layer(layer(0.1), 5.0, 4.0, 1e-5, LINEAR, gravity=9.81)
    assert outside(answer) == {"centrifuge"} and not answer.captured


def test_synchronous_linear_waves_hold_up_to_the_dry_wall() -> None:
    fill = layer(0.1)
    assert answer_layer(fill, SPIN, SPIN, 0.9 * fill.depth, LINEAR).in_range
    assert outside(answer_layer(fill, SPIN, SPIN, 1.1 * fill.depth, LINEAR)) == {"wave_amplitude"}


def test_json_of_a_history(capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--radius", "0.15", "--volume", repr(layer(0.1).volume), "--height", "0.01", "--speed", "40"]
    options += ["--whirl-speed", "30", "--whirl-amplitude", "0.1 mm", "--model", "long_wave", "--cells", "64"]
    assert main(["layer", *options, "--duration", "1", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["in_range"] is True and answer["notes"] == []
    found = {number["name"]: number for number in answer["validity"]}
    assert set(found) == set(MEANING) - {"other_family", "crest", "trough", "crest_number"}
    assert found["relative_depth"]["most"] == 0.3 and found["centrifuge"]["value"] is None
    assert 0.0 < found["wave_amplitude"]["value"] < 0.2 and found["force_gap"]["value"] < 0.1
    # In words the same numbers stand one to a line.
    assert main(["layer", *options, "--duration", "1"]) == 0
    assert MEANING["force_gap"] in " ".join(capsys.readouterr().out.split())  # the table folds long texts
