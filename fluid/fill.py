"""A chamber with liquid in it; one, or many at once."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fluid.liquid import Liquid
from meshes.border import InputError, require_not_negative
from meshes.chamber import Chamber, Chambers

Array = NDArray[np.float64]


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


@dataclass(frozen=True)
class Fills:
    """Many chambers with liquid as arrays, taken from `Fill`s, which check their values.

    Parameters
    ----------
    chamber : of each
    density : of its liquid, kg/m^3, shape (n,)
    volume : V, m^3, shape (n,)
    """

    chamber: Chambers
    density: Array
    volume: Array

    @classmethod
    def of(cls, fills: Sequence[Fill]) -> Fills:
        """Arrays of some fills."""
        density = np.array([one.liquid.density for one in fills])
        return cls(
            Chambers.of([one.chamber for one in fills]), density, np.array([one.volume for one in fills])
        )

    @classmethod
    def same(cls, fill: Fill, count: int) -> Fills:
        """One fill so many times."""
        return cls.of([fill]).at(np.zeros(count, dtype=np.intp))

    @classmethod
    def joined(cls, parts: Sequence[Fills]) -> Fills:
        """Some arrays one behind the other."""
        walls = [part.chamber for part in parts]
        return cls(
            Chambers(
                np.concatenate([one.radius for one in walls]),
                np.concatenate([one.height for one in walls]),
                np.concatenate([one.inner_radius for one in walls]),
            ),
            np.concatenate([part.density for part in parts]),
            np.concatenate([part.volume for part in parts]),
        )

    def at(self, which: NDArray[np.intp]) -> Fills:
        """Those at some indices, in their order, shape (m,)."""
        return Fills(self.chamber.at(which), self.density[which], self.volume[which])

    @property
    def mass(self) -> Array:
        """Mass of the liquid m_l, kg, shape (n,)."""
        return self.density * self.volume

    @property
    def full_mass(self) -> Array:
        """Mass m_f of liquid that would fill the whole cylinder, kg, shape (n,); 0 without liquid."""
        full = self.density * math.pi * np.square(self.chamber.radius) * self.chamber.height
        return np.where(self.volume > 0.0, full, 0.0)

    @property
    def depth(self) -> Array:
        """Mean layer depth h0 = R - a, m, shape (n,), without cancellation for thin layers."""
        film = self.volume / (math.pi * self.chamber.height)
        squared = np.square(self.chamber.radius) - film
        surface = np.sqrt(np.maximum(squared, np.square(self.chamber.inner_radius)))
        return np.asarray(film / (self.chamber.radius + surface))
