"""One scene answered by several liquid models."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import SCENE, Option, Reader, ask
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.scene.scene import SceneOrPath
    from leblanc.studies.compare.answer import CompareAnswer
    from solvers.liquid_model import LiquidModel

FILES = ("compare.nc",)
_MODELS = Reader("leblanc.studies.compare:models_of")


def compare(
    scene: Annotated[SceneOrPath, SCENE, "The machine, or the path of its file."],
    models: Annotated[
        Sequence[str | LiquidModel],
        _MODELS,
        "Liquid models, commas between them; the last that answers is the reference.",
    ],
    *,
    workers: Annotated[int, Option(same=True), "Processes that hold waves in time [default: all cores]."] = 1,
    fresh: Annotated[
        bool, Option(same=True), "Recompute what an earlier run has left, so that all its time counts."
    ] = False,
    folder: Path | None = None,
) -> CompareAnswer:
    """The same scene by several liquid models. Table, figure, cost.

    In Python an object as `leblanc.LiquidModel` says may stand beside the names. A model that does not answer
    the scene is an entry with the reason. The processor time is that of this
    process and of its workers, and includes libraries that a model alone needs and that are loaded for it.

    Raises
    ------
    SceneError, InputError : as for `run`; no model that answers

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.compare(lb.example("horizontal_rig"), models=["statics", "linear"]).models
    ('statics', 'linear')
    """
    return ask(compare, "leblanc.studies.compare.study:answer", locals())


def models_of(models: Any, field: str) -> tuple[Any, ...]:
    """Liquid models of a list of names and objects, or of one text of names with commas between them."""
    given = models.split(",") if isinstance(models, str) else models
    if not isinstance(given, Sequence) or not all(
        isinstance(one, str) or hasattr(one, "answer") for one in given
    ):
        raise InputError(field, str(models), "names of liquid models, in a list or with commas between them")
    return tuple(one.strip() if isinstance(one, str) else one for one in given)
