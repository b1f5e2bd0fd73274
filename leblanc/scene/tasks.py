"""The tables [optimise] and [runup] of a scene: what its liquid is chosen for, and how its speed rises."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import Field, PlainValidator

from leblanc.core import units
from leblanc.scene.schema.part import Conflict, Part, allowed_at
from leblanc.scene.schema.rules import (
    SPEED,
    Inertia,
    Quantity,
    Refused,
    Span,
    Spans,
    Speed,
    Truth,
    Whole,
    entries,
    one_of,
    quantity,
    whole,
)

_GRADE = re.compile(r"\s*G\s*(\d+\.?\d*|\.\d+)\s*", re.ASCII)


class GradeRule:
    """A balance quality as a grade of ISO 21940-11, or as a velocity."""

    _velocity = Quantity(units.VELOCITY, 1e-6, 1e2)
    allowed = f'a grade such as "G 6.3", or {_velocity.allowed}'

    def __call__(self, value: object) -> float:
        """The velocity, m/s."""
        if isinstance(value, str) and (grade := _GRADE.fullmatch(value)):
            value = 1e-3 * float(grade[1])
        try:
            return self._velocity(value)
        except Refused as refused:
            raise Refused(self.allowed) from refused


# Objectives that are loads of the machine, see `leblanc.studies.optimise.objectives`.
LOADS = ("floor_force", "walking_margin", "point_clearance", "motor_torque")
OBJECTIVES = ("working_speed", "peak", "mean", "least_mass", "robust", *LOADS, "layout")
MEASURES = ("couplings", "separation")  # of a layout
LOADS_OVER = ("operating", "runup", "both")
MAX_DUTY = 1000
MAX_BALLS = 64  # in one race
MAX_SAMPLES = 100_000

_LENGTH = quantity(units.LENGTH, 1e-12, 1e3)
_Pair = tuple[float, float]
_Volumes = Annotated[_Pair, PlainValidator(Span(Quantity(units.VOLUME, 0.0, 1e9)))]

MAX_POINTS = 1000  # of a motor's curve

_RATE = Quantity(units.ANGULAR_ACCELERATION, 1e-9, 1e9)
_MotorSpeed = Annotated[float, quantity(units.ANGULAR_SPEED, 0.0, 1e6)]
_Torque = Annotated[float, quantity(units.TORQUE, -1e9, 1e9)]


class DutyPoint(Part):
    """A speed of a duty cycle and its share of the time."""

    speed: Speed = Field(description="spin speed")
    weight: Annotated[float, quantity(units.NUMBER, 1e-9, 1e9)] = Field(
        description="share of the time at it, of any sum"
    )


_Reach = Annotated[float, quantity(units.LENGTH, 0.0, 1e3)]


class Layout(Part):
    """How far the springs and dampers of a tub may move, and what for."""

    measure: Annotated[str, one_of(*MEASURES)] = Field(
        "couplings",
        description="what is made least: the squared couplings of stiffness and damping about the centre of "
        "mass (couplings), or how near natural frequencies come to a band of speeds (separation)",
    )
    reach: Annotated[tuple[_Reach, _Reach, _Reach], entries(3, 3, "lengths, along x, y, z")] = Field(
        (0.05, 0.1, 0.05), description="how far each place may move either way; 0 keeps it"
    )
    turn: Annotated[float, quantity(units.ANGLE, 0.0, 1.2)] = Field(
        math.radians(20.0),
        description="how far each direction may lean, in each of two ways across it; 0 keeps it",
    )
    band: Annotated[_Pair | None, PlainValidator(Span(Quantity(units.ANGULAR_SPEED, 1e-6, 1e6)))] = Field(
        None, description="running speeds for separation, the lower first; the scene's if left out"
    )
    sag: Annotated[float | None, quantity(units.LENGTH, 1e-9, 1e3)] = Field(
        None,
        description="largest sag of tub and drum under their weight; a tenth above the scene's if left out",
    )


_Counts = Annotated[tuple[int, int] | None, PlainValidator(Span(Whole(1, MAX_BALLS)))]
_Masses = Annotated[_Pair | None, PlainValidator(Span(Quantity(units.MASS, 1e-9, 1e9)))]
_Lengths = Annotated[_Pair | None, PlainValidator(Span(Quantity(units.LENGTH, 1e-6, 1e3)))]
_Drags = Annotated[_Pair | None, PlainValidator(Span(Quantity(units.DAMPING, 0.0, 1e15)))]


class BallRanges(Part):
    """Least and most of what is chosen of the balls of every race.

    What is left out stays as the scene has it.
    """

    count: _Counts = Field(None, description="how many balls")
    mass: _Masses = Field(None, description="of each ball, where the scene gives a mass")
    diameter: _Lengths = Field(None, description="of the balls, where the scene gives their density")
    drag: _Drags = Field(None, description="force on a ball over its speed in the drum")
    radius: _Lengths = Field(None, description="of the circle of the balls' centres")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Something is chosen; one of mass and diameter follows from the other."""
        if not given:
            yield Conflict(("count",), "given, or one of mass, diameter, drag, radius")
        if values.get("mass") is not None and values.get("diameter") is not None:
            yield Conflict(("diameter",), "left out where mass is given")


class Optimisation(Part):
    """What the liquid of a scene, its balls, or the layout of its mounts, is chosen for."""

    objective: Annotated[str, one_of(*OBJECTIVES)] = Field(
        "working_speed",
        description="what is made least: the amplitude at the working speed, its peak or its mean over the "
        "duty cycle, the mass of liquid that keeps a limit, the amplitude over ranges (robust), or a load, "
        "see loads_over: the largest force under a foot of the cabinet (floor_force), the share of its hold "
        "on the floor that the machine uses (walking_margin), the share of its gap that a point takes "
        "(point_clearance), the largest torque of the motor (motor_torque); or the mounts of a tub are "
        "chosen in place of its liquid (layout). Where there are balls these are chosen, for one of the "
        "first five",
    )
    working_speed: Annotated[float | None, SPEED] = Field(
        None, description="the last of the scene's speeds if left out"
    )
    steady: Truth = Field(
        False, description="the peak is that of the steady response even where the scene has a run-up"
    )
    duty: Annotated[tuple[DutyPoint, ...], entries(1, MAX_DUTY, "tables { speed = ..., weight = ... }")] = (
        Field((), description="speeds of the duty cycle; all of the scene's alike if left out")
    )
    vibration_limit: Annotated[float | None, _LENGTH] = Field(
        None,
        description="amplitude, zero to peak, for least_mass; if left out one per cent above the least "
        "possible, with balls a hundredth of the amplitude without them",
    )
    limit_at: Annotated[str, one_of("working_speed", "operating")] = Field(
        "working_speed", description="whether the limit holds at the working or at all operating speeds"
    )
    deflection: Annotated[float | None, _LENGTH] = Field(
        None, description="of the axis at the working speed, given; the rotor's own if left out"
    )
    unbalance: Annotated[
        _Pair | tuple[_Pair, ...] | None, PlainValidator(Spans(Quantity(units.UNBALANCE, 0.0, 1e9)))
    ] = Field(
        None,
        description="range for the objective robust: of the rotor's largest unbalance, with which all others "
        "grow by one factor; or a list of ranges, one for each, from which they are taken independently",
    )
    temperature: Annotated[_Pair | None, PlainValidator(Span(Quantity(units.TEMPERATURE, 150.0, 1000.0)))] = (
        Field(None, description="range of temperatures for the objective robust")
    )
    quantile: Annotated[float, quantity(units.NUMBER, 0.0, 1.0)] = Field(
        1.0, description="of the amplitudes over those ranges; 1 is the worst case"
    )
    samples: Annotated[int, whole(0, MAX_SAMPLES)] = Field(
        0, description="random samples of those ranges; a grid if 0"
    )
    seed: Annotated[int, whole(0, 2**63)] = Field(0, description="of the random samples")
    dry_patch: Truth = Field(True, description="whether the wall may be dry somewhere at the working speed")
    stable: Truth = Field(
        True,
        description="whether every small whirl must decay where the machine stays: at the working speed "
        "and those of the duty cycle, or at all operating speeds where a margin or a range of them is given",
    )
    stability_margin: Annotated[float | None, quantity(units.RATE, 0.0, 1e6)] = Field(
        None,
        description="least decay of every small whirl, at all operating speeds; with balls of all small "
        "motions, at the working speed unless operating is given; 0 if left out",
    )
    least_film: Annotated[float, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        5e-5,
        description="thinnest film that forms on a wall, by its mean depth: a chamber holds none or at least "
        "as much; 0 for no limit",
    )
    whirl_limit: Annotated[float | None, _LENGTH] = Field(
        None,
        description="largest self-excited whirl at the operating speeds; no limit if left out",
    )
    spill: Truth = Field(
        False, description="whether the liquid may reach a chamber's inner edge at the working speed"
    )
    operating: Annotated[_Pair | None, PlainValidator(Span(Quantity(units.ANGULAR_SPEED, 1e-6, 1e6)))] = (
        Field(None, description="range of operating speeds; the scene's if left out")
    )
    clearance: Annotated[float | None, _LENGTH] = Field(
        None, description="largest amplitude, zero to peak, at the operating speeds; no limit if left out"
    )
    loads_over: Annotated[str, one_of(*LOADS_OVER)] = Field(
        "operating",
        description="where loads are looked at: in steady turns at the operating speeds, over the run-up or "
        "programme in time, or both",
    )
    floor_force: Annotated[float | None, quantity(units.FORCE, 1e-9, 1e15)] = Field(
        None, description="largest force under any foot; no limit if left out"
    )
    walking_margin: Annotated[float | None, quantity(units.NUMBER, 0.0, 1.0)] = Field(
        None,
        description="least margin against walking: 1 at rest, 0 where a foot slips or lifts off; no limit if "
        "left out",
    )
    slip_margin: Annotated[float | None, quantity(units.NUMBER, 0.0, 1.0)] = Field(
        None, description="the same against slipping as a whole alone; no limit if left out"
    )
    point_clearance: Annotated[float | None, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        None, description="least clearance of every point with a gap; no limit if left out"
    )
    motor_torque: Annotated[float | None, quantity(units.TORQUE, 1e-9, 1e9)] = Field(
        None, description="largest torque of the motor; no limit if left out"
    )
    balance_quality: Annotated[float | None, PlainValidator(GradeRule())] = Field(
        None,
        description="grade that the unbalance of rotor and liquid together keeps at the working speed; no "
        "limit if left out",
    )
    volumes: Annotated[tuple[_Volumes, ...], entries(1, 1000, "pairs of volumes, one for each chamber")] = (
        Field((), description="least and most of each chamber; from nothing to what it holds if left out")
    )
    layout: Layout | None = Field(
        None, description="for the objective layout of a tub; its defaults if left out"
    )
    balls: BallRanges | None = Field(
        None,
        description="ranges in which the balls of all races are chosen; if left out 2 to 8 balls of a "
        "quarter to four times the mass, or half to twice the diameter, and a hundredth to a hundred times "
        "the drag",
    )


def pairs_of(ranges: _Pair | tuple[_Pair, ...]) -> tuple[_Pair, ...]:
    """Ranges of unbalance one by one; a single one is the first of one."""
    found: list[_Pair] = []
    for entry in ranges:
        if not isinstance(entry, tuple):
            low, high = ranges
            assert isinstance(low, float) and isinstance(high, float)
            return ((low, high),)
        found.append(entry)
    return tuple(found)


class TorqueCurve(Part):
    """What a motor can give at most."""

    speeds: Annotated[tuple[_MotorSpeed, ...], entries(2, MAX_POINTS, "rising angular speeds")] = Field(
        description="at which its torque is given"
    )
    torques: Annotated[tuple[_Torque, ...], entries(2, MAX_POINTS, "torques, one a speed")] = Field(
        description="largest at those speeds, straight lines between them"
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Speeds rise, and each has its torque."""
        return Motor.conflicts(values, given)


class Motor(Part):
    """A motor that drives the rotor."""

    inertia: Inertia = Field(description="of all that it turns, about the axis, without the liquid")
    speeds: Annotated[tuple[_MotorSpeed, ...], entries(2, MAX_POINTS, "rising angular speeds")] = Field(
        description="at which its torque is given"
    )
    torques: Annotated[tuple[_Torque, ...], entries(2, MAX_POINTS, "torques, one a speed")] = Field(
        description="at those speeds, straight lines between them"
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Speeds rise, and each has its torque."""
        speeds, torques = values.get("speeds"), values.get("torques")
        if speeds is not None and any(later <= earlier for earlier, later in itertools.pairwise(speeds)):
            yield Conflict(("speeds",), "a list in which every angular speed is above the one before")
        if speeds is not None and torques is not None and len(torques) != len(speeds):
            text = f"a list of {len(speeds)} torques, one for each of the motor's speeds"
            yield Conflict(("torques",), text)


BORES = ("none", "enstrophy")
CAPTURES = ("carried", "drum", "riding")


_IMPLIED: Any = None  # a value that others say where it is left out


class Runup(Part):
    """A ramp of the spin speed, then held; or the speed that a motor reaches."""

    start: Speed = Field(
        _IMPLIED, description="speed at the beginning; of start, stop, rate and ramp_time three"
    )
    stop: Speed = Field(_IMPLIED, description="speed that the ramp reaches, above start")
    rate: Annotated[float | None, PlainValidator(_RATE)] = Field(
        None, description="at which the speed rises; left out where a motor drives"
    )
    ramp_time: Annotated[float | None, quantity(units.TIME, 1e-9, 1e9)] = Field(
        None, description="that the ramp takes; left out where a motor drives"
    )
    motor: Motor | None = Field(None, description="that drives the rotor in place of a given rate")
    duration: Annotated[float, quantity(units.TIME, 1e-9, 1e9)] = Field(
        _IMPLIED,
        description="of ramp and hold together; of the ramp alone if left out, given where a motor drives",
    )
    cells: Annotated[int, whole(8, 65536)] = Field(128, description="of each liquid layer round its wall")
    back: Truth = Field(False, description="true: down again at the same rate")
    dispersion: Truth = Field(False, description="whether the waves of the layers disperse")
    bore: Annotated[str, one_of(*BORES)] = Field(
        "none",
        description="turbulence that hydraulic jumps of the layers leave behind: nothing (none), or "
        "fluctuations that press "
        "on the liquid, are spun up and decay (enstrophy)",
    )
    capture: Annotated[str, one_of(*CAPTURES)] = Field(
        "carried",
        description="how liquid at the bottom of a horizontal chamber becomes an annular layer: drawn over "
        "the top by its walls and baffles (carried); the same with twice their grip, the earliest to be "
        "expected (drum); or at rest in the drum where its centrifugal field beats gravity (riding)",
    )
    samples: Annotated[int, whole(10, 1_000_000)] = Field(2000, description="of the results over time")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """The ramp rises, of which three values say the fourth; a motor takes the place of its rate."""
        if "motor" in given:
            for key in ("rate", "ramp_time"):
                if key in given:
                    yield Conflict((key,), "left out where runup.motor is given")
            for key in ("start", "stop", "duration"):
                if key not in given:
                    yield Conflict((key,), f"given: {allowed_at(cls.model_fields[key])}")
            if given.get("back") is True:
                yield Conflict(("back",), "false where runup.motor is given")
        else:
            left = [key for key in _RAMP if key not in given]
            if not left:
                yield Conflict(("ramp_time",), "left out where start, stop and rate are given")
            elif len(left) > 1:
                # What most files say.
                key = next(key for key in ("start", "stop", "rate") if key in left)
                text = f"given: {allowed_at(cls.model_fields[key])}"
                more = "; duration is that of ramp and hold together" if "duration" in given else ""
                yield Conflict((key,), f"{text}; three of {', '.join(_RAMP)} say the fourth{more}")
            elif set(_RAMP) - set(left) <= values.keys():
                values = dict(values) | _ramp(values)
                if left[0] in ("start", "stop") and not _FIRST <= values[left[0]] <= _LAST:
                    text = f"such that the ramp runs from {_FIRST:g} to {_LAST:g} rad/s"
                    yield Conflict(("ramp_time",), text)
                    return
        start, stop, rate = (values.get(key) for key in _RAMP[:3])
        if start is not None and stop is not None and stop <= start:
            yield Conflict(("stop",), f"above runup.start, {start:g} rad/s")
        elif rate is not None and "rate" not in given and not _RATE.low <= rate <= _RATE.high:
            yield Conflict(("ramp_time",), f"such that the rate is {_RATE.allowed}")

    def implied(self) -> dict[str, Any]:
        """The fourth value of the ramp, and its time where nothing is held."""
        if self.motor is not None:
            return {}
        found = _ramp(self.__dict__)
        if "duration" in self.model_fields_set:
            return found
        whole = self.ramp_time
        if whole is None and self.rate is not None:
            whole = (self.stop - self.start) / self.rate
        return found | {"duration": whole}


_RAMP = ("start", "stop", "rate", "ramp_time")
_FIRST, _LAST = 1e-6, 1e6  # rad/s


def _ramp(values: Mapping[str, Any]) -> dict[str, Any]:
    """What of start, stop and rate is left out of a ramp; nothing where its time is."""
    start, stop, rate, time = (values[key] for key in _RAMP)
    if time is None:
        return {}
    if rate is None:
        return {"rate": (stop - start) / time}
    return {"start": stop - rate * time} if start is None else {"stop": start + rate * time}
