"""The tables of a scene file: their keys, the rule of each value, and how the values of a table bind."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, ValidationInfo, field_validator

from fluid.liquid import KNOWN_LIQUIDS, Liquid
from meshes.chamber import Chamber
from study import units
from study.optimise_table import DutyTable, OptimiseTable
from study.rotor_table import ROTORS, ExciterTable, JeffcottTable, TubTable, TwoPlaneTable
from study.rules import Entries, OneOf, Quantity, Refused, Text, Whole
from study.runup_table import MotorTable, RunupTable
from study.table import Length, Position, Speed, Table

MAX_CHAMBERS = 1000
MAX_SPEEDS = 100_000
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


class ChamberTable(Table):
    """[[chambers]]."""

    radius: Length
    inner_radius: Annotated[float, BeforeValidator(Quantity(units.LENGTH, 0.0, 1e3))] = 0.0
    height: Length
    plane: Position = 0.0
    liquid: Annotated[Liquid, BeforeValidator(LiquidRule())]
    volume: Annotated[float, BeforeValidator(Quantity(units.VOLUME, 0.0, 1e9))]

    @field_validator("inner_radius")
    @classmethod
    def _inside_the_wall(cls, value: float, info: ValidationInfo) -> float:
        radius = info.data.get("radius")
        if radius is not None and value >= radius:
            raise Refused(f"below the radius of the chamber, {radius:g} m")
        return value

    @field_validator("volume")
    @classmethod
    def _fits_the_chamber(cls, value: float, info: ValidationInfo) -> float:
        sizes = {key: info.data[key] for key in ("radius", "inner_radius", "height") if key in info.data}
        if len(sizes) < 3:
            return value
        capacity = Chamber(**sizes).capacity
        if value > capacity * (1.0 + _ROUNDING):
            raise Refused(f"at most what the chamber holds, {capacity:.6g} m^3 ({capacity * 1e6:.6g} ml)")
        return min(value, capacity)


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
