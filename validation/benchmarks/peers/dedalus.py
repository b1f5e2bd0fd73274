"""Dedalus 3 (Fourier, implicit-explicit) on the benchmarks' problems."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from meshes.arrays import Array
from validation.benchmarks.problems import SteadyProblem, TravellingProblem, spectrum
from validation.benchmarks.timing import Contestant, Go

CODE, PACKAGE = "Dedalus", "dedalus"


def steady(problem: SteadyProblem, quick: bool = False) -> list[Contestant]:
    """Implicit-explicit steps from rest in the frame of the whirl, the linear terms implicit."""
    names = problem.constants
    settings = (
        (("RK443", 64, 0.03),)
        if quick
        else (
            ("RK111", 64, 0.05), ("RK222", 64, 0.05), ("RK443", 64, 0.08), ("SBDF1", 48, 0.05),
            ("SBDF1", 64, 0.05), ("SBDF1", 64, 0.1), ("SBDF1", 64, 0.15),
            ("SBDF2", 64, 0.02), ("SBDF2", 64, 0.05), ("SBDF2", 64, 0.08), ("SBDF3", 64, 0.02),
        )
    )  # fmt: skip
    return [
        Contestant(
            CODE, f"{scheme}, {n} points, dt {dt:g} s", _builder(names, scheme, n, dt, problem.time), size=n
        )
        for scheme, n, dt in settings
    ]


def travelling(problem: TravellingProblem, quick: bool = False) -> list[Contestant]:
    """Implicit-explicit steps of several lengths."""
    names = {"c": 0.0, "a": problem.c.steepening, "d": problem.c.dispersion, "nu": 0.0, "g": 0.0, "q": 0.0}
    settings = (
        (("RK443", 64, 400),)
        if quick
        else (
            ("RK222", 64, 1000), ("RK222", 64, 5000), ("RK443", 64, 1000), ("RK443", 64, 2500),
            ("RK443", 96, 5000), ("SBDF2", 64, 2000), ("SBDF2", 64, 9000), ("SBDF3", 96, 20000),
        )
    )  # fmt: skip
    return [
        Contestant(
            CODE,
            f"{scheme}, {n} points, {steps} steps",
            _builder(names, scheme, n, problem.time / steps, problem.time, problem.start),
            size=n,
        )
        for scheme, n, steps in settings
    ]


def _builder(
    names: dict[str, float],
    scheme: str,
    points: int,
    dt: float,
    time: float,
    start: Callable[[Array], Array] | None = None,
) -> Callable[[], Callable[[], Go]]:
    """What builds a run of equal steps of about dt that ends at the time."""

    def build() -> Callable[[], Go]:
        import dedalus.public as d3

        for name in ("solvers", "subsystems"):
            logging.getLogger(name).setLevel(logging.WARNING)
        axis = d3.Coordinate("x")
        distributor = d3.Distributor(axis, dtype=np.float64)
        basis = d3.RealFourier(axis, size=points, bounds=(0.0, 2.0 * math.pi), dealias=3 / 2)
        x = distributor.local_grid(basis)
        u, push = distributor.Field(name="u", bases=basis), distributor.Field(name="push", bases=basis)
        push["g"] = -names["q"] * np.sin(x)
        known = names | {"u": u, "push": push, "dx": lambda field: d3.Differentiate(field, axis)}
        problem = d3.IVP([u], namespace=known)
        linear = "dt(u) + c*dx(u) + d*dx(dx(dx(u))) - nu*dx(dx(u)) + g*u"
        problem.add_equation(f"{linear} = - a*u*dx(u)" + (" + push" if names["q"] else ""))
        steps = max(1, math.ceil(time / dt * (1.0 - 1e-12)))

        def fresh() -> Go:
            solver = problem.build_solver(getattr(d3, scheme))
            u.change_scales(1)
            u["g"] = start(x) if start else 0.0

            def go() -> Any:
                for _ in range(steps):
                    solver.step(time / steps)
                u.change_scales(1)
                return spectrum(np.array(u["g"]))

            return go

        return fresh

    return build
