"""Quantities with units at the border: text or plain number in, SI number out. The only door to pint.

A cycle is an angle here: "1 Hz" and "60 rpm" are both 2 pi rad/s. (pint alone takes a hertz for 1/s, which
would make a speed in hertz 2 pi too small.) "1/s" is read as rad/s where an angular speed is wanted, as the
literature writes it, while "1/min" is refused there: nameplates mean turns by it. A rate in 1/s that is no
rotation takes neither hertz nor rpm.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal
from functools import partial
from numbers import Real
from typing import TYPE_CHECKING, Any

from meshes.errors import InputError, require_not_negative

if TYPE_CHECKING:
    from fluid.friction.laws import Friction
    from meshes.arrays import Array, Flags

_LONGEST = 64  # characters; no quantity needs more, and pint evaluates what it is given


@dataclass(frozen=True)
class Dimension:
    """A kind of quantity."""

    name: str  #: for messages, as in "must be a length"
    unit: str  #: its SI unit, that of plain numbers; empty for a pure number
    example: str  #: how a user may write one
    also: tuple[str, ...] = ()  #: other units taken as equal to the SI unit, but not their multiples

    @property
    def allowed(self) -> str:
        """What may be written, in words."""
        article = "an" if self.name[0] in "aeiou" else "a"
        if not self.unit:
            return f"{article} {self.name} such as {self.example}"
        return f'{article} {self.name} such as "{self.example}" (a plain number is in {self.unit})'


# Engineering units in one SI unit, for what is shown to people.
RPM = 60.0 / (2.0 * math.pi)  # revolutions per minute in one rad/s
ZERO_TO_PEAK = "zero to peak"  # every amplitude: largest distance from rest, half of a peak-to-peak reading
MM_PEAK = "mm 0-p"  # the same beside the unit of an axis
MM = 1e3  # millimetres in one metre
ML = 1e6  # millilitres in one cubic metre
LITRE = 1e3  # litres in one cubic metre
NOT_FOUND = "not found"  # as printed
_PLAIN = 7  # digits of a number that is written out; the fastest spin has them, in rpm
MINUS, DEGREE, TIMES = "\N{MINUS SIGN}", "\N{DEGREE SIGN}", "\N{MULTIPLICATION SIGN}"

NUMBER = Dimension("pure number", "", "0.1")
LENGTH = Dimension("length", "m", "65 mm")
VOLUME = Dimension("volume", "m^3", "10 ml")
MASS = Dimension("mass", "kg", "4 kg")
DENSITY = Dimension("density", "kg/m^3", "998 kg/m^3")
VISCOSITY = Dimension("kinematic viscosity", "m^2/s", "1.0 mm^2/s")
STIFFNESS = Dimension("stiffness", "N/m", "44000 N/m")
DAMPING = Dimension("damping coefficient", "N*s/m", "84 N*s/m")
UNBALANCE = Dimension("unbalance", "kg*m", "0.6 kg*mm")
INERTIA = Dimension("moment of inertia", "kg*m^2", "0.5 kg*m^2")
TORQUE = Dimension("torque", "N*m", "20 N*m")
ANGLE = Dimension("angle", "rad", "30 deg")
TIME = Dimension("time", "s", "14 s")
RATE = Dimension("rate", "1/s", "0.5 1/s")
ACCELERATION = Dimension("acceleration", "m/s^2", "9.81 m/s^2")
TEMPERATURE = Dimension("temperature", "K", "20 degC")
TEMPERATURE_STEP = Dimension("difference of temperatures", "K", "900 K")
EXPANSION = Dimension("thermal expansion", "1/K", "0.0007 1/K")
VELOCITY = Dimension("velocity", "m/s", "6.3 mm/s")
FORCE = Dimension("force", "N", "800 N")
WEAR = Dimension("wear coefficient", "m^2/N", "0.00000001 mm^3/(N*m)")
CURRENT = Dimension("electric current", "A", "30 mA")
MAGNET = Dimension("force constant of a magnet", "N*m^2/A^2", "0.00002 N*m^2/A^2")
DYNAMIC_VISCOSITY = Dimension("dynamic viscosity", "Pa*s", "3.5 mPa*s")
INTEGRAL_GAIN = Dimension("integral gain", "N/(m*s)", "1000000 N/(m*s)")
SQUARE_TIME = Dimension("square of a time", "s^2", "0.008 s^2")
CUBIC_RATE = Dimension("cube of a rate", "1/s^3", "70000000 1/s^3")
ELASTIC_MODULUS = Dimension("elastic modulus", "Pa", "210 GPa")
ANGULAR_STIFFNESS = Dimension("angular stiffness", "N*m/rad", "200000 N*m/rad")
ANGULAR_DAMPING = Dimension("angular damping", "N*m*s/rad", "5 N*m*s/rad")
ANGULAR_SPEED = Dimension("angular speed", "rad/s", "1000 rpm", also=("1/s",))
ANGULAR_ACCELERATION = Dimension("angular acceleration", "rad/s^2", "8 rad/s^2", also=("1/s^2",))
_DIMENSIONS = (
    *(LENGTH, VOLUME, MASS, DENSITY, VISCOSITY, STIFFNESS, DAMPING, UNBALANCE, INERTIA, TORQUE, ANGLE, TIME),
    *(RATE, ACCELERATION, TEMPERATURE, ANGULAR_SPEED, ANGULAR_ACCELERATION, FORCE, CURRENT, MAGNET),
    *(DYNAMIC_VISCOSITY, INTEGRAL_GAIN, SQUARE_TIME, CUBIC_RATE),
    *(ELASTIC_MODULUS, ANGULAR_STIFFNESS, ANGULAR_DAMPING, WEAR),
)

# Units of usual scenes, each in the SI unit of its dimension; all others are left to pint, whose
# definitions take a third of a second to read. A test holds every entry to pint, bit for bit.
_TURN = 2.0 * math.pi
_COMMON: dict[Dimension, dict[str, float]] = {
    LENGTH: {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "um": 1e-6},
    VOLUME: {
        "m^3": 1.0,
        "dm^3": 1e-3,
        "cm^3": 1e-6,
        "mm^3": 1e-9,
        "l": 1e-3,
        "L": 1e-3,
        "ml": 1e-6,
        "mL": 1e-6,
    },
    MASS: {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "t": 1e3},
    DENSITY: {"kg/m^3": 1.0, "g/cm^3": 1e3, "kg/l": 1e3, "g/ml": 1e3},
    VISCOSITY: {"m^2/s": 1.0, "mm^2/s": 1e-6, "cSt": 1e-6},
    STIFFNESS: {"N/m": 1.0, "N/cm": 1e2, "N/mm": 1e3, "kN/m": 1e3, "kN/mm": 1e6, "MN/m": 1e6},
    DAMPING: {"N*s/m": 1.0, "N*s/mm": 1e3, "kN*s/m": 1e3, "kg/s": 1.0},
    UNBALANCE: {"kg*m": 1.0, "kg*cm": 1e-2, "kg*mm": 1e-3, "g*m": 1e-3, "g*cm": 1e-5, "g*mm": 1e-6},
    INERTIA: {"kg*m^2": 1.0, "kg*cm^2": 1e-4, "kg*mm^2": 1e-6, "g*m^2": 1e-3, "g*cm^2": 1e-7},
    TORQUE: {"N*m": 1.0, "N*cm": 1e-2, "N*mm": 1e-3, "mN*m": 1e-3, "kN*m": 1e3},
    FORCE: {"N": 1.0, "mN": 1e-3, "kN": 1e3},
    CURRENT: {"A": 1.0, "mA": 1e-3},
    MAGNET: {"N*m^2/A^2": 1.0},
    DYNAMIC_VISCOSITY: {"Pa*s": 1.0, "mPa*s": 1e-3},
    INTEGRAL_GAIN: {"N/(m*s)": 1.0},
    SQUARE_TIME: {"s^2": 1.0},
    CUBIC_RATE: {"1/s^3": 1.0},
    ELASTIC_MODULUS: {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9},
    ANGULAR_STIFFNESS: {"N*m/rad": 1.0},
    ANGULAR_DAMPING: {"N*m*s/rad": 1.0},
    WEAR: {"m^2/N": 1.0},
    ANGLE: {"rad": 1.0, "mrad": 1e-3, "deg": _TURN / 360.0},
    TIME: {"s": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0},
    RATE: {"1/s": 1.0},
    ACCELERATION: {"m/s^2": 1.0, "cm/s^2": 1e-2, "mm/s^2": 1e-3},
    ANGULAR_SPEED: {"rad/s": 1.0, "1/s": 1.0, "rpm": _TURN / 60.0, "Hz": _TURN, "deg/s": _TURN / 360.0},
    ANGULAR_ACCELERATION: {"rad/s^2": 1.0, "1/s^2": 1.0, "rpm/s": _TURN / 60.0, "Hz/s": _TURN},
}
_OFFSETS = {"K": 0.0, "kelvin": 0.0, "degC": 273.15}  # of temperatures, in kelvin

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?"
_POWER = r"(?:\s*(?:\^|\*\*)\s*[+-]?[1-9])?"
_FACTOR = rf"[A-Za-zµμ°%]++{_POWER}"
_JOIN = r"(?:\s*[*/]\s*|\s+)"
_GROUP = rf"\(\s*{_FACTOR}(?:{_JOIN}{_FACTOR})*\s*\){_POWER}"
_UNIT = rf"(?:1?\s*/\s*)?(?:{_FACTOR}|{_GROUP})(?:{_JOIN}(?:{_FACTOR}|{_GROUP}))*"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*({_UNIT})?\s*", re.ASCII)
_SPELLINGS = str.maketrans({"·": "*", "⋅": "*", TIMES: "*", "²": "^2", "³": "^3"})
# Powers as figures behind a unit, "kg/m3", and factors without a sign between them, "Ns/m" and "gmm".
_FIGURE = re.compile(r"(?<=[A-Za-zµ])([2-4])(?![\d.])")
_GLUED = re.compile(
    r"(?<![A-Za-zµ])(?:([kMm]?N|[kM]?Pa|mPa)(?=[cms])(mm|cm|m)?(s)?|(k?g|mg)(mm|cm|m))(\^[2-4])?(?![A-Za-zµ])"
)
_SIMPLE = rf"{_FACTOR}(?:{_JOIN}{_FACTOR})*"
_PRODUCT = re.compile(rf"\s*({_NUMBER})\s*({_SIMPLE})\s*\*\s*({_NUMBER})\s*({_SIMPLE})\s*", re.ASCII)
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d")
_THOUSANDS = re.compile(r"\s*[+-]?\d{1,3},\d{3}(?!\d)")
_TURNS_A_MINUTE = re.compile(r"(?:RPM|Rpm|(?:rev|r|U)\s*/\s*min)")  # as nameplates have it
_SIGN = re.compile(r"\s*(\*\*|[*/^])\s*")
_HERTZ = re.compile(r"(?<![A-Za-z])([A-Za-z]*?)(?:Hz|hertz)(?![A-Za-z])")


@dataclass(frozen=True)
class Unit:
    """A unit in which values are shown."""

    name: str  #: as printed, and as it may be typed
    count: float  #: how many of it one SI unit is

    def number(self, value: float) -> str:
        """An SI value in this unit for print, without the unit."""
        return number(value * self.count)

    def text(self, value: float) -> str:
        """An SI value with this unit; what is not finite has none."""
        return f"{self.number(value)} {self.name}".rstrip() if math.isfinite(value) else number(value)


# Units that a person would write, each with the size in SI from which it is taken. The first one takes all
# that is smaller, the one at None what is zero or not known.
_UNITS: dict[Dimension, tuple[tuple[float, Unit], ...]] = {
    LENGTH: (
        (0.0, Unit("nm", 1e9)),
        (1e-7, Unit("um", 1e6)),
        (1e-4, Unit("mm", MM)),
        (10.0, Unit("m", 1.0)),
    ),
    MASS: ((0.0, Unit("mg", 1e6)), (1e-3, Unit("g", 1e3)), (1.0, Unit("kg", 1.0)), (1e4, Unit("t", 1e-3))),
    VOLUME: (
        (0.0, Unit("ul", 1e9)),
        (1e-7, Unit("ml", ML)),
        (1e-2, Unit("l", LITRE)),
        (10.0, Unit("m^3", 1.0)),
    ),
    UNBALANCE: (
        (0.0, Unit("mg mm", 1e9)),
        (1e-8, Unit("g mm", 1e6)),
        (1e-3, Unit("kg mm", MM)),
        (10.0, Unit("kg m", 1.0)),
    ),
    TIME: ((0.0, Unit("us", 1e6)), (1e-4, Unit("ms", 1e3)), (0.1, Unit("s", 1.0))),
    ANGULAR_SPEED: ((0.0, Unit("rpm", RPM)),),
    CURRENT: ((0.0, Unit("uA", 1e6)), (1e-4, Unit("mA", 1e3)), (1.0, Unit("A", 1.0))),
}
_USUAL = {LENGTH: "mm", MASS: "g", VOLUME: "ml", UNBALANCE: "g mm", TIME: "s", ANGULAR_SPEED: "rpm"}
_USUAL |= {CURRENT: "mA"}


def units_of(dimension: Dimension) -> tuple[Unit, ...]:
    """Units in which values are shown, by rising size."""
    return tuple(unit for _, unit in _UNITS.get(dimension, ((0.0, Unit(dimension.unit, 1.0)),)))


def unit_for(dimension: Dimension, *values: float) -> Unit:
    """Unit in which a person would write SI values that stand side by side; the largest finite one decides.

    Examples
    --------
    >>> unit_for(LENGTH, 7.2e-3, 5.6e-6).name, unit_for(LENGTH, 5.6e-6).name, unit_for(LENGTH, 0.0).name
    ('mm', 'um', 'mm')
    """
    units = _UNITS.get(dimension, ((0.0, Unit(dimension.unit, 1.0)),))
    size = max((abs(value) for value in values if math.isfinite(value)), default=0.0)
    if size == 0.0:
        usual = _USUAL.get(dimension, dimension.unit)
        return next(unit for _, unit in units if unit.name == usual)
    # What would be printed as the next unit's least, rounded to four digits, is in that unit.
    return [unit for least, unit in units if size * (1.0 + 5e-5) >= least][-1]


def unit_typed(value: object, dimension: Dimension) -> Unit:
    """Unit in which a value free of faults stands in a file, its SI unit where it is a plain number."""
    match = _matched(value) if isinstance(value, str) else None
    if match is None or not match[2] or dimension is TEMPERATURE:
        return Unit(dimension.unit, 1.0)
    return Unit(match[2], 1.0 / parse(f"1 {match[2]}", dimension))


def with_unit(value: float, dimension: Dimension) -> str:
    """An SI value for print in the unit that a person would write."""
    return unit_for(dimension, value).text(value)


def change_words(size: float, without: float) -> str:
    """How much a size differs from that without something, in per cent; empty where that is not known."""
    if not (0.0 < without < math.inf and math.isfinite(size)):
        return ""
    share = 100.0 * (size / without - 1.0)
    if abs(share) < 0.05:
        return "no change"
    return f"{'+' if share > 0.0 else MINUS}{abs(share):.{1 if abs(share) < 10.0 else 0}f} %"


def in_rpm(speed: float, missing: str = NOT_FOUND) -> str:
    """A speed in rad/s for print; `missing` stands in place of one that is not finite."""
    return with_unit(speed, ANGULAR_SPEED) if math.isfinite(speed) else missing


def rpm_range(low: float, high: float) -> str:
    """A range of speeds in rad/s for print; one number where both ends print alike."""
    first, last = number(low * RPM), in_rpm(high)
    return last if last == in_rpm(low) else f"{first} to {last}"


def over_rpm(low: float, high: float, before: str = "from", between: str = "to") -> str:
    """Where a range of speeds in rad/s is, as a part of a sentence: "from 1 to 2 rpm", or "at 2 rpm"."""
    last = in_rpm(high)
    return f"at {last}" if last == in_rpm(low) else f"{before} {number(low * RPM)} {between} {last}"


def rpm_bands(bands: Iterable[tuple[float, float]]) -> str:
    """Ranges of speed for print, from their first and last speeds in rad/s; empty without any."""
    return ", ".join(rpm_range(low, high) for low, high in bands)


def celsius(temperature: float) -> str:
    """A temperature in K for print, as a person would write it."""
    return f"{number(float(f'{temperature - 273.15:.10g}'))} degC"


def number(value: float) -> str:
    """Value to four digits for print, without zeros at the end."""
    if not math.isfinite(value):
        return NOT_FOUND if math.isnan(value) else "infinite"
    if value == 0.0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    if not -4 <= exponent < _PLAIN:
        return f"{value:.3e}".replace("-", MINUS)
    text = f"{value:.{max(0, 3 - exponent)}f}"
    return (text.rstrip("0").rstrip(".") if "." in text else text).replace("-", MINUS)


_ALL = 0.995  # relative error that leaves nothing sure


def measured(value: float, error: float, unit: Unit) -> str:
    """A value with its absolute error, both SI, no digit finer than that: "7.95 \N{PLUS-MINUS SIGN} 0.72".

    The value alone where the error is unknown, as large as itself or less than its fourth digit.
    """
    size, doubt = value * unit.count, abs(error) * unit.count
    if not math.isfinite(size) or not 0.0 < doubt < _ALL * abs(size):
        return number(size)
    # Two digits of the error, four of the value.
    places = min(1 - math.floor(math.log10(doubt)), 3 - math.floor(math.log10(abs(size))))
    shown = round(doubt, places)
    if shown == 0.0:
        return number(size)
    digits = max(places, 0)
    text = f"{round(size, places):.{digits}f} \N{PLUS-MINUS SIGN} {shown:.{digits}f}"
    return text.replace("-", MINUS)


_MOST = 1e50  # in SI; powers and products of what is larger overflow, and nothing in the world is


def parse(value: object, dimension: Dimension, field: str = "value") -> float:
    """Finite value in `dimension.unit` of a plain number, taken as SI, or of a text of a number and a unit.

    An `InputError` that names the field refuses anything else, and a unit of something else.

    Examples
    --------
    >>> parse("65 mm", LENGTH), parse(0.065, LENGTH), parse("60 rpm", ANGULAR_SPEED) / math.pi
    (0.065, 0.065, 2.0)
    """
    if isinstance(value, float) and abs(value) <= _MOST:
        return float(value)  # most are: a sweep checks millions
    if isinstance(value, str):
        number = _from_text(value, dimension, field)
    elif isinstance(value, Real) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    else:
        raise InputError(field, type(value).__name__, dimension.allowed)
    if not abs(number) <= _MOST:
        given = value if isinstance(value, str) else number
        raise InputError(field, given, f"{dimension.allowed}, and finite")
    return number


_WHOLE = 1e6  # from here on a bound is a whole number


def written_out(value: float) -> str:
    """A bound for a message without a power of ten: six digits or whole, many of them in groups of three.

    Examples
    --------
    >>> written_out(0.065), written_out(1e9), written_out(1e-12)
    ('0.065', '1 000 000 000', '0.000 000 000 001')
    """
    if not math.isfinite(value):
        return str(value)
    digits = f"{value:.6g}" if abs(value) < _WHOLE else f"{round(value):.15g}"
    whole, _, part = f"{Decimal(digits):f}".partition(".")
    whole = f"{int(whole):,}".replace(",", " ") if len(whole.lstrip("-")) > _PLAIN else whole
    if len(part) > _PLAIN:
        part = " ".join(part[k : k + 3] for k in range(0, len(part), 3))
    return f"{whole}.{part}" if part else whole


_BOUND = r"-?(?:\d{1,3}(?: \d{3})+(?!\d)|\d+)(?:\.(?:\d{3} )+\d{1,3}|\.\d*)?(?:e[+-]?\d+)?"
_POWERED = re.compile(r"(?<![\w.])-?\d+\.?\d*e[+-]?\d+(?![\w.])")


def allowed_as_typed(allowed: str, typed: object) -> str:
    """What is allowed, its bounds in the unit that the user typed, all of them written out.

    Of a list its first text counts; without a unit the text stays as it is.
    """
    text = _POWERED.sub(lambda found: written_out(float(found[0])), _in_unit_typed(allowed, typed))
    plain = isinstance(typed, float | int) and not isinstance(typed, bool)
    # Nobody fills cubic metres in.
    return (
        f'{text} (a plain number is in m^3; litres are typed "{typed:g} l")'
        if plain and text.endswith(" m^3")
        else text
    )


def _in_unit_typed(allowed: str, typed: object) -> str:
    """The bounds in the unit typed."""
    if isinstance(typed, list | tuple):
        typed = next((entry for entry in typed if isinstance(entry, str)), None)
    match = _matched(typed) if isinstance(typed, str) else None
    unit = match[2] if match else None
    if not unit or len(str(typed)) > _LONGEST:
        return allowed
    for dimension in _DIMENSIONS:
        if not re.search(rf"\d {re.escape(dimension.unit)}(?![\w^*/])", allowed):
            continue
        scale = _scale_of(unit, dimension)
        if scale is not None:
            bounds = re.compile(
                rf'(?<!["\d.])({_BOUND} (?:to|and) )?({_BOUND}) {re.escape(dimension.unit)}(?![\w^*/])'
            )
            return bounds.sub(partial(_bounds_as_typed, unit=unit, scale=scale), allowed)
    return allowed


def _scale_of(unit: str, dimension: Dimension) -> tuple[float, float] | None:
    """SI value of one unit and of its zero; None where it measures something else."""
    if dimension is TEMPERATURE:
        return (1.0, _OFFSETS[unit]) if unit in _OFFSETS else None
    unit = "1" + unit if unit.startswith("/") else unit
    factor = _COMMON.get(dimension, {}).get(_plain(unit)) or _factor(unit, dimension)
    return (factor, 0.0) if isinstance(factor, float) else None


def _bounds_as_typed(found: re.Match[str], unit: str, scale: tuple[float, float]) -> str:
    """One bound, or two of them, in another unit."""
    factor, zero = scale

    def written(bound: str) -> str:
        return re.sub(_BOUND, lambda it: written_out((_read(it[0]) - zero) / factor), bound, count=1)

    return f"{written(found[1] or '')}{written(found[2])} {unit}"


def _read(bound: str) -> float:
    """A bound as it stands in a message."""
    return float(bound.replace(" ", ""))


def parse_option(text: str | float, dimension: Dimension, field: str) -> float:
    """Value of an option of a command, where a plain number is a text too, or of a keyword, as by `parse`."""
    if type(text).__name__ in ("bool", "bool_", "bytes", "bytearray"):  # Python makes numbers of them
        raise InputError(field, type(text).__name__, dimension.allowed)
    try:
        number = float(text)
    except (ValueError, TypeError, OverflowError):
        return parse(text, dimension, field)
    return parse(number, dimension, field)


def _matched(text: str) -> re.Match[str] | None:
    """Number and unit of a text, the unit with ^, * and /; None where it is no quantity.

    Two quantities with a sign between them, "400 g * 230 mm", are one.
    """
    if len(text) > _LONGEST:
        return None
    spelled = text.translate(_SPELLINGS)
    number = re.match(rf"\s*{_NUMBER}", spelled)
    if number is None:
        return None
    rest = _GLUED.sub(_parted, _FIGURE.sub(r"^\1", spelled[number.end() :]))
    spelled = number[0] + rest
    if (two := _PRODUCT.fullmatch(spelled)) is not None:
        spelled = f"{float(two[1]) * float(two[3])!r} {two[2]} {two[4]}"
    return _QUANTITY.fullmatch(spelled)


def _parted(found: re.Match[str]) -> str:
    """Factors with a sign between them; behind a stroke all of them are below it."""
    *factors, power = found.groups()
    product = "*".join(filter(None, factors)) + (power or "")
    return f"({product})" if found.string[: found.start()].rstrip().endswith("/") else product


def _meant(text: str, dimension: Dimension) -> str:
    """How a text that cannot be read may be written instead, to follow what is allowed."""
    comma, written = (
        _DECIMAL_COMMA.match(text) is not None,
        re.sub(r"(?<=[A-Za-z\d])[.-](?=[A-Za-z])", "*", text),
    )
    tries = [text.replace(",", ".", 1)] if comma else [written] if written != text else []
    if _THOUSANDS.match(text):
        tries.append(text.replace(",", "", 1))
    said = "; the decimal sign is a point" if comma else ""
    for k, written in enumerate(tries):
        if _matched(written) is None or not _is_one(written, dimension):
            continue
        before = (
            ", as in"
            if comma and k == 0
            else ", and thousands have no sign:"
            if comma
            else "; it may be written"
        )
        said += f'{before} "{written.strip()}"'
    return said


def _is_one(text: str, dimension: Dimension) -> bool:
    """Whether a text is a quantity of that kind."""
    try:
        parse(text, dimension)
    except InputError:
        return False
    return True


def _from_text(text: str, dimension: Dimension, field: str) -> float:
    """Number and unit to SI."""
    match = _matched(text)
    if match is None:
        raise InputError(field, text[:_LONGEST], f"{dimension.allowed}{_meant(text, dimension)}")
    number, unit = float(match[1]), match[2] or ""
    if not unit and dimension.unit:
        raise InputError(field, text, f"{dimension.allowed}; this text has no unit")
    if dimension is TEMPERATURE:
        return _kelvin(number, unit, text, field)
    unit = "1" + unit if unit.startswith("/") else unit
    factor = _COMMON.get(dimension, {}).get(_plain(unit)) or _factor(unit, dimension)
    if isinstance(factor, str):
        raise InputError(field, text, f"{dimension.allowed}; {factor}")
    return _scaled(number, factor)


def _plain(unit: str) -> str:
    """A unit as the table of common ones spells it: N*s/m for N s / m."""
    return "*".join(_SIGN.sub(lambda sign: "^" if sign[1] == "**" else sign[1], unit).split())


def _kelvin(number: float, unit: str, text: str, field: str) -> float:
    """Temperature on the absolute scale; degrees count from an offset, which a factor cannot say."""
    if unit in _OFFSETS:
        return number + _OFFSETS[unit]
    import pint

    try:
        return float(_registry().Quantity(number, _registry().parse_units(unit)).to("kelvin").magnitude)
    except (pint.PintError, ArithmeticError) as error:
        raise InputError(field, text, TEMPERATURE.allowed) from error


def _scaled(number: float, factor: float) -> float:
    """Product with a conversion factor, rounded once where the factor is a whole number or one over it."""
    if factor >= 1.0:
        whole = round(factor)
        return number * (whole if math.isclose(whole, factor, rel_tol=1e-12) else factor)
    parts = round(1.0 / factor)
    return number / parts if math.isclose(parts * factor, 1.0, rel_tol=1e-12) else number * factor


@functools.lru_cache(maxsize=1024)
def _factor(unit: str, dimension: Dimension) -> float | str:
    """SI value of one unit, or what is wrong with it."""
    if not unit:
        return 1.0
    import pint

    try:
        factor, base = _base("rpm" if _TURNS_A_MINUTE.fullmatch(unit) else unit)
    except pint.UndefinedUnitError as error:
        names = [error.unit_names] if isinstance(error.unit_names, str) else list(error.unit_names)
        said, small = f"there is no unit {' or '.join(names)}", names[0].lower()
        return f"{said}, but {small}" if small != names[0] and small in _registry() else said
    except (pint.PintError, ArithmeticError):
        return f"{unit} cannot be used as a unit"
    if factor is None or not 1e-30 < factor < 1e30:
        return f"{unit} cannot be used as a unit"
    if base == _base(dimension.unit)[1]:
        return float(factor)
    if base not in [_base(name)[1] for name in dimension.also]:
        return f"{unit} measures something else"
    if not math.isclose(factor, 1.0, rel_tol=1e-12):
        return f"{unit} may mean turns or radians"
    return 1.0


def _base(unit: str) -> tuple[float | None, Any]:
    """Factor to SI base units, None for a scale that is not a factor, and those units, angles among them."""
    registry = _registry()
    parsed = registry.parse_units(_HERTZ.sub(r"(\1turn/s)", unit).replace("%", "percent"))
    single, two = (registry.Quantity(size, parsed).to_base_units() for size in (1.0, 2.0))
    is_factor = math.isclose(two.magnitude, 2.0 * single.magnitude, rel_tol=1e-12)
    return single.magnitude if is_factor else None, single.units


_CF_POWER = re.compile(r"([A-Za-z])(-?[1-9])(?![0-9])")
# Of which the answers here are made; all others are left to pint.
_USUAL_SINGLE = ("", "1", "m", "kg", "s", "rad", "N", "Pa", "J", "W", "A", "K")


@functools.cache
def is_unit(unit: str) -> bool:
    """Whether a text is a unit as CF writes it, "m s-1"; that of a number is "1", of what has none ""."""
    if all(_CF_POWER.sub(r"\1", part) in _USUAL_SINGLE for part in unit.split()):
        return True
    try:
        _registry().parse_units(_CF_POWER.sub(r"\1**\2", "*".join(unit.split())))
    except Exception:  # pint evaluates what it is given
        return False
    return True


@functools.cache
def _registry() -> Any:
    """The unit definitions; they take a third of a second to read, so only a text with a unit reads them."""
    import pint

    return pint.UnitRegistry()


def parse_friction(text: str, field: str) -> Friction:
    """Friction law as typed: none, stokes, wall, wall:ROUGHNESS, linear:RATE or quadratic:NUMBER.

    Raises
    ------
    InputError : no such law, a coefficient missing, misplaced or negative
    """
    law, colon, coefficient = text.partition(":")
    from fluid.friction.laws import Friction, FrictionLaw

    if law in (FrictionLaw.NONE, FrictionLaw.STOKES, FrictionLaw.WALL) and not colon:
        return Friction(FrictionLaw(law))
    if law == FrictionLaw.WALL and coefficient:
        roughness = parse_option(coefficient, LENGTH, field)
        require_not_negative(field, roughness)
        return Friction(FrictionLaw.WALL, roughness=roughness)
    if law in (FrictionLaw.LINEAR, FrictionLaw.QUADRATIC) and coefficient:
        unit = RATE if law == FrictionLaw.LINEAR else NUMBER
        value = parse_option(coefficient, unit, field)
        require_not_negative(field, value)
        return Friction(FrictionLaw(law), value)
    raise InputError(field, text, "none, stokes, wall, wall:ROUGHNESS, linear:RATE or quadratic:NUMBER")


def friction_words(friction: Friction) -> str:
    """Law of the liquid's friction with its coefficient."""
    from fluid.friction.laws import FrictionLaw

    return {
        FrictionLaw.NONE: "none",
        FrictionLaw.STOKES: "laminar (Stokes)",
        FrictionLaw.LINEAR: f"linear, {friction.coefficient:g} 1/s",
        FrictionLaw.QUADRATIC: f"quadratic, {friction.coefficient:g}",
        FrictionLaw.WALL: f"wall, rough by {1e6 * friction.roughness:g} µm"
        if friction.roughness
        else "smooth wall",
    }[friction.law]


def small_whirl_friction(friction: Friction) -> str:
    """Law of friction as a small whirl meets it, in words."""
    from fluid.friction.laws import FrictionLaw

    if friction.law is FrictionLaw.QUADRATIC:
        return "none (the quadratic law does not act on small whirls)"
    if friction.law.laminar:
        return "laminar"
    return friction_words(friction)


def in_peak(unit: str) -> str:
    """A unit of amplitudes as heads of tables name it."""
    return MM_PEAK.replace("mm", unit)


MOST_RANGES = 4  # listed one by one


def ranges(place: Array, mask: Flags, unit: str = "rpm") -> str:
    """Speeds (rad/s, in any order), or else times in s, at which a condition holds, in words."""
    import numpy as np

    if not mask.any():
        return "none"
    if mask.all():
        return "all speeds" if unit == "rpm" else "all the time"
    order = np.argsort(place, kind="stable")
    sorted_, holds = place[order] * (RPM if unit == "rpm" else 1.0), mask[order]
    change = np.flatnonzero(np.diff(np.concatenate(([False], holds, [False]))))
    first, last = sorted_[change[::2]], sorted_[change[1::2] - 1]
    if first.size > MOST_RANGES:
        return f"{first.size} ranges between {number(first[0])} and {number(last[-1])} {unit}"
    pairs = zip(first.tolist(), last.tolist(), strict=True)
    parts = [number(a) if a == b else f"{number(a)} to {number(b)}" for a, b in pairs]
    return f"{'; '.join(parts)} {unit}"


def amplitudes_are(place: str = "") -> tuple[str, str]:
    """What the amplitudes of an answer are, and where along the axis where that matters: label and value."""
    return "Amplitudes", f"{ZERO_TO_PEAK}{', ' if place else ''}{place}"


def with_peak(unit: str, name: str, text: str) -> str:
    """What a reader needs to know of a quantity; of an amplitude that it is zero to peak."""
    if unit == "m" and "amplitude" in name + text and ZERO_TO_PEAK not in name + text:
        return f"{ZERO_TO_PEAK}, {text}" if text else ZERO_TO_PEAK
    return text


def amplitude_sentence(place: str = "") -> str:
    """The same as a sentence."""
    return f"{' are '.join(amplitudes_are(place))}."
