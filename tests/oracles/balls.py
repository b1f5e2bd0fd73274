"""Where statics puts the balls of a balancer, whirls with light balls, balls spread round a race."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from solvers.rotor.balls.balancers import BallRace
from solvers.rotor.balls.states import RotorWithBalls
from solvers.rotor.system import RotorSystem
from solvers.runup.balls import Balls


def balanced_places(unbalance: complex, moment: float, count: int) -> Array | None:
    """Places in which equal balls balance an unbalance in their own plane [theory: balls, eq. 21].

    Pairs symmetrical about the direction opposite to the unbalance; of an odd number one stays in it.

    Parameters
    ----------
    unbalance : U0 e^{i angle}, kg m
    moment : m R of one ball, kg m
    count : N, 1 or more

    Returns
    -------
    Angles in the rotor, rad, shape (N,); None where the balls cannot balance it

    Raises
    ------
    InputError : a moment that is not positive, no ball
    """
    require_positive("moment", moment)
    if count < 1:
        raise InputError("count", count, "1 or more")
    needed = abs(unbalance) / moment
    odd = count % 2
    pairs = count - odd
    # N = 1 leaves no angle to choose.
    cosine = (needed - odd) / pairs if pairs else (1.0 if needed == 1.0 else math.inf)
    if abs(cosine) > 1.0:
        return None
    away = math.acos(cosine)
    spots = [0.0] * odd + [away, -away] * (pairs // 2)
    opposite = cmath.phase(unbalance) + math.pi if unbalance else 0.0
    return np.array(spots) + opposite


def residual_unbalance(unbalance: complex, moment: float, places: ArrayLike) -> complex:
    """Unbalance of rotor and balls together, kg m [theory: balls, eq. 21].

    Parameters
    ----------
    unbalance : of the rotor, U0 e^{i angle}, kg m
    moment : m R of one ball, kg m
    places : of the balls in the rotor, rad, shape (N,)
    """
    return complex(unbalance + moment * np.exp(1j * np.asarray(places, dtype=float)).sum())


def unbalance_in_planes(
    unbalances: Sequence[tuple[float, complex]], first: float, second: float
) -> tuple[complex, complex]:
    """Two unbalances with the same static and couple parts as any number of them [theory: balls, eq. 21].

    Parameters
    ----------
    unbalances : position along the axis, m, and U e^{i angle}, kg m, of each
    first, second : positions of the two planes, m

    Returns
    -------
    In the first and in the second plane, kg m: what balls there must oppose

    Raises
    ------
    InputError : both planes in one place
    """
    if first == second:
        raise InputError("second", second, "another plane than the first")
    static = sum((size for _, size in unbalances), 0j)
    couple = sum((position * size for position, size in unbalances), 0j)
    there = (couple - first * static) / (second - first)
    return static - there, there


def light_ball_roots(system: RotorSystem, races: Sequence[BallRace], speed: float) -> np.ndarray:
    """Forward whirls of a rotor with light balls evenly round their races [theory: balls, eq. 37-38].

    lambda in the standing frame, 1/s, by rising frequency, to first order in the balls and in the damping of
    the supports. Above the whirl frequency the drag of the races, which turns with the rotor, feeds a whirl;
    the supports must damp more than that.
    """
    machine = RotorWithBalls(system, tuple(races))
    axes, balls = machine.axes, machine.balls
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


def spread_balls(races: Sequence[BallRace]) -> Balls:
    """Balls evenly round each race, at rest in the drum."""
    places = [2.0 * np.pi * k / len(race.masses) for race in races for k in range(len(race.masses))]
    return Balls(tuple(races), tuple(places), (1.0,) * len(places))
