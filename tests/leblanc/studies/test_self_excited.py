"""What self-excited whirl makes of a study's stability, and how it is reported."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fluid.friction.laws import NO_FRICTION, layer_thickness
from fluid.whirl import damped_waves
from leblanc.liquid.choose import prepare
from leblanc.scene.scene import dry_rotor, load_scene
from leblanc.studies.run.motion import SelfExcited
from leblanc.studies.run.notes import RunCode
from leblanc.studies.run.notes import self_excited as note_of
from leblanc.studies.run.study import _thick_layers, run_scene, self_excited
from leblanc.studies.run.words import checks
from meshes.arrays import Array
from solvers.whirl import laminar
from solvers.whirl.growth import asynchronous_growth
from solvers.whirl.system import SystemModes
from tests.mutants import kills


def found(growth: list[float], bands: tuple[tuple[float, float], ...]) -> SelfExcited:
    return SelfExcited(np.array(growth), np.array([50.0, 60.0, 70.0]), bands, "none")


_ANSWER = "leblanc.studies.run.motion:SelfExcited"


@kills(
    f"{_ANSWER}.leaves_stable",
    "self.growth <= 0.0)",
    "self.growth < 0.0)",
)
@kills(f"{_ANSWER}.leaves_stable", "stable & (self", "stable | (self")
def test_stability() -> None:
    """Growing whirls take stability away, and give none back."""
    whirl = found([-1.0, 0.0, 0.5], ((80.0, 90.0),))
    stable = whirl.leaves_stable(np.array([True, False, True]))
    np.testing.assert_array_equal(stable, [True, False, False])
    np.testing.assert_array_equal(whirl.leaves_stable(np.ones(3, dtype=bool)), [True, True, False])


@kills(
    f"{_ANSWER}.leaves_stable",
    "(self.growth <= 0.0)",
    "~(self.growth > 0.0)",
)
@kills("leblanc.studies.run.answer:RunAnswer.stability", "(kept & np.isnan(growth))", "False")
@kills("leblanc.studies.run.study:self_excited", "bands_not_known(speed, growth)", "()")
def test_what_is_not_known_is_not_stable(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search that fails differs from a stable machine in every way out; its bands are listed."""
    scene = load_scene("examples/two_plane_rig.toml").replace({"speeds.count": 13})
    whole = run_scene(scene)
    assert set(whole.stability.tolist()) == {"stable", "unstable"} and whole.whirl_bands_not_known == ()
    np.testing.assert_array_equal(whole.stability == "stable", whole.stable)
    # Every third search finds nothing.
    search = laminar._counted

    def lost(problem: object, modes: SystemModes, speed: Array, fastest: Array) -> SystemModes:
        found = search(problem, modes, speed, fastest)  # type: ignore[arg-type]
        return replace(found, complete=found.complete & (np.round(speed * 30.0 / np.pi).astype(int) % 3 > 0))

    monkeypatch.setattr(laminar, "_counted", lost)
    result = run_scene(scene)
    unknown = np.isnan(result.growth)
    assert unknown.any() and not unknown.all()
    assert np.all(result.stability[unknown] == "not_known") and not result.stable[unknown].any()
    np.testing.assert_array_equal(result.stability[~unknown], whole.stability[~unknown])
    answer = result.to_json()
    assert all(state == "not_known" for state in np.array(answer["stability"])[unknown])
    assert not any(np.array(answer["stable"])[unknown])
    told = np.zeros(unknown.shape, dtype=bool)
    for low, high in answer["whirl_bands_not_known"]:
        told |= (result.speed > low) & (result.speed < high)
        assert not any(low < b and high > a for a, b in answer["whirl_bands"])
    np.testing.assert_array_equal(told[1:-1], unknown[1:-1])
    assert "do not take it for stable" in note_of(result.whirl).text
    assert "Stability not known" in [limit.label for limit in checks(result)]
    flag = result.to_dataset()["stability"]
    meaning = dict(zip(flag.attrs["flag_values"].tolist(), flag.attrs["flag_meanings"].split(), strict=True))
    assert [meaning[value] for value in flag.values.tolist()] == result.stability.tolist()


@kills("leblanc.studies.run.notes:self_excited", "np.nanargmax(whirl", "np.nanargmin(whirl")
def test_words() -> None:
    """Edges and the fastest whirl in rpm."""
    text = note_of(found([-1.0, 0.25, 0.5], ((20.0 * np.pi, 30.0 * np.pi),))).text
    assert "600 to 900 rpm" in text and "668.5 rpm" in text and "0.5 1/s" in text
    assert note_of(found([-1.0, -1.0, 0.0], ())).text.startswith("No self-excited whirl")
    assert "Not known at 1 of 3 speeds" in note_of(found([np.nan, 0.0, 0.0], ())).text
    assert "is not known" in note_of(found([np.nan] * 3, ())).text


@kills(
    "leblanc.studies.run.study:self_excited",
    "filled, known = [scene.fills], growth[None]",
    "filled, known = [scene.fills[:1]], None",
)
def test_rig() -> None:
    """The horizontal rig whirls just above its critical speed, slower than it spins."""
    whirl = self_excited(prepare(load_scene("examples/horizontal_rig.toml")))
    ((low, high),) = whirl.bands
    speed = load_scene("examples/horizontal_rig.toml").speed_array()
    grows = whirl.growth > 0.0
    assert 104.0 < low < 112.0 < high < 160.0
    np.testing.assert_array_equal(grows, (speed > low) & (speed < high))
    assert np.all(whirl.whirl_speed[grows] < speed[grows])
    # Refined edges: growth there is its slope, some 0.1 in a unit of speed, times 1e-8 of the speed.
    scene = load_scene("examples/horizontal_rig.toml")
    at_edges, _ = asynchronous_growth(dry_rotor(scene), scene.fills, [low, high], scene.model.friction)
    assert np.all(np.abs(at_edges) < 1e-6)


@kills("leblanc.studies.run.study:_thick_layers", "2.0 * fill.liquid.viscosity", "fill.liquid.viscosity")
@kills("leblanc.studies.run.study:_thick_layers", "slip / slower_slip(layer.layer_tanh)", "slip")
def test_thick_wall_layers_are_said() -> None:
    """Below the speed at which the slower wave's layer is a fifth of the depth growth is out of range."""
    machine = prepare(load_scene("examples/horizontal_rig.toml"))
    note = _thick_layers(machine)
    assert note is not None and note.code is RunCode.THICK_WALL_LAYER
    speed, shares = float(note.data["speed"]), []  # type: ignore[arg-type]
    assert machine.speed[-1] < speed and note.text.startswith("Growth and bands here")
    for fill in machine.scene.fills:
        kappa = (fill.chamber.radius / fill.surface_radius) ** 2
        slower = abs(float(damped_waves((kappa - 1.0) / (kappa + 1.0), speed, 0.0)[1].real))
        shares.append(float(layer_thickness(fill.liquid.viscosity, slower)) / fill.depth)
    assert max(shares) == pytest.approx(0.2, rel=1e-9)
    faster = _thick_layers(replace(machine, speed=2.0 * machine.speed))
    assert faster is not None and "below 2600 rpm" in faster.text and faster.data["speed"] == speed
    assert _thick_layers(replace(machine, speed=speed + machine.speed)) is None
    # Without laminar friction there are none.
    assert _thick_layers(replace(machine, friction=NO_FRICTION)) is None
