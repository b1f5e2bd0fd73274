"""A sweep from start to end: what is missing in the store is answered and written, block by block."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

import numpy as np

from leblanc.scene.schema.load import SceneFault, SceneFaults, shown
from leblanc.studies.sweep.block import Block, BlockAnswer
from leblanc.studies.sweep.outputs import PENDING
from leblanc.studies.sweep.sampling import Rows, sample_rows
from leblanc.studies.sweep.store import Store, field_values, locked, open_store, write_block
from leblanc.studies.sweep.study import Sweep
from leblanc.studies.sweep.workers import answer_blocks, require_scheduler
from meshes.errors import InputError

Progress = Callable[[int, int], None]


def run_sweep(
    sweep: Sweep,
    folder: Path,
    workers: int | None = None,
    scheduler: str | None = None,
    fresh: bool = False,
    progress: Progress | None = None,
) -> Store:
    """Answer every sample that the store does not hold yet.

    It may be ended at any moment, however rudely; the same call goes on from the finished blocks, and the
    store comes out the same, byte for byte, whatever the workers.

    Parameters
    ----------
    sweep : the scenes
    folder : that holds the store
    workers : local processes, 0 to work in this one; None for one on each core
    scheduler : address of a Dask scheduler, in place of local processes
    fresh : throw away a store that is there
    progress : called with the number of samples finished and of all

    Returns
    -------
    The store, complete.

    Raises
    ------
    InputError : another process works on the store, it belongs to another sweep, the cluster does not fit
    SceneFaults : the scene asks for what no sample can answer
    NotConverged : the cluster was lost
    """
    if fresh and scheduler is not None:
        require_scheduler(scheduler)  # before the old store is gone
    with locked(folder):
        store = open_store(folder, sweep, fresh)
        missing = _missing(store)
        finished = sweep.samples - sum(stop - start for start, stop in map(store.bounds, missing))
        if progress is not None:
            progress(finished, sweep.samples)
        if not missing:
            return store
        _probe(sweep)
        rows = sample_rows(sweep)
        blocks = (_block(sweep, store, rows, number) for number in missing)
        with _interrupts() as interrupted:
            for answer in answer_blocks(blocks, _workers(workers, len(missing)), scheduler):
                _write(sweep, store, rows, answer)
                start, stop = store.bounds(answer.number)
                finished += stop - start
                if progress is not None:
                    progress(finished, sweep.samples)
                if interrupted.is_set():
                    raise KeyboardInterrupt
    return store


@contextmanager
def _interrupts() -> Iterator[threading.Event]:
    """What tells of a Ctrl-C that was lost: Python drops one that comes while it destroys an object."""
    seen = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield seen  # only the main thread may set handlers
        return
    before, complain = signal.getsignal(signal.SIGINT), sys.unraisablehook

    def note(number: int, frame: FrameType | None) -> None:
        seen.set()
        if callable(before):
            before(number, frame)

    def drop(what: sys.UnraisableHookArgs) -> None:
        if what.exc_type is not KeyboardInterrupt:
            complain(what)

    if before is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, note)
    sys.unraisablehook = drop
    try:
        yield seen
    finally:
        signal.signal(signal.SIGINT, before)
        sys.unraisablehook = complain


def _missing(store: Store) -> list[int]:
    """Numbers of the blocks that are not finished."""
    return np.flatnonzero(store.read("status")[:: store.block] == PENDING).tolist()


def _workers(asked: int | None, blocks: int) -> int:
    """As many as there are cores and work; a process of its own is not worth one block."""
    if asked is not None:
        return asked
    import os

    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return 0 if blocks == 1 else min(cores, blocks)


def _probe(sweep: Sweep) -> None:
    """Answer the scene itself: what no sample can answer is one fault then, not as many as samples."""
    from leblanc.studies.batch import answer_scenes

    if any(one.path == "model.liquid" for one in sweep.fields):
        return
    try:
        answer_scenes([sweep.scene])
    except InputError as error:
        raise SceneFaults(
            [SceneFault(sweep.scene_path, error.field, shown(error.value), error.allowed)]
        ) from error


def _block(sweep: Sweep, store: Store, rows: Rows, number: int) -> Block:
    drawn = rows(*store.bounds(number))
    values = tuple(
        tuple(field.value(one) for field, one in zip(sweep.fields, row, strict=True)) for row in drawn
    )
    return Block(number, sweep.table, tuple(field.keys for field in sweep.fields), values)


def _write(sweep: Sweep, store: Store, rows: Rows, answer: BlockAnswer) -> None:
    drawn = rows(*store.bounds(answer.number))
    variables = {field.path: field_values(field, drawn[:, j]) for j, field in enumerate(sweep.fields)}
    variables |= answer.values
    variables["reason"] = np.array(answer.reason, dtype=object)
    write_block(store, answer.number, variables, answer.status)
