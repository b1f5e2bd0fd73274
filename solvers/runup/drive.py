"""What turns the rotor: a given speed over time, or a motor with its torque curve."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_positive


@dataclass(frozen=True)
class Ramp:
    """Spin speed that rises at a rate, is held, and may fall again at the same rate.

    Parameters
    ----------
    start, stop : rad/s
    rate : rad/s^2
    duration : of rise and hold together, s; a rise that takes longer is cut there
    back : down to the start again afterwards

    Raises
    ------
    InputError : a value that is not positive, a stop that is not above the start
    """

    start: float
    stop: float
    rate: float
    duration: float
    back: bool = False

    def __post_init__(self) -> None:
        for name in ("start", "stop", "rate", "duration"):
            require_positive(name, getattr(self, name))
        if self.stop <= self.start:
            raise InputError("stop", self.stop, f"above the start, {self.start:g} rad/s")

    def corners(self) -> Array:
        """Times at which the rate changes, from 0 to the end, and the speeds there, shape (2, k)."""
        rise = min((self.stop - self.start) / self.rate, self.duration)
        top = min(self.stop, self.start + self.rate * rise)
        points = [(0.0, self.start), (rise, top)]
        if self.duration > rise:
            points.append((self.duration, top))
        if self.back:
            points.append((self.duration + rise, self.start))
        return np.array(points).T


@dataclass(frozen=True)
class Motor:
    """A motor on the rotor's axis: the spin speed answers.

    Parameters
    ----------
    start : spin speed at the beginning, rad/s
    inertia : of rotor and motor about the axis, kg m^2
    speeds, torques : points of the torque curve, rad/s ascending and N m; straight lines between them
    duration : s

    Raises
    ------
    InputError : a value that is not positive, a curve of less than two points or not ascending
    """

    start: float
    inertia: float
    speeds: tuple[float, ...]
    torques: tuple[float, ...]
    duration: float

    def __post_init__(self) -> None:
        for name in ("start", "inertia", "duration"):
            require_positive(name, getattr(self, name))
        if len(self.speeds) < 2 or len(self.speeds) != len(self.torques):
            raise InputError("motor.torques", len(self.torques), "one for each of at least two speeds")
        if not all(math.isfinite(value) for value in (*self.speeds, *self.torques)):
            raise InputError("motor.torques", self.torques, "finite numbers")
        if any(after <= before for before, after in zip(self.speeds, self.speeds[1:], strict=False)):
            raise InputError("motor.speeds", self.speeds, "ascending")

    def corners(self) -> Array:
        """Beginning and end with the starting speed, shape (2, 2)."""
        return np.array([[0.0, self.duration], [self.start, self.start]])


Drive = Ramp | Motor


def torque_curve(drive: Drive) -> Array:
    """Speeds and torques of a motor, shape (2, k); k = 0 for a ramp."""
    if isinstance(drive, Ramp):
        return np.zeros((2, 0))
    return np.array([drive.speeds, drive.torques], dtype=float)
