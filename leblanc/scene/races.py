"""A race of a scene with balls in it; `race()` is what the solvers take."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, PlainValidator

from fluid.liquid import Liquid
from leblanc.core import units
from leblanc.scene.chambers import LiquidRule
from leblanc.scene.schema.part import Conflict, Part, allowed_at
from leblanc.scene.schema.rules import (
    LENGTH,
    Damping,
    Length,
    Position,
    one_of,
    quantity,
    whole,
)
from leblanc.scene.tasks import MAX_BALLS

if TYPE_CHECKING:
    from solvers.rotor.balls.balancers import BallRace as Race

_SOLID = 0.4  # inertia of a ball about its own centre over m r^2
_ADDED = 0.5  # mass of liquid that a ball takes along over what it displaces


class BallRace(Part):
    """A race about the rotor's axis and the balls that run in it.

    Examples
    --------
    >>> ring = BallRace(kind="balls", radius="90 mm", count=2, mass="20 g", drag="0.5 N*s/m")
    >>> ring.race().masses, ring.race().rolling
    ((0.02, 0.02), 1.4)
    """

    ALTERNATIVES: ClassVar = (("mass", "density"),)

    kind: Literal["balls"] = Field("balls", description="the kind of chamber")
    radius: Length = Field(description="of the circle of the balls' centres")
    count: Annotated[int, whole(1, MAX_BALLS)] = Field(description="how many balls, all alike")
    mass: Annotated[float | None, quantity(units.MASS, 1e-9, 1e9)] = Field(
        None, description="of each ball; or density"
    )
    density: Annotated[float | None, quantity(units.DENSITY, 1.0, 1e5)] = Field(
        None, description="of the balls, with their diameter; or mass"
    )
    diameter: Annotated[float | None, LENGTH] = Field(
        None, description="of the balls; needed with density and with liquid"
    )
    drag: Damping = Field(description="force on a ball over its speed in the drum")
    motion: Annotated[Literal["rolling", "sliding"], one_of("rolling", "sliding")] = Field(
        "rolling", description="rolling balls are slower to move along the race, by 7/5"
    )
    rolling_resistance: Annotated[float, quantity(units.NUMBER, 0.0, 0.5)] = Field(
        0.0, description="force that a ball resists to rolling over its pressure on the race"
    )
    liquid: Annotated[Liquid | None, PlainValidator(LiquidRule())] = Field(
        None, description="that covers the balls and turns with the drum"
    )
    plane: Position = Field(0.0, description="axial position on the rotor; used by two_plane and tub")
    start: Annotated[Literal["spread", "bottom"], one_of("spread", "bottom")] = Field(
        "spread",
        description="where a run-up begins: evenly round the race at rest in the drum, or side by side at "
        "rest at the bottom",
    )
    start_angle: Annotated[float, quantity(units.ANGLE, -1e3, 1e3)] = Field(
        0.0, description="of the first ball that begins evenly round the race, from the drum's zero mark"
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A mass or what it follows from; balls that fit in their race, and sink in their liquid."""
        yield from super().conflicts(values, given)
        if values.get("start") == "bottom" and values.get("start_angle"):
            yield Conflict(("start_angle",), "left out where the balls start at the bottom")
        for key in ("density", "liquid"):
            if key in given and "diameter" not in given:
                text = f"given with {key}: {allowed_at(cls.model_fields['diameter'])}"
                yield Conflict(("diameter",), text)
        radius, size, count = (values.get(key) for key in ("radius", "diameter", "count"))
        if radius is None or size is None or count is None:
            return
        if size >= 2.0 * radius or 2.0 * count * math.asin(size / (2.0 * radius)) > 2.0 * math.pi:
            most = 2.0 * radius * math.sin(math.pi / count) if count > 1 else 2.0 * radius
            yield Conflict(("diameter",), f"at most {most:.6g} m, that {count} balls fit in the race")
        elif values.get("liquid") is not None and {"mass", "density"} <= values.keys():
            yield from _sinks(values, size)

    @property
    def each(self) -> float:
        """Mass of one ball, kg."""
        if self.mass is not None:
            return self.mass
        assert self.density is not None and self.diameter is not None
        return self.density * _volume(self.diameter)

    @property
    def displaced(self) -> float:
        """Mass of the liquid that one ball displaces, kg."""
        if self.liquid is None or self.diameter is None:
            return 0.0
        return self.liquid.density * _volume(self.diameter)

    @property
    def capacity(self) -> float:
        """Largest unbalance that the balls can balance in their plane, kg m."""
        return self.count * (self.each - self.displaced) * self.radius

    @cached_property
    def _race(self) -> Race:
        from solvers.rotor.balls.balancers import BallRace as Race

        mass, displaced = self.each, self.displaced
        left, own = mass - displaced, _SOLID * mass * (self.motion == "rolling")
        wider = 1.0 if self.diameter is None else 1.0 + 0.5 * self.diameter / self.radius
        around = (1.0 + _ADDED) * displaced
        return Race(
            position=self.plane,
            radius=self.radius,
            masses=(left,) * self.count,
            drag=self.drag,
            rolling=(mass + own + _ADDED * displaced) / left,
            resistance=self.rolling_resistance,
            carried=(own * wider + around) / left,
            driven=(own * wider**2 + around) / left,
        )

    def race(self) -> Race:
        """The race with its balls, as the solvers take it [theory: races, eq. 1 and 4]."""
        return self._race


def _volume(diameter: float) -> float:
    return math.pi / 6.0 * diameter**3


def _sinks(values: Mapping[str, Any], size: float) -> Iterator[Conflict]:
    """Balls that are pressed to the race: heavier than the liquid they displace."""
    volume, liquid = _volume(size), values["liquid"].density
    density = values["density"] if values["mass"] is None else values["mass"] / volume
    if density is None or density > liquid:
        return
    if values["mass"] is None:
        yield Conflict(("density",), f"above that of the liquid, {liquid:.6g} kg/m^3, or the balls float")
    else:
        text = f"above {liquid * volume:.6g} kg, the liquid that it displaces, or the balls float"
        yield Conflict(("mass",), text)
