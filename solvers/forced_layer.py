"""A finite-volume layer driven by a prescribed whirl: time steps, friction, and the loads on the drum.

Heun's method with friction in two exact half steps around each step [theory: long_wave, eq. 8-11]. Lengths
over R, times in the unit of the spin given. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from fluid import friction, long_wave
from solvers.face_flux import COMPILED, DRY, NEAREST, faded_velocity, log_of_surface
from solvers.finite_volume import FULL, GHOSTS, WORK, ring_rates

_jit: Any = njit(**COMPILED)

_surface = _jit(long_wave.free_surface_radius)
_wall = _jit(long_wave.wall_pressure)
_damping = _jit(friction.damping_rate)

RAN_OUT, AT_AXIS = -1, -2
# Courant number beyond which a step is taken again.
_LARGEST = 0.5


def scratch(cells: int) -> NDArray[np.float64]:
    """Scratch that `advance` wants for a ring of so many cells."""
    return np.zeros((WORK + 7, cells + 2 * GHOSTS))


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
def _cell_loads(area, q, spin, pull, pressure, lever, turning):
    """Pressure on the wall, first moment and mass flux of each cell."""
    for i in range(area.size):
        r = np.maximum(_surface(area[i]), NEAREST)
        u, log = faded_velocity(area[i], q[i], spin), log_of_surface(area[i], r)
        pressure[i] = _wall(u, log, area[i], r, spin, pull[i])
        lever[i] = _lever(r)
        turning[i] = u * log


@_jit
def _lever(surface):
    """First moment of the liquid per radian, (1 - r^3)/3."""
    return (1.0 - surface) * (1.0 + surface + surface * surface) / 3.0


@_jit
def _tally(area, q, spin, pull, angles, work, back, sums, share):
    """Add a time's share of the loads to the sums of `advance`, turned into the frame of the deflection.

    The force is over rho h_c R^3 times the square of the unit of spin.
    """
    n = area.size
    cosine, sine = angles[0], angles[1]
    pressure, lever, turning = work[0, :n], work[1, :n], work[2, :n]
    _cell_loads(area, q, spin, pull, pressure, lever, turning)
    force_x, force_y, moment_x, moment_y = 0.0, 0.0, 0.0, 0.0
    total, turned, least, largest = 0.0, 0.0, area[0], area[0]
    for i in range(n):
        force_x += pressure[i] * cosine[i]
        force_y += pressure[i] * sine[i]
        moment_x += lever[i] * cosine[i]
        moment_y += lever[i] * sine[i]
        total += area[i]
        turned += turning[i]
        least, largest = min(least, area[i]), max(largest, area[i])
    sums[1] += complex(moment_x, moment_y) / total * back * share
    sums[2] += turned / total * share
    sums[3] += (1.0 - _surface(least)) * share
    sums[4] += (1.0 - _surface(largest)) * share
    sums[5] += complex(force_x, force_y) * (2.0 * np.pi / n) * back * share


@_jit
def _offset(area, angles):
    """Offset of the liquid's centre of mass."""
    x, y, total = 0.0, 0.0, 0.0
    for i in range(area.size):
        lever = _lever(_surface(area[i]))
        x += lever * angles[0, i]
        y += lever * angles[1, i]
        total += area[i]
    return complex(x, y) / total


@_jit
def _predict(area, q, rate_a, rate_q, dt, next_a, next_q):
    """Euler step; tells whether the surface stays off the axis and every number is one."""
    sound = True
    for i in range(area.size):
        next_a[i] = max(area[i] + dt * rate_a[i], 0.0)
        next_q[i] = q[i] + dt * rate_q[i]
        # Written so that nan is not sound either.
        sound = sound and area[i] < FULL and next_a[i] < FULL and abs(next_q[i]) < np.inf
    return sound


@_jit
def _correct(area, q, rate_a, rate_q, dt, next_a, next_q):
    """Second stage of Heun's method."""
    for i in range(area.size):
        area[i] = 0.5 * (area[i] + max(next_a[i] + dt * rate_a[i], 0.0))
        q[i] = 0.5 * (q[i] + next_q[i] + dt * rate_q[i])


@_jit
def advance(area, q, start, stop, drive, rub, angles, courant, most, spare, sums):
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
    spare : as from `scratch`, whose rows are reused
    sums : results, complex, shape (6,), in the frame of the deflection, as means over the time: force by the
        liquid's momentum, offset, turning, least depth, largest depth, force by the pressure on the wall
        [theory: long_wave, eq. 7]

    Returns
    -------
    steps tried, or RAN_OUT where they did, or AT_AXIS where the surface came to the axis
    """
    n = area.size
    step = 2.0 * np.pi / n
    amplitude, slip, ramp, whirl, weight, spin = drive
    law, coefficient, lid, spread = int(rub[0]), rub[1], rub[2], rub[3]
    pull_cell, pull_face = spare[WORK, :n], spare[WORK + 1, :n]
    rate_a, rate_q = spare[WORK + 2, :n], spare[WORK + 3, :n]
    next_a, next_q, begin_q = spare[WORK + 4, :n], spare[WORK + 5, :n], spare[WORK + 6, :n]
    for k in range(6):
        sums[k] = 0.0
    first = _offset(area, angles) * complex(np.cos(slip * start), -np.sin(slip * start))
    time, steps, dt, fastest, push = start, 0, 0.0, 0.0, 0.0 + 0.0j
    # 0: only the largest speed is asked for; 1 and 2: the two stages of Heun's method.
    stage = 0
    while time < stop:
        force = _whirl(time + dt if stage == 2 else time, amplitude, slip, ramp, whirl, weight, spin)
        _spread(force, angles[0], angles[1], pull_cell)
        _spread(force, angles[2], angles[3], pull_face)
        if stage == 1:
            # The speed may have grown since it was taken: a tenth is kept in hand.
            dt = min(courant * step / (1.1 * fastest), stop - time)
            for i in range(n):
                begin_q[i] = q[i]
            _rub(area, q, spin, law, coefficient, lid, 0.5 * dt)
        if stage < 2:
            for i in range(n):
                next_a[i], next_q[i] = area[i], q[i]
        fastest = ring_rates(
            next_a,
            next_q,
            spin,
            0.0,
            pull_cell,
            pull_face,
            step,
            dt if stage > 0 else 0.0,
            spread,
            spare,
            rate_a,
            rate_q,
        )
        if steps >= most:
            return RAN_OUT
        if not fastest < np.inf:
            return AT_AXIS
        if stage > 0 and dt * fastest > _LARGEST * step:
            # A film has run faster than the step allows: once more, shorter.
            for i in range(n):
                q[i] = begin_q[i]
            stage = 1
            steps += 1
            continue
        if stage == 1:
            if not _predict(area, q, rate_a, rate_q, dt, next_a, next_q):
                return AT_AXIS
        elif stage == 2:
            force = _whirl(time, amplitude, slip, ramp, whirl, weight, spin)
            back = complex(np.cos(slip * time), -np.sin(slip * time))
            _spread(force, angles[0], angles[1], pull_cell)
            _tally(area, begin_q, spin, pull_cell, angles, spare, back, sums, dt)
            push += force * back * dt
            _correct(area, q, rate_a, rate_q, dt, next_a, next_q)
            _rub(area, q, spin, law, coefficient, lid, 0.5 * dt)
            time += dt
            steps += 1
        stage = 2 if stage == 1 else 1
    last = _offset(area, angles) * complex(np.cos(slip * time), -np.sin(slip * time))
    # Momentum of the liquid as a whole: its mass times the push, the centripetal and the Coriolis part.
    total = 0.0
    for i in range(n):
        total += area[i] * step
    sums[0] = total * (push + whirl * whirl * sums[1] - complex(0.0, 2.0 * whirl) * (last - first))
    for k in range(6):
        sums[k] /= stop - start
    return steps
