"""Gravity across the axis and balls that rest in a drum: they swing about their places once a turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import require_not_negative, require_positive
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.system import RotorSystem


@dataclass(frozen=True)
class Swing:
    """Small swings of N balls by gravity, and what they do to a rotor of n coordinates."""

    #: complex amplitude of each ball's angle in the drum, psi + Re(balls e^{i Omega t}), rad, shape (N,)
    balls: Complex
    #: complex amplitudes of the rotor at twice the spin, Re(coordinates e^{2 i Omega t}), (n,)
    coordinates: Complex


def ball_swing(speed: Array, radius: Array, rate: Array, rolling: Array, gravity: float) -> Array:
    """Swing of a single ball on a rotor that does not give way [theory: races, eq. 12].

    Amplitude of its angle in the drum, rad, shape (...); `rate` is the drag over its mass b/m, 1/s, `rolling`
    kappa, gravity acts across the axis.
    """
    return np.asarray(gravity / (radius * np.square(speed)) / np.hypot(rolling, rate / speed))


def gravity_swing(
    system: RotorSystem,
    races: Sequence[BallRace],
    speed: float,
    places: Array,
    coordinates: Complex,
    gravity: float,
) -> Swing:
    """Swings of balls about places at which they rest, rotor and balls together [theory: races, eq. 11].

    To first order in g/(R Omega^2), gravity across the axis against the first direction. Balls that swing
    once a turn shake the axis with twice the spin. Where the supports differ, what comes back to the balls
    with three times the spin is left out.
    """
    require_positive("speed", speed)
    require_not_negative("gravity", gravity)
    axes, balls = race_arrays(system, races)
    mass, radius, drag, rolling = balls.T
    along = 1j * np.exp(1j * places)
    whole = system.mass + np.einsum("j,jin,jim->nm", mass, axes, axes)
    damping = system.damping + speed * system.gyroscopic
    held = system.stiffness + 2j * speed * damping - 4.0 * speed**2 * whole
    # A ball that swings by 1 rad pushes forward with twice the spin.
    push = (2.0 * mass * radius * speed**2 * along)[:, None] * (axes[:, 0] - 1j * axes[:, 1])
    moved = np.linalg.solve(held, push.T)
    forward = 0.5 * (axes[:, 0] + 1j * axes[:, 1])
    outward = ((forward @ coordinates) * np.exp(-1j * places)).real
    own = rolling * radius * -(speed**2) + 1j * speed * drag * radius / mass + speed**2 * outward
    matrix = np.diag(own) - 4.0 * speed**2 * np.conj(along)[:, None] * (forward @ moved)
    swing = np.linalg.solve(matrix, -gravity * along)
    return Swing(swing, moved @ swing)


def swing_power(races: Sequence[BallRace], speed: float, swing: Complex) -> float:
    """Mean power that the drag of the races turns into heat as balls swing, W; the motor replaces it.

    Amplitudes as `Swing.balls`.
    """
    drag = np.array([race.drag * race.radius**2 for race in races for _ in race.masses])
    return float(0.5 * speed**2 * drag @ np.square(np.abs(swing)))


def holding(races: Sequence[BallRace], speed: ArrayLike, gravity: float = 0.0) -> Array:
    """Deflection along its race up to which a ball stays where it is [theory: races, eq. 9], m, shape (s, N).

    Of a drum that lies gravity takes its part once a turn; 0 where it moves the ball in each.
    """
    reach = [race.resistance * race.radius for race in races for _ in race.masses]
    taken = gravity / np.square(np.atleast_1d(np.asarray(speed, dtype=float)))
    return np.asarray(np.maximum(np.array(reach) - taken[:, None], 0.0))
