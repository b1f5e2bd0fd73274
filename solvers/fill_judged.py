"""Points that a search has judged: what is said of them, and which is the best [theory: optimum, eq. 6]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Judgement:
    """What a judge says of m points.

    Parameters
    ----------
    objective : to be least; infinite where there is no value, shape (m,)
    excess : of the constraint that is exceeded most, relative; 0 or below where all hold, shape (m,)
    details : further values by name, shape (m,) each
    """

    objective: Array
    excess: Array
    details: dict[str, Array] = field(default_factory=dict)


Judge = Callable[[Array], Judgement]  # takes points, shape (m, n)


@dataclass(frozen=True)
class SearchPlan:
    """How much a search tries.

    Parameters
    ----------
    levels : of each coordinate in the grid, by the number of coordinates; beyond the last, lines instead
    crossed : expected coordinates become levels even of three and more; else those points join the grid
    finest : lowest level above the lower corner, over the box's width
    valleys : of the grid from which steps go down
    sweeps : of steps, at most
    settled : relative gain of a round below which a valley counts as followed to its end
    hair : values that differ by less, relative, count as equal in the end
    edge : distance at which the edge of a plateau or of what is allowed counts as found, over its place
    sections : into which such an edge is closed in at once
    """

    levels: tuple[int, ...] = (24, 11, 5)
    crossed: bool = True
    finest: float = 1e-4
    valleys: int = 3
    sweeps: int = 16
    settled: float = 2e-5
    hair: float = 1e-6
    edge: float = 1e-6
    sections: int = 32


def best_of(judged: Judgement, cost: Array, hair: float = 1e-6) -> int:
    """Index of the best of the points judged [theory: optimum, eq. 6].

    Those that exceed their constraints least, of these the least objective, of all within a hair of that the
    least cost, and of those the one that is farthest from exceeding anything.

    Parameters
    ----------
    judged : m points
    cost : of each, shape (m,)
    hair : relative
    """
    over = np.maximum(judged.excess, 0.0)
    left = np.flatnonzero(over <= over.min() * (1.0 + hair))
    for values in (judged.objective, cost, judged.excess):
        here = values[left]
        least = here.min()
        near = here <= least + hair * abs(least) if np.isfinite(least) else here == least
        left = left[near]
    return int(left[0])


class Log:
    """Asks the judge and keeps what it said."""

    def __init__(self, judge: Judge) -> None:
        self.judge = judge
        self.points: list[Array] = []
        self.said: list[Judgement] = []

    def __call__(self, points: Array) -> Judgement:
        """Judgement of points, shape (m, n); what is not a number counts as infinite."""
        said = self.judge(points)
        objective = np.where(np.isnan(said.objective), np.inf, said.objective)
        said = Judgement(objective, np.where(np.isnan(said.excess), np.inf, said.excess), said.details)
        self.points.append(points)
        self.said.append(said)
        return said

    def all(self) -> tuple[Array, Judgement]:
        """Every point and what was said of it."""
        names = self.said[0].details
        return np.concatenate(self.points), Judgement(
            np.concatenate([one.objective for one in self.said]),
            np.concatenate([one.excess for one in self.said]),
            {name: np.concatenate([one.details[name] for one in self.said]) for name in names},
        )
