"""What CAD does not plot is no wall; every copy in an array of blocks is; units said and unsaid."""

from __future__ import annotations

import math
from itertools import product
from pathlib import Path

import ezdxf
import pytest

from meshes.files.drawing import read_drawing
from tests.mutants import kills

HIDE = ("off", "frozen", "not plotting", "invisible", "Defpoints")


def drawn(path: Path, hide: str, place: str, radius: float) -> None:
    """A circle of radius 2 that shows, and one that does not: in model space, in a block, as its layer 0."""
    document = ezdxf.new("R2010", units=4)
    space = document.modelspace()
    space.add_circle((0, 0), 2.0)
    layer = document.layers.add("h")
    if hide == "off":
        layer.off()
    elif hide == "frozen":
        layer.freeze()
    elif hide == "not plotting":
        layer.dxf.plot = 0
    on = {"layer": "Defpoints" if hide == "Defpoints" else "h", "invisible": int(hide == "invisible")}
    if place == "space":
        space.add_circle((0, 0), radius, dxfattribs=on)
    else:
        inner = on if place == "block" else {"layer": "0", "invisible": on["invisible"]}
        outer = on if place == "layer 0" else {}
        document.blocks.new("b").add_circle((0, 0), radius, dxfattribs=inner)
        space.add_blockref("b", (0, 0), dxfattribs=outer)
    document.saveas(path)


@pytest.mark.parametrize(("hide", "place"), list(product(HIDE, ("space", "block", "layer 0"))))
def test_what_is_not_plotted_is_no_wall(hide: str, place: str, tmp_path: Path) -> None:
    for radius in (1.0, 5.0):
        drawn(tmp_path / "a.dxf", hide, place, radius)
        curves, unit = read_drawing(tmp_path / "a.dxf")
        assert len(curves) == 3 and unit == 1e-3
        assert max(abs(curve.points).max() for curve in curves) == pytest.approx(2.0)


def test_every_copy_of_an_array(tmp_path: Path) -> None:
    document = ezdxf.new("R2010", units=4)
    document.blocks.new("b").add_circle((0, 0), 1.0)
    array = {"column_count": 3, "row_count": 2, "column_spacing": 4.0, "row_spacing": 5.0}
    document.modelspace().add_blockref("b", (0, 0), dxfattribs=array)
    document.saveas(tmp_path / "a.dxf")
    curves, _ = read_drawing(tmp_path / "a.dxf")
    middles = {tuple(sum(c.points[[0, -1]][0] for c in curves[k : k + 3]) / 3) for k in range(0, 18, 3)}
    assert len(curves) == 18
    assert {(round(x), round(y)) for x, y in middles} == set(product((0, 4, 8), (0, 5)))


@pytest.mark.parametrize(
    ("number", "metre"),
    [(1, 0.0254), (4, 1e-3), (21, 1200 / 3937), (22, 100 / 3937), (24, 5280 * 1200 / 3937)],
)
def test_units(number: int, metre: float, tmp_path: Path) -> None:
    document = ezdxf.new("R2010", units=4)
    document.modelspace().add_circle((0, 0), 1.0)
    document.header["$INSUNITS"] = number
    document.saveas(tmp_path / "a.dxf")
    assert read_drawing(tmp_path / "a.dxf")[1] == pytest.approx(metre, rel=1e-12)


@pytest.mark.parametrize("number", [0, -1, 25, 99])
def test_a_unit_that_is_not_known_is_none(number: int, tmp_path: Path) -> None:
    document = ezdxf.new("R2010", units=4)
    document.modelspace().add_circle((0, 0), 1.0)
    document.header["$INSUNITS"] = number
    document.saveas(tmp_path / "a.dxf")
    assert read_drawing(tmp_path / "a.dxf")[1] is None


def test_a_file_without_a_header_says_no_unit(tmp_path: Path) -> None:
    text = "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n0.0\n20\n0.0\n40\n1.0\n0\nENDSEC\n0\nEOF\n"
    (tmp_path / "a.dxf").write_text(text)
    assert read_drawing(tmp_path / "a.dxf")[1] is None


@kills("meshes.files.drawing:_opened", "not one.dxf.flags & _FRAME", "one.dxf.flags >= 0")
def test_a_fitted_polyline_is_its_fitted_vertices(tmp_path: Path) -> None:
    """The frame that steers it lies outside and is not drawn."""
    document = ezdxf.new("R2000", units=4)
    line = document.modelspace().add_polyline2d([], close=True)
    for way, flag, size in ((4, 16, 9.0), (12, 8, 2.0)):
        angles = [2.0 * math.pi * k / way for k in range(way)]
        line.append_formatted_vertices(
            [(size * math.cos(a), size * math.sin(a)) for a in angles], "xy", {"flags": flag}
        )
    document.saveas(tmp_path / "a.dxf")
    curves, _ = read_drawing(tmp_path / "a.dxf")
    assert len(curves) == 12
    assert max(abs(curve.points).max() for curve in curves) == pytest.approx(2.0)
