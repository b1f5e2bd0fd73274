"""Linear vibration of a rotor without liquid: modes, unbalance response, orbits, critical speeds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.system import RotorSystem

_ROUNDING = 1e-14  # of the fastest eigenvalue, that another's real part is known to


@dataclass(frozen=True)
class Modes:
    """Free vibration q = Re(shape e^{eigenvalue t}) at s spin speeds; n coordinates, n modes."""

    spin: Array  #: Omega, rad/s, shape (s,)
    #: with imaginary parts of 0 or above, rising; of the two of an overdamped mode the slower one, 1/s, shape
    #: (s, n)
    eigenvalue: Complex
    shape: Complex  #: largest component 1, shape (s, n coordinates, n modes)

    @property
    def frequency(self) -> Array:
        """Damped natural frequencies, rad/s, 0 where overdamped, shape (s, n)."""
        return np.asarray(self.eigenvalue.imag)

    @property
    def damping_ratio(self) -> Array:
        """-Re/|eigenvalue|, 1 where overdamped, 0 for a body without support, shape (s, n).

        A real part that rounding alone may have left is none.
        """
        size = np.abs(self.eigenvalue)
        known = np.abs(self.eigenvalue.real) > _ROUNDING * size.max(axis=1, keepdims=True, initial=0.0)
        return np.divide(-self.eigenvalue.real, size, out=np.zeros(size.shape), where=known)


@dataclass(frozen=True)
class Orbit:
    """Motion of the axis in one plane, forward e^{i Omega t} + backward e^{-i Omega t}."""

    forward: Complex  #: complex amplitudes, m, shape (...,)
    backward: Complex

    @property
    def amplitude(self) -> Array:
        """Largest distance from the undisturbed axis: the semi-major axis of the ellipse, m, shape (...,)."""
        return np.asarray(np.abs(self.forward) + np.abs(self.backward))


def modes(system: RotorSystem, spin: ArrayLike = 0.0, *, damped: bool = True) -> Modes:
    """Natural frequencies and mode shapes at spin speeds [theory: rotor, eq. 24]."""
    omega = np.atleast_1d(np.asarray(spin, dtype=float)).reshape(-1)
    if not np.all(np.isfinite(omega)):
        raise InputError("spin", spin, "finite numbers")
    n = len(system.coordinates)
    scale = _scale(system)
    damping = (system.damping if damped else 0.0) + omega[:, None, None] * system.gyroscopic
    state = np.zeros((omega.size, 2 * n, 2 * n))
    state[:, :n, n:] = np.eye(n)
    state[:, n:, :n] = -_per_mass(system, system.stiffness)
    state[:, n:, n:] = -np.linalg.solve(system.mass, damping)
    # In coordinates of one dimension, or turns would count for less than displacements.
    state *= np.tile(scale, 2)[:, None] / np.tile(scale, 2)
    value, vector = np.linalg.eig(state)
    value = _without_rounding(value)
    order = np.lexsort((-value.real, -value.imag), axis=-1)[:, :n][:, ::-1]
    eigenvalue = np.take_along_axis(value, order, axis=1)
    shape = np.take_along_axis(vector[:, :n] / scale[:, None], order[:, None, :], axis=2)
    largest = np.take_along_axis(shape, np.abs(shape * scale[:, None]).argmax(axis=1)[:, None, :], axis=1)
    return Modes(omega, np.asarray(eigenvalue, dtype=complex), np.asarray(shape / largest, dtype=complex))


FREE = 1e-13  # square of a natural frequency over the largest one: rounding, so that nothing holds the motion
_STILL = 1e-6  # of the axis' largest motion, that is rounding


def free_motions(system: RotorSystem) -> Array:
    """Shapes of motions that nothing holds, of unit kinetic energy, shape (n, k)."""
    from scipy.linalg import eigh

    square, shapes = eigh(system.stiffness, system.mass)
    loose = square < FREE * square.max() if square.max() > 0.0 else np.ones(square.size, dtype=bool)
    return np.asarray(shapes[:, loose])


def axis_is_free(system: RotorSystem) -> bool:
    """A motion that nothing holds moves the spin axis sideways: unbalance and liquid drive it."""
    from scipy.linalg import eigh

    every, free = eigh(system.stiffness, system.mass)[1], free_motions(system)
    return any(
        np.linalg.norm(part @ free) > _STILL * np.linalg.norm(part @ every)
        for part in (system.centre, system.lean)
    )


def _without_rounding(value: Complex) -> Complex:
    """Eigenvalues with 0 for parts that are rounding: of a free body, of equal overdamped modes."""
    size = np.abs(value)
    # The twofold 0 of a free body comes out as the square root of rounding.
    clean = np.where(size > 1e-7 * size.max(axis=-1, keepdims=True), value, 0.0)
    return np.asarray(clean.real + 1j * np.where(np.abs(clean.imag) > 1e-9 * size, clean.imag, 0.0))


def _scale(system: RotorSystem) -> Array:
    """Square roots of the coordinates' inertias over a mass: lengths that turns are multiplied by, (n,)."""
    inertia = np.diag(system.mass)
    return np.asarray(np.sqrt(inertia / inertia.max()))


def _per_mass(system: RotorSystem, matrix: Array) -> Array:
    return np.asarray(np.linalg.solve(system.mass, matrix))


def dynamic_stiffness(system: RotorSystem, speed: Array) -> Complex:
    """K - Omega^2 M + i Omega (C + Omega G), N/m and alike, shape (s, n, n) [theory: rotor, eq. 25]."""
    omega = np.asarray(speed, dtype=float)[:, None, None]
    real = system.stiffness - np.square(omega) * system.mass
    return np.asarray(real + 1j * omega * (system.damping + omega * system.gyroscopic), dtype=complex)


def unbalance_response(system: RotorSystem, speed: ArrayLike) -> Complex:
    """Steady answer q = Re(answer e^{i Omega t}) to the unbalance at constant speed [theory: rotor, eq. 25].

    Complex amplitudes of the coordinates, shape (s, n); infinite where an undamped rotor runs exactly at a
    critical speed.
    """
    omega = np.atleast_1d(np.asarray(speed, dtype=float))
    if omega.ndim != 1 or not np.all(np.isfinite(omega)):
        raise InputError("speed", speed, "a list of finite numbers")
    force = np.square(omega)[:, None] * system.unbalance
    return solve_each(dynamic_stiffness(system, omega), force)


def solve_each(matrix: Complex, right: Complex) -> Complex:
    """Solution of each of s linear systems, shape (s, n); infinite where its matrix is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        out = np.full(right.shape, complex(np.inf, 0.0))
        for k in range(len(matrix)):
            try:
                out[k] = np.linalg.solve(matrix[k], right[k])
            except np.linalg.LinAlgError:
                continue
        return out


def orbit(system: RotorSystem, answer: Complex, position: float) -> Orbit:
    """Orbit of the axis at a position for q = Re(answer e^{i Omega t}) [theory: rotor, eq. 26].

    `forward` infinite where the answer is.
    """
    bounded = np.asarray(np.isfinite(answer).all(axis=-1))
    first, second = np.moveaxis(np.where(bounded[..., None], answer, 0.0) @ system.at(position).T, -1, 0)
    forward, backward = 0.5 * (first + 1j * second), 0.5 * np.conj(first - 1j * second)
    none = complex(np.inf, 0.0)
    return Orbit(np.where(bounded, forward, none), np.where(bounded, backward, 0.0))


def whirl_direction(system: RotorSystem, shape: Complex) -> Array:
    """Sense in which the axis goes round, from -1, backward circles, to 1, forward ones.

    (|f|^2 - |b|^2)/(|f|^2 + |b|^2), f and b summed over the displacement of the axis and its lean, the latter
    times the length at which an impulse moves the axis as much by turning as by shifting the rotor. 0 for
    straight lines and where the axis does not move.
    """
    forward, backward = np.zeros(shape.shape[:-1]), np.zeros(shape.shape[:-1])
    shift, turn = (
        np.trace(part @ np.linalg.solve(system.mass, part.T)) for part in (system.centre, system.lean)
    )
    length = shift / turn if turn > 0.0 else 0.0
    for part, weight in ((system.centre, 1.0), (system.lean, length)):
        first, second = np.moveaxis(shape @ part.T, -1, 0)
        forward += weight * np.square(np.abs(first + 1j * second))
        backward += weight * np.square(np.abs(first - 1j * second))
    total = forward + backward
    # Shapes are of order 1; what is left of rounding has no sense.
    moves = total > 1e-20 * np.square(np.abs(shape)).sum(axis=-1)
    return np.divide(forward - backward, total, out=np.zeros(total.shape), where=moves)


def critical_speeds(system: RotorSystem, added: Complex | None = None) -> tuple[Array, Complex]:
    """Speeds at which the undamped rotor vibrates freely once a turn [theory: rotor, eq. 27].

    Rising, rad/s, shape (c,), and complex shapes (c, n). `added` is the Hermitian mass matrix of what moves
    with the rotor at the speed of its spin.
    """
    from scipy.linalg import eig

    scale = _scale(system)
    weight = scale[:, None] * scale
    stiffest, heaviest = np.abs(system.stiffness / weight).max(), np.diag(system.mass).max()
    if stiffest == 0.0:
        return np.zeros(0), np.zeros((0, scale.size), dtype=complex)
    inertia = system.mass - 1j * system.gyroscopic + (0.0 if added is None else added)
    squared, vector = eig(
        system.stiffness / (weight * stiffest), inertia / (weight * heaviest), homogeneous_eigvals=True
    )
    above, below = squared
    finite = np.asarray(np.abs(below) > 1e-12 * np.abs(above))
    value = np.divide(above, below, out=np.zeros_like(above), where=finite)
    # Quotients of Hermitian forms are real; those at 0 are motions without a spring, negative ones discs
    # that their own spin holds up.
    held = np.asarray(finite & (value.real > 1e-10) & (np.abs(value.imag) <= 1e-6 * np.abs(value)))
    speed = np.sqrt(value.real[held] * stiffest / heaviest)
    order = np.argsort(speed)
    return np.asarray(speed[order]), np.asarray((vector[:, held] / scale[:, None]).T[order], dtype=complex)
