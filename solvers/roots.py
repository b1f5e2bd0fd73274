"""Roots inside a bracket, many at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array


def bracketed_root(
    function: Callable[[Array, NDArray[np.intp]], Array],
    low: Array,
    high: Array,
    relative: float = 4.0 * np.finfo(float).eps,
    iterations: int = 200,
) -> tuple[Array, NDArray[np.bool_]]:
    """Root of each of n functions between the ends of its bracket, and whether it was found [Chandrupatla97].

    `function` takes points and which of the n functions each belongs to, shape (m,). Steps by inverse
    quadratic interpolation where the last three points allow it, otherwise by halving, until the bracket is
    `relative` of its larger end. Without a change of sign the root is an end of the bracket.
    """
    # The newest point, the one across the root from it, and the one before.
    new, across = low.astype(float), high.astype(float)
    everyone = np.arange(new.size)
    at_new, at_across = function(new, everyone), function(across, everyone)
    root = np.where(np.abs(at_new) <= np.abs(at_across), new, across)
    found = (at_new == 0.0) | (at_across == 0.0)
    active = everyone[~found & (np.sign(at_new) != np.sign(at_across))]
    points = _Points(*(x[active] for x in (new, across, new, at_new, at_across, at_new)))
    share = np.full(active.size, 0.5)
    for _ in range(iterations):
        if active.size == 0:
            break
        x = points.new + share * (points.across - points.new)
        points = points.step(x, function(x, active))
        best = np.abs(points.at_new) <= np.abs(points.at_across)
        root[active] = np.where(best, points.new, points.across)
        width = np.abs(points.across - points.new)
        least = 0.5 * relative * np.maximum(np.abs(points.new), np.abs(points.across))
        done = (points.at_new == 0.0) | (width <= 2.0 * least)
        found[active[done]] = True
        keep = ~done
        active, points = active[keep], points.at(keep)
        share = points.share(least[keep] / width[keep])
    return root, found


class _Points(NamedTuple):
    """Three points of each function and its values there; the root is between the first two."""

    new: Array
    across: Array
    before: Array
    at_new: Array
    at_across: Array
    at_before: Array

    def at(self, which: NDArray[np.bool_]) -> _Points:
        """Points of some functions."""
        return _Points(*(x[which] for x in self))

    def step(self, x: Array, fx: Array) -> _Points:
        """Points with a further one inside the bracket."""
        same = np.sign(fx) == np.sign(self.at_new)
        return _Points(
            new=x,
            across=np.where(same, self.across, self.new),
            before=np.where(same, self.new, self.across),
            at_new=fx,
            at_across=np.where(same, self.at_across, self.at_new),
            at_before=np.where(same, self.at_new, self.at_across),
        )

    def share(self, least: Array) -> Array:
        """How far from the newest point towards the one across it the next one lies, 0 to 1."""
        a, b, c, fa, fb, fc = self
        xi, phi = _over(a - b, c - b), _over(fa - fb, fc - fb)
        curved = (np.square(phi) < xi) & (np.square(1.0 - phi) < 1.0 - xi)
        inverse = _over(fa, fb - fa) * _over(fc, fb - fc)
        inverse += _over(c - a, b - a) * _over(fa, fc - fa) * _over(fb, fc - fb)
        return np.clip(np.where(curved, inverse, 0.5), least, 1.0 - least)


def _over(numerator: Array, denominator: Array) -> Array:
    """Quotient; 0 over 0."""
    return np.divide(numerator, denominator, out=np.zeros_like(numerator), where=denominator != 0.0)
