"""The free surface on other sections: any polygon, any mesh of the same section, parts, turned sections."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.paraboloid import Moments
from meshes.arrays import Array
from meshes.quality import triangle_areas
from meshes.section import Section, annulus, disc, section_area
from solvers.statics.free_surface import integrate_surface, solve_surface
from tests.mutants import kills
from tests.solvers.statics.test_free_surface import (
    HEIGHT,
    NAMES,
    RADIUS,
    agree,
    beta_of,
    depth_at,
    panels,
    round_chamber,
    values,
)


def rectangle(x0: float, x1: float, y0: float, y1: float, floor: float, ramp: float) -> Array:
    """Moments, in the order of NAMES, over a rectangle, by iterated quadrature; the axis is at the origin."""
    squares = [s for s in (floor, floor + ramp) if s > 0.0]
    chords = [math.sqrt(s - y * y) for s in squares for y in (0.0, y0, y1) if s > y * y]
    total = np.zeros(10)
    for x, wx in zip(
        *panels([x0, x1, *(m for c in chords for m in (c, -c) if x0 < m < x1)], 40), strict=True
    ):
        halves = [math.sqrt(s - x * x) for s in squares if s > x * x]
        y, wy = panels([y0, y1, *(m for c in halves for m in (c, -c) if y0 < m < y1)], 40)
        h = depth_at(x * x + y * y, floor, ramp)
        one = np.ones_like(y)
        rows = [one, x * one, y, h / 2, x * x * one, y * y, h * h / 3, x * y, x * h / 2, y * h / 2]
        total += wx * (np.array(rows) @ (wy * h))
    return total


def square_mesh(count: int, x0: float, x1: float, y0: float, y1: float) -> Section:
    """Straight triangles, two to each cell of a grid."""
    x, y = np.meshgrid(np.linspace(x0, x1, count + 1), np.linspace(y0, y1, count + 1), indexing="ij")
    a = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    b, c, d = a + count + 1, a + count + 2, a + 1
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return Section(np.stack([x.ravel(), y.ravel()], axis=1), triangles)


def bent_disc(segments: int) -> Section:
    """Quadratic disc whose inner edges are bent as well, by a smooth displacement."""
    section = disc(RADIUS, segments, order=2)
    x, y = section.points.T
    return Section(section.points + 0.3 * np.stack([y * y, x * y - x * x], axis=1), section.triangles)


def quartered(section: Section) -> Section:
    """Each quadratic triangle cut in four along its own map: other elements, exactly the same section."""
    lattice = [(0, 0), (4, 0), (0, 4), (2, 0), (2, 2), (0, 2), (1, 0), (3, 0), (3, 1), (1, 3), (0, 3), (0, 1)]
    lattice += [(1, 1), (2, 1), (1, 2)]
    p, q = np.array(lattice).T / 4.0
    r = 1.0 - p - q
    shape = np.array([r * (2 * r - 1), p * (2 * p - 1), q * (2 * q - 1), 4 * r * p, 4 * p * q, 4 * q * r])
    points = np.einsum("mia,ik->mka", section.points[section.triangles], shape).reshape(-1, 2)
    parts = [[0, 3, 5, 6, 12, 11], [3, 1, 4, 7, 8, 13], [5, 4, 2, 14, 9, 10], [3, 4, 5, 13, 14, 12]]
    first = 15 * np.arange(len(section.triangles))[:, None, None]
    return Section(points, (first + np.array(parts)).reshape(-1, 6))


def test_bent_mesh() -> None:
    """On the same section every mesh gives the same, however its elements lie: the integrals are exact.

    Elements of the coarse mesh are as large as their distance from the axis, which leaves nine digits.
    """
    coarse = bent_disc(8)
    fine = quartered(coarse)
    finest = quartered(fine)
    for axis in ((0.0, 0.0), (0.013, -0.007), (-0.17, 0.05), (0.3, 0.2)):
        for beta in (0.5, beta_of(20.0), beta_of(300.0), math.inf):
            for dry_radius in (0.01, 0.1, 0.2):
                a, b, c = (
                    integrate_surface(mesh, HEIGHT, beta, dry_radius=dry_radius, axis=axis)
                    for mesh in (coarse, fine, finest)
                )
                agree(a, c, 1e-8, 0.2)
                agree(b, c, 1e-10, 0.2)


def test_dry_spot_inside_a_triangle() -> None:
    """A dry spot, or a spot clear of the lid, anywhere in a coarse polygon: the rest in closed form.

    With the lid dry, V = beta (J - a^2 A) + beta pi a^4/2, A and J the polygon's area and polar moment about
    the axis; with the lid wet outside r = b and the floor covered, V = h A - beta pi b^4/2.
    """
    section = disc(RADIUS, 8)
    area = section_area(section)
    for axis in ((0.0, 0.0), (0.01, 0.003), (-0.05, 0.0)):
        corners = (section.points - np.array(axis))[section.triangles]
        parts = triangle_areas(section.points, section.triangles)
        summed = corners.sum(axis=1)
        polar = float(parts @ ((corners**2).sum(axis=(1, 2)) + (summed**2).sum(axis=1)) / 12.0)
        for a in (1e-9, 1e-4, 3e-3, 0.02, 0.05):
            beta = 0.1
            found = integrate_surface(section, HEIGHT, beta, dry_radius=a, axis=axis)
            exact = beta * (polar - a**2 * area) + beta * math.pi * a**4 / 2
            assert float(found.volume) == pytest.approx(exact, rel=1e-9)
        for b in (1e-4, 0.02, 0.1):
            beta = 0.9 * HEIGHT / b**2
            wetted = HEIGHT + beta * (_farthest(corners) - b**2)
            found = integrate_surface(section, HEIGHT, beta, wetted, axis=axis)
            exact = area * HEIGHT - beta * math.pi * b**4 / 2
            assert float(found.volume) == pytest.approx(exact, rel=1e-9)


def _farthest(corners: Array) -> float:
    return float(np.sum(corners**2, axis=-1).max())


def test_square() -> None:
    """Two triangles, and many, against iterated quadrature; axis inside, on a corner and outside."""
    for count in (1, 7):
        for x0, y0 in ((-0.05, -0.06), (0.0, 0.0), (0.1, -0.04)):
            section = square_mesh(count, x0, x0 + 0.12, y0, y0 + 0.12)
            for speed, dry_radius in ((15.0, 0.06), (200.0, 0.11)):
                floor, ramp = dry_radius**2, HEIGHT / beta_of(speed)
                exact = rectangle(x0, x0 + 0.12, y0, y0 + 0.12, floor, ramp)
                found = integrate_surface(section, HEIGHT, beta_of(speed), dry_radius=dry_radius)
                agree(found, exact, 1e-7 if count == 1 else 1e-9, 0.12)


def test_l_shape_is_the_sum_of_its_squares() -> None:
    """Three squares in one mesh, solved for a volume, then summed by quadrature at that surface."""
    unit = square_mesh(4, 0.0, 0.1, 0.0, 0.1)
    corners = [(-0.12, -0.08), (-0.02, -0.08), (-0.12, 0.02)]
    count = len(unit.points)
    points = np.concatenate([unit.points + np.array(corner) for corner in corners])
    section = Section(points, np.concatenate([unit.triangles + k * count for k in range(3)]))
    for speed in (12.0, 90.0):
        beta = beta_of(speed)
        solution = solve_surface(section, HEIGHT, beta, 3e-4)
        floor = -solution.surface_constant / beta
        exact = sum(rectangle(x, x + 0.1, y, y + 0.1, floor, HEIGHT / beta) for x, y in corners)
        assert exact[0] == pytest.approx(3e-4, rel=1e-9)
        agree(solution.moments, exact, 1e-9, 0.15)


def test_parts_add_up_to_the_whole() -> None:
    """Any ragged part of a mesh is a section; it and the rest hold what the whole holds."""
    whole = disc(RADIUS, 32, order=2)
    mine = np.hypot(*(whole.points[whole.triangles[:, 0]] - 0.1).T) < 0.12
    parts = [Section(whole.points, whole.triangles[chosen]) for chosen in (mine, ~mine)]
    for speed in (10.0, 100.0):
        everything, *shares = (
            integrate_surface(section, HEIGHT, beta_of(speed), dry_radius=0.17, axis=(-0.02, 0.01))
            for section in (whole, *parts)
        )
        agree(everything, values(shares[0]) + values(shares[1]), 1e-9, RADIUS)


@kills("solvers.statics.free_surface:_all_moments", "third, x * y * depth", "third, x * x * depth")
def test_turned() -> None:
    """Turning section and axis by a quarter turns the moments: (x, y) becomes (-y, x)."""
    section, axis = bent_disc(12), (-0.03, 0.01)
    turned = Section(np.stack([-section.points[:, 1], section.points[:, 0]], axis=1), section.triangles)
    a = integrate_surface(section, HEIGHT, beta_of(40.0), dry_radius=0.18, axis=axis)
    b = integrate_surface(turned, HEIGHT, beta_of(40.0), dry_radius=0.18, axis=(-axis[1], axis[0]))
    expected = Moments(a.volume, -a.y, a.x, a.z, a.yy, a.xx, a.zz, -a.xy, -a.yz, a.xz)
    agree(b, expected, 1e-13, RADIUS)
    assert abs(float(a.y)) > 1e-3 * abs(float(a.x))
    assert abs(float(a.xy)) > 1e-3 * float(a.xx)


@pytest.mark.parametrize(("inner", "e"), [(0.05, 0.01), (0.15, 0.03), (0.1, 0.15), (0.1, 0.5)])
def test_annulus_is_one_disc_minus_another(inner: float, e: float) -> None:
    """The inner wall dry, reached by the liquid, holding the axis or not."""
    section = annulus(RADIUS, inner, 64, order=2)
    for speed, fill in ((10.0, 0.1), (60.0, 0.3), (60.0, 0.9)):
        beta, capacity = beta_of(speed), section_area(section) * HEIGHT
        solution = solve_surface(section, HEIGHT, beta, fill * capacity, axis=(-e, 0.0))
        floor, ramp = -solution.surface_constant / beta, HEIGHT / beta
        outer, core = (round_chamber(r, e, floor, ramp) for r in (RADIUS, inner))
        # Either wall is off by slivers of b^4/30 of its disc, with opposite signs; edges of one length have
        # b = pi/64 outside, R/R_i times as much inside.
        slivers = (math.pi / 64) ** 4 / 30 * math.pi * RADIUS**2 * HEIGHT * (RADIUS / inner) ** 2
        exact = np.array([outer[name] - core[name] for name in NAMES])
        agree(solution.moments, exact, 1.01 * slivers / (fill * capacity), RADIUS + e)


def test_depth_is_that_of_the_paraboloid() -> None:
    """A needle of a section samples H(r): its volume over its area is the depth there."""
    beta, axis = beta_of(25.0), (-0.02, 0.0)
    for r in (0.12, 0.15, 0.19):
        points = np.array([[r, 0.0], [r + 1e-7, 0.0], [r, 1e-7]]) + np.array(axis)
        needle = Section(points, np.array([[0, 1, 2]]))
        found = integrate_surface(needle, HEIGHT, beta, dry_radius=0.14, axis=axis)
        depth = min(max(beta * (r**2 - 0.14**2), 0.0), HEIGHT)
        # Over 1e-7 m the surface rises by 2 beta r 1e-7 at most.
        assert float(found.volume) / section_area(needle) == pytest.approx(depth, abs=2 * beta * r * 1e-7)
