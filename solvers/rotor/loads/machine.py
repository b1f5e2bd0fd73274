"""Forces and clearances of a machine at moments of its motion [theory: loads]. SI units."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.loads.bearings import bearing_forces, hub_load, weight_load
from solvers.rotor.loads.floor import (
    Cabinet,
    FloorForce,
    Margins,
    floor_forces,
    margins,
    require_standing,
)
from solvers.rotor.loads.frame import AnyRotor, Frame, Holder, Weight, frame_of, holders_of, weights_of
from solvers.rotor.tub import Tub, Vector


@dataclass(frozen=True)
class Point:
    """A named point whose motion counts."""

    name: str  #: for reports
    position: Vector  #: (x, y, z) at rest, m
    on: str = "axis"  #: "tub", which does not spin; "drum", which does; or "axis"
    gap: float | None = None  #: to the housing, m; None where nobody asks for the clearance
    direction: Vector | None = None  #: in which the gap is; all across the axis if None


@dataclass(frozen=True)
class Loads:
    """Forces and clearances at moments, shape (...)."""

    holder: Array  #: size of the force in each spring, damper or support, N, shape (..., h)
    bearing: Array  #: of the force across the axis in each bearing, N, shape (..., b)
    #: distance of each point from where it rests, m, shape (..., p); of a point on the drum from where it
    #: would be on its circle
    moved: Array
    #: what is left of each point's gap, below 0 where it touches, m, nan without a gap, (..., p)
    clearance: Array
    floor: FloorForce | None  #: None without a cabinet
    margins: Margins | None  #: against walking; None without a cabinet


@dataclass(frozen=True)
class LoadedMachine:
    """A rotor with what holds it, where it stands and what is asked of it."""

    rotor: AnyRotor  #: dry
    fills: tuple[Fill, ...] = ()  #: its chambers with their liquid
    gravity: float = 9.81  #: m/s^2
    vertical: bool = False  #: gravity acts along the axis
    cabinet: Cabinet | None = None  #: None where it is not known
    points: tuple[Point, ...] = ()  #: whose motion counts
    #: places of two along the axis of a tub's drum, m; None where they are not known
    bearings: tuple[float, float] | None = None
    races: tuple[BallRace, ...] = ()  #: with balls, whose weight hangs on the drum

    def __post_init__(self) -> None:
        tub = isinstance(self.rotor, Tub)
        if self.bearings is not None and not tub:
            raise InputError("rotor.bearings", self.bearings, "left out for a rotor without a tub")
        if self.bearings is not None and self.bearings[0] == self.bearings[1]:
            raise InputError("rotor.bearings", self.bearings, "at two different places")
        for k, point in enumerate(self.points):
            if point.on == "tub" and not tub:
                raise InputError(f"points.{k}.on", point.on, "drum or axis for a rotor without a tub")
        if self.cabinet is not None:
            require_standing(self.cabinet, self.frame)
            margins(self.cabinet, self.resting, self.resting)

    @cached_property
    def frame(self) -> Frame:
        """Directions of the rotor."""
        return frame_of(self.rotor, self.vertical)

    @cached_property
    def holders(self) -> tuple[Holder, ...]:
        """Springs, dampers and supports."""
        return holders_of(self.rotor)

    @cached_property
    def weights(self) -> tuple[Weight, ...]:
        """Masses of rotor, liquid and balls."""
        return weights_of(self.rotor, self.fills, self.frame, self.races)

    @cached_property
    def pull(self) -> Array:
        """Acceleration of gravity along x, y, z, m/s^2, shape (3,)."""
        found = np.zeros(3)
        found[self.frame.up] = -self.gravity
        return found

    @cached_property
    def sunk(self) -> Array:
        """Coordinates by which the weight moves the rotor on its springs at rest, shape (n,).

        Of many springs each takes its share by its stiffness [theory: loads, eq. 3]; where nothing is springy
        the weight moves nothing.
        """
        load = sum(
            (weight.mass * self.frame.moving(weight.position).T @ self.pull for weight in self.weights),
            np.zeros(self.frame.body.shape[1]),
        )
        return np.asarray(np.linalg.lstsq(self.rotor.system().stiffness, load, rcond=1e-12)[0])

    @cached_property
    def resting(self) -> FloorForce:
        """Force of the floor under each foot at rest, shape (f,)."""
        assert self.cabinet is not None
        return floor_forces(self.cabinet, self.frame, *self._weight)

    @cached_property
    def _weight(self) -> tuple[Array, Array]:
        """Force and moment of all weights on the cabinet, its own among them."""
        assert self.cabinet is not None
        force, moment = self.cabinet.mass * self.pull, np.cross(self.cabinet.centre, self.pull)
        moment = self.cabinet.mass * moment
        for weight in self.weights:
            force = force + weight.mass * self.pull
            moment = moment + weight.mass * np.cross(weight.position, self.pull)
        return force, moment

    def holding(self, place: Array, rate: Array) -> Array:
        """Force of the moving rotor on the cabinet in each holder, weights left out [theory: loads, eq. 2].

        Along x, y, z, N, shape (..., h, 3); coordinates count from the equilibrium at rest.
        """
        found = [
            place @ (holder.stiffness @ self.frame.moving(holder.position)).T
            + rate @ (holder.damping @ self.frame.moving(holder.position)).T
            for holder in self.holders
        ]
        return np.stack(found, axis=-2)

    def on_cabinet(self, place: Array, rate: Array) -> tuple[Array, Array]:
        """Force and moment of the moving rotor on the cabinet, weights left out [theory: loads, eq. 4].

        N and N m about the origin of the rotor's coordinates, shape (..., 3) each.
        """
        forces = self.holding(place, rate)
        places = np.array([holder.position for holder in self.holders])
        return forces.sum(axis=-2), np.cross(places, forces).sum(axis=-2)

    def displacement(self, point: Point, place: Array, angle: Array) -> Array:
        """Displacement of a point along x, y, z, m, shape (..., 3) [theory: loads, eq. 1].

        The drum has turned by the angle, rad, shape (...).
        """
        frame = self.frame
        if point.on == "tub":
            return np.asarray(place @ frame.moving(point.position).T)
        centre = frame.on_axis(point.position[frame.along])
        moved = np.asarray(place @ frame.moving(centre).T)
        if point.on == "axis":
            return moved
        first, second = frame.across
        arm = np.subtract(point.position, centre)
        turning = (arm[first] + 1j * arm[second]) * np.exp(1j * angle)
        spoke = np.zeros((*np.shape(angle), 3))
        spoke[..., first], spoke[..., second] = turning.real, turning.imag
        lean = place @ frame.body[3:].T
        # A turn about the axis is a part of the spin.
        lean[..., frame.along] = 0.0
        return np.asarray(moved + np.cross(lean, spoke))

    def loads(self, place: Array, rate: Array, acceleration: Array, angle: Array) -> Loads:
        """Forces and clearances at some moments.

        Coordinates count from the equilibrium at rest, shape (..., n); the drum has turned by the angle, rad.
        """
        still = self.holding(self.sunk, np.zeros_like(self.sunk))
        holder = np.linalg.norm(self.holding(place, rate) + still, axis=-1)
        shape = holder.shape[:-1]
        moved, clearance = np.zeros((*shape, len(self.points))), np.zeros((*shape, len(self.points)))
        for k, point in enumerate(self.points):
            shift = self.displacement(point, place, angle)
            moved[..., k] = np.linalg.norm(shift, axis=-1)
            clearance[..., k] = np.nan if point.gap is None else point.gap - self._towards(point, shift)
        floor = margin = None
        if self.cabinet is not None:
            force, moment = self.on_cabinet(place, rate)
            weight, lever = self._weight
            floor = floor_forces(self.cabinet, self.frame, force + weight, moment + lever)
            margin = margins(self.cabinet, floor, self.resting)
        bearing = self._bearings(place, rate, acceleration)
        return Loads(holder, bearing, moved, clearance, floor, margin)

    def _towards(self, point: Point, shift: Array) -> Array:
        """How far a point has come towards the housing, m."""
        if point.direction is None:
            return np.asarray(np.hypot(*(shift[..., way] for way in self.frame.across)))
        way = np.array(point.direction)
        return np.asarray(shift @ (way / np.linalg.norm(way)))

    def _bearings(self, place: Array, rate: Array, acceleration: Array) -> Array:
        """Size of the force in each bearing, N, shape (..., 2); (..., 0) where they are not known."""
        if self.bearings is None or not isinstance(self.rotor, Tub):
            return np.zeros((*place.shape[:-1], 0))
        load = hub_load(self.rotor, place, rate, acceleration) + weight_load(self.weights, self.pull)
        return np.asarray(np.linalg.norm(bearing_forces(self.rotor, self.bearings, load), axis=-1))
