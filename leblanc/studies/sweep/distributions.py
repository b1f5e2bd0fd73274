"""Distributions of a varied value by their inverse functions, and how a study file writes them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from leblanc import units
from leblanc.scene.schema.rules import Entries, Quantity, Refused, Whole
from meshes.arrays import Array
from meshes.errors import InputError

MAX_LEVELS = 1_000_000
MAX_CHOICES = 1000

_INSIDE = (2.0**-54, 1.0 - 2.0**-53)  # where every inverse distribution function is finite


@dataclass(frozen=True)
class Uniform:
    """Evenly spread from `low` to `high`."""

    low: float
    high: float

    def at(self, u: Array) -> Array:
        """Value below which the share u lies [theory: sampling, eq. 1]."""
        return np.asarray(self.low + (self.high - self.low) * u)


@dataclass(frozen=True)
class Normal:
    """Gauss's bell around `mean` with a standard deviation."""

    mean: float
    deviation: float

    def at(self, u: Array) -> Array:
        """Value below which the share u lies [theory: sampling, eq. 2]."""
        return np.asarray(self.mean + self.deviation * _standard_normal(u))


@dataclass(frozen=True)
class LogNormal:
    """Its logarithm is normal: two thirds lie within `factor` of the `median`, up and down."""

    median: float
    factor: float

    def at(self, u: Array) -> Array:
        """Value below which the share u lies [theory: sampling, eq. 3]."""
        return np.asarray(self.median * np.exp(math.log(self.factor) * _standard_normal(u)))


@dataclass(frozen=True)
class Choice:
    """One of a few values, each as likely.

    Parameters
    ----------
    options : as a scene writes them; a quantity in SI
    """

    options: tuple[Any, ...]

    @property
    def words(self) -> bool:
        """Some option is no number."""
        return not all(isinstance(one, float | int) for one in self.options)

    def at(self, u: Array) -> Array:
        """Number of the option at the share u [theory: sampling, eq. 4]."""
        return np.minimum(np.floor(u * len(self.options)), len(self.options) - 1.0)

    def levels(self) -> Array:
        """Numbers of all options."""
        return np.arange(len(self.options), dtype=np.float64)


@dataclass(frozen=True)
class Levels:
    """Evenly spaced values of a grid, both ends among them."""

    first: float
    last: float
    count: int

    def levels(self) -> Array:
        """All values."""
        return np.linspace(self.first, self.last, self.count)


Distribution = Uniform | Normal | LogNormal | Choice | Levels


def _standard_normal(u: Array) -> Array:
    """Quantiles of the standard normal distribution."""
    from scipy.special import ndtri

    return np.asarray(ndtri(np.clip(u, *_INSIDE)))


def read_distribution(kind: str, given: Any, rule: Any) -> Distribution:
    """Distribution as a study file writes it.

    Parameters
    ----------
    kind : a key of `KINDS`
    given : what stands behind it in the file
    rule : of the varied field

    Raises
    ------
    Refused, InputError : the values do not make a distribution of this field
    """
    return KINDS[kind](given, rule)


def _quantity(rule: Any, kind: str) -> Quantity:
    """The rule of a field that takes any number between bounds."""
    if not isinstance(rule, Quantity):
        raise Refused(f"choice, since the field must be {rule.allowed}: it has no {kind}")
    return rule


def _several(given: Any, count: int, what: str) -> list[Any]:
    return list(Entries(count, count, what)(given))


def _uniform(given: Any, rule: Any) -> Uniform:
    rule = _quantity(rule, "uniform")
    low, high = map(rule, _several(given, 2, f"values, lowest and highest, each {rule.allowed}"))
    if low >= high:
        raise Refused("a lowest value below the highest")
    return Uniform(low, high)


def _normal(given: Any, rule: Any) -> Normal:
    rule = _quantity(rule, "normal")
    mean, spread = _several(given, 2, f"values, mean and standard deviation, each {rule.allowed}")
    deviation = units.parse(spread, rule.dimension)
    if deviation <= 0.0:
        raise Refused("a mean and a standard deviation above 0")
    return Normal(rule(mean), deviation)


def _lognormal(given: Any, rule: Any) -> LogNormal:
    rule = _quantity(rule, "lognormal")
    middle, spread = _several(given, 2, f"values, median and factor; the median {rule.allowed}")
    median, factor = rule(middle), Quantity(units.NUMBER, 1.0, 1e6)(spread)
    if median <= 0.0 or factor <= 1.0:
        raise Refused("a median above 0 and a factor above 1")
    return LogNormal(median, factor)


def _choice(given: Any, rule: Any) -> Choice:
    options = Entries(1, MAX_CHOICES, f"values, each {rule.allowed}")(given)
    checked = [rule(option) for option in options]
    return Choice(tuple(checked) if isinstance(rule, Quantity) else tuple(options))


def _linspace(given: Any, rule: Any) -> Levels:
    rule = _quantity(rule, "linspace")
    first, last, count = _several(
        given, 3, f"values, first, last and how many; first and last {rule.allowed}"
    )
    levels = Levels(rule(first), rule(last), Whole(2, MAX_LEVELS)(count))
    if levels.first == levels.last:
        raise Refused("two different ends")
    return levels


KINDS: dict[str, Callable[[Any, Any], Distribution]] = {
    "uniform": _uniform,
    "normal": _normal,
    "lognormal": _lognormal,
    "choice": _choice,
    "linspace": _linspace,
}

# How a study file writes each, and what it means.
FORMS: dict[str, tuple[str, str]] = {
    "uniform": ("{ uniform = [low, high] }", "evenly spread between the two"),
    "normal": ("{ normal = [mean, deviation] }", "Gauss's bell with that mean and standard deviation"),
    "lognormal": (
        "{ lognormal = [median, factor] }",
        "two thirds within that factor of the median",
    ),
    "choice": ("{ choice = [a, b, ...] }", "each as likely; the only one for words; in a grid all of them"),
    "linspace": (
        "{ linspace = [first, last, count] }",
        "evenly spaced, with both ends; only in a grid",
    ),
}

REFUSALS = (Refused, InputError)
