"""Fits of machines drawn at random: how many find the truth, and how many miss it without a note.

`python -m tests.leblanc.studies.random_fits --count 300` fits two to four unknowns from guesses that are off by
up to a factor e, to data with noise of 0 to 2 %; `--coverage 400` counts the intervals that hold the truth,
for each kind of noise.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass

import numpy as np

from leblanc.results.fit import FitResult, quantile
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.studies.fit import fit_scene
from leblanc.studies.fitting.measured import Measurement
from leblanc.studies.fitting.problem import answer
from meshes.arrays import Array

PLANAR = ("rotor.mass", "rotor.stiffness", "rotor.damping", "rotor.unbalance", "chambers.0.volume")
TILTING = (
    "rotor.unbalances.0.size",
    "rotor.transverse_inertia",
    "rotor.supports.0.damping",
    "rotor.supports.1.stiffness",
)
# Of the interval of 95 %: within it in 2000 unknowns of normal noise one is not.
_WIDE = 1.8
_EXACT = 1e-3  # of a value without noise


@dataclass(frozen=True)
class Fitted:
    """One fit beside the truth."""

    truth: Array  #: SI, shape (p,)
    result: FitResult
    noise: float  #: of the readings, relative

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
        """Right, wrong with a note, or wrong without one."""
        if self.near and self.result.accepted:
            return "right"
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
    return scene_from_table({"name": "planar", "rotor": rotor, "chambers": [chamber], "speeds": _speeds(critical)})


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
    return scene_from_table({"name": "tilting", "rotor": rotor, "chambers": [chamber], "speeds": _speeds(critical)})


def _speeds(critical: float) -> dict[str, float]:
    return {"start": 0.4 * critical, "stop": 2.0 * critical, "count": 30}


def value_at(scene: Scene, path: str) -> float:
    """A value of a scene, SI."""
    table = scene.table()
    for key in path.split("."):
        table = table[int(key)] if isinstance(table, list | tuple) else table[key]  # type: ignore[index, assignment]
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
    size = noise * (amplitude if random.random() < 0.5 else np.sqrt(np.mean(np.square(amplitude))))
    seen = np.abs(amplitude + size * random.standard_normal(speed.size))
    guess = scene
    for _ in range(20):
        off = truth * np.exp(random.uniform(-1.0, 1.0, truth.size))
        try:
            guess = scene.replace(dict(zip(paths, off.tolist(), strict=True)))
            break
        except Exception:  # noqa: BLE001 - a chamber that would overflow: other guesses
            continue
    return Fitted(truth, fit_scene(guess, Measurement("speed", speed, (("amplitude", seen),)), paths), noise)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    begun, counts = time.process_time(), {"right": 0, "noted": 0, "silent": 0}
    for seed in range(asked.seed, asked.seed + asked.count):
        one = drawn(seed)
        counts[one.verdict] += 1
        r = one.result
        print(seed, one.verdict, f"{one.noise:g} left {r.residual_rms:.2g} {r.accepted} {r.evaluations} evals", time.process_time()-begun,
            " ".join(f"{p.split('.')[-1]}={v/t:.4g}[{a/t:.3g},{b/t:.3g}]" for p, v, t, (a,b) in zip(r.unknown, r.value, one.truth, r.interval)), [n.code for n in r.notes], flush=True)
    print(counts)
