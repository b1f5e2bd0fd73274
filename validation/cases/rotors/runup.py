"""Run-ups of one upright machine over volume and friction; figures of another code."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import known_liquid
from leblanc.core.units import LITRE, MM, RPM
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupNumerics, run_up
from solvers.statics.hydrostatics import optimal_volume
from solvers.synchronous.response import response
from solvers.whirl.edges import unstable_bands
from validation.case import Case, Claims
from validation.page import Figure, Table, logarithmic, page
from validation.study import launch, shown

CLAIMS = Claims("runup")

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


_FRICTION = "the other friction brings a layer to rest at the rate k exactly, this one at k h R/A"


def cases() -> list[Case]:
    """Peak, the speed there and the amplitude at the end, without liquid and with two frictions."""
    found = []
    for volume, rate, *given in GIVEN:
        point = run(volume, rate)
        key = f"{volume * LITRE:g}-l-{rate:g}"
        what = f"{volume * LITRE:g} l of water, friction {rate:g} 1/s" if volume else "no liquid"
        rows = (
            ("peak", "largest amplitude, mm", point.peak * MM),
            ("speed", "speed there, rad/s", point.peak_speed),
            ("end", "amplitude at the end, mm", point.last * MM),
        )
        note = _FRICTION if volume else ""
        for (kind, size, value), printed in zip(rows, given, strict=True):
            words = {"kind": kind, "key": key, "size": size, "what": what, "note": note}
            found.append(CLAIMS.case("cases", value, printed=printed, **words))
    return found


_LOOKS: tuple[tuple[str, str, Any], ...] = (
    ("#0072B2", "o", "-"),
    ("#D55E00", "s", (0, (5, 1.5))),
    ("#009E73", "^", (0, (1, 1.2))),
    ("#CC79A7", "D", (0, (5, 1.2, 1, 1.2))),
)


def comparison() -> Table:
    """The figures given beside those computed."""
    rows = []
    for volume, rate, peak, speed, end in GIVEN:
        found = run(volume, rate, check=volume > 0.0)
        rows.append(
            (
                *(f"{volume * LITRE:g} l", f"{rate:g}", f"{peak}", f"{found.peak * MM:.2f}", f"{speed}"),
                *(f"{found.peak_speed:.2f}", f"{end}", f"{found.last * MM:.3f}"),
                *("" if math.isnan(found.error) else f"{found.error:.1%}", f"{found.closure:.0e}"),
            )
        )
    given = ("peak, mm: given", "here", "at rad/s: given", "here", "end, mm: given", "here")
    return Table(("water", "k, 1/s", *given, "error estimate", "energy left"), tuple(rows))


def table(points: Sequence[Point]) -> Table:
    """Peak and end over volume and friction."""
    rates = dict.fromkeys(point.friction for point in points)
    rows = [
        (
            f"{volume * LITRE:.3g}",
            *(
                f"{found.peak * MM:.2f} at {found.peak_speed:.1f}; {found.end * MM:.2f}"
                + ("" if found.converged else " (stopped)")
                for found in points
                if found.volume == volume
            ),
        )
        for volume in dict.fromkeys(point.volume for point in points)
    ]
    return Table(("water, l", *(f"k = {rate:g}" for rate in rates)), tuple(rows))


def trend_figure(points: Sequence[Point], dry: Point) -> Figure:
    """Run-up over volume and friction, with that without liquid."""
    volumes = list(dict.fromkeys(point.volume for point in points))
    litres = np.array(volumes) * LITRE
    with page([1.7, 1.4, 1.4], _CAPTION, top=0.12) as (figure, rows):
        panels = [axes for [axes] in rows]
        _lines(panels, points)
        panels[0].axhline(dry.peak * MM, **_DRY)
        panels[1].axhline(dry.peak_speed * RPM, **_DRY)
        panels[2].axhline(dry.end * MM, **_DRY)
        panels[2].plot(litres, steady_end(volumes) * MM, color="0.45", linewidth=2.6, alpha=0.6, zorder=1)
        panels[2].plot([], [], color="0.45", linewidth=2.6, alpha=0.6, label="steady response")
        _whirl(panels[1], volumes, points[0].friction)
        least = best_volume(float(steady_end(volumes)[-1])) * LITRE
        dashes = {"color": "0.15", "linewidth": 1.0, "linestyle": (0, (7, 3))}
        for axes in panels:
            axes.axvline(least, **dashes, label=f"{least:.2f} l cover the wall at the final speed")
            logarithmic(axes, x=[0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0])
            axes.set_xlim(0.92 * litres[0], 1.08 * litres[-1])
            axes.minorticks_off()
            axes.tick_params(labelbottom=axes is panels[-1])
        for axes, name in zip(panels, ("Peak (mm)", "Speed there (rpm)", "End (mm)"), strict=True):
            axes.set_ylabel(name)
        panels[-1].set_xlabel("Water (l)")
    return figure


_DRY: dict[str, Any] = {"color": "0.3", "linewidth": 1.0, "linestyle": (0, (1, 1.5)), "label": "no liquid"}
_CAPTION = (
    "Upright Jeffcott rotor, 30 kg, 25 rad/s, damping ratio 0.06, unbalance 0.1 kg m, one chamber of 250 mm "
    "radius and 40 mm height with water, run up from 5 to 100 rad/s at 8 rad/s\N{SUPERSCRIPT TWO} and held, "
    "14 s in all. Above: largest amplitude and the speed at which it occurs; below: mean amplitude over the "
    "last second. Annular long waves in time, 128 cells, linear wall friction of rate k. Shaded: speeds at "
    "which some whirl grows by itself by linear theory with the smallest friction."
)


def _lines(panels: Sequence[Any], points: Sequence[Point]) -> None:
    """One line for each friction in each panel."""
    for (color, mark, dashes), rate in zip(
        _LOOKS, dict.fromkeys(point.friction for point in points), strict=False
    ):
        mine = [point for point in points if point.friction == rate and point.converged]
        x = np.array([point.volume for point in mine]) * LITRE
        look: dict[str, Any] = {"color": color, "marker": mark, "linestyle": dashes, "linewidth": 1.2}
        look |= {"markersize": 3.5, "markerfacecolor": "white", "label": f"k = {rate:g} 1/s"}
        for axes, values in (
            (panels[0], [point.peak * MM for point in mine]),
            (panels[1], [point.peak_speed * RPM for point in mine]),
            (panels[2], [point.end * MM for point in mine]),
        ):
            axes.plot(x, values, **look)


def _whirl(axes: Any, volumes: Sequence[float], friction: float) -> None:
    """Speeds of self-excited whirl over volume, shaded."""
    x = np.geomspace(volumes[0], volumes[-1], 60)
    low, high = band(x.tolist(), friction)
    look = {"facecolor": "#F0E442", "alpha": 0.35, "hatch": "///", "edgecolor": "0.55", "linewidth": 0.0}
    axes.fill_between(x * LITRE, low * RPM, high * RPM, **look, label="self-excited whirl", zorder=0.5)


def main(out: Path, workers: int = 2) -> Iterator[object]:
    """Run the study in processes, draw and print it."""
    points = sweep(workers=workers)
    figure = partial(trend_figure, points, run(0.0, 0.0))
    yield from shown(comparison, partial(table, points), runup_trends=figure)(out)


if __name__ == "__main__":
    launch(main)
