"""The second variation of the energy, against a filled bowl that is tilted numerically."""

from __future__ import annotations

import numpy as np
import pytest

from fluid.upright import free_surface_term, frozen_liquid
from meshes.chamber import Chamber
from meshes.errors import InputError
from tests.mutants import kills
from tests.oracles.bowl import BOWLS, GRAVITY, RHO, Bowl

EPS = np.finfo(float).eps


def assert_second_variation(bowl: Bowl) -> None:
    level = bowl.energy(0.0)
    tilts = np.array([4e-3, 2e-3, 1e-3])
    # E is even in the tilt. The error of each second difference goes with tilt^2; two extrapolations of it,
    # with an error of tilt^4 left, tell each other's accuracy. Rounding of E is divided by tilt^2.
    second = np.array([2.0 * (bowl.energy(t) - level) / t**2 for t in tilts])
    coarse, fine = (4.0 * second[1:] - second[:-1]) / 3.0
    rounding = 20.0 * EPS * max(abs(level), RHO * GRAVITY * bowl.volume) * 4.0 / tilts[-1] ** 2

    difference, moment = bowl.frozen()
    constant = bowl.level(0.0) / GRAVITY - bowl.floor
    a = float(free_surface_term(bowl.chamber, bowl.floor, constant, bowl.speed, GRAVITY, RHO))
    margin = difference * bowl.speed**2 - moment * GRAVITY - a  # [DR18, eq. 21; theory: statics, eq. 20]
    tolerance = abs(fine - coarse) + rounding
    # The tolerance must be able to tell a from a slightly wrong a.
    assert tolerance < 1e-3 * a
    assert abs(fine - margin) <= tolerance


@pytest.mark.parametrize("name", BOWLS)
def test_margin_is_the_second_derivative_of_the_energy(name: str) -> None:
    assert_second_variation(BOWLS[name])


@kills(
    "fluid.upright:free_surface_term",
    "integral = np.sum(np.square(stiffening)",
    "integral = np.sum((stiffening)",
)
@kills("fluid.upright:free_surface_term", "axis=-1) / 4.0", "axis=-1) / 2.0")
def test_wall_only() -> None:
    assert_second_variation(BOWLS["surface on the wall only"])


@kills(
    "fluid.upright:_waterlines",
    "for level in (0.0, chamber.height):",
    "for level in (0.0, 2.0 * chamber.height):",
)
def test_floor_to_lid() -> None:
    assert_second_variation(BOWLS["surface from floor to lid"])


def assert_frozen(bowl: Bowl) -> None:
    """A sum over rings by other points, which is exact for these polynomials: rounding alone is left."""
    difference, moment = bowl.frozen()
    constant = bowl.level(0.0) / GRAVITY - bowl.floor
    found = frozen_liquid(bowl.chamber, bowl.floor, constant, bowl.speed, GRAVITY, RHO)
    # The level is found to 1e-14 of its span; moments go with it.
    size = RHO * bowl.volume * (bowl.chamber.radius + abs(bowl.floor) + bowl.chamber.height) ** 2
    assert float(found.polar - found.transverse) == pytest.approx(difference, abs=1e-11 * size)
    assert float(found.static) == pytest.approx(moment, abs=1e-11 * size / bowl.chamber.radius)


@pytest.mark.parametrize("name", BOWLS)
def test_frozen_liquid_is_summed_ring_by_ring(name: str) -> None:
    assert_frozen(BOWLS[name])


@kills("fluid.upright:frozen_liquid", "(0.5 * s * top + cubed)", "(s * top + cubed)")
@kills("fluid.upright:frozen_liquid", "0.5 * top * (high + floor)", "0.5 * top * (high - floor)")
@kills("fluid.upright:frozen_liquid", "chamber.height)\n", "2.0 * chamber.height)\n")
def test_frozen_liquid_from_floor_to_lid() -> None:
    assert_frozen(BOWLS["surface from floor to lid"])


@kills("fluid.upright:frozen_liquid", "ring * s * top", "ring * 0.5 * s * top")
def test_full_annulus_is_a_solid_ring() -> None:
    chamber = Chamber(0.2, 0.06, inner_radius=0.12)
    mass, floor = RHO * chamber.capacity, 0.05
    # A constant above the lid everywhere: full at any speed.
    polar, transverse, static = frozen_liquid(chamber, floor, 0.06, [0.0, 30.0], GRAVITY, RHO)
    squares = 0.2**2 + 0.12**2
    np.testing.assert_allclose(polar, 0.5 * mass * squares, rtol=1e-13)
    height = floor + 0.03
    np.testing.assert_allclose(transverse, mass * (squares / 4.0 + 0.06**2 / 12.0 + height**2), rtol=1e-13)
    np.testing.assert_allclose(static, mass * height, rtol=1e-13)


def test_still_liquid() -> None:
    # Without spin a = rho g times the plan's second moment: the metacentric loss of every tank.
    a = free_surface_term(Chamber(0.2, 0.1), 0.3, [-0.01, 0.05, 0.11], 0.0, GRAVITY, RHO)
    np.testing.assert_allclose(a, [0.0, RHO * GRAVITY * np.pi * 0.2**4 / 4.0, 0.0], rtol=1e-14)


def test_full_and_empty_chambers_have_no_free_surface() -> None:
    beta = 90.0**2 / (2 * GRAVITY)
    a = free_surface_term(Chamber(0.2, 0.05), 0.1, [0.05, -beta * 0.2**2], 90.0, GRAVITY, RHO)
    np.testing.assert_array_equal(a, 0.0)


def test_a_partition_can_only_help() -> None:
    # An inner wall takes plan away from the free surface.
    whole, ring = (
        free_surface_term(Chamber(0.2, 0.1, inner_radius=r), 0.1, -0.02, 10.0, GRAVITY, RHO)
        for r in (0.0, 0.15)
    )
    assert 0.0 < float(ring) < float(whole)


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((np.nan, 0.0, 9.0, GRAVITY, RHO), "floor"),
        ((0.0, np.inf, 9.0, GRAVITY, RHO), "surface_constant"),
        ((0.0, 0.0, np.nan, GRAVITY, RHO), "speed"),
        ((0.0, 0.0, 9.0, 0.0, RHO), "gravity"),
        ((0.0, 0.0, 9.0, GRAVITY, -1.0), "density"),
    ],
)
def test_bad_input(arguments: tuple[float, ...], field: str) -> None:
    with pytest.raises(InputError) as caught:
        free_surface_term(Chamber(0.2, 0.1), *arguments)
    assert caught.value.field == field
