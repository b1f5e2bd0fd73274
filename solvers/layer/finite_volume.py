"""Finite volumes for the annular long-wave equations: second order, well balanced, never below zero.

Unknowns of a cell: the liquid area per radian A and the relative angular momentum q = u A - Omega A^2, the
absolute one less Omega R^2 A, whose flux cancels [theory: long_wave, eq. 4]. Reconstructed are the static
head, so that equilibria stay as they are, and the velocity, both limited; the flux is HLL; time steps are
Heun's (SSP), with friction in two exact half steps around them [theory: long_wave, eq. 11]. Lengths over R,
times in the unit of the spin given.

Compiled by numba with its cache on disk; the equations are those of `fluid.long_wave`, the passes over the
faces `solvers.layer.face_flux`'s.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from fluid import long_wave
from solvers.layer.face_flux import (
    COMPILED,
    NEAREST,
    beds,
    half_slopes,
    hll,
    largest,
    log_of_surface,
    primitives,
    side,
    signals,
)

_jit: Any = njit(**COMPILED)

_inlined: Any = njit(inline="always")

_surface = _jit(long_wave.free_surface_radius)
_bernoulli = _jit(long_wave.bernoulli)
_CONSTANT, _CURVED, _LESS = long_wave.PADE

# Beyond this area the surface has come to the axis (r_s < 0.03): no layer is left to speak of.
FULL = 0.4995
# Cells by which the ring is continued beyond both its ends.
GHOSTS = 2
# Rows of scratch: of cells with ghosts, of faces, and of either side of the faces (area, q, flux of mass and
# of q, pressure, speeds). Only whole rows are contiguous to the compiler: they are taken one by one.
WORK = 25
_AREA, _PULL, _VELOCITY, _HEAD, _HALF_HEAD, _HALF_VELOCITY = range(6)
_BED, _SLOW, _FAST, _MASS, _FLOW = range(6, 11)
_AFTER, _BEFORE, _ROWS = 11, 18, 7


@_inlined
def ring_rates(area, q, spin, euler, pull_cell, pull_face, step, dt, spread, work, d_area, d_q):
    """`rates`, for callers that are compiled themselves: it becomes part of them."""
    _cells(area, q, spin, pull_cell, work)
    fastest = _faces(pull_face, spin, work)
    mass = work[_MASS]
    _drain(area, step, dt, mass, work[_FLOW], work[_BEFORE + 4], work[_AFTER + 4], work[_BED])
    _gather(area, euler, step, work, d_q)
    if spread > 0.0:
        _disperse(area, spin, pull_cell, step, spread, work, d_q)
    for i in range(area.size):
        d_area[i] = (mass[i] - mass[i + 1]) / step
    return fastest


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
    work : scratch, shape (WORK, n + 2 GHOSTS)
    d_area, d_q : results, shape (n,)
    """
    return ring_rates(area, q, spin, euler, pull_cell, pull_face, step, dt, spread, work, d_area, d_q)


@_inlined
def _cells(area, q, spin, pull, work):
    """Primitive variables of the cells and their half slopes, all round and a little further."""
    n = area.size
    end = n + GHOSTS
    for i in range(n):
        work[_AREA, i + GHOSTS] = area[i]
        work[_PULL, i + GHOSTS] = pull[i]
    primitives(area, q, spin, pull, work[_VELOCITY, GHOSTS:end], work[_HEAD, GHOSTS:end])
    for row in range(_HEAD + 1):
        for i in range(GHOSTS):
            work[row, i] = work[row, n + i]
            work[row, end + i] = work[row, GHOSTS + i]
    inner = slice(1, n + 3)
    half_head, half_velocity = work[_HALF_HEAD, inner], work[_HALF_VELOCITY, inner]
    half_slopes(work[_AREA], work[_HEAD], work[_VELOCITY], spin, half_head, half_velocity)


@_inlined
def _faces(pull_face, spin, work):
    """Fluxes through each cell's left face, and once more through the first; returns the largest speed."""
    n = pull_face.size
    m = n + 1
    bed = work[_BED, :m]
    for i in range(n):
        bed[i] = pull_face[i]
    bed[n] = pull_face[0]
    wide, pull = work[_AREA], work[_PULL]
    beds(wide[1:], wide[2:], pull[1:], pull[2:], bed)
    for k in range(2):
        # First the cell after each face, then the one before it.
        cells, row, way = slice(2 - k, m + 2 - k), _AFTER + k * _ROWS, 2.0 * k - 1.0
        side(
            wide[cells],
            work[_HEAD, cells],
            work[_HALF_HEAD, cells],
            work[_VELOCITY, cells],
            work[_HALF_VELOCITY, cells],
            bed,
            way,
            spin,
            work[row],
            work[row + 1],
            work[row + 2],
            work[row + 3],
            work[row + 4],
            work[row + 5],
            work[row + 6],
        )
    after, before = _AFTER, _BEFORE
    slow, fast = work[_SLOW, :m], work[_FAST, :m]
    signals(
        work[before],
        work[after],
        work[before + 5],
        work[after + 5],
        work[before + 6],
        work[after + 6],
        slow,
        fast,
    )
    for k in range(2):
        flux = work[_MASS + k, :m]
        hll(slow, fast, work[before + 2 + k], work[after + 2 + k], work[before + k], work[after + k], flux)
    return largest(slow, fast)


@_inlined
def _gather(area, euler, step, work, d_q):
    """Rate of change of q from the fluxes, the force within each cell and the Euler force.

    Inside a cell the force is A dB/dtheta, by the trapezium of its two ends.
    """
    n = area.size
    flow, bend = work[_FLOW], work[_HALF_HEAD, GHOSTS : n + GHOSTS]
    area_l, push_l = work[_BEFORE], work[_BEFORE + 4]
    area_r, push_r = work[_AFTER], work[_AFTER + 4]
    for i in range(n):
        through = (flow[i + 1] - push_l[i + 1]) - (flow[i] - push_r[i])
        within = (area_l[i + 1] + area_r[i]) * bend[i]
        d_q[i] = -euler * area[i] - (through + within) / step


@_jit
def _disperse(area, spin, pull, step, spread, work, d_q):
    """Add what the finite depth takes from the pressure gradient [theory: long_wave, eq. 12].

    The gradient g of Bernoulli's function counts as tanh(nL)/(nL) of itself: what is missing, y, solves
    (15 - 6 L^2 d^2) y = -5 L^2 d^2 g. Weighted with the mean area it exerts no net torque; cells with less
    than half of that feel less.
    """
    n = area.size
    velocity, head, slope = work[_VELOCITY, GHOSTS:], work[_AFTER], work[_AFTER + 1]
    right = work[_AFTER + 2, :n]
    for i in range(n):
        surface = np.maximum(_surface(area[i]), NEAREST)
        log = log_of_surface(area[i], surface)
        head[i] = _bernoulli(velocity[i], log, area[i], surface, spin, pull[i])
    head[n], head[n + 1] = head[0], head[1]
    for i in range(n + 1):
        slope[i] = (head[i + 1] - head[i - 1 if i > 0 else n - 1]) / (2.0 * step)
    slope[n + 1] = slope[1]
    reach, mean = spread / (step * step), 0.0
    for i in range(n):
        bend = slope[i + 1] - 2.0 * slope[i] + slope[i - 1 if i > 0 else n - 1]
        right[i] = -_LESS * reach * bend
        mean += area[i] / n
    solve_ring(_CONSTANT + 2.0 * _CURVED * reach, _CURVED * reach, right)
    for i in range(n):
        # A film shorter of liquid than half the mean would be torn by the mean layer's share.
        d_q[i] += min(mean, 2.0 * area[i]) * right[i]


@_jit
def solve_ring(diagonal, side, value):
    """Solve diagonal y_i - side (y_{i-1} + y_{i+1}) = value_i round a ring, in place.

    With diagonal > 2 side >= 0 the matrix is c (1 - p S)(1 - p S^T), S being the shift by one cell: a sweep
    each way, each started with the value that it will end with.
    """
    n = value.size
    root = 0.5 * (diagonal + np.sqrt((diagonal - 2.0 * side) * (diagonal + 2.0 * side)))
    ratio = side / root
    whole = 1.0 - np.exp(n * np.log(ratio)) if ratio > 0.0 else 1.0
    carried = 0.0
    for i in range(n):
        carried = value[i] + ratio * carried
    carried /= whole
    for i in range(n):
        carried = value[i] + ratio * carried
        value[i] = carried / root
    carried = 0.0
    for i in range(n):
        carried = value[n - 1 - i] + ratio * carried
    carried /= whole
    for i in range(n):
        carried = value[n - 1 - i] + ratio * carried
        value[n - 1 - i] = carried


@_inlined
def _drain(area, step, dt, mass, flow, push_l, push_r, share):
    """Cut the mass fluxes so that no cell loses more than it has; nothing is lost on the way.

    The flow beyond the pressure is cut alike: a film that kept its mass and lost the momentum of more, or the
    other way round, would run away.
    """
    n = area.size
    for i in range(n):
        lost = dt / step * (np.maximum(mass[i + 1], 0.0) - np.minimum(mass[i], 0.0))
        share[i + 1] = area[i] / lost if lost > area[i] else 1.0
    share[0], share[n + 1] = share[n], share[1]
    for face in range(n + 1):
        kept = share[face] if mass[face] > 0.0 else share[face + 1]
        mass[face] *= kept
        flow[face] -= (1.0 - kept) * (flow[face] - 0.5 * (push_l[face] + push_r[face]))
