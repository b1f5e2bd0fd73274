"""One layer through one time step of the coupled machine, and what it tells the rotor.

The axis' mean acceleration over the step is given; the layer answers with its momentum relative to the axis
[theory: coupling, eq. 2-5]. Lengths over the wall radius R, times in s. Compiled by numba with its cache on
disk.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from solvers.face_flux import COMPILED, DRY, NEAREST, faded_velocity, log_of_surface
from solvers.finite_volume import GHOSTS, WORK, ring_rates
from solvers.layer_step import calm, copy, correct, predict, surface_radius, wall_friction
from solvers.machine import ENERGY, FLOW, HEAT, INERTIA, LOSS, MISSED, MOMENT, SPINNING, TORQUE

_jit: Any = njit(**COMPILED)
_inner: Any = njit(**(COMPILED | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}))

# Courant number beyond which a step is taken again.
LARGEST = 1.0
DONE, TOO_LONG, AT_AXIS = 0, 1, 2


def layer_scratch(layers: int, cells: int) -> NDArray[np.float64]:
    """Scratch that `layer_step` wants for each of so many layers."""
    return np.zeros((layers, WORK + 9, cells + 2 * GHOSTS))


@_jit
def measure(area, q, spin, angles, spare, out):
    """Fill `out` with a layer's measures, shape (MEASURES,) [theory: coupling, eq. 2, 4 and 7]."""
    n = area.size
    step = 2.0 * np.pi / n
    across, along, log = spare[WORK, :n], spare[WORK + 1, :n], spare[WORK + 2, :n]
    flow = spare[WORK + 3, :n]
    for k in range(out.size):
        out[k] = 0.0
    for i in range(n):
        r = np.maximum(surface_radius(area[i]), NEAREST)
        u = faded_velocity(area[i], q[i], spin)
        log[i] = log_of_surface(area[i], r)
        across[i], along[i] = r * angles[0, i], r * angles[1, i]
        flow[i] = u * log[i]
        lever = (1.0 - r) * (1.0 + r + r * r) / 3.0
        out[MOMENT] += lever * angles[0, i] * step
        out[MOMENT + 1] += lever * angles[1, i] * step
        whole = area[i] * (1.0 - area[i])
        out[SPINNING] += (spin * whole + u * area[i]) * step
        out[ENERGY] += (0.5 * spin * spin * whole + spin * u * area[i] + 0.5 * u * u * log[i]) * step
    for i in range(n):
        after, before = i + 1 if i + 1 < n else 0, i - 1
        x, y = 0.5 * (across[after] - across[before]), 0.5 * (along[after] - along[before])
        out[FLOW] += flow[i] * x
        out[FLOW + 1] += flow[i] * y
        out[INERTIA] += log[i] * x * x / step
        out[INERTIA + 1] += log[i] * x * y / step
        out[INERTIA + 2] += log[i] * y * y / step


@_inner
def _pull(x, y, angles, pull_cell, pull_face):
    """Radial part of a uniform body force at cells and faces."""
    for i in range(pull_cell.size):
        pull_cell[i] = x * angles[0, i] + y * angles[1, i]
        pull_face[i] = x * angles[2, i] + y * angles[3, i]


@_inner
def _energy(area, q, spin):
    """Energy of the flow in the frame that does not turn, over rho h_c R^4 [theory: coupling, eq. 7]."""
    total = 0.0
    for i in range(area.size):
        r = np.maximum(surface_radius(area[i]), NEAREST)
        u = faded_velocity(area[i], q[i], spin)
        turning = spin * area[i] * (0.5 * spin * (1.0 - area[i]) + u)
        total += turning + 0.5 * u * u * log_of_surface(area[i], r)
    return total * 2.0 * np.pi / area.size


@_inner
def _power(area, q, spin, euler, x, y, angles, rate_a, gains, dt):
    """Power of the body force in the frame that does not turn [theory: coupling, eq. 8].

    Adds what the flow's profile makes of the changing spin: the Euler force acts on the angular momentum,
    which the profile does not turn into energy to the last digit.
    """
    n = area.size
    step = 2.0 * np.pi / n
    moment_x, moment_y, rate_x, rate_y = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        r = np.maximum(surface_radius(area[i]), NEAREST)
        lever = (1.0 - r) * (1.0 + r + r * r) / 3.0
        moment_x += lever * angles[0, i] * step
        moment_y += lever * angles[1, i] * step
        rate_x += r * angles[0, i] * rate_a[i] * step
        rate_y += r * angles[1, i] * rate_a[i] * step
        u, log = faded_velocity(area[i], q[i], spin), log_of_surface(area[i], r)
        gains[MISSED] -= dt * step * euler * u * (area[i] - log * (1.0 - area[i]))
    return x * (rate_x - spin * moment_y) + y * (rate_y + spin * moment_x)


@_inner
def _work(area, q, before, spin, step, gains):
    """Add what friction has done to the velocities: impulse of the wall's torque, and heat."""
    for i in range(area.size):
        a = area[i]
        if a <= DRY:
            continue
        r = np.maximum(surface_radius(a), NEAREST)
        u, v = faded_velocity(a, before[i], spin), faded_velocity(a, q[i], spin)
        gains[TORQUE] += a * (v - u) * step
        gains[HEAT] += 0.5 * log_of_surface(a, r) * (u * u - v * v) * step


@_inner
def layer_step(area, q, spins, push, rub, dt, angles, spare, gains):
    """Advance a layer by one time step, in place; a step that fails leaves nothing to go on with.

    Parameters
    ----------
    area, q : state, shape (n,)
    spins : spin at the beginning and at the end
    push : body force over R in the drum frame at the beginning (two parts) and at the end (two)
    rub : friction law, coefficient, lid, square of the layer's L for dispersion (0 without it)
    dt : time step
    angles : cosine and sine at the cells' middles and at their left faces, shape (4, n)
    spare : scratch of this layer, from `layer_scratch`
    gains : results, shape (GAINS,)

    Returns
    -------
    DONE, TOO_LONG or AT_AXIS; and the largest speed met
    """
    n = area.size
    step, euler = 2.0 * np.pi / n, (spins[1] - spins[0]) / dt
    law, coefficient, lid, spread = int(rub[0]), rub[1], rub[2], rub[3]
    pull_cell, pull_face = spare[WORK, :n], spare[WORK + 1, :n]
    rate_a, rate_q = spare[WORK + 4, :n], spare[WORK + 5, :n]
    next_a, next_q, before = spare[WORK + 6, :n], spare[WORK + 7, :n], spare[WORK + 8, :n]
    for k in range(gains.size):
        gains[k] = 0.0
    copy(q, before)
    wall_friction(area, q, spins[0], law, coefficient, lid, 0.5 * dt)
    _work(area, q, before, spins[0], step, gains)
    copy(area, next_a)
    copy(q, next_q)
    gains[LOSS] = _energy(area, q, spins[0])
    fastest = 0.0
    for stage in range(2):
        spin, x, y = spins[stage], push[2 * stage], push[2 * stage + 1]
        _pull(x, y, angles, pull_cell, pull_face)
        speed = ring_rates(
            next_a, next_q, spin, euler, pull_cell, pull_face, step, dt, spread, spare, rate_a, rate_q
        )
        if not speed < np.inf:
            return AT_AXIS, speed
        fastest = max(fastest, speed)
        if dt * fastest > LARGEST * step:
            return TOO_LONG, fastest
        done = _power(next_a, next_q, spin, euler, x, y, angles, rate_a, gains, 0.5 * dt)
        gains[LOSS] += 0.5 * dt * done
        if stage == 0:
            if not predict(area, q, rate_a, rate_q, dt, next_a, next_q):
                return AT_AXIS, fastest
        else:
            correct(area, q, rate_a, rate_q, dt, next_a, next_q)
            calm(area, q, spin)
    gains[LOSS] -= _energy(area, q, spins[1]) + gains[MISSED]
    copy(q, before)
    wall_friction(area, q, spins[1], law, coefficient, lid, 0.5 * dt)
    _work(area, q, before, spins[1], step, gains)
    return DONE, fastest
