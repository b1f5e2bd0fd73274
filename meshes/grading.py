"""Points along a line whose distance grows from its ends."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def graded(
    length: float, largest: float, start: float, end: float, growth: float = 1.5, least: int = 1
) -> Array:
    """Divide a line into steps that grow from both ends.

    The step at a point is the least of `largest` and what has grown from either end. The steps are stretched
    or shrunk alike, so that a whole number of them fills the line.

    Parameters
    ----------
    length : of the line, above 0
    largest : the longest step
    start, end : steps at the ends, at most; above `largest` they have no effect
    growth : ratio of neighbouring steps, at most, above 1
    least : smallest number of steps

    Returns
    -------
    Positions from 0 to `length`, rising, shape (steps + 1,).
    """
    slope = math.log(growth)
    # A step that starts where steps are `start` long, and grows on its way, ends that much shorter.
    shorter = slope / (growth - 1.0)
    start, end = min(start * shorter, largest), min(end * shorter, largest)
    # The step is start + slope x, then `largest` if there is room, then end + slope (length - x).
    rise, fall = (largest - start) / slope, length - (largest - end) / slope
    if rise > fall:
        rise = fall = 0.5 * (length + (end - start) / slope)
        rise = fall = min(max(rise, 0.0), length)
    rising = math.log1p(slope * rise / start) / slope
    level = (fall - rise) / largest
    falling = math.log1p(slope * (length - fall) / end) / slope
    total = rising + level + falling
    steps = max(least, math.ceil(total * (1.0 - 1e-9)))
    at = total * np.arange(steps + 1) / steps
    x = rise + (at - rising) * largest
    x = np.where(at < rising, start * np.expm1(slope * np.minimum(at, rising)) / slope, x)
    back = np.minimum(total - at, falling)
    x = np.where(total - at < falling, length - end * np.expm1(slope * back) / slope, x)
    x[0], x[-1] = 0.0, length
    return np.asarray(x)
