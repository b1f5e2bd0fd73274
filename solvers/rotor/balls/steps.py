"""Time steps of a rotor with ball balancers, compiled by numba with its cache on disk."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from meshes.arrays import Array
from solvers.rotor.balls import motion as ball_motion

_jit: Any = njit(cache=True, error_model="numpy", nogil=True)
_rates: Any = _jit(ball_motion.rates)


def _advance(
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
) -> None:
    """Integrate by the classical Runge-Kutta method, of fourth order.

    Parameters
    ----------
    state : start, shape (2 n + 2 N + 2,); becomes the end
    mass, damping, stiffness, turning, axes, balls, numbers : see `ball_motion.rates`
    step : time step, s
    steps : between two samples
    record : result: the state at each sample, the start first, shape (samples, 2 n + 2 N + 2)
    """
    slopes, trial = np.empty((4, state.size)), np.empty(state.size)
    record[0] = state
    for sample in range(1, record.shape[0]):
        for i in range(steps):
            time = ((sample - 1) * steps + i) * step
            for stage in range(4):
                share = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
                for k in range(state.size):
                    trial[k] = state[k] + (share * step * slopes[stage - 1, k] if stage > 0 else 0.0)
                here = time + share * step
                _rates(here, trial, mass, damping, stiffness, turning, axes, balls, numbers, slopes[stage])
            for k in range(state.size):
                middle = slopes[1, k] + slopes[2, k]
                state[k] += step / 6.0 * (slopes[0, k] + 2.0 * middle + slopes[3, k])
        record[sample] = state


advance: Any = _jit(_advance)
