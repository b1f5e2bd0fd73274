"""Every model tells the numbers it rests on, and says so in the result where they are out of its range."""

from __future__ import annotations

import json
import math

import pytest

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from fluid.liquid import known_liquid
from leblanc.cli import main
from leblanc.liquid.models import wave_model
from leblanc.liquid.notes import LayerCode, Number
from leblanc.liquid.validity import MEANING
from leblanc.studies.layer.answer import LayerAnswer
from leblanc.studies.layer.study import answer_layer
from meshes.chamber import Chamber
from solvers.potential.steady import linear_detuning
from solvers.synchronous.models import LINEAR
from tests.mutants import kills

R, H, SPIN = 0.15, 0.01, 40.0
SHARED = {"relative_depth", "deflection", "detuning", "froude", "centrifuge", "reynolds", "wall_layer"}


def layer(relative_depth: float, liquid: str = "water") -> Fill:
    surface = R * (1.0 - relative_depth)
    return Fill(Chamber(R, H), known_liquid(liquid), math.pi * (R**2 - surface**2) * H)


def outside(answer: LayerAnswer) -> set[str]:
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


DEEP, RATIO, FOLD = 0.1, 1.1, 0.010372250  # of the fully nonlinear wave, by another code for its equations


def beside_the_fold(
    model: str, share: float, friction: Friction = NO_FRICTION, speed: float = 0.0, gravity: float = 0.0
) -> tuple[Number | None, LayerAnswer]:
    """A whirl of a share of the largest that a smooth wave follows, at a detuning unless a speed is given."""
    fill, asked = layer(DEEP), wave_model(model, friction, 32 if model == "long_wave" else None)
    at = speed or SPIN / (1.0 + RATIO * math.sqrt(linear_detuning(DEEP)))
    answer = answer_layer(fill, SPIN, at, share * FOLD * fill.depth, asked, gravity)
    return next((number for number in answer.validity if number.name == "smooth_whirl"), None), answer


@pytest.mark.parametrize("model", ["linear", "kdv", "long_wave"])
@kills("solvers.liquid_model:smooth_whirl", "/ fill.depth / largest", "* largest / fill.depth")
def test_a_whirl_counts_beside_the_largest_that_a_smooth_wave_follows(model: str) -> None:
    """Told by the models that have an estimate; the note that says why is there where it is out of range."""
    for share in (0.5, 1.5):
        number, answer = beside_the_fold(model, share)
        # The closed form has this fold to 1.5 %, at most 7 %.
        assert number is not None and number.value == pytest.approx(share, rel=0.07) and number.most == 1.0
        told = [note for note in answer.notes if note.code is LayerCode.NO_SMOOTH_WAVE]
        assert number.in_range == (share < 1.0) == (not told) == math.isfinite(answer.error_estimate)
        assert not any(MEANING["smooth_whirl"] in note.text for note in answer.notes), "said once"
        if told:
            assert not answer.in_range and told[0].data["fold"] is True
            assert told[0].data["whirl"] / told[0].data["largest"] == pytest.approx(number.value, rel=1e-12)


@pytest.mark.parametrize("model", ["kdv", "long_wave"])
@kills("solvers.pypde.models:_bounds", 'name != "smooth_whirl"', 'name == "smooth_whirl"')
def test_friction_rounds_a_fold_off(model: str) -> None:
    number, answer = beside_the_fold(model, 1.5, Friction("linear", 1.0))
    assert number is not None and number.most is None and number.in_range
    assert LayerCode.NO_SMOOTH_WAVE not in {note.code for note in answer.notes}


def test_no_end_is_told_where_other_waves_are() -> None:
    assert beside_the_fold("linear", 1.5, gravity=9.81)[0] is None
    assert beside_the_fold("linear", 1.5, speed=SPIN)[0] is None
    still = beside_the_fold("linear", 0.0)[0]
    assert still is not None and still.value == 0.0


def test_json_of_a_history(capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--radius", "0.15", "--volume", repr(layer(0.1).volume), "--height", "0.01", "--speed", "40"]
    options += ["--whirl-speed", "30", "--whirl-amplitude", "0.1 mm", "--model", "long_wave", "--cells", "64"]
    assert main(["layer", *options, "--duration", "1", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert answer["in_range"] is True and answer["notes"] == []
    found = {number["name"]: number for number in answer["validity"]}
    others = {"other_family", "crest", "trough", "crest_number", "smooth_whirl", "grid_gap"}
    assert set(found) == set(MEANING) - others
    assert found["relative_depth"]["most"] == 0.3 and found["centrifuge"]["value"] is None
    assert 0.0 < found["wave_amplitude"]["value"] < 0.2 and found["force_gap"]["value"] < 0.1
    # In words the same numbers stand one to a line.
    assert main(["layer", *options, "--duration", "1"]) == 0
    assert MEANING["force_gap"] in " ".join(capsys.readouterr().out.split())  # the table folds long texts
