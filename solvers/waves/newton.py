"""Newton's method for steady waves: a dense low block, the diagonal above it, factors as long as they serve.

Above the first modes the coefficient of a mode, which grows with its number, outweighs all that the wave's
height couples to it: there the diagonal stands for the derivative. What that leaves out, and what old factors
leave out, costs corrections; where these gain too little new factors are made, at last with all modes in the
block, or, beyond `DENSE_MODES`, GMRES takes over.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dgetrf, dgetrs
from scipy.sparse.linalg import LinearOperator, gmres

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.waves.modes import DENSE_MODES, System, WaveProblem, joined, resized, split, values

# Relative size of the last eighth of the spectrum that leaves the wave itself right to 1e-8 and better.
TAIL = 1e-10
TOLERANCE = 1e-11
_NEWTON_STEPS = 40
_HALVINGS = 8
# A coefficient this many times the wave's height stands alone; a correction that gains less is slow.
ALONE = 6.0
_SLOW = 0.2


@dataclass(frozen=True)
class SteadyWave:
    """A steady wave, or how far the search for it came.

    Parameters
    ----------
    problem : what it answers
    speed : s, rad/s
    modes : coefficients of e^{i n xi}, n = 1..M, of eta, m^2, shape (M,)
    converged : the equations are met and the spectrum is resolved
    reason : why not, in words; empty if converged
    iterations : Newton steps in all
    residual : of the equations, each mode over its coefficient, relative to the wave
    tail : largest of the last eighth of the modes over the largest mode
    """

    problem: WaveProblem = field(repr=False)
    speed: float
    modes: Complex = field(repr=False)
    converged: bool
    reason: str
    iterations: int
    residual: float
    tail: float

    def profile(self, points: int) -> Array:
        """Heights eta, m^2, at `points` equal steps of xi from 0, shape (points,); points above 2 M."""
        if points <= 2 * self.modes.size:
            raise InputError("points", points, f"above {2 * self.modes.size}")
        return values(self.modes, points)

    @property
    def rms(self) -> float:
        """Root mean square of eta, m^2."""
        return float(np.sqrt(2.0) * np.linalg.norm(self.modes))


@dataclass(frozen=True)
class Factors:
    """Factors of the low block, bordered by a plane if there is one, and the diagonal above.

    `enough` tells that the block takes all modes that are coupled by the wave's height.
    """

    lu: Array
    pivots: NDArray[np.intc]
    low: int
    high: Complex
    plane: Array | None
    enough: bool

    def solve(self, r: Array, off: float = 0.0) -> Array:
        """Change that the derivative turns into r and, with a border, that lies `off` along its direction."""
        size, low = 2 * (self.low + self.high.size), self.low
        m = size // 2
        found = np.empty(size + (self.plane is not None))
        right = np.empty(self.lu.shape[0])
        right[:low], right[low : 2 * low] = r[:low], r[m : m + low]
        if low < m:
            upper = (r[low:m] + 1j * r[m + low : size]) / self.high
            found[low:m], found[m + low : size] = upper.real, upper.imag
        if self.plane is not None:
            if low < m:
                off -= 2.0 * float(
                    self.plane[low:m] @ found[low:m] + self.plane[m + low : size] @ found[m + low : size]
                )
            right[-1] = off
        x = dgetrs(self.lu, self.pivots, right, overwrite_b=1)[0]
        found[:low], found[m : m + low] = x[:low], x[low : 2 * low]
        if self.plane is not None:
            found[-1] = x[-1]
        return found


def factorise(
    system: System, y: Array, p: float, plane: Array | None = None, alone: float = ALONE
) -> Factors:
    """Factors of the derivative at a wave; where a plane's direction is given, bordered by it and by p.

    Raises
    ------
    LinAlgError : the low block is singular
    """
    m = system.modes
    coefficient = system.coefficient(p)
    height = float(np.max(np.abs(values(joined(y), system.points))))
    wanted = _low_modes(np.abs(coefficient), alone * height)
    low = min(wanted, DENSE_MODES)
    matrix = system.jacobian(y, p, low, border=int(plane is not None))
    if plane is not None:
        by_p = system.by_parameter(y, p)
        matrix[:low, -1], matrix[low:-1, -1] = by_p[:low], by_p[m : m + low]
        matrix[-1, :low], matrix[-1, low:-1] = 2.0 * plane[:low], 2.0 * plane[m : m + low]
        matrix[-1, -1] = plane[-1]
    lu, pivots, fault = dgetrf(matrix, overwrite_a=1)
    if fault:
        raise np.linalg.LinAlgError("the equations do not determine the wave")
    return Factors(lu, pivots, low, coefficient[low:], plane, low == wanted)


def _low_modes(coefficient: Array, height: float) -> int:
    """Modes up to the last one whose coefficient is below that height; all where few are left."""
    m = coefficient.size
    below = np.flatnonzero(coefficient <= height)
    low = max(8, int(below[-1]) + 1 if below.size else 0)
    return min(low if low < 0.8 * m else m, m)


def newton(
    system: System, y: Array, p: float, tolerance: float = TOLERANCE, factors: Factors | None = None
) -> SteadyWave:
    """Damped Newton iteration at a fixed parameter; old factors are used as long as they gain."""
    r = system.residual(y, p)
    error, reason, count, alone = system.error(r, y), "", 0, ALONE
    size = system.size(r)
    while error > tolerance and count < _NEWTON_STEPS:
        fresh = factors is None
        try:
            factors = factors or factorise(system, y, p, alone=alone)
            dy, share = _step(system, factors, y, p, r), 1.0
        except np.linalg.LinAlgError as fault:
            reason = f"singular: {fault}"
            break
        for _ in range(_HALVINGS if fresh else 1):
            trial = y + share * dy
            r_trial = system.residual(trial, p)
            gain = system.size(r_trial) / size
            if gain < 1.0:
                break
            share *= 0.5
        else:
            if not fresh:
                factors = None
                continue
            if factors.low < system.modes and alone < math.inf:
                factors, alone = None, math.inf
                continue
            # At the rounding floor no step gains: the judgement is the residual's.
            break
        if gain > _SLOW or share < 1.0:
            if fresh and share == 1.0 and error < 1e-3:
                alone *= 2.0
            factors = None
        y, r, count, size = trial, r_trial, count + 1, gain * size
        error = system.error(r, y)
    return as_wave(system, y, p, error, count, reason)


def _step(system: System, factors: Factors, y: Array, p: float, r: Array) -> Array:
    """Newton's step; raises LinAlgError if it cannot be had."""
    if factors.enough:
        return factors.solve(-r)
    heights = values(joined(y), system.points)
    shape = (r.size, r.size)
    act = LinearOperator(shape, lambda x: system.act(heights, p, np.ravel(x)), dtype=float)
    approximate = LinearOperator(shape, lambda x: factors.solve(np.ravel(x)), dtype=float)
    dy, fault = gmres(act, -r, M=approximate, rtol=1e-4, atol=0.0, restart=80, maxiter=5)
    if fault:
        raise np.linalg.LinAlgError("GMRES did not converge")
    return np.asarray(dy)


def as_wave(system: System, y: Array, p: float, error: float, count: int, reason: str = "") -> SteadyWave:
    """Unscaled wave with its verdict."""
    v = joined(y)
    tail = tail_of(v)
    if error > TOLERANCE:
        reason = reason or f"residual {error:.1e} after {count} Newton steps"
    elif tail > TAIL:
        reason = f"spectrum not resolved: tail {tail:.1e} on {2 * (v.size + 1)} points"
    return SteadyWave(
        problem=system.problem,
        speed=float(p * system.scale),
        modes=v * (system.scale / system.problem.steepening),
        converged=not reason,
        reason=reason,
        iterations=count,
        residual=error,
        tail=tail,
    )


def tail_of(v: Complex) -> float:
    """Largest of the last eighth of the modes over the largest of all."""
    size = np.abs(v)
    return float(size[-max(1, size.size // 8) :].max() / (size.max() or 1.0))


def refined(
    wave: SteadyWave, most_points: int, tolerance: float = TOLERANCE, tail: float = TAIL
) -> SteadyWave:
    """The same wave on as many points as its spectrum needs."""
    while wave.residual <= tolerance and wave.tail > tail and 4 * (wave.modes.size + 1) <= most_points:
        system = System(wave.problem, 2 * wave.modes.size + 1)
        y = resized(scaled_unknowns(wave), system.modes)
        finer = newton(system, y, wave.speed / system.scale, tolerance)
        wave = replace(finer, iterations=finer.iterations + wave.iterations)
    return wave


def scaled_unknowns(wave: SteadyWave) -> Array:
    """Real unknowns of a wave in the scales of its problem."""
    return split(wave.modes * (wave.problem.steepening / wave.problem.speed_scale))
