"""Growth of small motions about steady ones: roots in the turning frame, or multipliers of half a turn.

Where more balls stand than the balance needs, they can move along a family of balanced states: these
directions are no instability.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError, require_positive
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.states import (
    RotorWithBalls,
    balanced_places,
    quarter_turn,
    require_balance,
    turning,
)
from solvers.rotor.system import RotorSystem

_RANK = 1e-7  # of the largest: smaller singular values are none
STEPS = 32  # of half a turn, at least
_MOST = 4096
_GONE = 1e-300  # a multiplier that is nothing
_SETTLED = 1e-6  # over a radian: change of the logarithm of a multiplier between two numbers of steps


@dataclass(frozen=True)
class Linearised:
    """M z'' + C z' + K z = 0 for z = (p, psi) in the turning frame [theory: balls, eq. 32-34].

    n coordinates of the rotor, N balls.
    """

    mass: Array  #: M, C, K, shape (n + N, n + N)
    damping: Array
    stiffness: Array
    neutral: Array  #: directions of the balls, orthonormal, along which nothing changes, shape (N, d)
    moved: Array  #: what the rotor's deflection does along them, shape (n, d)
    settled = True

    def matrix(self) -> Array:
        """Rates of (z across the family, z'), shape (2 (n + N) - d,) twice [theory: races, eq. 18].

        A shift along the family has no force, so it drives nothing and is left out; its rate stays.
        """
        size, count = self.mass.shape[0], self.neutral.shape[0]
        held = _across(self.neutral)
        kept = np.eye(size)[:, : size - count]
        kept = np.hstack((kept, np.vstack((np.zeros((size - count, held.shape[1])), held))))
        free = kept.shape[1]
        whole = np.zeros((free + size, free + size))
        whole[:free, free:] = kept.T
        whole[: size - count, free + size - count :] -= self.moved @ self.neutral.T
        forces = np.hstack((self.stiffness @ kept, self.damping))
        whole[free:] = -np.linalg.solve(self.mass, forces)
        return whole

    def roots(self) -> Complex:
        """Characteristic roots but those of the neutral directions, 1/s, the largest real part first."""
        found = np.linalg.eigvals(self.matrix())
        return np.asarray(found[np.argsort(-found.real)])

    def lasting(self, frequency: float, speed: float) -> Complex:
        """Matrix that is singular where a motion of this frequency neither grows nor decays, without units.

        The frequency is that seen from the rotor, rad/s.
        """
        matrix = _over_spin(self.matrix(), self.mass.shape[0], speed) / speed
        return np.asarray(matrix - 1j * frequency / speed * np.eye(len(matrix)))


@dataclass(frozen=True)
class HalfTurn:
    """What half a turn makes of small motions, the rotor's part reversed [theory: balls, eq. 36]."""

    map: Array  #: P Phi of (z without the neutral directions, z'), z = (q, psi), shape (2 (n + N) - d,) twice
    neutral: Array  #: directions of the balls, orthonormal, along which nothing changes, shape (N, d)
    speed: float  #: Omega, rad/s
    steps: int  #: of the Magnus method
    settled: bool = True  #: twice the steps hardly change the largest growth

    def roots(self) -> Complex:
        """Characteristic exponents, log(multiplier) over the time of half a turn, 1/s, the largest first."""
        found = np.linalg.eigvals(self.map)
        # What heavy drag leaves of a ball's speed may be below the least number.
        found = np.log(np.where(np.abs(found) < _GONE, _GONE, found.astype(complex)))
        found = found[np.argsort(-found.real)]
        return np.asarray(found * self.speed / np.pi)

    def lasting(self, frequency: float, speed: float) -> Complex:
        """Matrix that is singular where a motion of this frequency neither grows nor decays, without units.

        The frequency is that seen from the rotor, rad/s, known up to twice the spin.
        """
        matrix = _over_spin(self.map, (len(self.map) + self.neutral.shape[1]) // 2, speed)
        return np.asarray(matrix - np.exp(1j * np.pi * frequency / speed) * np.eye(len(matrix)))


def _over_spin(matrix: Array, moving: int, speed: float) -> Array:
    """Positions against speeds over the spin: entries of one size. The last `moving` unknowns are speeds."""
    scale = np.ones(len(matrix))
    scale[: len(matrix) - moving] = speed
    return np.asarray(scale[:, None] * matrix / scale)


@dataclass(frozen=True)
class Stability:
    """What becomes of small disturbances of a balanced rotor."""

    growth: float  #: of the disturbance that grows most, 1/s; below 0 they all die out
    #: at which it turns or swings as seen from the rotor, rad/s; known up to twice the spin where the
    #: supports are not the same in every direction
    frequency: float
    neutral: Array  #: directions of the balls along which the rotor stays balanced, orthonormal, shape (N, d)
    places: Array  #: of the balls, rad, shape (N,)
    #: characteristic roots, or characteristic exponents of the half turn, 1/s, shape (2 (n + N) - d,)
    roots: Complex
    settled: bool = True  #: False where the steps of the half turn did not suffice for the growth

    @property
    def stable(self) -> bool:
        """All disturbances but those along the neutral directions decay."""
        return self.settled and self.growth < 0.0


def neutral_directions(machine: RotorWithBalls, places: ArrayLike, free: Flags | None = None) -> Array:
    """Directions in which balls can move and neither unbalance nor pull changes [theory: balls, eq. 35].

    Orthonormal columns, shape (N, d). `free`: balls in whose plane the axis does not move
    [theory: races, eq. 7]; None: all.
    """
    moved = 1j * machine.moments(places)
    mine = np.flatnonzero(np.ones(moved.shape[1], dtype=bool) if free is None else free)
    if not mine.size:
        return np.zeros((moved.shape[1], 0))
    # Shifts and tilts have different units: each row over its own size.
    rows = np.vstack((moved.real, moved.imag))
    sizes = np.abs(rows).sum(axis=1)
    rows = (rows / np.where(sizes > 0.0, sizes, 1.0)[:, None])[sizes > _RANK * sizes.max()]
    own = _null_space(rows[:, mine])
    found = np.zeros((moved.shape[1], own.shape[1]))
    found[mine] = own
    return found


def _across(neutral: Array) -> Array:
    """Orthonormal columns that span what is left beside the neutral directions."""
    return _null_space(neutral.T) if neutral.size else np.eye(neutral.shape[0])


def _null_space(rows: Array) -> Array:
    from scipy.linalg import null_space

    return np.asarray(null_space(rows, rcond=_RANK))


def small_motions(
    machine: RotorWithBalls,
    speed: float,
    places: ArrayLike,
    coordinates: ArrayLike | None = None,
    free: Flags | None = None,
    steps: int | None = None,
) -> Linearised | HalfTurn:
    """Small motions about a state in which the balls rest at `places` (rad, shape (N,)), on any supports.

    In the turning frame where the rotor is the same in every direction, else over half a turn, its `steps`
    None: as many as needed. Coordinates are complex amplitudes, q = Re(coordinates e^{i Omega t}), None:
    balanced; `free` are balls in whose plane the axis does not move, None: all of a balanced rotor, else
    none.
    """
    require_positive("speed", speed)
    angles = machine.checked(places)
    moved = np.zeros(len(machine.system.coordinates), dtype=complex)
    if coordinates is not None:
        moved = np.asarray(coordinates, dtype=complex)
    still = np.full(angles.size, coordinates is None) if free is None else free
    neutral = neutral_directions(machine, angles, still)
    turn = turning(machine.system)
    if turn is not None:
        return _turning_motions(machine, speed, angles, moved.real, turn, neutral, still)
    if steps is not None:
        return _half_turn(machine, speed, angles, moved, neutral, steps)
    return _settled_half_turn(machine, speed, angles, moved, neutral)


def linearised(
    system: RotorSystem,
    races: Sequence[BallRace],
    speed: float,
    places: ArrayLike,
    deflection: ArrayLike | None = None,
) -> Linearised:
    """Equations of small motions in the frame that turns with the rotor [theory: balls, eq. 32-34].

    The rotor must be the same in every direction; `deflection` is p in the turning frame, None: balanced.
    """
    quarter_turn(system)
    found = small_motions(RotorWithBalls(system, tuple(races)), speed, places, deflection)
    assert isinstance(found, Linearised)
    return found


def _turning_motions(
    machine: RotorWithBalls,
    speed: float,
    angles: Array,
    deflection: Array,
    turn: Array,
    neutral: Array,
    still: Flags,
) -> Linearised:
    system, moment, balls, whole = machine.system, machine.moment, machine.balls, machine.mass
    n, count = len(system.coordinates), moment.size
    outward, along = _directions(machine, angles)
    damping = system.damping + speed * system.gyroscopic
    mass, drag, held = (np.zeros((n + count, n + count)) for _ in range(3))
    mass[:n, :n], mass[:n, n:], mass[n:, :n] = whole, (moment * along.T), (moment * along.T).T
    mass[n:, n:] = np.diag(balls[:, 3] * balls[:, 0] * balls[:, 1] ** 2)
    drag[:n, :n] = damping + 2.0 * speed * whole @ turn
    drag[:n, n:] = -2.0 * speed * moment * outward.T
    drag[n:, :n] = 2.0 * speed * (moment * (along @ turn).T).T
    drag[n:, n:] = np.diag(balls[:, 2] * balls[:, 1] ** 2)
    held[:n, :n] = system.stiffness + speed * damping @ turn - speed**2 * whole
    held[:n, n:] = -(speed**2) * moment * along.T
    held[n:, :n] = held[:n, n:].T
    held[n:, n:] = np.diag(speed**2 * moment * (outward @ deflection))
    shifted = np.zeros((n, neutral.shape[1]))
    if turns_freely(machine, still):
        # Along the others nothing of the deflection changes, so that the turn's part across them has all.
        across = np.ones(count) - neutral @ neutral.sum(axis=0)
        size = float(np.linalg.norm(across))
        neutral = np.column_stack((neutral, across / size))
        shifted = np.column_stack((shifted, turn @ deflection / size))
    return Linearised(mass, drag, held, neutral, shifted)


def turns_freely(machine: RotorWithBalls, still: Flags) -> bool:
    """Balls and deflection may turn together in the drum: the rotor by itself is balanced.

    `still`: balls in whose plane the axis does not move. Where no plane has a deflection this is one of
    `neutral_directions`.
    """
    held = np.abs(machine.push).sum(axis=0)
    return bool((np.abs(machine.system.unbalance) <= _RANK * held).all() and not still.all())


def family_dimension(machine: RotorWithBalls, places: ArrayLike, still: Flags) -> int:
    """Number of directions along which a state may move and stays one [theory: races, eq. 16]."""
    return int(neutral_directions(machine, places, still).shape[1] + turns_freely(machine, still))


def _directions(machine: RotorWithBalls, angles: Array) -> tuple[Array, Array]:
    """Motion of the axis outward and along the race at each ball, for unit coordinates, (..., N, n)."""
    x, y = np.cos(angles)[..., None], np.sin(angles)[..., None]
    first, second = machine.axes[:, 0], machine.axes[:, 1]
    return first * x + second * y, second * x - first * y


def balanced_roots(system: RotorSystem, races: Sequence[BallRace], speed: float) -> Complex:
    """Characteristic roots of a balanced rotor with its balls evenly round their races, 1/s.

    The largest real part first, in the frame that turns with the rotor, on supports that are alike. The root
    0 of each race, whose balls may turn together, and what further balls leave free are left out.
    """
    for race in races:
        if len(race.masses) < 2 or len(set(race.masses)) > 1:
            raise InputError("races", race.masses, "two balls or more, all alike")
    balanced = replace(system, unbalance=np.zeros_like(system.unbalance))
    places = balanced_places(balanced, races)
    return linearised(system, races, speed, places).roots()


def balanced_stability(
    system: RotorSystem, races: Sequence[BallRace], speed: float, places: ArrayLike | None = None
) -> Stability:
    """Whether rotor and balls stay balanced after a small disturbance [theory: balls, eq. 32-36].

    Characteristic roots where the rotor is the same in every direction across its axis, else Floquet
    multipliers of half a turn. Places None: those of `balanced_places`.
    """
    require_positive("speed", speed)
    machine = RotorWithBalls(system, tuple(races))
    if places is None:
        angles = balanced_places(system, races)
    else:
        angles = machine.checked(places)
        require_balance(system, races, angles)
    found = small_motions(machine, speed, angles)
    roots = found.roots()
    frequency = float(abs(roots[0].imag))
    return Stability(float(roots[0].real), frequency, found.neutral, angles, roots, found.settled)


def _settled_half_turn(
    machine: RotorWithBalls, speed: float, angles: Array, coordinates: Complex, neutral: Array
) -> HalfTurn:
    """Half a turn with its steps doubled until the largest growth rate stays."""
    steps, last = STEPS, np.nan
    while True:
        found = _half_turn(machine, speed, angles, coordinates, neutral, steps)
        growth = float(found.roots()[0].real) * np.pi / speed
        if abs(growth - last) <= _SETTLED * max(1.0, abs(growth)):
            return found
        if steps >= _MOST:
            return replace(found, settled=False)
        steps, last = 2 * steps, growth


def _half_turn(
    machine: RotorWithBalls,
    speed: float,
    angles: Array,
    coordinates: Complex,
    neutral: Array,
    steps: int,
) -> HalfTurn:
    """Steps of the fourth-order Magnus method, at two points of Gauss each."""
    from scipy.linalg import expm

    step = np.pi / (speed * steps)
    apart = np.sqrt(3.0) / 6.0
    begin = np.arange(steps)[:, None] + np.array([0.5 - apart, 0.5 + apart])
    rates = _standing_rates(machine, speed, angles, coordinates, step * begin.reshape(-1))
    rates = rates.reshape(steps, 2, *rates.shape[1:])
    first, second = rates[:, 0], rates[:, 1]
    mean, twist = 0.5 * step * (first + second), second @ first - first @ second
    pieces = expm(mean + (np.sqrt(3.0) / 12.0) * step**2 * twist)
    size, n = rates.shape[-1] // 2, len(machine.system.coordinates)
    reverse = np.ones(2 * size)
    reverse[:n] = reverse[size : size + n] = -1.0
    whole = np.eye(2 * size)
    for piece in pieces:
        whole = piece @ whole
    whole = reverse[:, None] * whole
    held = _across(neutral)
    kept = np.zeros((2 * size, 2 * size - neutral.shape[1]))
    kept[:n, :n] = np.eye(n)
    kept[n:size, n : n + held.shape[1]] = held
    kept[size:, n + held.shape[1] :] = np.eye(size)
    return HalfTurn(np.asarray(kept.T @ whole @ kept), neutral, speed, steps)


def _standing_rates(
    machine: RotorWithBalls, speed: float, angles: Array, coordinates: Complex, times: Array
) -> Array:
    """Rates of small motions in the standing frame at each time, shape (times, 2 (n + N), 2 (n + N)).

    Theory: races, eq. 6.
    """
    system, moment, balls = machine.system, machine.moment[:, None], machine.balls
    n, count = len(system.coordinates), balls.shape[0]
    outward, along = _directions(machine, angles + speed * times[:, None])
    steady = np.real(coordinates * np.exp(1j * speed * times)[:, None])
    mass, drag, held = (np.zeros((times.size, n + count, n + count)) for _ in range(3))
    mass[:, :n, :n], mass[:, n:, :n] = machine.mass, moment * along
    mass[:, :n, n:] = np.swapaxes(moment * along, 1, 2)
    mass[:, n:, n:] = np.diag(balls[:, 3] * balls[:, 0] * balls[:, 1] ** 2)
    drag[:, :n, :n] = system.damping + speed * system.gyroscopic
    drag[:, :n, n:] = -2.0 * speed * np.swapaxes(moment * outward, 1, 2)
    drag[:, n:, n:] = np.diag(balls[:, 2] * balls[:, 1] ** 2)
    held[:, :n, :n] = system.stiffness
    held[:, :n, n:] = -(speed**2) * np.swapaxes(moment * along, 1, 2)
    each = np.arange(n, n + count)
    held[:, each, each] = speed**2 * moment[:, 0] * np.einsum("tjn,tn->tj", outward, steady)
    rates = np.zeros((times.size, 2 * (n + count), 2 * (n + count)))
    rates[:, : n + count, n + count :] = np.eye(n + count)
    rates[:, n + count :] = -np.linalg.solve(mass, np.concatenate((held, drag), axis=2))
    return rates
