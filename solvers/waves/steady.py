"""Steady periodic waves of one family in the frame of the whirl: one of them, and all answers over the speed.

Newton's method finds them without time stepping. N points carry the modes 1..N/2 - 1; they are doubled until
the spectrum's tail is low enough. `follow` traces one curve over the whirl speed, through its folds,
`growth_rates` tells which of its waves last, `respond` collects the waves at given speeds from the curves
that pass them.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import eigvals

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
from solvers.waves.newton import (
    TAIL,
    TOLERANCE,
    Pace,
    Path,
    SteadyWave,
    as_wave,
    landing,
    march,
    newton,
    refined,
    scaled_unknowns,
    segment,
)

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
    """Waves of one family under the whirl, whose axis accelerates by F = omega_w^2 w0, m/s^2."""
    frequency = functools.partial(wave_frequency, c=c, whitham=whitham)
    return WaveProblem(frequency, c.steepening, float(forcing(c, acceleration)), decay, diffusion)


def solve(
    problem: WaveProblem,
    speed: float,
    guess: Complex | None = None,
    points: int = 128,
    most_points: int = MOST_POINTS,
) -> SteadyWave:
    """One steady wave at a whirl speed seen from the drum, rad/s, with as many points as it needs.

    Where several answers exist it is the one next to the guess (modes, m^2, shape (m,)); else next to the
    bore of vanishing dispersion [theory: kdv, eq. 27] or to the linear wave or, if Newton's method does not
    arrive from there, the one that grows out of a strongly damped wave as the extra damping is taken away;
    `respond` finds the others. Points, at least 12, are doubled until the spectrum's tail falls below `TAIL`;
    a wave that needs more than `most_points` is not converged. Without forcing it is rest; a guess is refused
    there, since a natural sloshing wave is defined up to a shift only.
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


MOST_CURVE_POINTS = 2 * (DENSE_MODES + 1)
# Steps along a curve, in units of the scaled wave and speed.
_LONGEST, _SHORTEST = 0.5, 1e-7
# Two answers at a speed that differ by less, relative to their modes, are the same one.
_SAME = 1e-6
# A passage is looked for this far beyond both ends of its segment, and counts as real below this.
_EDGE = 1e-9
# Coefficients of the scaled speed along a segment that are only rounding.
_FLAT = 1e-14


@dataclass(frozen=True)
class Branch:
    """A curve of steady waves over the whirl speed, through its folds."""

    waves: tuple[SteadyWave, ...]  #: points in order along the curve
    #: unit tangents of the curve there, scaled [Re v, Im v, p]
    tangents: tuple[Array, ...] = field(repr=False)
    complete: bool  #: the far end of the range was reached
    reason: str  #: why not, in words; empty if complete

    @property
    def speeds(self) -> Array:
        """Whirl speeds s of the points, rad/s, shape (k,)."""
        return np.array([wave.speed for wave in self.waves])

    @property
    def folds(self) -> tuple[int, ...]:
        """Indices of the points at which the speed turns back."""
        onward = np.sign(np.diff(self.speeds))
        return tuple(int(k) for k in np.flatnonzero(onward[1:] * onward[:-1] < 0.0) + 1)


def follow(
    problem: WaveProblem,
    start: float,
    stop: float,
    points: int = 128,
    most_steps: int = 4000,
    longest: float = _LONGEST,
) -> Branch:
    """Follow the curve of steady waves from one whirl speed, rad/s, to another, through its folds.

    It starts at the wave of `solve`; `longest` step in units of the scaled wave and speed. `complete` is
    False where it came back to the start, left what the modes resolve or ran out of steps.
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


def growth_rates(wave: SteadyWave) -> Complex:
    """Growth rates of small disturbances of a steady wave in the whirl's frame, 1/s, largest real part first.

    On disturbances that carry no liquid to or from the layer [theory: kdv, eq. 21], shape (2 M,); of a free
    wave the direction of a shift is taken out, (2 M - 1,). At most `DENSE_MODES` modes.
    """
    if not wave.converged:
        raise InputError("wave", wave.reason, "converged")
    if wave.modes.size > DENSE_MODES:
        raise InputError("wave", wave.modes.size, f"of at most {DENSE_MODES} modes")
    problem, m = wave.problem, wave.modes.size
    with one_thread():
        system = System(problem, m)
        jacobian = system.jacobian(scaled_unknowns(wave), wave.speed / system.scale, m)
        n = system.n[:, None]
        # d v_n/dt = -i n times the derivative of the equation of mode n.
        operator = np.vstack((n * jacobian[m:], -n * jacobian[:m]))
        if problem.forcing == 0.0 and wave.rms > 0.0:
            shift = split(1j * system.n * wave.modes)
            basis = np.linalg.qr(shift[:, None], mode="complete")[0][:, 1:]
            operator = basis.T @ operator @ basis
        values = eigvals(operator, check_finite=False) * system.scale
    return np.asarray(values[np.argsort(-values.real)])


def growth(wave: SteadyWave) -> float:
    """Largest growth rate of small disturbances, 1/s; arguments and errors as in `growth_rates`."""
    return float(growth_rates(wave)[0].real)


@dataclass(frozen=True)
class Response:
    """All steady waves found at each of a row of whirl speeds."""

    speeds: Array  #: s, rad/s, shape (k,)
    waves: tuple[tuple[SteadyWave, ...], ...]  #: for each speed its answers, smallest first
    #: for each speed the growth rates of those, 1/s; empty unless asked for
    growth: tuple[tuple[float, ...], ...]
    #: the curves followed: from the lowest speed and, where that one does not reach the other end by itself,
    #: from the highest
    branches: tuple[Branch, ...]
    complete: bool  #: a curve reached from one end to the other, and each of its passages was solved
    reason: str  #: why not, in words; empty if complete


def respond(
    problem: WaveProblem, speeds: ArrayLike, points: int = 128, margin: float = 0.0, stability: bool = False
) -> Response:
    """All steady waves at a row of rising whirl speeds, rad/s, connected to those beyond the row.

    The curves begin `margin` outside, rad/s; far from resonance the answer there is unique.
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


def _alike(wave: SteadyWave, other: SteadyWave) -> bool:
    common = min(wave.modes.size, other.modes.size)
    gap = np.linalg.norm(wave.modes[:common] - other.modes[:common])
    return bool(gap <= _SAME * np.linalg.norm(wave.modes))
