"""Measured and fitted quantities of a machine, and their residuals."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import MM, MM_PEAK, RPM
from leblanc.plotting.page import Caption, Figure, Frame, lay_out, number, style
from leblanc.studies.fit.answer import FitAnswer, Measured
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports
FRAME = Frame(left=0.78, top=0.12, between=0.14, below=0.42)
DATA, LINE = "0.15", "#0072B2"
# What is drawn across: its factor from SI units, and what it is called.
_OVER = {"speed": (RPM, "Speed (rpm)"), "time": (1.0, "Time (s)"), "added": (1e6, "Liquid added (ml)")}
_HEIGHTS = 2.2, 0.9  # inches: the quantity, what is left of it


def fit_figure(answer: FitAnswer) -> Figure:
    """Each measured quantity with the fitted one over speed or time, and below it the residuals."""
    factor, label = _OVER[answer.over]
    with style():
        figure = Figure()
        panels: list[list[Axes]] = []
        for k, part in enumerate(answer.measured):
            panels += [[figure.add_axes((0, 0, 1, 1), label=f"{k}{row}")] for row in "ab"]
            curve = None if answer.curve is None else (answer.curve.at * factor, answer.curve.values[k])
            _draw(panels[-2][0], panels[-1][0], answer.at * factor, part, curve, labelled=k == 0)
        for (axes,) in panels:
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=axes is panels[-1][0])
        panels[-1][0].set_xlabel(label)
        lay_out(figure, panels, list(_HEIGHTS) * len(answer.measured), FRAME, _caption(answer))
        figure.alt = (
            "Measured points and the fitted line, with their residuals below; "
            f"{100.0 * answer.residual_rms:.2g} % of the measured size."
        )
    return figure


def _draw(
    above: Axes,
    below: Axes,
    over: Array,
    part: Measured,
    curve: tuple[Array, Array] | None,
    labelled: bool,
) -> None:
    """One quantity with the fitted curve, and its residuals."""
    angle, bare = part.unit == "rad", part.unit == ""
    factor = 180.0 / np.pi if angle else 1.0 if bare else MM
    unit = "deg" if angle else "as measured" if bare else "mm"
    mark = {"linestyle": "", "marker": "o", "markersize": 3.5, "markerfacecolor": "white"}
    names = ("measured", "fitted") if labelled else ("_", "_")
    above.plot(over, part.value * factor, color=DATA, label=names[0], zorder=3, **mark)
    at, fitted = (over, part.fitted) if curve is None else curve
    above.plot(at, fitted * factor, color=LINE, linewidth=1.4, label=names[1])
    left = part.value - part.fitted
    left = np.angle(np.exp(1j * left)) if angle else left
    below.axhline(0.0, color="0.6", linewidth=0.8)
    below.plot(over, left * factor, color=DATA, **mark)
    for axes in (above, below):
        axes.margins(y=0.12)  # no mark is cut at the edge
    words = part.name.replace("_", " ").capitalize()
    peak = unit == "mm" and part.name in ("amplitude", "peak")
    above.set_ylabel(f"{words}\n({MM_PEAK if peak else unit})")
    below.set_ylabel(f"left ({unit})")


def _caption(answer: FitAnswer) -> Caption:
    found = "; ".join(_found(answer, k) for k in range(len(answer.unknown)))
    over = "liquid added" if answer.over == "added" else answer.over
    return Caption(
        f"Measured and fitted over {over}, and their residuals.",
        f"Scene: {one_line(answer.name)}. Found, with standard errors: {found}. Left: "
        f"{100.0 * answer.residual_rms:.2g} % of the measured size.",
    )


def _found(answer: FitAnswer, k: int) -> str:
    """One value with its standard error, in the unit of the scene's file."""
    unit = answer.shown_in(k)
    std = float(answer.std[k]) * unit.count
    error = f" ± {std:.2g}" if np.isfinite(std) else ""
    return f"{answer.unknown[k]} = {unit.number(float(answer.value[k]))}{error} {unit.name}".rstrip()
