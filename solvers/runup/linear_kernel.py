"""Rotor and linear layers through time by the trapezium [theory: coupling, eq. 11-13].

SI units. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from meshes.arrays import Array
from solvers.layer.face_flux import COMPILED
from solvers.runup.kernel import motor_torque, solve
from solvers.runup.state import DRIVE, FRICTION, GRAVITY, MOTOR, STEPS, SUPPORT, UNBALANCE

_jit: Any = njit(**COMPILED)


# Columns of a layer: mass, curvature, friction rate, power of the spin that it goes with, moment of inertia.
MASS, CURVATURE, RATE, POWER, INERTIA = range(5)


class LinearMachine(NamedTuple):
    """Rotor and l linear layers; n coordinates, N = n + 2 l.

    Parameters
    ----------
    matrices : M, C, G, K of the rotor, shape (4, n, n)
    unbalance : U, complex, shape (n,)
    planes : displacement of each layer's axis for unit coordinates, shape (l, 2, n)
    layers : properties, shape (l, 5)
    active : 1 for a layer, 0 for liquid that moves with the drum as a mass, shape (l,)
    gravity : across the axis, shape (2,)
    drive : rate of the spin, moment of inertia with a motor, shape (2,)
    curve : the motor's, shape (2, k)
    place, rate : rotor's coordinates and the layers' offsets, two parts each, and their rates, shape (N,)
    turning : spin, angle, time, shape (3,)
    carried : rotation of each layer as a whole, rad/s, shape (l,)
    sums : tallies of `solvers.runup.state`
    left, change, swing : scratch, shapes (N, N), (N,), (n,)
    """

    matrices: Array
    unbalance: NDArray[np.complex128]
    planes: Array
    layers: Array
    active: Array
    gravity: Array
    drive: Array
    curve: Array
    place: Array
    rate: Array
    turning: Array
    carried: Array
    sums: Array
    left: Array
    change: Array
    swing: Array


@_jit
def _assemble(m, j, spin, before, after, dt):
    """Rows and columns of a layer [theory: coupling, eq. 11]."""
    n = m.unbalance.size
    mass, kappa, b = m.layers[j, MASS], m.layers[j, CURVATURE], m.planes[j]
    friction = m.layers[j, RATE] * spin ** m.layers[j, POWER] * (1.0 + kappa)
    whole = 0.5 * (before + after)
    for i in range(n):
        for k in range(n):
            m.left[i, k] += mass * (b[0, i] * b[0, k] + b[1, i] * b[1, k])
    for part in range(2):
        row = n + 2 * j + part
        m.left[row, row] = 1.0
        m.change[row] = 0.0
        if m.active[j] == 0.0:
            continue
        other, sign = n + 2 * j + 1 - part, 1.0 - 2.0 * part
        # Multiplication by -i takes (x, y) to (y, -x).
        coriolis, swirl = (
            4.0 * kappa * whole * sign,
            (whole * friction + 2.0 * kappa * (after - before) / dt) * sign,
        )
        centrifugal = -2.0 * kappa * whole * whole
        m.left[row, row] = mass * (1.0 + kappa + 0.5 * dt * friction + 0.25 * dt * dt * centrifugal)
        m.left[row, other] = mass * (0.5 * dt * coriolis + 0.25 * dt * dt * swirl)
        here, there = m.place[row] + 0.5 * dt * m.rate[row], m.place[other] + 0.5 * dt * m.rate[other]
        forces = friction * m.rate[row] + coriolis * m.rate[other] + centrifugal * here + swirl * there
        m.change[row] = dt * mass * (m.gravity[part] - forces)
        for i in range(n):
            m.left[row, i] = mass * b[part, i]
            m.left[i, row] = mass * b[part, i]


@_jit
def _rotor_rows(m, spin, first, last, spins, dt):
    """Rows of the rotor, as in the nonlinear step [theory: coupling, eq. 5]."""
    n = m.unbalance.size
    for i in range(n):
        m.swing[i] = spins[0] * (m.unbalance[i] * first).imag - spins[1] * (m.unbalance[i] * last).imag
        m.change[i] = -m.swing[i]
        for k in range(n):
            damping = m.matrices[1, i, k] + spin * m.matrices[2, i, k]
            stiffness = m.matrices[3, i, k]
            m.left[i, k] = m.matrices[0, i, k] + 0.5 * dt * damping + 0.25 * dt * dt * stiffness
            m.change[i] -= dt * (damping * m.rate[k] + stiffness * (m.place[k] + 0.5 * dt * m.rate[k]))


@_jit
def _carry(m, j, spin, spins, dt):
    """Rotation of a layer as a whole at the end of the step: wall friction takes it to the drum's."""
    if m.active[j] == 0.0:
        return spins[1]
    share = 0.5 * dt * m.layers[j, RATE] * spin ** m.layers[j, POWER]
    return (m.carried[j] * (1.0 - share) + share * (spins[0] + spins[1])) / (1.0 + share)


@_jit
def _tally(m, spin, spins, dt):
    """Add one step's works and heats, then make its end the state [theory: coupling, eq. 13]."""
    n = m.unbalance.size
    for i in range(n):
        mean = m.rate[i] + 0.5 * m.change[i]
        m.sums[UNBALANCE] -= m.swing[i] * mean
        for k in range(n):
            m.sums[SUPPORT] += dt * mean * m.matrices[1, i, k] * (m.rate[k] + 0.5 * m.change[k])
    for j in range(m.layers.shape[0]):
        if m.active[j] == 0.0:
            continue
        mass, kappa, row = m.layers[j, MASS], m.layers[j, CURVATURE], n + 2 * j
        rate = m.layers[j, RATE] * spin ** m.layers[j, POWER]
        after = _carry(m, j, spin, spins, dt)
        whole, gained = 0.5 * (m.carried[j] + after), after - m.carried[j]
        u, v = m.rate[row] + 0.5 * m.change[row], m.rate[row + 1] + 0.5 * m.change[row + 1]
        x, y = m.place[row] + 0.5 * dt * u, m.place[row + 1] + 0.5 * dt * v
        # Velocity relative to the liquid that turns as a whole.
        p, q = u + whole * y, v - whole * x
        drag = mass * rate * (1.0 + kappa)
        m.sums[FRICTION] += dt * (drag * (p * p + q * q) + m.layers[j, INERTIA] * rate * (spin - whole) ** 2)
        m.sums[DRIVE] -= dt * drag * whole * (x * q - y * p)
        m.sums[DRIVE] += 2.0 * mass * kappa * gained * (x * v - y * u - whole * (x * x + y * y))
        m.sums[DRIVE] += m.layers[j, INERTIA] * spin * gained
        m.sums[GRAVITY] += dt * mass * (m.gravity[0] * u + m.gravity[1] * v)
    if m.curve.shape[1] > 0:
        m.sums[MOTOR] += dt * spin * motor_torque(m.curve, spin)


@_jit
def advance_linear(m, stop, angle_step, most):
    """Advance rotor and layers to a time.

    Parameters
    ----------
    m : LinearMachine, changed in place
    stop : s
    angle_step : most that the rotor turns in a step, rad
    most : most steps

    Returns
    -------
    0, or 3 where the steps ran out, or 5 where the motor stands
    """
    n, spins, taken = m.unbalance.size, (0.0, 0.0), 0
    while m.turning[2] < stop:
        before = m.turning[0]
        if before <= 0.0:
            return 5
        if taken >= most:
            return 3
        taken += 1
        left = stop - m.turning[2]
        dt = min(angle_step / before, left)
        if left > dt > 0.5 * left:
            dt = 0.5 * left
        after = before + (m.drive[0] * dt if m.curve.shape[1] == 0 else 0.0)
        rounds = 1 if m.curve.shape[1] == 0 else 6
        for _ in range(rounds):
            spin = 0.5 * (before + after)
            first = complex(np.cos(m.turning[1]), np.sin(m.turning[1]))
            turned = m.turning[1] + spin * dt
            last = complex(np.cos(turned), np.sin(turned))
            spins = (before, after)
            for i in range(m.change.size):
                for k in range(m.change.size):
                    m.left[i, k] = 0.0
            _rotor_rows(m, spin, first, last, spins, dt)
            for j in range(m.layers.shape[0]):
                _assemble(m, j, spin, m.carried[j], _carry(m, j, spin, spins, dt), dt)
            solve(m.left, m.change)
            if m.curve.shape[1] > 0:
                load = 0.0
                for i in range(n):
                    load -= m.change[i] * (0.5 * m.unbalance[i] * (first + last)).imag
                for j in range(m.layers.shape[0]):
                    gained = _carry(m, j, spin, spins, dt) - m.carried[j]
                    load += m.layers[j, INERTIA] * gained * m.active[j]
                after = before + (dt * motor_torque(m.curve, spin) - load) / m.drive[1]
                if after <= 0.0:
                    return 5
        spin = 0.5 * (before + spins[1])
        _tally(m, spin, spins, dt)
        for j in range(m.layers.shape[0]):
            m.carried[j] = _carry(m, j, spin, spins, dt)
        for i in range(m.change.size):
            m.place[i] += dt * (m.rate[i] + 0.5 * m.change[i])
            m.rate[i] += m.change[i]
        m.turning[0], m.turning[1] = spins[1], m.turning[1] + spin * dt
        m.turning[2] = stop if dt == left else m.turning[2] + dt
        m.sums[STEPS] += 1.0
    return 0
