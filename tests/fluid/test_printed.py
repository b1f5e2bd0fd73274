from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy import integrate

from fluid.paraboloid import lens_moments
from fluid.printed import (
    dry_radius_as_printed,
    dry_volume_as_printed,
    dry_volume_frozen_angle,
    liquid_angle_as_printed,
    liquid_volume_by_lens,
    optimal_volume_as_printed,
    optimal_volume_by_lens,
    optimal_volume_disc_corrected,
)
from meshes.chamber import Chamber
from meshes.errors import InputError
from tests.mutants import kills

G = 9.81
EPS = np.finfo(float).eps
WIDE = Chamber(radius=0.2, height=0.05)
SMALL = Chamber(radius=0.05, height=0.02)


def steepness(speed: float) -> float:
    return speed**2 / (2.0 * G)


def liquid_by_heights(chamber: Chamber, printed_constant: float, e: float, speed: float) -> float:
    """Chamber minus the lenses of air, height by height: no antiderivative in z."""
    beta = steepness(speed)
    h, c = chamber.height, printed_constant
    kinks = [beta * (chamber.radius + side * e) ** 2 - c for side in (-1.0, 1.0)]
    marks = np.unique(np.clip([0.0, -c, *kinks, h], 0.0, h))
    air = 0.0
    for low, high in pairwise(marks):
        if high + c > 0.0:
            # z = low + (high - low)(1 - cos(t))/2 smooths the square roots at the kinks.
            def section(t: float, low: float = low, high: float = high) -> float:
                z = low + 0.5 * (high - low) * (1.0 - np.cos(t))
                area = lens_moments(np.sqrt(max(z + c, 0.0) / beta), chamber.radius, e).area
                return float(area) * 0.5 * (high - low) * np.sin(t)

            air += integrate.quad(section, 0.0, np.pi, epsabs=0.0, epsrel=1e-12, limit=200)[0]
    return chamber.capacity - air


@kills(
    "fluid.printed:liquid_volume_by_lens",
    "(level * float(lens.area) - beta",
    "(level * float(lens.area) + beta",
)
def test_volume_by_lens_is_the_sum_over_heights() -> None:
    for chamber, speed in ((WIDE, 20.0), (WIDE, 90.0), (SMALL, 100.0)):
        beta = steepness(speed)
        for e in (0.001, 0.3 * chamber.radius, 1.2 * chamber.radius):
            # Floor covered, surface clear of the wall, wall cut, all but empty.
            R = chamber.radius
            for squared in (-0.1 * R**2, 0.1 * R**2, R**2, 0.99 * (R + e) ** 2):
                c = beta * squared
                got = liquid_volume_by_lens(chamber, c, e, speed, G)
                # Rounding: beta times the lens's moments, of the order beta (R + e)^4, against each other.
                slack = 100 * EPS * beta * (chamber.radius + e) ** 4 + 1e-11 * chamber.capacity
                assert abs(got - liquid_by_heights(chamber, c, e, speed)) <= slack


@settings(max_examples=60)
@given(fill=st.floats(0.05, 0.95), speed=st.floats(15.0, 200.0), offset=st.floats(0.0, 1.0))
def test_eq_17_is_exact_while_the_surface_is_clear_of_the_wall(
    fill: float, speed: float, offset: float
) -> None:
    beta, h = steepness(speed), WIDE.height
    volume = fill * WIDE.capacity
    c = beta * WIDE.radius**2 - beta * volume / (np.pi * h) - 0.5 * h  # C* as printed
    # Clear: the air is one paraboloid from floor to lid, and its rim at the lid stays inside the wall.
    assume(c >= 0.0)
    room = WIDE.radius - np.sqrt((h + c) / beta)
    assume(room > 0.0)
    got = liquid_volume_by_lens(WIDE, c, offset * room, speed, G)
    assert got == pytest.approx(volume, rel=0, abs=100 * EPS * beta * WIDE.radius**4)


# Millilitres, from adaptive quadrature in 30 digits.
OPTIMAL = [
    (WIDE, 90.0, 1e-3, 54.43957239),
    (WIDE, 90.0, 3e-3, 178.3088703),
    (WIDE, 90.0, 10e-3, 603.5171603),
    (WIDE, 20.0, 1e-3, 7.660266099),
    (WIDE, 20.0, 3e-3, 68.48354943),
    (WIDE, 20.0, 10e-3, 458.8148245),
    (SMALL, 100.0, 1e-3, 5.179335154),
    (SMALL, 100.0, 3e-3, 17.16556767),
    (SMALL, 100.0, 10e-3, 55.38914207),
]


@pytest.mark.parametrize(("chamber", "speed", "e", "millilitres"), OPTIMAL)
def test_optimal_volume(chamber: Chamber, speed: float, e: float, millilitres: float) -> None:
    # Ten digits are given; rounding of chamber minus air adds beta R^4 eps over the volume.
    slack = 5e-10 * millilitres * 1e-6 + 100 * EPS * steepness(speed) * chamber.radius**4
    assert optimal_volume_by_lens(chamber, e, speed, G) == pytest.approx(millilitres * 1e-6, rel=0, abs=slack)


@kills(
    "fluid.printed:dry_radius_as_printed",
    "return chamber.radius - eccentricity",
    "return chamber.radius + eccentricity",
)
def test_optimal_volume_of_one_chamber() -> None:
    chamber, speed, e, millilitres = OPTIMAL[0]
    assert optimal_volume_by_lens(chamber, e, speed, G) == pytest.approx(millilitres * 1e-6, rel=1e-8)


def test_optimal_volume_at_high_speed() -> None:
    # The surface is a cylinder that touches the near wall. Each height moves its radius by h/(2 beta R).
    R, h, e, speed = WIDE.radius, WIDE.height, 0.003, 2000.0
    spread = 2 * np.pi * h * h / (2 * steepness(speed))
    assert optimal_volume_by_lens(WIDE, e, speed, G) == pytest.approx(
        np.pi * h * (R**2 - (R - e) ** 2), rel=0, abs=spread
    )


def test_eq_18_as_printed_is_litres_off() -> None:
    # More than the chamber holds (6.3 litres).
    assert optimal_volume_as_printed(WIDE, 1e-3, 90.0, G) == pytest.approx(2.040, rel=1e-3)


@kills("fluid.printed:_disc_volume", "s**2 * (far - near) ** 2 / 16.0", "s**2 * (far - near) ** 2 / 8.0")
def test_corrected_eq_18() -> None:
    """Chamber minus the air over a round lid section of diameter s and the dry disc on the floor."""
    R, h, e, speed = WIDE.radius, WIDE.height, 0.003, 90.0
    beta = steepness(speed)
    a = R - e
    b = np.sqrt(a**2 + h / beta)
    centre, rho = 0.5 * (b - a), 0.5 * (a + b)

    def ring(phi: float) -> float:
        # int (h - z) r dr up to the rim of the disc about (centre, 0), seen from the rotation axis.
        edge = centre * np.cos(phi) + np.sqrt(rho**2 - (centre * np.sin(phi)) ** 2)
        return (h + beta * a**2) * edge**2 / 2.0 - beta * edge**4 / 4.0

    lid = 2.0 * integrate.quad(ring, 0.0, np.pi, epsabs=0.0, epsrel=1e-13)[0]
    floor = np.pi * beta * a**4 / 2.0
    # Two numbers of the order beta R^4 are subtracted.
    assert optimal_volume_disc_corrected(WIDE, e, speed, G) == pytest.approx(
        np.pi * R**2 * h - (lid - floor), rel=0, abs=100 * EPS * beta * R**4
    )


def test_corrected_eq_18_integrates_the_disc_it_names() -> None:
    assert optimal_volume_disc_corrected(WIDE, 1e-3, 90.0, G) * 1e6 == pytest.approx(56.7, abs=0.05)


def test_eq_19_touches_the_near_wall() -> None:
    assert dry_radius_as_printed(WIDE, 0.003) == pytest.approx(0.197, rel=1e-15)


def wall_cut(fraction: float, e: float, speed: float) -> float:
    """C* of a waterline on the floor that far between the near and the far point of the wall."""
    radius = WIDE.radius - e + 2.0 * e * fraction
    return steepness(speed) * radius**2


@kills("fluid.printed:dry_volume_frozen_angle", "kite = h * root / (2.0 * beta)", "kite = h * root / beta")
@kills("fluid.printed:dry_volume_frozen_angle", "beta * (e**2 - R**2))", "beta * (R**2 - e**2))")
def test_repaired_eq_20_is_exact_for_a_steep_surface() -> None:
    """For a surface that rises steeply the angles hardly change with height, and eq. 20 repaired is exact."""
    e, speed = 0.05, 4000.0
    for fraction in (0.2, 0.5, 0.8):
        c = wall_cut(fraction, e, speed)
        exact = liquid_volume_by_lens(WIDE, c, e, speed, G)
        repaired = dry_volume_frozen_angle(WIDE, c, e, speed, G)
        # dA = alpha d(rho^2): with alpha frozen the error is of second order in the rise of rho^2 over the
        # height, h (h/beta)^2/6 times d(alpha)/d(rho^2) < 100/m^2, 1e-14 m^3; the rest is rounding.
        assert repaired == pytest.approx(exact, rel=0, abs=1e-14 + 100 * EPS * steepness(speed) * 0.25**4)


def test_repaired_eq_20_near_the_exact_volume() -> None:
    # At 90 rad/s the rise over the height is 15 % of the eccentricity's span: a few per cent.
    c = wall_cut(0.3, 0.003, 90.0)
    exact = liquid_volume_by_lens(WIDE, c, 0.003, 90.0, G)
    assert dry_volume_frozen_angle(WIDE, c, 0.003, 90.0, G) == pytest.approx(exact, rel=0.02)


def test_eq_20_as_printed_is_not_a_volume() -> None:
    assert dry_volume_as_printed(WIDE, wall_cut(0.3, 0.003, 90.0), 0.003, 90.0, G) < 0.0


@kills("fluid.printed:dry_volume_as_printed", "kite = h * chord / (4.0", "kite = h * math.sqrt(chord) / (4.0")
def test_eq_20_as_printed() -> None:
    """Term by term, at the radius where the arccosine is a right angle less its known rest."""
    e, speed = 0.003, 90.0
    beta, R, h = steepness(speed), WIDE.radius, WIDE.height
    c = beta * R**2
    p = -(c**2) + 2 * c * beta * (R**2 + e**2) - beta**2 * (R**2 - e**2) ** 2
    bracket = (
        R**2 * h / 2 * np.arccos((c - beta * (R**2 + e**2)) / (2 * e * R * beta))
        - h * p / (4 * e * beta**2)
        + h * (h + 2 * c) / (2 * beta) * (np.pi - np.tan(p / (2 * e * beta * (c - beta * (R**2 + e**2)))))
    )
    # p is a difference of numbers of the order c^2 that leaves 1e-4 of them; the tangent steepens that.
    assert dry_volume_as_printed(WIDE, c, e, speed, G) == pytest.approx(np.pi * R**2 * h - bracket, rel=1e-6)


def test_eq_25_as_printed_holds_for_equal_unbalances() -> None:
    for lag in (0.2, 0.9, 1.5):
        assert liquid_angle_as_printed(lag, 1.0) == pytest.approx(np.pi, abs=1e-7)


@kills("fluid.printed:liquid_angle_as_printed", "(square - ratio**2)", "(square - ratio)")
def test_eq_25_as_printed() -> None:
    lag, k = 0.6, 0.8
    alpha = liquid_angle_as_printed(lag, k)
    # The printed statement solved for the radicand: nothing of the code's form is used.
    root = -np.cos(alpha) - np.sin(lag) ** 2
    assert root**2 == pytest.approx(np.cos(lag) ** 2 * (k**2 - np.sin(lag) ** 2), rel=1e-12)
    assert root > 0.0


@pytest.mark.parametrize(
    ("call", "field"),
    [
        (lambda: optimal_volume_as_printed(WIDE, 1e-3, 0.0, G), "speed"),
        (lambda: optimal_volume_as_printed(WIDE, 1e-3, 90.0, 0.0), "gravity"),
        (lambda: optimal_volume_as_printed(WIDE, 1e-3, 1e300, 1e-300), "speed"),
        (lambda: optimal_volume_disc_corrected(WIDE, 0.2, 90.0, G), "eccentricity"),
        (lambda: optimal_volume_by_lens(Chamber(0.2, 0.05, 0.1), 1e-3, 90.0, G), "inner_radius"),
        (lambda: dry_volume_as_printed(WIDE, 0.0, 1e-3, 90.0, G), "surface_constant"),
        (lambda: dry_volume_frozen_angle(WIDE, np.nan, 1e-3, 90.0, G), "surface_constant"),
        (lambda: dry_volume_frozen_angle(WIDE, 16.0, 0.0, 90.0, G), "eccentricity"),
        (lambda: liquid_angle_as_printed(0.5, 0.2), "ratio"),
        (lambda: liquid_angle_as_printed(0.5, 1.2), "ratio"),
        (lambda: liquid_angle_as_printed(np.inf, 1.0), "lag"),
    ],
)
def test_bad_input(call, field: str) -> None:
    with pytest.raises(InputError) as caught:
        call()
    assert caught.value.field == field
