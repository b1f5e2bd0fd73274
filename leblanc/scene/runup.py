"""The run-up of a scene: a ramp of the speed, or a motor that drives it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import Field

from leblanc import units
from leblanc.scene.schema.part import Conflict, Part
from leblanc.scene.schema.rules import Inertia, Quantity, Speed, Truth, entries, quantity, whole

MAX_POINTS = 1000  # of a motor's curve

_RATE = Quantity(units.ANGULAR_ACCELERATION, 1e-9, 1e9)
_MotorSpeed = Annotated[float, quantity(units.ANGULAR_SPEED, 0.0, 1e6)]
_Torque = Annotated[float, quantity(units.TORQUE, -1e9, 1e9)]


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
            text = f"a list of {len(speeds)} torques, one for each of runup.motor.speeds"
            yield Conflict(("torques",), text)


class Runup(Part):
    """A ramp of the spin speed, then held; or the speed that a motor reaches."""

    start: Speed = Field(description="speed at the beginning")
    stop: Speed = Field(description="speed that the ramp reaches, above start")
    rate: Annotated[float | None, quantity(units.ANGULAR_ACCELERATION, 1e-9, 1e9)] = Field(
        None, description="at which the speed rises; left out where a motor drives"
    )
    motor: Motor | None = Field(None, description="that drives the rotor in place of a given rate")
    duration: Annotated[float, quantity(units.TIME, 1e-9, 1e9)] = Field(
        description="of ramp and hold together"
    )
    cells: Annotated[int, whole(8, 65536)] = Field(128, description="of each liquid layer round its wall")
    back: Truth = Field(False, description="true: down again at the same rate")
    dispersion: Truth = Field(False, description="whether the waves of the layers disperse")
    samples: Annotated[int, whole(10, 1_000_000)] = Field(2000, description="of the results over time")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """The ramp rises; a motor takes the place of its rate."""
        if {"start", "stop"} <= values.keys() and values["stop"] <= values["start"]:
            yield Conflict(("stop",), f"above runup.start, {values['start']:g} rad/s")
        if "motor" not in given:
            if "rate" not in given:
                yield Conflict(("rate",), f"given: {_RATE.allowed}")
            return
        if "rate" in given:
            yield Conflict(("rate",), "left out where runup.motor is given")
        if given.get("back") is True:
            yield Conflict(("back",), "false where runup.motor is given")
