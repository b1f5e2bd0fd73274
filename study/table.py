"""What the tables of a scene file have in common."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict

from study import units
from study.rules import Entries, OneOf, Quantity


class Table(BaseModel):
    """A table whose keys are all known and whose values do not change."""

    model_config = ConfigDict(extra="forbid", frozen=True)


# Rules of values that some tables may leave out.
LENGTH = BeforeValidator(Quantity(units.LENGTH, 1e-6, 1e3))
POSITION = BeforeValidator(Quantity(units.LENGTH, -1e3, 1e3))
SPEED = BeforeValidator(Quantity(units.ANGULAR_SPEED, 1e-6, 1e6))
DAMPING = BeforeValidator(Quantity(units.DAMPING, 0.0, 1e15))
STIFFNESS = BeforeValidator(Quantity(units.STIFFNESS, 1e-9, 1e15))

Length = Annotated[float, LENGTH]
Position = Annotated[float, POSITION]
Place = Annotated[
    tuple[Position, Position, Position], BeforeValidator(Entries(3, 3, "lengths, along x, y, z"))
]
Speed = Annotated[float, SPEED]
Mass = Annotated[float, BeforeValidator(Quantity(units.MASS, 1e-9, 1e9))]
Inertia = Annotated[float, BeforeValidator(Quantity(units.INERTIA, 1e-12, 1e12))]
Unbalance = Annotated[float, BeforeValidator(Quantity(units.UNBALANCE, 0.0, 1e9))]
Damping = Annotated[float, DAMPING]
Stiffness = Annotated[float, STIFFNESS]
Axis = Annotated[Literal["horizontal", "vertical"], BeforeValidator(OneOf(("horizontal", "vertical")))]
