"""The balls that are best for an objective: how many, how heavy, with what drag, in what race."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field
from typing import Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays
from leblanc.core.netcdf import variable as var
from leblanc.core.notes import Note, texts
from leblanc.results.base import ConstraintValue, number_or_none
from leblanc.studies.balls.answer import BallsAnswer
from meshes.arrays import Array


@dataclass(frozen=True)
class DesignRange:
    """A value that was searched."""

    path: str  #: in the scene
    low: float  #: least and most, SI
    high: float
    unit: str  #: SI


@dataclass(frozen=True)
class DesignedRace:
    """A race with the balls found, or with those of the scene."""

    count: int  #: of the balls
    mass: float  #: of one ball, kg
    diameter: float | None  #: of the balls, m; None where the scene does not say it
    drag: float  #: force on a ball over its speed in the drum, N s/m
    radius: float  #: of the circle of the balls' centres, m
    plane: float  #: along the axis, m
    capacity: float  #: largest unbalance that the balls hold, kg m
    sized_by: str  #: "mass" or "diameter", as a scene gives the size of a ball


@dataclass(frozen=True)
class TriedDesigns:
    """All designs that were judged, m of them with v values each."""

    values: Array  #: in the order of the ranges, SI, shape (m, v)
    count: Array  #: balls in all races together, shape (m,)
    mass: Array  #: of all balls, kg, shape (m,)
    vibration: Array  #: amplitude, m, infinite where no state is stable, shape (m,)
    growth: Array  #: of small motions, 1/s, shape (m,)
    excess: Array  #: by how much a constraint is exceeded, relative, 0 or below if none is, shape (m,)


@dataclass(frozen=True)
class BallDesignResult(Result):
    """The best balls of a scene's races [theory: races, eq. 13-15].

    Examples
    --------
    >>> import leblanc as lb
    >>> scene = lb.example("balls").replace({"optimise": {"objective": "least_mass"}})
    >>> best = lb.optimise(scene)  # doctest: +SKIP
    >>> best.count, best.value  # doctest: +SKIP
    """

    figure: ClassVar[str] = "leblanc.figures.races.design:design_figure"
    summary: ClassVar[str] = "leblanc.text.races.design:facts"

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    objective: str  #: working_speed, peak, mean, least_mass or robust
    meaning: str  #: of the amplitude, in words
    working_speed: float  #: rad/s
    ranges: tuple[DesignRange, ...]  #: what was searched
    races: tuple[DesignedRace, ...]  #: with the best balls, and with those of the scene
    races_before: tuple[DesignedRace, ...]
    value: float  #: of the objective, m, or kg for least_mass
    #: amplitude with the best balls, with the scene's, and without, m; infinite where no state is stable
    vibration: float
    vibration_before: float
    vibration_without: float
    mass_before: float  #: of the scene's balls, kg
    growth: float  #: of small motions at the speeds that are looked at, the largest, 1/s
    growth_before: float
    constraints: dict[str, ConstraintValue]  #: by name
    unbalances: Array  #: conditions of the rotor, size of each unbalance, kg m, shape (n, u)
    evaluations: int  #: designs judged
    tried: TriedDesigns  #: all of them
    volume: Array  #: of liquid in each chamber, which stays, m^3
    response: BallsAnswer  #: what `run` says of the best balls
    interrupted: bool  #: from the keyboard; the best of what was tried until then
    notes: tuple[Note, ...] = field(default_factory=tuple)  #: of the search

    @property
    def unit(self) -> str:
        """Of the value."""
        return "kg" if self.objective == "least_mass" else "m"

    @property
    def baseline(self) -> float:
        """The value without balls: their mass, or the amplitude."""
        return 0.0 if self.objective == "least_mass" else self.vibration_without

    @property
    def feasible(self) -> bool:
        """Every constraint is met, and a stable state was found."""
        kept = all(constraint.satisfied for constraint in self.constraints.values())
        return kept and math.isfinite(self.vibration)

    @property
    def exceeded(self) -> dict[str, ConstraintValue]:
        """Constraints that are not met, by name."""
        return {name: own for name, own in self.constraints.items() if not own.satisfied}

    @property
    def count(self) -> list[int]:
        """Balls of each race."""
        return [race.count for race in self.races]

    @property
    def ball_mass(self) -> list[float]:
        """Mass of one ball of each race, kg."""
        return [race.mass for race in self.races]

    @property
    def diameter(self) -> list[float | None]:
        """Of the balls of each race, m; None where the scene does not say it."""
        return [race.diameter for race in self.races]

    @property
    def drag(self) -> list[float]:
        """Of each race, N s/m."""
        return [race.drag for race in self.races]

    @property
    def radius(self) -> list[float]:
        """Of the circle of the balls' centres of each race, m."""
        return [race.radius for race in self.races]

    @property
    def capacity(self) -> list[float]:
        """Largest unbalance that the balls of each race hold, kg m."""
        return [race.capacity for race in self.races]

    @property
    def mass(self) -> float:
        """Of all balls, kg."""
        return sum(race.count * race.mass for race in self.races)

    @property
    def stability_margin(self) -> float:
        """Decay of the small motions that fade slowest, 1/s."""
        return -self.growth

    def to_json(self) -> dict[str, Any]:
        """What `optimise` prints for scripts, SI; null for what is not there."""
        own = ["name", "objective", "meaning", "unit", "working_speed", "value", "baseline", "feasible"]
        own += ["count", "ball_mass", "diameter", "drag", "radius", "capacity", "mass", "mass_before"]
        own += ["evaluations", "interrupted", "volume", "unbalances", "digest", "assumed"]
        numbers = ["vibration", "vibration_before", "vibration_without", "growth", "stability_margin"]
        return {
            **{name: getattr(self, name) for name in own},
            **{name: number_or_none(getattr(self, name)) for name in numbers},
            "growth_before": number_or_none(self.growth_before),
            "constraints": {name: _constraint_json(each) for name, each in self.constraints.items()},
            "ranges": [asdict(each) for each in self.ranges],
            "balanced_from": number_or_none(self.response.balanced_from),
            "notes": texts(self.notes),
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `race`, `tried`, `varied`, and those of the best balls over `speed`."""
        each, tried = ("race",), ("tried",)
        sizes = [math.nan if size is None else size for size in self.diameter]
        found = {
            "count": var(each, np.array(self.count), "1", "balls"),
            "ball_mass": var(each, np.array(self.ball_mass), "kg", "mass of a ball"),
            "diameter": var(each, np.array(sizes), "m", "diameter of a ball"),
            "drag": var(each, np.array(self.drag), "N s m-1", "drag of a ball"),
            "radius": var(each, np.array(self.radius), "m", "radius of the path"),
            "capacity": var(each, np.array(self.capacity), "kg m", "unbalance that the balls hold"),
            "value": var((), self.value, self.unit, "objective", self.meaning),
            "varied": var(("varied",), np.array([r.path for r in self.ranges], dtype=object), "1", "path"),
            "tried_values": var((*tried, "varied"), self.tried.values, "1", "values tried", "SI units"),
            "tried_mass": var(tried, self.tried.mass, "kg", "mass of all balls"),
            "tried_vibration": var(tried, self.tried.vibration, "m", "amplitude", self.meaning),
            "tried_growth": var(tried, self.tried.growth, "s-1", "growth of small motions"),
            "tried_excess": var(tried, self.tried.excess, "1", "excess over a constraint", "relative"),
        }
        run = self.response
        over = {
            "amplitude": var(("speed",), run.amplitude, "m", "amplitude with the best balls"),
            "amplitude_without": var(("speed",), run.amplitude_without, "m", "amplitude without balls"),
            "growth": var(("speed",), run.growth, "s-1", "growth of small motions"),
        }
        coords = {"speed": var(("speed",), run.speed, "rad s-1", "spin speed")}
        return NamedArrays(found | over, coords, attributes(self, "optimise", {}, self.notes))


def _constraint_json(own: ConstraintValue) -> dict[str, Any]:
    """A constraint with null for a value that was not found."""
    return {**asdict(own), "value": number_or_none(own.value)}
