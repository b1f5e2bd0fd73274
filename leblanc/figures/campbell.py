"""The Campbell diagram of a dry rotor."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.figures.caption import caption
from leblanc.figures.curves import gapped, joined
from leblanc.figures.page import Figure, Frame, add_rate_axis, lay_out, number, style
from leblanc.results.response import RunResult
from leblanc.text.run import alts
from leblanc.units import RPM
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

FORWARD, BACKWARD, STRAIGHT, SPIN = "#0072B2", "#D55E00", "0.35", "0.2"  # after Okabe and Ito
CLEAR = 0.2  # from here on a whirl is drawn as one with or against the spin
HZ = 60.0  # rpm in one hertz
# Colour, dashes and marker of each sense of whirl.
STYLES = (
    ("with the spin", 1.0, FORWARD, "solid", "^"),
    ("against the spin", -1.0, BACKWARD, (0, (5, 1.5)), "v"),
    ("to and fro", 0.0, STRAIGHT, (0, (1, 1.2)), "o"),
)
FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)


def campbell_figure(result: RunResult) -> Figure:
    """Natural frequencies of the dry rotor over its speed."""
    with style():
        figure = Figure()
        figure.alt = alts(result)["campbell"]
        axes: Axes = figure.add_axes((0, 0, 1, 1))
        draw_campbell(axes, result)
        for scale in (axes.xaxis, axes.yaxis):
            scale.set_major_formatter(number)
        add_rate_axis(axes)
        text = "Damped natural frequencies without liquid, by the sense in which the axis goes round."
        lay_out(figure, [[axes]], [2.75], FRAME, caption(result, text))
    return figure


def draw_campbell(axes: Axes, result: RunResult) -> None:
    """Natural frequencies over speed, forward and backward told apart, and where the spin meets them.

    Parameters
    ----------
    axes : an empty drawing
    result : of a rotor that is not planar
    """
    assert result.motion is not None
    diagram = result.motion.campbell
    rpm, hertz = diagram.spin * RPM, diagram.frequency * RPM / HZ
    overdamped = hertz <= 0.0
    direction = diagram.direction.copy()
    if diagram.spin.size > 1 and diagram.spin[0] == 0.0:
        # At rest modes of one frequency mix at will; turning a little tells them apart.
        direction[0] = direction[1]
    for name, sense, color, dashes, marker in STYLES:
        lines = []
        for k in range(hertz.shape[1]):
            mine = (_sense(direction[:, k]) == sense) & ~overdamped[:, k]
            lines.append(gapped(*_runs(rpm, hertz[:, k], mine)))
        x, y = joined(lines)
        if np.isfinite(y).any():
            axes.plot(x, y, color=color, linestyle=dashes, label=f"whirl {name}")
        met = _sense(diagram.crossing_direction) == sense
        if met.any():
            place = diagram.crossing[met] * RPM
            axes.plot(
                *(place, place / HZ, marker),
                color=color,
                markerfacecolor="white",
                markersize=6,
                zorder=4,
                label=f"spin meets it, {name}",
            )
    top = float(rpm[-1])
    axes.plot([0.0, top], [0.0, top / HZ], color=SPIN, linewidth=0.9, label="once a turn")
    low, high = result.response.speed[[0, -1]] * RPM
    if min(low, high) > 0.02 * top:
        axes.axvspan(
            0.0, min(low, high), color="0.92", linewidth=0, zorder=0, label="below the speeds studied"
        )
    axes.set_xlim(0.0, top)
    axes.set_ylim(0.0, 1.15 * max(float(hertz.max(initial=0.0)), 0.1))
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel("Natural frequency (Hz)")


def _sense(direction: Array) -> Array:
    """1 with the spin, -1 against it, 0 for ellipses that are nearly lines."""
    return np.where(np.abs(direction) < CLEAR, 0.0, np.sign(direction))


def _runs(x: Array, y: Array, mask: np.ndarray) -> tuple[Array, Array, np.ndarray]:
    """The line where the mask holds and one point farther, so that no gap opens where it changes."""
    wide = mask.copy()
    wide[1:] |= mask[:-1]
    shown = np.where(wide & (y > 0.0), y, np.nan)
    return x, shown, np.zeros(x.size - 1, dtype=bool)
