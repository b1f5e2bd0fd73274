"""Named walls of a mesh file: what its lines and groups say about a section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshes.border import InputError
from meshes.liquid_section import free_sides
from meshes.section import Section
from meshes.slits import open_slits

Indices = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class NamedSection:
    """A section and the names that its walls have in the file.

    Parameters
    ----------
    section : the section
    walls : sides of each named wall, shape (S, 2 or 3): start, end, node between, the section on their left
    notes : what in the file was not kept, in words
    """

    section: Section
    walls: Mapping[str, Indices]
    notes: tuple[str, ...]


def name_walls(
    section: Section, lines: Mapping[str, Indices], slits: Sequence[str], notes: Sequence[str]
) -> NamedSection:
    """Find the walls that have a name, and open slits along named lines.

    Parameters
    ----------
    section : the section
    lines : end nodes of the lines of each group, shape (L, 2); -1 for nodes that the section does not use
    slits : groups along which the section is opened: thin baffles drawn as lines
    notes : what was dropped before

    Returns
    -------
    The section, opened, and its walls.

    Raises
    ------
    InputError : a slit that is no group, or does not lie inside the section
    """
    said = list(notes)
    for name in slits:
        if name not in lines:
            raise InputError(
                "slits", name, f"a group of lines in the file: {', '.join(lines) or 'there is none'}"
            )
    opened = [lines[name] for name in slits]
    cells = section.triangles
    origin = np.arange(len(section.points))
    if opened:
        points, cells = open_slits(section.points, cells, np.concatenate(opened))
        origin = np.arange(len(points))
        origin[cells] = section.triangles
        section = Section(points, cells)
    sides = free_sides(cells)
    pairs = _pairs(origin[sides[:, :2]])
    walls: dict[str, Indices] = {}
    for name, ends in lines.items():
        wanted = _pairs(ends[np.all(ends >= 0, axis=1)])
        found = sides[np.isin(pairs, wanted)]
        inside = len(np.unique(_pairs(ends))) - len(np.unique(_pairs(origin[found[:, :2]])))
        if inside:
            said.append(f"{inside} lines of '{name}' are dropped: they do not lie on a wall")
        if len(found):
            walls[name] = found
    return NamedSection(section, walls, tuple(said))


def _pairs(ends: Indices) -> Indices:
    """One number for each pair of nodes, in either order."""
    return np.asarray(np.min(ends, axis=1) * np.int64(2**31) + np.max(ends, axis=1))
