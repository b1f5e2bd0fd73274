"""Units at the border against factors known by definition."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leblanc.core import units
from leblanc.core.units import Dimension, parse, parse_option
from meshes.errors import InputError
from tests.mutants import kills

TURN = 2.0 * math.pi
INCH, POUND = 0.0254, 0.45359237  # m and kg, exact by definition

# SI value of one of each unit, by definition, not by pint.
FACTORS: dict[Dimension, dict[str, float]] = {
    units.NUMBER: {"": 1.0, "%": 1e-2, "percent": 1e-2},
    units.LENGTH: {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "um": 1e-6, "in": INCH, "ft": 12 * INCH},
    units.VOLUME: {"m^3": 1.0, "l": 1e-3, "L": 1e-3, "ml": 1e-6, "mL": 1e-6, "cm^3": 1e-6, "mm³": 1e-9},
    units.MASS: {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": POUND},
    units.DENSITY: {"kg/m^3": 1.0, "g/cm^3": 1e3, "kg/l": 1e3, "g/ml": 1e3, "kg m^-3": 1.0},
    units.VISCOSITY: {"m^2/s": 1.0, "mm^2/s": 1e-6, "cSt": 1e-6, "St": 1e-4, "mm²/s": 1e-6},
    units.STIFFNESS: {"N/m": 1.0, "N/mm": 1e3, "kN/m": 1e3, "kg/s^2": 1.0},
    units.DAMPING: {"N*s/m": 1.0, "N s/m": 1.0, "N/(m/s)": 1.0, "kg/s": 1.0, "N·s/mm": 1e3},
    units.UNBALANCE: {"kg*m": 1.0, "kg*mm": 1e-3, "g*mm": 1e-6, "g mm": 1e-6, "kg·m": 1.0},
    units.TIME: {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0},
    units.RATE: {"1/s": 1.0, "/s": 1.0, "s^-1": 1.0, "1/min": 1 / 60, "s**-1": 1.0},
    units.ACCELERATION: {"m/s^2": 1.0, "m/s**2": 1.0, "mm/s^2": 1e-3, "m s^-2": 1.0},
    units.ANGULAR_SPEED: {
        "rad/s": 1.0,
        "1/s": 1.0,
        "rpm": TURN / 60,
        "RPM": TURN / 60,
        "r/min": TURN / 60,
        "rev/min": TURN / 60,
        "U/min": TURN / 60,
        "turn/min": TURN / 60,
        "Hz": TURN,
        "hertz": TURN,
        "kHz": 1e3 * TURN,
        "deg/s": TURN / 360,
    },
    units.ANGULAR_ACCELERATION: {"rad/s^2": 1.0, "1/s^2": 1.0, "rpm/s": TURN / 60, "Hz/s": TURN},
}
SPELLINGS = [(dimension, unit) for dimension, table in FACTORS.items() for unit in table]


@pytest.mark.parametrize(("dimension", "unit"), SPELLINGS, ids=lambda it: getattr(it, "name", it))
def test_one_of_each_unit_is_what_its_definition_says(dimension: Dimension, unit: str) -> None:
    # a product of a few factors, each rounded once: a few parts in 1e16
    assert parse(f"1 {unit}", dimension) == pytest.approx(FACTORS[dimension][unit], rel=1e-15, abs=0.0)


@settings(max_examples=200)
@given(
    st.sampled_from(SPELLINGS), st.floats(-1e9, 1e9), st.sampled_from(["{!r} {}", "{!r}{}", " {:.17e}  {} "])
)
def test_any_number_with_any_unit(spelling: tuple[Dimension, str], number: float, form: str) -> None:
    dimension, unit = spelling
    if unit.startswith("1"):
        form = "{!r} {}"  # a digit must not run into the number
    expected = number * FACTORS[dimension][unit]
    # as above; below 1e-300 the product may lose digits to underflow
    assert parse(form.format(number, unit), dimension) == pytest.approx(expected, rel=1e-15, abs=1e-300)


@given(st.floats(-1e50, 1e50), st.sampled_from(list(FACTORS)))
def test_a_plain_number_is_si(number: float, dimension: Dimension) -> None:
    assert parse(number, dimension) == number
    assert parse_option(repr(number), dimension, "x") == number


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("65 mm", units.LENGTH, 0.065),
        ("10 ml", units.VOLUME, 1e-05),
        ("0.45 l", units.VOLUME, 0.00045),
        ("0.6 kg*mm", units.UNBALANCE, 0.0006),
        ("600 g*mm", units.UNBALANCE, 0.0006),
        ("7 cm", units.LENGTH, 0.07),
        ("1.2 g/cm^3", units.DENSITY, 1200.0),
    ],
)
def test_decimal_units_round_once(text: str, dimension: Dimension, value: float) -> None:
    assert parse(text, dimension) == value


@pytest.mark.parametrize(
    ("value", "dimension"),
    [
        ("4", units.MASS),
        ("4 N", units.MASS),
        ("4 kgg", units.MASS),
        ("4 KG", units.MASS),
        ("kg", units.MASS),
        ("", units.MASS),
        ("four kg", units.MASS),
        ("4,5 kg", units.MASS),
        ("4 kg + 1 kg", units.MASS),
        ("4 2 kg", units.MASS),
        ("4 kg)", units.MASS),
        ("4 kg**0.5", units.MASS),
        ("4 kg kg", units.MASS),
        ("4 kg*dB", units.MASS),
        ("4 kg*m*rad", units.UNBALANCE),
        ("nan kg", units.MASS),
        ("inf kg", units.MASS),
        ("1e400 kg", units.MASS),
        ("9**9**9", units.MASS),
        ("9**9**9 kg", units.MASS),
        ("1 kg**9**9", units.MASS),
        ("1 " + "(" * 30 + "kg" + ")" * 30, units.MASS),
        ("1 " + "kg " * 1000, units.MASS),
        ("1" * 1000 + " kg", units.MASS),
        ("1 __import__('os')", units.MASS),
        ("1 Qm^9/(qm^9*m^9)", units.RATE),
        ("10 dB", units.NUMBER),
        ("10 degC", units.NUMBER),
        ("1 rad", units.NUMBER),
        ("0.5 Hz", units.RATE),  # a rotation, not a rate of decay
        ("0.5 rpm", units.RATE),
        ("100 1/min", units.ANGULAR_SPEED),  # turns on a nameplate, radians by the rule of 1/s
        ("100 min^-1", units.ANGULAR_SPEED),
        ("100 1/min^2", units.ANGULAR_ACCELERATION),
        ("100 U/min", units.RATE),
        ("100 Bq", units.ANGULAR_SPEED),  # a count is no angle
        ("100 cps", units.ANGULAR_SPEED),
        ("100 Hz^2", units.ANGULAR_ACCELERATION),
        (math.nan, units.MASS),
        (-math.inf, units.MASS),
        (10**400, units.MASS),
        (True, units.MASS),
        (None, units.MASS),
        ([4.0], units.MASS),
        (4j, units.MASS),
    ],
    ids=lambda value: getattr(value, "name", repr(value)[:40]),
)
def test_what_is_no_such_quantity_is_refused(value: object, dimension: Dimension) -> None:
    with pytest.raises(InputError) as caught:
        parse(value, dimension, "rotor.mass")
    assert caught.value.field == "rotor.mass"
    assert dimension.name in caught.value.allowed
    assert dimension.example in caught.value.allowed


def test_a_wrong_unit_is_named() -> None:
    with pytest.raises(InputError, match="there is no unit rmp"):
        parse("1000 rmp", units.ANGULAR_SPEED)
    with pytest.raises(InputError, match="there is no unit Kg, but kg"):
        parse("4 Kg", units.MASS)
    for text, said in (
        ("4,5 kg", 'the decimal sign is a point, as in "4.5 kg"'),
        ("1,200 kg", 'as in "1.200 kg", and thousands have no sign: "1200 kg"'),
        ("4,5 l", "the decimal sign is a point$"),
    ):
        with pytest.raises(InputError, match=said):
            parse(text, units.MASS)
    for text in ("84 N.s/m", "84 N-s/m"):
        with pytest.raises(InputError, match=r'it may be written "84 N\*s/m"'):
            parse(text, units.DAMPING)
    with pytest.raises(InputError, match=r"N\*s/m measures something else"):
        parse("84 Ns/m", units.STIFFNESS)  # no plural of newton
    with pytest.raises(InputError, match="1/min may mean turns or radians"):
        parse("1000 1/min", units.ANGULAR_SPEED)
    with pytest.raises(InputError, match="N/m measures something else"):
        parse("4 N/m", units.MASS)
    with pytest.raises(InputError, match="has no unit"):
        parse("4", units.MASS)


@settings(max_examples=200)
@given(
    st.one_of(
        st.text(max_size=80),
        st.lists(
            st.sampled_from(
                ["4", "kg", "mm", "s", "Hz", "%", " ", "*", "/", "^2", "**-1", "(", ")", "dB", "in"]
            )
        )
        .map("".join)
        .map("3 {}".format),
    ),
    st.sampled_from(list(FACTORS)),
)
def test_any_text_is_a_finite_number_or_refused(text: str, dimension: Dimension) -> None:
    for read in (parse, parse_option):
        try:
            value = read(text, dimension, "x")
        except InputError:
            continue
        assert math.isfinite(value)


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "1e400", "heavy", "4 N"])
def test_options_are_refused_like_values(text: str) -> None:
    with pytest.raises(InputError):
        parse_option(text, units.MASS, "mass")


def test_options_take_units_too() -> None:
    assert (
        parse_option("65 mm", units.LENGTH, "radius")
        == parse_option("0.065", units.LENGTH, "radius")
        == 0.065
    )


def test_plain_numbers_need_no_unit_library() -> None:
    code = """if True:
        import sys
        from leblanc.core import units
        units.parse(0.1, units.MASS)
        units.parse_option("0.1", units.MASS, "mass")
        sys.exit("pint" in sys.modules)
    """
    root = Path(units.__file__).parents[2]
    assert subprocess.run([sys.executable, "-c", code], cwd=root, check=False).returncode == 0


COMMON = [(dimension, unit) for dimension, table in units._COMMON.items() for unit in table]


@pytest.mark.parametrize(("dimension", "unit"), COMMON, ids=lambda it: getattr(it, "name", it))
@settings(max_examples=20)
@given(number=st.floats(-1e12, 1e12))
def test_common_units_are_those_of_the_library(dimension: Dimension, unit: str, number: float) -> None:
    """Bit for bit, so that no scene changes its digest."""
    factor = units._factor(unit, dimension)
    assert isinstance(factor, float)
    assert units._scaled(number, units._COMMON[dimension][unit]) == units._scaled(number, factor)


@given(st.sampled_from(sorted(units._OFFSETS)), st.floats(-1e6, 1e6))
def test_common_temperatures_are_those_of_the_library(unit: str, number: float) -> None:
    registry = units._registry()
    by_library = registry.Quantity(number, registry.parse_units(unit)).to("kelvin").magnitude
    assert units.parse(f"{number!r} {unit}", units.TEMPERATURE) == by_library


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("84 N s/m", units.DAMPING, 84.0),
        ("84 N * s / m", units.DAMPING, 84.0),
        ("9.8 m/s**2", units.ACCELERATION, 9.8),
        ("3 cm ³", units.VOLUME, 3e-6),
        ("600 g·mm", units.UNBALANCE, 6e-4),
        ("998 kg/m3", units.DENSITY, 998.0),
        ("1.5e-6 m2/s", units.VISCOSITY, 1.5e-6),
        ("1e3 mm", units.LENGTH, 1.0),
        ("10 cm3", units.VOLUME, 1e-5),
        ("84 Ns/m", units.DAMPING, 84.0),
        ("20 Nmm", units.TORQUE, 0.02),
        ("3 kgm2", units.INERTIA, 3.0),
        ("120 gmm", units.UNBALANCE, 1.2e-4),
        ("3.5 mPas", units.DYNAMIC_VISCOSITY, 3.5e-3),
        ("5 Nms/rad", units.ANGULAR_DAMPING, 5.0),
        ("400 g × 230 mm", units.UNBALANCE, 0.092),  # noqa: RUF001
    ],
)
def test_common_units_in_any_spelling(text: str, dimension: Dimension, value: float) -> None:
    assert parse(text, dimension) == value


@kills("leblanc.core.units:_parted", 'endswith("/")', 'endswith("*")')
@kills("leblanc.core.units:_matched", "float(two[1]) * float(two[3])", "float(two[1])")
def test_products_as_they_are_typed() -> None:
    """Factors behind a stroke are below it; two quantities with a sign between them are multiplied."""
    assert parse("1e-8 mm3/Nm", units.WEAR) == parse("1e-8 mm^3/(N*m)", units.WEAR)
    assert parse("400 g * 230 mm", units.UNBALANCE) == parse("0.092 kg m", units.UNBALANCE)


def test_usual_scenes_need_no_unit_library() -> None:
    code = """if True:
        import sys
        from leblanc.scene.examples import example, example_names
        for name in example_names():
            name.startswith("studies/") or example(name)
        sys.exit("pint" in sys.modules)
    """
    root = Path(units.__file__).parents[2]
    assert subprocess.run([sys.executable, "-c", code], cwd=root, check=False).returncode == 0
