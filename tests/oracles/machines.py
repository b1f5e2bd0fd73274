"""Machines as tables of plain SI numbers, and what turns one into another that must answer alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from copy import deepcopy
from typing import Any

Table = dict[str, Any]

# Exponents of length, mass and time of what a scene or an option gives, by its key.
LENGTH, MASS, TIME, SPEED, RATIO = (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1), (0, 0, 0)
GIVEN: dict[str, tuple[int, int, int]] = {
    "mass": MASS, "tub_mass": MASS, "drum_mass": MASS,
    "stiffness": (0, 1, -2), "damping": (0, 1, -1), "unbalance": (1, 1, 0), "size": (1, 1, 0),
    "tub_inertia": (2, 1, 0), "drum_polar_inertia": (2, 1, 0), "drum_transverse_inertia": (2, 1, 0),
    "transverse_inertia": (2, 1, 0), "polar_inertia": (2, 1, 0),
    "position": LENGTH, "drum_position": LENGTH, "plane": LENGTH,
    "radius": LENGTH, "inner_radius": LENGTH, "height": LENGTH, "volume": (3, 0, 0),
    "density": (-3, 1, 0), "viscosity": (2, 0, -1), "gravity": (1, 0, -2),
    "start": SPEED, "stop": SPEED, "linear": SPEED, "rate": (0, 0, -2), "duration": TIME,
    "eccentricity": LENGTH, "speed": SPEED, "whirl-speed": SPEED, "whirl-amplitude": LENGTH, "ramp": TIME,
    "vibration_limit": LENGTH, "feet": LENGTH, "gap": LENGTH,
}  # fmt: skip

# Another unit of each, and how many of it make one SI unit.
OTHER: dict[tuple[int, int, int], tuple[str, float]] = {
    LENGTH: ("mm", 1e3), MASS: ("g", 1e3), TIME: ("ms", 1e3), SPEED: ("rpm", 30.0 / math.pi),
    (0, 1, -2): ("N/mm", 1e-3), (0, 1, -1): ("N*s/mm", 1e-3), (1, 1, 0): ("kg*mm", 1e3),
    (2, 1, 0): ("kg*mm^2", 1e6), (3, 0, 0): ("ml", 1e6), (-3, 1, 0): ("g/cm^3", 1e-3),
    (2, 0, -1): ("mm^2/s", 1e6), (1, 0, -2): ("mm/s^2", 1e3), (0, 0, -2): ("rpm/s", 30.0 / math.pi),
}  # fmt: skip

_LIQUID = {"density": 998.2, "viscosity": 1.0034e-6}
_SPEEDS = {"start": 20.0, "stop": 180.0, "count": 5}

JEFFCOTT: Table = {
    "name": "Jeffcott", "gravity": 9.81,
    "rotor": {
        "kind": "jeffcott", "mass": 4.0, "stiffness": 48400.0, "damping": 88.0, "unbalance": 6e-4,
        "axis": "horizontal",
    },
    "chambers": [
        {"radius": 0.065, "height": 0.02, "volume": 1e-5, "liquid": _LIQUID},
        {"radius": 0.05, "height": 0.03, "volume": 2e-5, "liquid": _LIQUID},
    ],
    "speeds": _SPEEDS,
    "model": {"liquid": "auto", "friction": "stokes"},
    "runup": {"start": 20.0, "stop": 180.0, "rate": 80.0, "duration": 2.5, "cells": 16, "samples": 40},
}  # fmt: skip

TWO_PLANE: Table = {
    "name": "Two planes", "gravity": 9.81,
    "rotor": {
        "kind": "two_plane", "mass": 20.0, "transverse_inertia": 0.72, "polar_inertia": 0.16,
        "axis": "horizontal",
        "supports": [
            {"position": -0.35, "stiffness": 40e3, "damping": 80.0},
            {"position": 0.3, "stiffness": 40e3, "damping": 80.0},
        ],
        "unbalances": [
            {"position": -0.2, "size": 1.5e-3, "angle": 0.0},
            {"position": 0.25, "size": 1.2e-3, "angle": 2.0},
        ],
    },
    "chambers": [
        {"radius": 0.095, "inner_radius": 0.07, "height": 0.025, "volume": 6e-5, "liquid": _LIQUID,
         "plane": -0.28},
        {"radius": 0.085, "inner_radius": 0.06, "height": 0.025, "volume": 5e-5, "liquid": _LIQUID,
         "plane": 0.28},
    ],
    "speeds": _SPEEDS,
    "model": {"liquid": "auto", "friction": "stokes"},
    "runup": {"start": 20.0, "stop": 180.0, "rate": 80.0, "duration": 2.5, "cells": 16, "samples": 40},
}  # fmt: skip

TUB: Table = {
    "name": "Tub", "gravity": 9.81,
    "rotor": {
        "kind": "tub", "tub_mass": 48.2, "drum_mass": 12.5, "tub_inertia": [1.3, 1.5, 1.3],
        "drum_polar_inertia": 0.32, "drum_transverse_inertia": 0.2, "drum_position": [0.0, 0.09, 0.0],
        "unbalance": 0.185, "axis": "horizontal",
        "springs": [
            {"position": [0.2, 0.0, 0.2], "stiffness": [1500.0, 1200.0, 5700.0]},
            {"position": [-0.2, 0.0, 0.2], "stiffness": [1500.0, 1200.0, 5700.0]},
            {"position": [0.12, 0.0, -0.22], "stiffness": [500.0, 500.0, 0.0]},
            {"position": [-0.12, 0.0, -0.22], "stiffness": [500.0, 500.0, 0.0]},
        ],
        "dampers": [
            {"position": [0.12, 0.0, -0.22], "damping": [40.0, 20.0, 155.0]},
            {"position": [-0.12, 0.0, -0.22], "damping": [40.0, 20.0, 155.0]},
        ],
    },
    "chambers": [
        {"radius": 0.18, "inner_radius": 0.15, "height": 0.04, "volume": 6e-4, "liquid": _LIQUID,
         "plane": 0.115},
    ],
    "speeds": {"start": 12.0, "stop": 60.0, "count": 5},
    "model": {"liquid": "auto", "friction": "stokes"},
}  # fmt: skip

MACHINES = {"jeffcott": JEFFCOTT, "two_plane": TWO_PLANE, "tub": TUB}


def changed(table: Table, change: Callable[[str, float], Any]) -> Table:
    """The table with `change(key, number)` for each number that has a dimension or none."""

    def inside(key: str, value: Any) -> Any:
        if isinstance(value, dict):
            return {name: inside(name, one) for name, one in value.items()}
        if isinstance(value, list):
            return [inside(key, one) for one in value]
        return change(key, value) if key in GIVEN else value

    return {key: inside(key, value) for key, value in table.items()}


def factor(exponents: tuple[int, int, int], scales: tuple[float, float, float]) -> float:
    """By how much a quantity of these dimensions grows when length, mass and time do."""
    return math.prod(scale**power for scale, power in zip(scales, exponents, strict=True))


def scaled(table: Table, scales: tuple[float, float, float]) -> Table:
    """The similar machine: every length, mass and time that many times as large."""
    return changed(table, lambda key, value: value * factor(GIVEN[key], scales))


def in_other_units(table: Table) -> Table:
    """The same machine written in millimetres, grams, revolutions per minute and their like."""

    def write(key: str, value: float) -> str:
        # The rate of a friction is no rotation, so it takes no rpm.
        unit, count = ("1/min", 60.0) if key == "linear" else OTHER[GIVEN[key]]
        return f"{value * count!r} {unit}"

    return changed(table, write)


def split(table: Table, which: int = 0) -> Table:
    """One chamber made of two, each of half the height and half the volume, in the same plane."""
    found = deepcopy(table)
    half = found["chambers"][which]
    half["height"] *= 0.5
    half["volume"] *= 0.5
    found["chambers"].insert(which, deepcopy(half))
    return found


def reordered(table: Table) -> Table:
    """The chambers, supports and unbalances in the opposite order."""
    found = deepcopy(table)
    found["chambers"].reverse()
    for name in ("supports", "unbalances", "springs", "dampers"):
        if name in found["rotor"]:
            found["rotor"][name].reverse()
    if "cabinet" in found:
        found["cabinet"]["feet"].reverse()
    return found


def turned(table: Table, angle: float) -> Table:
    """Every unbalance turned about the axis, rad."""
    found = deepcopy(table)
    for one in found["rotor"]["unbalances"]:
        one["angle"] += angle
    return found
