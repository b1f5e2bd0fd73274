"""Steady waves of one family as a py-pde solver: Newton's method in place of steps in time."""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from pde.backends.base import BackendBase
from pde.grids.base import GridBase
from pde.solvers.base import ConvergenceError, SolverBase

from fluid.kdv import wave_frequency
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.pypde.one_family import KdvBurgersPDE, circle_points
from solvers.waves.modes import WaveProblem, WaveTerms, values
from solvers.waves.newton import SteadyWave
from solvers.waves.steady import solve


class SteadyNewtonSolver(SolverBase):  # type: ignore[no-untyped-call]
    """Steady wave in the frame of the whirl, by the name "steady_newton" [theory: kdv, eq. 18].

    The state comes back as the wave that the whirl holds once all others have decayed, with the whirl fully
    grown, at the angle that it has at each stop. It is found from nothing, by continuation from a strongly
    damped one where that is needed; `info["wave"]` has it on as many modes as it needs.
    """

    name = "steady_newton"
    _use_post_step_hook = False

    def __init__(self, pde: KdvBurgersPDE, *, backend: str | BackendBase[Any] = "auto") -> None:
        super().__init__(pde, backend="numpy" if backend == "auto" else backend)
        if not isinstance(pde, KdvBurgersPDE):
            raise InputError("pde", type(pde).__name__, "a KdvBurgersPDE")
        self.terms = pde.terms

    def make_stepper(self, state: Any, dt: float | None = None) -> Any:
        """Function that puts the wave in place of a state; there are no steps, `dt` must be None."""
        if dt is not None:
            raise InputError("dt", dt, "left out: there are no steps in time")
        circle_points(state.grid)
        self._select_backend(state)
        wave = solve(steady_problem(self.terms), self.terms.whirl_speed)
        self.info |= {"dt": None, "dt_adaptive": False, "stochastic": False, "steps": wave.iterations}
        self.info |= {"wave": wave, "residual": wave.residual, "tail": wave.tail}
        self.info["status"] = "finished" if wave.converged else "not converged"

        def advance(state: Any, start: float, stop: float) -> float:
            if not wave.converged:
                self.info["reason"] = wave.reason
                raise ConvergenceError(wave.reason)
            state.data[...] = drawn(wave, state.grid, stop)
            return stop

        return advance


def steady_problem(terms: WaveTerms) -> WaveProblem:
    """The equations of a steady wave, of what acts on waves in time."""
    frequency = functools.partial(wave_frequency, c=terms.c, whitham=terms.whitham)
    return WaveProblem(frequency, terms.c.steepening, terms.forcing, terms.damping, terms.viscosity)


def drawn(wave: SteadyWave, grid: GridBase, time: float) -> Array:
    """Heights of a steady wave on a grid, which may be too coarse for all modes, m^2, shape (points,)."""
    points, first = circle_points(grid)
    modes = wave.modes
    turn = np.exp(1j * np.arange(1, modes.size + 1) * (first - wave.speed * time))
    finer = math.ceil((2 * modes.size + 1) / points)
    return np.asarray(values(modes * turn, finer * points)[::finer])
