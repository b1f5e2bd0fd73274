"""Time steps of the dual-frequency exciter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from meshes.arrays import Array
from solvers.machine_code import machine_code
from solvers.rotor.exciter import machine as exciter
from solvers.slices import compiled, slices

_jit: Any = machine_code(error_model="numpy", nogil=True)
_rates: Any = _jit(exciter.rates)

Stretch = Callable[..., int]


def _step(time: float, state: Array, numbers: Array, step: float, slopes: Array, trial: Array) -> None:
    """One step of the classical Runge-Kutta method, of fourth order."""
    weights = (1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0)
    for stage in range(4):
        share = 0.0 if stage == 0 else (1.0 if stage == 3 else 0.5)
        for i in range(state.size):
            trial[i] = state[i] + (share * step * slopes[stage - 1, i] if stage > 0 else 0.0)
        _rates(time + share * step, trial, numbers, slopes[stage])
    for i in range(state.size):
        for stage in range(4):
            state[i] += step * weights[stage] * slopes[stage, i]


_compiled_step: Any = _jit(_step)


def _spread(state: Array, balls: int) -> float:
    """Largest angle between the first ball and another, the short way round."""
    widest = 0.0
    for j in range(1, balls):
        apart = (state[2 + j] - state[2] + np.pi) % (2.0 * np.pi) - np.pi
        widest = max(widest, abs(apart))
    return widest


_compiled_spread: Any = _jit(_spread)


def _mean_angle(state: Array, balls: int) -> float:
    """Angle of the sum of the balls' unit vectors."""
    x, y = 0.0, 0.0
    for j in range(balls):
        x += np.cos(state[2 + j])
        y += np.sin(state[2 + j])
    return float(np.arctan2(y, x))


_compiled_mean_angle: Any = _jit(_mean_angle)


def _stretch(
    state: Array,
    numbers: Array,
    step: float,
    steps: int,
    most: float,
    means: Array,
    first: int,
    sums: Array,
    before: Array,
    begin: int,
    end: int,
) -> int:
    """Some of the steps of `advance`.

    `means`: mean speed of each ball and the largest spread, a block a row; `sums`: from the block `first` on,
    projections of the platform's position on sine and cosine of the balls' mean angle and of the shaft's;
    `before`: angles at the beginning of the block. Returns the blocks done if a ball was faster than `most`,
    else 0.
    """
    blocks, balls = means.shape[0], means.shape[1] - 1
    slopes, trial = np.empty((4, state.size)), np.empty(state.size)
    for number in range(begin, end):
        block = number // steps
        i = number - block * steps
        if i == 0:
            before[:] = state[2 : 2 + balls]
            means[block, balls] = 0.0
        time = (block * steps + i) * step
        if block >= first:
            # A Hann window: what leaks from one frequency to the other falls with the cube of its length.
            slow, fast = _compiled_mean_angle(state, balls), numbers[6] * time
            share = (i + 0.5 + (block - first) * steps) / ((blocks - first) * steps)
            weight = 2.0 * (1.0 - np.cos(2.0 * np.pi * share)) / ((blocks - first) * steps)
            sums[0] += weight * state[0] * np.sin(slow)
            sums[1] += weight * state[0] * np.cos(slow)
            sums[2] += weight * state[0] * np.sin(fast)
            sums[3] += weight * state[0] * np.cos(fast)
        _compiled_step(time, state, numbers, step, slopes, trial)
        means[block, balls] = max(means[block, balls], _compiled_spread(state, balls))
        if i < steps - 1:
            continue
        fastest = 0.0
        for j in range(balls):
            means[block, j] = (state[2 + j] - before[j]) / (steps * step)
            fastest = max(fastest, means[block, j])
        # Written so that nan stops as well.
        if not fastest <= most:
            return int(block + 1)
    return 0


_compiled_stretch: Any = _jit(_stretch)


def advance(
    state: Array,
    numbers: Array,
    step: float,
    steps: int,
    most: float,
    means: Array,
    first: int,
    sums: Array,
    stretch: Stretch = _compiled_stretch,
) -> int:
    """Integrate block by block until the end, or until a ball is faster than `most` in the mean of a block.

    Arguments as of `stretch`, after each slice of which Python sees a Ctrl-C; returns the blocks done.
    """
    blocks, begin, before = means.shape[0], 0, np.empty(means.shape[1] - 1)
    for taken in slices(blocks * steps, 4 * state.size):
        end = begin + taken
        stopped = compiled(stretch, state, numbers, step, steps, most, means, first, sums, before, begin, end)
        if stopped:
            return int(stopped)
        begin = end
    return int(blocks)
