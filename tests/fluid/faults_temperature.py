"""Seeded faults of the liquids over temperature."""

from __future__ import annotations

from tests.faults import Fault
from tests.fluid import test_temperature as oracle

_MODULE = "fluid.liquid"

FAULTS: tuple[Fault, ...] = (
    Fault(_MODULE, "-7.9870401e-3", "7.9870401e-3", oracle.check_water),
    Fault(_MODULE, "(1.0 + 16.879850e-3 * t)", "(1.0 - 16.879850e-3 * t)", oracle.check_water),
    Fault(_MODULE, "(celsius + CELSIUS) / 300.0", "(celsius + CELSIUS) / 293.15", oracle.check_water),
    Fault(_MODULE, "2.034e-2 * t - 6.162e-3", "2.034e-2 * t + 6.162e-3", oracle.check_sea_water),
    Fault(_MODULE, "fresh + salt * s", "fresh - salt * s", oracle.check_sea_water),
    Fault(_MODULE, "(1.0 + first * s", "(1.0 - first * s", oracle.check_sea_water),
    Fault(_MODULE, "1277.0 - 0.654", "1277.0 + 0.654", oracle.check_glycerol),
    Fault(_MODULE, "9900.0 + 70.0", "9900.0 - 70.0", oracle.check_glycerol),
    Fault(_MODULE, "1127.68 - 0.65816", "1127.68 + 0.65816", oracle.check_glycol),
    Fault(_MODULE, "(celsius + 127.861)", "(celsius + 147.861)", oracle.check_glycol),
    Fault(_MODULE, "first + share * (second - first)", "first - share * (second - first)", oracle.check_oil),
    Fault(_MODULE, "(1.0 + OIL_EXPANSION * ", "(1.0 - OIL_EXPANSION * ", oracle.check_oil),
    Fault(
        _MODULE, "liquid.viscosity * runnier / thinner", "liquid.viscosity * runnier", oracle.check_kept_mass
    ),
    Fault(
        _MODULE,
        "return liquid.density / liquid_at(liquid, temperature).density",
        "return liquid_at(liquid, temperature).density / liquid.density",
        oracle.check_kept_mass,
    ),
)
