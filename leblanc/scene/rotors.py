"""The rotor of a scene, a class for each kind.

`machine()` is the solvers' rotor without liquid; `rows()` and `tables()` are what it says, for readers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, wraps
from importlib.metadata import EntryPoint
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    PlainValidator,
    SerializeAsAny,
    Tag,
    ValidationError,
    model_validator,
)
from pydantic_core import InitErrorDetails

from leblanc.core import units
from leblanc.core.units import MASS, MM, in_rpm, number, with_unit
from leblanc.registry import CORE, MACHINES, WINGS, announced, sound
from leblanc.scene.bearings import (
    STEEL_WEAR,
    BallDiameter,
    CagedBearing,
    ContactAngle,
    DynamicRating,
    PitchDiameter,
    WearCoefficient,
    caged,
    rolling_columns,
    rolling_conflicts,
)
from leblanc.scene.loads import Load, PlaneUnbalance, Sheds, unbalance_table
from leblanc.scene.magnetic import MagneticRotor
from leblanc.scene.rows import Row, RowTable, Value, mm, row, three, unbalance
from leblanc.scene.schema.part import ANNOUNCED, Conflict, Part, placed
from leblanc.scene.schema.rules import (
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
    Quantity,
    Several,
    Stiffness,
    Unbalance,
    entries,
    one_of,
    quantity,
    whole,
)
from leblanc.scene.spindle import Spindle
from meshes.errors import InputError

if TYPE_CHECKING:
    from solvers.rotor.exciter.machine import Exciter as ExciterMachine
    from solvers.rotor.jeffcott import Jeffcott
    from solvers.rotor.tub import Mount, Tub
    from solvers.rotor.two_plane import TwoPlane

MAX_PARTS = 1000  # supports, springs, dampers, unbalances

_Number = Annotated[float, quantity(units.NUMBER, -1e6, 1e6)]
_Three = tuple[float, float, float]

_AXIS = "horizontal: gravity lies across the axis; vertical: along it"
_WITHOUT = "of the rotor without the liquid"
_SHEDS = "part of the unbalance that leaves while the drum turns fast; none if left out"


def _sheds(sheds: Sheds | None) -> list[Row]:
    """What leaves of the unbalance."""
    return [] if sheds is None else [row("Of it leaves", sheds.words(), "rotor.sheds")]


def _kind(rotor: AnyRotor) -> Row:
    """Kind and axis."""
    return row("Rotor", f"{rotor.kind}, {rotor.axis} axis", "rotor.axis", "rotor.kind")


class JeffcottRotor(Part):
    """A rotor on an isotropic support, moving in one plane.

    Examples
    --------
    >>> import leblanc as lb
    >>> rotor = lb.JeffcottRotor(
    ...     mass="4 kg", critical_speed="1000 rpm", damping_ratio=0.1, unbalance=6e-4, axis="horizontal"
    ... )
    >>> f"{rotor.machine().stiffness:.0f} N/m"
    '43865 N/m'
    """

    ALTERNATIVES: ClassVar = (("critical_speed", "stiffness"), ("damping_ratio", "damping"))

    kind: Literal["jeffcott"] = Field("jeffcott", description="the kind of rotor")
    mass: Mass = Field(description=f"{_WITHOUT}, M")
    critical_speed: Annotated[float | None, SPEED] = Field(
        None, description=f"{_WITHOUT} and damping; or stiffness"
    )
    stiffness: Annotated[float | None, STIFFNESS] = Field(
        None, description="of the support, K; or critical_speed"
    )
    damping_ratio: Annotated[float | None, quantity(units.NUMBER, 0.0, 1e3)] = Field(
        None, description=f"of the support over the critical damping {_WITHOUT}; or damping"
    )
    damping: Annotated[float | None, DAMPING] = Field(
        None, description="of the support, external, C; or damping_ratio"
    )
    unbalance: Unbalance = Field(description="mass times its distance from the axis, m e")
    axis: Axis = Field(description=_AXIS)
    sheds: Sheds | None = Field(None, description=_SHEDS)

    @cached_property
    def _machine(self) -> Jeffcott:
        from solvers.rotor.jeffcott import Jeffcott

        stiffness, damping = self.stiffness, self.damping
        if self.critical_speed is not None:
            stiffness = self.mass * self.critical_speed**2
        assert stiffness is not None
        if self.damping_ratio is not None:
            damping = 2.0 * self.damping_ratio * math.sqrt(stiffness * self.mass)
        assert damping is not None
        return Jeffcott(self.mass, stiffness, damping, self.unbalance)

    def machine(self) -> Jeffcott:
        """The rotor without liquid: K = M omega^2 and C = 2 zeta sqrt(K M) where omega and zeta are given."""
        return self._machine

    def rows(self) -> list[Row]:
        """Rows of the rotor, for readers."""
        machine = self.machine()
        speed, ratio = in_rpm(machine.natural_frequency), number(machine.damping_ratio)
        stiffness, damping = f"{number(machine.stiffness)} N/m", f"{number(machine.damping)} N s/m"
        return [
            _kind(self),
            row("Mass", with_unit(self.mass, MASS), "rotor.mass"),
            row("Critical speed, dry", speed, "rotor.critical_speed", "rotor.stiffness"),
            row("Stiffness", stiffness, "rotor.stiffness", "rotor.critical_speed"),
            row("Damping ratio", ratio, "rotor.damping_ratio", "rotor.damping"),
            row("Damping", damping, "rotor.damping", "rotor.damping_ratio"),
            row("Unbalance", unbalance(self.unbalance), "rotor.unbalance"),
            *_sheds(self.sheds),
        ]

    def tables(self) -> list[RowTable]:
        """No tables: the rotor has no parts."""
        return []


def _across(dimension: units.Dimension) -> PlainValidator:
    """The same in all directions across the axis, or along the first and the second."""
    each = Quantity(dimension, 0.0, 1e15)
    return PlainValidator(Several(each, "two", "the first and the second direction across the axis"))


class Support(Part):
    """A support of the rotor's axis."""

    position: Position = Field(description="along the axis from the rotor's centre of mass")
    stiffness: Annotated[float | tuple[float, float], _across(units.STIFFNESS)] = Field(
        description="the same in all directions across the axis, or one for each of two"
    )
    damping: Annotated[float | tuple[float, float], _across(units.DAMPING)] = Field(description="likewise")
    ball_diameter: BallDiameter = None
    pitch_diameter: PitchDiameter = None
    contact_angle: ContactAngle = 0.0

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Balls and their circle belong together."""
        yield from rolling_conflicts(values, given)


class TwoPlaneRotor(Part):
    """A rigid rotor in supports along its axis.

    Examples
    --------
    >>> import leblanc as lb
    >>> rotor = lb.TwoPlaneRotor(
    ...     mass="20 kg",
    ...     transverse_inertia=0.4,
    ...     polar_inertia=0.1,
    ...     supports=[
    ...         {"position": "-0.2 m", "stiffness": 1e6, "damping": 100.0},
    ...         {"position": "0.2 m", "stiffness": 1e6, "damping": 100.0},
    ...     ],
    ...     axis="horizontal",
    ... )
    >>> rotor.machine().system().coordinates
    ('x', 'y', 'alpha', 'beta')
    """

    kind: Literal["two_plane"] = Field("two_plane", description="the kind of rotor")
    mass: Mass = Field(description=f"{_WITHOUT}")
    transverse_inertia: Inertia = Field(
        description="about an axis through the centre of mass across the rotor's, without the liquid"
    )
    polar_inertia: Annotated[float, quantity(units.INERTIA, 0.0, 1e12)] = Field(
        description="about the rotor's axis, without the liquid; at most twice the transverse one"
    )
    supports: Annotated[tuple[Support, ...], entries(1, MAX_PARTS, "tables headed [[rotor.supports]]")] = (
        Field(description="of the axis, one table each")
    )
    unbalances: Annotated[
        tuple[PlaneUnbalance, ...], entries(0, MAX_PARTS, "tables headed [[rotor.unbalances]]")
    ] = Field((), description="one table each")
    axis: Axis = Field(description=_AXIS)
    pivot: Annotated[float | None, POSITION] = Field(
        None,
        description="place of a ball joint on a vertical axis, upwards from the centre of mass: whether the "
        "rotor stands upright about it is reported; the response moves on the supports alone",
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """No body has more inertia about an axis than about the two across; a ball joint carries upright."""
        if values.get("pivot") is not None and values.get("axis") == "horizontal":
            yield Conflict(("pivot",), "left out unless the axis is vertical")
        if {"transverse_inertia", "polar_inertia"} <= values.keys():
            most = 2.0 * values["transverse_inertia"]
            if values["polar_inertia"] > most * (1.0 + 1e-9):
                text = f"at most twice rotor.transverse_inertia, {most:g} kg*m^2"
                yield Conflict(("polar_inertia",), text)

    @cached_property
    def _machine(self) -> TwoPlane:
        from solvers.rotor import two_plane

        return two_plane.TwoPlane(
            mass=self.mass,
            transverse_inertia=self.transverse_inertia,
            polar_inertia=self.polar_inertia,
            supports=tuple(
                two_plane.Support(support.position, support.stiffness, support.damping)
                for support in self.supports
            ),
            unbalances=tuple(
                two_plane.PlaneUnbalance(part.position, part.size, part.angle) for part in self.unbalances
            ),
        )

    def machine(self) -> TwoPlane:
        """The rotor without liquid."""
        return self._machine

    def caged(self) -> tuple[CagedBearing, ...]:
        """Supports whose balls are given."""
        return caged([(f"support {k + 1}", support) for k, support in enumerate(self.supports)])

    def rows(self) -> list[Row]:
        """Rows of the rotor, for readers."""
        across, about = f"{number(self.transverse_inertia)} kg m²", f"{number(self.polar_inertia)} kg m²"
        return [
            _kind(self),
            row("Mass", with_unit(self.mass, MASS), "rotor.mass"),
            row("Inertia across the axis", across, "rotor.transverse_inertia"),
            row("Inertia about the axis", about, "rotor.polar_inertia"),
            *([] if self.pivot is None else [row("Ball joint at", mm(self.pivot), "rotor.pivot")]),
        ]

    def tables(self) -> list[RowTable]:
        """Supports and unbalances, for readers."""
        balls, columns = rolling_columns(self.supports, "rotor.supports")
        supports = tuple(
            (
                Value(f"{k + 1}"),
                Value(number(support.position * MM), (f"rotor.supports.{k}.position",)),
                Value(_each(support.stiffness), (f"rotor.supports.{k}.stiffness",)),
                Value(_each(support.damping), (f"rotor.supports.{k}.damping",)),
                *columns[k],
            )
            for k, support in enumerate(self.supports)
        )
        head = ("Support", "at (mm)", "stiffness (N/m)", "damping (N s/m)", *balls)
        found = [RowTable(head, supports)]
        if self.unbalances:
            found.append(unbalance_table("Unbalance", "rotor.unbalances", self.unbalances))
        return found


def _each(value: float | tuple[float, float]) -> str:
    """One value, or one for each direction, for readers."""
    return f"({three(value)})" if isinstance(value, tuple) else number(value)


_DIRECTION = entries(3, 3, "pure numbers, along x, y, z")


class _Mounted(Part):
    """What holds a tub at one point: along a direction, or along the axes."""

    COEFFICIENT: ClassVar[str]

    position: Place = Field(description="where it holds the tub, x, y, z from the tub's centre of mass")
    direction: Annotated[tuple[_Number, _Number, _Number] | None, _DIRECTION] = Field(
        None, description="along which it acts, of any length; left out where it acts along x, y and z"
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A coefficient along a direction that is given, or three of them along the axes."""
        key, along = cls.COEFFICIENT, values.get("direction")
        if along is not None and not any(along):
            yield Conflict(("direction",), "three pure numbers that are not all 0")
        if not {"direction", key} <= values.keys():
            return
        if isinstance(values[key], tuple) == (along is not None):
            several, single = (
                "a list of three, along x, y, z, where no direction is given",
                "a single value, along the direction that is given",
            )
            yield Conflict((key,), several if along is None else single)

    def mount(self) -> Mount:
        """The mount as the solvers take it."""
        from solvers.rotor.tub import Mount

        value = getattr(self, self.COEFFICIENT)
        if isinstance(value, tuple):
            return Mount(self.position, along_axes=value)
        assert self.direction is not None
        return Mount(self.position, coefficient=value, direction=self.direction)

    def values(self, at: str) -> tuple[Value, ...]:
        """Place, size and direction for readers; `at` is its path in the scene."""
        size = getattr(self, self.COEFFICIENT)
        text = f"({three(size)})" if isinstance(size, tuple) else number(size)
        way = Value("along x, y, z")
        if self.direction is not None:
            way = Value(f"({three(self.direction)})", (f"{at}.direction",))
        return (
            Value(f"({three(self.position, MM)})", (f"{at}.position",)),
            Value(text, (f"{at}.{self.COEFFICIENT}",)),
            way,
        )


class Spring(_Mounted):
    """A spring between the tub and the ground."""

    COEFFICIENT: ClassVar = "stiffness"

    stiffness: Annotated[float | _Three, PlainValidator(Several(Quantity(units.STIFFNESS, 0.0, 1e15)))] = (
        Field(description="along its direction, or three along x, y, z")
    )


class Damper(_Mounted):
    """A damper between the tub and the ground."""

    COEFFICIENT: ClassVar = "damping"

    damping: Annotated[float | _Three, PlainValidator(Several(Quantity(units.DAMPING, 0.0, 1e15)))] = Field(
        description="along its direction, or three along x, y, z"
    )


class Bearing(Part):
    """A bearing of the drum in its tub."""

    position: Position = Field(description="along the axis: y, from the tub's centre of mass")
    ball_diameter: BallDiameter = None
    pitch_diameter: PitchDiameter = None
    contact_angle: ContactAngle = 0.0
    dynamic_rating: DynamicRating = None
    wear_coefficient: WearCoefficient = STEEL_WEAR

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Balls and their circle belong together, wear and rating as well."""
        yield from rolling_conflicts(values, given)
        if "wear_coefficient" in given and "dynamic_rating" not in given:
            yield Conflict(("wear_coefficient",), "left out without dynamic_rating")


class TubRotor(Part):
    """A suspended tub with its drum, which spins about y.

    Examples
    --------
    >>> import leblanc as lb
    >>> rotor = lb.example("tub").rotor
    >>> len(rotor.springs), rotor.machine().system().coordinates
    (6, ('x', 'y', 'z', 'alpha', 'beta', 'gamma'))
    """

    kind: Literal["tub"] = Field("tub", description="the kind of rotor")
    tub_mass: Mass = Field(description="of the tub and all that does not spin")
    drum_mass: Mass = Field(description="of the drum without the liquid")
    tub_inertia: Annotated[
        tuple[Inertia, Inertia, Inertia], entries(3, 3, "moments of inertia, about x, y, z")
    ] = Field(description="of the tub about x, y, z through its centre of mass")
    drum_polar_inertia: Inertia = Field(description="of the drum about its axis")
    drum_transverse_inertia: Inertia = Field(description="of the drum across its axis, about its own centre")
    drum_position: Place = Field((0.0, 0.0, 0.0), description="of the drum's centre, x, y, z")
    unbalance: Unbalance = Field(
        0.0, description="of the laundry, mass times its distance from the axis; or loads, or both"
    )
    unbalance_position: Annotated[float | None, POSITION] = Field(
        None, description="y of the unbalance; that of the drum's centre if left out"
    )
    sheds: Sheds | None = Field(None, description=_SHEDS)
    loads: Annotated[tuple[Load, ...], entries(0, MAX_PARTS, "tables headed [[rotor.loads]]")] = Field(
        (), description="laundry spread over the drum's length, one table each"
    )
    springs: Annotated[tuple[Spring, ...], entries(1, MAX_PARTS, "tables headed [[rotor.springs]]")] = Field(
        description="between the tub and the ground, one table each"
    )
    dampers: Annotated[tuple[Damper, ...], entries(0, MAX_PARTS, "tables headed [[rotor.dampers]]")] = Field(
        (), description="between the tub and the ground, one table each"
    )
    bearings: Annotated[tuple[Bearing, ...], entries(2, 2, "tables headed [[rotor.bearings]]")] = Field(
        (), description="of the drum in the tub, two of them; their forces are not reported if left out"
    )
    axis: Axis = Field("horizontal", description=_AXIS)

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """There is an unbalance, in one place or in several; two bearings are at two places."""
        if "unbalance" not in given and "loads" not in given:
            text = 'given: an unbalance such as "0.6 kg*mm" (a plain number is in kg*m)'
            yield Conflict(("unbalance",), f"{text}, or tables headed [[rotor.loads]]")

        places = [bearing.position for bearing in values.get("bearings", ())]
        if len(places) == 2 and places[0] == places[1]:
            yield Conflict(("bearings", 1, "position"), "another place than that of the first bearing")

    @property
    def has_own_unbalance(self) -> bool:
        """Not all of the laundry is in its loads."""
        return "unbalance" in self.model_fields_set or not self.loads

    @cached_property
    def _machine(self) -> Tub:
        from solvers.rotor.tub import Tub
        from solvers.rotor.two_plane import PlaneUnbalance as Turning

        return Tub(
            tub_mass=self.tub_mass,
            drum_mass=self.drum_mass,
            tub_inertia=self.tub_inertia,
            drum_polar_inertia=self.drum_polar_inertia,
            drum_transverse_inertia=self.drum_transverse_inertia,
            drum_position=self.drum_position,
            unbalance=self.unbalance,
            unbalance_position=self.unbalance_position,
            loads=tuple(Turning(load.position, load.size, load.angle) for load in self.loads),
            springs=tuple(spring.mount() for spring in self.springs),
            dampers=tuple(damper.mount() for damper in self.dampers),
        )

    def caged(self) -> tuple[CagedBearing, ...]:
        """Bearings whose balls are given."""
        return caged([(f"bearing {k + 1}", bearing) for k, bearing in enumerate(self.bearings)])

    def machine(self) -> Tub:
        """Tub and drum without liquid."""
        return self._machine

    def rows(self) -> list[Row]:
        """Rows of the rotor, for readers."""
        about, across = number(self.drum_polar_inertia), number(self.drum_transverse_inertia)
        heavy = self.drum_position[1] if self.unbalance_position is None else self.unbalance_position
        return [
            _kind(self),
            row("Tub mass", with_unit(self.tub_mass, MASS), "rotor.tub_mass"),
            row("Drum mass", with_unit(self.drum_mass, MASS), "rotor.drum_mass"),
            row("Tub inertias x, y, z", f"{three(self.tub_inertia)} kg m²", "rotor.tub_inertia"),
            row("Drum inertia about its axis", f"{about} kg m²", "rotor.drum_polar_inertia"),
            row("Drum inertia across it", f"{across} kg m²", "rotor.drum_transverse_inertia"),
            row("Drum's centre", f"({three(self.drum_position, MM)}) mm", "rotor.drum_position"),
            *(
                [
                    row("Unbalance", unbalance(self.unbalance), "rotor.unbalance"),
                    row("Unbalance at y", mm(heavy), "rotor.unbalance_position"),
                    *_sheds(self.sheds),
                ]
                * self.has_own_unbalance
            ),
        ]

    def tables(self) -> list[RowTable]:
        """Springs, dampers and loads, for readers."""
        mounts: tuple[tuple[str, str, Sequence[_Mounted]], ...] = (
            ("Spring", "N/m", self.springs),
            ("Damper", "N s/m", self.dampers),
        )
        found = []
        for name, unit, parts in mounts:
            lines = tuple(
                (Value(f"{k + 1}"), *part.values(f"rotor.{name.lower()}s.{k}"))
                for k, part in enumerate(parts)
            )
            if lines:
                head = (name, "at x, y, z (mm)", f"{parts[0].COEFFICIENT} ({unit})", "direction")
                found.append(RowTable(head, lines))
        if self.loads:
            found.append(unbalance_table("Load", "rotor.loads", self.loads))
        if self.bearings:
            found.append(_bearing_table(self.bearings))
        return found


def _rating_values(part: Bearing, field: str) -> tuple[Value, Value]:
    """Rating and wear of a bearing as cells of a table."""
    rating = part.dynamic_rating
    return (
        Value("not given" if rating is None else number(rating), (f"{field}.dynamic_rating",)),
        Value(f"{part.wear_coefficient:.4g}", (f"{field}.wear_coefficient",)),
    )


def _bearing_table(bearings: Sequence[Bearing]) -> RowTable:
    """Bearings for readers; columns of their balls where some are known."""
    head, columns = rolling_columns(bearings, "rotor.bearings")
    rated = any(part.dynamic_rating is not None for part in bearings)
    rows = [
        (
            Value(f"{k + 1}"),
            Value(number(part.position * MM), (f"rotor.bearings.{k}.position",)),
            *columns[k],
            *(_rating_values(part, f"rotor.bearings.{k}") if rated else ()),
        )
        for k, part in enumerate(bearings)
    ]
    if rated:
        head = (*head, "dynamic rating (N)", "wear (m2/N)")
    return RowTable(("Bearing", "at y (mm)", *head), tuple(rows))


class Balls(Part):
    """The balls, rollers or pendulums of an exciter."""

    ALTERNATIVES: ClassVar = (("kind", "pendulum_inertia"),)

    count: Annotated[int, whole(1, 1000)] = Field(description="how many there are")
    mass: Mass = Field(description="of each")
    kind: Annotated[Literal["ball", "roller"] | None, one_of("ball", "roller")] = Field(
        None, description="what rolls in the track; or pendulum_inertia"
    )
    pendulum_inertia: Annotated[float | None, quantity(units.INERTIA, 0.0, 1e12)] = Field(
        None, description="of each pendulum about its own centre of mass; or kind"
    )
    track_radius: Length = Field(description="of the circle of their centres")
    damping: Damping = Field(description="of the motion along the track")

    @property
    def name(self) -> Literal["ball", "roller", "pendulum"]:
        """What one of them is."""
        return self.kind or "pendulum"


class Exciter(Part):
    """A platform that vibrates along one line, shaken by an unbalance and by balls in a rotating track.

    Examples
    --------
    >>> import leblanc as lb
    >>> rotor = lb.example("vibratory_table").rotor
    >>> rotor.balls.count, rotor.balls.name
    (2, 'ball')
    """

    kind: Literal["exciter"] = Field("exciter", description="the kind of rotor")
    platform_mass: Mass = Field(description="of all that vibrates without the balls")
    stiffness: Stiffness = Field(description="of the platform's springs")
    damping: Damping = Field(description="of the platform")
    unbalance: Unbalance = Field(description="of the shaft, mass times its distance from the axis")
    balls: Balls = Field(description="in the track on the shaft")

    @property
    def axis(self) -> Axis:
        """Axis of the shaft, which lies across the vibration."""
        return "horizontal"

    @cached_property
    def _machine(self) -> ExciterMachine:
        from solvers.rotor.exciter.machine import Exciter as Machine
        from solvers.rotor.exciter.machine import rolling_inertia

        balls = self.balls
        inertia = balls.pendulum_inertia or 0.0
        return Machine(
            platform_mass=self.platform_mass,
            stiffness=self.stiffness,
            damping=self.damping,
            unbalance=self.unbalance,
            ball_count=balls.count,
            ball_mass=balls.mass,
            rolling=rolling_inertia(balls.name, balls.mass, balls.track_radius, inertia),
            track_radius=balls.track_radius,
            ball_damping=balls.damping,
        )

    def machine(self) -> ExciterMachine:
        """Platform, shaft and balls."""
        return self._machine

    def rows(self) -> list[Row]:
        """Rows of the exciter, for readers."""
        balls = self.balls
        what = "rotor.balls.pendulum_inertia" if balls.kind is None else "rotor.balls.kind"
        found = [
            row("Rotor", "exciter", "rotor.kind"),
            row("Platform mass", with_unit(self.platform_mass, MASS), "rotor.platform_mass"),
            row("Stiffness", f"{number(self.stiffness)} N/m", "rotor.stiffness"),
            row("Damping", f"{number(self.damping)} N s/m", "rotor.damping"),
            row("Unbalance of the shaft", unbalance(self.unbalance), "rotor.unbalance"),
            Row(
                "In the track",
                (Value(f"{balls.count}", ("rotor.balls.count",)), Value(f"{balls.name}s", (what,))),
            ),
            row("Mass of each", with_unit(balls.mass, MASS), "rotor.balls.mass"),
            row("Radius of the track", mm(balls.track_radius), "rotor.balls.track_radius"),
            row("Damping along it", f"{number(balls.damping)} N s/m", "rotor.balls.damping"),
        ]
        if balls.pendulum_inertia is not None:
            found.append(row("Inertia of each", f"{number(balls.pendulum_inertia)} kg m²", what))
        return found

    def tables(self) -> list[RowTable]:
        """No tables: the balls are all alike."""
        return []


def not_taken(kind: str, what: str = "") -> InputError:
    """The refusal of a machine by a question that is not for its kind; `what` else there is to do."""
    return InputError("rotor.kind", kind, f"of another kind: this command takes no machine of this one{what}")


class Machine(Part):
    """A kind of machine of another package, which announces it by its kind under `leblanc.machines`.

    A subclass has a `kind`, a Literal with that text for its default, and the fields of its table. Where it
    has a `machine()`, the rotor without liquid as an object with `system()`, and an `unbalance`, kg m, the
    studies of rotors with liquid answer; `ANSWERS` names what answers in their place.
    """

    #: question, as "run", to "module:function" of a scene, which returns an `Answer`
    ANSWERS: ClassVar[Mapping[str, str]] = {}

    kind: str = Field(description="the kind of rotor")
    axis: Axis = Field("horizontal", description=_AXIS)

    def machine(self) -> Any:
        """The rotor without liquid; an `InputError` where the kind has none."""
        raise not_taken(self.kind)

    def rows(self) -> list[Row]:
        """Kind and axis, and each value in SI units; a subclass may say it better."""
        found = [_kind(self)]
        for name in type(self).model_fields:
            if name in ("kind", "axis"):
                continue
            value = getattr(self, name)
            said = number(value) if isinstance(value, float) else str(value)
            found.append(row(name.replace("_", " ").capitalize(), said, f"rotor.{name}"))
        return found

    def tables(self) -> list[RowTable]:
        """No tables: a subclass may have parts."""
        return []

    @classmethod
    def alternatives(cls) -> tuple[type[Part], ...]:
        """In place of all kinds, each one that an installed package announces."""
        if cls is not Machine:
            return (cls,)
        found = []
        for kind in announced_machines():
            with suppress(InputError):  # one that is broken is no choice
                found.append(announced_machine(kind))
        return tuple(found)

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        """Check what its `machine()` gives."""
        super().__pydantic_init_subclass__(**kwargs)
        if "machine" in vars(cls):
            setattr(cls, "machine", _checked(vars(cls)["machine"]))  # noqa: B010 - of each subclass

    @model_validator(mode="wrap")
    @classmethod
    def _of_its_kind(cls, given: Any, handler: ModelWrapValidatorHandler[Self]) -> Any:
        """A table becomes what its kind says, which stands in the places of its faults."""
        if cls is not Machine or isinstance(given, Machine):
            return handler(given)
        try:
            found = announced_machine(given["kind"])
        except InputError as error:
            fault = InitErrorDetails(
                type="value_error", loc=("kind",), input=given["kind"], ctx={"error": error}
            )
            raise ValidationError.from_exception_data(cls.__name__, [fault]) from error
        try:
            return found.model_validate(given)
        except ValidationError as error:
            raise placed(error, given["kind"]) from None


def _checked(machine: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """The method of a machine of another package; what it gives, or fails with, is told with its kind."""

    @wraps(machine)
    def checked(self: Any) -> Any:
        from solvers.rotor.system import RotorSystem

        with sound(self.kind, f"machine() of {type(self).__module__}:{type(self).__qualname__}"):
            try:
                found = machine(self)
                equations = found.system()
                if not isinstance(equations, RotorSystem):
                    raise TypeError(f"system() gives {type(equations).__name__}, no RotorSystem")
            except InputError as error:
                if "." in error.field:  # of its table
                    raise
                raise ValueError(str(error)) from error
        return found

    return checked


def announced_machines() -> dict[str, EntryPoint]:
    """Kinds of machines of other packages."""
    return announced(MACHINES, (*CORE, *WINGS))


def announced_machine(kind: str) -> type[Machine]:
    """The class that an installed package announces for a kind of machine."""
    entry = announced_machines()[kind]
    with sound(kind, f"loading {entry.value}"):
        found = entry.load()
    if isinstance(found, type) and issubclass(found, Machine) and found.model_fields["kind"].default == kind:
        return found
    allowed = f'of a package that works; {entry.value} is no subclass of Machine with kind = "{kind}"'
    raise InputError("rotor.kind", kind, allowed)


def rotor_tag(given: Any) -> Any:
    """Tag of a rotor in `AnyRotor`: its kind, or `ANNOUNCED` for a kind of another package."""
    kind = given.get("kind") if isinstance(given, Mapping) else getattr(given, "kind", None)
    ours = not isinstance(kind, str) or kind in CORE or kind in WINGS
    return ANNOUNCED if not ours and kind in announced_machines() else kind


AnyRotor = (
    Annotated[JeffcottRotor, Tag("jeffcott")]
    | Annotated[TwoPlaneRotor, Tag("two_plane")]
    | Annotated[TubRotor, Tag("tub")]
    | Annotated[Exciter, Tag("exciter")]
    | Annotated[MagneticRotor, Tag("magnetic")]
    | Annotated[Spindle, Tag("spindle")]
    | Annotated[SerializeAsAny[Machine], Tag(ANNOUNCED)]
)
# Kinds that carry no liquid and have an answer of their own.
WITHOUT_CHAMBERS = (Exciter, MagneticRotor, Spindle)
