"""Self-excited whirl over speed and fill or another number; of balls where they balance."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import FRICTION, SCENE, Option, Points, Quantity, Texts, ask, together
from leblanc.core.units import ANGULAR_SPEED, VOLUME
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene, SceneOrPath
    from leblanc.studies.map.answer import WhirlMap
    from leblanc.studies.map.balls.answer import BallChart

FILES = ("map.html", "map.nc")

# The second axis of either map.
_Over = Annotated[
    Texts,
    "Path of the number on the second axis, as rotor.damping_ratio; several, each behind its own --over, "
    "keep their ratios [default: the liquid's volume; with balls the drag in all races].",
]
_First = Annotated[Quantity | None, Option(("--from",)), "Its first value [default: a tenth of the scene's]."]
_Last = Annotated[Quantity | None, Option(("--to",)), "Its last value [default: ten times the scene's]."]
_Values = Annotated[Points, "How many values of it [default: 31]."]
_Spacing = Annotated[
    bool | None,
    Option(("--log/--linear",)),
    "How it is spaced [default: log where it spans a decade].",
]


def map_whirl(
    scene: Annotated[SceneOrPath, SCENE, "The machine, or the path of its file."],
    *,
    volumes: Annotated[Points, VOLUME, "How many volumes [default: 101]."] = 101,
    speeds: Annotated[
        Points, ANGULAR_SPEED, "How many speeds, over the scene's range [default: 201; with balls 61]."
    ] = 201,
    max_volume: Annotated[
        Quantity | None, VOLUME, "Most liquid in all chambers together [default: what fits]."
    ] = None,
    over: _Over = (),
    start: _First = None,
    stop: _Last = None,
    values: _Values = 31,
    log: _Spacing = None,
    friction: Annotated[
        Any,
        FRICTION,
        "none, stokes, wall[:ROUGHNESS], linear:RATE or quadratic:NUMBER [default: the scene's].",
    ] = None,
    cycles: Annotated[
        bool,
        Option(("--cycles",)),
        "Find how large the whirls of the scene as it stands grow: amplitude, frequency, folds, stability.",
    ] = False,
    model: Annotated[
        Any,
        Option(("--model",)),
        "Liquid model in place of the scene's, by its name; kdv: limit cycles by KdV-Burgers.",
    ] = None,
    progress: Annotated[
        Callable[[float, float], None] | None, "Called with the number of volumes done and of all."
    ] = None,
) -> WhirlMap:
    """Growth rate of self-excited whirl over speed and fill, or another number, with the edges of its bands.

    Rising arrays say each of the `volumes`, of all liquid together, of the `speeds`, and of the `values` of
    what `over` names. Friction may be a table as in a machine file as well, or a `Friction`; the model an
    object as `leblanc.LiquidModel` says.

    Raises
    ------
    SceneError, InputError : as for `run`; a path that leads to no number

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.map_whirl(lb.example("horizontal_rig"), volumes=3, speeds=5).growth.shape
    (3, 5)
    >>> lb.map_whirl(lb.example("horizontal_rig"), over="rotor.damping_ratio", values=3, speeds=5).value
    array([0.01, 0.1 , 1.  ])
    >>> lb.map_whirl(lb.example("horizontal_rig"), volumes=["5 ml", "8 ml"], speeds=[100, 150, 210]).speed
    array([100., 150., 210.])
    """
    return ask(map_whirl, "leblanc.studies.map.study:answer", locals())


def map_balls(
    scene: Annotated[SceneOrPath, SCENE, "The machine with its races, or its file."],
    over: _Over = (),
    *,
    start: _First = None,
    stop: _Last = None,
    values: _Values = 31,
    speeds: Annotated[Points, ANGULAR_SPEED, "How many speeds, over the scene's range."] = 61,
    log: _Spacing = None,
    state: Annotated[
        str, "Of the balls: balanced, heavy or light, together on that side [default: balanced]."
    ] = "balanced",
    progress: Annotated[
        Callable[[float, float], None] | None, "Called with the number of points done and of all."
    ] = None,
) -> BallChart:
    """Where the balls of a scene keep the rotor balanced, over its speeds and another of its numbers.

    Rising arrays say each of the `values` and `speeds`.

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
    return ask(map_balls, "leblanc.studies.map.balls.study:chart_scene", locals())


def map(scene: Scene, **options: Any) -> WhirlMap | BallChart:
    """Growth of self-excited whirl over speed and fill, or any number; with balls where these balance.

    Options of the other kind of machine are refused.
    """
    own, kind = (map_balls, "balls") if scene.kind == "balls" else (map_whirl, "no balls")
    given = {name: value for name, value in options.items() if value is not None}
    for name, value in given.items():
        if name not in own.__annotations__:
            raise InputError(name, value, f"left out for a scene with {kind}")
    found: WhirlMap | BallChart = own(scene, **given)
    return found


map.__signature__ = together(map_whirl, map_balls)  # type: ignore[attr-defined]  # of the command
