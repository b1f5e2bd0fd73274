"""The figure of an exciter: stuck speeds of its balls and the vibration of its platform over speed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import MM, MM_PEAK, RPM
from leblanc.plotting.page import (
    Caption,
    Figure,
    Frame,
    add_rate_axis,
    lay_out,
    number,
    style,
)
from leblanc.wings.exciter.answer import ExciterAnswer, ExciterExplanation, alt

FRAME = Frame(left=0.72, top=0.46, between=0.14, below=0.42)
TITLE = "Stuck speeds of the balls and vibration of the platform"
_BRANCHES = (
    ("stuck together, slowest", {"color": "C0", "linestyle": "-"}),
    ("middle (unstable)", {"color": "C1", "linestyle": ":"}),
    ("fastest", {"color": "C2", "linestyle": "--"}),
)
_HELD = {"linestyle": "none", "marker": "o", "markerfacecolor": "white", "markeredgecolor": "black"}
_LOST = {"linestyle": "none", "marker": "x", "markeredgecolor": "black", "markersize": 6.0}


def exciter_figure(result: ExciterAnswer) -> Figure:
    """Stuck speeds above, slow and fast vibration below, time integrations as marks.

    Parameters
    ----------
    result : the answer
    """
    with style():
        figure = Figure()
        figure.alt = alt(result)
        above: Any = figure.add_axes((0, 0, 1, 1), label="stuck")
        below: Any = figure.add_axes((0, 0, 1, 1), label="vibration")
        _draw_stuck(above, result)
        _draw_vibration(below, result)
        low, high = float(result.speed.min()) * RPM, float(result.speed.max()) * RPM
        margin = 0.01 * (high - low) if high > low else 1.0
        for axes in (above, below):
            axes.set_yscale("log")
            axes.set_xlim(low - margin, high + margin)
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.yaxis.set_minor_formatter("")
            _mark_critical(axes, result)
        above.tick_params(labelbottom=False)
        below.set_xlabel("Shaft speed (rpm)")
        add_rate_axis(above, "Shaft speed (rad/s)")
        lay_out(figure, [[above], [below]], [2.3, 1.8], FRAME, _caption(result))
    return figure


def _draw_stuck(axes: Any, result: ExciterAnswer) -> None:
    """Branches, and where the time integrations stand on them."""
    for column, (label, look) in enumerate(_BRANCHES):
        if np.isfinite(result.stuck_speeds[:, column]).any():
            axes.plot(result.speed * RPM, result.stuck_speeds[:, column] * RPM, label=label, **look)
    axes.axhline(
        result.machine.natural_frequency * RPM, color="0.45", linewidth=0.7, label="natural frequency"
    )
    _draw_checks(axes, result, "stuck_speed", RPM)
    # Crosses on the slowest branch where the balls leave it or do not come to it.
    lost = [check.speed for check in result.checks if not check.holds]
    if lost:
        places = np.interp(lost, result.speed, result.stuck_speeds[:, 0])
        axes.plot(np.array(lost) * RPM, places * RPM, label="time integration, balls leave", **_LOST)
    axes.set_ylabel("Speed of the balls (rpm)")


def _draw_vibration(axes: Any, result: ExciterAnswer) -> None:
    """Amplitudes with the balls and with the shaft; that of the balls only where they stay."""
    slow = np.where(result.dual_frequency, result.amplitude_slow, np.nan)
    axes.plot(result.speed * RPM, slow * MM, color="C0", label="slow vibration, with the balls")
    if np.any(result.amplitude_fast > 0.0):
        look = {"color": "C3", "linestyle": "-."}
        axes.plot(
            result.speed * RPM, result.amplitude_fast * MM, label="fast vibration, with the shaft", **look
        )
    _draw_checks(axes, result, "slow", MM)
    _draw_checks(axes, result, "fast", MM)
    axes.set_ylabel(f"Amplitude ({MM_PEAK})")


def _draw_checks(axes: Any, result: ExciterAnswer, quantity: str, unit: float) -> None:
    """Marks of the time integrations in which the balls stay."""
    mine = [check for check in result.checks if check.holds and math.isfinite(getattr(check, quantity))]
    mine = [check for check in mine if getattr(check, quantity) > 0.0]
    if mine:
        values = [getattr(check, quantity) * unit for check in mine]
        axes.plot(
            [check.speed * RPM for check in mine], values, label="time integration, balls stay", **_HELD
        )


def _mark_critical(axes: Any, result: ExciterAnswer) -> None:
    """Line at the critical speed, hatched beyond."""
    if not math.isfinite(result.critical_speed) or result.critical_speed >= float(result.speed.max()):
        return
    look = {"facecolor": "none", "edgecolor": "0.75", "hatch": "///", "linewidth": 0.0}
    end = axes.get_xlim()[1]
    axes.axvspan(result.critical_speed * RPM, end, label="beyond the critical speed", zorder=0, **look)
    axes.axvline(result.critical_speed * RPM, color="0.25", linewidth=0.9)


def _caption(result: ExciterAnswer) -> Caption:
    numbers, known = result.dimensionless, result.characteristic
    critical = f"{result.critical_speed * RPM:.0f} rpm" if math.isfinite(result.critical_speed) else "none"
    three = (
        f"Three stuck speeds from {known[0] * RPM:.0f} to {known[2] * RPM:.0f} rpm. "
        if math.isfinite(known[0])
        else "One stuck speed at every shaft speed. "
    )
    start = {
        "released": "platform at rest, balls on their way at the natural frequency",
        "regime": "in the dual-frequency motion",
        "rest": "platform and balls at rest",
    }[result.start.kind]
    assumed = assumed_words(result.assumed)
    return Caption(
        f"{three}Critical speed {critical}, started with {start}, {result.start.separation:g} rad apart. "
        f"Lines: lowest order in the balls' share of the mass ({numbers.smallness:.3g}); drag "
        f"{numbers.drag:.3g}, unbalance {numbers.unbalance:.3g}, damping ratio {numbers.damping:.3g}; no "
        "gravity.",
        f"Scene: {one_line(result.name)}. Assumed: {assumed}.",
    )


def stuck_range_figure(answer: ExciterExplanation) -> Figure:
    """Speeds of the shaft at which the balls have three stuck speeds, beside the speeds of the scene.

    Parameters
    ----------
    answer : the vibrating table in numbers
    """
    begin, through, end = (speed * RPM for speed in answer.characteristic)
    unit = answer.natural_frequency * RPM
    low, high = (ratio * unit for ratio in answer.speed_ratio)
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        axes.plot([low, high], [1.0, 1.0], color="0.3", linewidth=6, label="speeds of the scene")
        if math.isfinite(begin):
            axes.plot([begin, end], [0.0, 0.0], color="#0072B2", linewidth=6, label="three stuck speeds")
        for speed, look, name in (
            (unit, ":", "natural frequency"),
            (through, "-.", "slowest stuck speed at the resonance"),
            (answer.critical_speed_printed * RPM, "--", "critical speed, the source's regression"),
        ):
            if math.isfinite(speed):
                axes.axvline(speed, color="black", linestyle=look, linewidth=0.9, label=name)
        axes.set_ylim(-0.7, 1.7)
        axes.set_yticks([])
        axes.set_xlabel("Shaft speed (rpm)")
        axes.xaxis.set_major_formatter(number)
        add_rate_axis(axes, "Shaft speed (rad/s)")
        figure.alt = (
            f"Ranges of the shaft's speed: the scene from {low:.5g} to {high:.5g} rpm, three stuck speeds of "
            f"the balls from {begin:.5g} to {end:.5g} rpm."
        )
        text = "Speeds of the shaft at which the balls can stick together at three speeds."
        lay_out(figure, [[axes]], [1.2], FRAME, Caption(text, f"Scene: {one_line(answer.name)}."))
    return figure
