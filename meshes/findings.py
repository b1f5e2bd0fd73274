"""Faults of a mesh, where, and what to change: findings that a user can read."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from meshes.arrays import Array, Indices
from meshes.bodies.body import Body, body_jacobians
from meshes.errors import InputError
from meshes.liquid_section import LiquidSection
from meshes.quality import SIDES, cell_areas, jacobians, vertex_angles
from meshes.section import Section

# Angles beyond this spoil the gradients on a triangle, however small it is; thin cells do not.
_WIDEST = math.radians(160.0)

# Neighbours whose areas differ by more than this carry the error of the larger one.
_JUMP = 20.0

# Errors of frequencies that are worth a word, and points across the liquid that a wave needs at least.
_WAVE_ERROR, _ACROSS = 0.01, 3


@dataclass(frozen=True)
class Finding:
    """A fault of a mesh."""

    what: str  #: the fault, with its figure
    where: tuple[float, ...]  #: the worst place, m; two or three coordinates
    change: str  #: what makes it better

    def __str__(self) -> str:
        place = ", ".join(f"{value:.4g}" for value in self.where)
        return f"{self.what} at ({place}) m: {self.change}"


def mesh_findings(mesh: Section | LiquidSection | Body) -> tuple[Finding, ...]:
    """Faults of a mesh, the worst place of each: folded cells, angles near 180 degrees, sizes that jump."""
    if isinstance(mesh, Body):
        return _folded(mesh.points, mesh.cells, body_jacobians(mesh.points, mesh.cells))
    cells = mesh.triangles if isinstance(mesh, Section) else mesh.cells
    found = _folded(mesh.points, cells, jacobians(mesh.points, cells))
    return (*found, *_wide(mesh.points, cells), *_uneven(mesh.points, cells))


def wave_findings(liquid: LiquidSection, mode: int) -> tuple[Finding, ...]:
    """Where a mesh does not resolve n crests along and across the liquid to 1 % of the squared frequency."""
    found = []
    points = points_per_wave(liquid, mode)
    error = wave_error(points, liquid.order)
    sides = liquid.points[liquid.surface[:, :2]]
    if error > _WAVE_ERROR:
        longest = int(np.argmax(np.hypot(*(sides[:, 1] - sides[:, 0]).T)))
        # Nodes on a wavelength that bring `wave_error` to the limit.
        step = math.sqrt(12.0 * _WAVE_ERROR) if liquid.order == 1 else (720.0 * _WAVE_ERROR) ** 0.25
        wanted = 2.0 * math.pi * liquid.order / step
        found.append(
            Finding(
                f"{points:.1f} nodes per wave of mode {mode} on the free surface, "
                f"an error of about {100.0 * error:.2g} % of its frequency squared",
                _place(sides[longest].mean(axis=0)),
                f"sides {points / wanted:.2g} times as long on the surface, or quadratic cells",
            )
        )
    across, where = points_across(liquid, mode)
    if across < _ACROSS:
        found.append(
            Finding(
                f"{across} nodes across the liquid that mode {mode} moves",
                _place(where),
                "more layers, or cells graded towards the free surface",
            )
        )
    return tuple(found)


def points_per_wave(liquid: LiquidSection, mode: int) -> float:
    """Nodes on a wavelength 2 pi a/n of the free surface where its sides are longest."""
    _check_mode(mode)
    start, end = (liquid.points[liquid.surface[:, k]] for k in (0, 1))
    chord = float(np.hypot(*(end - start).T).max())
    angle = 2.0 * math.asin(min(1.0, 0.5 * chord / liquid.surface_radius))
    return liquid.order * 2.0 * math.pi / (mode * angle)


def wave_error(points: float, order: int) -> float:
    """Relative error, at most 1, of a squared frequency of waves along a line on even finite elements.

    (k s)^2/12 for linear elements of length s, (k s)^4/720 for quadratic ones, to leading order, with k s = 2
    pi p/N for N nodes on a wavelength and degree p.
    """
    step = 2.0 * math.pi * order / points
    return min(1.0, step**2 / 12.0 if order == 1 else step**4 / 720.0)


def points_across(liquid: LiquidSection, mode: int) -> tuple[int, Array]:
    """Fewest nodes from the free surface down to a/n or the wall, both ends counted; where that is, m."""
    _check_mode(mode)
    steps, radius = _steps_below(liquid), np.hypot(*liquid.points.T)
    deepest = float(radius[liquid.wall[:, 0]].max()) - liquid.surface_radius
    reach = min(deepest, liquid.surface_radius / mode)
    vertices = np.isfinite(steps)
    # Nodes at that depth or just below it, or on a wall well below the surface.
    below = vertices & (radius - liquid.surface_radius >= reach * (1.0 - 1e-9))
    walls = np.zeros(len(radius), dtype=bool)
    walls[liquid.wall[:, :2]] = True
    below |= vertices & walls & (radius - liquid.surface_radius >= 0.5 * reach)
    fewest = int(np.argmin(np.where(below, steps, np.inf)))
    return int(steps[fewest]) * liquid.order + 1, liquid.points[fewest]


def _steps_below(liquid: LiquidSection) -> Array:
    """Sides of cells from the free surface to each vertex; infinite for other nodes."""
    ends = liquid.cells[:, SIDES[liquid.cells.shape[1]][:, :2]].reshape(-1, 2)
    count = len(liquid.points)
    start = np.unique(liquid.surface[:, :2])
    rows = np.concatenate([ends[:, 0], np.full(len(start), count)])
    columns = np.concatenate([ends[:, 1], start])
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(count + 1, count + 1)).tocsr()
    graph.data[:] = 1.0
    return np.asarray(dijkstra(graph, directed=False, indices=count, unweighted=True))[:count] - 1.0


def _folded(points: Array, cells: Indices, jacobian: Array) -> tuple[Finding, ...]:
    bad = np.flatnonzero(jacobian.min(axis=1) <= 0.0)
    if not len(bad):
        return ()
    place = _place(points[cells[bad[0]]].mean(axis=0))
    return (Finding(f"{len(bad)} of {len(cells)} cells are folded", place, "smaller cells at curved walls"),)


def _wide(points: Array, cells: Indices) -> tuple[Finding, ...]:
    angles = vertex_angles(points, cells).max(axis=1)
    worst = int(np.argmax(angles))
    if angles[worst] <= _WIDEST:
        return ()
    what = f"{int(np.sum(angles > _WIDEST))} of {len(cells)} cells have an angle near 180 degrees, "
    return (
        Finding(
            what + f"{math.degrees(angles[worst]):.0f} at most",
            _place(points[cells[worst]].mean(axis=0)),
            "another size there, so that nodes fall differently",
        ),
    )


def _uneven(points: Array, cells: Indices) -> tuple[Finding, ...]:
    sides = SIDES[cells.shape[1]][:, :2]
    ends = np.sort(cells[:, sides].reshape(-1, 2), axis=1)
    order = np.lexsort(ends.T)
    same = np.all(ends[order[1:]] == ends[order[:-1]], axis=1)
    first, other = order[:-1][same] // len(sides), order[1:][same] // len(sides)
    area = np.abs(cell_areas(points, cells))
    ratio = np.maximum(area[first], area[other]) / np.maximum(np.minimum(area[first], area[other]), 1e-300)
    if not len(ratio) or ratio.max() <= _JUMP:
        return ()
    worst = int(np.argmax(ratio))
    return (
        Finding(
            f"neighbours differ {ratio[worst]:.0f} times in area",
            _place(points[cells[first[worst]]].mean(axis=0)),
            "a smaller growth from cell to cell",
        ),
    )


def _check_mode(mode: int) -> None:
    if mode != int(mode) or mode < 1:
        raise InputError("mode", mode, "a whole number, 1 or more")


def _place(point: Array) -> tuple[float, ...]:
    return tuple(float(value) for value in point)
