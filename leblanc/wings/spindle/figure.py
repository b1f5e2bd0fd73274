"""Figures of a spindle unit: compliances and their ratio over frequency, shapes of its natural motions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import MM
from leblanc.plotting.page import Caption, Figure, Frame, lay_out, number, style
from leblanc.wings.spindle.answer import PER_NEWTON, THEORIES, SpindleAnswer, hertz, sentence
from meshes.arrays import Complex

FRAME = Frame(left=0.72, top=0.2, between=0.12, below=0.42)
MOST_SHAPES = 6
_LOOKS: tuple[dict[str, Any], ...] = (
    {"color": "C0", "linestyle": "-"},
    {"color": "C3", "linestyle": "--"},
    {"color": "C2", "linestyle": "-."},
    {"color": "C1", "linestyle": ":"},
)


def compliance_figure(result: SpindleAnswer) -> Figure:
    """Size and phase of both compliances above, of their ratio W below."""
    lines = (
        (f"{result.measured_at}, measured (q1)", result.measured * PER_NEWTON),
        (f"{result.wanted_at}, wanted (q2)", result.wanted * PER_NEWTON),
    )
    with style():
        figure = Figure()
        figure.alt = (
            f"Size and phase of the compliances of {result.measured_at} and {result.wanted_at} under a force "
            f"at {result.driven_at}, and of their ratio W, over frequency. {sentence(result)}"
        )
        names = ("size", "phase", "ratio", "ratio_phase")
        panels: list[Any] = [figure.add_axes((0, 0, 1, 1), label=name) for name in names]
        for (label, values), look in zip(lines, _LOOKS, strict=False):
            _draw(panels[0], panels[1], result, values, label, look)
        _draw(panels[2], panels[3], result, result.transmissibility, "W = q2/q1", _LOOKS[2])
        for axes, label in zip(panels, ("nm/N", "Phase (deg)", "|W|", "Phase (deg)"), strict=True):
            axes.set_ylabel(f"Compliance ({label})" if axes is panels[0] else label)
            axes.set_xscale("log")
            axes.set_xlim(*(result.frequency[[0, -1]] / (2.0 * math.pi) * np.array([0.999, 1.001])))
            axes.xaxis.set_major_formatter(number)
            axes.xaxis.set_minor_formatter("")
            for mode in result.modes:
                axes.axvline(
                    mode.frequency / (2.0 * math.pi),
                    *(0.0, 1.0),
                    color="0.6",
                    linewidth=0.6,
                    zorder=0,
                    label="natural frequency",
                )
            axes.tick_params(labelbottom=axes is panels[-1])
        panels[-1].set_xlabel("Frequency of the force (Hz)")
        lay_out(figure, [[axes] for axes in panels], [1.7, 0.85, 1.2, 0.85], FRAME, _caption(result))
    return figure


def _draw(size: Any, phase: Any, result: SpindleAnswer, values: Complex, label: str, look: Any) -> None:
    """One complex number over frequency."""
    frequency = result.frequency / (2.0 * math.pi)
    size.plot(frequency, np.abs(values), label=label, **look)
    size.set_yscale("log")
    size.yaxis.set_major_formatter(number)
    size.yaxis.set_minor_formatter("")
    degrees = np.degrees(np.angle(values))
    jumps = np.abs(np.diff(degrees)) > 180.0
    degrees[np.flatnonzero(jumps)] = np.nan  # where the angle passes from -180 to 180
    phase.plot(frequency, degrees, **look)
    phase.set_ylim(-190.0, 190.0)
    phase.set_yticks([-180, -90, 0, 90, 180])


def shapes_figure(result: SpindleAnswer) -> Figure:
    """Deflection along each beam in the first natural motions, of which there is one at least."""
    shown = result.modes[:MOST_SHAPES]
    with style():
        figure = Figure()
        every = ", ".join(hertz(mode.frequency) for mode in result.modes)
        figure.alt = f"Deflection along each beam in the natural motions at {every}."
        panels: list[Any] = []
        for k, mode in enumerate(shown):
            axes: Any = figure.add_axes((0, 0, 1, 1), label=f"mode {k + 1}")
            panels.append(axes)
            axes.axhline(0.0, color="0.6", linewidth=0.6, zorder=0)
            for j, (name, first, (place, deflection)) in enumerate(
                zip(result.beams, result.places, mode.along, strict=True)
            ):
                axes.plot((first + place) * MM, deflection, label=name, **_LOOKS[j % len(_LOOKS)])
            axes.set_ylim(-1.15, 1.15)
            axes.set_ylabel(hertz(mode.frequency))
            axes.tick_params(labelbottom=k == len(shown) - 1)
        panels[-1].set_xlabel("Place along the machine (mm)")
        left = "" if len(shown) == len(result.modes) else f" The first {len(shown)} of {len(result.modes)}."
        caption = Caption(
            f"Deflection over its largest value in each natural motion without damping.{left}",
            _origin(result),
        )
        lay_out(figure, [[axes] for axes in panels], [0.85] * len(panels), FRAME, caption)
    return figure


def _caption(result: SpindleAnswer) -> Caption:
    return Caption(
        f"A force of 1 N at {result.driven_at}; {result.measured_at} is measured, {result.wanted_at} wanted. "
        f"Exact beams with {THEORIES[result.theory]}; no gyroscopic moments.",
        _origin(result),
    )


def _origin(result: SpindleAnswer) -> str:
    assumed = assumed_words(result.assumed)
    return f"Scene: {one_line(result.name)}. Assumed: {assumed}, all marked in the scene."
