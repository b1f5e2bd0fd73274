"""Waves of one family as a py-pde equation, and the exponential steppers as a py-pde solver.

The right-hand side is spectral on a circle of evenly spaced cells and written in numpy: every py-pde
solver, tracker and storage works on it and nothing is compiled. Importing this module registers the solver
"exponential".
"""

from __future__ import annotations

import cmath
import math
from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike
from pde.backends.base import BackendBase
from pde.fields.scalar import ScalarField
from pde.grids.base import GridBase
from pde.grids.cartesian import CartesianGrid
from pde.solvers.base import ConvergenceError, SolverBase

from fluid import kdv
from fluid.kdv import KdvCoefficients
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_positive
from solvers.pypde.grid import CirclePDE
from solvers.pypde.grid import circle as circle
from solvers.waves.modes import WaveTerms, wave_split
from solvers.waves.stepper import (
    Advance,
    Control,
    Split,
    advance_adaptive,
    advance_fixed,
    find_method,
    to_spectrum,
)


class SplitPDE(CirclePDE):  # type: ignore[no-untyped-call]
    """A py-pde equation that names its stiff linear part, for the solver "exponential"."""

    @abstractmethod
    def split(self, grid: GridBase) -> Split:
        """The equation as exponential steppers take it: linear symbol of each mode, and the rest."""


class KdvBurgersPDE(SplitPDE):  # type: ignore[no-untyped-call]
    """Weakly nonlinear waves of one family, forced by a whirl and damped [theory: kdv, eq. 1].

    The field is eta, the liquid area per radian above its mean, m^2. Parameters as of
    `solvers.waves.modes.WaveTerms`.
    """

    def __init__(
        self,
        c: KdvCoefficients,
        *,
        whitham: bool = False,
        viscosity: float = 0.0,
        damping: float = 0.0,
        forcing: float = 0.0,
        whirl_speed: float = 0.0,
        ramp: float = 0.0,
    ) -> None:
        super().__init__()
        self.terms = WaveTerms(c, whitham, viscosity, damping, forcing, whirl_speed, ramp)
        self._known: tuple[int, float, Split] | None = None
        self.explicit_time_dependence = self.terms.forcing != 0.0 and self.terms.whirl_speed != 0.0

    @staticmethod
    def start(grid: GridBase, change: ArrayLike = 0.0) -> ScalarField:
        """State from eta, m^2, of shape (n,) or one number."""
        return ScalarField(grid, np.broadcast_to(np.asarray(change, dtype=float), grid.shape).copy())

    def split(self, grid: GridBase) -> Split:
        """The equation as exponential steppers take it."""
        points, first = circle_points(grid)
        if self._known is None or self._known[:2] != (points, first):
            # py-pde's own solvers ask for it at each evaluation.
            self._known = points, first, wave_split(self.terms, points, first)
        return self._known[2]

    def evolution_rate(self, state: Any, t: float = 0.0) -> Any:
        """Right-hand side of the equation, for py-pde's own solvers."""
        split = self.split(state.grid)
        spectrum = to_spectrum(state.data)
        rate = split.symbol * spectrum + split.nonlinear(spectrum, t)
        return ScalarField(state.grid, np.fft.irfft(rate, n=state.data.size))

    def make_post_step_hook(self, state: Any, backend: str | BackendBase[Any] = "numpy") -> tuple[Any, Any]:
        """Check after each step of py-pde's own solvers that the wave is finite still."""

        # By these names: some of py-pde's solvers pass them as keywords.
        def check(state_data: Any, t: float, post_step_data: Any) -> tuple[Any, Any]:
            if not np.isfinite(state_data).all():
                raise ConvergenceError(f"the wave outgrew every number at t = {t:g} s")
            return state_data, post_step_data

        return check, None

    def loads(self, state: Any, t: float) -> Array:
        """Offset of the centre of mass at one moment, in the frame of the deflection, m, shape (2,)."""
        place = self.place(state, t)
        return np.array([place.real, place.imag])

    def place(self, state: Any, t: float) -> complex:
        """Offset of the centre of mass as a complex number, m, real along the deflection."""
        ahead = circle_points(state.grid)[1] - self.terms.whirl_speed * t
        return complex(kdv.offset(self.terms.c, state.data)) * cmath.exp(1j * ahead)

    def means(self, loads: Array, length: float, places: tuple[complex, complex]) -> Complex:
        """Mean over a time of the offset, m, shape (1,)."""
        return np.array([complex(*loads) / length])

    def seen(self, state: Any, t: float) -> Array:
        """The wave at equal steps of xi from the deflection, m^2, shape (points,)."""
        points, first = circle_points(state.grid)
        turn = np.arange(points // 2 + 1) * (self.terms.whirl_speed * t - first)
        return np.asarray(np.fft.irfft(to_spectrum(state.data) * np.exp(1j * turn), n=points))

    def fastest(self, grid: GridBase) -> float:
        """Frequency of the fastest mode on a grid, 1/s, by which explicit steps are bounded."""
        return float(np.abs(self.split(grid).symbol[:-1]).max())

    @property
    def sizes(self) -> tuple[float, ...]:
        """Size of a wave that is small, m^2, to which tolerances are relative."""
        return (0.01 * self.terms.c.mean_area,)

    # Steps times the fastest frequency, by py-pde's names: RK4 is stable up to 2.8; a step of Adams and
    # Bashforth grows by its fourth power, one of Euler by its square, which damping does not hold; fixed
    # points contract.
    steps: ClassVar[Mapping[str, float]] = {
        "runge-kutta": 1.5, "adams-bashforth": 0.05, "crank-nicolson": 0.8, "implicit": 0.4,
        "euler": 0.0, "explicit": 0.0,
    }  # fmt: skip


class ExponentialSolver(SolverBase):  # type: ignore[no-untyped-call]
    """Exponential steppers for every py-pde equation that is a `SplitPDE`, by the name "exponential".

    Method "etdrk4", "krogstad" or "ifrk4". Without `dt` the steps follow the tolerance, the error of a step
    over the field, both root mean squares; with it they are as long as `dt` or, to land on the times of
    trackers, shorter. Hooks after each step are not called. The rest of the split is followed in a frame of
    angular speed `frame`, rad/s; None: the equation's.
    """

    name = "exponential"
    _use_post_step_hook = False

    def __init__(
        self,
        pde: SplitPDE,
        *,
        backend: str | BackendBase[Any] = "auto",
        method: str = "krogstad",
        tolerance: float = 1e-6,
        frame: float | None = None,
    ) -> None:
        super().__init__(pde, backend="numpy" if backend == "auto" else backend)
        self.equation = pde
        if not isinstance(pde, SplitPDE):
            raise InputError("pde", type(pde).__name__, "a SplitPDE")
        find_method(method)
        require_positive("tolerance", tolerance)
        self.method, self.tolerance, self.frame = method, tolerance, frame

    def make_stepper(self, state: Any, dt: float | None = None) -> Any:
        """Function that advances a state from one time to another by steps of `dt`, s; None: adaptive."""
        if dt is not None:
            require_positive("dt", dt)
        split = self.equation.split(state.grid)
        if self.frame is not None:
            split = Split(split.symbol, split.nonlinear, self.frame)
        self._select_backend(state)
        self.info |= {"dt": dt, "dt_adaptive": dt is None, "stochastic": False, "method": self.method}
        self.info |= {"steps": 0, "rejected": 0, "smallest_step": math.inf, "largest_error": 0.0}
        self.info["status"] = "finished"
        points, trial = state.data.size, None

        def advance(state: Any, start: float, stop: float) -> float:
            nonlocal trial
            if stop - start <= 4.0 * np.finfo(float).eps * max(abs(start), abs(stop)):
                return stop
            spectrum, span = to_spectrum(state.data), (start, stop)
            if dt is None:
                control = Control(self.tolerance, trial)
                done = advance_adaptive(split, spectrum, span, control, self.method)
                trial = done.next_step
            else:
                steps = max(1, math.ceil((stop - start) / dt * (1.0 - 1e-12)))
                done = advance_fixed(split, spectrum, span, steps, self.method)
            state.data[...] = np.fft.irfft(done.spectrum, n=points)
            self._note(done)
            return done.time

        return advance

    def _note(self, done: Advance) -> None:
        self.info["steps"] += done.steps
        self.info["rejected"] += done.rejected
        self.info["smallest_step"] = min(self.info["smallest_step"], done.smallest_step)
        self.info["largest_error"] = max(self.info["largest_error"], done.largest_error)
        self.info["status"] = done.status
        if done.status != "finished":
            raise ConvergenceError(f"{done.status} at t = {done.time:g} s after {self.info['steps']} steps")


def circle_points(grid: GridBase) -> tuple[int, float]:
    """Number of points and angle of the first, of a grid that goes round once."""
    if not (
        isinstance(grid, CartesianGrid)
        and grid.num_axes == 1
        and grid.periodic == [True]
        and math.isclose(grid.volume, 2.0 * math.pi)
    ):
        raise InputError("grid", grid, "one periodic axis of length 2 pi, as from `circle`")
    return int(grid.shape[0]), float(grid.axes_coords[0][0])
