"""Where a whirl with an exact layer begins softly, and circles that it settles at, drawn.

`python -m tests.exact_whirl.figure --out docs/images`; `python -m tests.exact_whirl` computes anew.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.exact_whirl import Kept, Way, kept
from tests.exact_whirl.edges import soft_mass_ratio
from validation.page import Figure, page
from validation.study import launch, shown

_LOOKS = (("#0072B2", ":"), ("#D55E00", "-."), ("#009E73", "-"), ("#CC79A7", "--"))
_LEAST = 5e-3  # mass ratio at the lower end


def whirl_figure() -> Figure:
    """How a whirl begins over depth and mass ratio, and circles beyond the onset."""
    results = kept()
    text = (
        "Above: below the line the lower edge of the band without losses moves into it as the whirl "
        f"grows. Marks: support damped by {results.damping:g}, friction {results.friction:g} of the "
        "natural frequency; light and deep liquids have no whirl then. Below: circles with these losses; "
        "points: where a motion in time came to."
    )
    with page([2.0, 2.0], text, left=0.62, between=0.62) as (figure, [[first], [second]]):
        _draw_onsets(first, results)
        _draw_circles(second, results)
        figure.alt = alternative(results)
    return figure


def _draw_onsets(axes: Any, results: Kept) -> None:
    layer = np.linspace(0.2, 0.72, 200)
    ratio = soft_mass_ratio(layer)
    axes.plot(layer[ratio > 0.0], ratio[ratio > 0.0], color="black", label="edge without losses")
    for sign, marker, name in ((1.0, "o", "begins softly"), (-1.0, "x", "begins hard")):
        rows = [row for row in results.onsets if sign * row.shift > 0.0]
        axes.plot(
            [row.layer for row in rows],
            [row.mass_ratio for row in rows],
            linestyle="none", marker=marker, markersize=4.0, label=f"{name}, with losses",
            color="#009E73" if sign > 0.0 else "#D55E00", markerfacecolor="none",
        )  # fmt: skip
    axes.set_yscale("log")
    axes.set_ylim(_LEAST, 4.0)
    axes.set_xlim(0.0, 0.95)
    axes.set_yticks([0.01, 0.1, 1.0], ["0.01", "0.1", "1"])
    axes.minorticks_off()
    axes.set_xlabel("Depth h0/R")
    axes.set_ylabel("Mass ratio, full drum over rotor")


def _draw_circles(axes: Any, results: Kept) -> None:
    for way, (colour, line) in zip(results.ways, _LOOKS, strict=True):
        onset = way.circles[0].speed
        beyond = [100.0 * (each.speed / onset - 1.0) for each in way.circles]
        whirl = [each.whirl for each in way.circles]
        name = f"depth {way.layer:g}, mass ratio {way.mass_ratio:g}"
        axes.plot(beyond, whirl, color=colour, linestyle=line, label=name)
        for found in settled_on(results, way):
            axes.plot(100.0 * (found[0] / onset - 1.0), found[1], color=colour, marker="o")
    axes.axvline(0.0, color="0.7", linewidth=0.6)
    axes.set_ylim(0.0, 0.03)
    axes.set_xlabel("Spin beyond the onset, %")
    axes.set_ylabel("Whirl over depth, W/h0")


def settled_on(results: Kept, way: Way) -> list[tuple[float, float]]:
    """Omega/omega_n and W/h_0 that small pushes of a way's machine came to in time."""
    return [
        (found.setting.speed, found.last)
        for found in results.settled
        if (found.setting.layer, found.setting.mass_ratio) == (way.layer, way.mass_ratio)
    ]


def alternative(results: Kept) -> str:
    """Numbers that a reader would take from the figure."""
    edges = ", ".join(f"{soft_mass_ratio(h):.2g} at depth {h:g}" for h in (0.3, 0.4, 0.5, 0.6, 0.7))
    ways = [
        f"depth {way.layer:g}, mass ratio {way.mass_ratio:g}: from {way.circles[0].speed:.4f} to "
        f"{way.circles[-1].speed:.4f} of the natural frequency at a whirl of {way.circles[-1].whirl:g}"
        for way in results.ways
    ]
    points = [f"{row.last:.4f} at {row.setting.speed:g}" for row in results.settled]
    return (
        f"Mass ratio up to which the edge is soft: {edges}. Circles, {'; '.join(ways)}. "
        f"In time: {', '.join(points)}."
    )


if __name__ == "__main__":
    launch(shown(exact_whirl=whirl_figure))
