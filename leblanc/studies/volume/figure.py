"""A chamber with its free surface in a section through the rotation axis."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from leblanc.core.units import MM
from leblanc.liquid.filled import FilledChamber
from leblanc.plotting.chambers import liquid_outline
from leblanc.plotting.page import Caption, Figure, Frame, lay_out, number, style
from leblanc.studies.volume.answer import VolumeAnswer, facts, question_words
from meshes.arrays import Array

FRAME = Frame(left=0.72, top=0.2, between=0.12, below=0.42)
WALL, LIQUID = "0.15", "#56B4E9"
POINTS = 400  # of the surface


def surface_figure(answer: VolumeAnswer) -> Figure:
    """Section through the rotation axis and the geometric one: walls, and the surface of the liquid.

    The surface is that of the given volume, or of the optimal one, which just touches the wall where it is
    nearest to the rotation axis.
    """
    chamber, away = answer.chamber, answer.eccentricity
    height, radius = chamber.height * MM, chamber.radius * MM
    left, right = (away - chamber.radius) * MM, (away + chamber.radius) * MM
    x = np.linspace(left, right, POINTS)
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        inside = (np.abs(x - away * MM) >= chamber.inner_radius * MM) & ~np.isnan(_surface(answer, x / MM))
        top = np.clip(_surface(answer, x / MM) * MM, 0.0, height)
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
        best = dict(facts(answer))["wetting volume, at the floor"]
        figure.alt = f"Section of the chamber with the free surface of its liquid; wetting volume {best}."
        which = "the volume asked for" if answer.surface is not None else "the wetting volume"
        text = f"Free surface of {which}; {best} wet the wall at the floor. Height and width differ in scale."
        lay_out(figure, [[axes]], [2.4], FRAME, Caption(text, f"{question_words(answer)}."))
    return figure


def _surface(answer: VolumeAnswer, x: Array) -> Array:
    """Height of the free surface over the floor at distances x from the rotation axis, m."""
    height, reach = answer.chamber.height, answer.chamber.radius - answer.eccentricity
    if answer.gravity == 0.0:
        volume = answer.optimal_volume if answer.volume is None else answer.volume
        rest = math.sqrt(max(answer.chamber.radius**2 - volume / (math.pi * height), 0.0))
        wall = FilledChamber(
            answer.chamber.radius, answer.chamber.inner_radius, height, volume, "", mean_surface_radius=rest
        )
        _, inner, _ = liquid_outline(wall, complex(answer.eccentricity), answer.chamber.radius - rest)
        return np.where(np.abs(x) >= inner.max(), height, 0.0)
    beta = answer.speed**2 / (2.0 * answer.gravity)
    # The optimal surface meets the lower edge of the wall where it is nearest to the rotation axis.
    constant = -beta * reach**2
    if answer.surface is not None and answer.surface.surface_constant is not None:
        constant = answer.surface.surface_constant
    return np.asarray(beta * np.square(x) + constant)
