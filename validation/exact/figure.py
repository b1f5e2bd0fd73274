"""The kept errors as maps over depth and detuning, and where smooth waves end, drawn.

`python -m validation.exact.figure --out docs/images`; `python -m validation.exact` measures them anew.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style
from meshes.arrays import Array
from validation.exact import Cases, Ends, kept

_FRAME = Frame(left=0.78, top=0.28, between=0.3, below=0.42)
# Whirls over the depth that maps are drawn for, least and largest error of the colours, lines.
_WHIRLS, _LEAST, _MOST, _LINES = (0.003, 0.03), 1e-6, 1.0, (0.01, 0.05)
_NAMES = {
    "linear": "linear",
    "long_wave": "long_wave",
    "dispersion": "long_wave --dispersion",
    "kdv": "kdv",
    "whitham": "kdv --dispersion",
}
_DEPTHS = {0.03: "#0072B2", 0.1: "#D55E00", 0.3: "#009E73", 0.6: "#CC79A7"}


def on_grid(cases: Cases, name: str, whirl: float) -> tuple[Array, Array, Array]:
    """Ratios, depths and a model's error at one whirl, shape (depths, ratios); nan where there is no wave.

    Parameters
    ----------
    cases : of the maps
    name : of the model
    whirl : w_0/h_0
    """
    rows = cases.whirl == whirl
    layer, across = np.unique(cases.layer[rows], return_inverse=True)
    ratio, along = np.unique(cases.ratio[rows], return_inverse=True)
    error = np.full((layer.size, ratio.size), np.nan)
    error[across, along] = cases.error(name)[rows]
    return ratio, layer, error


def maps_figure(cases: Cases) -> Figure:
    """A panel for each model at a smaller and a larger whirl.

    Parameters
    ----------
    cases : of the maps
    """
    with style():
        figure, rows = Figure(), []
        for name, title in _NAMES.items():
            row: list[Any] = []
            for whirl in _WHIRLS:
                axes: Any = figure.add_axes((0, 0, 1, 1), label=f"{name}{whirl}")
                ratio, layer, error = on_grid(cases, name, whirl)
                axes.patch.set(facecolor="white", edgecolor="0.6", hatch="////", linewidth=0.0)
                seen = np.clip(error, 1.01 * _LEAST, 0.99 * _MOST)
                mesh = axes.pcolormesh(
                    ratio, layer, seen, norm="log", vmin=_LEAST, vmax=_MOST, cmap="viridis"
                )
                axes.contour(ratio, layer, seen, levels=_LINES, colors=("white", "red"), linewidths=0.9)
                axes.set_yscale("log")
                axes.set_yticks([0.02, 0.05, 0.1, 0.2, 0.5], ["0.02", "0.05", "0.1", "0.2", "0.5"])
                axes.set_yticks([], minor=True)
                axes.set_title(f"{title}, whirl {whirl:g} of the depth", loc="left", fontsize=7)
                axes.tick_params(labelbottom=name == "whitham", labelleft=whirl == _WHIRLS[0])
                row.append(axes)
            row[0].set_ylabel("Depth over radius")
            rows.append(row)
        for axes in rows[-1]:
            axes.set_xlabel("Detuning p/p\N{SUBSCRIPT ONE}")
        bar = rows[0][1].inset_axes((0.6, 0.2, 0.35, 0.06))
        figure.colorbar(mesh, cax=bar, orientation="horizontal", ticks=[1e-6, 1e-4, 1e-2, 1.0])
        bar.set_xticks([1e-6, 1e-4, 1e-2, 1.0], ["1e-6", "1e-4", "0.01", "1"])
        bar.tick_params(labelsize=6, colors="white")
        text = (
            "Error of the force ratio beside the exact wave, over the larger of it and 1. White line: 1 %, "
            "red: 5 %. Hatched: no smooth steady wave was found, of the liquid or the model. Long waves by "
            "their steady equations, without the error of cells."
        )
        lay_out(figure, rows, [1.25] * len(rows), _FRAME, text)
        parts = [
            f"{title} at {whirl:g}: median {np.nanmedian(on_grid(cases, name, whirl)[2]):.1e}"
            for name, title in _NAMES.items()
            for whirl in _WHIRLS
        ]
        figure.alt = f"Maps of the error over detuning and depth. {'; '.join(parts)}."
    return figure


def ends_figure(ends: Ends) -> Figure:
    """Largest whirl of a smooth wave over the detuning at a few depths.

    Parameters
    ----------
    ends : of branches
    """
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        for depth, colour in _DEPTHS.items():
            rows = (ends.layer == depth) & (ends.whirl < 0.5) & (ends.whirl > 0.0)
            for side in (ends.ratio < 1.0, ends.ratio > 1.0):
                label = f"depth {depth:g} of the radius" if side[0] else None
                axes.plot(ends.ratio[rows & side], ends.whirl[rows & side], color=colour, label=label)
                # Nearer the resonance a way in whirl may step over the choking onto another wave.
                choked = (ends.layer == depth) & side & (np.abs(ends.ratio - 1.0) > 0.05)
                look: dict[str, Any] = {"color": colour, "linestyle": (0, (4, 2)), "linewidth": 0.8}
                axes.plot(ends.ratio[choked], ends.choked[choked], **look)
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(number)
        axes.set_ylim(1e-4, 0.6)
        axes.set_xlabel("Detuning p/p\N{SUBSCRIPT ONE}")
        axes.set_ylabel("Largest whirl over depth")
        text = (
            "Solid: the exact wave; above 1 a fold, below 1 the last smooth wave found on the way from rest. "
            "Dashed: choking of long waves without dispersion, not drawn next to 1."
        )
        lay_out(figure, [[axes]], [2.8], _FRAME, text)
        figure.alt = "Largest whirl of a smooth steady wave over detuning: none at 1, rising to both sides."
    return figure


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw both figures.

    Parameters
    ----------
    arguments : of the command line; None: the process's own
    """
    parser = argparse.ArgumentParser(prog="python -m validation.exact.figure", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    out = parser.parse_args(arguments).out
    measured = kept()
    for figure, stem, title in (
        (maps_figure(measured.maps), "wave_errors", "Errors of the wave models"),
        (ends_figure(measured.ends), "wave_ends", "Where smooth steady waves end"),
    ):
        save(figure, out, stem, title).svg.unlink()


if __name__ == "__main__":
    main()
