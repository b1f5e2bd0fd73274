"""Steady periodic waves of one family in the frame of the whirl, by Newton's method without time stepping.

N points carry the modes 1..N/2 - 1; they are doubled until the spectrum's tail is low enough.
"""

from __future__ import annotations

import functools
import math
from dataclasses import replace

import numpy as np

from fluid.kdv import KdvCoefficients, forcing, wave_frequency
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.waves.modes import (
    DENSE_MODES,
    DampingSystem,
    System,
    WaveProblem,
    one_thread,
    resized,
    split,
    values,
)
from solvers.waves.newton import TOLERANCE, SteadyWave, as_wave, newton, refined, scaled_unknowns
from solvers.waves.path import Pace, landing, march

MOST_POINTS = 8192
# Damping and dispersion over steepening below which a wave at resonance is a bore; modes of its front.
_WEAK, _ROUND = 1.0, 8.0
# The way from a damped wave: its diffusion in the problem's scale, modes, accuracy and limits.
_EXTRA, _FEWEST = 1.5, 15
_COARSE, _COARSE_TAIL = 1e-5, 1e-4
_WAY = Pace(
    longest=1.0,
    shortest=1e-4,
    tolerance=_COARSE,
    tail=_COARSE_TAIL,
    most_modes=1023,
    most_steps=400,
    most_work=50.0 * DENSE_MODES**3,
)
# Points up to which a first try is refined before that way is taken.
_MOST_AT_ONCE = 1024
# The crest of the last wave that was found is short of the one that is looked for by some such factor.
_SHORT = 1.4


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

    Where several answers exist this is one of them: the one next to the guess; else the one next to the bore
    of vanishing dispersion [theory: kdv, eq. 27] or to the linear wave or, if Newton's method does not arrive
    from there, the one that grows out of a strongly damped wave as the extra damping is taken away, through
    folds if there are any. `solvers.waves.continuation` finds the others.

    Parameters
    ----------
    problem : equations; without forcing the answer is rest
    speed : whirl speed s seen from the drum, rad/s
    guess : modes of a wave near by, m^2, shape (m,)
    points : to begin with, 12 or more; doubled until the spectrum's tail falls below `TAIL`
    most_points : limit of that; a wave that needs more is returned with `converged` False

    Returns
    -------
    SteadyWave; `converged` and `reason` tell whether it is an answer

    Raises
    ------
    InputError : a speed that is not finite, too few points, a guess without forcing (a free wave is defined
        up to a shift)
    """
    if not math.isfinite(speed):
        raise InputError("speed", speed, "a finite number")
    if points < 12:
        raise InputError("points", points, "12 or more")
    system = System(problem, points // 2 - 1)
    p = speed / system.scale
    if problem.forcing == 0.0:
        if guess is not None:
            raise InputError("forcing", problem.forcing, "other than 0 where a wave is guessed")
        return as_wave(system, np.zeros(2 * system.modes), p, 0.0, 0)
    with one_thread():
        if guess is not None:
            scaled = np.asarray(guess, dtype=np.complex128) * complex(problem.steepening / system.scale)
            return refined(newton(system, resized(split(scaled), system.modes), p), most_points)
        return _found(system, p, most_points)


def _found(system: System, p: float, most_points: int) -> SteadyWave:
    """An answer from nothing, or the last wave on the way to it and why that ended."""
    count = 0
    for start in _starts(system, p):
        wave = refined(newton(system, start, p), min(most_points, _MOST_AT_ONCE))
        count += wave.iterations
        at_limit = 4 * (wave.modes.size + 1) > most_points
        if wave.residual <= TOLERANCE and (wave.tail <= _COARSE_TAIL or at_limit):
            break
    else:
        wave = _from_damped(system, p, most_points)
        count += wave.iterations
    wave = refined(replace(wave, iterations=count), most_points)
    return (
        wave
        if wave.converged
        else replace(wave, reason=_cause(wave, max(most_points // 2, wave.modes.size + 1)) + wave.reason)
    )


def _starts(system: System, p: float) -> list[Array]:
    """Waves to begin with, the likeliest first: a bore where steepening rules, the linear wave."""
    strength = math.sqrt(2.0 * abs(system.half_forcing))
    first, second = system.coefficient(p)[:2]
    detuning = -first.real / strength
    other = abs(second - first.real) - first.imag
    if other > _WEAK * strength or abs(detuning) >= 4.0 / math.pi:
        return [system.linear(p)]
    front, n = -2.0 * math.asin(0.25 * math.pi * detuning), system.n
    turn = np.exp(0.5j * front)
    bore = 1j / math.pi * np.exp(-1j * front * n) * (turn / (n - 0.5) + np.conj(turn) / (n + 0.5))
    return [split(strength * np.exp(-np.square(n / _ROUND)) * bore), system.linear(p)]


def _from_damped(system: System, p: float, most_points: int) -> SteadyWave:
    """Follow the answer while an extra diffusion, at first stronger than the forcing, is taken away."""
    problem, most = system.problem, most_points // 2 - 1
    make = functools.partial(DampingSystem, problem, speed=p * system.scale)
    damped = make(_FEWEST)
    begun = newton(damped, damped.linear(_EXTRA), _EXTRA, _COARSE)
    first = np.append(scaled_unknowns(begun), _EXTRA)
    path = march(make, first, 0.0, replace(_WAY, most_modes=min(most, _WAY.most_modes)))
    count = begun.iterations + sum(point.corrections for point in path.points)
    if path.reason:
        last = path.points[-1].here if path.points else first
        wave = as_wave(System(problem, last.size // 2), last[:-1], p, math.inf, count)
        extra = last[-1] * system.scale
        return replace(wave, reason=f"followed down to {extra:.3g} rad^2/s more diffusion: {path.reason}")
    y = landing(path, 0.0)
    modes = max(system.modes, y.size // 2)
    while True:
        wave = newton(System(problem, modes), resized(y, modes), p)
        count += wave.iterations
        # The coarse wave may need more modes before it leads to the answer.
        if wave.residual <= TOLERANCE or 2 * modes + 1 > most:
            return replace(wave, iterations=count)
        modes = 2 * modes + 1


def _cause(wave: SteadyWave, most: int) -> str:
    """What keeps the wave from being found, if it shows: short waves standing on it [theory: kdv, eq. 28]."""
    n = np.arange(1.0, most + 1.0)
    crest = _SHORT * np.max(np.abs(values(wave.modes, 4 * (wave.modes.size + 1))))
    ahead = np.abs(wave.problem.frequency(n) / n - wave.speed)
    standing = np.flatnonzero(ahead <= abs(wave.problem.steepening) * crest)
    crests = int(standing[-1]) + 1 if standing.size else 0
    if crests == most:
        return f"the wave breaks, even waves of {most} crests round the drum do not outrun it; "
    return f"a bore with waves of up to {crests} crests round the drum; " if crests > 50 else ""
