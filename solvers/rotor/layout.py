"""Where the mounts of a tub sit, and what of its motions they couple; many layouts at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.tub import Mount, Tub, displacement

COORDINATES = ("x", "y", "z", "alpha", "beta", "gamma")
PAIRS = tuple((i, j) for i in range(6) for j in range(i + 1, 6))
_ROWS, _COLUMNS = np.array(PAIRS).T


@dataclass(frozen=True)
class Mounts:
    """Springs or dampers of m layouts with n mounts each."""

    position: Array  #: of each from the tub's centre of mass, m, shape (m, n, 3)
    direction: Array  #: unit vectors, shape (m, n, 3)
    coefficient: Array  #: along the direction, N/m or N s/m, shape (n,)
    along_axes: Array  #: along x, y, z, N/m or N s/m, shape (n, 3)

    def __post_init__(self) -> None:
        count = self.coefficient.size
        if self.position.ndim != 3 or self.position.shape[1:] != (count, 3):
            raise InputError("position", self.position.shape, f"of shape (m, {count}, 3)")
        if self.direction.shape != self.position.shape or self.along_axes.shape != (count, 3):
            raise InputError("direction", self.direction.shape, f"of shape {self.position.shape}")

    @classmethod
    def of(cls, mounts: Sequence[Mount]) -> Mounts:
        """One layout of mounts that are given one by one."""
        way = np.array([mount.direction for mount in mounts], dtype=float).reshape(-1, 3)
        return cls(
            np.array([mount.position for mount in mounts], dtype=float).reshape(1, -1, 3),
            (way / np.linalg.norm(way, axis=1, keepdims=True))[None],
            np.array([mount.coefficient for mount in mounts], dtype=float),
            np.array([mount.along_axes for mount in mounts], dtype=float).reshape(-1, 3),
        )

    def matrix(self, origin: Array) -> Array:
        """Stiffness or damping for the motion of a point and the turns about it [theory: rotor, eq. 21].

        Sum of J^T c J, shape (m, 6, 6); the point from the tub's centre of mass, m.
        """
        along = np.einsum("n,mni,mnj->mnij", self.coefficient, self.direction, self.direction)
        along = along + self.along_axes[None, :, :, None] * np.eye(3)
        moving = displacement(self.position - origin)
        return np.asarray(np.einsum("mnki,mnkl,mnlj->mij", moving, along, moving))


def centre_of_mass(rotor: Tub) -> Array:
    """Centre of mass of tub and drum from that of the tub, m, shape (3,)."""
    return np.array(rotor.drum_position) * rotor.drum_mass / rotor.mass


def mass_matrix(rotor: Tub, origin: Array) -> Array:
    """Mass matrix for the motion of a point and the turns about it, shape (6, 6) [theory: rotor, eq. 22].

    The point from the tub's centre of mass, m.
    """
    # The tub's centre moves with the point and turns about it.
    tub, drum = displacement(-origin), displacement(np.array(rotor.drum_position) - origin)
    across, along = rotor.drum_transverse_inertia, rotor.drum_polar_inertia
    turning = np.diag([0.0, 0.0, 0.0, *rotor.tub_inertia]) + np.diag([0.0, 0.0, 0.0, across, along, across])
    return np.asarray(rotor.tub_mass * (tub.T @ tub) + rotor.drum_mass * (drum.T @ drum) + turning)


def couplings(matrix: Array) -> Array:
    """Terms off the diagonal over the root of those on it, in the order of `PAIRS` [theory: rotor, eq. 36].

    Of symmetric matrices without negative eigenvalues, shape (..., 6, 6): -1 to 1, 0 where a diagonal term
    is, shape (..., 15).

    Examples
    --------
    >>> spring = Mount((0.0, 0.0, 0.1), along_axes=(100.0, 100.0, 100.0))
    >>> found = couplings(Mounts.of([spring]).matrix(np.zeros(3)))[0]
    >>> print([f"{COORDINATES[i]}-{COORDINATES[j]}" for (i, j), c in zip(PAIRS, found) if c])
    ['x-beta', 'y-alpha']
    """
    diagonal = np.maximum(np.diagonal(matrix, axis1=-2, axis2=-1), 0.0)
    size = np.sqrt(diagonal[..., _ROWS] * diagonal[..., _COLUMNS])
    found: Array = np.zeros_like(size)
    np.divide(matrix[..., _ROWS, _COLUMNS], size, out=found, where=size > 0.0)
    return found


def natural_frequencies(stiffness: Array, mass: Array) -> Array:
    """Natural frequencies at rest without damping, rising, rad/s, shape (m, 6)."""
    root = np.linalg.inv(np.linalg.cholesky(mass))
    squared = np.linalg.eigvalsh(root @ stiffness @ root.T)
    return np.asarray(np.sqrt(np.maximum(squared, 0.0)))


def sag(stiffness: Array, weight: Array) -> Array:
    """How far the point sinks under a weight in it, and how far the tub turns with it.

    Distance along the force (N, shape (3,)), m, and largest turn, rad, shape (2, m), from stiffness (m, 6,
    6); infinite where nothing holds the tub.
    """
    force = np.concatenate([weight, np.zeros(3)])
    held = np.linalg.eigvalsh(stiffness)
    firm = held[:, 0] > 1e-12 * held[:, -1]
    found = np.full((2, stiffness.shape[0]), np.inf)
    if firm.any():
        moved = np.linalg.solve(stiffness[firm], np.broadcast_to(force[:, None], (int(firm.sum()), 6, 1)))[
            ..., 0
        ]
        found[0, firm] = moved[:, :3] @ weight / np.linalg.norm(weight)
        found[1, firm] = np.abs(moved[:, 3:]).max(axis=1)
    return found
