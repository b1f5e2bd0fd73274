"""States on both sides of the faces between cells, and the flux through them, by passes over the whole ring.

Every pass is free of branches and reads arrays straight through, so that the compiler turns it into vector
instructions; together they cost a third of a loop that decides cell by cell. Lengths over R
[theory: long_wave, eq. 11]. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from fluid import long_wave

# Products and sums may be contracted, zeros lose their signs; the order of sums stays. Views of arrays need
# no reference counts here, and what only compiled code calls no wrappers: less to compile.
COMPILED: dict[str, Any] = {
    "cache": True,
    "fastmath": {"contract", "arcp", "nsz"},
    "error_model": "numpy",
    "_nrt": False,
}
_jit: Any = njit(**(COMPILED | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}))

_surface = _jit(long_wave.free_surface_radius)
_head = _jit(long_wave.static_head)
_at_head = _jit(long_wave.surface_at_head)
_mass = _jit(long_wave.mass_flux)
_momentum = _jit(long_wave.momentum_flux)
_pressure = _jit(long_wave.pressure_force)
_celerity = _jit(long_wave.wave_celerity)

# Below this area (of R^2) a cell is dry: its velocity is not known to any digit.
DRY = 1e-13
THIN = 1e-8
# The surface of a face comes no nearer to the axis.
NEAREST = 0.03
# Keeps quotients of nothing by nothing at nothing.
_NOTHING = 1e-300


@_jit
def log_of_surface(area: float, surface: float) -> float:
    """L = ln(1/r) for r >= 0.03, to rounding for any area down to nothing.

    With p = r^(1/8), L = 16 artanh((1 - p)/(1 + p)), whose argument is below 0.22; 1 - p is taken from the
    area, so that thin films keep their digits. Unlike log1p it vectorises.
    """
    half = np.sqrt(surface)
    quarter = np.sqrt(half)
    eighth = np.sqrt(quarter)
    whole = (1.0 + surface) * (1.0 + half) * (1.0 + quarter) * (1.0 + eighth) * (1.0 + eighth)
    z = 2.0 * area / whole
    y = z * z
    total = 1.0 / 25.0
    total = total * y + 1.0 / 23.0
    total = total * y + 1.0 / 21.0
    total = total * y + 1.0 / 19.0
    total = total * y + 1.0 / 17.0
    total = total * y + 1.0 / 15.0
    total = total * y + 1.0 / 13.0
    total = total * y + 1.0 / 11.0
    total = total * y + 1.0 / 9.0
    total = total * y + 1.0 / 7.0
    total = total * y + 1.0 / 5.0
    total = total * y + 1.0 / 3.0
    total = total * y + 1.0
    result: float = 16.0 * z * total
    return result


@_jit
def faded_velocity(area: float, q: float, spin: float) -> float:
    """Velocity along the wall, faded out in films thinner than THIN, where its digits are gone."""
    square = area * area
    faded: float = 2.0 * (q + spin * square) * area / (square + np.maximum(square, THIN * THIN))
    return faded if area > DRY else 0.0


@_jit
def primitives(area, q, spin, pull, velocity, head):
    """Fill velocity and static head of each cell; arrays of one shape."""
    for i in range(area.size):
        velocity[i] = faded_velocity(area[i], q[i], spin)
        head[i] = _head(area[i], _surface(area[i]), spin, pull[i])


@_jit
def _half_slope(back: float, ahead: float) -> float:
    """Half of the monotonised central slope."""
    central = 0.25 * (back + ahead)
    least = min(abs(central), abs(back), abs(ahead))
    slope: float = least if central > 0.0 else -least
    return slope if back * ahead > 0.0 else 0.0


@_jit
def half_slopes(area, head, velocity, spin, half_head, half_velocity):
    """Half of the slopes of a ring's cells but the first and the last, limited wave by wave.

    Differences of head and velocity are split into those that the two waves of the cell carry, of which
    du/dA = (lambda - u/r^2)/L [theory: long_wave, eq. 3]. Next to a dry cell there is no slope.
    """
    n = half_head.size
    area_b, area_m, area_a = area[:n], area[1 : n + 1], area[2 : n + 2]
    head_b, head_m, head_a = head[:n], head[1 : n + 1], head[2 : n + 2]
    velocity_b, velocity_m, velocity_a = velocity[:n], velocity[1 : n + 1], velocity[2 : n + 2]
    for i in range(n):
        wet = min(area_b[i], area_m[i], area_a[i]) > DRY
        surface = np.maximum(_surface(area_m[i]), NEAREST)
        # In a film the split has no digits, and it is not used.
        log = log_of_surface(area_m[i], surface) if wet else 1.0
        mean, half = _celerity(velocity_m[i], log, surface, spin)
        carried = mean - velocity_m[i] / (surface * surface)
        # Velocity over head of the wave that runs ahead and of the other one.
        scale = 1.0 / (log * spin * spin)
        ahead, behind = (carried + half) * scale, (carried - half) * scale
        share = 1.0 / (ahead - behind)
        head_1, head_2 = head_m[i] - head_b[i], head_a[i] - head_m[i]
        velocity_1, velocity_2 = velocity_m[i] - velocity_b[i], velocity_a[i] - velocity_m[i]
        first = _half_slope((velocity_1 - behind * head_1) * share, (velocity_2 - behind * head_2) * share)
        second = _half_slope((ahead * head_1 - velocity_1) * share, (ahead * head_2 - velocity_2) * share)
        half_head[i] = first + second if wet else 0.0
        half_velocity[i] = ahead * first + behind * second if wet else 0.0


@_jit
def beds(area_l, area_r, pull_l, pull_r, bed):
    """Put the higher bed, the smaller radial force of the two cells', at faces next to a dry one."""
    for i in range(bed.size):
        wet = np.minimum(area_l[i], area_r[i]) > DRY
        bed[i] = bed[i] if wet else np.minimum(pull_l[i], pull_r[i])


@_jit
def side(
    cell_area,
    head,
    half_head,
    velocity,
    half_velocity,
    bed,
    way,
    spin,
    area,
    momentum,
    mass,
    flow,
    push,
    back,
    ahead,
):
    """State and fluxes on one side of each face.

    Parameters
    ----------
    cell_area, head, half_head, velocity, half_velocity : of the cell on that side of each face
    bed : radial force at the faces
    way : 1 for the cell before the face, -1 for the one after it
    spin : Omega
    area, momentum : results, the state A and q at the face
    mass, flow, push : results, its fluxes of mass and of momentum, and the pressure's share of the latter
    back, ahead : results, its characteristic speeds
    """
    for i in range(bed.size):
        wet = cell_area[i] > DRY
        # Where the push exceeds the centrifugal force no surface has this head: the least radius stands in.
        level = np.maximum(_at_head(head[i] + way * half_head[i], spin, bed[i]), NEAREST)
        r = level if wet else 1.0
        u = velocity[i] + way * half_velocity[i] if wet else 0.0
        a = 0.5 * (1.0 - r) * (1.0 + r)
        log = log_of_surface(a, r)
        area[i], momentum[i] = a, u * a - spin * a * a
        mass[i], push[i] = _mass(u, log), _pressure(a, r, spin, bed[i])
        flow[i] = _momentum(u, log, a, r) + push[i]
        mean, half = _celerity(u, log, r, spin)
        back[i], ahead[i] = mean - half, mean + half


@_jit
def signals(area_l, area_r, back_l, back_r, ahead_l, ahead_r, slow, fast):
    """Slowest and fastest wave from each face, at most and at least zero [theory: long_wave, eq. 3]."""
    for i in range(slow.size):
        back, ahead = np.minimum(back_l[i], back_r[i]), np.maximum(ahead_l[i], ahead_r[i])
        # A front on a dry bed runs ahead of the liquid at twice the waves' speed relative to it.
        back = 1.5 * back_r[i] - 0.5 * ahead_r[i] if area_l[i] == 0.0 else back
        ahead = 1.5 * ahead_l[i] - 0.5 * back_l[i] if area_r[i] == 0.0 else ahead
        slow[i], fast[i] = np.minimum(back, 0.0), np.maximum(ahead, 0.0)


@_jit
def hll(slow, fast, left, right, state_l, state_r, flux):
    """Flux of Harten, Lax and van Leer from the two sides' fluxes and states."""
    for i in range(flux.size):
        width = 1.0 / (fast[i] - slow[i] + _NOTHING)
        jump = fast[i] * slow[i] * (state_r[i] - state_l[i])
        flux[i] = (fast[i] * left[i] - slow[i] * right[i] + jump) * width


@_jit
def largest(slow, fast):
    """Largest speed either way; a speed that is not a number counts as infinite."""
    found = 0.0
    for i in range(slow.size):
        speed = np.maximum(-slow[i], fast[i])
        if not speed <= found:
            found = speed if speed > found else np.inf
    return found
