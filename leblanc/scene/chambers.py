"""A chamber of a scene with its liquid; `fill()` is what the solvers take."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, PlainValidator

from fluid.fill import Fill
from fluid.liquid import KNOWN_LIQUIDS, SALTS, BrineLaw, Liquid, brine
from fluid.temperature import (
    REFERENCE,
    Constant,
    Expansion,
    GivenLaw,
    PropertyLaw,
    Tabulated,
    Vogel,
    Walther,
)
from leblanc.core import units
from leblanc.core.files import path_text
from leblanc.scene.schema.load import meant
from leblanc.scene.schema.part import Conflict, Part, allowed_at
from leblanc.scene.schema.rules import (
    LENGTH,
    Length,
    Position,
    Quantity,
    Refused,
    Span,
    Text,
    entries,
    one_of,
    quantity,
    whole,
)
from meshes.baffles import Baffles as Plates
from meshes.chamber import Chamber as Walls
from meshes.chamber_section import ChamberSection, chamber_section
from meshes.errors import InputError
from meshes.section import Section

_MOST_BAFFLES = 64
OUTLINES = ".dxf, .step, .stp, .iges, .igs or .brep"


def round_chamber(
    radius: float, height: float, baffles: int, baffle_tip_radius: float, baffle_wall_gap: float
) -> Walls:
    """A round chamber with radial baffles or, where there are 0 of them, without any; lengths in m."""
    if not 0 <= baffles <= _MOST_BAFFLES:
        raise InputError("baffles", baffles, f"from 0 to {_MOST_BAFFLES}")
    if not baffles and (baffle_tip_radius != 0.0 or baffle_wall_gap != 0.0):
        raise InputError("baffles", baffles, "1 or more where their edges are given")
    plates = Plates(baffles, baffle_tip_radius, baffle_wall_gap) if baffles else None
    return Walls(radius, height, baffles=plates)


def is_outline(path: str | Path) -> bool:
    """Whether a file is a drawing or a model by its ending."""
    from meshes.files.outline import SUFFIXES

    return Path(path).suffix.lower() in SUFFIXES


def section_of_any_file(
    path: str | Path, unit: float | None, size: float | None, names: tuple[str, str]
) -> Section:
    """Section from a mesh file, or from an outline with quadratic cells, about the file's origin.

    `unit` of length, m (None: the one that the file names, of a mesh 1 m) and `size` of the cells at walls of
    an outline, m (None: a hundredth of its largest extent) are what the user calls `names`. An `InputError`
    also where the extra `cad` is missing.
    """
    if not is_outline(path):
        if size is not None:
            raise InputError(names[1], size, "left out for a mesh file, which has its cells")
        from meshes.files.exchange import read_section

        return read_section(path, 1.0 if unit is None else unit)
    from meshes.files.outline import outline_section

    try:
        return outline_section(path, size, scale=unit)
    except ImportError as missing:
        allowed = f"a mesh file; outlines need the extra `cad`: pip install leblanc[cad] ({missing})"
        raise InputError("path", str(path), allowed) from missing
    except InputError as fault:
        if fault.field == "height":
            allowed = "a plane outline; meshes.files.outline.outline_section cuts a solid at a height"
            raise InputError("path", str(path), allowed) from fault
        field = dict(zip(("scale", "wall_size"), names, strict=True)).get(fault.field, fault.field)
        raise InputError(field, fault.value, fault.allowed) from fault


MAX_BAFFLES = 360

_ROUNDING = 1e-9  # relative; a chamber filled to the brim may be written with nine digits
# Of the drum's space: a film of a radius times 2e-8, thinner than molecules; no mesh of doubles has it.
_FILM = 4e-8


MAX_TABLE = 1000  # points of a property over temperature

_Temperature = Annotated[float, quantity(units.TEMPERATURE, 1.0, 2000.0)]
_TEMPERATURES = Span(Quantity(units.TEMPERATURE, 1.0, 2000.0))
_Range = Annotated[tuple[float, float] | None, PlainValidator(_TEMPERATURES)]
_Temperatures = Annotated[tuple[_Temperature, ...], entries(2, MAX_TABLE, "rising temperatures")]
_Densities = Annotated[
    tuple[Annotated[float, quantity(units.DENSITY, 1e-3, 1e6)], ...],
    entries(2, MAX_TABLE, "densities, one a temperature"),
]
_Viscosities = Annotated[
    tuple[Annotated[float, quantity(units.VISCOSITY, 1e-12, 1e3)], ...],
    entries(2, MAX_TABLE, "kinematic viscosities, one a temperature"),
]


def _given_and_absent(
    given: Mapping[str, Any], needed: tuple[str, ...], fields: Mapping[str, Any], why: str
) -> Iterator[Conflict]:
    """Keys that a law needs stand there, and no others."""
    for key in needed:
        if key not in given:
            yield Conflict((key,), f"given {why}: {allowed_at(fields[key])}")
    for key in given:
        if key in fields and key not in (*needed, "law"):
            yield Conflict((key,), f"left out {why}")


def _broken(make: Callable[[], PropertyLaw]) -> Iterator[Conflict]:
    """What the law itself finds wrong with its numbers."""
    try:
        make()
    except InputError as fault:
        yield Conflict((fault.field,), fault.allowed)


class DensityLaw(Part):
    """A density over temperature: a table, or a value at one temperature and the expansion of the volume."""

    temperatures: _Temperatures = Field((), description="of the table; or value")
    values: _Densities = Field((), description="of the table")
    value: Annotated[float | None, quantity(units.DENSITY, 1e-3, 1e6)] = Field(
        None, description="at the temperature that follows; or temperatures and values"
    )
    temperature: Annotated[float | None, quantity(units.TEMPERATURE, 1.0, 2000.0)] = Field(
        None, description="of that value"
    )
    expansion: Annotated[float | None, quantity(units.EXPANSION, -0.1, 0.1)] = Field(
        None, description="of the volume over that at this temperature"
    )
    range: _Range = Field(None, description="temperatures between which the expansion holds")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A table or an expansion, and its numbers fit."""
        table = "temperatures" in given or "values" in given
        needed = ("temperatures", "values") if table else ("value", "temperature", "expansion", "range")
        why = "with a table" if table else "with an expansion"
        found = list(_given_and_absent(given, needed, cls.model_fields, why))
        yield from found
        if not found and set(needed) <= values.keys():
            yield from _broken(lambda: _density_law(values))

    def made(self) -> PropertyLaw:
        """The law as the liquids take it."""
        return _density_law(self.__dict__)


def _density_law(values: Mapping[str, Any]) -> PropertyLaw:
    if values["temperatures"]:
        return Tabulated(tuple(values["temperatures"]), tuple(values["values"]))
    return Expansion(values["value"], values["temperature"], values["expansion"], *values["range"])


class ViscosityLaw(Part):
    """A kinematic viscosity over temperature: a table, or a named law with its coefficients."""

    law: Annotated[str, one_of("table", "walther", "vogel", "andrade")] = Field(
        "table",
        description="table; walther: an oil through two points, ASTM D341; vogel: a exp(b / (T - c)); "
        "andrade: a exp(b / T)",
    )
    temperatures: _Temperatures = Field((), description="of the table, or two for walther")
    values: _Viscosities = Field((), description="at those temperatures")
    a: Annotated[float | None, quantity(units.VISCOSITY, 1e-30, 1e3)] = Field(
        None, description="for vogel and andrade"
    )
    b: Annotated[float | None, quantity(units.TEMPERATURE_STEP, 0.0, 1e6)] = Field(
        None, description="for vogel and andrade"
    )
    c: Annotated[float | None, quantity(units.TEMPERATURE, 0.0, 2000.0)] = Field(
        None, description="for vogel"
    )
    range: _Range = Field(None, description="temperatures between which the law holds; a table has its own")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Each law has its own keys, and its numbers fit."""
        if "law" not in values:
            return
        needed = _VISCOSITY_KEYS[values["law"]]
        why = f"with the law {values['law']}"
        found = list(_given_and_absent(given, needed, cls.model_fields, why))
        yield from found
        if not found and set(needed) <= values.keys():
            yield from _broken(lambda: _viscosity_law(values))

    def made(self) -> PropertyLaw:
        """The law as the liquids take it."""
        return _viscosity_law(self.__dict__)


_VISCOSITY_KEYS = {
    "table": ("temperatures", "values"),
    "walther": ("temperatures", "values", "range"),
    "vogel": ("a", "b", "c", "range"),
    "andrade": ("a", "b", "range"),
}


def _viscosity_law(values: Mapping[str, Any]) -> PropertyLaw:
    points = tuple(values["temperatures"]), tuple(values["values"])
    if values["law"] == "table":
        return Tabulated(*points)
    if values["law"] == "walther":
        return Walther(*points, *values["range"])
    return Vogel(values["a"], values["b"], values["c"] or 0.0, *values["range"])


@dataclass(frozen=True)
class Property(Quantity):
    """A property of a liquid: its value, or a table or law of its change with temperature."""

    table: type[Part] | None = None

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        return f"{super().allowed}; or a table of its change with temperature"

    def __call__(self, value: object) -> Any:
        """Value in SI units, or the law."""
        if isinstance(value, Tabulated | Expansion | Walther | Vogel):
            return value
        if isinstance(value, dict) and self.table is not None:
            return self.table.model_validate(value).made()  # type: ignore[attr-defined]
        return super().__call__(value)


class LiquidProperties(Part):
    """A liquid by its properties, each a value or a law of the temperature; or a salt in water."""

    density: Annotated[Any, PlainValidator(Property(units.DENSITY, 1e-3, 1e6, False, DensityLaw))] = Field(
        None, description="rho, or a table of its change with temperature; or salt"
    )
    viscosity: Annotated[Any, PlainValidator(Property(units.VISCOSITY, 0.0, 1e3, False, ViscosityLaw))] = (
        Field(None, description="kinematic viscosity nu, or a table of its change with temperature")
    )
    temperature: Annotated[float, quantity(units.TEMPERATURE, 1.0, 2000.0)] = Field(
        REFERENCE, description="at which the scene's volumes and a command without temperatures hold"
    )
    salt: Annotated[str | None, one_of(*SALTS)] = Field(None, description="of a brine; or density")
    mass_fraction: Annotated[float | None, quantity(units.NUMBER, 0.0, 1.0)] = Field(
        None, description="of that salt in the brine"
    )
    name: Annotated[str, PlainValidator(Text(100))] = Field("liquid", description="for reports, free text")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Density and viscosity, or a salt and its share; laws that have temperatures in common."""
        brine = "salt" in given or "mass_fraction" in given
        needed = ("salt", "mass_fraction") if brine else ("density", "viscosity")
        for key in needed:
            if key not in given:
                yield Conflict((key,), f"given: {allowed_at(cls.model_fields[key])}")
        for key in ("density", "viscosity", "temperature", "name") if brine else ():
            if key in given:
                yield Conflict((key,), "left out where salt is given")
        known = {*needed, "temperature"} <= values.keys() and all(values[key] is not None for key in needed)
        if not known or not set(needed) <= given.keys():
            return
        try:
            _liquid(values)
        except InputError as fault:
            key = {"range": "density"}.get(fault.field, fault.field)
            if key == "temperature" and "temperature" not in given:
                text = f"given, where density and viscosity do not hold at 20 degC: {fault.allowed}"
                yield Conflict((key,), text)
            else:
                yield Conflict((key,), fault.allowed)


def _liquid(values: Mapping[str, Any]) -> Liquid:
    """The liquid that a table describes."""
    if values["salt"] is not None:
        return brine(values["salt"], values["mass_fraction"])
    properties = values["density"], values["viscosity"]
    name, temperature = values.get("name", "liquid"), values["temperature"]
    density, viscosity = (Constant(value) if isinstance(value, float) else value for value in properties)
    if isinstance(density, Constant) and isinstance(viscosity, Constant):
        return Liquid(name, density.value, viscosity.value)
    law = GivenLaw(density, viscosity, temperature)
    return Liquid(name, density.at(temperature), viscosity.at(temperature), law)


class LiquidRule:
    """A known liquid by its name, or any by its properties."""

    table = LiquidProperties
    allowed = (
        f"one of: {', '.join(KNOWN_LIQUIDS)}; or a table {{ density = ..., viscosity = ... }} or "
        "{ salt = ..., mass_fraction = ... }"
    )

    def __call__(self, value: object) -> Liquid:
        """The liquid."""
        if isinstance(value, Liquid):
            return value
        if isinstance(value, dict):
            return _liquid(LiquidProperties.model_validate(value).__dict__)
        if isinstance(value, str) and value in KNOWN_LIQUIDS:
            return KNOWN_LIQUIDS[value]
        raise Refused(self.allowed + meant(value, KNOWN_LIQUIDS))

    @staticmethod
    def written(value: Liquid) -> object:
        """The liquid as a file says it; one with a name of its own and no law stays what it is."""
        if KNOWN_LIQUIDS.get(value.name) == value:
            return value.name
        law, name = value.law, {} if value.name == "liquid" else {"name": value.name}
        if isinstance(law, BrineLaw) and value == brine(law.salt, law.mass_fraction):
            return {"salt": law.salt, "mass_fraction": law.mass_fraction}
        if isinstance(law, GivenLaw) and value.density == law.density.at(law.reference):
            both = {"density": _law_table(law.density), "viscosity": _law_table(law.viscosity)}
            return both | name | {"temperature": law.reference}
        if value.name == "liquid" and law is None:
            return {"density": value.density, "viscosity": value.viscosity}
        return value


def _law_table(law: PropertyLaw) -> object:
    """A law as a file says it."""
    if isinstance(law, Constant):
        return law.value
    if isinstance(law, Tabulated):
        return {"temperatures": list(law.temperatures), "values": list(law.values)}
    span = {"range": [law.lowest, law.highest]}
    if isinstance(law, Expansion):
        point = {"value": law.value, "temperature": law.temperature}
        return point | {"expansion": law.expansion} | span
    if isinstance(law, Walther):
        points = {"temperatures": list(law.temperatures), "values": list(law.values)}
        return {"law": "walther"} | points | span
    assert isinstance(law, Vogel)
    coefficients = {"a": law.a, "b": law.b}
    if law.c == 0.0:
        return {"law": "andrade"} | coefficients | span
    return {"law": "vogel"} | coefficients | {"c": law.c} | span


class Baffles(Part):
    """Radial baffles of a chamber, all alike and evenly spaced."""

    count: Annotated[int, whole(1, MAX_BAFFLES)] = Field(description="how many there are")
    tip_radius: Annotated[float, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        0.0, description="distance of the inner edge from the axis; or height"
    )
    height: Annotated[float | None, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        None, description="extent from the outer edge towards the axis, in place of tip_radius"
    )
    wall_gap: Annotated[float, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        0.0, description="distance of the outer edge from the wall"
    )
    first_angle: Annotated[float, quantity(units.ANGLE, -7.0, 7.0)] = Field(
        0.0, description="of the first baffle"
    )
    loss: Annotated[float | None, quantity(units.NUMBER, 0.0, 1e6)] = Field(
        None,
        description="coefficient of the head that the flow loses at each, referred to the mean depth; by "
        "depth and flow if left out",
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """One of both says where the plates end."""
        if {"tip_radius", "height"} <= set(given):
            yield Conflict(("height",), "left out where tip_radius is given")

    def tip(self, radius: float) -> float:
        """Distance of the inner edge from the axis in a chamber of that radius, m."""
        return self.tip_radius if self.height is None else radius - self.wall_gap - self.height


class SectionRule:
    """A file of a chamber's section: a mesh or an outline; or a section that is read already."""

    allowed = f"the path of a mesh file of the section, .msh, .vtu or .xdmf, or of an outline, {OUTLINES}"

    def __call__(self, value: object) -> str | ChamberSection:
        """The path, or the section."""
        if isinstance(value, ChamberSection):
            return value
        if isinstance(value, Path):
            value = str(value)
        if not isinstance(value, str) or not value:
            raise Refused(self.allowed)
        if not Path(value).is_file():
            raise Refused(f"{self.allowed}; there is no such file")
        return value


@lru_cache(maxsize=64)
def section_from_file(path: str, unit: float | None, size: float | None = None) -> ChamberSection:
    """Section of a chamber from a mesh file or an outline, about the file's origin.

    `unit` and `size` as of `section_of_any_file`.
    """
    mesh = section_of_any_file(path, unit, size, ("section_unit", "section_size"))
    if size is None and is_outline(path):
        size = 0.01 * float(np.ptp(mesh.points, axis=0).max())
    return chamber_section(path_text(Path(path).name), mesh, size)


class Chamber(Part):
    """A chamber about the rotor's axis, circular or with a section of its own, and the liquid in it."""

    USUAL_KIND: ClassVar[bool] = True

    kind: Literal["liquid"] = Field("liquid", description="the kind of chamber")
    radius: Annotated[float | None, LENGTH] = Field(None, description="of the outer wall, R; or section")
    inner_radius: Annotated[float, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        0.0, description="of the inner wall, R_i; 0 if there is none"
    )
    section: Annotated[Any, PlainValidator(SectionRule())] = Field(
        None, description="file of a section of any other shape; its path counts from the scene's"
    )
    section_unit: Annotated[float | None, quantity(units.LENGTH, 1e-9, 1e3)] = Field(
        None, description="unit of length of that file, where it names none"
    )
    section_size: Annotated[float | None, quantity(units.LENGTH, 1e-9, 1e3)] = Field(
        None, description="of the cells at the walls of an outline; a hundredth of its extent if left out"
    )
    height: Length = Field(description="extent along the axis")
    plane: Position = Field(0.0, description="axial position on the rotor; used by two_plane and tub")
    baffles: Baffles | None = Field(None, description="thin radial plates over the whole height")
    liquid: Annotated[Liquid, PlainValidator(LiquidRule())] = Field(description="what is in it")
    volume: Annotated[float, quantity(units.VOLUME, 0.0, 1e9)] = Field(description="of liquid, V")

    @classmethod
    def as_table(cls, given: Any) -> Any:
        """A `fluid.fill.Fill` between circular walls stands for the chamber that holds it."""
        if not isinstance(given, Fill) or given.chamber.section is not None:
            return given
        walls = given.chamber
        table = {
            "radius": walls.radius,
            "inner_radius": walls.inner_radius,
            "height": walls.height,
            "plane": walls.plane,
            "liquid": given.liquid,
            "volume": given.volume,
        }
        if walls.baffles is None:
            return table
        plates = {key: value for key, value in asdict(walls.baffles).items() if value is not None}
        return table | {"baffles": plates}

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """Circular walls or a section; the baffles inside the walls, and the liquid between them."""
        if "section" in given:
            for key in ("radius", "inner_radius", "baffles"):
                if key in given:
                    yield Conflict((key,), "left out where section is given")
            yield from _in_section(values)
            return
        if "radius" not in given:
            yield Conflict(("radius",), f"given: {allowed_at(cls.model_fields['radius'])}; or section")
        radius = values.get("radius")
        if radius is None:
            return
        inner, plates = values.get("inner_radius"), values.get("baffles")
        if plates is not None and plates.tip(radius) >= radius - plates.wall_gap:
            text = f"a tip_radius below radius - wall_gap, {radius - plates.wall_gap:g} m"
            yield Conflict(("baffles",), text if plates.height is None else "plates of a height above 0")
        elif plates is not None and plates.tip(radius) < -_ROUNDING * radius:
            text = f"plates of a height up to radius - wall_gap, {radius - plates.wall_gap:g} m"
            yield Conflict(("baffles",), text)
        if inner is not None and inner >= radius:
            yield Conflict(("inner_radius",), f"below the radius of the chamber, {radius:g} m")
        elif {"inner_radius", "height", "volume"} <= values.keys():
            area = math.pi * (radius - inner) * (radius + inner)
            yield from _in_capacity(values["volume"], area * values["height"])

    def implied(self) -> dict[str, Any]:
        """Where plates end whose height is given."""
        plates, radius = self.baffles, self.radius
        if plates is None or plates.height is None or radius is None:
            return {}
        ended = plates.model_copy()  # the file says their height alone
        ended.__dict__["tip_radius"] = max(plates.tip(radius), 0.0)
        return {"baffles": ended}

    @cached_property
    def shape(self) -> ChamberSection | None:
        """The section of its own, if it has one."""
        if self.section is None or isinstance(self.section, ChamberSection):
            return self.section
        return section_from_file(self.section, self.section_unit, self.section_size)

    @cached_property
    def walls(self) -> Walls:
        """The chamber without its liquid."""
        if self.section is not None and self.shape is not None:
            return Walls(self.shape.farthest, self.height, plane=self.plane, section=self.shape)
        assert self.radius is not None
        baffles = self.baffles
        if baffles is not None:
            parts = (baffles.count, baffles.tip_radius, baffles.wall_gap, baffles.first_angle, baffles.loss)
        plates = None if baffles is None else Plates(*parts)
        return Walls(self.radius, self.height, self.inner_radius, self.plane, plates)

    @cached_property
    def _fill(self) -> Fill:
        return _held(self.walls, self.liquid, self.volume)

    def fill(self) -> Fill:
        """The chamber with its liquid, as the solvers take it."""
        return self._fill

    def holding(self, volume: float) -> Chamber:
        """The same chamber with another volume of its liquid, m^3.

        Raises
        ------
        InputError : more than the chamber holds
        """
        other = self.altered(volume=volume)
        other.__dict__["walls"] = self.walls  # the same, and hundreds of volumes are tried
        other.__dict__["_fill"] = _held(self.walls, self.liquid, volume)
        return other


def _held(walls: Walls, liquid: Liquid, volume: float) -> Fill:
    """What a chamber holds: full and empty within the rounding of a radius."""
    capacity, drum = walls.capacity, math.pi * walls.height * walls.radius**2
    if volume < _FILM * drum:
        return Fill(walls, liquid, 0.0)
    full = capacity < volume <= capacity * (1.0 + _ROUNDING)
    return Fill(walls, liquid, capacity if full else volume)


def _in_section(values: Mapping[str, Any]) -> Iterator[Conflict]:
    """The file of a section can be used, and holds the volume."""
    path = values.get("section")
    if path is None or not {"section_unit", "section_size"} <= values.keys():
        return
    try:
        section = path
        if isinstance(path, str):
            section = section_from_file(path, values["section_unit"], values["section_size"])
    except InputError as error:
        reason = error.allowed if error.field == "path" else f"{error.field} {error.allowed}"
        yield Conflict(("section",), f"{SectionRule.allowed}: {reason}")
        return
    if {"height", "volume"} <= values.keys():
        yield from _in_capacity(values["volume"], float(section.area * values["height"]))


def _in_capacity(volume: float, capacity: float) -> Iterator[Conflict]:
    """A chamber holds its liquid."""
    if volume > capacity * (1.0 + _ROUNDING):
        text = f"at most what the chamber holds, {capacity:.6g} m^3"
        yield Conflict(("volume",), text)
