"""The exact wave, drawn: its force, the speeds of free waves, a wave near the highest and its spectrum."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fluid.waves import force_ratio
from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, style
from meshes.arrays import Array
from solvers.potential.steady import SteadyWave, follow, forced, free, linear_detuning, on_nodes
from solvers.potential.strip import nodes
from validation.breaking import kept
from validation.exact.branch import SMOOTH, detuning, whirl_speeds
from validation.exact.long_wave import steady_long_wave

_FRAME = Frame(left=0.72, top=0.15, between=0.55, below=0.42)
LAYER, SHARE = 0.1, 0.05  # h_0/R and w_0/h_0 of the force
# p/p_1 of the whirls, nearest to each other where waves end.
_RATIOS = np.concatenate(
    (
        np.arange(0.1, 0.7, 0.1),
        np.arange(0.66, 0.82, 0.02),
        np.arange(1.16, 1.4, 0.02),
        np.arange(1.4, 2.1, 0.1),
    )
)
_HIGH, _LEAST = 4.5, 1e-6  # of the force that is drawn, and of the differences
# Depths of free waves, and the last crest of the one whose highest is not known.
_DEPTHS, _THINNEST = (0.05, 0.1, 0.2, 0.3, 0.5), 1.70
_COLOURS = ("0.45", "#0072B2", "#E69F00", "#D55E00", "#009E73")
NEAR = 0.99  # of the highest crest, how far free waves are followed
# Shares of the height on the way, closer where the speed turns.
_WAY = (0.04, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.86, 0.91, 0.95, 0.98, 1.0)
SHARP = 0.3  # h_0/R of the wave that is drawn with its nodes
_NEAR_CREST, _EVERY = 0.12, 8  # what is drawn of its crest, rad, and of its nodes


def force_figure() -> Figure:
    """Force ratio of a whirl over its speed: exact, linear and by long waves."""
    exact, plain, dispersive = _forces()
    curves = (
        ("exact", exact, {"color": "black", "linewidth": 1.6}),
        ("long waves", plain, {"color": "#0072B2", "linestyle": (0, (5, 1.5))}),
        ("long waves, dispersion", dispersive, {"color": "#D55E00", "linestyle": (0, (1, 1.2))}),
    )
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1), label="force")
        below: Any = figure.add_axes((0, 0, 1, 0.5), label="difference")
        speed = np.linspace(0.62, 1.9, 1001)
        linear = np.asarray(force_ratio(1.0 / (1.0 - LAYER) ** 2, speed))
        shown = np.where(np.abs(linear) < _HIGH, linear, np.nan)
        axes.plot(speed, shown, color="0.6", linewidth=1.0, label="linear")
        pairs = np.array([whirl_speeds(LAYER, ratio) for ratio in _RATIOS])
        for column in pairs.T:
            small = np.asarray(force_ratio(1.0 / (1.0 - LAYER) ** 2, column))
            for side in (_RATIOS < 1.0, _RATIOS > 1.0):
                _draw_off(below, column[side], small[side], exact[side], {"color": "0.6"})
                for name, force, look in curves:
                    axes.plot(column[side], force[side], **look, label=name)
                    if force is not exact:
                        _draw_off(below, column[side], force[side], exact[side], look)
        axes.set_ylim(-_HIGH, _HIGH)
        axes.yaxis.set_major_formatter(number)
        axes.set_ylabel("Force ratio G")
        axes.tick_params(labelbottom=False)
        below.set_yscale("log")
        below.set_ylim(_LEAST, 0.5)
        below.set_yticks([1e-5, 1e-4, 1e-3, 1e-2, 1e-1], ["0.001 %", "0.01 %", "0.1 %", "1 %", "10 %"])
        below.minorticks_off()
        below.set_ylabel("Off the exact G")
        below.set_xlabel("Whirl speed over spin speed")
        for each in (axes, below):
            each.set_xlim(speed[0], speed[-1])
            each.xaxis.set_major_formatter(number)
        text = (
            f"Force on the drum over that of a full one, h0/R = {LAYER:g}, w0 = {SHARE:g} h0; below, how "
            "far it is off over the larger of |G| and 1. Lines end where no smooth steady wave follows the "
            "whirl. Each p belongs to two whirl speeds with one force."
        )
        frame = Frame(left=0.72, top=0.15, between=0.15, below=0.42)
        lay_out(figure, [[axes], [below]], [2.2, 1.4], frame, text)
        ends = [_RATIOS[np.isfinite(exact) & side] for side in (_RATIOS < 1.0, _RATIOS > 1.0)]
        figure.alt = (
            f"Force ratio over whirl speed; smooth exact waves up to p/p1 = {ends[0].max():.2f} and from "
            f"{ends[1].min():.2f} on."
        )
    return figure


def _draw_off(axes: Any, speed: Array, force: Array, exact: Array, look: dict[str, Any]) -> None:
    """How far a model is off, over the larger of |G| and 1."""
    off = np.abs(force - exact) / np.maximum(1.0, np.abs(exact))
    axes.plot(speed, np.maximum(off, _LEAST), **look)


def _forces() -> tuple[Array, Array, Array]:
    """G at each p/p_1: exact, long waves, long waves with dispersion; nan where no smooth wave is."""
    rows = []
    for ratio in _RATIOS:
        square = detuning(LAYER, float(ratio))
        wave = forced(LAYER, square, SHARE * LAYER, most=128)
        found = [wave.force_ratio if wave.converged and wave.tail < SMOOTH else math.nan]
        for dispersion in (False, True):
            long = steady_long_wave(LAYER, square, SHARE * LAYER, dispersion)
            found.append(long.force_ratio if long.smooth else math.nan)
        rows.append(found)
    exact, plain, dispersive = np.array(rows).T
    return exact, plain, dispersive


def last_crests() -> dict[float, float]:
    """Crest over h_0, by h_0/R, of the last free wave that is drawn."""
    highest = {round(row.depth, 6): row.crest for row in kept().highest}
    return {depth: NEAR * highest[depth] if depth in highest else _THINNEST for depth in _DEPTHS}


def climbed(layer: float, crest: float) -> list[SteadyWave]:
    """Natural waves of one crest up to one over h_0, as far as nodes resolve them."""
    found = [free(layer, 1.0 + _WAY[0] * (crest - 1.0))]
    for share in _WAY[1:]:
        ahead = follow(found[-1], {"whirl": 0.0, "crest": 1.0 + share * (crest - 1.0)}, 1)
        if not ahead.converged:
            break
        found.append(ahead)
    return found


def free_figure(climbs: dict[float, list[SteadyWave]]) -> Figure:
    """Speed of natural waves of rising crests over their crest, by h_0/R."""
    highest = {round(row.depth, 6): row for row in kept().highest}
    with style():
        figure = Figure()
        rows: list[list[Any]] = [[figure.add_axes((0, 0, 1, 1), label=name)] for name in ("behind", "ahead")]
        for (layer, waves), colour in zip(climbs.items(), _COLOURS, strict=False):
            p, crest = math.sqrt(linear_detuning(layer)), [1.0, *(wave.crest for wave in waves)]
            for [axes], way in zip(rows, (1, 0), strict=True):
                small = (p / (1.0 - p), -p / (1.0 + p))[way]
                speed = [small, *(wave.slip_speeds()[way] for wave in waves)]
                axes.plot(crest, speed, color=colour, label=f"h0/R = {layer:g}")
                if layer in highest:
                    last = highest[layer]
                    ends = (-1.0 / (2.0 + 1.0 / last.slip), last.slip)[way]
                    axes.plot(last.crest, ends, "o", color=colour, markersize=4.5)
        for [axes] in rows:
            axes.set_xlim(1.0, 1.75)
            axes.yaxis.set_major_formatter(number)
            axes.xaxis.set_major_formatter(number)
        rows[0][0].set_ylabel("s/Omega, backward")
        rows[1][0].set_ylabel("s/Omega, forward")
        rows[1][0].set_xlabel("Crest over h0")
        rows[0][0].tick_params(labelbottom=False)
        text = (
            "Speed of free waves of one crest along the wall, against the spin (above) and with it "
            f"(below), up to {100 * NEAR:.0f} % of the highest crest; dots: the highest wave, where the "
            "liquid at the crest stands still in the wave's frame. Each backward wave has the shape of the "
            "forward one."
        )
        frame = Frame(left=0.72, top=0.15, between=0.15, below=0.42)
        lay_out(figure, rows, [1.6, 1.6], frame, text)
        figure.alt = "; ".join(
            f"h0/R = {layer:g}: s = {waves[0].slip_speeds()[1]:.4f} at a crest of {waves[0].crest:.3f}, "
            f"{waves[-1].slip_speeds()[1]:.4f} at {waves[-1].crest:.3f}"
            for layer, waves in climbs.items()
        )
    return figure


def sharp_figure(wave: SteadyWave, lower: SteadyWave) -> Figure:
    """Wave near the highest with its nodes, and the spectra of it and of a lower one with a round crest."""
    with style():
        figure = Figure()
        whole: Any = figure.add_axes((0, 0, 0.6, 1), label="shape")
        near: Any = figure.add_axes((0.6, 0, 0.4, 1), label="crest")
        spectra: Any = figure.add_axes((0, 0, 1, 0.5), label="spectra")
        for found, look in ((lower, {"color": "0.55", "linewidth": 1.0}), (wave, {"color": "#0072B2"})):
            angle, depth = found.angle, found.depth / found.layer
            both = np.concatenate((-angle[:0:-1], angle)), np.concatenate((depth[:0:-1], depth))
            whole.plot(*both, **look)
            near.plot(*both, **look)
        angle, depth = wave.angle, wave.depth / wave.layer
        within = np.abs(angle) < _NEAR_CREST
        dots = {"color": "#D55E00", "markersize": 4.0, "markerfacecolor": "white"}
        near.plot(angle[::_EVERY], depth[::_EVERY], "o", **dots, label=f"each {_EVERY}th node")
        near.set_xlim(-_NEAR_CREST, _NEAR_CREST)
        near.set_ylim(float(depth[within].min()), 1.005 * float(depth.max()))
        near.set_xticks([-0.1, -0.05, 0.0, 0.05, 0.1])
        whole.set_xlim(-math.pi, math.pi)
        whole.set_xticks([-3, -2, -1, 0, 1, 2, 3])
        whole.set_ylabel("Depth over h0")
        for axes in (whole, near):
            axes.set_xlabel("Angle from the crest (rad)")
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
        to = nodes(wave.surface.size - 1, wave.at.crests, 1.0)
        even = on_nodes(wave, to)
        lines: tuple[tuple[SteadyWave, str, dict[str, Any]], ...] = (
            (lower, f"crest {lower.crest:.3f}", {"color": "0.55"}),
            (wave, f"crest {wave.crest:.3f}", {"color": "#0072B2"}),
            (even, "the same on even nodes", {"color": "#D55E00", "linestyle": (0, (5, 1.5))}),
        )
        for found, name, look in lines:
            size = np.arange(found.surface.size) * np.abs(found.at.spectrum(found.surface))
            spectra.semilogy(np.arange(1, size.size), size[1:] / size.max(), **look, label=name)
        spectra.set_ylim(1e-14, 3.0)
        spectra.set_yticks([1e-12, 1e-8, 1e-4, 1.0], ["1e-12", "1e-8", "1e-4", "1"])
        spectra.set_xlim(0, wave.surface.size)
        spectra.minorticks_off()
        spectra.set_xlabel("Number k of the cosine")
        spectra.set_ylabel("k |Yk| over largest")
        text = (
            f"Above: a free wave near the highest, h0/R = {wave.layer:g}, and a lower one (grey); right: "
            f"its crest, where {np.count_nonzero(within)} of {wave.surface.size} nodes from crest to trough "
            f"stand in {_NEAR_CREST:g} rad. Below: coefficients of the surface; nodes are added until the "
            "last tenth is rounding."
        )
        lay_out(figure, [[whole, near], [spectra]], [1.7, 1.6], _FRAME, text)
        box = near.get_position()
        near.set_position((box.x0 + 0.09, box.y0, box.width - 0.09, box.height))
        figure.alt = (
            f"A free wave with a crest of {wave.crest:.4f} depths, nearly a corner; its nodes crowd there. "
            f"Tail of its spectrum {wave.tail:.1e} with crowded nodes, {even.tail:.1e} on as many even ones."
        )
    return figure
