"""Figures of a map: self-excited whirl over speed and volume or another number, and how large it grows."""

from __future__ import annotations

from typing import Any

import numpy as np

from leblanc.core.notes import assumed_words, one_line
from leblanc.core.units import ML, MM, MM_PEAK, RPM, VOLUME, with_unit
from leblanc.plotting.page import (
    RIGHT,
    WIDTH,
    Caption,
    Figure,
    Frame,
    add_rate_axis,
    lay_out,
    number,
    part_of,
    style,
)
from leblanc.scene.schema.paths import path_words
from leblanc.studies.map.answer import WhirlMap, alt, cycles_alt
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

FRAME = Frame(left=0.72, top=0.46, between=0.72, below=0.42)
PANEL, BAR, BESIDE, ROOM = 2.3, 0.13, 0.55, 1.35  # inches: panel's height, bar's width, left of it, in all
DARKEST = 2.0  # per cent of the decays that are faster than the colours tell apart
SHALLOWEST = 0.05  # of the fastest decay: growth slower than that is reported by outline and hatch alone
GROWTH, RATIO = "RdBu_r", "cividis"
PALER = (0.1, 0.9)  # of the colours of growth: their ends would hide lines and dots
OUTLINE, NO_WHIRL = "0.1", "0.93"
HATCH, DOTS = (0.0, 0.0, 0.0, 0.5), (0.0, 0.0, 0.0, 0.35)  # thin and sparse: the colours stay readable
_SHOWN = ("branch", "speed", "amplitude", "whirl_speed", "stable", "in_range")
ASIDE = 0.4  # inches, for the axis on the right
CYCLES_FRAME = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
BAND = {"facecolor": "0.9", "hatch": "//", "edgecolor": (0.0, 0.0, 0.0, 0.15), "linewidth": 0.0, "zorder": 0}
STABLE = {"color": "#0072B2", "linewidth": 1.9, "linestyle": "-", "zorder": 3}
LEFT = {"color": "#D55E00", "linewidth": 1.3, "linestyle": (0, (4, 2)), "zorder": 2.8}
FAR = {"linewidth": 0.7}
FOLD = {"color": "black", "marker": "D", "markersize": 4.0, "linestyle": "none", "zorder": 5}
OWN = {"color": "black", "linewidth": 1.2, "linestyle": (0, (6, 2)), "zorder": 4}


def map_figure(result: WhirlMap) -> Figure:
    """Growth rate above, whirl speed over spin speed below, over speed and all liquid, or what varies."""
    with style():
        figure = Figure()
        figure.alt = alt(result)
        panels = [figure.add_axes((0, 0, 1, 1), label=name) for name in ("growth", "whirl")]
        bars = [_draw_growth(figure, panels[0], result), _draw_whirl(figure, panels[1], result)]
        for axes in panels:
            _outline(axes, result, hatched=axes is panels[0])
            label, y = _second(result)
            axes.set_ylabel(label)
            axes.set_xlim(result.speed[0] * RPM, result.speed[-1] * RPM)
            axes.set_yscale("log" if result.log else "linear")
            axes.set_ylim(0.0 if result.value is None else y[0], y[-1])
            axes.grid(visible=False)
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
            axes.set_xlabel("Speed (rpm)")
            _add_ratios(axes, result)
        lay_out(figure, [[axes] for axes in panels], [PANEL] * 2, FRAME, _caption(result))
        for axes, bar in zip(panels, bars, strict=True):
            _place_bar(axes, bar)
    return figure


def _second(result: WhirlMap) -> tuple[str, Array]:
    """Label of the second axis, and its values as drawn."""
    if result.value is None:
        return "Liquid (ml)", result.volume * ML
    _, values, unit = result.second
    name = path_words(*result.paths)
    return f"{name} ({unit.name})" if unit.name else name, values * unit.count


def _add_ratios(axes: Axes, result: WhirlMap) -> None:
    """Speed over the critical one above, share of what the chambers hold on the right."""
    critical, whole = result.critical_speed_dry * RPM, result.capacity * ML
    if critical > 0.0:
        above = axes.secondary_xaxis("top", functions=(lambda x: x / critical, lambda x: x * critical))
        above.set_xlabel("Speed/critical speed without liquid (\N{EN DASH})")
        above.xaxis.set_major_formatter(number)
    else:
        add_rate_axis(axes)
    if whole > 0.0:
        share = axes.secondary_yaxis(
            "right", functions=(lambda y: 100.0 * y / whole, lambda y: y * whole / 100.0)
        )
        share.set_ylabel("Fill (% of the chambers)")
        share.yaxis.set_major_formatter(number)


def _place_bar(axes: Axes, bar: Axes | None) -> None:
    """Make room on the right of a panel for its colour bar."""
    box = axes.get_position()
    width = box.width - (ROOM - RIGHT) / WIDTH
    axes.set_position((box.x0, box.y0, width, box.height))
    if bar is not None:
        bar.set_position((box.x0 + width + BESIDE / WIDTH, box.y0, BAR / WIDTH, box.height))


def _colours(figure: Figure, axes: Axes, result: WhirlMap, values: Array, label: str, **look: Any) -> Axes:
    """Colours of the values that are numbers; their bar."""
    x, y = result.speed * RPM, _second(result)[1]
    drawn = axes.pcolormesh(x, y, values, shading="nearest", rasterized=True, **look)
    bar = figure.add_axes((0, 0, 1, 1), label=label)
    short = bool(np.nanmin(values) < drawn.get_clim()[0])
    figure.colorbar(drawn, cax=bar, label=label, format=number, extend="min" if short else "neither")
    return bar


def _draw_growth(figure: Figure, axes: Axes, result: WhirlMap) -> Axes | None:
    """Growth and decay on one scale about zero, which is white; unknown stays white as well."""
    growth = result.growth
    known = growth[np.isfinite(growth)]
    if not known.size:
        return None
    decay = known[known < 0.0]
    low = -float(np.percentile(decay, DARKEST)) if decay.size else 0.0
    top = float(known.max(initial=0.0))
    most = max(top, SHALLOWEST * low) if top > 0.0 else low
    colours = part_of(GROWTH, *PALER)
    look = {"cmap": colours, "vmin": -(most or 1.0), "vmax": most or 1.0}
    return _colours(figure, axes, result, growth, "Growth rate, decay below 0 (1/s)", **look)


def _draw_whirl(figure: Figure, axes: Axes, result: WhirlMap) -> Axes | None:
    """Whirl speed over spin speed, where a whirl grows."""
    axes.set_facecolor(NO_WHIRL)
    ratio = np.where(result.growth > 0.0, result.whirl_speed / result.speed, np.nan)
    if not np.isfinite(ratio).any():
        axes.text(0.5, 0.5, "no whirl grows", transform=axes.transAxes, ha="center", va="center")
        return None
    low, high = float(np.nanmin(ratio)), float(np.nanmax(ratio))
    label = "Whirl speed/spin speed (\N{EN DASH})"
    return _colours(figure, axes, result, ratio, label, cmap=RATIO, vmin=low, vmax=max(high, low + 1e-3))


def signed_distance(result: WhirlMap) -> Array:
    """Distance from the nearest edge of its volume's bands, positive inside a band, rad/s, shape (v, n).

    Along a row it is linear next to an edge, so that a contour at zero passes through the refined edges of
    every band that is some steps wide. The ends of the range of speeds are no edges.
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
    x, y, distance = result.speed * RPM, _second(result)[1], signed_distance(result)
    key = {"facecolor": "none", "linewidth": 0.0}
    if np.any(distance > 0.0):
        if hatched:
            area = axes.contourf(x, y, distance, levels=[0.0, np.inf], colors="none", hatches=["/"])
            area.set(edgecolor=HATCH, linewidth=0.0)
        if np.any(distance < 0.0):
            axes.contour(x, y, distance, levels=[0.0], colors=[OUTLINE], linewidths=1.1)
        axes.fill([], [], hatch="//", edgecolor=HATCH, label="a whirl grows: unstable", **key)
    if not result.in_range.all():
        out = np.where(result.in_range, 0.0, 1.0)
        area = axes.contourf(x, y, out, levels=[0.5, 1.5], colors="none", hatches=[".."])
        area.set(edgecolor=DOTS, linewidth=0.0)
        axes.contour(x, y, out, levels=[0.5], colors=["0.45"], linewidths=0.8, linestyles=":")
        axes.fill([], [], hatch="...", edgecolor=DOTS, label="model out of range", **key)
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
        (0.5 * (low + high) * RPM, at)
        for bands, at in zip(result.edges, y.tolist(), strict=True)
        for low, high in bands
        if np.searchsorted(result.speed, low) == np.searchsorted(result.speed, high)
    ]
    if narrow:
        style = {"color": OUTLINE, "markersize": 2.5, "linestyle": "none", "marker": "."}
        axes.plot(*np.array(narrow).T, label="unstable band between two speeds", **style)
    _, values, unit = result.second
    own, label = result.scene_volume, f"scene's volume, {with_unit(result.scene_volume, VOLUME)}"
    if result.value is not None:
        own, label = result.scene_value, f"scene: {unit.text(result.scene_value)}"
    if 0.0 < own <= values[-1]:
        axes.axhline(own * (ML if result.value is None else unit.count), label=label, **OWN)


def cycles_figure(result: WhirlMap) -> Figure:
    """Amplitude of self-excited whirls above, their frequency below, over speed."""
    shown: dict[str, Array] = {
        name: np.array([row[name] for row in result.cycles], dtype=float) for name in _SHOWN
    }
    with style():
        figure = Figure()
        figure.alt = cycles_alt(result)
        panels: list[Axes] = [
            figure.add_axes((0, 0, 1, 1), label=name) for name in ("amplitude", "frequency")
        ]
        ends = [float(end) * RPM for end in (result.speed[0], result.speed[-1])]
        for axes, name, scale in zip(panels, ("amplitude", "whirl_speed"), (MM, RPM), strict=True):
            for k, (low, high) in enumerate(result.scene_edges):
                label = "_" if k else "a small whirl grows"
                axes.axvspan(low * RPM, high * RPM, label=label, **BAND)
            for branch in np.unique(shown["branch"]).tolist():
                _draw_branch(
                    axes, {key: value[shown["branch"] == branch] for key, value in shown.items()}, name, scale
                )
            axes.set_xlim(ends[0], ends[1])
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
        _dress_cycles(panels[0], panels[1], result)
        caption = Caption(
            "Self-excited whirls of finite size over speed: amplitude of the first chamber's axis, and "
            "frequency in space. Thin where the liquid lags by over a third of the spin: beyond the model.",
            f"Scene: {one_line(result.name)}. Liquid model: nonlinear long waves that stand in the whirl's "
            f"frame; liquid friction: {result.friction}; support: {result.damping}; no unbalance or gravity.",
        )
        lay_out(figure, [[axes] for axes in panels], [2.6, 1.7], CYCLES_FRAME, caption)
        for axes in panels:
            box = axes.get_position()
            axes.set_position((box.x0, box.y0, box.width - ASIDE / WIDTH, box.height))
    return figure


def _dress_cycles(top: Axes, below: Axes, result: WhirlMap) -> None:
    """Folds, key and axes of the figure of limit cycles."""
    folds = np.array([(fold.speed * RPM, fold.amplitude * MM) for fold in result.folds])
    if folds.size:
        top.plot(*folds.T, label="fold", **FOLD)
    for label, look in (("stable", STABLE), ("unstable", LEFT), ("the liquid lags by over a third", FAR)):
        top.plot([], [], label=label, **look)
    top.set_ylim(0.0, None)
    top.set_ylabel(f"Amplitude ({MM_PEAK})")
    top.tick_params(labelbottom=False)
    if result.depth > 0.0:
        depth = result.depth * MM
        share = top.secondary_yaxis("right", functions=(lambda y: y / depth, lambda y: y * depth))
        share.set_ylabel("Amplitude/depth (\N{EN DASH})")
        share.yaxis.set_major_formatter(number)
    add_rate_axis(top)
    if result.critical_speed_dry > 0.0:
        critical = result.critical_speed_dry * RPM
        below.axhline(
            critical, color="0.45", linewidth=0.9, linestyle=":", label="critical speed without liquid"
        )
    below.set_ylabel("Whirl speed (rpm)")
    below.set_xlabel("Spin speed (rpm)")


def _draw_branch(axes: Axes, rows: dict[str, Array], name: str, scale: float) -> None:
    """A branch, stable parts in full and thick, unstable ones dashed, those out of the model's range thin."""
    x, y = rows["speed"] * RPM, rows[name] * scale
    stable, fair = rows["stable"] > 0.0, rows["in_range"] > 0.0
    for holds, valid, look in (
        (True, True, STABLE),
        (True, False, STABLE | FAR),
        (False, True, LEFT),
        (False, False, LEFT | FAR),
    ):
        here = (stable == holds) & (fair == valid)
        # A piece reaches to the next whirl, so that pieces join.
        wide = here | np.concatenate([[False], here[:-1]])
        axes.plot(x, np.where(wide, y, np.nan), **look)


def _caption(result: WhirlMap) -> Caption:
    """What is shown, the scene, the model, both dampings, notes."""
    assumed = assumed_words(result.assumed)
    notes = " ".join(one_line(note.text) for note in result.notes)
    what = "all liquid together" if result.value is None else " and ".join(result.paths)
    return Caption(
        f"Fastest-growing whirl, infinitesimal, over speed and {what}; below, its speed in space "
        "over the spin's, where it grows.",
        f"Scene: {one_line(result.name)}. Liquid model: exact linear theory of the plane layer; liquid "
        f"friction: {result.friction}; support: {result.damping}. {notes} Assumed: {assumed}.",
    )
