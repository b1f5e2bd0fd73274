"""What one turn of a steady motion holds: the largest forces, the least clearances, the orbits. SI units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fluid.friction.laws import Friction
from fluid.pool import pool_of, wall_torque
from fluid.waves import capture_speed
from fluid.whirl import drag_power, plane_layer
from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.loads.machine import LoadedMachine, Loads
from solvers.rotor.vibration import orbit

ANGLES = 180  # of a turn at which sizes are looked at: a maximum of a sine is within 1.6e-4 of its size
_AT_ONCE = 200  # speeds
LEAST = ("clearance", "floor_force_least", "lift_off", "slip", "walking")
MEAN = "bearing_mean"


@dataclass(frozen=True)
class Extremes:
    """The worst of each of k turns or intervals; f feet, h holders, b bearings, p points."""

    holder: Array  #: largest size of the force in each spring, damper or support, N, shape (k, h)
    bearing: Array  #: in each bearing across the axis, N, shape (k, b)
    bearing_mean: Array  #: cubic mean of that force, by which a ball bearing lives, N, shape (k, b)
    moved: Array  #: largest distance of each point from where it rests, m, shape (k, p)
    clearance: Array  #: least of each point, nan without a gap, m, shape (k, p)
    floor_force: Array  #: of each foot, N, shape (k, f)
    floor_force_least: Array
    lift_off: Array  #: least margins, shape (k,); nan without a cabinet
    slip: Array
    walking: Array

    def at(self, rows: Index) -> Extremes:
        """Extremes of some turns."""
        return Extremes(**{name: getattr(self, name)[rows] for name in Extremes.__dataclass_fields__})


def cubic_mean(values: Array, axis: int, keepdims: bool = False) -> Array:
    """(mean of F^3)^(1/3) along an axis: the steady load with the same life [theory: loads, eq. 21]."""
    return np.asarray(np.cbrt(np.mean(values**3, axis=axis, keepdims=keepdims)))


def extremes(loads: Loads) -> Extremes:
    """Extremes of k turns over moments, the last axis of loads of shape (k, m)."""
    count = loads.holder.shape[0]
    floor, margin, none = loads.floor, loads.margins, np.full(count, np.nan)
    nobody = np.zeros((count, 0))
    return Extremes(
        holder=loads.holder.max(axis=1),
        bearing=loads.bearing.max(axis=1),
        bearing_mean=cubic_mean(loads.bearing, axis=1),
        moved=loads.moved.max(axis=1),
        clearance=loads.clearance.min(axis=1),
        floor_force=nobody if floor is None else floor.vertical.max(axis=1),
        floor_force_least=nobody if floor is None else floor.vertical.min(axis=1),
        lift_off=none if margin is None else margin.lift_off.min(axis=1),
        slip=none if margin is None else margin.slip.min(axis=1),
        walking=none if margin is None else margin.walking.min(axis=1),
    )


def joined(parts: list[Extremes]) -> Extremes:
    """Extremes of several parts, one after the other."""
    names = Extremes.__dataclass_fields__
    return Extremes(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})


def turn_extremes(machine: LoadedMachine, coordinates: Complex, speed: Array) -> Extremes:
    """Extremes over a turn of steady motions q = Re(coordinates e^{i Omega t}) [theory: loads, eq. 14].

    From amplitudes (s, n): nan where the motion is not known, infinite where it has no bound.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, ANGLES, endpoint=False)
    known = np.asarray(np.isfinite(coordinates).all(axis=1))
    parts = []
    for first in range(0, speed.size, _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        size = np.where(known[part, None], coordinates[part], 0.0)[:, None, :]
        turned = size * np.exp(1j * angle)[:, None]
        spin = speed[part, None, None]
        loads = machine.loads(
            *(turned.real, (1j * spin * turned).real, (-np.square(spin) * turned).real),
            np.broadcast_to(angle, turned.shape[:2]),
        )
        parts.append(extremes(loads))
    return _without(joined(parts), known, np.asarray(np.isinf(coordinates).any(axis=1)))


def _without(found: Extremes, known: Flags, endless: Flags) -> Extremes:
    """Extremes with nan where the motion is not known, and no bound where it has none."""
    values = {}
    for name in Extremes.__dataclass_fields__:
        value = getattr(found, name)
        worst = -np.inf if name in LEAST else np.inf
        shape = (-1, *[1] * (value.ndim - 1))
        unknown, without = ~known.reshape(shape), endless.reshape(shape) & ~np.isnan(value)
        values[name] = np.where(without, worst, np.where(unknown, np.nan, value))
    return Extremes(**values)


def orbits(machine: LoadedMachine, coordinates: Complex) -> tuple[Array, Array]:
    """Semi-axes of the ellipse on which each point goes round [theory: loads, eq. 15].

    The larger and the smaller one, m, shape (s, p) each; of a point on the drum that of the middle of its
    circle.
    """
    large, small = np.zeros((2, coordinates.shape[0], len(machine.points)))
    for k, point in enumerate(machine.points):
        place = point.position
        if point.on != "tub":
            place = machine.frame.on_axis(place[machine.frame.along])
        moved = np.where(np.isfinite(coordinates), coordinates, np.nan) @ machine.frame.moving(place).T
        size, pair = np.square(np.abs(moved)).sum(axis=1), np.abs(np.square(moved).sum(axis=1))
        large[:, k] = np.sqrt(0.5 * (size + pair))
        small[:, k] = np.sqrt(0.5 * np.maximum(size - pair, 0.0))
    return large, small


def damping_power(machine: LoadedMachine, coordinates: Complex, speed: Array) -> Array:
    """Mean power that the supports turn into heat, which the motor replaces [theory: loads, eq. 16].

    W, shape (s,); what the liquid takes is that of `liquid_power`.
    """
    damping = machine.rotor.system().damping
    moved = np.where(np.isfinite(coordinates), coordinates, np.nan)
    heat = np.einsum("si,ij,sj->s", moved.conj(), damping, moved).real
    return np.asarray(0.5 * np.square(speed) * heat)


def liquid_power(machine: LoadedMachine, friction: Friction, coordinates: Complex, speed: Array) -> Array:
    """Mean power that friction in the liquid turns into heat, W, shape (s,) [theory: loads, eq. 18-19].

    The motor replaces it. In a circular forward whirl without transverse gravity the liquid rests in its
    drum; backward whirl and gravity move it as small waves, below the speed from which an annular layer
    exists as a pool past which walls and baffles move. Of a chamber with baffles the pool alone counts, one
    with a section of its own is left out.
    """
    system, total = machine.rotor.system(), np.zeros(speed.shape)
    gravity = 0.0 if machine.vertical else machine.gravity
    for fill in machine.fills:
        own, drawn = np.zeros((2, *speed.shape))
        layer = None if fill.uneven else plane_layer(fill, friction)
        if layer is not None:
            backward = np.abs(orbit(system, coordinates, fill.chamber.plane).backward)
            own = drag_power(layer, speed, -speed, np.square(speed) * backward)
            drawn = drag_power(layer, speed, 0.0 * speed, gravity)
        pool = pool_of(fill) if gravity > 0.0 and fill.chamber.section is None else None
        if pool is not None:
            lies = speed <= capture_speed(fill.surface_radius, gravity)
            most = pool.mass * gravity * pool.arm
            held = speed * np.minimum(wall_torque(fill, pool, friction, speed), most)
            own = np.where(lies, held, own + drawn)
        total = total + own
    return total
