"""Scenes with fully nonlinear waves: answered at once, integrated in time, or refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from leblanc.liquid.choose import prepare
from leblanc.scene.examples import example
from leblanc.scene.scene import load_scene
from leblanc.studies.held.held import held_machine
from leblanc.studies.run.study import run_scene
from leblanc.studies.runup.study import runup_scene
from meshes.errors import InputError
from solvers.held import exact, family
from solvers.held.convergence import Watch
from solvers.held.integrate import start
from solvers.held.state import HoldNumerics
from solvers.layer.records import Outcome
from solvers.synchronous.response import response
from tests.exact_whirl.held import CASES, pair
from tests.exact_whirl.lagging import circles


def test_upright_it_is_answered_at_once() -> None:
    """By the circle of small waves, which is exact at any height while the wall is wet."""
    change = {"speeds.start": 12.0, "speeds.stop": 14.0, "speeds.count": 2, "model.liquid": "potential"}
    scene = example("runup").replace(change)
    found, exact = run_scene(scene), run_scene(scene.replace({"model.liquid": "linear"}))
    assert found.held is None
    assert found.amplitude == pytest.approx(exact.amplitude, rel=1e-12)


@pytest.mark.slow
def test_across_gravity_it_is_held() -> None:
    change = {"speeds.start": 160.0, "speeds.stop": 160.0, "speeds.count": 1, "model.cells": 32}
    scene = example("horizontal_rig").replace(change | {"model.liquid": "potential"})
    found = run_scene(scene)
    long = run_scene(scene.replace({"model.liquid": "long_wave", "model.cells": 64}))
    assert found.held is not None
    assert found.held.model == "potential"
    assert found.to_json()["held_solver"] == "dop853"
    assert found.to_json().keys() == long.to_json().keys()
    assert found.state.tolist() == ["periodic"]
    # Cells of the long waves, of second order, and the square of layers of 0.03 R.
    assert found.amplitude == pytest.approx(long.amplitude, rel=3e-3)
    assert any("fully nonlinear waves integrated in time" in str(note) for note in found.notes)


@pytest.mark.slow
def test_a_thick_layer_holds_a_limit_cycle() -> None:
    """With a smooth wave: the circle that Newton's method has for this speed, and its whirl speed."""
    scene = load_scene(Path("docs/examples/thick_layer.toml"))
    found = run_scene(scene)
    assert found.held is not None and found.state.tolist() == ["limit_cycle"]
    assert found.whirl is not None and found.whirl.bands
    natural, depth = 30.0, scene.fills[0].depth
    rows = circles(0.5, 0.05, 0.02, 0.03, [0.001, 0.002, 0.003, 0.0035, 0.004, 0.0045])
    speeds = [row.speed * natural for row in rows]
    spin = float(scene.speed_array()[0])
    # The whirl comes to rest to 1 % of its size in the turns that there are.
    whirl = float(np.interp(spin, speeds, [row.whirl for row in rows])) * depth
    assert found.amplitude[0] == pytest.approx(whirl, rel=0.03)
    turning = float(np.interp(spin, speeds, [row.whirl_speed for row in rows])) * natural
    assert found.held.whirl_speed[0] == pytest.approx(turning, rel=1e-4)


@pytest.mark.parametrize("liquid", ["potential", "kdv"])
@pytest.mark.parametrize("name", ["tub", "two_plane_rig"])
def test_tubs_and_two_planes_go_a_turn(name: str, liquid: str) -> None:
    """Of a synchronous motion: nothing is lost, and the axis is where it was, to what gravity ripples."""
    scene = example(name).replace({"model.liquid": liquid, "model.held": "always"})
    machine, spin = prepare(scene), 240.0
    held, numerics = held_machine(machine), HoldNumerics(cells=32, turns=16)
    steady = response(machine.rotor, scene.fills, np.array([spin]), machine.axial_gravity).coordinates[0]
    before = start(held, spin, numerics, steady)
    watch = Watch(held, before, numerics, 0.0)
    watch.count = 15
    steps = exact.march if liquid == "potential" else family.march
    after, outcome = steps(held, before, numerics, watch)
    assert outcome is Outcome.DONE
    np.testing.assert_allclose(after.area.mean(axis=1), before.area.mean(axis=1), rtol=1e-7)
    np.testing.assert_allclose(
        after.coordinates, before.coordinates, atol=0.05 * np.abs(before.coordinates).max()
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", ["tub", "washing_machine"])
def test_other_machines_are_held_beside_long_waves(name: str) -> None:
    """Cells of the long waves, of second order, and the square of layers of 0.02 R."""
    (case,) = [case for case in CASES if case[0] == name]
    found = pair(*case)
    assert found.exact.state == found.long.state == "periodic"
    assert abs(found.apart) < 2e-3


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"model.friction": {"quadratic": 0.01}}, "model.friction"),
        ({"model.cells": 33}, "model.cells"),
        ({"chambers.0.baffles": {"count": 4}}, "model.liquid"),
    ],
)
def test_what_it_does_not_know(change: dict[str, object], field: str) -> None:
    with pytest.raises(InputError) as fault:
        run_scene(example("horizontal_rig").replace({"model.liquid": "potential", **change}))
    assert fault.value.field == field


def test_no_run_up() -> None:
    scene = example("horizontal_rig").replace({"model.liquid": "potential"})
    with pytest.raises(InputError, match="long_wave or linear"):
        runup_scene(scene)
