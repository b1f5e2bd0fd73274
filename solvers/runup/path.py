"""The motion of the rotor all along a run-up, fine enough for velocities and accelerations [theory: loads].

`Recorder` keeps it while a machine runs; the run is the same with it and without. SI units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from meshes.arrays import Array
from solvers.rotor.system import RotorSystem
from solvers.runup.machine import RunupMachine

FINE = 128  # moments a turn, of the spin or of the fastest natural frequency
ROWS = 4096  # steps that the machine writes down between two looks
_CLOSE = 0.3  # of the distance that is aimed at: steps nearer than that are not both kept
WORKS = ("unbalance", "drive", "motor")


@dataclass(frozen=True)
class RotorPath:
    """Coordinates of the rotor at m moments of a run-up with k samples.

    Parameters
    ----------
    time, angle : s, and rad by which the drum has turned, rising, shape (m,)
    coordinates : from the static equilibrium, shape (m, n)
    work : of the unbalance, of the drive on the liquid and of the motor up to each sample, J, shape (k, 3)
    """

    time: Array
    angle: Array
    coordinates: Array
    work: Array

    def motion(self, time: Array) -> tuple[Array, Array, Array, Array]:
        """Angle, coordinates, their rates and accelerations at some times, by cubic splines.

        Parameters
        ----------
        time : within those of the path, s, shape (t,)

        Returns
        -------
        rad, shape (t,); coordinates and their derivatives, shape (t, n) each
        """
        from scipy.interpolate import CubicSpline

        if self.time.size < 4:
            still = np.zeros((time.size, self.coordinates.shape[1]))
            return np.interp(time, self.time, self.angle), still, still, still
        spline = CubicSpline(self.time, self.coordinates)
        angle = np.interp(time, self.time, self.angle)
        return angle, spline(time), spline(time, 1), spline(time, 2)


def fastest_frequency(system: RotorSystem) -> float:
    """Highest undamped natural frequency of a rotor at rest, rad/s.

    Parameters
    ----------
    system : the rotor
    """
    squares = np.linalg.eigvals(np.linalg.solve(system.mass, system.stiffness)).real
    return math.sqrt(max(float(squares.max()), 0.0))


@dataclass
class Recorder:
    """Keeps the path of a machine's rotor: of all steps those that are about evenly apart.

    Parameters
    ----------
    frequency : fastest natural frequency, rad/s
    coordinates : how many the rotor has
    kept : time, angle and coordinates so far, arrays of shape (., 2 + n)
    waiting : steps since then, of which one is kept as soon as all of its neighbours are known
    work : works at each sample so far
    """

    frequency: float
    coordinates: int
    kept: list[Array] = field(default_factory=list)
    waiting: Array = field(default_factory=lambda: np.zeros((0, 0)))
    work: list[list[float]] = field(default_factory=list)

    def begin(self, machine: RunupMachine) -> None:
        """Keep the moment in which the machine stands, and have it write down its steps."""
        machine.follow(ROWS)
        start = machine.read()
        self.kept.append(np.concatenate([[start.time, start.angle], start.coordinates])[None])
        self.waiting = np.zeros((0, 2 + self.coordinates))
        self.sample(machine)

    def steps(self, machine: RunupMachine) -> None:
        """Take in the steps since the last look."""
        rows = np.concatenate([self.waiting, machine.followed()[:, : 2 + self.coordinates]])
        if not rows.size:
            return
        # The phase in parts of 1: of each part the step next to its middle is kept, so that no two are close.
        phase = FINE / (2.0 * np.pi) * (rows[:, 1] + self.frequency * rows[:, 0])
        part = np.floor(phase)
        whole = part < part[-1]
        order = np.lexsort((np.abs(phase - part - 0.5), part))
        _, first = np.unique(part[order], return_index=True)
        chosen = order[first]
        self.kept.append(rows[chosen[whole[chosen]]])
        self.waiting = rows[~whole]

    def sample(self, machine: RunupMachine) -> None:
        """Keep the works at a sample."""
        self.work.append([float(machine.sums[name]) for name in WORKS])

    def path(self) -> RotorPath:
        """What was kept, up to the last step."""
        rows = np.concatenate(self.kept)
        if self.waiting.size:
            # The last step stands for the one before it too, which may be close.
            rows = np.concatenate([rows[: max(1, len(rows) - 1)], self.waiting[-1:]])
        # Both steps next to an edge may be close where a part has only one.
        apart = np.diff(rows[:, 1] + self.frequency * rows[:, 0]) > _CLOSE * 2.0 * np.pi / FINE
        rows = rows[np.concatenate([[True], apart[:-1], [True]])] if len(rows) > 2 else rows
        return RotorPath(rows[:, 0], rows[:, 1], rows[:, 2:], np.array(self.work))
