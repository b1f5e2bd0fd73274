"""The best volumes of a scene's chambers for an objective the user names [theory: optimum]."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fluid.whirl import is_full
from leblanc.scene.machine import require_clear
from leblanc.scene.optimise import Optimisation
from leblanc.scene.scene import Scene, Speeds
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from leblanc.studies.optimise.closed_form import (
    Covering,
    cover_walls,
    covering,
    dry_verdict,
    liquid_unbalance,
    one_point,
)
from leblanc.studies.optimise.constraints import Verdict, growth
from leblanc.studies.optimise.emulated import EmulatedAnswer, EmulatedVibration
from leblanc.studies.optimise.front import Front, front_around
from leblanc.studies.optimise.judge import Goal, goal_of, growth_speeds
from leblanc.studies.optimise.objectives import RunupPeak
from leblanc.studies.optimise.search import best_volumes, bounds_of, judged_again, on_all_cells
from leblanc.studies.prepare import axial_gravity
from leblanc.studies.validity import RANGES
from leblanc.units import RPM
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.search import Found, Judgement


@dataclass(frozen=True)
class OptimumRecord:
    """The best volumes of a scene and what they were chosen from; c chambers, m sets of volumes judged.

    Parameters
    ----------
    scene : the machine as it was given
    aim : what was asked for
    objective, meaning, unit : name, words and unit of the value
    working_speed : rad/s
    volume : the answer, m^3, shape (c,)
    value, baseline : of the objective with these volumes and without liquid
    vibration, vibration_baseline : m; the value itself unless that is a mass
    feasible : every constraint is met
    constraints : by name
    mass : of the liquid, kg
    growth : of the small whirl that grows most at the operating speeds, 1/s
    covering : for each chamber the closed forms at the deflection that the answer itself has
    evaluations : sets of volumes judged
    points : all of them, m^3, shape (m, c)
    judged : what was said of them
    front : what must be given up for what; None if it was not asked for
    sweep : from no liquid to the fullest chamber, shares as in the answer; None with the front
    notes : limits and findings, in words
    emulated : what the emulator that the search asked says of the answer; None without one
    """

    scene: Scene
    aim: Optimisation
    objective: str
    meaning: str
    unit: str
    working_speed: float
    volume: Array
    value: float
    baseline: float
    vibration: float
    vibration_baseline: float
    feasible: bool
    constraints: dict[str, Verdict]
    mass: float
    growth: float
    covering: tuple[Covering, ...]
    evaluations: int
    points: Array
    judged: Judgement
    front: Front | None
    sweep: Front | None
    notes: tuple[str, ...]
    emulated: EmulatedAnswer | None = None


def optimise_scene(
    scene: Scene,
    objective: str | None = None,
    aim: Optimisation | None = None,
    front: bool = True,
    progress: Callable[[int], None] | None = None,
    emulator: EmulatedVibration | None = None,
) -> OptimumRecord:
    """Best volume for each chamber of a scene.

    Parameters
    ----------
    scene : the machine; its own volumes do not matter
    objective : in place of the aim's
    aim : in place of the scene's
    front : find out as well what must be given up for what
    progress : called with the number of sets of volumes judged so far
    emulator : asked by the search in place of the solvers, which then judge the best that it found

    Returns
    -------
    OptimumRecord; `feasible` is False where no volumes meet the constraints, and those are given then that
    exceed them least

    Raises
    ------
    InputError : no chamber, a value that does not fit the scene, an objective that lacks something

    Examples
    --------
    >>> from leblanc.scene.scene import load_scene
    >>> best = optimise_scene(load_scene("examples/horizontal_rig.toml"), front=False)
    >>> bool(best.value < best.baseline)
    True
    """
    wish = aim or scene.optimise or Optimisation()
    wish = wish if objective is None else wish.altered(objective=objective)
    if not scene.fills:
        raise InputError("chambers", "none", "at least one to choose the volume of")
    require_clear(scene, "a search over volumes, which rests on the exact equilibrium in a clear ring")
    low, high = bounds_of(scene, wish)
    if wish.deflection is not None:
        return _at_given_deflection(scene, wish, wish.deflection)
    machine = FilledMachine(scene)
    goal = goal_of(scene, wish, machine, lambda one: best_volumes(scene, one, low, high, progress))
    if emulator is None:
        found = best_volumes(scene, goal, low, high, progress)
        chosen, sure = on_all_cells(scene, goal, found)
        record = _record(scene, wish, sure, machine, chosen)
    else:
        low, high = emulator.inside(low, high, np.array([fill.volume for fill in scene.fills]))
        quick = replace(goal, judge=replace(goal.judge, vibration=emulator), costly=False)
        chosen = judged_again(goal, best_volumes(scene, quick, low, high, progress))
        told = emulator.answer(chosen.point)
        record = _record(scene, wish, goal, machine, chosen)
        record = replace(record, emulated=told, notes=(told.words(), *record.notes))
    if not front:
        return record
    edge, sweep = front_around(scene, goal, chosen, record.vibration, growth_speeds(scene, wish))
    return replace(record, front=edge, sweep=sweep)


def _record(
    scene: Scene, aim: Optimisation, goal: Goal, machine: FilledMachine, found: Found
) -> OptimumRecord:
    """All that is to be told of the answer."""
    judge, volume = goal.judge, found.point
    nothing = np.zeros((1, volume.size))
    vibration, dry = (float(judge.vibration.exact(row)[0]) for row in (volume[None], nothing))
    verdicts = {
        "capacity": _capacity(scene, volume),
        **{one.name: one.verdict(float(one.value(volume[None])[0])) for one in judge.constraints},
    }
    mass = float(volume @ judge.density)
    speeds = growth_speeds(scene, aim)
    most = float(growth(scene, volume[None], speeds)[0])
    return OptimumRecord(
        scene=scene,
        aim=aim,
        objective=aim.objective,
        meaning=goal.meaning,
        unit="kg" if judge.by_mass else "m",
        working_speed=goal.working_speed,
        volume=volume,
        value=mass if judge.by_mass else vibration,
        baseline=0.0 if judge.by_mass else dry,
        vibration=vibration,
        vibration_baseline=dry,
        feasible=all(one.satisfied for one in verdicts.values()),
        constraints=verdicts,
        mass=mass,
        growth=most,
        covering=_closed_forms(machine.scene, volume, goal.working_speed),
        evaluations=int(np.unique(found.points, axis=0).shape[0]),
        points=found.points,
        judged=found.judged,
        front=None,
        sweep=None,
        notes=(*goal.notes, *_warnings(scene, goal, volume)),
    )


def _capacity(scene: Scene, volume: Array) -> Verdict:
    """How full the fullest chamber is."""
    share = max(v / fill.chamber.capacity for v, fill in zip(volume.tolist(), scene.fills, strict=True))
    return Verdict(1.0, share, share <= 1.0 + 1e-12, "1", "share of the chamber that is fullest")


def _warnings(scene: Scene, goal: Goal, volume: Array) -> tuple[str, ...]:
    """What the models do not hold for."""
    deepest = RANGES["long_wave"]["relative_depth"][1]
    if not isinstance(goal.judge.vibration, RunupPeak):
        return ()
    return tuple(
        f"Out of range: the layer in chamber {k + 1} is deeper than {deepest:g} of its radius."
        for k, fill in enumerate(with_volumes(scene, volume).fills)
        if fill.depth > deepest * fill.chamber.radius and not is_full(fill)
    )


def _closed_forms(scene: Scene, volume: Array, speed: float) -> tuple[Covering, ...]:
    """The covering volumes at the deflection that the answer has at the working speed."""
    from leblanc.studies.run import run_scene

    record = run_scene(with_volumes(scene, volume).altered(speeds=Speeds.at(speed)))
    gravity = axial_gravity(scene)
    if record.motion is None:
        moved = np.full(volume.size, abs(record.response.deflection[0]))
    else:
        moved = np.abs(record.motion.chamber_forward[0])
    found = []
    for fill, deflection in zip(scene.fills, moved.tolist(), strict=True):
        if not math.isfinite(deflection):
            return ()
        found.append(covering(fill.chamber, deflection, speed, gravity))
    return tuple(found)


def _at_given_deflection(scene: Scene, aim: Optimisation, deflection: float) -> OptimumRecord:
    """The least volumes that leave no wall dry over its whole height at a given deflection."""
    speed = scene.speeds.stop if aim.working_speed is None else aim.working_speed
    volumes, forms, count, notes = cover_walls(scene, deflection, speed)
    filled = with_volumes(scene, np.array(volumes)).fills
    value = sum(liquid_unbalance(fill, deflection, speed, axial_gravity(scene)) for fill in filled)
    mass = sum(fill.mass for fill in filled)
    verdicts = {
        "capacity": _capacity(scene, np.array(volumes)),
        "dry_patch": dry_verdict(scene, volumes, deflection, speed),
    }
    return OptimumRecord(
        scene=scene,
        aim=aim,
        objective="working_speed",
        meaning=f"liquid's unbalance at the deflection given, at {speed * RPM:.4g} rpm",
        unit="kg m",
        working_speed=speed,
        volume=np.array(volumes),
        value=value,
        baseline=0.0,
        vibration=deflection,
        vibration_baseline=deflection,
        feasible=all(one.satisfied for one in verdicts.values()),
        constraints=verdicts,
        mass=mass,
        growth=float(growth(scene, np.array([volumes]), growth_speeds(scene, aim))[0]),
        covering=forms,
        evaluations=count,
        points=np.array([volumes]),
        judged=one_point(volumes, value, mass),
        front=None,
        sweep=None,
        notes=notes,
    )
