"""Friction laws of the liquid on its chamber, as users type and read them."""

from __future__ import annotations

from fluid.friction import Friction, FrictionLaw
from leblanc.units import NUMBER, RATE, parse_option
from meshes.errors import InputError, require_not_negative


def parse_friction(text: str, field: str) -> Friction:
    """Friction law typed on the command line: none, stokes, linear:RATE or quadratic:NUMBER.

    Raises
    ------
    InputError : no such law, a coefficient missing, misplaced or negative
    """
    law, colon, coefficient = text.partition(":")
    if law in (FrictionLaw.NONE, FrictionLaw.STOKES) and not colon:
        return Friction(FrictionLaw(law))
    if law in (FrictionLaw.LINEAR, FrictionLaw.QUADRATIC) and coefficient:
        unit = RATE if law == FrictionLaw.LINEAR else NUMBER
        value = parse_option(coefficient, unit, field)
        require_not_negative(field, value)
        return Friction(FrictionLaw(law), value)
    raise InputError(field, text, "none, stokes, linear:RATE or quadratic:NUMBER")


def friction_words(friction: Friction) -> str:
    """Law of the liquid's friction with its coefficient."""
    return {
        FrictionLaw.NONE: "none",
        FrictionLaw.STOKES: "laminar (Stokes)",
        FrictionLaw.LINEAR: f"linear, {friction.coefficient:g} 1/s",
        FrictionLaw.QUADRATIC: f"quadratic, {friction.coefficient:g}",
    }[friction.law]
