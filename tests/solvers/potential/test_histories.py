"""The exact wave under a prescribed whirl, in SI units: computed flow, linear theory, gravity, honest ends."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fluid import whirl
from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.chamber import Baffles, Chamber
from meshes.errors import InputError
from solvers.liquid_model import Whirl
from solvers.potential.histories import film, simulate
from solvers.potential.in_time import Steps, WaveState
from solvers.potential.steady import forced
from tests.mutants import kills

FLOW = Path(__file__).parents[3] / "validation" / "data" / "openfoam_layer.json"
# tanh L of a layer of a tenth.
TANH = (1.0 - 0.81) / (1.0 + 0.81)
WATER = Liquid("water", 998.0, 1e-6)


def ring(layer: float, radius: float = 0.15, inner: float = 0.0) -> Fill:
    """A layer of this depth over the radius in a chamber 10 mm high."""
    chamber = Chamber(radius, 0.01, inner_radius=inner)
    return Fill(chamber, WATER, math.pi * radius**2 * layer * (2.0 - layer) * 0.01)


def computed(name: str) -> dict[str, Any]:
    """A case of the computed flow."""
    return next(case for case in json.loads(FLOW.read_text())["cases"] if case["name"] == name)


@kills("solvers.potential.histories:whirl_push", "size * share", "0.98 * size * share")
def test_resonance_beside_computed_flow() -> None:
    """A whirl at the free wave: means of the first whirls of two-phase flow with a wall that holds it.

    The flow's own error is 3 % before it breaks; its wall takes a little more. An exact wave of another code
    has 0.268+0.299i and 0.482+1.990i.
    """
    case = computed("C_0.05_f1")
    motion = Whirl(case["speed"], case["whirl_speed"], case["whirl_amplitude"], case["ramp"])
    found = simulate(ring(0.1), motion, 1.67)
    assert found.state is WaveState.RESOLVED and found.periods.converged
    np.testing.assert_allclose(found.periods.force_ratio, [0.268 + 0.299j, 0.482 + 1.990j], atol=8e-4)
    wanted = np.array([complex(*pair) for pair in case["force_ratio"][:2]])
    np.testing.assert_allclose(found.periods.force_ratio, wanted, rtol=0.04)
    # The flow's is the greatest of the period, with the same error of 1 %.
    assert 0.015 * found.crest == pytest.approx(case["depth_max"][1], rel=0.01)
    # Momentum and pressure by quite different sums; 8 points in a panel of 3/Omega integrate to 1e-9.
    assert found.force_gap < 1e-8 and found.energy_gap < 1e-7 and found.turning_gap < 1e-7
    assert found.drift < 1e-12 and found.nodes > 128


def test_twice_as_large_a_machine() -> None:
    """Another radius and speed with the same numbers over R and Omega: the same answer over its own units."""
    first = simulate(ring(0.1), Whirl(40.0, 30.0, 2e-4, 0.3), 1.2, Steps(64))
    other = simulate(ring(0.1, 0.3), Whirl(20.0, 15.0, 4e-4, 0.6), 2.4, Steps(64))
    np.testing.assert_allclose(other.periods.force_ratio, first.periods.force_ratio, atol=1e-12)
    np.testing.assert_allclose(other.periods.offset, 2.0 * first.periods.offset, atol=1e-15)
    np.testing.assert_allclose(other.periods.mean_rotation, 0.5 * first.periods.mean_rotation, atol=1e-13)
    np.testing.assert_allclose(other.periods.time, 2.0 * first.periods.time)


def test_small_whirl_settles_where_linear_theory_is() -> None:
    """With a gentle ramp, and friction in which all else dies."""
    rate = 0.1
    found = simulate(ring(0.1), Whirl(40.0, 52.0, 1.5e-6, 0.5), 5.0, Steps(32, 64, friction=rate))
    wanted = complex(whirl.force_with_friction(TANH, 1.0, 1.3, rate))
    # What the ramp has stirred has died by exp(-9); the square of the whirl over the depth is 1e-8.
    assert found.periods.force_ratio[-1] == pytest.approx(wanted, abs=1e-3)


@kills("solvers.potential.histories:whirl_push", "- 1j * weight", "+ 1j * weight")
def test_gravity_across_the_axis() -> None:
    """Beside a whirl that hardly turns and hardly is: the liquid lies above, as the linear theory has it."""
    gravity, spin, rate = 1.2, 40.0, 0.1
    motion = replace(Whirl(spin, 1e-9 * spin, 1e-9), gravity=gravity)
    found = simulate(ring(0.1), motion, 5.0, Steps(32, 64, friction=rate))
    # A whirl at 1e-4 of the spin with the force of gravity; that points along -y, the deflection along x.
    slow = 1e-4
    wanted = complex(whirl.offset_with_friction(TANH, 1.0, slow, rate)) / slow**2
    # Gravity sets in at once; the waves of that have died by exp(-9) or so, second order is (g/Omega^2 R)^2.
    assert found.periods.offset[-1] / (gravity / spin**2) == pytest.approx(-1j * wanted, abs=1e-3)
    assert wanted == pytest.approx(-0.405, abs=0.05)


def test_a_wave_that_breaks_ends_it() -> None:
    """Twice as hard as the computed flow: periods up to the breaking, and no force beyond."""
    case = computed("C_0.05_f1")
    motion = Whirl(case["speed"], case["whirl_speed"], 4.0 * case["whirl_amplitude"], case["ramp"])
    found = simulate(ring(0.1), motion, 4.0, Steps(128, 512))
    assert found.state is WaveState.BROKEN and not found.periods.converged and found.periods.reason
    assert 1 <= found.periods.time.size < 6 and np.isfinite(found.periods.force_ratio).all()
    shots = film(ring(0.1), motion, 60, 6.0, Steps(128, 512))
    assert 1 < shots.time.size < 60 and shots.depth.shape == (shots.time.size, shots.theta.size)


def test_the_crest_comes_to_an_inner_wall() -> None:
    """A gap a tenth deeper than the layer, and a crest of more than that."""
    case = computed("C_0.05_f1")
    motion = Whirl(case["speed"], case["whirl_speed"], case["whirl_amplitude"], case["ramp"])
    found = simulate(ring(0.1, inner=0.15 * 0.89), motion, 1.67)
    assert not found.periods.converged and "inner wall" in found.periods.reason
    assert found.crest > 1.1


def test_film() -> None:
    """It begins with the even layer and shows the wave that the history has at its end, volume and all."""
    motion, fill = Whirl(40.0, 52.0, 3e-4, 0.2), ring(0.1)
    period = motion.period
    shots = film(fill, motion, 8, 2.0, Steps(64))
    np.testing.assert_allclose(shots.depth[0], fill.depth, rtol=1e-12)
    np.testing.assert_allclose(np.diff(shots.time), 0.25 * period, rtol=1e-12)
    # The mean of R^2 - r^2 over equal angles is exact for a smooth surface.
    volume = 0.5 * np.mean(0.15**2 - np.square(0.15 - shots.depth), axis=1) * 2.0 * np.pi * 0.01
    np.testing.assert_allclose(volume, fill.volume, rtol=1e-9)
    assert abs(shots.deflection[-1]) == pytest.approx(3e-4, rel=1e-12)


def test_steady_wave_is_where_time_leads() -> None:
    """A whirl that grows gently over many of its turns arrives at the wave of Newton's method."""
    motion = Whirl(40.0, 20.0, 3e-4, 4.0)
    found = simulate(ring(0.1), motion, 5.0, Steps(64, 128))
    wave = forced(0.1, 1.0, 3e-4 / 0.15)
    # What the ramp stirs goes with its third power.
    assert found.periods.force_ratio[-1] == pytest.approx(wave.force_ratio, abs=2e-3)


@pytest.mark.parametrize(
    ("field", "fill"),
    [
        ("volume", replace(ring(0.1), volume=0.0)),
        ("baffles", replace(ring(0.1), chamber=Chamber(0.15, 0.01, baffles=Baffles(4, 0.14)))),
    ],
)
def test_what_it_does_not_serve(field: str, fill: Fill) -> None:
    with pytest.raises(InputError, match=field):
        simulate(fill, Whirl(40.0, 52.0, 1e-4), 1.0)


def test_bad_input() -> None:
    motion = Whirl(40.0, 52.0, 1e-4)
    with pytest.raises(InputError, match="duration"):
        simulate(ring(0.1), motion, 0.0)
    with pytest.raises(InputError, match="frames"):
        film(ring(0.1), motion, 0, 1.0)
