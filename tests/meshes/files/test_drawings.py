"""Drawings by hand, each with its area in closed form or the refusal that it deserves."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from meshes.errors import InputError
from meshes.files.outline import outline_section
from meshes.section import section_area

ezdxf = pytest.importorskip("ezdxf")
try:
    import gmsh  # noqa: F401
except (ImportError, OSError) as missing:  # the wheel needs libraries of the system
    pytest.skip(f"gmsh cannot be loaded: {missing}", allow_module_level=True)

PI = math.pi
HALF = 1.0  # bulge of a half circle

Draw = Callable[[Any, Any], None]


def square(space: Any, side: float, at: tuple[float, float] = (0.0, 0.0), **attributes: Any) -> None:
    x, y, a = *at, 0.5 * side
    corners = [(x - a, y - a), (x + a, y - a), (x + a, y + a), (x - a, y + a)]
    space.add_lwpolyline(corners, close=True, dxfattribs=attributes)


def circle(space: Any, radius: float, at: tuple[float, float] = (0.0, 0.0), **attributes: Any) -> None:
    space.add_circle(at, radius, dxfattribs=attributes)


def segment(chord: float, bulge: float) -> float:
    """Area between a chord and its arc; the bulge is the tangent of a quarter of the arc's angle."""
    angle = 4.0 * math.atan(bulge)
    radius = chord / (2.0 * math.sin(0.5 * angle))
    return 0.5 * radius**2 * (angle - math.sin(angle))


def plain_circle(doc: Any, space: Any) -> None:
    circle(space, 100)


def beside_notes(doc: Any, space: Any) -> None:
    circle(space, 100)
    space.add_text("drum", dxfattribs={"insert": (300, 0)})
    space.add_mtext("across\nthe drum")
    space.add_linear_dim((0, 150), (-100, 0), (100, 0)).render()
    space.add_point((10, 10))
    space.add_hatch().paths.add_polyline_path([(0, 0), (10, 0), (10, 10)], is_closed=True)
    space.add_solid([(0, 0), (10, 0), (0, 10), (10, 10)])


def island(doc: Any, space: Any) -> None:
    circle(space, 100)
    circle(space, 20, (30, 0))


def baffle_islands(doc: Any, space: Any) -> None:
    """Six thin plates that stand free of the wall."""
    circle(space, 100)
    for k in range(6):
        c, s = math.cos(PI * k / 3), math.sin(PI * k / 3)
        plate = [(70, -1), (95, -1), (95, 1), (70, 1)]
        space.add_lwpolyline([(c * x - s * y, s * x + c * y) for x, y in plate], close=True)


def bulges(doc: Any, space: Any) -> None:
    """A square with one side bulged out, one in, by a third of a right angle and more."""
    corners = [(-50, -50, 0.3), (50, -50, 0), (50, 50, -0.2), (-50, 50, 0)]
    space.add_lwpolyline(corners, format="xyb", close=True)


def heavy_polyline(doc: Any, space: Any) -> None:
    """Old polylines: two half circles of radius 60 about a square."""
    space.add_polyline2d([(-60, 0, 0, 0, HALF), (60, 0, 0, 0, HALF)], format="xyseb", close=True)
    space.add_polyline2d([(-20, -20), (20, -20), (20, 20), (-20, 20)], close=True)


def space_polyline(doc: Any, space: Any) -> None:
    space.add_polyline3d([(0, 0, 7), (80, 0, 7), (0, 60, 7)], close=True)


def steep_polyline(doc: Any, space: Any) -> None:
    space.add_polyline3d([(0, 0, 0), (80, 0, 7), (0, 60, 0)], close=True)


def ellipse(doc: Any, space: Any) -> None:
    space.add_ellipse((0, 0), (60, 80), 0.4)


def rational_spline(doc: Any, space: Any) -> None:
    """A quarter of a circle as a rational Bezier curve, which is exact, and two radii."""
    w = math.sqrt(0.5)
    space.add_rational_spline([(100, 0), (100, 100), (0, 100)], [1, w, 1], degree=2)
    space.add_line((0, 100), (0, 0))
    space.add_line((0, 0), (100, 0))


def bezier(doc: Any, space: Any) -> None:
    """x = 3 t^2 - 2 t^3, y = 3 t - 3 t^2 of 100: the integral of y dx is 18/30."""
    space.add_open_spline([(0, 0), (0, 100), (100, 100), (100, 0)], degree=3)
    space.add_line((100, 0), (0, 0))


def ellipse_of_halves(doc: Any, space: Any) -> None:
    space.add_ellipse((0, 0), (90, 0), 0.5, 0, PI)
    space.add_ellipse((0, 0), (90, 0), 0.4, PI, 2 * PI)


def block(doc: Any, name: str = "B", side: float = 10.0) -> Any:
    made = doc.blocks.new(name)
    square(made, side)
    return made


def scaled_block(doc: Any, space: Any) -> None:
    """Scaled unevenly, turned, mirrored: a circle becomes an ellipse."""
    circle(doc.blocks.new("B"), 10)
    space.add_blockref("B", (5, 5), dxfattribs={"xscale": -6, "yscale": 4, "rotation": 33})


def mirrored_bulge(doc: Any, space: Any) -> None:
    made = doc.blocks.new("B")
    made.add_lwpolyline([(0, 0, 0), (50, 0, 0.5), (50, 40, 0), (0, 40, 0)], format="xyb", close=True)
    space.add_blockref("B", (0, 0), dxfattribs={"xscale": -2, "yscale": 2, "rotation": -71})


def nested_blocks(doc: Any, space: Any) -> None:
    """A square of 10, thrice enlarged twice over, within a circle."""
    block(doc, "A")
    doc.blocks.new("B").add_blockref("A", (1, 1), dxfattribs={"xscale": 3, "yscale": 3, "rotation": 20})
    space.add_blockref("B", (2, 0), dxfattribs={"xscale": 3, "yscale": -3})
    circle(space, 100)


def block_about_a_base(doc: Any, space: Any) -> None:
    doc.blocks.new("A", base_point=(500, 0)).add_circle((500, 0), 20)
    space.add_blockref("A", (0, 0))
    circle(space, 100)


def array(doc: Any, space: Any) -> None:
    """Three columns, two rows, turned by a right angle."""
    block(doc)
    grid = {"column_count": 3, "row_count": 2, "column_spacing": 30, "row_spacing": 40, "rotation": 90}
    space.add_blockref("B", (20, -30), dxfattribs=grid)
    circle(space, 100)


def array_in_a_block(doc: Any, space: Any) -> None:
    block(doc)
    grid = {"column_count": 2, "row_count": 2, "column_spacing": 20, "row_spacing": 20}
    doc.blocks.new("C").add_blockref("B", (-10, -10), dxfattribs=grid)
    space.add_blockref("C", (0, 0), dxfattribs={"xscale": 2, "yscale": 2})
    circle(space, 100)


def array_beyond_the_wall(doc: Any, space: Any) -> None:
    block(doc)
    grid = {"column_count": 5, "row_count": 1, "column_spacing": 40, "row_spacing": 0}
    space.add_blockref("B", (0, 0), dxfattribs=grid)
    circle(space, 100)


def hidden_everywhere(doc: Any, space: Any) -> None:
    """What is switched off, frozen, not plotted, invisible, of Defpoints; open, crossing, larger."""
    square(space, 100)
    doc.layers.add("off").off()
    doc.layers.add("ice").freeze()
    doc.layers.add("screen").dxf.plot = 0
    circle(space, 400, layer="off")
    circle(space, 50, (50, 0), layer="ICE")
    space.add_line((0, 0), (7, 7), dxfattribs={"layer": "screen"})
    circle(space, 10, invisible=1)
    circle(space, 5, layer="Defpoints")
    circle(doc.blocks.new("B"), 3)
    space.add_blockref("B", (0, 0), dxfattribs={"layer": "off"})


def hidden_baffles(doc: Any, space: Any) -> None:
    """Lines on a layer of baffles that shows; two of them are invisible, one would cross all."""
    circle(space, 100)
    for y, hide in ((-40, 0), (0, 1), (40, 1)):
        space.add_line((-300, y), (300, -y), dxfattribs={"layer": "baffles", "invisible": hide})


def baffles_on_a_hidden_layer(doc: Any, space: Any) -> None:
    circle(space, 100)
    doc.layers.add("baffles").off()
    space.add_line((-50, 0), (50, 0), dxfattribs={"layer": "baffles"})


def inches(doc: Any, space: Any) -> None:
    doc.units = 1
    square(space, 2)


def survey_inches(doc: Any, space: Any) -> None:
    doc.header["$INSUNITS"] = 22
    square(space, 3.937)


def no_unit(doc: Any, space: Any) -> None:
    doc.units = 0
    square(space, 2)


def from_below(doc: Any, space: Any) -> None:
    """Half a circle seen from below, closed by a line."""
    space.add_arc((30, 0), 50, 0, 180, dxfattribs={"extrusion": (0, 0, -1)})
    space.add_line((-80, 0), (20, 0))


def specks(doc: Any, space: Any) -> None:
    """Sides and lines of no length, or of a ten-millionth, between the corners of a square."""
    corners = [(0, 0), (80, 0), (80, 0), (80, 80), (0, 80), (0, 80 - 1e-5)]
    space.add_lwpolyline(corners, close=True)
    space.add_line((80, 80), (80, 80))
    space.add_lwpolyline([(10, 10), (10, 10)])


def closed_on_its_start(doc: Any, space: Any) -> None:
    """A polyline whose last corner is the first again, and which says that it is closed."""
    space.add_lwpolyline([(0, 0), (80, 0), (80, 80), (0, 80), (0, 0)], close=True)


def tiny_gaps(doc: Any, space: Any) -> None:
    """Gaps of a ten-millionth of the drawing."""
    space.add_line((0, 0), (100, 0))
    space.add_line((100, 1e-5), (100, 50))
    space.add_line((100 - 1e-5, 50), (0, 50))
    space.add_line((0, 50 - 1e-5), (1e-5, 0))


def wide_gap(doc: Any, space: Any) -> None:
    space.add_line((0, 0), (100, 0))
    space.add_line((100, 0.1), (100, 50))
    space.add_line((100, 50), (0, 0))


def unclosed(doc: Any, space: Any) -> None:
    space.add_lwpolyline([(0, 0), (80, 0), (80, 80), (0, 80)])


def spur(doc: Any, space: Any) -> None:
    square(space, 100)
    space.add_line((50, 50), (90, 90))


def twice(doc: Any, space: Any) -> None:
    circle(space, 100)
    circle(space, 100)


def twice_in_pieces(doc: Any, space: Any) -> None:
    """A circle, and the same as two half circles that start elsewhere."""
    circle(space, 100)
    space.add_lwpolyline([(0, -100, HALF), (0, 100, HALF)], format="xyb", close=True)


def outside(doc: Any, space: Any) -> None:
    circle(space, 100)
    circle(space, 20, (130, 0))


def frame(doc: Any, space: Any) -> None:
    """A sheet's border with the drum in it and a title block."""
    square(space, 500)
    circle(space, 100)
    space.add_lwpolyline([(150, -250), (250, -250), (250, -200), (150, -200)], close=True)


def across_the_wall(doc: Any, space: Any) -> None:
    circle(space, 100)
    circle(space, 20, (95, 0))


def across_one_another(doc: Any, space: Any) -> None:
    circle(space, 100)
    circle(space, 20)
    square(space, 30, (20, 0))


def touching_the_wall(doc: Any, space: Any) -> None:
    circle(space, 100)
    circle(space, 20, (80, 0))


def touching_corner(doc: Any, space: Any) -> None:
    """A square that stands with a corner on the side of another."""
    square(space, 200)
    space.add_lwpolyline([(100, 0), (60, 40), (20, 0), (60, -40)], close=True)


def in_a_bay(doc: Any, space: Any) -> None:
    """A circle in a bay of the wall, between the ends of the arc that makes it."""
    space.add_lwpolyline([(-50, -50, 0), (50, -50, -0.5), (50, 50, 0), (-50, 50, 0)], "xyb", close=True)
    circle(space, 5, (45, 0))


def within_an_obstacle(doc: Any, space: Any) -> None:
    """A hollow shaft: no liquid comes into its bore."""
    circle(space, 100)
    circle(space, 30)
    circle(space, 20)


def bow_tie(doc: Any, space: Any) -> None:
    space.add_lwpolyline([(0, 0), (100, 100), (100, 0), (0, 100)], close=True)


def arc_through_its_polyline(doc: Any, space: Any) -> None:
    """An arc that bulges inwards across the opposite side."""
    space.add_lwpolyline(
        [(0, 0, 0), (100, 0, -1.0), (100, 100, 0), (60, 100, 0), (60, 0.5, 0)], "xyb", close=True
    )


def tilted_circle(doc: Any, space: Any) -> None:
    space.add_circle((0, 0), 100, dxfattribs={"extrusion": (0, 1, 1)})


def two_drums(doc: Any, space: Any) -> None:
    """Two sections side by side, each with its shaft."""
    for x in (0, 300):
        circle(space, 100, (x, 0))
        circle(space, 20, (x, 0))


def notes_alone(doc: Any, space: Any) -> None:
    space.add_text("nothing")


BULGED = 100**2 + segment(100, 0.3) - segment(100, 0.2)
BULGED_BLOCK = 4 * (50 * 40 + segment(40, 0.5))

# Area in mm^2, or words of the refusal.
DRAWINGS: dict[Draw, float | str] = {
    plain_circle: PI * 1e4,
    beside_notes: PI * 1e4,
    island: PI * (1e4 - 400),
    baffle_islands: PI * 1e4 - 6 * 50,
    bulges: BULGED,
    heavy_polyline: PI * 3600 - 1600,
    space_polyline: 2400,
    steep_polyline: "plane z = constant",
    ellipse: PI * 0.4 * 1e4,
    rational_spline: PI / 4 * 1e4,
    bezier: 6000,
    ellipse_of_halves: PI / 2 * 90**2 * 0.9,
    scaled_block: PI * 100 * 24,
    mirrored_bulge: BULGED_BLOCK,
    nested_blocks: PI * 1e4 - 8100,
    block_about_a_base: PI * (1e4 - 400),
    array: PI * 1e4 - 600,
    array_in_a_block: PI * 1e4 - 1600,
    array_beyond_the_wall: "outside",
    hidden_everywhere: 1e4,
    inches: 4 * 25.4**2,
    survey_inches: 1e4,
    no_unit: "does not name its unit",
    from_below: PI / 2 * 2500,
    specks: 6400,
    closed_on_its_start: 6400,
    tiny_gaps: 5000,
    wide_gap: "open at",
    unclosed: "open at",
    spur: "branching at",
    twice: "twice",
    twice_in_pieces: "cross",
    outside: "outside",
    frame: "touching another",
    across_the_wall: "cross",
    across_one_another: "cross",
    touching_the_wall: "touching another",
    touching_corner: "cross",
    in_a_bay: "outside",
    within_an_obstacle: PI * 9100,
    bow_tie: "cross",
    arc_through_its_polyline: "cross",
    tilted_circle: "plane z = constant",
    two_drums: "outside",
    notes_alone: "it holds TEXT",
    hidden_baffles: PI * 1e4,
    baffles_on_a_hidden_layer: "layer of the drawing that shows curves",
}


def answer(draw: Draw, folder: Path) -> float:
    """Area that comes of a drawing, mm^2."""
    document = ezdxf.new("R2010", units=4)
    draw(document, document.modelspace())
    document.saveas(folder / "a.dxf")
    slits = ["BAFFLES"] if "baffles" in draw.__name__ and "islands" not in draw.__name__ else []
    return 1e6 * section_area(outline_section(folder / "a.dxf", 5e-3, growth=2.0, slits=slits))


@pytest.mark.parametrize("draw", DRAWINGS, ids=lambda draw: draw.__name__)
def test_a_drawing_has_its_area_or_is_refused(draw: Draw, tmp_path: Path) -> None:
    """Quadratic edges lose b^4/30 of a sector, b half their angle: edges of 5 mm on the walls, of 50 mm
    radius and more, 1e-7; on islands of 20 mm, 4 % of the area, 4 % of 8e-6; on the ends of ellipses as much.
    """
    expected = DRAWINGS[draw]
    if isinstance(expected, str):
        with pytest.raises(InputError, match=expected):
            answer(draw, tmp_path)
    else:
        assert answer(draw, tmp_path) == pytest.approx(expected, rel=2e-6)
