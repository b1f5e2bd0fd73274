"""Liquids of a scene over temperature: tables and laws as a file writes them."""

from __future__ import annotations

import pickle
import tomllib
from typing import Any

import pytest

from fluid.liquid import Liquid, brine, liquid_at
from fluid.temperature import Expansion, GivenLaw, Tabulated, Vogel, Walther
from leblanc.scene.examples import example
from leblanc.scene.inputs import input_rows
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError

OIL = """
name = "oil VG 46"

[density]
value = "870 kg/m^3"
temperature = "15 degC"
expansion = "7e-4 1/K"
range = ["-5 degC", "90 degC"]

[viscosity]
law = "walther"
temperatures = ["40 degC", "100 degC"]
values = ["46 mm^2/s", "6.8 mm^2/s"]
range = ["-5 degC", "100 degC"]
"""
TABLE = """
temperature = "40 degC"
density = { temperatures = ["0 degC", "40 degC", "80 degC"], values = ["0.9 g/cm^3", "870 kg/m^3", 840] }
viscosity = { temperatures = ["10 degC", "30 degC", "70 degC"], values = ["90 cSt", "40 cSt", "12 cSt"] }
"""
VOGEL = 'density = 900\nviscosity = { law = "vogel", a = 5e-8, b = 900, c = 150, range = [270, 370] }'
ANDRADE = (
    'density = 900\nviscosity = { law = "andrade", a = 1e-9, b = "2000 K", range = ["0 degC", "90 degC"] }'
)
BRINE = 'salt = "calcium_chloride"\nmass_fraction = 0.25'


def scene(text: str) -> Scene:
    return example("horizontal_rig").replace({"chambers.0.liquid": tomllib.loads(text)})


def liquid(text: str) -> Liquid:
    return scene(text).fills[0].liquid


def test_what_a_file_says_is_what_the_liquid_is() -> None:
    law = GivenLaw(
        Expansion(870.0, 288.15, 7e-4, 268.15, 363.15),
        Walther((313.15, 373.15), (46e-6, 6.8e-6), 268.15, 373.15),
    )
    oil = liquid(OIL)
    assert oil == Liquid("oil VG 46", law.density.at(293.15), law.viscosity.at(293.15), law)
    assert liquid_at(oil, 313.15).viscosity == pytest.approx(46e-6, rel=1e-12)
    held = liquid(TABLE)
    assert held.law == GivenLaw(
        Tabulated((273.15, 313.15, 353.15), (900.0, 870.0, 840.0)),
        Tabulated((283.15, 303.15, 343.15), (90e-6, 40e-6, 12e-6)),
        313.15,
    )
    assert held.density == 870.0  # at the temperature of the scene's values
    vogel, andrade = liquid(VOGEL).law, liquid(ANDRADE).law
    assert isinstance(vogel, GivenLaw) and vogel.viscosity == Vogel(5e-8, 900.0, 150.0, 270.0, 370.0)
    assert isinstance(andrade, GivenLaw) and andrade.viscosity == Vogel(1e-9, 2000.0, 0.0, 273.15, 363.15)
    assert liquid(BRINE) == brine("calcium_chloride", 0.25)
    plain = liquid('name = "tea"\ndensity = 1000\nviscosity = 1e-6')
    assert plain == Liquid("tea", 1000.0, 1e-6)


@pytest.mark.parametrize("text", [OIL, TABLE, VOGEL, ANDRADE, BRINE])
def test_written_again_it_is_the_same(text: str) -> None:
    given = scene(text)
    again = scene_from_table(given.table())
    assert again == given and again.digest == given.digest
    sent = pickle.loads(pickle.dumps(given))  # to another process
    assert sent == given and hash(sent.fills[0].liquid) == hash(given.fills[0].liquid)
    assert any(path == "chambers.0.liquid" for _, _, path in input_rows(given))


def test_laws_with_the_same_numbers_are_told_apart() -> None:
    """Two scenes with the same values at 20 degrees have digests of their own."""
    at = liquid(ANDRADE)
    plain = scene(f"density = {at.density!r}\nviscosity = {at.viscosity!r}")
    assert len({scene(ANDRADE).digest, plain.digest, scene(OIL).digest, scene(TABLE).digest}) == 4
    other = ANDRADE.replace("2000 K", "2001 K")
    assert scene(other).digest != scene(ANDRADE).digest


def test_units_do_not_matter() -> None:
    """Kelvin or degrees, mm^2/s or SI, per cent or 1/K: the same liquid at every temperature."""
    written = (
        OIL.replace('"15 degC"', "288.15").replace('"7e-4 1/K"', '"0.07 %/K"').replace('"870 kg/m^3"', "870")
    )
    written = written.replace('["46 mm^2/s", "6.8 mm^2/s"]', '["46e-6 m^2/s", "6.8 cSt"]')
    written = written.replace('["40 degC", "100 degC"]', "[313.15, 373.15]")
    first, other = liquid(OIL), liquid(written)
    for kelvin in (268.15, 293.15, 341.0):
        one, two = liquid_at(first, kelvin), liquid_at(other, kelvin)
        assert two.density == pytest.approx(one.density, rel=1e-14)
        assert two.viscosity == pytest.approx(one.viscosity, rel=1e-12)
    assert scene(OIL).digest == scene(written).digest


def test_a_value_inside_a_law_is_replaced() -> None:
    found = scene(OIL).replace({"chambers.0.liquid.density.expansion": 8e-4}).fills[0].liquid
    assert found.density == pytest.approx(870.0 / (1.0 + 5 * 8e-4), rel=1e-14)


_RANGES: list[tuple[str, str, str]] = [
    (
        "density = { temperatures = [300, 290], values = [1000, 999] }",
        "density.temperatures",
        "above the one",
    ),
    ("density = { temperatures = [290, 300], values = [1000] }", "density.values", "densities"),
    ("density = { temperatures = [290, 300, 310], values = [1000, 990] }", "density.values", "3 values"),
    ("density = { temperatures = [290, nan], values = [1000, 990] }", "density.temperatures.1", "finite"),
    ("density = { values = [1000, 990] }", "density.temperatures", "given with a table"),
    ("density = { value = 1000, expansion = 1e-4 }", "density.temperature", "given with an expansion"),
    ("density = {}", "density.value", "given with an expansion"),
    (
        "density = { temperatures = [290, 300], values = [1000, 990], value = 1000 }",
        "density.value",
        "left out with a table",
    ),
    (
        "density = { value = 900, temperature = 300, expansion = -0.05, range = [290, 340] }",
        "density.expansion",
        "above 0",
    ),
    ("viscosity = { law = 'vogle' }", "viscosity.law", "did you mean vogel"),
    (
        "viscosity = { law = 'vogel', a = 1e-6, b = 300, range = [280, 300] }",
        "viscosity.c",
        "given with the law",
    ),
    (
        "viscosity = { law = 'andrade', a = 1e-6, b = 300, c = 100, range = [280, 300] }",
        "viscosity.c",
        "left out with the law",
    ),
    (
        "viscosity = { law = 'vogel', a = 1e-6, b = '300 degC', c = 100, range = [280, 300] }",
        "viscosity.b",
        "difference of temperatures",
    ),
    (
        "viscosity = { temperatures = [280, 300], values = ['1 mPa*s', '2 mm^2/s'] }",
        "viscosity.values.0",
        "something else",
    ),
    (
        "viscosity = { temperatures = [310, 330], values = [2e-6, 1e-6] }",
        "temperature",
        "do not hold at 20 degC",
    ),
    (
        "viscosity = { temperatures = [300, 310], values = [2e-6, 1e-6] }\ntemperature = 320",
        "temperature",
        "310 K",
    ),
    ("salt = 'sodium_chloride'", "mass_fraction", "given"),
    ("salt = 'sodium_chlorid'\nmass_fraction = 0.1", "salt", "did you mean sodium_chloride"),
    ("salt = 'sodium_chloride'\nmass_fraction = 0.4", "mass_fraction", "0.26"),
    ("salt = 'sodium_chloride'\nmass_fraction = 0.2\ndensity = 1100", "density", "left out"),
]


@pytest.mark.parametrize(("text", "field", "said"), _RANGES)
def test_what_is_wrong_with_a_liquid_is_named(text: str, field: str, said: str) -> None:
    table: dict[str, Any] = tomllib.loads(text)
    if "salt" not in table:
        table = {"density": 1000, "viscosity": 1e-6} | table
    with pytest.raises(SceneError) as caught:
        example("horizontal_rig").replace({"chambers.0.liquid": table})
    faults = [fault for fault in caught.value.faults if fault.field == f"chambers.0.liquid.{field}"]
    assert faults and said in faults[0].allowed, caught.value
