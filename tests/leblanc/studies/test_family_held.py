"""Scenes with KdV-Burgers: held where a whirl grows or no steady model serves, within range, or refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from leblanc.liquid.choose import choose_all, held_at, prepare
from leblanc.scene.examples import example
from leblanc.scene.scene import load_scene
from leblanc.studies.held.held import _family_left
from leblanc.studies.run.study import _endless, run_scene
from meshes.errors import InputError
from solvers.liquid_model import ROUNDING
from solvers.synchronous.response import response
from tests.mutants import kills

KDV = {"model.liquid": "kdv", "model.held": "auto"}
WHIRLS = load_scene(Path("docs/examples/self_excited.toml"))


def at(*speeds: float) -> dict[str, object]:
    return {"speeds.start": speeds[0], "speeds.stop": speeds[-1], "speeds.count": len(speeds)}


@pytest.mark.slow
@kills("leblanc.studies.held.held:held_response", '== "kdv_held"', '== "kdv"')
def test_a_band_of_whirl_is_held_and_the_rest_is_steady() -> None:
    """Just above the lower edge, where the whirl is small: in range, and as large as that of long waves."""
    scene = WHIRLS.replace(KDV | at(105.0, 115.0) | {"model.cells": 32})
    found = run_scene(scene)
    assert found.held is not None
    assert found.response.model.tolist() == ["kdv", "kdv_held"]
    assert found.state.tolist()[1] == "limit_cycle"
    assert found.response.in_range.tolist() == [False, True]
    # Long waves on 64 cells have 0.2964 of the depth; of a limit cycle no error is known.
    assert found.amplitude[1] / scene.fills[0].depth == pytest.approx(0.2964, rel=0.06)
    assert np.isnan(found.error_estimate[1])
    json = found.to_json()
    assert json["held_solver"] == "lawson"
    assert any("KdV-Burgers integrated in time at 1 of 2 speeds" in str(note) for note in found.notes)
    # Their energy is not known.
    assert np.isnan(found.held.energy_error).all()


@kills("leblanc.studies.held.held:_family_left", "np.where(cycles", "np.where(~cycles")
def test_the_error_is_the_distance_from_the_equilibrium_and_none_of_a_cycle() -> None:
    scene = WHIRLS.replace(KDV | at(150.0, 160.0) | {"rotor.unbalance": "1 kg*mm"})
    machine = prepare(scene)
    found = response(machine.rotor, scene.fills, machine.speed, 0.0)
    left = _family_left(machine, found, np.array([False, True]))
    # The same answer again, to what another order of sums leaves, which is put on top.
    assert left[0] <= 2.0 * ROUNDING
    assert np.isnan(left[1])
    off = replace(found, deflection=1.1 * found.deflection)
    assert _family_left(machine, off, np.array([False, False])) == pytest.approx(0.1, rel=0.1)


def test_where_it_is_held() -> None:
    growth = np.array([-1.0, 1.0])
    for held, wanted in (("never", [False, False]), ("auto", [False, True]), ("always", [True, True])):
        scene = WHIRLS.replace(KDV | at(105.0, 115.0) | {"model.held": held})
        (choice,) = choose_all([prepare(scene)])
        assert held_at(scene, choice, growth).tolist() == wanted


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"model.cells": 33}, "model.cells"),
        ({"model.friction": {"quadratic": 0.01}}, "model.friction"),
        ({"chambers.0.baffles": {"count": 4, "tip_radius": "97 mm"}}, "model.held"),
    ],
)
def test_what_it_refuses(changes: dict[str, object], field: str) -> None:
    with pytest.raises(InputError) as refused:
        run_scene(WHIRLS.replace(KDV | at(105.0, 115.0) | changes))
    assert refused.value.field == field


@kills("leblanc.studies.run.study:_endless", "& ~answer.converged", "& answer.converged")
def test_a_motion_that_ran_away_says_nothing_of_the_resonance() -> None:
    """No bound is a matter of an answer: not of a motion held in time that has not converged."""
    scene = example("runup")
    found = prepare(scene)
    answer = response(found.rotor, scene.fills, np.array([20.0]), 0.0)
    endless = replace(answer, deflection=np.array([complex(np.inf, 0.0)]), converged=np.array([False]))
    note = _endless(replace(endless, model=np.array(["linear"])))
    assert note is not None and note.data["speed"] == 20.0
    assert _endless(replace(endless, model=np.array(["kdv_held"]))) is None
