"""Finite volumes for the annular long-wave equations: second order, well balanced, never below zero.

Unknowns of a cell: the liquid area per radian A and the relative angular momentum q = u A - Omega A^2, the
absolute one less Omega R^2 A, whose flux cancels [theory: long_wave, eq. 4]. Reconstructed are the static
head, so that equilibria stay as they are, and the velocity, both limited; the flux is HLL; time steps are
Heun's (SSP), with friction in two exact half steps around them [theory: long_wave, eq. 11]. Lengths over R,
times in the unit of the spin given.

Compiled by numba with its cache on disk; the equations are those of `fluid.long_wave` and `fluid.friction`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from fluid import long_wave

FAST = {"contract", "arcp", "nsz"}
_jit: Any = njit(cache=True, fastmath=FAST, error_model="numpy")

_surface = _jit(long_wave.free_surface_radius)
_log = _jit(long_wave.layer_log)
_head = _jit(long_wave.static_head)
_at_head = _jit(long_wave.surface_at_head)
_mass = _jit(long_wave.mass_flux)
_momentum = _jit(long_wave.momentum_flux)
_pressure = _jit(long_wave.pressure_force)
_celerity = _jit(long_wave.wave_celerity)
_bernoulli = _jit(long_wave.bernoulli)
_CONSTANT, _CURVED, _LESS = long_wave.PADE

# Below this area (of R^2) a cell is dry: its velocity is not known to any digit.
DRY = 1e-13
THIN = 1e-8
# Beyond this area the surface has come to the axis (r_s < 0.03): no layer is left to speak of.
FULL = 0.4995
NEAREST = 0.03
WORK = 9


@_jit
def _limited(a: float, b: float) -> float:
    """Monotonised central slope."""
    if a * b <= 0.0:
        return 0.0
    middle = 0.5 * (a + b)
    least = 2.0 * min(abs(a), abs(b))
    slope: float = np.sign(middle) * min(abs(middle), least)
    return slope


@_jit
def primitives(area, q, spin, pull, surface, velocity, head):
    """Fill free-surface radius, velocity and static head of each cell."""
    for i in range(area.size):
        a = area[i]
        r = _surface(a)
        surface[i] = r
        moved = q[i] + spin * a * a
        # In films thinner than THIN the velocity is faded out: its digits are gone.
        velocity[i] = 2.0 * moved * a / (a * a + max(a * a, THIN * THIN)) if a > DRY else 0.0
        head[i] = _head(a, r, spin, pull[i])


@_jit
def rates(area, q, spin, euler, pull_cell, pull_face, step, dt, spread, work, d_area, d_q):
    """Rates of change of A and q; returns the largest characteristic speed.

    Parameters
    ----------
    area, q : state, shape (n,)
    spin : Omega; euler : its rate of change
    pull_cell, pull_face : f_r at the cells' middles and at their left faces, shape (n,)
    step : cell width, rad
    dt : time step in which no cell may lose more than it has
    spread : L^2 of the undisturbed layer for the dispersive term, 0 without it
    work : scratch, shape (WORK, n)
    d_area, d_q : results, shape (n,)
    """
    n = area.size
    surface, velocity, head = work[0], work[1], work[2]
    primitives(area, q, spin, pull_cell, surface, velocity, head)
    fastest = 0.0
    for i in range(n):
        d_area[i] = 0.0
        d_q[i] = -euler * area[i]
    for face in range(n):
        right = face
        left = face - 1 if face > 0 else n - 1
        before = left - 1 if left > 0 else n - 1
        after = right + 1 if right < n - 1 else 0
        dry = area[left] <= DRY or area[right] <= DRY
        pull = pull_face[face]
        head_l, head_r = head[left], head[right]
        u_l, u_r = velocity[left], velocity[right]
        if dry:
            # The bed is the higher of the two cells': liquid below it does not climb.
            pull = min(pull_cell[left], pull_cell[right])
        else:
            between = head_r - head_l
            if area[before] > DRY:
                head_l += 0.5 * _limited(head_l - head[before], between)
                u_l += 0.5 * _limited(u_l - velocity[before], u_r - velocity[left])
            if area[after] > DRY:
                head_r -= 0.5 * _limited(between, head[after] - head_r)
                u_r -= 0.5 * _limited(velocity[right] - velocity[left], velocity[after] - velocity[right])
        # Where the push exceeds the centrifugal force no surface has this head: the least radius stands in.
        r_l = max(_at_head(head_l, spin, pull), NEAREST)
        r_r = max(_at_head(head_r, spin, pull), NEAREST)
        a_l, a_r = 0.5 * (1.0 - r_l) * (1.0 + r_l), 0.5 * (1.0 - r_r) * (1.0 + r_r)
        if area[left] <= DRY:
            a_l, r_l, u_l = 0.0, 1.0, 0.0
        if area[right] <= DRY:
            a_r, r_r, u_r = 0.0, 1.0, 0.0
        p_l, p_r = _pressure(a_l, r_l, spin, pull), _pressure(a_r, r_r, spin, pull)
        log_l, log_r = _log(a_l), _log(a_r)
        mean_l, half_l = _celerity(u_l, log_l, r_l, spin)
        mean_r, half_r = _celerity(u_r, log_r, r_r, spin)
        slow = min(mean_l - half_l, mean_r - half_r)
        fast = max(mean_l + half_l, mean_r + half_r)
        if a_l == 0.0:
            slow, fast = mean_r - 2.0 * half_r, mean_r + half_r
        elif a_r == 0.0:
            slow, fast = mean_l - half_l, mean_l + 2.0 * half_l
        mass_l, mass_r = _mass(u_l, log_l), _mass(u_r, log_r)
        flow_l = _momentum(u_l, log_l, a_l, r_l) + p_l
        flow_r = _momentum(u_r, log_r, a_r, r_r) + p_r
        if slow >= 0.0:
            mass, flow = mass_l, flow_l
        elif fast <= 0.0:
            mass, flow = mass_r, flow_r
        else:
            q_l, q_r = u_l * a_l - spin * a_l * a_l, u_r * a_r - spin * a_r * a_r
            width = 1.0 / (fast - slow)
            mass = (fast * mass_l - slow * mass_r + fast * slow * (a_r - a_l)) * width
            flow = (fast * flow_l - slow * flow_r + fast * slow * (q_r - q_l)) * width
        fastest = max(fastest, abs(slow), abs(fast))
        work[7, face] = mass
        # Inside a cell the force is A dB/dtheta, by the trapezium of its two ends: half here, half at the
        # cell's other face.
        d_q[left] -= (flow - p_l) / step
        d_q[right] += (flow - p_r) / step
        work[3, left], work[4, left] = a_l, head_l
        work[5, right], work[6, right] = a_r, head_r
    for i in range(n):
        d_q[i] -= 0.5 * (work[3, i] + work[5, i]) * (work[4, i] - work[6, i]) / step
    if spread > 0.0:
        _disperse(area, spin, pull_cell, step, spread, work, d_q)
    _drain(area, step, dt, work[7], work[3])
    for face in range(n):
        left = face - 1 if face > 0 else n - 1
        mass = work[7, face] / step
        d_area[left] -= mass
        d_area[face] += mass
    return fastest


@_jit
def _disperse(area, spin, pull, step, spread, work, d_q):
    """Add what the finite depth takes from the pressure gradient [theory: long_wave, eq. 12].

    The gradient g of Bernoulli's function counts as tanh(nL)/(nL) of itself: what is missing, y, solves
    (15 - 6 L^2 d^2) y = -5 L^2 d^2 g. Weighted with the mean area it exerts no net torque.
    """
    n = area.size
    surface, velocity = work[0], work[1]
    head, slope, right = work[3], work[4], work[5]
    mean = 0.0
    for i in range(n):
        head[i] = _bernoulli(velocity[i], _log(area[i]), area[i], surface[i], spin, pull[i])
        mean += area[i] / n
    for i in range(n):
        slope[i] = (head[i + 1 if i < n - 1 else 0] - head[i - 1 if i > 0 else n - 1]) / (2.0 * step)
    reach = spread / (step * step)
    for i in range(n):
        bend = slope[i + 1 if i < n - 1 else 0] - 2.0 * slope[i] + slope[i - 1 if i > 0 else n - 1]
        right[i] = -_LESS * reach * bend
    _cyclic(_CONSTANT + 2.0 * _CURVED * reach, -_CURVED * reach, right, work[6], work[8])
    for i in range(n):
        d_q[i] += mean * right[i]


@_jit
def _cyclic(diagonal, side, value, factor, corner):
    """Solve a cyclic tridiagonal system of constant coefficients in place."""
    n = value.size
    lead = (
        diagonal - side
    )  # the band, to which side (1, 0, ..., 0, 1)^T (1, 0, ..., 0, 1) adds the ring's corners
    for i in range(n):
        corner[i] = 0.0
    corner[0] = corner[n - 1] = 1.0
    factor[0] = side / lead
    value[0] /= lead
    corner[0] /= lead
    for i in range(1, n):
        below = (lead if i == n - 1 else diagonal) - side * factor[i - 1]
        factor[i] = side / below
        value[i] = (value[i] - side * value[i - 1]) / below
        corner[i] = (corner[i] - side * corner[i - 1]) / below
    for i in range(n - 2, -1, -1):
        value[i] -= factor[i] * value[i + 1]
        corner[i] -= factor[i] * corner[i + 1]
    share = side * (value[0] + value[n - 1]) / (1.0 + side * (corner[0] + corner[n - 1]))
    for i in range(n):
        value[i] -= share * corner[i]


@_jit
def _drain(area, step, dt, mass, share):
    """Cut the mass fluxes so that no cell loses more than it has; nothing is lost on the way."""
    n = area.size
    for i in range(n):
        after = i + 1 if i < n - 1 else 0
        lost = dt / step * (max(mass[after], 0.0) - min(mass[i], 0.0))
        share[i] = area[i] / lost if lost > area[i] else 1.0
    for face in range(n):
        left = face - 1 if face > 0 else n - 1
        mass[face] *= share[left] if mass[face] > 0.0 else share[face]
