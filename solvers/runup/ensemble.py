"""Range of a run-up under rounding: the same run many times, its unbalance changed in the last digits.

Where walls run dry such a difference grows until it is seen: one run is then one of many possible ones.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.arrays import Array
from meshes.errors import InputError
from meshes.quantity import Q
from solvers.rotor.system import RotorSystem
from solvers.runup.machine import Drive, RunupModel
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up

# Relative, of the unbalance: some hundred times rounding, as the steps of a long run gather it.
CHANGE = 1e-13
MOST = 10_000  # members


@dataclass(frozen=True)
class EnsembleTask:
    """One run of an ensemble; the parameters are those of `solvers.runup.runup.run_up`, with its number."""

    system: RotorSystem
    fills: tuple[Fill, ...]
    drive: Drive
    friction: Friction
    gravity: float
    numerics: RunupNumerics
    model: RunupModel


@dataclass(frozen=True)
class Member:
    """What is kept of a run of an ensemble."""

    amplitude: Array  #: modulus of the first deflection at the times that were reached, m, shape (j,)
    largest: Array  #: largest amplitude since the time before, m, shape (j,)
    time: Array | None = None  #: those times, s, shape (j,); None where they are those of all runs
    ended: bool | None = None  #: it came to its end; None where the number of times says so


@dataclass(frozen=True)
class Spread:
    """The range of an ensemble over k times."""

    asked: Annotated[int, Q("1", text="runs that were wanted, the unchanged one among them", data=False)]
    members: Annotated[int, Q("1", text="those of them that were made", data=False)]
    lost: Annotated[int, Q("1", text="how many of those did not come to their end", data=False)]
    change: Annotated[float, Q("1", "largest relative change of the unbalance", data=False)]
    seed: Annotated[int, Q("1", text="random seed of the changes", data=False)]
    #: of the modulus of the first deflection, nan where no member came so far
    amplitude_min: Annotated[
        Array, Q("m", "amplitude, min over runs that rounding tells apart", over=("time",))
    ]
    amplitude_max: Annotated[
        Array, Q("m", "amplitude, max over runs that rounding tells apart", over=("time",))
    ]
    amplitude_median: Annotated[
        Array, Q("m", "amplitude, median over runs that rounding tells apart", over=("time",))
    ]
    #: of all ways, the unchanged run first, shape (members,)
    peaks: Annotated[Array, Q("m", "largest amplitude of every member", over=("member",), data=False)]

    @property
    def peak_spread(self) -> Annotated[float, Q("1", "range of the peaks over the median", data=False)]:
        """Difference of the largest and the smallest peak over the median one; 0 where nothing moves."""
        middle = float(np.median(self.peaks))
        return float(np.ptp(self.peaks)) / middle if middle > 0.0 else 0.0

    @property
    def largest_spread(
        self,
    ) -> Annotated[float, Q("1", "widest range at one time over the median peak", data=False)]:
        """Largest width of the range at one time over the median peak; 0 where nothing moves."""
        middle = float(np.median(self.peaks))
        width = float(np.nanmax(self.amplitude_max - self.amplitude_min, initial=0.0))
        return width / middle if middle > 0.0 else 0.0


def ensemble(
    system: RotorSystem,
    fills: Sequence[Fill],
    drive: Drive,
    friction: Friction,
    gravity: float,
    numerics: RunupNumerics,
    model: RunupModel,
    count: int,
    seed: int = 0,
) -> list[EnsembleTask]:
    """Runs whose unbalance is changed by up to `CHANGE`, by numbers that depend on seed and run alone."""
    if not 1 <= count <= MOST:
        raise InputError("ensemble", count, f"from 1 to {MOST}")
    if seed < 0:
        raise InputError("seed", seed, "0 or more")
    alone, tasks = replace(numerics, companion=False), []
    for member in range(count):
        part = CHANGE * np.random.default_rng([seed, member]).uniform(-1.0, 1.0)
        changed = replace(system, unbalance=system.unbalance * (1.0 + part))
        tasks.append(EnsembleTask(changed, tuple(fills), drive, friction, gravity, alone, model))
    return tasks


def run_member(task: EnsembleTask) -> Member:
    """One run of an ensemble."""
    history = run_up(
        *(task.system, task.fills, task.drive, task.friction, task.gravity, task.numerics),
        model=task.model,
    )
    return member_of(history)


def member_of(history: RunupHistory) -> Member:
    """What an ensemble keeps of a run."""
    return Member(history.amplitude, history.largest, history.time, history.converged)


def spread_over(members: Iterable[Member], asked: int, count: int, seed: int) -> Spread:
    """The range of an ensemble, the unchanged run first among its members."""
    runs = list(members)
    amplitude = np.full((len(runs), count), np.nan)
    for row, run in zip(amplitude, runs, strict=True):
        found = _at_times_of(runs[0], run)
        reached = min(count, found.size)
        row[:reached] = found[:reached]
    known = ~np.isnan(amplitude).all(axis=0)
    low, high, middle = (np.full(count, np.nan) for _ in range(3))
    low[known], high[known] = np.nanmin(amplitude[:, known], axis=0), np.nanmax(amplitude[:, known], axis=0)
    middle[known] = np.nanmedian(amplitude[:, known], axis=0)
    return Spread(
        asked=asked,
        members=len(runs),
        lost=sum(_lost(run, count) for run in runs),
        change=CHANGE,
        seed=seed,
        amplitude_min=low,
        amplitude_max=high,
        amplitude_median=middle,
        peaks=np.array([run.largest.max() for run in runs]),
    )


def _at_times_of(first: Member, run: Member) -> Array:
    """Amplitudes of a run at the times of the first: a drum that coasts has corners of its own."""
    if run.time is None or first.time is None or np.array_equal(run.time, first.time[: run.time.size]):
        return run.amplitude
    reached = first.time[first.time <= run.time[-1] * (1.0 + 1e-9)]
    return np.asarray(np.interp(reached, run.time, run.amplitude))


def _lost(run: Member, count: int) -> bool:
    """Whether a run did not come to its end."""
    return run.amplitude.size < count if run.ended is None else not run.ended
