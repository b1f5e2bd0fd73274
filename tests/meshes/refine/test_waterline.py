"""Cut triangles: distances from the axis, and areas outside circles, on straight and curved edges."""

from __future__ import annotations

import math

import numpy as np
import pytest

from meshes.quality import EDGES
from meshes.refine.waterline import beyond, distance_range, monotone_arcs
from meshes.section import Section, disc, section_area
from tests.mutants import kills

AXES = [(0.0, 0.0), (0.013, -0.007), (-0.2, 0.0), (0.1, 0.1), (-0.5, 0.3)]


def bent_disc() -> Section:
    """A coarse quadratic disc whose inner edges are bent as well, by a smooth displacement."""
    section = disc(0.2, 8, order=2)
    x, y = section.points.T
    return Section(section.points + 0.3 * np.stack([y * y, x * y - x * x], axis=1), section.triangles)


def beyond_circle(section: Section, axis: tuple[float, float], radius: float) -> np.ndarray:
    """Area and first moments about the axis of the part of a section outside a circle, by the arcs alone."""
    arcs = monotone_arcs(section, axis)
    least, largest = distance_range(arcs, len(section.triangles))
    square, of = radius**2, arcs.triangle
    x, y, weight = beyond(arcs, least[of], largest[of], square, square * (1.0 + 1e-12))
    return np.stack([np.ones_like(x), x, y]) @ weight


@kills("meshes.refine.waterline:beyond", "curve[1] + 2.0 * t * curve[2]", "curve[1] + t * curve[2]")
@kills("meshes.refine.waterline:beyond", "(x * dy - y * dx)", "(y * dx - x * dy)")
@kills("meshes.refine.waterline:_along_rays", "* _RAY[1] * fraction\n", "* _RAY[1]\n")
def test_whole_section() -> None:
    """Outside a circle of no size lies all of it, wherever the axis is."""
    for section in (disc(0.2, 8), bent_disc()):
        for axis in AXES:
            area = beyond_circle(section, axis, 1e-9)[0]
            # Triangles as large as their distance from the axis keep some ten digits; the circle has 1e-17.
            assert area == pytest.approx(section_area(section), rel=1e-9)


@kills("meshes.refine.waterline:_extremes", "3.0 * np.sum(c1 * c2, axis=0)", "2.0 * np.sum(c1 * c2, axis=0)")
def test_hole() -> None:
    """A circle within the section takes away its area, and its moment about its own centre is nothing."""
    for section in (disc(0.2, 8), bent_disc()):
        area, x, y = beyond_circle(section, (0.0, 0.0), 1e-9)
        for axis in AXES[:2]:
            for radius in (1e-5, 1e-3, 0.02, 0.1):
                found = beyond_circle(section, axis, radius)
                about = [area, x - axis[0] * area, y - axis[1] * area]
                assert found[0] == pytest.approx(area - math.pi * radius**2, rel=1e-9)
                assert found[1:] == pytest.approx(about[1:], abs=1e-9 * 0.2 * area)


@kills(
    "meshes.refine.waterline:_crossing",
    "x * x + y * y - level",
    "x * x + y * y - 0.9 * level",
)
@kills("meshes.refine.waterline:beyond", "np.sqrt(np.minimum(origin, square)", "(np.minimum(origin, square)")
def test_half_plane() -> None:
    """A straight wall at distance d from the axis leaves a circular segment of closed area."""
    square = Section(np.array([[0.0, -1], [1, -1], [1, 1], [0, 1]]), np.array([[0, 1, 2], [0, 2, 3]]))
    for distance in (0.0, 0.05, 0.3):
        for radius in (0.4, 0.7, 0.9):
            half = math.acos(distance / radius)
            inside = radius**2 * (half - math.sin(half) * math.cos(half))
            found = beyond_circle(square, (-distance, 0.0), radius)[0]
            # Two triangles as large as the circle: the edge rule's 8 points see the pole at the axis from a
            # distance like the length of the pieces, and keep 8 digits.
            assert found == pytest.approx(2.0 - inside, rel=1e-8)


@pytest.mark.parametrize("axis", AXES)
def test_arcs_cover_each_edge_and_are_monotone(axis: tuple[float, float]) -> None:
    section = bent_disc()
    arcs = monotone_arcs(section, axis)
    assert np.bincount(arcs.triangle, np.abs(arcs.far - arcs.near)) == pytest.approx(3.0, rel=1e-14)
    t = arcs.near + np.linspace(0.0, 1.0, 50)[:, None] * (arcs.far - arcs.near)
    x, y = (arcs.curve[0][:, None] + t * (arcs.curve[1][:, None] + t * arcs.curve[2][:, None])).reshape(
        2, 50, -1
    )
    square = x * x + y * y
    # The ends of the arcs are found to rounding of t, where the slope is zero.
    assert np.all(np.diff(square, axis=0) >= -1e-16)
    assert square[0] == pytest.approx(arcs.near_square, abs=1e-16)
    assert square[-1] == pytest.approx(arcs.far_square, abs=1e-16)


def check_range(axis: tuple[float, float] = AXES[1]) -> None:
    """Bounds from above and below by samples along the edges."""
    section = bent_disc()
    least, largest = distance_range(monotone_arcs(section, axis), len(section.triangles))
    t = np.linspace(0.0, 1.0, 401)[:, None, None, None]
    start, end, middle = (section.points[section.triangles[:, EDGES[:, k]]] for k in range(3))
    edge = (1 - t) * (1 - 2 * t) * start + t * (2 * t - 1) * end + 4 * t * (1 - t) * middle
    square = np.sum((edge - np.array(axis)) ** 2, axis=-1).transpose(1, 0, 2).reshape(len(start), -1)
    # Between samples the squared distance can rise or fall by its curvature over the step, 1/401^2.
    slack = 2 * square.max() / 401**2
    assert np.all(largest >= square.max(axis=1) - 1e-16)
    assert np.all(largest <= square.max(axis=1) + slack)
    assert np.all(least <= square.min(axis=1) + 1e-16)
    outside = least > 0.0
    assert np.all(least[outside] >= square.min(axis=1)[outside] - slack)
    # One triangle holds the axis, or several share it; none if it lies outside the section.
    held = math.hypot(*axis) < 0.15
    assert np.any(least < 1e-20) == held
    assert np.sum((least == 0.0) & (square.min(axis=1) > slack)) <= 1


@pytest.mark.parametrize("axis", AXES)
def test_range_of_the_distance(axis: tuple[float, float]) -> None:
    check_range(axis)


@kills("meshes.refine.waterline:distance_range", "(xa * yb - ya * xb, xa * xb", "(xa * yb + ya * xb, xa * xb")
def test_range_about_one_axis() -> None:
    check_range()
