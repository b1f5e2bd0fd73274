"""A chamber with liquid in it; one, or many at once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fluid.liquid import Liquid
from meshes.arrays import Array
from meshes.chamber import Chamber, Chambers
from meshes.chamber_section import layer_depth, level
from meshes.errors import InputError, require_not_negative

FULL = 1.0 - 1e-9  # of the capacity; beyond it there is no free surface


def compartment_share(count: int) -> float:
    """Part of the added mass of a free surface that closed compartments take away [theory: sections, eq. 8].

    (n/pi)^2 sin^2(pi/n), the mean over all directions of the deflection: each sector keeps its volume.
    """
    return 0.0 if count == 1 else (count / math.pi * math.sin(math.pi / count)) ** 2


@dataclass(frozen=True)
class Fill:
    """A chamber, the liquid in it and how much of it.

    Raises
    ------
    InputError : a volume outside that range

    Examples
    --------
    >>> fill = Fill(Chamber(radius=0.2, height=0.05), Liquid("water", 998.2, 1.004e-6), volume=0.5e-3)
    >>> round(fill.mass, 6), round(fill.depth, 6)
    (0.4991, 0.008123)
    """

    chamber: Chamber  #: where the liquid is
    liquid: Liquid  #: what it is
    volume: float  #: V, m^3, from 0 to the chamber's capacity

    def __post_init__(self) -> None:
        require_not_negative("volume", self.volume)
        # A volume given as the capacity may exceed it by rounding.
        if self.volume > self.chamber.capacity * (1.0 + 1e-12):
            raise InputError(
                "volume", self.volume, f"at most the chamber's capacity ({self.chamber.capacity:g} m^3)"
            )

    @property
    def mass(self) -> float:
        """Mass of the liquid m_l, kg."""
        return self.liquid.density * self.volume

    @property
    def full_mass(self) -> float:
        """Mass m_f of liquid that would fill the cylinder, kg: the added mass of a layer without baffles."""
        return self.liquid.density * math.pi * self.chamber.radius**2 * self.chamber.height

    @property
    def added_mass(self) -> float:
        """Mass that the liquid adds in a small whirl with the spin, kg [theory: sections, eq. 8].

        In a section of another shape that of the liquid and of the air inside its surface, if it has one.
        """
        if self.chamber.section is not None:
            if not self.uneven:
                return self.mass
            air = math.pi * self.chamber.height * self.surface_radius**2
            return self.liquid.density * (self.volume + air)
        lost = compartment_share(self.compartments) * self.surface_radius**2
        return self.full_mass - self.liquid.density * math.pi * self.chamber.height * lost

    @property
    def surface_radius(self) -> float:
        """Mean free-surface radius a of the uniform layer at fast spin, m."""
        section, area = self.chamber.section, self.volume / self.chamber.height
        if section is not None:
            if 0.0 < area < section.area * FULL:
                return level(section, area)[0]
            return self.chamber.radius if area == 0.0 else 0.0
        squared = self.chamber.radius**2 - self.volume / (math.pi * self.chamber.height)
        return math.sqrt(max(squared, self.chamber.inner_radius**2))

    @property
    def depth(self) -> float:
        """Mean layer depth h0 = R - a, m, without cancellation for thin layers; the least elsewhere."""
        section, area = self.chamber.section, self.volume / self.chamber.height
        if section is not None:
            return layer_depth(section, area) if 0.0 < area < section.area * FULL else 0.0
        film = self.volume / (math.pi * self.chamber.height)
        return film / (self.chamber.radius + self.surface_radius)

    @property
    def uneven(self) -> bool:
        """The waves at fast spin are not those of a clear ring: baffles in the liquid, or another section."""
        baffles, radius = self.chamber.baffles, self.chamber.radius
        if self.chamber.section is not None:
            return 0.0 < self.volume < self.chamber.capacity * FULL
        if baffles is None or not 0.0 < self.volume < self.chamber.capacity * FULL:
            return False
        return baffles.wetted_span(radius, self.surface_radius) is not None

    @property
    def compartments(self) -> int:
        """Bodies of liquid that baffles keep apart, from the wall through the surface; 1 if it can pass."""
        baffles = self.chamber.baffles
        if baffles is None or not self.uneven:
            return 1
        span = baffles.wetted_span(self.chamber.radius, self.surface_radius)
        return baffles.count if span == (self.surface_radius, self.chamber.radius) else 1


@dataclass(frozen=True)
class Fills:
    """Many chambers with liquid as arrays, taken from `Fill`s, which check their values."""

    chamber: Chambers  #: of each
    density: Array  #: of its liquid, kg/m^3, shape (n,)
    volume: Array  #: V, m^3, shape (n,)
    added_mass: Array  #: in a small whirl with the spin, kg, shape (n,); 0 without liquid
    depth: Array  #: of the layer, m, shape (n,); in a section of another shape the least
    origin: tuple[Fill, ...]  #: the fills they were taken from
    which: NDArray[np.intp]  #: index of each among those, shape (n,)

    @classmethod
    def of(cls, fills: Sequence[Fill]) -> Fills:
        """Arrays of some fills."""
        return cls(
            Chambers.of([fill.chamber for fill in fills]),
            np.array([fill.liquid.density for fill in fills]),
            np.array([fill.volume for fill in fills]),
            np.array([fill.added_mass if fill.volume > 0.0 else 0.0 for fill in fills]),
            np.array([fill.depth for fill in fills]),
            tuple(fills),
            np.arange(len(fills)),
        )

    @classmethod
    def joined(cls, parts: Sequence[Fills]) -> Fills:
        """Some arrays one behind the other."""
        walls = [part.chamber for part in parts]
        first = np.cumsum([0, *(len(part.origin) for part in parts)])
        return cls(
            Chambers(
                np.concatenate([wall.radius for wall in walls]),
                np.concatenate([wall.height for wall in walls]),
                np.concatenate([wall.inner_radius for wall in walls]),
            ),
            np.concatenate([part.density for part in parts]),
            np.concatenate([part.volume for part in parts]),
            np.concatenate([part.added_mass for part in parts]),
            np.concatenate([part.depth for part in parts]),
            tuple(fill for part in parts for fill in part.origin),
            np.concatenate([part.which + k for part, k in zip(parts, first[:-1], strict=True)]),
        )

    def at(self, which: NDArray[np.intp]) -> Fills:
        """Those at some indices, in their order, shape (m,)."""
        return Fills(
            self.chamber.at(which),
            self.density[which],
            self.volume[which],
            self.added_mass[which],
            self.depth[which],
            self.origin,
            self.which[which],
        )

    def fill(self, k: int) -> Fill:
        """A single one of them, as it was given."""
        return self.origin[int(self.which[k])]

    def __len__(self) -> int:
        return self.which.size

    @property
    def mass(self) -> Array:
        """Mass of the liquid m_l, kg, shape (n,)."""
        return self.density * self.volume
