"""Best volume of liquid, balls or layout of a tub's mounts for an objective."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import FILE, SCENE, Option, Quantity, ask
from leblanc.core.units import LENGTH, TIME

if TYPE_CHECKING:
    from leblanc.studies.optimise.answer import OptimumAnswer
    from leblanc.studies.optimise.balls.answer import BallDesignAnswer
    from leblanc.studies.optimise.layout.answer import LayoutAnswer

FILES = ("layout.html", "layout.nc", "optimise.html", "optimum.nc")


def optimise(
    scene: Annotated[Any, SCENE, "Machine, or the path of its file, with or without a table [optimise]."],
    objective: Annotated[
        str | None,
        "working_speed, peak, mean, least_mass, robust, floor_force, walking_margin, point_clearance, "
        "motor_torque, or layout of a tub's mounts [default: the scene's, or working_speed].",
    ] = None,
    *,
    deflection: Annotated[
        Quantity | None, LENGTH, "Given deflection: the least liquid that wets the walls at it."
    ] = None,
    limit: Annotated[
        Quantity | None, LENGTH, "Vibration limit of the objective least_mass [default: the scene's]."
    ] = None,
    steady: Annotated[
        bool, Option(("--steady",)), "Peak of the steady response even if the scene has a run-up."
    ] = False,
    seed: Annotated[
        int | None, "Random seed of robust samples, balls and layouts [default: the scene's]."
    ] = None,
    emulator: Annotated[
        Any, FILE, "Store of a sweep over the volumes: an emulator of it answers in the search."
    ] = None,
    workers: Annotated[
        int,
        Option(same=True),
        "Processes for designs of balls and whirls with baffles, threads for run-ups, where one takes its "
        "time [default: all cores].",
    ] = 1,
    front: Annotated[bool, "Leave out the trade-off (Pareto front)."] = True,
    max_evaluations: Annotated[
        int | None,
        "Evaluations at most: the answer is then the best so far, and says so [default: any number].",
    ] = None,
    timeout: Annotated[
        Quantity | None, TIME, "Time that the search may take, likewise, e.g. 60 s [default: any]."
    ] = None,
    progress: Callable[[float, float], None] | None = None,
) -> OptimumAnswer | LayoutAnswer | BallDesignAnswer:
    """Best volume(s), balls, or layout of a tub's mounts, for an objective. Figures, data file, report.

    Where the scene has balls these are chosen, and its liquid stays as it is filled. `progress` is called
    with what is done and the total.

    Raises
    ------
    SceneError, InputError : as for `run`; a value that does not fit the scene

    Examples
    --------
    >>> import leblanc as lb
    >>> best = lb.optimise(lb.example("horizontal_rig"), front=False)
    >>> bool(best.value < best.baseline)
    True
    """
    return ask(optimise, "leblanc.studies.optimise.study:answer", locals())
