"""Random machines for the optimiser, and the best volumes by brute force."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fluid.liquid import known_liquid
from leblanc.scene.chambers import Chamber
from leblanc.scene.scene import JeffcottRotor, Model, Scene, Speeds
from leblanc.scene.tasks import Optimisation
from leblanc.studies.optimise.filled import FilledMachine, with_volumes
from leblanc.studies.sweep.batch import answer_scenes
from meshes.arrays import Array

FREE: dict[str, Any] = {"stable": False, "least_film": 0.0, "spill": True}  # nothing but the objective
MANY = 3000  # pairs of a scene and a speed at once


def random_scene(seed: int, chambers: int, count: int = 25) -> Scene:
    """A planar machine with empty chambers, run from below its resonance to above."""
    chance = np.random.default_rng(seed)
    mass, natural = float(10.0 ** chance.uniform(0.0, 2.0)), float(10.0 ** chance.uniform(1.2, 2.3))
    damping = float(10.0 ** chance.uniform(-1.1 if seed % 4 == 1 else -1.7, -0.5))
    fills = []
    for _ in range(chambers):
        radius = float(chance.uniform(0.05, 0.3)) * mass ** (1 / 3) / 3.0
        height, inner = (
            radius * float(chance.uniform(0.1, 0.5)),
            radius * float(chance.choice([0.0, 0.6, 0.8])),
        )
        liquid = known_liquid(str(chance.choice(["water", "brine", "glycerol"])))
        fills.append(Chamber(radius=radius, height=height, inner_radius=inner, liquid=liquid, volume=0.0))
    unbalance = mass * max(one.walls.radius for one in fills) * float(10.0 ** chance.uniform(-3.0, -1.5))
    rotor = JeffcottRotor(
        mass=mass,
        stiffness=mass * natural**2,
        damping=2.0 * damping * mass * natural,
        unbalance=unbalance,
        axis="vertical" if chance.random() < 0.5 else "horizontal",
    )
    speeds = Speeds(start=0.5 * natural, stop=natural * float(chance.uniform(1.1, 4.0)), count=count)
    if seed % 4 == 1:  # a peak over speeds has sense only where their steps resolve it
        speeds = Speeds(start=0.6 * natural, stop=1.6 * natural, count=count)
    model = Model(liquid="statics")
    return Scene(name="random", rotor=rotor, chambers=fills, speeds=speeds, model=model)


def random_task(seed: int, scene: Scene) -> Optimisation:
    """One of the objectives, in turn."""
    chance = np.random.default_rng(seed + 10_000)
    objective = ("working_speed", "peak", "mean", "least_mass")[seed % 4]
    if objective == "mean":
        speeds = chance.uniform(scene.speeds.start, scene.speeds.stop, 3)
        duty = [{"speed": float(one), "weight": float(chance.uniform(0.1, 1.0))} for one in speeds]
        return Optimisation(objective=objective, duty=duty, **FREE)
    if objective == "least_mass":
        none, full = (
            float(amplitudes(scene, np.array([row]), at=scene.speeds.stop)[0, 0])
            for row in (np.zeros(len(scene.fills)), _capacity(scene))
        )
        low, high = sorted((none, full))
        limit = low + float(chance.uniform(0.05, 0.9)) * (high - low) + 1e-9
        return Optimisation(objective=objective, vibration_limit=limit, **FREE)
    return Optimisation(objective=objective, **FREE)


def _capacity(scene: Scene) -> Array:
    return np.array([fill.chamber.capacity for fill in scene.fills])


def amplitudes(scene: Scene, volumes: Array, at: float | None = None) -> Array:
    """Amplitudes at one speed or at all of the scene's, shape (m, s)."""
    speeds = scene.speeds if at is None else Speeds.at(at)
    rows, step = [], max(1, MANY // speeds.count)
    for first in range(0, volumes.shape[0], step):
        part = volumes[first : first + step]
        answers = answer_scenes([with_volumes(scene, row).altered(speeds=speeds) for row in part])
        rows.append(np.where(np.isnan(answers.amplitude), math.inf, answers.amplitude))
    return np.concatenate(rows)


def values(scene: Scene, task: Optimisation, volumes: Array) -> Array:
    """The objective, infinite where a limit is exceeded: from its definition."""
    stop = scene.speeds.stop
    if task.objective == "working_speed":
        return amplitudes(scene, volumes, stop)[:, 0]
    if task.objective == "peak":
        return FilledMachine(scene).peaks(volumes, scene.speeds)  # which has a test of its own
    if task.objective == "mean":
        speeds, weights = np.array([(one.speed, one.weight) for one in task.duty]).T
        each = np.stack([amplitudes(scene, volumes, float(one))[:, 0] for one in speeds])
        return np.asarray(weights @ each / weights.sum())
    assert task.objective == "least_mass"
    assert task.vibration_limit is not None
    density = np.array([fill.liquid.density for fill in scene.fills])
    good = amplitudes(scene, volumes, stop)[:, 0] <= task.vibration_limit
    return np.where(good, volumes @ density, math.inf)


def brute_force(scene: Scene, task: Optimisation, first: int, rounds: int, inner: int) -> tuple[Array, float]:
    """Best of a dense grid, and of denser ones around its best."""
    capacity = _capacity(scene)
    levels = [
        np.unique(
            np.concatenate(
                ([0.0], most * np.geomspace(1e-4, 1.0, first), most * np.linspace(0, 1, first // 3))
            )
        )
        for most in capacity
    ]
    for turn in range(rounds + 1):
        grid = np.stack(np.meshgrid(*levels, indexing="ij"), axis=-1).reshape(-1, capacity.size)
        found = values(scene, task, grid)
        k = int(np.argmin(found))
        best, value = grid[k], float(found[k])
        if turn == rounds or not math.isfinite(value):
            break
        levels = [_closer(one, x, inner) for one, x in zip(levels, best, strict=True)]
    return best, value


def _closer(levels: Array, x: float, count: int) -> Array:
    """Levels between the neighbours of one of them."""
    k = int(np.searchsorted(levels, x))
    low, high = levels[max(k - 1, 0)], levels[min(k + 1, levels.size - 1)]
    return np.unique(np.concatenate((np.linspace(low, x, count), np.linspace(x, high, count))))
