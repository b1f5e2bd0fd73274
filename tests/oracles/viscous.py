"""Rotor and a plane layer of viscous liquid: the linearised Navier-Stokes equations on Chebyshev points.

Nothing is taken from boundary layers: the wall holds the liquid, the free surface has no stress. Amplitudes
go as e^{i (s t - theta)} in the frame of the drum; u, v and p are radial, along the wall, and pressure over
density without that of the rotation at rest.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from meshes.arrays import Array


class Machine(NamedTuple):
    """A planar rotor with one layer, per metre of the chamber's height; SI units."""

    mass: float
    stiffness: float
    damping: float
    radius: float
    surface: float
    density: float
    viscosity: float


class Answer(NamedTuple):
    """Of the liquid to a unit deflection at one frequency."""

    force: complex  # on the drum, N/m per metre of height: pressure and shear on the wall
    newton: complex  # the same from the motion of the centre of mass


def chebyshev(low: float, high: float, points: int) -> tuple[Array, Array]:
    """Points between two radii, dense at both, and the matrix that differentiates on them."""
    k = np.arange(points)
    x = np.cos(np.pi * k / (points - 1))
    weight = np.where((k == 0) | (k == points - 1), 2.0, 1.0) * (-1.0) ** k
    matrix = np.outer(weight, 1.0 / weight) / (x[:, None] - x + np.eye(points))
    matrix -= np.diag(matrix.sum(axis=1))
    return 0.5 * (high + low) + 0.5 * (high - low) * x, matrix * 2.0 / (high - low)


def liquid_answer(machine: Machine, spin: float, slip: complex, points: int) -> Answer:
    """What a layer answers to a whirl e^{i slip t} seen from the drum, by collocation."""
    r, d = chebyshev(machine.surface, machine.radius, points)
    n, nu, omega = points, machine.viscosity, slip + spin
    unit, over = np.eye(n), np.diag(1.0 / r)
    # u'' + u'/r - 2 u/r^2 and what couples the two.
    bent = nu * (d @ d + over @ d - 2.0 * over @ over)
    turned = 2j * nu * over @ over
    u, v, p = (slice(k * n, (k + 1) * n) for k in range(3))
    matrix, right = np.zeros((3 * n + 1, 3 * n + 1), dtype=complex), np.zeros(3 * n + 1, dtype=complex)
    force = omega**2
    matrix[u, u], matrix[u, v], matrix[u, p] = 1j * slip * unit - bent, -2.0 * spin * unit - turned, d
    matrix[v, u], matrix[v, v], matrix[v, p] = 2.0 * spin * unit + turned, 1j * slip * unit - bent, -1j * over
    matrix[p, u], matrix[p, v] = d + over, -1j * over
    right[u], right[v] = force, -1j * force
    wall, surface = int(np.argmax(r)), int(np.argmin(r))
    # In place of momentum at the ends: no slip, no stress, and xi's own row.
    for row, at in ((u.start + wall, u.start + wall), (v.start + wall, v.start + wall)):
        matrix[row], right[row] = 0.0, 0.0
        matrix[row, at] = 1.0
    row = v.start + surface
    matrix[row], right[row] = 0.0, 0.0
    matrix[row, v] = d[surface]
    matrix[row, v.start + surface] -= 1.0 / r[surface]
    matrix[row, u.start + surface] = -1j / r[surface]
    row = u.start + surface
    matrix[row], right[row] = 0.0, 0.0
    matrix[row, p.start + surface], matrix[row, -1] = 1.0, spin**2 * r[surface]
    matrix[row, u] = -2.0 * nu * d[surface]
    matrix[-1, -1], matrix[-1, u.start + surface] = 1j * slip, -1.0
    scale = np.abs(matrix).max(axis=1)
    found = np.linalg.solve(matrix / scale[:, None], right / scale)
    pressure, shear = found[p][wall], nu * (d[wall] @ found[v])
    xi, kappa = found[-1], (machine.radius / machine.surface) ** 2
    area = math.pi * (machine.radius**2 - machine.surface**2)
    return Answer(
        machine.density * math.pi * machine.radius * complex(pressure - 1j * shear),
        machine.density * area * omega**2 * complex(1.0 - xi / (kappa - 1.0)),
    )


def whirl(machine: Machine, spin: float, start: complex, points: int = 48) -> complex:
    """Frequency s of the coupled whirl next to a value, seen from the drum; it grows at -Im s, 1/s."""

    def left(slip: complex) -> complex:
        omega = slip + spin
        support = machine.stiffness - machine.mass * omega**2 + 1j * machine.damping * omega
        return support - liquid_answer(machine, spin, slip, points).force

    last, here = start * (1.0 + 1e-5), start
    at_last, at_here = left(last), left(here)
    for _ in range(30):
        step = at_here * (here - last) / (at_here - at_last)
        last, at_last, here = here, at_here, here - step
        if abs(step) < 1e-12 * abs(spin):
            break
        at_here = left(here)
    return here
