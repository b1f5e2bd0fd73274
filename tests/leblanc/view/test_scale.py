"""How much larger a picture draws things: nothing that is wet falls dry, nothing dry gets wet."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fluid.fill import Fill
from fluid.liquid import known_liquid
from leblanc.plotting.bodies import Scale
from leblanc.studies.shapes.scale import (
    DEEP,
    SHOWN,
    choose_scale,
    drawn_volume,
    drying_deflection,
    given_scale,
)
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.statics.hydrostatics import equilibrium, optimal_volume

WATER = known_liquid("water")
THICK = Fill(Chamber(0.2, 0.05), WATER, 1e-3)  # a layer of 17 mm
THIN = Fill(Chamber(0.065, 0.02), WATER, 1e-5)  # of 1.2 mm


def choose(fill: Fill, *deflections: float, speed: float = 100.0, gravity: float = 0.0) -> Scale:
    found = np.array(deflections, dtype=complex)[:, None]
    return choose_scale((fill,), found, np.full(len(deflections), speed), gravity)


def test_drying_deflection() -> None:
    # Without gravity the wall falls dry when the deflection passes the mean depth of the layer.
    found = drying_deflection(THICK.chamber, THICK.volume, np.array([50.0]), 0.0)
    assert found[0] == pytest.approx(THICK.depth, rel=1e-9)
    # With it, where the volume is the one that just covers the wall.
    edge = drying_deflection(THICK.chamber, THICK.volume, np.array([20.0]), 9.81)
    assert float(optimal_volume(THICK.chamber, edge[0], 20.0, 9.81)) == pytest.approx(THICK.volume, rel=1e-6)


def test_wet_stays_wet() -> None:
    for fill in (THICK, THIN):
        for part in (0.01, 0.3, 0.95):
            size = part * fill.depth
            scale = choose(fill, size)
            assert scale.deflection >= 1.0
            drawn = equilibrium(
                fill.chamber, drawn_volume(fill, scale.depth), scale.deflection * size, 100.0, 0.0
            )
            assert not bool(drawn.dry_patch)


def test_dry_stays_dry() -> None:
    for fill in (THICK, THIN):
        size = 1.3 * fill.depth
        scale = choose(fill, 0.2 * size, size)
        # Equal factors: the arc that is dry depends on the deflection over the depth alone, in a thin layer.
        assert scale.deflection == scale.depth
        drawn = equilibrium(
            fill.chamber, drawn_volume(fill, scale.depth), scale.deflection * size, 100.0, 0.0
        )
        assert bool(drawn.dry_patch)


def test_drawn_volume() -> None:
    # The layer's area is pi (R^2 - (R - d h)^2).
    layer = 3.0 * THIN.depth
    outer, inner = THIN.chamber.radius, THIN.chamber.radius - layer
    exact = math.pi * (outer**2 - inner**2) * THIN.chamber.height
    assert drawn_volume(THIN, 3.0) == pytest.approx(exact, rel=1e-12)
    assert drawn_volume(THIN, 1.0) == THIN.volume


def test_a_thick_layer_keeps_its_volume() -> None:
    assert choose(THICK, 1e-4).depth == 1.0
    assert choose(THICK, 0.0) == Scale()
    assert choose(THICK, math.nan) == Scale()


def test_a_thin_layer_is_drawn_deeper() -> None:
    scale = choose(THIN, 1e-4)
    assert 1.0 < scale.depth <= DEEP * THIN.chamber.radius / THIN.depth


@settings(max_examples=20)
@given(st.floats(1e-9, 10.0), st.floats(1.0, 500.0), st.sampled_from([0.0, 9.81]))
def test_the_drawing_keeps_its_size(size: float, speed: float, gravity: float) -> None:
    for fill in (THICK, THIN):
        scale = choose(fill, size, speed=speed, gravity=gravity)
        # At most what is wanted, or the deflection itself where that is larger, up to half the radius.
        most = max(SHOWN * fill.chamber.radius, min(size, 0.5 * fill.chamber.radius))
        assert 0.0 < scale.deflection * size <= most * (1.0 + 1e-9)


def test_words_name_every_factor() -> None:
    assert Scale().in_words() == "Everything to scale."
    assert "13 times larger" in Scale(13.0).in_words()
    assert "0.25 of its size" in Scale(0.25).in_words()
    assert "3 times larger" in Scale(3.0, 3.0).in_words()
    both = Scale(36.0, 2.7).in_words()
    assert "36 times larger" in both
    assert "2.7 times" in both


@pytest.mark.parametrize("factor", [0.0, -1.0, math.nan, math.inf, 1e6])
def test_a_factor_that_cannot_be_drawn(factor: float) -> None:
    with pytest.raises(InputError, match="--factor"):
        given_scale(factor, (THICK,), np.array([[0.01 + 0j]]))
