"""The fill sweep of a real machine: what the file says and what is claimed of it."""

from __future__ import annotations

import numpy as np

from validation.cases.fill_sweep import cases, model_curves
from validation.cases.rigs import data


def test_the_measured_sweep_has_the_shape_that_is_claimed() -> None:
    measured = data("fill_sweep.json")
    added = measured["added_ml"]
    assert added == [0, 50, 100, 150, 200, 250, 300]
    assert np.all(np.diff(measured["resonance_peak"]) < 0)
    assert added[int(np.argmin(measured["peak"]))] == 250
    assert added[int(np.argmin(measured["cruise_mean"]))] == 0


def test_verdicts_follow_from_the_curves() -> None:
    """Every effect is off by more than a factor of two, so not even a trend is met."""
    found = {one.name: one for one in cases()}
    assert set(found) == {f"fill_sweep/{name}" for name in ("resonance-peak", "peak", "cruise", "order")}
    assert all(case.verdict == "differs" for case in found.values())
    volume, runup, resonance, cruise = model_curves()
    fall = found["fill_sweep/resonance-peak"].effect
    assert fall is not None
    # 3043/27742 measured; with this machine the peak is hardly less.
    assert round(fall.measured, 2) == 0.11 and round(fall.computed, 2) == 0.94
    assert np.all(np.diff(resonance) < 0.0) and volume[int(np.argmin(resonance))] == 300.0
    # At cruise the liquid of the model does no harm, where that of the real machine did.
    assert cruise[-1] < cruise[0]
    # More liquid than covers the wall changes nothing there: the same to rounding.
    np.testing.assert_allclose(cruise[-3:], cruise[-1], rtol=1e-9)
    assert runup.min() < runup[0]
