"""Forces and clearances all along a run-up, and the torque asked of its drive [theory: loads]. SI units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from meshes.arrays import Array, Flags
from solvers.rotor.loads.machine import LoadedMachine
from solvers.rotor.loads.turn import LEAST, Extremes, extremes
from solvers.runup.path import RotorPath

_AT_ONCE = 20_000  # moments
_SHY = 2  # samples on each side of a change of the liquid whose accelerations are not those of a spline


def path_extremes(machine: LoadedMachine, path: RotorPath, time: Array, captured: Flags) -> Extremes:
    """The worst of each interval up to a sample, the first sample alone [theory: loads, eq. 14].

    Parameters
    ----------
    machine : whose rotor moves
    path : its motion
    time : of the samples, s, rising, shape (k,)
    captured : which layers ride with the drum at the samples, shape (k, l)

    Returns
    -------
    Extremes of k intervals; bearing forces are not a number where liquid was caught or let go
    """
    every = np.union1d(path.time, time)
    every = every[(every >= time[0]) & (every <= time[-1])]
    parts = []
    for first in range(0, every.size, _AT_ONCE):
        angle, place, rate, acceleration = path.motion(every[first : first + _AT_ONCE])
        # One moment for each row, so that every moment has its own extremes.
        moved, moving, pushed = (part[:, None, :] for part in (place, rate, acceleration))
        parts.append(extremes(machine.loads(moved, moving, pushed, angle[:, None])))
    starts = np.searchsorted(every, time[:-1], side="right")
    starts = np.concatenate([[0], starts])
    values = {}
    for name in Extremes.__dataclass_fields__:
        moments = np.concatenate([getattr(part, name) for part in parts])
        worst = np.minimum if name in LEAST else np.maximum
        values[name] = worst.reduceat(moments, starts, axis=0)
    found = Extremes(**values)
    return replace(found, bearing=np.where(_jolted(captured)[:, None], np.nan, found.bearing))


def _jolted(captured: Flags) -> Flags:
    """Samples near a change of what rides with the drum, shape (k,)."""
    changed = np.zeros(len(captured), dtype=bool)
    changed[1:] = (captured[1:] != captured[:-1]).any(axis=1)
    near = changed.copy()
    for step in range(1, _SHY + 1):
        near[step:] |= changed[:-step]
        near[:-step] |= changed[step:]
    return near


def drive_torque(
    path: RotorPath, time: Array, speed: Array, angle: Array, inertia: float, motor: bool
) -> Array:
    """Mean torque on the shaft from each sample to the next [theory: loads, eq. 17].

    Parameters
    ----------
    path : with the works at the samples
    time, speed, angle : of the samples, s, rad/s and rad, shape (k,)
    inertia : of what spins about the axis without the liquid, kg m^2
    motor : a motor drives: its own work counts

    Returns
    -------
    N m, shape (k,); the first is that of the interval after it
    """
    if time.size < 2:
        return np.zeros(time.shape)
    unbalance, drive, given = np.diff(path.work[: time.size], axis=0).T
    turned = np.diff(angle)
    work = given if motor else unbalance + drive
    mean = np.divide(work, turned, out=np.zeros_like(turned), where=turned != 0.0)
    if not motor:
        mean = mean + inertia * np.diff(speed) / np.diff(time)
    return np.concatenate([mean[:1], mean])
