"""Baffles in the compiled long waves: compartments, budgets, and the table of the faces."""

from __future__ import annotations

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.baffles import COLUMNS, DENSITY, FACE, GAP, LOSS, TIP, table_of
from solvers.layer.places import fewest_cells
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import Coupled, couple
from tests.mutants import kills

WATER = Liquid("water", 1000.0, 1e-6)


def layer(baffles: Baffles | None, volume: float = 8e-4, inner: float = 0.0) -> Fill:
    return Fill(Chamber(0.15, 0.05, inner, baffles=baffles), WATER, volume)


@kills("solvers.layer.baffles:table_of", "1.0 - plates.tip_radius / radius", "plates.tip_radius / radius")
@kills("solvers.layer.baffles:table_of", "plates.angles * cells", "plates.angles * 2.0 * cells")
@kills("solvers.layer.baffles:table_of", "plates.loss * radius", "plates.loss")
def test_table() -> None:
    """Baffles stand at the nearest faces; lengths are over the wall's radius."""
    fill = layer(Baffles(4, 0.12, 0.003, 0.01, loss=2.0))
    table = table_of(fill, 64)
    assert list(table[:, FACE]) == [0, 16, 32, 48]
    np.testing.assert_allclose(table[:, TIP], 0.2)
    np.testing.assert_allclose(table[:, GAP], 0.02)
    np.testing.assert_allclose(table[:, LOSS], 2.0 / (fill.depth / 0.15))
    assert table_of(layer(None), 64).shape == (0, COLUMNS)
    (row,) = table_of(fill, 15)
    assert row[FACE] == -1.0 and row[DENSITY] == pytest.approx(4 / (2 * np.pi)) and row[TIP] == table[0, TIP]
    with pytest.raises(InputError, match="16 or more"):
        table_of(layer(Baffles(4)), 15)
    assert fewest_cells([fill]) == 8 and fewest_cells([fill, layer(Baffles(12))]) == 48


def lagged(baffles: Baffles, lag: float, cells: int) -> Coupled:
    """A layer at 30 rad/s that lags by a share of it, on a rotor that hardly moves."""
    machine = couple(
        Jeffcott(3.0, 3e4, 40.0, 1e-12).system(), [layer(baffles)], 30.0, Friction(), 0.0, cells, False
    )
    area = machine.state.area
    machine.state.momentum[:] = -lag * 30.0 * area * (1 - area) - 30.0 * area**2
    return machine


@kills("solvers.layer.baffles:table_of", "plates.count / (2.0 * math.pi)", "plates.count / math.pi")
def test_smeared_as_at_their_places() -> None:
    """At a small lag eight baffles decelerate a layer alike as a sink and each at its face.

    The layer piles up by zeta u^2/(4 g) before each, 1e-3 of its depth at a lag of 0.02 and zeta about 1:
    what the two know differently of that, and of the waves between the baffles, is as small.
    """
    lags = []
    for cells in (24, 128):
        machine, found = lagged(Baffles(8, 0.145), 0.02, cells), []
        for stop in (0.5, 2.0, 8.0):
            assert machine.advance(stop, 0.0, 0.8, 10**6) == Outcome.DONE
            found.append(-float(machine.read().mean_rotation[0]))
        lags.append(found)
    assert lags[0][0] > 1.3 * lags[0][2] and lags[0][2] < 0.5 * 0.02 * 30.0
    np.testing.assert_allclose(lags[0], lags[1], rtol=1e-3)


def test_smeared_budgets() -> None:
    """A sink's momentum goes to the drum; its heat and the drum's work close the energy."""
    machine = lagged(Baffles(8, 0.145), 0.15, 24)
    (one, _, before, _), start = machine.measured()[0], machine.energy()
    assert machine.advance(0.3, 0.0, 0.8, 10**6) == Outcome.DONE
    _, _, after, _ = machine.measured()[0]
    sums, scale = machine.sums, one.weight * one.radius**4
    impulse = scale * (after.spinning - before.spinning)
    assert impulse > 0.02 * scale * abs(before.spinning)
    assert sums.drive == pytest.approx(30.0 * impulse, rel=1e-10)
    # Of second order in the step: some 40 steps in the time the lag takes to fall by half.
    lost = sums.drive - (machine.energy() - start)
    assert sums.baffles == pytest.approx(lost, rel=2e-3) and sums.baffles > 0.0
    assert sums.baffles + sums.lost + sums.support == pytest.approx(lost, rel=1e-6)
    # What the step takes too much there the scheme gives back: that is no heat.
    assert sums.lost < 0.0 <= sums.bores < 2e-3 * lost


def test_budgets() -> None:
    """What the baffles take of the angular momentum the drum gets; the energy is accounted for."""
    rotor = Jeffcott(3.0, 3e4, 40.0, 1e-12)
    machine = couple(rotor.system(), [layer(Baffles(4, 0.145))], 30.0, Friction(), 0.0, 64, False)
    area = machine.state.area
    machine.state.momentum[:] = -0.15 * 30.0 * area * (1 - area) - 30.0 * area**2
    (one, _, before, _), start = machine.measured()[0], machine.energy()
    assert machine.advance(0.2, 0.0, 0.4, 10**6) == Outcome.DONE
    _, _, after, _ = machine.measured()[0]
    sums, scale = machine.sums, one.weight * one.radius**4
    impulse = scale * (after.spinning - before.spinning)
    assert impulse > 0.02 * scale * before.spinning
    # Momentum to rounding of some hundred steps; the drive's work is that of its torque.
    assert sums.drive == pytest.approx(30.0 * impulse, rel=1e-10)
    # Heat at the baffles is what is lost: bores and the scheme take the rest, none of it made from nothing.
    lost = sums.drive - (machine.energy() - start)
    assert sums.baffles + sums.lost + sums.support == pytest.approx(lost, rel=1e-6)
    assert 0.5 * lost < sums.baffles < lost and sums.bores > 0.0
    assert machine.mass_error() < 1e-13


def test_compartments_slosh() -> None:
    """Closed baffles part the ring: the first wave between two of them has its closed form.

    u = 0 at both ends of [0, Phi] and waves at Omega L +- c give omega = pi L Omega^2/(c Phi).
    """
    found = []
    for cells in (64, 128):
        machine = couple(
            Jeffcott(3.0, 3e9, 0.0, 0.0).system(), [layer(Baffles(4))], 30.0, Friction(), 0.0, cells, False
        )
        area = machine.state.area
        theta = 2 * np.pi * (np.arange(cells) + 0.5) / cells
        area += 2e-4 * np.cos(2 * theta)
        machine.state.momentum[:] = -30.0 * area**2
        log = -0.5 * np.log(1 - 2 * area.mean())
        wave = np.sqrt((30.0 * log) ** 2 + log * 30.0**2)
        period = 2.0 * wave * (np.pi / 2) / (log * 30.0**2)
        quarter = cells // 4
        ends = []
        for k in range(1, 81):
            assert machine.advance(k * period / 40, 0.0, 0.8, 10**6) == Outcome.DONE
            # The first cosine of one compartment's profile.
            ends.append(machine.state.area[0, :quarter] @ np.cos(2 * theta[:quarter]))
        swing = np.array(ends)
        crossings = np.flatnonzero(np.diff(np.sign(swing)))
        times = crossings + swing[crossings] / (swing[crossings] - swing[crossings + 1]) + 1.0
        found.append(abs(np.diff(times).mean() * 2 / 40 - 1))
        whole = machine.state.area.reshape(4, quarter).mean(axis=1)
        np.testing.assert_allclose(whole, area.mean(), rtol=1e-9)
    assert found[1] < 0.01, found
