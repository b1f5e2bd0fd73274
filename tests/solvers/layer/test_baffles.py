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
from solvers.layer.baffles import FACE, GAP, LOSS, TIP, table_of
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import couple
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
    assert table_of(layer(None), 64).shape == (0, 7)
    with pytest.raises(InputError):
        table_of(fill, 15)


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
    assert sums.baffles + sums.bores + sums.support == pytest.approx(lost, rel=1e-6)
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
