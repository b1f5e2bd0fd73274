"""The table [optimise] of a scene: what its liquid is chosen for, and within which limits."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, PlainValidator

from leblanc import units
from leblanc.scene.schema.part import Part
from leblanc.scene.schema.rules import SPEED, Quantity, Span, Speed, Truth, entries, one_of, quantity, whole

OBJECTIVES = ("working_speed", "peak", "mean", "least_mass", "robust")
MAX_DUTY = 1000
MAX_SAMPLES = 100_000

_LENGTH = quantity(units.LENGTH, 1e-12, 1e3)
_Pair = tuple[float, float]
_Volumes = Annotated[_Pair, PlainValidator(Span(Quantity(units.VOLUME, 0.0, 1e9)))]


class DutyPoint(Part):
    """A speed of a duty cycle and its share of the time."""

    speed: Speed = Field(description="spin speed")
    weight: Annotated[float, quantity(units.NUMBER, 1e-9, 1e9)] = Field(
        description="share of the time at it, of any sum"
    )


class Optimisation(Part):
    """What the liquid of a scene is chosen for."""

    objective: Annotated[str, one_of(*OBJECTIVES)] = Field(
        "working_speed",
        description="what is made least: the amplitude at the working speed, its peak or its mean over the "
        "duty cycle, the mass of liquid that keeps a limit, or the amplitude over ranges (robust)",
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
        None, description="amplitude for least_mass; one per cent above the least possible if left out"
    )
    limit_at: Annotated[str, one_of("working_speed", "operating")] = Field(
        "working_speed", description="whether the limit holds at the working or at all operating speeds"
    )
    deflection: Annotated[float | None, _LENGTH] = Field(
        None, description="of the axis at the working speed, given; the rotor's own if left out"
    )
    unbalance: Annotated[_Pair | None, PlainValidator(Span(Quantity(units.UNBALANCE, 0.0, 1e9)))] = Field(
        None, description="range of unbalances for the objective robust"
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
    stability_margin: Annotated[float | None, quantity(units.RATE, 0.0, 1e6)] = Field(
        None, description="least decay of every small whirl at the operating speeds; no limit if left out"
    )
    operating: Annotated[_Pair | None, PlainValidator(Span(Quantity(units.ANGULAR_SPEED, 1e-6, 1e6)))] = (
        Field(None, description="range of operating speeds; the scene's if left out")
    )
    clearance: Annotated[float | None, _LENGTH] = Field(
        None, description="largest amplitude at the operating speeds; no limit if left out"
    )
    volumes: Annotated[tuple[_Volumes, ...], entries(1, 1000, "pairs of volumes, one for each chamber")] = (
        Field((), description="least and most of each chamber; from nothing to what it holds if left out")
    )
