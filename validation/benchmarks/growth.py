"""How the cost of this package grows: with points and cells, with the length of a sweep; the first call."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from leblanc.studies.layer.study import answer_layer
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import simulate
from solvers.synchronous.models import LINEAR, STATICS
from solvers.waves.steady import respond, solve
from validation.benchmarks.leblanc_codes import AMPLITUDE, SPEED
from validation.benchmarks.problems import SPIN, fill, response_speeds, steady_problem

# Cells of the waves in a sweep over speeds, and the whirl periods that each speed is given.
_SWEEP_CELLS, _SWEEP_PERIODS = 64, 3


@dataclass(frozen=True)
class Growth:
    """Cost over a number."""

    name: str  #: of the model
    over: str  #: what the number counts
    counts: list[int]  #: shape (k,)
    seconds: list[float]  #: best of some repeats, s, shape (k,)


def best(run: Callable[[], object], repeats: int = 3, enough: float = 2.0) -> float:
    """Shortest time of runs after one to warm up, s; no more runs after `enough` seconds."""
    run()
    times: list[float] = []
    while len(times) < repeats and sum(times) < enough:
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    return min(times)


def over_cells(quick: bool = False) -> list[Growth]:
    """One steady wave over its points; a whirl period and a right-hand side of the long waves over cells."""
    counts = [2**k for k in range(4, 8 if quick else 14)]
    problem = steady_problem()
    waves = [best(partial(solve, problem.waves, problem.speed, points=n, most_points=n)) for n in counts]
    few = [n for n in counts if n <= 1024]
    whirl = Whirl(SPIN, SPEED, AMPLITUDE)
    period = [best(partial(simulate, fill(), whirl, whirl.period, numerics=Numerics(n))) for n in few]
    return [
        Growth("kdv, one steady wave", "points", counts, waves),
        Growth("long_wave, one whirl period", "cells", few, period),
        Growth("long_wave, one right-hand side", "cells", counts, [right_hand_side(n) for n in counts]),
    ]


def over_speeds(quick: bool = False) -> list[Growth]:
    """Cost of a sweep over the number of its whirl speeds."""
    counts = [1, 10, 30] if quick else [1, 3, 10, 30, 100, 300, 1000]
    layer, low, high = fill(), response_speeds()[0], response_speeds()[-1]

    def each(work: Callable[[float], object]) -> list[float]:
        rows = [np.linspace(low, high, n) if n > 1 else np.array([low]) for n in counts]

        def all_of(row: NDArray[np.float64]) -> None:
            for speed in row.tolist():
                work(speed)

        return [best(partial(all_of, row)) for row in rows]

    def periods(slip: float) -> object:
        whirl = Whirl(SPIN, SPIN + slip, AMPLITUDE)
        return simulate(layer, whirl, _SWEEP_PERIODS * whirl.period, numerics=Numerics(_SWEEP_CELLS))

    problem = steady_problem().waves
    curves = [best(partial(respond, problem, np.linspace(low, high, n))) for n in counts[1:]]
    return [
        Growth(
            "statics", "speeds", counts, each(lambda _: answer_layer(layer, SPIN, SPIN, AMPLITUDE, STATICS))
        ),
        Growth(
            "linear", "speeds", counts, each(lambda s: answer_layer(layer, SPIN, SPIN + s, AMPLITUDE, LINEAR))
        ),
        Growth("kdv, whole curve", "speeds", counts[1:], curves),
        Growth(
            f"long_wave, {_SWEEP_PERIODS} periods on {_SWEEP_CELLS} cells", "speeds", counts, each(periods)
        ),
    ]


def right_hand_side(cells: int) -> float:
    """Time of one right-hand side of the long waves on a moving layer that is not uniform, s."""
    from solvers.layer.finite_volume import GHOSTS, WORK, plain_rates
    from solvers.layer.inside import NOTHING

    step = 2.0 * np.pi / cells
    middle = step * (np.arange(cells) + 0.5)
    area = 0.095 * (1.0 + 0.1 * np.cos(middle))
    q = 0.01 * np.sin(2.0 * middle) * area - area**2
    pull = 0.003 * np.cos(middle)
    work, d_area, d_q = np.zeros((WORK, cells + 2 * GHOSTS)), np.zeros(cells), np.zeros(cells)
    none, times = np.empty(0), max(1, 200_000 // cells)
    more = False, work, d_area, d_q, none

    def run() -> None:
        for _ in range(times):
            plain_rates(*(area, q, none, 1.0, 0.0, pull, pull, *NOTHING, step, 1e-4 * step), *more)

    return best(run, 5) / times


def curve_time() -> tuple[float, bool]:
    """Time of the response at 201 speeds, s, and whether the curve is complete."""
    problem = steady_problem().waves
    answer = respond(problem, response_speeds())
    return best(lambda: respond(problem, response_speeds()), 5), answer.complete


FIRST = """
import time
begin = time.perf_counter()
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import simulate
from validation.benchmarks.leblanc_codes import AMPLITUDE, SPEED
from validation.benchmarks.problems import SPIN, fill
whirl = Whirl(SPIN, SPEED, AMPLITUDE)
loaded = time.perf_counter()
simulate(fill(), whirl, whirl.period, numerics=Numerics(16))
called = time.perf_counter()
simulate(fill(), whirl, whirl.period, numerics=Numerics(16))
print(loaded - begin, called - loaded, time.perf_counter() - called)
"""


def first_calls() -> dict[str, float]:
    """Times of the first long-wave run of a process, s: nothing compiled yet, from the cache, and again."""
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"NUMBA_CACHE_DIR": folder}
        rows = []
        for _ in range(2):
            command = [sys.executable, "-c", FIRST]
            done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
            rows.append([float(seconds) for seconds in done.stdout.split()])
    cold, warm = rows
    return {
        "imports": warm[0],
        "nothing compiled": cold[1],
        "from the cache": warm[1],
        "second call": warm[2],
    }
