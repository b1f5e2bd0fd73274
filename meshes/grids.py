"""Meshes as PyVista grids, for pictures and for what VTK can do. The only door of the meshes to PyVista."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Indices
from meshes.bodies.body import WALL_PARTS, Body
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection
from meshes.section import Section

if TYPE_CHECKING:
    from pyvista import UnstructuredGrid


# VTK's number of a cell, by the dimension of the cell and its nodes; their order is VTK's already.
_VTK_TYPES = {
    (1, 2): 3,  # line
    (1, 3): 21,  # quadratic edge
    (2, 3): 5,  # triangle
    (2, 6): 22,  # quadratic triangle
    (2, 4): 9,  # quadrilateral
    (2, 9): 28,  # biquadratic quadrilateral
    (3, 4): 10,  # tetrahedron
    (3, 10): 24,  # quadratic tetrahedron
}


def grid(
    mesh: Section | LiquidSection | Body,
    point_data: Mapping[str, ArrayLike] | None = None,
    cell_data: Mapping[str, ArrayLike] | None = None,
    *,
    height: float = 0.0,
) -> UnstructuredGrid:
    """A mesh with real fields at its nodes and on its cells, in metres; curved cells stay quadratic."""
    cells = mesh.triangles if isinstance(mesh, Section) else mesh.cells
    dimension = 3 if isinstance(mesh, Body) else 2
    return _grid(_in_space(mesh.points, height), cells, dimension, point_data, cell_data)


def boundary_grid(
    mesh: LiquidSection | Body,
    part: Literal["surface", "wall"],
    point_data: Mapping[str, ArrayLike] | None = None,
    *,
    height: float = 0.0,
) -> UnstructuredGrid:
    """The free surface of a mesh of liquid, or the walls that it wets, with the nodes of the whole mesh.

    Walls carry the cell data `part`: the piece of wall of a section, or of `meshes.bodies.body.WALL_PARTS`.
    """
    if part not in ("surface", "wall"):
        raise InputError("part", part, '"surface" or "wall"')
    cells = mesh.surface if part == "surface" else mesh.wall
    numbers = {}
    if part == "wall":
        numbers = {"part": mesh.wall_part if isinstance(mesh, Body) else mesh.wall_piece}
    dimension = 2 if isinstance(mesh, Body) else 1
    return _grid(_in_space(mesh.points, height), cells, dimension, point_data, numbers)


def wall_grid(body: Body, part: str) -> UnstructuredGrid:
    """One part of the walls that a body wets: "floor", "lid" or "side"."""
    if part not in WALL_PARTS:
        raise InputError("part", part, ", ".join(WALL_PARTS))
    return _grid(body.points, body.wall[body.wall_part == WALL_PARTS.index(part)], 2, None, None)


def _in_space(points: Array, height: float) -> Array:
    if points.shape[1] == 3:
        return points
    return np.column_stack([points, np.full(len(points), float(height))])


def _grid(
    points: Array,
    cells: Indices,
    dimension: int,
    point_data: Mapping[str, ArrayLike] | None,
    cell_data: Mapping[str, ArrayLike] | None,
) -> UnstructuredGrid:
    import pyvista

    kind = _VTK_TYPES[dimension, cells.shape[1]]
    made = pyvista.UnstructuredGrid({kind: np.array(cells)}, np.array(points))
    for where, fields, length in (
        ("point_data", point_data, len(points)),
        ("cell_data", cell_data, len(cells)),
    ):
        for name, given in (fields or {}).items():
            values = np.array(given)
            if values.ndim == 0 or len(values) != length:
                raise InputError(f"{where}.{name}", values.shape, f"an array of length {length}")
            if values.dtype.kind not in "biuf":
                raise InputError(f"{where}.{name}", str(values.dtype), "an array of real numbers")
            getattr(made, where)[name] = values
    return made
