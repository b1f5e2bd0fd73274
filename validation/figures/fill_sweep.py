"""The measured fill sweep of a real washing machine beside the assumed one, drawn."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, style
from validation.cases.fill_sweep import model_curves
from validation.cases.rigs import data

_FRAME = Frame(left=0.72, top=0.28, between=0.34, below=0.42)


def sweep_figure() -> Figure:
    """Three objectives over the volume added, each over its value without liquid."""
    measured = data("fill_sweep.json")
    added = np.array(measured["added_ml"], dtype=float)
    volume, runup, resonance, cruise = model_curves()
    rows = (
        ("Resonance peak", "resonance_peak", resonance),
        ("Peak of the whole run", "peak", runup),
        ("Cruise", "cruise_mean", cruise),
    )
    with style():
        figure = Figure()
        panels: list[Any] = []
        for title, key, own in rows:
            axes: Any = figure.add_axes((0, 0, 1, 1), label=key)
            seen = np.array(measured[key], dtype=float)
            real = {"color": "black", "marker": "s", "markerfacecolor": "white", "linewidth": 1.0}
            axes.plot(added, seen / seen[0], **real, label="measured: acceleration of a cabinet")
            look: dict[str, Any] = {"color": "#0072B2", "marker": "o", "linestyle": (0, (5, 1.5))}
            axes.plot(volume, own / own[0], **look, label="computed: amplitude of an assumed machine")
            for x, y in ((added, seen / seen[0]), (volume, own / own[0])):
                k = int(np.argmin(y * (1.0 + 1e-9 * np.arange(y.size))))
                least = {"marker": "*", "markersize": 10.0, "linestyle": "none", "color": "#E69F00"}
                axes.plot(x[k], y[k], **least, markeredgecolor="black", zorder=5, label="least")
            axes.set_title(title, loc="left")
            axes.set_ylim(0.0, 1.7)
            axes.set_ylabel("Over that\nwithout (\N{EN DASH})")
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=key == "cruise_mean")
            panels.append(axes)
        panels[-1].set_xlabel("Water in the ring (ml)")
        text = (
            "Each over its value without liquid. Measured: one run for each volume, size of the ring, speeds "
            "and load unknown. Computed: 40 kg on 2 Hz, damping ratio 0.1, unbalance 0.08 kg m, upright; "
            "ring 240/205 mm, 40 mm high, friction 3 1/s; 40 to 700 rpm at 5 rad/s\N{SUPERSCRIPT TWO}, all "
            "assumed."
        )
        lay_out(figure, [[axes] for axes in panels], [1.2] * 3, _FRAME, text)
    return figure
