"""Liquids by name or by their properties."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.border import InputError, require_not_negative, require_positive


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
