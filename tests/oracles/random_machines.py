"""Machines drawn at random over decades of every field, and their mirror images along the axis."""

from __future__ import annotations

import math
from copy import deepcopy

import numpy as np

from tests.oracles.machines import TUB, TWO_PLANE, Table


def two_plane(rng: np.random.Generator) -> Table:
    """A rotor with two supports and two chambers of laminar liquid."""
    found, even = deepcopy(TWO_PLANE), _even(rng)
    rotor = found["rotor"]
    rotor["mass"] = even(1.0, 300.0)
    rotor["transverse_inertia"] = rotor["mass"] * even(5e-4, 1.0)
    rotor["polar_inertia"] = rotor["transverse_inertia"] * even(0.03, 1.95)
    for support in rotor["supports"]:
        support |= {
            "position": support["position"] * even(0.1, 3.0),
            "stiffness": even(1e2, 1e7),
            "damping": even(0.1, 5e3),
        }
    _fill(found, rng)
    return found


def tub(rng: np.random.Generator) -> Table:
    """A suspended tub with one chamber, or with two equal ones at its ends."""
    found, even = deepcopy(TUB), _even(rng)
    for part, key, low in (("springs", "stiffness", 0.1), ("dampers", "damping", 0.03)):
        for own in found["rotor"][part]:
            own[key] = [value * even(low, 10.0) for value in own[key]]
    _fill(found, rng)
    if rng.random() < 0.5:
        found["chambers"].append(deepcopy(found["chambers"][0]) | {"plane": -0.1})
    return found


def mirrored(table: Table) -> Table:
    """The machine seen from behind a mirror across its axis, front for back; its spin stays what it is."""
    found = deepcopy(table)
    rotor = found["rotor"]
    for part in ("supports", "unbalances"):
        for own in rotor.get(part, ()):
            own["position"] = -own["position"]
    for part in ("springs", "dampers"):
        for own in rotor.get(part, ()):
            own["position"] = [own["position"][0], -own["position"][1], own["position"][2]]
    if "drum_position" in rotor:
        rotor["drum_position"] = [
            rotor["drum_position"][0],
            -rotor["drum_position"][1],
            rotor["drum_position"][2],
        ]
    for chamber in found["chambers"]:
        chamber["plane"] = -chamber["plane"]
    return found


def _even(rng: np.random.Generator):  # type: ignore[no-untyped-def]
    """Numbers whose logarithm is even between those of two ends."""
    return lambda low, high: float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _fill(table: Table, rng: np.random.Generator) -> None:
    """Chambers from a film to nearly full, of petrol or of mercury, from as good as inviscid to thick."""
    even = _even(rng)
    for chamber in table["chambers"]:
        radius, height = even(0.02, 0.5), even(0.005, 0.2)
        chamber |= {
            "radius": radius,
            "inner_radius": 0.0,
            "height": height,
            "volume": math.pi * radius**2 * height * even(1e-5, 0.98),
            "plane": chamber["plane"] * even(0.02, 2.0),
            "liquid": {"density": even(500.0, 13000.0), "viscosity": even(1e-8, 1e-2)},
        }
    table["speeds"] = {"start": even(1.0, 30.0), "stop": even(100.0, 2000.0), "count": 20}
