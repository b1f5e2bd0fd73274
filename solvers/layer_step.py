"""Pieces of a layer's time step: wall friction, and the two stages of Heun's method.

Friction acts in two exact half steps around each step [theory: long_wave, eq. 8-11]. Lengths over R, times in
the unit of the spin given. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from fluid import friction, long_wave
from solvers.face_flux import COMPILED, DRY
from solvers.finite_volume import FULL

_jit: Any = njit(**COMPILED)

# Films thinner than this (area over R^2) are held back, at this multiple of the spin.
FILM, FASTEST = 1e-5, 4.0

surface_radius = _jit(long_wave.free_surface_radius)
_damping = _jit(friction.damping_rate)


@_jit
def copy(source, target):
    """Copy an array element by element: compiled code here may not ask for memory, as slices would."""
    to, of = target.reshape(-1), source.reshape(-1)
    for i in range(of.size):
        to[i] = of[i]


@_jit
def wall_friction(area, q, spin, law, coefficient, lid, dt):
    """Friction alone over a time dt: an exact decay of the velocity, cell by cell."""
    if law == 0:
        return
    for i in range(area.size):
        a = area[i]
        if a <= DRY:
            q[i] = -spin * a * a
            continue
        moved = q[i] + spin * a * a
        depth = 1.0 - surface_radius(a)
        rate = _damping(law, coefficient, lid, depth, a, moved / a)
        # Quadratic friction: du/dt = -c |u| u has the hyperbola as its solution, the others the exponential.
        kept = 1.0 / (1.0 + rate * dt) if law == 3 else np.exp(-rate * dt)
        q[i] = moved * kept - spin * a * a


@_jit
def calm(area, q, spin):
    """Hold films back that run away: they carry no momentum worth speaking of and would rule the time step.

    No front runs ahead at twice the speed of the drum; films below FILM may go twice as fast as that.
    """
    for i in range(area.size):
        a = area[i]
        if a < FILM:
            most = FASTEST * abs(spin) * a
            moved = min(max(q[i] + spin * a * a, -most), most)
            q[i] = moved - spin * a * a


@_jit
def predict(area, q, rate_a, rate_q, dt, next_a, next_q):
    """Euler step; tells whether the surface stays off the axis and every number is one."""
    sound = True
    for i in range(area.size):
        next_a[i] = max(area[i] + dt * rate_a[i], 0.0)
        next_q[i] = q[i] + dt * rate_q[i]
        # Written so that nan is not sound either.
        sound = sound and area[i] < FULL and next_a[i] < FULL and abs(next_q[i]) < np.inf
    return sound


@_jit
def correct(area, q, rate_a, rate_q, dt, next_a, next_q):
    """Second stage of Heun's method."""
    for i in range(area.size):
        area[i] = 0.5 * (area[i] + max(next_a[i] + dt * rate_a[i], 0.0))
        q[i] = 0.5 * (q[i] + next_q[i] + dt * rate_q[i])
