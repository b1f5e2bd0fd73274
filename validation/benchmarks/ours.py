"""This package on the benchmarks' problems."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from meshes.arrays import Array, Complex
from solvers.waves.modes import WaveTerms, wave_split
from solvers.waves.steady import solve
from solvers.waves.stepper import Control, advance_adaptive, advance_fixed, to_spectrum
from validation.benchmarks.problems import (
    METHOD,
    SteadyProblem,
    TravellingProblem,
    seen_from_whirl,
    whirl_split,
)
from validation.benchmarks.timing import Contestant, Go

CODE = "leblanc"


def steady(problem: SteadyProblem, quick: bool = False) -> list[Contestant]:
    """Newton's method on several numbers of points, and the exponential stepper from rest.

    Parameters
    ----------
    problem : what to solve
    quick : only a few settings
    """
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
    """The exponential stepper at several tolerances, with as many points as each deserves.

    Parameters
    ----------
    problem : what to solve
    quick : only a few settings
    """
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
