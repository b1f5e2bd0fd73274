"""Liquids at other temperatures against tables of other sources."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fluid.liquid import (
    CELSIUS,
    KNOWN_LIQUIDS,
    LAWS,
    REFERENCE,
    Liquid,
    expansion,
    glycerol_density,
    glycerol_viscosity,
    glycol_density,
    glycol_viscosity,
    known_liquid,
    liquid_at,
    oil_density,
    oil_viscosity,
    sea_water_density,
    sea_water_viscosity,
    water_density,
    water_viscosity,
)
from meshes.errors import InputError
from tests.mutants import kills


@kills("fluid.liquid:water_density", "-7.9870401e-3", "7.9870401e-3")
@kills("fluid.liquid:water_density", "(1.0 + 16.879850e-3 * t)", "(1.0 - 16.879850e-3 * t)")
@kills("fluid.liquid:water_viscosity", "(celsius + CELSIUS) / 300.0", "(celsius + CELSIUS) / 293.15")
def test_water() -> None:
    """Viscosity at saturation from a handbook of chemical engineering; density of air-free water (ITS-90)."""
    for kelvin, micro in (
        (280, 1433.7),
        (290, 1084.0),
        (300, 853.84),
        (310, 693.54),
        (340, 421.97),
        (370, 291.36),
    ):
        # The correlation is good to a per cent, the handbook rounds at 1e-4.
        assert water_viscosity(kelvin - CELSIUS) == pytest.approx(micro * 1e-6, rel=2e-3)
    for celsius, density in (
        (0, 999.843),
        (4, 999.975),
        (20, 998.207),
        (40, 992.215),
        (60, 983.196),
        (100, 958.35),
    ):
        # An older scale of temperature: up to 0.015 kg/m^3 near boiling.
        assert water_density(celsius) == pytest.approx(density, abs=0.02)


@kills("fluid.liquid:sea_water_density", "2.034e-2 * t - 6.162e-3", "2.034e-2 * t + 6.162e-3")
@kills("fluid.liquid:sea_water_density", "fresh + salt * s", "fresh - salt * s")
@kills("fluid.liquid:sea_water_viscosity", "(1.0 + first * s", "(1.0 - first * s")
def test_sea_water() -> None:
    """Sea water of 35 g/kg by the ITTC's tables for ships: 1.1883e-6 m^2/s at 15 C, 1024.8 kg/m^3 at 20 C."""
    # Two independent fits, each good to a per cent and a tenth of a per cent.
    for celsius, density, kinematic in (
        (10, 1026.95, 1.3604e-6),
        (15, 1026.02, 1.1892e-6),
        (25, 1023.39, 9.371e-7),
    ):
        assert sea_water_density(celsius) == pytest.approx(density, rel=1e-3)
        assert sea_water_viscosity(celsius) / density == pytest.approx(kinematic, rel=1.5e-2)


@kills("fluid.liquid:glycerol_density", "1277.0 - 0.654", "1277.0 + 0.654")
@kills("fluid.liquid:glycerol_viscosity", "9900.0 + 70.0", "9900.0 - 70.0")
def test_glycerol() -> None:
    """Segur and Oberstar's table: 12.07 Pa s at 0 C, 1.41 at 20 C, 0.142 at 50 C, 0.0148 at 100 C."""
    for celsius, viscosity in ((0, 12.07), (20, 1.41), (50, 0.142), (100, 0.0148)):
        assert glycerol_viscosity(celsius) == pytest.approx(viscosity, rel=0.05)
    for celsius, density in ((15, 1264.0), (20, 1260.8), (30, 1254.6)):
        assert glycerol_density(celsius) == pytest.approx(density, rel=5e-3)


@kills("fluid.liquid:glycol_density", "1127.68 - 0.65816", "1127.68 + 0.65816")
@kills("fluid.liquid:glycol_viscosity", "(celsius + 127.861)", "(celsius + 147.861)")
def test_glycol() -> None:
    """A table for coolants: 15.5 mPa s at 26.7 C, 7.0 at 48.9 C, 3.8 at 71.1 C, 2.4 at 93.3 C."""
    for celsius, milli in ((26.7, 15.5), (48.9, 7.0), (71.1, 3.8), (93.3, 2.4)):
        assert glycol_viscosity(celsius) == pytest.approx(milli * 1e-3, rel=0.04)  # given with two digits
    for celsius, density in ((20, 1113.2), (60, 1085.0)):
        assert glycol_density(celsius) == pytest.approx(density, rel=3e-3)


@kills("fluid.liquid:oil_viscosity", "first + share * (second - first)", "first - share * (second - first)")
@kills("fluid.liquid:oil_density", "(1.0 + OIL_EXPANSION * ", "(1.0 - OIL_EXPANSION * ")
def test_oil() -> None:
    """The class of the oil is its viscosity at 40 C; the other point is the known liquid's."""
    assert oil_viscosity(40.0) / oil_density(40.0) == pytest.approx(32e-6, rel=1e-12)
    own = KNOWN_LIQUIDS["mineral_oil"]
    assert oil_viscosity(20.0) / oil_density(20.0) == pytest.approx(own.viscosity, rel=1e-12)
    assert oil_density(20.0) / oil_density(50.0) == pytest.approx(1.0 + 30.0 * 7e-4, rel=1e-12)


@kills("fluid.liquid:liquid_at", "liquid.viscosity * runnier / thinner", "liquid.viscosity * runnier")
@kills(
    "fluid.liquid:expansion",
    "return liquid.density / liquid_at(liquid, temperature).density",
    "return liquid_at(liquid, temperature).density / liquid.density",
)
def test_kept_mass() -> None:
    """The volume grows as the density falls; at 20 C nothing changes."""
    for name in LAWS:
        liquid = known_liquid(name)
        warm = liquid_at(liquid, REFERENCE + 30.0)
        assert warm.density * expansion(liquid, REFERENCE + 30.0) == pytest.approx(liquid.density, rel=1e-14)
        assert expansion(liquid, REFERENCE + 30.0) > 1.005
        same = liquid_at(liquid, REFERENCE)
        assert same.density == pytest.approx(liquid.density, rel=1e-14)
        assert same.viscosity == pytest.approx(liquid.viscosity, rel=1e-14)
    # Kinematic viscosity of water at 60 C, steam tables: 0.4748e-6; the known one at 20 C is rounded at 1e-3.
    assert liquid_at(known_liquid("water"), 333.15).viscosity == pytest.approx(0.4748e-6, rel=3e-3)


def test_laws_agree_with_the_known_liquids() -> None:
    """As far as the module says they do."""
    for name, law in LAWS.items():
        known = KNOWN_LIQUIDS[name]
        assert law.density(20.0) == pytest.approx(known.density, rel=3e-3)
        assert law.viscosity(20.0) / law.density(20.0) == pytest.approx(known.viscosity, rel=0.06)


@given(st.sampled_from(sorted(LAWS)), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_warmer_is_thinner_and_runnier(name: str, one: float, other: float) -> None:
    """Everywhere in the range, but for water below its densest point, 4 C."""
    law, liquid = LAWS[name], known_liquid(name)
    low = max(law.lowest, CELSIUS + 4.5) if name == "water" else law.lowest
    cold, warm = sorted(low + (law.highest - low) * x for x in (one, other))
    first, second = liquid_at(liquid, cold), liquid_at(liquid, warm)
    assert second.density <= first.density * (1.0 + 1e-12)
    assert second.viscosity <= first.viscosity * (1.0 + 1e-12)
    assert math.isfinite(second.viscosity) and second.viscosity > 0.0


def test_what_has_no_law_is_refused() -> None:
    water = known_liquid("water")
    for liquid in (known_liquid("mercury"), Liquid("liquid", 900.0, 1e-5), replace(water, density=1000.0)):
        with pytest.raises(InputError, match="liquid"):
            liquid_at(liquid, REFERENCE)
    for kelvin in (CELSIUS - 1.0, CELSIUS + 101.0):
        with pytest.raises(InputError, match="temperature"):
            liquid_at(water, kelvin)
