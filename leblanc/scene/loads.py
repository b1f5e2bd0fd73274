"""Unbalances of a scene's rotor: where each is, and how much of it leaves with time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from pydantic import Field

from leblanc.core import units
from leblanc.core.units import MASS, MM, UNBALANCE, in_rpm, number, unit_for, with_unit
from leblanc.scene.rows import RowTable, Value, degrees
from leblanc.scene.schema.part import Part
from leblanc.scene.schema.rules import SPEED, Position, Unbalance, quantity


class Sheds(Part):
    """Water that leaves the laundry, and with it a part of an unbalance."""

    share: Annotated[float, quantity(units.NUMBER, 0.0, 1.0)] = Field(
        description="of the unbalance that leaves in the end"
    )
    time_constant: Annotated[float, quantity(units.TIME, 1e-6, 1e9)] = Field(
        description="in which what has not yet left falls to 1/e, while the drum is faster than above"
    )
    above: Annotated[float, SPEED] = Field(description="speed from which on water leaves")
    mass: Annotated[float | None, quantity(units.MASS, 1e-12, 1e9)] = Field(
        None, description="of the water that leaves in the end; the drum keeps its mass if left out"
    )

    def words(self) -> str:
        """What leaves, for readers."""
        share, time = number(100.0 * self.share), number(self.time_constant)
        mass = "" if self.mass is None else f", {with_unit(self.mass, MASS)}"
        return f"{share} % in {time} s above {in_rpm(self.above)}{mass}"


_SHEDS = "part of it that leaves while the drum turns fast; none if left out"


class PlaneUnbalance(Part):
    """An unbalance in one plane across the axis."""

    position: Position = Field(description="of the plane, along the axis from the rotor's centre of mass")
    size: Unbalance = Field(description="mass times its distance from the axis")
    angle: Annotated[float, quantity(units.ANGLE, -1e3, 1e3)] = Field(
        0.0, description="fixed in the rotor, positive with the spin"
    )
    sheds: Sheds | None = Field(None, description=_SHEDS)


class Load(Part):
    """A part of the laundry, in one plane across the drum's axis."""

    position: Position = Field(description="y of its plane")
    size: Unbalance = Field(description="mass times its distance from the axis")
    angle: Annotated[float, quantity(units.ANGLE, -1e3, 1e3)] = Field(
        0.0, description="fixed in the drum, positive with the spin"
    )
    sheds: Sheds | None = Field(None, description=_SHEDS)


def unbalance_table(name: str, field: str, parts: Sequence[PlaneUnbalance | Load]) -> RowTable:
    """Unbalances for readers; a column of what leaves where something does.

    `name` of one of them, `field` their path in the scene; at least one part.
    """
    unit = unit_for(UNBALANCE, *(part.size for part in parts))
    leaves = any(part.sheds is not None for part in parts)
    rows = [
        (
            Value(f"{k + 1}"),
            Value(number(part.position * MM), (f"{field}.{k}.position",)),
            Value(unit.number(part.size), (f"{field}.{k}.size",)),
            Value(degrees(part.angle), (f"{field}.{k}.angle",)),
            *([Value(part.sheds.words() if part.sheds else "none", (f"{field}.{k}.sheds",))] * leaves),
        )
        for k, part in enumerate(parts)
    ]
    head = (name, "at (mm)", f"size ({unit.name})", "angle (deg)", *(("leaves",) * leaves))
    return RowTable(head, tuple(rows))
