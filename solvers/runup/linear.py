"""A rotor with linear layers, the cheap model of a run-up [theory: coupling, eq. 11-13]."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fluid.fill import Fill
from fluid.friction import Friction, FrictionLaw, damping_rate
from meshes.arrays import Array
from meshes.errors import require_not_negative
from solvers.rotor.system import RotorSystem
from solvers.runup.chamber import layer_capture, layer_properties, pool_offset
from solvers.runup.state import LAW, LID, RUBBING, TALLIES

if TYPE_CHECKING:
    from solvers.runup.linear_kernel import LinearMachine


@dataclass
class LinearCoupled:
    """A rotor with linear layers at one moment.

    Parameters
    ----------
    system, fills : what it is made from
    capture : speed above which each liquid rides with the drum as a layer, rad/s, shape (l,)
    pool : offset of liquid that is no layer, along the first direction, m, shape (l,)
    angle : that the rotor turns in a step over the Courant number, rad
    machine : matrices, state and scratch of the steps
    """

    system: RotorSystem
    fills: tuple[Fill, ...]
    capture: Array
    pool: Array
    angle: float
    machine: LinearMachine

    @property
    def time(self) -> float:
        """Time, s."""
        return float(self.machine.turning[2])

    @property
    def spin(self) -> float:
        """Spin speed, rad/s."""
        return float(self.machine.turning[0])

    @property
    def masses(self) -> Array:
        """Mass of the liquid in each chamber, kg, shape (l,)."""
        return np.array([fill.mass for fill in self.fills])

    @property
    def sums(self) -> Array:
        """Tallies of `solvers.runup.state`."""
        return self.machine.sums

    def drive(self, curve: Array, inertia: float) -> None:
        """Set a motor's torque curve and moment of inertia; an empty curve leaves the spin to its ramp."""
        self.machine = self.machine._replace(curve=curve)
        self.machine.drive[1] = inertia

    def advance(self, stop: float, rate: float, courant: float, most: int) -> int:
        """Advance to a time; status of `solvers.runup.linear_kernel.advance_linear`."""
        from solvers.runup.linear_kernel import advance_linear

        self.machine.drive[0] = rate
        return int(advance_linear(self.machine, stop, courant * self.angle, most))

    def mass_error(self) -> float:
        """None: the layer keeps its mass by construction."""
        return 0.0

    def energy(self) -> float:
        """Energy of rotor and layers, J [theory: coupling, eq. 12]."""
        from solvers.runup.linear_kernel import CURVATURE, INERTIA, MASS

        m, n = self.machine, len(self.system.coordinates)
        q, v = m.place[:n], m.rate[:n]
        total = 0.5 * (v @ m.matrices[0] @ v + q @ m.matrices[3] @ q)
        for j, layer in enumerate(m.layers):
            axis, row = m.planes[j] @ v, slice(n + 2 * j, n + 2 * j + 2)
            total += 0.5 * layer[MASS] * axis @ axis
            if not m.active[j]:
                continue
            d, rate, kappa = m.place[row], m.rate[row], layer[CURVATURE]
            total += layer[MASS] * (axis @ rate + 0.5 * (1.0 + kappa) * rate @ rate)
            total += (
                0.5 * layer[INERTIA] * m.carried[j] ** 2 - layer[MASS] * kappa * m.carried[j] ** 2 * d @ d
            )
        return float(total)


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
    from solvers.runup.linear_kernel import LinearMachine

    require_not_negative("gravity", gravity)
    n, count = len(system.coordinates), len(fills)
    capture = np.array([layer_capture(fill, gravity) for fill in fills])
    size = n + 2 * count
    machine = LinearMachine(
        matrices=np.stack([system.mass, system.damping, system.gyroscopic, system.stiffness]).astype(float),
        unbalance=system.unbalance.astype(complex),
        planes=np.array([system.at(fill.chamber.plane) for fill in fills]).reshape(count, 2, n),
        layers=np.array([_layer(fill, friction) for fill in fills]).reshape(count, 5),
        active=(capture < spin).astype(float),
        gravity=np.array([-gravity, 0.0]),
        drive=np.zeros(2),
        curve=np.zeros((2, 0)),
        place=np.zeros(size),
        rate=np.zeros(size),
        turning=np.array([spin, 0.0, 0.0]),
        carried=np.full(count, spin),
        sums=np.zeros(TALLIES),
        left=np.zeros((size, size)),
        change=np.zeros(size),
        swing=np.zeros(n),
    )
    pool = np.array([pool_offset(fill) if gravity > 0.0 else 0.0 for fill in fills])
    return LinearCoupled(system, tuple(fills), capture, pool, 2.0 * math.pi / cells, machine)


def _layer(fill: Fill, friction: Friction) -> tuple[float, ...]:
    """Row of `LinearMachine.layers`; the quadratic law has no friction to offer a small motion."""
    chamber = fill.chamber
    if fill.surface_radius <= 0.0:
        return fill.mass, 1.0, 0.0, 0.0, 0.0
    kappa = (chamber.radius / fill.surface_radius) ** 2
    area = fill.volume / (2.0 * math.pi * chamber.height * chamber.radius**2)
    inertia = fill.liquid.density * chamber.height * 2.0 * math.pi * chamber.radius**4 * area * (1.0 - area)
    row = layer_properties(fill, friction, False)
    law, rate = int(row[LAW]), 0.0
    if area > 0.0:
        rate = float(damping_rate(law, row[RUBBING], row[LID], fill.depth / chamber.radius, area, 0.0))
    return fill.mass, kappa, rate, 0.5 if friction.law is FrictionLaw.STOKES else 0.0, inertia


def switch_linear(machine: LinearCoupled) -> float:
    """Catch and let go liquid as `solvers.runup.long_wave.switch`; returns the energy brought in, J."""
    m, n = machine.machine, len(machine.system.coordinates)
    limit = np.where(m.active > 0.0, 0.98 * machine.capture, machine.capture)
    wanted = (machine.spin > limit).astype(float)
    changed = np.flatnonzero(wanted != m.active)
    if changed.size == 0:
        return 0.0
    before, lost = machine.energy(), np.zeros(n)
    whole = m.matrices[0] + sum(a * b.T @ b for a, b in zip(machine.masses, m.planes, strict=True))
    for j in changed.tolist():
        row = slice(n + 2 * j, n + 2 * j + 2)
        lost += machine.masses[j] * m.planes[j].T @ m.rate[row]
        m.place[row], m.rate[row], m.carried[j], m.active[j] = 0.0, 0.0, machine.spin, wanted[j]
    # What else moves keeps its momentum: the offsets' rates act on the rotor through their masses.
    m.rate[:n] += np.linalg.solve(whole, lost)
    return machine.energy() - before


def read_linear(machine: LinearCoupled) -> dict[str, Any]:
    """What `solvers.runup.runup.RunupHistory` records of a moment, by its names."""
    m, n, count = machine.machine, len(machine.system.coordinates), len(machine.fills)
    q = m.place[:n].copy()
    planes = list(m.planes) or [machine.system.centre]
    offset = m.place[n::2] + 1j * m.place[n + 1 :: 2]
    active = m.active > 0.0
    depth = np.array([fill.depth for fill in machine.fills])
    rise = (m.layers[:, 1] - 1.0) * np.abs(offset)
    nothing = np.full(count, np.nan)
    return {
        "time": machine.time,
        "speed": machine.spin,
        "angle": float(m.turning[1]),
        "coordinates": q,
        "deflection": np.array([complex(*(plane @ q)) for plane in planes]),
        "offset": np.where(active, offset, machine.pool),
        "captured": active,
        "depth_min": np.where(active, depth - rise, nothing),
        "depth_max": np.where(active, depth + rise, nothing),
        "mean_rotation": np.where(active, m.carried - machine.spin, 0.0),
    }
