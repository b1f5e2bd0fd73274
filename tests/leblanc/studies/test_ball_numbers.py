"""Scenes with balls through explain, sweep, fit, trade and compare."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.scene import Scene, dry_rotor
from leblanc.studies.balls.answer import BallsAnswer
from leblanc.studies.explain.balls.answer import BallExplainAnswer, facts
from leblanc.studies.fit.measured import Measurement
from leblanc.studies.fit.problem import answer as _answer
from leblanc.studies.fit.study import fit_scene
from leblanc.studies.sweep.batch import answer_scenes
from leblanc.studies.sweep.block import scene_maker
from leblanc.studies.sweep.outputs import kept_of
from meshes.errors import InputError
from solvers.rotor.balls.stability import balanced_stability
from tests.leblanc.studies.optimise.test_balls import two_planes
from tests.mutants import kills
from validation.trade.cases import questions

ROOT = Path(__file__).resolve().parents[3]
EXAMPLE = lb.example("balls")
FEW = EXAMPLE.replace({"speeds.count": 5})


def explained(scene: Scene) -> BallExplainAnswer:
    told = lb.explain(scene)
    assert isinstance(told, BallExplainAnswer)
    return told


@kills("leblanc.studies.explain.balls.study:_numbers", "inertia / race.drag", "race.each / race.drag")
@kills(
    "leblanc.studies.explain.balls.study:_balanced_from",
    "(low, middle) if stable",
    "(middle, high) if stable",
)
def test_the_example_in_numbers() -> None:
    """Sizes by hand; the edge of balancing by the roots of another code."""
    told = explained(FEW)
    (race,) = told.races
    mass = 7850.0 * math.pi / 6.0 * 0.012**3
    assert race.capacity == pytest.approx(2 * mass * 0.065, rel=1e-12)
    assert race.share == pytest.approx(6e-4, rel=1e-12)
    assert race.fade_time == pytest.approx(1.4 * mass / 0.1, rel=1e-12)  # a rolling ball, 7/5 of its mass
    assert race.drag * told.machine.critical_speed_dry * race.fade_time == pytest.approx(1.0, rel=1e-12)
    assert race.crowding == pytest.approx(2 * math.asin(0.006 / 0.065) / math.pi, rel=1e-12)
    assert told.can_balance
    system, races = dry_rotor(EXAMPLE).system(), [EXAMPLE.balls[0].race()]
    edge = told.balanced_from
    below, above = (balanced_stability(system, races, factor * edge).growth for factor in (0.999, 1.001))
    assert below > 0.0 > above
    assert any("on the way up" in text for text in told.lacking)


def test_shares_in_two_planes_are_those_of_statics() -> None:
    """Sum and moment of the unbalances; conditions and roots stand beside."""
    told = explained(two_planes())
    sizes, places = np.array([3e-4, 5e-4 * np.exp(1j)]), np.array([-0.1, 0.1])
    sums = np.array([sizes.sum(), (sizes * places).sum()])
    shares = np.abs(np.linalg.solve([[1.0, 1.0], [-0.12, 0.12]], sums))
    np.testing.assert_allclose([race.share for race in told.races], shares, rtol=1e-9)
    assert told.balancing is not None
    assert told.balancing.growth is not None
    # With damped supports the balls balance from about the conditions on.
    assert told.balanced_from == pytest.approx(told.balancing.above, rel=0.05)
    assert any("two planes" in label for label, _ in facts(told))


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"chambers.0.diameter": "6 mm"}, "hold less than their share"),
        ({"chambers.0.count": 1}, "a single ball holds one size"),
    ],
)
def test_why_balls_cannot_balance(changes: dict[str, object], why: str) -> None:
    changes = changes | ({"chambers.0.diameter": "16 mm"} if "chambers.0.count" in changes else {})
    told = explained(EXAMPLE.replace(changes))
    assert not told.can_balance
    assert why in told.reason
    assert math.isnan(told.balanced_from)
    assert json.loads(json.dumps(told.to_json(), default=list))["balanced_from"] is None


def test_unbalance_in_other_planes_is_told() -> None:
    scene = two_planes()
    one = scene.altered(chambers=scene.chambers[:1])
    told = explained(one)
    assert "in other planes than the races" in told.reason
    assert told.single_plane is not None
    assert math.isnan(told.races[0].share)


def test_with_liquid_both_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (ROOT / "examples" / "balls_and_liquid.toml").read_text(encoding="utf-8")
    text = text.replace('start = "4 rad/s"', 'start = "60 rad/s"').replace("count = 87", "count = 2")
    path = str(tmp_path / "both.toml")
    Path(path).write_text(text, encoding="utf-8")
    assert main(["explain", path]) == 0
    said = capsys.readouterr().out
    assert "chamber 1" in said
    assert "race 2" in said
    assert "long waves: linear layers are not known" in said
    assert main(["explain", path, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert len(told["races"]) == 2
    assert told["layers"][0]["depth"] > 0.0
    drawn = explained(FEW)
    assert "Growth of small motions" in drawn.plot().alt
    assert drawn.to_dataset()["race_count"].values.tolist() == [2]


def test_a_sweep_keeps_what_run_tells() -> None:
    """Outputs of a sample are those of `run` of its scene; count and drag vary."""
    table = FEW.table()
    make = scene_maker(table, [("chambers", 0, "count"), ("chambers", 0, "drag")])
    scenes = [make(values) for values in ((1, 0.1), (3, 0.4))]
    kept = answer_scenes(scenes)
    assert {name for name, value in vars(kept).items() if value is not None} <= set(
        kept_of(scenes[0]).outputs
    )
    for k, scene in enumerate(scenes):
        result = lb.run(scene)
        assert isinstance(result, BallsAnswer)
        np.testing.assert_array_equal(kept.amplitude[k], result.amplitude)
        np.testing.assert_array_equal(kept.growth[k], result.growth)
        assert kept.state[k].tolist() == result.state.tolist()
        assert kept.balanced[k].tolist() == result.balanced.tolist()
        np.testing.assert_equal(kept.balanced_from[k], result.balanced_from)
        assert kept.peak_amplitude[k] == np.nanmax(result.amplitude)
    assert not {"state", "balanced_from"} & set(kept_of(lb.example("horizontal_rig")).outputs)


def test_a_sweep_of_balls_from_its_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Whole numbers of balls as choices; what does not fit has its reason."""
    text = (ROOT / "examples" / "balls.toml").read_text(encoding="utf-8").replace("count = 141", "count = 4")
    (tmp_path / "balls.toml").write_text(text, encoding="utf-8")
    study = tmp_path / "study.toml"
    vary = '[vary]\n"chambers.0.count" = { choice = [2, 60] }\n'
    vary += '"chambers.0.drag" = { choice = [0.1, "1 N*s/m"] }\n'
    study.write_text(f'scene = "balls.toml"\nmethod = "grid"\n{vary}', encoding="utf-8")
    assert main(["sweep", str(study), "--workers", "0", "--json", "--out", str(tmp_path / "o")]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["done"], told["failed"]) == (2, 2)
    assert "60 balls fit in the race" in told["reasons"][0]["reason"]
    assert told["outputs"]["balanced_from"]["samples"] == 2
    # The same command again finds all there.
    assert main(["sweep", str(study), "--workers", "0", "--json", "--out", str(tmp_path / "o")]) == 0
    assert json.loads(capsys.readouterr().out)["outputs"] == told["outputs"]


def settling() -> Scene:
    """Balls of the example that come to balance at a speed above the critical one."""
    race = {"kind": "balls", "radius": 0.065, "count": 2, "mass": 0.0071, "drag": 0.1}
    plan = {"start": 180.0, "stop": 200.0, "rate": 40.0, "duration": 2.5, "samples": 400}
    return EXAMPLE.replace({"chambers.0": race, "runup": plan})


@pytest.mark.slow
def test_values_of_balls_come_back_from_a_measured_run() -> None:
    """Drag, mass and unbalance from an amplitude with noise: within four of their stated errors."""
    truth, at = np.array([0.1, 0.0071, 6e-4]), np.linspace(0.1, 2.4, 120)
    (amplitude,) = _answer(settling(), "time", at, ["amplitude"])
    random = np.random.default_rng(3)
    noise = 0.02 * np.sqrt(np.mean(amplitude**2)) * random.standard_normal(at.size)
    table = Measurement("time", at, (("amplitude", amplitude + noise),))
    unknown = ("chambers.0.drag", "chambers.0.mass", "rotor.unbalance")
    guess = settling().replace(dict(zip(unknown, (0.13, 0.008, 5.5e-4), strict=True)))
    found = fit_scene(guess, table, unknown, starts=1)
    assert found.converged
    assert np.all(np.abs(found.value - truth) < 4.0 * found.std)
    assert np.all(found.std < 0.05 * truth)
    assert found.residual_rms == pytest.approx(0.02, rel=0.3)


def test_a_fit_of_balls_takes_time() -> None:
    table = Measurement("speed", np.array([100.0, 200.0, 300.0]), (("amplitude", np.full(3, 1e-4)),))
    with pytest.raises(InputError, match="it takes a run-up over time"):
        fit_scene(EXAMPLE, table, ("chambers.0.drag",))


def test_trade_takes_the_steps_of_a_run_up() -> None:
    """One question, the passage in time; the ladder goes by cells, which set the steps."""
    (question,) = questions(EXAMPLE, quick=True)
    assert question.name == "runup"
    assert {case.model for case in question.cases} == {"auto", "long_wave"}
    assert question.scene.balls == EXAMPLE.balls
    with pytest.raises(InputError, match="runup"):
        questions(lb.load_scene(ROOT / "examples" / "balls_design.toml"), quick=True)


def test_compare_says_why_not(capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        main(["compare", str(ROOT / "examples" / "balls_and_liquid.toml"), "--models", "statics,linear"]) == 2
    )
    said = capsys.readouterr().err.strip()
    assert "balls have one model" in said
    assert len(said.splitlines()) == 1
