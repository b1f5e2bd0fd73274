"""Figures of a rotor in magnetic bearings: of `run` its trial and its orbits, of `explain` the forces."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import LENGTH, RPM, in_rpm, with_unit
from leblanc.plotting.page import (
    Caption,
    Figure,
    Frame,
    lay_out,
    number,
    style,
)
from leblanc.wings.magnetic.answer import NAMES, MagneticAnswer, MagneticExplanation, sentence

UM, MA = 1e6, 1e3
_LOOKS: dict[str, dict[str, Any]] = {
    "synergetic": {"color": "C0", "linestyle": "-"},
    "pid": {"color": "C1", "linestyle": "--"},
}
_LEAST = 1e-5  # of the gap: what a logarithmic axis shows


def magnetic_figure(result: MagneticAnswer) -> Figure:
    """Deflection and currents of the trial in time, deflection by unbalances over speed."""
    with style():
        figure = Figure()
        time = "deflection in a bearing and currents over time, and " if result.trials else ""
        figure.alt = f"Curves of {time}the deflection by unbalances over speed. {sentence(result)}"
        rows: list[list[Any]] = []
        if result.trials:
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
        lay_out(figure, rows, heights, frame, _caption(result))
    return figure


def _draw_deflection(axes: Any, result: MagneticAnswer) -> None:
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


def _draw_current(axes: Any, result: MagneticAnswer) -> None:
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


def _mark_loads(axes: Any, result: MagneticAnswer) -> None:
    """Lines where loads come on later."""
    end = max(motion.time[-1] for motion in result.trials)
    for load in result.loads:
        if 0.0 < load.start < end:
            axes.axvline(
                load.start, color="0.25", linewidth=0.7, linestyle=(0, (1, 2)), label="load comes on"
            )
    axes.set_xlim(0.0, float(end))


def _draw_unbalance(axes: Any, result: MagneticAnswer) -> None:
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


def _caption(result: MagneticAnswer) -> Caption:
    assumed = assumed_words(result.assumed)
    shown = "Deflection in a bearing by the unbalances alone, from the linear loop."
    if result.trials:
        shown = (
            "Above: deflection in the bearing where it is larger and largest of four control currents in the "
            f"trial in time, at {in_rpm(result.load_speed)} in the mean. Below: deflection by the unbalances "
            "alone, from the linear loop."
        )
    return Caption(shown, f"Scene: {one_line(result.name)}. Assumed: {assumed}.")


def force_figure(answer: MagneticExplanation) -> Figure:
    """Force outwards over the deflection, with the largest current home, without and with the largest out."""
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
        assumed = assumed_words(answer.assumed)
        origin = f"Scene: {one_line(answer.name)}. Assumed: {assumed}."
        frame = Frame(left=0.72, top=0.12, between=0.0, below=0.42)
        lay_out(figure, [[axes]], [2.4], frame, Caption(text, origin))
    return figure
