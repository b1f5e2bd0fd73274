"""Machines drawn at random, every field over six decades, and what a change of them must not change.

Fields of `machine` are drawn one without regard to another, so most machines are absurd: a drum of a tenth of
a millimetre beside a rotor of ten tonnes. What must not change the answer must not change theirs either.
`two_plane` and `tub` draw machines that could be built, around one that was.
"""

from __future__ import annotations

import math
from copy import deepcopy
from typing import Any

import numpy as np

from tests.oracles.machines import TUB, TWO_PLANE, Table, changed, reordered

Scales = tuple[float, float, float]

KINDS = ("jeffcott", "two_plane", "tub")
FARTHEST = 40.0  # m, of a part of a machine with a cabinet, for its feet may be 1 km off when it is scaled


def drawn(rng: np.random.Generator, low: float, decades: float = 6.0) -> float:
    """A number between `low` and so many decades above it, evenly in its logarithm."""
    return float(low * 10.0 ** (decades * rng.random()))


def machine(seed: int, kind: str | None = None) -> Table:
    """The machine of a seed, in plain SI numbers.

    Parameters
    ----------
    seed : of the draw
    kind : of rotor; drawn as well if None
    """
    rng = np.random.default_rng(seed)
    kind = kind or str(rng.choice(KINDS))
    rotor = {"jeffcott": _jeffcott, "two_plane": _two_plane, "tub": _tub}[kind](rng)
    rotor |= {"kind": kind, "axis": str(rng.choice(["horizontal", "vertical"]))}
    start = drawn(rng, 1e-3)
    found = {
        "name": f"random {seed}",
        "gravity": drawn(rng, 1e-2),
        "rotor": rotor,
        "chambers": [_chamber(rng, kind) for _ in range(int(rng.integers(1, 4)))],
        "speeds": {"start": start, "stop": start * drawn(rng, 1.2, 1.5), "count": 3},
        "model": {"liquid": "auto", "friction": _friction(rng)},
    }
    return found | (_around(rng, found) if rng.random() < 0.5 else {})


def _around(rng: np.random.Generator, table: Table) -> Table:
    """A cabinet on four feet so wide apart that every mass lies between them, and a point on the axis."""
    rotor = table["rotor"]
    parts = [*rotor.get("springs", ()), *rotor.get("supports", ()), *table["chambers"]]
    places = [rotor.get("drum_position", 0.0), *(part.get("position", 0.0) for part in parts)]
    places += [chamber.get("plane", 0.0) for chamber in table["chambers"]]
    widest = max(np.max(np.abs(place)) for place in places)
    wide, long = (max(float(widest), 1e-3) * float(rng.uniform(2.2, 3.0)) for _ in range(2))
    if widest > FARTHEST:
        return {}
    up, along = _ways(table)
    across = 3 - up - along
    feet = []
    for first, second in ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)):
        foot = [0.0, 0.0, 0.0]
        foot[up], foot[along], foot[across] = -wide, first * long, second * wide
        feet.append(foot)
    place = [0.0, 0.0, 0.0]
    place[1 if rotor["kind"] == "tub" else 2] = _place(rng)
    cabinet = {"mass": drawn(rng, 1e-1), "feet": feet, "friction": float(rng.uniform(0.1, 1.0))}
    return {"cabinet": cabinet, "points": [{"name": "end", "position": place, "gap": drawn(rng, 1e-4)}]}


def _ways(table: Table) -> tuple[int, int]:
    """Numbers of the direction up, and of another one, which is along the axis where that lies."""
    lies = table["rotor"]["axis"] == "horizontal"
    if table["rotor"]["kind"] == "tub":
        return (2, 1) if lies else (1, 0)
    return (0, 2) if lies else (2, 0)


def _jeffcott(rng: np.random.Generator) -> Table:
    return {
        "mass": drawn(rng, 1e-2),
        "stiffness": drawn(rng, 1e1),
        "damping": drawn(rng, 1e-2),
        "unbalance": drawn(rng, 1e-7),
    }


def _place(rng: np.random.Generator) -> float:
    return float(rng.choice([-1.0, 1.0])) * drawn(rng, 1e-4)


def _two_plane(rng: np.random.Generator) -> Table:
    transverse = drawn(rng, 1e-4)
    supports = [
        {"position": _place(rng), "stiffness": drawn(rng, 1e1), "damping": drawn(rng, 1e-2)} for _ in range(2)
    ]
    unbalances = [
        {"position": _place(rng), "size": drawn(rng, 1e-7), "angle": float(rng.uniform(-3.0, 3.0))}
        for _ in range(2)
    ]
    return {
        "mass": drawn(rng, 1e-2),
        "transverse_inertia": transverse,
        "polar_inertia": 2.0 * transverse * drawn(rng, 1e-6),
        "supports": supports,
        "unbalances": unbalances,
    }


def _tub(rng: np.random.Generator) -> Table:
    def places() -> list[float]:
        return [_place(rng) for _ in range(3)]

    def three(low: float) -> list[float]:
        return [drawn(rng, low) for _ in range(3)]

    return {
        "tub_mass": drawn(rng, 1e-2),
        "drum_mass": drawn(rng, 1e-2),
        "tub_inertia": three(1e-4),
        "drum_polar_inertia": drawn(rng, 1e-4),
        "drum_transverse_inertia": drawn(rng, 1e-4),
        "drum_position": places(),
        "unbalance": drawn(rng, 1e-7),
        "springs": [{"position": places(), "stiffness": three(1e1)} for _ in range(3)],
        "dampers": [{"position": places(), "damping": three(1e-2)} for _ in range(2)],
    }


def _chamber(rng: np.random.Generator, kind: str) -> Table:
    radius, height = drawn(rng, 1e-4), drawn(rng, 1e-4)
    inner = radius * (1.0 - drawn(rng, 1e-6)) if rng.random() < 0.5 else 0.0
    capacity = np.pi * (radius - inner) * (radius + inner) * height
    liquid = {"density": drawn(rng, 1e-2), "viscosity": drawn(rng, 1e-9)}
    found = {"radius": radius, "inner_radius": inner, "height": height, "liquid": liquid}
    found["volume"] = capacity * drawn(rng, 1e-6) * (1.0 - 1e-9)
    if kind != "jeffcott":
        found["plane"] = _place(rng)
    return found


def _friction(rng: np.random.Generator) -> Any:
    laws = ["none", "stokes", {"linear": drawn(rng, 1e-3)}, {"quadratic": drawn(rng, 1e-4)}]
    return laws[int(rng.integers(len(laws)))]


def mirrored(table: Table) -> Table:
    """The machine seen in a mirror across its axis, which leaves the sense of the spin."""
    found = deepcopy(table)
    rotor = found["rotor"]
    for place in [*rotor.get("supports", ()), *rotor.get("unbalances", ())]:
        place["position"] *= -1.0
    for place in [*rotor.get("springs", ()), *rotor.get("dampers", ())]:
        place["position"][1] *= -1.0
    if "drum_position" in rotor:
        rotor["drum_position"][1] *= -1.0
    for chamber in found["chambers"]:
        if "plane" in chamber:
            chamber["plane"] *= -1.0
    along = 1 if rotor["kind"] == "tub" else 2
    if "cabinet" in found and rotor["axis"] == "horizontal":
        for foot in found["cabinet"]["feet"]:
            foot[along] *= -1.0
    for point in found.get("points", ()):
        point["position"][along] *= -1.0
    return found


def nudged(table: Table, seed: int, size: float = 2.0**-40) -> Table:
    """The machine with every number that has a unit off by `size` of itself, up or down at random."""
    rng = np.random.default_rng(seed)

    def nudge(key: str, value: Any) -> Any:
        return value * (1.0 + size * float(rng.choice([-1.0, 1.0])))

    found = changed(table, nudge)
    for chamber in found["chambers"]:
        # No more than it holds.
        radius, inner = chamber["radius"], chamber["inner_radius"]
        capacity = np.pi * (radius - inner) * (radius + inner) * chamber["height"]
        chamber["volume"] = min(chamber["volume"], capacity)
    return found


def random_scales(seed: int) -> Scales:
    """Powers of two, of length, mass and time: rounding is all they change; the density changes little."""
    rng = np.random.default_rng(seed)
    length, denser, time = (2.0 ** int(rng.integers(-3, 4)) for _ in range(3))
    return length, denser * length**3, time


def permuted(table: Table) -> Table:
    """All parts in the opposite order but the first chamber, at which a rotor that tilts is looked at."""
    first, *others = table["chambers"]
    found = reordered(table)
    found["chambers"] = deepcopy([first, *reversed(others)])
    return found


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


def lying_drum(seed: int) -> Table:
    """A lying drum with 0 to 12 baffles of any height that starts from rest or slowly, with its way.

    Of a size that is built, on supports that its unbalance moves by some per cent of its radius.
    """
    rng = np.random.default_rng(seed)
    even = _even(rng)
    radius = even(0.03, 0.4)
    inner = radius * float(rng.uniform(0.5, 0.9)) if rng.random() < 0.4 else 0.0
    height = radius * even(0.1, 1.0)
    volume = math.pi * (radius**2 - inner**2) * height * even(0.005, 0.7)
    density = even(600.0, 3000.0)
    chamber = {
        "radius": radius,
        "inner_radius": inner,
        "height": height,
        "volume": volume,
        "liquid": {"density": density, "viscosity": even(1e-7, 1e-3)},
    }
    count = int(rng.integers(0, 13))
    if count:
        chamber["baffles"] = {"count": count, "tip_radius": float(rng.uniform(inner, radius))}
        if rng.random() < 0.2:
            tip = chamber["baffles"]["tip_radius"]
            chamber["baffles"]["wall_gap"] = (radius - tip) * float(rng.uniform(0.1, 0.9))
    slow = math.sqrt(9.81 / radius)
    top, mass = slow * even(1.5, 12.0), density * volume * even(0.5, 100.0)
    rotor = {
        "kind": "jeffcott",
        "mass": mass,
        "stiffness": mass * (top * even(0.1, 3.0)) ** 2,
        "unbalance": mass * radius * even(1e-4, 1e-2),
        "axis": "horizontal",
    }
    rotor["damping"] = 2.0 * math.sqrt(rotor["stiffness"] * mass) * even(0.03, 0.5)
    laws = ["none", "stokes", "wall", {"linear": slow * even(1e-3, 1e2)}, {"quadratic": even(1e-4, 1.0)}]
    time = even(2.0, 20.0) / slow
    found = {
        "name": f"lying drum {seed}",
        "gravity": 9.81,
        "rotor": rotor,
        "chambers": [chamber],
        "speeds": {"start": 0.5 * top, "stop": top, "count": 3},
        "model": {"liquid": "auto", "friction": laws[int(rng.integers(len(laws)))]},
    }
    how = {"cells": 48, "samples": 200, "capture": str(rng.choice(["carried", "drum"]))}
    how |= {"dispersion": bool(rng.random() < 0.2), "bore": str(rng.choice(["none", "enstrophy"]))}
    if rng.random() < 0.3:
        start = slow * float(rng.uniform(0.05, 0.95))
        way = {"start": start, "stop": top, "rate": (top - start) / time, "duration": 1.2 * time}
        return found | {"runup": way | how | {"back": bool(rng.random() < 0.3)}}
    low = top * float(rng.uniform(0.0, 0.8))
    steps = [f"to {top} rad/s in {time} s", f"hold {0.2 * time} s"]
    ends = [
        [f"to {low} rad/s in {0.5 * time} s", f"to {top} rad/s in {0.5 * time} s"],
        [f"to 0 rad/s in {0.7 * time} s"],
        [f"coast {0.5 * time} s"],
        ["coast to 0 rad/s"],
        [],
    ]
    steps += ends[int(rng.integers(len(ends)))]
    inertia = mass * radius**2 * even(0.1, 1.0)
    drag = {"drag_torque": inertia * top / time * even(0.01, 10.0), "coast_limit": 2.0 * time}
    if rng.random() < 0.5:
        drag["drag_rate"] = even(0.1, 1e3) / time
    return found | {"programme": {"start": 0.0, "steps": steps, "inertia": inertia} | drag | how}
