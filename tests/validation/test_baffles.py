"""Long waves with baffles beside the computed flow."""

from __future__ import annotations

import numpy as np
import pytest

from tests.oracles.cases import come_out_again, kept_group, verdicts
from validation.cases.baffles import flow
from validation.cases.baffles.flow import lagging


def test_decays_and_losses() -> None:
    """The lag of each decay within 0.03 of the spin, the driven losses within a quarter, by both ways."""
    found = kept_group("baffles")
    sinks = {f"{name}_sink" for name in ("w6", "w6n4", "w9", "d3", "d6", "d9")}
    struck = {f"{name}_start" for name in ("w6", "w9", "d3")}
    agree = {"n0", "w6", "w6f", "w6n4", "w9", "d3", "d6", "d9"} | sinks | struck
    assert set(found) == agree | {"d6s", "s6"}
    assert agree <= verdicts(found, "agrees")
    assert "d6s" in verdicts(found, "trend")
    come_out_again([flow._decay("w6"), flow._driven("d6"), flow._behind()])


@pytest.mark.parametrize("name", ["w6", "d6"])
def test_cells(name: str) -> None:
    """Twice the cells change the lag by less than a hundredth of the spin; no liquid is lost."""
    coarse, fine = lagging(name, 64), lagging(name)
    time = np.linspace(0.02, coarse.time[-1], 50)
    assert np.abs(coarse.at(time) - fine.at(time)).max() < 0.01
    assert max(coarse.mass_error, fine.mass_error) < 1e-12


def test_left_behind() -> None:
    """A spin-up of 40 rad/s^2 leaves the liquid behind, one of 10 does not."""
    assert lagging("d6s").lag[-1] > 0.3 and lagging("d6").lag[-1] < 0.08
