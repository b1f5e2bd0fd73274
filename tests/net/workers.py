"""Commands in processes of their own: none sees what another left behind, none loads the libraries again."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import multiprocessing
import os
import pkgutil
import shutil
import sys
import time
import traceback
import warnings
from collections.abc import Iterator, Sequence
from multiprocessing.connection import Connection, wait
from multiprocessing.context import BaseContext
from multiprocessing.process import BaseProcess
from pathlib import Path
from types import ModuleType
from typing import cast

from tests.net.answers import Answer, answer
from tests.net.call import ROOT, packages
from tests.net.cases import Case
from tests.net.scenes import write_inputs

_PATIENCE = 1800.0  # seconds for one command
# Loaded once, before the processes split off; those that are not there are skipped.
_LIBRARIES = (
    *("numpy", "scipy.optimize", "scipy.sparse.linalg", "scipy.integrate", "scipy.stats", "scipy.special"),
    *("matplotlib.figure", "matplotlib.backends.backend_agg", "matplotlib.backends.backend_svg"),
    *("xarray", "h5netcdf", "pint", "pydantic", "jinja2", "numba", "pde", "skfem", "rich.progress", "typer"),
    *("zarr", "SALib", "sklearn.gaussian_process"),
)


def run_all(
    cases: Sequence[Case], scratch: Path, jobs: int, shaken: bool = False
) -> Iterator[tuple[Case, Answer, float]]:
    """Answers of all cases and the processor seconds each took, in the order of the cases.

    Parameters
    ----------
    cases : the commands
    scratch : folder for inputs and outputs
    jobs : how many at a time
    shaken : inputs changed by rounding
    """
    inputs = scratch / "inputs"
    write_inputs(inputs, shaken)
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
    if len(cases) > 2 * jobs and context.get_start_method() == "fork":
        _load()
    waiting = list(enumerate(cases))
    running: dict[Connection, tuple[int, BaseProcess, float]] = {}
    done: dict[int, tuple[Answer, float]] = {}
    told = 0
    while waiting or running:
        while waiting and len(running) < jobs:
            k, case = waiting.pop(0)
            pipe, process = _start(context, case, inputs, scratch / case.name)
            running[pipe] = k, process, time.perf_counter()
        for ready in wait(list(running), timeout=1.0):
            k, process, _ = running.pop(cast(Connection, ready))
            done[k] = _received(cast(Connection, ready))
            process.join()
            shutil.rmtree(scratch / cases[k].name, ignore_errors=True)
        for _, process, began in running.values():
            if time.perf_counter() - began > _PATIENCE:
                process.kill()  # the pipe then ends, which is an answer
        while told in done:
            yield cases[told], *done.pop(told)
            told += 1


def _start(context: BaseContext, case: Case, inputs: Path, folder: Path) -> tuple[Connection, BaseProcess]:
    """A process that runs a command, and the end of a pipe at which its answer comes out."""
    ours, theirs = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(theirs, case, inputs, folder))  # type: ignore[attr-defined]
    process.start()
    theirs.close()  # so that the pipe ends with the process
    return ours, process


def _received(ours: Connection) -> tuple[Answer, float]:
    """What a process sent before it ended."""
    try:
        found: tuple[Answer, float] = ours.recv()
    except EOFError:
        found = {"code": "the process died"}, 0.0
    finally:
        ours.close()
    return found


def _work(theirs: Connection, case: Case, inputs: Path, folder: Path) -> None:
    """One command in a folder of its own that has the inputs."""
    shutil.copytree(inputs, folder)
    os.chdir(folder)
    with (folder.parent / f"{case.name}.log").open("wb") as log:
        for stream in (1, 2):  # what compiled libraries print is no part of the answer
            os.dup2(log.fileno(), stream)
    try:
        found = answer(case, folder)
    except Exception:
        found = {"code": traceback.format_exc()}
    spent = os.times()
    theirs.send((found, spent.user + spent.system + spent.children_user + spent.children_system))
    theirs.close()


def _load() -> None:
    """Import what commands need, so that the processes that split off have it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name in _LIBRARIES:
            if importlib.util.find_spec(name.partition(".")[0]):
                importlib.import_module(name)
        for name in packages():
            package = importlib.import_module(name)
            assert Path(str(package.__file__)).is_relative_to(ROOT), f"{name} is of another checkout"
            _load_all(package)


def _load_all(package: ModuleType) -> None:
    """Import all modules of a package; those of an extra that is not installed are skipped."""
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.", onerror=lambda name: None):
        if not module.name.endswith("__main__"):
            with contextlib.suppress(ImportError):
                importlib.import_module(module.name)
