"""Machines with balls drawn at random: planar, in two planes and tubs, with one to five balls in a race."""

from __future__ import annotations

import math
from copy import deepcopy

import numpy as np

from tests.oracles.machines import TUB, Table, changed

KINDS = ("jeffcott", "two_plane", "tub")
PLACES = (-0.15, 0.0, 0.1, 0.2)  # of races and unbalances: as machines are built, often in one plane


def machine_with_balls(seed: int) -> Table:
    """The machine of a seed, in plain SI numbers; unbalances are often in the plane of a race."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % 3]
    rotor, mass = {"jeffcott": _planar, "two_plane": _two_plane, "tub": _tub}[kind](rng)
    most = 1 if kind == "jeffcott" else 2
    size = rotor.get("unbalance", 0.0) + sum(part["size"] for part in rotor.get("unbalances", ()))
    races = [_race(rng, mass, size, kind != "jeffcott") for _ in range(int(rng.integers(1, most + 1)))]
    resonance = 60.0 if kind != "tub" else 30.0
    start = resonance * float(rng.uniform(0.3, 1.2))
    return {
        "name": f"random balls {seed}",
        "rotor": rotor | {"kind": kind, "axis": "vertical"},
        "chambers": races,
        "speeds": {"start": start, "stop": start + resonance * float(rng.uniform(1.0, 5.0)), "count": 3},
    }


def nudged_balls(table: Table, seed: int, size: float) -> Table:
    """The machine with every number that has a unit off by `size` of itself, up or down at random."""
    rng = np.random.default_rng(seed)
    return changed(table, lambda key, value: value * (1.0 + size * float(rng.choice([-1.0, 1.0]))))


def _even(rng: np.random.Generator, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _planar(rng: np.random.Generator) -> tuple[Table, float]:
    mass = _even(rng, 1.0, 100.0)
    stiffness = mass * 60.0**2
    damping = 2.0 * math.sqrt(stiffness * mass) * _even(rng, 0.01, 0.3)
    unbalance = mass * _even(rng, 1e-6, 3e-4)
    return {"mass": mass, "stiffness": stiffness, "damping": damping, "unbalance": unbalance}, mass


def _two_plane(rng: np.random.Generator) -> tuple[Table, float]:
    mass = _even(rng, 1.0, 100.0)
    transverse = mass * _even(rng, 0.005, 0.08)
    support = {"stiffness": 0.5 * mass * 60.0**2, "damping": mass * 60.0 * _even(rng, 0.02, 0.2)}
    supports = [
        support | {"position": place, "stiffness": support["stiffness"] * _even(rng, 0.7, 1.4)}
        for place in (-0.2, 0.25)
    ]
    count = int(rng.integers(1, 3))
    unbalances = [
        {
            "position": float(rng.choice(PLACES)),
            "size": mass * _even(rng, 1e-6, 1e-4),
            "angle": float(rng.choice([0.0, 1.0, 3.0])),
        }
        for _ in range(count)
    ]
    rotor = {
        "mass": mass,
        "transverse_inertia": transverse,
        "polar_inertia": transverse * _even(rng, 0.1, 1.8),
    }
    return rotor | {"supports": supports, "unbalances": unbalances}, mass


def _tub(rng: np.random.Generator) -> tuple[Table, float]:
    rotor = deepcopy(TUB["rotor"])
    for part, key in (("springs", "stiffness"), ("dampers", "damping")):
        for own in rotor[part]:
            own[key] = [value * _even(rng, 0.5, 2.0) for value in own[key]]
    mass = rotor["tub_mass"] + rotor["drum_mass"]
    rotor["unbalance"] = mass * _even(rng, 1e-5, 1e-3)
    return rotor, mass


def _race(rng: np.random.Generator, mass: float, size: float, tilts: bool) -> Table:
    """Balls that hold from less than the unbalance to ten times it, so that many are more than it needs."""
    count, radius = int(rng.integers(1, 6)), float(rng.uniform(0.05, 0.2))
    ball = min(size * _even(rng, 0.5, 10.0) / (count * radius), 0.05 * mass / count)
    drag = ball * 60.0 * _even(rng, 0.01, 1.0)
    found = {"kind": "balls", "radius": radius, "count": count, "mass": ball, "drag": drag}
    return found | ({"plane": float(rng.choice(PLACES))} if tilts else {})
