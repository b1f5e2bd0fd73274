"""Laundry along a drum: loads together are their sum, and what leaves of each is reported."""

from __future__ import annotations

import math

import numpy as np
import pytest

import leblanc as lb
from leblanc.scene.inputs import input_rows
from leblanc.scene.rotors import TubRotor
from leblanc.scene.scene import Scene, dry_rotor, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.scene.unbalances import sheds_of, unbalances_of, with_unbalances
from leblanc.studies.drives import rotor_in_time
from leblanc.studies.run.notes import RunCode
from leblanc.studies.runup.notes import RunupCode
from tests.mutants import kills

SHEDS = {"share": 0.3, "time_constant": "0.5 s", "above": "20 rad/s"}


def tub(*loads: dict[str, object], unbalance: object = None) -> Scene:
    table = lb.example("tub").table()
    rotor = table["rotor"]
    for key in ("unbalance", "unbalance_position"):
        rotor.pop(key, None)
    if loads:
        rotor["loads"] = list(loads)
    if unbalance is not None:
        rotor["unbalance"] = unbalance
    return scene_from_table(table | {"assumed": []})


def push(scene: Scene) -> np.ndarray:
    return dry_rotor(scene).system().unbalance


@kills("solvers.rotor.tub:Tub._system", "cmath.exp(1j * load.angle)", "cmath.exp(-1j * load.angle)")
@kills("solvers.rotor.tub:Tub._system", "centre + load.position * lean", "centre - load.position * lean")
def test_loads_add_up() -> None:
    """One load is the unbalance at its place; two alike are twice it; opposite ones leave a couple.

    The angle is positive with the spin: a quarter of a turn is a factor of i.
    """
    load = {"position": 0.06, "size": 0.05}
    single, base = tub(load), lb.example("tub").replace({"rotor.unbalance": 0.05})
    alone = base.replace({"rotor.unbalance_position": 0.06})
    np.testing.assert_allclose(push(single), push(alone), rtol=1e-14)
    np.testing.assert_allclose(push(tub(load, load)), 2.0 * push(alone), rtol=1e-14)
    np.testing.assert_allclose(push(tub(load, unbalance=0.02)), push(alone) + 0.4 * push(
        base.replace({"rotor.unbalance_position": base.rotor.drum_position[1]})  # type: ignore[union-attr]
    ), rtol=1e-12, atol=1e-15)  # fmt: skip
    turned = tub(load | {"angle": "90 deg"})
    np.testing.assert_allclose(push(turned), 1j * push(alone), rtol=1e-13, atol=1e-17)
    couple = push(tub(load, load | {"position": -0.06, "angle": math.pi}))
    assert np.abs(couple[[0, 2]]).max() < 1e-16 and np.abs(couple[3:]).max() == pytest.approx(0.006)


@kills("leblanc.scene.unbalances:with_unbalances", "sizes[first:]", "sizes[:len(rotor.loads)]")
def test_sizes_in_their_order() -> None:
    loads = {"position": 0.06, "size": 0.05}, {"position": -0.1, "size": 0.03, "sheds": SHEDS}
    both, bare = tub(*loads, unbalance=0.02).rotor, tub(*loads).rotor
    assert unbalances_of(both) == (0.02, 0.05, 0.03) and unbalances_of(bare) == (0.05, 0.03)
    assert unbalances_of(with_unbalances(both, (1.0, 2.0, 3.0))) == (1.0, 2.0, 3.0)
    assert unbalances_of(with_unbalances(bare, (2.0, 3.0))) == (2.0, 3.0)
    assert [sheds is not None for sheds in sheds_of(both)] == [False, False, True]
    assert isinstance(both, TubRotor) and both.loads[1].sheds is not None


@kills("leblanc.studies.drives:rotor_in_time", "sheds.share * size * (j == k)", "sheds.share * size")
def test_what_leaves_has_its_place() -> None:
    """The share of one load, where that lies."""
    loads = {"position": 0.06, "size": 0.05}, {"position": -0.1, "size": 0.03, "angle": 1.0, "sheds": SHEDS}
    (shed,) = rotor_in_time(tub(*loads)).sheds
    np.testing.assert_allclose(shed.unbalance, 0.3 * push(tub(loads[1])), rtol=1e-13, atol=1e-18)
    assert (shed.time_constant, shed.above) == (0.5, 20.0)
    assert rotor_in_time(tub(loads[0])).sheds == ()


def test_a_tub_has_an_unbalance() -> None:
    with pytest.raises(SceneError) as caught:
        tub()
    (fault,) = caught.value.faults
    assert fault.field == "rotor.unbalance" and "[[rotor.loads]]" in fault.allowed
    with pytest.raises(SceneError, match=r"rotor.loads.0.sheds.share"):
        tub({"position": 0, "size": 1, "sheds": SHEDS | {"share": 1.5}})


def test_digests_and_rows() -> None:
    """A scene without loads keeps the digest it had; loads and what leaves are part of it."""
    load = {"position": 0.06, "size": 0.05}
    digests = {tub(load).digest, tub(load | {"sheds": SHEDS}).digest, tub(load, load).digest}
    assert (
        len(digests) == 3
        and tub(load | {"sheds": SHEDS}).table()["rotor"]["loads"][0]["sheds"]["share"] == 0.3
    )
    rows = {path: text for _, text, path in input_rows(tub(load | {"sheds": SHEDS}), ("rotor",))}
    assert rows["rotor.loads.0.sheds"] == "30 % in 0.5 s above 191 rpm" and "rotor.unbalance" not in rows


def test_a_run_up_tells_what_is_left() -> None:
    """0.3 of the unbalance leaves in half a second, while the drum is fast: e^(-t/T) of it stays."""
    scene = lb.example("runup").replace(
        {"runup.duration": "3 s", "runup.cells": 16, "runup.start": "25 rad/s"}
    )
    scene = scene.replace({"rotor.sheds": SHEDS})
    found = lb.run_up(scene, samples=60, check=False)
    wanted = 0.7 + 0.3 * np.exp(-found.time / 0.5)
    np.testing.assert_allclose(found.unbalance_left, wanted, rtol=1e-12)
    np.testing.assert_array_equal(found.to_json()["unbalance_left"], found.unbalance_left)
    assert RunupCode.UNBALANCE_LEFT in {note.code for note in found.notes}
    assert "unbalance_left" in found.to_dataset()
    steady = lb.run(scene.replace({"speeds.count": 3}))
    plain = lb.run(lb.example("runup").replace({"speeds.count": 3}))
    assert RunCode.UNBALANCE_LEAVES in {note.code for note in steady.notes}
    np.testing.assert_array_equal(steady.amplitude, plain.amplitude)
