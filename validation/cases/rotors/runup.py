"""Run-ups of one upright machine over volume and friction; figures of another code."""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import known_liquid
from leblanc.core.units import LITRE, MM
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupNumerics, run_up
from solvers.statics.hydrostatics import optimal_volume
from solvers.synchronous.response import response
from solvers.whirl.edges import unstable_bands
from validation.cases.case import Case, Origin, compare

_MASS, _NATURAL, _UNBALANCE, _GRAVITY = 30.0, 25.0, 0.1, 9.81
ROTOR = Jeffcott(_MASS, _MASS * _NATURAL**2, 2.0 * 0.06 * _MASS * _NATURAL, _UNBALANCE)
CHAMBER = Chamber(0.25, 0.04)
RAMP = Ramp(5.0, 100.0, 8.0, 14.0)
RATES = (0.5, 1.0, 3.0, 10.0)  # 1/s
VOLUMES = tuple(np.round(np.geomspace(0.05e-3, 3e-3, 19), 6).tolist())  # m^3
_LAST = 1.0  # s, over which the end amplitude is a mean
# Peak, mm, its speed, rad/s, and amplitude at the end, mm, of another code for the same machine, whose
# friction takes the layer to rest at the rate k exactly; here the rate is k h R/A, 1.6 % more at 0.5 l.
GIVEN = (
    (0.0, 0.0, 22.4, 29.9, 3.55),
    (0.5e-3, 0.5, 18.71, 29.04, 2.75),
    (0.5e-3, 3.0, 16.88, 28.64, 2.779),
)


@dataclass(frozen=True)
class Point:
    """What one run-up came to."""

    volume: float  #: of water, m^3, and rate of the linear law, 1/s
    friction: float
    peak: float  #: largest amplitude, m, and the speed there, rad/s
    peak_speed: float
    end: float  #: mean amplitude over the last second, and the very last one, m
    last: float
    closure: float  #: of the energy balance; of the amplitude, nan if it was not estimated
    error: float
    converged: bool  #: the run came to its end


def run(volume: float, friction: float, cells: int = 128, check: bool = False) -> Point:
    """One run-up, volume and friction as in `Point`; check: estimate the error."""
    fills = [Fill(CHAMBER, known_liquid("water"), volume)] if volume > 0.0 else []
    numerics = RunupNumerics(cells=cells, companion=check)
    h = run_up(ROTOR.system(), fills, RAMP, Friction(FrictionLaw.LINEAR, friction), 0.0, numerics)
    k = int(np.argmax(h.largest))
    late = h.time >= h.time[-1] - _LAST
    return Point(
        volume=volume,
        friction=friction,
        peak=float(h.largest[k]),
        peak_speed=float(h.largest_speed[k]),
        end=float(np.mean(h.amplitude[late])),
        last=float(h.amplitude[-1]),
        closure=h.audit.closure,
        error=h.error_estimate,
        converged=h.converged,
    )


def sweep(
    volumes: Sequence[float] = VOLUMES, rates: Sequence[float] = RATES, cells: int = 128, workers: int = 2
) -> list[Point]:
    """All run-ups, friction by friction; volumes, m^3, rates, 1/s."""
    runs = [(volume, rate, cells) for rate in rates for volume in volumes]
    with ProcessPoolExecutor(max_workers=workers) as pool:
        return list(pool.map(run, *zip(*runs, strict=True)))


def steady_end(volumes: Sequence[float] = VOLUMES) -> Array:
    """Amplitude of the steady response at the final speed, m, shape (v,)."""
    found = []
    for volume in volumes:
        fills = [Fill(CHAMBER, known_liquid("water"), volume)]
        answer = response(ROTOR, fills, [RAMP.stop], _GRAVITY)
        found.append(float(abs(answer.deflection[0])))
    return np.array(found)


def best_volume(deflection: float) -> float:
    """Volume that just covers the wall at a deflection and the final speed, m^3."""
    return float(optimal_volume(CHAMBER, deflection, RAMP.stop, _GRAVITY))


def band(volumes: Sequence[float], friction: float) -> tuple[Array, Array]:
    """First and last speed at which some whirl grows, for each volume, rad/s; nan where none does."""
    rows = [[Fill(CHAMBER, known_liquid("water"), volume)] for volume in volumes]
    speed = np.linspace(RAMP.start, RAMP.stop, 191)
    bands = unstable_bands(ROTOR, rows, speed, Friction(FrictionLaw.LINEAR, friction))
    ends = [(row[0][0], row[-1][1]) if row else (math.nan, math.nan) for row in bands]
    low, high = np.array(ends).T
    return low, high


# The figures have three or four digits, and the other code's friction is 1.6 % weaker at half a litre.
_TOLERANCE = 0.012
_FRICTION = "the other friction brings a layer to rest at the rate k exactly, this one at k h R/A"
_SOURCE = "another code, validation/cases/rotors/runup.py"


def cases() -> list[Case]:
    """Peak, the speed there and the amplitude at the end, without liquid and with two frictions."""
    found = []
    for volume, rate, *given in GIVEN:
        point = run(volume, rate)
        name = f"{volume * LITRE:g}-l-{rate:g}"
        what = f"{volume * LITRE:g} l of water, friction {rate:g} 1/s" if volume else "no liquid"
        rows = (
            ("peak", "largest amplitude, mm", point.peak * MM),
            ("speed", "speed there, rad/s", point.peak_speed),
            ("end", "amplitude at the end, mm", point.last * MM),
        )
        for (kind, quantity, value), printed in zip(rows, given, strict=True):
            found.append(
                compare(
                    f"runup/{kind}-{name}",
                    _SOURCE,
                    f"{quantity}: {what}",
                    printed,
                    value,
                    tolerance=_TOLERANCE,
                    origin=Origin(
                        "second code", "run-ups written before the package had them, with its own friction"
                    ),
                    note=_FRICTION if volume else "",
                )
            )
    return found
