"""Finite-element integrals of a stream function over liquid and walls: the door of sloshing to scikit-fem."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csr_array, vstack
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

from meshes.arrays import Array, Indices
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
    """Quadrature points on the walls, both sides of a slit.

    Parameters
    ----------
    points : where they are, shape (Q, 2), m
    weights : length of wall each stands for, shape (Q,), m
    along : unit tangent with the liquid on the left, shape (Q, 2)
    slope : psi at the nodes to its derivative along the normal out of the liquid, shape (Q, N), 1/m
    """

    points: Array
    weights: Array
    along: Array
    slope: csr_array


def stiffness(section: LiquidSection) -> csr_array:
    """K = int grad psi . grad v over the liquid [theory: sloshing, eq. 6].

    Parameters
    ----------
    section : the liquid at rest

    Returns
    -------
    Symmetric matrix over the nodes of the mesh, shape (N, N), a pure number.
    """
    basis = CellBasis(*_mesh(section), intorder=_DEGREE[section.cells.shape[1]], disable_doflocs=True)
    raw = BilinearForm(_gradients).assemble(basis).tocoo()
    node = _node_of_unknown(section, basis.element_dofs)
    return csr_array(coo_array((raw.data, (node[raw.row], node[raw.col])), shape=(len(section.points),) * 2))


def wall_points(section: LiquidSection) -> WallPoints:
    """Points on the walls with the slope of the stream function there, eight to a side.

    Parameters
    ----------
    section : the liquid at rest
    """
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
    """Slopes of the stream function at the middles of the cells, u = (d psi/dy, -d psi/dx).

    Parameters
    ----------
    section : the liquid at rest

    Returns
    -------
    psi at the nodes to d psi/dx and to d psi/dy, each of shape (M, N), 1/m.
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
