"""Feet, bearings, points and the motor of machines with balls: welded ones, none, balanced ones, weights."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.liquid.choose import across_gravity
from leblanc.studies.balls.answer import BallsAnswer
from leblanc.studies.drives import drive_of, numerics_of, planned
from leblanc.studies.loads.study import loaded_machine
from leblanc.studies.runup.study import chosen_run
from tests.mutants import kills

FEET = [[-0.3, 0.15, 0.2], [-0.3, -0.15, 0.2], [-0.3, -0.15, -0.2], [-0.3, 0.15, -0.2]]
CABINET = {"mass": 10.0, "feet": FEET, "friction": 0.5}
POINTS = [
    {"name": "rim", "on": "drum", "position": [0.07, 0.0, 0.0], "gap": "2 mm"},
    {"name": "shaft", "position": [0.0, 0.0, 0.1]},
]
RACE: dict[str, Any] = {"kind": "balls", "radius": 0.1, "count": 3, "mass": 0.05, "drag": 1.0}
# Over these keys the loads of a scene are compared.
KEYS = ("floor_force", "floor_force_least", "walking_margin", "lift_off_margin", "slip_margin")
NAMED = ("displacement", "mount_force", "bearing_force", "clearance")


def rig(race: dict[str, Any] | None = None, **changes: Any) -> lb.Scene:
    """A lying planar rotor on feet, with balls and without liquid."""
    table = lb.example("horizontal_rig").replace({"speeds.count": 9}).table()
    table |= {"cabinet": CABINET, "points": POINTS, "assumed": []}
    table["chambers"] = [RACE | {"radius": 0.065, "mass": 0.02} | (race or {})]
    return lb.Scene(**table).replace(changes)


@cache
def tub(**changes: Any) -> lb.Scene:
    """The tub with a race in the plane of its drum's centre of mass, and without liquid."""
    table = lb.example("tub").replace({"speeds.count": 5}).table()
    table |= {"assumed": []}
    table["chambers"] = [RACE | {"radius": 0.2, "mass": 0.15, "plane": 0.09, "drag": 3.0} | changes]
    return lb.Scene(**table)


def welded(scene: lb.Scene, result: BallsAnswer, k: int) -> lb.Scene:
    """The same machine at its k-th speed with the balls as a part of its rotor."""
    ball = scene.balls[0].each
    moment = ball * scene.balls[0].radius
    speed = float(result.speed[k])
    table = scene.without_balls().table()
    rotor = table["rotor"]
    table["speeds"] = {"start": speed, "stop": speed, "count": 1}
    mass = "drum_mass" if scene.rotor.kind == "tub" else "mass"
    rotor[mass] += ball * result.ball_angle.shape[1]
    if scene.rotor.kind == "tub":
        unbalance = rotor.pop("unbalance")
        plane = scene.balls[0].plane
        rotor["loads"] = [{"position": plane, "size": unbalance}] + [
            {"position": plane, "size": moment, "angle": float(angle)} for angle in result.ball_angle[k]
        ]
    else:
        total = scene.rotor.unbalance + moment * np.exp(1j * result.ball_angle[k]).sum()
        machine = scene.rotor.machine()
        rotor |= {"unbalance": float(abs(total)), "stiffness": machine.stiffness, "damping": machine.damping}
        for key in ("critical_speed", "damping_ratio"):
            rotor.pop(key, None)
        # A planar rotor has a chamber: this one is as good as empty.
        table["chambers"] = [{"radius": 0.01, "height": 0.001, "volume": 0.0, "liquid": "water"}]
    return lb.Scene(**table)


def compare(found: dict[str, Any], at: int, other: dict[str, Any], tolerance: float) -> None:
    """Loads at one speed against those of another scene of one speed."""
    for key in KEYS:
        np.testing.assert_allclose(found[key][at], other[key][0], rtol=tolerance, err_msg=key)
    np.testing.assert_allclose(found["floor_force_rest"], other["floor_force_rest"], rtol=1e-12)
    for key in NAMED:
        assert found[key].keys() == other[key].keys()
        for name, values in found[key].items():
            np.testing.assert_allclose(values[at], other[key][name][0], rtol=tolerance, err_msg=name)


@kills("solvers.rotor.loads.frame:weights_of", "*liquid, *rolling)\n    return", "*liquid)\n    return")
@kills("solvers.rotor.loads.frame:weights_of", "sum(race.masses)", "race.masses[0]")
def test_balls_at_rest_are_a_part_of_the_tub() -> None:
    """Welded where they rest they are laundry: feet, springs, bearings and points carry the same."""
    scene = tub()
    result = lb.run(scene)
    assert isinstance(result, BallsAnswer)
    assert result.stable.all()
    found = result.to_json()
    for k in (0, 2, 4):
        # What balls resist along the axis, where they are 1 % of the mass, is left out of the motion.
        compare(found, k, lb.run(welded(scene, result, k)).to_json(), 2e-3)


def test_balls_at_rest_are_a_part_of_the_planar_rotor() -> None:
    scene = rig({"mass": 1e-3})  # too light to balance: some unbalance is left at every speed
    result = lb.run(scene)
    assert isinstance(result, BallsAnswer)
    found = result.to_json()
    stable = np.flatnonzero(result.stable)
    assert stable.size > 3
    for k in stable[[0, -1]].tolist():
        # The zero of the turn differs, and 180 angles miss 1.6e-4 of an amplitude.
        compare(found, k, lb.run(welded(scene, result, k)).to_json(), 2e-4)


def test_balanced_rotor_leaves_its_feet_in_peace() -> None:
    """Nothing with the spin is left: weights alone, the margin is whole, the motor rests."""
    result = lb.run(rig())
    assert isinstance(result, BallsAnswer)
    assert result.loads is not None
    balanced = (result.state == "balanced") & result.stable
    assert balanced.any()
    worst, rest = result.loads.worst, result.loads.rest
    assert rest.sum() == pytest.approx(9.81 * (10.0 + 4.0 + 10.0 + 0.06) - 98.1, rel=1e-12)
    np.testing.assert_allclose(worst.floor_force[balanced], np.tile(rest, (balanced.sum(), 1)), rtol=1e-12)
    np.testing.assert_allclose(worst.walking[balanced], 1.0, rtol=1e-12)
    # The rotor lies: its balls swing once a turn, and their drag is all that the motor replaces.
    assert result.gravity is not None
    power = (result.loads.torque * result.speed)[balanced]
    np.testing.assert_allclose(power, result.gravity.power[balanced], rtol=1e-9)
    assert np.all(power > 0.0)
    upright = rig(**{"cabinet": None, "rotor.axis": "vertical"})
    still = lb.run(upright)
    assert isinstance(still, BallsAnswer)
    assert still.loads is not None
    np.testing.assert_allclose(still.loads.torque[balanced], 0.0, atol=1e-15)
    np.testing.assert_allclose(worst.clearance[balanced, 0], 2e-3, rtol=1e-12)


def test_where_no_state_is_stable_nothing_is_told() -> None:
    result = lb.run(rig())
    assert isinstance(result, BallsAnswer)
    assert result.loads is not None
    assert result.unstable.any()
    assert np.isnan(result.loads.worst.walking[result.unstable]).all()
    told = result.to_json()["walking_margin"]
    assert [value is None for value in told] == result.unstable.tolist()
    assert any(note.code == "loads_of_states" for note in result.notes)


def test_balls_without_mass_leave_the_loads_as_they_are() -> None:
    """Over speed and over time, beside liquid."""
    bare = lb.example("tub").replace(
        # The throw in which the ring forms, after 1.6 s, is chaotic: it tells machines 1e-9 apart.
        {"speeds.count": 4, "model": {"liquid": "statics"}, "runup.duration": "1.5 s", "runup.cells": 16}
    )
    table = bare.table()
    race = RACE | {"radius": 0.2, "mass": 1e-9, "drag": 1e-8, "plane": 0.09}
    table["chambers"] = [*table["chambers"], race]
    scene = lb.Scene(**table)
    found, other = lb.run(scene).to_json(), lb.run(bare).to_json()
    for key in (*KEYS, "motor_torque"):
        np.testing.assert_allclose(found[key], other[key], rtol=1e-6, err_msg=key)
    for key in NAMED:
        for name, values in other[key].items():
            np.testing.assert_allclose(found[key][name], values, rtol=1e-6, err_msg=name)
    free = bare.replace({"model": {"liquid": "long_wave"}})
    runs = [lb.run_up(each, samples=50, check=False).to_json() for each in (scene_with_waves(scene), free)]
    for key in ("floor_force", "walking_margin_over_time", "motor_torque"):
        size = np.abs(np.array(runs[1][key], dtype=float)).max()
        np.testing.assert_allclose(runs[0][key], runs[1][key], atol=1e-6 * size, err_msg=key)


def scene_with_waves(scene: lb.Scene) -> lb.Scene:
    """The same with long waves, as run-ups take them beside balls."""
    return scene.replace({"model": {"liquid": "long_wave"}})


@kills("leblanc.studies.loads.study:loaded_machine", "tuple(race.race() for race in scene.balls)", "()")
def test_the_mean_force_on_the_floor_is_the_weight() -> None:
    """Balls that hang behind the drum at the bottom press with their weight, though they go round with none.

    Momentum does not grow over whole turns: the mean of the forces of all feet is the weight of all masses.
    """
    change = {"start": "bottom", "count": 2, "mass": 0.3, "drag": 0.05}
    table = rig(change).table()
    table["runup"] = {"start": 29.0, "stop": 30.0, "rate": 1.0, "duration": 8.0, "cells": 128}
    table["rotor"]["unbalance"] = 1e-6
    scene = lb.Scene(**table)
    machine = loaded_machine(scene)
    assert machine is not None
    weight = float(machine.resting.vertical.sum())
    assert weight == pytest.approx(9.81 * (10.0 + scene.rotor.mass + 0.6), rel=1e-12)
    plan = planned(scene)
    numerics = numerics_of(plan, None, 400, False)
    run = chosen_run(scene, drive_of(plan, scene.rotor), across_gravity(scene), numerics, follow=True).history
    assert run.path is not None
    # The balls lag far behind: they lie at the bottom, pulled up a little by the drag.
    assert np.all(np.abs(run.ball_speed[-1]) < 1.0)
    _, place, rate, _ = run.path.motion(np.linspace(6.0, 6.0 + 8 * 2.0 * np.pi / 30.0, 4001))
    force, _ = machine.on_cabinet(place, rate)
    # Upwards is the first direction.
    assert weight - force[:, 0].mean() == pytest.approx(weight, abs=1e-3 * 9.81 * 0.6)


def test_the_motor_speeds_the_balls_up() -> None:
    """Balls held by a great drag take m R^2 of each times the rate, beside what the same rotor takes."""
    change = {"drag": 1e6, "motion": "sliding"}
    drive = {"start": 100.0, "stop": 200.0, "rate": 50.0, "duration": 2.0, "cells": 64}
    table = rig(change).table() | {"runup": drive}
    table["rotor"]["axis"] = "vertical"
    table.pop("cabinet")
    found = lb.run_up(lb.Scene(**table), samples=100, check=False).to_json()
    machine = lb.Scene(**table).rotor.machine()
    heavy = table["rotor"] | {
        "mass": machine.mass + 0.06, "stiffness": machine.stiffness, "damping": machine.damping,
    }  # fmt: skip
    for key in ("critical_speed", "damping_ratio"):
        heavy.pop(key, None)
    alone = table | {"rotor": heavy}
    alone["chambers"] = [{"radius": 0.01, "height": 0.001, "volume": 0.0, "liquid": "water"}]
    alone["model"] = {"liquid": "long_wave"}
    bare = lb.run_up(lb.Scene(**alone), samples=100, check=False).to_json()
    more = np.array(found["motor_torque"]) - np.array(bare["motor_torque"])
    expected = 3 * 0.02 * 0.065**2 * 50.0
    # Balls spread evenly round the race have no unbalance; the steps leave 1e-3 of one.
    np.testing.assert_allclose(more[10:], expected, rtol=0.02)


def test_bearing_cages_are_told_beside_balls() -> None:
    scene = tub()
    found, bare = lb.run(scene).cage_speed, lb.run(lb.example("tub").replace({"speeds.count": 5})).cage_speed
    assert found == bare
