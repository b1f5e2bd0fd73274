"""Means over stretches of time of what a py-pde run measures, and a run that ends when they stay the same."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol, TypeVar

import numpy as np
from pde.trackers.base import FinishedSimulation, TrackerBase
from pde.trackers.interrupts import FixedInterrupts
from pde.trackers.trackers import CallbackTracker

from meshes.arrays import Array, Complex
from solvers.liquid_model import Whirl

# How an equation says where the liquid is.
P = TypeVar("P")

_PERIODS = 400
_TURNS = 20_000.0  # rad of spin
_MOST = 64  # periods in a stretch
_EARLY = 1e-6  # of a whirl period, by which a stop may be off


class Measured(Protocol[P]):
    """An equation whose loads can be taken at a moment and as means over a time."""

    def loads(self, state: Any, t: float) -> Array:
        """Loads at one moment, shape (m,)."""
        ...

    def place(self, state: Any, t: float) -> P:
        """Where the liquid is at one moment, in the frame of the deflection."""
        ...

    def means(self, loads: Array, length: float, places: tuple[P, P]) -> Complex:
        """Means over a length of time from the integrals of the loads and the places at both ends."""
        ...


@dataclass(frozen=True)
class Stretches:
    """Stretches of whirl periods, one behind the other."""

    periods: Sequence[int]  #: whirl periods in each, shape (k,)
    start: float  #: of the first one, s
    period: float  #: of the whirl seen from the drum, s

    @property
    def ends(self) -> Array:
        """Start of the first and end of each, s, shape (k + 1,)."""
        return np.asarray(self.start + self.period * np.cumsum((0, *self.periods)))

    def stops(self, samples: int) -> Array:
        """`ends` with stops between them, so many in each whirl period, s."""
        ends = self.ends
        counts = [n * samples + 1 for n in self.periods]
        parts = [np.linspace(*span)[1:] for span in zip(ends, ends[1:], counts, strict=False)]
        return np.concatenate([ends[:1], *parts])


def gently(whirl: Whirl) -> Whirl:
    """A whirl with a ramp, its own if it has one."""
    # The slowest natural sloshing wave turns in some 30/Omega: a ramp of ten of them hardly stirs it.
    return whirl if whirl.ramp else replace(whirl, ramp=max(6.0 * whirl.period, 300.0 / whirl.spin))


def settling(whirl: Whirl, synchronous: bool) -> Stretches:
    """Stretches of ever more whirl periods, until a layer has had time enough to settle.

    The first one begins when the whirl has grown; a synchronous layer starts from its equilibrium.
    """
    count = 2 if synchronous else max(1, round(100.0 / (whirl.period * whirl.spin)))
    grown = 0 if synchronous else int(np.ceil(whirl.ramp / whirl.period))
    periods: list[int] = []
    while sum(periods) < _PERIODS and (grown + sum(periods)) * whirl.period * whirl.spin < _TURNS:
        periods.append(count)
        if len(periods) % 3 == 0:
            count = min(2 * count, _MOST)
    return Stretches(periods, grown * whirl.period, whirl.period)


class StretchMeans(TrackerBase):  # type: ignore[no-untyped-call]
    """Tracker of means over stretches of time, which ends the run where two neighbours agree.

    They agree where their first means differ by less than `settled`, relative; None: never. Loads come from
    the solver, if its `info` adds them up as "loads" (`samples` 0); else they are taken at `samples` stops in
    each whirl period and joined by straight lines.
    """

    name = "stretch_means"

    def __init__(
        self, equation: Measured[Any], stretches: Stretches, samples: int = 0, settled: float | None = None
    ) -> None:
        super().__init__(FixedInterrupts(stretches.stops(samples) if samples else stretches.ends))
        self.equation, self.stretches, self.samples, self.settled = equation, stretches, samples, settled
        self.rows: list[Complex] = []
        self.steady = False
        self.last: tuple[Any, float] | None = None  # state at the end of the last stretch, and when
        self.fields: list[tuple[float, Array]] = []  # at the start and at the end of each stretch
        self._place: Any = None  # of the liquid there
        self._ends, self._early = stretches.ends, _EARLY * stretches.period
        self._solver: dict[str, Any] = {}
        self._loads: Array = np.zeros(1)  # integrals up to now, of those taken at each stop
        self._begun: Array = np.zeros(1)  # integrals up to where the stretch began
        self._before: tuple[Array, float] | None = None  # loads at the last stop, and when

    def initialize(self, field: Any, info: dict[str, Any] | None = None) -> float:
        """See `pde.TrackerBase`."""
        self._solver = (info or {}).get("solver", {})
        return float(super().initialize(field, info))

    def handle(self, field: Any, t: float) -> None:
        """See `pde.TrackerBase`; raises `FinishedSimulation` where the means no longer change."""
        loads = self._taken(field, t) if self.samples else self._solver["loads"]
        if t < self._ends[len(self.rows) + (self.last is not None)] - self._early:
            return
        place = self.equation.place(field, t)
        self.fields.append((t, np.copy(field.data)))
        if self.last is None:
            self.last = field.copy(), t
        else:
            state, before = self.last
            state.data[...] = field.data
            self.last = state, t
            row = self.equation.means(loads - self._begun, t - before, (self._place, place))
            self.rows.append(row)
        self._place, self._begun = place, np.copy(loads)
        if self.settled is not None and len(self.rows) > 1:
            before, now = self.rows[-2][0], self.rows[-1][0]
            if abs(now - before) <= self.settled * abs(now):
                self.steady = True
                raise FinishedSimulation("the means no longer change")

    def _taken(self, field: Any, t: float) -> Array:
        """Integrals of the loads up to now, by the trapezium between the stops."""
        loads = self.equation.loads(field, t)
        if self._before is not None:
            self._loads = self._loads + 0.5 * (t - self._before[1]) * (self._before[0] + loads)
        self._before = loads, t
        return self._loads


def run(
    equation: Any,
    state: Any,
    means: StretchMeans,
    solver: str,
    options: dict[str, Any],
    progress: Callable[[float], object] | None = None,
) -> str:
    """Solve an equation over stretches of time, to their end or until the means stay the same.

    The means have the state that was reached; returned is why the run went no further, or empty.
    """
    stop = float(means.stretches.ends[-1])
    trackers: list[Any] = [means]
    if progress is not None:
        # At the same stops, so that no digit depends on who looks on.
        times = means.interrupt.copy()  # type: ignore[no-untyped-call]
        trackers.append(CallbackTracker(lambda _, t: progress(t / stop), times))
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # of steps that are then refused
            equation.solve(state, stop, tracker=trackers, solver=solver, **options)
    except RuntimeError as fault:  # py-pde's solvers have no other
        return str(equation.diagnostics["solver"].get("reason", fault))
    return ""
