"""Outlines from DXF drawings: lines, arcs and splines, exact as drawn. The only door to ezdxf."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from meshes.arrays import Array, Indices
from meshes.errors import InputError
from meshes.files.foreign import limited_memory

_MOST = 20_000  # curves; blocks within blocks make many of a few lines

# Ends of curves nearer than this part of the drawing meet.
MEET = 1e-6


def meet(points: Array) -> tuple[Indices, Array]:
    """Number the places where ends of curves meet: that of each end, (N,), and the places, (P, 2)."""
    reach = MEET * float(np.ptp(points, axis=0).max())
    first = np.array([min(near) for near in cKDTree(points).query_ball_point(points, reach)])
    places, number = np.unique(first, return_inverse=True)
    return number.astype(np.int64), points[places]


def closed_loops(path: str | Path, ends: Indices, places: Array) -> list[list[int]]:
    """Numbers of the curves of each outline, in order, from the places of their ends.

    An `InputError` names the place where an outline is open or branches.
    """
    degree = np.bincount(ends.ravel(), minlength=len(places))
    if np.any(degree != 2):
        worst = int(np.argmax(degree != 2))
        x, y = places[worst]
        state = {1: "open", 3: "branching"}.get(int(degree[worst]), "touching another, or drawn twice,")
        raise InputError("path", str(path), f"a drawing of closed outlines; one is {state} at ({x:g}, {y:g})")
    at: list[list[int]] = [[] for _ in places]
    for k, (first, other) in enumerate(ends):
        at[first].append(k)
        at[other].append(k)
    left, loops = set(range(len(ends))), []
    while left:
        loop = [min(left)]
        left.remove(loop[0])
        place = ends[loop[0], 1]
        while following := [k for k in at[place] if k in left]:
            loop.append(following[0])
            left.remove(loop[-1])
            first, other = ends[loop[-1]]
            place = other if place == first else first
        loops.append(loop)
    return loops


# Units of the US survey foot, m, by their number in a DXF file: foot, inch, yard, mile.
_SURVEY = {21: 1200.0 / 3937.0, 22: 100.0 / 3937.0, 23: 3600.0 / 3937.0, 24: 6336000.0 / 3937.0}

_FRAME = 16  # flag of a vertex that steers a spline

_READ = ("LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE", "INSERT")


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve of a drawing."""

    layer: str  #: where it was drawn
    #: in the plane, shape (K, 2), in the drawing's unit: the two ends of a line; the start, a point between
    #: and the end of a circular arc; the control points of a spline, which starts and ends on the outer two
    points: Array
    degree: int  #: of a spline; 1 for a line, 0 for an arc
    knots: tuple[float, ...] = ()  #: of a spline; weights are empty if it is not rational
    weights: tuple[float, ...] = ()


def read_drawing(path: str | Path) -> tuple[list[Curve], float | None]:
    """Curves in the model space of a DXF drawing, and the length of its unit, m, None if it has none.

    Text, dimensions, hatches and similar entities are skipped, blocks are opened. An `InputError` for curves
    outside one plane z = constant, splines that do not end on their control points, no curve at all.
    """
    try:
        import ezdxf
        from ezdxf import units
    except ImportError as missing:
        allowed = f"a mesh file; drawings need the extra `cad` ({missing})"
        raise InputError("path", str(path), allowed) from missing

    try:
        with limited_memory(path):
            document = ezdxf.readfile(path)
            _take_arrays_apart(path, document)
            entities = list(islice(_opened(document.modelspace(), _layers(document)), _MOST + 1))
            said = b"$INSUNITS" in Path(path).read_bytes()  # ezdxf takes metres where a file does not say
    except InputError:
        raise
    except RecursionError as fault:
        raise InputError("path", str(path), "a drawing whose blocks do not hold themselves") from fault
    except Exception as fault:  # ezdxf raises whatever a wrong tag leads to
        reason = " ".join(str(fault).split()) or type(fault).__name__
        raise InputError("path", str(path), f"a DXF drawing that can be read ({reason})") from fault
    if len(entities) > _MOST:
        raise InputError(
            "path", str(path), f"a drawing of at most {_MOST} curves, those of its blocks counted"
        )
    pieces = [(layer, points) for entity, layer in entities for points in _pieces(path, entity)]
    if not pieces:
        kinds = ", ".join(sorted({entity.dxftype() for entity in document.modelspace()})) or "nothing"
        raise InputError("path", str(path), f"a drawing that shows {', '.join(_READ[:-1])}; it holds {kinds}")
    curves, heights = [], []
    for layer, (points, degree, knots, weights) in pieces:
        at = np.array([(p.x, p.y, p.z) for p in points], dtype=np.float64)
        heights.append(at[:, 2])
        curves.append(Curve(layer, at[:, :2], degree, tuple(knots), tuple(weights)))
    extent = max(float(np.ptp(np.concatenate([c.points for c in curves]), axis=0).max()), 1e-300)
    if np.ptp(np.concatenate(heights)) > 1e-9 * extent:
        raise InputError("path", str(path), "a drawing in a plane z = constant")
    unit = int(document.units) if said else 0
    if unit in _SURVEY:
        return curves, _SURVEY[unit]
    return curves, float(units.conversion_factor(unit, units.M)) if 0 < unit < min(_SURVEY) else None


def _layers(document: Any) -> tuple[frozenset[str], frozenset[str]]:
    """Layers that CAD does not show or plot, in lower case, and those of them that are frozen."""
    frozen = {layer.dxf.name.lower() for layer in document.layers if layer.is_frozen()}
    hidden = {layer.dxf.name.lower() for layer in document.layers if layer.is_off() or not layer.dxf.plot}
    return frozenset({"defpoints", *hidden, *frozen}), frozenset(frozen)


def _take_arrays_apart(path: str | Path, document: Any) -> None:
    """Put single copies in place of arrays of blocks: their spacing grows with the block that holds them."""
    for layout in (document.modelspace(), *document.blocks):
        arrays = [entity for entity in layout if entity.dxftype() == "INSERT" and entity.mcount > 1]
        if sum(array.mcount for array in arrays) > _MOST:
            raise InputError("path", str(path), f"a drawing of arrays of at most {_MOST} copies")
        for array in arrays:
            for copy in array.multi_insert():
                document.entitydb.add(copy)
                layout.add_entity(copy)
            layout.delete_entity(array)


def _opened(
    entities: Any, layers: tuple[frozenset[str], frozenset[str]], around: str = "0"
) -> Iterator[tuple[Any, str]]:
    """Curves that CAD plots among some entities, each with its layer; blocks and polylines taken apart.

    What a block has on layer 0 lies on that of its insertion, `around`. A layer that is off hides what lies
    on it; one that is frozen also hides blocks inserted on it, whatever layers they hold.
    """
    hidden, frozen = layers
    for entity in entities:
        kind, layer = entity.dxftype(), str(entity.dxf.layer)
        layer = around if layer == "0" else layer
        block = kind == "INSERT"
        if kind not in _READ or entity.dxf.invisible or layer.lower() in (frozen if block else hidden):
            continue
        if block:
            yield from _opened(entity.virtual_entities(), layers, layer)
        elif kind in ("LWPOLYLINE", "POLYLINE"):
            if kind == "POLYLINE":  # a fitted one holds the frame of its spline too, which is not drawn
                entity.vertices[:] = [one for one in entity.vertices if not one.dxf.flags & _FRAME]
            yield from ((piece, layer) for piece in entity.virtual_entities())
        else:
            yield entity, layer


def _pieces(path: str | Path, entity: Any) -> Iterator[tuple[Any, int, Any, Any]]:
    """Points, degree, knots and weights of an entity; closed curves fall into two or three pieces."""
    kind = entity.dxftype()
    if kind == "LINE":
        if entity.dxf.start.distance(entity.dxf.end) > 0.0:
            yield (entity.dxf.start, entity.dxf.end), 1, (), ()
    elif kind == "ARC":
        start, end = entity.dxf.start_angle, entity.dxf.end_angle
        turn = (end - start) % 360.0 or 360.0
        yield from _arcs(entity, start, turn, 1 if turn < 300.0 else 3)
    elif kind == "CIRCLE":
        yield from _arcs(entity, 0.0, 360.0, 3)
    else:
        for spline in _splines(entity):
            if not spline.is_clamped:
                raise InputError("path", str(path), "a drawing whose splines end on their control points")
            yield spline.control_points, spline.degree, spline.knots(), spline.weights()


def _arcs(entity: Any, start: float, turn: float, parts: int) -> Iterator[tuple[Any, int, Any, Any]]:
    for k in range(parts):
        angles = [start + turn * (k + share) / parts for share in (0.0, 0.5, 1.0)]
        yield tuple(entity.vertices(angles)), 0, (), ()


def _splines(entity: Any) -> Iterator[Any]:
    """A spline, or an ellipse as rational splines, which are exact; two halves if it is closed."""
    from ezdxf.math import BSpline, ConstructionEllipse

    if entity.dxftype() == "ELLIPSE":
        start, end = entity.dxf.start_param, entity.dxf.end_param
        turn = (end - start) % (2.0 * np.pi) or 2.0 * np.pi
        tool = entity.construction_tool()
        for half in (0.0, 0.5):
            ends = start + half * turn, start + (half + 0.5) * turn
            yield BSpline.from_ellipse(
                ConstructionEllipse(tool.center, tool.major_axis, tool.extrusion, tool.ratio, *ends)
            )
        return
    spline = entity.construction_tool()
    extent = np.ptp([(p.x, p.y) for p in spline.control_points], axis=0).max()
    if spline.is_clamped and spline.control_points[0].distance(spline.control_points[-1]) < 1e-9 * extent:
        knots = np.unique(spline.knots())
        middle = len(knots) // 2
        yield from spline.split(0.5 * float(knots[middle - 1] + knots[middle]))  # between two knots
    else:
        yield spline
