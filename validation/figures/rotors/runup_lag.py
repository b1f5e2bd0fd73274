"""How fast a run-up may be to show the steady response: the horizontal rig at several rates.

`python -m validation.figures.rotors.runup_lag --out docs/images` draws its figure and tables of
docs/runup.md.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from fluid.friction.laws import Friction, FrictionLaw
from leblanc.results.runup import turn_mean
from meshes.arrays import Array, Complex
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupNumerics, run_up
from solvers.synchronous.response import response
from validation.cases.rotors.rigs import data, horizontal_rig, horizontal_rotor

_RPM = 2.0 * math.pi / 60.0
RATES = (40.0, 20.0, 10.0, 5.0, 2.5, 1.25)  # rad/s^2
FROM, TO = 400.0 * _RPM, 1500.0 * _RPM
# Clear of the start, where the rotor is pushed off from rest; through the resonance; and beyond it, where
# whirl grows by itself.
LOOKED, BEYOND = (550.0 * _RPM, 1100.0 * _RPM), (1100.0 * _RPM, 1450.0 * _RPM)
_GRAVITY = 9.81
_COLORS = ("#CC79A7", "#E69F00", "#D55E00", "#009E73", "#56B4E9", "#0072B2")
_DASHES = ((0, (1, 1)), (0, (4, 1, 1, 1)), (0, (3, 1.5)), (0, (6, 2)), (0, (8, 1.5, 1, 1.5)), "-")


@dataclass(frozen=True)
class Lag:
    """A run-up of the rig and what it lacks of the steady response; k samples."""

    rate: float  #: of the ramp, rad/s^2
    speed: Array  #: rad/s, shape (k,)
    #: of the liquid behind the unbalance, means over turns, within half a turn of the steady one, rad, shape
    #: (k,)
    angle: Array
    #: largest distance of the deflection from the steady one, over the largest steady one: up through the
    #: resonance, and above it
    error: float
    beyond: float
    angle_error: float  #: largest error of the liquid's angle up through the resonance, rad
    angles: Array  #: of the liquid behind the unbalance at the speeds of the measurements, rad, shape (6,)
    closure: float  #: of the energy balance
    converged: bool  #: the run came to its end


def steady(speed: Array, damping_ratio: float) -> tuple[Complex, Array]:
    """Steady deflection, m, and angle of the liquid behind the unbalance, rad, shape (k,)."""
    rotor = horizontal_rotor(damping_ratio, 1000.0 * _RPM)
    answer = response(rotor, horizontal_rig(), speed, gravity=0.0)
    return answer.deflection, -answer.liquid_angle


def lag(rate: float, damping_ratio: float, cells: int = 64, gravity: float = _GRAVITY) -> Lag:
    """Run up the rig at a rate, rad/s^2, its liquid a layer from the start.

    The damping ratio counts the liquid's added mass; gravity across the axis, m/s^2.
    """
    ramp = Ramp(FROM, TO, rate, (TO - FROM) / rate)
    turns = 0.5 * (TO**2 - FROM**2) / rate / (2.0 * math.pi)
    numerics = RunupNumerics(cells=cells, samples=max(400, int(12.0 * turns)), companion=False)
    rotor = horizontal_rotor(damping_ratio, 1000.0 * _RPM).system()
    h = run_up(rotor, horizontal_rig(), ramp, Friction(FrictionLaw.STOKES), gravity, numerics)
    deflection = turn_mean(h.deflection[:, 0] * np.exp(-1j * h.angle), h.angle)
    exact, exact_angle = steady(h.speed, damping_ratio)
    apart = np.angle(np.exp(-1j * exact_angle) / turn_mean(h.liquid_position, h.angle))
    off = np.abs(deflection - exact) / np.abs(exact).max()
    looked, beyond = ((h.speed >= low) & (h.speed <= high) for low, high in (LOOKED, BEYOND))
    measured = np.array(data("dr18_fig24.json")["speed_rpm"]) * _RPM
    return Lag(
        rate=rate,
        speed=h.speed,
        angle=exact_angle + apart,
        error=float(off[looked].max()),
        beyond=float(off[beyond].max()),
        angle_error=float(np.abs(apart[looked]).max()),
        angles=np.asarray(np.interp(measured, h.speed, exact_angle + apart)),
        closure=h.audit.closure,
        converged=h.converged,
    )


def fitted_damping() -> float:
    """Damping ratio fitted to the six angles by the steady response."""
    from validation.cases.rotors.rigs import horizontal_cases

    found = next(case for case in horizontal_cases() if case.name == "horizontal_rig/rotor-and-liquid")
    assert isinstance(found.computed, float)
    return found.computed


def orders(lags: Sequence[Lag]) -> list[float]:
    """Exponents of the error over the rate, from each to the next."""
    return [
        math.log(point.error / other.error) / math.log(point.rate / other.rate)
        for point, other in pairwise(lags)
    ]


def table(lags: Sequence[Lag], damping_ratio: float) -> str:
    """Errors and the six angles, as two tables in Markdown."""
    measured = data("dr18_fig24.json")
    lines = [
        "| rate, rad/s^2 | error to 1100 rpm | exponent | of the angle, deg | error beyond | energy left |",
        "|---|---|---|---|---|---|",
    ]
    for point, order in zip(lags, [math.nan, *orders(lags)], strict=True):
        exponent = "" if math.isnan(order) else f"{order:.2f}"
        lines.append(
            f"| {point.rate:g} | {point.error:.2%} | {exponent} | {math.degrees(point.angle_error):.1f} "
            f"| {point.beyond:.2%} | {point.closure:.0e} |"
        )
    head = " | ".join(f"{rpm:.0f} rpm" for rpm in measured["speed_rpm"])
    lines += ["", f"| liquid behind the unbalance, deg | {head} |", "|---|" + "---|" * 6]
    lines.append("| measured [DR18, Fig. 24] | " + " | ".join(map(str, measured["angle_deg"])) + " |")
    _, exact = steady(np.array(measured["speed_rpm"]) * _RPM, damping_ratio)
    rows = [("steady response", exact)] + [(f"{point.rate:g} rad/s^2", point.angles) for point in lags[::-1]]
    for name, angles in rows:
        lines.append(f"| {name} | " + " | ".join(f"{angle:.1f}" for angle in np.degrees(angles)) + " |")
    return "\n".join(lines)


def draw(lags: Sequence[Lag], damping_ratio: float, directory: Path) -> Path:
    """Angle over speed and error over rate as PNG and SVG; lags by falling rate."""
    from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style

    with style():
        figure = Figure()
        upper: Any = figure.add_axes((0, 0, 1, 1), label="angle")
        lower: Any = figure.add_axes((0, 0, 1, 1), label="error")
        _draw_angles(upper, lags, damping_ratio)
        upper.xaxis.set_major_formatter(number)
        _draw_errors(lower, lags)
        lower.xaxis.set_major_formatter(number)
        frame = Frame(left=0.72, top=0.12, between=0.52, below=0.42)
        text = (
            "Horizontal rig [DR18, section 7.2], water, run up from 400 to 1500 rpm with the liquid a layer "
            f"from the start. Damping ratio {damping_ratio:.3f}, fitted to the six angles by the steady "
            "response. Annular long waves in time, 64 cells, laminar friction, gravity across the axis; "
            "means over turns. Below: largest distance of the deflection from the steady one between 550 and "
            "1100 rpm and between 1100 and 1450 rpm, where slow run-ups leave whirl the time to grow by "
            "itself, over the largest steady one. Assumed: mass, damping, place of the unbalance, heights "
            "of the chambers."
        )
        lay_out(figure, [[upper], [lower]], [2.3, 1.6], frame, text, 8)
    return save(figure, directory, "runup_lag", "Lag of a run-up behind the steady response").png


def _draw_angles(axes: Any, lags: Sequence[Lag], damping_ratio: float) -> None:
    """Angle of the liquid over speed: measured, steady, and at each rate."""
    from leblanc.figures.drawing.curves import gapped

    measured = data("dr18_fig24.json")
    speed = np.linspace(LOOKED[0], BEYOND[1], 400)
    axes.plot(
        speed / _RPM, np.degrees(steady(speed, damping_ratio)[1]), color="black", label="steady response"
    )
    for point, color, dashes in zip(lags, _COLORS, _DASHES, strict=False):
        kept = (point.speed >= LOOKED[0]) & (point.speed <= BEYOND[1])
        rpm, degrees = point.speed[kept] / _RPM, np.degrees(point.angle[kept])
        look: dict[str, Any] = {"color": color, "linestyle": dashes, "linewidth": 1.1}
        axes.plot(
            *gapped(rpm, degrees, np.abs(np.diff(degrees)) > 180.0),
            **look,
            label=f"{point.rate:g} rad/s\N{SUPERSCRIPT TWO}",
        )
    mark = {"color": "black", "markersize": 5.0, "markerfacecolor": "white", "zorder": 5}
    error = {"elinewidth": 0.8, "capsize": 2.0, "linestyle": "none", "label": "measured, read to 30 deg"}
    axes.errorbar(measured["speed_rpm"], measured["angle_deg"], yerr=15.0, fmt="o", **mark, **error)
    axes.set_ylim(-35.0, 235.0)
    axes.set_yticks(range(0, 226, 45))
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel("Liquid behind\nthe unbalance (deg)")


def _draw_errors(axes: Any, lags: Sequence[Lag]) -> None:
    """Error over rate with a line of slope one through the slowest."""
    rates, errors = np.array([point.rate for point in lags]), np.array([point.error for point in lags])
    axes.loglog(rates, 100.0 * errors, "o-", color="#0072B2", label="error through the resonance")
    look: dict[str, Any] = {"color": "#D55E00", "marker": "s", "linestyle": (0, (3.5, 1.5))}
    beyond = 100.0 * np.array([point.beyond for point in lags])
    axes.loglog(rates, beyond, markerfacecolor="white", linewidth=1.1, label="error beyond it", **look)
    guide = {"color": "0.4", "linewidth": 1.0, "linestyle": (0, (6, 2))}
    axes.loglog(rates, 100.0 * errors[-1] * rates / rates[-1], **guide, label="in proportion to the rate")
    axes.set_xticks(rates)
    axes.set_yticks([1.0, 3.0, 10.0, 30.0, 100.0], ["1", "3", "10", "30", "100"])
    axes.minorticks_off()
    axes.set_xlabel("Rate (rad/s\N{SUPERSCRIPT TWO})")
    axes.set_ylabel("Error (%)")


def main(arguments: list[str] | None = None) -> int:
    """Run the study.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code
    """
    parser = argparse.ArgumentParser(
        prog="python -m validation.figures.rotors.runup_lag", description=__doc__
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the figure")
    parser.add_argument("--workers", type=int, default=2, help="processes [default: 2]")
    chosen = parser.parse_args(arguments)
    damping_ratio = fitted_damping()
    with ProcessPoolExecutor(max_workers=chosen.workers) as pool:
        lags = list(pool.map(partial(lag, damping_ratio=damping_ratio), RATES))
    draw(lags, damping_ratio, chosen.out)
    print(f"damping ratio {damping_ratio:.4f}", "", table(lags, damping_ratio), sep="\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
