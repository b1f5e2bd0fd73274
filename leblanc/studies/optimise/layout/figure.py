"""Where the mounts of a tub sit before and after, their couplings and natural frequencies."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.core.units import MM
from leblanc.plotting.page import Figure, Frame, lay_out, number, style
from leblanc.studies.optimise.layout.answer import LayoutAnswer, MountPlace, pair_names
from meshes.arrays import Array

Axes = Any  # matplotlib's, which no module that only draws imports

LAYOUT = Frame(left=0.72, top=0.15, between=0.75, below=0.42)
_NOTHING = 1e-6  # a coupling below is none
# Of a layout: what it is, colour and hatching.
_LAYOUTS = (("before", "#D55E00", "////"), ("after", "#0072B2", ""))
PLACES_HIGH = 2.7  # inches


def places_figure(result: LayoutAnswer) -> Figure:
    """Where the mounts of a tub sit before and after, seen along the axis of the drum and from the side."""
    everywhere = np.array([[mount.position_before, mount.position] for mount in result.mounts]) * MM
    size = float(np.abs(everywhere).max()) or 1.0
    with style():
        figure = Figure()
        panels: list[Axes] = [figure.add_axes((0, 0, 1, 1), label=name) for name in ("front", "side")]
        for axes, (across, name) in zip(panels, ((0, "x"), (1, "y")), strict=True):
            for k, mount in enumerate(result.mounts):
                _draw_mount(axes, mount, everywhere[k], across, size)
            centre = result.origin * MM
            axes.plot(centre[across], centre[2], "+", color="0.3", markersize=9.0, label="centre of mass")
            axes.set_xlim(-1.5 * size, 1.5 * size)
            axes.set_ylim(-1.5 * size, 1.5 * size)
            axes.set_aspect("equal", adjustable="box")
            axes.set_xlabel(f"{name} (mm)")
            axes.xaxis.set_major_formatter(number)
            axes.yaxis.set_major_formatter(number)
        panels[0].set_ylabel("z, upwards (mm)")
        panels[1].tick_params(labelleft=False)
        text = (
            f"{result.name}: where springs and dampers hold the tub, along the axis of its drum (left) and "
            "from the side. Lines are the directions in which they act; arrows go from where they sit to "
            "where the search puts them."
        )
        lay_out(figure, [panels], [PLACES_HIGH], LAYOUT, text)
        moved = np.linalg.norm(everywhere[:, 1] - everywhere[:, 0], axis=1)
        figure.alt = (
            f"Places of {len(result.mounts)} springs and dampers before and after; the farthest moves by "
            f"{moved.max():.0f} mm. {result.sentence()}"
        )
    return figure


def _draw_mount(axes: Axes, mount: MountPlace, places: Array, across: int, size: float) -> None:
    """One spring or damper in one view: marks where it sits, a line along its direction, an arrow between."""
    kind = mount.name.split()[0]
    # A damper may sit where a spring does.
    mark, wide = ("o", 8.0) if kind == "spring" else ("s", 4.0)
    ways = (mount.direction_before, mount.direction)
    for (label, color, _), place, way in zip(_LAYOUTS, places, ways, strict=True):
        look = {"color": color, "markeredgecolor": "black", "markersize": wide, "markeredgewidth": 0.5}
        axes.plot(place[across], place[2], mark, label=f"{kind} {label}", zorder=3.0, **look)
        if way is not None:
            half = 0.22 * size * np.array([way[across], way[2]])
            ends = np.stack([place[[across, 2]] - half, place[[across, 2]] + half])
            axes.plot(*ends.T, color=color, linewidth=1.1, zorder=2.0)
    (begin, end) = places[:, [across, 2]]
    if np.linalg.norm(end - begin) > 0.03 * size:
        arrow = {"arrowstyle": "->", "color": "0.35", "linewidth": 0.9, "shrinkA": 3.0, "shrinkB": 3.0}
        axes.annotate("", xy=tuple(end), xytext=tuple(begin), arrowprops=arrow, zorder=2.5)


def layout_figure(result: LayoutAnswer) -> Figure:
    """Couplings of stiffness and damping, and natural frequencies, before and after."""
    names = pair_names()
    largest = np.max([np.abs(table).max(axis=0) for table in result.couplings.values()], axis=0)
    shown = np.flatnonzero(largest > _NOTHING).tolist() or [0]
    across = np.arange(len(shown))
    with style():
        figure = Figure()
        panels: list[Axes] = [figure.add_axes((0, 0, 1, 1), label=name) for name in "abc"]
        for axes, (name, table) in zip(panels, result.couplings.items(), strict=False):
            for layout, (label, color, hatch) in enumerate(_LAYOUTS):
                look = {"color": color, "edgecolor": "black", "linewidth": 0.5, "hatch": hatch}
                bars = across + 0.4 * (layout - 0.5)
                axes.bar(bars, np.abs(table[layout, shown]), 0.38, label=label, **look)
            axes.set_xticks(across, [names[k] for k in shown], rotation=45, ha="right", fontsize=7)
            axes.set_ylabel(f"Coupling of {name} (\N{EN DASH})")
            axes.set_ylim(0.0, max(0.05, 1.1 * float(np.abs(table).max())))
            axes.yaxis.set_major_formatter(number)
        for layout, (label, color, _) in enumerate(_LAYOUTS):
            hertz = result.frequency[layout] / (2.0 * math.pi)
            panels[2].plot(
                hertz, np.full(6, 1 - layout), "o", color=color, markeredgecolor="black", label=label
            )
        if result.measure == "separation" and result.band is not None:
            low, high = (rate / (2.0 * math.pi) for rate in result.band)
            panels[2].axvspan(low, high, color="0.85", label="running speeds", zorder=0)
        panels[2].set_ylim(-0.6, 1.6)
        panels[2].set_yticks([0, 1], ["after", "before"])
        panels[2].set_xlabel("Natural frequency at rest (Hz)")
        panels[2].xaxis.set_major_formatter(number)
        text = (
            f"{result.name}: couplings about the centre of mass of tub and drum, each the term over the root "
            "of those on the diagonal, and natural frequencies at rest without damping, with the mounts "
            "where they are and where the search puts them."
        )
        lay_out(figure, [[axes] for axes in panels], [1.3, 1.3, 0.7], LAYOUT, text)
        figure.alt = f"Bars of the couplings and points of the natural frequencies. {result.sentence()}"
    return figure
