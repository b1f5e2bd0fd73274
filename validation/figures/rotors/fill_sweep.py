"""The measured fill sweep of a real washing machine beside the machine that two of its fills ask for, drawn.

python -m validation.figures.rotors.fill_sweep --out docs/images
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save_png, style
from meshes.arrays import Array
from validation.cases.fill_sweep.contact import of_kept
from validation.cases.fill_sweep.fitted import NEAREST, bands, kept, measured, ratios
from validation.study import launch

_FRAME = Frame(left=0.78, top=0.28, between=0.34, below=0.42)
_LINE, _TOUCHES = "#0072B2", "#009E73"


def sweep_figure() -> Figure:
    """Passage and cruise over the water added, each over its value with the first fill."""
    added, *seen = measured()
    draws, fitted = kept()
    own = [ratio[0] for ratio in ratios(fitted.answers)]
    titles = ("At the resonance", "Near the highest speed, 750 rpm")
    with style():
        figure = Figure()
        panels: list[Any] = []
        for k, (title, band) in enumerate(zip(titles, bands(draws, fitted.answers), strict=True)):
            axes: Any = figure.add_axes((0, 0, 1, 1), label=title)
            _draw(axes, added, seen[k], own[k], band)
            axes.set_title(title, loc="left")
            axes.set_ylabel("Shaking over that\nwith 0 ml added (\N{EN DASH})")
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=k == 1)
            panels.append(axes)
        _draw_contact(panels[0], added)
        panels[0].set_yscale("log")
        panels[0].set_ylim(0.07, 3.0)
        panels[0].set_yticks([0.1, 0.2, 0.5, 1.0, 2.0], ["0.1", "0.2", "0.5", "1", "2"])
        panels[0].yaxis.set_minor_locator(panels[0].yaxis.get_minor_locator().__class__(subs=()))
        panels[1].set_ylim(0.0, 1.4)
        panels[1].set_xlabel("Water added to the ring (ml)")
        text = (
            "Measured: one run for each fill; those with 0 and 50 ml strike the cabinet at the resonance. "
            "Computed: one machine for all fills, its values fitted to the first and the last fill (large "
            f"marks); band: the {NEAREST} of {len(draws.values)} sets of assumed values that come closest to "
            "these two. Green: the tub touches the cabinet beyond a clearance; nine tenths of what the two "
            "fills allow, and their middle. Scene: validation/data/fill_sweep.toml, most of it assumed."
        )
        lay_out(figure, [[axes] for axes in panels], [2.0, 1.6], _FRAME, text)
        pairs = zip(added[1:], seen[0][1:], own[0][1:], strict=True)
        rows = "; ".join(f"{ml:g} ml {a:.2f} measured, {b:.2f} computed" for ml, a, b in pairs)
        figure.alt = f"Shaking at the resonance over that with 0 ml added: {rows}."
    return figure


def _draw(axes: Any, added: Array, seen: Array, own: Array, band: Array) -> None:
    """One quantity: band, computed line, measured points, those that were fitted large."""
    axes.fill_between(added, *band, color=_LINE, alpha=0.2, linewidth=0.0, label="closest assumed values")
    axes.plot(added, own, color=_LINE, linestyle=(0, (5, 1.5)), linewidth=1.3, label="computed, fitted")
    look: dict[str, Any] = {"color": "black", "linestyle": "none", "markerfacecolor": "white", "zorder": 4}
    axes.plot(added, seen, marker="s", markersize=4.5, label="measured", **look)
    ends = [0, -1]
    axes.plot(added[ends], seen[ends], marker="s", markersize=8.0, label="measured, fitted to", **look)


def _draw_contact(axes: Any, added: Array) -> None:
    """What a clearance makes of the same values: nine tenths of what two fills allow, and the middle."""
    low, middle, high = of_kept().bands()
    axes.fill_between(added, low, high, color=_TOUCHES, alpha=0.15, linewidth=0.0, label="with a clearance")
    axes.plot(added, middle, color=_TOUCHES, linewidth=1.3, label="with a clearance, middle")


def draw(out: Path) -> Path:
    """Write it as PNG."""
    title = "The measured fill sweep, and what one machine makes of it"
    return save_png(sweep_figure(), out, "fill_sweep", title)


if __name__ == "__main__":
    launch(draw)
