"""The figure of a rotor in magnetic bearings: a trial in time, and what unbalances leave over speed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import RPM, in_rpm
from leblanc.figures.drawing.page import (
    Caption,
    Figure,
    FigureFiles,
    Frame,
    lay_out,
    number,
    save,
    style,
)
from leblanc.results.magnetic.control import MagneticResult
from leblanc.text.magnetic import NAMES, alt

TITLE = "Rotor in magnetic bearings"
UM, MA = 1e6, 1e3
_LOOKS: dict[str, dict[str, Any]] = {
    "synergetic": {"color": "C0", "linestyle": "-"},
    "pid": {"color": "C1", "linestyle": "--"},
}
_LEAST = 1e-5  # of the gap: what a logarithmic axis shows


def magnetic_figure(result: MagneticResult) -> Figure:
    """Deflection and currents of the trial in time, deflection by unbalances over speed.

    Parameters
    ----------
    result : the answer
    """
    with style():
        figure = Figure()
        figure.alt = alt(result)
        rows: list[list[Any]] = []
        if any(control.trial is not None for control in result.controllers):
            above: Any = figure.add_axes((0, 0, 1, 1), label="deflection")
            middle: Any = figure.add_axes((0, 0, 1, 1), label="current")
            _draw_deflection(above, result)
            _draw_current(middle, result)
            rows += [[above], [middle]]
        below: Any = figure.add_axes((0, 0, 1, 1), label="unbalance")
        _draw_unbalance(below, result)
        rows.append([below])
        heights = [1.9, 1.5, 1.3][-len(rows) :]
        frame = Frame(left=0.72, top=0.12, between=0.12, below=0.42, gaps=(0.12, 0.5)[-(len(rows) - 1) :])
        if len(rows) == 1:
            frame = Frame(left=0.72, top=0.12, between=0.12, below=0.42)
        lay_out(figure, rows, heights, frame, _caption(result), most_lines=6)
    return figure


def write_magnetic_figure(result: MagneticResult, directory: Path) -> FigureFiles:
    """Draw the figure and write it as PNG and SVG.

    Parameters
    ----------
    result : the answer
    directory : where the files go; made if it is missing
    """
    return save(magnetic_figure(result), directory, "magnetic", TITLE)


def _draw_deflection(axes: Any, result: MagneticResult) -> None:
    """Distance from the centre in the bearing where it is larger, on a logarithmic axis."""
    gap = result.machine.magnets.gap
    for control in result.controllers:
        if control.trial is None:
            continue
        motion = control.trial.motion
        shown = np.maximum(motion.distance, _LEAST * gap)
        axes.plot(motion.time, shown * UM, label=NAMES[control.name], linewidth=1.0, **_LOOKS[control.name])
    axes.axhline(gap * UM, color="0.25", linewidth=0.9, label="magnet")
    axes.axhline(result.band * UM, color="0.45", linewidth=0.8, linestyle=":", label="2 % of the gap")
    _mark_loads(axes, result)
    axes.set_yscale("log")
    axes.set_ylim(_LEAST * gap * UM, 2.0 * gap * UM)
    axes.yaxis.set_major_formatter(number)
    axes.yaxis.set_minor_formatter("")
    axes.tick_params(labelbottom=False)
    axes.set_ylabel("Deflection (um)")


def _draw_current(axes: Any, result: MagneticResult) -> None:
    """Largest of the four control currents."""
    for control in result.controllers:
        if control.trial is None:
            continue
        motion = control.trial.motion
        size = np.abs(motion.current).max(axis=-1)
        axes.plot(motion.time, size * MA, label=NAMES[control.name], linewidth=1.0, **_LOOKS[control.name])
    axes.axhline(
        result.machine.magnets.limit * MA, color="0.45", linewidth=0.8, linestyle="-.", label="most current"
    )
    _mark_loads(axes, result)
    axes.set_ylim(0.0, 1.1 * result.machine.magnets.limit * MA)
    axes.set_xlabel("Time (s)")
    axes.set_ylabel("Control current (mA)")


def _mark_loads(axes: Any, result: MagneticResult) -> None:
    """Lines where loads come on later."""
    end = max(control.trial.motion.time[-1] for control in result.controllers if control.trial is not None)
    for load in result.loads:
        if 0.0 < load.start < end:
            axes.axvline(
                load.start, color="0.25", linewidth=0.7, linestyle=(0, (1, 2)), label="load comes on"
            )
    axes.set_xlim(0.0, float(end))


def _draw_unbalance(axes: Any, result: MagneticResult) -> None:
    """Deflection by the unbalances over speed."""
    look = {"marker": "o"} if result.speed.size == 1 else {}
    for control in result.controllers:
        axes.plot(
            result.speed * RPM,
            control.amplitude * UM,
            label=NAMES[control.name],
            **_LOOKS[control.name],
            **look,
        )
    axes.set_yscale("log")
    axes.xaxis.set_major_formatter(number)
    axes.yaxis.set_major_formatter(number)
    axes.yaxis.set_minor_formatter("")
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel("By unbalances (um)")


def _caption(result: MagneticResult) -> Caption:
    assumed = ", ".join(map(one_line, result.assumed)) or "nothing"
    shown = "Deflection in a bearing by the unbalances alone, from the linear loop."
    if any(control.trial is not None for control in result.controllers):
        shown = (
            "Above: deflection in the bearing where it is larger and largest of four control currents in the "
            f"trial in time, at {in_rpm(result.load_speed)} in the mean. Below: deflection by the unbalances "
            "alone, from the linear loop."
        )
    return Caption(shown, f"Scene: {one_line(result.name)}. Assumed: {assumed}.")
