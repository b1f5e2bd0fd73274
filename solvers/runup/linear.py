"""A rotor with linear layers, the cheap model of a run-up [theory: coupling, eq. 11-13]."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fluid.fill import Fill
from fluid.friction import Friction, FrictionLaw, damping_rate
from meshes.arrays import Array
from meshes.errors import require_not_negative
from solvers.layer.records import records
from solvers.layer.state import ring
from solvers.rotor.system import RotorSystem
from solvers.runup.machine import Outcome, Reading
from solvers.runup.state import RELEASE, SHAFT, SUMS, layer_capture, layer_properties, mean_area, pool_offset

if TYPE_CHECKING:
    from solvers.runup.linear_kernel import LinearMachine


@dataclass
class LinearCoupled:
    """A rotor with linear layers at one moment, a `solvers.runup.machine.RunupMachine`.

    Parameters
    ----------
    system, fills : what it is made from
    capture : speed above which each liquid rides with the drum as a layer, rad/s, shape (l,)
    pool : offset of liquid that is no layer, along the first direction, m, shape (l,)
    cells : the rotor turns in a step by a cell times the Courant number
    machine : matrices, state and scratch of the steps
    """

    system: RotorSystem
    fills: tuple[Fill, ...]
    capture: Array
    pool: Array
    cells: int
    machine: LinearMachine

    @property
    def time(self) -> float:
        """Time, s."""
        return float(self.machine.shaft[0].time)

    @property
    def spin(self) -> float:
        """Spin speed, rad/s."""
        return float(self.machine.shaft[0].spin)

    @property
    def masses(self) -> Array:
        """Mass of the liquid in each chamber, kg, shape (l,)."""
        return np.array([fill.mass for fill in self.fills])

    @property
    def sums(self) -> np.record:
        """Record SUMS of `solvers.runup.state`."""
        found: np.record = self.machine.sums[0]
        return found

    @property
    def theta(self) -> Array:
        """Angle of the cells' middles from the drum's zero mark, rad, shape (c,)."""
        angles = ring(self.cells)
        return np.asarray(np.arctan2(angles[1], angles[0]))

    def drive(self, curve: Array, inertia: float) -> None:
        """Set a motor's torque curve and moment of inertia; an empty curve leaves the spin to its ramp."""
        self.machine = self.machine._replace(curve=curve)
        self.machine.shaft[0].inertia = inertia

    def advance(self, stop: float, rate: float, courant: float, most: int) -> Outcome:
        """Advance to a time while the spin changes at a rate, in at most so many steps."""
        from solvers.runup.linear_kernel import advance_linear

        self.machine.shaft[0].rate = rate
        return Outcome(advance_linear(self.machine, stop, courant * (2.0 * math.pi / self.cells), most))

    def mass_error(self) -> float:
        """None: the layer keeps its mass by construction."""
        return 0.0

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
        return float(total)

    def switch(self) -> float:
        """Catch and let go liquid as `solvers.runup.long_wave.Coupled.switch`; energy brought in, J."""
        m, n = self.machine, len(self.system.coordinates)
        limit = np.where(m.active > 0.0, RELEASE * self.capture, self.capture)
        wanted = (self.spin > limit).astype(float)
        changed = np.flatnonzero(wanted != m.active)
        if changed.size == 0:
            return 0.0
        before, lost = self.energy(), np.zeros(n)
        whole = m.matrices[0] + sum(a * b.T @ b for a, b in zip(self.masses, m.planes, strict=True))
        for j in changed.tolist():
            row = slice(n + 2 * j, n + 2 * j + 2)
            lost += self.masses[j] * m.planes[j].T @ m.rate[row]
            m.place[row], m.rate[row], m.carried[j], m.active[j] = 0.0, 0.0, self.spin, wanted[j]
        # What else moves keeps its momentum: the offsets' rates act on the rotor through their masses.
        m.rate[:n] += np.linalg.solve(whole, lost)
        return self.energy() - before

    def fall(self, outcome: Outcome) -> None:
        """Nothing falls: small waves are not thrown down."""

    def read(self) -> Reading:
        """The moment as the history keeps it."""
        m, n = self.machine, len(self.system.coordinates)
        q, active = m.place[:n].copy(), m.active > 0.0
        planes = list(m.planes) or [self.system.centre]
        offset = self._offset()
        depth = np.array([fill.depth for fill in self.fills])
        rise = (m.layers.curvature - 1.0) * np.abs(offset)
        nothing = np.full(len(self.fills), np.nan)
        return Reading(
            time=self.time,
            speed=self.spin,
            angle=float(m.shaft[0].angle),
            coordinates=q,
            deflection=np.array([complex(*(plane @ q)) for plane in planes]),
            offset=np.where(active, offset, self.pool),
            captured=active,
            depth_min=np.where(active, depth - rise, nothing),
            depth_max=np.where(active, depth + rise, nothing),
            mean_rotation=np.where(active, m.carried - self.spin, 0.0),
        )

    def depth(self) -> Array:
        """Depth of the layers at as many angles as cells, m, nan where the liquid is none, shape (l, c)."""
        m = self.machine
        offset = self._offset() * np.exp(-1j * m.shaft[0].angle)
        depth = np.array([fill.depth for fill in self.fills])[:, None]
        wave = np.real(offset[:, None] * np.exp(-1j * self.theta))
        rise = (m.layers.curvature - 1.0)[:, None] * wave
        return np.where(m.active[:, None] > 0.0, depth + rise, np.nan)

    def _offset(self) -> Array:
        """Offset of each layer's centre of mass from its chamber's axis, standing frame, complex, m."""
        m, n = self.machine, len(self.system.coordinates)
        return np.asarray(m.place[n::2] + 1j * m.place[n + 1 :: 2])


def couple_linear(
    system: RotorSystem,
    fills: Sequence[Fill],
    spin: float,
    friction: Friction,
    gravity: float,
    cells: int,
    dispersion: bool,
) -> LinearCoupled:
    """Rotor without deflection, liquid at rest in the drum.

    Parameters are those of `solvers.runup.long_wave.couple`; `cells` sets the length of the steps alone, and
    the exact linear theory has all dispersion.

    Raises
    ------
    InputError : a negative gravity
    """
    from solvers.runup.linear_kernel import LINEAR_LAYER, LinearMachine

    require_not_negative("gravity", gravity)
    n, count = len(system.coordinates), len(fills)
    capture = np.array([layer_capture(fill, gravity) for fill in fills])
    size = n + 2 * count
    layers, shaft = records(LINEAR_LAYER, count), records(SHAFT)
    for j, fill in enumerate(fills):
        layers[j] = _layer(fill, friction)
    shaft[0].spin = spin
    machine = LinearMachine(
        matrices=np.stack([system.mass, system.damping, system.gyroscopic, system.stiffness]).astype(float),
        unbalance=system.unbalance.astype(complex),
        planes=np.array([system.at(fill.chamber.plane) for fill in fills]).reshape(count, 2, n),
        layers=layers,
        active=(capture < spin).astype(float),
        gravity=np.array([-gravity, 0.0]),
        curve=np.zeros((2, 0)),
        place=np.zeros(size),
        rate=np.zeros(size),
        shaft=shaft,
        carried=np.full(count, spin),
        sums=records(SUMS),
        left=np.zeros((size, size)),
        change=np.zeros(size),
        swing=np.zeros(n),
    )
    pool = np.array([pool_offset(fill) if gravity > 0.0 else 0.0 for fill in fills])
    return LinearCoupled(system, tuple(fills), capture, pool, cells, machine)


def _layer(fill: Fill, friction: Friction) -> tuple[float, ...]:
    """Record LINEAR_LAYER in its order; the quadratic law has no friction to offer a small motion."""
    chamber = fill.chamber
    if fill.surface_radius <= 0.0:
        return fill.mass, 1.0, 0.0, 0.0, 0.0
    kappa = (chamber.radius / fill.surface_radius) ** 2
    area, rate = mean_area(fill), 0.0
    inertia = fill.liquid.density * chamber.height * 2.0 * math.pi * chamber.radius**4 * area * (1.0 - area)
    if area > 0.0:
        layer = layer_properties(fill, friction, False)
        depth = fill.depth / chamber.radius
        rate = float(damping_rate(layer.law, layer.coefficient, layer.lid, depth, area, 0.0))
    return fill.mass, kappa, rate, 0.5 if friction.law is FrictionLaw.STOKES else 0.0, inertia
