"""Volumes of chambers with baffles: which model answers, where the liquid passes, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.core.units import LENGTH, with_unit
from leblanc.liquid.notes import BaffleCode
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.tasks import Optimisation
from leblanc.studies.optimise.answer import OptimumAnswer
from leblanc.studies.optimise.constraints import freeing_volumes, most_cells
from leblanc.studies.optimise.filled import FilledMachine, QualityAtSpeed, model_name, with_volumes
from leblanc.studies.optimise.objectives import RunupPeak
from leblanc.studies.optimise.study import optimise_scene
from leblanc.studies.run.study import run_scene
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from tests.mutants import kills

# Of a wall of 65 mm: plates of 5 mm, past which 39 ml and more flow.
ROOM = "leblanc.studies.optimise.constraints"

LOW = {"count": 8, "tip_radius": 0.06}
FREED = math.pi * 0.02 * (0.065**2 - 0.06**2)


TABLE: dict[str, Any] = {
    "name": "One chamber",
    "rotor": {
        "kind": "jeffcott",
        "mass": 4.0,
        "critical_speed": 105.0,
        "damping_ratio": 0.1,
        "unbalance": 6e-4,
        "axis": "horizontal",
    },
    "speeds": {"start": 60.0, "stop": 200.0, "count": 15},
    "model": {"friction": "stokes"},
}
CHAMBER = {"radius": 0.065, "height": 0.02, "volume": 1e-5, "liquid": "water"}


def rig(baffles: dict[str, Any] | None = LOW, **more: Any) -> Scene:
    chamber = CHAMBER if baffles is None else CHAMBER | {"baffles": baffles}
    return scene_from_table(TABLE | {"chambers": [chamber]}).replace(more)


def added_area(number: int, radius: float, inner: float) -> float:
    """Area of liquid in N compartments that adds as much mass in a small whirl with the spin.

    At rest in the drum each surface moves by e cos(theta) less its mean over the compartment.
    """
    level = number**2 * math.sin(math.pi / number) ** 2 / math.pi
    return math.pi * (radius**2 - inner**2) + inner**2 * (math.pi - level)


def amplitude(scene: Scene, volume: float, speed: float | Array) -> Array:
    """Of the rotor with the liquid in eight compartments, m."""
    rotor, inner = scene.rotor.machine(), math.sqrt(0.065**2 - volume / (math.pi * 0.02))
    assert isinstance(rotor, Jeffcott)
    mass = rotor.mass + scene.fills[0].liquid.density * 0.02 * added_area(8, 0.065, inner)
    stiffness = rotor.stiffness - mass * np.square(speed) + 1j * rotor.damping * speed
    return np.asarray(rotor.unbalance * np.square(speed) / np.abs(stiffness))


@kills("leblanc.studies.optimise.filled:model_name", "is_cut(scene)", "False")
@kills(
    "leblanc.studies.optimise.filled:FilledMachine._planar",
    "np.concatenate(places), kind",
    "0 * np.concatenate(places), kind",
)
def test_compartments_are_answered_in_closed_form() -> None:
    """Below the volume that passes the closed form of compartments, above it what a clear ring answers."""
    scene, speed, volumes = rig(), 120.0, np.array([1e-5, 6e-5, 3e-5, FREED * 1.001])
    found = FilledMachine(scene).at(volumes[:, None], np.full(4, speed)).amplitude
    clear = FilledMachine(rig(None))
    wanted = clear.at(volumes[:, None], np.full(4, speed)).amplitude
    np.testing.assert_allclose(found[[1, 3]], wanted[[1, 3]], rtol=1e-12)
    for k in (0, 2):
        assert found[k] == pytest.approx(amplitude(scene, volumes[k], speed), rel=1e-6)
        assert abs(found[k] / wanted[k] - 1.0) > 1e-3
    named = FilledMachine(scene).scene
    assert [model_name(with_volumes(named, row)) for row in volumes[:2, None]] == ["linear", "statics"]


def test_the_peak_of_compartments_is_that_of_a_run() -> None:
    """The top of the curve is the highest of many speeds, and what a run finds between its own."""
    scene, volume = rig(**{"speeds.count": 3}), np.array([[3e-5]])
    found = FilledMachine(scene).peaks(volume, scene.speeds)[0]
    speeds = np.linspace(100.0, 110.0, 20001)
    # The elements' mass, to 3e-7, and the square of half a step over the width of the resonance.
    assert found == pytest.approx(amplitude(scene, 3e-5, speeds).max(), rel=1e-6)
    assert found == pytest.approx(
        float(run_scene(with_volumes(scene, volume[0])).peak["amplitude"]), rel=1e-6
    )


def test_a_rotor_that_tilts_as_its_run() -> None:
    """Amplitude and balance quality of one chamber cut and one clear."""
    scene = example("two_plane_rig").replace(
        {"chambers.0.baffles": {"count": 3, "tip_radius": "1 mm"}, "speeds.count": 2, "speeds.start": 60.0}
    )
    scene = scene.replace({"model.liquid": "auto"})
    machine, volumes = FilledMachine(scene), np.array([fill.volume for fill in scene.fills])
    record, last = run_scene(scene), scene.speeds.stop
    found = machine.at(volumes[None], np.array([last])).amplitude[0]
    assert found == pytest.approx(record.amplitude[-1], rel=1e-9)
    assert record.balance_quality is not None
    quality = QualityAtSpeed(machine, last).of(volumes[None])[0]
    assert quality == pytest.approx(record.balance_quality[-1], rel=1e-9)
    assert set(record.response.model) == {"linear"}


@kills(f"{ROOM}:_freeing", "max(baffles.tip_radius, chamber.inner_radius)", "0.0")
@kills(f"{ROOM}:_freeing", "< chamber.radius", "< 0.0")
def test_where_the_liquid_passes() -> None:
    """Just below the volume there are compartments, just above it none; behind a gap there never are."""
    scene = rig()
    (freed,) = freeing_volumes(scene)
    assert freed == pytest.approx(FREED, rel=1e-12)
    parts = [with_volumes(scene, freed * np.array([s])).fills[0].compartments for s in (1 - 1e-6, 1 + 1e-6)]
    assert parts == [8, 1]
    for clear in (
        {"count": 3, "tip_radius": 0.05, "wall_gap": 0.002},
        {"count": 3, "tip_radius": 0.065 - 1e-12},
    ):
        assert freeing_volumes(rig(clear))[0] == pytest.approx(0.0, abs=1e-12)


def test_the_best_volume_with_baffles() -> None:
    """No volume of a grid is better, cut or not, and the response is by the model of the search."""
    scene, grid = rig(), np.linspace(0.5 * FREED, 0.99 * FREED, 14)
    known = FilledMachine(scene).at(grid[:, None], np.full(grid.size, scene.speeds.stop)).amplitude
    for span in ((0.5 * FREED, 0.99 * FREED), (0.5 * FREED, 3.0 * FREED)):
        task = Optimisation(stable=False, volumes=(span,))
        found = optimise_scene(scene, task=task, front=False)
        assert found.feasible and found.value <= known.min() * (1 + 1e-3)
        assert "parted" in {note.code for note in found.notes}
        assert found.response is not None
        cut = bool(found.volume[0] < FREED)
        assert (set(found.response.response.model) == {"linear"}) == cut == (span[1] < FREED)
        assert found.closed_form == ()
        # The sentence on a ring that hardly balances, with the layer that the best volume makes.
        said = [str(note) for note in found.notes if note.code == BaffleCode.CLOSED_COMPARTMENTS]
        assert len(said) == cut
        deep = 0.065 - math.sqrt(0.065**2 - found.volume[0] / (math.pi * 0.02))
        for sentence in said:
            assert "baffles of 5 mm" in sentence and f"layer of {with_unit(deep, LENGTH)}" in sentence
            assert "close 8 compartments" in sentence


def test_workers_do_not_change_volumes_with_baffles() -> None:
    """The same sets are judged to the same whirls by one process and by two."""
    scene = rig({"count": 3, "tip_radius": 0.05})
    alone, shared = (lb.optimise(scene, front=False, max_evaluations=20, workers=count) for count in (1, 2))
    assert isinstance(alone, OptimumAnswer) and isinstance(shared, OptimumAnswer)
    np.testing.assert_array_equal(alone.candidates.volume, shared.candidates.volume)
    np.testing.assert_array_equal(alone.candidates.excess, shared.candidates.excess)
    assert alone.growth == shared.growth and np.unique(alone.candidates.excess).size > 2
    with pytest.raises(InputError, match="workers"):
        lb.optimise(scene, workers=0)


@pytest.mark.parametrize(
    ("changes", "task", "told"),
    [
        ({"count": 2, "tip_radius": 0.06}, {}, r"chambers\.0\.baffles\.count = 2: .*two compartments"),
        ({"model.liquid": "statics"}, {}, r"model\.liquid = 'statics': .*39\.27 ml"),
        ({}, {"whirl_limit": 1e-3}, r"optimise\.whirl_limit"),
    ],
)
def test_what_has_no_model_is_refused(changes: dict[str, Any], task: dict[str, Any], told: str) -> None:
    """One line with the field; volumes that pass the baffles are answered all the same."""
    scene = rig(changes) if "count" in changes else rig(**changes)
    with pytest.raises(InputError, match=told):
        optimise_scene(scene, task=Optimisation(**task), front=False)
    if not task:
        wet = Optimisation(stable=False, volumes=((1.01 * FREED, 2.0 * FREED),))
        assert optimise_scene(scene, task=wet, front=False, response=False).feasible


def test_run_ups_take_any_number_of_baffles() -> None:
    """More of them hold the liquid back more: 40 plates are smeared over 32 cells."""
    runup = {"start": 20.0, "stop": 60.0, "rate": 80.0, "duration": 0.6, "cells": 32}
    scene = rig({"count": 40, "tip_radius": 0.06}, **{"runup": runup, "rotor.axis": "vertical"})
    assert scene.runup is not None
    wet = Optimisation(objective="peak", volumes=((2.0 * FREED, 3.0 * FREED),))
    with pytest.raises(InputError, match=r"runup\.cells = 32: must be 160 or more"):
        optimise_scene(scene, task=wet.altered(volumes=()), front=False)
    assert most_cells(scene) == 160 and most_cells(rig()) == 32 and most_cells(rig(None)) == 0
    assert np.isfinite(RunupPeak(scene).exact(np.array([[6e-5]]))).all()
