"""Scenes with balls through `run` and `run_up`, and what refuses them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.results.motion.ball_states import BallsResult
from meshes.errors import InputError

ROOT = Path(__file__).resolve().parents[3]


def test_the_example_balances_above_its_critical_speed() -> None:
    result = lb.run(lb.example("balls").replace({"speeds.count": 15}))
    assert isinstance(result, BallsResult)
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
    for key in ("cabinet", "points"):
        table.pop(key, None)
    table["rotor"] = {key: value for key, value in table["rotor"].items() if key != "bearings"}
    table["assumed"] = []
    race = {"kind": "balls", "radius": 0.1, "count": 3, "mass": 0.01, "drag": 1.0}
    race["plane"] = scene.chambers[0].plane
    table["chambers"] = [*table["chambers"], race]
    table["runup"] = {"start": 5.0, "stop": 20.0, "rate": 10.0, "duration": 2.0, "cells": 16}
    both = lb.Scene(**table).replace({"speeds.count": 5})
    result = lb.run(both)
    assert isinstance(result, BallsResult)
    assert result.converged.all()
    run = lb.run_up(both, samples=40, check=False)
    assert run.converged
    assert run.ball_angle.shape == (run.time.size, 3)
    assert run.without == "without liquid and balls"
    assert run.energy.closure < 0.05


def test_balls_that_resist_leave_a_band() -> None:
    scene = lb.example("balls").replace({"chambers.0.rolling_resistance": 1e-3, "speeds.count": 3})
    result = lb.run(scene)
    assert isinstance(result, BallsResult)
    assert result.sticking == (1e-3 * 0.065,)
    assert any(note.code == "sticks" for note in result.notes)


@pytest.mark.parametrize("command", ["map", "view"])
def test_other_commands_refuse_balls_in_one_line(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, str(ROOT / "examples" / "balls_and_liquid.toml")]) == 2
    said = capsys.readouterr().err.strip()
    assert "chambers.1.kind" in said
    assert len(said.splitlines()) == 1


def test_a_linear_layer_does_not_run_beside_balls() -> None:
    scene = lb.example("balls_and_liquid").replace({"model": {"liquid": "linear"}})
    with pytest.raises(InputError, match="where balls run beside"):
        lb.run_up(scene)
    with pytest.raises(InputError, match="beside balls"):
        lb.run(scene)


def test_json_is_what_the_result_carries() -> None:
    result = lb.run(lb.example("balls").replace({"speeds.count": 3}))
    told = json.loads(json.dumps(result.to_json(), default=lambda value: value.tolist()))
    assert [row[0]["state"] for row in told["states"]] == ["balanced"] * 3
    assert told["can_balance"] is True
