"""Mesh files: round trips to the last digit, files as Gmsh writes them, and every way a file can be wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from meshes.baffles import Baffles
from meshes.bodies.wave import wave_body
from meshes.errors import InputError
from meshes.files.exchange import (
    PLANE,
    SUFFIXES,
    read_section,
    read_walls,
    write_mesh,
    write_section,
)
from meshes.liquid_section import LiquidSection, free_sides, liquid_section
from meshes.quality import cell_areas
from meshes.rings.triangles import ring
from meshes.section import Section, annulus, disc, section_area
from tests.meshes.test_liquid_section import INNER, ring_of
from tests.mutants import kills

# A unit square of two triangles, as Gmsh writes it: corner points, boundary lines, the centre of an arc that
# no triangle uses, a name for the plane, and one triangle turned over.
GMSH_22 = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 7 "section"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 9 9 0
3 1000 0 0
4 1000 1000 0
5 0 1000 0
$EndNodes
$Elements
5
1 15 2 0 1 1
2 1 2 0 1 1 3
3 1 2 0 2 3 4
4 2 2 7 1 1 3 4
5 2 2 7 1 1 5 4
$EndElements
"""

GMSH_41 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
1 1 1 0
1 0 0 0 0
1 0 0 0 1000 0 0 0 2 1 -1
1 0 0 0 1000 1000 0 0 1 1
$EndEntities
$Nodes
2 4 1 4
0 1 0 1
1
0 0 0
2 1 0 3
2
3
4
1000 0 0
1000 1000 0
0 1000 0
$EndNodes
$Elements
2 3 1 3
1 1 1 1
1 1 2
2 1 2 2
2 1 2 3
3 1 3 4
$EndElements
"""


def same(a: Section, b: Section) -> bool:
    """Equal up to the numbering of the nodes, to the last bit."""
    return a.order == b.order and np.array_equal(a.points[a.triangles], b.points[b.triangles])


def check_round_trip(folder: Path) -> None:
    for section in (disc(0.2, 16), disc(0.07, 16, order=2), annulus(0.2, 0.1, 12, order=2, wall_layer=1e-3)):
        for suffix in SUFFIXES:
            file = folder / f"section{suffix}"
            write_section(section, file)
            assert same(read_section(file), section)


def test_round_trip(tmp_path: Path) -> None:
    check_round_trip(tmp_path)


def test_fields_travel_along(tmp_path: Path) -> None:
    import meshio

    section = disc(0.2, 16, order=2)
    depth, number = np.hypot(*section.points.T), np.arange(len(section.triangles), dtype=float)
    for suffix in SUFFIXES:
        file = tmp_path / f"section{suffix}"
        write_section(section, file, point_data={"depth": depth}, cell_data={"number": number})
        mesh = meshio.read(file)
        assert np.array_equal(mesh.point_data["depth"], depth)
        assert np.array_equal(mesh.cell_data["number"][0], number)


@pytest.mark.parametrize("text", [GMSH_22, GMSH_41])
def test_files_as_gmsh_writes_them(tmp_path: Path, text: str) -> None:
    file = tmp_path / "square.MSH"
    file.write_text(text)
    section = read_section(file, scale=1e-3)
    assert len(section.points) == 4
    assert len(section.triangles) == 2
    assert section_area(section) == pytest.approx(1.0, rel=1e-15)


def test_turned_quadratic_triangles_keep_their_curved_edges(tmp_path: Path) -> None:
    import meshio

    section = disc(0.2, 12, order=2)
    turned = section.triangles[:, [1, 0, 2, 3, 5, 4]]
    file = tmp_path / "turned.vtu"
    points = np.column_stack([section.points, np.full(len(section.points), 0.3)])
    meshio.Mesh(points, [("triangle6", turned)]).write(file)
    assert section_area(read_section(file)) == pytest.approx(section_area(section), rel=1e-14)


CELLS_REFUSED = [
    ([("quad", [[0, 1, 2, 3]])], "quad"),
    ([("quad", [[0, 1, 2, 3]]), ("triangle", [[0, 1, 2]])], "quad, triangle"),
    ([("tetra", [[0, 1, 2, 3]])], "tetra"),
    ([("line", [[0, 1]])], "no cells with an area"),
    ([("triangle", [[0, 1, 2]]), ("triangle6", [[0, 1, 2, 3, 4, 5]])], "triangle, triangle6"),
]


@pytest.mark.parametrize(("cells", "found"), CELLS_REFUSED)
def test_other_cells_are_named(tmp_path: Path, cells: list[tuple[str, object]], found: str) -> None:
    import meshio

    points = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [1, 1, 0], [1, 0, 0]], dtype=float)
    file = tmp_path / "cells.vtu"
    meshio.Mesh(points, [(kind, np.array(numbers)) for kind, numbers in cells]).write(file)
    with pytest.raises(InputError, match=f"holds {found}$") as fault:
        read_section(file)
    assert str(file) in str(fault.value)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("empty.msh", ""),
        ("prose.msh", "no mesh at all\n"),
        ("version.msh", "$MeshFormat\n9.9 0 8\n$EndMeshFormat\n"),
        ("cut.msh", GMSH_41[:250]),
        ("cut_in_elements.msh", GMSH_22[:-40]),
        ("letters.msh", GMSH_22.replace("1000 1000", "many more")),
        ("node.msh", GMSH_22.replace("1 5 4\n$End", "1 8 4\n$End")),
        ("tilted.msh", GMSH_22.replace("1000 1000 0", "1000 1000 1")),
        ("nan.msh", GMSH_22.replace("1000 1000 0", "1000 nan 0")),
        ("overlap.msh", GMSH_22.replace("1 1 5 4", "1 1 3 5")),
        ("empty.vtu", ""),
        ("prose.vtu", "no mesh at all"),
        ("other.vtu", "<svg></svg>"),
        ("binary.vtu", "\x00\x01\x02"),
    ],
)
def test_bad_files_are_named_without_a_word_on_the_streams(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], name: str, text: str
) -> None:
    file = tmp_path / name
    file.write_text(text)
    with pytest.raises(InputError) as fault:
        read_section(file)
    assert fault.value.field == "path"
    assert str(file) in str(fault.value)
    assert "\n" not in str(fault.value)
    assert capfd.readouterr() == ("", "")


def test_missing_and_foreign_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="an existing mesh file"):
        read_section(tmp_path / "nowhere.msh")
    with pytest.raises(InputError, match="an existing mesh file"):
        (tmp_path / "folder.msh").mkdir()
        read_section(tmp_path / "folder.msh")
    with pytest.raises(InputError, match=r"\.msh or \.vtu"):
        read_section(tmp_path / "section.stl")
    with pytest.raises(InputError, match=r"\.msh or \.vtu"):
        write_section(disc(0.2, 8), tmp_path / "section.stl")
    with pytest.raises(InputError, match="in a folder that exists"):
        write_section(disc(0.2, 8), tmp_path / "nowhere" / "section.vtu")
    with pytest.raises(InputError, match="scale"):
        read_section(tmp_path / "nowhere.msh", scale=0.0)


@pytest.mark.parametrize("where", ["point_data", "cell_data"])
def test_fields_of_another_length_are_refused(tmp_path: Path, where: str) -> None:
    with pytest.raises(InputError, match=f"{where}.depth"):
        write_section(disc(0.2, 8), tmp_path / "a.vtu", **{where: {"depth": np.zeros(3)}})  # type: ignore[arg-type]


def test_nothing_is_printed(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    check_round_trip(tmp_path)
    assert capfd.readouterr() == ("", "")


def read_liquid(path: Path) -> LiquidSection:
    """Section of liquid from a mesh file; the nodes nearest to the origin are the free surface."""
    import meshio

    contents = meshio.read(path)
    (cells,) = (block.data for block in contents.cells if block.type in PLANE.values())
    points = np.asarray(contents.points[:, :2], dtype=float)
    return liquid_section(points, cells.astype(np.int64), float(np.hypot(*points.T).min()))


def test_liquid_round_trip(tmp_path: Path) -> None:
    """Every kind of cell out and in; surface and walls are found again, to the last bit of the nodes."""
    baffles = Baffles(3, 0.18, 0.005)
    meshes = [ring(0.2, 0.17, 24, order=order, baffles=baffles) for order in (1, 2)]
    meshes += [liquid_section(*ring_of(nodes), INNER) for nodes in (4, 9)]
    for mesh in meshes:
        for suffix in SUFFIXES:
            file = tmp_path / f"liquid{suffix}"
            write_mesh(mesh, file)
            again = read_liquid(file)
            assert np.array_equal(again.points[again.cells], mesh.points[mesh.cells])
            assert again.surface_radius == pytest.approx(mesh.surface_radius, rel=1e-15)
            assert sorted(again.fixed_piece) == sorted(mesh.fixed_piece)
            assert len(again.surface) == len(mesh.surface)


def test_fields_of_liquids_and_bodies_travel_along(tmp_path: Path) -> None:
    import meshio

    liquid = ring(0.2, 0.17, 16, baffles=Baffles(3, 0.18, 0.005), tip_size=0.01)
    body = wave_body(0.2, 0.05, np.full(16, 0.17))
    for mesh in (liquid, body):
        distance = np.hypot(*mesh.points[:, :2].T)
        for suffix in SUFFIXES:
            file = tmp_path / f"mesh{suffix}"
            number = np.arange(len(mesh.cells), dtype=float)
            write_mesh(mesh, file, point_data={"r": distance}, cell_data={"number": number})
            found = meshio.read(file)
            # Files may put the nodes in another order, but fields must go with them.
            assert found.point_data["r"] == pytest.approx(np.hypot(*found.points[:, :2].T), rel=1e-13)
            assert np.array_equal(found.cell_data["number"][0], number)
            assert np.array_equal(
                found.points[found.cells[0].data][..., :2], mesh.points[mesh.cells][..., :2]
            )


def test_walls_have_names_in_gmsh_files(tmp_path: Path) -> None:
    """A ring whose baffles stand free: surface, outer wall and three pieces, which the cells border again."""
    mesh = ring(0.2, 0.17, 24, order=2, baffles=Baffles(3, 0.18, 0.005))
    write_mesh(mesh, tmp_path / "liquid.msh")
    named = read_walls(tmp_path / "liquid.msh")
    assert set(named.walls) == {"surface", "outer wall", "wall 1", "wall 2", "wall 3"}
    radius = np.hypot(*named.section.points.T)
    assert radius[named.walls["surface"]] == pytest.approx(0.17, rel=1e-12)
    assert radius[named.walls["outer wall"]] == pytest.approx(0.2, rel=1e-12)
    assert sum(map(len, named.walls.values())) == len(free_sides(mesh.cells))
    assert named.notes == ("the names of areas are dropped: liquid",)


# A square of two by one cells of triangles; its left wall has a name, the line down its middle is a baffle
# from the lower wall to the upper one, group 9 is its right wall, and the lower wall is in no group.
GROUPS = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 4 "left"
1 5 "baffle"
2 7 "section"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
9
1 15 2 0 1 1
2 1 2 4 1 4 1
3 1 2 5 2 2 5
4 1 2 9 3 3 6
5 1 2 0 4 1 2
6 2 2 7 1 1 2 5
7 2 2 7 1 1 5 4
8 2 2 7 1 2 3 6
9 2 2 7 1 2 6 5
$EndElements
"""


@kills("meshes.files.exchange:name_walls", "origin[cells] = section.triangles", "pass")
def test_groups(tmp_path: Path) -> None:
    file = tmp_path / "groups.msh"
    file.write_text(GROUPS)
    named = read_walls(file)
    assert set(named.walls) == {"left", "group 9"}
    assert np.array_equal(np.sort(named.section.points[named.walls["left"][0]][:, 1]), [0.0, 1.0])
    assert named.notes == (
        "1 points are dropped",
        "1 lines in no physical group are dropped",
        "the names of areas are dropped: section",
        "1 lines of 'baffle' are dropped: they do not lie on a wall",
    )
    opened = read_walls(file, slits=["baffle"])
    assert len(opened.section.points) == 8  # both ends lie on walls, so both are doubled
    assert len(opened.walls["baffle"]) == 2
    # One side has the section on its left going up, the other going down.
    ends = opened.section.points[opened.walls["baffle"][:, :2]]
    assert np.sort(ends[:, 1, 1] - ends[:, 0, 1]).tolist() == [-1.0, 1.0]
    assert len(opened.notes) == 3


def test_slits_that_are_no_groups_are_refused(tmp_path: Path) -> None:
    (tmp_path / "groups.msh").write_text(GROUPS)
    with pytest.raises(InputError, match="left, baffle, group 9"):
        read_walls(tmp_path / "groups.msh", slits=["fin"])
    with pytest.raises(InputError, match="slits"):
        read_walls(tmp_path / "groups.msh", slits=["left"])


def test_a_section_that_is_no_liquid_is_refused(tmp_path: Path) -> None:
    write_mesh(liquid_section(*ring_of(9), INNER), tmp_path / "quads.vtu")
    with pytest.raises(InputError, match="holds quad9"):
        read_section(tmp_path / "quads.vtu")


@kills(
    "meshes.files.exchange:plane_cells",
    "turned = np.take(cells, _REVERSED[cells.shape[1]], axis=1)",
    "turned = cells[:, ::-1]",
)
def test_turned_cells(tmp_path: Path) -> None:
    """Clockwise cells of every kind keep their sides when they are turned round."""
    import meshio

    for nodes, kind, reverse in (
        (3, "triangle", [0, 2, 1]),
        (6, "triangle6", [1, 0, 2, 3, 5, 4]),
    ):
        points, cells = ring_of(nodes)
        space = np.column_stack([points, np.zeros(len(points))])
        meshio.Mesh(space, [(kind, cells[:, reverse])]).write(tmp_path / "turned.vtu")
        again = read_section(tmp_path / "turned.vtu")
        assert cell_areas(again.points, again.triangles) == pytest.approx(cell_areas(points, cells))
