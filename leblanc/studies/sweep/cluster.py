"""Blocks of a sweep answered in this process, in local ones or on a cluster: the only door to dask."""

from __future__ import annotations

import atexit
import logging
import signal
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from tempfile import TemporaryDirectory
from typing import Any

from leblanc.core.answer import NotConverged
from leblanc.core.interrupts import held
from leblanc.studies.sweep.block import Block, BlockAnswer, answer_block, own_versions, reason_of
from meshes.errors import InputError

AHEAD = 2  # blocks in flight for each thread: one at work, one waiting
# Of local workers: memory is given back in large pieces only. With Dask's own choice, 64 kB, a quarter of the
# time goes into page faults.
_ENVIRONMENT = {
    f"distributed.nanny.pre-spawn-environ.MALLOC_{kind}_THRESHOLD_": 2**28 for kind in ("TRIM", "MMAP")
} | {"distributed.nanny.pre-spawn-environ.PYTHONSAFEPATH": 1}  # nothing from the current folder
_PATIENCE = 30.0  # seconds for a cluster to answer and to have a worker


def answer_blocks(
    blocks: Iterable[Block], workers: int = 0, scheduler: str | None = None
) -> Iterator[BlockAnswer]:
    """Answers of blocks, in the order in which they are done.

    The blocks are taken one by one, and only a few are ever waiting; the answers do not depend on where they
    come from.
    """
    if scheduler is None and workers == 0:
        for block in blocks:
            yield answer_block(block)
        return
    with client_of(workers, scheduler) as client:
        yield from _answers(client, blocks)


@contextmanager
def client_of(workers: int, scheduler: str | None) -> Iterator[Any]:
    """A client of local processes or of a running cluster."""
    import dask
    from distributed import Client, LocalCluster
    from distributed.deploy.spec import close_clusters

    for name in ("distributed", "distributed.client", "distributed.utils"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what goes wrong is said by `_cluster_faults`
    if scheduler is not None:
        with _connected(scheduler) as client:
            yield client
        return
    # Dask's own choice of a folder is shared by all users of the machine, and what it keeps is unpickled.
    with (
        TemporaryDirectory(prefix="leblanc-", ignore_cleanup_errors=True) as folder,
        _deaf_loop() as loop,
        dask.config.set(_ENVIRONMENT),
    ):
        try:
            cluster = LocalCluster(
                loop=loop,
                local_directory=folder,
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address=":0",  # any free port, so that a second sweep finds one as well
                scheduler_kwargs={"dashboard": False},
                silence_logs=logging.CRITICAL,
            )
        except (KeyboardInterrupt, SystemExit):
            # As Python ends Dask would wait ten seconds for what is half begun; its workers end without it.
            atexit.unregister(close_clusters)
            raise
        client = None
        try:
            client = Client(cluster)
            yield client
        finally:
            # Half closed they wait for each other. Where this takes long the process ends, workers with it.
            with held():
                if client is not None:
                    client.close()
                cluster.close()


def require_scheduler(address: str) -> None:
    """Raise unless a cluster with a worker answers."""
    with client_of(0, address):
        pass


@contextmanager
def _connected(address: str) -> Iterator[Any]:
    """A client of a running cluster that has a worker."""
    from distributed import Client

    try:
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError) as error:
        allowed = "the address of a Dask scheduler that answers, such as tcp://host:8786"
        raise InputError("scheduler", address, allowed) from error
    with client:
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except TimeoutError as error:
            raise InputError("scheduler", address, "a cluster with at least one worker") from error
        yield client


@contextmanager
def _deaf_loop() -> Iterator[Any]:
    """A loop whose processes do not see a Ctrl-C, which goes to all of a terminal; this one ends them.

    They inherit from its thread that it is held back. This thread hears it at once, as they start too.
    """
    from multiprocessing.resource_tracker import ensure_running

    from distributed.utils import LoopRunner

    ensure_running()  # which would let it through again to what starts after it
    runner = LoopRunner(asynchronous=False)
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        runner.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    try:
        yield runner.loop
    finally:
        runner.stop()


def _answers(client: Any, blocks: Iterable[Block]) -> Iterator[BlockAnswer]:
    """Answers as they are done, with a bounded number of blocks in flight."""
    from distributed import wait

    waiting = iter(blocks)
    flying: set[Any] = set()
    while True:
        with _cluster_faults():
            threads = max(1, sum(client.nthreads().values()))  # workers come and go
            room = max(0, AHEAD * threads - len(flying))
            flying |= {client.submit(answer_block, block, pure=False) for block in islice(waiting, room)}
            if not flying:
                return
            done = wait(flying, return_when="FIRST_COMPLETED").done
            answers = [_checked(future.result()) for future in done]
        flying -= done
        yield from answers


@contextmanager
def _cluster_faults() -> Iterator[None]:
    """What can go wrong with a cluster, in words."""
    from distributed import CancelledError, KilledWorker

    kept = "finished blocks are kept; run the same command to go on"
    try:
        yield
    except KilledWorker as error:
        raise NotConverged([f"a block ended {error.allowed_failures + 1} workers; {kept}"]) from error
    except MemoryError as error:
        raise NotConverged([f"a block did not fit the memory of its worker; {kept}"]) from error
    except (CancelledError, OSError) as error:
        raise NotConverged([f"the cluster was lost; {kept}"]) from error
    except (ImportError, AttributeError) as error:
        if isinstance(error, AttributeError) and "Can't get attribute" not in str(error):
            raise
        raise _other_version(reason_of(error)) from error  # the task itself is unknown there


def _checked(answer: BlockAnswer) -> BlockAnswer:
    """The answer, if it comes from the same code as this process runs."""
    own = own_versions()
    for package, version in answer.versions.items():
        if own[package] != version:
            raise _other_version(f"one has {package} {version}")
    return answer


def _other_version(found: str) -> InputError:
    needed = ", ".join(f"{package} {version}" for package, version in own_versions().items())
    return InputError("scheduler", found, f"a cluster whose workers have {needed}")
