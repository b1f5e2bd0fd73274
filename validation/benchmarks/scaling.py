"""`python -m validation.benchmarks.scaling`: run-ups a minute of a sweep with more workers than there are.

Measured are the parts of a block's way on this machine: its answer in a worker, what it costs to send it
there and back, and what the first process does with it, which alone writes. Those times then go through the
queues of a sweep (`leblanc.studies.sweep.cluster`) with any number of workers.
"""

from __future__ import annotations

import heapq
import pickle
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from leblanc.scene.examples import example
from leblanc.studies.sweep.block import answer_block
from leblanc.studies.sweep.cluster import AHEAD, client_of
from leblanc.studies.sweep.plan import Sweep, study_of
from leblanc.studies.sweep.sampling import sample_rows
from leblanc.studies.sweep.store import open_store
from leblanc.studies.sweep.study import block_of, run_sweep, write_answer
from validation.study import launch

WORKERS = (1, 2, 4, 16, 64, 256)
SAMPLES = 10_000
_EMPTY = 400  # tasks without work, by which the scheduler is timed
_REAL = (1, 2)  # workers with which a sweep is made as well


def passed(durations: Sequence[float], aside: float, workers: int, ahead: int = AHEAD) -> float:
    """Time that a sweep takes, s, whose blocks take so long in a worker and `aside` in the first process.

    That hands out blocks as long as fewer than `ahead` for each worker are away, waits for those that are
    done and takes one after the other.
    """
    waiting, away = list(durations)[::-1], list[float]()
    free, clock = [0.0] * workers, 0.0
    while waiting or away:
        while waiting and len(away) < ahead * workers:
            done = max(clock, heapq.heappop(free)) + waiting.pop()
            heapq.heappush(free, done)
            heapq.heappush(away, done)
        clock, taken = max(clock, heapq.heappop(away)), 1
        while away and away[0] <= clock:
            heapq.heappop(away)
            taken += 1
        clock += taken * aside
    return clock


def runups(samples: int, cells: int) -> Sweep:
    """The sweep that is timed: unbalance, volume and rate of examples/runup.toml, all different."""
    scene = example("runup").replace({"runup.cells": cells})
    vary = {
        "rotor.unbalance": {"uniform": [0.05, 0.15]},
        "chambers.0.volume": {"uniform": [3e-4, 7e-4]},
        "runup.rate": {"uniform": [7.0, 9.0]},
    }
    given = {"command": "runup", "check": False, "method": "sobol", "samples": samples, "vary": vary}
    return study_of({"scene": scene, **given})


def _parts(sweep: Sweep, blocks: int, size: int) -> tuple[list[float], float]:
    """Times of some blocks in a worker, s, and the mean of what the first process does with one."""
    answered, aside = [], 0.0
    with TemporaryDirectory() as folder:
        store = replace(open_store(Path(folder), sweep), block=size)
        rows = sample_rows(sweep)
        answer_block(block_of(sweep, store, rows, 0))  # loads what is compiled
        for number in range(blocks):
            begin = time.perf_counter()
            sent = pickle.dumps(block_of(sweep, store, rows, number))
            aside += time.perf_counter() - begin
            begin = time.perf_counter()
            back = pickle.dumps(answer_block(pickle.loads(sent)))
            answered.append(time.perf_counter() - begin)
            begin = time.perf_counter()
            write_answer(sweep, store, rows, pickle.loads(back))
            aside += time.perf_counter() - begin
    return answered, aside / blocks


def _nothing(number: int) -> int:
    return number


def _scheduler() -> float:
    """Time of the scheduler for a task, s."""
    with client_of(1, None) as client:
        client.gather(client.map(_nothing, range(_EMPTY), pure=False))
        begin = time.perf_counter()
        client.gather(client.map(_nothing, range(_EMPTY), pure=False))
        return (time.perf_counter() - begin) / _EMPTY


def main(blocks: int = 8, cells: int = 64) -> Iterator[str]:
    """Run-ups a minute over workers, from so many blocks that are timed."""
    sweep = runups(SAMPLES, cells)
    with TemporaryDirectory() as folder:
        size = open_store(Path(folder), sweep).block
    answered, aside = _parts(sweep, blocks, size)
    task = _scheduler()
    each = sum(answered) / blocks
    yield f"{size} run-ups of {cells} cells in a block: {each:.2f} s in a worker"
    yield f"first process: {1e3 * aside:.1f} ms for a block, scheduler {1e3 * task:.1f} ms for a task"
    count = SAMPLES // size
    durations = [answered[k % blocks] for k in range(count)]
    alone = 0.0
    for workers in WORKERS:
        lasts = passed(durations, aside + task, workers)
        alone = alone or lasts
        share = alone / lasts / workers
        yield (
            f"{workers:4d} workers: {60.0 * SAMPLES / lasts:7.0f} run-ups a minute, {SAMPLES} in "
            f"{lasts / 60.0:6.2f} minutes, {share:.0%} of each worker used"
        )
    few = runups(16 * size, cells)
    for workers in _REAL:
        with TemporaryDirectory() as folder:
            begin = time.perf_counter()
            run_sweep(few, Path(folder), workers)
            lasted = time.perf_counter() - begin
        yield f"{workers} workers, made: {16 * size} run-ups in {lasted:.1f} s with the start of the workers"


if __name__ == "__main__":
    launch(main)
