"""The tables of a scene's rotor, one kind each: their keys and how the values of a table bind."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BeforeValidator, ValidationInfo, field_validator

from leblanc import units
from leblanc.scene.rules import (
    DAMPING,
    POSITION,
    SPEED,
    STIFFNESS,
    Axis,
    Damping,
    Entries,
    Inertia,
    Length,
    Mass,
    OneOf,
    Place,
    Position,
    Quantity,
    Refused,
    Several,
    Stiffness,
    Table,
    Unbalance,
    Whole,
)

if TYPE_CHECKING:
    from solvers.rotor.tub import Mount, Tub
    from solvers.rotor.two_plane import TwoPlane

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


@dataclass(frozen=True)
class Rotor:
    """A rotor on an isotropic support, moving in one plane.

    Parameters
    ----------
    kind : "jeffcott"
    mass : M without the liquid, kg
    stiffness : K, N/m
    damping : C of the support, external, N s/m
    unbalance : U0 = m e, kg m
    axis : "horizontal" if gravity lies across the axis, "vertical" if along it
    """

    kind: Literal["jeffcott"]
    mass: float
    stiffness: float
    damping: float
    unbalance: float
    axis: Axis


@dataclass(frozen=True)
class TwoPlaneRotor:
    """A rigid rotor in supports along its axis.

    Parameters
    ----------
    kind : "two_plane"
    machine : the rotor without liquid
    axis : as in `Rotor`
    """

    kind: Literal["two_plane"]
    machine: TwoPlane
    axis: Axis


@dataclass(frozen=True)
class TubRotor:
    """A suspended tub with its drum.

    Parameters
    ----------
    kind : "tub"
    machine : tub and drum without liquid
    axis : of the drum, as in `Rotor`
    """

    kind: Literal["tub"]
    machine: Tub
    axis: Axis


@dataclass(frozen=True)
class ExciterBalls:
    """The balls, rollers or pendulums of an exciter.

    Parameters
    ----------
    count : how many
    mass : of each, kg
    kind : "ball", "roller" or "pendulum"
    pendulum_inertia : of each pendulum about its own centre of mass, kg m^2; 0 for the others
    track_radius : of the circle of their centres, m
    damping : of the motion along the track, N s/m
    """

    count: int
    mass: float
    kind: Literal["ball", "roller", "pendulum"]
    pendulum_inertia: float
    track_radius: float
    damping: float


@dataclass(frozen=True)
class Exciter:
    """A platform that vibrates along one line, shaken by an unbalance and by balls in a rotating track.

    Parameters
    ----------
    kind : "exciter"
    platform_mass : of all that vibrates without the balls, kg
    stiffness : N/m
    damping : N s/m
    unbalance : of the shaft, kg m
    balls : in the track on the shaft
    """

    kind: Literal["exciter"]
    platform_mass: float
    stiffness: float
    damping: float
    unbalance: float
    balls: ExciterBalls

    @property
    def axis(self) -> Axis:
        """Its shaft lies across the vibration."""
        return "horizontal"


AnyRotor = Rotor | TwoPlaneRotor | TubRotor | Exciter


def rotor_from_table(table: Table) -> AnyRotor:
    """Rotor from the checked values of its table."""
    if isinstance(table, TwoPlaneTable):
        return _two_plane(table)
    if isinstance(table, TubTable):
        return _tub(table)
    if isinstance(table, ExciterTable):
        return _exciter(table)
    assert isinstance(table, JeffcottTable)
    return _jeffcott(table)


def _jeffcott(table: JeffcottTable) -> Rotor:
    """Stiffness and damping from a critical speed and a damping ratio, both of the rotor without liquid.

    K = M omega^2 and C = 2 zeta sqrt(K M).
    """
    stiffness, damping = table.stiffness, table.damping
    if table.critical_speed is not None:
        stiffness = table.mass * table.critical_speed**2
    assert stiffness is not None
    if table.damping_ratio is not None:
        damping = 2.0 * table.damping_ratio * math.sqrt(stiffness * table.mass)
    assert damping is not None
    return Rotor(table.kind, table.mass, stiffness, damping, table.unbalance, table.axis)


def _two_plane(table: TwoPlaneTable) -> TwoPlaneRotor:
    from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane

    machine = TwoPlane(
        mass=table.mass,
        transverse_inertia=table.transverse_inertia,
        polar_inertia=table.polar_inertia,
        supports=tuple(Support(**one.model_dump()) for one in table.supports),
        unbalances=tuple(PlaneUnbalance(**one.model_dump()) for one in table.unbalances),
    )
    return TwoPlaneRotor(table.kind, machine, table.axis)


def _tub(table: TubTable) -> TubRotor:
    from solvers.rotor.tub import Tub

    values = table.model_dump(exclude={"kind", "axis", "springs", "dampers"})
    machine = Tub(
        **values, springs=tuple(map(_mount, table.springs)), dampers=tuple(map(_mount, table.dampers))
    )
    return TubRotor(table.kind, machine, table.axis)


def _mount(table: SpringTable | DamperTable) -> Mount:
    """Along its direction if it has one, else along the axes."""
    from solvers.rotor.tub import Mount

    value = table.stiffness if isinstance(table, SpringTable) else table.damping
    if isinstance(value, tuple):
        return Mount(table.position, along_axes=value)
    assert table.direction is not None
    return Mount(table.position, coefficient=value, direction=table.direction)


def _exciter(table: ExciterTable) -> Exciter:
    values = table.model_dump(exclude={"balls"})
    balls = table.balls.model_dump(exclude={"kind", "pendulum_inertia"})
    inertia = table.balls.pendulum_inertia
    kind = table.balls.kind or "pendulum"
    return Exciter(**values, balls=ExciterBalls(**balls, kind=kind, pendulum_inertia=inertia or 0.0))
