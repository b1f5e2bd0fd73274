"""Fits of machines drawn at random: how many find the truth, and how many miss it without a note.

`python -m tests.leblanc.studies.random_fits --count 300` fits 2 to 4 unknowns from guesses that are off by
up to a factor e, to data with noise of 0 to 2 %; `--coverage 400` counts the intervals that hold the truth,
for each kind of noise. A miss that least squares from the truth shares is counted by itself: noise alone.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc

from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.studies.fit.answer import FitAnswer
from leblanc.studies.fit.measured import Measurement
from leblanc.studies.fit.problem import Problem, answer
from leblanc.studies.fit.search import descend
from leblanc.studies.fit.study import fit_scene
from meshes.arrays import Array
from meshes.errors import InputError

PLANAR = ("rotor.mass", "rotor.stiffness", "rotor.damping", "rotor.unbalance", "chambers.0.volume")
TILTING = (
    "rotor.unbalances.0.size",
    "rotor.transverse_inertia",
    "rotor.supports.0.damping",
    "rotor.supports.1.stiffness",
)
DRY_TRUTH = {"rotor.stiffness": 18750.0, "rotor.damping": 90.0, "rotor.unbalance": 0.004}
DRY = {
    "name": "dry",
    "rotor": {
        "kind": "jeffcott",
        "mass": 30.0,
        "axis": "vertical",
        **{path.split(".")[1]: value for path, value in DRY_TRUTH.items()},
    },
    "chambers": [{"radius": 0.1, "height": 0.05, "volume": 0.0, "liquid": "water"}],
    "speeds": {"start": "80 rpm", "stop": "900 rpm", "count": 40},
    "model": {"liquid": "linear"},
}
# Of the interval of 95 %: of normal noise that is estimated from 28 degrees of freedom, one in 1000 unknowns
# is beyond 1.8 * 2.048 standard errors (Student's t).
_WIDE = 1.8
_SHARED = 0.125  # of the interval, half a standard error: the best values from the truth are the ones found
_EXACT = 1e-3  # of a value without noise


@dataclass(frozen=True)
class Fitted:
    """One fit beside the truth."""

    truth: Array  #: SI, shape (p,)
    result: FitAnswer
    noise: float  #: of the readings, relative
    best: Array  #: where least squares from the truth ends, weighted by the noise as drawn, SI, shape (p,)
    rise: float  #: of that sum of squares from there to the truth, chi squared of p

    @property
    def near(self) -> bool:
        """Every value within what noise may do to it, or its bound beside the truth."""
        low, high = self.result.interval.T
        value, truth = self.result.value, self.truth
        inside = np.isnan(low) | (truth >= value * (low / value) ** _WIDE)
        inside &= np.isnan(high) | (truth <= value * (high / value) ** _WIDE)
        close = np.abs(value - truth) <= _EXACT * truth
        return bool((close | (inside & np.isfinite(self.result.interval).any(axis=1))).all())

    @property
    def verdict(self) -> str:
        """Right, missed by noise alone, wrong with a note, or wrong without one."""
        if self.near and self.result.accepted:
            return "right"
        low, high = self.result.interval.T
        if (np.abs(np.log(self.result.value / self.best)) <= _SHARED * np.log(high / low)).all():
            return "noise"
        return "noted" if self.result.notes or not self.result.accepted else "silent"


def planar(random: np.random.Generator) -> Scene:
    """A planar rotor with liquid in one chamber."""
    mass, critical = float(np.exp(random.uniform(0.0, 4.0))), float(random.uniform(20.0, 150.0))
    stiffness, ratio = mass * critical**2, float(np.exp(random.uniform(np.log(0.02), np.log(0.2))))
    radius = 0.05 * mass ** (1.0 / 3.0)
    height = float(random.uniform(0.2, 0.6)) * radius
    volume = float(random.uniform(0.1, 0.7)) * np.pi * radius**2 * height
    rotor = {
        "kind": "jeffcott",
        "mass": mass,
        "stiffness": stiffness,
        "damping": 2.0 * ratio * mass * critical,
        "unbalance": 0.003 * mass * radius,
        "axis": str(random.choice(["horizontal", "vertical"])),
    }
    chamber = {"radius": radius, "height": height, "volume": volume, "liquid": "water"}
    return scene_from_table(
        {"name": "planar", "rotor": rotor, "chambers": [chamber], "speeds": _speeds(critical)}
    )


def tilting(random: np.random.Generator) -> Scene:
    """A rigid rotor on two supports, with liquid in one chamber."""
    mass, critical = float(np.exp(random.uniform(1.0, 4.5))), float(random.uniform(20.0, 100.0))
    radius = 0.05 * mass ** (1.0 / 3.0)
    height, stiffness = 0.3 * radius, mass * critical**2
    ratio = float(random.uniform(0.02, 0.15))
    supports = [
        {"position": place * radius, "stiffness": share * stiffness, "damping": ratio * mass * critical}
        for place, share in ((-1.5, 0.45), (1.8, 0.55))
    ]
    rotor = {
        "kind": "two_plane",
        "mass": mass,
        "transverse_inertia": float(random.uniform(0.5, 2.0)) * mass * radius**2,
        "polar_inertia": 0.4 * mass * radius**2,
        "axis": "horizontal",
        "supports": supports,
        "unbalances": [{"position": 0.5 * radius, "size": 0.003 * mass * radius, "angle": 0.4}],
    }
    volume = float(random.uniform(0.2, 0.6)) * np.pi * radius**2 * height
    chamber = {"radius": radius, "height": height, "volume": volume, "liquid": "water", "plane": 0.8 * radius}
    return scene_from_table(
        {"name": "tilting", "rotor": rotor, "chambers": [chamber], "speeds": _speeds(critical)}
    )


def _speeds(critical: float) -> dict[str, float]:
    return {"start": 0.4 * critical, "stop": 2.0 * critical, "count": 30}


def value_at(scene: Scene, path: str) -> float:
    """A value of a scene, SI."""
    table = scene.table()
    for key in path.split("."):
        table = table[int(key)] if isinstance(table, list | tuple) else table[key]
    return float(table)  # type: ignore[arg-type]


def drawn(seed: int) -> Fitted:
    """One machine, its noise, guess and fit."""
    random = np.random.default_rng(seed)
    tilts = seed % 5 == 4
    scene = tilting(random) if tilts else planar(random)
    pool = TILTING if tilts else PLANAR
    paths = tuple(sorted(random.choice(pool, size=int(random.integers(2, 5)), replace=False).tolist()))
    truth = np.array([value_at(scene, path) for path in paths])
    noise = float(random.choice([0.0, 0.005, 0.01, 0.02]))
    speed = scene.speed_array()
    (amplitude,) = answer(scene, "speed", speed, ["amplitude"])
    typical = np.full(speed.size, np.sqrt(np.mean(np.square(amplitude))))
    size = noise * (amplitude if random.random() < 0.5 else typical)
    seen = np.abs(amplitude + size * random.standard_normal(speed.size))
    guess = scene
    for _ in range(20):
        off = truth * np.exp(random.uniform(-1.0, 1.0, truth.size))
        try:
            guess = scene.replace(dict(zip(paths, off.tolist(), strict=True)))
            break
        except (InputError, SceneError):  # a chamber that would overflow: another guess
            continue
    table = Measurement("speed", speed, (("amplitude", seen),))
    return Fitted(truth, fit_scene(guess, table, paths), noise, *_from_truth(scene, table, paths, size))


def _from_truth(scene: Scene, table: Measurement, paths: tuple[str, ...], size: Array) -> tuple[Array, float]:
    """Best values from the truth with the weights that the noise has, and the rise to the truth."""
    truth = np.array([value_at(scene, path) for path in paths])
    if not size.any():
        return truth, 0.0
    problem = Problem(scene, tuple((path,) for path in paths), truth, table, "given")
    residual = problem.weighted([size])
    valley = descend(problem, residual, np.zeros(truth.size))
    return problem.values(valley.x), float(np.sum(np.square(residual(np.zeros(truth.size))))) - valley.cost


def dry(random: np.random.Generator, kind: str, share: float = 0.03) -> FitAnswer:
    """A dry planar machine with noise of one kind, stated, or estimated from either kind."""
    scene = scene_from_table(DRY)
    speed = scene.speed_array()
    (amplitude,) = answer(scene, "speed", speed, ["amplitude"])
    size = share * float(np.sqrt(np.mean(np.square(amplitude))))
    absolute = kind == "absolute" or (kind == "estimate" and random.random() < 0.5)
    sigma = np.full(speed.size, size) if absolute else share * amplitude
    seen = amplitude + sigma * random.standard_normal(speed.size)
    stated = {"absolute": f"{1e3 * size} mm", "relative": f"{100.0 * share} %", "estimate": "estimate"}[kind]
    guess = scene.replace({"rotor.stiffness": 15e3, "rotor.damping": 60.0, "rotor.unbalance": 2e-3})
    table = Measurement("speed", speed, (("amplitude", np.maximum(seen, 0.0)),))
    return fit_scene(guess, table, tuple(DRY_TRUTH), noise=stated)


def covered(kind: str, seed: int) -> NDArray[np.bool_]:
    """Whether each interval of 95 % holds the truth."""
    low, high = dry(np.random.default_rng(seed), kind).interval.T
    truth = np.array(list(DRY_TRUTH.values()))
    return np.asarray((low <= truth) & (truth <= high))


def _main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--coverage", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    counts = {"right": 0, "noise": 0, "noted": 0, "silent": 0}
    for seed in range(asked.seed, asked.seed + asked.count):
        one = drawn(seed)
        counts[one.verdict] += 1
        codes = " ".join(note.code.value for note in one.result.notes)
        chance = chdtrc(one.truth.size, one.rise)
        told = f"{seed} {one.verdict} {one.result.value / one.truth} {codes} {counts}"
        print(told, f"chance of such noise {chance:.2g}", flush=True)
    inside = {kind: np.zeros(len(DRY_TRUTH), dtype=int) for kind in ("relative", "absolute", "estimate")}
    for k in range(asked.coverage):
        for kind, held in inside.items():
            held += covered(kind, asked.seed + k)
        if k % 10 == 9 or k == asked.coverage - 1:
            print(
                k + 1, {kind: (held / (k + 1)).round(4).tolist() for kind, held in inside.items()}, flush=True
            )


if __name__ == "__main__":
    _main()
