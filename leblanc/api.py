"""The calls of `import leblanc as lb`: what the commands do, as functions.

Scenes are `leblanc.Scene` or the path of a scene file; quantities are numbers in SI units or texts with a
unit, as in "65 mm". Every call returns a result with `.to_json()`, `.to_dataset()` and `.plot()`, which shows
itself in a notebook.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from os import PathLike
from typing import TYPE_CHECKING

from leblanc.core.question import Quantity, called
from leblanc.registry import answerer
from leblanc.scene.scene import Scene, friction_of, scene_of
from meshes.errors import InputError

if TYPE_CHECKING:
    from fluid.friction.laws import Friction
    from leblanc.core.answer import Answer
    from leblanc.results.explanation import Explanation
    from leblanc.results.models.comparison import Comparison
    from leblanc.results.races.chart import BallChart
    from leblanc.results.races.numbers import BallExplanation
    from leblanc.results.whirl_map import WhirlMap

SceneOrPath = Scene | str | PathLike[str]

_OPTION = re.compile(r"--([a-z][a-z-]*)")


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


def map_whirl(
    scene: SceneOrPath,
    *,
    volumes: int = 101,
    speeds: int = 201,
    max_volume: Quantity | None = None,
    friction: str | Mapping[str, object] | Friction | None = None,
    cycles: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> WhirlMap:
    """Growth rate of self-excited whirl over speed and fill, with the edges of its bands.

    Parameters
    ----------
    scene : the machine, or the path of its file
    volumes, speeds : how many of each
    max_volume : most liquid in all chambers together, m^3; what fits if None
    friction : none, stokes, wall[:ROUGHNESS], linear:RATE or quadratic:NUMBER, a table as in a machine file,
        or a `Friction`; the scene's if None
    cycles : find how large the whirls of the scene as it stands grow as well, in `cycles` and `folds`
    progress : called with the number of volumes done and of all

    Raises
    ------
    SceneError, InputError : as for `run`

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.map_whirl(lb.example("horizontal_rig"), volumes=3, speeds=5).growth.shape
    (3, 5)
    """
    machine = scene_of(scene)
    from leblanc.core.units import VOLUME, parse_option
    from leblanc.studies.whirl_map import map_scene

    with _keywords():
        most = None if max_volume is None else parse_option(max_volume, VOLUME, "--max-volume")
        law = None if friction is None else friction_of(friction, "friction")
        return map_scene(machine, volumes, speeds, most, law, progress, cycles)


def map_balls(
    scene: SceneOrPath,
    over: str | Sequence[str] = (),
    *,
    start: Quantity | None = None,
    stop: Quantity | None = None,
    values: int = 31,
    speeds: int = 61,
    log: bool | None = None,
    state: str = "balanced",
    progress: Callable[[int, int], None] | None = None,
) -> BallChart:
    """Where the balls of a scene keep the rotor balanced, over its speeds and another of its numbers.

    Parameters
    ----------
    scene : the machine with its races, or the path of its file
    over : path of the number, as "chambers.0.drag"; several keep their ratios; the drag in all races if empty
    start, stop : first and last value of it (`--from` and `--to`); chosen about what the scene has if None
    values, speeds : how many of each
    log : space the values by their logarithm; where they span a decade if None
    state : balanced; heavy or light, with the balls of each race together on that side of its plane
    progress : called with the number of points done and of all

    Raises
    ------
    SceneError, InputError : as for `run`; no race, a path that leads to no number

    Examples
    --------
    >>> import leblanc as lb
    >>> chart = lb.map_balls(lb.example("balls"), "rotor.unbalance", values=5, speeds=9)
    >>> chart.growing[-1].tolist()  # beyond what two balls hold
    [-1, -1, -1, -1, -1, -1, -1, -1, -1]
    """
    machine = scene_of(scene)
    from leblanc.studies.races.chart import chart_scene

    paths = (over,) if isinstance(over, str) else tuple(over)
    with _keywords():
        return chart_scene(
            machine,
            paths,
            start,
            stop,
            values=values,
            speeds=speeds,
            log=log,
            state=state,
            progress=progress,
        )


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
