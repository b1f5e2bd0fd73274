"""A finite-volume layer driven by a prescribed whirl: time steps, friction, and the loads on the drum.

Heun's method with friction in two exact half steps around each step [theory: long_wave, eq. 8-11]. Lengths
over R, times in the unit of the spin given. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from fluid import friction, long_wave
from solvers.finite_volume import DRY, FAST, FULL, WORK, primitives, rates

_jit: Any = njit(cache=True, fastmath=FAST, error_model="numpy")

_surface = _jit(long_wave.free_surface_radius)
_log = _jit(long_wave.layer_log)
_wall = _jit(long_wave.wall_pressure)
_damping = _jit(friction.damping_rate)


@_jit
def _rub(area, q, spin, law, coefficient, lid, dt):
    """Friction alone over a time dt: an exact decay of the velocity, cell by cell."""
    if law == 0:
        return
    for i in range(area.size):
        a = area[i]
        if a <= DRY:
            q[i] = -spin * a * a
            continue
        moved = q[i] + spin * a * a
        depth = 1.0 - _surface(a)
        rate = _damping(law, coefficient, lid, depth, a, moved / a)
        # Quadratic friction: du/dt = -c |u| u has the hyperbola as its solution, the others the exponential.
        kept = 1.0 / (1.0 + rate * dt) if law == 3 else np.exp(-rate * dt)
        q[i] = moved * kept - spin * a * a


@_jit
def _whirl(time, amplitude, slip, ramp, whirl, weight, spin):
    """Body force in the drum frame: minus the axis' acceleration, and gravity across the axis.

    The amplitude grows as tau - sin(2 pi tau)/(2 pi), tau = time/ramp; its rate of change is left out of the
    acceleration [theory: long_wave, eq. 8].
    """
    grown = 1.0
    if time < ramp:
        grown = time / ramp - np.sin(2.0 * np.pi * time / ramp) / (2.0 * np.pi)
    force = amplitude * whirl * whirl * grown * complex(np.cos(slip * time), np.sin(slip * time))
    return force + weight * complex(-np.sin(spin * time), -np.cos(spin * time))


@_jit
def _spread(force, cosine, sine, pull):
    for i in range(pull.size):
        pull[i] = force.real * cosine[i] + force.imag * sine[i]


@_jit
def loads(area, q, spin, pull, cosine, sine, step, work):
    """Pressure force on the drum; offset, turning, least and largest depth and area of the liquid.

    The force is over rho h_c R^3 times the square of the unit of spin.
    """
    surface, velocity, head = work[0], work[1], work[2]
    primitives(area, q, spin, pull, surface, velocity, head)
    force, moment = 0.0 + 0.0j, 0.0 + 0.0j
    total, turning, least, largest = 0.0, 0.0, 1.0, 0.0
    for i in range(area.size):
        r, u = surface[i], velocity[i]
        log = _log(area[i])
        ray = complex(cosine[i], sine[i]) * step
        force += _wall(u, log, area[i], r, spin, pull[i]) * ray
        moment += (1.0 - r * r * r) / 3.0 * ray
        total += area[i] * step
        turning += u * log * step
        least, largest = min(least, 1.0 - r), max(largest, 1.0 - r)
    return force, moment / total, turning / total, least, largest, total


@_jit
def advance(area, q, start, stop, drive, rub, angles, courant, most):
    """Advance a layer under a prescribed whirl and integrate its loads over time.

    Parameters
    ----------
    area, q : state, changed in place, shape (n,)
    start, stop : times
    drive : amplitude, slip (whirl seen from the drum), ramp time, whirl speed, weight, spin
    rub : friction law, coefficient, lid, square of the layer's L for dispersion (0 without it)
    angles : cosine and sine at the cells' middles and at their left faces, shape (4, n)
    courant : Courant number
    most : most steps

    Returns
    -------
    steps taken, or -1 where they ran out or the surface came to the axis; then, as means over the time: force
    by the liquid's momentum and offset, both in the frame of the deflection (complex), turning, least depth,
    largest depth, and force by the pressure on the wall [theory: long_wave, eq. 7]
    """
    n = area.size
    step = 2.0 * np.pi / n
    amplitude, slip, ramp, whirl, weight, spin = drive
    law, coefficient, lid, spread = int(rub[0]), rub[1], rub[2], rub[3]
    work = np.zeros((WORK, n))
    pull_cell, pull_face = np.zeros(n), np.zeros(n)
    rate_a, rate_q, next_a, next_q = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    mean_force, mean_offset, mean_push = 0.0 + 0.0j, 0.0 + 0.0j, 0.0 + 0.0j
    first = 0.0 + 0.0j
    mean_turning, mean_least, mean_largest = 0.0, 0.0, 0.0
    time, steps = start, 0
    fastest = 0.0
    while time < stop:
        force = _whirl(time, amplitude, slip, ramp, whirl, weight, spin)
        _spread(force, angles[0], angles[1], pull_cell)
        _spread(force, angles[2], angles[3], pull_face)
        if fastest == 0.0:
            fastest = rates(area, q, spin, 0.0, pull_cell, pull_face, step, 0.0, spread, work, rate_a, rate_q)
        # The speed may have grown since it was taken: a tenth is kept in hand, and what comes out is checked.
        dt = min(courant * step / (1.1 * fastest), stop - time)
        load, moment, turning, least, largest, _ = loads(
            area, q, spin, pull_cell, angles[0], angles[1], step, work
        )
        back = complex(np.cos(slip * time), -np.sin(slip * time)) * dt
        if steps == 0:
            first = moment * complex(np.cos(slip * time), -np.sin(slip * time))
        mean_force += load * back
        mean_offset += moment * back
        mean_push += force * back
        mean_turning += turning * dt
        mean_least += least * dt
        mean_largest += largest * dt
        _rub(area, q, spin, law, coefficient, lid, 0.5 * dt)
        rates(area, q, spin, 0.0, pull_cell, pull_face, step, dt, spread, work, rate_a, rate_q)
        sound = fastest < np.inf
        for i in range(n):
            next_a[i] = max(area[i] + dt * rate_a[i], 0.0)
            next_q[i] = q[i] + dt * rate_q[i]
            # Written so that nan is not sound either.
            sound = sound and area[i] < FULL and next_a[i] < FULL and abs(next_q[i]) < np.inf
        if not sound:
            return -1, mean_force, mean_offset, mean_turning, mean_least, mean_largest, mean_push
        force = _whirl(time + dt, amplitude, slip, ramp, whirl, weight, spin)
        _spread(force, angles[0], angles[1], pull_cell)
        _spread(force, angles[2], angles[3], pull_face)
        fastest = rates(
            next_a, next_q, spin, 0.0, pull_cell, pull_face, step, dt, spread, work, rate_a, rate_q
        )
        for i in range(n):
            area[i] = 0.5 * (area[i] + max(next_a[i] + dt * rate_a[i], 0.0))
            q[i] = 0.5 * (q[i] + next_q[i] + dt * rate_q[i])
        _rub(area, q, spin, law, coefficient, lid, 0.5 * dt)
        time += dt
        steps += 1
        if steps >= most:
            return -1, mean_force, mean_offset, mean_turning, mean_least, mean_largest, mean_push
    _spread(force, angles[0], angles[1], pull_cell)
    last = loads(area, q, spin, pull_cell, angles[0], angles[1], step, work)[1]
    last *= complex(np.cos(slip * time), -np.sin(slip * time))
    length = stop - start
    total = 0.0
    for i in range(n):
        total += area[i] * step
    # Momentum of the liquid as a whole: its mass times the push, the centripetal and the Coriolis part.
    drift = (last - first) / length
    inertia = mean_push + whirl * whirl * mean_offset - complex(0.0, 2.0 * whirl) * drift * length
    return (
        steps,
        total * inertia / length,
        mean_offset / length,
        mean_turning / length,
        mean_least / length,
        mean_largest / length,
        mean_force / length,
    )
