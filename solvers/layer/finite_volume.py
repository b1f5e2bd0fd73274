"""Finite volumes for the annular long-wave equations: second order, well balanced, never below zero.

Unknowns of a cell: the liquid area per radian A and the relative angular momentum q = u A - Omega A^2, the
absolute one less Omega R^2 A, whose flux cancels [theory: long_wave, eq. 4]. Reconstructed are the static
head, so that equilibria stay as they are, and the velocity, both limited; the flux is HLL; time steps are
Heun's (SSP), with friction in two exact half steps around them [theory: long_wave, eq. 11]. Lengths over R,
times in the unit of the spin given. Every pass over the ring is free of branches and reads arrays straight
through, so that the compiler turns it into vector instructions.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fluid import long_wave
from meshes.arrays import Array
from solvers.layer.baffles import (
    FACE,
    OPEN,
    keep_heat,
    obstruct,
    slope_aside,
    smear,
    straighten,
    take,
    wall_beds,
)
from solvers.machine_code import BARE, BOTH, FLAG, REAL, ROW, ROWS, handed_type, machine_code

# Products and sums may be contracted, zeros lose their signs; the order of sums stays. Views of arrays need
# no reference counts here: less to compile.
COMPILED: dict[str, Any] = {
    "fastmath": {"contract", "arcp", "nsz"},
    "error_model": "numpy",
    "_nrt": False,
    "nogil": True,
}
# Where a gap is full speeds count twice for the step. A ramp within a cell stays within its neighbours in
# steps of half a cell: with longer ones, as of a Courant number of 0.8, a gap that fills and empties rings.
PRESSED = 2.0
_face_jit: Any = machine_code(**(COMPILED | BARE))
# Sums and largest values over a ring, in parts that the compiler chooses once and for all: the same numbers
# give the same sum.
SUMMED: dict[str, Any] = COMPILED | {
    "fastmath": {"contract", "arcp", "nsz", "reassoc", "nnan"},
    "settled": True,
}
_sum_jit: Any = machine_code(**(SUMMED | BARE))

_surface = _face_jit(long_wave.free_surface_radius)
_head = _face_jit(long_wave.static_head)
_at_head = _face_jit(long_wave.surface_at_head)
_mass = _face_jit(long_wave.mass_flux)
_momentum = _face_jit(long_wave.momentum_flux)
_pressure = _face_jit(long_wave.pressure_force)
_celerity = _face_jit(long_wave.wave_celerity)

# Below this area (of R^2) a cell is dry: its velocity is not known to any digit.
DRY = 1e-13
# A film thinner than this (area over R^2) sticks to the wall: 2.5 um in a drum of 0.25 m, where Stokes' layer
# is some tenths of a mm. Without a fade what a draining cell keeps of its momentum makes its speed, rounding
# of it rules the steps, and no two processors agree.
THIN = 1e-5
# The surface of a face comes no nearer to the axis.
NEAREST = 0.03
# Share of its own rotation in whose field liquid counts as held.
HELD = 2.0 / 3.0
# Keeps quotients of nothing by nothing at nothing.
_NOTHING = 1e-300

# Skew of the slopes by which a face lies on its cell's parabola.
THIRD = 1.0 / 12.0

_LOG_4 = 1.3862943611198906


@_face_jit
def log_and_inverse(area: float, surface: float) -> tuple[float, float]:
    """L = ln(1/r) and 1/r^2 for r >= 0.03, to rounding for any area down to nothing.

    With a c of 1, 4 or 16 that brings c r above 0.48, L = ln c + 2 artanh z, z = (1 - c r)/(1 + c r) up to
    0.352. For c = 1 the numerator times 1 + r is twice the area, so that thin films keep their digits. artanh
    z over z is a polynomial in z^2, right to 2e-17. No branch, no root, one division: it vectorises.
    """
    near = surface >= 0.5
    scale = 1.0 if near else (4.0 if surface >= 0.125 else 16.0)
    begin = 0.0 if near else (_LOG_4 if surface >= 0.125 else 2.0 * _LOG_4)
    scaled = scale * surface
    above = 2.0 * area if near else (1.0 - scaled) * (1.0 + scaled)
    below = (1.0 + scaled) * (1.0 + scaled)
    square = surface * surface
    quotient = 1.0 / (below * square)
    z = above * square * quotient
    y = z * z
    # The polynomial in z^2 through ten Chebyshev points of what artanh z/z adds to 1, over z^2.
    total = 0.08595651784385513
    total = total * y + 0.041446293257421704
    total = total * y + 0.06053446533638424
    total = total * y + 0.06651188202397319
    total = total * y + 0.0769316491415723
    total = total * y + 0.090908803768947
    total = total * y + 0.11111111661167948
    total = total * y + 0.14285714280380316
    total = total * y + 0.2000000000002001
    total = total * y + 0.3333333333333332
    return begin + 2.0 * z * (1.0 + y * total), below * quotient


@_face_jit
def log_of_surface(area: float, surface: float) -> float:
    """L alone, as by `log_and_inverse`."""
    log: float = log_and_inverse(area, surface)[0]
    return log


@_face_jit
def faded_velocity(area: float, q: float, spin: float) -> float:
    """Velocity along the wall, faded out in films thinner than THIN."""
    square = area * area
    faded: float = 2.0 * (q + spin * square) * area / (square + np.maximum(square, THIN * THIN))
    return faded if area > DRY else 0.0


@_face_jit
def primitives(area, q, spin, held, pull, full, slot, first, velocity, head, surface):
    """Fill velocity, head in the field of a rotation `held` and radius of the surface of each cell.

    The first cell stands at `first` in the last three arrays. Beyond the area `full` the head rises by `slot`
    times what is more [theory: long_wave, eq. 18].
    """
    for i in range(area.size):
        rim = _surface(area[i])
        surface[i + first], velocity[i + first] = rim, faded_velocity(area[i], q[i], spin)
        pressed = slot * np.maximum(area[i] - full, 0.0)
        head[i + first] = _head(area[i], rim, held, pull[i]) + pressed


@_face_jit
def _limited(back: float, ahead: float, skew: float) -> tuple[float, float]:
    """Half of a cell's slope, and what both its faces have beyond its mean; limited, 0 where it is a crest.

    A face takes a quarter of each difference, behind and ahead, and `skew` more of that across it and less
    of the other: 0 is the monotonised central slope, 1/12 the parabola within Koren's limits.
    """
    near, far = 0.25 + skew, 0.25 - skew
    least = min(abs(back), abs(ahead))
    up = min(abs(far * back + near * ahead), least)
    down = min(abs(near * back + far * ahead), least)
    way = 0.5 if back + ahead > 0.0 else -0.5
    half, bend = way * (up + down), way * (up - down)
    same = back * ahead > 0.0
    return (half if same else 0.0), (bend if same else 0.0)


@_face_jit
def half_slopes(
    area,
    head,
    velocity,
    surface,
    spin,
    held,
    full,
    slot,
    half_head,
    half_velocity,
    log,
    bent_head,
    bent_velocity,
):
    """Half of the slopes of a ring's cells but the first and the last, limited wave by wave; and their L.

    Differences of head and velocity are split into those that the two waves of the cell carry, of which
    du/dA = (lambda - u/r^2)/L = Omega +- c/L, c half the difference of the speeds [theory: long_wave, eq. 3].
    Next to a dry cell there is no slope, nor where the gap begins to be full. `bent_head` and `bent_velocity`
    are the means of what a cell has at its two faces by parabolas, which make faces right to third order
    [theory: long_wave, eq. 20]; None: the slopes are straight.
    """
    skew = 0.0
    if bent_head is not None:
        skew = THIRD
    for i in range(1, area.size - 1):
        here, before, after = area[i], area[i - 1], area[i + 1]
        least, most = min(before, here, after), max(before, here, after)
        wet = least > DRY and (most <= full or least > full)
        r = np.maximum(surface[i], NEAREST)
        log[i], inverse = log_and_inverse(here, r)
        # In a film the split has no digits, and it is not used.
        length = log[i] if wet else 1.0
        _, half = _celerity(velocity[i] * inverse, length, spin)
        stiff = slot if here > full else 0.0
        half = np.sqrt(half * half + length * stiff) if stiff > 0.0 else half
        # Velocity over head of the wave that runs ahead and of the other one, times Omega^2 L; the inverse of
        # their difference.
        carried, weight = spin * length, (held * held + stiff) * length
        ahead, behind = carried + half, carried - half
        quotient = 1.0 / (half * weight)
        share = 0.5 * weight * quotient
        head_1, head_2 = head[i] - head[i - 1], head[i + 1] - head[i]
        velocity_1 = weight * (velocity[i] - velocity[i - 1])
        velocity_2 = weight * (velocity[i + 1] - velocity[i])
        first, first_bend = _limited(velocity_1 - behind * head_1, velocity_2 - behind * head_2, skew)
        second, second_bend = _limited(ahead * head_1 - velocity_1, ahead * head_2 - velocity_2, skew)
        half_head[i] = (first + second) * share if wet else 0.0
        half_velocity[i] = 0.5 * (ahead * first + behind * second) * quotient if wet else 0.0
        if bent_head is not None:
            bend = 0.5 * (ahead * first_bend + behind * second_bend) * quotient
            bent_head[i] = head[i] + ((first_bend + second_bend) * share if wet else 0.0)
            bent_velocity[i] = velocity[i] + (bend if wet else 0.0)


@_face_jit
def beds(pull_face, area, pull, bed):
    """Radial force at the faces, (n + 1,); next to a dry cell the higher bed, the smaller of the two cells'.

    `area` and `pull` of the cells with ghosts.
    """
    n = pull_face.size
    for i in range(n):
        bed[i] = pull_face[i]
    bed[n] = pull_face[0]
    for i in range(n + 1):
        wet = np.minimum(area[i + 1], area[i + 2]) > DRY
        bed[i] = bed[i] if wet else np.minimum(pull[i + 1], pull[i + 2])


@_face_jit
def side(
    cell_area,
    head,
    half_head,
    velocity,
    half_velocity,
    bed,
    faces,
    first,
    way,
    spin,
    held,
    full,
    slot,
    area,
    momentum,
    mass,
    flow,
    push,
    back,
    ahead,
):
    """State and fluxes on one side of each face, and its characteristic speeds; the results stand last.

    The cell of the first face stands at `first`; `way` is 1 for the cell before the face, -1 after it; head
    and velocity are the means of a cell's two faces, `bed` the radial force at the faces, `push` the
    pressure's share of the flux of momentum.
    """
    rim = np.sqrt(np.maximum(1.0 - 2.0 * full, 0.0)) if full < 0.5 else -1.0
    for i in range(faces):
        k = i + first
        wet = cell_area[k] > DRY
        # Where the push exceeds the centrifugal force no surface has this head: the least radius stands in.
        here = head[k] + way * half_head[k]
        level = np.maximum(_at_head(here, held, bed[i]), NEAREST)
        # Beyond the full gap the head is that of the slot, on a straight line.
        beyond = here - held * held * full + rim * bed[i]
        pressed = full + beyond / (slot + held * held + bed[i] / rim)
        level = np.sqrt(np.maximum(1.0 - 2.0 * pressed, NEAREST * NEAREST)) if level < rim else level
        r = level if wet else 1.0
        u = velocity[k] + way * half_velocity[k] if wet else 0.0
        a = 0.5 * (1.0 - r) * (1.0 + r)
        log, inverse = log_and_inverse(a, r)
        area[i], momentum[i] = a, u * a - spin * a * a
        mass[i], push[i] = _mass(u, log), _pressure(a, r, spin, bed[i])
        stiff = slot if a > full else 0.0
        push[i] += 0.5 * stiff * (a - full) * (a + full)
        flow[i] = _momentum(u, log, a, inverse) + push[i]
        mean, half = _celerity(u * inverse, log, spin)
        # Where the gap fills and empties from step to step the waves in it count twice as fast. A cell with
        # less than half of a full gap fills it at no face: its state there is deep by the steep bed alone.
        quick = stiff if 2.0 * cell_area[k] > full else 0.0
        half = np.sqrt(half * half + 4.0 * log * quick) if quick > 0.0 else half
        back[i], ahead[i] = mean - half, mean + half


@_face_jit
def signals(area_l, area_r, back_l, back_r, ahead_l, ahead_r, faces, slow, fast):
    """Slowest and fastest wave from each face, at most and at least zero [theory: long_wave, eq. 3]."""
    for i in range(faces):
        back, ahead = np.minimum(back_l[i], back_r[i]), np.maximum(ahead_l[i], ahead_r[i])
        # A front on a dry bed runs ahead of the liquid at twice the waves' speed relative to it.
        back = 1.5 * back_r[i] - 0.5 * ahead_r[i] if area_l[i] == 0.0 else back
        ahead = 1.5 * ahead_l[i] - 0.5 * back_l[i] if area_r[i] == 0.0 else ahead
        slow[i], fast[i] = np.minimum(back, 0.0), np.maximum(ahead, 0.0)


@_face_jit
def hll(slow, fast, mass_l, mass_r, flow_l, flow_r, area_l, area_r, q_l, q_r, faces, mass, flow):
    """Fluxes of Harten, Lax and van Leer from the two sides' fluxes and states."""
    for i in range(faces):
        width = 1.0 / (fast[i] - slow[i] + _NOTHING)
        left, right, both = fast[i] * width, slow[i] * width, fast[i] * slow[i] * width
        mass[i] = left * mass_l[i] - right * mass_r[i] + both * (area_r[i] - area_l[i])
        flow[i] = left * flow_l[i] - right * flow_r[i] + both * (q_r[i] - q_l[i])


@_sum_jit
def _greatest(slow, fast, faces):
    """Largest speed either way; any number where one is not a number."""
    found = 0.0
    for i in range(faces):
        speed = fast[i] if fast[i] > -slow[i] else -slow[i]
        found = speed if speed > found else found
    return found


@_sum_jit
def most(values):
    """Largest of some numbers."""
    found = values[0]
    for i in range(values.size):
        found = values[i] if values[i] > found else found
    return found


@_face_jit
def largest(slow, fast, faces):
    """Largest speed either way; a speed that is not a number counts as infinite."""
    bad = 0
    for i in range(faces):
        bad += 0 if fast[i] - slow[i] < np.inf else 1
    return _greatest(slow, fast, faces) if bad == 0 else np.inf


_jit: Any = machine_code(**COMPILED)
_both: Any = machine_code(**(COMPILED | BOTH))

_bernoulli = _face_jit(long_wave.bernoulli)
_CONSTANT, _CURVED, _LESS = long_wave.PADE

# Beyond this area the surface has come to the axis (r_s < 0.03): no layer is left to speak of.
FULL = 0.4995
# Cells by which the ring is continued beyond both its ends.
GHOSTS = 2
# Rows of scratch: of cells with ghosts, of faces, and of either side of the faces (area, q, flux of mass and
# of q, pressure, speeds). Only whole rows are contiguous to the compiler: they are taken one by one.
WORK = 31
_AREA, _PULL, VELOCITY, _HEAD, SURFACE, _HALF_HEAD, _HALF_VELOCITY, LOG = range(8)
_BED, _SLOW, _FAST, _MASS, _FLOW = range(8, 13)
_AFTER, _BEFORE, _ROWS = 13, 20, 7
_ROLLER, _POWER, _BENT_HEAD, _BENT_VELOCITY = range(27, 31)

# Decay of the fluctuations behind a bore, over their own speed and the depth; from jumps and breaking waves.
DECAY = 0.48
# No fluctuations in films thinner than this; their energy is at most this share of Omega^2 A.
NO_ROLLER, MOST_ROLLER = 1e-5, 0.25


@_sum_jit
def _held(area, q, spin):
    """Rotation in whose field liquid lies on the wall: the drum's, or 2/3 of its own where that is more.

    Heads and areas of a face follow from one another in this field [theory: long_wave, eq. 5-6]. A drum that
    is braked leaves its liquid behind, and its own field would not hold it against the force on its axis.
    """
    inertia, relative = 0.0, 0.0
    for i in range(area.size):
        inertia += area[i] * (1.0 - area[i])
        relative += q[i] + spin * area[i] * area[i]
    own = spin + relative / np.maximum(inertia, _NOTHING)
    return np.maximum(abs(spin), HELD * abs(own))


@_both
def plain_rates(
    area,
    q,
    energy,
    spin,
    euler,
    pull_cell,
    pull_face,
    plates,
    full,
    slot,
    step,
    dt,
    dispersion,
    work,
    d_area,
    d_q,
    d_energy,
):
    """`rates` of a ring without baffles whose waves neither disperse nor leave fluctuations behind them."""
    pressed, held = slot * spin * spin, _held(area, q, spin)
    _cells(area, q, spin, held, pull_cell, full, pressed, work)
    half_slopes(
        *(work[_AREA], work[_HEAD], work[VELOCITY], work[SURFACE], spin, held, full, pressed),
        *(work[_HALF_HEAD], work[_HALF_VELOCITY], work[LOG], None, None),
    )
    beds(pull_face, work[_AREA], work[_PULL], work[_BED])
    fastest = _faces(pull_face, spin, held, full, pressed, _HEAD, VELOCITY, work, None)
    _drain(area, step, dt, work[_MASS], work[_FLOW], work[_BEFORE + 4], work[_AFTER + 4], work[_BED])
    _gather(area, euler, spin, held, step, work, d_area, d_q)
    return fastest


@_both
def baffled_rates(
    area,
    q,
    energy,
    spin,
    euler,
    pull_cell,
    pull_face,
    plates,
    full,
    slot,
    step,
    dt,
    dispersion,
    work,
    d_area,
    d_q,
    d_energy,
):
    """`rates` of a ring with baffles whose waves neither disperse nor leave fluctuations behind them."""
    pressed, held = slot * spin * spin, _held(area, q, spin)
    mass, flow = work[_MASS], work[_FLOW]
    _cells(area, q, spin, held, pull_cell, full, pressed, work)
    half_slopes(
        *(work[_AREA], work[_HEAD], work[VELOCITY], work[SURFACE], spin, held, full, pressed),
        *(work[_HALF_HEAD], work[_HALF_VELOCITY], work[LOG], None, None),
    )
    slope_aside(plates, area, full, work[_HEAD], work[_HALF_HEAD], GHOSTS)
    slope_aside(plates, area, full, work[VELOCITY], work[_HALF_VELOCITY], GHOSTS)
    beds(pull_face, work[_AREA], work[_PULL], work[_BED])
    wall_beds(plates, pull_face, work[_AREA], work[_BED], GHOSTS)
    fastest = _faces(pull_face, spin, held, full, pressed, _HEAD, VELOCITY, work, None)
    obstruct(plates, area, spin, full, pressed, pull_face, work[_BEFORE:], work[_AFTER:], mass, flow)
    _drain(area, step, dt, mass, flow, work[_BEFORE + 4], work[_AFTER + 4], work[_BED])
    _gather(area, euler, spin, held, step, work, d_area, d_q)
    take(plates, step, d_q)
    smear(plates, area, q, spin, step, dt, d_q)
    return fastest


@_both
def no_rates(
    area,
    q,
    energy,
    spin,
    euler,
    pull_cell,
    pull_face,
    plates,
    full,
    slot,
    step,
    dt,
    dispersion,
    work,
    d_area,
    d_q,
    d_energy,
):
    """Stands for `rates` where there is no ring."""
    return 0.0


@_both
def rates(
    area,
    q,
    energy,
    spin,
    euler,
    pull_cell,
    pull_face,
    plates,
    full,
    slot,
    step,
    dt,
    dispersion,
    work,
    d_area,
    d_q,
    d_energy,
):
    """Rates of change of A, q and, behind bores, A e; returns the largest characteristic speed.

    `energy` is A e of the fluctuations and `d_energy` its rate of change, of no cells where they are left
    out; `pull_cell` and `pull_face` are f_r at the cells' middles and at their left faces, `euler` the rate
    of change of the spin; `plates`, `full` and `slot` as in `solvers.layer.inside.Inside`; `dt` the time step
    in which no cell may lose more than it has, `work` scratch, (WORK, n + 2 GHOSTS).
    """
    pressed, held = slot * spin * spin, _held(area, q, spin)
    _cells(area, q, spin, held, pull_cell, full, pressed, work)
    # Only where waves disperse are the equations good enough for parabolas to show.
    if dispersion:
        half_slopes(
            *(work[_AREA], work[_HEAD], work[VELOCITY], work[SURFACE], spin, held, full, pressed),
            *(work[_HALF_HEAD], work[_HALF_VELOCITY], work[LOG]),
            *(work[_BENT_HEAD], work[_BENT_VELOCITY]),
        )
    else:
        half_slopes(
            *(work[_AREA], work[_HEAD], work[VELOCITY], work[SURFACE], spin, held, full, pressed),
            *(work[_HALF_HEAD], work[_HALF_VELOCITY], work[LOG], None, None),
        )
    slope_aside(plates, area, full, work[_HEAD], work[_HALF_HEAD], GHOSTS)
    slope_aside(plates, area, full, work[VELOCITY], work[_HALF_VELOCITY], GHOSTS)
    straighten(plates, area.size, work[_HEAD], work[_BENT_HEAD], GHOSTS)
    straighten(plates, area.size, work[VELOCITY], work[_BENT_VELOCITY], GHOSTS)
    beds(pull_face, work[_AREA], work[_PULL], work[_BED])
    wall_beds(plates, pull_face, work[_AREA], work[_BED], GHOSTS)
    head, velocity = (_BENT_HEAD, _BENT_VELOCITY) if dispersion else (_HEAD, VELOCITY)
    rolling = work[_ROLLER, : energy.size + 2 * GHOSTS if energy.size > 0 else 0]
    if energy.size > 0:
        fluctuations(area, energy, spin, rolling)
    fastest = _faces(pull_face, spin, held, full, pressed, head, velocity, work, rolling)
    mass, flow = work[_MASS], work[_FLOW]
    obstruct(plates, area, spin, full, pressed, pull_face, work[_BEFORE:], work[_AFTER:], mass, flow)
    _drain(area, step, dt, mass, flow, work[_BEFORE + 4], work[_AFTER + 4], work[_BED])
    _gather(area, euler, spin, held, step, work, d_area, d_q)
    take(plates, step, d_q)
    if energy.size > 0:
        # The faces' higher beds are gone by now: next to a dry cell there are no fluctuations.
        roller_rates(area, d_q, spin, euler, pull_cell, pull_face, step, work, d_energy)
        keep_heat(plates, step, d_energy)
    smear(plates, area, q, spin, step, dt, d_q)
    if dispersion:
        _disperse(area, spin, pull_cell, plates, step, work, d_q)
    return fastest


# Of `rates`, and of those that take its place where a ring has less.
RATES: Any = handed_type(
    *(REAL, ROW, ROW, ROW, REAL, REAL, ROW, ROW, ROWS, REAL, REAL, REAL, REAL, FLAG, ROWS, ROW, ROW, ROW)
)


def rates_of(plates: Array, dispersion: bool, enstrophy: bool) -> Any:
    """The rates of rings with these features."""
    if dispersion or enstrophy:
        return rates
    return baffled_rates if plates.shape[-2] else plain_rates


@_face_jit
def _cells(area, q, spin, held, pull, full, slot, work):
    """Primitive variables of the cells, all round and a little further."""
    n = area.size
    end = n + GHOSTS
    for i in range(n):
        work[_AREA, i + GHOSTS] = area[i]
        work[_PULL, i + GHOSTS] = pull[i]
    primitives(area, q, spin, held, pull, full, slot, GHOSTS, work[VELOCITY], work[_HEAD], work[SURFACE])
    for row in range(SURFACE + 1):
        for i in range(GHOSTS):
            work[row, i] = work[row, n + i]
            work[row, end + i] = work[row, GHOSTS + i]


@_face_jit
def _faces(pull_face, spin, held, full, slot, head, velocity, work, rolling):
    """Fluxes through each cell's left face, and once more through the first; returns the largest speed.

    `head` and `velocity`: rows of what the cells have at their faces on the whole; `rolling`: energy of their
    fluctuations with ghosts, or None.
    """
    m, bed, wide, slow, fast = pull_face.size + 1, work[_BED], work[_AREA], work[_SLOW], work[_FAST]
    for k in range(2):
        # First the cell after each face, then the one before it.
        row, way = _AFTER + k * _ROWS, 2.0 * k - 1.0
        side(
            *(wide, work[head], work[_HALF_HEAD], work[velocity], work[_HALF_VELOCITY], bed, m, 2 - k, way),
            *(spin, held, full, slot, work[row], work[row + 1], work[row + 2], work[row + 3], work[row + 4]),
            *(work[row + 5], work[row + 6]),
        )
        if rolling is not None and rolling.size > 0:
            lifted(rolling[2 - k :], work[row], work[row + 3], work[row + 5], work[row + 6], m)
    after, before = _AFTER, _BEFORE
    area_l, area_r = work[before], work[after]
    signals(
        *(area_l, area_r, work[before + 5], work[after + 5], work[before + 6], work[after + 6], m, slow, fast)
    )
    hll(
        *(slow, fast, work[before + 2], work[after + 2], work[before + 3], work[after + 3], area_l, area_r),
        *(work[before + 1], work[after + 1], m, work[_MASS], work[_FLOW]),
    )
    quicker = PRESSED if most(wide) > full else 1.0
    return quicker * largest(slow, fast, m)


@_face_jit
def _gather(area, euler, spin, held, step, work, d_area, d_q):
    """Rates of change of A and q from the fluxes, the force within each cell and the Euler force.

    Inside a cell the force is A dB/dtheta, by the trapezium of its two ends; a film on a steep bed, whose
    state at an end is deeper than twice its own, is pushed as what there is of it. Heads in a stronger field
    than the drum's rise by what it adds as well.
    """
    n, more = area.size, 0.5 * (held - spin) * (held + spin)
    mass, flow, bend = work[_MASS], work[_FLOW], work[_HALF_HEAD]
    area_l, push_l = work[_BEFORE], work[_BEFORE + 4]
    area_r, push_r = work[_AFTER], work[_AFTER + 4]
    for i in range(n):
        through = (flow[i + 1] - push_l[i + 1]) - (flow[i] - push_r[i])
        most = 2.0 * area[i]
        rise = bend[i + GHOSTS] - more * (area_l[i + 1] - area_r[i])
        within = (np.minimum(area_l[i + 1], most) + np.minimum(area_r[i], most)) * rise
        d_q[i] = -euler * area[i] - (through + within) / step
        d_area[i] = (mass[i] - mass[i + 1]) / step


@_face_jit
def fluctuations(area, energy, spin, rolling):
    """Energy e of the fluctuations of each cell, with ghosts [theory: long_wave, eq. 15]."""
    n = area.size
    for i in range(n):
        a = area[i]
        most = MOST_ROLLER * spin * spin * a
        rolling[i + GHOSTS] = np.minimum(energy[i] / a, most) if a > NO_ROLLER else 0.0
    for i in range(GHOSTS):
        rolling[i] = rolling[n + i]
        rolling[n + GHOSTS + i] = rolling[GHOSTS + i]


@_face_jit
def lifted(rolling, area, flow, back, ahead, faces):
    """Add the fluctuations' pressure 2 A e to the momentum flux of a side, and to its waves' speeds."""
    for i in range(faces):
        e = rolling[i]
        flow[i] += 2.0 * area[i] * e
        mean, half = 0.5 * (back[i] + ahead[i]), 0.5 * (ahead[i] - back[i])
        half = np.sqrt(half * half + 6.0 * e)
        back[i], ahead[i] = mean - half, mean + half


@_face_jit
def roller_rates(area, d_q, spin, euler, pull, pull_face, step, work, d_energy):
    """Rate of change of A e of the fluctuations behind bores [theory: long_wave, eq. 16-17].

    What the fluxes take from the energy of the mean flow feeds them, with numerical fluxes for that energy of
    the same kind as for mass and momentum; they are carried along, and decay.
    """
    n = area.size
    slow, fast, mass, power = work[_SLOW], work[_FAST], work[_MASS], work[_POWER]
    rolling, velocity = work[_ROLLER], work[VELOCITY]
    for i in range(n + 1):
        bed = pull_face[i] if i < n else pull_face[0]
        flux_l, held_l = _energy_flux(
            work[_BEFORE, i], work[_BEFORE + 1, i], work[_BEFORE + 2, i], rolling[i + GHOSTS - 1], spin, bed
        )
        flux_r, held_r = _energy_flux(
            work[_AFTER, i], work[_AFTER + 1, i], work[_AFTER + 2, i], rolling[i + GHOSTS], spin, bed
        )
        width = 1.0 / (fast[i] - slow[i] + _NOTHING)
        left, right, both = fast[i] * width, slow[i] * width, fast[i] * slow[i] * width
        through = left * work[_BEFORE + 2, i] - right * work[_AFTER + 2, i]
        through += both * (work[_AFTER, i] - work[_BEFORE, i])
        # Where a cell runs dry the mass flux was cut, and the energy's with it.
        kept = mass[i] / through if abs(through) > _NOTHING else 1.0
        power[i] = kept * (left * flux_l - right * flux_r + both * (held_r - held_l))
    for i in range(n):
        a, u, log = area[i], velocity[i + GHOSTS], work[LOG, i + GHOSTS]
        radius = np.maximum(work[SURFACE, i + GHOSTS], NEAREST)
        flow = u * log
        # Derivatives of the mean flow's energy by A and by q.
        by_area = flow * (2.0 * spin - u / np.maximum(a, DRY)) + 0.5 * u * u / (radius * radius)
        by_area += spin * spin * a - radius * pull[i]
        by_q = flow / np.maximum(a, DRY)
        rate_a, rate_q = (mass[i] - mass[i + 1]) / step, d_q[i] + euler * a
        lost = -by_area * rate_a - by_q * rate_q - (power[i + 1] - power[i]) / step
        e = rolling[i + GHOSTS]
        entered = mass[i] * (rolling[i + GHOSTS - 1] if mass[i] > 0.0 else e)
        left_it = mass[i + 1] * (e if mass[i + 1] > 0.0 else rolling[i + GHOSTS + 1])
        depth = 2.0 * a / (1.0 + radius)
        decay = 0.5 * DECAY * a * 2.0 * e * np.sqrt(2.0 * e) / np.maximum(depth, DRY)
        d_energy[i] = (entered - left_it) / step + lost - decay if a > NO_ROLLER else 0.0


@_face_jit
def _energy_flux(area, q, mass, rolling, spin, bed):
    """Flux of the mean flow's energy through a face and that energy, with the body force's potential."""
    radius = np.sqrt(np.maximum(1.0 - 2.0 * area, NEAREST * NEAREST))
    u = (q + spin * area * area) / area if area > DRY else 0.0
    level = 0.5 * u * u / (radius * radius) + spin * spin * area - radius * bed
    lever = (1.0 - radius) * (1.0 + radius + radius * radius) / 3.0
    energy = 0.5 * u * mass + 0.5 * spin * spin * area * area - bed * lever
    return mass * (level + spin * mass + 2.0 * rolling), energy


@_face_jit
def _disperse(area, spin, pull, plates, step, work, d_q):
    """Add what the finite depth takes from the flux of momentum [theory: long_wave, eq. 12-14].

    Serre's pressure over the layer is A L^2 (2 u'^2 - a')/3, a = y - g* being the acceleration that moves
    along; at y' stands 6/15 for 1/3, for short waves' sake. y solves
    15 A y - 6 (A L^2 y')' = -5 (A L^2 (g*' + 2 u'^2))', and A y is added as the difference of fluxes: no
    torque, whatever the areas.
    Faces next to a dry cell let none through.
    """
    n = area.size
    velocity, radius, logs = work[VELOCITY, GHOSTS:], work[SURFACE, GHOSTS:], work[LOG, GHOSTS:]
    head, reach = work[_AFTER], work[_AFTER + 1]
    face, slope, push = work[_AFTER + 2], work[_AFTER + 3], work[_AFTER + 4]
    diagonal, value = work[_AFTER + 5, :n], work[_AFTER + 6, :n]
    for i in range(n):
        surface, log = np.maximum(radius[i], NEAREST), logs[i]
        # Without the flow's own square: what is left is the acceleration that moves along.
        carried = velocity[i] / surface
        head[i] = _bernoulli(velocity[i], log, area[i], surface, spin, pull[i]) - 0.5 * carried * carried
        reach[i] = area[i] * log * log if area[i] > DRY else 0.0
    for i in range(n):
        before = i - 1 if i > 0 else n - 1
        face[i] = 2.0 * reach[i] * reach[before] / (reach[i] + reach[before] + _NOTHING)
        push[i] = face[i] * (head[i] - head[before])
    # A baffle holds the waves' own pressure back as it does the flow.
    for k in range(plates.shape[0]):
        i = int(plates[k, FACE])
        if i >= 0:
            face[i] *= plates[k, OPEN]
            push[i] *= plates[k, OPEN]
    face[n], push[n] = face[0], push[0]
    for i in range(n):
        # Of the two sides' differences the deeper one's counts: a film has none of its own.
        slope[i] = (push[i] + push[i + 1]) / (step * (face[i] + face[i + 1]) + _NOTHING)
    for i in range(n):
        before = i - 1 if i > 0 else n - 1
        stretch = velocity[i] - velocity[before]
        bend = slope[i] - slope[before] + 2.0 * stretch * stretch / step
        push[i] = _LESS / (_CONSTANT * step) * face[i] * bend
        face[i] *= _CURVED / (_CONSTANT * step * step)
    face[n], push[n] = face[0], push[0]
    for i in range(n):
        diagonal[i] = area[i] + face[i] + face[i + 1] + _NOTHING
        value[i] = (push[i] - push[i + 1]) / step
    solve_ring(diagonal, face, value, slope)
    for i in range(n):
        before = i - 1 if i > 0 else n - 1
        push[i] -= face[i] * step * (value[i] - value[before])
    push[n] = push[0]
    for i in range(n):
        d_q[i] += (push[i] - push[i + 1]) / step


@_jit
def solve_ring(diagonal, side, value, spare):
    """Solve diagonal_i y_i - side_i y_{i-1} - side_{i+1} y_{i+1} = value_i round a ring, in place.

    Elimination, and the two corners by the formula of Sherman and Morrison. The matrix must be positive
    definite. `diagonal` is left with the pivots' inverses; `side` has n + 1 entries, the last the first once
    more.
    """
    n = value.size
    last, first, share = n - 1, diagonal[0], side[0] / diagonal[0]
    diagonal[last] += side[0] * share
    diagonal[0] = 0.5 / first
    spare[0] = 1.0
    for i in range(1, n):
        factor = side[i] * diagonal[i - 1]
        spare[i] = factor * spare[i - 1] + (share if i == last else 0.0)
        value[i] += factor * value[i - 1]
        diagonal[i] = 1.0 / (diagonal[i] - factor * side[i])
    value[last] *= diagonal[last]
    spare[last] *= diagonal[last]
    for i in range(n - 2, -1, -1):
        value[i] = (value[i] + side[i + 1] * value[i + 1]) * diagonal[i]
        spare[i] = (spare[i] + side[i + 1] * spare[i + 1]) * diagonal[i]
    gained = value[0] + share * value[last]
    gained /= 1.0 / first - spare[0] - share * spare[last]
    for i in range(n):
        value[i] += gained * spare[i]


@_face_jit
def _drain(area, step, dt, mass, flow, push_l, push_r, share):
    """Cut the mass fluxes so that no cell loses more than it has; nothing is lost on the way.

    The flow beyond the pressure is cut alike: a film that kept its mass and lost the momentum of more, or the
    other way round, would run away.
    """
    n, rate, empty = area.size, dt / step, 0
    for i in range(n):
        lost = rate * (np.maximum(mass[i + 1], 0.0) - np.minimum(mass[i], 0.0))
        share[i + 1] = lost
        empty += 1 if lost > area[i] else 0
    if empty == 0:
        return
    for i in range(n):
        share[i + 1] = area[i] / share[i + 1] if share[i + 1] > area[i] else 1.0
    share[0], share[n + 1] = share[n], share[1]
    for face in range(n + 1):
        kept = share[face] if mass[face] > 0.0 else share[face + 1]
        # Where nothing passes, as at a closed baffle, there is nothing to cut.
        kept = 1.0 if mass[face] == 0.0 else kept
        mass[face] *= kept
        push_l[face] = flow[face] - kept * (flow[face] - push_l[face])
        push_r[face] = flow[face] - kept * (flow[face] - push_r[face])
