"""Processes that work on parts of a question and end with their parent."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager

# Libraries of linear algebra with threads of their own are slower on matrices as small as ours.
_THREADS = "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"


@contextmanager
def processes(workers: int) -> Iterator[ProcessPoolExecutor]:
    """A pool of so many processes, which are ended with the block, whatever they are doing.

    What they compile must be on disk before: workers that find the kernels of another version there at the
    same time would mix the two.

    Parameters
    ----------
    workers : at least 1
    """
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ |= dict.fromkeys(_THREADS, "1")
    pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _begin)
    try:
        yield pool
    finally:
        for name, value in before.items():
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = value
        _end(pool)


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
    working = list((pool._processes or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in working:
        process.kill()
    for process in working:
        process.join()
