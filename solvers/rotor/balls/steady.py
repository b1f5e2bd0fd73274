"""Steady states of a rotor with balls over speed: all that are found, and how small motions grow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.stability import small_motions
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.system import RotorSystem

_STARTS = 5  # irregular ones besides those by intent
_ALIKE = 1e-5  # of the balls' unbalance: states nearer than that are one
_STILL = 1e-7  # of the bare rotor's amplitudes: counts as none
_GROWS = 1e-9  # of the spin
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

    @property
    def stable(self) -> Flags:
        """Small motions fade or stay, shape (s, b)."""
        return np.asarray((self.kind != BallKind.NONE) & (self.growth <= _GROWS * self.speed[:, None]))


def starts_of(counts: Sequence[int]) -> Array:
    """Places from which the balls of some races are let go, rad, shape (k, N).

    Evenly, together on the heavy and on the light side, nearly so, and irregularly.

    Parameters
    ----------
    counts : of balls in each race
    """
    even = np.concatenate([2.0 * np.pi * np.arange(count) / count for count in counts])
    order = np.concatenate([np.arange(count) for count in counts])
    uneven = even + 0.3 * np.sin(order + 1.0)
    near = 0.15 * np.sin(2.0 * order + 1.0)
    zero = np.zeros(even.size)
    some = np.random.default_rng(0).uniform(0.0, 2.0 * np.pi, (_STARTS, even.size))
    return np.array([uneven, zero, zero + np.pi, near, near + np.pi, *some])


def steady_states(system: RotorSystem, races: Sequence[BallRace], speed: ArrayLike) -> BallStates:
    """States in which all balls rest in the drum, with the growth of small motions [theory: races, eq. 5].

    All that balls which creep come to from starts of many kinds, apart or kept together, and the balanced
    one where they can hold the unbalance. Gravity across the axis has no part in it: it turns in the drum.

    Parameters
    ----------
    system : the rotor without balls
    races : one or more
    speed : Omega, rad/s, above 0, shape (s,)

    Raises
    ------
    InputError : no race, a speed that is not positive and finite

    Examples
    --------
    Two balls above and below the critical speed of 105 rad/s:

    >>> from solvers.rotor.jeffcott import Jeffcott
    >>> rotor = Jeffcott(mass=4.0, stiffness=4.4e4, damping=84.0, unbalance=6e-4)
    >>> race = BallRace(position=0.0, radius=0.065, masses=(7e-3, 7e-3), drag=0.1)
    >>> found = steady_states(rotor.system(), [race], [60.0, 250.0])
    >>> [[BallKind(k).name for k in row[ok]] for row, ok in zip(found.kind, found.stable)]
    [['TOGETHER'], ['BALANCED']]
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
    places, rests = machine.settle(each, np.tile(starts, (spin.size, 1)))
    shape = (spin.size, len(starts))
    kept = (rests & attracting(machine, each, places, len(starts))).reshape(shape)
    return collected(machine, spin, compliance, places.reshape(*shape, -1), kept)


def attracting(machine: RotorWithBalls, compliance: Complex, places: Array, count: int) -> Flags:
    """States that balls which creep come to; from a start with all together, balls that stay so.

    The last steps of a search are Newton's, and may end by chance, or by rounding, where balls that creep
    would leave.

    Parameters
    ----------
    machine : rotor and balls
    compliance, places : of states from a number of starts at each speed, shapes (p, n, n) and (p, N)
    count : of starts, those of `starts_of`
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


def collected(
    machine: RotorWithBalls,
    speed: Array,
    compliance: Complex,
    places: Array,
    rests: Flags,
    added: Array | None = None,
) -> BallStates:
    """Different states among those found, the balanced one first, then by rising deflection.

    Parameters
    ----------
    machine : rotor and balls
    speed : rad/s, shape (s,)
    compliance : shape (s, n, n), or (s, k, n, n) where each state has its own
    places, rests : found from k starts, shapes (s, k, N) and (s, k)
    added : to the mass matrix in small motions, of liquid, shape (s, n, n)
    """
    wanted, rows = machine.balanced(), []
    for i in range(speed.size):
        own = compliance[i] if compliance.ndim == 4 else np.repeat(compliance[i][None], places.shape[1], 0)
        candidates, matrices = places[i][rests[i]], own[rests[i]]
        if wanted is not None:
            candidates = np.vstack((wanted, candidates))
            matrices = np.concatenate((own[:1], matrices))
        found = _different(machine, matrices, candidates)
        whole = machine if added is None else machine.carrying(added[i])
        rows.append([(*state[:3], growth(whole, float(speed[i]), *state[1:])) for state in found])
    # A place for a state even where there is none at any speed: every reader finds it empty.
    most = max([1, *map(len, rows)])
    n, count = len(machine.system.coordinates), machine.moment.size
    kind = np.zeros((speed.size, most), dtype=np.intp)
    where, rates = np.full((speed.size, most, count), np.nan), np.full((speed.size, most), np.nan)
    amplitudes = np.full((speed.size, most, n), complex(np.nan, np.nan))
    for i, row in enumerate(rows):
        for k, (name, angles, coordinates, rate) in enumerate(row):
            kind[i, k], where[i, k], amplitudes[i, k], rates[i, k] = name, angles, coordinates, rate
    return BallStates(speed, kind, where, amplitudes, rates)


def _different(
    machine: RotorWithBalls, compliance: Complex, places: Array
) -> list[tuple[BallKind, Array, Complex, Flags]]:
    """Each state once, with the balls in whose plane the axis rests.

    Of states that leave all races at rest the first alone: their balls may stand anyhow.
    """
    coordinates = machine.coordinates(compliance, places)
    size, still = np.abs(machine.forward(coordinates)).max(axis=1), machine.at_rest(compliance, places)
    counts = [len(race.masses) for race in machine.races]
    first = np.cumsum([0, *counts[:-1]])
    turn = np.exp(1j * places)
    means = np.hstack([np.add.reduceat(turn**k, first, axis=1) / counts for k in (1, 2)])
    found: list[tuple[BallKind, Array, Complex, Flags]] = []
    seen: list[Complex] = []
    rests = False
    for p in np.argsort(size, kind="stable").tolist():
        kind = BallKind.APART
        if still[p].all():
            if rests:
                continue
            rests = True
            bare = np.abs(compliance[p] @ machine.system.unbalance).max()
            if np.abs(coordinates[p]).max() <= _STILL * bare:
                kind = BallKind.BALANCED
                coordinates[p] = 0.0  # what is left is rounding
        elif np.allclose(np.abs(means[p, : len(counts)]), 1.0, rtol=0.0, atol=1e-8):
            kind = BallKind.TOGETHER
        if any(np.abs(means[p] - other).max() <= _ALIKE for other in seen):
            continue
        seen.append(means[p])
        angles = np.mod(places[p] + np.pi, 2.0 * np.pi) - np.pi
        found.append((kind, angles, coordinates[p], still[p]))
    return found


def growth(
    machine: RotorWithBalls, speed: float, places: Array, coordinates: Complex, still: Flags | None = None
) -> float:
    """Largest real part of the roots of small motions about a state, 1/s; nan where it did not settle.

    Parameters
    ----------
    machine : rotor and balls, with the liquid's share in step with the axis
    speed : rad/s
    places : of the balls in the drum, rad, shape (N,)
    coordinates : complex amplitudes there, shape (n,)
    still : balls in whose plane the axis does not move, shape (N,); None: none
    """
    found = small_motions(machine, speed, places, coordinates, still)
    return float(found.roots()[0].real) if found.settled else float("nan")
