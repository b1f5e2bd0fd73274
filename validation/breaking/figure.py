"""The kept endings of the nonlinear wave, the highest natural waves, long waves beside them and a crest.

`python -m validation.breaking.figure --out docs/images`; `python -m tests.breaking` computes them anew.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from leblanc.plotting.page import fill
from validation.breaking import Beside, Kept, crests, kept
from validation.breaking.crests import Crest
from validation.page import Figure, number, page
from validation.study import launch, shown

_LOOKS = {
    0.1: {"color": "#0072B2", "marker": "o"},
    0.3: {"color": "#D55E00", "marker": "s"},
    0.5: {"color": "#009E73", "marker": "^"},
    0.7: {"color": "#CC79A7", "marker": "D"},
}
SHOWN = (crests.LAYER, crests.SHARE)  # h_0/R and w_0/h_0 of the crests over time
# Of the crest that breaks: colours from the first moment to the last, what of the wall is drawn, rad.
_COLOURS = ("0.65", "#56B4E9", "#009E73", "#0072B2", "#D55E00", "#CC79A7")
_AHEAD, _BEHIND = 0.22, 0.42
_DRUM_LINES = 721


def breaking_figure() -> Figure:
    """Time to breaking over the whirl, highest crests over depth, and crests over time beside long waves."""
    results = kept()
    text = (
        "Above: whirl periods until the exact wave breaks, under a whirl with the backward free wave, "
        "grown over 0.9 periods; open symbols: not broken until then. Below: crests of the highest free "
        "waves, and the crest of a wave that breaks beside long waves, h0/R = 0.1, w0 = 0.05 h0."
    )
    with page([2.2, 1.5, 1.7], text, left=0.62, between=0.62) as (figure, [[ends], [crests], [times]]):
        _draw_ends(ends, results)
        highest = np.array([(row.depth, row.crest) for row in results.highest]).T
        crests.plot(*highest, color="black", marker=".", label="highest free wave")
        crests.set_ylim(bottom=1.0)
        crests.set(xlabel="Depth h0/R", ylabel="Crest over h0")
        _draw_times(times, results)
        figure.alt = alternative(results)
    return figure


def _draw_ends(axes: Any, results: Kept) -> None:
    axes.set(xscale="log", yscale="log")
    for depth, look in _LOOKS.items():
        rows = [row for row in results.endings if row.depth == depth]
        broken = [row for row in rows if row.state == "broken"]
        others = [row for row in rows if row.state != "broken"]
        whirls, periods = ([getattr(row, name) for row in broken] for name in ("whirl", "periods"))
        axes.plot(whirls, periods, label=f"h0/R = {depth:g}", **look)
        whirls, periods = ([getattr(row, name) for row in others] for name in ("whirl", "periods"))
        # Those of several depths lie on one another.
        open_ones = {"linestyle": "none", "markersize": 11.0 * (0.95 - depth), "markerfacecolor": "none"}
        axes.plot(whirls, periods, **open_ones, **look)
    axes.set_xticks([0.002, 0.005, 0.01, 0.02, 0.05, 0.1], ["0.002", "0.005", "0.01", "0.02", "0.05", "0.1"])
    axes.set_yticks([1, 2, 5, 10, 20], ["1", "2", "5", "10", "20"])
    axes.set_ylim(1.0, 32.0)
    axes.minorticks_off()
    axes.set(xlabel="Whirl over depth, w0/h0", ylabel="Whirl periods to breaking")


def _draw_times(axes: Any, results: Kept) -> None:
    pair = pair_shown(results)
    axes.plot(pair[0].time, pair[0].exact, color="black", label="exact wave")
    for row, colour, line in zip(pair, ("#0072B2", "#D55E00"), ("--", ":"), strict=True):
        name = "long wave + dispersion" if row.dispersion else "long wave"
        axes.plot(row.time, row.crest, color=colour, linestyle=line, label=name)
    axes.set_ylim(bottom=1.0)
    axes.set(xlabel="Time (whirl periods)", ylabel="Crest over h0")


def pair_shown(results: Kept) -> list[Beside]:
    """The long waves without and with dispersion whose crests are drawn."""
    return [row for row in results.beside if (row.depth, row.whirl) == SHOWN]


def crest_figure(found: Sequence[Crest] | None = None) -> Figure:
    """Crest that breaks: in the drum, and unrolled with its slopes as they are; None: the finest one kept."""
    rows = list(found) if found else [row for row in crests.kept() if row.most == max(crests.MOST)]
    turn, left = 2.0 * math.pi / abs(crests.resonant(*SHOWN)[1].slip), 0.62
    # What a strip as wide as that is high.
    wide = 6.3 - left - 0.25
    high = wide * float(_unrolled(1.7 * crests.LAYER)) / (_AHEAD + _BEHIND)
    text = (
        f"h0/R = {SHOWN[0]:g}, w0 = {SHOWN[1]:g} h0, whirl with the small backward free wave; t in "
        f"1/Omega, a whirl period being {turn:.1f}; {rows[-1].most} nodes. Above: seen from the drum, "
        "which spins counter-clockwise, true to scale. Below: unrolled onto the strip, where "
        "slopes are as steep as they are in the drum; the last crest's ripples are those of its nodes. "
        "B: speed of the liquid at the crest over that of the crest."
    )
    heights, columns = [wide / len(rows), high], (len(rows), 1)
    with page(heights, text, columns, left=left, top=0.3, between=0.25) as (figure, [drums, [near]]):
        for axes, row in zip(drums, rows, strict=True):
            _draw_drum(axes, row)
        for row, colour in zip(rows, _COLOURS, strict=False):
            name = f"t = {row.time:.4g}: {row.slope:.0f} deg, B = {row.crest_number:.2f}"
            near.plot(crests.angles(), _unrolled(row.depth), color=colour, label=name)
        depths = np.arange(0.0, 1.9, 0.5)
        near.set_yticks(_unrolled(crests.LAYER * depths), [number(depth) for depth in depths])
        near.set(xlim=(-_AHEAD, _BEHIND), ylim=(0.0, float(_unrolled(1.7 * crests.LAYER))))
        near.axhline(float(_unrolled(crests.LAYER)), color="0.5", linewidth=0.7, linestyle=":")
        near.set(xlabel="Angle from the crest (rad); the wave runs to the left", ylabel="Depth over h0")
        figure.alt = crest_words(rows)
    return figure


def _unrolled(depth: Any) -> Any:
    """Height ln(R/r) in the strip, of a depth over R."""
    return -np.log1p(-np.asarray(depth))


def _draw_drum(axes: Any, row: Crest) -> None:
    angle = np.linspace(-math.pi, math.pi, _DRUM_LINES)
    depth = np.interp(angle, crests.angles(), row.depth)
    wall, free = np.exp(1j * (row.place + angle)), (1.0 - depth) * np.exp(1j * (row.place + angle))
    axes.set(xlim=(-1.06, 1.06), ylim=(-1.06, 1.06))
    axes.set_aspect("equal")
    axes.set_axis_off()
    ring = np.concatenate((wall, free[::-1]))
    fill(axes, ring.real, ring.imag, facecolor="#56B4E9", edgecolor="none")
    axes.plot(wall.real, wall.imag, color="black", linewidth=1.2)
    axes.plot(free.real, free.imag, color="#0072B2", linewidth=0.9)
    axes.set_title(f"t = {row.time:.4g}", fontsize=7.5, pad=2.0)


def crest_words(rows: Sequence[Crest]) -> str:
    """Numbers of a crest that breaks."""
    parts = [
        f"at t = {row.time:.4g} a crest of {row.crest:.3f} h0, {row.slope:.1f} deg steep, with B = "
        f"{row.crest_number:.2f}"
        for row in rows
    ]
    return f"A crest that breaks: {'; '.join(parts)}."


def alternative(results: Kept) -> str:
    """Numbers that a reader would take from the figure."""
    ends = [
        f"depth {row.depth:g}, whirl {row.whirl:g}: "
        + (f"{row.periods:.2f} periods" if row.state == "broken" else f"none to {row.periods:.0f} periods")
        for row in results.endings
    ]
    crests = [f"{row.crest:.3f} at {row.depth:g}" for row in results.highest]
    return f"Time to breaking, {'; '.join(ends)}. Highest crests over the depth: {', '.join(crests)}."


if __name__ == "__main__":
    launch(shown(breaking=breaking_figure, breaking_crest=crest_figure))
