"""Curves of steady waves over the whirl speed, through their folds: pseudo-arclength continuation.

A point is the scaled wave and the scaled speed together, [Re v, Im v, p]; dense linear algebra of at most
`DENSE_MODES` modes, with the BLAS held to one thread.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgetrf, dgetrs

from meshes.border import InputError
from solvers.periodic import TAIL, TOLERANCE, SteadyWave, as_wave, newton, scaled_unknowns, solve, tail_of
from solvers.wave_modes import DENSE_MODES, System, WaveProblem, one_thread, resized

Array = NDArray[np.float64]

MOST_CURVE_POINTS = 2 * (DENSE_MODES + 1)
_CORRECTIONS = 12
_SLOW, _NEAR = 0.2, 2
_AMPLE = 1e-2
_LONGEST, _SHORTEST = 0.5, 1e-7
# Cosine of the turn between neighbouring points and size of the correction over the step: beyond, the point
# may lie on another curve.
_TURN, _STRAY = 0.8, 0.2


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
    first = solve(problem, start, points=points, most_points=MOST_CURVE_POINTS)
    if not first.converged:
        return Branch((first,), (np.zeros(0),), False, f"no answer at the start: {first.reason}")
    with one_thread():
        return _march(first, stop, most_steps, longest)


def _march(first: SteadyWave, stop: float, most_steps: int, longest: float) -> Branch:
    system = System(first.problem, first.modes.size)
    begin, target = first.speed / system.scale, stop / system.scale
    sense = math.copysign(1.0, target - begin)
    here = np.append(scaled_unknowns(first), begin)
    ahead = _tangent(system, here, sense)
    bend = np.zeros(here.size)
    waves, tangents, step = [first], [ahead], 0.1 * longest

    def ended(reason: str) -> Branch:
        return Branch(tuple(waves), tuple(tangents), not reason, reason)

    for _ in range(most_steps):
        guess = here + step * (ahead + 0.5 * step * bend)
        found = _correct(system, guess, ahead)
        if found is None or not _follows(found, guess, ahead, step):
            step *= 0.5
            if step < _SHORTEST:
                return ended("the steps became too short")
            continue
        wave = as_wave(system, found.here[:-1], float(found.here[-1]), found.error, found.corrections)
        modes = _modes_for(wave, first.modes.size)
        if modes > DENSE_MODES:
            return ended(wave.reason)
        if modes > system.modes:
            # The same step once more with more modes; what the coarse ones found is not kept.
            system = System(first.problem, modes)
            here, ahead, bend = (widened(x, modes) for x in (here, ahead, bend))
            continue
        tangents.append(found.ahead)
        if (found.here[-1] - target) * sense >= 0.0:
            waves.append(newton(system, found.here[:-1], target))
            return ended(waves[-1].reason)
        waves.append(wave)
        bend, here, ahead = (found.ahead - ahead) / step, found.here, found.ahead
        if (here[-1] - begin) * sense < 0.0:
            return ended("the curve came back to where it began")
        if modes < system.modes:
            system = System(first.problem, modes)
            here, ahead, bend = (widened(x, modes) for x in (here, ahead, bend))
        step = min(
            longest, step * (1.5 if found.corrections <= 4 else 1.0 if found.corrections <= 6 else 0.7)
        )
    return ended(f"not at the end after {most_steps} steps")


def _follows(found: _Corrected, guess: Array, ahead: Array, step: float) -> bool:
    """The point continues the curve: a far correction or a sharp turn may lead to another one."""
    gap = found.here - guess
    return dot(found.ahead, ahead) >= _TURN and dot(gap, gap) <= (_STRAY * step) ** 2


def _modes_for(wave: SteadyWave, fewest: int) -> int:
    """Modes for the next point: twice as many if the tail is too high, half of them if that is ample."""
    modes = wave.modes.size
    if wave.tail > TAIL:
        return 2 * modes + 1
    if modes > 2 * fewest and tail_of(wave.modes[: modes // 2]) < _AMPLE * TAIL:
        return modes // 2
    return modes


@dataclass(frozen=True)
class _Corrected:
    """Point on the curve (scaled wave and speed), unit tangent there, corrections it took, residual."""

    here: Array
    ahead: Array
    corrections: int
    error: float


def dot(one: Array, other: Array) -> float:
    """Inner product of (wave, speed): the mean square of the wave plus that of the speed."""
    return float(2.0 * (one[:-1] @ other[:-1]) + one[-1] * other[-1])


def widened(point: Array, modes: int) -> Array:
    """Point or direction with modes cut off or set to 0."""
    return np.append(resized(point[:-1], modes), point[-1])


def _correct(system: System, guess: Array, direction: Array) -> _Corrected | None:
    """Back to the curve on the plane across the direction; one factorisation, more where that is slow."""
    factors, here, before = _bordered(system, guess, direction), guess, math.inf
    for count in range(_CORRECTIONS):
        r = system.residual(here[:-1], here[-1])
        error = system.error(r, here[:-1])
        if factors is None or error > before:
            return None
        if error <= TOLERANCE:
            if count > _NEAR:
                # The factors belong to a point too far off for the tangent.
                factors = _bordered(system, here, direction)
            return factors and _Corrected(here, _along(factors, direction), count, error)
        if error > _SLOW * before:
            factors = _bordered(system, here, direction)
            if factors is None:
                return None
        off = dot(direction, here - guess)
        here, before = here + dgetrs(*factors, np.append(-r, -off))[0], error
    return None


def _bordered(system: System, point: Array, direction: Array) -> tuple[Array, NDArray[np.intc]] | None:
    """LU factors of the equations' derivative and the plane across the direction; None if singular."""
    size = point.size - 1
    matrix = np.empty((size + 1, size + 1), order="F")
    matrix[:size, :size] = system.jacobian(point[:-1], point[-1], system.modes)
    matrix[:size, size] = -point[:-1]
    matrix[size, :size] = 2.0 * direction[:-1]
    matrix[size, size] = direction[-1]
    factors, pivots, fault = dgetrf(matrix, overwrite_a=1)
    return None if fault else (factors, pivots)


def _tangent(system: System, point: Array, sense: float) -> Array:
    """Unit tangent at a point of the curve, towards rising (sense 1) or falling speed."""
    across = np.append(np.zeros(point.size - 1), sense)
    factors = _bordered(system, point, across)
    if factors is None:
        raise np.linalg.LinAlgError("the curve begins at a fold")
    return _along(factors, across)


def _along(factors: tuple[Array, NDArray[np.intc]], direction: Array) -> Array:
    """Unit tangent of the curve, onward."""
    ahead = dgetrs(*factors, np.append(np.zeros(direction.size - 1), 1.0))[0]
    return np.asarray(ahead / math.sqrt(dot(ahead, ahead)))
