"""Natural frequencies of a structure, all of a band, and their shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Index
from meshes.errors import InputError
from solvers.roots import bracketed_root
from solvers.rotor.shaft.structure import (
    Nodes,
    Structure,
    dynamic_stiffness,
    motion_at,
    nodes_up_to,
    scales,
)

_ENOUGH = 1e-13  # relative width of a bracket; the eigenvalues are known no better


@dataclass(frozen=True)
class Mode:
    """A natural motion without damping."""

    frequency: float  #: rad/s
    #: for each beam places from its first station, m, and deflections, the largest of all being 1
    along: tuple[tuple[Array, Array], ...]
    stations: tuple[Array, ...]  #: deflection at the stations of each beam


def natural_frequencies(structure: Structure, low: float, high: float, spin: float = 0.0) -> Array:
    """All natural frequencies between two others, rad/s, rising, without dampers [theory: spindle, eq. 11].

    The k-th eigenvalue of the dynamic stiffness passes zero once, at the k-th of them: none is missed, two of
    one frequency count twice. Of forward whirl, of backward whirl where `spin` is negative.
    """
    return _found(structure, low, high, spin)[0]


def modes(
    structure: Structure, low: float, high: float, spin: float = 0.0, least: int = 8
) -> tuple[Mode, ...]:
    """Natural frequencies of a band with their shapes.

    The shape is known at the ends of at least `least` pieces of each section.
    """
    frequencies, order = _found(structure, low, high, spin)
    nodes = nodes_up_to(structure, high, spin, least)
    return tuple(
        _mode(structure, nodes, float(frequency), int(k), spin)
        for frequency, k in zip(frequencies, order, strict=True)
    )


def _mode(structure: Structure, nodes: Nodes, frequency: float, order: int, spin: float) -> Mode:
    """The shape of one natural frequency: the eigenvector of the eigenvalue that passes zero there."""
    matrices, size = _scaled(structure, nodes, np.array([frequency]), spin)
    motion = size * np.linalg.eigh(matrices[0])[1][:, order]
    along = motion_at(structure, nodes, motion)
    largest = max((deflection for _, deflection in along), key=lambda part: float(np.abs(part).max()))
    unit = float(largest[np.abs(largest).argmax()])
    stations = tuple(
        np.array([motion[2 * nodes.of((beam, k))] for k in range(len(sections) + 1)]) / unit
        for beam, sections in enumerate(structure.beams)
    )
    return Mode(frequency, tuple((place, deflection / unit) for place, deflection in along), stations)


def _found(structure: Structure, low: float, high: float, spin: float) -> tuple[Array, Index]:
    """The frequencies, and which eigenvalue passes zero at each."""
    if not (np.isfinite([low, high]).all() and 0.0 < low <= high):
        raise InputError("band", (low, high), "two finite numbers above 0, the second at least the first")
    nodes = nodes_up_to(structure, high, spin)
    ends = np.sum(_eigenvalues(structure, nodes, np.array([low, high]), spin) < 0.0, axis=-1)
    order: Index = np.arange(ends[0], ends[1])

    def eigenvalue(frequency: Array, which: Index) -> Array:
        every = _eigenvalues(structure, nodes, frequency, spin)
        return np.asarray(every[np.arange(frequency.size), order[which]])

    start, end = np.full(order.size, low), np.full(order.size, high)
    found, sure = bracketed_root(eigenvalue, start, end, _ENOUGH)
    if not sure.all():
        raise InputError("structure", found[~sure].tolist(), "one whose natural frequencies can be bracketed")
    return found, order


def _eigenvalues(structure: Structure, nodes: Nodes, frequency: Array, spin: float) -> Array:
    """Eigenvalues of the scaled dynamic stiffness, rising, shape (n, 2 nodes)."""
    return np.asarray(np.linalg.eigvalsh(_scaled(structure, nodes, frequency, spin)[0]))


def _scaled(structure: Structure, nodes: Nodes, frequency: Array, spin: float) -> tuple[Array, Array]:
    """Dynamic stiffness without damping, rows and columns of one size, and the factors that make it so.

    The factors are those at rest: the same at every frequency, so that eigenvalues keep falling.
    """
    size = scales(dynamic_stiffness(structure, nodes, np.zeros(1)))
    matrices = dynamic_stiffness(structure, nodes, frequency, spin, damped=False).real
    return np.asarray(matrices * size[:, None] * size), size
