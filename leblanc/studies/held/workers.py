"""Held states on all cores: processes that hold one motion after the other, and end with their parent."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager

from solvers.held.branch import HeldTask, Runner
from solvers.held.hold import compile_kernels, hold_with_error
from solvers.held.state import HeldMachine, HeldState, HoldNumerics

# Libraries of linear algebra with threads of their own are slower on matrices as small as ours.
_THREADS = "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"


@contextmanager
def runner(machine: HeldMachine, numerics: HoldNumerics, workers: int) -> Iterator[Runner]:
    """A runner of tasks in so many processes; in this one where that is one or none.

    Parameters
    ----------
    machine, numerics : as for `solvers.held.hold.hold`
    workers : processes
    """
    if workers <= 1:
        yield lambda tasks: _here(machine, numerics, tasks)
        return
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ |= dict.fromkeys(_THREADS, "1")
    pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _begin)
    try:
        yield lambda tasks: _there(pool, machine, numerics, tasks)
    finally:
        for name, value in before.items():
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = value
        _end(pool)


def _here(
    machine: HeldMachine, numerics: HoldNumerics, tasks: Sequence[HeldTask]
) -> Iterator[tuple[int, HeldState]]:
    for k, task in enumerate(tasks):
        yield k, hold_with_error(machine, task.begin, numerics, task.slowest)


def _there(
    pool: ProcessPoolExecutor, machine: HeldMachine, numerics: HoldNumerics, tasks: Sequence[HeldTask]
) -> Iterator[tuple[int, HeldState]]:
    if tasks:
        # Workers that find the kernels of another version on disk at the same time would mix the two.
        compile_kernels(machine, tasks[0].begin)
    waiting: dict[Future[HeldState], int] = {
        pool.submit(hold_with_error, machine, task.begin, numerics, task.slowest): k
        for k, task in enumerate(tasks)
    }
    for future in as_completed(waiting):
        yield waiting[future], future.result()


def _begin() -> None:
    """In a worker: leave Ctrl-C to the parent, and end where that is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_outlive_nobody, args=(parent.sentinel,), daemon=True).start()


def _outlive_nobody(sentinel: int) -> None:
    multiprocessing.connection.wait([sentinel])
    os._exit(1)


def _end(pool: ProcessPoolExecutor) -> None:
    """End the workers at once, whatever they are doing."""
    processes = list((pool._processes or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.kill()
    for process in processes:
        process.join()
