"""Liquids at other temperatures against tables of other sources."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fluid.liquid import (
    KNOWN_LIQUIDS,
    LAWS,
    SALTS,
    BrineLaw,
    Liquid,
    brine,
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
    silicone_law,
    water_density,
    water_viscosity,
)
from fluid.temperature import CELSIUS, REFERENCE, Constant, Expansion, GivenLaw, Tabulated, Vogel, Walther
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


@kills("fluid.liquid:_relative", "viscosity(there) / thinner", "viscosity(there)")
@kills(
    "fluid.liquid:expansion",
    "return liquid.density / liquid_at(liquid, temperature).density",
    "return liquid_at(liquid, temperature).density / liquid.density",
)
def test_kept_mass() -> None:
    """The volume grows as the density falls; at 20 C nothing changes."""
    for liquid in (*map(known_liquid, LAWS), brine("sodium_chloride", 0.1)):
        warm = liquid_at(liquid, REFERENCE + 30.0)
        assert warm.density * expansion(liquid, REFERENCE + 30.0) == pytest.approx(liquid.density, rel=1e-14)
        assert expansion(liquid, REFERENCE + 30.0) > 1.005
        same = liquid_at(liquid, REFERENCE)
        assert same.density == pytest.approx(liquid.density, rel=1e-14)
        assert same.viscosity == pytest.approx(liquid.viscosity, rel=1e-14)
    # Kinematic viscosity of water at 60 C, steam tables: 0.4748e-6; the known one at 20 C is rounded at 1e-3.
    assert liquid_at(known_liquid("water"), 333.15).viscosity == pytest.approx(0.4748e-6, rel=3e-3)


def test_laws_agree_with_the_known_liquids() -> None:
    """As far as the module says they do; silicone oils are their laws."""
    for name, law in LAWS.items():
        known = KNOWN_LIQUIDS[name]
        if isinstance(law, GivenLaw):
            assert law.density.at(REFERENCE) == known.density
            assert law.viscosity.at(REFERENCE) == known.viscosity
            continue
        assert law.density(20.0) == pytest.approx(known.density, rel=3e-3)
        # The table of this brine says less; its change with temperature is all that is taken from the law.
        most = 0.21 if name == "calcium_chloride_brine" else 0.06
        assert law.viscosity(20.0) / law.density(20.0) == pytest.approx(known.viscosity, rel=most)


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
        with pytest.raises(InputError, match=r"273\.15 to 373\.15 K \(0 to 100 degC\)"):
            liquid_at(water, kelvin)
    with pytest.raises(InputError, match="liquid"):  # it is at another temperature already
        liquid_at(liquid_at(brine("sodium_chloride", 0.1), 300.0), 300.0)


@kills("fluid.liquid:BrineLaw.density", "(share + c2 + c3 * celsius)", "(share + c2 - c3 * celsius)")
@kills("fluid.liquid:BrineLaw.viscosity", "math.pow(water, 1.0 - share)", "water")
def test_brines() -> None:
    """Handbook of chemistry at 20 C; sodium chloride over temperature by another correlation [KKC81]."""
    for salt, share, density, milli in (
        ("sodium_chloride", 0.10, 1070.7, 1.193),
        ("sodium_chloride", 0.20, 1147.8, 1.557),
        ("sodium_chloride", 0.26, 1197.2, None),
        ("calcium_chloride", 0.10, 1083.5, None),
        ("calcium_chloride", 0.20, 1177.5, None),
        ("calcium_chloride", 0.30, 1281.6, None),
        ("calcium_chloride", 0.40, 1395.7, None),
    ):
        law = BrineLaw(salt, share)
        assert law.density(20.0) == pytest.approx(density, rel=2e-3)  # the worst is the strongest one
        if milli is not None:
            assert law.viscosity(20.0) == pytest.approx(milli * 1e-3, rel=0.01)
    for molality in (1.0, 3.0, 5.5):
        share = molality * 58.443 / (1000.0 + molality * 58.443)
        for celsius in (20.0, 40.0, 60.0, 90.0):
            a = 0.03324 * molality + 0.003624 * molality**2 - 1.879e-4 * molality**3
            b = -0.0396 * molality + 0.0102 * molality**2 - 7.02e-4 * molality**3
            more = a + b * math.log10(water_viscosity(celsius) / 1.002e-3)
            other = water_viscosity(celsius) * 10.0**more
            # Both are good to a per cent or so of the measurements that they are fitted to.
            assert BrineLaw("sodium_chloride", share).viscosity(celsius) == pytest.approx(other, rel=0.025)


def test_calcium_chloride_when_warmer() -> None:
    """3.5 mol/kg with 0.5 mol/kg of potassium chloride, which changes the viscosity by some per cent.

    Measured at 30 and 40 C: 2.476 and 2.033 mPa s (Scientific Reports 10, 16312, 2020).
    """
    share = 3.5 * 110.98 / (1000.0 + 3.5 * 110.98)
    law = BrineLaw("calcium_chloride", share)
    assert law.viscosity(30.0) == pytest.approx(2.476e-3, rel=0.06)
    assert law.viscosity(40.0) / law.viscosity(30.0) == pytest.approx(2.033 / 2.476, rel=0.02)


def test_brine_without_salt_is_water() -> None:
    for salt in SALTS:
        plain = brine(salt, 0.0)
        assert plain.density == pytest.approx(998.2, rel=1e-4)
        assert plain.viscosity == pytest.approx(1.004e-6, rel=2e-3)
    with pytest.raises(InputError, match="mass_fraction"):
        brine("sodium_chloride", 0.27)
    with pytest.raises(InputError, match="salt"):
        brine("salt", 0.1)


@kills("fluid.liquid:silicone_law", "-SILICONE_SLOPE / _GRADED", "SILICONE_SLOPE / _GRADED")
def test_silicone_oils() -> None:
    """Sold by their viscosity at 25 C; makers give 1 - nu(99 C)/nu(38 C) = 0.60 to 0.62 from 100 mm^2/s."""
    assert silicone_law(1e-4, 965.0).viscosity.at(CELSIUS + 25.0) == pytest.approx(1e-4, rel=1e-12)
    for grade in (100, 200, 350, 500, 1000):
        oil = known_liquid(f"silicone_oil_{grade}")
        assert liquid_at(oil, CELSIUS + 25.0).viscosity == pytest.approx(grade * 1e-6, rel=1e-12)
        cold, warm = (liquid_at(oil, CELSIUS + celsius).viscosity for celsius in (37.8, 98.9))
        assert 0.595 < 1.0 - warm / cold < 0.625
        assert liquid_at(oil, CELSIUS + 25.0).density == pytest.approx(970.0, rel=6e-3)


# -- laws that a user gives ------------------------------------------------------------------------------


def _table(step: float, first: float = 275.0, last: float = 355.0) -> Tabulated:
    count = round((last - first) / step) + 1
    kelvins = tuple(first + step * k for k in range(count))
    return Tabulated(kelvins, tuple(water_viscosity(kelvin - CELSIUS) for kelvin in kelvins))


@kills("fluid.temperature:Tabulated.at", "np.log(self.values)", "np.sqrt(self.values)")
def test_a_table_is_its_points_and_third_order_between() -> None:
    """The viscosity of water sampled: halving the step leaves an eighth of the error away from the ends."""
    errors = []
    for step in (8.0, 4.0, 2.0):
        table = _table(step)
        assert all(table.at(k) == v for k, v in zip(table.temperatures, table.values, strict=True))
        places = [300.0 + 0.1 * k for k in range(321)]
        exact = [water_viscosity(kelvin - CELSIUS) for kelvin in places]
        errors.append(max(abs(table.at(k) / x - 1.0) for k, x in zip(places, exact, strict=True)))
    orders = [math.log2(first / second) for first, second in itertools.pairwise(errors)]
    assert min(orders) > 2.8
    assert errors[-1] < 1e-5


def test_a_table_of_a_known_liquid_is_that_liquid() -> None:
    """To the error of the interpolation: sampled each 5 K, a few parts in ten thousand near the ends."""
    water = known_liquid("water")
    kelvins = tuple(275.0 + 5.0 * k for k in range(17))
    held = [liquid_at(water, kelvin) for kelvin in kelvins]
    density, viscosity = ([getattr(liquid, name) for liquid in held] for name in ("density", "viscosity"))
    law = GivenLaw(Tabulated(kelvins, tuple(density)), Tabulated(kelvins, tuple(viscosity)))
    own = Liquid("sampled", law.density.at(REFERENCE), law.viscosity.at(REFERENCE), law)
    for kelvin in (276.3, 283.15, 301.7, 333.15, 353.9):
        found, exact = liquid_at(own, kelvin), liquid_at(water, kelvin)
        # A largest value is cut flat: h^2/8 times the curvature, 1.6e-5 1/K^2 at 4 C.
        assert found.density == pytest.approx(exact.density, rel=5e-5)
        assert found.viscosity == pytest.approx(exact.viscosity, rel=5e-4)
        assert expansion(own, kelvin) == pytest.approx(expansion(water, kelvin), rel=1e-4)


@given(st.lists(st.floats(1e-7, 1e-2), min_size=2, max_size=6), st.floats(0.0, 1.0))
def test_a_table_never_leaves_its_neighbours(values: list[float], share: float) -> None:
    kelvins = tuple(280.0 + 10.0 * k for k in range(len(values)))
    table = Tabulated(kelvins, tuple(values))
    kelvin = kelvins[0] + share * (kelvins[-1] - kelvins[0])
    k = min(int((kelvin - kelvins[0]) / 10.0), len(values) - 2)
    low, high = sorted(values[k : k + 2])
    assert low * (1.0 - 1e-9) <= table.at(kelvin) <= high * (1.0 + 1e-9)


@kills("fluid.temperature:Expansion._volume", "1.0 + self.expansion", "1.0 - self.expansion")
@kills("fluid.temperature:Walther.at", "+ _WALTHER)) for value", "- _WALTHER)) for value")
@kills("fluid.temperature:Vogel.at", "(temperature - self.c)", "temperature")
def test_named_laws() -> None:
    """From their definitions, and an oil of ISO VG 32 with 5.4 mm^2/s at 100 C: 8.5 at 80 C [ASTM17]."""
    oil = Walther((313.15, 373.15), (32e-6, 5.4e-6), 263.15, 373.15)
    assert oil.at(353.15) == pytest.approx(8.5e-6, rel=5e-3)  # given with two digits
    for kelvin, value in zip(oil.temperatures, oil.values, strict=True):
        assert oil.at(kelvin) == pytest.approx(value, rel=1e-12)
    # ln ln (nu + 0.7) is straight over ln T: three points in geometric order.
    heights = [
        math.log(math.log(oil.at(k) * 1e6 + 0.7)) for k in (280.0, 315.0, 280.0 * (315.0 / 280.0) ** 2)
    ]
    assert heights[2] - heights[1] == pytest.approx(heights[1] - heights[0], rel=1e-10)
    law = Vogel(a=2e-7, b=900.0, c=140.0, lowest=270.0, highest=370.0)
    assert law.at(320.0) == pytest.approx(2e-7 * math.exp(5.0), rel=1e-14)
    dense = Expansion(900.0, 300.0, 8e-4, 270.0, 370.0)
    assert dense.at(300.0) == 900.0
    assert dense.at(350.0) * 1.04 == pytest.approx(900.0, rel=1e-14)


def test_laws_with_wrong_numbers_are_refused() -> None:
    for make, field in (
        (lambda: Tabulated((300.0, 290.0), (1.0, 2.0)), "temperatures"),
        (lambda: Tabulated((300.0,), (1.0,)), "temperatures"),
        (lambda: Tabulated((290.0, math.nan), (1.0, 2.0)), "temperatures"),
        (lambda: Tabulated((290.0, 300.0), (1.0, 2.0, 3.0)), "values"),
        (lambda: Tabulated((290.0, 300.0), (1.0, 0.0)), "values"),
        (lambda: Tabulated((290.0, 300.0), (1.0, math.inf)), "values"),
        (lambda: Expansion(900.0, 300.0, -0.02, 290.0, 360.0), "expansion"),
        (lambda: Expansion(900.0, 300.0, 7e-4, 360.0, 290.0), "range"),
        (lambda: Walther((313.0, 373.0), (3e-6, 32e-6), 280.0, 373.0), "values"),
        (lambda: Walther((313.0, 373.0), (3e-6, 1e-6), 280.0, 373.0), "values"),
        (lambda: Walther((313.0, 373.0), (32e-6, 2.1e-6), 280.0, 420.0), "range"),
        (lambda: Walther((373.0, 313.0), (32e-6, 5e-6), 280.0, 373.0), "temperatures"),
        (lambda: Vogel(1e-6, 300.0, 290.0, 280.0, 370.0), "c"),
        (lambda: Vogel(1e-6, 1e5, 279.0, 280.0, 370.0), "b"),
        (lambda: GivenLaw(Expansion(9e2, 3e2, 1e-4, 280.0, 290.0), Constant(1e-6), 300.0), "temperature"),
        (
            lambda: GivenLaw(Expansion(9e2, 3e2, 1e-4, 280.0, 290.0), Vogel(1e-6, 9.0, 0.0, 291.0, 299.0)),
            "range",
        ),
    ):
        with pytest.raises(InputError, match=field):
            make()
