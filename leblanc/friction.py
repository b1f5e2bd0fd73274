"""Friction laws of the liquid on its chamber, as users name them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from leblanc.units import NUMBER, RATE, parse_option
from meshes.errors import InputError, require_not_negative

Law = Literal["none", "stokes", "linear", "quadratic"]
_WITHOUT: dict[str, Law] = {"none": "none", "stokes": "stokes"}
_WITH: dict[str, Law] = {"linear": "linear", "quadratic": "quadratic"}


@dataclass(frozen=True)
class Friction:
    """Friction of the liquid on its chamber.

    Parameters
    ----------
    law : "none", "stokes", "linear" or "quadratic"
    coefficient : 1/s for linear, a pure number for quadratic, 0 for the others
    """

    law: Law
    coefficient: float


def parse_friction(text: str, field: str) -> Friction:
    """Friction law typed on the command line: none, stokes, linear:RATE or quadratic:NUMBER.

    Raises
    ------
    InputError : no such law, a coefficient missing, misplaced or negative
    """
    law, colon, coefficient = text.partition(":")
    if law in _WITHOUT and not colon:
        return Friction(_WITHOUT[law], 0.0)
    if law in _WITH and coefficient:
        value = parse_option(coefficient, RATE if law == "linear" else NUMBER, field)
        require_not_negative(field, value)
        return Friction(_WITH[law], value)
    raise InputError(field, text, "none, stokes, linear:RATE or quadratic:NUMBER")


def friction_words(friction: Friction) -> str:
    """Law of the liquid's friction with its coefficient."""
    return {
        "none": "none",
        "stokes": "laminar (Stokes)",
        "linear": f"linear, {friction.coefficient:g} 1/s",
        "quadratic": f"quadratic, {friction.coefficient:g}",
    }[friction.law]
