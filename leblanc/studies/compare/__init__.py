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

FILES = ("compare.nc",)
_NAMES = Reader("leblanc.studies.compare:names_of")


def compare(
    scene: Annotated[SceneOrPath, SCENE, "The machine, or the path of its file."],
    models: Annotated[
        Sequence[str], _NAMES, "Liquid models, commas between them; the last that answers is the reference."
    ],
    *,
    workers: Annotated[int, Option(same=True), "Processes that hold waves in time [default: all cores]."] = 1,
    fresh: Annotated[
        bool, Option(same=True), "Recompute what an earlier run has left, so that all its time counts."
    ] = False,
    folder: Path | None = None,
) -> CompareAnswer:
    """The same scene by several liquid models. Table, figure, cost.

    A model that does not answer the scene is an entry with the reason. The processor time is that of this
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


def names_of(models: Any, field: str) -> tuple[str, ...]:
    """Names of liquid models, of a list or of one text with commas between them."""
    names = models.split(",") if isinstance(models, str) else models
    if not isinstance(names, Sequence) or not all(isinstance(name, str) for name in names):
        raise InputError(field, str(models), "names of liquid models, in a list or with commas between them")
    return tuple(name.strip() for name in names)
