"""The figure of a scene with balls in numbers: growth of small motions about the balanced state."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import RPM
from leblanc.plotting.curves import speed_limits
from leblanc.plotting.page import Caption, Figure, Frame, add_rate_axis, lay_out, number, style
from leblanc.studies.explain.balls.answer import BallExplainAnswer, alt
from leblanc.studies.run.figure import DRY, WET

FRAME = Frame(left=0.72, top=0.46, between=0.14, below=0.42)


def numbers_figure(answer: BallExplainAnswer) -> Figure:
    """Growth over speed, with the speed from which on the rotor is balanced."""
    with style():
        figure = Figure()
        figure.alt = alt(answer)
        axes: Any = figure.add_axes((0, 0, 1, 1))
        rpm = answer.speed * RPM
        axes.plot(rpm, answer.growth, color=WET, linewidth=1.6, label="growth about the balanced state")
        axes.axhline(0.0, color="0.3", linewidth=0.8)
        marks = (
            (answer.machine.critical_speed_dry, DRY, "critical speed"),
            (answer.balanced_from, "#009E73", "balanced from here on"),
        )
        for speed, color, label in marks:
            if math.isfinite(speed):
                axes.axvline(speed * RPM, color=color, linestyle="--", linewidth=0.9, label=label)
        known = answer.growth[np.isfinite(answer.growth)]
        if known.size:
            # A growth that is large beside every decay would hide where the sign turns.
            low = float(known.min())
            axes.set_ylim(1.2 * min(low, 0.0), 1.2 * min(float(known.max()), 5.0 * abs(low)) or 1.0)
        axes.set_xlim(*speed_limits(answer.speed))
        axes.set_xlabel("Speed (rpm)")
        axes.set_ylabel("Growth (1/s)")
        axes.xaxis.set_major_formatter(number)
        axes.yaxis.set_major_formatter(number)
        add_rate_axis(axes)
        assumed = assumed_words(answer.assumed)
        origin = f"Scene: {one_line(answer.name)}. Assumed: {assumed}."
        lay_out(figure, [[axes]], [2.2], FRAME, Caption(figure.alt, origin))
    return figure
