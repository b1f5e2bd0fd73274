"""This package on the benchmarks' problems: unidirectional waves, and long waves under a whirl."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from fluid.friction.laws import Friction, FrictionLaw
from meshes.arrays import Array, Complex
from solvers.layer.state import Numerics
from solvers.liquid_model import Whirl
from solvers.pypde.settle import simulate
from solvers.waves.modes import WaveTerms, wave_split
from solvers.waves.steady import solve
from solvers.waves.stepper import Control, advance_adaptive, advance_fixed, to_spectrum
from validation.benchmarks.problems import (
    METHOD,
    SPIN,
    SteadyProblem,
    TravellingProblem,
    fill,
    seen_from_whirl,
    whirl_split,
)
from validation.benchmarks.timing import Answer, Contestant, Go

# The axis turns at the layer's retrograde resonance; half the depth off would be dry.
SPEED, AMPLITUDE, RAMP = 30.575880656422154, 7.5e-4, 0.6
FRICTION = 1.0  # 1/s, linear


@dataclass(frozen=True)
class LayerProblem:
    """A layer from rest under a whirl at its resonance, a bore after some periods, settled by friction."""

    periods: int  #: whirl periods, seen from the drum

    @property
    def whirl(self) -> Whirl:
        """What drives it."""
        return Whirl(SPIN, SPEED, AMPLITUDE, RAMP)

    @property
    def duration(self) -> float:
        """Time of the run, 1/Omega."""
        return self.periods * self.whirl.period * SPIN

    @property
    def friction(self) -> float:
        """Coefficient of the linear law, Omega."""
        return FRICTION / SPIN

    @property
    def area(self) -> float:
        """Liquid area per radian at rest, R^2."""
        layer = fill()
        return layer.volume / (2.0 * math.pi * layer.chamber.height * layer.chamber.radius**2)

    def force(self, time: float) -> complex:
        """Body force in the drum frame at a time in 1/Omega, Omega^2 R [theory: long_wave, eq. 8]."""
        whirl, seconds = self.whirl, time / SPIN
        part = min(seconds / whirl.ramp, 1.0)
        grown = part - math.sin(2.0 * math.pi * part) / (2.0 * math.pi)
        size = whirl.amplitude / fill().chamber.radius * (whirl.speed / SPIN) ** 2
        return size * grown * cmath.exp(1j * whirl.slip * seconds)

    def in_whirl_frame(self, area: Array) -> Array:
        """Angles of the cells' middles from the deflection at the end, and areas over R^2, shape (2, n)."""
        middle = 2.0 * math.pi * (np.arange(area.size) + 0.5) / area.size
        return np.stack([middle - self.whirl.slip * self.duration / SPIN, area])


def ours(problem: LayerProblem, cells: tuple[int, ...]) -> list[Contestant]:
    """The finite-volume solver on several grids."""

    def builder(n: int) -> Callable[[], Callable[[], Go]]:
        return lambda: lambda: partial(answer, problem, n)

    return [Contestant(CODE, f"{n} cells", builder(n), size=n) for n in cells]


def answer(problem: LayerProblem, cells: int) -> Array:
    """Layer at the end of the problem by this package, as from `LayerProblem.in_whirl_frame`."""
    layer, whirl = fill(), problem.whirl
    history = simulate(
        layer, whirl, problem.periods * whirl.period, Friction(FrictionLaw.LINEAR, FRICTION), Numerics(cells)
    )
    if not history.converged:
        raise RuntimeError("the surface came to the axis")
    surface = 1.0 - history.depth / layer.chamber.radius
    return np.stack([history.theta, 0.5 * (1.0 - surface * surface)])


def profile_error(found: Answer, reference: Answer) -> float:
    """L1 distance of two profiles, shapes (2, n) and (2, m), over the reference's departure from the mean.

    The reference is averaged over the cells of the one found.
    """
    area = np.real(found[1])
    cells = area.size
    edges = np.real(found[0]) - math.pi / cells
    step = 2.0 * math.pi / cells
    exact = (_integral(reference, edges + step) - _integral(reference, edges)) / step
    return float(np.sum(np.abs(area - exact)) / np.sum(np.abs(exact - np.mean(exact))))


def force_error(found: Answer, reference: Answer) -> float:
    """Distance of the liquid's centres of mass, to which the forces on the drum go, over the reference's."""
    near, exact = offset(found), offset(reference)
    return abs(near - exact) / abs(exact)


def offset(profile: Answer) -> complex:
    """Distance of the liquid's centre of mass from the drum's axis, R; real along the deflection."""
    theta, area = np.real(profile[0]), np.real(profile[1])
    moment = np.sum((1.0 - np.power(1.0 - 2.0 * area, 1.5)) / 3.0 * np.exp(1j * theta))
    return complex(moment / np.sum(area))


def _integral(profile: Answer, angle: Array) -> Array:
    """Integral of a piecewise constant periodic profile from the left edge of its first cell."""
    order = np.argsort(np.mod(np.real(profile[0]), 2.0 * math.pi))
    middle, area = np.mod(np.real(profile[0]), 2.0 * math.pi)[order], np.real(profile[1])[order]
    width = 2.0 * math.pi / area.size
    edges = middle[0] - 0.5 * width + width * np.arange(area.size + 1)
    sums = np.concatenate(([0.0], np.cumsum(area) * width))
    turns = np.floor((angle - edges[0]) / (2.0 * math.pi))
    return np.asarray(np.interp(angle - 2.0 * math.pi * turns, edges, sums) + turns * sums[-1])


CODE = "leblanc"


def steady(problem: SteadyProblem, quick: bool = False) -> list[Contestant]:
    """Newton's method on several numbers of points, and the exponential stepper from rest."""
    newton = [
        Contestant(CODE, f"Newton, {points} points", _newton(problem, points), size=points)
        for points in ((32, 128) if quick else (32, 64, 96, 128, 256))
    ]
    # The longest stable steps: what is steady does not depend on them.
    steps = (
        ((64, 0.04),) if quick else ((48, 0.05), (64, 0.02), (64, 0.03), (64, 0.04), (64, 0.05), (96, 0.03))
    )
    stepped = [
        Contestant(CODE, f"ETDRK4-B, {n} points, dt {dt:g} s", _from_rest(problem, n, dt), size=n)
        for n, dt in steps
    ]
    return newton + stepped


def travelling(problem: TravellingProblem, quick: bool = False) -> list[Contestant]:
    """Exponential stepper at several tolerances, with as many points as each deserves."""
    settings = (
        ((64, 1e-5), (96, 1e-7))
        if quick
        else ((48, 1e-4), (64, 1e-5), (96, 1e-6), (96, 1e-7), (128, 1e-8), (128, 1e-9), (160, 1e-10))
    )
    return [
        Contestant(CODE, f"ETDRK4-B, {n} points, tolerance {tol:g}", _run(problem, n, tol), size=n)
        for n, tol in settings
    ]


def _newton(problem: SteadyProblem, points: int) -> Callable[[], Callable[[], Go]]:
    def go() -> Complex:
        return solve(problem.waves, problem.speed, points=points, most_points=points).modes

    return lambda: lambda: go


def _from_rest(problem: SteadyProblem, points: int, dt: float) -> Callable[[], Callable[[], Go]]:
    def build() -> Callable[[], Go]:
        split, steps = whirl_split(problem, points), math.ceil(problem.time / dt)
        rest = np.zeros(points // 2 + 1, dtype=complex)

        def go() -> Complex:
            done = advance_fixed(split, rest, (0.0, problem.time), steps, METHOD)
            return seen_from_whirl(done, problem.speed, points)

        return lambda: go

    return build


def _run(problem: TravellingProblem, points: int, tolerance: float) -> Callable[[], Callable[[], Go]]:
    def build() -> Callable[[], Go]:
        split = wave_split(WaveTerms(problem.c), points)
        theta = 2.0 * np.pi * np.arange(points) / points
        start: Array = problem.start(theta)

        def go() -> Complex:
            done = advance_adaptive(
                split, to_spectrum(start), (0.0, problem.time), Control(tolerance), METHOD
            )
            return seen_from_whirl(done, problem.c.linear_speed, points)

        return lambda: go

    return build
