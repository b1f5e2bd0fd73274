"""One scene by several liquid models: each answers as `run` does, and who does not says why."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.studies.compare.answer import comparison_rows
from leblanc.studies.compare.figure import comparison_figure
from leblanc.studies.held.holding import Holding
from leblanc.studies.run.study import run_scene
from meshes.errors import InputError
from tests.mutants import kills

Capture = pytest.CaptureFixture[str]


def by(scene: Scene, model: str) -> Scene:
    return scene.replace({"model.liquid": model})


@pytest.mark.parametrize("name", ["horizontal_rig", "centrifuge", "tub"])
def test_a_comparison_is_the_difference_of_two_runs(name: str) -> None:
    scene = example(name).replace({"speeds.count": 5})
    found = lb.compare(scene, ["linear", "statics"])
    linear, statics = (run_scene(by(scene, model)) for model in ("linear", "statics"))
    difference, largest = linear.amplitude - statics.amplitude, statics.peak["amplitude"]
    assert largest >= statics.amplitude.max()
    np.testing.assert_array_equal(found.difference("linear"), difference / largest)
    assert found.largest_difference("linear") == np.abs(difference / largest).max()
    assert found.digest == scene.digest and found.name == scene.name
    assert [one.result is not None and one.cpu_time is not None for one in found.answers] == [True, True]


def test_an_empty_machine_is_the_same_by_every_model() -> None:
    """Without liquid each answers the dry rotor, whose amplitude is known."""
    scene = example("horizontal_rig")
    empty = scene.replace({f"chambers.{k}.volume": 0.0 for k in range(len(scene.chambers))})
    found = lb.compare(empty, ["linear", "statics"])
    rotor, speed = empty.rotor.machine(), found.speed  # type: ignore[union-attr]
    stiff = rotor.stiffness - rotor.mass * speed**2
    dry = rotor.unbalance * speed**2 / np.abs(stiff + 1j * rotor.damping * speed)
    for one in found.results.values():
        # Rounding of the two ways to write the same quotient.
        np.testing.assert_allclose(one.amplitude, dry, rtol=1e-12)


@kills("leblanc.studies.compare.figure:_two_lines", 'label.replace(" at ", "\\nat ")', "label")
@kills("leblanc.studies.compare.answer:_estimate", "error >= WHOLE", "error < 0.0")
def test_a_tub_fits_its_low_panels_and_no_error_is_thousands() -> None:
    """Resonances drawn wider halve the panels: no label reaches the next one. 100 % and more are words."""
    found = lb.compare(example("tub"), ["linear", "statics"])
    figure = comparison_figure(found)
    FigureCanvasAgg(figure).draw()
    labels = [axes.yaxis.label.get_window_extent() for axes in figure.axes if axes.get_ylabel()]
    assert len(labels) == 4
    assert not any(one.overlaps(other) for one, other in combinations(labels, 2))
    rows = comparison_rows(found)
    assert found.answers[0].largest_error > 1.0 and "100 or more" in rows[0]  # type: ignore[operator]


@kills("leblanc.studies.compare.figure:comparison_figure", "text, FRAME.left", "text")
def test_small_differences_leave_their_ticks_room() -> None:
    """0.005 per cent is a long word beside a low panel: its label stays on the figure."""
    figure = comparison_figure(lb.compare(example("centrifuge"), ["linear", "statics"]))
    FigureCanvasAgg(figure).draw()
    labels = [axes.yaxis.label.get_window_extent() for axes in figure.axes if axes.get_ylabel()]
    assert min(label.x0 for label in labels) >= 0.0


def test_a_model_by_itself_has_no_difference() -> None:
    found = lb.compare(example("centrifuge"), ["linear"])
    assert found.reference == "linear" and found.largest_difference("linear") == 0.0


class Solid:
    """Liquid that is frozen to the drum."""

    name = "solid"

    def answer(self, fills: Any, whirls: Any) -> lb.LiquidAnswer:
        """See `LiquidModel`."""
        return lb.LiquidAnswer.at_rest(fills, whirls, fills.mass * whirls.amplitude, fills.mass)


@kills("leblanc.studies.compare.study:_answer", "None if named else model", "None")
def test_a_model_of_ones_own_beside_a_name() -> None:
    """Each as `run` answers with it; the digest knows the object, the scene's own does not."""
    scene = example("horizontal_rig").replace({"speeds.count": 5})
    found = lb.compare(scene, [Solid(), "linear"])
    assert found.models == ("solid", "linear") and found.reference == "linear"
    own = lb.run(scene, model=Solid())
    np.testing.assert_array_equal(found.results["solid"].amplitude, own.amplitude)
    assert found.difference("solid").any() and "Solid" in found.typed.liquid_model
    assert found.digest not in (scene.digest, own.digest)
    for wrong in ([Solid(), Solid()], [Solid(), 1]):
        with pytest.raises(InputError) as fault:
            lb.compare(scene, wrong)
        assert fault.value.field == "models"


def test_an_announced_model_is_known_by_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = SimpleNamespace(name="solid", group="leblanc.liquids", value="ice:Solid", load=lambda: Solid)
    package = SimpleNamespace(name="ice", entry_points=(entry,))
    monkeypatch.setattr("leblanc.registry.distributions", lambda: [package])
    scene = example("horizontal_rig").replace({"speeds.count": 5})
    found, own = (lb.compare(scene, [model, "linear"]) for model in ("solid", Solid()))
    np.testing.assert_array_equal(found.difference("solid"), own.difference("solid"))


def test_the_scenes_own_model_does_not_count() -> None:
    scene = example("horizontal_rig")
    one, other = (lb.compare(by(scene, own), ["linear"]) for own in ("auto", "kdv"))
    np.testing.assert_array_equal(one.results["linear"].amplitude, other.results["linear"].amplitude)


def test_a_refusal_is_an_entry() -> None:
    cut = example("horizontal_rig").replace({"chambers.0.baffles": {"count": 4}, "speeds.count": 5})
    found = lb.compare(cut, ["fem", "kdv"])
    assert [one.answered for one in found.answers] == [True, False]
    assert found.reference == "fem"
    refused = found.answers[1]
    assert f"'{refused.model}'" in refused.reason and "baffles" in refused.reason


def test_waves_held_in_time_are_a_model_like_the_others() -> None:
    """Upright they are the exact equilibrium, to their own estimate of the error."""
    change = {"speeds.start": 60.0, "speeds.count": 2, "model.cells": 32, "model.friction": {"linear": 5.0}}
    found = lb.compare(example("vertical_rig").replace(change), ["statics", "long_wave"])
    assert [one.answered for one in found.answers] == [True, True]
    held = found.results["long_wave"]
    assert held.error_estimate is not None and held.converged.all()
    gap = np.abs(held.amplitude / found.results["statics"].amplitude - 1.0)
    assert np.all(gap <= held.error_estimate + 1e-4)


@pytest.mark.parametrize(
    ("name", "models", "field"),
    [
        ("horizontal_rig", [], "models"),
        ("horizontal_rig", ["statics", "beauty"], "models"),
        ("horizontal_rig", ["statics", "linear", "statics"], "models"),
        ("vibratory_table", ["statics"], "rotor.kind"),
    ],
)
def test_faults_name_the_field(name: str, models: list[str], field: str) -> None:
    with pytest.raises(InputError) as fault:
        lb.compare(example(name), models)
    assert fault.value.field == field


def test_a_fault_of_the_scene_is_not_one_of_the_models() -> None:
    halves = example("horizontal_rig").replace({"chambers.0.baffles": {"count": 2}})
    with pytest.raises(InputError) as fault:
        lb.compare(halves, ["auto", "fem"])
    assert fault.value.field == "chambers.0.baffles.count"
    quarters = example("horizontal_rig").replace({"chambers.0.baffles": {"count": 4}})
    with pytest.raises(InputError) as fault:
        lb.compare(quarters, ["kdv"])
    assert fault.value.field == "models"


def test_the_command_writes_what_it_prints(tmp_path: Path, capsys: Capture) -> None:
    scene = tmp_path / "rig.toml"
    assert main(["new", "--example", "horizontal_rig", str(scene)]) == 0
    capsys.readouterr()
    command = ["compare", str(scene), "--models", "kdv, linear, statics", "--out", str(tmp_path / "out")]
    assert main([*command, "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert [one["model"] for one in said["models"]] == ["kdv", "linear", "statics"]
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "compare.nc",
        "compare.svg",
        "contents.json",
    }
    assert main(command) == 0
    printed = capsys.readouterr().out
    for one in said["models"]:
        assert f"{1e3 * one['peak_amplitude']:.4g}" in printed


def test_a_model_that_does_not_answer_is_a_row_and_a_line(tmp_path: Path, capsys: Capture) -> None:
    scene, text = tmp_path / "rig.toml", Path("examples/centrifuge.toml").read_text(encoding="utf-8")
    assert "count = 289" in text
    text = text.replace("count = 289", "count = 9")  # finite elements take their time at each
    scene.write_text(text.replace("[[chambers]]", "[[chambers]]\nbaffles = { count = 4 }"), encoding="utf-8")
    assert main(["compare", str(scene), "--models", "kdv,fem", "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    assert "does not answer" in printed and "kdv: model.liquid = 'kdv'" in printed


def test_kept_states_are_held_anew_where_their_time_is_asked_for(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else what an earlier run has left is taken, and costs nothing."""
    seen: list[Holding] = []

    def looked_at(scene: Scene, model: str, holding: Holding) -> object:
        seen.append(holding)
        raise InputError("scene", "enough", "seen")

    monkeypatch.setattr("leblanc.studies.compare.study._answer", looked_at)
    typed = ["compare", "examples/centrifuge.toml", "--models", "long_wave", "--out", str(tmp_path / "out")]
    assert main(typed) == main([*typed, "--fresh", "--workers", "3"]) == 2
    assert [holding.fresh for holding in seen] == [False, True] and seen[1].workers == 3
    assert {holding.folder for holding in seen} == {tmp_path / "out"}
    capsys.readouterr()
    assert main([*typed, "--workers", "0"]) == 2
    assert "--workers" in capsys.readouterr().err


@pytest.mark.parametrize("models", ["statics,statics", "beauty", ""])
def test_the_command_refuses_in_one_line(models: str, tmp_path: Path, capsys: Capture) -> None:
    scene = tmp_path / "rig.toml"
    assert main(["new", "--example", "horizontal_rig", str(scene)]) == 0
    capsys.readouterr()
    assert main(["compare", str(scene), "--models", models, "--out", str(tmp_path / "out")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("leblanc: --models = ")
    assert not (tmp_path / "out").exists()
