"""Motions in which the balls rest in the turning rotor: balanced ones, and those that leave a deflection."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_positive
from solvers.roots import bracketed_root
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.system import RotorSystem

# Coordinates that a turn of the machine about its spin axis takes into one another.
_PAIRS = (("x", "y"), ("alpha", "beta"))
_ALIKE = 1e-9  # relative; two directions that differ by rounding alone are the same
_BALANCED = 1e-9  # of the balls' own moment: what may be left of a balanced rotor's unbalance
_ROUNDS = 60  # of Newton's method for steady places


def quarter_turn(system: RotorSystem) -> Array:
    """J: rate of change of coordinates that turn with the spin, at unit speed [theory: balls, eq. 28].

    Parameters
    ----------
    system : a rotor that is the same in every direction across its axis

    Returns
    -------
    J with J^2 = -1, shape (n, n)

    Raises
    ------
    InputError : coordinates without a partner, or matrices that a turn changes
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


def ball_moments(system: RotorSystem, races: Sequence[BallRace], places: ArrayLike) -> Complex:
    """Share of each ball in the unbalance, m R (B_1 - i B_2)^T e^{i psi} [theory: balls, eq. 21].

    Parameters
    ----------
    system, races : rotor and balls
    places : psi of each ball in the rotor, race by race, rad, shape (N,)

    Returns
    -------
    One column for each ball, in the units of the rotor's unbalance, shape (n, N)

    Raises
    ------
    InputError : places that are not one finite angle for each ball
    """
    axes, balls = race_arrays(system, races)
    angles = checked_places(places, balls.shape[0])
    size = balls[:, 0] * balls[:, 1]
    across = axes[:, 0] - 1j * axes[:, 1]
    return np.asarray((size * np.exp(1j * angles))[:, None] * across).T


def checked_places(places: ArrayLike, count: int) -> Array:
    """Places of the balls as an array.

    Parameters
    ----------
    places : angles, rad
    count : of the balls

    Raises
    ------
    InputError : not one finite angle for each ball
    """
    angles = np.asarray(places, dtype=float)
    if angles.shape != (count,) or not np.isfinite(angles).all():
        raise InputError("places", angles.tolist(), f"finite angles of {count} balls")
    return angles


def balanced_places(system: RotorSystem, races: Sequence[BallRace]) -> Array:
    """Places at which the balls take away the whole unbalance [theory: balls, eq. 21].

    Of all such places those that are evenly spread over an arc of each race; of all shares of the races in
    the unbalance those with the least sum of squares over what each race can hold. Three balls and more have
    a family of further ones.

    Parameters
    ----------
    system : the rotor with its unbalance
    races : the balls of one race alike; a race with one ball serves if its moment happens to be right

    Returns
    -------
    psi of each ball in the rotor, race by race, rad, shape (N,)

    Raises
    ------
    InputError : balls of one race that differ, or that cannot balance this unbalance

    Examples
    --------
    >>> from solvers.rotor.jeffcott import Jeffcott
    >>> rotor = Jeffcott(10.0, 1e4, 40.0, 1.2e-3).system()
    >>> balanced_places(rotor, [BallRace(0.0, 0.08, (0.015, 0.015), 0.3)]).round(3)
    array([2.094, 4.189])
    """
    for race in races:
        if len(set(race.masses)) > 1:
            raise InputError("races", race.masses, "balls of one race alike; else give their places")
    rows = [system.at(race.position) for race in races]
    across = np.array([row[0] - 1j * row[1] for row in rows]).T
    # Weighted so that the least sum has each race hold the same part of what it can.
    weight = np.sqrt([sum(race.masses) * race.radius for race in races])
    shares = weight * np.linalg.lstsq(across * weight, -system.unbalance, rcond=None)[0]
    places: list[float] = []
    for race, share in zip(races, shares.tolist(), strict=True):
        # A share at rounding has no direction.
        most = sum(race.masses) * race.radius
        wanted = share if abs(share) > 1e-12 * most else 0.0
        places += _arc(race, wanted)
    require_balance(system, races, places)
    return np.array(places)


def require_balance(system: RotorSystem, races: Sequence[BallRace], places: ArrayLike) -> None:
    """The balls at these places take away the whole unbalance.

    Parameters
    ----------
    system, races : rotor and balls
    places : of the balls, rad, shape (N,)

    Raises
    ------
    InputError : they leave some of it
    """
    moments = ball_moments(system, races, places)
    left = float(np.abs(system.unbalance + moments.sum(axis=1)).max())
    most = float(np.abs(moments).sum())
    if not left <= _BALANCED * most:
        raise InputError("places", places, f"such that the unbalance is balanced; {left:.3g} is left")


def _arc(race: BallRace, share: complex) -> list[float]:
    """Places of equal balls, evenly over an arc, whose moments add up to a share, kg m."""
    count, moment = len(race.masses), race.masses[0] * race.radius
    wanted = abs(share) / moment
    if wanted > count * (1.0 + 1e-12):
        raise InputError("races", race.masses, f"balls of {abs(share):.6g} kg m or more together")
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
    return [middle + gap * (k - 0.5 * (count - 1)) for k in range(count)]


def turning_stiffness(system: RotorSystem, races: Sequence[BallRace], speed: float) -> Array:
    """What a deflection that turns with the rotor is held by, balls included [theory: balls, eq. 30].

    K + Omega (C + Omega G) J - Omega^2 (M + sum m B^T B), shape (n, n).

    Parameters
    ----------
    system, races : a rotor alike in every direction, and its balls
    speed : Omega, rad/s
    """
    axes, balls = race_arrays(system, races)
    whole = system.mass + np.einsum("j,jai,jak->ik", balls[:, 0], axes, axes)
    turned = (system.damping + speed * system.gyroscopic) @ quarter_turn(system)
    return np.asarray(system.stiffness + speed * turned - speed**2 * whole)


def turning_deflection(
    system: RotorSystem, races: Sequence[BallRace], speed: float, places: ArrayLike
) -> Array:
    """Deflection, at rest in the rotor, with balls held at their places [theory: balls, eq. 30].

    Parameters
    ----------
    system, races : a rotor alike in every direction, and its balls
    speed : Omega, rad/s
    places : of the balls, rad, shape (N,)

    Returns
    -------
    p at the moment when the unbalance's angle is that of its complex number, m or rad, shape (n,)
    """
    whole = system.unbalance + ball_moments(system, races, places).sum(axis=1)
    return np.linalg.solve(turning_stiffness(system, races, speed), speed**2 * whole.real)


def pulls(system: RotorSystem, races: Sequence[BallRace], speed: float, places: ArrayLike) -> Array:
    """Displacement of the axis along the race at each ball, 0 where balls rest [theory: balls, eq. 31].

    Parameters
    ----------
    system, races, speed, places : see `turning_deflection`

    Returns
    -------
    t_j^T B_j p, m, shape (N,): the ball is driven onward by m R Omega^2 times it
    """
    axes, balls = race_arrays(system, races)
    angles = checked_places(places, balls.shape[0])
    moved = axes @ turning_deflection(system, races, speed, angles)
    return np.asarray(moved[:, 1] * np.cos(angles) - moved[:, 0] * np.sin(angles))


def steady_places(
    system: RotorSystem, races: Sequence[BallRace], speed: float, places: ArrayLike
) -> Array | None:
    """Places next to given ones at which the balls rest in the rotor [theory: balls, eq. 31].

    Balanced or not, by Newton's method on the pulls. Balls may sit in one another: nothing in the equations
    keeps them apart.

    Parameters
    ----------
    system, races, speed : see `turning_deflection`
    places : where the search begins, rad, shape (N,)

    Returns
    -------
    Places, rad, shape (N,); None where the search finds none
    """
    require_positive("speed", speed)
    axes, balls = race_arrays(system, races)
    angles = checked_places(places, balls.shape[0]).copy()
    held = turning_stiffness(system, races, speed)
    size = float(np.abs(ball_moments(system, races, angles)).sum() + np.abs(system.unbalance).sum())
    scale = speed**2 * size / float(np.abs(held).max())
    for _ in range(_ROUNDS):
        x, y = np.cos(angles), np.sin(angles)
        along = axes[:, 1] * x[:, None] - axes[:, 0] * y[:, None]
        outward = axes[:, 0] * x[:, None] + axes[:, 1] * y[:, None]
        deflection = turning_deflection(system, races, speed, angles)
        left = along @ deflection
        if np.abs(left).max() <= 1e-13 * max(scale, float(np.abs(deflection).max())):
            return angles
        push = (speed**2 * balls[:, 0] * balls[:, 1])[:, None] * along
        slope = along @ np.linalg.solve(held, push.T) - np.diag(outward @ deflection)
        change = np.linalg.lstsq(slope, -left, rcond=1e-12)[0]
        angles += change / max(1.0, 2.0 * float(np.abs(change).max()))
    return None


def without_unbalance(system: RotorSystem) -> RotorSystem:
    """The rotor balanced by itself.

    Parameters
    ----------
    system : the rotor
    """
    return replace(system, unbalance=np.zeros_like(system.unbalance))
