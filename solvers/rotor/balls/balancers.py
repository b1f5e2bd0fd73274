"""Ball balancers on any rotor: balanced states, and the motion of rotor and balls together in time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.rotor.balls.motion import energy
from solvers.rotor.system import RotorSystem

MOST_STEPS = 100_000_000  # about ten minutes


@dataclass(frozen=True)
class BallRace:
    """A circular race around the rotor's axis with balls that roll in it."""

    position: float  #: along the axis, m
    radius: float  #: R of the balls' centres, m
    masses: tuple[float, ...]  #: m of each ball, kg
    drag: float  #: of the race on one ball over its speed in it, N s/m
    #: kappa, inertia of a ball on its way over that of its sliding mass, 7/5 for a ball that rolls
    rolling: float = 7.0 / 5.0
    #: f, what a ball resists to rolling over the force with which it presses on the race; a ball that is at
    #: rest in the rotor stays until it is pulled harder. Only run-ups know it
    resistance: float = 0.0
    #: s and d, torque on a ball and on the rotor by a change of the spin over m R^2 times that change, 0 for
    #: a ball that slides [theory: races, eq. 1]; a constant spin does not feel them
    carried: float = 0.0
    driven: float = 0.0

    def __post_init__(self) -> None:
        for name in ("resistance", "carried", "driven"):
            require_not_negative(name, getattr(self, name))
        if not math.isfinite(self.position):
            raise InputError("position", self.position, "a finite number")
        require_positive("radius", self.radius)
        require_not_negative("drag", self.drag)
        if not self.masses:
            raise InputError("masses", self.masses, "those of one ball or more")
        for mass in self.masses:
            require_positive("masses", mass)
        if not (math.isfinite(self.rolling) and self.rolling >= 1.0):
            raise InputError("rolling", self.rolling, "1 or above")


@dataclass(frozen=True)
class BalancedRun:
    """Motion of a rotor with ball balancers at constant spin; s samples, n coordinates, N balls in all."""

    time: Array  #: s, shape (s,)
    coordinates: Array  #: q, m or rad, shape (s, n)
    ball_angle: Array  #: of each ball in the standing frame, race by race, rad, shape (s, N)
    ball_speed: Array  #: rad/s, shape (s, N)
    energy_error: float  #: gap of the energy audit over the largest of its parts [theory: balls, eq. 20]
    converged: bool  #: every number is finite and the audit closes to a thousandth
    speed: float  #: Omega, rad/s

    def deflection(self, system: RotorSystem, position: float) -> Complex:
        """Complex deflection of the axis at a position in the turning frame, m, shape (s,)."""
        first, second = system.at(position) @ self.coordinates.T
        return np.asarray((first + 1j * second) * np.exp(-1j * self.speed * self.time))


def simulate(
    system: RotorSystem,
    races: Sequence[BallRace],
    speed: float,
    duration: float,
    *,
    places: ArrayLike | None = None,
    gravity: float = 0.0,
    samples: int = 400,
    steps: int = 48,
) -> BalancedRun:
    """Integrate rotor and balls at constant spin [theory: balls, eq. 16-18].

    Balls start at rest in the rotor at `places` (rad, race by race; None: evenly), the rotor without
    deflection; gravity acts across the axis, against the second direction. `steps` counts those of the
    fourth-order method in a turn, or in 2 pi of the fastest own motion if that is faster.
    """
    from solvers.rotor.balls.steps import advance

    require_positive("speed", speed)
    require_positive("duration", duration)
    require_not_negative("gravity", gravity)
    if not races or samples < 2 or steps < 8:
        raise InputError("races, samples, steps", (len(races), samples, steps), "at least 1, 2 and 8")
    if any(race.resistance > 0.0 for race in races):
        raise InputError("resistance", [race.resistance for race in races], "0 here; a run-up knows it")
    axes, balls = race_arrays(system, races)
    n, count = len(system.coordinates), balls.shape[0]
    state = _initial(n, races, speed, places, count)
    in_sample = math.ceil(duration / (samples - 1) * _fastest(system, balls, speed) * steps / (2.0 * math.pi))
    if in_sample * (samples - 1) > MOST_STEPS:
        raise InputError("duration", duration, f"one of at most {MOST_STEPS:g} steps; the rotor is stiff")
    step = duration / ((samples - 1) * in_sample)
    record = np.zeros((samples, state.size))
    turning = np.stack((system.unbalance.real, system.unbalance.imag))
    damping = system.damping + speed * system.gyroscopic
    numbers = np.array([speed, gravity])
    matrices = (system.mass, damping, system.stiffness, turning, axes, balls)
    advance(state, matrices, numbers, step, in_sample, record)
    error = _audit(record, system, axes, balls, gravity)
    return BalancedRun(
        time=np.linspace(0.0, duration, samples),
        coordinates=record[:, :n],
        ball_angle=record[:, 2 * n : 2 * n + count],
        ball_speed=record[:, 2 * n + count : 2 * (n + count)],
        energy_error=error,
        converged=error <= 1e-3,
        speed=speed,
    )


def _fastest(system: RotorSystem, balls: Array, speed: float) -> float:
    """Largest of the spin, the rotor's own frequencies and rates of decay, and the balls' decay, rad/s."""
    n = len(system.coordinates)
    forces = np.hstack((system.stiffness, system.damping + speed * system.gyroscopic))
    matrix = np.zeros((2 * n, 2 * n))
    matrix[:n, n:] = np.eye(n)
    matrix[n:] = -np.linalg.solve(system.mass, forces)
    return float(max(speed, np.abs(np.linalg.eigvals(matrix)).max(), (balls[:, 2] / balls[:, 0]).max()))


def _audit(record: Array, system: RotorSystem, axes: Array, balls: Array, gravity: float) -> float:
    """Largest gap between the work done and the change of energy, over the sum of the sizes of all work."""
    if not np.isfinite(record).all():
        return math.inf
    held = np.array([energy(state, system.mass, system.stiffness, axes, balls, gravity) for state in record])
    gap, scale = float(np.max(np.abs(held - held[0] - record[:, -2]))), float(record[-1, -1])
    return gap / scale if scale > 0.0 else gap


def race_arrays(system: RotorSystem, races: Sequence[BallRace]) -> tuple[Array, Array]:
    """Axis displacement in each ball's plane, and mass, radius, drag, rolling inertia of each ball."""
    axes = [system.at(race.position) for race in races for _ in race.masses]
    rows = [(mass, race.radius, race.drag, race.rolling) for race in races for mass in race.masses]
    return np.array(axes), np.array(rows)


def with_balls_at(system: RotorSystem, races: Sequence[BallRace], places: Array) -> RotorSystem:
    """Rotor with its balls fixed where they are: a part of its mass and of its unbalance.

    Places in rad, race by race, shape (N,).
    """
    axes, balls = race_arrays(system, races)
    mass = system.mass + np.einsum("j,jin,jim->nm", balls[:, 0], axes, axes)
    turning = balls[:, 0] * balls[:, 1] * np.exp(1j * places)
    return replace(system, mass=mass, unbalance=system.unbalance + turning @ (axes[:, 0] - 1j * axes[:, 1]))


def _initial(
    n: int,
    races: Sequence[BallRace],
    speed: float,
    places: ArrayLike | None,
    count: int,
) -> Array:
    """State at time 0."""
    state = np.zeros(2 * (n + count) + 2)
    even = [2.0 * math.pi * k / len(race.masses) for race in races for k in range(len(race.masses))]
    start = np.array(even) if places is None else np.asarray(places, dtype=float)
    if start.shape != (count,) or not np.isfinite(start).all():
        raise InputError("places", start.tolist(), f"finite angles of {count} balls")
    state[2 * n : 2 * n + count] = start
    state[2 * n + count : -2] = speed
    return state
