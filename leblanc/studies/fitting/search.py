"""The search of a fit: from more and more starts until the best values have been found again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from leblanc.studies.fitting.problem import LIMIT, NO_ANSWER, Problem, Residual
from meshes.arrays import Array, Flags

# Of the logarithms: how far off the other starts are, those that are looked at nearby and further away.
_NEAR, _FAR = 1.2, 2.3
# Values tried before a search, for each unknown; a run-up takes as long as a hundred steady answers.
_TRIED, _TRIED_DEAR = 24, 4
# Most searches, and for each unknown more; few where each answer is dear.
_MOST, _MOST_DEAR = (6, 4), (2, 1)
_AGAIN = 2  # searches that must come to the best values
_FLOOR = 1e-6  # of the size of a quantity: less left is nothing but rounding
_ROUGH, _FINE = 1e-3, 1e-8  # where searches end, of the sum
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
    progress: Callable[[float], None] | None = None,
) -> Searched:
    """Ends of searches from the guess and from others about it, until the best has been found again.

    Parameters
    ----------
    problem : with its guess at 0
    starts : searches at least
    seed : of the other starts
    explained : whether what is left with some values may be noise; if not the search goes on
    progress : called with the share that is done
    """
    plain = problem.weighted(problem.plain())
    begins = _scanned(problem, plain) if problem.first.size == 1 else _tried(problem, seed, starts)
    base, each = _MOST if problem.measurement.over == "speed" else _MOST_DEAR
    most = max(starts, base + each * problem.first.size)
    found: list[Valley] = []
    for k, begin in enumerate(begins[:most]):
        # By turns: the logarithms have wider valleys, sizes find what logarithms weigh too little.
        if k % 2 == 0:
            begin = descend(problem, problem.logarithmic, begin, _ROUGH, 20).x
        found.append(descend(problem, plain, begin))
        if progress is not None:
            progress((k + 1) / min(most, len(begins)))
        best = min(found, key=lambda valley: valley.cost)
        again = _again(problem, found, best)
        if len(found) >= max(starts, _AGAIN) and again >= _AGAIN and explained(best.x):
            break
    ordered = sorted(found, key=lambda valley: valley.cost)
    return Searched(tuple(ordered), _again(problem, found, ordered[0]))


def _again(problem: Problem, found: list[Valley], best: Valley) -> int:
    """Searches that came to the best sum."""
    return sum(valley.cost <= 1.01 * best.cost + floor(problem) for valley in found)


def _tried(problem: Problem, seed: int, starts: int) -> list[Array]:
    """Starts, the guess first, then those of a Sobol sequence about it with least left."""
    from scipy.stats import qmc

    count = problem.first.size
    dear = problem.measurement.over != "speed"
    size = max((_TRIED_DEAR if dear else _TRIED) * count, starts)
    power = int(np.ceil(np.log2(size)))
    spread = 2.0 * qmc.Sobol(count, rng=np.random.default_rng(seed)).random_base2(power) - 1.0
    reach = np.where(np.arange(2**power) % 2 == 0, _NEAR, _FAR)
    points = spread * reach[:, None]
    sums = [float(np.sum(np.square(problem.logarithmic(x)))) for x in points]
    order = np.argsort(sums, kind="stable")
    # Of starts that are close to one another the better one.
    apart: list[Array] = []
    rest: list[Array] = []
    for x in points[order]:
        near = any(float(np.abs(x - other).max()) < 0.3 for other in apart)
        (rest if near else apart).append(x)
    return [np.zeros(count), *apart, *rest]


def _scanned(problem: Problem, plain: Residual) -> list[Array]:
    """Starts of one unknown: the lowest places of a scan over all that is looked at."""
    inner = np.linspace(-_FAR, _FAR, _SCAN)
    outer = np.linspace(_FAR, 0.999 * LIMIT, _SCAN_FAR + 1)[1:]
    if problem.measurement.over != "speed":
        inner, outer = inner[::4], outer[::3]
    points = np.concatenate([-outer[::-1], inner, outer])
    found: list[float] = []
    for residual in (plain, problem.logarithmic):
        sums = np.array([float(np.sum(np.square(residual(np.array([x]))))) for x in points])
        padded = np.concatenate([[np.inf], sums, [np.inf]])
        low = np.flatnonzero((sums <= padded[:-2]) & (sums <= padded[2:]) & (sums < NO_ANSWER**2))
        best = low[np.argsort(sums[low], kind="stable")][:_VALLEYS]
        found += [x for x in points[best].tolist() if x not in found]
    # The guess again behind them, so that no scan leaves a search without a start.
    return [np.array([x]) for x in (*found, 0.0, 0.05)]
