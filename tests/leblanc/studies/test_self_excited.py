"""What self-excited whirl makes of a study's stability, and how it is told."""

from __future__ import annotations

import numpy as np

from fluid.friction import Friction
from leblanc.results.record import SelfExcited
from leblanc.scene.machine import dry_rotor
from leblanc.scene.scene import load_scene
from leblanc.studies.run import describe_whirl, self_excited, stable_with
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills


def found(growth: list[float], bands: tuple[tuple[float, float], ...]) -> SelfExcited:
    return SelfExcited(np.array(growth), np.array([50.0, 60.0, 70.0]), bands, "none")


@kills("leblanc.studies.run:stable_with", "found.growth > 0.0)", "found.growth >= 0.0)")
@kills("leblanc.studies.run:stable_with", "stable & ~(found", "stable | ~(found")
def test_stability() -> None:
    """Growing whirls take stability away, and give none back."""
    whirl = found([-1.0, 0.0, 0.5], ((80.0, 90.0),))
    stable = stable_with(whirl, np.array([True, False, True]))
    np.testing.assert_array_equal(stable, [True, False, False])
    np.testing.assert_array_equal(stable_with(whirl, np.ones(3, dtype=bool)), [True, True, False])


@kills("leblanc.studies.run:describe_whirl", "np.argmax(found.growth)", "np.argmin(found.growth)")
@kills("leblanc.studies.run:describe_whirl", "{high * RPM:.5g} rpm", "{high:.5g} rpm")
def test_words() -> None:
    """Edges and the fastest whirl in rpm."""
    text = describe_whirl(found([-1.0, 0.25, 0.5], ((20.0 * np.pi, 30.0 * np.pi),)))
    assert "600 to 900 rpm" in text and "668.5 rpm" in text and "0.5 1/s" in text
    assert describe_whirl(found([-1.0, -1.0, 0.0], ())).startswith("No whirl")
    assert "not found" in describe_whirl(found([np.nan, 0.0, 0.0], ()))


@kills(
    "leblanc.studies.run:self_excited",
    "unstable_bands(system, [scene.chambers], speed, friction, growth[None])",
    "unstable_bands(system, [scene.chambers], speed, (0, 0.0), growth[None])",
)
def test_rig() -> None:
    """The horizontal rig whirls just above its critical speed, slower than it spins."""
    whirl = self_excited(load_scene("examples/horizontal_rig.toml"))
    ((low, high),) = whirl.bands
    speed = load_scene("examples/horizontal_rig.toml").speed_array()
    grows = whirl.growth > 0.0
    assert 104.0 < low < 110.0 < high < 160.0
    np.testing.assert_array_equal(grows, (speed > low) & (speed < high))
    assert np.all(whirl.whirl_speed[grows] < speed[grows])
    # Refined edges: growth there is its slope, some 0.1 in a unit of speed, times 1e-8 of the speed.
    scene = load_scene("examples/horizontal_rig.toml")
    system = dry_rotor(scene).system()
    at_edges, _ = asynchronous_growth(system, scene.chambers, [low, high], Friction("stokes"))
    assert np.all(np.abs(at_edges) < 1e-6)
