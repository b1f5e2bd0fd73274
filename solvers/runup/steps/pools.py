"""Liquid in two layers through a time step of the rotor that it is coupled to [theory: pool, eq. 18-19]."""

from __future__ import annotations

from typing import Any

from solvers.layer.finite_volume import COMPILED
from solvers.layer.records import records
from solvers.layer.step import copy
from solvers.layer.two_layer_step import advance as advance_pool
from solvers.layer.two_layer_step import measure as measure_pool
from solvers.layer.two_layer_step import stands
from solvers.layer.two_layers import FLOWS, STREAM, TAKEN
from solvers.machine_code import (
    BLOCKS,
    FLAG,
    HANDED,
    NOTHING,
    REAL,
    ROW,
    ROWS,
    WHOLE,
    handed,
    handed_type,
    machine_code,
    type_of,
)
from solvers.runup.state import SUMS

_handed: Any = machine_code(**(COMPILED | HANDED))

# No wave of a pool is faster, rad/s.
_FASTEST = 1e9


@_handed
def move_pools(
    pools,
    tables,
    two_layers,
    rings,
    kept,
    gravity,
    angles,
    spins,
    axis,
    dt,
    guess,
    before,
    after,
    inertia,
    taken,
    first,
    last,
    work,
):
    """Move all pools one step under the guessed accelerations; whether they could [theory: pool, eq. 19].

    `axis` is the row of the first pool among those of all liquids; the pools begin as they are `kept`.
    """
    spin = 0.5 * (spins[0] + spins[1])
    copy(kept, two_layers)
    for j in range(pools.shape[0]):
        pool, own, gone = pools[j], axis + j, taken[j]
        x = (gravity[0] - guess[own, 0]) / pool.radius
        y = (gravity[1] - guess[own, 1]) / pool.radius
        gone.torque, gone.heat, gone.baffles = 0.0, 0.0, 0.0
        fastest = advance_pool(
            two_layers[j], spin, x, y, rings[j], dt, angles, pool, tables[j], work[j], gone
        )
        if not fastest < _FASTEST:
            return False
        begin, end = first[j], last[j]
        measure_pool(two_layers[j], angles, pool.full, pool.slot, spins[1], work[j], end)
        before[own, 0], before[own, 1] = pool.weight * begin.flow_x, pool.weight * begin.flow_y
        after[own, 0], after[own, 1] = pool.weight * end.flow_x, pool.weight * end.flow_y
        scale = 0.5 * pool.weight / pool.radius
        inertia[own, 0] = scale * (begin.xx + end.xx)
        inertia[own, 1] = scale * (begin.xy + end.xy)
        inertia[own, 2] = scale * (begin.yy + end.yy)
    return True


@_handed
def begin_pools(pools, two_layers, rings, kept, gravity, angles, spin, axis, push, first, work):
    """Measure the pools at the beginning of a step; rings that their own rotation holds no more fall."""
    for j in range(pools.shape[0]):
        pool = pools[j]
        x = (gravity[0] - push[axis + j, 0, 0]) / pool.radius
        y = (gravity[1] - push[axis + j, 0, 1]) / pool.radius
        rings[j] = rings[j] and stands(two_layers[j], x, y, pool.full)
        measure_pool(two_layers[j], angles, pool.full, pool.slot, spin, work[j], first[j])
    copy(two_layers, kept)


@_handed
def no_pools(
    pools,
    tables,
    two_layers,
    rings,
    kept,
    gravity,
    angles,
    spins,
    axis,
    dt,
    guess,
    before,
    after,
    inertia,
    taken,
    first,
    last,
    work,
):
    """Stands for `move_pools` where there are none."""
    return True


@_handed
def begin_no_pools(pools, two_layers, rings, kept, gravity, angles, spin, axis, push, first, work):
    """Stands for `begin_pools` where there are none."""


@_handed
def tally_pools(pools, gravity, spins, axis, dt, found, before, after, taken, first, last, sums):
    """Add one step's work and losses of the pools to `sums`, a record SUMS [theory: coupling, eq. 9-10]."""
    spin = 0.5 * (spins[0] + spins[1])
    for j in range(pools.shape[0]):
        pool, gone, own = pools[j], taken[j], axis + j
        drive = spin * pool.inertia * gone.torque
        heat = pool.inertia * gone.heat
        lost = pool.inertia * gone.baffles
        x, y = last[j].moment_x - first[j].moment_x, last[j].moment_y - first[j].moment_y
        fallen = pool.weight * (gravity[0] * x + gravity[1] * y)
        sums.drive += drive
        sums.friction += heat
        sums.baffles += lost
        sums.gravity += fallen
        # Jumps, mixing and what the layers rub on one another: what is left of its balance in its own frame.
        sums.lost += pool.inertia * (first[j].energy - last[j].energy) + fallen + drive - heat - lost
        for i in range(2):
            sums.lost -= 0.5 * dt * found[own, i] * (before[own, i] + after[own, i])


@_handed
def tally_no_pools(pools, gravity, spins, axis, dt, found, before, after, taken, first, last, sums):
    """Stands for `tally_pools` where there are none."""


_POOLS, _FLOWS, _FLAGS = type_of(records(STREAM)), type_of(records(FLOWS)), FLAG[::1]
_TAKEN = type_of(records(TAKEN))
_MOVE: Any = handed_type(
    *(FLAG, _POOLS, BLOCKS, BLOCKS, _FLAGS, BLOCKS, ROW, ROWS, ROW, WHOLE, REAL, ROWS, ROWS, ROWS, ROWS),
    *(_TAKEN, _FLOWS, _FLOWS, BLOCKS),
)
_BEGIN: Any = handed_type(
    *(NOTHING, _POOLS, BLOCKS, _FLAGS, BLOCKS, ROW, ROWS, REAL, WHOLE, BLOCKS, _FLOWS, BLOCKS)
)


_TALLY: Any = handed_type(
    *(NOTHING, _POOLS, ROW, ROW, WHOLE, REAL, ROWS, ROWS, ROWS, _TAKEN, _FLOWS, _FLOWS),
    type_of(records(SUMS)[0]),
)
# Of `begin_pools`, `move_pools` and `tally_pools`.
POOLS: Any = (_BEGIN, _MOVE, _TALLY)


def pools_of(moves: bool) -> tuple[Any, ...]:
    """What moves pools, if any liquid of the machine may be one, handed over."""
    made = (begin_pools, move_pools, tally_pools) if moves else (begin_no_pools, no_pools, tally_no_pools)
    return tuple(handed(part, types) for part, types in zip(made, POOLS, strict=True))
