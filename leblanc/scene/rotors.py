"""The rotor of a scene, a class for each kind; `machine()` is the solvers' rotor without liquid."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, PlainValidator

from leblanc import units
from leblanc.scene.part import Conflict, Part
from leblanc.scene.rules import (
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


class JeffcottRotor(Part):
    """A rotor on an isotropic support, moving in one plane."""

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


class Support(Part):
    """An isotropic support of the rotor's axis."""

    position: Position = Field(description="along the axis from the rotor's centre of mass")
    stiffness: Annotated[float, quantity(units.STIFFNESS, 0.0, 1e15)] = Field(
        description="the same in all directions across the axis"
    )
    damping: Damping = Field(description="likewise")


class PlaneUnbalance(Part):
    """An unbalance in one plane across the axis."""

    position: Position = Field(description="of the plane, along the axis from the rotor's centre of mass")
    size: Unbalance = Field(description="mass times its distance from the axis")
    angle: Annotated[float, quantity(units.ANGLE, -1e3, 1e3)] = Field(
        0.0, description="fixed in the rotor, positive with the spin"
    )


class TwoPlaneRotor(Part):
    """A rigid rotor in supports along its axis."""

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

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """No body has more inertia about an axis than about the two across it together."""
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
                two_plane.Support(one.position, one.stiffness, one.damping) for one in self.supports
            ),
            unbalances=tuple(
                two_plane.PlaneUnbalance(one.position, one.size, one.angle) for one in self.unbalances
            ),
        )

    def machine(self) -> TwoPlane:
        """The rotor without liquid."""
        return self._machine


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
            several, one = (
                "a list of three, along x, y, z, where no direction is given",
                "a single value, along the direction that is given",
            )
            yield Conflict((key,), several if along is None else one)

    def mount(self) -> Mount:
        """As the solvers take it."""
        from solvers.rotor.tub import Mount

        value = getattr(self, self.COEFFICIENT)
        if isinstance(value, tuple):
            return Mount(self.position, along_axes=value)
        assert self.direction is not None
        return Mount(self.position, coefficient=value, direction=self.direction)


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


class TubRotor(Part):
    """A suspended tub with its drum, which spins about y."""

    kind: Literal["tub"] = Field("tub", description="the kind of rotor")
    tub_mass: Mass = Field(description="of the tub and all that does not spin")
    drum_mass: Mass = Field(description="of the drum without the liquid")
    tub_inertia: Annotated[
        tuple[Inertia, Inertia, Inertia], entries(3, 3, "moments of inertia, about x, y, z")
    ] = Field(description="of the tub about x, y, z through its centre of mass")
    drum_polar_inertia: Inertia = Field(description="of the drum about its axis")
    drum_transverse_inertia: Inertia = Field(description="of the drum across its axis, about its own centre")
    drum_position: Place = Field((0.0, 0.0, 0.0), description="of the drum's centre, x, y, z")
    unbalance: Unbalance = Field(description="of the laundry, mass times its distance from the axis")
    unbalance_position: Annotated[float | None, POSITION] = Field(
        None, description="y of the unbalance; that of the drum's centre if left out"
    )
    springs: Annotated[tuple[Spring, ...], entries(1, MAX_PARTS, "tables headed [[rotor.springs]]")] = Field(
        description="between the tub and the ground, one table each"
    )
    dampers: Annotated[tuple[Damper, ...], entries(0, MAX_PARTS, "tables headed [[rotor.dampers]]")] = Field(
        (), description="between the tub and the ground, one table each"
    )
    axis: Axis = Field("horizontal", description=_AXIS)

    @cached_property
    def _machine(self) -> Tub:
        from solvers.rotor.tub import Tub

        return Tub(
            tub_mass=self.tub_mass,
            drum_mass=self.drum_mass,
            tub_inertia=self.tub_inertia,
            drum_polar_inertia=self.drum_polar_inertia,
            drum_transverse_inertia=self.drum_transverse_inertia,
            drum_position=self.drum_position,
            unbalance=self.unbalance,
            unbalance_position=self.unbalance_position,
            springs=tuple(one.mount() for one in self.springs),
            dampers=tuple(one.mount() for one in self.dampers),
        )

    def machine(self) -> Tub:
        """Tub and drum without liquid."""
        return self._machine


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
    """A platform that vibrates along one line, shaken by an unbalance and by balls in a rotating track."""

    kind: Literal["exciter"] = Field("exciter", description="the kind of rotor")
    platform_mass: Mass = Field(description="of all that vibrates without the balls")
    stiffness: Stiffness = Field(description="of the platform's springs")
    damping: Damping = Field(description="of the platform")
    unbalance: Unbalance = Field(description="of the shaft, mass times its distance from the axis")
    balls: Balls = Field(description="in the track on the shaft")

    @property
    def axis(self) -> Axis:
        """Its shaft lies across the vibration."""
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


AnyRotor = JeffcottRotor | TwoPlaneRotor | TubRotor | Exciter
