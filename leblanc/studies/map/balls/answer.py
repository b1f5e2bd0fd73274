"""Where a state of the balls is stable, over speed and a number of the scene."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer
from leblanc.core.blocks import (
    Block,
    Check,
    Checks,
    Columns,
    Headline,
    Notes,
    Picture,
    Section,
    Table,
    Words,
    check,
)
from leblanc.core.notes import Note, texts
from leblanc.core.units import (
    RPM,
    UNBALANCE,
    Dimension,
    Unit,
    in_rpm,
    number,
    rpm_bands,
    unit_for,
    with_unit,
)
from meshes.arrays import Array, Flags
from meshes.quantity import Q
from solvers.rotor.balls.charts import NONE

STATES = {
    "balanced": "the balanced state",
    "heavy": "the state with all balls on the heavy side",
    "light": "the state with all balls opposite to the unbalance",
}
CURVES = {
    "hopf": "a pair of roots crosses (Hopf)",
    "zero": "one root passes 0 (fold, branching)",
}
_ENDS = {
    "left": "leaves the chart",
    "closed": "closes",
    "nowhere": "comes to where the state ends",
    "lost": "is lost, as no further point is found",
    "long": "is cut, as it has too many points",
}
HEAD = ("Curve", "speed (rpm)", "value", "frequency in the drum (rpm)", "it ends where it")
MODEL = (
    "Small motions of the rotor with all its coordinates and of the balls in their races about the state, in "
    "the frame that turns with the drum: roots at every point of a grid, and the curves on which a root "
    "stands on the imaginary axis, followed by their arc length."
)
_OVER, _POINT, _RATE = ("value", "speed"), ("point",), "rad s-1"
_CURVE = "of a point on a curve where the number of growing roots changes"


@dataclass(frozen=True)
class Curve:
    """A curve on which roots stand on the imaginary axis; k points."""

    kind: str  #: "hopf", a pair of roots, or "zero", one root at 0
    speed: Array  #: of its points, rad/s and SI, shape (k,); the last one of a curve that leaves lies outside
    value: Array
    frequency: Array  #: of the pair as seen from the rotor, rad/s, shape (k,)
    #: of its first and its last point: "left" the chart, "closed", "nowhere", as the state ends there,
    #: "lost", as no further point is found, or "long", with too many points
    ends: tuple[str, str]


@dataclass(frozen=True)
class BallChart(Answer):
    """Stability of a state of the balls; s speeds, v values of another number of the scene.

    Examples
    --------
    >>> import leblanc as lb
    >>> chart = lb.map_balls(lb.example("balls"), values=3, speeds=5)
    >>> chart.growing.shape, [round(edge) for edge in chart.scene_bands[0]]
    ((3, 5), [117, 314])
    """

    command = "map"
    title = "Stability of balls in their races"
    data = "map.nc"
    page = "map.html"
    unused = ("runup", "optimise")
    figure = "leblanc.studies.map.balls.figure:chart_figure"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: Annotated[tuple[str, ...], Q(text="values that no source gives")]
    digest: Annotated[str, Q(text="of the scene")]
    axis: str  #: "horizontal" or "vertical"
    #: "balanced", "heavy" or "light"
    state: Annotated[str, Q(text="of the balls; heavy or light: together on that side")]
    paths: Annotated[
        tuple[str, ...], Q(text="numbers of the scene that are varied; others go along with the first")
    ]
    dimension: Dimension  #: of these numbers
    log: bool  #: the values are spaced evenly in their logarithm
    speed: Annotated[Array, Q(_RATE, "spin speed", "of the rotor about its axis", over=("speed",))]
    value: Annotated[Array, Q("{0.si}", "{0.paths[0]}", "varied", over=("value",))]
    growing: Annotated[NDArray[np.int32], Q("1", "growing roots", "-1: no such state", over=_OVER)]
    #: nan where the state does not exist, shape (v, s)
    growth: Annotated[Array, Q("s-1", "growth rate", "of the motion that grows most", over=_OVER)]
    edges: Annotated[
        tuple[Curve, ...], Q(text="curves on which the number of growing roots changes", data=False)
    ]
    #: empty for another state than the balanced one
    bounds: Annotated[tuple[float, ...], Q(text="values at which the state begins or ends to exist, SI")]
    #: nan where it says nothing
    scene_value: Annotated[float, Q(text="what the scene has there, SI")]
    scene_growth: Annotated[Array, Q("s-1", "growth with the scene's value", over=("speed",))]
    #: an end that is the first or the last speed is where the range ends
    scene_bands: Annotated[
        tuple[tuple[float, float], ...],
        Q("rad s-1", text="speeds between which the state is stable then", data=False),
    ]
    capacity: Annotated[
        tuple[float, ...],
        Q("kg m", text="largest unbalance that the balls of each race hold in the scene", data=False),
    ]
    notes: Annotated[tuple[Note, ...], Q(text="limits of validity and findings")]

    @property
    def unit(self) -> Annotated[str, Q(text="SI unit of the values")]:
        return self.dimension.unit

    @property
    def stable_from(
        self,
    ) -> Annotated[
        float,
        Q("rad s-1", text="speed from which on the scene's state is stable to the last one", data=False),
    ]:
        last = self.scene_bands[-1] if self.scene_bands else (np.nan, np.nan)
        return last[0] if last[1] == self.speed[-1] else math.nan

    @property
    def stable(self) -> Flags:
        """The state is there and nothing grows about it, shape (v, s)."""
        return np.asarray(self.growing == 0)

    @property
    def missing(self) -> Flags:
        """There is no such state, shape (v, s)."""
        return np.asarray(self.growing == NONE)

    @property
    def si(self) -> str:
        """Unit of the values in the data file."""
        return self.unit or "1"

    @property
    def kinds(self) -> str:
        """Kind of each curve by its number."""
        return ", ".join(f"{k}: {edge.kind}" for k, edge in enumerate(self.edges)) or "none"

    @property
    def edge(
        self,
    ) -> Annotated[NDArray[np.int32], Q("1", "number of the curve", "{0.kinds}", over=_POINT, json=False)]:
        sizes = [edge.speed.size for edge in self.edges]
        return np.repeat(np.arange(len(sizes), dtype=np.int32), sizes)

    @property
    def edge_speed(self) -> Annotated[Array, Q(_RATE, "speed", _CURVE, over=_POINT, json=False)]:
        return np.concatenate([np.zeros(0), *(edge.speed for edge in self.edges)])

    @property
    def edge_value(self) -> Annotated[Array, Q("{0.si}", "value", _CURVE, over=_POINT, json=False)]:
        return np.concatenate([np.zeros(0), *(edge.value for edge in self.edges)])

    @property
    def edge_frequency(
        self,
    ) -> Annotated[Array, Q(_RATE, "frequency in the drum", _CURVE, over=_POINT, json=False)]:
        return np.concatenate([np.zeros(0), *(edge.frequency for edge in self.edges)])

    @property
    def own(self) -> Mapping[str, Any]:
        return {"state": self.state, "paths": ", ".join(self.paths)}

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.value.size} values by {self.speed.size} speeds done"

    @property
    def varied(self) -> str:
        """The number that is varied, as its path; of several the first."""
        more = len(self.paths) - 1
        return self.paths[0] + (f" and {more} more" if more else "")

    @property
    def shown_unit(self) -> Unit:
        """In which values are shown."""
        return unit_for(self.dimension, *self.value[[0, -1]].tolist())

    def blocks(self) -> tuple[Block, ...]:
        low, high = (number(float(self.speed[k]) * RPM) for k in (0, -1))
        about = f"Stability of {STATES[self.state]} from {low} to {high} rpm over {self.varied}."
        picture = Picture("map", "Where the balls are stable", self.figure)
        tables = Columns((Table(facts(self), indent=2),), (Checks(checks(self), shown="page"),))
        return (
            Headline(sentence(self), about, shown="both"),
            Section("Results", (picture, tables, Words("", shown="text"), curves(self)), width="120mm"),
            Section("Model", (Words(MODEL, "balls", small=True),), shown="page"),
            Notes(texts(self.notes)),
        )


def sentence(found: BallChart) -> str:
    """From which speed on the scene's own value gives a stable state, and what the chart adds."""
    own = ""
    if math.isfinite(found.scene_value):
        own = f", {found.varied} being {with_unit(found.scene_value, found.dimension)}"
    if math.isfinite(found.stable_from):
        where = f"stable from {in_rpm(found.stable_from)} to {in_rpm(float(found.speed[-1]))}"
    elif found.scene_bands:
        where = f"stable at {rpm_bands(found.scene_bands)}"
    else:
        where = "stable at none of these speeds" if np.isfinite(found.scene_growth).any() else "not possible"
    return (
        f"In the scene as it stands {STATES[found.state]} is {where}{own}; over the whole chart it is at "
        f"{_share(found.stable)} of the points."
    )


def facts(found: BallChart) -> list[tuple[str, str]]:
    """What the chart says in numbers: label and value."""
    unit = found.shown_unit
    span = f"{unit.number(float(found.value[0]))} to {unit.text(float(found.value[-1]))}"
    last, growth = in_rpm(float(found.speed[-1])), float(found.scene_growth[-1])
    rows = [
        ("Values by speeds", f"{found.value.size} by {found.speed.size}"),
        ("Over", f"{', '.join(found.paths)}: {span}"),
        ("Stability of", STATES[found.state]),
        ("Stable at", f"{_share(found.stable)} of the points"),
        ("Unstable at", f"{_share(found.growing > 0)} of the points"),
    ]
    if found.missing.any():
        rows.append(("No such state at", f"{_share(found.missing)} of the points"))
    if found.bounds:
        ends = ", ".join(with_unit(x, found.dimension) for x in found.bounds)
        rows.append(("It begins or ends at", ends))
    held = ", ".join(with_unit(size, UNBALANCE) for size in found.capacity)
    return [
        *rows,
        ("Unbalance that the balls of each race hold", held),
        ("Stable in the scene as it stands", rpm_bands(found.scene_bands) or "at none of these speeds"),
        (
            f"Growth of small motions there at {last}",
            f"{number(growth)} 1/s" if math.isfinite(growth) else "no such state",
        ),
        ("Curves on which the number of growing roots changes", str(len(found.edges)) or "none"),
    ]


def curves(found: BallChart) -> Table:
    """Each curve: what crosses, over which speeds and values, how fast it swings, where it ends."""
    unit, rows = found.shown_unit, []
    for edge in found.edges:
        low, high = _within(edge.value, found.value)
        slow, fast = _within(edge.speed * RPM, found.speed * RPM)
        swing = [number(float(end(edge.frequency)) * RPM) for end in (np.min, np.max)]
        rows.append(
            (
                CURVES[edge.kind],
                f"{number(slow)} to {number(fast)}",
                f"{unit.number(low)} to {unit.text(high)}",
                "none" if edge.kind == "zero" else " to ".join(dict.fromkeys(swing)),
                " and ".join(dict.fromkeys(_ENDS[end] for end in edge.ends)),
            )
        )
    return Table(rows, HEAD)


def checks(found: BallChart) -> list[Check]:
    """Where the chart is not what it seems: each check with what fails it."""
    cut = sum("long" in edge.ends for edge in found.edges)
    stands, lost = math.isfinite(found.stable_from), bool(found.missing.any())
    return [
        check("No such state", f"{_share(found.missing)} of the points" if lost else "none", lost),
        check("Curves not followed to their end", str(cut) if cut else "none", cut > 0),
        check("Unstable at the last speed in the scene as it stands", "no" if stands else "yes", not stands),
    ]


def _share(mask: Flags) -> str:
    return f"{number(100.0 * float(np.mean(mask)))} %"


def _within(values: Array, grid: Array) -> tuple[float, float]:
    """Least and largest in the chart; the last point of a curve that leaves it lies beyond."""
    return max(float(values.min()), float(grid[0])), min(float(values.max()), float(grid[-1]))
