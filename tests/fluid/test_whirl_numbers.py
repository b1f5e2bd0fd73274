"""Dimensionless numbers of a whirl against their definitions in independent terms."""

from __future__ import annotations

import math

import pytest

from fluid.fill import Fill
from fluid.liquid import Liquid
from fluid.numbers import whirl_numbers
from meshes.chamber import Chamber
from tests.mutants import kills

R, A, H, SPIN = 0.15, 0.135, 0.01, 40.0


def fill(viscosity: float = 1e-6, surface: float = A) -> Fill:
    return Fill(Chamber(R, H), Liquid("test", 1000.0, viscosity), math.pi * (R**2 - surface**2) * H)


@kills("fluid.numbers:whirl_numbers", "whirl_speed - spin", "whirl_speed + spin")
@kills("fluid.numbers:whirl_numbers", "2.0 * viscosity", "viscosity")
@kills("fluid.numbers:whirl_numbers", "abs(pair[0] - pair[1])", "abs(pair[0] + pair[1])")
@kills("fluid.numbers:whirl_numbers", "spin**2 * surface / gravity", "spin**2 * radius / gravity")
@kills("fluid.numbers:whirl_numbers", "spin * radius**2", "spin * depth**2")
def test_numbers() -> None:
    """At a free wave the detuning is none and the Froude number one; halfway between the two it is a half."""
    log = math.log(R / A)
    thick = math.tanh(log)
    ahead = SPIN * (thick + math.sqrt(thick**2 + thick))
    back = SPIN * (thick - math.sqrt(thick**2 + thick))
    for wave in (ahead, back):
        at = whirl_numbers(fill(), SPIN, SPIN + wave, 1.5e-3, 9.81)
        assert at.detuning == pytest.approx(0.0, abs=1e-12) and at.froude == pytest.approx(1.0, rel=1e-12)
    between = whirl_numbers(fill(), SPIN, SPIN + 0.5 * (ahead + back), 1.5e-3, 9.81)
    assert between.detuning == pytest.approx(0.5, rel=1e-12)
    assert at.relative_depth == pytest.approx(0.1, rel=1e-12) and at.deflection == pytest.approx(
        0.1, rel=1e-9
    )
    assert at.centrifuge == pytest.approx(SPIN**2 * A / 9.81) and at.reynolds == pytest.approx(9e5)
    # Twice the layer in which a plate's oscillation dies to 1/e, for four times the viscosity.
    four = whirl_numbers(fill(4e-6), SPIN, SPIN + back, 1.5e-3, 9.81)
    assert four.wall_layer == pytest.approx(2 * at.wall_layer, rel=1e-12)
    assert at.wall_layer * 0.1 * R == pytest.approx(math.sqrt(2e-6 / abs(back)), rel=1e-9)


def test_limits() -> None:
    still = whirl_numbers(fill(0.0), SPIN, SPIN, 0.0, 0.0)
    assert still.wall_layer == 0.0 and still.deflection == 0.0
    assert math.isinf(still.reynolds) and math.isinf(still.centrifuge)
    full = whirl_numbers(fill(surface=0.0), SPIN, 30.0, 1e-3, 0.0)
    assert full.relative_depth == 1.0 and math.isfinite(full.detuning)
