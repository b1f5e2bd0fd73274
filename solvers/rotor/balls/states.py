"""Motions in which the balls rest in the turning rotor: balanced ones, and those that leave a deflection."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.roots import bracketed_root
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.system import RotorSystem

# Coordinates that a turn of the machine about its spin axis takes into one another.
_PAIRS = (("x", "y"), ("alpha", "beta"))
_ALIKE = 1e-9  # relative; two directions that differ by rounding alone are the same
_EXACTLY = 1e-12  # relative: as much as is wanted
_BALANCED = 1e-9  # of the balls' own moment: what may be left of a balanced rotor's unbalance
_STILL = 1e-7  # of the bare rotor's deflection, or of the balls': counts as none
_SETTLING = 400  # rounds
_LONGEST = 0.4  # rad, that a ball moves in a round
_RESTS = 1e-11  # of the pull on a ball of the bare rotor: what a state may leave
_NEWTON = 60  # rounds
_FINE = 0.05  # rad, that a ball which may stick moves in a round
_STICKS = 1e-6  # of the deflection that all together could give: pull beyond the hold that counts as none
_CREEPS, _LOCAL = 2000, 1e-5  # steps of a way of creeping balls, at most; rad, error of each
_CREPT = 1e-9  # pull at which they are there: from a smaller one rounding leads along a family
_RANK = 1e-7  # of the largest: smaller singular values are none


def quarter_turn(system: RotorSystem) -> Array:
    """J: rate of change of coordinates that turn with the spin, at unit speed [theory: balls, eq. 28].

    J^2 = -1, shape (n, n); an `InputError` for coordinates without a partner and matrices that a turn
    changes.
    """
    n = len(system.coordinates)
    turn = np.zeros((n, n))
    for first, second in _PAIRS:
        if first in system.coordinates and second in system.coordinates:
            i, j = system.coordinates.index(first), system.coordinates.index(second)
            turn[i, j], turn[j, i] = -1.0, 1.0
    if not np.array_equal(turn @ turn, -np.eye(n)):
        raise InputError("rotor", system.coordinates, "pairs of coordinates that turn into one another")
    for name in ("mass", "damping", "gyroscopic", "stiffness"):
        matrix = getattr(system, name)
        if np.abs(matrix @ turn - turn @ matrix).max() > _ALIKE * np.abs(matrix).max():
            raise InputError(name, "matrix", "the same in every direction across the axis")
    return turn


def turning(system: RotorSystem) -> Array | None:
    """J of `quarter_turn`, shape (n, n); None where the rotor is not the same in every direction."""
    try:
        return quarter_turn(system)
    except InputError:
        return None


@dataclass(frozen=True)
class RotorWithBalls:
    """A linear rotor, with the liquid's share in its matrices, and balls in races; N balls, n coordinates."""

    system: RotorSystem  #: the rotor without balls
    races: tuple[BallRace, ...]  #: that hold them, one or more

    @cached_property
    def _arrays(self) -> tuple[Array, Array]:
        return race_arrays(self.system, self.races)

    @property
    def axes(self) -> Array:
        """Displacement of the axis in the plane of each ball for unit coordinates, shape (N, 2, n)."""
        return self._arrays[0]

    @property
    def balls(self) -> Array:
        """Mass, radius, drag, rolling inertia of each, shape (N, 4)."""
        return self._arrays[1]

    @cached_property
    def moment(self) -> Array:
        """m R of each ball, kg m, shape (N,)."""
        return np.asarray(self.balls[:, 0] * self.balls[:, 1])

    @cached_property
    def push(self) -> Complex:
        """Unbalance of each ball at angle 0, as that of a rotor, shape (N, n)."""
        return np.asarray(self.moment[:, None] * (self.axes[:, 0] - 1j * self.axes[:, 1]))

    @cached_property
    def mass(self) -> Array:
        """Mass matrix with the balls, shape (n, n)."""
        added = np.einsum("j,jin,jim->nm", self.balls[:, 0], self.axes, self.axes)
        return np.asarray(self.system.mass + added)

    def carrying(self, added: Array) -> RotorWithBalls:
        """The same with more in its mass matrix, of liquid that goes with the rotor, shape (n, n)."""
        return replace(self, system=replace(self.system, mass=self.system.mass + added))

    def checked(self, places: ArrayLike) -> Array:
        """Places of the balls, psi in the rotor, rad, race by race, as an array of shape (N,).

        An `InputError` if they are not one finite angle for each ball.
        """
        angles, count = np.asarray(places, dtype=float), len(self.balls)
        if angles.shape != (count,) or not np.isfinite(angles).all():
            raise InputError("places", angles.tolist(), f"finite angles of {count} balls")
        return angles

    def moments(self, places: ArrayLike) -> Complex:
        """Share of each ball in the unbalance, m R (B_1 - i B_2)^T e^{i psi} [theory: balls, eq. 21].

        One column for each ball, in the units of the rotor's unbalance, shape (n, N).
        """
        return np.asarray(np.exp(1j * self.checked(places))[:, None] * self.push).T

    def forward(self, coordinates: Complex) -> Complex:
        """Forward part of the axis in the plane of each ball, m, shape (..., N)."""
        onward = 0.5 * (self.axes[:, 0] + 1j * self.axes[:, 1])
        return np.asarray(coordinates @ onward.T)

    def compliance(self, speed: Array, added: Complex | None = None) -> Complex:
        """Answer of the coordinates to an unbalance over it, shape (s, n, n).

        `added` is the liquid's share in the mass matrix, shape (s, n, n).
        """
        s = speed[:, None, None]
        damping = self.system.damping + s * self.system.gyroscopic
        mass = self.mass if added is None else self.mass + added
        return np.asarray(s**2 * np.linalg.inv(self.system.stiffness + 1j * s * damping - s**2 * mass))

    def coordinates(self, compliance: Complex, places: Array) -> Complex:
        """Complex amplitudes with the balls at some places [theory: races, section 3].

        Q of p problems, m or rad, from compliances (p, n, n) and places (p, N).
        """
        load = self.system.unbalance + np.exp(1j * places) @ self.push
        return np.asarray(np.einsum("pij,pj->pi", compliance, load))

    def at_rest(self, compliance: Complex, places: Array) -> Flags:
        """Balls in whose plane the axis does not move, shape (p, N)."""
        bare, each = self._answers(compliance)
        scale = np.abs(bare).max(axis=1) + np.abs(each).max(axis=(1, 2))
        size = np.abs(self.forward(self.coordinates(compliance, places)))
        return np.asarray(size <= _STILL * scale[:, None])

    def _answers(self, compliance: Complex) -> tuple[Complex, Complex]:
        """Forward deflection at each ball by the rotor's unbalance, (p, N), and by each ball, (p, N, N)."""
        bare = self.forward(np.einsum("pij,j->pi", compliance, self.system.unbalance))
        each = self.forward(np.einsum("pij,kj->pki", compliance, self.push))
        return bare, np.moveaxis(each, 1, 2)

    def _scaled_answers(self, compliance: Complex) -> tuple[Complex, Complex]:
        """Answers of `_answers` over the largest deflection that all together could give."""
        bare, each = self._answers(compliance)
        scale = _largest(bare, each)
        return bare / scale[:, None], each / scale[:, None, None]

    def pulls(self, compliance: Complex, places: Array) -> tuple[Array, Array]:
        """Motion of the axis along the race at each ball, 0 where balls rest [theory: races, eq. 5].

        Im[w e^{-i psi}] over the deflection that unbalance and balls all together could give, shape (p, N),
        and its derivatives by the places, (p, N, N).
        """
        return _pulls(*self._scaled_answers(compliance), places)

    def settle(
        self, compliance: Complex, places: Array, rounds: int = _SETTLING, joined: Flags | None = None
    ) -> tuple[Array, Flags]:
        """Places to which the balls are pulled, as in a stiff oil, and whether they rest there.

        Implicit steps that grow as the pull decays [theory: races, eq. 5]; in the end they are Newton's.
        Balls of starts that are `joined`, shape (p,), move race by race as one. Shapes (p, N) and (p,).
        """
        as_one = np.full(places.shape[0], False) if joined is None else joined
        answers = self._scaled_answers(compliance)
        found, length = places.astype(float).copy(), np.full(places.shape[0], 0.5)
        unit = np.eye(places.shape[1])
        size = np.full(places.shape[0], np.inf)
        for _ in range(rounds):
            (pull, slope), before = _pulls(*answers, found), size
            size = np.abs(pull).max(axis=1)
            busy = size > _RESTS
            if not busy.any():
                break
            shrink = np.where(np.isfinite(before), before / np.maximum(size, 1e-300), 1.0)
            length = np.clip(length * np.clip(shrink, 0.5, 3.0), 0.5, 1e9)
            step = np.linalg.solve(unit / length[:, None, None] - slope, pull[:, :, None])[:, :, 0]
            step[as_one] = step[as_one] @ self._mean_of_race
            most = np.abs(step).max(axis=1, initial=1e-300)
            step *= np.minimum(1.0, _LONGEST / most)[:, None]
            found += step * busy[:, None]
        return found, np.asarray(size <= 1e3 * _RESTS)

    def stick(self, compliance: Complex, places: Array, hold: Array) -> tuple[Array, Flags]:
        """Places at which balls that creep stop for the resistance to rolling, and whether they stopped.

        Each is held where its pull, as a deflection, is at most `hold`, m, shape (p, N); elsewhere it creeps
        along what exceeds that [theory: races, eq. 9], in implicit steps of at most `_FINE`. Shapes (p, N)
        and (p,).
        """
        bare, each = self._answers(compliance)
        scale = _largest(bare, each)
        found, going = places.astype(float), np.arange(places.shape[0])
        unit, rest = np.eye(places.shape[1]), np.zeros(places.shape[0], dtype=bool)
        for _ in range(_SETTLING):
            pull, slope = _pulls(bare[going], each[going], found[going])
            held = hold[going]
            beyond = np.sign(pull) * np.maximum(np.abs(pull) - held, 0.0)
            stopped = np.abs(beyond).max(axis=1) <= _STICKS * scale[going]
            rest[going[stopped]] = True
            going, beyond, slope = going[~stopped], beyond[~stopped], slope[~stopped]
            if not going.size:
                break
            moves = (beyond != 0.0).astype(float)
            slope = slope * moves[:, :, None] * moves[:, None, :]
            # A third of the shortest time in which the pull changes: longer steps would leave the way.
            steep = np.abs(slope).sum(axis=2).max(axis=1)
            damped = np.maximum(3.0 * steep, 1e-9 * scale[going])[:, None, None]
            step = np.linalg.solve(damped * unit - slope, beyond[:, :, None])[:, :, 0]
            most = np.abs(step).max(axis=1, initial=1e-300)
            found[going] += step * np.minimum(1.0, _FINE / most)[:, None]
        return found, rest

    @cached_property
    def _mean_of_race(self) -> Array:
        """Matrix that gives each ball the mean of its race, shape (N, N)."""
        counts = [len(race.masses) for race in self.races]
        own = np.repeat(np.eye(len(counts)), counts, axis=0)
        return np.asarray(own / counts @ own.T)

    def creep(self, compliance: Complex, places: Array) -> tuple[Array, Flags]:
        """Places to which balls creep along their pull in time, and whether they rest there.

        The way itself, to a part of `_LOCAL` a step: of a family of states it leads to one
        [theory: races, eq. 17]. Steps of a linearly implicit method of second order; at the end Newton's
        across the family.
        """
        bare, each = self._scaled_answers(compliance)
        found, length, unit = places.astype(float), np.full(places.shape[0], 0.1), np.eye(places.shape[1])
        going, share = np.arange(places.shape[0]), 1.0 / (2.0 + math.sqrt(2.0))
        for _ in range(_CREEPS):
            at, h = found[going], length[going, None]
            pull, slope = _pulls(bare[going], each[going], at)
            busy = np.abs(pull).max(axis=1) > _CREPT
            if not busy.all():
                going = going[busy]
                if not going.size:
                    break
                at, h, pull, slope = at[busy], h[busy], pull[busy], slope[busy]
            inverse = np.asarray(np.linalg.inv(unit - share * h[:, :, None] * slope), dtype=float)
            first = _times(inverse, pull)
            middle = _pulls(bare[going], each[going], at + 0.5 * h * first)[0]
            second = _times(inverse, middle - first) + first
            ahead = _pulls(bare[going], each[going], at + h * second)[0]
            third = ahead - (6.0 + math.sqrt(2.0)) * (second - middle) - 2.0 * (first - pull)
            error = h[:, 0] / 6.0 * np.abs(first - 2.0 * second + _times(inverse, third)).max(axis=1)
            kept = error <= _LOCAL
            found[going[kept]] += (h * second)[kept]
            factor = 0.8 * np.cbrt(_LOCAL / np.maximum(error, 1e-12 * _LOCAL))
            length[going] = np.minimum(length[going] * np.clip(factor, 0.2, 5.0), 1e6)
        for _ in range(3):
            pull, slope = _pulls(bare, each, found)
            found -= _times(np.asarray(np.linalg.pinv(slope, rcond=_RANK)), pull)
        rests = np.abs(_pulls(bare, each, found)[0]).max(axis=1) <= 1e3 * _RESTS
        return found, np.asarray(rests)

    def nearest(self, compliance: Complex, places: ArrayLike) -> Array | None:
        """Places next to given ones at which the balls rest, stable or not; None where none is found.

        Newton's method on the pulls [theory: races, eq. 5]. Balls may sit in one another: nothing keeps them
        apart.
        """
        answers = self._scaled_answers(compliance[None])
        angles = self.checked(places).copy()
        for _ in range(_NEWTON):
            pull, slope = (part[0] for part in _pulls(*answers, angles[None]))
            if np.abs(pull).max() <= 1e-2 * _RESTS:
                return angles
            change = np.linalg.lstsq(slope, -pull, rcond=1e-12)[0]
            angles += change / max(1.0, 2.0 * float(np.abs(change).max()))
        return None

    def balanced(self) -> Array | None:
        """Places of `balanced_places`, rad, shape (N,); None where the balls cannot balance the rotor."""
        try:
            return balanced_places(self.system, self.races)
        except InputError:
            return None


def _largest(bare: Complex, each: Complex) -> Array:
    """Largest deflection that unbalance and balls all together could give, m, 1 for none, shape (p,)."""
    found = np.abs(bare).max(axis=1) + np.abs(each).sum(axis=2).max(axis=1)
    return np.where(found > 0.0, found, 1.0)


def _times(matrix: Array, vector: Array) -> Array:
    """Products of matrices, shape (p, N, N), with vectors, shape (p, N)."""
    return np.asarray((matrix @ vector[:, :, None])[:, :, 0])


def _pulls(bare: Complex, each: Complex, places: Array) -> tuple[Array, Array]:
    """Pull on each ball, shape (p, N), and its derivatives by the places, shape (p, N, N)."""
    turn = np.exp(1j * places)
    seen = (bare + np.einsum("pjk,pk->pj", each, turn)) * turn.conj()
    slope = (turn.conj()[:, :, None] * each * turn[:, None, :]).real
    return np.asarray(seen.imag), np.asarray(slope - seen.real[:, :, None] * np.eye(places.shape[1]))


def balancing_shares(machine: RotorWithBalls) -> tuple[Complex, float]:
    """Share of each race, kg m, in balancing the rotor, and what is left over the unbalance.

    Of all shares that balance it those whose squares, each over what its race can hold, have the least sum
    [theory: races, eq. 14].
    """
    counts = [len(race.masses) for race in machine.races]
    first = np.cumsum([0, *counts[:-1]])
    weights = np.sqrt(np.add.reduceat(machine.moment, first))
    unit = machine.push[first] / machine.moment[first, None]
    columns, wanted = (unit * weights[:, None]).T, -machine.system.unbalance.astype(complex)
    found = np.linalg.lstsq(columns, wanted, rcond=None)[0]
    scale = float(np.abs(wanted).max())
    left = float(np.abs(columns @ found - wanted).max()) / scale if scale > 0.0 else 0.0
    return np.asarray(weights * found), left


def balanced_places(system: RotorSystem, races: Sequence[BallRace]) -> Array:
    """Places (rad, race by race) at which the balls take away the whole unbalance [theory: balls, eq. 21].

    Of all shares of the planes those whose squares, each over what the plane's races can hold, have the least
    sum; the races of a plane are used to the same extent, each with its balls evenly over an arc. Where balls
    of a plane differ, or a race has a single one, all of them close a polygon. There may be further places;
    an `InputError` where there are none.
    """
    arms = [np.array(race.masses) * race.radius for race in races]
    planes: dict[float, list[int]] = {}
    for k, race in enumerate(races):
        planes.setdefault(race.position, []).append(k)
    shares = balancing_shares(RotorWithBalls(system, tuple(races)))[0]
    places: list[Array] = [np.zeros(0)] * len(races)
    for members in planes.values():
        held, share = sum(float(arms[k].sum()) for k in members), complex(shares[members].sum())
        # A share at rounding has no direction.
        wanted = share if abs(share) > 1e-12 * held else 0.0
        found = _in_plane([arms[k] for k in members], wanted)
        if found is None:
            masses = [races[k].masses for k in members]
            raise InputError("races", masses, f"balls that can hold {abs(share):.6g} kg m in their plane")
        for k, part in zip(members, found, strict=True):
            places[k] = part
    every = np.concatenate(places)
    require_balance(system, races, every)
    return every


def _in_plane(arms: list[Array], share: complex) -> list[Array] | None:
    """Places of the balls of one plane, race by race, whose moments add up to a share; None if they cannot.

    Arms are m R of each ball of each race, kg m.
    """
    whole = sum(float(arm.sum()) for arm in arms)
    wanted = abs(share) / whole
    alike = all(np.ptp(arm) == 0.0 for arm in arms)
    if alike and all(arm.size > 1 or abs(wanted - 1.0) <= _EXACTLY for arm in arms):
        if wanted > 1.0 + _EXACTLY:
            return None
        return [_arc(arm.size, wanted * arm.size, share) for arm in arms]
    order = np.argsort(-np.concatenate(arms), kind="stable")
    sides = _polygon(np.concatenate(arms)[order].tolist(), abs(share))
    if sides is None:
        return None
    every = np.zeros(order.size)
    every[order] = np.array(sides) + (float(np.angle(share)) if share else 0.0)
    return np.split(every, np.cumsum([arm.size for arm in arms])[:-1])


def _arc(count: int, wanted: float, share: complex) -> Array:
    """Places of equal balls, evenly over an arc about the share, with a given sum of unit vectors."""
    if count == 1 or wanted >= count:
        gap = 0.0
    elif count == 2:
        gap = 2.0 * math.acos(0.5 * wanted)
    else:
        # The sum of unit vectors a gap apart falls from their number at 0 to 0 when they stand all round.
        def left(at: Array, _: object) -> Array:
            return np.asarray(np.sin(0.5 * count * at) / np.sin(0.5 * at) - wanted)

        whole = 2.0 * math.pi / count
        gap = float(bracketed_root(left, np.array([1e-9]), np.array([whole]))[0][0]) if wanted else whole
    middle = float(np.angle(share)) if share else gap * 0.5 * (count - 1)
    return np.asarray(middle + gap * (np.arange(count) - 0.5 * (count - 1)))


def _polygon(arms: list[float], wanted: float) -> list[float] | None:
    """Directions in which arms, the longest first, add up to a vector along angle 0; None if they cannot.

    The longest arm, the vector and what the others give together are a triangle [theory: balls, eq. 21]. The
    others give as much as they would if all were used to the same extent, or next to that.
    """
    first, others = arms[0], arms[1:]
    if not others:
        return [0.0] if abs(wanted - first) <= _EXACTLY * first else None
    together = sum(others)
    least = max(abs(first - wanted), 2.0 * others[0] - together, 0.0)
    largest = min(first + wanted, together)
    if least > largest + _EXACTLY * first:
        return None
    rest = min(max(wanted * together / (first + together), least), largest)
    own, other = 0.0, math.pi if wanted == 0.0 else 0.0
    if wanted > 0.0 and rest > 0.0:
        # One height for both sides: its rounding next to a flat triangle then cancels in their sum.
        along = (first**2 + wanted**2 - rest**2) / (2.0 * wanted)
        height = math.sqrt(max(first**2 - along**2, 0.0))
        own, other = math.atan2(height, along), math.atan2(-height, wanted - along)
    turned = _polygon(others, rest)
    return None if turned is None else [own, *(other + angle for angle in turned)]


def require_balance(system: RotorSystem, races: Sequence[BallRace], places: ArrayLike) -> None:
    """Raise an `InputError` where the balls at these places leave some of the unbalance."""
    moments = RotorWithBalls(system, tuple(races)).moments(places)
    left = float(np.abs(system.unbalance + moments.sum(axis=1)).max())
    most = float(np.abs(moments).sum())
    if not left <= _BALANCED * most:
        raise InputError("places", places, f"such that the unbalance is balanced; {left:.3g} is left")
