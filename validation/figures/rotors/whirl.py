"""Growth of self-excited whirl over speed, by linear theory and in time, drawn."""

from __future__ import annotations

from typing import Any

from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, style
from validation.cases.case import Case
from validation.cases.rotors.whirl import NATURAL, RANGE, growth_over_speed

_FRAME = Frame(left=0.72, top=0.15, between=0.0, below=0.42)


def growth_figure(in_time: list[Case]) -> Figure:
    """Growth rate over speed with four sets of damping, and the coupled model in time."""
    curves: tuple[tuple[str, float, Friction, str, Any], ...] = (
        ("no damping", 0.0, NO_FRICTION, "#0072B2", "-"),
        ("support 0.05", 0.05, NO_FRICTION, "#D55E00", (0, (5, 1.5))),
        (
            "support 0.05, laminar friction",
            0.05,
            Friction(FrictionLaw.STOKES),
            "#009E73",
            (0, (6, 1.5, 1, 1.5)),
        ),
        ("support 0.02, friction 30 1/s", 0.02, Friction(FrictionLaw.LINEAR, 30.0), "#CC79A7", (0, (1, 1.2))),
    )
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        axes.axhline(0.0, color="0.15", linewidth=0.8)
        for label, zeta, friction, color, dashes in curves:
            look = {"color": color, "linestyle": dashes, "linewidth": 1.4, "label": label}
            axes.plot(RANGE, growth_over_speed(zeta, friction), **look)
        marks = {"marker": "s", "linestyle": "none", "color": "black", "markerfacecolor": "white"}
        for case in in_time:
            ratio = float(case.name.rpartition("-")[2])
            assert isinstance(case.computed, float)
            axes.plot(ratio, case.computed / NATURAL, **marks, zorder=4, label="coupled long waves in time")
        axes.set_xlim(0.6, 2.4)
        axes.set_ylim(-0.03, 0.08)
        axes.xaxis.set_major_formatter(number)
        axes.yaxis.set_major_formatter(number)
        axes.set_xlabel("Spin speed over the natural frequency without liquid (\N{EN DASH})")
        axes.set_ylabel("Growth over the natural frequency (\N{EN DASH})")
        text = (
            "Growth rate of the small whirl that grows most; above zero it grows by itself. Planar rotor "
            "with one layer, m_f/M = 0.1, h0/R = 0.1; support: damping ratio. Exact linear theory of the "
            "plane layer; marks: coupled nonlinear long waves with dispersion, 256 cells, on the first and "
            "on the last of the lines."
        )
        lay_out(figure, [[axes]], [2.75], _FRAME, text)
    return figure


def in_time(cases: list[Case]) -> list[Case]:
    """Cases that were run in time."""
    return [case for case in cases if case.name.startswith("whirl/in-time-")]
