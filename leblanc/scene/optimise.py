"""The table [optimise] of a scene file: what its liquid is chosen for, and within which limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pydantic import BeforeValidator

from leblanc import units
from leblanc.scene.rules import SPEED, Entries, Flag, OneOf, Quantity, Refused, Speed, Table, Whole

OBJECTIVES = ("working_speed", "peak", "mean", "least_mass", "robust")
MAX_DUTY = 1000
MAX_SAMPLES = 100_000

_LENGTH = Quantity(units.LENGTH, 1e-12, 1e3)


@dataclass(frozen=True)
class Span:
    """Two values of one quantity, the lower first."""

    each: Quantity

    @property
    def allowed(self) -> str:
        """The rule in words."""
        return f"a list of two, the second at least the first, each {self.each.allowed}"

    def __call__(self, value: object) -> tuple[float, float]:
        """Both in SI units."""
        if not isinstance(value, list) or len(value) != 2:
            raise Refused(self.allowed)
        low, high = map(self.each, value)
        if high < low:
            raise Refused(self.allowed)
        return low, high


_VOLUMES = Span(Quantity(units.VOLUME, 0.0, 1e9))
_Volumes = Annotated[tuple[float, float], BeforeValidator(_VOLUMES)]


class DutyTable(Table):
    """One of optimise.duty: a speed and its share of the time."""

    speed: Speed
    weight: Annotated[float, BeforeValidator(Quantity(units.NUMBER, 1e-9, 1e9))]


class OptimiseTable(Table):
    """[optimise]."""

    objective: Annotated[str, BeforeValidator(OneOf(OBJECTIVES))] = "working_speed"
    working_speed: Annotated[float | None, SPEED] = None
    steady: Annotated[bool, BeforeValidator(Flag())] = False
    duty: Annotated[
        tuple[DutyTable, ...], BeforeValidator(Entries(1, MAX_DUTY, "tables { speed = ..., weight = ... }"))
    ] = ()
    vibration_limit: Annotated[float | None, BeforeValidator(_LENGTH)] = None
    limit_at: Annotated[str, BeforeValidator(OneOf(("working_speed", "operating")))] = "working_speed"
    deflection: Annotated[float | None, BeforeValidator(_LENGTH)] = None
    unbalance: Annotated[
        tuple[float, float] | None, BeforeValidator(Span(Quantity(units.UNBALANCE, 0.0, 1e9)))
    ] = None
    temperature: Annotated[
        tuple[float, float] | None, BeforeValidator(Span(Quantity(units.TEMPERATURE, 150.0, 1000.0)))
    ] = None
    quantile: Annotated[float, BeforeValidator(Quantity(units.NUMBER, 0.0, 1.0))] = 1.0
    samples: Annotated[int, BeforeValidator(Whole(0, MAX_SAMPLES))] = 0
    seed: Annotated[int, BeforeValidator(Whole(0, 2**63))] = 0
    dry_patch: Annotated[bool, BeforeValidator(Flag())] = True
    stability_margin: Annotated[float | None, BeforeValidator(Quantity(units.RATE, 0.0, 1e6))] = None
    operating: Annotated[
        tuple[float, float] | None, BeforeValidator(Span(Quantity(units.ANGULAR_SPEED, 1e-6, 1e6)))
    ] = None
    clearance: Annotated[float | None, BeforeValidator(_LENGTH)] = None
    volumes: Annotated[
        tuple[_Volumes, ...], BeforeValidator(Entries(1, 1000, "pairs of volumes, one for each chamber"))
    ] = ()


@dataclass(frozen=True)
class Aim:
    """What the liquid of a scene is chosen for, in SI units.

    Parameters
    ----------
    objective : one of `OBJECTIVES`
    working_speed : rad/s; the last of the scene's speeds if None
    steady : the peak is that of the steady response even where the scene has a run-up
    duty : pairs of speed, rad/s, and weight; all speeds of the scene alike if empty
    vibration_limit : of the objective least_mass, m; one per cent above the least that is possible if None
    limit_at : whether that holds at the working speed or at all operating speeds
    deflection : given deflection at the working speed, m; the rotor's own if None
    unbalance : range of unbalances for the objective robust, kg m
    temperature : range of temperatures for it, K
    quantile : of the amplitudes over those ranges; 1 is the worst case
    samples, seed : of a random sample of both ranges; a grid if there are 0 samples
    dry_patch : the wall may be dry somewhere at the working speed
    stability_margin : least decay of every small whirl at the operating speeds, 1/s; no limit if None
    operating : range of operating speeds, rad/s; the scene's if None
    clearance : largest amplitude allowed at the operating speeds, m; no limit if None
    volumes : least and most of each chamber, m^3; from nothing to what it holds if empty
    """

    objective: str = "working_speed"
    working_speed: float | None = None
    steady: bool = False
    duty: tuple[tuple[float, float], ...] = ()
    vibration_limit: float | None = None
    limit_at: str = "working_speed"
    deflection: float | None = None
    unbalance: tuple[float, float] | None = None
    temperature: tuple[float, float] | None = None
    quantile: float = 1.0
    samples: int = 0
    seed: int = 0
    dry_patch: bool = True
    stability_margin: float | None = None
    operating: tuple[float, float] | None = None
    clearance: float | None = None
    volumes: tuple[tuple[float, float], ...] = ()


def aim_of(table: OptimiseTable) -> Aim:
    """Aim from the checked values of its table."""
    values = table.model_dump(exclude={"duty"})
    return Aim(**values, duty=tuple((one.speed, one.weight) for one in table.duty))
