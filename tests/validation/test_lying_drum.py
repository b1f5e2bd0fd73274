"""The horizontal drum beside computed flow and makers' statements."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from validation.case import Case
from validation.cases.liquid import lying_drum


@cache
def found() -> dict[str, Case]:
    """All cases by name."""
    return {case.name.partition("/")[2]: case for case in lying_drum.cases()}


def test_what_agrees_and_what_differs() -> None:
    """The computed flow up and down and the makers' rule; beyond 25 rad/s weight pulls back too much."""
    differs = {name for name, case in found().items() if case.verdict == "differs"}
    assert differs == {"half_9", "gravity"}


def test_balances() -> None:
    """Mass to rounding, energy to the steps, in every run."""
    for name in ("L6", "L6d", "L9", "L0"):
        run = lying_drum.own(name)
        assert run.mass_error < 1e-12 and run.energy_error < 1e-3
        assert np.isfinite(run.torque).all()


def test_means() -> None:
    """Means over a window, nan at the ends."""
    line = np.arange(40.0)
    mean = lying_drum.running(line, 0.2)
    assert np.isnan(mean[:5]).all() and mean[20] == pytest.approx(line[15:25].mean())
