"""What is searched of the balls of a scene, and the scene with other balls."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from leblanc.results.races.design import DesignRange
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import MAX_BALLS, BallRanges, Optimisation
from meshes.arrays import Array, Flags
from meshes.errors import InputError

_FEW, _MANY = 2, 8  # balls of a race where the scene gives no ranges
_USUAL = {"mass": (0.25, 4.0), "diameter": (0.5, 2.0), "drag": (0.01, 100.0)}  # times the scene's
_UNITS = {"count": "1", "mass": "kg", "diameter": "m", "drag": "N s/m", "radius": "m"}
_LOGARITHMIC = ("mass", "diameter", "drag")


class Variable(NamedTuple):
    """One number of a race that is searched."""

    race: int
    name: str
    low: float
    high: float

    @property
    def logarithmic(self) -> bool:
        """Its logarithm is searched."""
        return self.name in _LOGARITHMIC and self.low > 0.0

    @property
    def bounds(self) -> tuple[float, float]:
        """Of what is searched."""
        return (math.log(self.low), math.log(self.high)) if self.logarithmic else (self.low, self.high)

    def value(self, searched: float) -> float:
        """The number itself, SI."""
        found = math.exp(searched) if self.logarithmic else searched
        return float(min(max(found, self.low), self.high))

    def searched(self, value: float) -> float:
        """What is searched at a value, within the bounds."""
        held = min(max(value, self.low), self.high)
        return math.log(held) if self.logarithmic else held


def size_of(race: BallRace) -> str:
    """The size of a ball that a scene gives: its mass, or the diameter beside a density."""
    return "mass" if race.mass is not None else "diameter"


def variables_of(scene: Scene, task: Optimisation) -> tuple[Variable, ...]:
    """What is searched of the balls of every race."""
    found: list[Variable] = []
    for k, race in enumerate(scene.balls):
        at = f"chambers.{len(scene.liquids) + k}"
        if task.balls is None:
            found += _usual(k, race)
        else:
            found += _given(k, race, task.balls, at)
    return tuple(found)


def _usual(k: int, race: BallRace) -> Iterator[Variable]:
    """Around what the scene has."""
    yield Variable(k, "count", min(_FEW, race.count), min(max(_MANY, race.count), MAX_BALLS))
    for name in (size_of(race), "drag"):
        value, (low, high) = getattr(race, name), _USUAL[name]
        if value > 0.0:
            yield Variable(k, name, low * value, high * value)


def _given(k: int, race: BallRace, ranges: BallRanges, at: str) -> Iterator[Variable]:
    """What the task gives."""
    own = size_of(race)
    other, keeps = ("diameter", "mass") if own == "mass" else ("mass", "density")
    if getattr(ranges, other) is not None:
        text = f"left out where {at}.{keeps} is given; {own} in its place"
        raise InputError(f"optimise.balls.{other}", list(getattr(ranges, other)), text)
    for name in ("count", own, "drag", "radius"):
        if (span := getattr(ranges, name)) is not None:
            yield Variable(k, name, *span)


def named_ranges(scene: Scene, variables: Sequence[Variable]) -> tuple[DesignRange, ...]:
    """The variables as results keep them."""
    first = len(scene.liquids)
    return tuple(
        DesignRange(f"chambers.{first + v.race}.{v.name}", v.low, v.high, _UNITS[v.name]) for v in variables
    )


def start_of(scene: Scene, variables: Sequence[Variable]) -> Array:
    """The scene's own balls as a point of the search, moved into the ranges, shape (v,)."""
    return np.array([v.searched(float(getattr(scene.balls[v.race], v.name))) for v in variables])


def values_of(variables: Sequence[Variable], point: Array) -> Array:
    """The numbers at a point of the search, SI, shape (v,)."""
    pairs = zip(variables, point.tolist(), strict=True)
    return np.array([round(v.value(x)) if v.name == "count" else v.value(x) for v, x in pairs])


def with_balls(scene: Scene, variables: Sequence[Variable], point: Array) -> Scene:
    """The scene with other balls, which are not checked: they may not fit."""
    changes: list[dict[str, float | int]] = [{} for _ in scene.balls]
    for variable, value in zip(variables, values_of(variables, point).tolist(), strict=True):
        changes[variable.race][variable.name] = round(value) if variable.name == "count" else value
    races = [race.altered(**own) for race, own in zip(scene.balls, changes, strict=True)]
    return scene.altered(chambers=(*scene.liquids, *races))


def crowding(race: BallRace) -> float:
    """Share of the way round a race that its balls take side by side; 0 where their diameter is not known."""
    if race.diameter is None:
        return 0.0
    share = race.diameter / (2.0 * race.radius)
    return race.count * math.asin(share) / math.pi if share < 1.0 else math.inf


def floats(race: BallRace) -> bool:
    """The balls are not heavier than the liquid that they displace."""
    return race.displaced >= race.each


def total_mass(scene: Scene) -> float:
    """Of all balls, kg."""
    return float(sum(race.count * race.each for race in scene.balls))


def whole_numbers(variables: Sequence[Variable]) -> Flags:
    """Which of the variables are whole numbers, shape (v,)."""
    return np.array([v.name == "count" for v in variables])
