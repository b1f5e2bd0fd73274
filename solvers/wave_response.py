"""All steady waves at a row of whirl speeds that one continuation connects."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshes.border import InputError
from solvers.continuation import MOST_CURVE_POINTS, Branch, follow
from solvers.wave_modes import System, WaveProblem, one_thread
from solvers.wave_newton import SteadyWave, newton, refined, scaled_unknowns
from solvers.wave_path import segment
from solvers.wave_stability import growth

Array = NDArray[np.float64]

_SAME = 1e-6
_EDGE = 1e-9
# Coefficients of the scaled speed along a segment that are only rounding.
_FLAT = 1e-14


@dataclass(frozen=True)
class Response:
    """All steady waves found at each of a row of whirl speeds.

    Parameters
    ----------
    speeds : s, rad/s, shape (k,)
    waves : for each speed its answers, smallest first
    growth : for each speed the growth rates of those, 1/s; empty unless asked for
    branches : the curves followed: from the lowest speed and, where that one does not reach the other end by
        itself, from the highest
    complete : a curve reached from one end to the other, and each of its passages was solved
    reason : why not, in words; empty if complete
    """

    speeds: Array
    waves: tuple[tuple[SteadyWave, ...], ...]
    growth: tuple[tuple[float, ...], ...]
    branches: tuple[Branch, ...]
    complete: bool
    reason: str


def respond(
    problem: WaveProblem, speeds: ArrayLike, points: int = 128, margin: float = 0.0, stability: bool = False
) -> Response:
    """All steady waves at a row of whirl speeds, connected to those below and above the row.

    Parameters
    ----------
    problem : equations
    speeds : whirl speeds s, rad/s, increasing, shape (k,), two or more
    points : to begin with
    margin : how far outside the row the curves begin, rad/s; far from resonance the answer there is unique
    stability : also the growth rate of each answer

    Returns
    -------
    Response

    Raises
    ------
    InputError : speeds that do not increase, a negative margin
    """
    row = np.asarray(speeds, dtype=float)
    if row.ndim != 1 or row.size < 2 or not bool(np.all(np.diff(row) > 0.0)):
        raise InputError("speeds", speeds, "two or more, increasing")
    if not (math.isfinite(margin) and margin >= 0.0):
        raise InputError("margin", margin, "a finite number, 0 or above")
    ends = (row[0] - margin, row[-1] + margin)
    branches = [follow(problem, *ends, points=points)]
    if not branches[0].complete:
        branches.append(follow(problem, ends[1], ends[0], points=points))
    with one_thread():
        answers, missed = _passages(branches, row)
        rates = tuple(tuple(growth(w) for w in found) for found in answers) if stability else ()
    reason = "; ".join(branch.reason for branch in branches if branch.reason)
    if missed:
        reason = "; ".join(filter(None, (reason, f"{missed} passages were not solved")))
    # A curve that leads from one end to the other passes every speed an odd number of times.
    odd = all(len(found) % 2 for found in answers)
    if branches[0].complete and not odd:
        reason = "; ".join(filter(None, (reason, "two answers too close to a fold to be told apart")))
    return Response(row, answers, rates, tuple(branches), not reason, reason)


def _passages(branches: list[Branch], row: Array) -> tuple[tuple[tuple[SteadyWave, ...], ...], int]:
    """Waves where the curves pass each speed, each passage solved to the end; and how many failed."""
    found: list[list[SteadyWave]] = [[] for _ in row]
    missed = 0
    for branch in branches:
        for k, left in enumerate(branch.waves[:-1]):
            modes = max(left.modes.size, branch.waves[k + 1].modes.size)
            system = System(left.problem, modes)
            curve = _segment(branch, k)
            for at, guess in _crossings(curve, row / system.scale):
                wave = refined(newton(system, guess, row[at] / system.scale), MOST_CURVE_POINTS)
                missed += not wave.converged
                if wave.converged and not any(_alike(wave, other) for other in found[at]):
                    found[at].append(wave)
    return tuple(tuple(sorted(waves, key=lambda w: w.rms)) for waves in found), missed


def _segment(branch: Branch, k: int) -> Array:
    """Cubic between points k and k + 1."""
    scale = branch.waves[k].problem.speed_scale
    ends = [np.append(scaled_unknowns(w), w.speed / scale) for w in branch.waves[k : k + 2]]
    return segment(*ends, *branch.tangents[k : k + 2])[0]


def _crossings(curve: Array, row: Array) -> list[tuple[int, Array]]:
    """Where a segment passes the (scaled) speeds of the row: index and unknowns."""
    p = np.polynomial.Polynomial(curve[:, -1]).trim(_FLAT)
    turns = p.deriv().roots()
    inner = turns.real[(turns.imag == 0.0) & (turns.real > 0.0) & (turns.real < 1.0)]
    marks: Array = np.asarray(p(np.concatenate(([0.0], inner, [1.0]))), dtype=np.float64)
    low, high = float(marks.min()), float(marks.max())
    within = range(int(np.searchsorted(row, low)), int(np.searchsorted(row, high, "right")))
    powers = np.arange(4)
    return [
        (at, u.real**powers @ curve[:, :-1])
        for at in within
        for u in (p - row[at]).roots()
        if abs(u.imag) < _EDGE and -_EDGE <= u.real <= 1.0 + _EDGE
    ]


def _alike(one: SteadyWave, other: SteadyWave) -> bool:
    common = min(one.modes.size, other.modes.size)
    gap = np.linalg.norm(one.modes[:common] - other.modes[:common])
    return bool(gap <= _SAME * np.linalg.norm(one.modes))
