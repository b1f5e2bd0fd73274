"""Sections from drawn outlines: DXF, STEP, IGES and BREP files meshed by Gmsh. The only door to Gmsh."""

from __future__ import annotations

import contextlib
import ctypes
import math
import os
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from meshes.arrays import Array, Indices
from meshes.errors import InputError, require_few_nodes, require_positive
from meshes.files.drawing import MEET, Curve, closed_loops, meet, read_drawing
from meshes.files.foreign import require_file
from meshes.quality import cell_areas
from meshes.rings.triangles import open_slits
from meshes.section import Section


@contextlib.contextmanager
def silenced() -> Iterator[None]:
    """Send what the whole process prints on its standard output into the void.

    Libraries such as OpenCASCADE write there below Python's own streams; other threads are silent as well.
    """
    try:
        kept = os.dup(1)
    except OSError:  # there is no standard output
        yield
        return
    _flush()
    void = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(void, 1)
        yield
    finally:
        _flush()
        os.dup2(kept, 1)
        os.close(void)
        os.close(kept)


def _flush() -> None:
    """Empty the buffers of Python and of the C library, so that each text goes where it belongs."""
    with contextlib.suppress(AttributeError, ValueError):  # a stream that is missing or closed
        sys.stdout.flush()
    with contextlib.suppress(OSError, TypeError, AttributeError):  # where the C library has no common name
        ctypes.CDLL(None).fflush(None)


SUFFIXES = (".dxf", ".step", ".stp", ".iges", ".igs", ".brep")

# Gmsh's number of a triangle and of a line by order.
_TRIANGLE, _LINE = {1: 2, 2: 9}, {1: 1, 2: 8}


def outline_section(
    path: str | Path,
    wall_size: float | None = None,
    *,
    inside_size: float = math.inf,
    growth: float = 1.3,
    order: int = 2,
    scale: float | None = None,
    height: float | None = None,
    slits: Sequence[str] = (),
) -> Section:
    """Section from an outline (DXF, STEP, IGES, BREP), its geometric axis at the drawing's origin.

    The largest closed outline is the outer wall; the others within it are inner walls and obstacles. Only
    what CAD shows and plots counts; the same file and sizes give the same mesh. Sizes in m: `wall_size` a
    hundredth of the largest extent if None; `scale` is the length of the file's unit, `height` the z at which
    a solid is cut, in that unit; `slits` are layers of a DXF drawing whose lines are baffles. An
    `ImportError` without Gmsh or ezdxf (`leblanc[cad]`).
    """
    file = _check(path, wall_size, inside_size, growth, order)
    drawn = file.suffix.lower() == ".dxf"
    # OpenCASCADE turns what has a unit into millimetres.
    unit_of_model = None if file.suffix.lower() == ".brep" else 1e-3
    curves, unit = read_drawing(file) if drawn else ([], unit_of_model)
    if not drawn and unit is not None and scale is not None:
        raise InputError("scale", scale, "left out: the file names its unit")
    metre = scale if scale is not None else unit
    if metre is None:
        raise InputError("scale", scale, "given: the file does not name its unit")
    require_positive("scale", metre)
    with _gmsh(path) as gmsh:
        if drawn:
            cracks = _build(path, gmsh, curves, slits)
        else:
            cracks = []
            _import(path, gmsh, file, height)
        at_wall = _default_size(gmsh) if wall_size is None else wall_size / metre
        sizes = (at_wall, max(at_wall, inside_size / metre), math.log(growth))
        points, triangles, ends = _mesh(gmsh, sizes, order, cracks, metre)
    try:
        points, triangles = open_slits(metre * points, triangles, ends)
        return Section(points, triangles)
    except InputError as fault:
        raise InputError("path", str(path), f"an outline that wall_size resolves; {fault}") from fault


def _default_size(gmsh: Any) -> float:
    """A hundredth of the largest extent of the model, in its unit."""
    x0, y0, _, x1, y1, _ = gmsh.model.getBoundingBox(-1, -1)
    return 0.01 * float(max(x1 - x0, y1 - y0))


def _check(path: str | Path, wall_size: float | None, inside_size: float, growth: float, order: int) -> Path:
    file = Path(path)
    if file.suffix.lower() not in SUFFIXES:
        raise InputError("path", str(path), "an outline, " + " or ".join(SUFFIXES))
    require_file(file)
    if wall_size is not None:
        require_positive("wall_size", wall_size)
    if not inside_size >= (wall_size or 0.0):
        raise InputError("inside_size", inside_size, f"wall_size ({wall_size or 0.0:g} m) or above")
    if not 1.0 < growth <= 3.0:
        raise InputError("growth", growth, "above 1, 3 at most")
    if order not in (1, 2):
        raise InputError("order", order, "1 (straight edges) or 2 (quadratic edges)")
    return file


@contextlib.contextmanager
def _gmsh(path: str | Path) -> Iterator[Any]:
    """Give Gmsh a model of its own, quiet and repeatable, and leave it as it was found."""
    try:
        import gmsh
    except (ImportError, OSError) as missing:  # the wheel needs libraries of the system
        allowed = f"a mesh file; outlines need the extra `cad` and its system packages ({missing})"
        raise InputError("path", str(path), allowed) from missing

    started = not gmsh.isInitialized()
    before = "" if started else str(gmsh.model.getCurrent())
    if started:
        # No handler of signals, which only the main thread may set; no file of the user's settings.
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    options = {
        "General.Terminal": 0.0,
        "General.NumThreads": 1.0,
        "Geometry.ToleranceBoolean": 0.0,
        "Mesh.Algorithm": 6.0,
        "Mesh.MeshSizeExtendFromBoundary": 0.0,
        "Mesh.MeshSizeFromPoints": 0.0,
        "Mesh.MeshSizeFromCurvature": 0.0,
        "Mesh.MeshSizeMin": 0.0,
        "Mesh.MeshSizeMax": 1e22,
        "Mesh.MeshSizeFactor": 1.0,
        "Mesh.HighOrderOptimize": 0.0,
        "Mesh.RandomSeed": 1.0,
    }
    found = {name: gmsh.option.getNumber(name) for name in options}
    unit = gmsh.option.getString("Geometry.OCCTargetUnit")
    try:
        for name, value in options.items():
            gmsh.option.setNumber(name, value)
        gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
        gmsh.model.add("leblanc outline")
        yield gmsh
    except InputError:
        raise
    except Exception as fault:  # Gmsh raises plain exceptions for whatever it stumbles over
        reason = " ".join(str(fault).split()) or "no reason given"
        raise InputError("path", str(path), f"an outline that Gmsh can mesh ({reason})") from fault
    finally:
        if started:
            gmsh.finalize()
        else:
            gmsh.model.remove()
            gmsh.model.setCurrent(before)
            gmsh.option.setString("Geometry.OCCTargetUnit", unit)
            for name, value in found.items():
                gmsh.option.setNumber(name, value)


def _build(path: str | Path, gmsh: Any, curves: list[Curve], slits: Sequence[str]) -> list[int]:
    """Make the drawing's surface; the numbers of the curves in it that are slits."""
    layers = {curve.layer.lower(): curve.layer for curve in curves}
    thin = {name.lower() for name in slits}
    for name in slits:
        if name.lower() not in layers:
            shown = ", ".join(sorted(layers.values()))
            raise InputError("slits", name, f"a layer of the drawing that shows curves: {shown}")
    walls = [curve for curve in curves if curve.layer.lower() not in thin]
    baffles = [curve for curve in curves if curve.layer.lower() in thin]
    if not walls:
        raise InputError("slits", tuple(slits), "layers that leave curves for the walls")
    points = np.array([p for curve in walls for p in (curve.points[0], curve.points[-1])])
    number, places = meet(points)
    ends = number.reshape(-1, 2)
    speck = 2.0 * MEET * float(np.ptp(places, axis=0).max())
    whole = [
        k for k, (start, end) in enumerate(ends) if start != end or np.ptp(walls[k].points, 0).max() > speck
    ]
    walls, ends = [walls[k] for k in whole], ends[whole]
    loops = closed_loops(path, ends, places)
    _check_crossings(path, gmsh, walls, ends, places)
    outlines = _nested(path, gmsh, walls, ends, places, loops)
    made = _add_all(gmsh, walls, ends, places)
    wires = [gmsh.model.occ.addCurveLoop([made[k] for k in loop]) for loop in outlines]
    surface = gmsh.model.occ.addPlaneSurface(wires)
    if not baffles:
        gmsh.model.occ.synchronize()
        return []
    tips = [[gmsh.model.occ.addPoint(*curve.points[k], 0.0) for k in (0, -1)] for curve in baffles]
    lines = [_add(gmsh, curve, *pair) for curve, pair in zip(baffles, tips, strict=True)]
    _, parts = gmsh.model.occ.fragment([(2, surface)], [(1, line) for line in lines])
    gmsh.model.occ.synchronize()
    # Parts of baffles outside the section bound nothing and are not meshed with it.
    return [tag for pieces in parts[1:] for dimension, tag in pieces if dimension == 1]


@contextlib.contextmanager
def _aside(gmsh: Any, curves: list[Curve], ends: Indices, places: Array) -> Iterator[tuple[list[int], float]]:
    """Curves in a model of their own, one unit large, and how long that unit is."""
    model, unit = gmsh.model.getCurrent(), float(np.ptp(places, axis=0).max())
    gmsh.model.add("leblanc outlines alone")
    try:
        small = [replace(curve, points=curve.points / unit) for curve in curves]
        yield _add_all(gmsh, small, ends, places / unit), unit
    finally:
        gmsh.model.remove()
        gmsh.model.setCurrent(model)


def _check_crossings(path: str | Path, gmsh: Any, walls: list[Curve], ends: Indices, places: Array) -> None:
    """Refuse curves that cross, touch or cover one another but where they end."""
    with _aside(gmsh, walls, ends, places) as (made, unit):
        gmsh.option.setNumber("Geometry.ToleranceBoolean", MEET)
        try:
            _, parts = gmsh.model.occ.fragment([(1, tag) for tag in made], [])
        finally:
            gmsh.option.setNumber("Geometry.ToleranceBoolean", 0.0)
        gmsh.model.occ.synchronize()
        owners = Counter(part for pieces in parts for part in pieces)
        for curve, own, pieces in zip(walls, places[ends], parts, strict=True):
            if len(pieces) == 1 and owners[pieces[0]] == 1:
                continue
            tips = gmsh.model.getBoundary(pieces, combined=False, oriented=False)
            at = np.array([gmsh.model.getValue(*tip, []) for tip in tips])[:, :2] * unit
            away = np.hypot(*(at[:, None] - own[None]).T).min(axis=0)
            inner = away.max() > 2.0 * MEET * unit
            x, y = at[np.argmax(away)] if inner else curve.points[len(curve.points) // 2]
            allowed = f"a drawing of outlines that do not cross or touch, as they do at ({x:g}, {y:g})"
            raise InputError("path", str(path), allowed)


def _nested(
    path: str | Path, gmsh: Any, walls: list[Curve], ends: Indices, places: Array, loops: list[list[int]]
) -> list[list[int]]:
    """The largest of some outlines that do not cross, which must hold all others, and those right within it.

    What lies within an obstacle, as the bore of a hollow shaft, bounds nothing that liquid reaches.
    """
    if len(loops) == 1:
        return loops
    with _aside(gmsh, walls, ends, places) as (made, unit):
        wires = [gmsh.model.occ.addCurveLoop([made[k] for k in loop]) for loop in loops]
        faces = [gmsh.model.occ.addPlaneSurface([wire]) for wire in wires]
        gmsh.model.occ.synchronize()
        order = sorted(range(len(loops)), key=lambda k: -gmsh.model.occ.getMass(2, faces[k]))
        boxes = np.array([gmsh.model.getBoundingBox(2, face) for face in faces])[:, [0, 1, 3, 4]]
        kept = order[:1]
        for rank, k in enumerate(order[1:], start=1):
            place = places[ends[loops[k][0], 0]]
            at = place / unit
            around = [
                other
                for other in order[:rank]
                if np.all((boxes[other, :2] <= at) & (at <= boxes[other, 2:]))
                and gmsh.model.isInside(2, faces[other], [*at, 0.0])
            ]
            x, y = place
            if order[0] not in around:
                allowed = (
                    f"a drawing whose largest outline holds all others; one lies outside at ({x:g}, {y:g})"
                )
                raise InputError("path", str(path), allowed)
            if len(around) == 1:
                kept.append(k)
    return [loops[k] for k in kept]


def _add_all(gmsh: Any, curves: list[Curve], ends: Indices, places: Array) -> list[int]:
    """Add curves between places where they meet."""
    tags = [gmsh.model.occ.addPoint(x, y, 0.0) for x, y in places]
    return [_add(gmsh, curve, tags[i], tags[j]) for curve, (i, j) in zip(curves, ends, strict=True)]


def _add(gmsh: Any, curve: Curve, start: int, end: int) -> int:
    """Add a curve between two points of Gmsh's model."""
    between = [gmsh.model.occ.addPoint(x, y, 0.0) for x, y in curve.points[1:-1]]
    if curve.degree == 0:
        return int(gmsh.model.occ.addCircleArc(start, between[0], end, center=False))
    if curve.degree == 1 and not between:
        return int(gmsh.model.occ.addLine(start, end))
    knots, times = np.unique(np.round(curve.knots, 12), return_counts=True)
    return int(
        gmsh.model.occ.addBSpline(
            [start, *between, end],
            degree=curve.degree,
            weights=list(curve.weights),
            knots=list(knots),
            multiplicities=list(times),
        )
    )


def _import(path: str | Path, gmsh: Any, file: Path, height: float | None) -> None:
    """Bring a model's plane face in, or cut its solids at a height."""
    with silenced():  # OpenCASCADE reports on IGES files whatever Gmsh is told
        shapes = gmsh.model.occ.importShapes(str(file), highestDimOnly=True)
    gmsh.model.occ.synchronize()
    solid = any(dimension == 3 for dimension, _ in shapes)
    if solid:
        if height is None:
            raise InputError("height", height, "given: the file holds a solid, which is cut there")
        x0, y0, _, x1, y1, _ = gmsh.model.getBoundingBox(-1, -1)
        pad = 0.1 * max(x1 - x0, y1 - y0)
        cut = gmsh.model.occ.addRectangle(x0 - pad, y0 - pad, height, x1 - x0 + 2 * pad, y1 - y0 + 2 * pad)
        gmsh.model.occ.intersect([(2, cut)], [s for s in shapes if s[0] == 3])
        gmsh.model.occ.synchronize()
    faces = gmsh.model.getEntities(2)
    boxes = np.array([gmsh.model.getBoundingBox(*face) for face in faces]).reshape(-1, 6)
    thick = np.ptp(boxes[:, [2, 5]]) if len(boxes) else 0.0
    if not len(faces) or thick > 1e-5 * np.ptp(boxes[:, [0, 3]]):
        raise InputError(
            "height" if solid else "path",
            height if solid else str(path),
            "where the solid is" if solid else "a model with a face in a plane z = constant, or with a solid",
        )


def _mesh(
    gmsh: Any, sizes: tuple[float, float, float], order: int, cracks: list[int], metre: float
) -> tuple[Array, Indices, Indices]:
    """Mesh the model's faces; points, triangles, and ends of the lines on cracks."""
    at_wall, inside, slope = sizes
    faces = gmsh.model.getEntities(2)
    boundary = gmsh.model.getBoundary(faces, combined=True, oriented=False)
    near = sorted({tag for _, tag in boundary} | set(cracks))
    area, length = (
        sum(gmsh.model.occ.getMass(*one) for one in ones) for ones in (faces, [(1, k) for k in near])
    )
    # Equilateral triangles, as large as the field below has them on a strip along the walls, whose own nodes
    # are a row more.
    strip = min(area / length, (inside - at_wall) / slope)
    graded = (
        length / slope * (1.0 / at_wall - 1.0 / (at_wall + slope * strip))
        + (area - length * strip) / inside**2
    )
    vertices = 2.0 / math.sqrt(3.0) * graded + length / at_wall
    require_few_nodes("wall_size", at_wall * metre, vertices * order**2)
    field = gmsh.model.mesh.field
    distance, size = field.add("Distance"), field.add("MathEval")
    field.setNumbers(distance, "CurvesList", near)
    field.setNumber(distance, "Sampling", 200)
    field.setString(size, "F", f"Min({min(inside, 1e20):.17g}, {at_wall:.17g} + {slope:.17g} * F{distance})")
    field.setAsBackgroundMesh(size)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(order)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    points = np.asarray(coordinates).reshape(-1, 3)[:, :2]
    number = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    number[tags.astype(np.int64)] = np.arange(len(tags))
    _, nodes = gmsh.model.mesh.getElementsByType(_TRIANGLE[order])
    cells = number[nodes.astype(np.int64)].reshape(-1, 3 * order)
    lines = [gmsh.model.mesh.getElementsByType(_LINE[order], tag)[1] for tag in cracks]
    ends = (
        np.concatenate([np.empty(0, dtype=np.int64), *lines]).astype(np.int64).reshape(-1, order + 1)[:, :2]
    )
    return _turned(points, cells, number[ends])


def _turned(points: Array, cells: Indices, ends: Indices) -> tuple[Array, Indices, Indices]:
    """Counter-clockwise triangles, and the points that they use."""
    used, inverse = np.unique(cells, return_inverse=True)
    new = np.full(len(points), -1, dtype=np.int64)
    new[used] = np.arange(len(used))
    cells = inverse.astype(np.int64).reshape(len(cells), -1)
    points = points[used]
    clockwise = cell_areas(points, cells[:, :3]) < 0.0
    turned = np.take(cells, [0, 2, 1, 5, 4, 3][: cells.shape[1]], axis=1)
    ends = new[ends]
    return points, np.where(clockwise[:, None], turned, cells), ends[np.all(ends >= 0, axis=1)]
