"""Volumes at which the surface meets an edge of the chamber: definitions, closed forms, limits, order."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from meshes.arrays import Array
from meshes.chamber import Chamber, Chambers
from solvers.statics.free_surface import default_disc, integrate_surface
from solvers.statics.hydrostatics import equilibrium, wall_volumes
from tests.mutants import kills

GRAVITY = 9.81
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)


def beta_of(speed: float) -> float:
    return speed**2 / (2.0 * GRAVITY)


def under(radius: float, height: float, e: float, beta: float, constant: float) -> float:
    """Volume under z = beta r^2 + C inside a cylinder, by Gauss-Legendre over circles about the axis.

    The circle of radius r has the angle 2 phi in the disc. Between the radii where phi or the depth bend, and
    with r = a + (b - a) sin(t)^2 against the roots that phi has there, the integrand is smooth.
    """

    def shell(r: Array) -> Array:
        crossing = np.maximum(2.0 * e * r, 1e-300)
        cosine = np.clip((r * r + e * e - radius * radius) / crossing, -1.0, 1.0)
        phi = np.where(r <= radius - e, math.pi, np.where(r <= e - radius, 0.0, np.arccos(cosine)))
        return np.asarray(2.0 * phi * r * np.clip(beta * r * r + constant, 0.0, height))

    squares = (-constant / beta, (height - constant) / beta) if beta > 0.0 else ()
    marks = {0.0, abs(radius - e), radius + e, *(math.sqrt(s) for s in squares if s > 0.0)}
    total = 0.0
    for a, b in pairwise(sorted(mark for mark in marks if mark <= radius + e)):
        t = 0.25 * math.pi * (1.0 + NODES)
        r = a + (b - a) * np.sin(t) ** 2
        total += float(np.sum(0.25 * math.pi * WEIGHTS * (b - a) * np.sin(2.0 * t) * shell(r)))
    return total


def by_definition(chamber: Chamber, e: float, speed: float) -> dict[str, float]:
    """The volumes by their surface constants, integrated as above, m^3."""
    beta, big, small, h = beta_of(speed), chamber.radius, chamber.inner_radius, chamber.height
    constants = {
        "wetting": -beta * (big - e) ** 2,
        "lid": h - beta * (big + e) ** 2,
        "inner": -beta * (small + e) ** 2,
        "full": h - beta * (big - e) ** 2,
    }
    found = {}
    for name, constant in constants.items():
        found[name] = under(big, h, e, beta, constant)
        if small > 0.0:
            found[name] -= under(small, h, e, beta, constant)
    return found


STEEP = (
    "solvers.statics.hydrostatics:wall_volumes",
    "1.0 + 4.0 * steep * e / radius",
)
FOOT = ("solvers.statics.hydrostatics:wall_volumes", "(radius + inner + 2.0 * e)")


@kills(*STEEP, "1.0 + 2.0 * steep * e / radius")
@kills(*STEEP, "4.0 * steep * e / radius")
@kills(*FOOT, "(radius + inner + e)")
@kills("solvers.statics.hydrostatics:wall_volumes", "np.ones_like(e)", "0.5 * np.ones_like(e)")
@example(log_speed=1.0, share=0.0, slender=0.5, inner=0.5)
@example(log_speed=0.5, share=0.3, slender=0.2, inner=0.0)
@example(log_speed=2.0, share=0.01, slender=0.3, inner=0.8)
@given(
    log_speed=st.floats(-1.0, 2.5),
    share=st.floats(0.0, 1.5),
    slender=st.floats(0.05, 2.0),
    inner=st.one_of(st.just(0.0), st.floats(0.2, 0.9)),
)
@settings(max_examples=40)
def test_definitions_over_the_box(log_speed: float, share: float, slender: float, inner: float) -> None:
    """Each is what lies under its surface, found by another integral; more liquid from one to the next."""
    radius, speed = 0.2, 10.0**log_speed
    chamber, e = Chamber(radius, slender * radius, inner * radius), share * radius
    found, exact = wall_volumes(chamber, e, speed, GRAVITY), by_definition(chamber, e, speed)
    # The depth is a difference of numbers beta (R + e)^2/h times its size, 3e4 here: 1e-16 of that, and the
    # quadrature's own 1e-10 of the chamber where marks nearly meet.
    slack = 1e-9 * chamber.capacity
    assert float(found.wetting) == pytest.approx(exact["wetting"], rel=1e-8, abs=slack)
    assert float(found.lid) == pytest.approx(exact["lid"], rel=1e-8, abs=slack)
    assert float(found.full) == pytest.approx(exact["full"], rel=1e-8, abs=slack)
    assert math.isnan(float(found.inner)) == (inner == 0.0)
    if inner > 0.0:
        assert float(found.inner) == pytest.approx(exact["inner"], rel=1e-8, abs=slack)
    # C rises from the wetting and the lid volume to the full one.
    whole = chamber.capacity * (1.0 + 1e-12)
    assert 0.0 <= float(found.wetting) <= float(found.full) * (1.0 + 1e-12) <= whole * (1.0 + 1e-12)
    assert 0.0 <= float(found.lid) <= float(found.full) * (1.0 + 1e-12)


@kills(*STEEP, "1.0 + 8.0 * steep * e / radius")
def test_closed_forms() -> None:
    """In a chamber so high that the surface leaves out the lid, or the floor, all are polynomials.

    Over the disc int r^2 dA = pi R^2 (R^2/2 + e^2); whole circles of radius a = R - e give pi a^4/2.
    """
    radius, e, beta = 0.2, 0.03, beta_of(6.0)
    disc, spread, near = math.pi * radius**2, math.pi * radius**2 * (radius**2 / 2 + e**2), radius - e
    wetting = beta * (spread - disc * near**2 + 0.5 * math.pi * near**4)
    air_over_lid = beta * (disc * (radius + e) ** 2 - spread)
    for height in (0.2, 2.0, 20.0):
        assert height > beta * (radius + e) ** 2  # neither floor nor lid cuts what it must not
        chamber = Chamber(radius, height)
        found = wall_volumes(chamber, e, 6.0, GRAVITY)
        assert float(found.wetting) == pytest.approx(wetting, rel=1e-12)
        # Differences from the capacity keep its rounding.
        assert chamber.capacity - found.lid == pytest.approx(air_over_lid, abs=1e-12 * chamber.capacity)
        air = 0.5 * math.pi * beta * near**4
        assert chamber.capacity - found.full == pytest.approx(air, abs=1e-12 * chamber.capacity)


def test_without_deflection() -> None:
    """Nothing wets a wall that the axis does not leave; lid and wall are wet together, pi h^2/(2 beta)."""
    found = wall_volumes(Chamber(0.2, 0.05), 0.0, 90.0, GRAVITY)
    assert float(found.wetting) == 0.0
    assert float(found.lid) == float(found.full)
    assert float(found.full) == pytest.approx(math.pi * 0.05**2 / (2.0 * beta_of(90.0)), rel=1e-12)


@kills("solvers.statics.hydrostatics:wall_volumes", "np.where(upright, lid, np.nan)", "lid")
@kills("solvers.statics.hydrostatics:wall_volumes", "np.where(upright, full, wetting)", "full")
def test_without_gravity_and_at_fast_spin() -> None:
    """A cylinder: the first and the last are one, the crescent; the inner wall is met by a whole ring."""
    chamber, e = Chamber(0.2, 0.05, 0.15), np.array([0.0, 1e-3, 0.01])
    flat = wall_volumes(chamber, e, 90.0, 0.0)
    np.testing.assert_array_equal(flat.wetting, flat.full)
    crescent, ring = math.pi * 0.05 * e * (0.4 - e), math.pi * 0.05 * (0.2**2 - (0.15 + e) ** 2)
    np.testing.assert_allclose(flat.full, crescent, rtol=1e-12)
    np.testing.assert_allclose(flat.inner, ring, rtol=1e-12)
    assert np.isnan(flat.lid).all()
    # At 1e5 rad/s the ramp of the surface is h/(2 beta R) = 2e-10 m wide.
    fast = wall_volumes(chamber, e, 1e5, GRAVITY)
    ramp = 2.0 * math.pi * 0.2 * 0.05 * 0.05 / (2.0 * beta_of(1e5) * 0.15)
    np.testing.assert_allclose(fast.full, crescent, atol=ramp)
    np.testing.assert_allclose(fast.wetting, crescent, atol=ramp)
    np.testing.assert_allclose(fast.inner, ring, atol=ramp)
    assert np.all(fast.lid <= ramp)


def test_at_rest() -> None:
    """A still tank wets the whole floor at once, and touches the lid when it is full."""
    found = wall_volumes(Chamber(0.2, 0.05), 0.01, 0.0, GRAVITY)
    assert float(found.wetting) == 0.0
    whole = pytest.approx(Chamber(0.2, 0.05).capacity, rel=1e-14)
    assert float(found.lid) == whole and float(found.full) == whole


def test_by_finite_elements() -> None:
    """The same surfaces on quadratic triangles, whose wall runs 1e-7 e inside the circle on the average."""
    radius, h, e, speed, inner = 0.2, 0.05, 0.02, 30.0, 0.12
    beta = beta_of(speed)
    found = wall_volumes(Chamber(radius, h, inner), e, speed, GRAVITY)
    section = default_disc(radius, 2.0 * e, inner_radius=inner)
    rises = (
        (found.lid, h),
        (found.inner, beta * ((radius + e) ** 2 - (inner + e) ** 2)),
        (found.full, h + beta * ((radius + e) ** 2 - (radius - e) ** 2)),
    )
    for exact, rise in rises:
        volume = float(integrate_surface(section, h, beta, rise, axis=(-e, 0.0)).volume)
        # What is lost there is as high as the chamber at most.
        assert volume == pytest.approx(float(exact), rel=1e-9, abs=2.0 * math.pi * radius * h * 1e-7 * e)


def test_what_they_mean() -> None:
    """With each the surface stands where its name says, by the solved equilibrium."""
    for chamber, e, speed in (
        (Chamber(0.2, 0.05), 1e-3, 90.0),
        (Chamber(0.2, 0.05), 0.02, 4.0),  # it covers the floor
        (Chamber(0.2, 0.05, 0.1), 0.02, 30.0),
    ):
        met = wall_volumes(chamber, e, speed, GRAVITY)
        assert float(equilibrium(chamber, met.wetting, e, speed).nearest_depth) == pytest.approx(
            0.0, abs=1e-9
        )
        assert float(equilibrium(chamber, met.lid, e, speed).wetted_height) == pytest.approx(1.0, rel=1e-9)
        assert float(equilibrium(chamber, met.full, e, speed).nearest_depth) == pytest.approx(1.0, rel=1e-9)
        if chamber.inner_radius > 0.0:
            touching = float(equilibrium(chamber, met.inner, e, speed).surface_constant)
            assert touching == pytest.approx(-beta_of(speed) * (chamber.inner_radius + e) ** 2, rel=1e-9)


def test_what_more_does() -> None:
    """Upright, more than wets the wall adds to the unbalance until it is wet to the lid, then nothing."""
    chamber, e, speed = Chamber(0.2, 0.05), 1e-3, 30.0
    met = wall_volumes(chamber, e, speed, GRAVITY)
    volumes = np.array([met.wetting, 0.5 * (met.wetting + met.full), met.full, 1.5 * met.full])
    moment = equilibrium(chamber, volumes, e, speed).unbalance()[0]
    most = math.pi * 0.2**2 * 0.05 * e
    assert moment[0] < 0.5 * most and moment[0] < moment[1] < most
    np.testing.assert_allclose(moment[2:], most, rtol=1e-11)
    # From the foot of an inner wall on it changes again.
    ring = Chamber(0.2, 0.05, 0.18)
    met = wall_volumes(ring, e, 90.0, GRAVITY)
    assert met.full < met.inner < ring.capacity
    moment = equilibrium(ring, np.array([met.full, met.inner, 0.5 * (met.inner + ring.capacity)]), e, 90.0)
    found = moment.unbalance()[0] / most
    np.testing.assert_allclose(found[:2], 1.0, rtol=1e-11)
    assert found[2] < 0.99


def test_over_speed_and_deflection() -> None:
    """Faster spin lifts what wets the wall, lowers what reaches the lid; more deflection parts them."""
    chamber, speed = Chamber(0.2, 0.05), np.linspace(1.0, 200.0, 80)
    met = wall_volumes(chamber, 2e-3, speed, GRAVITY)
    assert np.all(np.diff(met.wetting) > 0.0)
    assert np.all(np.diff(met.lid) < 0.0) and np.all(np.diff(met.full) < 0.0)
    met = wall_volumes(chamber, np.linspace(0.0, 0.1, 60), 40.0, GRAVITY)
    assert np.all(np.diff(met.wetting) > 0.0) and np.all(np.diff(met.full) > 0.0)
    assert np.all(np.diff(met.lid) < 0.0)


def test_one_chamber_for_each_state() -> None:
    many = Chambers(np.array([0.2, 0.1]), np.array([0.05, 0.04]), np.array([0.0, 0.05]))
    met = wall_volumes(many, np.full(2, 1e-3), 50.0, GRAVITY)
    for k, one in enumerate((Chamber(0.2, 0.05), Chamber(0.1, 0.04, 0.05))):
        np.testing.assert_array_equal([each[k] for each in met], wall_volumes(one, 1e-3, 50.0, GRAVITY))


def test_units_of_length_and_time() -> None:
    """Three times as large under three times the gravity, and twice as fast under four times: alike."""
    chamber, e = Chamber(0.2, 0.05, 0.12), np.array([0.0, 1e-3, 0.02])
    plain = wall_volumes(chamber, e, 40.0, GRAVITY)
    large = wall_volumes(Chamber(0.6, 0.15, 0.36), 3.0 * e, 40.0, 3.0 * GRAVITY)
    fast = wall_volumes(chamber, e, 80.0, 4.0 * GRAVITY)
    for one, wide, quick in zip(plain, large, fast, strict=True):
        np.testing.assert_allclose(wide, 27.0 * one, rtol=1e-12, atol=1e-18)
        np.testing.assert_allclose(quick, one, rtol=1e-12, atol=1e-18)
