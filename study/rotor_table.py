"""The tables of a scene's rotor, one kind each: their keys and how the values of a table bind."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, ValidationInfo, field_validator

from study import units
from study.rules import Entries, OneOf, Quantity, Refused, Several, Whole
from study.table import (
    DAMPING,
    POSITION,
    SPEED,
    STIFFNESS,
    Axis,
    Damping,
    Inertia,
    Length,
    Mass,
    Place,
    Position,
    Stiffness,
    Table,
    Unbalance,
)

KINDS = ("jeffcott", "two_plane", "tub", "exciter")
MAX_PARTS = 1000  # supports, springs, dampers, unbalances

_KIND = BeforeValidator(OneOf(KINDS))
_Number = Annotated[float, BeforeValidator(Quantity(units.NUMBER, -1e6, 1e6))]
_Three = tuple[float, float, float]


class JeffcottTable(Table):
    """[rotor] with kind = "jeffcott"."""

    kind: Annotated[Literal["jeffcott"], _KIND]
    mass: Mass
    critical_speed: Annotated[float | None, SPEED] = None
    stiffness: Annotated[float | None, STIFFNESS] = None
    damping_ratio: Annotated[float | None, BeforeValidator(Quantity(units.NUMBER, 0.0, 1e3))] = None
    damping: Annotated[float | None, DAMPING] = None
    unbalance: Unbalance
    axis: Axis


class SupportTable(Table):
    """[[rotor.supports]]."""

    position: Position
    stiffness: Annotated[float, BeforeValidator(Quantity(units.STIFFNESS, 0.0, 1e15))]
    damping: Damping


class PlaneUnbalanceTable(Table):
    """[[rotor.unbalances]]."""

    position: Position
    size: Unbalance
    angle: Annotated[float, BeforeValidator(Quantity(units.ANGLE, -1e3, 1e3))] = 0.0


class TwoPlaneTable(Table):
    """[rotor] with kind = "two_plane"."""

    kind: Annotated[Literal["two_plane"], _KIND]
    mass: Mass
    transverse_inertia: Inertia
    polar_inertia: Annotated[float, BeforeValidator(Quantity(units.INERTIA, 0.0, 1e12))]
    supports: Annotated[
        tuple[SupportTable, ...], BeforeValidator(Entries(1, MAX_PARTS, "tables headed [[rotor.supports]]"))
    ]
    unbalances: Annotated[
        tuple[PlaneUnbalanceTable, ...],
        BeforeValidator(Entries(0, MAX_PARTS, "tables headed [[rotor.unbalances]]")),
    ] = ()
    axis: Axis

    @field_validator("polar_inertia")
    @classmethod
    def _of_a_body(cls, value: float, info: ValidationInfo) -> float:
        transverse = info.data.get("transverse_inertia")
        if transverse is not None and value > 2.0 * transverse * (1.0 + 1e-9):
            raise Refused(f"at most twice rotor.transverse_inertia, {2.0 * transverse:g} kg*m^2")
        return value


_DIRECTION = BeforeValidator(Entries(3, 3, "pure numbers, along x, y, z"))


class _MountTable(Table):
    position: Place
    direction: Annotated[tuple[_Number, _Number, _Number] | None, _DIRECTION] = None

    @field_validator("direction")
    @classmethod
    def _of_some_length(cls, value: _Three | None) -> _Three | None:
        if value is not None and not any(value):
            raise Refused("three pure numbers that are not all 0")
        return value


def _one_way(value: float | _Three, info: ValidationInfo) -> float | _Three:
    """A coefficient along a direction that is given, or three of them along the axes."""
    if "direction" in info.data and isinstance(value, tuple) == (info.data["direction"] is not None):
        raise Refused(
            "a list of three, along x, y, z, where no direction is given"
            if info.data["direction"] is None
            else "a single value, along the direction that is given"
        )
    return value


class SpringTable(_MountTable):
    """[[rotor.springs]]."""

    stiffness: Annotated[float | _Three, BeforeValidator(Several(Quantity(units.STIFFNESS, 0.0, 1e15)))]
    _bound = field_validator("stiffness")(_one_way)


class DamperTable(_MountTable):
    """[[rotor.dampers]]."""

    damping: Annotated[float | _Three, BeforeValidator(Several(Quantity(units.DAMPING, 0.0, 1e15)))]
    _bound = field_validator("damping")(_one_way)


class TubTable(Table):
    """[rotor] with kind = "tub"."""

    kind: Annotated[Literal["tub"], _KIND]
    tub_mass: Mass
    drum_mass: Mass
    tub_inertia: Annotated[
        tuple[Inertia, Inertia, Inertia],
        BeforeValidator(Entries(3, 3, "moments of inertia, about x, y, z")),
    ]
    drum_polar_inertia: Inertia
    drum_transverse_inertia: Inertia
    drum_position: Place = (0.0, 0.0, 0.0)
    unbalance: Unbalance
    unbalance_position: Annotated[float | None, POSITION] = None
    springs: Annotated[
        tuple[SpringTable, ...], BeforeValidator(Entries(1, MAX_PARTS, "tables headed [[rotor.springs]]"))
    ]
    dampers: Annotated[
        tuple[DamperTable, ...], BeforeValidator(Entries(0, MAX_PARTS, "tables headed [[rotor.dampers]]"))
    ] = ()
    axis: Axis = "horizontal"


class BallsTable(Table):
    """balls = { ... } of an exciter."""

    count: Annotated[int, BeforeValidator(Whole(1, 1000))]
    mass: Mass
    kind: Annotated[Literal["ball", "roller"] | None, BeforeValidator(OneOf(("ball", "roller")))] = None
    pendulum_inertia: Annotated[float | None, BeforeValidator(Quantity(units.INERTIA, 0.0, 1e12))] = None
    track_radius: Length
    damping: Damping


class ExciterTable(Table):
    """[rotor] with kind = "exciter"."""

    kind: Annotated[Literal["exciter"], _KIND]
    platform_mass: Mass
    stiffness: Stiffness
    damping: Damping
    unbalance: Unbalance
    balls: BallsTable


ROTORS: dict[str, dict[tuple[str, ...], type[Table]]] = {
    "jeffcott": {("rotor",): JeffcottTable},
    "two_plane": {
        ("rotor",): TwoPlaneTable,
        ("rotor", "supports", "*"): SupportTable,
        ("rotor", "unbalances", "*"): PlaneUnbalanceTable,
    },
    "tub": {
        ("rotor",): TubTable,
        ("rotor", "springs", "*"): SpringTable,
        ("rotor", "dampers", "*"): DamperTable,
    },
    "exciter": {("rotor",): ExciterTable, ("rotor", "balls"): BallsTable},
}

# Where exactly one key of each pair must stand: the place of the table, the pairs.
ALTERNATIVES: dict[str, tuple[tuple[tuple[str, ...], tuple[str, str]], ...]] = {
    "jeffcott": (
        (("rotor",), ("critical_speed", "stiffness")),
        (("rotor",), ("damping_ratio", "damping")),
    ),
    "exciter": ((("rotor", "balls"), ("kind", "pendulum_inertia")),),
}
