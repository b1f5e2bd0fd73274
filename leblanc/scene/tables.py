"""The tables of a scene file: their keys, the rule of each value, and how the values of a table bind."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, ValidationInfo, field_validator

from fluid.liquid import KNOWN_LIQUIDS, Liquid
from leblanc import units
from leblanc.scene.optimise import DutyTable, OptimiseTable
from leblanc.scene.rotors import ROTORS, ExciterTable, JeffcottTable, TubTable, TwoPlaneTable
from leblanc.scene.rules import (
    LENGTH,
    Entries,
    Length,
    OneOf,
    Position,
    Quantity,
    Refused,
    Speed,
    Table,
    Text,
    Whole,
)
from leblanc.scene.runup import MotorTable, RunupTable
from meshes.baffles import Baffles
from meshes.chamber import Chamber
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


MAX_CHAMBERS = 1000
MAX_SPEEDS = 100_000
MAX_BAFFLES = 360
MAX_ASSUMED = 10_000

_LIQUID_MODELS = ("auto", "statics", "linear", "long_wave", "kdv", "fem")
_ROUNDING = 1e-9  # relative; a chamber filled to the brim may be written with nine digits

_Path = Annotated[str, BeforeValidator(Text(200))]


class LiquidTable(Table):
    """liquid = { density = ..., viscosity = ... }."""

    density: Annotated[float, BeforeValidator(Quantity(units.DENSITY, 1e-3, 1e6))]
    viscosity: Annotated[float, BeforeValidator(Quantity(units.VISCOSITY, 0.0, 1e3))]


class LiquidRule:
    """A known liquid by its name, or any by its properties."""

    allowed = f"one of: {', '.join(KNOWN_LIQUIDS)}; or a table {{ density = ..., viscosity = ... }}"

    def __call__(self, value: object) -> Liquid:
        """The liquid."""
        if isinstance(value, dict):
            table = LiquidTable.model_validate(value)
            return Liquid("liquid", table.density, table.viscosity)
        if isinstance(value, str) and value in KNOWN_LIQUIDS:
            return KNOWN_LIQUIDS[value]
        raise Refused(self.allowed)


class BafflesTable(Table):
    """baffles = { count = ..., tip_radius = ... }."""

    count: Annotated[int, BeforeValidator(Whole(1, MAX_BAFFLES))]
    tip_radius: Annotated[float, BeforeValidator(Quantity(units.LENGTH, 0.0, 1e3))] = 0.0
    wall_gap: Annotated[float, BeforeValidator(Quantity(units.LENGTH, 0.0, 1e3))] = 0.0
    first_angle: Annotated[float, BeforeValidator(Quantity(units.ANGLE, -7.0, 7.0))] = 0.0


class SectionRule:
    """A file of a chamber's section, read with its unit: a mesh, or an outline and the size of its cells."""

    allowed = f"the path of a mesh file of the section, .msh, .vtu or .xdmf, or of an outline, {OUTLINES}"

    def __call__(self, value: object, info: ValidationInfo) -> ChamberSection:
        """The section."""
        if not isinstance(value, str) or not value:
            raise Refused(self.allowed)
        if not Path(value).is_file():
            raise Refused(f"{self.allowed}; there is no such file")
        try:
            return section_from_file(value, info.data.get("section_unit"), info.data.get("section_size"))
        except InputError as error:
            reason = error.allowed if error.field == "path" else f"{error.field} {error.allowed}"
            raise Refused(f"{self.allowed}: {reason}") from error


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
    return chamber_section(Path(path).name, mesh, size)


class ChamberTable(Table):
    """[[chambers]]."""

    section_unit: Annotated[float | None, BeforeValidator(Quantity(units.LENGTH, 1e-9, 1e3))] = None
    section_size: Annotated[float | None, BeforeValidator(Quantity(units.LENGTH, 1e-9, 1e3))] = None
    section: Annotated[Any, BeforeValidator(SectionRule())] = None
    radius: Annotated[float | None, LENGTH] = None
    inner_radius: Annotated[float, BeforeValidator(Quantity(units.LENGTH, 0.0, 1e3))] = 0.0
    height: Length
    plane: Position = 0.0
    baffles: BafflesTable | None = None
    liquid: Annotated[Liquid, BeforeValidator(LiquidRule())]
    volume: Annotated[float, BeforeValidator(Quantity(units.VOLUME, 0.0, 1e9))]

    @field_validator("inner_radius")
    @classmethod
    def _inside_the_wall(cls, value: float, info: ValidationInfo) -> float:
        radius = info.data.get("radius")
        if radius is not None and value >= radius:
            raise Refused(f"below the radius of the chamber, {radius:g} m")
        return value

    @field_validator("baffles")
    @classmethod
    def _inside_the_chamber(cls, value: BafflesTable | None, info: ValidationInfo) -> BafflesTable | None:
        radius = info.data.get("radius")
        if value is not None and radius is not None and value.tip_radius >= radius - value.wall_gap:
            raise Refused(f"a tip_radius below radius - wall_gap, {radius - value.wall_gap:g} m")
        return value

    @field_validator("volume")
    @classmethod
    def _fits_the_chamber(cls, value: float, info: ValidationInfo) -> float:
        section, height = info.data.get("section"), info.data.get("height")
        radius, inner = info.data.get("radius"), info.data.get("inner_radius")
        if height is None:
            return value
        if section is not None:
            capacity = float(section.area * height)
        elif radius is not None and inner is not None:
            capacity = Chamber(radius, height, inner).capacity
        else:
            return value
        if value > capacity * (1.0 + _ROUNDING):
            raise Refused(f"at most what the chamber holds, {capacity:.6g} m^3 ({capacity * 1e6:.6g} ml)")
        return min(value, capacity)

    def chamber(self) -> Chamber:
        """The chamber."""
        if self.section is not None:
            farthest = self.section.farthest
            return Chamber(farthest, self.height, plane=self.plane, section=self.section)
        assert self.radius is not None
        baffles = None if self.baffles is None else Baffles(**self.baffles.model_dump())
        return Chamber(self.radius, self.height, self.inner_radius, self.plane, baffles)


class SpeedsTable(Table):
    """[speeds]."""

    start: Speed
    stop: Speed
    count: Annotated[int, BeforeValidator(Whole(1, MAX_SPEEDS))]

    @field_validator("stop")
    @classmethod
    def _not_before_start(cls, value: float, info: ValidationInfo) -> float:
        start = info.data.get("start")
        if start is not None and value < start:
            raise Refused(f"at least speeds.start, {start:g} rad/s")
        return value

    @field_validator("count")
    @classmethod
    def _reaches_both_ends(cls, value: int, info: ValidationInfo) -> int:
        if value == 1 and {"start", "stop"} <= info.data.keys() and info.data["start"] != info.data["stop"]:
            raise Refused("at least 2 where speeds.start and speeds.stop differ")
        return value


class FrictionTable(Table):
    """friction = { linear = ... } or { quadratic = ... }."""

    linear: Annotated[float | None, BeforeValidator(Quantity(units.RATE, 0.0, 1e6))] = None
    quadratic: Annotated[float | None, BeforeValidator(Quantity(units.NUMBER, 0.0, 1e3))] = None


class FrictionRule:
    """A friction law by its name, or with its coefficient."""

    allowed = 'one of: none, stokes, { linear = "0.5 1/s" }, { quadratic = 0.01 }'

    def __call__(self, value: object) -> tuple[str, float]:
        """Law and coefficient, 0 where there is none."""
        if isinstance(value, str) and value in ("none", "stokes"):
            return value, 0.0
        if isinstance(value, dict):
            coefficients = FrictionTable.model_validate(value).model_dump(exclude_none=True)
            if len(coefficients) == 1:
                return next(iter(coefficients.items()))
        raise Refused(self.allowed)


class ModelTable(Table):
    """[model]."""

    liquid: Annotated[str, BeforeValidator(OneOf(_LIQUID_MODELS))] = "auto"
    friction: Annotated[Any, BeforeValidator(FrictionRule())] = ("stokes", 0.0)
    tolerance: Annotated[float, BeforeValidator(Quantity(units.NUMBER, 1e-12, 1.0))] = 1e-3


_TABLES = BeforeValidator(Entries(0, MAX_CHAMBERS, "tables headed [[chambers]]"))


class SceneTable(Table):
    """The whole file, whatever the rotor."""

    name: Annotated[str, BeforeValidator(Text(200))]
    source: Annotated[str, BeforeValidator(Text(4000, may_be_empty=True))] = ""
    assumed: Annotated[tuple[_Path, ...], BeforeValidator(Entries(0, MAX_ASSUMED, "field paths"))] = ()
    gravity: Annotated[float, BeforeValidator(Quantity(units.ACCELERATION, 1e-6, 1e6))] = 9.81
    rotor: Table
    chambers: Annotated[tuple[ChamberTable, ...], _TABLES] = ()
    speeds: SpeedsTable
    model: ModelTable = ModelTable()
    runup: RunupTable | None = None
    optimise: OptimiseTable | None = None


class JeffcottScene(SceneTable):
    """A file whose rotor is a "jeffcott"."""

    rotor: JeffcottTable
    chambers: Annotated[
        tuple[ChamberTable, ...], BeforeValidator(Entries(1, MAX_CHAMBERS, "tables headed [[chambers]]"))
    ]


class TwoPlaneScene(SceneTable):
    """A file whose rotor is a "two_plane"."""

    rotor: TwoPlaneTable


class TubScene(SceneTable):
    """A file whose rotor is a "tub"."""

    rotor: TubTable


class ExciterScene(SceneTable):
    """A file whose rotor is an "exciter"."""

    rotor: ExciterTable


SCENES: dict[str, type[SceneTable]] = {
    "jeffcott": JeffcottScene,
    "two_plane": TwoPlaneScene,
    "tub": TubScene,
    "exciter": ExciterScene,
}

# Tables that all kinds share, by their place in the file; "*" stands for the number of an entry.
_COMMON: dict[tuple[str, ...], type[Table]] = {
    ("chambers", "*"): ChamberTable,
    ("chambers", "*", "liquid"): LiquidTable,
    ("chambers", "*", "baffles"): BafflesTable,
    ("speeds",): SpeedsTable,
    ("model",): ModelTable,
    ("model", "friction"): FrictionTable,
    ("runup",): RunupTable,
    ("runup", "motor"): MotorTable,
    ("optimise",): OptimiseTable,
    ("optimise", "duty", "*"): DutyTable,
}

# Each table of a scene by the kind of its rotor and its place in the file.
TABLES: dict[str, dict[tuple[str, ...], type[Table]]] = {
    kind: {(): scene} | _COMMON | ROTORS[kind] for kind, scene in SCENES.items()
}
