"""Steady states of a rotor with balls: where the balls can rest in the drum, and how small motions grow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.system import RotorSystem

_STARTS = 5  # irregular ones besides those by intent
_ROUNDS = 400
_LONGEST = 0.4  # rad, that a ball moves in a round
_RESTS = 1e-11  # of the pull on a ball of the bare rotor: what a state may leave
_ALIKE = 1e-5  # of the balls' unbalance: states nearer than that are one
_STILL = 1e-7  # of the bare rotor's deflection, or of the balls': counts as none
_NEUTRAL = 1e-6  # of the spin: roots this small are places that nothing prefers
_GROWS = 1e-9  # of the spin
_PARTS = 256  # of a turn in which small motions are followed where the supports differ


class BallKind(IntEnum):
    """How balls rest in the drum."""

    NONE = 0
    BALANCED = 1
    TOGETHER = 2
    APART = 3


@dataclass(frozen=True)
class BallStates:
    """States in which the balls rest in the drum: s speeds, at most b states at each, N balls, n coordinates.

    Parameters
    ----------
    speed : Omega, rad/s, shape (s,)
    kind : BallKind, NONE where there are fewer, shape (s, b)
    places : angle of each ball in the drum, from its zero mark, rad, shape (s, b, N)
    coordinates : complex amplitudes, q = Re(coordinates e^{i Omega t}), shape (s, b, n)
    growth : largest real part of the roots of small motions, 1/s, below 0 where they fade, shape (s, b)
    """

    speed: Array
    kind: Index
    places: Array
    coordinates: Complex
    growth: Array

    @property
    def stable(self) -> Flags:
        """Small motions fade or stay, shape (s, b)."""
        return np.asarray((self.kind != BallKind.NONE) & (self.growth <= _GROWS * self.speed[:, None]))


@dataclass(frozen=True)
class RotorWithBalls:
    """A linear rotor with the liquid's share in its matrices and balls in races; N balls, n coordinates.

    Parameters
    ----------
    system : the rotor without balls
    races : that hold them
    """

    system: RotorSystem
    races: tuple[BallRace, ...]

    @property
    def axes(self) -> Array:
        """Displacement of the axis in the plane of each ball for unit coordinates, shape (N, 2, n)."""
        return race_arrays(self.system, self.races)[0]

    @property
    def balls(self) -> Array:
        """Mass, radius, drag, rolling inertia of each, shape (N, 4)."""
        return race_arrays(self.system, self.races)[1]

    @property
    def moment(self) -> Array:
        """m R of each ball, kg m, shape (N,)."""
        return np.asarray(self.balls[:, 0] * self.balls[:, 1])

    @property
    def push(self) -> Complex:
        """Unbalance of each ball at angle 0, as that of a rotor, shape (N, n)."""
        return np.asarray(self.moment[:, None] * (self.axes[:, 0] - 1j * self.axes[:, 1]))

    @property
    def mass(self) -> Array:
        """Mass matrix with the balls, shape (n, n)."""
        added = np.einsum("j,jin,jim->nm", self.balls[:, 0], self.axes, self.axes)
        return np.asarray(self.system.mass + added)

    def forward(self, coordinates: Complex) -> Complex:
        """Forward part of the axis in the plane of each ball, m, shape (..., N)."""
        turning = 0.5 * (self.axes[:, 0] + 1j * self.axes[:, 1])
        return np.asarray(coordinates @ turning.T)

    def compliance(self, speed: Array, added: Complex | None = None) -> Complex:
        """Answer of the coordinates to an unbalance over it, shape (s, n, n).

        Parameters
        ----------
        speed : rad/s, shape (s,)
        added : the liquid's share in the mass matrix, shape (s, n, n)
        """
        s = speed[:, None, None]
        damping = self.system.damping + s * self.system.gyroscopic
        mass = self.mass if added is None else self.mass + added
        return np.asarray(s**2 * np.linalg.inv(self.system.stiffness + 1j * s * damping - s**2 * mass))

    def coordinates(self, compliance: Complex, places: Array) -> Complex:
        """Complex amplitudes with the balls at some places, shape (p, n)."""
        load = self.system.unbalance + np.exp(1j * places) @ self.push
        return np.asarray(np.einsum("pij,pj->pi", compliance, load))

    def settle(self, compliance: Complex, places: Array, rounds: int = _ROUNDS) -> tuple[Array, Flags]:
        """Let the balls go where they are pulled, as in a stiff oil, until they rest [theory: races, eq. 5].

        Implicit steps that grow as the pull fades; in the end they are Newton's.

        Parameters
        ----------
        compliance : of each of p problems, shape (p, n, n)
        places : start of the balls, rad, shape (p, N)
        rounds : most steps

        Returns
        -------
        Places, shape (p, N), and whether the balls rest there, shape (p,)
        """
        bare = self.forward(np.einsum("pij,j->pi", compliance, self.system.unbalance))
        each = np.moveaxis(self.forward(np.einsum("pij,kj->pki", compliance, self.push)), 1, 2)
        scale = np.abs(bare).max(axis=1) + np.abs(each).sum(axis=2).max(axis=1)
        scale = np.where(scale > 0.0, scale, 1.0)
        bare, each = bare / scale[:, None], each / scale[:, None, None]
        found, length = places.astype(float).copy(), np.full(places.shape[0], 0.5)
        unit = np.eye(places.shape[1])
        size = np.full(places.shape[0], np.inf)
        for _ in range(rounds):
            turn = np.exp(1j * found)
            seen = (bare + np.einsum("pjk,pk->pj", each, turn)) * turn.conj()
            pull, before = seen.imag, size
            size = np.abs(pull).max(axis=1)
            busy = size > _RESTS
            if not busy.any():
                break
            slope = (turn.conj()[:, :, None] * each * turn[:, None, :]).real - seen.real[:, :, None] * unit
            shrink = np.where(np.isfinite(before), before / np.maximum(size, 1e-300), 1.0)
            length = np.clip(length * np.clip(shrink, 0.5, 3.0), 0.5, 1e9)
            step = np.linalg.solve(unit / length[:, None, None] - slope, pull[:, :, None])[:, :, 0]
            most = np.abs(step).max(axis=1, initial=1e-300)
            step *= np.minimum(1.0, _LONGEST / most)[:, None]
            found += step * busy[:, None]
        return found, np.asarray(size <= 1e3 * _RESTS)

    def balanced(self) -> Array | None:
        """Places at which the balls take all unbalance away, rad, shape (N,); None where they cannot.

        Each race takes the share that goes with what it can hold [theory: balls, eq. 21].
        """
        counts = [len(race.masses) for race in self.races]
        first = np.cumsum([0, *counts[:-1]])
        most = np.add.reduceat(self.moment, first)
        # Of all shares that do it those whose squares, weighted by what the races hold, have the least sum.
        columns = (self.push[first] * (np.sqrt(most) / self.moment[first])[:, None]).T
        found, *_ = np.linalg.lstsq(columns, -self.system.unbalance.astype(complex), rcond=None)
        left = np.abs(columns @ found + self.system.unbalance).max()
        share = found / np.sqrt(most)
        alike = all(len(set(race.masses)) == 1 for race in self.races)
        if not alike or left > 1e-9 * np.abs(self.system.unbalance).max() or np.abs(share).max() > 1.0:
            return None
        parts = [_fan(n, abs(part)) for n, part in zip(counts, share, strict=True)]
        if any(part is None for part in parts):
            return None
        pairs = zip(parts, share, strict=True)
        return np.concatenate([part + np.angle(own) for part, own in pairs if part is not None])


def _fan(count: int, share: float) -> Array | None:
    """Balls spread evenly about angle 0 whose unbalance is a share of all of it; None for a single one."""
    if count == 1:
        return np.zeros(1) if abs(share - 1.0) <= 1e-12 else None
    about = np.linspace(-1.0, 1.0, count)
    low, high = 0.0, np.pi * (count - 1) / count
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.cos(middle * about).mean() > share else (low, middle)
    return np.asarray(low * about)


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
    """States in which all balls rest in the drum, with the growth of small motions [theory: races, eq. 5-7].

    All that are reached from starts of many kinds, and the balanced one where the balls can hold the
    unbalance. Gravity across the axis has no part in it: it turns in the drum.

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
    return collected(machine, spin, compliance, places.reshape(*shape, -1), rests.reshape(shape))


def collected(
    machine: RotorWithBalls,
    speed: Array,
    compliance: Complex,
    places: Array,
    rests: Flags,
    added: Complex | None = None,
) -> BallStates:
    """Different states among those found, the balanced one first, then by rising deflection.

    Parameters
    ----------
    machine : rotor and balls
    speed : rad/s, shape (s,)
    compliance : shape (s, n, n), or (s, k, n, n) where each state has its own
    places, rests : found from k starts, shapes (s, k, N) and (s, k)
    added : the liquid's share in the mass matrix, shape (s, n, n)
    """
    wanted, rows = machine.balanced(), []
    for i in range(speed.size):
        own = compliance[i] if compliance.ndim == 4 else np.repeat(compliance[i][None], places.shape[1], 0)
        candidates, matrices = places[i][rests[i]], own[rests[i]]
        if wanted is not None:
            candidates = np.vstack((wanted, candidates))
            matrices = np.concatenate((own[:1], matrices))
        found = _different(machine, matrices, candidates)
        more = None if added is None else added[i]
        rows.append([(*state, growth(machine, float(speed[i]), state[1], state[2], more)) for state in found])
    most = max((len(row) for row in rows), default=0)
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
) -> list[tuple[BallKind, Array, Complex]]:
    """Each state once; of those that leave the races at rest the first: their balls may stand anyhow."""
    coordinates = machine.coordinates(compliance, places)
    deflection = machine.forward(coordinates)
    bare = machine.forward(np.einsum("pij,j->pi", compliance, machine.system.unbalance))
    alone = machine.forward(np.einsum("pij,kj->pki", compliance, machine.push))
    scale = np.abs(bare).max(axis=1) + np.abs(alone).max(axis=(1, 2))
    counts = [len(race.masses) for race in machine.races]
    first = np.cumsum([0, *counts[:-1]])
    turn = np.exp(1j * places)
    means = np.hstack([np.add.reduceat(turn**k, first, axis=1) / counts for k in (1, 2)])
    found: list[tuple[BallKind, Array, Complex]] = []
    seen: list[Complex] = []
    rests = False
    for p in np.argsort(np.abs(deflection).max(axis=1), kind="stable").tolist():
        kind = BallKind.APART
        if np.abs(deflection[p]).max() <= _STILL * scale[p]:
            if rests:
                continue
            rests = True
            size = np.abs(compliance[p] @ machine.system.unbalance).max()
            if np.abs(coordinates[p]).max() <= _STILL * size:
                kind = BallKind.BALANCED
                coordinates[p] = 0.0  # what is left is rounding
        elif np.allclose(np.abs(means[p, : len(counts)]), 1.0, rtol=0.0, atol=1e-8):
            kind = BallKind.TOGETHER
        if any(np.abs(means[p] - other).max() <= _ALIKE for other in seen):
            continue
        seen.append(means[p])
        found.append((kind, np.mod(places[p] + np.pi, 2.0 * np.pi) - np.pi, coordinates[p]))
    return found


def growth(
    machine: RotorWithBalls, speed: float, places: Array, coordinates: Complex, added: Complex | None = None
) -> float:
    """Largest real part of the roots of small motions about a state, 1/s [theory: races, eq. 6-7].

    Of a balanced state the places that nothing prefers are left out.

    Parameters
    ----------
    machine : rotor and balls
    speed : rad/s
    places : of the balls in the drum, rad, shape (N,)
    coordinates : complex amplitudes there, shape (n,)
    added : the liquid's share in the mass matrix, which moves as a mass in step with the axis, shape (n, n)
    """
    quarter = turning(machine.system)
    alike = quarter is not None
    roots = (_turning_roots if alike else _floquet_roots)(machine, speed, places, coordinates, added)
    moved = roots[np.abs(roots) > _NEUTRAL * speed]
    return float((moved if moved.size else roots).real.max())


def turning(system: RotorSystem) -> Array | None:
    """A quarter turn about the spin axis of all coordinates, shape (n, n); None where supports differ."""
    n = len(system.coordinates)
    quarter = np.zeros((n, n))
    for first, second in (("x", "y"), ("alpha", "beta")):
        if first in system.coordinates and second in system.coordinates:
            i, j = system.coordinates.index(first), system.coordinates.index(second)
            quarter[i, j], quarter[j, i] = -1.0, 1.0
    if not np.allclose(quarter @ quarter, -np.eye(n)):
        return None
    for matrix in (system.mass, system.damping, system.gyroscopic, system.stiffness):
        if not np.allclose(matrix @ quarter, quarter @ matrix, rtol=0.0, atol=1e-9 * np.abs(matrix).max()):
            return None
    return quarter


def _turning_roots(
    machine: RotorWithBalls, speed: float, places: Array, coordinates: Complex, added: Complex | None
) -> Complex:
    """Roots in the frame that turns with the rotor, where nothing depends on time [theory: races, eq. 6]."""
    system, quarter = machine.system, turning(machine.system)
    assert quarter is not None
    mass = machine.mass if added is None else machine.mass + added.real
    whole = system.damping + speed * system.gyroscopic
    out, along = _directions(machine, places)
    moment, balls, n = machine.moment, machine.balls, len(system.coordinates)
    count = moment.size
    inertia, damping, stiffness = np.zeros((3, n + count, n + count))
    cross = (moment[:, None] * along).T
    pull = moment * speed**2 * (out @ coordinates.real)
    inertia[:n, :n], inertia[:n, n:], inertia[n:, :n] = mass, cross, cross.T
    inertia[n:, n:] = np.diag(balls[:, 3] * balls[:, 0] * balls[:, 1] ** 2)
    swing = 2.0 * speed * (moment[:, None] * out).T
    damping[:n, :n], damping[:n, n:], damping[n:, :n] = 2.0 * speed * mass @ quarter + whole, -swing, swing.T
    damping[n:, n:] = np.diag(balls[:, 2] * balls[:, 1] ** 2)
    stiffness[:n, :n] = system.stiffness + speed * whole @ quarter - speed**2 * mass
    stiffness[:n, n:], stiffness[n:, :n] = -(speed**2) * cross, -(speed**2) * cross.T
    stiffness[n:, n:] = np.diag(pull)
    return _roots(inertia, damping, stiffness)


def _directions(machine: RotorWithBalls, places: Array) -> tuple[Array, Array]:
    """Parts of the axis' motion outward and along the race at each ball, for unit coordinates, (N, n)."""
    x, y = np.cos(places)[:, None], np.sin(places)[:, None]
    first, second = machine.axes[:, 0], machine.axes[:, 1]
    return x * first + y * second, x * second - y * first


def _roots(inertia: Array, damping: Array, stiffness: Array) -> Complex:
    size = inertia.shape[0]
    matrix = np.zeros((2 * size, 2 * size))
    matrix[:size, size:] = np.eye(size)
    matrix[size:] = -np.linalg.solve(inertia, np.hstack((stiffness, damping)))
    return np.asarray(np.linalg.eigvals(matrix), dtype=complex)


def _floquet_roots(
    machine: RotorWithBalls, speed: float, places: Array, coordinates: Complex, added: Complex | None
) -> Complex:
    """The same where the supports differ: growth over one turn of the rotor [theory: races, eq. 7].

    The balls' own ripple with twice the spin is left out of the state. Steps by the trapezium's rule at the
    middles keep any decay a decay.
    """
    system, moment, balls = machine.system, machine.moment, machine.balls
    n, count = len(system.coordinates), moment.size
    size, step = n + count, 2.0 * np.pi / (_PARTS * speed)
    mass = machine.mass if added is None else machine.mass + added.real
    whole: Array = np.eye(2 * size)
    for part in range(_PARTS):
        angle = (part + 0.5) * speed * step
        out, along = _directions(machine, places + angle)
        accelerated = -(speed**2) * (coordinates * np.exp(1j * angle)).real
        inertia, damping, stiffness = np.zeros((3, size, size))
        cross = (moment[:, None] * along).T
        inertia[:n, :n], inertia[:n, n:], inertia[n:, :n] = mass, cross, cross.T
        inertia[n:, n:] = np.diag(balls[:, 3] * balls[:, 0] * balls[:, 1] ** 2)
        damping[:n, :n] = system.damping + speed * system.gyroscopic
        damping[:n, n:] = -2.0 * speed * (moment[:, None] * out).T
        damping[n:, n:] = np.diag(balls[:, 2] * balls[:, 1] ** 2)
        stiffness[:n, :n], stiffness[:n, n:] = system.stiffness, -(speed**2) * cross
        stiffness[n:, n:] = -np.diag(moment * (out @ accelerated))
        rate = np.zeros((2 * size, 2 * size))
        rate[:size, size:] = np.eye(size)
        rate[size:] = -np.linalg.solve(inertia, np.hstack((stiffness, damping)))
        half = 0.5 * step * rate
        whole = np.asarray(np.linalg.solve(np.eye(2 * size) - half, (np.eye(2 * size) + half) @ whole))
    factors = np.linalg.eigvals(whole).astype(complex)
    return np.asarray(np.log(np.maximum(np.abs(factors), 1e-300)) / (_PARTS * step) + 0j)
