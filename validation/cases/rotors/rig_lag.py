"""How fast a run-up may be to show the steady response: the horizontal rig at several rates.

`python -m validation.cases.rotors.rig_lag --out docs/images` draws its figure and tables of
docs/howto/runup.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from fluid.friction.laws import Friction, FrictionLaw
from leblanc.core.units import RPM
from leblanc.studies.runup.answer import turn_mean
from meshes.arrays import Array, Complex
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupNumerics, run_up
from solvers.synchronous.response import response
from validation.cases.rotors.rigs import horizontal_cases, horizontal_rig, horizontal_rotor
from validation.page import Figure, Table, page
from validation.study import data, launch, shown

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
    found = next(case for case in horizontal_cases() if case.name == "horizontal_rig/rotor-and-liquid")
    assert isinstance(found.computed, float)
    return found.computed


def orders(lags: Sequence[Lag]) -> list[float]:
    """Exponents of the error over the rate, from each to the next."""
    return [
        math.log(point.error / other.error) / math.log(point.rate / other.rate)
        for point, other in pairwise(lags)
    ]


def tables(lags: Sequence[Lag], damping_ratio: float) -> tuple[Table, Table]:
    """Errors by the rate, and the six angles."""
    errors = tuple(
        (
            *(f"{point.rate:g}", f"{point.error:.2%}", "" if math.isnan(order) else f"{order:.2f}"),
            *(f"{math.degrees(point.angle_error):.1f}", f"{point.beyond:.2%}", f"{point.closure:.0e}"),
        )
        for point, order in zip(lags, [math.nan, *orders(lags)], strict=True)
    )
    head = ("error to 1100 rpm", "exponent", "of the angle, deg", "error beyond", "energy left")
    measured = data("dr18_fig24.json")
    _, exact = steady(np.array(measured["speed_rpm"]) * _RPM, damping_ratio)
    rows = [("steady response", exact)] + [(f"{point.rate:g} rad/s^2", point.angles) for point in lags[::-1]]
    told = [(name, *(f"{angle:.1f}" for angle in np.degrees(angles))) for name, angles in rows]
    given = ("measured [DR18, Fig. 24]", *map(str, measured["angle_deg"]))
    speeds = (f"{rpm:.0f} rpm" for rpm in measured["speed_rpm"])
    angles_of = Table(("liquid behind the unbalance, deg", *speeds), (given, *told))
    return Table(("rate, rad/s^2", *head), errors), angles_of


def lag_figure(lags: Sequence[Lag], damping_ratio: float) -> Figure:
    """Lag of a run-up behind the steady response: angle over speed, error over rate; lags by falling rate."""
    text = (
        "Horizontal rig [DR18, section 7.2], water, run up from 400 to 1500 rpm with the liquid a layer "
        f"from the start. Damping ratio {damping_ratio:.3f}, fitted to the six angles by the steady "
        "response. Annular long waves in time, 64 cells, laminar friction, gravity across the axis; "
        "means over turns. Below: largest distance of the deflection from the steady one between 550 and "
        "1100 rpm and between 1100 and 1450 rpm, where slow run-ups leave whirl the time to grow by "
        "itself, over the largest steady one. Assumed: mass, damping, place of the unbalance, heights "
        "of the chambers."
    )
    with page([2.3, 1.6], text, top=0.12, between=0.52) as (figure, [[upper], [lower]]):
        _draw_angles(upper, lags, damping_ratio)
        _draw_errors(lower, lags)
    return figure


def _draw_angles(axes: Any, lags: Sequence[Lag], damping_ratio: float) -> None:
    """Angle of the liquid over speed: measured, steady, and at each rate."""
    from leblanc.plotting.curves import gapped

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
    axes.set(yticks=range(0, 226, 45), xlabel="Speed (rpm)", ylabel="Liquid behind\nthe unbalance (deg)")


def _draw_errors(axes: Any, lags: Sequence[Lag]) -> None:
    """Error over rate with a line of slope one through the slowest."""
    rates, errors = np.array([point.rate for point in lags]), np.array([point.error for point in lags])
    axes.loglog(rates, 100.0 * errors, "o-", color="#0072B2", label="error through the resonance")
    look: dict[str, Any] = {"color": "#D55E00", "marker": "s", "linestyle": (0, (3.5, 1.5))}
    beyond = 100.0 * np.array([point.beyond for point in lags])
    axes.loglog(rates, beyond, markerfacecolor="white", linewidth=1.1, label="error beyond it", **look)
    guide = {"color": "0.4", "linewidth": 1.0, "linestyle": (0, (6, 2))}
    axes.loglog(rates, 100.0 * errors[-1] * rates / rates[-1], **guide, label="in proportion to the rate")
    axes.set_xticks(rates, [f"{rate:g}" for rate in rates])
    axes.set_yticks([1.0, 3.0, 10.0, 30.0, 100.0], ["1", "3", "10", "30", "100"])
    axes.minorticks_off()
    axes.set(xlabel="Rate (rad/s\N{SUPERSCRIPT TWO})", ylabel="Error (%)")


def main(out: Path, workers: int = 2) -> Iterator[object]:
    """Run the study in processes, draw and print it."""
    ratio = fitted_damping()
    with ProcessPoolExecutor(max_workers=workers) as pool:
        lags = list(pool.map(partial(lag, damping_ratio=ratio), RATES))
    yield f"damping ratio {ratio:.4f}"
    yield from shown(partial(tables, lags, ratio), runup_lag=partial(lag_figure, lags, ratio))(out)


_READING = 15.0  # deg


def angle_figure(damping_ratio: float) -> Figure:
    """Angle of the liquid behind the unbalance over speed; damping ratio fitted to the six angles."""
    measured = data("dr18_fig24.json")
    speed = np.linspace(500.0, 1500.0, 501)
    curves: tuple[tuple[float, str, Any], ...] = (
        (damping_ratio, "#0072B2", "-"),
        (0.5 * damping_ratio, "#56B4E9", (0, (5, 1.5))),
        (2.0 * damping_ratio, "#E69F00", (0, (1, 1.2))),
    )
    text = (
        "Horizontal rig with two chambers of 100 and 130 mm diameter, 10 ml of water in each. Bars: half "
        "of the step of the readings. Lines: synchronous response with exact equilibrium of the liquid, "
        "without gravity, critical speed held at 1000 rpm. Assumed: 4 kg, 20 mm height, 10 g on a radius "
        "of 60 mm."
    )
    with page([2.75], text) as (figure, [[axes]]):
        for ratio, color, dashes in curves:
            angle = np.degrees(steady(speed / RPM, ratio)[1])
            look_text = f"damping ratio {ratio:.3f}" + (", fitted" if ratio == damping_ratio else "")
            axes.plot(speed, angle, color=color, linestyle=dashes, linewidth=1.4, label=look_text)
        marks = {"marker": "s", "linestyle": "none", "color": "black", "markerfacecolor": "white"}
        seen = np.array(measured["angle_deg"], dtype=float)
        axes.vlines(measured["speed_rpm"], seen - _READING, seen + _READING, color="black", linewidth=0.8)
        axes.plot(measured["speed_rpm"], seen, **marks, zorder=4, label="measured, DR18, Fig. 24")
        axes.set(xlim=(speed[0], speed[-1]), ylim=(-20.0, 200.0))
        axes.set(yticks=range(0, 181, 30), xlabel="Speed (rpm)", ylabel="Liquid behind the unbalance (deg)")
    return figure


if __name__ == "__main__":
    launch(main)
