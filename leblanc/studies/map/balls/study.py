"""Charts of the balls of a scene: where a state is stable, over its speeds and any other number of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

from leblanc.core.notes import Note
from leblanc.core.progress import update
from leblanc.liquid.validity import doubts
from leblanc.scene.scene import Scene, dry_rotor
from leblanc.studies.balls import notes
from leblanc.studies.balls.states import Parts, liquid_beside, own_family, parts_of
from leblanc.studies.map.axes import speeds_of
from leblanc.studies.map.balls.answer import STATES, BallChart, Curve
from leblanc.studies.map.varied import USUAL, Varied, axis_of, varied_of
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
_WIDE = 100.0  # factor on both sides of the scene's drag
_KEPT = 4096  # machines


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
    drags = tuple(f"chambers.{len(scene.liquids) + k}.drag" for k in range(len(scene.balls)))
    varied = varied_of(scene, over or drags)
    axis = axis_of(varied, values, start, stop, log, MOST, USUAL if over else _WIDE)
    second, log = axis.even, axis.log
    family = _family(scene, varied, log)
    rotor, races = dry_rotor(scene).system(), [race.race() for race in scene.balls]
    chosen = State() if state == "balanced" else gathered(rotor, races, state == "light")
    chart = stability_chart(_told(family, speed.size * second.size), speed, second, chosen)
    bounds = existence_bounds(family, float(speed[0]), second) if state == "balanced" else []
    growth, bands = stable_bands(own_family(scene), speed, 0.0, chosen)
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
        value=axis.value,
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


def _curve(edge: Edge, log: bool) -> Curve:
    """A curve with values in place of their logarithms."""
    value = np.exp(edge.second) if log else edge.second
    ends = edge.ends[0].name.lower(), edge.ends[1].name.lower()
    return Curve(edge.kind.name.lower(), edge.first, value, edge.frequency, ends)


def _family(scene: Scene, varied: Varied, log: bool) -> Family:
    """The scene's machine at each speed and value, or logarithm of one."""

    @lru_cache(maxsize=_KEPT)
    def parts(at: float) -> Parts:
        return parts_of(varied.at(scene, math.exp(at) if log else at))

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
