"""Many speeds: each from its synchronous motion, then with neighbours' motions carried up and down.

A motion that exists beyond the speed at which it began is found only from a neighbour: the second pass goes
from speed to speed wherever two neighbours are of different kinds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Flags
from solvers.held.state import HeldKind, HeldState, Moment

# Amplitudes of two motions are the same within this share of the larger.
_SAME = 0.01


@dataclass(frozen=True)
class HeldTask:
    """A motion to hold."""

    begin: Moment  #: where it begins, at its speed
    #: rate at which the slowest small motion dies or grows there, 1/s; 0 where it is not known
    slowest: float = 0.0


Runner = Callable[[Sequence[HeldTask]], Iterator[tuple[int, HeldState]]]


@dataclass(frozen=True)
class HeldBranches:
    """States over n rising speeds."""

    up: tuple[HeldState, ...]  #: as a machine meets them whose speed rises slowly
    #: as one meets them whose speed falls slowly; the same states where there is no hysteresis
    down: tuple[HeldState, ...]

    @property
    def hysteresis(self) -> Flags:
        """Where the way up and the way down differ, shape (n,)."""
        return np.array([not alike(a, b) for a, b in zip(self.up, self.down, strict=True)])


def alike(first: HeldState, second: HeldState) -> bool:
    """Whether two states of one speed are the same motion."""
    sizes = np.array([[state.amplitude, state.largest] for state in (first, second)])
    if not np.isfinite(sizes).all():
        return first is second or bool(np.isnan(sizes).all())
    return bool(np.all(np.abs(sizes[0] - sizes[1]) <= _SAME * sizes.max(axis=0)))


def held_branches(
    tasks: Sequence[HeldTask],
    run: Runner,
    forks: Flags | None = None,
    done: Callable[[int], object] = lambda _: None,
) -> HeldBranches:
    """Held states over rising speeds, up and down; the same in whatever order the runner answers.

    `forks`: where several steady motions are known to exist, so that neighbours are tried.
    """
    found: dict[int, HeldState] = {}
    for k, state in run(tasks):
        found[k] = state
        done(1)
    base = [found[k] for k in range(len(tasks))]
    several = np.zeros(len(tasks), dtype=bool) if forks is None else forks
    chains = [_Chain(base, tasks, several, way) for way in (1, -1)]
    # Both ways go on side by side, a speed at a time.
    while waiting := [(chain, task) for chain in chains if (task := chain.next()) is not None]:
        for k, state in run([task for _, task in waiting]):
            waiting[k][0].take(state)
            done(1)
    up, down = (tuple(chain.states) for chain in chains)
    return HeldBranches(up, down)


class _Chain:
    """A motion carried from speed to speed, one way."""

    def __init__(self, base: Sequence[HeldState], tasks: Sequence[HeldTask], forks: Flags, way: int) -> None:
        self.states, self.base, self.tasks, self.forks, self.way = list(base), base, tasks, forks, way
        self.here = 0 if way > 0 else len(base) - 1

    def next(self) -> HeldTask | None:
        """The next speed at which the neighbour's motion may be another one; None at the end."""
        while 0 <= self.here + self.way < len(self.states):
            last, here = self.states[self.here], self.here + self.way
            self.here = here
            if self._may_differ(last, here):
                begin = last.moment.at(self.tasks[here].begin.spin)
                # A guess would lead from a whirl to the steady motion.
                slowest = 0.0 if last.kind is HeldKind.LIMIT_CYCLE else self.tasks[here].slowest
                return HeldTask(begin, slowest)
        return None

    def _may_differ(self, last: HeldState, here: int) -> bool:
        base = self.base[here]
        if not last.settled or not np.array_equal(last.moment.layers, self.tasks[here].begin.layers):
            return False
        circles = HeldKind.STEADY, HeldKind.PERIODIC
        if last.kind is not HeldKind.LIMIT_CYCLE and self.tasks[here].slowest > 0.0:
            # Whatever comes, a whirl grows from it, as from what this speed began with.
            return False
        kinds = last.kind is not base.kind and not (last.kind in circles and base.kind in circles)
        return kinds or bool(self.forks[here])

    def take(self, state: HeldState) -> None:
        """The state that the neighbour's motion has come to."""
        if state.settled and not alike(state, self.base[self.here]):
            self.states[self.here] = state
