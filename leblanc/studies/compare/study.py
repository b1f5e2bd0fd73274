"""One scene answered by several liquid models, each with what it costs."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from leblanc.core.progress import update
from leblanc.liquid.models import asked_with
from leblanc.registry import LIQUIDS, announced
from leblanc.scene.scene import LIQUID_MODELS, Scene, require_chambers, require_no_balls, require_whirl
from leblanc.studies.compare.answer import CompareAnswer, ModelAnswer
from leblanc.studies.held.holding import Holding
from leblanc.studies.run.study import run_scene
from meshes.errors import InputError
from solvers.checked_model import CheckedModel
from solvers.liquid_model import LiquidModel


def answer(
    scene: Scene,
    models: Sequence[str | LiquidModel],
    workers: int = 1,
    fresh: bool = False,
    folder: Path | None = None,
) -> CompareAnswer:
    """Response of a scene by each of several liquid models, by rising exactness."""
    names = _checked(scene, models)
    holding, found, refusals = Holding(workers, folder, fresh), [], []
    for name, model in zip(names, models, strict=True):
        update(what=f"response by {name}")
        try:
            found.append(_answer(scene, model, holding))
        except InputError as error:
            refusals.append(error)
            found.append(ModelAnswer(name, str(error), None, None))
    if len(refusals) == len(found):
        raise _none(names, refusals)
    return CompareAnswer(scene.name, scene.source, scene.assumed, scene.digest, tuple(found))


def _checked(scene: Scene, models: Sequence[str | LiquidModel]) -> tuple[str, ...]:
    """Names of the models, after what can be refused before any of them is asked."""
    require_no_balls(scene, "a comparison of liquid models, as balls have one model; `leblanc run` answers")
    require_whirl(scene)
    require_chambers(scene, "a comparison of liquid models")
    every = (*LIQUID_MODELS, *announced(LIQUIDS, LIQUID_MODELS))
    known = ", ".join(every)
    names = tuple(model if isinstance(model, str) else CheckedModel(model).name for model in models)
    if not models:
        raise InputError("models", "none", f"at least one of {known}")
    for k, name in enumerate(names):
        if isinstance(models[k], str) and name not in every:
            raise InputError("models", name, f"some of {known}, with commas between them")
        if name in names[:k]:
            raise InputError("models", ",".join(names), f"different models: {name} stands there twice")
    return names


def _answer(scene: Scene, model: str | LiquidModel, holding: Holding) -> ModelAnswer:
    """The answer by one model, and its processor time."""
    named = isinstance(model, str)
    variant = scene.altered(model=scene.model.altered(liquid=model)) if named else scene
    began = _processor_time()
    with asked_with(variant, None if named else model) as own:
        result = run_scene(own, holding=holding)
    return ModelAnswer(own.model.liquid, "", _processor_time() - began, result)


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
