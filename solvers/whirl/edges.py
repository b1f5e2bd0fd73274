"""Stability boundaries: edges of the bands of speed in which a rotor with liquid layers whirls by itself.

No band may be lost between two speeds. A mode changes fast only where another meets it. From modes and their
slopes over the spin at a few speeds of its own choice each interval is refined until its modes are followed
from end to end, no growth can have changed its sign inside, and every meeting of two modes has been gone to
[theory: whirl, eq. 32 and 33]. With laminar friction and baffles only the modes that grow most are known and
followed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION
from fluid.whirl import plane_layer
from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor
from solvers.rotor.vibration import critical_speeds
from solvers.whirl.growth import Waves, growth_at, modes_at
from solvers.whirl.laminar import Met

_APART = 0.08  # first distance of speeds, relative
_FEWEST = 9
_BESIDE = 1e-6  # relative, of the second speed by which slopes are found
_FOLLOWED = 0.02  # of the change of the spin: how far a mode may be from where its slopes lead
_LEAP = 0.05  # of the spin: a mode does not go so far over that second speed
_SIDE_BY_SIDE = 0.1  # of the spread of slopes: below it modes go side by side and do not cross
_HIDDEN = 1e-4  # of the spin: rounding of a root, which hides its growth and its slope
_HALVINGS = 7
_NARROW, _AT_EDGE = 1e-6, 0.01  # relative width of intervals that are not split further, at edges
_FLOOR = 1e-10  # of the spin: growth that is not looked for
_DAMPED = 0.1  # of the spin: decay beyond which a mode is not followed
_WITHIN = 2.0  # of the change of the spin: decay that no meeting makes growth within it
_SLOW = 1.1  # of the spin: frequency up to which it is
_STEPS = 6  # towards a meeting
_MET = 1e-10  # of the spin: how near a meeting is gone to


@dataclass(frozen=True)
class Looks:
    """Points (row, speed) and what is known there, shape (n,) and (n, m)."""

    row: Index
    speed: Array
    growth: Array  #: of the mode that grows most, 1/s, nan where it is not known
    root: Complex  #: of the modes, growth + i frequency, nan where there is none
    slope: Complex  #: over the spin

    def at(self, which: Index | Flags) -> Looks:
        """Those at some indices."""
        return Looks(*(getattr(self, part.name)[which] for part in fields(self)))


def looks(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    first: float,
    last: float,
    friction: Waves,
    met: Sequence[Met] | None = None,
) -> tuple[Index, Array, Array]:
    """Points by rising row and speed from which every change of the sign of the growth is seen.

    Rows, speeds, and growth rates, nan where they are not known. `met`: of each row.
    """

    def at(row: Index, speed: Array) -> Looks:
        return _looked(rotor, rows, row, speed, friction, met)

    own = [_first_speeds(rotor, fills, first, last) for fills in rows]
    row, speed = np.repeat(np.arange(len(rows)), [part.size for part in own]), np.concatenate(own)
    seen = at(row, speed)
    inside = seen.row[1:] == seen.row[:-1]
    low, high = seen.at(np.flatnonzero(inside)), seen.at(np.flatnonzero(inside) + 1)
    found, meetings = [seen], []
    for _ in range(_HALVINGS):
        split, share = _unsure(low, high)
        meetings.append(_meetings(low.at(~split), high.at(~split)))
        if not split.any():
            break
        low, high = low.at(split), high.at(split)
        middle = at(low.row, low.speed + share[split] * (high.speed - low.speed))
        found.append(middle)
        low, high = _joined([low, middle]), _joined([middle, high])
    else:
        meetings.append(_meetings(low, high))
    found += _gone_to(at, [np.concatenate(part) for part in zip(*meetings, strict=True)])
    row, speed, growth = (
        np.concatenate([getattr(part, n) for part in found]) for n in ("row", "speed", "growth")
    )
    order = np.lexsort((speed, row))
    return row[order], speed[order], growth[order]


def _first_speeds(rotor: Rotor, fills: Sequence[Fill], first: float, last: float) -> Array:
    """Ends of the range, speeds between at even ratios, and those where a wave meets a rotor's mode.

    A wave of a clear ring goes round at c = 1 + T -+ sqrt(T^2 + T) times the spin in space: it meets a mode,
    without or with the liquid's mass, at a critical speed of a rotor of mass c^2 M and gyroscopic matrix c G
    [theory: whirl, eq. 32].
    """
    count = max(_FEWEST, 1 + int(np.ceil(np.log(last / first) / _APART)))
    found = [np.geomspace(first, last, count)]
    found[0][[0, -1]] = first, last
    layers = [(fill.chamber.plane, plane_layer(fill, NO_FRICTION)) for fill in fills]
    waves = [(plane, layer) for plane, layer in layers if layer is not None]
    ratios = {
        1.0 + x.layer_tanh + way * math.sqrt(x.layer_tanh * (x.layer_tanh + 1.0))
        for _, x in waves
        for way in (1.0, -1.0)
    }
    if isinstance(rotor, Jeffcott):
        masses = (rotor.mass, rotor.mass + sum(x.mass for _, x in waves))
        found += [math.sqrt(rotor.stiffness / mass) / np.array(sorted(ratios)) for mass in masses]
        every = np.unique(np.concatenate(found))
        return every[(every >= first) & (every <= last)]
    system = rotor.system()
    heavy = sum((x.mass * system.at(z).T @ system.at(z) for z, x in waves), np.zeros(system.mass.shape))
    for ratio in (sense * ratio for ratio in ratios for sense in (1.0, -1.0)):
        for mass in (system.mass, system.mass + heavy):
            turned = replace(system, mass=ratio**2 * mass, gyroscopic=ratio * system.gyroscopic)
            found.append(critical_speeds(turned)[0])
    every = np.unique(np.concatenate(found))
    return every[(every >= first) & (every <= last)]


def _looked(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    row: Index,
    speed: Array,
    friction: Waves,
    met: Sequence[Met] | None,
) -> Looks:
    """Modes and growth at points, and slopes by a second speed close by."""
    *tables, growth = modes_at(rotor, rows, row, speed, friction, _BESIDE, met)
    root, beside = (
        np.where(rounding <= _HIDDEN * speed[:, None], roots, complex(np.nan, np.nan))
        for roots, rounding in tables
    )
    change = _changes(root, beside)
    change = np.where(np.abs(change) <= _LEAP * speed[:, None], change, complex(np.nan, np.nan))
    return Looks(row, speed, growth, root, change / (_BESIDE * speed[:, None]))


def _changes(root: Complex, beside: Complex) -> Complex:
    """Change of each mode to a second speed close by, the nearest taken for the same, shape (n, m).

    Two that keep side by side, closer than they change, are told apart by their common change.
    """

    def paired(led: Complex) -> tuple[Index, Complex]:
        gap = np.abs(beside[:, None, :] - led[:, :, None])
        to = _pairing(np.where(np.isnan(gap), np.inf, gap))
        return to, np.take_along_axis(beside, to, axis=1) - root

    to, change = paired(root)
    near = np.abs(root[:, :, None] - root[:, None, :]) <= np.abs(change)[:, :, None]
    if near.sum() <= np.isfinite(change).sum():
        return change
    count = np.maximum(near.sum(axis=2), 1)
    common = np.where(near, change[:, None, :], 0.0).sum(axis=2) / count
    other, common_change = paired(root + common)
    spread = [
        np.where(near & (to != other)[:, :, None], np.abs(part[:, :, None] - part[:, None, :]), 0.0).sum(
            axis=(1, 2)
        )
        for part in (change, common_change)
    ]
    return np.where((spread[1] < _SIDE_BY_SIDE * spread[0])[:, None], common_change, change)


def _joined(parts: Sequence[Looks]) -> Looks:
    """Points one after the other, with as many places for modes as the widest has."""
    width = max(part.root.shape[1] for part in parts)

    def wide(table: Complex) -> Complex:
        more = ((0, 0), (0, width - table.shape[1]))
        return np.pad(table, more, constant_values=complex(np.nan, np.nan))

    return Looks(
        *(np.concatenate([getattr(part, name) for part in parts]) for name in ("row", "speed", "growth")),
        *(np.concatenate([wide(getattr(part, name)) for part in parts]) for name in ("root", "slope")),
    )


@dataclass(frozen=True)
class _Followed:
    """Modes from the lower end of intervals to the upper one, shape (k, m)."""

    start: Complex  #: root and slope at the lower end, and at the upper one
    leaves: Complex
    end: Complex
    comes: Complex
    sure: Flags  #: the slopes of both ends lead from one to the other
    counts: Flags  #: the mode may grow: it is no heavily damped one


def _follow(low: Looks, high: Looks) -> _Followed:
    """Modes that the mean of both slopes leads from the lower to the upper end, each way the nearest."""
    width = (high.speed - low.speed)[:, None, None]
    led = low.root[:, :, None] + 0.5 * width * (low.slope[:, :, None] + high.slope[:, None, :])
    off = np.abs(high.root[:, None, :] - led)
    off = np.where(np.isnan(off), np.inf, off)
    there = _pairing(off)
    near = np.take_along_axis(off, there[:, :, None], axis=2)[:, :, 0] <= _FOLLOWED * width[:, :, 0]
    end, comes = (np.take_along_axis(part, there, axis=1) for part in (high.root, high.slope))
    rate = np.where(np.isnan(low.root), -np.inf, low.root.real)
    spin = low.speed[:, None]
    heavily = np.minimum(_DAMPED * spin, _WITHIN * width[:, :, 0])
    counts = (rate > -heavily) & (np.abs(low.root.imag) < _SLOW * spin)
    return _Followed(low.root, low.slope, end, comes, near, counts)


def _pairing(off: Array) -> Index:
    """For each of m places one of p others, nearest first, by distances of shape (k, m, p); shape (k, m)."""
    count, places, others = off.shape
    left, there = off.copy(), np.zeros((count, places), dtype=np.intp)
    every = np.arange(count)
    for _ in range(min(places, others)):
        one, other = np.divmod(np.argmin(left.reshape(count, places * others), axis=1), others)
        free = np.isfinite(left[every, one, other])
        there[every[free], one[free]] = other[free]
        left[every, one], left[every, :, other] = np.inf, np.inf
    return there


def _unsure(low: Looks, high: Looks) -> tuple[Flags, Array]:
    """Intervals to be looked into, and where: as a share of their width, shape (k,).

    Modes that cannot be followed, growth that passes to another mode, and growths and distances of two modes
    whose tangents meet beyond zero.
    """
    width, modes = high.speed - low.speed, _follow(low, high)
    lost = (modes.counts & ~modes.sure).any(axis=1)
    # At the edge of a band two modes end as square roots, which no slope follows; the edge is solved later.
    edge = (low.growth > 0.0) != (high.growth > 0.0)
    split = lost & (width > np.where(edge, _AT_EDGE, _NARROW) * high.speed)
    share = np.full(width.shape, 0.5)
    kept = modes.sure & modes.counts
    floor = (_FLOOR * high.speed)[:, None]
    values = modes.start.real, modes.end.real, modes.leaves.real, modes.comes.real
    at, turn = _tangents(*values, width[:, None])
    rises = kept & (values[0] <= 0.0) & (values[1] <= 0.0) & (values[2] > values[3]) & (turn > floor)
    falls = kept & (values[0] > 0.0) & (values[1] > 0.0) & (values[2] < values[3]) & (turn < -floor)
    pairs = _pairs(modes)
    near = np.zeros((width.size, 0)), np.zeros((width.size, 0), dtype=bool)
    if pairs is not None:
        gap, reach = pairs
        beyond, least = _tangents(*gap, width[:, None])
        twice = (
            (gap[0] * gap[1] > 0.0)
            & (least * gap[0] < 0.0)
            & (gap[2] * gap[0] < 0.0)
            & (gap[3] * gap[0] > 0.0)
        )
        near = beyond, twice & (reach < width[:, None] * np.abs(gap[2] - gap[3]))
    between, gap_there = _handed_over(low, high, modes)
    wanted = np.concatenate([gap_there[:, None], rises | falls, near[1]], axis=1)
    places = np.concatenate([between[:, None], at, near[0]], axis=1)
    which = np.argmax(wanted, axis=1)
    asked = wanted.any(axis=1) & (width > 1e-8 * high.speed)
    place = np.take_along_axis(places, which[:, None], axis=1)[:, 0]
    share = np.where(asked, np.clip(place, 0.1, 0.9), share)
    return split | asked, share


def _handed_over(low: Looks, high: Looks, modes: _Followed) -> tuple[Array, Flags]:
    """Where none of the modes that grow at the ends may grow, as a share of the width; which intervals.

    In the middle between the zeros of the chords of the last that ceases and of the first that begins.
    """
    start, end = modes.start.real, modes.end.real
    first, last = modes.sure & (start > 0.0), modes.sure & (end > 0.0)
    zero = np.divide(start, start - end, out=np.full(start.shape, np.nan), where=first != last)
    ceases = np.where(first & ~last, zero, 0.0).max(axis=1, initial=0.0)
    begins = np.where(last & ~first, zero, 1.0).min(axis=1, initial=1.0)
    return 0.5 * (ceases + begins), (low.growth > 0.0) & (high.growth > 0.0) & ~(first & last).any(axis=1)


def _tangents(first: Array, last: Array, rise: Array, fall: Array, width: Array) -> tuple[Array, Array]:
    """Where the tangents at both ends of intervals meet, as a share of the width, and their value there."""
    bend = rise - fall
    at = np.divide(last - first - fall * width, bend, out=np.full(first.shape, -1.0), where=bend != 0.0)
    inside = (at > 0.0) & (at < width)
    return np.where(inside, at / width, 0.5), np.where(inside, first + rise * at, 0.0)


def _pairs(modes: _Followed) -> tuple[tuple[Array, Array, Array, Array], Array] | None:
    """Distances in frequency of all pairs of modes at both ends, both slopes, and the decay to be overcome.

    Two modes that decay at rates a and b make each other grow only by a coupling above sqrt(a b); one as wide
    as the interval is seen without going there.
    """
    count = modes.start.shape[1]
    if count < 2:
        return None
    one, other = np.triu_indices(count, 1)
    sure = modes.sure & modes.counts
    both = sure[:, one] & sure[:, other]
    gap = tuple(
        np.where(both, part.imag[:, one] - part.imag[:, other], np.nan)
        for part in (modes.start, modes.end, modes.leaves, modes.comes)
    )
    decay = np.maximum(-np.maximum(modes.start.real, modes.end.real), 0.0)
    return (gap[0], gap[1], gap[2], gap[3]), np.sqrt(decay[:, one] * decay[:, other])


def _meetings(low: Looks, high: Looks) -> tuple[Any, ...]:
    """Meetings of two modes inside intervals: row, speed, both ends, rad/s, and the root that they share."""
    modes = _follow(low, high)
    pairs = _pairs(modes)
    if pairs is None or low.row.size == 0:
        return (np.zeros(0, dtype=np.intp), *np.zeros((3, 0)), np.zeros(0, dtype=complex))
    (first, last, rise, fall), reach = pairs
    width = (high.speed - low.speed)[:, None]
    crossed = (first * last < 0.0) & (reach < width * np.maximum(np.abs(rise), np.abs(fall)))
    where, which = np.nonzero(crossed)
    at = first[where, which] / (first - last)[where, which]
    one, other = (part[which] for part in np.triu_indices(modes.start.shape[1], 1))
    root = sum((1.0 - at) * modes.start[where, own] + at * modes.end[where, own] for own in (one, other))
    speed = low.speed[where] + at * width[where, 0]
    return low.row[where], speed, low.speed[where], high.speed[where], np.asarray(0.5 * root)


def _gone_to(at: Callable[[Index, Array], Looks], meetings: Sequence[Any]) -> list[Looks]:
    """Points on the way to meetings of two modes, by Newton's method on the distance of frequencies.

    In a band both have one frequency; from outside a distance as sqrt(x^2 - w^2) leads into it, to w^2/x.
    """
    row, speed, low, high, root = meetings
    found: list[Looks] = []
    before = np.full(row.shape, np.inf)
    for _ in range(_STEPS):
        if row.size == 0:
            break
        here = at(row, speed)
        # At a meeting that is no band, rounding makes one of no width.
        found.append(
            replace(
                here, growth=np.where(here.growth > _FLOOR * speed, here.growth, np.minimum(here.growth, 0.0))
            )
        )
        off = np.abs(here.root - root[:, None])
        two = np.argsort(np.where(np.isnan(off), np.inf, off), axis=1)[:, :2]
        pair, slope = (np.take_along_axis(part, two, axis=1) for part in (here.root, here.slope))
        gap, rate = (part.imag[:, 0] - part.imag[:, 1] for part in (pair, slope))
        step = np.divide(-gap, rate, out=np.full(gap.shape, np.nan), where=np.abs(rate) > 1e-9)
        on = np.isfinite(step) & (here.growth <= 0.0) & (np.abs(step) > _MET * speed)
        # What does not come nearer to a meeting has none.
        on &= (speed + step > low) & (speed + step < high) & (np.abs(step) < 0.5 * before)
        row, low, high, step = row[on], low[on], high[on], step[on]
        before = np.abs(step)
        root = (pair.mean(axis=1) + 0.0)[on] + step * slope.mean(axis=1)[on]
        speed = speed[on] + step
    return found


Bands = tuple[tuple[float, float], ...]

_WIDTH = 1e-10  # relative, of the bracket an edge is left in
_AT_BOUND = 1e-8  # relative, of speeds at an edge
_NEAR = 1e-3  # of a bracket: how closely the secant's zero is looked at
_TRUSTED = (
    0.1  # of a bracket: how far an interpolated zero may be off that is looked at in the secant's place
)
_ROUNDED = 64.0  # times as far from it the second look, where rounding hides the growth
_BISECTIONS = 60


def unstable_bands(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    speed: ArrayLike,
    friction: Waves = NO_FRICTION,
    growth: Array | None = None,
    met: Sequence[Met] | None = None,
) -> tuple[Bands, ...]:
    """Bands (low, high) of speed in which some whirl grows, rad/s, of each row of fills, edges refined.

    At speeds of its own choice between the first and the last given, so that no band is lost and none depends
    on their number [theory: whirl, eq. 32 and 33]. Next to a speed of unknown growth rate a band ends at the
    last known one. `met`: what is known of each row from other questions.
    """
    grid = np.asarray(speed, dtype=float)
    known = [Met() for _ in rows] if met is None else met
    row, points, rate = looks(rotor, rows, float(grid[0]), float(grid[-1]), friction, known)
    found = _bands(rotor, rows, row, points, rate, friction, known)
    if growth is None:
        return found
    # Speeds asked for of which the bands say otherwise are looked from as well, and where the growth is not
    # known at one it is not known up to its neighbours.
    own = np.repeat(np.arange(len(rows)), grid.size), np.tile(grid, len(rows)), np.asarray(growth).ravel()
    other = np.concatenate([_contradicts(bands, grid, g) for bands, g in zip(found, growth, strict=True)])
    for k, at_speeds in enumerate(growth):
        for low, high in bands_not_known(grid, at_speeds):
            rate[(row == k) & (points > low) & (points < high)] = np.nan
            other |= (own[0] == k) & (own[1] >= low) & (own[1] <= high)
    if not other.any():
        return found
    row, points, rate = (np.concatenate([x, y[other]]) for x, y in zip((row, points, rate), own, strict=True))
    order = np.lexsort((points, row))
    return _bands(rotor, rows, row[order], points[order], rate[order], friction, known)


def any_growth(
    rotor: Rotor, rows: Sequence[Sequence[Fill]], speed: ArrayLike, friction: Waves = NO_FRICTION
) -> Flags:
    """Whether `unstable_bands` finds a band, of each row of fills: without looking for edges.

    Rows in which a whirl grows at one of the first speeds are not looked into any further.
    """
    grid = np.asarray(speed, dtype=float)
    first, last = float(grid[0]), float(grid[-1])
    own = [_first_speeds(rotor, fills, first, last) for fills in rows]
    row, points = np.repeat(np.arange(len(rows)), [part.size for part in own]), np.concatenate(own)
    grows = growth_at(rotor, rows, row, points, friction)[0] > 0.0
    found = np.zeros(len(rows), dtype=bool)
    found[row[grows]] = True
    calm = np.flatnonzero(~found)
    if calm.size:
        row, _, rate = looks(rotor, [rows[k] for k in calm.tolist()], first, last, friction)
        found[calm[row[rate > 0.0]]] = True
    return found


def _contradicts(bands: Bands, speed: Array, growth: Array) -> Flags:
    """Speeds inside bands at which nothing grows or outside at which something does, shape (n,)."""
    inside, edge = np.zeros(speed.shape, dtype=bool), np.zeros(speed.shape, dtype=bool)
    for low, high in bands:
        inside |= (speed >= low) & (speed <= high)
        edge |= np.minimum(np.abs(speed - low), np.abs(speed - high)) <= _AT_BOUND * speed
    return np.asarray(~edge & ~np.isnan(growth) & (inside != (growth > 0.0)))


def _bands(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    row: Index,
    points: Array,
    rate: Array,
    friction: Waves,
    met: Sequence[Met],
) -> tuple[Bands, ...]:
    """Bands between points by rising row and speed at which the growth is known, their edges refined."""
    grows, known_there = rate > 0.0, ~np.isnan(rate)
    # Where growth begins, after a point, and where it ceases, likewise; the ends of the rows count.
    inner = row[1:] == row[:-1]
    begins = grows & ~np.concatenate([[False], inner & grows[:-1]])
    ceases = grows & ~np.concatenate([inner & grows[1:], [False]])
    # Each with its neighbour on the other side of the edge, if there is one whose growth is known.
    here = np.concatenate([np.flatnonzero(begins), np.flatnonzero(ceases)])
    after = np.arange(here.size) >= np.count_nonzero(begins)
    other = np.clip(here + np.where(after, 1, -1), 0, row.size - 1)
    edge = points[here]
    kept = (row[other] == row[here]) & (other != here) & known_there[other]
    low, high = np.minimum(here, other)[kept], np.maximum(here, other)[kept]
    first, last = (np.stack([points[at], rate[at]]) for at in (low, high))
    edge[kept] = _refine(rotor, rows, row[low], first, last, friction, met)
    bands = zip(row[begins].tolist(), edge[~after].tolist(), edge[after].tolist(), strict=True)
    found: list[list[tuple[float, float]]] = [[] for _ in rows]
    for k, start, stop in bands:
        found[k].append((start, stop))
    return tuple(tuple(own) for own in found)


def bands_not_known(speed: Array, growth: Array) -> Bands:
    """Bands of speed in which the growth rate is nan, up to the nearest speeds at which it is known.

    Or to the ends of the range.
    """
    lost = np.concatenate([[False], np.isnan(growth), [False]])
    first, past = np.flatnonzero(~lost[:-1] & lost[1:]), np.flatnonzero(lost[:-1] & ~lost[1:])
    low, high = speed[np.maximum(first - 1, 0)], speed[np.minimum(past, speed.size - 1)]
    return tuple(zip(low.tolist(), high.tolist(), strict=True))


def _refine(
    rotor: Rotor,
    rows: Sequence[Sequence[Fill]],
    row: Index,
    low: Array,
    high: Array,
    friction: Waves,
    met: Sequence[Met],
) -> Array:
    """Speeds at which the whirl begins or ceases to grow, between those of `low` and `high`.

    Three points at a time: in the middle and closely round the zero of the growth by interpolation; in
    quarters where the whirl is neutral on one side, as without damping.
    """
    low, high = low.copy(), high.copy()
    first = low[1] > 0.0
    seen = np.stack([low, high])
    for _ in range(_BISECTIONS):
        active = np.flatnonzero(high[0] - low[0] > _WIDTH * high[0])
        if active.size == 0:
            break
        (a, at_a), (b, at_b) = low[:, active], high[:, active]
        width, signs = b - a, at_a * at_b < 0.0
        share = np.full(a.shape, 0.5)
        np.divide(at_a, at_a - at_b, out=share, where=signs)
        near = np.where(signs, _NEAR, 0.25)
        zero, off = _zero(seen[:, :, active])
        better, off = (zero - a) / width, off / width
        trusted = (np.abs(better - 0.5) < 0.5 + _NEAR) & (off < _TRUSTED)
        share, near = np.where(trusted, np.clip(better, 0.0, 1.0), share), np.where(trusted, off, near)
        near = np.where(signs | trusted, np.maximum(near, 0.25 * _WIDTH * b / width), near)
        # Growth that rounding makes zero ends a little beyond the zero.
        beyond = np.where(at_a == 0.0, 1.0, -1.0)
        sides = np.where(trusted & ~signs, [beyond, _ROUNDED * beyond], [[-1.0], [1.0]])
        parts = np.concatenate([share + sides * near, np.full((1, a.size), 0.5)])
        looks = a + np.sort(np.clip(parts, 0.0, 1.0), axis=0) * width
        at_rows = np.tile(row[active], 3)
        found = growth_at(rotor, rows, at_rows, looks.ravel(), friction, met)[0].reshape(3, -1)
        # The ends and the looks in order; the edge is before the first that is unlike the lower end.
        points = np.concatenate([a[None], looks, b[None]])
        rates = np.concatenate([at_a[None], found, at_b[None]])
        beyond = np.argmax((rates > 0.0) != first[active], axis=0)
        at = np.arange(active.size)
        low[:, active] = points[beyond - 1, at], rates[beyond - 1, at]
        high[:, active] = points[beyond, at], rates[beyond, at]
        fresh = np.full((3, *low.shape), np.nan)
        fresh[:, 0, active], fresh[:, 1, active] = looks, found
        seen = np.concatenate([seen, fresh])
    return np.asarray(0.5 * (low[0] + high[0]))


def _zero(seen: Array) -> tuple[Array, Array]:
    """Speed of no growth by interpolation through points (speed, growth), (m, 2, k); how far it may be off.

    The speed is a polynomial of the growth through the three and four of least growth, without those that
    rounding made zero; nan where all have one sign.
    """
    size = np.where(seen[:, 1] == 0.0, np.nan, np.abs(seen[:, 1]))
    order = np.argsort(size, axis=0, kind="stable")[:4]  # nan last
    speed, growth = (np.take_along_axis(part, order, axis=0) for part in (seen[:, 0], seen[:, 1]))
    growth = np.where(
        (growth > 0.0).any(axis=0) & (growth < 0.0).any(axis=0) & (growth != 0.0), growth, np.nan
    )
    found = []
    for count in (3, 4):
        total = np.zeros(speed.shape[1]) if count <= len(speed) else np.full(speed.shape[1], np.nan)
        for own in range(min(count, len(speed))):
            others = np.delete(growth[:count], own, axis=0)
            gap = others - growth[own]
            ratio = np.divide(others, gap, out=np.full(gap.shape, np.nan), where=gap != 0.0)
            total += speed[own] * ratio.prod(axis=0)
        found.append(total)
    return found[1], np.abs(found[1] - found[0])
