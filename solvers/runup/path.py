"""Motion of the rotor all along a run-up, fine enough for velocities and accelerations [theory: loads].

`Recorder` keeps it while a machine runs; the run is the same with it and without. SI units.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from meshes.arrays import Array, Flags, Index
from solvers.rotor.system import RotorSystem
from solvers.runup.machine import RunupMachine

FINE = 128  # moments a turn, of the spin or of the fastest natural frequency
ROWS = 4096  # steps that the machine writes down between two looks
_LEAST = 6  # moments through which a spline goes
_CLOSE = 0.3  # of the distance that is aimed at: steps nearer than that are not both kept
WORKS = ("unbalance", "drive", "motor")


@dataclass(frozen=True)
class RotorPath:
    """Coordinates of the rotor at m moments of a run-up with k samples."""

    time: Array  #: s, and rad by which the drum has turned, rising, shape (m,)
    angle: Array
    coordinates: Array  #: from the static equilibrium, shape (m, n)
    #: of the unbalance, of the drive on the liquid and of the motor up to each sample, J, shape (k, 3)
    work: Array
    #: times at which liquid that is caught or falls changes velocities at once, s, rising, shape (j,)
    jumps: Array = field(default_factory=lambda: np.zeros(0))

    def motion(self, time: Array) -> tuple[Array, Array, Array, Array]:
        """Angle, coordinates, their rates and accelerations at rising times, by cubic splines between jumps.

        At a jump the motion after it; nan where two jumps are too close for derivatives.
        """
        angle, n = np.interp(time, self.time, self.angle), self.coordinates.shape[1]
        if self.time.size < _LEAST:
            still = np.zeros((time.size, n))
            return angle, still, still, still
        found = np.full((3, time.size, n), np.nan)
        ends = np.concatenate([[-np.inf], self.jumps, [np.inf]])
        for k, begin in enumerate(ends[:-1].tolist()):
            part = (time >= begin) & (time < ends[k + 1])
            spline = self._piece(begin, float(ends[k + 1])) if part.any() else None
            if spline is not None:
                found[:, part] = [spline(time[part], order) for order in range(3)]
            elif part.any():
                shifts = [np.interp(time[part], self.time, row) for row in self.coordinates.T]
                found[0, part] = np.stack(shifts, axis=1)
        return angle, found[0], found[1], found[2]

    def kicks(self) -> Array:
        """Changes of the rates at each jump, m/s and rad/s, shape (j, n).

        nan where the motion before or after is not known.
        """
        ends, found = np.concatenate([[-np.inf], self.jumps, [np.inf]]), []
        for k, time in enumerate(self.jumps.tolist()):
            before, after = self._piece(float(ends[k]), time), self._piece(time, float(ends[k + 2]))
            if before is None or after is None:
                found.append(np.full(self.coordinates.shape[1], np.nan))
            else:
                found.append(after(time, 1) - before(time, 1))
        return np.array(found).reshape(-1, self.coordinates.shape[1])

    def _piece(self, begin: float, end: float) -> Any:
        """Spline through the moments between two jumps, None through too few."""
        from scipy.interpolate import CubicSpline

        rows = (self.time >= begin) & (self.time <= end)
        if np.count_nonzero(rows) < _LEAST:
            return None
        return CubicSpline(self.time[rows], self.coordinates[rows])


def fastest_frequency(system: RotorSystem) -> float:
    """Highest undamped natural frequency of a rotor at rest, rad/s."""
    squares = np.linalg.eigvals(np.linalg.solve(system.mass, system.stiffness)).real
    return math.sqrt(max(float(squares.max()), 0.0))


def evenly(phase: Array) -> Index:
    """Of some moments the nearest to the middle of each whole number of their phase."""
    part = np.floor(phase)
    order = np.lexsort((np.abs(phase - part - 0.5), part))
    _, first = np.unique(part[order], return_index=True)
    return np.asarray(order[first])


def apart(time: Array, angle: Array, frequency: float) -> Flags:
    """Of moments chosen by `evenly` those that are not close to the one before; both ends stay."""
    if time.size <= 2:
        return np.ones(time.shape, dtype=bool)
    far = np.diff(angle + frequency * time) > _CLOSE * 2.0 * np.pi / FINE
    return np.concatenate([[True], far[:-1], [True]])


@dataclass
class Recorder:
    """Keeps the path of a machine's rotor: of all steps those that are about evenly apart."""

    frequency: float  #: fastest natural frequency, rad/s
    coordinates: int  #: how many the rotor has
    #: time, angle and coordinates so far, arrays of shape (., 2 + n)
    kept: list[Array] = field(default_factory=list)
    #: steps since then, of which one is kept as soon as all of its neighbours are known
    waiting: Array = field(default_factory=lambda: np.zeros((0, 0)))
    work: list[list[float]] = field(default_factory=list)  #: works at each sample so far

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
        whole = np.floor(phase) < np.floor(phase[-1])
        chosen = evenly(phase)
        self.kept.append(rows[chosen[whole[chosen]]])
        self.waiting = rows[~whole]

    def sample(self, machine: RunupMachine) -> None:
        """Keep the works at a sample."""
        self.work.append([float(machine.sums[name]) for name in WORKS])

    def path(self, jumps: Sequence[float] = ()) -> RotorPath:
        """What was kept, up to the last step."""
        rows = np.concatenate(self.kept)
        if self.waiting.size:
            # The last step stands for the one before it too, which may be close.
            rows = np.concatenate([rows[: max(1, len(rows) - 1)], self.waiting[-1:]])
        # Both steps next to an edge may be close where a part has only one.
        rows = rows[apart(rows[:, 0], rows[:, 1], self.frequency)]
        return RotorPath(rows[:, 0], rows[:, 1], rows[:, 2:], np.array(self.work), np.unique(jumps))
