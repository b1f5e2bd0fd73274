"""The wave of a liquid layer over time: curves and the pictures of a film, drawn on axes handed in."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from leblanc.figures.over_speed import STRIP
from leblanc.figures.wave import axes as wave_axes
from leblanc.figures.wave import picture as wave
from leblanc.figures.wave.axes import DEFLECTION, DEGREE, DRY_BAR, LIQUID, MEAN_LINE, SURFACE, WALL
from leblanc.results.layer import Wave, WaveFrames
from leblanc.units import MM, RPM
from meshes.arrays import Array

Show = Callable[[int], None]
Axes = Any  # matplotlib's, which no module that only draws imports

TURNED = "#D55E00"


def draw_force(axes: Axes, _record: Wave, history: WaveFrames) -> None:
    """Both parts of the force ratio, a point for each period."""
    if history.force_ratio is None or history.period_time is None:
        return
    force = np.where(np.isfinite(history.force_ratio), history.force_ratio, complex(math.nan, math.nan))
    axes.plot(history.period_time, force.real, color=SURFACE, marker="o", label="force along the deflection")
    ahead = {"color": TURNED, "marker": "s", "linestyle": (0, (4, 1.5)), "markerfacecolor": "white"}
    axes.plot(history.period_time, force.imag, label=f"force 90{DEGREE} ahead of it", **ahead)
    axes.margins(y=0.12)
    axes.set_ylabel("Force ratio (\N{EN DASH})")


def draw_rotation(axes: Axes, _record: Wave, history: WaveFrames) -> None:
    """Mean rotation of the liquid in the drum, a point for each period."""
    if history.mean_rotation is None or history.period_time is None:
        return
    turning = np.where(np.isfinite(history.mean_rotation), history.mean_rotation, math.nan)
    style = {"color": "0.15", "marker": "^", "linewidth": 1.2}
    axes.plot(history.period_time, turning, label="mean rotation in the drum", **style)
    axes.margins(y=0.15)
    axes.set_ylabel("Rotation (rad/s)")
    beside = axes.secondary_yaxis("right", functions=(lambda rate: rate * RPM, lambda rpm: rpm / RPM))
    beside.set_ylabel("(rpm)")


def draw_depths(axes: Axes, record: Wave, history: WaveFrames) -> None:
    """Deepest and shallowest place at each time."""
    crest, trough = history.depth.max(axis=1) * MM, history.depth.min(axis=1) * MM
    mark = "o" if history.time.size == 1 else None
    axes.plot(history.time, crest, color=SURFACE, linewidth=1.2, marker=mark, label="crest")
    style = {"color": TURNED, "linewidth": 1.2, "linestyle": (0, (3.5, 1.5)), "marker": mark}
    axes.plot(history.time, trough, label="trough", **style)
    axes.axhline(record.mean_depth * MM, **MEAN_LINE | {"linewidth": 0.8, "linestyle": (0, (1, 1.2))})
    top = max(float(crest.max()), record.mean_depth * MM)
    axes.set_ylim(-0.04 * top if top > 0.0 else -0.04, 1.12 * top if top > 0.0 else 1.0)
    axes.set_ylabel("Depth (mm)")


def film(left: Axes, right: Axes, record: Wave, history: WaveFrames) -> Show:
    """Both drawings of a film in the frame of the drum.

    Parameters
    ----------
    left, right : an empty drawing and an empty plot
    record, history : what to draw

    Returns
    -------
    What sets both to the time of an index.
    """
    chosen = wave.frames(record, history)
    layers = history.depth[chosen]
    dry = bool(wave.is_dry(layers, record.mean_depth).any())
    show_annulus = _annulus(left, record, history, wave.depth_factor(record, float(layers.max())), dry)
    wave_axes.profile_axis(right, max(float(layers.max()), record.mean_depth) * MM, dry)
    show_profile = _profile(right, record, history, dry)
    digits = _digits(history.time[chosen])

    def show(index: int) -> None:
        show_annulus(index)
        show_profile(index)
        left.set_title(f"t = {history.time[index]:.{digits}f} s")

    return show


def _annulus(axes: Axes, record: Wave, history: WaveFrames, factor: float, dry: bool) -> Show:
    """Draw what stands still of the annulus, and return what moves the rest."""
    radius, largest = record.radius * MM, float(np.abs(history.deflection).max())
    wave_axes.walls(axes, record)
    wave_axes.turning(axes, record, "spin", 1.0, 135.0)
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="geometric axis")
    axes.plot([0.97 * radius], [0.0], "s", color=WALL, markersize=6, zorder=5, label="mark on the drum")
    (liquid,) = axes.fill([0.0], [0.0], facecolor=LIQUID, edgecolor="none", label="liquid")
    (free,) = axes.plot([], [], color=SURFACE, linewidth=0.8)
    (bar,) = axes.plot([], [], **DRY_BAR | ({} if dry else {"label": "_"}))
    arrow = wave_axes.arrow(axes, record, 0.0, DEFLECTION, "deflection")

    def show(index: int) -> None:
        depth = history.depth[index] * MM
        angle, surface = wave.free_surface(radius, history.theta, depth, factor)
        liquid.set_xy(np.stack(wave.outline(radius, angle, surface), axis=1))
        wet = wave_axes.wet_surface(record, angle, surface, factor)
        free.set_data(wet.real, wet.imag)
        edge = wave_axes.dry_wall(record, angle, surface, factor)
        bar.set_data(edge.real, edge.imag)
        direction = complex(history.deflection[index]) / largest if largest > 0.0 else 0.0
        x, y, head = wave_axes.arrow_ends(record, direction)
        arrow.set_data(x, y)
        arrow.set_marker(head)

    return show


def _profile(axes: Axes, record: Wave, history: WaveFrames, dry: bool) -> Show:
    """Draw what stands still of the depth around the wall, and return what moves the rest."""
    across = {"transform": axes.get_xaxis_transform()}
    (curve,) = axes.plot([], [], color=SURFACE, linewidth=1.2, label="depth of the layer")
    axes.axhline(record.mean_depth * MM, **MEAN_LINE)
    style = {"color": DEFLECTION, "linewidth": 1.2, "linestyle": (0, (1, 1.2))}
    (place,) = axes.plot([], [], label="angle of the deflection", **style, **across)
    (bar,) = axes.plot([], [], **DRY_BAR | ({} if dry else {"label": "_"}), **across)
    axes.set_xlabel("Angle from the mark, with the spin (deg)")

    def show(index: int) -> None:
        angle, depth = wave.unrolled(history.theta, history.depth[index])
        curve.set_data(np.degrees(angle), depth * MM)
        bar.set_data(np.degrees(angle), np.where(wave.is_dry(depth, record.mean_depth), 0.5 * STRIP, np.nan))
        deflection = complex(history.deflection[index])
        there = math.degrees(cmath.phase(deflection)) if deflection != 0.0 else math.nan
        place.set_data([there, there], [0.0, 1.0])

    return show


def _digits(time: Array) -> int:
    """Decimals that tell one frame from the next."""
    step = float(np.min(np.diff(time))) if time.size > 1 else 1e-2
    return min(max(0, 1 - math.floor(math.log10(step))), 9)


def describe_film(record: Wave, history: WaveFrames) -> str:
    """What a film shows and how fast, in words."""
    chosen = wave.frames(record, history)
    time, whole = history.time[chosen], float(history.time[-1] - history.time[0])
    span = float(time[-1] - time[0])
    part = "" if span >= 0.9 * whole else f" (the last {span:.3g} s of {whole:.3g} s)"
    factor = wave.depth_factor(record, float(history.depth[chosen].max()))
    drawn = wave_axes.describe_depths(factor)
    text = f"Seen from the drum{part}. {drawn}; the arrow grows with the deflection."
    if span > 0.0:
        text += f" One second of the film is {span / (time.size - 1) * wave.FRAME_RATE:.3g} s."
        if abs(record.seen_from_the_drum) * float(np.max(np.diff(time))) > 2.0 * wave.TURN:
            text += " The frames are too far apart to follow the deflection."
    return text
