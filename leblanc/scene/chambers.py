"""A chamber of a scene with its liquid; `fill()` is what the solvers take."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field, PlainValidator

from fluid.fill import Fill
from fluid.liquid import KNOWN_LIQUIDS, Liquid
from leblanc import units
from leblanc.files import path_text
from leblanc.scene.schema.load import meant
from leblanc.scene.schema.part import Conflict, Part, allowed_at
from leblanc.scene.schema.rules import LENGTH, Length, Position, Refused, quantity, whole
from meshes.baffles import Baffles as Plates
from meshes.chamber import Chamber as Walls
from meshes.chamber_section import ChamberSection, chamber_section
from meshes.errors import InputError
from meshes.section import Section

OUTLINES = ".dxf, .step, .stp, .iges, .igs or .brep"


def is_outline(path: str | Path) -> bool:
    """Whether a file is a drawing or a model by its ending.

    Parameters
    ----------
    path : of the file
    """
    from meshes.files.outline import SUFFIXES

    return Path(path).suffix.lower() in SUFFIXES


def section_of_any_file(
    path: str | Path, unit: float | None, size: float | None, names: tuple[str, str]
) -> Section:
    """Section from a mesh file or from an outline, about the file's origin.

    Parameters
    ----------
    path : of the file
    unit : its unit of length, m; None for the one that it names, of a mesh for 1 m
    size : of the cells at walls of an outline, m; None for a hundredth of its largest extent
    names : what the user calls unit and size

    Returns
    -------
    The section; that of an outline has quadratic cells.

    Raises
    ------
    InputError : a file that cannot be used, a size for a mesh file, which has its cells, a unit that is
        missing, or given where the file names it, a library of the extra `cad` that is missing
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


class LiquidProperties(Part):
    """A liquid by its properties."""

    density: Annotated[float, quantity(units.DENSITY, 1e-3, 1e6)] = Field(description="rho")
    viscosity: Annotated[float, quantity(units.VISCOSITY, 0.0, 1e3)] = Field(
        description="kinematic viscosity nu"
    )


class LiquidRule:
    """A known liquid by its name, or any by its properties."""

    table = LiquidProperties
    allowed = f"one of: {', '.join(KNOWN_LIQUIDS)}; or a table {{ density = ..., viscosity = ... }}"

    def __call__(self, value: object) -> Liquid:
        """The liquid."""
        if isinstance(value, Liquid):
            return value
        if isinstance(value, dict):
            table = LiquidProperties.model_validate(value)
            return Liquid("liquid", table.density, table.viscosity)
        if isinstance(value, str) and value in KNOWN_LIQUIDS:
            return KNOWN_LIQUIDS[value]
        raise Refused(self.allowed + meant(value, KNOWN_LIQUIDS))

    @staticmethod
    def written(value: Liquid) -> object:
        """As a file says it; a liquid with a name of its own stays what it is.

        Parameters
        ----------
        value : the liquid
        """
        if KNOWN_LIQUIDS.get(value.name) == value:
            return value.name
        if value.name == "liquid":
            return {"density": value.density, "viscosity": value.viscosity}
        return value


class Baffles(Part):
    """Radial baffles of a chamber, all alike and evenly spaced."""

    count: Annotated[int, whole(1, MAX_BAFFLES)] = Field(description="how many there are")
    tip_radius: Annotated[float, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        0.0, description="distance of the inner edge from the axis"
    )
    wall_gap: Annotated[float, quantity(units.LENGTH, 0.0, 1e3)] = Field(
        0.0, description="distance of the outer edge from the wall"
    )
    first_angle: Annotated[float, quantity(units.ANGLE, -7.0, 7.0)] = Field(
        0.0, description="of the first baffle"
    )


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

    Parameters
    ----------
    path : of the file
    unit : its unit of length, m; None for the one that it names, of a mesh for 1 m
    size : of the cells at walls of an outline, m; None for a hundredth of its largest extent
    """
    mesh = section_of_any_file(path, unit, size, ("section_unit", "section_size"))
    if size is None and is_outline(path):
        size = 0.01 * float(np.ptp(mesh.points, axis=0).max())
    return chamber_section(path_text(Path(path).name), mesh, size)


class Chamber(Part):
    """A chamber about the rotor's axis, circular or with a section of its own, and the liquid in it."""

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
        return table if walls.baffles is None else table | {"baffles": asdict(walls.baffles)}

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
        if plates is not None and plates.tip_radius >= radius - plates.wall_gap:
            text = f"a tip_radius below radius - wall_gap, {radius - plates.wall_gap:g} m"
            yield Conflict(("baffles",), text)
        if inner is not None and inner >= radius:
            yield Conflict(("inner_radius",), f"below the radius of the chamber, {radius:g} m")
        elif {"inner_radius", "height", "volume"} <= values.keys():
            area = math.pi * (radius - inner) * (radius + inner)
            yield from _in_capacity(values["volume"], area * values["height"])

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
            parts = (baffles.count, baffles.tip_radius, baffles.wall_gap, baffles.first_angle)
        plates = None if baffles is None else Plates(*parts)
        return Walls(self.radius, self.height, self.inner_radius, self.plane, plates)

    @cached_property
    def _fill(self) -> Fill:
        volume, capacity = self.volume, self.walls.capacity
        full = capacity < volume <= capacity * (1.0 + _ROUNDING)
        return Fill(self.walls, self.liquid, capacity if full else volume)

    def fill(self) -> Fill:
        """The chamber with its liquid, as the solvers take it."""
        return self._fill

    def holding(self, volume: float) -> Chamber:
        """The same chamber with another volume of its liquid.

        Parameters
        ----------
        volume : m^3

        Raises
        ------
        InputError : more than the chamber holds
        """
        other = self.altered(volume=volume)
        other.__dict__["walls"] = self.walls  # the same, and hundreds of volumes are tried
        other.__dict__["_fill"] = Fill(self.walls, self.liquid, volume)
        return other


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
