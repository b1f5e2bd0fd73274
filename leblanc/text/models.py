"""What each liquid model does and takes for granted, and how ranges of speed and errors are printed."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from leblanc.results.choice import ModelSpan
from leblanc.results.note import percent
from leblanc.units import RPM

# What the model does, and what it takes for granted.
MODELS = {
    "statics": (
        "The liquid rests in the turning drum; its surface is a paraboloid about the rotation axis.",
        "Left out: waves, self-excited whirl, surface tension.",
    ),
    "linear": (
        "Small waves on a rigidly turning ring, by the exact linear theory of plane frictionless flow.",
        "Taken for granted: a wet wall all round, small disturbances, one depth along the axis.",
    ),
    "long_wave": (
        "Long waves of any height, bores included, that keep mass and angular momentum.",
        "Taken for granted: a layer thin against its waves, one depth along the axis.",
    ),
    "kdv": (
        "One family of weakly nonlinear, dispersive waves that stand still as seen from the whirl.",
        "Taken for granted: whirl near the resonance of that family, low waves.",
    ),
    "fem": (
        "Small disturbances of the liquid, by finite elements on the section of the chamber.",
        "Taken for granted: plane frictionless flow, an undisturbed surface that is a circle.",
    ),
}

WHIRL = (
    "Free whirls of rotor and liquid together, by the exact linear theory of the plane layer with laminar or "
    "linear friction at its wall; shown is the whirl that grows most.",
    "Taken for granted: small whirls, a wet wall all round, one depth along the axis.",
)

BALLS = (
    "Stuck speeds and vibration are those of the lowest order in the balls' share of the moving mass; the "
    "critical speed and the integrated speeds come from the full equations in time.",
    "Taken for granted: balls that roll without sliding or touching, a shaft that keeps its speed, a "
    "platform that moves along one line, no gravity.",
)


def described(names: Iterable[str]) -> list[tuple[str, str]]:
    """Name of each model once, with what it does and takes for granted; nothing of one that is not known.

    Parameters
    ----------
    names : of models, in any order
    """
    return [(name, " ".join(MODELS.get(name, ()))) for name in dict.fromkeys(names)]


def speeds_words(span: ModelSpan) -> str:
    """First and last speed of a range, rpm; one where they are the same."""
    first, last = f"{span.first * RPM:.5g}", f"{span.last * RPM:.5g}"
    return first if first == last else f"{first} to {last}"


def error_words(span: ModelSpan) -> str:
    """Largest estimated error in a range of speeds."""
    if np.isfinite(span.error):
        return percent(span.error)
    return "not known" if np.isnan(span.error) else "without a bound"
