"""Scenes with exact waves: answered at once, held in time, or refused."""

from __future__ import annotations

import pytest

from leblanc.scene.examples import example
from leblanc.studies.run import run_scene
from leblanc.studies.runup import runup_scene
from meshes.errors import InputError


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
    assert any("exact waves held in time" in str(note) for note in found.notes)


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
