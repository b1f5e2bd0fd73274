"""Small motions of rotor and balls about the balanced state [theory: balls, eq. 16-18]."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_positive
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.balls.motion import rates
from solvers.rotor.system import RotorSystem

# Share of a radius and of a radian by which the state is moved for a derivative of smooth forces.
_STEP = 1e-5
_NEUTRAL = 1e-7  # of the spin: roots this small are the turning of a race's balls, which nothing holds


def balanced_roots(system: RotorSystem, races: Sequence[BallRace], speed: float) -> Complex:
    """Characteristic roots of a rotor without unbalance whose balls stand evenly round their races.

    Looked at in the frame that turns with the rotor, where this state is at rest. One root of each race is 0:
    its balls may turn together. These are left out.

    Parameters
    ----------
    system : a rotor on supports that are alike in both directions; its unbalance does not count
    races : two balls or more each, all of one race alike
    speed : Omega, rad/s, above 0

    Returns
    -------
    Roots, 1/s, the one that grows most first, shape (2 n + 2 N - races,)

    Raises
    ------
    InputError : a speed that is not positive, a race whose balls do not balance one another
    """
    require_positive("speed", speed)
    for race in races:
        if len(race.masses) < 2 or len(set(race.masses)) > 1:
            raise InputError("races", race.masses, "two balls or more, all alike")
    axes, balls = race_arrays(system, races)
    n, count = len(system.coordinates), balls.shape[0]
    state = np.zeros(2 * (n + count) + 2)
    even = [2.0 * np.pi * k / len(race.masses) for race in races for k in range(len(race.masses))]
    state[2 * n : 2 * n + count], state[2 * n + count : -2] = even, speed
    matrices = (system.mass, system.damping + speed * system.gyroscopic, system.stiffness)
    still, numbers = np.zeros((2, n)), np.array([speed, 0.0])

    def rate(at: Array) -> Array:
        out = np.zeros(at.size)
        rates(0.0, at, *matrices, still, axes, balls, numbers, out)
        return out

    size = float(balls[:, 1].max())
    steps = np.full(2 * (n + count), _STEP)
    steps[:n], steps[n : 2 * n], steps[2 * n + count :] = _STEP * size, _STEP * size * speed, _STEP * speed
    jacobian = np.zeros((steps.size, steps.size))
    for k, step in enumerate(steps):
        moved = np.zeros(state.size)
        moved[k] = step
        jacobian[:, k] = (rate(state + moved) - rate(state - moved))[:-2] / (2.0 * step)
    jacobian -= speed * _turning(system, count)
    roots = np.linalg.eigvals(jacobian)
    roots = roots[np.argsort(np.abs(roots))]
    if np.abs(roots[: len(races)]).max() > np.sqrt(_NEUTRAL) * speed:
        raise InputError("races", len(races), "such that the balls of each may turn together")
    roots = roots[len(races) :]
    return np.asarray(roots[np.argsort(-roots.real)])


def _turning(system: RotorSystem, count: int) -> Array:
    """Rate of change of a state that turns with the rotor, at unit spin: pairs (x, y) and (alpha, beta)."""
    n = len(system.coordinates)
    quarter = np.zeros((n, n))
    for first, second in (("x", "y"), ("alpha", "beta")):
        if first in system.coordinates:
            i, j = system.coordinates.index(first), system.coordinates.index(second)
            quarter[i, j], quarter[j, i] = -1.0, 1.0
    whole = np.zeros((2 * (n + count),) * 2)
    whole[:n, :n] = whole[n : 2 * n, n : 2 * n] = quarter
    return whole
