"""The exact wave under a whirl, period by period: small ones by linear theory, tall ones by other codes."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fluid import whirl as small
from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.liquid_model import Whirl
from solvers.potential.histories import film, simulate, whirl_push
from solvers.potential.in_time import Steps, WaveState
from solvers.potential.steady import forced
from tests.mutants import kills
from tests.oracles.exact import force_with_friction

WATER = Liquid("water", 1000.0, 1e-6)
FLOW = Path(__file__).parents[3] / "validation" / "data" / "openfoam_layer.json"


def layer(depth: float, radius: float = 0.15, height: float = 1.0, inner: float = 0.0) -> Fill:
    """A layer whose depth at rest is a share of the radius."""
    chamber = Chamber(radius, height, inner_radius=inner)
    return Fill(chamber, WATER, math.pi * height * radius**2 * depth * (2.0 - depth))


@kills("solvers.potential.histories:_Means._close", "1j * slip * momentum", "-1j * slip * momentum")
@kills("solvers.potential.histories:_Means._close", "2j * momentum - centre", "1j * momentum - centre")
@kills("solvers.potential.histories:_Means._balance", "2.0 * k * s.kept.kinetic", "k * s.kept.kinetic")
@kills("solvers.potential.histories:_Means._balance", "k * s.kept.turning", "2.0 * k * s.kept.turning")
def test_two_forces_and_three_budgets() -> None:
    """By pressure and by momentum, with the energy and the angular momentum that the force brings."""
    fill, spin = layer(0.3), 40.0
    motion = Whirl(spin, 1.4 * spin, 0.02 * fill.depth, ramp=20.0 / spin, gravity=0.002 * spin**2 * 0.15)
    for friction in (0.0, 0.2):
        found = simulate(fill, motion, 3.0 * motion.period, Steps(64, 256, friction=friction))
        periods = found.periods
        assert found.state is WaveState.RESOLVED and periods.converged and periods.force_ratio.size == 3
        assert np.abs(periods.force_ratio).min() > 0.1
        # The ramp's end is a corner of the third derivative within a panel of three.
        assert max(found.force_gap, found.energy_gap, found.turning_gap) < 1e-6 and found.drift < 1e-11
        np.testing.assert_allclose(periods.pressure_ratio, periods.force_ratio, atol=1e-6)


@kills("solvers.potential.histories:whirl_push", "whirl.speed**2 * whirl.amplitude", "whirl.amplitude")
@kills("solvers.potential.histories:_history", "(whirl.speed / spin) ** 2", "(whirl.speed / spin)")
def test_a_small_whirl_with_friction() -> None:
    """Its last period by linear theory: force, offset and the waves' height, for lengths in m."""
    fill, spin, rate = layer(0.1), 30.0, 0.4
    motion = Whirl(spin, 0.75 * spin, 1e-5 * fill.depth, ramp=30.0 / spin)
    periods = simulate(fill, motion, 5.0 * motion.period, Steps(32, 32, friction=rate)).periods
    square = (fill.surface_radius / fill.chamber.radius) ** 2
    given = (1.0 - square) / (1.0 + square), spin, motion.speed, rate * spin
    # The slower free wave has died to e^{-0.13 * 70}.
    assert complex(periods.force_ratio[-1]) == pytest.approx(complex(force_with_friction(*given)), abs=1e-3)
    assert complex(periods.offset[-1]) == pytest.approx(
        complex(small.offset_with_friction(*given)) * motion.amplitude, abs=1e-3 * motion.amplitude
    )
    # Half the wave's height at the surface goes with the offset: V c = pi a^2 eta of one crest.
    lifted = abs(periods.offset[-1]) * fill.depth * (2.0 * 0.15 - fill.depth) / fill.surface_radius**2
    assert (periods.depth_max - periods.depth_min)[-1] == pytest.approx(2.0 * lifted, rel=0.05)
    assert abs(periods.theta[np.argmax(periods.depth)] - np.angle(periods.offset[-1])) < 0.2


def test_resonance_of_a_computed_flow() -> None:
    """The whirl with the backward free wave: periods before it breaks, of two other codes and the flow."""
    run = next(case for case in json.loads(FLOW.read_text())["cases"] if "time" in case)
    fill = layer(0.1)
    motion = Whirl(run["speed"], run["whirl_speed"], run["whirl_amplitude"], run["ramp"])
    found = simulate(fill, motion, 2.0 * motion.period, Steps(128, 512))
    force = found.periods.force_ratio
    assert found.state is WaveState.RESOLVED and found.force_gap < 1e-8
    # Three digits of another code for the same equations.
    assert force[:2] == pytest.approx([0.268 + 0.299j, 0.482 + 1.990j], abs=6e-4)
    # The flow has a wall without slip, and is known to 3 %.
    flow = np.array([complex(*pair) for pair in run["force_ratio"][:2]])
    assert np.abs(force / flow - 1.0).max() < 0.035


@pytest.mark.slow
def test_resonance_ends_where_the_crest_breaks() -> None:
    """Between 65 and 67/Omega, whatever nodes it may have; long waves with dispersion agree until then."""
    from solvers.layer.state import Numerics
    from solvers.pypde.settle import simulate as long_waves

    fill = layer(0.1)
    motion = Whirl(40.0, 40.0 - 9.424119343577846, 0.05 * fill.depth, 0.6)
    found = simulate(fill, motion, 4.0 * motion.period, Steps(128, 2048, damping=2.0))
    assert found.state is WaveState.BROKEN and "crest breaks" in found.periods.reason
    assert found.periods.force_ratio.size == 2 and not found.periods.converged
    assert 1.4 < found.crest < 1.55 and 0.65 < found.crest_number < 0.7 and found.drift < 1e-6
    numerics = Numerics(256, dispersion=True)
    other = long_waves(fill, motion, 2.0 * motion.period, numerics=numerics).force_ratio
    assert np.abs(other / found.periods.force_ratio - 1.0).max() < 2e-2


def test_a_smooth_wave_settles_on_the_steady_one() -> None:
    """Off resonance, with a little friction for the free waves that the ramp stirs."""
    fill, spin = layer(0.3), 40.0
    motion = Whirl(spin, 0.85 * spin, 0.05 * fill.depth, ramp=60.0 / spin)
    found = simulate(fill, motion, 3.0 * motion.period, Steps(64, 256, friction=0.1))
    wanted = forced(0.3, (1.0 - 1.0 / 0.85) ** 2, 0.05 * 0.3)
    # The friction turns and shortens it by its square and itself, of the distance from resonance.
    assert found.periods.force_ratio[-1].real == pytest.approx(wanted.force_ratio, rel=0.02)
    assert found.crest == pytest.approx(wanted.crest, rel=0.02)


@kills(
    "solvers.potential.histories:film", "interval * np.arange(1, frames)", "interval * np.arange(frames - 1)"
)
def test_film() -> None:
    """Pictures hold the liquid, begin with the layer at rest, and show what the history tells."""
    fill = layer(0.1)
    motion = Whirl(40.0, 52.0, 0.02 * fill.depth, 0.3)
    pictures = film(fill, motion, frames=9, periods=1.0, steps=Steps(64, 128))
    assert pictures.depth.shape == (9, 256)
    np.testing.assert_allclose(pictures.depth[0], fill.depth, rtol=1e-12)
    # Even angles and a surface that is smooth: the sum is exact.
    area = np.mean(pictures.depth * (0.15 - 0.5 * pictures.depth), axis=1) * 2.0 * math.pi
    np.testing.assert_allclose(area, fill.volume, rtol=1e-9)
    np.testing.assert_allclose(pictures.time, np.arange(9) * motion.period / 9.0)
    assert abs(pictures.deflection[-1]) == pytest.approx(motion.amplitude) and pictures.deflection[0] == 0.0
    few = film(fill, motion, frames=3, periods=1.0, steps=Steps(64, 128))
    # Within steps of 0.3 by a formula of seventh order.
    np.testing.assert_allclose(few.depth, pictures.depth[::3], atol=1e-9 * 0.15)
    again = film(fill, motion, frames=1, periods=1.0)
    assert again.depth.shape == (1, 256)


def test_the_inner_wall_ends_it() -> None:
    fill = layer(0.1, inner=0.15 * 0.87)
    motion = Whirl(40.0, 40.0 - 9.424, 0.05 * fill.depth, 0.6)
    found = simulate(fill, motion, 3.0 * motion.period, Steps(64, 256))
    assert found.state is WaveState.BROKEN and "inner wall" in found.periods.reason
    assert found.crest == pytest.approx(1.3, abs=0.02)


def test_units() -> None:
    """Twice the radius and half the spin: the same ratios."""
    kept = []
    for radius, spin in ((0.15, 40.0), (0.3, 20.0)):
        fill = layer(0.2, radius)
        motion = Whirl(spin, 1.5 * spin, 0.02 * fill.depth, 10.0 / spin)
        kept.append(simulate(fill, motion, motion.period, Steps(64, 64)).periods)
    assert kept[1].force_ratio[0] == pytest.approx(kept[0].force_ratio[0], rel=1e-9)
    np.testing.assert_allclose(kept[1].depth, 2.0 * kept[0].depth, rtol=1e-8)
    assert kept[1].mean_rotation[0] == pytest.approx(0.5 * kept[0].mean_rotation[0], rel=1e-6)


def test_force_of_whirl_and_gravity() -> None:
    fill = layer(0.1)
    push = whirl_push(fill, Whirl(10.0, 12.0, 0.003, gravity=9.81))
    unit = 100.0 * 0.15
    assert push(0.0) == pytest.approx((144.0 * 0.003 - 9.81j) / unit, rel=1e-13)
    assert push(math.pi) == pytest.approx((144.0 * 0.003 * np.exp(0.2j * math.pi) + 9.81j) / unit, rel=1e-13)


def test_bad_input() -> None:
    fill, motion = layer(0.1), Whirl(10.0, 12.0, 0.001)
    with pytest.raises(InputError, match="volume"):
        simulate(replace(fill, volume=0.0), motion, 1.0)
    with pytest.raises(InputError, match="duration"):
        simulate(fill, motion, 0.0)
    with pytest.raises(InputError, match="frames"):
        film(fill, motion, 0, 1.0)
