"""The search for a scene's volumes: its box, where it starts, how much it tries."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from leblanc.core.interrupts import stopping
from leblanc.core.progress import update
from leblanc.liquid.choose import axial_gravity
from leblanc.liquid.notes import slowed_by
from leblanc.scene.scene import JeffcottRotor, Scene, jeffcott
from leblanc.scene.tasks import Optimisation
from leblanc.studies.optimise.objectives import Passages, PeakOver
from leblanc.studies.optimise.problem import Problem
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.search import Budget, Enough, Found, Judgement, SearchPlan, best_of, search
from solvers.statics.hydrostatics import wall_volumes

# Where an answer costs tens of milliseconds and more.
_SPARING = SearchPlan(
    levels=(16, 6, 4),
    finest=2e-3,
    valleys=2,
    sweeps=3,
    settled=1e-2,
    margin=1e-3,
    edge=3e-2,
    sections=4,
    polish=4,
)
# Where it takes some speeds to know a value.
_FEW = SearchPlan(
    levels=(14, 9, 5), crossed=False, finest=1e-3, sweeps=6, settled=5e-4, margin=2e-5, edge=1e-3, sections=10
)
# Sets of volumes at once where an answer costs much: all together cost less, but nobody hears of them.
_AT_ONCE, _RUNUPS = 16, 4
_DIGITS = 8  # binary ones of volumes, where each new one costs much
_CLOSER = 6  # of the best that a cheaper vibration found are evaluated again


def bounds_of(scene: Scene, task: Optimisation) -> tuple[Array, Array]:
    """Least and most volume of each chamber, m^3, shape (c,) each."""
    capacity = np.array([fill.chamber.capacity for fill in scene.fills])
    if not task.volumes:
        return np.zeros_like(capacity), capacity
    if len(task.volumes) != capacity.size:
        text = f"a list of {capacity.size} pairs of volumes, one for each chamber"
        raise InputError("optimise.volumes", len(task.volumes), text)
    low, high = np.array(task.volumes).T
    for k, (most, room) in enumerate(zip(low, capacity, strict=True)):
        if most > room:
            raise InputError(
                f"optimise.volumes.{k}", float(most), f"at most what the chamber holds, {room:g} m^3"
            )
    return low, np.minimum(high, capacity)


def best_volumes(
    scene: Scene, problem: Problem, low: Array, high: Array, part: float = 1.0, budget: Budget | None = None
) -> Found:
    """Best volumes for a problem, a search that is a part of the whole work."""
    costly = _AT_ONCE if problem.runs is None else _RUNUPS
    count, done, budget, slow = 0, 0.0, budget or Budget(), slowed_by(scene.fills)

    def say(more: int) -> None:
        nonlocal count
        count += more
        update(done, 1.0, f"{count} sets{slow}" if slow else f"{count} sets of volumes evaluated")

    def stage(share: float) -> None:
        nonlocal done
        done = part * share
        say(0)

    def judge(volumes: Array) -> Judgement:
        allowed = budget.take(volumes.shape[0])
        said = problem.evaluate(volumes[:allowed])
        say(allowed)
        if allowed < volumes.shape[0]:
            raise Enough(budget.words, said)
        return said

    starts, alike = _starts(scene, problem, low.size), _alike(scene, low, high)
    plan = plan_of(problem)
    if problem.costly:
        # Finite elements of each new fill: volumes that no answer tells apart are one.
        plan = replace(plan, at_once=costly, digits=_DIGITS if slow else 0)
    with stopping():
        return search(judge, low, high, problem.density, starts, alike, plan, stage)


def plan_of(problem: Problem) -> SearchPlan:
    """How much the search for a problem tries; its margin is what values differ by that are not equal.

    That is what the objective can tell [theory: optimum, eq. 13].
    """
    if problem.costly:
        return _SPARING
    return _FEW if isinstance(problem.vibration, PeakOver) else SearchPlan()


def _starts(scene: Scene, problem: Problem, count: int) -> Array:
    """Volumes that just cover the walls at deflections the machine may have: there the law bends."""
    gravity, rows = axial_gravity(scene), []
    for speed in problem.speeds:
        for deflection in _likely_deflections(scene, speed)[
            : 5 if count == 1 and len(problem.speeds) == 1 else 2
        ]:
            row = []
            for fill in scene.fills:
                e = min(deflection, 0.9 * fill.chamber.radius)
                row.append(float(wall_volumes(fill.chamber, e, speed, gravity).full))
            rows.append(row)
    return np.array(rows[: 12 if count == 1 else 3]).reshape(-1, len(scene.fills))


def _likely_deflections(scene: Scene, speed: float) -> list[float]:
    """Of the planar rotor with all walls wet, and without liquid, m [theory: rotor, eq. 3]."""
    if not isinstance(scene.rotor, JeffcottRotor):
        return []
    rotor = jeffcott(scene)
    force, stiffness = rotor.unbalance * speed**2, complex(rotor.dynamic_stiffness(np.array(speed)))
    added = sum(fill.added_mass for fill in scene.fills) * speed**2
    sizes = [abs(stiffness - added), abs(stiffness)]
    wet, dry = (force / size if size > 0.0 else math.inf for size in sizes)
    return [e for e in (wet, dry, 2.0 * wet, 0.5 * wet, math.sqrt(wet * dry)) if 0.0 < e < math.inf]


def _alike(scene: Scene, low: Array, high: Array) -> list[list[int]]:
    """Groups of chambers that may be exchanged without a change."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for k, fill in enumerate(scene.fills):
        chamber = replace(fill.chamber, plane=0.0) if isinstance(scene.rotor, JeffcottRotor) else fill.chamber
        groups.setdefault((chamber, fill.liquid, float(low[k]), float(high[k])), []).append(k)
    return [group for group in groups.values() if len(group) > 1]


def on_all_cells(scene: Scene, problem: Problem) -> Problem:
    """The problem with run-ups on all of the scene's cells; itself if it has no others."""
    coarse, plan = problem.runs, scene.speed_plan
    if plan is None or coarse is None or coarse.numerics.cells >= plan.cells:
        return problem
    return problem.on(scene, Passages(scene, loaded=coarse.loaded, threads=coarse.of.threads))


def evaluated_again(fine: Problem, found: Found) -> Found:
    """The best of what a search with a cheaper vibration found, by the problem's own evaluation."""
    allowed = np.maximum(found.judged.excess, 0.0) <= max(found.excess, 0.0)
    order = np.flatnonzero(allowed)[np.argsort(found.judged.objective[allowed], kind="stable")]
    tried = np.unique(np.concatenate((found.point[None], found.points[order[:_CLOSER]])), axis=0)
    again = fine.evaluate(tried)
    best = best_of(again, tried @ fine.density, plan_of(fine).margin)
    objective, excess = float(again.objective[best]), float(again.excess[best])
    return replace(found, point=tried[best], objective=objective, excess=excess)
