"""The liquid model at each speed of a scene, and of its run-up: cheapest within tolerance, and why."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from fluid.friction.laws import Friction, FrictionLaw
from leblanc.core.notes import percent
from leblanc.liquid.choice import model_spans, seconds_words
from leblanc.liquid.choose import axial_gravity, choose, choose_all, prepare, runup_outlook
from leblanc.liquid.models import synchronous_model
from leblanc.scene.scene import Scene, dry_rotor, jeffcott, load_scene
from leblanc.studies.explain.answer import machine_rows
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.run.notes import RunCode
from leblanc.studies.run.study import run_scene
from leblanc.studies.runup.study import runup_scene
from meshes.errors import InputError
from solvers.held.cost import hold_seconds
from solvers.synchronous.models import LINEAR
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from tests.leblanc.studies.test_explain import scene as small_scene
from tests.leblanc.studies.test_runup import scene as upright_scene
from tests.mutants import kills
from tests.oracles.blocks import on_terminal

WITHOUT_LIQUID = ('kind = "exciter"', 'kind = "magnetic"', 'kind = "spindle"', 'kind = "balls"')
EXAMPLES = sorted(
    path.stem
    for path in Path("examples").glob("*.toml")
    if not any(kind in path.read_text() for kind in WITHOUT_LIQUID)
)


def asked(machine: Scene, liquid: str, tolerance: float = 0.01) -> Scene:
    return machine.altered(model=machine.model.altered(liquid=liquid, tolerance=tolerance))


def strong(unbalance: float = 6e-3) -> Scene:
    """An upright scene whose wall runs dry near resonance."""
    return small_scene(axis="vertical", unbalance=unbalance)


@kills("leblanc.liquid.choose:_choice", "linear.wet & (linear.worst <= tolerance)", "linear.worst <= 9.0")
def test_auto_is_within_its_tolerance() -> None:
    """What `auto` takes differs from the exact equilibrium by no more than it says and no more than asked.

    1e-9 stands for the solver's linear limit.
    """
    for tolerance in (1e-6, 0.01, 0.3):
        machine = asked(strong(), "auto", tolerance)
        auto, exact = run_scene(machine), run_scene(asked(machine, "statics"))
        names = set(auto.response.model.tolist())
        assert names == {"linear", "statics"}
        assert auto.error_estimate is not None and (auto.error_estimate <= tolerance).all()
        slack = auto.error_estimate + 1e-9
        assert (np.abs(auto.amplitude - exact.amplitude) <= slack * exact.amplitude).all()
        offset, true = auto.response.liquid_offset, exact.response.liquid_offset
        assert (np.abs(offset - true) <= slack * true).all()
        np.testing.assert_array_equal(auto.response.dry_patch, exact.response.dry_patch)
        np.testing.assert_array_equal(auto.response.in_range, exact.response.in_range)


def test_a_finer_tolerance_takes_the_exact_model_more_often() -> None:
    counts = [np.sum(choose(asked(strong(), "auto", one)).models == "statics") for one in (1e-12, 0.01, 0.5)]
    assert counts[0] >= counts[1] >= counts[2] and counts[0] > counts[2]


def test_a_model_that_is_asked_for_is_taken_and_its_error_told() -> None:
    for name in ("statics", "linear"):
        choice = choose(asked(strong(), name))
        assert choice.prescribed and set(choice.models.tolist()) == {name} and choice.model == name
        assert set(run_scene(asked(strong(), name)).response.model.tolist()) == {name}
    linear, auto = choose(asked(strong(), "linear")), choose(strong())
    assert linear.error.max() > 0.5 and linear.missed.any()
    np.testing.assert_array_equal(linear.error, auto.linear.worst)
    notes = run_scene(asked(strong(), "linear")).notes
    assert "the model asked for" in str(notes[0]) and "more than the tolerance of 1 %" in str(notes[0])


@kills(
    "leblanc.liquid.choose:_choice",
    "linear.worst, ROUNDING) + gravity.amplitude",
    "linear.worst, ROUNDING)",
)
@kills(
    "leblanc.liquid.choose:across_gravity",
    'scene.rotor.axis == "horizontal"',
    'scene.rotor.axis == "vertical"',
)
def test_where_the_tolerance_is_not_met() -> None:
    """Across a lying axis gravity spoils slow speeds: no number below capture, a large error above it."""
    choice = choose(small_scene())
    speed = small_scene().speed_array()
    assert np.isnan(choice.error[~choice.in_range]).all() and (~choice.in_range).any()
    above = choice.error[choice.in_range]
    assert (np.diff(choice.gravity.amplitude[choice.in_range][speed[choice.in_range] > 150.0]) < 0.0).all()
    assert above[0] > choice.tolerance > above[-1]
    assert choice.missed[0] and not choice.missed[-1]
    notes = run_scene(small_scene()).notes
    assert any(note.code is RunCode.TOLERANCE_MISSED for note in notes)
    spans = model_spans(choice, speed)
    kinds = [(span.in_range, span.within_tolerance) for span in spans]
    assert kinds[0] == (False, False) and kinds[-1] == (True, True) and (True, False) in kinds
    assert spans[0].first == speed[0] and spans[-1].last == speed[-1]
    assert "does not ride" in spans[0].reason


@kills("leblanc.liquid.choose:held_cost", 'scene.model.altered(held="auto")', "scene.model")
@kills("leblanc.liquid.choose:held_cost", "choice.holding[at].sum()", "choice.holding.sum()")
@kills("leblanc.liquid.choose:costed", "machine.across_gravity", "machine.axial_gravity")
def test_what_motions_held_in_time_would_take_is_told_in_seconds() -> None:
    """`explain` and the note of `run` name the speeds that auto would hold and the time that takes."""
    lying = small_scene()
    machine = prepare(lying)
    growth = asynchronous_growth(machine.rotor, lying.fills, machine.speed, machine.friction)[0]
    choice = choose(lying)
    # As many as no steady model answers, and as grow; what each takes follows from its cells and layers.
    wanted = choice.in_range & (choice.missed | (growth > 0.0))
    seconds = hold_seconds(lying.fills, machine.speed[wanted], growth[wanted], 9.81)
    held = explain_scene(lying).held
    assert held is not None and not held.asked
    assert held.speeds == np.count_nonzero(wanted) < machine.speed.size
    assert held.seconds == pytest.approx(seconds.sum(), rel=1e-12)
    assert (held.first, held.last) == tuple(machine.speed[wanted][[0, -1]])
    assert f"{held.speeds} speeds" in (
        words := dict(machine_rows(explain_scene(lying)))["integrated in time"]
    )
    assert seconds_words(held.seconds) in words and 'held = "auto"' in words
    (note,) = (each for each in run_scene(lying).notes if each.code is RunCode.TOLERANCE_MISSED)
    assert note.data["held_speeds"] == held.speeds and note.data["held_seconds"] == held.seconds
    assert seconds_words(held.seconds) in str(note)


def test_nothing_is_said_of_motions_held_in_time_where_none_are_wanted() -> None:
    """Not where steady models answer all, nor where the scene names one; once held, it is what they take."""
    calm = small_scene(axis="vertical", unbalance=1e-6)
    quiet = calm.altered(model=calm.model.altered(friction=Friction(FrictionLaw.LINEAR, 5.0)))
    assert explain_scene(quiet).held is None
    assert explain_scene(asked(small_scene(), "statics")).held is None
    lying = small_scene()
    every = explain_scene(lying.altered(model=lying.model.altered(held="always"))).held
    assert every is not None and every.asked and every.speeds == lying.speed_array().size
    few = explain_scene(lying.altered(model=lying.model.altered(held="always", cells=64))).held
    # A quarter of the cells' share, and the turns themselves.
    assert few is not None and 0.25 * every.seconds < few.seconds < 0.75 * every.seconds


def test_all_scenes_at_once_are_each_one_alone() -> None:
    scenes = [
        small_scene(), strong(), load_scene("examples/two_plane_rig.toml"), asked(strong(), "linear"),
        load_scene("examples/vertical_rig.toml"),
    ]  # fmt: skip
    for one, machine in zip(choose_all([prepare(machine) for machine in scenes]), scenes, strict=True):
        alone = choose(machine)
        np.testing.assert_array_equal(one.models, alone.models)
        np.testing.assert_allclose(one.error, alone.error, rtol=1e-12)
    with pytest.raises(InputError, match=r"model\.liquid"):
        cut = asked(small_scene(), "kdv").replace({"chambers.0.baffles": {"count": 4}})
        choose_all([prepare(small_scene()), prepare(cut)])


@kills("solvers.synchronous.response:_merged", "for _, part in parts]).at(order)", "for _, part in parts])")
def test_mixed_models() -> None:
    """Each speed is answered by its own model, whatever its neighbours take."""
    machine = strong()
    rotor, fills, speed = jeffcott(machine), machine.fills, machine.speed_array()
    gravity = axial_gravity(machine)
    models = np.where(np.arange(speed.size) % 3 == 0, "linear", "statics")
    mixed = response(rotor, fills, speed, gravity, [synchronous_model(name) for name in models.tolist()])
    for name in ("linear", "statics"):
        whole, rows = response(rotor, fills, speed, gravity, synchronous_model(name)), models == name
        np.testing.assert_allclose(mixed.deflection[rows], whole.deflection[rows], rtol=1e-12)
        np.testing.assert_array_equal(mixed.stable[rows], whole.stable[rows])
        count = np.isfinite(mixed.branch_deflection[rows]).sum(axis=1)
        np.testing.assert_array_equal(count, np.isfinite(whole.branch_deflection[rows]).sum(axis=1))
    assert mixed.model.tolist() == models.tolist()
    np.testing.assert_array_equal(mixed.speed, speed)


def test_mixed_models_of_a_tilting_rotor() -> None:
    machine = load_scene("examples/two_plane_rig.toml")
    rotor, speed = dry_rotor(machine), machine.speed_array()[::40]
    models = np.where(np.arange(speed.size) % 2 == 0, "linear", "statics")
    mixed = response(rotor, machine.fills, speed, 0.0, [synchronous_model(name) for name in models.tolist()])
    linear = response(rotor, machine.fills, speed, 0.0, LINEAR)
    assert mixed.model.tolist() == models.tolist() and mixed.position == linear.position
    np.testing.assert_allclose(mixed.coordinates[::2], linear.coordinates[::2], rtol=1e-12)


def test_the_estimate_is_written() -> None:
    record = run_scene(small_scene())
    found = record.to_json()["error_estimate"]
    assert len(found) == record.response.speed.size and found[0] is None and 0.0 < found[-1] < 0.01
    kept = record.to_dataset()["error_estimate"]
    assert kept.attrs["units"] == "1"
    np.testing.assert_array_equal(kept.values, record.error_estimate)
    assert "error_estimate" not in replace(record, error_estimate=None).to_json()


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_is_explained(name: str) -> None:
    """Words and numbers for each range of speeds, without gaps, and nothing that was not filled in."""
    file = f"examples/{name}.toml"
    found = lb.explain(file)
    words = on_terminal(found)
    assert "estimated error" in words and "next better" in words and "tolerance of 0.1 %" in words
    assert "nan" not in words.split() and "inf" not in words.split() and "{" not in words
    assert max(map(len, words.splitlines())) <= 140
    spans = json.loads(json.dumps(found.to_json()))["models"]
    speed = load_scene(file).speed_array()
    assert spans[0]["first"] == pytest.approx(speed[0]) and spans[-1]["last"] == pytest.approx(speed[-1])
    assert all(one["reason"] and one["better"] for one in spans)


def test_reasons_name_what_decides() -> None:
    """Dry walls, walls that are not covered, and a straight law each have their own words."""
    reasons = " ".join(span.reason for span in explain_scene(strong()).models)
    assert "times as far" in reasons and "does not cover the wall" in reasons
    slow = explain_scene(load_scene("examples/vertical_rig.toml")).models[0]
    assert slow.model == "statics" and "at this spin" in slow.reason and "none" in slow.better
    lying = explain_scene(small_scene()).models[-1]
    assert lying.model == "linear" and lying.strain < 1.0
    assert (
        percent(0.0042) == "0.42 %" and percent(0.0) == "rounding" and percent(3.0) == "about 100 % or more"
    )


def test_run_up_takes_linear_layers_while_waves_are_small() -> None:
    """Small waves stay linear and agree with long waves as estimated; large ones are done again."""
    mild = {"rotor": {"unbalance": 2e-3}, "model": {"friction": {"linear": "30 1/s"}, "tolerance": 0.01}}
    tame = upright_scene(**mild)
    record = runup_scene(tame, cells=64)
    # By the model below the tolerance, by the steps of 64 cells about as much again.
    assert record.model == "linear" and record.model_error <= 2.0 * tame.model.tolerance
    assert "within the tolerance" in record.model_reason and record.model_reason in record.notes[0].text
    other = runup_scene(asked(tame, "long_wave"), cells=64, check=False)
    a, b = record.history.amplitude, other.history.amplitude
    assert np.abs(a - b).max() <= record.model_error * b.max()
    assert other.model == "long_wave" and "asks" in other.model_reason
    wild = runup_scene(asked(upright_scene(), "auto", 0.01), check=False)
    assert wild.model == "long_wave" and "with linear layers waves reach" in wild.model_reason
    strict = runup_scene(asked(tame, "auto", 1e-4), check=False)
    assert strict.model == "long_wave"


def test_what_rules_linear_layers_out() -> None:
    rough = upright_scene(model={"friction": {"quadratic": 0.01}})
    assert "quadratic" in runup_outlook(rough) and runup_outlook(rough).startswith("long waves")
    motor = load_scene("examples/weak_motor.toml")
    assert "motor" in runup_outlook(motor) and "motor" in explain_scene(motor).runup
    assert "linear layers first" in runup_outlook(asked(upright_scene(), "auto", 0.01))
    assert "not known" in runup_outlook(asked(upright_scene(), "auto", 1e-3))
    assert "as the scene asks" in runup_outlook(asked(upright_scene(), "linear"))
    assert "statics" in runup_outlook(asked(upright_scene(), "statics"))
    assert runup_outlook(small_scene()) == ""
