"""Rings with baffles: exact areas of the polar grid, pieces of walls, over the whole input box; sectors."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.baffles import Baffles
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection
from meshes.quality import cell_areas, jacobians
from meshes.rings.sectors import compartment, sector
from meshes.rings.triangles import graded, open_slits, ring
from meshes.section import section_area
from tests.mutants import kills


def grid_area(mesh: LiquidSection, radius: float) -> float:
    """Area between two circles that consist of chords or of parabolas, from the sides of the surface.

    A sector of half angle b of the unit circle has the triangle's area sin b cos b, and a parabola over the
    chord 2 sin b, 1 - cos b high, adds two thirds of that rectangle.
    """
    start, end = (mesh.points[mesh.surface[:, k]] for k in (0, 1))
    b = np.arcsin(0.5 * np.hypot(*(end - start).T) / mesh.surface_radius)
    sectors = np.sin(b) * np.cos(b)
    if mesh.order == 2:
        sectors += 4.0 / 3.0 * np.sin(b) * (1.0 - np.cos(b))
    return float((radius**2 - mesh.surface_radius**2) * sectors.sum())


@kills(
    "meshes.rings.triangles:_halved",
    "0.5 * (values[1:] + values[:-1])",
    "0.6 * values[1:] + 0.4 * values[:-1]",
)
@kills("meshes.rings.triangles:_grid", "np.sin(angle)], axis=-1)", "np.cos(angle)], axis=-1)")
def test_ring_area() -> None:
    for order in (1, 2):
        for baffles in (None, Baffles(5, 0.14, 0.002, 0.3)):
            mesh = ring(0.15, 0.135, 24, order=order, baffles=baffles)
            area = cell_areas(mesh.points, mesh.cells).sum()
            assert area == pytest.approx(grid_area(mesh, 0.15), rel=1e-12)


def wall_length(mesh: LiquidSection) -> float:
    return float(np.hypot(*(mesh.points[mesh.wall[:, 1]] - mesh.points[mesh.wall[:, 0]]).T).sum())


@kills("meshes.baffles:Baffles.wetted_span", "radius - self.wall_gap", "radius + self.wall_gap")
def test_baffle_length() -> None:
    """The wall and both sides of every baffle, in chords."""
    for baffles, length in (
        (Baffles(4, 0.14), 0.010),
        (Baffles(3, 0.0, 0.002), 0.013),
        (Baffles(2, 0.1), 0.015),
    ):
        mesh = ring(0.15, 0.135, 24, order=1, baffles=baffles)
        angles = np.unique(np.round(np.arctan2(*mesh.points.T[::-1]) % (2 * math.pi), 9))
        chords = 2 * 0.15 * np.sin(0.5 * np.diff(angles, append=angles[0] + 2 * math.pi)).sum()
        assert wall_length(mesh) == pytest.approx(chords + 2 * baffles.count * length, rel=1e-8)


@kills("meshes.baffles:Baffles.angles", "2.0 * math.pi / self.count", "math.pi / self.count")
def test_baffles_lie_on_their_rays() -> None:
    """Nodes on the rays of the baffles are there twice, but for the tips."""
    baffles = Baffles(3, 0.14, 0.002, 0.4)
    mesh = ring(0.15, 0.135, 24, baffles=baffles)
    radius, angle = np.hypot(*mesh.points.T), np.arctan2(*mesh.points.T[::-1])
    for k in range(3):
        off = np.abs(np.exp(1j * angle) - np.exp(1j * (0.4 + 2 * math.pi * k / 3)))
        on = radius[(off < 1e-9) & (radius > 0.14 - 1e-9) & (radius < 0.148 + 1e-9)]
        places, count = np.unique(np.round(on, 9), return_counts=True)
        assert list(count) == [1, *[2] * (len(places) - 2), 1]


baffle_sets = st.builds(
    Baffles,
    count=st.integers(1, 60),
    tip_radius=st.one_of(st.just(0.0), st.floats(0.0, 0.999)),
    wall_gap=st.one_of(st.just(0.0), st.floats(-6.0, -0.4).map(lambda p: 10.0**p)),
    first_angle=st.floats(-7.0, 7.0),
)


@given(
    baffles=st.one_of(st.none(), baffle_sets),
    depth=st.floats(-4.0, -0.05).map(lambda p: 10.0**p),
    segments=st.integers(8, 40),
    order=st.sampled_from([1, 2]),
    layers=st.integers(1, 4),
)
@settings(max_examples=60)
def test_rings_are_valid_over_the_input_box(
    baffles: Baffles | None, depth: float, segments: int, order: int, layers: int
) -> None:
    surface = 1.0 - depth
    if baffles and baffles.tip_radius >= 1.0 - baffles.wall_gap:
        with pytest.raises(InputError):
            ring(1.0, surface, segments, baffles=baffles)
        return
    mesh = ring(
        1.0, surface, segments, order=order, layers=layers, baffles=baffles, tip_size=0.3 * depth, growth=3
    )
    assert jacobians(mesh.points, mesh.cells).min() > 0.0
    # A layer of 1e-4 keeps twelve digits of its area: coordinates carry 1e-16.
    assert cell_areas(mesh.points, mesh.cells).sum() == pytest.approx(grid_area(mesh, 1.0), rel=1e-10)
    span = baffles.wetted_span(1.0, surface) if baffles else None
    free = baffles is not None and span is not None and span[1] < 1.0
    compartments = baffles.count if baffles and span == (surface, 1.0) else 1
    assert int(mesh.fixed_piece.sum()) == compartments
    assert int((~mesh.fixed_piece).sum()) == (baffles.count if free and baffles else 0)


@kills(
    "meshes.rings.triangles:graded", "shorter = slope / (growth - 1.0)", "shorter = (growth - 1.0) / slope"
)
@kills(
    "meshes.rings.triangles:graded",
    "0.5 * (length + (end - start) / slope)",
    "0.5 * (length + (start - end) / slope)",
)
def test_grading() -> None:
    """Steps start and end as asked, neighbours differ by the growth at most, none is above the largest."""
    for length, largest, start, end, growth in (
        (1.0, 0.1, 1e-3, 1e-2, 1.5),
        (1.0, math.inf, 1e-6, math.inf, 2.0),
        (0.3, 0.05, math.inf, math.inf, 1.2),
        (1.0, 10.0, 1e-5, 1e-5, 3.0),
        (1e-4, 1.0, 1e-8, 2.0, 1.3),
    ):
        largest = min(largest, length)
        steps = np.diff(graded(length, largest, start, end, growth, least=2))
        assert steps.sum() == pytest.approx(length, rel=1e-13)
        assert steps.max() <= largest * (1 + 1e-9)
        assert steps[0] <= start * (1 + 1e-9)
        assert steps[-1] <= end * (1 + 1e-9)
        ratio = steps[1:] / steps[:-1]
        assert max(ratio.max(), (1 / ratio).max()) <= growth * (1 + 1e-9)
        # Not many more steps than it takes: they are shortened by the rounding up of their number alone, by a
        # half at most of two or more, and the first by ln(growth)/(growth - 1) at most besides.
        if math.isfinite(start) and len(steps) > 2:
            assert steps[0] > 0.5 * math.log(growth) / (growth - 1) * start


def test_layers_at_wall_and_surface() -> None:
    mesh = ring(0.2, 0.1, 24, order=1, wall_depth=1e-3, surface_depth=4e-3)
    rows = np.unique(np.round(np.hypot(*mesh.points.T), 12))
    assert 0.3e-3 < rows[-1] - rows[-2] <= 1e-3 * (1 + 1e-9)
    assert 1.2e-3 < rows[1] - rows[0] <= 4e-3 * (1 + 1e-9)


@kills("meshes.rings.triangles:open_slits", "turned = [1, 0, 2]", "turned = [0, 1, 2]")
def test_slits() -> None:
    """A square of four: opened across, from the middle outwards, and along a cross."""
    x, y = np.meshgrid(np.arange(3.0), np.arange(3.0), indexing="ij")
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    cells = np.array([[0, 3, 4, 1], [1, 4, 5, 2], [3, 6, 7, 4], [4, 7, 8, 5]])
    for slits, nodes in (
        ([[1, 4], [4, 7]], 12),  # three doubled: two parts
        ([[7, 4]], 10),  # the tip in the middle stays one node
        ([[1, 4], [4, 7], [3, 4], [4, 5]], 9 + 4 + 3),  # four in the middle, two at each end
        (np.zeros((0, 2), dtype=int), 9),
    ):
        opened, numbers = open_slits(points, cells, np.array(slits))
        assert len(opened) == nodes
        assert np.array_equal(opened[numbers], points[cells])
        assert np.array_equal(opened[:9], points)


@pytest.mark.parametrize(
    "slits",
    [
        [[0, 1]],  # on the boundary
        [[0, 4]],  # no side
        [[4, 5]],  # opens nothing: both ends are in the mesh
    ],
)
def test_slits_that_open_nothing_are_refused(slits: list[list[int]]) -> None:
    x, y = np.meshgrid(np.arange(4.0), np.arange(3.0), indexing="ij")
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    cells = np.array([[k, k + 3, k + 4, k + 1] for k in (0, 1, 3, 4, 6, 7)])
    slits = [[4, 7]] if slits == [[4, 5]] else slits
    with pytest.raises(InputError, match="slits"):
        open_slits(points, cells, np.array(slits))


@kills(
    "meshes.rings.sectors:sector", "middle = 0.5 * (r[tail] + r[head])", "middle = 0.49 * (r[tail] + r[head])"
)
def test_sector_area() -> None:
    """Chords and parabolas of both walls, as in `grid_area`; the sides are rays."""
    for inner in (0.0, 0.1, 0.1999):
        for order in (1, 2):
            section = sector(0.2, 0.7, 1.0, inner, 12, order=order)
            lost = {1: (1 / 24) ** 2 * 2 / 3, 2: (1 / 24) ** 4 / 30}[order]
            exact = 0.5 * (0.2**2 - inner**2)
            # Both walls lose their share of their sectors; edges of the inner one are up to as long, and span
            # up to twice the angle.
            slack = lost * 0.5 * (0.2**2 + 2 ** (2 * order) * inner**2) * 1.01
            assert section_area(section) == pytest.approx(exact, abs=slack)
            if inner == 0.0:
                assert section_area(section) == pytest.approx(exact * (1 - lost), rel=lost * (1 / 24) ** 2)


@given(
    angle=st.floats(0.01, 2 * math.pi),
    segments=st.integers(7, 40),
    inner=st.one_of(st.just(0.0), st.floats(-3.0, -1e-4).map(lambda p: 10.0**p)),
    order=st.sampled_from([1, 2]),
)
@settings(max_examples=60)
def test_sectors_are_valid(angle: float, segments: int, inner: float, order: int) -> None:
    section = sector(1.0, 1.3, angle, inner, segments, order=order)  # `Section` refuses folded triangles
    exact = 0.5 * angle * (1.0 - inner**2)
    # Edges of 60 degrees at most: they lose 2 b^2/3 and b^4/30 of their sectors, b = pi/6.
    lost = {1: 2 / 3 * (math.pi / 6) ** 2, 2: (math.pi / 6) ** 4 / 30}[order]
    assert section_area(section) == pytest.approx(exact, abs=0.5 * angle * lost * (1 + inner**2))


def test_compartments_fill_the_chamber() -> None:
    baffles = Baffles(5, first_angle=0.3)
    areas = [section_area(compartment(baffles, k, 0.2, 0.05)) for k in range(5)]
    whole = math.pi * (0.2**2 - 0.05**2)
    # 32 edges in 72 degrees: b = 0.02.
    assert sum(areas) == pytest.approx(whole, rel=0.02**4)
    first = compartment(baffles, 1, 0.2)
    angle = np.arctan2(*first.points[np.hypot(*first.points.T) > 0.01].T[::-1])
    assert angle.min() == pytest.approx(0.3 + 2 * math.pi / 5, rel=1e-12)
    slit = compartment(Baffles(1), 0, 0.2)
    assert section_area(slit) == pytest.approx(math.pi * 0.2**2, rel=1e-5)


def test_a_thin_ring_with_sixty_baffles() -> None:
    mesh = ring(1.0, 1.0 - 1e-4, 8, layers=2, baffles=Baffles(60, 1 - 5e-5, 1e-7), tip_size=2e-5, growth=3.0)
    assert jacobians(mesh.points, mesh.cells).min() > 0.0
    assert len(mesh.fixed_piece) == 61
    assert cell_areas(mesh.points, mesh.cells).sum() == pytest.approx(grid_area(mesh, 1.0), rel=1e-10)


def test_a_baffle_out_of_the_liquid_is_no_wall() -> None:
    dry = ring(0.2, 0.15, 16, baffles=Baffles(4, 0.1, 0.06))
    assert len(dry.cells) == len(ring(0.2, 0.15, 16).cells)
    assert Baffles(4, 0.1, 0.06).wetted_span(0.2, 0.15) is None


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: Baffles(0), "count"),
        (lambda: Baffles(2, -0.1), "tip_radius"),
        (lambda: Baffles(2, 0.1, math.nan), "wall_gap"),
        (lambda: Baffles(2, first_angle=math.inf), "first_angle"),
        (lambda: Baffles(2, 0.19, 0.02).wetted_span(0.2, 0.1), "tip_radius"),
        (lambda: ring(0.0, 0.1), "radius"),
        (lambda: ring(0.2, 0.2), "surface_radius"),
        (lambda: ring(0.2, 0.0), "surface_radius"),
        (lambda: ring(0.2, 0.1, 7), "segments"),
        (lambda: ring(0.2, 0.1, 20_000), "segments"),
        (lambda: ring(0.2, 0.1, order=3), "order"),
        (lambda: ring(0.2, 0.1, layers=0), "layers"),
        (lambda: ring(0.2, 0.1, wall_depth=0.0), "wall_depth"),
        (lambda: ring(0.2, 0.1, surface_depth=math.nan), "surface_depth"),
        (lambda: ring(0.2, 0.1, tip_size=0.0), "tip_size"),
        (lambda: ring(0.2, 0.1, growth=1.0), "growth"),
        (lambda: sector(-1.0, 0.0, 1.0), "radius"),
        (lambda: sector(1.0, math.nan, 1.0), "start"),
        (lambda: sector(1.0, 0.0, 7.0), "angle"),
        (lambda: sector(1.0, 0.0, 1.0, 1.0), "inner_radius"),
        (lambda: sector(1.0, 0.0, 3.0, segments=2), "segments"),
        (lambda: sector(1.0, 0.0, 1.0, order=0), "order"),
        (lambda: compartment(Baffles(3), 3, 0.2), "number"),
    ],
)
def test_bad_requests_are_refused(make, field: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as fault:
        make()
    assert fault.value.field == field
