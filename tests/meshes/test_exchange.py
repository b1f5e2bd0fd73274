"""Mesh files: round trips to the last digit, files as Gmsh writes them, and every way a file can be wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from meshes.border import InputError
from meshes.exchange import read_section, write_section
from meshes.section import Section, annulus, disc, section_area

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
        for suffix in (".msh", ".vtu"):
            file = folder / f"section{suffix}"
            write_section(section, file)
            assert same(read_section(file), section)


def test_round_trip(tmp_path: Path) -> None:
    check_round_trip(tmp_path)


def test_fields_travel_along(tmp_path: Path) -> None:
    import meshio

    section = disc(0.2, 16, order=2)
    depth, number = np.hypot(*section.points.T), np.arange(len(section.triangles), dtype=float)
    for suffix in (".msh", ".vtu"):
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
