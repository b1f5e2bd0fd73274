"""Shapes of the liquid's modes, seen along the axis."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.units import MM, RPM
from leblanc.plotting.bodies import rounded_down
from leblanc.plotting.page import Figure, Frame, lay_out, number, style
from leblanc.studies.modes.answer import ModesAnswer
from meshes.arrays import Array
from meshes.liquid_section import LiquidSection

Axes = Any  # matplotlib's, which no module that only draws imports

MODES_FRAME = Frame(left=0.25, top=0.42, between=0.5, below=0.02)
PANEL, ACROSS, MOST = 1.93, 3, 6  # inches; drawings
SHOWN = 0.3  # depth of the layer as drawn, over its outer radius
RISE = 0.3  # of the largest displacement, over the depth as drawn where the layer is thinnest
LEVELS = np.linspace(-1.0, 1.0, 12)  # of the stream function over its largest value; none of them 0
# Triangles that a cell is cut into for drawing, by its number of nodes.
CUTS = {
    3: [[0, 1, 2]],
    4: [[0, 1, 2], [0, 2, 3]],
    6: [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    9: [[0, 4, 8], [0, 8, 7], [4, 1, 5], [4, 5, 8], [8, 5, 2], [8, 2, 6], [7, 8, 6], [7, 6, 3]],
}


def modes_figure(result: ModesAnswer) -> Figure:
    """The slowest modes at the instant of the strongest flow, one shape of those with equal frequencies."""
    modes = result.shapes
    shown = _distinct(modes.multiplicity)[:MOST]
    stretch = _stretch(result.section)
    with style():
        figure = Figure()
        rows = []
        for start in range(0, len(shown), ACROSS):
            row = [figure.add_axes((0, 0, 1, 1), label=str(start + j)) for j in range(ACROSS)]
            for j, axes in enumerate(row):
                if start + j < len(shown):
                    _draw(axes, result, shown[start + j], stretch)
                else:
                    axes.set_axis_off()
            rows.append(row)
        caption = _caption(result, stretch)
        lay_out(figure, rows, [PANEL] * len(rows), MODES_FRAME, caption)
        slowest = ", ".join(f"{float(modes.frequency[k]):.4g}" for k in shown)
        figure.alt = (
            f"Shapes of {len(shown)} modes of the liquid along the axis; frequencies {slowest} rad/s."
        )
    return figure


def _distinct(multiplicity: NDArray[np.int64]) -> list[int]:
    """The first mode of each frequency."""
    found, k = [], 0
    while k < len(multiplicity):
        found.append(k)
        k += int(multiplicity[k])
    return found


def _stretch(section: LiquidSection) -> float:
    """Factor by which depths are drawn larger, 1 in a deep layer."""
    outer = float(np.hypot(*section.points.T).max())
    depth = outer - section.surface_radius
    return max(1.0, rounded_down(SHOWN * outer / depth)) if depth < SHOWN * outer else 1.0


def _placed(section: LiquidSection, points: Array, stretch: float, inward: Array | float = 0.0) -> Array:
    """Points with their distance from the outermost one drawn larger, m, shape (N, 2)."""
    outer = float(np.hypot(*section.points.T).max())
    radius = np.hypot(*points.T)
    drawn = outer - stretch * (outer - radius) - inward
    return np.asarray(points * (drawn / radius)[:, None])


def _draw(axes: Axes, result: ModesAnswer, k: int, stretch: float) -> None:
    """Stream lines, free surface and walls of one mode."""
    section, modes = result.section, result.shapes
    outer = float(np.hypot(*section.points.T).max())
    points = _placed(section, section.points, stretch)
    psi = modes.psi[k]
    phase = np.exp(-1j * result.phase[k])
    cuts = section.cells[:, CUTS[section.cells.shape[1]]].reshape(-1, 3)
    share = (psi * phase).real / np.abs(psi).max()
    axes.tricontourf(*points.T, cuts, share, levels=LEVELS, cmap="PuOr", vmin=-1.3, vmax=1.3)
    for sign, dash in ((1.0, "solid"), (-1.0, "dashed")):
        levels = np.sort(sign * LEVELS[LEVELS > 0.0])
        axes.tricontour(*points.T, cuts, share, levels=levels, colors="0.25", linewidths=0.5, linestyles=dash)
    rise = np.zeros(len(section.points))
    rise[modes.surface_nodes] = (modes.displacement[k] * phase).real
    depth = stretch * least_depth(section)
    moved = _placed(section, section.points, stretch, -RISE * depth * rise)
    _lines(axes, points, section.surface, color="0.45", linewidth=0.7, linestyle=":")
    _lines(axes, moved, section.surface, color="#0072B2", linewidth=1.6)
    _lines(axes, points, section.wall, color="black", linewidth=1.4)
    axes.plot(0.0, 0.0, "+", color="0.4", markersize=5, markeredgewidth=0.7)
    axes.set_aspect("equal")
    limit = 1.04 * outer
    axes.set_xlim(-limit, limit)
    axes.set_ylim(-limit, limit)
    axes.set_axis_off()
    axes.set_title(_title(result, k), fontsize=7.5, pad=2.0)


def least_depth(section: LiquidSection) -> float:
    """From the free surface to the nearest wall outside it, m; walls across it, as baffles, do not count."""
    plane = section.points[:, 0] + 1j * section.points[:, 1]
    start, end = plane[section.wall[:, 0]], plane[section.wall[:, 1]]
    along = ((end - start) * (0.5 * (start + end)).conj()) / np.abs(end - start)
    around = np.abs(along.imag) > np.abs(along.real)
    away = np.abs(plane[section.wall[around]]) - section.surface_radius
    return float(away[away > 0.0].min(initial=float(np.abs(plane).max()) - section.surface_radius))


def _lines(axes: Axes, points: Array, sides: NDArray[np.int64], **look: Any) -> None:
    """Sides as one broken line."""
    order = [0, 2, 1] if sides.shape[1] == 3 else [0, 1]
    path = points[sides[:, order]]
    gap = np.full((len(path), 1, 2), np.nan)
    axes.plot(*np.concatenate([path, gap], axis=1).reshape(-1, 2).T, **look)


def _title(result: ModesAnswer, k: int) -> str:
    modes = result.shapes
    sigma, crests, same = float(modes.frequency[k]), int(modes.crests[k]), int(modes.multiplicity[k])
    runs = "stands"
    if abs(float(modes.travelling[k])) >= 0.5:
        runs = "runs with the spin" if sigma > 0.0 else "runs against the spin"
    times = f", {same} alike" if same > 1 else ""
    plural = "crest" if crests == 1 else "crests"
    return f"{number(float(f'{sigma:.5g}'))} rad/s{times}\n{crests} {plural}, {runs}"


def _caption(result: ModesAnswer, stretch: float) -> str:
    depth = "" if stretch == 1.0 else f" Depths are drawn {number(stretch)} times larger."
    surface, rpm = result.section.surface_radius * MM, result.speed * RPM
    return (
        "Slowest modes of the liquid in the frame of the drum, spin counter-clockwise. Lines: stream lines, "
        "solid where liquid circles counter-clockwise, dashed where clockwise; blue: free surface at that "
        f"instant, dotted: at rest. {result.chamber}, free surface at {surface:.5g} mm, "
        f"{result.speed:.4g} rad/s = {rpm:.4g} rpm. "
        f"Model: finite elements, plane and inviscid.{depth} Assumed: nothing."
    )
