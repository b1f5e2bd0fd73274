"""Curves of steady waves over one parameter, through their folds: pseudo-arclength continuation.

A point is the scaled wave and the parameter together, [Re v, Im v, p]. The next one is predicted by the cubic
through the last two with their tangents and corrected on the plane across the curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from solvers.waves.modes import System, joined, resized, values
from solvers.waves.newton import ALONE, Factors, factorise, tail_of

_CORRECTIONS = 24
# Factors that gain less than this are made anew.
_SLOW = 0.3
# Cosine of the turn between neighbouring points and size of the correction over the step: beyond, the point
# may lie on another curve. The correction over the step that the next one aims at.
_TURN, _STRAY, _AIM = 0.8, 0.2, 0.03
# A tail this far below the limit lets half of the modes go.
_AMPLE = 1e-2
# Relative error of a tangent.
_STRAIGHT = 1e-3


@dataclass(frozen=True)
class PathPoint:
    """Point on a curve (scaled wave and parameter), unit tangent there, corrections it took, residual."""

    here: Array
    ahead: Array
    corrections: int
    error: float


@dataclass(frozen=True)
class Path:
    """A curve: its points in order, the systems they solve, why it ended too early (empty: it did not)."""

    points: tuple[PathPoint, ...]
    systems: tuple[System, ...]
    reason: str


@dataclass(frozen=True)
class Pace:
    """How a curve is followed.

    Parameters
    ----------
    longest, shortest : steps, in units of the scaled wave and parameter
    tolerance : of each point's residual
    tail : of each point's spectrum
    most_modes : a curve whose waves need more ends
    most_steps : limit of its points
    most_work : limit of the work on dense blocks, the cube of the modes in each
    """

    longest: float
    shortest: float
    tolerance: float
    tail: float
    most_modes: int
    most_steps: int
    most_work: float = math.inf


def march(make: Callable[[int], System], first: Array, target: float, pace: Pace) -> Path:
    """Follow a curve from a point on it until its parameter has passed the target.

    Parameters
    ----------
    make : the equations of a number of modes
    first : the point to begin with, [Re v, Im v, p]
    target : of the parameter
    pace : lengths and limits

    Returns
    -------
    Path; its last point is the first one beyond the target
    """
    system = make(first.size // 2)
    sense = math.copysign(1.0, target - first[-1])
    try:
        begin = _begin(system, first, sense)
    except np.linalg.LinAlgError:
        return Path((), (), "the curve begins at a fold")
    points, systems, step, work = [begin], [system], 0.1 * pace.longest, 0.0

    def ended(reason: str) -> Path:
        return Path(tuple(points), tuple(systems), reason)

    while len(points) < pace.most_steps and work < pace.most_work:
        # Steps are taken with the modes of the system, which may have changed since the last ones.
        *behind, last = (_with_modes(point, system.modes) for point in points[-2:])
        guess = _predicted(behind[0] if behind else None, last, step)
        found, cost = _correct(system, guess, last.ahead, pace.tolerance)
        work += cost
        stray = math.inf if found is None else _stray(found, guess, last.ahead, step)
        if found is None or stray > _STRAY:
            step *= 0.5
            if step < pace.shortest:
                return ended("the steps became too short")
            continue
        modes = _modes_for(found.here, first.size // 2, pace.tail)
        if modes > pace.most_modes:
            return ended(f"spectrum not resolved on {2 * (system.modes + 1)} points")
        if modes <= system.modes:
            points.append(found)
            systems.append(system)
            if (found.here[-1] - target) * sense >= 0.0:
                return ended("")
            if (found.here[-1] - first[-1]) * sense < 0.0:
                return ended("the curve came back to where it began")
            step = min(pace.longest, step * min(2.0, max(0.3, math.cbrt(_AIM / max(stray, 1e-12)))))
        # With more modes the same step is taken once more; what the coarse ones found is not kept.
        system = system if modes == system.modes else make(modes)
    return ended(f"not at the end after {len(points)} steps")


def _begin(system: System, first: Array, sense: float) -> PathPoint:
    """The first point, with the tangent towards rising (sense 1) or falling parameter."""
    across = np.append(np.zeros(first.size - 1), sense)
    factors = factorise(system, first[:-1], first[-1], across)
    return PathPoint(first, _tangent(system, first, across, factors), 0, 0.0)


def _with_modes(point: PathPoint, modes: int) -> PathPoint:
    if point.here.size == 2 * modes + 1:
        return point
    here, ahead = widened(point.here, modes), widened(point.ahead, modes)
    return PathPoint(here, ahead, point.corrections, point.error)


def segment(begin: Array, end: Array, leaving: Array, arriving: Array) -> tuple[Array, float]:
    """Cubic between two points with their tangents, and the length of the curve there.

    Coefficients of u^0 ... u^3, from u = 0 to 1.
    """
    modes = max(begin.size, end.size) // 2
    a, b, start, stop = (widened(x, modes) for x in (begin, end, leaving, arriving))
    chord = b - a
    # An arc is longer than its chord, by a twelfth of what the tangents turn.
    arc = math.sqrt(dot(chord, chord)) * (1.0 + (1.0 - dot(start, stop)) / 12.0)
    start, stop = arc * start, arc * stop
    return np.array([a, start, 3.0 * chord - 2.0 * start - stop, start + stop - 2.0 * chord]), arc


def landing(path: Path, target: float) -> Array:
    """The wave, about, where the last segment of a path passes the target."""
    before, after = path.points[-2:]
    cubic, _ = segment(before.here, after.here, before.ahead, after.ahead)
    u = np.linspace(0.0, 1.0, 65)[:, None] ** np.arange(4)
    at = int(np.argmin(np.abs(u @ cubic[:, -1] - target)))
    return np.asarray(u[at] @ cubic[:, :-1])


def _predicted(behind: PathPoint | None, last: PathPoint, step: float) -> Array:
    """The curve one step on: a line, or the cubic through the last two points with their tangents."""
    if behind is None:
        return np.asarray(last.here + step * last.ahead)
    cubic, arc = segment(behind.here, last.here, behind.ahead, last.ahead)
    return np.asarray((1.0 + step / arc) ** np.arange(4) @ cubic)


def _stray(found: PathPoint, guess: Array, ahead: Array, step: float) -> float:
    """Correction over the step; infinite where the curve turns: it may be another one."""
    gap = found.here - guess
    return math.inf if dot(found.ahead, ahead) < _TURN else math.sqrt(dot(gap, gap)) / step


def _modes_for(point: Array, fewest: int, most_tail: float) -> int:
    """Modes for the next point: twice as many if the tail is too high, half of them if that is ample."""
    v = joined(point[:-1])
    if tail_of(v) > most_tail:
        return 2 * v.size + 1
    if v.size > 2 * fewest and tail_of(v[: v.size // 2]) < _AMPLE * most_tail:
        return v.size // 2
    return v.size


def dot(a: Array, b: Array) -> float:
    """Inner product of (wave, parameter): the mean square of the wave plus that of the parameter."""
    return float(2.0 * (a[:-1] @ b[:-1]) + a[-1] * b[-1])


def widened(point: Array, modes: int) -> Array:
    """Point or direction with modes cut off or set to 0."""
    return point if point.size == 2 * modes + 1 else np.append(resized(point[:-1], modes), point[-1])


def _correct(
    system: System, guess: Array, direction: Array, tolerance: float
) -> tuple[PathPoint | None, float]:
    """Back to the curve on the plane across the direction, and the work on dense blocks that it took.

    Factors are made anew where they gain too little, with more modes in the block.
    """
    here, before, work, alone = guess, math.inf, 0.0, ALONE
    factors: Factors | None = None
    r = system.residual(here[:-1], here[-1])
    error = system.error(r, here[:-1])
    for count in range(_CORRECTIONS):
        try:
            if factors is None or error > _SLOW * before:
                alone *= 1.0 if factors is None else 2.0
                factors = factorise(system, here[:-1], here[-1], direction, alone)
                work += float(factors.low**3)
            if error <= tolerance:
                return PathPoint(here, _tangent(system, here, direction, factors), count, error), work
        except np.linalg.LinAlgError:
            break
        trial = here + factors.solve(-r, -dot(direction, here - guess))
        r_trial = system.residual(trial[:-1], trial[-1])
        error_trial = system.error(r_trial, trial[:-1])
        if error_trial <= error:
            here, r, before, error = trial, r_trial, error, error_trial
        elif factors.low == system.modes or not factors.enough:
            break
        else:
            before = 0.0
    return None, work


def _tangent(system: System, point: Array, direction: Array, factors: Factors) -> Array:
    """Unit tangent of the curve, onward, refined until what the factors leave out is made good."""
    y, p = point[:-1], float(point[-1])
    heights, by_p = values(joined(y), system.points), system.by_parameter(y, p)
    ahead = factors.solve(np.zeros(y.size), 1.0)
    for _ in range(6):
        left = system.act(heights, p, ahead[:-1]) + ahead[-1] * by_p
        change = factors.solve(-left, 1.0 - dot(direction, ahead))
        ahead = ahead + change
        if dot(change, change) < _STRAIGHT**2 * dot(ahead, ahead):
            break
    return np.asarray(ahead / math.sqrt(dot(ahead, ahead)))
