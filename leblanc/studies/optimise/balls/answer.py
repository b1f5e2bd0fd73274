"""The balls that are best for an objective: how many, how heavy, with what drag, in what race."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from leblanc.core.blocks import Block, Checks, Columns, Headline, Notes, Picture, Section, Table, Words, check
from leblanc.core.netcdf import Variable, variable
from leblanc.core.notes import Note, texts
from leblanc.core.units import LENGTH, MASS, MM, NOT_FOUND, UNBALANCE, in_rpm, number, with_unit
from leblanc.studies.balls.answer import BallsAnswer
from leblanc.studies.optimise.answer import Best
from meshes.arrays import Array
from meshes.quantity import Q

_RACE, _TRIED, _OVER = ("race",), ("tried",), ("speed",)
_MODEL = (
    "Balls that roll or slide in races on a rotor with all its coordinates: states in which they rest in the "
    "drum, and the roots of small motions about each. The state taken is the worst of the stable ones."
)
_SEARCH = (
    "Designs are searched by differential evolution over whole numbers of balls and real sizes, then closer."
)


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

    def words(self) -> str:
        """Number and size of the balls."""
        size = with_unit(self.mass, MASS)
        if self.sized_by == "diameter" and self.diameter is not None:
            size = with_unit(self.diameter, LENGTH)
        return f"{self.count} ball{'' if self.count == 1 else 's'} of {size}"

    def keys(self) -> str:
        """For the scene file."""
        size = f'mass = "{self.mass * 1e3:.6g} g"'
        if self.sized_by == "diameter" and self.diameter is not None:
            size = f'diameter = "{self.diameter * MM:.6g} mm"'
        rest = f'drag = "{self.drag:.6g} N*s/m"; radius = "{self.radius * MM:.6g} mm"'
        return f"count = {self.count}; {size}; {rest}"


@dataclass(frozen=True)
class TriedDesigns:
    """All designs that were evaluated, m of them with v values each."""

    #: in the order of the ranges
    values: Annotated[Array, Q("1", "values tried", "SI units", over=(*_TRIED, "varied"))]
    count: Array  #: balls in all races together, shape (m,)
    mass: Annotated[Array, Q("kg", "mass of all balls", over=_TRIED)]
    vibration: Array  #: amplitude, m, infinite where no state is stable, shape (m,)
    growth: Annotated[Array, Q("s-1", "growth of small motions", over=_TRIED)]
    #: 0 or below if no constraint is exceeded
    excess: Annotated[Array, Q("1", "excess over a constraint", "relative", over=_TRIED)]


@dataclass(frozen=True, kw_only=True)
class BallDesignAnswer(Best):
    """The best balls of a scene's races [theory: races, eq. 13-15].

    Examples
    --------
    >>> import leblanc as lb
    >>> scene = lb.example("balls").replace({"optimise": {"objective": "least_mass"}})
    >>> best = lb.optimise(scene)  # doctest: +SKIP
    >>> best.count, best.value  # doctest: +SKIP
    """

    title = "Best balls"
    data, page = "optimum.nc", "optimise.html"
    figure = "leblanc.studies.optimise.balls.figure:design_figure"

    assumed: Annotated[tuple[str, ...], Q(text="values that no source gives")]
    objective: Annotated[str, Q(text="working_speed, peak, mean, least_mass or robust")]
    meaning: Annotated[str, Q(text="of the amplitude")]
    working_speed: Annotated[float, Q("rad s-1", "working speed", data=False)]
    ranges: Annotated[tuple[DesignRange, ...], Q(text="what was searched")]
    races: tuple[DesignedRace, ...]  #: with the best balls, and with those of the scene
    races_before: tuple[DesignedRace, ...]
    #: infinite where no state is stable
    vibration: Annotated[float, Q("m", "amplitude", "zero to peak, with the best balls", data=False)]
    vibration_before: Annotated[float, Q("m", "amplitude", "with the scene's balls", data=False)]
    vibration_without: Annotated[float, Q("m", "amplitude", "without balls", data=False)]
    mass_before: Annotated[float, Q("kg", "mass of the scene's balls", data=False)]
    growth: Annotated[float, Q("s-1", "growth of small motions, the largest", data=False)]
    growth_before: Annotated[float, Q("s-1", "the same with the scene's balls", data=False)]
    #: conditions of the rotor, shape (n, u)
    unbalances: Annotated[Array, Q("kg m", "size of each unbalance", data=False)]
    tried: Annotated[TriedDesigns, Q(prefix="tried", json=False)]
    volume: Annotated[Array, Q("m3", "liquid in each chamber, which stays", data=False)]
    response: BallsAnswer  #: what `run` says of the best balls
    #: from the keyboard; the best of what was tried until then
    interrupted: Annotated[bool, Q(name="ended before its time")]
    stopped: Annotated[str, Q(name="limit that ended the search", data=False)] = ""  #: likewise
    notes: Annotated[tuple[Note, ...], Q(text="of the search")] = ()

    @property
    def unit(self) -> Annotated[str, Q(text="of the value")]:
        return "kg" if self.objective == "least_mass" else "m"

    @property
    def baseline(self) -> Annotated[float, Q(name="value without balls, SI")]:
        return 0.0 if self.objective == "least_mass" else self.vibration_without

    @property
    def feasible(self) -> bool:
        """Every constraint is met, and a stable state was found."""
        return not self.exceeded and math.isfinite(self.vibration)

    def _each(self, name: str) -> tuple[Any, ...]:
        return tuple(getattr(race, name) for race in self.races)

    @property
    def count(self) -> Annotated[tuple[int, ...], Q("1", "balls", over=_RACE)]:
        return self._each("count")

    @property
    def ball_mass(self) -> Annotated[tuple[float, ...], Q("kg", "mass of a ball", over=_RACE)]:
        return self._each("mass")

    @property
    def diameter(self) -> Annotated[tuple[float | None, ...], Q("m", "diameter of a ball", over=_RACE)]:
        """None where the scene does not say it."""
        return self._each("diameter")

    @property
    def drag(self) -> Annotated[tuple[float, ...], Q("N s m-1", "drag of a ball", over=_RACE)]:
        return self._each("drag")

    @property
    def radius(self) -> Annotated[tuple[float, ...], Q("m", "radius of the path", over=_RACE)]:
        return self._each("radius")

    @property
    def capacity(
        self,
    ) -> Annotated[tuple[float, ...], Q("kg m", "unbalance that the balls hold", over=_RACE)]:
        return self._each("capacity")

    @property
    def mass(self) -> Annotated[float, Q("kg", "mass of all balls", data=False)]:
        return sum(race.count * race.mass for race in self.races)

    @property
    def stability_margin(
        self,
    ) -> Annotated[float, Q("s-1", "decay of the slowest small motions", data=False)]:
        return -self.growth

    @property
    def balanced_from(
        self,
    ) -> Annotated[float, Q("rad s-1", "speed from which the balanced state is stable", data=False)]:
        return self.response.balanced_from

    @property
    def varied(self) -> Annotated[Array, Q("1", "path", over=("varied",), json=False)]:
        return np.array([each.path for each in self.ranges], dtype=object)

    @property
    def objective_value(self) -> Annotated[Variable, Q(text="of it", variable="value", json=False)]:
        return variable((), self.value, self.unit, "objective", self.meaning)

    @property
    def amplitude_tried(
        self,
    ) -> Annotated[
        Variable,
        Q(text="amplitude of every design tried, zero to peak", variable="tried_vibration", json=False),
    ]:
        return variable(_TRIED, self.tried.vibration, "m", "amplitude", self.meaning)

    @property
    def speed(self) -> Annotated[Array, Q("rad s-1", "spin speed", over=_OVER, json=False)]:
        return self.response.speed

    @property
    def amplitude(self) -> Annotated[Array, Q("m", "amplitude with the best balls", over=_OVER, json=False)]:
        return self.response.amplitude

    @property
    def amplitude_without(
        self,
    ) -> Annotated[Array, Q("m", "amplitude without balls", over=_OVER, json=False)]:
        return self.response.amplitude_without

    @property
    def growth_over_speed(
        self,
    ) -> Annotated[Array, Q("s-1", "growth of small motions", over=_OVER, variable="growth", json=False)]:
        return self.response.growth

    @property
    def faults(self) -> tuple[str, ...]:
        return () if self.feasible else (f"no balls meet every constraint: {self._nearest()}",)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.evaluations} designs evaluated"

    def blocks(self) -> tuple[Block, ...]:
        lost = not math.isfinite(self.vibration)
        checks = (
            self.exceeded_check(),
            check("No stable state where it works", "yes" if lost else "no", lost),
            check("Interrupted", "yes" if self.interrupted else "no", self.interrupted),
            *([check("Ended by a limit", self.stopped, True)] if self.stopped else []),
        )
        head = "race", "balls", "mass of each (g)", "diameter (mm)", "drag (N s/m)", "path's radius (mm)"
        paste = [
            Words(race.keys(), name=f"For race {k + 1} of the scene", code=True)
            for k, race in enumerate(self.races)
        ]
        model = Words(_MODEL, name="balls", small=True), Words(_SEARCH, small=True)
        return (
            Headline(self.sentence(), f"Objective {self.objective}: the {self.meaning}.", shown="both"),
            Table(tuple(self._races()), (*head, "holds (g mm)")),
            *paste,
            Section(
                "Designs",
                (
                    Picture("design", "Designs of balls and the best of them", self.figure),
                    Columns((Table(tuple(self._facts())),), (Checks(checks),)),
                    self.constraint_table(),
                ),
                width="120mm",
            ),
            Section("Model", model, shown="page"),
            Notes(texts(self.notes)),
        )

    def sentence(self) -> str:
        """The best balls and what they give."""
        races = " and ".join(race.words() for race in self.races)
        text = f"{races}, {with_unit(self.mass, MASS)} in all, the {self.meaning} is {_size(self.vibration)}"
        if not self.feasible:
            return f"No balls within the ranges meet every constraint. Nearest: with {text}."
        return f"With {text} in place of {_size(self.vibration_without)} without balls."

    def _races(self) -> Iterator[tuple[str, ...]]:
        """A row for each race, with the best balls and with those of the scene."""
        for which, races in (("best", self.races), ("scene", self.races_before)):
            for k, race in enumerate(races):
                yield (
                    f"{k + 1} {which}",
                    f"{race.count}",
                    number(race.mass * 1e3),
                    "" if race.diameter is None else number(race.diameter * MM),
                    number(race.drag),
                    number(race.radius * MM),
                    number(race.capacity * 1e6),
                )

    def _facts(self) -> Iterator[tuple[str, str]]:
        """Main numbers: label and value."""
        decays = [
            f"{number(-growth)} 1/s" if math.isfinite(growth) else NOT_FOUND
            for growth in (self.growth, self.growth_before)
        ]
        masses = with_unit(self.mass, MASS), with_unit(self.mass_before, MASS)
        yield "Objective", f"{self.objective}, the {self.meaning}"
        if len(self.unbalances) > 1:
            sizes = self.unbalances.max(axis=1)
            span = [with_unit(float(size), UNBALANCE) for size in (sizes.min(), sizes.max())]
            yield "Unbalances", f"{span[0]} to {span[1]}, {len(sizes)} conditions"
        yield "Amplitude", _size(self.vibration)
        yield "with the scene's balls", _size(self.vibration_before)
        yield "without balls", _size(self.vibration_without)
        yield "Mass of all balls", ", before ".join(masses)
        yield "Small motions decay with", ", with the scene's balls ".join(decays)
        yield "Balanced state stable from", in_rpm(self.balanced_from)
        yield "Constraints", "every one is met" if self.feasible else f"not met: {self._nearest()}"
        yield "Designs evaluated", f"{self.evaluations}"

    def _nearest(self) -> str:
        """What is exceeded where no balls meet every constraint."""
        parts = [self.exceeded_words()] if self.exceeded else []
        if not math.isfinite(self.vibration):
            parts.append(f"no state of the balls is stable at {in_rpm(self.working_speed)}")
        return "; ".join(parts)


def _size(amplitude: float) -> str:
    """An amplitude, or that there is none that stays."""
    return with_unit(amplitude, LENGTH) if math.isfinite(amplitude) else "not known, no state being stable"
