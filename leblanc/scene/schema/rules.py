"""Rules for single values of a scene: each takes what the file says and returns it checked, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, PlainValidator

from leblanc.core import units
from leblanc.core.units import Dimension, parse, written_out
from leblanc.scene.schema.load import meant


class Refused(ValueError):  # noqa: N818 - it says what became of the value
    """A value that breaks a rule; `allowed` is what it must be, in words that follow "must be"."""

    def __init__(self, allowed: str) -> None:
        super().__init__(allowed)
        self.allowed = allowed


@dataclass(frozen=True)
class Quantity:
    """A number with a unit, within bounds.

    The bounds are far outside anything that is built; they keep squares and products finite.
    """

    dimension: Dimension  #: what it measures
    low: float  #: bounds in SI units, both allowed
    high: float
    or_zero: bool = False  #: zero is allowed as well

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        zero = "0, or " if self.or_zero and self.low > 0.0 else ""
        unit = f" {self.dimension.unit}" if self.dimension.unit else ""
        return (
            f"{self.dimension.allowed}, {zero}from {written_out(self.low)} to {written_out(self.high)}{unit}"
        )

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        return {"type": ["number", "string"]}

    def __call__(self, value: object) -> float:
        """Value in SI units."""
        number = parse(value, self.dimension) + 0.0  # a negative zero becomes zero
        if self.low <= number <= self.high or (self.or_zero and number == 0.0):
            return number
        raise Refused(self.allowed)


_COUNTS = {"two": 2, "three": 3}


def _array(each: dict[str, Any], count: int) -> dict[str, Any]:
    """So many of one kind in JSON schema."""
    return {"type": "array", "items": each, "minItems": count, "maxItems": count}


@dataclass(frozen=True)
class Several:
    """One quantity, or several of them, along x, y, z or other directions."""

    each: Quantity
    count: str = "three"
    directions: str = "x, y, z"

    @property
    def dimension(self) -> Dimension:
        """Of each."""
        return self.each.dimension

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        return f"{self.each.allowed}; or a list of {self.count}, along {self.directions}"

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        return {"anyOf": [self.each.schema, _array(self.each.schema, _COUNTS[self.count])]}

    def __call__(self, value: object) -> float | tuple[float, ...]:
        """Value or values in SI units."""
        if not isinstance(value, list | tuple):
            return self.each(value)
        if len(value) != _COUNTS[self.count]:
            raise Refused(self.allowed)
        return tuple(map(self.each, value))


@dataclass(frozen=True)
class Whole:
    """A whole number within bounds."""

    low: int
    high: int

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        return f"a whole number from {self.low} to {self.high}"

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        return {"type": "integer", "minimum": self.low, "maximum": self.high}

    def __call__(self, value: object) -> int:
        """The number."""
        if isinstance(value, int) and not isinstance(value, bool) and self.low <= value <= self.high:
            return value
        raise Refused(self.allowed)


@dataclass(frozen=True)
class OneOf:
    """One of a few names."""

    names: tuple[str, ...]

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        return "one of: " + ", ".join(self.names)

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        return {"enum": list(self.names)}

    def __call__(self, value: object) -> str:
        """The word."""
        if isinstance(value, str) and value in self.names:
            return value
        raise Refused(self.allowed + meant(value, self.names))


@dataclass(frozen=True)
class Text:
    """A text of bounded length without control characters; blanks and line breaks in a row count as one."""

    longest: int
    may_be_empty: bool = False

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        empty = "" if self.may_be_empty else ", not empty"
        return f"a text in quotes of at most {self.longest} printable characters{empty}"

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        return {"type": "string"}

    def __call__(self, value: object) -> str:
        """The text on one line."""
        if not isinstance(value, str):
            raise Refused(self.allowed)
        text = " ".join(value.split())
        if not text.isprintable() or len(text) > self.longest or not (text or self.may_be_empty):
            raise Refused(self.allowed)
        return text


@dataclass(frozen=True)
class Flag:
    """True or false."""

    allowed: str = "true or false"

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        return {"type": "boolean"}

    def __call__(self, value: object) -> bool:
        """The flag."""
        if isinstance(value, bool):
            return value
        raise Refused(self.allowed)


@dataclass(frozen=True)
class Entries:
    """A list of bounded length."""

    low: int
    high: int
    what: str

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        size = f"{self.low}" if self.low == self.high else f"{self.low} to {self.high}"
        return f"a list of {size} {self.what}"

    def __call__(self, value: object) -> list[object] | tuple[object, ...]:
        """The list; an array stands for one in Python."""
        value = value.tolist() if hasattr(value, "tolist") else value
        if isinstance(value, list | tuple) and self.low <= len(value) <= self.high:
            return value
        raise Refused(self.allowed)


@dataclass(frozen=True)
class Span:
    """Two values of one quantity, or two whole numbers, the lower first."""

    each: Quantity | Whole

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        return f"a list of two, the second at least the first, each {self.each.allowed}"

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        return _array(self.each.schema, 2)

    def __call__(self, value: object) -> tuple[float, float]:
        """Both in SI units, whole numbers as they are."""
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise Refused(self.allowed)
        low, high = map(self.each, value)
        if high < low:
            raise Refused(self.allowed)
        return low, high


@dataclass(frozen=True)
class Spans:
    """Two values of one quantity, the lower first; or a list of such pairs."""

    each: Quantity

    @property
    def allowed(self) -> str:
        """What is allowed, as a text."""
        return f"{Span(self.each).allowed}; or a list of such pairs"

    @property
    def schema(self) -> dict[str, Any]:
        """The same in JSON schema."""
        pair = Span(self.each).schema
        return {"anyOf": [pair, {"type": "array", "items": pair}]}

    def __call__(self, value: object) -> tuple[float, float] | tuple[tuple[float, float], ...]:
        """The pair, or the pairs, in SI units."""
        span = Span(self.each)
        if isinstance(value, list | tuple) and value and all(isinstance(x, list | tuple) for x in value):
            return tuple(map(span, value))
        try:
            return span(value)
        except Refused as refused:
            raise Refused(self.allowed) from refused


def quantity(dimension: Dimension, low: float, high: float, *, or_zero: bool = False) -> PlainValidator:
    """Rule of a number with a unit, for an annotation; arguments as of `Quantity`."""
    return PlainValidator(Quantity(dimension, low, high, or_zero))


def entries(low: int, high: int, what: str) -> BeforeValidator:
    """Rule of a list whose entries have rules of their own, for an annotation."""
    return BeforeValidator(Entries(low, high, what))


def whole(low: int, high: int) -> PlainValidator:
    """Rule of a whole number between bounds, both allowed, for an annotation."""
    return PlainValidator(Whole(low, high))


def one_of(*names: str) -> PlainValidator:
    """Rule of one of a few names, for an annotation."""
    return PlainValidator(OneOf(names))


# Rules that several tables share; the plain names are those of optional values.
LENGTH = quantity(units.LENGTH, 1e-6, 1e3)
POSITION = quantity(units.LENGTH, -1e3, 1e3)
SPEED = quantity(units.ANGULAR_SPEED, 1e-6, 1e6)
DAMPING = quantity(units.DAMPING, 0.0, 1e15)
STIFFNESS = quantity(units.STIFFNESS, 1e-9, 1e15)

Length = Annotated[float, LENGTH]
Position = Annotated[float, POSITION]
Place = Annotated[tuple[Position, Position, Position], entries(3, 3, "lengths, along x, y, z")]
Speed = Annotated[float, SPEED]
Mass = Annotated[float, quantity(units.MASS, 1e-9, 1e9)]
Inertia = Annotated[float, quantity(units.INERTIA, 1e-12, 1e12)]
Unbalance = Annotated[float, quantity(units.UNBALANCE, 0.0, 1e9)]
Damping = Annotated[float, DAMPING]
Stiffness = Annotated[float, STIFFNESS]
Truth = Annotated[bool, PlainValidator(Flag())]
Axis = Annotated[Literal["horizontal", "vertical"], one_of("horizontal", "vertical")]
