"""A spin programme: the speed is driven, held, or left to itself while the drum coasts, stage after stage."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive

# Of the highest speed: a drum that turns more slowly counts as standing. Angles need a spin, and with the
# square of it the unbalance has lost all its force.
FLOOR = 0.005


@dataclass(frozen=True)
class Stage:
    """One part of a programme: a speed that is given, or a drum that turns freely."""

    stop: float | None = None  #: speed at the end, rad/s; None where the time alone ends it
    #: at which a given speed changes, rad/s^2, without a sign; None where the time is given
    rate: float | None = None
    #: s; None where speed and rate give it; of a coast to a speed the longest time
    duration: float | None = None
    free: bool = False  #: the motor is off

    def __post_init__(self) -> None:
        if self.stop is not None:
            require_not_negative("stop", self.stop)
        for name in ("rate", "duration"):
            value = getattr(self, name)
            if value is not None:
                require_positive(name, value)
        if self.duration is None and (self.rate is None or self.stop is None or self.free):
            raise InputError("duration", None, "given, or the speed at the end and a rate of a driven stage")
        if self.rate is not None and self.duration is not None:
            raise InputError("rate", self.rate, "left out where the duration is given")

    def lasts(self, spin: float, stop: float) -> float:
        """How long a stage with a given speed lasts, s."""
        if self.duration is not None:
            return self.duration
        assert self.rate is not None
        return abs(stop - spin) / self.rate


def require_curve(speeds: tuple[float, ...], torques: tuple[float, ...]) -> None:
    """Refuse what is no torque curve of a motor."""
    if len(speeds) < 2 or len(speeds) != len(torques):
        raise InputError("motor.torques", len(torques), "one for each of at least two speeds")
    if not all(math.isfinite(value) for value in (*speeds, *torques)):
        raise InputError("motor.torques", torques, "finite numbers")
    if any(after <= before for before, after in pairwise(speeds)):
        raise InputError("motor.speeds", speeds, "ascending")


@dataclass(frozen=True)
class Programme:
    """Stages one after the other, each from the speed that the one before has reached."""

    start: float  #: speed at the beginning, rad/s; a drum at rest begins at the `floor`
    stages: tuple[Stage, ...]  #: at least one
    #: of drum and motor about the axis without the liquid, kg m^2; None where nothing coasts
    inertia: float | None = None
    drag_torque: float = 0.0  #: of bearings and belt on a coasting drum, N m, the same at every speed
    #: of what grows with the speed: alone it slows the drum without liquid at this rate, 1/s
    drag_rate: float = 0.0
    #: speeds, rad/s, ascending, and the largest torques of the motor there, N m, straight lines between them;
    #: None for one that gives what the stages ask
    motor: tuple[tuple[float, ...], tuple[float, ...]] | None = None
    limit: float = 600.0  #: longest time of a stage whose speed the motor does not reach, s

    def __post_init__(self) -> None:
        for name in ("start", "drag_torque", "drag_rate"):
            require_not_negative(name, getattr(self, name))
        if not self.stages:
            raise InputError("stages", 0, "at least one")
        if not self.highest > 0.0:
            raise InputError("stages", self.highest, "stages of which one goes above 0 rad/s")
        if self.inertia is not None:
            require_positive("inertia", self.inertia)
        elif self.motor is not None or any(stage.free for stage in self.stages):
            raise InputError("inertia", None, "given where the drum coasts or a motor limits its speed")
        if self.motor is not None:
            require_curve(*self.motor)

    @property
    def highest(self) -> float:
        """Highest speed of the programme, rad/s."""
        return max(self.start, *(stage.stop or 0.0 for stage in self.stages if not stage.free), 0.0)

    @property
    def floor(self) -> float:
        """Speed below which the drum counts as standing, rad/s."""
        return FLOOR * self.highest

    def target(self, stage: Stage, spin: float) -> float:
        """Speed at which a stage ends, or below which it cannot go, rad/s."""
        if stage.stop is None:
            return self.floor if stage.free else spin
        return max(stage.stop, self.floor)

    def drag(self) -> Array:
        """Speeds and torques of the drag on a coasting drum, as a motor's curve, shape (2, 2)."""
        # Far above every speed, for a curve goes on level beyond its ends.
        far = 10.0 * self.highest
        viscous = (self.inertia or 0.0) * self.drag_rate
        return np.array([[0.0, far], [-self.drag_torque, -self.drag_torque - viscous * far]])

    def net(self) -> Array:
        """Speeds and torques of the motor less those of the drag, shape (2, k) [theory: coupling, eq. 16]."""
        assert self.motor is not None
        drag, known = self.drag(), np.array(self.motor[0])
        speeds = np.union1d(known, drag[0])
        return np.array([speeds, np.interp(speeds, *self.motor) + np.interp(speeds, *drag)])

    def corners(self) -> Array:
        """Times at which stages begin and end and the speeds there, shape (2, k).

        Estimates where the drum coasts: those of a drum without liquid that does not whirl.
        """
        time, spin = 0.0, max(self.start, self.floor)
        points = [(time, spin)]
        for stage in self.stages:
            stop = self.target(stage, spin)
            if stage.free:
                lasts, stop = self._coast(stage, spin, stop)
            else:
                lasts = stage.lasts(spin, stop)
            if lasts > 0.0:
                time, spin = time + lasts, stop
                points.append((time, spin))
        return np.array(points).T

    def _coast(self, stage: Stage, spin: float, stop: float) -> tuple[float, float]:
        """Duration of a coast by drag alone and the speed at its end [theory: coupling, eq. 14]."""
        assert self.inertia is not None and stage.duration is not None
        steady, rate = self.drag_torque / self.inertia, self.drag_rate
        if spin <= stop:
            return 0.0, spin
        if rate > 0.0:
            lasts = math.log1p(rate * (spin - stop) / (steady + rate * stop)) / rate
        else:
            lasts = (spin - stop) / steady if steady > 0.0 else math.inf
        if lasts <= stage.duration:
            return lasts, stop
        if rate > 0.0:
            after = spin + (spin + steady / rate) * math.expm1(-rate * stage.duration)
        else:
            after = spin - steady * stage.duration
        return stage.duration, after
