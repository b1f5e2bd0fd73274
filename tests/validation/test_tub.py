"""The suspended tub of the source: its cases, its figures, and the example that is the same machine."""

from __future__ import annotations

import math

import numpy as np
import pytest

from leblanc.scene.scene import dry_rotor, load_scene
from solvers.rotor.tub import Tub
from solvers.rotor.vibration import critical_speeds, unbalance_response
from tests.mutants import kills
from validation.cases.rotors.tub import FARTHEST, amplitude, cases, direction, draw, plots, suspended_tub


def test_verdicts() -> None:
    verdicts = {case.name.partition("/")[2]: case.verdict for case in cases()}
    assert verdicts == {
        "supercritical": "agrees",
        "measured-amplitude": "differs",
        "angular-motion": "trend",
        "longitudinal-motion": "trend",
        "dg-spring-direction": "erratum",
        "dg-spring-projection": "erratum",
        "rigidity-centre": "trend",
        "dr-eq-10": "erratum",
    }


def test_the_example_is_the_machine_of_the_cases() -> None:
    example = dry_rotor(load_scene("examples/tub.toml"))
    ours = suspended_tub(FARTHEST)
    assert isinstance(example, Tub)
    # The example gives directions with six digits.
    for name in ("mass", "damping", "gyroscopic", "stiffness", "unbalance"):
        one, other = getattr(example.system(), name), getattr(ours.system(), name)
        np.testing.assert_allclose(one, other, atol=2e-6 * np.abs(other).max())


@kills(
    "validation.cases.rotors.tub:direction",
    "side * math.sin(turn)",
    "side * math.cos(angle) * math.sin(turn)",
)
@kills("validation.cases.rotors.tub:direction", "math.sin(angle) * flat", "math.sin(angle)")
def test_direction() -> None:
    """A unit vector, at its angle to the plane across the axis; on the other side half a turn about z."""
    for angle in (-1.2, 0.3, 1.3):
        for turn in (-0.6, 0.0, 0.8):
            one, other = (np.array(direction(angle, turn, side)) for side in (1.0, -1.0))
            assert np.linalg.norm(one) == pytest.approx(1.0, rel=1e-14)
            assert math.asin(one[1]) == pytest.approx(turn, abs=1e-14)
            assert math.atan2(one[2], one[0]) == pytest.approx(angle, rel=1e-13)
            np.testing.assert_allclose(other, one * [-1.0, -1.0, 1.0], atol=1e-15)


@kills("validation.cases.rotors.tub:direction", ", side * math.sin(turn)", ", math.sin(turn)")
def test_static_balance() -> None:
    """Turned springs that carry the weight leave no force along the axis and none across it."""
    machine = suspended_tub(0.0, 0.0, 0.5)
    pull = sum(np.array(one.direction) for one in machine.springs if one.coefficient > 0.0)
    np.testing.assert_allclose(pull[:2], 0.0, atol=1e-15)


@kills("validation.cases.rotors.tub:suspended_tub", "DAMPER - known.friction", "DAMPER + known.friction")
@kills("validation.cases.rotors.tub:suspended_tub", "SPRING - known.lateral", "SPRING + known.lateral")
def test_vertical_resonance() -> None:
    """In the middle everything up and down is one oscillator, 2 c (sin^2 75 + lateral share) over 60.7 kg."""
    machine, speed = suspended_tub(), np.linspace(2.0, 60.0, 50)
    stiffness = 2.0 * (4800.0 * math.sin(math.radians(75.0)) ** 2 + 1200.0)
    damping = 2.0 * (155.0 * math.sin(math.radians(70.0)) ** 2 + 20.0)
    closed = 0.185 * speed**2 / np.abs(stiffness - 60.7 * speed**2 + 1j * damping * speed)
    np.testing.assert_allclose(amplitude(machine, speed, "z"), closed, rtol=1e-12)
    assert np.min(np.abs(critical_speeds(machine.system())[0] - math.sqrt(stiffness / 60.7))) < 1e-9


def test_six_figures() -> None:
    assert len(plots()) == 6
    for plot in plots():
        axes = draw(plot).axes[0]
        assert len(axes.lines) == 4
        machine = plot.lines[1][1]
        x, y = axes.lines[1].get_data()
        k = 300
        system = machine.system()
        answer = np.abs(unbalance_response(system, [x[k] * math.pi / 30.0])[0])
        assert y[k] == pytest.approx(1e3 * answer[system.coordinates.index(plot.coordinate)], rel=1e-9)
        assert axes.get_ylim()[1] > max(line.get_ydata().max() for line in axes.lines)
