"""One time step of the law of the wall: the mean flow's friction, then that of the waves [theory: friction].

Unconditionally stable and of second order, cell by cell; the waves' part leaves the angular momentum of the
layer to rounding. Lengths over R, times in the unit of the law's rates.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fluid.friction import laws
from solvers.layer.finite_volume import COMPILED, DRY, SUMMED
from solvers.machine_code import (
    BARE,
    HANDED,
    NOTHING,
    REAL,
    ROW,
    ROWS,
    WHOLE,
    handed,
    handed_type,
    machine_code,
)

_handed: Any = machine_code(**(COMPILED | HANDED))
_inner_part: Any = machine_code(**(COMPILED | BARE))
_sum_part: Any = machine_code(**(SUMMED | BARE))
_sum_jit: Any = machine_code(**SUMMED)

# Decays up to this in a step take the exponential's series, whose tenth term is 0.06^10/10! = 2e-19.
_WEAK = 0.0625

_damping = _inner_part(laws.damping_rate)


@_sum_jit
def kept_speed(area, velocity, surface, law, coefficient, lid, dt, kept):
    """Share of each cell's velocity that friction leaves after a time dt: an exact decay, cell by cell."""
    n, strong = area.size, 0
    for i in range(n):
        a = np.maximum(area[i], DRY)
        # The wall's shear over the velocity, without the cancellation in 1 - r.
        rate = _damping(law, coefficient, lid, 2.0 * area[i] / (1.0 + surface[i]), a, velocity[i])
        kept[i] = rate * dt
        strong += 1 if kept[i] > _WEAK else 0
    if law == laws.QUADRATIC:
        # du/dt = -c |u| u has the hyperbola as its solution, the others the exponential.
        for i in range(n):
            kept[i] = 1.0 / (1.0 + kept[i])
    elif strong == 0:
        # The exponential's series, which vectorises; it ends with rounding.
        for i in range(n):
            x = kept[i]
            total = 1.0 - x / 9.0
            total = 1.0 - x / 8.0 * total
            total = 1.0 - x / 7.0 * total
            total = 1.0 - x / 6.0 * total
            total = 1.0 - x / 5.0 * total
            total = 1.0 - x / 4.0 * total
            total = 1.0 - x / 3.0 * total
            total = 1.0 - x / 2.0 * total
            kept[i] = 1.0 - x * total
    else:
        for i in range(n):
            kept[i] = np.exp(-kept[i])


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
def _slow_mean(area, velocity, surface, lid, top, table, dt, kept, spare):
    """Share of each cell's velocity that the mean part leaves: (1 + p x)^(-1/p) to second order in x.

    In three passes, as only the middle one, which reads the table as `mean_rate` does, cannot take several
    cells at once. Divisions are dear, so one stands for 1/h and 1/(1 - A).
    """
    last = table.shape[0] - 1
    slowness, pace = 1.0 / top, top * dt
    for i in range(area.size):
        held, rest = np.maximum(area[i], DRY), 1.0 - area[i]
        over = 1.0 / (held * rest)
        ratio = abs(velocity[i]) * held * over * slowness
        # h = 2 A/(1 + r).
        sides = 0.5 * (1.0 + surface[i]) * rest * over + lid
        spare[i] = sides * (ratio if ratio > 1.0 else 1.0) * pace
        kept[i] = np.sqrt(np.sqrt(ratio if ratio < 1.0 else 1.0)) * last
    for i in range(area.size):
        k = min(int(kept[i]), last - 1)
        rate = table[k, 0] + (kept[i] - k) * (table[k + 1, 0] - table[k, 0])
        kept[i], spare[i] = rate * spare[i], table[k, 1]
    for i in range(area.size):
        kept[i] = 1.0 / (1.0 + kept[i] * (1.0 + spare[i] * kept[i]))


@_sum_part
def _weigh(area, velocity, surface, coefficient, plates, thin, dt, kept, gone):
    """Share of its velocity beside the mean that a cell loses; sums of momentum and mass, so weighted.

    x + x^2/2 over 1 + x + x^2/2, x the rate times the step, as one fraction.
    """
    momentum, mass = 0.0, 0.0
    for i in range(area.size):
        above = coefficient * dt * (1.0 + plates * (1.0 - surface[i]))
        # A (h + delta)/h, h = 2 A/(1 + r).
        below = np.maximum(area[i], DRY) + 0.5 * thin * (1.0 + surface[i])
        lost = above * (below + 0.5 * above)
        share = lost / (below * below + lost)
        gone[i] = share
        momentum += share * area[i] * kept[i] * velocity[i]
        mass += share * area[i]
    return momentum, mass


@_handed
def wall_kept(area, velocity, surface, law, coefficient, lid, plates, thin, top, table, dt, kept, pushed):
    """What the law of the wall makes of each cell's velocity in a time dt: kept u + pushed.

    Numbers as of `fluid.friction.wall.WallDrag`; `coefficient` is that of the waves' part on the wall.
    """
    _slow_mean(area, velocity, surface, lid, top, table, dt, kept, pushed)
    momentum, mass = _weigh(area, velocity, surface, coefficient, plates, thin, dt, kept, pushed)
    mean = momentum / np.maximum(mass, 1e-300)
    for i in range(area.size):
        gone = pushed[i]
        kept[i] *= 1.0 - gone
        pushed[i] = gone * mean


@_handed
def plain_kept(area, velocity, surface, law, coefficient, lid, plates, thin, top, table, dt, kept, pushed):
    """The same by any other law, or none; nothing is pushed."""
    if law == laws.NONE:
        for i in range(area.size):
            kept[i] = 1.0
    else:
        kept_speed(area, velocity, surface, law, coefficient, lid, dt, kept)
    for i in range(area.size):
        pushed[i] = 0.0


# Of `wall_kept` and `plain_kept`.
FRICTION: Any = handed_type(
    *(NOTHING, ROW, ROW, ROW, WHOLE, REAL, REAL, REAL, REAL, REAL, ROWS, REAL, ROW, ROW)
)


def friction_of(law: int) -> Any:
    """Friction by a law, handed over."""
    return handed(wall_kept if law == laws.WALL else plain_kept, FRICTION)
