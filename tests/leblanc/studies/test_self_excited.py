"""What self-excited whirl makes of a study's stability, and how it is told."""

from __future__ import annotations

import numpy as np

from fluid.friction import Friction
from leblanc.results.notes import self_excited as note_of
from leblanc.results.response import SelfExcited
from leblanc.scene.scene import dry_rotor, load_scene
from leblanc.studies.choose import prepare
from leblanc.studies.run import self_excited
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills


def found(growth: list[float], bands: tuple[tuple[float, float], ...]) -> SelfExcited:
    return SelfExcited(np.array(growth), np.array([50.0, 60.0, 70.0]), bands, "none")


@kills("leblanc.results.response:SelfExcited.leaves_stable", "self.growth > 0.0)", "self.growth >= 0.0)")
@kills("leblanc.results.response:SelfExcited.leaves_stable", "stable & ~(self", "stable | ~(self")
def test_stability() -> None:
    """Growing whirls take stability away, and give none back."""
    whirl = found([-1.0, 0.0, 0.5], ((80.0, 90.0),))
    stable = whirl.leaves_stable(np.array([True, False, True]))
    np.testing.assert_array_equal(stable, [True, False, False])
    np.testing.assert_array_equal(whirl.leaves_stable(np.ones(3, dtype=bool)), [True, True, False])


@kills("leblanc.results.notes:self_excited", "np.argmax(whirl", "np.argmin(whirl")
def test_words() -> None:
    """Edges and the fastest whirl in rpm."""
    text = note_of(found([-1.0, 0.25, 0.5], ((20.0 * np.pi, 30.0 * np.pi),))).text
    assert "600 to 900 rpm" in text and "668.5 rpm" in text and "0.5 1/s" in text
    assert note_of(found([-1.0, -1.0, 0.0], ())).text.startswith("No whirl")
    assert "not found" in note_of(found([np.nan, 0.0, 0.0], ())).text


@kills(
    "leblanc.studies.run:self_excited",
    "filled, known = [scene.fills], growth[None]",
    "filled, known = [scene.fills[:1]], None",
)
def test_rig() -> None:
    """The horizontal rig whirls just above its critical speed, slower than it spins."""
    whirl = self_excited(prepare(load_scene("examples/horizontal_rig.toml")))
    ((low, high),) = whirl.bands
    speed = load_scene("examples/horizontal_rig.toml").speed_array()
    grows = whirl.growth > 0.0
    assert 104.0 < low < 110.0 < high < 160.0
    np.testing.assert_array_equal(grows, (speed > low) & (speed < high))
    assert np.all(whirl.whirl_speed[grows] < speed[grows])
    # Refined edges: growth there is its slope, some 0.1 in a unit of speed, times 1e-8 of the speed.
    scene = load_scene("examples/horizontal_rig.toml")
    at_edges, _ = asynchronous_growth(dry_rotor(scene), scene.fills, [low, high], Friction("stokes"))
    assert np.all(np.abs(at_edges) < 1e-6)
