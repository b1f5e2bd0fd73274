"""A rigid cabinet on its feet: the force of the floor under each, and the margin against walking.

The cabinet stands still: what the rotor does to it goes to the floor at once. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.rotor.loads.frame import Frame
from solvers.rotor.tub import Vector

_LEVEL = 1e-6  # of the distance between feet: how far one may stand above another
_LINE = 1e-6  # of that distance: how far the feet must be from a straight line
_ALIKE = 1e-9  # of the largest force at rest: what rounding may make of equal ones


@dataclass(frozen=True)
class Cabinet:
    """A rigid cabinet that stands on a level floor."""

    mass: float  #: without the rotor, kg
    centre: Vector  #: its centre of mass, in the rotor's coordinates at rest, m
    feet: tuple[Vector, ...]  #: where the feet touch the floor, at least three, shape (f, 3), m
    friction: float  #: coefficient between feet and floor

    def __post_init__(self) -> None:
        require_not_negative("cabinet.mass", self.mass)
        require_positive("cabinet.friction", self.friction)
        if len(self.feet) < 3 or not np.isfinite(self.feet).all():
            raise InputError("cabinet.feet", len(self.feet), "at least three, at finite places")


@dataclass(frozen=True)
class FloorForce:
    """What the floor does to f feet."""

    vertical: Array  #: upwards, below 0 where the floor would have to pull, N, shape (..., f)
    across: Array  #: along the floor, as far as friction allows it, N, shape (..., f)
    push: Array  #: the whole force along the floor, N, shape (...)


@dataclass(frozen=True)
class Margins:
    """How far a machine is from walking: 1 at rest, 0 where it begins [theory: loads, eq. 9-11]."""

    lift_off: Array  #: least vertical force under a foot over what it is at rest, shape (...)
    slip: Array  #: friction that the whole machine has left, over all that it has at rest, shape (...)
    foot: Array  #: friction that each foot has left, over all that it has at rest, shape (..., f)

    @property
    def walking(self) -> Array:
        """Least of all margins, shape (...)."""
        return np.asarray(np.minimum(np.minimum(self.lift_off, self.slip), self.foot.min(axis=-1)))


def plan(frame: Frame) -> tuple[int, int]:
    """Numbers of the two directions along the floor; the first, the second and up are right-handed."""
    return (frame.up + 1) % 3, (frame.up + 2) % 3


def require_standing(cabinet: Cabinet, frame: Frame) -> None:
    """Refuse feet on which no machine stands.

    An `InputError` where they are not on one level, or lie on a straight line.
    """
    feet = np.array(cabinet.feet)
    size = float(np.ptp(feet, axis=0).max())
    if float(np.ptp(feet[:, frame.up])) > _LEVEL * size:
        raise InputError("cabinet.feet", "at different heights", "all at one height: the floor is level")
    flat = feet[:, plan(frame)] - feet[:, plan(frame)].mean(axis=0)
    if np.linalg.svd(flat, compute_uv=False)[-1] <= _LINE * size:
        raise InputError("cabinet.feet", "on a straight line", "not all on one straight line")


def floor_forces(cabinet: Cabinet, frame: Frame, force: Array, moment: Array) -> FloorForce:
    """Force of the floor under each foot [theory: loads, eq. 5-8].

    From the force (N) and moment (N m, about the origin of the rotor's coordinates) of all that acts on the
    cabinet, weights included, shape (..., 3); shares of more than three feet are those of least squares.
    """
    first, second = plan(frame)
    up = frame.up
    feet = np.array(cabinet.feet)
    height = np.zeros(3)
    height[up] = feet[:, up].mean()
    about = moment - np.cross(height, force)
    a, b = feet[:, first], feet[:, second]
    carrying = np.stack([np.ones(a.size), b, -a])
    load = -np.stack([force[..., up], about[..., first], about[..., second]], axis=-1)
    vertical = load @ np.linalg.pinv(carrying).T
    pressing = np.maximum(vertical, 0.0)
    whole = pressing.sum(axis=-1, keepdims=True)
    share = np.divide(pressing, whole, out=np.full(pressing.shape, 1.0 / a.size), where=whole > 0.0)
    # About the centre of the load the feet take the force along the floor together, and its moment.
    east = a - (share * a).sum(axis=-1, keepdims=True)
    north = b - (share * b).sum(axis=-1, keepdims=True)
    push_a, push_b = -force[..., first], -force[..., second]
    twist = -about[..., up] - ((share * a).sum(axis=-1) * push_b - (share * b).sum(axis=-1) * push_a)
    stiff = (share * (np.square(east) + np.square(north))).sum(axis=-1)
    turn = np.divide(twist, stiff, out=np.zeros_like(twist), where=stiff > 0.0)[..., None]
    across = share * np.hypot(push_a[..., None] - turn * north, push_b[..., None] + turn * east)
    return FloorForce(vertical, across, np.hypot(push_a, push_b))


def margins(cabinet: Cabinet, floor: FloorForce, rest: FloorForce) -> Margins:
    """How far a machine is from walking [theory: loads, eq. 9-11].

    From the floor's forces with the rotor in motion and at rest; an `InputError` for a foot that carries
    nothing at rest, or without gravity.
    """
    if not rest.vertical.any():
        raise InputError("gravity", 0.0, "above 0 with a cabinet: without weight no foot holds to the floor")
    if not np.all(rest.vertical > 0.0):
        # Feet that press alike to rounding are told by the first of them, on any processor.
        alike = _ALIKE * float(np.abs(rest.vertical).max())
        weak = int(np.argmax(rest.vertical <= rest.vertical.min() + alike))
        raise InputError(
            f"cabinet.feet.{weak}",
            f"{float(rest.vertical[weak]):.4g} N at rest",
            "where the machine's weight presses on it: its centre of mass must lie between the feet",
        )
    grip = cabinet.friction * floor.vertical - floor.across
    total = cabinet.friction * floor.vertical.sum(axis=-1) - floor.push
    return Margins(
        lift_off=(floor.vertical / rest.vertical).min(axis=-1),
        slip=total / (cabinet.friction * rest.vertical.sum(axis=-1)),
        foot=grip / (cabinet.friction * rest.vertical),
    )
