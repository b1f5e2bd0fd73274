"""From one sample of a run to the next: to which time, at which rate of the spin, driven or free."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from meshes.arrays import Array
from solvers.runup.machine import Drive, Motor, Ramp, RunupMachine
from solvers.runup.programme import Programme, Stage

# A grid point this near to a corner, of the distance between two, is no sample of its own.
_SLIVER = 1e-6
# A coast has come to its speed within this share of it.
_REACHED = 1e-6


class Leg(NamedTuple):
    """The way to the next sample."""

    stop: float  #: its time, s
    rate: float  #: of the spin, rad/s^2; 0 where the spin is free
    stage: int  #: of the programme, from 0
    limited: bool = False  #: the motor gives less than the programme asks
    #: only drag, liquid and supports act on the drum, which may come to a stand before the time
    coasts: bool = False


def highest(drive: Drive) -> float:
    """Largest speed that a drive asks for, rad/s."""
    if isinstance(drive, Programme):
        return drive.highest
    speeds = drive.corners()[1] if isinstance(drive, Ramp) else np.array(drive.speeds)
    return float(speeds.max())


def marked(drive: Drive, samples: int, moments: Array) -> list[float]:
    """Times of samples next to some moments, s, ascending, each once."""
    if isinstance(drive, Programme):
        step = _step(drive, samples)
        return [float(time) for time in np.unique(np.round(moments / step) * step)]
    time, _ = _times(drive, samples)
    return sorted({float(time[np.abs(time - moment).argmin()]) for moment in moments})


def legs(drive: Drive, machine: RunupMachine, samples: int) -> Iterator[Leg]:
    """Legs of a run; each is to be gone before the next is asked for: the spin of a coasting drum decides."""
    if isinstance(drive, Programme):
        yield from _programme(drive, machine, _step(drive, samples))
        return
    curve = np.array([drive.speeds, drive.torques], dtype=float) if isinstance(drive, Motor) else _GIVEN
    machine.drive(curve, drive.inertia if isinstance(drive, Motor) else 0.0)
    time, rate = _times(drive, samples)
    for stop, slope in zip(time[1:].tolist(), rate.tolist(), strict=True):
        yield Leg(stop, slope, 0)


def known_legs(drive: Drive, machine: RunupMachine, samples: int) -> tuple[Array, Array] | None:
    """Times and rates of all legs where they are known beforehand, shape (k,); None of a programme."""
    if isinstance(drive, Programme):
        return None
    made = list(legs(drive, machine, samples))
    return np.array([leg.stop for leg in made]), np.array([leg.rate for leg in made])


_GIVEN = np.zeros((2, 0))  # the torque curve of a speed that is given


def _step(drive: Programme, samples: int) -> float:
    """Time between two samples of a programme, s."""
    return float(drive.corners()[0, -1]) / (samples - 1)


def _times(drive: Ramp | Motor, samples: int) -> tuple[Array, Array]:
    """Sampled times with all corners of the ramp among them, and the rate from each to the next."""
    corners = drive.corners()
    time = np.unique(np.concatenate((np.linspace(0.0, corners[0, -1], samples), corners[0])))
    rate = np.zeros(time.size - 1)
    if isinstance(drive, Ramp):
        slopes = np.diff(corners[1]) / np.diff(corners[0])
        middle = 0.5 * (time[:-1] + time[1:])
        rate = slopes[np.searchsorted(corners[0], middle) - 1]
    return time, rate


def _programme(drive: Programme, machine: RunupMachine, step: float) -> Iterator[Leg]:
    """Stage after stage, each from the time and the speed that were reached."""
    load = _Load(machine)
    for number, stage in enumerate(drive.stages):
        spin, stop = machine.spin, drive.target(stage, machine.spin)
        if stage.free:
            assert drive.inertia is not None
            machine.drive(drive.drag(), drive.inertia)
            yield from _coast(drive, machine, step, number, stage, stop)
            continue
        machine.drive(_GIVEN, 0.0)
        lasts = stage.lasts(spin, stop)
        if lasts <= 0.0:
            continue
        if drive.motor is not None:
            yield from _limited(drive, machine, step, number, (lasts, stop), load)
            continue
        end, rate = machine.time + lasts, (stop - spin) / lasts
        while machine.time < end:
            yield Leg(min(_after(machine.time, step, end), end), rate, number)


def _limited(
    drive: Programme,
    machine: RunupMachine,
    step: float,
    number: int,
    aim: tuple[float, float],
    load: _Load,
) -> Iterator[Leg]:
    """Legs of a stage with a given speed as far as the motor's torque suffices [theory: coupling, eq. 16].

    `aim`: time, s, and end speed. Where the rate asks for more than the motor gives its curve takes over. A
    rise goes on until its speed is reached, at no more than its rate; a hold ends with its time, and speed it
    has lost is made up for with all the torque there is.
    """
    assert drive.inertia is not None
    lasts, stop = aim
    net, rate = drive.net(), (stop - machine.spin) / lasts
    load.look()
    end = machine.time + (lasts if rate == 0.0 else max(lasts, drive.limit))
    while machine.time < end:
        time, spin, gap = machine.time, machine.spin, stop - machine.spin
        near = abs(gap) <= _REACHED * stop
        if rate != 0.0 and (near or gap * rate < 0.0):
            return
        given = float(np.interp(spin, *net))
        asked = rate if rate != 0.0 or near or gap < 0.0 else math.inf
        inertia = drive.inertia - machine.lost_inertia
        limited = inertia * asked + load.torque() > given
        slope = (given - load.torque()) / inertia if limited else rate
        until = min(_after(time, step, end), end)
        if slope * gap > 0.0:
            until = min(until, time + max(gap / slope, _SLIVER * step))
        machine.drive(net if limited else _GIVEN, drive.inertia if limited else 0.0)
        yield Leg(until, 0.0 if limited else rate, number, limited)
        load.look()


class _Load:
    """Mean torque of liquid and whirl on the drum over its last turn."""

    def __init__(self, machine: RunupMachine) -> None:
        self._machine = machine
        self._known = [self._now()]

    def _now(self) -> tuple[float, float]:
        """The angle turned, rad, and the work so far, J."""
        sums = self._machine.sums
        return float(self._machine.angle), float(sums["unbalance"] + sums["drive"])

    def look(self) -> None:
        """Take in the last leg."""
        self._known.append(self._now())
        while len(self._known) > 2 and self._known[-1][0] - self._known[1][0] >= 2.0 * math.pi:
            del self._known[0]

    def torque(self) -> float:
        """Mean torque on the drum, N m; 0 before the first leg."""
        (first, before), (last, after) = self._known[0], self._known[-1]
        return (after - before) / (last - first) if last > first else 0.0


def _coast(
    drive: Programme, machine: RunupMachine, step: float, number: int, stage: Stage, stop: float
) -> Iterator[Leg]:
    """Legs until the drum has come down to a speed, stands, or its time is over.

    Where a straight line through the last leg comes down to the speed before the next sample, the leg ends
    there: an ever slower drum comes to its speed in a few ever shorter ones.
    """
    assert stage.duration is not None and drive.inertia is not None
    end = machine.time + stage.duration
    torque = float(np.interp(machine.spin, *drive.drag()))
    slope = torque / drive.inertia
    while machine.time < end and machine.spin > stop * (1.0 + _REACHED):
        time, spin = machine.time, machine.spin
        until = min(_after(time, step, end), end)
        if slope < 0.0:
            until = min(until, time + max((stop - spin) / slope, _SLIVER * step))
        yield Leg(until, 0.0, number, coasts=True)
        if machine.time < until:
            return
        slope = (machine.spin - spin) / (until - time)


def _after(time: float, step: float, end: float) -> float:
    """The next point of the grid; the end where only a sliver would be left before it."""
    found = (math.floor(time / step + _SLIVER) + 1.0) * step
    return end if end - found < _SLIVER * step else found
