"""How a property of a liquid depends on the temperature: a table, or a law with coefficients.

A law is data, not code: it can be compared, kept in a scene and sent to another process. Temperatures are
absolute. Theory page: liquids, eq. 1 to 5.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from meshes.errors import InputError, require_not_negative, require_positive

CELSIUS = 273.15  # K at 0 degrees Celsius
REFERENCE = CELSIUS + 20.0  # K, to which a liquid's values belong where nothing else is said
AS_GIVEN = "as given"  # source of a law that a scene gives
_WALTHER = 0.7  # mm^2/s, added to a viscosity above 2 mm^2/s [ASTM17]
_LEAST_WALTHER = 2.0  # mm^2/s, below which that constant is another one


class PropertyLaw(Protocol):
    """A property of a liquid over temperature."""

    @property
    def lowest(self) -> float:
        """From which temperature on it holds, K."""
        ...

    @property
    def highest(self) -> float:
        """Up to which temperature it holds, K."""
        ...

    def at(self, temperature: float) -> float:
        """The property at a temperature in that range, K, in its SI unit."""
        ...


@dataclass(frozen=True)
class Constant:
    """A property that does not change."""

    value: float  #: in its SI unit
    lowest: float = 0.0
    highest: float = math.inf

    def at(self, temperature: float) -> float:
        """See `PropertyLaw`."""
        return self.value


@dataclass(frozen=True)
class Tabulated:
    """A property from a table, its logarithm a monotone piecewise cubic (PCHIP) [theory: liquids, eq. 1].

    The error falls with the third power of the distance of even points; two points make a straight line.
    """

    temperatures: tuple[float, ...]  #: rising, K; at least two
    values: tuple[float, ...]  #: in its SI unit, above 0

    def __post_init__(self) -> None:
        count = len(self.temperatures)
        if count < 2 or not all(map(math.isfinite, self.temperatures)):
            raise InputError("temperatures", list(self.temperatures), "at least two finite temperatures")
        steps = zip(self.temperatures, self.temperatures[1:], strict=False)
        if any(later <= earlier for earlier, later in steps):
            raise InputError("temperatures", list(self.temperatures), "each above the one before")
        if len(self.values) != count:
            raise InputError("values", list(self.values), f"{count} values, one for each temperature")
        for value in self.values:
            require_positive("values", value)

    @property
    def lowest(self) -> float:
        """See `PropertyLaw`."""
        return self.temperatures[0]

    @property
    def highest(self) -> float:
        """See `PropertyLaw`."""
        return self.temperatures[-1]

    def at(self, temperature: float) -> float:
        """See `PropertyLaw`."""
        import numpy as np
        from scipy.interpolate import PchipInterpolator

        if temperature in self.temperatures:  # as the table has it, to the last digit
            return self.values[self.temperatures.index(temperature)]
        return math.exp(float(PchipInterpolator(self.temperatures, np.log(self.values))(temperature)))


@dataclass(frozen=True)
class Expansion:
    """Density of a liquid whose volume grows linearly [theory: liquids, eq. 2]."""

    value: float  #: density at that temperature, kg/m^3
    temperature: float  #: K
    expansion: float  #: of the volume there, 1/K
    lowest: float  #: between which this holds, K
    highest: float

    def __post_init__(self) -> None:
        require_positive("value", self.value)
        _require_range(self.lowest, self.highest)
        volumes = [self._volume(end) for end in (self.lowest, self.highest)]
        if not min(volumes) > 0.0:
            raise InputError("expansion", self.expansion, "such that the volume stays above 0 in the range")

    def _volume(self, temperature: float) -> float:
        return 1.0 + self.expansion * (temperature - self.temperature)

    def at(self, temperature: float) -> float:
        """See `PropertyLaw`."""
        return self.value / self._volume(temperature)


@dataclass(frozen=True)
class Walther:
    """Kinematic viscosity of an oil through two points, ASTM D341 [theory: liquids, eq. 3].

    log log(nu + 0.7) is a straight line over log T, nu in mm^2/s.
    """

    temperatures: tuple[float, float]  #: of the two points, K, rising
    values: tuple[float, float]  #: kinematic viscosity there, m^2/s, both above 2 mm^2/s
    lowest: float  #: between which the line holds, K
    highest: float

    def __post_init__(self) -> None:
        _require_range(self.lowest, self.highest)
        if len(self.temperatures) != 2 or len(self.values) != 2:
            raise InputError("temperatures", list(self.temperatures), "two of them, with two values")
        if not 0.0 < self.temperatures[0] < self.temperatures[1]:
            raise InputError("temperatures", list(self.temperatures), "two of them, the lower first")
        if not self.values[0] > self.values[1] >= _LEAST_WALTHER * 1e-6:
            raise InputError("values", list(self.values), "falling, and at least 2e-06 m^2/s")
        if not self.at(self.highest) >= _LEAST_WALTHER * 1e-6 * (1.0 - 1e-12):
            limit = "a temperature up to which the viscosity is at least 2e-06 m^2/s"
            raise InputError("range", self.highest, limit)

    def at(self, temperature: float) -> float:
        """See `PropertyLaw`."""
        cold, warm = (math.log(point) for point in self.temperatures)
        first, second = (math.log(math.log(value * 1e6 + _WALTHER)) for value in self.values)
        share = (math.log(temperature) - cold) / (warm - cold)
        return 1e-6 * (math.exp(math.exp(first + share * (second - first))) - _WALTHER)


@dataclass(frozen=True)
class Vogel:
    """Kinematic viscosity nu = a exp(b / (T - c)), with c = 0 Andrade's law [theory: liquids, eq. 4, 5]."""

    a: float  #: m^2/s
    b: float  #: K
    c: float
    lowest: float  #: between which this holds, K; both above c
    highest: float

    def __post_init__(self) -> None:
        require_positive("a", self.a)
        require_not_negative("b", self.b)
        _require_range(self.lowest, self.highest)
        if not self.c < self.lowest:
            raise InputError("c", self.c, f"below the range, which begins at {self.lowest:g} K")
        if not self.b / (self.lowest - self.c) < 500.0:
            raise InputError("b", self.b, "such that the viscosity stays finite in the range")

    def at(self, temperature: float) -> float:
        """See `PropertyLaw`."""
        return self.a * math.exp(self.b / (temperature - self.c))


def _require_range(lowest: float, highest: float) -> None:
    if not (0.0 < lowest < highest and math.isfinite(highest)):
        raise InputError("range", [lowest, highest], "two temperatures above 0 K, the lower first")


@dataclass(frozen=True)
class GivenLaw:
    """Density and viscosity of a liquid over temperature, each by a law of its own."""

    density: PropertyLaw  #: kg/m^3
    viscosity: PropertyLaw  #: kinematic, m^2/s
    reference: float = REFERENCE  #: temperature to which the liquid's own values belong, K
    source: str = AS_GIVEN  #: keys of the references

    def __post_init__(self) -> None:
        if not self.lowest < self.highest:
            text = "ranges of density and viscosity that have temperatures in common"
            raise InputError("range", [self.lowest, self.highest], text)
        if not self.lowest <= self.reference <= self.highest:
            text = f"from {self.lowest:g} to {self.highest:g} K, where density and viscosity are given"
            raise InputError("temperature", self.reference, text)

    @property
    def lowest(self) -> float:
        """From which temperature on both hold, K."""
        return max(self.density.lowest, self.viscosity.lowest)

    @property
    def highest(self) -> float:
        """Up to which temperature both hold, K."""
        return min(self.density.highest, self.viscosity.highest)

    def relative(self, temperature: float) -> tuple[float, float]:
        """Density and kinematic viscosity at a temperature over those at the reference."""
        pairs = ((law.at(temperature), law.at(self.reference)) for law in (self.density, self.viscosity))
        rho, nu = (here / there if there > 0.0 else 1.0 for here, there in pairs)
        return rho, nu
