"""At the ends of what may be asked the wave models answer or say no: no nan, no lost mass."""

from __future__ import annotations

import math

import pytest

from tests.extremes.waves import Extreme, extremes, outcome

CASES = list(extremes("long_wave"))


def check(case: Extreme) -> bool:
    found = outcome(case)
    assert found.finite
    # Rounding of a sum over the cells and of as many steps' fluxes, which cancel in pairs.
    assert found.mass_error < 1e-12
    assert found.least_depth >= 0.0
    if not found.converged:
        assert found.says
    else:
        assert math.isfinite(found.force)
    return found.converged


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_long_wave(case: Extreme) -> None:
    converged = check(case)
    # All have an answer but those whose whirl takes half of what the layer leaves free.
    assert converged == (case.depth < 0.9 or case.amplitude < 0.01)
