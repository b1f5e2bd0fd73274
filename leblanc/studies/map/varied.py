"""Numbers of a scene along an axis of a chart: their paths, their values, and the scene at each of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.friction.laws import Friction
from leblanc.core.units import parse_option
from leblanc.scene.scene import Scene
from leblanc.scene.schema.load import SceneError
from leblanc.scene.schema.paths import keys_of, rule_at
from leblanc.scene.schema.rules import Quantity, Refused, Several
from leblanc.studies.map.axes import few_points
from meshes.arrays import Array
from meshes.errors import InputError

USUAL = 10.0  # factor on both sides of what the scene has
_DECADE = 10.0  # a range as wide as this is spaced by logarithms
_ROOTS = ("rotor", "chambers", "gravity", "model")


@dataclass(frozen=True)
class Varied:
    """Numbers of a scene that vary together."""

    paths: tuple[str, ...]  #: of them, the first one leads
    rule: Quantity  #: of the first
    own: float  #: what the scene has there, SI, nan where it says nothing
    shares: tuple[float, ...]  #: of each over the first

    def at(self, scene: Scene, value: float) -> Scene:
        """The scene with a value of the first, SI, and the others in their ratio to it."""
        try:
            return scene.replace(
                {path: value * share for path, share in zip(self.paths, self.shares, strict=True)}
            )
        except SceneError as error:
            fault = error.faults[0]
            where, allowed = f"{self.paths[0]} at {value:g}", f"such that {fault.field} is {fault.allowed}"
            raise InputError("over", where, allowed) from None


@dataclass(frozen=True)
class Axis:
    """Values along an axis."""

    value: Array  #: SI, rising
    even: Array  #: these, or their logarithms where `log` says so
    log: bool


def varied_of(scene: Scene, over: str | Sequence[str]) -> Varied:
    """What varies, by its paths."""
    paths = (over,) if isinstance(over, str) else tuple(over)
    if len(set(paths)) < len(paths):
        raise InputError("over", ", ".join(paths), "paths that differ")
    rules = [_rule(scene, path) for path in paths]
    if len({rule.dimension for rule in rules}) > 1:
        raise InputError("over", ", ".join(paths), "paths of quantities of one kind")
    own = [_own(scene, path) for path in paths]
    together = all(math.isfinite(value) for value in own) and own[0] != 0.0
    # Numbers that have no ratio take the same value.
    shares = tuple(value / own[0] for value in own) if together else (1.0,) * len(own)
    return Varied(paths, rules[0], own[0], shares)


def axis_of(
    varied: Varied,
    values: int | Sequence[str | float],
    start: str | float | None,
    stop: str | float | None,
    log: bool | None,
    most: int,
    factor: float = USUAL,
) -> Axis:
    """Values one by one, or so many from first to last, by their logarithm where they span a decade."""
    points = values if isinstance(values, int) else _given(varied, values, start, stop)
    few_points("values", points, most)
    low, high = _ends(varied, start, stop, factor) if isinstance(points, int) else (points[0], points[-1])
    log = low > 0.0 and high >= _DECADE * low if log is None else log
    if log and low <= 0.0:
        raise InputError("start", low, "above 0 for values spaced by their logarithm")
    if not isinstance(points, int):
        value = np.array(points, dtype=float)
        return Axis(value, np.log(value) if log else value, log)
    first, last = (math.log(low), math.log(high)) if log else (low, high)
    even = np.linspace(first, last, points)
    value = np.exp(even) if log else even.copy()
    # Ends as they were asked for, without the rounding of a logarithm.
    value[0], value[-1] = low, high
    return Axis(value, even, log)


def _given(
    varied: Varied, values: Sequence[str | float], start: str | float | None, stop: str | float | None
) -> list[float]:
    """Values one by one, SI, each as the scene allows it."""
    for field, end in (("start", start), ("stop", stop)):
        if end is not None:
            raise InputError(field, end, "left out where each of the values is given")
    found = []
    for k, one in enumerate(np.asarray(values).tolist()):
        value = parse_option(one, varied.rule.dimension, f"values.{k}")
        try:
            found.append(varied.rule(value))
        except Refused as refused:
            raise InputError(f"values.{k}", one, refused.allowed) from None
    return found


def _rule(scene: Scene, path: str) -> Quantity:
    """Rule of a number that may take any value in between."""
    if keys_of(path)[0] not in _ROOTS:
        raise InputError("over", path, f"the path of a number under {', '.join(_ROOTS)}")
    try:
        rule = rule_at(Scene, scene.table(), path)
    except Refused as refused:
        raise InputError("over", path, refused.allowed) from None
    rule = rule.each if isinstance(rule, Several) else rule
    if not isinstance(rule, Quantity):
        raise InputError("over", path, "the path of a number that may take any value in between")
    return rule


def _own(scene: Scene, path: str) -> float:
    """What the scene has at a path, SI; nan where that is nothing."""
    found: object = scene
    for key in keys_of(path):
        if isinstance(found, Friction):
            # As typed: a table of its law.
            found = {found.law.value: found.coefficient}.get(str(key))
        elif isinstance(key, int) and isinstance(found, tuple):
            found = found[key]
        else:
            found = getattr(found, str(key), None)
    return float(found) if isinstance(found, float | int) else math.nan


def _ends(
    varied: Varied, start: str | float | None, stop: str | float | None, factor: float
) -> tuple[float, float]:
    """First and last value, SI."""
    own, ends = varied.own, []
    for option, given, chosen in (("start", start, own / factor), ("stop", stop, own * factor)):
        if given is None and not own > 0.0:
            raise InputError(option, given, f"given where the scene has no {varied.paths[0]} above 0")
        value = chosen if given is None else parse_option(given, varied.rule.dimension, option)
        try:
            ends.append(varied.rule(value))
        except Refused as refused:
            raise InputError(option, value, refused.allowed) from None
    if not ends[0] < ends[1]:
        raise InputError("stop", ends[1], f"above the first value, {ends[0]:g}")
    return ends[0], ends[1]
