"""A scene's numbers and the liquid model that answers at each speed."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import SCENE, Option, ask

if TYPE_CHECKING:
    from leblanc.core.answer import Answer
    from leblanc.scene.scene import SceneOrPath
    from leblanc.studies.explain.answer import ExplainAnswer
    from leblanc.studies.explain.balls.answer import BallExplainAnswer


def explain(
    scene: Annotated[SceneOrPath, SCENE, "The machine, or the path of its file."],
) -> ExplainAnswer | BallExplainAnswer | Answer:
    """Key numbers of the machine; which liquid model answers, and why.

    Of balls in races what they hold, and from which speed on they balance.

    Raises
    ------
    SceneError, InputError : as for `run`

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.explain(lb.example("horizontal_rig")).critical_speed_dry > 0.0
    True
    """
    return ask(explain, "leblanc.studies.kinds:explain", locals())


def present(
    answer: Any,
    *,
    full: Annotated[bool, Option(("--full",)), "Every number, and why each model answers."] = False,
) -> Any:
    """What the command alone is asked for: twelve lines, or everything."""
    return replace(answer, full=full) if hasattr(answer, "full") else answer
