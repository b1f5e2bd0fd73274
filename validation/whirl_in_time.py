"""Self-excited whirls in time, by the coupled nonlinear model: how fast they grow, how large they become."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor, RotorSystem
from solvers.runup.long_wave import couple
from solvers.runup.machine import Ramp
from solvers.runup.runup import RunupNumerics, run_up

_SAMPLES = 800
_SMALL = 1e-7  # of the smallest layer's depth, at first
_LARGE = 0.02  # of that depth; beyond it the layer is no longer linear


@dataclass(frozen=True)
class WhirlInTime:
    """What a small disturbance did."""

    growth: float  #: of the deflection's modulus over the last half of the time, 1/s
    whirl_speed: float  #: of the deflection over it, rad/s, standing frame
    linear: bool  #: the layers stayed within the range of linear waves


def whirl_in_time(
    system: RotorSystem,
    fills: Sequence[Fill],
    spin: float,
    friction: Friction,
    duration: float,
    numerics: RunupNumerics | None = None,
) -> WhirlInTime:
    """Let go a rotor with liquid at a constant speed from a tiny deflection [theory: coupling].

    The duration, s, must be long enough for the mode that grows most, or decays slowest, to outlast the
    others.
    """
    require_positive("duration", duration)
    require_positive("spin", spin)
    numerics = numerics or RunupNumerics()
    machine = couple(system, fills, spin, friction, 0.0, numerics.cells, numerics.dispersion)
    if not machine.active.any():
        raise InputError("chambers", len(fills), "at least one with a layer of liquid")
    depth = min(fill.depth for fill, moving in zip(fills, machine.active, strict=True) if moving)
    plane = machine.machine.planes[0]
    # The coordinates that move the first axis along its first direction, as little as may be.
    kick = np.linalg.pinv(plane) @ np.array([_SMALL * depth, 0.0])
    machine.state.place[: kick.size] = kick
    time = np.linspace(0.0, duration, _SAMPLES + 1)
    deflection = np.empty(_SAMPLES, dtype=complex)
    for k, stop in enumerate(time[1:].tolist()):
        if machine.advance(stop, 0.0, numerics.courant, 10**9) != Outcome.DONE:
            return WhirlInTime(math.nan, math.nan, False)
        deflection[k] = complex(*(plane @ machine.state.place[: kick.size]))
    last = slice(_SAMPLES // 2, None)
    modulus = np.abs(deflection[last])
    if modulus.min() <= 0.0:
        return WhirlInTime(-math.inf, 0.0, True)
    growth = np.polyfit(time[1:][last], np.log(modulus), 1)[0]
    turning = np.polyfit(time[1:][last], np.unwrap(np.angle(deflection[last])), 1)[0]
    return WhirlInTime(float(growth), float(turning), bool(modulus.max() < _LARGE * depth))


@dataclass(frozen=True)
class LargeWhirl:
    """A whirl that a machine has come to."""

    amplitude: float  #: mean deflection of the first chamber's axis, m
    whirl_speed: float  #: rad/s, standing frame
    spread: float  #: of the deflection over its mean


_SETTLING, _WATCHED = 900.0, 200.0  # rad of spin: until a whirl has settled, and over which it is measured


def large_whirl_in_time(
    rotor: Rotor,
    fills: Sequence[Fill],
    spin: float,
    friction: Friction,
    kick: float,
    cells: int = 64,
) -> LargeWhirl:
    """Kick a rotor with uniform layers sideways at a constant speed and wait [theory: coupling].

    `kick`: deflection of the first chamber's axis at first, m. LargeWhirl is nan where the machine does not
    get so far.
    """
    machine = couple(rotor.system(), fills, spin, friction, 0.0, cells, False)
    plane = rotor.system().at(fills[0].chamber.plane)
    machine.state.place[:] = kick * np.linalg.pinv(plane)[:, 0]
    times = np.append(np.linspace(0.0, _SETTLING, 31)[1:], _SETTLING + np.arange(1.0, _WATCHED + 1.0)) / spin
    deflection = np.empty(times.size, dtype=complex)
    for k, stop in enumerate(times.tolist()):
        if machine.advance(stop, 0.0, RunupNumerics().courant, 10**9) != Outcome.DONE:
            return LargeWhirl(math.nan, math.nan, math.nan)
        deflection[k] = complex(*(plane @ machine.state.place))
    last = times > _SETTLING / spin
    size, turned = np.abs(deflection[last]), np.unwrap(np.angle(deflection[last]))
    turning = np.polyfit(times[last], turned, 1)[0]
    return LargeWhirl(float(size.mean()), float(turning), float(np.ptp(size) / size.mean()))


@dataclass(frozen=True)
class Passage:
    """A run-up through a band of self-excited whirl and back; k times on the way up, m on the way down."""

    rate: float  #: of the ramp, rad/s^2
    time: Array  #: s, rad/s, m, and rad/s in the standing frame, on the way up, shape (k,)
    speed: Array
    amplitude: Array
    whirl_speed: Array
    lag: Array  #: by which the liquid turns more slowly than the drum on the way up, rad/s, shape (k,)
    speed_down: Array  #: on the way down, the last first: speeds rise, shape (m,)
    amplitude_down: Array
    whirl_speed_down: Array
    converged: bool  #: the run came to its end

    def at(self, speed: float, back: bool = False) -> float:
        """Amplitude at a speed on the way up or down, m."""
        known = (self.speed_down, self.amplitude_down) if back else (self.speed, self.amplitude)
        return float(np.interp(speed, *known))


_SEED = 1e-4  # of the depth: offset of the rotor's mass from the axis, which starts the whirl
_PER_TURN = 10  # samples


def passage(
    rotor: Jeffcott,
    fill: Fill,
    friction: Friction,
    speeds: tuple[float, float],
    rate: float,
    numerics: RunupNumerics,
    seed: float = _SEED,
) -> Passage:
    """Run a rotor with one layer up and at once down again, with next to no unbalance [theory: coupling].

    The numerics' samples are as many as tell the whirl's frequency; `seed`: offset of the rotor's mass from
    the axis over the layer's depth.
    """
    first, last = speeds
    ramp = Ramp(first, last, rate, (last - first) / rate, back=True)
    turns = (last**2 - first**2) / rate / (2.0 * math.pi)
    light = replace(rotor, unbalance=rotor.mass * seed * fill.depth)
    resolved = replace(numerics, samples=int(_PER_TURN * turns), companion=False)
    h = run_up(light.system(), [fill], ramp, friction, 0.0, resolved)
    turning = np.gradient(np.unwrap(np.angle(h.deflection[:, 0])), h.time)
    up, down = slice(0, int(np.argmax(h.speed)) + 1), slice(None, int(np.argmax(h.speed)) - 1, -1)
    return Passage(
        rate=rate,
        time=h.time[up],
        speed=h.speed[up],
        amplitude=h.amplitude[up],
        whirl_speed=turning[up],
        lag=-h.mean_rotation[up, 0],
        speed_down=h.speed[down],
        amplitude_down=h.amplitude[down],
        whirl_speed_down=turning[down],
        converged=h.converged,
    )
