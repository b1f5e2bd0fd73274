"""`leblanc explain` and the choice of the liquid model."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from fluid.fill import Fill
from fluid.liquid import Liquid
from fluid.numbers import layer_numbers
from fluid.pool import centrifuging_speed
from leblanc.cli import main
from leblanc.core.units import in_rpm
from leblanc.liquid.choose import carried_from, choose
from leblanc.registry import CORE
from leblanc.scene.examples import example, example_names, example_path
from leblanc.scene.scene import Scene, load_scene, scene_from_table
from leblanc.studies.explain.answer import layer_rows
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.run.study import run_scene
from meshes.chamber import Chamber
from meshes.errors import InputError
from tests.mutants import kills

RPM = math.pi / 30.0


def table(**rotor: object) -> dict[str, object]:
    return {
        "name": "test",
        "rotor": {
            "kind": "jeffcott", "mass": 4.0, "stiffness": 4e4, "damping_ratio": 0.1, "unbalance": 6e-4,
            "axis": "horizontal", **rotor,
        },
        "chambers": [{"radius": 0.065, "height": 0.02, "volume": 1e-5, "liquid": "water"}],
        "speeds": {"start": 5.0, "stop": 200.0, "count": 40},
    }  # fmt: skip


def scene(**rotor: object) -> Scene:
    return scene_from_table(table(**rotor))


@kills("fluid.numbers:layer_numbers", "np.square(spin) * surface / gravity", "spin * surface / gravity")
@kills(
    "fluid.numbers:layer_numbers",
    "spin * radius**2 / viscosity if viscosity > 0.0",
    "spin * radius / viscosity if viscosity > 0.0",
)
@kills(
    "fluid.numbers:layer_numbers", "np.sqrt(viscosity / spin) / fill.depth", "viscosity / spin / fill.depth"
)
@kills(
    "fluid.fill:Fill.depth",
    "film / (self.chamber.radius + self.surface_radius)",
    "film / (2.0 * self.chamber.radius)",
)
@kills(
    "fluid.fill:Fill.surface_radius",
    "self.chamber.radius**2 - self.volume / (math.pi",
    "self.chamber.radius**2 - self.volume / (2.0 * math.pi",
)
def test_numbers() -> None:
    """Numbers of a layer whose values are round: R = 2, a = 1.2, nu = 0.04."""
    volume = math.pi * (4.0 - 1.44) * 0.5
    fill = Fill(Chamber(2.0, 0.5), Liquid("oil", 900.0, 0.04), volume)
    n = layer_numbers(fill, np.array([10.0, 100.0]), gravity=10.0, axial_gravity=10.0)
    assert n.fill == pytest.approx(0.64)
    assert n.relative_depth == pytest.approx(0.4)
    assert n.curvature == pytest.approx(1.0 / 0.36)
    np.testing.assert_allclose(n.centrifuge, [12.0, 1200.0])
    np.testing.assert_allclose(n.steepness, [40.0, 4000.0])
    assert np.isinf(layer_numbers(fill, np.array([10.0]), gravity=10.0, axial_gravity=0.0).steepness).all()
    np.testing.assert_allclose(n.reynolds, [1e3, 1e4])
    np.testing.assert_allclose(n.skin, np.sqrt([4e-3, 4e-4]) / 0.8)


@pytest.mark.parametrize("axis", ["horizontal", "vertical"])
def test_no_gravity_is_the_limit_of_little(axis: str) -> None:
    """On either axis, and there is no speed below which it holds no ring."""
    made = scene().replace({"rotor.axis": axis, "speeds.count": 5})
    without, little = (made.replace({"gravity": gravity}) for gravity in (0.0, 1e-6))
    assert choose(without).captured_from is None
    # What gravity changes is of first order in g/(Omega^2 a), below 1e-6 here.
    np.testing.assert_allclose(run_scene(without).amplitude, run_scene(little).amplitude, rtol=1e-6)


@kills("leblanc.liquid.choose:_carried", "speed > captured_from", "speed < captured_from")
def test_a_horizontal_axis_needs_capture() -> None:
    """The liquid of a horizontal axis is captured where Omega^2 a exceeds g; a vertical axis needs none."""
    lying = choose(scene())
    assert lying.captured_from is not None
    surface = scene().fills[0].surface_radius
    assert lying.captured_from == pytest.approx(math.sqrt(9.81 / surface))
    speed = scene().speed_array()
    np.testing.assert_array_equal(lying.in_range, speed > lying.captured_from)
    assert choose(scene(axis="vertical")).captured_from is None
    assert choose(scene(axis="vertical")).in_range.all()


@kills("leblanc.liquid.choose:carried_from", "max([stands", "min([stands")
def test_run_tells_both_speeds_of_a_lying_drum() -> None:
    """Speeds from which an annular layer exists and is reached from rest: `fluid.pool` has both."""
    lying = scene().replace({"model.friction": "stokes"})
    fill, found = lying.fills[0], run_scene(lying)
    stands = math.sqrt(9.81 / fill.surface_radius)
    balance = centrifuging_speed(fill, lying.model.friction, 9.81)
    assert balance > stands
    assert found.capture_speed == pytest.approx(stands) and found.carried_from == pytest.approx(balance)
    assert found.to_json()["carried_from"] == found.carried_from
    (note,) = (note for note in found.notes if note.code == "not_carried")
    assert in_rpm(stands) in note.text and in_rpm(balance) in note.text
    # A drag that beats gravity at once leaves the ring's own condition; without friction nothing carries it.
    held = lying.replace({"model.friction": {"linear": 1e6}})
    assert carried_from(held) == pytest.approx(stands)
    free = run_scene(lying.replace({"model.friction": "none"}))
    assert free.carried_from == math.inf and free.to_json()["carried_from"] is None
    assert carried_from(scene(axis="vertical")) is None


@pytest.mark.parametrize("model", ["kdv", "statics"])
def test_models_that_do_not_answer_are_refused(model: str) -> None:
    """Compartments have waves of their own."""
    asked = scene_from_table(table() | {"model": {"liquid": model}}).replace(
        {"chambers.0.baffles": {"count": 4}}
    )
    with pytest.raises(InputError, match=r"model\.liquid"):
        choose(asked)


def test_explanation() -> None:
    answer = explain_scene(scene())
    added = 998.2 * math.pi * 0.065**2 * 0.02
    assert answer.critical_speed_dry == pytest.approx(100.0)
    assert answer.critical_speed_wet == pytest.approx(math.sqrt(4e4 / (4.0 + added)), rel=1e-9)
    assert answer.speed_ratio == pytest.approx((0.05, 2.0))
    layer = answer.layers[0]
    assert layer is not None and layer.added_mass_ratio == pytest.approx(added / 4.0)
    spans = answer.models
    assert not spans[0].in_range and all(span.in_range for span in spans[1:])
    assert spans[0].first == 5.0 and spans[-1].last == 200.0


def test_words_and_json(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main(["explain", "examples/vertical_rig.toml", "--full"]) == 0
    words = capsys.readouterr().out
    assert "chamber 3" in words and "statics" in words and "kappa" in words
    assert main(["explain", "examples/horizontal_rig.toml", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    numbers = answer["layers"][0]["numbers"]
    assert numbers["relative_depth"] == pytest.approx(0.01902, rel=1e-3)
    assert numbers["steepness"] == [None, None]  # a cylinder


def test_the_wall_is_told_how_it_carries_the_liquid_along() -> None:
    """By the law of the wall: regime and Reynolds number of the lag that the ramp asks, spin-up beside it."""
    given = table()
    given["chambers"] = [{"radius": 0.15, "height": 0.05, "volume": 6.715e-4, "liquid": "water"}]
    given["runup"] = {"start": 5.0, "stop": 40.0, "rate": 2.0, "duration": 20.0}
    laminar = given | {"model": {"friction": "stokes"}}
    assert explain_scene(scene_from_table(laminar)).layers[0].spin_up is None  # type: ignore[union-attr]
    layer = explain_scene(scene_from_table(given)).layers[0]
    assert layer is not None and layer.spin_up is not None
    found = layer.spin_up
    # 15 mm deep at 40 rad/s in water: 5.37 s; the Reynolds number by its definition.
    assert found.time == pytest.approx(5.37, rel=0.01)
    diameter = 4.0 * 0.015 * 0.05 / 0.08
    assert found.reynolds == pytest.approx(found.lag * 0.15 * diameter / 1.0e-6, rel=0.01)
    assert (found.regime, found.ramp, found.ramp_time) == ("turbulent", True, pytest.approx(17.5))
    # What the ramp asks: dOmega/dt R = (f_D/2) u^2/D_h with f_D of 0.02 to 0.04.
    speed = found.lag * 0.15
    assert 0.01 < 2.0 * 0.15 * diameter / speed**2 < 0.02
    rows = dict(layer_rows(layer))
    assert "turbulent" in rows["flow at the wall"] and "can follow" in rows["spun up"]
    del given["runup"]
    still = explain_scene(scene_from_table(given)).layers[0]
    assert still is not None and still.spin_up is not None and still.spin_up.lag == pytest.approx(200.0)


def test_an_answer_says_in_python_what_the_command_prints(capsys: pytest.CaptureFixture[str]) -> None:
    """Byte for byte: lists, and null for what is not finite, before anything is printed."""
    scene = "examples/horizontal_rig.toml"
    assert main(["explain", scene, "--json"]) == 0
    answer = explain_scene(load_scene(scene)).to_json()
    assert json.dumps(answer, allow_nan=False) + "\n" == capsys.readouterr().out


@pytest.mark.parametrize("name", [name for name in example_names() if not name.startswith("studies/")])
def test_twelve_lines_say_the_main_numbers(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Of every machine with liquid; none is longer than 100 columns."""
    scene = example(name)
    if scene.balls or scene.kind not in CORE:
        return
    assert main(["explain", str(example_path(name))]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 12 and max(map(len, lines)) <= 100
    printed = "\n".join(lines)
    answer = lb.explain(scene)
    assert in_rpm(answer.critical_speed_dry) in printed and "explain --full" in lines[-1]
    assert all(span.model in printed for span in answer.models[:4])
    assert main(["explain", str(example_path(name)), "--full"]) == 0
    assert len(capsys.readouterr().out.splitlines()) > len(lines)
