"""What `map` answers of a rotor with balls: where a state of the balls is stable, over speed and a number."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays
from leblanc.core.netcdf import variable as var
from leblanc.core.notes import Note, texts
from leblanc.core.units import Dimension
from leblanc.results.base import number_or_none
from meshes.arrays import Array, Flags, Indices
from solvers.rotor.balls.charts import NONE


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
class BallChart(Result):
    """Stability of a state of the balls; s speeds, v values of another number of the scene.

    Examples
    --------
    >>> import leblanc as lb
    >>> chart = lb.map_balls(lb.example("balls"), values=3, speeds=5)
    >>> chart.growing.shape, [round(edge) for edge in chart.scene_bands[0]]
    ((3, 5), [117, 314])
    """

    figure: ClassVar[str] = "leblanc.figures.races.chart:chart_figure"
    summary: ClassVar[str] = "leblanc.text.races.chart:facts"

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    axis: str  #: "horizontal" or "vertical"
    state: str  #: of the balls, "balanced", "heavy" or "light": together on that side
    #: of the numbers of the scene that are varied; the first one takes the values, the others go along
    paths: tuple[str, ...]
    dimension: Dimension  #: of these numbers
    log: bool  #: the values are spaced evenly in their logarithm
    speed: Array  #: spin speed, rad/s, shape (s,)
    value: Array  #: of the number, SI, shape (v,)
    growing: Indices  #: roots with a positive real part, -1 where the state does not exist, shape (v, s)
    #: of the small motion that grows most, 1/s, nan where the state does not exist, shape (v, s)
    growth: Array
    edges: tuple[Curve, ...]  #: curves on which the number of growing roots changes
    #: values between which the balanced state begins or ends to exist, SI; empty for another state
    bounds: tuple[float, ...]
    scene_value: float  #: what the scene has there, SI; nan where it says nothing
    scene_growth: Array  #: with the scene as it stands, 1/s, shape (s,)
    #: speeds between which the state is stable then, rad/s; an end that is the first or the last speed is
    #: where the range ends
    scene_bands: tuple[tuple[float, float], ...]
    #: largest unbalance that the balls of each race hold in the scene as it stands, kg m
    capacity: tuple[float, ...]
    notes: tuple[Note, ...]  #: limits of validity and findings

    @property
    def stable(self) -> Flags:
        """The state is there and nothing grows about it, shape (v, s)."""
        return np.asarray(self.growing == 0)

    @property
    def missing(self) -> Flags:
        """There is no such state, shape (v, s)."""
        return np.asarray(self.growing == NONE)

    @property
    def stable_from(self) -> float:
        """Speed from which on, to the last one, the state is stable with the scene as it stands, rad/s."""
        last = self.scene_bands[-1] if self.scene_bands else (np.nan, np.nan)
        return last[0] if last[1] == self.speed[-1] else float("nan")

    def to_json(self) -> dict[str, Any]:
        """What `map` prints for scripts, SI: rows of `growing` and `growth` follow `value`."""
        names = ["speed", "value", "paths", "state", "growing", "growth", "bounds", "scene_growth"]
        names += ["scene_bands", "capacity", "name", "digest", "assumed"]
        return {name: getattr(self, name) for name in names} | {
            "unit": self.dimension.unit,
            "scene_value": number_or_none(self.scene_value),
            "stable_from": number_or_none(self.stable_from),
            "edges": [asdict(edge) for edge in self.edges],
            "notes": texts(self.notes),
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `value` and `speed`; the curves over `point`, one after the other."""
        over, along = ("value", "speed"), ("point",)
        unit = self.dimension.unit or "1"
        number = np.repeat(np.arange(len(self.edges)), [edge.speed.size for edge in self.edges])
        names = [edge.kind for edge in self.edges]
        points = {
            name: np.concatenate([np.zeros(0), *(getattr(edge, name) for edge in self.edges)])
            for name in ("speed", "value", "frequency")
        }
        curve = "of a point on a curve where the number of growing roots changes"
        kinds = ", ".join(f"{k}: {kind}" for k, kind in enumerate(names)) or "none"
        return NamedArrays(
            {
                "growing": var(
                    over, self.growing.astype(np.int32), "1", "growing roots", "-1: no such state"
                ),
                "growth": var(over, self.growth, "s-1", "growth rate", "of the motion that grows most"),
                "scene_growth": var(("speed",), self.scene_growth, "s-1", "growth with the scene's value"),
                "edge": var(along, number.astype(np.int32), "1", "number of the curve", kinds),
                "edge_speed": var(along, points["speed"], "rad s-1", "speed", curve),
                "edge_value": var(along, points["value"], unit, "value", curve),
                "edge_frequency": var(along, points["frequency"], "rad s-1", "frequency in the drum", curve),
            },
            coords={
                "speed": var(("speed",), self.speed, "rad s-1", "spin speed", "of the rotor about its axis"),
                "value": var(("value",), self.value, unit, self.paths[0], "varied"),
            },
            attrs=attributes(self, "map", {"state": self.state, "paths": ", ".join(self.paths)}, self.notes),
        )
