"""Cracks in a mesh: sides along which cells part, each with nodes of its own."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshes.arrays import Array, Indices
from meshes.errors import InputError
from meshes.liquid_section import SIDES


def open_slits(points: Array, cells: Indices, slits: Indices) -> tuple[Array, Indices]:
    """Part the cells of a mesh along some of its sides.

    A node is doubled where the sides cut its cells into groups: along a slit and where it meets the boundary.
    At a tip inside the mesh the cells stay connected around it, and the node stays one. Where slits cross,
    every group gets a node.

    Parameters
    ----------
    points : nodes, shape (N, 2), m
    cells : node numbers, shape (M, 3), (M, 6), (M, 4) or (M, 9)
    slits : end nodes of the sides to open, shape (K, 2), in either direction

    Returns
    -------
    Points and cells; nodes keep their numbers, copies are added at the end.

    Raises
    ------
    InputError : a slit that is no side between two cells, or one that opens nothing: a single side whose ends
        are both tips in the mesh
    """
    if len(slits) == 0:
        return points, cells
    sides = SIDES[cells.shape[1]]
    nodes = cells[:, sides].reshape(-1, sides.shape[1])
    # The places in `cells` at which each side finds its nodes.
    places = (np.arange(len(cells))[:, None, None] * cells.shape[1] + sides).reshape(nodes.shape)
    ends = np.sort(nodes[:, :2], axis=1)
    order = np.lexsort((ends[:, 1], ends[:, 0]))
    twin = np.all(ends[order[1:]] == ends[order[:-1]], axis=1)
    side, other_side = order[:-1][twin], order[1:][twin]
    key, wanted = _key(ends[side]), np.unique(_key(np.sort(slits, axis=1)))
    cut = np.isin(key, wanted)
    if np.count_nonzero(cut) != len(wanted):
        raise InputError("slits", np.shape(slits), "sides with a cell on either hand")
    kept, kept_other = side[~cut], other_side[~cut]
    # Neighbours run along their common side in opposite directions.
    width = sides.shape[1]
    turned = [1, 0, 2][:width]
    first, second = places[kept].ravel(), places[kept_other][:, turned].ravel()
    links = coo_array((np.ones(first.size), (first, second)), shape=(cells.size, cells.size))
    count, group = connected_components(links, directed=False)
    return _numbered(points, cells, np.asarray(group), int(count), ends[side[cut]])


def _numbered(
    points: Array, cells: Indices, group: Indices, count: int, opened: Indices
) -> tuple[Array, Indices]:
    """Give the first group of places at each node its number, and new numbers to the others."""
    node = np.empty(count, dtype=np.int64)
    node[group] = cells.ravel()
    _, first = np.unique(node, return_index=True)
    extra = np.ones(count, dtype=bool)
    extra[first] = False
    doubled = np.zeros(len(points), dtype=bool)
    doubled[node[extra]] = True
    if not np.all(doubled[opened].any(axis=1)):
        raise InputError("slits", len(opened), "two sides long or more where both ends are in the mesh")
    number = node.copy()
    number[extra] = len(points) + np.arange(np.count_nonzero(extra))
    return np.concatenate([points, points[node[extra]]]), number[group].reshape(cells.shape)


def _key(ends: Indices) -> Indices:
    """One number for each pair of nodes."""
    return np.asarray(ends[:, 0] * np.int64(2**31) + ends[:, 1])
