"""Many states of a layer through the same time at once: what derivatives by differences take most of."""

from __future__ import annotations

from typing import Any

from solvers.layer.finite_volume import COMPILED
from solvers.layer.records import Outcome
from solvers.layer.step import ADVANCE, advance
from solvers.machine_code import REAL, ROWS, WHOLE, machine_code

_jit: Any = machine_code(**COMPILED)


@_jit
def advance_each(
    rates,
    friction,
    areas,
    momenta,
    pace,
    start,
    time,
    parts,
    drive,
    wall,
    angles,
    inside,
    courant,
    most,
    spare,
    loads,
):
    """Advance states of a layer, in place, through a time in equal steps; whether all came to the end.

    Arguments as of `solvers.layer.step.advance`; the loads of each state are added to `loads`, shape (m,).
    """
    for k in range(areas.shape[0]):
        pace[0].time, pace[0].fastest = start, 0.0
        for part in range(parts):
            stop = start + time * (part + 1) / parts
            outcome, _ = advance(
                rates, friction, areas[k], momenta[k], areas[k, :0], pace, stop, drive, wall, angles, inside,
                courant, most, spare, loads[k : k + 1],
            )  # fmt: skip
            if outcome != Outcome.DONE:
                return False
    return True


# Of `advance_each`: rates and friction handed over, pace, drive and all else as of `advance`.
ADVANCE_EACH: Any = (*(*ADVANCE[:2], ROWS, ROWS, ADVANCE[5], REAL, REAL, WHOLE, *ADVANCE[7:]),)
