"""What a mesh file holds, and what of it makes a plane mesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes.border import InputError
from meshes.quality import cell_areas

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

# Names of cells in files by their nodes: in the plane, along sides and in space.
PLANE = {3: "triangle", 6: "triangle6", 4: "quad", 9: "quad9"}
LINES = {2: "line", 3: "line3"}
SPACE = {4: "tetra", 10: "tetra10"}

# Cells without an area: nodes and edges that Gmsh writes along with the others.
_DROPPED = frozenset({"vertex", *LINES.values()})

# Reverses a cell and keeps its first vertex and the numbering of the nodes between.
_REVERSED = {
    3: np.array([0, 2, 1]),
    6: np.array([0, 2, 1, 5, 4, 3]),
    4: np.array([0, 3, 2, 1]),
    9: np.array([0, 3, 2, 1, 7, 6, 5, 4, 8]),
}


@dataclass(frozen=True)
class FileContents:
    """Points and cells of a mesh file.

    Parameters
    ----------
    points : shape (N, 2 or 3), in the file's unit
    blocks : kind of cells and their nodes
    groups : number of the physical group of each cell of each block, 0 for none
    names : of physical groups by dimension and number
    """

    points: Array
    blocks: list[tuple[str, NDArray[Any]]]
    groups: list[Indices]
    names: dict[tuple[int, int], str]


def plane_cells(
    path: str | Path, contents: FileContents, scale: float, kinds: tuple[str, ...]
) -> tuple[Array, Indices, Indices]:
    """The one kind of plane cells of a file.

    Parameters
    ----------
    path : of the file, for words
    contents : of the file
    scale : length of the file's unit, m
    kinds : the cells that will do

    Returns
    -------
    Points that they use, m, shape (N, 2); cells, counter-clockwise; the new number of each point, or -1.

    Raises
    ------
    InputError : other cells, more than one kind, points that are not in a plane z = constant
    """
    found = sorted({kind for kind, data in contents.blocks if kind not in _DROPPED and len(data)})
    shapes = "triangles or quadrilaterals" if "quad" in kinds else "triangles"
    if len(found) != 1 or found[0] not in kinds:
        names = ", ".join(found) if found else "no cells with an area"
        raise InputError(
            "path", str(path), f"a mesh of {shapes}, all straight or all quadratic; it holds {names}"
        )
    cells = np.concatenate([data for kind, data in contents.blocks if kind == found[0]]).astype(np.int64)
    used = np.unique(cells)
    if used[0] < 0 or used[-1] >= len(contents.points):
        raise InputError("path", str(path), f"a mesh whose {shapes} use nodes that are there")
    number = np.full(len(contents.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    points, cells = scale * _in_plane(path, contents.points[used]), number[cells]
    corners = 4 if found[0].startswith("quad") else 3
    clockwise = cell_areas(points, cells[:, :corners]) < 0.0
    turned = np.take(cells, _REVERSED[cells.shape[1]], axis=1)
    return points, np.where(clockwise[:, None], turned, cells), number


def named_lines(contents: FileContents, number: Indices) -> dict[str, Indices]:
    """End nodes of the lines of each physical group.

    Parameters
    ----------
    contents : of the file
    number : new number of each point of the file, or -1

    Returns
    -------
    Pairs of new numbers by the group's name, "group 3" for one without; lines in no group are left out.
    """
    found: dict[str, list[Indices]] = {}
    for (kind, data), groups in zip(contents.blocks, contents.groups, strict=True):
        if kind not in LINES.values():
            continue
        ends = data[:, :2].astype(np.int64)
        there = np.all((ends >= 0) & (ends < len(number)), axis=1)
        for group in np.unique(groups[groups > 0]):
            name = contents.names.get((1, int(group)), f"group {group}")
            found.setdefault(name, []).append(number[ends[there & (groups == group)]])
    return {name: np.concatenate(ends) for name, ends in found.items()}


def dropped_in_words(contents: FileContents) -> tuple[str, ...]:
    """What a section does not keep of a file: points, lines in no group, names of areas."""
    notes = []
    points = sum(len(data) for kind, data in contents.blocks if kind == "vertex")
    if points:
        notes.append(f"{points} points are dropped")
    blocks = list(zip(contents.blocks, contents.groups, strict=True))
    lines = sum(int(np.sum(groups <= 0)) for (kind, _), groups in blocks if kind in LINES.values())
    if lines:
        notes.append(f"{lines} lines in no physical group are dropped")
    areas = [name for (dimension, _), name in sorted(contents.names.items()) if dimension == 2]
    if areas:
        notes.append(f"the names of areas are dropped: {', '.join(areas)}")
    return tuple(notes)


def _in_plane(path: str | Path, points: Array) -> Array:
    """The x and y of points that share their z."""
    if not np.all(np.isfinite(points)):
        raise InputError("path", str(path), "a mesh with finite coordinates")
    if points.shape[1] == 2:
        return points
    extent = np.ptp(points, axis=0)
    if not extent[2] <= 1e-9 * max(extent[0], extent[1]):
        raise InputError("path", str(path), "a mesh in a plane z = constant")
    return points[:, :2]
