"""Whether a whirl mode was missed: the argument principle on what the modes found leave of the determinant.

A characteristic function f, real on the real axis and analytic but for cuts, has as many zeros right of a
path as its phase falls short of that at infinity [theory: whirl, eq. 19]. Divided by the modes that are known
it has no steep places near them, so that few points serve, and what is counted is what was missed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex, Flags, Index

_STEP = (
    1.2  # of |h f'/f| and of the phase between two points: no zero lies close beside the line between them
)
_ROUNDS = 48
_FAR = 1e5  # over the highest frequency: where the phase is that at infinity
_WHOLE = 0.2  # distance of a count from a whole number
_LIP = 1e-9  # over the spin: how far the path stays off a cut
_FIRST = np.geomspace(1e-3, 1.0, 7)  # over a frequency, of the first points below and above it

# Takes points, shape (k,), and which of the n problems each belongs to, (k,); returns f over its size, log of
# its size, and f'/f, each (k,).
Characteristic = Callable[[Complex, Index], tuple[Complex, Array, Complex]]


@dataclass(frozen=True)
class Region:
    """Right of a line, without the cuts that end at two conjugate points and run from there to the left.

    Parameters
    ----------
    line : real part of the line, 1/s, shape (n,)
    tip : imaginary part of the end of the upper cut, 0 or above, rad/s, shape (n,)
    scale : a frequency of the problem, rad/s, above 0, shape (n,)
    far : beyond which the function goes as its highest power but for some per cent, rad/s, shape (n,)
    """

    line: Array
    tip: Array
    scale: Array
    far: Array


def missed_modes(function: Characteristic, degree: int, known: Complex, region: Region) -> Array:
    """How many modes of a region are not among those known [theory: whirl, eq. 19].

    Parameters
    ----------
    function : the characteristic function
    degree : power of lambda it goes with far away
    known : modes, with or without their conjugates, nan where there is none, 1/s, shape (n, m)
    region : where to count

    Returns
    -------
    Their number, a conjugate pair counts as two, shape (n,); nan where the phase could not be followed
    """
    pairs, alone = _upper(known, region.scale)
    path, owner = _path(pairs, region)
    rise, sure = _phase(_Deflated(function, pairs, alone), path, owner, region.scale)
    held = 2 * np.isfinite(pairs).sum(axis=1) + np.isfinite(alone).sum(axis=1)
    count = 0.5 * (degree - held) - rise / np.pi
    whole = np.round(count)
    return np.where(sure & (np.abs(count - whole) <= _WHOLE), whole, np.nan)


def _upper(known: Complex, scale: Array) -> tuple[Complex, Complex]:
    """Of the modes those above the real axis, each once and standing for its conjugate, and the real ones."""
    near = 1e-6 * scale[:, None]
    above, below, real = known.imag > near, known.imag < -near, np.abs(known.imag) <= near
    nothing = complex(np.nan, np.nan)
    upper = np.where(above, known, nothing)
    mirrored = np.where(below, known.conj(), nothing)
    gap = np.abs(mirrored[:, :, None] - upper[:, None, :])
    twin = (gap <= 1e-6 * (np.abs(mirrored)[:, :, None] + scale[:, None, None])).any(axis=2)
    lower = np.where(twin, nothing, mirrored)
    return np.concatenate([upper, lower], axis=1), np.where(real, known.real + 0j, nothing)


def _path(pairs: Complex, region: Region) -> tuple[Complex, Index]:
    """Points of polylines from the real axis upwards to far away, one after the other, and whose they are.

    Left of the end of a cut the path goes along its lower side to the end and back along the upper one.
    """
    paths, owners = [], []
    for k in range(region.line.size):
        left, tip, size = (float(part[k]) for part in (region.line, region.tip, region.scale))
        own = np.unique(pairs[k].imag[np.isfinite(pairs[k])])
        far = _FAR * max(float(region.far[k]), size, float(own[-1]) if own.size else 0.0)
        around = [size * (1.0 + _FIRST), size * (1.0 - _FIRST), [size], own]
        height = np.concatenate([*around, np.geomspace(1e-3 * size, far, 24)])
        height = np.unique(height[height > 0.0])
        lip, end = _LIP * size, 1j * tip
        back = left * (1.0 - _FIRST)
        if left >= 0.0:
            parts = [[left], left + 1j * height]
        elif tip == 0.0:
            parts = [[0.0], back[::-1] + 1j * lip, left + 1j * height[height > lip]]
        else:
            below, above = height[height < tip - lip], height[height > tip + lip]
            parts = [
                *([left], left + 1j * below, [left + end - 1j * lip], back + end - 1j * lip),
                *([end], back[::-1] + end + 1j * lip, [left + end + 1j * lip], left + 1j * above),
            ]
        points = np.concatenate(parts).astype(complex)
        paths.append(points)
        owners.append(np.full(points.size, k, dtype=np.intp))
    return np.concatenate(paths), np.concatenate(owners)


@dataclass(frozen=True)
class _Deflated:
    """A characteristic function over the modes that are known."""

    function: Characteristic
    pairs: Complex
    alone: Complex

    def at(self, points: Complex, owner: Index) -> tuple[Array, Array, Complex]:
        """Phase, log of the size, and f'/f, at points of problems, each of shape (k,)."""
        unit, size, slope = self.function(points, owner)
        phase, slope = np.angle(unit), slope.copy()
        size = size.copy()
        for known in (self.pairs, self.pairs.conj(), self.alone):
            gap = points[:, None] - known[owner]
            there = np.isfinite(gap)
            gap = np.where(there, gap, 1.0)
            phase = phase - np.angle(gap).sum(axis=1)
            size = size - np.log(np.abs(gap)).sum(axis=1)
            slope = slope - np.where(there, 1.0 / gap, 0.0).sum(axis=1)
        return phase, size, slope


def _phase(function: _Deflated, points: Complex, own: Index, scale: Array) -> tuple[Array, Flags]:
    """Rise of the phase along each path, and whether it could be followed, shape (n,)."""
    values = function.at(points, own)
    joined = np.flatnonzero(own[1:] == own[:-1])
    start, end, which = points[joined], points[joined + 1], own[joined]
    at_start, at_end = ([part[joined + k] for part in values] for k in (0, 1))
    rise, sure = np.zeros(scale.size), np.ones(scale.size, dtype=bool)
    for _ in range(_ROUNDS):
        step = np.abs(end - start)
        turn = np.remainder(at_end[0] - at_start[0] + np.pi, 2.0 * np.pi) - np.pi
        steep = np.maximum(np.abs(at_start[2]), np.abs(at_end[2])) * step
        change = np.abs(at_end[1] - at_start[1])
        smooth = (steep <= _STEP) & (np.abs(turn) <= _STEP) & (change <= _STEP)
        np.add.at(rise, which[smooth], turn[smooth])
        left = ~smooth
        # Where the path comes so close to a zero that rounding decides, nothing is known.
        tiny = left & ~(step > 1e-12 * (scale[which] + np.abs(start)))
        sure[which[tiny]] = False
        left &= sure[which]
        if not left.any():
            return rise, sure
        start, end, which = start[left], end[left], which[left]
        at_start, at_end = ([part[left] for part in values] for values in (at_start, at_end))
        middle = 0.5 * (start + end)
        at_middle = function.at(middle, which)
        start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
        which = np.concatenate([which, which])
        at_start, at_end = (
            [np.concatenate(pair) for pair in zip(*both, strict=True)]
            for both in ((at_start, at_middle), (at_middle, at_end))
        )
    sure[which] = False
    return rise, sure
