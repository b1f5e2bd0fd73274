"""Liquid in a spinning drum condensed to its free surface: the matrices of its motion.

The liquid's motion in the drum's frame is a displacement with the stream function eta, u = curl eta',
harmonic at every time. With the finite elements' values of eta on the free surface and on walls that pierce
it,

    K eta'' + 2 Omega C eta' + Omega^2 B eta = - P^T f,    Q = -rho P eta,

for a uniform body force f; Q is the first moment of the displaced liquid, per length of the axis. Nothing
depends on the spin but what is written: one condensation serves every speed. The integrals are scikit-fem's;
this is the door of sloshing to it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr
from scipy.sparse import coo_array, csc_array, csr_array, vstack
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu
from skfem import (
    BilinearForm,
    CellBasis,
    ElementQuad1,
    ElementQuad2,
    ElementTriP1,
    ElementTriP2,
    MeshQuad1,
    MeshQuad2,
    MeshTri1,
    MeshTri2,
)

from meshes.arrays import Array, Complex, Indices
from meshes.liquid_section import SIDES, LiquidSection

_MESHES = {3: MeshTri1, 6: MeshTri2, 4: MeshQuad1, 9: MeshQuad2}
_ELEMENTS = {3: ElementTriP1, 6: ElementTriP2, 4: ElementQuad1, 9: ElementQuad2}
# Degree of the quadrature: exact on straight cells; on curved ones far below the error of the elements.
_DEGREE = {3: 2, 6: 6, 4: 4, 9: 8}
_GAUSS = np.polynomial.legendre.leggauss(8)
# Corners of the reference cell by their number.
_CORNERS = {
    3: np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
    4: np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
}


@dataclass(frozen=True, eq=False)
class WallPoints:
    """Quadrature points on the walls, both sides of a slit."""

    points: Array  #: where they are, shape (Q, 2), m
    weights: Array  #: length of wall each stands for, shape (Q,), m
    along: Array  #: unit tangent with the liquid on the left, shape (Q, 2)
    #: psi at the nodes to its derivative along the normal out of the liquid, shape (Q, N), 1/m
    slope: csr_array


def stiffness(section: LiquidSection) -> csr_array:
    """K = int grad psi . grad v over the liquid, symmetric, over the nodes [theory: sloshing, eq. 6]."""
    basis = CellBasis(*_mesh(section), intorder=_DEGREE[section.cells.shape[1]], disable_doflocs=True)
    raw = BilinearForm(_gradients).assemble(basis).tocoo()
    node = _node_of_unknown(section, basis.element_dofs)
    return csr_array(coo_array((raw.data, (node[raw.row], node[raw.col])), shape=(len(section.points),) * 2))


def wall_points(section: LiquidSection) -> WallPoints:
    """Points on the walls with the slope of the stream function there, eight to a side."""
    mesh, element = _mesh(section)
    t, weight = 0.5 * (1.0 + _GAUSS[0]), 0.5 * _GAUSS[1]
    corners = _CORNERS[len(SIDES[section.cells.shape[1]])]
    points, along, weights, slopes = [], [], [], []
    for start, end, own, cells in _walls_by_side(section, corners):
        place, tangent = _along(section.points[section.wall[own]], t)
        speed = np.sqrt(np.sum(np.square(tangent), axis=2))
        unit = tangent / speed[:, :, None]
        at = start[:, None] + (end - start)[:, None] * t
        basis = CellBasis(mesh, element, elements=cells, quadrature=(at, weight), disable_doflocs=True)
        grads = np.stack([np.asarray(field[0].grad) for field in basis.basis])  # (nodes, 2, cells, points)
        slope = grads[:, 0] * unit[:, :, 1] - grads[:, 1] * unit[:, :, 0]
        nodes = np.broadcast_to(section.cells[cells].T[:, :, None], slope.shape)
        rows = np.broadcast_to(np.arange(speed.size).reshape(speed.shape), slope.shape)
        shape = (speed.size, len(section.points))
        slopes.append(coo_array((slope.ravel(), (rows.ravel(), nodes.ravel())), shape=shape))
        points.append(place.reshape(-1, 2))
        along.append(unit.reshape(-1, 2))
        weights.append((speed * weight).ravel())
    return WallPoints(
        points=np.concatenate(points),
        weights=np.concatenate(weights),
        along=np.concatenate(along),
        slope=csr_array(vstack(slopes)),
    )


def gradients(section: LiquidSection) -> tuple[csr_array, csr_array]:
    """Matrices from psi at the nodes to d psi/dx and d psi/dy at the cells' middles, (M, N), 1/m.

    The velocity is u = (d psi/dy, -d psi/dx).
    """
    mesh, element = _mesh(section)
    corners = len(SIDES[section.cells.shape[1]])
    middle = np.full((2, 1), 1.0 / 3.0 if corners == 3 else 0.5)
    basis = CellBasis(mesh, element, quadrature=(middle, np.ones(1)), disable_doflocs=True)
    cells = len(section.cells)
    node = _node_of_unknown(section, basis.element_dofs)[basis.element_dofs]
    row = np.broadcast_to(np.arange(cells), node.shape).ravel()
    slopes = np.stack([np.asarray(field[0].grad)[:, :, 0] for field in basis.basis], axis=1)
    shape = (cells, len(section.points))
    along_x, along_y = (
        csr_array(coo_array((slope.ravel(), (row, node.ravel())), shape=shape)) for slope in slopes
    )
    return along_x, along_y


def _gradients(u: Any, v: Any, _w: Any) -> Any:
    return u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]


def _mesh(section: LiquidSection) -> tuple[Any, Any]:
    """Mesh and element; scikit-fem numbers the nodes of curved cells in its own way."""
    nodes = section.cells.shape[1]
    mesh = _MESHES[nodes](
        np.ascontiguousarray(section.points.T), np.ascontiguousarray(section.cells.T), sort_t=False
    )
    return mesh, _ELEMENTS[nodes]()


def _node_of_unknown(section: LiquidSection, unknowns: Indices) -> Indices:
    """Node of the section that each of scikit-fem's unknowns sits on; both list a cell's nodes alike."""
    node = np.empty(len(section.points), dtype=np.int64)
    node[unknowns] = section.cells.T
    return node


def _walls_by_side(section: LiquidSection, corners: Array) -> Iterator[tuple[Array, Array, Indices, Indices]]:
    """Sides on walls by their place in the cell: its ends in the reference cell, wall sides, their cells."""
    size = np.int64(len(section.points))
    wanted = section.wall[:, 0] * size + section.wall[:, 1]
    for local, side in enumerate(SIDES[section.cells.shape[1]]):
        key = section.cells[:, side[0]] * size + section.cells[:, side[1]]
        _, own, cells = np.intersect1d(wanted, key, assume_unique=True, return_indices=True)
        if len(own):
            yield corners[local], corners[(local + 1) % len(corners)], own, cells


def _along(nodes: Array, t: Array) -> tuple[Array, Array]:
    """Positions and slopes at 0 <= t <= 1 along sides of two or three nodes, shape (sides, points, 2)."""
    start, end = nodes[:, None, 0], nodes[:, None, 1]
    t = t[:, None]
    if nodes.shape[1] == 2:
        return start + (end - start) * t, np.broadcast_to(end - start, (len(nodes), len(t), 2))
    bend = 4.0 * nodes[:, None, 2] - 2.0 * (start + end)
    return start + (end - start) * t + bend * t * (1.0 - t), end - start + bend * (1.0 - 2.0 * t)


_CHUNK = 128  # columns solved for at once


@dataclass(frozen=True, eq=False)
class LiquidSystem:
    """Liquid of a section condensed to its free surface; made by `condense`."""

    section: LiquidSection  #: the liquid at rest
    inertia: Array  #: K, symmetric, positive definite, shape (n, n), a pure number
    gyration: Array  #: C, antisymmetric, shape (n, n), a pure number
    surface: Array  #: B, symmetric, positive definite, shape (n, n), a pure number
    moment: Array  #: P, shape (2, n), m
    liquid_area: float  #: of the liquid, and with the dry middle, m^2
    enclosed_area: float
    #: flows around closed free surfaces and free-standing walls that the condensation leaves out: they are
    #: steady, and no force of the drum starts them
    circulations: int
    unknowns: int  #: stream function values that the mesh has, walls left out
    interior: Interior  #: what gives the values on all nodes, see `on_nodes`

    def on_nodes(self, amplitudes: Array | Complex) -> Complex:
        """Stream function on the nodes of the mesh, shape (k, N), of amplitudes (k, n)."""
        return self.interior.on_nodes(amplitudes)

    def products(self, amplitudes: Complex) -> tuple[Complex, Complex, Complex]:
        """K, C and B times amplitudes, shape (k, n) each."""
        inertia, gyration, surface = self.inertia, self.gyration, self.surface
        return amplitudes @ inertia.T, amplitudes @ gyration.T, amplitudes @ surface.T


class Condensed(Protocol):
    """Liquid of a section in unknowns on its free surface: as dense matrices, or as what they do."""

    @property
    def section(self) -> LiquidSection:
        """The liquid at rest."""
        ...

    @property
    def circulations(self) -> int:
        """Steady flows left out."""
        ...

    def on_nodes(self, amplitudes: Array | Complex) -> Complex:
        """Stream function on the nodes, shape (k, n) to (k, N)."""
        ...

    def products(self, amplitudes: Complex) -> tuple[Complex, Complex, Complex]:
        """K, C and B times amplitudes, shape (k, n) each."""
        ...


@dataclass(frozen=True, eq=False)
class SurfaceSystem:
    """The same liquid without dense matrices; made by `surface_system`.

    Unknowns are the values on the surface and on walls that pierce it, of motions without circulation.
    """

    section: LiquidSection  #: as in `LiquidSystem`
    gyration: csr_array  #: C, sparse, shape (n, n)
    #: D and W, sparse, B = D^T W D of differences along the sides, which cells of very unlike width do not
    #: spoil by rounding, shape (r, n) and (r, r)
    rise: csr_array
    bend: csr_array
    give: csr_array  #: the inverse of W, sparse
    whole: csr_array  #: stiffness of the surface with the inside held, sparse, shape (n, n)
    moment: Array  #: P, shape (2, n), m
    steady: Array  #: 1 on each closed part of the surface, shape (n, p)
    liquid_area: float
    enclosed_area: float
    circulations: int
    unknowns: int
    interior: Interior  #: what gives the values on all nodes
    pieces: int  #: stretches of the surface that no path along it joins

    def on_nodes(self, amplitudes: Array | Complex) -> Complex:
        """Stream function on the nodes of the mesh, shape (k, N), of amplitudes (k, n)."""
        return self.interior.on_nodes(amplitudes)

    def inertia_times(self, values: Any) -> Any:
        """K times columns, shape (n, k), by one solution inside for each."""
        if np.iscomplexobj(values):
            return self.inertia_times(values.real) + 1j * self.inertia_times(values.imag)
        if self.interior.factors is None:
            return self.whole @ values
        coupling = self.interior.coupling
        return self.whole @ values - coupling.T @ self.interior.factors.solve(coupling @ values)

    def surface_times(self, values: Any) -> Any:
        """B times columns, shape (n, k)."""
        return self.rise.T @ (self.bend @ (self.rise @ values))

    def products(self, amplitudes: Complex) -> tuple[Complex, Complex, Complex]:
        """K, C and B times amplitudes, shape (k, n) each."""
        columns = amplitudes.T
        found = self.inertia_times(columns), self.gyration @ columns, self.surface_times(columns)
        return np.asarray(found[0].T), np.asarray(found[1].T), np.asarray(found[2].T)


@dataclass(frozen=True, eq=False)
class Interior:
    """Harmonic continuation from the condensed unknowns to the nodes."""

    #: columns span what the condensed unknowns mean on the surface, shape (surface unknowns, n); None if they
    #: are the values there
    basis: Array | None
    factors: Any  #: of the stiffness inside
    coupling: csr_array  #: stiffness between inside and surface
    unknown: Indices  #: of each node, -1 where psi = 0, shape (N,)
    place: Indices  #: of the unknowns in the vector of inside, then surface, shape (unknowns,)

    def on_nodes(self, amplitudes: Array | Complex) -> Complex:
        """Values on all nodes, shape (k, n) to (k, N)."""
        real, imag = (self.expand(np.atleast_2d(part)) for part in (amplitudes.real, amplitudes.imag))
        return np.asarray(real + 1j * imag)

    def expand(self, amplitudes: Array) -> Array:
        """Values on all nodes of real amplitudes, shape (k, n) to (k, N)."""
        at_surface = amplitudes.T if self.basis is None else self.basis @ amplitudes.T
        inside = at_surface[:0] if self.factors is None else -self.factors.solve(self.coupling @ at_surface)
        values = np.concatenate([inside, at_surface, np.zeros((1, len(amplitudes)))])
        place = np.append(self.place, len(values) - 1)  # the last one for unknown -1
        return np.asarray(values[place[self.unknown]].T)


def condense(section: LiquidSection) -> LiquidSystem:
    """Matrices of the liquid's motion on the free surface [theory: sloshing, eq. 9].

    Their size is that of the nodes on the free surface, the cost the cube of that.
    """
    parts = _parts(section)
    schur = parts.schur()
    constants, outside = parts.steady, parts.outside
    basis = np.eye(len(outside)) if constants.shape[1] == 0 else qr(schur @ constants)[0]
    basis = np.asarray(basis[:, constants.shape[1] :])
    inertia, gyration, surface = (
        basis.T @ matrix @ basis for matrix in (schur, parts.gyration.toarray(), parts.surface.toarray())
    )
    return LiquidSystem(
        section=section,
        inertia=0.5 * (inertia + inertia.T),
        gyration=0.5 * (gyration - gyration.T),
        surface=0.5 * (surface + surface.T),
        moment=np.asarray(parts.moment @ basis),
        liquid_area=area_within(section.points, np.concatenate([section.surface, section.wall])),
        enclosed_area=_enclosed_area(section),
        circulations=constants.shape[1] + parts.submerged,
        unknowns=parts.count,
        interior=Interior(basis, parts.factors, parts.coupling, parts.unknown, parts.place),
    )


def surface_system(section: LiquidSection) -> SurfaceSystem:
    """The liquid's motion on the free surface without dense matrices [theory: sloshing, eq. 9]."""
    parts = _parts(section)
    place = np.full(parts.count + 1, -1, dtype=np.int64)
    place[parts.outside] = np.arange(len(parts.outside))
    rise, bend, give = _differences(section, place[parts.unknown], len(parts.outside))
    return SurfaceSystem(
        section=section,
        gyration=parts.gyration,
        rise=rise,
        bend=bend,
        give=give,
        whole=parts.whole,
        moment=parts.moment,
        steady=parts.steady,
        liquid_area=area_within(section.points, np.concatenate([section.surface, section.wall])),
        enclosed_area=_enclosed_area(section),
        circulations=parts.steady.shape[1] + parts.submerged,
        unknowns=parts.count,
        interior=Interior(None, parts.factors, parts.coupling, parts.unknown, parts.place),
        pieces=parts.pieces,
    )


@dataclass(frozen=True, eq=False)
class _Parts:
    """What both systems are made of; outside: unknowns of the surface, inside: the others."""

    unknown: Indices  #: of each node, -1 where psi = 0, and their number
    count: int
    outside: Indices  #: unknowns on the surface, shape (n,)
    place: Indices  #: of the unknowns in the vector of inside, then surface
    factors: Any  #: of the stiffness inside, None without any; between inside and surface; surface
    coupling: csr_array
    whole: csr_array
    gyration: csr_array  #: C and B on the surface
    surface: csr_array
    moment: Array  #: P
    steady: Array  #: 1 on each closed part of the surface, shape (n, p)
    pieces: int  #: stretches of the surface that no path along it joins
    submerged: int  #: free-standing walls in the liquid

    def schur(self) -> Array:
        """The stiffness that the surface feels, shape (n, n)."""
        whole = self.whole.toarray()
        if self.factors is None:
            return np.asarray(whole)
        for start in range(0, len(whole), _CHUNK):
            part = slice(start, start + _CHUNK)
            whole[:, part] -= self.coupling.T @ self.factors.solve(self.coupling[:, part].toarray())
        return np.asarray(0.5 * (whole + whole.T))


def _parts(section: LiquidSection) -> _Parts:
    """Forms of the liquid, the inside factored."""
    unknown, count = _unknowns(section)
    # Values on nodes from unknowns.
    row = np.flatnonzero(unknown >= 0)
    reduce = csr_array(coo_array((np.ones(row.size), (row, unknown[row])), shape=(unknown.size, count)))
    k, c, b = (csr_array(reduce.T @ form @ reduce) for form in (stiffness(section), *surface_forms(section)))
    on_surface = np.zeros(count, dtype=bool)
    touched = unknown[section.surface.ravel()]
    on_surface[touched[touched >= 0]] = True
    inside, outside = np.flatnonzero(~on_surface), np.flatnonzero(on_surface)
    place = np.empty(count, dtype=np.int64)
    place[np.concatenate([inside, outside])] = np.arange(count)
    factors = None
    if len(inside):
        factors = splu(
            csc_array(k[inside][:, inside]),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
    steady, pieces = _closed_parts(section, unknown, outside)
    return _Parts(
        unknown=unknown,
        count=count,
        outside=outside,
        place=place,
        factors=factors,
        coupling=csr_array(k[inside][:, outside]),
        whole=csr_array(k[outside][:, outside]),
        gyration=csr_array(c[outside][:, outside]),
        surface=csr_array(b[outside][:, outside]),
        moment=np.asarray((moment_of(section) @ reduce)[:, outside]),
        steady=steady,
        pieces=pieces,
        submerged=int(np.count_nonzero(~section.fixed_piece) - np.count_nonzero(_piercing(section))),
    )


def surface_forms(section: LiquidSection) -> tuple[csr_array, csr_array]:
    """C = oint psi_theta v dtheta and B = oint psi_theta v_theta dtheta on the free surface, rows for v.

    Over the nodes [theory: sloshing, eq. 6]; theta, positive with the spin, is interpolated along a side.
    """
    sides = section.surface
    x, y = section.points[sides[:, 0]].T
    u, v = section.points[sides[:, 1]].T
    turn = np.arctan2(x * v - y * u, x * u + y * v)  # below 0
    if section.order == 1:
        first = np.array([[-1.0, 1.0], [-1.0, 1.0]]) / 2.0
        second = np.array([[1.0, -1.0], [-1.0, 1.0]])
    else:
        first = np.array([[-3.0, -1.0, 4.0], [1.0, 3.0, -4.0], [-4.0, 4.0, 0.0]]) / 6.0
        second = np.array([[7.0, 1.0, -8.0], [1.0, 7.0, -8.0], [-8.0, -8.0, 16.0]]) / 3.0
    # The sides run against the angle.
    gyration = np.broadcast_to(-first, (len(sides), *first.shape))
    tension = second / np.abs(turn)[:, None, None]
    shape, width = (len(section.points),) * 2, sides.shape[1]
    rows = np.repeat(sides, width, axis=1).ravel()
    columns = np.tile(sides, (1, width)).ravel()
    c, b = (csr_array(coo_array((m.ravel(), (rows, columns)), shape=shape)) for m in (gyration, tension))
    return c, b


def _differences(
    section: LiquidSection, unknown: Indices, count: int
) -> tuple[csr_array, csr_array, csr_array]:
    """D, W and its inverse with B = D^T W D: differences from node to node along the sides of the surface.

    `unknown`: number on the surface of each node, -1 for those held at 0.
    """
    sides = section.surface
    x, y = section.points[sides[:, 0]].T
    u, v = section.points[sides[:, 1]].T
    turn = np.abs(np.arctan2(x * v - y * u, x * u + y * v))
    if section.order == 1:
        steps, unit = [(0, 1)], np.ones((1, 1))
    else:
        steps, unit = [(0, 2), (2, 1)], np.array([[7.0, -1.0], [-1.0, 7.0]]) / 3.0
    row = np.arange(len(steps) * len(sides)).reshape(len(sides), len(steps))
    entries, rows, columns = [], [], []
    for k, ends in enumerate(steps):
        for end, sign in zip(ends, (-1.0, 1.0), strict=True):
            own = unknown[sides[:, end]]
            held = own >= 0
            entries.append(np.full(int(held.sum()), sign))
            rows.append(row[held, k])
            columns.append(own[held])
    places = (np.concatenate(rows), np.concatenate(columns))
    rise = csr_array(coo_array((np.concatenate(entries), places), shape=(row.size, count)))
    width = len(steps)
    at = (np.repeat(row, width, axis=1).ravel(), np.tile(row, (1, width)).ravel())
    bend, give = (
        csr_array(coo_array((values.ravel(), at), shape=(row.size, row.size)))
        for values in (
            unit / turn[:, None, None],
            np.linalg.inv(unit) * turn[:, None, None],
        )
    )
    return rise, bend, give


def moment_of(section: LiquidSection) -> Array:
    """P = oint (x, y) v_theta dtheta, from the gyration matrix and the nodes' positions, shape (2, N)."""
    gyration, _ = surface_forms(section)
    return np.asarray((gyration.T @ section.points).T)


def _unknowns(section: LiquidSection) -> tuple[Indices, int]:
    """Unknown of each node, -1 on fixed walls; one for each free-standing piece, and their number."""
    unknown = np.full(len(section.points), -1, dtype=np.int64)
    free = np.zeros(len(section.points), dtype=bool)
    free[section.cells] = True
    free[section.wall] = False
    own = np.flatnonzero(free)
    unknown[own] = np.arange(len(own))
    count = len(own)
    for piece in np.flatnonzero(~section.fixed_piece):
        unknown[section.wall[section.wall_piece == piece]] = count
        count += 1
    return unknown, count


def _closed_parts(section: LiquidSection, unknown: Indices, outside: Indices) -> tuple[Array, int]:
    """1 on each closed part of the free surface, shape (n, p), and the stretches of it that nothing joins.

    No side of a closed part leads to a fixed wall. Where psi is constant on all of it the surface stays a
    circle and the flow is a steady vortex, which the condensation leaves out.
    """
    ends = unknown[section.surface[:, :2]]
    count = int(unknown.max()) + 1
    ends = np.where(ends < 0, count, ends)  # one node for all fixed walls
    links = coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(count + 1, count + 1))
    label = connected_components(links, directed=False)[1]
    closed = np.setdiff1d(label[ends[:, 0]], label[[count]])
    free = (ends < count).all(axis=1)
    links = coo_array((np.ones(free.sum()), tuple(ends[free].T)), shape=(count, count))
    stretch = connected_components(links, directed=False)[1]
    touched = ends[ends < count]
    # A node between the ends of a curved side belongs to the part of its side.
    part = label.copy()
    if section.order == 2:
        middle = unknown[section.surface[:, 2]]
        part[middle] = label[ends[:, 0]]
    return (part[outside][:, None] == closed).astype(float), len(np.unique(stretch[touched]))


def _piercing(section: LiquidSection) -> NDArray[np.bool_]:
    """Which free-standing pieces reach the free surface, shape (pieces,)."""
    touches = np.isin(section.wall, section.surface).any(axis=1)
    found = np.zeros(len(section.fixed_piece), dtype=bool)
    found[section.wall_piece[touches]] = True
    return found & ~section.fixed_piece


def area_within(points: Array, sides: Indices) -> float:
    """Area with those sides around it, on the left, m^2."""
    start, end = points[sides[:, 0]], points[sides[:, 1]]
    twice = _cross(start, end)
    if sides.shape[1] == 3:
        bend = points[sides[:, 2]] - 0.5 * (start + end)
        twice = twice + (4.0 / 3.0) * _cross(bend, end - start)
    return 0.5 * float(twice.sum())


def _enclosed_area(section: LiquidSection) -> float:
    """Area of the liquid and of the dry middle; where a wall is dry it is taken to be straight, m^2."""
    liquid = area_within(section.points, np.concatenate([section.surface, section.wall]))
    start, end = section.points[section.surface[:, 0]], section.points[section.surface[:, 1]]
    order = np.argsort(-np.arctan2(end[:, 1], end[:, 0]), kind="stable")
    across = 0.5 * float(_cross(end[order], start[np.roll(order, -1)]).sum())
    return liquid - area_within(section.points, section.surface) - across


def _cross(first: Array, other: Array) -> Array:
    return np.asarray(first[:, 0] * other[:, 1] - first[:, 1] * other[:, 0])
