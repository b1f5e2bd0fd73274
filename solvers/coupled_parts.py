"""Small parts of the coupled time step: linear equations, the motor, a layer's momentum and inertia.

SI units. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

from typing import Any

from numba import njit

from solvers.face_flux import COMPILED
from solvers.machine import FLOW, INERTIA, MOMENT, RADIUS, WEIGHT

_jit: Any = njit(**COMPILED)


@_jit
def solve(matrix, right):
    """Solve a small dense system in place by elimination with pivots."""
    n = right.size
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            for j in range(n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
            right[k], right[best] = right[best], right[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k, n):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]


@_jit
def motor_torque(curve, spin):
    """Torque at a speed, by straight lines between the points of the motor's curve."""
    last = curve.shape[1] - 1
    if spin <= curve[0, 0]:
        return curve[1, 0]
    for k in range(last):
        if spin <= curve[0, k + 1]:
            part = (spin - curve[0, k]) / (curve[0, k + 1] - curve[0, k])
            return curve[1, k] + part * (curve[1, k + 1] - curve[1, k])
    return curve[1, last]


@_jit
def relative_momentum(measures, layer, spin, cosine, sine, out):
    """Momentum of a layer relative to its axis, in the standing frame [theory: coupling, eq. 3]."""
    scale = layer[WEIGHT] * layer[RADIUS] ** 3
    x = measures[FLOW] - spin * measures[MOMENT + 1]
    y = measures[FLOW + 1] + spin * measures[MOMENT]
    out[0], out[1] = scale * (x * cosine - y * sine), scale * (x * sine + y * cosine)


@_jit
def flow_inertia(measures, layer, c, s, out):
    """Inertia of a layer's flow under a body force, in the standing frame [theory: coupling, eq. 4]."""
    scale = layer[WEIGHT] * layer[RADIUS] ** 2
    xx, xy, yy = scale * measures[INERTIA], scale * measures[INERTIA + 1], scale * measures[INERTIA + 2]
    out[0] = c * c * xx - 2.0 * c * s * xy + s * s * yy
    out[1] = c * s * (xx - yy) + (c * c - s * s) * xy
    out[2] = s * s * xx + 2.0 * c * s * xy + c * c * yy
