"""Charts of the balls of a scene: where a state is stable, over its speeds and any other number of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from leblanc.core.notes import Note
from leblanc.core.progress import update
from leblanc.core.units import parse_option
from leblanc.liquid.validity import doubts
from leblanc.scene.scene import Scene, dry_rotor
from leblanc.scene.schema.load import SceneError
from leblanc.scene.schema.paths import keys_of, rule_at
from leblanc.scene.schema.rules import Quantity, Refused, Several
from leblanc.studies.balls import notes
from leblanc.studies.balls.states import Parts, liquid_beside, own_family, parts_of
from leblanc.studies.map.axes import few_points, speeds_of
from leblanc.studies.map.balls.answer import STATES, BallChart, Curve
from meshes.errors import InputError
from solvers.rotor.balls.charts import (
    Edge,
    Family,
    Machine,
    State,
    existence_bounds,
    gathered,
    stability_chart,
    stable_bands,
)
from solvers.rotor.balls.states import turning

MOST = 1000  # values or speeds of a chart
_WIDE, _USUAL = 100.0, 10.0  # factors on both sides of the scene's drag, of any other number
_DECADE = 10.0  # a range as wide as this is spaced by logarithms
_ROOTS = ("rotor", "chambers", "gravity")
_KEPT = 4096  # machines


@dataclass(frozen=True)
class _Varied:
    """Numbers of a scene that vary together."""

    paths: tuple[str, ...]  #: of them, the first one leads
    rule: Quantity  #: of the first
    own: float  #: what the scene has there, SI, nan where it says nothing
    shares: tuple[float, ...]  #: of each over the first


def chart_scene(
    scene: Scene,
    over: str | Sequence[str],
    start: str | float | None,
    stop: str | float | None,
    values: int | Sequence[str | float],
    speeds: int | Sequence[float],
    log: bool | None,
    state: str,
) -> BallChart:
    """Stability of a state of the balls over speed and another number of the scene, or the drag.

    Paths in `over` keep their ratios; values go from a tenth to ten times what the scene has (of the drag a
    hundredth to a hundred times) unless given, by their logarithm where they span a decade. State heavy or
    light: the balls of each race together on that side of its plane.
    """
    _check(scene, state)
    scene, speed = speeds_of(scene, speeds, MOST)
    liquid_beside(scene)
    varied = _varied(scene, (over,) if isinstance(over, str) else tuple(over))
    points = values if isinstance(values, int) else _given(varied, values, start, stop)
    few_points("values", points, MOST)
    low, high = _ends(varied, start, stop, not over) if isinstance(points, int) else (points[0], points[-1])
    log = low > 0.0 and high >= _DECADE * low if log is None else log
    if log and low <= 0.0:
        raise InputError("start", low, "above 0 for values spaced by their logarithm")
    if isinstance(points, int):
        first, last = (math.log(low), math.log(high)) if log else (low, high)
        second = np.linspace(first, last, points)
    else:
        second = np.log(points) if log else np.array(points)
    family = _family(scene, varied, log)
    rotor, races = dry_rotor(scene).system(), [race.race() for race in scene.balls]
    chosen = State() if state == "balanced" else gathered(rotor, races, state == "light")
    chart = stability_chart(_told(family, speed.size * second.size), speed, second, chosen)
    bounds = existence_bounds(family, float(speed[0]), second) if state == "balanced" else []
    growth, bands = stable_bands(own_family(scene), speed, 0.0, chosen)
    # Ends as they were asked for, without the rounding of a logarithm.
    value = np.exp(second) if log else second.copy()
    value[0], value[-1] = low, high
    value = value if isinstance(points, int) else np.array(points)
    answer = BallChart(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        axis=scene.rotor.axis,
        state=state,
        paths=varied.paths,
        dimension=varied.rule.dimension,
        log=log,
        speed=speed,
        value=value,
        growing=chart.growing.T.astype(np.int32),
        growth=chart.growth.T,
        edges=tuple(_curve(edge, log) for edge in chart.edges),
        bounds=tuple(np.exp(bounds).tolist() if log else bounds),
        scene_value=varied.own,
        scene_growth=growth,
        scene_bands=tuple(bands),
        capacity=tuple(race.capacity for race in scene.balls),
        notes=(),
    )
    return replace(answer, notes=_notes(scene, answer, turning(rotor) is not None))


def _check(scene: Scene, state: str) -> None:
    if not scene.balls:
        raise InputError("chambers", len(scene.chambers), "with one of kind balls for this")
    if state not in STATES:
        raise InputError("state", state, f"one of {', '.join(STATES)}")


def _given(
    varied: _Varied, values: Sequence[str | float], start: str | float | None, stop: str | float | None
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


def _varied(scene: Scene, over: tuple[str, ...]) -> _Varied:
    """What varies: the paths given, or the drag of all races."""
    first = len(scene.liquids)
    paths = over or tuple(f"chambers.{first + k}.drag" for k in range(len(scene.balls)))
    if len(set(paths)) < len(paths):
        raise InputError("over", ", ".join(paths), "paths that differ")
    rules = [_rule(scene, path) for path in paths]
    if len({rule.dimension for rule in rules}) > 1:
        raise InputError("over", ", ".join(paths), "paths of quantities of one kind")
    own = [_own(scene, path) for path in paths]
    together = all(math.isfinite(value) for value in own) and own[0] != 0.0
    # Numbers that have no ratio take the same value.
    shares = tuple(value / own[0] for value in own) if together else (1.0,) * len(own)
    return _Varied(paths, rules[0], own[0], shares)


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
        found = found[key] if isinstance(key, int) and isinstance(found, tuple) else getattr(found, str(key))
    return float(found) if isinstance(found, float | int) else math.nan


def _ends(
    varied: _Varied, start: str | float | None, stop: str | float | None, drag: bool
) -> tuple[float, float]:
    """First and last value, SI."""
    factor, own, ends = _WIDE if drag else _USUAL, varied.own, []
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


def _curve(edge: Edge, log: bool) -> Curve:
    """A curve with values in place of their logarithms."""
    value = np.exp(edge.second) if log else edge.second
    ends = edge.ends[0].name.lower(), edge.ends[1].name.lower()
    return Curve(edge.kind.name.lower(), edge.first, value, edge.frequency, ends)


def _family(scene: Scene, varied: _Varied, log: bool) -> Family:
    """The scene's machine at each speed and value, or logarithm of one."""

    @lru_cache(maxsize=_KEPT)
    def parts(at: float) -> Parts:
        value = math.exp(at) if log else at
        changes = {path: value * share for path, share in zip(varied.paths, varied.shares, strict=True)}
        try:
            return parts_of(scene.replace(changes))
        except SceneError as error:
            fault = error.faults[0]
            where = f"{varied.paths[0]} at {value:g}"
            allowed = f"such that {fault.field} is {fault.allowed}"
            raise InputError("over", where, allowed) from None

    return lambda speed, at: parts(at).at(speed)


def _told(family: Family, total: int) -> Family:
    """The same, telling how many points of the grid are done."""
    done = 0

    def told(speed: float, at: float) -> Machine:
        nonlocal done
        done += 1
        update(min(done, total), total, "points" if done < total else "curves")
        return family(speed, at)

    return told


def _notes(scene: Scene, answer: BallChart, alike: bool) -> tuple[Note, ...]:
    """What was assumed, and what is not reported."""
    found = []
    if answer.state == "balanced":
        found.append(notes.free_balls())
    if answer.missing.any():
        found.append(notes.not_there(float(np.mean(answer.missing)), answer.state))
    if answer.edges:
        found.append(notes.between_lines())
    if len(answer.paths) > 1:
        found.append(notes.in_ratio(answer.paths))
    found.append(notes.points())
    if scene.rotor.axis == "horizontal":
        found.append(notes.lies([]))
    if not alike:
        found.append(notes.uneven_supports())
    if scene.fills:
        found.append(notes.liquid_in_step(liquid_beside(scene)[0]))
    if any(race.liquid is not None for race in scene.balls):
        found.append(notes.covered())
    return (*found, *doubts(scene))
