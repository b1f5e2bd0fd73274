"""Roots inside a bracket, many at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def bracketed_root(
    function: Callable[[Array, NDArray[np.intp]], Array],
    low: Array,
    high: Array,
    relative: float = 4.0 * np.finfo(float).eps,
    iterations: int = 200,
) -> tuple[Array, NDArray[np.bool_]]:
    """Root of each of n functions between the ends of its bracket, by Illinois steps and bisection.

    Every step shrinks the bracket; every third one halves it, so that the worst case is bisection's.

    Parameters
    ----------
    function : takes points, shape (m,), and which of the n functions each belongs to, shape (m,); returns
        values, shape (m,), of opposite sign at the two ends
    low, high : the brackets, shape (n,)
    relative : bracket width over its larger end at which a root counts as found
    iterations : most steps

    Returns
    -------
    root : shape (n,); an end of the bracket where the function does not change sign
    found : shape (n,), False where it does not, or where the steps ran out
    """
    low, high = low.astype(float), high.astype(float)
    everyone = np.arange(low.size)
    at_low, at_high = function(low, everyone), function(high, everyone)
    root = np.where(np.abs(at_low) <= np.abs(at_high), low, high)
    found = (at_low == 0.0) | (at_high == 0.0)
    active = everyone[~found & (np.sign(at_low) != np.sign(at_high))]
    for step in range(iterations):
        if active.size == 0:
            break
        a, b, fa, fb = low[active], high[active], at_low[active], at_high[active]
        middle = 0.5 * (a + b)
        secant = a + (b - a) * (fa / (fa - fb))
        x = np.where((step % 3 == 2) | ~((secant > a) & (secant < b)), middle, secant)
        fx = function(x, active)
        left = np.sign(fx) == np.sign(fa)
        # Illinois: the end that stays is given half its value, or the secant would creep.
        low[active], at_low[active] = np.where(left, x, a), np.where(left, fx, 0.5 * fa)
        high[active], at_high[active] = np.where(left, b, x), np.where(left, 0.5 * fb, fx)
        root[active] = x
        width = np.abs(high[active] - low[active])
        scale = np.maximum(np.abs(high[active]), np.abs(low[active]))
        done = (fx == 0.0) | (width <= relative * scale)
        found[active[done]] = True
        active = active[~done]
    return root, found
