"""The chamber of a liquid balancer: a cylinder or a concentric annulus."""

from __future__ import annotations

import math
from dataclasses import dataclass

from meshes.border import InputError, require_not_negative, require_positive


@dataclass(frozen=True)
class Chamber:
    """Circular chamber, concentric with the rotor's geometric axis.

    Parameters
    ----------
    radius : outer wall radius R, m
    height : extent along the axis h_c, m
    inner_radius : inner wall radius R_i, m; 0 if there is no inner wall
    plane : axial position of the chamber on the rotor, m

    Raises
    ------
    InputError : a length that is not finite and positive, or an inner wall outside the outer one

    Examples
    --------
    >>> round(Chamber(radius=0.2, height=0.05).capacity * 1e3, 3)
    6.283
    """

    radius: float
    height: float
    inner_radius: float = 0.0
    plane: float = 0.0

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)
        require_positive("height", self.height)
        require_not_negative("inner_radius", self.inner_radius)
        if self.inner_radius >= self.radius:
            raise InputError("inner_radius", self.inner_radius, f"below radius ({self.radius:g} m)")
        if not math.isfinite(self.plane):
            raise InputError("plane", self.plane, "a finite number")

    @property
    def section_area(self) -> float:
        """Area of the section across the axis, m^2."""
        return math.pi * (self.radius - self.inner_radius) * (self.radius + self.inner_radius)

    @property
    def capacity(self) -> float:
        """Volume of liquid that fills the chamber, m^3."""
        return self.section_area * self.height
