import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fluid.paraboloid import Lens, lens_moments
from meshes.errors import InputError
from tests.mutants import kills

EPS = np.finfo(float).eps


def reference(r: float, radius: float, e: float) -> list[mp.mpf]:
    """A, S, J, T by integrating over the arcs of circles about the rotation axis, 25 digits."""
    with mp.workdps(25):
        r_, R, d = mp.mpf(r), mp.mpf(radius), mp.mpf(e)

        def phi(p: mp.mpf) -> mp.mpf:
            if p <= R - d:
                return mp.pi
            return mp.acos(max(mp.mpf(-1), min(mp.mpf(1), (p * p + d * d - R * R) / (2 * d * p))))

        near, far = max(mp.mpf(0), d - R), min(r_, R + d)
        marks = sorted({p for p in (near, abs(R - d), far) if near <= p <= far})
        if len(marks) < 2:
            return [mp.mpf(0)] * 4
        integrands = (
            lambda p: 2 * phi(p) * p,
            lambda p: 2 * mp.sin(phi(p)) * p**2,
            lambda p: 2 * phi(p) * p**3,
            lambda p: 2 * mp.sin(phi(p)) * p**4,
        )
        return [mp.quad(f, marks) for f in integrands]


def four(lens: Lens) -> tuple[np.ndarray, ...]:
    return lens.area, lens.x, lens.polar, lens.x_polar


def assert_matches_quadrature(r: float, radius: float, e: float) -> None:
    # Rounding of the three lengths moves the arcs by eps times their sum; the moments follow with that power.
    # Measured over 150 draws: 0.9 eps, taken as 4.
    scale = min(r, radius + e) + radius + e
    for power, got, want in zip(
        (2, 3, 4, 5), four(lens_moments(r, radius, e)), reference(r, radius, e), strict=True
    ):
        assert abs(mp.mpf(float(got)) - want) <= 4 * EPS * scale**power


@settings(max_examples=40)
@given(
    radius=st.floats(0.02, 2.0),
    ratio=st.one_of(st.floats(0.0, 3.0), st.floats(-8.0, 0.0).map(lambda x: 10.0**x)),
    place=st.floats(0.0, 1.0),
)
def test_crossing_circles_match_quadrature(radius: float, ratio: float, place: float) -> None:
    e = ratio * radius
    assert_matches_quadrature(abs(radius - e) + 2.0 * place * min(radius, e), radius, e)


@settings(max_examples=30)
@given(radius=st.floats(0.02, 2.0), ratio=st.floats(0.0, 3.0), r=st.floats(0.0, 10.0))
def test_any_circles_match_quadrature(radius: float, ratio: float, r: float) -> None:
    assert_matches_quadrature(r, radius, ratio * radius)


@kills("fluid.paraboloid:lens_moments", "0.5 * np.pi * whole**4", "0.25 * np.pi * whole**4")
def test_disc_inside_the_chamber() -> None:
    lens = lens_moments(0.3, 1.0, 0.5)
    np.testing.assert_allclose(four(lens), [np.pi * 0.09, 0.0, np.pi / 2 * 0.3**4, 0.0], rtol=4 * EPS)


@pytest.mark.parametrize("e", [0.0, 1e-310, 1e-12, 0.4, 1.0, 7.0])
def test_disc_that_holds_the_chamber(e: float) -> None:
    # Steiner: int x (x^2 + y^2) over a unit disc about (e, 0) is pi (e^3 + e).
    want = [np.pi, np.pi * e, np.pi * (0.5 + e * e), np.pi * (e**3 + e)]
    for r in (1.0 + e, 30.0, np.inf):
        np.testing.assert_allclose(four(lens_moments(r, 1.0, e)), want, rtol=8 * EPS)


def test_discs_apart() -> None:
    assert np.all(np.array(four(lens_moments([0.0, 0.5, 1.0], 1.0, 2.0))) == 0.0)


def test_equal_discs_at_one_radius() -> None:
    # The vesica: 2 pi/3 - sqrt(3)/2, its centre of mass half way between the centres.
    lens = lens_moments(1.0, 1.0, 1.0)
    area = 2 * np.pi / 3 - np.sqrt(3) / 2
    np.testing.assert_allclose([lens.area, lens.x], [area, 0.5 * area], rtol=8 * EPS)


def test_derivatives() -> None:
    """A ring dr adds its arc: dJ = r^2 dA and dT = r^2 dS, and dA, dS are the arc's own."""
    e, radius = np.array([0.3, 0.9, 1.0, 1.7])[:, None], 1.0
    r = np.abs(radius - e) + np.array([0.1, 0.5, 0.8]) * 2.0 * np.minimum(radius, e)
    step = 1e-5
    upper, lower = lens_moments(r + step, radius, e), lens_moments(r - step, radius, e)
    rates = [(a - b) / (2 * step) for a, b in zip(four(upper), four(lower), strict=True)]
    phi = np.arccos((r**2 + e**2 - radius**2) / (2 * e * r))
    want = (2 * phi * r, 2 * np.sin(phi) * r**2, 2 * phi * r**3, 2 * np.sin(phi) * r**4)
    # Central differences: step^2/6 times a third derivative, at most 1e3 here, and rounding.
    for got, expected in zip(rates, want, strict=True):
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e3 * step**2 / 6 + 100 * EPS / step)


def test_continuous_where_the_regime_changes() -> None:
    for e in (0.3, 1.0, 2.0):
        for edge in (abs(1.0 - e), 1.0 + e):
            below = lens_moments(np.nextafter(edge, 0.0), 1.0, e)
            above = lens_moments(np.nextafter(edge, 9.0), 1.0, e)
            # The arcs there are at most 2 pi edge long.
            np.testing.assert_allclose(four(below), four(above), rtol=0, atol=60 * EPS * (1.0 + edge) ** 5)


def test_arrays_broadcast() -> None:
    lens = lens_moments(np.full((3, 1), 0.5), 1.0, np.array([0.0, 0.7]))
    assert lens.area.shape == lens.x_polar.shape == (3, 2)


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((1.0, 0.0, 0.1), "radius"),
        ((-1.0, 1.0, 0.1), "disc_radius"),
        ((np.nan, 1.0, 0.1), "disc_radius"),
        ((1.0, 1.0, -0.1), "eccentricity"),
        ((1.0, 1.0, np.inf), "eccentricity"),
    ],
)
def test_bad_input(arguments: tuple[float, float, float], field: str) -> None:
    with pytest.raises(InputError) as caught:
        lens_moments(*arguments)
    assert caught.value.field == field


@kills("fluid.paraboloid:_own_segment", "return r**2 * area, r**4", "return r**2 * area / 2.0, r**4")
@kills("fluid.paraboloid:lens_moments", "first = (2.0 / 3.0)", "first = (1.0 / 3.0)")
@kills("fluid.paraboloid:lens_moments", "- 2.0 * e * first + polar", "+ 2.0 * e * first + polar")
@kills("fluid.paraboloid:lens_moments", "0.0, e * area)", "0.0, 0.5 * e * area)")
@kills("fluid.paraboloid:lens_moments", "across - radius * cos * first", "across + radius * cos * first")
def test_three_pairs_of_circles_match_quadrature() -> None:
    for r, e in ((0.8, 0.5), (1.3, 0.5), (1.4, 1.2)):
        assert_matches_quadrature(r, 1.0, e)
