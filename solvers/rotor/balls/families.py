"""Families of states: balls that stand where the axis rests can move together and leave it at rest.

Every member has the same deflection; the growth rate of small motions across the family differs along it
[theory: races, section 9].
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from meshes.arrays import Array, Complex, Flags, Index
from solvers.rotor.balls.stability import HalfTurn, small_motions, turns_freely
from solvers.rotor.balls.states import RotorWithBalls, turning

_RANK = 1e-7  # of the largest: smaller singular values are none
_ROUNDS, _LEAVES, _LONGEST = 40, 1e-12, 0.5  # of Newton's method onto the family; relative; rad, a step of it
_BETTER = 1e-10  # of the spin: what counts as more growth in a search
_FIRST, _MOST = 0.3, 0.6  # rad: steps of a search along the family


class _Budget(NamedTuple):
    """Effort of a search for the least and the largest growth rate."""

    members: int  # drawn first
    rounds: int
    directions: int  # of a round, each taken both ways


_QUICK, _SLOW = _Budget(48, 36, 3), _Budget(6, 8, 1)  # for matrices at once; one by one


@dataclass(frozen=True)
class Member:
    """A state of balls at one speed, one of a family."""

    machine: RotorWithBalls  #: with the liquid's share in step with the axis
    speed: float  #: rad/s
    places: Array  #: of the balls in the drum, rad, shape (N,)
    coordinates: Complex  #: complex amplitudes, shape (n,)
    still: Flags  #: balls in whose plane the axis does not move, shape (N,)


@dataclass(frozen=True)
class Polygons:
    """Places of the balls in planes at rest that leave there what the state wants [theory: races, eq. 16]."""

    machine: RotorWithBalls
    still: Flags  #: balls in planes at rest, shape (N,), f of them

    @cached_property
    def _parts(self) -> tuple[Array, Array]:
        """Share of a ball in the conditions at angles 0 and a quarter turn, shape (r, f) each.

        r conditions that do not depend on one another, whatever the angles.
        """
        push = self.machine.push[self.still].T
        first, second = np.vstack((push.real, push.imag)), np.vstack((-push.imag, push.real))
        size = np.abs(first).sum(axis=1) + np.abs(second).sum(axis=1)
        scale = np.where(size > _RANK * size.max(), size, np.inf)[:, None]
        first, second = first / scale, second / scale
        left, values, _ = np.linalg.svd(np.hstack((first, second)), full_matrices=False)
        left = left[:, values > _RANK * values[0]]
        return left.T @ first, left.T @ second

    def held(self, angles: Array) -> Array:
        """What the balls hold of each condition, shape (..., r), at angles of shape (..., f)."""
        first, second = self._parts
        return np.asarray(np.cos(angles) @ first.T + np.sin(angles) @ second.T)

    def _back(self, angles: Array) -> tuple[Array, Array]:
        """Derivative A of `held`, shape (..., r, f), and A^T (A A^T)^-1, shape (..., f, r)."""
        first, second = self._parts
        rate = -np.sin(angles)[..., None, :] * first + np.cos(angles)[..., None, :] * second
        whole = rate @ np.swapaxes(rate, -1, -2)
        # Where all balls stand in one line a condition is lost: Levenberg's term keeps the step finite.
        damp = _RANK**2 * np.trace(whole, axis1=-2, axis2=-1)[..., None, None] * np.eye(len(first))
        return rate, np.asarray(np.swapaxes(rate, -1, -2) @ np.linalg.inv(whole + damp))

    def along(self, angles: Array, ways: Array) -> Array:
        """Part of some ways along the family, of length one, shape (..., f)."""
        rate, back = self._back(angles)
        part = ways - (back @ (rate @ ways[..., None]))[..., 0]
        return np.asarray(part / np.maximum(np.linalg.norm(part, axis=-1, keepdims=True), 1e-300))

    def onto(self, angles: Array, wanted: Array, rounds: int = _ROUNDS) -> tuple[Array, Flags]:
        """The nearest members by Newton's method, shape (..., f), and whether they are found, shape (...)."""
        found = angles.copy()
        for _ in range(rounds):
            gap = wanted - self.held(found)
            if np.abs(gap).max() <= _LEAVES:
                break
            step = (self._back(found)[1] @ gap[..., None])[..., 0]
            most = np.abs(step).max(axis=-1, keepdims=True)
            found += step * np.minimum(1.0, _LONGEST / np.maximum(most, 1e-300))
        return found, np.asarray(np.abs(wanted - self.held(found)).max(axis=-1) <= 1e3 * _LEAVES)


def growth_ranges(members: Sequence[Member]) -> Array:
    """Least and largest growth rate of small motions across the families of some states, 1/s, shape (s, 2).

    A search along each family from members all over it, with the same draws at all speeds.
    """
    found = np.full((len(members), 2), np.nan)
    groups: dict[bytes, list[int]] = {}
    for k, member in enumerate(members):
        groups.setdefault(member.still.tobytes(), []).append(k)
    for rows in groups.values():
        own = [members[k] for k in rows]
        machine, still = own[0].machine, own[0].still
        quick = turning(machine.system) is not None and not turns_freely(machine, still)
        if quick:
            found[rows] = _extremes(own, _Reduced(own).growth, _QUICK)
        else:
            # One after the other: half turns take their time.
            found[rows] = [_extremes([one], _each(one), _SLOW)[0] for one in own]
    return found


def _each(member: Member) -> Callable[[Array], Array]:
    """Growth rate of each of some members, from the motions of all balls."""

    def growth(angles: Array) -> Array:
        rates = []
        steps = None
        for row in angles[0]:
            places = member.places.copy()
            places[member.still] = row
            motions = small_motions(
                member.machine, member.speed, places, member.coordinates, member.still, steps
            )
            if isinstance(motions, HalfTurn):
                if not motions.settled:
                    rates.append(np.nan)
                    continue
                steps = motions.steps
            rates.append(float(motions.roots()[0].real))
        return np.array([rates])

    return growth


def _extremes(members: Sequence[Member], growth: Callable[[Array], Array], budget: _Budget) -> Array:
    """Least and largest growth rate, shape (s, 2), of members with the same planes at rest."""
    polygons = Polygons(members[0].machine, members[0].still)
    own = np.array([member.places[member.still] for member in members])
    least = _BETTER * np.array([member.speed for member in members])[:, None]
    wanted, draws = polygons.held(own)[:, None], np.random.default_rng(0)
    free, count = own.shape[1] - wanted.shape[-1], own.shape[1]
    drawn = draws.uniform(0.0, 2.0 * np.pi, (budget.members, count))
    places, known = polygons.onto(np.repeat(drawn[None], len(own), axis=0), wanted)
    places, known = np.concatenate((own[:, None], places), axis=1), np.insert(known, 0, True, axis=1)
    rates = np.where(known, growth(places), np.nan)
    sense = np.array([-1.0, -1.0, 1.0, 1.0])
    at, rows = _best_two(rates, least), np.arange(len(own))[:, None]
    places, best = places[rows, at], rates[rows, at] * sense
    if free > 0:
        step = np.full(best.shape, _FIRST)
        many = budget.directions if free > 1 else 1
        for _ in range(budget.rounds):
            ways = polygons.along(places[:, :, None], draws.standard_normal((many, count)))
            ways = np.concatenate((ways, -ways), axis=2) * step[:, :, None, None]
            ahead, reached = polygons.onto(places[:, :, None] + ways, wanted[:, None], 6)
            shape = ahead.shape
            rate = growth(ahead.reshape(len(own), -1, count)).reshape(shape[:3]) * sense[:, None]
            rate = np.where(reached & np.isfinite(rate), rate, -np.inf)
            pick = np.argmax(rate, axis=2)[:, :, None]
            better = np.take_along_axis(rate, pick, axis=2)[:, :, 0]
            goes = better > best + least
            best = np.where(goes, better, best)
            moved = np.take_along_axis(ahead, pick[..., None], axis=2)[:, :, 0]
            places = np.where(goes[..., None], moved, places)
            step = np.minimum(step * np.where(goes, 1.5, 0.5), _MOST)
    ends = best * sense
    return np.stack((ends[:, :2].min(axis=1), ends[:, 2:].max(axis=1)), axis=1)


def _best_two(rates: Array, alike: Array) -> Index:
    """Of each row the first two of the least and of the largest; values that are alike by their order."""
    picks = []
    for sense in (-1.0, 1.0):
        score = np.where(np.isfinite(rates), sense * rates, -np.inf)
        for _ in range(2):
            pick: Index = np.argmax(score >= score.max(axis=1, keepdims=True) - alike, axis=1)
            picks.append(pick)
            left = score.copy()
            left[np.arange(len(left)), pick] = -np.inf
            # With a single member left both begin there.
            some = np.asarray(np.isfinite(left).any(axis=1))
            score = np.where(some[:, None], left, score)
    return np.stack(picks, axis=1)


class _Reduced:
    """Small motions with alike balls of a plane at rest as two of them [theory: races, eq. 19-20].

    For states of one machine on supports that are alike, at some speeds.
    """

    def __init__(self, members: Sequence[Member]) -> None:
        first = members[0]
        machine, system, still = first.machine, first.machine.system, first.still
        self.count, turn = len(system.coordinates), turning(system)
        assert turn is not None  # the supports are alike
        speed = np.array([member.speed for member in members])[:, None, None]
        mass = np.array([member.machine.mass for member in members])
        damping = system.damping + speed * system.gyroscopic
        self.speed, self.mass = speed[:, 0, 0], mass
        self.drag = damping + 2.0 * speed * mass @ turn
        self.held = system.stiffness + speed * damping @ turn - speed**2 * mass
        self.turn, self.gathered = turn, np.flatnonzero(~still)
        self.angles = np.array([member.places[self.gathered] for member in members])
        self.deflection = np.array([member.coordinates.real for member in members])
        rows = np.hstack((machine.balls, machine.axes.reshape(len(machine.balls), -1)))[still]
        alike: dict[bytes, list[int]] = {}
        for k, row in enumerate(rows):
            alike.setdefault(row.tobytes(), []).append(k)
        self.groups = list(alike.values())
        mine = np.flatnonzero(still)
        each = [mine[group[:2]] for group in self.groups]
        self.balls = np.concatenate((self.gathered, *each))
        self.rates = [
            float(-machine.balls[mine[group[0]], 2] / np.prod(machine.balls[mine[group[0]], [0, 3]]))
            for group in self.groups
            if len(group) > 2
        ]
        self.numbers, self.axes = machine.balls[self.balls], machine.axes[self.balls]
        self.moment = machine.moment[self.balls]
        free = self.axes[self.gathered.size :] * self.moment[self.gathered.size :, None, None]
        span = free.reshape(-1, self.count)
        scale = np.abs(span).max(axis=0)
        scale = np.where(scale > 0.0, scale, 1.0)
        _, values, right = np.linalg.svd(span / scale, full_matrices=False)
        right = right[values > _RANK * values[0]]
        self.span, self.back = scale[:, None] * right.T, right / scale

    def growth(self, angles: Array) -> Array:
        """Largest real part of the roots, 1/s, shape (s, m), at places of shape (s, m, f)."""
        n, fixed, total = self.count, self.gathered.size, self.balls.size
        s, m = angles.shape[:2]
        standing = np.exp(1j * np.repeat(self.angles[:, None], m, axis=1))
        turn = np.concatenate((standing, *(_as_two(angles[..., group]) for group in self.groups)), axis=2)
        x, y = turn.real[..., None], turn.imag[..., None]
        outward = self.axes[:, 0] * x + self.axes[:, 1] * y
        along = self.axes[:, 1] * x - self.axes[:, 0] * y
        pushed, pulled = self.moment[:, None] * along, self.moment[:, None] * outward
        speed = self.speed[:, None, None, None]
        size, positions = n + total, n + fixed + self.span.shape[1]
        mass, drag = (np.zeros((s, m, size, size)) for _ in range(2))
        shift = np.zeros((s, m, size, positions))
        mass[..., :n, :n], mass[..., n:, :n] = self.mass[:, None], pushed
        mass[..., :n, n:] = np.swapaxes(pushed, 2, 3)
        inertia = self.numbers[:, 3] * self.numbers[:, 0] * self.numbers[:, 1] ** 2
        mass[..., n:, n:] = np.diag(inertia)
        drag[..., :n, :n] = self.drag[:, None]
        drag[..., :n, n:] = -2.0 * speed * np.swapaxes(pulled, 2, 3)
        drag[..., n:, :n] = 2.0 * speed * pushed @ self.turn
        drag[..., n:, n:] = np.diag(self.numbers[:, 2] * self.numbers[:, 1] ** 2)
        shift[..., :n, :n], shift[..., n:, :n] = self.held[:, None], -(speed**2) * pushed
        shift[..., :n, n : n + fixed] = -(speed**2) * np.swapaxes(pushed[..., :fixed, :], 2, 3)
        each = np.arange(fixed)
        stands = np.einsum("smkn,sn->smk", pulled[..., :fixed, :], self.deflection)
        shift[..., n + each, n + each] = speed[..., 0] ** 2 * stands
        shift[..., :n, n + fixed :] = -(speed**2) * self.span
        whole = np.zeros((s, m, positions + size, positions + size))
        each = np.arange(n + fixed)
        whole[..., each, positions + each] = 1.0
        whole[..., n + fixed : positions, positions + n + fixed :] = self.back @ np.swapaxes(
            pushed[..., fixed:, :], 2, 3
        )
        whole[..., positions:, :] = -np.linalg.solve(mass, np.concatenate((shift, drag), axis=3))
        found = np.linalg.eigvals(whole).real.max(axis=2)
        return np.asarray(np.maximum(found, max(self.rates, default=-np.inf)))


def _as_two(angles: Array) -> Complex:
    """Two balls for alike ones: e of each as a complex number, the root of sum e e^T [theory: races, eq. 19].

    One ball or two stay as they are.
    """
    turn = np.exp(1j * angles)
    if turn.shape[-1] <= 2:
        return np.asarray(turn)
    x, y = turn.real, turn.imag
    first, second, mixed = (x * x).sum(-1), (y * y).sum(-1), (x * y).sum(-1)
    # Of a 2 by 2 matrix: (G + g)/sqrt(tr G + 2 g), g^2 = det G.
    root = np.sqrt(np.maximum(first * second - mixed**2, 0.0))
    size = np.sqrt(first + second + 2.0 * root)
    both = np.stack((first + root + 1j * mixed, mixed + 1j * (second + root)), axis=-1)
    return np.asarray(both / size[..., None])
