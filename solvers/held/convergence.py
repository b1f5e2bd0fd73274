"""How a motion is judged by its turns: whether it has converged, to what, and where it is bound for.

Of every turn of the drum, the unit of time, three numbers are kept: mean, least and largest distance of the
axis from where it rests; their changes decide what the motion is.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from meshes.arrays import Array, Complex, Flags, Index
from solvers.held.state import (
    SHORT,
    HeldKind,
    HeldMachine,
    HeldState,
    HoldNumerics,
    Moment,
    PeriodicMotion,
)
from solvers.layer.inside import full_area
from solvers.layer.records import Outcome
from solvers.runup.path import FINE, apart, evenly, fastest_frequency
from solvers.runup.runup import EnergyAudit
from solvers.runup.state import WORKS, mean_area, planes_of

# Turns after which a motion may be called periodic, and one that begins on an orbit that is known; a limit
# cycle is judged over windows from `_LONG` on.
FEW, KNOWN, _LONG = 4, 2, 32
# Turns after which a motion that may whirl is compared with the orbit next to it, if it has not converged and
# its swing is smaller than three pieces of so many turns before: it decays to that where it comes closer as
# the orbit's multiplier says, within these factors of the rate.
_LOOKS, _PIECE, _SMALLER, _SLOWER, _FASTER = (64, 128, 256, 512), 16, 0.98, 0.5, 2.0
_SHORT = 2  # turns of a motion that repeats, of which the path is kept
_EVEN = 0.5  # times the tolerance, that a circle may wobble
_ELSEWHERE = 20.0  # times the tolerance, that the axis may be off after a turn that repeats
_LINES = 2  # multiples of the spin that are no whirl of their own, either way
_RESTS = 1e-7  # of the amplitude, that a stable equilibrium may move in a turn
_GROWN = 8.0  # logarithm by which a whirl that grows has to have grown
_QUICK = 2.0  # logarithm by which quick small motions grow or die in the shortest window
_FALL = 0.5  # logarithm by which a motion that dies does so in a window
_MARKS = 8  # turns from which it is guessed where a motion is bound for
_TRIES = 8  # how often
# An orbit is nudged by this share, watched for so many turns at a time, and called stable or not where its
# distance has changed by that factor, or has gone down to that share.
_NUDGE, _PROBED, _SURE, _LEFT = 0.002, 16, 1.1, 0.2
_NOISE, _FAR = 1e-3, 1e3  # what counts as noise there; weights beyond which a guess is none
_DIES = 0.8  # of the spread of a window's means in the next, where the motion dies
_ALIKE = 0.02  # of the amplitude, by which the extremes of two windows of a limit cycle may differ
_ELASTIC, _ROUNDING = 1e-3, 1e-12  # of the elastic and of the spun energy: no balance is measured by less
_SWING = 0.1  # of the way between the extremes, by which that may
_MEANS = 5.0  # times the tolerance, by which their means may
_LIES = 0.5  # of the spin, by which liquid that has filled its gap lags where it lies at the bottom


@dataclass
class _Probe:
    """An orbit that was guessed, while it is looked at whether it is stable."""

    state: Array  #: on it
    end: Array  #: from `Watch._seen`
    rows: list[Array]  #: what the watch knew of it
    sizes: list[tuple[float, float, float]]
    kind: HeldKind
    #: how far the motion is from it at the end of each turn since it was nudged
    gaps: list[float] = field(default_factory=list)


class Watch:
    """What the turns have been like, and whether that is enough to judge by."""

    def __init__(
        self,
        machine: HeldMachine,
        begin: Moment,
        numerics: HoldNumerics,
        slowest: float,
        near: Callable[[Moment], PeriodicMotion | None] | None = None,
        few: int = FEW,
        guesses: bool = True,
    ) -> None:
        self.machine, self.begin, self.numerics = machine, begin, numerics
        #: what looks for a stable motion that repeats next to a moment; one that the motion decays to
        self.near = near
        self.orbit: PeriodicMotion | None = None
        self.few = few
        #: whether it is guessed where the motion is bound for: not where that was looked for before
        self.guesses = guesses
        self.planes = planes_of(machine.system, machine.fills)
        self.seen = self.planes[0] if machine.fills else machine.system.centre
        # Growth in a turn.
        self.slowest = slowest * 2.0 * math.pi / begin.spin
        self.window = _LONG
        if slowest != 0.0:
            self.window = max(_LONG, math.ceil(_FALL / abs(self.slowest)))
        self.window = min(self.window, numerics.turns // 2)
        self.quick = abs(self.slowest) * _LONG > _QUICK
        self.count, self.steps = 0, 0
        #: of each turn, where they are told: works and heats as `WORKS`, "bores" with what the scheme gives
        #: back, and what the energy gains, J
        self.balances: list[Array] = []
        self.forget(begin.layers)

    def forget(self, layers: Flags) -> None:
        """Begin anew with these chambers' layers, as after one has fallen."""
        self.which = np.flatnonzero(layers)
        fills = [self.machine.fills[j] for j in self.which.tolist()]
        self.gaps = np.array([full_area(fill) * fill.chamber.radius**2 for fill in fills])
        self.lying = np.zeros(len(fills), dtype=int)  # turns on end that each layer has lain at the bottom
        self.rows: list[Array] = []
        self.sizes: list[tuple[float, float, float]] = []
        self.areas: list[tuple[Array, Array]] = []
        self.marks: list[Array] = []
        self.tries, self.span = 0, self.few
        self.probe: _Probe | None = None
        self.kind, self.change = HeldKind.NOT_SETTLED, math.inf

    def turn(self, steps: Array, layers: Array, state: Any) -> bool:
        """Take a turn; whether that is enough."""
        self.count += 1
        self.steps += len(steps)
        self.rows.append(steps)
        del self.rows[: -2 * self.window]
        size = np.abs(self._deflection(steps))
        weight = np.diff(steps[:, 0], prepend=2.0 * steps[0, 0] - steps[1, 0])
        self.sizes.append((float(size @ weight / weight.sum()), float(size.min()), float(size.max())))
        self.areas.append((layers.min(axis=(0, 2)), layers.sum(axis=2)[-1]))
        if self._lies(layers, state).any():
            return True
        if self.probe is not None:
            return self._probed(state)
        if not self._judge():
            self._accelerate(state)
            return self._decays(state)
        # A guess leads to an orbit whether or not that is stable: a motion that marched there is.
        if self.tries == 0 or self.kind is HeldKind.LIMIT_CYCLE:
            return True
        self.probe = _Probe(
            state.data.copy(), self._seen(steps), list(self.rows), list(self.sizes), self.kind
        )
        n = self.begin.coordinates.size
        state.data[-2 * n :] *= 1.0 + _NUDGE
        return False

    @property
    def down(self) -> Flags:
        """Layers that have lain at the bottom long enough to be a mass that does not turn."""
        return np.asarray(self.lying >= SHORT)

    def _lies(self, layers: Array, state: Any) -> Flags:
        """Count the turns in which gravity holds a layer between the walls at the bottom; `down`.

        Without an inner wall its steps would have failed at the axis.
        """
        if self.machine.gravity == 0.0 or self.machine.liquid != "long_wave":
            return self.down
        full = layers.max(axis=(0, 2)) > self.gaps
        if full.any():
            area, momentum = state.data[: full.size], state.data[full.size : 2 * full.size]
            spin = self.begin.spin
            full &= _mean_rotation(self.machine, spin, area, momentum, self.which) < -_LIES * spin
        self.lying = np.where(full, self.lying + 1, 0)
        return self.down

    def _seen(self, steps: Array) -> Array:
        """Coordinates and moments of the layers at the end of a turn, each over the size it has in it."""
        size = np.abs(steps[:, 2:]).max(axis=0)
        n = self.begin.coordinates.size
        for part in (slice(0, n), slice(n, None)):
            size[part] = size[part].max(initial=0.0)
        return np.asarray(np.append(steps[-1, 2:], size))

    def _probed(self, state: Any) -> bool:
        """Whether an orbit that was nudged has shown what becomes of it; back to it where it is stable."""
        probe = self.probe
        assert probe is not None
        ends, size = np.split(probe.end, 2)
        gap = np.abs(self.rows[-1][-1, 2:] - ends) / np.maximum(size, 1e-300)
        probe.gaps.append(float(gap.max()))
        if len(probe.gaps) % _PROBED:
            return False
        late, soon = max(probe.gaps[-SHORT:]), max(probe.gaps[-2 * SHORT : -SHORT])
        if late > soon * _SURE and late > _NUDGE:
            # It is left for good: the motion goes on by itself from here.
            self.probe, self.tries, self.slowest, self.sizes = None, _TRIES, 0.0, []
            self.kind, self.change = HeldKind.NOT_SETTLED, math.inf
            return False
        if late * _SURE > soon and late > _LEFT * _NUDGE and len(probe.gaps) < 4 * _PROBED:
            return False
        state.data[...] = probe.state
        self.rows, self.sizes, self.kind = probe.rows, probe.sizes, probe.kind
        return True

    def _accelerate(self, state: Any) -> None:
        """Put the state where the last turns are bound for, while a stable motion still moves there."""
        if self.slowest >= 0.0 or self.tries >= _TRIES or not self.guesses:
            return
        self.marks.append(state.data.copy())
        if len(self.marks) <= _MARKS + 1:
            return
        found = _limit(self.marks, self.begin.coordinates.size)
        if found is not None:
            state.data[...] = found
        self.marks, self.tries = [], self.tries + 1
        self.sizes = self.sizes[:0]

    def _deflection(self, steps: Array) -> Complex:
        """Deflection of the axis that is watched, standing frame, at every step."""
        place = steps[:, 2 : 2 + self.seen.shape[1]]
        return np.asarray(place @ self.seen[0] + 1j * (place @ self.seen[1]))

    def _judge(self) -> bool:
        """Whether the motion has settled, and to what."""
        sizes, done = np.array(self.sizes), len(self.sizes)
        scale = float(sizes[-SHORT:, 2].max())
        if scale == 0.0:
            self.kind, self.change = HeldKind.STEADY, 0.0
            return done >= 2
        if self.slowest < 0.0 and done >= 2 and np.ptp(sizes[-2:]) <= _RESTS * scale:
            self.change = float(np.ptp(sizes[-2:]) / scale)
            self.kind = self._repeating(self.change)
            return True
        left = self._left(sizes, scale)
        if left <= self.numerics.tolerance:
            wobble = float(np.ptp(sizes[-FEW:])) / scale
            self.kind = self._repeating(wobble)
            self.change, self.span = left, self.few
            # A circle that the axis does not run through in a turn is a whirl of its own.
            if self._elsewhere(scale):
                self.kind, self.span = HeldKind.LIMIT_CYCLE, 2 * SHORT
            return True
        return done % (self.window // 2) == 0 and self._bounded(sizes, scale)

    def _repeating(self, wobble: float) -> HeldKind:
        """Kind of a motion that repeats every turn and wobbles by so much of the amplitude.

        Gravity across the axis makes every layer ripple, however little of that the axis shows.
        """
        ripples = self.machine.gravity > 0.0 and self.begin.layers.any()
        even = wobble <= _EVEN * self.numerics.tolerance and not ripples
        return HeldKind.STEADY if even else HeldKind.PERIODIC

    def _elsewhere(self, scale: float) -> bool:
        """Whether the axis is not where it was a turn before."""
        ends = self._deflection(np.stack([rows[-1] for rows in self.rows[-2:]]))
        return bool(abs(ends[1] - ends[0]) > _ELSEWHERE * self.numerics.tolerance * scale)

    def _left(self, sizes: Array, scale: float) -> float:
        """What may still come of the amplitude's change, over its size, if the motion repeats every turn."""
        if self.slowest < 0.0:
            if len(sizes) < self.few:
                return math.inf
            # No motion dies more slowly than the slowest.
            each = float(np.ptp(sizes[-self.few :], axis=0).max()) / scale / (self.few - 1)
            return each / -math.expm1(self.slowest)
        if len(sizes) < 2 * SHORT:
            return math.inf
        parts = sizes[-SHORT:], sizes[-2 * SHORT : -SHORT]
        late, soon = (float(np.ptp(part, axis=0).max()) / scale for part in parts)
        # A whirl that linear theory lets grow has had its time, or has died all the same.
        wanted = _GROWN if self.slowest > 0.0 else 0.0
        if self.slowest * self.count < wanted and not self._died(sizes, scale):
            return math.inf
        if late <= 0.25 * self.numerics.tolerance:
            return late
        share = late / soon if soon > late else 1.0
        return late * max(1.0, share / max(1.0 - share, 1e-3))

    def _died(self, sizes: Array, scale: float) -> bool:
        """Whether a whirl has decayed that grows in linear theory: unbalance and gravity may hold the layer.

        Over windows in which it would have grown visibly, and to far below the tolerance.
        """
        if len(sizes) < 2 * self.window:
            return False
        parts = sizes[-self.window :], sizes[-2 * self.window : -self.window]
        late, soon = (float(np.ptp(part, axis=0).max()) / scale for part in parts)
        return late <= 0.25 * self.numerics.tolerance and late < (1.0 - _SWING) * soon

    def _bounded(self, sizes: Array, scale: float) -> bool:
        """Whether two windows of turns, one after the other, are alike: the motion is bounded."""
        if len(sizes) < 2 * self.window:
            return False
        late, soon = sizes[-self.window :], sizes[-2 * self.window : -self.window]
        # Weights that fade out at both ends: means of what repeats in no whole number come out fast.
        weight = _taper((np.arange(self.window) + 0.5) / self.window)
        means = abs((weight / weight.sum()) @ (late - soon)[:, 0]) / scale
        ends = max(abs(late[:, 1].min() - soon[:, 1].min()), abs(late[:, 2].max() - soon[:, 2].max())) / scale
        moves = np.ptp(late[:, 0]) < _DIES * np.ptp(soon[:, 0])
        # A whirl that is small beside the amplitude may still grow or die while the extremes look alike; one
        # that grows or dies within a window is through with it.
        swings = [float(part[:, 2].max() - part[:, 1].min()) for part in (late, soon)]
        moves |= not self.quick and abs(swings[0] - swings[1]) > _SWING * swings[1]
        wobble = float(np.ptp(late, axis=0).max()) / scale
        if moves or means > _MEANS * self.numerics.tolerance or ends > _ALIKE:
            return False
        if wobble <= self.numerics.tolerance and not self._elsewhere(scale):
            if self.slowest >= 0.0:
                return False
            # Where small motions decay a whirl below the tolerance that stays as it is is none.
            self.kind, self.change, self.span = self._repeating(wobble), wobble, self.window
            return True
        self.kind, self.change, self.span = HeldKind.LIMIT_CYCLE, float(means), self.window
        return True

    def _decays(self, state: Any) -> bool:
        """Whether the motion decays to a stable one that repeats, `orbit`, as the multipliers of that say.

        It is then so near to it that nothing else is between them [theory: held, eq. 24].
        """
        if self.near is None or self.count not in _LOOKS or len(self.sizes) < 3 * _PIECE:
            return False
        swings = np.array([high - low for _, low, high in self.sizes[-3 * _PIECE :]])
        if swings[-_PIECE:].mean() > _SMALLER * swings[:_PIECE].mean():
            return False
        n, layers, data = self.begin.coordinates.size, self.which.size, state.data.copy()
        found = self.near(
            replace(
                self.begin,
                coordinates=data[-2 * n : -n, 0],
                rate=data[-n:, 0],
                area=data[:layers],
                momentum=data[layers : 2 * layers],
                layers=np.isin(np.arange(self.begin.layers.size), self.which),
            )
        )
        if found is None:
            return False
        ends = np.array([rows[-1, 2 : 2 + n] for rows in self.rows[-3 * _PIECE :]])
        gaps = np.square(ends - found.moment.coordinates).reshape(3, _PIECE, n).mean(axis=(1, 2))
        falls = 0.5 * np.diff(np.log(np.maximum(gaps, 1e-300)))
        each = _PIECE * math.log(found.multiplier)
        if np.any(falls > _SLOWER * each) or np.any(falls < _FASTER * each):
            return False
        self.orbit = found
        return True

    def answer(self, moment: Moment, outcome: Outcome) -> HeldState:
        """The state as the last turns leave it."""
        short = self.kind in (HeldKind.STEADY, HeldKind.PERIODIC)
        turns = min(len(self.rows), self.span)
        machine, spin, n = self.machine, moment.spin, moment.coordinates.size
        if turns == 0:
            return _lost(machine, moment, outcome)
        steps, sizes = np.concatenate(self.rows[-turns:]), np.array(self.sizes[-turns:])
        span = steps[-1, 0] - steps[0, 0] + (steps[1, 0] - steps[0, 0])
        weight = np.diff(steps[:, 0], prepend=2.0 * steps[0, 0] - steps[1, 0])
        weight = weight * _taper((steps[:, 0] - steps[0, 0]) / span, flat=short)
        weight /= weight.sum()
        turned = np.exp(-1j * spin * steps[:, 0])
        place, which = steps[:, 2 : 2 + n], np.flatnonzero(moment.layers)
        rest = weight @ place
        deflection = self._deflection(steps)
        liquid, ripple = _centres(machine, steps[:, 2 + n :], which, weight)
        areas = [area for area, _ in self.areas[-turns:]]
        whole = np.array([2.0 * math.pi * f.chamber.radius**2 * mean_area(f) for f in machine.fills])
        drift = moment.area.mean(axis=1) * 2.0 * math.pi / whole[which] - 1.0
        dry = np.zeros(len(machine.fills), dtype=bool)
        dry[which] = np.min(areas, axis=0) <= 0.0
        turning = np.zeros(len(machine.fills))
        turning[which] = _mean_rotation(machine, spin, moment.area, moment.momentum, which)
        balance = self._balance(turns, steps)
        faults = "; ".join((*balance.pop("faults", ()), *self._beyond(steps)))
        reason = "; ".join(filter(None, (outcome.message, faults)))
        if self.kind is HeldKind.NOT_SETTLED and not reason:
            reason = f"the motion still changes after {self.count} turns"
        return HeldState(
            spin=spin,
            kind=self.kind if outcome is Outcome.DONE and not faults else HeldKind.NOT_SETTLED,
            amplitude=float(weight @ np.abs(deflection)),
            crest=float(sizes[:, 2].mean()),
            least=float(sizes[:, 1].min()),
            largest=float(sizes[:, 2].max()),
            coordinates=2.0 * (weight * turned) @ (place - rest),
            rest=rest,
            liquid=liquid,
            ripple=ripple,
            whirl_speed=math.nan if short else _other_speed(steps[:, 0], deflection, spin),
            dry=dry,
            captured=moment.layers.copy(),
            mean_rotation=turning,
            mass_error=float(np.abs(drift).max(initial=0.0)),
            change=self.change,
            turns=self.count,
            steps=self.steps,
            moment=moment,
            reason=reason,
            path=self._path(_SHORT if short else turns),
            **balance,
        )

    def _balance(self, turns: int, steps: Array) -> dict[str, Any]:
        """Heat, energy error and violations of the balance in the last turns; nothing where none is known."""
        told = self.balances[-turns:]
        if not told:
            return {}
        *works, change = np.sum(told, axis=0).tolist()
        known = dict(zip(WORKS, works, strict=True))
        # Bores give nothing back: what the scheme does is no heat, the balance leaves it.
        audit = EnergyAudit(**known | {"bores": max(known["bores"], 0.0)}, captured=0.0, change=change)
        # Undamped motion turns nothing into heat: its own energy is the measure then.
        n = self.begin.coordinates.size
        place = steps[:, 2 : 2 + n] - steps[:, 2 : 2 + n].mean(axis=0)
        elastic = 0.5 * float(np.einsum("ki,ij,kj->k", place, self.machine.system.stiffness, place).max())
        # A liquid that turns by a rounding of its energy does not move.
        fills, spin = self.machine.fills, self.begin.spin
        turning = sum(fill.mass * (spin * fill.chamber.radius) ** 2 for fill in fills)
        scale = max(audit.scale, _ELASTIC * elastic, _ROUNDING * turning)
        error = abs(audit.remainder) / scale if scale > 0.0 else 0.0
        return {
            "heat": audit.dissipated * spin / (2.0 * math.pi * len(told)),
            "energy_error": error if math.isfinite(error) else math.inf,
            "faults": audit.faults_beside(scale),
        }

    def _beyond(self, steps: Array) -> list[str]:
        """Chambers whose axis is deflected beyond their wall."""
        found, n = [], self.begin.coordinates.size
        for j, (plane, fill) in enumerate(zip(self.planes, self.machine.fills, strict=True)):
            size, wall = float(np.hypot(*(plane @ steps[:, 2 : 2 + n].T)).max()), fill.chamber.radius
            if not size <= wall:
                found.append(f"the axis of chamber {j + 1} is deflected by {size:.3g} m, beyond {wall:.3g} m")
        return found

    def _path(self, turns: int) -> Array:
        """Time and coordinates of the last turns, at moments evenly apart."""
        rows = np.concatenate(self.rows[-turns:])
        fastest, n = fastest_frequency(self.machine.system), self.begin.coordinates.size
        rows = rows[evenly(FINE / (2.0 * math.pi) * (rows[:, 1] + fastest * rows[:, 0]))]
        return np.asarray(rows[apart(rows[:, 0], rows[:, 1], fastest)][:, [0, *range(2, 2 + n)]])


def _limit(marks: list[Array], coordinates: int) -> Array | None:
    """State that the ends of some turns are bound for, by reduced rank extrapolation; None if unsound.

    Its weights have the sum 1, so that no liquid is lost or made.
    """
    states = np.array(marks)
    n, count = coordinates, states.shape[1] // 2 - coordinates
    parts = np.concatenate(
        [states[:, : 2 * count].reshape(len(marks), -1), states[:, 2 * count :, 0]], axis=1
    )
    cells = states.shape[2]
    # Each kind of number counts as the size it has.
    size = np.concatenate(
        [
            np.repeat(np.abs(states[:, : 2 * count]).mean(axis=(0, 2)), cells) * math.sqrt(2 * count * cells),
            np.full(n, np.abs(states[:, -2 * n : -n, 0]).max()),
            np.full(n, np.abs(states[:, -n:, 0]).max()),
        ]
    )
    change = np.diff(parts / np.maximum(size, 1e-300), axis=0)
    bend = np.diff(change, axis=0)
    xi = np.linalg.lstsq(bend.T, -change[0], rcond=_NOISE)[0]
    if not np.isfinite(xi).all() or np.abs(xi).max() > _FAR:
        return None
    found = states[0] + np.tensordot(xi, np.diff(states[:-1], axis=0), axes=1)
    areas = found[:count]
    whole = areas.sum(axis=1, keepdims=True)
    np.maximum(areas, 0.0, out=areas)
    areas *= whole / np.maximum(areas.sum(axis=1, keepdims=True), 1e-300)
    return np.asarray(found)


def _taper(part: Array, flat: bool = False) -> Array:
    """exp(-1/(x(1 - x))) over a stretch from 0 to 1, or 1 all over it."""
    if flat:
        return np.ones_like(part)
    inner = np.clip(part * (1.0 - part), 1e-3, None)
    return np.asarray(np.exp(-1.0 / inner))


def _centres(machine: HeldMachine, moments: Array, which: Index, weight: Array) -> tuple[Complex, Array]:
    """Mean and ripple of each layer's centre of mass in the drum, m, shape (l,)."""
    mean, ripple = np.zeros(len(machine.fills), dtype=complex), np.zeros(len(machine.fills))
    for row, j in enumerate(which.tolist()):
        fill = machine.fills[j]
        scale = fill.chamber.radius / (2.0 * math.pi * mean_area(fill))
        centre = scale * (moments[:, 2 * row] + 1j * moments[:, 2 * row + 1])
        mean[j] = weight @ centre
        ripple[j] = np.abs(centre - mean[j]).max()
    return mean, ripple


def _mean_rotation(machine: HeldMachine, spin: float, area: Array, momentum: Array, which: Index) -> Array:
    """Rotation of each layer relative to the drum, rad/s: u L over the area, as in a run-up."""
    radius = np.array([machine.fills[j].chamber.radius for j in which.tolist()])[:, None]
    a, q = area / np.square(radius), momentum / radius**4
    log = -0.5 * np.log1p(-2.0 * np.minimum(a, 0.4999))
    velocity = np.divide(q, a, out=np.zeros_like(a), where=a > 0.0) + spin * a
    return np.asarray((velocity * log).sum(axis=1) / np.maximum(a.sum(axis=1), 1e-300))


def _other_speed(time: Array, deflection: Complex, spin: float) -> float:
    """Strongest frequency of the axis beside the multiples of the spin, standing frame, rad/s."""
    from scipy.optimize import minimize_scalar

    count = 1 << int(np.ceil(np.log2(time.size)))
    even = np.linspace(time[0], time[-1], count, endpoint=False)
    seen = np.interp(even, time, deflection.real) + 1j * np.interp(even, time, deflection.imag)
    fade = np.hanning(count)
    waves = np.exp(1j * spin * np.outer(even, np.arange(-_LINES, _LINES + 1)))
    seen = seen - waves @ np.linalg.lstsq(fade[:, None] * waves, fade * seen, rcond=None)[0]
    size = np.abs(np.fft.fft(seen * fade))
    speeds = 2.0 * math.pi * np.fft.fftfreq(count, even[1] - even[0])
    k = int(np.argmax(size))
    if size[k] == 0.0:
        return math.nan
    width = float(speeds[1] - speeds[0])

    def less(speed: float) -> float:
        return -abs(complex((seen * fade) @ np.exp(-1j * speed * even)))

    around = float(speeds[k]) - width, float(speeds[k]) + width
    return float(minimize_scalar(less, bounds=around, method="bounded", options={"xatol": 1e-6 * width}).x)


def _lost(machine: HeldMachine, moment: Moment, outcome: Outcome) -> HeldState:
    """State where not even one turn was made."""
    count = len(machine.fills)
    return HeldState(
        spin=moment.spin, kind=HeldKind.NOT_SETTLED, amplitude=math.nan, crest=math.nan, least=math.nan,
        largest=math.nan, coordinates=np.full(moment.coordinates.size, complex(math.nan, math.nan)),
        rest=np.full(moment.coordinates.size, math.nan),
        liquid=np.full(count, complex(math.nan, math.nan)), ripple=np.full(count, math.nan),
        whirl_speed=math.nan, dry=np.zeros(count, dtype=bool), captured=moment.layers.copy(),
        mean_rotation=np.full(count, math.nan), mass_error=math.nan, change=math.inf, turns=0, steps=0,
        moment=moment, reason=outcome.message or "not a single turn was made",
    )  # fmt: skip
