"""Response and the liquid's centre of mass at each speed of a scene."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import SCENE, Option, Quantity, ask

if TYPE_CHECKING:
    from leblanc.core.answer import Answer
    from leblanc.scene.scene import SceneOrPath
    from leblanc.studies.run.answer import RunAnswer

FILES = ("summary.html", "response.nc")


def run(
    scene: Annotated[SceneOrPath, SCENE, "The machine, or the path of its file."],
    *,
    workers: Annotated[int, Option(same=True), "Processes that hold waves in time [default: all cores]."] = 1,
    fresh: Annotated[bool, Option(same=True), "Recompute what an earlier run has left."] = False,
    solver: Annotated[
        str | None, "Of py-pde, that holds waves in time: runge-kutta, scipy ... [default: coupled]."
    ] = None,
    cycles: Annotated[
        bool, Option(("--cycles",)), "Find how large whirls that grow by themselves become."
    ] = False,
    model: Annotated[
        Any,
        Option(alone=True),
        "Liquid in place of the scene's: an object as `leblanc.LiquidModel` says, or a name.",
    ] = None,
    speeds: Annotated[
        Sequence[Quantity] | None, Option(alone=True), "Rising spin speeds in place of the scene's."
    ] = None,
    folder: Path | None = None,
) -> RunAnswer | Answer:
    """Answer of the machine at each speed. Figures, data file, report.

    The response at each speed; of an exciter its stuck speeds and vibration, of a rotor in magnetic bearings
    its poles, margins and motion, of a spindle its compliances and natural frequencies; with balls in races
    the states in which they rest. It depends neither on the workers nor on what the folder has kept.

    Raises
    ------
    SceneError : with everything that is wrong with the file
    InputError : the scene names a liquid model that does not know its chambers, fewer than one worker

    Examples
    --------
    >>> import leblanc as lb
    >>> answer = lb.run(lb.example("horizontal_rig"))
    >>> answer.speed.shape == answer.amplitude.shape == (201,)
    True
    >>> lb.run(lb.example("horizontal_rig"), speeds=["900 rpm", "1100 rpm"]).stable
    array([ True, False])
    """
    return ask(run, "leblanc.studies.kinds:run", locals())
