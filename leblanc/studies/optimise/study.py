"""The best volumes of a scene's chambers for an objective the user names [theory: optimum].

Beside them stand the analytical checks and the front: a sweep from no liquid to the fullest, and what
the search met by the way.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fluid.whirl import is_full
from leblanc.core.answer import Answer
from leblanc.core.interrupts import stopping
from leblanc.core.notes import Note
from leblanc.core.progress import update
from leblanc.core.units import in_rpm
from leblanc.liquid.choose import axial_gravity
from leblanc.liquid.models import SYNCHRONOUS_MODELS
from leblanc.liquid.notes import compartment_notes, slowed_by
from leblanc.liquid.validity import doubts
from leblanc.scene.scene import Scene, Speeds, require_clear, require_no_balls, require_whirl
from leblanc.scene.tasks import OBJECTIVES, Optimisation
from leblanc.studies.optimise import notes as notes_of
from leblanc.studies.optimise.answer import (
    CandidateChamber,
    Candidates,
    ConstraintValue,
    EmulatedAnswer,
    OptimumAnswer,
    ParetoFront,
    Poured,
    WettingVolumes,
    about,
)
from leblanc.studies.optimise.constraints import freeing_volumes, growth, require_known_walls, require_loads
from leblanc.studies.optimise.filled import FilledMachine, QualityAtSpeed, model_name, with_volumes
from leblanc.studies.optimise.problem import (
    Problem,
    growth_speeds,
    problem_of,
    unbalances,
    working_speed,
)
from leblanc.studies.optimise.robust import Robust, condition_table
from leblanc.studies.optimise.search import (
    best_volumes,
    bounds_of,
    evaluated_again,
    on_all_cells,
    plan_of,
)
from leblanc.studies.optimise.wetting import optimal_volume_by_search, wetting_volumes
from leblanc.studies.processes import processes
from leblanc.studies.run.study import run_scene
from leblanc.studies.sweep.emulator import Emulator, emulate_store, varied_fields
from leblanc.studies.sweep.store import read_store
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.liquid_model import LONG
from solvers.search import Budget, Enough, Found, Judgement, SearchPlan
from solvers.statics.hydrostatics import equilibrium
from solvers.whirl.elimination import eliminated

_ASKED = "the scene asks for it; "


_VOLUME = re.compile(r"chambers\.(\d+)\.volume")


def answer(
    scene: Scene,
    objective: str | None,
    deflection: float | None,
    limit: float | None,
    steady: bool,
    seed: int | None,
    emulator: Path | None,
    workers: int,
    front: bool,
    max_evaluations: int | None,
    timeout: float | None,
) -> Answer:
    """Best volumes, balls where the scene has them, or layout of mounts, for its task with what is given."""
    if objective is not None and objective not in OBJECTIVES:
        raise InputError("objective", objective, "one of " + ", ".join(OBJECTIVES))
    for name, length in (("deflection", deflection), ("limit", limit)):
        if length is not None and not 1e-12 <= length <= 1e3:
            raise InputError(name, length, "from 1e-12 to 1000 m")
    if seed is not None and seed < 0:
        raise InputError("seed", seed, "a whole number, 0 or above")
    if max_evaluations is not None and max_evaluations < 1:
        raise InputError("max_evaluations", max_evaluations, "a whole number, 1 or above")
    if timeout is not None and not 0.0 < timeout < 1e9:
        raise InputError("timeout", timeout, "above 0 s")
    budget = Budget(max_evaluations, timeout)
    given = {"objective": objective, "deflection": deflection, "vibration_limit": limit, "seed": seed}
    task = scene.optimise or Optimisation()
    task = task.altered(**{name: value for name, value in given.items() if value is not None})
    task = task.altered(steady=task.steady or steady)
    if task.objective == "layout":
        from leblanc.studies.optimise.layout.study import optimise_layout

        for name, most in (("max_evaluations", max_evaluations), ("timeout", timeout)):
            if most is not None:
                raise InputError(name, most, "left out for a layout, which takes some seconds")
        return optimise_layout(scene, task)
    if scene.balls:
        from leblanc.studies.optimise.balls.study import optimise_balls

        if emulator is not None:
            raise InputError("emulator", str(emulator), "left out with balls, whose designs it does not know")
        return optimise_balls(scene, task, workers, budget)
    surrogate = None if emulator is None else emulated_vibration(emulator, scene, task)
    with whirl_pool(scene, workers) as pool:
        return optimise_scene(
            scene, task=task, front=front, emulator=surrogate, budget=budget, workers=workers, pool=pool
        )


@contextmanager
def whirl_pool(scene: Scene, workers: int) -> Iterator[ProcessPoolExecutor | None]:
    """Processes that work out whirls of sets of volumes, where finite elements make each costly."""
    if workers < 1:
        raise InputError("workers", workers, "1 or more")
    if workers == 1 or not slowed_by(scene.fills):
        yield None
        return
    # What the workers run is compiled before they start.
    eliminated(np.eye(2, dtype=complex)[None])
    with processes(workers) as pool:
        yield pool


def optimise_scene(
    scene: Scene,
    objective: str | None = None,
    task: Optimisation | None = None,
    front: bool = True,
    emulator: EmulatedVibration | None = None,
    response: bool = True,
    budget: Budget | None = None,
    workers: int = 1,
    pool: ProcessPoolExecutor | None = None,
) -> OptimumAnswer:
    """Best volume for each chamber of a scene; its own volumes do not matter.

    Not feasible where no volumes meet the constraints: those that exceed them least are given then; the best
    so far where the search is interrupted or has spent its budget. The emulator is asked by the search in
    place of the solvers, which then evaluate the best that it found. Threads of `workers` make run-ups, a
    pool works out whirls.
    """
    task = task or scene.optimise or Optimisation()
    task = task if objective is None else task.altered(objective=objective)
    require_whirl(scene, known=True)
    require_no_balls(scene, "a search over volumes alone; optimise_balls answers this one")
    if task.balls is not None:
        raise InputError("optimise.balls", "given", "left out where no chamber is of kind balls")
    if not scene.fills:
        raise InputError("chambers", "none", "at least one to choose the volume of")
    require_clear(scene, "a search over volumes, which rests on the equilibrium in a ring", baffles=True)
    low, high = bounds_of(scene, task)
    require_known_walls(scene, task, low, high)
    machine = FilledMachine(scene)
    require_loads(scene, task)
    if task.deflection is not None:
        result = _at_deflection(scene, task, task.deflection)
        return _with_response(result, scene, machine) if response else result

    stopped: list[Found] = []
    budget = budget or Budget()

    def solve(problem: Problem) -> Found:
        found = best_volumes(scene, problem, low, high, budget=budget)
        stopped.extend([found] if found.interrupted or found.stopped else [])
        return found

    problem = problem_of(scene, task, machine, solve, workers, pool)
    exact, quick = on_all_cells(scene, problem), problem
    if emulator is not None:
        low, high = emulator.inside(low, high, np.array([fill.volume for fill in scene.fills]))
        quick = replace(problem, vibration=emulator, estimated=True, costly=False)
    part = _SEARCH if front else 1.0
    chosen = stopped[0] if stopped else best_volumes(scene, quick, low, high, part, budget)
    if quick is not exact or stopped:
        chosen = evaluated_again(exact, chosen)
    result = _result(scene, task, exact, machine, chosen)
    if emulator is not None:
        said = emulator.answer(chosen.point)
        result = replace(result, emulator=said, notes=(notes_of.emulated(said), *result.notes))
    speeds = growth_speeds(scene, task)
    if front and not result.interrupted and not result.stopped:
        try:
            with stopping():
                edge, sweep = front_around(scene, problem, chosen, result.vibration, speeds, budget, pool)
            result = replace(result, front=edge, sweep=sweep)
        except (KeyboardInterrupt, Enough) as why:
            note = notes_of.interrupted(result.evaluations, searched=True, limit=str(why))
            by_signal = isinstance(why, KeyboardInterrupt)
            notes = note, *result.notes
            result = replace(result, interrupted=by_signal, stopped=str(why), notes=notes)
    if isinstance(robust := exact.vibration, Robust):
        around = unbalances(scene, task)
        table = condition_table(
            *(scene, task, robust, result.volume, around),
            lambda warm, held: float(growth(warm, held[None], speeds)[0]),
        )
        result = replace(result, robust=table)
    return _with_response(result, scene, machine) if response else result


def _result(
    scene: Scene, task: Optimisation, problem: Problem, machine: FilledMachine, found: Found
) -> OptimumAnswer:
    """The best volumes with all that belongs to them."""
    volume = found.point
    nothing = np.zeros((1, volume.size))
    vibration, dry = (float(problem.vibration.exact(row)[0]) for row in (volume[None], nothing))
    value, bare = vibration, dry
    if problem.sized is not None:
        value, bare = (float(problem.sized.exact(row)[0]) for row in (volume[None], nothing))
    constraints = {
        "capacity": _capacity(scene, volume),
        **{
            constraint.name: constraint.at(float(constraint.value(volume[None])[0]))
            for constraint in problem.constraints
        },
    }
    mass = float(volume @ problem.density)
    said = found.judged
    forms = _closed_forms(machine, volume, problem.working_speed)
    _, high = bounds_of(scene, task)
    poured = poured_volumes(problem, volume, value, high) if volume.any() else None
    return _of_scene(
        scene,
        task,
        in_time=problem.runs is not None,
        objective=task.objective,
        meaning=problem.meaning,
        unit=problem.unit,
        working_speed=problem.working_speed,
        volume=volume,
        value=mass if problem.by_mass else value,
        baseline=0.0 if problem.by_mass else bare,
        vibration=vibration,
        vibration_baseline=dry,
        constraints=constraints,
        mass=mass,
        growth=float(growth(scene, volume[None], growth_speeds(scene, task))[0]),
        **_quality(machine, volume, problem.working_speed),
        closed_form=forms,
        poured=poured,
        with_margin=None if poured is None else _with_margin(problem, poured, forms, high),
        equal_within=plan_of(problem).margin,
        evaluations=int(np.unique(found.points, axis=0).shape[0]),
        candidates=Candidates(
            volume=found.points,
            objective=said.objective,
            excess=said.excess,
            vibration=said.details["vibration"],
            mass=said.details["mass"],
            exact=said.details["sure"] == 1.0,
            exceeded=_exceeded(problem, said),
        ),
        notes=(*_findings(problem, found), *problem.notes, *_limits(scene, problem, volume), *doubts(scene)),
        interrupted=found.interrupted,
        stopped=found.stopped,
    )


_MARGIN = 1.2  # of the volume that wets a wall: what spills, evaporates and is poured less
_NEXT = 1.05  # of that volume, up to which a little less leaves the wall dry in part
_LOST = 0.005  # of the objective, that rounded volumes may lose


def poured_volumes(problem: Problem, volume: Array, value: float, high: Array) -> Poured | None:
    """Volumes with as few digits as lose next to nothing; None where four lose more.

    Parameters
    ----------
    volume, high : best volumes and the most that are allowed, m^3, shape (c,)
    value : of the objective with the former
    """
    best = problem.evaluate(volume[None])
    for digits in (2, 3, 4):
        rows = np.unique([_rounded(volume, digits, up, high) for up in (False, True)], axis=0)
        found = problem.evaluate(rows)
        objective = rows @ problem.density if problem.by_mass else found.objective
        # As good as the best in what it must keep to, and nearly so in what is made small.
        kept = found.excess <= max(float(best.excess[0]), 0.0)
        near = problem.by_mass | (objective <= value + _LOST * abs(value))
        fit = np.flatnonzero(kept & near)
        if fit.size:
            k = int(fit[np.lexsort((rows[fit] @ problem.density, objective[fit]))[0]])
            return Poured(rows[k], float(objective[k]), bool(found.excess[k] <= 0.0))
    return None


def _rounded(volume: Array, digits: int, up: bool, high: Array) -> Array:
    """Volumes to some digits, to the nearest or up, none above the most."""
    nothing = volume <= 0.0
    size = np.where(nothing, 1.0, volume)
    step = 10.0 ** (np.floor(np.log10(size)) + 1 - digits)
    # What rounding of the computation adds is no next step.
    count = np.ceil(size / step - 1e-9) if up else np.round(size / step)
    return np.where(nothing, 0.0, np.minimum(np.round(count * step, 15), high))


def _with_margin(
    problem: Problem, poured: Poured, forms: tuple[WettingVolumes, ...], high: Array
) -> Poured | None:
    """A fifth more than what just wets a wall; None where more than that is poured anyway."""
    wetting = np.array([form.optimal_volume for form in forms])
    if not forms or not np.any((poured.volume > 0.0) & (poured.volume <= _NEXT * wetting)):
        return None
    more = _rounded(
        np.where(poured.volume > 0.0, np.maximum(poured.volume, _MARGIN * wetting), 0.0), 2, True, high
    )
    if np.array_equal(more, poured.volume):
        return None
    found = problem.evaluate(more[None])
    value = float(more @ problem.density) if problem.by_mass else float(found.objective[0])
    return Poured(more, value, bool(found.excess[0] <= 0.0))


def _exceeded(problem: Problem, said: Judgement) -> tuple[str, ...]:
    """Name of the constraint that each set of volumes exceeds most, empty where it keeps to all."""
    if not problem.constraints:
        return ("",) * said.excess.size
    worst = np.argmax([own.excess(said.details[own.name]) for own in problem.constraints], axis=0)
    pairs = zip(worst.tolist(), said.excess.tolist(), strict=True)
    return tuple(problem.constraints[k].name if excess > 0.0 else "" for k, excess in pairs)


def _findings(problem: Problem, found: Found) -> Iterator[Note]:
    """What must be known of the answer: it was interrupted, or it is no liquid."""
    said = found.judged
    if found.interrupted or found.stopped:
        yield notes_of.interrupted(found.points.shape[0], limit=found.stopped)
    if found.point.max() > 0.0 or not found.feasible:
        return
    better = said.details["vibration"] < found.objective * (1.0 - plan_of(problem).margin)
    forbidden = [
        own.name
        for own in problem.constraints
        if np.any(own.excess(said.details[own.name])[better & (said.excess > 0.0)] > 0.0)
    ]
    yield notes_of.no_liquid(problem.by_mass, tuple(forbidden))


def _at_deflection(scene: Scene, task: Optimisation, deflection: float) -> OptimumAnswer:
    """The least volumes that leave no wall dry over its whole height at a given deflection, m."""
    speed, gravity, single = working_speed(scene, task), axial_gravity(scene), np.ones(1)
    found = [optimal_volume_by_search(fill, deflection, speed, gravity) for fill in scene.fills]
    volume = np.array([best.point[0] for best in found])
    forms = tuple(wetting_volumes(fill.chamber, deflection, speed, gravity) for fill in scene.fills)
    gap = max(
        abs(own / form.optimal_volume - 1.0) if form.optimal_volume > 0.0 else abs(own)
        for own, form in zip(volume.tolist(), forms, strict=True)
    )
    unbalance, mass, dry = 0.0, 0.0, 0.0
    for fill in with_volumes(scene, volume).fills:
        state = equilibrium(fill.chamber, fill.volume, deflection, speed, gravity)
        unbalance += fill.liquid.density * float(state.unbalance()[0])
        mass += fill.mass
        # A little above the volume that just wets it.
        above = min(fill.volume * (1.0 + 1e-9), fill.chamber.capacity)
        dry = max(dry, float(equilibrium(fill.chamber, above, deflection, speed, gravity).dry_patch))
    meaning = "wall dry somewhere at the deflection given (1) or nowhere (0)"
    return _of_scene(
        scene,
        task,
        in_time=False,
        objective="working_speed",
        meaning=f"liquid's unbalance at the deflection given, at {in_rpm(speed)}",
        unit="kg m",
        working_speed=speed,
        volume=volume,
        value=unbalance,
        baseline=0.0,
        vibration=deflection,
        vibration_baseline=deflection,
        constraints={
            "capacity": _capacity(scene, volume),
            "dry_patch": ConstraintValue(0.0, dry, dry == 0.0, "1", meaning),
        },
        mass=mass,
        growth=float(growth(scene, volume[None], growth_speeds(scene, task))[0]),
        closed_form=forms,
        equal_within=SearchPlan().margin,
        evaluations=sum(best.points.shape[0] for best in found),
        candidates=Candidates(
            volume=volume[None],
            objective=unbalance * single,
            excess=-single,
            vibration=unbalance * single,
            mass=mass * single,
            exact=single > 0.0,
        ),
        notes=(notes_of.given_deflection(deflection, speed, gap, forms), *doubts(scene)),
    )


def _of_scene(scene: Scene, task: Optimisation, in_time: bool, **found: object) -> OptimumAnswer:
    """An answer with what it says of its scene."""
    return OptimumAnswer(
        **about(scene, task),
        unused=() if in_time else ("runup",),
        chambers=tuple(CandidateChamber(fill.chamber.capacity, fill.liquid.name) for fill in scene.fills),
        friction=scene.model.friction,
        tolerance=scene.model.tolerance,
        in_time=in_time,
        **found,  # type: ignore[arg-type]
    )


def _with_response(result: OptimumAnswer, scene: Scene, machine: FilledMachine) -> OptimumAnswer:
    """The machine with the best volumes over the scene's speeds, by the model of the search."""
    if machine.scene.model.liquid not in SYNCHRONOUS_MODELS:
        return result
    filled = with_volumes(machine.scene, result.volume)
    filled = filled.altered(model=filled.model.altered(liquid=model_name(filled)))
    response = run_scene(filled)
    if scene.model.liquid == "auto":
        # The scene leaves the model to the search, which names one.
        spans = (replace(span, reason=span.reason.removeprefix(_ASKED)) for span in response.models)
        response = replace(response, models=tuple(spans))
    return replace(result, response=response)


def _capacity(scene: Scene, volume: Array) -> ConstraintValue:
    """How full the fullest chamber is."""
    share = max(v / fill.chamber.capacity for v, fill in zip(volume.tolist(), scene.fills, strict=True))
    meaning = "share of the chamber that is fullest"
    return ConstraintValue(1.0, share, share <= 1.0 + 1e-12, "1", meaning)


def _limits(scene: Scene, problem: Problem, volume: Array) -> tuple[Note, ...]:
    """What the models do not hold for."""
    deepest = LONG[1]
    parted = tuple(
        notes_of.parted(k, fill.chamber.baffles.count, freed)
        for k, (fill, freed) in enumerate(zip(scene.fills, freeing_volumes(scene), strict=True))
        if fill.chamber.baffles is not None and freed > 0.0
    )
    fills = with_volumes(scene, volume).fills
    parted += tuple(compartment_notes(fills))
    if problem.runs is None:
        return parted
    return parted + tuple(
        notes_of.too_deep(k, deepest)
        for k, fill in enumerate(fills)
        if fill.depth > deepest * fill.chamber.radius and not is_full(fill)
    )


def _closed_forms(machine: FilledMachine, volume: Array, speed: float) -> tuple[WettingVolumes, ...]:
    """The volumes that wet the walls at the deflection that the answer has at the working speed.

    None where baffles would cut so little liquid into compartments, in which it does not gather on one side.
    """
    scene = machine.scene
    if freeing_volumes(scene).any():
        return ()
    if machine.planar and scene.model.liquid in SYNCHRONOUS_MODELS:
        moved = np.repeat(machine.at(volume[None], np.array([speed])).amplitude, volume.size)
    else:
        answer = run_scene(with_volumes(scene, volume).altered(speeds=Speeds.at(speed)))
        moved = np.full(volume.size, abs(answer.response.deflection[0]))
        if answer.motion is not None:
            moved = np.abs(answer.motion.chamber_forward[0])
    if not np.isfinite(moved).all():
        return ()
    gravity = axial_gravity(scene)
    return tuple(
        wetting_volumes(fill.chamber, deflection, speed, gravity)
        for fill, deflection in zip(scene.fills, moved.tolist(), strict=True)
    )


def _quality(machine: FilledMachine, volume: Array, speed: float) -> dict[str, float]:
    """Balance quality with the best volumes and without liquid; nothing where no steady model answers."""
    if machine.scene.model.liquid not in SYNCHRONOUS_MODELS:
        return {}
    quality = QualityAtSpeed(machine, speed)
    both = {"balance_quality": float(quality.of(volume[None])[0]), "balance_quality_dry": quality.dry()}
    return {} if any(map(math.isnan, both.values())) else both


def not_dominated(values: Array) -> Flags:
    """Points that no other beats: none is as good in every value and better in one.

    Of points that are equal in everything the first alone.
    """
    kept: Flags = np.asarray(np.isfinite(values).all(axis=1))
    order = np.lexsort(values.T[::-1])
    # In this order no point is beaten by a later one.
    for place, k in enumerate(order.tolist()):
        if kept[k]:
            later = order[place + 1 :]
            kept[later] &= ~np.all(values[later] >= values[k], axis=1)
    return kept


_SEARCH = 0.7  # share of the work that a search is where the front follows, as it comes on average
_AT_ONCE = 8  # volumes of the front at once, where an answer costs much
_SWEEP, _SPARING = 40, 12  # volumes of the dedicated sweep; where an answer costs much
_MOST_IN_FRONT, _FEW_IN_FRONT = 60, 12  # of the points evaluated by the way; where whirls cost much


def front_around(
    scene: Scene,
    problem: Problem,
    found: Found,
    vibration: float,
    speeds: Array,
    budget: Budget,
    pool: ProcessPoolExecutor | None = None,
) -> tuple[ParetoFront, ParetoFront]:
    """The trade-off (Pareto front) by rising mass, and the sweep from no liquid to the fullest chamber."""
    known = found.judged.details
    count = _SPARING if problem.costly else _SWEEP
    high = np.array([fill.chamber.capacity for fill in scene.fills])
    share = np.concatenate(([0.0], np.geomspace(1e-3, 1.0, count)))
    along = found.point if found.point.max() > 0.0 else high
    room = float(np.min(high[along > 0.0] / along[along > 0.0]))
    rows = [np.minimum(share[:, None] * room * along, high), found.point[None]]
    swept = np.unique(np.concatenate(rows), axis=0)
    exact = np.flatnonzero((known["sure"] == 1.0) & np.isfinite(known["vibration"]))
    most = _FEW_IN_FRONT if slowed_by(scene.fills) else _MOST_IN_FRONT
    by_the_way = exact[_thin(known["vibration"][exact], known["mass"][exact], most)]
    volume = np.concatenate((swept, found.points[by_the_way]))
    total, done, slow = swept.shape[0] + volume.shape[0], 0, slowed_by(scene.fills)

    def each(value: Callable[[Array], Array], rows: Array) -> Array:
        nonlocal done
        values, few = [], _AT_ONCE if problem.costly else rows.shape[0]
        for first in range(0, rows.shape[0], few):
            budget.look()
            values.append(value(rows[first : first + few]))
            done += values[-1].size
            update(_SEARCH + (1.0 - _SEARCH) * done / total, 1.0, f"trade-off{slow}")
        return np.concatenate(values)

    size = np.concatenate((each(problem.vibration.exact, swept), known["vibration"][by_the_way]))
    size[np.all(volume == found.point, axis=1)] = vibration
    margin = -each(lambda rows: growth(scene, rows, speeds, pool), volume)
    mass = volume @ problem.density
    part = slice(0, swept.shape[0])
    kept = np.flatnonzero(not_dominated(np.stack((size, mass, -margin), axis=1)))
    kept = kept[np.lexsort((size[kept], mass[kept]))]
    edge, whole = (ParetoFront(volume[k], size[k], mass[k], margin[k]) for k in (kept, part))
    return edge, whole


def _thin(vibration: Array, mass: Array, most: int) -> NDArray[np.intp]:
    """Of the points that are not beaten in vibration and mass a few, evenly chosen."""
    kept = np.flatnonzero(not_dominated(np.stack((vibration, mass), axis=1)))
    kept = kept[np.argsort(mass[kept], kind="stable")]
    return kept[np.unique(np.linspace(0, max(kept.size - 1, 0), most).astype(int))] if kept.size else kept


class EmulatedVibration:
    """Vibration of a machine by an emulator over the volumes of some of its chambers."""

    def __init__(self, emulator: Emulator, chambers: tuple[int, ...]) -> None:
        self.emulator, self.chambers = emulator, chambers

    def exact(self, volumes: Array) -> Array:
        """Vibration with m sets of volumes, m, as exact as the emulator is."""
        return self.emulator.output(volumes[:, self.chambers])

    def answer(self, volume: Array) -> EmulatedAnswer:
        """What it says of one set of volumes, shape (c,)."""
        value, deviation = self.emulator.predict(volume[None, self.chambers])
        return EmulatedAnswer(float(value[0]), float(deviation[0]), self.emulator.error)

    def inside(self, low: Array, high: Array, own: Array) -> tuple[Array, Array]:
        """Bounds of the volumes cut to what the emulator knows; other chambers keep their own volume."""
        least, most = own.copy(), own.copy()
        for k, chamber in enumerate(self.chambers):
            least[chamber] = max(low[chamber], self.emulator.low[k])
            most[chamber] = min(high[chamber], self.emulator.high[k])
            if not least[chamber] <= most[chamber]:
                span = f"{self.emulator.low[k]:g} to {self.emulator.high[k]:g} m^3"
                allowed = f"such that they meet the samples of the sweep, {span}"
                raise InputError(f"optimise.volumes.{chamber}", (low[chamber], high[chamber]), allowed)
        return least, most


def emulated_vibration(store: Path, scene: Scene, task: Optimisation) -> EmulatedVibration:
    """Emulator of the vibration that an optimisation is after, from a sweep over the volumes."""
    found = read_store(store)
    said = found.attributes()
    if said["scene_digest"] != scene.digest:
        raise InputError("emulator", str(store), "the store of a sweep of this very scene")
    matches = [_VOLUME.fullmatch(name) for name in varied_fields(found)]
    chambers = tuple(int(match[1]) for match in matches if match is not None)
    if len(chambers) != len(matches):
        raise InputError("emulator", str(store), "a sweep that varies volumes and nothing else")
    return EmulatedVibration(emulate_store(found, _output(scene, task, said.get("command", "run"))), chambers)


def _output(scene: Scene, task: Optimisation, command: str) -> str:
    """Output of a sweep by a command that is the vibration of the objective."""
    in_time = task.objective == "peak" and not task.steady and scene.speed_plan is not None
    if in_time != (command == "runup"):
        allowed = f'the store of a sweep with command = "{"runup" if in_time else "run"}" for this objective'
        raise InputError("emulator", f'one with command = "{command}"', allowed)
    if in_time:
        return "peak_amplitude"
    if task.objective == "working_speed" and task.working_speed in (None, scene.speeds.stop):
        return "last_amplitude"
    if task.objective == "peak":
        return "peak_amplitude"
    allowed = "working_speed at the last speed, or peak, with an emulator"
    raise InputError("objective", task.objective, allowed)
