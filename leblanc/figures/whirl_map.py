"""The map of self-excited whirl over speed and volume."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.figures.page import RIGHT, WIDTH, Caption, Figure, Frame, add_rate_axis, lay_out, number, style
from leblanc.figures.page import save as save  # a figure is drawn and written together
from leblanc.results.base import one_line
from leblanc.results.whirl_map import WhirlMap
from leblanc.text.whirl_map import alt
from leblanc.units import ML, RPM, VOLUME, with_unit
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

FRAME = Frame(left=0.72, top=0.46, between=0.18, below=0.42)
PANEL, BAR, ROOM, GAP = (
    2.3,
    0.13,
    0.85,
    0.08,
)  # inches: panel's height, bar's width, room for it, between bars
DARKEST = 2.0  # per cent of the decays that are faster than the colours tell apart
LINES = 9  # of the caption
GROWS, DECAYS, RATIO = "YlOrBr", "Blues_r", "cividis"
OUTLINE, NO_WHIRL = "0.1", "0.93"
OWN = {"color": "black", "linewidth": 1.2, "linestyle": (0, (6, 2)), "zorder": 4}


def map_figure(result: WhirlMap) -> Figure:
    """Growth rate above, whirl speed over spin speed below, over speed and volume of all liquid."""
    with style():
        figure = Figure()
        figure.alt = alt(result)
        panels = [figure.add_axes((0, 0, 1, 1), label=name) for name in ("growth", "whirl")]
        bars = [_draw_growth(figure, panels[0], result), _draw_whirl(figure, panels[1], result)]
        for axes in panels:
            _outline(axes, result, hatched=axes is panels[0])
            axes.set_ylabel("Liquid (ml)")
            axes.set_xlim(result.speed[0] * RPM, result.speed[-1] * RPM)
            axes.set_ylim(0.0, result.volume[-1] * ML)
            axes.grid(visible=False)
            axes.xaxis.set_major_formatter(_label)
            axes.yaxis.set_major_formatter(_label)
        panels[0].tick_params(labelbottom=False)
        panels[1].set_xlabel("Speed (rpm)")
        add_rate_axis(panels[0])
        lay_out(figure, [[axes] for axes in panels], [PANEL] * 2, FRAME, _caption(result), LINES)
        for axes, beside in zip(panels, bars, strict=True):
            _place_bars(figure, axes, beside)
    return figure


def _label(value: float, _at: float) -> str:
    return number(value)


def _place_bars(figure: Figure, axes: Axes, bars: list[Axes]) -> None:
    """Make room on the right of a panel for its colour bars, one above the other."""
    box = axes.get_position()
    width = box.width - (ROOM - RIGHT) / WIDTH
    axes.set_position((box.x0, box.y0, width, box.height))
    gap = GAP / figure.get_figheight()
    height = (box.height - gap * (len(bars) - 1)) / max(len(bars), 1)
    for i, bar in enumerate(bars):
        bottom = box.y1 - height - i * (height + gap)
        bar.set_position((box.x0 + width + 0.1 / WIDTH, bottom, BAR / WIDTH, height))


def _colours(figure: Figure, axes: Axes, result: WhirlMap, values: Array, label: str, **look: Any) -> Axes:
    """Colours of the values that are numbers; their bar."""
    x, y = result.speed * RPM, result.volume * ML
    drawn = axes.pcolormesh(x, y, values, shading="nearest", rasterized=True, **look)
    bar = figure.add_axes((0, 0, 1, 1), label=label)
    short = bool(np.nanmin(values) < drawn.get_clim()[0])
    figure.colorbar(drawn, cax=bar, label=label, format=_label, extend="min" if short else "neither")
    return bar


def _draw_growth(figure: Figure, axes: Axes, result: WhirlMap) -> list[Axes]:
    """Growth and decay, each by its own colours; neutral and unknown stay white."""
    growth, bars = result.growth, []
    up, down = np.where(growth > 0.0, growth, np.nan), np.where(growth < 0.0, growth, np.nan)
    if np.isfinite(up).any():
        top = float(np.nanmax(up))
        bars.append(_colours(figure, axes, result, up, "Growth rate (1/s)", cmap=GROWS, vmin=0.0, vmax=top))
    if np.isfinite(down).any():
        low = float(np.nanpercentile(down, DARKEST))
        # The darkest blues would hide the dots.
        bars.append(
            _colours(figure, axes, result, down, "Decay (1/s)", cmap=DECAYS, vmin=1.5 * low, vmax=0.0)
        )
    return bars


def _draw_whirl(figure: Figure, axes: Axes, result: WhirlMap) -> list[Axes]:
    """Whirl speed over spin speed, where a whirl grows."""
    axes.set_facecolor(NO_WHIRL)
    ratio = np.where(result.growth > 0.0, result.whirl_speed / result.speed, np.nan)
    if not np.isfinite(ratio).any():
        axes.text(0.5, 0.5, "no whirl grows", transform=axes.transAxes, ha="center", va="center")
        return []
    low, high = float(np.nanmin(ratio)), float(np.nanmax(ratio))
    label = "Whirl speed/spin speed (\N{EN DASH})"
    return [_colours(figure, axes, result, ratio, label, cmap=RATIO, vmin=low, vmax=max(high, low + 1e-3))]


def signed_distance(result: WhirlMap) -> Array:
    """Distance of each point from the nearest edge of its volume's bands, positive inside a band, rad/s.

    Along a row it is linear next to an edge, so that a contour at zero passes through the refined edges of
    every band that is some steps wide. The ends of the range of speeds are no edges.

    Parameters
    ----------
    result : the map

    Returns
    -------
    Over volume and speed, shape (v, n)
    """
    first, last = result.speed[0], result.speed[-1]
    rows = []
    for bands in result.edges:
        inside = np.zeros(result.speed.shape, dtype=bool)
        distance = np.full(result.speed.shape, last - first)
        for low, high in bands:
            inside |= (result.speed >= low) & (result.speed <= high)
            for end in (low, high):
                if first < end < last:
                    distance = np.minimum(distance, np.abs(result.speed - end))
        rows.append(np.where(inside, distance, -distance))
    return np.array(rows)


def _outline(axes: Axes, result: WhirlMap, hatched: bool) -> None:
    """Unstable region hatched and outlined, what is out of range dotted, the scene's own volume dashed."""
    x, y, distance = result.speed * RPM, result.volume * ML, signed_distance(result)
    key = {"facecolor": "none", "edgecolor": OUTLINE, "linewidth": 0.5}
    if np.any(distance > 0.0):
        if hatched:
            axes.contourf(x, y, distance, levels=[0.0, np.inf], colors="none", hatches=["//"])
        if np.any(distance < 0.0):
            axes.contour(x, y, distance, levels=[0.0], colors=[OUTLINE], linewidths=1.1)
        axes.fill([], [], hatch="///", label="a whirl grows: unstable", **key)
    if not result.in_range.all():
        out = np.where(result.in_range, 0.0, 1.0)
        axes.contourf(x, y, out, levels=[0.5, 1.5], colors="none", hatches=[".."])
        axes.contour(x, y, out, levels=[0.5], colors=["0.45"], linewidths=0.8, linestyles=":")
        axes.fill([], [], hatch="...", label="model out of range", **key)
    lost = np.isnan(result.growth)
    if lost.any():
        style = {
            "color": OUTLINE,
            "markersize": 3.5,
            "linestyle": "none",
            "marker": "x",
            "markeredgewidth": 0.8,
        }
        rows, columns = np.nonzero(lost)
        axes.plot(x[columns], y[rows], label="growth not known", **style)
    narrow = [
        (0.5 * (low + high) * RPM, volume * ML)
        for bands, volume in zip(result.edges, result.volume, strict=True)
        for low, high in bands
        if np.searchsorted(result.speed, low) == np.searchsorted(result.speed, high)
    ]
    if narrow:
        style = {"color": OUTLINE, "markersize": 2.5, "linestyle": "none", "marker": "."}
        axes.plot(*np.array(narrow).T, label="unstable band between two speeds", **style)
    if 0.0 < result.scene_volume <= result.volume[-1]:
        axes.axhline(
            result.scene_volume * ML, label=f"scene's volume, {with_unit(result.scene_volume, VOLUME)}", **OWN
        )


def _caption(result: WhirlMap) -> Caption:
    """What is shown, the scene, the model, both dampings, notes."""
    assumed = ", ".join(map(one_line, result.assumed)) or "nothing"
    notes = " ".join(one_line(note.text) for note in result.notes)
    return Caption(
        "Whirl that grows most, infinitesimal, over speed and all liquid together; below, its speed in space "
        "over the spin's, where it grows.",
        f"Scene: {one_line(result.name)}. Liquid model: exact linear theory of the plane layer; liquid "
        f"friction: {result.friction}; support: {result.damping}. {notes} Assumed: {assumed}.",
    )
