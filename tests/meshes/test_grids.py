"""Meshes in PyVista: kinds of cells, areas and volumes as VTK finds them, fields, and a picture of each."""

from __future__ import annotations

import math

import numpy as np
import pytest

from meshes.baffles import Baffles
from meshes.bodies.body import body_integrals
from meshes.bodies.paraboloid import paraboloid_body
from meshes.bodies.wave import wave_body
from meshes.errors import InputError
from meshes.grids import boundary_grid, grid, wall_grid
from meshes.liquid_section import liquid_section
from meshes.quality import cell_areas
from meshes.rings.triangles import ring
from meshes.section import disc, section_area
from tests.meshes.test_liquid_section import INNER, ring_of

pyvista = pytest.importorskip("pyvista")


def test_plane_grids() -> None:
    """VTK integrates quadratic triangles as straight pieces, finer ones of them exactly enough."""
    for order, kind in ((1, 5), (2, 22)):
        section = disc(0.2, 32, order=order)
        made = grid(section)
        assert set(made.celltypes) == {kind}
        assert made.n_points == len(section.points)
        # VTK looks at a quadratic triangle as four straight ones: b^2/6 of a disc instead of 2 b^2/3.
        lost = {1: 1e-12, 2: (math.pi / 32) ** 2 / 6 * 1.01}[order]
        assert made.compute_cell_sizes()["Area"].sum() == pytest.approx(section_area(section), rel=lost)
    for nodes, kind in ((4, 9), (9, 28)):
        mesh = liquid_section(*ring_of(nodes), INNER)
        made = grid(mesh, height=0.3)
        assert set(made.celltypes) == {kind}
        assert np.all(made.points[:, 2] == 0.3)
        exact = cell_areas(mesh.points, mesh.cells).sum()
        # One row of 12 cells, and quarters of them: b = pi/12.
        lost = {4: 1e-12, 9: 2 * (math.pi / 12) ** 2 / 6}[nodes]
        assert made.compute_cell_sizes()["Area"].sum() == pytest.approx(exact, rel=lost)


def test_bodies() -> None:
    for order, kind in ((1, 10), (2, 24)):
        for body in (
            paraboloid_body(disc(0.2, 48, order=order), 0.05, 20.0, -0.2, axis=(-0.02, 0.0), order=order),
            wave_body(0.2, 0.05, 0.18 + 0.01 * np.cos(2 * math.pi * np.arange(64) / 64), order=order),
        ):
            made = grid(body)
            assert set(made.celltypes) == {kind}
            sizes = made.compute_cell_sizes()["Volume"]
            # VTK's own tetrahedra: all the right way round; quadratic ones in straight pieces.
            assert sizes.min() > 0.0
            lost = {1: 1e-10, 2: 2e-3}[order]
            assert sizes.sum() == pytest.approx(body_integrals(body).volume, rel=lost)


def test_boundaries() -> None:
    mesh = ring(0.2, 0.15, 32, baffles=Baffles(3, 0.17, 0.01))
    surface, wall = boundary_grid(mesh, "surface"), boundary_grid(mesh, "wall")
    assert set(surface.celltypes) == set(wall.celltypes) == {21}
    assert set(boundary_grid(ring(0.2, 0.15, 32, order=1), "wall").celltypes) == {3}
    assert np.array_equal(wall.cell_data["part"], mesh.wall_piece)
    body = paraboloid_body(disc(0.2, 48), 0.05, 20.0, -0.2, order=1)
    sides = [wall_grid(body, part).compute_cell_sizes()["Area"].sum() for part in ("floor", "lid", "side")]
    walls = boundary_grid(body, "wall")
    assert walls.compute_cell_sizes()["Area"].sum() == pytest.approx(sum(sides), rel=1e-12)
    # A regular polygon of 48 sides around.
    assert sides[2] == pytest.approx(0.05 * 2 * 48 * 0.2 * math.sin(math.pi / 48), rel=1e-12)
    assert boundary_grid(body, "surface").n_cells == len(body.surface)


def test_fields() -> None:
    section = disc(0.2, 16, order=2)
    radius = np.hypot(*section.points.T)
    made = grid(section, {"radius": radius}, {"number": np.arange(len(section.triangles))})
    assert np.array_equal(made.point_data["radius"], radius)
    # The centre of each cell, by VTK's interpolation of the field.
    assert made.cell_data["number"][-1] == len(section.triangles) - 1
    made.points[0] = 9.0
    assert section.points[0, 0] != 9.0


@pytest.mark.parametrize(
    ("fields", "field"),
    [
        ({"point_data": {"a": np.zeros(3)}}, "point_data.a"),
        ({"cell_data": {"a": np.zeros(3)}}, "cell_data.a"),
        ({"point_data": {"a": 1.0}}, "point_data.a"),
        ({"cell_data": {"a": np.zeros(208, dtype=complex)}}, "cell_data.a"),
    ],
)
def test_bad_fields_are_refused(fields: dict[str, dict[str, np.ndarray]], field: str) -> None:
    section = disc(0.2, 16)
    if field == "cell_data.a" and len(fields["cell_data"]["a"]) > 3:
        fields = {"cell_data": {"a": np.zeros(len(section.triangles), dtype=complex)}}
    with pytest.raises(InputError) as fault:
        grid(section, **fields)
    assert fault.value.field == field


def test_unknown_parts_are_refused() -> None:
    mesh = ring(0.2, 0.15, 16)
    with pytest.raises(InputError, match="part"):
        boundary_grid(mesh, "lid")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="part"):
        wall_grid(paraboloid_body(disc(0.2, 12), 0.05, 0.0, 0.02), "top")


def test_pictures_show_something() -> None:
    """Each kind of mesh, rendered off the screen, covers a part of its picture."""
    body = paraboloid_body(disc(0.2, 24, order=2), 0.05, 20.0, -0.2, axis=(-0.02, 0.0))
    for made in (
        grid(disc(0.2, 24, order=2)),
        grid(liquid_section(*ring_of(9), INNER)),
        grid(body),
        boundary_grid(body, "surface"),
    ):
        plotter = pyvista.Plotter(off_screen=True, window_size=(120, 90))
        plotter.background_color = "white"
        plotter.add_mesh(made, color="navy", show_edges=True)
        picture = plotter.screenshot(None, return_img=True)
        plotter.close()
        assert 0.02 < np.mean(np.any(picture < 250, axis=2)) < 0.95
