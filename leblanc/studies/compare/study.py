"""One scene answered by several liquid models, each with what it costs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from leblanc.core.progress import update
from leblanc.scene.scene import LIQUID_MODELS, Scene, require_chambers, require_no_balls, require_whirl
from leblanc.studies.compare.answer import CompareAnswer, ModelAnswer
from leblanc.studies.held.holding import Holding
from leblanc.studies.run.study import run_scene
from meshes.errors import InputError


def answer(
    scene: Scene, models: Sequence[str], workers: int = 1, fresh: bool = False, folder: Path | None = None
) -> CompareAnswer:
    """Response of a scene by each of several liquid models, by rising exactness."""
    _check(scene, models)
    holding, found, refusals = Holding(workers, folder, fresh), [], []
    for name in models:
        update(what=f"response by {name}")
        try:
            found.append(_answer(scene, name, holding))
        except InputError as error:
            refusals.append(error)
            found.append(ModelAnswer(name, str(error), None, None))
    if len(refusals) == len(found):
        raise _none(models, refusals)
    return CompareAnswer(scene.name, scene.source, scene.assumed, scene.digest, tuple(found))


def _check(scene: Scene, models: Sequence[str]) -> None:
    require_no_balls(scene, "a comparison of liquid models, as balls have one model; `leblanc run` answers")
    require_whirl(scene)
    require_chambers(scene, "a comparison of liquid models")
    known = ", ".join(LIQUID_MODELS)
    if not models:
        raise InputError("models", "none", f"at least one of {known}")
    for k, name in enumerate(models):
        if name not in LIQUID_MODELS:
            raise InputError("models", name, f"some of {known}, with commas between them")
        if name in models[:k]:
            raise InputError("models", ",".join(models), f"different models: {name} stands there twice")


def _answer(scene: Scene, name: str, holding: Holding) -> ModelAnswer:
    """The answer by one model, and its processor time."""
    variant = scene.altered(model=scene.model.altered(liquid=name))
    began = _processor_time()
    result = run_scene(variant, holding=holding)
    return ModelAnswer(name, "", _processor_time() - began, result)


def _processor_time() -> float:
    """Of this process and of those that it has waited for, s."""
    return sum(os.times()[:4])


def _none(models: Sequence[str], refusals: Sequence[InputError]) -> InputError:
    """The fault where no model answers: the scene's own where all say the same of it, else the choice."""
    first = refusals[0]
    if all((refusal.field, str(refusal)) == (first.field, str(first)) for refusal in refusals) and (
        first.field != "model.liquid"
    ):
        return first
    allowed = f"at least one that answers the scene; {first.field} must be {first.allowed}"
    return InputError("models", ",".join(models), allowed)
