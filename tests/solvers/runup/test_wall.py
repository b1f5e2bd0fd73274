"""The law of the wall in time: spin-up of a lagging layer, its energy, and small waves, by both models."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import STOKES, Friction, damping_rate
from fluid.friction.pipe import friction_factor, hydraulic_diameter
from fluid.friction.wall import mean_rates
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import LinearCoupled, couple_linear
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import RunupModel
from solvers.runup.state import layer_drag, layer_properties, mean_area
from tests.fluid.friction.test_pipe import CASES

WALL = Friction("wall")  # type: ignore[arg-type]
RIGID = Jeffcott(1e6, 1e12, 0.0, 0.0)


def at_rest_in_space(model: RunupModel, fill: Fill, spin: float, cells: int = 8) -> Coupled | LinearCoupled:
    found = model(RIGID.system(), [fill], spin, WALL, 0.0, cells, False, False)
    if isinstance(found, LinearCoupled):
        found.machine.carried[:] = 0.0
    else:
        assert isinstance(found, Coupled)
        # No angular momentum: q + Omega A = 0 in each cell.
        found.state.momentum[:] = -spin * found.state.area
    return found


@pytest.mark.parametrize("model", [couple, couple_linear])
@pytest.mark.parametrize(("radius", "depth", "height", "nu", "spin", "wanted"), CASES)
def test_a_layer_at_rest_in_space_is_carried_along(
    model: RunupModel,
    radius: float,
    depth: float,
    height: float,
    nu: float,
    spin: float,
    wanted: tuple[float, float, float],
) -> None:
    """Lags of 50, 10 and 5 % are reached when the channel's law says.

    The long waves' mean rotation is u L/A, the law's lag u/(1 - A): a third of A^2 apart, 0.3 % for the
    thickest layer here.
    """
    volume = math.pi * height * (radius**2 - (radius - depth) ** 2)
    machine = at_rest_in_space(model, Fill(Chamber(radius, height), Liquid("it", 1000.0, nu), volume), spin)
    for share, time in zip((0.5, 0.1, 0.05), wanted, strict=True):
        assert machine.advance(time, 0.0, 0.8, 10**7) == Outcome.DONE
        assert -float(machine.read().mean_rotation[0]) / spin == pytest.approx(share, rel=0.01)


@pytest.mark.parametrize("model", [couple, couple_linear])
def test_its_energy_goes_into_heat(model: RunupModel) -> None:
    """Work of the drive is heat and what the layer gained."""
    fill = Fill(Chamber(0.15, 0.05), Liquid("water", 1000.0, 1e-6), 6.7e-4)
    # The linear layer's work takes the mean spin of a step: a hundred steps a turn leave 1e-5.
    for rate, closed in ((0.0, 1e-9), (5.0, 1e-9 if model is couple else 2e-5)):
        machine = at_rest_in_space(model, fill, 40.0)
        before = machine.energy()
        assert machine.advance(1.0, rate, 0.8, 10**6) == Outcome.DONE
        sums = machine.sums
        # What the long waves' profile misses while the spin changes is a part of its own.
        left = sums.drive - sums.profile - sums.friction - sums.bores - (machine.energy() - before)
        assert abs(left) < closed * sums.drive
        assert 0.2 * sums.drive < sums.friction < 0.8 * sums.drive


def seen_from_the_drum(machine: Coupled) -> float:
    """Energy in the drum's frame: that in space less Omega times the angular momentum."""
    ((layer, _, measures, _),) = machine.measured()
    return float(machine.energy() - machine.spin * layer.weight * layer.radius**4 * measures.spinning)


def test_small_waves_feel_their_own_part_of_the_law() -> None:
    """Decay of a wave a thousandth deep, beside Stokes' law and what the scheme alone takes."""
    fill = Fill(Chamber(0.15, 0.05), Liquid("water", 1000.0, 1e-6), 6.7e-4)
    rates = []
    for law in (WALL, Friction("stokes"), Friction()):  # type: ignore[arg-type]
        machine = couple(RIGID.system(), [fill], 40.0, law, 0.0, 64, False)
        rest = seen_from_the_drum(machine)
        machine.state.area[0] *= 1.0 + 1e-3 * np.cos(machine.theta)
        machine.state.momentum[0] = -40.0 * np.square(machine.state.area[0])
        start = seen_from_the_drum(machine) - rest
        assert machine.advance(1.0, 0.0, 0.8, 10**6) == Outcome.DONE
        rates.append(-math.log((seen_from_the_drum(machine) - rest) / start))
    layer, drag = layer_properties(fill, WALL, False), layer_drag(fill, WALL)
    assert drag is not None
    depth, area = fill.depth / 0.15, mean_area(fill)
    stokes, own = (
        float(damping_rate(STOKES, layer.coefficient * math.sqrt(40.0), lid, depth, area, 0.0))
        for lid in (layer.lid, layer.plates)
    )
    # So slow a motion is laminar, 8 nu/D_h (1/h + 2/h_c); the faded part lacks delta/h, 3 %.
    slow = float(mean_rates(drag, depth, area, 1e-9))
    faded = depth / (depth + layer.thin / math.sqrt(40.0))
    wanted = (own * faded + slow) / stokes
    assert wanted > 1.6
    assert (rates[0] - rates[2]) / (rates[1] - rates[2]) == pytest.approx(wanted, rel=0.01)


@pytest.mark.parametrize("model", [couple, couple_linear])
def test_without_viscosity_and_roughness_nothing_is_dragged(model: RunupModel) -> None:
    fill = Fill(Chamber(0.15, 0.05), Liquid("ideal", 1000.0, 0.0), 6.7e-4)
    machine = at_rest_in_space(model, fill, 40.0)
    assert machine.advance(1.0, 0.0, 0.8, 10**6) == Outcome.DONE
    assert machine.sums.friction == 0.0
    # The long waves' mean rotation, u L/A, is a third of A^2 off that of a solid layer.
    assert -float(machine.read().mean_rotation[0]) / 40.0 == pytest.approx(1.0, rel=5e-3)


def test_a_rough_wall_drags_by_the_quadratic_law() -> None:
    """Without viscosity the lag falls as 1/(1 + t/T), T = 2 D_h/(f_D Omega R)."""
    fill = Fill(Chamber(0.15, 0.05), Liquid("ideal", 1000.0, 0.0), 6.7e-4)
    rough, diameter = 1e-4, float(hydraulic_diameter(fill.depth, 0.05))
    machine = couple_linear(RIGID.system(), [fill], 40.0, Friction("wall", roughness=rough), 0.0, 64, False)  # type: ignore[arg-type]
    machine.machine.carried[:] = 0.0
    pace = 2.0 * diameter / (float(friction_factor(math.inf, rough / diameter)) * 40.0 * 0.15)
    assert machine.advance(3.0 * pace, 0.0, 0.8, 10**6) == Outcome.DONE
    # The table's 1e-4, and second order in a step of pace/20 or less.
    assert 1.0 - machine.machine.carried[0] / 40.0 == pytest.approx(0.25, rel=1e-3)
