"""One time step of the law of the wall: the mean flow's friction, then that of the waves [theory: friction].

Unconditionally stable and of second order, cell by cell; the waves' part leaves the angular momentum of the
layer to rounding. Lengths over R, times in the unit of the law's rates. Compiled by numba with its cache on
disk.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from solvers.layer.finite_volume import COMPILED, DRY, SUMMED

_bare: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_part: Any = njit(**COMPILED)
_inner_part: Any = njit(**(COMPILED | _bare))
_sum_part: Any = njit(**(SUMMED | _bare))


@_inner_part
def mean_rate(table, top, slip):
    """Rate over 1/h + 2/h_c at which friction takes a slip, and half of 1 - p; see `fluid.friction.wall`."""
    last = table.shape[0] - 1
    ratio = slip / top
    beyond = ratio if ratio > 1.0 else 1.0
    # Written so that what is no number is the table's end.
    place = np.sqrt(np.sqrt(ratio if ratio < 1.0 else 1.0)) * last
    k = min(int(place), last - 1)
    part = place - k
    rate = (table[k, 0] + part * (table[k + 1, 0] - table[k, 0])) * beyond * top
    return rate, table[k, 1]


@_inner_part
def _slow_mean(area, velocity, surface, lid, top, table, dt, kept):
    """Share of each cell's velocity that the mean part leaves: (1 + p x)^(-1/p) to second order in x."""
    for i in range(area.size):
        depth = np.maximum(2.0 * area[i] / (1.0 + surface[i]), DRY)
        rate, bend = mean_rate(table, top, abs(velocity[i]) / (1.0 - area[i]))
        x = rate * (1.0 / depth + lid) * dt
        kept[i] = 1.0 / (1.0 + x * (1.0 + bend * x))


@_sum_part
def _weigh(area, velocity, surface, coefficient, plates, thin, dt, kept, gone):
    """Share of its velocity beside the mean that a cell loses; sums of momentum and mass, so weighted."""
    momentum, mass = 0.0, 0.0
    for i in range(area.size):
        depth = 2.0 * area[i] / (1.0 + surface[i])
        area_i = np.maximum(area[i], DRY)
        # depth/(depth + thin), which a dry cell without waves has as well.
        faded = depth / np.maximum(depth + thin, DRY)
        x = coefficient * (1.0 + plates * depth) / area_i * faded * dt
        x = x * (1.0 + 0.5 * x)
        share = x / (1.0 + x)
        gone[i] = share
        momentum += share * area[i] * kept[i] * velocity[i]
        mass += share * area[i]
    return momentum, mass


@_part
def wall_kept(area, velocity, surface, coefficient, wall, dt, kept, pushed):
    """What the law of the wall makes of each cell's velocity in a time dt: kept u + pushed.

    Parameters
    ----------
    area, velocity, surface : A, u and r_s, shape (n,)
    coefficient : of the waves' part on the wall
    wall : lid, plates, thin, top and table, see `fluid.friction.wall.WallDrag`
    dt : time
    kept, pushed : results, shape (n,)
    """
    lid, plates, thin, top, table = wall
    _slow_mean(area, velocity, surface, lid, top, table, dt, kept)
    momentum, mass = _weigh(area, velocity, surface, coefficient, plates, thin, dt, kept, pushed)
    mean = momentum / np.maximum(mass, 1e-300)
    for i in range(area.size):
        gone = pushed[i]
        kept[i] *= 1.0 - gone
        pushed[i] = gone * mean
