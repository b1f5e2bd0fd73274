"""The film of a run-up: the chambers seen along the axis beside the amplitude over speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.core.units import LENGTH, MM, MM_PEAK, RPM, unit_for
from leblanc.liquid.filled import FilledChamber
from leblanc.plotting.bodies import film_factor, pool
from leblanc.plotting.page import (
    FILM_DPI,
    RIGHT,
    WIDTH,
    Figure,
    Frame,
    lay_out,
    number,
    style,
    write_film,
)
from leblanc.studies.layer import figure as wave
from leblanc.studies.runup.answer import RunupAnswer, RunupFrames
from leblanc.studies.runup.figure import caption
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports
Show = Callable[[int], None]

FRAME_RATE = 20  # 1/s; a GIF counts in hundredths of a second
FRAME = Frame(left=0.1, top=0.34, between=0.0, below=0.3)
MOST_DRAWINGS = 2
REACH = 1.18  # of a drawing, over the largest wall radius, beside the deflection
DOWN = 1.09  # where the mark for gravity stands, over the wall's radius
PLOT_LEFT, PLOT_BELOW = 0.55, 0.22
LIQUID, SURFACE, WALL, AXIS = "#56B4E9", "#0072B2", "0.15", "#D55E00"


def animate(
    result: RunupAnswer, frames: RunupFrames, path: Path, drawn: Callable[[int, int], None] | None = None
) -> int:
    """Write the film of a run-up in the frame of the drum; its number of frames, as of `write_film`."""
    count = range(frames.time.size)
    return write_film(lambda: film_figure(result, frames), count, FRAME_RATE, path, drawn)


def film_figure(result: RunupAnswer, frames: RunupFrames) -> tuple[Figure, Show]:
    """Figure of a film and what sets it to a frame."""
    groups = drawings(result.chambers, result.planes)
    shown = groups[:MOST_DRAWINGS]
    factor = film_factor(result.chambers, frames.depth, frames.deflection)
    with style():
        figure = Figure()
        axes = [figure.add_axes((0, 0, 1, 1), label=str(i)) for i in range(len(shown) + 1)]
        shows = [
            _draw_group(panel, result, frames, group, factor)
            for panel, group in zip(axes, shown, strict=False)
        ]
        shows.append(_draw_curve(axes[-1], result, frames))
        title, unit = axes[0], unit_for(LENGTH, float(frames.amplitude.max()))

        def show(index: int) -> None:
            for move in shows:
                move(index)
            title.set_title(
                f"t = {frames.time[index]:.2f} s, {frames.speed[index] * RPM:.0f} rpm, "
                f"{frames.amplitude[index] * unit.count:.2f} {unit.name}",
                loc="left",
            )

        text = _describe(frames, factor, sum(map(len, groups[MOST_DRAWINGS:])))
        height = 2.6 if len(axes) < 3 else 2.1
        lay_out(figure, [axes], [height], FRAME, caption(result, text))
        total, box = figure.get_figheight(), axes[-1].get_position()
        x, y = box.x0 + PLOT_LEFT / WIDTH, box.y0 + PLOT_BELOW / total
        axes[-1].set_position((x, y, 1.0 - RIGHT / WIDTH - x, box.y1 - y))
        # Video codecs halve both sides of a picture for its colours.
        figure.set_size_inches(WIDTH, 2.0 * math.ceil(0.5 * FILM_DPI * total) / FILM_DPI)
    return figure, show


def _describe(frames: RunupFrames, factor: float, left_out: int) -> str:
    """What a film shows and how fast, in words."""
    text = "Seen along the axis from the drum; the cross is the axis at rest."
    if factor != 1.0:
        text += f" Deflection and depth drawn \N{MULTIPLICATION SIGN} {factor:g}, walls to scale."
    step = float(np.max(np.diff(frames.time)))
    if left_out:
        text += f" {left_out} more chambers are not drawn."
    return f"{text} One second of the film is {step * FRAME_RATE:.2g} s."


def drawings(chambers: tuple[FilledChamber, ...], planes: tuple[float, ...]) -> list[list[int]]:
    """Chambers that share a drawing because they lie inside one another in one plane, by their indices."""
    groups: list[list[int]] = []
    for j in sorted(range(len(chambers)), key=lambda j: -chambers[j].radius):
        for group in groups:
            if planes[j] == planes[group[-1]] and chambers[j].radius <= chambers[group[-1]].inner_radius:
                group.append(j)
                break
        else:
            groups.append([j])
    return groups


def _draw_group(
    axes: Axes, result: RunupAnswer, frames: RunupFrames, group: list[int], factor: float
) -> Show:
    """Draw what is fixed of some chambers, and return what moves the rest."""
    widest, largest = result.chambers[group[0]].radius * MM, max(c.radius for c in result.chambers) * MM
    circle = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 361))
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="axis at rest")
    mark = {"color": WALL, "markersize": 6, "zorder": 5}
    name = "unbalance" if result.kind == "jeffcott" else "zero mark of the drum"
    (heavy,) = axes.plot([], [], "s", label=name, **mark)
    centre_look = {"markerfacecolor": "white", "markeredgecolor": AXIS, "markersize": 5}
    (middle,) = axes.plot([], [], "o", label="geometric centre", zorder=6, **centre_look)
    parts = []
    for j in group:
        chamber = result.chambers[j]
        (liquid,) = axes.fill([0.0], [0.0], facecolor=LIQUID, edgecolor="none", label="liquid")
        (free,) = axes.plot([], [], color=SURFACE, linewidth=0.8)
        rings = [radius * MM * circle for radius in (chamber.radius, chamber.inner_radius) if radius > 0.0]
        walls = [(ring, axes.plot([], [], color=WALL, linewidth=1.4)[0]) for ring in rings]
        parts.append((j, liquid, free, walls))
    (down,) = axes.plot([], [], "v", color="0.4", markersize=6, label="down" if result.gravity else "_")
    reach = REACH * largest + float(np.abs(frames.deflection).max()) * factor * MM
    names = ", ".join(f"{number(result.chambers[j].radius * MM)}" for j in group)
    axes.text(0.5, -0.04, f"radius {names} mm", transform=axes.transAxes, ha="center", fontsize=7)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    axes.axis("off")

    def show(index: int) -> None:
        for j, liquid, free, walls in parts:
            centre = complex(frames.deflection[index, j]) * factor * MM
            edge, surface = liquid_shape(result.chambers[j], frames, index, j, factor)
            liquid.set_xy(_points(edge + centre))
            free.set_data((surface + centre).real, (surface + centre).imag)
            for ring, line in walls:
                line.set_data((ring + centre).real, (ring + centre).imag)
        centre = complex(frames.deflection[index, group[0]]) * factor * MM
        middle.set_data([centre.real], [centre.imag])
        heavy.set_data([centre.real + widest], [centre.imag])
        if result.gravity > 0.0:
            low = centre + DOWN * widest * np.exp(1j * frames.down[index])
            down.set_data([low.real], [low.imag])
            # matplotlib's triangle points up.
            down.set_marker((3, 0, math.degrees(frames.down[index]) - 90.0))

    return show


def _points(edge: Any) -> Array:
    return np.stack([edge.real, edge.imag], axis=1)


def liquid_shape(
    chamber: FilledChamber, frames: RunupFrames, index: int, j: int, factor: float
) -> tuple[Any, Any]:
    """Closed outline of the liquid in a chamber and its free surface, about the chamber's centre, mm.

    Depths of a layer grow by `factor`; a pool is drawn to scale.
    """
    radius, depth = chamber.radius * MM, frames.depth[index, j]
    if not np.isnan(depth).any():
        inner = chamber.inner_radius * MM
        angle, layer = wave.free_surface(radius, frames.theta, depth * MM, factor, inner)
        x, y = wave.outline(radius, angle, layer)
        return x + 1j * y, layer * np.exp(1j * angle)
    area = chamber.volume / chamber.height
    found, _ = pool(chamber.radius, chamber.inner_radius, area, float(frames.pool[index, j]))
    # Where the liquid surrounds the inner wall, the outlines are joined by a line there and back.
    edge = np.concatenate([np.append(loop, [loop[0], found.loops[0][0]]) for loop in found.loops])
    gaps = [np.append(arc, np.nan) for arc in found.arcs]
    return edge * MM, np.concatenate(gaps) * MM if gaps else np.zeros(0, dtype=complex)


def _draw_curve(axes: Axes, result: RunupAnswer, frames: RunupFrames) -> Show:
    """Amplitude over speed and a dot that moves along it."""
    _, speed, amplitude = result.whole_curve()
    axes.plot(speed * RPM, amplitude * MM, color="0.6", linewidth=0.9, label="whole run-up")
    (past,) = axes.plot([], [], color=SURFACE, linewidth=1.3, label="so far")
    (dot,) = axes.plot([], [], "o", color=AXIS, markersize=6, zorder=5)
    axes.set_ylim(0.0, 1.1 * float(amplitude.max()) * MM or 1.0)
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel(f"Amplitude ({MM_PEAK})", labelpad=2.0)
    axes.xaxis.set_major_formatter(number)
    axes.yaxis.set_major_formatter(number)

    def show(index: int) -> None:
        done = result.time <= frames.time[index]
        past.set_data(result.speed[done] * RPM, result.amplitude[done] * MM)
        dot.set_data([frames.speed[index] * RPM], [frames.amplitude[index] * MM])

    return show
