"""Steady states of a rotor with balls over speed: all that are found, with growth rates of small motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.families import Polygons
from solvers.rotor.balls.stability import family_dimension, small_motions, turns_freely
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.system import RotorSystem

_LED, _STARTS = 5, 5  # starts by intent, and irregular ones
_LEAD = 0.1  # rad, from race to race, of those with all balls of a race together
_ALIKE = 1e-5  # of the balls' unbalance: states nearer than that are one
_BALANCED = 1e-9  # of what the balls all together do: counts as none
_STILL = 1e-7  # of the bare rotor's amplitudes: counts as none
GROWS = 1e-9  # of the spin
_EQUAL = 1e-7  # relative: states whose amplitudes differ by less stand in the order of their starts
_NEUTRAL = 1e-9  # slope of a pull over the largest pull: balls that creep neither come nor go
_TOGETHER = (1, 2)  # starts with all balls together


class BallKind(IntEnum):
    """How balls rest in the drum."""

    NONE = 0
    BALANCED = 1
    TOGETHER = 2
    APART = 3


@dataclass(frozen=True)
class BallStates:
    """States of balls at rest in the drum: s speeds, at most b states at each, N balls, n coordinates."""

    speed: Array  #: Omega, rad/s, shape (s,)
    kind: Index  #: BallKind, NONE where there are fewer, shape (s, b)
    places: Array  #: angle of each ball in the drum, from its zero mark, rad, shape (s, b, N)
    coordinates: Complex  #: complex amplitudes, q = Re(coordinates e^{i Omega t}), shape (s, b, n)
    #: largest real part of the roots of small motions, 1/s, below 0 where they fade; nan where the map of
    #: half a turn did not settle, which does not count as stable, shape (s, b)
    growth: Array
    #: directions along which a state can move and stays one: of a family `places` and `growth` are those of
    #: the member that creeping balls come to [theory: races, eq. 16-17], shape (s, b)
    dimension: Index
    still: Flags  #: balls in whose plane the axis does not move, shape (s, b, N)

    @property
    def stable(self) -> Flags:
        """Small motions decay or stay, shape (s, b)."""
        return np.asarray((self.kind != BallKind.NONE) & (self.growth <= GROWS * self.speed[:, None]))


def starts_of(counts: Sequence[int]) -> Array:
    """Places from which the balls of some races are let go, rad, shape (k, N).

    Evenly, together on the heavy and on the light side, nearly so, and irregularly.
    """
    even = np.concatenate([2.0 * np.pi * np.arange(count) / count for count in counts])
    # Counted over all races: two balls of one plane that begin at one angle would part by rounding alone.
    every = np.arange(even.size)
    uneven = even + 0.3 * np.sin(every + 1.0)
    near = 0.15 * np.sin(2.0 * every + 1.0)
    # Nor do races of one plane begin at one angle: only rounding would part them.
    zero = np.repeat(_LEAD * np.arange(len(counts)), counts)
    some = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (_STARTS, even.size))
    return np.array([uneven, zero, zero + np.pi, near, near + np.pi, *some])


def steady_states(system: RotorSystem, races: Sequence[BallRace], speed: ArrayLike) -> BallStates:
    """States in which all balls rest in the drum, with growth rates of small motions.

    All that balls which creep come to from starts of many kinds, apart or kept together, and the balanced one
    where they can hold the unbalance [theory: races, eq. 5]. Gravity across the axis has no part in it: it
    turns in the drum.
    """
    spin = np.array(speed, dtype=float).reshape(-1)
    if not races:
        raise InputError("races", 0, "one or more")
    if not np.all(np.isfinite(spin) & (spin > 0.0)):
        raise InputError("speed", spin.tolist(), "finite numbers above 0")
    machine = RotorWithBalls(system, tuple(races))
    compliance = machine.compliance(spin)
    starts = starts_of([len(race.masses) for race in races])
    each = np.repeat(compliance, len(starts), axis=0)
    places, rests = machine.settle(each, np.tile(starts, (spin.size, 1)), joined=begin_joined(spin.size))
    shape = (spin.size, len(starts))
    kept = (rests & attracting(machine, each, places, len(starts))).reshape(shape)
    return collected(machine, spin, each.reshape(*shape, *each.shape[1:]), places.reshape(*shape, -1), kept)


def begin_joined(count: int) -> Flags:
    """Starts of `starts_of`, so many times over, whose balls begin and stay together."""
    return np.tile(np.isin(np.arange(_LED + _STARTS), _TOGETHER), count)


def attracting(machine: RotorWithBalls, compliance: Complex, places: Array, count: int) -> Flags:
    """States that balls which creep come to; from a start with all together, balls that stay so.

    States from `count` starts of `starts_of` at each speed. The last steps of a search are Newton's, and may
    end by chance where balls that creep would leave.
    """
    slope = machine.pulls(compliance, places)[1]
    counts = [len(race.masses) for race in machine.races]
    joined = np.repeat(np.eye(len(counts)), counts, axis=0)
    together = (joined / counts).T @ slope @ joined
    draws, draw_all = (np.linalg.eigvals(part).real.max(axis=1) <= _NEUTRAL for part in (slope, together))
    # Together they stay but for rounding, which may part them where they draw apart.
    stay = np.abs(np.exp(1j * places) @ joined / counts).min(axis=1) >= 1.0 - _NEUTRAL
    stay &= np.isin(np.arange(places.shape[0]) % count, _TOGETHER)
    return np.asarray(np.where(stay, draw_all, draws))


@dataclass
class _Found:
    """One state at a speed, or one member of a family."""

    kind: BallKind
    places: Array  #: shape (N,)
    coordinates: Complex  #: shape (n,)
    still: Flags  #: shape (N,)
    dimension: int  #: of its family
    starts: list[int]  #: from which the search came to it or another member; -1 for the closed form


def collected(
    machine: RotorWithBalls,
    speed: Array,
    compliance: Complex,
    places: Array,
    rests: Flags,
    added: Array | None = None,
) -> BallStates:
    """Different states among those found, the balanced one first, then by rising deflection.

    Of a family the member to which balls creep from the first start that leads to it. Found from the k starts
    of `starts_of`: compliance (s, k, n, n), places (s, k, N), rests (s, k); `added` to the mass matrix in
    small motions.
    """
    wanted = machine.balanced()
    rows: list[list[_Found]] = []
    for i in range(speed.size):
        starts = np.flatnonzero(rests[i])
        candidates, matrices = places[i][starts], compliance[i][starts]
        if wanted is not None:
            candidates = np.vstack((wanted, candidates))
            matrices, starts = np.concatenate((compliance[i, :1], matrices)), np.insert(starts, 0, -1)
        rows.append(_different(machine, matrices, candidates, starts))
    _to_members(machine, compliance, rows)
    # A place for a state even where there is none at any speed: every reader finds it empty.
    most = max([1, *map(len, rows)])
    n, count = len(machine.system.coordinates), machine.moment.size
    kind, dimension = (np.zeros((speed.size, most), dtype=np.intp) for _ in range(2))
    where, rates = np.full((speed.size, most, count), np.nan), np.full((speed.size, most), np.nan)
    amplitudes = np.full((speed.size, most, n), complex(np.nan, np.nan))
    still = np.zeros((speed.size, most, count), dtype=bool)
    for i, row in enumerate(rows):
        whole = machine if added is None else machine.carrying(added[i])
        for k, state in enumerate(row):
            kind[i, k], dimension[i, k] = state.kind, state.dimension
            where[i, k] = np.mod(state.places + np.pi, 2.0 * np.pi) - np.pi
            amplitudes[i, k], still[i, k] = state.coordinates, state.still
            rates[i, k] = growth(whole, float(speed[i]), where[i, k], state.coordinates, state.still)
    return BallStates(speed, kind, where, amplitudes, rates, dimension, still)


def _to_members(machine: RotorWithBalls, compliance: Complex, rows: list[list[_Found]]) -> None:
    """Take of each family the member that creeping balls come to [theory: races, eq. 17].

    From the first start whose balls, on their true way, come to the family; where none does, the member next
    to the first start.
    """
    starts = starts_of([len(race.masses) for race in machine.races])
    begins = begin_joined(1)
    waiting = [
        (i, state, [k for k in state.starts if k >= 0 and not begins[k]])
        for i, row in enumerate(rows)
        for state in row
        if state.dimension
    ]
    while waiting:
        going = [(i, state, left) for i, state, left in waiting if left]
        for _, state, left in waiting:
            if not left and state.still.any():
                _to_nearest(machine, state, starts[0])
        if not going:
            break
        first = [left[0] for _, _, left in going]
        matrices = np.array([compliance[i, k] for (i, _, _), k in zip(going, first, strict=True)])
        places, rests = machine.creep(matrices, starts[first])
        coordinates, still = machine.coordinates(matrices, places), machine.at_rest(matrices, places)
        waiting = []
        for p, (i, state, left) in enumerate(going):
            if rests[p] and _same_family(machine, state, places[p], coordinates[p], still[p]):
                state.places = places[p]
                if state.kind is not BallKind.BALANCED:
                    state.coordinates = coordinates[p]
            else:
                waiting.append((i, state, left[1:]))


def _same_family(
    machine: RotorWithBalls, state: _Found, places: Array, coordinates: Complex, still: Flags
) -> bool:
    """Whether balls came to a family: the same planes at rest, and the others as they were."""
    if not np.array_equal(still, state.still):
        return False
    both = np.array([state.places, places])
    means = _means(machine, both, np.array([state.coordinates, coordinates]), state.still)
    return bool(np.abs(means[0] - means[1]).max() <= _ALIKE)


def _to_nearest(machine: RotorWithBalls, state: _Found, start: Array) -> None:
    """The member next to a start, by Newton's method, where it finds one."""
    polygons, still = Polygons(machine, state.still), state.still
    found, known = polygons.onto(start[still], polygons.held(state.places[still]))
    if known:
        state.places = state.places.copy()
        state.places[still] = found


def _means(machine: RotorWithBalls, places: Array, coordinates: Complex, still: Flags) -> Complex:
    """First and second harmonic of each race whose plane moves, 0 of others, shape (p, 2 races).

    From the deflection where state and deflection turn freely in the drum.
    """
    counts = [len(race.masses) for race in machine.races]
    first = np.cumsum([0, *counts[:-1]])
    if turns_freely(machine, still):
        moved = machine.forward(coordinates)[:, np.argmin(still)]
        places = places - np.angle(moved)[:, None]
    turn = np.exp(1j * places)
    return np.hstack([np.add.reduceat(turn**k, first, axis=1) / counts * ~still[first] for k in (1, 2)])


def _different(machine: RotorWithBalls, compliance: Complex, places: Array, starts: Index) -> list[_Found]:
    """Each state or family once, the smallest deflection first, equal ones in the order of their starts."""
    coordinates = machine.coordinates(compliance, places)
    size, still = np.abs(machine.forward(coordinates)).max(axis=1), machine.at_rest(compliance, places)
    counts = [len(race.masses) for race in machine.races]
    first = np.cumsum([0, *counts[:-1]])
    gathered = np.abs(np.add.reduceat(np.exp(1j * places), first, axis=1) / counts)
    size = np.where(still.all(axis=1), 0.0, size)
    found: list[_Found] = []
    seen: list[tuple[Flags, Complex]] = []
    for p in _ordered(size):
        (means,) = _means(machine, places[p][None], coordinates[p][None], still[p])
        known = [
            k
            for k, (rest, other) in enumerate(seen)
            if np.array_equal(rest, still[p]) and np.abs(means - other).max() <= _ALIKE
        ]
        if known:
            found[known[0]].starts.append(int(starts[p]))
            continue
        seen.append((still[p], means))
        kind = BallKind.APART
        if still[p].all():
            answer = np.abs(compliance[p] @ np.vstack((machine.system.unbalance, machine.push)).T)
            held = float(answer[:, 1:].sum(axis=1).max())
            if np.abs(coordinates[p]).max() <= max(_STILL * float(answer[:, 0].max()), _BALANCED * held):
                kind = BallKind.BALANCED
                coordinates[p] = 0.0  # what is left is rounding
        elif np.allclose(gathered[p], 1.0, rtol=0.0, atol=1e-8):
            kind = BallKind.TOGETHER
        dimension = family_dimension(machine, places[p], still[p])
        found.append(_Found(kind, places[p], coordinates[p], still[p], dimension, [int(starts[p])]))
    return found


def _ordered(size: Array) -> list[int]:
    """Rising sizes, those that are equal but for `_EQUAL` in their order."""
    order = np.argsort(size, kind="stable").tolist()
    found: list[int] = []
    while order:
        alike = [p for p in order if size[p] <= size[order[0]] * (1.0 + _EQUAL)]
        found += sorted(alike)
        order = order[len(alike) :]
    return found


def growth(
    machine: RotorWithBalls, speed: float, places: Array, coordinates: Complex, still: Flags | None = None
) -> float:
    """Largest real part of the roots of small motions about a state, 1/s; nan where it did not converge.

    With the liquid's share in step with the axis; `still` are balls in whose plane the axis does not move.
    """
    found = small_motions(machine, speed, places, coordinates, still)
    return float(found.roots()[0].real) if found.settled else float("nan")
