"""Baffles of a layer as an internal condition of the long waves at the cell faces where they stand.

Mass and momentum pass such a face as an orifice lets them [theory: baffles, eq. 5-10]. Where fewer than four
cells stand between two baffles, their resistance is a sink of momentum all over the layer instead
[theory: baffles, eq. 11-12]. Lengths over R, times in the unit of the spin given.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from fluid import long_wave
from fluid.fill import Fill
from fluid.friction import baffles
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.layer.places import FEWEST_CELLS, is_smeared
from solvers.machine_code import BARE, machine_code

_OPTIONS: dict[str, Any] = {
    "fastmath": {"contract", "arcp", "nsz"},
    "error_model": "numpy",
    "_nrt": False,
}
_jit: Any = machine_code(**(_OPTIONS | BARE))

# Columns of a layer's table of baffles, one row each: the face, below 0 in rows that are not used; distances
# of the edges from the wall over R; a loss coefficient given over the mean depth, below 0 for the law; then
# what the last evaluation found: momentum taken from the liquid in a unit of time, power lost, and how open
# the face is. A row of smeared baffles has no face, and last their number over 2 pi, otherwise 0.
FACE, TIP, GAP, LOSS, TORQUE, POWER, OPEN, DENSITY = range(8)
COLUMNS = 8
# A thin side of a face takes waves at least as fast as a layer of this share of the other's depth.
_THINNEST = 0.25
# A face with no more than this on both sides has nothing to let through.
_DRY = 1e-12
# A baffle that takes no more than this of its flow squared is none.
_WEAKEST = 1e-12
# Rounds for what piles up before a baffle, and what may be left of it; the bore that runs back is no slower
# than this share of its waves; an area over R^2 that no pile comes to.
_ROUNDS, _SETTLED, _SLOWEST, _DEEPEST = 60, 1e-12, 0.05, 0.45
# Cells between two baffles from which on each end of the piece has three of its own for its slopes.
_FEWEST_ASIDE = 6

# Steps towards the depth that piles up before smeared baffles, and the share of it that may be left.
_STEPS, _LEFT = 30, 1e-9

_share = _jit(baffles.open_share)
_contraction = _jit(baffles.contraction)
_celerity = _jit(long_wave.wave_celerity)
_stiffness = _jit(long_wave.slot_stiffness)
_CLOSED, _BEFORE = baffles.CLOSED, baffles.BEFORE


def table_of(fill: Fill, cells: int, smeared: bool | None = None) -> Array:
    """A layer's table of baffles: each at the nearest face between two cells, or all of them smeared.

    Shape (k, COLUMNS), k = 0 without baffles, 1 with smeared ones; `smeared` None: the cells decide.
    Compartments with less than four cells in each are refused.
    """
    plates, radius = fill.chamber.baffles, fill.chamber.radius
    if plates is None:
        return np.zeros((0, COLUMNS))
    smears = is_smeared(fill, cells) if smeared is None else smeared
    if smears and fill.compartments > 1:
        text = f"{FEWEST_CELLS * plates.count} or more, {FEWEST_CELLS} in each of {plates.count} compartments"
        raise InputError("cells", cells, text)
    found = np.zeros((1 if smears else plates.count, COLUMNS))
    found[:, FACE] = -1.0 if smears else np.round(plates.angles * cells / (2.0 * math.pi)) % cells
    found[:, DENSITY] = plates.count / (2.0 * math.pi) if smears else 0.0
    found[:, TIP], found[:, GAP] = 1.0 - plates.tip_radius / radius, plates.wall_gap / radius
    found[:, LOSS] = -1.0 if plates.loss is None or fill.depth == 0.0 else plates.loss * radius / fill.depth
    found[:, OPEN] = 0.0 if fill.compartments > 1 else 1.0
    return found


def tables_of(fills: Sequence[Fill], cells: int) -> Array:
    """Tables of several layers, filled up with rows that are not used, shape (l, k, COLUMNS)."""
    tables = [table_of(fill, cells) for fill in fills]
    found = np.zeros((len(tables), max((len(table) for table in tables), default=0), COLUMNS))
    found[:, :, FACE] = -1.0
    for rows, table in zip(found, tables, strict=True):
        rows[: len(table)] = table
    return found


@_jit
def resistance(depth, row):
    """Head lost over the flow squared, K/(2 h^2); below 0 where nothing passes [theory: baffles, eq. 5]."""
    if row[LOSS] >= 0.0:
        return 0.5 * row[LOSS] / max(depth, 1e-12)
    share = _share(depth, row[TIP], row[GAP])
    if share <= _CLOSED:
        return -1.0
    lost = (1.0 / (_contraction(share) * share) - 1.0) / max(depth, 1e-12)
    return 0.5 * lost * lost


@_jit
def shut(area, row):
    """Whether a baffle lets nothing pass of a layer of this area."""
    return resistance(_depth(area), row) < 0.0


@_jit
def wall_beds(table, pull_face, area, bed, ghosts):
    """Let closed baffles bear the liquid to their own place, however dry the other side: walls, in `bed`."""
    n = pull_face.size
    for k in range(table.shape[0]):
        i = int(table[k, FACE])
        if i >= 0 and shut(max(area[i + ghosts - 1], area[i + ghosts]), table[k]):
            bed[i] = pull_face[i]
            bed[n] = bed[0]


@_jit
def _side(area, q, share, way, spin, full, slot, bed, other):
    """One side of a face: velocity, head, half the waves' speed over L, that speed, and how much is left.

    `way` is 1 before the face and -1 after it. Liquid that runs away from the baffle faster than its waves
    would tell it nothing of what lies behind: it counts as fast as they are [theory: baffles, eq. 10].
    """
    radius = np.sqrt(max(1.0 - 2.0 * area, 1e-3))
    velocity = share * (q + spin * area * area) / area if area > 1e-13 else 0.0
    log = _log(area)
    stiff = _stiffness(area, full, slot)
    half = _celerity(velocity / (radius * radius), log, spin)[1]
    half = np.sqrt(half * half + log * stiff)
    left = half / -(way * velocity) if way * velocity < -half else 1.0
    velocity *= left
    turning = velocity / (radius * radius)
    head = 0.5 * turning * velocity + spin * spin * area + 2.0 * spin * velocity * log - radius * bed
    head += slot * max(area - full, 0.0)
    # Where one side is a film the waves' speed of the other side counts: the film will be as deep.
    deep = max(log, _THINNEST * _log(other))
    wave = _celerity(turning, deep, spin)[1]
    wave = np.sqrt(wave * wave + deep * stiff)
    return velocity, head, wave / max(deep, 1e-12), half, left


@_jit
def _log(area):
    """L of an area, kept off the axis."""
    return -0.5 * np.log(max(1.0 - 2.0 * area, 1e-3))


@_jit
def _depth(area):
    """Depth of an area, without cancellation in thin layers."""
    return 2.0 * area / (1.0 + np.sqrt(max(1.0 - 2.0 * area, 1e-3)))


@_jit
def _piled(area, mass, passed, velocity, half, spin, most, star):
    """Area that stands before a baffle, behind the bore that runs back from it if `star` stands there.

    `mass`, `passed` and `velocity` count towards the baffle, `spin` as well [theory: baffles, eq. 9].
    """
    if mass <= passed:
        return area
    log = _log(star)
    flow = passed / log
    other = _celerity(flow / max(1.0 - 2.0 * star, 1e-3), log, spin)[1]
    back = 0.5 * (half + other - velocity - flow - spin * (_log(area) + log))
    wanted = area + (mass - passed) / max(back, _SLOWEST * other)
    return max(min(wanted, most), area)


@_jit
def _past(drive, whole, before, behind, row):
    """Flow past a baffle between two depths, with the sign of `drive`, and its resistance; eq. 5."""
    held = resistance(_BEFORE * before + (1.0 - _BEFORE) * min(before, behind), row)
    if held < 0.0:
        return 0.0, held
    return 2.0 * drive / (whole + np.sqrt(whole * whole + 4.0 * held * abs(drive))), held


@_jit
def _through(sides, row, most):
    """Flow past a baffle and its resistance, below 0 where it is closed [theory: baffles, eq. 5 and 9].

    `sides`: drive and Z of eq. 5, spin, then area, flow, velocity and waves' speed before and after the face.
    More passes where more is piled up, and less is left to pile up: one area between the layer's and `most`
    is its own answer, found by false position with halves (Illinois).
    """
    drive, whole, spin, area_l, mass_l, u_l, half_l, area_r, mass_r, u_r, half_r = sides
    way, area, mass, u, half, behind = 1.0, area_l, mass_l, u_l, half_l, _depth(area_r)
    if drive <= 0.0:
        way, area, mass, u, half, behind = -1.0, area_r, -mass_r, -u_r, half_r, _depth(area_l)
    low, high = area, max(most, area)
    more, less, star, last = 0.0, 0.0, area, 0
    passed, held = 0.0, 0.0
    for tried in range(_ROUNDS):
        passed, held = _past(drive, whole, _depth(star), behind, row)
        miss = _piled(area, mass, way * passed, u, half, way * spin, max(most, area), star) - star
        if abs(miss) <= _SETTLED * star:
            break
        if miss > 0.0:
            less = 0.5 * less if last > 0 else less
            low, more, last = star, miss, 1
        else:
            more = 0.5 * more if last < 0 else more
            high, less, last = star, miss, -1
        star = high if tried == 0 else low + (high - low) * more / (more - less)
    return passed, held


@_jit
def _aside(ratio):
    """Slope of a cell beside a baffle over its difference from the next one.

    3/2 - ratio/2 is right to second order, `ratio` being the difference after that over this one. Where the
    profile turns over there is no jump: rotor and liquid would not agree on an acceleration.
    """
    return min(1.0, 2.0 * ratio, max(1.5 - 0.5 * ratio, 0.0))


@_jit
def slope_aside(table, area, full, value, half, ghosts):
    """Put half slopes of cells beside baffles, which know their own side alone, to second order, in place.

    Values and slopes of the cells have shape (n + 2 ghosts,).
    """
    n = area.size
    # The two ends of a short piece would share cells and make a stiff whole of it: no slopes there.
    plain = n < _FEWEST_ASIDE * table.shape[0]
    for k in range(2 * table.shape[0]):
        i, way = int(table[k // 2, FACE]), 2 * (k % 2) - 1
        if i < 0:
            continue
        one = (i + (way - 1) // 2) % n
        wet = area[one] > _DRY
        if wet and 0.0 <= resistance(_depth(area[one]), table[k // 2]) <= _WEAKEST:
            continue
        two, three = (one + way) % n, (one + 2 * way) % n
        least, most = min(area[one], area[two], area[three]), max(area[one], area[two], area[three])
        near = value[two + ghosts] - value[one + ghosts]
        far = value[three + ghosts] - value[two + ghosts]
        # Next to a dry cell there is no slope, nor where the gap begins to be full.
        smooth = near * far > 0.0 and least > _DRY and (most <= full or least > full)
        half[one + ghosts] = 0.5 * way * near * _aside(far / near) if smooth and not plain else 0.0
        if one == n - 1:
            half[ghosts - 1] = half[one + ghosts]
        if one == 0:
            half[n + ghosts] = half[one + ghosts]


@_jit
def straighten(table, n, value, bent, ghosts):
    """Make straight again, in place, the cells beside baffles, where they were parabolas.

    `bent` are the means of what cells have at their two faces, with ghosts as `value`.
    """
    for k in range(2 * table.shape[0]):
        i, way = int(table[k // 2, FACE]), 2 * (k % 2) - 1
        if i < 0:
            continue
        beside = (i + (way - 1) // 2) % n
        bent[beside + ghosts] = value[beside + ghosts]
        if beside == n - 1:
            bent[ghosts - 1] = value[ghosts - 1]
        if beside == 0:
            bent[n + ghosts] = value[n + ghosts]


@_jit
def obstruct(table, area, spin, full, slot, pull_face, before, after, mass, flow):
    """Put a layer's baffles in the way: mass and momentum fluxes through their faces, in place.

    The flux of momentum that stays is that of the cell before the face; the one after it gets less by what
    the baffle takes, the column TORQUE. `before` and `after` have the states on the two sides of each face,
    rows A, q, flux of mass and of momentum, pressure, shape (5 or more, n + 1); `mass` and `flow` the fluxes
    of an open face.
    """
    n = pull_face.size
    for k in range(table.shape[0]):
        row = table[k]
        row[TORQUE], row[POWER], row[OPEN] = 0.0, 0.0, 1.0
        i = int(row[FACE])
        if i < 0:
            continue
        area_l, area_r = before[0, i], after[0, i]
        if max(area_l, area_r) <= _DRY:
            continue
        # A film beside the face has less to give than its state at the face, which slopes with the bed.
        full_l = min(1.0, 2.0 * area[i - 1] / max(area_l, 1e-300))
        full_r = min(1.0, 2.0 * area[i] / max(area_r, 1e-300))
        u_l, head_l, wave_l, half_l, left_l = _side(
            area_l, before[1, i], full_l, 1.0, spin, full, slot, pull_face[i], area_r
        )
        u_r, head_r, wave_r, half_r, left_r = _side(
            area_r, after[1, i], full_r, -1.0, spin, full, slot, pull_face[i], area_l
        )
        mass_l, mass_r = full_l * left_l * before[2, i], full_r * left_r * after[2, i]
        own_l = before[4, i] + full_l * left_l * left_l * (before[3, i] - before[4, i])
        own_r = after[4, i] + full_r * left_r * left_r * (after[3, i] - after[4, i])
        # The waves that leave the face link head and flow: dB = (Omega -+ c/L) dQ.
        out_l, out_r = wave_l - spin, wave_r + spin
        whole = wave_l + wave_r
        drive = head_l - head_r + out_l * mass_l + out_r * mass_r
        sides = drive, whole, spin, area_l, mass_l, u_l, half_l, area_r, mass_r, u_r, half_r
        passed, held = _through(sides, row, min(full, _DEEPEST))
        open_ = 1.0 / (1.0 + held * abs(passed) / whole) if held >= 0.0 else 0.0
        free = drive / whole
        # What a face of this kind would let through if it were open; the scheme's own fluxes take its place.
        # Liquid that comes faster than its waves can leave again is stopped as a jet is.
        slope_l = min(u_l - spin * area_l - area_l * wave_l, half_l - u_l)
        slope_r = max(u_r - spin * area_r + area_r * wave_r, -half_r - u_r)
        flow_l = own_l + slope_l * (passed - mass_l) + open_ * (flow[i] - own_l - slope_l * (free - mass_l))
        flow_r = own_r + slope_r * (passed - mass_r) + open_ * (flow[i] - own_r - slope_r * (free - mass_r))
        if held < 0.0:
            # A wall presses on liquid that runs away from it by no more than its rest, and never pulls.
            flow_l = min(max(flow_l, 0.0), before[4, i]) if mass_l < 0.0 else max(flow_l, before[4, i])
            flow_r = min(max(flow_r, 0.0), after[4, i]) if mass_r > 0.0 else max(flow_r, after[4, i])
        through = passed + open_ * (mass[i] - free)
        row[TORQUE], row[OPEN] = flow_l - flow_r, open_
        row[POWER] = max(held, 0.0) * abs(passed) * passed * passed
        mass[i], flow[i] = through, flow_l
        if i == 0:
            mass[n], flow[n] = through, flow_l


@_jit
def take(table, step, d_q):
    """Take from the cells after the baffles what these take from the flow of momentum."""
    for k in range(table.shape[0]):
        i = int(table[k, FACE])
        if i >= 0:
            d_q[i] -= table[k, TORQUE] / step


@_jit
def keep_heat(table, step, d_energy):
    """Keep from the fluctuations what is heat at the baffles, from the cells on both sides alike."""
    for k in range(table.shape[0]):
        i = int(table[k, FACE])
        if i >= 0:
            d_energy[i - 1] -= 0.5 * table[k, POWER] / step
            d_energy[i] -= 0.5 * table[k, POWER] / step


@_jit
def smeared_resistance(depth, head, row):
    """`resistance` of one of many baffles to the flow of a layer that piles up before each.

    The depth before them grows from that of the layer to the fixed point by Newton's method, `head` being
    u^2/(4 g) of the flow past them; the function is convex and falls, so that no step goes too far
    [theory: baffles, eq. 3 and 11].
    """
    if row[LOSS] >= 0.0:
        return 0.5 * row[LOSS] / max(depth, 1e-12)
    before, loss = depth, 0.0
    for _ in range(_STEPS):
        share = _share(before, row[TIP], row[GAP])
        if share <= _CLOSED:
            return -1.0
        lost = 1.0 / (_contraction(share) * share) - 1.0
        loss = lost * lost * depth / before
        # A little deeper, for the slope.
        deeper = 1.000001 * before
        share = _share(deeper, row[TIP], row[GAP])
        lost = 1.0 / (_contraction(share) * share) - 1.0
        slope = (lost * lost * depth / deeper - loss) / (deeper - before)
        missing = depth + loss * head - before
        if missing <= _LEFT * before:
            break
        before += missing / (1.0 - slope * head)
    return 0.5 * loss / (depth * depth)


@_jit
def smear(table, area, q, spin, step, dt, d_q):
    """Take from all cells what smeared baffles take, in `d_q`, TORQUE and POWER.

    Rows of baffles at faces stay as they are. A step by Heun's method with these rates is of second order and
    stops no flow beyond rest.
    """
    for k in range(table.shape[0]):
        row = table[k]
        if row[DENSITY] <= 0.0:
            continue
        row[TORQUE], row[POWER] = 0.0, 0.0
        for i in range(area.size):
            if area[i] <= _DRY:
                continue
            velocity, depth, log = q[i] / area[i] + spin * area[i], _depth(area[i]), _log(area[i])
            # Mean of the squared radii of wall and surface.
            middle = max(1.0 - area[i], 1e-3)
            own = spin + velocity / middle
            head = velocity * velocity / (4.0 * max(own * own, 1e-12) * middle * np.sqrt(middle))
            held = smeared_resistance(depth, head, row)
            pull = row[DENSITY] * (held if held >= 0.0 else 1e12) * log * log * abs(velocity)
            pull /= np.sqrt(1.0 + (pull * dt) ** 2)
            row[TORQUE] += step * area[i] * pull * velocity
            row[POWER] += step * log * pull * velocity * velocity
            d_q[i] -= area[i] * pull * velocity


@_jit
def taken(table):
    """Momentum and power that the baffles take together, in a unit of time."""
    torque, power = 0.0, 0.0
    for k in range(table.shape[0]):
        torque += table[k, TORQUE]
        power += table[k, POWER]
    return torque, power
