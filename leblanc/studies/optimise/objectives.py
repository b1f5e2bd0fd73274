"""What is to be small: vibrations over the volumes [theory: optimum, eq. 2-4].

At one speed or a mean over several, the largest over many without asking for all of them, and the largest of
a run-up in time; `robust` has the quantile over operating conditions.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Protocol

import numpy as np

from leblanc.scene.scene import Scene, Speeds
from leblanc.studies.liquid import runup_model
from leblanc.studies.optimise.answers import FilledMachine, with_volumes
from meshes.arrays import Array, Flags, Index


class Vibration(Protocol):
    """A vibration that depends on the volumes of m sets, m^3, shape (m, c)."""

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """Vibration, m, shape (m,); above the bound an estimate from below will do."""
        ...

    def least(self, volumes: Array, bound: float = math.inf) -> tuple[Array, Flags]:
        """The same, known for sure where it is least; elsewhere estimates from below.

        Parameters
        ----------
        volumes : m^3, shape (m, c)
        bound : what is above it need not be known for sure even if it is least

        Returns
        -------
        vibration, m, and where that is sure, shape (m,) each
        """
        ...


class AlwaysExact(ABC):
    """A vibration that costs the same to know for sure."""

    @abstractmethod
    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`."""

    def least(self, volumes: Array, bound: float = math.inf) -> tuple[Array, Flags]:
        """See `Vibration`; sure everywhere."""
        return self.exact(volumes, bound), np.ones(volumes.shape[0], dtype=bool)


class AtSpeed(AlwaysExact):
    """Amplitude at one speed, or the weighted mean over several [theory: optimum, eq. 2].

    Parameters
    ----------
    machine : with any volumes
    speeds, weights : rad/s and their shares, shape (k,)
    """

    def __init__(self, machine: FilledMachine, speeds: Array, weights: Array) -> None:
        self.machine, self.speeds, self.weights = machine, speeds, weights / weights.sum()

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`."""
        count = self.speeds.size
        pairs = self.machine.at(np.repeat(volumes, count, axis=0), np.tile(self.speeds, volumes.shape[0]))
        return np.asarray(pairs.amplitude.reshape(-1, count) @ self.weights)


class RunupPeak(AlwaysExact):
    """Largest amplitude of a run-up in time.

    Parameters
    ----------
    scene : with a table `runup`
    cells : round each wall; the scene's if None
    """

    def __init__(self, scene: Scene, cells: int | None = None) -> None:
        from leblanc.studies.runup import across_gravity, drive_of, liquid_model, numerics_of, planned

        plan = planned(scene)
        self.scene, self.drive, self.gravity = scene, drive_of(plan), across_gravity(scene)
        self.numerics = numerics_of(plan, cells, check=False)
        self.model = runup_model(liquid_model(scene))
        self._known: dict[bytes, float] = {}

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`; infinite for a run that did not come to its end."""
        return np.array([self._one(np.ascontiguousarray(row)) for row in volumes])

    def _one(self, volumes: Array) -> float:
        from leblanc.scene.scene import dry_rotor
        from solvers.runup.runup import run_up

        key = volumes.tobytes()
        if key not in self._known:
            friction, fills = self.scene.model.friction, with_volumes(self.scene, volumes).fills
            system = dry_rotor(self.scene).system()
            numerics, drive = self.numerics, self.drive
            run = run_up(system, fills, drive, friction, self.gravity, numerics, None, self.model)
            self._known[key] = float(run.amplitude.max()) if run.converged else math.inf
        return self._known[key]


_EQUAL = 1e-9  # relative
_COARSE = 16  # speeds at which a peak is first looked for
_PEAKS = 3  # of them that are looked at more closely
_PARTS = 4  # into which the gaps beside a peak are cut
_WATCHED = 2  # speeds of former peaks, beside the last
_WINDOW = (-3, -1, 0, 1, 3)  # places around the last
_CLOSE = (-8, -5, -3, -2, -1, 0, 1, 2, 3, 5, 8)  # places around a peak that is to be known for sure


class PeakOver:
    """Largest amplitude over a range of speeds [theory: optimum, eq. 3].

    The largest at some speeds is never above the largest at all. So volumes that are worse than the best
    known at a few speeds already are not looked at any further, and of several sets of volumes the best is
    the one whose peak, once it is known for sure, is still below what the others reach at those few speeds.

    Parameters
    ----------
    machine : with any volumes
    speeds : evenly spaced
    """

    def __init__(self, machine: FilledMachine, speeds: Speeds) -> None:
        self.machine, self.speeds = machine, speeds
        self.speed = np.linspace(speeds.start, speeds.stop, speeds.count)
        self._watched: list[int] = []
        step = max(1, self.speed.size // _COARSE)
        self._coarse = sorted({*range(0, self.speed.size, step), self.speed.size - 1})

    def exact(self, volumes: Array, bound: float = math.inf) -> Array:
        """See `Vibration`."""
        if not self.machine.planar:
            return np.asarray(self.machine.over(volumes, self.speeds).max(axis=1))
        known = np.full((volumes.shape[0], self.speed.size), np.nan)
        self._make_sure(known, volumes, np.arange(volumes.shape[0]), bound)
        return _so_far(known)

    def least(self, volumes: Array, bound: float = math.inf) -> tuple[Array, Flags]:
        """See `Vibration`."""
        sure = np.zeros(volumes.shape[0], dtype=bool)
        if not self.machine.planar:
            return self.exact(volumes), ~sure
        known = np.full((volumes.shape[0], self.speed.size), np.nan)
        everyone = np.arange(volumes.shape[0])
        self._ask(known, volumes, everyone, self._watched or self._coarse)
        looked = np.zeros_like(sure)
        while True:
            so_far = _so_far(known)
            # What is equal to the best known counts as worse, or a plateau would be asked point by point.
            least = min(bound, float(so_far[sure].min(initial=math.inf)))
            left = everyone[~sure & (so_far < least * (1.0 - _EQUAL))]
            if left.size == 0:
                return so_far, sure
            fresh = left[~looked[left]]
            if fresh.size and self._watched:
                self._ask(known, volumes, fresh, sorted(self._near(self._watched[-1], _WINDOW)))
                looked[fresh] = True
                continue
            best = left[np.argmin(so_far[left])][None]
            self._make_sure(known, volumes, best, math.inf)
            sure[best] = True
            if self._watch(int(np.nanargmax(known[best[0]]))):
                looked[:] = False

    def _watch(self, index: int) -> bool:
        """Look at this speed first from now on, and at those watched last; True if it was not among them."""
        fresh = index not in self._watched
        self._watched = [*[known for known in self._watched if known != index][-_WATCHED:], index]
        return fresh

    def _near(self, index: int, places: Sequence[int]) -> set[int]:
        """Speeds around one."""
        return {index + shift for shift in places if 0 <= index + shift < self.speed.size}

    def _around_best(self, row: Array) -> set[int]:
        """Speeds around the highest one known, if any is."""
        return set() if np.isnan(row).all() else self._near(int(np.nanargmax(row)), _CLOSE)

    def _ask(self, known: Array, volumes: Array, rows: Index, speeds: Sequence[int]) -> None:
        """Fill in some rows at some speeds."""
        columns = np.asarray(speeds, dtype=np.intp)
        self._fill(known, volumes, np.repeat(rows, columns.size), np.tile(columns, rows.size))

    def _fill(self, known: Array, volumes: Array, rows: Index, columns: Index) -> None:
        if rows.size:
            known[rows, columns] = self.machine.at(volumes[rows], self.speed[columns]).amplitude

    def _make_sure(self, known: Array, volumes: Array, rows: Index, bound: float) -> None:
        """Close in on the highest peaks of some rows."""
        first = [sorted({*self._coarse, *self._around_best(known[row])}) for row in rows.tolist()]
        owner = np.repeat(rows, [len(indices) for indices in first])
        self._fill(known, volumes, owner, np.array([k for indices in first for k in indices], dtype=np.intp))
        while rows.size:
            rows = rows[_so_far(known[rows]) <= bound]
            wanted = [_around_peaks(known[row]) for row in rows.tolist()]
            owner = np.repeat(rows, [indices.size for indices in wanted])
            if owner.size == 0:
                return
            self._fill(known, volumes, owner, np.concatenate(wanted))
            rows = rows[np.array([indices.size > 0 for indices in wanted])]


def _so_far(known: Array) -> Array:
    """Largest amplitude known of each, shape (m,)."""
    return np.asarray(np.where(np.isnan(known), -np.inf, known).max(axis=1, initial=-np.inf))


def _around_peaks(row: Array) -> Index:
    """Indices to compute next: in the gaps on both sides of the highest peaks known."""
    at = np.flatnonzero(~np.isnan(row))
    value = row[at]
    before, behind = np.concatenate(([-np.inf], value[:-1])), np.concatenate((value[1:], [-np.inf]))
    peaks = np.flatnonzero((value >= before) & (value >= behind))
    peaks = peaks[np.argsort(-value[peaks], kind="stable")][:_PEAKS]
    wanted: set[int] = set()
    for k in peaks.tolist():
        for low, high in ((k - 1, k), (k, k + 1)):
            if low >= 0 and high < at.size and at[high] - at[low] > 1:
                inner = np.linspace(at[low], at[high], _PARTS + 1)[1:-1].round().astype(int)
                wanted |= {index for index in inner.tolist() if at[low] < index < at[high]}
    return np.array(sorted(wanted), dtype=np.intp)
