"""Findings on meshes: errors of waves on elements solved by hand, counts along known rings, what is named."""

from __future__ import annotations

import math

import numpy as np
import pytest

from meshes.baffles import Baffles
from meshes.bodies.body import Body
from meshes.bodies.paraboloid import paraboloid_body
from meshes.errors import InputError
from meshes.findings import mesh_findings, points_across, points_per_wave, wave_error, wave_findings
from meshes.rings.triangles import ring
from meshes.section import Section, disc
from tests.mutants import kills


def discrete_error(points: int, order: int) -> float:
    """Relative error of the squared wavenumber of a wave on a periodic line, its elements assembled by hand.

    With `points` nodes on one wavelength; the lowest pair of modes of K u = k^2 M u.
    """
    elements = points // order
    size = 2 * math.pi / elements
    if order == 1:
        stiff, mass = np.array([[1, -1], [-1, 1]]) / size, size / 6 * np.array([[2, 1], [1, 2]])
    else:
        stiff = np.array([[7, -8, 1], [-8, 16, -8], [1, -8, 7]]) / (3 * size)
        mass = size / 30 * np.array([[4, 2, -1], [2, 16, 2], [-1, 2, 4]])
    big_k, big_m = np.zeros((points, points)), np.zeros((points, points))
    for e in range(elements):
        nodes = (order * e + np.arange(order + 1)) % points
        big_k[np.ix_(nodes, nodes)] += stiff
        big_m[np.ix_(nodes, nodes)] += mass
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(big_m, big_k)).real)
    return float(squares[1] - 1.0)


@kills("meshes.findings:wave_error", "step**2 / 12.0", "step**2 / 24.0")
@kills("meshes.findings:wave_error", "step**4 / 720.0", "step**4 / 360.0")
def test_wave_error() -> None:
    """The leading term of the error, the next smaller by the square of a step over ten or so."""
    for order, points in ((1, 20), (1, 40), (2, 16), (2, 32)):
        step = 2 * math.pi * order / points
        assert wave_error(points, order) == pytest.approx(discrete_error(points, order), rel=0.1 * step**2)
    assert wave_error(2.0, 1) < 1.0 == wave_error(1.0, 1)


@kills("meshes.findings:points_per_wave", "liquid.order * 2.0 * math.pi / (mode", "2.0 * math.pi / (mode")
def test_points_per_wave() -> None:
    for segments in (24, 60):
        for order in (1, 2):
            mesh = ring(0.15, 0.135, segments, order=order)
            assert points_per_wave(mesh, 3) == pytest.approx(segments * order / 3, rel=1e-12)


@kills("meshes.findings:points_across", "liquid.surface_radius / mode)", "liquid.surface_radius * mode)")
def test_points_across() -> None:
    """Rows of a ring; to a depth a/n for short waves, to the edge of a baffle where that is nearer."""
    mesh = ring(0.2, 0.1, 24, order=2, layers=5)
    rows = np.unique(np.round(np.hypot(*mesh.points.T), 9))
    assert points_across(mesh, 1)[0] == len(rows)
    below = int(np.searchsorted(rows[::2], 0.1 + 0.1 / 4 - 1e-9))
    assert points_across(mesh, 4)[0] == 2 * below + 1
    assert (
        points_across(ring(0.2, 0.1, 24, order=1, layers=1), 1)[0] == 3
    )  # the least between two marks is two
    assert points_across(ring(0.2, 0.1, 24, baffles=Baffles(4)), 1)[0] > 1


def test_a_good_mesh_has_no_findings() -> None:
    mesh = ring(0.15, 0.135, 48, baffles=Baffles(4, 0.14))
    assert mesh_findings(mesh) == ()
    assert wave_findings(mesh, 3) == ()
    assert mesh_findings(disc(0.2, 32, order=2)) == ()
    assert mesh_findings(paraboloid_body(disc(0.2, 32, order=2), 0.05, 20.0, -0.2)) == ()


def test_a_wave_that_is_not_resolved_is_named() -> None:
    mesh = ring(0.15, 0.135, 12, order=1, layers=1)
    found = wave_findings(mesh, 4)
    assert len(found) == 1
    words = str(found[0])
    assert "3.0 nodes per wave of mode 4" in words
    # The side that is longest lies on the circle; the change brings the error to a hundredth.
    assert math.hypot(*found[0].where) == pytest.approx(0.135 * math.cos(math.pi / 12), rel=1e-9)
    shorter = float(words.split("sides ")[1].split(" times")[0])
    assert wave_error(3.0 / shorter, 1) == pytest.approx(0.01, rel=0.1)
    thin = ring(0.15, 0.05, 48, order=1, layers=1)
    assert any("nodes across" in str(one) for one in wave_findings(thin, 7))


def test_poor_cells_are_named() -> None:
    points = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.02], [0.5, -1.0]])
    flat = Section(points, np.array([[0, 1, 2], [0, 3, 1]]))
    words = [str(one) for one in mesh_findings(flat)]
    assert len(words) == 2
    # The obtuse angle is 180 degrees less twice the arctangent of 0.04; areas are 0.01 and 0.5.
    assert "1 of 2 cells have an angle near 180 degrees, 175 at most at (0.5, 0.006667) m" in words[0]
    assert "neighbours differ 50 times in area" in words[1]


def test_folded_tetrahedra_are_named() -> None:
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    none = np.empty((0, 3), dtype=int)
    body = Body(points, np.array([[0, 2, 1, 3]]), none, none, np.empty(0, dtype=int))
    assert "1 of 1 cells are folded at (0.25, 0.25, 0.25) m" in str(mesh_findings(body)[0])


@pytest.mark.parametrize("mode", [0, 1.5])
def test_bad_modes_are_refused(mode: float) -> None:
    mesh = ring(0.15, 0.135, 12)
    for ask in (points_per_wave, points_across, wave_findings):
        with pytest.raises(InputError, match="mode"):
            ask(mesh, mode)  # type: ignore[arg-type, operator]
