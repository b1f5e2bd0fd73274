"""A layer under a prescribed whirl whose wave stands in the whirl's frame, by finite volumes in time.

When the whirl has turned by one cell, at the slip as seen from the drum, the layer is as it was, but one cell
further on: a fixed point of that short map is the steady wave, with its bores and dry cells. Mass and angular
momentum are kept, so that the wave's force and the wall's torque agree to rounding. Lengths over R, times
over 1/Omega [theory: whirl, eq. 21-23].
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw, layer_thickness, plate_factor
from fluid.friction.pipe import hydraulic_diameter
from fluid.friction.wall import drag_table
from meshes.arrays import Array, Complex
from solvers.layer.inside import NOTHING
from solvers.layer.records import LOADS, PACE, Drive, Outcome, Wall, records
from solvers.layer.state import ring
from solvers.slices import compiled, step_budget

# Courant numbers. Small disturbances of a limited wave grow cell by cell in longer steps than the first.
_COURANT = 0.5
# Of the equal steps of a cell's time, which are no longer than this: no step is cut where none need be.
_LONGEST = 1.09
_STEP = 1e-8  # of the mean area and of what drives the layer, in differences of the map
_LEAST = 1e-7  # of the radius: smaller deflections are answered as this one, the limit of a small whirl
_SLOWEST = 1e-3  # of the spin: a wave that turns more slowly in the drum is none
_SETTLED = 2e-5  # change of G from period to period
_MEANS = ((1, 40), (4, 10), (12, 10))  # periods a mean is taken over, and how many such means are tried


class Whirling(NamedTuple):
    """What drives a layer."""

    ratio: float  #: r = omega_w/Omega
    size: float  #: w = W/R
    #: of the friction, as `fluid.friction.laws.damping_rate` takes it, over Omega if it is a rate; under the
    #: law of the wall 1/Omega, s, with which all of the law changes
    drag: float


class Answer(NamedTuple):
    """A layer after some time."""

    state: Array  #: area and momentum of the cells, shape (2 n,)
    force: complex  #: G, mean over that time
    turning: float  #: mean rotation of the liquid relative to the drum, over Omega


@dataclass(frozen=True)
class Derivatives:
    """Derivatives of the map over the time of one cell at a state, the states having 2 n components."""

    state: Array  #: of the state after it, shape (2 n, 2 n)
    given: Array  #: by ratio, size and drag, shape (2 n, 3)
    force: Complex  #: of G by the state, shape (2 n,)
    force_given: Complex  #: and by ratio, size and drag, shape (3,)


class LayerWave(ABC):
    """A layer whose wave stands in the whirl's frame, by any equations, as a branch asks it."""

    mean: float  #: area at rest, A0 over R^2
    state: Array  #: the present one

    def __init__(self, fill: Fill, friction: Friction, cells: int) -> None:
        self.fill, self.friction, self.cells = fill, friction, cells

    def drag(self, spin: float, whirl_speed: float) -> float:
        """Coefficient of the friction, over the spin if it is a rate; both speeds in rad/s."""
        slip, radius = whirl_speed - spin, self.fill.chamber.radius
        if self.friction.law is FrictionLaw.WALL:
            return 1.0 / spin
        _, found = self.friction.at(self.fill.liquid.viscosity, slip, radius)
        return found if self.friction.law is FrictionLaw.QUADRATIC else found / spin

    @abstractmethod
    def lag(self, share: float) -> None:
        """Start anew with a uniform layer that lags behind the drum by a share of its spin."""

    @abstractmethod
    def thinnest(self, state: Array) -> float:
        """Least area over the mean."""

    @abstractmethod
    def kept(self, state: Array) -> Array:
        """A state that a layer can have, next to one that a step of Newton's method led to."""

    @abstractmethod
    def closed(self, step: Array) -> Array:
        """Derivative of the map less the state, from that of the map, each equation saying something."""

    @abstractmethod
    def period(self, given: Whirling) -> Answer | None:
        """Go on towards the standing wave of a prescribed whirl; None where the layer breaks down."""

    @abstractmethod
    def cell(self, state: Array, given: Whirling) -> Answer | None:
        """A state after the map whose fixed point is the standing wave; None where the layer breaks down."""

    @abstractmethod
    def linearise(self, given: Whirling) -> Derivatives | None:
        """Derivatives of the map at the present state; None where the layer breaks down."""


class StandingWave(LayerWave):
    """A layer on its way to a standing wave."""

    def __init__(self, fill: Fill, friction: Friction, cells: int) -> None:
        from solvers.layer.step import scratch

        super().__init__(fill, friction, cells)
        chamber = fill.chamber
        self.mean = fill.volume / (2.0 * math.pi * chamber.height * chamber.radius**2)
        self._lid = 2.0 * chamber.radius / chamber.height if friction.law.laminar else 0.0
        self._table: tuple[float, Array] | None = None
        if friction.law is FrictionLaw.WALL:
            diameter = float(hydraulic_diameter(fill.depth, chamber.height))
            self._table = drag_table(diameter, fill.liquid.viscosity, friction.roughness)
        self._step, self._angles, self._scratch = 2.0 * math.pi / cells, ring(cells), scratch(cells)
        self._parts, self._fastest = 1, 0.0
        # Where each cell comes from when a layer is moved by one.
        self._back = {way: np.roll(np.arange(cells), way) for way in (-1, 1)}
        area = np.full(cells, self.mean)
        self.state = np.concatenate([area, -np.square(area)])

    def thinnest(self, state: Array) -> float:
        """See `LayerWave`; 0 where the wall is dry."""
        return max(float(state[: self.cells].min()) / self.mean, 0.0)

    def lag(self, share: float) -> None:
        """See `LayerWave`."""
        area = np.full(self.cells, self.mean)
        velocity = -share * math.sqrt(1.0 - 2.0 * self.mean)
        self.state = np.concatenate([area, velocity * area - np.square(area)])

    def period(self, given: Whirling) -> Answer | None:
        """See `LayerWave`; for one turn of the whirl in the drum."""
        state = self.state.copy()
        found = self._advance(state, given, 2.0 * math.pi / abs(given.ratio - 1.0))
        if found is not None:
            self.state = found.state
        return found

    def settle(self, given: Whirling) -> Answer | None:
        """Go on until G stays; None where it does not, or where the layer breaks down.

        One period is compared with the next, later means of 4 and of 12.
        """
        for length, tries in _MEANS:
            last = complex(math.inf)
            for _ in range(tries):
                found = [self.period(given) for _ in range(length)]
                if any(part is None for part in found):
                    return None
                parts = [part for part in found if part is not None]
                mean = sum(part.force for part in parts) / length
                if abs(mean - last) < _SETTLED:
                    turning = sum(part.turning for part in parts) / length
                    return Answer(self.state, mean, turning)
                last = mean
        return None

    def cell(self, state: Array, given: Whirling, turned: float = 0.0) -> Answer | None:
        """A state after the time of one cell, moved back by it; None where the layer breaks down.

        The forcing is ahead of the state's frame by `turned`, rad.
        """
        slip = given.ratio - 1.0
        if not abs(slip) > _SLOWEST:
            return None
        time = self._step / abs(slip)
        found = self._all_through(state.reshape(1, -1), given, time, turned / slip)
        if found is None:
            return None
        states, forces, loads = found
        return Answer(states[0], complex(forces[0]), float(loads["turning"][0]) / time)

    def linearise(self, given: Whirling) -> Derivatives | None:
        """See `LayerWave`."""
        slip, size = given.ratio - 1.0, 2 * self.cells
        if not abs(slip) > _SLOWEST:
            return None
        time = self._step / abs(slip)
        # How many steps it takes: their number stays while the state changes, which keeps the map smooth.
        if self._advance(self.state.copy(), given, time) is None:
            return None
        self._parts = max(1, math.ceil(self._fastest * time / (_COURANT * self._step)))
        base = self.cell(self.state, given)
        if base is None:
            return None
        step = _STEP * self.mean
        moved = self.state + step * np.eye(size)
        found = self._all_through(moved, given, time)
        if found is None:
            return None
        states, forces, _ = found
        by_state = (states - base.state).T / step
        force = (forces - base.force) / step
        by_given, force_given = np.empty((size, 3)), np.empty(3, dtype=complex)
        for k, value in enumerate(given):
            step = _STEP * (abs(value) or 1.0)
            ahead = self.cell(self.state, given._replace(**{given._fields[k]: value + step}))
            if ahead is None:
                return None
            by_given[:, k] = (ahead.state - base.state) / step
            force_given[k] = (ahead.force - base.force) / step
        return Derivatives(by_state, by_given, force, force_given)

    def _all_through(
        self, moved: Array, given: Whirling, time: float, start: float = 0.0
    ) -> tuple[Array, Complex, Any] | None:
        """States, shape (m, 2 n), after the time of a cell, moved back by it, with G and loads of each.

        None where one breaks down.
        """
        from solvers.cycles.stretch import ADVANCE_EACH, advance_each
        from solvers.layer.step import stepper
        from solvers.machine_code import entry

        n = self.cells
        areas, momenta = moved[:, :n].copy(), moved[:, n:].copy()
        loads: Any = np.zeros(len(moved), LOADS)
        drive, wall, most = self._posed(given, time, _LONGEST)
        done = compiled(
            *(
                entry(advance_each, *ADVANCE_EACH),
                *stepper(wall, NOTHING, False)[1:],
                areas,
                momenta,
                records(PACE),
                start,
                time,
                self._parts,
                drive,
                wall,
            ),
            *(self._angles, NOTHING, _LONGEST, most, self._scratch, loads.view(np.recarray)),
        )
        if not done:
            return None
        states, way = np.empty_like(moved), 1 if given.ratio < 1.0 else -1
        for first, part in ((0, areas), (n, momenta)):
            states[:, first : first + n] = part[:, self._back[way]]
        offset = (loads["offset_x"] + 1j * loads["offset_y"]) / time
        return states, self._force(offset, drive.amplitude), loads

    def closed(self, step: Array) -> Array:
        """See `LayerWave`: the map keeps the volume, and that it stays takes that equation's place."""
        matrix, n = step - np.eye(2 * self.cells), self.cells
        matrix[:n, :n] += 1.0 / n
        return np.asarray(matrix)

    def kept(self, state: Array) -> Array:
        """A state without areas below nothing, of the layer's volume."""
        area = np.maximum(state[: self.cells], 0.0)
        return np.concatenate([area * (self.mean / area.mean()), state[self.cells :]])

    def _advance(self, state: Array, given: Whirling, time: float) -> Answer | None:
        """Advance a state, in place, in as long steps as it allows."""
        from solvers.layer.step import stepper

        n, pace, loads = self.cells, records(PACE), records(LOADS)
        drive, wall, most = self._posed(given, time, _COURANT)
        outcome, _ = compiled(
            *(
                *stepper(wall, NOTHING, False),
                state[:n],
                state[n:],
                np.empty(0),
                pace,
                time,
                drive,
                wall,
                self._angles,
            ),
            *(NOTHING, _COURANT, most, self._scratch, loads),
        )
        if outcome != Outcome.DONE:
            return None
        self._fastest = float(pace[0].fastest)
        sums = loads[0]
        offset = complex(sums.offset_x, sums.offset_y) / time
        return Answer(state, complex(self._force(offset, drive.amplitude)), float(sums.turning) / time)

    def _posed(self, given: Whirling, time: float, courant: float) -> tuple[Drive, Wall, int]:
        """Drive, wall, and most steps through a time."""
        drive = Drive(max(given.size, _LEAST), given.ratio - 1.0, 0.0, given.ratio, 0.0, 1.0)
        wall = self._wall(given)
        return drive, wall, step_budget(time, 1.0, self.cells, courant)

    def _wall(self, given: Whirling) -> Wall:
        """What the steps know of the wall, rates over the spin."""
        if self._table is None:
            return Wall(self.friction.law.number, max(given.drag, 0.0), self._lid, False)
        spin, radius = 1.0 / given.drag, self.fill.chamber.radius
        slip, (top, table) = (given.ratio - 1.0) * spin, self._table
        law, coefficient = self.friction.at(self.fill.liquid.viscosity, slip, radius)
        thin = float(layer_thickness(self.fill.liquid.viscosity, slip)) / radius
        plates = self._lid * plate_factor(slip, spin)
        rates = coefficient / spin, self._lid, False, plates, thin, top / (radius * spin)
        return Wall(law, *rates, table)

    def _force(self, offset: Any, amplitude: float) -> Any:
        """G by Newton's law for all liquid, of which the mean area is half the share of a full drum's."""
        return 2.0 * self.mean * (1.0 + offset / amplitude)
