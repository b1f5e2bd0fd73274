"""Motion of the dual-frequency exciter in time, and up to which shaft speed its balls stay stuck."""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.rotor.exciter.machine import (
    CharacteristicSpeeds,
    Dimensionless,
    characteristic_speeds,
    platform_motion,
    rates,
    stuck_speeds,
)

# Coefficients of 1, delta, h, b: numerators and denominators of g1, g2, g3 [YF17, eq. 20].
_PRINTED = (
    ((1.0, -26.5235, -16.7424, -30.1288), (-0.2537, -0.8080, -3.9439, 0.6984)),
    ((1.0, 1.7134, 8.2055, -28.7751), (-0.3455, -0.5673, 4.3034, 8.2679)),
    ((1.0, -9.2714, 229.7664, 43.5133), (-0.0992, 2.4911, 35.3149, -0.1019)),
)
# Ranges that the coefficients were fitted in [YF17, section 5.2].
RANGES = {"smallness": (0.005, 0.05), "drag": (0.1, 0.6), "unbalance": (0.0, 1.0), "damping": (0.01, 0.07)}


def printed_critical_speed(
    smallness: ArrayLike, drag: ArrayLike, unbalance: ArrayLike, damping: ArrayLike
) -> Array:
    """Critical speed as the source prints it [YF17, eq. 18-20]; two balls.

    Over the natural frequency, for the numbers of `Dimensionless`, shapes (...,).
    """
    eps, b, delta, h = np.broadcast_arrays(
        *(np.asarray(x, dtype=float) for x in (smallness, drag, unbalance, damping))
    )
    terms = np.stack((np.ones_like(eps), delta, h, b), axis=-1)
    first, second, third = (terms @ np.array(top) / (terms @ np.array(bottom)) for top, bottom in _PRINTED)
    return np.asarray(1.0 + (1.0 + eps * first) / (4.0 * (b + eps * second) * (h + eps * third)))


MOST_STEPS = 1_000_000_000  # about ten minutes
STARTS = ("released", "regime", "rest")
# Deviation of the balls' speed and their spread that still count; blocks of time, and those judged.
_SPEED_OFF, _SPREAD = 0.05, 0.5
_BLOCKS, _LAST = 40, 10
# Turns of the balls against the shaft without which two frequencies are not told apart.
_TOLD = 5.0


@dataclass(frozen=True)
class Start:
    """How the motion begins [theory: balls, section 1]."""

    #: `released`: platform at rest, balls on their way at the natural frequency; `regime`: platform and balls
    #: already in the dual-frequency motion; `rest`: all at rest, the shaft at its full speed
    kind: str = "released"
    #: angle over which the balls are spread evenly, rad; the first in line with the unbalance, the others
    #: ahead of it
    separation: float = 0.3

    def __post_init__(self) -> None:
        if self.kind not in STARTS:
            raise InputError("kind", self.kind, "one of " + ", ".join(STARTS))
        require_not_negative("separation", self.separation)


@dataclass(frozen=True)
class Motion:
    """What a time integration shows, in the machine's own units; b blocks of time, N balls."""

    speed: float  #: n of the shaft
    ball_speed: Array  #: mean speed of each ball in each block, shape (b, N)
    spread: Array  #: largest angle between the first and another ball in each block, rad, shape (b,)
    stuck_speed: float  #: mean speed of the balls over the last quarter; of the last block if they broke away
    #: amplitudes of the platform with the balls and with the shaft over the last quarter; nan where the balls
    #: have broken away, or part from the shaft by less than five turns in that time
    slow: float
    fast: float
    #: the dual-frequency motion holds: in the last quarter the balls keep within 5 % of the slowest stuck
    #: speed and within half a radian of one another
    holds: bool
    converged: bool  #: every number is finite


@dataclass(frozen=True)
class CriticalSpeed:
    """Bracket of the shaft speed at which the dual-frequency motion is first lost."""

    #: n at which it still holds, the result; n1, unproved, if it is lost at the next speed already
    holds: float
    #: n at which it is lost, at most the width asked for above; the merger of the stuck speeds if it holds as
    #: long as these exist
    lost: float
    runs: int  #: time integrations spent


def integrate(
    machine: Dimensionless,
    speed: float,
    balls: int = 2,
    start: Start | None = None,
    duration: float | None = None,
    steps: int = 24,
) -> Motion:
    """Integrate the full equations of motion at one shaft speed [theory: balls, eq. 6].

    Duration in units of 1/(natural frequency), by default 200 turns of stuck balls, or 12 times the longest
    decay time; `steps` of the fourth-order method in a turn of the shaft, or in 2 pi of what is faster.
    """
    from solvers.rotor.exciter.steps import advance

    start = start or Start()
    require_positive("speed", speed)
    if balls < 1 or steps < 8:
        raise InputError("balls, steps", (balls, steps), "1 or more balls, 8 or more steps")
    total = _duration(machine) if duration is None else duration
    require_positive("duration", total)
    roots = stuck_speeds(speed, machine)
    state = initial_state(machine, speed, float(roots[0]), balls, start)
    fastest = max(speed, 1.0, 2.0 * machine.damping, machine.smallness * machine.drag)
    in_block = math.ceil(total / _BLOCKS * steps * fastest / (2.0 * math.pi))
    if in_block * _BLOCKS > MOST_STEPS:
        raise InputError("duration", total, f"one of at most {MOST_STEPS:g} steps")
    step = total / (_BLOCKS * in_block)
    means, sums = np.zeros((_BLOCKS, balls + 1)), np.zeros(4)
    # Beyond the middle of the upper two the balls are on their way to the fastest.
    most = 0.5 * float(roots[1] + roots[2]) if np.isfinite(roots[2]) else 2.0 * float(roots[0]) + 1.0
    done = advance(state, machine.numbers(speed), step, in_block, most, means, _BLOCKS - _LAST, sums)
    return _motion(speed, float(roots[0]), total / _BLOCKS, means[:done], sums, machine)


def initial_state(machine: Dimensionless, speed: float, stuck: float, balls: int, start: Start) -> Array:
    """State at time 0, when the unbalance points along the first direction.

    Platform's position and velocity, angles of the balls, their speeds, shape (2 + 2 N,).
    """
    state = np.zeros(2 + 2 * balls)
    state[2 : 2 + balls] = np.linspace(0.0, start.separation, balls)
    if start.kind == "rest":
        return state
    if start.kind == "released":
        state[2 + balls :] = 1.0
        return state
    state[2 + balls :] = stuck
    slow, fast = platform_motion(machine, speed, stuck)
    state[0] = (slow + fast).imag
    state[1] = (1j * (stuck * slow + speed * fast)).imag
    return state


def placed_state(machine: Dimensionless, speed: float, ball_speed: ArrayLike, ball_angle: ArrayLike) -> Array:
    """State at time 0 of balls that turn evenly, each at its own speed, and of the shaken platform."""
    speeds, angles = np.asarray(ball_speed, dtype=float), np.asarray(ball_angle, dtype=float)
    if speeds.ndim != 1 or speeds.size < 1 or speeds.shape != angles.shape:
        raise InputError("ball_speed, ball_angle", (speeds.tolist(), angles.tolist()), "one of each a ball")
    if not (np.all(np.isfinite(speeds)) and np.all(np.isfinite(angles))):
        raise InputError("ball_speed, ball_angle", (speeds.tolist(), angles.tolist()), "finite numbers")
    turning = np.append(speeds, speed)
    weight = np.append(np.full(speeds.size, 1.0 / speeds.size), machine.unbalance)
    answer = turning**2 / (1.0 - turning**2 + 2j * machine.damping * turning)
    wave = weight * answer * np.exp(1j * np.append(angles, 0.0))
    return np.concatenate(([wave.sum().imag, (1j * turning * wave).sum().imag], angles, speeds))


@dataclass(frozen=True)
class Trace:
    """Motion after transients have decayed, in the machine's own units; s samples, N balls."""

    time: Array  #: from the start of the motion, shape (s,)
    position: Array  #: v, v' and v'' of the platform, shape (s,)
    velocity: Array
    acceleration: Array
    ball_angle: Array  #: of each ball, shape (s, N)
    ball_speed: Array


def trace(
    machine: Dimensionless,
    speed: float,
    turns: float = 3.0,
    balls: int = 2,
    start: Start | None = None,
    samples: int = 1200,
) -> Trace:
    """Platform and balls over some turns of the stuck balls, after as long a run as `integrate` makes."""
    from scipy.integrate import solve_ivp

    from solvers.rotor.exciter.steps import advance

    require_positive("speed", speed)
    require_positive("turns", turns)
    if balls < 1 or samples < 2:
        raise InputError("balls, samples", (balls, samples), "1 or more balls, 2 or more samples")
    slowest = float(stuck_speeds(speed, machine)[0])
    state = initial_state(machine, speed, slowest, balls, start or Start())
    total = _duration(machine)
    fastest = max(speed, 1.0, 2.0 * machine.damping, machine.smallness * machine.drag)
    steps, numbers = math.ceil(total * 48 * fastest / (2.0 * math.pi)), machine.numbers(speed)
    means, sums = np.zeros((1, balls + 1)), np.zeros(4)
    advance(state, numbers, total / steps, steps, math.inf, means, 1, sums)

    def rate(time: float, at: Array) -> Array:
        out = np.zeros(at.size)
        rates(time, at, numbers, out)
        return out

    times = total + np.linspace(0.0, turns * 2.0 * math.pi / slowest, samples)
    span = (float(times[0]), float(times[-1]))
    found = solve_ivp(rate, span, state, "DOP853", times, rtol=1e-10, atol=1e-12).y.T
    moved = np.array([rate(time, at) for time, at in zip(times.tolist(), found, strict=True)])
    return Trace(
        time=times,
        position=found[:, 0],
        velocity=found[:, 1],
        acceleration=moved[:, 1],
        ball_angle=found[:, 2 : 2 + balls],
        ball_speed=found[:, 2 + balls :],
    )


def critical_speed(
    machine: Dimensionless,
    balls: int = 2,
    start: Start | None = None,
    width: float = 0.05,
    ratio: float = 1.1,
) -> CriticalSpeed:
    """Largest shaft speed at which the dual-frequency motion holds [YF17, section 4.4].

    Searched upward in steps of a constant `ratio` for the first speed at which it does not, then halved to
    `width`.
    """
    require_positive("width", width)
    if not ratio > 1.0:
        raise InputError("ratio", ratio, "above 1")
    known = characteristic_speeds(machine)
    low, high, runs = _first_loss(machine, balls, start, ratio, known)
    while high - low > width:
        middle, runs = 0.5 * (low + high), runs + 1
        if integrate(machine, middle, balls, start).holds:
            low = middle
        else:
            high = middle
    return CriticalSpeed(low, high, runs)


def critical_speeds(
    machines: Sequence[Dimensionless], balls: int = 2, start: Start | None = None, workers: int = 1
) -> Array:
    """`critical_speed` of many machines, shape (m,)."""
    with ThreadPoolExecutor(max_workers=workers) as pool:
        found = pool.map(lambda machine: critical_speed(machine, balls, start).holds, machines)
    return np.array(list(found))


def _first_loss(
    machine: Dimensionless, balls: int, start: Start | None, ratio: float, known: CharacteristicSpeeds
) -> tuple[float, float, int]:
    """Neighbouring speeds of a geometric row of which only the first holds, and the runs."""
    if math.isnan(known.merger):
        raise InputError(
            "machine", machine, "one whose stuck speeds part: less damping, more drag or fewer balls"
        )
    # Up to n1 there is one stuck speed: nowhere else to go.
    low, runs = known.second_pair, 0
    while True:
        high, runs = min(low * ratio, known.merger), runs + 1
        if not integrate(machine, high, balls, start).holds:
            return low, high, runs
        if high == known.merger:
            return high, high, runs
        low = high


def _duration(machine: Dimensionless) -> float:
    """Time in which transients have decayed by e^12."""
    if machine.drag <= 0.0 or machine.damping <= 0.0:
        raise InputError("drag, damping", (machine.drag, machine.damping), "above 0, or give a duration")
    slowest = min(machine.smallness * machine.drag, machine.damping)
    return max(400.0 * math.pi, 12.0 / slowest)


def _motion(
    speed: float, stuck: float, block: float, means: Array, sums: Array, machine: Dimensionless
) -> Motion:
    """Judge the last quarter of what was integrated."""
    finished = means.shape[0] == _BLOCKS
    last = slice(-_LAST, None) if finished else slice(-1, None)
    speeds, spread = means[:, :-1], means[:, -1]
    sound = bool(np.isfinite(means).all() and np.isfinite(sums).all())
    merger = characteristic_speeds(machine).merger
    exists = math.isnan(merger) or speed <= merger
    kept = bool(
        np.all(np.abs(speeds[last] - stuck) <= _SPEED_OFF * stuck) and np.all(spread[last] <= _SPREAD)
    )
    turns = abs(speed - float(speeds[last].mean())) * block * _LAST / (2.0 * math.pi)
    slow = fast = math.nan
    if sound and finished and turns >= _TOLD:
        slow, fast = float(np.hypot(sums[0], sums[1])), float(np.hypot(sums[2], sums[3]))
    return Motion(
        speed=speed,
        ball_speed=speeds,
        spread=spread,
        stuck_speed=float(speeds[last].mean()),
        slow=slow,
        fast=fast,
        holds=sound and finished and exists and kept,
        converged=sound,
    )
