"""Balls in races on a rotor that runs up: how they start, and what the steps know of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.layer.records import Record, records
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.system import RotorSystem
from solvers.runup.state import BALL


@dataclass(frozen=True)
class Balls:
    """The balls of some races at the start of a run-up; N balls in all, race by race."""

    races: tuple[BallRace, ...] = ()  #: that hold them
    places: tuple[float, ...] = ()  #: angle of each in the standing frame, rad, N of them
    #: speed of each over the spin: 1 at rest in the drum, 0 at rest in space, N of them
    shares: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        count = sum(len(race.masses) for race in self.races)
        for name in ("places", "shares"):
            values = getattr(self, name)
            if len(values) != count or not np.isfinite(values).all():
                raise InputError(name, values, f"finite numbers of {count} balls")


NO_BALLS = Balls()


def ball_records(balls: Balls) -> Record:
    """What the steps know of each ball, records BALL, shape (N,)."""
    rows = [
        (
            *(mass, race.radius, race.rolling * mass * race.radius**2, race.drag * race.radius**2),
            *(race.carried * mass * race.radius**2, race.driven * mass * race.radius**2, race.resistance),
        )
        for race in balls.races
        for mass in race.masses
    ]
    found = records(BALL, len(rows))
    for j, row in enumerate(rows):
        found[j] = row
    return found


def race_planes(system: RotorSystem, balls: Balls) -> Array:
    """Displacement of the axis in the plane of each ball for unit coordinates, shape (N, 2, n)."""
    planes, _ = race_arrays(system, balls.races)
    return np.asarray(planes, dtype=float).reshape(len(balls.places), 2, len(system.coordinates))


def _along(races: Array, roll: Array) -> Array:
    """Part of the motion of each race's centre along the race at its ball, for unit rates, shape (N, n)."""
    across = np.stack((-np.sin(roll), np.cos(roll)), axis=1)
    return np.asarray(np.einsum("ji,jin->jn", across, races))


def balls_energy(
    balls: Record, races: Array, rate: Array, roll: Array, roll_rate: Array, spin: float
) -> float:
    """Kinetic energy of the balls, J [theory: races, eq. 1]."""
    carried = races @ rate
    axis = 0.5 * balls.mass * np.square(carried).sum(axis=1)
    meeting = balls.mass * balls.radius * roll_rate * (_along(races, roll) @ rate)
    own = 0.5 * balls.inertia * np.square(roll_rate) - balls.carried * spin * roll_rate
    return float(np.sum(axis + meeting + own + 0.5 * balls.driven * spin**2))


def balls_inertia(balls: Record, races: Array, roll: Array) -> tuple[Array, Array]:
    """What the balls add to the rotor's inertia against an impulse, and how their rates answer one.

    kg and kg m^2, (n, n); fall of the balls' rates for unit jumps of the rotor's rates, (N, n).
    """
    along, moving = _along(races, roll), balls.mass * balls.radius
    whole = np.einsum("j,jin,jim->nm", balls.mass, races, races)
    answer = (moving / balls.inertia)[:, None] * along
    return whole - np.einsum("j,jn,jm->nm", moving, along, answer), answer
