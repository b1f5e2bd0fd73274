"""What a scene may say of the balls of a rolling bearing: the speed of its cage follows from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Protocol

from pydantic import Field

from leblanc.core import units
from leblanc.core.units import MM, number
from leblanc.scene.rows import Value, degrees
from leblanc.scene.schema.part import Conflict
from leblanc.scene.schema.rules import LENGTH, quantity

ROLLING = ("ball_diameter", "pitch_diameter", "contact_angle")

BallDiameter = Annotated[
    float | None,
    LENGTH,
    Field(description="of its balls; the speed of its cage is reported with this and pitch_diameter"),
]
PitchDiameter = Annotated[float | None, LENGTH, Field(description="of the circle of the balls' centres")]
DynamicRating = Annotated[
    float | None,
    quantity(units.FORCE, 1.0, 1e8),
    Field(description="basic dynamic load rating C, by the maker; life, slip and wear are reported with it"),
]
STEEL_WEAR = 1e-17  # m^2/N, of lubricated hardened steel to an order of magnitude: 1e-7 over its hardness
WearCoefficient = Annotated[
    float,
    quantity(units.WEAR, 0.0, 1e-9),
    Field(
        description="volume that sliding balls wear off for each newton and metre; left out that of "
        "lubricated steel, to an order of magnitude"
    ),
]
ContactAngle = Annotated[
    float,
    quantity(units.ANGLE, 0.0, 1.57),
    Field(description="of the balls with the rings, from the plane across the axis"),
]


class Rolls(Protocol):
    """A part of a scene that may be a rolling bearing."""

    @property
    def ball_diameter(self) -> float | None:
        """Diameter of a ball, m."""

    @property
    def pitch_diameter(self) -> float | None:
        """Diameter of the circle of the balls' centres, m."""

    @property
    def contact_angle(self) -> float:
        """Contact angle of the balls, rad."""


@dataclass(frozen=True)
class CagedBearing:
    """A bearing whose balls are given."""

    name: str  #: by which results tell it
    ball_diameter: float  #: of a ball, of the circle of the balls' centres, m
    pitch_diameter: float
    contact_angle: float  #: rad


def caged(named: Sequence[tuple[str, Rolls]]) -> tuple[CagedBearing, ...]:
    """Bearings of those named parts whose balls are given."""
    return tuple(
        CagedBearing(name, part.ball_diameter, part.pitch_diameter, part.contact_angle)
        for name, part in named
        if part.ball_diameter is not None and part.pitch_diameter is not None
    )


def rolling_conflicts(values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
    """Conflicts of a part's balls with the circle they run on: both are given, or neither."""
    ball, pitch = values.get("ball_diameter"), values.get("pitch_diameter")
    for key, other in (("ball_diameter", "pitch_diameter"), ("pitch_diameter", "ball_diameter")):
        if key in given and other not in given:
            yield Conflict((other,), f"given with {key}")
    if ball is not None and pitch is not None and not ball < pitch:
        yield Conflict(("ball_diameter",), f"below pitch_diameter, {pitch:g} m")
    if "contact_angle" in given and "ball_diameter" not in given:
        yield Conflict(("contact_angle",), "left out without ball_diameter and pitch_diameter")


def rolling_columns(parts: Sequence[Rolls], field: str) -> tuple[tuple[str, ...], list[tuple[Value, ...]]]:
    """Balls of parts as columns of a table: heads, and the cells of each part.

    None where no balls are given. `field`: path of the parts in the scene.
    """
    if all(part.ball_diameter is None for part in parts):
        return (), [()] * len(parts)
    rows: list[tuple[Value, ...]] = []
    for k, part in enumerate(parts):
        sizes = zip(ROLLING, (part.ball_diameter, part.pitch_diameter), strict=False)
        rows.append(
            (
                *(
                    Value("not given" if size is None else number(size * MM), (f"{field}.{k}.{name}",))
                    for name, size in sizes
                ),
                Value(degrees(part.contact_angle), (f"{field}.{k}.contact_angle",)),
            )
        )
    return ("balls (mm)", "their circle (mm)", "contact angle (deg)"), rows
