"""The search of a fit: from more and more starts until the best values have been found again."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from leblanc.core.progress import update
from leblanc.studies.fit.problem import LIMIT, NO_ANSWER, Problem, Residual
from meshes.arrays import Array, Flags

# Of the logarithms: how far off the other starts are, those that are looked at nearby and further away.
_NEAR, _FAR = 1.2, 2.3
# Values tried before a search, for each unknown; a run-up takes as long as a hundred steady answers.
_TRIED, _TRIED_DEAR = 24, 4
# Most searches, and for each unknown more; few where each answer is dear.
_MOST, _MOST_DEAR = (6, 4), (2, 1)
_UNSEEN = 0.5  # valleys that have not been found, on average, at which a search ends
_FLOOR = 1e-6  # of the size of a quantity: less left is nothing but rounding
_FINE = 1e-8  # of the sum, where searches end
_SCAN, _SCAN_FAR = 41, 9  # values of one unknown within _FAR of the guess, and beyond on either side
_VALLEYS = 4  # of a scan, that are followed to their floor


@dataclass(frozen=True)
class Valley:
    """Where one search ended."""

    x: Array  #: logarithms or steps, shape (p,)
    cost: float  #: sum of squares
    ended: bool  #: the search came to its end, at an answer


@dataclass(frozen=True)
class Searched:
    """Where the searches ended."""

    valleys: tuple[Valley, ...]  #: best first
    again: int  #: searches that came to the best sum


def descend(
    problem: Problem,
    residual: Residual,
    x: Array,
    end: float = _FINE,
    most: int = 60,
    free: Flags | None = None,
) -> Valley:
    """Search for the least sum of squares from one start, of some of the unknowns or all."""
    from scipy.optimize import least_squares

    moves = np.ones(x.size, dtype=bool) if free is None else free

    def whole(part: Array) -> Array:
        full = x.copy()
        full[moves] = part
        return full

    given = {"x_scale": 0.1, "ftol": end, "xtol": end, "gtol": 1e-14, "max_nfev": most}
    found = least_squares(
        lambda part: residual(whole(part)),
        np.clip(x[moves], -0.999 * LIMIT, 0.999 * LIMIT),
        jac=lambda part: problem.jacobian(residual, whole(part), moves),
        bounds=(-LIMIT, LIMIT),
        **given,
    )
    answered = problem.answer(whole(found.x)) is not None
    return Valley(whole(found.x), 2.0 * float(found.cost), bool(found.success) and answered)


def floor(problem: Problem) -> float:
    """Sum of squares that is nothing but rounding."""
    return problem.count * _FLOOR**2


def search(
    problem: Problem,
    starts: int,
    seed: int,
    explained: Callable[[Array], bool],
) -> Searched:
    """Ends of searches until the best has been found again and hardly any are unseen [theory: fit, eq. 6].

    The search goes on where the residuals may not be noise (`explained`).
    """
    plain = problem.weighted(problem.plain())
    alone = problem.first.size == 1
    begins = _scanned(problem, plain) if alone else _tried(problem, seed, starts)
    base, each = _MOST if problem.measurement.over == "speed" else _MOST_DEAR
    most = min(len(begins), max(starts, base + each * problem.first.size))
    found: list[Valley] = []
    for begin in begins[:most]:
        found.append(descend(problem, plain, begin))
        found.sort(key=lambda valley: valley.cost)
        update(len(found), most, "search")
        # The lowest places of a scan are followed one and all: it has seen what lies between them.
        enough = not alone and len(found) >= starts and _unseen(problem, found) <= _UNSEEN
        if enough and _again(problem, found) > 1 and explained(found[0].x):
            break
    return Searched(tuple(found), _again(problem, found))


def _again(problem: Problem, found: list[Valley]) -> int:
    """Searches that came to the best sum, of ends in rising order."""
    return sum(valley.cost <= 1.01 * found[0].cost + floor(problem) for valley in found)


def _unseen(problem: Problem, found: list[Valley]) -> float:
    """Expected number of valleys that no search has come to, of ends in rising order [theory: fit, eq. 6]."""
    sums = [valley.cost for valley in found]
    seen = 1 + sum(high > 1.01 * low + floor(problem) for low, high in itertools.pairwise(sums))
    rest = len(sums) - seen - 2
    return seen * (len(sums) - 1) / rest - seen if rest > 0 else float("inf")


def _tried(problem: Problem, seed: int, starts: int) -> list[Array]:
    """Starts: the guess, then places of a Sobol sequence about it that no better one is close to."""
    from scipy.stats import qmc

    count = problem.first.size
    each = _TRIED if problem.measurement.over == "speed" else _TRIED_DEAR
    power = int(np.ceil(np.log2(max(each * count, starts))))
    spread = 2.0 * qmc.Sobol(count, rng=np.random.default_rng(seed)).random_base2(power) - 1.0
    reach = np.where(np.arange(2**power) % 2 == 0, _NEAR, _FAR)
    points = spread * reach[:, None]
    problem.ahead(points)
    sums = [float(np.sum(np.square(problem.logarithmic(x)))) for x in points]
    points = points[np.argsort(sums, kind="stable")]
    close = _FAR * 2.0 ** ((1 - power) / count)  # half the distance of neighbours among those further away
    apart: list[Array] = [np.zeros(count)]
    rest: list[Array] = []
    for k, x in enumerate(points):
        near = np.abs(points[:k] - x).max(axis=1) < close
        (rest if near.any() else apart).append(x)
    return [*apart, *rest]


def _scanned(problem: Problem, plain: Residual) -> list[Array]:
    """Starts of one unknown: the lowest places of a scan over all that is looked at."""
    inner = np.linspace(-_FAR, _FAR, _SCAN)
    outer = np.linspace(_FAR, 0.999 * LIMIT, _SCAN_FAR + 1)[1:]
    if problem.measurement.over != "speed":
        inner, outer = inner[::4], outer[::3]
    points = np.concatenate([-outer[::-1], inner, outer])
    problem.ahead(list(points[:, None]))
    found: list[float] = []
    for residual in (plain, problem.logarithmic):
        sums = np.array([float(np.sum(np.square(residual(np.array([x]))))) for x in points])
        padded = np.concatenate([[np.inf], sums, [np.inf]])
        low = np.flatnonzero((sums <= padded[:-2]) & (sums <= padded[2:]) & (sums < NO_ANSWER**2))
        best = low[np.argsort(sums[low], kind="stable")][:_VALLEYS]
        found += [x for x in points[best].tolist() if x not in found]
    return [np.array([x]) for x in found or [0.0]]
