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
from pathlib import Path
from typing import TYPE_CHECKING, Any

from leblanc.core.question import called
from leblanc.registry import answerer
from leblanc.scene.scene import Scene, dry_rotor, friction_of, scene_of
from meshes.errors import InputError

if TYPE_CHECKING:
    from fluid.friction.laws import Friction
    from leblanc.core.answer import Answer
    from leblanc.questions import Quantity
    from leblanc.results.explanation import Explanation
    from leblanc.results.fit import FitResult
    from leblanc.results.machine.layout import LayoutResult
    from leblanc.results.models.comparison import Comparison
    from leblanc.results.optimum import OptimumResult
    from leblanc.results.races.chart import BallChart
    from leblanc.results.races.design import BallDesignResult
    from leblanc.results.races.numbers import BallExplanation
    from leblanc.results.races.states import BallsResult
    from leblanc.results.runup import RunupResult
    from leblanc.results.sweep import SweepResult
    from leblanc.results.whirl_map import WhirlMap
    from leblanc.studies.run.answer import RunResult
    from solvers.liquid_model import LiquidModel

SceneOrPath = Scene | Mapping[str, Any] | str | PathLike[str]

_OPTION = re.compile(r"--([a-z][a-z-]*)")


def run(
    scene: SceneOrPath,
    *,
    workers: int = 1,
    solver: str | None = None,
    cycles: bool = False,
    model: LiquidModel | str | None = None,
) -> RunResult | Answer | BallsResult:
    """Response and the liquid's centre of mass at each speed of a scene.

    Parameters
    ----------
    scene : the machine, or the path of its file
    workers : processes that hold long waves in time, where the scene asks for that; this one alone if 1. The
        answer does not depend on it
    solver : of py-pde, by name, that holds them, an independent check: "runge-kutta", "scipy"; the compiled
        steps if None
    cycles : find how large whirls that grow by themselves become, in `self_excited_amplitude`, `cycles` and
        `folds`; it takes some seconds
    model : of the liquid in place of the scene's: an object with the two names of `leblanc.LiquidModel`, or a
        name as in `[model] liquid`

    Returns
    -------
    The response at each speed; of an exciter its stuck speeds and vibration, of a rotor in magnetic bearings
    its poles, margins and motion, of a spindle its compliances and natural frequencies;
    with balls in races the states in which they rest

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
    """
    if workers < 1:
        raise InputError("workers", workers, "1 or more")
    machine = scene_of(scene)
    if model is not None:
        from leblanc.studies.models.liquid import asked_with

        with asked_with(machine, model) as other:
            return run(other, workers=workers, solver=solver, cycles=cycles)
    if (address := answerer("run", machine.rotor.kind)) is not None:
        answer: Answer = called(address)(machine)
        return answer
    if machine.balls:
        from leblanc.studies.races.balls import run_balls

        return run_balls(machine)
    from leblanc.studies.held.holding import Holding
    from leblanc.studies.run.study import run_scene
    from solvers.held.state import COUPLED

    return run_scene(machine, holding=Holding(workers, solver=solver or COUPLED), cycles=cycles)


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


def run_up(
    scene: SceneOrPath,
    *,
    cells: int | None = None,
    samples: int | None = None,
    check: bool = True,
    frames: int | None = None,
    progress: Callable[[float], None] | None = None,
    ensemble: int = 0,
    seed: int = 0,
    workers: int = 1,
) -> RunupResult:
    """Rotor and liquid through the speeds in time, as the scene's table [runup] says.

    Parameters
    ----------
    scene : the machine, or the path of its file
    cells, samples : round each wall, and times that are recorded; the scene's if None
    check : run once more with half the cells to estimate the error
    frames : how many times the layers are kept for a film; not at all if None
    progress : called with the share of the work that is done
    ensemble : how many times the run is repeated with its unbalance changed in the last digits, to tell what
        rounding alone does
    seed : of those changes
    workers : processes that repeat it

    Raises
    ------
    SceneError : with everything that is wrong with the file
    InputError : no table [runup], a value out of its range

    Examples
    --------
    >>> import leblanc as lb
    >>> short = lb.example("runup").replace({"runup.duration": "1 s", "runup.cells": 16})
    >>> bool(lb.run_up(short, samples=50, check=False).amplitude.max() > 0.0)
    True
    """
    from leblanc.studies.runup import runup_scene

    if workers < 1:
        raise InputError("workers", workers, "1 or more")
    return runup_scene(scene_of(scene), cells, samples, check, progress, frames, ensemble, seed, workers)


def map_whirl(
    scene: SceneOrPath,
    *,
    volumes: int = 101,
    speeds: int = 201,
    max_volume: Quantity | None = None,
    friction: str | Mapping[str, object] | Friction | None = None,
    cycles: bool = False,
    progress: Callable[[int, int], None] | None = None,
    model: LiquidModel | str | None = None,
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
    model : of the liquid, as for `run`

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
    from leblanc.studies.models.liquid import asked_with
    from leblanc.studies.whirl_map import map_scene

    with _keywords(), asked_with(machine, model) as machine:
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


def optimise(
    scene: SceneOrPath,
    objective: str | None = None,
    *,
    deflection: Quantity | None = None,
    limit: Quantity | None = None,
    steady: bool = False,
    seed: int | None = None,
    emulator: str | PathLike[str] | None = None,
    front: bool = True,
    progress: Callable[[int], None] | None = None,
    workers: int = 1,
) -> OptimumResult | LayoutResult | BallDesignResult:
    """Best volume of liquid for each chamber, best balls, or best layout of a tub's springs and dampers.

    Where the scene has balls these are chosen, and its liquid stays as it is filled.

    Parameters
    ----------
    scene : the machine, or the path of its file, with or without a table [optimise]
    objective : working_speed, peak, mean, least_mass, robust or layout; the scene's if None
    deflection : given, m: the least liquid that covers the walls at it
    limit : of the vibration, for least_mass, m
    steady : the peak is that of the steady response even if the scene has a run-up
    seed : of the random sample of robust
    emulator : store of a sweep over the volumes, from which the search gets an emulator
    front : find out as well what must be given up for what
    progress : called with the number of sets of volumes, or designs of balls, judged
    workers : processes that judge designs of balls where one takes its time; the answer is the same with any

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
    machine = scene_of(scene)
    from leblanc.questions import optimisation_of, require_no_emulator
    from leblanc.studies.optimise.balls.search import optimise_balls
    from leblanc.studies.optimise.emulated import emulated_vibration
    from leblanc.studies.optimise.layout import optimise_layout
    from leblanc.studies.optimise.optimise import optimise_scene

    with _keywords():
        task = optimisation_of(machine, objective, deflection, limit, steady, seed)
        if task.objective == "layout":
            return optimise_layout(
                machine, task, None if progress is None else lambda count, _: progress(count)
            )
        told = None if progress is None else lambda count, _: progress(count)
        if machine.balls:
            require_no_emulator(emulator)
            return optimise_balls(machine, task, told, workers)
        surrogate = None if emulator is None else emulated_vibration(Path(emulator), machine, task)
        return optimise_scene(machine, task=task, front=front, progress=told, emulator=surrogate)


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


def fit(
    scene: SceneOrPath,
    measured: str | PathLike[str],
    unknown: Sequence[str],
    *,
    starts: int = 2,
    seed: int = 0,
    scale: str = "given",
    noise: str = "estimate",
    column: Mapping[str, str] | None = None,
) -> FitResult:
    """Unknowns of a scene from a measured curve, each with its uncertainty.

    Parameters
    ----------
    scene : the machine, or the path of its file; its values are the first guess
    measured : path of a table over speed, time or liquid added, with a header such as
        "speed [rpm], amplitude [mm]"; commas, semicolons or tabs between its columns
    unknown : paths of the unknowns in the scene, as "rotor.mass"; "A=B" ties B to A
    starts : searches at least; more follow until the best values have been found again
    seed : of the values that they start from
    scale : "given", "free" where the unit of the sensor is not known, "each" where every quantity has its own
    noise : of the measured values: "estimate", "3 %" of each reading, or an error such as "0.1 mm"
    column : headers of the file by the quantities that are meant, as in {"amplitude": "Schwingweg [um pp]"}

    Raises
    ------
    SceneError, InputError : as for `run`; a table that cannot be read, an unknown that is no number above 0

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import leblanc as lb
    >>> rig = lb.example("horizontal_rig").replace({"speeds.count": 12})
    >>> found = lb.run(rig)
    >>> lines = [f"{s}, {a}" for s, a in zip(found.speed, found.amplitude)]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = Path(folder) / "measured.csv"
    ...     _ = table.write_text("\\n".join(["speed [rad/s], amplitude [m]", *lines]))
    ...     answer = lb.fit(rig.replace({"rotor.mass": 4.4}), table, ["rotor.mass"], starts=1)
    >>> round(answer.parameters["rotor.mass"]["value"], 3)
    4.0
    """
    machine = scene_of(scene)
    from leblanc.studies.fit import fit_scene
    from leblanc.studies.fitting.measured import read_measured
    from leblanc.studies.fitting.problem import require_scale

    with _keywords():
        free = require_scale(scale) != "given"
        table = read_measured(measured, dry_rotor(machine).system().coordinates, free, column)
        file = scene if isinstance(scene, str | PathLike) else None
        return fit_scene(machine, table, tuple(unknown), starts, seed, scale, noise=noise, file=file)


def sweep(
    study: str | PathLike[str],
    out: str | PathLike[str] | None = None,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    fresh: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> SweepResult:
    """Answers of many scenes that differ in a few values; after a stop the same call continues.

    Parameters
    ----------
    study : path of the study file
    out : folder of the store; out/<study name> if None
    workers : local processes, 0 for none but this; the cores if None
    scheduler : address of a Dask scheduler, in place of local processes
    fresh : start anew, without what is in the store
    progress : called with the number of samples finished and of all

    Raises
    ------
    SceneError : with everything that is wrong with the files
    InputError : a store of another study, a scheduler that does not answer

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.sweep("study.toml", workers=0)  # doctest: +SKIP
    """
    from leblanc.core.files import out_dir
    from leblanc.studies.sweep.study import load_sweep
    from leblanc.studies.sweep.summary import sweep_result

    plan = load_sweep(Path(study))
    folder = out_dir(plan.name, None if out is None else Path(out))
    with _keywords():
        return sweep_result(plan, folder, workers, scheduler, fresh, progress)


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
