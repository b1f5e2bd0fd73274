"""Forces and clearances all along a run-up, and the torque asked of its drive [theory: loads]. SI units."""

from __future__ import annotations

import numpy as np

from meshes.arrays import Array
from solvers.rotor.loads.bearings import bearing_forces, hub_load
from solvers.rotor.loads.machine import LoadedMachine
from solvers.rotor.loads.turn import ANGLES, LEAST, MEAN, Extremes, cubic_mean, extremes, turn_extremes
from solvers.rotor.tub import Tub
from solvers.runup.path import RotorPath

_AT_ONCE = 20_000  # moments
_ENDS = 4  # moments at the ends of a path whose accelerations are not those of the motion


def path_extremes(machine: LoadedMachine, path: RotorPath, time: Array) -> Extremes:
    """Extremes of each interval up to a sample, the first sample alone [theory: loads, eq. 14].

    Where liquid is caught or falls those before and after; of the impulse itself see `bearing_impulses`.
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
        worst = np.fmin if name in LEAST else np.fmax
        if name == MEAN:
            count = np.diff([*starts, len(moments)])[:, None]
            values[name] = np.cbrt(np.add.reduceat(moments**3, starts, axis=0) / count)
            continue
        values[name] = worst.reduceat(moments, starts, axis=0)
    return Extremes(**values)


def bearing_impulses(machine: LoadedMachine, path: RotorPath) -> Array:
    """Impulse of each pool-annulus transition on the bearings, N s, shape (j, b) [theory: loads, eq. 20].

    b = 0 where bearings are not known.
    """
    kicks = path.kicks()
    if machine.bearings is None or not isinstance(machine.rotor, Tub):
        return np.zeros((len(kicks), 0))
    still = np.zeros_like(kicks)
    load = hub_load(machine.rotor, still, still, kicks)
    return np.asarray(np.linalg.norm(bearing_forces(machine.rotor, machine.bearings, load), axis=-1))


def held_extremes(machine: LoadedMachine, spin: float, path: Array) -> Extremes:
    """Extremes over the last turns of a motion that is held at a speed [theory: loads, eq. 14].

    `path`: time and coordinates as of `solvers.held.state.HeldState`, (m, 1 + n); nan where it is too short.
    """
    if len(path) <= 4 * _ENDS:
        nothing = np.full((1, len(machine.rotor.system().coordinates)), np.nan, dtype=complex)
        return turn_extremes(machine, nothing, np.array([spin]))
    whole = RotorPath(path[:, 0], spin * path[:, 0], path[:, 1:], np.zeros((2, 3)))
    # The derivatives of a spline are poor at its ends.
    begin, end = path[_ENDS, 0], path[-1 - _ENDS, 0]
    times = np.linspace(begin, end, 2 + int(ANGLES * spin * (end - begin) / (2.0 * np.pi)))
    found = path_extremes(machine, whole, times)
    values = {}
    for name in Extremes.__dataclass_fields__:
        worst = cubic_mean if name == MEAN else np.min if name in LEAST else np.max
        values[name] = worst(getattr(found, name), axis=0, keepdims=True)
    return Extremes(**values)


def drive_torque(
    path: RotorPath, time: Array, speed: Array, angle: Array, inertia: Array, motor: bool
) -> Array:
    """Mean torque on the shaft from each sample to the next, N m, shape (k,) [theory: loads, eq. 17].

    The first is that of the interval after it. `inertia` of what spins without liquid, kg m^2; `motor`: its
    own work counts.
    """
    if time.size < 2:
        return np.zeros(time.shape)
    unbalance, drive, given = np.diff(path.work[: time.size], axis=0).T
    turned = np.diff(angle)
    work = given if motor else unbalance + drive
    mean = np.divide(work, turned, out=np.zeros_like(turned), where=turned != 0.0)
    if not motor:
        mean = mean + 0.5 * (inertia[1:] + inertia[:-1]) * np.diff(speed) / np.diff(time)
    return np.concatenate([mean[:1], mean])
