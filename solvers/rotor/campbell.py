"""Campbell diagram: natural frequencies followed over the spin speed, and where they meet it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.arrays import Array, Index
from meshes.errors import InputError
from meshes.quantity import Q
from solvers.roots import bracketed_root
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import modes, whirl_direction

_BOTH = ("spin", "mode")


@dataclass(frozen=True)
class Campbell:
    """Modes over spin speed, each in its own column; s speeds, n modes, c crossings."""

    spin: Annotated[Array, Q("rad s-1", "spin speed", "of the Campbell diagram", ("spin",), json=False)]
    #: 0 where overdamped
    frequency: Annotated[
        Array,
        Q(
            *("rad s-1", "natural frequency", "damped, without liquid", _BOTH),
            key="campbell_frequency",
            json=False,
        ),
    ]
    damping_ratio: Annotated[
        Array,
        Q("1", "damping ratio", "without liquid", _BOTH, key="campbell_damping_ratio", json=False),
    ]
    direction: Annotated[
        Array,
        Q(
            *("1", "direction of the whirl", "-1 against the spin to 1 with it", _BOTH),
            key="campbell_direction",
            json=False,
        ),
    ]
    crossing: Array  #: speeds at which a natural frequency equals the spin, rising, rad/s, shape (c,)
    crossing_direction: Array  #: direction of the whirl there, shape (c,)
    converged: NDArray[np.bool_]  #: each crossing was found to rounding, shape (c,)


def campbell(system: RotorSystem, spin: ArrayLike) -> Campbell:
    """Natural frequencies over the spin speed and their crossings with it [theory: rotor, eq. 24].

    At rising speeds, rad/s; modes are followed by likeness of shape and nearness of frequency.
    """
    omega = np.array(spin, dtype=float).reshape(-1)
    if not (np.all(np.isfinite(omega)) and np.all(omega >= 0.0) and np.all(np.diff(omega) > 0.0)):
        raise InputError("spin", omega.tolist(), "rising finite numbers, 0 or above")
    found = modes(system, omega)
    order = _followed(found.eigenvalue.imag, found.shape, system)
    shape = np.take_along_axis(found.shape, order[:, None, :], axis=2)
    frequency, ratio = (np.take_along_axis(x, order, axis=1) for x in (found.frequency, found.damping_ratio))
    gap = frequency - omega[:, None]
    # A crossing at a grid point belongs to the interval that ends there.
    row, column = np.nonzero(
        (np.sign(gap[:-1]) * np.sign(gap[1:]) < 0.0) | ((gap[1:] == 0.0) & (gap[:-1] != 0.0))
    )
    crossing, converged, direction = _refined(system, omega, frequency, shape, row, column)
    rank = np.argsort(crossing, kind="stable")
    return Campbell(
        spin=omega,
        frequency=frequency,
        damping_ratio=ratio,
        direction=whirl_direction(system, np.moveaxis(shape, 1, 2)),
        crossing=crossing[rank],
        crossing_direction=direction[rank],
        converged=converged[rank],
    )


def _likeness(system: RotorSystem, first: NDArray[np.complex128], other: NDArray[np.complex128]) -> Array:
    """Modal assurance |a^H M b|^2/(a^H M a b^H M b) of the columns of two tables, shape (n, n)."""
    cross = np.abs(np.conj(first).T @ system.mass @ other) ** 2
    sizes = [np.einsum("ik,ij,jk->k", np.conj(x), system.mass, x).real for x in (first, other)]
    return np.asarray(cross / (sizes[0][:, None] * sizes[1]))


def _followed(frequency: Array, shape: NDArray[np.complex128], system: RotorSystem) -> Index:
    """Order of the modes at each speed that continues those of the speed before, shape (s, n)."""
    from scipy.optimize import linear_sum_assignment

    order = np.tile(np.arange(frequency.shape[1]), (frequency.shape[0], 1))
    for k in range(1, frequency.shape[0]):
        before = order[k - 1]
        likeness = _likeness(system, shape[k - 1][:, before], shape[k])
        apart = np.abs(frequency[k - 1][before][:, None] - frequency[k])
        order[k] = linear_sum_assignment(apart / max(apart.max(), 1e-300) - likeness)[1]
    return order


def _refined(
    system: RotorSystem,
    omega: Array,
    frequency: Array,
    shape: NDArray[np.complex128],
    row: Index,
    column: Index,
) -> tuple[Array, NDArray[np.bool_], Array]:
    """Crossings between grid points: speed, found to rounding or not, direction of the whirl."""

    def mode(speed: Array, which: Index) -> tuple[Array, NDArray[np.complex128]]:
        """Frequency and shape of the mode that lies on the line followed, shapes (m,) and (m, n)."""
        found = modes(system, speed)
        k, j = row[which], column[which]
        part = (speed - omega[k]) / (omega[k + 1] - omega[k])
        expected = frequency[k, j] + part * (frequency[k + 1, j] - frequency[k, j])
        apart = np.abs(found.frequency - expected[:, None])
        like = np.empty(apart.shape)
        for i, (a, b) in enumerate(zip(k, j, strict=True)):
            like[i] = _likeness(system, shape[a][:, [b]], found.shape[i])[0]
        best = np.argmin(apart / np.maximum(apart.max(axis=1, keepdims=True), 1e-300) - like, axis=1)
        at = np.arange(speed.size)
        return found.frequency[at, best], found.shape[at, :, best]

    def gap(speed: Array, which: Index) -> Array:
        return mode(speed, which)[0] - speed

    crossing, converged = bracketed_root(gap, omega[row], omega[row + 1], relative=1e-12)
    return crossing, converged, whirl_direction(system, mode(crossing, np.arange(crossing.size))[1])
