"""The lag of a layer with baffles over time, long waves beside computed flow, drawn.

python -m validation.cases.baffles.figure --out docs/images
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save_png, style
from validation.cases.baffles.flow import lagging, reference
from validation.study import launch

_FRAME = Frame(left=0.72, top=0.15, between=0.35, below=0.42)
# Of each run: what it is, colour and line.
_LOOKS: dict[str, tuple[str, str, Any]] = {
    "n0": ("decay without baffles", "0.45", (0, (1, 1.2))),
    "w6n4": ("decay, 4 of 6 mm", "#009E73", (0, (5, 1.5))),
    "w6": ("decay, 8 of 6 mm", "#0072B2", "-"),
    "w9": ("decay, 8 of 9 mm", "#D55E00", (0, (6, 1.5, 1, 1.5))),
}
_DRIVEN: dict[str, tuple[str, str, Any]] = {
    "d3": ("3 mm, 5 rad/s\N{SUPERSCRIPT TWO}", "#009E73", (0, (5, 1.5))),
    "d6": ("6 mm, 10 rad/s\N{SUPERSCRIPT TWO}", "#0072B2", "-"),
    "d9": ("9 mm, 10 rad/s\N{SUPERSCRIPT TWO}", "#D55E00", (0, (6, 1.5, 1, 1.5))),
    "d6s": ("6 mm, 40 rad/s\N{SUPERSCRIPT TWO}", "#CC79A7", (0, (1, 1.2))),
}


def lag_figure() -> Figure:
    """Decays of a lag, and lags that a spin-up holds."""
    with style():
        figure = Figure()
        panels: list[Any] = [figure.add_axes((0, 0, 1, 1), label=name) for name in "ab"]
        for axes, looks, last in ((panels[0], _LOOKS, 0.8), (panels[1], _DRIVEN, 1.2)):
            _draw(axes, looks)
            axes.set_xlim(0.0, last)
            axes.set_ylim(0.0, None)
            axes.set_ylabel("Lag over the spin (\N{EN DASH})")
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
        panels[1].set_xlabel("Time (s)")
        text = (
            "A ring of 13.7 mm of liquid on a wall of 240 mm radius, spin 40 rad/s, baffles on the wall: a "
            "lag of a quarter of the spin that decays (above), and lags held by a steady spin-up (below, "
            "eight baffles). "
            "Lines: long waves, 128 cells; points: computed two-phase flow, plane and laminar. A spin-up of "
            "40 rad/s\N{SUPERSCRIPT TWO} leaves the liquid behind."
        )
        lay_out(figure, [[axes] for axes in panels], [2.0, 2.0], _FRAME, text)
    return figure


def _draw(axes: Any, looks: dict[str, tuple[str, str, Any]]) -> None:
    """Some runs: lines of the long waves, points of the computed flow."""
    for name, (label, color, dashes) in looks.items():
        own, run = lagging(name), reference(name)
        axes.plot(own.time, own.lag, color=color, linestyle=dashes, linewidth=1.3, label=label)
        time, lag = np.array(run["time"]), 1.0 - np.array(run["mean_rotation"])
        some = np.unique(np.searchsorted(time, np.arange(0.02, time[-1], 0.04)))
        look = {"marker": "s", "markersize": 3.0, "linestyle": "none", "markerfacecolor": "white"}
        axes.plot(time[some], lag[some], color=color, **look)


def draw(out: Path) -> Path:
    """Write it as PNG."""
    title = "The lag of a layer with baffles, beside computed flow"
    return save_png(lag_figure(), out, "baffles_decay", title)


if __name__ == "__main__":
    launch(draw)
