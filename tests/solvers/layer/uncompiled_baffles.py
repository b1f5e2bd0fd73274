"""Baffles as an internal condition, run as plain Python with seeded faults; see `uncompiled_layer`."""

from __future__ import annotations

import numpy as np

from fluid import long_wave as lw
from fluid.friction import baffles as law
from fluid.friction.wall import NO_TABLE
from solvers.layer import baffles, finite_volume
from solvers.layer.inside import Inside
from solvers.layer.records import Outcome, records
from solvers.layer.state import ring
from solvers.layer.step import calm
from solvers.runup import kernel
from solvers.runup.state import GAINS, LAYER, MEASURES
from tests.mutants import kills

SPIN = 1.3


def table(faces: list[int], tip: float, gap: float = 0.0, loss: float = -1.0) -> np.ndarray:
    rows = np.zeros((len(faces), baffles.COLUMNS))
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3] = faces, tip, gap, loss
    return rows


def middles(n: int) -> np.ndarray:
    return 2 * np.pi * (np.arange(n) + 0.5) / n


def rates(
    area: np.ndarray, q: np.ndarray, plates: np.ndarray, pull: float = 0.0, dt: float = 0.0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rates of A and q, and the fluxes of mass."""
    n = area.size
    step, d_area, d_q = 2 * np.pi / n, np.empty(n), np.empty(n)
    work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
    cell, face = pull * np.cos(middles(n)), pull * np.cos(middles(n) - 0.5 * step)
    finite_volume.rates(
        area, q, SPIN, 0.0, cell, face, Inside(plates, 1.0, 0.0), step, dt, False, work, d_area, d_q
    )
    return d_area, d_q, work[finite_volume._MASS, : n + 1].copy()


def wild(n: int) -> tuple[np.ndarray, np.ndarray]:
    theta = middles(n)
    area = 0.06 + 0.03 * np.cos(2 * theta) + np.where(np.arange(n) % 7 == 0, 0.02, 0.0)
    return area, (0.2 * np.sin(theta) - 0.1) * area - SPIN * area**2


@kills("solvers.layer.baffles:obstruct", "<= _DRY", "< 0.0")
def test_a_dry_face() -> None:
    """Where both cells beside a baffle are dry nothing passes, and no rate is lost."""
    area, q = wild(32)
    area[6:11], q[6:11] = 0.0, 0.0
    for height in (0.0, 0.05, 0.5):
        d_area, d_q, mass = rates(area, q, table([8], height), 0.1)
        assert np.isfinite(d_area).all() and np.isfinite(d_q).all() and mass[8] == 0.0


@kills("solvers.layer.baffles:obstruct", "open_ * (mass[i] - free)", "open_ * mass[i]")
@kills("solvers.layer.baffles:obstruct", "flow[i] - own_l - slope_l", "flow[i] - slope_l")
@kills("solvers.layer.baffles:obstruct", "flow[i] - own_r - slope_r", "flow[i] - slope_r")
@kills("solvers.layer.baffles:resistance", "share) - 1.0)", "share) - 0.9)")
def test_nothing_in_the_way() -> None:
    """Baffles without height are none, to rounding of the fluxes."""
    area, q = wild(32)
    bare = rates(area, q, table([], 0.0), 0.1)
    for plates in (table([0, 8, 21], 0.0), table([0, 8, 21], 0.3, 0.3), table([5], 0.05, loss=0.0)):
        for one, other in zip(rates(area, q, plates, 0.1), bare, strict=True):
            np.testing.assert_allclose(one, other, atol=1e-14)


@kills("solvers.layer.baffles:obstruct", "mass[n], flow[n] = through, flow_l", "pass")
@kills("solvers.layer.baffles:obstruct", "passed, open_ = 0.0, 0.0", "passed, open_ = 0.0, 1.0")
def test_compartments_keep_their_liquid() -> None:
    """Past closed baffles nothing goes, however the layer moves; next to dry walls as well."""
    n, faces = 32, [0, 8, 16, 24]
    area, q = wild(n)
    area[8:12], q[8:12] = 0.0, 0.0
    held = area.reshape(4, 8).sum(axis=1)
    for _ in range(40):
        d_area, d_q, mass = rates(area, q, table(faces, 0.4), 0.1, 0.02)
        assert np.all(mass[[0, 8, 16, 24, 32]] == 0.0)
        area, q = np.maximum(area + 0.02 * d_area, 0.0), q + 0.02 * d_q
        calm(area, q, SPIN)
    assert area.min() > -1e-15 and abs(area[12:16].sum()) > 1e-3
    np.testing.assert_allclose(area.reshape(4, 8).sum(axis=1), held, rtol=1e-13)


@kills("solvers.layer.baffles:take", "-= table[k, TORQUE]", "+= table[k, TORQUE]")
@kills("solvers.layer.baffles:obstruct", "flow_r = own_r", "flow_r = own_l")
def test_compartments_rest() -> None:
    """Levels that differ from one closed compartment to the next stay, with a force across the axis."""
    n, faces, pull = 32, [0, 8, 16, 24], 0.2
    head = np.repeat([0.05, 0.09, 0.12, 0.02], 8) * SPIN**2 + 0.2
    surface = lw.surface_at_head(head - 1.0 * 0.2, SPIN, pull * np.cos(middles(n)))
    area = 0.5 * (1 - surface**2)
    d_area, d_q, _ = rates(area, -SPIN * area**2, table(faces, 0.6), pull)
    wet = area > 0.0
    assert wet.sum() > 16
    # Rounding of the fluxes over the width of a cell.
    assert np.abs(d_area).max() < 1e-14 and np.abs(d_q).max() < 1e-14


@kills("solvers.layer.baffles:obstruct", "whole * whole + 4.0 * held", "whole * whole + 2.0 * held")
@kills("solvers.layer.baffles:obstruct", "whole = wave_l + wave_r", "whole = out_l - out_r")
@kills("solvers.layer.baffles:obstruct", "u_l - spin * area_l", "u_l + spin * area_l")
@kills("solvers.layer.baffles:obstruct", "+ area_r * wave_r", "- area_r * wave_r")
@kills("solvers.layer.baffles:resistance", "0.5 * lost * lost", "lost * lost")
@kills("fluid.friction.baffles:open_share", "held - tip", "tip")
def test_weak_flow() -> None:
    """A weak uniform flow loses K Q^2/(2 h^2) of its head; the two waves that this sends out say the rest."""
    area, n, face = 0.08, 16, 5
    depth, log = 1.0 - np.sqrt(1 - 2 * area), float(lw.layer_log(area))
    share = 1.0 - 0.05 / depth
    k = (1 / ((0.55 + 0.45 * share**1.8) * share) - 1) ** 2 / (2 * depth**2)
    wave = np.sqrt((SPIN * log) ** 2 + log * SPIN**2)
    for u in (1e-6, -1e-6):
        rest = np.full(n, area)
        plates = table([face], 0.05)
        d_area, d_q, mass = rates(rest, u * rest - SPIN * rest**2, plates)
        flow = u * log
        less = -k * flow * abs(flow) / (2 * wave / log)
        # Of second order in the flow; the next order is smaller by 1e-5.
        assert abs((mass[face] - flow) / less - 1) < 2e-5 / abs(u) * 1e-6 + 1e-4
        step = 2 * np.pi / n
        np.testing.assert_allclose([d_area[face - 1], d_area[face]], [-less / step, less / step], rtol=1e-3)
        # Waves leave at Omega L -+ c; the momentum in them is what the cells gain.
        gained = np.array([(SPIN * log - wave) * less, (SPIN * log + wave) * less])
        by_area = _momentum_in_wave(area, np.array([-wave, wave]))
        # dq = (dq/dA) dA, dA = dQ/lambda, and the flux changes by lambda dq.
        np.testing.assert_allclose(
            [d_q[face - 1], d_q[face]], [-by_area[0] * less / step, by_area[1] * less / step], rtol=1e-3
        )
        assert gained.shape == (2,)
        # The baffle takes A times the head that is lost.
        assert abs(plates[0, baffles.TORQUE] / (area * k * flow * abs(flow)) - 1) < 1e-3
        assert abs(plates[0, baffles.POWER] / (k * abs(flow) ** 3) - 1) < 1e-3


def _momentum_in_wave(area: float, half: np.ndarray) -> np.ndarray:
    """dq/dA of q = u A - Omega A^2 at rest along a wave, du/dA = Omega +- c/L."""
    log = float(lw.layer_log(area))
    return area * (SPIN + half / log) - 2.0 * SPIN * area


@kills("solvers.layer.baffles:resistance", "0.5 * row[LOSS]", "row[LOSS]")
def test_given_loss() -> None:
    """A coefficient given takes zeta u^2/2 times the mean depth from a flow of that depth."""
    area, u = 0.08, 1e-6
    depth, log = 1.0 - np.sqrt(1 - 2 * area), float(lw.layer_log(area))
    rest, plates = np.full(16, area), table([3], 0.05, loss=4.0 / depth)
    rates(rest, u * rest - SPIN * rest**2, plates)
    assert abs(plates[0, baffles.TORQUE] / (area * 4.0 * (u * log) ** 2 / (2 * depth**2)) - 1) < 1e-4
    assert law.CLOSED < 1e-3


@kills("solvers.runup.kernel:layer_step", "gains.torque -= 0.5 * dt * held", "pass")
@kills("solvers.runup.kernel:layer_step", "gains.baffles += 0.5 * dt * power", "pass")
@kills("solvers.runup.kernel:layer_step", "(spin * held + power)", "power")
@kills("solvers.layer.baffles:obstruct", "max(held, 0.0) * abs(passed) * passed * passed", "0.5 * abs(held)")
def test_gains() -> None:
    """The drum gets what the layer loses of angular momentum; its work goes into the layer and into heat."""
    n, spins = 32, np.array([SPIN, SPIN])
    area = 0.06 + 0.01 * np.cos(middles(n))
    q = -0.15 * area - SPIN * area**2
    gains, spare, ends = records(GAINS)[0], kernel.layer_scratch(1, n)[0], records(MEASURES, 2)
    kernel.measure(area, q, SPIN, ring(n), spare, ends[0])
    plates = table([0, 8, 16, 24], 0.03)
    done = kernel.layer_step(
        *(area, q, area[:0], spins, np.zeros(4), records(LAYER)[0], 0.0, 0.0, NO_TABLE, 0.02, ring(n)),
        *(Inside(plates, 1.0, 0.0), spare, gains),
    )
    assert done[0] == Outcome.DONE
    kernel.measure(area, q, SPIN, ring(n), spare, ends[1])
    gained = ends[1].spinning - ends[0].spinning
    assert gains.torque > 1e-7 and abs(gained - gains.torque) < 1e-13
    left = SPIN * gains.torque - gains.loss - gains.baffles - (ends[1].energy - ends[0].energy)
    assert abs(left) < 1e-13
    # The head lost at a plate works on the flow past it: the torque times the mean turning, and some more.
    turning = -0.15 * gains.torque
    assert 0.5 * abs(turning) < gains.baffles < 1.5 * abs(turning)
