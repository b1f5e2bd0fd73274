"""Equal liquid in one to four rings, drawn: `python -m validation.cases.claims.figure --out docs/images`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save_png, style
from validation.cases.claims.chambers import COUNTS, KINDS, gain
from validation.study import launch

_FRAME = Frame(left=0.72, top=0.15, between=0.35, below=0.42)
# Of each measure: what it is, colour and mark.
_LOOKS = {
    "at_speed": ("at 90 rad/s", "#0072B2", "o"),
    "peak": ("largest at constant speed", "#D55E00", "s"),
    "run_up": ("largest of a run-up at 4 rad/s\N{SUPERSCRIPT TWO}", "#009E73", "^"),
}


def rings_figure() -> Figure:
    """Deflection over that without liquid, over the number of rings."""
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        for kind in KINDS:
            for measure, (label, color, mark) in _LOOKS.items():
                sizes = [getattr(gain(count, kind), measure) for count in COUNTS]
                look = {"color": color, "marker": mark, "markersize": 4.5, "linewidth": 1.3}
                if kind == "stacked":
                    look |= {"linestyle": (0, (5, 1.5)), "markerfacecolor": "white"}
                axes.plot(COUNTS, sizes, label=f"{kind}, {label}", **look)
        axes.axhline(1.0, color="0.45", linewidth=0.8)
        axes.set_xticks(COUNTS)
        axes.set_xlim(0.8, 4.2)
        axes.set_ylim(0.6, 1.2)
        axes.yaxis.set_major_formatter(number)
        axes.set_xlabel("Number of rings that share one litre")
        axes.set_ylabel("Deflection over that without liquid (\N{EN DASH})")
        text = (
            "The vertical rig with one litre of water in one to four rings within 400 mm by 40 mm: "
            "concentric ones 50 mm wide with layers of equal depth, or rings of equal height one above the "
            "other. Steady: exact equilibrium and linear layers; run-up: annular long waves, 32 cells. "
            "Assumed: 30 kg, 40 mm, damping ratio 0.01, smooth walls, the ramp."
        )
        lay_out(figure, [[axes]], [2.9], _FRAME, text)
    return figure


def draw(out: Path) -> Path:
    """Write it as PNG."""
    return save_png(rings_figure(), out, "claims_rings", "Equal liquid in one to four rings")


if __name__ == "__main__":
    launch(draw)
