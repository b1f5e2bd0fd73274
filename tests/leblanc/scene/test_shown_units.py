"""Values for print are in units that a person would write, and read back as what they were."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from leblanc import units
from leblanc.units import (
    ANGULAR_SPEED,
    LENGTH,
    MASS,
    MINUS,
    TIME,
    UNBALANCE,
    VOLUME,
    Dimension,
    allowed_as_typed,
    celsius,
    in_rpm,
    parse,
    rpm_range,
    unit_for,
    with_unit,
)

# The bounds of what a scene may say, in SI.
BOUNDS = {
    LENGTH: (1e-9, 1e3),
    MASS: (1e-9, 1e9),
    VOLUME: (1e-12, 1e9),
    UNBALANCE: (1e-12, 1e9),
    TIME: (1e-7, 1e5),
    ANGULAR_SPEED: (1e-3, 1e6),
}


@given(st.sampled_from(list(BOUNDS)), st.floats(0.0, 1.0), st.booleans())
def test_a_value_reads_back_to_four_digits(dimension: Dimension, share: float, negative: bool) -> None:
    """The text is input as well: the number, four digits of it, with a unit that `parse` knows."""
    low, high = BOUNDS[dimension]
    value = low * (high / low) ** share * (-1.0 if negative else 1.0)
    text = with_unit(value, dimension).replace(MINUS, "-")
    # Half a unit of the fourth digit.
    assert math.isclose(parse(text, dimension), value, rel_tol=5.001e-4), text


@given(st.sampled_from(list(BOUNDS)), st.floats(0.3, 0.75))
def test_no_power_of_ten_where_machines_are_built(dimension: Dimension, share: float) -> None:
    """Neither 1e+04 rpm nor 0.005636 mm nor 115000 g mm: no power of ten, one zero behind the point."""
    low, high = {
        LENGTH: (1e-7, 1e2), MASS: (1e-6, 1e5), VOLUME: (1e-9, 1e2), UNBALANCE: (1e-9, 1e3),
        TIME: (1e-5, 1e3),
        ANGULAR_SPEED: (0.1, 1e5),
    }[dimension]  # fmt: skip
    text = with_unit(low * (high / low) ** share, dimension)
    assert re.fullmatch(r"(0\.0?[1-9]\d{0,3}|[1-9]\d{0,5}(\.\d+)?) [a-z^3 ]+", text), text


@pytest.mark.parametrize(
    ("value", "dimension", "text"),
    [
        (5.636e-6, LENGTH, "5.636 um"),
        (0.1794e-3, LENGTH, "0.1794 mm"),
        (0.065, LENGTH, "65 mm"),
        (0.0, LENGTH, "0 mm"),
        (9.9999999e-5, LENGTH, "0.1 mm"),
        (250.0, LENGTH, "250 m"),
        (0.115, UNBALANCE, "115 kg mm"),
        (6e-4, UNBALANCE, "600 g mm"),
        (1e-5, VOLUME, "10 ml"),
        (1.2e-3, VOLUME, "1200 ml"),
        (0.02, VOLUME, "20 l"),
        (3.8, MASS, "3.8 kg"),
        (0.31, MASS, "310 g"),
        (1e4 / units.RPM, ANGULAR_SPEED, "10000 rpm"),
        (3e5 / units.RPM, ANGULAR_SPEED, "300000 rpm"),
        (math.inf, LENGTH, "infinite"),
        (math.nan, MASS, "not found"),
    ],
)
def test_units_a_person_would_write(value: float, dimension: Dimension, text: str) -> None:
    assert with_unit(value, dimension) == text


def test_values_side_by_side_share_a_unit() -> None:
    assert unit_for(LENGTH, 3e-6, 7e-3, math.nan).name == "mm"
    assert unit_for(LENGTH, math.nan, math.inf).name == "mm"
    assert rpm_range(1.0 / units.RPM, 12345.0 / units.RPM) == "1 to 12345 rpm"
    assert in_rpm(math.nan, "none") == "none"


def test_a_temperature_is_in_degrees() -> None:
    """20 degC is 293.15 K, whose difference from 273.15 has rounding in its last digits."""
    assert [celsius(parse(f"{degrees} degC", units.TEMPERATURE)) for degrees in (20, 5.5, 0)] == [
        "20 degC",
        "5.5 degC",
        "0 degC",
    ]


@pytest.mark.parametrize(
    ("allowed", "typed", "said"),
    [
        ("from 1e-06 to 1000 m", "300 mm", "from 0.001 to 1000000 mm"),
        ("at most what it holds, 0.000259181 m^3", "2 l", "at most what it holds, 0.259181 l"),
        ("at least speeds.start, 10.472 rad/s", "50 rpm", "at least speeds.start, 100 rpm"),
        ("from 150 to 1000 K", ["20 degC", "2000 degC"], "from -123.15 to 726.85 degC"),
        ("at most twice it, 0.02 kg*m^2", "1 kg*m^2", "at most twice it, 0.02 kg*m^2"),
        ("at most twice it, 0.02 kg*m^2", "300000 kg*mm^2", "at most twice it, 20000 kg*mm^2"),
        # nothing typed, no unit, a unit of something else, an example in quotes
        ("below 0.065 m", 0.3, "below 0.065 m"),
        ("below 0.065 m", "0.3", "below 0.065 m"),
        ("below 0.065 m", "3 kg", "below 0.065 m"),
        ('such as "4 kg" (a plain number is in kg)', "4 g", 'such as "4 kg" (a plain number is in kg)'),
    ],
)
def test_bounds_in_the_unit_typed(allowed: str, typed: object, said: str) -> None:
    assert allowed_as_typed(allowed, typed) == said
