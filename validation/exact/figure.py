"""The kept errors of the models beside the exact wave, drawn: maps, and where smooth waves end.

`python -m validation.exact.figure --out docs/images`; `python -m validation.exact` measures them anew.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save_png, style
from meshes.arrays import Array
from validation.exact import Cases, Ends, kept

# Panels: a model and its name; the whirls of the two figures' halves, over h_0.
_MODELS = (
    ("linear", "linear"), ("kdv", "kdv"),
    ("long_wave", "long waves"), ("dispersion", "long waves, dispersion"),
)  # fmt: skip
_WHIRLS = (0.003, 0.03)
# Errors at the ends of the colours, and at the lines.
_LEAST, _MOST, _LINES = 1e-5, 1.0, (0.01, 0.05)
_TICKS = (0.02, 0.05, 0.1, 0.2, 0.5)
_LAYERS = (0.02, 0.1, 0.3, 0.7)
_LOOKS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
_FRAME = Frame(left=0.72, top=0.24, between=0.3, below=0.42)


def maps_figure(cases: Cases) -> Figure:
    """Error of each model over depth and detuning, at a small whirl and a larger one."""
    with style():
        figure = Figure()
        rows: list[list[Any]] = []
        shown: Any = None
        for model, name in _MODELS:
            row: list[Any] = []
            for whirl in _WHIRLS:
                axes: Any = figure.add_axes((0, 0, 1, 1), label=f"{model} {whirl}")
                ratio, layer, error = grid_of(cases, model, whirl)
                lost, known = np.isnan(error), np.clip(error, _LEAST, _MOST)
                shown = axes.pcolormesh(
                    ratio, layer, known, norm="log", vmin=_LEAST, vmax=_MOST, cmap="viridis",
                    shading="nearest", rasterized=True,
                )  # fmt: skip
                axes.contourf(
                    ratio, layer, lost.astype(float), levels=[0.5, 1.5], colors="none", hatches=["////"]
                )
                axes.contour(
                    ratio, layer, np.log10(known), levels=np.log10(_LINES), colors=["white", "black"],
                    linewidths=0.9, linestyles=["--", "-"],
                )  # fmt: skip
                _dress(axes, first=not row, last=model == _MODELS[-1][0])
                axes.set_title(f"{name}, whirl {whirl:g} h0", fontsize=7.5, pad=2.5)
                row.append(axes)
            rows.append(row)
        text = (
            "Error of the force ratio G over the larger of |G| and 1, against the exact wave without "
            "friction. Dashed line 1 %, solid line 5 %. Hatched: no smooth steady wave was found, of the "
            "exact equations or of the model; alone, where short waves in the lee resonate. Of the two whirl "
            "speeds with this p the one below the spin."
        )
        lay_out(figure, rows, [1.25] * len(rows), _FRAME, text)
        _spread(figure, rows, shown)
        figure.alt = maps_words(cases)
    return figure


def _dress(axes: Any, first: bool, last: bool) -> None:
    axes.set_yscale("log")
    axes.set_yticks(_TICKS, [number(tick) for tick in _TICKS])
    axes.minorticks_off()
    axes.set_xlim(0.2, 2.15)
    axes.set_ylim(0.02, 0.7)
    axes.set_facecolor("0.88")
    axes.grid(visible=False)
    axes.set_ylabel("Depth h0/R" if first else "")
    axes.set_xlabel("Detuning p/p1" if last else "")
    axes.tick_params(labelleft=first, labelbottom=last)


def _spread(figure: Figure, rows: list[list[Any]], shown: Any) -> None:
    """Room between two columns, and the scale of colours beside them."""
    for row in rows:
        for k, axes in enumerate(row):
            box = axes.get_position()
            width = 0.88 * box.width
            axes.set_position((box.x0 - 0.1 * k * box.width, box.y0, width, box.height))
    top, bottom = rows[0][-1].get_position(), rows[-1][-1].get_position()
    bar: Any = figure.add_axes((top.x1 + 0.02, bottom.y0, 0.018, top.y1 - bottom.y0))
    figure.colorbar(shown, cax=bar, format=lambda value, _position: f"{number(100.0 * value)} %")
    bar.minorticks_off()
    bar.set_title("error", fontsize=7, pad=3)


def grid_of(cases: Cases, model: str, whirl: float) -> tuple[Array, Array, Array]:
    """p/p_1 (m,), h_0/R (n,) and a model's error (n, m) at one whirl w_0/h_0 of the maps' grid."""
    mine = np.isclose(cases.whirl, whirl)
    layers, ratios = np.unique(cases.layer[mine]), np.unique(cases.ratio[mine])
    error = np.full((layers.size, ratios.size), np.nan)
    rows, columns = np.searchsorted(layers, cases.layer[mine]), np.searchsorted(ratios, cases.ratio[mine])
    error[rows, columns] = cases.error(model)[mine]
    return ratios, layers, error


def maps_words(cases: Cases) -> str:
    """What a reader would take from the maps."""
    parts = []
    for model, name in _MODELS:
        for whirl in _WHIRLS:
            error = grid_of(cases, model, whirl)[2]
            found = error[np.isfinite(error)]
            parts.append(
                f"{name} at {whirl:g} of the depth: median {100.0 * np.median(found):.2g} %, below 1 % in "
                f"{100.0 * np.mean(found < 0.01):.0f} % of the places with a wave"
            )
    return f"Maps of the error over depth and detuning. {'; '.join(parts)}."


def ends_figure(ends: Ends) -> Figure:
    """Largest whirl of a smooth wave over the detuning, for some depths."""
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        axes.set_yscale("log")
        for layer, look in zip(_LAYERS, _LOOKS, strict=True):
            mine = np.isclose(ends.layer, layer)
            for side in (ends.ratio < 1.0, ends.ratio > 1.0):
                here = mine & side & (ends.whirl < 0.49)
                name = f"h0/R = {layer:g}" if side[0] else None
                axes.plot(ends.ratio[here], ends.whirl[here], color=look, label=name)
                folds = here & ends.fold
                axes.plot(ends.ratio[folds], ends.whirl[folds], "o", color=look, markersize=3.0)
                choked = mine & side & (ends.choked > 0.0)
                axes.plot(ends.ratio[choked], ends.choked[choked], ":", color=look, linewidth=0.9)
        axes.set_xlim(0.3, 1.8)
        axes.set_ylim(2e-4, 0.5)
        axes.yaxis.set_major_formatter(number)
        axes.set_xlabel("Detuning p/p1")
        axes.set_ylabel("Largest whirl w0/h0")
        text = (
            "Largest whirl whose steady wave, grown from rest, is smooth. Points: folds, beyond which there "
            "is none near. Lines without points: as far as the wave was followed, to its choking, to lee "
            "waves (dents) or to a sharp crest. Dotted: long waves without dispersion choke."
        )
        lay_out(figure, [[axes]], [2.8], Frame(left=0.72, top=0.15, between=0.12, below=0.42), text)
        figure.alt = ends_words(ends)
    return figure


def ends_words(ends: Ends) -> str:
    """What a reader would take from the lines."""
    parts = [
        f"{whirl:.2g} at p/p_1 = {ratio:g} and a depth of {layer:g}"
        for layer, ratio, whirl in zip(ends.layer, ends.ratio, ends.whirl, strict=True)
        if layer in _LAYERS and ratio in (0.6, 0.9, 1.1, 1.3)
    ]
    return f"Largest whirl over depth of a smooth wave, over the detuning: {'; '.join(parts)}."


def draw(out: Path) -> list[Path]:
    """Write both as PNG."""
    measured = kept()
    return [
        save_png(maps_figure(measured.maps), out, "wave_errors", "Error of the models beside the exact wave"),
        save_png(ends_figure(measured.ends), out, "wave_ends", "Where smooth waves end"),
    ]


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the figures.

    Parameters
    ----------
    arguments : of the command line; None: the process's own
    """
    parser = argparse.ArgumentParser(prog="python -m validation.exact.figure", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the figures")
    print(*draw(parser.parse_args(arguments).out), sep="\n")


if __name__ == "__main__":
    main()
