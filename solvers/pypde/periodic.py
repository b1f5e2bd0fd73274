"""Motions of rotor and layers that repeat with the turn as a py-pde solver: Newton's method, no marching.

Importing this module registers the solver "periodic_newton".
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from pde.backends.base import BackendBase
from pde.solvers.base import ConvergenceError

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.pypde.coupled import CoupledSolver, RotorLayersPDE
from solvers.shooting import FixedPoint, Krylov, directions, fixed_point
from solvers.slices import step_budget

MARKS = 8  # times a turn on which steps land, and at which the layers are looked at
_TURNS = 60  # at most
_NEAR = 100.0  # times the tolerance, at which multipliers are looked at
_STIRRED = 0.1  # of other changes, beside those that a coarser mesh has for the slowest
_WAVES = 8  # of the layers' momentum, with which all small changes begin


@dataclass(frozen=True)
class PeriodicOrbit:
    """A motion that repeats with the turn, and what becomes of small changes of it."""

    point: Array  #: its numbers at the beginning of a turn, each over its size
    change: float  #: that is left, as `point`
    turns: int  #: what it took
    known: Krylov  #: the map of a turn about it, on this mesh or on a coarser one
    #: Floquet multipliers: by these a turn takes small changes on, the largest first; none without `judged`
    multipliers: Complex
    stable: bool | None = None  #: None where they do not tell


class PeriodicNewtonSolver(CoupledSolver):  # type: ignore[no-untyped-call]
    """Motion that repeats with the turn, by the name "periodic_newton" [theory: held, eq. 19-23].

    Over one turn of the drum a state comes back as the motion near it that repeats, stable or not: Newton's
    method on the map of the steps of "coupled". `info["orbit"]` is its `PeriodicOrbit`. `tolerance`
    is the change that is left, over the depth of the layers; `known`, the orbit on half the cells, takes the
    place of the state. Without `judged` no multipliers are looked for.
    """

    name = "periodic_newton"

    def __init__(
        self,
        pde: RotorLayersPDE,
        *,
        backend: str | BackendBase[Any] = "auto",
        courant: float = 0.8,
        tolerance: float = 1e-6,
        known: PeriodicOrbit | None = None,
        judged: bool = True,
    ) -> None:
        super().__init__(pde, backend=backend, courant=courant)
        if not 0.0 < tolerance < 1.0:
            raise InputError("tolerance", tolerance, "between 0 and 1")
        self.tolerance, self.known, self.judged = tolerance, known, judged or known is None

    def make_stepper(self, state: Any, dt: float | None = None) -> Any:
        """Function that puts the motion in place of a state; it takes no steps, `dt` must be None."""
        if dt is not None:
            raise InputError("dt", dt, "left out: there are no steps in time")
        self.equation.parts(state)
        self._select_backend(state)
        self.info |= {"dt": None, "dt_adaptive": False, "stochastic": False, "steps": 0}
        self.info |= {"courant": self.courant, "outcome": Outcome.DONE}
        turn = 2.0 * math.pi / self.equation.spin

        def advance(state: Any, start: float, stop: float) -> float:
            if abs(stop - start - turn) > 1e-9 * turn:
                raise InputError("t_range", (start, stop), f"one turn of the drum, {turn:g} s")
            turns = _Turns(self, state, start, stop)
            try:
                orbit = self._orbit(turns)
            except ConvergenceError as error:
                self.info["reason"] = str(error)
                raise
            finally:
                self.info["steps"] += turns.steps
            self.info["orbit"] = orbit
            turns.put(orbit.point, state.data)
            return stop

        return advance

    def _orbit(self, turns: _Turns) -> PeriodicOrbit:
        """The motion, from the state or from that on half the cells, and its multipliers."""
        half = self.known
        begin = turns.taken(turns.given.data) if half is None else turns.finer(half.point)
        known = None if half is None else half.known.moved(turns.finer)
        # Near enough for the derivative, which then leads there.
        at = self._near(turns, begin, self.tolerance * (_NEAR if known is None else 1.0), known)
        if not self.judged and known is not None:
            return PeriodicOrbit(at.point, at.change, turns.count, known, np.zeros(0, dtype=complex))
        way = turns.stirred() if known is None else known.leading() + _STIRRED * turns.stirred()
        found = directions(turns, turns.paced(at), way)
        if found.stable is not False and known is None:
            at = self._near(turns, at.point, self.tolerance, found)
        values, _ = found.multipliers
        return PeriodicOrbit(at.point, at.change, turns.count, known or found, values, found.stable)

    @staticmethod
    def _near(turns: _Turns, begin: Array, tolerance: float, known: Krylov | None) -> FixedPoint:
        at = fixed_point(turns, begin, tolerance, _TURNS, known)
        if not at.change <= tolerance:
            raise ConvergenceError(f"no motion that repeats within {at.turns} turns: {at.change:.1e} is left")
        return at


class _Turns:
    """The map of a turn, of the numbers of a state over their sizes."""

    def __init__(self, solver: CoupledSolver, state: Any, start: float, stop: float) -> None:
        self.solver, self.given, self.here = solver, state, state.copy()
        equation = solver.equation
        self.machine = equation.machine(state.grid.shape[0])
        self.machine.follow(0)
        self.start, self.stops = start, np.linspace(start, stop, MARKS + 1)[1:]
        self.most = step_budget(stop - start, equation.spin, state.grid.shape[0], solver.courant)
        self.count, self.steps = 0, 0
        self.layers, self.cells = int(equation.layers.sum()), state.grid.shape[0]
        #: pace and accelerations with which every turn begins; None: those with which the last one ended
        self.begin: tuple[Array, Array] | None = None
        # Layers by their energy; coordinates by what they move the walls.
        fills = [equation.fills[j] for j in np.flatnonzero(equation.layers).tolist()]
        area = np.array([0.5 * (fill.chamber.radius**2 - fill.surface_radius**2) for fill in fills])
        radius, spin = np.array([fill.chamber.radius for fill in fills]), equation.spin
        depth = min((fill.depth for fill in fills), default=1.0)
        reach = np.abs(self.machine.machine.planes).max(axis=(0, 1), initial=0.0)
        moved = depth / np.where(reach > 0.0, reach, 1.0)
        rows = np.concatenate([area, spin * area**1.5 * radius]) * math.sqrt(self.cells)
        self.sizes = np.concatenate([np.repeat(rows, self.cells), moved, spin * moved])

    def __call__(self, point: Array) -> Array:
        """The point after a turn."""
        self.put(point, self.here.data)
        if self.begin is not None:
            self.machine.state.pace[:], self.machine.state.push[:] = self.begin
        self.solver._load(self.machine, self.here, self.start)
        before = self.machine.sums.steps
        outcome, _ = self.machine.pass_by(self.stops, 0.0, self.solver.courant, self.most)
        self.count, self.steps = self.count + 1, self.steps + int(self.machine.sums.steps - before)
        if outcome is not Outcome.DONE:
            self.solver.info["outcome"] = outcome
            raise ConvergenceError(f"{outcome.message} in a turn")
        self.solver._store(self.machine, self.here)
        return self.taken(self.here.data)

    def taken(self, data: Array) -> Array:
        """The numbers of a state over their sizes."""
        rows = 2 * self.layers
        return np.asarray(np.concatenate([data[:rows].ravel(), data[rows:, 0]]) / self.sizes)

    def put(self, point: Array, data: Array) -> None:
        """Write a point into a state; areas below zero are cut, and the rest is scaled to the volume."""
        rows, values = 2 * self.layers, point * self.sizes
        data[:rows] = values[: rows * self.cells].reshape(rows, self.cells)
        data[rows:] = values[rows * self.cells :, None]
        area = data[: self.layers]
        if area.min(initial=0.0) < 0.0:
            whole = area.sum(axis=1, keepdims=True)
            np.maximum(area, 0.0, out=area)
            area *= whole / area.sum(axis=1, keepdims=True)

    def finer(self, point: Array) -> Array:
        """A point of half the cells on this mesh, on a straight line in each cell, which keeps its liquid."""
        rows = point[: self.layers * self.cells].reshape(2 * self.layers, -1)
        slope = 0.125 * (np.roll(rows, -1, axis=1) - np.roll(rows, 1, axis=1))
        halves = np.stack([rows - slope, rows + slope], axis=2) * math.sqrt(0.5)
        return np.concatenate([halves.ravel(), point[self.layers * self.cells :]])

    def stirred(self) -> Array:
        """Small changes of the rotor and of the flow by long waves: no liquid passes closed baffles."""
        dice = np.random.default_rng(0)
        angle = np.arange(self.cells) * 2.0 * math.pi / self.cells
        found = np.zeros(self.sizes.size)
        flow = found[self.layers * self.cells : 2 * self.layers * self.cells].reshape(self.layers, self.cells)
        for row in flow:
            for wave in range(_WAVES):
                size, phase = dice.standard_normal(2)
                row += size / (1.0 + wave) * np.cos(wave * angle + math.pi * phase) / math.sqrt(self.cells)
        rotor = found[2 * self.layers * self.cells :]
        rotor[:] = dice.standard_normal(rotor.size)
        return np.asarray(found / np.linalg.norm(found))

    def paced(self, at: FixedPoint) -> FixedPoint:
        """The same for differences of turns, whose steps all begin at the same pace from here on."""
        self.begin = self.machine.state.pace.copy(), self.machine.state.push.copy()
        return replace(at, image=self(at.point))
