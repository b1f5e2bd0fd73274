"""Answers by the kind of machine: those of its wing, or of the core, whose solvers are loaded only then."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from leblanc.core.answer import Answer, as_typed
from leblanc.core.question import called
from leblanc.liquid.models import asked_with
from leblanc.registry import answerer
from leblanc.scene.scene import Scene
from meshes.errors import InputError


def run(
    scene: Scene,
    *,
    workers: int,
    fresh: bool,
    solver: str | None,
    cycles: bool,
    model: object,
    speeds: Sequence[str | float] | None,
    folder: Path | None,
) -> Answer:
    """Response of a machine, as `leblanc.run` takes its parameters."""
    if workers < 1:
        raise InputError("workers", workers, "1 or more")
    scene = scene if speeds is None else scene.replace({"speeds": speeds})
    with asked_with(scene, model) as own:
        found: Answer
        if (special := answerer("run", own.kind)) is not None:
            found = special(own)
        else:
            from leblanc.studies.held.holding import Holding
            from leblanc.studies.run.study import run_scene
            from solvers.held.state import COUPLED

            found = run_scene(own, Holding(workers, folder, fresh, solver or COUPLED), cycles)
    as_typed(found, scene, model=model)
    return found


def explain(scene: Scene) -> Answer:
    """Numbers of a machine before any speed is solved."""
    answer = answerer("explain", scene.kind) or called("leblanc.studies.explain.study:explain_scene")
    found: Answer = answer(scene)
    return found
