"""Largest amplitudes over a range of speeds, found between the speeds that were asked for.

`refine` samples complex amplitudes around every maximum and wherever the phase turns too far between two
samples, where a narrower resonance shows; `seeds` has the speeds that show the shape of a known one. A
round's speeds of many machines are asked for together.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from meshes.arrays import Array, Complex, Index
from meshes.quantity import Q

# Complex amplitudes of some machines at some speeds, shape (m,) each: their parts, shape (m, p).
Answer = Callable[[Index, Array], Complex]

_ROUNDS = 40  # of questions at most
_GAIN = 1e-12  # relative height that a maximum may still gain
_SEEN = 1e-3  # the same of a maximum that is lower than another one
_TURN = 0.8  # rad from one sample to the next that show a resonance's shape
_LOOKED = 6  # rounds in which a turn of the phase is followed whatever its height
_WORTH = 0.3  # of the largest amplitude, from which on it is followed to its end
# Maxima seen so finely that a parabola shows their tops: rounding of an answer makes ever more of them.
_FINE = 0.05  # of their height, by which the samples beside such a one are lower at most
_AT_A_TIME = 8  # of them, the highest, are followed
_SETTLED = 8  # rounds in which nothing else is wanted; a top takes three or four
_CLOSE = 4.0 * np.finfo(float).eps  # relative distance of two speeds that are one
_SHAPE = (-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0)  # half widths from a resonance
_SHARED = 0.5  # half widths up to which a resonance takes another one's speed for its own


@dataclass(frozen=True)
class Peak:
    """Largest amplitude over a range of speeds."""

    #: nan where no amplitude is known
    speed: Annotated[float, Q("rad s-1", "speed of the largest amplitude")]
    #: infinite where it has no bound, nan where none is known
    amplitude: Annotated[float, Q("m", "largest amplitude")]

    @property
    def known(self) -> bool:
        """Whether there is one, with a bound or without."""
        return not math.isnan(self.amplitude)


@dataclass(frozen=True)
class Resonance:
    """A maximum of the amplitude over speed, as standards on rotors judge it."""

    speed: Annotated[float, Q("rad s-1", "speed of a maximum", "over speed")]
    #: infinite where it has no bound
    amplitude: Annotated[float, Q("m", "amplitude of a maximum", "over speed")]
    #: infinite without a bound, nan where the curve does not fall so far on both sides
    amplification_factor: Annotated[
        float, Q("1", "amplification factor", "speed of a maximum over the width of its half-power band")
    ]
    #: nan of a machine that works at no speed
    separation_margin: Annotated[
        float, Q("1", "separation margin", "distance from the last speed, over that speed")
    ]


@dataclass(frozen=True)
class Samples:
    """Complex amplitudes of a machine over speed; the amplitude is the sum of the sizes of their parts."""

    speed: Array  #: rising, rad/s, shape (n,)
    parts: Complex  #: m, nan or infinite where there is none, shape (n, p)

    @property
    def amplitude(self) -> Array:
        """Amplitude, m, shape (n,)."""
        return np.asarray(np.abs(self.parts).sum(axis=1))

    def joined(self, speed: Array, parts: Complex) -> Samples:
        """Samples with others, those of equal speed once."""
        every = np.concatenate((self.speed, speed))
        distinct, first = np.unique(every, return_index=True)
        return Samples(distinct, np.concatenate((self.parts, parts))[first])


def highest(speed: Array, amplitude: Array) -> Peak:
    """The largest of some amplitudes, the first of equals."""
    if np.isnan(amplitude).all():
        return Peak(math.nan, math.nan)
    k = int(np.nanargmax(amplitude))
    return Peak(float(speed[k]), float(amplitude[k]))


_FALLS = 0.9  # of a maximum, below which the amplitude falls on both sides of one that counts


def maxima(speed: Array, amplitude: Array) -> tuple[Resonance, ...]:
    """Maxima within a range of rising speeds, shape (n,); ripples that fall by less than a tenth are none."""
    known = ~np.isnan(amplitude)
    x, y = speed[known], amplitude[known]
    if y.size < 3:
        return ()
    left, right = np.append(-np.inf, y[:-1]), np.append(y[1:], -np.inf)
    tops = np.flatnonzero((y >= right) & (y > left))
    found = []
    for k in tops[(tops > 0) & (tops < y.size - 1)].tolist():
        if None in (_crossing(x, y, k, side, _FALLS) for side in (-1, 1)):
            continue
        low, high = (_crossing(x, y, k, side, math.sqrt(0.5)) for side in (-1, 1))
        factor = math.nan if low is None or high is None else math.inf
        if low is not None and high is not None and high > low:
            factor = float(x[k]) / (high - low)
        margin = abs(float(x[k]) - float(speed[-1])) / abs(float(speed[-1])) if speed[-1] else math.nan
        found.append(Resonance(float(x[k]), float(y[k]), factor, margin))
    return tuple(found)


def _crossing(x: Array, y: Array, top: int, side: int, share: float) -> float | None:
    """Where a curve falls to a share of a maximum on one side; None where it rises above it before."""
    if math.isinf(y[top]):
        return float(x[top])
    level, k = share * y[top], top + side
    while 0 <= k < y.size and level < y[k] <= y[top]:
        k += side
    if not 0 <= k < y.size or y[k] > y[top]:
        return None
    inner = k - side
    return float(x[inner] + (x[k] - x[inner]) * (y[inner] - level) / (y[inner] - y[k]))


def seeds(
    centre: Array, half_width: Array, start: float, stop: float, known: Array, whole: bool = True
) -> Array:
    """Speeds that show the shape of resonances, rising: their centres, and others where samples are few.

    `whole`: all of the shape, as a figure needs it; else as much as `refine` needs, where overlapping
    resonances share their speeds.
    """
    found = list(centre) if whole else []
    for k in np.argsort(half_width, kind="stable").tolist():  # nan, whose shape another one shows, last
        place, width = float(centre[k]), float(half_width[k])
        near = np.abs(known - place) <= 2.0 * width
        if not whole:
            every = np.concatenate((known, found))
            sides = (0.0, -1.0, 1.0) if 0.0 < width < 0.3 * place else (0.0,)
            tried = [place + width * side if side else place for side in sides]
            found += [x for x in tried if not np.any(np.abs(every - x) <= _SHARED * width)]
        elif 0.0 < width < 0.3 * place and np.count_nonzero(near) < len(_SHAPE):
            found += (place + width * np.array(_SHAPE)).tolist()
    distinct = np.unique(found)
    return distinct[(distinct >= start) & (distinct <= stop)]


def refine(answer: Answer, samples: Sequence[Samples], bound: Sequence[float]) -> list[Samples]:
    """Samples with those added that give the largest amplitude of each machine to about 1e-10 of itself.

    `answer` gives parts of some machines, by their index, at some speeds; a machine that has reached its
    `bound`, which no amplitude exceeds, is done.
    """
    found = list(samples)
    spacing = [np.ptp(one.speed) / max(one.speed.size - 1, 1) for one in found]
    going, fine = list(range(len(found))), [0] * len(found)
    for turn in range(_ROUNDS):
        pairs = []
        for k in going:
            speed, coarse = _wanted(found[k], bound[k], turn, spacing[k])
            fine[k] += not coarse
            if speed.size and fine[k] <= _SETTLED:
                pairs.append((k, speed))
        if not pairs:
            break
        going = [k for k, _ in pairs]
        owner = np.repeat(np.array(going, dtype=np.intp), [speed.size for _, speed in pairs])
        parts = answer(owner, np.concatenate([speed for _, speed in pairs]))
        for k, speed in pairs:
            found[k] = found[k].joined(speed, parts[owner == k])
    return found


def _wanted(samples: Samples, bound: float, turn: int, spacing: float) -> tuple[Array, bool]:
    """Speeds at which a machine is looked at next, none once its peak is known; whether a shape is sought."""
    x, size = samples.speed, samples.amplitude
    known = np.isfinite(size)
    if np.isinf(size).any() or not known.any():
        return np.zeros(0), False
    x, size, parts = x[known], size[known], samples.parts[known]
    largest = float(size.max())
    if largest == 0.0 or largest >= bound * (1.0 - _GAIN) or x.size < 2:
        return np.zeros(0), False
    coarse, fine = _around_maxima(x, size, largest)
    turns = _inside_turns(x, size, parts, largest, turn, spacing)
    every = np.unique(np.concatenate((coarse, fine, turns)))
    place = np.searchsorted(x, every)
    apart = np.minimum(
        np.abs(every - x[np.minimum(place, x.size - 1)]), np.abs(every - x[np.maximum(place - 1, 0)])
    )
    return every[apart > _CLOSE * np.abs(every)], bool(coarse.size or turns.size)


def _inside_turns(x: Array, size: Array, parts: Complex, largest: float, turn: int, spacing: float) -> Array:
    """Speeds inside the intervals over which the phase of a part turns too far."""
    gap = np.diff(x)
    turned = np.abs(np.angle(parts[1:] * np.conj(parts[:-1])))
    # What a part adds to the amplitude is what its phase is worth.
    counts = np.maximum(np.abs(parts[1:]), np.abs(parts[:-1])) > 0.02 * largest
    wide = np.any((turned > _TURN) & counts, axis=1)
    high = np.maximum(size[1:], size[:-1]) >= _WORTH * largest
    followed = np.where(high, gap > 1e-4 * spacing, turn < _LOOKED)
    k = np.flatnonzero(wide & followed & (gap > 1e-12 * x[1:]))
    return np.concatenate([x[k] + share * gap[k] for share in (0.25, 0.5, 0.75)])


def _around_maxima(x: Array, size: Array, largest: float) -> tuple[Array, Array]:
    """Speeds around maxima of an amplitude whose shape is not seen yet, and around the highest of the others.

    1/amplitude^2 is nearly a parabola over the speed around the top of a resonance.
    """
    edge = np.concatenate(([-np.inf], size, [-np.inf]))
    found: list[float] = []
    fine: list[tuple[float, list[float]]] = []
    for i in np.flatnonzero((size >= edge[:-2]) & (size > edge[2:])).tolist():
        low, high = x[max(i - 1, 0)], x[min(i + 1, x.size - 1)]
        if high - low <= 8.0 * _CLOSE * x[i]:
            continue
        top, gain, flat = _vertex(x, size, i)
        inside = low < top < high
        if not inside:  # at an end of the range, from which the amplitude falls
            if i not in (0, x.size - 1):
                found += _between(low, x[i], high)
            continue
        sharp = gain > 0.05
        if size[i] * (1.0 + gain) < (1.0 - _SEEN) * largest and not sharp and gain <= _SEEN:
            continue
        if gain <= _GAIN and (flat <= 1e-5 or size[i] < (1.0 - 1e-5) * largest):
            continue
        width = 0.06 * (high - low)
        around = [y for y in (top, top - width, top + width) if low < y < high]
        if sharp or flat > _FINE:
            found += around + _between(low, x[i], high)
        else:
            fine.append((size[i] * (1.0 + gain), around))
    fine = sorted(fine, key=lambda one: -one[0])[:_AT_A_TIME]
    return np.array(found), np.array([speed for _, around in fine for speed in around])


def _between(low: float, middle: float, high: float) -> list[float]:
    """Speeds on both sides of a maximum, by which each side shrinks to a third."""
    sides = [(low, middle), (middle, high)]
    return [a + share * (b - a) for a, b in sides if b > a for share in (1.0 / 3.0, 2.0 / 3.0)]


def _vertex(x: Array, size: Array, i: int) -> tuple[float, float, float]:
    """Place of the top, what it is above the sample i, and what the neighbours are below it, relatively."""
    j = min(max(i, 1), x.size - 2)
    if x.size < 3:
        return float(x.mean()), 1.0, 1.0
    (a, b, c), q = x[j - 1 : j + 2], np.square(size[i] / size[j - 1 : j + 2])
    first, second = (q[1] - q[0]) / (b - a), (q[2] - q[1]) / (c - b)
    curved = (second - first) / (c - a)
    flat = 1.0 - float(size[j - 1 : j + 2].min()) / float(size[i])
    if not curved > 0.0:
        return -math.inf, 0.0, flat
    top = 0.5 * (a + b) - 0.5 * first / curved
    at_top = q[1] + (top - b) * (first + curved * (top - a))
    gain = math.inf if at_top <= 0.0 else 1.0 / math.sqrt(at_top) - 1.0
    return float(top), gain, flat
