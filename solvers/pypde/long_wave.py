"""The annular long waves as a py-pde equation, and their finite-volume stepper as a py-pde solver.

The right-hand side is the compiled one of `solvers.layer.finite_volume` behind py-pde's numpy backend: every
py-pde solver, tracker and storage works on it. Importing this module registers the solver "finite_volume".
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike
from pde.backends.base import BackendBase
from pde.fields.collection import FieldCollection
from pde.fields.scalar import ScalarField
from pde.grids.base import GridBase
from pde.grids.cartesian import CartesianGrid
from pde.solvers.base import ConvergenceError, SolverBase

from fluid import long_wave
from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.layer.records import LOADS, Outcome, records
from solvers.liquid_model import Whirl
from solvers.pypde import terms
from solvers.pypde.grid import CirclePDE
from solvers.pypde.terms import LongWaveTerms

_LOST = "the surface came to the axis, or a film outran the steps,"


class AnnularLongWavePDE(CirclePDE):  # type: ignore[no-untyped-call]
    """Nonlinear long waves on the wall of a whirling drum [theory: long_wave, eq. 1 and 4].

    The state is a collection of two scalar fields on a `circle` in the drum frame: "area", the liquid area
    per radian A, m^2, and "momentum", the relative angular momentum q = R u A - Omega A^2, m^4/s. Both are
    small numbers: absolute tolerances of py-pde's and scipy's steppers should be some 1e-6 of them.
    Parameters as of `solvers.pypde.terms.LongWaveTerms`.
    """

    def __init__(
        self,
        fill: Fill,
        whirl: Whirl,
        *,
        friction: Friction = NO_FRICTION,
        dispersion: bool = False,
        spin_rate: float = 0.0,
    ) -> None:
        super().__init__()
        self.terms = LongWaveTerms(fill, whirl, friction, dispersion, spin_rate)
        self.explicit_time_dependence = spin_rate != 0.0 or whirl.amplitude != 0.0 or whirl.gravity != 0.0

    def start(
        self, grid: GridBase, depth: ArrayLike | None = None, velocity: ArrayLike = 0.0, time: float = 0.0
    ) -> Any:
        """State from depth R - r_s, m, and velocity along the wall, relative to the drum, m/s.

        Each of shape (n,) or one number; depth None: the fill, uniform. The momentum is relative to the
        drum's spin at `time`.
        """
        n, fill = _cells(grid), self.terms.fill
        h = np.broadcast_to(np.asarray(fill.depth if depth is None else depth, dtype=float), (n,))
        u = np.broadcast_to(np.asarray(velocity, dtype=float), (n,))
        if not (np.isfinite(h).all() and h.min() >= 0.0):
            raise InputError("depth", float(h.min()), "finite numbers, 0 or above")
        if not np.isfinite(u).all():
            raise InputError("velocity", velocity, "finite numbers")
        area = terms.area_at(self.terms, np.minimum(h, fill.chamber.radius))
        momentum = terms.momentum_at(self.terms, area, u, time)
        terms.require_layer(self.terms, area, momentum)
        return _collection(grid, area, momentum)

    def surface_radius(self, state: Any) -> Array:
        """Free-surface radius r_s of each cell, m, shape (n,); beyond the wall in cells below zero."""
        return terms.surface_radius(self.terms, _parts(state)[0])

    def depth(self, state: Any) -> Array:
        """Depth R - r_s of each cell, m, shape (n,)."""
        return terms.depth(self.terms, _parts(state)[0])

    def velocity(self, state: Any, t: float) -> Array:
        """Velocity u along the wall relative to the drum, m/s, shape (n,); 0 where dry."""
        return terms.velocity(self.terms, *_parts(state), t)

    def offset(self, state: Any) -> complex:
        """Liquid's centre of mass from the drum's axis, m, in the drum frame, real along theta = 0."""
        return terms.liquid_offset(self.terms, _parts(state)[0])

    def force(self, state: Any, t: float) -> complex:
        """Force on the drum by the pressure on its wall, N, in the drum frame [theory: long_wave, eq. 7]."""
        return terms.pressure_force(self.terms, *_parts(state), t)

    def place(self, state: Any, t: float) -> terms.Place:
        """Offset in the frame of the deflection and its rate of change; nan where there is no layer."""
        return terms.place_at(self.terms, np.asarray(state.data[0]), np.asarray(state.data[1]), t)

    def loads(self, state: Any, t: float) -> Array:
        """Loads at one moment; over time they add up to those in the `info` of "finite_volume"."""
        return terms.loads_at(self.terms, *_parts(state), t)

    def means(self, loads: Array, length: float, places: tuple[terms.Place, terms.Place]) -> Complex:
        """Means over a time of loads added up, as from `solvers.pypde.terms.load_means`, shape (6,)."""
        return terms.load_means(self.terms, loads, length, places)

    def fastest(self, grid: GridBase) -> float:
        """Cells that the fastest wave on the layer at rest passes in a unit of time, 1/s."""
        surface = self.terms.fill.surface_radius / self.terms.fill.chamber.radius
        log = -math.log(surface)
        mean, half = long_wave.wave_celerity(0.0, log, self.terms.whirl.spin)
        return float(abs(mean) + half) * _cells(grid) / (2.0 * math.pi)

    @property
    def sizes(self) -> tuple[float, ...]:
        """A and |q| of the layer at rest in the drum, m^2 and m^4/s, to which tolerances are relative."""
        depth = np.array([self.terms.fill.depth])
        area = float(terms.area_at(self.terms, depth)[0])
        return area, self.terms.whirl.spin * area**2

    # Steps times `fastest`, by py-pde's names: half of what is stable, as waves grow faster; first order
    # needs short ones, and fixed points contract.
    steps: ClassVar[Mapping[str, float]] = {
        "runge-kutta": 0.5, "adams-bashforth": 0.1, "crank-nicolson": 0.25, "implicit": 0.1,
        "euler": 0.02, "explicit": 0.02,
    }  # fmt: skip

    def angular_momentum(self, state: Any, t: float) -> float:
        """Angular momentum of the liquid in space about the drum's axis, kg m^2/s."""
        return terms.angular_momentum(self.terms, *_parts(state), t)

    def evolution_rate(self, state: Any, t: float = 0.0) -> Any:
        """Right-hand side of the equation, for py-pde's own solvers; nan where the surface is at the axis.

        Wall friction is a source in it, stiff in thin films for all laws but the linear one. Their steps must
        resolve the waves, dt < dtheta/|lambda| [theory: long_wave, eq. 3], and beside a dry patch may leave
        cells a little below zero, which count as dry.
        """
        area, momentum = _parts(state)
        return _collection(state.grid, *terms.layer_rates(self.terms, area, momentum, t))

    def make_post_step_hook(self, state: Any, backend: str | BackendBase[Any] = "numpy") -> tuple[Any, Any]:
        """Check after each step of py-pde's own solvers that there is a layer still."""

        # By these names: some of py-pde's solvers pass them as keywords.
        def check(state_data: Any, t: float, post_step_data: Any) -> tuple[Any, Any]:
            if not terms.is_layer(self.terms, state_data[0], state_data[1]):
                raise ConvergenceError(f"{_LOST} at t = {t:g} s")
            return state_data, post_step_data

        return check, None

    def solve(
        self,
        state: Any,
        t_range: Any,
        dt: float | None = None,
        tracker: Any = "auto",
        *,
        solver: Any = "finite_volume",
        **options: Any,
    ) -> Any:
        """Solve as py-pde does, by the solver "finite_volume" unless another is named.

        py-pde's own default is left aside since its tolerance, 1e-4 m^2, is no smaller than a thin layer.
        """
        return super().solve(state, t_range, dt, tracker, solver=solver, **options)


class FiniteVolumeSolver(SolverBase):  # type: ignore[no-untyped-call]
    """The compiled finite volumes with their own time steps, by the name "finite_volume".

    Heun's method with steps by the Courant number (at most 0.9), cut to land on the times of trackers;
    friction in exact half steps; no cell falls below zero, no liquid is lost [theory: long_wave, eq. 11]. The
    spin must be constant; hooks after each step are not called. `info["loads"]` has the integrals of the
    loads over the time covered: see `solvers.pypde.terms.loads_at`.
    """

    name = "finite_volume"
    _use_post_step_hook = False

    def __init__(
        self,
        pde: AnnularLongWavePDE,
        *,
        backend: str | BackendBase[Any] = "auto",
        courant: float = 0.8,
    ) -> None:
        super().__init__(pde, backend="numpy" if backend == "auto" else backend)
        if getattr(type(pde), "evolution_rate", None) is not AnnularLongWavePDE.evolution_rate:
            raise InputError("pde", type(pde).__name__, "an AnnularLongWavePDE, its right-hand side as it is")
        if not 0.0 < courant <= 0.9:
            raise InputError("courant", courant, "above 0, at most 0.9")
        terms.require_constant_spin(pde.terms)
        self.terms, self.courant = pde.terms, courant

    def make_stepper(self, state: Any, dt: float | None = None) -> Any:
        """Function that advances a state over a time; `dt` must be None (steps by the Courant number)."""
        if dt is not None:
            raise InputError("dt", dt, "left out: `courant` sets the steps")
        _parts(state)
        self._select_backend(state)
        self.info |= {"dt": None, "dt_adaptive": True, "stochastic": False, "steps": 0}
        self.info |= {"courant": self.courant, "status": "finished"}
        loads = records(LOADS)
        marcher = terms.Marcher(self.terms, _cells(state.grid), self.courant, loads)
        self.info["loads"] = loads.view(np.float64)  # goes with what the march adds up

        def advance(state: Any, start: float, stop: float) -> float:
            outcome, steps = marcher.march(state.data, start, stop)
            if outcome is not Outcome.DONE:
                ran = outcome in (Outcome.RAN_OUT, Outcome.RAN_AWAY)
                self.info["status"] = "lost"
                self.info["reason"] = f"{outcome.message} ({steps} steps)" if ran else outcome.message
                raise ConvergenceError(f"{outcome.message} between t = {start:g} s and {stop:g} s")
            self.info["steps"] += steps
            return stop

        return advance


def _cells(grid: GridBase) -> int:
    """Number of cells of a grid as from `circle`."""
    if not (
        isinstance(grid, CartesianGrid)
        and grid.num_axes == 1
        and grid.periodic == [True]
        and grid.axes_bounds == ((0.0, 2.0 * math.pi),)
        and grid.shape[0] >= 8
    ):
        raise InputError("grid", grid, "one periodic axis from 0 to 2 pi, as from `circle`")
    return int(grid.shape[0])


def _parts(state: Any) -> tuple[Array, Array]:
    """A and q of a state."""
    fields = isinstance(state, FieldCollection) and all(isinstance(f, ScalarField) for f in state)
    if not (fields and len(state) == 2 and state.data.dtype == np.float64):
        raise InputError("state", type(state).__name__, 'two real scalar fields, "area" and "momentum"')
    _cells(state.grid)
    return state.data[0], state.data[1]


def _collection(grid: GridBase, area: Array, momentum: Array) -> Any:
    return FieldCollection(
        [ScalarField(grid, area, label="area"), ScalarField(grid, momentum, label="momentum")]
    )
