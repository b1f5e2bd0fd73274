"""DG21, Fig. 4 to 9, drawn again: `python -m validation.figures.rotors.tub --out docs/images`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save_png, style
from solvers.rotor.tub import Tub
from validation.cases.rotors.tub import FARTHEST, amplitude, suspended_tub
from validation.study import launch

_RPM = math.pi / 30.0
_FRAME = Frame(left=0.72, top=0.46, between=0.0, below=0.42)
_LINES = ("-", (0, (5, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5, 1, 1.5)))
_MARKS = "osD^v"
_ASSUMED = (
    "Linear vibration of the dry tub with the masses, springs, dampers and eccentricity of DG21, table 1; "
    "inertias, places and sideways stiffnesses are assumed."
)


@dataclass(frozen=True)
class Plot:
    """One figure."""

    name: str  #: stem of its file
    title: str  #: what it shows
    coordinate: str  #: of the tub's centre of mass
    label: str  #: of the axis
    lines: Sequence[tuple[str, Tub]]  #: label and machine of each line
    top: float = 300.0  #: largest speed, rpm


def plots() -> tuple[Plot, ...]:
    """The six figures of the source."""
    places = [(f"y_D = {1e3 * y:.0f} mm", suspended_tub(y)) for y in (0.0, 0.03, 0.06, FARTHEST)]
    shifts = (0.0, 0.025, 0.05, 0.075)
    turns = (0.0, 15.0, 30.0, 45.0)
    up, along = "Amplitude of z (mm)", "Amplitude of y (mm)"

    def shifted(y: float) -> list[tuple[str, Tub]]:
        return [(f"l_c = {1e3 * shift:.0f} mm", suspended_tub(y, shift)) for shift in shifts]

    springs = [
        (f"springs at {t:.0f}\N{DEGREE SIGN}", suspended_tub(FARTHEST, 0.0, math.radians(t))) for t in turns
    ]
    dampers = [
        (f"dampers at {t:.0f}\N{DEGREE SIGN}", suspended_tub(FARTHEST, 0.0, 0.0, math.radians(t)))
        for t in turns
    ]
    return (
        Plot("tub_fig4_vertical", "Vertical motion, after DG21, Fig. 4", "z", up, places),
        Plot("tub_fig5_longitudinal", "Motion along the axis, after DG21, Fig. 5", "y", along, places),
        Plot(
            "tub_fig6_rigidity_centre",
            "Vertical motion, after DG21, Fig. 6: rigidity centre l_c off the centre of gravity, y_D = 0",
            "z", up, shifted(0.0),
        ),
        Plot(
            "tub_fig7_rigidity_centre_far",
            "Vertical motion, after DG21, Fig. 7: rigidity centre l_c off, y_D = 90 mm",
            "z", up, shifted(FARTHEST),
        ),
        Plot(
            "tub_fig8_springs_turned",
            "Vertical motion, after DG21, Fig. 8: springs turned out of the plane, y_D = 90 mm",
            "z", up, springs,
        ),
        Plot(
            "tub_fig9_dampers_turned",
            "Vertical motion, after DG21, Fig. 9: dampers turned out of the plane, y_D = 90 mm",
            "z", up, dampers,
        ),
    )  # fmt: skip


def draw(plot: Plot) -> Figure:
    """Amplitude over speed, one line a machine."""
    speed = np.linspace(20.0, plot.top, 1121)
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        highest = 0.0
        for k, (label, machine) in enumerate(plot.lines):
            size = 1e3 * amplitude(machine, speed * _RPM, plot.coordinate)
            highest = max(highest, float(size.max()))
            axes.plot(
                *(speed, size),
                color=f"C{k}",
                linestyle=_LINES[k],
                marker=_MARKS[k],
                markerfacecolor="white",
                markevery=(40 + 35 * k, 140),
                linewidth=1.2,
                label=label,
            )
        axes.set_xlim(speed[0], speed[-1])
        axes.set_ylim(0.0, 1.08 * highest)
        axes.set_xlabel("Speed (rpm)")
        axes.set_ylabel(plot.label)
        for scale in (axes.xaxis, axes.yaxis):
            scale.set_major_formatter(number)
        above = axes.secondary_xaxis("top", functions=(lambda x: x * _RPM, lambda x: x / _RPM))
        above.set_xlabel("Speed (rad/s)")
        lay_out(figure, [[axes]], [2.75], _FRAME, f"{plot.title}. {_ASSUMED}")
    return figure


def main(out: Path = Path("out/tub")) -> list[Path]:
    """Write the figures as PNG."""
    return [save_png(draw(plot), out, plot.name, plot.title) for plot in plots()]


if __name__ == "__main__":
    launch(main)
