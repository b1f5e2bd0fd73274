"""The best volumes of a scene's chambers for an objective the user names [theory: optimum].

Beside them stand the closed forms and the front: a sweep from no liquid to the fullest, and what the search
met by the way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fluid.whirl import is_full
from leblanc.core.notes import Note
from leblanc.core.units import in_rpm
from leblanc.results import optimum
from leblanc.results.base import ConstraintValue
from leblanc.results.choice import ModelSpan
from leblanc.results.notes.baffles import compartment_notes
from leblanc.results.optimum import (
    CandidateChamber,
    Candidates,
    Feasibility,
    OptimumResult,
    ParetoFront,
    WettingVolumes,
)
from leblanc.scene.scene import Scene, Speeds, require_clear, require_no_balls, require_whirl
from leblanc.scene.tasks import Optimisation
from leblanc.studies.models.choose import axial_gravity
from leblanc.studies.models.liquid import SYNCHRONOUS_MODELS
from leblanc.studies.models.validity import doubts
from leblanc.studies.optimise.answers import FilledMachine, model_name, with_volumes
from leblanc.studies.optimise.balance import QualityAtSpeed
from leblanc.studies.optimise.constraints import growth
from leblanc.studies.optimise.emulated import EmulatedVibration
from leblanc.studies.optimise.loads import require_loads
from leblanc.studies.optimise.problem import (
    Evaluator,
    Problem,
    growth_speeds,
    problem_of,
    unbalances,
    working_speed,
)
from leblanc.studies.optimise.robust import Robust, condition_table
from leblanc.studies.optimise.search import (
    Progress,
    best_volumes,
    bounds_of,
    evaluated_again,
    on_all_cells,
    plan_of,
)
from leblanc.studies.optimise.walls import freeing_volumes, require_known_walls
from leblanc.studies.optimise.wetting import WettedWalls, wet_walls, wetting_volumes
from leblanc.studies.run.study import run_scene
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.liquid_model import LONG
from solvers.search import Found, Judgement, SearchPlan

_ASKED = "the scene asks for it; "


def optimise_scene(
    scene: Scene,
    objective: str | None = None,
    task: Optimisation | None = None,
    front: bool = True,
    progress: Progress | None = None,
    emulator: EmulatedVibration | None = None,
    response: bool = True,
) -> OptimumResult:
    """Best volume for each chamber of a scene; its own volumes do not matter.

    Not feasible where no volumes meet the constraints: those that exceed them least are given then; the best
    so far where the search is interrupted. The emulator is asked by the search in place of the solvers, which
    then evaluate the best that it found.
    """
    task = task or scene.optimise or Optimisation()
    task = task if objective is None else task.altered(objective=objective)
    if task.objective == "layout":
        raise InputError("--objective", "layout", "one of the liquid here; optimise_layout answers this one")
    require_whirl(scene)
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
        result = _at_deflection(scene, task, wet_walls(scene, task.deflection, working_speed(scene, task)))
        return _with_response(result, scene, machine) if response else result

    stopped: list[Found] = []

    def solve(problem: Problem) -> Found:
        found = best_volumes(scene, problem, low, high, progress)
        stopped.extend([found] if found.interrupted else [])
        return found

    problem = problem_of(scene, task, machine, solve)
    exact, quick = on_all_cells(scene, problem), problem
    if emulator is not None:
        low, high = emulator.inside(low, high, np.array([fill.volume for fill in scene.fills]))
        quick = replace(
            problem, evaluate=replace(problem.evaluate, vibration=emulator, estimated=True), costly=False
        )
    told = _first_part(progress) if front else progress
    chosen = stopped[0] if stopped else best_volumes(scene, quick, low, high, told)
    if quick is not exact or stopped:
        chosen = evaluated_again(exact, chosen)
    result = _result(scene, task, exact, machine, chosen)
    if emulator is not None:
        answer = emulator.answer(chosen.point)
        result = replace(result, emulator=answer, notes=(optimum.emulated(answer), *result.notes))
    if front and not result.interrupted:
        result = _with_front(result, scene, problem, chosen, growth_speeds(scene, task), progress)
    if isinstance(exact.evaluate.vibration, Robust):
        speeds, around = growth_speeds(scene, task), unbalances(scene, task)
        table = condition_table(
            scene,
            task,
            exact.evaluate.vibration,
            result.volume,
            around,
            lambda warm, held: float(growth(warm, held[None], speeds)[0]),
        )
        result = replace(result, robust=table)
    return _with_response(result, scene, machine) if response else result


def _with_front(
    result: OptimumResult,
    scene: Scene,
    problem: Problem,
    found: Found,
    speeds: Array,
    progress: Progress | None,
) -> OptimumResult:
    """The best volumes with the front around them; without it where it is interrupted from the keyboard."""
    try:
        edge, sweep = front_around(scene, problem, found, result.vibration, speeds, progress)
    except KeyboardInterrupt:
        note = optimum.interrupted(result.evaluations, searched=True)
        return replace(result, interrupted=True, notes=(note, *result.notes))
    return replace(result, front=edge, sweep=sweep)


def _result(
    scene: Scene, task: Optimisation, problem: Problem, machine: FilledMachine, found: Found
) -> OptimumResult:
    """The best volumes with all that belongs to them."""
    evaluate, volume = problem.evaluate, found.point
    nothing = np.zeros((1, volume.size))
    vibration, dry = (float(evaluate.vibration.exact(row)[0]) for row in (volume[None], nothing))
    value, bare = vibration, dry
    if evaluate.sized is not None:
        value, bare = (float(evaluate.sized.exact(row)[0]) for row in (volume[None], nothing))
    constraints = {
        "capacity": _capacity(scene, volume),
        **{
            constraint.name: constraint.at(float(constraint.value(volume[None])[0]))
            for constraint in evaluate.constraints
        },
    }
    mass = float(volume @ evaluate.density)
    said = found.judged
    return _of_scene(
        scene,
        in_time=evaluate.runs is not None,
        objective=task.objective,
        meaning=problem.meaning,
        unit=evaluate.unit,
        working_speed=problem.working_speed,
        volume=volume,
        value=mass if evaluate.by_mass else value,
        baseline=0.0 if evaluate.by_mass else bare,
        vibration=vibration,
        vibration_baseline=dry,
        constraints=constraints,
        mass=mass,
        growth=float(growth(scene, volume[None], growth_speeds(scene, task))[0]),
        **_quality(machine, volume, problem.working_speed),
        closed_form=_closed_forms(machine, volume, problem.working_speed),
        equal_within=plan_of(problem).margin,
        evaluations=int(np.unique(found.points, axis=0).shape[0]),
        candidates=Candidates(
            volume=found.points,
            objective=said.objective,
            excess=said.excess,
            vibration=said.details["vibration"],
            mass=said.details["mass"],
            exact=said.details["sure"] == 1.0,
            exceeded=_exceeded(evaluate, said),
        ),
        notes=(*_findings(problem, found), *problem.notes, *_limits(scene, problem, volume), *doubts(scene)),
        interrupted=found.interrupted,
    )


def _exceeded(evaluate: Evaluator, said: Judgement) -> tuple[str, ...]:
    """Name of the constraint that each set of volumes exceeds most, empty where it keeps to all."""
    if not evaluate.constraints:
        return ("",) * said.excess.size
    worst = np.argmax([own.excess(said.details[own.name]) for own in evaluate.constraints], axis=0)
    pairs = zip(worst.tolist(), said.excess.tolist(), strict=True)
    return tuple(evaluate.constraints[k].name if excess > 0.0 else "" for k, excess in pairs)


def _findings(problem: Problem, found: Found) -> tuple[Note, ...]:
    """What must be known of the answer: it was interrupted, or it is no liquid."""
    evaluate, said = problem.evaluate, found.judged
    notes = [optimum.interrupted(found.points.shape[0])] if found.interrupted else []
    if found.point.max() > 0.0 or not found.feasible:
        return tuple(notes)
    better = said.details["vibration"] < found.objective * (1.0 - plan_of(problem).margin)
    forbidden = [
        own.name
        for own in evaluate.constraints
        if np.any(own.excess(said.details[own.name])[better & (said.excess > 0.0)] > 0.0)
    ]
    notes.append(optimum.no_liquid(evaluate.by_mass, tuple(forbidden)))
    return tuple(notes)


def _at_deflection(scene: Scene, task: Optimisation, found: WettedWalls) -> OptimumResult:
    """The least volumes that leave no wall dry over its whole height at a given deflection."""
    volume = np.array(found.volumes)
    single = np.ones(1)
    return _of_scene(
        scene,
        in_time=False,
        objective="working_speed",
        meaning=f"liquid's unbalance at the deflection given, at {in_rpm(found.speed)}",
        unit="kg m",
        working_speed=found.speed,
        volume=volume,
        value=found.unbalance,
        baseline=0.0,
        vibration=found.deflection,
        vibration_baseline=found.deflection,
        constraints={"capacity": _capacity(scene, volume), "dry_patch": found.dry_wall},
        mass=found.mass,
        growth=float(growth(scene, volume[None], growth_speeds(scene, task))[0]),
        closed_form=found.closed_form,
        equal_within=SearchPlan().margin,
        evaluations=found.evaluations,
        candidates=Candidates(
            volume=volume[None],
            objective=found.unbalance * single,
            excess=-single,
            vibration=found.unbalance * single,
            mass=found.mass * single,
            exact=single > 0.0,
        ),
        notes=(*found.notes, *doubts(scene)),
    )


def _of_scene(scene: Scene, constraints: dict[str, ConstraintValue], **found: object) -> OptimumResult:
    """A result with what it says of its scene."""
    kept = all(constraint.satisfied for constraint in constraints.values())
    return OptimumResult(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        chambers=tuple(CandidateChamber(fill.chamber.capacity, fill.liquid.name) for fill in scene.fills),
        friction=scene.model.friction,
        tolerance=scene.model.tolerance,
        feasibility=Feasibility.FEASIBLE if kept else Feasibility.INFEASIBLE,
        constraints=constraints,
        front=None,
        sweep=None,
        **found,  # type: ignore[arg-type]
    )


def _with_response(result: OptimumResult, scene: Scene, machine: FilledMachine) -> OptimumResult:
    """The machine with the best volumes over the scene's speeds, by the model of the search."""
    if machine.scene.model.liquid not in SYNCHRONOUS_MODELS:
        return result
    filled = with_volumes(machine.scene, result.volume)
    filled = filled.altered(model=filled.model.altered(liquid=model_name(filled)))
    response = run_scene(filled)
    if scene.model.liquid == "auto":
        response = replace(response, models=tuple(_of_search(span) for span in response.models))
    return replace(result, response=response)


def _of_search(span: ModelSpan) -> ModelSpan:
    """The scene leaves the model to the search, which names one."""
    return replace(span, reason=span.reason.removeprefix(_ASKED))


def _capacity(scene: Scene, volume: Array) -> ConstraintValue:
    """How full the fullest chamber is."""
    share = max(v / fill.chamber.capacity for v, fill in zip(volume.tolist(), scene.fills, strict=True))
    meaning = "share of the chamber that is fullest"
    return ConstraintValue(1.0, share, share <= 1.0 + 1e-12, "1", meaning)


def _limits(scene: Scene, problem: Problem, volume: Array) -> tuple[Note, ...]:
    """What the models do not hold for."""
    deepest = LONG[1]
    parted = tuple(
        optimum.parted(k, fill.chamber.baffles.count, freed)
        for k, (fill, freed) in enumerate(zip(scene.fills, freeing_volumes(scene), strict=True))
        if fill.chamber.baffles is not None and freed > 0.0
    )
    fills = with_volumes(scene, volume).fills
    parted += tuple(compartment_notes(fills))
    if problem.evaluate.runs is None:
        return parted
    return parted + tuple(
        optimum.too_deep(k, deepest)
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


def front_of(volume: Array, vibration: Array, mass: Array, margin: Array) -> ParetoFront:
    """The points that are not dominated, by rising mass."""
    kept = np.flatnonzero(not_dominated(np.stack((vibration, mass, -margin), axis=1)))
    kept = kept[np.lexsort((vibration[kept], mass[kept]))]
    return ParetoFront(volume[kept], vibration[kept], mass[kept], margin[kept])


_SEARCH = 0.7  # share of the work that a search is where the front follows, as it comes on average
_AT_ONCE = 8  # volumes of the front at once, where an answer costs much


def _first_part(progress: Progress | None) -> Progress | None:
    """The search is the first part of the work."""
    return None if progress is None else lambda count, share: progress(count, _SEARCH * share)


_SWEEP, _SPARING = 40, 12  # volumes of the dedicated sweep; where an answer costs much
_MOST_IN_FRONT = 60  # of the points evaluated by the way


def front_around(
    scene: Scene,
    problem: Problem,
    found: Found,
    vibration: float,
    speeds: Array,
    progress: Progress | None = None,
) -> tuple[ParetoFront, ParetoFront]:
    """What must be given up for what: the front, and the sweep from no liquid to the fullest chamber."""
    evaluate, known = problem.evaluate, found.judged.details
    count = _SPARING if problem.costly else _SWEEP
    high = np.array([fill.chamber.capacity for fill in scene.fills])
    share = np.concatenate(([0.0], np.geomspace(1e-3, 1.0, count)))
    along = found.point if found.point.max() > 0.0 else high
    room = float(np.min(high[along > 0.0] / along[along > 0.0]))
    rows = [np.minimum(share[:, None] * room * along, high), found.point[None]]
    swept = np.unique(np.concatenate(rows), axis=0)
    exact = np.flatnonzero((known["sure"] == 1.0) & np.isfinite(known["vibration"]))
    by_the_way = exact[_thin(known["vibration"][exact], known["mass"][exact])]
    volume = np.concatenate((swept, found.points[by_the_way]))
    total, done = swept.shape[0] + volume.shape[0], 0

    def each(value: Callable[[Array], Array], rows: Array) -> Array:
        nonlocal done
        values, few = [], _AT_ONCE if problem.costly else rows.shape[0]
        for first in range(0, rows.shape[0], few):
            values.append(value(rows[first : first + few]))
            done += values[-1].size
            if progress is not None:
                progress(found.points.shape[0], _SEARCH + (1.0 - _SEARCH) * done / total)
        return np.concatenate(values)

    size = np.concatenate((each(evaluate.vibration.exact, swept), known["vibration"][by_the_way]))
    size[np.all(volume == found.point, axis=1)] = vibration
    margin = -each(lambda rows: growth(scene, rows, speeds), volume)
    mass = volume @ evaluate.density
    part = slice(0, swept.shape[0])
    whole = ParetoFront(volume[part], size[part], mass[part], margin[part])
    return front_of(volume, size, mass, margin), whole


def _thin(vibration: Array, mass: Array) -> NDArray[np.intp]:
    """Of the points that are not beaten in vibration and mass a few, evenly chosen."""
    kept = np.flatnonzero(not_dominated(np.stack((vibration, mass), axis=1)))
    kept = kept[np.argsort(mass[kept], kind="stable")]
    return (
        kept[np.unique(np.linspace(0, max(kept.size - 1, 0), _MOST_IN_FRONT).astype(int))]
        if kept.size
        else kept
    )
