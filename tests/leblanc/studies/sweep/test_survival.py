"""Sweeps in processes of their own, some of which are killed: the store ends the same, byte for byte."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from leblanc.studies.sweep.block import PENDING
from leblanc.studies.sweep.store import STORE, read_store
from leblanc.studies.sweep.study import run_sweep
from tests.oracles.sweeps import ROOT, STUDY, leblanc, study_in, tree, write_study

psutil = pytest.importorskip("psutil")

DEADLINE = 300.0  # s; far beyond what any of these takes on a busy machine
MANY = STUDY.replace("samples = 256", "samples = 6000")  # fifty blocks of 120


def until(process: subprocess.Popen[str], true: Callable[[], bool]) -> bool:
    """Wait until something is true; False if the process ended before."""
    end = time.monotonic() + DEADLINE
    while not true():
        assert time.monotonic() < end, "nothing happened"
        with suppress(subprocess.TimeoutExpired):
            process.wait(0.005)
            return true()
    return True


def finished(folder: Path) -> int:
    """Blocks that are marked as finished."""
    marks = folder / STORE / "status" / "c"
    return len([one for one in marks.glob("*") if one.name.isdecimal()]) if marks.exists() else 0


def complete(process: subprocess.Popen[str]) -> str:
    """Let it end well; what it said."""
    out, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0, err
    assert "Traceback" not in err, err
    return str(out)


def undisturbed(folder: Path, study: str) -> dict[str, bytes]:
    """The store of a sweep that nothing happens to, in this process."""
    run_sweep(study_in(folder, study), folder / "out", workers=0)
    return tree(folder / "out" / STORE)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The store that each of the disturbed sweeps must end with."""
    return undisturbed(tmp_path_factory.mktemp("whole"), MANY)


def children(process: subprocess.Popen[str]) -> list[psutil.Process]:
    return list(psutil.Process(process.pid).children(recursive=True))


def workers_of(process: subprocess.Popen[str]) -> list[psutil.Process]:
    """Its children that answer blocks, not those that only keep watch."""
    return [one for one in children(process) if "spawn_main" in " ".join(one.cmdline())]


def test_the_store_does_not_depend_on_the_workers(tmp_path: Path) -> None:
    study = STUDY.replace("samples = 256", "samples = 70")
    (tmp_path / "alone").mkdir()
    alone = undisturbed(tmp_path / "alone", study)
    write_study(tmp_path, study)
    out = complete(leblanc("study.toml", "--workers", "2", "--out", "out", "--json", cwd=tmp_path))
    assert tree(tmp_path / "out" / STORE) == alone
    assert json.loads(out)["done"] == 70


@pytest.mark.slow
def test_one_worker_two_workers_one_store(tmp_path: Path, whole: dict[str, bytes]) -> None:
    write_study(tmp_path, MANY)
    for workers in ("1", "2"):
        complete(leblanc("study.toml", "--workers", workers, "--out", workers, cwd=tmp_path))
        assert tree(tmp_path / workers / STORE) == whole


@pytest.mark.slow
@pytest.mark.parametrize("workers", ["0", "2"])
def test_killed_at_ten_moments_and_started_again(
    tmp_path: Path, whole: dict[str, bytes], workers: str
) -> None:
    write_study(tmp_path, MANY)
    command = ("study.toml", "--workers", workers, "--out", "out")
    moments, killed = random.Random(3), 0
    for _ in range(10):
        process = leblanc(*command, cwd=tmp_path)
        before = finished(tmp_path / "out")
        more = moments.randrange(1, 5)
        running = until(process, lambda at=before + more: finished(tmp_path / "out") >= at)  # type: ignore[misc]
        with suppress(subprocess.TimeoutExpired):  # and a moment more, anywhere in a block
            process.wait(moments.random() * 0.1)
        assert running
        if process.poll() is None:
            process.kill()
            killed += 1
        process.communicate(timeout=DEADLINE)
        if finished(tmp_path / "out"):
            status = read_store(tmp_path / "out" / STORE).read("status")
            assert (status != PENDING).sum() >= 120 * before  # nothing is lost
    assert killed == 10
    complete(leblanc(*command, cwd=tmp_path))
    assert tree(tmp_path / "out" / STORE) == whole


@pytest.mark.slow
def test_workers_end_with_the_process_that_started_them(tmp_path: Path) -> None:
    write_study(tmp_path, MANY)
    process = leblanc("study.toml", "--workers", "2", "--out", "out", cwd=tmp_path)
    assert until(process, lambda: finished(tmp_path / "out") > 2)
    below = children(process)
    assert len(below) >= 2
    process.kill()
    process.communicate(timeout=DEADLINE)
    _, alive = psutil.wait_procs(below, timeout=20.0)
    assert not alive


@pytest.mark.slow
def test_a_worker_that_dies_is_replaced(tmp_path: Path, whole: dict[str, bytes]) -> None:
    write_study(tmp_path, MANY)
    process = leblanc("study.toml", "--workers", "2", "--out", "out", cwd=tmp_path)
    assert until(process, lambda: finished(tmp_path / "out") > 2)
    workers_of(process)[0].kill()
    complete(process)
    assert tree(tmp_path / "out" / STORE) == whole


@pytest.mark.slow
@pytest.mark.parametrize("workers", ["0", "2"])
def test_an_interrupt_keeps_what_is_finished(tmp_path: Path, whole: dict[str, bytes], workers: str) -> None:
    write_study(tmp_path, MANY)
    command = ("study.toml", "--workers", workers, "--out", "out")
    process = leblanc(*command, cwd=tmp_path, start_new_session=True)
    assert until(process, lambda: finished(tmp_path / "out") > 2)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does: to all of them
    _, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 130
    assert err.splitlines()[-1] == "leblanc: interrupted"
    assert "Traceback" not in err
    kept = finished(tmp_path / "out")
    assert kept > 2
    complete(leblanc(*command, cwd=tmp_path))
    assert tree(tmp_path / "out" / STORE) == whole


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[tuple[str, list[subprocess.Popen[str]]]]:
    """A Dask scheduler and its workers, each a process of its own."""
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    file = folder / "scheduler.json"

    def start(*arguments: str) -> subprocess.Popen[str]:
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        command = [sys.executable, "-m", *arguments, "--scheduler-file", str(file), "--no-dashboard"]
        return subprocess.Popen(command, cwd=folder, env=environment, text=True, **quiet)  # type: ignore[call-overload, no-any-return]

    def there() -> bool:
        return file.exists() and file.read_text(encoding="utf-8").endswith("}")

    running = [start("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0")]
    try:
        assert until(running[0], there)
        address = json.loads(file.read_text(encoding="utf-8"))["address"]
        worker = ("distributed.cli.dask_worker", "--nthreads", "1", "--no-nanny")
        running.extend(start(*worker) for _ in range(workers))
        yield address, running[1:]
    finally:
        for one in reversed(running):
            one.kill()
            one.wait(DEADLINE)


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_ends_the_sweep(tmp_path: Path, whole: dict[str, bytes]) -> None:
    write_study(tmp_path, MANY)
    with cluster(tmp_path, 2) as (address, workers):
        process = leblanc("study.toml", "--scheduler", address, "--out", "out", cwd=tmp_path)
        assert until(process, lambda: finished(tmp_path / "out") > 5)
        workers[0].kill()
        workers[0].wait(DEADLINE)
        assert finished(tmp_path / "out") < 50
        complete(process)
        assert workers[1].poll() is None
    assert tree(tmp_path / "out" / STORE) == whole


@pytest.mark.slow
def test_a_cluster_that_is_lost_is_said(tmp_path: Path) -> None:
    write_study(tmp_path, MANY)
    with cluster(tmp_path, 1) as (address, _):
        process = leblanc("study.toml", "--scheduler", address, "--out", "out", cwd=tmp_path)
        assert until(process, lambda: finished(tmp_path / "out") > 2)
    _, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 3
    assert "the cluster was lost; finished blocks are kept" in err
    assert "Traceback" not in err


@pytest.mark.slow
def test_no_cluster_is_said(tmp_path: Path) -> None:
    write_study(tmp_path)
    for address in ("tcp://127.0.0.1:9", "nonsense://x"):
        process = leblanc("study.toml", "--scheduler", address, "--out", "out", cwd=tmp_path)
        _, err = process.communicate(timeout=DEADLINE)
        assert process.returncode == 2
        (line,) = err.splitlines()
        assert line.startswith(f"leblanc: --scheduler = '{address}': must be the address of a Dask scheduler")
