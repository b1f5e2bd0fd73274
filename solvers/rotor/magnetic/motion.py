"""Motion of a rotor in magnetic bearings through time, with all nonlinearity of the magnets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from meshes.quantity import Q
from solvers.rotor.magnetic.control import Controller
from solvers.rotor.magnetic.machine import MagneticRotor

MOST_TURNS = 20_000.0  # of the rotor in one run: some minutes
_RELATIVE, _ABSOLUTE = 1e-8, 1e-10  # errors of a step; the second over the sizes of `_Equations.errors`
_REACH = 0.9999  # of the gap, from where on the magnets' forces are those there


class Ending(StrEnum):
    """How a motion ended."""

    DONE = "done"
    TOUCHED = "touched"  # the rotor reached a magnet
    FAILED = "failed"  # the steps did not converge


@dataclass(frozen=True)
class SpeedLaw:
    """Omega = mean + amplitude sin(frequency t) [theory: magnetic, eq. 24] [BG18, section 2]."""

    mean: float  #: rad/s, the amplitude at most the mean
    amplitude: float = 0.0
    frequency: float = 0.0  #: of the pulsation, rad/s

    def __post_init__(self) -> None:
        for name in ("mean", "amplitude", "frequency"):
            require_not_negative(name, getattr(self, name))
        if self.amplitude > self.mean:
            raise InputError("amplitude", self.amplitude, f"at most the mean speed, {self.mean:g} rad/s")

    def speed(self, time: ArrayLike) -> Array:
        """Omega, rad/s, shape of `time`."""
        return np.asarray(self.mean + self.amplitude * np.sin(self.frequency * np.asarray(time, dtype=float)))

    def rate(self, time: ArrayLike) -> Array:
        """Rate of change of Omega, rad/s^2, shape of `time`."""
        cosine = np.cos(self.frequency * np.asarray(time, dtype=float))
        return np.asarray(self.amplitude * self.frequency * cosine)

    def angle(self, time: ArrayLike) -> Array:
        """Angle of the rotor, rad, 0 at time 0, shape of `time`."""
        t = np.asarray(time, dtype=float)
        turned = self.mean * t
        if self.frequency > 0.0:
            turned = turned + self.amplitude / self.frequency * (1.0 - np.cos(self.frequency * t))
        return np.asarray(turned)


@dataclass(frozen=True)
class Load:
    """A constant or harmonic load on the rotor from some time on [theory: magnetic, eq. 2] [BG18, eq. 37]."""

    force: tuple[float, float]  #: along x and y, N
    moment: tuple[float, float] = (0.0, 0.0)  #: about x and y, N m
    frequency: float | None = None  #: p of force and moment times sin(p (t - start)), rad/s; constant if None
    start: float = 0.0  #: s

    def __post_init__(self) -> None:
        if not all(map(math.isfinite, (*self.force, *self.moment, self.start))):
            raise InputError("load", (self.force, self.moment, self.start), "finite numbers")
        if self.frequency is not None:
            require_positive("frequency", self.frequency)

    @property
    def size(self) -> Array:
        """Generalised forces, N and N m, shape (4,)."""
        return np.array([*self.force, *self.moment])

    def at(self, time: ArrayLike) -> Array:
        """Generalised forces at some times, shape (..., 4)."""
        since = np.asarray(time, dtype=float) - self.start
        share = np.ones_like(since) if self.frequency is None else np.sin(self.frequency * since)
        return np.asarray(np.where(since >= 0.0, share, 0.0)[..., None] * self.size)


@dataclass(frozen=True)
class Motion:
    """Motion in time; n times."""

    time: Annotated[Array, Q("s", "time", over=("time",))]
    speed: Annotated[Array, Q("rad s-1", "spin speed", over=("time",))]
    place: Array  #: coordinates and their rates, m, rad and per second, shape (n, 4)
    rate: Array
    memory: Array  #: state of the controller, shape (n, k)
    #: along first x, first y, second x, second y of the bearings, shape (n, 4)
    displacement: Annotated[Array, Q("m", "displacement in the bearings", over=("time", "axis"))]
    #: that flow, shape (n, 4)
    current: Annotated[Array, Q("A", "control currents", over=("time", "axis"))]
    ending: Annotated[Ending, Q(text="how it ended")]
    evaluations: int  #: of the equations of motion

    @property
    def distance(self) -> Array:
        """Distance from the centre in the bearing where it is larger, m, shape (n,)."""
        d = self.displacement
        return np.asarray(np.maximum(np.hypot(d[:, 0], d[:, 1]), np.hypot(d[:, 2], d[:, 3])))


def integrate(
    machine: MagneticRotor,
    controller: Controller,
    law: SpeedLaw,
    duration: float,
    loads: Sequence[Load] = (),
    place: ArrayLike = (0.0, 0.0, 0.0, 0.0),
    rate: ArrayLike = (0.0, 0.0, 0.0, 0.0),
    samples: int = 1001,
) -> Motion:
    """Motion by scipy's LSODA, anew where a load comes on [theory: magnetic, eq. 1 and 2].

    From a place and rate of shape (4,), recorded at even times; it ends where the rotor touches a magnet.
    """
    require_positive("duration", duration)
    if samples < 2:
        raise InputError("samples", samples, "2 or more")
    if law.mean * duration > MOST_TURNS * 2.0 * math.pi:
        raise InputError("duration", duration, f"one of at most {MOST_TURNS:g} turns")
    q, v = np.asarray(place, dtype=float), np.asarray(rate, dtype=float)
    if q.shape != (4,) or v.shape != (4,) or not (np.isfinite(q).all() and np.isfinite(v).all()):
        raise InputError("place, rate", (q.tolist(), v.tolist()), "four finite numbers each")
    if _room(machine, q) <= 0.0:
        raise InputError("place", q.tolist(), "a place at which the rotor touches no magnet")
    state = np.concatenate((q, v, np.zeros(controller.states)))
    if machine.magnets.bandwidth is not None:
        state = np.concatenate((state, np.zeros(4)))
    equations = _Equations(machine, controller, law, tuple(loads))
    return _motion(equations, *_pieces(equations, state, duration, samples))


def settling_time(motion: Motion, band: float, before: float = math.inf) -> float:
    """Time from which the rotor stays within a distance of the centre, s; inf if it does not.

    What comes after `before`, s, is not looked at.
    """
    require_positive("band", band)
    looked = motion.time < before
    time, outside = motion.time[looked], np.flatnonzero(motion.distance[looked] > band)
    if not outside.size:
        return float(time[0])
    last = int(outside[-1])
    return float(time[last + 1]) if last + 1 < time.size else math.inf


class _Equations:
    """Rates of change of coordinates, rates, controller and coils, for the integration."""

    def __init__(
        self, machine: MagneticRotor, controller: Controller, law: SpeedLaw, loads: tuple[Load, ...]
    ) -> None:
        self.machine, self.controller, self.law, self.loads = machine, controller, law, loads
        self.magnets, self.inertia, self.motion = machine.magnets, machine.inertia, machine.bearing_motion
        self.pull, self.damping = machine.motor_pull, machine.damping
        self.gyroscopic, self.circulation = machine.gyroscopic, machine.circulation

    def currents(self, time: float, state: Array) -> tuple[Array, Array, Array]:
        """Wanted and flowing currents, and the rate of change of the controller's state."""
        k, limit = self.controller.states, self.magnets.limit
        speed = float(self.law.speed(time))
        wanted, memory = self.controller.answer(speed, state[:4], state[4:8], state[8 : 8 + k])
        wanted = np.clip(wanted, -limit, limit)
        return wanted, wanted if self.magnets.bandwidth is None else state[8 + k :], memory

    def __call__(self, time: float, state: Array) -> Array:
        """Rates of change, shape of `state`."""
        q, v = state[:4], state[4:8]
        speed, change = float(self.law.speed(time)), float(self.law.rate(time))
        wanted, current, memory = self.currents(time, state)
        most = _REACH * self.magnets.gap  # a trial step may end beyond a magnet
        force = self.magnets.force(np.clip(self.motion @ q, -most, most), current)
        load = self.motion.T @ force + self.machine.unbalance_load(self.law.angle(time), speed, change)
        for part in self.loads:
            load = load + part.at(time)
        load = load + (self.pull - speed * self.circulation - change * self.gyroscopic) @ q
        load = load - (self.damping + speed * self.gyroscopic) @ v
        parts = [v, load / self.inertia, memory]
        if self.magnets.bandwidth is not None:
            parts.append(self.magnets.bandwidth * (wanted - current))
        return np.concatenate(parts)

    def room(self, time: float, state: Array) -> float:
        """Clearance left in the bearing where there is less, m."""
        return _room(self.machine, state[:4])

    def errors(self, size: int) -> Array:
        """Absolute errors that a step may make, shape (size,)."""
        magnets, k = self.magnets, self.controller.states
        lean = magnets.gap / max(abs(self.machine.first), abs(self.machine.second))
        place = np.array([magnets.gap, magnets.gap, lean, lean])
        rate = place * math.sqrt(magnets.position_stiffness / self.machine.mass)
        coils = np.full(size - 8 - k, magnets.bias_current)
        return _ABSOLUTE * np.concatenate((place, rate, self.controller.scales, coils))


def _room(machine: MagneticRotor, place: Array) -> float:
    at = machine.bearing_motion @ place
    return machine.magnets.gap - max(math.hypot(at[0], at[1]), math.hypot(at[2], at[3]))


def _pieces(
    equations: _Equations, state: Array, duration: float, samples: int
) -> tuple[Array, Array, Ending, int]:
    """Times, states, ending and steps, anew from each time at which a load comes on."""
    from scipy.integrate import solve_ivp

    def touches(time: float, state: Array) -> float:
        return equations.room(time, state)

    touches.terminal = True  # type: ignore[attr-defined]
    starts = {load.start for load in equations.loads if 0.0 < load.start < duration}
    edges = [0.0, *sorted(starts), duration]
    wanted = np.linspace(0.0, duration, samples)
    times, states, steps = [], [], 0
    for low, high in pairwise(edges):
        inside = wanted[(wanted >= low) & (wanted < high)] if high < duration else wanted[wanted >= low]
        asked = np.unique(np.concatenate((inside, [high])))
        found = solve_ivp(
            equations,
            (low, high),
            state,
            method="LSODA",
            t_eval=asked,
            events=touches,
            rtol=_RELATIVE,
            atol=equations.errors(state.size),
        )
        steps += found.nfev
        recorded = np.isin(found.t, inside)
        times.append(found.t[recorded])
        states.append(found.y.T[recorded])
        if found.status == 1:
            times.append(found.t_events[0][-1:])
            states.append(found.y_events[0][-1:])
            return np.concatenate(times), np.concatenate(states), Ending.TOUCHED, steps
        if found.status != 0 or not np.isfinite(found.y).all():
            return np.concatenate(times), np.concatenate(states), Ending.FAILED, steps
        state = found.y[:, -1]
    return np.concatenate(times), np.concatenate(states), Ending.DONE, steps


def _motion(equations: _Equations, time: Array, states: Array, ending: Ending, steps: int) -> Motion:
    """What was integrated, with the currents that flow."""
    currents = [equations.currents(float(t), state)[1] for t, state in zip(time, states, strict=True)]
    return Motion(
        time=time,
        speed=equations.law.speed(time),
        place=states[:, :4],
        rate=states[:, 4:8],
        memory=states[:, 8 : 8 + equations.controller.states],
        displacement=states[:, :4] @ equations.motion.T,
        current=np.array(currents).reshape(-1, 4),
        ending=ending,
        evaluations=steps,
    )
