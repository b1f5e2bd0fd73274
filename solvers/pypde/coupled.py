"""A rotor with its long-wave layers as one py-pde equation, and the compiled coupled steps as its solver.

The layers are fields; each coordinate of the rotor and each of its rates is a field that is the same all
round. The spin is constant. Importing this module registers the solver "coupled".
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from pde.backends.base import BackendBase
from pde.fields.collection import FieldCollection
from pde.fields.scalar import ScalarField
from pde.grids.base import GridBase
from pde.solvers.base import ConvergenceError, SolverBase
from pde.trackers.base import FinishedSimulation, TrackerBase

from fluid import long_wave
from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, STOKES, WALL, Friction, damping_rate
from fluid.friction.wall import WallDrag, wall_shear
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.layer.baffles import FACE, OPEN, tables_of
from solvers.layer.finite_volume import DRY, GHOSTS, WORK, rates_of
from solvers.layer.inside import SLOT_SPEED, Inside
from solvers.layer.places import fewest_cells
from solvers.layer.records import Outcome
from solvers.layer.state import ring
from solvers.pypde.grid import CirclePDE, circle
from solvers.pypde.terms import faded_velocity
from solvers.rotor.system import RotorSystem
from solvers.runup.long_wave import Coupled, couple
from solvers.slices import step_budget

_ROUNDS, _AGREED = 60, 1e-13
_ROWS = 4096  # steps written down between two looks of Python


class RotorLayersPDE(CirclePDE):  # type: ignore[no-untyped-call]
    """Rotor and layers at a constant spin [theory: coupling, eq. 1-5].

    The state is a collection on a `circle`: "area" and "momentum" of each layer as of `AnnularLongWavePDE`,
    then the coordinates of the rotor by their names and their rates, uniform fields. At time 0 the drum's
    zero mark lies along the first direction; gravity, m/s^2, acts across the axis, against it. Liquid of a
    full chamber, or where no annular layer exists, is a mass; `layers` says which chambers hold a layer,
    None: those whose liquid rides with the drum. The laminar law takes the slower natural wave's frequency.
    """

    def __init__(
        self,
        system: RotorSystem,
        fills: Sequence[Fill],
        spin: float,
        *,
        friction: Friction = NO_FRICTION,
        gravity: float = 0.0,
        dispersion: bool = False,
        layers: Flags | None = None,
    ) -> None:
        super().__init__()
        self.system, self.fills, self.spin = system, tuple(fills), spin
        self.friction, self.gravity, self.dispersion = friction, gravity, dispersion
        fewest = fewest_cells(self.fills)
        self.layers = self.machine(fewest).active if layers is None else np.asarray(layers, dtype=bool)
        self.explicit_time_dependence = True
        self._still: dict[int, Coupled] = {}  # by the number of cells: what does not change with the state

    def machine(self, cells: int) -> Coupled:
        """Machine of the compiled steps at rest, with the annular layers of this spin."""
        given = (self.system, self.fills, self.spin, self.friction, self.gravity, cells, self.dispersion)
        found = couple(*given)
        if hasattr(self, "layers") and not np.array_equal(found.active, self.layers):
            found.capture = np.where(self.layers, 0.0, math.inf)
            found.switch()
        return found

    def start(
        self,
        cells: int,
        coordinates: Array | None = None,
        rate: Array | None = None,
        area: Array | None = None,
        momentum: Array | None = None,
    ) -> Any:
        """State of 8 or more cells round each wall, at rest and uniform where nothing is given.

        Coordinates and rates of the rotor have shape (n,), areas A, m^2, and momenta q, m^4/s, (l, cells).
        """
        n, fills = len(self.system.coordinates), [self.fills[j] for j in np.flatnonzero(self.layers).tolist()]
        tables_of(fills, cells)  # refuses compartments that the cells do not resolve
        each = [2.0 * math.pi * fill.chamber.height * fill.chamber.radius**2 for fill in fills]
        rest = np.array([fill.volume for fill in fills]) / each
        rest = np.repeat(rest.reshape(-1, 1), cells, axis=1)
        square = np.array([fill.chamber.radius**2 for fill in fills]).reshape(-1, 1)
        parts = [
            rest * square if area is None else area,
            -self.spin * np.square(rest) * np.square(square) if momentum is None else momentum,
        ]
        uniform = [np.zeros(n) if part is None else part for part in (coordinates, rate)]
        return self._collection(circle(cells), *parts, *uniform)

    def _collection(self, grid: GridBase, area: Array, momentum: Array, place: Array, rate: Array) -> Any:
        """State from its parts; places and rates of shape (n,)."""
        cells, names = grid.shape[0], self.system.coordinates
        which = np.flatnonzero(self.layers)
        fields = [ScalarField(grid, part, label=f"area {j}") for j, part in zip(which, area, strict=True)]
        fields += [
            ScalarField(grid, part, label=f"momentum {j}") for j, part in zip(which, momentum, strict=True)
        ]
        for values, label in ((place, "{}"), (rate, "rate of {}")):
            fields += [
                ScalarField(grid, np.full(cells, value), label=label.format(name))
                for name, value in zip(names, values, strict=True)
            ]
        return FieldCollection(fields)

    def parts(self, state: Any) -> tuple[Array, Array, Array, Array]:
        """Area and momentum of the layers, shape (l, c), coordinates and rates, shape (n,)."""
        n, count = len(self.system.coordinates), int(self.layers.sum())
        if not isinstance(state, FieldCollection) or len(state) != 2 * (n + count):
            allowed = f"{2 * count} fields of the layers and {2 * n} of the rotor, as from `start`"
            raise InputError("state", type(state).__name__, allowed)
        data = np.asarray(state.data, dtype=float)
        return data[:count], data[count : 2 * count], data[2 * count : -n, 0], data[-n:, 0]

    def evolution_rate(self, state: Any, t: float = 0.0) -> Any:
        """Right-hand side of the equation, for py-pde's own solvers.

        The force of a layer depends on the acceleration of its chamber: it is found by rounds of a linear
        equation with the inertia of the flow [theory: coupling, eq. 4].
        """
        area, _, place, rate = self.parts(state)
        machine, layers = self._resting(state), self._moving(state, t)
        system, turn = self.system, cmath.exp(1j * self.spin * t)
        mass, _, _, stiffness = machine.machine.matrices
        damping = system.damping + self.spin * system.gyroscopic
        push = (self.spin**2 * system.unbalance * turn).real - damping @ rate - stiffness @ place
        planes = machine.machine.planes
        left = mass + sum(
            (plane.T @ (layer.mass * np.eye(2) - layer.inertia) @ plane for layer, plane in
             zip(layers, planes, strict=True)), np.zeros_like(mass),
        )  # fmt: skip
        acceleration = np.zeros(place.size)
        for _ in range(_ROUNDS):
            right = push.copy()
            for layer, plane in zip(layers, planes, strict=True):
                seen = plane @ acceleration
                layer.accelerate(machine.machine.gravity - seen)
                right -= plane.T @ (layer.momentum_rate + layer.inertia @ seen)
            before, acceleration = acceleration, np.linalg.solve(left, right)
            if np.abs(acceleration - before).max() <= _AGREED * np.abs(acceleration).max():
                break
        d_area = np.array([layer.d_area for layer in layers]).reshape(area.shape)
        d_momentum = np.array([layer.d_momentum for layer in layers]).reshape(area.shape)
        return self._collection(state.grid, d_area, d_momentum, rate, acceleration)

    def _resting(self, state: Any) -> Coupled:
        """The machine with as many cells as a state has."""
        cells = int(state.data.shape[1])
        if cells not in self._still:
            self._still[cells] = self.machine(cells)
        return self._still[cells]

    def _moving(self, state: Any, t: float) -> list[_Layer]:
        """The layers of a state."""
        area, momentum, _, _ = self.parts(state)
        machine, pairs = self._resting(state), zip(area, momentum, strict=True)
        return [_Layer(machine, j, a, q, self.spin, self.spin * t) for j, (a, q) in enumerate(pairs)]

    # Steps times `fastest`, by py-pde's names: as for the layers alone, but for those with rounds of their
    # own beside the rounds of the coupling, and one that does not go through time.
    steps: ClassVar[Mapping[str, float]] = {
        "runge-kutta": 0.5, "adams-bashforth": 0.1, "euler": 0.02, "explicit": 0.02,
        "crank-nicolson": 0.0, "implicit": 0.0, "periodic_newton": 0.0,
    }  # fmt: skip

    def fastest(self, grid: GridBase) -> float:
        """Cells that the fastest wave on the layers at rest passes in a unit of time, 1/s; 0 without any."""
        found = 0.0
        for fill in (self.fills[j] for j in np.flatnonzero(self.layers).tolist()):
            log = math.log(fill.chamber.radius / fill.surface_radius)
            mean, half = long_wave.wave_celerity(0.0, log, self.spin)
            found = max(found, float(abs(mean) + half) * grid.shape[0] / (2.0 * math.pi))
        return found

    @property
    def sizes(self) -> tuple[float, ...]:
        """Size of each field, for tolerances: layers at rest, their least depth, that times the spin."""
        fills, n = [self.fills[j] for j in np.flatnonzero(self.layers).tolist()], len(self.system.coordinates)
        areas = [0.5 * (fill.chamber.radius**2 - fill.surface_radius**2) for fill in fills]
        depth = min((fill.depth for fill in fills), default=1.0)
        moving = [depth] * n + [depth * self.spin] * n
        return *areas, *(self.spin * area**2 for area in areas), *moving

    def row(self, state: Any, t: float) -> Array:
        """A moment as a row of `solvers.runup.state.State.trace`, shape (2 + n + 2 l,)."""
        moments = [layer.moment for layer in self._moving(state, t)]
        parts = [part for moment in moments for part in (moment.real, moment.imag)]
        return np.array([t, self.spin * t, *self.parts(state)[2], *parts])

    def deflection(self, state: Any) -> Complex:
        """Deflection of each chamber's axis in the standing frame, m, complex, shape (l,)."""
        place = self.parts(state)[2]
        return np.array([complex(*(self.system.at(fill.chamber.plane) @ place)) for fill in self.fills])


class _Layer:
    """A layer at one moment: its rates, and its momentum relative to its axis, under any acceleration.

    Lengths over R in the drum frame, but for `mass`, `inertia` and `momentum_rate`, which are in SI units in
    the standing frame.
    """

    def __init__(
        self, machine: Coupled, j: int, area: Array, momentum: Array, spin: float, angle: float
    ) -> None:
        layer = machine.machine.layers[j]
        known = machine.machine
        self.inside = Inside(known.plates[j], known.gaps[j], SLOT_SPEED**2)
        self.layer, self.spin, self.turn = layer, spin, cmath.exp(1j * angle)
        self.a = np.maximum(area / layer.radius**2, 0.0)
        self.q = momentum / layer.radius**4
        self.angles, self.mass = ring(area.size), float(layer.mass)
        self.u = faded_velocity(self.a, self.q, spin)
        self.surface, self.log = long_wave.free_surface_radius(self.a), long_wave.layer_log(self.a)
        self.across = self._across(self.surface * (self.angles[0] + 1j * self.angles[1]))
        self.inertia = self._flow_inertia()
        self.shear = self._shear(machine.machine.tables[j])
        self.d_area, self.d_momentum, self.momentum_rate = area, momentum, np.zeros(2)

    def _across(self, ray: Complex) -> Complex:
        """Half the difference of the two neighbours of each cell, where no closed baffle stands between."""
        faces = ray - np.roll(ray, 1)
        for row in self.inside.plates:
            if row[FACE] >= 0.0 and row[OPEN] == 0.0:
                faces[int(row[FACE])] = 0.0
        return np.asarray(0.5 * (faces + np.roll(faces, -1)))

    def _flow_inertia(self) -> Array:
        """Inertia of the flow under a body force, standing frame, kg, (2, 2) [theory: coupling, eq. 4]."""
        step = 2.0 * math.pi / self.a.size
        seen = self.across * self.turn
        parts = np.stack([seen.real, seen.imag])
        scale = self.layer.weight * self.layer.radius**2
        found: Array = scale * (parts * self.log) @ parts.T / step
        return found

    @property
    def moment(self) -> complex:
        """First moment of the layer over R^3, drum frame."""
        r, rays = self.surface, self.angles[0] + 1j * self.angles[1]
        return complex(np.sum((1.0 - r) * (1.0 + r + r * r) / 3.0 * rays) * 2.0 * math.pi / self.a.size)

    def _shear(self, table: Array) -> Array:
        """Rate at which friction takes q [theory: long_wave, eq. 9]."""
        layer, coefficient = self.layer, float(self.layer.coefficient)
        if layer.law in (STOKES, WALL):
            coefficient *= math.sqrt(self.spin)
        lost: Array = np.zeros(self.a.size)
        wet = self.a > DRY
        a, u = self.a[wet], self.u[wet]
        depth = 2.0 * a / (1.0 + self.surface[wet])
        if layer.law == WALL:
            thin = float(layer.thin) / math.sqrt(self.spin)
            known = float(layer.plates), float(layer.lid), thin, float(layer.top), table
            lost[wet] = wall_shear(WallDrag(coefficient, *known), depth, a, u)
            return lost
        lost[wet] = damping_rate(int(layer.law), coefficient, float(layer.lid), depth, a, u) * a * u
        return lost

    def accelerate(self, push: Array) -> None:
        """Take a body force, m/s^2, standing frame, shape (2,): minus the acceleration, and gravity."""
        n, spin, layer = self.a.size, self.spin, self.layer
        force = complex(*push) / layer.radius / self.turn
        cell, face = (
            force.real * self.angles[k] + force.imag * self.angles[k + 1] for k in (0, 2)
        )  # fmt: skip
        d_a, d_q, work = np.zeros(n), np.zeros(n), np.zeros((WORK, n + 2 * GHOSTS))
        none, step = np.empty(0), 2.0 * math.pi / n
        still = self.a, self.q, none, spin, 0.0, cell, face, *self.inside, step, 0.0
        going = rates_of(self.inside.plates, bool(layer.dispersion), False)
        going(*still, layer.dispersion, work, d_a, d_q, none)
        d_q -= self.shear
        self.d_area, self.d_momentum = d_a * layer.radius**2, d_q * layer.radius**4
        self.momentum_rate = self._momentum_rate(d_a, d_q)

    def _momentum_rate(self, d_a: Array, d_q: Array) -> Array:
        """Rate of change of the momentum relative to the axis, N, standing frame."""
        wet = self.a > DRY
        d_u = np.divide(
            d_q - self.q * d_a / np.where(wet, self.a, 1.0), self.a, where=wet, out=np.zeros_like(d_a)
        )
        d_u += np.where(wet, self.spin * d_a, 0.0)
        d_flow = d_u * self.log + self.u * d_a / np.square(self.surface)
        rays = self.angles[0] + 1j * self.angles[1]
        across, d_across = self._across(self.surface * rays), self._across(-d_a / self.surface * rays)
        step = 2.0 * math.pi / self.a.size
        d_flowing = np.sum(d_flow * across + self.u * self.log * d_across)
        d_moment = np.sum(self.surface * d_a * rays) * step
        flowing = np.sum(self.u * self.log * across)
        relative, changed = flowing + 1j * self.spin * self.moment, d_flowing + 1j * self.spin * d_moment
        found = (changed + 1j * self.spin * relative) * self.turn * self.layer.weight * self.layer.radius**3
        return np.array([found.real, found.imag])


class CoupledSolver(SolverBase):  # type: ignore[no-untyped-call]
    """The compiled coupled steps of the run-up, by the name "coupled" [theory: coupling, eq. 5].

    Steps by the Courant number (at most 0.9), cut to land on the times of trackers; hooks after each step
    are not called. With `follow` they land on so many times in each stretch, its end the last:
    `info["marks"]` are the layers' areas there, m^2, (follow, l, c), and `info["followed"]` holds what every
    step has left: see `solvers.runup.state.State.trace`.
    """

    name = "coupled"
    _use_post_step_hook = False

    def __init__(
        self,
        pde: RotorLayersPDE,
        *,
        backend: str | BackendBase[Any] = "auto",
        courant: float = 0.8,
        follow: int = 0,
    ) -> None:
        super().__init__(pde, backend="numpy" if backend == "auto" else backend)
        if not isinstance(pde, RotorLayersPDE):
            raise InputError("pde", type(pde).__name__, "a RotorLayersPDE")
        if not 0.0 < courant <= 0.9:
            raise InputError("courant", courant, "above 0, at most 0.9")
        self.equation, self.courant, self.follow = pde, courant, follow

    def make_stepper(self, state: Any, dt: float | None = None) -> Any:
        """Function that advances a state over a time; `dt` must be None (steps by the Courant number)."""
        if dt is not None:
            raise InputError("dt", dt, "left out: `courant` sets the steps")
        self.equation.parts(state)
        self._select_backend(state)
        self.info |= {"dt": None, "dt_adaptive": True, "stochastic": False, "steps": 0}
        self.info |= {"courant": self.courant, "outcome": Outcome.DONE, "followed": None}
        machine = self.equation.machine(state.grid.shape[0])
        self.info["balance"] = np.zeros(machine.works().size + 1)
        machine.follow(_ROWS if self.follow else 0)
        left: Array | None = None
        begun = 0.0

        def advance(state: Any, start: float, stop: float) -> float:
            nonlocal left, begun
            # Where nobody has touched the state the steps go on as if there had been no stop.
            if left is None or not np.array_equal(left, state.data):
                self._load(machine, state, start)
                begun = machine.energy()
            steps, before = machine.sums.steps, machine.works()
            most = step_budget(stop - machine.time, machine.spin, machine.theta.size, self.courant)
            stops = np.linspace(machine.time, stop, max(self.follow, 1) + 1)[1:]
            outcome, marks = machine.pass_by(stops, 0.0, self.courant, most)
            self.info["outcome"] = outcome
            if outcome is not Outcome.DONE:
                self._store(machine, state)  # where the steps end
                raise ConvergenceError(f"{outcome.message} between t = {start:g} s and {stop:g} s")
            self._store(machine, state)
            left = state.data.copy()
            self.info["steps"] += int(machine.sums.steps - steps)
            if self.follow:
                square = np.square(machine.machine.layers.radius)[:, None]
                self.info |= {"followed": machine.followed(), "marks": marks * square}
            done, energy = machine.works() - before, machine.energy()
            self.info["balance"] = self.info["balance"] + np.append(done, energy - begun)
            begun = energy
            return stop

        return advance

    def _load(self, machine: Coupled, state: Any, time: float) -> None:
        """Take a state into the machine."""
        area, momentum, place, rate = self.equation.parts(state)
        square = np.square(machine.machine.layers.radius)[:, None]
        machine.state.area[:], machine.state.momentum[:] = area / square, momentum / np.square(square)
        machine.state.place[:], machine.state.rate[:] = place, rate
        machine.shaft.time, machine.shaft.angle = time, self.equation.spin * time

    def _store(self, machine: Coupled, state: Any) -> None:
        """Give the machine's moment to a state."""
        area, momentum, _, _ = self.equation.parts(state)
        square = np.square(machine.machine.layers.radius)[:, None]
        area[:], momentum[:] = machine.state.area * square, machine.state.momentum * np.square(square)
        n = machine.state.place.size
        state.data[-2 * n : -n] = machine.state.place[:, None]
        state.data[-n:] = machine.state.rate[:, None]


def run(
    equation: RotorLayersPDE,
    state: Any,
    stretch: tuple[float, float],
    trackers: Sequence[Any],
    **options: Any,
) -> tuple[Any, Outcome]:
    """Solve as py-pde does over a stretch of time; steps that fail are an outcome, Ctrl-C is let through."""
    try:
        state = equation.solve(state, stretch, tracker=list(trackers), **options)
    except RuntimeError:  # py-pde's solvers have no other
        failed = equation.diagnostics["solver"].get("outcome", Outcome.TOO_LONG)
        return equation.diagnostics.get("last_state", state), failed
    return state, Outcome.DONE


class TurnTracker(TrackerBase):  # type: ignore[no-untyped-call]
    """Tracker that hands the steps of each turn to `enough`, until that is true.

    `enough` takes the steps of a turn (rows of `solvers.runup.state.State.trace`), the layers at its marks
    (areas A, m^2, shape (k, l, c)) and the state at its end, which it may change. The solver "coupled" with
    `follow` gives every step and its marks, others the moments at which this is called, `stops` times a
    turn. `balances` are works and heats
    of each turn as `solvers.runup.state.WORKS`, and last the energy that rotor and liquid gain, J; empty
    where the solver does not give them.
    """

    def __init__(
        self,
        equation: RotorLayersPDE,
        turn: float,
        enough: Callable[[Array, Array, Any], bool],
        stops: int = 1,
    ) -> None:
        super().__init__(interrupts=turn / stops)
        self.equation, self.enough, self.stops = equation, enough, stops
        self.steps: list[Array] = []
        self.layers: list[Array] = []
        self.balances: list[Array] = []
        self._balance: Array | float = 0.0

    def initialize(self, field: Any, info: dict[str, Any] | None = None) -> float:
        """Keep the solver's `info`."""
        self.info: dict[str, Any] = {} if info is None else info
        return super().initialize(field, info)

    def handle(self, field: Any, t: float) -> None:
        """Take the steps since the last call."""
        told = self.info["solver"]
        steps = told["followed"] if "followed" in told else self.equation.row(field, t)[None, :]
        if steps is None or t == 0.0:
            return
        self.steps.append(steps)
        self.layers.append(told["marks"] if "marks" in told else self.equation.parts(field)[0][None].copy())
        if len(self.layers) < self.stops:
            return
        if "balance" in told:
            self.balances.append(told["balance"] - self._balance)
            self._balance = told["balance"]
        turn, layers = np.concatenate(self.steps), np.concatenate(self.layers)
        self.steps, self.layers = [], []
        if self.enough(turn, layers, field):
            raise FinishedSimulation("settled")
