"""A chamber with liquid in it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fluid.liquid import Liquid
from meshes.border import InputError, require_not_negative
from meshes.chamber import Chamber


@dataclass(frozen=True)
class Fill:
    """A chamber, the liquid in it and how much of it.

    Parameters
    ----------
    chamber : where the liquid is
    liquid : what it is
    volume : V, m^3, from 0 to the chamber's capacity

    Raises
    ------
    InputError : a volume outside that range
    """

    chamber: Chamber
    liquid: Liquid
    volume: float

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
        """Mass m_f of liquid that would fill the whole cylinder, kg: the added mass of a layer."""
        return self.liquid.density * math.pi * self.chamber.radius**2 * self.chamber.height

    @property
    def surface_radius(self) -> float:
        """Mean free-surface radius a of the uniform layer at fast spin, m."""
        squared = self.chamber.radius**2 - self.volume / (math.pi * self.chamber.height)
        return math.sqrt(max(squared, self.chamber.inner_radius**2))

    @property
    def depth(self) -> float:
        """Mean layer depth h0 = R - a, m, without cancellation for thin layers."""
        film = self.volume / (math.pi * self.chamber.height)
        return film / (self.chamber.radius + self.surface_radius)
