"""Sections cut by the circle of the free surface: areas, orders, pieces of walls; bisection; the inverse."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.errors import InputError
from meshes.liquid_section import LiquidSection, free_sides
from meshes.quality import assess, cell_areas, jacobians, vertex_angles
from meshes.refine.bisection import bisect, edge_numbers, quadratic_triangles, refine
from meshes.refine.circle_cut import Circle, follow_circle
from meshes.refine.waterline import area_outside, liquid_outside, surface_radius_of
from meshes.rings.sectors import sector
from meshes.rings.triangles import open_slits
from meshes.section import Section, annulus, disc, section_area
from tests.mutants import kills


def square(half: float, cells: int = 8) -> Section:
    """Square about the origin of right triangles."""
    x = np.linspace(-half, half, cells + 1)
    points = np.stack(np.meshgrid(x, x, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij"))
    a, b = i * (cells + 1) + j, (i + 1) * (cells + 1) + j
    return Section(points, np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)]))


def bent(section: Section, amount: float, seed: int = 0) -> Section:
    """A section moved by a smooth field, so that its walls are no circles and its edges are curved."""
    waves = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, 5))
    x, y = section.points.T / np.abs(section.points).max()
    terms = np.stack([x * y, x**2 - y**2, x**3 - x * y**2, np.sin(2 * x), np.cos(2 * y) - 1])
    scale = amount * np.abs(section.points).max()
    return Section(section.points + scale * (waves @ terms).T, section.triangles)


def arc_slack(liquid: LiquidSection) -> float:
    """Most that quadratic arcs of the free surface can lack: b^4/30 of their sectors, b half their angle."""
    start, end = (liquid.points[liquid.surface[:, k]] for k in (0, 1))
    b = np.arcsin(np.minimum(0.5 * np.hypot(*(end - start).T) / liquid.surface_radius, 1.0))
    # b^2/3 of it is the next term.
    return float(liquid.surface_radius**2 * np.sum(b**5 / 30.0 * (1.0 + b**2)))


def slide_slack(section: Section) -> float:
    """Most that walls can change where a vertex slides along.

    Their parabolas meet at a small angle there. A vertex slides by 0.3 of an edge of length h at most, and a
    parabola through the same wall with its end moved leaves it by the angle times that, over an edge or two.
    Six crossings are more than these sections have.
    """
    sides = free_sides(section.triangles)
    start, end, middle = (section.points[sides[:, k]] for k in range(3))
    leaving, arriving = 4.0 * middle - 3.0 * start - end, 3.0 * end + start - 4.0 * middle
    after = np.empty_like(arriving)
    after[np.argsort(sides[:, 1])] = leaving[np.argsort(sides[:, 0])]
    turn = (arriving[:, 0] * after[:, 1] - arriving[:, 1] * after[:, 0]) / (
        np.hypot(*arriving.T) * np.hypot(*after.T)
    )
    return float(6.0 * np.abs(turn).max() * 0.3 * np.max(np.sum((end - start) ** 2, axis=1)))


@kills("meshes.refine.waterline:_Split.outside", "square = radius * radius", "square = radius")
def test_area_outside() -> None:
    """A square beyond a circle within it, beyond one that cuts its sides, beyond one about its corner."""
    section = square(1.0)
    assert area_outside(section, 0.7) == pytest.approx(4.0 - math.pi * 0.49, rel=1e-9)
    half = math.acos(1.0 / 1.2)
    segments = 4 * 1.2**2 * (half - math.sin(half) * math.cos(half))
    assert area_outside(section, 1.2) == pytest.approx(4.0 - (math.pi * 1.44 - segments), rel=1e-9)
    assert area_outside(section, 1.0, axis=(1.0, 1.0)) == pytest.approx(4.0 - math.pi / 4, rel=1e-8)
    assert area_outside(section, 2.0) == 0.0
    assert area_outside(section, 0.0) == pytest.approx(4.0, rel=1e-12)


@kills(
    "meshes.refine.waterline:surface_radius_of",
    "farthest - depth) - liquid_area",
    "farthest - depth) - 1.01 * liquid_area",
)
def test_inverse() -> None:
    """The radius that leaves an area leaves it, down to layers of a millionth."""
    for section in (square(1.0), bent(disc(1.0, 32, order=2), 0.1), sector(1.0, 0.2, 1.1)):
        whole = section_area(section)
        for share in (1e-6, 1e-3, 0.3, 0.9):
            radius = surface_radius_of(section, share * whole)
            # Against the whole: the distance of the farthest node carries 1e-16 of it, its wall is as long.
            assert area_outside(section, radius) == pytest.approx(share * whole, rel=1e-8, abs=1e-13)


def test_cut_area() -> None:
    """Area of the mesh against the integral of the same section beyond the same circle."""
    for section in (
        disc(0.2, 48, order=2),
        bent(disc(0.2, 24, order=2), 0.1),
        square(0.2),
        annulus(0.2, 0.05, 32),
    ):
        for radius in (0.08, 0.13, 0.16, 0.19):
            liquid = liquid_outside(section, radius, order=2)
            area, exact = cell_areas(liquid.points, liquid.cells).sum(), area_outside(section, radius)
            slack = arc_slack(liquid)
            assert area == pytest.approx(exact, abs=slack + 1e-9 * exact)
            # The parabolas run inside their circles: liquid is gained.
            assert area > exact - 1e-9 * exact


@pytest.mark.parametrize(("order", "expected"), [(1, 2.0), (2, 4.0)])
def test_order_of_the_area(order: int, expected: float) -> None:
    """Over sides that shrink eightfold, since where nodes fall jumps from mesh to mesh.

    A side may come out up to twice as short as asked for, and the longest count: the slope is found to within
    log(2^p)/log(8) of p at the worst, p/3; it is allowed half of that.
    """
    section = disc(0.2, 48, order=order)

    def error(size: float) -> float:
        liquid = liquid_outside(section, 0.13, surface_size=size, order=order)
        return abs(cell_areas(liquid.points, liquid.cells).sum() / area_outside(section, 0.13) - 1.0)

    slope = math.log(error(0.03) / error(0.03 / 8)) / math.log(8.0)
    assert slope == pytest.approx(expected, abs=expected / 6)


@given(
    amount=st.floats(0.0, 0.12),
    seed=st.integers(0, 50),
    segments=st.integers(12, 40),
    share=st.floats(0.03, 0.9),
    hollow=st.booleans(),
)
@settings(max_examples=60)
def test_any_section_can_be_cut(amount: float, seed: int, segments: int, share: float, hollow: bool) -> None:
    """Cells are valid (the constructor looks), the area is that beyond the circle, no angle is hopeless."""
    whole = annulus(1.0, 0.15, segments, order=2) if hollow else disc(1.0, segments, order=2)
    section = bent(whole, amount, seed)
    radius = surface_radius_of(section, share * section_area(section))
    liquid = liquid_outside(section, radius)
    assert jacobians(liquid.points, liquid.cells).min() > 0.0
    exact = area_outside(section, radius)
    slack = arc_slack(liquid) + slide_slack(section) + 1e-8
    assert cell_areas(liquid.points, liquid.cells).sum() == pytest.approx(exact, abs=slack)


@kills("meshes.refine.waterline:liquid_outside", "0.5 * (growth - 1.0)", "0.5 * (growth + 1.0)")
def test_sizes() -> None:
    """Sides at surface and wall, and how they grow between."""
    section = disc(0.2, 32, order=2)
    liquid = liquid_outside(section, 0.12, surface_size=0.004, wall_size=0.006, growth=1.4)
    for sides, size in ((liquid.surface, 0.004), (liquid.wall, 0.006)):
        lengths = np.hypot(*(liquid.points[sides[:, 1]] - liquid.points[sides[:, 0]]).T)
        # A node that moved along may have lengthened its sides by the fraction that nodes may move.
        assert lengths.max() < 1.3 * size
    middle = np.abs(np.hypot(*liquid.points[liquid.cells[:, 0]].T) - 0.16) < 0.01
    areas = cell_areas(liquid.points, liquid.cells)
    assert np.median(areas[middle]) > 2 * np.median(areas[~middle])
    quality = assess(liquid.points, liquid.cells)
    assert math.degrees(quality.worst_angle) < 150
    assert quality.aspect_ratio < 12


def test_a_square_chamber_has_one_body_or_four() -> None:
    one = liquid_outside(square(1.0), 0.8, order=2)
    assert list(one.fixed_piece) == [True]
    four = liquid_outside(square(1.0), 1.2, order=2)
    assert list(four.fixed_piece) == [True] * 4


def test_an_obstacle_in_the_liquid_is_a_piece_of_wall() -> None:
    """An annulus whose hole lies off the centre, beyond the circle."""
    ring = annulus(1.0, 0.3, 32, order=2)
    r = np.hypot(*ring.points.T)
    section = Section(ring.points + np.outer(1 - (r - 0.3) / 0.7, [0.6, 0.0]), ring.triangles)
    liquid = liquid_outside(section, 0.2)
    assert sorted(liquid.fixed_piece) == [False, True]


def test_compartments_and_slits() -> None:
    liquid = liquid_outside(sector(1.0, 0.2, 1.1), 0.7)
    assert list(liquid.fixed_piece) == [True]
    assert len(liquid.surface) == len(free_sides(liquid.cells)) - len(liquid.wall)
    # A square slit from the middle of a side inwards: the nodes on both sides of the slit stay apart.
    section = square(1.0)
    _, edges = edge_numbers(section.triangles)
    ray = np.all(section.points[edges[:, :2], 1] == 0.0, axis=1)
    for inner_end, wetted in ((0.25, 0.4), (0.75, 0.25)):  # piercing the surface; ending in the liquid
        slits = edges[ray & np.all(section.points[edges[:, :2], 0] >= inner_end, axis=1), :2]
        slit = Section(*open_slits(section.points, section.triangles, slits))
        liquid = liquid_outside(slit, 0.6, order=2)
        assert list(liquid.fixed_piece) == [True]
        on_slit = np.all(np.abs(liquid.points[liquid.wall[:, :2], 1]) < 1e-12, axis=1)
        start, end = (liquid.points[liquid.wall[on_slit, k]] for k in (0, 1))
        assert np.hypot(*(end - start).T).sum() == pytest.approx(2 * wetted, rel=1e-9)


def test_a_thin_layer() -> None:
    """A layer of a thousandth of the radius, a hundredth as thick as the triangles of the section."""
    section = disc(1.0, 64, order=2)
    liquid = liquid_outside(section, 0.999)
    exact = area_outside(section, 0.999)
    # The wall's parabolas lie inside the true circle by b^4/8 = 7e-7 at most, within the layer.
    assert cell_areas(liquid.points, liquid.cells).sum() == pytest.approx(
        exact, abs=arc_slack(liquid) + 1e-12
    )


@kills(
    "meshes.refine.bisection:_at_quarters",
    "0.375 * low + 0.75 * middle - 0.125 * high",
    "0.375 * low + 0.625 * middle",
)
@kills(
    "meshes.refine.bisection:_halve",
    "0.5 * (points[bc] + points[ca]) - 0.125",
    "0.5 * (points[bc] + points[ca]) - 0.25",
)
@kills("meshes.refine.bisection:bisect", "marked[base[more]] = True", "break")
def test_bisection() -> None:
    """Halving keeps the area to rounding, leaves no hanging node, and at least half of the least angle."""
    section = bent(disc(1.0, 16, order=2), 0.1)
    points, triangles = quadratic_triangles(section)
    least = vertex_angles(points, triangles[:, :3]).min()
    walls = len(free_sides(triangles))
    for seed in range(3):
        _, edges = edge_numbers(triangles)
        marked = np.random.default_rng(seed).random(len(edges)) < 0.2
        points, triangles = bisect(points, triangles, marked)
        again = Section(points, triangles)  # refuses folded triangles and shared nodes
        assert section_area(again) == pytest.approx(section_area(section), rel=1e-13)
        # A hanging node would leave free sides within; the wall's are on it twice as many at most.
        sides = free_sides(triangles)
        assert walls <= len(sides) <= 2 * walls
        walls = len(sides)
    # Bisection of longest edges keeps half of the least angle for straight edges; these bend a little.
    assert vertex_angles(points, triangles[:, :3]).min() > 0.45 * least


def test_refinement_reaches_the_size() -> None:
    points, triangles = quadratic_triangles(square(1.0, 2))
    points, triangles = refine(points, triangles, lambda at: 0.02 + 0.3 * np.hypot(*at.T))
    _, edges = edge_numbers(triangles)
    length = np.hypot(*(points[edges[:, 1]] - points[edges[:, 0]]).T)
    assert np.all(length <= (0.02 + 0.3 * np.hypot(*points[edges[:, 2]].T)) * (1 + 1e-9))
    assert cell_areas(points, triangles).sum() == pytest.approx(4.0, rel=1e-13)


@kills(
    "meshes.refine.circle_cut:_cut_corners",
    "signs * np.sign(signs.sum(axis=1))[:, None] < 0.0",
    "signs * np.sign(signs.sum(axis=1))[:, None] > 0.0",
)
@kills("meshes.refine.circle_cut:_bend_onto", "bent[middle] = circle.project(0.5", "bent[middle] = (0.5")
@kills(
    "meshes.refine.circle_cut:_cut_corners",
    "tip_out = signs[np.arange(n), apex] > 0.0",
    "tip_out = signs[np.arange(n), apex] < 0.0",
)
@kills(
    "meshes.refine.circle_cut:Circle.beyond",
    "points[..., 1] - self.y) - self.radius",
    "points[..., 1] + self.y) - self.radius",
)
def test_both_sides_of_a_circle() -> None:
    """A circle off the centre: the triangles outside and inside share out the section."""
    for section in (disc(1.0, 32, order=2), square(1.0)):
        points, triangles = quadratic_triangles(section)
        for circle in (Circle(0.31, -0.2, 0.5), Circle(-0.8, 0.1, 0.6)):
            axis = (circle.x, circle.y)
            found, cells, outside = follow_circle(
                *refine(points, triangles, lambda at: np.full(len(at), 0.1)), circle
            )
            areas = cell_areas(found, cells)
            assert areas.min() > 0.0
            whole = section_area(section)
            # 30 arcs or more around: b = 0.1 at most, b^4/30 of the circle's area.
            beyond = area_outside(section, circle.radius, axis)
            assert areas[outside].sum() == pytest.approx(beyond, abs=0.1**4 / 30 * math.pi * circle.radius**2)
            assert areas.sum() == pytest.approx(whole, rel=1e-7)


@pytest.mark.parametrize(
    ("radius", "options", "field"),
    [
        (0.0, {}, "surface_radius"),
        (1.5, {}, "surface_radius"),
        (0.5, {"surface_size": 0.0}, "surface_size"),
        (0.5, {"wall_size": math.nan}, "wall_size"),
        (0.5, {"growth": 1.0}, "growth"),
        (0.5, {"order": 3}, "order"),
        (0.5, {"surface_size": 1e-6}, "size"),
    ],
)
def test_bad_requests_are_refused(radius: float, options: dict[str, float], field: str) -> None:
    with pytest.raises(InputError) as fault:
        liquid_outside(disc(1.0, 12), radius, **options)  # type: ignore[arg-type]
    assert fault.value.field == field


def test_a_circle_that_leaves_no_surface_is_refused() -> None:
    with pytest.raises(InputError):
        liquid_outside(annulus(1.0, 0.5, 16), 0.3)
    with pytest.raises(InputError, match="liquid_area"):
        surface_radius_of(disc(1.0, 12), 4.0)
    with pytest.raises(InputError, match="liquid_area"):
        surface_radius_of(disc(1.0, 12), 0.0)
    with pytest.raises(InputError, match="radius"):
        area_outside(disc(1.0, 12), -1.0)
