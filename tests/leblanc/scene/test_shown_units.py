"""Values for print are in units that a person would write, and read back as what they were."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Annotated, Any, get_args, get_origin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from leblanc.core import units
from leblanc.core.units import (
    ANGULAR_SPEED,
    LENGTH,
    MASS,
    MINUS,
    STIFFNESS,
    TIME,
    UNBALANCE,
    VOLUME,
    Dimension,
    allowed_as_typed,
    celsius,
    in_rpm,
    over_rpm,
    parse,
    rpm_range,
    unit_for,
    unit_typed,
    with_unit,
    written_out,
)
from leblanc.liquid.choice import seconds_words
from leblanc.scene.scene import Scene
from leblanc.scene.schema.part import Part, allowed_at, parts_of, rule_of
from leblanc.scene.schema.rules import Quantity
from leblanc.studies.sweep.plan import Study

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
    # One speed is one number, and speeds that print alike are one.
    assert rpm_range(44.307, 44.307) == rpm_range(44.307, 44.3071) == "423.1 rpm"
    assert over_rpm(44.307, 44.307) == over_rpm(44.307, 44.3071, "between", "and") == "at 423.1 rpm"
    assert over_rpm(1.0 / units.RPM, 2.0 / units.RPM) == "from 1 to 2 rpm"
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


def _parts(root: type[Part]) -> dict[str, type[Part]]:
    """A table and all tables within it, by name."""
    found = {root.__name__: root}
    for field in root.model_fields.values():
        for part in parts_of(field).values():
            found |= {} if part.__name__ in found else _parts(part)
    return found


PARTS = _parts(Scene) | _parts(Study)


def _quantities(thing: Any) -> Iterator[Quantity]:
    """Rules with bounds, in a rule or an annotation."""
    if isinstance(thing, Quantity):
        yield thing
    elif get_origin(thing) is Annotated:
        for part in get_args(thing):
            yield from _quantities(getattr(part, "func", part))
    else:
        inside = [] if isinstance(thing, type) else getattr(thing, "__dict__", {}).values()
        for part in (*get_args(thing), *inside):
            yield from _quantities(part)


BOUNDED = sorted(
    {
        quantity
        for part in PARTS.values()
        for field in part.model_fields.values()
        for thing in (rule_of(field), field.annotation)
        for quantity in _quantities(thing)
    },
    key=lambda quantity: (quantity.dimension.name, quantity.low, quantity.high),
)
POWER = re.compile(r"\d[eE][+-]?\d")


def test_every_bounded_field_is_looked_at() -> None:
    assert {"Scene", "JeffcottRotor", "TubRotor", "Baffles", "Optimisation", "Study"} <= PARTS.keys()
    kinds = {quantity.dimension for quantity in BOUNDED}
    assert {UNBALANCE, units.STIFFNESS, units.INERTIA, units.EXPANSION, units.TORQUE} <= kinds
    assert len(BOUNDED) > 30


@pytest.mark.parametrize("name", PARTS)
def test_what_a_field_allows_has_no_power_of_ten(name: str) -> None:
    for key, field in PARTS[name].model_fields.items():
        allowed = allowed_at(field) if rule_of(field) is not None or parts_of(field) else ""
        assert not POWER.search(allowed), f"{key}: {allowed}"


@pytest.mark.parametrize("quantity", BOUNDED, ids=lambda q: f"{q.dimension.name}-{q.low:g}-{q.high:g}")
def test_bounds_have_no_power_of_ten_in_any_unit_and_read_back(quantity: Quantity) -> None:
    """Six digits, which is what is written of them."""
    dimension = quantity.dimension
    for unit in [dimension.unit, *units._COMMON.get(dimension, {})]:
        said = allowed_as_typed(quantity.allowed, f"1 {unit}" if unit else 1.0)
        assert not POWER.search(said), said
        found = re.search(rf"from (-?[\d. ]+) to (-?[\d. ]+?){re.escape(f' {unit}'.rstrip())}($|;)", said)
        assert found, said
        for text, bound in zip(found.groups()[:2], (quantity.low, quantity.high), strict=True):
            read = parse(
                f"{text.replace(' ', '')} {unit}".strip() if unit else float(text.replace(" ", "")), dimension
            )
            assert math.isclose(read, bound, rel_tol=5.001e-6, abs_tol=0.0), said


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1e9, "1 000 000 000"), (-1e3, "-1000"), (9549296.6, "9549297"), (12345678.4, "12 345 678"),
        (1e-6, "0.000001"), (1e-9, "0.000 000 001"), (9.5493e-6, "0.000 009 549 3"), (0.0, "0"),
    ],
)  # fmt: skip
def test_bounds_are_written_out(value: float, text: str) -> None:
    assert written_out(value) == text


def test_a_bound_in_groups_is_told_in_the_unit_typed() -> None:
    said = "from 0 to 1 000 000 000 kg*m, and below twice 0.000 000 001 5 kg*m"
    wanted = "from 0 to 1 000 000 000 000 kg*mm, and below twice 0.0000015 kg*mm"
    assert allowed_as_typed(said, "3 kg*mm") == wanted


def test_texts_are_what_a_person_would_write() -> None:
    """The unit typed comes back; without one, and of a time known to a factor of two, the usual one."""
    typed = unit_typed("15 N/mm", STIFFNESS)
    assert (typed.text(15e3), unit_typed(15e3, STIFFNESS).name) == ("15 N/mm", "N/m")
    shown = with_unit(5.636e-6, LENGTH), with_unit(0.115, UNBALANCE), with_unit(1047.2, ANGULAR_SPEED)
    assert shown == ("5.636 um", "115 kg mm", "10000 rpm")
    assert over_rpm(10.0, 20.0, "between", "and") == "between 95.49 and 191 rpm"
    assert over_rpm(20.0, 20.0) == "at 191 rpm"
    assert allowed_as_typed("below the radius, 0.065 m", "300 mm") == "below the radius, 65 mm"
    assert (seconds_words(123.4), seconds_words(0.0123)) == ("120 s", "12 ms")
