"""Chambers with baffles in a search over volumes: up to which volume these cut the liquid."""

from __future__ import annotations

import math

import numpy as np

from fluid.fill import Fill
from leblanc.core.units import VOLUME, with_unit
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import Optimisation
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.layer.places import FEWEST_CELLS


def freeing_volumes(scene: Scene) -> Array:
    """Volume of each chamber from which on its liquid passes the baffles, m^3, shape (c,).

    Below it the liquid is in compartments; 0 where it never is, as behind a gap at the wall.
    """
    return np.array([_freeing(fill) for fill in scene.fills])


def _freeing(fill: Fill) -> float:
    chamber, baffles = fill.chamber, fill.chamber.baffles
    if baffles is None or baffles.wetted_span(chamber.radius, baffles.tip_radius) is None:
        return 0.0
    if baffles.wetted_span(chamber.radius, 0.0)[1] < chamber.radius:  # type: ignore[index]
        return 0.0
    inner = max(baffles.tip_radius, chamber.inner_radius)
    return math.pi * chamber.height * (chamber.radius - inner) * (chamber.radius + inner)


def most_cells(scene: Scene) -> int:
    """Cells round each wall that long waves need where the liquid is in the most compartments; 0 without."""
    cut = zip(scene.fills, freeing_volumes(scene).tolist(), strict=True)
    counts = (fill.chamber.baffles.count for fill, freed in cut if freed > 0.0 and fill.chamber.baffles)
    return max((FEWEST_CELLS * count for count in counts), default=0)


def require_known_walls(scene: Scene, task: Optimisation, low: Array, high: Array) -> None:
    """Refuse baffles that no model answers for at some of the volumes searched."""
    for k, (fill, freed) in enumerate(zip(scene.fills, freeing_volumes(scene).tolist(), strict=True)):
        baffles = fill.chamber.baffles
        if baffles is None:
            continue
        if task.whirl_limit is not None:
            raise InputError(
                "optimise.whirl_limit", task.whirl_limit, "left out: limit cycles know no baffles"
            )
        if low[k] >= freed or high[k] <= 0.0:
            continue
        where = f"or least volumes in optimise.volumes.{k} of {with_unit(freed, VOLUME)}, which passes them"
        if baffles.count == 2:
            text = f"3 or more where they cut the liquid, as two compartments have no model; {where}"
            raise InputError(f"chambers.{k}.baffles.count", baffles.count, text)
        plan, cells = scene.speed_plan, FEWEST_CELLS * baffles.count
        if plan is not None and task.objective == "peak" and not task.steady and plan.cells < cells:
            text = f"{cells} or more, {FEWEST_CELLS} in each of {baffles.count} compartments; {where}"
            table = "runup" if scene.programme is None else "programme"
            raise InputError(f"{table}.cells", plan.cells, text)
        if scene.model.liquid not in ("auto", "fem", "long_wave"):
            text = f"auto or fem where baffles cut the liquid into compartments; {where}"
            raise InputError("model.liquid", scene.model.liquid, text)
