"""The film of a run-up: the chambers seen along the axis beside the amplitude over speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures import wave
from leblanc.figures.page import FILM_DPI, RIGHT, WIDTH, Figure, Frame, lay_out, number, style, write_film
from leblanc.figures.runup import caption
from leblanc.figures.section import rounded_down
from leblanc.results.chamber import FilledChamber
from leblanc.studies.runup import RunupRecord
from leblanc.studies.runup_film import Reel
from leblanc.units import MM, RPM
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports
Show = Callable[[int], None]

FRAME_RATE = 20  # 1/s; a GIF counts in hundredths of a second
FRAME = Frame(left=0.1, top=0.34, between=0.0, below=0.3)
MOST_DRAWINGS = 2
REACH = 1.18  # of a drawing, over the largest wall radius, beside the deflection
SWING = 0.3  # largest deflection as drawn, over the smallest wall radius
USUAL = 0.9  # of the frames, whose depths the drawing is scaled to
DOWN = 1.09  # where the mark for gravity stands, over the wall's radius
PLOT_LEFT, PLOT_BELOW, LINES = 0.55, 0.22, 6
LIQUID, SURFACE, WALL, AXIS = "#56B4E9", "#0072B2", "0.15", "#D55E00"


def animate(
    record: RunupRecord, reel: Reel, path: Path, drawn: Callable[[int, int], None] | None = None
) -> int:
    """Write the film of a run-up, in the frame of the drum.

    Parameters
    ----------
    record, reel : the run-up and its frames
    path : a .gif, or an .mp4 if there is an ffmpeg
    drawn : called after each frame with the number of frames drawn and of all

    Returns
    -------
    Number of frames.

    Raises
    ------
    InputError : another kind of file, an .mp4 without an ffmpeg
    """
    frames = range(reel.time.size)
    return write_film(lambda: film_figure(record, reel), frames, FRAME_RATE, path, drawn)


def film_figure(record: RunupRecord, reel: Reel) -> tuple[Figure, Show]:
    """Figure of a film and what sets it to a frame."""
    groups = drawings(record.chambers, record.planes)
    shown, factor = groups[:MOST_DRAWINGS], exaggeration(record, reel)
    with style():
        figure = Figure()
        axes = [figure.add_axes((0, 0, 1, 1), label=str(i)) for i in range(len(shown) + 1)]
        shows = [
            _draw_group(one, record, reel, group, factor) for one, group in zip(axes, shown, strict=False)
        ]
        shows.append(_draw_curve(axes[-1], record, reel))
        title = axes[0]

        def show(index: int) -> None:
            for one in shows:
                one(index)
            title.set_title(
                f"t = {reel.time[index]:.2f} s, {reel.speed[index] * RPM:.0f} rpm, "
                f"{reel.amplitude[index] * MM:.2f} mm",
                loc="left",
            )

        text = _describe(reel, factor, sum(map(len, groups[MOST_DRAWINGS:])))
        height = 2.6 if len(axes) < 3 else 2.1
        lay_out(figure, [axes], [height], FRAME, caption(record, text), LINES)
        total, box = figure.get_figheight(), axes[-1].get_position()
        x, y = box.x0 + PLOT_LEFT / WIDTH, box.y0 + PLOT_BELOW / total
        axes[-1].set_position((x, y, 1.0 - RIGHT / WIDTH - x, box.y1 - y))
        # Video codecs halve both sides of a picture for its colours.
        figure.set_size_inches(WIDTH, 2.0 * math.ceil(0.5 * FILM_DPI * total) / FILM_DPI)
    return figure, show


def _describe(reel: Reel, factor: float, left_out: int) -> str:
    """What a film shows and how fast, in words."""
    text = "Seen along the axis from the drum; the cross is the axis at rest."
    if factor != 1.0:
        text += f" Deflection and depth drawn \N{MULTIPLICATION SIGN} {factor:g}, walls to scale."
    step = float(np.max(np.diff(reel.time)))
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


def exaggeration(record: RunupRecord, reel: Reel) -> float:
    """One factor for deflections and depths, so that a surface round the axis at rest stays so as drawn."""
    fits = [wave.LARGEST_FACTOR]
    for j, chamber in enumerate(record.chambers):
        room = chamber.radius - chamber.inner_radius
        deepest = float(np.quantile(np.nan_to_num(reel.depth[:, j]).max(axis=1), USUAL))
        if deepest > 0.0:
            fits.append(wave.FILLED * room / deepest)
        largest = float(np.abs(reel.deflection[:, j]).max())
        if largest > 0.0:
            fits.append(SWING * chamber.radius / largest)
    return rounded_down(max(1.0, min(fits)))


def _draw_group(axes: Axes, record: RunupRecord, reel: Reel, group: list[int], factor: float) -> Show:
    """Draw what stands still of some chambers, and return what moves the rest."""
    widest, largest = record.chambers[group[0]].radius * MM, max(c.radius for c in record.chambers) * MM
    circle = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 361))
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="axis at rest")
    mark = {"color": WALL, "markersize": 6, "zorder": 5}
    name = "unbalance" if record.kind == "jeffcott" else "zero mark of the drum"
    (heavy,) = axes.plot([], [], "s", label=name, **mark)
    centre_look = {"markerfacecolor": "white", "markeredgecolor": AXIS, "markersize": 5}
    (middle,) = axes.plot([], [], "o", label="geometric centre", zorder=6, **centre_look)
    parts = []
    for j in group:
        chamber = record.chambers[j]
        (liquid,) = axes.fill([0.0], [0.0], facecolor=LIQUID, edgecolor="none", label="liquid")
        (free,) = axes.plot([], [], color=SURFACE, linewidth=0.8)
        rings = [radius * MM * circle for radius in (chamber.radius, chamber.inner_radius) if radius > 0.0]
        walls = [(ring, axes.plot([], [], color=WALL, linewidth=1.4)[0]) for ring in rings]
        parts.append((j, liquid, free, walls))
    (down,) = axes.plot([], [], "v", color="0.4", markersize=6, label="down" if record.gravity else "_")
    reach = REACH * largest + float(np.abs(reel.deflection).max()) * factor * MM
    names = ", ".join(f"{record.chambers[j].radius * MM:.4g}" for j in group)
    axes.text(0.5, -0.04, f"radius {names} mm", transform=axes.transAxes, ha="center", fontsize=7)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    axes.axis("off")

    def show(index: int) -> None:
        for j, liquid, free, walls in parts:
            centre = complex(reel.deflection[index, j]) * factor * MM
            edge, surface = liquid_shape(record.chambers[j], reel, index, j, factor)
            liquid.set_xy(_points(edge + centre))
            free.set_data((surface + centre).real, (surface + centre).imag)
            for ring, line in walls:
                line.set_data((ring + centre).real, (ring + centre).imag)
        centre = complex(reel.deflection[index, group[0]]) * factor * MM
        middle.set_data([centre.real], [centre.imag])
        heavy.set_data([centre.real + widest], [centre.imag])
        if record.gravity > 0.0:
            low = centre + DOWN * widest * np.exp(1j * reel.pool[index])
            down.set_data([low.real], [low.imag])
            # matplotlib's triangle points up.
            down.set_marker((3, 0, math.degrees(reel.pool[index]) - 90.0))

    return show


def _points(edge: Any) -> Array:
    return np.stack([edge.real, edge.imag], axis=1)


def liquid_shape(chamber: FilledChamber, reel: Reel, index: int, j: int, factor: float) -> tuple[Any, Any]:
    """Closed outline of the liquid in a chamber and its free surface, about the chamber's centre, mm.

    Parameters
    ----------
    chamber, reel : the chamber, the frames
    index, j : of the frame and of the chamber
    factor : of a layer's depth; a pool is drawn to scale
    """
    radius, depth = chamber.radius * MM, reel.depth[index, j]
    if not np.isnan(depth).any():
        angle, layer = wave.free_surface(radius, reel.theta, depth * MM, factor)
        x, y = wave.outline(radius, angle, layer)
        return x + 1j * y, layer * np.exp(1j * angle)
    half = pool_angle(chamber)
    arc = radius * np.exp(1j * (reel.pool[index] + np.linspace(-half, half, 181)))
    return arc, arc[[0, -1]]


def pool_angle(chamber: FilledChamber) -> float:
    """Half the angle of the circular segment that liquid at the bottom of a chamber fills, rad; 0 to pi.

    A segment of half angle a has the area R^2 (a - sin a cos a); an inner wall is left out.
    """
    share = chamber.volume / (chamber.height * chamber.radius**2)
    low, high = 0.0, math.pi
    for _ in range(60):
        half = 0.5 * (low + high)
        low, high = (low, half) if half - math.sin(half) * math.cos(half) > share else (half, high)
    return 0.5 * (low + high)


def _draw_curve(axes: Axes, record: RunupRecord, reel: Reel) -> Show:
    """Amplitude over speed and a dot that moves along it."""
    h = record.history
    axes.plot(h.speed * RPM, h.amplitude * MM, color="0.6", linewidth=0.9, label="whole run-up")
    (past,) = axes.plot([], [], color=SURFACE, linewidth=1.3, label="so far")
    (dot,) = axes.plot([], [], "o", color=AXIS, markersize=6, zorder=5)
    axes.set_ylim(0.0, 1.1 * float(max(h.amplitude.max(), reel.amplitude.max())) * MM or 1.0)
    axes.set_xlabel("Speed (rpm)")
    axes.set_ylabel("Amplitude (mm)", labelpad=2.0)
    axes.xaxis.set_major_formatter(number)
    axes.yaxis.set_major_formatter(number)

    def show(index: int) -> None:
        done = h.time <= reel.time[index]
        past.set_data(h.speed[done] * RPM, h.amplitude[done] * MM)
        dot.set_data([reel.speed[index] * RPM], [reel.amplitude[index] * MM])

    return show
