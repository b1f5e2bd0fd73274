"""Meshes from and to files: Gmsh `.msh`, VTK `.vtu` and XDMF `.xdmf`. The only door to meshio."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.arrays import Array, Indices
from meshes.bodies.body import Body
from meshes.errors import InputError, require_positive
from meshes.files.foreign import limited_memory, require_file, require_harmless_xml
from meshes.liquid_section import LiquidSection, free_sides
from meshes.quality import cell_areas
from meshes.rings.triangles import open_slits
from meshes.section import Section

SUFFIXES = (".msh", ".vtu", ".xdmf")

# Names of cells in files by their nodes: in the plane, along sides and in space.
PLANE = {3: "triangle", 6: "triangle6", 4: "quad", 9: "quad9"}
LINES = {2: "line", 3: "line3"}
SPACE = {4: "tetra", 10: "tetra10"}

# Cells without an area: nodes and edges that Gmsh writes along with the others.
_DROPPED = frozenset({"vertex", *LINES.values()})

# Reverses a triangle and keeps its first vertex and the numbering of the nodes between.
_REVERSED = {3: np.array([0, 2, 1]), 6: np.array([0, 2, 1, 5, 4, 3])}


@dataclass(frozen=True)
class FileContents:
    """Points and cells of a mesh file."""

    points: Array  #: shape (N, 2 or 3), in the file's unit
    blocks: list[tuple[str, NDArray[Any]]]  #: kind of cells and their nodes
    groups: list[Indices]  #: number of the physical group of each cell of each block, 0 for none
    names: dict[tuple[int, int], str]  #: of physical groups by dimension and number


def plane_cells(path: str | Path, contents: FileContents, scale: float) -> tuple[Array, Indices, Indices]:
    """Points, m, and counter-clockwise triangles of one kind of a file; new number of each point or -1."""
    found = sorted({kind for kind, data in contents.blocks if kind not in _DROPPED and len(data)})
    if len(found) != 1 or found[0] not in ("triangle", "triangle6"):
        names = ", ".join(found) if found else "no cells with an area"
        raise InputError(
            "path", str(path), f"a mesh of triangles, all straight or all quadratic; it holds {names}"
        )
    cells = np.concatenate([data for kind, data in contents.blocks if kind == found[0]]).astype(np.int64)
    used = np.unique(cells)
    if used[0] < 0 or used[-1] >= len(contents.points):
        raise InputError("path", str(path), "a mesh whose triangles use nodes that are there")
    number = np.full(len(contents.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    points, cells = scale * _in_plane(path, contents.points[used]), number[cells]
    clockwise = cell_areas(points, cells[:, :3]) < 0.0
    turned = np.take(cells, _REVERSED[cells.shape[1]], axis=1)
    return points, np.where(clockwise[:, None], turned, cells), number


def named_lines(contents: FileContents, number: Indices) -> dict[str, Indices]:
    """End nodes of the lines of each physical group, by its name or "group 3"; other lines are left out."""
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


@dataclass(frozen=True, eq=False)
class NamedSection:
    """A section and the names that its walls have in the file."""

    section: Section  #: the section
    #: sides of each named wall, shape (S, 2 or 3): start, end, node between, the section on their left
    walls: Mapping[str, Indices]
    notes: tuple[str, ...]  #: what in the file was not kept, in words


def name_walls(
    section: Section, lines: Mapping[str, Indices], slits: Sequence[str], notes: Sequence[str]
) -> NamedSection:
    """Find the walls that have a name, and open slits along named lines: thin baffles drawn as lines."""
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


def read_section(path: str | Path, scale: float = 1.0) -> Section:
    """Section from a mesh file (`.msh` of Gmsh 2.2 or 4.1, `.vtu`, `.xdmf`), its origin the geometric axis.

    `scale` is the length of the file's unit, m. Triangles may be straight or quadratic; points, lines and
    nodes that no triangle uses are dropped, clockwise triangles are turned round.
    """
    return read_walls(path, scale).section


def read_walls(path: str | Path, scale: float = 1.0, slits: Sequence[str] = ()) -> NamedSection:
    """Section from a mesh file, with the walls that Gmsh's physical groups name.

    Slits are groups of lines inside the section along which it is opened: baffles without thickness.
    """
    contents = _contents(path, scale)
    points, cells, number = plane_cells(path, contents, scale)
    try:
        section = Section(points, cells)
    except InputError as fault:
        raise InputError("path", str(path), f"a valid section; {fault}") from fault
    return name_walls(section, named_lines(contents, number), slits, dropped_in_words(contents))


def write_section(
    section: Section,
    path: str | Path,
    *,
    point_data: Mapping[str, ArrayLike] | None = None,
    cell_data: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write a section, and fields at its nodes and on its triangles, to a mesh file.

    `.msh` (Gmsh 4.1, binary; 1, 3 or 9 components), `.vtu`, or `.xdmf` with an `.h5` file beside it.
    """
    block = (PLANE[section.triangles.shape[1]], section.triangles)
    _write(path, section.points, [block], point_data, cell_data)


def write_mesh(
    mesh: LiquidSection | Body,
    path: str | Path,
    *,
    point_data: Mapping[str, ArrayLike] | None = None,
    cell_data: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write a section or a body of liquid, and fields on it, to a mesh file.

    A `.msh` file also gets the lines of a section's free surface and walls, in physical groups named
    "surface", "outer wall", and "wall 1", "wall 2", ... for pieces that stand free; fields are 0 there.
    """
    if isinstance(mesh, Body):
        _write(path, mesh.points, [(SPACE[mesh.cells.shape[1]], mesh.cells)], point_data, cell_data)
        return
    blocks, names = [(PLANE[mesh.cells.shape[1]], mesh.cells)], ["liquid"]
    if Path(path).suffix.lower() == ".msh":
        line = LINES[mesh.surface.shape[1]]
        blocks.append((line, mesh.surface))
        names.append("surface")
        free = np.cumsum(~mesh.fixed_piece)
        for piece, fixed in enumerate(mesh.fixed_piece):
            blocks.append((line, mesh.wall[mesh.wall_piece == piece]))
            names.append("outer wall" if fixed else f"wall {free[piece]}")
    _write(path, mesh.points, blocks, point_data, cell_data, names)


def _write(
    path: str | Path,
    points: Array,
    blocks: list[tuple[str, NDArray[Any]]],
    point_data: Mapping[str, ArrayLike] | None,
    cell_data: Mapping[str, ArrayLike] | None,
    names: Sequence[str] = (),
) -> None:
    file = _known(path)
    at_points = _fields("point_data", point_data, len(points))
    at_cells = _fields("cell_data", cell_data, len(blocks[0][1]))
    # All formats keep three coordinates.
    space = points if points.shape[1] == 3 else np.column_stack([points, np.zeros(len(points))])
    sides = [len(data) for _, data in blocks[1:]]
    fields = {
        key: [values, *(np.zeros((count, *values.shape[1:])) for count in sides)]
        for key, values in at_cells.items()
    }
    # Binary, since meshio's text output of fields cannot be read back under numpy 2.
    gmsh = file.suffix.lower() == ".msh"
    options: dict[str, Any] = {"file_format": "gmsh", "binary": True} if gmsh else {}
    groups: dict[str, NDArray[Any]] = {}
    if gmsh and names:
        numbers = {name: 1 + k for k, name in enumerate(dict.fromkeys(names))}
        groups = {name: np.array([k, 2 if name == names[0] else 1]) for name, k in numbers.items()}
        # Every block is a piece of geometry of its own, which the nodes on it belong to.
        owner = np.tile([2, 1], (len(space), 1))
        for k, (_, data) in enumerate(blocks[1:], start=2):
            owner[data] = [1, k]
        # The nodes of each piece follow one another in the file: put so, they keep their fields.
        order = np.lexsort((owner[:, 1], owner[:, 0]))
        space, new = space[order], np.argsort(order)
        blocks = [(kind, new[data]) for kind, data in blocks]
        at_points = {key: values[order] for key, values in at_points.items()}
        at_points["gmsh:dim_tags"] = owner[order]
        count = [len(data) for _, data in blocks]
        fields["gmsh:geometrical"] = [np.full(n, 1 + k) for k, n in enumerate(count)]
        fields["gmsh:physical"] = [np.full(n, numbers[name]) for name, n in zip(names, count, strict=True)]
    with _guarded(path, "a file that can be written, in a folder that exists") as meshio:
        cells = [(kind, np.array(data)) for kind, data in blocks]
        mesh = meshio.Mesh(space, cells, point_data=at_points, cell_data=fields, field_data=groups)
        mesh.write(file, **options)


def _known(path: str | Path) -> Path:
    file = Path(path)
    if file.suffix.lower() not in SUFFIXES:
        raise InputError("path", str(path), "a mesh file, " + " or ".join(SUFFIXES))
    return file


@contextlib.contextmanager
def _guarded(path: str | Path, allowed: str) -> Iterator[Any]:
    """Give meshio, keep its chatter to itself, and turn whatever it stumbles over into an `InputError`.

    It prints to both streams, warns, leaves the program on some files, and its parsers raise whatever a wrong
    byte leads to; so everything but an interrupt is caught, and kept as the cause.
    """
    import meshio

    chatter = io.StringIO()
    try:
        with (
            warnings.catch_warnings(),
            contextlib.redirect_stdout(chatter),
            contextlib.redirect_stderr(chatter),
        ):
            warnings.simplefilter("ignore")
            yield meshio
    except InputError:
        raise
    except (Exception, SystemExit) as fault:
        reason = " ".join(chatter.getvalue().split()) or f"{type(fault).__name__}: {fault}"
        raise InputError("path", str(path), f"{allowed} ({reason})") from fault


def _contents(path: str | Path, scale: float) -> FileContents:
    require_positive("scale", scale)
    file = _known(path)
    require_file(file, "mesh file")
    if file.suffix.lower() != ".msh":
        require_harmless_xml(file)
    with (
        _guarded(path, "a mesh file that can be read, " + " or ".join(SUFFIXES)) as meshio,
        limited_memory(file),
    ):
        mesh = meshio.read(file)
        blocks = [(str(block.type), np.asarray(block.data)) for block in mesh.cells]
        tags = mesh.cell_data.get("gmsh:physical", [np.zeros(len(data)) for _, data in blocks])
        groups = [np.asarray(tag).astype(np.int64) for tag in tags]
        names = {(int(of[1]), int(of[0])): str(name) for name, of in mesh.field_data.items() if len(of) == 2}
        return FileContents(np.asarray(mesh.points, dtype=np.float64), blocks, groups, names)


def _fields(name: str, fields: Mapping[str, ArrayLike] | None, length: int) -> dict[str, NDArray[Any]]:
    arrays = {key: np.asarray(values) for key, values in (fields or {}).items()}
    for key, values in arrays.items():
        if values.ndim == 0 or len(values) != length:
            raise InputError(f"{name}.{key}", values.shape, f"an array of length {length}")
    return arrays
