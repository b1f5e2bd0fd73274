"""Sections from drawings and models: areas in closed form, units, slits, threads, silence, refusals."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from meshes.errors import InputError
from meshes.files.drawing import read_drawing
from meshes.files.outline import outline_section
from meshes.liquid_section import free_sides
from meshes.quality import assess
from meshes.refine.waterline import liquid_outside
from meshes.section import Section, section_area

ezdxf = pytest.importorskip("ezdxf")
try:
    import gmsh
except (ImportError, OSError) as missing:  # the wheel needs libraries of the system
    pytest.skip(f"gmsh cannot be loaded: {missing}", allow_module_level=True)

MM, METRE = 4, 6


def drawing(path: Path, units: int = MM) -> tuple[Any, Any]:
    document = ezdxf.new(units=units)
    return document, document.modelspace()


def stadium(path: Path) -> float:
    """Half circles on both sides of a rectangle, less a circle and an ellipse; its area, m^2."""
    document, space = drawing(path)
    space.add_lwpolyline(
        [(-100, -50, 0), (100, -50, 1), (100, 50, 0), (-100, 50, 1)], format="xyb", close=True
    )
    space.add_circle((0, 0), 20)
    space.add_ellipse((80, 0), (0, 30), 0.5)
    space.add_text("a label")
    space.add_line((-120, 0), (-60, 0), dxfattribs={"layer": "BAFFLES"})  # stands free
    space.add_line((40, -50), (40, -20), dxfattribs={"layer": "BAFFLES"})  # attached
    document.saveas(path)
    return (200 * 100 + math.pi * (50**2 - 20**2 - 30 * 15)) * 1e-6


def check_stadium(folder: Path, order: int = 2) -> None:
    """The area to the order of the mesh: arcs lose 2 b^2/3 or b^4/30 of their sectors."""
    exact = stadium(folder / "stadium.dxf")
    for size in (0.01, 0.005):
        section = outline_section(
            folder / "stadium.dxf", size, inside_size=0.03, order=order, slits=["BAFFLES"]
        )
        # Half angle of an edge on the smallest arc; the ellipse is half as sharp again at its ends: 7.5 mm.
        b = 0.6 * size / 0.0075
        lost = {1: 2 / 3 * b**2, 2: b**4 / 30}[order]
        assert section_area(section) == pytest.approx(
            exact, abs=lost * math.pi * 0.03 * 0.015 + 0.25 * lost * 4e-3
        )


@pytest.mark.parametrize("order", [1, 2])
def test_stadium(tmp_path: Path, order: int) -> None:
    check_stadium(tmp_path, order)


def test_order_of_the_outline(tmp_path: Path) -> None:
    """A circle, whose edges are even: 2 and 4."""
    document, space = drawing(tmp_path)
    space.add_circle((0, 0), 100)
    document.saveas(tmp_path / "circle.dxf")
    for order in (1, 2):
        lack = [
            1.0 - section_area(outline_section(tmp_path / "circle.dxf", size, order=order)) / (math.pi * 0.01)
            for size in (0.01, 0.005)
        ]
        # A whole number of edges on each third of the circle, 21 and 42.
        assert math.log2(lack[0] / lack[1]) == pytest.approx(2 * order, abs=0.15)


def test_nodes_of_walls_lie_on_the_outline(tmp_path: Path) -> None:
    stadium(tmp_path / "stadium.dxf")
    section = outline_section(tmp_path / "stadium.dxf", 0.01, slits=["BAFFLES"])
    x, y = section.points[np.unique(free_sides(section.triangles))].T * 1e3
    straight = np.minimum(np.abs(np.abs(y) - 50), 1e9 * (np.abs(x) > 100))
    round_ends = np.abs(np.hypot(np.abs(x) - 100, y) - 50)
    ellipse = np.abs(np.hypot((x - 80) / 15, y / 30) - 1) * 15
    baffles = np.minimum(np.abs(y) + 1e9 * (x > -59.9), np.abs(x - 40) + 1e9 * (y > -19.9))
    away = np.min([straight, round_ends, np.abs(np.hypot(x, y) - 20), ellipse, baffles], axis=0)
    assert away.max() < 1e-4  # a ten-thousandth of a millimetre


def test_slits_are_baffles(tmp_path: Path) -> None:
    """Pieces of wall: the outline with a baffle attached, the ellipse, the free baffle; the circle is dry."""
    stadium(tmp_path / "stadium.dxf")
    section = outline_section(tmp_path / "stadium.dxf", 0.01, slits=["BAFFLES"])
    liquid = liquid_outside(section, 0.04, order=2)
    assert sorted(liquid.fixed_piece) == [False, False, True]


def test_the_same_again(tmp_path: Path) -> None:
    """The same mesh again, from another thread, and within a session of Gmsh that goes on."""
    stadium(tmp_path / "stadium.dxf")
    meshes: list[Section] = []

    def make() -> None:
        meshes.append(outline_section(tmp_path / "stadium.dxf", 0.01, slits=["BAFFLES"]))

    make()
    thread = threading.Thread(target=make)
    thread.start()
    thread.join()
    assert not gmsh.isInitialized()
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 7.0)
        gmsh.model.add("mine")
        make()
        assert gmsh.model.getCurrent() == "mine"
        assert gmsh.option.getNumber("Mesh.MeshSizeMax") == 7.0
        assert "leblanc outline" not in gmsh.model.list()
    finally:
        gmsh.finalize()
    for other in meshes[1:]:
        assert np.array_equal(meshes[0].points, other.points)
        assert np.array_equal(meshes[0].triangles, other.triangles)


def test_units_and_blocks(tmp_path: Path) -> None:
    """A square of lines in a block, put there twice as large and turned, in inches; then scaled by hand."""
    document = ezdxf.new(units=1)
    block = document.blocks.new("BOX")
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    for k in range(4):
        block.add_line(corners[k], corners[(k + 1) % 4])
    document.modelspace().add_blockref("BOX", (0, 0), dxfattribs={"xscale": 2, "yscale": 2, "rotation": 30})
    document.saveas(tmp_path / "box.dxf")
    assert section_area(outline_section(tmp_path / "box.dxf", 0.01)) == pytest.approx(
        4 * 0.0254**2, rel=1e-12
    )
    large = outline_section(tmp_path / "box.dxf", 0.3, scale=1.0)
    assert section_area(large) == pytest.approx(4.0, rel=1e-12)


def test_arcs_seen_from_below_and_splines(tmp_path: Path) -> None:
    """A half circle drawn from below (extrusion -z), a half ellipse below it, as an arc and as a spline."""
    document, space = drawing(tmp_path, METRE)
    space.add_arc((0, 0), 0.1, 0, 180, dxfattribs={"extrusion": (0, 0, -1)})
    space.add_ellipse((0, 0), (0.1, 0), 0.5, math.pi, 2 * math.pi)
    document.saveas(tmp_path / "halves.dxf")
    exact = math.pi / 2 * 0.1**2 * 1.5
    # Edges of 5 mm at a radius of 25 mm at the sharpest: b = 0.1.
    assert section_area(outline_section(tmp_path / "halves.dxf", 0.005)) == pytest.approx(exact, rel=0.1**4)
    document, space = drawing(tmp_path, METRE)
    space.add_open_spline([(0, 0), (0, 1), (1, 1), (1, 0)], degree=3)
    space.add_line((1, 0), (0, 0))
    document.saveas(tmp_path / "spline.dxf")
    curves, unit = read_drawing(tmp_path / "spline.dxf")
    assert unit == 1.0
    assert sorted(curve.degree for curve in curves) == [1, 3]
    # Bezier: x = 3t^2 - 2t^3, y = 3t - 3t^2; int y dx = int 18 t^2 (1-t)^2 dt = 18/30.
    found = section_area(outline_section(tmp_path / "spline.dxf", 0.05))
    assert found == pytest.approx(0.6, rel=1e-6)


def test_a_closed_spline(tmp_path: Path) -> None:
    document, space = drawing(tmp_path, METRE)
    turn = np.linspace(0.0, 2 * math.pi, 25)
    space.add_spline([(0.1 * math.cos(t), 0.1 * math.sin(t)) for t in turn])
    document.saveas(tmp_path / "closed.dxf")
    # A cubic through 24 points of a circle, 15 degrees apart, with free ends: within 1e-3 of it.
    assert section_area(outline_section(tmp_path / "closed.dxf", 0.01)) == pytest.approx(
        math.pi * 0.01, rel=2e-3
    )


@pytest.fixture
def models(tmp_path: Path) -> Iterator[Path]:
    """A drum with a square shaft as STEP and BREP, a plane ellipse as STEP and IGES; in millimetres."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    drum = gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 50, 200)
    shaft = gmsh.model.occ.addBox(-20, -20, -10, 40, 40, 100)
    gmsh.model.occ.cut([(3, drum)], [(3, shaft)])
    gmsh.model.occ.synchronize()
    for name in ("drum.step", "drum.brep"):
        gmsh.write(str(tmp_path / name))
    gmsh.clear()
    gmsh.model.occ.addDisk(0, 0, 0, 100, 60)
    gmsh.model.occ.synchronize()
    for name in ("face.step", "face.iges"):
        gmsh.write(str(tmp_path / name))
    gmsh.finalize()
    yield tmp_path


def test_models(models: Path, capfd: pytest.CaptureFixture[str]) -> None:
    capfd.readouterr()
    drum = math.pi * 0.04 - 0.0016
    cut = outline_section(models / "drum.step", 0.01, height=25)
    # b = 1/40 of the circle: 1e-8.
    assert section_area(cut) == pytest.approx(drum, rel=1e-7)
    again = outline_section(models / "drum.brep", 0.01, height=25, scale=1e-3)
    assert section_area(again) == pytest.approx(drum, rel=1e-7)
    for name in ("face.step", "face.iges"):
        # 36 mm is the sharpest radius of the ellipse: b = 0.14.
        face = outline_section(models / name, 0.01)
        assert section_area(face) == pytest.approx(math.pi * 0.006, rel=0.14**4 / 30)
        assert assess(face.points, face.triangles).inverted == 0
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("name", "options", "field"),
    [
        ("drum.step", {}, "height"),
        ("drum.step", {"height": 70}, "height"),
        ("drum.step", {"height": 25, "scale": 1.0}, "scale"),
        ("drum.brep", {"height": 25}, "scale"),
        ("nowhere.step", {}, "path"),
        ("drum.stl", {}, "path"),
    ],
)
def test_models_without_a_section(models: Path, name: str, options: dict[str, float], field: str) -> None:
    with pytest.raises(InputError) as fault:
        outline_section(models / name, 0.01, **options)  # type: ignore[arg-type]
    assert fault.value.field == field
    assert not gmsh.isInitialized()


def _draw(path: Path, what: str) -> None:
    document, space = drawing(path)
    if what == "open":
        space.add_lwpolyline([(0, 0), (100, 0), (100, 100), (0, 101)])
    elif what == "branching":
        space.add_lwpolyline([(0, 0), (100, 0), (100, 100), (0, 100)], close=True)
        space.add_line((0, 0), (-50, -50))
    elif what == "text alone":
        space.add_text("nothing to see")
    elif what == "tilted":
        space.add_line((0, 0, 0), (1, 0, 5))
    elif what == "crossed":
        space.add_lwpolyline([(0, 0), (100, 100), (100, 0), (0, 100)], close=True)
    elif what == "no unit":
        document.units = 0
        space.add_circle((0, 0), 100)
    document.saveas(path)


@pytest.mark.parametrize(
    ("what", "field", "words"),
    [
        ("open", "path", "open at"),
        ("branching", "path", "branching at"),
        ("text alone", "path", "it holds TEXT"),
        ("tilted", "path", "plane"),
        ("crossed", "path", "outline"),
        ("no unit", "scale", "does not name its unit"),
    ],
)
def test_bad_drawings_are_named(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], what: str, field: str, words: str
) -> None:
    _draw(tmp_path / "bad.dxf", what)
    with pytest.raises(InputError, match=words) as fault:
        outline_section(tmp_path / "bad.dxf", 0.02)
    assert fault.value.field == field
    assert capfd.readouterr() == ("", "")
    assert not gmsh.isInitialized()


def test_bad_requests_are_refused(tmp_path: Path) -> None:
    stadium(tmp_path / "stadium.dxf")
    (tmp_path / "prose.dxf").write_text("no drawing at all")
    for name, options, field in (
        ("prose.dxf", {}, "path"),
        ("stadium.dxf", {"slits": ["WALLS"]}, "slits"),
        ("stadium.dxf", {"slits": ["0", "BAFFLES"]}, "slits"),
        ("stadium.dxf", {"wall_size": 0.0}, "wall_size"),
        ("stadium.dxf", {"inside_size": 0.001}, "inside_size"),
        ("stadium.dxf", {"growth": 1.0}, "growth"),
        ("stadium.dxf", {"order": 3}, "order"),
        ("stadium.dxf", {"scale": -1.0}, "scale"),
    ):
        with pytest.raises(InputError) as fault:
            outline_section(tmp_path / name, **({"wall_size": 0.01} | options))  # type: ignore[arg-type]
        assert fault.value.field == field
