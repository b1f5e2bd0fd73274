"""The table of a run-up: a ramp of the speed, or a motor that drives it."""

from __future__ import annotations

import itertools
from typing import Annotated

from pydantic import BeforeValidator, ValidationInfo, field_validator

from leblanc import units
from leblanc.scene.rules import Entries, Flag, Inertia, Quantity, Refused, Speed, Table, Whole

MAX_POINTS = 1000  # of a motor's curve

_RATE = BeforeValidator(Quantity(units.ANGULAR_ACCELERATION, 1e-9, 1e9))
_MotorSpeed = Annotated[float, BeforeValidator(Quantity(units.ANGULAR_SPEED, 0.0, 1e6))]
_Torque = Annotated[float, BeforeValidator(Quantity(units.TORQUE, -1e9, 1e9))]


class MotorTable(Table):
    """motor = { ... }."""

    inertia: Inertia
    speeds: Annotated[
        tuple[_MotorSpeed, ...], BeforeValidator(Entries(2, MAX_POINTS, "rising angular speeds"))
    ]
    torques: Annotated[tuple[_Torque, ...], BeforeValidator(Entries(2, MAX_POINTS, "torques, one a speed"))]

    @field_validator("speeds")
    @classmethod
    def _rising(cls, value: tuple[float, ...]) -> tuple[float, ...]:
        if any(later <= earlier for earlier, later in itertools.pairwise(value)):
            raise Refused("a list in which every angular speed is above the one before")
        return value

    @field_validator("torques")
    @classmethod
    def _one_for_each_speed(cls, value: tuple[float, ...], info: ValidationInfo) -> tuple[float, ...]:
        speeds = info.data.get("speeds")
        if speeds is not None and len(value) != len(speeds):
            raise Refused(f"a list of {len(speeds)} torques, one for each of runup.motor.speeds")
        return value


class RunupTable(Table):
    """[runup]."""

    start: Speed
    stop: Speed
    rate: Annotated[float | None, _RATE] = None
    motor: MotorTable | None = None
    duration: Annotated[float, BeforeValidator(Quantity(units.TIME, 1e-9, 1e9))]
    cells: Annotated[int, BeforeValidator(Whole(8, 65536))] = 128
    back: Annotated[bool, BeforeValidator(Flag())] = False
    dispersion: Annotated[bool, BeforeValidator(Flag())] = False
    samples: Annotated[int, BeforeValidator(Whole(10, 1_000_000))] = 2000

    @field_validator("stop")
    @classmethod
    def _above_start(cls, value: float, info: ValidationInfo) -> float:
        start = info.data.get("start")
        if start is not None and value <= start:
            raise Refused(f"above runup.start, {start:g} rad/s")
        return value
