"""Section meshes: areas in closed form, orders of the wall, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.errors import InputError
from meshes.quality import EDGES, assess
from meshes.section import Section, annulus, disc, section_area
from tests.mutants import kills

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])


def wall_edges(section: Section) -> np.ndarray:
    """Nodes of the edges that bound one triangle only, shape (E, 2 or 3)."""
    width = 2 if section.order == 1 else 3
    edges = section.triangles[:, EDGES[:, :width]].reshape(-1, width)
    _, index, count = np.unique(np.sort(edges[:, :2], axis=1), axis=0, return_index=True, return_counts=True)
    return np.asarray(edges[index[count == 1]])


@kills("meshes.section:annulus", "points = [radii[j] * np", "points = [radii[j] ** 2 * np")
def test_polygon_area() -> None:
    for segments in (8, 31, 64):
        section = disc(0.2, segments)
        polygon = 0.5 * segments * 0.2**2 * math.sin(2 * math.pi / segments)
        assert section_area(section) == pytest.approx(polygon, rel=1e-13)


@kills(
    "meshes.section:_quadratic",
    "middles[curved] = 0.5 * (ra + rb) * along",
    "middles[curved] = np.sqrt(ra * rb * np.sum(along**2, axis=1)[:, None] / 4.0) * along",
)
def test_quadratic_wall() -> None:
    """Every wall node on its circle; the area lacks b^4/30, b half the angle of an edge.

    The parabola through the ends and the middle of an arc runs inside it by (1 - cos b)^2 t^2 (1 - t^2)/2 of
    the radius, t from -1 to 1: b^4/60 on the average, and the next term is smaller by b^2/3.
    """
    for section, radii in (
        (disc(0.2, 48, order=2), (0.2,)),
        (disc(0.2, 48, order=2, wall_layer=1e-3), (0.2,)),
        (annulus(0.2, 0.1, 48, order=2), (0.2, 0.1)),
    ):
        edges = wall_edges(section)
        distance = np.hypot(*section.points[np.unique(edges)].T)
        on_one = np.min([np.abs(distance - radius) for radius in radii], axis=0)
        assert on_one.max() < 1e-16 * 4
    half = math.pi / 48
    lack = 1.0 - section_area(disc(1.0, 48, order=2)) / math.pi
    assert lack == pytest.approx(half**4 / 30, rel=half**2)


@pytest.mark.parametrize(("order", "expected"), [(1, 2.0), (2, 4.0)])
def test_order_of_the_area(order: int, expected: float) -> None:
    def error(segments: int) -> float:
        return abs(section_area(disc(0.2, segments, order=order)) / (math.pi * 0.2**2) - 1.0)

    # The next term of the error is smaller by b^2/3 at most, b = pi/40.
    slope = math.log2(error(40) / error(80))
    assert slope == pytest.approx(expected, abs=(math.pi / 40) ** 2 / 3 / math.log(2))


def test_inner_wall_has_edges_as_long_as_the_outer_one() -> None:
    """Equal edges cut equal slivers off both walls: a polygonal annulus has the round one's area to b^4."""
    half = math.pi / 40
    exact = math.pi * (0.2**2 - 0.08**2)
    assert section_area(annulus(0.2, 0.08, 40)) == pytest.approx(exact, rel=(half / 0.4) ** 4)


@given(
    segments=st.integers(8, 80),
    order=st.sampled_from([1, 2]),
    layer=st.one_of(st.none(), st.floats(-4.0, 0.0).map(lambda p: 10.0**p)),
    growth=st.floats(1.1, 2.0),
    inner=st.one_of(st.just(0.0), st.floats(-3.0, -1e-4).map(lambda p: 10.0**p)),
)
@settings(max_examples=60)
def test_meshes_are_valid_and_fill_the_section(
    segments: int, order: int, layer: float | None, growth: float, inner: float
) -> None:
    section = annulus(1.0, inner, segments, order=order, wall_layer=layer, growth=growth)
    quality = assess(section.points, section.triangles)
    assert quality.inverted == 0
    # A triangulation without hanging nodes has walls of two closed polygons at most, on the circles.
    edges = wall_edges(section)
    distance = np.hypot(*section.points[edges].T)
    assert np.all((np.abs(distance - 1.0) < 1e-15) | (np.abs(distance - inner) < 1e-15))
    outer = int(np.sum(distance[0] > 0.5 * (1.0 + inner)))
    assert outer == segments
    # Both walls lack area at the order of the mesh: 2 b^2/3 and b^4/30 of each disc, b = pi/8 at most inside.
    lack = {1: 2 / 3 * (math.pi / 8) ** 2, 2: (math.pi / 8) ** 4 / 30}[order]
    exact = math.pi * (1.0 - inner**2)
    assert quality.total_area == pytest.approx(exact, abs=math.pi * lack * (1.0 + inner**2) + 1e-12)
    if layer is None:
        # Rings are as deep as wide, or thinner where the gap leaves no room.
        assert quality.aspect_ratio < max(8.0, 10.0 * math.pi / segments / (1.0 - inner))


def test_wall_layers_are_thin_and_grow() -> None:
    section = disc(0.2, 64, wall_layer=2e-4, growth=1.5)
    rings = np.unique(np.round(0.2 - np.hypot(*section.points.T), 12))
    steps = np.diff(rings)
    assert 0.5e-4 < steps[0] <= 2e-4
    assert np.allclose(steps[1:5] / steps[:4], 1.5, rtol=1e-6)


def test_arrays_are_attracting_and_locked() -> None:
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    points = SQUARE.copy()
    section = Section(points, triangles)
    points[0] = 9.0
    assert section.points[0, 0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        section.points[0] = 1.0


@pytest.mark.parametrize(
    ("points", "triangles", "field"),
    [
        (SQUARE.T, [[0, 1, 2]], "points"),
        (np.where(SQUARE == 1.0, np.nan, SQUARE), [[0, 1, 2]], "points"),
        (SQUARE, [[0, 1, 2, 3]], "triangles"),
        (SQUARE, np.zeros((0, 3), dtype=int), "triangles"),
        (SQUARE, [[0.0, 1.0, 2.0]], "triangles"),
        (SQUARE, [[0, 1, 4]], "triangles"),
        (SQUARE, [[0, 1, -1]], "triangles"),
        (SQUARE, [[0, 2, 1]], "triangles"),  # clockwise
        (SQUARE, [[0, 1, 1]], "triangles"),  # no area
        (SQUARE, [[0, 1, 2], [0, 1, 3]], "triangles"),  # both above the edge 0-1
    ],
)
def test_bad_arrays_are_refused(points: object, triangles: object, field: str) -> None:
    with pytest.raises(InputError) as fault:
        Section(np.asarray(points), np.asarray(triangles))
    assert fault.value.field == field


def test_edges_have_midside_nodes_of_their_own() -> None:
    section = disc(0.2, 8, order=2)
    for wrong in (section.triangles[0, 4], section.triangles[0, 0]):
        triangles = section.triangles.copy()
        triangles[-1, 5] = wrong
        with pytest.raises(InputError):
            Section(section.points, triangles)


@pytest.mark.parametrize(
    ("request_", "field"),
    [
        ({"radius": 0.0}, "radius"),
        ({"radius": math.nan}, "radius"),
        ({"inner_radius": -0.1}, "inner_radius"),
        ({"inner_radius": 0.2}, "inner_radius"),
        ({"segments": 7}, "segments"),
        ({"segments": 2_000_000}, "segments"),
        ({"segments": 100, "growth": 1.0, "wall_layer": 1e-6}, "segments"),
        ({"order": 3}, "order"),
        ({"wall_layer": 0.0}, "wall_layer"),
        ({"wall_layer": 1e-9}, "wall_layer"),
        ({"growth": 0.9}, "growth"),
        ({"growth": math.nan}, "growth"),
    ],
)
def test_bad_requests_are_refused(request_: dict[str, float], field: str) -> None:
    with pytest.raises(InputError) as fault:
        annulus(**({"radius": 0.2, "inner_radius": 0.0} | request_))  # type: ignore[arg-type]
    assert fault.value.field == field
