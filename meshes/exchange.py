"""Sections from and to mesh files: Gmsh `.msh` and VTK `.vtu`. The only door to meshio."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.border import InputError, require_positive
from meshes.quality import triangle_areas
from meshes.section import Section

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SUFFIXES = (".msh", ".vtu")

# Cells that a section has no use for: nodes and edges that Gmsh writes along with the triangles.
_DROPPED = frozenset({"vertex", "line", "line3"})
_TRIANGLES = ("triangle", "triangle6")

# Reverses a triangle and keeps its first vertex and the numbering of its midside nodes.
_REVERSED = np.array([0, 2, 1, 5, 4, 3])


def read_section(path: str | Path, scale: float = 1.0) -> Section:
    """Section from a mesh file.

    Triangles may be straight or quadratic; points and lines in the file are dropped, so are nodes that no
    triangle uses, and clockwise triangles are turned round.

    Parameters
    ----------
    path : a `.msh` file (Gmsh 2.2 or 4.1, text or binary) or a `.vtu` file
    scale : length of the file's unit, m: 1e-3 for a mesh drawn in millimetres

    Returns
    -------
    The section, in metres; coordinates are from the file's origin, which is taken for the geometric axis.

    Raises
    ------
    InputError : no such file, not a mesh, cells other than triangles, a mesh that does not lie in a plane
        z = constant, triangles that `Section` refuses
    """
    require_positive("scale", scale)
    file = _known(path)
    if not file.is_file():
        raise InputError("path", str(path), "an existing mesh file")
    with _guarded(path, "a mesh file that can be read, .msh or .vtu") as meshio:
        mesh = meshio.read(file)
        blocks = [(str(block.type), np.asarray(block.data)) for block in mesh.cells]
        points = np.asarray(mesh.points, dtype=np.float64)
    triangles = _triangles(path, blocks)
    used, inverse = np.unique(triangles, return_inverse=True)
    if used[0] < 0 or used[-1] >= len(points):
        raise InputError("path", str(path), "a mesh whose triangles use nodes that are there")
    width = triangles.shape[1]
    numbers: Indices = inverse.astype(np.int64).reshape(-1, width)
    plane = scale * _in_plane(path, points[used])
    clockwise = triangle_areas(plane, numbers[:, :3]) < 0.0
    numbers = np.where(clockwise[:, None], np.take(numbers, _REVERSED[:width], axis=1), numbers)
    try:
        return Section(plane, numbers)
    except InputError as fault:
        raise InputError("path", str(path), f"a valid section; {fault}") from fault


def write_section(
    section: Section,
    path: str | Path,
    *,
    point_data: Mapping[str, ArrayLike] | None = None,
    cell_data: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Write a section, and fields on it, to a mesh file.

    Parameters
    ----------
    section : the section, in metres
    path : a `.msh` file (Gmsh 4.1, binary) or a `.vtu` file; its folder must exist
    point_data : fields at the nodes by name, each of shape (N, ...); `.msh` takes 1, 3 or 9 components
    cell_data : fields on the triangles by name, each of shape (M, ...)

    Raises
    ------
    InputError : another kind of file, a field of another length, a file that cannot be written
    """
    file = _known(path)
    at_points = _fields("point_data", point_data, len(section.points))
    at_cells = _fields("cell_data", cell_data, len(section.triangles))
    # Both formats keep three coordinates.
    points = np.column_stack([section.points, np.zeros(len(section.points))])
    kind = _TRIANGLES[section.order - 1]
    # Binary, since meshio's text output of fields cannot be read back under numpy 2.
    gmsh = file.suffix.lower() == ".msh"
    options: dict[str, Any] = {"file_format": "gmsh", "binary": True} if gmsh else {}
    with _guarded(path, "a file that can be written, in a folder that exists") as meshio:
        mesh = meshio.Mesh(
            points,
            [(kind, np.array(section.triangles))],
            point_data=at_points,
            cell_data={name: [values] for name, values in at_cells.items()},
        )
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
    except (Exception, SystemExit) as fault:
        reason = " ".join(chatter.getvalue().split()) or f"{type(fault).__name__}: {fault}"
        raise InputError("path", str(path), f"{allowed} ({reason})") from fault


def _triangles(path: str | Path, blocks: list[tuple[str, NDArray[Any]]]) -> Indices:
    """The one kind of triangles among the cells of a file."""
    found = sorted({kind for kind, data in blocks if kind not in _DROPPED and len(data)})
    if len(found) != 1 or found[0] not in _TRIANGLES:
        names = ", ".join(found) if found else "no cells with an area"
        raise InputError(
            "path", str(path), f"a mesh of triangles, all straight or all quadratic; it holds {names}"
        )
    return np.concatenate([data for kind, data in blocks if kind == found[0]]).astype(np.int64)


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


def _fields(name: str, fields: Mapping[str, ArrayLike] | None, length: int) -> dict[str, NDArray[Any]]:
    arrays = {key: np.asarray(values) for key, values in (fields or {}).items()}
    for key, values in arrays.items():
        if values.ndim == 0 or len(values) != length:
            raise InputError(f"{name}.{key}", values.shape, f"an array of length {length}")
    return arrays
