"""Compiled loops in slices, and how many steps they may take: nothing runs for ever or past a Ctrl-C.

Python sees a Ctrl-C between two slices only. What a loop carries from step to step stands in arrays that
outlive the slice, so that no digit of an answer depends on where a slice ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

SLICE = 1 << 19  # cells or coordinates moved in a slice, some tenths of a second

# No front runs ahead at twice the speed of the drum, and films are given twice as much.
FASTEST = 4.0
# A film faster than this many drums has run away, and each step would be shorter than the last.
RUNAWAY = 1e3
# What a run may take of the steps that the fastest film needs; what is known to come to an end takes a
# fourth of them at most, in the mean of its time.
SPARE = 100


def step_budget(time: float, spin: float, cells: int, courant: float) -> int:
    """Most steps over a time, a hundred times what a film needs at four times the speed of the drum."""
    return math.ceil(SPARE * (1.0 + FASTEST * abs(spin) * time * cells / (2.0 * math.pi * courant)))


def slices(steps: int, size: int, most: int = 0) -> Iterator[int]:
    """Numbers of steps that make up a number of them, each as many as take a fraction of a second.

    `size` counts the cells or coordinates that a step moves; `most` bounds a slice, 0: not.
    """
    length = max(1, SLICE // size)
    length = min(length, most) if most > 0 else length
    for done in range(0, steps, length):
        yield min(length, steps - done)


def compiled(loop: Callable[..., Any], *given: Any) -> Any:
    """What a compiled loop returns; an interrupt that comes on the way into it or out of it stays one."""
    try:
        return loop(*given)
    except SystemError as error:  # "returned a result with an exception set"
        if error.__cause__ is None:
            raise
        raise error.__cause__ from None
