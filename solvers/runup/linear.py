"""A rotor with linear layers, the cheap model of a run-up [theory: coupling, eq. 11-13]."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.baffles import baffle_torque
from fluid.friction.laws import Friction, damping_rate
from fluid.whirl import is_full, layer_rate, plane_layer, slower_slip
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.layer.records import Outcome, records
from solvers.layer.state import ring
from solvers.rotor.system import RotorSystem
from solvers.runup.balls import NO_BALLS, Balls, ball_records, balls_energy, balls_inertia, race_planes
from solvers.runup.machine import Handover, Reading, Transfer
from solvers.runup.state import (
    CREST,
    LINEAR_LAYER,
    SUMS,
    CoupledRotor,
    LinearMachine,
    at_rest,
    layer_drag,
    layer_properties,
    mean_area,
    wall_tables,
)
from solvers.slices import compiled, slices

_LAGS = 129  # of the curves of smeared baffles


@dataclass
class LinearCoupled(CoupledRotor):
    """A rotor with linear layers at one moment, a `solvers.runup.machine.RunupMachine`."""

    cells: int  #: the rotor turns in a step by a cell times the Courant number
    machine: LinearMachine  #: matrices, state and scratch of the steps
    rows: int = 0  #: above 0 where the steps are written down
    kept: list[Array] = field(default_factory=list)  #: those written down since `followed` was asked last

    @property
    def sloshing(self) -> slice:
        """Rows of the layers among `place` and `rate`, two each."""
        n = len(self.system.coordinates)
        return slice(n, n + 2 * len(self.fills))

    @property
    def rolling(self) -> slice:
        """Rows of the balls among `place` and `rate`."""
        return slice(self.sloshing.stop, None)

    @property
    def theta(self) -> Array:
        """Angle of the cells' middles from the drum's zero mark, rad, shape (c,)."""
        angles = ring(self.cells)
        return np.asarray(np.arctan2(angles[1], angles[0]))

    def advance(self, stop: float, rate: float, courant: float, most: int) -> Outcome:
        """Advance to a time while the spin changes at a rate, in at most so many steps."""
        self.shaft.rate = rate
        angle_step, outcome = courant * (2.0 * math.pi / self.cells), Outcome.RAN_OUT
        # A step at a time where each is written down: it costs little beside what a step of waves does.
        for steps in slices(most, self.machine.left.size, 1 if self.rows else 0):
            outcome = Outcome(compiled(*self.steps, *self.machine, stop, angle_step, steps))
            if self.rows:
                place = self.machine.place[: len(self.system.coordinates)]
                self.kept.append(np.array([self.time, self.shaft.angle, *place]))
            if outcome is not Outcome.RAN_OUT:
                break
        return outcome

    def through(
        self,
        stops: Array,
        rates: Array,
        courant: float,
        most: int,
        progress: Callable[[float], object],
    ) -> None:
        """None: its legs, which cost little, are gone one by one."""

    @cached_property
    def steps(self) -> tuple[Any, ...]:
        """The compiled steps and the part of them that this machine has, handed over."""
        from solvers.machine_code import entry
        from solvers.runup.steps.balls import balls_of
        from solvers.runup.steps.linear import ADVANCE_LINEAR, advance_linear

        return entry(advance_linear, *ADVANCE_LINEAR), *balls_of(self.machine.balls.size)

    def follow(self, rows: int) -> None:
        """See `solvers.runup.long_wave.Coupled.follow`."""
        self.rows, self.kept = rows, []

    def followed(self) -> Array:
        """Time, angle and coordinates of the steps since this was asked last, shape (k, 2 + n)."""
        found = np.array(self.kept).reshape(-1, 2 + len(self.system.coordinates))
        self.kept = []
        return found

    def mass_error(self) -> float:
        """Always 0: the layer keeps its mass by construction."""
        return 0.0

    @property
    def velocity(self) -> Array:
        """Rates of change of the rotor's coordinates, shape (n,)."""
        return np.asarray(self.machine.rate[: len(self.system.coordinates)])

    def energy(self) -> float:
        """Energy of rotor and layers, J [theory: coupling, eq. 12]."""
        m, n = self.machine, len(self.system.coordinates)
        q, v = m.place[:n], m.rate[:n]
        total = 0.5 * (v @ m.matrices[0] @ v + q @ m.matrices[3] @ q)
        for j, layer in enumerate(m.layers):
            axis, row = m.planes[j] @ v, slice(n + 2 * j, n + 2 * j + 2)
            total += 0.5 * layer.mass * axis @ axis
            if not m.active[j]:
                continue
            d, rate, kappa = m.place[row], m.rate[row], layer.curvature
            total += layer.mass * (axis @ rate + 0.5 * (1.0 + kappa) * rate @ rate)
            total += 0.5 * layer.inertia * m.carried[j] ** 2 - layer.mass * kappa * m.carried[j] ** 2 * d @ d
        roll, roll_rate = m.place[self.rolling], m.rate[self.rolling]
        return float(total + balls_energy(m.balls, m.races, v, roll, roll_rate, self.spin))

    def switch(self) -> float:
        """Catch and let go liquid as `solvers.runup.long_wave.Coupled.switch`; energy brought in, J."""
        m, n, active = self.machine, len(self.system.coordinates), self.machine.active > 0.0
        own, wanted = m.carried * active, self.ridden(active)
        anew = wanted != active
        if not anew.any():
            return 0.0
        before, lost, offset = self.energy(), np.zeros(n), self._offset()
        whole = m.matrices[0] + sum(a * b.T @ b for a, b in zip(self.masses, m.planes, strict=True))
        for j in np.flatnonzero(anew).tolist():
            row = slice(n + 2 * j, n + 2 * j + 2)
            lost += m.planes[j].T @ self._momentum(j)
            m.place[row], m.rate[row], m.active[j] = 0.0, 0.0, wanted[j]
            m.carried[j] = self.spin
        # What else moves keeps its momentum: the offsets' rates act on the rotor through their masses.
        inertia, along = balls_inertia(m.balls, m.races, m.place[self.rolling])
        jump = np.linalg.solve(whole + inertia, lost)
        m.rate[:n] += jump
        m.rate[self.rolling] -= along @ jump
        after, now = self.energy(), m.carried * m.active
        rise = (self._offset() - offset).real * abs(float(self.gravity[0])) * self.masses
        for j in np.flatnonzero(anew).tolist():
            turning = float(own[j] * self.spread_inertia[j]), float(now[j] * self.spread_inertia[j])
            there = bool(wanted[j])
            self.transfers.append(
                Transfer(j, there, self.time, self.spin, turning, (before, after), float(rise[j]))
            )
        return after - before

    def _momentum(self, j: int) -> Array:
        """Momentum of a liquid relative to its chamber's axis, standing frame, kg m/s, shape (2,)."""
        m, row = self.machine, len(self.system.coordinates) + 2 * j
        return np.asarray(self.masses[j] * m.rate[row : row + 2] * m.active[j])

    def fall(self, outcome: Outcome) -> None:
        """Always None: small waves do not fall."""

    def read(self) -> Reading:
        """The moment as the history keeps it."""
        m, n = self.machine, len(self.system.coordinates)
        q, active = m.place[:n].copy(), m.active > 0.0
        deflection = np.array([complex(*(plane @ q)) for plane in self.seen])
        offset = self._offset()
        depth = np.array([fill.depth for fill in self.fills])
        rise = (m.layers.curvature - 1.0) * np.abs(offset)
        nothing = np.full(len(self.fills), np.nan)
        return Reading(
            time=self.time,
            speed=self.spin,
            angle=float(self.shaft.angle),
            coordinates=q,
            deflection=deflection,
            **self.largest(abs(deflection[0])),
            offset=offset,
            captured=active,
            depth_min=np.where(active, depth - rise, nothing),
            depth_max=np.where(active, depth + rise, nothing),
            mean_rotation=np.where(active, m.carried - self.spin, 0.0),
            wet_share=np.where(active, 1.0, self.resting_wet),
            lifted_share=np.where(active, 0.5, 0.0),
            ball_angle=m.place[self.rolling] - self.shaft.angle,
            ball_speed=m.rate[self.rolling].copy(),
        )

    def depth(self) -> Array:
        """Depth of the layers at as many angles as cells, m, nan where the liquid is none, shape (l, c)."""
        m = self.machine
        offset = self._offset() * np.exp(-1j * self.shaft.angle)
        depth = np.array([fill.depth for fill in self.fills])[:, None]
        wave = np.real(offset[:, None] * np.exp(-1j * self.theta))
        rise = (m.layers.curvature - 1.0)[:, None] * wave
        return np.where(m.active[:, None] > 0.0, depth + rise, np.nan)

    def _offset(self) -> Complex:
        """Offset of each liquid's centre of mass from its chamber's axis, standing frame, complex, m."""
        m, active = self.machine, self.machine.active > 0.0
        first, second = m.place[self.sloshing].reshape(-1, 2).T
        return np.where(active, first + 1j * second, self.pool_offset)


def couple_linear(
    system: RotorSystem,
    fills: Sequence[Fill],
    spin: float,
    friction: Friction,
    gravity: float,
    cells: int,
    dispersion: bool,
    enstrophy: bool = False,
    handover: Handover = Handover.RIDING,
    balls: Balls = NO_BALLS,
    position: float = 0.0,
) -> LinearCoupled:
    """Rotor without deflection, liquid at rest in the drum, balls where they start, by linear layers.

    `cells` sets the length of the steps alone; the exact linear theory has all dispersion and no bores.
    Liquid at the bottom of a lying drum is a mass at rest there, whatever the `handover`: long waves move it.
    """
    rest = at_rest(system, fills, spin, gravity, position)
    n, count = len(system.coordinates), len(fills)
    size = n + 2 * count + len(balls.places)
    layers = records(LINEAR_LAYER, count)
    for j, fill in enumerate(fills):
        layers[j] = _layer(fill, friction)
    machine = LinearMachine(
        matrices=np.stack([system.mass, system.damping, system.gyroscopic, system.stiffness]).astype(float),
        unbalance=system.unbalance.astype(complex),
        planes=rest.planes,
        layers=layers,
        tables=wall_tables(fills, friction),
        plates=plate_curves(fills),
        active=np.zeros(count),
        gravity=rest.gravity,
        curve=np.zeros((2, 0)),
        watched=rest.watched,
        place=np.zeros(size),
        rate=np.zeros(size),
        shaft=rest.shaft,
        carried=np.full(count, spin),
        sums=records(SUMS),
        crest=records(CREST),
        balls=ball_records(balls),
        races=race_planes(system, balls),
        left=np.zeros((size, size)),
        change=np.zeros(size),
        swing=np.zeros(n),
        held=np.zeros(len(balls.places)),
        spins=np.zeros(2),
        turn=np.zeros(4),
    )
    machine.place[n + 2 * count :] = balls.places
    machine.rate[n + 2 * count :] = spin * np.array(balls.shares, dtype=float)
    found = LinearCoupled(
        system=system,
        fills=tuple(fills),
        friction=friction,
        handover=handover,
        capture=rest.capture,
        pools=rest.pools,
        cells=cells,
        machine=machine,
        shaft=machine.shaft[0],
        sums=machine.sums[0],
        crest=machine.crest[0],
    )
    found.position = position
    machine.active[:] = found.begins_as_layer(spin)
    return found


def plate_curves(fills: Sequence[Fill]) -> Array:
    """Smeared baffles, zeta N r_m/(4 pi R) over the lag from 0 to the spin [theory: baffles, eq. 13].

    At even lags, shape (l, p); p = 0 where no baffle stands in liquid.
    """
    wet = [j for j, fill in enumerate(fills) if fill.uneven and not is_full(fill)]
    found, lags = np.zeros((len(fills), _LAGS if wet else 0)), np.linspace(0.0, 1.0, _LAGS)
    for j in wet:
        fill, baffles = fills[j], fills[j].chamber.baffles
        assert baffles is not None
        if fill.compartments > 1:
            text = "fewer, or shorter: linear layers do not slosh in compartments, long waves do"
            raise InputError(f"chambers.{j}.baffles.count", baffles.count, text)
        middle = math.sqrt(0.5 * (fill.chamber.radius**2 + fill.surface_radius**2))
        # The loss is a function of the lag over the spin alone.
        loss = baffle_torque(fill, 1.0, lags).loss
        found[j] = loss * baffles.count * middle / (4.0 * math.pi * fill.chamber.radius)
    return found


def _layer(fill: Fill, friction: Friction) -> tuple[float, ...]:
    """Record LINEAR_LAYER in its order; the quadratic law has no friction to offer a small motion."""
    chamber = fill.chamber
    if fill.surface_radius <= 0.0:
        return fill.mass, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    kappa = (chamber.radius / fill.surface_radius) ** 2
    area, rate, whole, top, sides = mean_area(fill), 0.0, 0.0, 0.0, 0.0
    inertia = fill.liquid.density * chamber.height * 2.0 * math.pi * chamber.radius**4 * area * (1.0 - area)
    if area > 0.0:
        layer, small = layer_properties(fill, friction, False), plane_layer(fill, friction)
        depth = fill.depth / chamber.radius
        # The layer as a whole feels the drag of a mean flow, its waves that of the slower free one.
        rate = whole = float(damping_rate(layer.law, layer.coefficient, layer.lid, depth, area, 0.0))
        if layer_drag(fill, friction) is not None:
            top, sides = layer.top, 1.0 / depth + layer.lid
        if friction.law.laminar and small is not None:
            rate = float(layer_rate(small, 1.0, -slower_slip(small.layer_tanh)).real)
    return fill.mass, kappa, rate, whole, 0.5 if friction.law.laminar else 0.0, inertia, top, sides
