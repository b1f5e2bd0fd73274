"""Scenes with balls through `run` and `run_up`, and what refuses them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.studies.balls.answer import BallsAnswer, sentence
from leblanc.studies.balls.study import run_balls
from meshes.errors import InputError
from solvers.rotor.balls.swing import ball_swing
from tests.mutants import kills

ROOT = Path(__file__).resolve().parents[3]


def test_the_example_balances_above_its_critical_speed() -> None:
    result = lb.run(lb.example("balls").replace({"speeds.count": 15}))
    assert isinstance(result, BallsAnswer)
    assert result.state[0] == "together"
    assert result.state[-1] == "balanced"
    unbalance, held = 6e-4, result.capacity[0]
    angles = np.sort(np.abs(result.ball_angle[-1]))
    np.testing.assert_allclose(np.cos(angles), -unbalance / held, rtol=1e-9)
    assert result.amplitude[-1] == 0.0
    assert result.amplitude[0] > result.amplitude_without[0]
    # Between them the balls run.
    assert result.unstable.any()
    assert any(note.code == "runs_on" for note in result.notes)
    assert len(result.to_dataset().speed) == 15


@pytest.mark.parametrize("name", ["two_plane_rig", "tub"])
def test_races_fit_rotors_that_tilt(name: str) -> None:
    """Liquid and balls on a rotor with four and with six coordinates, at rest and on a run-up."""
    scene = lb.example(name)
    table = scene.table()
    table["assumed"] = []
    race = {"kind": "balls", "radius": 0.1, "count": 3, "mass": 0.01, "drag": 1.0}
    race["plane"] = scene.chambers[0].plane
    table["chambers"] = [*table["chambers"], race]
    table["runup"] = {"start": 5.0, "stop": 20.0, "rate": 10.0, "duration": 2.0, "cells": 16}
    both = lb.Scene(**table).replace({"speeds.count": 5})
    result = run_balls(both, edges=False)
    assert result.converged.all()
    run = lb.run_up(both, samples=40, check=False)
    assert run.converged
    assert run.ball_angle.shape == (run.time.size, 3)
    assert run.without == "without liquid and balls"
    assert run.energy.closure < 0.05
    # Feet, springs and bearings are reported as without balls.
    for told in (result.loads, run.loads):
        assert (told is None) == (name != "tub")
        if told is not None:
            assert np.isfinite(told.worst.walking).all()
            assert told.worst.bearing.shape[1] == 2


@kills("leblanc.studies.balls.study:_balanced_bands", "np.array([low, high])", "np.array([low, 0.9 * high])")
def test_the_speed_from_which_balls_balance_does_not_hang_on_the_speeds() -> None:
    """Its edge is solved: the balanced state grows next to it on one side and decays on the other."""
    found = [lb.run(lb.example("balls").replace({"speeds.count": n})).balanced_from for n in (7, 60)]
    assert found[0] == found[1]
    for share, stable in ((0.999, False), (1.001, True)):
        near = lb.example("balls").replace({"speeds.start": share * found[0], "speeds.count": 2})
        assert bool(run_balls(near, edges=False).balanced[0]) is stable


@kills("leblanc.studies.balls.study:_balanced_bands", "family.any()", "False")
def test_a_family_of_balanced_states_has_no_edge_of_one() -> None:
    """More balls than a balance needs stand in many ways, of unlike stability: the speeds asked for tell."""
    many = lb.example("balls_and_liquid").replace({"speeds.count": 2})
    found = run_balls(many, families=False)
    assert (found.family_dimension > 0).any() and found.balanced_bands is None
    assert found.balanced_from in found.speed


def test_balls_that_resist_leave_a_band() -> None:
    scene = lb.example("balls").replace({"chambers.0.rolling_resistance": 1e-3, "speeds.count": 3})
    result = lb.run(scene)
    assert isinstance(result, BallsAnswer)
    assert result.sticking == (1e-3 * 0.065,)
    assert any(note.code == "sticks" for note in result.notes)
    assert result.stuck is not None
    np.testing.assert_allclose(result.stuck.hold, 1e-3 * 0.065, rtol=1e-12)
    # Beyond the band at rest in which any deflection is left alone, and far from what the balls could do.
    at = result.stuck
    assert at.low[-1] < at.median[-1] < at.high[-1] and at.median[-1] > 0.5 * 1e-3 * 0.065
    assert result.amplitude[-1] == 0.0
    assert "balls that stick leave" in sentence(result)
    without = lb.run(scene.replace({"chambers.0.rolling_resistance": 0.0}))
    assert isinstance(without, BallsAnswer) and without.stuck is None and "stuck" not in without.to_json()
    # On a lying axis gravity, here 1.5 times what holds a ball at 3000 rpm, frees it in every turn.
    lying = lb.run(scene.replace({"rotor.axis": "horizontal"}))
    assert isinstance(lying, BallsAnswer) and lying.stuck is not None and not lying.stuck.sticks.any()
    assert lying.stuck.high[-1] < 1e-3 * lying.amplitude_without[-1]
    assert "balls that stick leave" not in sentence(lying)


@kills("leblanc.studies.balls.study:_apart", "_UNLIKE * k", "0.0 * k")
def test_balls_that_met_part_where_they_balance() -> None:
    """Slowly through the resonance: below it both come to the heavy side, and to one place to the last digit.

    Two alike would stay together for ever and leave a rotor that they can balance at U - 2 m R over its mass.
    """
    slow = {"runup.rate": "4 rad/s^2", "runup.duration": "160 s", "runup.cells": 16, "model.liquid": "linear"}
    run = lb.run_up(lb.example("balls").replace(slow), check=False, samples=100)
    early = run.ball_angle[run.speed < 80.0][-1]
    assert abs(early[1] - early[0]) < 0.01
    np.testing.assert_allclose(np.cos(run.ball_angle[-1]), -6e-4 / 9.23e-4, rtol=0.0, atol=0.02)
    # What is left is the drum's, which has stopped gaining speed: a hundredth of what balls together leave.
    assert run.amplitude[-1] < 0.01 * 9e-5


@kills("leblanc.studies.balls.study:_places", "race.start_angle + 2.0", "2.0")
def test_where_balls_begin_turns_with_the_unbalance() -> None:
    """Unbalances and balls turned by one angle in an upright drum are the same machine, balls alone not."""
    table = lb.example("two_plane_rig").table() | {"assumed": []}
    table["rotor"]["axis"] = "vertical"
    race = {"kind": "balls", "radius": 0.1, "count": 2, "mass": 0.01, "drag": 1.0, "plane": 0.2}
    table["chambers"] = [race]
    table["runup"] = {"start": 20.0, "stop": 90.0, "rate": 20.0, "duration": 4.0, "cells": 16}
    first = lb.Scene(**table)
    angles = {f"rotor.unbalances.{k}.angle": u.angle + 0.7 for k, u in enumerate(first.rotor.unbalances)}
    alone = {"chambers.0.start_angle": 0.7}
    runs = [lb.run_up(first.replace(how), samples=40, check=False) for how in ({}, angles | alone, alone)]
    size = runs[0].amplitude.max()
    np.testing.assert_allclose(runs[0].amplitude, runs[1].amplitude, rtol=0.0, atol=1e-9 * size)
    assert np.abs(runs[0].amplitude - runs[2].amplitude).max() > 0.01 * size


def test_models_of_liquid_are_not_compared_beside_balls(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", str(ROOT / "examples" / "balls_and_liquid.toml"), "--models", "statics"]) == 2
    said = capsys.readouterr().err.strip()
    assert "chambers.1.kind" in said
    assert len(said.splitlines()) == 1


def test_linear_layers_run_beside_balls() -> None:
    """At a small amplitude, with a layer that hardly lags, as long waves do; an ensemble takes the model."""
    changes = {"model": {"liquid": "linear", "friction": {"linear": 8.0}}, "rotor.unbalance": "0.05 kg*mm"}
    changes |= {f"chambers.{k}.{key}": f"{value} mg" for k, key, value in ((1, "mass", 170), (2, "mass", 80))}
    scene = lb.example("balls_and_liquid").replace({"runup.duration": "8 s", "runup.start": "30 rad/s"})
    table = scene.table() | {"assumed": []}
    for race in table["chambers"][1:]:
        race.pop("density")
        race.pop("liquid", None)
        race |= {"drag": 2e-3, "mass": 1e-4}
    scene = lb.Scene(**table).replace(changes)
    runs = [
        lb.run_up(
            scene.replace({"model.liquid": name}), samples=80, check=False, ensemble=2 * (name == "linear")
        )
        for name in ("linear", "long_wave")
    ]
    assert [each.model for each in runs] == ["linear", "long_wave"]
    size = runs[1].amplitude.max()
    np.testing.assert_allclose(runs[0].amplitude, runs[1].amplitude, rtol=0.0, atol=0.02 * size)
    assert runs[0].spread is not None
    assert runs[0].energy.closure < 2e-3


def lying(**changes: Any) -> lb.Scene:
    """A lying planar rotor with a layer and two balls that do not hold its unbalance."""
    table = lb.example("horizontal_rig").replace({"speeds.count": 7, "speeds.start": "400 rpm"}).table()
    race = {"kind": "balls", "radius": 0.05, "count": 2, "mass": 2e-3, "drag": 0.05}
    table["chambers"] = [*table["chambers"], race]
    return lb.Scene(**table).replace(changes)


def error_beside_held(model: str) -> None:
    """As `run` has it of a rotor whose mass and unbalance are those of rotor and balls together."""
    # So large that the surface touches the wall's end somewhere, which linear theory does not know.
    scene = lying(**{"model.liquid": model, "rotor.unbalance": "4 kg*mm", "speeds.start": "900 rpm"})
    result = run_balls(scene, edges=False)
    assert result.error_estimate is not None
    assert (np.nanmax(result.error_estimate[result.stable]) > 0.1) == (model == "linear")
    assert set(result.model) == {f"balls and {model}"}
    machine = scene.rotor.machine()
    for k in np.flatnonzero(result.stable)[[0, -1]].tolist():
        table, speed = scene.without_balls().table(), float(result.speed[k])
        total = machine.unbalance + 2e-3 * 0.05 * np.exp(1j * result.ball_angle[k]).sum()
        table["rotor"] |= {
            "mass": machine.mass + 4e-3,
            "unbalance": float(abs(total)),
            "stiffness": machine.stiffness,
        }
        table["rotor"] |= {"damping": machine.damping}
        for key in ("critical_speed", "damping_ratio"):
            table["rotor"].pop(key)
        table |= {"speeds": {"start": speed, "stop": speed, "count": 1}, "assumed": []}
        alone = lb.run(lb.Scene(**table))
        assert alone.error_estimate is not None
        assert result.error_estimate[k] == pytest.approx(alone.error_estimate[0], rel=1e-6)
        assert result.amplitude[k] == pytest.approx(alone.amplitude[0], rel=1e-6)


@kills("leblanc.studies.balls.study:liquid_errors", "law.worst if linear", "0.0 if linear")
@kills("leblanc.studies.balls.study:_errors", "np.full(count, across)", "np.full(count, 0.0)")
def test_the_error_is_that_of_the_rotor_with_its_balls_held() -> None:
    for model in ("statics", "linear"):
        error_beside_held(model)


def test_models_of_the_liquid_agree_where_the_surface_clears_the_wall() -> None:
    """With a small deflection linear theory is exact; with a large one a wall runs dry and it is not."""
    found = [run_balls(lying(**{"model.liquid": name}), edges=False) for name in ("statics", "linear")]
    np.testing.assert_allclose(found[0].amplitude, found[1].amplitude, rtol=1e-8)
    far = {"rotor.unbalance": "40 kg*mm", "speeds.start": "1500 rpm", "speeds.stop": "1600 rpm"}
    found = [run_balls(lying(**far, **{"model.liquid": name}), edges=False) for name in ("statics", "linear")]
    assert np.abs(found[0].amplitude / found[1].amplitude - 1.0).max() > 0.01
    with pytest.raises(InputError, match="auto, statics or linear"):
        lb.run(lying(**{"model.liquid": "long_wave"}))


def test_gravity_is_told_with_its_size() -> None:
    """On a lying drum: its share, swings as of a ball alone on a stiff rotor, what leaves the walls."""
    scene = lying()
    result = run_balls(scene, edges=False)
    assert result.gravity is not None
    assert result.in_range is not None
    np.testing.assert_allclose(result.gravity.share, 9.81 / (0.05 * result.speed**2))
    race = scene.balls[0].race()
    closed = ball_swing(result.speed, np.array(0.05), np.array(25.0), np.array(race.rolling), 9.81)
    np.testing.assert_allclose(result.gravity.ball_swing.max(axis=1)[-1], closed[-1], rtol=0.02)
    assert any(note.code == "lies" and "twice the spin" in note.text for note in result.notes)
    assert any(note.code == "liquid_waves" for note in result.notes)
    told = json.loads(json.dumps(result.to_json(), default=lambda value: value.tolist()))
    assert set(told["gravity"]) == {"share", "ball_swing", "amplitude", "power"}
    assert told["in_range"] == [True] * 7
    slow = run_balls(lying(**{"speeds.start": "60 rpm", "speeds.stop": "160 rpm"}), edges=False)
    assert slow.in_range is not None
    # Of the layer of the rig, whose surface is farther out than the balls, and of the balls.
    np.testing.assert_array_equal(slow.in_range, 0.05 * slow.speed**2 > 9.81)
    upright = lb.run(lb.example("balls_and_liquid").replace({"speeds.count": 3})).to_json()
    assert "gravity" not in upright
    assert "in_range" not in upright
    assert max(upright["error_estimate"]) < 1e-9


def test_json_is_what_the_result_carries() -> None:
    result = lb.run(lb.example("balls").replace({"speeds.count": 3}))
    told = json.loads(json.dumps(result.to_json(), default=lambda value: value.tolist()))
    assert [row[0]["state"] for row in told["states"]] == ["balanced"] * 3
    assert told["can_balance"] is True


def test_a_race_for_each_ball_does_as_one_race() -> None:
    """The balls of a plane balance together, whichever races they run in."""
    scene = lb.example("balls").replace({"speeds.count": 15})
    (race,) = scene.balls
    apart = scene.replace({"chambers": [race.model_dump(exclude_none=True) | {"count": 1}] * 2})
    one, two = lb.run(scene), lb.run(apart)
    assert isinstance(one, BallsAnswer) and isinstance(two, BallsAnswer)
    assert two.can_balance and two.balanced_from == pytest.approx(one.balanced_from, rel=1e-9)
    np.testing.assert_allclose(two.amplitude, one.amplitude, atol=1e-12)
    np.testing.assert_allclose(two.growth, one.growth, rtol=1e-7, atol=1e-9 * scene.speeds.stop)


# One ball heavier than the unbalance next to the resonance of 63 rad/s: nowhere is it drawn to rest.
NO_STATE = """
name = "no state"
rotor = {{ kind="jeffcott", mass = 10, stiffness = 4e4, damping = 100, unbalance = 5e-5, axis = "vertical" }}
chambers = [{{ kind = "balls", radius = 0.1, count = 1, mass = 0.05, drag = 0.1 }}]
speeds = {{ start = 80.0, stop = {stop}, count = {count} }}
"""


@pytest.mark.parametrize(("count", "stop"), [(1, 80.0), (3, 90.0)])
def test_commands_say_in_words_that_there_is_no_state(
    count: int, stop: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A rotor with a ball at none of whose speeds the ball can rest."""
    path = tmp_path / "none.toml"
    path.write_text(NO_STATE.format(count=count, stop=stop))
    result = lb.run(lb.load_scene(path))
    assert isinstance(result, BallsAnswer)
    assert not result.converged.any() and set(result.state) == {"none"}
    assert np.isnan(result.growth).all() and np.isnan(result.amplitude).all()
    for command in (["run"], ["explain"], ["view", "--screenshot", str(tmp_path / "none.png")]):
        arguments = [command[0], str(path), *command[1:]]
        arguments += ["--out", str(tmp_path / "out")] if command[0] == "run" else []
        assert main(arguments) == (3 if command[0] == "run" else 0)
        said = "".join(capsys.readouterr())
        assert "Traceback" not in said
        if command[0] == "run":
            assert "no state of balls at rest was found; without balls" in said
            assert "not found deg" not in said and "is reported there" not in said
        elif command[0] == "view":
            assert "no state found" in said and "of its size" not in said
