"""Radial baffles of a chamber: thin plates along the axis, from the wall or from near it towards the axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative

# Tips nearer to the free surface or to the wall than this fraction of its radius are on it.
_TOUCHES = 1e-9


@dataclass(frozen=True)
class Baffles:
    """Radial baffles, all alike and evenly spaced; they have no thickness.

    Four kinds follow from the two ends, with the free surface at r = a: attached to the wall and ending in
    the liquid; attached and piercing the surface, so that the liquid cannot go around; with a gap at the wall
    and piercing the surface; and standing free in the liquid.
    """

    count: int  #: how many, 1 or more
    #: distance of the inner edge from the axis, m; a + gap for a gap below the surface, 0 if the baffles meet
    #: on the axis
    tip_radius: float = 0.0
    wall_gap: float = 0.0  #: distance of the outer edge from the wall, m; 0 if attached
    first_angle: float = 0.0  #: angle of the first, rad
    #: coefficient of the head lost at each, referred to the mean depth; None takes the law of
    #: `fluid.friction.baffles`
    loss: float | None = None

    def __post_init__(self) -> None:
        if self.count != int(self.count) or self.count < 1:
            raise InputError("count", self.count, "a whole number, 1 or more")
        require_not_negative("tip_radius", self.tip_radius)
        require_not_negative("wall_gap", self.wall_gap)
        if not math.isfinite(self.first_angle):
            raise InputError("first_angle", self.first_angle, "a finite angle in radians")
        if self.loss is not None:
            require_not_negative("loss", self.loss)

    @property
    def angles(self) -> Array:
        """Angle of each baffle, rad, shape (count,), rising from `first_angle`."""
        return np.asarray(self.first_angle + 2.0 * math.pi / self.count * np.arange(self.count))

    def wetted_span(self, radius: float, surface_radius: float) -> tuple[float, float] | None:
        """Radii of a baffle's part in the liquid, m, at most from a to R; None if it stays dry."""
        inner, outer = self.tip_radius, radius - self.wall_gap
        if inner >= outer:
            raise InputError("tip_radius", inner, f"below radius - wall_gap ({outer:g} m)")
        if outer <= surface_radius * (1.0 + _TOUCHES):
            return None
        if self.wall_gap <= _TOUCHES * radius:
            outer = radius
        return (surface_radius if inner <= surface_radius * (1.0 + _TOUCHES) else inner), outer
