"""Newton's method for steady waves, and curves of them over one parameter, through their folds.

The derivative has a dense low block and a diagonal above it, where the coefficient of a mode outweighs all
that the wave's height couples to it. Where corrections gain too little new factors are made, at last with all
modes in the block, or, beyond `DENSE_MODES`, GMRES takes over. A point of a curve is the scaled wave and the
parameter, [Re v, Im v, p]; the next one is predicted by the cubic through the last two with their tangents
and corrected on the plane across the curve: pseudo-arclength continuation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
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
    """A steady wave, or how far the search for it came."""

    problem: WaveProblem = field(repr=False)  #: what it answers
    speed: float  #: s, rad/s
    modes: Complex = field(repr=False)  #: coefficients of e^{i n xi}, n = 1..M, of eta, m^2, shape (M,)
    converged: bool  #: the equations are met and the spectrum is resolved
    reason: str  #: why not, in words; empty if converged
    iterations: int  #: Newton steps in all
    residual: float  #: of the equations, each mode over its coefficient, relative to the wave
    tail: float  #: largest of the last eighth of the modes over the largest mode

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
    """Factors of the derivative at a wave; where a plane's direction is given, bordered by it and by p."""
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


_CORRECTIONS = 24
# Factors that gain less than this are made anew.
_SLOW_ON_CURVE = 0.3
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
    """How a curve is followed."""

    longest: float  #: steps, in units of the scaled wave and parameter
    shortest: float
    tolerance: float  #: of each point's residual
    tail: float  #: of each point's spectrum
    most_modes: int  #: a curve whose waves need more ends
    most_steps: int  #: limit of its points
    most_work: float = math.inf  #: limit of the work on dense blocks, the cube of the modes in each


def march(make: Callable[[int], System], first: Array, target: float, pace: Pace) -> Path:
    """Follow a curve from a point [Re v, Im v, p] to the first one beyond the target of its parameter."""
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
        *behind, last = (
            replace(point, here=widened(point.here, system.modes), ahead=widened(point.ahead, system.modes))
            for point in points[-2:]
        )
        guess = _predicted(behind[0] if behind else None, last, step)
        found, cost = _correct(system, guess, last.ahead, pace.tolerance)
        work += cost
        # Correction over the step; infinite where the curve turns: it may be another one.
        stray = math.inf
        if found is not None and dot(found.ahead, last.ahead) >= _TURN:
            stray = math.sqrt(dot(found.here - guess, found.here - guess)) / step
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


def segment(begin: Array, end: Array, leaving: Array, arriving: Array) -> tuple[Array, float]:
    """Cubic between two points with their tangents, u^0 ... u^3 up to u = 1, and the curve's length."""
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
            if factors is None or error > _SLOW_ON_CURVE * before:
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
