"""The map of self-excited whirl over speed and volume."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from leblanc.figures.page import RIGHT, WIDTH, Figure, Frame, lay_out, number, style
from leblanc.figures.page import save as save  # a figure is drawn and written together
from leblanc.results.provenance import one_line
from leblanc.units import ML, RPM
from meshes.arrays import Array

if TYPE_CHECKING:
    from leblanc.studies.whirl_map import StabilityRecord

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


def map_figure(record: StabilityRecord) -> Figure:
    """Growth rate above, whirl speed over spin speed below, over speed and volume of all liquid."""
    with style():
        figure = Figure()
        panels = [figure.add_axes((0, 0, 1, 1), label=name) for name in ("growth", "whirl")]
        bars = [_draw_growth(figure, panels[0], record), _draw_whirl(figure, panels[1], record)]
        for axes in panels:
            _outline(axes, record, hatched=axes is panels[0])
            axes.set_ylabel("Liquid (ml)")
            axes.set_xlim(record.speed[0] * RPM, record.speed[-1] * RPM)
            axes.set_ylim(0.0, record.volume[-1] * ML)
            axes.grid(visible=False)
            axes.xaxis.set_major_formatter(_label)
            axes.yaxis.set_major_formatter(_label)
        panels[0].tick_params(labelbottom=False)
        panels[1].set_xlabel("Speed (rpm)")
        above = panels[0].secondary_xaxis("top", functions=(_to_rate, _to_rpm))
        above.set_xlabel("Speed (rad/s)")
        above.xaxis.set_major_formatter(_label)
        lay_out(figure, [[axes] for axes in panels], [PANEL] * 2, FRAME, _caption(record), LINES)
        for axes, beside in zip(panels, bars, strict=True):
            _place_bars(figure, axes, beside)
    return figure


def _label(value: float, _at: float) -> str:
    return number(value)


def _to_rate(rpm: ArrayLike) -> ArrayLike:
    return np.asarray(rpm) / RPM


def _to_rpm(rate: ArrayLike) -> ArrayLike:
    return np.asarray(rate) * RPM


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


def _colours(
    figure: Figure, axes: Axes, record: StabilityRecord, values: Array, label: str, **look: Any
) -> Axes:
    """Colours of the values that are numbers; their bar."""
    x, y = record.speed * RPM, record.volume * ML
    drawn = axes.pcolormesh(x, y, values, shading="nearest", rasterized=True, **look)
    bar = figure.add_axes((0, 0, 1, 1), label=label)
    short = bool(np.nanmin(values) < drawn.get_clim()[0])
    figure.colorbar(drawn, cax=bar, label=label, format=_label, extend="min" if short else "neither")
    return bar


def _draw_growth(figure: Figure, axes: Axes, record: StabilityRecord) -> list[Axes]:
    """Growth and decay, each by its own colours; neutral and unknown stay white."""
    growth, bars = record.growth, []
    up, down = np.where(growth > 0.0, growth, np.nan), np.where(growth < 0.0, growth, np.nan)
    if np.isfinite(up).any():
        top = float(np.nanmax(up))
        bars.append(_colours(figure, axes, record, up, "Growth rate (1/s)", cmap=GROWS, vmin=0.0, vmax=top))
    if np.isfinite(down).any():
        low = float(np.nanpercentile(down, DARKEST))
        # The darkest blues would hide the dots.
        bars.append(
            _colours(figure, axes, record, down, "Decay (1/s)", cmap=DECAYS, vmin=1.5 * low, vmax=0.0)
        )
    return bars


def _draw_whirl(figure: Figure, axes: Axes, record: StabilityRecord) -> list[Axes]:
    """Whirl speed over spin speed, where a whirl grows."""
    axes.set_facecolor(NO_WHIRL)
    ratio = np.where(record.growth > 0.0, record.whirl_speed / record.speed, np.nan)
    if not np.isfinite(ratio).any():
        axes.text(0.5, 0.5, "no whirl grows", transform=axes.transAxes, ha="center", va="center")
        return []
    low, high = float(np.nanmin(ratio)), float(np.nanmax(ratio))
    label = "Whirl speed/spin speed (\N{EN DASH})"
    return [_colours(figure, axes, record, ratio, label, cmap=RATIO, vmin=low, vmax=max(high, low + 1e-3))]


def signed_distance(record: StabilityRecord) -> Array:
    """Distance of each point from the nearest edge of its volume's bands, positive inside a band, rad/s.

    Along a row it is linear next to an edge, so that a contour at zero passes through the refined edges of
    every band that is some steps wide. The ends of the range of speeds are no edges.

    Parameters
    ----------
    record : the map

    Returns
    -------
    Over volume and speed, shape (v, n)
    """
    first, last = record.speed[0], record.speed[-1]
    rows = []
    for bands in record.edges:
        inside = np.zeros(record.speed.shape, dtype=bool)
        distance = np.full(record.speed.shape, last - first)
        for low, high in bands:
            inside |= (record.speed >= low) & (record.speed <= high)
            for end in (low, high):
                if first < end < last:
                    distance = np.minimum(distance, np.abs(record.speed - end))
        rows.append(np.where(inside, distance, -distance))
    return np.array(rows)


def _outline(axes: Axes, record: StabilityRecord, hatched: bool) -> None:
    """Unstable region hatched and outlined, what is out of range dotted, the scene's own volume dashed."""
    x, y, distance = record.speed * RPM, record.volume * ML, signed_distance(record)
    key = {"facecolor": "none", "edgecolor": OUTLINE, "linewidth": 0.5}
    if np.any(distance > 0.0):
        if hatched:
            axes.contourf(x, y, distance, levels=[0.0, np.inf], colors="none", hatches=["//"])
        if np.any(distance < 0.0):
            axes.contour(x, y, distance, levels=[0.0], colors=[OUTLINE], linewidths=1.1)
        axes.fill([], [], hatch="///", label="a whirl grows: unstable", **key)
    if not record.in_range.all():
        out = np.where(record.in_range, 0.0, 1.0)
        axes.contourf(x, y, out, levels=[0.5, 1.5], colors="none", hatches=[".."])
        axes.contour(x, y, out, levels=[0.5], colors=["0.45"], linewidths=0.8, linestyles=":")
        axes.fill([], [], hatch="...", label="model out of range", **key)
    narrow = [
        (0.5 * (low + high) * RPM, volume * ML)
        for bands, volume in zip(record.edges, record.volume, strict=True)
        for low, high in bands
        if np.searchsorted(record.speed, low) == np.searchsorted(record.speed, high)
    ]
    if narrow:
        style = {"color": OUTLINE, "markersize": 2.5, "linestyle": "none", "marker": "."}
        axes.plot(*np.array(narrow).T, label="unstable band between two speeds", **style)
    if 0.0 < record.scene_volume <= record.volume[-1]:
        axes.axhline(
            record.scene_volume * ML, label=f"scene's volume, {record.scene_volume * ML:.4g} ml", **OWN
        )


def _caption(record: StabilityRecord) -> str:
    """What is shown, the scene, the model, both dampings, notes."""
    assumed = ", ".join(one_line(one) for one in record.assumed) or "nothing"
    notes = " ".join(one_line(note) for note in record.notes)
    return (
        "Whirl that grows most, infinitesimal, over speed and all liquid together; below, its "
        "speed in space over the spin's, where it grows. "
        f"Scene: {one_line(record.name)}. Liquid model: exact linear theory of the plane layer; liquid "
        f"friction: {record.friction}; support: {record.damping}. {notes} Assumed: {assumed}."
    )
