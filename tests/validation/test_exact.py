"""The exact wave as the measure of the others: the kept numbers, and some of them again."""

from __future__ import annotations

import numpy as np
import pytest

from validation.exact import Cases, kept
from validation.exact.__main__ import choking
from validation.exact.answers import model_answers
from validation.exact.branch import detuning, end, held_waves
from validation.exact.long_wave import steady_long_wave


def test_folds_are_those_of_another_code() -> None:
    # Digits of an independent programme; parabolas through three heights keep seven.
    for layer, ratio, known in ((0.1, 1.1, 0.010372250), (0.3, 1.2, 0.052327347)):
        found = end(layer, ratio)
        assert found.fold and found.whirl == pytest.approx(known, rel=1e-6)


def test_small_long_waves_are_those_of_linear_theory() -> None:
    # G - m = (1 - m)/(1 - p^2/p_1^2), m = 1 - a^2, with L for tanh L in the resonance; the rest is w^2.
    layer, square = 0.3, 0.1
    log, mass = -np.log1p(-layer), layer * (2.0 - layer)
    for dispersion, tanh in ((False, log), (True, log * (15.0 + log**2) / (15.0 + 6.0 * log**2))):
        known = mass + (1.0 - mass) / (1.0 - square * (1.0 + tanh) / tanh)
        found = steady_long_wave(layer, square, 1e-5 * layer, dispersion)
        assert found.smooth and found.force_ratio == pytest.approx(known, rel=1e-7)


def test_kept_numbers_come_again() -> None:
    maps = kept().maps
    asked = (maps.layer == 0.1) & (maps.ratio > 1.2) & (maps.whirl == 0.01)
    row = int(np.flatnonzero(maps.smooth & asked)[0])
    layer, ratio, whirl = (float(values[row]) for values in (maps.layer, maps.ratio, maps.whirl))
    # Spectra end at 1e-8 and nodes depend on the way.
    assert held_waves(layer, ratio, (whirl,))[0].force_ratio == pytest.approx(maps.exact[row], rel=1e-8)
    for name, answer in model_answers(layer, ratio, whirl).items():
        assert answer == pytest.approx(maps.models[name][row], rel=1e-8), name


def test_through_time_the_long_waves_come_to_the_steady_ones() -> None:
    marched = kept().marched
    gap = np.abs(marched.force - marched.steady)
    coarse, fine = (gap[marched.cells == cells] for cells in (64, 256))
    # Second order: a sixteenth of the gap; a half of that order is left to the limiter at crests.
    assert np.all(fine < 0.25 * coarse) and np.median(fine / coarse) < 1.0 / 12.0
    assert marched.converged[marched.cells == 256].all()


def test_choking_is_near_the_kept_one() -> None:
    ends = kept().ends
    row = int(np.flatnonzero((ends.layer == 0.1) & (ends.ratio == 0.75))[0])
    assert choking(0.1, 0.75) == pytest.approx(ends.choked[row], rel=1e-6)
    # Just below it there is a wave, 3 % above it there is none.
    square = detuning(0.1, 0.75)
    assert steady_long_wave(0.1, square, 0.99 * ends.choked[row] * 0.1, False).converged
    assert not steady_long_wave(0.1, square, 1.03 * ends.choked[row] * 0.1, False).converged


def _twins(cases: Cases, name: str) -> float:
    both = cases.smooth & np.isfinite(cases.models[name]) & np.isfinite(cases.models[f"{name}_twin"])
    return float(np.nanmedian(cases.error(f"{name}_twin")[both] / cases.error(name)[both]))


def test_one_family_tells_twins_apart() -> None:
    # They are one wave to the exact equations; the faster whirl has the faster family, and the larger error.
    assert _twins(kept().maps, "kdv") > 1.5 and _twins(kept().maps, "whitham") > 1.5
