"""A layer under a whirl in words."""

from __future__ import annotations

import cmath
import math

from leblanc.results.layer import LayerPeriodsResult, LayerResult, Number
from leblanc.text.numbers import number
from leblanc.units import MM


def summary(result: LayerResult) -> list[tuple[str, str]]:
    """The main numbers of a layer's answer, as labels and values."""
    return [
        ("Liquid model", result.case.model),
        ("Force ratio", _at_angle(result.force_ratio, 1.0, "")),
        ("Centre of mass", _at_angle(result.offset, MM, " mm")),
        ("Mean rotation in the drum", f"{number(result.mean_rotation)} rad/s"),
        *_validity(result.converged, result.in_range, result.validity),
    ]


def periods_summary(result: LayerPeriodsResult) -> list[tuple[str, str]]:
    """The main numbers of a layer from rest, as labels and values."""
    h = result.history
    if not h.time.size:
        return [("Liquid model", result.case.model), ("Answer", h.reason)]
    return [
        ("Liquid model", result.case.model),
        ("Whirl periods", f"{h.time.size}"),
        ("Force ratio of the last one", _at_angle(complex(h.force_ratio[-1]), 1.0, "")),
        ("Mean rotation in the drum", f"{number(float(h.mean_rotation[-1]))} rad/s"),
        *_validity(result.converged, result.in_range, result.validity),
    ]


def _validity(converged: bool, in_range: bool, numbers: tuple[Number, ...]) -> list[tuple[str, str]]:
    """Whether there is an answer that holds."""
    wrong = "; ".join(str(one) for one in numbers if not one.in_range)
    held = "yes" if in_range else wrong or "no"
    return [("Converged", "yes" if converged else "no"), ("Model in range", held)]


def _at_angle(value: complex, factor: float, unit: str) -> str:
    """Size and angle from the deflection."""
    if not cmath.isfinite(value):
        return "not found"
    angle = f"{math.degrees(cmath.phase(value)):.0f} deg from the deflection"
    return f"{number(abs(value) * factor)}{unit} at {angle}"
