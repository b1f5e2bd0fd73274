"""The kept endings of the exact wave, the highest free waves and long waves beside the exact one, drawn.

`python -m validation.breaking.figure --out docs/images`; `python -m validation.breaking` computes them anew.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from leblanc.figures.drawing.page import Figure, Frame, lay_out, save, style
from validation.breaking import Beside, Kept, kept

_FRAME = Frame(left=0.62, top=0.15, between=0.62, below=0.42)
_LOOKS = {
    0.1: {"color": "#0072B2", "marker": "o"},
    0.3: {"color": "#D55E00", "marker": "s"},
    0.5: {"color": "#009E73", "marker": "^"},
    0.7: {"color": "#CC79A7", "marker": "D"},
}
SHOWN = (0.1, 0.05)  # h_0/R and w_0/h_0 of the crests over time


def breaking_figure() -> Figure:
    """Time to breaking over the whirl, highest crests over depth, and crests over time beside long waves."""
    results = kept()
    with style():
        figure = Figure()
        ends: Any = figure.add_axes((0, 0, 1, 1))
        crests: Any = figure.add_axes((0, 0, 0.5, 1))
        times: Any = figure.add_axes((0.5, 0, 0.5, 1))
        _draw_ends(ends, results)
        _draw_crests(crests, results)
        _draw_times(times, results)
        text = (
            "Above: whirl periods until the exact wave breaks, under a whirl with the backward free wave, "
            "grown over 0.9 periods; open symbols: not broken until then. Below: crests of the highest free "
            "waves, and the crest of a wave that breaks beside long waves, h0/R = 0.1, w0 = 0.05 h0."
        )
        lay_out(figure, [[ends], [crests], [times]], [2.2, 1.5, 1.7], _FRAME, text)
        figure.alt = alternative(results)
    return figure


def _draw_ends(axes: Any, results: Kept) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    for depth, look in _LOOKS.items():
        rows = [row for row in results.endings if row.depth == depth]
        broken = [row for row in rows if row.state == "broken"]
        others = [row for row in rows if row.state != "broken"]
        axes.plot(
            [row.whirl for row in broken],
            [row.periods for row in broken],
            label=f"h0/R = {depth:g}",
            **look,
        )
        axes.plot(
            [row.whirl for row in others],
            [row.periods for row in others],
            linestyle="none",
            # Those of several depths lie on one another.
            markersize=11.0 * (0.95 - depth),
            markerfacecolor="none",
            **look,
        )
    axes.set_xticks([0.002, 0.005, 0.01, 0.02, 0.05, 0.1], ["0.002", "0.005", "0.01", "0.02", "0.05", "0.1"])
    axes.set_yticks([1, 2, 5, 10, 20], ["1", "2", "5", "10", "20"])
    axes.set_ylim(1.0, 32.0)
    axes.minorticks_off()
    axes.set_xlabel("Whirl over depth, w0/h0")
    axes.set_ylabel("Whirl periods to breaking")


def _draw_crests(axes: Any, results: Kept) -> None:
    axes.plot(
        [row.depth for row in results.highest],
        [row.crest for row in results.highest],
        color="black",
        marker=".",
        label="highest free wave",
    )
    axes.set_ylim(bottom=1.0)
    axes.set_xlabel("Depth h0/R")
    axes.set_ylabel("Crest over h0")


def _draw_times(axes: Any, results: Kept) -> None:
    pair = shown(results)
    axes.plot(pair[0].time, pair[0].exact, color="black", label="exact wave")
    for row, colour, line in zip(pair, ("#0072B2", "#D55E00"), ("--", ":"), strict=True):
        name = "long wave + dispersion" if row.dispersion else "long wave"
        axes.plot(row.time, row.crest, color=colour, linestyle=line, label=name)
    axes.set_ylim(bottom=1.0)
    axes.set_xlabel("Time (whirl periods)")
    axes.set_ylabel("Crest over h0")


def shown(results: Kept) -> list[Beside]:
    """The long waves without and with dispersion whose crests are drawn."""
    return [row for row in results.beside if (row.depth, row.whirl) == SHOWN]


def alternative(results: Kept) -> str:
    """The numbers that a reader would take from the figure.

    Parameters
    ----------
    results : what is drawn
    """
    ends = [
        f"depth {row.depth:g}, whirl {row.whirl:g}: "
        + (f"{row.periods:.2f} periods" if row.state == "broken" else f"none to {row.periods:.0f} periods")
        for row in results.endings
    ]
    crests = [f"{row.crest:.3f} at {row.depth:g}" for row in results.highest]
    return f"Time to breaking, {'; '.join(ends)}. Highest crests over the depth: {', '.join(crests)}."


def draw(out: Path) -> Path:
    """Write it as PNG.

    Parameters
    ----------
    out : folder, made if it is missing
    """
    files = save(breaking_figure(), out, "breaking", "When the exact wave breaks")
    files.svg.unlink()
    return files.png


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the figure.

    Parameters
    ----------
    arguments : of the command line; None: the process's own
    """
    parser = argparse.ArgumentParser(prog="python -m validation.breaking.figure", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the figure")
    print(draw(parser.parse_args(arguments).out))


if __name__ == "__main__":
    main()
