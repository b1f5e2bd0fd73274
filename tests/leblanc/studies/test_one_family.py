"""Unidirectional waves answer `run` for every rotor, and says how far it is from the exact equilibrium."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from fluid.fill import Fill, Fills
from leblanc.cli import main
from leblanc.liquid.choose import prepare
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.run.notes import RunCode
from leblanc.studies.run.study import run_scene
from leblanc.studies.sweep.batch import answer_scenes
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.liquid_model import LiquidAnswer, LiquidModel, Whirls, added_mass_answer
from solvers.synchronous.response import response
from tests.leblanc.studies.test_compare import by

Capture = pytest.CaptureFixture[str]
ROTORS = ("horizontal_rig", "runup", "tub")
MORE = ("vertical_rig", "centrifuge", "two_plane_rig", "washing_machine")


def few(name: str, **more: object) -> Scene:
    """An example at five of its speeds."""
    return by(example(name), "kdv").replace({"speeds.count": 5, **more})


def added(fill: Fill) -> float:
    """Mass that small waves of the retrograde family add, KdV, kg; from closed forms alone."""
    ratio = fill.surface_radius / fill.chamber.radius
    log = -math.log(ratio)
    root = math.sqrt(log * log + log)
    delta = log**3 / 3.0 * (1.0 - (2.0 * log + 1.0) / (2.0 * root))
    share = (log + root) / (2.0 * root) * (log - root) / (log - root - delta)
    return fill.full_mass * (1.0 - ratio**2 + ratio**2 * share)


class Straight(LiquidModel):
    """A law that is a straight line: each chamber adds the mass of small waves of one family."""

    name = "straight"

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        return added_mass_answer(fills, whirls, added_mass=self.added_mass(fills))

    def added_mass(self, fills: Fills) -> Array:
        return np.array([added(fills.fill(k)) for k in range(len(fills))])


@pytest.mark.parametrize("name", ["horizontal_rig", "centrifuge"])
def test_small_waves_add_the_mass_of_one_family(name: str) -> None:
    """w = Omega^2 U0/(K - (M + m) Omega^2 + i C Omega), the oracle of a planar rotor."""
    scene = few(name)
    scene = scene.replace({"rotor.unbalance": 1e-5 * scene.rotor.unbalance})  # type: ignore[union-attr]
    rotor, mass, result = scene.rotor.machine(), sum(map(added, scene.fills)), run_scene(scene)  # type: ignore[union-attr]
    speed = result.speed
    stiffness = rotor.stiffness - (rotor.mass + mass) * speed**2 + 1j * rotor.damping * speed
    np.testing.assert_allclose(result.deflection, rotor.unbalance * speed**2 / stiffness, rtol=1e-6)
    np.testing.assert_allclose(result.liquid_offset, mass * result.amplitude / result.liquid_mass, rtol=1e-6)
    wet = math.sqrt(rotor.stiffness / (rotor.mass + mass))
    assert result.critical_speed_wet == pytest.approx(wet, rel=1e-9)
    assert mass < sum(fill.added_mass for fill in scene.fills)


def test_small_waves_of_a_rotor_that_tilts() -> None:
    """In two planes by harmonic balance: the same masses, added by the closed form."""
    scene = few("two_plane_rig", **{f"rotor.unbalances.{k}.size": 1e-8 for k in range(2)})
    machine, result = prepare(scene), run_scene(scene)
    exact = response(machine.rotor, scene.fills, machine.speed, 0.0, Straight())
    np.testing.assert_allclose(result.response.coordinates, exact.coordinates, rtol=1e-6)
    assert result.converged.all() and result.response.residual.max() < 1e-9


@pytest.mark.parametrize("name", [*ROTORS, *(pytest.param(name, marks=pytest.mark.slow) for name in MORE)])
def test_every_rotor_is_answered(name: str) -> None:
    """Force and centre of mass are Newton's; range and error are reported at each speed."""
    scene = few(name)
    result, exact = run_scene(scene), run_scene(by(scene, "statics"))
    assert set(result.model.tolist()) == {"kdv"} and not result.in_range.any()
    assert np.isfinite(result.amplitude).all() and np.isfinite(result.liquid_offset).all()
    gaps = [
        np.abs(getattr(result, key) / getattr(exact, key) - 1.0) for key in ("amplitude", "liquid_offset")
    ]
    thrown = np.nan_to_num(exact.error_estimate)
    told = np.asarray(result.error_estimate)
    known = ~np.isnan(told)
    np.testing.assert_allclose(told[known], (np.maximum(*gaps) + thrown)[known], rtol=1e-6)
    # About half of the liquid's answer is missing somewhere, and that is said.
    assert np.nanmax(told) > 0.2
    (note,) = [note for note in result.notes if note.code is RunCode.ONE_FAMILY]
    assert "unidirectional waves alone" in str(note) and "out of range" in str(note)
    assert ("no wave" in str(note)) == (not result.converged.all())
    (span, *_) = explain_scene(scene).models[-1:]
    assert span.model == "kdv" and "off the exact equilibrium" in span.reason


def test_many_machines_at_once_are_each_one_alone() -> None:
    """As sweeps answer them: by the same laws."""
    scenes = [few("runup"), few("centrifuge")]
    found = answer_scenes(scenes)
    for k, scene in enumerate(scenes):
        alone = run_scene(scene)
        np.testing.assert_allclose(found.amplitude[k], alone.amplitude, rtol=1e-12)
        np.testing.assert_allclose(found.liquid_offset[k], alone.liquid_offset, rtol=1e-12)
        np.testing.assert_array_equal(found.converged[k], alone.converged)
        assert not found.in_range[k].any()


@pytest.mark.usefixtures("undrawn")
def test_where_no_wave_stands_the_answer_says_so(tmp_path: Path, capsys: Capture) -> None:
    """At its resonance this rotor goes farther than the layer is deep."""
    text = Path("examples/runup.toml").read_text(encoding="utf-8").replace('"auto"', '"kdv"')
    scene = tmp_path / "scene.toml"
    scene.write_text(text.replace("count = 381", "count = 20"), encoding="utf-8")
    assert main(["run", str(scene), "--json", "--out", str(tmp_path / "out")]) == 3
    printed = capsys.readouterr()
    answer = json.loads(printed.out)
    assert "unidirectional waves leave the wall dry at 2 of 20 speeds" in printed.err
    assert answer["state"].count("not_settled") >= 2 and answer["dry_patch"].count(True) == 2
    assert (tmp_path / "out" / "response.nc").exists()
    assert main(["run", str(scene), "--out", str(tmp_path / "out")]) == 3
    assert "Largest amplitude (mm 0-p, out of range, not converged, unstable)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"chambers.0.baffles": {"count": 4}}, "model.liquid"),
        ({"chambers.0.baffles": {"count": 2}}, "chambers.0.baffles.count"),
    ],
)
def test_chambers_that_it_does_not_know_get_one_line(change: dict[str, object], field: str) -> None:
    with pytest.raises(InputError) as fault:
        run_scene(few("horizontal_rig", **change))
    assert fault.value.field == field


def test_a_table_with_balls_is_no_rotor_with_liquid() -> None:
    with pytest.raises(InputError) as fault:
        run_scene(by(example("vibratory_table"), "kdv"))
    assert fault.value.field == "rotor.kind"
