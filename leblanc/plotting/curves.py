"""Curves over speed made ready for drawing: sorted, thinned, branches linked, angles unwrapped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import combinations, pairwise
from typing import Any

import numpy as np

from leblanc.core.units import MM, RPM
from leblanc.liquid.choice import HELD_MODELS
from leblanc.studies.held.answer import Held
from leblanc.studies.run.answer import RunAnswer, phase
from meshes.arrays import Array, Complex, Flags, Index

Span = tuple[float, float]

COLUMNS = 1500  # more than a printed page resolves
NARROW = 0.025  # of the speeds: a resonance of a narrower half-power band is drawn once more, wider
_LOW = 0.25  # of the highest peak, below which a peak is no resonance to be drawn wider
_ASIDE = 2.5  # half-power bands shown on either side of one
_TOGETHER = 0.05  # of the speeds: narrow bands no farther apart share one picture
_MOST_WIDE = 0.5  # of the speeds, above which nothing is gained by drawing them again
_MOST_WINDOWS = 3


@dataclass(frozen=True)
class HeldCurves:
    """Time-domain states in the units of figures, by rising speed; n speeds, c chambers."""

    rpm: Array  #: of all speeds asked for, shape (n,)
    cycle: Array  #: amplitude of limit cycles on average, mm, nan elsewhere, shape (n,)
    whirl: Array  #: speed of their whirl in space, rpm, nan elsewhere, shape (n,)
    #: amplitude on the way down where it differs, and at the neighbours, mm, nan elsewhere, shape (n,)
    down: Array
    #: distance of each layer's mean centre of mass from its chamber's axis, and by how much the centre leaves
    #: that mean, mm, nan where the layer was not held, shape (n, c)
    layer: Array
    swing: Array


@dataclass(frozen=True)
class Curves:
    """One study in the units of its figures, by rising speed; p points, b branches."""

    rpm: Array  #: spin speed, shape (p,)
    limits: Span  #: of the speed axis, rpm
    amplitude: Array  #: mm, shape (p,)
    amplitude_dry: Array
    offset: Array
    angle: Array  #: degrees in (-270, 90], nan where nothing has a direction, shape (p,)
    phase: Array
    phase_dry: Array
    stable: Flags  #: of the branch reported, shape (p,)
    cycling: Flags  #: a limit cycle is reported, shape (p,)
    least: Array  #: amplitude over time, mm, nan where no motion was held, shape (p,)
    largest: Array
    branches: Array  #: amplitudes of all branches, mm, shape (p, b)
    branch_stable: Flags  #: shape (p, b)
    #: number of the continuous curve that each branch belongs to, -1 where there is none, shape (p, b)
    chain: Index
    reported: Index  #: chain of the branch reported, -1 if it is none of them, shape (p,)
    dry_patch: list[Span]  #: spans of speed, rpm
    out_of_range: list[Span]
    not_converged: list[Span]
    held: HeldCurves | None = None  #: time-domain states; None where none was


def lag_degrees(angle: Array, size: Array) -> Array:
    """Angle in degrees in (-270, 90], a lag of 0 to 180 degrees in one piece; nan where size is 0."""
    degrees = 90.0 - np.mod(90.0 - np.degrees(angle), 360.0)
    return np.where(size > 0.0, degrees, np.nan)


def thin(curves: Array, columns: int) -> Index:
    """Indices of points that keep the look of curves, (n, k): ends, peaks and troughs of each column.

    All of them if there are few; nan is allowed.
    """
    count = curves.shape[0]
    if count <= 4 * columns:
        return np.arange(count)
    starts = np.linspace(0, count, columns + 1).astype(np.intp)
    width = int(np.diff(starts).max())
    # Short columns repeat their last point, which changes neither extreme.
    points = np.minimum(starts[:-1, None] + np.arange(width), starts[1:, None] - 1)
    keep = [starts[:-1], starts[1:] - 1]
    for values in curves.T:
        block, known = values[points], ~np.isnan(values[points])
        highest = np.argmax(np.where(known, block, -np.inf), axis=1)
        lowest = np.argmin(np.where(known, block, np.inf), axis=1)
        keep += [points[np.arange(columns), highest], points[np.arange(columns), lowest]]
    return np.unique(np.concatenate(keep))


def spans(x: Array, mask: Flags, limits: Span) -> list[Span]:
    """Intervals in which a condition holds, reaching half-way to the next point where it does not.

    Gaps narrower than 1/1000 of the limits are closed.
    """
    edges = np.concatenate(([limits[0]], 0.5 * (x[1:] + x[:-1]), [limits[1]]))
    change = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False]))))
    left, right = edges[change[::2]], edges[change[1::2]]
    wide = left[1:] - right[:-1] > 1e-3 * (limits[1] - limits[0])
    left, right = (
        left[np.concatenate(([True], wide))[: left.size]],
        right[np.append(wide, True)[: right.size]],
    )
    return list(zip(left.tolist(), right.tolist(), strict=True))


def link(branches: Complex) -> Index:
    """Number of the continuous curve that each branch belongs to, -1 where there is none, shape (n, b).

    Branches, by rising amplitude, change their column where a fold begins or ends. Those of two neighbouring
    speeds are matched in order; where their numbers differ, those are left over whose absence makes the
    matched ones move least.
    """
    chain = np.full(branches.shape, -1, dtype=np.intp)
    present = ~np.isnan(branches)
    changes = np.flatnonzero(np.any(present[1:] != present[:-1], axis=1)) + 1
    known = 0
    for start, stop in pairwise([0, *changes.tolist(), len(branches)]):
        now = np.flatnonzero(present[start])
        if start > 0:
            before = np.flatnonzero(present[start - 1])
            old, new = _matched(branches[start - 1, before], branches[start, now])
            chain[start, now[new]] = chain[start - 1, before[old]]
        fresh = now[chain[start, now] < 0]
        chain[start, fresh] = known + np.arange(fresh.size)
        known += fresh.size
        chain[start:stop] = chain[start]
    return chain


def _matched(before: Complex, now: Complex) -> tuple[Index, Index]:
    """Places in two ordered lists that belong together: all of the shorter one, moved as little as can be."""
    if len(before) > len(now):
        new, old = _matched(now, before)
        return old, new
    steps, rows = np.abs(before[:, None] - now[None, :]), np.arange(len(before))
    choices = combinations(range(len(now)), len(before))
    best = min(choices, key=lambda columns: float(steps[rows, list(columns)].sum()))
    return rows, np.array(best, dtype=np.intp)


def _bounded(deflection: Complex) -> Complex:
    """Deflections with nan in place of the infinite ones, which no axis can hold."""
    return np.where(np.isfinite(deflection), deflection, complex(np.nan, np.nan))


def _reported(branches: Complex, deflection: Complex, chain: Index) -> Index:
    """Curve on which the deflection reported lies, -1 where it lies on none, shape (p,)."""
    distance = np.abs(branches - deflection[:, None])
    on_it = distance <= 1e-6 * np.abs(deflection)[:, None]
    number: Index = np.max(np.where(on_it, chain, -1), axis=1, initial=-1)
    return number


def speed_limits(speed: Array) -> Span:
    """Ends of an axis for speeds given in rad/s, rpm; about a single one there is a margin."""
    low, high = float(speed.min()) * RPM, float(speed.max()) * RPM
    margin = 0.0 if low < high else max(0.05 * low, 1.0)
    return low - margin, high + margin


def prepare(result: RunAnswer) -> Curves:
    """Curves of a study, ready for drawing."""
    r = result.curve
    order = np.argsort(r.speed, kind="stable")
    rpm = r.speed[order] * RPM
    limits = speed_limits(r.speed)
    deflection, branches = _bounded(r.deflection), _bounded(r.branch_deflection)
    size, size_dry = np.abs(deflection), np.abs(_bounded(r.deflection_dry))
    amplitude, amplitude_dry, each = (
        np.where(np.isfinite(x), x, np.nan) for x in (r.amplitude, r.amplitude_dry, r.branch_amplitude)
    )
    lines = [amplitude * MM, amplitude_dry * MM, r.liquid_offset * MM]
    lines.append(lag_degrees(r.liquid_angle, r.liquid_offset))
    lines.append(lag_degrees(phase(deflection), size))
    lines.append(lag_degrees(phase(r.deflection_dry), size_dry))
    table = np.column_stack([*lines, each * MM])[order]
    drawn = thin(table, COLUMNS)
    kept = order[drawn]
    chain, ends = link(branches[kept]), _over_time(result)
    amplitude, amplitude_dry, offset, angle, lag, lag_dry = table[drawn, : len(lines)].T
    return Curves(
        rpm=rpm[drawn],
        limits=limits,
        amplitude=amplitude,
        amplitude_dry=amplitude_dry,
        offset=offset,
        angle=angle,
        phase=lag,
        phase_dry=lag_dry,
        stable=r.stable[kept],
        cycling=result.cycling[kept],
        least=ends[0][kept],
        largest=ends[1][kept],
        branches=table[drawn, len(lines) :],
        branch_stable=r.branch_stable[kept],
        chain=chain,
        reported=_reported(branches[kept], deflection[kept], chain),
        dry_patch=spans(rpm, r.dry_patch[order], limits),
        out_of_range=spans(rpm, ~r.in_range[order], limits),
        not_converged=spans(rpm, ~r.converged[order], limits),
        held=None if result.held is None else _held_curves(result, result.held),
    )


def _over_time(result: RunAnswer) -> tuple[Array, Array]:
    """Least and largest amplitude on the curve, mm, nan where no motion was held, shape (p,).

    At speeds between those asked for their shares of the mean are interpolated: there only the mean is kept.
    """
    curve, held = result.curve, result.held
    if held is None:
        return np.full(curve.speed.shape, np.nan), np.full(curve.speed.shape, np.nan)
    order = np.argsort(result.speed, kind="stable")
    mean = np.where(result.amplitude > 0.0, result.amplitude, np.nan)
    shares = (np.interp(curve.speed, result.speed[order], (end / mean)[order])
              for end in (held.least, held.largest))  # fmt: skip
    least, largest = (
        np.where(np.isin(curve.model, list(HELD_MODELS)), share * curve.amplitude * MM, np.nan)
        for share in shares
    )
    return least, largest


def _held_curves(result: RunAnswer, held: Held) -> HeldCurves:
    """Time-domain states, ready for drawing."""
    order = np.argsort(result.speed, kind="stable")
    mean, apart, drawn = result.amplitude[order], held.hysteresis[order], held.at[order]
    down = np.where(apart, held.amplitude_down[order], np.where(drawn, mean, np.nan))
    return HeldCurves(
        rpm=result.speed[order] * RPM,
        cycle=np.where(held.limit_cycle[order], mean, np.nan) * MM,
        whirl=np.where(held.limit_cycle, held.whirl_speed, np.nan)[order] * RPM,
        down=np.where(widened(apart), down, np.nan) * MM,
        layer=np.abs(held.liquid[order]) * MM,
        swing=held.ripple[order] * MM,
    )


def half_power_bands(x: Array, y: Array) -> list[tuple[float, float, float]]:
    """Lower end, upper end and height of the bands in which a line is above its peak over the root of 2.

    By rising ends; only of peaks that reach a quarter of the highest and whose band has both its ends on the
    line.
    """
    known = ~np.isnan(y)
    x, y = x[known], y[known]
    found: list[tuple[float, float, float]] = []
    if y.size < 3:
        return found
    inside = np.arange(1, y.size - 1)
    tops = inside[(y[1:-1] >= y[:-2]) & (y[1:-1] > y[2:]) & (y[1:-1] >= _LOW * y.max())]
    for top in tops[np.argsort(-y[tops], kind="stable")].tolist():
        level = y[top] / np.sqrt(2.0)
        below = np.flatnonzero(y < level)
        left, right = below[below < top], below[below > top]
        if not left.size or not right.size:
            continue
        ends = [
            np.interp(level, y[[k, n]], x[[k, n]])
            for k, n in ((left[-1], left[-1] + 1), (right[0], right[0] - 1))
        ]
        if not any(low <= x[top] <= high for low, high, _ in found):
            found.append((float(ends[0]), float(ends[1]), float(y[top])))
    return sorted(found)


def windows(lines: Sequence[tuple[Array, Array]], limits: Span) -> list[Span]:
    """At most three spans of speed to draw once more, so that narrow resonances have their width on an axis.

    A resonance is narrow where its half-power band takes less than `NARROW` of the axis; narrow ones close to
    one another share a span. None where they are spread over more than half of the axis.
    """
    whole = limits[1] - limits[0]
    bands = [band for x, y in lines for band in half_power_bands(x, y) if band[1] - band[0] < NARROW * whole]
    highest = max((height for _, _, height in bands), default=0.0)
    groups: list[list[float]] = []
    for low, high, height in sorted(band for band in bands if band[2] >= _LOW * highest):
        room = _ASIDE * (high - low)
        first, last = max(low - room, limits[0]), min(high + room, limits[1])
        if groups and first - groups[-1][1] <= _TOGETHER * whole:
            groups[-1] = [groups[-1][0], max(groups[-1][1], last), max(groups[-1][2], height)]
        else:
            groups.append([first, last, height])
    kept = sorted(sorted(groups, key=lambda group: -group[2])[:_MOST_WINDOWS])
    if sum(last - first for first, last, _ in kept) > _MOST_WIDE * whole:
        return []
    return [(first, last) for first, last, _ in kept]


def cut(curves: Curves, window: Span) -> Curves:
    """The curves within a span of speed, and one point beyond either end of it."""
    first = max(int(np.searchsorted(curves.rpm, window[0], side="right")) - 1, 0)
    last = int(np.searchsorted(curves.rpm, window[1], side="left")) + 1
    inside = _rows(curves, slice(first, last))
    if curves.held is not None:
        # No point of another grid may stand outside, but for those that lines lead to.
        low, high = np.searchsorted(curves.held.rpm, window)
        held = slice(max(int(low) - 1, 0), int(high) + 1)
        inside["held"] = replace(curves.held, **_rows(curves.held, held))
    for name in ("dry_patch", "out_of_range", "not_converged"):
        inside[name] = [
            (max(low, window[0]), min(high, window[1]))
            for low, high in getattr(curves, name)
            if low < window[1] and high > window[0]
        ]
    return replace(curves, limits=window, **inside)


def _rows(curves: Curves | HeldCurves, part: slice) -> dict[str, Any]:
    """Every array over the speeds at some of them."""
    values = {item.name: getattr(curves, item.name) for item in fields(curves)}
    return {name: value[part] for name, value in values.items() if isinstance(value, np.ndarray)}


def median_over(x: Array, y: Array) -> float:
    """Value that a line exceeds over half of its extent, however its points are spread."""
    if x[-1] <= x[0]:
        return float(np.median(y))
    weight = np.gradient(x) if x.size > 1 else np.ones(1)
    order = np.argsort(y, kind="stable")
    share = np.cumsum(weight[order])
    return float(y[order][np.searchsorted(share, 0.5 * share[-1])])


def gapped(x: Array, y: Array, breaks: Flags) -> tuple[Array, Array]:
    """Line with a gap after each point where it breaks."""
    after = np.flatnonzero(breaks) + 1
    return np.insert(x, after, np.nan), np.insert(y, after, np.nan)


def joined(lines: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Several lines as one, with gaps between them."""
    gap = np.array([np.nan])
    parts = [(np.append(x, gap), np.append(y, gap)) for x, y in lines] or [(gap, gap)]
    return np.concatenate([x for x, _ in parts]), np.concatenate([y for _, y in parts])


def widened(mask: Flags) -> Flags:
    """The mask and its neighbours, shape (p,)."""
    wide = mask.copy()
    wide[1:] |= mask[:-1]
    wide[:-1] |= mask[1:]
    return wide


def lonely(y: Array) -> Flags:
    """Points without a neighbour to draw a line to, shape (p,)."""
    known = ~np.isnan(y)
    alone = known.copy()
    alone[1:] &= ~known[:-1]
    alone[:-1] &= ~known[1:]
    return alone


def _fold_tips(curves: Curves, row: int, beyond: int) -> list[tuple[Array, Array]]:
    """Short lines at one speed between each two branches that are not there any more beyond it."""
    gone = np.setdiff1d(curves.chain[row], curves.chain[beyond])
    if not np.any(curves.chain[beyond] >= 0):  # nothing was found there: no fold
        return []
    ends = np.sort(curves.branches[row, np.isin(curves.chain[row], gone[gone >= 0])])
    return [(np.repeat(curves.rpm[row], 2), pair) for pair in ends[: ends.size // 2 * 2].reshape(-1, 2)]


def other_branches(curves: Curves) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Amplitudes of stable branches, and of unstable ones with the folds' tips: rpm and mm, with gaps."""
    stable, unstable = [], []
    for number in range(int(curves.chain.max(initial=-1)) + 1):
        point, column = np.nonzero(curves.chain == number)
        x, y, calm = curves.rpm[point], curves.branches[point, column], curves.branch_stable[point, column]
        stable.append((x, np.where(calm, y, np.nan)))
        unstable.append((x, np.where(widened(~calm), y, np.nan)))
    changes = np.flatnonzero(np.any(curves.chain[1:] != curves.chain[:-1], axis=1))
    for row in changes.tolist():
        unstable += _fold_tips(curves, row, row + 1) + _fold_tips(curves, row + 1, row)
    return joined(stable), joined(unstable)
