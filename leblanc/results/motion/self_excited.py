"""Whirl that grows by itself."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from leblanc.core.netcdf import Variable, finite
from leblanc.core.netcdf import variable as var
from leblanc.results.motion.cycles import LargeWhirl
from meshes.arrays import Array, Flags


@dataclass(frozen=True)
class SelfExcited:
    """Whirl that grows by itself from the even layer, in linear theory."""

    growth: Array  #: of the whirl that grows most, 1/s, nan where it was not found, shape (n,)
    whirl_speed: Array  #: of that whirl in the standing frame, rad/s, shape (n,)
    #: of speed in which some whirl grows, rad/s; the ends of the range of speeds count as edges
    bands: tuple[tuple[float, float], ...]
    friction: str  #: of the liquid, in words
    #: bands of speed in which the modes were not found, between the nearest speeds where they were, rad/s
    not_known: tuple[tuple[float, float], ...] = ()
    large: LargeWhirl | None = None  #: how large the whirl becomes; None where that was not asked for

    def leaves_stable(self, stable: Flags) -> Flags:
        """Stable against slow disturbances, no whirl grows; what is not known is not stable; shape (n,)."""
        return np.asarray(stable & (self.growth <= 0.0))

    def inside(self, speed: Array) -> Flags:
        """Whether speeds lie inside a band in which a whirl grows, shape (n,)."""
        found = np.zeros(speed.shape, dtype=bool)
        for low, high in self.bands:
            found |= (speed >= low) & (speed <= high)
        return found

    def to_json(self) -> dict[str, Any]:
        """Growth over speed, and the bands of speed in which it is positive."""
        return {
            "growth": finite(self.growth),
            "whirl_speed": finite(self.whirl_speed),
            "whirl_bands": [list(band) for band in self.bands],
            "whirl_bands_not_known": [list(band) for band in self.not_known],
            **({} if self.large is None else self.large.to_json()),
        }

    def variables(self) -> dict[str, Variable]:
        """Arrays over `speed`; those of finite whirls over `cycle` and `fold` too."""
        most, over = "of the whirl that grows most", ("speed",)
        return {
            "growth": var(over, self.growth, "s-1", "growth rate", f"{most}; above 0 unstable"),
            "whirl_speed": var(over, self.whirl_speed, "rad s-1", "whirl speed", f"{most}, in space"),
            **({} if self.large is None else self.large.variables()),
        }
