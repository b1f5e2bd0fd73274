"""Contestants and how they are timed: warmed up, interleaved, best of several repeats, on one core."""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Answer = NDArray[np.float64] | NDArray[np.complex128]
Go = Callable[[], Answer]
# Of runs longer than this, s, one is timed.
_LONG = 20.0


@dataclass(frozen=True)
class Contestant:
    """One code with one setting on one problem."""

    code: str  #: its name
    setting: str  #: method, resolution, step
    #: builds everything that is built once and compiled; returns what sets the state back and returns the run
    #: to be timed
    prepare: Callable[[], Callable[[], Go]]
    size: int = 0  #: points or cells; 0 where there is no such number


@dataclass(frozen=True)
class Sample:
    """What one contestant reached."""

    code: str  #: as in `Contestant`
    setting: str
    size: int
    seconds: float  #: best of the repeats, s
    error: float  #: of the answer, relative; nan where the run failed
    first: float  #: time of building, compiling and the first run, s
    repeats: int  #: how many were timed
    note: str = ""  #: why there is no answer, in words; empty if there is one


def version(package: str) -> str | None:
    """Version of an installed package that can be imported; `module/distribution` where the names differ."""
    module, _, distribution = package.partition("/")
    if importlib.util.find_spec(module) is None:
        return None
    try:
        return importlib.metadata.version(distribution or module)
    except importlib.metadata.PackageNotFoundError:
        return "unknown version"


def one_core() -> int | None:
    """Hold this process and all threads it starts to one core; the core, None where that cannot be."""
    if not hasattr(os, "sched_setaffinity"):
        return None
    core = max(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {core})
    return core


def measure(
    contestants: Sequence[Contestant],
    error: Callable[[Answer], float],
    repeats: int = 5,
    progress: Callable[[str], None] = lambda _: None,
) -> list[Sample]:
    """Time contestants side by side: each once to warm up, then all in turn, again and again.

    Runs of more than 20 s are timed once; `progress` is called with what runs. One sample each, in order.
    """
    builds: list[Callable[[], Go] | None] = []
    rows: list[tuple[float, float, float, str]] = []
    for contestant in contestants:
        progress(f"{contestant.code}: {contestant.setting}")
        begin = time.perf_counter()
        seconds, wrong, note, build = float("nan"), float("nan"), "", None
        try:
            build = contestant.prepare()
            seconds, answer = _timed(build())
            wrong = error(answer)
            note = "" if np.isfinite(wrong) else "diverged"
        except (ArithmeticError, RuntimeError, ValueError, np.linalg.LinAlgError) as fault:
            # A peer that breaks down in a setting is a result: the table says so.
            note = (str(fault).strip() or type(fault).__name__).splitlines()[0][:120]
        rows.append((seconds, wrong, time.perf_counter() - begin, note))
        builds.append(None if note else build)
    times: list[list[float]] = [[] for _ in builds]
    for count in range(repeats):
        for build, row, mine in zip(builds, rows, times, strict=True):
            # One run is enough of what takes long.
            if build is not None and (count == 0 or row[0] < _LONG):
                mine.append(_timed(build())[0])
    return [
        Sample(
            contestant.code,
            contestant.setting,
            contestant.size,
            min(mine, default=float("nan")),
            wrong,
            first,
            len(mine),
            note,
        )
        for contestant, mine, (_, wrong, first, note) in zip(contestants, times, rows, strict=True)
    ]


def _timed(go: Go) -> tuple[float, Answer]:
    begin = time.perf_counter()
    answer = go()
    return time.perf_counter() - begin, answer
