"""Whirls of finite size as users meet them: map --cycles, explain, the limit of an optimisation."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from pytest import approx

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.scene import Scene, load_scene
from leblanc.scene.tasks import Optimisation
from leblanc.studies.explain.answer import facts as explained
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.map.answer import WhirlMap, facts, sentence
from leblanc.studies.map.figure import cycles_figure
from leblanc.studies.optimise.constraints import whirl_size
from leblanc.studies.runup.study import runup_scene, whirl_on_the_way
from meshes.errors import InputError
from tests.mutants import kills

SCENE = """
name = "Whirl"
[rotor]
kind = "jeffcott"
mass = 6.2832
critical_speed = "100 rad/s"
damping_ratio = 0.02
unbalance = 0.0
axis = "{axis}"
[[chambers]]
radius = "100 mm"
height = "20 mm"
volume = "119.38 ml"
liquid = {{ density = 1000.0, viscosity = "1e-6 m^2/s" }}
[speeds]
start = "100 rad/s"
stop = "140 rad/s"
count = 41
[model]
friction = {{ linear = "3 1/s" }}
"""


def scene(folder: Path, axis: str = "vertical") -> Path:
    path = folder / f"{axis}.toml"
    path.write_text(SCENE.format(axis=axis))
    return path


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> Scene:
    return load_scene(scene(tmp_path_factory.mktemp("whirl")))


@pytest.fixture(scope="module")
def found(machine: Scene) -> WhirlMap:
    return lb.map_whirl(machine, volumes=3, speeds=21, cycles=True)


def test_the_map_tells_how_large_the_whirl_grows(found: WhirlMap) -> None:
    # Rotor and layer marched in time: 0.5664 of the depth, 10 mm, at 1.3 times the natural frequency.
    stable = [row for row in found.cycles if row["stable"]]
    near = min(stable, key=lambda row: abs(row["speed"] - 130.0))
    assert near["amplitude"] == approx(5.66e-3, rel=0.02)
    assert near["whirl_speed"] == approx(95.07, rel=2e-3)
    assert near["power"] == approx(near["torque"] * near["speed"])
    assert all(row["in_range"] == (3.0 * row["lag"] <= row["speed"]) for row in found.cycles)
    (fold,) = found.folds
    assert fold["speed"] == approx(111.86, rel=1e-3)
    values = dict(facts(found))
    assert values["Folds"].startswith("1068 rpm")
    assert "up to 6.78" in sentence(found) and values["Largest stable whirl"] in sentence(found)


def test_a_map_that_was_not_asked_has_no_cycles(machine: Scene) -> None:
    plain = lb.map_whirl(machine, volumes=3, speeds=5)
    assert plain.large is None and plain.cycles is None and "cycles" not in plain.to_json()
    assert not any(name.startswith("cycle") for name in plain.named_arrays().variables)


def test_data_file_and_json_say_the_same(found: WhirlMap) -> None:
    arrays = found.to_dataset()
    text = json.loads(json.dumps(found.to_json()["cycles"]))
    for name in ("speed", "amplitude", "whirl_speed", "lag", "power"):
        assert arrays[f"cycle_{name}"].values == approx([row[name] for row in text])
    assert (arrays["cycle_stable"].values > 0).tolist() == [row["stable"] for row in text]
    assert arrays["fold_speed"].values == approx([fold["speed"] for fold in found.folds])


def test_the_figure_tells_stable_from_unstable_without_colour(found: WhirlMap) -> None:
    figure = cycles_figure(found)
    lines = {line.get_label(): line for line in figure.axes[0].get_lines()}
    assert lines["stable"].get_linestyle() != lines["unstable"].get_linestyle()
    values = dict(facts(found))
    assert values["Largest stable whirl"] in figure.alt and values["Folds"] in figure.alt


def test_gravity_across_is_told_and_nothing_bounds_a_whirl(tmp_path: Path) -> None:
    few = {"volumes": 2, "speeds": 5, "cycles": True}
    lying = lb.map_whirl(scene(tmp_path, "horizontal"), **few)
    assert any(note.code == "no_circle" for note in lying.notes)
    free = load_scene(scene(tmp_path)).replace({"rotor.damping_ratio": 0.0})
    (note,) = (note for note in lb.map_whirl(free, **few).notes if note.code == "no_cycles")
    assert "nothing bounds" in note.text


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = scene(tmp_path)
    main(["map", str(path), "--cycles", "--volumes", "2", "--speeds", "5", "--out", str(tmp_path), "--json"])
    told = json.loads(capsys.readouterr().out)
    assert told["folds"] and {"speed", "amplitude", "whirl_speed", "lag", "stable"} <= set(told["cycles"][0])
    assert (tmp_path / "cycles.svg").exists() and "self-excited whirls over speed" in (
        tmp_path / "map.html"
    ).read_text()


@kills("solvers.cycles.estimate:largest_estimate", "0.5 * (low + high)", "0.1 * low + 0.9 * high")
def test_explain_estimates_it(machine: Scene, found: WhirlMap) -> None:
    explanation = explain_scene(machine)
    assert explanation.whirl is not None
    # The middle of a band that the last speed cuts, among the rows of the branch next to it.
    assert 110.0 < explanation.whirl.speed < 130.0
    rows = sorted((row["speed"], row["amplitude"]) for row in found.cycles if row["stable"])
    solved = np.interp(explanation.whirl.speed, *np.transpose(rows))
    assert explanation.whirl.amplitude == approx(solved, rel=0.1)
    assert any(label == "whirl" for label, _ in explained(explanation))
    calm = machine.replace({"speeds.stop": "105 rad/s"})
    assert explain_scene(calm).whirl is None
    # One whirl of one machine, however many speeds are asked.
    for count in (2, 60, 201):
        other = explain_scene(machine.replace({"speeds.count": count})).whirl
        assert other == explanation.whirl


def test_a_run_up_says_how_large_the_whirl_on_its_way_becomes(machine: Scene, found: WhirlMap) -> None:
    plan = {"start": 100.0, "stop": 140.0, "rate": 400.0, "duration": 0.1, "cells": 16, "samples": 10}
    ramped = machine.replace({"runup": plan})
    (note,) = (note for note in runup_scene(ramped, check=False).notes if note.code == "self_excited")
    # As `explain` has it.
    told = explain_scene(machine).whirl
    assert told is not None
    assert (note.data["speed"], note.data["amplitude"]) == approx((told.speed, told.amplitude), rel=1e-6)
    assert "map --cycles" in note.text
    lying = whirl_on_the_way(ramped.replace({"rotor.axis": "horizontal"}), ((112.4, 140.0),))
    assert lying is None and whirl_on_the_way(ramped, ()) is None


def test_a_limit_of_the_whirl(machine: Scene) -> None:
    limit = whirl_size(machine, np.linspace(100.0, 140.0, 5), 5e-3)
    values = limit.value(np.array([[0.0], [2e-5], [1.1938e-4], [6e-4]]))
    # Nothing in the chamber, nothing that whirls; a thin layer; the scene's own; nearly full.
    assert values[0] == 0.0 and values[3] == 0.0
    assert 0.0 < values[1] < values[2] == approx(6.78e-3, rel=0.02)
    assert (limit.excess(values) > 0.0).tolist() == [False, False, True, False]
    assert Optimisation(whirl_limit=1e-3).whirl_limit == 1e-3


def test_a_limit_of_a_whirl_that_is_an_ellipse(tmp_path: Path) -> None:
    tub = load_scene(Path(__file__).parents[3] / "examples/tub.toml")
    with pytest.raises(InputError, match="whirl_limit"):
        whirl_size(tub, np.linspace(10.0, 100.0, 5), 1e-3)


@kills("leblanc.studies.cycles.study:cycles_by", '== "kdv" else', '== "none" else')
@kills(
    "leblanc.studies.cycles.study:_of_family",
    "sizes[1:, both] - sizes[0, both]",
    "sizes[:1, both] - sizes[0, both]",
)
def test_limit_cycles_by_kdv_burgers(machine: Scene, capsys: pytest.CaptureFixture[str]) -> None:
    map_ = lb.map_whirl(machine, volumes=2, speeds=3, cycles=True, model="kdv")
    assert map_.large is not None and map_.large.wave == "kdv"
    # Marched in time 0.5664 of 10 mm at 130 rad/s; see [theory: kdv] for the distance.
    (size,) = (w.amplitude for branch in map_.large.branches for w in branch.at(130.0) if w.stable)
    assert size == approx(5.664e-3, rel=0.04)
    notes = {note.code: note.data for note in map_.notes}
    assert notes["high_wave"]["largest"] > 0.3
    # Half the diffusion and half as much again: the whirl owes it little, but not nothing.
    assert 1e-4 < notes["diffusion"]["change"] < 0.01
    # Where the trough is below the wall the wave is out of range, though the size still holds.
    rows = map_.large.cycles
    assert all(row.in_range == (row.thinnest >= 0.0 and row.lag <= row.speed / 3.0) for row in rows)
    assert "KdV-Burgers" in str(map_.blocks())
    own = machine.replace({"model.friction": {"quadratic": 0.01}})
    for one, friction, field in ((machine, "quadratic:0.01", "friction"), (own, None, "model.friction")):
        with pytest.raises(InputError, match="unidirectional") as refused:
            lb.map_whirl(one, volumes=2, speeds=3, cycles=True, model="kdv", friction=friction)
        assert refused.value.field == field
    given = machine.replace({"model.liquid": "kdv"})
    assert lb.run(given, cycles=True).to_json()["cycles_model"] == "kdv"
