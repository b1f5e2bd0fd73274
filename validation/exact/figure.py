"""The kept errors of the models beside the fully nonlinear wave, drawn: maps, and where smooth waves end.

`python -m validation.exact.figure --out docs/images`; `python -m tests.exact` measures them anew.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from meshes.arrays import Array
from validation.exact import Cases, Ends, kept
from validation.page import Figure, number, page
from validation.study import launch, shown

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


def maps_figure(cases: Cases) -> Figure:
    """Error of each model over depth and detuning, at a small whirl and a larger one."""
    text = (
        "Error of the force ratio G over the larger of |G| and 1, against the exact wave without "
        "friction. Dashed line 1 %, solid line 5 %. Hatched: no smooth steady wave was found, of the "
        "exact equations or of the model; alone, where short waves in the lee resonate. Of the two whirl "
        "speeds with this p the one below the spin."
    )
    size = (2,) * len(_MODELS)
    with page([1.25] * len(size), text, size, top=0.24, between=0.3) as (figure, rows):
        for row, (model, name) in zip(rows, _MODELS, strict=True):
            for axes, whirl in zip(row, _WHIRLS, strict=True):
                ratio, layer, error = grid_of(cases, model, whirl)
                lost, known = np.isnan(error), np.clip(error, _LEAST, _MOST)
                colours = axes.pcolormesh(
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
                _dress(axes, first=axes is row[0], last=row is rows[-1])
                axes.set_title(f"{name}, whirl {whirl:g} h0", fontsize=7.5, pad=2.5)
        bar: Any = figure.add_axes((0, 0, 1, 1), label="bar")
        figure.colorbar(colours, cax=bar, format=lambda value, _position: f"{number(100.0 * value)} %")
        bar.minorticks_off()
        bar.set_title("error", fontsize=7, pad=3)
        figure.alt = maps_words(cases)
    for row in rows:
        for k, axes in enumerate(row):
            box = axes.get_position()
            axes.set_position((box.x0 - 0.1 * k * box.width, box.y0, 0.88 * box.width, box.height))
    first, last = rows[0][-1].get_position(), rows[-1][-1].get_position()
    bar.set_position((first.x1 + 0.02, last.y0, 0.018, first.y1 - last.y0))
    return figure


def _dress(axes: Any, first: bool, last: bool) -> None:
    axes.set_yscale("log")
    axes.set_yticks(_TICKS, [number(tick) for tick in _TICKS])
    axes.minorticks_off()
    axes.set(xlim=(0.2, 2.15), ylim=(0.02, 0.7))
    axes.set_facecolor("0.88")
    axes.grid(visible=False)
    axes.set(ylabel="Depth h0/R" if first else "", xlabel="Detuning p/p1" if last else "")
    axes.tick_params(labelleft=first, labelbottom=last)


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
    text = (
        "Largest whirl whose steady wave, grown from rest, is smooth. Points: folds, beyond which there "
        "is none near. Lines without points: as far as the wave was followed, to its choking, to lee "
        "waves (dents) or to a sharp crest. Dotted: long waves without dispersion choke."
    )
    with page([2.8], text) as (figure, [[axes]]):
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
        axes.set(xlim=(0.3, 1.8), ylim=(2e-4, 0.5))
        axes.yaxis.set_major_formatter(number)
        axes.set(xlabel="Detuning p/p1", ylabel="Largest whirl w0/h0")
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


if __name__ == "__main__":
    measured = kept()
    maps, ends = partial(maps_figure, measured.maps), partial(ends_figure, measured.ends)
    launch(shown(wave_errors=maps, wave_ends=ends))
