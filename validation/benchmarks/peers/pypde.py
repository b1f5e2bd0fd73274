"""py-pde as it comes (finite differences of second order) on the benchmarks' problems.

BDF and Radau, by py-pde's scipy solver, are told which cells act on which: their Jacobian is sparse and costs
few evaluations.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from meshes.arrays import Array
from validation.benchmarks.problems import SteadyProblem, TravellingProblem, spectrum
from validation.benchmarks.timing import Contestant, Go

CODE, PACKAGE = "py-pde", "pde/py-pde"

_FREE = "- a * u * d_dx(u) - d * d_dx(laplace(u))"
FORCED = f"-c * d_dx(u) {_FREE} + nu * laplace(u) - g * u - q * sin(x)"


def steady(problem: SteadyProblem, quick: bool = False) -> list[Contestant]:
    """BDF, Radau and explicit Runge-Kutta from rest in the frame of the whirl."""
    consts = problem.constants

    def implicit(method: str, points: int) -> Contestant:
        build = _builder(FORCED, consts, points, problem.time, _implicit(method, points, 1e-2, 1e-9))
        return Contestant(CODE, f"{method}, {points} points, rtol 0.01", build, size=points)

    def explicit(points: int) -> Contestant:
        dt = problem.time / math.ceil(problem.time / _stable(problem.c.dispersion, points))
        options = {"solver": "runge-kutta", "dt": dt}
        build = _builder(FORCED, consts, points, problem.time, options)
        return Contestant(CODE, f"RK4, {points} points, dt {dt:.2g} s", build, size=points)

    if quick:
        return [implicit("BDF", 128)]
    # BDF is not stable next to the imaginary axis: weakly damped waves hold its steps down for minutes.
    methods = ("BDF", "Radau") if problem.waves.decay > 0.1 else ("Radau",)
    runs = [implicit(method, n) for method in methods for n in (256, 512, 1280, 1792)]
    return [*runs, explicit(128), explicit(256), explicit(512)]


def travelling(problem: TravellingProblem, quick: bool = False) -> list[Contestant]:
    """Explicit Runge-Kutta, with steps of one length and adaptive, and implicit BDF."""
    consts: dict[str, Any] = {"a": problem.c.steepening, "d": problem.c.dispersion}
    size = abs(problem.wave.height)

    def contestant(name: str, points: int, options: dict[str, Any]) -> Contestant:
        build = _builder(_FREE, consts, points, problem.time, options, problem.start)
        return Contestant(CODE, f"{name}, {points} points", build, size=points)

    def explicit(points: int) -> Contestant:
        dt = problem.time / math.ceil(problem.time / _stable(problem.c.dispersion, points))
        return contestant("RK4 at its longest step", points, {"solver": "runge-kutta", "dt": dt})

    if quick:
        return [explicit(96)]
    runs = [explicit(n) for n in (128, 256, 512, 768)]
    adaptive = {"solver": "runge-kutta", "adaptive": True, "tolerance": 1e-5 * size}
    runs.append(contestant("RK45 adaptive", 256, adaptive))
    for points, rtol in ((128, 1e-3), (256, 1e-3), (256, 1e-4)):
        runs.append(
            contestant(f"BDF, rtol {rtol:g}", points, _implicit("BDF", points, rtol, 1e-2 * rtol * size))
        )
    return runs


def _stable(dispersion: float, points: int) -> float:
    """Step of RK4, stable up to 2.8 on the imaginary axis; the third difference reaches 3 sqrt(3)/2 /dx^3."""
    return 0.9 * 2.8 / (2.6 * abs(dispersion) * (points / (2.0 * math.pi)) ** 3)


def _implicit(method: str, points: int, rtol: float, atol: float) -> dict[str, Any]:
    """Options of scipy's implicit methods with the Jacobian's pattern: two cells to each side."""
    from scipy.sparse import diags_array

    offsets = [*range(-2, 3), points - 2, points - 1, 1 - points, 2 - points]
    pattern = diags_array([np.ones(points - abs(k)) for k in offsets], offsets=offsets).tocsc()
    return {"solver": "scipy", "method": method, "rtol": rtol, "atol": atol, "jac_sparsity": pattern}


def _builder(
    text: str,
    consts: dict[str, Any],
    points: int,
    time: float,
    options: dict[str, Any],
    start: Callable[[Array], Array] | None = None,
) -> Callable[[], Callable[[], Go]]:
    """What builds the stepper that `PDE.solve` would call, compiled once by numba on one thread."""

    def build() -> Callable[[], Go]:
        from pde import config  # type: ignore[attr-defined]
        from pde.fields.scalar import ScalarField
        from pde.grids.cartesian import CartesianGrid
        from pde.pdes.pde import PDE
        from pde.solvers.base import SolverBase

        logging.getLogger("pde").setLevel(logging.WARNING)
        config["backend.numba.multithreading"] = "never"
        grid = CartesianGrid([(0.0, 2.0 * math.pi)], points, periodic=True)
        x: Any = grid.axes_coords[0]
        state = ScalarField(grid, start(x) if start else 0.0)
        choice = dict(options)
        dt = choice.pop("dt", None)
        equation = PDE({"u": text}, consts=consts)
        solver = SolverBase.from_name(choice.pop("solver"), pde=equation, backend="numba", **choice)
        stepper = solver.make_stepper(state, dt)
        # The first call compiles.
        stepper(state.copy(), 0.0, dt or 1e-9 * time)

        def fresh() -> Go:
            moving = state.copy()

            def go() -> Any:
                stepper(moving, 0.0, time)
                return spectrum(np.asarray(moving.data, dtype=float), x[0])

            return go

        return fresh

    return build
