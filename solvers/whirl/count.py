"""Whether a whirl mode was missed: the argument principle on the determinant over the modes found.

A characteristic function f, real on the real axis and analytic but for cuts, has as many zeros right of a
path as its phase falls short of that at infinity [theory: whirl, eq. 19]. Over the known modes it is smooth
near them: few points serve, and the count is that of the missed ones.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array, Complex, Flags, Index

_STEP = 1.2  # most change of log f from the middle of a step to its ends
_BEND = 0.6  # most difference between both: no zeros, not two alike either, are close to the step
_ROUNDS = 48
_CROWD = 256  # steps of one path still halved, of which twenty are usual: there the phase is rounding's
_FAR = 1e5  # over the highest frequency: where the phase is that at infinity
_WHOLE = 0.2  # distance of a count from a whole number
_LIP, _END = 1e-9, 1e-8  # over the spin: how far the path stays off a cut and its end
_ALIKE = 0.01  # of the distance of a rough mode from the line: two of them so near to one another are one
_BLOCK = 512  # points whose arrays fit the processor's cache
_FIRST = np.array([1e-2, 1.0])  # over a frequency, of the first points below and above it

# Takes points, shape (k,), and which of the n problems each belongs to, (k,); returns log f, (k,).
Characteristic = Callable[[Complex, Index], Complex]


@dataclass(frozen=True)
class Region:
    """Right of a line, without the cuts that end at conjugate points and run from there to the left."""

    line: Array  #: real part of the line, 1/s, shape (n,)
    tips: Array  #: imaginary parts of the ends of cuts, from 0 upwards, rad/s, shape (n, c)
    scale: Array  #: a frequency of the problem, rad/s, above 0, shape (n,)
    #: beyond which the function goes as its highest power but for some per cent, rad/s, shape (n,)
    far: Array


def missed_modes(
    function: Characteristic, degree: int, known: Complex, region: Region, rough: Complex | None = None
) -> Array:
    """How many modes of a region are not among those known [theory: whirl, eq. 19].

    A conjugate pair counts as two; nan where the phase could not be followed. Far away f goes as
    lambda^`degree`. `rough`: what is near modes above the real axis and left of the line: it makes smooth
    what is followed, as known modes do. From afar it would hide a mode right of the line, as both together
    make a whole turn: the path has points beside each, from which a part of that shows.
    """
    if region.line.size == 0:
        return np.zeros(0)
    pairs, alone = _upper(known, region.scale)
    beside = np.zeros((len(pairs), 0))
    if rough is not None:
        away = 0.5 * (region.line[:, None] - rough.real)
        beside, own = np.hstack([rough.imag - away, rough.imag + away]), np.hstack([away, away])
        order = np.argsort(beside, axis=1)
        beside, own = np.take_along_axis(beside, order, axis=1), np.take_along_axis(own, order, axis=1)
        # Those of two that are alike serve both.
        beside[:, 1:][np.diff(beside, axis=1) < _ALIKE * own[:, 1:]] = np.nan
        pairs = packed(np.hstack([pairs, rough]))
    path, owner = _path(pairs, region, beside)
    rise, sure = _phase(_Deflated(function, pairs, alone, region.scale), path, owner, region.scale)
    held = 2 * np.isfinite(pairs).sum(axis=1) + np.isfinite(alone).sum(axis=1)
    count = 0.5 * (degree - held) - rise / np.pi
    whole = np.round(count)
    return np.where(sure & (np.abs(count - whole) <= _WHOLE), whole, np.nan)


def _upper(known: Complex, scale: Array) -> tuple[Complex, Complex]:
    """Modes above the real axis, each once and standing for its conjugate, and the real ones."""
    near = 1e-6 * scale[:, None]
    above, below, real = known.imag > near, known.imag < -near, np.abs(known.imag) <= near
    nothing = complex(np.nan, np.nan)
    upper = np.where(above, known, nothing)
    mirrored = np.where(below, known.conj(), nothing)
    gap = np.abs(mirrored[:, :, None] - upper[:, None, :])
    twin = (gap <= 1e-6 * (np.abs(mirrored)[:, :, None] + scale[:, None, None])).any(axis=2)
    lower = np.where(twin, nothing, mirrored)
    return packed(np.hstack([upper, lower])), packed(np.where(real, known.real + 0j, nothing))


def packed(values: Complex) -> Complex:
    """Rows with their finite entries first, without the columns that no row needs."""
    finite = np.isfinite(values)
    order = np.argsort(~finite, axis=1, kind="stable")
    return np.take_along_axis(values, order, axis=1)[:, : finite.sum(axis=1).max(initial=0)]


def _path(pairs: Complex, region: Region, beside: Array) -> tuple[Complex, Index]:
    """Points of polylines from the real axis upwards to far away, one after the other, and whose they are.

    Also at heights `beside`, nan in place of some, shape (n, r).

    Left of the end of a cut the path goes along its lower side to the end and back along the upper one.
    """
    scale = region.scale
    fastest = np.where(np.isfinite(pairs), pairs.imag, 0.0).max(axis=1, initial=0.0)
    far = _FAR * np.maximum(region.far, np.maximum(fastest, scale))
    around = np.outer(scale, np.unique(np.concatenate([1.0 + _FIRST, 1.0 - _FIRST, [1.0]])))
    height = np.sort(np.hstack([around, np.geomspace(1e-2 * scale, far, 8).T, beside]), axis=1)
    left, low, past = region.line[:, None], _LIP * scale[:, None], _END * scale[:, None]
    cut = left < past
    back = left * (1.0 - _FIRST)
    passed, parts = np.zeros_like(left), [left + 0.0j]
    for tip in region.tips.T[:, :, None]:
        inside = cut & (tip > 0.0)
        between = np.where(inside & (height > passed) & (height < tip - low), left + 1j * height, np.nan)
        down, up = 1j * (tip - low), 1j * (tip + low)
        parts += [between, *(np.where(inside, part + down, np.nan) for part in (left, back, past))]
        parts[0] = np.where(cut & (tip == 0.0), past + 0.0j, parts[0])
        parts += [np.where(cut, part + up, np.nan) for part in (past, back[:, ::-1], left)]
        passed = np.where(cut, tip + low, passed)
    parts.append(np.where(height > passed, left + 1j * height, np.nan))
    points = np.hstack(parts)
    there = ~np.isnan(points)
    return points[there], np.nonzero(there)[0]


@dataclass(frozen=True)
class _Deflated:
    """A characteristic function over the modes that are known."""

    function: Characteristic
    pairs: Complex
    alone: Complex
    scale: Array  #: as of `Region`

    def at(self, points: Complex, owner: Index) -> Complex:
        """log f at points of problems, shape (k,)."""
        found = np.empty(points.shape, dtype=complex)
        for first in range(0, points.size, _BLOCK):
            cut = slice(first, first + _BLOCK)
            found[cut] = self._some(points[cut], owner[cut])
        return found

    def _some(self, points: Complex, owner: Index) -> Complex:
        """As `at`; one logarithm of all factors over their sizes: by how many turns it is off, none asks."""
        size = np.abs(points) + self.scale[owner]
        over = (1.0 / size)[:, None]
        at, pairs, alone = points[:, None] * over, self.pairs[owner] * over, self.alone[owner] * over
        product, power = np.ones(points.shape, dtype=complex), np.zeros(points.shape)
        for gap, zeros in (((at - pairs) * (at - pairs.conj()), 2), (at - alone, 1)):
            absent = np.isnan(gap)
            gap[absent] = 1.0
            product *= gap.prod(axis=1)
            power += zeros * (gap.shape[1] - absent.sum(axis=1))
        return np.asarray(self.function(points, owner) - np.log(product) - power * np.log(size))


def _phase(function: _Deflated, points: Complex, own: Index, scale: Array) -> tuple[Array, Flags]:
    """Rise of the phase along each path, and whether it could be followed, shape (n,).

    A step counts where log f changes little and evenly from its start to its middle to its end, unlike about
    a zero, whatever its length; others are halved.
    """
    value = function.at(points, own)
    joined = np.flatnonzero(own[1:] == own[:-1])
    start, end, which = points[joined], points[joined + 1], own[joined]
    at_start, at_end = value[joined], value[joined + 1]
    rise, sure = np.zeros(scale.size), np.ones(scale.size, dtype=bool)
    for _ in range(_ROUNDS):
        middle = 0.5 * (start + end)
        at_middle = function.at(middle, which)
        first, second = _change(at_start, at_middle), _change(at_middle, at_end)
        even = (np.abs(first) <= _STEP) & (np.abs(second) <= _STEP) & (np.abs(first - second) <= _BEND)
        np.add.at(rise, which[even], (first + second).imag[even])
        # Where the path comes so close to a zero that rounding decides, nothing is known.
        tiny = ~even & ~(np.abs(end - start) > 1e-12 * (scale[which] + np.abs(start)))
        sure[which[tiny]] = False
        sure &= np.bincount(which[~even], minlength=sure.size) <= _CROWD
        left = ~even & sure[which]
        if not left.any():
            return rise, sure
        start, end = np.concatenate([start[left], middle[left]]), np.concatenate([middle[left], end[left]])
        at_start, at_end = (
            np.concatenate(pair)
            for pair in ((at_start[left], at_middle[left]), (at_middle[left], at_end[left]))
        )
        which = np.concatenate([which[left], which[left]])
    sure[which] = False
    return rise, sure


def _change(first: Complex, second: Complex) -> Complex:
    """Change of a logarithm by the shorter way round."""
    change = second - first
    return np.asarray(change.real + 1j * (np.remainder(change.imag + np.pi, 2.0 * np.pi) - np.pi))
