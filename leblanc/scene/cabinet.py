"""The tables [cabinet] and [[points]] of a scene: what stands around the rotor, and where room is short."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, PlainValidator

from leblanc.core import units
from leblanc.core.units import MASS, MM, number, with_unit
from leblanc.scene.rows import Row, RowTable, Value, mm, row, three
from leblanc.scene.schema.part import Conflict, Part
from leblanc.scene.schema.rules import Place, Text, entries, one_of, quantity

if TYPE_CHECKING:
    from solvers.rotor.loads.floor import Cabinet as Standing
    from solvers.rotor.loads.machine import Point as Moving

MAX_FEET = 100
MAX_POINTS = 1000
ON = ("tub", "drum", "axis")

_NUMBER = quantity(units.NUMBER, -1e6, 1e6)
_Number = Annotated[float, _NUMBER]


class Cabinet(Part):
    """A rigid cabinet that stands still on a level floor.

    Examples
    --------
    >>> feet = [[0.2, 0.2, -0.4], [-0.2, 0.2, -0.4], [0.0, -0.2, -0.4]]
    >>> Cabinet(mass="25 kg", centre_of_mass=[0, 0, "-100 mm"], feet=feet).friction
    0.3
    """

    mass: Annotated[float, quantity(units.MASS, 0.0, 1e9)] = Field(
        description="of all that stands still: housing, counterweights on it"
    )
    centre_of_mass: Place = Field(
        (0.0, 0.0, 0.0), description="of the cabinet, x, y, z in the rotor's coordinates at rest"
    )
    feet: Annotated[tuple[Place, ...], entries(3, MAX_FEET, "places, each [x, y, z]")] = Field(
        description="where the feet touch the floor, all at one height, in the rotor's coordinates at rest; "
        "of more than three all are equally stiff"
    )
    friction: Annotated[float, quantity(units.NUMBER, 1e-6, 1e3)] = Field(
        0.3, description="coefficient between feet and floor: rubber on dry tiles 0.6, on wet ones 0.3"
    )

    def standing(self) -> Standing:
        """The cabinet as the solvers take it."""
        from solvers.rotor.loads.floor import Cabinet as Standing

        return Standing(self.mass, self.centre_of_mass, self.feet, self.friction)

    def rows(self) -> list[Row]:
        """Rows of the cabinet, for readers."""
        return [
            row("Cabinet mass", with_unit(self.mass, MASS), "cabinet.mass"),
            row(
                "Cabinet's centre of mass",
                f"({three(self.centre_of_mass, MM)}) mm",
                "cabinet.centre_of_mass",
            ),
            row("Friction of the feet", number(self.friction), "cabinet.friction"),
        ]

    def tables(self) -> list[RowTable]:
        """Feet of the cabinet, for readers."""
        lines = tuple(
            (Value(f"{k + 1}"), Value(f"({three(foot, MM)})", ("cabinet.feet",)))
            for k, foot in enumerate(self.feet)
        )
        return [RowTable(("Foot", "at x, y, z (mm)"), lines)]


class Point(Part):
    """A named point whose orbit and clearance are reported.

    Examples
    --------
    >>> Point(name="door", on="tub", position=[0, "0.2 m", "0.25 m"], gap="25 mm").gap
    0.025
    """

    name: Annotated[str, PlainValidator(Text(60))] = Field(description="free text, no two points alike")
    on: Annotated[str, one_of(*ON)] = Field(
        "axis",
        description="what it is fixed to: the tub, which does not spin (kind tub only); the drum or rotor, "
        "with which it goes round; or the spin axis",
    )
    position: Place = Field(description="x, y, z in the rotor's coordinates at rest")
    gap: Annotated[float | None, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        None, description="room to the housing at rest; no clearance is reported if left out"
    )
    direction: Annotated[
        tuple[_Number, _Number, _Number] | None, entries(3, 3, "pure numbers, along x, y, z")
    ] = Field(
        None, description="in which that room is, of any length; every direction across the axis if left out"
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A direction has a length."""
        along = values.get("direction")
        if along is not None and not any(along):
            yield Conflict(("direction",), "three pure numbers that are not all 0")

    def moving(self) -> Moving:
        """The point as the solvers take it."""
        from solvers.rotor.loads.machine import Point as Moving

        return Moving(self.name, self.position, self.on, self.gap, self.direction)


def point_table(points: tuple[Point, ...]) -> RowTable:
    """Table of the named points, for readers."""
    lines = []
    for k, point in enumerate(points):
        at = f"points.{k}"
        along = "across the axis" if point.direction is None else f"({three(point.direction)})"
        lines.append(
            (
                Value(point.name, (f"{at}.name",)),
                Value(point.on, (f"{at}.on",)),
                Value(f"({three(point.position, MM)})", (f"{at}.position",)),
                Value("not given" if point.gap is None else mm(point.gap), (f"{at}.gap",)),
                Value(along, (f"{at}.direction",)),
            )
        )
    return RowTable(("Point", "on", "at x, y, z (mm)", "gap", "gap towards"), tuple(lines))


# Kinds whose bodies no point of a cabinet moves with, in words.
_ALONE = {"exciter": "an exciter", "magnetic": "a rotor in magnetic bearings", "spindle": "a spindle"}


def cabinet_conflicts(values: Mapping[str, Any], kind: object) -> Iterator[Conflict]:
    """Conflicts of a scene's cabinet and points with its rotor's kind.

    `values`: of the scene, those without a fault of their own.
    """
    names = [point.name for point in values.get("points", ())]
    for k, name in enumerate(names):
        if name in names[:k]:
            yield Conflict(("points", k, "name"), "another name than those of the points before")
    if isinstance(kind, str) and kind in _ALONE:
        for key in ("cabinet", "points"):
            if values.get(key):
                yield Conflict((key,), f"left out for {_ALONE[kind]}")
    elif kind in ("jeffcott", "two_plane"):
        for k, point in enumerate(values.get("points", ())):
            if point.on == "tub":
                yield Conflict(("points", k, "on"), "drum or axis: this rotor has no tub")
