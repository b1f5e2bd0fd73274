"""`--model auto`: the cheapest model of a whirling layer that is within the tolerance, and what it says."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from leblanc.cli import main
from leblanc.liquid.notes import LayerCode
from leblanc.liquid.whirling import (
    AutoWave,
    WaveChoice,
    choose_free,
    choose_in_time,
    choose_wave,
)
from leblanc.studies.layer.answer import LayerAnswer
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.liquid_model import Whirl
from solvers.potential.steady import linear_detuning
from solvers.pypde.models import LongWave, OneFamily
from solvers.wave_error import largest_whirl
from tests.exact.answers import layer_fill
from tests.mutants import kills
from validation.exact import detuning, kept, whirl_speeds


def chosen(layer: float, speed: float, size: float, **more: Any) -> WaveChoice:
    """Of a drum of unit radius and spin, a whirl over the depth."""
    fill = layer_fill(layer)
    return choose_wave(AutoWave(**more), fill, Whirl(1.0, speed, size * layer))


def at_ratio(layer: float, ratio: float) -> float:
    return 1.0 / (1.0 + ratio * math.sqrt(linear_detuning(layer)))


DRAWS, SEED = 40, 11


@kills("leblanc.liquid.whirling:_refused", "error <= tolerance", "error <= 30.0 * tolerance")
def test_nineteen_in_twenty_answers_are_as_good_as_they_say() -> None:
    """Beside fully nonlinear waves followed from rest at random whirls, to which nothing was fitted."""
    drawn, rng = kept().drawn, np.random.default_rng(SEED)
    held, kinds = [], []
    for k in rng.choice(np.flatnonzero(drawn.smooth & (drawn.layer <= 0.5)), DRAWS, replace=False):
        tolerance, twin = float(np.exp(rng.uniform(*np.log([1e-6, 0.05])))), int(rng.integers(2))
        layer, ratio, size = (float(each[k]) for each in (drawn.layer, drawn.ratio, drawn.whirl))
        choice = chosen(layer, whirl_speeds(layer, ratio)[twin], size, tolerance=tolerance)
        assert choice.wave is not None, "a smooth wave is answered by a model of smooth waves"
        answer, exact = choice.wave.answer, float(drawn.exact[k])
        force = float(answer.unbalance[0].real) / (layer_fill(layer).full_mass * size * layer)
        told = float(answer.error[0])
        assert told <= tolerance
        kinds.append(choice.model.name)
        # Kept are waves whose spectrum falls to 1e-6 of its largest.
        held.append(abs(force - exact) / max(1.0, abs(exact)) <= max(told, 1e-6))
    assert kinds.count("linear") > 10 and kinds.count("potential") > 3
    assert np.mean(held) >= 0.95


def test_cheaper_models_go_first_and_the_next_one_says_why() -> None:
    """One family is within some per cent next to its resonance alone, where linear theory is not."""
    layer = 0.05
    fold = float(largest_whirl(layer, detuning(layer, 1.02)))
    loose = {"layer": layer, "speed": at_ratio(layer, 1.02), "size": 0.8 * fold}
    names = [chosen(**loose, tolerance=tolerance).model.name for tolerance in (0.5, 0.05, 0.01)]
    assert names == ["linear", "kdv", "potential"]
    reason = chosen(**loose, tolerance=0.01).reason
    assert "linear theory may be off by" in reason and "unidirectional waves may be off by" in reason
    assert "within 1 %" in reason


def test_a_whirl_with_the_drum_is_answered_by_liquid_at_rest() -> None:
    wet, dry = (chosen(0.1, 1.0, size, friction=Friction("stokes")) for size in (0.9, 1.2))
    assert (wet.model.name, dry.model.name) == ("linear", "statics")
    assert "wall" in dry.reason or "range" in dry.reason


@pytest.mark.parametrize("ratio", [0.9, 1.1])
def test_beyond_smooth_waves_long_ones_answer(ratio: float) -> None:
    layer = 0.1
    size = 4.0 * float(largest_whirl(layer, detuning(layer, ratio)))
    found = chosen(layer, at_ratio(layer, ratio), size, cells=64)
    assert isinstance(found.model, LongWave) and "hydraulic jumps" in found.reason and found.wave is None
    assert "4 times the largest" in found.reason and found.notes == (), (
        "the number beside the largest whirl says so already"
    )


def test_an_exact_wave_that_is_not_found_is_said_where_the_closed_form_has_one() -> None:
    """At a resonance of two crests on the way, between it and that of one no end is reported."""
    layer, ratio, size = 0.45, 0.97, 0.2
    found = chosen(layer, at_ratio(layer, ratio), size, cells=16)
    assert float(largest_whirl(layer, detuning(layer, ratio))) == math.inf
    assert found.model.name == "long_wave"
    assert [note.code for note in found.notes] == [LayerCode.NO_EXACT_WAVE]


FILL = Fill(Chamber(0.15, 0.05), layer_fill(0.1).liquid, 6.71e-4)


@pytest.mark.parametrize(
    ("asked", "gravity", "name", "said"),
    [
        (AutoWave(Friction("linear", 1.0)), 0.0, "long_wave", "friction"),
        (AutoWave(), 9.81, "long_wave", "gravity"),
        (AutoWave(), 0.0, "linear", "within 1 %"),
    ],
)
def test_what_acts_decides_who_is_asked(asked: AutoWave, gravity: float, name: str, said: str) -> None:
    found = choose_wave(asked, FILL, Whirl(40.0, 32.0, 1.5e-4, gravity=gravity))
    assert found.model.name == name and said in found.reason


def test_baffles_are_left_to_those_who_take_them() -> None:
    fill = Fill(Chamber(0.15, 0.05, baffles=Baffles(6, 0.0, 0.0)), FILL.liquid, FILL.volume)
    small, large = Whirl(40.0, 32.0, 1e-5), Whirl(40.0, 32.0, 5e-2)
    assert choose_wave(AutoWave(), fill, small).model.name == "fem"
    assert choose_wave(AutoWave(), fill, large).model.name == "long_wave"
    assert choose_wave(AutoWave(Friction("linear", 1.0)), fill, small).model.name == "long_wave"


def test_long_waves_get_dispersion_where_it_brings_them_within_the_tolerance() -> None:
    rubbed = {"friction": Friction("linear", 0.01), "speed": 0.85, "size": 0.05}
    for layer, tolerance, dispersion in ((0.25, 0.02, False), (0.25, 0.002, True), (0.25, 1e-6, False)):
        model = chosen(layer, tolerance=tolerance, **rubbed).model
        assert isinstance(model, LongWave) and model.numerics.dispersion is dispersion
    model = chosen(0.02, dispersion=True, **rubbed).model
    assert isinstance(model, LongWave) and model.numerics.dispersion


def test_dispersion_goes_to_one_family_too() -> None:
    layer = 0.05
    size = 0.8 * float(largest_whirl(layer, detuning(layer, 1.02)))
    model = chosen(layer, at_ratio(layer, 1.02), size, tolerance=0.05, dispersion=True).model
    assert isinstance(model, OneFamily) and model.dispersion


def test_through_time_and_free_waves() -> None:
    whirl = Whirl(1.0, 0.8, 1e-3)
    assert choose_in_time(AutoWave(), layer_fill(0.1), whirl).model.name == "long_wave"
    assert choose_in_time(AutoWave(), layer_fill(0.4), whirl).model.name == "potential"
    rubbed = AutoWave(Friction("linear", 0.1))
    assert choose_in_time(rubbed, layer_fill(0.4), whirl).model.name == "long_wave"
    assert choose_free(AutoWave()).model.name == "potential"
    with pytest.raises(InputError, match="friction"):
        choose_free(rubbed)
    assert AutoWave().friction == NO_FRICTION


LAYER = ["layer", "--radius", "0.15", "--volume", "6.71e-4", "--height", "0.05", "--speed", "40"]
WHIRL = [*LAYER, "--whirl-speed", "32", "--whirl-amplitude", "1.5e-4"]


def test_the_answer_tells_model_and_reason(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*WHIRL, "--model", "auto", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert main([*WHIRL, "--model", "linear", "--json"]) == 0
    named = json.loads(capsys.readouterr().out)
    assert found["model"] == named["model"] == "linear" and named["model_reason"] == ""
    assert "its estimated error is 0.42 %, within 1 %" in found["model_reason"]
    assert found["force_ratio"] == named["force_ratio"]
    options = {"radius": 0.15, "volume": 6.71e-4, "height": 0.05, "speed": 40.0, "whirl_speed": 32.0}
    tight = lb.layer(**options, whirl_amplitude=1.5e-4, model="auto", tolerance=1e-3)
    assert isinstance(tight, LayerAnswer) and tight.model == "potential"
    assert tight.exact is not None and ("Why that model", tight.model_reason) in tight.facts()
    assert tight.named_arrays().attrs["reason"] == tight.model_reason


def test_through_time_and_free_by_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    timed = ["--model", "auto", "--duration", "0.5", "--cells", "32", "--json"]
    assert main([*WHIRL, *timed]) in (0, 3)
    found = json.loads(capsys.readouterr().out)
    assert found["model"] == "long_wave" and "no estimate" in found["model_reason"]
    assert main([*LAYER, "--free", "1.1", "--model", "auto", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["model"] == "potential"


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (["--model", "linear", "--tolerance", "0.1"], "--tolerance"),
        (["--model", "auto", "--tolerance", "0"], "--tolerance"),
        (["--model", "auto", "--tolerance", "2"], "--tolerance"),
        (["--model", "auto", "--solver", "scipy"], "--solver"),
        (["--model", "auto", "--friction", "linear:1", "--cells", "2"], "--cells"),
        (["--model", "automatic"], "--model"),
    ],
)
def test_bad_input(capsys: pytest.CaptureFixture[str], options: list[str], named: str) -> None:
    assert main([*WHIRL, *options]) == 2
    err = capsys.readouterr().err
    assert named in err and len(err.strip().splitlines()) == 1
