"""Liquids by name or by their properties, and how these change with temperature.

A law gives what temperature changes; the values at 20 degrees Celsius are those of `KNOWN_LIQUIDS`, which
come from other tables: they differ from the laws' by up to 0.3 % in density and 6 % in viscosity.
Brines of any strength and silicone oils have the values of their laws.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from fluid.temperature import AS_GIVEN, CELSIUS, REFERENCE, Expansion, GivenLaw, Vogel
from meshes.errors import InputError, require_not_negative, require_positive


@dataclass(frozen=True)
class Liquid:
    """A Newtonian liquid.

    Raises
    ------
    InputError : a density that is not positive, a negative viscosity

    Examples
    --------
    >>> Liquid("water", density=998.2, viscosity=1.004e-6) == known_liquid("water")
    True
    """

    name: str  #: what to call it in reports
    density: float  #: rho, kg/m^3
    viscosity: float  #: kinematic viscosity nu, m^2/s
    #: how both change with temperature; None where that is not known, or where the name says it
    law: GivenLaw | BrineLaw | None = None

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


SALINITY = 0.035  # of sea water, kg/kg
OIL_EXPANSION = 7e-4  # of mineral oils, 1/K

_Property = Callable[[float], float]


@dataclass(frozen=True)
class TemperatureLaw:
    """Density and viscosity of one liquid as its source gives them."""

    lowest: float  #: K, between which the source holds
    highest: float
    density: _Property  #: kg/m^3, of the temperature in degrees Celsius
    viscosity: _Property  #: dynamic, Pa s, of the temperature in degrees Celsius
    source: str  #: keys of the references

    reference = REFERENCE

    def relative(self, temperature: float) -> tuple[float, float]:
        """Density and kinematic viscosity at a temperature, K, over those at the reference."""
        return _relative(self.density, self.viscosity, temperature)


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


@dataclass(frozen=True)
class Salt:
    """Coefficients of a salt in water [LC04, LAL07; refitted in LAL09]."""

    lowest: float  #: K, between which they hold
    highest: float
    most: float  #: mass fraction up to which they hold, below saturation at 20 degrees Celsius
    volume: tuple[float, float, float, float, float]  #: c_0 to c_4 of its apparent density
    viscosity: tuple[float, float, float, float, float, float]  #: v_1 to v_6


SALTS = {
    "sodium_chloride": Salt(
        lowest=CELSIUS + 5.0,
        highest=CELSIUS + 100.0,
        most=0.26,
        volume=(-0.0032411222, 0.0636354336, 1.0137139947, 0.0145951015, 3317.348544),
        viscosity=(16.2217886, 1.32293087, 1.48485985, 0.00746912560, 30.7802008, 2.05826852),
    ),
    "calcium_chloride": Salt(
        lowest=CELSIUS + 15.0,
        highest=CELSIUS + 100.0,
        most=0.42,
        volume=(-9.7289374715, 14.7005352975, 4.1903334147, 0.0397403624, 2708.127789),
        viscosity=(32.0143700, 0.788104086, -1.14120454, 0.00270010694, 776516.747, 5.83888131),
    ),
}


@dataclass(frozen=True)
class BrineLaw:
    """A salt in water over temperature [theory: liquids, eq. 6, 7]."""

    salt: str  #: one of `SALTS`
    mass_fraction: float  #: of the salt in the solution

    reference = REFERENCE
    source = "LC04, LAL07, LAL09"

    def __post_init__(self) -> None:
        if self.salt not in SALTS:
            raise InputError("salt", self.salt, "one of: " + ", ".join(SALTS))
        most = SALTS[self.salt].most
        if not 0.0 <= self.mass_fraction <= most:
            raise InputError("mass_fraction", self.mass_fraction, f"from 0 to {most:g} for {self.salt}")

    @property
    def lowest(self) -> float:
        """From which temperature on it holds, K."""
        return SALTS[self.salt].lowest

    @property
    def highest(self) -> float:
        """Up to which temperature it holds, K."""
        return SALTS[self.salt].highest

    def density(self, celsius: float) -> float:
        """Density of the solution, kg/m^3, its water that of [KELL75]."""
        c0, c1, c2, c3, c4 = SALTS[self.salt].volume
        share = self.mass_fraction
        apparent = (c0 * share + c1) * math.exp(1e-6 * (celsius + c4) ** 2) / (share + c2 + c3 * celsius)
        return 1.0 / ((1.0 - share) / water_density(celsius) + share / apparent)

    def viscosity(self, celsius: float) -> float:
        """Dynamic viscosity of the solution, Pa s."""
        v1, v2, v3, v4, v5, v6 = SALTS[self.salt].viscosity
        share = self.mass_fraction
        water = (celsius + 246.0) / ((0.05594 * celsius + 5.2842) * celsius + 137.37)
        salt = math.exp((v1 * math.pow(share, v2) + v3) / (v4 * celsius + 1.0))
        salt /= v5 * math.pow(share, v6) + 1.0
        return 1e-3 * math.pow(water, 1.0 - share) * math.pow(salt, share)

    def relative(self, temperature: float) -> tuple[float, float]:
        """Density and kinematic viscosity at a temperature, K, over those at the reference."""
        return _relative(self.density, self.viscosity, temperature)


def brine(salt: str, mass_fraction: float) -> Liquid:
    """A salt in water, at 20 degrees Celsius.

    Parameters
    ----------
    salt : one of `SALTS`
    mass_fraction : of the salt in the solution

    Raises
    ------
    InputError : another salt, a mass fraction out of its range

    Examples
    --------
    >>> round(brine("sodium_chloride", 0.2).density)
    1148
    """
    law = BrineLaw(salt, mass_fraction)
    density = law.density(REFERENCE - CELSIUS)
    name = f"{100.0 * mass_fraction:g} % {salt.replace('_', ' ')} brine"
    return Liquid(name, density, law.viscosity(REFERENCE - CELSIUS) / density, law)


def _relative(density: _Property, viscosity: _Property, temperature: float) -> tuple[float, float]:
    """Density and kinematic viscosity at a temperature, K, over those at 20 degrees Celsius."""
    here, there = temperature - CELSIUS, REFERENCE - CELSIUS
    thinner = density(here) / density(there)
    return thinner, viscosity(here) / viscosity(there) / thinner


SILICONE_SLOPE = 763.1 * math.log(10.0)  # K, of the logarithm of the viscosity over 1/T [KF96]
SILICONE_EXPANSION = 9.5e-4  # 1/K [KF96]
_GRADED = CELSIUS + 25.0  # K, at which silicone oils have the viscosity that they are sold by


def silicone_law(grade: float, density: float) -> GivenLaw:
    """A silicone oil (polydimethylsiloxane) over temperature [KF96].

    Its grade, m^2/s, from 100 mm^2/s up, and its density, both at 25 degrees Celsius.
    """
    span = CELSIUS - 25.0, CELSIUS + 250.0
    thickness = Vogel(grade * math.exp(-SILICONE_SLOPE / _GRADED), SILICONE_SLOPE, 0.0, *span)
    return GivenLaw(Expansion(density, _GRADED, SILICONE_EXPANSION, *span), thickness, source="KF96")


_SILICONES = {
    f"silicone_oil_{grade}": silicone_law(grade * 1e-6, density)
    for grade, density in ((100, 965.0), (200, 970.0), (350, 970.0), (500, 970.0), (1000, 970.0))
}
KNOWN_LIQUIDS |= {
    name: Liquid(name, law.density.at(REFERENCE), law.viscosity.at(REFERENCE))
    for name, law in _SILICONES.items()
}


LAWS: dict[str, TemperatureLaw | BrineLaw | GivenLaw] = {
    "water": TemperatureLaw(CELSIUS, CELSIUS + 100.0, water_density, water_viscosity, "KELL75, IAPWS11"),
    "sea_water": TemperatureLaw(CELSIUS, CELSIUS + 100.0, sea_water_density, sea_water_viscosity, "SLZ10"),
    "glycerol": TemperatureLaw(CELSIUS, CELSIUS + 100.0, glycerol_density, glycerol_viscosity, "CHENG08"),
    "ethylene_glycol": TemperatureLaw(290.0, 450.0, glycol_density, glycol_viscosity, "ST03"),
    "mineral_oil": TemperatureLaw(CELSIUS, CELSIUS + 60.0, oil_density, oil_viscosity, "ISO92"),
    "brine": BrineLaw("sodium_chloride", 0.26),
    "calcium_chloride_brine": BrineLaw("calcium_chloride", 0.4),
    **_SILICONES,
}


def law_of(liquid: Liquid) -> TemperatureLaw | BrineLaw | GivenLaw | None:
    """How a liquid changes with temperature: its own law, or that of the known liquid that it is, or None."""
    if liquid.law is not None:
        return liquid.law
    return LAWS.get(liquid.name) if KNOWN_LIQUIDS.get(liquid.name) == liquid else None


def liquid_at(liquid: Liquid, temperature: float) -> Liquid:
    """A liquid at another temperature than that to which its values belong.

    Parameters
    ----------
    liquid : with a law: one of `LAWS`, or one of its own
    temperature : K

    Returns
    -------
    The liquid there; it has no law, which counts from another temperature

    Raises
    ------
    InputError : no law for this liquid, a temperature out of its range

    Examples
    --------
    >>> from fluid.liquid import known_liquid
    >>> round(liquid_at(known_liquid("water"), 333.15).density, 1)
    983.2
    """
    law = law_of(liquid)
    if law is None:
        known = ", ".join(LAWS)
        text = f"one of {known}, or given over temperature itself, where temperatures matter"
        raise InputError("liquid", liquid.name, text)
    if not law.lowest <= temperature <= law.highest:
        name = liquid.name if law.source == AS_GIVEN else f"{liquid.name} [{law.source}]"
        degrees = f"{law.lowest - CELSIUS:g} to {law.highest - CELSIUS:g} degC"
        span = f"from {law.lowest:g} to {law.highest:g} K ({degrees}) for {name}"
        asked = f"{temperature:g} K ({temperature - CELSIUS:g} degC)"
        raise InputError("temperature", asked, span)
    thinner, runnier = law.relative(temperature)
    density, viscosity = liquid.density * thinner, liquid.viscosity * runnier
    return replace(liquid, density=density, viscosity=viscosity, law=None)


def expansion(liquid: Liquid, temperature: float) -> float:
    """Volume of a mass of liquid over that at the temperature of its values [theory: optimum, eq. 9]."""
    return liquid.density / liquid_at(liquid, temperature).density
