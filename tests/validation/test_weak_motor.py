"""The example of the weak motor does what its page says, on a coarse mesh."""

from __future__ import annotations

from leblanc.scene.examples import example
from validation.cases.rotors.weak_motor import with_and_without


def test_liquid_takes_a_weak_motor_through_the_resonance() -> None:
    scene = example("weak_motor")
    assert scene.runup is not None
    wet, dry = with_and_without(scene.altered(runup=scene.runup.altered(cells=32, samples=600)))
    # It hangs where the vibration eats what the motor has: below the resonance at 25 rad/s.
    assert 24.0 < dry.speed[-1] < 25.0
    assert abs(dry.speed[-1] - dry.speed[-100]) < 1e-3
    assert wet.speed[-1] > 60.0
    assert wet.converged and dry.converged
