"""The angle of the liquid on the horizontal rig, measured and computed [DR18, Fig. 24]."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.core.units import RPM
from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, style
from validation.cases.rotors.rigs import data
from validation.figures.rotors.runup_lag import steady

_FRAME = Frame(left=0.72, top=0.15, between=0.0, below=0.42)
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
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        for ratio, color, dashes in curves:
            angle = np.degrees(steady(speed / RPM, ratio)[1])
            look_text = f"damping ratio {ratio:.3f}" + (", fitted" if ratio == damping_ratio else "")
            axes.plot(speed, angle, color=color, linestyle=dashes, linewidth=1.4, label=look_text)
        marks = {"marker": "s", "linestyle": "none", "color": "black", "markerfacecolor": "white"}
        seen = np.array(measured["angle_deg"], dtype=float)
        axes.vlines(measured["speed_rpm"], seen - _READING, seen + _READING, color="black", linewidth=0.8)
        axes.plot(measured["speed_rpm"], seen, **marks, zorder=4, label="measured, DR18, Fig. 24")
        axes.set_xlim(speed[0], speed[-1])
        axes.set_ylim(-20.0, 200.0)
        axes.set_yticks(range(0, 181, 30))
        axes.xaxis.set_major_formatter(number)
        axes.set_xlabel("Speed (rpm)")
        axes.set_ylabel("Liquid behind the unbalance (deg)")
        text = (
            "Horizontal rig with two chambers of 100 and 130 mm diameter, 10 ml of water in each. Bars: half "
            "of the step of the readings. Lines: synchronous response with exact equilibrium of the liquid, "
            "without gravity, critical speed held at 1000 rpm. Assumed: 4 kg, 20 mm height, 10 g on a radius "
            "of 60 mm."
        )
        lay_out(figure, [[axes]], [2.75], _FRAME, text)
    return figure
