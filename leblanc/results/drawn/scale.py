"""What drawings in two and in three dimensions share: factors for small lengths, distances to walls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from leblanc.results.chamber import FilledChamber
from meshes.arrays import Array, Complex


@dataclass(frozen=True)
class Scale:
    """Factors that a picture applies; walls are to scale.

    Parameters
    ----------
    deflection : of the axis
    depth : of the mean layer; 1 draws as much liquid as there is
    """

    deflection: float = 1.0
    depth: float = 1.0

    def in_words(self) -> str:
        """What is larger than it is, for the caption."""
        if self.deflection == self.depth == 1.0:
            return "Everything to scale."
        size = f"{self.deflection:g} times"
        if self.depth == 1.0:
            larger = f"{size} larger" if self.deflection > 1.0 else f"at {self.deflection:g} of its size"
            return f"Deflection drawn {larger}, walls and volume of liquid to scale."
        if self.depth == self.deflection:
            return f"Deflection and depth of the liquid layer drawn {size} larger, walls to scale."
        return (
            f"Deflection drawn {size} larger, the liquid layer {self.depth:g} times as deep as it is; "
            "walls to scale."
        )


def rounded_down(factor: float) -> float:
    """The factor with two digits, for printing.

    Parameters
    ----------
    factor : above 0
    """
    step = 10.0 ** (math.floor(math.log10(factor)) - 1)
    # A factor that is a round number already must not lose a digit to rounding.
    return math.floor(factor / step * (1.0 + 1e-9)) * step


def chord(radius: float, centre: complex, angle: Array) -> Array:
    """Distance from the origin, inside a circle, to that circle.

    Parameters
    ----------
    radius, centre : of the circle, m
    angle : direction of the ray, rad, shape (...,)
    """
    away = centre * np.exp(-1j * angle)
    distance: Array = away.real + np.sqrt(radius**2 - away.imag**2)
    return distance


def half_angle(share: float) -> float:
    """Half the angle of a circular segment of area R^2 (a - sin a cos a), rad; 0 to pi.

    Parameters
    ----------
    share : of the segment's area, over R^2
    """
    low, high = 0.0, math.pi
    for _ in range(60):
        half = 0.5 * (low + high)
        low, high = (low, half) if half - math.sin(half) * math.cos(half) > share else (half, high)
    return 0.5 * (low + high)


LARGEST_FACTOR = 1e6  # of a depth as drawn
FILLED = 0.55  # deepest place as drawn over the room between the walls
SWING = 0.3  # largest deflection as drawn, over the smallest wall radius
USUAL = 0.9  # of the frames of a film, whose depths its drawing is scaled to


def film_factor(chambers: Sequence[FilledChamber], depth: Array, deflection: Complex) -> float:
    """One factor for deflections and depths, so that a surface round the axis at rest stays so as drawn.

    Parameters
    ----------
    chambers : whose walls are drawn to scale
    depth : of the layers in each frame, m, nan where the liquid is none, shape (f, l, c)
    deflection : of each chamber's axis, complex, m, shape (f, l)
    """
    fits = [LARGEST_FACTOR]
    for j, chamber in enumerate(chambers):
        deepest = float(np.quantile(np.nan_to_num(depth[:, j]).max(axis=1), USUAL))
        if deepest > 0.0:
            fits.append(FILLED * (chamber.radius - chamber.inner_radius) / deepest)
        largest = float(np.abs(deflection[:, j]).max())
        if largest > 0.0:
            fits.append(SWING * chamber.radius / largest)
    return rounded_down(max(1.0, min(fits)))
