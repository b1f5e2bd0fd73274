"""Walls of a chamber with a section of its own, and baffles, as pieces of a three-dimensional picture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from leblanc.figures.chambers.uneven import plates
from leblanc.view.parts import Piece, Stage, placed
from meshes.arrays import Complex, Indices
from meshes.chamber import Chamber
from meshes.chamber_section import ChamberSection
from meshes.liquid_section import free_sides
from meshes.section import Section

STEPS = 4  # straight pieces of a curved side
_SAME = 1e-9  # of the farthest point: ends nearer to each other are one
_PARTS = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])  # of a curved triangle


@dataclass(frozen=True)
class Outline:
    """Sides of a section, each as straight pieces with k points, from the geometric axis.

    Parameters
    ----------
    walls : complex, m, shape (n, k), with the section on the left
    outwards : unit vectors out of the section at these points, complex, shape (n, k)
    plates : both sides of baffles without thickness, each pair once, m, shape (m, k)
    """

    walls: Complex
    outwards: Complex
    plates: Complex


def outline(section: Section) -> Outline:
    """Walls of a section, those without thickness apart.

    Parameters
    ----------
    section : about the geometric axis
    """
    sides = free_sides(section.triangles)
    plane = section.points[:, 0] + 1j * section.points[:, 1]
    curved = sides.shape[1] == 3
    start, end = plane[sides[:, 0]], plane[sides[:, 1]]
    middle = plane[sides[:, 2]] if curved else 0.5 * (start + end)
    t = np.linspace(0.0, 1.0, STEPS + 1 if curved else 2)
    at = np.stack([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)])
    slope = np.stack([4 * t - 3, 4 - 8 * t, 4 * t - 1])
    nodes = np.stack([start, middle, end], axis=1)
    points, along = nodes @ at, nodes @ slope
    out = -1j * along / np.abs(along)
    double = _double(start, end, _SAME * float(np.abs(plane).max()))
    # One direction where two sides meet.
    total = np.zeros(plane.size, dtype=complex)
    for k, column in ((0, 0), (1, -1)):
        np.add.at(total, sides[~double, k], out[~double, column])
    size = np.abs(total)
    mean = np.divide(total, size, out=np.zeros_like(total), where=size > 0.0)
    out[:, 0], out[:, -1] = mean[sides[:, 0]], mean[sides[:, 1]]
    first = double & (np.arange(len(sides)) == _first(start, end, _SAME * float(np.abs(plane).max())))
    walls, outwards, plates = (
        np.asarray(one, dtype=complex) for one in (points[~double], out[~double], points[first])
    )
    return Outline(walls, outwards, plates)


def _pairs(start: Complex, end: Complex, same: float) -> NDArray[np.int64]:
    """Number of each side, alike for two between the same ends."""
    grid = np.stack([start.real, start.imag, end.real, end.imag], axis=1)
    cells = np.rint(grid / same).astype(np.int64)
    swap = (cells[:, 0] > cells[:, 2]) | ((cells[:, 0] == cells[:, 2]) & (cells[:, 1] > cells[:, 3]))
    cells[swap] = cells[swap][:, [2, 3, 0, 1]]
    return np.unique(cells, axis=0, return_inverse=True)[1].ravel().astype(np.int64)


def _double(start: Complex, end: Complex, same: float) -> NDArray[np.bool_]:
    """Sides at the place of another one: the two faces of a baffle."""
    number = _pairs(start, end, same)
    return np.asarray(np.bincount(number)[number] == 2)


def _first(start: Complex, end: Complex, same: float) -> NDArray[np.int64]:
    """The first side of the number that each has."""
    number = _pairs(start, end, same)
    return np.unique(number, return_index=True)[1][number].astype(np.int64)


def plates_of(chamber: Chamber, depth: float) -> Complex:
    """Baffles as lines from the geometric axis, m, shape (m, k).

    Parameters
    ----------
    chamber : with baffles of its own or in its section
    depth : by which the liquid layer is drawn deeper; distances of baffles from the wall grow with it
    """
    if chamber.section is not None:
        return outline(chamber.section.mesh).plates
    if chamber.baffles is None:
        return np.empty((0, 2), dtype=complex)
    ends = np.array(plates(chamber.baffles, chamber.radius, depth))
    inner = np.maximum(np.abs(ends[:, :1]), chamber.inner_radius) * np.exp(1j * np.angle(ends[:, 1:]))
    return np.concatenate([inner, ends[:, 1:]], axis=1)


def baffles(stage: Stage, lines: Complex, k: int, centre: complex, floor: float, lid: float) -> list[Piece]:
    """Plates over the whole height.

    Parameters
    ----------
    stage : what stands still
    lines : as from `plates_of`
    k : number of the chamber, from 0
    centre : of the chamber as drawn, m
    floor, lid : places along the axis, m
    """
    return [_ruled(stage, f"baffle {k + 1}", "metal", centre + one[None], floor, lid) for one in lines]


def section_walls(
    stage: Stage, section: ChamberSection, k: int, centre: complex, floor: float, lid: float, skin: float
) -> list[Piece]:
    """Walls, floor, lid and their rims.

    Parameters
    ----------
    stage : what stands still
    section : of the chamber
    k : number of the chamber, from 0
    centre : of the chamber as drawn, m
    floor, lid : places along the axis, m
    skin : how much outside the liquid walls are drawn, m
    """
    sides = outline(section.mesh)
    walls = centre + sides.walls + skin * sides.outwards
    mesh = section.mesh
    across = centre + mesh.points[:, 0] + 1j * mesh.points[:, 1]
    number = np.arange(walls.size).reshape(walls.shape)
    edges = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=-1).astype(np.int64)
    return [
        _ruled(stage, f"wall {k + 1}", "wall", walls, floor, lid),
        Piece(f"floor {k + 1}", placed(stage, across, floor), straight(mesh.triangles), "floor"),
        Piece(f"lid {k + 1}", placed(stage, across, lid), straight(mesh.triangles), "lid"),
        *(
            Piece(f"rim {k + 1}", placed(stage, walls.ravel(), height), edges, "rim")
            for height in (floor, lid)
        ),
    ]


def straight(triangles: Indices) -> Indices:
    """Triangles with straight sides, four for one with curved sides.

    Parameters
    ----------
    triangles : node numbers, shape (m, 3) or (m, 6)
    """
    return triangles if triangles.shape[1] == 3 else triangles[:, _PARTS].reshape(-1, 3)


def _ruled(stage: Stage, name: str, look: str, lines: Complex, floor: float, lid: float) -> Piece:
    """Upright faces on lines across the axis, shape (n, k)."""
    low = np.arange(lines.size).reshape(lines.shape)
    one, other = low[:, :-1].ravel(), low[:, 1:].ravel()
    cells: Indices = np.stack([one, other, other + lines.size, one + lines.size], axis=-1).astype(np.int64)
    plane = lines.ravel()
    points = np.concatenate([placed(stage, plane, floor), placed(stage, plane, lid)])
    return Piece(name, points, cells, look)
