"""Time steps of a rotor with ball balancers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from meshes.arrays import Array
from solvers.machine_code import machine_code
from solvers.rotor.balls import motion as ball_motion
from solvers.slices import compiled, slices

_jit: Any = machine_code(error_model="numpy", nogil=True)
_rates: Any = _jit(ball_motion.rates)


def _stretch(
    state: Array,
    mass: Array,
    damping: Array,
    stiffness: Array,
    turning: Array,
    axes: Array,
    balls: Array,
    numbers: Array,
    step: float,
    steps: int,
    record: Array,
    begin: int,
    end: int,
) -> None:
    """Some of the steps of `advance`.

    Arguments as of `rates`; `state` becomes the end, `record` has the state at each sample, `begin` and `end`
    number the steps.
    """
    slopes, trial = np.empty((4, state.size)), np.empty(state.size)
    for number in range(begin, end):
        time = number * step
        for stage in range(4):
            share = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
            for k in range(state.size):
                trial[k] = state[k] + (share * step * slopes[stage - 1, k] if stage > 0 else 0.0)
            here = time + share * step
            _rates(here, trial, mass, damping, stiffness, turning, axes, balls, numbers, slopes[stage])
        for k in range(state.size):
            middle = slopes[1, k] + slopes[2, k]
            state[k] += step / 6.0 * (slopes[0, k] + 2.0 * middle + slopes[3, k])
        if (number + 1) % steps == 0:
            record[(number + 1) // steps] = state


_compiled_stretch: Any = _jit(_stretch)


def advance(
    state: Array,
    matrices: tuple[Array, ...],
    numbers: Array,
    step: float,
    steps: int,
    record: Array,
    stretch: Callable[..., None] = _compiled_stretch,
) -> None:
    """Integrate by the classical Runge-Kutta method, of fourth order.

    `state` becomes the end, `record` has the state at each sample, the start first; after each slice of a
    `stretch` Python sees a Ctrl-C.
    """
    record[0] = state
    begin = 0
    for taken in slices((record.shape[0] - 1) * steps, 4 * state.size):
        compiled(stretch, state, *matrices, numbers, step, steps, record, begin, begin + taken)
        begin += taken
