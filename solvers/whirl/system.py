"""Whirl modes of any rotor with liquid layers in any planes, with linear friction.

Coordinates are the rotor's and two for each layer, the offset of its liquid from the axis, all real and in
the standing frame; modes go as e^{lambda t}.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from fluid.whirl import Layer, steady_rate
from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.system import RotorSystem

_EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class CoupledMatrices:
    """M z'' + C z' + K z = 0 at n spin speeds, z the rotor's coordinates and (dx, dy) of each layer."""

    mass: Array  #: symmetric, positive definite, shape (N, N)
    damping: Array  #: with gyroscopic and circulatory parts, shape (n, N, N)
    stiffness: Array

    def at(self, which: Index) -> CoupledMatrices:
        """Matrices at some speeds, shape (k,)."""
        return CoupledMatrices(self.mass, self.damping[which], self.stiffness[which])


def coupled_matrices(
    system: RotorSystem, layers: Sequence[tuple[float, Layer]], speed: Array
) -> CoupledMatrices:
    """Rotor and layers with linear friction as one linear system [theory: whirl, eq. 7].

    Layers with their planes, m; liquid without a free surface is part of the rotor's mass.
    """
    count, spin = len(system.coordinates), speed[:, None, None]
    size = count + 2 * len(layers)
    mass = np.zeros((size, size))
    damping, stiffness = np.zeros((2, speed.size, size, size))
    mass[:count, :count] = system.mass
    damping[:, :count, :count] = system.damping + spin * system.gyroscopic
    stiffness[:, :count, :count] = system.stiffness
    turn, unit = np.array([[0.0, 1.0], [-1.0, 0.0]]), np.eye(2)
    for j, (plane, layer) in enumerate(layers):
        own, at = slice(count + 2 * j, count + 2 * j + 2), system.at(plane)
        t, inertia = layer.layer_tanh, layer.mass / (0.5 * (1.0 - layer.layer_tanh))
        # Of a complex rate the second part acts across the velocity.
        steady = steady_rate(layer, spin)
        drag = steady.real * unit - steady.imag * turn
        mass[:count, :count] += layer.mass * at.T @ at
        mass[own, :count], mass[:count, own] = layer.mass * at, layer.mass * at.T
        mass[own, own] = inertia * unit
        damping[:, own, own] = inertia * (drag + 2.0 * (1.0 + t) * spin * turn)
        stiffness[:, own, own] = inertia * (spin * drag @ turn - (1.0 + t) * np.square(spin) * unit)
    return CoupledMatrices(mass, damping, stiffness)


@dataclass(frozen=True)
class SystemModes:
    """Modes of a rotor with layers at n spin speeds."""

    root: Complex  #: lambda, 1/s, m of them and with each its conjugate, shape (n, m)
    #: 1 where the larger of the two circles that make up the whirl goes round as e^{i Im(lambda) t}, -1 where
    #: it goes the other way, shape (n, m)
    sense: Array
    rounding: Array  #: how far rounding may have moved each, 1/s, shape (n, m)
    found: Flags  #: False where the iteration did not settle, shape (n, m)
    #: no mode is missing that grows more than the one of those found that grows most, shape (n,)
    complete: Flags

    def at(self, which: Index) -> SystemModes:
        """Modes at some speeds."""
        return SystemModes(*(getattr(self, part.name)[which] for part in fields(self)))

    def widened(self, width: int, gone: float) -> SystemModes:
        """Modes with others not found appended, up to `width` at each speed, lambda there `gone`."""
        more = ((0, 0), (0, width - self.root.shape[1]))
        if width == self.root.shape[1]:
            return self
        return SystemModes(
            np.pad(self.root, more, constant_values=gone),
            np.pad(self.sense, more, constant_values=1.0),
            np.pad(self.rounding, more),
            np.pad(self.found, more),
            self.complete,
        )

    def replaced(self, which: Index, others: SystemModes, gone: float) -> SystemModes:
        """Modes with those at some speeds in place of its own, lambda `gone` where one lacks a mode."""
        width = max(self.root.shape[1], others.root.shape[1])
        kept = np.setdiff1d(np.arange(len(self.root)), which)
        found = joined([self.at(kept).widened(width, gone), others.widened(width, gone)])
        return found.at(np.argsort(np.concatenate([kept, which])))


def linear_modes(matrices: CoupledMatrices, circles: Array) -> SystemModes:
    """All modes with linear friction; `circles` (2 c, N), in pairs across the axis, tell their sense.

    Unit masses and velocities over a common frequency make the matrix as even as it can be; an eigenvalue
    moves by the rounding of its entries times its condition number [theory: whirl, eq. 15].
    """
    inverse, state = _state(matrices)
    size = len(inverse)
    values, right = np.linalg.eig(state)
    left = np.linalg.pinv(right)
    condition = np.linalg.norm(left, axis=2) * np.linalg.norm(right, axis=1)
    scale = np.linalg.norm(state, axis=(1, 2))
    rounding = 2.0 * _EPS * np.sqrt(2.0 * size) * scale[:, None] * np.minimum(condition, 1.0 / _EPS)
    moved = (circles @ inverse.T) @ right[:, :size]
    along, against = (
        np.square(np.abs(moved[:, ::2] + turn * moved[:, 1::2])).sum(axis=1) for turn in (1j, -1j)
    )
    found = np.ones(values.shape, dtype=bool)
    return SystemModes(values, sense_of(along, against), rounding, found, np.ones(len(values), dtype=bool))


def linear_roots(matrices: CoupledMatrices) -> Complex:
    """lambda of `linear_modes` alone, 1/s, shape (n, 2 N)."""
    return np.asarray(np.linalg.eigvals(_state(matrices)[1]), dtype=complex)


def _state(matrices: CoupledMatrices) -> tuple[Array, Array]:
    """What makes the masses units, shape (N, N), and the matrix of the first order, shape (n, 2 N, 2 N)."""
    inverse = np.linalg.inv(np.linalg.cholesky(matrices.mass))
    stiffness, damping = (inverse @ matrix @ inverse.T for matrix in (matrices.stiffness, matrices.damping))
    size = len(inverse)
    unit = np.sqrt(np.abs(stiffness).max(axis=(1, 2)))
    unit = np.maximum(unit, np.abs(damping).max(axis=(1, 2)) * 1e-3)[:, None, None]
    state = np.zeros((len(stiffness), 2 * size, 2 * size))
    state[:, :size, size:] = np.eye(size) * unit
    state[:, size:, :size] = -stiffness / unit
    state[:, size:, size:] = -damping
    return inverse, state


def joined(parts: Sequence[SystemModes]) -> SystemModes:
    """Modes at the speeds of several blocks, each with as many, one block after the other."""
    names = [part.name for part in fields(SystemModes)]
    return SystemModes(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def sense_of(along: Array, against: Array) -> Array:
    """1 where a mode goes round as e^{i Im(lambda) t}, -1 where it goes the other way, shape (n, m).

    From squared sizes of its circles; 1 for modes that move no axis.
    """
    least = 1e-18 * (along + against).max(axis=1, keepdims=True, initial=0.0)
    return np.where(along + least >= against, 1.0, -1.0)


def circles_of(system: RotorSystem, layers: Sequence[tuple[float, Layer]]) -> Array:
    """Displacements of the axis at each layer, or at the rotor's origin without any, and the offsets."""
    count, size = len(system.coordinates), len(system.coordinates) + 2 * len(layers)
    axes = [system.at(plane) for plane, _ in layers] or [system.centre]
    shown = np.zeros((2 * len(axes), size))
    shown[:, :count] = np.concatenate(axes)
    return np.concatenate([shown, np.eye(size)[count:]])
