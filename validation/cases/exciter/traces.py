"""The exciter's traces and trends [YF17, fig. 3 to 6, eq. 21].

Trends take minutes; they are kept in `validation/data/exciter_more.json`, which `python -m
validation.cases.exciter.traces --anew` makes anew.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from meshes.arrays import Array
from solvers.rotor.exciter.machine import Dimensionless, characteristic_speeds, platform_motion, stuck_speeds
from solvers.rotor.exciter.motion import Trace, critical_speeds, trace
from validation.case import Case
from validation.cases.exciter.speeds import CLAIMS, MACHINE, vibratory_table
from validation.page import Figure, logarithmic, page
from validation.study import data, launch, shown, write

DATA = Path(__file__).parents[2] / "data" / "exciter_more.json"
SPEED = 5.0
_PRINTED_GAP = 0.01105
# Curves of a panel: what runs along it, its values, what tells the curves apart, its values, the rest.
_DAMPINGS, _SMALL, _UNBALANCES = (0.01, 0.03, 0.07), (0.005, 0.01, 0.02), (0.0, 0.25, 0.5, 0.75, 1.0)
PANELS: tuple[tuple[str, tuple[float, ...], str, tuple[float, ...], dict[str, float]], ...] = (
    ("damping", (0.01, 0.025, 0.04, 0.055, 0.07), "smallness", _SMALL, {"drag": 0.4, "unbalance": 0.25}),
    ("drag", (0.1, 0.2, 0.35, 0.6), "damping", _DAMPINGS, {"smallness": 0.005, "unbalance": 0.25}),
    ("unbalance", _UNBALANCES, "damping", _DAMPINGS, {"smallness": 0.01, "drag": 0.4}),
    ("unbalance", _UNBALANCES, "smallness", _SMALL, {"drag": 0.4, "damping": 0.03}),
)
FIGURES = ("5a", "5b", "6a", "6b")
_SLACK = 0.03  # relative: a step against the trend up to this is the width of the search, 0.05 in speed


@dataclass(frozen=True)
class Traces:
    """Figure 3: the motion, its lowest order, and their difference."""

    motion: Trace  #: as integrated
    turns: Array  #: of the balls since the first sample, shape (s,)
    lowest: Array  #: v, v', v'' to lowest order, the balls' phase fitted, shape (3, s)
    gap: Array  #: largest difference of each over the largest of the motion, shape (3,)


@cache
def traces() -> Traces:
    """The typical experiment at n = 5, over three turns of the balls [YF17, fig. 3]."""
    motion = trace(MACHINE, SPEED)
    slowest = float(stuck_speeds(SPEED, MACHINE)[0])
    slow, fast = platform_motion(MACHINE, SPEED, slowest)
    # The constant of the balls' phase is free [YF17, eq. 8]: that of their mean over these turns.
    phase = float(np.mean(motion.ball_angle.mean(axis=1) - slowest * motion.time))
    turned = np.stack([slowest * motion.time + phase, SPEED * motion.time])
    waves, factors = np.array([[slow], [fast]]) * np.exp(1j * turned), 1j * np.array([[slowest], [SPEED]])
    lowest = np.stack([(waves * factors**k).sum(axis=0).imag for k in range(3)])
    seen = np.stack([motion.position, motion.velocity, motion.acceleration])
    gap = np.abs(seen - lowest).max(axis=1) / np.abs(seen).max(axis=1)
    return Traces(motion, slowest * (motion.time - motion.time[0]) / (2.0 * math.pi), lowest, gap)


def cases() -> Iterator[Case]:
    """Traces, critical speed in dimensions (eq. 21), and whether the curves of figures 5 and 6 go one way."""
    found = traces()
    names = ("displacement", "velocity", "acceleration")
    worst = float(found.gap.max())
    apart = ", ".join(f"{name} {100 * gap:.2f} %" for name, gap in zip(names, found.gap, strict=True))
    yield CLAIMS.case("trace-gap", worst, worst <= _PRINTED_GAP * 1.1, difference=apart)
    for key, printed, value, tolerance in (
        ("ball-speed-high", 0.97, found.motion.ball_speed.max(), 0.02),
        ("ball-speed-low", 0.92, found.motion.ball_speed.min(), 0.02),
        ("acceleration", 14.0, np.abs(found.motion.acceleration).max(), 0.1),
    ):
        words = {"key": key, "words": key.replace("-", " "), "tolerance": tolerance}
        yield CLAIMS.case("trace", float(value), printed=printed, **words)
    table = vibratory_table()
    own, damping = table.natural_frequency, 2.0 * table.damping * table.ball_damping
    exact = characteristic_speeds(table.dimensionless()).through_resonance * own
    given = own + table.ball_count * table.ball_mass**2 * own**3 / damping
    yield CLAIMS.case("eq-21", exact, printed=given)
    for figure, panel in zip(FIGURES, data(DATA.name)["panels"], strict=True):
        rises, along = panel["along"] == "unbalance", panel["along"]
        steps = [np.diff(curve) / np.array(curve[:-1]) for curve in panel["curves"]]
        worst = max(float(np.max(-step if rises else step)) for step in steps)
        same, shape = worst <= _SLACK, "rises" if rises else "falls"
        computed = f"{shape} all the way" if same else f"not all the way: {100 * worst:.0f} % against it"
        what = f"critical speed over {along}, {len(steps)} curves"
        yield CLAIMS.case("fig", computed, same, figure=figure, quantity=what, shape=shape)


def keep() -> None:
    """Measure the trends, in minutes, and keep them."""
    panels = []
    for along, values, apart, others, rest in PANELS:
        curves = []
        for other in others:
            machines = [Dimensionless(**{along: value, apart: other, **rest}) for value in values]
            curves.append([round(float(n), 3) for n in critical_speeds(machines, workers=2)])
        panels.append({"along": along, "values": values, "apart": apart, "others": others, "curves": curves})
    about = "Critical speeds of figures 5 and 6 of YF17, released, 0.3 rad apart; "
    write(DATA, {"about": f"{about}by validation.cases.exciter.traces.", "panels": panels})


_LETTERS = {
    "smallness": "\N{GREEK SMALL LETTER EPSILON}",
    "drag": "b",
    "unbalance": "\N{GREEK SMALL LETTER DELTA}",
    "damping": "h",
}
_LOOKS = (("C0", "o", "-"), ("C1", "s", "--"), ("C2", "^", "-."))


def trace_figure() -> Figure:
    """Speed of the balls, motion of the platform, and how far the lowest order is off [YF17, fig. 3]."""
    found = traces()
    seen = (found.motion.position, found.motion.velocity, found.motion.acceleration)
    names = ("displacement", "velocity", "acceleration")
    text = (
        "Dual-frequency motion at n = 5, eps = 0.01, b = 0.4, delta = 0.25, h = 0.03, in the machine\u2019s "
        "own units: speed of both balls, motion of the platform, and what it differs by from the lowest "
        "order (theory: balls, eq. 7), whose phase is fitted."
    )
    with page([1.2, 1.5, 1.2], text, top=0.2, between=0.3, below=0.45) as (figure, rows):
        balls, motion, gap = panels = [axes for [axes] in rows]
        for k, dashes in enumerate(("-", "--")):
            speed = found.motion.ball_speed[:, k]
            balls.plot(found.turns, speed, color="black", linestyle=dashes, label=f"ball {k + 1}")
        for name, values, lowest, (color, _, dashes) in zip(names, seen, found.lowest, _LOOKS, strict=True):
            motion.plot(found.turns, values, color=color, linestyle=dashes, label=name)
            gap.plot(found.turns, values - lowest, color=color, linestyle=dashes)
        balls.set_ylabel("Ball speed (\N{EN DASH})")
        motion.set_ylabel("Platform (\N{EN DASH})")
        gap.set(ylabel="Gap (\N{EN DASH})", xlabel="Turns of the balls (\N{EN DASH})")
        for axes in panels:
            axes.set_xlim(0.0, 3.0)
            axes.tick_params(labelbottom=axes is gap)
    return figure


def trend_figure() -> Figure:
    """Critical speed over damping, drag and unbalance, from the kept runs [YF17, fig. 5 and 6]."""
    text = (
        "Critical speed of the exciter with two balls, released 0.3 rad apart, no gravity; numbers that are "
        "not on a panel: b = 0.4, h = 0.03, delta = 0.25, and eps = 0.01 (0.005 in 5b)."
    )
    room = {"left": 0.6, "top": 0.25, "between": 0.75, "below": 0.45, "apart": 0.65}
    with page([2.0, 2.0], text, (2, 2), **room) as (figure, rows):
        panels = [axes for row in rows for axes in row]
        for name, panel, axes in zip(FIGURES, data(DATA.name)["panels"], panels, strict=True):
            apart = _LETTERS[panel["apart"]]
            for other, curve, (color, mark, dashes) in zip(
                panel["others"], panel["curves"], _LOOKS, strict=True
            ):
                axes.plot(panel["values"], curve, color=color, marker=mark, linestyle=dashes)
                axes.annotate(
                    f"{apart} = {other:g}",
                    (panel["values"][-1], curve[-1]),
                    # On panel 5b two curves end close together.
                    xytext=(3, {"C0": 3, "C1": -2}.get(color, 0) if name == "5b" else 0),
                    textcoords="offset points",
                    va="center",
                    fontsize=7,
                )
            low, high = panel["values"][0], panel["values"][-1]
            axes.set_xlim(low - 0.03 * (high - low), high + 0.3 * (high - low))
            logarithmic(axes, y=[5, 10, 20, 50, 100] if name == "5b" else [5, 7, 10, 15, 20])
            axes.set_xlabel(f"{panel['along'].capitalize()} {_LETTERS[panel['along']]} (\N{EN DASH})")
            axes.set_title(f"Figure {name}")
        for first, _ in rows:
            first.set_ylabel("Critical speed n (\N{EN DASH})")
    return figure


if __name__ == "__main__":
    launch(shown(anew=keep, exciter_traces=trace_figure, exciter_trends=trend_figure))
