"""Baffles of a layer as an internal condition of the long waves at the cell faces where they stand.

Mass and momentum pass such a face as an orifice lets them [theory: baffles, eq. 5-8]. Lengths over R, times
in the unit of the spin given. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numba import njit

from fluid import long_wave
from fluid.fill import Fill
from fluid.friction import baffles
from meshes.arrays import Array
from meshes.errors import InputError

_OPTIONS: dict[str, Any] = {
    "cache": True,
    "fastmath": {"contract", "arcp", "nsz"},
    "error_model": "numpy",
    "_nrt": False,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
}
_jit: Any = njit(**_OPTIONS)

# Columns of a layer's table of baffles, one row each: the face, below 0 in rows that are not used; distances
# of the edges from the wall over R; a loss coefficient given over the mean depth, below 0 for the law; then
# what the last evaluation found: momentum taken from the liquid in a unit of time, power lost, and how open
# the face is.
FACE, TIP, GAP, LOSS, TORQUE, POWER, OPEN = range(7)
COLUMNS = 7
# Waves between two baffles need so many cells.
FEWEST_CELLS = 4
# A thin side of a face takes waves at least as fast as a layer of this share of the other's depth.
_THINNEST = 0.25
# A face with no more than this on both sides has nothing to let through.
_DRY = 1e-12

_share = _jit(baffles.open_share)
_contraction = _jit(baffles.contraction)
_celerity = _jit(long_wave.wave_celerity)
_CLOSED, _BEFORE = baffles.CLOSED, baffles.BEFORE


def table_of(fill: Fill, cells: int) -> Array:
    """A layer's table of baffles; each moves to the nearest face between two cells.

    Parameters
    ----------
    fill : chamber and liquid
    cells : round the wall

    Returns
    -------
    Shape (k, COLUMNS), k = 0 without baffles

    Raises
    ------
    InputError : baffles with less than four cells between two
    """
    plates, radius = fill.chamber.baffles, fill.chamber.radius
    if plates is None:
        return np.zeros((0, COLUMNS))
    if cells < FEWEST_CELLS * plates.count:
        raise InputError("cells", cells, f"at least {FEWEST_CELLS} between two of {plates.count} baffles")
    found = np.zeros((plates.count, COLUMNS))
    found[:, FACE] = np.round(plates.angles * cells / (2.0 * math.pi)) % cells
    found[:, TIP], found[:, GAP] = 1.0 - plates.tip_radius / radius, plates.wall_gap / radius
    found[:, LOSS] = -1.0 if plates.loss is None or fill.depth == 0.0 else plates.loss * radius / fill.depth
    found[:, OPEN] = 1.0
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
    """Head lost over the flow squared, K/(2 h^2); below 0 where nothing passes [theory: baffles, eq. 5].

    Parameters
    ----------
    depth : h at the baffle
    row : of the table
    """
    if row[LOSS] >= 0.0:
        return 0.5 * row[LOSS] / max(depth, 1e-12)
    share = _share(depth, row[TIP], row[GAP])
    if share <= _CLOSED:
        return -1.0
    lost = (1.0 / (_contraction(share) * share) - 1.0) / depth
    return 0.5 * lost * lost


@_jit
def _side(area, q, share, spin, full, slot, bed, other):
    """One side of a face: velocity, head, half the waves' speed over L, and that speed."""
    radius = np.sqrt(max(1.0 - 2.0 * area, 1e-3))
    velocity = share * (q + spin * area * area) / area if area > 1e-13 else 0.0
    turning = velocity / (radius * radius)
    log = _log(area)
    head = 0.5 * turning * velocity + spin * spin * area + 2.0 * spin * velocity * log - radius * bed
    stiff = slot if area > full else 0.0
    head += stiff * (area - full)
    # Where one side is a film the waves' speed of the other side counts: the film will be as deep.
    deep = max(log, _THINNEST * _log(other))
    half = _celerity(turning, log, spin)[1]
    wave = _celerity(turning, deep, spin)[1]
    half, wave = np.sqrt(half * half + log * stiff), np.sqrt(wave * wave + deep * stiff)
    return velocity, head, wave / max(deep, 1e-12), half


@_jit
def _log(area):
    """L of an area, kept off the axis."""
    return -0.5 * np.log(max(1.0 - 2.0 * area, 1e-3))


@_jit
def _depth(area):
    """Depth of an area, without cancellation in thin layers."""
    return 2.0 * area / (1.0 + np.sqrt(max(1.0 - 2.0 * area, 1e-3)))


@_jit
def obstruct(table, area, spin, full, slot, pull_face, before, after, mass, flow):
    """Put a layer's baffles in the way: mass and momentum fluxes through their faces, in place.

    The flux of momentum that stays is that of the cell before the face; the one after it gets less by what
    the baffle takes, the column TORQUE.

    Parameters
    ----------
    table : as by `table_of`; its last columns are results
    area : of the cells, shape (n,)
    spin : Omega
    full, slot : area of a full gap, and how the head rises with more
    pull_face : radial force at the faces, shape (n,)
    before, after : states on the two sides of each face, rows A, q, flux of mass and of momentum,
        pressure, shape (5 or more, n + 1)
    mass, flow : fluxes of an open face, changed where a baffle stands, shape (n + 1,)
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
        mass_l, mass_r = full_l * before[2, i], full_r * after[2, i]
        u_l, head_l, wave_l, half_l = _side(
            area_l, before[1, i], full_l, spin, full, slot, pull_face[i], area_r
        )
        u_r, head_r, wave_r, half_r = _side(
            area_r, after[1, i], full_r, spin, full, slot, pull_face[i], area_l
        )
        own_l = before[4, i] + full_l * (before[3, i] - before[4, i])
        own_r = after[4, i] + full_r * (after[3, i] - after[4, i])
        # The waves that leave the face link head and flow: dB = (Omega -+ c/L) dQ.
        out_l, out_r = wave_l - spin, wave_r + spin
        whole = wave_l + wave_r
        drive = head_l - head_r + out_l * mass_l + out_r * mass_r
        deep_l, deep_r = _depth(area_l), _depth(area_r)
        came, goes = (deep_l, deep_r) if drive > 0.0 else (deep_r, deep_l)
        held = resistance(_BEFORE * came + (1.0 - _BEFORE) * min(came, goes), row)
        free = drive / whole
        passed, open_ = 0.0, 0.0
        if held >= 0.0:
            size = abs(drive)
            passed = 2.0 * drive / (whole + np.sqrt(whole * whole + 4.0 * held * size))
            open_ = 1.0 / (1.0 + held * abs(passed) / whole)
        # What a face of this kind would let through if it were open; the scheme's own fluxes take its place.
        # Liquid that comes faster than its waves can leave again is stopped as a jet is.
        slope_l = min(u_l - spin * area_l - area_l * wave_l, half_l - u_l)
        slope_r = max(u_r - spin * area_r + area_r * wave_r, -half_r - u_r)
        flow_l = own_l + slope_l * (passed - mass_l) + open_ * (flow[i] - own_l - slope_l * (free - mass_l))
        flow_r = own_r + slope_r * (passed - mass_r) + open_ * (flow[i] - own_r - slope_r * (free - mass_r))
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
def taken(table):
    """Momentum and power that the baffles take together, in a unit of time."""
    torque, power = 0.0, 0.0
    for k in range(table.shape[0]):
        torque += table[k, TORQUE]
        power += table[k, POWER]
    return torque, power
