"""Bands of speed in which states of balls are stable, their edges solved, whatever speeds are asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from meshes.arrays import Array, Flags, Indices
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import critical_speeds

Bands = tuple[tuple[float, float], ...]  # first and last speed of each, rad/s, rising
# Growth over the spin, shape (k, p), at p speeds; where it is wanted, shape (k, p) or (k, 1), it is known.
Rates = Callable[[Array, Flags], Array]

_APART, _FEWEST = 0.06, 9  # first distance of speeds, relative; how many there are at least
_BESIDE = 0.01  # relative: on either side of a critical speed, where growth changes fast
_ROUNDS = 4  # towards an extremum next to zero
_WIDTH = 2e-4  # relative, of the bracket an edge is left in; the secant in it is far closer
_PARTS, _NEAR = 18, 1e-3  # of a bracket: even parts, and how closely the secant's zero is looked at
_STEPS = 60
_AT_EDGE = 2e-4  # relative: speeds that near an edge do not contradict it


def critical_looks(system: RotorSystem, first: float, last: float) -> Array:
    """Speeds next to which the growth of states of balls changes fast, rad/s, shape (l,).

    Slow motions of balls meet a free motion of the rotor where it goes round once a turn; where the supports
    differ also half the sum of two such frequencies and half their difference.

    Parameters
    ----------
    system : the rotor with its balls held in their places, and with its liquid
    first, last : ends of the range, rad/s
    """
    own = critical_speeds(system)[0]
    pairs = 0.5 * np.concatenate([(own[:, None] + own).ravel(), np.abs(own[:, None] - own).ravel()])
    every = np.unique(np.concatenate([own, pairs]).round(9))
    every = np.concatenate([every, (1.0 - _BESIDE) * own, (1.0 + _BESIDE) * own])
    return np.asarray(every[(every > first) & (every < last)])


def stable_bands_between(
    rates: Rates, first: float, last: float, special: Array, asked: tuple[Array, Array]
) -> tuple[Bands, ...]:
    """Bands of speed in which each of k rates is not above zero, their edges solved.

    Looked at are speeds of its own choice, with more of them at extrema next to zero, so that the bands do
    not change with the speeds asked for but where these contradict them.

    Parameters
    ----------
    rates : growth less what counts as none; infinite where there is no such state
    first, last : ends of the range, rad/s
    special : speeds inside that are looked at as well, shape (l,)
    asked : speeds asked for, shape (s,), and the rates there, shape (k, s)

    Returns
    -------
    Of each rate its bands; an end that is `first` or `last` is where the range ends
    """
    count = max(_FEWEST, 1 + int(np.ceil(np.log(last / first) / _APART))) if last > first else 1
    speed = np.geomspace(first, last, count)
    speed[[0, -1]] = first, last
    speed = np.unique(np.concatenate([speed, special]))
    every = np.ones((len(asked[1]), 1), dtype=bool)
    rate = rates(speed, every)
    for _ in range(_ROUNDS):
        new = np.setdiff1d(_near_zero(speed, rate), speed)
        if not new.size:
            break
        speed, rate = _merged((speed, rate), (new, rates(new, every)))
    bands = _bands(rates, speed, rate)
    other = np.any([_contradicts(own, asked[0], at) for own, at in zip(bands, asked[1], strict=True)], axis=0)
    if other.any():
        bands = _bands(rates, *_merged((speed, rate), (asked[0][other], asked[1][:, other])))
    return bands


def common(one: Bands, other: Bands) -> Bands:
    """What two sets of bands have in common, but for what is narrower than edges are known.

    Parameters
    ----------
    one, other : bands
    """
    ends = [(max(a, c), min(b, d)) for a, b in one for c, d in other]
    return tuple(sorted((low, high) for low, high in ends if high - low > _AT_EDGE * high))


def beside(bands: Bands, first: float, last: float) -> Bands:
    """The rest of the range.

    Parameters
    ----------
    bands : bands inside
    first, last : ends of the range, rad/s
    """
    if not bands:
        return ((first, last),)
    ends = [first, *(end for band in bands for end in band), last]
    pairs = zip(ends[::2], ends[1::2], strict=True)
    return tuple((low, high) for low, high in pairs if high - low > _AT_EDGE * high)


def within(bands: Bands, speed: Array) -> Flags:
    """Speeds inside bands, edges included, shape (s,).

    Parameters
    ----------
    bands : bands
    speed : rad/s, shape (s,)
    """
    found = np.zeros(speed.shape, dtype=bool)
    for low, high in bands:
        found |= (speed >= low) & (speed <= high)
    return found


def _merged(one: tuple[Array, Array], other: tuple[Array, Array]) -> tuple[Array, Array]:
    """Speeds of both by rising speed, each once, with their rates."""
    speed, at = np.unique(np.concatenate([one[0], other[0]]), return_index=True)
    return speed, np.hstack([one[1], other[1]])[:, at]


def _near_zero(speed: Array, rate: Array) -> Array:
    """Speeds beside extrema that turn to zero and may pass it between two looks."""
    found: list[Array] = [np.zeros(0)]
    for own in rate:
        size = np.where(np.isfinite(own), np.abs(own), np.inf)
        left, here, right = size[:-2], size[1:-1], size[2:]
        alike = (np.sign(own[:-2]) == np.sign(own[1:-1])) & (np.sign(own[2:]) == np.sign(own[1:-1]))
        # The slopes next to it, as steep as they are, would reach zero within an interval.
        turns = alike & np.isfinite(here) & (here <= left) & (here <= right)
        steep = np.maximum(*(np.where(np.isfinite(side), side, 0.0) for side in (left, right)))
        at = np.flatnonzero(turns & (2.0 * here <= steep)) + 1
        found += [0.5 * (speed[at] + speed[at - 1]), 0.5 * (speed[at] + speed[at + 1])]
    return np.unique(np.concatenate(found))


def _contradicts(bands: Bands, speed: Array, rate: Array) -> Flags:
    """Speeds whose rate says other than the bands do, shape (s,)."""
    ends = np.array([end for band in bands for end in band])
    at_edge = np.zeros(speed.shape, dtype=bool)
    if ends.size:
        at_edge = np.abs(speed[:, None] - ends).min(axis=1) <= _AT_EDGE * speed
    return np.asarray(~at_edge & (within(bands, speed) != (rate <= 0.0)))


def _bands(rates: Rates, speed: Array, rate: Array) -> tuple[Bands, ...]:
    """Bands between looks by rising speed; between two that differ the edge is solved."""
    row, low = np.nonzero((rate[:, 1:] <= 0.0) != (rate[:, :-1] <= 0.0))
    edge = _solved(rates, len(rate), row, *(np.stack([speed[at], rate[row, at]]) for at in (low, low + 1)))
    found = []
    for k, own in enumerate(rate):
        ends: Sequence[float] = edge[row == k].tolist()
        ends = [float(speed[0])] * bool(own[0] <= 0.0) + [*ends]
        ends = ends + [float(speed[-1])] * bool(own[-1] <= 0.0)
        found.append(tuple(zip(ends[::2], ends[1::2], strict=True)))
    return tuple(found)


def _solved(rates: Rates, count: int, row: Indices, low: Array, high: Array) -> Array:
    """Speeds at which rates change their sign, shape (n,).

    Several looks at a time, evenly and closely round the secant's zero: states end in jumps, and a round
    takes its time for a single speed as for many.

    Parameters
    ----------
    count : k, of all rates
    row : of each
    low, high : speed and rate on either side, shape (2, n)
    """
    first = low[1] <= 0.0
    for _ in range(_STEPS):
        active = np.flatnonzero(high[0] - low[0] > _WIDTH * high[0])
        if active.size == 0:
            break
        (a, at_a), (b, at_b) = low[:, active], high[:, active]
        smooth = np.isfinite(at_a) & np.isfinite(at_b)
        share, width = np.full(a.shape, 0.5), b - a
        np.divide(at_a, at_a - at_b, out=share, where=smooth & (at_a != at_b))
        near = np.maximum(_NEAR, 0.25 * _WIDTH * b / width)
        parts = [share - near, share + near, *(np.full(a.shape, k / _PARTS) for k in range(1, _PARTS))]
        looks = a + np.sort(np.clip(np.stack(parts), 0.0, 1.0), axis=0) * width
        own = np.tile(row[active], len(parts))
        # Rates of one kind of state change at one speed, and are looked at once.
        speed, at_speed = np.unique(looks.ravel(), return_inverse=True)
        wanted = np.zeros((count, speed.size), dtype=bool)
        wanted[own, at_speed] = True
        found = rates(speed, wanted)[own, at_speed].reshape(looks.shape)
        points = np.concatenate([a[None], looks, b[None]])
        values = np.concatenate([at_a[None], found, at_b[None]])
        # The edge is before the first that is unlike the lower end.
        beyond, at = np.argmax((values <= 0.0) != first[active], axis=0), np.arange(active.size)
        low[:, active] = points[beyond - 1, at], values[beyond - 1, at]
        high[:, active] = points[beyond, at], values[beyond, at]
    smooth = np.isfinite(low[1]) & np.isfinite(high[1]) & (low[1] != high[1])
    share = np.full(row.size, 0.5)
    np.divide(low[1], low[1] - high[1], out=share, where=smooth)
    return np.asarray(low[0] + share * (high[0] - low[0]))
