"""The chamber of a liquid balancer: a cylinder or a concentric annulus; one, or many at once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection
from meshes.errors import InputError, require_not_negative, require_positive
from meshes.quantity import Q


@dataclass(frozen=True)
class Chamber:
    """Chamber about the rotor's geometric axis: circular, or with a section of its own.

    Raises
    ------
    InputError : a length that is not finite and positive, an inner wall outside the outer one, baffles whose
        inner edge lies outside their outer one, a section with baffles, an inner or another outer radius

    Examples
    --------
    >>> round(Chamber(radius=0.2, height=0.05).capacity * 1e3, 3)
    6.283
    """

    #: R; with a section the distance of its farthest point
    radius: Annotated[float, Q("m", "radius", "of the wall")]
    height: Annotated[float, Q("m", "height", "of the chamber")]  #: extent along the axis h_c
    #: R_i; 0 if there is no inner wall
    inner_radius: Annotated[float, Q("m", "inner radius", "of the chamber")] = 0.0
    plane: float = 0.0  #: axial position of the chamber on the rotor, m
    baffles: Baffles | None = None  #: thin radial plates over the whole height; None without any
    section: ChamberSection | None = None  #: any other section; None for circular walls

    def __post_init__(self) -> None:
        require_positive("radius", self.radius)
        require_positive("height", self.height)
        require_not_negative("inner_radius", self.inner_radius)
        if self.inner_radius >= self.radius:
            raise InputError("inner_radius", self.inner_radius, f"below radius ({self.radius:g} m)")
        if not math.isfinite(self.plane):
            raise InputError("plane", self.plane, "a finite number")
        if self.baffles is not None and self.baffles.tip_radius >= self.radius - self.baffles.wall_gap:
            allowed = f"below radius - wall_gap ({self.radius - self.baffles.wall_gap:g} m)"
            raise InputError("baffles.tip_radius", self.baffles.tip_radius, allowed)
        if self.section is not None:
            if self.baffles is not None or self.inner_radius > 0.0:
                raise InputError("section", self.section.name, "given without baffles and inner_radius")
            if not math.isclose(self.radius, self.section.farthest, rel_tol=1e-9):
                raise InputError("radius", self.radius, f"that of the section ({self.section.farthest:g} m)")

    @property
    def section_area(self) -> float:
        """Area of the section across the axis, m^2."""
        if self.section is not None:
            return self.section.area
        return math.pi * (self.radius - self.inner_radius) * (self.radius + self.inner_radius)

    @property
    def capacity(self) -> float:
        """Volume of liquid that fills the chamber, m^3."""
        return self.section_area * self.height


@dataclass(frozen=True)
class Chambers:
    """Many chambers as arrays, taken from `Chamber`s, which check their values."""

    radius: Array  #: of each, m, shape (n,)
    height: Array
    inner_radius: Array

    @classmethod
    def of(cls, chambers: Sequence[Chamber]) -> Chambers:
        """Arrays of some chambers."""
        sizes = np.array(
            [(chamber.radius, chamber.height, chamber.inner_radius) for chamber in chambers]
        ).reshape(-1, 3)
        return cls(*np.ascontiguousarray(sizes.T))

    def at(self, which: NDArray[np.intp]) -> Chambers:
        """Those at some indices, in their order, shape (m,)."""
        return Chambers(self.radius[which], self.height[which], self.inner_radius[which])

    @property
    def capacity(self) -> Array:
        """Volume of liquid that fills each, m^3, shape (n,)."""
        ring = (self.radius - self.inner_radius) * (self.radius + self.inner_radius)
        return np.asarray(math.pi * ring * self.height)
