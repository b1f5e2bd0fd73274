"""Limit cycles of a rotor with liquid layers over speed: where branches start, and their properties."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.whirl import plane_layer
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.cycles.balance import Circular, NotCircularError, circular
from solvers.cycles.branch import Cycle, Follower, MakeWave
from solvers.cycles.edges import Edge, small_whirl_edges
from solvers.cycles.estimate import estimated_whirl, undamped_bands, unsettled
from solvers.cycles.family import FamilyWave, family_growth
from solvers.cycles.floquet import disturbance_growth
from solvers.cycles.wave import StandingWave
from solvers.rotor.system import Rotor

CELLS = 64
FEWEST = 32
# Of the first and of the last speed: whirls are followed so far below the range, where a band may begin, and
# edges are looked for so far beyond it, from which a branch may come back.
_BELOW, _ABOVE = 0.6, 1.5
_SHARES = (0.3, 0.5, 0.15, 0.75)  # of a band, where the first whirl of a branch is looked for
_LARGE = 0.8  # of the depth: a first whirl that would be larger is looked for nearer to the edge
# Trough of the wave over its layer's depth: at the first whirl from an edge, and where a branch comes to one.
_FIRST, _SMALL = (0.05, 0.03, 0.1, 0.2), 0.02
_STRAYED = 0.1  # relative: a first whirl this far from its edge belongs to another
# Two whirls are one that are nearer in spin and whirl speed over that of the edge, and in the weighted size.
_SAME, _THICK = 2e-3, 0.05
_ON = 2e-4  # the same for parts of one branch that overlap: at a kink its two arms lie close together
_BEYOND = 2.0  # of the last step of a branch: what it goes on to the edge
_POINTS = 400
_LENGTH = 0.1  # of the speed: what counts along a branch as much as its largest amplitude
_BROKEN = "no further whirl was found"
_PROMINENT = 1e-3  # relative: cells move a branch by half of that, a smaller turn is no fold to be told
FAST_LAG = 1.0 / 3.0  # of the spin: beyond that the flow's profile no longer describes the lagging liquid


class HeldWhirl(NamedTuple):
    """A limit cycle at a speed: amplitude, m, whirl speed and lag of the liquid, rad/s, and stability."""

    amplitude: float
    whirl_speed: float
    lag: float
    stable: bool


@dataclass(frozen=True)
class Branch:
    """Limit cycles one after the other; k of them, c chambers."""

    speed: Array  #: Omega and omega_w, rad/s, shape (k,)
    whirl_speed: Array
    deflection: Complex  #: of each chamber's axis in the frame of the whirl, complex, m, shape (k, c)
    #: by which the liquid of each chamber turns more slowly than the drum, rad/s, nan where there is no
    #: layer, shape (k, c)
    lag: Array
    #: of the disturbance that grows most, 1/s, below 0 where the whirl is stable, shape (k,); where it was
    #: not found that between its neighbours, nan where it was found nowhere
    growth: Array
    torque: Array  #: that the drive has to supply on top, N m, shape (k,)
    thinnest: Array  #: least depth of a layer over its mean depth, shape (k,)
    folds: tuple[int, ...]  #: indices of the whirls next to a fold, where the branch turns back in speed
    fold_speed: tuple[float, ...]  #: there, by a parabola through three whirls, rad/s and m
    fold_amplitude: tuple[float, ...]
    reason: tuple[str, str]  #: why it ends where it ends, at the first whirl and at the last one

    @property
    def amplitude(self) -> Array:
        """Deflection of the first chamber's axis, m, shape (k,)."""
        return np.asarray(np.abs(self.deflection[:, 0]))

    @property
    def stable(self) -> Flags:
        """Whether small disturbances decay, shape (k,)."""
        return np.asarray(self.growth < 0.0)

    @property
    def power(self) -> Array:
        """Power of the drive on top, W, shape (k,)."""
        return np.asarray(self.torque * self.speed)

    def at(self, speed: float) -> list[HeldWhirl]:
        """Amplitude, whirl speed, lag and stability of every whirl of the branch at a speed.

        Values between two whirls go along a smooth curve.
        """
        found = []
        for k in range(self.speed.size - 1):
            first, last = self.speed[k], self.speed[k + 1]
            low, high = min(first, last), max(first, last)
            # A whirl between two pieces of the branch belongs to the first one.
            if low == high or not low <= speed <= high or (k > 0 and speed == first):
                continue
            place = self._place(k, speed)
            _, size, turning, behind = self._curve(place).tolist()
            found.append(HeldWhirl(size, turning, behind, bool(self.stable[k] and self.stable[k + 1])))
        return found

    @cached_property
    def _curve(self) -> Callable[[float], Array]:
        """Speed, amplitude, whirl speed and lag over the number of the whirl."""
        rows = np.column_stack([self.speed, self.amplitude, self.whirl_speed, np.nanmax(self.lag, axis=1)])
        if len(rows) < 3:
            return lambda place: rows[0] + place * (rows[-1] - rows[0])
        from scipy.interpolate import Akima1DInterpolator

        # Over the length of the branch, in which its whirls lie as they were followed.
        scale = np.array([_LENGTH * self.speed.max(), self.amplitude.max()])
        steps = np.sqrt(np.square(np.diff(rows[:, :2], axis=0) / scale).sum(axis=1))
        arc = np.concatenate([[0.0], np.cumsum(np.maximum(steps, 1e-9))])
        curve = Akima1DInterpolator(arc, rows, method="makima")
        numbers = np.arange(len(arc))
        return lambda place: np.asarray(curve(np.interp(place, numbers, arc)))

    def _place(self, piece: int, speed: float) -> float:
        """Number of a whirl, with its part of a piece, at a speed between those of the ends of the piece."""
        from scipy.optimize import brentq

        ends = [float(self.speed[k]) - speed for k in (piece, piece + 1)]
        if 0.0 in ends:
            return float(piece + ends.index(0.0))
        return float(brentq(lambda place: float(self._curve(place)[0]) - speed, piece, piece + 1, xtol=1e-9))


@dataclass(frozen=True)
class LimitCycles:
    """All limit cycles that were found."""

    branches: tuple[Branch, ...]  #: each through its folds
    reason: str = ""  #: why there are none, or what is not among them; empty if nothing is to be said

    def largest_stable(self, speed: float) -> float:
        """Amplitude of the largest stable whirl at a speed, m; 0 where there is none."""
        whirls = [whirl for branch in self.branches for whirl in branch.at(speed)]
        return max((whirl.amplitude for whirl in whirls if whirl.stable), default=0.0)


def limit_cycles(
    rotor: Rotor,
    fills: Sequence[Fill],
    speeds: tuple[float, float],
    friction: Friction,
    cells: int = CELLS,
    progress: Callable[[int, float], None] | None = None,
    wave: MakeWave = StandingWave,
) -> LimitCycles:
    """Self-excited whirls of finite size over a range of speeds [theory: whirl, eq. 21-28].

    Circles, without unbalance and gravity; branches are followed somewhat below the first speed. No branches,
    with the reason, for unlike supports, baffles, or without the friction or damping that bounds the whirl.
    """
    first, last = speeds
    if not 0.0 < first < last:
        raise InputError("speeds", speeds, "rising and above 0")
    if cells < FEWEST:
        raise InputError("cells", cells, f"at least {FEWEST}")
    try:
        machine = circular(rotor.system(), fills, friction)
    except NotCircularError as why:
        return LimitCycles((), str(why))
    why_not = unsettled(machine, friction)
    if why_not:
        return LimitCycles((), why_not)
    finder = _Finder(machine, friction, cells, (_BELOW * first, last), progress, wave=wave)
    finder.search(rotor, fills)
    return LimitCycles(tuple(finder.branches), finder.reason())


def largest_whirl(
    rotor: Rotor, fills: Sequence[Fill], speeds: Array, friction: Friction, cells: int = FEWEST
) -> float:
    """Amplitude of the largest self-excited whirl at any of some speeds, m, on few cells; see `limit_cycles`.

    A stable one, whether a small one grows there or an impulse has to start it: the unstable branch lies
    below. The estimate where the whirl would lay a thin layer dry; 0 where none grows, infinite where nothing
    bounds one.
    """
    if not any(plane_layer(fill, friction) for fill in fills):
        return 0.0
    machine = circular(rotor.system(), fills, friction)
    if unsettled(machine, friction):
        return np.inf if not np.abs(machine.damping).max() > 0.0 else 0.0
    # A single speed still needs a way to it.
    range_ = (_BELOW * float(speeds[0]), float(speeds[-1]) * (1.0 + 1e-3))
    finder = _Finder(machine, friction, cells, range_, None, judged=False)
    finder.search(rotor, fills)
    whirls = [whirl for branch in finder.branches for speed in speeds.tolist() for whirl in branch.at(speed)]
    largest = max((whirl.amplitude for whirl in whirls), default=0.0)
    for lower, upper, near in finder.missed:
        inside = [speed for speed in speeds.tolist() if lower < speed < upper]
        rules = [estimated_whirl(machine, friction, lower, near, speed) for speed in inside]
        largest = max([largest, *(rule.amplitude for rule in rules)])
    return largest


class _Finder:
    """Branches of a machine within a range of speeds; `judged`: find what becomes of disturbances.

    `missed`: bands of the undamped machine without a whirl found (edges and a frequency); `lost`: spins of
    edges from which no branch could be followed; `tried`: starts, from edges and inside bands.
    """

    def __init__(
        self,
        machine: Circular,
        friction: Friction,
        cells: int,
        range_: tuple[float, float],
        progress: Callable[[int, float], None] | None,
        judged: bool = True,
        wave: MakeWave = StandingWave,
    ) -> None:
        self.judged, self.wave = judged, wave
        self.machine, self.friction, self.cells, self.range = machine, friction, cells, range_
        self.progress, self.count = progress, 0
        self.branches: list[Branch] = []
        self.rows: list[list[_Row]] = []  # of each branch
        self.missed: list[tuple[float, float, float]] = []
        self.lost: list[float] = []
        self.tried = 0

    def search(self, rotor: Rotor, fills: Sequence[Fill]) -> None:
        """Find the branches from all edges, then those of large whirls inside the bands."""
        low, high = self.range
        for edge in small_whirl_edges(self.machine, (low, _ABOVE * high)):
            self.tried += 1
            self._from_edge(edge)
        for lower, upper, near in undamped_bands(rotor, fills, (low, _ABOVE * high)):
            if lower < high:
                self.tried += 1
                self._from_inside(lower, min(upper, high), near)

    def reason(self) -> str:
        """Why there are no branches, or what may be missing among them; empty if nothing is to be said."""
        if not self.tried:
            return "no self-excited whirl in this range"
        if not self.branches:
            return "no limit cycle was found"
        said = []
        if self.lost:
            spins = ", ".join(f"{spin:.4g}" for spin in self.lost)
            said.append(f"no branch was found from the edges of bands at {spins} rad/s")
        ends = [
            float(branch.speed[k])
            for branch in self.branches
            for k, why in ((0, branch.reason[0]), (-1, branch.reason[1]))
            if why == _BROKEN
        ]
        if ends:
            spins = ", ".join(f"{spin:.4g}" for spin in ends)
            said.append(f"branches could not be followed beyond {spins} rad/s")
        return "; ".join(said)

    def _from_edge(self, edge: Edge) -> None:
        """The branch from an edge of a band, at which a small whirl neither grows nor decays."""
        follower = Follower(self.machine, self.friction, self.cells, edge.spin, self.wave)
        start = None
        for trough in _FIRST:
            size = trough / edge.trough / follower.depth
            start = follower.start(edge.moved, edge.whirl_speed, edge.spin, size, hold_size=True)
            if start is not None and abs(start.spin / edge.spin - 1.0) < _STRAYED:
                break
            start = None
        if start is None:
            if self._inside(edge.spin):
                self.lost.append(edge.spin)
            return
        if self._known(follower, start):
            return
        found, why = self._follow(follower, start)
        if self._inside(start.spin):
            found = [self._row(follower, start), *found]
        if found:
            self._add(follower, found, ("edge of the band", why))

    def _from_inside(self, lower: float, upper: float, near: float) -> None:
        """The branch of a large whirl inside a band, where none of the others leads to it."""
        follower = Follower(self.machine, self.friction, self.cells, lower, self.wave)
        for share in _SHARES:
            spin = lower + share * (upper - lower)
            guess = estimated_whirl(self.machine, self.friction, lower, near, spin)
            while guess.amplitude > _LARGE * follower.depth and spin > lower * 1.002:
                spin = lower + 0.6 * (spin - lower)
                guess = estimated_whirl(self.machine, self.friction, lower, near, spin)
            size = min(guess.amplitude / follower.depth, 1.2 * _LARGE)
            start = follower.start(guess.moved, guess.whirl_speed, spin, size, guess.lag)
            if start is not None and 1.0 - follower.thinnest(start) > _SMALL:
                if not self._known(follower, start):
                    self._add(follower, *self._both_ways(follower, start))
                return
        if not any(branch.at(0.5 * (lower + upper)) for branch in self.branches):
            self.missed.append((lower, upper, near))

    def _known(self, follower: Follower, cycle: Cycle) -> bool:
        """Whether a limit cycle lies on a branch that has been found."""
        size = float(np.abs(self.machine.rows @ cycle.moved)[0])
        return any(
            _lies_on(branch, follower, (cycle.spin, cycle.whirl_speed, size)) for branch in self.branches
        )

    def _add(self, follower: Follower, rows: list[_Row], reason: tuple[str, str]) -> None:
        """Take in a branch; one with which it shares an end that could not be followed is the same one.

        There both come to a kink of the limiter, where rounding decides whether Newton's steps pass it.
        """
        for k, branch in enumerate(self.branches):
            if reason[1] == _BROKEN == branch.reason[1] and _lies_on(branch, follower, rows[-1].place):
                first = self.rows.pop(k)
                while len(rows) > 1 and _lies_on(branch, follower, rows[-1].place, 0.0, _ON):
                    rows.pop()
                gap = np.subtract(first[-1].place, rows[-1].place) / follower.scales
                end = first[-1].arc + float(np.linalg.norm(gap))
                back = [replace(row, arc=end + rows[-1].arc - row.arc) for row in reversed(rows)]
                rows, reason = first + back, (self.branches.pop(k).reason[0], reason[0])
                break
        self.rows.append(rows)
        self.branches.append(_branch(rows, reason))

    def _both_ways(self, follower: Follower, start: Cycle) -> tuple[list[_Row], tuple[str, str]]:
        parts, reasons = [], []
        for way in (-1.0, 1.0):
            begin = replace(start, tangent=way * start.tangent, sense=way * start.sense)
            found, why = self._follow(follower, begin)
            parts.append([replace(row, arc=way * row.arc) for row in found])
            reasons.append(why)
        rows = [*reversed(parts[0]), self._row(follower, start), *parts[1]]
        return rows, (reasons[0], reasons[1])

    def _follow(self, follower: Follower, start: Cycle) -> tuple[list[_Row], str]:
        """Whirls on from one, and why the last one is the last; those out of the range are left out."""
        rows: list[_Row] = []
        last, entered = 1.0 - follower.thinnest(start), self._inside(start.spin)
        for cycle in follower.after(start):
            trough, inside = 1.0 - follower.thinnest(cycle), self._inside(cycle.spin)
            if trough < min(_SMALL, last):
                return rows, "edge of the band"
            last = trough
            if not inside and not entered:
                # A branch from beyond the range is followed as long as it comes nearer.
                if self._distance(cycle.spin) > self._distance(start.spin):
                    return rows, "end of the range of speeds"
                continue
            if not entered and self._known(follower, cycle):
                return rows, "end of the range of speeds"
            if entered and not inside:
                found = follower.at(cycle, float(np.clip(cycle.spin, *self.range)))
                cycle = cycle if found is None else found
            entered = True
            rows.append(self._row(follower, cycle))
            self.count += 1
            if self.progress is not None:
                self.progress(self.count, cycle.spin)
            if not inside:
                return rows, "end of the range of speeds"
            place = rows[-1].place
            if any(b.reason[1] == _BROKEN and _lies_on(b, follower, place, 0.0, _ON) for b in self.branches):
                # Onto a branch that came to its end at a kink from the other side: `_add` joins the two.
                return rows, _BROKEN
            if len(rows) >= _POINTS:
                return rows, "so many whirls were found that the rest was left"
        return rows, _BROKEN

    def _inside(self, spin: float) -> bool:
        return self.range[0] <= spin <= self.range[1]

    def _distance(self, spin: float) -> float:
        """How far a spin is from the range, rad/s."""
        return max(self.range[0] - spin, spin - self.range[1], 0.0)

    def _row(self, follower: Follower, cycle: Cycle) -> _Row:
        machine = self.machine
        rows = np.array([place.row for place in machine.places])
        size = np.square(np.abs(rows @ cycle.moved))
        mass = np.array([place.full_mass for place in machine.places])
        lag = np.full(len(machine.rows), np.nan)
        for place, turning in zip(machine.places, cycle.turning, strict=True):
            lag[list(place.which)] = -turning
        return _Row(
            speed=cycle.spin,
            whirl_speed=cycle.whirl_speed,
            deflection=machine.rows @ cycle.moved,
            lag=lag,
            growth=self._growth(follower, cycle),
            torque=float(cycle.whirl_speed**2 * (mass * size * cycle.force.imag).sum()),
            thinnest=follower.thinnest(cycle),
            arc=cycle.arc,
        )

    def _growth(self, follower: Follower, cycle: Cycle) -> float:
        """Growth of the disturbance that grows most, 1/s; nan where it was not found."""
        if not self.judged:
            return float("nan")
        families = [wave for wave in follower.waves if isinstance(wave, FamilyWave)]
        if families:
            return family_growth(self.machine, families, cycle)
        volumes = [wave for wave in follower.waves if isinstance(wave, StandingWave)]
        found = disturbance_growth(self.machine, volumes, cycle)
        return float("nan") if found is None else found


@dataclass(frozen=True)
class _Row:
    """A limit cycle as a branch tells it, see `Branch`."""

    speed: float
    whirl_speed: float
    deflection: Complex
    lag: Array
    growth: float
    torque: float
    thinnest: float
    arc: float

    @property
    def place(self) -> tuple[float, float, float]:
        """Spin and whirl speed, rad/s, and amplitude, m."""
        return self.speed, self.whirl_speed, float(np.abs(self.deflection[0]))


def _lies_on(
    branch: Branch,
    follower: Follower,
    place: tuple[float, float, float],
    beyond: float = _BEYOND,
    same: float = _SAME,
) -> bool:
    """Whether a whirl lies on a branch, which goes on beyond its ends by so much of its last steps."""
    weights = np.array([1.0 / follower.speed, 1.0 / follower.speed, _THICK / follower.depth])
    rows = weights * np.column_stack([branch.speed, branch.whirl_speed, branch.amplitude])
    if len(rows) < 2:
        return False
    point = weights * np.array(place)
    way = np.diff(rows, axis=0)
    part = ((point - rows[:-1]) * way).sum(axis=1) / np.maximum(np.square(way).sum(axis=1), 1e-300)
    least, most = np.zeros(len(way)), np.ones(len(way))
    least[0], most[-1] = -beyond, 1.0 + beyond
    gap = rows[:-1] + np.clip(part, least, most)[:, None] * way - point
    return bool(np.sqrt(np.square(gap).sum(axis=1)).min() < same)


def _branch(rows: list[_Row], reason: tuple[str, str]) -> Branch:
    """A branch from its whirls, the slow end first."""
    names = ("speed", "whirl_speed", "deflection", "lag", "growth", "torque", "thinnest")
    values = {name: np.array([getattr(row, name) for row in rows]) for name in names}
    amplitude, arc = np.abs(values["deflection"][:, 0]), np.array([row.arc for row in rows])
    known = np.isfinite(values["growth"])
    if known.any():
        # Between its neighbours where it is not known.
        filled = np.interp(arc, arc[known], values["growth"][known])
        # At single whirls a kink of the limiter may hide it: the middle one of three neighbours counts.
        wide = np.concatenate([filled[:1], filled, filled[-1:]])
        values["growth"] = np.median([wide[:-2], wide[1:-1], wide[2:]], axis=0)
    turns = _turns(values["speed"])
    near = [slice(k - 1, k + 2) for k in turns]
    folds = [_fold(arc[at], values["speed"][at], amplitude[at]) for at in near]
    return Branch(
        **values,
        folds=tuple(turns),
        fold_speed=tuple(speed for speed, _ in folds),
        fold_amplitude=tuple(size for _, size in folds),
        reason=reason,
    )


def _turns(speed: Array) -> list[int]:
    """Whirls at which a branch turns back in speed, small turns to and fro left out."""
    found: list[int] = []
    best, way = 0, 0
    for k in range(1, speed.size):
        step = (speed[k] - speed[best]) / speed[best]
        if way == 0:
            if abs(step) > _PROMINENT:
                way, best = int(np.sign(step)), k
        elif way * step > 0.0:
            best = k
        elif abs(step) > _PROMINENT:
            found.append(best)
            way, best = -way, k
    return [k for k in found if 0 < k < speed.size - 1]


def _fold(arc: Array, speed: Array, amplitude: Array) -> tuple[float, float]:
    """Speed and amplitude where the parabola of speed over arc through three whirls turns back."""
    place = arc - arc[1]
    bend, slope, _ = np.polyfit(place, speed, 2)
    top = float(np.clip(-0.5 * slope / bend, place.min(), place.max())) if bend else 0.0
    at = [float(np.polyval(np.polyfit(place, part, 2), top)) for part in (speed, amplitude)]
    return at[0], at[1]
