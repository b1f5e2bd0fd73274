"""Numbers and ranges of speed as they are printed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from leblanc.core.units import MINUS as MINUS
from leblanc.core.units import NOT_FOUND as NOT_FOUND
from leblanc.core.units import RPM, ZERO_TO_PEAK
from leblanc.core.units import number as number

MOST_RANGES = 4  # listed one by one


def ranges(speed: NDArray[np.float64], mask: NDArray[np.bool_]) -> str:
    """Speeds at which a condition holds, in words.

    Parameters
    ----------
    speed : rad/s, in any order, shape (n,)
    mask : the condition, shape (n,)
    """
    if not mask.any():
        return "none"
    if mask.all():
        return "all speeds"
    order = np.argsort(speed, kind="stable")
    rpm, holds = speed[order] * RPM, mask[order]
    change = np.flatnonzero(np.diff(np.concatenate(([False], holds, [False]))))
    first, last = rpm[change[::2]], rpm[change[1::2] - 1]
    if first.size > MOST_RANGES:
        return f"{first.size} ranges between {number(first[0])} and {number(last[-1])} rpm"
    pairs = zip(first.tolist(), last.tolist(), strict=True)
    parts = [number(a) if a == b else f"{number(a)} to {number(b)}" for a, b in pairs]
    return "; ".join(parts) + " rpm"


def amplitudes_are(place: str = "") -> tuple[str, str]:
    """What the amplitudes of an answer are, as label and value.

    Parameters
    ----------
    place : where along the axis; empty for a rotor that moves in one plane
    """
    return "Amplitudes", f"{ZERO_TO_PEAK}{', ' if place else ''}{place}"


def amplitude_sentence(place: str = "") -> str:
    """The same as a sentence."""
    return f"{' are '.join(amplitudes_are(place))}."
