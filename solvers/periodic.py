"""Steady periodic waves of one family in the frame of the whirl, by Newton's method without time stepping.

N points carry the modes 1..N/2 - 1; they are doubled until the spectrum's tail is low enough.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from fluid.kdv import KdvCoefficients, forcing, wave_frequency
from meshes.border import InputError
from solvers.wave_modes import System, WaveProblem, joined, one_thread, resized, split, values

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

MOST_POINTS = 8192
# Relative size of the last eighth of the spectrum that leaves the wave itself right to 1e-8 and better.
TAIL = 1e-10
TOLERANCE = 1e-11
_NEWTON_STEPS = 20
_HALVINGS = 8
_HOMOTOPY = 12
# On the way to an answer a coarse wave is enough.
_COARSE, _COARSE_TAIL = 1e-3, 1e-4


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


def family_problem(
    c: KdvCoefficients, acceleration: float, whitham: bool = False, decay: float = 0.0, diffusion: float = 0.0
) -> WaveProblem:
    """Waves of one family under the whirl.

    Parameters
    ----------
    c : the family
    acceleration : F = omega_w^2 w0 of the axis, m/s^2
    whitham : exact dispersion instead of KdV's
    decay, diffusion : as in `WaveProblem`
    """
    frequency = functools.partial(wave_frequency, c=c, whitham=whitham)
    return WaveProblem(frequency, c.steepening, float(forcing(c, acceleration)), decay, diffusion)


def solve(
    problem: WaveProblem,
    speed: float,
    guess: Complex | None = None,
    points: int = 128,
    most_points: int = MOST_POINTS,
) -> SteadyWave:
    """One steady wave at a whirl speed, with as many points as it needs.

    Where several answers exist this is one of them: the one next to the guess; else the one next to the
    linear wave or, if Newton's method does not arrive from there, the one that grows out of a strongly damped
    wave as the extra damping is taken away. `solvers.wave_response` finds the others.

    Parameters
    ----------
    problem : equations
    speed : whirl speed s seen from the drum, rad/s
    guess : modes of a wave near by, m^2, shape (m,)
    points : to begin with, 12 or more; doubled until the spectrum's tail falls below `TAIL`
    most_points : limit of that; a wave that needs more is returned with `converged` False

    Returns
    -------
    SteadyWave; `converged` and `reason` tell whether it is an answer

    Raises
    ------
    InputError : a speed that is not finite, too few points, a free wave (forcing 0, defined up to a shift)
    """
    if not math.isfinite(speed):
        raise InputError("speed", speed, "a finite number")
    if points < 12:
        raise InputError("points", points, "12 or more")
    if problem.forcing == 0.0:
        raise InputError("forcing", problem.forcing, "other than 0")
    with one_thread():
        system = System(problem, points // 2 - 1)
        p = speed / system.scale
        if guess is None:
            wave = newton(system, system.linear(p), p)
            wave = wave if wave.residual <= TOLERANCE else _from_damped(system, p, most_points)
        else:
            scaled = np.asarray(guess, dtype=np.complex128) * complex(problem.steepening / system.scale)
            wave = newton(system, resized(split(scaled), system.modes), p)
        return refined(wave, most_points)


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


def newton(system: System, y: Array, p: float, tolerance: float = TOLERANCE) -> SteadyWave:
    """Damped Newton iteration at a fixed scaled speed."""
    r = system.residual(y, p)
    error, reason, count = system.error(r, y), "", 0
    while error > tolerance and count < _NEWTON_STEPS:
        try:
            dy = system.step(y, p, r)
        except np.linalg.LinAlgError as fault:
            reason = f"singular: {fault}"
            break
        share, size = 1.0, system.size(r)
        for _ in range(_HALVINGS):
            trial = y + share * dy
            r_trial = system.residual(trial, p)
            if system.size(r_trial) < size:
                break
            share *= 0.5
        else:
            # At the rounding floor no step gains: the judgement is the residual's.
            break
        y, r, count = trial, r_trial, count + 1
        error = system.error(r, y)
    return as_wave(system, y, p, error, count, reason)


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
    return float(np.max(size[-max(1, size.size // 8) :]) / (np.max(size) or 1.0))


def _from_damped(system: System, p: float, most_points: int) -> SteadyWave:
    """Follow the answer while an extra diffusion, at first as strong as the forcing, is taken away."""
    problem, scale, count = system.problem, system.scale, 0
    modes, y = system.modes, system.linear(p)
    for extra in (*(2.0 * 0.5**k for k in range(_HOMOTOPY)), 0.0):
        damped = replace(problem, diffusion=problem.diffusion + extra * scale)
        tolerance = _COARSE if extra else TOLERANCE
        wave = newton(System(damped, modes), y, p, tolerance)
        if not wave.residual <= tolerance:
            wave = replace(wave, reason=f"{wave.reason}, with a diffusion of {damped.diffusion:.3g} rad^2/s")
            break
        wave = refined(wave, most_points, tolerance, _COARSE_TAIL)
        modes, y, count = wave.modes.size, scaled_unknowns(wave), count + wave.iterations
    return replace(wave, problem=problem, iterations=count)
