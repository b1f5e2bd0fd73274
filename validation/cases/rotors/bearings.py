"""Bearings and balancing [DR18, sections 3 and 4]: load against slip, wear and friction of the bush."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from leblanc.scene.examples import example
from leblanc.studies.loads.answer import BearingLife
from leblanc.studies.run.study import run_scene
from meshes.arrays import Array
from solvers.rotor.rolling_bearing import worn_volume
from validation.case import Case, Claims

CLAIMS = Claims("bearings")

# Table 1: wear, m^2/N, and friction without lubricant, with 10 % and with 50 % of lubrication.
WEAR = {"dry": 100e-16, "10 %": 5.1e-16, "50 %": 4.0e-16}
FRICTION = {"dry": (0.22, 0.35), "10 %": (0.08, 0.08), "50 %": (0.07, 0.07)}
HOURS, ROUNDING = 300.0, (1.0e-3, 1.5e-3)  # of the trial; radius that its edge had at the end, m
_BORE = 0.017  # m, of the ball bearing 60203 whose place the bush takes; not printed
_RATING = 9560.0  # N, dynamic rating of a 60203 by its standard; not printed
_BELT = 20.0  # N, less than any belt pulls that drives a drum; not printed
# Unbalance of the trials: 22000 g cm, none; below that what leaves as good as no force.
_UNBALANCE = (0.22, 1e-6)


def rounded_off(radius: float, bore: float) -> float:
    """Volume that is missing where the edge of a bore is rounded all round, m^3 (Pappus)."""
    area = (1.0 - 0.25 * math.pi) * radius**2
    # Centroid of a square less a quarter circle, from its corner.
    outward = radius * (10.0 - 3.0 * math.pi) / (12.0 - 3.0 * math.pi)
    return 2.0 * math.pi * (0.5 * bore + outward) * area


def load_times_speed(radius: float, wear: float) -> float:
    """Mean load times sliding speed that wears an edge to that radius in the trial, W."""
    return rounded_off(radius, _BORE) / (float(worn_volume(wear, 1.0, 1.0)) * 3600.0 * HOURS)


def cases() -> Iterator[Case]:
    """What 300 hours and a rounding of 1 to 1.5 mm say of load and power, then slip over balance."""
    track = _BORE * 0.5 * 500.0 * math.pi / 30.0  # m/s at 500 rpm
    for state, wear in WEAR.items():
        low, high = (load_times_speed(radius, wear) for radius in ROUNDING)
        least, most = FRICTION[state]
        yield CLAIMS.case(
            "bush",
            f"{low:.2g} to {high:.2g} W, of which friction {least * low:.2g} to {most * high:.2g} W",
            high / track > _BELT,
            **{"name": f"bush-{state.removesuffix(' %')}", "state": state, "belt": _BELT},
            load=f"{low / track:.0f} to {high / track:.0f}",
        )
    loaded, free = (_bearings(unbalance) for unbalance in _UNBALANCE)
    least = float(loaded.least_load[0, -1])
    same = bool(np.all(loaded.load[:, -1] > free.load[:, -1]) and np.all(free.slip >= loaded.slip))
    yield CLAIMS.case(
        "load-and-slip",
        f"{_newtons(loaded.load)} with it, {_newtons(free.load)} without: slip {_most(loaded.slip)} and "
        f"{_most(free.slip)} of rolling",
        same and _most(free.slip) != _most(loaded.slip),
        least=least,
    )


def _bearings(unbalance: float) -> BearingLife:
    """Bearings 60203 of the example's tub without liquid, so much unbalance in its drum, kg m."""
    changed = {f"rotor.bearings.{k}.dynamic_rating": _RATING for k in (0, 1)}
    changed |= {"rotor.unbalance": unbalance, "speeds.count": 3, "chambers.0.volume": 0.0}
    life = run_scene(example("tub").replace(changed)).bearing_life
    assert isinstance(life, BearingLife)
    return life


def _newtons(load: Array) -> str:
    return " and ".join(f"{each:.0f} N" for each in load[:, -1])


def _most(slip: Array) -> str:
    return f"{100.0 * float(slip[:, -1].max()):.0f} %"
