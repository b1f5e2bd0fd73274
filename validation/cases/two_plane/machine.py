"""The made-up machine of balancing in two planes: a long and a short rotor, two races with two balls each."""

from __future__ import annotations

import numpy as np

from meshes.arrays import Array
from solvers.rotor.balls.balancers import BalancedRun, BallRace
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane

SUPPORTS = (Support(0.2, 1e4, 40.0), Support(-0.22, 1.1e4, 40.0))
UNBALANCES = (PlaneUnbalance(0.15, 1e-3, 0.0), PlaneUnbalance(-0.1, 8e-4, 2.0))
LONG = TwoPlane(10.0, 0.5, 0.1, SUPPORTS, UNBALANCES)
SHORT = TwoPlane(10.0, 0.1, 0.18, SUPPORTS, UNBALANCES)
RACES = (BallRace(0.15, 0.08, (0.015, 0.015), 0.3), BallRace(-0.15, 0.08, (0.015, 0.015), 0.3))
BALLS = sum(sum(race.masses) for race in RACES)
SCATTERED = (0.5, 1.5, 0.2, 3.0)  # rad, where the balls set out


def bare_deflection(rotor: TwoPlane, position: float, speed: float) -> float:
    """Size of the deflection without balancers, which is circular, m; position along the axis, m."""
    system = rotor.system()
    matrix = system.stiffness - speed**2 * system.mass + 1j * speed * system.damping
    whirl = np.linalg.solve(matrix + 1j * speed**2 * system.gyroscopic, speed**2 * system.unbalance)
    return float(abs(system.at(position)[0] @ whirl))


def over_bare(rotor: TwoPlane, run: BalancedRun, speed: float) -> Array:
    """Larger deflection of the two supports in a run, over that without balancers, shape (k,)."""
    system, places = rotor.system(), [support.position for support in rotor.supports]
    sizes = [np.abs(run.deflection(system, at)) / bare_deflection(rotor, at, speed) for at in places]
    return np.asarray(np.max(sizes, axis=0))
