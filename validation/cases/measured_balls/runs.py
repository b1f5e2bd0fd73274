"""Run-ups of the measured rig [RCFW11] with balls that resist to rolling, from many starts.

Kept in `validation/data/measured_balls_runs.json`; `python -m validation.cases.measured_balls.runs --anew`
makes them anew in a quarter of an hour.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path

import numpy as np

from fluid.friction.laws import NO_FRICTION
from meshes.arrays import Array
from solvers.runup.balls import Balls
from solvers.runup.linear import couple_linear
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from validation.cases.measured_balls.machine import RPM, WASHERS, known, race, rotor, speeds_read
from validation.study import launch, shown, stored

DATA = Path(__file__).parents[2] / "data" / "measured_balls_runs.json"
GRAVITY = 9.81
RESISTANCES = (0.0, 3e-4, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 3.5e-3, 4e-3, 6e-3)
BEST = 3e-3  # of those the one whose levels are nearest to the measured ones, a test asks
WEIGHTLESS = (0.0, 1e-4, 3e-4, 6e-4, 1e-3, 2e-3)
DRAGS = (1e-3, 1e-2, 1e-1)  # N s/m: a ball's own speed fades within 0.6 s, 0.06 s, 6 ms
# Each speed is held for half a second, in steps of 10 rpm.
RATE = 20.0 * RPM
_FROM, _TO, _ABOVE = 600.0, 5000.0, 4000.0  # rpm; of the levels
_SLOW = 300.0  # rpm, from which runs up and down begin
_STARTS, _FEW = 4, 2  # places of the balls at the start, of levels and of whole curves
_WINDOW, _NEAR = 0.25, 25.0  # s, of which the largest is taken; rpm, within which points are a speed's
_CELLS = 32  # 50 steps a turn; twice as many change levels by 1 %, as other starts do


@dataclass(frozen=True)
class Level:
    """Amplitudes from 4000 to 5000 rpm of all starts, with every drag, one resistance and gravity."""

    resistance: float
    gravity: float  #: m/s^2, across the axis
    washers: int
    amplitude: tuple[float, ...]  #: um, by drag, then by start


@dataclass(frozen=True)
class Curve:
    """Amplitudes at the speeds that were measured, on one way up and down."""

    resistance: float
    washers: int
    drag: float  #: N s/m
    up: tuple[float, ...]  #: um
    down: tuple[float, ...]


@dataclass(frozen=True)
class Kept:
    """All runs."""

    levels: tuple[Level, ...]
    curves: tuple[Curve, ...]


def starts(count: int) -> Array:
    """Angles of the two balls in the drum when a run begins, rad, shape (count, 2)."""
    return np.random.default_rng(1).uniform(0.0, 2.0 * math.pi, (_STARTS, 2))[:count]


def run(
    washers: int, resistance: float, drag: float, places: Array, gravity: float, start: float, back: bool
) -> RunupHistory:
    """One run up, and down again; start in rpm."""
    system, own = rotor(washers).system(), race(resistance, drag)
    balls = Balls((own,), tuple(places.tolist()), (1.0, 1.0))
    rise = (_TO - start) * RPM / RATE
    drive = Ramp(start * RPM, _TO * RPM, RATE, rise, back)
    # Forty samples a second on curves, of which the largest of ten is taken; few of levels.
    samples = math.ceil(40.0 * rise * (1 + back)) if back else 400
    numerics = RunupNumerics(cells=_CELLS, samples=samples, companion=False)
    model = partial(couple_linear, balls=balls, position=own.position)
    found = run_up(system, (), drive, NO_FRICTION, gravity, numerics, model=model)
    assert found.converged and not found.audit.faults
    return found


def seen(history: RunupHistory, washers: int) -> Array:
    """Mean over the bearings of the distance from the axis at rest, m."""
    system, found = rotor(washers).system(), np.zeros(history.time.shape)
    for place in known()["bearings_position"]:
        first, second = system.at(place) @ history.coordinates.T
        found += 0.5 * np.hypot(first, second)
    return found


def level_of(washers: int, resistance: float, drag: float, places: Array, gravity: float) -> float:
    """Mean amplitude from 4000 to 5000 rpm, m, where the orbit is nearly a circle."""
    history = run(washers, resistance, drag, places, gravity, _FROM, False)
    return float(seen(history, washers)[history.speed > _ABOVE * RPM].mean())


def curve_of(washers: int, resistance: float, drag: float, places: Array) -> tuple[Array, Array]:
    """Amplitudes as they were measured at each speed, up and down, m."""
    history = run(washers, resistance, drag, places, GRAVITY, _SLOW, True)
    size, rising = seen(history, washers), history.time < 0.5 * history.time[-1]
    found = []
    for way in (rising, ~rising):
        row = []
        for rpm in speeds_read():
            near = way & (np.abs(history.speed / RPM - rpm) < _NEAR)
            window = np.floor(history.time[near] / _WINDOW)
            row.append(np.median([size[near][window == k].max() for k in np.unique(window)]))
        found.append(np.array(row))
    return found[0], found[1]


def _levels(resistance: float, gravity: float, washers: int) -> Level:
    sizes = [
        1e6 * level_of(washers, resistance, drag, places, gravity)
        for drag in DRAGS
        for places in starts(_STARTS)
    ]
    return Level(resistance, gravity, washers, tuple(sizes))


def _curves(resistance: float, washers: int, drag: float) -> Curve:
    both = [curve_of(washers, resistance, drag, places) for places in starts(_FEW)]
    up, down = (1e6 * np.median(part, axis=0) for part in zip(*both, strict=True))
    return Curve(resistance, washers, drag, tuple(up.tolist()), tuple(down.tolist()))


def measure() -> Kept:
    """All runs anew."""
    asked = [(f, GRAVITY) for f in RESISTANCES] + [(f, 0.0) for f in WEIGHTLESS]
    levels = tuple(_levels(f, gravity, washers) for f, gravity in asked for washers in WASHERS)
    curves = tuple(_curves(f, washers, drag) for f in (0.0, BEST) for washers in WASHERS for drag in DRAGS)
    return Kept(levels, curves)


_read, _write = stored(DATA, Kept, digits=4, compact=True)


@cache
def kept() -> Kept:
    """The kept runs."""
    return _read()


def _keep() -> str:
    _write(measure())
    return str(DATA)


if __name__ == "__main__":
    launch(shown(anew=_keep))
