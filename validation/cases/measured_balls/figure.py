"""The measured rig [RCFW11] drawn beside what the package computes."""

from __future__ import annotations

from typing import Any

import numpy as np

from validation.cases.measured_balls.cases import as_good, curves_of, levels
from validation.cases.measured_balls.machine import WASHERS, level, measured, plain, speeds_read
from validation.cases.measured_balls.runs import BEST, DRAGS, RESISTANCES
from validation.page import Figure, logarithmic, page
from validation.study import launch, shown

_UM = 1e6
_SHOWN = (1, 3)  # washers whose curves are drawn
_SEEN: dict[str, Any] = {"linestyle": "none", "markersize": 4.0, "zorder": 3.0}
_MARKS = (("plain", "o", "0.35", "without balls"), ("up", "^", "#D55E00", "with balls, up"),
          ("down", "v", "#0072B2", "with balls, down"))  # fmt: skip


def curves_figure() -> Figure:
    """Measured and computed amplitudes over speed, and the levels at full speed over the resistance."""
    least, most = as_good()
    text = (
        "Two balls on a rotor in unlike supports [RCFW11]: marks are measured, lines computed with supports "
        f"twice as stiff as printed; bands are runs up and down with a rolling resistance of {BEST:g} and "
        f"drags from {DRAGS[0]:g} to {DRAGS[-1]:g} N s/m. Below: amplitude from 4000 to 5000 rpm, median and "
        f"10 to 90 % of 12 runs up; with resistances from {least:g} to {most:g} (grey) it is about what was "
        "measured (dashed) with 0 to 3 washers."
    )
    room = {"left": 0.74, "top": 0.3, "between": 0.62, "below": 0.45, "apart": 0.5}
    with page([2.3, 2.2], text, (2, 1), **room) as (figure, (above, (below,))):
        figure.alt = (
            "Two panels of amplitude over speed with one and with three washers, measured marks beside "
            "computed lines and bands; below them the amplitude at full speed over the rolling resistance."
        )
        for axes, washers in zip(above, _SHOWN, strict=True):
            _draw_curves(axes, washers)
            axes.tick_params(labelleft=axes is above[0])
        above[0].set_ylabel("Amplitude (\N{MICRO SIGN}m 0-p)")
        _draw_levels(below, (least, most))
    return figure


def _draw_curves(axes: Any, washers: int) -> None:
    """Everything of one unbalance."""
    rpm, fine = speeds_read(), np.linspace(600.0, 5000.0, 881)
    axes.plot(fine, plain(washers, fine) * _UM, color="0.35", linewidth=1.0, label="computed, without balls")
    for way, color in (("up", "#D55E00"), ("down", "#0072B2")):
        each = np.array([getattr(curve, way) for curve in curves_of(BEST, washers)])
        axes.fill_between(rpm, each.min(axis=0), each.max(axis=0), color=color, alpha=0.2, linewidth=0.0)
        axes.plot(rpm, np.median(each, axis=0), color=color, linewidth=1.0, label=f"computed, {way}")
    for curve, mark, color, label in _MARKS:
        axes.plot(rpm, measured(curve, washers) * _UM, mark, color=color, label=f"measured, {label}", **_SEEN)
    axes.set_title("one washer" if washers == 1 else "three washers, which the balls just hold")
    logarithmic(axes, y=[1.0, 10.0, 100.0, 1000.0])
    axes.set(ylim=(3.0, 1500.0), xlim=(600.0, 5000.0), xlabel="Speed (rpm)")


def _draw_levels(axes: Any, good: tuple[float, float]) -> None:
    """Levels over the resistance, measured ones as lines across."""
    resistance = np.array(RESISTANCES) * 1e3
    axes.axvspan(good[0] * 1e3, good[1] * 1e3, color="0.9", zorder=0.0)
    for washers in WASHERS:
        color, found = f"C{washers}", [levels(f)[washers] for f in RESISTANCES]
        low, middle, high = np.percentile(found, [10.0, 50.0, 90.0], axis=1)
        moved = resistance + 0.03 * (washers - 2)
        look = {"color": color, "linewidth": 1.2, "capsize": 2.0, "marker": "o", "markersize": 3.5}
        label = f"{washers} washer{'' if washers == 1 else 's'}"
        axes.errorbar(moved, middle, yerr=[middle - low, high - middle], label=label, **look)
        axes.axhline(level("up", washers) * _UM, color=color, linestyle=(0, (4, 2)), linewidth=0.9)
    axes.set(xlabel="Rolling resistance (1/1000)", ylabel="Amplitude (\N{MICRO SIGN}m 0-p)")
    axes.set(xlim=(-0.2, 6.2), ylim=(0.0, 40.0))


if __name__ == "__main__":
    launch(shown(measured_balls=curves_figure))
