"""Held states on all cores: processes that hold one motion after the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager

from leblanc.studies.processes import processes
from solvers.held.branch import HeldTask, Runner
from solvers.held.integrate import compile_kernels, hold_with_error
from solvers.held.state import HeldMachine, HeldState, HoldNumerics


@contextmanager
def runner(machine: HeldMachine, numerics: HoldNumerics, workers: int) -> Iterator[Runner]:
    """A runner of tasks in so many processes; in this one where that is one or none."""
    if workers <= 1:
        yield lambda tasks: _here(machine, numerics, tasks)
        return
    with processes(workers) as pool:
        yield lambda tasks: _there(pool, machine, numerics, tasks)


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
