"""The figure of an explanation: which liquid model answers where."""

from __future__ import annotations

import math
from typing import Any

from leblanc.core.notes import EXACT, assumed_words, one_line
from leblanc.core.units import RPM
from leblanc.plotting.curves import speed_limits
from leblanc.plotting.page import Caption, Figure, Frame, add_rate_axis, lay_out, number, style
from leblanc.studies.explain.answer import ExplainAnswer
from leblanc.studies.run.words import error_words, speeds_words

FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
COLOURS = {"statics": "#0072B2", "linear": "#E69F00", "fem": "#009E73"}  # after Okabe and Ito
HATCHES = {"statics": "", "linear": "///", "fem": "..."}
MOST = 1.0  # relative error that is drawn at most


def model_figure(answer: ExplainAnswer) -> Figure:
    """Estimated error over speed, with the liquid model that answers there."""
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        axes.set_yscale("log")
        axes.set_ylim(0.1 * EXACT, 3.0 * MOST)
        for span in answer.models:
            known = math.isfinite(span.error)
            top = min(max(span.error, EXACT), MOST) if known else 3.0 * MOST
            look = {"facecolor": COLOURS.get(span.model, "0.5"), "hatch": HATCHES.get(span.model, "xx")}
            label = f"{span.model}{'' if known else ', error not known'}"
            axes.fill_between(
                *([span.first * RPM, span.last * RPM], [0.1 * EXACT] * 2, [top] * 2),
                alpha=0.75 if known else 0.25,
                edgecolor="black",
                linewidth=0.7,
                label=label,
                **look,
            )
        axes.axhline(answer.tolerance, color="black", linestyle="--", linewidth=0.9, label="tolerance")
        for speed, line, name in (
            (answer.critical_speed_dry, "-.", "critical speed without liquid"),
            (answer.critical_speed_wet, ":", "critical speed with liquid"),
        ):
            if math.isfinite(speed):
                axes.axvline(speed * RPM, color="0.3", linestyle=line, label=name)
        axes.set_xlim(*speed_limits(answer.speed))
        axes.set_xlabel("Speed (rpm)")
        axes.set_ylabel("Estimated relative error")
        axes.xaxis.set_major_formatter(number)
        add_rate_axis(axes)
        spans = "; ".join(f"{speeds_words(span)} rpm {span.model}" for span in answer.models) or "no liquid"
        figure.alt = f"Bars of the estimated error over speed, one for each range of a liquid model: {spans}."
        assumed = assumed_words(answer.assumed)
        origin = f"Scene: {one_line(answer.name)}. Assumed: {assumed}."
        largest = sorted(answer.models, key=lambda span: span.error if math.isfinite(span.error) else -1.0)
        worst = f"{error_words(largest[-1])} at most" if largest else "none without liquid"
        text = f"Liquid model at each speed and its estimated error, {worst}."
        lay_out(figure, [[axes]], [2.4], FRAME, Caption(text, origin))
    return figure
