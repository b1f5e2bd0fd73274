"""Motion of the exciter together with a small disturbance: growth rate, speeds and vibration by blocks."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from solvers.machine_code import machine_code
from solvers.rotor.exciter.machine import Dimensionless
from solvers.rotor.exciter.motion import MOST_STEPS
from solvers.slices import compiled, slices

_jit: Any = machine_code(error_model="numpy", nogil=True)


@dataclass(frozen=True)
class Followed:
    """A motion and the growth of a disturbance along it, in the machine's own units; b blocks, N balls."""

    #: at the end: platform's position and velocity, angles and speeds of the balls, shape (2 + 2 N,)
    state: Array
    time: float  #: at the end
    ball_speed: Array  #: mean speed of each ball in each block, shape (b, N)
    growth: Array  #: mean rate of growth of the disturbance in each block, shape (b,)
    power: Array  #: mean square of the platform's position in each block, shape (b,)
    samples: Array  #: positions of the platform at equal times over the last blocks, shape (s,)
    sample_time: float  #: between two of them


def tangent_rates(time: float, pair: Array, numbers: Array, out: Array) -> None:
    """Rates of the state and of a small disturbance of it [theory: balls, eq. 4 and 6].

    For the compiler. `pair`: the state of `machine.rates` and behind it the disturbance, shape (4 + 4 N,).
    """
    eps, b, delta, h, sigma, alpha, n = numbers
    size = pair.size // 2
    balls = (size - 2) // 2
    load = delta * n * n * np.sin(n * time) - 2.0 * h * pair[1] - pair[0]
    load_change = -2.0 * h * pair[size + 1] - pair[size]
    carried, carried_change = 0.0, 0.0
    for j in range(balls):
        at, fast = 2 + j, 2 + balls + j
        rate, turn, quicken = pair[fast], pair[size + at], pair[size + fast]
        cosine, sine = np.cos(pair[at]), np.sin(pair[at])
        own, own_change = -eps * b * (rate - n), -eps * b * quicken
        if sigma != 0.0:
            own -= eps * sigma * np.cos(pair[at] - alpha)
            own_change += eps * sigma * np.sin(pair[at] - alpha) * turn
        load += (rate * rate * sine - own * cosine) / balls
        load_change += (2.0 * rate * sine * quicken + rate * rate * cosine * turn) / balls
        load_change += (own * sine * turn - own_change * cosine) / balls
        carried += cosine * cosine / balls
        carried_change -= 2.0 * cosine * sine * turn / balls
        out[at], out[size + at] = rate, quicken
        out[fast], out[size + fast] = own, own_change
    mass = 1.0 - eps * carried
    acceleration = load / mass
    change = (load_change + acceleration * eps * carried_change) / mass
    out[0], out[size] = pair[1], pair[size + 1]
    out[1], out[size + 1] = acceleration, change
    for j in range(balls):
        at, fast = 2 + j, 2 + balls + j
        cosine, sine = np.cos(pair[at]), np.sin(pair[at])
        out[fast] -= eps * acceleration * cosine
        out[size + fast] -= eps * (change * cosine - acceleration * sine * pair[size + at])


_compiled_rates: Any = _jit(tangent_rates)


def _tangent_step(time: float, pair: Array, numbers: Array, step: float, slopes: Array, trial: Array) -> None:
    """One step of the classical Runge-Kutta method, of fourth order."""
    _compiled_rates(time, pair, numbers, slopes[0])
    for i in range(pair.size):
        trial[i] = pair[i] + 0.5 * step * slopes[0, i]
    _compiled_rates(time + 0.5 * step, trial, numbers, slopes[1])
    for i in range(pair.size):
        trial[i] = pair[i] + 0.5 * step * slopes[1, i]
    _compiled_rates(time + 0.5 * step, trial, numbers, slopes[2])
    for i in range(pair.size):
        trial[i] = pair[i] + step * slopes[2, i]
    _compiled_rates(time + step, trial, numbers, slopes[3])
    for i in range(pair.size):
        pair[i] += step / 6.0 * (slopes[0, i] + 2.0 * (slopes[1, i] + slopes[2, i]) + slopes[3, i])


_compiled_step: Any = _jit(_tangent_step)


def _stretch(
    pair: Array,
    numbers: Array,
    start: float,
    step: float,
    steps: int,
    sums: Array,
    samples: Array,
    first: int,
    every: int,
    begin: int,
    end: int,
) -> None:
    """Some of the steps of `follow`.

    The disturbance of `pair` is brought back to length 1 at the end of each step. `sums` has of each block
    the turns of the balls, the logarithm of the growth and the squares of the platform's position; `samples`
    its position.
    """
    size = pair.size // 2
    balls = (size - 2) // 2
    slopes, trial = np.empty((4, pair.size)), np.empty(pair.size)
    for number in range(begin, end):
        block = number // steps
        taken = (number - first) // every
        if number >= first and (number - first) % every == 0 and taken < samples.size:
            samples[taken] = pair[0]
        for j in range(balls):
            sums[block, j] -= pair[2 + j]
        sums[block, balls + 1] += pair[0] * pair[0]
        _compiled_step(start + number * step, pair, numbers, step, slopes, trial)
        for j in range(balls):
            sums[block, j] += pair[2 + j]
        length = 0.0
        for i in range(size, pair.size):
            length += pair[i] * pair[i]
        length = np.sqrt(length)
        sums[block, balls] += np.log(length)
        for i in range(size, pair.size):
            pair[i] /= length


_compiled_stretch: Any = _jit(_stretch)


def follow(
    machine: Dimensionless,
    speed: float,
    state: Array,
    duration: float,
    disturbance: Array | None = None,
    blocks: int = 40,
    samples: int = 0,
    sampled: float = 0.25,
    steps: int = 24,
    start: float = 0.0,
    stretch: Callable[..., None] = _compiled_stretch,
) -> Followed:
    """Integrate the full equations of motion and a small disturbance [theory: balls, eq. 6].

    Times in units of 1/(natural frequency). After many `blocks` the mean growth rate is the largest exponent
    of Lyapunov. The disturbance is by default one that is like no symmetry of the machine; `samples` of the
    platform's position over the last share `sampled` of the time.
    """
    require_positive("speed", speed)
    require_positive("duration", duration)
    given = np.arange(1.0, state.size + 1.0) if disturbance is None else np.asarray(disturbance, dtype=float)
    length = float(np.linalg.norm(given))
    if given.shape != state.shape or not length > 0.0:
        raise InputError("disturbance", given.tolist(), f"{state.size} numbers, not all 0")
    if blocks < 1 or steps < 8 or samples < 0 or not 0.0 < sampled <= 1.0:
        raise InputError(
            "blocks, steps, samples, sampled",
            (blocks, steps, samples, sampled),
            "1 or more, 8 or more, 0 or more, above 0 and at most 1",
        )
    balls = (state.size - 2) // 2
    in_block = math.ceil(duration / blocks * steps * max(speed, 1.0) / (2.0 * math.pi))
    total = in_block * blocks
    if total > MOST_STEPS:
        raise InputError("duration", duration, f"one of at most {MOST_STEPS:g} steps")
    step = duration / total
    every = max(1, math.floor(total * sampled / max(samples, 1)))
    kept = np.zeros(min(samples, total))
    pair = np.concatenate((np.asarray(state, dtype=float), given / length))
    sums, begin = np.zeros((blocks, balls + 2)), 0
    first = total - every * max(kept.size, 1)
    for taken in slices(total, 4 * pair.size):
        end = begin + taken
        compiled(
            *(stretch, pair, machine.numbers(speed), start, step, in_block, sums, kept, first, every),
            *(begin, end),
        )
        begin = end
    span = in_block * step
    return Followed(
        state=pair[: state.size].copy(),
        time=start + duration,
        ball_speed=sums[:, :balls] / span,
        growth=sums[:, balls] / span,
        power=sums[:, balls + 1] / in_block,
        samples=kept,
        sample_time=every * step,
    )
