"""The figure of a chamber's optimal volume: the free surface in the plane of the deflection."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.figures.chambers.section import liquid_outline
from leblanc.figures.page import Caption, Figure, Frame, lay_out, number, style
from leblanc.results.chamber import FilledChamber
from leblanc.results.volume import VolumeResult
from leblanc.text.volume import facts, question
from leblanc.units import MM
from meshes.arrays import Array

FRAME = Frame(left=0.72, top=0.2, between=0.12, below=0.42)
WALL, LIQUID = "0.15", "#56B4E9"
POINTS = 400  # of the surface


def surface_figure(result: VolumeResult) -> Figure:
    """Section through the rotation axis and the geometric one: walls, and the surface of the liquid.

    The surface is that of the volume asked for, or of the optimal one, which just touches the wall where
    it is nearest to the rotation axis.

    Parameters
    ----------
    result : the answer
    """
    chamber, away = result.chamber, result.eccentricity
    height, radius = chamber.height * MM, chamber.radius * MM
    left, right = (away - chamber.radius) * MM, (away + chamber.radius) * MM
    x = np.linspace(left, right, POINTS)
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        inside = (np.abs(x - away * MM) >= chamber.inner_radius * MM) & ~np.isnan(_surface(result, x / MM))
        top = np.clip(_surface(result, x / MM) * MM, 0.0, height)
        axes.fill_between(x, 0.0, top, where=inside & (top > 0.0), color=LIQUID, linewidth=0, label="liquid")
        for wall in (radius, chamber.inner_radius * MM):
            if wall > 0.0:
                for side in (-wall, wall):
                    axes.plot([away * MM + side] * 2, [0.0, height], color=WALL, linewidth=1.6)
        for level in (0.0, height):
            axes.plot([left, right], [level, level], color=WALL)
        axes.axvline(0.0, color="black", linestyle="-.", linewidth=0.9, label="rotation axis")
        axes.axvline(away * MM, color="#D55E00", linestyle=":", linewidth=1.2, label="geometric axis")
        axes.set_xlabel("Along the deflection (mm)")
        axes.set_ylabel("Height (mm)")
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(number)
        axes.grid(visible=False)
        best = dict(facts(result))["optimal volume"]
        figure.alt = f"Section of the chamber with the free surface of its liquid; optimal volume {best}."
        which = "the volume asked for" if result.surface is not None else "the optimal volume"
        text = f"Free surface of {which}; {best} just cover the wall. Height and width differ in scale."
        lay_out(figure, [[axes]], [2.4], FRAME, Caption(text, f"{question(result)}."))
    return figure


def _surface(result: VolumeResult, x: Array) -> Array:
    """Height of the free surface over the floor at distances x from the rotation axis, m."""
    height, reach = result.chamber.height, result.chamber.radius - result.eccentricity
    if result.gravity == 0.0:
        volume = result.optimal_volume if result.volume is None else result.volume
        rest = math.sqrt(max(result.chamber.radius**2 - volume / (math.pi * height), 0.0))
        wall = FilledChamber(
            result.chamber.radius, result.chamber.inner_radius, height, volume, "", mean_surface_radius=rest
        )
        _, inner, _ = liquid_outline(wall, complex(result.eccentricity), result.chamber.radius - rest)
        return np.where(np.abs(x) >= inner.max(), height, 0.0)
    beta = result.speed**2 / (2.0 * result.gravity)
    # The optimal surface meets the lower edge of the wall where it is nearest to the rotation axis.
    constant = -beta * reach**2
    if result.surface is not None and result.surface.surface_constant is not None:
        constant = result.surface.surface_constant
    return np.asarray(beta * np.square(x) + constant)
