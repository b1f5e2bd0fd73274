"""The steady wave of one family under a prescribed whirl, by py-pde: by Newton's method, or in time."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from pde.solvers.base import ConvergenceError

from meshes.arrays import Array
from solvers.liquid_model import Whirl
from solvers.pypde.grid import circle
from solvers.pypde.one_family import KdvBurgersPDE
from solvers.pypde.steady_newton import SteadyNewtonSolver
from solvers.pypde.stock import SAMPLES, require_solver, stepping
from solvers.pypde.stretches import StretchMeans, gently, run, settling
from solvers.waves.modes import WaveTerms
from solvers.waves.newton import SteadyWave

NEWTON = SteadyNewtonSolver.name
# Relative change of the mean offset: of a wave that has settled; without damping, where natural waves stay.
_SETTLED, _STIRRED = 1e-6, 1e-3


def steady_wave(terms: WaveTerms, points: int) -> SteadyWave:
    """The steady wave of one family that py-pde's `solve` comes back with."""
    equation = KdvBurgersPDE(**vars(terms))
    with suppress(ConvergenceError):  # which the wave tells as well
        equation.solve(equation.start(circle(points)), 1.0, tracker=None, solver=NEWTON)
    found: SteadyWave = equation.diagnostics["solver"]["wave"]
    return found


def steady_state(
    terms: WaveTerms,
    whirl: Whirl,
    points: int,
    solver: str,
    progress: Callable[[float], object] | None = None,
) -> tuple[Array, str]:
    """Wave left of rest under a whirl that has grown gently, and why it is not steady, or empty.

    Heights at equal steps of the angle from the deflection, m^2, shape (points,).
    """
    whirl = gently(whirl)
    named = vars(replace(terms, ramp=whirl.ramp))
    equation = KdvBurgersPDE(named.pop("c"), **named)
    require_solver(equation, solver)
    state = equation.start(circle(points))
    settled = _SETTLED if terms.damping or terms.viscosity else _STIRRED
    means = StretchMeans(equation, settling(whirl, False), SAMPLES, settled)
    options = stepping(equation, state.grid, solver, whirl.period / SAMPLES)
    reason = run(equation, state, means, solver, options, progress)
    if not reason and not means.steady:
        reason = "the wave still changes from one stretch of whirl periods to the next"
    return equation.seen(*(means.last or (state, 0.0))), reason
