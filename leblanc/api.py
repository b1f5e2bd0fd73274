"""The calls of `import leblanc as lb`: what the commands do, as functions.

Scenes are `leblanc.Scene` or the path of a scene file; quantities are numbers in SI units or texts with a
unit, as in "65 mm". Every call returns a result with `.to_json()`, `.to_dataset()` and `.plot()`, which shows
itself in a notebook.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from leblanc.core.question import called
from leblanc.registry import answerer
from leblanc.scene.scene import SceneOrPath, scene_of
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.core.answer import Answer
    from leblanc.results.explanation import Explanation
    from leblanc.results.models.comparison import Comparison
    from leblanc.results.races.numbers import BallExplanation


_OPTION = re.compile(r"--([a-z][a-z-]*)")


def validate(group: str | None = None) -> Sequence[Any]:
    """Published cases beside what the package computes: printed, computed, difference and verdict of each.

    Parameters
    ----------
    group : of cases, as `leblanc validate --help` lists them; all if None

    Raises
    ------
    InputError : no such group

    Examples
    --------
    >>> import leblanc as lb
    >>> {case.verdict for case in lb.validate("turning")} <= {"agrees", "erratum", "trend", "differs"}
    True
    """
    found: Sequence[Any] = called("validation.command:all_cases")(group)
    return found


def explain(
    scene: SceneOrPath,
) -> Explanation | Answer | BallExplanation:
    """A scene's dimensionless numbers, the liquid model that answers at each speed, and why.

    Of balls in races: what they hold and from which speed on they balance.

    Parameters
    ----------
    scene : the machine, or the path of its file

    Raises
    ------
    SceneError, InputError : as for `run`

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.explain(lb.example("horizontal_rig")).critical_speed_dry > 0.0
    True
    """
    machine = scene_of(scene)
    if (address := answerer("explain", machine.rotor.kind)) is not None:
        answer: Answer = called(address)(machine)
        return answer
    if machine.balls:
        from leblanc.studies.explain import explain_balls

        return explain_balls(machine)
    from leblanc.studies.explain import explain_scene

    return explain_scene(machine)


def compare(scene: SceneOrPath, models: Sequence[str]) -> Comparison:
    """The same scene answered by several liquid models, side by side, with what each takes.

    Parameters
    ----------
    scene : the machine, or the path of its file
    models : names of liquid models; one that does not answer `run` is listed with the reason

    Raises
    ------
    SceneError, InputError : as for `run`; no model that answers

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.compare(lb.example("horizontal_rig"), models=["statics", "linear"]).models
    ('statics', 'linear')
    """
    machine = scene_of(scene)
    from leblanc.studies.compare import compare_models

    with _keywords():
        return compare_models(machine, tuple(models))


@contextmanager
def _keywords() -> Iterator[None]:
    """Faults name the keyword in place of the command's option."""
    try:
        yield
    except InputError as error:
        field, allowed = (_OPTION.sub(_keyword, text) for text in (error.field, str(error.allowed)))
        raise InputError(field, error.value, allowed) from error.__cause__


def _keyword(option: re.Match[str]) -> str:
    return option[1].replace("-", "_")
