"""The table [programme] of a scene: the way of its speed, in place of the ramp of [runup]."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import astuple
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, PlainValidator

from leblanc.core import units
from leblanc.core.units import in_rpm, number
from leblanc.scene.programme.steps import MAX_STEPS, SPEED, Step, StepList, StepRule
from leblanc.scene.rows import Row, curve_words, row, rpm
from leblanc.scene.schema.part import Conflict, Part
from leblanc.scene.schema.rules import Inertia, Truth, one_of, quantity, whole
from leblanc.scene.tasks import BORES, CAPTURES, TorqueCurve

_STEPS = StepList(1, MAX_STEPS, 'steps such as "to 90 rpm in 4 s"')


class Programme(Part):
    """A spin programme: speeds that are driven, held, or left to a drum that coasts; in place of [runup]."""

    start: Annotated[float, PlainValidator(SPEED)] = Field(
        0.0, description="speed at the beginning; 0 is a drum at rest"
    )
    steps: Annotated[
        tuple[Annotated[Step, PlainValidator(StepRule())], ...],
        BeforeValidator(_STEPS),
    ] = Field(description="one after the other, each from the speed that the one before has reached")
    inertia: Inertia | None = Field(
        None,
        description="of drum and motor about the axis without the liquid, for a coast or a motor; that of "
        "the rotor about its axis if left out",
    )
    motor: TorqueCurve | None = Field(
        None, description="that drives the drum; without one it gives what the steps ask"
    )
    drag_torque: Annotated[float, quantity(units.TORQUE, 0.0, 1e9)] = Field(
        0.0, description="of bearings and belt, the same at every speed"
    )
    drag_rate: Annotated[float, quantity(units.RATE, 0.0, 1e6)] = Field(
        0.0, description="at which drag that grows with the speed alone would slow the drum"
    )
    coast_limit: Annotated[float, quantity(units.TIME, 1e-9, 1e9)] = Field(
        600.0, description="longest time of a coast to a speed, or of a rise that the motor limits"
    )
    cells: Annotated[int, whole(8, 65536)] = Field(128, description="of each liquid layer round its wall")
    dispersion: Truth = Field(False, description="whether the waves of the layers disperse")
    bore: Annotated[str, one_of(*BORES)] = Field(
        "none", description="turbulence that hydraulic jumps of the layers leave behind, as in runup.bore"
    )
    capture: Annotated[str, one_of(*CAPTURES)] = Field(
        "carried",
        description="pool-annulus transition of a horizontal chamber, as in runup.capture",
    )
    samples: Annotated[int, whole(10, 1_000_000)] = Field(2000, description="of the results over time, about")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Each step changes something, and one of them is faster than 0."""
        if not {"start", "steps"} <= values.keys():
            return
        speed: float | None = values["start"]
        fastest = values["start"]
        for k, step in enumerate(values["steps"]):
            if step.kind == "coast":
                if step.speed is not None and speed is not None and step.speed >= speed:
                    yield Conflict(("steps", k), f"a coast to a speed below the one before, {in_rpm(speed)}")
                speed = step.speed
            elif step.kind == "to":
                if step.speed == speed:
                    text = f"to another speed than the one before, {in_rpm(step.speed)}"
                    yield Conflict(("steps", k), text)
                speed, fastest = step.speed, max(fastest, step.speed)
        if fastest == 0.0:
            yield Conflict(("steps",), "a list with a step to a speed above 0")

    @property
    def coasts(self) -> bool:
        """The drum turns freely in some step."""
        return any(step.kind == "coast" for step in self.steps)

    def content(self) -> dict[str, Any]:
        """The steps for the fingerprint of a scene."""
        return self.model_dump(exclude={"steps"}) | {"steps": [astuple(step) for step in self.steps]}

    def rows(self) -> list[Row]:
        """Rows of the programme, for readers."""
        found = [row("Programme from", rpm(self.start), "programme.start")]
        found += [
            row(f"Programme step {k + 1}", step.words(), f"programme.steps.{k}")
            for k, step in enumerate(self.steps)
        ]
        if self.motor is not None:
            text = curve_words(self.motor.speeds, self.motor.torques)
            found.append(row("Motor's torque", text, "programme.motor.torques", "programme.motor.speeds"))
        if self.coasts or self.motor is not None:
            if self.inertia is not None:
                found.append(row("Inertia of the drum", f"{number(self.inertia)} kg m²", "programme.inertia"))
            found += [
                row("Drag of the drum", f"{number(self.drag_torque)} N m", "programme.drag_torque"),
                row("Drag rate of the drum", f"{number(self.drag_rate)} 1/s", "programme.drag_rate"),
                row("Longest coast", f"{number(self.coast_limit)} s", "programme.coast_limit"),
            ]
        return [
            *found,
            row("Programme cells", f"{self.cells} round each wall", "programme.cells"),
            row("Programme dispersion", "with" if self.dispersion else "without", "programme.dispersion"),
            *(
                []
                if self.bore == "none"
                else [row("Turbulence of jumps", f"with {self.bore}", "programme.bore")]
            ),
            *([row("Centrifuged", self.capture, "programme.capture")] * (self.capture != "carried")),
            row("Programme samples", f"{self.samples}", "programme.samples"),
        ]
