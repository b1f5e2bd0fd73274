"""Small motions of rotor and balls about steady ones: roots in the turning frame, multipliers elsewhere.

The balls of a race have no place of their own: where more of them stand than the balance needs, they can move
along a family of balanced states. These directions are told, and are no instability.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_positive
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.balls.states import (
    balanced_places,
    ball_moments,
    checked_places,
    quarter_turn,
    require_balance,
    without_unbalance,
)
from solvers.rotor.system import RotorSystem

_RANK = 1e-9  # of the largest: smaller singular values are none
_STEPS, _MOST = 32, 4096  # of half a turn
_GONE = 1e-300  # a multiplier that is nothing
_SETTLED = 1e-6  # over a radian: change of the logarithm of a multiplier between two numbers of steps


@dataclass(frozen=True)
class Linearised:
    """M z'' + C z' + K z = 0 for z = (p, psi) in the turning frame [theory: balls, eq. 32-34].

    n coordinates of the rotor, N balls.

    Parameters
    ----------
    mass, damping, stiffness : M, C, K, shape (n + N, n + N)
    neutral : directions of the balls, orthonormal, along which nothing changes, shape (N, d)
    """

    mass: Array
    damping: Array
    stiffness: Array
    neutral: Array

    def matrix(self) -> Array:
        """Rates of (z without the neutral directions, z'), shape (2 (n + N) - d,) twice.

        A shift along a neutral direction has no force, so it drives nothing and is left out; its rate stays.
        """
        size, count = self.mass.shape[0], self.neutral.shape[0]
        held = _across(self.neutral)
        kept = np.eye(size)[:, : size - count]
        kept = np.hstack((kept, np.vstack((np.zeros((size - count, held.shape[1])), held))))
        free = kept.shape[1]
        whole = np.zeros((free + size, free + size))
        whole[:free, free:] = kept.T
        forces = np.hstack((self.stiffness @ kept, self.damping))
        whole[free:] = -np.linalg.solve(self.mass, forces)
        return whole

    def roots(self) -> Complex:
        """Characteristic roots but those of the neutral directions, 1/s, the one that grows most first."""
        found = np.linalg.eigvals(self.matrix())
        return np.asarray(found[np.argsort(-found.real)])


@dataclass(frozen=True)
class Stability:
    """What becomes of small disturbances of a balanced rotor.

    Parameters
    ----------
    growth : of the disturbance that grows most, 1/s; below 0 they all die out
    frequency : at which it turns or swings as seen from the rotor, rad/s; known up to twice the spin where
        the supports are not the same in every direction
    neutral : directions of the balls along which the rotor stays balanced, orthonormal, shape (N, d)
    places : of the balls, rad, shape (N,)
    roots : characteristic roots, or characteristic exponents of the half turn, 1/s, shape (2 (n + N) - d,)
    """

    growth: float
    frequency: float
    neutral: Array
    places: Array
    roots: Complex

    @property
    def stable(self) -> bool:
        """All disturbances but those along the neutral directions die out."""
        return self.growth < 0.0


def neutral_directions(system: RotorSystem, races: Sequence[BallRace], places: ArrayLike) -> Array:
    """Directions in which balls can move without a change of the unbalance [theory: balls, eq. 35].

    Parameters
    ----------
    system, races : rotor and balls
    places : of the balls, rad, shape (N,)

    Returns
    -------
    Orthonormal columns, shape (N, d)
    """
    moved = 1j * ball_moments(system, races, places)
    # Shifts and tilts have different units: each row over its own size.
    rows = np.vstack((moved.real, moved.imag))
    sizes = np.abs(rows).sum(axis=1)
    rows = rows[sizes > _RANK * sizes.max()]
    return _null_space(rows / np.abs(rows).sum(axis=1)[:, None])


def _across(neutral: Array) -> Array:
    """Orthonormal columns that span what is left beside the neutral directions."""
    return _null_space(neutral.T) if neutral.size else np.eye(neutral.shape[0])


def _null_space(rows: Array) -> Array:
    from scipy.linalg import null_space

    return np.asarray(null_space(rows, rcond=_RANK))


def linearised(
    system: RotorSystem,
    races: Sequence[BallRace],
    speed: float,
    places: ArrayLike,
    deflection: ArrayLike | None = None,
) -> Linearised:
    """Equations of small motions in the frame that turns with the rotor [theory: balls, eq. 32-34].

    Parameters
    ----------
    system : a rotor that is the same in every direction across its axis
    races : one or more
    speed : Omega, rad/s, above 0
    places : psi of each ball, at which it rests, rad, shape (N,)
    deflection : p of the rotor in the turning frame, m or rad, shape (n,); None: balanced, without any

    Raises
    ------
    InputError : a speed that is not positive, supports that differ in two directions
    """
    require_positive("speed", speed)
    turn = quarter_turn(system)
    axes, balls = race_arrays(system, races)
    angles = checked_places(places, balls.shape[0])
    n, count = len(system.coordinates), balls.shape[0]
    whole, along, outward = _directions(system, axes, balls, angles)
    damping = system.damping + speed * system.gyroscopic
    mass, drag, held = (np.zeros((n + count, n + count)) for _ in range(3))
    moment = balls[:, 0] * balls[:, 1]
    mass[:n, :n], mass[:n, n:], mass[n:, :n] = whole, (moment * along.T), (moment * along.T).T
    mass[n:, n:] = np.diag(balls[:, 3] * balls[:, 0] * balls[:, 1] ** 2)
    drag[:n, :n] = damping + 2.0 * speed * whole @ turn
    drag[:n, n:] = -2.0 * speed * moment * outward.T
    drag[n:, :n] = 2.0 * speed * (moment * (along @ turn).T).T
    drag[n:, n:] = np.diag(balls[:, 2] * balls[:, 1] ** 2)
    held[:n, :n] = system.stiffness + speed * damping @ turn - speed**2 * whole
    held[:n, n:] = -(speed**2) * moment * along.T
    held[n:, :n] = held[:n, n:].T
    moved = np.zeros(n) if deflection is None else np.asarray(deflection, dtype=float)
    held[n:, n:] = np.diag(speed**2 * moment * (outward @ moved))
    neutral = neutral_directions(system, races, angles) if deflection is None else np.zeros((count, 0))
    return Linearised(mass, drag, held, neutral)


def _directions(system: RotorSystem, axes: Array, balls: Array, angles: Array) -> tuple[Array, Array, Array]:
    """Mass with the balls on board; motion of the axis along the race and outward at each ball, (N, n)."""
    x, y = np.cos(angles)[:, None], np.sin(angles)[:, None]
    whole = system.mass + np.einsum("j,jai,jak->ik", balls[:, 0], axes, axes)
    return whole, axes[:, 1] * x - axes[:, 0] * y, axes[:, 0] * x + axes[:, 1] * y


def balanced_roots(system: RotorSystem, races: Sequence[BallRace], speed: float) -> Complex:
    """Characteristic roots of a rotor without unbalance whose balls stand evenly round their races.

    Looked at in the frame that turns with the rotor, where this state is at rest. One root of each race is 0:
    its balls may turn together. These, and what further balls leave free, are left out.

    Parameters
    ----------
    system : a rotor on supports that are alike in both directions; its unbalance does not count
    races : two balls or more each, all of one race alike
    speed : Omega, rad/s, above 0

    Returns
    -------
    Roots, 1/s, the one that grows most first; shape (2 n + 2 N - races,) for two balls in each

    Raises
    ------
    InputError : a speed that is not positive, a race whose balls do not balance one another
    """
    for race in races:
        if len(race.masses) < 2 or len(set(race.masses)) > 1:
            raise InputError("races", race.masses, "two balls or more, all alike")
    places = balanced_places(without_unbalance(system), races)
    return linearised(system, races, speed, places).roots()


def balanced_stability(
    system: RotorSystem, races: Sequence[BallRace], speed: float, places: ArrayLike | None = None
) -> Stability:
    """Whether rotor and balls stay balanced after a small disturbance [theory: balls, eq. 32-36].

    Characteristic roots where the rotor is the same in every direction across its axis; where it is not,
    Floquet multipliers of half a turn.

    Parameters
    ----------
    system : any rotor, with its unbalance
    races : one or more
    speed : Omega, rad/s, above 0
    places : of the balls, rad, shape (N,), which balance it; None: those of `balanced_places`

    Raises
    ------
    InputError : a speed that is not positive, balls that do not balance the unbalance

    Examples
    --------
    >>> from solvers.rotor.jeffcott import Jeffcott
    >>> rotor, race = Jeffcott(10.0, 1e4, 40.0, 1.2e-3).system(), BallRace(0.0, 0.08, (0.015, 0.015), 0.3)
    >>> [balanced_stability(rotor, [race], speed).stable for speed in (20.0, 60.0)]
    [False, True]
    """
    require_positive("speed", speed)
    if places is None:
        angles = balanced_places(system, races)
    else:
        angles = checked_places(places, sum(len(race.masses) for race in races))
        require_balance(system, races, angles)
    if is_isotropic(system):
        found = linearised(system, races, speed, angles)
        roots, neutral = found.roots(), found.neutral
    else:
        neutral = neutral_directions(system, races, angles)
        roots = balanced_exponents(system, races, speed, angles)
    return Stability(float(roots[0].real), float(abs(roots[0].imag)), neutral, angles, roots)


def light_ball_roots(system: RotorSystem, races: Sequence[BallRace], speed: float) -> Complex:
    """Forward whirls of a rotor with light balls evenly round their races [theory: balls, eq. 37-38].

    To first order in the balls and in the damping of the supports. Above the speed of a whirl the drag of the
    races, which turns with the rotor, feeds it; the supports must damp more than that.

    Parameters
    ----------
    system : a rotor that is the same in every direction across its axis
    races : two balls or more each
    speed : Omega, rad/s, above 0

    Returns
    -------
    lambda of each forward whirl in the standing frame, 1/s, by rising frequency, shape (n/2,) at most
    """
    require_positive("speed", speed)
    quarter_turn(system)
    axes, balls = race_arrays(system, races)
    n = len(system.coordinates)
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.eye(n)
    forces = np.hstack((system.stiffness, speed * system.gyroscopic))
    matrix[n:] = -np.linalg.solve(system.mass, forces)
    found, vectors = np.linalg.eig(matrix)
    roots = []
    for root, shape in zip(found, vectors[:n].T, strict=True):
        first, second = axes[:, 0] @ shape, axes[:, 1] @ shape
        # The spin's way round: the second direction follows the first by a quarter.
        size = max(float(np.abs(first).max()), float(np.abs(second).max()))
        if root.imag <= 0.0 or np.abs(second + 1j * first).max() > 1e-6 * size:
            continue
        whirl = root.imag
        slip = whirl - speed
        held = -balls[:, 3] * balls[:, 0] * slip**2 + 1j * slip * balls[:, 2]
        carried = np.square(np.abs(first)) * balls[:, 0] * whirl**2
        push = np.sum(carried * (2.0 + balls[:, 0] * whirl**2 / held))
        lost = 1j * whirl * (shape.conj() @ system.damping @ shape)
        weight = shape.conj() @ (2j * whirl * system.mass + speed * system.gyroscopic) @ shape
        roots.append(1j * whirl + (push - lost) / weight)
    return np.array(sorted(roots, key=lambda root: root.imag))


def is_isotropic(system: RotorSystem) -> bool:
    """Whether the rotor is the same in every direction across its axis.

    Parameters
    ----------
    system : the rotor
    """
    try:
        quarter_turn(system)
    except InputError:
        return False
    return True


def balanced_exponents(
    system: RotorSystem, races: Sequence[BallRace], speed: float, places: ArrayLike
) -> Complex:
    """Characteristic exponents of the balanced state on any supports [theory: balls, eq. 36].

    In the standing frame the coefficients have the period of a turn; after half a turn the balls are
    opposite, which is the same machine with the rotor's coordinates reversed. The map over half a turn is
    made of steps of the fourth-order Magnus method, their number doubled until the exponents stay.

    Parameters
    ----------
    system : any rotor
    races, speed : as in `balanced_stability`
    places : of the balls, rad, shape (N,)

    Returns
    -------
    log(multiplier) over half a turn's time, 1/s, the largest growth first, shape (2 (n + N) - d,)

    Raises
    ------
    InputError : exponents that do not settle
    """
    require_positive("speed", speed)
    axes, balls = race_arrays(system, races)
    angles = checked_places(places, balls.shape[0])
    neutral = neutral_directions(system, races, angles)
    steps = _STEPS
    last: Array = np.zeros(0)
    while steps <= _MOST:
        found = np.linalg.eigvals(_half_turn(system, axes, balls, angles, speed, neutral, steps))
        # What heavy drag leaves of a ball's speed may be below the least number.
        found = np.log(np.where(np.abs(found) < _GONE, _GONE, found.astype(complex)))
        found = found[np.argsort(-found.real)]
        growth = np.asarray(found.real, dtype=np.float64)
        if last.size and np.abs(growth[0] - last[0]) <= _SETTLED * max(1.0, abs(growth[0])):
            return np.asarray(found * speed / np.pi)
        steps, last = 2 * steps, growth
    raise InputError("speed", speed, f"one at which {_MOST} steps in half a turn are enough")


def _half_turn(
    system: RotorSystem,
    axes: Array,
    balls: Array,
    angles: Array,
    speed: float,
    neutral: Array,
    steps: int,
) -> Array:
    """Map of (q, psi, q', psi') over half a turn, the rotor's part reversed, without neutral directions."""
    from scipy.linalg import expm

    step = np.pi / (speed * steps)
    apart = np.sqrt(3.0) / 6.0
    begin = np.arange(steps)[:, None] + np.array([0.5 - apart, 0.5 + apart])
    rates = _standing_rates(system, axes, balls, angles, speed, step * begin.reshape(-1))
    rates = rates.reshape(steps, 2, *rates.shape[1:])
    first, second = rates[:, 0], rates[:, 1]
    mean, twist = 0.5 * step * (first + second), second @ first - first @ second
    pieces = expm(mean + (np.sqrt(3.0) / 12.0) * step**2 * twist)
    size, n = rates.shape[-1] // 2, len(system.coordinates)
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
    return np.asarray(kept.T @ whole @ kept)


def _standing_rates(
    system: RotorSystem, axes: Array, balls: Array, angles: Array, speed: float, times: Array
) -> Array:
    """Matrices of the small motions in the standing frame at each time, shape (times, 2 (n + N), ...)."""
    n, count = len(system.coordinates), balls.shape[0]
    turned = angles + speed * times[:, None]
    x, y = np.cos(turned)[..., None], np.sin(turned)[..., None]
    along, outward = axes[:, 1] * x - axes[:, 0] * y, axes[:, 0] * x + axes[:, 1] * y
    moment = (balls[:, 0] * balls[:, 1])[:, None]
    whole = system.mass + np.einsum("j,jai,jak->ik", balls[:, 0], axes, axes)
    mass, drag, held = (np.zeros((times.size, n + count, n + count)) for _ in range(3))
    mass[:, :n, :n], mass[:, n:, :n] = whole, moment * along
    mass[:, :n, n:] = np.swapaxes(moment * along, 1, 2)
    mass[:, n:, n:] = np.diag(balls[:, 3] * balls[:, 0] * balls[:, 1] ** 2)
    drag[:, :n, :n] = system.damping + speed * system.gyroscopic
    drag[:, :n, n:] = -2.0 * speed * np.swapaxes(moment * outward, 1, 2)
    drag[:, n:, n:] = np.diag(balls[:, 2] * balls[:, 1] ** 2)
    held[:, :n, :n] = system.stiffness
    held[:, :n, n:] = -(speed**2) * np.swapaxes(moment * along, 1, 2)
    rates = np.zeros((times.size, 2 * (n + count), 2 * (n + count)))
    rates[:, : n + count, n + count :] = np.eye(n + count)
    rates[:, n + count :] = -np.linalg.solve(mass, np.concatenate((held, drag), axis=2))
    return rates
