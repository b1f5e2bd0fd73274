"""The error that the hand-over of a pool leaves, and the band about the amplitude."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Handover, Ramp
from solvers.runup.runup import NUDGE, RunupNumerics, _over_a_turn, run_up
from tests.mutants import kills

FILL = Fill(Chamber(0.24, 0.06, baffles=Baffles(8, 0.231)), Liquid("brine", 1200.0, 1.6e-6), 1.2e-3)
# Critical at 26 rad/s, where the ring forms.
ROTOR = Jeffcott(60.0, 4.05e4, 309.0, 0.05)
RAMP = Ramp(4.0, 44.0, 8.0, 7.0)
NUMERICS = RunupNumerics(cells=32, samples=600, handover=Handover.CARRIED)
ROUGH = Friction("quadratic", 0.02)


@kills("solvers.runup.runup:run_up", "handover=Handover.DRUM", "handover=Handover.CARRIED")
@kills("solvers.runup.runup:_with_errors", "early.largest.max()", "history.largest.max()")
@kills("solvers.runup.runup:_band_of", "np.fmin.reduce(values)", "np.fmax.reduce(values)")
@kills("solvers.runup.runup:_formed", "reversed(run.transfers)", "run.transfers[:0]")
@kills("solvers.runup.runup:_with_errors", "band += np.interp", "band += 0.0 * np.interp")
@kills("solvers.runup.runup:_with_errors", "max(peaks) - min(peaks)", "max(peaks) + min(peaks)")
@kills("solvers.runup.runup:run_up", "alone(coarse, change)", "alone(coarse, 0.0 * change)")
@kills("solvers.runup.runup:_with_errors", "band = band + np.interp", "band = 0.0 * band + 0.0 * np.interp")
def test_band() -> None:
    """The three runs that it is made of, made one by one."""

    def alone(cells: int, handover: Handover, change: float = 0.0) -> np.ndarray:
        numerics = replace(NUMERICS, cells=cells, handover=handover, companion=False)
        system = ROTOR.system()
        system = replace(system, unbalance=system.unbalance * (1.0 + change))
        return _over_a_turn(run_up(system, [FILL], RAMP, ROUGH, 9.81, numerics, model=couple))

    found = run_up(ROTOR.system(), [FILL], RAMP, ROUGH, 9.81, NUMERICS, model=couple)
    assert found.ring_speed is not None
    ((low, high),) = found.ring_speed
    (formed,) = [each.speed for each in found.transfers if each.captured]
    # Fewer cells or the firmer grip make the ring earlier.
    assert low < 0.9 * formed and high == pytest.approx(formed, rel=1e-2)
    fine, coarse, early = alone(32, Handover.CARRIED), alone(16, Handover.CARRIED), alone(16, Handover.DRUM)
    largest = found.amplitude.max()
    assert found.handover_estimate == pytest.approx(np.abs(coarse - early).max() / largest, rel=1e-12)
    assert found.handover_estimate > 1e-3
    assert found.band is not None
    nudged = [alone(16, Handover.CARRIED, change) for change in (-NUDGE, NUDGE)]
    rounding = np.max([np.abs(coarse - run) for run in nudged], axis=0)
    # What next to nothing changes of the unbalance is next to nothing here, and more than rounding.
    assert 1e-14 < rounding.max() < 1e-6 * largest
    wanted = np.abs(fine - coarse) + np.abs(coarse - early) + rounding
    np.testing.assert_allclose(found.band, wanted, atol=1e-14)
    # The largest amplitudes are those of all steps, the others those of the samples, some tens a turn.
    peaks = [run.max() for run in (fine, coarse, early)]
    gaps = abs(peaks[0] - peaks[1]), abs(peaks[1] - peaks[2])
    np.testing.assert_allclose(found.peak_gaps[:2], gaps, atol=2e-3 * largest)
    several = [coarse.max(), *(run.max() for run in nudged)]
    assert found.peak_gaps[2] == pytest.approx(max(several) - min(several), rel=0.1)
    assert found.peak_gaps[1] > 1e-4 * largest


def test_none_where_nothing_is_handed_over() -> None:
    """No second hand-over is run without a pool that becomes a ring, nor under another rule."""
    smooth = replace(FILL, chamber=replace(FILL.chamber, baffles=None))
    for friction, handover in (
        (Friction(), Handover.CARRIED),
        (ROUGH, Handover.RIDING),
        (ROUGH, Handover.DRUM),
    ):
        numerics = replace(NUMERICS, handover=handover)
        found = run_up(ROTOR.system(), [smooth], RAMP, friction, 9.81, numerics, model=couple)
        assert math.isnan(found.handover_estimate) and found.band is not None
        assert (found.ring_speed is None) == (not any(each.captured for each in found.transfers))
        assert float(found.band.max()) <= 2.0 * found.error_estimate * float(found.amplitude.max()) + 1e-15


@kills("solvers.runup.runup:_over_a_turn", "run.angle + np.pi", "run.angle + 0.0 * np.pi")
def test_largest_within_a_turn() -> None:
    """Half a turn before and after, the ends included."""
    numerics = replace(NUMERICS, companion=False, samples=101)
    found = run_up(ROTOR.system(), [], Ramp(10.0, 11.0, 1.0, 2.0), numerics=numerics, model=couple_linear)
    slow = _over_a_turn(found)
    for k in range(found.time.size):
        near = np.abs(found.angle - found.angle[k]) <= math.pi * (1.0 + 1e-12)
        assert slow[k] == found.amplitude[near].max()
