"""Numbers and ranges of speed as they are printed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from leblanc.units import MINUS as MINUS
from leblanc.units import NOT_FOUND as NOT_FOUND
from leblanc.units import RPM, ZERO_TO_PEAK
from leblanc.units import number as number

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
    own, holds = speed[order], mask[order]
    change = np.flatnonzero(np.diff(np.concatenate(([False], holds, [False]))))
    return _listed(list(zip(own[change[::2]].tolist(), own[change[1::2] - 1].tolist(), strict=True)))


def band_ranges(speed: NDArray[np.float64], bands: Sequence[tuple[float, float]]) -> str:
    """Bands of speed in words, alike.

    Parameters
    ----------
    speed : asked for, rad/s, shape (n,)
    bands : first and last speed of each, rad/s
    """
    if not bands:
        return "none"
    whole = len(bands) == 1 and bands[0][0] <= speed.min() and bands[0][1] >= speed.max()
    return "all speeds" if whole else _listed(bands)


def _listed(bands: Sequence[tuple[float, float]]) -> str:
    if len(bands) > MOST_RANGES:
        first, last = number(bands[0][0] * RPM), number(bands[-1][1] * RPM)
        return f"{len(bands)} ranges between {first} and {last} rpm"
    ends = [(number(low * RPM), number(high * RPM)) for low, high in bands]
    return "; ".join(low if low == high else f"{low} to {high}" for low, high in ends) + " rpm"


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
