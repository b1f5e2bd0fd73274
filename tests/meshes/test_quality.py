"""Quality of triangulations against triangles whose angles and areas are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from meshes.quality import assess, cell_areas, edge_polynomials, jacobians, triangle_areas
from tests.mutants import kills

ONE = np.array([[0, 1, 2]])
EQUILATERAL = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, math.sqrt(0.75)]])
# The right triangle of a half square, its long edge bent onto the circle about the right angle: the nodes lie
# at 0, 45 and 90 degrees on the unit circle.
BENT = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [math.sqrt(0.5), math.sqrt(0.5)], [0, 0.5]], dtype=float)
SIX = np.array([[0, 1, 2, 3, 4, 5]])


@kills("meshes.quality:aspect_ratios", "0.25 * np.sqrt(3.0) * longest", "0.5 * np.sqrt(3.0) * longest")
def test_equilateral() -> None:
    quality = assess(EQUILATERAL, ONE)
    assert quality.worst_angle == pytest.approx(math.pi / 3, rel=1e-14)
    assert quality.aspect_ratio == pytest.approx(1.0, rel=1e-14)
    assert quality.total_area == pytest.approx(math.sqrt(3) / 4, rel=1e-14)
    assert quality.inverted == 0


@kills("meshes.quality:cell_areas", "cross(c1, c2) / 3.0", "cross(c1, c2) / 2.0")
@kills("meshes.quality:edge_polynomials", "bend = 2.0 * (start + end)", "bend = (start + end)")
def test_parabola_area() -> None:
    """A parabolic bulge holds 2/3 of sagitta times chord; its middle tangent is parallel to the chord."""
    sagitta = 1.0 - math.sqrt(0.5)
    area = triangle_areas(BENT, SIX)
    assert area[0] == pytest.approx(0.5 + 2 / 3 * sagitta * math.sqrt(2), rel=1e-14)


@kills("meshes.quality:vertex_angles", "np.roll(c1 + 2.0 * c2, 1", "np.roll(c1 + c2, 1")
def test_parabola_angle() -> None:
    """The end tangent of a parabolic arc rises above the chord by 4 sagitta over chord."""
    rise = math.atan(4 * (1 - math.sqrt(0.5)) / math.sqrt(2))
    # 90 degrees at the corner is worst by 30 degrees; the bent corners have 45 degrees and the rise.
    assert 45 + math.degrees(rise) < 90
    assert assess(BENT, SIX).worst_angle == pytest.approx(math.pi / 2, rel=1e-14)
    # Bent inwards and to one side: the tangents at the ends, 4 (middle - end) + (end - other end), are
    # (-1.6, 0.8) and (0.4, -1.2), and the straight edges are the axes.
    hollow = BENT.copy()
    for middle, angle in (([0.35, 0.45], math.atan(0.4 / 1.2)), ([0.45, 0.35], math.atan(0.4 / 1.2))):
        hollow[4] = middle
        assert assess(hollow, SIX).worst_angle == pytest.approx(angle, rel=1e-13)


@kills("meshes.quality:jacobians", "(xp * yq - xq * yp)", "(xp * yq + xq * yp)")
def test_jacobian() -> None:
    """det of the map by central differences of the map itself, which is quadratic: exact but for rounding."""
    points = BENT + 0.03 * np.sin(np.arange(12.0)).reshape(6, 2)

    def position(p: float, q: float) -> np.ndarray:
        r = 1 - p - q
        shape = [r * (2 * r - 1), p * (2 * p - 1), q * (2 * q - 1), 4 * r * p, 4 * p * q, 4 * q * r]
        return np.asarray(shape) @ points

    expected = []
    for p, q in [(i / 8, j / 8) for i in range(9) for j in range(9 - i)]:
        dp = position(p + 0.5, q) - position(p - 0.5, q)
        dq = position(p, q + 0.5) - position(p, q - 0.5)
        expected.append(dp[0] * dq[1] - dp[1] * dq[0])
    assert np.allclose(jacobians(points, SIX)[0], expected, rtol=0, atol=1e-13)


def test_needle() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 1e-3]])
    quality = assess(points, ONE)
    # altitude 1e-3 under an edge of 1; the obtuse angle is all but 2 atan(2e-3)
    assert quality.aspect_ratio == pytest.approx(math.sqrt(0.75) * 1e3, rel=1e-12)
    assert quality.worst_angle == pytest.approx(math.pi - 2 * math.atan(2e-3), rel=1e-12)


def test_flat_and_inverted_triangles_are_counted() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [2.0, 0.0]])
    quality = assess(points, np.array([[0, 1, 2], [0, 2, 1], [0, 1, 3]]))
    assert quality.triangles == 3
    assert quality.inverted == 2
    assert quality.aspect_ratio == math.inf
    assert quality.smallest_area == -0.5
    assert quality.largest_area == 0.5


def test_a_corner_folded_by_its_midside_node_is_inverted() -> None:
    folded = BENT.copy()
    folded[4] = [0.2, 0.2]
    assert assess(folded, SIX).inverted == 1
    assert triangle_areas(folded, SIX)[0] > 0.0


def test_midside_nodes_on_the_chords_leave_edges_straight() -> None:
    offset = np.array([1e3, -7e2])  # far from the origin, where a middle is rounded
    straight = np.concatenate([EQUILATERAL, (EQUILATERAL + np.roll(EQUILATERAL, -1, axis=0)) / 2]) + offset
    assert np.all(edge_polynomials(straight[None])[2] == 0.0)
    # the coordinates carry 1e-13 of rounding
    assert triangle_areas(straight, SIX)[0] == pytest.approx(math.sqrt(3) / 4, abs=1e-12)


@kills(
    "meshes.quality:_square_slopes",
    "slopes, number = np.stack([4.0 * t - 3.0",
    "slopes, number = np.stack([4.0 * t - 2.0",
)
@kills("meshes.quality:_square_slopes", "along_q = values[i]", "along_q = values[j]")
def test_quadrilaterals() -> None:
    """Area, Jacobian, angle and aspect ratio of quadrilaterals, straight and mapped."""
    rhombus = np.array([[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [1.0, 1.0]])
    four = np.array([[0, 1, 2, 3]])
    assert cell_areas(rhombus, four)[0] == pytest.approx(2.0, rel=1e-14)
    assert jacobians(rhombus, four)[0] == pytest.approx(2.0, rel=1e-14)  # constant over a parallelogram
    quality = assess(rhombus, four)
    assert quality.worst_angle in (pytest.approx(math.pi / 4), pytest.approx(3 * math.pi / 4))
    # The longest side is 2, the breadth across it 1.
    assert quality.aspect_ratio == pytest.approx(2.0, rel=1e-14)
    # A quarter of a ring, mapped: both arcs are parabolas with a third of the sagitta lost from the circle.
    angle, radius = np.meshgrid(np.linspace(0, math.pi / 2, 3), np.array([1.0, 1.5, 2.0]))
    nodes = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    order = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
    ring = np.array([nodes[k] for k in order])
    sagitta, half = 1 - math.sqrt(0.5), math.sqrt(0.5)
    sector = half * half + 2 / 3 * sagitta * 2 * half
    assert cell_areas(ring, np.arange(9)[None])[0] == pytest.approx(3 * sector, rel=1e-13)
    # The Jacobian against differences of the biquadratic map itself, which are exact in its middle.
    jacobian = jacobians(ring, np.arange(9)[None])[0].reshape(7, 7)
    along, around = nodes[2, 1] - nodes[0, 1], nodes[1, 2] - nodes[1, 0]
    assert jacobian[3, 3] == pytest.approx(along[0] * around[1] - along[1] * around[0], rel=1e-13)
    start, end, middle = nodes[0, 0], nodes[0, 2], nodes[0, 1]
    leaving = 4 * middle - 3 * start - end
    out = -3 * nodes[0, 0] + 4 * nodes[1, 0] - nodes[2, 0]
    assert jacobian[0, 0] == pytest.approx(out[0] * leaving[1] - out[1] * leaving[0], rel=1e-13)
    # Integrated by Simpson's rule on its 7 x 7 points, exact for cubics: the area again.
    weights = np.array([1, 4, 2, 4, 2, 4, 1]) / 18
    assert weights @ jacobian @ weights == pytest.approx(3 * sector, rel=1e-12)


def test_a_dart_is_inverted() -> None:
    dart = np.array([[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]])
    assert assess(dart, np.array([[0, 1, 2, 3]])).inverted == 1
