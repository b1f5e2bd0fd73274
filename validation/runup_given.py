"""A run-up with one chamber against the figures of another code for the same machine."""

from __future__ import annotations

from leblanc.units import MM
from validation.case import Case, compare
from validation.runup_trends import GIVEN, LITRE, run

# The figures have three or four digits, and the other code's friction is 1.6 % weaker at half a litre.
_TOLERANCE = 0.012
_FRICTION = "the other friction brings a layer to rest at the rate k exactly, this one at k h R/A"
_SOURCE = "another code, validation/runup_trends.py"


def cases() -> list[Case]:
    """Peak, the speed there and the amplitude at the end, without liquid and with two frictions."""
    found = []
    for volume, rate, *given in GIVEN:
        point = run(volume, rate)
        name = f"{volume * LITRE:g}-l-{rate:g}"
        what = f"{volume * LITRE:g} l of water, friction {rate:g} 1/s" if volume else "no liquid"
        rows = (
            ("peak", "largest amplitude, mm", point.peak * MM),
            ("speed", "speed there, rad/s", point.peak_speed),
            ("end", "amplitude at the end, mm", point.last * MM),
        )
        for (kind, words, value), printed in zip(rows, given, strict=True):
            found.append(
                compare(
                    f"runup/{kind}-{name}",
                    _SOURCE,
                    f"{words}: {what}",
                    printed,
                    value,
                    tolerance=_TOLERANCE,
                    note=_FRICTION if volume else "",
                )
            )
    return found
