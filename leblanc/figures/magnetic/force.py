"""Force of magnets and motor over the deflection of a rotor."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import LENGTH, with_unit
from leblanc.figures.drawing.page import Caption, Figure, Frame, lay_out, style
from leblanc.results.magnetic.explanation import MagneticExplanation

UM = 1e6


def force_figure(answer: MagneticExplanation) -> Figure:
    """Force outwards over the deflection, with the largest current home, without and with the largest out.

    Parameters
    ----------
    answer : a rotor in numbers
    """
    looks = (("C0", "-", "largest current home"), ("0.3", "--", "bias current alone"), ("C1", "-.", "out"))
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        for force, (color, line, label) in zip(answer.force, looks, strict=True):
            axes.plot(answer.place * UM, force, color=color, linestyle=line, label=label)
        axes.axhline(0.0, color="0.45", linewidth=0.7)
        most = float(np.abs(answer.force[0]).max())
        axes.set_ylim(-1.5 * most, 4.0 * most)
        axes.set_xlim(0.0, float(answer.place[-1]) * UM)
        axes.set_xlabel("Deflection along an axis (um)")
        axes.set_ylabel("Force outwards (N)")
        figure.alt = (
            f"Force outwards over the deflection for three currents; the rotor comes home from "
            f"{with_unit(answer.reach, LENGTH)}."
        )
        text = "Force of both bearings and the motor on a rotor that does not lean."
        assumed = ", ".join(map(one_line, answer.assumed)) or "nothing"
        origin = f"Scene: {one_line(answer.name)}. Assumed: {assumed}."
        frame = Frame(left=0.72, top=0.12, between=0.0, below=0.42)
        lay_out(figure, [[axes]], [2.4], frame, Caption(text, origin))
    return figure
