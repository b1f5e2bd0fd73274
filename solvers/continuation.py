"""Curves of steady waves over the whirl speed, through their folds: pseudo-arclength continuation.

A point is the scaled wave and the scaled speed together, [Re v, Im v, p]; dense linear algebra of at most
`DENSE_MODES` modes, with the BLAS held to one thread.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from meshes.border import InputError
from solvers.periodic import solve
from solvers.wave_modes import DENSE_MODES, System, WaveProblem, one_thread
from solvers.wave_newton import TAIL, TOLERANCE, SteadyWave, as_wave, newton, scaled_unknowns
from solvers.wave_path import Pace, Path, march

Array = NDArray[np.float64]

MOST_CURVE_POINTS = 2 * (DENSE_MODES + 1)
_LONGEST, _SHORTEST = 0.5, 1e-7


@dataclass(frozen=True)
class Branch:
    """A curve of steady waves over the whirl speed, through its folds.

    Parameters
    ----------
    waves : points in order along the curve
    tangents : unit tangents of the curve there, scaled [Re v, Im v, p]
    complete : the far end of the range was reached
    reason : why not, in words; empty if complete
    """

    waves: tuple[SteadyWave, ...]
    tangents: tuple[Array, ...] = field(repr=False)
    complete: bool
    reason: str

    @property
    def speeds(self) -> Array:
        """Whirl speeds s of the points, rad/s, shape (k,)."""
        return np.array([wave.speed for wave in self.waves])

    @property
    def folds(self) -> tuple[int, ...]:
        """Indices of the points at which the speed turns back."""
        onward = np.sign(np.diff(self.speeds))
        return tuple(int(k) for k in np.flatnonzero(onward[1:] * onward[:-1] < 0.0) + 1)

    @property
    def heights(self) -> Array:
        """Root mean squares of the waves, m^2, shape (k,)."""
        return np.array([wave.rms for wave in self.waves])


def follow(
    problem: WaveProblem,
    start: float,
    stop: float,
    points: int = 128,
    most_steps: int = 4000,
    longest: float = _LONGEST,
) -> Branch:
    """Follow the curve of steady waves from one whirl speed to another, through its folds.

    Parameters
    ----------
    problem : equations
    start, stop : whirl speeds, rad/s; the wave at `start` is the one of `solvers.periodic.solve`
    points : to begin with; doubled up to `MOST_CURVE_POINTS` where the spectrum needs it
    most_steps : limit of the points on the curve
    longest : longest step, in units of the scaled wave and speed

    Returns
    -------
    Branch; `complete` is False where it came back to the start, left what the modes resolve or ran out of
    steps

    Raises
    ------
    InputError : speeds that are not finite or are equal, too few points, a free wave
    """
    if not (math.isfinite(start) and math.isfinite(stop)) or start == stop:
        raise InputError("stop", stop, f"a finite speed other than start ({start!r})")
    if problem.forcing == 0.0:
        raise InputError("forcing", problem.forcing, "other than 0")
    first = solve(problem, start, points=points, most_points=MOST_CURVE_POINTS)
    if not first.converged:
        return Branch((first,), (np.zeros(0),), False, f"no answer at the start: {first.reason}")
    pace = Pace(longest, _SHORTEST, TOLERANCE, TAIL, DENSE_MODES, most_steps)
    with one_thread():
        here = np.append(scaled_unknowns(first), start / problem.speed_scale)
        path = march(functools.partial(System, problem), here, stop / problem.speed_scale, pace)
        if not path.points:
            return Branch((first,), (np.zeros(0),), False, path.reason)
        return _branch(problem, path, first, stop)


def _branch(problem: WaveProblem, path: Path, begin: SteadyWave, stop: float) -> Branch:
    """Waves of the points; the last one is solved at the end of the range itself."""
    waves = [begin]
    for system, point in zip(path.systems[1:], path.points[1:], strict=True):
        waves.append(as_wave(system, point.here[:-1], float(point.here[-1]), point.error, point.corrections))
    reason = path.reason
    if not reason:
        waves[-1] = newton(path.systems[-1], path.points[-1].here[:-1], stop / path.systems[-1].scale)
        reason = waves[-1].reason
    return Branch(tuple(waves), tuple(point.ahead for point in path.points), not reason, reason)
