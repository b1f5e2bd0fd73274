"""The spindle of a machine tool in a scene: beams of sections, masses on them, joints, where it is driven."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, PlainValidator

from leblanc.core import units
from leblanc.core.units import MASS, MM, in_rpm, number, with_unit
from leblanc.scene.bearings import (
    ROLLING,
    BallDiameter,
    CagedBearing,
    ContactAngle,
    PitchDiameter,
    caged,
    rolling_columns,
    rolling_conflicts,
)
from leblanc.scene.rows import Row, RowTable, Value, row
from leblanc.scene.schema.part import Conflict, Part
from leblanc.scene.schema.rules import SPEED, Axis, Length, Mass, Refused, entries, one_of, quantity

if TYPE_CHECKING:
    from solvers.rotor.shaft.structure import Coordinate, Station, Structure

GROUND = "ground"
MOST_BEAMS, MOST_SECTIONS, MOST_JOINTS = 20, 100, 200
THEORIES = ("euler", "rayleigh", "timoshenko")

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,39}")
_STATION = re.compile(r"([A-Za-z][A-Za-z0-9_]{0,39})\.(\d{1,3})")
_STATION_TEXT = 'the name of a beam and the number of its station from 0, such as "housing.2"'


def without_liquid(values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
    """Conflicts of what a scene leaves out where its rotor is a spindle."""
    for key in ("chambers", "model", "runup", "programme", "optimise"):
        if key in values and key in given and values[key] not in ((), None):
            yield Conflict((key,), "left out for a spindle, which holds no liquid and is driven by a force")


class BeamName:
    """A word."""

    allowed = "a word of at most 40 letters, digits and underscores that begins with a letter"

    def __call__(self, value: object) -> str:
        """The word."""
        if isinstance(value, str) and _NAME.fullmatch(value) and value != GROUND:
            return value
        raise Refused(f"{self.allowed}, other than {GROUND}")


class StationName:
    """Beam and station, or the ground."""

    def __init__(self, ground: bool = False) -> None:
        self.ground = ground

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        return f'{_STATION_TEXT}, or "{GROUND}"' if self.ground else _STATION_TEXT

    def __call__(self, value: object) -> str:
        """The name."""
        if isinstance(value, str) and (_STATION.fullmatch(value) or (self.ground and value == GROUND)):
            return value
        raise Refused(self.allowed)


_At = Annotated[str, PlainValidator(StationName())]
_Damping = Annotated[float, quantity(units.DAMPING, 0.0, 1e15)]
_Stiffness = Annotated[float, quantity(units.STIFFNESS, 0.0, 1e15)]
_AngularStiffness = Annotated[float, quantity(units.ANGULAR_STIFFNESS, 0.0, 1e15)]
_AngularDamping = Annotated[float, quantity(units.ANGULAR_DAMPING, 0.0, 1e15)]


class BeamSection(Part):
    """A round piece of a beam."""

    length: Length = Field(description="along the axis")
    diameter: Length = Field(description="outer one")
    bore: Annotated[float, quantity(units.LENGTH, 0.0, 1e3)] = Field(0.0, description="inner diameter")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A bore leaves a wall."""
        if {"bore", "diameter"} <= values.keys() and values["bore"] >= values["diameter"]:
            yield Conflict(("bore",), f"below the diameter, {values['diameter']:g} m")


class Beam(Part):
    """A beam of sections, each of one diameter, of one material; its stations are where sections meet."""

    name: Annotated[str, PlainValidator(BeamName())] = Field(description="of the beam, by which stations go")
    elastic_modulus: Annotated[float, quantity(units.ELASTIC_MODULUS, 1e3, 1e13)] = Field(
        210e9, description="of its material, E"
    )
    density: Annotated[float, quantity(units.DENSITY, 1e-3, 1e6)] = Field(
        7850.0, description="of its material"
    )
    poisson_ratio: Annotated[float, quantity(units.NUMBER, 0.0, 0.499)] = Field(
        0.3, description="of its material, for the shear"
    )
    sections: Annotated[tuple[BeamSection, ...], entries(1, MOST_SECTIONS, "tables of a length")] = Field(
        description="from its first station on, one table each"
    )


class SpindleMass(Part):
    """A body on a beam: a disc, a pulley."""

    station: _At = Field(description=f"where it sits: {_STATION_TEXT}")
    mass: Mass = Field(description="of it")
    inertia: Annotated[float, quantity(units.INERTIA, 0.0, 1e12)] = Field(
        0.0, description="across the axis, about the station"
    )


class SpindleJoint(Part):
    """A spring with a damper between two beams, or between a beam and the ground."""

    station: _At = Field(description=f"one end: {_STATION_TEXT}")
    to: Annotated[str, PlainValidator(StationName(ground=True))] = Field(
        GROUND, description="the other end: a station of another beam, or ground"
    )
    stiffness: _Stiffness = Field(description="across the axis")
    damping: _Damping = Field(0.0, description="across the axis")
    angular_stiffness: _AngularStiffness = Field(0.0, description="against a difference of the slopes")
    angular_damping: _AngularDamping = Field(0.0, description="likewise")
    ball_diameter: BallDiameter = None
    pitch_diameter: PitchDiameter = None
    contact_angle: ContactAngle = 0.0

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Balls and their circle belong together."""
        yield from rolling_conflicts(values, given)


class Spindle(Part):
    """A spindle unit with what holds it, vibrating in one plane under a harmonic force: no liquid.

    Examples
    --------
    >>> import leblanc as lb
    >>> rotor = lb.example("spindle").rotor
    >>> [len(beam.sections) for beam in rotor.beams]
    [2, 6, 7, 4]
    """

    kind: Literal["spindle"] = Field("spindle", description="the kind of rotor")
    theory: Annotated[Literal["euler", "rayleigh", "timoshenko"], one_of(*THEORIES)] = Field(
        "timoshenko",
        description="of the beams: euler has the mass alone, rayleigh also rotary inertia, timoshenko also "
        "shear",
    )
    driven: _At = Field(description=f"where the unit force acts: {_STATION_TEXT}")
    measured: _At = Field(description="where the vibration is measured, 1 in W = q2/q1")
    wanted: _At = Field(description="where the vibration is asked for, 2 in W = q2/q1")
    beams: Annotated[tuple[Beam, ...], entries(1, MOST_BEAMS, "tables headed [[rotor.beams]]")] = Field(
        description="of the machine: tool holder, spindle, housing, frame, one table each"
    )
    masses: Annotated[tuple[SpindleMass, ...], entries(0, MOST_JOINTS, "tables headed [[rotor.masses]]")] = (
        Field((), description="on the beams, one table each")
    )
    joints: Annotated[tuple[SpindleJoint, ...], entries(1, MOST_JOINTS, "tables headed [[rotor.joints]]")] = (
        Field(description="bearings, clamps and supports, one table each")
    )

    rotation: Annotated[float | None, SPEED] = Field(
        None,
        description="speed at which the spindle turns, which has no part in its vibration; the cages of "
        "joints with ball_diameter and pitch_diameter are reported at it",
    )

    _POINTS: ClassVar = ("driven", "measured", "wanted")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Beams have names of their own, stations are there, a joint has two ends."""
        if "joints" in values and "rotation" not in given:
            for k, joint in enumerate(values["joints"]):
                if joint.ball_diameter is not None:
                    yield Conflict(("joints", k, "ball_diameter"), "left out without rotor.rotation")
        beams = values.get("beams")
        if not beams:
            return
        names = [beam.name for beam in beams]
        for k, name in enumerate(names):
            if name in names[:k]:
                yield Conflict(("beams", k, "name"), "another name than those of the beams before")
        known = {f"{beam.name}.{k}" for beam in beams for k in range(len(beam.sections) + 1)}
        ends = ", ".join(f"{beam.name}.{len(beam.sections)}" for beam in beams)
        text = f"a station that is there, the last ones being {ends}"
        for key in cls._POINTS:
            if key in values and values[key] not in known:
                yield Conflict((key,), text)
        for k, mass in enumerate(values.get("masses", ())):
            if mass.station not in known:
                yield Conflict(("masses", k, "station"), text)
        for k, joint in enumerate(values.get("joints", ())):
            if joint.station not in known:
                yield Conflict(("joints", k, "station"), text)
            if joint.to != GROUND and joint.to not in known:
                yield Conflict(("joints", k, "to"), text)
            elif joint.to.partition(".")[0] == joint.station.partition(".")[0]:
                yield Conflict(("joints", k, "to"), f"a station of another beam, or {GROUND}")

    @property
    def axis(self) -> Axis:
        """Always horizontal: gravity has no part in small vibrations, and these are across the axis."""
        return "horizontal"

    def station(self, name: str) -> Station:
        """A station as the solvers number it."""
        beam, _, place = name.partition(".")
        return [part.name for part in self.beams].index(beam), int(place)

    def coordinate(self, name: str) -> Coordinate:
        """The deflection of a station."""
        from solvers.rotor.shaft.structure import Coordinate

        return Coordinate(self.station(name))

    @cached_property
    def _machine(self) -> Structure:
        from solvers.rotor.shaft.section import round_section
        from solvers.rotor.shaft.structure import Joint, PointMass, Structure

        beams = tuple(
            tuple(
                round_section(
                    *(section.length, section.diameter, section.bore),
                    elastic_modulus=beam.elastic_modulus,
                    density=beam.density,
                    poisson_ratio=beam.poisson_ratio,
                    theory=self.theory,
                )
                for section in beam.sections
            )
            for beam in self.beams
        )
        masses = tuple(PointMass(self.station(part.station), part.mass, part.inertia) for part in self.masses)
        joints = tuple(
            Joint(
                self.station(part.station),
                None if part.to == GROUND else self.station(part.to),
                *(part.stiffness, part.damping, part.angular_stiffness, part.angular_damping),
            )
            for part in self.joints
        )
        return Structure(beams, masses, joints)

    def caged(self) -> tuple[CagedBearing, ...]:
        """Joints whose balls are given."""
        return caged([(f"{joint.station} to {joint.to}", joint) for joint in self.joints])

    def content(self) -> dict[str, Any]:
        """The spindle for a fingerprint; what came later counts only where it is given."""
        found = self.model_dump()
        if self.rotation is None:
            del found["rotation"]
        for joint in found["joints"]:
            if joint["ball_diameter"] is None:
                for key in ROLLING:
                    del joint[key]
        return found

    def machine(self) -> Structure:
        """Beams, masses and joints as the solvers take them."""
        return self._machine

    def rows(self) -> list[Row]:
        """Rows of the spindle, for readers."""
        return [
            row("Rotor", "spindle", "rotor.kind"),
            row("Beam theory", self.theory, "rotor.theory"),
            row("Driven by a unit force at", self.driven, "rotor.driven"),
            row("Vibration measured at", self.measured, "rotor.measured"),
            row("Vibration wanted at", self.wanted, "rotor.wanted"),
            *([] if self.rotation is None else [row("Turns at", in_rpm(self.rotation), "rotor.rotation")]),
            *(
                row(
                    f"Material of {beam.name}",
                    f"E {number(beam.elastic_modulus * 1e-9)} GPa, {number(beam.density)} kg/m³, "
                    f"nu {number(beam.poisson_ratio)}",
                    *(f"rotor.beams.{k}.{key}" for key in ("elastic_modulus", "density", "poisson_ratio")),
                )
                for k, beam in enumerate(self.beams)
            ),
            *(
                row(
                    f"Mass at {part.station}",
                    f"{with_unit(part.mass, MASS)}, {number(part.inertia)} kg m² across",
                    *(f"rotor.masses.{k}.{key}" for key in ("mass", "inertia")),
                )
                for k, part in enumerate(self.masses)
            ),
        ]

    def tables(self) -> list[RowTable]:
        """Sections and joints, for readers."""
        sections = tuple(
            (
                Value(f"{beam.name}.{k} to {k + 1}"),
                *(
                    Value(number(getattr(section, key) * MM), (f"rotor.beams.{b}.sections.{k}.{key}",))
                    for key in ("length", "diameter", "bore")
                ),
            )
            for b, beam in enumerate(self.beams)
            for k, section in enumerate(beam.sections)
        )
        balls, columns = rolling_columns(self.joints, "rotor.joints")
        keys = ("stiffness", "damping", "angular_stiffness", "angular_damping")
        joints = tuple(
            (
                Value(f"{part.station} to {part.to}"),
                *(Value(number(getattr(part, key)), (f"rotor.joints.{k}.{key}",)) for key in keys),
                *columns[k],
            )
            for k, part in enumerate(self.joints)
        )
        heads = ("stiffness (N/m)", "damping (N s/m)", "angular (N m/rad)", "its damping (N m s/rad)")
        return [
            RowTable(("Section", "length (mm)", "diameter (mm)", "bore (mm)"), sections),
            RowTable(("Joint", *heads, *balls), joints),
        ]
