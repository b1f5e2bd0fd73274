"""Liquid models on a grid against the exact equilibrium, the long-wave scheme at rest, and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fluid.fill import Fill, Fills
from fluid.liquid import known_liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.state import Numerics
from solvers.liquid_model import LiquidAnswer, LiquidModel, Whirl, Whirls
from solvers.pypde.settle import settle
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.models import STATICS, CellsAtRest, ElementsAtRest, Statics
from solvers.synchronous.response import response
from tests.mutants import kills

WATER = known_liquid("water")
LAYER = Fill(Chamber(0.15, 0.05), WATER, 0.15 * Chamber(0.15, 0.05).capacity)
THIN = Fill(Chamber(0.2, 0.04), WATER, 1e-6 * Chamber(0.2, 0.04).capacity)
RING = Fill(Chamber(0.2, 0.04, 0.15), WATER, 0.6 * Chamber(0.2, 0.04, 0.15).capacity)


def ask(
    model: LiquidModel, fill: Fill, deflection: Array, speed: float = 40.0, gravity: float = 0.0
) -> LiquidAnswer:
    count = deflection.size
    whirls = Whirls.synchronous(np.full(count, speed), deflection, np.full(count, gravity))
    return model.answer(Fills.of([fill] * count), whirls)


@kills(
    "solvers.synchronous.models:_middles",
    "(np.arange(cells) + 0.5) / cells",
    "(np.arange(cells) + 0.25) / cells",
)
@kills("solvers.synchronous.models:_circle", "- np.square(e * sine)", "+ np.square(e * sine)")
def test_scheme_at_rest() -> None:
    """The finite-volume scheme, started from rest in its own equilibrium and run on, has the same force.

    Its equilibrium is found by bisection on the squared radius to 1e-16 and kept to rounding, of which some
    hundred steps leave 1e-12 at most. The centre of mass is a second witness, without the momentum.
    """
    for cells in (16, 64):
        for share in (0.5, 0.99, 1.3, 3.0):
            e = share * LAYER.depth
            held = settle(LAYER, Whirl(spin=40.0, speed=40.0, amplitude=e), numerics=Numerics(cells=cells))
            mine = ask(CellsAtRest(cells), LAYER, np.array([e]))
            assert mine.converged.all() and mine.dry_patch.tolist() == [share > 1.0]
            assert mine.unbalance[0] / (LAYER.full_mass * e) == pytest.approx(
                held.force_ratio[-1].real, rel=1e-12
            )
            assert mine.unbalance[0] / LAYER.mass - e == pytest.approx(held.offset[-1].real, rel=1e-12)


@kills(
    "solvers.synchronous.models:_circle",
    "below = level - e * (away - away[0])",
    "below = level - 2.0 * e * (away - away[0])",
)
@kills(
    "solvers.synchronous.models:_circle",
    "seen = 1.0 + e * cosine + chord",
    "seen = 1.0 - e * cosine + chord",
)
@kills(
    "solvers.synchronous.models:CellsAtRest._at_rest",
    "lever = depth * (3.0 - depth * (3.0 - depth)) / 3.0",
    "lever = depth * (2.0 - depth) / 2.0",
)
@kills(
    "solvers.synchronous.models:CellsAtRest._at_rest",
    "moment = fills.volume * deflection + size",
    "moment = size",
)
@kills(
    "solvers.synchronous.models:CellsAtRest._at_rest",
    "np.mean(depth * (2.0 - depth), axis=1) - film",
    "np.mean(2.0 * depth, axis=1) - film",
)
def test_wet_wall() -> None:
    """With every cell wet the sums are those of a smooth periodic function: the full mass to rounding.

    The surface's nearest singularity, where its circle has no chord, is at |Im theta| = acosh(rho/e) > 2 for
    e below a quarter of the surface's radius: N = 32 leaves e^{-64}.
    """
    for fill in (LAYER, THIN, RING):
        e = fill.depth * np.array([1e-6, 1e-3, 0.3, 0.9])
        found = ask(CellsAtRest(32), fill, e)
        # A sum of levers of both signs: rounding is relative to their size.
        rounding = 1e-15 * fill.mass * fill.chamber.radius
        np.testing.assert_allclose(found.unbalance, fill.full_mass * e, rtol=2e-13, atol=rounding)
        np.testing.assert_allclose(found.slope, fill.full_mass, rtol=2e-12)
        assert not found.dry_patch.any() and found.converged.all()
    # At no deflection the liquid is even and its slope the same.
    still = ask(CellsAtRest(32), LAYER, np.zeros(1))
    assert still.unbalance[0] == pytest.approx(0.0, abs=1e-17)
    assert still.slope[0] == pytest.approx(LAYER.full_mass, rel=1e-13)


def test_cells_converge() -> None:
    """Beside a dry patch the depth has a kink, which the middle rule leaves at second order.

    The kink's error is J/(12 N^2) (2 pi)^2 at most and turns with its place in a cell, so that the root mean
    square over many deflections falls by four: within 0.15 of order two over 60 of them.
    """
    e = LAYER.depth * np.linspace(1.05, 6.0, 60)
    exact = ask(Statics(), LAYER, e)
    grids = (32, 64, 128, 256, 512)
    off = [ask(CellsAtRest(n), LAYER, e).unbalance / exact.unbalance - 1.0 for n in grids]
    rms = np.sqrt(np.mean(np.square(off), axis=1))
    np.testing.assert_allclose(np.log2(rms[:-1] / rms[1:]), 2.0, atol=0.15)
    # The plan of the surface jumps at the kink: first order for the slope, one cell in N of its change.
    steep = [np.abs(ask(CellsAtRest(n), LAYER, e).slope / exact.slope - 1.0).max() for n in grids]
    assert all(worst <= 4.0 / n for worst, n in zip(steep, grids, strict=True))


@kills(
    "solvers.synchronous.models:CellsAtRest._at_rest",
    "share = np.divide(surface, chord,",
    "share = np.divide(chord, surface + 1.0,",
)
@kills(
    "solvers.synchronous.models:CellsAtRest._at_rest", "np.square(arm - middle[:, None])", "np.square(arm)"
)
@kills(
    "solvers.synchronous.models:CellsAtRest._at_rest",
    "fills.volume + size * spread, dry",
    "size * spread, dry",
)
def test_slope() -> None:
    """The slope is the derivative of the unbalance while no cell changes sides.

    Central differences over 1e-4 of the depth leave its square times the third derivative, some 1e-6, as
    measured by halving the step.
    """
    for share in (0.4, 1.7, 4.0):
        e, step = share * LAYER.depth, 1e-4 * LAYER.depth
        found = ask(CellsAtRest(24), LAYER, np.array([e - step, e, e + step]))
        slope = (found.unbalance[2] - found.unbalance[0]) / (2.0 * step)
        assert found.slope[1] == pytest.approx(slope, rel=1e-6)


@settings(max_examples=60)
@given(
    cells=st.integers(8, 80),
    filled=st.floats(1e-7, 0.5),
    shares=st.lists(st.floats(0.0, 1.4), min_size=2, max_size=12, unique=True),
    radius=st.floats(0.01, 1.0),
)
def test_law_never_falls(cells: int, filled: float, shares: list[float], radius: float) -> None:
    """What the search for branches needs: mass <= slope <= full mass, unbalance below mass times (R + e)."""
    chamber = Chamber(radius, 0.04)
    fill = Fill(chamber, WATER, filled * chamber.capacity)
    e = radius * np.sort(shares)
    found = ask(CellsAtRest(cells), fill, e)
    assert found.converged.all()
    own = found.unbalance - fill.mass * e
    # Roots are found to four units of rounding of the greatest depth, sums of unity to as much.
    assert np.all(np.diff(own) >= -1e-13 * fill.mass * radius)
    assert np.all(own <= fill.mass * radius * (1.0 + 1e-12))
    assert np.all(found.slope >= fill.mass * (1.0 - 1e-12))
    assert np.all(found.slope <= fill.full_mass * (1.0 + 1e-9))


@kills("solvers.synchronous.models:_surface", "level - (far - near)", "level + (far - near)")
@kills("solvers.synchronous.models:_surface", "axis, plane = (-e, 0.0)", "axis, plane = (e, 0.0)")
@kills(
    "solvers.synchronous.models:ElementsAtRest.answer",
    "float(steep[k]) * height / radius**2",
    "float(steep[k]) * height / radius",
)
def test_elements_converge() -> None:
    """Straight edges lose the segments of the circle, second order; quadratic ones run inside it by b^4/60.

    The wall's error is that of the area with a wet wall: 1 - sin(x)/x, x = 2 pi/N, for straight edges. The
    orders are asymptotic: from 32 edges on they are within 0.3.
    """
    for speed, gravity in ((40.0, 0.0), (20.0, 9.81)):
        e = LAYER.depth * np.array([0.3, 1.4, 5.0])
        exact = ask(Statics(), LAYER, e, speed, gravity)
        for order, expected in ((1, 2.0), (2, 4.0)):
            grids = (32, 64)
            found = [ask(ElementsAtRest(n, order), LAYER, e, speed, gravity) for n in grids]
            off = [one.unbalance / exact.unbalance - 1.0 for one in found]
            assert np.all(off[1] < 0.0)
            np.testing.assert_allclose(np.log2(off[0] / off[1]), expected, atol=0.3)
            assert all(one.converged.all() for one in found)
            np.testing.assert_array_equal(found[1].dry_patch, exact.dry_patch)
    corner = 2.0 * math.pi / 32
    wet = ask(ElementsAtRest(32), LAYER, np.array([0.3 * LAYER.depth]))
    assert wet.unbalance[0] / (LAYER.full_mass * 0.3 * LAYER.depth) == pytest.approx(
        math.sin(corner) / corner, 1e-9
    )


@kills(
    "solvers.synchronous.models:_surface",
    "slope = float(here.volume) + 2.0 * spread",
    "slope = float(here.volume) + spread",
)
@kills("solvers.synchronous.models:_surface", "square - arm * arm / plan", "square")
def test_elements_slope() -> None:
    """The slope by the plan's moments against the exact one, on both kinds of surface.

    Quadratic edges leave 1e-5; the difference of levels, 1e-4 apart, leaves 1e-4 times the logarithmic
    derivative of the spread, some 3.
    """
    for speed, gravity in ((40.0, 0.0), (20.0, 9.81)):
        e = LAYER.depth * np.array([0.3, 1.4, 5.0])
        exact, found = (ask(model, LAYER, e, speed, gravity) for model in (Statics(), ElementsAtRest(32, 2)))
        np.testing.assert_allclose(found.slope, exact.slope, rtol=6e-4)


@kills(
    "solvers.synchronous.models:CellsAtRest.answer",
    "0.5 * math.pi * np.square(chamber.radius)",
    "math.pi * np.square(chamber.radius)",
)
@kills("solvers.synchronous.models:CellsAtRest._at_rest", "drop = level + e * away[0]", "drop = level - e")
def test_range() -> None:
    """Long waves are for layers that are thin, upright, and clear of the axis and of an inner wall."""
    wave = CellsAtRest(32)
    small = np.array([1e-4])
    assert ask(wave, LAYER, small).in_range.all()
    deep = Fill(LAYER.chamber, WATER, 0.52 * LAYER.chamber.capacity)  # h0 = 0.307 R
    assert not ask(wave, deep, small).in_range.any()
    # The paraboloid covers the wall where Omega^2 V/(pi h) = g h, 7.4 rad/s here.
    covering = math.sqrt(9.81 * math.pi * LAYER.chamber.height**2 / LAYER.volume)
    assert not ask(wave, LAYER, small, 0.99 * covering, 9.81).in_range.any()
    assert ask(wave, LAYER, small, 1.01 * covering, 9.81).in_range.all()
    # The layer of a ring is as deep as the deflection adds to its mean depth.
    gap = RING.chamber.radius - RING.chamber.inner_radius
    assert ask(wave, RING, np.array([0.98, 1.02]) * (gap - RING.depth)).in_range.tolist() == [True, False]


def test_response() -> None:
    """A rotor finds the same branches with cells as with the exact equilibrium.

    With a wet wall to rounding; with a dry one the law's own error at 256 cells, 3e-5, times the
    amplification of the spring, below 10 here.
    """
    rotor = Jeffcott(mass=20.0, stiffness=2.0e4, damping=60.0, unbalance=0.05)
    speed = np.array([15.0, 25.0, 31.0, 40.0, 80.0])
    exact = response(rotor, [LAYER], speed, 0.0, STATICS)
    mine = response(rotor, [LAYER], speed, 0.0, CellsAtRest(256))
    assert mine.model.tolist() == ["long_wave 256"] * 5
    assert exact.dry_patch.any() and not exact.dry_patch.all()
    off = np.abs(mine.deflection / exact.deflection - 1.0)
    assert off[~exact.dry_patch].max() < 1e-11
    assert off.max() < 3e-4
    np.testing.assert_array_equal(mine.dry_patch, exact.dry_patch)
    np.testing.assert_array_equal(mine.stable, exact.stable)


def test_models_are_values() -> None:
    """Equal models count as one where each speed has its own; names tell resolutions apart."""
    assert (
        CellsAtRest(64) == CellsAtRest(64)
        and len({CellsAtRest(64), CellsAtRest(64), CellsAtRest(32), STATICS}) == 3
    )
    assert CellsAtRest(64).name == "long_wave 64" and ElementsAtRest(16, 2).name == "fem 16 order 2"


def test_no_states() -> None:
    for model in (CellsAtRest(16), ElementsAtRest(16)):
        nothing = np.zeros(0)
        fills = Fills.of([LAYER]).at(np.zeros(0, dtype=np.intp))
        assert model.answer(fills, Whirls.synchronous(nothing, nothing, nothing)).slope.size == 0
        assert model.linear_limit(Fills.of([LAYER]), np.ones(1), np.zeros(1)).tolist() == [0.0]


def test_too_coarse() -> None:
    with pytest.raises(InputError, match="cells"):
        CellsAtRest(7)
    with pytest.raises(InputError, match="segments"):
        ElementsAtRest(7)
    with pytest.raises(InputError, match="order"):
        ElementsAtRest(16, 3)
