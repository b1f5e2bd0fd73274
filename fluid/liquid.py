"""Liquids by name or by their properties, and how these change with temperature.

A law gives what temperature changes; the values at 20 degrees Celsius are those of `KNOWN_LIQUIDS`, which
come from other tables: they differ from the laws' by up to 0.3 % in density and 6 % in viscosity.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from meshes.errors import InputError, require_not_negative, require_positive


@dataclass(frozen=True)
class Liquid:
    """A Newtonian liquid.

    Parameters
    ----------
    name : what to call it in reports
    density : rho, kg/m^3
    viscosity : kinematic viscosity nu, m^2/s

    Raises
    ------
    InputError : a density that is not positive, a negative viscosity

    Examples
    --------
    >>> Liquid("water", density=998.2, viscosity=1.004e-6) == known_liquid("water")
    True
    """

    name: str
    density: float
    viscosity: float

    def __post_init__(self) -> None:
        require_positive("density", self.density)
        require_not_negative("viscosity", self.viscosity)


# Handbook values at 20 degrees Celsius, rounded to what the tables agree on.
KNOWN_LIQUIDS: dict[str, Liquid] = {
    liquid.name: liquid
    for liquid in (
        Liquid("water", 998.2, 1.004e-6),
        Liquid("sea_water", 1024.8, 1.05e-6),
        Liquid("brine", 1197.0, 1.66e-6),  # saturated sodium chloride, 26 % by mass
        Liquid("calcium_chloride_brine", 1396.0, 5.3e-6),  # 40 % by mass
        Liquid("ethylene_glycol", 1113.2, 1.81e-5),
        Liquid("glycerol", 1260.8, 1.12e-3),
        Liquid("mineral_oil", 870.0, 6.9e-5),  # ISO VG 32 at 20 degrees Celsius
        Liquid("silicone_oil_100", 965.0, 1.0e-4),
        Liquid("mercury", 13545.9, 1.147e-7),
    )
}


def known_liquid(name: str) -> Liquid:
    """Liquid of that name.

    Raises
    ------
    InputError : the name is not in `KNOWN_LIQUIDS`
    """
    if name not in KNOWN_LIQUIDS:
        raise InputError("liquid", name, "one of " + ", ".join(sorted(KNOWN_LIQUIDS)))
    return KNOWN_LIQUIDS[name]


CELSIUS = 273.15  # K at 0 degrees Celsius
REFERENCE = CELSIUS + 20.0  # K, to which `KNOWN_LIQUIDS` belong
SALINITY = 0.035  # of sea water, kg/kg
OIL_EXPANSION = 7e-4  # of mineral oils, 1/K

_Property = Callable[[float], float]


@dataclass(frozen=True)
class TemperatureLaw:
    """Density and viscosity of one liquid as its source gives them.

    Parameters
    ----------
    lowest, highest : K, between which the source holds
    density : kg/m^3, of the temperature in degrees Celsius
    viscosity : dynamic, Pa s, of the temperature in degrees Celsius
    source : keys of the references
    """

    lowest: float
    highest: float
    density: _Property
    viscosity: _Property
    source: str


def water_density(celsius: float) -> float:
    """Density of water at atmospheric pressure, kg/m^3 [KELL75]."""
    t = celsius
    above = -280.54253e-12 * t + 105.56302e-9
    for coefficient in (-46.170461e-6, -7.9870401e-3, 16.945176, 999.83952):
        above = above * t + coefficient
    return above / (1.0 + 16.879850e-3 * t)


def water_viscosity(celsius: float) -> float:
    """Dynamic viscosity of water at 0.1 MPa, Pa s [IAPWS11]."""
    relative = (celsius + CELSIUS) / 300.0
    terms = ((280.68, -1.9), (511.45, -7.7), (61.131, -19.6), (0.45903, -40.0))
    return 1e-6 * sum(factor * math.pow(relative, power) for factor, power in terms)


def sea_water_density(celsius: float) -> float:
    """Density of sea water, kg/m^3 [SLZ10]."""
    t, s = celsius, SALINITY
    fresh = 9.999e2 + 2.034e-2 * t - 6.162e-3 * t**2 + 2.261e-5 * t**3 - 4.657e-8 * t**4
    salt = 8.020e2 - 2.001 * t + 1.677e-2 * t**2 - 3.060e-5 * t**3 - 1.613e-5 * s * t**2
    return fresh + salt * s


def sea_water_viscosity(celsius: float) -> float:
    """Dynamic viscosity of sea water, Pa s [SLZ10, eq. 22]."""
    t, s = celsius, SALINITY
    fresh = 4.2844e-5 + 1.0 / (0.157 * (t + 64.993) ** 2 - 91.296)
    first = 1.541 + 1.998e-2 * t - 9.52e-5 * t**2
    second = 7.974 - 7.561e-2 * t + 4.724e-4 * t**2
    return fresh * (1.0 + first * s + second * s**2)


def glycerol_density(celsius: float) -> float:
    """Density of glycerol, kg/m^3 [CHENG08]."""
    return 1277.0 - 0.654 * celsius


def glycerol_viscosity(celsius: float) -> float:
    """Dynamic viscosity of glycerol, Pa s [CHENG08]."""
    return 12.1 * math.exp((celsius - 1233.0) * celsius / (9900.0 + 70.0 * celsius))


def glycol_density(celsius: float) -> float:
    """Density of ethylene glycol, kg/m^3 [ST03]."""
    return 1127.68 - 0.65816 * celsius - 6.1765e-4 * celsius**2


def glycol_viscosity(celsius: float) -> float:
    """Dynamic viscosity of ethylene glycol, Pa s [ST03]."""
    return 1e-3 * math.exp(986.519 / (celsius + 127.861) - 3.61359)


def oil_density(celsius: float) -> float:
    """Density of a mineral oil with the usual expansion, kg/m^3."""
    return KNOWN_LIQUIDS["mineral_oil"].density / (1.0 + OIL_EXPANSION * (celsius - 20.0))


def oil_viscosity(celsius: float) -> float:
    """Dynamic viscosity of an oil of 32 mm^2/s at 40 degrees Celsius, Pa s [ISO92].

    log log(nu + 0.7) is a straight line over log T, nu in mm^2/s; its other point is that at 20 degrees.
    """

    def height(square_millimetres: float) -> float:
        return math.log(math.log(square_millimetres + 0.7))

    cold, warm = math.log(REFERENCE), math.log(CELSIUS + 40.0)
    first, second = height(KNOWN_LIQUIDS["mineral_oil"].viscosity * 1e6), height(32.0)
    share = (math.log(celsius + CELSIUS) - cold) / (warm - cold)
    square_millimetres = math.exp(math.exp(first + share * (second - first))) - 0.7
    return 1e-6 * square_millimetres * oil_density(celsius)


LAWS: dict[str, TemperatureLaw] = {
    "water": TemperatureLaw(CELSIUS, CELSIUS + 100.0, water_density, water_viscosity, "KELL75, IAPWS11"),
    "sea_water": TemperatureLaw(CELSIUS, CELSIUS + 100.0, sea_water_density, sea_water_viscosity, "SLZ10"),
    "glycerol": TemperatureLaw(CELSIUS, CELSIUS + 100.0, glycerol_density, glycerol_viscosity, "CHENG08"),
    "ethylene_glycol": TemperatureLaw(290.0, 450.0, glycol_density, glycol_viscosity, "ST03"),
    "mineral_oil": TemperatureLaw(CELSIUS, CELSIUS + 60.0, oil_density, oil_viscosity, "ISO92"),
}


def liquid_at(liquid: Liquid, temperature: float) -> Liquid:
    """A liquid at another temperature than 20 degrees Celsius.

    Parameters
    ----------
    liquid : one of `KNOWN_LIQUIDS`
    temperature : K

    Raises
    ------
    InputError : no law for this liquid, a temperature out of its range

    Examples
    --------
    >>> from fluid.liquid import known_liquid
    >>> round(liquid_at(known_liquid("water"), 333.15).density, 1)
    983.2
    """
    law = LAWS.get(liquid.name)
    if law is None or KNOWN_LIQUIDS[liquid.name] != liquid:
        known = ", ".join(LAWS)
        raise InputError("liquid", liquid.name, f"one of {known} where temperatures matter")
    if not law.lowest <= temperature <= law.highest:
        span = f"from {law.lowest:g} to {law.highest:g} K for {liquid.name} [{law.source}]"
        raise InputError("temperature", temperature, span)
    here, there = temperature - CELSIUS, REFERENCE - CELSIUS
    thinner = law.density(here) / law.density(there)
    runnier = law.viscosity(here) / law.viscosity(there)
    return replace(liquid, density=liquid.density * thinner, viscosity=liquid.viscosity * runnier / thinner)


def expansion(liquid: Liquid, temperature: float) -> float:
    """Volume of a mass of liquid over that at 20 degrees Celsius [theory: optimum, eq. 9].

    Parameters
    ----------
    liquid, temperature : as for `liquid_at`

    Raises
    ------
    InputError : as `liquid_at`
    """
    return liquid.density / liquid_at(liquid, temperature).density
