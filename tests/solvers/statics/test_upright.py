"""A spinning body with liquid: its upright rotation against limits known without liquid, and in energy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.statics.hydrostatics import equilibrium
from solvers.statics.upright import Top, sign_changes, upright_margin
from tests.mutants import kills
from tests.oracles.bowl import BOWLS, GRAVITY, RHO, Bowl

WATER = Liquid("water", RHO, 1e-6)
DISC = Top(mass=2.0, transverse_inertia=0.02, polar_inertia=0.06, centre=0.1)


@kills("solvers.statics.upright:upright_margin", "top.mass * top.centre**2", "0.0 * top.centre**2")
@kills("solvers.statics.upright:upright_margin", "+ top.stiffness", "- top.stiffness")
@kills("solvers.statics.upright:upright_margin", "- top.mass * top.centre * gravity", "")
def test_top_without_liquid_stands_from_the_speed_of_its_closed_form() -> None:
    # (C - A - M l^2) W^2 = M g l - k
    spread = 0.06 - 0.02 - 2.0 * 0.1**2
    sprung = Top(2.0, 0.02, 0.06, 0.1, stiffness=0.5)
    for top, pull in ((DISC, 2.0 * GRAVITY * 0.1), (sprung, 2.0 * GRAVITY * 0.1 - 0.5)):
        limit = math.sqrt(pull / spread)
        margin = upright_margin(top, (), 1.0, limit * np.array([0.9, 1.0, 1.1]), GRAVITY).left
        assert margin[0] < 0.0 < margin[2]
        assert abs(margin[1]) < 1e-14 * pull
        grid = np.linspace(1.0, 50.0, 9)
        found = sign_changes(lambda w, top=top: upright_margin(top, (), 1.0, w, GRAVITY).left, grid)
        assert found == pytest.approx((limit,), rel=1e-13)


def assert_added(bowl: Bowl) -> None:
    """The margin with liquid less that without is the second derivative of the liquid's own energy."""
    middle = bowl.floor + 0.5 * bowl.chamber.height - DISC.centre
    chamber = Chamber(bowl.chamber.radius, bowl.chamber.height, bowl.chamber.inner_radius, plane=middle)
    fill = Fill(chamber, WATER, bowl.volume)
    wet = upright_margin(DISC, (fill,), 1.0, bowl.speed, GRAVITY).left
    added = float(wet - upright_margin(DISC, (), 1.0, bowl.speed, GRAVITY).left)
    tilt, level = 2e-3, bowl.energy(0.0)
    second, half = (2.0 * (bowl.energy(t) - level) / t**2 for t in (tilt, 0.5 * tilt))
    # The difference of both is three quarters of the coarser one's error, which goes with tilt^2.
    size = RHO * GRAVITY * bowl.volume + abs(level)
    assert added == pytest.approx((4.0 * half - second) / 3.0, abs=abs(second - half) + 1e-8 * size)


@pytest.mark.parametrize("name", BOWLS)
def test_liquid_adds_what_tilting_it_costs(name: str) -> None:
    assert_added(BOWLS[name])


@kills("solvers.statics.upright:upright_margin", "- 0.5 * chamber.height", "")
@kills("solvers.statics.upright:upright_margin", "surface = surface + taken", "surface = surface - taken")
@kills("solvers.statics.upright:upright_margin", "- liquid.static * gravity", "")
def test_liquid_from_floor_to_lid() -> None:
    assert_added(BOWLS["surface from floor to lid"])


@settings(max_examples=60, deadline=None)
@given(
    radius=st.floats(0.02, 1.0),
    slender=st.floats(0.05, 5.0),
    inner=st.floats(0.0, 0.95),
    share=st.floats(0.01, 0.99),
    plane=st.floats(-2.0, 2.0),
    speed=st.floats(0.1, 300.0),
)
def test_a_free_surface_never_helps(
    radius: float, slender: float, inner: float, share: float, plane: float, speed: float
) -> None:
    chamber = Chamber(radius, slender * radius, inner * radius, plane=plane * radius)
    fill = Fill(chamber, WATER, share * chamber.capacity)
    margin = upright_margin(DISC, (fill,), 1.0, speed, GRAVITY)
    assert float(margin.surface) > 0.0
    assert np.isfinite(margin.left)
    # All of it at the wall, and as far below the fixed point as the chamber reaches, would add the most.
    most = fill.mass * radius**2 * speed**2
    dry = float(upright_margin(DISC, (), 1.0, speed, GRAVITY).left)
    height = abs(DISC.centre + chamber.plane) + 0.5 * chamber.height
    assert float(margin.frozen) - dry <= most + fill.mass * GRAVITY * height * (1.0 + 1e-12)


def test_share_is_a_fill_of_that_volume() -> None:
    chamber = Chamber(0.15, 0.04, 0.05, plane=0.02)
    whole, part = Fill(chamber, WATER, 1e-3), Fill(chamber, WATER, 0.4e-3)
    left = upright_margin(DISC, (whole,), [0.4, 1.0], 40.0, GRAVITY).left
    assert float(left[0]) == pytest.approx(
        float(upright_margin(DISC, (part,), 1.0, 40.0, GRAVITY).left), rel=1e-12
    )
    state = equilibrium(chamber, 0.4e-3, 0.0, 40.0, GRAVITY)
    assert bool(state.converged.all())


def test_two_half_chambers_are_worse_by_nothing_but_their_partition() -> None:
    """At fast spin a chamber split in height is the same: the layer is one cylinder in both."""
    whole = Fill(Chamber(0.15, 0.04, plane=0.05), WATER, 1e-3)
    halves = tuple(Fill(Chamber(0.15, 0.02, plane=p), WATER, 0.5e-3) for p in (0.04, 0.06))
    speed = 2e4
    one, two = (upright_margin(DISC, fills, 1.0, speed, GRAVITY).left for fills in ((whole,), halves))
    # The surface is a cylinder to h/(beta R^2) = 4e-8, and rounding of C is eps beta R^2/h in the heights.
    assert float(one) == pytest.approx(float(two), rel=1e-6)


def test_signs() -> None:
    found = sign_changes(lambda x: (x - 1.0) * (x - 2.5), np.linspace(0.0, 4.0, 9))
    np.testing.assert_allclose(found, [1.0, 2.5], rtol=1e-14)
    assert sign_changes(lambda x: np.square(x - 1.0), np.linspace(0.0, 4.0, 5)) == ()


@kills("fluid.upright:cylinder_terms", "squared * ring", "ring")
@kills("fluid.upright:cylinder_terms", "(high + inner)", "(high - inner)")
@kills("fluid.upright:cylinder_terms", "np.square(omega) * inner", "np.square(omega) * high")
@kills("fluid.upright:cylinder_terms", "(amount < chamber.capacity)", "(amount <= chamber.capacity)")
def test_without_gravity_it_is_the_limit_of_little_gravity() -> None:
    """What is left goes linearly with a small g, so that twice the half less the whole is the limit."""
    speed, share = 30.0, np.array([0.02, 0.4, 1.0])
    for inner in (0.0, 0.05):
        chamber = Chamber(0.2, 0.1, inner_radius=inner, plane=0.03)
        for part in (0.7, 1.0):  # at 1 the last share fills the chamber: no free surface
            fill = Fill(chamber, WATER, part * chamber.capacity)
            weak, weaker = (upright_margin(DISC, (fill,), share, speed, g) for g in (2e-3, 1e-3))
            without = upright_margin(DISC, (fill,), share, speed, 0.0)
            for name in ("frozen", "surface", "left"):
                whole, half, at = (getattr(margin, name) for margin in (weak, weaker, without))
                # Of second order: (2 g h/(Omega R)^2)^2 is 1e-10 of each; eight digits cancel nowhere.
                np.testing.assert_allclose(at, 2.0 * half - whole, rtol=1e-7, atol=1e-9)
    # Every term goes with the square of the speed: without springs nothing depends on it.
    left = upright_margin(DISC, (fill,), 0.5, np.array([1.0, 1e3]), 0.0).left
    assert left[1] == pytest.approx(1e6 * left[0], rel=1e-12)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"mass": 0.0}, "mass"),
        ({"transverse_inertia": -1.0}, "transverse_inertia"),
        ({"polar_inertia": -1.0}, "polar_inertia"),
        ({"stiffness": math.nan}, "stiffness"),
        ({"centre": math.inf}, "centre"),
    ],
)
def test_body_is_checked(change: dict[str, float], field: str) -> None:
    values = {"mass": 1.0, "transverse_inertia": 0.1, "polar_inertia": 0.1, "centre": 0.1} | change
    with pytest.raises(InputError) as caught:
        Top(**values)
    assert caught.value.field == field


def test_speed_gravity_and_walls_are_checked() -> None:
    chamber = Chamber(0.15, 0.04, baffles=Baffles(count=3, tip_radius=0.1))
    for fills, speed, gravity, field in (
        ((), 0.0, GRAVITY, "speed"),
        ((), 1.0, -1.0, "gravity"),
        ((Fill(chamber, WATER, 1e-4),), 1.0, GRAVITY, "chambers"),
    ):
        with pytest.raises(InputError) as caught:
            upright_margin(DISC, fills, 1.0, speed, gravity)
        assert caught.value.field == field
