"""The figures of a response to an unbalance: amplitude, liquid and phase over speed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from leblanc.figures.campbell import campbell_figure
from leblanc.figures.caption import caption, zero_of
from leblanc.figures.chambers.along_axis import chamber_figure
from leblanc.figures.curves import Curves, prepare
from leblanc.figures.over_speed import draw_amplitude, draw_angle, draw_offset, draw_phase
from leblanc.figures.page import (
    Figure,
    FigureFiles,
    Frame,
    MultipleLocator,
    add_rate_axis,
    lay_out,
    number,
    save,
    style,
)
from leblanc.results.response import RunResult
from leblanc.text.run import alts
from leblanc.units import MM

Draw = Callable[[Any, Curves, RunResult], None]

FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)


def write_figures(result: RunResult, directory: Path) -> tuple[FigureFiles, ...]:
    """Draw all figures of a study and write each as PNG and SVG.

    One result gives the same files byte for byte, as long as the version of matplotlib stays the same.

    Parameters
    ----------
    result : the study
    directory : where the files go; made if it is missing
    """
    figures = [
        ("amplitude", "Amplitude over speed", amplitude_figure),
        ("liquid", "Liquid's centre of mass over speed", liquid_figure),
        ("phase", "Phase of the deflection over speed", phase_figure),
        ("chamber", "Chamber seen along the axis", chamber_figure),
    ]
    if result.motion is not None:
        figures.append(("campbell", "Natural frequencies over speed", campbell_figure))
    return tuple(save(draw(result), directory, name, title) for name, title, draw in figures)


def amplitude_figure(result: RunResult) -> Figure:
    """Amplitude over speed with and without liquid."""
    text = "Amplitude of the deflection."
    if result.motion is not None:
        text = f"Largest radius of the axis' orbit at {number(result.motion.position * MM)} mm."
    return _over_speed(result, "amplitude", [(2.75, draw_amplitude)], text)


def liquid_figure(result: RunResult) -> Figure:
    """Distance and angle of the liquid's centre of mass over speed."""
    panels = [(1.55, draw_offset), (1.55, draw_angle)]
    text = f"Centre of mass of the liquid: distance from the rotation axis, angle from {zero_of(result)}."
    return _over_speed(result, "liquid", panels, text)


def phase_figure(result: RunResult) -> Figure:
    """Phase of the deflection over speed with and without liquid."""
    text = f"Angle from {zero_of(result)} to the deflection; a lag is negative."
    return _over_speed(result, "phase", [(2.75, draw_phase)], text)


def _over_speed(result: RunResult, name: str, panels: Sequence[tuple[float, Draw]], text: str) -> Figure:
    """Panels above one another that share the speed, in rpm below and in rad/s above."""
    curves = prepare(result)
    with style():
        figure = Figure()
        figure.alt = alts(result)[name]
        rows = []
        for i, (_, draw) in enumerate(panels):
            axes: Any = figure.add_axes((0, 0, 1, 1), label=str(i))
            draw(axes, curves, result)
            axes.xaxis.set_major_formatter(number)
            if not axes.yaxis.get_label_text().endswith("(deg)"):
                axes.yaxis.set_major_formatter(number)
                axes.yaxis.set_minor_formatter("")
            else:
                axes.yaxis.set_major_locator(MultipleLocator(45.0))
            rows.append([axes])
        for (axes,) in rows[:-1]:
            axes.tick_params(labelbottom=False)
        rows[-1][0].set_xlabel("Speed (rpm)")
        add_rate_axis(rows[0][0])
        lay_out(figure, rows, [height for height, _ in panels], FRAME, caption(result, text))
    return figure
