"""A tub that touches its cabinet: what a clearance makes of the draws that were run without one.

Below the clearance a tub shakes its cabinet through the soft suspension, beyond it through the contact. The
run-ups know no contact: their passage stands for the deflection that the tub would have.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from meshes.arrays import Array, Index
from validation.cases.fill_sweep.fitted import Answers, kept, measured, ratios

CLEARANCES = 200  # that are tried with each draw
FALLS = 0.999  # a passage of the last fill over the first above which no clearance lies between them


@dataclass(frozen=True)
class Contact:
    """Shaking at the resonance over the first fill, fitted to the last: n pairs of a draw and a clearance."""

    shaking: Array  #: shape (n, f)
    draw: Index  #: number of the draw, shape (n,)
    clearance: Array  #: over the deflection with the first fill, shape (n,)

    def within(self, seen: Array, factor: float) -> float:
        """Share of pairs that meet all fills between the fitted ones, (f,), within a factor above 1."""
        off = np.abs(np.log(self.shaking / seen))[:, 1:-1]
        return float(np.mean((off <= np.log(factor)).all(axis=1)))

    def steps(self, seen: Array) -> Array:
        """Share of the pairs below the geometric mean of both ends with each measured fill, shape (f,)."""
        first = np.argmax(self.shaking < np.sqrt(seen[0] * seen[-1]), axis=1)
        return np.asarray(np.bincount(first, minlength=seen.size) / first.size)

    def bands(self) -> Array:
        """A twentieth, the half and nineteen twentieths of the pairs are below, shape (3, f)."""
        return np.asarray(np.quantile(self.shaking, (0.05, 0.5, 0.95), axis=0))

    def closest(self, seen: Array) -> int:
        """Number of the pair that comes closest to all measured fills, shape (f,)."""
        return int(np.argmin(np.square(np.log(self.shaking / seen)).sum(axis=1)))


def touching(passage: Array, clearance: Array, last: float) -> Array:
    """Shaking over that of the first fill, its contact so stiff that the last fill is met, shape (n, f).

    `passage` is the deflection over that of the first fill, (n, f); the clearance lies between the last and
    the first of them, (n,); `last` is measured.
    """
    stiff = (passage[:, -1] / last - 1.0) / (1.0 - clearance)
    shaking = passage + stiff[:, None] * np.maximum(passage - clearance[:, None], 0.0)
    return np.asarray(shaking / shaking[:, :1])


def allowed(answers: Answers, last: float) -> Contact:
    """Draws whose deflection falls from the first to the last fill, with clearances between the two."""
    passage = ratios(answers)[0]
    falls = np.flatnonzero((passage[:, -1] < FALLS) & (passage[:, -1] > last))
    part = (np.arange(CLEARANCES) + 0.5) / CLEARANCES
    draw = np.repeat(falls, CLEARANCES)
    least = passage[draw, -1]
    clearance = least + (1.0 - least) * np.tile(part, falls.size)
    return Contact(touching(passage[draw], clearance, last), draw, clearance)


@cache
def of_kept() -> Contact:
    """What the kept draws allow."""
    return allowed(kept()[0], float(measured()[1][-1]))
