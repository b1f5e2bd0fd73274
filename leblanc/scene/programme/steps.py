"""The steps of a spin programme as a person writes them: "to 90 rpm in 4 s", "hold 10 s", "coast to 0"."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from leblanc.core import units
from leblanc.core.units import RPM, in_rpm, number
from leblanc.scene.schema.load import meant
from leblanc.scene.schema.rules import Entries, Quantity, Refused
from meshes.errors import InputError

MAX_STEPS = 1000
_LONGEST = 200  # characters of a step

SPEED = Quantity(units.ANGULAR_SPEED, 1e-6, 1e6, or_zero=True)
RATE = Quantity(units.ANGULAR_ACCELERATION, 1e-9, 1e9)
TIME = Quantity(units.TIME, 1e-9, 1e9)

ALLOWED = (
    'a step: "to 90 rpm in 4 s", "to 1200 rpm at 60 rpm/s", "hold 10 s", "coast to 100 rpm" or "coast 20 s"'
)
_WORDS = ("to", "hold", "coast")
_TO = re.compile(r"to\b\s*(?P<speed>.*?)\s*\b(?P<how>in|at)\b\s*(?P<what>.*)", re.IGNORECASE)


@dataclass(frozen=True)
class Step:
    """One line of a programme, in SI units."""

    kind: Literal["to", "hold", "coast"]  #: "to" a speed, "hold" the speed, or "coast" without a motor
    speed: float | None = None  #: at its end, rad/s; None for a hold and for a coast of a given time
    #: at which it changes, rad/s^2, without a sign; None where a time is given, or none
    rate: float | None = None
    #: how long it lasts, s; None where speed and rate give it, and for a coast to a speed
    time: float | None = None

    def written(self) -> str:
        """The step as a file says it, in SI units; read again it is the same step."""
        if self.kind == "to":
            how = f"in {self.time!r} s" if self.rate is None else f"at {self.rate!r} rad/s^2"
            return f"to {self.speed!r} rad/s {how}"
        return f"coast to {self.speed!r} rad/s" if self.time is None else f"{self.kind} {self.time!r} s"

    def words(self) -> str:
        """The step for readers, in their units."""
        if self.kind == "to":
            assert self.speed is not None
            if self.rate is not None:
                return f"to {in_rpm(self.speed)} at {number(self.rate * RPM)} rpm/s"
            return f"to {in_rpm(self.speed)} in {_s(self.time or 0.0)}"
        if self.time is not None:
            return f"{self.kind} {_s(self.time)}"
        assert self.speed is not None
        return f"coast to {in_rpm(self.speed)}" if self.speed else "coast to a stand"


def _s(time: float) -> str:
    return f"{number(time)} s"


def parse_step(text: object, field: str = "step") -> Step:
    """A step from its line; `field` names the value in the `InputError`.

    >>> parse_step("hold 10 s"), parse_step("coast to 0").speed
    (Step(kind='hold', speed=None, rate=None, time=10.0), 0.0)
    """
    if isinstance(text, Step):
        return text
    if not isinstance(text, str) or len(text) > _LONGEST:
        raise InputError(field, str(text)[:_LONGEST], ALLOWED)
    line = " ".join(text.split())
    word, _, rest = line.partition(" ")
    kind = word.lower()
    if kind == "to":
        found = _TO.fullmatch(line)
        if found is None:
            raise InputError(field, text, f'{ALLOWED}; "to" needs "in" and a time or "at" and a rate')
        speed = _value(found["speed"], SPEED, "speed", text, field)
        if found["how"].lower() == "in":
            return Step("to", speed, time=_value(found["what"], TIME, "time", text, field))
        return Step("to", speed, _value(found["what"], RATE, "rate", text, field))
    if kind == "hold":
        return Step("hold", time=_value(rest, TIME, "time", text, field))
    if kind == "coast":
        way, _, speed_text = rest.partition(" ")
        if way.lower() == "to":
            return Step("coast", _value(speed_text, SPEED, "speed", text, field))
        return Step("coast", time=_value(rest, TIME, "time", text, field))
    raise InputError(field, text, f"{ALLOWED}{meant(kind, _WORDS)}")


def _value(given: str, rule: Quantity, name: str, text: str, field: str) -> float:
    """A quantity within a step."""
    if given == "0" and rule.or_zero:
        return 0.0
    try:
        return rule(given)
    except (InputError, Refused) as fault:
        raise InputError(field, text, f"{ALLOWED}; its {name} must be {fault.allowed}") from fault


class StepRule:
    """A line that is a step."""

    allowed = ALLOWED

    def __call__(self, value: object) -> Step:
        """The step."""
        return parse_step(value)


class StepList(Entries):
    """A list of steps."""

    @staticmethod
    def written(steps: tuple[Step, ...]) -> list[str]:
        """The steps of a programme as a file says them."""
        return [step.written() for step in steps]
