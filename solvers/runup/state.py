"""What the coupled time steps work on, and how every run-up begins; SI units.

The steps take machine, chambers, state and scratch; single numbers that change stand in records, see
`solvers.layer.records`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.friction.wall import NO_TABLE, WallDrag, wall_drag
from fluid.pool import Pool, centrifuging_speed, pool_of
from fluid.waves import free_wave_frequencies
from meshes.arrays import Array, Complex, Flags
from meshes.errors import require_not_negative
from solvers.layer.records import Record, floats, records
from solvers.rotor.system import RotorSystem
from solvers.runup.machine import Handover, Transfer

# A layer is let go at this share of the spin speed that captures it, lest it be caught and let go in turns.
RELEASE = 0.98


def mean_area(fill: Fill) -> float:
    """Liquid area per radian over R^2."""
    return fill.volume / (2.0 * math.pi * fill.chamber.height * fill.chamber.radius**2)


class LayerProperties(NamedTuple):
    """What the steps know of a layer."""

    radius: float  #: of the wall R, m
    weight: float  #: rho h_c, kg/m^2
    mass: float  #: kg
    #: law and coefficient: of the friction: number of the law; k, 1/s, Stokes' over the root of the spin, or
    #: c_f
    law: int
    coefficient: float
    lid: float  #: 2 R/h_c under Stokes' friction and the law of the wall, otherwise 0
    dispersion: bool  #: whether its waves disperse
    #: plates, thin and top: of the law of the wall, see `fluid.friction.wall.WallDrag`, of unit spin: the
    #: coefficient goes with the root of the spin and `thin` with its inverse
    plates: float = 0.0
    thin: float = 0.0
    top: float = 0.0


# The same as a record.
_KINDS = {"law": np.int64, "dispersion": np.bool_}
LAYER = np.dtype([(name, _KINDS.get(name, np.float64)) for name in LayerProperties._fields], align=True)


def layer_properties(fill: Fill, friction: Friction, dispersion: bool) -> LayerProperties:
    """Properties of a chamber's layer for the steps; the laminar law is at the slower natural wave."""
    chamber, slip = fill.chamber, unit_slip(fill)
    law, coefficient = friction.at(fill.liquid.viscosity, slip, chamber.radius)
    laminar = friction.law.laminar and slip > 0.0
    lid = 2.0 * chamber.radius / chamber.height if laminar else 0.0
    weight = fill.liquid.density * chamber.height
    found = LayerProperties(chamber.radius, weight, fill.mass, law, coefficient, lid, dispersion)
    drag = layer_drag(fill, friction)
    if drag is None:
        return found
    return found._replace(plates=drag.plates, thin=drag.thin, top=drag.top)


def unit_slip(fill: Fill) -> float:
    """Frequency of the slower natural sloshing wave seen from the drum over the spin; 0 without a layer."""
    log = math.log(fill.chamber.radius / fill.surface_radius) if fill.surface_radius > 0.0 else math.inf
    return abs(float(free_wave_frequencies(1, log, 1.0)[1])) if 0.0 < log < math.inf else 0.0


def layer_drag(fill: Fill, friction: Friction) -> WallDrag | None:
    """The law of the wall for a layer at unit spin; None under another law or without a layer."""
    slip, chamber = unit_slip(fill), fill.chamber
    if friction.law is not FrictionLaw.WALL or slip == 0.0:
        return None
    return wall_drag(friction, fill.liquid.viscosity, fill.depth, chamber.radius, chamber.height, slip, 1.0)


def wall_tables(fills: Sequence[Fill], friction: Friction) -> Array:
    """Tables of the law of the wall for every layer, shape (l, m, 2); zeros for liquid that is none."""
    drags = [layer_drag(fill, friction) for fill in fills]
    found = [NO_TABLE if drag is None else drag.table for drag in drags]
    longest = max((len(table) for table in found), default=0)
    tables = np.zeros((len(fills), longest, 2))
    for j, table in enumerate(found):
        tables[j, : len(table)] = table
    return tables


def layer_capture(fill: Fill, gravity: float) -> float:
    """Speed above which the liquid is a layer, rad/s; infinite for liquid without a free surface, or none."""
    if not 0.0 < fill.volume < fill.chamber.capacity * (1.0 - 1e-9) or fill.surface_radius <= 0.0:
        return math.inf
    return math.sqrt(gravity / fill.surface_radius)


# What a layer is measured by: moment and its rate of change by the flow, inertia of the flow, angular
# momentum and energy in the frame that does not turn [theory: coupling, eq. 2, 4 and 7].
MEASURES = floats("moment_x", "moment_y", "flow_x", "flow_y", "xx", "xy", "yy", "spinning", "energy")
# What a layer's step adds up: impulse of the torque of wall and baffles, its work at the spins at which it
# acts, heat by friction, loss in bores and by the scheme, energy that the flow's profile misses, heat at the
# baffles.
GAINS = floats("torque", "work", "heat", "loss", "missed", "baffles")
# The rotation: speed, angle turned, time; rate of change of the speed, on its ramp or in the last step with a
# motor; moment of inertia about the axis with a motor.
SHAFT = floats("spin", "angle", "time", "rate", "inertia")
# Lengths of the last two steps, the fastest wave, by what the next step is shortened; rows of the trace kept.
PACE = floats("last", "before", "older", "fastest", "share", "kept")
# The largest amplitude since the moment was last read, and the speed and time of it.
CREST = floats("amplitude", "speed", "time")
# A ball in a race: mass, radius of its path, inertia on it, torque of the drag over the speed in the drum,
# torque by a change of the spin on the ball and on the drum, and its resistance to rolling over its pressure.
BALL = floats("mass", "radius", "inertia", "drag", "carried", "driven", "resistance")
# What is summed up over time [theory: coupling, eq. 9-10]: work of the unbalance, of the drive on the liquid,
# of gravity; heat in the supports and by wall friction, loss in bores, loss at the baffles, what the assumed
# profile of the flow misses while the spin changes; work of the motor; what layers lose in bores and by the
# scheme, whose largest value so far is the loss in bores; steps, layer steps, largest disagreement left.
SUMS = floats(
    *("unbalance", "drive", "gravity", "support", "friction", "bores", "baffles", "profile", "motor"),
    *("lost", "steps", "layer_steps", "disagreement"),
)


# Works and heats among them, J.
WORKS = ("unbalance", "drive", "gravity", "support", "friction", "bores", "baffles", "profile", "motor")


class Machine(NamedTuple):
    """Rotor and layers; n coordinates, l layers, c cells."""

    matrices: Array  #: M, C, G, K, shape (4, n, n)
    unbalance: NDArray[np.complex128]  #: U, complex, shape (n,)
    #: in-plane displacement of each axis for unit coordinates, the layers' first, then the pools', shape (l +
    #: p, 2, n)
    planes: Array
    masses: Array  #: of the liquids at these, kg, shape (l + p,)
    layers: Record  #: records LAYER, shape (l,)
    #: records `solvers.layer.two_layers.STREAM` of liquid that is in two layers, and their tables of the law
    #: of the wall, shapes (p,) and (p, m, 2)
    pools: Record
    pool_tables: Array
    tables: Array  #: of the law of the wall, shape (l, m, 2); m = 0 under other laws
    gravity: Array  #: acceleration across the axis, shape (2,)
    angles: Array  #: cosine and sine at the cells' middles and at their left faces, shape (4, c)
    curve: Array  #: the motor's speeds and torques, shape (2, k); k = 0 for a ramp
    watched: Array  #: displacement of the axis whose amplitude counts, for unit coordinates, shape (2, n)
    plates: Array  #: baffles of each layer, as by `solvers.layer.baffles.tables_of`, shape (l, k, COLUMNS)
    gaps: Array  #: area of the full gap of each layer over R^2, 1 without an inner wall, shape (l,)
    balls: Record  #: records BALL, shape (N,)
    races: Array  #: displacement of the axis in the plane of each ball for unit coordinates, shape (N, 2, n)


class State(NamedTuple):
    """What changes with time."""

    #: place and rate: of the coordinates, shape (n,)
    place: Array
    rate: Array
    shaft: Record  #: record SHAFT, shape (1,)
    #: area and momentum: A/R^2 and q/R^2 of the layers' cells, shape (l, c)
    area: Array
    momentum: Array
    #: A e/R^4 of the fluctuations behind bores, shape (l, c), or (l, 0) where they are left out
    rolling: Array
    #: two_layers: A_1, A_2 over R^2 and L_1, L_2 over R^4 of each pool's cells, shape (p, 4, c)
    #: rings: whether each is a ring that has not fallen yet, shape (p,)
    two_layers: Array
    rings: Flags
    #: mean accelerations of the axes over the last step and over the one before, shape (l + p, 2, 2)
    push: Array
    pace: Record  #: record PACE, shape (1,)
    sums: Record  #: record SUMS, shape (1,)
    crest: Record  #: record CREST, shape (1,)
    #: time, angle, coordinates, and the first moment of each layer over R^3 in the drum frame, of every step,
    #: shape (k, 2 + n + 2 l); k = 0 where nobody wants them
    trace: Array
    #: roll and roll_rate: angle of each ball in the standing frame, and its rate, shape (N,)
    roll: Array
    roll_rate: Array


class Room(NamedTuple):
    """Scratch of the steps, made by `solvers.runup.long_wave`."""

    #: area, momentum, rolling and two_layers: the liquid at the beginning of the step, as in `State`
    area: Array
    momentum: Array
    rolling: Array
    two_layers: Array
    #: of each pool records TAKEN and FLOWS of `solvers.layer.two_layers`, these at both ends, shape (p,)
    taken: Record
    first: Record
    last: Record
    work: Array  #: scratch of `solvers.layer.two_layers.advance`, shape (p, ROWS, k)
    #: begin and end: records MEASURES of the layers at both ends, shape (l,)
    begin: Record
    end: Record
    gains: Record  #: records GAINS of the layers, shape (l,)
    inertia: Array  #: of the flows of layers and pools (xx, xy, yy), shape (l + p, 3)
    #: before and after: their momenta relative to their axes at both ends, shape (l + p, 2)
    before: Array
    after: Array
    #: guess and found: mean accelerations of the axes put in and come out; what they missed by in the round
    #: before, shape (l + p, 2)
    guess: Array
    found: Array
    miss: Array
    #: change and swing: of the velocities over the step; of the unbalance's momentum, shape (n,)
    change: Array
    swing: Array
    #: left and right: matrix and loads of the equations of rotor and balls, shapes (n + N, n + N) and (n +
    #: N,)
    left: Array
    right: Array
    roll: Array  #: change of the balls' rates over the step, shape (N,)
    held: Array  #: rolling resistance of each ball over its speed in the drum, N m s, shape (N,)
    spins: Array  #: at both ends, shape (2,)
    turn: Array  #: cosine and sine of the angle turned at both ends, shape (4,)
    force: Array  #: body force over R in the drum frame at both ends, two parts each, shape (4,)
    spare: Array  #: scratch of `solvers.runup.steps.layer.layer_step`, shape (l, ...)


# Of a layer: mass, curvature, friction rate of its waves and of it as a whole, power of the spin that they go
# with, moment of inertia; under the law of the wall last velocity of its table, R/h + 2 R/h_c, otherwise 0
# both.
LINEAR_LAYER = floats("mass", "curvature", "rate", "whole", "power", "inertia", "top", "sides")


class LinearMachine(NamedTuple):
    """Rotor, l linear layers and b balls; n coordinates, N = n + 2 l + b."""

    matrices: Array  #: M, C, G, K of the rotor, shape (4, n, n)
    unbalance: NDArray[np.complex128]  #: U, complex, shape (n,)
    planes: Array  #: displacement of each layer's axis for unit coordinates, shape (l, 2, n)
    layers: Record  #: records LINEAR_LAYER, shape (l,)
    tables: Array  #: of the law of the wall, shape (l, m, 2); m = 0 under other laws
    #: smeared baffles, zeta N r_m/(4 pi R) at lags that rise evenly from 0 to the spin, shape (l, p); p = 0
    #: where no layer has any
    plates: Array
    active: Array  #: 1 for a layer, 0 for liquid that lies at the bottom or is solid, shape (l,)
    gravity: Array  #: across the axis, shape (2,)
    curve: Array  #: the motor's, shape (2, k)
    watched: Array  #: displacement of the axis whose amplitude counts, for unit coordinates, shape (2, n)
    #: place and rate: rotor's coordinates, the layers' offsets, two parts each, and the balls' angles in the
    #: standing frame, and their rates, shape (N,)
    place: Array
    rate: Array
    shaft: Record  #: record SHAFT, shape (1,)
    carried: Array  #: rotation of each layer as a whole, rad/s, shape (l,)
    sums: Record  #: record SUMS, shape (1,)
    crest: Record  #: record CREST, shape (1,)
    #: balls and races: as in `Machine`, shapes (b,) and (b, 2, n)
    balls: Record
    races: Array
    #: left, change, swing and held: scratch, shapes (N, N), (N,), (n,), (b,)
    left: Array
    change: Array
    swing: Array
    held: Array
    #: speed, and cosine and sine of the angle turned, at both ends of the step, shapes (2,) and (4,)
    spins: Array
    turn: Array


class Rest(NamedTuple):
    """A rotor without deflection and its liquid at rest in the drum; n coordinates, l chambers."""

    #: own rotation above which each liquid stays a layer, rad/s, inf for a solid mass, shape (l,)
    capture: Array
    #: of the chambers across gravity; None for a solid mass, no liquid, and without gravity
    pools: tuple[Pool | None, ...]
    planes: Array  #: displacement of each chamber's axis for unit coordinates, shape (l, 2, n)
    watched: Array  #: that of the first chamber, or of the axis at a position without one, shape (2, n)
    shaft: Record  #: record SHAFT at the spin, shape (1,)
    gravity: Array  #: acceleration across the axis, shape (2,)


def at_rest(
    system: RotorSystem, fills: Sequence[Fill], spin: float, gravity: float, position: float = 0.0
) -> Rest:
    """How every run-up begins; `position` of the plane whose amplitude counts without a chamber, m."""
    require_not_negative("gravity", gravity)
    shaft = records(SHAFT)
    shaft[0].spin = spin
    planes = planes_of(system, fills)
    return Rest(
        capture=np.array([layer_capture(fill, gravity) for fill in fills]),
        pools=tuple(pool_of(fill) if gravity > 0.0 else None for fill in fills),
        planes=planes,
        watched=np.array(planes[0] if fills else system.at(position), dtype=float),
        shaft=shaft,
        gravity=np.array([-gravity, 0.0]),
    )


def planes_of(system: RotorSystem, fills: Sequence[Fill]) -> Array:
    """Displacement of each chamber's axis for unit coordinates, shape (l, 2, n)."""
    planes = np.array([system.at(fill.chamber.plane) for fill in fills], dtype=float)
    return planes.reshape(len(fills), 2, len(system.coordinates))


def pours(fill: Fill, pool: Pool) -> bool:
    """Whether a pool lies below its chamber's axis, so that two shallow layers describe it."""
    return pool.half_angle < (_HALF if fill.chamber.inner_radius > 0.0 else _TO_THE_AXIS) * math.pi


# Half of the wetted arc over pi: half a ring, and where a pool without an inner wall comes near the axis, 45
# per cent of the chamber.
_HALF, _TO_THE_AXIS = 0.5, 0.475


@dataclass
class CoupledRotor(ABC):
    """What every rotor with layers has, long waves or linear; see `solvers.runup.machine.RunupMachine`."""

    system: RotorSystem  #: what it is made from
    fills: tuple[Fill, ...]
    friction: Friction  #: of the liquid on its walls
    handover: Handover  #: how liquid at the bottom becomes a layer
    capture: Array  #: as of `Rest`, shape (l,)
    pools: tuple[Pool | None, ...]
    machine: Machine | LinearMachine  #: what the compiled steps take
    shaft: np.record  #: record SHAFT of the moment
    sums: np.record  #: record SUMS: works, heats and counts so far
    crest: np.record  #: record CREST of the interval
    #: liquid that has become a layer or fallen so far
    transfers: list[Transfer] = field(default_factory=list, init=False)
    #: mass matrix of what has left the drum, and its moment of inertia about the axis
    lost_mass: Array | None = field(default=None, init=False)
    lost_inertia: float = field(default=0.0, init=False)
    #: of the plane that is read where there is no chamber, m
    position: float = field(default=0.0, init=False)

    @cached_property
    def swings(self) -> Flags:
        """Liquid that swings as a pool while it is no layer, shape (l,)."""
        moves = self.handover is not Handover.RIDING
        pairs = zip(self.fills, self.pools, strict=True)
        return np.array(
            [moves and pool is not None and pours(fill, pool) for fill, pool in pairs], dtype=bool
        )

    @cached_property
    def rests(self) -> Flags:
        """Liquid across the axis that is too much for a pool: a mass until it becomes a ring, shape (l,)."""
        moves = self.handover is not Handover.RIDING
        return np.array([moves and pool is not None for pool in self.pools], dtype=bool) & ~self.swings

    @cached_property
    def centrifuging(self) -> Array:
        """Speed from which each pool becomes a ring, rad/s; inf without a pool, shape (l,)."""
        gravity = abs(float(self.gravity[0]))
        pairs = zip(self.fills, self.pools, strict=True)
        return np.array(
            [np.inf if p is None else centrifuging_speed(f, self.friction, gravity) for f, p in pairs]
        )

    @property
    def pool_offset(self) -> Complex:
        """Centre of mass of liquid that rests at the bottom, from its chamber's axis, standing frame, m."""
        return np.array([0.0 if pool is None else -pool.arm for pool in self.pools], dtype=complex)

    @cached_property
    def resting_wet(self) -> Array:
        """Share of the outer wall that each liquid wets at rest at the bottom; all of it elsewhere, (l,)."""
        return np.array([1.0 if pool is None else pool.half_angle / math.pi for pool in self.pools])

    def begins_as_layer(self, spin: float) -> Flags:
        """Whether each liquid rides with a drum that has always turned at this speed, shape (l,)."""
        rides = self.capture < spin
        return rides & (self.centrifuging < spin) if self.swings.any() else rides

    def ridden(self, active: Flags) -> Flags:
        """Which liquids are layers from now on under the rule `riding`, shape (l,)."""
        return np.asarray(self.spin > np.where(active, RELEASE * self.capture, self.capture))

    @cached_property
    def seen(self) -> Array:
        """Displacement of the axes that are read, for unit coordinates: the chambers', or the one watched."""
        planes = planes_of(self.system, self.fills)
        return planes if len(planes) else np.array([self.system.at(self.position)], dtype=float)

    @cached_property
    def lowest(self) -> Array:
        """Own rotation below which a layer falls in any case, rad/s, shape (l,)."""
        gravity = abs(float(self.gravity[0]))
        return np.array([layer_capture(fill, gravity) for fill in self.fills])

    @cached_property
    def spread_inertia(self) -> Array:
        """Moment of inertia of each liquid as a uniform layer, kg m^2, shape (l,)."""
        return np.array([0.5 * f.mass * (f.chamber.radius**2 + f.surface_radius**2) for f in self.fills])

    @property
    def gravity(self) -> Array:
        """Acceleration across the axis, shape (2,)."""
        return self.machine.gravity

    @property
    def time(self) -> float:
        """Time, s."""
        return float(self.shaft["time"])

    @property
    def spin(self) -> float:
        """Spin speed, rad/s."""
        return float(self.shaft["spin"])

    @property
    def angle(self) -> float:
        """Angle by which the drum has turned, rad."""
        return float(self.shaft["angle"])

    def drive(self, curve: Array, inertia: float) -> None:
        """Set a motor's torque curve and moment of inertia; an empty curve leaves the spin to its ramp."""
        self.machine = self.machine._replace(curve=np.ascontiguousarray(curve, dtype=float))
        self.shaft.inertia = inertia - self.lost_inertia

    def load(self, unbalance: Complex) -> None:
        """Set the unbalance from here on, kg m and kg m^2, shape (n,)."""
        self.machine.unbalance[:] = unbalance

    @property
    @abstractmethod
    def velocity(self) -> Array:
        """Rates of change of the rotor's coordinates, shape (n,)."""

    @abstractmethod
    def energy(self) -> float:
        """Of rotor and liquid, J."""

    def lighten(self, mass: Array, inertia: float) -> float:
        """See `solvers.runup.machine.RunupMachine.lighten`."""
        gone = np.zeros_like(self.system.mass) if self.lost_mass is None else self.lost_mass
        self.machine.matrices[0] -= mass - gone
        self.shaft["inertia"] -= inertia - self.lost_inertia
        self.lost_mass, self.lost_inertia = mass, inertia
        return -0.5 * float(self.velocity @ (mass - gone) @ self.velocity)

    def watch(self) -> None:
        """From here on look for the largest amplitude anew."""
        self.crest.amplitude = 0.0

    def largest(self, amplitude: float) -> dict[str, float]:
        """Parts of a reading: the largest amplitude of the interval, with that of the moment itself."""
        largest, speed, time = self.crest.item()
        if amplitude >= largest:
            largest, speed, time = amplitude, self.spin, self.time
        return {"largest": largest, "largest_speed": speed, "largest_time": time}

    @property
    def masses(self) -> Array:
        """Mass of the liquid in each chamber, kg, shape (l,)."""
        return np.array([fill.mass for fill in self.fills])
